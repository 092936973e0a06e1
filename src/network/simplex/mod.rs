//! One simplex: the arrangement of n linear functions, and the upper envelope of n materials, in a tetrahedron or a
//! triangle, given by values at its corners (sections 4 and 5 of the networks paper). [`data`] says what comes out.

pub mod arrangement;
pub mod data;
pub mod interface;

pub use arrangement::arrangement;
pub use data::{
    Carrier, FaceSupport, Kind, LocalCell, LocalEdge, LocalFace, LocalFunction, LocalHalfFace, LocalPlane, LocalVertex,
    Scratch, SimplexComplex,
};
pub use interface::interface;

//! One simplex: the arrangement of n linear functions, and the upper envelope of n materials, in a tetrahedron or a
//! triangle, given by values at its corners (sections 4 and 5 of the networks paper). [`data`] says what comes out.

pub mod arrangement;
pub mod batch;
pub mod check;
pub mod data;
pub mod exact_values;
mod export;
mod first_two;
pub mod interface;
#[cfg(feature = "plain-signs")]
mod plain;
mod signs;
mod split;
mod table_view;
pub mod tables;
mod work;

pub use arrangement::{arrangement, arrangement_incremental};
pub use check::check;
pub use data::{
    Carrier, FaceSupport, Kind, LocalCell, LocalEdge, LocalFace, LocalFunction, LocalHalfFace, LocalPlane, LocalVertex,
    Scratch, SimplexComplex,
};
pub use interface::{interface, interface_incremental};
pub use table_view::{View, ViewFace};
pub use tables::{ENTRIES, Found, PERMUTATIONS, SYMMETRIES, find_table};

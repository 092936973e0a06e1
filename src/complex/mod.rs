//! The output: cells, faces, edges and vertices with half-faces; and everything that all engines need to get
//! from faces to nested cells and from there to the arrays that a host reads.

pub mod data;
pub mod locate;
pub mod loops;
pub mod radial;
pub mod shells;

pub use data::{Complex, HalfFace, Origin, SupportId};

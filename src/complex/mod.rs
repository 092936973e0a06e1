//! The output: cells, faces, edges and vertices with half-faces; and everything that all engines need to get
//! from faces to nested cells and from there to the arrays that a host reads.

pub mod adjacency;
pub mod bodies;
pub mod bridge;
pub mod certified;
pub mod certify;
pub mod certify_check;
pub mod certify_repair;
pub mod certify_work;
pub mod check;
pub mod data;
pub mod ears;
pub mod euler;
pub mod exact_values;
pub mod keys;
pub mod locate;
pub mod loops;
pub mod moments;
pub mod projection;
pub mod radial;
pub mod shells;
pub mod styles;
pub mod triangulate;

pub use adjacency::{Adjacency, HalfCorner, adjacency};
pub use certify::{CertifiedComplex, CertifyOptions, CertifyReport, certify};
pub use check::{check, check_part, check_volumes};
pub use data::{Complex, HalfFace, Levels, Origin, SupportId};
pub use euler::{euler, solid_euler, surface_euler};
pub use keys::{GlobalIds, Key};
pub use moments::{Moments, moments};
pub use styles::{FaceArrays, FaceStyle, faces_as};

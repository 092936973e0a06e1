//! Networks of piecewise linear functions on tetrahedra and triangles (DESIGN §5): the implicit arrangement (IA), whose
//! surfaces are the zero sets of functions, and the material interface (MI), whose surfaces separate the regions
//! where different materials are largest. Both are exact for any finite values.

mod assemble;
mod box_cubes;
mod box_edges;
pub mod carrier;
pub mod chains;
mod check;
pub mod csg;
pub mod data;
pub mod domain;
pub mod edges;
pub mod exact_vertices;
pub mod extract;
pub mod local;
mod locate;
mod mesh_cells;
mod mesh_edges;
pub mod patches;
mod points;
mod polygons;
pub mod radial;
pub mod rays;
pub mod regions;
pub mod runs;
mod sets;
pub mod shells;
mod signs;
pub mod simplex;
mod table;
pub mod tet_mesh;
pub mod ties;
pub mod topology;
pub mod volumes;
mod walls;

pub use data::{Network, SetItem, Values};
pub use domain::{BoxGrid, Domain};
pub use extract::extract;
pub use simplex::Kind;
pub use tet_mesh::TetMesh;

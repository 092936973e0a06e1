//! Grid: the boxes of a rectilinear grid against a surface: full, empty or cut into polyhedra.

pub mod data;
pub mod lattice;

use crate::base::{Result, Run};
use crate::mesh::TriMesh;
use std::sync::Arc;

pub use data::{CUT, EMPTY, FULL, FULL_CELL, GridCells};
pub use lattice::Lattice;

/// What to take for fluid, and where the block's fluid is known.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridOptions {
    /// The fluid is outside the mesh.
    pub outside: bool,
    /// For a patch of a mesh: a node of the block, and whether it is in the fluid (not on the surface). `None`: the mesh is whole.
    pub known: Option<([usize; 3], bool)>,
}

/// Cuts the boxes of a block along a surface.
pub fn cut_grid(mesh: &Arc<TriMesh>, lattice: Lattice, options: &GridOptions, run: &mut Run) -> Result<GridCells> {
    let _ = (options, run);
    Ok(GridCells { mesh: mesh.clone(), planes: lattice.planes(), lattice, ..Default::default() })
}

//! Arrangements of triangle meshes: the cells into which any number of meshes divide space, each with its winding-number vector; booleans are an
//! extraction from it (the Mesh Arrangements paper, DESIGN §6).
//!
//! Stages in pipeline order: [`soup`] → [`intersect`] (with [`stars`], [`pair`], [`sheets`], [`points`]) → [`clusters`] → [`crossings`] → [`triangulate`] (with [`regions`]) →
//! [`resolve`] (→ [`clip`], of half-spaces: [`supports`]) → [`patches`] → [`cells`] (with [`nesting`]) → [`winding`] → [`extract`] (→ [`certify`], with
//! [`flatten`], [`slabs`] and [`snap`]) or [`solids`] (→ [`keys`]).

pub mod cells;
pub mod certify;
pub mod clip;
pub mod clusters;
pub mod crossings;
pub mod data;
pub mod extract;
pub mod flatten;
pub mod intersect;
pub mod keys;
pub mod nesting;
pub mod pair;
pub mod patches;
pub mod planar;
pub mod points;
pub mod regions;
pub mod resolve;
pub mod sheets;
pub mod slabs;
pub mod snap;
pub mod solids;
pub mod soup;
pub mod stars;
pub mod supports;
pub mod triangulate;
pub mod volumes;
pub mod winding;

pub use data::*;
pub use extract::{Extraction, Selection, choose, extract};

use crate::base::{CellId, FaceId, Result, Run, VertexId};
use crate::complex::{HalfFace, Origin};
use crate::exact::{Plane, Point};

/// Nothing to choose yet.
#[derive(Clone, Copy, Debug, Default)]
pub struct ArrangementOptions {}

/// The cells into which meshes divide space.
#[derive(Clone, Debug, Default)]
pub struct Arrangement {
    pub resolved: Resolved,
    pub cells: Cells,
    pub winding: Winding,
    /// Seconds per stage, in order.
    pub stages: Vec<(&'static str, f64)>,
}

impl Arrangement {
    pub fn operand_count(&self) -> usize {
        self.resolved.soup.operand_count()
    }
    /// Input positions, then constructed points; not all of them are corners of faces.
    pub fn vertex_count(&self) -> usize {
        self.resolved.vertex_count()
    }
    pub fn face_count(&self) -> usize {
        self.resolved.faces.len()
    }
    pub fn patch_count(&self) -> usize {
        self.cells.patch_face.len()
    }
    /// The unbounded cell, number 0, included.
    pub fn cell_count(&self) -> usize {
        self.cells.cell_count
    }
    /// Correctly rounded coordinates.
    pub fn coords(&self, v: VertexId) -> [f64; 3] {
        self.resolved.coords(v)
    }
    pub fn origin(&self, v: VertexId) -> Origin {
        self.resolved.origin(v)
    }
    /// The exact, symbolic point of a vertex.
    pub fn point(&self, v: VertexId) -> Point {
        self.resolved.point(v)
    }
    /// The cells behind a face and before it; `NONE` for a face that divides nothing.
    pub fn face_cells(&self, f: FaceId) -> [CellId; 2] {
        [false, true].map(|front| self.cells.of[HalfFace::new(f, front).at()])
    }
    /// The winding numbers of a cell that are not zero, by operand.
    pub fn winding(&self, c: CellId) -> &[Multiplicity] {
        self.winding.rows.row(c)
    }
}

/// Finds the cells into which the operands divide space. Runs on the current rayon pool; the result does not depend on its size.
///
/// Errors: `BadMesh` with every coordinate that is not finite, every index out of range, every edge of an operand that does not balance
/// (the message names the operand); `TooLarge`; `Cancelled`.
pub fn arrange(operands: &[Operand], options: &ArrangementOptions, run: &mut Run) -> Result<Arrangement> {
    arrange_with(operands, &[], None, options, run)
}

/// The same with half-spaces n·x + d < 0 as further operands, numbered behind the others. Each is its part within a box, the bounds (lowest and highest corner;
/// `None`: the box of all meshes, with as much room on each side as it is large): what is farther out has winding number 0.
///
/// Errors: as [`arrange`]; `BadPlane` with every plane that is not finite or has a zero normal; `BadArgument` for bounds that are no box.
pub fn arrange_with(
    operands: &[Operand],
    half_spaces: &[Plane],
    bounds: Option<[[f64; 3]; 2]>,
    _options: &ArrangementOptions,
    run: &mut Run,
) -> Result<Arrangement> {
    let soup = soup::soup_with(operands, half_spaces, bounds, run)?;
    let contacts = intersect::intersect(&soup, run)?;
    let clusters = clusters::clusters(&contacts);
    debug_assert_eq!(clusters.check(&contacts), Ok(()));
    let pair_count = contacts.pair_count;
    let graphs = crossings::crossings(&soup, contacts, &clusters, run)?;
    let mut resolved = resolve::resolve(soup, graphs, &clusters, pair_count, run)?;
    drop(clusters);
    clip::clip(&mut resolved, run)?;
    debug_assert_eq!(resolved.check(), Ok(()));
    run.stage("patches", 0.7)?;
    let patches = patches::patches(&resolved, run)?;
    if !patches.unbalanced.is_empty() {
        return Err(patches::unbalanced_error(&resolved, operands, &patches.unbalanced));
    }
    debug_assert_eq!(patches.check(&resolved), Ok(()));
    run.stage("cells", 0.8)?;
    let cells = cells::cells(&resolved, patches, run)?;
    debug_assert_eq!(cells.check(), Ok(()));
    run.stage("winding", 0.95)?;
    let winding = winding::winding(&cells)?;
    debug_assert_eq!(winding.check(&cells), Ok(()));
    run.end_stage();
    Ok(Arrangement { resolved, cells, winding, stages: run.take_stages() })
}

//! Which component of the input each cell belongs to: cells that share a face on a plane (or level) are parts of one body, and a body is
//! named by the component of the outer shell around it.

use super::{Complex, SupportId};
use crate::base::{ComponentId, Error, Result, SharedUnionFind};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

/// Fills `cell_component`. `Inconsistent` if no outer shell bounds a cell's body, which only input that intersects itself
/// can cause. Cost: linear in the faces, shared out among threads.
pub fn assign_components(c: &mut Complex) -> Result<()> {
    let count = c.cell_shells.len() - 1;
    let bodies = SharedUnionFind::new(count);
    // All other faces come behind those of triangles.
    let surface = c.face_support.partition_point(|s| matches!(s, SupportId::Triangle(_)));
    c.face_cells[surface..].par_iter().with_min_len(LEAST).for_each(|&[owner, neighbour]| {
        if neighbour.is_some() {
            bodies.union(owner.at(), neighbour.at());
        }
    });
    let component: Vec<AtomicU32> = (0..count).map(|_| AtomicU32::new(ComponentId::NONE.0)).collect();
    c.face_support[..surface].par_iter().zip(&c.face_cells).with_min_len(LEAST).for_each(|(&support, cells)| {
        let SupportId::Triangle(t) = support else { return };
        let shell = &c.mesh.shells[c.mesh.triangle_shell[t.at()].at()];
        if shell.outer {
            let body = &component[bodies.find(cells[0].at())];
            // Nearly always there already.
            if body.load(Ordering::Relaxed) > shell.component.0 {
                body.fetch_min(shell.component.0, Ordering::Relaxed);
            }
        }
    });
    c.cell_component = (0..count).map(|i| ComponentId(component[bodies.find(i)].load(Ordering::Relaxed))).collect();
    match c.cell_component.iter().position(|component| component.is_none()) {
        Some(cell) => Err(Error::inconsistent(format!("cell {cell} is in no solid"))),
        None => Ok(()),
    }
}

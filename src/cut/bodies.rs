//! Which component of the input each cell belongs to: cells that share a plane face are parts of one body, and a body is
//! named by the component of the outer shell around it.

use crate::base::{CellId, ComponentId, Error, Result, UnionFind};
use crate::complex::{Complex, SupportId};

/// Fills `cell_component`. `Inconsistent` if no outer shell bounds a cell's body, which only input that intersects itself
/// can cause. Cost: linear in the faces.
pub fn assign_components(c: &mut Complex) -> Result<()> {
    let count = c.cell_shells.len() - 1;
    let mut bodies = UnionFind::new(count);
    for &[owner, neighbour] in &c.face_cells {
        if neighbour.is_some() {
            bodies.union(owner.at(), neighbour.at());
        }
    }
    let mut component = vec![ComponentId::NONE; count];
    for (f, &[owner, _]) in c.face_cells.iter().enumerate() {
        let SupportId::Triangle(t) = c.face_support[f] else { break };
        let shell = &c.mesh.shells[c.mesh.triangle_shell[t.at()].at()];
        if shell.outer {
            let body = bodies.find(owner.at());
            component[body] = component[body].min(shell.component);
        }
    }
    c.cell_component = (0..count).map(|i| component[bodies.find(CellId::of(i).at())]).collect();
    match c.cell_component.iter().position(|component| component.is_none()) {
        Some(cell) => Err(Error::inconsistent(format!("cell {cell} is in no solid"))),
        None => Ok(()),
    }
}

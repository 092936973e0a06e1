//! Which component of the input each cell belongs to: cells that share a plane face are parts of one body, and a body is
//! named by the component of the outer shell around it.

use crate::base::{CellId, ComponentId, UnionFind};
use crate::complex::{Complex, SupportId};

/// Fills `cell_component`. Cost: linear in the faces.
pub fn assign_components(c: &mut Complex) {
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
}

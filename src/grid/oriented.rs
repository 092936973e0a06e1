//! The surface as the grid sees it: directed so that the fluid is behind its triangles.

use crate::mesh::{EdgeUse, TriMesh};
use std::sync::Arc;

/// The mesh itself, or all of its triangles reversed where the fluid is outside. A triangle's corners 0, 1, 2 become 0, 2, 1.
pub fn oriented(mesh: &Arc<TriMesh>, outside: bool) -> Arc<TriMesh> {
    if !outside {
        return mesh.clone();
    }
    let mut reversed = TriMesh::clone(mesh);
    reversed.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    reversed.triangle_edges.iter_mut().for_each(|e| e.swap(0, 2));
    // Side 0 becomes side 2 and the other way round.
    reversed.edge_uses.items.iter_mut().for_each(|u| *u = EdgeUse::new(u.triangle, 2 - u.side(), !u.forward()));
    reversed.shells.iter_mut().for_each(|s| s.outer = !s.outer);
    Arc::new(reversed)
}

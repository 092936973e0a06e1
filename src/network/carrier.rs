//! Which open sub-simplex of the domain holds an edge, and whether it lies on the domain's boundary.
//!
//! An edge of the network is a side of a convex polygon in one closed simplex, so the smallest face of that simplex with both
//! of its ends holds the open edge: its nodes are those of the two ends together.
//!
//! Cost: a few divisions for boxes, else that of the simplices around one node.

use super::{Domain, Network};
use crate::base::{NodeId, TetId, VertexId};

/// The nodes of the sub-simplex that holds the open edge between two vertices (or a vertex, given twice), rising, then `NONE`.
pub fn edge_carrier(network: &Network, u: VertexId, v: VertexId) -> [NodeId; 4] {
    let (a, b) = (&network.vertex_nodes[u.at()], &network.vertex_nodes[v.at()]);
    let (mut i, mut j) = (0, 0);
    std::array::from_fn(|_| {
        let (x, y) = (a.get(i).copied().unwrap_or(NodeId::NONE), b.get(j).copied().unwrap_or(NodeId::NONE));
        i += (x <= y) as usize;
        j += (y <= x) as usize;
        x.min(y)
    })
}

/// How many nodes a carrier has.
#[inline]
pub fn node_count(nodes: &[NodeId; 4]) -> usize {
    nodes.iter().filter(|n| n.is_some()).count()
}

/// Whether a sub-simplex of the domain lies on its boundary: some facet around it has a simplex on one side only.
pub fn on_boundary(domain: &Domain, nodes: &[NodeId; 4], around: &mut Vec<TetId>) -> bool {
    let (dim, count) = (domain.dim(), node_count(nodes));
    if count > dim {
        return false;
    }
    if let Domain::Box(grid) = domain {
        // All nodes in one of the six faces.
        let (mut low, mut high) = ([true; 3], [true; 3]);
        for place in nodes[..count].iter().map(|&n| grid.place(n)) {
            for axis in 0..3 {
                low[axis] &= place[axis] == 0;
                high[axis] &= place[axis] == grid.cells()[axis];
            }
        }
        return low.contains(&true) || high.contains(&true);
    }
    domain.around(&nodes[..count], around);
    if count == dim {
        return around.len() == 1;
    }
    around.iter().any(|&tet| {
        let corners = domain.corners(tet);
        (0..=dim).any(|facet| !nodes.contains(&corners[facet]) && domain.opposite(tet, facet).is_none())
    })
}

//! What the lattice implies about full boxes, on demand: the squares between them, which are not stored as faces, and the
//! links from cut cells to full neighbours, which are stored but scattered among the faces.
//!
//! A square between a full and a cut box is a face of the cut box's cell (the surface misses the closed full box, so the
//! square is fluid on both sides); a full box has no empty neighbour, for the same reason. So the implied squares are those
//! between two full boxes, and those of full boxes at the block's boundary.

use super::data::{FULL, FULL_CELL, GridCells};
use crate::base::{BoxId, CellId, FaceId, NodeId};

/// Squares of one grid plane, by rising lowest node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FullFaces {
    pub low_node: Vec<NodeId>,
    /// The full boxes on the lower and upper side; `NONE` beyond the block.
    pub boxes: Vec<[BoxId; 2]>,
}

/// The squares of the plane through a node of an axis with a full box and no face. Cost: a byte per box beside the plane.
pub fn full_faces(g: &GridCells, axis: usize, node: usize) -> FullFaces {
    let lattice = &g.lattice;
    let (b, c) = ([1, 0, 0][axis], [2, 2, 1][axis]);
    let mut out = FullFaces::default();
    // The slower axis outside, so that nodes rise.
    for j in 0..lattice.count(c) {
        for i in 0..lattice.count(b) {
            let mut at = [0; 3];
            (at[axis], at[b], at[c]) = (node, i, j);
            let side = |inside: bool, at: [usize; 3]| if inside { lattice.box_id(at) } else { BoxId::NONE };
            let upper = side(node < lattice.count(axis), at);
            let low_node = lattice.node_id(at);
            at[axis] = node.wrapping_sub(1);
            let lower = side(node > 0, at);
            let full = |x: BoxId| x.is_some() && g.flags[x.at()] == FULL;
            let open = |x: BoxId| x.is_none() || full(x);
            if (full(lower) || full(upper)) && open(lower) && open(upper) {
                out.low_node.push(low_node);
                out.boxes.push([lower, upper]);
            }
        }
    }
    out
}

/// Faces between a cut cell and a full box, by rising face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FullLinks {
    pub cell: Vec<CellId>,
    pub face: Vec<FaceId>,
    pub full: Vec<BoxId>,
}

/// The box on the lower (0) or upper (1) side of a face in a grid plane, which is within the block.
#[inline]
pub fn box_beside(g: &GridCells, f: FaceId, side: usize) -> BoxId {
    let mut at = g.lattice.node_at(g.square_node[(f.0 - g.plane_faces[0]) as usize]);
    at[g.face_axis(f)] -= 1 - side;
    g.lattice.box_id(at)
}

/// All links from cut cells to full neighbours. Cost: linear in the faces.
pub fn full_links(g: &GridCells) -> FullLinks {
    let mut out = FullLinks::default();
    for (k, cells) in g.square_cells.iter().enumerate() {
        let f = FaceId(g.plane_faces[0] + k as u32);
        for side in 0..2 {
            if cells[side] == FULL_CELL {
                out.cell.push(cells[1 - side]);
                out.face.push(f);
                out.full.push(box_beside(g, f, side));
            }
        }
    }
    out
}

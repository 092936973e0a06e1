//! Planar subdivision → loops → outer and hole loops.
//!
//! Input: for every vertex the half-edges that leave it, counter-clockwise, and which half-edges have a face on their
//! left. Half-edge `2i` runs along piece `i`, `2i + 1` back. A loop is an orbit of `next`: arriving at a vertex, the next half-edge
//! is the first one clockwise of the way back. An edge with the same face on both sides is walked twice.
//!
//! Cost: linear in the half-edges.

use crate::base::{Csr, EdgeId, VertexId};
use rayon::prelude::*;

/// Loops as rows of half-edges, by lowest half-edge. Fails with a half-edge whose left side is inside while its
/// successor's is not: the labels contradict each other.
pub fn trace_loops(half_edges: usize, star: &Csr<u32>, has_face: impl Fn(u32) -> bool) -> Result<Csr<u32>, u32> {
    const DONE: u32 = u32::MAX;
    let mut next = vec![DONE; half_edges];
    for row in star.rows() {
        let mut clockwise = row.len();
        for (i, &out) in row.iter().enumerate() {
            clockwise = if i == 0 { row.len() - 1 } else { clockwise };
            let arriving = out ^ 1;
            if has_face(arriving) {
                let successor = row[clockwise];
                if !has_face(successor) {
                    return Err(arriving);
                }
                next[arriving as usize] = successor;
            }
            clockwise = i;
        }
    }
    let mut loops = Csr::with_capacity(0, half_edges);
    for start in 0..half_edges {
        let mut h = start;
        if next[h] == DONE {
            continue;
        }
        while next[h] != DONE {
            loops.items.push(h as u32);
            h = std::mem::replace(&mut next[h], DONE) as usize;
        }
        // Successors are distinct when the stars are permutations; a walk that ends elsewhere means they were not.
        if h != start {
            return Err(start as u32);
        }
        loops.end_row();
    }
    Ok(loops)
}

/// Edges by rising pair of vertices, and the edge from each corner to the next of its loop (`NONE` for the only corner of one).
/// Cost: a sort of the corners.
pub fn find_edges(loop_offsets: &[u32], corners: &[VertexId]) -> (Vec<[VertexId; 2]>, Vec<EdgeId>) {
    let mut uses: Vec<(u64, u32)> = Vec::with_capacity(corners.len());
    for w in loop_offsets.windows(2) {
        let row = w[0] as usize..w[1] as usize;
        if row.len() < 2 {
            continue;
        }
        for k in row.clone() {
            let (a, b) = (corners[k], corners[if k + 1 == row.end { row.start } else { k + 1 }]);
            uses.push(((a.min(b).0 as u64) << 32 | a.max(b).0 as u64, k as u32));
        }
    }
    uses.par_sort_unstable();
    let mut edges: Vec<[VertexId; 2]> = Vec::new();
    let mut of_corner = vec![EdgeId::NONE; corners.len()];
    let mut last = u64::MAX;
    for (ends, k) in uses {
        if ends != last {
            last = ends;
            edges.push([VertexId((ends >> 32) as u32), VertexId(ends as u32)]);
        }
        of_corner[k as usize] = EdgeId::of(edges.len() - 1);
    }
    (edges, of_corner)
}

//! Edges and adjacency of a triangle list, by counting sort.
//!
//! The sides of all triangles are bucketed by their lower vertex (count, prefix sum, fill), then each bucket, six
//! sides on average, is sorted by higher vertex and triangle. Edges come out sorted by (lower, higher), the uses of an
//! edge by triangle.
//!
//! Degenerate cases: a side from a vertex to itself (a triangle with a repeated corner, which validation rejects) is no
//! edge and gets `EdgeId::NONE`. Triangles with equal corners share edges with two uses each, whatever their number.
//!
//! Cost: linear, plus the sort of buckets (a vertex with a million sides costs a million times its logarithm).

use super::EdgeUse;
use crate::base::csr::Walk;
use crate::base::few::sort_few;
use crate::base::parallel::{self, each_part, ranges, recast, write_parts, write_parts3};
use crate::base::{Csr, EdgeId, TriangleId, VertexId};
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

/// Edges, the edges of each triangle, and the triangles of each edge; fields as in [`super::TriMesh`].
#[derive(Clone, Debug, Default)]
pub struct EdgeTable {
    pub edges: Vec<[VertexId; 2]>,
    pub triangle_edges: Vec<[EdgeId; 3]>,
    pub edge_uses: Csr<EdgeUse>,
}

/// A side in its bucket: higher vertex, triangle, direction and side, so that plain integer order is the order wanted.
/// 31 + 30 + 3 bits; `build` refuses more than 2³¹ vertices or 2³¹/3 triangles.
#[inline(always)]
fn pack(hi: u32, triangle: usize, forward: bool, side: usize) -> u64 {
    (hi as u64) << 33 | (triangle as u64) << 3 | (forward as u64) << 2 | side as u64
}

/// The sides of triangles by lower vertex, packed.
struct Sides<'a>(&'a [[VertexId; 3]]);

// SAFETY: only reads what is borrowed.
unsafe impl Walk<u64> for Sides<'_> {
    fn positions(&self) -> usize {
        self.0.len()
    }
    #[inline]
    fn walk(&self, triangles: Range<usize>, mut visit: impl FnMut(usize, u64)) {
        for (t, corners) in triangles.clone().zip(&self.0[triangles]) {
            for side in 0..3 {
                let (from, to) = (corners[side].0, corners[(side + 1) % 3].0);
                if from != to {
                    visit(from.min(to) as usize, pack(from.max(to), t, from < to, side));
                }
            }
        }
    }
}

/// Finds the edges of `triangles`, whose corners are below `vertex_count`. Shared out among the threads of the current rayon pool.
pub fn edge_table(vertex_count: usize, triangles: &[[VertexId; 3]]) -> EdgeTable {
    let mut sides = Csr::from_walk(vertex_count, &Sides(triangles));
    // Ranges of lower vertices with about as many sides each.
    let total = sides.items.len();
    let bounds: Vec<usize> = ranges(total, LEAST)
        .iter()
        .map(|range| sides.offsets.partition_point(|&o| (o as usize) < range.start))
        .chain([vertex_count])
        .collect();
    let mut parts = Vec::with_capacity(bounds.len());
    let (offsets, mut rest) = (&sides.offsets[..], &mut sides.items[..]);
    for w in bounds.windows(2) {
        let (part, behind) = rest.split_at_mut((offsets[w[1]] - offsets[w[0]]) as usize);
        parts.push((w[0]..w[1], part));
        rest = behind;
    }
    let edge_counts = each_part(parts, |_, (vertices, part)| {
        let (mut start, mut count) = (0, 0);
        for row in offsets[vertices.start..=vertices.end].windows(2) {
            let end = start + (row[1] - row[0]) as usize;
            let bucket = &mut part[start..end];
            sort_few(bucket);
            count += !bucket.is_empty() as usize + bucket.windows(2).filter(|w| w[0] >> 33 != w[1] >> 33).count();
            start = end;
        }
        count
    });
    let first = parallel::offsets(edge_counts.iter().copied());
    // Every side of two vertices has one use, so every place is written once, by whichever thread has the use.
    let lengths: Vec<usize> = ranges(triangles.len(), LEAST).into_iter().map(|range| range.len()).collect();
    let places = write_parts(&lengths, |_, part| part.fill([EdgeId::NONE; 3]));
    // SAFETY: an id is a transparent word, and so is an atomic one.
    let places: Vec<[AtomicU32; 3]> = unsafe { recast(places) };
    let use_counts: Vec<usize> = bounds.windows(2).map(|w| (offsets[w[1]] - offsets[w[0]]) as usize).collect();
    let items = &sides.items;
    let mut row_counts = edge_counts.clone();
    // The end of the last row.
    row_counts[edge_counts.len() - 1] += 1;
    let (edges, rows, uses) = write_parts3([&edge_counts, &row_counts, &use_counts], |i, edges, rows, uses| {
        // One more than the edge at hand.
        let mut next = first[i] as u32;
        for lo in bounds[i]..bounds[i + 1] {
            let mut last = lo as u32;
            for at in offsets[lo]..offsets[lo + 1] {
                let packed = items[at as usize];
                let hi = (packed >> 33) as u32;
                if hi != last {
                    edges.push([VertexId::of(lo), VertexId(hi)]);
                    rows.push(at);
                    next += 1;
                    last = hi;
                }
                let (triangle, code) = (TriangleId((packed >> 3) as u32 & 0x3fff_ffff), packed as u8 & 7);
                uses.push(EdgeUse { triangle, code });
                places[triangle.at()][(code & 3) as usize].store(next - 1, Ordering::Relaxed);
            }
        }
        if i + 1 == edge_counts.len() {
            rows.push(total as u32);
        }
    });
    // SAFETY: an id is a transparent word, and so is an atomic one.
    let triangle_edges = unsafe { recast(places) };
    EdgeTable { edges, triangle_edges, edge_uses: Csr { offsets: rows, items: uses } }
}

/// Sides in one task at least.
const LEAST: usize = 1 << 14;

/// Edges rise strictly, uses rise by triangle, sides and directions agree with the triangles, and each side of each
/// triangle is used once.
pub fn check_edges(
    triangles: &[[VertexId; 3]],
    edges: &[[VertexId; 2]],
    triangle_edges: &[[EdgeId; 3]],
    edge_uses: &Csr<EdgeUse>,
) -> Result<(), String> {
    edge_uses.check()?;
    if edge_uses.len() != edges.len() || triangle_edges.len() != triangles.len() {
        return Err("edges: lengths differ".into());
    }
    if edges.windows(2).any(|w| w[0] >= w[1]) || edges.iter().any(|e| e[0] >= e[1]) {
        return Err("edges are not sorted".into());
    }
    for (e, uses) in edge_uses.rows().enumerate() {
        if uses.is_empty() || uses.windows(2).any(|w| w[0].triangle > w[1].triangle) {
            return Err(format!("edge {e}: its uses are not sorted"));
        }
        for u in uses {
            let corners = triangles[u.triangle.at()];
            let (from, to) = (corners[u.side()], corners[(u.side() + 1) % 3]);
            let expected = if u.forward() { [from, to] } else { [to, from] };
            if edges[e] != expected || triangle_edges[u.triangle.at()][u.side()] != EdgeId::of(e) {
                return Err(format!("edge {e}: a use does not match its triangle {}", u.triangle.0));
            }
        }
    }
    let sides = triangles.iter().flat_map(|&[a, b, c]| [a != b, b != c, c != a]).filter(|&s| s).count();
    if sides != edge_uses.items.len() {
        return Err("the number of edge uses is not the number of sides".into());
    }
    Ok(())
}

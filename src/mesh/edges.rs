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
use crate::base::parallel::{concat, offsets};
use crate::base::{Csr, EdgeId, TriangleId, VertexId};
use rayon::prelude::*;
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

/// The edges from a range of lower vertices: higher vertices, and uses.
struct Part {
    edges: Vec<[VertexId; 2]>,
    uses: Csr<EdgeUse>,
}

/// Finds the edges of `triangles`, whose corners are below `vertex_count`. Each thread of the current rayon pool takes a range of
/// lower vertices, and walks all triangles to find the sides in it.
pub fn edge_table(vertex_count: usize, triangles: &[[VertexId; 3]]) -> EdgeTable {
    let threads = if triangles.len() < 1 << 14 { 1 } else { rayon::current_num_threads() };
    let bound = |i: usize| (vertex_count * i / threads) as u32;
    let part = |i: usize| edges_from(bound(i)..bound(i + 1), triangles);
    let parts: Vec<Part> =
        if threads == 1 { vec![part(0)] } else { (0..threads).into_par_iter().with_max_len(1).map(part).collect() };
    let first = offsets(parts.iter().map(|p| p.edges.len()));
    // Every side has one use, so every place is written once, by whichever thread has the use.
    let sides: Vec<[AtomicU32; 3]> = (0..triangles.len())
        .into_par_iter()
        .with_min_len(1 << 14)
        .map(|_| std::array::from_fn(|_| AtomicU32::new(EdgeId::NONE.0)))
        .collect();
    parts.par_iter().zip(&first).for_each(|(part, &first)| {
        for e in 0..part.edges.len() {
            for u in part.uses.row(e) {
                sides[u.triangle.at()][u.side()].store((first + e) as u32, Ordering::Relaxed);
            }
        }
    });
    let triangle_edges = sides.into_iter().map(|side| side.map(|e| EdgeId(e.into_inner()))).collect();
    let (edges, uses): (Vec<_>, Vec<_>) = parts.into_iter().map(|p| (p.edges, p.uses)).unzip();
    EdgeTable { edges: concat(edges), triangle_edges, edge_uses: Csr::concat(uses) }
}

fn edges_from(range: Range<u32>, triangles: &[[VertexId; 3]]) -> Part {
    // Behind the range for what is before it.
    let bucket = |v: u32| v.wrapping_sub(range.start) as usize;
    let mut ends = vec![0u32; range.len() + 1];
    for &[a, b, c] in triangles {
        for v in [a.0.min(b.0), b.0.min(c.0), c.0.min(a.0)] {
            if let Some(n) = ends.get_mut(bucket(v).wrapping_add(1)) {
                *n += (bucket(v) < range.len()) as u32;
            }
        }
    }
    for v in 0..range.len() {
        ends[v + 1] += ends[v];
    }
    let count = ends[range.len()] as usize;
    let mut sides = vec![0u64; count];
    for (t, &corners) in triangles.iter().enumerate() {
        for side in 0..3 {
            let (from, to) = (corners[side].0, corners[(side + 1) % 3].0);
            let at = bucket(from.min(to));
            if at < range.len() {
                let slot = &mut ends[at];
                sides[*slot as usize] = pack(from.max(to), t, from < to, side);
                *slot += 1;
            }
        }
    }
    // Filling has moved each offset to the end of its bucket, which is the start of the next.
    let mut part = Part { edges: Vec::with_capacity(count / 2 + 1), uses: Csr::with_capacity(count / 2 + 1, count) };
    let mut start = 0;
    for (lo, &end) in range.clone().zip(&ends) {
        let bucket = &mut sides[start..end as usize];
        start = end as usize;
        sort_bucket(bucket);
        emit_bucket(lo, bucket, &mut part);
    }
    part
}

/// Insertion sort for the usual handful, which arrives nearly sorted; the library's sort beyond.
#[inline]
fn sort_bucket(bucket: &mut [u64]) {
    if bucket.len() > 24 {
        bucket.sort_unstable();
        return;
    }
    for i in 1..bucket.len() {
        let x = bucket[i];
        let mut j = i;
        while j > 0 && bucket[j - 1] > x {
            bucket[j] = bucket[j - 1];
            j -= 1;
        }
        bucket[j] = x;
    }
}

#[inline]
fn emit_bucket(lo: u32, bucket: &[u64], part: &mut Part) {
    let mut last = lo;
    for &packed in bucket {
        let hi = (packed >> 33) as u32;
        if hi == lo {
            continue;
        }
        if hi != last {
            if last != lo {
                part.uses.end_row();
            }
            last = hi;
            part.edges.push([VertexId(lo), VertexId(hi)]);
        }
        let triangle = TriangleId((packed >> 3) as u32 & 0x3fff_ffff);
        part.uses.items.push(EdgeUse { triangle, code: packed as u8 & 7 });
    }
    if last != lo {
        part.uses.end_row();
    }
}

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

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
use crate::base::{Csr, EdgeId, TriangleId, VertexId};

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

/// Finds the edges of `triangles`, whose corners are below `vertex_count`.
pub fn edge_table(vertex_count: usize, triangles: &[[VertexId; 3]]) -> EdgeTable {
    let mut offsets = vec![0u32; vertex_count + 1];
    for &[a, b, c] in triangles {
        offsets[a.at().min(b.at()) + 1] += 1;
        offsets[b.at().min(c.at()) + 1] += 1;
        offsets[c.at().min(a.at()) + 1] += 1;
    }
    for v in 0..vertex_count {
        offsets[v + 1] += offsets[v];
    }
    let mut sides = vec![0u64; triangles.len() * 3];
    for (t, &corners) in triangles.iter().enumerate() {
        for side in 0..3 {
            let (from, to) = (corners[side].0, corners[(side + 1) % 3].0);
            let slot = &mut offsets[from.min(to) as usize];
            sides[*slot as usize] = pack(from.max(to), t, from < to, side);
            *slot += 1;
        }
    }
    // Filling has moved each offset to the end of its bucket, which is the start of the next.
    let mut table = EdgeTable {
        edges: Vec::with_capacity(triangles.len() * 3 / 2 + 1),
        triangle_edges: vec![[EdgeId::NONE; 3]; triangles.len()],
        edge_uses: Csr::with_capacity(triangles.len() * 3 / 2 + 1, triangles.len() * 3),
    };
    let mut start = 0;
    for (lo, &end) in offsets[..vertex_count].iter().enumerate() {
        let bucket = &mut sides[start..end as usize];
        start = end as usize;
        sort_bucket(bucket);
        emit_bucket(lo as u32, bucket, &mut table);
    }
    table
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
fn emit_bucket(lo: u32, bucket: &[u64], table: &mut EdgeTable) {
    let mut last = lo;
    for &packed in bucket {
        let hi = (packed >> 33) as u32;
        if hi == lo {
            continue;
        }
        if hi != last {
            if last != lo {
                table.edge_uses.end_row();
            }
            last = hi;
            table.edges.push([VertexId(lo), VertexId(hi)]);
        }
        let edge_use = EdgeUse { triangle: TriangleId((packed >> 3) as u32 & 0x3fff_ffff), code: packed as u8 & 7 };
        table.triangle_edges[edge_use.triangle.at()][edge_use.side()] = EdgeId::of(table.edges.len() - 1);
        table.edge_uses.items.push(edge_use);
    }
    if last != lo {
        table.edge_uses.end_row();
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

//! Edges of the network, and the polygons around each.
//!
//! Every polygon's side is dropped into a bucket of its lower vertex (count, prefix sum, fill); a bucket, a handful of entries, is sorted
//! by upper vertex and polygon. So edges are numbered by their vertices, lexicographically, and no search finds them but one
//! in a bucket.
//!
//! In two dimensions polygons are segments, and what patches meet at are vertices: there an "edge" is a vertex, given as twice itself.
//!
//! Cost: linear in the corners; about 20 bytes an edge remain.

use super::Network;
use crate::base::csr::Walk;
use crate::base::few::sort_few;
use crate::base::parallel::map_ranges;
use crate::base::{Csr, EdgeId, PolygonId, VertexId};
use std::ops::Range;

/// The edges of a network.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edges {
    /// The ends of each edge, the lower vertex first; row `v` has the edges whose lower vertex is `v`, by rising upper vertex.
    pub ends: Csr<[VertexId; 2]>,
    /// The polygons around each edge, rising.
    pub polygons: Csr<PolygonId>,
}

impl Edges {
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.ends.items.len()
    }

    pub fn is_empty(&self) -> bool {
        self.ends.items.is_empty()
    }

    #[inline(always)]
    pub fn ends_of(&self, e: EdgeId) -> [VertexId; 2] {
        self.ends.items[e.at()]
    }

    /// The edge between two vertices.
    #[inline]
    pub fn between(&self, u: VertexId, v: VertexId) -> Option<EdgeId> {
        let (low, high) = (u.min(v), u.max(v));
        let row = self.ends.range(low);
        let edges = &self.ends.items[row.clone()];
        // A bucket holds a handful, except at vertices where very many polygons meet.
        let at = if edges.len() <= 16 {
            edges.iter().position(|e| e[1] == high)
        } else {
            edges.binary_search_by_key(&high, |e| e[1]).ok()
        };
        at.map(|k| EdgeId::of(row.start + k))
    }

    /// Every edge between its ends, every polygon with its sides, once each; loops have two corners or more and no vertex twice.
    pub fn check(&self, network: &Network) -> Result<(), String> {
        self.ends.check()?;
        self.polygons.check()?;
        if self.ends.len() != network.vertex_count() || self.polygons.len() != self.len() {
            return Err("counts of edges differ".into());
        }
        for (v, row) in self.ends.rows().enumerate() {
            let low = if network.dim == 2 { v as u32 } else { v as u32 + 1 };
            if row.iter().any(|e| e[0].at() != v || e[1].0 < low) || row.windows(2).any(|w| w[0] >= w[1]) {
                return Err(format!("edges of vertex {v} are not in order"));
            }
        }
        let mut sides = vec![0u32; network.polygon_count()];
        for (e, row) in self.polygons.rows().enumerate() {
            if row.is_empty() || row.windows(2).any(|w| w[0] >= w[1]) {
                return Err(format!("polygons of edge {e} do not rise"));
            }
            for p in row {
                sides[p.at()] += 1;
                let [u, v] = self.ends.items[e];
                if walk(network, *p, u, v).is_none() {
                    return Err(format!("edge {e} is not a side of polygon {}", p.0));
                }
            }
        }
        match (0..sides.len()).find(|&p| sides[p] as usize != network.polygons.row(p).len()) {
            Some(p) => Err(format!("polygon {p} has sides without an edge")),
            None => Ok(()),
        }
    }
}

/// How a polygon walks an edge: `true` from `u` to `v`; `None` if these are not neighbours in its loop. In two dimensions (`u` = `v`):
/// whether the segment starts there, which is the same question one dimension down: the front is on the left of a
/// segment's way, so turning counterclockwise about its first vertex one meets its back and leaves its front.
pub fn walk(network: &Network, p: PolygonId, u: VertexId, v: VertexId) -> Option<bool> {
    let corners = network.polygons.row(p);
    let at = corners.iter().position(|&c| c == u)?;
    if u == v {
        return Some(at == 0);
    }
    let n = corners.len();
    if corners[if at + 1 == n { 0 } else { at + 1 }] == v {
        Some(true)
    } else if corners[if at == 0 { n - 1 } else { at - 1 }] == v {
        Some(false)
    } else {
        None
    }
}

/// Sides by lower vertex: upper vertex and polygon in one word.
struct Sides<'a>(&'a Network);

// SAFETY: reads borrowed arrays alone.
unsafe impl Walk<u64> for Sides<'_> {
    fn positions(&self) -> usize {
        self.0.polygon_count()
    }
    #[inline]
    fn walk(&self, range: Range<usize>, mut visit: impl FnMut(usize, u64)) {
        let polygons = &self.0.polygons;
        let mut start = polygons.offsets[range.start] as usize;
        for (p, &end) in range.clone().zip(&polygons.offsets[range.start + 1..]) {
            let corners = &polygons.items[start..end as usize];
            start = end as usize;
            let Some(&last) = corners.last() else { continue };
            let mut from = last;
            for &to in corners {
                let (low, high) = (from.min(to), from.max(to));
                visit(low.at(), (high.0 as u64) << 32 | p as u64);
                from = to;
            }
        }
    }
}

/// All edges of a network.
pub fn find_edges(network: &Network) -> Edges {
    let count = network.vertex_count();
    if network.dim == 2 {
        let ends = (0..count).map(|v| [VertexId::of(v); 2]).collect();
        let ends = Csr { offsets: (0..=count as u32).collect(), items: ends };
        return Edges {
            ends,
            polygons: Csr::from_positions(count, network.polygon_count(), |range| {
                range.flat_map(|p| network.polygons.row(p).iter().map(move |v| (v.at(), PolygonId::of(p))))
            }),
        };
    }
    let sides = Csr::from_walk(count, &Sides(network));
    let parts = map_ranges(count, 1 << 12, |range| {
        let here = (sides.offsets[range.end] - sides.offsets[range.start]) as usize;
        let mut ends = Csr::with_capacity(range.len(), here / 2 + 16);
        let mut polygons = Csr::with_capacity(here / 2 + 16, here);
        let mut row = Vec::new();
        for v in range {
            row.clear();
            row.extend_from_slice(sides.row(v));
            sort_few(&mut row);
            let mut last = u64::MAX;
            for &side in &row {
                let high = side >> 32;
                if high != last {
                    if last != u64::MAX {
                        polygons.end_row();
                    }
                    ends.items.push([VertexId::of(v), VertexId(high as u32)]);
                    last = high;
                }
                polygons.items.push(PolygonId(side as u32));
            }
            if last != u64::MAX {
                polygons.end_row();
            }
            ends.end_row();
        }
        (ends, polygons)
    });
    let (ends, polygons) = parts.into_iter().unzip();
    Edges { ends: Csr::concat(ends), polygons: Csr::concat(polygons) }
}

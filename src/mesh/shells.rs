//! From edges to edge-connected components and to shells: triangles joined through wedges of solid.
//!
//! An edge with two uses joins its two triangles. Around an edge with more, the triangles are sorted radially and the
//! solid fills the wedges that run counter-clockwise (about the axis lower → higher vertex) from a triangle that walks
//! the edge backward to the next that walks it forward: the outward normal of a forward triangle points
//! counter-clockwise, that of a backward one clockwise. The two triangles of a wedge belong to one shell.
//!
//! Degenerate cases: on self-intersecting input wedges may overlap or coincide; each backward use is then paired with
//! the nearest free forward use, in a fixed order, and all uses are paired as long as they balance.
//!
//! Cost: linear, and a radial sort per non-manifold edge.

use super::{EdgeUse, TriMesh};
use crate::base::parallel::map_ranges;
use crate::base::{Csr, EdgeId, SharedUnionFind, TriangleId, VertexId};
use crate::exact::{self, Direction, Sign, cyclic::sort_cyclic};
use std::ops::Range;

/// Buffers of the radial sort, reused from edge to edge.
#[derive(Clone, Debug, Default)]
pub struct WedgeScratch {
    around: Vec<EdgeUse>,
    open: Vec<EdgeUse>,
}

/// The surface seen through its edges: what radial order needs.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    pub vertices: &'a [[f64; 3]],
    pub triangles: &'a [[VertexId; 3]],
    pub edges: &'a [[VertexId; 2]],
    pub edge_uses: &'a Csr<EdgeUse>,
}

impl<'a> From<&'a TriMesh> for Surface<'a> {
    fn from(mesh: &'a TriMesh) -> Self {
        Self { vertices: &mesh.vertices, triangles: &mesh.triangles, edges: &mesh.edges, edge_uses: &mesh.edge_uses }
    }
}

/// The corner of a triangle opposite to a use of its edge.
#[inline(always)]
fn apex<'a>(s: &Surface<'a>, u: &EdgeUse) -> &'a [f64; 3] {
    &s.vertices[s.triangles[u.triangle.at()][(u.side() + 2) % 3].at()]
}

/// Sorts uses of `edge` counter-clockwise about the axis from its lower to its higher vertex, starting at the first.
pub fn sort_around(s: Surface, edge: EdgeId, uses: &mut [EdgeUse]) {
    let [lo, hi] = s.edges[edge.at()].map(|v| &s.vertices[v.at()]);
    sort_cyclic(
        uses,
        |a, b| exact::orient3d(lo, hi, apex(&s, a), apex(&s, b)),
        |a, b| {
            let axis = Direction::Between(*lo, *hi);
            let a = Direction::Between(*lo, *apex(&s, a));
            let b = Direction::Between(*lo, *apex(&s, b));
            exact::cross_dot_cross(&axis, &a, &axis, &b) == Sign::Negative
        },
    );
}

/// The wedges of solid at an edge: calls `wedge(backward use, forward use)`; the solid lies counter-clockwise of the
/// first and clockwise of the second, about the axis from the edge's lower to its higher vertex. Unbalanced uses stay
/// without a partner.
pub fn wedges(s: Surface, edge: EdgeId, scratch: &mut WedgeScratch, mut wedge: impl FnMut(EdgeUse, EdgeUse)) {
    let uses = s.edge_uses.row(edge);
    if let [a, b] = *uses {
        if a.forward() != b.forward() {
            if a.forward() { wedge(b, a) } else { wedge(a, b) }
        }
        return;
    }
    let WedgeScratch { around, open } = scratch;
    around.clear();
    around.extend_from_slice(uses);
    sort_around(s, edge, around);
    // Brackets on a circle: backward opens, forward closes. Twice round closes whatever opened late; in the second
    // round a backward use is not opened again, and forward uses that found a partner are marked by a missing triangle.
    open.clear();
    for round in 0..2 {
        for u in around.iter_mut() {
            if !u.forward() {
                if round == 0 {
                    open.push(*u);
                }
            } else if u.triangle.is_some()
                && let Some(back) = open.pop()
            {
                wedge(back, *u);
                u.triangle = crate::base::TriangleId::NONE;
            }
        }
    }
}

/// The wedges of solid at an edge of a mesh, as pairs of a backward and a forward use (see [`wedges`]); `pairs` is
/// cleared first. An edge with two uses has one wedge.
pub fn wedge_mates(mesh: &TriMesh, edge: EdgeId, scratch: &mut WedgeScratch, pairs: &mut Vec<[EdgeUse; 2]>) {
    pairs.clear();
    wedges(mesh.into(), edge, scratch, |back, fore| pairs.push([back, fore]));
}

/// Sets of triangles, numbered by lowest triangle.
#[derive(Clone, Debug, Default)]
pub struct Sets {
    /// The set of each triangle.
    pub of: Vec<u32>,
    /// The lowest triangle of each set.
    pub lowest: Vec<u32>,
}

/// The edge-connected components.
pub fn components(triangle_edges: &[[EdgeId; 3]], edge_uses: &Csr<EdgeUse>) -> Sets {
    let sets = SharedUnionFind::new(triangle_edges.len());
    if neighbours_are_near(edge_uses) {
        let first_use = FirstUse::new(edge_uses);
        sets.join_blocks(LEAST, |range, block| {
            for t in range {
                // Sides of triangles with equal corners, which are defects, are no edges.
                block.join(t, triangle_edges[t].map(|e| if e.is_some() { first_use.of(e).at() } else { t }));
            }
        });
    } else {
        map_ranges(edge_uses.len(), LEAST, |range| {
            for e in range {
                let uses = edge_uses.row(e);
                for u in &uses[1..] {
                    sets.union(uses[0].triangle.at(), u.triangle.at());
                }
            }
        });
    }
    let (of, lowest) = sets.labels(|_| true);
    Sets { of, lowest }
}

/// Whether triangles that share an edge are mostly close to one another in the list, as far as some of the edges tell. Then it is faster to join
/// them triangle by triangle, in blocks; else edge by edge, since looking up a triangle's edges costs more than joining. The outcome is
/// the same. (Icosphere of 1.3 million triangles, each one's four parts side by side: by triangles 13 % faster on
/// two threads, 11 % on one; its parts a quarter of the list apart: 18 % slower.)
pub fn neighbours_are_near(edge_uses: &Csr<EdgeUse>) -> bool {
    const ASKED: usize = 1 << 10;
    const NEAR: u32 = 1 << 10;
    let step = edge_uses.len().div_ceil(ASKED).max(1);
    let asked = (0..edge_uses.len()).step_by(step);
    let near = |&e: &usize| match edge_uses.row(e) {
        [a, b] => b.triangle.0 - a.triangle.0 < NEAR,
        _ => false,
    };
    4 * asked.clone().filter(near).count() >= 3 * asked.len()
}

/// The first use of edges, found in one step where every edge has two uses. Cost: a look at all offsets.
pub struct FirstUse<'a> {
    edge_uses: &'a Csr<EdgeUse>,
    two_each: bool,
}

impl<'a> FirstUse<'a> {
    pub fn new(edge_uses: &'a Csr<EdgeUse>) -> Self {
        let even =
            |range: Range<usize>| range.clone().zip(&edge_uses.offsets[range]).all(|(e, &o)| o as usize == 2 * e);
        let two_each = map_ranges(edge_uses.offsets.len(), LEAST, even).into_iter().all(|even| even);
        Self { edge_uses, two_each }
    }
    /// The lowest triangle at an edge.
    #[inline(always)]
    pub fn of(&self, e: EdgeId) -> TriangleId {
        if self.two_each { self.edge_uses.items[2 * e.at()].triangle } else { self.edge_uses.row(e)[0].triangle }
    }
}

/// Whether one of the edges, all of which balance, has more than two uses.
pub fn has_fans(edge_uses: &Csr<EdgeUse>) -> bool {
    edge_uses.items.len() > 2 * edge_uses.len()
}

/// The shells; `None` where they are the components: without non-manifold edges nothing is computed.
pub fn shells(s: Surface) -> Option<Sets> {
    if !has_fans(s.edge_uses) {
        return None;
    }
    let sets = SharedUnionFind::new(s.triangles.len());
    map_ranges(s.edges.len(), LEAST, |range| {
        let mut scratch = WedgeScratch::default();
        for e in range {
            wedges(s, EdgeId::of(e), &mut scratch, |a, b| sets.union(a.triangle.at(), b.triangle.at()));
        }
    });
    let (of, lowest) = sets.labels(|_| true);
    Some(Sets { of, lowest })
}

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

//! The active simplices of a mesh, and the edges that the network crosses, with their points.
//!
//! Edges have no numbers in a mesh: those of active simplices go into the buckets of their lower nodes (count, prefix sum, fill), are sorted there by the
//! higher node, and numbered in that order. Cost: linear in simplices, and small sorts.

use super::data::Values;
use super::points::{Edge, EdgePoints, EdgeWork, Span, arrangement_points, interface_points, share_material};
use super::signs::{Label, NodeSigns};
use super::table::EDGES;
use super::tet_mesh::TetMesh;
use crate::base::parallel::{concat, map_ranges};
use crate::base::{Csr, FunctionId, NodeId, TetId};
use std::ops::Range;

/// Simplices or edges in one task at least.
const LEAST: usize = 1 << 12;

pub struct MeshEdges<'a> {
    mesh: &'a TetMesh,
    /// Active simplices, rising.
    pub active: Vec<TetId>,
    /// The number of each of their edges (as in [`EDGES`]).
    edges: Vec<[u32; 6]>,
    /// The first vertex on each edge, and the end.
    first: Vec<u32>,
    /// The ends of each edge, lower first.
    ends: Vec<[NodeId; 2]>,
    /// Of each point.
    functions: Csr<FunctionId>,
    /// Edges that were worked on together.
    parts: Vec<Range<usize>>,
}

impl EdgePoints for MeshEdges<'_> {
    fn functions(&self) -> &Csr<FunctionId> {
        &self.functions
    }

    fn take_functions(&mut self) -> Csr<FunctionId> {
        std::mem::take(&mut self.functions)
    }

    fn lengths(&self) -> Vec<usize> {
        self.parts.iter().map(|r| (self.first[r.end] - self.first[r.start]) as usize).collect()
    }

    fn edges(&self, part: usize, mut visit: impl FnMut(&Edge, u32)) {
        for e in self.parts[part].clone() {
            visit(&edge_of(self.mesh, self.ends[e]), self.first[e + 1] - self.first[e]);
        }
    }
}

#[inline(always)]
fn edge_of(mesh: &TetMesh, nodes: [NodeId; 2]) -> Edge {
    Edge { nodes, places: nodes.map(|n| mesh.vertices[n.at()]) }
}

impl MeshEdges<'_> {
    /// The points on an edge of the simplex at a place of `active`; it must have some.
    #[inline(always)]
    pub fn span(&self, at: usize, edge: usize) -> Span {
        let e = self.edges[at][edge] as usize;
        Span { first: self.first[e], count: self.first[e + 1] - self.first[e] }
    }
}

fn build<'a>(
    mesh: &'a TetMesh,
    active: impl Fn(&[NodeId]) -> bool + Sync,
    crossed: impl Fn(NodeId, NodeId) -> bool + Sync,
    points: impl Fn(&Edge, &mut EdgeWork, &mut Csr<FunctionId>) -> u32 + Sync,
) -> MeshEdges<'a> {
    let found = concat(map_ranges(mesh.tets.len(), LEAST, |range| {
        let mut found = Vec::new();
        for t in range {
            let nodes = &mesh.tets[t][..=mesh.dim];
            if active(nodes) {
                let mut mask = 0u8;
                for (e, &[a, b]) in EDGES.iter().enumerate() {
                    if b < nodes.len() && crossed(nodes[a], nodes[b]) {
                        mask |= 1 << e;
                    }
                }
                found.push((TetId::of(t), mask));
            }
        }
        found
    }));
    // Edges of active simplices, each time one has it.
    let mut uses = Csr::from_positions(mesh.vertices.len(), found.len(), |range| {
        range.flat_map(|at| {
            let (tet, crossed) = found[at];
            let nodes = &mesh.tets[tet.at()];
            EDGES.iter().enumerate().filter(move |(e, _)| crossed >> e & 1 == 1).map(move |(e, &[a, b])| {
                let (a, b) = (nodes[a], nodes[b]);
                (a.min(b).at(), (a.max(b), (at * 6 + e) as u32))
            })
        })
    });
    let mut numbers = vec![[u32::MAX; 6]; found.len()];
    let mut ends: Vec<[NodeId; 2]> = Vec::new();
    for low in 0..mesh.vertices.len() {
        let row = uses.row_mut(low);
        row.sort_unstable();
        for same in row.chunk_by(|a, b| a.0 == b.0) {
            for &(_, at) in same {
                numbers[at as usize / 6][at as usize % 6] = ends.len() as u32;
            }
            ends.push([NodeId::of(low), same[0].0]);
        }
    }
    let parts = map_ranges(ends.len(), LEAST, |range| {
        let (mut counts, mut out, mut work) = (Vec::new(), Csr::default(), EdgeWork::default());
        for &nodes in &ends[range.clone()] {
            counts.push(points(&edge_of(mesh, nodes), &mut work, &mut out));
        }
        (range, counts, out)
    });
    let (mut first, mut functions, mut ranges) = (vec![0], Vec::new(), Vec::new());
    let mut sum = 0;
    for (range, counts, f) in parts {
        first.extend(counts.iter().map(|n| {
            sum += n;
            sum
        }));
        functions.push(f);
        ranges.push(range);
    }
    let active = found.iter().map(|a| a.0).collect();
    MeshEdges { mesh, active, edges: numbers, first, ends, functions: Csr::concat(functions), parts: ranges }
}

/// Of an arrangement: active are simplices where some function is neither positive nor negative at all corners.
pub fn arrangement_edges<'a>(mesh: &'a TetMesh, values: &Values, signs: &NodeSigns) -> MeshEdges<'a> {
    let active = |nodes: &[NodeId]| (0..signs.words).any(|w| active_word(signs, nodes, w, values.len()) != 0);
    let crossed = |a, b| signs.of(a).iter().zip(signs.of(b)).any(|(a, b)| a.crossing(*b) != 0);
    build(mesh, active, crossed, |edge, work, out| {
        let [a, b] = edge.nodes.map(|n| signs.of(n));
        let crossing =
            (0..signs.words).flat_map(|w| bits(a[w].crossing(b[w])).map(move |f| FunctionId::of(w * 64 + f)));
        let zero =
            |w: usize| !(a[w].positive | a[w].negative | b[w].positive | b[w].negative) & in_word(w, values.len());
        let zeros = (0..signs.words).any(|w| zero(w) != 0);
        arrangement_points(values, edge, crossing, zeros, work, out)
    })
}

/// The functions of a word that there are.
#[inline(always)]
fn in_word(w: usize, functions: usize) -> u64 {
    u64::MAX >> (64 - 64.min(functions - w * 64))
}

/// The active functions in word w.
#[inline(always)]
pub fn active_word(signs: &NodeSigns, nodes: &[NodeId], w: usize, functions: usize) -> u64 {
    let (mut positive, mut negative) = (u64::MAX, u64::MAX);
    for &n in nodes {
        positive &= signs.of(n)[w].positive;
        negative &= signs.of(n)[w].negative;
    }
    !(positive | negative) & in_word(w, functions)
}

/// Set bits, rising.
pub fn bits(mut word: u64) -> impl Iterator<Item = usize> + Clone {
    std::iter::from_fn(move || {
        let bit = (word != 0).then(|| word.trailing_zeros() as usize);
        word &= word.wrapping_sub(1);
        bit
    })
}

/// Of an interface: active are simplices where not one material alone is the largest at all corners.
pub fn interface_edges<'a>(mesh: &'a TetMesh, values: &Values, labels: &[Label]) -> MeshEdges<'a> {
    let differ = |a: NodeId, b: NodeId| labels[a.at()].difference(labels[b.at()]) != 0;
    let active = |nodes: &[NodeId]| nodes.iter().any(|&n| differ(nodes[0], n));
    let crossed = |a: NodeId, b: NodeId| {
        let tied = labels[a.at()].tied() || labels[b.at()].tied();
        differ(a, b) && !(tied && share_material(values, a, b))
    };
    build(mesh, active, crossed, |edge, work, out| interface_points(values, edge, work, out))
}

//! Patches: polygons joined across manifold edges, and components: patches that share a vertex.
//!
//! An edge is *manifold* if exactly two polygons meet there, on the same functions (of an interface: between the same two materials), and it
//! is not on the boundary of the domain. It is *open* if it has one polygon: the patch ends there, at the domain's boundary or
//! around a zero piece with equal signs on both sides. All other edges are *chain edges*.
//!
//! Across a manifold edge front continues front: there are two wedges around it, so the labels on the sides of both polygons are the same two, and
//! the normal follows from the labels. Only polygons with equal labels on both sides have a normal by accident of numbering; of
//! a patch of such, a flood finds which are turned against its lowest polygon, and whether the patch has one side only (a Möbius band).
//!
//! Why an edge on the domain's boundary is not manifold: outside lies between its two polygons on one side, so what is before the one need not be
//! connected with what is before the other. There may be such edges only where a function vanishes at a node or functions meet on
//! an edge of the domain, so that elsewhere no edge is looked at twice.
//!
//! Cost: linear, a few nanoseconds a corner.

use super::carrier::{edge_carrier, node_count, on_boundary};
use super::edges::{Edges, walk};
use super::{Domain, Network};
use crate::base::parallel::{concat, map_ranges};
use crate::base::{ComponentId, EdgeId, PatchId, PolygonId, SharedUnionFind, TetId, VertexId};
use crate::exact::Sign;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// One side of a patch: `patch << 1 | front`; the front is where the normals of its polygons point to (of a patch whose
/// polygons do not agree, the normal of its lowest polygon).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct HalfPatch(pub u32);

impl HalfPatch {
    #[inline(always)]
    pub fn new(patch: PatchId, front: bool) -> Self {
        Self(patch.0 << 1 | front as u32)
    }
    #[inline(always)]
    pub fn patch(self) -> PatchId {
        PatchId(self.0 >> 1)
    }
    #[inline(always)]
    pub fn front(self) -> bool {
        self.0 & 1 != 0
    }
    #[inline(always)]
    pub fn other(self) -> Self {
        Self(self.0 ^ 1)
    }
    #[inline(always)]
    pub fn at(self) -> usize {
        self.0 as usize
    }
}

/// The patches of a network. Numbered by their lowest polygons, as are components.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patches {
    /// The patch of each polygon.
    pub of: Vec<PatchId>,
    /// The lowest polygon of each patch.
    pub lowest: Vec<PolygonId>,
    /// One bit for each polygon: its normal is against that of the lowest polygon of its patch. Empty if there is none.
    pub turned: Vec<u64>,
    /// Patches whose two sides are one (Möbius bands, and those with an open edge inside the domain), rising.
    pub one_sided: Vec<PatchId>,
    /// One bit for each edge: a chain edge.
    pub chain_bits: Vec<u64>,
    /// The chain edges, rising.
    pub chain_edges: Vec<EdgeId>,
    /// The component of each patch.
    pub component: Vec<ComponentId>,
    pub component_count: usize,
    /// The lowest patch at each vertex.
    pub at_vertex: Vec<PatchId>,
}

#[inline(always)]
fn bit(bits: &[u64], i: usize) -> bool {
    bits.get(i / 64).is_some_and(|w| w >> (i % 64) & 1 != 0)
}

impl Patches {
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.lowest.len()
    }

    pub fn is_empty(&self) -> bool {
        self.lowest.is_empty()
    }

    #[inline(always)]
    pub fn is_chain_edge(&self, e: EdgeId) -> bool {
        bit(&self.chain_bits, e.at())
    }

    /// The side of the patch that one side of a polygon belongs to.
    #[inline(always)]
    pub fn side(&self, p: PolygonId, front: bool) -> HalfPatch {
        HalfPatch::new(self.of[p.at()], front ^ bit(&self.turned, p.at()))
    }

    /// Polygons of a patch lie on the same functions; patches and components are numbered by lowest polygon; an edge that is neither chain nor
    /// open has two polygons of one patch.
    pub fn check(&self, network: &Network, edges: &Edges) -> Result<(), String> {
        if self.of.len() != network.polygon_count() || self.at_vertex.len() != network.vertex_count() {
            return Err("counts of patches differ".into());
        }
        let mut seen = 0;
        for (p, patch) in self.of.iter().enumerate() {
            if patch.at() > seen || patch.at() >= self.len() {
                return Err(format!("patch of polygon {p} is not numbered by its lowest polygon"));
            }
            if patch.at() == seen {
                if self.lowest[seen].at() != p {
                    return Err(format!("polygon {p} is the lowest of patch {seen}"));
                }
                seen += 1;
            }
            if network.polygon_set[p] != network.polygon_set[self.lowest[patch.at()].at()] {
                return Err(format!("patch {} lies on two sets of functions", patch.0));
            }
        }
        let mut next = 0;
        for &c in &self.component {
            if c.at() > next {
                return Err("components are not numbered by their lowest patches".into());
            }
            next += (c.at() == next) as usize;
        }
        if seen != self.len() || next != self.component_count {
            return Err("counts of patches differ".into());
        }
        let mut chain_edges = self.chain_edges.iter().copied();
        for (e, row) in edges.polygons.rows().enumerate() {
            let e = EdgeId::of(e);
            if self.is_chain_edge(e) {
                if chain_edges.next() != Some(e) || row.len() == 1 {
                    return Err(format!("chain edge {}", e.0));
                }
            } else if row.len() > 2 || row.iter().any(|p| self.of[p.at()] != self.of[row[0].at()]) {
                return Err(format!("edge {} joins two patches", e.0));
            }
        }
        Ok(())
    }
}

/// Whether there may be edges on the domain's boundary with several polygons: some vertex is at a node, or on an edge of the domain with
/// more functions than one (of an interface: more materials than two).
pub fn has_ties(network: &Network) -> bool {
    let plain = match network.kind {
        super::Kind::Arrangement => 1,
        super::Kind::Interface => 2,
    };
    let found = map_ranges(network.vertex_count(), 1 << 14, |range| {
        let functions = &network.vertex_functions.offsets[range.start..=range.end];
        network.vertex_nodes[range]
            .iter()
            .zip(functions.windows(2))
            .any(|(nodes, w)| nodes[1].is_none() || (network.dim == 3 && nodes[2].is_none() && w[1] - w[0] != plain))
    });
    found.contains(&true)
}

/// Joins polygons across manifold edges.
pub fn find_patches(network: &Network, domain: &Domain, edges: &Edges) -> Patches {
    let ties = has_ties(network);
    let classes = SharedUnionFind::new(network.polygon_count());
    let set = |p: PolygonId| network.polygon_set[p.at()];
    let chain_edges = concat(map_ranges(edges.len(), 1 << 13, |range| {
        let (mut chain_edges, mut around) = (Vec::new(), Vec::new());
        for e in range.map(EdgeId::of) {
            match *edges.polygons.row(e) {
                [_] => {}
                [p, q]
                    if set(p) == set(q) && !(ties && at_boundary(network, domain, edges.ends_of(e), &mut around)) =>
                {
                    classes.union(p.at(), q.at());
                }
                _ => chain_edges.push(e),
            }
        }
        chain_edges
    }));
    let mut chain_bits = vec![0u64; if chain_edges.is_empty() { 0 } else { edges.len().div_ceil(64) }];
    chain_edges.iter().for_each(|e| chain_bits[e.at() / 64] |= 1 << (e.at() % 64));
    let (of, lowest) = classes.labels(|_| true);
    let mut patches = Patches {
        of: of.into_iter().map(PatchId).collect(),
        lowest: lowest.into_iter().map(PolygonId).collect(),
        chain_bits,
        chain_edges,
        ..Patches::default()
    };
    find_components(network, &mut patches);
    turn(network, domain, edges, &mut patches);
    patches
}

/// Whether an edge with two polygons is on the domain's boundary. Inside a facet there it would have both of them in one simplex, cut by
/// a third one; so only edges of the domain are asked.
fn at_boundary(network: &Network, domain: &Domain, [u, v]: [VertexId; 2], around: &mut Vec<TetId>) -> bool {
    if network.vertex_nodes[u.at()][2].is_some() || network.vertex_nodes[v.at()][2].is_some() {
        return false;
    }
    let carrier = edge_carrier(network, u, v);
    node_count(&carrier) < network.dim && on_boundary(domain, &carrier, around)
}

/// Patches with a common vertex. Of the patches at a vertex each meets, in whatever order they come, one that is there or was there before a lower
/// one; so all are joined, and the lowest stays.
fn find_components(network: &Network, patches: &mut Patches) {
    let at_vertex: Vec<AtomicU32> =
        (0..network.vertex_count()).into_par_iter().with_min_len(1 << 14).map(|_| AtomicU32::new(u32::MAX)).collect();
    let classes = SharedUnionFind::new(patches.len());
    let alone = rayon::current_num_threads() == 1;
    map_ranges(network.polygon_count(), 1 << 13, |range| {
        let mut start = network.polygons.offsets[range.start] as usize;
        let ends = &network.polygons.offsets[range.start + 1..=range.end];
        for (&end, &patch) in ends.iter().zip(&patches.of[range]) {
            for v in &network.polygons.items[start..end as usize] {
                let place = &at_vertex[v.at()];
                let mut here = place.load(Ordering::Relaxed);
                if here == patch.0 {
                    continue;
                }
                if patch.0 < here {
                    if alone {
                        place.store(patch.0, Ordering::Relaxed);
                    } else {
                        here = place.fetch_min(patch.0, Ordering::Relaxed);
                    }
                }
                if here != u32::MAX && here != patch.0 {
                    classes.union(here as usize, patch.at());
                }
            }
            start = end as usize;
        }
    });
    let (of, lowest) = classes.labels(|_| true);
    patches.component = of.into_iter().map(ComponentId).collect();
    patches.component_count = lowest.len();
    patches.at_vertex = at_vertex.into_iter().map(|patch| PatchId(patch.into_inner())).collect();
}

/// Finds which polygons of patches without a normal are turned, and which patches have one side only: for their form, or because one
/// comes from one side to the other around an open edge inside the domain.
fn turn(network: &Network, domain: &Domain, edges: &Edges, patches: &mut Patches) {
    let flat = |set: &[super::SetItem]| set.iter().all(|item| item.orientation == Sign::Zero);
    let flat_sets: Vec<bool> = network.sets.rows().map(flat).collect();
    if !flat_sets.contains(&true) {
        return;
    }
    patches.turned = vec![0u64; network.polygon_count().div_ceil(64)];
    let mut reached = vec![0u64; network.polygon_count().div_ceil(64)];
    let (mut stack, mut around) = (Vec::new(), Vec::new());
    for patch in 0..patches.len() {
        let first = patches.lowest[patch];
        if !flat_sets[network.polygon_set[first.at()].at()] {
            continue;
        }
        reached[first.at() / 64] |= 1 << (first.at() % 64);
        stack.push(first);
        let mut one_sided = false;
        while let Some(p) = stack.pop() {
            let corners = network.polygons.row(p);
            for (k, &v) in corners.iter().enumerate() {
                let u = if network.dim == 2 { v } else { corners[if k == 0 { corners.len() - 1 } else { k - 1 }] };
                let e = edges.between(u, v).expect("a side of a polygon is an edge");
                let [a, b] = match *edges.polygons.row(e) {
                    _ if patches.is_chain_edge(e) => continue,
                    [_] => {
                        one_sided |= !on_boundary(domain, &edge_carrier(network, u, v), &mut around);
                        continue;
                    }
                    ref row => [row[0], row[1]],
                };
                let q = if a == p { b } else { a };
                // Polygons that agree walk their common edge in opposite ways.
                let turned = bit(&patches.turned, p.at()) ^ (walk(network, p, u, v) == walk(network, q, u, v));
                let word = 1u64 << (q.at() % 64);
                if reached[q.at() / 64] & word == 0 {
                    reached[q.at() / 64] |= word;
                    patches.turned[q.at() / 64] |= word * turned as u64;
                    stack.push(q);
                } else {
                    one_sided |= bit(&patches.turned, q.at()) != turned;
                }
            }
        }
        if one_sided {
            patches.one_sided.push(PatchId::of(patch));
        }
    }
}

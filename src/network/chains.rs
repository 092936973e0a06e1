//! Chains: maximal paths and loops of chain edges along which the same sheets meet; and corners, where they end.
//!
//! A vertex with two chain edges is passed through if each polygon around the one continues, across manifold edges around the vertex, as a
//! polygon around the other. Then the order around both is the same: on a small sphere about the vertex the sheets are disjoint arcs from one
//! point to another, and no arc can leave the order, nor change its sides. So one edge of each chain tells the order of patches around all of it.
//! (Patches alone do not tell: two sheets of one patch that join before the second edge would be counted as two that pass.)
//! An edge on the domain's boundary does not continue inside, nor past a node of the boundary, where the domain may do what it likes.
//!
//! In two dimensions chain "edges" are vertices ([`super::edges`]); each is a chain of its own, and a corner.
//!
//! Cost: linear in the chain edges, times the polygons at a vertex.

use super::carrier::{edge_carrier, node_count, on_boundary};
use super::edges::Edges;
use super::local::Setting;
use super::patches::{HalfPatch, Patches};
use super::radial::{self, Around};
use crate::base::parallel::map_ranges;
use crate::base::{Csr, EdgeId, PatchId, PolygonId, Result, TetId, VertexId};
use rayon::prelude::*;

/// The chains of a network, numbered by their lowest edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chains {
    /// The edges of each chain, along it.
    pub edges: Csr<EdgeId>,
    /// The vertices of each chain: one more than edges; a loop begins and ends with the same one. A path begins at its lower end (at the end with
    /// the lower edge, if both are one corner), a loop with its lowest edge, from its lower end. In two dimensions: its vertex alone.
    pub vertices: Csr<VertexId>,
    /// Whether a chain closes without a corner.
    pub is_loop: Vec<bool>,
    /// The order of patches around each chain: counterclockwise about its direction, the side of each that is met first.
    pub around: Csr<HalfPatch>,
    /// For each item of `around`: from there to the next one the way leads out of the domain.
    pub gap: Vec<bool>,
    /// The vertices where chains end, rising.
    pub corners: Vec<VertexId>,
}

impl Chains {
    pub fn len(&self) -> usize {
        self.edges.len()
    }

    pub fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// Pairs of half-patches that bound one wedge around a chain.
    pub fn wedges(&self, chain: usize) -> impl Iterator<Item = [HalfPatch; 2]> {
        let range = self.around.range(chain);
        let (around, gap) = (&self.around.items[range.clone()], &self.gap[range]);
        let next = |k: usize| around[if k + 1 == around.len() { 0 } else { k + 1 }];
        (0..around.len()).filter(|&k| !gap[k]).map(move |k| [around[k].other(), next(k)])
    }

    /// Each chain edge in one chain, vertices between them, chains end at corners, as many polygons as patches around.
    pub fn check(&self, edges: &Edges, patches: &Patches, dim: usize) -> std::result::Result<(), String> {
        self.edges.check()?;
        self.vertices.check()?;
        self.around.check()?;
        let mut all: Vec<EdgeId> = self.edges.items.clone();
        all.sort_unstable();
        if all != patches.chain_edges || self.around.items.len() != self.gap.len() {
            return Err("chains do not have the chain edges once each".into());
        }
        for c in 0..self.len() {
            let (path, vertices) = (self.edges.row(c), self.vertices.row(c));
            if vertices.len() != path.len() + (dim == 3) as usize {
                return Err(format!("chain {c} has {} vertices", vertices.len()));
            }
            for (k, e) in path.iter().enumerate() {
                let mut ends = [vertices[k], vertices[if dim == 2 { k } else { k + 1 }]];
                ends.sort_unstable();
                if ends != edges.ends_of(*e) {
                    return Err(format!("edge {} is not where chain {c} has it", e.0));
                }
                if edges.polygons.row(*e).len() != self.around.row(c).len() {
                    return Err(format!("chain {c} has other patches at edge {}", e.0));
                }
                let mut here: Vec<PatchId> = edges.polygons.row(*e).iter().map(|p| patches.of[p.at()]).collect();
                let mut around: Vec<PatchId> = self.around.row(c).iter().map(|h| h.patch()).collect();
                here.sort_unstable();
                around.sort_unstable();
                if here != around {
                    return Err(format!("chain {c} has other patches at edge {}", e.0));
                }
            }
            let (first, last) = (vertices[0], vertices[vertices.len() - 1]);
            let corner = |v: &VertexId| self.corners.binary_search(v).is_ok();
            if self.is_loop[c] == corner(&first)
                || corner(&first) != corner(&last)
                || (self.is_loop[c] && first != last)
            {
                return Err(format!("chain {c} does not end at corners"));
            }
            if vertices.iter().skip(1).take(path.len().saturating_sub(1)).any(corner) {
                return Err(format!("chain {c} passes a corner"));
            }
        }
        Ok(())
    }
}

/// Chain edges by position in `Patches::chain_edges`; which one follows at each end, if the way passes.
type Links = Vec<[u32; 2]>;
const NONE: u32 = u32::MAX;

/// Traces the chains, and finds the order of patches around each.
pub fn find_chains(setting: &Setting, edges: &Edges, patches: &Patches) -> Result<Chains> {
    let mut chains = Chains::default();
    let links = if setting.network.dim == 2 {
        chains.corners = patches.chain_edges.iter().map(|&e| edges.ends_of(e)[0]).collect();
        vec![[NONE; 2]; patches.chain_edges.len()]
    } else {
        link(setting, edges, patches, &mut chains.corners)
    };
    trace(setting, edges, patches, &links, &mut chains);
    let parts = map_ranges(chains.len(), 64, |range| {
        let mut scratch = radial::Scratch::default();
        let mut row: Vec<Around> = Vec::new();
        let (mut around, mut gap) = (Csr::default(), Vec::new());
        for c in range {
            let path = chains.vertices.row(c);
            let ends = [path[0], path[(path.len() > 1) as usize]];
            let carrier = edge_carrier(setting.network, ends[0], ends[1]);
            let polygons = edges.polygons.row(chains.edges.row(c)[0]);
            radial::around_edge(setting, ends, &carrier, polygons, &mut scratch, &mut row)?;
            around.items.extend(row.iter().map(|a| a.near(patches)));
            gap.extend(row.iter().map(|a| a.gap));
            around.end_row();
        }
        Ok((around, gap))
    });
    let (around, gap): (Vec<_>, Vec<_>) = parts.into_iter().collect::<Result<Vec<_>>>()?.into_iter().unzip();
    chains.around = Csr::concat(around);
    chains.gap = crate::base::parallel::concat(gap);
    Ok(chains)
}

/// Which chain edges continue each other.
fn link(setting: &Setting, edges: &Edges, patches: &Patches, corners: &mut Vec<VertexId>) -> Links {
    let mut ends: Vec<(VertexId, u32, u8)> = Vec::with_capacity(2 * patches.chain_edges.len());
    for (k, &e) in patches.chain_edges.iter().enumerate() {
        let [u, v] = edges.ends_of(e);
        ends.extend([(u, k as u32, 0), (v, k as u32, 1)]);
    }
    ends.par_sort_unstable();
    // What begins in each part of the list: whole vertices.
    let vertex_at = |at: usize| ends.get(at).map_or(VertexId::NONE, |end| end.0);
    let begin = |at: usize| {
        let started = at > 0 && vertex_at(at - 1) == vertex_at(at);
        if started { at + ends[at..].iter().take_while(|end| end.0 == ends[at].0).count() } else { at }
    };
    let parts = map_ranges(ends.len(), 1 << 10, |range| {
        let (mut found, mut corners, mut around) = (Vec::new(), Vec::new(), Vec::new());
        let whole = begin(range.start)..begin(range.end).max(begin(range.start));
        for here in ends[whole].chunk_by(|a, b| a.0 == b.0) {
            let v = here[0].0;
            if let &[(_, a, side_a), (_, b, side_b)] = here {
                let [from, to] = [a, b].map(|k| patches.chain_edges[k as usize]);
                if passes(setting, edges, patches, v, from, to, &mut around) {
                    found.push([(a, side_a), (b, side_b)]);
                    continue;
                }
            }
            corners.push(v);
        }
        (found, corners)
    });
    let mut links = vec![[NONE; 2]; patches.chain_edges.len()];
    for (found, here) in parts {
        for [(a, side_a), (b, side_b)] in found {
            links[a as usize][side_a as usize] = b;
            links[b as usize][side_b as usize] = a;
        }
        corners.extend(here);
    }
    links
}

/// Whether all polygons around one chain edge at a vertex continue as polygons around the other.
fn passes(
    setting: &Setting,
    edges: &Edges,
    patches: &Patches,
    v: VertexId,
    from: EdgeId,
    to: EdgeId,
    around: &mut Vec<TetId>,
) -> bool {
    let row = edges.polygons.row(from);
    if row.len() != edges.polygons.row(to).len() {
        return false;
    }
    if !row.iter().all(|&p| arrives(setting, edges, patches, v, from, to, p)) {
        return false;
    }
    // Edges at a vertex inside the domain are inside it.
    let nodes = &setting.network.vertex_nodes[v.at()];
    if !on_boundary(setting.domain, nodes, around) {
        return true;
    }
    let mut outer = |e: EdgeId| {
        let [a, b] = edges.ends_of(e);
        on_boundary(setting.domain, &edge_carrier(setting.network, a, b), around)
    };
    match (outer(from), outer(to)) {
        (false, false) => true,
        (true, true) => node_count(nodes) > 1,
        _ => false,
    }
}

/// Follows a polygon from one chain edge around a vertex, across manifold edges; true if that ends at the other chain edge.
fn arrives(
    setting: &Setting,
    edges: &Edges,
    patches: &Patches,
    v: VertexId,
    from: EdgeId,
    to: EdgeId,
    first: PolygonId,
) -> bool {
    let (mut e, mut p) = (from, first);
    loop {
        let corners = setting.network.polygons.row(p);
        let at = corners.iter().position(|&c| c == v).expect("a polygon at the vertex");
        let before = corners[if at == 0 { corners.len() - 1 } else { at - 1 }];
        let after = corners[if at + 1 == corners.len() { 0 } else { at + 1 }];
        let [a, b] = edges.ends_of(e);
        let came_from = if a == v { b } else { a };
        let far = if before == came_from { after } else { before };
        e = edges.between(v, far).expect("a side of a polygon is an edge");
        if patches.is_chain_edge(e) {
            return e == to;
        }
        match *edges.polygons.row(e) {
            [a, b] => p = if a == p { b } else { a },
            _ => return false,
        }
    }
}

/// Walks along the links.
fn trace(setting: &Setting, edges: &Edges, patches: &Patches, links: &Links, chains: &mut Chains) {
    let mut done = vec![false; links.len()];
    let ends = |k: u32| edges.ends_of(patches.chain_edges[k as usize]);
    // The edge after `k`, and whether it is walked forward, when `k` is left at its upper end (`forward`) or its lower one.
    let step = |k: u32, forward: bool| {
        let next = links[k as usize][forward as usize];
        (next != NONE).then(|| (next, ends(next)[0] == ends(k)[forward as usize]))
    };
    for k in 0..links.len() as u32 {
        if done[k as usize] {
            continue;
        }
        // Back to where it begins.
        let (mut at, mut forward, mut is_loop) = (k, true, false);
        while let Some((before, up)) = step(at, !forward) {
            (at, forward) = (before, !up);
            if at == k {
                is_loop = true;
                break;
            }
        }
        if is_loop {
            (at, forward) = (k, true);
        } else {
            // To the other end as well, to choose.
            let (mut end, mut up) = (at, forward);
            while let Some(next) = step(end, up) {
                (end, up) = next;
            }
            let (first, last) = (ends(at)[!forward as usize], ends(end)[up as usize]);
            if (last, end) < (first, at) {
                (at, forward) = (end, !up);
            }
        }
        let first_vertex = ends(at)[!forward as usize];
        chains.vertices.items.push(first_vertex);
        loop {
            done[at as usize] = true;
            chains.edges.items.push(patches.chain_edges[at as usize]);
            if setting.network.dim == 3 {
                chains.vertices.items.push(ends(at)[forward as usize]);
            }
            match step(at, forward) {
                Some((next, up)) if !done[next as usize] => (at, forward) = (next, up),
                _ => break,
            }
        }
        chains.edges.end_row();
        chains.vertices.end_row();
        chains.is_loop.push(is_loop);
    }
}

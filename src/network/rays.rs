//! Topological ray shooting (section 7.1 of the networks paper): which shells bound the same region of a box.
//!
//! One ray leaves each component of the network, from its vertex on the lowest edge of the grid (by lower node, then by place along the edge),
//! towards the edge's lower node, and goes on along edges of the grid to lower and lower nodes, until it meets the network again or ends at node 0.
//! It never meets its own component: all edges on its way are lower. So the shells at its two ends bound one region; together the rays of all
//! components join all that belong together (appendix A). Nodes are ordered by number, which is the lexicographic order of (z, y, x); every node but 0 has
//! a lower neighbour, along an axis.
//!
//! It holds where the domain is a box and no vertex of the network is at a node. (Then no polygon has one region on both sides.) Another method
//! is used elsewhere, and where a ray ends at a vertex in which several functions meet: see [`super::regions`].
//!
//! Cost: one pass over the vertices; the length of the rays in edges, times the vertices of one row of nodes.

use super::data::SetItem;
use super::local::Setting;
use super::patches::{HalfPatch, Patches};
use super::runs::node_vertices;
use super::shells::Shells;
use super::{Domain, Kind};
use crate::base::parallel::map_ranges;
use crate::base::{FunctionId, NodeId, UnionFind, VertexId};
use crate::exact::Sign;

/// The side of the network at a vertex on an open edge of the domain that looks to one end of the edge; `None` if functions that are not all on one
/// polygon meet there. A single sign of a function tells, or of a difference of two materials.
pub fn looking_to(setting: &Setting, patches: &Patches, v: VertexId, node: NodeId) -> Option<HalfPatch> {
    let network = setting.network;
    let patch = patches.at_vertex[v.at()];
    let set: &[SetItem] = network.set_of(patches.lowest[patch.at()].at());
    if !network.vertex_functions.row(v).iter().copied().eq(set.iter().map(|item| item.function)) {
        return None;
    }
    let value = |f: FunctionId| setting.values.at(f, node);
    let sign = match network.kind {
        Kind::Arrangement => Sign::of(value(set[0].function)),
        Kind::Interface => {
            let order = value(set[0].function).partial_cmp(&value(set[1].function));
            Sign::from_ordering(order.expect("values are finite"))
        }
    };
    match (sign, set[0].orientation) {
        (Sign::Zero, _) | (_, Sign::Zero) => None,
        (sign, orientation) => Some(HalfPatch::new(patch, sign == orientation)),
    }
}

/// Joins shells that bound one region; member `shells.len()` stands for node 0. `None` if the method does not hold.
pub fn shoot(setting: &Setting, patches: &Patches, shells: &Shells) -> Option<UnionFind> {
    let network = setting.network;
    let Domain::Box(grid) = setting.domain else { return None };
    if node_vertices(network).next().is_some() {
        return None;
    }
    let nodes = &network.vertex_nodes;
    let on_edges = nodes.partition_point(|n| n[1].is_some() && n[2].is_none());
    // The lowest vertex of each component, and where the vertices on edges from each row of nodes are.
    let row = Divide::by(grid.strides()[1]);
    let components = patches.component_count;
    let row_count = grid.node_count() / grid.strides()[1];
    // Tables for each task, unless they were larger than what the task reads.
    let least = (1 << 14).max(components + row_count);
    let parts = map_ranges(on_edges, least, |range| {
        let mut lowest = vec![(NodeId::NONE, VertexId::NONE); components];
        let mut rows = vec![[u32::MAX, 0]; row_count];
        for (v, (here, patch)) in range.clone().zip(nodes[range.clone()].iter().zip(&patches.at_vertex[range])) {
            let lowest = &mut lowest[patches.component[patch.at()].at()];
            *lowest = (*lowest).min((here[0], VertexId::of(v)));
            let [first, last] = &mut rows[row.quotient(here[0].0)];
            *first = (*first).min(v as u32);
            *last = v as u32;
        }
        (lowest, rows)
    });
    let mut parts = parts.into_iter();
    let (mut lowest, mut rows) = parts.next().expect("one part at least");
    for (others, their_rows) in parts {
        lowest.iter_mut().zip(others).for_each(|(mine, other)| *mine = (*mine).min(other));
        rows.iter_mut()
            .zip(their_rows)
            .for_each(|(mine, other)| *mine = [mine[0].min(other[0]), mine[1].max(other[1])]);
    }
    // The vertex on an edge that a ray meets first when it comes from the higher node. Vertices on an edge follow one another.
    let highest_on = |low: NodeId, high: NodeId| {
        let [first, last] = rows[row.quotient(low.0)];
        let mut here = (first..=last).rev();
        here.find(|&v| nodes[v as usize][..2] == [low, high]).map(VertexId)
    };
    let mut classes = UnionFind::new(shells.len() + 1);
    for (low, v) in lowest {
        if v.is_none() {
            return None;
        }
        let high = nodes[v.at()][1];
        let from = shells.of(looking_to(setting, patches, v, low)?);
        let mut join = |hit: VertexId, towards: NodeId| {
            let to = shells.of(looking_to(setting, patches, hit, towards)?);
            classes.union(from.at(), to.at());
            Some(())
        };
        // Another component's vertex on the same edge?
        if v.at() > 0 && nodes[v.at() - 1] == nodes[v.at()] {
            join(VertexId(v.0 - 1), high)?;
            continue;
        }
        let mut at = low;
        loop {
            let mut place = grid.place(at);
            let Some(axis) = (0..3).find(|&axis| place[axis] > 0) else {
                classes.union(from.at(), shells.len());
                break;
            };
            place[axis] -= 1;
            let next = grid.node(place);
            if let Some(hit) = highest_on(next, at) {
                join(hit, at)?;
                break;
            }
            at = next;
        }
    }
    Some(classes)
}

/// Division of ids by a number that is not known beforehand, without dividing.
struct Divide(u64);

impl Divide {
    /// The quotient of n below 2³² by d ≥ 2: ⌊n·⌈2⁶⁴/d⌉ / 2⁶⁴⌋. The factor is too large by less than 1, the product by less than 2⁻³² of a unit,
    /// and n/d is 1/d or more below the next whole number.
    fn by(d: usize) -> Self {
        Self((u64::MAX / d as u64) + 1)
    }
    #[inline(always)]
    fn quotient(&self, n: u32) -> usize {
        ((n as u128 * self.0 as u128) >> 64) as usize
    }
}

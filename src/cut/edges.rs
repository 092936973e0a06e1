//! Stage 2: the points where planes cross mesh edges, in order along each edge (paper, section 3.1).
//!
//! Within a family of parallel planes the order along an edge is known; between families it is the sign of a 2×2
//! determinant of corner values. Planes that cross at the same point are merged into one point with a set of planes.
//! The set is completed by the planes that contain the whole edge, so that it is intrinsic: all planes through the point.
//!
//! Invariant: points of an edge are strictly ordered from its lower vertex to its higher one, and their sets are complete.
//! Cost: the number of crossings, and a comparison of planes of unlike families per exchange of neighbours.

use super::classify::{Classified, KnifeId, Knives, each_common};
use crate::base::parallel::{concat, map_ranges, offsets, write_parts};
use crate::base::{Csr, EdgeId};
use crate::exact::{self, counters};
use crate::mesh::TriMesh;
use std::cmp::Ordering;
use std::ops::Range;

#[derive(Debug, Default)]
pub struct EdgePoints {
    /// Edge `e` has points `first[e]..first[e + 1]`, from its lower vertex to its higher.
    pub first: Vec<u32>,
    /// For each entry of `Classified::edge_crossings`: the place of its point along the edge.
    pub rank: Vec<u32>,
    /// All knives through each point, rising.
    pub knives: Csr<KnifeId>,
    /// The edge of each point.
    pub edge: Vec<EdgeId>,
    /// The knife that represents each point: of the lowest plane that crosses the edge there.
    pub lead: Vec<KnifeId>,
}

pub fn edge_points(mesh: &TriMesh, knives: &Knives, classified: &Classified) -> EdgePoints {
    let parts = map_ranges(mesh.edges.len(), 1 << 12, |range| points_of(mesh, knives, classified, range));
    let first = offsets(parts.iter().map(|p| p.edge.len()));
    let mut all = EdgePoints::default();
    let mut sets = Vec::with_capacity(parts.len());
    let (mut firsts, mut ranks, mut edges, mut leads) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for part in parts {
        firsts.push(part.first);
        ranks.push(part.rank);
        sets.push(part.knives);
        edges.push(part.edge);
        leads.push(part.lead);
    }
    // A part's own `first` begins with 0, and ends with what the next one begins with.
    let lengths: Vec<usize> = firsts.iter().map(|f| f.len() - 1).chain([1]).collect();
    all.first = write_parts(&lengths, |i, out| match firsts.get(i) {
        Some(part) => out.extend(part[..part.len() - 1].iter().map(|f| f + first[i] as u32)),
        None => out.push(first[i] as u32),
    });
    (all.rank, all.knives, all.edge, all.lead) = (concat(ranks), Csr::concat(sets), concat(edges), concat(leads));
    all
}

/// The points of some consecutive edges, numbered from 0.
fn points_of(mesh: &TriMesh, knives: &Knives, classified: &Classified, edges: Range<usize>) -> EdgePoints {
    let crossings = &classified.edge_crossings;
    let first_crossing = crossings.offsets[edges.start] as usize;
    let count = crossings.offsets[edges.end] as usize - first_crossing;
    let mut out = EdgePoints {
        first: Vec::with_capacity(edges.len() + 1),
        rank: vec![0; count],
        knives: Csr::with_capacity(count, count),
        edge: Vec::with_capacity(count),
        lead: Vec::with_capacity(count),
    };
    out.first.push(0);
    let mut order: Vec<u32> = Vec::new();
    let mut group: Vec<KnifeId> = Vec::new();
    for (e, &[a, b]) in edges.clone().zip(&mesh.edges[edges]) {
        let range = crossings.range(e);
        if range.is_empty() {
            out.first.push(out.edge.len() as u32);
            continue;
        }
        let row = &crossings.items[range.clone()];
        order.clear();
        order.extend(0..row.len() as u32);
        let (xa, xb) = (&mesh.vertices[a.at()], &mesh.vertices[b.at()]);
        let compare = |i: u32, j: u32| -> Ordering {
            let (ki, kj) = (row[i as usize].knife, row[j as usize].knife);
            if knives.family[ki.at()] == knives.family[kj.at()] {
                // From the lower vertex on: rising ranks where it lies below the family, falling ones where above.
                let below = row[i as usize].low_positive == knives.reversed[ki.at()];
                return if below { ki.cmp(&kj) } else { kj.cmp(&ki) };
            }
            exact::compare_on_edge(xa, xb, knives.plane(ki), knives.plane(kj))
        };
        if row.len() == 1 {
            counters::count_topology(counters::Predicate::EdgeOrder);
        } else {
            order.sort_by(|&i, &j| compare(i, j));
        }
        let containing = (classified.vertex_knives.row(a), classified.vertex_knives.row(b));
        let mut at = 0;
        let first = out.edge.len() as u32;
        while at < order.len() {
            let place = out.edge.len() as u32 - first;
            group.clear();
            let leader = order[at];
            while at < order.len() && (order[at] == leader || compare(leader, order[at]) == Ordering::Equal) {
                group.push(row[order[at] as usize].knife);
                out.rank[range.start - first_crossing + order[at] as usize] = place;
                at += 1;
            }
            out.lead.push(group.iter().copied().min_by_key(|k| knives.ids[k.at()]).unwrap());
            if !containing.0.is_empty() {
                each_common(containing.0, containing.1, |k| group.push(k));
            }
            group.sort_unstable();
            out.knives.push_row(&group);
            out.edge.push(EdgeId::of(e));
        }
        out.first.push(out.edge.len() as u32);
    }
    out
}

impl EdgePoints {
    /// Points of an edge follow one another, and each lies on its lead.
    pub fn check(&self) -> Result<(), String> {
        self.knives.check()?;
        if *self.first.last().unwrap_or(&0) as usize != self.edge.len() || self.lead.len() != self.edge.len() {
            return Err("points on edges do not match their edges".into());
        }
        if let Some(i) = (0..self.edge.len()).find(|&i| self.knives.row(i).binary_search(&self.lead[i]).is_err()) {
            return Err(format!("point {i} on an edge is not on its own plane"));
        }
        Ok(())
    }

    /// Number of points on an edge.
    #[inline(always)]
    pub fn count(&self, e: EdgeId) -> usize {
        (self.first[e.at() + 1] - self.first[e.at()]) as usize
    }
}

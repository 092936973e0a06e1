//! A planar straight-line graph for each cluster: its segments, cut where they cross or touch, and the members' edges.
//!
//! Two segments of one plane that are not on one line meet exactly if the ends of each are on both sides of the other's line, or on it. A side is
//! that of the carrier: the plane of the triangle that left the segment, or the edge; a sign of lower degree than a turn of three constructed
//! points. A proper crossing is a new point, named by both carriers and the plane; the same point is found in each of the planes, under names that may
//! differ, and gets one id afterwards ([`super::points`]). Segments on one line, in any number, are cut at one another's ends.
//!
//! Members' edges need no search: what lies on them is known from the pairs of triangles ([`super::intersect`]).
//! Cost: pairs of segments with boxes that meet, by a box hierarchy where there are many.

use super::data::{Carrier, Clusters, Contacts, Graphs, Segment, Soup};
use super::intersect::dedup_from;
use super::planar::Plane;
use super::points;
use crate::base::{Csr, EdgeId, PlaneId, Result, Run, TriangleId, VertexId, Watch};
use crate::complex::Origin;
use crate::mesh::bvh::build_bvh_watched;
use rayon::prelude::*;

/// From so many segments on, pairs are looked for in a hierarchy.
const MANY: usize = 24;
/// Clusters in one task at least.
const LEAST: usize = 16;
/// Clusters whose tasks are given out at once, and pairs of segments between two looks at the caller's wish to stop.
const CHUNK: usize = 1 << 12;
const PAIRS: usize = 1 << 7;

/// A vertex on a segment of a cluster: a known one, or one that is yet to get its id.
#[derive(Clone, Copy)]
struct Event {
    segment: u32,
    known: VertexId,
    new: Origin,
}

/// A cluster's segments (sorted, each once) and what lies on them.
#[derive(Default)]
struct Work {
    segments: Vec<Segment>,
    events: Vec<Event>,
}

/// Makes the graphs of all clusters. Errors: `Cancelled`.
pub fn crossings(soup: &Soup, contacts: Contacts, clusters: &Clusters, run: &mut Run) -> Result<Graphs> {
    run.stage("crossings", 0.35)?;
    let mesh = &*soup.mesh;
    let count = clusters.members.len();
    let mut works: Vec<Work> = Vec::with_capacity(count);
    while works.len() < count {
        let chunk = works.len()..count.min(works.len() + CHUNK);
        let fraction = 0.35 + 0.1 * works.len() as f64 / count as f64;
        run.watched("crossings", fraction, |watch| {
            let work = |c: usize| find(soup, &contacts, clusters.members.row(c), watch);
            works.par_extend(chunk.into_par_iter().with_min_len(LEAST).map(work));
        })?;
        run.tick("crossings", 0.35 + 0.1 * works.len() as f64 / count as f64)?;
    }
    // Soup vertices that touch something may be where segments cross.
    let touching =
        works.iter().flat_map(|w| &w.segments).flat_map(|s| s.ends).chain(contacts.edge_points.items.iter().copied());
    let touching = touching.filter(|v| v.at() < mesh.vertices.len()).map(Origin::Mesh);
    let new = works.iter().flat_map(|w| &w.events).filter(|e| e.known.is_none()).map(|e| e.new);
    let mut origins: Vec<Origin> = touching.chain(new).collect();
    run.tick("crossings", 0.45)?;
    origins.par_sort_unstable();
    origins.dedup();
    run.tick("crossings", 0.45)?;
    let Contacts { points, split_edges, edge_points, .. } = contacts;
    let mut graphs = Graphs { points, split_edges, edge_points, ..Graphs::default() };
    let ids = run.watched("crossings", 0.45, |watch| points::unify(soup, &mut graphs.points, &origins, watch))?;
    let id = |e: &Event| if e.known.is_some() { e.known } else { ids[origins.partition_point(|o| *o < e.new)] };
    let parts: Vec<(Vec<[VertexId; 2]>, Vec<VertexId>)> = run.watched("crossings", 0.45, |watch| {
        let piece = |(c, work): (usize, &Work)| pieces(soup, &graphs, clusters.members.row(c), work, id, watch);
        works.par_iter().with_min_len(LEAST).enumerate().map(piece).collect()
    })?;
    run.tick("crossings", 0.48)?;
    let (mut rows, mut lone) = (Csr::default(), Csr::default());
    for (p, l) in &parts {
        rows.push_row(p);
        lone.push_row(l);
    }
    (graphs.pieces, graphs.lone) = (rows, lone);
    run.tick("crossings", 0.5)?;
    drop(parts);
    drop(works);
    run.tick("crossings", 0.5)?;
    Ok(graphs)
}

/// The segments of a cluster and the vertices on them; told to stop, some of them.
fn find(soup: &Soup, contacts: &Contacts, members: &[TriangleId], watch: &Watch) -> Work {
    if !watch.go_on() {
        return Work::default();
    }
    let mesh = &*soup.mesh;
    let row = |t: &TriangleId| contacts.segments.row(contacts.cut.partition_point(|c| c < t));
    let mut work = Work { segments: members.iter().flat_map(row).copied().collect(), events: Vec::new() };
    work.segments.sort_unstable();
    work.segments.dedup();
    let inner = work.segments.len();
    if inner == 0 || (inner == 1 && members.len() == 1) {
        return work;
    }
    let plane = Plane::new(soup, &contacts.points, members[0]);
    // Behind the segments the members' edges, where there may be contact.
    let mut all = work.segments.clone();
    if members.len() > 1 {
        all.extend(edges_of(soup, members).map(|e| Segment { ends: mesh.edges[e.at()], carrier: Carrier::Edge(e) }));
    }
    let events = &mut work.events;
    if all.len() < MANY {
        for i in 0..inner {
            for j in i + 1..all.len() {
                meet(&plane, &all, inner, i, j, events);
            }
        }
        return work;
    }
    // (Rounding is monotone: where segments meet, the boxes of their rounded ends do.)
    let places: Vec<[f64; 3]> = all.iter().flat_map(|s| s.ends).map(|v| plane.place(v)).collect();
    let flat: Vec<[VertexId; 3]> = (0..all.len()).map(|i| [2 * i, 2 * i + 1, 2 * i + 1].map(VertexId::of)).collect();
    let mut asked = 0;
    build_bvh_watched(&places, &flat, watch).meeting_pairs(|a, b| {
        let (i, j) = (a.at().min(b.at()), a.at().max(b.at()));
        if i < inner {
            meet(&plane, &all, inner, i, j, events);
        }
        asked += 1;
        asked % PAIRS != 0 || watch.go_on()
    });
    work
}

/// Edges of members, each once, rising.
fn edges_of(soup: &Soup, members: &[TriangleId]) -> impl Iterator<Item = EdgeId> {
    let mut edges: Vec<EdgeId> =
        members.iter().filter_map(|t| soup.mesh.triangle_edges.get(t.at())).flatten().copied().collect();
    edges.sort_unstable();
    edges.dedup();
    edges.into_iter()
}

/// Notes where segments i < j touch or cross: vertices within the one or the other. From `inner` on nothing is noted.
fn meet(plane: &Plane, all: &[Segment], inner: usize, i: usize, j: usize, events: &mut Vec<Event>) {
    let (s, t) = (all[i], all[j]);
    let mut note = |segment: usize, known: VertexId, new: Origin| {
        if segment < inner {
            events.push(Event { segment: segment as u32, known, new });
        }
    };
    let nothing = Origin::Mesh(VertexId::NONE);
    let is_point = |s: &Segment| s.ends[0] == s.ends[1];
    if is_point(&s) || is_point(&t) {
        for (point, segment, number) in [(&s, &t, j), (&t, &s, i)] {
            let v = point.ends[0];
            if is_point(point)
                && !is_point(segment)
                && plane.side(segment.carrier, v).is_zero()
                && within(plane, segment, v)
            {
                note(number, v, nothing);
            }
        }
        return;
    }
    let sides = |carrier: Carrier, ends: [VertexId; 2]| ends.map(|v| plane.side(carrier, v));
    let of_t = if s.carrier == t.carrier { [crate::exact::Sign::Zero; 2] } else { sides(s.carrier, t.ends) };
    if of_t.iter().all(|s| s.is_zero()) {
        // On one line.
        for (number, segment, ends) in [(i, &s, t.ends), (j, &t, s.ends)] {
            for v in ends {
                if within(plane, segment, v) {
                    note(number, v, nothing);
                }
            }
        }
        return;
    }
    if of_t[0] == of_t[1] {
        return;
    }
    let of_s = sides(t.carrier, s.ends);
    if of_s[0] == of_s[1] {
        return;
    }
    let zero = |of: [crate::exact::Sign; 2]| of.iter().position(|s| s.is_zero());
    match (zero(of_s), zero(of_t)) {
        (None, None) => {
            let new = crossing(plane.soup, plane.of, s.carrier, t.carrier);
            note(i, VertexId::NONE, new);
            note(j, VertexId::NONE, new);
        }
        (Some(k), None) => note(j, s.ends[k], nothing),
        (None, Some(k)) => note(i, t.ends[k], nothing),
        // A common end.
        (Some(_), Some(_)) => {}
    }
}

/// The point where two carriers cross in the plane of a triangle.
fn crossing(soup: &Soup, of: TriangleId, a: Carrier, b: Carrier) -> Origin {
    match (a, b) {
        (Carrier::Plane(p), Carrier::Plane(q)) => {
            // Sheets come behind triangles.
            let mut all = [of, p, q];
            all.sort_unstable();
            match all.map(|t| soup.sheet(t)) {
                [None, None, None] => Origin::Triangles(all[0], all[1], all[2]),
                [None, None, Some(p)] => Origin::TrianglesPlane(all[0], all[1], p),
                [None, Some(p), Some(q)] => Origin::Triangle(all[0], p, q),
                [p, q, r] => {
                    let [p, q, r] = [p, q, r].map(|p| p.unwrap_or(PlaneId::NONE));
                    Origin::Planes(p, q, r)
                }
            }
        }
        (Carrier::Edge(e), Carrier::Plane(t)) | (Carrier::Plane(t), Carrier::Edge(e)) => match soup.sheet(t) {
            None => Origin::EdgeTriangle(e, t),
            Some(p) => Origin::Edge(e, p),
        },
        (Carrier::Edge(e), Carrier::Edge(f)) => Origin::Edges(e.min(f), e.max(f)),
    }
}

/// Whether a vertex on the line of a segment lies strictly between its ends.
fn within(plane: &Plane, s: &Segment, v: VertexId) -> bool {
    let [a, b] = s.ends;
    if v == a || v == b {
        return false;
    }
    let axis = points::open_axis(plane.soup, plane.points, a, b);
    let order = |p: VertexId, q: VertexId| points::compare(plane.soup, plane.points, p, q, axis);
    order(a, v) == order(v, b)
}

/// The pieces of a cluster and its vertices on none, sorted; told to stop, none.
fn pieces(
    soup: &Soup,
    graphs: &Graphs,
    members: &[TriangleId],
    work: &Work,
    id: impl Fn(&Event) -> VertexId,
    watch: &Watch,
) -> (Vec<[VertexId; 2]>, Vec<VertexId>) {
    if !watch.go_on() {
        return Default::default();
    }
    let mesh = &*soup.mesh;
    let mut on: Vec<(u32, VertexId)> = work.events.iter().map(|e| (e.segment, id(e))).collect();
    on.sort_unstable();
    on.dedup();
    let (mut pieces, mut lone, mut row) = (Vec::new(), Vec::new(), Vec::new());
    let mut chain = |row: &[VertexId]| pieces.extend(row.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]));
    let mut rest = &on[..];
    for (i, s) in work.segments.iter().enumerate() {
        let (here, behind) = rest.split_at(rest.partition_point(|e| e.0 as usize <= i));
        rest = behind;
        let [a, b] = s.ends;
        if a == b {
            lone.push(a);
            continue;
        }
        row.clear();
        row.extend(here.iter().map(|e| e.1));
        row.extend([a, b]);
        if row.len() > 2 && watch.go_on() {
            let axis = points::open_axis(soup, &graphs.points, a, b);
            row.sort_unstable_by(|&p, &q| points::compare(soup, &graphs.points, p, q, axis));
            dedup_from(&mut row, 0);
        }
        chain(&row);
    }
    for e in edges_of(soup, members) {
        let [a, b] = mesh.edges[e.at()];
        row.clear();
        row.push(a);
        if let Ok(place) = graphs.split_edges.binary_search(&e) {
            row.extend_from_slice(graphs.edge_points.row(place));
        }
        row.push(b);
        chain(&row);
    }
    pieces.sort_unstable();
    pieces.dedup();
    if !lone.is_empty() {
        let mut used: Vec<VertexId> = pieces.iter().flatten().copied().collect();
        used.sort_unstable();
        lone.sort_unstable();
        lone.dedup();
        lone.retain(|v| used.binary_search(v).is_err());
    }
    (pieces, lone)
}

impl Graphs {
    /// Points are distinct; pieces rise, with different ends, lower first; lone vertices are on no piece.
    pub fn check(&self, soup: &Soup, clusters: &Clusters) -> std::result::Result<(), String> {
        self.points.check(soup)?;
        self.pieces.check()?;
        self.lone.check()?;
        if self.pieces.len() != clusters.members.len() || self.lone.len() != clusters.members.len() {
            return Err("as many graphs as clusters".into());
        }
        for (c, (pieces, lone)) in self.pieces.rows().zip(self.lone.rows()).enumerate() {
            if pieces.windows(2).any(|w| w[0] >= w[1]) || pieces.iter().any(|p| p[0] >= p[1]) {
                return Err(format!("pieces of cluster {c} are not sorted"));
            }
            if lone.iter().any(|v| pieces.iter().flatten().any(|w| v == w)) {
                return Err(format!("a lone vertex of cluster {c} is on a piece"));
            }
        }
        Ok(())
    }
}

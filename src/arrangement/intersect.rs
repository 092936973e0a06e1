//! Intersections of all pairs of triangles, gathered: points on edges in order, segments in triangles, overlaps (section 3.1 of the paper).
//!
//! Candidates are the pairs whose boxes meet, from a box hierarchy over all operands at once: an operand may intersect itself. Pairs of nodes are
//! worked on in parallel; what they tell is sorted, so the order of candidates does not matter. Equal points found by different pairs become one
//! ([`super::points`]).
//!
//! Invariant: what lies within an edge is known for the edge, so all triangles there see the same points in the same order.
//! Cost: some twelve candidates per triangle, nearly all of which share a corner around which nothing meets ([`super::stars`]); a microsecond for a pair
//! that meets.

use super::data::{Carrier, Contacts, Points, Segment, Soup};
use super::pair::{Sink, meet};
use super::points;
use super::sheets;
use super::stars::flat_stars;
use crate::base::{EdgeId, PlaneId, Result, Run, TriangleId, VertexId, Watch};
use crate::complex::Origin;
use crate::mesh::bvh::{NodePair, build_bvh_watched};
use rayon::prelude::*;

/// Triangles for each pair of nodes whose triangles one task intersects, about; so many tasks whose findings are put together at once; and so many
/// pairs of triangles between two looks at whether the caller wants to stop.
const PART: usize = 1 << 9;
const AT_ONCE: usize = 1 << 9;
const PAIRS: u64 = 1 << 7;
/// Looks of planes at triangles between two looks of that kind.
const SHEETS: usize = 1 << 22;
/// So many of them a pair of planes takes.
const PAIR: usize = 1 << 11;

/// What pairs told.
#[derive(Default)]
struct Found {
    on_edges: Vec<(EdgeId, Origin)>,
    in_triangles: Vec<(TriangleId, [Origin; 2], Carrier)>,
    overlaps: Vec<[TriangleId; 2]>,
    pairs: u64,
}

impl Sink for Found {
    fn on_edge(&mut self, edge: EdgeId, point: Origin) {
        self.on_edges.push((edge, point));
    }
    fn in_triangle(&mut self, triangle: TriangleId, ends: [Origin; 2], carrier: Carrier) {
        self.in_triangles.push((triangle, ends, carrier));
    }
    fn overlap(&mut self, a: TriangleId, b: TriangleId) {
        self.overlaps.push([a, b]);
    }
}

impl Found {
    fn add(&mut self, mut other: Self) {
        self.on_edges.append(&mut other.on_edges);
        self.in_triangles.append(&mut other.in_triangles);
        self.overlaps.append(&mut other.overlaps);
        self.pairs += other.pairs;
    }
}

/// Intersects all triangles of a soup. Errors: `Cancelled`.
pub fn intersect(soup: &Soup, run: &mut Run) -> Result<Contacts> {
    run.stage("candidates", 0.1)?;
    let mesh = &*soup.mesh;
    let tree = run.watched("candidates", 0.1, |watch| build_bvh_watched(&mesh.vertices, &mesh.triangles, watch))?;
    run.stage("intersect", 0.15)?;
    let stars = flat_stars(mesh);
    run.tick("intersect", 0.16)?;
    let mut found = Found::default();
    let decide = |&pair: &NodePair, watch: &Watch| {
        let mut part = Found::default();
        let mut asked = 0;
        tree.meeting_pairs_below(pair, |a, b| {
            if soup.is_passive(a)
                || soup.is_passive(b)
                || stars.settle(&mesh.triangles[a.at()], &mesh.triangles[b.at()])
            {
                return true;
            }
            part.pairs += meet(mesh, a.min(b), a.max(b), &mut part) as u64;
            asked += 1;
            asked % PAIRS != 0 || watch.go_on()
        });
        part
    };
    let pairs = tree.node_pairs(mesh.triangles.len() / PART);
    for pairs in pairs.chunks(AT_ONCE) {
        run.watched("intersect", 0.2, |watch| {
            if rayon::current_num_threads() == 1 {
                pairs.iter().take_while(|_| watch.go_on()).for_each(|pair| found.add(decide(pair, watch)));
            } else {
                let decide = |pair| if watch.go_on() { decide(pair, watch) } else { Found::default() };
                let parts: Vec<Found> = pairs.par_iter().with_max_len(1).map(decide).collect();
                parts.into_iter().for_each(|part| found.add(part));
            }
        })?;
        run.tick("intersect", 0.2)?;
    }
    drop(tree);
    meet_sheets(soup, &mut found, run)?;
    run.tick("intersect", 0.3)?;
    run.watched("intersect", 0.3, |watch| gather(soup, found, watch))
}

/// Intersects the planes of half-spaces with all triangles and with one another.
fn meet_sheets(soup: &Soup, found: &mut Found, run: &mut Run) -> Result<()> {
    let stands = &soup.half_spaces.stands;
    let each = |p: usize| {
        let mut part = Found::default();
        let own = PlaneId::of(p);
        if stands[p] != own {
            part.overlap(soup.sheet_of(stands[p]), soup.sheet_of(own));
            return part;
        }
        part.pairs += sheets::meet_triangles(soup, own, &mut part);
        for q in (p + 1..stands.len()).filter(|&q| stands[q] == PlaneId::of(q)) {
            if !sheets::are_parallel(&soup.planes()[p], &soup.planes()[q]) {
                part.pairs += sheets::meet_planes(soup, own, PlaneId::of(q), &mut part) as u64;
            }
        }
        part
    };
    let threads = rayon::current_num_threads();
    let looks = soup.mesh.triangles.len() + PAIR * stands.len();
    let at_once = (SHEETS / looks.max(1)).clamp(threads, threads.max(64));
    for block in (0..stands.len()).collect::<Vec<_>>().chunks(at_once) {
        let parts: Vec<Found> = block.par_iter().with_max_len(1).map(|&p| each(p)).collect();
        parts.into_iter().for_each(|part| found.add(part));
        run.tick("intersect", 0.3)?;
    }
    Ok(())
}

/// (Told to stop it returns something or other.)
fn gather(soup: &Soup, mut found: Found, watch: &Watch) -> Contacts {
    let mesh = &*soup.mesh;
    found.on_edges.par_sort_unstable();
    found.on_edges.dedup();
    found.in_triangles.par_sort_unstable();
    found.in_triangles.dedup();
    found.overlaps.par_sort_unstable();
    let ends = found.in_triangles.iter().flat_map(|s| s.1);
    let mut origins: Vec<Origin> = found.on_edges.iter().map(|p| p.1).chain(ends).collect();
    origins.par_sort_unstable();
    origins.dedup();
    let mut points = Points::default();
    let ids = points::unify(soup, &mut points, &origins, watch);
    if !watch.go_on() {
        return Contacts::default();
    }
    let id = |o: &Origin| ids[origins.partition_point(|p| p < o)];
    let mut contacts = Contacts { pair_count: found.pairs, overlaps: found.overlaps, ..Contacts::default() };
    for row in found.on_edges.chunk_by(|a, b| a.0 == b.0) {
        let edge = row[0].0;
        let start = contacts.edge_points.items.len();
        contacts.edge_points.items.extend(row.iter().map(|p| id(&p.1)));
        order_on_edge(soup, &points, edge, &mut contacts.edge_points.items, start);
        contacts.edge_points.end_row();
        contacts.split_edges.push(edge);
    }
    let of_split = contacts.split_edges.iter().flat_map(|e| mesh.edge_uses.row(*e)).map(|u| u.triangle);
    let with_segments = found.in_triangles.iter().map(|s| s.0);
    let overlapping = contacts.overlaps.iter().flatten().copied();
    let of_split = of_split.filter(|t| !soup.is_passive(*t));
    contacts.cut = of_split.chain(with_segments).chain(overlapping).collect();
    contacts.cut.par_sort_unstable();
    contacts.cut.dedup();
    let mut rest = &found.in_triangles[..];
    for t in &contacts.cut {
        let (row, behind) = rest.split_at(rest.partition_point(|s| s.0 <= *t));
        rest = behind;
        let start = contacts.segments.items.len();
        contacts.segments.items.extend(row.iter().map(|(_, ends, carrier)| {
            let [a, b] = [id(&ends[0]), id(&ends[1])];
            Segment { ends: [a.min(b), a.max(b)], carrier: *carrier }
        }));
        contacts.segments.items[start..].sort_unstable();
        dedup_from(&mut contacts.segments.items, start);
        contacts.segments.end_row();
    }
    contacts.points = points;
    contacts
}

/// Sorts the vertices from `start` on along an edge, from its lower end to its higher one, each once.
pub fn order_on_edge(soup: &Soup, points: &Points, edge: EdgeId, items: &mut Vec<VertexId>, start: usize) {
    let mesh = &*soup.mesh;
    let [a, b] = mesh.edges[edge.at()];
    let axis = points::open_axis(soup, points, a, b);
    let rising = mesh.vertices[a.at()][axis] < mesh.vertices[b.at()][axis];
    items[start..].sort_unstable_by(|&p, &q| {
        let order = points::compare(soup, points, p, q, axis);
        if rising { order } else { order.reverse() }
    });
    dedup_from(items, start);
}

/// Removes repetitions from `start` on.
pub fn dedup_from<T: Copy + PartialEq>(items: &mut Vec<T>, start: usize) {
    let mut kept = start;
    for i in start..items.len() {
        if i == start || items[i] != items[kept - 1] {
            items[kept] = items[i];
            kept += 1;
        }
    }
    items.truncate(kept);
}

impl Contacts {
    /// Lists rise, ids are in range, points are distinct and rounded, edges' points lie between their ends in order.
    pub fn check(&self, soup: &Soup) -> std::result::Result<(), String> {
        let mesh = &*soup.mesh;
        self.points.check(soup)?;
        self.edge_points.check()?;
        self.segments.check()?;
        let rising = self.split_edges.windows(2).all(|w| w[0] < w[1]) && self.cut.windows(2).all(|w| w[0] < w[1]);
        if !rising || self.edge_points.len() != self.split_edges.len() || self.segments.len() != self.cut.len() {
            return Err("split edges or cut triangles are not listed once each".into());
        }
        let count = mesh.vertices.len() + self.points.origins.len();
        if self
            .segments
            .items
            .iter()
            .flat_map(|s| s.ends)
            .chain(self.edge_points.items.iter().copied())
            .any(|v| v.at() >= count)
        {
            return Err("a vertex that does not exist".into());
        }
        for (e, row) in self.split_edges.iter().zip(self.edge_points.rows()) {
            let [a, b] = mesh.edges[e.at()];
            let axis = points::open_axis(soup, &self.points, a, b);
            let all: Vec<VertexId> = std::iter::once(a).chain(row.iter().copied()).chain([b]).collect();
            let orders: Vec<_> =
                all.windows(2).map(|w| points::compare(soup, &self.points, w[0], w[1], axis)).collect();
            if row.is_empty() || orders[0].is_eq() || orders.iter().any(|o| *o != orders[0]) {
                return Err(format!("points on edge {} are not in order", e.0));
            }
        }
        Ok(())
    }
}

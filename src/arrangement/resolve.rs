//! The resolved surface: uncut triangles as they are, cut ones as the triangles of their cluster's graph (section 3.1 of the paper).
//!
//! A cluster of one triangle is triangulated within it. A cluster of several starts from a frame around them all, and what is in no member
//! is left out; which members hold a part is found by flooding from the pieces of each member's edges. So where members overlap they have the
//! same parts, each once, with all its births.
//!
//! Cost: uncut triangles are copied; a cluster costs its triangulation, and its parts once for each member.

use super::data::{Birth, Clusters, Graphs, Resolved, Soup};
use super::planar::{Plane, turn_of_rounded};
use super::points;
use super::regions::Regions;
use super::triangulate::{NONE, Triangulation, Vertices, curve_order, triangulate};
use crate::base::{Csr, Error, FaceId, Result, Run, TriangleId, VertexId, Watch};
use crate::exact::counters::{Predicate, Tier, count};
use crate::exact::{self, Point, Sign};
use crate::mesh::projection::seen_along;
use rayon::prelude::*;

/// Clusters in one task at least.
const LEAST: usize = 8;
/// Clusters whose tasks are given out at once.
const CHUNK: usize = 1 << 10;

/// A part of a cluster: its corners, positive in the plane of the cluster's first member, and the members that hold it.
struct Parts {
    corners: Vec<[VertexId; 3]>,
    /// `None`: the cluster is one triangle.
    births: Option<Csr<TriangleId>>,
}

/// Resolves a soup. Errors: `Cancelled`; `Inconsistent` if a graph contradicts itself (a fault of the library).
pub fn resolve(soup: Soup, graphs: Graphs, clusters: &Clusters, pair_count: u64, run: &mut Run) -> Result<Resolved> {
    run.stage("triangulate", 0.5)?;
    let count = clusters.members.len();
    let mut all: Vec<Parts> = Vec::with_capacity(count);
    while all.len() < count {
        let chunk = all.len()..count.min(all.len() + CHUNK);
        let fraction = |done: usize| 0.5 + 0.1 * done as f64 / count as f64;
        let made: Vec<Result<Parts>> = run.watched("triangulate", fraction(all.len()), |watch| {
            let part = |regions: &mut Regions, c: usize| {
                let graph = (graphs.pieces.row(c), graphs.lone.row(c));
                parts(&soup, &graphs, clusters.members.row(c), graph, regions, watch)
            };
            chunk.into_par_iter().with_min_len(LEAST).map_init(Regions::default, part).collect()
        })?;
        for part in made {
            all.push(part?);
        }
        run.tick("triangulate", fraction(all.len()))?;
    }
    run.stage("resolve", 0.6)?;
    let mesh = &*soup.mesh;
    let mut cut: Vec<TriangleId> = clusters.members.items.clone();
    cut.sort_unstable();
    let mut next = cut.iter().copied().peekable();
    let total = mesh.triangles.len().saturating_sub(cut.len()) + all.iter().map(|p| p.corners.len()).sum::<usize>();
    let mut faces = Vec::with_capacity(total);
    let mut support = Vec::with_capacity(total);
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let t = TriangleId::of(t);
        if next.next_if_eq(&t).is_none() && !soup.is_passive(t) {
            faces.push(*corners);
            support.push(t);
        }
    }
    let whole = faces.len();
    let (mut shared, mut births) = (Vec::new(), Csr::default());
    for (parts, members) in all.iter().zip(clusters.members.rows()) {
        let Some(rows) = &parts.births else {
            faces.extend_from_slice(&parts.corners);
            support.resize(faces.len(), members[0]);
            continue;
        };
        let (axis, positive) = soup.open_axis(members[0]);
        let like = |m: &TriangleId| *m == members[0] || soup.turn_along(*m, axis) == positive;
        let same: Vec<bool> = members.iter().map(like).collect();
        let like_first = |t: &TriangleId| same[members.partition_point(|m| m < t)];
        for (corners, holders) in parts.corners.iter().zip(rows.rows()) {
            let [a, b, c] = *corners;
            let oriented = like_first(&holders[0]);
            if holders.len() > 1 {
                shared.push(FaceId::of(faces.len()));
                births.items.extend(holders.iter().map(|t| Birth { triangle: *t, same: like_first(t) == oriented }));
                births.end_row();
            }
            faces.push(if oriented { [a, b, c] } else { [a, c, b] });
            support.push(holders[0]);
        }
    }
    let Graphs { points, .. } = graphs;
    Ok(Resolved { soup, points, faces, whole, support, shared, births, pair_count })
}

/// Vertices of one cluster by number, with a frame behind them where there is one.
struct Local<'a> {
    plane: Plane<'a>,
    vertices: Vec<VertexId>,
    /// Seen so that the first member turns to the left, and times a power of two.
    places: Vec<[f64; 2]>,
    /// Corners of the frame as points, which may be out of range of doubles.
    frame: Vec<Point>,
}

impl Local<'_> {
    fn point(&self, v: u32) -> Point {
        match (v as usize).checked_sub(self.vertices.len()) {
            Some(k) => self.frame[k],
            None => points::point(self.plane.soup, self.plane.points, self.vertices[v as usize]),
        }
    }
}

impl Vertices for Local<'_> {
    #[inline]
    fn place(&self, v: u32) -> [f64; 2] {
        self.places[v as usize]
    }
    #[inline]
    fn quick_turn(&self, a: u32, b: u32, c: u32) -> Option<Sign> {
        // As the plane would, without looking points up. No coordinate but those of the frame is above 1, and the frame is where it says.
        let [x, y, z] = [a, b, c].map(|v| self.places[v as usize]);
        let sign = turn_of_rounded(x, y, z, 1.0);
        if sign.is_some() {
            count(Predicate::Projected, Tier::Filter);
        }
        sign
    }
    #[inline]
    fn comes_before(&self, a: u32, b: u32) -> bool {
        let (x, y) = (self.places[a as usize], self.places[b as usize]);
        if x[0] != y[0] {
            return x[0] < y[0];
        }
        let (u, v) = seen_along(self.plane.axis);
        let axes = if self.plane.orientation == Sign::Negative { [v, u] } else { [u, v] };
        let order = |axis: usize| exact::compare_coordinate(&self.point(a), &self.point(b), axis);
        order(axes[0]).then_with(|| order(axes[1])).is_lt()
    }
    #[inline]
    fn turn(&self, a: u32, b: u32, c: u32) -> Sign {
        if let Some(sign) = self.quick_turn(a, b, c) {
            return sign;
        }
        let n = self.vertices.len() as u32;
        let sign = if a < n && b < n && c < n {
            let [a, b, c] = [a, b, c].map(|v| self.vertices[v as usize]);
            self.plane.turn(a, b, c)
        } else {
            let (u, v) = seen_along(self.plane.axis);
            exact::turn_projected(&self.point(a), &self.point(b), &self.point(c), u, v)
        };
        sign * self.plane.orientation
    }
}

/// Told to stop it returns any error.
fn parts(
    soup: &Soup,
    graphs: &Graphs,
    members: &[TriangleId],
    (pieces, lone): (&[[VertexId; 2]], &[VertexId]),
    regions: &mut Regions,
    watch: &Watch,
) -> Result<Parts> {
    watch.check()?;
    let mesh = &*soup.mesh;
    // Of a sheet: none.
    let corners = mesh.triangles.get(members[0].at()).copied();
    regions.number(pieces, lone);
    let vertices = &regions.vertices;
    let last = members[members.len() - 1];
    if let (Some(corners), 3, None) = (corners, vertices.len(), soup.sheet(last)) {
        // One triangle, or several on the same corners, that nothing cuts.
        let births = (members.len() > 1).then(|| Csr::from_pairs(1, members.iter().map(|m| (0, *m))));
        return Ok(Parts { corners: vec![corners], births });
    }
    let number = |v: VertexId| vertices.partition_point(|w| *w < v) as u32;
    let plane = Plane::new(soup, &graphs.points, members[0]);
    let (u, v) = seen_along(plane.axis);
    // Near 1, so that squares are in range.
    let scale = power_near(1.0 / mesh.bbox.iter().flatten().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs())));
    let seen = |x: [f64; 3]| {
        let [x, y] = if plane.orientation == Sign::Negative { [x[v], x[u]] } else { [x[u], x[v]] };
        [x * scale, y * scale]
    };
    let mut places: Vec<[f64; 2]> = vertices.iter().map(|&w| seen(plane.place(w))).collect();
    let count = vertices.len() as u32;
    let made: Triangulation;
    let local;
    if let (Some(corners), 1) = (corners, members.len()) {
        let start = corners.map(number);
        local = Local { plane, vertices: vertices.clone(), places, frame: Vec::new() };
        made = match regions.triangulate(&local, start) {
            Some(made) => made,
            None => {
                let order = curve_order(&local, (0..count).filter(|v| !start.contains(v)));
                let start = (&[start][..], &[[NONE; 3]][..]);
                triangulate(&local, count as usize, start, &order, &regions.pieces, watch)?
            }
        };
    } else {
        let frame = frame_around(&places);
        let as_point = |p: &[f64; 2]| {
            let p = if plane.orientation == Sign::Negative { [p[1], p[0]] } else { *p };
            // Where a coordinate times the scale is that.
            let across = |axis: usize, at: f64| {
                let n = std::array::from_fn(|i| if i == axis { scale } else { 0.0 });
                exact::Plane { n, d: -at }
            };
            Point::Planes { p: across(u, p[0]), q: across(v, p[1]), r: across(plane.axis, 0.0) }
        };
        let points = frame.iter().map(as_point).collect();
        places.extend(frame);
        local = Local { plane, vertices: vertices.clone(), places, frame: points };
        let [a, b, c, d] = [count, count + 1, count + 2, count + 3];
        let start = ([[a, b, c], [a, c, d]], [[NONE, NONE, 1], [0, NONE, NONE]]);
        let order = curve_order(&local, 0..count);
        made = triangulate(&local, count as usize + 4, (&start.0, &start.1), &order, &regions.pieces, watch)?;
    }
    debug_assert_eq!(made.check(&local), Ok(()));
    let vertices = &regions.vertices;
    let all = |t: usize| made.corners[t].map(|v| vertices[v as usize]);
    if corners.is_some() && members.len() == 1 {
        return Ok(Parts { corners: (0..made.corners.len()).map(all).collect(), births: None });
    }
    let held = flood(soup, graphs, members, &made, vertices, &plane, watch)?;
    let (mut corners, mut births) = (Vec::new(), Csr::default());
    for t in 0..made.corners.len() {
        let row = held.row(t);
        if !row.is_empty() {
            corners.push(all(t));
            births.push_row(row);
        }
    }
    Ok(Parts { corners, births: Some(births) })
}

/// The power of two below a positive number.
fn power_near(x: f64) -> f64 {
    let bits = x.min(f64::MAX).to_bits();
    let power = bits & !((1 << 52) - 1);
    f64::from_bits(if power == 0 { 1 << bits.ilog2() } else { power })
}

/// Four corners strictly around all places, to the left.
fn frame_around(places: &[[f64; 2]]) -> [[f64; 2]; 4] {
    let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for x in places {
        for i in 0..2 {
            lo[i] = lo[i].min(x[i]);
            hi[i] = hi[i].max(x[i]);
        }
    }
    let extent = (hi[0] - lo[0]).max(hi[1] - lo[1]).min(f64::MAX);
    for i in 0..2 {
        lo[i] = (lo[i] - extent).next_down().max(f64::MIN);
        hi[i] = (hi[i] + extent).next_up().min(f64::MAX);
    }
    [[lo[0], lo[1]], [hi[0], lo[1]], [hi[0], hi[1]], [lo[0], hi[1]]]
}

/// The members that hold each triangle, rising.
fn flood(
    soup: &Soup,
    graphs: &Graphs,
    members: &[TriangleId],
    made: &Triangulation,
    vertices: &[VertexId],
    plane: &Plane,
    watch: &Watch,
) -> Result<Csr<TriangleId>> {
    let mesh = &*soup.mesh;
    let number = |v: VertexId| vertices.partition_point(|w| *w < v) as u32;
    // Sides by their ends.
    let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * made.corners.len());
    for (t, c) in made.corners.iter().enumerate() {
        sides.extend((0..3).filter(|k| made.pieces[t] >> k & 1 != 0).map(|k| ([c[k], c[(k + 1) % 3]], t as u32)));
    }
    sides.sort_unstable();
    let mut held: Vec<(usize, TriangleId)> = Vec::new();
    // The member whose edge a side is, and that has visited a triangle: counts, so that nothing is cleared.
    let mut border = vec![[0u32; 3]; made.corners.len()];
    let mut visited = vec![0u32; made.corners.len()];
    let (mut stack, mut row) = (Vec::new(), Vec::new());
    let mut inside: Vec<bool> = Vec::new();
    for (round, &m) in members.iter().enumerate() {
        watch.check()?;
        let round = round as u32 + 1;
        if soup.sheet(m).is_some() {
            // The outline is where the box is: a triangle is in it with its corners, or not.
            if inside.is_empty() {
                inside = vertices.iter().map(|v| in_bounds(soup, graphs, *v)).collect();
            }
            let within = |c: &[u32; 3]| c.iter().all(|v| inside.get(*v as usize) == Some(&true));
            held.extend(made.corners.iter().enumerate().filter(|(_, c)| within(c)).map(|(t, _)| (t, m)));
            continue;
        }
        let same = soup.turn_along(m, plane.axis) == plane.orientation;
        let corners = mesh.triangles[m.at()];
        for (e, from) in mesh.triangle_edges[m.at()].into_iter().zip(corners) {
            let ends = mesh.edges[e.at()];
            row.clear();
            row.push(ends[0]);
            if let Ok(place) = graphs.split_edges.binary_search(&e) {
                row.extend_from_slice(graphs.edge_points.row(place));
            }
            row.push(ends[1]);
            // As the member walks it, or against that if the member faces down: then it is on the left.
            if (ends[0] == from) != same {
                row.reverse();
            }
            for w in row.windows(2) {
                let ends = [number(w[0]), number(w[1])];
                let at = sides.partition_point(|s| s.0 < ends);
                let Some((_, t)) = sides.get(at).filter(|s| s.0 == ends) else {
                    return Err(Error::inconsistent("an edge of a triangle is not in its cluster"));
                };
                let side = made.corners[*t as usize].iter().position(|v| *v == ends[0]).unwrap_or(0);
                border[*t as usize][side] = round;
                stack.push(*t);
            }
        }
        while let Some(t) = stack.pop() {
            if std::mem::replace(&mut visited[t as usize], round) == round {
                continue;
            }
            held.push((t as usize, m));
            for (&n, &of) in made.across[t as usize].iter().zip(&border[t as usize]) {
                if n != NONE && of != round && visited[n as usize] != round {
                    stack.push(n);
                }
            }
        }
    }
    Ok(Csr::from_pairs(made.corners.len(), held.iter().copied()))
}

/// Whether a vertex is in the closed box of half-spaces.
fn in_bounds(soup: &Soup, graphs: &Graphs, v: VertexId) -> bool {
    let x = points::place(soup, &graphs.points, v);
    let order = |i: usize, corner: &[f64; 3]| {
        let point = || points::point(soup, &graphs.points, v);
        exact::compare_rounded(x[i], corner[i], point, || Point::Vertex(*corner), i)
    };
    let [lo, hi] = &soup.half_spaces.bounds;
    (0..3).all(|i| order(i, lo).is_ge() && order(i, hi).is_le())
}

impl Resolved {
    /// All triangles that a face is a part of.
    pub fn births_of(&self, f: FaceId) -> impl Iterator<Item = Birth> + '_ {
        let several = self.shared.binary_search(&f).ok().map(|i| self.births.row(i));
        let single = Birth { triangle: self.support[f.at()], same: true };
        let one = several.is_none().then_some(single);
        several.unwrap_or_default().iter().copied().chain(one)
    }

    /// Faces have three corners and no two the same ones; corners are on the support; births rise.
    pub fn check(&self) -> std::result::Result<(), String> {
        self.points.check(&self.soup)?;
        self.births.check()?;
        if self.support.len() != self.faces.len() || self.shared.len() != self.births.len() {
            return Err("as many supports as faces".into());
        }
        let mut all: Vec<[VertexId; 3]> = self.faces.clone();
        all.iter_mut().for_each(|f| f.sort_unstable());
        if all.iter().any(|f| f[0] == f[1] || f[1] == f[2] || f[2].at() >= self.vertex_count()) {
            return Err("a face without three corners".into());
        }
        all.sort_unstable();
        if all.windows(2).any(|w| w[0] == w[1]) {
            return Err("two faces on the same corners".into());
        }
        for f in self.whole..self.faces.len() {
            let support = self.soup.support(self.support[f]);
            if self.faces[f].iter().any(|v| !exact::support_side(&support, &self.point(*v)).is_zero()) {
                return Err(format!("a corner of face {f} is not on its support"));
            }
        }
        for (f, row) in self.shared.iter().zip(self.births.rows()) {
            if row.len() < 2
                || row.windows(2).any(|w| w[0].triangle >= w[1].triangle)
                || row[0].triangle != self.support[f.at()]
            {
                return Err(format!("births of face {}", f.0));
            }
        }
        Ok(())
    }
}

//! Volumes, area vectors and centroids as doubles, every one correctly rounded: the double nearest to the exact value,
//! ties to even, zero as +0. So none of them depends on labels, order of summation or threads.
//!
//! Vertices become double-doubles with certified bounds; all else is arithmetic on those with measured error
//! ([`super::certified`]) and a rounding test at the end. What the test cannot decide is computed again with rationals.
//! Undecided are slivers, values out of range and exact ties or zeros after inexact steps, so the ordinary sources of
//! ties are kept exact: a coordinate fixed by an axis-aligned plane, edge or triangle is that number; faces with an
//! axis-aligned support have no extent along it; a box's centroid is the middle of its corners, a parallelogram's
//! too (grid cells: a third of them are ties).
//!
//! A polygon is integrated in its projection (two products per corner for the area, three for the centroid), relative to
//! its first corner; cells are sums over their faces' values relative to a corner of the cell (DESIGN §7, §12).
//! Cost: about 100 ns per corner and half-face. Memory while it runs: 72 bytes per vertex, 144 per face.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::certified::{Certified, Vector, cross, dot, minor, minus};
use super::data::{Complex, HalfFace, Origin, SupportId, crossing_axis};
use super::exact_values;
use super::projection::{Projection, projection};
use crate::base::{CellId, FaceId, VertexId};
use crate::exact::{Gradient, Linear, Plane, Zero, round_rational};
use crate::mesh::projection::seen_along;
use rayon::prelude::*;

/// See [`moments`]. A flag of 1 means that a value of that cell or face lies beyond double range: it is infinite, or zero
/// although the exact value is not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moments {
    pub cell_volume: Vec<f64>,
    pub cell_centroid: Vec<[f64; 3]>,
    /// Along the face's normal, as long as the area.
    pub face_area_vector: Vec<[f64; 3]>,
    pub face_centroid: Vec<[f64; 3]>,
    pub cell_flags: Vec<u8>,
    pub face_flags: Vec<u8>,
    /// How many cells and faces needed rationals.
    pub exact_cells: usize,
    pub exact_faces: usize,
}

/// What cells need of a face: its area vector, and three times its centroid relative to its first corner (a triangle's
/// needs no division).
#[derive(Clone, Copy)]
struct FaceSums {
    area: Vector,
    centroids: Vector,
}

/// A result: rounded values, flag, and whether rationals were needed.
struct Item<const N: usize> {
    values: [f64; N],
    flag: u8,
    exact: bool,
}

/// A cell with more faces than this is summed in pieces, in parallel. (The result is rounded from a certified sum, so
/// it does not depend on the pieces.)
const PIECE: usize = 8192;

/// All moments of a complex, on the threads of the current rayon pool.
pub fn moments(c: &Complex) -> Moments {
    let points: Vec<Vector> = (0..c.vertex_count()).into_par_iter().map(|v| position(c, VertexId::of(v))).collect();
    let (sums, faces): (Vec<FaceSums>, Vec<Item<6>>) =
        (0..c.face_count()).into_par_iter().map(|f| face(c, &points, FaceId::of(f))).unzip();
    let cells: Vec<Item<4>> =
        (0..c.cell_count()).into_par_iter().map(|k| cell(c, &points, &sums, CellId::of(k))).collect();
    Moments {
        cell_volume: cells.iter().map(|i| i.values[0]).collect(),
        cell_centroid: cells.iter().map(|i| [i.values[1], i.values[2], i.values[3]]).collect(),
        face_area_vector: faces.iter().map(|i| [i.values[0], i.values[1], i.values[2]]).collect(),
        face_centroid: faces.iter().map(|i| [i.values[3], i.values[4], i.values[5]]).collect(),
        cell_flags: cells.iter().map(|i| i.flag).collect(),
        face_flags: faces.iter().map(|i| i.flag).collect(),
        exact_cells: cells.iter().filter(|i| i.exact).count(),
        exact_faces: faces.iter().filter(|i| i.exact).count(),
    }
}

fn exactly(p: [f64; 3]) -> Vector {
    p.map(Certified::exactly)
}

/// n·x + d at an input point.
fn value(p: &Plane, x: &[f64; 3]) -> Certified {
    let mut sum = Certified::exactly(p.d);
    for i in 0..3 {
        if p.n[i] != 0.0 && x[i] != 0.0 {
            sum = sum + Certified::exactly(p.n[i]) * Certified::exactly(x[i]);
        }
    }
    sum
}

/// The axis of a normal with one component that is not zero.
fn axis_of(n: &[f64; 3]) -> Option<usize> {
    match n.map(|x| x != 0.0) {
        [true, false, false] => Some(0),
        [false, true, false] => Some(1),
        [false, false, true] => Some(2),
        _ => None,
    }
}

/// Where an axis-aligned plane crosses its axis.
fn crossing(p: &Plane, axis: usize) -> Certified {
    if p.n[axis] == 1.0 {
        return Certified::exactly(-p.d);
    }
    Certified::exactly(-p.d) / Certified::exactly(p.n[axis])
}

/// A vertex as double-doubles. Coordinates that input gives directly are exact (or at least the same for all vertices
/// on the same plane).
fn position(c: &Complex, v: VertexId) -> Vector {
    let origin = c.origins[v.at()];
    if let Origin::Mesh(m) = origin {
        return exactly(c.mesh.vertices[m.at()]);
    }
    let mut known: [Option<Certified>; 3] = [None; 3];
    for p in c.vertex_planes.row(v) {
        let p = &c.planes[p.at()];
        if let Some(axis) = axis_of(&p.n)
            && known[axis].is_none()
        {
            known[axis] = Some(crossing(p, axis));
        }
    }
    let fix = |known: &mut [Option<Certified>; 3], corners: &[[f64; 3]]| {
        for i in 0..3 {
            if corners.iter().all(|p| p[i] == corners[0][i]) {
                known[i] = Some(Certified::exactly(corners[0][i]));
            }
        }
    };
    let mut rest: Vector = [Certified::ZERO; 3];
    match origin {
        Origin::Mesh(_) => {}
        Origin::Edge(e, p) => {
            let [a, b] = c.mesh.edges[e.at()].map(|m| c.mesh.vertices[m.at()]);
            fix(&mut known, &[a, b]);
            if known.contains(&None) {
                let p = &c.planes[p.at()];
                along(&mut rest, &known, [a, b], [value(p, &a), value(p, &b)]);
            }
        }
        Origin::Triangle(t, p, q) => {
            let corners = c.mesh.corners(t);
            fix(&mut known, &corners);
            if known.contains(&None) {
                let row = |p: &Plane| corners.map(|x| value(p, &x));
                let w = cross(&row(&c.planes[p.at()]), &row(&c.planes[q.at()]));
                let sum = w[0] + w[1] + w[2];
                let (s, t) = (w[1] / sum, w[2] / sum);
                for i in 0..3 {
                    if known[i].is_none() {
                        let (u, v) = (
                            Certified::difference(corners[1][i], corners[0][i]),
                            Certified::difference(corners[2][i], corners[0][i]),
                        );
                        rest[i] = Certified::exactly(corners[0][i]) + (s * u + t * v);
                    }
                }
            }
        }
        Origin::EdgeTriangle(e, t) => {
            let [a, b] = c.mesh.edges[e.at()].map(|m| c.mesh.vertices[m.at()]);
            fix(&mut known, &[a, b]);
            let corners = c.mesh.corners(t);
            fix(&mut known, &corners);
            if known.contains(&None) {
                let to =
                    |p: [f64; 3]| -> Vector { std::array::from_fn(|i| Certified::difference(p[i], corners[0][i])) };
                let n = cross(&to(corners[1]), &to(corners[2]));
                along(&mut rest, &known, [a, b], [dot(&n, &to(a)), dot(&n, &to(b))]);
            }
        }
        Origin::Edges(e, f) => {
            let [a, b] = c.mesh.edges[e.at()].map(|m| c.mesh.vertices[m.at()]);
            let [p, q] = c.mesh.edges[f.at()].map(|m| c.mesh.vertices[m.at()]);
            fix(&mut known, &[a, b]);
            fix(&mut known, &[p, q]);
            if known.contains(&None) {
                let axis = crossing_axis(&[a, b], &[p, q]);
                let (u, v) = seen_along(axis);
                let turn = |x: [f64; 3]| {
                    let from = |y: [f64; 3], i: usize| Certified::difference(y[i], p[i]);
                    minor(from(q, u), from(x, v), from(q, v), from(x, u))
                };
                along(&mut rest, &known, [a, b], [turn(a), turn(b)]);
            }
        }
        Origin::Triangles(t, u, v) => {
            let all = [t, u, v].map(|t| c.mesh.corners(t));
            all.iter().for_each(|t| fix(&mut known, t));
            if known.contains(&None) {
                // Relative to a corner of the first.
                let o = all[0][0];
                let meet = all.map(|t| from_corner(&t, &o));
                where_planes_meet(&mut rest, &known, &o, &meet);
            }
        }
        Origin::TrianglesPlane(t, u, p) => {
            let all = [t, u].map(|t| c.mesh.corners(t));
            all.iter().for_each(|t| fix(&mut known, t));
            if known.contains(&None) {
                let (o, p) = (all[0][0], &c.planes[p.at()]);
                let [a, b] = all.map(|t| from_corner(&t, &o));
                where_planes_meet(&mut rest, &known, &o, &[a, b, (exactly(p.n), -value(p, &o))]);
            }
        }
        Origin::Level(i) => {
            let Zero { dim, corners, functions } = &c.levels.points[i as usize];
            let corners = &corners[..=*dim as usize];
            fix(&mut known, corners);
            if known.contains(&None) {
                let rows = functions.each_ref().map(values_of);
                let [p, q, r] = &rows;
                // Of all corners but the first, over the sum of all.
                let weights: Vector = match dim {
                    1 => [p[0] / (p[0] - p[1]), Certified::ZERO, Certified::ZERO],
                    2 => {
                        let three = |x: &[Certified; 4]| [x[0], x[1], x[2]];
                        let w = cross(&three(p), &three(q));
                        let sum = w[0] + w[1] + w[2];
                        [w[1] / sum, w[2] / sum, Certified::ZERO]
                    }
                    _ => {
                        let of = |i: usize, j: usize, k: usize| {
                            dot(&[p[i], p[j], p[k]], &cross(&[q[i], q[j], q[k]], &[r[i], r[j], r[k]]))
                        };
                        let w = [of(1, 2, 3), -of(0, 2, 3), of(0, 1, 3), -of(0, 1, 2)];
                        let sum = w[0] + w[1] + (w[2] + w[3]);
                        [w[1] / sum, w[2] / sum, w[3] / sum]
                    }
                };
                for i in 0..3 {
                    if known[i].is_none() {
                        let step = |k: usize| weights[k] * Certified::difference(corners[k + 1][i], corners[0][i]);
                        let sum = (1..corners.len() - 1).fold(step(0), |sum, k| sum + step(k));
                        rest[i] = Certified::exactly(corners[0][i]) + sum;
                    }
                }
            }
        }
        Origin::Planes(p, q, r) => {
            if known.contains(&None) {
                let planes = [p, q, r].map(|p| &c.planes[p.at()]);
                let [a, b, d] = planes.map(|p| exactly(p.n));
                let (ab, bd, da) = (cross(&a, &b), cross(&b, &d), cross(&d, &a));
                let det = dot(&a, &bd);
                let [x, y, z] = planes.map(|p| Certified::exactly(-p.d));
                for i in 0..3 {
                    if known[i].is_none() {
                        rest[i] = (x * bd[i] + y * da[i] + z * ab[i]) / det;
                    }
                }
            }
        }
    }
    std::array::from_fn(|i| known[i].unwrap_or(rest[i]))
}

/// The normal of a triangle's plane and the plane's value, relative to a point.
fn from_corner(t: &[[f64; 3]; 3], o: &[f64; 3]) -> (Vector, Certified) {
    let to = |p: [f64; 3]| -> Vector { std::array::from_fn(|i| Certified::difference(p[i], t[0][i])) };
    let n = cross(&to(t[1]), &to(t[2]));
    let place: Vector = std::array::from_fn(|i| Certified::difference(t[0][i], o[i]));
    let value = dot(&n, &place);
    (n, value)
}

/// Where three planes n·(x − o) = value meet; the first goes through o. Coordinates that are not known yet.
fn where_planes_meet(
    rest: &mut Vector,
    known: &[Option<Certified>; 3],
    o: &[f64; 3],
    [(a, _), (b, y), (d, z)]: &[(Vector, Certified); 3],
) {
    let (ab, bd, da) = (cross(a, b), cross(b, d), cross(d, a));
    let det = dot(a, &bd);
    for i in 0..3 {
        if known[i].is_none() {
            rest[i] = Certified::exactly(o[i]) + (*y * da[i] + *z * ab[i]) / det;
        }
    }
}

/// The point between a and b where what has these values there vanishes; coordinates that are not known yet.
fn along(rest: &mut Vector, known: &[Option<Certified>; 3], [a, b]: [[f64; 3]; 2], [from, to]: [Certified; 2]) {
    let t = from / (from - to);
    for i in 0..3 {
        if known[i].is_none() {
            rest[i] = Certified::exactly(a[i]) + t * Certified::difference(b[i], a[i]);
        }
    }
}

/// A linear function's values at the corners.
fn values_of(function: &Linear) -> [Certified; 4] {
    std::array::from_fn(|i| Certified::difference(function.first[i], function.second[i]))
}

/// The normal of a face's support, in double-doubles.
fn normal(c: &Complex, f: FaceId) -> Vector {
    match c.face_support[f.at()] {
        SupportId::Plane(p) => exactly(c.planes[p.at()].n),
        SupportId::Triangle(t) => {
            let [a, b, d] = c.mesh.corners(t);
            let to = |p: [f64; 3]| std::array::from_fn(|i| Certified::difference(p[i], a[i]));
            cross(&to(b), &to(d))
        }
        SupportId::Level(p) => {
            let Gradient { corners: [a, b, d, e], function } = &c.levels.supports[p.at()];
            let to = |p: &[f64; 3]| -> Vector { std::array::from_fn(|i| Certified::difference(p[i], a[i])) };
            let (u, v, w) = (to(b), to(d), to(e));
            let [f, g, h, k] = values_of(function);
            let rise = [g - f, h - f, k - f];
            let (vw, wu, uv) = (cross(&v, &w), cross(&w, &u), cross(&u, &v));
            std::array::from_fn(|i| dot(&rise, &[vw[i], wu[i], uv[i]]))
        }
    }
}

/// Rounds each value; `None` if any of them is undecided.
fn round_all<const N: usize>(values: [Certified; N]) -> Option<[f64; N]> {
    let mut out = [0.0; N];
    for i in 0..N {
        out[i] = values[i].rounded()?;
    }
    Some(out)
}

/// Rounds rationals, and flags what is out of range.
fn round_exact<const N: usize>(values: [&rug::Rational; N]) -> Item<N> {
    let rounded = values.map(round_rational);
    let out = (0..N).any(|i| rounded[i].is_infinite() || rounded[i] == 0.0 && !values[i].is_zero());
    Item { values: rounded, flag: out as u8, exact: true }
}

fn add(a: &Vector, b: &Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn face(c: &Complex, points: &[Vector], f: FaceId) -> (FaceSums, Item<6>) {
    let corners = c.face_corners(f);
    let vertices = &c.corner_vertices[corners.clone()];
    let p0 = &points[vertices[0].at()];
    let area;
    let (centroids, place) = if let [_, b, d] = *vertices {
        let (b, d) = (&points[b.at()], &points[d.at()]);
        let (u, v) = (minus(b, p0), minus(d, p0));
        // A triangle on a plane has the plane's direction, exactly; and all triangles have their middle.
        area = match c.face_support[f.at()] {
            SupportId::Triangle(_) => cross(&u, &v).map(|x| x.scaled(0.5)),
            SupportId::Plane(_) | SupportId::Level(_) => polygon(c, points, f, projection(c, f)).area,
        };
        (add(&u, &v), add(&add(p0, b), d).map(Certified::third))
    } else {
        let sums = polygon(c, points, f, projection(c, f));
        area = sums.area;
        match middle(points, vertices) {
            Some(m) => (minus(&m, p0).map(|x| x.times(3.0)), m),
            None => (sums.centroids, add(p0, &sums.centroids.map(Certified::third))),
        }
    };
    let sums = FaceSums { area, centroids };
    let all = [area[0], area[1], area[2], place[0], place[1], place[2]];
    let item = match round_all(all) {
        Some(values) => Item { values, flag: 0, exact: false },
        None => {
            let exact = exact_values::face_values(c, f);
            let ([a, b, d], [x, y, z]) = (&exact.area, &exact.centroid);
            round_exact([a, b, d, x, y, z])
        }
    };
    (sums, item)
}

/// The middle of a parallelogram whose corners are exact.
fn middle(points: &[Vector], vertices: &[VertexId]) -> Option<Vector> {
    let [a, b, d, e] = *vertices else { return None };
    let (p, q) = (add(&points[a.at()], &points[d.at()]), add(&points[b.at()], &points[e.at()]));
    (0..3)
        .all(|i| p[i].err == 0.0 && q[i].err == 0.0 && p[i].hi == q[i].hi && p[i].lo == q[i].lo)
        .then(|| p.map(|x| x.scaled(0.5)))
}

/// Area vector and centroid of any face, with slits and isolated vertices: what is
/// walked twice cancels, and a loop of one vertex contributes nothing.
fn polygon(c: &Complex, points: &[Vector], f: FaceId, pr: Projection) -> FaceSums {
    let depth = 3 - pr.ax - pr.ay;
    let n = normal(c, f);
    let flat = (0..3).all(|i| i == depth || n[i].is_zero());
    let start = c.face_corners(f).start;
    let p0 = &points[c.corner_vertices[start].at()];
    let mut doubled = Certified::ZERO;
    let mut first = [Certified::ZERO; 3];
    for l in c.loops_of(f) {
        let corners = c.corners_of(l);
        let at = |k: usize| minus(&points[c.corner_vertices[k].at()], p0);
        // The first corner of all is the origin: its two sides contribute nothing.
        let (mut a, from) =
            if corners.start == start { (at(start + 1), start + 2) } else { (at(corners.end - 1), corners.start) };
        for k in from..corners.end {
            let b = at(k);
            let w = a[pr.ax] * b[pr.ay] - a[pr.ay] * b[pr.ax];
            doubled = doubled + w;
            for i in 0..3 {
                if !(flat && i == depth) {
                    first[i] = first[i] + w * (a[i] + b[i]);
                }
            }
            a = b;
        }
    }
    let half = doubled.scaled(0.5);
    let size = if n[depth].hi < 0.0 { -n[depth] } else { n[depth] };
    let scale = if flat { half } else { half / size };
    let area = std::array::from_fn(|i| match i == depth {
        true if n[depth].hi < 0.0 => -half,
        true => half,
        false if n[i].is_zero() => Certified::ZERO,
        false => scale * n[i],
    });
    let centroids = std::array::from_fn(|i| if flat && i == depth { Certified::ZERO } else { first[i] / doubled });
    FaceSums { area, centroids }
}

/// Three times the volume V, and the sum of 9V (centroid − corner) of the cones over the faces of a piece of a cell, less
/// the factor 3/4 that a cone's centroid has towards its base's.
fn gather(c: &Complex, points: &[Vector], sums: &[FaceSums], faces: &[HalfFace], o: &Vector) -> [Certified; 4] {
    let mut total = [Certified::ZERO; 4];
    for h in faces {
        let s = &sums[h.face().at()];
        let q = minus(&points[c.corner_vertices[c.face_corners(h.face()).start].at()], o);
        let mut v = Certified::ZERO;
        for i in 0..3 {
            if !s.area[i].is_zero() {
                v = v + s.area[i] * q[i];
            }
        }
        if v.is_zero() {
            continue;
        }
        let v = if h.front() { -v } else { v };
        total[0] = total[0] + v;
        for i in 0..3 {
            total[i + 1] = total[i + 1] + v * (q[i] + q[i].scaled(2.0) + s.centroids[i]);
        }
    }
    total
}

fn cell(c: &Complex, points: &[Vector], sums: &[FaceSums], k: CellId) -> Item<4> {
    let faces = c.cell_faces(k);
    if let Some([low, high]) = box_corners(c, points, faces) {
        let d = minus(&high, &low);
        let volume = d[0] * d[1] * d[2];
        let m = add(&low, &high).map(|x| x.scaled(0.5));
        if let Some(values) = round_all([volume, m[0], m[1], m[2]]) {
            return Item { values, flag: 0, exact: false };
        }
    }
    let first = c.face_corners(faces[0].face()).start;
    let o = &points[c.corner_vertices[first].at()];
    let total = if faces.len() <= PIECE {
        gather(c, points, sums, faces, o)
    } else {
        let pieces: Vec<_> = faces.par_chunks(PIECE).map(|p| gather(c, points, sums, p, o)).collect();
        pieces.iter().fold([Certified::ZERO; 4], |s, p| std::array::from_fn(|i| s[i] + p[i]))
    };
    let volume = total[0].third();
    let weight = total[0].scaled(4.0);
    let m: Vector = std::array::from_fn(|i| o[i] + total[i + 1] / weight);
    match round_all([volume, m[0], m[1], m[2]]) {
        Some(values) => Item { values, flag: 0, exact: false },
        None => {
            let (volume, [x, y, z]) = exact_values::cell_values(c, k);
            round_exact([&volume, &x, &y, &z])
        }
    }
}

/// Lowest and highest corner of a cell that is an axis-aligned box with exact corners: six faces of four corners each on
/// axis-aligned planes. (Such a face is a rectangle, since a straight angle among its four corners would leave a
/// triangle, which has no right angles to spare; and six rectangles close up to a box.)
fn box_corners(c: &Complex, points: &[Vector], faces: &[HalfFace]) -> Option<[Vector; 2]> {
    if faces.len() != 6 {
        return None;
    }
    let p = &points[c.corner_vertices[c.face_corners(faces[0].face()).start].at()];
    let (mut low, mut high) = (*p, *p);
    for h in faces {
        let f = h.face();
        let SupportId::Plane(plane) = c.face_support[f.at()] else { return None };
        axis_of(&c.planes[plane.at()].n)?;
        let corners = c.face_corners(f);
        if corners.len() != 4 || c.face_loops[f.at() + 1] - c.face_loops[f.at()] != 1 {
            return None;
        }
        for k in corners {
            let p = &points[c.corner_vertices[k].at()];
            for i in 0..3 {
                if p[i].err != 0.0 || !p[i].hi.is_finite() {
                    return None;
                }
                let less = |a: &Certified, b: &Certified| a.hi < b.hi || a.hi == b.hi && a.lo < b.lo;
                if less(&p[i], &low[i]) {
                    low[i] = p[i];
                }
                if less(&high[i], &p[i]) {
                    high[i] = p[i];
                }
            }
        }
    }
    Some([low, high])
}

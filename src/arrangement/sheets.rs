//! What planes of half-spaces have in common with triangles and with one another, symbolically.
//!
//! A triangle meets a plane in nothing, a corner, a chord (whose ends are corners or crossings of its sides), one of its sides, or all of itself: signs of input
//! coordinates tell. Two planes meet in a line; what is of interest is its part within the box, whose ends are found in the box's triangles: in each the chord of the one
//! plane is split by the other plane, or has an end on it. The box is convex, so the line is in it between two points, in one or not at all; points are compared
//! exactly. What lies in the box's boundary is there as a chord already.
//!
//! Degenerate cases: a plane through corners or along sides; a plane in which a triangle lies is a cluster with it, as any two triangles that overlap; planes that miss
//! the box have no sheet, those that touch it in a corner or a side have one without area, of which nothing is left in the end; parallel planes do not meet.
//!
//! Cost: for each plane a sign per vertex and a look at each triangle; for each pair of planes twelve triangles of the box.

use super::Soup;
use super::data::Carrier;
use super::pair::Sink;
use super::planar::quick_side;
use super::supports::BOX;
use crate::base::{PlaneId, TriangleId};
use crate::complex::Origin;
use crate::exact::{self, Direction, Plane, Sign, Support};
use std::cmp::Ordering;

/// The side of an input vertex.
#[inline(always)]
fn side(p: &Plane, x: &[f64; 3]) -> Sign {
    quick_side(p, x).unwrap_or_else(|| exact::side(p, x))
}

/// A chord: its ends, and the side that it is if it is one.
struct Chord {
    ends: [Origin; 2],
    carrier: Carrier,
}

/// What a plane has of a triangle whose corners are on these sides, if it meets it but for all of it.
fn chord(soup: &Soup, p: PlaneId, t: TriangleId, s: &[Sign; 3]) -> Option<Chord> {
    let (v, e) = (soup.mesh.triangles[t.at()], soup.mesh.triangle_edges[t.at()]);
    let zero = |i: usize| s[i % 3].is_zero();
    let crosses = |i: usize| !zero(i) && !zero(i + 1) && s[i % 3] != s[(i + 1) % 3];
    if let Some(i) = (0..3).find(|&i| zero(i) && zero(i + 1)) {
        return Some(Chord { ends: [v[i], v[(i + 1) % 3]].map(Origin::Mesh), carrier: Carrier::Edge(e[i]) });
    }
    let mut points = (0..3).filter(|&i| zero(i)).map(|i| Origin::Mesh(v[i]));
    let mut crossings = (0..3).filter(|&i| crosses(i)).map(|i| Origin::Edge(e[i], p));
    let first = points.next().or_else(|| crossings.next())?;
    let ends = [first, crossings.next().unwrap_or(first)];
    Some(Chord { ends, carrier: Carrier::Plane(t) })
}

/// Tells what a plane (one that stands for itself) and all triangles have in common. Returns how many triangles it meets.
pub fn meet_triangles(soup: &Soup, p: PlaneId, sink: &mut impl Sink) -> u64 {
    let (mesh, sheet) = (&*soup.mesh, soup.sheet_of(p));
    let plane = &soup.planes()[p.at()];
    let sides: Vec<Sign> = mesh.vertices.iter().map(|x| side(plane, x)).collect();
    let mut met = 0;
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let s = corners.map(|v| sides[v.at()]);
        if !s[0].is_zero() && s[0] == s[1] && s[0] == s[2] {
            continue;
        }
        let t = TriangleId::of(t);
        if soup.is_passive(t) {
            continue;
        }
        met += 1;
        let Some(Chord { ends, carrier }) = chord(soup, p, t, &s) else { continue };
        if s == [Sign::Zero; 3] {
            sink.overlap(t, sheet);
            continue;
        }
        for end in ends {
            if let Origin::Edge(e, _) = end {
                sink.on_edge(e, end);
            }
        }
        if ends[0] == ends[1] {
            // The same for all triangles around the corner.
            sink.in_triangle(sheet, ends, Carrier::Plane(sheet));
            continue;
        }
        if carrier == Carrier::Plane(t) {
            sink.in_triangle(t, ends, Carrier::Plane(sheet));
        }
        sink.in_triangle(sheet, ends, carrier);
    }
    met
}

/// Tells what two planes (each stands for itself) have in common within the box. Returns whether that is a segment.
pub fn meet_planes(soup: &Soup, p: PlaneId, q: PlaneId, sink: &mut impl Sink) -> bool {
    let planes = [p, q].map(|p| soup.planes()[p.at()]);
    let mut found: Vec<Origin> = Vec::new();
    for t in (0..BOX).map(|k| soup.box_triangle(0, k)) {
        let corners = soup.mesh.corners(t);
        let [of_p, of_q] = planes.map(|plane| corners.map(|x| side(&plane, &x)));
        // A triangle in the one plane has with the other one the chord of that.
        let (own, s, other) = if of_p == [Sign::Zero; 3] { (q, of_q, 0) } else { (p, of_p, 1) };
        let Some(Chord { ends, .. }) = chord(soup, own, t, &s) else { continue };
        let other = Support::Plane(planes[other]);
        let [a, b] = ends.map(|end| exact::support_side(&other, &soup.point(end)));
        if a.is_zero() {
            found.push(ends[0]);
        }
        if b.is_zero() {
            found.push(ends[1]);
        }
        if !a.is_zero() && !b.is_zero() && a != b {
            found.push(Origin::Triangle(t, p.min(q), p.max(q)));
        }
    }
    let order = |a: &Origin, b: &Origin| {
        let (x, y) = (soup.point(*a), soup.point(*b));
        (0..3).map(|axis| exact::compare_coordinate(&x, &y, axis)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
    };
    let Some(&first) = found.iter().min_by(|a, b| order(a, b)) else { return false };
    let Some(&last) = found.iter().max_by(|a, b| order(a, b)) else { return false };
    if order(&first, &last).is_eq() {
        return false;
    }
    let [of_p, of_q] = [p, q].map(|p| soup.sheet_of(p));
    sink.in_triangle(of_p, [first, last], Carrier::Plane(of_q));
    sink.in_triangle(of_q, [first, last], Carrier::Plane(of_p));
    true
}

/// Whether two planes that do not coincide do not meet.
pub fn are_parallel(a: &Plane, b: &Plane) -> bool {
    if a.n == b.n || a.n == b.n.map(|x| -x) {
        return true;
    }
    let unit = |axis: usize| Direction::Plane(std::array::from_fn(|i| (i == axis) as u8 as f64));
    let (a, b) = (Direction::Plane(a.n), Direction::Plane(b.n));
    (0..3).all(|axis| exact::determinant(&a, &b, &unit(axis)).is_zero())
}

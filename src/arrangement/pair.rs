//! What two triangles have in common, symbolically (section 3.1 of the Mesh Arrangements paper): nothing, a point, a segment, or an overlap in their
//! common plane. Signs of input coordinates alone; no constructed point is read.
//!
//! Not in one plane, both triangles meet the line L of their planes in a segment (or a point), whose ends are corners or crossings of sides. An end is
//! an oriented pair of corners, from behind the other plane (or on it) to before it (or on it), one of them off it; then the order along L of an
//! end (p, P) of A and one (q, Q) of B is the sign of orient3d(p, P, q, Q): along n_B × n_A, q comes after p where it is negative. (Put L on the x-axis,
//! B in y = 0 and A in z = 0: the determinant is −4 (q − p).) Which end of a triangle comes first follows from its orientation: A's
//! boundary rises through B's plane at A's last end, B's rises through A's plane at B's first end.
//!
//! In one plane, signs of turns of the corners of one about the sides of the other tell everything.
//!
//! Cost: 6 to 13 signs of determinants for triangles that meet; one or two for most neighbours.

use crate::base::{EdgeId, TriangleId, VertexId};
use crate::complex::Origin;
use crate::exact::{Sign, orient3d};
use crate::mesh::TriMesh;
use crate::mesh::projection::{open_axis, turn};
use crate::mesh::self_intersection::{certainly_apart, contact};

use super::data::Carrier;

/// What is found: told point by point. A point within an edge is told for the edge, a segment or a point within a triangle for the triangle.
pub trait Sink {
    fn on_edge(&mut self, edge: EdgeId, point: Origin);
    /// Ends may be equal.
    fn in_triangle(&mut self, triangle: TriangleId, ends: [Origin; 2], carrier: Carrier);
    /// The two overlap in an area.
    fn overlap(&mut self, a: TriangleId, b: TriangleId);
}

/// A triangle with what is asked about it again and again.
#[derive(Clone, Copy)]
struct Side<'a> {
    id: TriangleId,
    v: [VertexId; 3],
    x: [&'a [f64; 3]; 3],
    edges: [EdgeId; 3],
}

impl<'a> Side<'a> {
    fn new(mesh: &'a TriMesh, id: TriangleId) -> Self {
        let v = mesh.triangles[id.at()];
        Self { id, v, x: v.map(|v| &mesh.vertices[v.at()]), edges: mesh.triangle_edges[id.at()] }
    }
}

/// Sides of the corners of `a` of the plane of `b`; shared corners are on it.
fn sides(a: &Side, b: &Side) -> [Sign; 3] {
    std::array::from_fn(|i| if b.v.contains(&a.v[i]) { Sign::Zero } else { orient3d(b.x[0], b.x[1], b.x[2], a.x[i]) })
}

/// An end of what a triangle has in common with the other plane.
#[derive(Clone, Copy)]
struct End<'a> {
    /// A corner, or the side that crosses.
    at: At,
    from: &'a [f64; 3],
    to: &'a [f64; 3],
}

#[derive(Clone, Copy, PartialEq)]
enum At {
    Corner(VertexId),
    Crossing(EdgeId),
}

/// What a triangle has in common with the other plane: its ends along n_B × n_A, and the side that lies in the plane, if one does.
struct Trace<'a> {
    first: End<'a>,
    last: End<'a>,
    side: Option<EdgeId>,
}

/// `rises_last`: see the head of this file.
fn trace<'a>(t: &Side<'a>, s: &[Sign; 3], rises_last: bool) -> Trace<'a> {
    let corner = |i: usize| {
        // Any corner off the plane will do.
        let off = (0..3).find(|&k| !s[k].is_zero()).unwrap_or(i);
        let (from, to) = if s[off] == Sign::Positive { (t.x[i], t.x[off]) } else { (t.x[off], t.x[i]) };
        End { at: At::Corner(t.v[i]), from, to }
    };
    let crossing = |i: usize| {
        let j = (i + 1) % 3;
        let (from, to) = if s[i] == Sign::Negative { (t.x[i], t.x[j]) } else { (t.x[j], t.x[i]) };
        End { at: At::Crossing(t.edges[i]), from, to }
    };
    let zeros = s.iter().filter(|s| s.is_zero()).count();
    let ordered = |rising: End<'a>, falling: End<'a>, side: Option<EdgeId>| {
        let (first, last) = if rises_last { (falling, rising) } else { (rising, falling) };
        Trace { first, last, side }
    };
    match zeros {
        2 => {
            // The side from corner i to j is in the plane. Its triangle before it: the boundary comes from before, falls to i, and rises at j.
            let k = (0..3).find(|&k| !s[k].is_zero()).unwrap_or(0);
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (rising, falling) = if s[k] == Sign::Positive { (j, i) } else { (i, j) };
            ordered(corner(rising), corner(falling), Some(t.edges[i]))
        }
        1 => {
            let i = (0..3).find(|&i| s[i].is_zero()).unwrap_or(0);
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            if s[j] == s[k] {
                return Trace { first: corner(i), last: corner(i), side: None };
            }
            let (at, across) = (corner(i), crossing(j));
            if s[j] == Sign::Positive { ordered(at, across, None) } else { ordered(across, at, None) }
        }
        _ => {
            // Two sides cross.
            let rising = (0..3).find(|&i| s[i] == Sign::Negative && s[(i + 1) % 3] == Sign::Positive).unwrap_or(0);
            let falling = (0..3).find(|&i| s[i] == Sign::Positive && s[(i + 1) % 3] == Sign::Negative).unwrap_or(0);
            ordered(crossing(rising), crossing(falling), None)
        }
    }
}

/// Whether the end of B comes after that of A (positive), before it, or is the same point.
fn order(p: &End, q: &End) -> Sign {
    match (p.at, q.at) {
        (At::Corner(a), At::Corner(b)) if a == b => Sign::Zero,
        _ => -orient3d(p.from, p.to, q.from, q.to),
    }
}

/// Tells what two triangles have in common beyond the corners and sides that they share by index. Returns whether that is anything.
pub fn meet(mesh: &TriMesh, a: TriangleId, b: TriangleId, sink: &mut impl Sink) -> bool {
    // Nearly all candidates end here, neighbours in one plane above all, by signs that doubles can tell. Where nothing is shared, the exact
    // signs of what follows tell as well.
    let [p, q] = [a, b].map(|t| &mesh.triangles[t.at()]);
    let shared = p.iter().any(|v| q.contains(v));
    let in_contact = || contact(&mesh.vertices, p, q);
    if if shared { !in_contact() } else { certainly_apart(&mesh.corners(a), &mesh.corners(b)) } {
        return false;
    }
    let (a, b) = (Side::new(mesh, a), Side::new(mesh, b));
    let apart = |s: &[Sign; 3]| !s[0].is_zero() && s[0] == s[1] && s[0] == s[2];
    let of_a = sides(&a, &b);
    if of_a == [Sign::Zero; 3] {
        return (shared || in_contact()) && coplanar(&a, &b, sink);
    }
    if apart(&of_a) {
        return false;
    }
    let of_b = sides(&b, &a);
    !apart(&of_b) && crossing(&a, &b, &of_a, &of_b, sink)
}

/// One end of the common segment: of A alone, of B alone, or of both.
#[derive(Clone, Copy)]
enum Which {
    A(At),
    B(At),
    Both(At, At),
}

fn crossing(a: &Side, b: &Side, of_a: &[Sign; 3], of_b: &[Sign; 3], sink: &mut impl Sink) -> bool {
    let (of_a, of_b) = (trace(a, of_a, true), trace(b, of_b, false));
    let (front, back) = (order(&of_a.last, &of_b.first), order(&of_a.first, &of_b.last));
    if front == Sign::Positive || back == Sign::Negative {
        return false;
    }
    let [lower, upper] = if front.is_zero() {
        [Which::Both(of_a.last.at, of_b.first.at); 2]
    } else if back.is_zero() {
        [Which::Both(of_a.first.at, of_b.last.at); 2]
    } else {
        let lower = match order(&of_a.first, &of_b.first) {
            Sign::Positive => Which::B(of_b.first.at),
            Sign::Negative => Which::A(of_a.first.at),
            Sign::Zero => Which::Both(of_a.first.at, of_b.first.at),
        };
        let upper = match order(&of_a.last, &of_b.last) {
            Sign::Positive => Which::A(of_a.last.at),
            Sign::Negative => Which::B(of_b.last.at),
            Sign::Zero => Which::Both(of_a.last.at, of_b.last.at),
        };
        [lower, upper]
    };
    let (from, mut found) = name(a, b, &of_a, &of_b, lower, sink);
    let (to, told) = name(a, b, &of_a, &of_b, upper, sink);
    found |= told;
    // What lies along a side of a triangle, or at its boundary, is told for the side.
    if of_a.side.is_none() && (from != to || matches!(lower, Which::B(_))) {
        sink.in_triangle(a.id, [from, to], of_b.side.map_or(Carrier::Plane(b.id), Carrier::Edge));
        found = true;
    }
    if of_b.side.is_none() && (from != to || matches!(lower, Which::A(_))) {
        sink.in_triangle(b.id, [from, to], of_a.side.map_or(Carrier::Plane(a.id), Carrier::Edge));
        found = true;
    }
    found
}

/// The name of an end; tells it to the edges that hold it inside. Whether there was one.
fn name(a: &Side, b: &Side, of_a: &Trace, of_b: &Trace, end: Which, sink: &mut impl Sink) -> (Origin, bool) {
    // The end of one triangle and what holds it in the other: a corner or a side, or its inside.
    let (at, other) = match end {
        Which::Both(p, q) => (p, Some(q)),
        Which::A(p) => (p, of_b.side.map(At::Crossing)),
        Which::B(q) => (q, of_a.side.map(At::Crossing)),
    };
    match (at, other) {
        (At::Corner(u), Some(At::Corner(_))) => (Origin::Mesh(u), false),
        (At::Corner(u), Some(At::Crossing(e))) | (At::Crossing(e), Some(At::Corner(u))) => {
            sink.on_edge(e, Origin::Mesh(u));
            (Origin::Mesh(u), true)
        }
        (At::Crossing(e), Some(At::Crossing(f))) => {
            let point = Origin::Edges(e.min(f), e.max(f));
            sink.on_edge(e, point);
            sink.on_edge(f, point);
            (point, true)
        }
        (At::Corner(u), None) => (Origin::Mesh(u), false),
        (At::Crossing(e), None) => {
            let into = if matches!(end, Which::A(_)) { b.id } else { a.id };
            let point = Origin::EdgeTriangle(e, into);
            sink.on_edge(e, point);
            (point, true)
        }
    }
}

/// Two triangles in one plane.
fn coplanar(a: &Side, b: &Side, sink: &mut impl Sink) -> bool {
    let (axis, inside_a) = open_axis(&a.x.map(|x| *x));
    let inside_b = turn(b.x[0], b.x[1], b.x[2], axis);
    // Row k: where the corners of one are of side k of the other, positive inside.
    let turns = |t: &Side, inside: Sign, of: &Side| -> [[Sign; 3]; 3] {
        std::array::from_fn(|k| {
            std::array::from_fn(|i| match (0..3).find(|&j| t.v[j] == of.v[i]) {
                Some(j) if j == (k + 2) % 3 => Sign::Positive,
                Some(_) => Sign::Zero,
                None => turn(t.x[k], t.x[(k + 1) % 3], of.x[i], axis) * inside,
            })
        })
    };
    let (about_b, about_a) = (turns(b, inside_b, a), turns(a, inside_a, b));
    let mut found = false;
    for (t, of, about) in [(b, a, &about_b), (a, b, &about_a)] {
        for i in (0..3).filter(|&i| !t.v.contains(&of.v[i])) {
            let column = [about[0][i], about[1][i], about[2][i]];
            if column.contains(&Sign::Negative) {
                continue;
            }
            if let Some(k) = column.iter().position(|s| s.is_zero()) {
                sink.on_edge(t.edges[k], Origin::Mesh(of.v[i]));
                found = true;
            }
        }
    }
    let opposite = |x: Sign, y: Sign| x * y == Sign::Negative;
    for i in 0..3 {
        for k in 0..3 {
            let (j, l) = ((i + 1) % 3, (k + 1) % 3);
            if opposite(about_b[k][i], about_b[k][j]) && opposite(about_a[i][k], about_a[i][l]) {
                let (e, f) = (a.edges[i], b.edges[k]);
                let point = Origin::Edges(e.min(f), e.max(f));
                sink.on_edge(e, point);
                sink.on_edge(f, point);
                found = true;
            }
        }
    }
    // The insides are apart exactly if a side of one has the other outside.
    let separates = |row: &[Sign; 3]| !row.contains(&Sign::Positive);
    if !about_b.iter().any(separates) && !about_a.iter().any(separates) {
        sink.overlap(a.id.min(b.id), a.id.max(b.id));
        found = true;
    }
    found
}

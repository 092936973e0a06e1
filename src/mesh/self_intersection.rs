//! Exact self-intersection: any contact of two triangles other than a vertex or an edge that they share by index.
//!
//! Candidate pairs come from the box hierarchy. What a pair shares by index decides what is left to ask:
//! all three corners: they coincide; an edge: they meet elsewhere only if they lie in one plane, folded onto each other; a
//! vertex: a further contact reaches the side opposite to it in one of the two; nothing: any contact reaches a side of one
//! of them. So everything is "does a closed segment meet a closed triangle", from `orient3d` signs, and in one plane
//! from turns.
//!
//! Before that, a strict separation seen along one axis is tried in doubles. It settles nearly all neighbours, and above all
//! those in one plane, for which the exact signs are zero and dear.
//!
//! Triangles are not degenerate and coordinates finite. Touching counts: at a point, along an edge, in an area.
//!
//! Cost: the pairs whose boxes meet, some twelve per triangle for an ordinary mesh, two or three signs each.

use super::bvh::Bvh;
use super::projection::{certain_turn, largest_axis, open_axis, seen_along, turn};
use crate::base::{TriangleId, VertexId, Watch};
use crate::exact::{Sign, orient3d};

type Corners = [[f64; 3]; 3];

/// Pairs between two looks at the caller's wish to stop.
const OFTEN: usize = 1 << 8;

/// The pairs of triangles in contact, lower id first, sorted. Stops at `limit` pairs (which ones is fixed by the input, but
/// they need not be the lowest).
pub fn self_intersections(
    vertices: &[[f64; 3]],
    triangles: &[[VertexId; 3]],
    bvh: &Bvh,
    limit: usize,
) -> Vec<[TriangleId; 2]> {
    self_intersections_watched(vertices, triangles, bvh, limit, &Watch::quiet())
}

/// The same; told to stop it returns some of them.
pub fn self_intersections_watched(
    vertices: &[[f64; 3]],
    triangles: &[[VertexId; 3]],
    bvh: &Bvh,
    limit: usize,
    watch: &Watch,
) -> Vec<[TriangleId; 2]> {
    let (mut found, mut asked) = (Vec::new(), 0);
    if limit == 0 {
        return found;
    }
    bvh.meeting_pairs(|a, b| {
        if contact(vertices, &triangles[a.at()], &triangles[b.at()]) {
            found.push([a.min(b), a.max(b)]);
        }
        asked += 1;
        found.len() < limit && (asked % OFTEN != 0 || watch.go_on())
    });
    found.sort_unstable();
    found
}

/// Whether two triangles meet outside what they share by index.
pub fn contact(vertices: &[[f64; 3]], p: &[VertexId; 3], q: &[VertexId; 3]) -> bool {
    // Rotate each so that shared corners come first.
    let in_q = p.map(|v| q.contains(&v));
    let at =
        |t: &[VertexId; 3], start: usize| -> Corners { std::array::from_fn(|i| vertices[t[(start + i) % 3].at()]) };
    match in_q.iter().filter(|s| **s).count() {
        0 => disjoint_by_index(&at(p, 0), &at(q, 0)),
        1 => {
            let i = in_q.iter().position(|s| *s).unwrap_or(0);
            let j = q.iter().position(|v| *v == p[i]).unwrap_or(0);
            sharing_a_vertex(&at(p, i), &at(q, j))
        }
        2 => {
            let i = in_q.iter().position(|s| !*s).unwrap_or(0);
            let j = q.iter().position(|v| !p.contains(v)).unwrap_or(0);
            folded(&at(p, i), &vertices[q[j].at()])
        }
        _ => true,
    }
}

/// Apexes t[0] and `other` over the edge t[1], t[2]: in one plane and on the same side of the edge.
fn folded(t: &Corners, other: &[f64; 3]) -> bool {
    // Seen from anywhere, apexes strictly on either side of the edge are not folded onto each other.
    let axis = largest_axis(t);
    if let (Some(a), Some(b)) = (seen(&t[1], &t[2], &t[0], axis), seen(&t[1], &t[2], other, axis))
        && a != b
    {
        return false;
    }
    if orient3d(&t[0], &t[1], &t[2], other) != Sign::Zero {
        return false;
    }
    let (axis, sign) = open_axis(t);
    turn(&t[1], &t[2], other, axis) == sign
}

/// The two share corner 0.
fn sharing_a_vertex(p: &Corners, q: &Corners) -> bool {
    // Seen along an axis, the line of a side at the shared corner may have the rest of its own triangle strictly on one
    // hand and the other triangle, but for the corner, strictly on the other.
    let axis = largest_axis(p);
    let splits = |s: &Corners, t: &Corners, i: usize| {
        seen(&s[0], &s[i], &s[3 - i], axis).is_some_and(|own| {
            let other = Some(-own);
            seen(&s[0], &s[i], &t[1], axis) == other && seen(&s[0], &s[i], &t[2], axis) == other
        })
    };
    if splits(p, q, 1) || splits(p, q, 2) || splits(q, p, 1) || splits(q, p, 2) {
        return false;
    }
    let of_p = [orient3d(&q[0], &q[1], &q[2], &p[1]), orient3d(&q[0], &q[1], &q[2], &p[2])];
    if of_p[0] == of_p[1] && of_p[0] != Sign::Zero {
        return false;
    }
    if segment_meets([&p[1], &p[2]], of_p, q) {
        return true;
    }
    if of_p == [Sign::Zero; 2] {
        return coplanar_segment_meets([&q[1], &q[2]], p);
    }
    let of_q = [orient3d(&p[0], &p[1], &p[2], &q[1]), orient3d(&p[0], &p[1], &p[2], &q[2])];
    segment_meets([&q[1], &q[2]], of_q, p)
}

/// Whether two triangles that share no corner are certainly apart, as doubles see them along one axis.
#[inline]
pub fn certainly_apart(p: &Corners, q: &Corners) -> bool {
    let axis = largest_axis(p);
    parted(p, q, axis) || parted(q, p, axis)
}

fn disjoint_by_index(p: &Corners, q: &Corners) -> bool {
    if certainly_apart(p, q) {
        return false;
    }
    let of_p: [Sign; 3] = std::array::from_fn(|i| orient3d(&q[0], &q[1], &q[2], &p[i]));
    if one_sided(&of_p) {
        return false;
    }
    let of_q: [Sign; 3] = std::array::from_fn(|i| orient3d(&p[0], &p[1], &p[2], &q[i]));
    if one_sided(&of_q) {
        return false;
    }
    if of_p == [Sign::Zero; 3] {
        return coplanar_meet(p, q);
    }
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        segment_meets([&p[i], &p[j]], [of_p[i], of_p[j]], q) || segment_meets([&q[i], &q[j]], [of_q[i], of_q[j]], p)
    })
}

/// The turn a → b → c seen along an axis, if doubles can tell.
#[inline(always)]
fn seen(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3], axis: usize) -> Option<Sign> {
    let (u, v) = seen_along(axis);
    certain_turn(b[u] - a[u], b[v] - a[v], c[u] - a[u], c[v] - a[v])
}

/// Whether, seen along an axis, the line of a side of `s` certainly has `t` strictly on its outer hand.
#[inline]
fn parted(s: &Corners, t: &Corners, axis: usize) -> bool {
    let Some(inside) = seen(&s[0], &s[1], &s[2], axis) else { return false };
    let outside = Some(-inside);
    (0..3).any(|i| {
        let (a, b) = (&s[i], &s[(i + 1) % 3]);
        t.iter().all(|x| seen(a, b, x, axis) == outside)
    })
}

/// All strictly on one side.
fn one_sided(s: &[Sign; 3]) -> bool {
    s[0] != Sign::Zero && s[0] == s[1] && s[0] == s[2]
}

/// Whether a closed segment meets a closed triangle. `side` are its ends' sides of the triangle's plane.
fn segment_meets(segment: [&[f64; 3]; 2], side: [Sign; 2], t: &Corners) -> bool {
    if side[0] == side[1] {
        return side[0] == Sign::Zero && coplanar_segment_meets(segment, t);
    }
    // The segment's line meets the plane in one point, and that point is on the segment. It is outside the triangle when
    // the line passes two sides in opposite turns.
    let [a, b] = segment;
    let mut seen = Sign::Zero;
    for i in 0..3 {
        let s = orient3d(a, b, &t[i], &t[(i + 1) % 3]);
        if s == Sign::Zero {
            continue;
        }
        if seen == Sign::Zero {
            seen = s;
        } else if seen != s {
            return false;
        }
    }
    true
}

/// The same in the triangle's plane: a triangle and a segment are disjoint exactly when the line of one of the triangle's
/// sides, or of the segment, separates them strictly (these are the normals of their Minkowski difference).
fn coplanar_segment_meets(segment: [&[f64; 3]; 2], t: &Corners) -> bool {
    let (axis, inside) = open_axis(t);
    let [a, b] = segment;
    for i in 0..3 {
        let j = (i + 1) % 3;
        if turn(&t[i], &t[j], a, axis) == -inside && turn(&t[i], &t[j], b, axis) == -inside {
            return false;
        }
    }
    let sides: [Sign; 3] = std::array::from_fn(|i| turn(a, b, &t[i], axis));
    !one_sided(&sides)
}

/// Two triangles in one plane: disjoint exactly when a side of one separates them strictly.
fn coplanar_meet(p: &Corners, q: &Corners) -> bool {
    let (axis, of_p) = open_axis(p);
    let of_q = turn(&q[0], &q[1], &q[2], axis);
    let separates = |s: &Corners, inside: Sign, t: &Corners| {
        (0..3).any(|i| t.iter().all(|x| turn(&s[i], &s[(i + 1) % 3], x, axis) == -inside))
    };
    !separates(p, of_p, q) && !separates(q, of_q, p)
}

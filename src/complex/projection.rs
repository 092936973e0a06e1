//! A face seen in two dimensions: its plane projected along the axis in which the exact normal is not zero,
//! turned so that counter-clockwise in the projection is counter-clockwise about the face's normal.
//!
//! Decisions are exact. The filter reads the correctly rounded coordinates of the complex, each of which is off by
//! at most half an ulp, so its bound covers the rounding of the points as well as that of the arithmetic; what it
//! cannot certify is asked of the incidences (straight angles along a cut), then of the kernel with the symbolic points. Order along an axis needs no bound at all: correct
//! rounding is monotone, so different rounded coordinates are in the order of the exact ones.
//! Cost: a few nanoseconds where the filter decides.

use super::data::{Complex, Origin, SupportId};
use crate::base::{FaceId, PlaneId, VertexId};
use crate::exact::{self, Direction, Gradient, Linear, Point, Sign};
use std::cmp::Ordering;

/// The two coordinate axes that a face is seen in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projection {
    pub ax: usize,
    pub ay: usize,
    /// The plane that the face lies on, `NONE` if none.
    plane: PlaneId,
}

impl Projection {
    /// Along `axis`, with the normal's component there positive or negative.
    fn along(axis: usize, positive: bool, plane: PlaneId) -> Self {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        if positive { Self { ax: u, ay: v, plane } } else { Self { ax: v, ay: u, plane } }
    }
}

/// The projection of a face: along the component of its support's normal that is largest in floating point (only
/// a preference) and not zero, exactly.
pub fn projection(c: &Complex, f: FaceId) -> Projection {
    let n = match c.face_support[f.at()] {
        SupportId::Plane(p) => c.planes[p.at()].n,
        SupportId::Triangle(t) => {
            let [a, b, d] = c.mesh.corners(t);
            let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
            let v = [d[0] - a[0], d[1] - a[1], d[2] - a[2]];
            [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        }
        SupportId::Level(p) => {
            let Gradient { corners: [a, b, d, e], function: Linear { first, second } } = &c.levels.supports[p.at()];
            let to = |p: &[f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
            let cross = |u: [f64; 3], v: [f64; 3]| {
                [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            };
            let rise = |i: usize| (first[i] - second[i]) - (first[0] - second[0]);
            let (u, v, w) = (to(b), to(d), to(e));
            let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
            std::array::from_fn(|i| rise(1) * vw[i] + rise(2) * wu[i] + rise(3) * uv[i])
        }
    };
    let plane = c.face_plane[f.at()];
    let mut axes = [0, 1, 2];
    // Not a number sorts as zero; the order of three axes by a total order of magnitudes.
    let size = |i: usize| if n[i].is_nan() { 0.0 } else { n[i].abs() };
    axes.sort_by(|&i, &j| size(j).total_cmp(&size(i)));
    for axis in axes {
        let sign = match c.face_support[f.at()] {
            SupportId::Plane(_) if n[axis] > 0.0 => Sign::Positive,
            SupportId::Plane(_) if n[axis] < 0.0 => Sign::Negative,
            SupportId::Plane(_) => Sign::Zero,
            SupportId::Level(p) => {
                let unit = |i: usize| Direction::Plane(std::array::from_fn(|j| (j == i % 3) as u8 as f64));
                exact::determinant(&Direction::Gradient(c.levels.supports[p.at()]), &unit(axis + 1), &unit(axis + 2))
            }
            SupportId::Triangle(t) => {
                let [a, b, d] = c.mesh.corners(t);
                exact::turn_projected(
                    &Point::Vertex(a),
                    &Point::Vertex(b),
                    &Point::Vertex(d),
                    (axis + 1) % 3,
                    (axis + 2) % 3,
                )
            }
        };
        match sign {
            Sign::Positive => return Projection::along(axis, true, plane),
            Sign::Negative => return Projection::along(axis, false, plane),
            Sign::Zero => {}
        }
    }
    // A support has a normal; a degenerate one was refused where the input came in.
    Projection::along(2, true, plane)
}

/// The turn a → b → d as seen in the projection: positive is to the left.
///
/// Filter: with u = 2⁻⁵³, M the largest of the six magnitudes, rounded coordinates are within uM of the exact ones
/// and a computed difference within 2uM + 2uM of the exact one (second order included below). With differences
/// D₁…D₄ the determinant is then within 4uM·ΣD (inputs) + u(|p₁| + |p₂| + |p₁ − p₂|) (products and subtraction, each
/// product at most 2M times a difference) + 32u²M² of the exact one: below 16uM·ΣD + 64u²M². A subnormal rounding
/// or product adds at most 2⁻¹⁰⁷⁴·(4M + 4) more: below 2⁻¹⁰⁶⁰·(M + 1). Overflow makes the bound infinite or the
/// comparison false.
pub fn turn(c: &Complex, pr: Projection, a: VertexId, b: VertexId, d: VertexId) -> Sign {
    if a == b || b == d || a == d {
        return Sign::Zero;
    }
    let (pa, pb, pd) = (&c.coords[a.at()], &c.coords[b.at()], &c.coords[d.at()]);
    let (ax, ay, bx, by, dx, dy) = (pa[pr.ax], pa[pr.ay], pb[pr.ax], pb[pr.ay], pd[pr.ax], pd[pr.ay]);
    let (ux, uy, vx, vy) = (bx - ax, by - ay, dx - ax, dy - ay);
    let det = ux * vy - uy * vx;
    let m = ax.abs().max(ay.abs()).max(bx.abs()).max(by.abs()).max(dx.abs()).max(dy.abs());
    let spread = ux.abs() + uy.abs() + vx.abs() + vy.abs();
    const U: f64 = f64::EPSILON / 2.0;
    // 2⁻¹⁰⁶⁰
    const TINY: f64 = f64::from_bits(1 << 14);
    let bound = 16.0 * U * m * spread + 64.0 * U * U * m * m + TINY * (m + 1.0);
    if det > bound {
        return Sign::Positive;
    }
    if det < -bound {
        return Sign::Negative;
    }
    if collinear(c, pr, a, b, d) {
        return Sign::Zero;
    }
    exact::turn_projected(&c.point(a), &c.point(b), &c.point(d), pr.ax, pr.ay)
}

/// Whether incidences alone put three vertices of a face on one line: on a plane other than the face's (the face lies
/// in two different planes there), or on one mesh edge. Straight angles nearly always are of this kind.
fn collinear(c: &Complex, pr: Projection, a: VertexId, b: VertexId, d: VertexId) -> bool {
    let (p, q, r) = (c.vertex_planes.row(a), c.vertex_planes.row(b), c.vertex_planes.row(d));
    if q.iter().any(|x| *x != pr.plane && p.contains(x) && r.contains(x)) {
        return true;
    }
    let origins = [a, b, d].map(|v| c.origins[v.at()]);
    let edge = origins.iter().find_map(|o| if let Origin::Edge(e, _) = o { Some(*e) } else { None });
    edge.is_some_and(|e| {
        origins.iter().all(|o| match o {
            Origin::Mesh(v) => c.mesh.edges[e.at()].contains(v),
            Origin::Edge(other, _) => *other == e,
            _ => false,
        })
    })
}

/// Order of two vertices along one axis, exactly.
pub fn compare_axis(c: &Complex, a: VertexId, b: VertexId, axis: usize) -> Ordering {
    let (x, y) = (c.coords[a.at()][axis], c.coords[b.at()][axis]);
    if a == b || x == y && level(c, a, b, axis) {
        return Ordering::Equal;
    }
    exact::compare_rounded(x, y, || c.point(a), || c.point(b), axis)
}

/// Whether two vertices are on one plane across `axis`.
fn level(c: &Complex, a: VertexId, b: VertexId, axis: usize) -> bool {
    let across = |p: &PlaneId| (0..3).all(|i| i == axis || c.planes[p.at()].n[i] == 0.0);
    c.vertex_planes.row(a).iter().any(|p| across(p) && c.vertex_planes.row(b).contains(p))
}

/// Lexicographic order in the projection. Two vertices of one face are equal only if they are the same.
pub fn compare(c: &Complex, pr: Projection, a: VertexId, b: VertexId) -> Ordering {
    if a == b {
        return Ordering::Equal;
    }
    compare_axis(c, a, b, pr.ax).then_with(|| compare_axis(c, a, b, pr.ay))
}

/// Lexicographic order in space: an order of the points themselves, whatever their labels.
pub fn compare_points(c: &Complex, a: VertexId, b: VertexId) -> Ordering {
    if a == b {
        return Ordering::Equal;
    }
    compare_axis(c, a, b, 0).then_with(|| compare_axis(c, a, b, 1)).then_with(|| compare_axis(c, a, b, 2))
}

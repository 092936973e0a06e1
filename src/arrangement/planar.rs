//! Signs in the plane of a cluster: the side of a vertex of a segment's line, and the turn of three vertices, seen along an axis.
//!
//! Each asks what is known first (a point that is named by the line's carrier is on it), then doubles (rounded coordinates are within half an ulp
//! of the exact ones: a bound follows), then exactly.
//!
//! Error of a turn in doubles, with M no smaller than any |coordinate| and u = 2⁻⁵³: each coordinate is off by uM, each difference by 2uM and its
//! own rounding, so each product by 3uM times the other factor, and the determinant by less than 4uM·Σ|differences| + 16u²M² + 4u·Σ|products|.
//! The side of a triangle's plane: n·d with n = e × f exact but for rounding; d = x − b is off by 2uM in each coordinate: Σ mᵢ (2uM + 16u|dᵢ|)
//! where mᵢ bounds |nᵢ|; doubled.

use super::data::{Carrier, Points, Soup};
use super::points;
use crate::base::{EdgeId, PlaneId, TriangleId, VertexId};
use crate::complex::Origin;
use crate::exact::counters::{Predicate, Tier, count};
use crate::exact::{self, Sign, Support};
use crate::mesh::projection::{ROUNDOFF, seen_along};

/// A plane to work in: that of a triangle.
#[derive(Clone, Copy)]
pub struct Plane<'a> {
    pub soup: &'a Soup,
    pub points: &'a Points,
    /// A triangle in the plane.
    pub of: TriangleId,
    pub axis: usize,
    /// How the triangle turns, seen along the axis.
    pub orientation: Sign,
    /// No smaller than any coordinate's magnitude.
    most: f64,
}

/// No underflow matters above.
const TINY: f64 = 1e-280;

impl<'a> Plane<'a> {
    pub fn new(soup: &'a Soup, points: &'a Points, of: TriangleId) -> Self {
        let (axis, orientation) = soup.open_axis(of);
        let most = soup.mesh.bbox.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        Self { soup, points, of, axis, orientation, most }
    }

    #[inline(always)]
    pub fn place(&self, v: VertexId) -> [f64; 3] {
        points::place(self.soup, self.points, v)
    }

    #[inline(always)]
    pub fn origin(&self, v: VertexId) -> Origin {
        points::origin(self.soup, self.points, v)
    }

    /// Whether a vertex is on an edge, or in the plane of a triangle, as its name says. (It may be although its name does not.)
    fn named(&self, origin: Origin, carrier: Carrier) -> bool {
        let mesh = &*self.soup.mesh;
        match carrier {
            Carrier::Plane(t) => match self.soup.sheet(t) {
                Some(p) => match origin {
                    Origin::Edge(_, q) | Origin::TrianglesPlane(_, _, q) => p == q,
                    Origin::Triangle(_, q, r) => p == q || p == r,
                    Origin::Planes(q, r, s) => p == q || p == r || p == s,
                    _ => false,
                },
                None => {
                    let has = |e: EdgeId| mesh.triangle_edges[t.at()].contains(&e);
                    match origin {
                        Origin::Mesh(v) => mesh.triangles[t.at()].contains(&v),
                        Origin::EdgeTriangle(e, s) => s == t || has(e),
                        Origin::Edges(e, f) => has(e) || has(f),
                        Origin::Triangles(p, q, r) => t == p || t == q || t == r,
                        Origin::Edge(e, _) => has(e),
                        Origin::Triangle(s, ..) => s == t,
                        Origin::TrianglesPlane(p, q, _) => t == p || t == q,
                        Origin::Planes(..) | Origin::Level(_) => false,
                    }
                }
            },
            Carrier::Edge(e) => match origin {
                Origin::Mesh(v) => mesh.edges[e.at()].contains(&v),
                Origin::EdgeTriangle(f, _) | Origin::Edge(f, _) => e == f,
                Origin::Edges(f, g) => e == f || e == g,
                _ => false,
            },
        }
    }

    /// The side of a vertex of a carrier's line in this plane; which side is positive depends on the carrier alone.
    pub fn side(&self, carrier: Carrier, v: VertexId) -> Sign {
        let origin = self.origin(v);
        if self.named(origin, carrier) {
            count(Predicate::PointSide, Tier::Topology);
            return Sign::Zero;
        }
        match carrier {
            Carrier::Edge(e) => {
                let [a, b] = self.soup.mesh.edges[e.at()];
                self.turn(a, b, v)
            }
            Carrier::Plane(t) => match self.soup.sheet(t) {
                None => self.side_of_triangle(t, v),
                Some(p) => {
                    let plane = self.soup.planes()[p.at()];
                    if let Some(sign) = quick_side(&plane, &self.place(v)) {
                        count(Predicate::PointSide, Tier::Filter);
                        return sign;
                    }
                    exact::support_side(&Support::Plane(plane), &points::point(self.soup, self.points, v))
                }
            },
        }
    }

    fn side_of_triangle(&self, t: TriangleId, v: VertexId) -> Sign {
        let corners = self.soup.mesh.corners(t);
        let x = self.place(v);
        let minus = |p: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| p[i] - corners[0][i]) };
        let (e, f, d) = (minus(&corners[1]), minus(&corners[2]), minus(&x));
        let (mut sum, mut bound) = (0.0, TINY);
        for (i, d) in d.iter().enumerate() {
            let (j, k) = seen_along(i);
            let (l, r) = (e[j] * f[k], e[k] * f[j]);
            sum += (l - r) * d;
            bound += (l.abs() + r.abs()) * (4.0 * ROUNDOFF * self.most + 32.0 * ROUNDOFF * d.abs());
        }
        if sum.abs() > bound && bound < f64::MAX {
            count(Predicate::PointSide, Tier::Filter);
            return Sign::of(sum);
        }
        exact::support_side(&Support::Triangle(corners), &points::point(self.soup, self.points, v))
    }

    /// The turn a → b → c, seen along the axis.
    pub fn turn(&self, a: VertexId, b: VertexId, c: VertexId) -> Sign {
        if let Some(sign) = self.quick_turn(a, b, c) {
            count(Predicate::Projected, Tier::Filter);
            return sign;
        }
        if self.on_one_line([a, b, c]) {
            count(Predicate::Projected, Tier::Topology);
            return Sign::Zero;
        }
        let (u, v) = seen_along(self.axis);
        let point = |v: VertexId| points::point(self.soup, self.points, v);
        exact::turn_projected(&point(a), &point(b), &point(c), u, v)
    }

    fn quick_turn(&self, a: VertexId, b: VertexId, c: VertexId) -> Option<Sign> {
        let (u, v) = seen_along(self.axis);
        let [a, b, c] = [a, b, c].map(|x| self.place(x)).map(|x| [x[u], x[v]]);
        turn_of_rounded(a, b, c, self.most)
    }

    /// Three vertices on one edge, or on one plane that is not this one, as their names say.
    fn on_one_line(&self, vertices: [VertexId; 3]) -> bool {
        let origins = vertices.map(|v| self.origin(v));
        let Some(first) = origins.iter().find(|o| !matches!(o, Origin::Mesh(_))) else { return false };
        let all = |carrier: Carrier| origins.iter().all(|o| self.named(*o, carrier));
        // A triangle in this plane itself tells nothing: it may be any that is parallel.
        let other = |t: TriangleId| t != self.of && all(Carrier::Plane(t)) && !self.contains(t);
        let edge = |e: EdgeId| all(Carrier::Edge(e));
        let sheet = |p: PlaneId| other(self.soup.sheet_of(p));
        match *first {
            Origin::Edge(e, p) => edge(e) || sheet(p),
            Origin::Triangle(t, p, q) => sheet(p) || sheet(q) || other(t),
            Origin::Planes(p, q, r) => sheet(p) || sheet(q) || sheet(r),
            Origin::TrianglesPlane(t, u, p) => sheet(p) || other(t) || other(u),
            Origin::EdgeTriangle(e, t) => edge(e) || other(t),
            Origin::Edges(e, f) => edge(e) || edge(f),
            Origin::Triangles(p, q, r) => other(p) || other(q) || other(r),
            _ => false,
        }
    }

    /// Whether a triangle or sheet lies in this plane.
    fn contains(&self, t: TriangleId) -> bool {
        let soup = self.soup;
        let (corners, support) = match (soup.sheet(t), soup.sheet(self.of)) {
            // Sheets that coincide are named by one of them.
            (Some(p), Some(q)) => return p == q,
            (None, _) => (soup.mesh.corners(t), soup.support(self.of)),
            (Some(_), None) => (soup.mesh.corners(self.of), soup.support(t)),
        };
        match support {
            Support::Triangle([a, b, c]) => corners.iter().all(|x| exact::orient3d(&a, &b, &c, x).is_zero()),
            Support::Plane(p) => corners.iter().all(|x| exact::side(&p, x).is_zero()),
        }
    }
}

/// The turn a → b → c of points of which these are the coordinates, or that round to them and have none of larger magnitude than `most`, if
/// doubles tell. All may be multiplied by one power of two.
#[inline(always)]
pub fn turn_of_rounded(a: [f64; 2], b: [f64; 2], c: [f64; 2], most: f64) -> Option<Sign> {
    let (x1, y1, x2, y2) = (b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]);
    let (left, right) = (x1 * y2, x2 * y1);
    let det = left - right;
    let off = ROUNDOFF * most;
    let bound = 4.0 * off * (x1.abs() + y1.abs() + x2.abs() + y2.abs())
        + 16.0 * off * off
        + 4.0 * ROUNDOFF * (left.abs() + right.abs())
        + TINY;
    (det.abs() > bound && bound < f64::MAX).then(|| Sign::of(det))
}

/// The side of a plane of a point that rounds to x, if doubles tell. Each coordinate is off by half an ulp and each product and sum rounds once: within
/// 6u of the sum of magnitudes; eight are used. Half an ulp of a subnormal coordinate is more than u of it: that is in what is added for each of n.
#[inline(always)]
pub fn quick_side(p: &exact::Plane, x: &[f64; 3]) -> Option<Sign> {
    let terms = [p.n[0] * x[0], p.n[1] * x[1], p.n[2] * x[2], p.d];
    let sum = terms[0] + terms[1] + terms[2] + terms[3];
    let size = terms.iter().fold(0.0, |s, t| s + t.abs());
    let least = TINY * (1.0 + p.n[0].abs() + p.n[1].abs() + p.n[2].abs());
    (sum.abs() > 8.0 * ROUNDOFF * size + least && size < f64::MAX).then(|| Sign::of(sum))
}

//! Signs in the plane of a cluster: the side of a vertex of a segment's line, and the turn of three vertices, seen along an axis.
//!
//! Each asks what is known first (a point that is named by the line's carrier is on it), then doubles (rounded coordinates are within half an ulp
//! of the exact ones: a bound follows), then exactly.
//!
//! Error of a turn in doubles, with M no smaller than any |coordinate| and u = 2⁻⁵³: each coordinate is off by uM, each difference by 2uM and its
//! own rounding, so each product by 3uM times the other factor, and the determinant by less than 4uM·Σ|differences| + 16u²M² + 4u·Σ|products|.
//! The side of a triangle's plane: n·d with n = e × f exact but for rounding; d = x − b is off by 2uM in each coordinate: Σ mᵢ (2uM + 16u|dᵢ|)
//! where mᵢ bounds |nᵢ|; doubled.

use super::data::{Carrier, Points};
use super::points;
use crate::base::{EdgeId, TriangleId, VertexId};
use crate::complex::Origin;
use crate::exact::counters::{Predicate, Tier, count};
use crate::exact::{self, Sign, Support};
use crate::mesh::TriMesh;
use crate::mesh::projection::{ROUNDOFF, open_axis, seen_along};

/// A plane to work in: that of a triangle.
#[derive(Clone, Copy)]
pub struct Plane<'a> {
    pub mesh: &'a TriMesh,
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
    pub fn new(mesh: &'a TriMesh, points: &'a Points, of: TriangleId) -> Self {
        let (axis, orientation) = open_axis(&mesh.corners(of));
        let most = mesh.bbox.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        Self { mesh, points, of, axis, orientation, most }
    }

    #[inline(always)]
    pub fn place(&self, v: VertexId) -> [f64; 3] {
        points::place(self.mesh, self.points, v)
    }

    #[inline(always)]
    pub fn origin(&self, v: VertexId) -> Origin {
        points::origin(self.mesh, self.points, v)
    }

    /// Whether a vertex is on an edge, or in the plane of a triangle, as its name says. (It may be although its name does not.)
    fn named(&self, origin: Origin, carrier: Carrier) -> bool {
        let of_edge = |e: EdgeId, t: TriangleId| self.mesh.triangle_edges[t.at()].contains(&e);
        match (carrier, origin) {
            (Carrier::Plane(t), Origin::Mesh(v)) => self.mesh.triangles[t.at()].contains(&v),
            (Carrier::Plane(t), Origin::EdgeTriangle(e, s)) => s == t || of_edge(e, t),
            (Carrier::Plane(t), Origin::Edges(e, f)) => of_edge(e, t) || of_edge(f, t),
            (Carrier::Plane(t), Origin::Triangles(p, q, r)) => t == p || t == q || t == r,
            (Carrier::Edge(e), Origin::Mesh(v)) => self.mesh.edges[e.at()].contains(&v),
            (Carrier::Edge(e), Origin::EdgeTriangle(f, _)) => e == f,
            (Carrier::Edge(e), Origin::Edges(f, g)) => e == f || e == g,
            _ => false,
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
                let [a, b] = self.mesh.edges[e.at()];
                self.turn(a, b, v)
            }
            Carrier::Plane(t) => self.side_of_triangle(t, v),
        }
    }

    fn side_of_triangle(&self, t: TriangleId, v: VertexId) -> Sign {
        let corners = self.mesh.corners(t);
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
        exact::support_side(&Support::Triangle(corners), &points::point(self.mesh, self.points, v))
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
        let point = |v: VertexId| points::point(self.mesh, self.points, v);
        exact::turn_projected(&point(a), &point(b), &point(c), u, v)
    }

    fn quick_turn(&self, a: VertexId, b: VertexId, c: VertexId) -> Option<Sign> {
        let (u, v) = seen_along(self.axis);
        let [a, b, c] = [a, b, c].map(|x| self.place(x));
        let (x1, y1, x2, y2) = (b[u] - a[u], b[v] - a[v], c[u] - a[u], c[v] - a[v]);
        let (left, right) = (x1 * y2, x2 * y1);
        let det = left - right;
        let off = ROUNDOFF * self.most;
        let bound = 4.0 * off * (x1.abs() + y1.abs() + x2.abs() + y2.abs())
            + 16.0 * off * off
            + 4.0 * ROUNDOFF * (left.abs() + right.abs())
            + TINY;
        (det.abs() > bound && bound < f64::MAX).then(|| Sign::of(det))
    }

    /// Three vertices on one edge, or on one plane that is not this one, as their names say.
    fn on_one_line(&self, vertices: [VertexId; 3]) -> bool {
        let origins = vertices.map(|v| self.origin(v));
        let Some(first) = origins.iter().find(|o| !matches!(o, Origin::Mesh(_))) else { return false };
        let all = |carrier: Carrier| origins.iter().all(|o| self.named(*o, carrier));
        // A triangle in this plane itself tells nothing: it may be any that is parallel.
        let other = |t: TriangleId| t != self.of && all(Carrier::Plane(t)) && !self.contains(t);
        let edge = |e: EdgeId| all(Carrier::Edge(e));
        match *first {
            Origin::EdgeTriangle(e, t) => edge(e) || other(t),
            Origin::Edges(e, f) => edge(e) || edge(f),
            Origin::Triangles(p, q, r) => other(p) || other(q) || other(r),
            _ => false,
        }
    }

    /// Whether a triangle lies in this plane.
    fn contains(&self, t: TriangleId) -> bool {
        let [a, b, c] = self.mesh.corners(self.of);
        self.mesh.corners(t).iter().all(|x| exact::orient3d(&a, &b, &c, x).is_zero())
    }
}

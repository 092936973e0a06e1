//! The predicates: each names its formula once (an [`Expression`]) and, where it is hot, tries its static filter before. All
//! return the sign that exact rational arithmetic would give, for any finite input. Cost: 2 to 20 ns where a filter
//! decides, some 30 to 150 ns where the running bound does, 100 to 1000 ns for exact zeros (by degree).

use super::Sign;
use super::counters::{Predicate, Tier, count};
use super::points::{denominator, numerator, plain, shape, value_at};
use super::ring::{Expression, Kernel, Ring, cross, det3, difference, dot as dot_product, minor, plane_value};
use super::rows::{Row, determinant_of_rows};
use super::static_filters as filters;
use super::tiers::sign_of;
use super::types::{Direction, Gradient, Plane, Point, Support};
use std::cmp::Ordering;

#[doc(hidden)]
pub struct Side<'a>(pub &'a Plane, pub &'a [f64; 3]);

impl Expression<1> for Side<'_> {
    const PREDICATE: Predicate = Predicate::Side;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        let v = k.point(self.1);
        [plane_value(&k.plane(self.0), &v)]
    }
}

/// n.v + d
#[inline]
pub fn side(p: &Plane, v: &[f64; 3]) -> Sign {
    if let Some(s) = filters::side(p, v) {
        count(Predicate::Side, Tier::Filter);
        return s;
    }
    // x + d = 0 and its like: the sign of a rounded sum or difference of two doubles is the exact one, and zero products
    // add nothing. (Grids of planes at vertex coordinates end here.)
    if p.n.iter().all(|&n| n == 0.0 || n.abs() == 1.0) && p.n.iter().filter(|&&n| n != 0.0).count() == 1 {
        count(Predicate::Side, Tier::Filter);
        return Sign::of(p.n[0] * v[0] + p.n[1] * v[1] + p.n[2] * v[2] + p.d);
    }
    sign_of(&Side(p, v))
}

#[doc(hidden)]
pub struct EdgeOrder<'a>(pub &'a [f64; 3], pub &'a [f64; 3], pub &'a Plane, pub &'a Plane);

impl Expression<1> for EdgeOrder<'_> {
    const PREDICATE: Predicate = Predicate::EdgeOrder;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        let (a, b) = (k.point(self.0), k.point(self.1));
        let (p, q) = (k.plane(self.2), k.plane(self.3));
        [minor(&plane_value(&p, &a), &plane_value(&p, &b), &plane_value(&q, &a), &plane_value(&q, &b)).negated()]
    }
}

/// p and q both properly cross segment ab: compares where, from a to b.
///
/// The crossing is at t = p(a) / (p(a) - p(b)); the difference of two such is q(a) p(b) - p(a) q(b) over the product of
/// the two denominators, whose signs are those of p(a) and q(a).
pub fn compare_on_edge(a: &[f64; 3], b: &[f64; 3], p: &Plane, q: &Plane) -> Ordering {
    let m = [filters::value(p, a), filters::value(q, b), filters::value(p, b), filters::value(q, a)];
    let difference = match filters::minor(m) {
        Some(s) => {
            count(Predicate::EdgeOrder, Tier::Filter);
            -s
        }
        None => sign_of(&EdgeOrder(a, b, p, q)),
    };
    if difference.is_zero() {
        return Ordering::Equal;
    }
    (difference * side(p, a) * side(q, a)).to_ordering()
}

#[doc(hidden)]
pub struct TriangleOrder<'a>(pub &'a [[f64; 3]; 3], pub &'a Plane, pub &'a Plane, pub &'a Plane);

impl Expression<1> for TriangleOrder<'_> {
    const PREDICATE: Predicate = Predicate::TriangleOrder;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        let c = [k.point(&self.0[0]), k.point(&self.0[1]), k.point(&self.0[2])];
        let values = |p: &Plane| {
            let p = k.plane(p);
            [plane_value(&p, &c[0]), plane_value(&p, &c[1]), plane_value(&p, &c[2])]
        };
        [det3(&values(self.1), &values(self.2), &values(self.3))]
    }
}

/// Sign of the 3x3 determinant with rows p, q, r and columns their values n.x+d at the triangle's corners.
pub fn triangle_determinant(t: &[[f64; 3]; 3], p: &Plane, q: &Plane, r: &Plane) -> Sign {
    let values = |p: &Plane| [filters::value(p, &t[0]), filters::value(p, &t[1]), filters::value(p, &t[2])];
    match filters::triangle(&[values(p), values(q), values(r)]) {
        Some(s) => {
            count(Predicate::TriangleOrder, Tier::Filter);
            s
        }
        None => sign_of(&TriangleOrder(t, p, q, r)),
    }
}

#[doc(hidden)]
pub struct PointSide<'a>(pub &'a Support, pub &'a Point);

impl Expression<2> for PointSide<'_> {
    const PREDICATE: Predicate = Predicate::PointSide;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 2] {
        value_at(k, self.0, self.1)
    }
}

/// Which side of a support a symbolic point is on.
pub fn support_side(s: &Support, x: &Point) -> Sign {
    match (s, x) {
        (Support::Plane(p), Point::Vertex(v)) => return side(p, v),
        (Support::Triangle(t), Point::Vertex(v)) => return orient3d(&t[0], &t[1], &t[2], v),
        _ => {}
    }
    if lies_on(s, x) {
        count(Predicate::PointSide, Tier::Topology);
        return Sign::Zero;
    }
    sign_of(&PointSide(s, x))
}

/// The point is defined on this very support (it may lie on it otherwise too).
fn lies_on(s: &Support, x: &Point) -> bool {
    match (s, x) {
        (_, Point::Supports(all)) => all.contains(s),
        (Support::Plane(s), Point::EdgePlane { p, .. }) => s == p,
        (Support::Plane(s), Point::TrianglePlanes { p, q, .. }) => s == p || s == q,
        (Support::Plane(s), Point::Planes { p, q, r }) => s == p || s == q || s == r,
        (Support::Triangle(s), Point::EdgeTriangle { a, b, t }) => s == t || (s.contains(a) && s.contains(b)),
        (Support::Triangle(s), Point::TrianglePlanes { t, .. }) => s == t,
        (Support::Triangle(s), Point::EdgePlane { a, b, .. }) => s.contains(a) && s.contains(b),
        (Support::Triangle(s), Point::Edges { a, b, c, d, .. }) => {
            (s.contains(a) && s.contains(b)) || (s.contains(c) && s.contains(d))
        }
        _ => false,
    }
}

#[doc(hidden)]
pub struct CoordinateOrder<'a>(pub &'a Point, pub &'a Point, pub usize);

impl Expression<3> for CoordinateOrder<'_> {
    const PREDICATE: Predicate = Predicate::CoordinateOrder;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 3] {
        let (a, b) = (shape(k, self.0), shape(k, self.1));
        let (aw, bw) = (denominator(k, &a), denominator(k, &b));
        let d = minor(&numerator(&a, self.2), &aw, &numerator(&b, self.2), &bw);
        [d, aw, bw]
    }
}

/// Orders two symbolic points by coordinate `axis`.
pub fn compare_coordinate(a: &Point, b: &Point, axis: usize) -> Ordering {
    if let (Some((an, ad)), Some((bn, bd))) = (plain(a, axis), plain(b, axis)) {
        // Division is correctly rounded, hence monotonous: unequal quotients are in the right order.
        let (x, y) = (an / ad, bn / bd);
        if x != y {
            count(Predicate::CoordinateOrder, Tier::Filter);
            return if x < y { Ordering::Less } else { Ordering::Greater };
        }
        if ad.abs() == 1.0 && bd.abs() == 1.0 || (an == bn && ad == bd) {
            count(Predicate::CoordinateOrder, Tier::Filter);
            return Ordering::Equal;
        }
        return (determinant_of_rows(&[Row::Values(&[an, ad]), Row::Values(&[bn, bd])]) * Sign::of(ad) * Sign::of(bd))
            .to_ordering();
    }
    if a == b {
        count(Predicate::CoordinateOrder, Tier::Topology);
        return Ordering::Equal;
    }
    sign_of(&CoordinateOrder(a, b, axis)).to_ordering()
}

/// Orders two symbolic points by a coordinate whose correctly rounded values are at hand. Rounding to nearest is monotone: where
/// the doubles differ, the exact values differ the same way, so this filter needs no bound; equal doubles decide nothing.
#[inline]
pub fn compare_rounded(x: f64, y: f64, a: impl FnOnce() -> Point, b: impl FnOnce() -> Point, axis: usize) -> Ordering {
    if x != y {
        super::counters::count_filter(super::counters::Predicate::CoordinateOrder);
        return if x < y { Ordering::Less } else { Ordering::Greater };
    }
    compare_coordinate(&a(), &b(), axis)
}

/// A direction over a ring.
pub fn direction<K: Kernel>(k: &K, d: &Direction) -> [K::N; 3] {
    match d {
        Direction::Plane(n) => k.row(&Row::Values(n)),
        Direction::Triangle([a, b, c]) => {
            let a = k.point(a);
            cross(&difference(&k.point(b), &a), &difference(&k.point(c), &a))
        }
        Direction::Between(a, b) => difference(&k.point(b), &k.point(a)),
        Direction::Gradient(Gradient { corners, function }) => {
            // (f_b − f_a) v×w + (f_c − f_a) w×u + (f_d − f_a) u×v over det(u, v, w), with u, v, w from a to b, c, d.
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| k.point(&corners[i]));
            let (u, v, w) = (difference(&b, &a), difference(&c, &a), difference(&d, &a));
            let [f, rest @ ..] = k.row::<4>(&function.row());
            let rise = rest.map(|x| x.minus(&f));
            let (vw, wu, uv) = (cross(&v, &w), cross(&w, &u), cross(&u, &v));
            std::array::from_fn(|i| dot_product(&rise, &[vw[i].clone(), wu[i].clone(), uv[i].clone()]))
        }
    }
}

#[doc(hidden)]
pub struct Determinant<'a>(pub &'a Direction, pub &'a Direction, pub &'a Direction);

impl Expression<1> for Determinant<'_> {
    const PREDICATE: Predicate = Predicate::Direction;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        [det3(&direction(k, self.0), &direction(k, self.1), &direction(k, self.2))]
    }
}

/// Sign of det(u, v, w).
pub fn determinant(u: &Direction, v: &Direction, w: &Direction) -> Sign {
    if let (Direction::Plane(u), Direction::Plane(v), Direction::Plane(w)) = (u, v, w)
        && let Some(s) = filters::normals(u, v, w)
    {
        count(Predicate::Direction, Tier::Filter);
        return s;
    }
    sign_of(&Determinant(u, v, w))
}

#[doc(hidden)]
pub struct CrossDotCross<'a>(pub [&'a Direction; 4]);

impl Expression<1> for CrossDotCross<'_> {
    const PREDICATE: Predicate = Predicate::Direction;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        let d = |i: usize| direction(k, self.0[i]);
        let (a, b, c, d) = (d(0), d(1), d(2), d(3));
        [minor(&dot_product(&a, &c), &dot_product(&a, &d), &dot_product(&b, &c), &dot_product(&b, &d))]
    }
}

/// Sign of (a x b) . (c x d), which is (a.c)(b.d) - (a.d)(b.c).
pub fn cross_dot_cross(a: &Direction, b: &Direction, c: &Direction, d: &Direction) -> Sign {
    sign_of(&CrossDotCross([a, b, c, d]))
}

#[doc(hidden)]
pub struct Dot<'a>(pub &'a Direction, pub &'a Direction);

impl Expression<1> for Dot<'_> {
    const PREDICATE: Predicate = Predicate::Direction;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        [dot_product(&direction(k, self.0), &direction(k, self.1))]
    }
}

/// Sign of u . v
pub fn dot(u: &Direction, v: &Direction) -> Sign {
    sign_of(&Dot(u, v))
}

#[doc(hidden)]
pub struct Orient3d<'a>(pub [&'a [f64; 3]; 4]);

impl Expression<1> for Orient3d<'_> {
    const PREDICATE: Predicate = Predicate::Orient3d;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        let [a, b, c, d] = self.0;
        let a = k.point(a);
        [det3(&difference(&k.point(b), &a), &difference(&k.point(c), &a), &difference(&k.point(d), &a))]
    }
}

/// Side of d relative to the plane through a, b, c: sign of det(b-a, c-a, d-a).
pub fn orient3d(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3], d: &[f64; 3]) -> Sign {
    match filters::orient3d(a, b, c, d) {
        Some(s) => {
            count(Predicate::Orient3d, Tier::Filter);
            s
        }
        None => sign_of(&Orient3d([a, b, c, d])),
    }
}

/// One component of (b-a) x (c-a): the projections onto the plane of axes `i`, `j`.
#[doc(hidden)]
pub struct Turn2d<'a>(pub [&'a [f64; 3]; 3], pub usize, pub usize);

impl Expression<1> for Turn2d<'_> {
    const PREDICATE: Predicate = Predicate::Orient3d;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        let d = |v: &[f64; 3], i: usize| k.coordinate(v[i]).minus(&k.coordinate(self.0[0][i]));
        let ([_, b, c], i, j) = (self.0, self.1, self.2);
        [minor(&d(b, i), &d(b, j), &d(c, i), &d(c, j))]
    }
}

/// The three points lie on one line (or coincide).
pub fn collinear(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3]) -> bool {
    // One component of the normal that is not zero is enough.
    [(1, 2), (2, 0), (0, 1)].into_iter().all(|(i, j)| sign_of(&Turn2d([a, b, c], i, j)).is_zero())
}

#[doc(hidden)]
pub struct TurnProjected<'a>(pub [&'a Point; 3], pub usize, pub usize);

impl Expression<4> for TurnProjected<'_> {
    const PREDICATE: Predicate = Predicate::Projected;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 4] {
        let row = |x: &Point| {
            let s = shape(k, x);
            [numerator(&s, self.1), numerator(&s, self.2), denominator(k, &s)]
        };
        let m = [row(self.0[0]), row(self.0[1]), row(self.0[2])];
        let det = det3(&m[0], &m[1], &m[2]);
        let [a, b, c] = m.map(|[_, _, w]| w);
        [det, a, b, c]
    }
}

/// All three points' (u, v) = coordinates (ax, ay): sign of the turn a -> b -> c in that projection, symbolic points.
pub fn turn_projected(a: &Point, b: &Point, c: &Point, ax: usize, ay: usize) -> Sign {
    if let (Point::Vertex(a), Point::Vertex(b), Point::Vertex(c)) = (a, b, c) {
        return sign_of(&Turn2d([a, b, c], ax, ay));
    }
    sign_of(&TurnProjected([a, b, c], ax, ay))
}

#[doc(hidden)]
pub struct Projected<'a> {
    pub apex: &'a [f64; 3],
    pub b: &'a [f64; 3],
    pub c: &'a [f64; 3],
    pub n: &'a [f64; 3],
    pub axis: usize,
}

impl Expression<2> for Projected<'_> {
    const PREDICATE: Predicate = Predicate::Projected;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 2] {
        let a = k.point(self.apex);
        let (w, u) = (difference(&k.point(self.b), &a), difference(&k.point(self.c), &a));
        let n = k.row(&Row::Values(self.n));
        let (nw, nu) = (dot_product(&n, &w), dot_product(&n, &u));
        [minor(&w[self.axis], &nw, &u[self.axis], &nu), nw]
    }
}

/// Central projection from `apex`: w = b - apex and u = c - apex with n.w and n.u both of the same sign s, not zero, meet
/// the plane n.y = s (through apex + y) at w / |n.w| and u / |n.u|. Compares these two points' coordinate `axis`.
pub fn compare_projected(apex: &[f64; 3], b: &[f64; 3], c: &[f64; 3], n: &[f64; 3], axis: usize) -> Ordering {
    sign_of(&Projected { apex, b, c, n, axis }).to_ordering()
}

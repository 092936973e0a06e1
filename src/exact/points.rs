//! Symbolic points as formulas: homogeneous coordinates, and the value of a support's linear function at a point, over any
//! ring. A point on an edge or in a triangle is a sum of corners weighted by plane values (the barycentric form), which
//! has a lower degree than the meet of three planes and loses less to cancellation; other points follow from Cramer's rule.
//!
//! Invariant: weights, coordinates and the denominator W share one positive scale, and W may have either sign. W = 0 only
//! where the caller's carriers do not meet in one point.

use super::interpolate;
use super::ring::{Kernel, Ring, cross, difference, dot, minor, plane_value};
use super::types::{Plane, Point, Support};

/// A support's linear function: n.x + d, or n.(x - a) for a triangle with corner a (no product of n and a is formed
/// before it is needed).
pub enum Form<N> {
    Plane([N; 4]),
    Triangle([N; 3], [N; 3]),
}

pub fn form<K: Kernel>(k: &K, s: &Support) -> Form<K::N> {
    match s {
        Support::Plane(p) => Form::Plane(k.plane(p)),
        Support::Triangle(t) => triangle_form(k, t),
    }
}

pub fn triangle_form<K: Kernel>(k: &K, t: &[[f64; 3]; 3]) -> Form<K::N> {
    let a = k.point(&t[0]);
    let n = cross(&difference(&k.point(&t[1]), &a), &difference(&k.point(&t[2]), &a));
    Form::Triangle(n, a)
}

/// The function's value at a point with coordinates (not homogeneous).
#[inline]
pub fn value<N: Ring>(f: &Form<N>, v: &[N; 3]) -> N {
    match f {
        Form::Plane(p) => plane_value(p, v),
        Form::Triangle(n, a) => dot(n, &difference(v, a)),
    }
}

/// The coefficients n, d.
pub fn coefficients<N: Ring>(f: Form<N>) -> [N; 4] {
    match f {
        Form::Plane(p) => p,
        Form::Triangle(n, a) => {
            let d = dot(&n, &a).negated();
            let [x, y, z] = n;
            [x, y, z, d]
        }
    }
}

/// What a point is made of.
pub enum Shape<N> {
    /// A corner itself.
    One([N; 3]),
    /// w[0] c[0] + w[1] c[1] over w[0] + w[1].
    Two([N; 2], [[N; 3]; 2]),
    /// The same with three.
    Three([N; 3], [[N; 3]; 3]),
    Four([N; 4], [[N; 3]; 4]),
    /// Homogeneous coordinates X, Y, Z, W.
    Meet([N; 3], N),
}

/// A point that can be evaluated in any ring.
pub trait Symbolic {
    fn shape<K: Kernel>(&self, k: &K) -> Shape<K::N>;
    /// A coordinate that is known as a quotient of two input numbers without any geometry.
    fn plain(&self, axis: usize) -> Option<(f64, f64)>;
    /// The correctly rounded coordinates that are wanted and that a cheap evaluation settles.
    fn quick(&self, open: &[bool; 3]) -> [Option<f64>; 3];
}

impl Symbolic for Point {
    #[inline]
    fn shape<K: Kernel>(&self, k: &K) -> Shape<K::N> {
        shape(k, self)
    }
    #[inline]
    fn plain(&self, axis: usize) -> Option<(f64, f64)> {
        plain(self, axis)
    }
    #[inline]
    fn quick(&self, open: &[bool; 3]) -> [Option<f64>; 3] {
        match self {
            Point::EdgePlane { a, b, p } => interpolate::on_edge(a, b, p, open),
            Point::TrianglePlanes { t, p, q } => interpolate::in_triangle(t, p, q, open),
            Point::Zero(zero) => zero.quick(open),
            _ => [None; 3],
        }
    }
}

pub fn shape<K: Kernel>(k: &K, x: &Point) -> Shape<K::N> {
    let on_edge = |a: &[f64; 3], b: &[f64; 3], f: Form<K::N>| {
        let c = [k.point(a), k.point(b)];
        // The function falls from f(a) to f(b): the weight of a is -f(b), that of b is f(a).
        let w = [value(&f, &c[1]).negated(), value(&f, &c[0])];
        Shape::Two(w, c)
    };
    match x {
        Point::Vertex(v) => Shape::One(k.point(v)),
        Point::EdgePlane { a, b, p } => on_edge(a, b, Form::Plane(k.plane(p))),
        Point::EdgeTriangle { a, b, t } => on_edge(a, b, triangle_form(k, t)),
        Point::Edges { a, b, c, d, axis } => {
            let ends = [k.point(a), k.point(b)];
            let (c, d) = (k.point(c), k.point(d));
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let along = difference(&d, &c);
            // The turn of an end about c seen from d: falls along ab as a plane's value does.
            let turn = |x: &[K::N; 3]| {
                let to = difference(x, &c);
                minor(&along[u], &along[v], &to[u], &to[v])
            };
            let w = [turn(&ends[1]).negated(), turn(&ends[0])];
            Shape::Two(w, ends)
        }
        Point::TrianglePlanes { t, p, q } => {
            let c = [k.point(&t[0]), k.point(&t[1]), k.point(&t[2])];
            let (p, q) = (k.plane(p), k.plane(q));
            let w = cross(
                &[plane_value(&p, &c[0]), plane_value(&p, &c[1]), plane_value(&p, &c[2])],
                &[plane_value(&q, &c[0]), plane_value(&q, &c[1]), plane_value(&q, &c[2])],
            );
            Shape::Three(w, c)
        }
        Point::Planes { p, q, r } => meet(k.plane(p), k.plane(q), k.plane(r)),
        Point::Supports([p, q, r]) => {
            meet(coefficients(form(k, p)), coefficients(form(k, q)), coefficients(form(k, r)))
        }
        Point::Zero(zero) => zero.shape(k),
    }
}

/// Three planes: n_i.x = -d_i gives x = -(d_1 n_2 x n_3 + d_2 n_3 x n_1 + d_3 n_1 x n_2) / det(n_1, n_2, n_3).
/// W is negated instead of the three coordinates.
fn meet<N: Ring>([p0, p1, p2, d]: [N; 4], [q0, q1, q2, e]: [N; 4], [r0, r1, r2, f]: [N; 4]) -> Shape<N> {
    let (p, q, r) = ([p0, p1, p2], [q0, q1, q2], [r0, r1, r2]);
    let (qr, rp, pq) = (cross(&q, &r), cross(&r, &p), cross(&p, &q));
    let w = dot(&p, &qr).negated();
    let x = |i: usize| d.times(&qr[i]).plus(&e.times(&rp[i])).plus(&f.times(&pq[i]));
    Shape::Meet([x(0), x(1), x(2)], w)
}

/// The denominator of a point.
#[inline]
pub fn denominator<K: Kernel>(k: &K, s: &Shape<K::N>) -> K::N {
    match s {
        Shape::One(_) => k.one(),
        Shape::Two(w, _) => w[0].plus(&w[1]),
        Shape::Three(w, _) => w[0].plus(&w[1]).plus(&w[2]),
        Shape::Four(w, _) => w[0].plus(&w[1]).plus(&w[2]).plus(&w[3]),
        Shape::Meet(_, w) => w.clone(),
    }
}

/// A coordinate times the denominator.
#[inline]
pub fn numerator<N: Ring>(s: &Shape<N>, axis: usize) -> N {
    match s {
        Shape::One(c) => c[axis].clone(),
        Shape::Two(w, c) => w[0].times(&c[0][axis]).plus(&w[1].times(&c[1][axis])),
        Shape::Three(w, c) => w[0].times(&c[0][axis]).plus(&w[1].times(&c[1][axis])).plus(&w[2].times(&c[2][axis])),
        Shape::Four(w, c) => w[0]
            .times(&c[0][axis])
            .plus(&w[1].times(&c[1][axis]))
            .plus(&w[2].times(&c[2][axis]))
            .plus(&w[3].times(&c[3][axis])),
        Shape::Meet(x, _) => x[axis].clone(),
    }
}

/// X, Y, Z, W.
pub fn homogeneous<K: Kernel>(k: &K, x: &impl Symbolic) -> [K::N; 4] {
    let s = x.shape(k);
    [numerator(&s, 0), numerator(&s, 1), numerator(&s, 2), denominator(k, &s)]
}

/// The support's function at a point, times the point's denominator; and that denominator.
pub fn value_at<K: Kernel>(k: &K, s: &Support, x: &Point) -> [K::N; 2] {
    let f = form(k, s);
    let x = shape(k, x);
    let w = denominator(k, &x);
    let v = match &x {
        Shape::One(c) => value(&f, c),
        Shape::Two(w, c) => w[0].times(&value(&f, &c[0])).plus(&w[1].times(&value(&f, &c[1]))),
        Shape::Three(w, c) => dot(w, &[value(&f, &c[0]), value(&f, &c[1]), value(&f, &c[2])]),
        Shape::Four(w, c) => {
            let v = |i: usize| w[i].times(&value(&f, &c[i]));
            v(0).plus(&v(1)).plus(&v(2)).plus(&v(3))
        }
        Shape::Meet(x, w) => match &f {
            Form::Plane([a, b, c, d]) => a.times(&x[0]).plus(&b.times(&x[1])).plus(&c.times(&x[2])).plus(&d.times(w)),
            Form::Triangle(n, a) => dot(n, &std::array::from_fn(|i| x[i].minus(&a[i].times(w)))),
        },
    };
    [v, w]
}

/// A coordinate that is known as a quotient of two input numbers without any geometry: of a vertex, of a point on an edge or
/// triangle that is perpendicular to the axis, or on a plane that is.
pub fn plain(x: &Point, axis: usize) -> Option<(f64, f64)> {
    let on_plane = |p: &Plane| {
        let flat = p.n[axis] != 0.0 && p.n[(axis + 1) % 3] == 0.0 && p.n[(axis + 2) % 3] == 0.0;
        flat.then(|| (-p.d, p.n[axis]))
    };
    let on_edge = |a: &[f64; 3], b: &[f64; 3]| (a[axis] == b[axis]).then(|| (a[axis], 1.0));
    let on_triangle =
        |t: &[[f64; 3]; 3]| (t[0][axis] == t[1][axis] && t[0][axis] == t[2][axis]).then(|| (t[0][axis], 1.0));
    let on_support = |s: &Support| match s {
        Support::Plane(p) => on_plane(p),
        Support::Triangle(t) => on_triangle(t),
    };
    match x {
        Point::Vertex(v) => Some((v[axis], 1.0)),
        Point::EdgePlane { a, b, p } => on_edge(a, b).or_else(|| on_plane(p)),
        Point::EdgeTriangle { a, b, t } => on_edge(a, b).or_else(|| on_triangle(t)),
        Point::Edges { a, b, c, d, .. } => on_edge(a, b).or_else(|| on_edge(c, d)),
        Point::TrianglePlanes { t, p, q } => on_triangle(t).or_else(|| on_plane(p)).or_else(|| on_plane(q)),
        Point::Planes { p, q, r } => on_plane(p).or_else(|| on_plane(q)).or_else(|| on_plane(r)),
        Point::Zero(zero) => zero.plain(axis),
        Point::Supports(s) => on_support(&s[0]).or_else(|| on_support(&s[1])).or_else(|| on_support(&s[2])),
    }
}

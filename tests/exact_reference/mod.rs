//! What the kernel is compared with: points and signs from their definitions, in rationals, by ways that the
//! kernel does not take (parameters along edges, Gauss elimination, explicit cross products). And the inputs to
//! compare on.
#![allow(dead_code)]

#[path = "../common/random.rs"]
pub mod random;

use lapidary::exact::{Direction, Gradient, Linear, Plane, Point, Sign, Support, Zero};
pub use random::Random;
use rug::Rational;
use std::cmp::Ordering;

pub type Q = Rational;
pub type Q3 = [Rational; 3];

/// Kinds of input numbers.
pub const KINDS: [&str; 10] = [
    "uniform",
    "small integers",
    "integers moved by ulps",
    "subnormal",
    "around 1e-170",
    "around 1e+150",
    "any exponent",
    "exponents within 2^40",
    "quarters",
    "long and short",
];

pub fn number(r: &mut Random, kind: usize) -> f64 {
    let small = |r: &mut Random| r.below(7) as f64 - 3.0;
    match kind {
        0 => r.signed(),
        1 => small(r),
        2 => {
            let mut x = small(r);
            for _ in 0..r.below(3) {
                x = if r.below(2) == 0 { x.next_up() } else { x.next_down() };
            }
            // Zero has subnormal neighbours; they are the business of other kinds.
            if x.abs() < 1e-300 { 0.0 } else { x }
        }
        3 => {
            let x = f64::from_bits(if r.below(2) == 0 { r.below(5) } else { r.below(1 << 52) });
            if r.below(2) == 0 { x } else { -x }
        }
        4 => small(r) * 1e-170,
        5 => r.signed() * 1e150,
        6 => r.signed() * 2f64.powi(r.below(1900) as i32 - 950),
        7 => r.signed() * 2f64.powi(r.below(80) as i32 - 40),
        8 => (r.below(17) as f64 - 8.0) / 4.0,
        _ => {
            if r.below(2) == 0 {
                small(r)
            } else {
                r.signed()
            }
        }
    }
}

pub fn vector(r: &mut Random, kind: usize) -> [f64; 3] {
    [number(r, kind), number(r, kind), number(r, kind)]
}

/// A normal that is not zero.
pub fn normal(r: &mut Random, kind: usize) -> [f64; 3] {
    loop {
        let mut n = vector(r, kind);
        if r.below(4) == 0 {
            // Axis-parallel.
            let keep = r.below(3) as usize;
            n[(keep + 1) % 3] = 0.0;
            n[(keep + 2) % 3] = 0.0;
        }
        if n != [0.0; 3] {
            return n;
        }
    }
}

/// A plane; every other one goes (nearly, or exactly where products are exact) through a given point.
pub fn plane(r: &mut Random, kind: usize, through: &[f64; 3]) -> Plane {
    // Products of coordinates and normals must stay finite for the planes through points, not for the predicates.
    let n = normal(r, kind);
    let d =
        if r.below(2) == 0 { -(n[0] * through[0] + n[1] * through[1] + n[2] * through[2]) } else { number(r, kind) };
    Plane { n, d: if d.is_finite() { d } else { number(r, kind) } }
}

pub fn triangle(r: &mut Random, kind: usize) -> [[f64; 3]; 3] {
    [vector(r, kind), vector(r, kind), vector(r, kind)]
}

pub fn q(x: f64) -> Q {
    Q::from_f64(x).expect("finite")
}

pub fn q3(v: &[f64; 3]) -> Q3 {
    [q(v[0]), q(v[1]), q(v[2])]
}

pub fn sign(x: &Q) -> Sign {
    match x.cmp0() {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

pub fn sub(a: &Q3, b: &Q3) -> Q3 {
    std::array::from_fn(|i| Q::from(&a[i] - &b[i]))
}

pub fn dot(a: &Q3, b: &Q3) -> Q {
    let mut s = Q::new();
    for i in 0..3 {
        s += Q::from(&a[i] * &b[i]);
    }
    s
}

pub fn cross(a: &Q3, b: &Q3) -> Q3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        Q::from(&a[j] * &b[k]) - Q::from(&a[k] * &b[j])
    })
}

/// n.v + d
pub fn plane_value(p: &Plane, v: &Q3) -> Q {
    dot(&q3(&p.n), v) + q(p.d)
}

/// The determinant by its definition: a sum over permutations.
pub fn leibniz<const M: usize>(m: &[[Q; M]; M]) -> Q {
    fn go<const M: usize>(m: &[[Q; M]; M], row: usize, used: &mut [bool; M], odd: bool, product: Q, sum: &mut Q) {
        if row == M {
            if odd {
                *sum -= product;
            } else {
                *sum += product;
            }
            return;
        }
        for c in 0..M {
            if !used[c] {
                // Inversions: columns above c that were used before.
                let swaps = used[c..].iter().filter(|&&u| u).count();
                used[c] = true;
                go(m, row + 1, used, odd ^ (swaps % 2 == 1), Q::from(&product * &m[row][c]), sum);
                used[c] = false;
            }
        }
    }
    let mut sum = Q::new();
    go(m, 0, &mut [false; M], false, Q::from(1), &mut sum);
    sum
}

/// n and right side h of n.x = h.
fn equation(s: &Support) -> (Q3, Q) {
    match s {
        Support::Plane(p) => (q3(&p.n), -q(p.d)),
        Support::Triangle(t) => {
            let n = triangle_normal(t);
            let h = dot(&n, &q3(&t[1]));
            (n, h)
        }
    }
}

pub fn triangle_normal(t: &[[f64; 3]; 3]) -> Q3 {
    cross(&sub(&q3(&t[1]), &q3(&t[0])), &sub(&q3(&t[2]), &q3(&t[0])))
}

/// Gauss elimination; `None` if singular.
fn solve(rows: [(Q3, Q); 3]) -> Option<Q3> {
    let mut m = rows.map(|([a, b, c], h)| [a, b, c, h]);
    for c in 0..3 {
        let pivot = (c..3).find(|&r| m[r][c] != 0)?;
        m.swap(c, pivot);
        let lead = m[c][c].clone();
        for x in &mut m[c] {
            *x /= &lead;
        }
        for r in 0..3 {
            if r != c && m[r][c] != 0 {
                let (f, lead) = (m[r][c].clone(), m[c].clone());
                for (x, y) in m[r].iter_mut().zip(&lead) {
                    *x -= Q::from(&f * y);
                }
            }
        }
    }
    Some(m.map(|[_, _, _, h]| h))
}

fn on_edge(a: &[f64; 3], b: &[f64; 3], (n, h): (Q3, Q)) -> Option<Q3> {
    let (a, b) = (q3(a), q3(b));
    let along = sub(&b, &a);
    let speed = dot(&n, &along);
    if speed == 0 {
        return None;
    }
    let t = (h - dot(&n, &a)) / speed;
    Some(std::array::from_fn(|i| Q::from(&along[i] * &t) + &a[i]))
}

/// The exact coordinates; `None` where the carriers do not meet in one point.
pub fn point(x: &Point) -> Option<Q3> {
    match x {
        Point::Vertex(v) => Some(q3(v)),
        Point::EdgePlane { a, b, p } => on_edge(a, b, equation(&Support::Plane(*p))),
        Point::EdgeTriangle { a, b, t } => on_edge(a, b, equation(&Support::Triangle(*t))),
        Point::Edges { a, b, c, d, axis } => {
            // The plane through cd along the axis.
            let mut up: Q3 = std::array::from_fn(|_| Q::new());
            up[*axis] += 1;
            let n = cross(&sub(&q3(d), &q3(c)), &up);
            let h = dot(&n, &q3(c));
            on_edge(a, b, (n, h))
        }
        Point::TrianglePlanes { t, p, q } => {
            solve([equation(&Support::Triangle(*t)), equation(&Support::Plane(*p)), equation(&Support::Plane(*q))])
        }
        Point::Planes { p, q, r } => solve([p, q, r].map(|p| equation(&Support::Plane(*p)))),
        Point::Supports(s) => solve([equation(&s[0]), equation(&s[1]), equation(&s[2])]),
        Point::Zero(zero) => zero_place(zero),
    }
}

/// The values of a linear function at corners.
fn linear(f: &Linear) -> [Q; 4] {
    std::array::from_fn(|i| q(f.first[i]) - q(f.second[i]))
}

/// Weights are the minors of the rows without a column, with alternating signs; `None` unless the point is inside.
fn zero_place(zero: &Zero) -> Option<Q3> {
    let rows: Vec<[Q; 4]> = zero.functions.iter().map(linear).collect();
    let n = zero.dim as usize;
    let minor = |column: usize| {
        let m: Vec<Vec<&Q>> =
            rows[..n].iter().map(|r| (0..=n).filter(|&k| k != column).map(|k| &r[k]).collect()).collect();
        let at = |i: usize, j: usize| m[i][j].clone();
        let w = match n {
            0 => Q::from(1),
            1 => at(0, 0),
            2 => leibniz::<2>(&std::array::from_fn(|i| std::array::from_fn(|j| at(i, j)))),
            _ => leibniz::<3>(&std::array::from_fn(|i| std::array::from_fn(|j| at(i, j)))),
        };
        if column.is_multiple_of(2) { w } else { -w }
    };
    let weights: Vec<Q> = (0..=n).map(minor).collect();
    if weights.iter().any(|w| *w == 0 || (*w > 0) != (weights[0] > 0)) {
        return None;
    }
    let sum = weights.iter().fold(Q::new(), |s, w| s + w);
    let weighted = |i: usize| weights.iter().zip(&zero.corners).fold(Q::new(), |s, (w, c)| s + q(c[i]) * w);
    Some(std::array::from_fn(|i| weighted(i) / &sum))
}

fn random_linear(r: &mut Random, kind: usize) -> Linear {
    let mut row = || std::array::from_fn(|_| number(r, kind));
    let first = row();
    let second = row();
    Linear { first, second: if first[0].to_bits() & 1 == 0 { [0.0; 4] } else { second } }
}

pub fn zero(r: &mut Random, kind: usize) -> Point {
    let dim = r.below(4) as u32;
    let corners = std::array::from_fn(|_| vector(r, kind));
    Point::Zero(Zero { dim, corners, functions: std::array::from_fn(|_| random_linear(r, kind)) })
}

/// A gradient on a tetrahedron of positive orientation.
pub fn gradient(r: &mut Random, kind: usize) -> Gradient {
    loop {
        let corners: [[f64; 3]; 4] = std::array::from_fn(|_| vector(r, kind));
        let [a, b, c, d] = corners.each_ref().map(q3);
        if dot(&cross(&sub(&b, &a), &sub(&c, &a)), &sub(&d, &a)) > 0 {
            return Gradient { corners, function: random_linear(r, kind) };
        }
    }
}

pub fn support_value(s: &Support, x: &Q3) -> Q {
    let (n, h) = equation(s);
    dot(&n, x) - h
}

pub fn direction(d: &Direction) -> Q3 {
    match d {
        Direction::Plane(n) => q3(n),
        Direction::Triangle(t) => triangle_normal(t),
        Direction::Between(a, b) => sub(&q3(b), &q3(a)),
        Direction::Gradient(Gradient { corners, function }) => {
            let f = linear(function);
            let row = |k: usize| (sub(&q3(&corners[k]), &q3(&corners[0])), Q::from(&f[k] - &f[0]));
            solve([row(1), row(2), row(3)]).expect("a tetrahedron")
        }
    }
}

pub fn support(r: &mut Random, kind: usize, near: &[f64; 3]) -> Support {
    if r.below(2) == 0 {
        Support::Plane(plane(r, kind, near))
    } else {
        let mut t = triangle(r, kind);
        if r.below(2) == 0 {
            t[0] = *near;
        }
        Support::Triangle(t)
    }
}

/// Two edges in a plane that is perpendicular to an axis, or at 45 degrees to two.
fn edges(r: &mut Random, kind: usize) -> Point {
    let axis = r.below(3) as usize;
    let height = if r.below(2) == 0 { Some(number(r, kind)) } else { None };
    let [a, b, c, d] = std::array::from_fn(|_| {
        let mut x = vector(r, kind);
        x[axis] = height.unwrap_or(x[(axis + 1) % 3]);
        x
    });
    Point::Edges { a, b, c, d, axis }
}

/// A symbolic point of any sort, with its exact coordinates.
pub fn symbolic(r: &mut Random, kind: usize, near: &[f64; 3]) -> (Point, Q3) {
    loop {
        let x = match r.below(8) {
            7 => zero(r, kind),
            0 => Point::Vertex(vector(r, kind)),
            1 => Point::EdgePlane { a: vector(r, kind), b: vector(r, kind), p: plane(r, kind, near) },
            2 => {
                let mut t = triangle(r, kind);
                if r.below(2) == 0 {
                    t[1] = *near;
                }
                Point::EdgeTriangle { a: vector(r, kind), b: vector(r, kind), t }
            }
            3 => Point::TrianglePlanes { t: triangle(r, kind), p: plane(r, kind, near), q: plane(r, kind, near) },
            4 => edges(r, kind),
            5 => Point::Planes { p: plane(r, kind, near), q: plane(r, kind, near), r: plane(r, kind, near) },
            _ => Point::Supports([support(r, kind, near), support(r, kind, near), support(r, kind, near)]),
        };
        if let Some(exact) = point(&x) {
            return (x, exact);
        }
    }
}

/// The double nearest to a rational, ties to even, by trying neighbours.
pub fn nearest(x: &Q) -> f64 {
    if *x == 0 {
        return 0.0;
    }
    // Half an ulp above the largest double everything is infinite.
    let limit: Q = Q::from(Q::from(1) << 1024) - Q::from(Q::from(1) << 970);
    if *x >= limit {
        return f64::INFINITY;
    }
    if *x <= Q::from(-&limit) {
        return f64::NEG_INFINITY;
    }
    let start = x.to_f64();
    let mut best = if start.is_finite() { start } else { f64::MAX.copysign(start) };
    loop {
        let mut moved = false;
        for other in [best.next_down(), best.next_up()] {
            if !other.is_finite() {
                continue;
            }
            let (d0, d1) = (Q::from(x - q(best)).abs(), Q::from(x - q(other)).abs());
            if d1 < d0 || (d1 == d0 && best.to_bits() & 1 == 1) {
                best = other;
                moved = true;
            }
        }
        if !moved {
            return best + 0.0;
        }
    }
}

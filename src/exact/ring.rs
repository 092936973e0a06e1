//! One formula, many number types. A predicate is an [`Expression`]: a polynomial in the input, written once over a
//! [`Ring`]; a [`Kernel`] says how input doubles enter that ring. The tiers of [`super::tiers`] evaluate the same
//! expression over values with error bounds, over integers on the stack, and over integers of any size.
//!
//! Invariant on which the integer tiers rest: every expression is homogeneous. It may only be scaled by a positive
//! factor when all coordinates are scaled by one power of two, each plane by its own, and each row of function
//! values by its own. (Then a kernel is free to choose those powers so that everything is an integer.)

use super::counters::Predicate;
use super::rows::Row;
use super::types::Plane;

/// Addition, subtraction, multiplication; by reference, since the wide types are large. The three
/// compositions are here so that a type can take them in one step.
pub trait Ring: Clone {
    fn plus(&self, o: &Self) -> Self;
    fn minus(&self, o: &Self) -> Self;
    fn times(&self, o: &Self) -> Self;
    fn negated(&self) -> Self;

    /// `a d - b c`
    #[inline]
    fn minor(a: &Self, b: &Self, c: &Self, d: &Self) -> Self {
        a.times(d).minus(&b.times(c))
    }
    #[inline]
    fn dot(a: &[Self; 3], b: &[Self; 3]) -> Self {
        a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
    }
    /// n.v + d for a plane's row n, d.
    #[inline]
    fn plane_value(p: &[Self; 4], v: &[Self; 3]) -> Self {
        p[0].times(&v[0]).plus(&p[1].times(&v[1])).plus(&p[2].times(&v[2])).plus(&p[3])
    }
}

/// How input doubles become ring elements.
pub trait Kernel {
    type N: Ring;
    /// A coordinate (of length 1 under scaling).
    fn coordinate(&self, x: f64) -> Self::N;
    /// The coefficients n, d of a plane, scaled so that n.x + d holds for coordinates as [`Kernel::coordinate`] gives them.
    fn plane(&self, p: &Plane) -> [Self::N; 4];
    /// A row of function values (or a normal), scaled by a power of two of its own.
    fn row<const M: usize>(&self, r: &Row<'_, M>) -> [Self::N; M];
    fn one(&self) -> Self::N;

    /// Several rows; here so that wide numbers can be built in place.
    #[inline]
    fn matrix<const M: usize>(&self, rows: &[Row<'_, M>; M]) -> [[Self::N; M]; M] {
        std::array::from_fn(|i| self.row(&rows[i]))
    }

    fn point(&self, v: &[f64; 3]) -> [Self::N; 3] {
        [self.coordinate(v[0]), self.coordinate(v[1]), self.coordinate(v[2])]
    }
}

/// Polynomials whose signs are wanted: the sign of an expression is the product of the signs of its `M` factors
/// (a numerator and the denominators that it was freed of).
pub trait Expression<const M: usize> {
    const PREDICATE: Predicate;
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; M];
}

#[inline]
pub fn dot<N: Ring>(a: &[N; 3], b: &[N; 3]) -> N {
    N::dot(a, b)
}

#[inline]
pub fn difference<N: Ring>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [a[0].minus(&b[0]), a[1].minus(&b[1]), a[2].minus(&b[2])]
}

/// `a d - b c`
#[inline]
pub fn minor<N: Ring>(a: &N, b: &N, c: &N, d: &N) -> N {
    N::minor(a, b, c, d)
}

#[inline]
pub fn cross<N: Ring>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [minor(&a[1], &a[2], &b[1], &b[2]), minor(&a[2], &a[0], &b[2], &b[0]), minor(&a[0], &a[1], &b[0], &b[1])]
}

#[inline]
pub fn det3<N: Ring>(a: &[N; 3], b: &[N; 3], c: &[N; 3]) -> N {
    let x = a[0].times(&minor(&b[1], &b[2], &c[1], &c[2]));
    let y = a[1].times(&minor(&b[2], &b[0], &c[2], &c[0]));
    let z = a[2].times(&minor(&b[0], &b[1], &c[0], &c[1]));
    x.plus(&y).plus(&z)
}

/// n.v + d
#[inline]
pub fn plane_value<N: Ring>(p: &[N; 4], v: &[N; 3]) -> N {
    N::plane_value(p, v)
}

//! Tier (c): a double with a running bound on its error, in round-to-nearest, without touching the rounding mode.
//!
//! Invariant: the true value is within `e` of `v`, or `e` is infinite or NaN, or `v` is NaN. With u = 2^-53, a sum is off by
//! at most u|v| (never by underflow: sums of doubles below 2^-1021 are exact), a product by at most u|v| + 2^-1075.
//! The bounds are themselves computed in doubles: at most six roundings, covered by the factor 1 + 8u; products in the bound
//! can lose up to three times 2^-1075, which together with the product's own loss is covered by adding the smallest
//! normal number 2^-1022. So no exponent window is needed: tiny operands end undecided, and so do overflows,
//! since an infinite `v` makes `e` infinite or NaN.

use super::Sign;
use super::ring::{Kernel, Ring};
use super::rows::Row;
use super::types::Plane;

/// Half an ulp of 1.
pub const U: f64 = f64::EPSILON / 2.0;
const INFLATE: f64 = 1.0 + 8.0 * U;

#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    pub v: f64,
    pub e: f64,
}

impl Bounded {
    #[inline(always)]
    pub fn exactly(v: f64) -> Self {
        Self { v, e: 0.0 }
    }

    /// The sign, if the bound certifies it. An exact zero (both parts zero) is certain as well.
    #[inline(always)]
    pub fn sign(&self) -> Option<Sign> {
        if self.v > self.e {
            Some(Sign::Positive)
        } else if -self.v > self.e {
            Some(Sign::Negative)
        } else if self.v == 0.0 && self.e == 0.0 {
            Some(Sign::Zero)
        } else {
            None
        }
    }
}

impl Ring for Bounded {
    #[inline(always)]
    fn plus(&self, o: &Self) -> Self {
        let v = self.v + o.v;
        Self { v, e: (self.e + o.e + U * v.abs()) * INFLATE }
    }
    #[inline(always)]
    fn minus(&self, o: &Self) -> Self {
        let v = self.v - o.v;
        Self { v, e: (self.e + o.e + U * v.abs()) * INFLATE }
    }
    #[inline(always)]
    fn times(&self, o: &Self) -> Self {
        let v = self.v * o.v;
        let e = (self.v.abs() + self.e) * o.e + o.v.abs() * self.e + U * v.abs();
        Self { v, e: e * INFLATE + f64::MIN_POSITIVE }
    }
    #[inline(always)]
    fn negated(&self) -> Self {
        Self { v: -self.v, e: self.e }
    }
}

/// Inputs enter as they are, without error.
pub struct BoundedKernel;

impl Kernel for BoundedKernel {
    type N = Bounded;
    #[inline(always)]
    fn coordinate(&self, x: f64) -> Bounded {
        Bounded::exactly(x)
    }
    #[inline(always)]
    fn plane(&self, p: &Plane) -> [Bounded; 4] {
        [p.n[0], p.n[1], p.n[2], p.d].map(Bounded::exactly)
    }
    #[inline(always)]
    fn row<const M: usize>(&self, r: &Row<'_, M>) -> [Bounded; M] {
        match r {
            Row::Values(a) => a.map(Bounded::exactly),
            Row::Difference(a, b) => std::array::from_fn(|i| Bounded::exactly(a[i]).minus(&Bounded::exactly(b[i]))),
            Row::Ones => [Bounded::exactly(1.0); M],
        }
    }
    #[inline(always)]
    fn one(&self) -> Bounded {
        Bounded::exactly(1.0)
    }
}

//! The unevaluated sum of two doubles, with a running bound on its error: about 106 bits, for correct rounding.
//!
//! Invariant: |lo| <= ulp(hi)/2 and the true value is within `err` of `hi + lo`; or `err` is infinite or NaN, or `hi` is NaN.
//! With u = 2^-53: a sum is off by at most 3.1 u² of itself, a product by at most 7 u² of itself (Joldes, Muller,
//! Popescu, "Tight and rigorous error bounds for basic building blocks of double-word arithmetic", 2017, algorithms 6 and
//! 10), so 4u²|hi| and 8u²|hi| hold with room for |hi| against the value. Where a product underflows, each of its
//! roundings loses at most 2^-1075; the smallest normal number is added for all of them and for those in the bound itself.
//! Overflow makes `err` infinite or NaN.

use super::bounded::U;
use super::ring::{Kernel, Ring};
use super::rows::Row;
use super::types::Plane;

const INFLATE: f64 = 1.0 + 16.0 * U;
const U2: f64 = U * U;

#[derive(Clone, Copy, Debug)]
pub struct DoubleDouble {
    pub hi: f64,
    pub lo: f64,
    pub err: f64,
}

/// a + b exactly, as a rounded sum and its error (Knuth).
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let bb = s - a;
    (s, (a - (s - bb)) + (b - bb))
}

/// The same for |a| >= |b|.
#[inline(always)]
pub fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

/// a b as a rounded product and its error: exact unless something under- or overflows.
#[inline(always)]
pub fn two_prod(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    if cfg!(target_feature = "fma") {
        return (p, a.mul_add(b, -p));
    }
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    (p, al * bl - (((p - ah * bh) - al * bh) - ah * bl))
}

/// Veltkamp's split into two numbers of 26 bits.
#[inline(always)]
fn halves(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let h = c - (c - a);
    (h, a - h)
}

impl DoubleDouble {
    #[inline(always)]
    pub fn exactly(x: f64) -> Self {
        Self { hi: x, lo: 0.0, err: 0.0 }
    }

    /// The quotient, within `err`; `None` if nothing is known of it (overflow, a divisor that may be zero).
    ///
    /// Two quotient digits; the remainder's own bound then says how far off they are, whatever their accuracy:
    /// |n − (q₁ + q₂)w| ≤ |r| + err, over the least |w|, rounded up by a wide margin.
    #[inline]
    pub fn over(&self, w: &Self) -> Option<Self> {
        let q1 = self.hi / w.hi;
        let r = self.minus(&Self::exactly(q1).times(w));
        let q2 = r.hi / w.hi;
        let r = r.minus(&Self::exactly(q2).times(w));
        let least = (w.hi.abs() - w.err) * (1.0 - 8.0 * U);
        let off = (r.hi.abs() * (1.0 + 4.0 * U) + r.err) * (1.0 + 8.0 * U) / least * (1.0 + 4.0 * U);
        // Also false for NaN. |q2| <= |q1| can fail only where the quotient is lost in its error; the sum is then not exact.
        if !(least > f64::MIN_POSITIVE && off < f64::MAX && q2.abs() <= q1.abs()) {
            return None;
        }
        let (hi, lo) = fast_two_sum(q1, q2);
        hi.is_finite().then_some(Self { hi, lo, err: off + f64::from_bits(1) })
    }
}

impl Ring for DoubleDouble {
    #[inline]
    fn plus(&self, o: &Self) -> Self {
        let (s, e) = two_sum(self.hi, o.hi);
        let (t, f) = two_sum(self.lo, o.lo);
        let (s, e) = fast_two_sum(s, e + t);
        let (hi, lo) = fast_two_sum(s, e + f);
        Self { hi, lo, err: (self.err + o.err + 4.0 * U2 * hi.abs()) * INFLATE + f64::MIN_POSITIVE }
    }
    #[inline]
    fn minus(&self, o: &Self) -> Self {
        self.plus(&o.negated())
    }
    #[inline]
    fn times(&self, o: &Self) -> Self {
        let (p, e) = two_prod(self.hi, o.hi);
        let (hi, lo) = fast_two_sum(p, e + (self.hi * o.lo + self.lo * o.hi));
        let inherited = (self.hi.abs() + self.err) * o.err + o.hi.abs() * self.err;
        Self { hi, lo, err: (inherited + 8.0 * U2 * hi.abs()) * INFLATE + f64::MIN_POSITIVE }
    }
    #[inline(always)]
    fn negated(&self) -> Self {
        Self { hi: -self.hi, lo: -self.lo, err: self.err }
    }
}

pub struct DoubleDoubleKernel;

impl Kernel for DoubleDoubleKernel {
    type N = DoubleDouble;
    #[inline(always)]
    fn coordinate(&self, x: f64) -> DoubleDouble {
        DoubleDouble::exactly(x)
    }
    #[inline(always)]
    fn plane(&self, p: &Plane) -> [DoubleDouble; 4] {
        [p.n[0], p.n[1], p.n[2], p.d].map(DoubleDouble::exactly)
    }
    #[inline(always)]
    fn row<const M: usize>(&self, r: &Row<'_, M>) -> [DoubleDouble; M] {
        let x = |x: f64| DoubleDouble::exactly(x);
        match r {
            Row::Values(a) => a.map(x),
            Row::Difference(a, b) => std::array::from_fn(|i| x(a[i]).minus(&x(b[i]))),
            Row::Ones => [x(1.0); M],
        }
    }
    #[inline(always)]
    fn one(&self) -> DoubleDouble {
        DoubleDouble::exactly(1.0)
    }
}

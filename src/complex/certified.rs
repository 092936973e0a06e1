//! Double-double arithmetic whose error bound is measured, not estimated: what a sum loses is computed and added to the
//! bound, so a chain of operations that happens to be exact knows that it is (`err` = 0). Lattice cells, axis-aligned
//! faces, float coordinates: exact zeros and exact ties between doubles are ordinary there, and an estimated bound
//! could never decide them.
//!
//! Invariant: the true value is within `err` of `hi + lo`, and hi = fl(hi + lo). `err` is infinite or NaN, or `hi` is,
//! when something over- or underflowed; then [`rounded`](Certified::rounded) has no answer and the caller goes to rationals.
//! No fused operation is needed; none changes a certified result. Cost: an addition about 30 operations, a product 35.

use crate::exact::double_double::{fast_two_sum, two_prod, two_sum};

/// A value near hi + lo, within err.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certified {
    pub hi: f64,
    pub lo: f64,
    pub err: f64,
}

const U: f64 = f64::EPSILON / 2.0;
/// Covers the rounding of a bound that is itself a sum of at most a dozen terms.
const INFLATE: f64 = 1.0 + 16.0 * U;
/// Products below 2⁻⁹⁰⁰ are not trusted: their error term could underflow.
const SMALL: f64 = f64::from_bits(123 << 52);
/// Relative weight of what underflow can take from cross terms of a trusted product: 2⁻¹⁷⁴ of it.
const CROSS: f64 = f64::from_bits((1023 - 160) << 52);

impl Certified {
    pub const ZERO: Self = Self { hi: 0.0, lo: 0.0, err: 0.0 };

    #[inline(always)]
    pub fn exactly(x: f64) -> Self {
        Self { hi: x, lo: 0.0, err: 0.0 }
    }

    /// Certainly zero.
    #[inline(always)]
    pub fn is_zero(self) -> bool {
        self.hi == 0.0 && self.err == 0.0
    }

    /// Upper bound on the magnitude.
    #[inline(always)]
    fn size(self) -> f64 {
        self.hi.abs() * (1.0 + 4.0 * U)
    }

    /// A third.
    #[inline(always)]
    pub fn third(self) -> Self {
        let q = self.hi / 3.0;
        // 3q = 2q + q and two exact remainders: what is left of hi, and of all.
        let thrice = |q: f64| two_sum(2.0 * q, q);
        let (a, b) = thrice(q);
        let (r, s) = two_sum(self.hi - a, -b);
        let (r, t) = two_sum(r, self.lo);
        let (hi, lo) = fast_two_sum(q, r / 3.0);
        // The second digit's remainder, by the same steps from the exact parts of the first (fast_two_sum is exact).
        let (d, e) = thrice(r / 3.0);
        let (left, f) = two_sum(r - d, -e);
        let left = left.abs() + f.abs() + s.abs() + t.abs();
        Self { hi, lo, err: (left + self.err) * (INFLATE / 3.0) + if left == 0.0 { 0.0 } else { f64::MIN_POSITIVE } }
    }

    /// Exactly x − y.
    #[inline(always)]
    pub fn difference(x: f64, y: f64) -> Self {
        let (hi, lo) = two_sum(x, -y);
        Self { hi, lo, err: 0.0 }
    }

    /// Times a power of two: exactly, unless the low part gets too small.
    #[inline(always)]
    pub fn scaled(self, power: f64) -> Self {
        let (hi, lo) = (self.hi * power, self.lo * power);
        let lost = hi.abs() < SMALL && self.hi != 0.0 || lo.abs() < f64::MIN_POSITIVE && self.lo != 0.0;
        Self { hi, lo, err: if lost { f64::INFINITY } else { self.err * power * INFLATE } }
    }

    /// Times a double, losing nothing where the product fits into two doubles (a general product bounds its cross terms).
    #[inline(always)]
    pub fn times(self, x: f64) -> Self {
        let (p, e) = two_prod(self.hi, x);
        let (c, f) = two_prod(self.lo, x);
        let (e, r) = two_sum(e, c);
        let (s, e) = two_sum(p, e);
        let (r, q) = two_sum(r, f);
        let (e, t) = two_sum(e, r);
        let (hi, lo) = two_sum(s, e);
        let small = |product: f64, factor: f64| product.abs() < SMALL && factor != 0.0 && x != 0.0;
        let lost = if small(p, self.hi) || small(c, self.lo) { f64::INFINITY } else { 0.0 };
        Self { hi, lo, err: (q.abs() + t.abs() + self.err * x.abs()) * INFLATE + lost }
    }

    /// The double nearest to the true value (ties to even, zero is +0), if the bound proves which it is.
    #[inline]
    pub fn rounded(self) -> Option<f64> {
        if self.err == 0.0 {
            // hi = fl(hi + lo), so hi is the rounding of the exact value, ties included.
            return self.hi.is_finite().then_some(self.hi + 0.0);
        }
        // lo ± err, with room for the rounding of these two sums.
        let e = self.err * INFLATE + self.lo.abs() * (4.0 * U);
        let (up, down) = (self.hi + (self.lo + e), self.hi + (self.lo - e));
        // Rounding is monotone: both ends of the interval round to hi, so the true value does. Far below SMALL the
        // sums above could be subnormal, where the room given to them is not enough.
        (up == self.hi && down == self.hi && self.hi.abs() > SMALL && self.hi.is_finite()).then_some(self.hi)
    }

    /// Certainly positive or certainly negative (1 or −1), zero (0), or unknown.
    pub fn sign(self) -> Option<i8> {
        if self.err == 0.0 && self.hi.is_finite() {
            return Some(if self.hi > 0.0 { 1 } else { -((self.hi < 0.0) as i8) });
        }
        let e = self.err * INFLATE + self.lo.abs() * (4.0 * U);
        match (self.hi > e - self.lo && self.hi > 0.0, -self.hi > e + self.lo && self.hi < 0.0) {
            (true, _) if self.hi.is_finite() => Some(1),
            (_, true) if self.hi.is_finite() => Some(-1),
            _ => None,
        }
    }
}

impl std::ops::Neg for Certified {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo, err: self.err }
    }
}

impl std::ops::Add for Certified {
    type Output = Self;
    /// Every step is an exact transformation of the sum into parts; the two parts that are dropped are the error.
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        // Input and what lies on axis-aligned planes has no low part.
        if self.lo == 0.0 && o.lo == 0.0 {
            let (hi, lo) = two_sum(self.hi, o.hi);
            return Self { hi, lo, err: (self.err + o.err) * INFLATE };
        }
        let (s, e) = two_sum(self.hi, o.hi);
        let (t, f) = two_sum(self.lo, o.lo);
        let (e, r) = two_sum(e, t);
        let (s, e) = two_sum(s, e);
        let (e, q) = two_sum(e, f);
        let (hi, lo) = two_sum(s, e);
        Self { hi, lo, err: (self.err + o.err + r.abs() + q.abs()) * INFLATE }
    }
}

impl std::ops::Sub for Certified {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl std::ops::Mul for Certified {
    type Output = Self;
    /// hi·hi exactly; of the cross terms each rounding is bounded by u of what it rounds, which is zero where they are.
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let (p, e) = two_prod(self.hi, o.hi);
        // The error term of a product too small to have one exactly; below, also cross terms that underflow.
        let lost = if p.abs() < SMALL && self.hi != 0.0 && o.hi != 0.0 { f64::INFINITY } else { 0.0 };
        if self.lo == 0.0 && o.lo == 0.0 {
            let inherited = self.size() * o.err + (o.size() + o.err) * self.err;
            return Self { hi: p, lo: e, err: inherited * INFLATE + lost };
        }
        let (c, d) = (self.hi * o.lo, self.lo * o.hi);
        let cross = c + d;
        let (l, r) = two_sum(e, cross);
        let (hi, lo) = two_sum(p, l);
        let dropped = r.abs() + U * (c.abs() + d.abs() + cross.abs()) + (self.lo * o.lo).abs();
        let inherited = self.size() * o.err + (o.size() + o.err) * self.err;
        let under = if self.lo != 0.0 || o.lo != 0.0 { p.abs() * CROSS } else { 0.0 };
        Self { hi, lo, err: (dropped + inherited + under) * INFLATE + lost }
    }
}

impl std::ops::Div for Certified {
    type Output = Self;
    /// Two quotient digits; the bound is the remainder that they leave, divided by the least the divisor can be, so a
    /// division that comes out exactly is known to.
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let q = self.hi / o.hi;
        let rest = self - o.times(q);
        let (hi, lo) = fast_two_sum(q, rest.hi / o.hi);
        let rest = (self - o.times(hi)) - o.times(lo);
        let left = (rest.size() + rest.err) * INFLATE;
        let least = o.hi.abs() * (1.0 - 4.0 * U) - o.err * INFLATE;
        let err = if left == 0.0 {
            0.0
        } else if least > 0.0 {
            left / least * INFLATE + f64::MIN_POSITIVE
        } else {
            f64::INFINITY
        };
        Self { hi, lo, err }
    }
}

pub type Vector = [Certified; 3];

#[inline(always)]
pub fn minus(a: &Vector, b: &Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub fn dot(a: &Vector, b: &Vector) -> Certified {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a b − c d
#[inline(always)]
pub fn minor(a: Certified, b: Certified, c: Certified, d: Certified) -> Certified {
    a * b - c * d
}

#[inline(always)]
pub fn cross(a: &Vector, b: &Vector) -> Vector {
    [minor(a[1], b[2], a[2], b[1]), minor(a[2], b[0], a[0], b[2]), minor(a[0], b[1], a[1], b[0])]
}

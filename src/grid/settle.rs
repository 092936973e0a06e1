//! Which double stands for an exact value in the arrays of a grid: the nearest, where a value within 2⁻¹² of a spacing of the
//! midpoint between two doubles counts as that midpoint and goes to the even one. So each double is within 0.5003 ulp of the
//! exact value, and depends on the exact value alone: not on threads, order, labels or the layout of blocks.
//!
//! Why not plainly the nearest: by symmetry a third of the centroids on a grid are exact midpoints, and an approximation can
//! never prove that. That a value lies within that strip, it can; and no symmetry puts values on the strip's border.

use crate::exact::round_rational;
use rug::Rational;

/// The unevaluated sum of two doubles. Its error is known by the context, not carried.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pair {
    pub hi: f64,
    pub lo: f64,
}

/// Half the width of the strip around a midpoint, in spacings.
const STRIP: f64 = 1.0 / 4096.0;
/// 2⁻⁹⁰⁰: smaller values are left to rationals, so that nothing here underflows.
const SMALL: f64 = f64::from_bits(123 << 52);
/// 2⁻⁵⁴ less room for the strip and for the rounding of a sum of two.
const NEAR: f64 = f64::EPSILON / 4.0 * (1.0 - 1.0 / 1024.0);

/// The double that stands for a value within `err` of hi + lo, where |lo| is at most a spacing of `hi`; `None` if the bound does
/// not prove which it is.
#[inline(always)]
pub fn settle(x: Pair, err: f64) -> Option<f64> {
    let hi = x.hi + x.lo;
    let lo = x.lo - (hi - x.hi);
    // Also false for NaN. Half the spacing on either side of hi is at least 2⁻⁵⁴|hi|.
    if lo.abs() + err <= hi.abs() * NEAR && hi.abs() > SMALL && hi.abs() < f64::MAX {
        return Some(hi);
    }
    near_midpoint(hi, lo, err)
}

#[cold]
#[inline(never)]
fn near_midpoint(hi: f64, lo: f64, err: f64) -> Option<f64> {
    if hi == 0.0 && lo == 0.0 && err == 0.0 {
        return Some(0.0);
    }
    if !(hi.abs() > SMALL && hi.abs() < f64::MAX && err < lo.abs()) {
        return None;
    }
    let other = if lo > 0.0 { hi.next_up() } else { hi.next_down() };
    let gap = (other - hi).abs();
    // Distance from the midpoint. Exact but for a relative rounding, which the inflated bound covers.
    let off = lo.abs() - gap / 2.0;
    let (err, strip) = (err * 1.001 + gap * 1e-12, gap * STRIP);
    if off + err < -strip {
        Some(hi)
    } else if off.abs() + err < strip {
        Some(if hi.to_bits() & 1 == 0 { hi } else { other })
    } else if off - err > strip && off + err < gap / 4.0 {
        Some(other)
    } else {
        None
    }
}

/// The same for a value that is known exactly. Infinite beyond the range of doubles; zero is +0.
pub fn settle_rational(x: &Rational) -> f64 {
    let near = round_rational(x);
    let Some(exact) = Rational::from_f64(near) else { return near };
    let rest = Rational::from(x - &exact);
    if rest.is_zero() || near == 0.0 {
        return near;
    }
    let other = if rest > 0 { near.next_up() } else { near.next_down() };
    let Some(other_exact) = Rational::from_f64(other) else { return near };
    let gap = (other_exact - exact).abs();
    let off = (rest.abs() - Rational::from(&gap / 2)).abs();
    let even = if near.to_bits() & 1 == 0 { near } else { other };
    if off <= gap / 4096 { even + 0.0 } else { near }
}

#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> Pair {
    let (hi, lo) = crate::exact::double_double::two_sum(a, b);
    Pair { hi, lo }
}

/// A product and its error, which is exact both ways.
#[inline(always)]
fn two_prod<const FUSED: bool>(a: f64, b: f64) -> (f64, f64) {
    if FUSED {
        let p = a * b;
        return (p, a.mul_add(b, -p));
    }
    crate::exact::double_double::two_prod(a, b)
}

impl Pair {
    #[inline(always)]
    pub fn of(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }
    /// For |a| >= |b| or a = 0.
    #[inline(always)]
    pub fn joined(a: f64, b: f64) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }
    /// Off by at most 2⁻¹⁰⁰ of |a| + |b|.
    #[inline(always)]
    pub fn plus(self, o: Self) -> Self {
        let s = two_sum(self.hi, o.hi);
        Self::joined(s.hi, s.lo + (self.lo + o.lo))
    }
    /// Off by at most 2⁻¹⁰⁰ of itself.
    #[inline(always)]
    pub fn times(self, o: Self) -> Self {
        self.times_as::<false>(o)
    }
    /// The same bits; `FUSED`: with fused multiplication (see [`crate::base::processor`]).
    #[inline(always)]
    pub fn times_as<const FUSED: bool>(self, o: Self) -> Self {
        let (p, e) = two_prod::<FUSED>(self.hi, o.hi);
        Self::joined(p, e + (self.hi * o.lo + self.lo * o.hi))
    }
    /// Times a power of two.
    #[inline(always)]
    pub fn scaled(self, power: f64) -> Self {
        Self { hi: self.hi * power, lo: self.lo * power }
    }
    /// Divided by `o`, given 1 / o.hi (to a few units in its last place); off by at most 2⁻⁹⁸ of itself.
    #[inline(always)]
    pub fn over(self, o: Self, inverse: f64) -> Self {
        self.over_as::<false>(o, inverse)
    }
    /// The same bits; `FUSED`: as in [`times_as`](Self::times_as).
    #[inline(always)]
    pub fn over_as<const FUSED: bool>(self, o: Self, inverse: f64) -> Self {
        let q = self.hi * inverse;
        let (p, e) = two_prod::<FUSED>(q, o.hi);
        let rest = (((self.hi - p) - e) + self.lo) - q * o.lo;
        Self::joined(q, rest * inverse)
    }
}

//! Coordinates within a box: a whole number of units, 2⁻⁶¹ of a power of two that holds the box along that axis, and the rest as
//! a double. Sums and products of the whole numbers are exact in 128 bits and do not depend on order; the rests enter to
//! first order, in plain doubles. So a polygon's area costs six multiplications and is known to about 2⁻⁸⁰ of its size.
//!
//! What a coordinate is off by (`slack`) is certified: the residuals' 2⁻⁹⁰ of the mesh's extent and a few roundings.

use super::lattice::Lattice;
use super::settle::{Pair, settle, settle_rational, two_sum};
use crate::base::BoxId;
use rug::Rational;

/// A coordinate, or a length, in units of an interval: h + l, with |l| <= 0.51.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    pub h: i64,
    pub l: f64,
}

/// The part of an axis between two neighbouring nodes.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
    /// Its length is less than 2^exponent, and at least half of that.
    pub exponent: i32,
    /// 2^(61 − exponent), and its inverse: a unit's length.
    pub scale: f64,
    pub unit: f64,
    pub length: Place,
    /// Its length over 2^exponent.
    pub size: Pair,
    pub middle: f64,
    /// A coordinate is off by at most this, in units.
    pub slack: f64,
    /// Everything is within the range for which the bounds are proven.
    pub ordinary: bool,
}

/// Units per 2^exponent.
pub const UNITS: f64 = (1u64 << 61) as f64;
const ROUND: f64 = 1.5 * (1u64 << 52) as f64;

/// 2^e for a normal result.
#[inline(always)]
pub fn power(e: i32) -> f64 {
    f64::from_bits(((e + 1023) as u64) << 52)
}

impl Interval {
    fn new(low: f64, high: f64, extent: f64) -> Self {
        let length = high - low;
        // The exponent above the leading bit. (Of a subnormal or infinite length: out of range.)
        let exponent = ((length.to_bits() >> 52) & 0x7ff) as i32 - 1022;
        let e = exponent.clamp(-240, 240);
        let (scale, unit) = (power(61 - e), power(e - 61));
        let slack = extent * scale * power(-89) + power(-42);
        let ordinary = e == exponent && extent * scale < power(100);
        let mut x = Self {
            low,
            high,
            exponent,
            scale,
            unit,
            length: Place::default(),
            size: Pair::default(),
            middle: 0.0,
            slack,
            ordinary,
        };
        x.length = x.place(high, 0.0);
        x.size = Pair::joined(x.length.h as f64, (x.length.h - x.length.h as f64 as i64) as f64 + x.length.l);
        x.size = x.size.scaled(1.0 / UNITS);
        let sum = two_sum(low, high);
        x.middle = settle(sum.scaled(0.5), 0.0).unwrap_or_else(|| {
            let exact = |x: f64| Rational::from_f64(x).unwrap_or_default();
            settle_rational(&((exact(low) + exact(high)) / 2))
        });
        x
    }

    /// The place of x + residual.
    ///
    /// x − low is exact as s + t, and s times a power of two too. |t| <= 2⁷ units, the residual at most 2⁻⁵³ of the extent, which
    /// an ordinary interval keeps below 2⁴⁷ units; so the rounding of their sum is within the slack.
    #[inline(always)]
    pub fn place(&self, x: f64, residual: f64) -> Place {
        let Pair { hi: s, lo: t } = two_sum(x, -self.low);
        let y = s * self.scale;
        let h = y as i64;
        let f = y - h as f64;
        let g = (t + residual) * self.scale;
        // To the nearest whole number.
        let k = ((f + g) + ROUND) - ROUND;
        Place { h: h + k as i64, l: (f - k) + g }
    }
}

/// The intervals of a lattice's axes.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    pub axes: [Vec<Interval>; 3],
}

impl Frames {
    pub fn new(lattice: &Lattice, extent: f64) -> Self {
        let axis = |a: usize| lattice.nodes[a].windows(2).map(|w| Interval::new(w[0], w[1], extent)).collect();
        Self { axes: [axis(0), axis(1), axis(2)] }
    }
    #[inline(always)]
    pub fn of_box(&self, lattice: &Lattice, b: BoxId) -> [&Interval; 3] {
        let at = lattice.box_at(b);
        [&self.axes[0][at[0]], &self.axes[1][at[1]], &self.axes[2][at[2]]]
    }
}

/// a b / 2⁶⁴, rounded down.
#[inline(always)]
pub fn high(a: i128, b: i64) -> i128 {
    let (h, l) = ((a >> 64) as i64, a as u64);
    (h as i128 * b as i128).wrapping_add((l as i128 * b as i128) >> 64)
}

/// a b / 2¹²⁸, at most 3 too low.
#[inline(always)]
pub fn high_of_wide(a: i128, b: i128) -> i128 {
    let (ah, al, bh, bl) = ((a >> 64) as i64 as i128, a as u64 as i128, (b >> 64) as i64 as i128, b as u64 as i128);
    (ah * bh).wrapping_add((ah * bl) >> 64).wrapping_add((al * bh) >> 64)
}

/// A product of differences of whole numbers, which fit 63 bits with their sign.
#[inline(always)]
pub fn product(a: i64, b: i64) -> i128 {
    a as i128 * b as i128
}

/// The leading part, off by less than 2⁶⁴ and a relative 2⁻⁵³.
#[inline(always)]
pub fn rough(x: i128) -> f64 {
    (x >> 64) as i64 as f64 * 18446744073709551616.0
}

/// x + c as a pair; |x| < 2¹²⁶. Off by at most 2⁻⁵² of |c| + 2³², and 2⁻¹⁰⁴ of the sum.
#[inline(always)]
pub fn pair(x: i128, c: f64) -> Pair {
    // Three parts that are exact as doubles.
    let a = (x >> 74) as i64 as f64 * power(74);
    let b = ((x >> 32) as i64 & ((1 << 42) - 1)) as f64 * power(32);
    let d = (x as u32) as f64;
    let top = Pair::joined(a, b);
    let s = two_sum(top.hi, d + c);
    Pair::joined(s.hi, s.lo + top.lo)
}

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

/// Places along some axes side by side, for vectors.
#[derive(Clone, Copy, Debug)]
pub struct Spot<const N: usize> {
    pub h: [i64; N],
    pub l: [f64; N],
}

/// What [`Spot`]s are relative to: low ends and scales of the intervals.
#[derive(Clone, Copy, Debug)]
pub struct Framing<const N: usize> {
    low: [f64; N],
    scale: [f64; N],
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
    /// Its length over 2^exponent, and the inverse of that, rounded.
    pub size: Pair,
    pub inverse: f64,
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
            inverse: 0.0,
            middle: 0.0,
            slack,
            ordinary,
        };
        x.length = x.place(high, 0.0);
        x.size = Pair::joined(x.length.h as f64, (x.length.h - x.length.h as f64 as i64) as f64 + x.length.l);
        x.size = x.size.scaled(1.0 / UNITS);
        x.inverse = 1.0 / x.size.hi;
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

impl<const N: usize> Framing<N> {
    /// Lanes beyond the given intervals are idle: zeros stay zeros.
    #[inline(always)]
    pub fn of(frames: &[&Interval]) -> Self {
        let lane = |f: fn(&Interval) -> f64| std::array::from_fn(|i| frames.get(i).map_or(0.0, |x| f(x)));
        Self { low: lane(|x| x.low), scale: lane(|x| x.scale) }
    }

    /// The places of x + residual: [`Interval::place`] without conversions to integers, for which narrow vectors have no instruction.
    /// A sum with 1.5·2⁸⁴ is a multiple of 2³² and shows it in its last bits; |y| < 2⁶³ where intervals are ordinary.
    #[inline(always)]
    pub fn spot(&self, x: &[f64; N], residual: &[f64; N]) -> Spot<N> {
        const TOP: f64 = 1.5 * (1u128 << 84) as f64;
        let mut out = Spot { h: [0; N], l: [0.0; N] };
        for i in 0..N {
            let Pair { hi: s, lo: t } = two_sum(x[i], -self.low[i]);
            let y = s * self.scale[i];
            let top = y + TOP;
            let rest = y - (top - TOP);
            let middle = rest + ROUND;
            let f = rest - (middle - ROUND);
            let g = (t + residual[i]) * self.scale[i];
            let last = (f + g) + ROUND;
            let k = last - ROUND;
            let part = |x: f64, zero: f64| x.to_bits().wrapping_sub(zero.to_bits());
            out.h[i] = (part(top, TOP) << 32).wrapping_add(part(middle, ROUND)).wrapping_add(part(last, ROUND)) as i64;
            out.l[i] = (f - k) + g;
        }
        out
    }
}

/// A sum in fixed point: whole units, and the first-order part.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sum {
    pub h: i128,
    pub l: f64,
}

impl Sum {
    #[inline(always)]
    pub fn add(&mut self, h: i128, l: f64) {
        self.h = self.h.wrapping_add(h);
        self.l += l;
    }
    #[inline(always)]
    pub fn pair(self) -> Pair {
        pair(self.h, self.l)
    }
}

pub const TO_64: f64 = 1.0 / 18446744073709551616.0;
pub const TO_128: f64 = TO_64 * TO_64;
/// What pairs lose, with room.
pub const LOSS: f64 = f64::from_bits((1023 - 96) << 52);

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
fn pair(x: i128, c: f64) -> Pair {
    // Three parts that are exact as doubles.
    let a = (x >> 74) as i64 as f64 * power(74);
    let b = ((x >> 32) as i64 & ((1 << 42) - 1)) as f64 * power(32);
    let d = (x as u32) as f64;
    let top = Pair::joined(a, b);
    let s = two_sum(top.hi, d + c);
    Pair::joined(s.hi, s.lo + top.lo)
}

/// The coordinate at a place plus q, where q and its bound are in terms of 2^exponent; the place's rest is off by the slack.
#[inline(always)]
pub fn coordinate(frame: &Interval, o: Place, q: Pair, err: f64) -> Option<f64> {
    let top = (o.h >> 32 << 32) as f64 * frame.unit;
    let rest = (o.h as u32) as f64 * frame.unit;
    let length = frame.unit * UNITS;
    let (q, err) = (q.scaled(length), err * length + if o.l == 0.0 { 0.0 } else { frame.slack * frame.unit });
    let s = two_sum(frame.low, top).plus(two_sum(q.hi, rest)).plus(two_sum(q.lo, o.l * frame.unit));
    let loss = (frame.low.abs() + length + q.hi.abs()) * LOSS;
    settle(s, err + loss)
}

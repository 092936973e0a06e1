//! From exact points to doubles: approximations with a bound, correct rounding (nearest, ties to even, zero is +0), and
//! exact rationals.
//!
//! Rounding: a coordinate that is a quotient of two input numbers is one division. Otherwise X / W is formed in double-double
//! with a bound; if both ends of the interval round alike, that is the answer. If they round to neighbours, one exact sign
//! against their midpoint decides: more than a third of the midpoints of edges are exact ties, so that is a common case and
//! runs on the stack (tier d). Wider intervals (an exact zero after cancellation, slivers, overflow, deep underflow) get an exact
//! test for zero and then the exact quotient. Subnormals need no special case: the sums in the rounding test are
//! rounded to their fixed ulp by the hardware. Points on edges and in triangles first try a cheaper evaluation with a cruder
//! bound (`interpolate.rs`), which nearly always decides.

use super::Sign;
use super::big::BigKernel;
use super::bounded::{Bounded, BoundedKernel, U};
use super::counters::{Predicate, Tier, count};
use super::double_double::{DoubleDouble, DoubleDoubleKernel};
use super::lift::Scan;
use super::points::{Symbolic, denominator, homogeneous, numerator, plain};
use super::ring::{Expression, Kernel, Ring};
use super::tiers::exact_sign;
use super::types::{Approx, Point};
use rug::{Integer, Rational};

/// Coordinates with certified bounds. Cost: some 50 ns. The bound is infinite where nothing is known (overflow, W near 0).
pub fn approx(x: &Point) -> Approx {
    if let Point::Vertex(v) = x {
        return Approx { x: *v, err: [0.0; 3] };
    }
    let [a, b, c, w] = homogeneous(&BoundedKernel, x);
    let mut out = Approx { x: [0.0; 3], err: [f64::INFINITY; 3] };
    for (i, n) in [a, b, c].iter().enumerate() {
        (out.x[i], out.err[i]) = match plain(x, i) {
            // One rounding; a subnormal quotient is off by at most 2^-1075.
            Some((n, 1.0)) => (n, 0.0),
            Some((n, d)) => {
                let q = n / d;
                (q, q.abs() * (2.0 * U) + f64::MIN_POSITIVE)
            }
            None => quotient(n, &w),
        };
        if !(out.x[i].is_finite() && out.err[i].is_finite()) {
            (out.x[i], out.err[i]) = (0.0, f64::INFINITY);
        }
    }
    out
}

/// q = fl(n/w): with r = n - q w (a bounded expression, so |n - q w| <= |r.v| + r.e for the true n and w), the error of q is at most
/// (|r.v| + r.e) / (|w.v| - w.e).
fn quotient(n: &Bounded, w: &Bounded) -> (f64, f64) {
    let q = n.v / w.v;
    let r = n.minus(&Bounded::exactly(q).times(w));
    let least = (w.v.abs() - w.e) * (1.0 - 4.0 * U);
    let err = (r.v.abs() + r.e) * (1.0 + 8.0 * U) / least * (1.0 + 4.0 * U) + f64::MIN_POSITIVE;
    if least > f64::MIN_POSITIVE && err.is_finite() { (q, err) } else { (0.0, f64::INFINITY) }
}

/// Correctly rounded coordinates, ties to even, zero is +0; beyond the range of doubles, infinite.
/// Cost: some 30 ns on an edge and 60 ns in a triangle; where that does not decide, and for other points, some 300 ns, exact ties
/// included.
pub fn round(x: &Point) -> [f64; 3] {
    if let Point::Vertex(v) = x {
        return v.map(|c| c + 0.0);
    }
    round_symbolic(x)
}

/// The same for any symbolic point.
#[inline]
pub fn round_symbolic(x: &impl Symbolic) -> [f64; 3] {
    let mut out = [0.0; 3];
    let mut open = [true; 3];
    for i in 0..3 {
        if let Some((n, d)) = x.plain(i) {
            count(Predicate::Rounding, Tier::Filter);
            // Adding +0 turns -0 into +0 and leaves everything else alone.
            out[i] = n / d + 0.0;
            open[i] = false;
        }
    }
    if open == [false; 3] {
        return out;
    }
    for (i, value) in x.quick(&open).into_iter().enumerate() {
        if let Some(value) = value {
            count(Predicate::Rounding, Tier::Bounded);
            out[i] = value + 0.0;
            open[i] = false;
        }
    }
    if open == [false; 3] {
        return out;
    }
    round_open(x, &open, &mut out);
    out
}

/// What the quick evaluation left open.
#[cold]
#[inline(never)]
fn round_open(x: &impl Symbolic, open: &[bool; 3], out: &mut [f64; 3]) {
    let s = x.shape(&DoubleDoubleKernel);
    let w = denominator(&DoubleDoubleKernel, &s);
    for i in 0..3 {
        if open[i] {
            out[i] = round_coordinate(x, i, &numerator(&s, i), &w) + 0.0;
        }
    }
}

fn round_coordinate(x: &impl Symbolic, axis: usize, n: &DoubleDouble, w: &DoubleDouble) -> f64 {
    if let Some((low, high)) = interval(n, w) {
        if low == high {
            count(Predicate::Rounding, Tier::Bounded);
            return low;
        }
        if low.next_up() == high && low.is_finite() && high.is_finite() {
            return match sign_of_midpoint(x, axis, low, high) {
                Sign::Negative => low,
                Sign::Positive => high,
                // The even one of two neighbours. (Around zero: ±0 and the least subnormal, which is odd.)
                Sign::Zero => [low, high][(low.to_bits() & 1) as usize],
            };
        }
    }
    // (Counted as two decisions where it is not zero; that is rare.)
    if exact_sign(&Numerator(x, axis)).is_zero() {
        return 0.0;
    }
    count(Predicate::Rounding, Tier::Big);
    let (n, d, e) = exact_quotient(x, axis);
    round_quotient(&n, &d, e)
}

/// The doubles nearest to the ends of an interval that holds n / w.
fn interval(n: &DoubleDouble, w: &DoubleDouble) -> Option<(f64, f64)> {
    let q = n.over(w)?;
    // The inner sums are rounded outwards, the outer ones to nearest: rounding is monotonous.
    Some((q.hi + (q.lo - q.err).next_down(), q.hi + (q.lo + q.err).next_up()))
}

/// 2X - (low + high) W, and W.
struct Midpoint<'a, P> {
    x: &'a P,
    axis: usize,
    low: f64,
    high: f64,
}

impl<P: Symbolic> Expression<2> for Midpoint<'_, P> {
    const PREDICATE: Predicate = Predicate::Rounding;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 2] {
        let s = self.x.shape(k);
        let (n, w) = (numerator(&s, self.axis), denominator(k, &s));
        let m = k.coordinate(self.low).plus(&k.coordinate(self.high));
        [n.plus(&n).minus(&m.times(&w)), w]
    }
}

/// Which side of the midpoint of two neighbouring doubles the coordinate is on. Double-double could not tell, so
/// the weaker bound is not asked.
fn sign_of_midpoint(x: &impl Symbolic, axis: usize, low: f64, high: f64) -> Sign {
    exact_sign(&Midpoint { x, axis, low, high })
}

struct Numerator<'a, P>(&'a P, usize);

impl<P: Symbolic> Expression<1> for Numerator<'_, P> {
    const PREDICATE: Predicate = Predicate::Rounding;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        [numerator(&self.0.shape(k), self.1)]
    }
}

/// Numerator, denominator, and the power of two to multiply their quotient with.
fn exact_quotient(x: &impl Symbolic, axis: usize) -> (Integer, Integer, i32) {
    let scan = Scan::new();
    x.shape(&scan);
    let k = BigKernel { e: scan.exponent() };
    let s = x.shape(&k);
    (numerator(&s, axis), denominator(&k, &s), k.e)
}

/// Exact coordinates, in lowest terms. Zeros where the carriers do not meet in one point.
pub fn rational(x: &impl Symbolic) -> [Rational; 3] {
    let scan = Scan::new();
    x.shape(&scan);
    let k = BigKernel { e: scan.exponent() };
    let [a, b, c, w] = homogeneous(&k, x);
    if w.is_zero() {
        return std::array::from_fn(|_| Rational::new());
    }
    [a, b, c].map(|n| Rational::from((n, w.clone())) << k.e)
}

/// Correctly rounded double of a rational (rug's `to_f64` truncates): nearest, ties to even, zero is +0; infinite
/// beyond the range.
pub fn round_rational(x: &Rational) -> f64 {
    round_quotient(x.numer(), x.denom(), 0)
}

/// Correctly rounded n / d 2^e. A zero denominator gives NaN.
pub fn round_quotient(n: &Integer, d: &Integer, e: i32) -> f64 {
    if d.is_zero() {
        return f64::NAN;
    }
    if n.is_zero() {
        return 0.0;
    }
    let negative = n.is_negative() != d.is_negative();
    // |n/d| is in (2^(size-1), 2^(size+1)). Take its integer part in units of 2^unit: at least 56 bits, or down to a
    // quarter of the least subnormal; what is cut off sets one sticky bit below, which keeps ties apart from near ties.
    let size = n.significant_bits() as i64 - d.significant_bits() as i64 + e as i64;
    if size > 1026 {
        return if negative { f64::NEG_INFINITY } else { f64::INFINITY };
    }
    let unit = (size - 57).max(-1076);
    let shift = unit - e as i64;
    let (mut n, mut d) = (Integer::from(n.abs_ref()), Integer::from(d.abs_ref()));
    if shift >= 0 {
        d <<= shift as u32;
    } else {
        n <<= (-shift) as u32;
    }
    let (q, r) = n.div_rem(d);
    // q < 2^58
    let m = q.to_u64().map_or(u64::MAX, |q| q << 1 | (!r.is_zero()) as u64);
    let magnitude = round_bits(m, unit - 1);
    if negative && magnitude != 0.0 { -magnitude } else { magnitude }
}

/// m 2^s rounded to nearest, ties to even, for s >= -1077.
fn round_bits(m: u64, s: i64) -> f64 {
    if m == 0 {
        return 0.0;
    }
    let top = s + 63 - m.leading_zeros() as i64;
    let ulp = (top - 52).max(-1074);
    let cut = ulp - s;
    let (m, s) = if cut <= 0 {
        (m, s)
    } else {
        let (kept, rest, half) = (m >> cut, m & ((1 << cut) - 1), 1u64 << (cut - 1));
        (kept + (rest > half || (rest == half && kept & 1 == 1)) as u64, ulp)
    };
    if s > 971 {
        return f64::INFINITY;
    }
    // m <= 2^53 is a double, 2^s is one too (subnormal for s < -1022), and so is their product unless it overflows.
    let power = if s >= -1022 { f64::from_bits(((s + 1023) as u64) << 52) } else { f64::from_bits(1 << (s + 1074)) };
    m as f64 * power
}

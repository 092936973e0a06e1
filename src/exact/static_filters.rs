//! Tier (b): semi-static filters of the hot predicates, plain doubles with one bound per call. Each returns `None` where its
//! proof does not decide.
//!
//! Notation: u = 2^-53. A plane value v = ((n0 x + n1 y) + n2 z) + d is computed together with its magnitude
//! S = ((|n0 x| + |n1 y|) + |n2 z|) + |d|. Every term passes at most four roundings, so |v - exact| <= ((1+u)^4 - 1) S_exact <= 4.1 u S_exact,
//! and S >= (1 - 4.1u) S_exact, thus <= 4.2 u S; to this each of three products may add 2^-1075 by underflow. [`SIDE`] takes 5 u.
//!
//! Where values are multiplied, the products must not underflow unseen: every magnitude must lie in the window
//! [2^-300, 2^300]. Then a product of three magnitudes is within 2^±900, an underflow inside a value (2^-1073 at most) is below u^8 of
//! its magnitude, and an underflow of a product of two or three *values* (2^-1074 at most) below u^3 of the product of
//! the magnitudes; the constants have more than that to spare. An infinite or NaN operand fails the window.

use super::Sign;
use super::bounded::U;
use super::types::Plane;

const SIDE: f64 = 5.0 * U;
/// v1 v2 - v3 v4: each value is off by 4.2u of its magnitude, a product adds 1u, the difference 1u: at most 10.5 u of the
/// sum of the products of magnitudes, which is itself computed to 2u.
const TWO: f64 = 12.0 * U;
/// A 3x3 determinant of values: 3 times 4.2u, and five roundings (product, difference, product, two sums): at most 17.7 u of the
/// permanent of the magnitudes, which is itself computed to 5u.
const THREE: f64 = 20.0 * U;
/// A 3x3 determinant of differences of coordinates, each off by 1u of itself: 3u and five roundings make 8.1u.
const ORIENT: f64 = 10.0 * U;
/// A 3x3 determinant of input numbers: five roundings.
const NORMALS: f64 = 8.0 * U;

const LOW: f64 = f64::from_bits((1023 - 300) << 52);
const HIGH: f64 = f64::from_bits((1023 + 300) << 52);

#[inline(always)]
fn decide(v: f64, bound: f64) -> Option<Sign> {
    if v > bound {
        Some(Sign::Positive)
    } else if v < -bound {
        Some(Sign::Negative)
    } else {
        None
    }
}

/// A plane's value and its magnitude.
#[inline(always)]
pub fn value(p: &Plane, v: &[f64; 3]) -> (f64, f64) {
    let (a, b, c) = (p.n[0] * v[0], p.n[1] * v[1], p.n[2] * v[2]);
    (a + b + c + p.d, a.abs() + b.abs() + c.abs() + p.d.abs())
}

/// Needs no window: the smallest normal number covers every underflow, and an overflow makes the bound infinite or NaN.
#[inline(always)]
pub fn side(p: &Plane, v: &[f64; 3]) -> Option<Sign> {
    let (value, magnitude) = value(p, v);
    decide(value, SIDE * magnitude + f64::MIN_POSITIVE)
}

/// The static form of [`side`]: a bound for all |v[i]| <= max_abs[i].
pub fn side_bound(p: &Plane, max_abs: &[f64; 3]) -> f64 {
    let (_, magnitude) = value(p, max_abs);
    SIDE * magnitude + f64::MIN_POSITIVE
}

/// Sign of v1 v2 - v3 v4 of (value, magnitude) pairs.
#[inline(always)]
pub fn minor([v1, v2, v3, v4]: [(f64, f64); 4]) -> Option<Sign> {
    let low = v1.1.min(v2.1).min(v3.1).min(v4.1);
    let high = v1.1.max(v2.1).max(v3.1).max(v4.1);
    // `min` and `max` drop a NaN, but then the bound or the value is NaN.
    if !(low >= LOW && high <= HIGH) {
        return None;
    }
    decide(v1.0 * v2.0 - v3.0 * v4.0, TWO * (v1.1 * v2.1 + v3.1 * v4.1))
}

/// Sign of the determinant of a 3x3 matrix of (value, magnitude) pairs.
#[inline(always)]
pub fn triangle(m: &[[(f64, f64); 3]; 3]) -> Option<Sign> {
    let (mut low, mut high) = (f64::INFINITY, 0.0f64);
    for row in m {
        for x in row {
            low = low.min(x.1);
            high = high.max(x.1);
        }
    }
    if !(low >= LOW && high <= HIGH) {
        return None;
    }
    let (det, permanent) = det3(&m.map(|r| r.map(|x| x.0)), &m.map(|r| r.map(|x| x.1)));
    decide(det, THREE * permanent)
}

/// Determinant of `m`, permanent of `a`.
#[inline(always)]
fn det3(m: &[[f64; 3]; 3], a: &[[f64; 3]; 3]) -> (f64, f64) {
    let (mut det, mut permanent) = (0.0, 0.0);
    for (i, (j, k)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
        det += m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]);
        permanent += a[0][i] * (a[1][j] * a[2][k] + a[1][k] * a[2][j]);
    }
    (det, permanent)
}

/// Sign of a determinant whose nine entries are exact up to `constant`; zero entries are exact and need no window.
#[inline(always)]
fn entries(m: &[[f64; 3]; 3], constant: f64) -> Option<Sign> {
    let (mut low, mut high) = (f64::INFINITY, 0.0f64);
    for row in m {
        for x in row {
            let a = x.abs();
            low = low.min(if a == 0.0 { 1.0 } else { a });
            high = high.max(a);
        }
    }
    if !(low >= LOW && high <= HIGH) {
        return None;
    }
    let (det, permanent) = det3(m, &m.map(|r| r.map(f64::abs)));
    decide(det, constant * permanent)
}

/// Sign of det(b - a, c - a, d - a). Differences do not underflow; one that is zero is exactly zero.
#[inline(always)]
pub fn orient3d(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3], d: &[f64; 3]) -> Option<Sign> {
    entries(&[sub(b, a), sub(c, a), sub(d, a)], ORIENT)
}

/// Sign of the determinant of three input rows.
#[inline(always)]
pub fn normals(u: &[f64; 3], v: &[f64; 3], w: &[f64; 3]) -> Option<Sign> {
    entries(&[*u, *v, *w], NORMALS)
}

#[inline(always)]
fn sub(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

//! The usual case of rounding: points on edges and in triangles, by interpolation from a corner in two doubles a number, with
//! one bound at the end in place of one per operation. It answers or leaves the coordinate to [`super::round`].
//!
//! Notation: u = 2⁻⁵³; a pair (h, l) stands for h + l with |l| ≤ u|h|(1 + u) unless said otherwise. Differences of two
//! input numbers are exact pairs. Where a plane is perpendicular to an axis with a normal of length 1, so are its values: no product is
//! rounded, and the interpolation is the quotient of two differences of coordinates.
//!
//! Range: inputs below 2²⁵⁰ and denominators above 2⁻²⁵⁰, so that nothing overflows and every loss by underflow (2⁻¹⁰⁷⁴, through at most
//! two factors or divisors) is below [`LOST`], which is added to the bounds. A coordinate too small for that is left
//! open.
//!
//! Cost: some 30 ns for a point on an edge.

use super::bounded::U;
use super::double_double::{fast_two_sum, two_prod, two_sum};
use super::rows::Row;
use super::types::Plane;

const U2: f64 = U * U;
/// 2^250 and its inverse.
const LARGEST: f64 = f64::from_bits((1023 + 250) << 52);
const LEAST: f64 = f64::from_bits((1023 - 250) << 52);
/// 2^-500.
const LOST: f64 = f64::from_bits((1023 - 500) << 52);

/// Two doubles.
type Pair = (f64, f64);

#[inline(always)]
fn difference(a: f64, b: f64) -> Pair {
    two_sum(a, -b)
}

/// a b, off by at most 7 u² |a b| (the error of ah bl + al bh and of the sum; al bl is left out).
#[inline(always)]
fn product(a: Pair, b: Pair) -> Pair {
    let (p, e) = two_prod(a.0, b.0);
    fast_two_sum(p, e + (a.0 * b.1 + a.1 * b.0))
}

/// a + b, off by at most 4 u² (|a| + |b|).
#[inline(always)]
fn sum(a: Pair, b: Pair) -> Pair {
    let (s, e) = two_sum(a.0, b.0);
    two_sum(s, e + (a.1 + b.1))
}

/// a / b, off by at most 16 u² |a / b|: q = fl(ah / bh), ah − fl(q bh) is exact, and the rest r has |r| ≤ 5u|a| and four
/// roundings; what the second digit r / bh ignores of b is a factor 1 ± 2u.
#[inline(always)]
fn quotient(a: Pair, b: Pair) -> Pair {
    let q = a.0 / b.0;
    let (p, e) = two_prod(q, b.0);
    let r = ((a.0 - p) - e) + (a.1 - q * b.1);
    fast_two_sum(q, r / b.0)
}

/// The value of a plane at a point and a bound on its error.
///
/// Axis-parallel with normal ±1: exact. Otherwise the low parts, three of products and three of sums, are at most 4u S
/// together, S = Σ|nᵢxᵢ| + |d|; adding them rounds six times: 24 u² S.
#[inline(always)]
fn value(p: &Plane, unit: Option<usize>, x: &[f64; 3]) -> (Pair, f64) {
    if let Some(axis) = unit {
        return (two_sum(p.n[axis] * x[axis], p.d), 0.0);
    }
    let (a, b, c) = (two_prod(p.n[0], x[0]), two_prod(p.n[1], x[1]), two_prod(p.n[2], x[2]));
    let (s, e) = two_sum(a.0, b.0);
    let (s, f) = two_sum(s, c.0);
    let (s, g) = two_sum(s, p.d);
    let low = ((a.1 + b.1) + c.1) + ((e + f) + g);
    let size = a.0.abs() + b.0.abs() + c.0.abs() + p.d.abs();
    (two_sum(s, low), 32.0 * U2 * size)
}

/// The axis of a plane x = ±d.
#[inline(always)]
fn unit_axis(p: &Plane) -> Option<usize> {
    let [x, y, z] = p.n;
    if x.abs() == 1.0 && y == 0.0 && z == 0.0 {
        Some(0)
    } else if y.abs() == 1.0 && x == 0.0 && z == 0.0 {
        Some(1)
    } else if z.abs() == 1.0 && x == 0.0 && y == 0.0 {
        Some(2)
    } else {
        None
    }
}

/// False also for NaN.
#[inline(always)]
fn in_range(x: &[f64; 3]) -> bool {
    (x[0].abs() < LARGEST) & (x[1].abs() < LARGEST) & (x[2].abs() < LARGEST)
}

#[inline(always)]
fn plane_in_range(p: &Plane) -> bool {
    in_range(&p.n) && p.d.abs() < LARGEST
}

/// The double nearest to `from + rest`, if all numbers within `err` of it have the same; `err` covers everything but the
/// sum made here.
#[inline(always)]
fn nearest(from: f64, rest: Pair, err: f64) -> Option<f64> {
    let (s, e) = two_sum(from, rest.0);
    let low = e + rest.1;
    // |e| ≤ u|s| and |rest.1| ≤ 2u|rest.0|: the sum is off by u times that; twice more for the sums below.
    let err = err + 8.0 * U2 * (s.abs() + rest.0.abs());
    let (h, l) = two_sum(s, low);
    let (below, above) = (h + (l - err), h + (l + err));
    (below == above).then_some(below)
}

/// The coordinates of edge ∩ plane that the bounds settle, `None` for the others.
///
/// With values v, w at the ends, t = v/(v − w), and x = a + (b − a) t. The errors E_v of v and E of v − w move t by at most
/// (E_v + |t| E)/|v − w| to first order; twice that is taken, and 32 u² |t| for the quotient.
pub fn on_edge(a: &[f64; 3], b: &[f64; 3], p: &Plane, open: &[bool; 3]) -> [Option<f64>; 3] {
    if !(in_range(a) && in_range(b) && plane_in_range(p)) {
        return [None; 3];
    }
    let unit = unit_axis(p);
    let ((v, ev), (w, ew)) = (value(p, unit, a), value(p, unit, b));
    let full = match unit {
        // The plane's constant cancels: exact.
        Some(axis) => two_sum(p.n[axis] * a[axis], -(p.n[axis] * b[axis])),
        None => sum(v, (-w.0, -w.1)),
    };
    along(a, b, (v, ev), (full, ew), w, open)
}

/// The same where a function vanishes whose values at the ends are known: exactly, or as exact differences.
#[inline(always)]
pub fn between(a: &[f64; 3], b: &[f64; 3], row: &Row<'_, 2>, open: &[bool; 3]) -> [Option<f64>; 3] {
    let [v, w] = row_values(row);
    if !(in_range(a) && in_range(b) && v.0.abs() < LARGEST && w.0.abs() < LARGEST) {
        return [None; 3];
    }
    along(a, b, (v, 0.0), (sum(v, (-w.0, -w.1)), 0.0), w, open)
}

/// The values of a row: exact pairs (or infinite).
#[inline(always)]
fn row_values<const M: usize>(row: &Row<'_, M>) -> [Pair; M] {
    match row {
        Row::Values(v) => v.map(|x| (x, 0.0)),
        Row::Difference(f, g) => std::array::from_fn(|i| difference(f[i], g[i])),
        Row::Ones => [(1.0, 0.0); M],
    }
}

/// Points a + (b − a) v/(v − w); `ev`, `ew`: the errors of v and w.
#[inline(always)]
fn along(
    a: &[f64; 3],
    b: &[f64; 3],
    (v, ev): (Pair, f64),
    (full, ew): (Pair, f64),
    w: Pair,
    open: &[bool; 3],
) -> [Option<f64>; 3] {
    let mut out = [None; 3];
    let size = full.0.abs();
    // Otherwise the bounds would not be of first order.
    if !(size > LEAST && (ev + ew) < size * U) {
        return out;
    }
    let t = quotient(v, full);
    let moved = ev + ew + 8.0 * U2 * (v.0.abs() + w.0.abs());
    let err_t = 32.0 * U2 * t.0.abs() + 2.0 * (ev + t.0.abs() * moved) / size + LOST * LEAST;
    for i in 0..3 {
        if open[i] {
            let d = difference(b[i], a[i]);
            let step = product(d, t);
            out[i] = nearest(a[i], step, d.0.abs() * err_t * (1.0 + 8.0 * U) + 8.0 * U2 * step.0.abs() + LOST);
        }
    }
    out
}

/// The same for triangle ∩ two planes.
///
/// Weights w = P × Q of the planes' values at the corners; x = a + (w₁ (b − a) + w₂ (c − a)) / (w₀ + w₁ + w₂). A weight
/// PᵢQⱼ − PⱼQᵢ is off by 12 u² (|PᵢQⱼ| + |PⱼQᵢ|) and by what the values' errors do to it; the rest follows by first-order
/// propagation, twice.
pub fn in_triangle(t: &[[f64; 3]; 3], p: &Plane, q: &Plane, open: &[bool; 3]) -> [Option<f64>; 3] {
    if !(t.iter().all(in_range) && plane_in_range(p) && plane_in_range(q)) {
        return [None; 3];
    }
    let (unit_p, unit_q) = (unit_axis(p), unit_axis(q));
    let vp: [(Pair, f64); 3] = std::array::from_fn(|i| value(p, unit_p, &t[i]));
    let vq: [(Pair, f64); 3] = std::array::from_fn(|i| value(q, unit_q, &t[i]));
    weighted(t, &vp, &vq, open)
}

/// The same where two functions vanish whose values at the corners are known.
pub fn within(t: &[[f64; 3]; 3], rows: &[Row<'_, 3>; 2], open: &[bool; 3]) -> [Option<f64>; 3] {
    let [vp, vq] = [0, 1].map(|i| row_values(&rows[i]).map(|v| (v, 0.0)));
    if !(t.iter().all(in_range) && vp.iter().chain(&vq).all(|v| v.0.0.abs() < LARGEST)) {
        return [None; 3];
    }
    weighted(t, &vp, &vq, open)
}

/// From the values at the corners, with their errors.
fn weighted(t: &[[f64; 3]; 3], vp: &[(Pair, f64); 3], vq: &[(Pair, f64); 3], open: &[bool; 3]) -> [Option<f64>; 3] {
    let mut out = [None; 3];
    let weight = |i: usize, j: usize| {
        let (l, r) = (product(vp[i].0, vq[j].0), product(vp[j].0, vq[i].0));
        let moved = vp[i].1 * vq[j].0.0.abs()
            + vp[i].0.0.abs() * vq[j].1
            + vp[j].1 * vq[i].0.0.abs()
            + vp[j].0.0.abs() * vq[i].1;
        let err = 16.0 * U2 * (l.0.abs() + r.0.abs()) + 2.0 * moved + LOST * LEAST;
        (sum(l, (-r.0, -r.1)), err)
    };
    let ((w0, e0), (w1, e1), (w2, e2)) = (weight(1, 2), weight(2, 0), weight(0, 1));
    let full = sum(sum(w0, w1), w2);
    let size = full.0.abs();
    let err_full = e0 + e1 + e2 + 12.0 * U2 * (w0.0.abs() + w1.0.abs() + w2.0.abs());
    if !(size > LEAST && err_full < size * U) {
        return out;
    }
    for i in 0..3 {
        if open[i] {
            let (d, f) = (difference(t[1][i], t[0][i]), difference(t[2][i], t[0][i]));
            let (l, r) = (product(w1, d), product(w2, f));
            let err = e1 * d.0.abs() + e2 * f.0.abs() + 16.0 * U2 * (l.0.abs() + r.0.abs());
            let step = quotient(sum(l, r), full);
            let err = 2.0 * (err + err_full * step.0.abs()) / size + 32.0 * U2 * step.0.abs();
            out[i] = nearest(t[0][i], step, err + LOST);
        }
    }
    out
}

//! Turns of three points of doubles, seen along an axis: a certified `f64` filter, inlined, in front of the kernel.
//!
//! Seen along `axis` the plane's coordinates are (axis+1, axis+2) mod 3, so the turn a → b → c is the sign of that
//! component of (b−a) × (c−a).

use crate::exact::{self, Point, Sign};

/// Unit roundoff of a double.
pub const ROUNDOFF: f64 = f64::EPSILON / 2.0;
/// Below this a determinant of products may have suffered from underflow (each product by at most 2⁻¹⁰⁷⁵).
pub const TINY: f64 = 1e-280;

/// The two axes that are seen when looking along `axis`, right-handed.
#[inline(always)]
pub fn seen_along(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}

/// Sign of x₁·y₂ − x₂·y₁ where each factor is a rounded difference of two doubles; `None` if the filter cannot tell.
///
/// Each factor has relative error u = 2⁻⁵³, each product 3u + O(u²), their difference u more, so the error is below
/// (4u + O(u²))·(|x₁y₂| + |x₂y₁|); 5u leaves room for the roundings of the bound itself. Overflow makes the bound
/// infinite or the result NaN, and then no comparison holds.
#[inline(always)]
pub fn certain_turn(x1: f64, y1: f64, x2: f64, y2: f64) -> Option<Sign> {
    let (left, right) = (x1 * y2, x2 * y1);
    let det = left - right;
    let bound = 5.0 * ROUNDOFF * (left.abs() + right.abs()) + TINY;
    if det > bound {
        Some(Sign::Positive)
    } else if det < -bound {
        Some(Sign::Negative)
    } else {
        None
    }
}

/// Sign of component `axis` of (b−a) × (c−a), exactly.
#[inline]
pub fn turn(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3], axis: usize) -> Sign {
    let (u, v) = seen_along(axis);
    certain_turn(b[u] - a[u], b[v] - a[v], c[u] - a[u], c[v] - a[v])
        .unwrap_or_else(|| exact::turn_projected(&Point::Vertex(*a), &Point::Vertex(*b), &Point::Vertex(*c), u, v))
}

/// Whether three finite points lie on a line, exactly.
#[inline]
pub fn collinear(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3]) -> bool {
    let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    if certain_turn(u[0], u[1], v[0], v[1]).is_some()
        || certain_turn(u[1], u[2], v[1], v[2]).is_some()
        || certain_turn(u[2], u[0], v[2], v[0]).is_some()
    {
        return false;
    }
    exact::collinear(a, b, c)
}

/// The axis along which a triangle shows most area, in doubles: a good guess, nothing more.
#[inline]
pub fn largest_axis(t: &[[f64; 3]; 3]) -> usize {
    let u: [f64; 3] = std::array::from_fn(|i| t[1][i] - t[0][i]);
    let v: [f64; 3] = std::array::from_fn(|i| t[2][i] - t[0][i]);
    let size = |axis: usize| {
        let (i, j) = seen_along(axis);
        (u[i] * v[j] - u[j] * v[i]).abs()
    };
    let best = if size(1) > size(0) { 1 } else { 0 };
    if size(2) > size(best) { 2 } else { best }
}

/// An axis along which a triangle, known not to be degenerate, is seen with area; and how it turns there.
#[inline]
pub fn open_axis(t: &[[f64; 3]; 3]) -> (usize, Sign) {
    // The others are there for when the guess is wrong.
    let best = largest_axis(t);
    for k in 0..3 {
        let axis = (best + k) % 3;
        let sign = turn(&t[0], &t[1], &t[2], axis);
        if sign != Sign::Zero {
            return (axis, sign);
        }
    }
    (best, Sign::Zero)
}

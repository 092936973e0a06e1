//! Exact axis-parallel rays from rational points inside triangles.
//!
//! A start is a point of a triangle with integer weights, 1 : k : k² over the corners in some order: strictly inside, and for
//! growing k on a curve that lies in no line, so only finitely many k put the ray on an edge or vertex of the mesh. Such a
//! ray is refused as degenerate and the caller takes the next k.
//!
//! Every decision is a sign: first in doubles with a bound that includes the error of the rounded start, then in rational
//! numbers. Cost: a handful of flops per candidate triangle; microseconds where the filter fails.

use super::bvh::Bvh;
use super::projection::{self, ROUNDOFF, seen_along};
use crate::base::{TriangleId, VertexId};
use crate::exact::Sign;
use rug::{Integer, Rational};
use std::cell::OnceCell;

/// The point of a triangle with weights 1 : k : k², and a direction along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayStart {
    pub from: TriangleId,
    /// The corners that bear the weights 1, k, k².
    pub order: [u8; 3],
    pub k: u32,
    pub axis: usize,
    pub positive: bool,
}

/// The ray meets an edge or a vertex of the surface, or starts on another triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Degenerate;

/// A crossing of a ray with the interior of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crossing {
    pub triangle: TriangleId,
    /// The triangle's normal points the way the ray goes: the ray leaves what the triangle encloses.
    pub leaves: bool,
}

/// What rays are cast into.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    pub vertices: &'a [[f64; 3]],
    pub triangles: &'a [[VertexId; 3]],
    pub bvh: &'a Bvh,
}

/// A start with rounded coordinates, their error bounds, and exact ones once needed.
struct Origin {
    corners: [[f64; 3]; 3],
    k: u32,
    x: [f64; 3],
    err: [f64; 3],
    exact: OnceCell<[Rational; 3]>,
}

fn rational(x: f64) -> Rational {
    Rational::from_f64(x).unwrap_or_default()
}

fn sign_of(x: &Rational) -> Sign {
    match x.cmp0() {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

impl Origin {
    fn new(scene: &Scene, start: &RayStart) -> Self {
        let t = scene.triangles[start.from.at()];
        let corners = start.order.map(|i| scene.vertices[t[i as usize].at()]);
        let k = start.k as f64;
        let total = 1.0 + k + k * k;
        let weights = [1.0 / total, k / total, k * k / total];
        let mut x = [0.0; 3];
        let mut err = [0.0; 3];
        for i in 0..3 {
            // Weights below one: no overflow. At most 4 roundings in a weight, 3 in the sum; subnormals are absolute.
            let terms = [weights[0] * corners[0][i], weights[1] * corners[1][i], weights[2] * corners[2][i]];
            x[i] = terms[0] + terms[1] + terms[2];
            err[i] = 16.0 * ROUNDOFF * (terms[0].abs() + terms[1].abs() + terms[2].abs()) + 1e-300;
        }
        Self { corners, k: start.k, x, err, exact: OnceCell::new() }
    }

    fn exact(&self) -> &[Rational; 3] {
        self.exact.get_or_init(|| {
            let k = Integer::from(self.k);
            let square = Integer::from(k.square_ref());
            let total = Integer::from(&k + &square) + 1u32;
            std::array::from_fn(|i| {
                let [a, b, c] = self.corners.map(|p| rational(p[i]));
                (a + b * &k + c * &square) / &total
            })
        })
    }

    /// The turn origin → a → b seen along `axis`.
    fn turn(&self, a: &[f64; 3], b: &[f64; 3], axis: usize) -> Sign {
        let (u, v) = seen_along(axis);
        let (x1, y1, x2, y2) = (a[u] - self.x[u], a[v] - self.x[v], b[u] - self.x[u], b[v] - self.x[v]);
        let (left, right) = (x1 * y2, x2 * y1);
        let det = left - right;
        // As in `certain_turn`, plus the origin's error times the factors beside it.
        let moved =
            self.err[u] * (y1.abs() + y2.abs() + self.err[v]) + self.err[v] * (x1.abs() + x2.abs() + self.err[u]);
        let bound = 8.0 * ROUNDOFF * (left.abs() + right.abs()) + 2.0 * moved + projection::TINY;
        if det > bound {
            return Sign::Positive;
        }
        if det < -bound {
            return Sign::Negative;
        }
        let p = self.exact();
        let minus = |q: &[f64; 3], i: usize| rational(q[i]) - &p[i];
        sign_of(&(minus(a, u) * minus(b, v) - minus(b, u) * minus(a, v)))
    }

    /// Which side of a triangle's plane the origin is on.
    fn side(&self, q: &[[f64; 3]; 3]) -> Sign {
        let minus = |p: &[f64; 3], o: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| p[i] - o[i]) };
        let (e, f, d) = (minus(&q[1], &q[0]), minus(&q[2], &q[0]), minus(&self.x, &q[0]));
        let (mut det, mut magnitude, mut moved) = (0.0, 0.0, 0.0);
        for (i, (d, err)) in d.into_iter().zip(self.err).enumerate() {
            let (j, k) = seen_along(i);
            let (l, r) = (e[j] * f[k], e[k] * f[j]);
            det += (l - r) * d;
            magnitude += (l.abs() + r.abs()) * (d.abs() + err);
            moved += (l.abs() + r.abs()) * err;
        }
        // Nine roundings in each term. Underflow in a product is multiplied by a distance: refuse large ones.
        let bound = 16.0 * ROUNDOFF * magnitude + 2.0 * moved + projection::TINY;
        let sane = d[0].abs().max(d[1].abs()).max(d[2].abs()) < 1e30;
        if sane && det > bound {
            return Sign::Positive;
        }
        if sane && det < -bound {
            return Sign::Negative;
        }
        let p = self.exact();
        let q = q.map(|c| c.map(rational));
        let minus = |p: &[Rational; 3], o: &[Rational; 3]| -> [Rational; 3] {
            std::array::from_fn(|i| Rational::from(&p[i] - &o[i]))
        };
        let (e, f, d) = (minus(&q[1], &q[0]), minus(&q[2], &q[0]), minus(p, &q[0]));
        let mut det = Rational::new();
        for (i, d) in d.iter().enumerate() {
            let (j, k) = seen_along(i);
            det += (Rational::from(&e[j] * &f[k]) - Rational::from(&e[k] * &f[j])) * d;
        }
        sign_of(&det)
    }
}

impl Scene<'_> {
    fn corners(&self, t: TriangleId) -> [[f64; 3]; 3] {
        self.triangles[t.at()].map(|v| self.vertices[v.at()])
    }

    /// Appends all crossings of the ray with the triangles that `counts` admits, in no particular order.
    pub fn crossings(
        &self,
        start: &RayStart,
        counts: impl Fn(TriangleId) -> bool,
        out: &mut Vec<Crossing>,
    ) -> Result<(), Degenerate> {
        let origin = Origin::new(self, start);
        let mut degenerate = false;
        self.candidates(&origin, start, |t| {
            if degenerate || t == start.from || !counts(t) {
                return;
            }
            match cross(&origin, start, t, &self.corners(t)) {
                Ok(Some(crossing)) => out.push(crossing),
                Ok(None) => {}
                Err(Degenerate) => degenerate = true,
            }
        });
        if degenerate { Err(Degenerate) } else { Ok(()) }
    }

    /// The first crossing of the ray, whichever triangle it is with.
    pub fn first_crossing(
        &self,
        start: &RayStart,
        scratch: &mut Vec<(f64, TriangleId)>,
    ) -> Result<Option<Crossing>, Degenerate> {
        let origin = Origin::new(self, start);
        let axis = start.axis;
        let outward = if start.positive { 1.0 } else { -1.0 };
        // Nearest box first; once a hit is known, boxes that begin behind its triangle's end cannot hold a nearer one.
        scratch.clear();
        self.candidates(&origin, start, |t| {
            if t != start.from {
                let near = self.corners(t).map(|p| p[axis] * outward);
                scratch.push((near[0].min(near[1]).min(near[2]), t));
            }
        });
        scratch.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut best: Option<(Crossing, Rational, f64)> = None;
        for &(near, t) in scratch.iter() {
            if best.as_ref().is_some_and(|b| near > b.2) {
                break;
            }
            let corners = self.corners(t);
            let Some(crossing) = cross(&origin, start, t, &corners)? else { continue };
            let far = corners.iter().map(|p| p[axis] * outward).fold(f64::NEG_INFINITY, f64::max);
            let mut at = height(origin.exact(), &corners, axis);
            if !start.positive {
                at = -at;
            }
            if best.as_ref().is_none_or(|b| at < b.1) {
                best = Some((crossing, at, far));
            }
        }
        Ok(best.map(|b| b.0))
    }

    /// All crossings of the ray, each with its coordinate along the ray's axis, in the order in which the ray meets them. For few rays: in
    /// rationals.
    pub fn ordered_crossings(&self, start: &RayStart) -> Result<Vec<(Rational, Crossing)>, Degenerate> {
        let mut found = Vec::new();
        self.crossings(start, |_| true, &mut found)?;
        let origin = Origin::new(self, start);
        let mut ordered: Vec<_> =
            found.into_iter().map(|c| (height(origin.exact(), &self.corners(c.triangle), start.axis), c)).collect();
        ordered.sort_by(|a, b| {
            let order = a.0.cmp(&b.0);
            (if start.positive { order } else { order.reverse() }).then(a.1.triangle.cmp(&b.1.triangle))
        });
        Ok(ordered)
    }

    /// The exact point where a ray starts.
    pub fn start_point(&self, start: &RayStart) -> [Rational; 3] {
        Origin::new(self, start).exact().clone()
    }

    fn candidates(&self, origin: &Origin, start: &RayStart, visit: impl FnMut(TriangleId)) {
        // The bounds are rounded once more: the error bound is generous enough for that. The sum of the terms may leave
        // the range of doubles by their last bit; then nothing is known.
        let bound =
            |i: usize, err: f64, unknown: f64| if origin.x[i].is_finite() { origin.x[i] + err } else { unknown };
        let lo = std::array::from_fn(|i| bound(i, -origin.err[i], f64::NEG_INFINITY));
        let hi = std::array::from_fn(|i| bound(i, origin.err[i], f64::INFINITY));
        self.bvh.meeting_ray(&lo, &hi, start.axis, start.positive, visit);
    }
}

/// Whether the ray crosses the inside of a triangle.
fn cross(origin: &Origin, start: &RayStart, t: TriangleId, q: &[[f64; 3]; 3]) -> Result<Option<Crossing>, Degenerate> {
    let axis = start.axis;
    let mut zero = false;
    let mut turns = Sign::Zero;
    for (i, a) in q.iter().enumerate() {
        let s = origin.turn(a, &q[(i + 1) % 3], axis);
        if s == Sign::Zero {
            zero = true;
        } else if turns == Sign::Zero {
            turns = s;
        } else if turns != s {
            return Ok(None);
        }
    }
    // Seen along the ray the start is on the triangle's boundary, or the triangle is seen edge-on and the start is on its
    // line: perhaps behind or beside it, but the next start decides as well.
    if zero {
        return Err(Degenerate);
    }
    // The turns all have the sign of the normal's component along the axis. The start is before the triangle, as the ray
    // goes, when it is behind its normal and the normal points along the ray, or before and against.
    let leaves = (turns == Sign::Positive) == start.positive;
    match origin.side(q) {
        Sign::Zero => Err(Degenerate),
        Sign::Negative => Ok(leaves.then_some(Crossing { triangle: t, leaves })),
        Sign::Positive => Ok((!leaves).then_some(Crossing { triangle: t, leaves })),
    }
}

/// The coordinate along `axis` at which the line through `p` crosses the triangle's plane.
pub fn height(p: &[Rational; 3], q: &[[f64; 3]; 3], axis: usize) -> Rational {
    let (u, v) = seen_along(axis);
    let q = q.map(|c| c.map(rational));
    let minus = |i: usize, k: usize| Rational::from(&q[i][k] - &p[k]);
    let mut sum = Rational::new();
    let mut area = Rational::new();
    for (i, corner) in q.iter().enumerate() {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let turn = minus(a, u) * minus(b, v) - minus(b, u) * minus(a, v);
        sum += Rational::from(&corner[axis] * &turn);
        area += turn;
    }
    if area.is_zero() { sum } else { sum / area }
}

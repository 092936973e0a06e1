//! Bulk classification of vertices by a plane: one static bound for all vertices of a box, so that a side costs three
//! multiplications and two comparisons, and vectorises.

use super::predicates::side;
use super::static_filters::side_bound;
use super::{Plane, Sign};

/// A plane with what is known about it before any vertex is seen.
#[derive(Clone, Copy, Debug)]
pub struct PlaneFilter {
    p: Plane,
    bound: f64,
    /// For an axis-parallel normal: the axis, else 3.
    axis: usize,
    /// The double nearest to the plane's place on that axis, the sign there, and the sign above it.
    place: f64,
    at: Sign,
    above: Sign,
}

impl PlaneFilter {
    /// `max_abs`: no smaller than |v[i]| of any vertex that will be asked for.
    pub fn new(p: &Plane, max_abs: &[f64; 3]) -> Self {
        let mut f =
            Self { p: *p, bound: side_bound(p, max_abs), axis: 3, place: 0.0, at: Sign::Zero, above: Sign::Zero };
        for axis in 0..3 {
            let place = -p.d / p.n[axis];
            if p.n[(axis + 1) % 3] == 0.0 && p.n[(axis + 2) % 3] == 0.0 && place.is_finite() {
                f.axis = axis;
                f.place = place;
                let mut at = [0.0; 3];
                at[axis] = place;
                f.at = side(p, &at);
                f.above = Sign::of(p.n[axis]);
            }
        }
        f
    }

    /// Of an axis-parallel plane: the axis, the double nearest to the plane's place on it, the sign there, and the sign above.
    pub fn on_axis(&self) -> Option<(usize, f64, Sign, Sign)> {
        (self.axis < 3).then_some((self.axis, self.place, self.at, self.above))
    }

    /// The side of a vertex, or `None` where the bound does not decide (then ask [`side`]). Always known for
    /// axis-parallel planes: no double lies strictly between the plane and the double nearest to it, so
    /// comparing with that one, whose own sign is known, is exact.
    #[inline(always)]
    pub fn side(&self, v: &[f64; 3]) -> Option<Sign> {
        if self.axis < 3 {
            let x = v[self.axis];
            return Some(if x == self.place {
                self.at
            } else if x > self.place {
                self.above
            } else {
                -self.above
            });
        }
        let s = self.p.n[0] * v[0] + self.p.n[1] * v[1] + self.p.n[2] * v[2] + self.p.d;
        if s > self.bound {
            Some(Sign::Positive)
        } else if s < -self.bound {
            Some(Sign::Negative)
        } else {
            None
        }
    }

    /// The side of a vertex, exactly.
    #[inline(always)]
    pub fn exact_side(&self, v: &[f64; 3]) -> Sign {
        self.side(v).unwrap_or_else(|| side(&self.p, v))
    }
}

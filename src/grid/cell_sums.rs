//! Volume and first moments of one cut cell, in fixed point (see [`super::fixed_point`]).
//!
//! By the divergence theorem V = ∮ x n_x dA and ∫ x_i dV = ½ ∮ x_i² n_i dA; so a face in a grid plane takes part only through its
//! area, in the one integral along its axis, and only walls need work. Walls are fans from their first corner: for a
//! triangle a b c with doubled area vector N and s = a + b + c,
//!   ∫ x n_x dA = N_x s_x / 6,     ½ ∫ x² n_x dA = N_x (a² + b² + c² + s²) / 48.
//! All is relative to a corner of the cell's first wall, so that what is uncertain about tiny cells is tiny as well.
//!
//! A volume is wanted to 2⁻⁶⁵ of itself, a centroid only of its coordinates, which are larger than the box, mostly much larger. So first moments
//! are summed from whole units at first, and with the rests (`FULL`) where that proves too little.
//!
//! Bounds. δ: slack of a coordinate; P: size of the cell; T <= 2P: size of a triangle; n: number of triangles; all in units. A component of
//! N is off by at most 8Tδ from coordinates, 4 from products of rests, and 2⁻⁵⁰T per term from roundings of what is first order in
//! the rests: T k + 4 with k = 8δ + (n + 16) 2⁻⁵⁰. The bounds of V6 and M48 follow from N's and those of their factors
//! (s <= 3P, a² + b² + c² + s² <= 12P²), with the terms that are dropped; constants are rounded up. Without the rests, δ is
//! larger by 0.51, and what it does to a term N Q of M48 is bounded by what was summed: 8Tδ Q + 24Pδ |N|, and of second order 576P²δ²;
//! of both factors the low halves are dropped, which loses at most (|N| + Q) 2⁻⁶⁴ + 1.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::face_sums::PlaneArea;
use super::fixed_point::{
    Interval, LOSS, Place, Spot, Sum, TO_64, TO_128, UNITS, coordinate, high, high_of_wide, power, product, rough,
};
use super::settle::{Pair, settle};
use crate::complex::HalfFace;

/// Integrals over a cell's walls and faces relative to `origin`.
pub struct CellSums<'a> {
    frame: [&'a Interval; 3],
    /// Whole units from the box's low corner.
    origin: [i64; 4],
    /// Six times the volume, in 2⁻¹¹⁹ of a unit box's 2^exponents.
    volume: Sum,
    /// 48 times the first moments, 2⁻¹¹⁶.
    first: [Sum; 3],
    /// Without rests: sums of |N_i| and of a² + b² + c² + s² along axis i, in 2⁹⁶ and each rounded down.
    areas: [u64; 3],
    squares: [u64; 3],
    /// The bitwise or of all distances from the origin.
    reach: [u64; 4],
    triangles: f64,
    plane_volume_err: f64,
    plane_first_err: [f64; 3],
}

/// Volume, fraction, centroid.
pub type BodyValues = [f64; 5];

/// A corner, or a difference of two.
#[derive(Clone, Copy)]
struct Arm {
    at: Spot<4>,
    /// The whole units as doubles.
    rough: [f64; 3],
}

impl Arm {
    #[inline(always)]
    fn of(at: Spot<4>) -> Self {
        Self { at, rough: [at.h[0] as f64, at.h[1] as f64, at.h[2] as f64] }
    }
    /// Whole units, and the first-order part of a component of the cross product.
    #[inline(always)]
    fn cross(&self, o: &Self, i: usize) -> (i128, f64) {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let h = product(self.at.h[j], o.at.h[k]) - product(self.at.h[k], o.at.h[j]);
        let l = (self.rough[j] * o.at.l[k] + self.at.l[j] * o.rough[k])
            - (self.rough[k] * o.at.l[j] + self.at.l[k] * o.rough[j]);
        (h, l)
    }
}

#[inline(always)]
fn squares(p: &Spot<4>) -> [i128; 3] {
    std::array::from_fn(|i| product(p.h[i], p.h[i]))
}

impl<'a> CellSums<'a> {
    pub fn new(frame: [&'a Interval; 3], origin: [i64; 4]) -> Self {
        Self {
            frame,
            origin,
            volume: Sum::default(),
            first: [Sum::default(); 3],
            areas: [0; 3],
            squares: [0; 3],
            reach: [1; 4],
            triangles: 0.0,
            plane_volume_err: 0.0,
            plane_first_err: [0.0; 3],
        }
    }

    /// A wall of the cell.
    #[inline(always)]
    pub fn wall<const FULL: bool>(&mut self, corners: &[Spot<4>]) {
        let (origin, mut reach) = (self.origin, self.reach);
        let mut relative = |p: &Spot<4>| {
            let mut p = *p;
            for i in 0..4 {
                p.h[i] -= origin[i];
                reach[i] |= p.h[i].unsigned_abs();
            }
            p
        };
        let a = relative(&corners[0]);
        let minus_a = |p: &Spot<4>| {
            Arm::of(Spot { h: std::array::from_fn(|i| p.h[i] - a.h[i]), l: std::array::from_fn(|i| p.l[i] - a.l[i]) })
        };
        let mut b = relative(&corners[1]);
        let mut u = minus_a(&b);
        let (of_a, mut of_b) = (squares(&a), squares(&b));
        for c in &corners[2..] {
            let c = relative(c);
            let v = minus_a(&c);
            let of_c = squares(&c);
            for i in 0..3 {
                let (n, nl) = u.cross(&v, i);
                let s = a.h[i] + b.h[i] + c.h[i];
                let sl = a.l[i] + b.l[i] + c.l[i];
                let size = rough(n);
                if i == 0 {
                    self.volume.add(high(n, s), (nl * s as f64 + size * sl) * TO_64);
                }
                let q = of_a[i] + of_b[i] + of_c[i] + product(s, s);
                if FULL {
                    let rest = |p: &Spot<4>| p.h[i] as f64 * p.l[i];
                    let ql = 2.0 * (rest(&a) + rest(&b) + rest(&c) + s as f64 * sl);
                    self.first[i].add(high_of_wide(n, q), (nl * rough(q) + size * ql) * TO_128);
                } else {
                    let (n, q) = ((n >> 64) as i64, (q >> 64) as i64);
                    self.first[i].h = self.first[i].h.wrapping_add(product(n, q));
                    self.areas[i] += n.unsigned_abs() >> 32;
                    self.squares[i] += q as u64 >> 32;
                }
            }
            (b, u, of_b) = (c, v, of_c);
        }
        self.reach = reach;
        self.triangles += (corners.len() - 2) as f64;
    }

    /// A face in a grid plane, on the cell's high or low side along an axis.
    #[inline(always)]
    pub fn plane<const FULL: bool>(&mut self, area: &PlaneArea, axis: usize, high_side: bool) {
        let (d, err) = (area.doubled(), area.err as f64);
        // Distance of the plane from the origin, along its normal out of the cell.
        let (x, xl) = if high_side {
            (self.frame[axis].length.h - self.origin[axis], self.frame[axis].length.l)
        } else {
            (self.origin[axis], 0.0)
        };
        let size = rough(d);
        let xf = x as f64;
        if axis == 0 {
            self.volume.add(high(d, 3 * x), size * 3.0 * xl * TO_64);
            self.plane_volume_err += (err * 3.0 * xf.abs() + size * power(-40)) * TO_64 + 4.0;
        }
        let q = product(x, x) * if high_side { 12 } else { -12 };
        let (l, least) = (24.0 * xf * xl * size * TO_128, size * (xf.abs() * power(-37) + 12.0));
        let mut err = (err * 12.0 * xf * xf + least) * TO_128 + 14.0;
        let h = if FULL {
            high_of_wide(d, q)
        } else {
            err += (12.0 * xf * xf + size) * TO_64 + 6.0;
            product((d >> 64) as i64, (q >> 64) as i64)
        };
        self.first[axis].add(h, if high_side { l } else { -l });
        self.plane_first_err[axis] += err;
    }

    /// δ, P, n, k of the bounds; P is rounded up to a power of two less one.
    #[inline(always)]
    fn sizes(&self) -> (f64, f64, f64) {
        let reach = self.reach[0] | self.reach[1] | self.reach[2];
        let reach = (u64::MAX >> reach.leading_zeros()) as f64;
        let slack = self.frame[0].slack.max(self.frame[1].slack).max(self.frame[2].slack);
        (reach, self.triangles, 8.0 * slack + (self.triangles + 16.0) * power(-50))
    }

    /// Volume, volume fraction and centroid; `None` for what is undecided.
    #[inline(always)]
    pub fn values<const FULL: bool, const FUSED: bool>(&self) -> Option<BodyValues> {
        let (p, n, k) = self.sizes();
        let volume_err = n * ((20.0 * p * k + 24.0) * p * TO_64 + 4.0) + self.plane_volume_err;
        let v = self.volume.pair();
        let volume_err = volume_err + v.hi.abs() * LOSS;
        let [x, y, z] = self.frame;
        // A sixth: 1/6 as a pair.
        let sixth = Pair { hi: 1.0 / 6.0, lo: 1.0 / 108086391056891904.0 };
        let whole = v.times_as::<FUSED>(sixth);
        let scale = power(x.exponent + y.exponent + z.exponent - 119);
        let volume = settle(whole.scaled(scale), volume_err * scale)?;
        let size = x.size.times_as::<FUSED>(y.size).times_as::<FUSED>(z.size);
        let scale = power(-119);
        let part = whole.scaled(scale).over_as::<FUSED>(size, x.inverse * y.inverse * z.inverse);
        let err = volume_err * scale / size.hi + part.hi * LOSS;
        let fraction = settle(part, err)?;
        let mut out = [volume, fraction, 0.0, 0.0, 0.0];
        let least = v.hi.abs() - volume_err;
        // Also false for NaN.
        let certain = least > v.hi.abs() * 0.5;
        if !certain {
            return None;
        }
        let inverse = 1.0 / v.hi;
        for i in 0..3 {
            let m = self.first[i].pair();
            let err = if FULL {
                n * ((100.0 * p * k + 200.0) * p * p * TO_128 + 6.0)
            } else {
                let part = power(96);
                let (areas, squares) = ((self.areas[i] as f64 + n) * part, (self.squares[i] as f64 + n) * part);
                // Triangles are within the box.
                let (size, delta) = (f64::min(2.0 * p, UNITS), 0.52 + k);
                let first_order = delta * (8.0 * size * squares + 24.0 * p * areas);
                let second_order = n * 600.0 * (delta * p) * (delta * p);
                (first_order + second_order) * TO_128 + (areas + squares) * TO_64 + n * 8.0
            };
            let err = err + self.plane_first_err[i];
            let err = err + m.hi.abs() * LOSS;
            let q = m.over_as::<FUSED>(v, inverse);
            let err = (err + q.hi.abs() * volume_err) / least + q.hi.abs() * LOSS;
            out[2 + i] = coordinate(self.frame[i], Place { h: self.origin[i], l: 0.0 }, q, err)?;
        }
        Some(out)
    }
}

/// Which side of a cell a half-face in a grid plane is on: its normal points along the axis, so the back is on the lower
/// side, and the face is the cell's high side.
#[inline(always)]
pub fn on_high_side(h: HalfFace) -> bool {
    !h.front()
}

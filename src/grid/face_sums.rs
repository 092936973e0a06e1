//! Areas and centroids of faces in grid planes, in fixed point (see [`super::fixed_point`]).
//!
//! The area is half the sum of p × q over a face's sides p q, the first moment a sixth of the sum of (p × q)(p + q), all relative to
//! the face's first corner. Bounds: as in [`super::cell_sums`]. Cost: some 20 ns per side, and 100 ns per face.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::fixed_point::{Interval, LOSS, Place, Spot, Sum, TO_64, coordinate, high, power, product, rough};
use super::settle::{Pair, settle};

/// The area of a face in a grid plane, doubled, in units of its square, and its bound.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneArea {
    /// The low and high half of a 128-bit number: one of those would cost another eight bytes per face.
    doubled: [u64; 2],
    pub err: f32,
}

impl PlaneArea {
    pub fn new(doubled: i128, err: f64) -> Self {
        // Rounded up.
        Self { doubled: [doubled as u64, (doubled >> 64) as u64], err: (err * 1.0001) as f32 }
    }
    #[inline(always)]
    pub fn doubled(&self) -> i128 {
        (self.doubled[1] as i64 as i128) << 64 | self.doubled[0] as i128
    }
}

/// The area of a whole square.
pub fn whole_square(b: &Interval, c: &Interval) -> PlaneArea {
    let (x, y) = (b.length, c.length);
    let rest = x.h as f64 * y.l + x.l * y.h as f64;
    PlaneArea::new(2 * (x.h as i128 * y.h as i128 + rest.round_ties_even() as i128), 4096.0)
}

/// Area and centroid of a face in a grid plane, all loops relative to its first corner, from its corners' places along the two axes
/// that follow its own, and the offsets of its loops. Returns the area for the cells, and area, fraction and centroid if they are decided.
///
/// Bounds as for cells, with edges in place of triangles; T: the size of the face.
#[inline(always)]
pub fn plane_face<const FUSED: bool>(
    spots: &[Spot<2>],
    loops: &[u32],
    frames: [&Interval; 2],
) -> (PlaneArea, Option<[f64; 4]>) {
    let [fb, fc] = frames;
    let mut sum = Sum::default();
    let mut first = [Sum::default(); 2];
    let mut reach = 1u64;
    let mut count = 0.0;
    let o = spots[0];
    let relative = |p: &Spot<2>| -> [Place; 2] {
        std::array::from_fn(|i| Place { h: p.h[i].wrapping_sub(o.h[i]), l: p.l[i] - o.l[i] })
    };
    for (l, w) in loops.windows(2).enumerate() {
        let corners = &spots[(w[0] - loops[0]) as usize..(w[1] - loops[0]) as usize];
        if corners.len() < 2 {
            continue;
        }
        // Sides at the origin itself contribute nothing.
        let (p, from) = if l == 0 { (&corners[1], 2) } else { (&corners[corners.len() - 1], 0) };
        let mut p = relative(p);
        reach |= p[0].h.unsigned_abs() | p[1].h.unsigned_abs();
        for q in &corners[from..] {
            let q = relative(q);
            reach |= q[0].h.unsigned_abs() | q[1].h.unsigned_abs();
            count += 1.0;
            let w = product(p[0].h, q[1].h) - product(p[1].h, q[0].h);
            let wl =
                (p[0].h as f64 * q[1].l + p[0].l * q[1].h as f64) - (p[1].h as f64 * q[0].l + p[1].l * q[0].h as f64);
            sum.add(w, wl);
            let size = rough(w);
            for i in 0..2 {
                let s = p[i].h + q[i].h;
                first[i].add(high(w, s), (wl * s as f64 + size * (p[i].l + q[i].l)) * TO_64);
            }
            p = q;
        }
    }
    let t = (u64::MAX >> reach.leading_zeros()) as f64;
    let slack = fb.slack.max(fc.slack);
    let k = 8.0 * slack + (count + 16.0) * power(-50);
    let err = count * (t * k + 4.0);
    let rounded = sum.l.round_ties_even();
    let area = PlaneArea::new(sum.h.wrapping_add(rounded as i128), err + 1.0);
    let found = FaceSums { sum, first, err, t, k, count, origin: [0, 1].map(|i| Place { h: o.h[i], l: o.l[i] }) };
    (area, found.values::<FUSED>(frames))
}

/// What is summed over a face, and what its bounds need.
struct FaceSums {
    sum: Sum,
    first: [Sum; 2],
    err: f64,
    t: f64,
    k: f64,
    count: f64,
    origin: [Place; 2],
}

impl FaceSums {
    #[inline(always)]
    fn values<const FUSED: bool>(&self, frames: [&Interval; 2]) -> Option<[f64; 4]> {
        let Self { sum, first, err, t, k, count, origin } = *self;
        let [fb, fc] = frames;
        let d = sum.pair();
        let d_err = err + d.hi.abs() * LOSS;
        let least = d.hi.abs() - d_err;
        // Also false for NaN.
        let certain = least > d.hi.abs() * 0.5;
        if !certain {
            return None;
        }
        let scale = power(fb.exponent + fc.exponent - 123);
        let value = settle(d.scaled(scale), d_err * scale)?;
        let size = fb.size.times_as::<FUSED>(fc.size);
        let part = d.scaled(power(-123)).over_as::<FUSED>(size, fb.inverse * fc.inverse);
        let fraction = settle(part, d_err * power(-123) / size.hi + part.hi.abs() * LOSS)?;
        let first_err = count * (t * (6.0 * t * k + 24.0) * TO_64 + 6.0);
        let inverse = 1.0 / d.hi;
        let mut out = [value, fraction, 0.0, 0.0];
        for i in 0..2 {
            let m = first[i].pair();
            let q = m.over_as::<FUSED>(d, inverse);
            let q_err = (first_err + m.hi.abs() * LOSS + q.hi.abs() * d_err) / least + q.hi.abs() * LOSS;
            let third = Pair { hi: 8.0 / 3.0, lo: 1.0 / 6755399441055744.0 };
            out[2 + i] = coordinate(frames[i], origin[i], q.times_as::<FUSED>(third), q_err * 3.0)?;
        }
        Some(out)
    }
}

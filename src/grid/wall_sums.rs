//! Area vectors and centroids of walls, in fixed point (see [`super::fixed_point`]; bounds as in [`super::cell_sums`]).
//!
//! Walls are fans from their first corner, relative to a corner of the first wall. Their areas: |A| = A_i·|n|/|n_i| for the axis i along
//! which the triangle's normal is largest; the ratio is a property of the input triangle ([`Normal`]), so no square root is taken per wall.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::fixed_point::{Interval, LOSS, Place, Spot, Sum, TO_64, coordinate, high, power, product, rough};
use super::settle::{Pair, settle, two_sum};
use crate::base::TriangleId;
use crate::exact::{Point, Sign, turn_projected};
use crate::mesh::TriMesh;

/// The direction of an input triangle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Normal {
    /// |n| / |n_axis| = root + rest, off by at most 2⁻⁷⁴ of it; root is 0 if that is not known.
    pub root: f64,
    pub rest: f32,
    /// Bits 0..3: that component is zero, exactly. Bits 3..5: the axis along which it is largest. Bit 5: it is negative there.
    pub code: u8,
}

impl Normal {
    #[inline(always)]
    pub fn zero(self, axis: usize) -> bool {
        self.code >> axis & 1 != 0
    }
    #[inline(always)]
    pub fn axis(self) -> usize {
        (self.code >> 3 & 3) as usize
    }
    #[inline(always)]
    pub fn negative(self) -> bool {
        self.code & 32 != 0
    }

    /// Cost: some 50 ns.
    pub fn of(mesh: &TriMesh, t: TriangleId) -> Self {
        let corners = mesh.corners(t);
        let [a, b, c] = corners;
        let u: [Pair; 3] = std::array::from_fn(|i| two_sum(b[i], -a[i]));
        let v: [Pair; 3] = std::array::from_fn(|i| two_sum(c[i], -a[i]));
        let (mut n, mut size) = ([Pair::default(); 3], 0.0);
        let mut normal = Self::default();
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (p, q) = (u[j].times(v[k]), u[k].times(v[j]));
            n[i] = p.plus(Pair { hi: -q.hi, lo: -q.lo });
            let terms = p.hi.abs() + q.hi.abs();
            // Products that may have underflowed prove nothing.
            if !(n[i].hi.abs() > terms * power(-95) && n[i].hi.abs() > power(-900)) {
                let [a, b, c] = corners.map(Point::Vertex);
                if turn_projected(&a, &b, &c, j, k) == Sign::Zero {
                    n[i] = Pair::default();
                    normal.code |= 1 << i;
                    continue;
                }
            }
            size = f64::max(size, terms);
        }
        let axis = (0..3).fold(0, |best, i| if n[i].hi.abs() > n[best].hi.abs() { i } else { best });
        normal.code |= (axis as u8) << 3 | ((n[axis].hi < 0.0) as u8) << 5;
        let largest = n[axis].hi.abs();
        let inverse = 1.0 / n[axis].hi;
        // Each component is off by at most 2⁻⁹⁷ of `size`.
        if !(largest > size * power(-20) && largest > power(-400) && largest < power(400)) {
            return normal;
        }
        let mut square = Pair::of(1.0);
        for i in 0..3 {
            if i != axis && !normal.zero(i) {
                let q = n[i].over(n[axis], inverse);
                square = square.plus(q.times(q));
            }
        }
        let root = square.hi.sqrt();
        let (p, e) = crate::exact::double_double::two_prod(root, root);
        normal.root = root;
        normal.rest = ((((square.hi - p) - e) + square.lo) / (2.0 * root)) as f32;
        normal
    }
}

/// Integrals over some walls relative to `origin`.
pub struct WallSums<'a> {
    frame: [&'a Interval; 3],
    /// Whole units from the box's low corner.
    origin: [i64; 3],
    /// Doubled area vector, 2⁻¹²² of a unit box's 2^exponents; not counting components that are zero.
    area: [Sum; 3],
    nonzero: [bool; 3],
    /// Closure: what the faces in grid planes leave open along each axis, in whole squares, high less low; and whether there
    /// are others than whole ones. Zero and no others: the walls' area along that axis is exactly zero.
    squares: [i32; 3],
    others: [bool; 3],
    /// Doubled wall area, 2⁻¹²² of the largest product of two units, and six times its first moments, 2⁻¹¹⁹.
    wall: Sum,
    wall_total: f64,
    wall_first: [Sum; 3],
    shift: [u32; 3],
    ratios_known: bool,
    /// The bitwise or of all distances from the origin.
    reach: u64,
    triangles: f64,
}

/// Area vector, centroid.
pub type WallValues = [f64; 6];

impl<'a> WallSums<'a> {
    pub fn new(frame: [&'a Interval; 3], origin: &Spot<4>) -> Self {
        let e = frame.map(|x| x.exponent);
        let products = [e[1] + e[2], e[2] + e[0], e[0] + e[1]];
        let most = products[0].max(products[1]).max(products[2]);
        Self {
            frame,
            origin: [origin.h[0], origin.h[1], origin.h[2]],
            area: [Sum::default(); 3],
            nonzero: [false; 3],
            squares: [0; 3],
            others: [false; 3],
            wall: Sum::default(),
            wall_total: 0.0,
            wall_first: [Sum::default(); 3],
            shift: products.map(|p| ((most - p) as u32).min(127)),
            ratios_known: true,
            reach: 1,
            triangles: 0.0,
        }
    }

    /// A wall of the cell.
    #[inline(always)]
    pub fn wall(&mut self, corners: &[Spot<4>], normal: Normal) {
        let mut place = |p: &Spot<4>| -> [Place; 3] {
            std::array::from_fn(|i| {
                let h = p.h[i] - self.origin[i];
                self.reach |= h.unsigned_abs();
                Place { h, l: p.l[i] }
            })
        };
        let a = place(&corners[0]);
        let mut b = place(&corners[1]);
        self.ratios_known &= normal.root != 0.0;
        for c in &corners[2..] {
            let c = place(c);
            self.triangles += 1.0;
            let n = doubled_area(&a, &b, &c, normal);
            let s: [i64; 3] = std::array::from_fn(|i| a[i].h + b[i].h + c[i].h);
            let sl: [f64; 3] = std::array::from_fn(|i| a[i].l + b[i].l + c[i].l);
            for i in 0..3 {
                if normal.zero(i) {
                    continue;
                }
                self.nonzero[i] = true;
                self.area[i].add(n[i].h, n[i].l);
            }
            // The wall's area from its largest component, turned so that it is positive.
            let axis = normal.axis();
            let flip = if normal.negative() { -1 } else { 1 };
            let w = (n[axis].h * flip) >> self.shift[axis];
            // The root is a whole multiple of 2⁻⁶², and below 2.
            let whole = (normal.root * (1u64 << 62) as f64) as i64;
            let down = power(-(self.shift[axis] as i32)) * flip as f64;
            let wl = (n[axis].l * normal.root + rough(n[axis].h) * normal.rest as f64) * down;
            let w = high(w, whole).wrapping_mul(4);
            self.wall.add(w, wl);
            let size = rough(w);
            self.wall_total += size.abs();
            for i in 0..3 {
                self.wall_first[i].add(high(w, s[i]), (wl * s[i] as f64 + size * sl[i]) * TO_64);
            }
            b = c;
        }
    }

    /// A face in a grid plane, on the cell's high or low side along an axis; `whole`: the whole square.
    pub fn plane(&mut self, axis: usize, high_side: bool, whole: bool) {
        self.squares[axis] += whole as i32 * if high_side { 1 } else { -1 };
        self.others[axis] |= !whole;
    }

    /// δ, P, n, k of the bounds; P is rounded up to a power of two less one.
    #[inline(always)]
    fn sizes(&self) -> (f64, f64, f64) {
        let reach = (u64::MAX >> self.reach.leading_zeros()) as f64;
        let slack = self.frame[0].slack.max(self.frame[1].slack).max(self.frame[2].slack);
        (reach, self.triangles, 8.0 * slack + (self.triangles + 16.0) * power(-50))
    }

    /// Area vector and centroid of the walls. Zero components are known from the triangles; with `all` the faces of the cell
    /// taken, also from those in grid planes.
    #[inline(always)]
    pub fn values<const FUSED: bool>(&self, all: bool) -> Option<WallValues> {
        let (p, n, k) = self.sizes();
        let mut out = [0.0; 6];
        let err = n * (2.0 * p * k + 4.0);
        for i in 0..3 {
            if self.nonzero[i] && !(all && self.squares[i] == 0 && !self.others[i]) {
                let a = self.area[i].pair();
                let (j, m) = ((i + 1) % 3, (i + 2) % 3);
                let scale = power(self.frame[j].exponent + self.frame[m].exponent - 123);
                out[i] = settle(a.scaled(scale), (err + a.hi.abs() * LOSS) * scale)?;
            }
        }
        if !self.ratios_known {
            return None;
        }
        // Twice a component's bound, for the ratio below 2; the shift and the products' ends; and the ratio's own error.
        let each = 4.0 * p * k + 24.0;
        let ratios = self.wall_total * power(-73);
        let w = self.wall.pair();
        let w_err = n * each + ratios + w.hi.abs() * LOSS;
        // s <= 3P; a ratio times N below 16P², times s's slack and the terms dropped.
        let first_err = n * ((3.0 * p * each + 16.0 * p * p * k + 64.0 * p) * TO_64 + 8.0) + 3.0 * p * ratios * TO_64;
        let least = w.hi.abs() - w_err;
        // Also false for NaN.
        let certain = least > w.hi.abs() * 0.5;
        if !certain {
            return None;
        }
        let inverse = 1.0 / w.hi;
        for i in 0..3 {
            let m = self.wall_first[i].pair();
            let q = m.over_as::<FUSED>(w, inverse);
            let err = (first_err + m.hi.abs() * LOSS + q.hi.abs() * w_err) / least + q.hi.abs() * LOSS;
            // Six times the moment over twice the area, and 2⁻¹¹⁹ over 2⁻¹²².
            let third = Pair { hi: 8.0 / 3.0, lo: 1.0 / 6755399441055744.0 };
            out[3 + i] =
                coordinate(self.frame[i], Place { h: self.origin[i], l: 0.0 }, q.times_as::<FUSED>(third), err * 3.0)?;
        }
        Some(out)
    }
}

/// The doubled area vector of a triangle, zero where the whole input triangle's is.
#[inline(always)]
fn doubled_area(a: &[Place; 3], b: &[Place; 3], c: &[Place; 3], normal: Normal) -> [Sum; 3] {
    let minus =
        |p: &[Place; 3]| -> [Place; 3] { std::array::from_fn(|i| Place { h: p[i].h - a[i].h, l: p[i].l - a[i].l }) };
    let (u, v) = (minus(b), minus(c));
    let mut out = [Sum::default(); 3];
    for i in 0..3 {
        if !normal.zero(i) {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            out[i] = Sum {
                h: product(u[j].h, v[k].h) - product(u[k].h, v[j].h),
                l: (u[j].h as f64 * v[k].l + u[j].l * v[k].h as f64)
                    - (u[k].h as f64 * v[j].l + u[k].l * v[j].h as f64),
            };
        }
    }
    out
}

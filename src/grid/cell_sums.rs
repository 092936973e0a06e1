//! The integrals over the surface of one cut cell, in fixed point (see [`super::fixed_point`]).
//!
//! By the divergence theorem V = ∮ x n_x dA and ∫ x_i dV = ½ ∮ x_i² n_i dA; so a face in a grid plane takes part only through its
//! area, in the one integral along its axis, and only walls need work. Walls are fans from their first corner: for a
//! triangle a b c with doubled area vector N and s = a + b + c,
//!   ∫ x n_x dA = N_x s_x / 6,     ½ ∫ x² n_x dA = N_x (a² + b² + c² + s²) / 48.
//! All is relative to a corner of the cell's first wall, so that what is uncertain about tiny cells is tiny as well.
//!
//! Wall areas: |A| = A_i·|n|/|n_i| for the axis i along which the triangle's normal is largest; the ratio is a property of the
//! input triangle ([`Normal`]), so no square root is taken per wall.
//!
//! Bounds. δ: slack of a coordinate; P: size of the cell; T <= 2P: size of a triangle; n: number of triangles; all in units. A component of
//! N is off by at most 8Tδ from coordinates, 4 from products of rests, and 2⁻⁵⁰T per term from roundings of what is first order in
//! the rests: T k + 4 with k = 8δ + (n + 16) 2⁻⁵⁰. The bounds of V6 and M48 follow from N's and those of their factors
//! (s <= 3P, a² + b² + c² + s² <= 12P²), with the terms that are dropped; constants are rounded up.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::data::GridCells;
use super::fixed_point::{Interval, Place, UNITS, high, high_of_wide, pair, power, product, rough};
use super::settle::{Pair, settle, two_sum};
use crate::base::{FaceId, TriangleId, VertexId};
use crate::complex::HalfFace;
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

/// Coordinates and residual of a vertex. Without a branch on its kind: that would be mispredicted half the time, and then the
/// look-ups that follow wait.
#[inline(always)]
pub fn position(g: &GridCells, v: VertexId) -> ([f64; 3], [f64; 3]) {
    let i = v.0.wrapping_sub(g.constructed.start) as usize;
    let there = i < g.residuals.len();
    let r = g.residuals.get(if there { i } else { 0 }).copied().unwrap_or_default();
    let weight = f64::from(there as u8);
    (g.coords[v.at()], r.map(|r| r * weight))
}

/// The walls of some boxes with their corners' places, gathered before anything is computed: the arrays they come from are in
/// another order, so that each look-up is likely to miss the cache; in loops of nothing else, the misses overlap.
#[derive(Default)]
pub struct Gathered {
    /// Wall `w` has corners `offsets[w]..offsets[w + 1]`.
    pub normals: Vec<Normal>,
    pub offsets: Vec<u32>,
    pub places: Vec<[Place; 3]>,
    vertices: Vec<VertexId>,
    starts: Vec<[u32; 2]>,
    triangles: Vec<TriangleId>,
}

impl Gathered {
    pub fn clear(&mut self) {
        self.normals.clear();
        self.offsets.clear();
        self.offsets.push(0);
        self.places.clear();
        self.vertices.clear();
        self.starts.clear();
        self.triangles.clear();
    }
    /// The number of walls that are there.
    pub fn len(&self) -> usize {
        self.starts.len()
    }
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }
    /// Takes a wall, which has one loop, so that loop and face have the same number.
    #[inline(always)]
    pub fn push(&mut self, g: &GridCells, f: FaceId) {
        self.starts.push([g.loop_offsets[f.at()], g.loop_offsets[f.at() + 1]]);
        self.triangles.push(g.wall_triangle[f.at()]);
    }
    /// To be called when all walls are there, before [`place`](Self::place).
    pub fn corners(&mut self, g: &GridCells, normals: &[Normal]) {
        for &[from, to] in &self.starts {
            self.vertices.extend_from_slice(&g.corners[from as usize..to as usize]);
            self.offsets.push(self.vertices.len() as u32);
        }
        self.normals.extend(self.triangles.iter().map(|t| normals[t.at()]));
    }
    /// Places of the next walls, up to wall `end`, in a box.
    pub fn place(&mut self, g: &GridCells, frame: &[&Interval; 3], end: usize) {
        let vertices = &self.vertices[self.places.len()..self.offsets[end] as usize];
        self.places.extend(vertices.iter().map(|&v| {
            let (x, r) = position(g, v);
            std::array::from_fn(|i| frame[i].place(x[i], r[i]))
        }));
    }
    #[inline(always)]
    pub fn wall(&self, w: usize) -> (&[[Place; 3]], Normal) {
        (&self.places[self.offsets[w] as usize..self.offsets[w + 1] as usize], self.normals[w])
    }
}

/// A sum in fixed point: whole units, and the first-order part.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    h: i128,
    l: f64,
}

impl Sum {
    #[inline(always)]
    fn add(&mut self, h: i128, l: f64) {
        self.h = self.h.wrapping_add(h);
        self.l += l;
    }
    #[inline(always)]
    fn pair(self) -> Pair {
        pair(self.h, self.l)
    }
}

/// The area of a face in a grid plane, doubled, in units of its square, and its bound.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneArea {
    /// The low and high half of a 128-bit number: one of those would cost another eight bytes per face.
    doubled: [u64; 2],
    err: f32,
    /// The whole square.
    whole: bool,
}

impl PlaneArea {
    pub fn new(doubled: i128, err: f64, whole: bool) -> Self {
        // Rounded up.
        Self { doubled: [doubled as u64, (doubled >> 64) as u64], err: (err * 1.0001) as f32, whole }
    }
    #[inline(always)]
    fn doubled(&self) -> i128 {
        (self.doubled[1] as i64 as i128) << 64 | self.doubled[0] as i128
    }
}

/// Integrals over a cell's walls and faces relative to `origin`.
pub struct CellSums<'a> {
    frame: [&'a Interval; 3],
    /// Whole units from the box's low corner.
    origin: [i64; 3],
    /// Six times the volume, in 2⁻¹¹⁹ of a unit box's 2^exponents.
    volume: Sum,
    /// 48 times the first moments, 2⁻¹¹⁶.
    first: [Sum; 3],
    /// Doubled area vector, 2⁻¹²²; not counting components that are zero.
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
    plane_volume_err: f64,
    plane_first_err: [f64; 3],
}

/// Volume, fraction, centroid.
pub type BodyValues = [f64; 5];
/// Area vector, centroid.
pub type WallValues = [f64; 6];

const TO_64: f64 = 1.0 / 18446744073709551616.0;
const TO_128: f64 = TO_64 * TO_64;
/// What pairs lose, with room.
const LOSS: f64 = f64::from_bits((1023 - 96) << 52);

impl<'a> CellSums<'a> {
    pub fn new(frame: [&'a Interval; 3], origin: [Place; 3]) -> Self {
        let e = frame.map(|x| x.exponent);
        let products = [e[1] + e[2], e[2] + e[0], e[0] + e[1]];
        let most = products[0].max(products[1]).max(products[2]);
        Self {
            frame,
            origin: origin.map(|p| p.h),
            volume: Sum::default(),
            first: [Sum::default(); 3],
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
            plane_volume_err: 0.0,
            plane_first_err: [0.0; 3],
        }
    }

    /// A wall of the cell. `BODY`: volume and first moments are wanted too.
    #[inline(always)]
    pub fn wall<const BODY: bool>(&mut self, (corners, normal): (&[[Place; 3]], Normal)) {
        let mut place = |p: &[Place; 3]| {
            let mut p = *p;
            for i in 0..3 {
                p[i].h -= self.origin[i];
                self.reach |= p[i].h.unsigned_abs();
            }
            p
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
                if BODY {
                    let size = rough(n[i].h);
                    if i == 0 {
                        self.volume.add(high(n[0].h, s[0]), (n[0].l * s[0] as f64 + size * sl[0]) * TO_64);
                    }
                    let q = product(a[i].h, a[i].h)
                        + product(b[i].h, b[i].h)
                        + product(c[i].h, c[i].h)
                        + product(s[i], s[i]);
                    let ql = 2.0
                        * (a[i].h as f64 * a[i].l
                            + b[i].h as f64 * b[i].l
                            + c[i].h as f64 * c[i].l
                            + s[i] as f64 * sl[i]);
                    self.first[i].add(high_of_wide(n[i].h, q), (n[i].l * rough(q) + size * ql) * TO_128);
                }
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

    /// A face in a grid plane, on the cell's high or low side along an axis.
    #[inline(always)]
    pub fn plane(&mut self, area: &PlaneArea, axis: usize, high_side: bool) {
        let (d, err) = (area.doubled(), area.err as f64);
        self.squares[axis] += area.whole as i32 * if high_side { 1 } else { -1 };
        self.others[axis] |= !area.whole;
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
        let sign = if high_side { 12 } else { -12 };
        let l = sign as f64 * 2.0 * xf * xl * size * TO_128;
        self.first[axis].add(high_of_wide(d, product(x, x) * sign), l);
        self.plane_first_err[axis] += (err * 12.0 * xf * xf + size * (xf.abs() * power(-37) + 12.0)) * TO_128 + 14.0;
    }

    /// δ, P, n, k of the bounds; P is rounded up to a power of two less one.
    #[inline(always)]
    fn sizes(&self) -> (f64, f64, f64) {
        let reach = (u64::MAX >> self.reach.leading_zeros()) as f64;
        let slack = self.frame[0].slack.max(self.frame[1].slack).max(self.frame[2].slack);
        (reach, self.triangles, 8.0 * slack + (self.triangles + 16.0) * power(-50))
    }

    /// Volume, volume fraction and centroid; `None` for what is undecided.
    #[inline(always)]
    pub fn body(&self) -> Option<BodyValues> {
        let (p, n, k) = self.sizes();
        let volume_err = n * ((20.0 * p * k + 24.0) * p * TO_64 + 4.0) + self.plane_volume_err;
        let v = self.volume.pair();
        let volume_err = volume_err + v.hi.abs() * LOSS;
        let [x, y, z] = self.frame;
        // A sixth: 1/6 as a pair.
        let sixth = Pair { hi: 1.0 / 6.0, lo: 1.0 / 108086391056891904.0 };
        let whole = v.times(sixth);
        let scale = power(x.exponent + y.exponent + z.exponent - 119);
        let volume = settle(whole.scaled(scale), volume_err * scale)?;
        let size = x.size.times(y.size).times(z.size);
        let scale = power(-119);
        let part = whole.scaled(scale).over(size, 1.0 / size.hi);
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
            let err = n * ((100.0 * p * k + 200.0) * p * p * TO_128 + 6.0) + self.plane_first_err[i];
            let err = err + m.hi.abs() * LOSS;
            let q = m.over(v, inverse);
            let err = (err + q.hi.abs() * volume_err) / least + q.hi.abs() * LOSS;
            out[2 + i] = coordinate(self.frame[i], Place { h: self.origin[i], l: 0.0 }, q, err)?;
        }
        Some(out)
    }

    /// Area vector and centroid of the walls. Zero components are known from the triangles; with `all` the faces of the cell
    /// taken, also from those in grid planes.
    #[inline(always)]
    pub fn walls(&self, all: bool) -> Option<WallValues> {
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
            let q = m.over(w, inverse);
            let err = (first_err + m.hi.abs() * LOSS + q.hi.abs() * w_err) / least + q.hi.abs() * LOSS;
            // Six times the moment over twice the area, and 2⁻¹¹⁹ over 2⁻¹²².
            let third = Pair { hi: 8.0 / 3.0, lo: 1.0 / 6755399441055744.0 };
            out[3 + i] = coordinate(self.frame[i], Place { h: self.origin[i], l: 0.0 }, q.times(third), err * 3.0)?;
        }
        Some(out)
    }
}

/// The coordinate at a place plus q, where q and its bound are in terms of 2^exponent; the place's rest is off by the slack.
#[inline(always)]
fn coordinate(frame: &Interval, o: Place, q: Pair, err: f64) -> Option<f64> {
    let top = (o.h >> 32 << 32) as f64 * frame.unit;
    let rest = (o.h as u32) as f64 * frame.unit;
    let length = frame.unit * UNITS;
    let (q, err) = (q.scaled(length), err * length + if o.l == 0.0 { 0.0 } else { frame.slack * frame.unit });
    let s = two_sum(frame.low, top).plus(two_sum(q.hi, rest)).plus(two_sum(q.lo, o.l * frame.unit));
    let loss = (frame.low.abs() + length + q.hi.abs()) * LOSS;
    settle(s, err + loss)
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

/// Area and centroid of a face in a grid plane, all loops relative to its first corner, from its corners' places along the two axes
/// that follow its own, and the offsets of its loops. Returns the area for the cells, and area, fraction and centroid if they are decided.
///
/// Bounds as above, for edges in place of triangles; T: the size of the face.
pub fn plane_face(places: &[[Place; 2]], loops: &[u32], frames: [&Interval; 2]) -> (PlaneArea, Option<[f64; 4]>) {
    let [fb, fc] = frames;
    let mut sum = Sum::default();
    let mut first = [Sum::default(); 2];
    let mut reach = 1u64;
    let mut count = 0.0;
    let o = places[0];
    let relative =
        |p: &[Place; 2]| -> [Place; 2] { std::array::from_fn(|i| Place { h: p[i].h - o[i].h, l: p[i].l - o[i].l }) };
    for (l, w) in loops.windows(2).enumerate() {
        let corners = &places[(w[0] - loops[0]) as usize..(w[1] - loops[0]) as usize];
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
    let area = PlaneArea::new(sum.h.wrapping_add(rounded as i128), err + 1.0, false);
    let values = || {
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
        let size = fb.size.times(fc.size);
        let part = d.scaled(power(-123)).over(size, 1.0 / size.hi);
        let fraction = settle(part, d_err * power(-123) / size.hi + part.hi.abs() * LOSS)?;
        let first_err = count * (t * (6.0 * t * k + 24.0) * TO_64 + 6.0);
        let inverse = 1.0 / d.hi;
        let mut out = [value, fraction, 0.0, 0.0];
        for i in 0..2 {
            let m = first[i].pair();
            let q = m.over(d, inverse);
            let q_err = (first_err + m.hi.abs() * LOSS + q.hi.abs() * d_err) / least + q.hi.abs() * LOSS;
            let third = Pair { hi: 8.0 / 3.0, lo: 1.0 / 6755399441055744.0 };
            out[2 + i] = coordinate(frames[i], o[i], q.times(third), q_err * 3.0)?;
        }
        Some(out)
    };
    (area, values())
}

/// Which side of a cell a half-face in a grid plane is on: its normal points along the axis, so the back is on the lower
/// side, and the face is the cell's high side.
#[inline(always)]
pub fn on_high_side(h: HalfFace) -> bool {
    !h.front()
}

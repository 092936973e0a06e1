//! Signs of functions at vertices.
//!
//! Vertices carry barycentric coordinates `x`, not normalised, from Cramer's rule on rows scaled to maximum 1, so that one error bound
//! per dimension of the carrier holds for all of them; a sign is one dot product compared with it. The symbolic planes decide the rest
//! (`exact/barycentric.rs`), zeros above all.
//!
//! Degenerate cases: planes that are nearly dependent leave coordinates of which nothing is certain (NaN), rows that scaling could have
//! hurt likewise: then every sign there is decided by the planes. At corners there is no error: products with 0 and 1 are exact, and
//! scaling keeps the order of values, so only equal results are compared again as given.

use super::work::Work;
use crate::exact::Sign;
use crate::exact::barycentric::{Function, orientation, oriented_sign};
use crate::exact::counters::{Predicate, Tier, count_many};

const U: f64 = f64::EPSILON / 2.0;
/// Bounds on the error of `f.x - w`, by the size of the carrier (its dimension and one), with u = 2^-53. All rows and f have entries of at most 1.
///
/// Arrangement. Dimension 1: coordinates are values themselves, hence exact; two products and a sum: 4u. Dimension 2: a minor of
/// entries up to 1 is off by 2u for its products and 2u for the difference; three of them, with products up to 2 and sums up to
/// 6, are off by 12u + 6u + 10u = 28u. Dimension 3: a 3x3 minor of three products up to 2, each off by 4u + 2u, with sums up to 4
/// and 6, by 28u; four of them, 112u, products up to 6 (24u) and sums up to 24 (54u): 190u.
///
/// Interface. Rows are rounded differences (one more u an entry), f and w rest on differences rounded twice, w is a dot product as
/// well. Dimension 1: 2u + 4u + 4u + 4u + 4u = 18u. Dimension 2: coordinates 8u: 24u + 16u + 16u + 12u + 12u = 80u. Dimension 3:
/// coordinates 46u: 184u + 78u + 78u + 24u + 48u = 412u.
///
/// What underflow loses is below 2^-1000, and terms of second order are far below the slack left.
const ERROR: [[f64; 8]; 2] =
    [[0.0, 0.0, 8.0 * U, 40.0 * U, 256.0 * U, 0.0, 0.0, 0.0], [0.0, 0.0, 24.0 * U, 96.0 * U, 512.0 * U, 0.0, 0.0, 0.0]];
/// A sum of coordinates below this (4 coordinates off by 46u) says nothing about their signs.
const NOTHING: f64 = 256.0 * U;

impl Work {
    /// Each function by its own power of two.
    pub fn scale_each(&mut self) {
        self.scaled.clear();
        self.scaled.extend(self.values.iter().map(|f| {
            let (s, t) = scale(max_abs(f));
            f.map(|x| x * s * t)
        }));
    }

    /// All by one power of two, and as differences to the highest value at each corner. Powers of two and rounded differences are
    /// monotonous, so at corners the results are in the right order wherever they differ.
    pub fn scale_together(&mut self) {
        let most = self.values.iter().fold(0.0, |m: f64, f| m.max(max_abs(f)));
        let (s, t) = scale(most);
        self.raised.clear();
        self.raised.extend(self.values.iter().map(|f| f.map(|x| x * s * t)));
        let top = self.raised.iter().fold([f64::NEG_INFINITY; 4], |m, f| std::array::from_fn(|c| m[c].max(f[c])));
        let difference = |f: &[f64; 4]| -> [f64; 4] { std::array::from_fn(|c| f[c] - top[c]) };
        let most = self.raised.iter().fold(0.0, |m: f64, f| m.max(max_abs(&difference(f))));
        // Beyond that, what scaling lost to underflow could show.
        let s = if most > 1e-100 { scale(most).0 } else { 1.0 };
        self.scaled.clear();
        self.scaled.extend(self.raised.iter().map(|f| difference(f).map(|x| x * s)));
    }

    /// The sign of the current function at a vertex, from this round or new.
    #[inline(always)]
    pub fn sign(&mut self, v: u32) -> i32 {
        let mark = self.vertices[v as usize].mark;
        if mark >> 2 == self.round { (mark & 3) as i32 - 1 } else { self.new_sign(v) }
    }

    /// The sign that this round has found.
    #[inline(always)]
    pub fn known_sign(&self, v: u32) -> i32 {
        let mark = self.vertices[v as usize].mark;
        debug_assert_eq!(mark >> 2, self.round);
        (mark & 3) as i32 - 1
    }

    #[inline(always)]
    pub fn new_sign(&mut self, v: u32) -> i32 {
        #[cfg(feature = "plain-signs")]
        if self.plain {
            return self.plain_sign(v);
        }
        let f = (self.round - 1) as usize;
        let mut sign = self.filtered_sign(f, v);
        self.filtered += 1;
        if sign == 0 {
            self.filtered -= 1;
            sign = self.exact_sign(f, v) as i32;
        }
        self.vertices[v as usize].mark = self.round << 2 | (sign + 1) as u32;
        if sign == 0 {
            self.zeros.push(v);
        }
        sign
    }

    /// The sign of function `f` at a vertex (interface: of its difference to the envelope); 0 if the bound does not decide.
    #[inline(always)]
    pub fn filtered_sign(&self, f: usize, v: u32) -> i32 {
        let (f, v) = (&self.scaled[f], &self.vertices[v as usize]);
        let s = (f[0] * v.x[0] + f[1] * v.x[1]) + (f[2] * v.x[2] + f[3] * v.x[3]) - v.w;
        let error = ERROR[self.interface as usize][v.size as usize & 7];
        // Signs are as good as random, so nothing jumps on them.
        (s > error) as i32 - (s < -error) as i32
    }

    /// The same from the planes.
    #[inline(never)]
    pub fn exact_sign(&mut self, f: usize, v: u32) -> Sign {
        let vertex = self.vertices[v as usize];
        let ids = vertex.functions();
        let n = vertex.size as usize - 1 + self.interface as usize;
        let function = |k: usize| {
            let f = &self.values[k];
            if self.interface { Function::Difference(f, &self.values[ids[0] as usize]) } else { Function::Values(f) }
        };
        let skip = self.interface as usize;
        let mut rows = [Function::Values(&[]); 4];
        for k in skip..n {
            rows[k - skip] = function(ids[k] as usize);
        }
        let (through, f) = (&rows[..n - skip], function(f));
        let side = match vertex.orientation {
            2 => orientation(vertex.carrier, through),
            1 => Sign::Positive,
            _ => Sign::Negative,
        };
        debug_assert!(!side.is_zero());
        let sign = oriented_sign(vertex.carrier, through, side, f);
        self.vertices[v as usize].orientation = side.to_i8();
        sign
    }

    /// Coordinates of the point of a carrier where functions vanish.
    #[inline(always)]
    pub fn meet(&self, carrier: u8, size: u8, ids: &[u32; 4]) -> [f64; 4] {
        let row = |k: usize| &self.scaled[ids[k] as usize];
        match size {
            1 => unit(carrier),
            2 => meet_edge(carrier, row(0)),
            3 => meet_triangle(carrier, row(0), row(1)),
            _ => meet_inside(row(0), row(1), row(2)),
        }
    }

    /// Coordinates of the point of a carrier where materials are equal, and their value there.
    #[inline(always)]
    pub fn meet_interface(&self, carrier: u8, size: u8, ids: &[u32; 4]) -> ([f64; 4], f64) {
        // Differences are small where materials are close: each row is scaled for itself.
        let row = |k: usize| {
            let (a, b) = (&self.raised[ids[k] as usize], &self.raised[ids[0] as usize]);
            let d: [f64; 4] = std::array::from_fn(|c| a[c] - b[c]);
            let most = max_abs(&std::array::from_fn(|c| if carrier >> c & 1 != 0 { d[c] } else { 0.0 }));
            // Below that, what scaling lost to underflow could show.
            let s = if most > 1e-100 { scale(most).0 } else { f64::NAN };
            d.map(|x| x * s)
        };
        let x = match size {
            1 => unit(carrier),
            2 => meet_edge(carrier, &row(1)),
            3 => meet_triangle(carrier, &row(1), &row(2)),
            _ => meet_inside(&row(1), &row(2), &row(3)),
        };
        let f = &self.scaled[ids[0] as usize];
        (x, (f[0] * x[0] + f[1] * x[1]) + (f[2] * x[2] + f[3] * x[3]))
    }

    pub fn flush_counters(&mut self) {
        count_many(Predicate::Barycentric, Tier::Filter, self.filtered);
        self.filtered = 0;
    }
}

#[inline(always)]
fn max_abs(f: &[f64; 4]) -> f64 {
    f[0].abs().max(f[1].abs()).max(f[2].abs().max(f[3].abs()))
}

/// Two powers of two by which a number becomes at least 1/2 and less than 1 (both 1 for zero). The second is 1 unless the number
/// is near the ends of the range.
#[inline(always)]
fn scale(most: f64) -> (f64, f64) {
    let field = |x: f64| x.to_bits() >> 52;
    let power = |x: f64| f64::from_bits((2045 - field(x)) << 52);
    match field(most) {
        64..=1983 => (power(most), 1.0),
        0..64 if most == 0.0 => (1.0, 1.0),
        0..64 => {
            let up = f64::from_bits((1023 + 600) << 52);
            (up, power(most * up))
        }
        _ => {
            let down = f64::from_bits((1023 - 600) << 52);
            (down, power(most * down))
        }
    }
}

#[inline(always)]
fn unit(carrier: u8) -> [f64; 4] {
    std::array::from_fn(|c| (carrier >> c & 1) as f64)
}

/// Where f vanishes between two corners of unlike signs.
#[inline(always)]
fn meet_edge(carrier: u8, f: &[f64; 4]) -> [f64; 4] {
    let (a, b) = (carrier.trailing_zeros() as usize, 7 - carrier.leading_zeros() as usize);
    let mut x = [0.0; 4];
    x[a] = f[b].abs();
    x[b] = f[a].abs();
    x
}

/// Where f and g vanish on a facet.
#[inline(always)]
fn meet_triangle(carrier: u8, f: &[f64; 4], g: &[f64; 4]) -> [f64; 4] {
    let [a, b, c]: [usize; 3] = match carrier {
        0b0111 => [0, 1, 2],
        0b1011 => [0, 1, 3],
        0b1101 => [0, 2, 3],
        _ => [1, 2, 3],
    };
    let minor = |i: usize, j: usize| f[i] * g[j] - f[j] * g[i];
    let (p, q, r) = (minor(b, c), minor(c, a), minor(a, b));
    let s = certain(p + q + r);
    let mut x = [0.0; 4];
    x[a] = p * s;
    x[b] = q * s;
    x[c] = r * s;
    x
}

/// Where f, g and h vanish inside.
#[inline(always)]
fn meet_inside(f: &[f64; 4], g: &[f64; 4], h: &[f64; 4]) -> [f64; 4] {
    let minor = |i: usize, j: usize| g[i] * h[j] - g[j] * h[i];
    let (m01, m02, m03) = (minor(0, 1), minor(0, 2), minor(0, 3));
    let (m12, m13, m23) = (minor(1, 2), minor(1, 3), minor(2, 3));
    let x = [
        f[1] * m23 - f[2] * m13 + f[3] * m12,
        -(f[0] * m23 - f[2] * m03 + f[3] * m02),
        f[0] * m13 - f[1] * m03 + f[3] * m01,
        -(f[0] * m12 - f[1] * m02 + f[2] * m01),
    ];
    let s = certain((x[0] + x[1]) + (x[2] + x[3]));
    x.map(|x| x * s)
}

/// The sign by which coordinates with this sum become positive: they all have one sign. NaN if rounding hides it.
#[inline(always)]
fn certain(sum: f64) -> f64 {
    if sum.abs() > NOTHING { 1.0f64.copysign(sum) } else { f64::NAN }
}

//! The sign of the signed volume of closed shells.
//!
//! Six times the volume is the sum of det(a−o, b−o, c−o) over the triangles, for any o. In `f64`, with o the first
//! corner of the shell and a running bound; where the bound cannot tell (slivers, shells without volume), exactly in
//! integers on a common exponent.
//!
//! Cost: some 20 flops per triangle for all shells in one pass; the exact case about a microsecond per triangle of the
//! undecided shell.

use super::projection::{ROUNDOFF, seen_along};
use crate::base::parallel::map_ranges;
use crate::base::{Csr, VertexId};
use crate::exact::Sign;
use rug::Integer;

/// A running sum of determinants of one shell.
#[derive(Clone, Copy, Default)]
struct Sum {
    value: f64,
    magnitude: f64,
    largest: f64,
    terms: f64,
}

impl Sum {
    #[inline(always)]
    fn add(&mut self, o: &Sum) {
        self.value += o.value;
        self.magnitude += o.magnitude;
        self.largest = self.largest.max(o.largest);
        self.terms += o.terms;
    }
}

/// The sign of the volume of each of `shell_count` shells; `shell_of` gives the shell of each triangle, or `u32::MAX` for
/// triangles of none. Coordinates are finite.
pub fn volume_signs(
    vertices: &[[f64; 3]],
    triangles: &[[VertexId; 3]],
    shell_of: &[u32],
    shell_count: usize,
) -> Vec<Sign> {
    let mut origins = vec![[f64::NAN; 3]; shell_count];
    let mut missing = shell_count;
    for (corners, &shell) in triangles.iter().zip(shell_of) {
        if missing == 0 {
            break;
        }
        if shell != u32::MAX && origins[shell as usize][0].is_nan() {
            origins[shell as usize] = vertices[corners[0].at()];
            missing -= 1;
        }
    }
    // With many shells one sum per shell and range would cost more than it saves.
    let least = if shell_count > 64 { triangles.len() } else { 1 << 13 };
    let parts = map_ranges(triangles.len(), least, |range| {
        let mut sums = vec![Sum::default(); shell_count];
        for (corners, &shell) in triangles[range.clone()].iter().zip(&shell_of[range]) {
            if shell == u32::MAX {
                continue;
            }
            let o = &origins[shell as usize];
            let minus = |p: [f64; 3]| [p[0] - o[0], p[1] - o[1], p[2] - o[2]];
            let [a, b, c] = corners.map(|v| minus(vertices[v.at()]));
            let mut term = 0.0;
            let mut magnitude = 0.0;
            for (i, a) in a.into_iter().enumerate() {
                let (j, k) = seen_along(i);
                let (p, q) = (b[j] * c[k], b[k] * c[j]);
                term += a * (p - q);
                magnitude += a.abs() * (p.abs() + q.abs());
            }
            let largest = a[0].abs().max(a[1].abs()).max(a[2].abs());
            sums[shell as usize].add(&Sum { value: term, magnitude, largest, terms: 1.0 });
        }
        sums
    });
    let mut sums = vec![Sum::default(); shell_count];
    for part in &parts {
        sums.iter_mut().zip(part).for_each(|(sum, more)| sum.add(more));
    }
    let mut members: Option<Csr<u32>> = None;
    let mut sign = |s: usize| {
        let Sum { value, magnitude, largest, terms } = sums[s];
        // A triple product of rounded differences has at most 3 + 2 + 1 + 2 roundings, the running sum one per term (whatever the order of the terms);
        // what the bound itself loses is within the surplus. Underflow takes at most 2^-1075 from each product, times
        // the factor that follows. With overflow the magnitude is infinite or NaN.
        let bound = (terms + 16.0) * ROUNDOFF * 1.25 * magnitude + terms * (largest * 1e-300 + 1e-280);
        if magnitude < 1e300 && value > bound {
            return Sign::Positive;
        }
        if magnitude < 1e300 && value < -bound {
            return Sign::Negative;
        }
        let members = members.get_or_insert_with(|| {
            let of_shells = shell_of.iter().enumerate().filter(|(_, s)| **s != u32::MAX);
            Csr::from_pairs(shell_count, of_shells.map(|(t, &s)| (s as usize, t as u32)))
        });
        exact_sign(vertices, triangles, members.row(s))
    };
    (0..shell_count).map(&mut sign).collect()
}

/// A finite double as `mantissa · 2^exponent`.
fn decompose(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let mantissa = if exponent == 0 { fraction } else { fraction | 1 << 52 };
    (if x < 0.0 { -mantissa } else { mantissa }, exponent.max(1) - 1075)
}

fn exact_sign(vertices: &[[f64; 3]], triangles: &[[VertexId; 3]], shell: &[u32]) -> Sign {
    let members = || shell.iter().map(|&t| &triangles[t as usize]);
    let base = members()
        .flat_map(|t| t.iter().flat_map(|v| vertices[v.at()]))
        .filter(|x| *x != 0.0)
        .map(|x| {
            let (mantissa, exponent) = decompose(x);
            exponent + mantissa.trailing_zeros() as i32
        })
        .min()
        .unwrap_or(0);
    let integer = |x: f64| {
        let (mantissa, exponent) = decompose(x);
        if mantissa == 0 {
            return Integer::new();
        }
        let trailing = mantissa.trailing_zeros();
        Integer::from(mantissa >> trailing) << (exponent + trailing as i32 - base) as u32
    };
    let mut sum = Integer::new();
    for t in members() {
        let [a, b, c] = t.map(|v| vertices[v.at()].map(integer));
        for (i, a) in a.iter().enumerate() {
            let (j, k) = seen_along(i);
            let minor = Integer::from(&b[j] * &c[k]) - Integer::from(&b[k] * &c[j]);
            sum += a * minor;
        }
    }
    match sum.cmp0() {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

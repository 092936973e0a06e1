//! Tier (e): integers of any size, for input whose exponents are too far apart for the stack; and for exact
//! coordinates. The same scaling as tier (d), so nothing under- or overflows here either.

use super::Sign;
use super::lift::{plane_exponent, row_exponent, split};
use super::ring::{Kernel, Ring};
use super::rows::Row;
use super::types::Plane;
use rug::Integer;

impl Ring for Integer {
    fn plus(&self, o: &Self) -> Self {
        Integer::from(self + o)
    }
    fn minus(&self, o: &Self) -> Self {
        Integer::from(self - o)
    }
    fn times(&self, o: &Self) -> Self {
        Integer::from(self * o)
    }
    fn negated(&self) -> Self {
        Integer::from(-self)
    }
}

pub fn sign(x: &Integer) -> Sign {
    Sign::from_ordering(x.cmp0())
}

/// x 2^-e, where `e` is at most the exponent of the lowest set bit of `x`.
pub fn scaled(x: f64, e: i32) -> Integer {
    let (m, s) = split(x);
    let shift = s - e;
    let m = if shift < 0 { Integer::from(m.unbounded_shr(-shift as u32)) } else { Integer::from(m) << shift as u32 };
    if x < 0.0 { -m } else { m }
}

pub struct BigKernel {
    pub e: i32,
}

impl Kernel for BigKernel {
    type N = Integer;
    fn coordinate(&self, x: f64) -> Integer {
        scaled(x, self.e)
    }
    fn plane(&self, p: &Plane) -> [Integer; 4] {
        let s = plane_exponent(p, self.e);
        [scaled(p.n[0], s), scaled(p.n[1], s), scaled(p.n[2], s), scaled(p.d, s + self.e)]
    }
    fn row<const M: usize>(&self, r: &Row<'_, M>) -> [Integer; M] {
        let s = row_exponent(r);
        match r {
            Row::Values(a) => std::array::from_fn(|i| scaled(a[i], s)),
            Row::Difference(a, b) => std::array::from_fn(|i| scaled(a[i], s) - scaled(b[i], s)),
            Row::Ones => std::array::from_fn(|_| Integer::from(1)),
        }
    }
    fn one(&self) -> Integer {
        Integer::from(1)
    }
}

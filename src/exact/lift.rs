//! Doubles as integers on a common exponent. A finite double is m 2^s with |m| < 2^53; `lsb` is the exponent of its
//! lowest set bit. [`Scan`] evaluates an expression only to see its coordinates and finds the exponent on which all
//! of them are integers; [`plane_exponent`] does the same for a plane, given the coordinates' exponent.
//! Cost: a few nanoseconds per input number.

use super::ring::{Kernel, Ring};
use super::rows::Row;
use super::types::Plane;
use std::cell::Cell;

/// No nonzero number seen.
pub const NONE: i32 = i32::MAX;

/// Mantissa and exponent: |x| = m 2^s.
#[inline(always)]
pub fn split(x: f64) -> (u64, i32) {
    let bits = x.to_bits();
    let field = ((bits >> 52) & 0x7ff) as i32;
    let m = (bits & ((1 << 52) - 1)) | (((field != 0) as u64) << 52);
    (m, field.max(1) - 1075)
}

/// Exponent of the lowest set bit; [`NONE`] for zero.
#[inline(always)]
pub fn lsb(x: f64) -> i32 {
    let (m, s) = split(x);
    if m == 0 { NONE } else { s + m.trailing_zeros() as i32 }
}

#[inline(always)]
pub fn lsb_of<const M: usize>(a: &[f64; M]) -> i32 {
    a.iter().fold(NONE, |e, &x| e.min(lsb(x)))
}

/// The exponent s such that n 2^-s and d 2^-(s+e) are integers, where e is the coordinates' exponent.
#[inline(always)]
pub fn plane_exponent(p: &Plane, e: i32) -> i32 {
    let d = lsb(p.d);
    let d = if d == NONE { NONE } else { d - e };
    match lsb_of(&p.n).min(d) {
        NONE => 0,
        s => s,
    }
}

/// The exponent of a row of function values; 0 if all are zero.
#[inline(always)]
pub fn row_exponent<const M: usize>(r: &Row<'_, M>) -> i32 {
    let s = match r {
        Row::Values(a) => lsb_of(a),
        Row::Difference(a, b) => lsb_of(a).min(lsb_of(b)),
        Row::Ones => 0,
    };
    if s == NONE { 0 } else { s }
}

/// The number type of [`Scan`]: nothing at all, so the arithmetic of the expression compiles to nothing.
#[derive(Clone, Copy)]
pub struct Nothing;

impl Ring for Nothing {
    #[inline(always)]
    fn plus(&self, _: &Self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn minus(&self, _: &Self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn times(&self, _: &Self) -> Self {
        Nothing
    }
    #[inline(always)]
    fn negated(&self) -> Self {
        Nothing
    }
}

/// Records the coordinates' exponent. Where an expression has planes but no (nonzero) coordinate, any exponent is right; the
/// one that lets offsets and normals end at the same bit is the narrowest.
pub struct Scan {
    coordinates: Cell<i32>,
    planes: Cell<i32>,
}

impl Scan {
    #[inline(always)]
    pub fn new() -> Self {
        Self { coordinates: Cell::new(NONE), planes: Cell::new(NONE) }
    }
    #[inline(always)]
    pub fn exponent(&self) -> i32 {
        match (self.coordinates.get(), self.planes.get()) {
            (NONE, NONE) => 0,
            (NONE, e) => e,
            (e, _) => e,
        }
    }
}

impl Default for Scan {
    fn default() -> Self {
        Self::new()
    }
}

impl Kernel for Scan {
    type N = Nothing;
    #[inline(always)]
    fn coordinate(&self, x: f64) -> Nothing {
        self.coordinates.set(self.coordinates.get().min(lsb(x)));
        Nothing
    }
    #[inline(always)]
    fn plane(&self, p: &Plane) -> [Nothing; 4] {
        // Once a coordinate has been seen, planes no longer matter.
        if self.coordinates.get() == NONE {
            let (d, n) = (lsb(p.d), lsb_of(&p.n));
            if d != NONE && n != NONE {
                self.planes.set(self.planes.get().min(d - n));
            }
        }
        [Nothing; 4]
    }
    #[inline(always)]
    fn row<const M: usize>(&self, _: &Row<'_, M>) -> [Nothing; M] {
        [Nothing; M]
    }
    #[inline(always)]
    fn one(&self) -> Nothing {
        Nothing
    }
}

//! Arithmetic modulo two fixed primes just below 2^61: exact sums over many cells checked in linear time. An identity of
//! rationals that holds is seen to hold; one that does not is missed with a chance of some 2^-122 for input that was
//! not made for it.

use super::lift::split;
use super::points::homogeneous;
use super::ring::{Kernel, Ring};
use super::rows::Row;
use super::types::{Plane, Point};
use rug::{Integer, Rational};

/// 2^61 - 1 and 2^61 - 31, both prime.
pub const PRIMES: [u64; 2] = [(1 << 61) - FOLD[0], (1 << 61) - FOLD[1]];
const FOLD: [u64; 2] = [1, 31];

/// A number modulo both primes; each part is below its prime.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Residue(pub [u64; 2]);

/// x mod p, for x < 2^122: 2^61 is FOLD modulo p.
#[inline(always)]
const fn reduce(x: u128, i: usize) -> u64 {
    let mask = (1u128 << 61) - 1;
    let x = (x & mask) + (x >> 61) * FOLD[i] as u128;
    let x = (x & mask) + (x >> 61) * FOLD[i] as u128;
    // Now below 2^61 + 2^11.
    let x = x as u64;
    if x >= PRIMES[i] { x - PRIMES[i] } else { x }
}

const LEAST: i32 = -1074;
const POWERS: usize = 2046;

/// 2^e for every exponent of a double's mantissa, from 2^-1074 on.
static POWER: [[u64; POWERS]; 2] = [powers(0), powers(1)];

const fn powers(i: usize) -> [u64; POWERS] {
    // 2^-1074 is the 1074th power of one half, which is (p + 1) / 2.
    let half = PRIMES[i].div_ceil(2);
    let mut x = 1u64;
    let mut k = 0;
    while k < -LEAST {
        x = reduce(x as u128 * half as u128, i);
        k += 1;
    }
    let mut all = [0; POWERS];
    let mut k = 0;
    while k < POWERS {
        all[k] = x;
        x = reduce(x as u128 * 2, i);
        k += 1;
    }
    all
}

impl Residue {
    pub const ZERO: Self = Self([0, 0]);
    pub const ONE: Self = Self([1, 1]);

    #[inline(always)]
    fn each(f: impl Fn(usize) -> u64) -> Self {
        Self([f(0), f(1)])
    }

    pub fn from_u64(x: u64) -> Self {
        Self::each(|i| reduce(x as u128, i))
    }

    pub fn from_i64(x: i64) -> Self {
        let r = Self::from_u64(x.unsigned_abs());
        if x < 0 { -r } else { r }
    }

    /// A finite double, exactly.
    #[inline]
    pub fn from_f64(x: f64) -> Self {
        let (m, s) = split(x);
        // (The exponent of a number that is not finite is the last one plus one.)
        debug_assert!(x.is_finite());
        let at = ((s - LEAST) as usize).min(POWERS - 1);
        let r = Self::each(|i| reduce(m as u128 * POWER[i][at] as u128, i));
        if x < 0.0 { -r } else { r }
    }

    pub fn from_integer(x: &Integer) -> Self {
        let r = Self::each(|i| Integer::from(x.abs_ref()).mod_u64(PRIMES[i]));
        if x.is_negative() { -r } else { r }
    }

    /// `None` if a prime divides the denominator.
    pub fn from_rational(x: &Rational) -> Option<Self> {
        Some(Self::from_integer(x.numer()) * Self::from_integer(x.denom()).inverse()?)
    }

    pub fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    /// 1/x; `None` if x vanishes modulo either prime. Cost: some 120 multiplications (Fermat).
    pub fn inverse(self) -> Option<Self> {
        if self.0[0] == 0 || self.0[1] == 0 {
            return None;
        }
        Some(Self::each(|i| {
            let (mut base, mut e, mut r) = (self.0[i], PRIMES[i] - 2, 1u64);
            while e > 0 {
                if e & 1 == 1 {
                    r = reduce(r as u128 * base as u128, i);
                }
                base = reduce(base as u128 * base as u128, i);
                e >>= 1;
            }
            r
        }))
    }
}

trait ModU64 {
    fn mod_u64(self, p: u64) -> u64;
}

impl ModU64 for Integer {
    /// Of a number that is not negative.
    fn mod_u64(self, p: u64) -> u64 {
        (self % p).to_u64().unwrap_or(0)
    }
}

impl std::ops::Add for Residue {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::each(|i| {
            let x = self.0[i] + o.0[i];
            if x >= PRIMES[i] { x - PRIMES[i] } else { x }
        })
    }
}

impl std::ops::Neg for Residue {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::each(|i| if self.0[i] == 0 { 0 } else { PRIMES[i] - self.0[i] })
    }
}

impl std::ops::Sub for Residue {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl std::ops::Mul for Residue {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self::each(|i| reduce(self.0[i] as u128 * o.0[i] as u128, i))
    }
}

impl std::ops::AddAssign for Residue {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl std::ops::SubAssign for Residue {
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl std::ops::MulAssign for Residue {
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

impl std::iter::Sum for Residue {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::ZERO, |a, b| a + b)
    }
}

impl Ring for Residue {
    #[inline(always)]
    fn plus(&self, o: &Self) -> Self {
        *self + *o
    }
    #[inline(always)]
    fn minus(&self, o: &Self) -> Self {
        *self - *o
    }
    #[inline(always)]
    fn times(&self, o: &Self) -> Self {
        *self * *o
    }
    #[inline(always)]
    fn negated(&self) -> Self {
        -*self
    }
}

/// Inputs modulo the primes; nothing is scaled.
pub struct ResidueKernel;

impl Kernel for ResidueKernel {
    type N = Residue;
    fn coordinate(&self, x: f64) -> Residue {
        Residue::from_f64(x)
    }
    fn plane(&self, p: &Plane) -> [Residue; 4] {
        [p.n[0], p.n[1], p.n[2], p.d].map(Residue::from_f64)
    }
    fn row<const M: usize>(&self, r: &Row<'_, M>) -> [Residue; M] {
        match r {
            Row::Values(a) => a.map(Residue::from_f64),
            Row::Difference(a, b) => std::array::from_fn(|i| Residue::from_f64(a[i]) - Residue::from_f64(b[i])),
            Row::Ones => [Residue::ONE; M],
        }
    }
    fn one(&self) -> Residue {
        Residue::ONE
    }
}

/// Residues of a symbolic point's exact coordinates; `None` if the denominator vanishes modulo a prime.
pub fn point_residues(x: &Point) -> Option<[Residue; 3]> {
    if let Point::Vertex(v) = x {
        return Some(v.map(Residue::from_f64));
    }
    let [a, b, c, w] = homogeneous(&ResidueKernel, x);
    let w = w.inverse()?;
    Some([a * w, b * w, c * w])
}

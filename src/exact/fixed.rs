//! Tier (d): integers on the stack. `Int<N>` is a signed number in two's complement of at most `N` limbs of 64 bits, of which the
//! lowest `len` are in use: a product costs the lengths of its factors, not the capacity, so a determinant of ordinary
//! input runs through one- and two-limb products.
//!
//! Invariant: `1 <= len <= N`, the value is that of limbs `0..len` as a signed number, and the top limb is not a mere extension of
//! the sign (unless it is the only one). A number that would not fit is *lost* (`len > N`), and so is all that is computed
//! from it; the caller then takes a wider type. Nothing wraps.

use super::Sign;
use super::lift::{plane_exponent, row_exponent, split};
use super::ring::{Kernel, Ring};
use super::rows::Row;
use super::types::Plane;

#[derive(Clone, Copy, Debug)]
pub struct Int<const N: usize> {
    len: usize,
    limbs: [u64; N],
}

/// `len` of a lost number; large, yet safe to add.
const LOST: usize = 1 << 20;

/// Numbers are wide, and a copy right after scalar stores stalls the processor: so results are built where they stay, by
/// methods that set `self` (limbs from `len` on hold anything), and functions return one local variable.
impl<const N: usize> Int<N> {
    const ZERO: Self = Self { len: 1, limbs: [0; N] };

    #[inline(always)]
    pub fn small(x: i64) -> Self {
        let mut r = Self::ZERO;
        r.limbs[0] = x as u64;
        r
    }

    #[inline(always)]
    fn set(&mut self, x: i128) {
        self.limbs[0] = x as u64;
        self.limbs[1] = (x >> 64) as u64;
        self.len = 1 + ((x as i64) as i128 != x) as usize;
    }

    /// x 2^-e, where `e` is at most the exponent of the lowest set bit of `x`.
    #[inline(always)]
    pub fn scaled(x: f64, e: i32) -> Self {
        let mut r = Self::ZERO;
        r.set_scaled(x, e);
        r
    }

    #[inline(always)]
    fn set_scaled(&mut self, x: f64, e: i32) {
        let (m, s) = split(x);
        // Without trailing zeros the shift is never negative. Signs and lengths vary at random, so no branch hangs on them.
        let zeros = m.trailing_zeros();
        let sign = (x.to_bits() as i64) >> 63;
        let m = (m.unbounded_shr(zeros) as i64 ^ sign) - sign;
        let shift = s + zeros as i32 - e;
        if m == 0 || shift <= 10 {
            self.limbs[0] = m.unbounded_shl(shift as u32) as u64;
            self.len = 1;
        } else if shift <= 74 {
            self.set((m as i128) << shift);
        } else {
            self.set_far(m, shift as usize);
        }
    }

    #[inline(never)]
    fn set_far(&mut self, m: i64, shift: usize) {
        let (word, bit) = (shift / 64, shift % 64);
        if word + 2 > N {
            self.len = LOST;
            return;
        }
        let m = (m as i128) << bit;
        self.limbs[..word].fill(0);
        self.limbs[word] = m as u64;
        self.limbs[word + 1] = (m >> 64) as u64;
        self.len = word + 2;
        self.trim();
    }

    /// The value of one limb.
    #[inline(always)]
    fn limb(&self) -> i128 {
        self.limbs[0] as i64 as i128
    }

    /// The value of one or two limbs.
    #[inline(always)]
    fn narrow(&self) -> i128 {
        let high = if self.len == 1 { ((self.limbs[0] as i64) >> 63) as u64 } else { self.limbs[1] };
        ((high as u128) << 64 | self.limbs[0] as u128) as i128
    }

    #[inline(always)]
    fn trim(&mut self) {
        while self.len > 1 && self.limbs[self.len - 1] == ((self.limbs[self.len - 2] as i64) >> 63) as u64 {
            self.len -= 1;
        }
    }

    #[inline(always)]
    fn extension(&self) -> u64 {
        ((self.limbs[self.len - 1] as i64) >> 63) as u64
    }

    /// Bits without the sign: |x| <= 2^bits.
    fn bits(&self) -> usize {
        let top = self.limbs[self.len - 1];
        let top = if (top as i64) < 0 { !top } else { top };
        64 * self.len - top.leading_zeros() as usize
    }

    /// `None` if the number was lost.
    #[inline(always)]
    pub fn sign(&self) -> Option<Sign> {
        if self.len > N {
            return None;
        }
        Some(if (self.limbs[self.len - 1] as i64) < 0 {
            Sign::Negative
        } else if self.len == 1 && self.limbs[0] == 0 {
            Sign::Zero
        } else {
            Sign::Positive
        })
    }

    /// The value; `None` if the number was lost.
    #[doc(hidden)]
    pub fn to_integer(&self) -> Option<rug::Integer> {
        let (&top, rest) = self.limbs.get(..self.len)?.split_last()?;
        Some(rest.iter().rev().fold(rug::Integer::from(top as i64), |x, &l| (x << 64) + l))
    }

    /// a + b, or a - b for `flip` = all ones.
    #[inline(always)]
    fn set_sum(&mut self, a: &Self, b: &Self, flip: u64) {
        if a.len <= 2 && b.len <= 2 {
            let (x, y) = (a.narrow(), b.narrow());
            let (s, overflow) = if flip == 0 { x.overflowing_add(y) } else { x.overflowing_sub(y) };
            if !overflow {
                self.set(s);
                return;
            }
        }
        self.set_sum_far(a, b, flip);
    }

    #[inline(never)]
    fn set_sum_far(&mut self, a: &Self, b: &Self, flip: u64) {
        let n = a.len.max(b.len);
        if n > N {
            self.len = LOST;
            return;
        }
        let (xa, xb) = (a.extension(), b.extension() ^ flip);
        // A difference is the sum with the complement and one.
        let mut carry = (flip & 1) != 0;
        for i in 0..n {
            let x = if i < a.len { a.limbs[i] } else { xa };
            let y = if i < b.len { b.limbs[i] ^ flip } else { xb };
            let (s, c1) = x.overflowing_add(y);
            let (s, c2) = s.overflowing_add(carry as u64);
            self.limbs[i] = s;
            carry = c1 | c2;
        }
        self.len = n;
        // The limb above: sign extensions and the carry.
        let top = xa.wrapping_add(xb).wrapping_add(carry as u64);
        if top == self.extension() {
            self.trim();
        } else if n == N {
            self.len = LOST;
        } else {
            self.limbs[n] = top;
            self.len = n + 1;
        }
    }

    /// Factors of at most two limbs, without loops; needs four limbs.
    #[inline(never)]
    fn set_product_of_two(&mut self, a: &Self, b: &Self) {
        let (a, b) = (a.narrow(), b.narrow());
        let (a0, a1) = (a as u64 as i128, (a >> 64) as i64 as i128);
        let (b0, b1) = (b as u64 as i128, (b >> 64) as i64 as i128);
        // a = a1 2^64 + a0 with the sign in a1; a0 b0 is unsigned, all others fit i128 with their carries.
        let low = a0 as u128 * b0 as u128;
        let middle = a1 * b0 + (low >> 64) as i128;
        let other = a0 * b1 + (middle as u64) as i128;
        let high = a1 * b1 + (middle >> 64) + (other >> 64);
        self.limbs[0] = low as u64;
        self.limbs[1] = other as u64;
        self.limbs[2] = high as u64;
        self.limbs[3] = (high >> 64) as u64;
        self.len = 4;
        self.trim();
    }

    #[inline(never)]
    fn set_product(&mut self, a: &Self, b: &Self) {
        let (la, lb) = (a.len, b.len);
        let n = (la + lb).min(N);
        // |a b| <= 2^(bits + bits) must be below 2^(64 N - 1).
        if la.max(lb) > N || (la + lb > N && a.bits() + b.bits() >= 64 * N - 1) {
            self.len = LOST;
            return;
        }
        // As unsigned numbers first, then a negative factor takes the other, shifted by its length, away again.
        let (a, b) = (&a.limbs[..la], &b.limbs[..lb]);
        let limbs = &mut self.limbs;
        limbs[..n].fill(0);
        for (i, &x) in a.iter().enumerate() {
            let mut carry = 0u64;
            let row = &mut limbs[i..n.min(i + lb + 1)];
            let take = row.len().min(lb);
            for (r, &y) in row[..take].iter_mut().zip(b) {
                let t = x as u128 * y as u128 + *r as u128 + carry as u128;
                *r = t as u64;
                carry = (t >> 64) as u64;
            }
            if row.len() > lb {
                row[lb] = carry;
            }
        }
        if (a[la - 1] as i64) < 0 {
            take_away(&mut limbs[la.min(n)..n], b);
        }
        if (b[lb - 1] as i64) < 0 {
            take_away(&mut limbs[lb.min(n)..n], a);
        }
        self.len = n;
        self.trim();
    }
}

/// to -= what, without what is beyond the end of `to`.
#[inline(always)]
fn take_away(to: &mut [u64], what: &[u64]) {
    let mut borrow = false;
    for (t, &w) in to.iter_mut().zip(what) {
        let (s, b1) = t.overflowing_sub(w);
        let (s, b2) = s.overflowing_sub(borrow as u64);
        *t = s;
        borrow = b1 | b2;
    }
}

impl<const N: usize> Ring for Int<N> {
    #[inline(always)]
    fn plus(&self, o: &Self) -> Self {
        let mut r = Self::ZERO;
        r.set_sum(self, o, 0);
        r
    }
    #[inline(always)]
    fn minus(&self, o: &Self) -> Self {
        let mut r = Self::ZERO;
        r.set_sum(self, o, u64::MAX);
        r
    }
    #[inline(always)]
    fn times(&self, o: &Self) -> Self {
        let mut r = Self::ZERO;
        if self.len == 1 && o.len == 1 {
            r.set(self.limbs[0] as i64 as i128 * o.limbs[0] as i64 as i128);
        } else if N >= 4 && self.len <= 2 && o.len <= 2 {
            r.set_product_of_two(self, o);
        } else {
            r.set_product(self, o);
        }
        r
    }
    #[inline]
    fn negated(&self) -> Self {
        let mut r = Self::ZERO;
        r.set_sum(&Self::ZERO, self, u64::MAX);
        r
    }
    #[inline]
    fn minor(a: &Self, b: &Self, c: &Self, d: &Self) -> Self {
        // One limb each: two products below 2^126 or equal to it, whose difference always fits.
        if a.len | b.len | c.len | d.len == 1 {
            let mut r = Self::ZERO;
            r.set(a.limb() * d.limb() - b.limb() * c.limb());
            return r;
        }
        a.times(d).minus(&b.times(c))
    }
    #[inline]
    fn dot(a: &[Self; 3], b: &[Self; 3]) -> Self {
        if a[0].len | a[1].len | a[2].len | b[0].len | b[1].len | b[2].len == 1 {
            let (s, o1) = (a[0].limb() * b[0].limb()).overflowing_add(a[1].limb() * b[1].limb());
            let (s, o2) = s.overflowing_add(a[2].limb() * b[2].limb());
            if !(o1 | o2) {
                let mut r = Self::ZERO;
                r.set(s);
                return r;
            }
        }
        a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
    }
    #[inline]
    fn plane_value(p: &[Self; 4], v: &[Self; 3]) -> Self {
        // Offsets end lower than normals do, so two limbs are common there.
        if p[0].len | p[1].len | p[2].len | v[0].len | v[1].len | v[2].len == 1 && p[3].len <= 2 {
            let (s, o1) = (p[0].limb() * v[0].limb()).overflowing_add(p[1].limb() * v[1].limb());
            let (s, o2) = s.overflowing_add(p[2].limb() * v[2].limb());
            let (s, o3) = s.overflowing_add(p[3].narrow());
            if !(o1 | o2 | o3) {
                let mut r = Self::ZERO;
                r.set(s);
                return r;
            }
        }
        p[0].times(&v[0]).plus(&p[1].times(&v[1])).plus(&p[2].times(&v[2])).plus(&p[3])
    }
}

/// Inputs on a common exponent: coordinates are x 2^-e.
pub struct IntKernel<const N: usize> {
    pub e: i32,
}

impl<const N: usize> Kernel for IntKernel<N> {
    type N = Int<N>;
    #[inline(always)]
    fn coordinate(&self, x: f64) -> Int<N> {
        Int::scaled(x, self.e)
    }
    #[inline]
    fn plane(&self, p: &Plane) -> [Int<N>; 4] {
        let s = plane_exponent(p, self.e);
        [Int::scaled(p.n[0], s), Int::scaled(p.n[1], s), Int::scaled(p.n[2], s), Int::scaled(p.d, s + self.e)]
    }
    #[inline]
    fn row<const M: usize>(&self, row: &Row<'_, M>) -> [Int<N>; M] {
        let mut r = [Int::ZERO; M];
        set_row(&mut r, row);
        r
    }
    #[inline]
    fn matrix<const M: usize>(&self, rows: &[Row<'_, M>; M]) -> [[Int<N>; M]; M] {
        let mut r = [[Int::ZERO; M]; M];
        for (r, row) in r.iter_mut().zip(rows) {
            set_row(r, row);
        }
        r
    }
    #[inline(always)]
    fn one(&self) -> Int<N> {
        Int::small(1)
    }
}

#[inline]
fn set_row<const N: usize, const M: usize>(r: &mut [Int<N>; M], row: &Row<'_, M>) {
    let s = row_exponent(row);
    match row {
        Row::Values(a) => r.iter_mut().zip(*a).for_each(|(r, &a)| r.set_scaled(a, s)),
        Row::Difference(a, b) => {
            for (r, (&a, &b)) in r.iter_mut().zip(a.iter().zip(*b)) {
                r.set_sum(&Int::scaled(a, s), &Int::scaled(b, s), u64::MAX);
            }
        }
        Row::Ones => r.iter_mut().for_each(|r| r.set(1)),
    }
}

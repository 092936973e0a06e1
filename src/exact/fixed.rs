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

impl<const N: usize> Int<N> {
    #[inline(always)]
    pub fn small(x: i64) -> Self {
        let mut limbs = [0; N];
        limbs[0] = x as u64;
        Self { len: 1, limbs }
    }

    #[inline(always)]
    fn lost() -> Self {
        Self { len: LOST, limbs: [0; N] }
    }

    #[inline(always)]
    fn wide(x: i128) -> Self {
        let mut limbs = [0; N];
        limbs[0] = x as u64;
        limbs[1] = (x >> 64) as u64;
        let len = if (x as i64) as i128 == x { 1 } else { 2 };
        Self { len, limbs }
    }

    /// x 2^-e, where `e` is at most the exponent of the lowest set bit of `x`.
    #[inline(always)]
    pub fn scaled(x: f64, e: i32) -> Self {
        let (m, s) = split(x);
        let shift = s - e;
        if shift <= 10 {
            // Shifted right, only zeros leave; `m` is zero when the shift would exceed its bits.
            let m = if shift < 0 { m.unbounded_shr(-shift as u32) } else { m << shift };
            return Self::small(if x < 0.0 { -(m as i64) } else { m as i64 });
        }
        Self::scaled_far(m, shift as usize, x < 0.0)
    }

    #[inline(never)]
    fn scaled_far(m: u64, shift: usize, negative: bool) -> Self {
        if m == 0 {
            return Self::small(0);
        }
        let (word, bit) = (shift / 64, shift % 64);
        if word + 2 > N {
            return Self::lost();
        }
        let m = (m as u128) << bit;
        let mut limbs = [0; N];
        limbs[word] = m as u64;
        limbs[word + 1] = (m >> 64) as u64;
        // The bits may fill the upper limb only up to bit 52 + 63 of two limbs, so that there is room for the sign.
        let r = Self { len: word + 2, limbs }.trimmed();
        if negative { r.negated() } else { r }
    }

    #[inline(always)]
    fn trimmed(mut self) -> Self {
        while self.len > 1 && self.limbs[self.len - 1] == ((self.limbs[self.len - 2] as i64) >> 63) as u64 {
            self.len -= 1;
        }
        self
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

    /// self + (o ^ flip) + carry: a sum for (0, 0), a difference for (all ones, 1).
    #[inline(always)]
    fn combined(&self, o: &Self, flip: u64) -> Self {
        if self.len == 1 && o.len == 1 {
            let (a, b) = (self.limbs[0] as i64 as i128, o.limbs[0] as i64 as i128);
            return Self::wide(if flip == 0 { a + b } else { a - b });
        }
        let n = self.len.max(o.len);
        if n > N {
            return Self::lost();
        }
        let (xa, xb) = (self.extension(), o.extension() ^ flip);
        let mut limbs = [0; N];
        let mut carry = (flip & 1) != 0;
        for (i, limb) in limbs[..n].iter_mut().enumerate() {
            let a = if i < self.len { self.limbs[i] } else { xa };
            let b = if i < o.len { o.limbs[i] ^ flip } else { xb };
            let (s, c1) = a.overflowing_add(b);
            let (s, c2) = s.overflowing_add(carry as u64);
            *limb = s;
            carry = c1 | c2;
        }
        // The limb above: sign extensions and the carry.
        let top = xa.wrapping_add(xb).wrapping_add(carry as u64);
        let mut len = n;
        if top != ((limbs[n - 1] as i64) >> 63) as u64 {
            if n == N {
                return Self::lost();
            }
            limbs[n] = top;
            len = n + 1;
        }
        Self { len, limbs }.trimmed()
    }

    #[inline(never)]
    fn product(&self, o: &Self) -> Self {
        let (la, lb) = (self.len, o.len);
        let full = la + lb;
        let n = if full > N {
            // |x y| <= 2^(bits + bits) must be below 2^(64 N - 1).
            if full > 2 * N || self.bits() + o.bits() >= 64 * N - 1 {
                return Self::lost();
            }
            N
        } else {
            full
        };
        // As unsigned numbers first, then a negative factor takes the other, shifted by its length, away again.
        let mut limbs = [0u64; N];
        let b = &o.limbs[..lb];
        for (i, &a) in self.limbs[..la].iter().enumerate() {
            let mut carry = 0u64;
            let row = &mut limbs[i..n.min(i + lb + 1)];
            let take = row.len().min(lb);
            for (r, &b) in row[..take].iter_mut().zip(b) {
                let t = a as u128 * b as u128 + *r as u128 + carry as u128;
                *r = t as u64;
                carry = (t >> 64) as u64;
            }
            if row.len() > lb {
                row[lb] = carry;
            }
        }
        if (self.limbs[la - 1] as i64) < 0 {
            take_away(&mut limbs[la.min(n)..n], b);
        }
        if (b[lb - 1] as i64) < 0 {
            take_away(&mut limbs[lb.min(n)..n], &self.limbs[..la]);
        }
        Self { len: n, limbs }.trimmed()
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
    #[inline]
    fn plus(&self, o: &Self) -> Self {
        self.combined(o, 0)
    }
    #[inline]
    fn minus(&self, o: &Self) -> Self {
        self.combined(o, u64::MAX)
    }
    #[inline]
    fn times(&self, o: &Self) -> Self {
        if self.len == 1 && o.len == 1 {
            return Self::wide(self.limbs[0] as i64 as i128 * o.limbs[0] as i64 as i128);
        }
        self.product(o)
    }
    #[inline]
    fn negated(&self) -> Self {
        Self::small(0).minus(self)
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
    fn row<const M: usize>(&self, r: &Row<'_, M>) -> [Int<N>; M] {
        let s = row_exponent(r);
        match r {
            Row::Values(a) => a.map(|x| Int::scaled(x, s)),
            Row::Difference(a, b) => std::array::from_fn(|i| Int::scaled(a[i], s).minus(&Int::scaled(b[i], s))),
            Row::Ones => [Int::small(1); M],
        }
    }
    #[inline(always)]
    fn one(&self) -> Int<N> {
        Int::small(1)
    }
}

//! The tiers behind every predicate: value with error bound, integers on the stack (three widths), integers of any
//! size. Each tier either knows the sign or passes; the last one always knows. The zero of a degenerate input
//! is an ordinary case: it costs one bounded and one integer evaluation, on the stack.

use super::Sign;
use super::big::{self, BigKernel};
use super::bounded::BoundedKernel;
use super::counters::{Tier, count};
use super::fixed::{Int, IntKernel};
use super::lift::Scan;
use super::ring::Expression;

/// The sign of an expression, whatever it takes.
#[inline]
pub fn sign_of<const M: usize, E: Expression<M>>(x: &E) -> Sign {
    match bounded_sign(x) {
        Some(s) => {
            count(E::PREDICATE, Tier::Bounded);
            s
        }
        None => exact_sign(x),
    }
}

/// Tier (c) alone.
#[doc(hidden)]
#[inline]
pub fn bounded_sign<const M: usize, E: Expression<M>>(x: &E) -> Option<Sign> {
    let mut s = Sign::Positive;
    for f in x.eval(&BoundedKernel) {
        s = s * f.sign()?;
    }
    Some(s)
}

/// Tiers (d) and (e).
#[cold]
#[inline(never)]
pub fn exact_sign<const M: usize, E: Expression<M>>(x: &E) -> Sign {
    let scan = Scan::new();
    x.eval(&scan);
    let e = scan.exponent();
    let s = fixed_sign_at::<M, 8, E>(x, e)
        .or_else(|| fixed_sign_at::<M, 16, E>(x, e))
        .or_else(|| fixed_sign_at::<M, 32, E>(x, e));
    match s {
        Some(s) => {
            count(E::PREDICATE, Tier::Exact);
            s
        }
        None => {
            count(E::PREDICATE, Tier::Big);
            big_sign(x)
        }
    }
}

fn fixed_sign_at<const M: usize, const N: usize, E: Expression<M>>(x: &E, e: i32) -> Option<Sign> {
    let mut s = Sign::Positive;
    for f in x.eval(&IntKernel::<N> { e }) {
        let f: Int<N> = f;
        s = s * f.sign()?;
    }
    Some(s)
}

/// Tier (d) alone, with `N` limbs.
#[doc(hidden)]
pub fn fixed_sign<const M: usize, const N: usize, E: Expression<M>>(x: &E) -> Option<Sign> {
    let scan = Scan::new();
    x.eval(&scan);
    fixed_sign_at::<M, N, E>(x, scan.exponent())
}

/// Tier (e) alone.
#[doc(hidden)]
#[inline(never)]
pub fn big_sign<const M: usize, E: Expression<M>>(x: &E) -> Sign {
    let scan = Scan::new();
    x.eval(&scan);
    let mut s = Sign::Positive;
    for f in x.eval(&BigKernel { e: scan.exponent() }) {
        s = s * big::sign(&f);
    }
    s
}

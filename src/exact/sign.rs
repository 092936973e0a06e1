//! The answer of a predicate. Never an `f64`: a sign is known or it is not returned.

use std::cmp::Ordering;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i8)]
pub enum Sign {
    Negative = -1,
    Zero = 0,
    Positive = 1,
}

impl Sign {
    /// The sign of a number that is exactly known. NaN has none (debug builds stop there).
    #[inline(always)]
    pub fn of(x: f64) -> Self {
        debug_assert!(!x.is_nan());
        if x > 0.0 {
            Sign::Positive
        } else if x < 0.0 {
            Sign::Negative
        } else {
            Sign::Zero
        }
    }

    #[inline(always)]
    pub fn is_zero(self) -> bool {
        self == Sign::Zero
    }

    #[inline(always)]
    pub fn to_i8(self) -> i8 {
        self as i8
    }

    /// The sign of `x - y`, from their order.
    #[inline(always)]
    pub fn from_ordering(o: Ordering) -> Self {
        match o {
            Ordering::Less => Sign::Negative,
            Ordering::Equal => Sign::Zero,
            Ordering::Greater => Sign::Positive,
        }
    }

    /// The order of `x` and `y`, from the sign of `x - y`.
    #[inline(always)]
    pub fn to_ordering(self) -> Ordering {
        match self {
            Sign::Negative => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Positive => Ordering::Greater,
        }
    }
}

impl std::ops::Neg for Sign {
    type Output = Sign;
    #[inline(always)]
    fn neg(self) -> Sign {
        match self {
            Sign::Negative => Sign::Positive,
            Sign::Zero => Sign::Zero,
            Sign::Positive => Sign::Negative,
        }
    }
}

impl std::ops::Mul for Sign {
    type Output = Sign;
    #[inline(always)]
    fn mul(self, o: Sign) -> Sign {
        match self {
            Sign::Negative => -o,
            Sign::Zero => Sign::Zero,
            Sign::Positive => o,
        }
    }
}

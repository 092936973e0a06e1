//! Determinants of function values at the corners of a simplex, for networks. A row is a function, or the difference of
//! two functions, taken exactly. Rows are scaled one by one by powers of two of their own, so functions of very different
//! magnitudes do not widen each other.

use super::Sign;
use super::counters::Predicate;
use super::ring::{Expression, Kernel, Ring};
use super::tiers::sign_of;

/// A row of a determinant.
#[derive(Clone, Copy, Debug)]
pub enum Row<'a, const M: usize> {
    Values(&'a [f64; M]),
    /// First minus second, exactly (never rounded).
    Difference(&'a [f64; M], &'a [f64; M]),
    Ones,
}

/// Determinants of 1 to 4 rows.
#[doc(hidden)]
pub struct RowDeterminant<'a, const M: usize>(pub &'a [Row<'a, M>; M]);

impl<const M: usize> Expression<1> for RowDeterminant<'_, M> {
    const PREDICATE: Predicate = Predicate::Barycentric;
    #[inline]
    fn eval<K: Kernel>(&self, k: &K) -> [K::N; 1] {
        [determinant(&k.matrix(self.0))]
    }
}

/// Laplace by the last rows' minors; at most 4x4 (checked by the compiler).
#[inline(always)]
fn determinant<const M: usize, N: Ring>(m: &[[N; M]; M]) -> N {
    const { assert!(M >= 1 && M <= 4) };
    // Minor of two columns in the last two rows; of three columns in the last three.
    let minor2 = |i: usize, j: usize| {
        let (r, s) = (&m[M - 2], &m[M - 1]);
        r[i].times(&s[j]).minus(&r[j].times(&s[i]))
    };
    match M {
        1 => m[0][0].clone(),
        2 => minor2(0, 1),
        3 => {
            let r = &m[0];
            r[0].times(&minor2(1, 2)).minus(&r[1].times(&minor2(0, 2))).plus(&r[2].times(&minor2(0, 1)))
        }
        _ => {
            // Six minors of the lower rows, shared by the four 3x3 minors.
            let (p01, p02, p03) = (minor2(0, 1), minor2(0, 2), minor2(0, 3));
            let (p12, p13, p23) = (minor2(1, 2), minor2(1, 3), minor2(2, 3));
            let r = &m[M - 3];
            let c0 = r[1].times(&p23).minus(&r[2].times(&p13)).plus(&r[3].times(&p12));
            let c1 = r[0].times(&p23).minus(&r[2].times(&p03)).plus(&r[3].times(&p02));
            let c2 = r[0].times(&p13).minus(&r[1].times(&p03)).plus(&r[3].times(&p01));
            let c3 = r[0].times(&p12).minus(&r[1].times(&p02)).plus(&r[2].times(&p01));
            let t = &m[0];
            t[0].times(&c0).minus(&t[1].times(&c1)).plus(&t[2].times(&c2)).minus(&t[3].times(&c3))
        }
    }
}

/// Sign of the determinant with these rows. Cost: some 20 ns where the bound decides, some 100 ns for a zero of ordinary values.
pub fn determinant_of_rows<const M: usize>(rows: &[Row<'_, M>; M]) -> Sign {
    sign_of(&RowDeterminant(rows))
}

//! Barycentric predicates (section 5.2 of the networks paper): signs of linear functions at points of a simplex that are given by the
//! functions that vanish there, from the corner values alone.
//!
//! A point of an open sub-simplex of dimension d, its *carrier*, is where d independent functions g_1..g_d vanish. With A the matrix of
//! their values at the carrier's corners and a last row of ones, f(x) = det(g_1, .., g_d, f) / det(A). All
//! barycentric coordinates of x are positive, and they are the cofactors of that last row over det(A): so one d x d minor
//! has the sign of det(A), and the row of ones is never needed. Differences of functions enter exactly, unrounded.
//!
//! Degenerate cases: d = 0 (a corner) is the sign of one value or one comparison. Functions that do not meet the carrier in one
//! point have no orientation (zero), and every sign at their "point" is zero.

use super::Sign;
use super::rows::{Row, determinant_of_rows};
use std::cmp::Ordering;

/// A linear function on a simplex by its values at all corners (as many as the simplex has).
#[derive(Clone, Copy, Debug)]
pub enum Function<'a> {
    Values(&'a [f64]),
    /// First minus second, exactly.
    Difference(&'a [f64], &'a [f64]),
}

/// Sign of the determinant of one to four functions at as many corners; bit c of `corners` takes corner c.
pub fn determinant(corners: u8, functions: &[Function<'_>]) -> Sign {
    debug_assert_eq!(corners.count_ones() as usize, functions.len());
    match functions.len() {
        1 => {
            let c = corners.trailing_zeros() as usize;
            match functions[0] {
                Function::Values(f) => Sign::of(f[c]),
                // Comparing doubles is exact, subtracting them is not.
                Function::Difference(f, g) => {
                    Sign::from_ordering(f[c].partial_cmp(&g[c]).expect("finite function values"))
                }
            }
        }
        2 => sized::<2>(corners, functions),
        3 => sized::<3>(corners, functions),
        4 => sized::<4>(corners, functions),
        n => panic!("a determinant of {n} functions in a simplex"),
    }
}

fn sized<const M: usize>(corners: u8, functions: &[Function<'_>]) -> Sign {
    let mut at = [0; M];
    let mut rest = corners;
    for c in &mut at {
        *c = rest.trailing_zeros() as usize;
        rest &= rest - 1;
    }
    let pick = |f: &[f64]| at.map(|c| f[c]);
    let values: [[[f64; M]; 2]; M] = std::array::from_fn(|i| match functions[i] {
        Function::Values(f) => [pick(f), [0.0; M]],
        Function::Difference(f, g) => [pick(f), pick(g)],
    });
    let rows: [Row<'_, M>; M] = std::array::from_fn(|i| match functions[i] {
        Function::Values(_) => Row::Values(&values[i][0]),
        Function::Difference(..) => Row::Difference(&values[i][0], &values[i][1]),
    });
    determinant_of_rows(&rows)
}

/// Sign of det(A) for the point of the open sub-simplex `carrier` where the functions `through` (one fewer than it has corners)
/// vanish. It depends on the order of `through`.
pub fn orientation(carrier: u8, through: &[Function<'_>]) -> Sign {
    if through.is_empty() {
        return Sign::Positive;
    }
    // The cofactor of the last corner, which stands on the diagonal.
    let last = 1 << (7 - carrier.leading_zeros());
    determinant(carrier & !last, through)
}

/// Sign of `f` at that point, its orientation known.
pub fn oriented_sign(carrier: u8, through: &[Function<'_>], orientation: Sign, f: Function<'_>) -> Sign {
    let mut rows = [f; 4];
    rows[..through.len()].copy_from_slice(through);
    determinant(carrier, &rows[..through.len() + 1]) * orientation
}

/// Sign of `f` at the point of the open sub-simplex `carrier` where the functions `through` vanish. Cost: some 40 ns where
/// error bounds decide, some 200 ns for a zero of ordinary values.
pub fn sign_at(carrier: u8, through: &[Function<'_>], f: Function<'_>) -> Sign {
    oriented_sign(carrier, through, orientation(carrier, through), f)
}

/// How many distinct zero sets the facets of a simplex of dimension `dim` and the functions have (functions that vanish
/// everywhere have none). Function-major values. Also where they lie outside of the simplex. Cost: O(n log n).
pub fn distinct_planes(dim: usize, values: &[f64]) -> usize {
    let m = dim + 1;
    let units: Vec<f64> = (0..m * m).map(|i| (i / m == i % m) as u8 as f64).collect();
    let mut rows: Vec<(usize, &[f64])> = units
        .chunks_exact(m)
        .chain(values.chunks_exact(m))
        .filter_map(|row| Some((row.iter().position(|&x| x != 0.0)?, row)))
        .collect();
    rows.sort_unstable_by(|a, b| compare_directions(*a, *b));
    rows.chunk_by(|a, b| compare_directions(*a, *b).is_eq()).count()
}

/// Orders rows by their first corner with a value, then by the ratios of the others to that: rounded quotients are monotonous, so only
/// equal ones are compared exactly.
fn compare_directions((i, a): (usize, &[f64]), (j, b): (usize, &[f64])) -> Ordering {
    let ratio = |k: usize| {
        let (x, y) = (a[k] / a[i], b[k] / b[i]);
        if x != y {
            return x.partial_cmp(&y).expect("finite function values");
        }
        // b_i/a_i of both: x/p against y/q is x q - y p over p q.
        let s = determinant_of_rows(&[Row::Values(&[a[k], a[i]]), Row::Values(&[b[k], b[i]])]);
        (s * Sign::of(a[i]) * Sign::of(b[i])).to_ordering()
    };
    i.cmp(&j).then_with(|| (i + 1..a.len()).map(ratio).find(|o| o.is_ne()).unwrap_or(Ordering::Equal))
}

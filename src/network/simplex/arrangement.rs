//! The arrangement of linear functions in one simplex (section 4.1).

use super::data::{Scratch, SimplexComplex};

/// The arrangement of `values.len() / (dim + 1)` functions (any number, none included) in a simplex of dimension `dim` (2 or 3).
/// `values`: finite, function-major, `values[f * (dim + 1) + corner]`.
pub fn arrangement(dim: usize, values: &[f64], _scratch: &mut Scratch, out: &mut SimplexComplex) {
    debug_assert!(dim == 2 || dim == 3);
    out.dim = dim;
    out.functions = values.len() / (dim + 1);
}

//! The upper envelope of materials in one simplex (section 4.2).

use super::data::{Scratch, SimplexComplex};

/// The material interface of `values.len() / (dim + 1)` materials (at least one) in a simplex of dimension `dim` (2 or 3).
/// `values`: finite, material-major, `values[m * (dim + 1) + corner]`.
pub fn interface(dim: usize, values: &[f64], _scratch: &mut Scratch, out: &mut SimplexComplex) {
    debug_assert!(dim == 2 || dim == 3);
    out.dim = dim;
    out.functions = values.len() / (dim + 1);
}

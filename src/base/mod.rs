//! The ground under the floors: typed ids, flat CSR arrays, errors with named culprits, boolean expressions as text, and the run control
//! (progress, cancel, log) that every engine takes.

pub mod bits;
pub mod blocks;
pub mod csr;
pub mod error;
pub mod expression;
pub mod few;
pub mod ids;
pub mod parallel;
pub mod processor;
pub mod run;
pub mod union_find;
pub mod vector;

pub use csr::Csr;
pub use error::{Culprit, DefectKind, Error, Result, Status};
pub use ids::*;
pub use run::{Run, Watch};
pub use union_find::{SharedUnionFind, UnionFind};

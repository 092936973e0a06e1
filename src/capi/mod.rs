//! The C boundary: one file per C noun, nothing but conversion, checking and guarding (DESIGN §8).
//!
//! The doc comments of the `extern "C"` functions are the manual: cbindgen copies them into `include/lapidary.h`
//! (see `build.rs`), in the order of the files below.
//!
//! Invariants of every function here:
//! - it returns an `i32` status and runs its body in [`guard`]: clean floating-point environment, no panic leaves;
//! - a pointer is read or written only after the null check, and only for the extent that its doc comment states;
//! - ids and offsets are handed out as `i32` views of our `u32` arrays: [`cut`] refuses a complex in which a count
//!   exceeds `i32::MAX`, and `NONE` (all bits set) reads as −1.
// The names are those of the C interface, and its contract on pointers is each function's doc comment.
#![allow(non_camel_case_types, clippy::missing_safety_doc)]

pub mod arrangement;
pub mod arrangement_extract;
pub mod arrangement_views;
pub mod certify;
pub mod complex;
pub mod context;
pub mod cut;
pub mod derived;
mod fpenv;
pub mod grid;
pub mod grid_boxes;
pub mod grid_cells;
pub mod grid_fluid;
pub mod grid_moments;
mod guard;
pub mod keys;
pub mod mesh;
pub mod network;
pub mod network_surface;
pub mod network_views;
pub mod simplex;
pub mod status;
pub mod surface;
pub mod surface_certify;
mod view;

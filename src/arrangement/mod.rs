//! Arrangements of triangle meshes: the cells into which any number of meshes divide space, each with its winding-number vector; booleans are an
//! extraction from it (the Mesh Arrangements paper, DESIGN §6).
//!
//! Stages in pipeline order: `soup` → `candidates` → `intersect` → `clusters` → `crossings` → `triangulate` → `resolve` → `patches` →
//! `cells` (with `nesting`) → `winding` → `extract`.

pub mod data;

pub use data::*;

//! Lapidary partitions 3-D space exactly. See `docs/architecture.md` for the house and where to start reading.

pub mod arrangement;
pub mod base;
pub mod capi;
pub mod complex;
pub mod cut;
pub mod exact;
pub mod grid;
pub mod mesh;
pub mod network;

#[global_allocator]
static BLOCKS: base::blocks::Blocks = base::blocks::Blocks;

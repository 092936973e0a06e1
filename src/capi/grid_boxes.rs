//! The noun `lap_grid`, second part: the block's boxes and the way from them to cells, as borrowed views.

use super::derived::on_demand;
use super::grid::lap_grid;
use super::guard::guard;
use super::view::{address, handle, index, put};
use crate::base::{BoxId, Status};
use crate::grid::{CUT, EMPTY, FULL, GridCells, Lattice};
use std::sync::OnceLock;

/// What is computed at the first call.
#[derive(Default)]
pub struct Boxes {
    /// Empty, full and cut boxes.
    tally: OnceLock<[i64; 3]>,
    offsets: OnceLock<Vec<u32>>,
}

/// The block in the whole grid, as C reads it.
pub struct Shape {
    boxes: [i64; 3],
    first: [i64; 3],
    total: [i64; 3],
}

impl Shape {
    pub fn of(lattice: &Lattice) -> Self {
        Self {
            boxes: std::array::from_fn(|a| lattice.count(a) as i64),
            first: lattice.first,
            total: lattice.total.map(|nodes| nodes - 1),
        }
    }
}

impl lap_grid {
    /// A box of the block, by its place from the low corner.
    pub fn box_id(&self, at: [i32; 3]) -> Result<BoxId, Status> {
        let mut checked = [0; 3];
        for (a, i) in at.into_iter().enumerate() {
            checked[a] = index(i, self.data.lattice.count(a))?;
        }
        Ok(self.data.lattice.box_id(checked))
    }
}

/// The block and the whole grid.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): boxes: 3 numbers, the boxes of the block along x, y, z; first:
/// 3 numbers, the indices of the block's first box in the whole grid; total: 3 numbers, the boxes of the whole grid;
/// x, y, z: boxes[0] + 1, boxes[1] + 1, boxes[2] + 1 coordinates of the block's nodes, as given (-0 as 0).
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_block(
    grid: *const lap_grid,
    boxes: *mut *const i64,
    first: *mut *const i64,
    total: *mut *const i64,
    x: *mut *const f64,
    y: *mut *const f64,
    z: *mut *const f64,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let nodes = &grid.data.lattice.nodes;
        unsafe {
            put(boxes, address(&grid.shape.boxes));
            put(first, address(&grid.shape.first));
            put(total, address(&grid.shape.total));
            put(x, address(&nodes[0]));
            put(y, address(&nodes[1]));
            put(z, address(&nodes[2]));
        }
        Ok(())
    })
}

/// How many boxes there are of each kind, and how many elements the cut boxes have: cells; faces, of which the first so many
/// are walls; vertices.
///
/// Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: one pass over the flags
/// at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_counts(
    grid: *const lap_grid,
    empty: *mut i64,
    full: *mut i64,
    cut: *mut i64,
    cells: *mut i64,
    faces: *mut i64,
    walls: *mut i64,
    vertices: *mut i64,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let tally = grid.boxes.tally.get_or_init(|| tally(&grid.data));
        unsafe {
            put(empty, tally[EMPTY as usize]);
            put(full, tally[FULL as usize]);
            put(cut, tally[CUT as usize]);
            put(cells, grid.data.cell_count() as i64);
            put(faces, grid.data.face_count() as i64);
            put(walls, grid.data.wall_count() as i64);
            put(vertices, grid.data.coords.len() as i64);
        }
        Ok(())
    })
}

fn tally(g: &GridCells) -> [i64; 3] {
    let full = g.flags.iter().filter(|&&flag| flag == FULL).count();
    let cut = g.cut_boxes.len();
    [g.flags.len() - full - cut, full, cut].map(|n| n as i64)
}

/// What each box is: LAP_BOX_EMPTY, LAP_BOX_FULL or LAP_BOX_CUT.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of boxes of the block; flags: count, box
/// (i, j, k) at i + nx (j + ny k).
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_flags(grid: *const lap_grid, count: *mut i64, flags: *mut *const u8) -> i32 {
    guard(|_| {
        let g = &unsafe { handle(grid) }?.data;
        unsafe {
            put(count, g.flags.len() as i64);
            put(flags, address(&g.flags));
        }
        Ok(())
    })
}

/// The boxes that are cut, and their cells.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut boxes; boxes: count numbers of
/// boxes, rising; box_cells: count + 1: box boxes[i] has the cells box_cells[i] up to, not including, box_cells[i + 1].
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_cut_boxes(
    grid: *const lap_grid,
    count: *mut i64,
    boxes: *mut *const i32,
    box_cells: *mut *const i32,
) -> i32 {
    guard(|_| {
        let g = &unsafe { handle(grid) }?.data;
        unsafe {
            put(count, g.cut_boxes.len() as i64);
            put(boxes, address(&g.cut_boxes));
            put(box_cells, address(&g.box_cells));
        }
        Ok(())
    })
}

/// From every box to its cells, for those who have the memory: as lap_grid_cut_boxes, but for all boxes.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of boxes; offsets: count + 1: box b has the
/// cells offsets[b] up to, not including, offsets[b + 1]; none unless it is cut.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: 4 bytes per box and a pass over them at the first
/// call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_box_cells(grid: *const lap_grid, count: *mut i64, offsets: *mut *const i32) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let all = on_demand(grid.threads, &grid.boxes.offsets, || box_offsets(&grid.data))?;
        unsafe {
            put(count, all.len() as i64 - 1);
            put(offsets, address(all));
        }
        Ok(())
    })
}

fn box_offsets(g: &GridCells) -> Vec<u32> {
    let mut offsets = Vec::with_capacity(g.flags.len() + 1);
    for (i, b) in g.cut_boxes.iter().enumerate() {
        offsets.resize(b.at() + 1, g.box_cells[i]);
    }
    offsets.resize(g.flags.len() + 1, g.cell_count() as u32);
    offsets
}

/// One box of the block: what it is, and its cells.
///
/// i, j, k: the box, from the block's low corner. Outputs (each may be NULL): flag: LAP_BOX_*; first: its first cell, 0
/// unless it is cut; count: the number of its cells, 0 unless it is cut.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_BAD_ARGUMENT for a box outside the block. Threads: any. Cost: a
/// binary search.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_box(
    grid: *const lap_grid,
    i: i32,
    j: i32,
    k: i32,
    flag: *mut i32,
    first: *mut i32,
    count: *mut i32,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let g = &grid.data;
        let b = grid.box_id([i, j, k])?;
        let cells = g.cells_of(b);
        unsafe {
            put(flag, g.flags[b.at()].into());
            put(first, cells.start as i32);
            put(count, cells.len() as i32);
        }
        Ok(())
    })
}

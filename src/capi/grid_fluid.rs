//! The noun `lap_grid`, fifth part: what connects cells and full boxes: implied faces, links, regions of fluid, aggregates of
//! small cells.

use super::context::{lap_context, with_context};
use super::derived::on_demand;
use super::grid::{lap_grid, null_grid};
use super::grid_moments::of_cells;
use super::guard::guard;
use super::view::{address, handle, index, input, put};
use crate::base::{Error, RegionId, Status};
use crate::grid::aggregate::{AggregateOptions, aggregate};
use crate::grid::full_faces::{FullLinks, full_faces, full_links};
use crate::grid::regions::{PointPlace, Regions, regions};
use std::sync::OnceLock;

/// What is computed at the first call.
#[derive(Default)]
pub struct Fluid {
    links: OnceLock<FullLinks>,
    regions: OnceLock<Regions>,
}

/// Where a point is: not in the fluid.
pub const LAP_REGION_SOLID: i32 = -1;
/// Where a point is: on the surface, exactly.
pub const LAP_REGION_SURFACE: i32 = -2;
/// Where a point is: outside the block's closed box.
pub const LAP_REGION_BEYOND: i32 = -3;

/// The faces of full boxes that are not stored, of one grid plane: squares between two full boxes, and squares of full boxes at
/// the block's boundary. (A square between a full box and a cut one is a face of the cut box: lap_grid_plane_faces.)
///
/// axis: 0, 1, 2 for the planes across x, y, z; node: the plane, from the block's low corner. Outputs (each may be NULL; valid until
/// the next call with this context): count; nodes: count, the number of the lowest node of each square, rising; boxes: 2 × count,
/// the numbers of the full boxes on the lower and on the upper side, -1 beyond the block.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for an axis or a plane that is not there; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: linear in the boxes beside the plane.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_full_faces(
    context: *mut lap_context,
    grid: *const lap_grid,
    axis: i32,
    node: i32,
    count: *mut i64,
    nodes: *mut *const i32,
    boxes: *mut *const i32,
) -> i32 {
    with_context(context, |state, host| {
        let g = &unsafe { handle(grid) }.map_err(null_grid)?.data;
        let axis = index(axis, 3).map_err(|s| Error::new(s, format!("axis: {axis} is none of 0, 1, 2")))?;
        let planes = g.lattice.nodes[axis].len();
        let node = index(node, planes)
            .map_err(|s| Error::new(s, format!("node: {node} is not there: {planes} in all, counted from 0")))?;
        let found = state.run(host, |_| Ok(full_faces(g, axis, node)))?;
        let found = state.hold(found);
        unsafe {
            put(count, found.low_node.len() as i64);
            put(nodes, address(&found.low_node));
            put(boxes, address(&found.boxes));
        }
        Ok(())
    })
}

/// The links from cut cells to full neighbours: those faces in grid planes that have LAP_CELL_FULL on a side.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count; cells: count, the cut cell; faces: count, the face
/// between the two, rising; boxes: count, the number of the full box.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the faces at the first
/// call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_full_links(
    grid: *const lap_grid,
    count: *mut i64,
    cells: *mut *const i32,
    faces: *mut *const i32,
    boxes: *mut *const i32,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let links = on_demand(grid.threads, &grid.fluid.links, || full_links(&grid.data))?;
        unsafe {
            put(count, links.cell.len() as i64);
            put(cells, address(&links.cell));
            put(faces, address(&links.face));
            put(boxes, address(&links.full));
        }
        Ok(())
    })
}

fn regions_of(grid: &lap_grid) -> Result<&Regions, Status> {
    on_demand(grid.threads, &grid.fluid.regions, || regions(&grid.data))
}

/// The connected regions of fluid in the block. Cells and full boxes are connected through faces in grid planes, not along
/// edges or at vertices. Regions are numbered by their lowest box, then cell.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): n_regions: the number of regions; count: the number of cut
/// cells; cell_regions: count, the region of each. For full boxes see lap_grid_box_region and lap_grid_region_runs.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: a pass over the flags, and linear in
/// cells and faces, at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_regions(
    grid: *const lap_grid,
    n_regions: *mut i64,
    count: *mut i64,
    cell_regions: *mut *const i32,
) -> i32 {
    guard(|_| {
        let r = regions_of(unsafe { handle(grid) }?)?;
        unsafe {
            put(n_regions, r.count as i64);
            put(count, r.cell_region.len() as i64);
            put(cell_regions, address(&r.cell_region));
        }
        Ok(())
    })
}

/// The regions of all full boxes, as runs along x.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of rows of boxes, ny nz; row_runs: count + 1:
/// row j + ny k has the runs row_runs[row] up to, not including, row_runs[row + 1]; run_boxes: 2 per run: the boxes numbered
/// run_boxes[2 r] up to, not including, run_boxes[2 r + 1], all of them full, rising; run_regions: one per run.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: as lap_grid_regions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_region_runs(
    grid: *const lap_grid,
    count: *mut i64,
    row_runs: *mut *const i32,
    run_boxes: *mut *const i32,
    run_regions: *mut *const i32,
) -> i32 {
    guard(|_| {
        let r = regions_of(unsafe { handle(grid) }?)?;
        unsafe {
            put(count, r.row_runs.len() as i64 - 1);
            put(row_runs, address(&r.row_runs));
            put(run_boxes, address(&r.run_boxes));
            put(run_regions, address(&r.run_region));
        }
        Ok(())
    })
}

/// The region of a full box.
///
/// i, j, k: the box, from the block's low corner. region: receives its region, -1 if the box is not full (the cells of a
/// cut box may be in several).
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a box outside the block, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: as
/// lap_grid_regions at the first call, then a binary search.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_box_region(grid: *const lap_grid, i: i32, j: i32, k: i32, region: *mut i32) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        if region.is_null() {
            return Err(Status::NullPointer);
        }
        let b = grid.box_id([i, j, k])?;
        unsafe { put(region, regions_of(grid)?.region_of_box(&grid.data, b).0 as i32) };
        Ok(())
    })
}

/// The region that holds a point, exactly. A point on a grid plane belongs to the fluid around it.
///
/// region: receives a region from 0, or LAP_REGION_SOLID, LAP_REGION_SURFACE, LAP_REGION_BEYOND.
///
/// Errors: LAP_ERR_BAD_ARGUMENT if a coordinate is not finite; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: as lap_grid_regions at the first call; linear in the mesh's triangles, and in a cut box some hundred
/// microseconds for each cell of ordinary size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_region_at(
    context: *mut lap_context,
    grid: *const lap_grid,
    x: f64,
    y: f64,
    z: f64,
    region: *mut i32,
) -> i32 {
    with_context(context, |state, host| {
        let grid = unsafe { handle(grid) }.map_err(null_grid)?;
        if region.is_null() {
            return Err(Error::new(Status::NullPointer, "region is NULL"));
        }
        if ![x, y, z].iter().all(|c| c.is_finite()) {
            return Err(Error::new(Status::BadArgument, "the point is not finite"));
        }
        let of = state.run(host, |_| Ok(grid.fluid.regions.get_or_init(|| regions(&grid.data))))?;
        let place = state.run(host, |_| Ok(of.at_point(&grid.data, &[x, y, z])))?;
        let number = match place {
            PointPlace::Region(r) => r.0 as i32,
            PointPlace::Solid => LAP_REGION_SOLID,
            PointPlace::Surface => LAP_REGION_SURFACE,
            PointPlace::Beyond => LAP_REGION_BEYOND,
        };
        unsafe { put(region, number) };
        Ok(())
    })
}

/// What belongs to a region, for example to the one that holds a given point (lap_grid_region_at).
///
/// region: from 0. Outputs (each may be NULL; valid until the next call with this context): n_cells: the number of cut cells;
/// cells: n_cells numbers, 1 for the region's cells, else 0; n_boxes: the number of boxes; boxes: n_boxes numbers, 1
/// for the region's full boxes, else 0.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for a region that is not there; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: as
/// lap_grid_regions at the first call; a byte per box, written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_region_mask(
    context: *mut lap_context,
    grid: *const lap_grid,
    region: i32,
    n_cells: *mut i64,
    cells: *mut *const u8,
    n_boxes: *mut i64,
    boxes: *mut *const u8,
) -> i32 {
    with_context(context, |state, host| {
        let grid = unsafe { handle(grid) }.map_err(null_grid)?;
        let of = state.run(host, |_| Ok(grid.fluid.regions.get_or_init(|| regions(&grid.data))))?;
        let id = index(region, of.count)
            .map_err(|s| Error::new(s, format!("region {region} is not there: {} in all, counted from 0", of.count)))?;
        let masks = state.run(host, |_| Ok(of.mask(&grid.data, RegionId::of(id))))?;
        let (of_cells, of_boxes) = &*state.hold(masks);
        unsafe {
            put(n_cells, of_cells.len() as i64);
            put(cells, address(of_cells));
            put(n_boxes, of_boxes.len() as i64);
            put(boxes, address(of_boxes));
        }
        Ok(())
    })
}

/// Aggregates small cells: maps each cut cell to the cell or the full box that stands for it, so that the volume fractions of
/// what stands together add up to `minimum` at least, where that can be had. Each small aggregate merges across its
/// largest face in a grid plane (ties: the larger fraction beyond, then the lower face), small ones first, until it
/// suffices. The geometry stays as it is, and so do all other arrays.
///
/// Inputs (borrowed for the call): minimum: a volume fraction, from 0; closed_faces: a number per face in a grid plane, in the
/// order of lap_grid_plane_faces, not 0 where nothing may merge across it, or NULL; closed_cells: a number per cut cell, not 0
/// where it may merge with none, or NULL. Outputs (each may be NULL; valid until the next call with this context):
/// count: the number of cut cells; cells: count, the cell that stands for each (itself, for one that stands alone), or
/// LAP_CELL_FULL; boxes: count, the number of the box of that cell, or of the full box; n_small: how many aggregates stay below
/// the minimum; small: n_small cells that stand for them, rising.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for a minimum that is negative or not finite; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: that of lap_grid_cell_moments at the first call; linear in the faces of small cells, times the few
/// rounds in which they merge.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_aggregate(
    context: *mut lap_context,
    grid: *const lap_grid,
    minimum: f64,
    closed_faces: *const u8,
    closed_cells: *const u8,
    count: *mut i64,
    cells: *mut *const i32,
    boxes: *mut *const i32,
    n_small: *mut i64,
    small: *mut *const i32,
) -> i32 {
    with_context(context, |state, host| {
        let grid = unsafe { handle(grid) }.map_err(null_grid)?;
        let g = &grid.data;
        if !(minimum.is_finite() && minimum >= 0.0) {
            return Err(Error::new(Status::BadArgument, format!("minimum: {minimum} is no volume fraction")));
        }
        let marks = |marks: *const u8, count: usize| -> Result<Option<&[u8]>, Error> {
            if marks.is_null() {
                return Ok(None);
            }
            unsafe { input(marks, count as i64) }.map(Some).map_err(|s| Error::new(s, "marks"))
        };
        let closed_faces = marks(closed_faces, g.square_node.len())?;
        let closed_cells = marks(closed_cells, g.cell_count())?;
        let m = of_cells(grid).map_err(|s| Error::new(s, "no threads to be had"))?;
        let options = AggregateOptions { minimum };
        let made = state.run(host, |_| Ok(aggregate(g, m, &options, closed_faces, closed_cells)))?;
        let made = state.hold(made);
        unsafe {
            put(count, made.cell.len() as i64);
            put(cells, address(&made.cell));
            put(boxes, address(&made.in_box));
            put(n_small, made.too_small.len() as i64);
            put(small, address(&made.too_small));
        }
        Ok(())
    })
}

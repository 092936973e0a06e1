//! The noun `lap_grid`, fourth part: the arrays of embedded-boundary solvers, computed on demand, once.

use super::derived::on_demand;
use super::grid::lap_grid;
use super::guard::guard;
use super::view::{address, handle, put};
use crate::base::{Csr, FaceId, Status};
use crate::grid::boundaries::{self, Boundaries, TagMoments, WallMoments};
use crate::grid::moments::{GridMoments, moments};
use crate::grid::second_moments::{SecondMoments, second_moments};
use std::sync::OnceLock;

/// What is computed at the first call.
#[derive(Default)]
pub struct Arrays {
    moments: OnceLock<GridMoments>,
    boundaries: OnceLock<Boundaries>,
    /// Flags of cells with those of their boundaries.
    flags: OnceLock<Vec<u8>>,
    walls: OnceLock<WallMoments>,
    tags: OnceLock<TagMoments>,
    second: OnceLock<SecondMoments>,
    cell_walls: OnceLock<Csr<FaceId>>,
}

pub fn of_cells(grid: &lap_grid) -> Result<&GridMoments, Status> {
    on_demand(grid.threads, &grid.arrays.moments, || moments(&grid.data))
}

fn boundaries_of(grid: &lap_grid) -> Result<&Boundaries, Status> {
    let of_cells = of_cells(grid)?;
    on_demand(grid.threads, &grid.arrays.boundaries, || boundaries::boundaries(&grid.data, of_cells))
}

/// Volumes of the cut cells.
///
/// Conventions of all these arrays: lengths, areas and volumes are in powers of the input's unit; fractions are relative to
/// the whole box or to the whole square of the grid, so in (0, 1]; coordinates are absolute, not relative to the box. A box
/// that is full has fraction 1 and its middle as its centroid, one that is empty has fraction 0. A box in several
/// parts has several cells, whose fractions add up. Every number is within one unit in the last place of the exact value
/// and depends on that value alone: not on threads, blocks or the order of the input. Sums close accordingly: the
/// areas of a cell's faces in grid planes and its boundary area vector cancel within half a unit in the last place per term.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; volumes: count; fractions:
/// count, volume over the volume of the box; centroids: 3 × count; flags: count, nonzero where a value of this
/// cell (boundary included) is beyond the range of double: it is then infinite, or 0.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: about a microsecond and a half per
/// cut cell at the first call of this function, lap_grid_cell_boundaries or lap_grid_plane_face_moments, then none. The flags
/// look at boundaries: the first call that asks for them costs what lap_grid_cell_boundaries does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_cell_moments(
    grid: *const lap_grid,
    count: *mut i64,
    volumes: *mut *const f64,
    fractions: *mut *const f64,
    centroids: *mut *const f64,
    flags: *mut *const u8,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let m = of_cells(grid)?;
        if !flags.is_null() {
            let walls = &boundaries_of(grid)?.flags;
            let both = grid.arrays.flags.get_or_init(|| m.cell_flags.iter().zip(walls).map(|(m, w)| m | w).collect());
            unsafe { put(flags, address(both)) };
        }
        unsafe {
            put(count, m.cell_volume.len() as i64);
            put(volumes, address(&m.cell_volume));
            put(fractions, address(&m.cell_fraction));
            put(centroids, address(&m.cell_centroid));
        }
        Ok(())
    })
}

/// Moments of the cut cells to order 2 about the middle of each cell's box, for reconstructions of higher order.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; first: 3 × count, the integrals
/// of (x - m)_i over the cell, m being the exact middle of its box; second: 6 × count, the integrals of (x - m)_i (x - m)_j
/// for ij = xx, yy, zz, xy, yz, zx. Of a full box with sides a, b, c and volume V they are 0 and V a²/12, V b²/12, V c²/12, 0, 0, 0.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: about ten microseconds per cut cell
/// at the first call, more where a moment is exactly zero by symmetry; then none. Memory: 72 bytes per cell.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_cell_second_moments(
    grid: *const lap_grid,
    count: *mut i64,
    first: *mut *const f64,
    second: *mut *const f64,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let m = on_demand(grid.threads, &grid.arrays.second, || second_moments(&grid.data))?;
        unsafe {
            put(count, m.first.len() as i64);
            put(first, address(&m.first));
            put(second, address(&m.second));
        }
        Ok(())
    })
}

/// The embedded boundary of each cut cell: all its walls together.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; area_vectors: 3 × count, the
/// sum of the area vectors of the cell's walls, pointing out of the fluid; centroids: 3 × count, the mean of the positions on
/// the walls, weighted by area (the cell's centroid if it has no wall).
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: about a microsecond
/// per cut cell, and lap_grid_cell_moments, at the first call, then none. Memory: 49 bytes per cell.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_cell_boundaries(
    grid: *const lap_grid,
    count: *mut i64,
    area_vectors: *mut *const f64,
    centroids: *mut *const f64,
) -> i32 {
    guard(|_| {
        let m = boundaries_of(unsafe { handle(grid) }?)?;
        unsafe {
            put(count, m.area.len() as i64);
            put(area_vectors, address(&m.area));
            put(centroids, address(&m.centroid));
        }
        Ok(())
    })
}

/// The faces in grid planes, in the order of lap_grid_plane_faces, which says what cells each joins.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of faces in grid planes; areas: count;
/// fractions: count, area over the area of the square; centroids: 3 × count, the coordinate across the plane being the
/// plane's node, bit for bit; flags: count, nonzero where a value is beyond the range of double: it is then infinite, or 0.
/// The area vector of a face is its area along the axis.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: as lap_grid_cell_moments.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_plane_face_moments(
    grid: *const lap_grid,
    count: *mut i64,
    areas: *mut *const f64,
    fractions: *mut *const f64,
    centroids: *mut *const f64,
    flags: *mut *const u8,
) -> i32 {
    guard(|_| {
        let m = of_cells(unsafe { handle(grid) }?)?;
        unsafe {
            put(count, m.face_area.len() as i64);
            put(areas, address(&m.face_area));
            put(fractions, address(&m.face_fraction));
            put(centroids, address(&m.face_centroid));
            put(flags, address(&m.face_flags));
        }
        Ok(())
    })
}

/// The walls one by one, in the order of lap_grid_walls, which says what triangle, tag and cell each has.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of walls; area_vectors: 3 × count, pointing
/// out of the fluid; centroids: 3 × count.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: some 200 ns and 48 bytes per wall
/// at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_wall_moments(
    grid: *const lap_grid,
    count: *mut i64,
    area_vectors: *mut *const f64,
    centroids: *mut *const f64,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let m = on_demand(grid.threads, &grid.arrays.walls, || boundaries::wall_moments(&grid.data))?;
        unsafe {
            put(count, m.area.len() as i64);
            put(area_vectors, address(&m.area));
            put(centroids, address(&m.centroid));
        }
        Ok(())
    })
}

/// The walls of each cut cell.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; offsets: count + 1; walls:
/// those of cell c are walls[offsets[c]] up to, not including, walls[offsets[c + 1]], rising. With lap_grid_walls they lead to
/// the triangles and tags behind a cell.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the walls at the first
/// call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_cell_walls(
    grid: *const lap_grid,
    count: *mut i64,
    offsets: *mut *const i32,
    walls: *mut *const i32,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let rows = on_demand(grid.threads, &grid.arrays.cell_walls, || boundaries::cell_walls(&grid.data))?;
        unsafe {
            put(count, rows.len() as i64);
            put(offsets, address(&rows.offsets));
            put(walls, address(&rows.items));
        }
        Ok(())
    })
}

/// The embedded boundary of each cut cell by tag of the triangles: what a boundary patch has of the cell.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; offsets: count + 1: cell c has
/// the entries offsets[c] up to, not including, offsets[c + 1]; tags: the tag of each entry, rising in a cell (0 for
/// a mesh without tags); area_vectors: 3 per entry, pointing out of the fluid; centroids: 3 per entry, weighted by area.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: as lap_grid_cell_boundaries, and
/// again for cells with several tags, at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_cell_tags(
    grid: *const lap_grid,
    count: *mut i64,
    offsets: *mut *const i32,
    tags: *mut *const i32,
    area_vectors: *mut *const f64,
    centroids: *mut *const f64,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let of_cells = boundaries_of(grid)?;
        let m = on_demand(grid.threads, &grid.arrays.tags, || boundaries::tag_moments(&grid.data, of_cells))?;
        unsafe {
            put(count, m.tags.len() as i64);
            put(offsets, address(&m.tags.offsets));
            put(tags, address(&m.tags.items));
            put(area_vectors, address(&m.area));
            put(centroids, address(&m.centroid));
        }
        Ok(())
    })
}

//! The noun `lap_grid`, third part: the polyhedra of the cut boxes, as borrowed views.

use super::derived::on_demand;
use super::grid::lap_grid;
use super::guard::guard;
use super::view::{address, handle, put};
use crate::base::{BoxId, Error, Status};
use crate::complex::Key;
use crate::grid::moments::cell_boxes;
use crate::grid::{self, GridCells};
use std::sync::OnceLock;

/// Of vertices, and of faces.
type Keys = (Vec<Key>, Vec<Key>);

/// What C reads in another form than it is stored in.
#[derive(Default)]
pub struct Views {
    wall_sources: OnceLock<Vec<i64>>,
    wall_tags: OnceLock<Vec<i32>>,
    cell_boxes: OnceLock<Vec<BoxId>>,
    keys: OnceLock<Result<Keys, Error>>,
}

/// The vertices of the cut cells: each coordinate the double nearest to the exact one (ties to even, zero as +0), in the
/// units of the input. A coordinate on a grid plane is the node's, bit for bit.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count; xyz: 3 × count; on_planes: count numbers, bit a (1, 2,
/// 4) set where the vertex lies on a grid plane across axis a (x, y, z), exactly.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_vertices(
    grid: *const lap_grid,
    count: *mut i64,
    xyz: *mut *const f64,
    on_planes: *mut *const u8,
) -> i32 {
    guard(|_| {
        let g = &unsafe { handle(grid) }?.data;
        unsafe {
            put(count, g.coords.len() as i64);
            put(xyz, address(&g.coords));
            put(on_planes, address(&g.on_planes));
        }
        Ok(())
    })
}

/// The faces of the cut cells, with their holes: walls first, then faces in grid planes. A face is a set of loops, the
/// outer loop first, then holes; seen with the face's normal up, the outer loop runs anticlockwise and holes run clockwise. A
/// loop is a cyclic run of corners; an isolated vertex inside a face is a hole of one corner. A wall has one loop. Two blocks
/// that share a face may start its loops at different corners.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of faces; face_loops: count + 1, face f has
/// the loops face_loops[f] up to, not including, face_loops[f + 1]; loop_corners: number of loops + 1, loop l has the corners
/// loop_corners[l] up to, not including, loop_corners[l + 1]; corner_vertices: the vertex of each corner.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_faces(
    grid: *const lap_grid,
    count: *mut i64,
    face_loops: *mut *const i32,
    loop_corners: *mut *const i32,
    corner_vertices: *mut *const i32,
) -> i32 {
    guard(|_| {
        let g = &unsafe { handle(grid) }?.data;
        unsafe {
            put(count, g.face_count() as i64);
            put(face_loops, address(&g.face_loops));
            put(loop_corners, address(&g.loop_offsets));
            put(corner_vertices, address(&g.corners));
        }
        Ok(())
    })
}

/// The walls: faces 0 up to count. Each is the part of a triangle of the mesh inside one box.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of walls; triangles: count: the
/// triangle that each lies on, by its place in the caller's array or, where triangle ids were given, by its id; never falling
/// in the order of places; tags: count: the tag of that triangle, NULL if the mesh has none; cells: count: the cell that the
/// wall bounds.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the walls at the first
/// call that asks for triangles or tags, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_walls(
    grid: *const lap_grid,
    count: *mut i64,
    triangles: *mut *const i64,
    tags: *mut *const i32,
    cells: *mut *const i32,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let g = &grid.data;
        if !triangles.is_null() {
            let ids = on_demand(grid.threads, &grid.views.wall_sources, || wall_sources(grid))?;
            unsafe { put(triangles, address(ids)) };
        }
        if !tags.is_null() {
            let all = on_demand(grid.threads, &grid.views.wall_tags, || wall_tags(g))?;
            unsafe { put(tags, address(all)) };
        }
        unsafe {
            put(count, g.wall_count() as i64);
            put(cells, address(&g.wall_cell));
        }
        Ok(())
    })
}

fn wall_sources(grid: &lap_grid) -> Vec<i64> {
    let triangles = grid.data.wall_triangle.iter();
    match &grid.triangle_ids {
        Some(ids) => triangles.map(|t| ids[t.at()]).collect(),
        None => triangles.map(|t| i64::from(t.0)).collect(),
    }
}

fn wall_tags(g: &GridCells) -> Vec<i32> {
    let tags = &g.mesh.tags;
    if tags.is_empty() { Vec::new() } else { g.wall_triangle.iter().map(|t| tags[t.at()]).collect() }
}

/// The faces in grid planes that bound cut cells: all after the walls. Face first + i is square i's, or a part of it. Squares
/// between full boxes, or between a full box and the boundary of the block, are not among them (lap_grid_full_faces).
///
/// Outputs (each may be NULL; borrowed until the grid is freed): first: the number of walls, hence the first face; count: the
/// number of faces in grid planes; axes: 4 faces: those across axis a (0: x, 1: y, 2: z) are axes[a] up to, not including,
/// axes[a + 1], by rising plane; nodes: count: the number of the lowest node of the square of the grid that holds the face;
/// cells: 2 × count: the cell on the lower side and the one on the upper side, LAP_CELL_FULL for that of a full box,
/// LAP_CELL_NONE at the block's boundary. Never NONE on both sides. The square of node (i, j, k) across x lies between the boxes
/// (i - 1, j, k) and (i, j, k), and so on; the normals point along the axis.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_plane_faces(
    grid: *const lap_grid,
    first: *mut i64,
    count: *mut i64,
    axes: *mut *const i32,
    nodes: *mut *const i32,
    cells: *mut *const i32,
) -> i32 {
    guard(|_| {
        let g = &unsafe { handle(grid) }?.data;
        unsafe {
            put(first, g.wall_count() as i64);
            put(count, g.square_node.len() as i64);
            put(axes, address(&g.plane_faces));
            put(nodes, address(&g.square_node));
            put(cells, address(&g.square_cells));
        }
        Ok(())
    })
}

/// The cut cells. A cell is bounded by shells, the outer shell first, then voids; a shell is a closed set of half-faces.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cells; boxes: count: the number of the
/// box that holds the cell, never falling; cell_shells: count + 1, cell c has the shells cell_shells[c] up to, not including,
/// cell_shells[c + 1]; shell_faces: number of shells + 1, shell s has the half-faces half_faces[shell_faces[s]] up to, not
/// including, half_faces[shell_faces[s + 1]]; half_faces: 2 f + side, side 0 where the normal of face f points out of the cell,
/// 1 where it points into it; rising in each shell.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the cells at the first
/// call that asks for boxes, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_cells(
    grid: *const lap_grid,
    count: *mut i64,
    boxes: *mut *const i32,
    cell_shells: *mut *const i32,
    shell_faces: *mut *const i32,
    half_faces: *mut *const i32,
) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        let g = &grid.data;
        if !boxes.is_null() {
            let all = on_demand(grid.threads, &grid.views.cell_boxes, || cell_boxes(g))?;
            unsafe { put(boxes, address(all)) };
        }
        unsafe {
            put(count, g.cell_count() as i64);
            put(cell_shells, address(&g.cell_shells));
            put(shell_faces, address(&g.shell_faces.offsets));
            put(half_faces, address(&g.shell_faces.items));
        }
        Ok(())
    })
}

/// The keys of the vertices, as lap_complex_vertex_keys makes them: from the ids of triangles and the places of planes in the
/// whole grid, so that blocks which share a vertex give it the same key.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count; keys: 2 × count, the first number of a pair never
/// negative. Plane i across x has the number i, i counted in the whole grid; those across y follow, then those across z.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_INCONSISTENT for input that intersects itself,
/// LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: some hundred nanoseconds per vertex and face at the first call of this or
/// lap_grid_face_keys, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_vertex_keys(grid: *const lap_grid, count: *mut i64, keys: *mut *const i64) -> i32 {
    guard(|_| {
        let (of_vertices, _) = keys_of(unsafe { handle(grid) }?)?;
        unsafe {
            put(count, of_vertices.len() as i64);
            put(keys, address(of_vertices));
        }
        Ok(())
    })
}

/// The keys of the faces, walls first, as lap_complex_face_keys makes them: the face that two blocks share has the same key in
/// both, and no other face has.
///
/// Outputs (each may be NULL; borrowed until the grid is freed): count; keys: 2 × count, the first number of a pair never
/// negative.
///
/// Errors: as lap_grid_vertex_keys, and so are threads and cost.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_face_keys(grid: *const lap_grid, count: *mut i64, keys: *mut *const i64) -> i32 {
    guard(|_| {
        let (_, of_faces) = keys_of(unsafe { handle(grid) }?)?;
        unsafe {
            put(count, of_faces.len() as i64);
            put(keys, address(of_faces));
        }
        Ok(())
    })
}

fn keys_of(grid: &lap_grid) -> Result<&Keys, Status> {
    let ids = grid.triangle_ids.as_deref();
    let made = on_demand(grid.threads, &grid.views.keys, || grid::keys(&grid.data, ids))?;
    made.as_ref().map_err(|error| error.status)
}

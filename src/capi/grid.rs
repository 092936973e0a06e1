//! The noun `lap_grid`, first part: making one, and what the block's boxes are. `grid_cells` has the polyhedra, `grid_moments`
//! the arrays of embedded-boundary solvers, `grid_fluid` what connects cells and full boxes.

use super::complex::lap_complex;
use super::context::{State, c_string, lap_context, with_context};
use super::derived::on_demand;
use super::grid_cells::Views;
use super::grid_moments::Arrays;
use super::guard::{Host, guard};
use super::keys::Keyed;
use super::mesh::{bad_options, lap_mesh};
use super::view::{address, handle, index, input, into_handle, put, read_options, write_options};
use crate::base::{Error, PlaneId, Run, Status};
use crate::grid::{self, CUT, EMPTY, FULL, GridCells, GridOptions, Lattice};
use crate::mesh::TriMesh;
use std::ffi::{CString, c_char};
use std::sync::{Arc, OnceLock};

/// The open box holds no fluid.
pub const LAP_BOX_EMPTY: i32 = 0;
/// The closed box misses the surface and is fluid: one cell, the box itself, which is not stored as a polyhedron.
pub const LAP_BOX_FULL: i32 = 1;
/// The surface touches the closed box, and the open box holds fluid: one or more cells, stored as polyhedra. A box with a
/// wall on its side and a volume fraction of 1 is cut.
pub const LAP_BOX_CUT: i32 = 2;

/// Where a cell is named: there is none, the face is on the boundary of the block.
pub const LAP_CELL_NONE: i32 = -1;
/// Where a cell is named: the one cell of a full box.
pub const LAP_CELL_FULL: i32 = -2;

/// Nothing is told about a node: the mesh is whole.
pub const LAP_NODE_UNKNOWN: i32 = 0;
/// The node is in the fluid, and not on the surface.
pub const LAP_NODE_FLUID: i32 = 1;
/// The node is neither in the fluid nor on the surface.
pub const LAP_NODE_SOLID: i32 = 2;

const _: () = {
    assert!(LAP_BOX_EMPTY == EMPTY as i32);
    assert!(LAP_BOX_FULL == FULL as i32);
    assert!(LAP_BOX_CUT == CUT as i32);
    assert!(LAP_CELL_NONE == crate::base::CellId::NONE.0 as i32);
    assert!(LAP_CELL_FULL == grid::FULL_CELL.0 as i32);
};

/// A block of a rectilinear grid, cut by a surface: a byte per box, polyhedra for the boxes that are cut, and on demand the
/// arrays of embedded-boundary solvers.
///
/// Boxes and nodes. A block of nx × ny × nz boxes has (nx + 1) × (ny + 1) × (nz + 1) nodes. Box (i, j, k) of the block
/// has the number i + nx (j + ny k), its low corner is node (i, j, k), and node (i, j, k) has the number
/// i + (nx + 1) (j + (ny + 1) k). All indices count from the block's low corner unless it says that they are of the whole grid.
///
/// Cells. Box b holds as many cells as the surface divides its fluid into; they are numbered by rising box. A cell is
/// bounded by faces: walls, which lie on triangles of the mesh, and faces in grid planes, which join two cells or lie on the
/// boundary of the block. Half-faces are those of lap_complex: 2 f + s, side 0 behind the face's normal, side 1 before
/// it. The normal of a wall points out of the fluid (so only side 0 of it is used), that of a face in a grid plane
/// along the axis (so side 0 belongs to the cell with the lower index).
///
/// Immutable: a const handle may be used from many threads at once; what is computed on demand is computed once.
pub struct lap_grid {
    pub data: GridCells,
    /// How many threads what is computed on demand may use.
    pub threads: usize,
    /// Global ids of the mesh's triangles; `None`: positions.
    pub triangle_ids: Option<Arc<[i64]>>,
    shape: Shape,
    stages: Vec<(CString, f64)>,
    /// Empty, full and cut boxes.
    tally: OnceLock<[i64; 3]>,
    box_offsets: OnceLock<Vec<u32>>,
    complex: OnceLock<Result<lap_complex, Status>>,
    pub views: Views,
    pub arrays: Arrays,
}

/// The block in the whole grid, as C reads it.
struct Shape {
    boxes: [i64; 3],
    first: [i64; 3],
    total: [i64; 3],
}

impl lap_grid {
    /// Takes a cut block over, if all its counts fit C's `int32_t`.
    fn new(data: GridCells, threads: usize, stages: Vec<(&'static str, f64)>) -> Result<Self, Error> {
        let longest = [
            data.lattice.nodes.iter().map(|n| n.len()).product(),
            data.coords.len(),
            // Half-faces are numbered by twice the face.
            2 * data.face_loops.len(),
            data.corners.len(),
            data.shell_faces.items.len(),
        ];
        if longest.iter().any(|&n| n > i32::MAX as usize) {
            return Err(Error::new(Status::TooLarge, "the result has more elements than 32-bit indices can number"));
        }
        let lattice = &data.lattice;
        let shape = Shape {
            boxes: std::array::from_fn(|a| lattice.count(a) as i64),
            first: lattice.first,
            total: lattice.total.map(|nodes| nodes - 1),
        };
        Ok(Self {
            data,
            threads,
            triangle_ids: None,
            shape,
            stages: stages.iter().map(|(name, seconds)| (c_string(name), *seconds)).collect(),
            tally: OnceLock::new(),
            box_offsets: OnceLock::new(),
            complex: OnceLock::new(),
            views: Views::default(),
            arrays: Arrays::default(),
        })
    }
}

const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<lap_grid>();
};

/// Options of lap_grid_new and lap_grid_new_patch; filled by lap_grid_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_grid_options {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
    /// Nonzero: the fluid is outside the solid, as in external flow (the grid's box minus the bodies). 0, the default: the
    /// fluid is the solid's inside.
    pub outside: i32,
    /// Nonzero: run lap_grid_check on the result and fail with LAP_ERR_INCONSISTENT if it does not hold. 0, the default: do
    /// not.
    pub check: i32,
    /// The block: boxes block_low[a] up to, not including, block_high[a] of the whole grid along axis a (0: x, 1: y, 2: z). -1
    /// as block_high[a] stands for the number of boxes. Default: 0 and -1, the whole grid.
    pub block_low: [i32; 3],
    pub block_high: [i32; 3],
    /// For a patch: what is known about node known_node (its indices in the whole grid; a node of the block): LAP_NODE_FLUID
    /// or LAP_NODE_SOLID. Default: LAP_NODE_UNKNOWN.
    pub known: i32,
    pub known_node: [i32; 3],
}

const DEFAULTS: lap_grid_options = lap_grid_options {
    struct_size: size_of::<lap_grid_options>() as i32,
    outside: 0,
    check: 0,
    block_low: [0; 3],
    block_high: [-1; 3],
    known: LAP_NODE_UNKNOWN,
    known_node: [0; 3],
};

/// Fills grid options with the defaults.
///
/// struct_size: pass (int32_t)sizeof(lap_grid_options); no more than that is written, so a program compiled against an
/// older header keeps working.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_options_init(options: *mut lap_grid_options, struct_size: i32) -> i32 {
    guard(|_| unsafe { write_options(options, struct_size, DEFAULTS) })
}

/// Cuts a block of a rectilinear grid along the surface of a solid.
///
/// Inputs (borrowed for the call): mesh; x, y, z: the n_x, n_y, n_z coordinates of the whole grid's nodes along each axis,
/// strictly rising, at least two, each taken as the exact number that it is: they alone say where the grid's planes are,
/// and ranks that pass the same numbers get the same planes; options: or NULL for the defaults (the whole grid, fluid
/// inside the solid). Grid planes may pass through vertices and edges of the mesh, and triangles may lie in them.
/// grid: receives the handle, NULL after an error or cancel; free it with lap_grid_free. It does not need the mesh
/// handle or the context to stay alive.
///
/// Errors: LAP_ERR_BAD_ARGUMENT with a message that names the node for coordinates that are not finite or do not rise, for a
/// block that is empty or outside the grid, and for a known node outside the block or on the surface;
/// LAP_ERR_INCONSISTENT for input that intersects itself; LAP_ERR_TOO_LARGE if the block has 2147483647 nodes or more or the
/// result more elements than 32-bit indices can number; LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: a byte per box, else it grows with the number of cut boxes and of triangles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_new(
    context: *mut lap_context,
    mesh: *const lap_mesh,
    n_x: i64,
    x: *const f64,
    n_y: i64,
    y: *const f64,
    n_z: i64,
    z: *const f64,
    options: *const lap_grid_options,
    grid: *mut *mut lap_grid,
) -> i32 {
    with_context(context, |state, host| {
        if grid.is_null() {
            return Err(Error::new(Status::NullPointer, "grid is NULL"));
        }
        unsafe { put(grid, std::ptr::null_mut()) };
        let mesh = unsafe { handle(mesh) }.map_err(|status| Error::new(status, "mesh is NULL"))?;
        let order = unsafe { Order::read([n_x, n_y, n_z], [x, y, z], options)? };
        let mut made = make(state, host, order, |_| Ok(mesh.mesh.clone()))?;
        made.triangle_ids = mesh.triangle_ids.clone();
        unsafe { put(grid, into_handle(made)) };
        Ok(())
    })
}

/// What is to be cut, besides the mesh.
struct Order {
    lattice: Lattice,
    options: GridOptions,
    check: bool,
}

impl Order {
    /// # Safety
    /// The pointers are null or as `lap_grid_new` says.
    unsafe fn read(counts: [i64; 3], nodes: [*const f64; 3], options: *const lap_grid_options) -> Result<Self, Error> {
        let mut slices: [&[f64]; 3] = [&[]; 3];
        for a in 0..3 {
            slices[a] = unsafe { input(nodes[a], counts[a]) }.map_err(|status| {
                let (axis, n) = (AXES[a], counts[a]);
                Error::new(status, format!("nodes along {axis}: NULL, or a bad count: {n}"))
            })?;
        }
        let options = unsafe { read_options(options, DEFAULTS) }.map_err(bad_options)?;
        let low = options.block_low.map(i64::from);
        let high = std::array::from_fn(|a| match options.block_high[a] {
            -1 => counts[a] - 1,
            high => high.into(),
        });
        let lattice = Lattice::new(slices, low, high)?;
        let known = match options.known {
            LAP_NODE_UNKNOWN => None,
            LAP_NODE_FLUID | LAP_NODE_SOLID => Some((known_node(&lattice, &options)?, options.known == LAP_NODE_FLUID)),
            other => return Err(Error::new(Status::BadArgument, format!("known: {other} is no LAP_NODE_*"))),
        };
        Ok(Self { lattice, options: GridOptions { outside: options.outside != 0, known }, check: options.check != 0 })
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// The known node, counted from the block's low corner.
fn known_node(lattice: &Lattice, options: &lap_grid_options) -> Result<[usize; 3], Error> {
    let mut local = [0; 3];
    for a in 0..3 {
        let node = i64::from(options.known_node[a]) - lattice.first[a];
        local[a] = usize::try_from(node).ok().filter(|&n| n < lattice.nodes[a].len()).ok_or_else(|| {
            let (node, axis) = (options.known_node[a], AXES[a]);
            Error::new(Status::BadArgument, format!("known_node: node {node} along {axis} is not one of the block's"))
        })?;
    }
    Ok(local)
}

fn make(
    state: &mut State,
    host: &mut Host,
    order: Order,
    mesh: impl FnOnce(&mut Run) -> Result<Arc<TriMesh>, Error> + Send,
) -> Result<lap_grid, Error> {
    let (data, stages) = state.run(host, |run| {
        let mesh = mesh(run)?;
        let data = grid::cut_grid(&mesh, order.lattice, &order.options, run)?;
        if order.check {
            data.check().map_err(Error::inconsistent)?;
        }
        Ok((data, run.take_stages()))
    })?;
    lap_grid::new(data, state.threads(), stages)
}

/// Frees a grid and all that was borrowed from it, its complex included. NULL is allowed and does nothing.
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_free(grid: *mut lap_grid) -> i32 {
    guard(|_| {
        if !grid.is_null() {
            drop(unsafe { Box::from_raw(grid) });
        }
        Ok(())
    })
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
        let tally = grid.tally.get_or_init(|| tally(&grid.data));
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
        let all = on_demand(grid.threads, &grid.box_offsets, || box_offsets(&grid.data))?;
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
        let g = &unsafe { handle(grid) }?.data;
        let mut at = [0; 3];
        for (a, i) in [i, j, k].into_iter().enumerate() {
            at[a] = index(i, g.lattice.count(a))?;
        }
        let b = g.lattice.box_id(at);
        let cells = g.cells_of(b);
        unsafe {
            put(flag, g.flags[b.at()].into());
            put(first, cells.start as i32);
            put(count, cells.len() as i32);
        }
        Ok(())
    })
}

/// The cut cells as an ordinary complex, on which all functions for lap_complex work. Its cells and its faces are numbered as
/// here, and so are its vertices; its planes are the block's grid planes, those across x first, then y, then z, each by rising
/// coordinate, with the equation x - node = 0. Its triangles are those of the mesh; where the fluid is outside they
/// are reversed. A face towards a full box or on the boundary of the block has a cell on one side only, which may be the front.
/// The volume and the Euler characteristic are those of the cut cells, not of the solid.
///
/// complex: borrowed until the grid is freed; do not free it.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE, LAP_ERR_INCONSISTENT. Threads: any. Cost: linear in the cut cells and
/// about as much memory again, at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_complex(grid: *const lap_grid, complex: *mut *const lap_complex) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        if complex.is_null() {
            return Err(Status::NullPointer);
        }
        let made = on_demand(grid.threads, &grid.complex, || to_complex(grid))?;
        unsafe { put(complex, std::ptr::from_ref(made.as_ref().map_err(|status| *status)?)) };
        Ok(())
    })
}

fn to_complex(grid: &lap_grid) -> Result<lap_complex, Status> {
    let g = &grid.data;
    let mut complex = lap_complex::new(grid::to_complex(g), grid.threads)?;
    complex.part = true;
    let planes = (0..g.planes.len()).map(|p| g.lattice.global_plane(PlaneId::of(p)));
    complex.keyed = Keyed::new(grid.triangle_ids.clone(), planes.collect());
    Ok(complex)
}

/// Checks that a cut grid is consistent: indices in range, loops closed, faces between the cells that name them, cells
/// closed.
///
/// Errors: LAP_ERR_INCONSISTENT with a message that names the element; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: linear in the cut cells, and a pass over the flags.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_check(context: *mut lap_context, grid: *const lap_grid) -> i32 {
    with_context(context, |state, host| {
        let grid = unsafe { handle(grid) }.map_err(null_grid)?;
        state.run(host, |_| grid.data.check().map_err(Error::inconsistent))
    })
}

pub fn null_grid(status: Status) -> Error {
    Error::new(status, "grid is NULL")
}

/// How many stages the making of the grid ran through.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_stage_count(grid: *const lap_grid, count: *mut i32) -> i32 {
    guard(|_| {
        let grid = unsafe { handle(grid) }?;
        if count.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(count, grid.stages.len() as i32) };
        Ok(())
    })
}

/// Stage i, from 0, in the order in which they ran: its name and its time in seconds.
///
/// Outputs (each may be NULL). name is borrowed until the grid is freed.
///
/// Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_BAD_ARGUMENT if there is no such stage. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_stage(
    grid: *const lap_grid,
    i: i32,
    name: *mut *const c_char,
    seconds: *mut f64,
) -> i32 {
    guard(|_| {
        let stages = &unsafe { handle(grid) }?.stages;
        let (text, time) = &stages[index(i, stages.len())?];
        unsafe {
            put(name, text.as_ptr());
            put(seconds, *time);
        }
        Ok(())
    })
}

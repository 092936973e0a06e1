//! The noun `lap_grid`, first part: making one. `grid_boxes` has what the block's boxes are, `grid_cells` the polyhedra,
//! `grid_moments` the arrays of embedded-boundary solvers, `grid_fluid` what connects cells and full boxes.

use super::complex::lap_complex;
use super::context::{State, c_string, lap_context, with_context};
use super::derived::on_demand;
use super::grid_boxes::{Boxes, Shape};
use super::grid_cells::Views;
use super::grid_fluid::Fluid;
use super::grid_moments::Arrays;
use super::guard::{Host, guard};
use super::keys::Keyed;
use super::mesh::{Arrays as MeshArrays, bad_options, lap_mesh};
use super::view::{handle, index, input, into_handle, put, read_options, write_options};
use crate::base::{Error, PlaneId, Run, Status};
use crate::complex::keys::check_ids;
use crate::grid::{self, CUT, EMPTY, FULL, GridCells, GridOptions, Lattice};
use crate::mesh::{self, MeshInput, MeshOptions, TriMesh};
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
    pub shape: Shape,
    stages: Vec<(CString, f64)>,
    complex: OnceLock<Result<lap_complex, Status>>,
    pub boxes: Boxes,
    pub views: Views,
    pub arrays: Arrays,
    pub fluid: Fluid,
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
        Ok(Self {
            shape: Shape::of(&data.lattice),
            data,
            threads,
            triangle_ids: None,
            stages: stages.iter().map(|(name, seconds)| (c_string(name), *seconds)).collect(),
            boxes: Boxes::default(),
            complex: OnceLock::new(),
            views: Views::default(),
            arrays: Arrays::default(),
            fluid: Fluid::default(),
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
/// block that is empty or outside the grid, and for a known node outside the block;
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

/// Cuts a block of a rectilinear grid along the part of a surface that is in it: for a rank that does not hold the whole mesh.
///
/// Inputs (borrowed for the call): xyz, indices, tags: as for lap_mesh_new, of some triangles of a mesh, among them all that
/// meet the closed box of the block (it suffices that their bounding boxes do; more do not harm; there may be none);
/// triangle_ids: n_triangles ids, each from 0 up to, not including, 2^40, no two equal: the triangles' places in the whole
/// mesh, of which keys are made; or NULL, then they are their places here; n_x to z: the whole grid's nodes, as for
/// lap_grid_new; options: with the block, and one node of it that is known to be in the fluid or not (lap_mesh_locate tells,
/// where the whole mesh is). Blocks that share a face, cut from parts of one mesh with the same vertex order in each
/// triangle, give it the same key and its vertices the same coordinates, bit for bit.
/// grid: receives the handle, NULL after an error or cancel; free it with lap_grid_free.
///
/// Errors: LAP_ERR_BAD_MESH as for lap_mesh_new, except that edges may be open where they do not meet the closed box of the
/// block, and nesting is not checked: the ids of an open edge's defect are those of this call's arrays, and it means
/// that a triangle is missing; LAP_ERR_BAD_ARGUMENT as for lap_grid_new, if no node is known, and for ids that are out of
/// range or equal; others as for lap_grid_new. Cost: as lap_grid_new, and n log n in the vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_grid_new_patch(
    context: *mut lap_context,
    n_vertices: i64,
    xyz: *const f64,
    n_triangles: i64,
    indices: *const i32,
    tags: *const i32,
    triangle_ids: *const i64,
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
        let arrays = unsafe { MeshArrays::borrow(n_vertices, xyz, n_triangles, indices, tags, std::ptr::null())? };
        let ids = if triangle_ids.is_null() {
            None
        } else {
            Some(unsafe { input(triangle_ids, n_triangles) }.map_err(|s| Error::new(s, "triangle_ids"))?)
        };
        let order = unsafe { Order::read([n_x, n_y, n_z], [x, y, z], options)? };
        if order.options.known.is_none() {
            return Err(Error::new(Status::BadArgument, "known: of a patch one node has to be known"));
        }
        let mut made = make(state, host, order, |run| {
            if let Some(ids) = ids {
                check_ids(ids, arrays.triangles.len(), "triangle")?;
            }
            let input = MeshInput { vertices: arrays.vertices, triangles: arrays.triangles, tags: arrays.tags };
            mesh::build_patch(&input, &MeshOptions::default(), run).map(Arc::new)
        })?;
        made.triangle_ids = ids.map(Arc::from);
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
    build: impl FnOnce(&mut Run) -> Result<Arc<TriMesh>, Error> + Send,
) -> Result<lap_grid, Error> {
    let (data, stages) = state.run(host, |run| {
        let mesh = build(run)?;
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

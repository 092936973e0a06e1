//! The noun `lap_arrangement`, first part: making one. `arrangement_views` has its vertices, faces, patches and cells,
//! `arrangement_extract` the surfaces of solids made of its cells.

use super::arrangement_views::Views;
use super::context::{c_string, lap_context, with_context};
use super::guard::guard;
use super::mesh::bad_options;
use super::view::{address, handle, index, input, into_handle, put, read_options, write_options};
use crate::arrangement::supports::BOX;
use crate::arrangement::{Arrangement, ArrangementOptions, Operand, arrange_with};
use crate::base::{Error, Status};
use crate::exact::Plane;
use std::ffi::{CString, c_char};
use std::sync::Arc;

/// One operand of an arrangement: any triangle mesh that balances at its edges (see lap_arrangement). Its arrays are borrowed for the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_operand {
    pub n_vertices: i64,
    /// 3 × n_vertices coordinates, each taken as the exact number that it is.
    pub xyz: *const f64,
    pub n_triangles: i64,
    /// 3 × n_triangles vertex indices from 0, anticlockwise seen from outside.
    pub indices: *const i32,
}

/// The cells into which triangle meshes, the operands, divide space, each with its winding number for every operand; solids made of
/// cells (lap_arrangement_extract). Exact for any finite coordinates.
///
/// Operands. Any number of meshes that intersect themselves and one another, with several components, nested, with non-manifold edges, with
/// duplicate and overlapping triangles in any orientation, with triangles without area (which are dropped). What is asked of each is
/// that its triangles balance at every edge, as point sets: as many on one side run along it as against it (T-junctions that cancel are fine). Then every
/// point off the surface has a winding number, an integer: how often the surface goes around it, positive where it faces outward. A point is
/// inside an operand where that is positive.
///
/// Vertices: the points that operands give, equal ones once, then those where triangles meet; not all of them are corners of faces. Faces: triangles
/// that meet in common vertices and edges only, no two with the same corners; each is a part of one input triangle or of several that lie on one another
/// there, its births, and runs like the first of them. Patch: faces joined across edges with two faces. Cell: a
/// connected part of space without faces that divide; number 0 is the unbounded one. Where births cancel in every operand a face divides nothing: it has
/// no patch and no cells. Triangles and vertices of all operands, where they are one number, count through the operands, one
/// behind the other (lap_arrangement_operands). Half-spaces may be operands too (lap_arrangement_new_half_spaces).
///
/// Immutable: a const handle may be used from many threads at once; what is computed on demand is computed once.
pub struct lap_arrangement {
    pub data: Arc<Arrangement>,
    /// How many threads what is computed on demand may use.
    pub threads: usize,
    pub views: Views,
    /// The first vertex and the first triangle of each operand as it was given, and their ends.
    pub first_vertex: Vec<i64>,
    pub first_triangle: Vec<i64>,
    dropped: Vec<i64>,
    stages: Vec<(CString, f64)>,
}

const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<lap_arrangement>();
};

/// Options of lap_arrangement_new; filled by lap_arrangement_options_init. There is nothing to choose yet.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_arrangement_options {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
}

const DEFAULTS: lap_arrangement_options =
    lap_arrangement_options { struct_size: size_of::<lap_arrangement_options>() as i32 };

/// Fills arrangement options with the defaults.
///
/// struct_size: pass (int32_t)sizeof(lap_arrangement_options); no more than that is written, so a program compiled against an
/// older header keeps working.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_options_init(options: *mut lap_arrangement_options, struct_size: i32) -> i32 {
    guard(|_| unsafe { write_options(options, struct_size, DEFAULTS) })
}

/// Finds the cells into which operands divide space.
///
/// Inputs (borrowed for the call): operands: n_operands of them; no operands, and operands without triangles, are allowed; options: or NULL for the
/// defaults.
/// arrangement: receives the handle, NULL after an error or cancel; free it with lap_arrangement_free. It needs neither the operands
/// nor the context to stay alive.
///
/// Errors: LAP_ERR_BAD_MESH with a message that names the operand, and all defects of one kind (lap_context_last_defects):
/// LAP_DEFECT_NON_FINITE_COORDINATE and LAP_DEFECT_INDEX_OUT_OF_RANGE (vertices and triangles count through the operands), or
/// LAP_DEFECT_UNBALANCED_EDGE (the first hundred; the message counts them); LAP_ERR_TOO_LARGE, LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a negative count,
/// LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: n log n in the triangles to find those that meet; some microseconds for each pair
/// that does; else memory is touched.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_new(
    context: *mut lap_context,
    n_operands: i64,
    operands: *const lap_operand,
    options: *const lap_arrangement_options,
    arrangement: *mut *mut lap_arrangement,
) -> i32 {
    let nothing = std::ptr::null();
    unsafe { make(context, [n_operands, 0], operands, [nothing; 2], options, arrangement) }
}

/// Finds the cells into which operands and half-spaces divide space. Half-space i is operand n_operands + i, in expressions as well.
///
/// Inputs (borrowed for the call): n_half_spaces, planes: 4 × n_half_spaces numbers a, b, c, d, each taken as the exact number that it is: the half-space
/// is where a x + b y + c z + d < 0, so (a, b, c) points out of it. bounds: six numbers, the lowest and the highest corner of a box, or NULL for the box
/// of all vertices of operands with as much room on each side as it is large. A half-space is its part within that box; farther out its winding
/// number is 0. So what is chosen by half-spaces alone ends at the box, and what is inside a mesh that is in the box is not touched by it. Others
/// as for lap_arrangement_new.
///
/// Planes may have any position: through vertices and edges, on triangles, coincident or opposite, three through a line, through the box's corners and on
/// its sides, beside everything. As births a half-space has thirteen triangles: 0 to 11 are parts of the sides of the box, 12 is its plane. Where
/// vertices and triangles count through the operands it counts for eight vertices (the box's corners) and thirteen triangles. In the complex of the
/// arrangement faces on planes alone have those as supports (LAP_SUPPORT_PLANE), with the index of the half-space (of coincident planes the lowest).
///
/// Errors: as lap_arrangement_new; LAP_ERR_BAD_PLANE with all planes that are not finite (LAP_DEFECT_NON_FINITE_PLANE) or have no normal
/// (LAP_DEFECT_ZERO_NORMAL); LAP_ERR_BAD_ARGUMENT for bounds that are no box (finite, the lowest corner lower in every coordinate), or NULL where operands have no
/// vertices. Cost: as there, for each half-space a look at every vertex and triangle, and in each plane about the square of the number of planes
/// that it meets in the box: n planes in general position make some n³ / 6 cells there, n parallel ones n + 1 and n² births.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_new_half_spaces(
    context: *mut lap_context,
    n_operands: i64,
    operands: *const lap_operand,
    n_half_spaces: i64,
    planes: *const f64,
    bounds: *const f64,
    options: *const lap_arrangement_options,
    arrangement: *mut *mut lap_arrangement,
) -> i32 {
    unsafe { make(context, [n_operands, n_half_spaces], operands, [planes, bounds], options, arrangement) }
}

/// # Safety
/// As the functions above say: operands and half-spaces as many as counted, bounds of six numbers or null.
unsafe fn make(
    context: *mut lap_context,
    [n_operands, n_half_spaces]: [i64; 2],
    operands: *const lap_operand,
    [planes, bounds]: [*const f64; 2],
    options: *const lap_arrangement_options,
    arrangement: *mut *mut lap_arrangement,
) -> i32 {
    with_context(context, |state, host| {
        if arrangement.is_null() {
            return Err(Error::new(Status::NullPointer, "arrangement is NULL"));
        }
        unsafe { put(arrangement, std::ptr::null_mut()) };
        let given = unsafe { input(operands, n_operands) }
            .map_err(|s| Error::new(s, format!("operands: NULL, or a bad count: {n_operands}")))?;
        let planes: &[[f64; 4]] = unsafe { input(planes.cast(), n_half_spaces) }
            .map_err(|s| Error::new(s, format!("planes: NULL, or a bad count: {n_half_spaces}")))?;
        let planes: Vec<Plane> = planes.iter().map(|&[a, b, c, d]| Plane { n: [a, b, c], d }).collect();
        let bounds: Option<[[f64; 3]; 2]> = unsafe { bounds.cast::<[[f64; 3]; 2]>().as_ref() }.copied();
        unsafe { read_options(options, DEFAULTS) }.map_err(bad_options)?;
        let mut operands = Vec::with_capacity(given.len());
        let (mut first_vertex, mut first_triangle) = (vec![0], vec![0]);
        for (i, o) in given.iter().enumerate() {
            let bad = |what: &str, count: i64| {
                let text = format!("operand {i}: {what}: NULL, or a bad count: {count}");
                move |status| Error::new(status, text)
            };
            let vertices = unsafe { input(o.xyz.cast(), o.n_vertices) }.map_err(bad("xyz", o.n_vertices))?;
            let triangles = unsafe { input(o.indices.cast(), o.n_triangles) }.map_err(bad("indices", o.n_triangles))?;
            operands.push(Operand { vertices, triangles });
            first_vertex.push(first_vertex[i] + o.n_vertices);
            first_triangle.push(first_triangle[i] + o.n_triangles);
        }
        for i in given.len()..given.len() + planes.len() {
            first_vertex.push(first_vertex[i] + 8);
            first_triangle.push(first_triangle[i] + BOX as i64 + 1);
        }
        let threads = state.threads();
        let (data, stages) = state.run(host, |run| {
            let mut data = arrange_with(&operands, &planes, bounds, &ArrangementOptions {}, run)?;
            let stages = std::mem::take(&mut data.stages);
            // Half-faces are numbered by twice the face.
            let longest = [data.vertex_count(), 2 * data.face_count(), data.winding.rows.items.len()];
            match longest.iter().any(|&n| n > i32::MAX as usize) {
                true => {
                    Err(Error::new(Status::TooLarge, "the result has more elements than 32-bit indices can number"))
                }
                false => Ok((data, stages)),
            }
        })?;
        let made = lap_arrangement {
            dropped: data.resolved.soup.dropped.iter().map(|&n| n.into()).collect(),
            data: Arc::new(data),
            threads,
            views: Views::default(),
            first_vertex,
            first_triangle,
            stages: stages.iter().map(|(name, seconds)| (c_string(name), *seconds)).collect(),
        };
        unsafe { put(arrangement, into_handle(made)) };
        Ok(())
    })
}

/// Frees an arrangement and all that was borrowed from it. NULL is allowed and does nothing. Surfaces made from it stay.
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_free(arrangement: *mut lap_arrangement) -> i32 {
    guard(|_| {
        if !arrangement.is_null() {
            drop(unsafe { Box::from_raw(arrangement) });
        }
        Ok(())
    })
}

pub fn null_arrangement(status: Status) -> Error {
    Error::new(status, "arrangement is NULL")
}

/// How many elements an arrangement has. cells: the unbounded one included; intersecting_pairs: pairs of input triangles that meet outside of
/// what they share; dropped: input triangles without area.
///
/// Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if arrangement is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_counts(
    arrangement: *const lap_arrangement,
    vertices: *mut i64,
    faces: *mut i64,
    patches: *mut i64,
    cells: *mut i64,
    intersecting_pairs: *mut i64,
    dropped: *mut i64,
) -> i32 {
    guard(|_| {
        let arrangement = unsafe { handle(arrangement) }?;
        let a = &arrangement.data;
        unsafe {
            put(vertices, a.vertex_count() as i64);
            put(faces, a.face_count() as i64);
            put(patches, a.patch_count() as i64);
            put(cells, a.cell_count() as i64);
            put(intersecting_pairs, a.resolved.pair_count as i64);
            put(dropped, arrangement.dropped.iter().sum());
        }
        Ok(())
    })
}

/// The operands of an arrangement, as they were given.
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): count; first_vertices, first_triangles: count + 1 numbers each: vertices
/// and triangles of operand i, where they count through all operands, are from place i up to, not including, place i + 1; dropped: of each the number of
/// triangles without area.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_operands(
    arrangement: *const lap_arrangement,
    count: *mut i64,
    first_vertices: *mut *const i64,
    first_triangles: *mut *const i64,
    dropped: *mut *const i64,
) -> i32 {
    guard(|_| {
        let a = unsafe { handle(arrangement) }?;
        unsafe {
            put(count, a.dropped.len() as i64);
            put(first_vertices, address(&a.first_vertex));
            put(first_triangles, address(&a.first_triangle));
            put(dropped, address(&a.dropped));
        }
        Ok(())
    })
}

/// How many stages the making of the arrangement ran through.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_stage_count(arrangement: *const lap_arrangement, count: *mut i32) -> i32 {
    guard(|_| {
        let arrangement = unsafe { handle(arrangement) }?;
        if count.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(count, arrangement.stages.len() as i32) };
        Ok(())
    })
}

/// Stage i, from 0, in the order in which they ran: its name and its time in seconds.
///
/// Outputs (each may be NULL). name is borrowed until the arrangement is freed.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_BAD_ARGUMENT if there is no such stage. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_stage(
    arrangement: *const lap_arrangement,
    i: i32,
    name: *mut *const c_char,
    seconds: *mut f64,
) -> i32 {
    guard(|_| {
        let stages = &unsafe { handle(arrangement) }?.stages;
        let (text, time) = &stages[index(i, stages.len())?];
        unsafe {
            put(name, text.as_ptr());
            put(seconds, *time);
        }
        Ok(())
    })
}

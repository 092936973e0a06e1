//! The noun `lap_complex`, second half: what is computed on demand, once, and kept with the handle.

use super::complex::lap_complex;
use super::context::{lap_context, with_context};
use super::guard::guard;
use super::view::handle;
use crate::base::{Error, Status};
use std::ffi::c_char;

/// Faces with holes: one polygon per loop.
pub const LAP_FACES_HOLES: i32 = 0;
/// Every hole joined to its outer loop by a bridge that is walked twice: one polygon per face.
pub const LAP_FACES_BRIDGED: i32 = 1;
/// Triangles.
pub const LAP_FACES_TRIANGLES: i32 = 2;

/// The moments of the cells: volume and centroid, in powers of the units of the input.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of cells; volumes: count; centroids: 3 × count;
/// flags: count, nonzero where a moment is beyond the range of double (it is then infinite, or 0). Every number is
/// within 4 units in the last place of the exact one.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INTERNAL. Threads: any. Cost: one walk over all faces at
/// the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_cell_moments(
    complex: *const lap_complex,
    count: *mut i64,
    volumes: *mut *const f64,
    centroids: *mut *const f64,
    flags: *mut *const u8,
) -> i32 {
    let _ = (count, volumes, centroids, flags);
    guard(|_| unsafe { handle(complex) }.and(Err(Status::Internal)))
}

/// The moments of the faces: area vector (along the face's normal, its length the area) and centroid.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of faces; area_vectors: 3 × count; centroids: 3 ×
/// count; flags: count, nonzero where a moment is beyond the range of double (it is then infinite, or 0). Every number
/// is within 4 units in the last place of the exact one.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INTERNAL. Threads: any. Cost: one walk over all faces at
/// the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_face_moments(
    complex: *const lap_complex,
    count: *mut i64,
    area_vectors: *mut *const f64,
    centroids: *mut *const f64,
    flags: *mut *const u8,
) -> i32 {
    let _ = (count, area_vectors, centroids, flags);
    guard(|_| unsafe { handle(complex) }.and(Err(Status::Internal)))
}

/// The faces as plain polygons, without new vertices.
///
/// style: LAP_FACES_HOLES, LAP_FACES_BRIDGED or LAP_FACES_TRIANGLES. Outputs (each may be NULL; borrowed as the complex):
/// count: the number of polygons; offsets: count + 1; vertices: those of polygon i are vertices[offsets[i]] up to, not
/// including, vertices[offsets[i + 1]]; faces: for each polygon the face that it is a part of, never falling. Polygons
/// run anticlockwise seen with the face's normal up (holes clockwise).
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_BAD_ARGUMENT for an unknown style, LAP_ERR_INTERNAL.
/// Threads: any. Cost: n log n in the size of each face at the first call for a style, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_polygons(
    complex: *const lap_complex,
    style: i32,
    count: *mut i64,
    offsets: *mut *const i32,
    vertices: *mut *const i32,
    faces: *mut *const i32,
) -> i32 {
    let _ = (style, count, offsets, vertices, faces);
    guard(|_| unsafe { handle(complex) }.and(Err(Status::Internal)))
}

/// What follows across each edge on the surface of the same cell: adjacent(half-face, edge).
///
/// The half-corner 2 c + s is side s of the face of corner c, along the edge from corner c to the next of its loop. Its mate
/// is the half-corner that meets it at that edge inside the same cell.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of corners, as in lap_complex_faces; mates:
/// 2 × count: mates[2 c + s] is the mate of half-corner 2 c + s, -1 outside the solid and for an isolated vertex; faces:
/// count: the face of each corner. So the half-face across is 2 faces[m / 2] + m % 2 for a mate m.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INCONSISTENT if half-faces do not pair up (input that intersects
/// itself). Threads: any. Cost: linear, and radial orders around edges that a cell meets more than once, at the
/// first call; then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_adjacency(
    complex: *const lap_complex,
    count: *mut i64,
    mates: *mut *const i32,
    faces: *mut *const i32,
) -> i32 {
    let _ = (count, mates, faces);
    guard(|_| unsafe { handle(complex) }.and(Err(Status::Internal)))
}

/// The Euler characteristic of the complex and of the solid that it was made from; a correct complex has both equal.
/// Vertices - edges + sum over faces of (1 - holes) - sum over cells of half the Euler characteristics of their shells.
///
/// Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INTERNAL. Threads: any. Cost:
/// linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_euler(complex: *const lap_complex, output: *mut i64, input: *mut i64) -> i32 {
    let _ = (output, input);
    guard(|_| unsafe { handle(complex) }.and(Err(Status::Internal)))
}

/// Checks that a complex is consistent: indices in range, loops and shells closed, each face owned by one or two cells,
/// Euler characteristics equal.
///
/// Errors: LAP_ERR_INCONSISTENT with a message that names the element; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: linear.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_check(context: *mut lap_context, complex: *const lap_complex) -> i32 {
    with_context(context, |_, _| {
        unsafe { handle(complex) }.map_err(|s| Error::new(s, "complex is NULL"))?;
        Err(Error::new(Status::Internal, "not there yet"))
    })
}

/// The exact coordinates of a vertex as canonical strings, "num/den" or "num" for an integer, in decimal. A GMP or CGAL
/// rational reads them.
///
/// Outputs (each may be NULL): x, y, z: valid until the next call with this context.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a vertex that is not there, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: some microseconds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_vertex_exact(
    context: *mut lap_context,
    complex: *const lap_complex,
    vertex: i32,
    x: *mut *const c_char,
    y: *mut *const c_char,
    z: *mut *const c_char,
) -> i32 {
    let _ = (vertex, x, y, z);
    with_context(context, |_, _| {
        unsafe { handle(complex) }.map_err(|s| Error::new(s, "complex is NULL"))?;
        Err(Error::new(Status::Internal, "not there yet"))
    })
}

/// The exact volume of a cell as a canonical string, "num/den" or "num" for an integer, in decimal.
///
/// volume: valid until the next call with this context.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a cell that is not there, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: an exact sum over the cell's faces; the string grows with the number of planes that
/// bound the cell.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_cell_volume_exact(
    context: *mut lap_context,
    complex: *const lap_complex,
    cell: i32,
    volume: *mut *const c_char,
) -> i32 {
    let _ = (cell, volume);
    with_context(context, |_, _| {
        unsafe { handle(complex) }.map_err(|s| Error::new(s, "complex is NULL"))?;
        Err(Error::new(Status::Internal, "not there yet"))
    })
}

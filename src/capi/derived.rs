//! The noun `lap_complex`, second half: what is computed on demand, once, and kept with the handle.
//!
//! Any of many threads may be the first to ask, also from within a callback of a running call. So the work is not done in
//! a context's pool (whose only worker may be waiting for that callback) but in a pool made for the occasion, which
//! costs some tens of microseconds once per demand.

use super::complex::lap_complex;
use super::context::{Pool, State, c_string, lap_context, with_context};
use super::guard::guard;
use super::view::{address, handle, index, put};
use crate::base::{CellId, Error, Status, VertexId};
use crate::complex::{
    self, Adjacency, Complex, FaceArrays, FaceStyle, Moments, adjacency, check_volumes, exact_values, faces_as,
    moments, solid_euler,
};
use std::ffi::c_char;
use std::sync::OnceLock;

/// Faces with holes: one polygon per loop.
pub const LAP_FACES_HOLES: i32 = 0;
/// Every hole joined to its outer loop by a bridge that is walked twice: one polygon per face.
pub const LAP_FACES_BRIDGED: i32 = 1;
/// Triangles.
pub const LAP_FACES_TRIANGLES: i32 = 2;

/// Everything that is computed on demand. A failure is kept as well: it would only fail again.
#[derive(Default)]
pub struct Derived {
    moments: OnceLock<Moments>,
    polygons: [OnceLock<Result<FaceArrays, String>>; 3],
    adjacency: OnceLock<Result<Adjacency, String>>,
    /// Of the complex, and of the solid that was cut.
    euler: OnceLock<Result<(i64, i64), String>>,
}

/// What `slot` holds; the first caller computes it.
fn demand<'a, T: Send + Sync>(
    complex: &'a lap_complex,
    slot: &'a OnceLock<T>,
    compute: impl FnOnce(&Complex) -> T + Send,
) -> Result<&'a T, Status> {
    on_demand(complex.threads, slot, || compute(&complex.data))
}

/// What `slot` holds; the first caller computes it, with so many threads.
pub fn on_demand<T: Send + Sync>(
    threads: usize,
    slot: &OnceLock<T>,
    compute: impl FnOnce() -> T + Send,
) -> Result<&T, Status> {
    if let Some(known) = slot.get() {
        return Ok(known);
    }
    // Made outside of the slot's initialisation, which cannot fail but by a panic; that leaves the slot empty.
    let pool = Pool::new(threads).map_err(|error| error.status)?;
    Ok(slot.get_or_init(|| pool.install(compute)))
}

/// What `slot` holds; the first caller makes it, or fails and leaves the slot as it is.
pub fn once<T>(slot: &OnceLock<T>, make: impl FnOnce() -> Result<T, Error>) -> Result<&T, Error> {
    if let Some(known) = slot.get() {
        return Ok(known);
    }
    let made = make()?;
    Ok(slot.get_or_init(|| made))
}

/// Lends the complex of a noun: NULL if `find` fails.
///
/// Safety: `complex` is NULL or may be written.
pub unsafe fn lend_complex<'a>(
    complex: *mut *const lap_complex,
    find: impl FnOnce() -> Result<&'a lap_complex, Error>,
) -> Result<(), Error> {
    if complex.is_null() {
        return Err(Error::new(Status::NullPointer, "complex is NULL"));
    }
    unsafe { put(complex, std::ptr::null()) };
    let found = find()?;
    unsafe { put(complex, std::ptr::from_ref(found)) };
    Ok(())
}

/// The status of a complex that C cannot number, in words.
pub fn too_many_elements(status: Status) -> Error {
    Error::new(status, "the complex has more elements than 32-bit indices can number")
}

/// A result that only input which intersects itself can make an error.
fn consistent<T>(result: &Result<T, String>) -> Result<&T, Status> {
    result.as_ref().map_err(|_| Status::Inconsistent)
}

/// The moments of the cells: volume and centroid, in powers of the units of the input.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of cells; volumes: count; centroids: 3 × count;
/// flags: count, nonzero where a moment is beyond the range of double (it is then infinite, or 0). Every number is
/// the double nearest to the exact one.
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
    guard(|_| {
        let complex = unsafe { handle(complex) }?;
        let m = demand(complex, &complex.derived.moments, moments)?;
        unsafe {
            put(count, m.cell_volume.len() as i64);
            put(volumes, address(&m.cell_volume));
            put(centroids, address(&m.cell_centroid));
            put(flags, address(&m.cell_flags));
        }
        Ok(())
    })
}

/// The moments of the faces: area vector (along the face's normal, its length the area) and centroid.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of faces; area_vectors: 3 × count; centroids: 3 ×
/// count; flags: count, nonzero where a moment is beyond the range of double (it is then infinite, or 0). Every number
/// is the double nearest to the exact one.
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
    guard(|_| {
        let complex = unsafe { handle(complex) }?;
        let m = demand(complex, &complex.derived.moments, moments)?;
        unsafe {
            put(count, m.face_area_vector.len() as i64);
            put(area_vectors, address(&m.face_area_vector));
            put(centroids, address(&m.face_centroid));
            put(flags, address(&m.face_flags));
        }
        Ok(())
    })
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
    guard(|_| {
        let complex = unsafe { handle(complex) }?;
        let wanted = match style {
            LAP_FACES_HOLES => FaceStyle::Holes,
            LAP_FACES_BRIDGED => FaceStyle::Bridged,
            LAP_FACES_TRIANGLES => FaceStyle::Triangulated,
            _ => return Err(Status::BadArgument),
        };
        let slot = &complex.derived.polygons[style as usize];
        let polygons = consistent(demand(complex, slot, |c| {
            // Bridges are walked twice, so this style can outgrow C's index type where the loops do not.
            faces_as(c, wanted).and_then(|p| match i32::try_from(p.vertices.len()) {
                Ok(_) => Ok(p),
                Err(_) => Err("more corners than an index can count".into()),
            })
        })?)?;
        unsafe {
            put(count, polygons.source_face.len() as i64);
            put(offsets, address(&polygons.offsets));
            put(vertices, address(&polygons.vertices));
            put(faces, address(&polygons.source_face));
        }
        Ok(())
    })
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
    guard(|_| {
        let complex = unsafe { handle(complex) }?;
        let found = consistent(demand(complex, &complex.derived.adjacency, adjacency)?)?;
        unsafe {
            put(count, found.corner_face.len() as i64);
            put(mates, address(&found.mates));
            put(faces, address(&found.corner_face));
        }
        Ok(())
    })
}

/// The Euler characteristic of the complex and of the solid that it was made from; a correct complex has both equal.
/// Vertices - edges + sum over faces of (1 - holes) - sum over cells of half the Euler characteristics of their shells (a
/// vertex counts once per umbrella; where the tip of a void or of a dent touches a plane, the shells there count as
/// joined by a tube). Of a network's complex they may differ where shells of one region touch in a point.
///
/// Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INCONSISTENT if half-faces do not pair
/// up (input that intersects itself). Threads: any. Cost:
/// linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_euler(complex: *const lap_complex, output: *mut i64, input: *mut i64) -> i32 {
    guard(|_| {
        let complex = unsafe { handle(complex) }?;
        let both = |c: &Complex| complex::euler(c).map(|output| (output, solid_euler(&c.mesh)));
        let (of_output, of_input) = *consistent(demand(complex, &complex.derived.euler, both)?)?;
        unsafe {
            put(output, of_output);
            put(input, of_input);
        }
        Ok(())
    })
}

/// Checks that a complex is consistent: indices in range, loops and shells closed, each face owned by one or two cells,
/// Euler characteristics equal.
///
/// Errors: LAP_ERR_INCONSISTENT with a message that names the element; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: linear.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_check(context: *mut lap_context, complex: *const lap_complex) -> i32 {
    with_context(context, |state, host| {
        let complex = unsafe { handle(complex) }.map_err(null_complex)?;
        let whole = !complex.part;
        state.run(host, |_| {
            if whole { check(&complex.data) } else { complex::check_part(&complex.data).map_err(Error::inconsistent) }
        })
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
    with_context(context, |state, _| {
        let c = &unsafe { handle(complex) }.map_err(null_complex)?.data;
        let vertex = index(vertex, c.vertex_count()).map_err(|s| no_such("vertex", vertex, c.vertex_count(), s))?;
        unsafe { put_strings(state, exact_values::vertex_strings(c, VertexId::of(vertex)), [x, y, z]) };
        Ok(())
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
    with_context(context, |state, _| {
        let c = &unsafe { handle(complex) }.map_err(null_complex)?.data;
        if volume.is_null() {
            return Err(Error::new(Status::NullPointer, "volume is NULL"));
        }
        let cell = index(cell, c.cell_count()).map_err(|s| no_such("cell", cell, c.cell_count(), s))?;
        unsafe { put(volume, keep(state, &exact_values::cell_volume_string(c, CellId::of(cell)))) };
        Ok(())
    })
}

/// Structure, then areas and volumes by residues.
pub fn check(c: &Complex) -> Result<(), Error> {
    complex::check(c).and_then(|()| check_volumes(c)).map_err(Error::inconsistent)
}

/// Keeps a string in the context; its address.
pub fn keep(state: &mut State, text: &str) -> *const c_char {
    state.strings[0] = c_string(text);
    state.strings[0].as_ptr()
}

/// Keeps three strings in the context and writes their addresses.
///
/// # Safety
/// Each of `to` is null or writable.
pub unsafe fn put_strings(state: &mut State, texts: [String; 3], to: [*mut *const c_char; 3]) {
    for ((kept, text), to) in state.strings.iter_mut().zip(texts).zip(to) {
        *kept = c_string(&text);
        unsafe { put(to, kept.as_ptr()) };
    }
}

fn null_complex(status: Status) -> Error {
    Error::new(status, "complex is NULL")
}

fn no_such(what: &str, i: i32, count: usize, status: Status) -> Error {
    Error::new(status, format!("{what} {i} is not there: {count} in all, counted from 0"))
}

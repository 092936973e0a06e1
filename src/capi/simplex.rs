//! The noun `lap_simplex`: what linear functions do to single simplices, many in one call.

use super::context::{c_string, lap_context, with_context};
use super::derived::keep;
use super::guard::guard;
use super::view::{address, handle, handle_mut, index, input, into_handle, put};
use crate::base::{Error, Status};
use crate::network::simplex::batch::{Order, SimplexBatch};
use crate::network::simplex::{
    ENTRIES, FaceSupport, Kind, LocalCell, LocalVertex, PERMUTATIONS, SYMMETRIES, exact_values,
};
use std::ffi::c_char;
use std::sync::OnceLock;

/// The arrangement (IA): the planes where a function is zero divide the simplex.
pub const LAP_SIMPLEX_ARRANGEMENT: i32 = 0;
/// The material interface (MI): cells are where a material is the largest.
pub const LAP_SIMPLEX_INTERFACE: i32 = 1;

/// A face in a facet of the simplex; its positive side is the simplex. ids: the corner opposite to the facet
pub const LAP_SIMPLEX_FACET: i32 = 0;
/// A face on the plane of a function, inside the simplex; positive where the function is. ids: the lowest such function
pub const LAP_SIMPLEX_FUNCTION: i32 = 1;
/// A face between two materials; positive where the first is larger. ids: the owners of the cells on its positive and on its
/// negative side, the first one lower
pub const LAP_SIMPLEX_PAIR: i32 = 2;

/// The complexes of tetrahedra or triangles, each divided by linear functions that are given by their values at its corners:
/// cells, faces, edges and vertices, the simplex's own boundary included. Exact for any finite values.
///
/// Faces separate cells: polygons in a tetrahedron, segments in a triangle, where there are no edges. Cells and faces are convex,
/// without straight corners, so the complex is fixed by the functions alone; their order changes numbers, and nothing else. Ids
/// count through all simplices of a call: those of simplex s are the ones between offsets that lap_simplex_offsets
/// tells. A simplex's own corners are its first vertices. In one whose corners are oriented the other way than
/// det(b - a, c - a, d - a) > 0, anticlockwise is to be read as clockwise.
///
/// Ties. Arrangement: a function that is zero everywhere, or on a lower-dimensional part of the boundary only, divides nothing;
/// functions with the same plane (f, 2 f, -f) share its faces. Interface: of materials that are equal everywhere the lowest owns the
/// cell; a material that is largest on a lower-dimensional set only has no cell and divides nothing. All of them are named
/// where they are zero (largest).
///
/// Half-faces: side 0 of face f, 2 f, is its positive side, side 1, 2 f + 1, its negative one. (A face of lap_complex has its owner
/// behind it, on side 0: that is the negative side of its normal.)
///
/// One handle is filled again and again, and keeps its memory; filling it needs it alone. Otherwise a const handle may be
/// used from many threads at once.
#[derive(Default)]
pub struct lap_simplex {
    batch: SimplexBatch,
    supports: OnceLock<(Vec<i32>, Vec<[i32; 2]>)>,
    signs: OnceLock<Vec<i32>>,
    tables: OnceLock<Tables>,
}

/// Of each simplex.
#[derive(Default)]
struct Tables {
    entries: Vec<i32>,
    corners: Vec<[i32; 4]>,
    functions: Vec<[i32; 3]>,
    flips: Vec<u8>,
}

const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<lap_simplex>();
};

/// Makes a handle without simplices, to be filled by lap_simplex_compute.
///
/// simplex: receives the handle; free it with lap_simplex_free.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: an allocation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_new(simplex: *mut *mut lap_simplex) -> i32 {
    guard(|_| {
        if simplex.is_null() {
            return Err(Status::NullPointer);
        }
        let mut made = lap_simplex::default();
        made.batch.forget();
        unsafe { put(simplex, into_handle(made)) };
        Ok(())
    })
}

/// Frees a handle and all that was borrowed from it. NULL is allowed and does nothing.
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_free(simplex: *mut lap_simplex) -> i32 {
    guard(|_| {
        if !simplex.is_null() {
            drop(unsafe { Box::from_raw(simplex) });
        }
        Ok(())
    })
}

/// Divides simplices, all alike in kind, dimension and number of functions.
///
/// Inputs (borrowed for the call): kind: LAP_SIMPLEX_ARRANGEMENT or LAP_SIMPLEX_INTERFACE; dim: 3 for tetrahedra, 2 for
/// triangles; n_simplices: may be 0; n_functions: of each simplex, or materials; an arrangement may have none; values:
/// n_simplices × n_functions × (dim + 1) numbers, value (s, f, c) of function f at corner c of simplex s at
/// (s n_functions + f) (dim + 1) + c.
/// simplex: what it had is replaced, and what was borrowed from it is no longer valid; after an error it has no simplices.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for a kind or dimension that there is not, a negative count, an interface of no materials, and, with a
/// message that names function, corner and simplex, for a value that is NaN or infinite; LAP_ERR_TOO_LARGE if the result has
/// more elements than 32-bit indices can number; LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY.
/// Cost: of each simplex, as its complex is large: an arrangement of n functions has up to n^3 / 6 cells, and costs
/// n^3 steps or less; and some microseconds for the call, so pass many at a time. Simplices are shared out among the context's threads.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_compute(
    context: *mut lap_context,
    simplex: *mut lap_simplex,
    kind: i32,
    dim: i32,
    n_simplices: i64,
    n_functions: i64,
    values: *const f64,
) -> i32 {
    with_context(context, |state, host| {
        let simplex = unsafe { handle_mut(simplex) }.map_err(null_simplex)?;
        simplex.supports.take();
        simplex.signs.take();
        simplex.tables.take();
        let batch = &mut simplex.batch;
        batch.forget();
        let order = unsafe { read_order(kind, dim, n_simplices, n_functions, values) }?;
        state.run(host, |_| {
            order.validate()?;
            batch.build(&order)
        })
    })
}

/// # Safety
/// `values` is null or as `lap_simplex_compute` says.
unsafe fn read_order<'a>(
    kind: i32,
    dim: i32,
    n_simplices: i64,
    n_functions: i64,
    values: *const f64,
) -> Result<Order<'a>, Error> {
    let bad = |message: String| Error::new(Status::BadArgument, message);
    let kind = match kind {
        LAP_SIMPLEX_ARRANGEMENT => Kind::Arrangement,
        LAP_SIMPLEX_INTERFACE => Kind::Interface,
        other => return Err(bad(format!("kind: {other} is no LAP_SIMPLEX_*"))),
    };
    if dim != 2 && dim != 3 {
        return Err(bad(format!("dim: {dim} is neither 2 nor 3")));
    }
    if n_simplices < 0 || n_functions < 0 {
        return Err(bad(format!("{n_simplices} simplices of {n_functions} functions: a count is negative")));
    }
    let large = || Error::new(Status::TooLarge, "there are more values than 32-bit indices can number");
    let each = n_functions.checked_mul(i64::from(dim) + 1).ok_or_else(large)?;
    let count = n_simplices.checked_mul(each).ok_or_else(large)?;
    if n_simplices > i64::from(i32::MAX) || n_functions > i64::from(i32::MAX) {
        return Err(large());
    }
    let values = unsafe { input(values, count) }.map_err(|status| Error::new(status, "values"))?;
    Ok(Order { kind, dim: dim as usize, simplices: n_simplices as usize, functions: n_functions as usize, values })
}

fn null_simplex(status: Status) -> Error {
    Error::new(status, "simplex is NULL")
}

/// How many elements the complexes of all simplices have together.
///
/// Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_counts(
    simplex: *const lap_simplex,
    simplices: *mut i64,
    vertices: *mut i64,
    edges: *mut i64,
    faces: *mut i64,
    cells: *mut i64,
) -> i32 {
    guard(|_| {
        let batch = &unsafe { handle(simplex) }?.batch;
        unsafe {
            put(simplices, batch.len() as i64);
            put(vertices, batch.all.vertex_count() as i64);
            put(edges, batch.all.edge_count() as i64);
            put(faces, batch.all.face_count() as i64);
            put(cells, batch.all.cell_count() as i64);
        }
        Ok(())
    })
}

/// Which elements are those of each simplex: of simplex s the vertices vertices[s] up to, not including, vertices[s + 1],
/// and alike the edges, faces, cells and planes.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of simplices; vertices, edges,
/// faces, cells, planes: count + 1 each.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_offsets(
    simplex: *const lap_simplex,
    count: *mut i64,
    vertices: *mut *const i32,
    edges: *mut *const i32,
    faces: *mut *const i32,
    cells: *mut *const i32,
    planes: *mut *const i32,
) -> i32 {
    guard(|_| {
        let batch = &unsafe { handle(simplex) }?.batch;
        unsafe {
            put(count, batch.len() as i64);
            put(vertices, address(&batch.first_vertex));
            put(edges, address(&batch.first_edge));
            put(faces, address(&batch.first_face));
            put(cells, address(&batch.first_cell));
            put(planes, address(&batch.first_plane));
        }
        Ok(())
    })
}

/// Where the complex of each simplex comes from: a look-up table (one or two functions, two or three materials), or construction.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of simplices; n_entries: how many entries the
/// tables have in all, complexes that no permutation of corners and no symmetry of functions makes alike; entries: count, the
/// entry of each simplex, -1 where it was constructed; corners: 4 × count, the simplex's corner for each of the entry's; functions: 3 × count, the
/// function (material) for each of the entry's; -1 where there is none; flips: a byte for each, bit k set where the entry's function k
/// has the opposite sign.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: some ten nanoseconds a simplex at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_tables(
    simplex: *const lap_simplex,
    count: *mut i64,
    n_entries: *mut i64,
    entries: *mut *const i32,
    corners: *mut *const i32,
    functions: *mut *const i32,
    flips: *mut *const u8,
) -> i32 {
    guard(|_| {
        let simplex = unsafe { handle(simplex) }?;
        let tables = simplex.tables.get_or_init(|| tables(&simplex.batch));
        unsafe {
            put(count, tables.entries.len() as i64);
            put(n_entries, ENTRIES.len() as i64);
            put(entries, address(&tables.entries));
            put(corners, address(&tables.corners));
            put(functions, address(&tables.functions));
            put(flips, address(&tables.flips));
        }
        Ok(())
    })
}

fn tables(batch: &SimplexBatch) -> Tables {
    let mut tables = Tables::default();
    for simplex in 0..batch.len() {
        let (mut entry, mut corners, mut functions, mut flips) = (-1, [-1; 4], [-1; 3], 0);
        if let Some(found) = batch.found(simplex) {
            entry = found.entry.into();
            let (permutation, symmetry) = (PERMUTATIONS[found.corners as usize], SYMMETRIES[found.functions as usize]);
            (0..=batch.all.dim).for_each(|k| corners[k] = permutation[k].into());
            (0..batch.all.functions).for_each(|k| functions[k] = symmetry.to[k].into());
            flips = symmetry.flip;
        }
        tables.entries.push(entry);
        tables.corners.push(corners);
        tables.functions.push(functions);
        tables.flips.push(flips);
    }
    tables
}

/// What each vertex is: the point of an open sub-simplex (corner, edge, triangle, tetrahedron; of dimension d) where some
/// functions are zero, or some materials equal.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; carriers: count numbers, bit c (1, 2, 4, 8)
/// set for each corner c of the sub-simplex; codes: 4 × count, the d functions that are zero there and fix the point (or the
/// d + 1 materials that are equal), then -1; where more go through the point there are other choices.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_vertices(
    simplex: *const lap_simplex,
    count: *mut i64,
    carriers: *mut *const u8,
    codes: *mut *const i32,
) -> i32 {
    guard(|_| {
        let all = &unsafe { handle(simplex) }?.batch.all;
        unsafe {
            put(count, all.vertex_count() as i64);
            put(carriers, address(&all.vertex_carrier));
            put(codes, address(&all.vertex_encoding));
        }
        Ok(())
    })
}

/// All functions that are zero at each vertex, without those that are zero everywhere, rising; or all materials that are largest
/// there.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of vertices; offsets:
/// count + 1; functions: those of vertex v are functions[offsets[v]] up to, not including, functions[offsets[v + 1]].
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_vertex_functions(
    simplex: *const lap_simplex,
    count: *mut i64,
    offsets: *mut *const i32,
    functions: *mut *const i32,
) -> i32 {
    guard(|_| {
        let all = &unsafe { handle(simplex) }?.batch.all;
        unsafe {
            put(count, all.vertex_functions.len() as i64);
            put(offsets, address(&all.vertex_functions.offsets));
            put(functions, address(&all.vertex_functions.items));
        }
        Ok(())
    })
}

/// The edges of tetrahedra; there are none in triangles.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; vertices: 2 × count.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_edges(
    simplex: *const lap_simplex,
    count: *mut i64,
    vertices: *mut *const i32,
) -> i32 {
    guard(|_| {
        let all = &unsafe { handle(simplex) }?.batch.all;
        unsafe {
            put(count, all.edge_count() as i64);
            put(vertices, address(&all.edges));
        }
        Ok(())
    })
}

/// The faces: in a tetrahedron the corners of each polygon, anticlockwise as seen from its positive side; in a triangle the two ends
/// of each segment, its positive side on the left of the way from the first to the second.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; offsets: count + 1, face f has the corners
/// offsets[f] up to, not including, offsets[f + 1]; vertices: the vertex of each corner; edges: the edge from each corner
/// to the next of its face (from the last to the first), NULL in triangles.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_faces(
    simplex: *const lap_simplex,
    count: *mut i64,
    offsets: *mut *const i32,
    vertices: *mut *const i32,
    edges: *mut *const i32,
) -> i32 {
    guard(|_| {
        let all = &unsafe { handle(simplex) }?.batch.all;
        unsafe {
            put(count, all.face_count() as i64);
            put(offsets, address(&all.face_vertices.offsets));
            put(vertices, address(&all.face_vertices.items));
            put(edges, address(&all.face_edges));
        }
        Ok(())
    })
}

/// What each face lies on, and the cells on its two sides.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; kinds: count numbers
/// LAP_SIMPLEX_FACET, LAP_SIMPLEX_FUNCTION or LAP_SIMPLEX_PAIR; ids: 2 × count, as these say, -1 where unused; planes: for each
/// face the plane that it lies on (see lap_simplex_planes); cells: 2 × count, those on its positive and on its negative side, -1 outside
/// of the simplex.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: kinds and ids: linear at the first call, then
/// none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_face_supports(
    simplex: *const lap_simplex,
    count: *mut i64,
    kinds: *mut *const i32,
    ids: *mut *const i32,
    planes: *mut *const i32,
    cells: *mut *const i32,
) -> i32 {
    guard(|_| {
        let simplex = unsafe { handle(simplex) }?;
        let all = &simplex.batch.all;
        if !kinds.is_null() || !ids.is_null() {
            let (of_kind, of_ids) = simplex.supports.get_or_init(|| {
                let number = |support: &FaceSupport| match *support {
                    FaceSupport::Facet(corner) => (LAP_SIMPLEX_FACET, [corner.into(), -1]),
                    FaceSupport::Function(f) => (LAP_SIMPLEX_FUNCTION, [f.0 as i32, -1]),
                    FaceSupport::Pair(a, b) => (LAP_SIMPLEX_PAIR, [a.0 as i32, b.0 as i32]),
                };
                all.face_support.iter().map(number).unzip()
            });
            unsafe {
                put(kinds, address(of_kind));
                put(ids, address(of_ids));
            }
        }
        unsafe {
            put(count, all.face_count() as i64);
            put(planes, address(&all.face_plane));
            put(cells, address(&all.face_cells));
        }
        Ok(())
    })
}

/// Planes that faces lie on, with all functions that are zero on them, rising, without those that are zero everywhere. Arrangement: those
/// of a simplex are its facets (facet c is opposite to corner c; functions may be zero there as well), then planes inside, which
/// all coplanar faces share. Interface: one for each face, with all materials that are largest on the whole face.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; offsets: count + 1; functions: those of
/// plane p are functions[offsets[p]] up to, not including, functions[offsets[p + 1]]; opposite: arrangement: for each of these
/// functions 1 where it is negative on the positive side of the plane, 0 where it is positive; interface: NULL.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_planes(
    simplex: *const lap_simplex,
    count: *mut i64,
    offsets: *mut *const i32,
    functions: *mut *const i32,
    opposite: *mut *const u8,
) -> i32 {
    guard(|_| {
        let all = &unsafe { handle(simplex) }?.batch.all;
        unsafe {
            put(count, all.plane_functions.len() as i64);
            put(offsets, address(&all.plane_functions.offsets));
            put(functions, address(&all.plane_functions.items));
            put(opposite, address(&all.plane_opposite));
        }
        Ok(())
    })
}

/// The half-faces that bound each cell.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of cells; offsets: count + 1;
/// half_faces: those of cell c are half_faces[offsets[c]] up to, not including, half_faces[offsets[c + 1]]; 2 f where the cell is on the
/// positive side of face f, 2 f + 1 where it is on the negative one.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_cells(
    simplex: *const lap_simplex,
    count: *mut i64,
    offsets: *mut *const i32,
    half_faces: *mut *const i32,
) -> i32 {
    guard(|_| {
        let all = &unsafe { handle(simplex) }?.batch.all;
        unsafe {
            put(count, all.cell_count() as i64);
            put(offsets, address(&all.cell_faces.offsets));
            put(half_faces, address(&all.cell_faces.items));
        }
        Ok(())
    })
}

/// The sign of every function in each cell of an arrangement.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of cells; functions: n, the
/// number of functions; signs: count × n, sign (c, f) at c n + f: -1, 1, or 0 where the function is zero on the whole simplex.
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL; LAP_ERR_BAD_ARGUMENT for an interface. Threads: any. Cost: linear at the first
/// call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_cell_signs(
    simplex: *const lap_simplex,
    count: *mut i64,
    functions: *mut i64,
    signs: *mut *const i32,
) -> i32 {
    guard(|_| {
        let simplex = unsafe { handle(simplex) }?;
        let all = &simplex.batch.all;
        if all.kind != Kind::Arrangement {
            return Err(Status::BadArgument);
        }
        if !signs.is_null() {
            let of_cells = simplex.signs.get_or_init(|| simplex.batch.signs());
            unsafe { put(signs, address(of_cells)) };
        }
        unsafe {
            put(count, all.cell_count() as i64);
            put(functions, all.functions as i64);
        }
        Ok(())
    })
}

/// The material of each cell of an interface.
///
/// Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of cells; owners: count numbers, the
/// lowest material that is largest in the cell; offsets: count + 1; materials: all that are, which are equal everywhere, rising: those
/// of cell c are materials[offsets[c]] up to, not including, materials[offsets[c + 1]].
///
/// Errors: LAP_ERR_NULL_POINTER if simplex is NULL; LAP_ERR_BAD_ARGUMENT for an arrangement. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_cell_materials(
    simplex: *const lap_simplex,
    count: *mut i64,
    owners: *mut *const i32,
    offsets: *mut *const i32,
    materials: *mut *const i32,
) -> i32 {
    guard(|_| {
        let all = &unsafe { handle(simplex) }?.batch.all;
        if all.kind != Kind::Interface {
            return Err(Status::BadArgument);
        }
        unsafe {
            put(count, all.cell_count() as i64);
            put(owners, address(&all.cell_owner));
            put(offsets, address(&all.cell_materials.offsets));
            put(materials, address(&all.cell_materials.items));
        }
        Ok(())
    })
}

/// The exact barycentric coordinates of a vertex, one for each corner of its simplex, as canonical strings, "num/den" or
/// "num" for an integer, in decimal. They are not negative, and their sum is 1. A GMP or CGAL rational reads them.
///
/// Outputs (each may be NULL): a, b, c, d: valid until the next call with this context; d is "0" in a triangle.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a vertex that is not there, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: some microseconds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_vertex_exact(
    context: *mut lap_context,
    simplex: *const lap_simplex,
    vertex: i32,
    a: *mut *const c_char,
    b: *mut *const c_char,
    c: *mut *const c_char,
    d: *mut *const c_char,
) -> i32 {
    with_context(context, |state, _| {
        let batch = &unsafe { handle(simplex) }.map_err(null_simplex)?.batch;
        let v = index(vertex, batch.all.vertex_count()).map_err(|s| no_such("vertex", vertex, s))?;
        let values = batch.values_at_vertex(LocalVertex::of(v));
        let x = exact_values::vertex(&batch.all, values, LocalVertex::of(v));
        state.strings = x.map(|x| c_string(&x.to_string()));
        for (out, text) in [a, b, c, d].into_iter().zip(&state.strings) {
            unsafe { put(out, text.as_ptr()) };
        }
        Ok(())
    })
}

/// The exact volume of a cell as a part of its simplex's volume (in a triangle: area), as a canonical string, "num/den" or "num" for an
/// integer, in decimal. Those of the cells of a simplex have the sum 1.
///
/// volume: valid until the next call with this context.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a cell that is not there, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost:
/// some microseconds for each corner of each face.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_cell_volume_exact(
    context: *mut lap_context,
    simplex: *const lap_simplex,
    cell: i32,
    volume: *mut *const c_char,
) -> i32 {
    with_context(context, |state, _| {
        let batch = &unsafe { handle(simplex) }.map_err(null_simplex)?.batch;
        if volume.is_null() {
            return Err(Error::new(Status::NullPointer, "volume is NULL"));
        }
        let c = LocalCell::of(index(cell, batch.all.cell_count()).map_err(|s| no_such("cell", cell, s))?);
        let values = batch.values_at_cell(c);
        unsafe { put(volume, keep(state, &exact_values::cell_volume(&batch.all, values, c).to_string())) };
        Ok(())
    })
}

fn no_such(what: &str, number: i32, status: Status) -> Error {
    Error::new(status, format!("there is no {what} {number}"))
}

/// Checks that the complexes are consistent: indices in range, faces closed, between the cells that name them and
/// oriented as they say, cells closed.
///
/// Errors: LAP_ERR_INCONSISTENT with a message that names the element; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. Cost: linear.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_simplex_check(context: *mut lap_context, simplex: *const lap_simplex) -> i32 {
    with_context(context, |state, host| {
        let simplex = unsafe { handle(simplex) }.map_err(null_simplex)?;
        state.run(host, |_| simplex.batch.check().map_err(Error::inconsistent))
    })
}

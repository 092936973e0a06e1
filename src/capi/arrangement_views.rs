//! The noun `lap_arrangement`, second part: vertices, faces, patches and cells, as borrowed views.

use super::arrangement::{lap_arrangement, null_arrangement};
use super::complex::{lap_complex, number_origin};
use super::context::{lap_context, with_context};
use super::derived::{keep, lend_complex, on_demand, once, put_strings, too_many_elements};
use super::guard::guard;
use super::view::{address, handle, index, put};
use crate::arrangement::solids::{every_cell, solids};
use crate::arrangement::volumes::cell_volumes;
use crate::arrangement::{Arrangement, Multiplicity};
use crate::base::{CellId, Csr, Error, FaceId, OperandId, Status, TriangleId, VertexId};
use crate::exact::{rational, round_rational};
use rug::Rational;
use std::ffi::c_char;
use std::sync::OnceLock;

/// What C reads in another form than the engine keeps it.
#[derive(Default)]
pub struct Views {
    xyz: OnceLock<Vec<[f64; 3]>>,
    origins: OnceLock<(Vec<i32>, Vec<[i32; 3]>)>,
    births: OnceLock<Births>,
    patch_cells: OnceLock<Vec<[CellId; 2]>>,
    multiplicities: OnceLock<(Vec<OperandId>, Vec<i32>)>,
    windings: OnceLock<(Vec<OperandId>, Vec<i32>)>,
    volumes: OnceLock<(Vec<Rational>, Vec<f64>)>,
    complex: OnceLock<lap_complex>,
}

/// Of all faces. Empty offsets: too many for C's indices.
#[derive(Default)]
struct Births {
    offsets: Vec<u32>,
    operands: Vec<OperandId>,
    triangles: Vec<u32>,
    reversed: Vec<bool>,
}

fn births(a: &Arrangement) -> Births {
    let (resolved, soup) = (&a.resolved, &a.resolved.soup);
    let mut all = Births { offsets: vec![0], ..Births::default() };
    for f in (0..a.face_count()).map(FaceId::of) {
        for b in resolved.births_of(f) {
            all.operands.push(soup.operand(b.triangle));
            all.triangles.push(soup.place(b.triangle));
            all.reversed.push(!b.same);
        }
        all.offsets.push(all.operands.len() as u32);
        if all.operands.len() > i32::MAX as usize {
            return Births::default();
        }
    }
    all
}

fn split(rows: &Csr<Multiplicity>) -> (Vec<OperandId>, Vec<i32>) {
    rows.items.iter().copied().unzip()
}

/// The vertices. No two are the same point; not all of them are corners of faces.
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): count; xyz: 3 × count coordinates, each the double nearest to
/// the exact one (zero is +0).
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: a copy at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_vertices(
    arrangement: *const lap_arrangement,
    count: *mut i64,
    xyz: *mut *const f64,
) -> i32 {
    guard(|_| {
        let arrangement = unsafe { handle(arrangement) }?;
        let a = &arrangement.data;
        let copy = || [&a.resolved.soup.mesh.vertices[..], &a.resolved.points.coords].concat();
        unsafe {
            put(count, a.vertex_count() as i64);
            if !xyz.is_null() {
                put(xyz, address(on_demand(arrangement.threads, &arrangement.views.xyz, copy)?));
            }
        }
        Ok(())
    })
}

/// What each vertex is, symbolically: LAP_VERTEX_MESH, or LAP_VERTEX_TRIANGLES; with half-spaces any but LAP_VERTEX_LEVEL, planes by the index of the
/// half-space (of coincident ones the lowest).
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): count; kinds: count numbers LAP_VERTEX_*; ids: 3 × count, as
/// LAP_VERTEX_* says, vertices and triangles counting through all operands (of equal vertices the first), -1 where unused.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_vertex_origins(
    arrangement: *const lap_arrangement,
    count: *mut i64,
    kinds: *mut *const i32,
    ids: *mut *const i32,
) -> i32 {
    guard(|_| {
        let arrangement = unsafe { handle(arrangement) }?;
        let (a, soup) = (&arrangement.data, &arrangement.data.resolved.soup);
        let triangle =
            |t: TriangleId| (arrangement.first_triangle[soup.operand(t).at()] + i64::from(soup.source[t.at()])) as i32;
        let number = |v: usize| number_origin(&soup.mesh, triangle, |_| -1, &a.origin(VertexId::of(v)));
        let all = || (0..a.vertex_count()).map(number).unzip();
        let (of_kind, of_ids) = on_demand(arrangement.threads, &arrangement.views.origins, all)?;
        unsafe {
            put(count, of_kind.len() as i64);
            put(kinds, address(of_kind));
            put(ids, address(of_ids));
        }
        Ok(())
    })
}

/// The exact coordinates of a vertex as canonical strings, "num/den" or "num" for an integer, in decimal. A GMP or CGAL
/// rational reads them.
///
/// Outputs (each may be NULL): x, y, z: valid until the next call with this context.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for a vertex that is not there; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: some
/// microseconds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_vertex_exact(
    context: *mut lap_context,
    arrangement: *const lap_arrangement,
    vertex: i32,
    x: *mut *const c_char,
    y: *mut *const c_char,
    z: *mut *const c_char,
) -> i32 {
    with_context(context, |state, _| {
        let a = &unsafe { handle(arrangement) }.map_err(null_arrangement)?.data;
        let none = |status| Error::new(status, format!("there is no vertex {vertex}"));
        let v = VertexId::of(index(vertex, a.vertex_count()).map_err(none)?);
        let texts = rational(&a.point(v)).map(|coordinate| coordinate.to_string());
        unsafe { put_strings(state, texts, [x, y, z]) };
        Ok(())
    })
}

/// The faces. Those that are whole input triangles come first, in their order, then the parts of others.
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): count; vertices: 3 × count; patches: of each, -1 where a face divides
/// nothing; cells: 2 × count: the cell behind it, which its normal points away from, and the cell before it; -1 where it divides nothing. Seen from the
/// tip of its normal a face runs anticlockwise.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_faces(
    arrangement: *const lap_arrangement,
    count: *mut i64,
    vertices: *mut *const i32,
    patches: *mut *const i32,
    cells: *mut *const i32,
) -> i32 {
    guard(|_| {
        let a = &unsafe { handle(arrangement) }?.data;
        unsafe {
            put(count, a.face_count() as i64);
            put(vertices, address(&a.resolved.faces));
            put(patches, address(&a.cells.patch));
            put(cells, address(&a.cells.of));
        }
        Ok(())
    })
}

/// The input triangles that each face is a part of.
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): count: the number of faces; offsets: count + 1; operands, triangles,
/// reversed: those of face f are from place offsets[f] up to, not including, place offsets[f + 1]: the operand, the triangle by its place in that operand's
/// list, and a byte, 1 where it runs against the face. They rise; the first runs like the face.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL; LAP_ERR_TOO_LARGE if they are more than 32-bit indices can number;
/// LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_face_births(
    arrangement: *const lap_arrangement,
    count: *mut i64,
    offsets: *mut *const i32,
    operands: *mut *const i32,
    triangles: *mut *const i32,
    reversed: *mut *const u8,
) -> i32 {
    guard(|_| {
        let arrangement = unsafe { handle(arrangement) }?;
        let all = on_demand(arrangement.threads, &arrangement.views.births, || births(&arrangement.data))?;
        if all.offsets.is_empty() {
            return Err(Status::TooLarge);
        }
        unsafe {
            put(count, arrangement.data.face_count() as i64);
            put(offsets, address(&all.offsets));
            put(operands, address(&all.operands));
            put(triangles, address(&all.triangles));
            put(reversed, address(&all.reversed));
        }
        Ok(())
    })
}

/// The patches, numbered by their lowest faces.
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): count; faces: the lowest face of each; cells: 2 × count: behind and before
/// that face, and so behind and before all faces of the patch (those that run the other way: before and behind); offsets: count + 1; operands,
/// multiplicities: those of patch p are from place offsets[p] up to, not including, place offsets[p + 1]: operands, rising, and how many triangles of it run like the lowest face,
/// less those that run against it. So much is the winding number behind higher than the one before it. Operands where that is 0 are left out.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the patches at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_patches(
    arrangement: *const lap_arrangement,
    count: *mut i64,
    faces: *mut *const i32,
    cells: *mut *const i32,
    offsets: *mut *const i32,
    operands: *mut *const i32,
    multiplicities: *mut *const i32,
) -> i32 {
    guard(|_| {
        let arrangement = unsafe { handle(arrangement) }?;
        let (a, views, threads) = (&arrangement.data, &arrangement.views, arrangement.threads);
        let both = || a.cells.patch_face.iter().map(|&f| a.face_cells(f)).collect();
        let of_cells = on_demand(threads, &views.patch_cells, both)?;
        let net = on_demand(threads, &views.multiplicities, || split(&a.cells.multiplicity))?;
        unsafe {
            put(count, a.patch_count() as i64);
            put(faces, address(&a.cells.patch_face));
            put(cells, address(of_cells));
            put(offsets, address(&a.cells.multiplicity.offsets));
            put(operands, address(&net.0));
            put(multiplicities, address(&net.1));
        }
        Ok(())
    })
}

/// The winding numbers of each cell: a sparse vector. Cell 0, the unbounded one, has none; the others are numbered by their lowest half-faces.
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): count: the number of cells; offsets: count + 1; operands, windings: those of
/// cell c are from place offsets[c] up to, not including, place offsets[c + 1]: operands, rising, and the winding number of each; operands where it is 0 are left out.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the cells at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_cells(
    arrangement: *const lap_arrangement,
    count: *mut i64,
    offsets: *mut *const i32,
    operands: *mut *const i32,
    windings: *mut *const i32,
) -> i32 {
    guard(|_| {
        let arrangement = unsafe { handle(arrangement) }?;
        let rows = &arrangement.data.winding.rows;
        let all = on_demand(arrangement.threads, &arrangement.views.windings, || split(rows))?;
        unsafe {
            put(count, rows.len() as i64);
            put(offsets, address(&rows.offsets));
            put(operands, address(&all.0));
            put(windings, address(&all.1));
        }
        Ok(())
    })
}

impl lap_arrangement {
    fn volumes(&self) -> Result<&(Vec<Rational>, Vec<f64>), Status> {
        on_demand(self.threads, &self.views.volumes, || {
            let exact = cell_volumes(&self.data);
            let rounded = exact.iter().map(round_rational).collect();
            (exact, rounded)
        })
    }
}

/// The volume of each cell, in cubed units of the input: the double nearest to the exact volume; of cell 0, the unbounded one, 0.
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): count: the number of cells; volumes: count.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: an exact sum over all faces at the first call, a
/// microsecond for a whole triangle and some for a part of one; then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_cell_volumes(
    arrangement: *const lap_arrangement,
    count: *mut i64,
    volumes: *mut *const f64,
) -> i32 {
    guard(|_| {
        let arrangement = unsafe { handle(arrangement) }?;
        unsafe {
            put(count, arrangement.data.cell_count() as i64);
            if !volumes.is_null() {
                put(volumes, address(&arrangement.volumes()?.1));
            }
        }
        Ok(())
    })
}

/// The exact volume of a cell as a canonical string, "num/den" or "num" for an integer, in decimal; of cell 0, the unbounded one, "0".
///
/// volume: valid until the next call with this context.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for a cell that is not there; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: as for
/// lap_arrangement_cell_volumes; the string grows with the number of constructed vertices on the cell's boundary.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_cell_volume_exact(
    context: *mut lap_context,
    arrangement: *const lap_arrangement,
    cell: i32,
    volume: *mut *const c_char,
) -> i32 {
    with_context(context, |state, _| {
        let arrangement = unsafe { handle(arrangement) }.map_err(null_arrangement)?;
        if volume.is_null() {
            return Err(Error::new(Status::NullPointer, "volume is NULL"));
        }
        let none = |status| Error::new(status, format!("there is no cell {cell}"));
        let cell = index(cell, arrangement.data.cell_count()).map_err(none)?;
        let exact = &arrangement.volumes().map_err(|s| Error::new(s, "no threads to be had"))?.0;
        unsafe { put(volume, keep(state, &exact[cell].to_string())) };
        Ok(())
    })
}

/// The bounded cells as a complex on which all functions for lap_complex work. Its mesh is that of all operands:
/// vertices and triangles count through them.
///
/// Cell c is cell c + 1 of the arrangement, and so has the winding numbers that lap_arrangement_cells gives for that. Faces are those of the
/// arrangement that divide, those parts of one triangle with the same births joined that only the triangulation separates: with holes, by the
/// lowest part. A face lies on the first triangle that it is a part of (LAP_SUPPORT_TRIANGLE); there may be a cell on either of its sides, or on both.
/// Vertices are those of the arrangement that such faces have, rising. lap_arrangement_complex_places tells which.
///
/// complex: borrowed until the arrangement is freed; do not free it.
///
/// Errors: LAP_ERR_TOO_LARGE, LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: at the first call linear in
/// the faces, with a sort of all edges, then none. Memory: some 200 bytes a face.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_complex(
    context: *mut lap_context,
    arrangement: *const lap_arrangement,
    complex: *mut *const lap_complex,
) -> i32 {
    with_context(context, |state, host| {
        let find = || {
            let arrangement = unsafe { handle(arrangement) }.map_err(null_arrangement)?;
            once(&arrangement.views.complex, || {
                let a = &arrangement.data;
                let made = state.run(host, |run| solids(a, &every_cell(a), run))?;
                lap_complex::of_arrangement(made, a, arrangement.threads).map_err(too_many_elements)
            })
        };
        unsafe { lend_complex(complex, find) }
    })
}

/// Where the vertices and faces of the complex of an arrangement come from. Only after lap_arrangement_complex.
///
/// Outputs (each may be NULL; borrowed until the arrangement is freed): n_vertices: of the complex; vertices: for each that of the
/// arrangement; n_faces: of the complex; offsets: n_faces + 1; faces: face f of the complex consists of the faces
/// faces[offsets[f]] up to, not including, faces[offsets[f + 1]] of the arrangement.
///
/// Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_BAD_ARGUMENT if there is no complex yet. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_complex_places(
    arrangement: *const lap_arrangement,
    n_vertices: *mut i64,
    vertices: *mut *const i32,
    n_faces: *mut i64,
    offsets: *mut *const i32,
    faces: *mut *const i32,
) -> i32 {
    guard(|_| {
        let complex = unsafe { handle(arrangement) }?.views.complex.get().ok_or(Status::BadArgument)?;
        let made = complex.places.as_ref().ok_or(Status::Internal)?;
        unsafe {
            put(n_vertices, made.vertices.len() as i64);
            put(vertices, address(&made.vertices));
            put(n_faces, made.faces.len() as i64);
            put(offsets, address(&made.faces.offsets));
            put(faces, address(&made.faces.items));
        }
        Ok(())
    })
}

//! The noun `lap_certified`: a complex as triangles over doubles that were checked exactly.

use super::complex::lap_complex;
use super::context::{lap_context, with_context};
use super::guard::guard;
use super::mesh::bad_options;
use super::view::{address, handle, index, input, into_handle, put, put_list, read_options, write_options};
use crate::base::{Error, PlaneId, Status};
use crate::complex::{CertifiedComplex, CertifyOptions, Complex, certify};

/// A complex as triangles over doubles that were checked exactly, repaired where rounding had made triangles meet, and a
/// report. Immutable: a const handle may be used from many threads at once.
///
/// Certified means: no triangle is without area; no two triangles meet but in a vertex or an edge that they share by index
/// (all pairs, of all faces); every cell's outer surface encloses a positive volume, every void in it a negative one. All
/// of that holds exactly for the doubles as they are, so the cells are disjoint solids that fill the input up to the changes
/// that the report tells.
///
/// Vertices, faces and cells have numbers of their own here, in the complex's order without those that are gone; maps lead from
/// the complex's numbers to these. Where nothing had to be repaired both are the same. The complex stays as it is.
pub struct lap_certified {
    data: CertifiedComplex,
}

/// Options of lap_certified_new; filled by lap_certify_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_certify_options {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
    /// Nonzero: check and report, repair nothing. 0, the default: repair.
    pub check_only: i32,
    /// Nonzero: ask also about pairs of triangles of the input that no plane has cut. They meet only if the input
    /// intersects itself, so this is for input that was not checked. 0, the default: do not.
    pub check_input: i32,
}

/// What lap_certified_report writes. Lengths are in the unit of the coordinates.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_certify_report {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
    /// 1 if nothing remains, else 0: then lap_certified_open says where.
    pub certified: i32,
    /// With correctly rounded coordinates, before any repair: triangles without area; pairs of triangles that meet, of those
    /// that bound one cell, or the outside (if any meet, some of these do); outer surfaces and voids of cells whose volume
    /// does not have its sign (asked only where the other two are 0).
    pub flat_before: i64,
    pub contacts_before: i64,
    pub volumes_before: i64,
    /// Vertices of the complex that are not at their correctly rounded coordinates any more, those that were merged into others
    /// included; how many of them are vertices of the input mesh; how many were merged.
    pub moved_vertices: i64,
    pub moved_mesh_vertices: i64,
    pub merged_vertices: i64,
    /// Faces and cells that are gone: those of which too little is left for doubles. The maps list them.
    pub removed_faces: i64,
    pub removed_cells: i64,
    /// What lap_certified_open lists.
    pub open_pairs: i64,
    pub open_cells: i64,
    /// The largest change of any coordinate; and the unit in which vertices are moved: one ulp of the largest |coordinate| of
    /// the mesh's bounding box.
    pub largest_move: f64,
    pub move_unit: f64,
}

const DEFAULTS: lap_certify_options =
    lap_certify_options { struct_size: size_of::<lap_certify_options>() as i32, check_only: 0, check_input: 0 };

/// Fills options of lap_certified_new with the defaults.
///
/// struct_size: pass (int32_t)sizeof(lap_certify_options); no more than that is written.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certify_options_init(options: *mut lap_certify_options, struct_size: i32) -> i32 {
    guard(|_| unsafe { write_options(options, struct_size, DEFAULTS) })
}

/// Triangulates a complex without new vertices, checks the triangles exactly over the correctly rounded coordinates, and
/// repairs what rounding broke.
///
/// Repairs are tried in this order, each around a defect only, and kept if they help: vertices at one place are merged, and
/// cells without volume go with them; diagonals of faces are flipped; vertices made by planes are moved by few units, first
/// across the faces and along the lines whose order they break; vertices a few units apart are merged. Vertices of the input mesh are
/// moved, and vertices that no edge joins merged, only where all of that failed. So the report is to be read: a result may be
/// uncertified, and says so.
///
/// Inputs (borrowed for the call): complex; fixed_planes: n_fixed_planes indices of planes, as the complex uses them (of coincident
/// planes the lowest): vertices on these planes, block boundaries say, stay where they are; fixed_vertices: n_fixed_vertices
/// indices of further vertices that do; options: or NULL for the defaults. Others may be merged into a vertex that stays.
/// certified: receives the handle, NULL after an error or cancel; free it with lap_certified_free. It does not need the complex to stay
/// alive.
///
/// Errors: LAP_ERR_INCONSISTENT if a face contradicts itself (input that intersects itself), LAP_ERR_NULL_POINTER,
/// LAP_ERR_BAD_ARGUMENT (an index out of range included), LAP_ERR_TOO_LARGE, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY,
/// LAP_ERR_BUSY. That something remains uncertified is no error. Cost: n log n of the triangles, mostly for those with a vertex
/// made by planes; about a millisecond for each place that has to be repaired.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certified_new(
    context: *mut lap_context,
    complex: *const lap_complex,
    n_fixed_planes: i64,
    fixed_planes: *const i32,
    n_fixed_vertices: i64,
    fixed_vertices: *const i32,
    options: *const lap_certify_options,
    certified: *mut *mut lap_certified,
) -> i32 {
    with_context(context, |state, host| {
        if certified.is_null() {
            return Err(Error::new(Status::NullPointer, "certified is NULL"));
        }
        unsafe { put(certified, std::ptr::null_mut()) };
        let c = &unsafe { handle(complex) }.map_err(|status| Error::new(status, "complex is NULL"))?.data;
        let planes = unsafe { input(fixed_planes, n_fixed_planes) }
            .map_err(|status| Error::new(status, format!("fixed_planes: NULL, or a bad count: {n_fixed_planes}")))?;
        let vertices = unsafe { input(fixed_vertices, n_fixed_vertices) }.map_err(|status| {
            Error::new(status, format!("fixed_vertices: NULL, or a bad count: {n_fixed_vertices}"))
        })?;
        let options = unsafe { read_options(options, DEFAULTS) }.map_err(bad_options)?;
        let options = CertifyOptions {
            fixed: fixed(c, planes, vertices)?,
            check_only: options.check_only != 0,
            check_input: options.check_input != 0,
        };
        let data = state.run(host, |run| certify(c, &options, run))?;
        if data.triangles.items.len() > i32::MAX as usize {
            return Err(Error::new(Status::TooLarge, "more triangles than 32-bit indices can number"));
        }
        unsafe { put(certified, into_handle(lap_certified { data })) };
        Ok(())
    })
}

/// One entry per vertex, or none if nothing is fixed.
fn fixed(c: &Complex, planes: &[i32], vertices: &[i32]) -> Result<Vec<bool>, Error> {
    if planes.is_empty() && vertices.is_empty() {
        return Ok(Vec::new());
    }
    let mut fixed_plane = vec![false; c.planes.len()];
    for &p in planes {
        let at = index(p, c.planes.len()).map_err(|s| Error::new(s, format!("fixed_planes: {p} is out of range")))?;
        fixed_plane[at] = true;
    }
    let on_fixed = |planes: &[PlaneId]| planes.iter().any(|p| fixed_plane[p.at()]);
    let mut all: Vec<bool> = c.vertex_planes.rows().map(on_fixed).collect();
    for &v in vertices {
        let at = index(v, all.len()).map_err(|s| Error::new(s, format!("fixed_vertices: {v} is out of range")))?;
        all[at] = true;
    }
    Ok(all)
}

/// Frees what was certified and all that was borrowed from it. NULL is allowed and does nothing.
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certified_free(certified: *mut lap_certified) -> i32 {
    guard(|_| {
        if !certified.is_null() {
            drop(unsafe { Box::from_raw(certified) });
        }
        Ok(())
    })
}

/// How many elements are left.
///
/// Outputs: each may be NULL.
///
/// Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certified_counts(
    certified: *const lap_certified,
    vertices: *mut i64,
    triangles: *mut i64,
    faces: *mut i64,
    cells: *mut i64,
) -> i32 {
    guard(|_| {
        let data = &unsafe { handle(certified) }?.data;
        unsafe {
            put(vertices, data.coords.len() as i64);
            put(triangles, data.triangles.items.len() as i64);
            put(faces, data.triangles.len() as i64);
            put(cells, data.cell_count as i64);
        }
        Ok(())
    })
}

/// The vertices.
///
/// Outputs (each may be NULL; borrowed as the handle): count; xyz: 3 × count coordinates.
///
/// Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certified_vertices(
    certified: *const lap_certified,
    count: *mut i64,
    xyz: *mut *const f64,
) -> i32 {
    guard(|_| {
        let data = &unsafe { handle(certified) }?.data;
        unsafe {
            put(count, data.coords.len() as i64);
            put(xyz, address(&data.coords));
        }
        Ok(())
    })
}

/// The triangles, by faces.
///
/// Outputs (each may be NULL; borrowed as the handle): count; vertices: 3 × count, anticlockwise seen with the face's normal up;
/// cells: 2 × count, the cell behind each triangle and the cell before it (-1: outside), as lap_complex_face_cells has them for
/// faces; face_count; face_triangles: face_count + 1: face f has the triangles face_triangles[f] up to, not including,
/// face_triangles[f + 1]. Where a cell between two faces went, in whole or in part, triangles of both are one: it is in the face with
/// the lower number, between the cells that are left.
///
/// Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certified_triangles(
    certified: *const lap_certified,
    count: *mut i64,
    vertices: *mut *const i32,
    cells: *mut *const i32,
    face_count: *mut i64,
    face_triangles: *mut *const i32,
) -> i32 {
    guard(|_| {
        let data = &unsafe { handle(certified) }?.data;
        unsafe {
            put(count, data.triangles.items.len() as i64);
            put(vertices, address(&data.triangles.items));
            put(cells, address(&data.triangle_cells));
            put(face_count, data.triangles.len() as i64);
            put(face_triangles, address(&data.triangles.offsets));
        }
        Ok(())
    })
}

/// From the complex's vertices, faces and cells to those here.
///
/// Outputs (each may be NULL; borrowed as the handle): n_vertices, n_faces, n_cells: the numbers of the complex; vertices, faces, cells:
/// for each the index here, -1 for one that is gone. A vertex that was merged has the index of the one that stands for
/// it.
///
/// Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certified_maps(
    certified: *const lap_certified,
    n_vertices: *mut i64,
    vertices: *mut *const i32,
    n_faces: *mut i64,
    faces: *mut *const i32,
    n_cells: *mut i64,
    cells: *mut *const i32,
) -> i32 {
    guard(|_| {
        let data = &unsafe { handle(certified) }?.data;
        unsafe {
            put(n_vertices, data.vertex_map.len() as i64);
            put(vertices, address(&data.vertex_map));
            put(n_faces, data.face_map.len() as i64);
            put(faces, address(&data.face_map));
            put(n_cells, data.cell_map.len() as i64);
            put(cells, address(&data.cell_map));
        }
        Ok(())
    })
}

/// The report.
///
/// report: written; struct_size: pass (int32_t)sizeof(lap_certify_report); no more than that is written.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096. Threads: any. Cost:
/// none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certified_report(
    certified: *const lap_certified,
    report: *mut lap_certify_report,
    struct_size: i32,
) -> i32 {
    guard(|_| {
        let r = &unsafe { handle(certified) }?.data.report;
        let known = lap_certify_report {
            struct_size: size_of::<lap_certify_report>() as i32,
            certified: r.certified as i32,
            flat_before: r.flat_before as i64,
            contacts_before: r.contacts_before as i64,
            volumes_before: r.shells_before as i64,
            moved_vertices: r.moved as i64,
            moved_mesh_vertices: r.moved_mesh_vertices as i64,
            merged_vertices: r.merged as i64,
            removed_faces: r.removed_faces as i64,
            removed_cells: r.removed_cells as i64,
            open_pairs: r.open_faces.len() as i64,
            open_cells: r.open_cells.len() as i64,
            largest_move: r.largest_move,
            move_unit: r.unit,
        };
        unsafe { write_options(report, struct_size, known) }
    })
}

/// What remains uncertified, in numbers of the complex (not of this handle).
///
/// Outputs (each may be NULL; borrowed as the handle): n_pairs; pairs: 2 × n_pairs faces whose triangles meet, the lower first; twice the same
/// face for one that meets itself or has a triangle without area; n_cells; cells: those with a volume, or a void, of the
/// wrong sign (asked only if there are no pairs). All are empty for a certified result.
///
/// Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_certified_open(
    certified: *const lap_certified,
    n_pairs: *mut i64,
    pairs: *mut *const i32,
    n_cells: *mut i64,
    cells: *mut *const i32,
) -> i32 {
    guard(|_| {
        let report = &unsafe { handle(certified) }?.data.report;
        unsafe {
            put_list(n_pairs, pairs, &report.open_faces);
            put_list(n_cells, cells, &report.open_cells);
        }
        Ok(())
    })
}

//! The noun `lap_surface`, second part: the surface of a solid on doubles that were checked exactly.

use super::context::{lap_context, with_context};
use super::guard::guard;
use super::mesh::bad_options;
use super::surface::{Certified, lap_surface};
use super::view::{handle, into_handle, put, put_list, read_options, write_options};
use crate::arrangement::certify::{CertifiedSurface, CertifyOptions, certify};
use crate::base::{Error, Status, VertexId};

/// Options of lap_surface_certify; filled by lap_surface_certify_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_surface_certify_options {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
    /// Nonzero: check and report, repair nothing. 0, the default: repair.
    pub check_only: i32,
    /// How many rounds of repair there may be, 1 or more; 0, the default: the library's own bound. Most surfaces need one or two.
    pub max_rounds: i32,
}

/// What lap_surface_certified_report writes. Lengths are in the unit of the coordinates.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_surface_certify_report {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
    /// 1 if nothing remains, else 0: then lap_surface_certified_open says where.
    pub certified: i32,
    /// With correctly rounded coordinates, before any repair: triangles without area; pairs of others that meet beyond what they share by index
    /// (counted up to a bound that grows with the triangles).
    pub flat_before: i64,
    pub contacts_before: i64,
    /// Rounds of repair, each an exact arrangement of the surface, that were needed; the last one changed nothing.
    pub rounds: i64,
    pub triangles_before: i64,
    pub triangles_after: i64,
    /// Triangles of the surface of which no part is left.
    pub removed_triangles: i64,
    /// Vertices of the result at places where the surface has none.
    pub moved_vertices: i64,
    /// Places of vertices of the surface at which the result has none.
    pub gone_vertices: i64,
    /// Places where vertices, edges and triangles near one another were made to share vertices.
    pub snapped: i64,
    /// Cells too thin for doubles that were left out of the solid or filled in.
    pub thin_cells: i64,
    /// What lap_surface_certified_open lists.
    pub open_pairs: i64,
    /// A bound on how far the surface went in any coordinate from where its correctly rounded vertices have it, thin cells apart.
    pub largest_move: f64,
    /// One ulp of the largest |coordinate|.
    pub move_unit: f64,
}

const DEFAULTS: lap_surface_certify_options = lap_surface_certify_options {
    struct_size: size_of::<lap_surface_certify_options>() as i32,
    check_only: 0,
    max_rounds: 0,
};

/// Fills options of lap_surface_certify with the defaults.
///
/// struct_size: pass (int32_t)sizeof(lap_surface_certify_options); no more than that is written.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_certify_options_init(
    options: *mut lap_surface_certify_options,
    struct_size: i32,
) -> i32 {
    guard(|_| unsafe { write_options(options, struct_size, DEFAULTS) })
}

/// Makes of an arrangement's surface one that is solid on its doubles: no triangle is without area, no two meet but in a vertex or an edge that they
/// share by index, every place is one vertex, and every point is wound around once or not at all. All of that is checked exactly, and repaired
/// where rounding broke it; whether it holds is in the report. A certified surface can go straight into the next lap_arrangement_new: its
/// coordinates and triangles as they are are the operand.
///
/// Repair goes in rounds: the rounded surface is arranged exactly, what it winds around in the positive sense is kept, and vertices made by
/// that are rounded. From the second round on, vertices, edges and triangles that meet are made to share vertices within few units first, and cells
/// hardly thicker than a unit go. So parts that are thinner than doubles can tell may vanish. Where nothing has to be repaired the result has the
/// same vertices and triangles as the surface, in the same order but for vertices at one place.
///
/// Inputs: surface: of an arrangement, or certified already; it stays as it is; options: or NULL for the defaults. certified: receives the handle,
/// NULL after an error or cancel; free it with lap_surface_free. It keeps nothing of the surface or of the arrangement.
/// Of it lap_surface_vertices tells in sources the lowest vertex of the arrangement whose rounded coordinates those are, -1 for one at another
/// place; lap_surface_polygons and lap_surface_triangles tell the face and the input triangle that each is a part of, but for
/// rounding (not rising any more), and whether it runs against these; lap_surface_volume and lap_surface_volume_exact are of the doubles as they are.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for the surface of a network and for options that there are not, LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE,
/// LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. That something remains uncertified is no error. Cost: an arrangement of the surface for
/// each round.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_certify(
    context: *mut lap_context,
    surface: *const lap_surface,
    options: *const lap_surface_certify_options,
    certified: *mut *mut lap_surface,
) -> i32 {
    with_context(context, |state, host| {
        if certified.is_null() {
            return Err(Error::new(Status::NullPointer, "certified is NULL"));
        }
        unsafe { put(certified, std::ptr::null_mut()) };
        let surface = unsafe { handle(surface) }.map_err(|status| Error::new(status, "surface is NULL"))?;
        if let Err(status) = surface.births() {
            return Err(Error::new(
                status,
                "the surface is that of a network: arrange it, and certify a surface of that",
            ));
        }
        let options = unsafe { read_options(options, DEFAULTS) }.map_err(bad_options)?;
        let defaults = CertifyOptions::default();
        let rounds = match options.max_rounds {
            0 => defaults.rounds,
            n if n > 0 => n as usize,
            n => return Err(Error::new(Status::BadArgument, format!("max_rounds: {n} is negative"))),
        };
        let options = CertifyOptions { check_only: options.check_only != 0, rounds, ..defaults };
        let threads = state.threads();
        let made = state.run(host, |run| {
            let made = certify(surface.vertices().0, surface.triangles(), &options, run)?;
            lap_surface::of_certified(with_births(surface, made)?, threads)
        })?;
        unsafe { put(certified, into_handle(made)) };
        Ok(())
    })
}

/// What was certified, with where it comes from.
fn with_births(surface: &lap_surface, made: CertifiedSurface) -> Result<Certified, Error> {
    let of = surface.births().map_err(|status| Error::new(status, "the surface is that of a network"))?;
    let each = || made.sources.iter().map(|t| t.at()).zip(made.against.iter().copied());
    let (coords, vertices) = surface.vertices();
    let bits = |x: &[f64; 3]| x.map(|x| (x + 0.0).to_bits());
    let mut known: Vec<([u64; 3], VertexId)> = coords.iter().map(bits).zip(vertices.iter().copied()).collect();
    known.sort_unstable();
    let source = |x: &[f64; 3]| match known.get(known.partition_point(|k| k.0 < bits(x))) {
        Some(k) if k.0 == bits(x) => k.1,
        _ => VertexId::NONE,
    };
    Ok(Certified {
        vertices: made.coords.iter().map(source).collect(),
        faces: each().map(|(t, _)| of.faces[t]).collect(),
        turned: each().map(|(t, against)| of.turned[t] != against).collect(),
        operands: each().map(|(t, _)| of.operands[t]).collect(),
        triangles: each().map(|(t, _)| of.triangles[t]).collect(),
        flipped: each().map(|(t, against)| of.flipped[t] != against).collect(),
        xyz: made.coords,
        corners: made.triangles.iter().map(|t| t.map(|v| v as u32)).collect(),
        report: made.report,
    })
}

/// The report of a certified surface.
///
/// report: written; struct_size: pass (int32_t)sizeof(lap_surface_certify_report); no more than that is written.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for a surface that lap_surface_certify did not make, and if the size is not a multiple of 4
/// in 4..4096. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_certified_report(
    certified: *const lap_surface,
    report: *mut lap_surface_certify_report,
    struct_size: i32,
) -> i32 {
    guard(|_| {
        let certified = unsafe { handle(certified) }?.certified()?;
        let r = &certified.report;
        let first = r.rounds.first().copied().unwrap_or_default();
        let known = lap_surface_certify_report {
            struct_size: size_of::<lap_surface_certify_report>() as i32,
            certified: r.certified as i32,
            flat_before: first.flat as i64,
            contacts_before: first.contacts as i64,
            rounds: r.rounds.len() as i64,
            triangles_before: r.triangles_before as i64,
            triangles_after: r.triangles_after as i64,
            removed_triangles: r.removed as i64,
            moved_vertices: r.moved as i64,
            gone_vertices: r.gone as i64,
            snapped: r.snapped as i64,
            thin_cells: r.thin_cells as i64,
            open_pairs: r.remaining.len() as i64,
            largest_move: r.largest_move,
            move_unit: r.unit,
        };
        unsafe { write_options(report, struct_size, known) }
    })
}

/// What remains uncertified, in numbers of the triangles of the certified surface.
///
/// Outputs (each may be NULL; borrowed until the surface is freed): n_pairs; pairs: 2 × n_pairs triangles that meet, the lower first; twice the same
/// one for a triangle without area. At most 65536 are listed. None for a certified result, nor for one whose triangles meet nowhere but wind around
/// something in another sense than once (only with check_only).
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for a surface that lap_surface_certify did not make. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_certified_open(
    certified: *const lap_surface,
    n_pairs: *mut i64,
    pairs: *mut *const i32,
) -> i32 {
    guard(|_| {
        let report = &unsafe { handle(certified) }?.certified()?.report;
        unsafe { put_list(n_pairs, pairs, &report.remaining) };
        Ok(())
    })
}

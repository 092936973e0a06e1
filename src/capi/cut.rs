//! The noun `lap_cut`: the cells into which planes divide a solid.

use super::complex::lap_complex;
use super::context::{c_string, lap_context, with_context};
use super::derived::check;
use super::guard::guard;
use super::mesh::{bad_options, lap_mesh};
use super::view::{address, handle, index, input, into_handle, put, read_options, write_options};
use crate::base::{Error, PlaneId, Status};
use crate::cut::{self, CutOptions};
use crate::exact::Plane;
use crate::exact::counters::{Counts, PREDICATES, Predicate, TIERS, Tier};
use std::ffi::{CString, c_char};

/// The cells into which planes divide a solid, and how they were found. Immutable: a const handle may be used from many
/// threads at once.
pub struct lap_cut {
    pub complex: lap_complex,
    pub plane_map: Vec<PlaneId>,
    pub stages: Vec<(CString, f64)>,
    pub statistics: Vec<(CString, i64)>,
}

/// Options of lap_cut_new; filled by lap_cut_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_cut_options {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
    /// Nonzero: run lap_complex_check on the result and fail with LAP_ERR_INCONSISTENT if it does not hold. 0, the
    /// default: do not.
    pub check: i32,
}

const DEFAULTS: lap_cut_options = lap_cut_options { struct_size: size_of::<lap_cut_options>() as i32, check: 0 };

/// Fills cut options with the defaults.
///
/// struct_size: pass (int32_t)sizeof(lap_cut_options); no more than that is written, so a program compiled against an
/// older header keeps working.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_options_init(options: *mut lap_cut_options, struct_size: i32) -> i32 {
    guard(|_| unsafe { write_options(options, struct_size, DEFAULTS) })
}

/// Cuts a solid along planes.
///
/// Inputs (borrowed for the call): mesh; planes: 4 × n_planes numbers, a, b, c, d for the plane a x + b y + c z + d = 0,
/// each taken as the exact number that it is, in any position and of any length (coincident planes count once;
/// n_planes may be 0); options: or NULL for the defaults. The positive side of a plane is where a x + b y + c z + d > 0.
/// cut: receives the handle, NULL after an error or cancel; free it with lap_cut_free. It does not need the mesh handle
/// or the context to stay alive.
///
/// Errors: LAP_ERR_BAD_PLANE with all defects found (not finite, zero normal), LAP_ERR_INCONSISTENT for input that
/// intersects itself, LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT, LAP_ERR_TOO_LARGE, LAP_ERR_CANCELLED,
/// LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: grows with the size of the result and n log n of the input.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_new(
    context: *mut lap_context,
    mesh: *const lap_mesh,
    n_planes: i64,
    planes: *const f64,
    options: *const lap_cut_options,
    cut: *mut *mut lap_cut,
) -> i32 {
    with_context(context, |state, host| {
        if cut.is_null() {
            return Err(Error::new(Status::NullPointer, "cut is NULL"));
        }
        unsafe { put(cut, std::ptr::null_mut()) };
        let mesh = unsafe { handle(mesh) }.map_err(|status| Error::new(status, "mesh is NULL"))?;
        let planes: &[[f64; 4]] = unsafe { input(planes.cast(), n_planes) }
            .map_err(|status| Error::new(status, format!("planes: NULL, or a bad count: {n_planes}")))?;
        let options = unsafe { read_options(options, DEFAULTS) }.map_err(bad_options)?;
        let planes: Vec<Plane> = planes.iter().map(|&[a, b, c, d]| Plane { n: [a, b, c], d }).collect();
        let made = state.run(host, |run| {
            let made = cut::cut(&mesh.mesh, &planes, &CutOptions::default(), run)?;
            if options.check != 0 {
                check(&made.complex)?;
            }
            Ok(made)
        })?;
        let mut complex = lap_complex::new(made.complex, state.threads())
            .map_err(|status| Error::new(status, "the result has more elements than 32-bit indices can number"))?;
        complex.keyed.triangles = mesh.triangle_ids.clone();
        let stages = made.stages.iter().map(|(name, seconds)| (c_string(name), *seconds)).collect();
        let statistics = statistics(&state.last_counts);
        unsafe { put(cut, into_handle(lap_cut { complex, plane_map: made.plane_map, stages, statistics })) };
        Ok(())
    })
}

/// Per predicate, what topology knew and what had to be computed.
fn statistics(counts: &Counts) -> Vec<(CString, i64)> {
    let of = |&p: &Predicate| {
        let known = counts.get(p, Tier::Topology);
        let all: u64 = TIERS.iter().map(|&t| counts.get(p, t)).sum();
        let name = |kind: &str| c_string(&format!("{}.{kind}", p.name()));
        [(name("topological"), known as i64), (name("numerical"), (all - known) as i64)]
    };
    PREDICATES.iter().flat_map(of).collect()
}

/// Frees a cut and all that was borrowed from it, its complex included. NULL is allowed and does nothing.
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_free(cut: *mut lap_cut) -> i32 {
    guard(|_| {
        if !cut.is_null() {
            drop(unsafe { Box::from_raw(cut) });
        }
        Ok(())
    })
}

/// The cells, faces, edges and vertices of a cut.
///
/// complex: borrowed until the cut is freed; do not free it.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_complex(cut: *const lap_cut, complex: *mut *const lap_complex) -> i32 {
    guard(|_| {
        let cut = unsafe { handle(cut) }?;
        if complex.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(complex, &raw const cut.complex) };
        Ok(())
    })
}

/// Which planes coincide.
///
/// Outputs (each may be NULL; borrowed until the cut is freed): count: the number of planes given; map: for each, the
/// lowest index of the planes that coincide with it (its own, if there is no lower one). The complex speaks of
/// planes by these lowest indices only. Opposite orientation does not keep planes from coinciding.
///
/// Errors: LAP_ERR_NULL_POINTER if cut is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_plane_map(cut: *const lap_cut, count: *mut i64, map: *mut *const i32) -> i32 {
    guard(|_| {
        let cut = unsafe { handle(cut) }?;
        unsafe {
            put(count, cut.plane_map.len() as i64);
            put(map, address(&cut.plane_map));
        }
        Ok(())
    })
}

/// How many stages the cut ran through.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_stage_count(cut: *const lap_cut, count: *mut i32) -> i32 {
    guard(|_| {
        let cut = unsafe { handle(cut) }?;
        if count.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(count, cut.stages.len() as i32) };
        Ok(())
    })
}

/// Stage i of the cut, from 0, in the order in which they ran: its name and its time in seconds.
///
/// Outputs (each may be NULL). name is borrowed until the cut is freed.
///
/// Errors: LAP_ERR_NULL_POINTER if cut is NULL, LAP_ERR_BAD_ARGUMENT if there is no such stage. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_stage(
    cut: *const lap_cut,
    i: i32,
    name: *mut *const c_char,
    seconds: *mut f64,
) -> i32 {
    guard(|_| {
        let stages = &unsafe { handle(cut) }?.stages;
        let (text, time) = &stages[index(i, stages.len())?];
        unsafe {
            put(name, text.as_ptr());
            put(seconds, *time);
        }
        Ok(())
    })
}

/// How many statistics there are: two per predicate, "predicate.topological" and "predicate.numerical": how many decisions
/// of this cut followed from topology alone, and how many were computed from numbers. All 0 unless the context counted
/// (lap_context_counters_enable).
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_statistic_count(cut: *const lap_cut, count: *mut i32) -> i32 {
    guard(|_| {
        let cut = unsafe { handle(cut) }?;
        if count.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(count, cut.statistics.len() as i32) };
        Ok(())
    })
}

/// Statistic i, from 0: its name and its value.
///
/// Outputs (each may be NULL). name is borrowed until the cut is freed.
///
/// Errors: LAP_ERR_NULL_POINTER if cut is NULL, LAP_ERR_BAD_ARGUMENT if there is no such statistic. Threads: any.
/// Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_statistic(
    cut: *const lap_cut,
    i: i32,
    name: *mut *const c_char,
    value: *mut i64,
) -> i32 {
    guard(|_| {
        let statistics = &unsafe { handle(cut) }?.statistics;
        let (text, number) = &statistics[index(i, statistics.len())?];
        unsafe {
            put(name, text.as_ptr());
            put(value, *number);
        }
        Ok(())
    })
}

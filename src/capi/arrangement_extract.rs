//! The noun `lap_arrangement`, third part: surfaces of solids made of its cells.

use super::arrangement::{lap_arrangement, null_arrangement};
use super::context::{State, lap_context, with_context};
use super::guard::Host;
use super::surface::lap_surface;
use super::view::{handle, input, into_handle, put};
use crate::arrangement::{Selection, choose};
use crate::base::{CellId, Error, Status};
use std::ffi::{CStr, c_char, c_void};

/// What is inside any operand.
pub const LAP_EXTRACT_UNION: i32 = 0;
/// What is inside all operands.
pub const LAP_EXTRACT_INTERSECTION: i32 = 1;
/// What is inside the first operand and no other one.
pub const LAP_EXTRACT_DIFFERENCE: i32 = 2;
/// What is inside an odd number of operands.
pub const LAP_EXTRACT_SYMMETRIC_DIFFERENCE: i32 = 3;
/// What is inside at least so many operands, one or more.
pub const LAP_EXTRACT_AT_LEAST: i32 = 4;
/// Where the winding numbers of all operands have a positive sum: what is inside, were all one mesh.
pub const LAP_EXTRACT_RESOLVE: i32 = 5;

/// Whether a cell is in the solid: return 0 if not, anything else if it is. winding: its winding number for each of the n_operands
/// operands (valid during the callback); the cell is inside those where it is positive.
///
/// Runs on the thread that made the call and under the floating-point environment which that thread had, while no work of the library runs with
/// this context. Must return normally (no exception, no longjmp) and must not use the same context (LAP_ERR_BUSY); handles and other contexts may be used.
pub type lap_inside =
    Option<unsafe extern "C" fn(user: *mut c_void, cell: i32, n_operands: i64, winding: *const i32) -> i32>;

/// The surface of a boolean of all operands: solid, which is to say that its triangles meet in common vertices and edges only, no two are the same,
/// none is without area (before coordinates are rounded), and around every edge inside and outside alternate. Any number of solids can be made from one arrangement.
///
/// operation: LAP_EXTRACT_*; at_least: how many operands, for LAP_EXTRACT_AT_LEAST (else it is not looked at). surface: receives the handle,
/// NULL after an error; free it with lap_surface_free. It keeps what it needs of the arrangement, which may be freed before it.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for an operation that there is not, or at_least below 1; LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE,
/// LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in cells and faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_extract(
    context: *mut lap_context,
    arrangement: *const lap_arrangement,
    operation: i32,
    at_least: i32,
    surface: *mut *mut lap_surface,
) -> i32 {
    with_context(context, |state, host| {
        let arrangement = unsafe { begin(arrangement, surface)? };
        let selection = match operation {
            LAP_EXTRACT_UNION => Selection::Union,
            LAP_EXTRACT_INTERSECTION => Selection::Intersection,
            LAP_EXTRACT_DIFFERENCE => Selection::Difference,
            LAP_EXTRACT_SYMMETRIC_DIFFERENCE => Selection::SymmetricDifference,
            LAP_EXTRACT_AT_LEAST if at_least < 1 => {
                return Err(Error::new(Status::BadArgument, format!("at_least: {at_least} is less than 1")));
            }
            LAP_EXTRACT_AT_LEAST => Selection::AtLeast(at_least as u32),
            LAP_EXTRACT_RESOLVE => Selection::Resolve,
            other => return Err(Error::new(Status::BadArgument, format!("operation: {other} is no LAP_EXTRACT_*"))),
        };
        let chosen = choose(&arrangement.data, selection)?;
        unsafe { finish(state, host, arrangement, &chosen, surface) }
    })
}

/// The surface of the cells that a boolean expression over the operands takes.
///
/// expression: text, borrowed for the call, such as "(0 | 1) & !2". A number stands for "inside that operand", from 0; ! is not, & and, - and not,
/// ^ one but not both, | or: & and - (as strong as one another, from left to right) before ^ before |; brackets; true and false. Spaces are free. Others as for
/// lap_arrangement_extract.
///
/// Errors: LAP_ERR_BAD_ARGUMENT with a message that names the first character that does not fit or the operand that there is not, or if the
/// expression takes in the unbounded cell; LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the faces,
/// and the cells times the expression.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_extract_expression(
    context: *mut lap_context,
    arrangement: *const lap_arrangement,
    expression: *const c_char,
    surface: *mut *mut lap_surface,
) -> i32 {
    with_context(context, |state, host| {
        let arrangement = unsafe { begin(arrangement, surface)? };
        if expression.is_null() {
            return Err(Error::new(Status::NullPointer, "expression is NULL"));
        }
        let Ok(text) = unsafe { CStr::from_ptr(expression) }.to_str() else {
            return Err(Error::new(Status::BadArgument, "expression: not UTF-8"));
        };
        let chosen = choose(&arrangement.data, Selection::Expression(text))?;
        unsafe { finish(state, host, arrangement, &chosen, surface) }
    })
}

/// The surface of the cells that a table takes.
///
/// table: n_cells bytes, borrowed for the call, nonzero for each cell that is taken; the first, of the unbounded cell, is 0; n_cells: as many as the
/// arrangement has. Others as for lap_arrangement_extract.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for a table of another length, or one that takes in the unbounded cell; LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE,
/// LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_extract_table(
    context: *mut lap_context,
    arrangement: *const lap_arrangement,
    n_cells: i64,
    table: *const u8,
    surface: *mut *mut lap_surface,
) -> i32 {
    with_context(context, |state, host| {
        let arrangement = unsafe { begin(arrangement, surface)? };
        let table = unsafe { input(table, n_cells) }
            .map_err(|s| Error::new(s, format!("table: NULL, or a bad count: {n_cells}")))?;
        let table: Vec<bool> = table.iter().map(|&b| b != 0).collect();
        let chosen = choose(&arrangement.data, Selection::Table(&table))?;
        unsafe { finish(state, host, arrangement, &chosen, surface) }
    })
}

/// The surface of the cells that a callback takes; it is asked once for each cell, rising, the unbounded one (number 0, which it must not take) included.
///
/// user: handed to the callback. Others as for lap_arrangement_extract.
///
/// Errors: LAP_ERR_BAD_ARGUMENT if the unbounded cell is taken; LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost:
/// linear in the faces, and in cells times operands, and the callbacks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_arrangement_extract_callback(
    context: *mut lap_context,
    arrangement: *const lap_arrangement,
    callback: lap_inside,
    user: *mut c_void,
    surface: *mut *mut lap_surface,
) -> i32 {
    with_context(context, |state, host| {
        let arrangement = unsafe { begin(arrangement, surface)? };
        let Some(callback) = callback else {
            return Err(Error::new(Status::NullPointer, "callback is NULL"));
        };
        // Asked here, on the caller's own thread and outside of any pool: a callback that waits for another call waits for nobody who waits for it.
        let mut ask = |cell: CellId, winding: &[i32]| {
            let (n, winding) = (winding.len() as i64, winding.as_ptr());
            host.call(|| unsafe { callback(user, cell.0 as i32, n, winding) }) != 0
        };
        let chosen = choose(&arrangement.data, Selection::Callback(&mut ask))?;
        unsafe { finish(state, host, arrangement, &chosen, surface) }
    })
}

/// # Safety
/// `arrangement` is null or a live handle, `surface` null or writable.
unsafe fn begin<'a>(
    arrangement: *const lap_arrangement,
    surface: *mut *mut lap_surface,
) -> Result<&'a lap_arrangement, Error> {
    if surface.is_null() {
        return Err(Error::new(Status::NullPointer, "surface is NULL"));
    }
    unsafe { put(surface, std::ptr::null_mut()) };
    unsafe { handle(arrangement) }.map_err(null_arrangement)
}

/// # Safety
/// `surface` is writable.
unsafe fn finish(
    state: &mut State,
    host: &mut Host,
    arrangement: &lap_arrangement,
    chosen: &[bool],
    surface: *mut *mut lap_surface,
) -> Result<(), Error> {
    let threads = state.threads();
    let made = state.run(host, |_| lap_surface::of_cells(&arrangement.data, chosen, threads))?;
    unsafe { put(surface, into_handle(made)) };
    Ok(())
}

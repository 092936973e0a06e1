//! The noun `lap_network`, third part: surfaces of solids made of its regions.

use super::context::{State, lap_context, with_context};
use super::guard::Host;
use super::network::{lap_network, null_network};
use super::surface::lap_surface;
use super::view::{handle, input, into_handle, put};
use crate::base::{Error, Status};
use crate::network::csg::{Choice, boundary, choose};
use std::ffi::{CStr, c_char, c_void};

/// Whether a region is in the solid: return 0 if not, anything else if it is.
///
/// Runs on the thread that made the call and under the floating-point environment which that thread had. Must
/// return normally (no exception, no longjmp) and must not use the same context (LAP_ERR_BUSY).
pub type lap_choose = Option<unsafe extern "C" fn(user: *mut c_void, region: i32) -> i32>;

/// The boundary of the regions that a boolean expression chooses.
///
/// expression: text, borrowed for the call, such as "(0 & !1) | 2". A number stands for "that function is positive" (of an interface:
/// "it is that material"), -k for "function k is negative", =k for "function k is zero"; ! is not, & and, ^ one but not both, | or, in
/// this order of strength; brackets; true and false. Spaces are free. triangles: nonzero: polygons are split into triangles, without new
/// vertices. surface: receives the handle, NULL after an error; free it with lap_surface_free. It does not need the network.
///
/// Errors: LAP_ERR_BAD_ARGUMENT with a message that names the first character that does not fit; LAP_ERR_NULL_POINTER,
/// LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the polygons, and the regions times the expression.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_csg(
    context: *mut lap_context,
    network: *const lap_network,
    expression: *const c_char,
    triangles: i32,
    surface: *mut *mut lap_surface,
) -> i32 {
    with_context(context, |state, host| {
        let network = unsafe { begin(network, surface)? };
        if expression.is_null() {
            return Err(Error::new(Status::NullPointer, "expression is NULL"));
        }
        let Ok(text) = unsafe { CStr::from_ptr(expression) }.to_str() else {
            return Err(Error::new(Status::BadArgument, "expression: not UTF-8"));
        };
        let chosen = choose(&network.data, &network.topology, Choice::Expression(text))?;
        unsafe { finish(state, host, network, &chosen, triangles, surface) }
    })
}

/// The boundary of the regions that a table chooses.
///
/// table: n_regions bytes, borrowed for the call, nonzero for each region of the network that is chosen; n_regions: as many as the network has.
/// Others as for lap_network_csg.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for a table of another length; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in
/// the polygons.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_csg_table(
    context: *mut lap_context,
    network: *const lap_network,
    n_regions: i64,
    table: *const u8,
    triangles: i32,
    surface: *mut *mut lap_surface,
) -> i32 {
    with_context(context, |state, host| {
        let network = unsafe { begin(network, surface)? };
        let table = unsafe { input(table, n_regions) }
            .map_err(|s| Error::new(s, format!("table: NULL, or a bad count: {n_regions}")))?;
        let table: Vec<bool> = table.iter().map(|&b| b != 0).collect();
        let chosen = choose(&network.data, &network.topology, Choice::Table(&table))?;
        unsafe { finish(state, host, network, &chosen, triangles, surface) }
    })
}

/// The boundary of the regions that a callback chooses; it is asked once for each region, rising.
///
/// user: handed to the callback. Others as for lap_network_csg.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the polygons, and the callbacks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_csg_callback(
    context: *mut lap_context,
    network: *const lap_network,
    callback: lap_choose,
    user: *mut c_void,
    triangles: i32,
    surface: *mut *mut lap_surface,
) -> i32 {
    with_context(context, |state, host| {
        let network = unsafe { begin(network, surface)? };
        let Some(callback) = callback else {
            return Err(Error::new(Status::NullPointer, "callback is NULL"));
        };
        let mut ask = |region: crate::base::RegionId| host.call(|| unsafe { callback(user, region.0 as i32) }) != 0;
        let chosen = choose(&network.data, &network.topology, Choice::Callback(&mut ask))?;
        unsafe { finish(state, host, network, &chosen, triangles, surface) }
    })
}

/// # Safety
/// `network` is null or a live handle, `surface` null or writable.
unsafe fn begin<'a>(network: *const lap_network, surface: *mut *mut lap_surface) -> Result<&'a lap_network, Error> {
    if surface.is_null() {
        return Err(Error::new(Status::NullPointer, "surface is NULL"));
    }
    unsafe { put(surface, std::ptr::null_mut()) };
    unsafe { handle(network) }.map_err(null_network)
}

/// # Safety
/// `surface` is writable.
unsafe fn finish(
    state: &mut State,
    host: &mut Host,
    network: &lap_network,
    chosen: &[bool],
    triangles: i32,
    surface: *mut *mut lap_surface,
) -> Result<(), Error> {
    let threads = state.threads();
    let made = state.run(host, |_| {
        let boundary = boundary(&network.data, &network.topology, chosen, triangles != 0);
        lap_surface::of_regions(&network.data, boundary, threads)
    })?;
    unsafe { put(surface, into_handle(made)) };
    Ok(())
}

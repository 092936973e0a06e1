//! The noun `lap_surface`: boundaries of solids made of a network's regions.

use super::context::{State, lap_context, with_context};
use super::guard::{Host, guard};
use super::network::{lap_network, null_network};
use super::view::{address, handle, input, into_handle, put};
use crate::base::{Error, Status};
use crate::network::csg::{Boundary, Choice, boundary, choose};
use std::ffi::{CStr, c_char, c_void};

/// Whether a region is in the solid: return 0 if not, anything else if it is.
///
/// Runs on the thread that made the call and under the floating-point environment which that thread had. Must
/// return normally (no exception, no longjmp) and must not use the same context (LAP_ERR_BUSY).
pub type lap_choose = Option<unsafe extern "C" fn(user: *mut c_void, region: i32) -> i32>;

/// The boundary of a union of regions of a network: an oriented mesh. Polygons between two regions that were both chosen are gone. It is closed, except where the
/// solid reaches the boundary of the network's domain.
///
/// Immutable: a const handle may be used from many threads at once.
pub struct lap_surface {
    boundary: Boundary,
    xyz: Vec<[f64; 3]>,
    flipped: Vec<u8>,
}

const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<lap_surface>();
};

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
    let made = state.run(host, |_| {
        let boundary = boundary(&network.data, &network.topology, chosen, triangles != 0);
        // Triangles may be more than polygons.
        if boundary.polygons.items.len() > i32::MAX as usize {
            return Err(Error::new(Status::TooLarge, "the result has more elements than 32-bit indices can number"));
        }
        let xyz = boundary.vertices.iter().map(|v| network.data.vertices[v.at()]).collect();
        let flipped = boundary.flipped.iter().map(|&b| b.into()).collect();
        Ok(lap_surface { boundary, xyz, flipped })
    })?;
    unsafe { put(surface, into_handle(made)) };
    Ok(())
}

/// Frees a surface and all that was borrowed from it. NULL is allowed and does nothing.
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_free(surface: *mut lap_surface) -> i32 {
    guard(|_| {
        if !surface.is_null() {
            drop(unsafe { Box::from_raw(surface) });
        }
        Ok(())
    })
}

/// The vertices of a surface.
///
/// Outputs (each may be NULL; borrowed until the surface is freed): count; xyz: 3 × count coordinates; sources: the vertex of the network
/// that each is, rising.
///
/// Errors: LAP_ERR_NULL_POINTER if surface is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_vertices(
    surface: *const lap_surface,
    count: *mut i64,
    xyz: *mut *const f64,
    sources: *mut *const i32,
) -> i32 {
    guard(|_| {
        let surface = unsafe { handle(surface) }?;
        unsafe {
            put(count, surface.xyz.len() as i64);
            put(xyz, address(&surface.xyz));
            put(sources, address(&surface.boundary.vertices));
        }
        Ok(())
    })
}

/// The polygons of a surface, convex; or triangles, if it was made so.
///
/// Outputs (each may be NULL; borrowed until the surface is freed): count; offsets: count + 1; vertices: those of polygon p are vertices[offsets[p]]
/// up to, not including, vertices[offsets[p + 1]], anticlockwise seen from outside the solid (in two dimensions: the solid is on
/// the right of the way from the first to the second); births: the polygon of the network that each comes from, rising; flipped: a
/// byte for each, 1 where it runs against that polygon.
///
/// Errors: LAP_ERR_NULL_POINTER if surface is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_polygons(
    surface: *const lap_surface,
    count: *mut i64,
    offsets: *mut *const i32,
    vertices: *mut *const i32,
    births: *mut *const i32,
    flipped: *mut *const u8,
) -> i32 {
    guard(|_| {
        let surface = unsafe { handle(surface) }?;
        let b = &surface.boundary;
        unsafe {
            put(count, b.polygons.len() as i64);
            put(offsets, address(&b.polygons.offsets));
            put(vertices, address(&b.polygons.items));
            put(births, address(&b.births));
            put(flipped, address(&surface.flipped));
        }
        Ok(())
    })
}

//! The noun `lap_network`, first part: making one. `network_views` has its vertices, polygons and what they form,
//! `network_surface` the boundaries of solids made of its regions.

use super::context::{State, c_string, lap_context, with_context};
use super::guard::{Host, guard};
use super::mesh::bad_options;
use super::network_views::Views;
use super::view::{handle, index, input, into_handle, put, read_options, write_options};
use crate::base::{Error, Status};
use crate::network::domain::LIMIT;
use crate::network::local::Setting;
use crate::network::regions::Method;
use crate::network::topology::{Topology, find_topology};
use crate::network::{BoxGrid, Domain, Kind, Network, TetMesh, Values, extract};
use std::ffi::{CString, c_char};

/// The implicit arrangement (IA): surfaces are where functions are zero.
pub const LAP_NETWORK_ARRANGEMENT: i32 = 0;
/// The material interface (MI): surfaces are where the largest function, the material, changes.
pub const LAP_NETWORK_INTERFACE: i32 = 1;

/// Regions are found by rays through the grid where these tell (a box, no vertex of the network at a node), else as
/// LAP_REGIONS_CLASSES.
pub const LAP_REGIONS_AUTOMATIC: i32 = 0;
/// Regions are found as classes of nodes, shells and cells, whatever the domain. The same regions, more time.
pub const LAP_REGIONS_CLASSES: i32 = 1;

/// The network of piecewise linear functions on a domain of tetrahedra (in two dimensions: triangles): vertices, polygons, and what they
/// form. Exact for any finite values.
///
/// Domain. A simplex is a tetrahedron (triangle); a node is a vertex of the domain, where functions have their values; in a simplex
/// they are linear. A box of nx × ny × nz cubes has node (i, j, k) at i + (nx + 1) (j + (ny + 1) k), cube (i, j, k) at
/// i + nx (j + ny k), and five tetrahedra a cube, 5 c to 5 c + 4 of cube c: one at each corner with even i + j + k, then the one between
/// the corners with odd i + j + k.
///
/// Arrangement: polygons are pieces of the zero sets of functions. A function that is zero on a lower-dimensional part of a
/// simplex only does not split it. A piece of the face between two simplices is a polygon if the sign of a function differs on its sides,
/// or if a function is zero on it and in neither simplex. Functions that are zero on one polygon are listed with it as a set.
/// Interface: polygons are where the regions of two materials meet; where materials are equal on a whole piece, the lowest
/// owns it. There are no polygons on the boundary of the domain.
///
/// Polygons are convex and lie in one simplex or on the face between two. Normals: arrangement: to the positive side of the lowest
/// function that has different signs on the two sides (where none has: into the simplex with the higher number); interface: into the
/// lower material. Loops run anticlockwise seen from the tip of the normal.
///
/// Patch: polygons joined across edges that have two polygons with one set of functions (and are not on the boundary of the domain). Chain: a
/// longest path or loop along other edges with two or more polygons, around which the same patches meet. (An edge with one polygon is a
/// border.) Corner: a vertex where chains end. Component: patches that share vertices. Shell: sides of patches that bound one
/// region along chains. Region: a part of the domain without polygons inside, bounded by shells; its label is the sign of every
/// function, or the material. The side of a patch is 2 p + s for patch p: s is 0 behind its normal, 1 before it.
///
/// Two dimensions: polygons are segments, from the first vertex to the second, with the normal to the left; edges are vertices
/// (both ends are the same); each vertex of the chain kind is a chain and a corner by itself; fourth nodes are -1, third
/// coordinates 0.
///
/// Immutable: a const handle may be used from many threads at once; what is computed on demand is computed once.
pub struct lap_network {
    pub data: Network,
    pub topology: Topology,
    /// How many threads what is computed on demand may use.
    pub threads: usize,
    /// What it was made from, if it was to be kept.
    pub source: Option<Source>,
    pub views: Views,
    stages: Vec<(CString, f64)>,
}

/// A domain and values of one's own.
pub struct Source {
    pub domain: Domain,
    pub values: Vec<Vec<f64>>,
}

const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<lap_network>();
};

/// Options of lap_network_new_*; filled by lap_network_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_network_options {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
    /// LAP_NETWORK_ARRANGEMENT, the default, or LAP_NETWORK_INTERFACE.
    pub kind: i32,
    /// How regions are found: LAP_REGIONS_AUTOMATIC, the default, or LAP_REGIONS_CLASSES.
    pub regions: i32,
    /// Nonzero: keep a copy of the values and of the mesh, which lap_network_vertex_exact, lap_network_region_ties,
    /// lap_network_complex and lap_network_check need. 0, the default: do not.
    pub keep_values: i32,
}

const DEFAULTS: lap_network_options = lap_network_options {
    struct_size: size_of::<lap_network_options>() as i32,
    kind: LAP_NETWORK_ARRANGEMENT,
    regions: LAP_REGIONS_AUTOMATIC,
    keep_values: 0,
};

/// Fills network options with the defaults.
///
/// struct_size: pass (int32_t)sizeof(lap_network_options); no more than that is written, so a program compiled against an
/// older header keeps working.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_options_init(options: *mut lap_network_options, struct_size: i32) -> i32 {
    guard(|_| unsafe { write_options(options, struct_size, DEFAULTS) })
}

/// The network of functions on a box of cubes, of which nothing is stored.
///
/// Inputs (borrowed for the call): cells: 3 numbers, cubes along x, y and z, 1 or more; bounds: lowest x, y, z, highest x, y, z: node i
/// of n + 1 along an axis is at (i / n) (highest - lowest) + lowest, computed in doubles as written; or NULL: then it is at i;
/// n_functions: functions, or materials; an arrangement may have none; values: that of function f at node i is
/// values[f × function_stride + i × node_stride], so with one array per function behind the other the strides are the number of nodes and
/// 1, and with interleaved values 1 and n_functions; options: or NULL for the defaults.
/// network: receives the handle, NULL after an error or cancel; free it with lap_network_free. It does not need the context to
/// stay alive.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for cells below 1, bounds that are not finite or do not rise, a stride below 1, a negative count, an
/// interface of no materials, an option that there is not, and, with a message that names function and node, for a value that is
/// NaN or infinite; LAP_ERR_TOO_LARGE if the box has 2^30 nodes or tetrahedra or more, or the result more elements than 32-bit
/// indices can number; LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: reading the values
/// once, else it grows with the simplices that surfaces cross and the polygons in them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_new_box(
    context: *mut lap_context,
    cells: *const i32,
    bounds: *const f64,
    n_functions: i64,
    values: *const f64,
    function_stride: i64,
    node_stride: i64,
    options: *const lap_network_options,
    network: *mut *mut lap_network,
) -> i32 {
    with_context(context, |state, host| {
        unsafe { clear(network)? };
        let cells = unsafe { input(cells.cast::<[i32; 3]>(), 1) }.map_err(|s| Error::new(s, "cells is NULL"))?[0];
        let bounds = match bounds.is_null() {
            true => None,
            false => Some(unsafe { input(bounds.cast::<[[f64; 3]; 2]>(), 1) }.map_err(|s| Error::new(s, "bounds"))?[0]),
        };
        // A negative count becomes 0, which is refused as well.
        let grid = BoxGrid::new(cells.map(|n| n.max(0) as u32), bounds)?;
        let order =
            unsafe { Order::read(grid.node_count(), n_functions, values, [function_stride, node_stride], options)? };
        let made = make(state, host, order, || Ok(Domain::Box(grid)))?;
        unsafe { put(network, into_handle(made)) };
        Ok(())
    })
}

/// The network of functions on a conforming mesh of tetrahedra: any, connected or not, with holes and handles.
///
/// Inputs (borrowed for the call): xyz: 3 × n_nodes coordinates; tets: 4 × n_tets nodes; the corners of a tetrahedron in either
/// orientation; nodes without tetrahedra are allowed. Two tetrahedra that share three nodes must lie on different sides of that face.
/// (Tetrahedra that overlap without sharing a face are not looked for: the network is then the union of what each holds.) Others as for
/// lap_network_new_box, with values at the n_nodes nodes.
/// network: receives the handle, NULL after an error or cancel; free it with lap_network_free.
///
/// Errors: LAP_ERR_BAD_MESH with LAP_DEFECT_NON_FINITE_COORDINATE, LAP_DEFECT_INDEX_OUT_OF_RANGE,
/// LAP_DEFECT_DEGENERATE_SIMPLEX or LAP_DEFECT_OVERLAPPING_SIMPLICES; LAP_ERR_TOO_LARGE for 2^30 nodes or tetrahedra or more; others
/// as for lap_network_new_box. Cost: linear in the mesh; faces are sorted around their lowest nodes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_new_tets(
    context: *mut lap_context,
    n_nodes: i64,
    xyz: *const f64,
    n_tets: i64,
    tets: *const i32,
    n_functions: i64,
    values: *const f64,
    function_stride: i64,
    node_stride: i64,
    options: *const lap_network_options,
    network: *mut *mut lap_network,
) -> i32 {
    with_context(context, |state, host| {
        unsafe { clear(network)? };
        let xyz = unsafe { input(xyz.cast::<[f64; 3]>(), n_nodes) }.map_err(|s| array("xyz", n_nodes, s))?;
        let tets = unsafe { input(tets.cast::<[i32; 4]>(), n_tets) }.map_err(|s| array("tets", n_tets, s))?;
        let order = unsafe { Order::read(xyz.len(), n_functions, values, [function_stride, node_stride], options)? };
        let made = make(state, host, order, || TetMesh::tets(xyz.to_vec(), tets).map(Domain::Mesh))?;
        unsafe { put(network, into_handle(made)) };
        Ok(())
    })
}

/// The network of functions on a conforming mesh of triangles in the plane: the same one dimension down.
///
/// Inputs (borrowed for the call): xy: 2 × n_nodes coordinates; triangles: 3 × n_triangles nodes, in either orientation; others as for
/// lap_network_new_tets.
/// network: receives the handle, NULL after an error or cancel; free it with lap_network_free.
///
/// Errors: as for lap_network_new_tets. Cost: as well.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_new_triangles(
    context: *mut lap_context,
    n_nodes: i64,
    xy: *const f64,
    n_triangles: i64,
    triangles: *const i32,
    n_functions: i64,
    values: *const f64,
    function_stride: i64,
    node_stride: i64,
    options: *const lap_network_options,
    network: *mut *mut lap_network,
) -> i32 {
    with_context(context, |state, host| {
        unsafe { clear(network)? };
        let xy = unsafe { input(xy.cast::<[f64; 2]>(), n_nodes) }.map_err(|s| array("xy", n_nodes, s))?;
        let triangles = unsafe { input(triangles.cast::<[i32; 3]>(), n_triangles) }
            .map_err(|s| array("triangles", n_triangles, s))?;
        let order = unsafe { Order::read(xy.len(), n_functions, values, [function_stride, node_stride], options)? };
        let made = make(state, host, order, || TetMesh::triangles(xy, triangles).map(Domain::Mesh))?;
        unsafe { put(network, into_handle(made)) };
        Ok(())
    })
}

/// # Safety
/// `network` is null or writable.
unsafe fn clear(network: *mut *mut lap_network) -> Result<(), Error> {
    if network.is_null() {
        return Err(Error::new(Status::NullPointer, "network is NULL"));
    }
    unsafe { put(network, std::ptr::null_mut()) };
    Ok(())
}

fn array(name: &str, count: i64, status: Status) -> Error {
    Error::new(status, format!("{name}: NULL, or a bad count: {count}"))
}

/// What is to be made, besides the domain.
struct Order<'a> {
    functions: Vec<&'a [f64]>,
    stride: usize,
    kind: Kind,
    method: Method,
    keep: bool,
}

impl<'a> Order<'a> {
    /// # Safety
    /// The pointers are null or as `lap_network_new_box` says.
    unsafe fn read(
        nodes: usize,
        n_functions: i64,
        values: *const f64,
        strides: [i64; 2],
        options: *const lap_network_options,
    ) -> Result<Self, Error> {
        let options = unsafe { read_options(options, DEFAULTS) }.map_err(bad_options)?;
        let bad = |message: String| Error::new(Status::BadArgument, message);
        let kind = match options.kind {
            LAP_NETWORK_ARRANGEMENT => Kind::Arrangement,
            LAP_NETWORK_INTERFACE => Kind::Interface,
            other => return Err(bad(format!("kind: {other} is no LAP_NETWORK_*"))),
        };
        let method = match options.regions {
            LAP_REGIONS_AUTOMATIC => Method::Automatic,
            LAP_REGIONS_CLASSES => Method::Classes,
            other => return Err(bad(format!("regions: {other} is no LAP_REGIONS_*"))),
        };
        if n_functions < 0 {
            return Err(bad(format!("n_functions: {n_functions} is negative")));
        }
        if n_functions >= LIMIT as i64 {
            return Err(Error::new(Status::TooLarge, "2^30 functions or more"));
        }
        let [function_stride, node_stride] = strides;
        for (name, stride) in [("function_stride", function_stride), ("node_stride", node_stride)] {
            if stride < 1 {
                return Err(bad(format!("{name}: {stride} is less than 1")));
            }
        }
        let mut functions = Vec::new();
        if n_functions > 0 && nodes > 0 {
            if values.is_null() {
                return Err(Error::new(Status::NullPointer, "values is NULL"));
            }
            // Numbers from the first to the last one of a function; all of them have to fit into memory.
            let length = (nodes as i64 - 1).checked_mul(node_stride).and_then(|n| n.checked_add(1));
            let whole = (n_functions - 1).checked_mul(function_stride).zip(length).and_then(|(a, b)| a.checked_add(b));
            let Some((length, _)) = length.zip(whole).filter(|&(_, whole)| whole <= isize::MAX as i64 / 8) else {
                return Err(bad(format!("strides of {function_stride} and {node_stride} reach beyond memory")));
            };
            let start = |f: i64| unsafe { values.add((f * function_stride) as usize) };
            functions =
                (0..n_functions).map(|f| unsafe { std::slice::from_raw_parts(start(f), length as usize) }).collect();
        } else {
            functions.resize(n_functions as usize, &[][..]);
        }
        Ok(Self { functions, stride: node_stride as usize, kind, method, keep: options.keep_values != 0 })
    }
}

fn make(
    state: &mut State,
    host: &mut Host,
    order: Order,
    domain: impl FnOnce() -> Result<Domain, Error> + Send,
) -> Result<lap_network, Error> {
    let threads = state.threads();
    state.run(host, |run| {
        run.stage("domain", 0.0)?;
        let domain = domain()?;
        let values = Values { functions: &order.functions, stride: order.stride };
        let data = extract(&domain, &values, order.kind, run)?;
        let topology = find_topology(&Setting { network: &data, domain: &domain, values }, order.method, run)?;
        let source = order.keep.then(|| {
            let copy = |f: &&[f64]| f.iter().step_by(order.stride).copied().collect();
            Source { domain, values: order.functions.iter().map(copy).collect() }
        });
        let longest = [
            data.polygons.items.len(),
            data.vertex_functions.items.len(),
            topology.edges.len(),
            // Sides of patches.
            2 * topology.patches.len(),
        ];
        if longest.iter().any(|&n| n > i32::MAX as usize) {
            return Err(Error::new(Status::TooLarge, "the result has more elements than 32-bit indices can number"));
        }
        let views = Views::of(&data, &topology);
        let stages = run.take_stages().iter().map(|(name, seconds)| (c_string(name), *seconds)).collect();
        Ok(lap_network { data, topology, threads, source, views, stages })
    })
}

/// Frees a network and all that was borrowed from it. NULL is allowed and does nothing. (Surfaces made from it stay.)
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_free(network: *mut lap_network) -> i32 {
    guard(|_| {
        if !network.is_null() {
            drop(unsafe { Box::from_raw(network) });
        }
        Ok(())
    })
}

/// Checks that a network is consistent with what it was made from: vertices in the simplices and on the functions that they
/// name, labels that come back around every edge, and everything formed of them.
///
/// Errors: LAP_ERR_BAD_ARGUMENT if it was made without keep_values; LAP_ERR_INCONSISTENT with a message that names the element;
/// LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: a sort of all edges.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_check(context: *mut lap_context, network: *const lap_network) -> i32 {
    with_context(context, |state, host| {
        let network = unsafe { handle(network) }.map_err(null_network)?;
        network.with_setting(|setting| {
            state.run(host, |_| {
                setting.network.check(setting.domain, &setting.values).map_err(Error::inconsistent)?;
                network.topology.check(setting).map_err(Error::inconsistent)
            })
        })
    })
}

impl lap_network {
    /// Calls `body` with what the network was made from, if that was kept.
    pub fn with_setting<R>(&self, body: impl FnOnce(&Setting) -> Result<R, Error>) -> Result<R, Error> {
        let missing = || Error::new(Status::BadArgument, "the network was made without keep_values");
        let source = self.source.as_ref().ok_or_else(missing)?;
        let functions: Vec<&[f64]> = source.values.iter().map(Vec::as_slice).collect();
        let values = Values { functions: &functions, stride: 1 };
        body(&Setting { network: &self.data, domain: &source.domain, values })
    }
}

pub fn null_network(status: Status) -> Error {
    Error::new(status, "network is NULL")
}

/// How many stages the making of the network ran through.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_stage_count(network: *const lap_network, count: *mut i32) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        if count.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(count, network.stages.len() as i32) };
        Ok(())
    })
}

/// Stage i, from 0, in the order in which they ran: its name and its time in seconds.
///
/// Outputs (each may be NULL). name is borrowed until the network is freed.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL, LAP_ERR_BAD_ARGUMENT if there is no such stage. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_stage(
    network: *const lap_network,
    i: i32,
    name: *mut *const c_char,
    seconds: *mut f64,
) -> i32 {
    guard(|_| {
        let stages = &unsafe { handle(network) }?.stages;
        let (text, time) = &stages[index(i, stages.len())?];
        unsafe {
            put(name, text.as_ptr());
            put(seconds, *time);
        }
        Ok(())
    })
}

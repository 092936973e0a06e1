//! The noun `lap_network`, second part: vertices, polygons and what they form, as borrowed views.

use super::complex::lap_complex;
use super::context::{lap_context, with_context};
use super::derived::{lend_complex, on_demand, once, put_strings, too_many_elements};
use super::guard::guard;
use super::network::{lap_network, null_network};
use super::view::{address, handle, index, put};
use crate::base::{Csr, Error, FunctionId, PolygonId, Status, VertexId};
use crate::network::csg::triangles;
use crate::network::exact_vertices::exact_vertex;
use crate::network::ties::tied_materials;
use crate::network::topology::Topology;
use crate::network::volumes::volumes;
use crate::network::{Kind, Network};
use std::ffi::c_char;
use std::sync::OnceLock;

/// What C reads in another form than the engine keeps it.
pub struct Views {
    active: Vec<i64>,
    set_functions: Vec<u32>,
    set_orientations: Vec<i32>,
    signs: Vec<i32>,
    loops: Vec<u8>,
    gaps: Vec<u8>,
    patch_polygons: OnceLock<Csr<PolygonId>>,
    turned: OnceLock<Vec<u8>>,
    triangles: OnceLock<(Vec<VertexId>, Vec<PolygonId>)>,
    ties: OnceLock<Csr<FunctionId>>,
    complex: OnceLock<lap_complex>,
}

impl Views {
    pub fn of(network: &Network, topology: &Topology) -> Self {
        let items = &network.sets.items;
        Self {
            active: network.active.iter().map(|&n| n as i64).collect(),
            set_functions: items.iter().map(|item| item.function.0).collect(),
            set_orientations: items.iter().map(|item| item.orientation.to_i8().into()).collect(),
            signs: topology.regions.signs.iter().map(|s| s.to_i8().into()).collect(),
            loops: topology.chains.is_loop.iter().map(|&b| b.into()).collect(),
            gaps: topology.chains.gap.iter().map(|&b| b.into()).collect(),
            patch_polygons: OnceLock::new(),
            turned: OnceLock::new(),
            triangles: OnceLock::new(),
            ties: OnceLock::new(),
            complex: OnceLock::new(),
        }
    }
}

/// How many elements a network has.
///
/// Outputs: each may be NULL; polygons are what the networks paper calls faces. Errors: LAP_ERR_NULL_POINTER if network is NULL.
/// Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_counts(
    network: *const lap_network,
    vertices: *mut i64,
    edges: *mut i64,
    polygons: *mut i64,
    patches: *mut i64,
    chains: *mut i64,
    corners: *mut i64,
    components: *mut i64,
    shells: *mut i64,
    regions: *mut i64,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        let t = &network.topology;
        unsafe {
            put(vertices, network.data.vertex_count() as i64);
            put(edges, t.edges.len() as i64);
            put(polygons, network.data.polygon_count() as i64);
            put(patches, t.patches.len() as i64);
            put(chains, t.chains.len() as i64);
            put(corners, t.chains.corners.len() as i64);
            put(components, t.patches.component_count as i64);
            put(shells, t.shells.len() as i64);
            put(regions, t.regions.len() as i64);
        }
        Ok(())
    })
}

/// What a network was made from.
///
/// Outputs (each may be NULL): kind: LAP_NETWORK_*; dim: the dimension, 2 or 3; functions: how many functions or materials.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_input(
    network: *const lap_network,
    kind: *mut i32,
    dim: *mut i32,
    functions: *mut i64,
) -> i32 {
    guard(|_| {
        let data = &unsafe { handle(network) }?.data;
        unsafe {
            put(
                kind,
                match data.kind {
                    Kind::Arrangement => super::network::LAP_NETWORK_ARRANGEMENT,
                    Kind::Interface => super::network::LAP_NETWORK_INTERFACE,
                },
            );
            put(dim, data.dim as i32);
            put(functions, data.function_count as i64);
        }
        Ok(())
    })
}

/// Active simplices by how many functions are active in them: those that are neither positive nor negative at all corners; of an
/// interface the materials that no other one exceeds at all corners, where there are two or more.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; simplices: count numbers, simplices[k] simplices have k
/// active functions.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_active(
    network: *const lap_network,
    count: *mut i64,
    simplices: *mut *const i64,
) -> i32 {
    guard(|_| {
        let active = &unsafe { handle(network) }?.views.active;
        unsafe {
            put(count, active.len() as i64);
            put(simplices, address(active));
        }
        Ok(())
    })
}

/// The vertices: no two are the same point, each is a corner of a polygon.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; xyz: 3 × count coordinates, each the double nearest to
/// the exact one (zero is +0); nodes: 4 × count: the nodes of the smallest simplex (node, edge, triangle, tetrahedron) of the domain that
/// holds the vertex, rising, then -1.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_vertices(
    network: *const lap_network,
    count: *mut i64,
    xyz: *mut *const f64,
    nodes: *mut *const i32,
) -> i32 {
    guard(|_| {
        let data = &unsafe { handle(network) }?.data;
        unsafe {
            put(count, data.vertex_count() as i64);
            put(xyz, address(&data.vertices));
            put(nodes, address(&data.vertex_nodes));
        }
        Ok(())
    })
}

/// All functions that are zero at each vertex; of an interface all materials that are largest there.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count: the number of vertices; offsets: count + 1; functions: those of
/// vertex v are functions[offsets[v]] up to, not including, functions[offsets[v + 1]], rising.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_vertex_functions(
    network: *const lap_network,
    count: *mut i64,
    offsets: *mut *const i32,
    functions: *mut *const i32,
) -> i32 {
    guard(|_| {
        let rows = &unsafe { handle(network) }?.data.vertex_functions;
        unsafe {
            put(count, rows.len() as i64);
            put(offsets, address(&rows.offsets));
            put(functions, address(&rows.items));
        }
        Ok(())
    })
}

/// The polygons, in the order of their simplices.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; vertices: those of polygon p are
/// vertices[offsets[p]] up to, not including, vertices[offsets[p + 1]], anticlockwise seen from the tip of its normal; sets: of each
/// polygon, the functions that it lies on (see lap_network_sets); simplices: 2 × count: those before and behind it, the same one
/// twice for a polygon inside a simplex.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_polygons(
    network: *const lap_network,
    count: *mut i64,
    offsets: *mut *const i32,
    vertices: *mut *const i32,
    sets: *mut *const i32,
    simplices: *mut *const i32,
) -> i32 {
    guard(|_| {
        let data = &unsafe { handle(network) }?.data;
        unsafe {
            put(count, data.polygon_count() as i64);
            put(offsets, address(&data.polygons.offsets));
            put(vertices, address(&data.polygons.items));
            put(sets, address(&data.polygon_set));
            put(simplices, address(&data.polygon_tets));
        }
        Ok(())
    })
}

/// The different sets of functions that polygons lie on, in lexicographic order.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; functions: those of set s are
/// functions[offsets[s]] up to, not including, functions[offsets[s + 1]], rising; of an interface two materials; orientations: one for
/// each of these: how the sign of the function changes along the normal, 1 if it rises, -1 if it falls, 0 if it is the same on both
/// sides; of an interface 1 for the material before the polygon, -1 for the one behind it.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_sets(
    network: *const lap_network,
    count: *mut i64,
    offsets: *mut *const i32,
    functions: *mut *const i32,
    orientations: *mut *const i32,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        unsafe {
            put(count, network.data.sets.len() as i64);
            put(offsets, address(&network.data.sets.offsets));
            put(functions, address(&network.views.set_functions));
            put(orientations, address(&network.views.set_orientations));
        }
        Ok(())
    })
}

/// The edges, and the polygons around each.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; vertices: 2 × count, the lower vertex first; offsets: count +
/// 1; polygons: those of edge e are polygons[offsets[e]] up to, not including, polygons[offsets[e + 1]], rising.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_edges(
    network: *const lap_network,
    count: *mut i64,
    vertices: *mut *const i32,
    offsets: *mut *const i32,
    polygons: *mut *const i32,
) -> i32 {
    guard(|_| {
        let edges = &unsafe { handle(network) }?.topology.edges;
        unsafe {
            put(count, edges.len() as i64);
            put(vertices, address(&edges.ends.items));
            put(offsets, address(&edges.polygons.offsets));
            put(polygons, address(&edges.polygons.items));
        }
        Ok(())
    })
}

/// The patch of each polygon.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count: the number of polygons; patches: count; turned: count bytes, 1
/// where the normal of the polygon is against that of the lowest polygon of its patch, which is the patch's. (Only polygons with one
/// label on both sides can be, or those of a patch with one side only.)
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: turned: linear at the first call;
/// then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_polygon_patches(
    network: *const lap_network,
    count: *mut i64,
    patches: *mut *const i32,
    turned: *mut *const u8,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        let p = &network.topology.patches;
        if !turned.is_null() {
            // The front of a turned polygon is the back of its patch.
            let is_turned = |i: usize| !p.side(PolygonId::of(i), true).front() as u8;
            let compute = || (0..p.of.len()).map(is_turned).collect::<Vec<u8>>();
            let bytes = on_demand(network.threads, &network.views.turned, compute)?;
            unsafe { put(turned, address(bytes)) };
        }
        unsafe {
            put(count, p.of.len() as i64);
            put(patches, address(&p.of));
        }
        Ok(())
    })
}

/// The patches, numbered by their lowest polygons.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; polygons: those of patch p are
/// polygons[offsets[p]] up to, not including, polygons[offsets[p + 1]], rising; they have one set of functions; components: the
/// component of each patch, numbered by their lowest polygons.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the polygons at the
/// first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_patches(
    network: *const lap_network,
    count: *mut i64,
    offsets: *mut *const i32,
    polygons: *mut *const i32,
    components: *mut *const i32,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        let p = &network.topology.patches;
        let rows = on_demand(network.threads, &network.views.patch_polygons, || {
            Csr::from_pairs(p.len(), p.of.iter().enumerate().map(|(i, patch)| (patch.at(), PolygonId::of(i))))
        })?;
        unsafe {
            put(count, p.len() as i64);
            put(offsets, address(&rows.offsets));
            put(polygons, address(&rows.items));
            put(components, address(&p.component));
        }
        Ok(())
    })
}

/// The chains, numbered by their lowest edges.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; edge_offsets: count + 1; edges: those of chain c are
/// edges[edge_offsets[c]] up to, not including, edges[edge_offsets[c + 1]], along it; vertex_offsets: count + 1; vertices: along it,
/// one more than edges (in two dimensions one), a loop begins and ends with the same; loops: count bytes, 1 where a chain closes without
/// a corner.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_chains(
    network: *const lap_network,
    count: *mut i64,
    edge_offsets: *mut *const i32,
    edges: *mut *const i32,
    vertex_offsets: *mut *const i32,
    vertices: *mut *const i32,
    loops: *mut *const u8,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        let c = &network.topology.chains;
        unsafe {
            put(count, c.len() as i64);
            put(edge_offsets, address(&c.edges.offsets));
            put(edges, address(&c.edges.items));
            put(vertex_offsets, address(&c.vertices.offsets));
            put(vertices, address(&c.vertices.items));
            put(loops, address(&network.views.loops));
        }
        Ok(())
    })
}

/// The order of patches around each chain.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count: the number of chains; offsets: count + 1; sides: those of
/// chain c are sides[offsets[c]] up to, not including, sides[offsets[c + 1]]: anticlockwise about its direction (seen against it), the side
/// of each patch that is met first, 2 p + s; a patch may be there several times; gaps: for each of these a byte, 1 where the
/// way from there to the next one (from the last to the first) leads out of the domain.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_chain_patches(
    network: *const lap_network,
    count: *mut i64,
    offsets: *mut *const i32,
    sides: *mut *const i32,
    gaps: *mut *const u8,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        let c = &network.topology.chains;
        unsafe {
            put(count, c.len() as i64);
            put(offsets, address(&c.around.offsets));
            put(sides, address(&c.around.items));
            put(gaps, address(&network.views.gaps));
        }
        Ok(())
    })
}

/// The corners: vertices where chains end.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; vertices: count, rising.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_corners(
    network: *const lap_network,
    count: *mut i64,
    vertices: *mut *const i32,
) -> i32 {
    guard(|_| {
        let corners = &unsafe { handle(network) }?.topology.chains.corners;
        unsafe {
            put(count, corners.len() as i64);
            put(vertices, address(corners));
        }
        Ok(())
    })
}

/// The shells: sides of patches that bound one region along edges.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; sides: those of shell s are
/// sides[offsets[s]] up to, not including, sides[offsets[s + 1]], rising, 2 p + s' for patch p; regions: the region of each shell.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_shells(
    network: *const lap_network,
    count: *mut i64,
    offsets: *mut *const i32,
    sides: *mut *const i32,
    regions: *mut *const i32,
) -> i32 {
    guard(|_| {
        let t = &unsafe { handle(network) }?.topology;
        unsafe {
            put(count, t.shells.len() as i64);
            put(offsets, address(&t.shells.half_patches.offsets));
            put(sides, address(&t.shells.half_patches.items));
            put(regions, address(&t.regions.of_shell));
        }
        Ok(())
    })
}

/// The regions: first those with shells, by their lowest shells, then parts of the domain that no polygon touches, by their lowest nodes.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; shells: those of region r are
/// shells[offsets[r]] up to, not including, shells[offsets[r + 1]], rising; simplices: one that holds a part of each region.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_regions(
    network: *const lap_network,
    count: *mut i64,
    offsets: *mut *const i32,
    shells: *mut *const i32,
    simplices: *mut *const i32,
) -> i32 {
    guard(|_| {
        let r = &unsafe { handle(network) }?.topology.regions;
        unsafe {
            put(count, r.len() as i64);
            put(offsets, address(&r.shells.offsets));
            put(shells, address(&r.shells.items));
            put(simplices, address(&r.simplices));
        }
        Ok(())
    })
}

/// The sign of every function in each region of an arrangement.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count: the number of regions; functions: n, the number of functions;
/// signs: count × n, that of function f in region r at r n + f: -1, 1, or 0 where the function is zero on the whole region.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL; LAP_ERR_BAD_ARGUMENT for an interface. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_region_signs(
    network: *const lap_network,
    count: *mut i64,
    functions: *mut i64,
    signs: *mut *const i32,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        if network.data.kind != Kind::Arrangement {
            return Err(Status::BadArgument);
        }
        unsafe {
            put(count, network.topology.regions.len() as i64);
            put(functions, network.data.function_count as i64);
            put(signs, address(&network.views.signs));
        }
        Ok(())
    })
}

/// The material of each region of an interface: the largest there, of equal ones the lowest. (Which others equal it throughout,
/// lap_network_region_ties tells.)
///
/// Outputs (each may be NULL; borrowed until the network is freed): count: the number of regions; materials: count.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL; LAP_ERR_BAD_ARGUMENT for an arrangement. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_region_materials(
    network: *const lap_network,
    count: *mut i64,
    materials: *mut *const i32,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        if network.data.kind != Kind::Interface {
            return Err(Status::BadArgument);
        }
        let regions = &network.topology.regions;
        unsafe {
            put(count, regions.len() as i64);
            put(materials, address(&regions.materials));
        }
        Ok(())
    })
}

/// The materials that are equal throughout each region of an interface: its owner, which is the lowest, and those that equal it at every node of every
/// simplex with a part of the region.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count: the number of regions; offsets: count + 1; materials: those
/// of region r are materials[offsets[r]] up to, not including, materials[offsets[r + 1]], rising.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for an arrangement, or if the network was made without keep_values; LAP_ERR_NULL_POINTER,
/// LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: at the first call linear in the simplices of regions with equal materials, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_region_ties(
    context: *mut lap_context,
    network: *const lap_network,
    count: *mut i64,
    offsets: *mut *const i32,
    materials: *mut *const i32,
) -> i32 {
    with_context(context, |state, host| {
        let network = unsafe { handle(network) }.map_err(null_network)?;
        let slot = &network.views.ties;
        if slot.get().is_none() {
            let found = network
                .with_setting(|setting| state.run(host, |_| tied_materials(setting, &network.topology.regions)))?;
            slot.get_or_init(|| found);
        }
        if let Some(ties) = slot.get() {
            unsafe {
                put(count, ties.len() as i64);
                put(offsets, address(&ties.offsets));
                put(materials, address(&ties.items));
            }
        }
        Ok(())
    })
}

/// The regions of a network in three dimensions as volumes: a complex on which all functions for lap_complex work but those for keys (there are none:
/// LAP_ERR_BAD_ARGUMENT). Its mesh is the boundary of the domain, a triangle for each face of a tetrahedron on it.
///
/// Cells are the regions, in their order. Faces are the pieces that the network leaves of the boundary's triangles, by triangle,
/// then the polygons of the network, in their order: polygon p is face n_faces - n_polygons + p. A polygon with one region on both
/// sides has one cell twice. Vertices are the nodes on the boundary (LAP_VERTEX_MESH, with their numbers as nodes), rising, then the
/// network's other vertices (LAP_VERTEX_LEVEL), rising. Volumes, moments and coordinates are exact as for all complexes.
///
/// complex: borrowed until the network is freed; do not free it.
///
/// Errors: LAP_ERR_BAD_ARGUMENT in two dimensions, or if the network was made without keep_values; LAP_ERR_BAD_MESH with LAP_DEFECT_EMPTY
/// for a domain without tetrahedra, or LAP_DEFECT_DUPLICATE_VERTEX where two nodes on its boundary are in one place;
/// LAP_ERR_TOO_LARGE, LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: at the first call linear in the
/// network and the boundary, with a sort of all edges, then none. Memory: some 300 bytes a vertex and 250 a polygon.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_complex(
    context: *mut lap_context,
    network: *const lap_network,
    complex: *mut *const lap_complex,
) -> i32 {
    with_context(context, |state, host| {
        let find = || {
            let network = unsafe { handle(network) }.map_err(null_network)?;
            once(&network.views.complex, || {
                let made =
                    network.with_setting(|setting| state.run(host, |run| volumes(setting, &network.topology, run)))?;
                lap_complex::new(made, network.threads).map_err(too_many_elements)
            })
        };
        unsafe { lend_complex(complex, find) }
    })
}

/// All polygons as triangles, without new vertices; in two dimensions there are none.
///
/// Outputs (each may be NULL; borrowed until the network is freed): count; vertices: 3 × count, anticlockwise as the polygon; polygons: that
/// of each triangle, rising.
///
/// Errors: LAP_ERR_NULL_POINTER if network is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_triangles(
    network: *const lap_network,
    count: *mut i64,
    vertices: *mut *const i32,
    polygons: *mut *const i32,
) -> i32 {
    guard(|_| {
        let network = unsafe { handle(network) }?;
        let all = on_demand(network.threads, &network.views.triangles, || triangles(&network.data))?;
        unsafe {
            put(count, all.1.len() as i64);
            put(vertices, address(&all.0));
            put(polygons, address(&all.1));
        }
        Ok(())
    })
}

/// The exact coordinates of a vertex, as canonical strings, "num/den" or "num" for an integer, in decimal. A GMP or CGAL rational reads
/// them.
///
/// Outputs (each may be NULL): x, y, z: valid until the next call with this context.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for a vertex that is not there, or if the network was made without keep_values;
/// LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: some microseconds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_network_vertex_exact(
    context: *mut lap_context,
    network: *const lap_network,
    vertex: i32,
    x: *mut *const c_char,
    y: *mut *const c_char,
    z: *mut *const c_char,
) -> i32 {
    with_context(context, |state, _| {
        let network = unsafe { handle(network) }.map_err(null_network)?;
        let none = |status| Error::new(status, format!("there is no vertex {vertex}"));
        let v = VertexId::of(index(vertex, network.data.vertex_count()).map_err(none)?);
        let exact = network.with_setting(|s| Ok(exact_vertex(s.network, s.domain, &s.values, v)))?;
        unsafe { put_strings(state, exact.map(|coordinate| coordinate.to_string()), [x, y, z]) };
        Ok(())
    })
}

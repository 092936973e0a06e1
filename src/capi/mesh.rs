//! The noun `lap_mesh`: a closed triangle mesh, validated once; its coordinates may be moved.

use super::context::{State, lap_context, with_context};
use super::derived::keep;
use super::guard::{Host, guard};
use super::view::{address, handle, handle_mut, input, into_handle, put, read_options, write_options};
use crate::base::{Error, Status};
use crate::complex::{exact_values, solid_euler};
use crate::exact::round_rational;
use crate::mesh::bvh::{Bvh, build_bvh};
use crate::mesh::{self, MeshInput, MeshOptions, Place, TriMesh, locate};
use rayon::prelude::*;
use rug::Rational;
use std::ffi::c_char;
use std::sync::{Arc, OnceLock};

/// A closed triangle mesh that bounds a solid: the triangles of every edge balance in orientation, solids are oriented
/// outward and voids inward. Any genus, several components, voids, non-manifold edges and vertices. A const
/// handle may be used from many threads at once; only lap_mesh_update_coordinates changes a mesh.
pub struct lap_mesh {
    pub mesh: Arc<TriMesh>,
    /// Global ids for keys; `None`: positions.
    pub triangle_ids: Option<Arc<[i64]>>,
    volume: OnceLock<Rational>,
    euler: OnceLock<i64>,
    bvh: OnceLock<Bvh>,
}

impl lap_mesh {
    fn volume(&self) -> &Rational {
        self.volume.get_or_init(|| exact_values::mesh_volume(&self.mesh))
    }
}

/// Options of lap_mesh_new; filled by lap_mesh_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct lap_mesh_options {
    /// Size of this struct in bytes, as the caller was compiled.
    pub struct_size: i32,
    /// Nonzero: vertices with equal coordinates become one (the lowest index stands for all). 0, the default: they
    /// are a defect.
    pub merge_duplicate_vertices: i32,
    /// Nonzero: find every pair of triangles that meet outside a vertex or an edge which they share, exactly. 0, the
    /// default: self-intersecting input gives LAP_ERR_INCONSISTENT or a result of unspecified geometry, never a crash.
    pub check_self_intersection: i32,
}

const DEFAULTS: lap_mesh_options = lap_mesh_options {
    struct_size: size_of::<lap_mesh_options>() as i32,
    merge_duplicate_vertices: 0,
    check_self_intersection: 0,
};

/// Fills mesh options with the defaults.
///
/// struct_size: pass (int32_t)sizeof(lap_mesh_options); no more than that is written, so a program compiled against an
/// older header keeps working.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_options_init(options: *mut lap_mesh_options, struct_size: i32) -> i32 {
    guard(|_| unsafe { write_options(options, struct_size, DEFAULTS) })
}

/// Makes a mesh from flat arrays.
///
/// Inputs (borrowed for the call): xyz: 3 × n_vertices coordinates, each taken as the exact number that it is, in any
/// unit; indices: 3 × n_triangles vertex indices from 0, anticlockwise seen from outside the solid; tags: n_triangles
/// numbers that are carried to the faces of results (boundary patch, body), or NULL; options: or NULL for the defaults.
/// Vertices that no triangle uses are allowed. mesh: receives the handle, NULL after an error; free it with
/// lap_mesh_free.
///
/// Errors: LAP_ERR_BAD_MESH with all defects found (lap_context_last_defects): coordinates that are not finite, indices
/// out of range, degenerate triangles, open edges, inconsistent orientation, wrong nesting, no triangles, and if asked
/// for self-intersections; LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT, LAP_ERR_TOO_LARGE, LAP_ERR_CANCELLED,
/// LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY.
/// Cost: n log n; with the check for self-intersections several times that.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_new(
    context: *mut lap_context,
    n_vertices: i64,
    xyz: *const f64,
    n_triangles: i64,
    indices: *const i32,
    tags: *const i32,
    options: *const lap_mesh_options,
    mesh: *mut *mut lap_mesh,
) -> i32 {
    with_context(context, |state, host| {
        if mesh.is_null() {
            return Err(Error::new(Status::NullPointer, "mesh is NULL"));
        }
        unsafe { put(mesh, std::ptr::null_mut()) };
        let arrays = unsafe { Arrays::borrow(n_vertices, xyz, n_triangles, indices, tags, options)? };
        let built = build(state, host, &arrays)?;
        let made = lap_mesh {
            mesh: Arc::new(built),
            triangle_ids: None,
            volume: OnceLock::new(),
            euler: OnceLock::new(),
            bvh: OnceLock::new(),
        };
        unsafe { put(mesh, into_handle(made)) };
        Ok(())
    })
}

/// Moves the vertices of a mesh and keeps its connectivity: the adjacency is reused, everything that depends on coordinates is
/// checked and computed anew, so that the mesh is afterwards what lap_mesh_new would make of them.
///
/// The handle is not const: no other thread may use it meanwhile, and what was borrowed from it (lap_mesh_vertices,
/// lap_mesh_bounds, ...) is no longer valid. Cuts and grids made from the mesh before keep the mesh that they were made
/// from. After an error the mesh is unchanged.
///
/// Inputs (borrowed for the call): xyz: 3 × n_vertices coordinates in the order of lap_mesh_vertices, which is the caller's own
/// order unless there were unused or merged vertices; options: or NULL for the defaults; only
/// check_self_intersection counts, and vertices that have become equal are a defect.
///
/// Errors: LAP_ERR_BAD_ARGUMENT if n_vertices is not the number of vertices of the mesh; LAP_ERR_BAD_MESH with all
/// defects found (lap_context_last_defects; ids are those of the mesh); LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE,
/// LAP_ERR_INCONSISTENT, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY.
/// Cost: linear, about a third of that of lap_mesh_new; a copy of the mesh if a cut or a grid holds it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_update_coordinates(
    context: *mut lap_context,
    mesh: *mut lap_mesh,
    n_vertices: i64,
    xyz: *const f64,
    options: *const lap_mesh_options,
) -> i32 {
    with_context(context, |state, host| {
        let mesh = unsafe { handle_mut(mesh) }.map_err(|s| Error::new(s, "mesh is NULL"))?;
        let vertices: &[[f64; 3]] = unsafe { input(xyz.cast(), n_vertices) }
            .map_err(|status| Error::new(status, format!("xyz: NULL, or a bad count: {n_vertices}")))?;
        let options = unsafe { read_options(options, DEFAULTS) }.map_err(bad_options)?;
        let options = MeshOptions {
            merge_duplicate_vertices: false,
            check_self_intersection: options.check_self_intersection != 0,
        };
        let held = &mut mesh.mesh;
        state.run(host, |run| mesh::update_coordinates(held, vertices, &options, run))?;
        (mesh.volume, mesh.euler, mesh.bvh) = (OnceLock::new(), OnceLock::new(), OnceLock::new());
        Ok(())
    })
}

/// Runs every check of lap_mesh_new, the one for self-intersections included, without making a mesh.
///
/// Inputs as for lap_mesh_new (options may be NULL; check_self_intersection is taken as set). n_defects (may be NULL)
/// receives how many defects there are.
///
/// Errors: those of lap_mesh_new: LAP_OK means that the mesh is valid, after LAP_ERR_BAD_MESH lap_context_last_defects
/// lists all defects. Cost: that of lap_mesh_new with the check for self-intersections.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_validate(
    context: *mut lap_context,
    n_vertices: i64,
    xyz: *const f64,
    n_triangles: i64,
    indices: *const i32,
    options: *const lap_mesh_options,
    n_defects: *mut i64,
) -> i32 {
    with_context(context, |state, host| {
        unsafe { put(n_defects, 0) };
        let mut arrays = unsafe { Arrays::borrow(n_vertices, xyz, n_triangles, indices, std::ptr::null(), options)? };
        arrays.options.check_self_intersection = 1;
        build(state, host, &arrays).map(drop).inspect_err(|error| unsafe {
            put(n_defects, error.culprits.len() as i64);
        })
    })
}

/// The borrowed input of a mesh.
pub struct Arrays<'a> {
    pub vertices: &'a [[f64; 3]],
    pub triangles: &'a [[i32; 3]],
    pub tags: Option<&'a [i32]>,
    options: lap_mesh_options,
}

impl Arrays<'_> {
    /// # Safety
    /// The pointers are null or as `lap_mesh_new` says.
    pub unsafe fn borrow(
        n_vertices: i64,
        xyz: *const f64,
        n_triangles: i64,
        indices: *const i32,
        tags: *const i32,
        options: *const lap_mesh_options,
    ) -> Result<Self, Error> {
        let named = |what: &'static str, n: i64| {
            move |status| {
                let message = match status {
                    Status::NullPointer => format!("{what} is NULL"),
                    Status::TooLarge => format!("the count of {what}, {n}, exceeds 2147483647"),
                    _ => format!("the count of {what} is negative: {n}"),
                };
                Error::new(status, message)
            }
        };
        let vertices = unsafe { input(xyz.cast(), n_vertices) }.map_err(named("xyz", n_vertices))?;
        let triangles = unsafe { input(indices.cast(), n_triangles) }.map_err(named("indices", n_triangles))?;
        let tags = if tags.is_null() {
            None
        } else {
            Some(unsafe { input(tags, n_triangles) }.map_err(named("tags", n_triangles))?)
        };
        let options = unsafe { read_options(options, DEFAULTS) }.map_err(bad_options)?;
        Ok(Arrays { vertices, triangles, tags, options })
    }
}

pub fn bad_options(status: Status) -> Error {
    Error::new(status, "options: struct_size is not a size, or options that this version does not know are set")
}

fn build(state: &mut State, host: &mut Host, arrays: &Arrays) -> Result<TriMesh, Error> {
    let input = MeshInput { vertices: arrays.vertices, triangles: arrays.triangles, tags: arrays.tags };
    let options = MeshOptions {
        merge_duplicate_vertices: arrays.options.merge_duplicate_vertices != 0,
        check_self_intersection: arrays.options.check_self_intersection != 0,
    };
    state.run(host, |run| mesh::build(&input, &options, run))
}

/// Frees a mesh. NULL is allowed and does nothing. Results made from the mesh stay valid.
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_free(mesh: *mut lap_mesh) -> i32 {
    guard(|_| {
        if !mesh.is_null() {
            drop(unsafe { Box::from_raw(mesh) });
        }
        Ok(())
    })
}

/// How many elements a mesh has: vertices (those that triangles use), triangles (all that were given), edges,
/// components (sets of triangles connected through edges), shells (sets of triangles connected through wedges of solid
/// at their edges; two solids that share an edge are two shells).
///
/// Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if mesh is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_counts(
    mesh: *const lap_mesh,
    vertices: *mut i64,
    triangles: *mut i64,
    edges: *mut i64,
    components: *mut i64,
    shells: *mut i64,
) -> i32 {
    guard(|_| {
        let m = &unsafe { handle(mesh) }?.mesh;
        unsafe {
            put(vertices, m.vertices.len() as i64);
            put(triangles, m.triangles.len() as i64);
            put(edges, m.edges.len() as i64);
            put(components, m.component_count as i64);
            put(shells, m.shells.len() as i64);
        }
        Ok(())
    })
}

/// The bounding box of a mesh.
///
/// bounds: receives a pointer to 6 doubles, lowest x, y, z and highest x, y, z; borrowed until the mesh is freed.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_bounds(mesh: *const lap_mesh, bounds: *mut *const f64) -> i32 {
    guard(|_| {
        let m = &unsafe { handle(mesh) }?.mesh;
        if bounds.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(bounds, address(&m.bbox)) };
        Ok(())
    })
}

/// The vertices of a mesh as it is held: those that triangles use, merged if asked for.
///
/// Outputs (each may be NULL; borrowed until the mesh is freed): count; xyz: 3 × count; sources: count indices of the
/// vertices in the caller's array.
///
/// Errors: LAP_ERR_NULL_POINTER if mesh is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_vertices(
    mesh: *const lap_mesh,
    count: *mut i64,
    xyz: *mut *const f64,
    sources: *mut *const i32,
) -> i32 {
    guard(|_| {
        let m = &unsafe { handle(mesh) }?.mesh;
        unsafe {
            put(count, m.vertices.len() as i64);
            put(xyz, address(&m.vertices));
            put(sources, address(&m.vertex_source));
        }
        Ok(())
    })
}

/// The triangles of a mesh, in the caller's order.
///
/// Outputs (each may be NULL; borrowed until the mesh is freed): count; vertices: 3 × count positions in the array of
/// lap_mesh_vertices; tags: count numbers as given, NULL if none were given.
///
/// Errors: LAP_ERR_NULL_POINTER if mesh is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_triangles(
    mesh: *const lap_mesh,
    count: *mut i64,
    vertices: *mut *const i32,
    tags: *mut *const i32,
) -> i32 {
    guard(|_| {
        let m = &unsafe { handle(mesh) }?.mesh;
        unsafe {
            put(count, m.triangles.len() as i64);
            put(vertices, address(&m.triangles));
            put(tags, address(&m.tags));
        }
        Ok(())
    })
}

/// The volume of the solid, in cubed units of the input: the double nearest to the exact volume.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: an exact sum over
/// the triangles at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_volume(mesh: *const lap_mesh, volume: *mut f64) -> i32 {
    guard(|_| {
        let mesh = unsafe { handle(mesh) }?;
        if volume.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(volume, round_rational(mesh.volume())) };
        Ok(())
    })
}

/// The exact volume of the solid as a canonical string, "num/den" or "num" for an integer, in decimal.
///
/// volume: valid until the next call with this context. A GMP or CGAL rational reads it.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: an exact sum over
/// the triangles at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_volume_exact(
    context: *mut lap_context,
    mesh: *const lap_mesh,
    volume: *mut *const c_char,
) -> i32 {
    with_context(context, |state, _| {
        let mesh = unsafe { handle(mesh) }.map_err(|s| Error::new(s, "mesh is NULL"))?;
        if volume.is_null() {
            return Err(Error::new(Status::NullPointer, "volume is NULL"));
        }
        unsafe { put(volume, keep(state, &mesh.volume().to_string())) };
        Ok(())
    })
}

/// The Euler characteristic of the solid, by the expression of lap_complex_euler: ball 1, ball with a void 2, solid
/// torus 0, two tetrahedra sharing a vertex 1.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_euler(mesh: *const lap_mesh, euler: *mut i64) -> i32 {
    guard(|_| {
        let mesh = unsafe { handle(mesh) }?;
        if euler.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(euler, *mesh.euler.get_or_init(|| solid_euler(&mesh.mesh))) };
        Ok(())
    })
}

/// A point outside the solid.
pub const LAP_PLACE_OUTSIDE: i32 = -1;
/// A point on the surface of the solid.
pub const LAP_PLACE_SURFACE: i32 = 0;
/// A point inside the solid.
pub const LAP_PLACE_INSIDE: i32 = 1;

/// Where points are with respect to the solid, exactly. (For example: what is known about a node, for a rank that holds only a
/// part of the mesh. See lap_grid_new_patch.)
///
/// Inputs (borrowed for the call): mesh; points: 3 × count finite coordinates. places: receives count numbers LAP_PLACE_*,
/// valid until the next call with this context.
///
/// Errors: LAP_ERR_BAD_ARGUMENT with a message that names the first point that is not finite; LAP_ERR_NULL_POINTER,
/// LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: n log n in the triangles at the first call, then logarithmic
/// for each point, plus some tens of nanoseconds for each triangle whose bounding box a ray from the point towards +x meets.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_locate(
    context: *mut lap_context,
    mesh: *const lap_mesh,
    count: i64,
    points: *const f64,
    places: *mut *const i32,
) -> i32 {
    with_context(context, |state, host| {
        let mesh = unsafe { handle(mesh) }.map_err(|s| Error::new(s, "mesh is NULL"))?;
        let points: &[[f64; 3]] = unsafe { input(points.cast(), count) }
            .map_err(|status| Error::new(status, format!("points: NULL, or a bad count: {count}")))?;
        if places.is_null() {
            return Err(Error::new(Status::NullPointer, "places is NULL"));
        }
        if let Some(i) = points.iter().flatten().position(|x| !x.is_finite()) {
            return Err(Error::new(Status::BadArgument, format!("point {} is not finite", i / 3)));
        }
        let found: Vec<i32> = state.run(host, |_| {
            let bvh = mesh.bvh.get_or_init(|| build_bvh(&mesh.mesh.vertices, &mesh.mesh.triangles));
            let place = |x| match locate(&mesh.mesh, bvh, x) {
                Place::Outside => LAP_PLACE_OUTSIDE,
                Place::Surface => LAP_PLACE_SURFACE,
                Place::Inside => LAP_PLACE_INSIDE,
            };
            Ok(points.par_iter().map(place).collect())
        })?;
        unsafe { put(places, address(&state.hold(found))) };
        Ok(())
    })
}

//! The noun `lap_complex`, third part: keys, and the global ids that they are made of.

use super::complex::lap_complex;
use super::context::{lap_context, with_context};
use super::cut::lap_cut;
use super::derived::on_demand;
use super::guard::guard;
use super::mesh::lap_mesh;
use super::view::{address, handle, handle_mut, input, put};
use crate::arrangement;
use crate::base::{Error, PlaneId, Status};
use crate::complex::keys::{check_ids, face_keys, names, vertex_keys};
use crate::complex::{GlobalIds, Key};
use std::sync::{Arc, OnceLock};

/// Global ids of a complex, and its keys once they have been asked for.
#[derive(Default)]
pub struct Keyed {
    /// `None`: positions.
    pub triangles: Option<Arc<[i64]>>,
    /// With the plane that stands for each. `None`: positions.
    planes: Option<(Vec<i64>, Vec<PlaneId>)>,
    keys: OnceLock<Result<Keys, Status>>,
}

impl Keyed {
    /// With ids for planes of which no two coincide.
    pub fn new(triangles: Option<Arc<[i64]>>, planes: Vec<i64>) -> Self {
        let own = (0..planes.len()).map(PlaneId::of).collect();
        Self { triangles, planes: Some((planes, own)), keys: OnceLock::new() }
    }
}

/// Of vertices, and of faces.
struct Keys {
    vertices: Vec<Key>,
    faces: Result<Vec<Key>, Status>,
}

fn make(complex: &lap_complex) -> Result<Keys, Status> {
    let (c, keyed) = (&complex.data, &complex.keyed);
    if !c.levels.points.is_empty() || !c.levels.supports.is_empty() {
        return Err(Status::BadArgument);
    }
    let ids = GlobalIds {
        triangles: keyed.triangles.as_deref(),
        planes: keyed.planes.as_ref().map(|p| &p.0[..]),
        plane_map: keyed.planes.as_ref().map(|p| &p.1[..]),
    };
    let names = names(&c.mesh, &c.planes, &ids).map_err(|error| error.status)?;
    let faces = match &complex.places {
        Some(p) => arrangement::keys::face_keys(&p.arrangement, c, &p.vertices, &p.faces, &names),
        None => face_keys(c, &names),
    };
    let faces = faces.map_err(|error| error.status);
    Ok(Keys { vertices: vertex_keys(c, &names), faces })
}

fn demand(complex: &lap_complex) -> Result<&Keys, Status> {
    let made = on_demand(complex.threads, &complex.keyed.keys, || make(complex))?;
    made.as_ref().map_err(|status| *status)
}

/// Gives the triangles of a mesh global ids, for keys: of results that are made from it afterwards. Without, the id of a
/// triangle is its index.
///
/// Inputs (borrowed for the call): ids: n_triangles numbers, one per triangle that the mesh was made of, in that order, each
/// from 0 up to, not including, 2^40, no two equal. Two meshes that hold parts of one surface give a triangle the
/// same id, and list its corners in the same order. No other call may use the mesh meanwhile.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for another number of ids, an id out of range, or two that are equal;
/// LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear if the ids rise, else n log n.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_mesh_set_triangle_ids(
    context: *mut lap_context,
    mesh: *mut lap_mesh,
    n_triangles: i64,
    ids: *const i64,
) -> i32 {
    with_context(context, |state, host| {
        let mesh = unsafe { handle_mut(mesh) }.map_err(|status| Error::new(status, "mesh is NULL"))?;
        let ids = unsafe { input(ids, n_triangles) }
            .map_err(|status| Error::new(status, format!("ids: NULL, or a bad count: {n_triangles}")))?;
        state.run(host, |_| check_ids(ids, mesh.mesh.triangles.len(), "triangle"))?;
        mesh.triangle_ids = Some(ids.into());
        Ok(())
    })
}

/// Gives the planes of a cut global ids, for keys. Without, the id of a plane is its index.
///
/// Inputs (borrowed for the call): ids: n_planes numbers, one per plane that was given to lap_cut_new, in that order, each from 0
/// up to, not including, 2^40, no two equal. Of coincident planes the smallest id stands for all. Only before the first call of
/// lap_complex_vertex_keys or lap_complex_face_keys; no other call may use the cut meanwhile.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for another number of ids, an id out of range, two that are equal, or if there
/// are keys already; LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear if the ids rise, else n log n.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_cut_set_plane_ids(
    context: *mut lap_context,
    cut: *mut lap_cut,
    n_planes: i64,
    ids: *const i64,
) -> i32 {
    with_context(context, |state, host| {
        let cut = unsafe { handle_mut(cut) }.map_err(|status| Error::new(status, "cut is NULL"))?;
        let ids = unsafe { input(ids, n_planes) }
            .map_err(|status| Error::new(status, format!("ids: NULL, or a bad count: {n_planes}")))?;
        state.run(host, |_| check_ids(ids, cut.plane_map.len(), "plane"))?;
        if cut.complex.keyed.keys.get().is_some() {
            return Err(Error::new(Status::BadArgument, "keys have been handed out already"));
        }
        cut.complex.keyed.planes = Some((ids.to_vec(), cut.plane_map.clone()));
        Ok(())
    })
}

/// The keys of the vertices: 128 bits each, made from global ids of triangles and planes alone (lap_mesh_set_triangle_ids,
/// lap_cut_set_plane_ids). No two vertices have the same key, and no vertex has that of a face. Two complexes cut from parts of
/// the same mesh by some of the same planes give a vertex that they share the same key, if both know all triangles that
/// contain it: a block that is given every triangle which meets its closed box, and the planes that bound it, does. (Arrangements promise less: a
/// point where more triangles meet than are needed to name it goes by those among which it was found first.)
///
/// Outputs (each may be NULL; borrowed as the complex): count; keys: 2 × count, the first number of a pair never negative.
/// What the numbers are: the 7 high bits of the first are the kind of the point, then follow three numbers of 40 bits, as for
/// lap_complex_vertex_origins; elements of the mesh go by the smallest id of the triangles that contain them. Kinds: 0, 1, 2:
/// corner 0, 1, 2 of a triangle; 3, 4, 5: on the side from corner 0, 1, 2 of a triangle to the next, and the smallest plane that
/// crosses it there; 6: inside a triangle, on two planes; 7: on three planes.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_BAD_ARGUMENT for that of a network, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first
/// call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_vertex_keys(
    complex: *const lap_complex,
    count: *mut i64,
    keys: *mut *const i64,
) -> i32 {
    guard(|_| {
        let made = demand(unsafe { handle(complex) }?)?;
        unsafe {
            put(count, made.vertices.len() as i64);
            put(keys, address(&made.vertices));
        }
        Ok(())
    })
}

/// The keys of the faces, as lap_complex_vertex_keys: no two faces have the same key, and a face that two complexes share has
/// the same key in both. A key names one edge of the face's boundary with its direction, and so the face on its left.
///
/// In complexes of arrangements (lap_arrangement_complex, lap_surface_complex) triangles are named by their places among those of all operands, one
/// behind the other (a half-space counts thirteen), and half-spaces by theirs among half-spaces. Faces with the same boundary have the same key in all
/// complexes of one arrangement and of arrangements of the same operands in the same order. Operands that are added behind the others change the keys
/// of those faces only that they cut or touch.
///
/// Outputs (each may be NULL; borrowed as the complex): count; keys: 2 × count, the first number of a pair never negative.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_BAD_ARGUMENT for that of a network, LAP_ERR_INCONSISTENT for input to a cut that intersects itself,
/// LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_face_keys(
    complex: *const lap_complex,
    count: *mut i64,
    keys: *mut *const i64,
) -> i32 {
    guard(|_| {
        let faces = demand(unsafe { handle(complex) }?)?.faces.as_ref().map_err(|status| *status)?;
        unsafe {
            put(count, faces.len() as i64);
            put(keys, address(faces));
        }
        Ok(())
    })
}

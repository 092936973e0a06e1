//! Keys of vertices and faces of cut boxes, as `complex::keys` makes them: from global ids of triangles and of the whole grid's
//! planes alone, so that blocks which share a face give it the same key.
//!
//! The planes through a vertex are not stored: `on_planes` says along which axes there is one, and its node has the vertex's
//! coordinate. Planes of a block are numbered in the order of the whole grid's, so names rise with positions.
//! Cost: linear; a binary search per corner and axis.

use super::data::GridCells;
use crate::base::{Error, FaceId, PlaneId, Result, VertexId};
use crate::complex::keys::{Corner, face_key, names, vertex_key};
use crate::complex::{GlobalIds, Key, SupportId};
use rayon::prelude::*;

/// The planes through a vertex: at most one across each axis.
struct Planes {
    ids: [PlaneId; 3],
    count: usize,
}

impl AsRef<[PlaneId]> for Planes {
    fn as_ref(&self) -> &[PlaneId] {
        &self.ids[..self.count]
    }
}

fn corner(g: &GridCells, v: VertexId) -> Corner<Planes> {
    let mut planes = Planes { ids: [PlaneId::NONE; 3], count: 0 };
    for axis in (0..3).filter(|a| g.on_planes[v.at()] >> a & 1 != 0) {
        let x = g.coords[v.at()][axis];
        let node = g.lattice.nodes[axis].partition_point(|&node| node < x);
        debug_assert_eq!(g.lattice.nodes[axis][node], x);
        planes.ids[planes.count] = g.lattice.plane(axis, node);
        planes.count += 1;
    }
    Corner { origin: g.origin(v), planes }
}

/// The keys of all vertices and of all faces. `triangles`: the global id of each triangle of the mesh; `None`: its position.
///
/// Errors: `Status::Inconsistent` for a face without a name (input that intersects itself).
pub fn keys(g: &GridCells, triangles: Option<&[i64]>) -> Result<(Vec<Key>, Vec<Key>)> {
    let planes: Vec<i64> = (0..g.planes.len()).map(|p| g.lattice.global_plane(PlaneId::of(p))).collect();
    let ids = GlobalIds { triangles, planes: Some(&planes), plane_map: None };
    let names = names(&g.mesh, &g.planes, &ids)?;
    let of_vertex = |v: usize| vertex_key(&names, &corner(g, VertexId::of(v)));
    let vertices = (0..g.coords.len()).into_par_iter().with_min_len(1024).map(of_vertex).collect();
    let of_face = |f: usize| {
        let face = FaceId::of(f);
        let support = match g.face_plane(face) {
            Some(plane) => SupportId::Plane(plane),
            None => SupportId::Triangle(g.wall_triangle[f]),
        };
        let loops = g.loops_of(face).map(|l| g.corners_of(l));
        face_key(&names, support, loops, |v| corner(g, v))
            .ok_or_else(|| Error::inconsistent(format!("the boundary of face {f} lies on no element of the input")))
    };
    let faces = (0..g.face_count()).into_par_iter().with_min_len(1024).map(of_face).collect::<Result<_>>()?;
    Ok((vertices, faces))
}

//! The polyhedral complex as plain flat arrays (DESIGN §7).

use crate::base::{CellId, ComponentId, Csr, EdgeId, FaceId, LoopId, PlaneId, PolygonId, TriangleId, VertexId};
use crate::exact::{self, Gradient, Plane, Point, Zero};
use crate::mesh::{self, TriMesh};
use std::sync::Arc;

/// What a vertex is, symbolically: the lowest-dimensional carrier that holds it, and the planes that fix it there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Origin {
    /// A vertex of the input mesh.
    Mesh(VertexId),
    /// The point where a mesh edge crosses a plane (the lowest of those that cross there).
    Edge(EdgeId, PlaneId),
    /// Inside a triangle, on two planes (the lexicographically first independent pair of those there).
    Triangle(TriangleId, PlaneId, PlaneId),
    /// Inside the solid, on three planes (the lexicographically first independent triple).
    Planes(PlaneId, PlaneId, PlaneId),
    /// Where a mesh edge crosses the plane of a triangle (arrangements).
    EdgeTriangle(EdgeId, TriangleId),
    /// Where two mesh edges of one plane cross.
    Edges(EdgeId, EdgeId),
    /// Where the planes of three triangles meet.
    Triangles(TriangleId, TriangleId, TriangleId),
    /// Where the planes of two triangles and a plane meet.
    TrianglesPlane(TriangleId, TriangleId, PlaneId),
    /// Where linear functions vanish: a position in [`Levels::points`].
    Level(u32),
}

/// What a face lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SupportId {
    Triangle(TriangleId),
    Plane(PlaneId),
    /// Where a linear function vanishes: a position in [`Levels::supports`].
    Level(PolygonId),
}

/// Zero sets of functions that are linear on the tetrahedra of a domain, of which the cells of a network are made.
/// Memory: some 300 bytes a point, 160 a support.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    pub points: Vec<Zero>,
    /// The network's name of each point.
    pub vertices: Vec<VertexId>,
    /// By polygon of the network: a function that vanishes on it and rises along its normal.
    pub supports: Vec<Gradient>,
}

/// One side of a face: `face << 1 | front`. Back: the side that the face's normal leaves. The back half-face belongs to
/// the face's owner, the front half-face to its neighbour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct HalfFace(pub u32);

impl HalfFace {
    #[inline(always)]
    pub fn new(face: FaceId, front: bool) -> Self {
        Self(face.0 << 1 | front as u32)
    }
    #[inline(always)]
    pub fn face(self) -> FaceId {
        FaceId(self.0 >> 1)
    }
    #[inline(always)]
    pub fn front(self) -> bool {
        self.0 & 1 != 0
    }
    #[inline(always)]
    pub fn at(self) -> usize {
        self.0 as usize
    }
}

/// Vertices, edges, faces with loops, cells with shells.
#[derive(Clone, Debug, Default)]
pub struct Complex {
    /// What the symbolic ids refer to.
    pub mesh: Arc<TriMesh>,
    pub planes: Vec<Plane>,
    pub levels: Arc<Levels>,
    /// Faces on triangles may have a cell before them, or none behind (arrangements): triangles do not bound the solid, and vertices on them may
    /// be named by others.
    pub two_sided: bool,

    /// Symbolic vertices and their coordinates, correctly rounded.
    pub origins: Vec<Origin>,
    pub coords: Vec<[f64; 3]>,
    /// All planes through each vertex, rising.
    pub vertex_planes: Csr<PlaneId>,

    pub edges: Vec<[VertexId; 2]>,

    /// Face `f` has loops `face_loops[f]..face_loops[f + 1]`: the outer loop first, then hole loops. Loops keep the
    /// face on their left when seen with its normal up (so holes run clockwise).
    pub face_loops: Vec<u32>,
    /// Loop `l` has corners `loop_offsets[l]..loop_offsets[l + 1]`.
    pub loop_offsets: Vec<u32>,
    /// The vertex of each corner.
    pub corner_vertices: Vec<VertexId>,
    /// The edge from each corner to the next of its loop; `NONE` for the only corner of an isolated vertex.
    pub corner_edges: Vec<EdgeId>,
    pub face_support: Vec<SupportId>,
    /// The lowest plane that the face lies on, `NONE` if none (a face on both a triangle and a plane has both).
    pub face_plane: Vec<PlaneId>,
    /// The tag of the triangle that a face lies on; 0 without tags and for faces on planes.
    pub face_tag: Vec<i32>,
    /// Owner (behind the normal) and neighbour (before it; `NONE` on the boundary of the solid).
    pub face_cells: Vec<[CellId; 2]>,

    /// Cell `c` has shells `cell_shells[c]..cell_shells[c + 1]`: the outer shell first, then voids.
    pub cell_shells: Vec<u32>,
    /// Shell `s` has half-faces `shell_faces.row(s)`, rising.
    pub shell_faces: Csr<HalfFace>,
    /// The input component that holds each cell's body; where faces are two-sided, cells that are joined across faces have one number.
    pub cell_component: Vec<ComponentId>,
}

impl Complex {
    pub fn vertex_count(&self) -> usize {
        self.origins.len()
    }
    pub fn edge_count(&self) -> usize {
        self.edges.len()
    }
    pub fn face_count(&self) -> usize {
        self.face_support.len()
    }
    pub fn cell_count(&self) -> usize {
        self.cell_component.len()
    }
    pub fn loops_of(&self, f: FaceId) -> impl Iterator<Item = LoopId> + Clone + use<> {
        (self.face_loops[f.at()]..self.face_loops[f.at() + 1]).map(LoopId)
    }
    #[inline(always)]
    pub fn corners_of(&self, l: LoopId) -> std::ops::Range<usize> {
        self.loop_offsets[l.at()] as usize..self.loop_offsets[l.at() + 1] as usize
    }
    /// Corners of all the loops of a face (they are contiguous).
    #[inline(always)]
    pub fn face_corners(&self, f: FaceId) -> std::ops::Range<usize> {
        let (a, b) = (self.face_loops[f.at()] as usize, self.face_loops[f.at() + 1] as usize);
        self.loop_offsets[a] as usize..self.loop_offsets[b] as usize
    }
    /// Half-faces of all the shells of a cell (they are contiguous).
    pub fn cell_faces(&self, c: CellId) -> &[HalfFace] {
        let (a, b) = (self.cell_shells[c.at()] as usize, self.cell_shells[c.at() + 1] as usize);
        &self.shell_faces.items[self.shell_faces.offsets[a] as usize..self.shell_faces.offsets[b] as usize]
    }
    /// The exact, symbolic point of a vertex.
    pub fn point(&self, v: VertexId) -> Point {
        match self.origins[v.at()] {
            Origin::Level(i) => Point::Zero(self.levels.points[i as usize]),
            origin => origin_point(&self.mesh, &self.planes, origin),
        }
    }
}

/// The exact point that an origin names, of mesh and planes. (Levels are those of a complex: [`Complex::point`].)
pub fn origin_point(mesh: &TriMesh, planes: &[Plane], origin: Origin) -> Point {
    match origin {
        Origin::Mesh(m) => Point::Vertex(mesh.vertices[m.at()]),
        Origin::Edge(e, p) => {
            let [a, b] = mesh.edges[e.at()];
            Point::EdgePlane { a: mesh.vertices[a.at()], b: mesh.vertices[b.at()], p: planes[p.at()] }
        }
        Origin::Triangle(t, p, q) => Point::TrianglePlanes { t: mesh.corners(t), p: planes[p.at()], q: planes[q.at()] },
        Origin::Planes(p, q, r) => Point::Planes { p: planes[p.at()], q: planes[q.at()], r: planes[r.at()] },
        Origin::EdgeTriangle(e, t) => {
            let [a, b] = mesh.edges[e.at()].map(|v| mesh.vertices[v.at()]);
            Point::EdgeTriangle { a, b, t: mesh.corners(t) }
        }
        Origin::Edges(e, f) => {
            let [[a, b], [c, d]] = [e, f].map(|e| mesh.edges[e.at()].map(|v| mesh.vertices[v.at()]));
            Point::Edges { a, b, c, d, axis: crossing_axis(&[a, b], &[c, d]) }
        }
        Origin::Level(_) => unreachable!("levels are those of a complex"),
        Origin::Triangles(t, u, v) => Point::Supports([t, u, v].map(|t| exact::Support::Triangle(mesh.corners(t)))),
        Origin::TrianglesPlane(t, u, p) => {
            let [t, u] = [t, u].map(|t| exact::Support::Triangle(mesh.corners(t)));
            Point::Supports([t, u, exact::Support::Plane(planes[p.at()])])
        }
    }
}

/// An axis along which two edges of one plane that cross are seen to cross: one along which two of their four ends and a third one
/// are no line. Of a line and two points on either side of it, both do.
pub fn crossing_axis([a, b]: &[[f64; 3]; 2], [c, _]: &[[f64; 3]; 2]) -> usize {
    mesh::projection::open_axis(&[*a, *b, *c]).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origins_are_small() {
        assert_eq!(size_of::<Origin>(), 16);
    }
}

//! What the stages of an arrangement hand to one another: plain flat arrays, each with a `check()` where its stage is.
//!
//! Vertices: ids below `soup.mesh.vertices.len()` are input positions, those from there on are constructed ([`Points`]). Two ids are never
//! the same point. Triangles and edges are those of the soup: all operands behind one another, then the sheets of half-spaces ([`super::supports`]).

use super::supports::HalfSpaces;
use crate::base::{CellId, Csr, EdgeId, FaceId, OperandId, PatchId, TriangleId, VertexId};
use crate::complex::{HalfFace, Origin};
use crate::exact::Point;
use crate::mesh::TriMesh;
use std::sync::Arc;

/// One input: any triangle mesh. Its triangles must balance at every edge, as point sets (piecewise constant winding number).
#[derive(Clone, Copy, Debug)]
pub struct Operand<'a> {
    pub vertices: &'a [[f64; 3]],
    pub triangles: &'a [[i32; 3]],
}

/// All operands as one list of triangles. Bit-equal positions are one vertex (-0 is 0), triangles without area are gone.
#[derive(Clone, Debug, Default)]
pub struct Soup {
    /// Vertices, triangles, edges and their uses, bounding box; without shells, and not closed in general.
    pub mesh: Arc<TriMesh>,
    /// Operand `i` has the triangles `first_triangle[i]..first_triangle[i + 1]`.
    pub first_triangle: Vec<u32>,
    /// The place of each triangle in its operand's list.
    pub source: Vec<u32>,
    /// Triangles without area that were dropped, per operand.
    pub dropped: Vec<u32>,
    /// The last operands, if there are any: see [`super::supports`].
    pub half_spaces: HalfSpaces,
}

/// Constructed points, in the order of their ids, from `soup.mesh.vertices.len()` on.
#[derive(Clone, Debug, Default)]
pub struct Points {
    pub origins: Vec<Origin>,
    /// Correctly rounded.
    pub coords: Vec<[f64; 3]>,
}

/// The line that a segment within a triangle lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Carrier {
    /// An edge of the soup: of the triangle itself, or of one in the same plane.
    Edge(EdgeId),
    /// The plane of another triangle, which is not parallel.
    Plane(TriangleId),
}

/// A segment in a triangle's plane, or a point there (both ends the same).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Segment {
    pub ends: [VertexId; 2],
    pub carrier: Carrier,
}

/// What pairs of triangles have in common (section 3.1 of the paper).
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    /// Points named by intersecting two triangles: on edges and, where two edges meet, on both.
    pub points: Points,
    /// Soup edges with points in their interior, rising, and these points from the lower end to the higher one.
    pub split_edges: Vec<EdgeId>,
    pub edge_points: Csr<VertexId>,
    /// Triangles with segments or points in their closure beyond their own corners and edges as they are, rising; and those, sorted, each once.
    /// A triangle of which only an edge is split is among them, with an empty row.
    pub cut: Vec<TriangleId>,
    pub segments: Csr<Segment>,
    /// Pairs that overlap in an area, lower id first, sorted; pairs with the same three corners included.
    pub overlaps: Vec<[TriangleId; 2]>,
    /// Pairs of triangles that meet outside what they share by index.
    pub pair_count: u64,
}

/// Triangles in one plane that overlap, directly or through others; most clusters are one triangle.
#[derive(Clone, Debug, Default)]
pub struct Clusters {
    /// The cut triangles by cluster, the lowest first; clusters by their lowest.
    pub members: Csr<TriangleId>,
}

/// A planar straight-line graph per cluster: segments meet in common ends only.
#[derive(Clone, Debug, Default)]
pub struct Graphs {
    /// All constructed points; those of [`Contacts`] first.
    pub points: Points,
    /// Pieces of segments and of the edges of members, each once, lower id first, sorted, per cluster.
    pub pieces: Csr<[VertexId; 2]>,
    /// Vertices on no piece, sorted, per cluster.
    pub lone: Csr<VertexId>,
    /// As in [`Contacts`].
    pub split_edges: Vec<EdgeId>,
    pub edge_points: Csr<VertexId>,
}

/// One triangle of an operand that a face is a part of, and whether they are oriented alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Birth {
    pub triangle: TriangleId,
    pub same: bool,
}

/// The resolved surface: triangles that meet in common vertices and edges only, no two with the same corners.
#[derive(Clone, Debug, Default)]
pub struct Resolved {
    pub soup: Soup,
    pub points: Points,
    /// Corners, oriented like the support. Faces `0..whole` are soup triangles as they came, in input order; then parts of cut ones.
    pub faces: Vec<[VertexId; 3]>,
    pub whole: usize,
    /// The lowest triangle that each face is a part of.
    pub support: Vec<TriangleId>,
    /// Faces that are parts of several triangles, rising, and all births of each, by triangle.
    pub shared: Vec<FaceId>,
    pub births: Csr<Birth>,
    /// Pairs of triangles that meet outside what they share by index.
    pub pair_count: u64,
}

impl Resolved {
    /// Input positions, then constructed points.
    pub fn vertex_count(&self) -> usize {
        self.soup.mesh.vertices.len() + self.points.origins.len()
    }
    /// Correctly rounded coordinates of a vertex.
    #[inline(always)]
    pub fn coords(&self, v: VertexId) -> [f64; 3] {
        let input = &self.soup.mesh.vertices;
        if v.at() < input.len() { input[v.at()] } else { self.points.coords[v.at() - input.len()] }
    }
    pub fn origin(&self, v: VertexId) -> Origin {
        let input = self.soup.mesh.vertices.len();
        if v.at() < input { Origin::Mesh(v) } else { self.points.origins[v.at() - input] }
    }
    /// The exact, symbolic point of a vertex.
    pub fn point(&self, v: VertexId) -> Point {
        self.soup.point(self.origin(v))
    }
}

/// Net multiplicity of a face, or a winding number, per operand: pairs with rising operands, zeros left out.
pub type Multiplicity = (OperandId, i32);

/// Faces joined across edges with two faces; the two sides of each patch; the cells that patches bound.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// The patch of each face; `NONE` where all multiplicities are zero: such faces divide nothing.
    pub patch: Vec<PatchId>,
    /// The lowest face of each patch.
    pub patch_face: Vec<FaceId>,
    /// Net multiplicities along the lowest face's orientation, per patch.
    pub multiplicity: Csr<Multiplicity>,
    /// The cell of each half-face (`NONE` for faces without a patch). Cell 0 is the unbounded one; the others by lowest half-face.
    pub of: Vec<CellId>,
    pub cell_count: usize,
    /// A half-face of each cell, the lowest (of the unbounded cell of nothing: none).
    pub lowest: Vec<HalfFace>,
}

/// The winding-number vector of each cell.
#[derive(Clone, Debug, Default)]
pub struct Winding {
    pub rows: Csr<Multiplicity>,
}

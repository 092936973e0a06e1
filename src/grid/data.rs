//! What cutting a rectilinear grid gives, as plain flat arrays: a byte per box, and polyhedra for the boxes that the surface
//! touches. Leaner than a `Complex`, which `to_complex` makes of it on demand: edges are pairs of neighbouring corners, and what
//! the lattice implies is not stored.

use super::lattice::Lattice;
use crate::base::{BoxId, CellId, Csr, EdgeId, FaceId, LoopId, NodeId, PlaneId, TriangleId, VertexId};
use crate::complex::{HalfFace, Origin};
use crate::exact::Plane;
use crate::mesh::TriMesh;
use std::sync::Arc;

/// The open box holds no fluid.
pub const EMPTY: u8 = 0;
/// The closed box misses the surface and is fluid.
pub const FULL: u8 = 1;
/// The surface touches the closed box, and the open box holds fluid.
pub const CUT: u8 = 2;

/// Stands for the one cell of a full box where cells are named.
pub const FULL_CELL: CellId = CellId(u32::MAX - 1);

/// A block of a rectilinear grid, cut by a surface.
#[derive(Clone, Debug, Default)]
pub struct GridCells {
    /// The triangles that meet the block's closed box (or more), directed so that the fluid is behind their normals: reversed
    /// where the fluid is outside the mesh.
    pub mesh: Arc<TriMesh>,
    pub lattice: Lattice,
    /// The block's grid planes, by `Lattice::plane`.
    pub planes: Vec<Plane>,
    /// `EMPTY`, `FULL` or `CUT` per box.
    pub flags: Vec<u8>,

    /// Vertices that some face uses, with correctly rounded coordinates: mesh vertices, points on mesh edges, points in triangles, nodes.
    pub coords: Vec<[f64; 3]>,
    /// Bit `a`: the vertex lies on a grid plane normal to axis `a` (exactly; its coordinate is that plane's node).
    pub on_planes: Vec<u8>,
    /// What vertices are symbolically, packed (see [`GridCells::origin`]).
    pub origins: Origins,
    /// Vertices `constructed.start..constructed.end` are points on mesh edges and in triangles; all others are exact in `coords`.
    /// For these, what rounding took away: |x − (coords + residuals)| ≤ 2⁻⁹⁰·`extent` per coordinate (and +0 where a coordinate is exact).
    pub constructed: std::ops::Range<u32>,
    pub residuals: Vec<[f64; 3]>,
    /// The largest |coordinate| of the mesh.
    pub extent: f64,

    /// Face `f` has loops `face_loops[f]..face_loops[f + 1]`, the outer loop first; a wall has one.
    pub face_loops: Vec<u32>,
    /// Loop `l` has corners `loop_offsets[l]..loop_offsets[l + 1]`; a loop of one corner is a touching vertex. Loops keep the face on
    /// their left, seen with its normal up.
    pub loop_offsets: Vec<u32>,
    pub corners: Vec<VertexId>,

    /// Faces `0..wall_triangle.len()` are walls, by rising triangle: the triangle they lie on and the one cell behind them.
    pub wall_triangle: Vec<TriangleId>,
    pub wall_cell: Vec<CellId>,
    /// Then come faces in grid planes; those normal to axis `a` are `plane_faces[a]..plane_faces[a + 1]`, by rising plane, then square. Their normal points
    /// along the axis.
    pub plane_faces: [u32; 4],
    /// For each face in a grid plane (from the first of them on): the lowest node of its square,
    pub square_node: Vec<NodeId>,
    /// and the cells on its lower and upper side: a cell, `FULL_CELL`, or `NONE` at the block's boundary.
    pub square_cells: Vec<[CellId; 2]>,

    /// Boxes that are `CUT`, rising; box `cut_boxes[b]` holds cells `box_cells[b]..box_cells[b + 1]`.
    pub cut_boxes: Vec<BoxId>,
    pub box_cells: Vec<u32>,
    /// Cell `c` has shells `cell_shells[c]..cell_shells[c + 1]`, the outer one first; shell `s` has half-faces `shell_faces.row(s)`, rising.
    /// The back half-face of a wall is the fluid's; that of a face in a plane is on its lower side.
    pub cell_shells: Vec<u32>,
    pub shell_faces: Csr<HalfFace>,
}

/// Origins in five bytes a vertex: planes are told by the axes that they are normal to, since coordinates tell the rest. A `Vec<Origin>` takes
/// sixteen, and vertices are what a grid has most of.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    /// The mesh vertex, mesh edge or triangle; nothing for a node.
    carriers: Vec<u32>,
    /// The kind, and the axis of an edge's plane, or the axis that is neither of a triangle's two planes'.
    codes: Vec<u8>,
}

const ON_MESH: u8 = 0;
const ON_EDGE: u8 = 4;
const IN_TRIANGLE: u8 = 8;
const NODE: u8 = 12;

impl Origins {
    pub fn new(lattice: &Lattice, origins: impl Iterator<Item = Origin>) -> Self {
        let mut out = Self::default();
        let axis = |p: PlaneId| lattice.plane_at(p).0 as u8;
        for origin in origins {
            let (carrier, code) = match origin {
                Origin::Mesh(v) => (v.0, ON_MESH),
                Origin::Edge(e, p) => (e.0, ON_EDGE + axis(p)),
                Origin::Triangle(t, p, q) => (t.0, IN_TRIANGLE + 3 - axis(p) - axis(q)),
                Origin::Planes(..) => (0, NODE),
                Origin::EdgeTriangle(..)
                | Origin::Edges(..)
                | Origin::Triangles(..)
                | Origin::TrianglesPlane(..)
                | Origin::Level(_) => {
                    unreachable!("grids make points on planes only")
                }
            };
            out.carriers.push(carrier);
            out.codes.push(code);
        }
        out
    }
    pub fn len(&self) -> usize {
        self.codes.len()
    }
    pub fn is_empty(&self) -> bool {
        self.codes.is_empty()
    }
}

impl GridCells {
    pub fn vertex_count(&self) -> usize {
        self.coords.len()
    }
    /// The plane normal to an axis through a vertex that is on one. Cost: a binary search.
    pub fn plane_through(&self, v: VertexId, axis: usize) -> PlaneId {
        let x = self.coords[v.at()][axis];
        let node = self.lattice.nodes[axis].partition_point(|n| *n < x);
        debug_assert!(self.lattice.nodes[axis][node] == x && self.on_planes[v.at()] >> axis & 1 != 0);
        self.lattice.plane(axis, node)
    }
    /// What a vertex is, symbolically (planes by `Lattice::plane`).
    pub fn origin(&self, v: VertexId) -> Origin {
        let (carrier, code) = (self.origins.carriers[v.at()], self.origins.codes[v.at()]);
        let plane = |axis: usize| self.plane_through(v, axis);
        let axis = code as usize & 3;
        match code & !3 {
            ON_MESH => Origin::Mesh(VertexId(carrier)),
            ON_EDGE => Origin::Edge(EdgeId(carrier), plane(axis)),
            IN_TRIANGLE => {
                let [a, b] = super::touched::others(axis);
                Origin::Triangle(TriangleId(carrier), plane(a), plane(b))
            }
            _ => Origin::Planes(plane(0), plane(1), plane(2)),
        }
    }
    pub fn face_count(&self) -> usize {
        self.face_loops.len() - 1
    }
    pub fn wall_count(&self) -> usize {
        self.wall_triangle.len()
    }
    pub fn cell_count(&self) -> usize {
        self.cell_shells.len() - 1
    }
    pub fn loops_of(&self, f: FaceId) -> impl Iterator<Item = LoopId> + Clone + use<> {
        (self.face_loops[f.at()]..self.face_loops[f.at() + 1]).map(LoopId)
    }
    #[inline(always)]
    pub fn corners_of(&self, l: LoopId) -> &[VertexId] {
        &self.corners[self.loop_offsets[l.at()] as usize..self.loop_offsets[l.at() + 1] as usize]
    }
    /// Corners of all the loops of a face (they are contiguous).
    #[inline(always)]
    pub fn face_corners(&self, f: FaceId) -> &[VertexId] {
        let (a, b) = (self.face_loops[f.at()] as usize, self.face_loops[f.at() + 1] as usize);
        &self.corners[self.loop_offsets[a] as usize..self.loop_offsets[b] as usize]
    }
    /// What rounding took away from a vertex's coordinates.
    #[inline(always)]
    pub fn residual(&self, v: VertexId) -> [f64; 3] {
        if self.constructed.contains(&v.0) { self.residuals[(v.0 - self.constructed.start) as usize] } else { [0.0; 3] }
    }
    /// Half-faces of all the shells of a cell (they are contiguous).
    pub fn cell_faces(&self, c: CellId) -> &[HalfFace] {
        let (a, b) = (self.cell_shells[c.at()] as usize, self.cell_shells[c.at() + 1] as usize);
        &self.shell_faces.items[self.shell_faces.offsets[a] as usize..self.shell_faces.offsets[b] as usize]
    }
    /// The axis that a face in a grid plane is normal to.
    #[inline(always)]
    pub fn face_axis(&self, f: FaceId) -> usize {
        debug_assert!(f.0 >= self.plane_faces[0]);
        (f.0 >= self.plane_faces[1]) as usize + (f.0 >= self.plane_faces[2]) as usize
    }
    /// The grid plane that a face lies in, if it is not a wall.
    pub fn face_plane(&self, f: FaceId) -> Option<PlaneId> {
        let square = (f.0).checked_sub(self.plane_faces[0])?;
        let axis = self.face_axis(f);
        Some(self.lattice.plane(axis, self.lattice.node_at(self.square_node[square as usize])[axis]))
    }
    /// The cells of a box: none unless it is `CUT`.
    pub fn cells_of(&self, b: BoxId) -> std::ops::Range<u32> {
        match self.cut_boxes.binary_search(&b) {
            Ok(i) => self.box_cells[i]..self.box_cells[i + 1],
            Err(_) => 0..0,
        }
    }
}

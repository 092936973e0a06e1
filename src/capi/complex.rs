//! The noun `lap_complex`, first half: what is stored, as borrowed views. `derived` has what is computed on demand.

use super::derived::Derived;
use super::guard::guard;
use super::keys::Keyed;
use super::view::{address, handle, index, put};
use crate::arrangement::Arrangement;
use crate::arrangement::solids::Solids;
use crate::base::{CellId, Csr, EdgeId, FaceId, PlaneId, Status, TriangleId, VertexId};
use crate::complex::{Complex, Origin, SupportId};
use crate::mesh::TriMesh;
use std::sync::{Arc, OnceLock};

/// A vertex of the input mesh. ids: its index in the caller's array
pub const LAP_VERTEX_MESH: i32 = 0;
/// Where an edge of the mesh crosses a plane. ids: the two vertices of the edge, the lowest plane
pub const LAP_VERTEX_EDGE: i32 = 1;
/// Inside a triangle of the mesh, on two planes. ids: triangle, plane, plane
pub const LAP_VERTEX_TRIANGLE: i32 = 2;
/// Inside the solid, on three planes. ids: plane, plane, plane
pub const LAP_VERTEX_PLANES: i32 = 3;
/// Where triangles of an arrangement meet. ids: three triangles; or one at an edge, one that it crosses, and -1
pub const LAP_VERTEX_TRIANGLES: i32 = 4;
/// A point of a network's domain where functions vanish (materials are equal). ids: the network's vertex, -1, -1
pub const LAP_VERTEX_LEVEL: i32 = 5;
/// Where two triangles of an arrangement and the plane of a half-space meet. ids: triangle, triangle, plane
pub const LAP_VERTEX_TRIANGLES_PLANE: i32 = 6;

/// A face that lies on a triangle of the input mesh.
pub const LAP_SUPPORT_TRIANGLE: i32 = 0;
/// A face that lies on a plane.
pub const LAP_SUPPORT_PLANE: i32 = 1;
/// A polygon of a network.
pub const LAP_SUPPORT_LEVEL: i32 = 2;

/// Vertices, edges, faces and cells. Belongs to the handle that it was borrowed from. Ids are positions in the
/// arrays, from 0. Immutable: a const handle may be used from many threads at once; what is computed on demand is
/// computed once.
///
/// Half-faces: side s of face f is the half-face 2 f + s. Side 0 is the back, from which the face's normal points away;
/// it belongs to the cell behind the face, the owner, whose outward normal the face's normal is. Side 1 is the front; it
/// belongs to the neighbour, and there the outward normal is the face's normal reversed.
pub struct lap_complex {
    pub data: Complex,
    /// How many threads what is computed on demand may use.
    pub threads: usize,
    pub derived: Derived,
    pub keyed: Keyed,
    /// Some of a solid's cells only: faces on planes may have one cell.
    pub part: bool,
    /// Of an arrangement's cells: where it comes from.
    pub places: Option<Places>,
    /// What the caller calls the triangles of the mesh; empty: positions.
    numbers: Vec<u32>,
    origins: OnceLock<(Vec<i32>, Vec<[i32; 3]>)>,
    supports: OnceLock<(Vec<i32>, Vec<i32>)>,
}

/// The arrangement whose cells make up a complex, and what there its vertices and its faces are.
pub struct Places {
    pub arrangement: Arc<Arrangement>,
    pub vertices: Vec<VertexId>,
    pub faces: Csr<FaceId>,
}

impl lap_complex {
    /// Takes a complex over, if all its counts fit C's `int32_t`.
    pub fn new(data: Complex, threads: usize) -> Result<Self, Status> {
        let longest = [
            data.vertex_count(),
            data.vertex_planes.items.len(),
            data.edge_count(),
            // Half-faces are numbered by twice the face.
            2 * data.face_count(),
            data.corner_vertices.len(),
            data.shell_faces.items.len(),
        ];
        if longest.iter().any(|&n| n > i32::MAX as usize) {
            return Err(Status::TooLarge);
        }
        Ok(Self {
            data,
            threads,
            derived: Derived::default(),
            keyed: Keyed::default(),
            part: false,
            places: None,
            numbers: Vec::new(),
            origins: OnceLock::new(),
            supports: OnceLock::new(),
        })
    }

    /// The same of an arrangement's cells.
    pub fn of_arrangement(made: Solids, arrangement: &Arc<Arrangement>, threads: usize) -> Result<Self, Status> {
        let mut complex = Self::new(made.complex, threads)?;
        complex.numbers = arrangement.resolved.soup.given();
        complex.keyed.triangles = Some(complex.numbers.iter().map(|&n| n.into()).collect());
        let arrangement = arrangement.clone();
        complex.places = Some(Places { arrangement, vertices: made.vertices, faces: made.faces });
        Ok(complex)
    }

    fn triangle(&self, t: TriangleId) -> i32 {
        self.numbers.get(t.at()).map_or(t.0, |n| *n) as i32
    }
}

const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<lap_complex>();
};

/// How many elements a complex has. loops, corners: of all faces; shells: of all cells.
///
/// Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_counts(
    complex: *const lap_complex,
    vertices: *mut i64,
    edges: *mut i64,
    faces: *mut i64,
    cells: *mut i64,
    loops: *mut i64,
    corners: *mut i64,
    shells: *mut i64,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        unsafe {
            put(vertices, c.vertex_count() as i64);
            put(edges, c.edge_count() as i64);
            put(faces, c.face_count() as i64);
            put(cells, c.cell_count() as i64);
            put(loops, c.loop_offsets.len().saturating_sub(1) as i64);
            put(corners, c.corner_vertices.len() as i64);
            put(shells, c.shell_faces.len() as i64);
        }
        Ok(())
    })
}

/// The coordinates of the vertices: each the double nearest to the exact coordinate (ties to even, zero as +0), in the
/// units of the input. Vertices of the input mesh come first.
///
/// Outputs (each may be NULL; borrowed as the complex): count; xyz: 3 × count.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_vertices(
    complex: *const lap_complex,
    count: *mut i64,
    xyz: *mut *const f64,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        unsafe {
            put(count, c.coords.len() as i64);
            put(xyz, address(&c.coords));
        }
        Ok(())
    })
}

/// What each vertex is, symbolically.
///
/// Outputs (each may be NULL; borrowed as the complex): count; kinds: count numbers LAP_VERTEX_*; ids: 3 × count, as
/// LAP_VERTEX_* says, in the caller's numbering, -1 where unused.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_vertex_origins(
    complex: *const lap_complex,
    count: *mut i64,
    kinds: *mut *const i32,
    ids: *mut *const i32,
) -> i32 {
    guard(|_| {
        let complex = unsafe { handle(complex) }?;
        let (of_kind, of_ids) = complex.origins.get_or_init(|| origins(complex));
        unsafe {
            put(count, of_kind.len() as i64);
            put(kinds, address(of_kind));
            put(ids, address(of_ids));
        }
        Ok(())
    })
}

fn origins(complex: &lap_complex) -> (Vec<i32>, Vec<[i32; 3]>) {
    let c = &complex.data;
    let level = |i: u32| c.levels.vertices[i as usize].0 as i32;
    c.origins.iter().map(|origin| number_origin(&c.mesh, |t| complex.triangle(t), level, origin)).unzip()
}

/// An origin as numbers for C: LAP_VERTEX_*, and ids. `triangle` numbers the triangles of the mesh for the caller, `level` the
/// vertices of a network.
pub fn number_origin(
    mesh: &TriMesh,
    triangle: impl Fn(TriangleId) -> i32,
    level: impl Fn(u32) -> i32,
    origin: &Origin,
) -> (i32, [i32; 3]) {
    let source = |v: VertexId| mesh.vertex_source[v.at()] as i32;
    let first = |e: EdgeId| mesh.edge_uses.row(e).first().map_or(-1, |u| triangle(u.triangle));
    match *origin {
        Origin::Mesh(v) => (LAP_VERTEX_MESH, [source(v), -1, -1]),
        Origin::Edge(e, p) => {
            let [a, b] = mesh.edges[e.at()];
            (LAP_VERTEX_EDGE, [source(a), source(b), p.0 as i32])
        }
        Origin::Triangle(t, p, q) => (LAP_VERTEX_TRIANGLE, [triangle(t), p.0 as i32, q.0 as i32]),
        Origin::Planes(p, q, r) => (LAP_VERTEX_PLANES, [p.0 as i32, q.0 as i32, r.0 as i32]),
        // Named by the lowest triangle at each edge.
        Origin::EdgeTriangle(e, t) => (LAP_VERTEX_TRIANGLES, [first(e), triangle(t), -1]),
        Origin::Edges(e, f) => (LAP_VERTEX_TRIANGLES, [first(e), first(f), -1]),
        Origin::Triangles(t, u, v) => (LAP_VERTEX_TRIANGLES, [t, u, v].map(triangle)),
        Origin::TrianglesPlane(t, u, p) => (LAP_VERTEX_TRIANGLES_PLANE, [triangle(t), triangle(u), p.0 as i32]),
        Origin::Level(i) => (LAP_VERTEX_LEVEL, [level(i), -1, -1]),
    }
}

/// All planes through each vertex, rising (of coincident planes the lowest).
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of vertices; offsets: count + 1; planes: those
/// of vertex v are planes[offsets[v]] up to, not including, planes[offsets[v + 1]].
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_vertex_planes(
    complex: *const lap_complex,
    count: *mut i64,
    offsets: *mut *const i32,
    planes: *mut *const i32,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        unsafe {
            put(count, c.vertex_planes.len() as i64);
            put(offsets, address(&c.vertex_planes.offsets));
            put(planes, address(&c.vertex_planes.items));
        }
        Ok(())
    })
}

/// The edges.
///
/// Outputs (each may be NULL; borrowed as the complex): count; vertices: 2 × count.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_edges(
    complex: *const lap_complex,
    count: *mut i64,
    vertices: *mut *const i32,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        unsafe {
            put(count, c.edge_count() as i64);
            put(vertices, address(&c.edges));
        }
        Ok(())
    })
}

/// The faces with their holes. A face is a set of loops, the outer loop first, then holes; seen with the face's normal
/// up, the outer loop runs anticlockwise and holes run clockwise. A loop is a cyclic run of corners. An edge with the
/// face on both its sides is walked twice; an isolated vertex inside a face is a hole of one corner and no edge.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of faces; face_loops: count + 1, face f has the
/// loops face_loops[f] up to, not including, face_loops[f + 1]; loop_corners: number of loops + 1, loop l has the corners
/// loop_corners[l] up to, not including, loop_corners[l + 1]; corner_vertices: the vertex of each corner; corner_edges:
/// the edge from each corner to the next of its loop (from the last to the first), -1 for an isolated vertex.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_faces(
    complex: *const lap_complex,
    count: *mut i64,
    face_loops: *mut *const i32,
    loop_corners: *mut *const i32,
    corner_vertices: *mut *const i32,
    corner_edges: *mut *const i32,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        unsafe {
            put(count, c.face_count() as i64);
            put(face_loops, address(&c.face_loops));
            put(loop_corners, address(&c.loop_offsets));
            put(corner_vertices, address(&c.corner_vertices));
            put(corner_edges, address(&c.corner_edges));
        }
        Ok(())
    })
}

/// What each face lies on. A face on both a triangle and a plane has the triangle as its support, and the plane as well; a face
/// of a network's complex is a polygon of the network or lies on a triangle of its domain's boundary.
///
/// Outputs (each may be NULL; borrowed as the complex): count; kinds: count numbers LAP_SUPPORT_*; ids: count indices of
/// triangles, planes or polygons, in the caller's numbering; planes: for each face the lowest plane that it lies on, -1 if none;
/// tags: for each face the tag of its triangle, 0 for faces on planes only and without tags. The normal of a face is
/// that of its support: of the triangle, (a, b, c) of the plane, or the polygon's.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: linear at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_face_supports(
    complex: *const lap_complex,
    count: *mut i64,
    kinds: *mut *const i32,
    ids: *mut *const i32,
    planes: *mut *const i32,
    tags: *mut *const i32,
) -> i32 {
    guard(|_| {
        let complex = unsafe { handle(complex) }?;
        let (of_kind, of_id) = complex.supports.get_or_init(|| {
            let number = |support: &SupportId| match *support {
                SupportId::Triangle(t) => (LAP_SUPPORT_TRIANGLE, complex.triangle(t)),
                SupportId::Plane(p) => (LAP_SUPPORT_PLANE, p.0 as i32),
                SupportId::Level(p) => (LAP_SUPPORT_LEVEL, p.0 as i32),
            };
            complex.data.face_support.iter().map(number).unzip()
        });
        unsafe {
            put(count, of_kind.len() as i64);
            put(kinds, address(of_kind));
            put(ids, address(of_id));
            put(planes, address(&complex.data.face_plane));
            put(tags, address(&complex.data.face_tag));
        }
        Ok(())
    })
}

/// The cells on the two sides of each face.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of faces; cells: 2 × count, the owner (behind
/// the face, on the side that its normal points away from), and the neighbour (before it), -1 outside the solid (in the complex of an
/// arrangement that may be either).
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_face_cells(
    complex: *const lap_complex,
    count: *mut i64,
    cells: *mut *const i32,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        unsafe {
            put(count, c.face_count() as i64);
            put(cells, address(&c.face_cells));
        }
        Ok(())
    })
}

/// The cells. A cell is bounded by shells, the outer shell first, then voids; a shell is a closed set of half-faces.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of cells; cell_shells: count + 1, cell c has the
/// shells cell_shells[c] up to, not including, cell_shells[c + 1]; shell_faces: number of shells + 1, shell s has the
/// half-faces half_faces[shell_faces[s]] up to, not including, half_faces[shell_faces[s + 1]]; half_faces: 2 f + side,
/// side 0 where the normal of face f points out of the cell, 1 where it points into it; rising in each shell.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_cells(
    complex: *const lap_complex,
    count: *mut i64,
    cell_shells: *mut *const i32,
    shell_faces: *mut *const i32,
    half_faces: *mut *const i32,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        unsafe {
            put(count, c.cell_count() as i64);
            put(cell_shells, address(&c.cell_shells));
            put(shell_faces, address(&c.shell_faces.offsets));
            put(half_faces, address(&c.shell_faces.items));
        }
        Ok(())
    })
}

/// The component of the input mesh (0 up to lap_mesh_counts' components) that each cell belongs to: that of the surface
/// which encloses it. In the complex of an arrangement cells that are joined across faces have one number, from 0.
///
/// Outputs (each may be NULL; borrowed as the complex): count: the number of cells; components: count.
///
/// Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_cell_components(
    complex: *const lap_complex,
    count: *mut i64,
    components: *mut *const i32,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        unsafe {
            put(count, c.cell_count() as i64);
            put(components, address(&c.cell_component));
        }
        Ok(())
    })
}

/// The side of a plane that a cell is on: side receives 1 where a x + b y + c z + d > 0, -1 where it is < 0.
///
/// cell: from 0; plane: index in the caller's array (any of coincident planes).
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a cell or plane that is not there, or for the complex of an arrangement (planes cut only what is within
/// the bounds of half-spaces, and winding numbers tell where cells are). Threads: any. Cost: one exact sign, and a walk over those vertices of
/// the cell that lie on the plane.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_complex_cell_side(
    complex: *const lap_complex,
    cell: i32,
    plane: i32,
    side: *mut i32,
) -> i32 {
    guard(|_| {
        let c = &unsafe { handle(complex) }?.data;
        if side.is_null() {
            return Err(Status::NullPointer);
        }
        if c.two_sided {
            return Err(Status::BadArgument);
        }
        let cell = CellId::of(index(cell, c.cell_count())?);
        let plane = PlaneId::of(index(plane, c.planes.len())?);
        unsafe { put(side, cell_side(c, cell, plane)?) };
        Ok(())
    })
}

/// A cell is a component of the solid minus all planes, so it lies on one side of each, and any vertex of it that is
/// not on the plane tells which.
fn cell_side(c: &Complex, cell: CellId, plane: PlaneId) -> Result<i32, Status> {
    let support = crate::exact::Support::Plane(c.planes[plane.at()]);
    for half in c.cell_faces(cell) {
        let face: FaceId = half.face();
        for corner in c.face_corners(face) {
            let v = c.corner_vertices[corner];
            let sign = crate::exact::support_side(&support, &c.point(v));
            if !sign.is_zero() {
                return Ok(sign.to_i8().into());
            }
        }
    }
    // All of a cell in one plane: it would have no volume.
    Err(Status::Inconsistent)
}

//! Keys: 128 bits that name a vertex or a face of a complex by the global ids of triangles and planes alone, so that ranks which
//! hold different parts of one mesh match what they share without coordinates or tolerances (DESIGN §11, "Keys").
//!
//! *Elements of the mesh.* A triangle is its global id; an edge or a vertex is the smallest global id among the triangles that
//! contain it, with its place (side or corner, 0 to 2) in that triangle. So the order of a triangle's corners belongs to it,
//! as its id does. *Planes* are their global ids; of coincident planes the smallest id stands for all.
//!
//! *Vertices.* The representative of the vertex (`Origin`) in global ids: a vertex of the mesh; an edge and the smallest plane that
//! crosses it there; a triangle and the first independent pair of the planes there; the first independent triple.
//! A key determines the point, and a point has one key.
//!
//! *Faces.* A face lies on its support S and keeps its boundary on its left. A half-edge (u, v) of the boundary is on a line L of S
//! and has one face of S on its left, so whatever names the half-edge names the face; the key is the smallest name. The
//! face's own plane (on it lies all of the face) is no carrier of edges. Let C be the smallest other plane through both u
//! and v, D the smallest plane through u and not through v; both follow from the two vertices' sets of planes. A name is one of
//!
//! | tag | ids | when |
//! |---|---|---|
//! | `CHORD` | t, C, D or end; direction | S is the triangle t, there is C |
//! | `SIDE` | t and a side of it, D or end | S is the triangle t, there is no C |
//! | `LINE` | S, C, D or the element of the mesh that holds u; direction | S is a plane, there is C |
//! | `EDGE` | S, a mesh edge, D or end; direction | S is a plane, no C, u and v lie on that edge, one of them inside it |
//! | `TRACE` | S, t, D or end; direction | S is a plane, no C, u or v lies inside the triangle t |
//! | `ACROSS` | S, the elements of u and of v | S is a plane, no C, else |
//!
//! *Each name determines the half-edge* (for a complex that is valid; forms have tags of their own):
//! - L: S and C are different planes through u and v, so `CHORD` and `LINE` have L = S ∩ C. Without C the piece lies on the surface
//!   (inside the solid two planes are needed to make an edge): on a triangle, where each chord has a plane that is not the triangle's, it is
//!   a piece of a side; on a plane, a piece of a mesh edge or of a chord t ∩ S.
//! - u by D: that plane contains u and not v, so it meets L in u alone.
//! - u without D: all planes through u contain L. Then u is not inside an edge that contains L, nor inside a triangle whose plane contains
//!   L: planes cut it out there, and one of those does not contain L. So in `LINE` the smallest element of the mesh that holds u
//!   meets L in u alone. In `CHORD`, `SIDE`, `EDGE` and `TRACE`, L meets a triangle or an edge of the mesh in a segment; u is on the
//!   boundary of the triangle, or a vertex, hence that end of the segment from which the direction leads inwards.
//! - `ACROSS`: neither end is inside a triangle. Two mesh vertices are two points. A point inside an edge e, the other one not on e: were e
//!   in S, the triangle in which the chord lies would be in S, or the chord in e. So e meets S in that point alone.
//! - Direction: which of u and v comes first by x, then y, then z, exactly; on a side of a triangle the face is on one side only. A
//!   half-edge is thus its line, its start and its direction. No two half-edges of one face differ in the direction alone: the face
//!   is on one side of C and on one side of D, and no segment has two ends in one place. So the direction is looked at once a face.
//!
//! *Intrinsic.* A vertex's planes and carrier are geometry, and so are S, C, D and the form. Two blocks give a shared vertex or face the same
//! key when both know all triangles that contain the elements which hold its vertices. A block that is given every triangle that meets its
//! closed box does: an element that holds a vertex meets the box there, and so does every triangle that contains the element, edges that
//! lie in the box only in part included. Planes need only be those of the box, the closed box's boundary included.
//!
//! Degenerate cases: an edge in several planes takes the smallest; a hole of one vertex has no half-edge and is skipped; an edge that has the
//! face on both sides offers both half-edges; where the plane that stands for coincident ones faces the other way than the one of the smallest id,
//! loops are read backwards. Complexes of input that intersects itself may be without a name: an error, never a panic.
//! Complexes of networks have no keys: they are not made of planes, and callers do not ask for those of their vertices.
//!
//! Cost: linear in corners and in the sizes of the vertices' plane sets, one exact comparison a face; one walk over the mesh.

use super::data::{Complex, Origin, SupportId, origin_point};
use crate::base::{EdgeId, Error, FaceId, PlaneId, Result, Status, TriangleId, VertexId};
use crate::exact::{Direction, Plane, Sign, compare_coordinate, determinant, side};
use crate::mesh::TriMesh;
use rayon::prelude::*;
use std::cmp::Ordering;

/// 7 bits of tag and three 40-bit ids: the first number is never negative. Keys of vertices and of faces differ in their tags.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Key(pub [i64; 2]);

/// Global ids are below this.
pub const ID_LIMIT: i64 = 1 << 40;

/// What the caller calls its triangles and planes.
#[derive(Clone, Copy, Debug, Default)]
pub struct GlobalIds<'a> {
    /// The global id of each triangle of the mesh; `None`: its position.
    pub triangles: Option<&'a [i64]>,
    /// The global id of each plane of the complex; `None`: its position.
    pub planes: Option<&'a [i64]>,
    /// For each plane the one that stands for it in the complex (the lowest position of those that coincide). `None`: no two
    /// planes coincide. Matters only where global ids do not rise with positions.
    pub plane_map: Option<&'a [PlaneId]>,
}

/// A vertex as keys see it: its carrier, and all planes through it (a slice, or anything that holds one), rising.
#[derive(Clone, Copy, Debug)]
pub struct Corner<S> {
    pub origin: Origin,
    pub planes: S,
}

/// Global names of everything that keys are made of.
pub struct Names<'a> {
    mesh: &'a TriMesh,
    planes: &'a [Plane],
    triangles: Option<&'a [i64]>,
    /// Per mesh vertex: smallest incident global triangle and the corner there, `id << 2 | corner`.
    vertices: Vec<u64>,
    /// Per plane: smallest global id of those that coincide with it, and whether that one faces the other way; empty where
    /// names are positions.
    plane_names: Vec<(u64, bool)>,
    /// Names rise with positions, so the lowest position has the smallest name.
    rising: bool,
}

// Tags of vertices. A corner or a side is added to the first two.
const CORNER: u32 = 0;
const ON_SIDE: u32 = 3;
const INSIDE: u32 = 6;
const MEET: u32 = 7;
// Tags of faces. The direction is bit 0 of what is added; "by its end" instead of a plane D is worth 2.
const CHORD: u32 = 8;
const TRACE: u32 = 12;
/// Eight kinds of start, by 2.
const LINE: u32 = 16;
/// Three sides, by 4.
const EDGE: u32 = 32;
/// Three sides, by 4 (no direction).
const SIDE: u32 = 44;
/// Six kinds of element at u, by 6, and six at v.
const ACROSS: u32 = 56;
/// Added to `LINE`: the start is a plane (after the kinds of mesh elements: three corners, three sides, a triangle).
const BY_PLANE: u32 = 7;
const BY_END: u32 = 2;
// Vertices made of triangles and edges, three sides each, and what planes add.
const PIERCED: u32 = 96;
const CROSSED: u32 = 100;
const THREE: u32 = 110;
/// And a plane.
const TWO: u32 = 111;

/// A tag below 128 and three ids.
#[inline(always)]
pub fn pack(tag: u32, a: u64, b: u64, c: u64) -> u128 {
    debug_assert!(tag < 128 && a < 1 << 40 && b < 1 << 40 && c < 1 << 40);
    (tag as u128) << 120 | (a as u128) << 80 | (b as u128) << 40 | c as u128
}

#[inline(always)]
pub fn key(packed: u128) -> Key {
    Key([(packed >> 64) as i64, packed as i64])
}

/// Global ids as they come from a caller: as many as elements, each in 0..2⁴⁰, none twice. `what` names the elements.
/// Cost: linear if the ids rise, else a sort.
pub fn check_ids(ids: &[i64], count: usize, what: &str) -> Result<()> {
    let bad = |message: String| Err(Error::new(Status::BadArgument, message));
    if ids.len() != count {
        return bad(format!("{} ids for {count} {what}s", ids.len()));
    }
    if let Some(i) = ids.iter().position(|id| !(0..ID_LIMIT).contains(id)) {
        return bad(format!("the id of {what} {i}, {}, is not in 0..2^40", ids[i]));
    }
    if ids.windows(2).all(|w| w[0] < w[1]) {
        return Ok(());
    }
    let mut order: Vec<u32> = (0..ids.len() as u32).collect();
    order.par_sort_unstable_by_key(|&i| (ids[i as usize], i));
    match order.windows(2).find(|w| ids[w[0] as usize] == ids[w[1] as usize]) {
        None => Ok(()),
        Some(w) => bad(format!("{what}s {} and {} have the same id, {}", w[0], w[1], ids[w[0] as usize])),
    }
}

/// Prepares the names of a mesh and planes. Errors: ids that are not as [`check_ids`] wants them. Cost: linear in the mesh.
pub fn names<'a>(mesh: &'a TriMesh, planes: &'a [Plane], ids: &GlobalIds<'a>) -> Result<Names<'a>> {
    if let Some(of) = ids.triangles {
        check_ids(of, mesh.triangles.len(), "triangle")?;
    }
    if let Some(of) = ids.planes {
        check_ids(of, planes.len(), "plane")?;
    }
    let mut vertices = vec![u64::MAX; mesh.vertices.len()];
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let id = ids.triangles.map_or(t as u64, |of| of[t] as u64);
        for (k, v) in corners.iter().enumerate() {
            let slot = &mut vertices[v.at()];
            *slot = (*slot).min(id << 2 | k as u64);
        }
    }
    let plane_names = ids.planes.map_or(Vec::new(), |of| plane_names(planes, of, ids.plane_map));
    let rising = plane_names.windows(2).all(|w| w[0].0 <= w[1].0);
    Ok(Names { mesh, planes, triangles: ids.triangles, vertices, plane_names, rising })
}

fn plane_names(planes: &[Plane], ids: &[i64], map: Option<&[PlaneId]>) -> Vec<(u64, bool)> {
    let own = |i: usize| (ids[i] as u64, false);
    let Some(map) = map else { return (0..ids.len()).map(own).collect() };
    // Collected at the representatives, then handed to all.
    let mut smallest: Vec<usize> = (0..ids.len()).collect();
    for (i, stands) in map.iter().enumerate() {
        let slot = &mut smallest[stands.at()];
        if ids[i] < ids[*slot] {
            *slot = i;
        }
    }
    let name = |(i, stands): (usize, &PlaneId)| {
        let least = smallest[stands.at()];
        // Coincident planes have parallel normals, so any component that is not zero tells whether they agree.
        let axis = (0..3).find(|&a| planes[i].n[a] != 0.0).unwrap_or(0);
        (ids[least] as u64, Sign::of(planes[i].n[axis]) != Sign::of(planes[least].n[axis]))
    };
    map.iter().enumerate().map(name).collect()
}

impl Names<'_> {
    #[inline(always)]
    pub fn plane(&self, p: PlaneId) -> u64 {
        if self.plane_names.is_empty() { p.0 as u64 } else { self.plane_names[p.at()].0 }
    }

    fn reversed(&self, p: PlaneId) -> bool {
        !self.plane_names.is_empty() && self.plane_names[p.at()].1
    }

    #[inline(always)]
    pub fn triangle(&self, t: TriangleId) -> u64 {
        self.triangles.map_or(t.0 as u64, |ids| ids[t.at()] as u64)
    }

    /// Smallest global triangle at a vertex, and the corner there.
    #[inline(always)]
    pub fn vertex(&self, v: VertexId) -> (u64, u32) {
        let name = self.vertices[v.at()];
        (name >> 2, (name & 3) as u32)
    }

    /// Smallest global triangle at an edge, and the side there.
    #[inline(always)]
    fn edge(&self, e: EdgeId) -> (u64, u32) {
        let uses = self.mesh.edge_uses.row(e);
        let names = uses.iter().map(|u| (self.triangle(u.triangle), u.side() as u32));
        names.min().unwrap_or((0, 0))
    }

    /// The smallest mesh element that holds a vertex: its id, and its kind as in the tags of vertices. `None` for a point
    /// inside the solid.
    #[inline(always)]
    fn element(&self, origin: Origin) -> Option<(u64, u32)> {
        match origin {
            Origin::Mesh(v) => Some(self.vertex(v)).map(|(id, k)| (id, CORNER + k)),
            Origin::Edge(e, _) => Some(self.edge(e)).map(|(id, k)| (id, ON_SIDE + k)),
            Origin::Triangle(t, _, _) => Some((self.triangle(t), INSIDE)),
            Origin::EdgeTriangle(e, _) | Origin::Edges(e, _) => Some(self.edge(e)).map(|(id, k)| (id, ON_SIDE + k)),
            Origin::Triangles(t, ..) | Origin::TrianglesPlane(t, ..) => Some((self.triangle(t), INSIDE)),
            Origin::Planes(..) | Origin::Level(_) => None,
        }
    }
}

/// The key of a vertex. `planes`: all planes through it, rising; read only where global ids do not rise with positions.
pub fn vertex_key<S: AsRef<[PlaneId]>>(names: &Names, vertex: &Corner<S>) -> Key {
    if !names.rising {
        return reordered_vertex_key(names, vertex.origin, vertex.planes.as_ref());
    }
    let plane = |p| names.plane(p);
    key(match vertex.origin {
        Origin::Mesh(v) => mesh_vertex(names, v),
        Origin::Edge(e, p) => {
            let (id, side) = names.edge(e);
            pack(ON_SIDE + side, id, plane(p), 0)
        }
        Origin::Triangle(t, p, q) => pack(INSIDE, names.triangle(t), plane(p), plane(q)),
        Origin::Planes(p, q, r) => pack(MEET, plane(p), plane(q), plane(r)),
        other => of_triangles(names, other),
    })
}

/// A vertex that is made of triangles and edges alone: of edges the lower name first, of triangles rising names.
fn of_triangles(names: &Names, origin: Origin) -> u128 {
    match origin {
        Origin::EdgeTriangle(e, t) => {
            let (id, side) = names.edge(e);
            pack(PIERCED + side, id, names.triangle(t), 0)
        }
        Origin::Edges(e, f) => {
            let (a, b) = (names.edge(e), names.edge(f));
            let ((a, of_a), (b, of_b)) = (a.min(b), a.max(b));
            pack(CROSSED + 3 * of_a + of_b, a, b, 0)
        }
        Origin::Triangles(t, u, v) => {
            let mut ids = [t, u, v].map(|t| names.triangle(t));
            ids.sort_unstable();
            pack(THREE, ids[0], ids[1], ids[2])
        }
        Origin::TrianglesPlane(t, u, p) => {
            let (t, u) = (names.triangle(t), names.triangle(u));
            pack(TWO, t.min(u), t.max(u), names.plane(p))
        }
        Origin::Mesh(_) | Origin::Edge(..) | Origin::Triangle(..) | Origin::Planes(..) => {
            unreachable!("the caller's match has those with planes")
        }
        Origin::Level(_) => unreachable!("complexes with levels have no keys"),
    }
}

fn mesh_vertex(names: &Names, v: VertexId) -> u128 {
    let (id, corner) = names.vertex(v);
    pack(CORNER + corner, id, 0, 0)
}

/// An origin's planes are the first by position; here the first by name are looked for, greedily (a first basis of a
/// matroid is found by taking whatever is independent of what was taken).
fn reordered_vertex_key(names: &Names, origin: Origin, planes: &[PlaneId]) -> Key {
    let mesh = names.mesh;
    let mut sorted: Vec<PlaneId> = planes.to_vec();
    sorted.sort_unstable_by_key(|&p| names.plane(p));
    let plane = |p: PlaneId| &names.planes[p.at()];
    let normal = |p: PlaneId| Direction::Plane(plane(p).n);
    let name = |p: Option<PlaneId>, fallback: PlaneId| names.plane(p.unwrap_or(fallback));
    key(match origin {
        Origin::Mesh(v) => mesh_vertex(names, v),
        Origin::Edge(e, p) => {
            // All of these planes meet the edge here: they contain its end if they contain all of it.
            let end = &mesh.vertices[mesh.edges[e.at()][0].at()];
            let crossing = sorted.iter().copied().find(|&p| !side(plane(p), end).is_zero());
            let (id, k) = names.edge(e);
            pack(ON_SIDE + k, id, name(crossing, p), 0)
        }
        Origin::Triangle(t, p, q) => {
            let corners = mesh.corners(t);
            let whole = |p: PlaneId| corners.iter().all(|x| side(plane(p), x).is_zero());
            sorted.retain(|&p| !whole(p));
            let first = sorted.first().copied();
            let independent = |&&q: &&PlaneId| {
                first.is_some_and(|p| {
                    p != q && !determinant(&Direction::Triangle(corners), &normal(p), &normal(q)).is_zero()
                })
            };
            let second = sorted.iter().find(independent).copied();
            pack(INSIDE, names.triangle(t), name(first, p), name(second, q))
        }
        Origin::Planes(p, q, r) => {
            // Two planes through one point that are not coincident are independent.
            let (first, second) = (sorted.first().copied(), sorted.get(1).copied());
            let third = sorted.iter().copied().skip(2).find(|&r| {
                let [p, q] = [first, second].map(|p| normal(p.unwrap_or(r)));
                !determinant(&p, &q, &normal(r)).is_zero()
            });
            pack(MEET, name(first, p), name(second, q), name(third, r))
        }
        other => of_triangles(names, other),
    })
}

/// The smallest plane through both vertices but `own`, and the smallest through the first and not through the second.
#[inline]
fn carriers(names: &Names, u: &[PlaneId], v: &[PlaneId], own: PlaneId) -> (Option<u64>, Option<u64>) {
    let (mut both, mut first) = (None, None);
    let mut j = 0;
    for &p in u {
        while j < v.len() && v[j] < p {
            j += 1;
        }
        let slot = if v.get(j) == Some(&p) {
            if p == own {
                continue;
            }
            &mut both
        } else {
            &mut first
        };
        let name = names.plane(p);
        if slot.is_none_or(|least| name < least) {
            *slot = Some(name);
        }
    }
    (both, first)
}

/// What the names of a face's half-edges have in common.
struct Face {
    support: SupportId,
    /// The plane on which the face lies, or `NONE`.
    own: PlaneId,
}

/// The name of a half-edge, and whether its direction has to be added to its tag. `None` if there is no name (input that
/// intersects itself).
fn half_edge<S: AsRef<[PlaneId]>>(names: &Names, face: &Face, u: &Corner<S>, v: &Corner<S>) -> Option<(u128, bool)> {
    let (c, d) = carriers(names, u.planes.as_ref(), v.planes.as_ref(), face.own);
    let (start, by_end) = (d.unwrap_or(0), if d.is_some() { 0 } else { BY_END });
    match (face.support, c) {
        (SupportId::Level(_), _) => None,
        (SupportId::Triangle(t), Some(c)) => Some((pack(CHORD + by_end, names.triangle(t), c, start), true)),
        (SupportId::Triangle(t), None) => {
            let side = side_of(names.mesh, t, u.origin, v.origin)?;
            Some((pack(SIDE + 4 * side + by_end, names.triangle(t), 0, start), false))
        }
        (SupportId::Plane(p), Some(c)) => {
            let (start, kind) = match d {
                Some(plane) => (plane, BY_PLANE),
                None => names.element(u.origin)?,
            };
            Some((pack(LINE + 2 * kind, names.plane(p), c, start), true))
        }
        (SupportId::Plane(p), None) => {
            let p = names.plane(p);
            if let Some(e) = common_edge(names.mesh, u.origin, v.origin) {
                let (id, side) = names.edge(e);
                return Some((pack(EDGE + 4 * side + by_end, p, id, start), true));
            }
            if let (Origin::Triangle(t, ..), _) | (_, Origin::Triangle(t, ..)) = (u.origin, v.origin) {
                return Some((pack(TRACE + by_end, p, names.triangle(t), start), true));
            }
            let ((a, of_u), (b, of_v)) = (names.element(u.origin)?, names.element(v.origin)?);
            Some((pack(ACROSS + 6 * of_u + of_v, p, a, b), false))
        }
    }
}

/// The edge that holds both vertices, if one of them is inside it.
#[inline]
fn common_edge(mesh: &TriMesh, u: Origin, v: Origin) -> Option<EdgeId> {
    match (u, v) {
        (Origin::Edge(e, _), Origin::Edge(f, _)) => (e == f).then_some(e),
        (Origin::Edge(e, _), Origin::Mesh(w)) | (Origin::Mesh(w), Origin::Edge(e, _)) => {
            mesh.edges[e.at()].contains(&w).then_some(e)
        }
        _ => None,
    }
}

/// The side of a triangle that holds both vertices.
fn side_of(mesh: &TriMesh, t: TriangleId, u: Origin, v: Origin) -> Option<u32> {
    let (corners, edges) = (&mesh.triangles[t.at()], &mesh.triangle_edges[t.at()]);
    let holds = |origin: Origin, k: usize| match origin {
        Origin::Mesh(w) => corners[k] == w || corners[(k + 1) % 3] == w,
        Origin::Edge(e, _) => edges[k] == e,
        _ => false,
    };
    (0..3).find(|&k| holds(u, k) && holds(v, k)).map(|k| k as u32)
}

/// The plane that holds a whole face: the one through all its vertices. There is one at most, for coincident planes go by one
/// id. Cost: most often the first vertices tell that there is none.
fn plane_of<S: AsRef<[PlaneId]>>(vertices: &[VertexId], corner: &impl Fn(VertexId) -> Corner<S>) -> PlaneId {
    let [first, rest @ ..] = vertices else { return PlaneId::NONE };
    let holds = |v: &VertexId, p: &PlaneId| corner(*v).planes.as_ref().contains(p);
    let whole = |p: &&PlaneId| rest.iter().all(|v| holds(v, p));
    corner(*first).planes.as_ref().iter().find(whole).copied().unwrap_or(PlaneId::NONE)
}

/// The key of a face.
///
/// `support`: of a face on both a triangle and a plane, the triangle. `loops`: its vertices in order with the face on the left, seen with
/// the support's normal up, read through `corner`; the outer loop first, then all holes or, for every face, none (the key differs).
/// `None` only for complexes of input that intersects itself.
pub fn face_key<'a, S: AsRef<[PlaneId]>>(
    names: &Names,
    support: SupportId,
    loops: impl Iterator<Item = &'a [VertexId]> + Clone,
    corner: impl Fn(VertexId) -> Corner<S>,
) -> Option<Key> {
    let (own, backwards) = match support {
        SupportId::Plane(p) => (p, names.reversed(p)),
        SupportId::Level(_) => return None,
        SupportId::Triangle(_) => (plane_of(loops.clone().next()?, &corner), false),
    };
    let face = Face { support, own };
    let (mut least, mut directed) = (u128::MAX, false);
    let mut ends: Option<[Origin; 2]> = None;
    for vertices in loops.filter(|l| l.len() > 1) {
        let mut from = corner(vertices[vertices.len() - 1]);
        for &v in vertices {
            let to = corner(v);
            let (u, v) = if backwards { (&to, &from) } else { (&from, &to) };
            let (name, has_direction) = half_edge(names, &face, u, v)?;
            if name < least {
                (least, directed, ends) = (name, has_direction, Some([u.origin, v.origin]));
            }
            from = to;
        }
    }
    let [u, v] = ends?;
    let falls = directed && !comes_first(names, u, v);
    Some(key(least | (falls as u128) << 120))
}

/// Whether u comes before v by x, then y, then z.
fn comes_first(names: &Names, u: Origin, v: Origin) -> bool {
    let [u, v] = [u, v].map(|origin| origin_point(names.mesh, names.planes, origin));
    let order = (0..3).map(|axis| compare_coordinate(&u, &v, axis)).find(|o| o.is_ne());
    order.unwrap_or(Ordering::Equal).is_lt()
}

/// The keys of all vertices. `names`: of the complex's mesh and planes. Cost: linear.
pub fn vertex_keys(c: &Complex, names: &Names) -> Vec<Key> {
    let of = |v: usize| vertex_key(names, &corner_of(c, VertexId::of(v)));
    (0..c.vertex_count()).into_par_iter().with_min_len(1024).map(of).collect()
}

/// The keys of all faces. `names`: of the complex's mesh and planes. Cost: linear.
/// Errors: `Status::Inconsistent` for a face without a name (input that intersects itself).
pub fn face_keys(c: &Complex, names: &Names) -> Result<Vec<Key>> {
    let of = |f: usize| {
        let loops = c.loops_of(FaceId::of(f)).map(|l| &c.corner_vertices[c.corners_of(l)]);
        face_key(names, c.face_support[f], loops, |v| corner_of(c, v))
            .ok_or_else(|| Error::inconsistent(format!("the boundary of face {f} lies on no element of the input")))
    };
    (0..c.face_count()).into_par_iter().with_min_len(1024).map(of).collect()
}

#[inline(always)]
fn corner_of(c: &Complex, v: VertexId) -> Corner<&[PlaneId]> {
    Corner { origin: c.origins[v.at()], planes: c.vertex_planes.row(v) }
}

//! Keys of faces of complexes that are made of an arrangement's cells ([`super::solids`]): 128 bits from the global ids of triangles and planes
//! alone, as [`crate::complex::keys`] has them for cuts.
//!
//! An *element* is a triangle of an operand or the sheet of a half-space, by its global name; triangles come before sheets. Of what a triangle is, only that
//! part matters that faces are born of (of a side of the box: what is in its half-space): elements are convex and flat. The elements through
//! a vertex are the births of the faces around it: faces are resolved, so an element that holds a vertex is cut up there. Faces that divide nothing
//! count as well. An element that holds both ends of an edge holds the edge.
//!
//! *Names.* A face lies on its first birth T. A half-edge u → v of its boundary, the face on the left seen with T's normal up, is on a line L: that of T and
//! of C, the first element through u and v that is not in T's plane; or, where all of them are in that plane, that of the first side of one on
//! which u and v are. D is the first element that holds one of u and v (u if there is one) and not the other. The name is T, L, D, which of the two D holds,
//! and whether u comes before v by x, y, z; the key is the smallest name of the face's half-edges.
//!
//! *Each name determines the face.* All elements at an edge are in one plane only if births change there, so one of them ends there: there is always
//! an L. D and L have an interval in common, in which say u is and v is not. It ends at u: an end q beyond u would be inside the edge, and
//! D cut up there together with T. So u is the last point of D on L in the direction of v, v is the next vertex, and one face is on the left.
//!
//! *Faces without such a half-edge*: then the same elements hold every vertex of the outer loop, so they hold the face, are in its plane, and all of them
//! are its births. At each side one of them ends (births change, and nothing is across): the face is what they have in common. What
//! names one corner names the elements there and so the face: a corner of an input triangle (the smallest name), or two sides that cross there (the
//! first, and the first that is not on the same line). Such faces are flat parts of a surface on which other operands, or folds that cancel, lie exactly.
//!
//! *Intrinsic.* Births, elements through vertices and exact order are geometry of the operands: the order of operands and of triangles does not matter where
//! global ids are carried along, nor do coincident triangles; and faces with the same boundary in two complexes of one arrangement have the same key. Another
//! operand changes keys where it meets what it does not divide: elements through a vertex are more then, and others may come first. So keys
//! are matched between arrangements of the same operands, not between parts.
//!
//! Cost: linear in faces and their births, with a sort of the elements through each vertex.

use super::{Arrangement, Resolved};
use crate::base::{Csr, Error, FaceId, Result, TriangleId, VertexId};
use crate::complex::keys::{Key, Names, key, pack};
use crate::complex::{Complex, Origin};
use crate::exact::{self, Point};
use crate::mesh::projection::seen_along;
use rayon::prelude::*;

// Tags, none of which a vertex has. Added: 1 if T is a sheet, then bits as they are listed.
/// C is a sheet, D is one, D holds the end, direction.
const LINE: u32 = 8;
/// D is a sheet, D holds the end, direction, and 16 times the side.
const SIDE: u32 = 40;
/// A corner.
const WHOLE: u32 = 88;
/// Three times a side, and another side.
const CROSSING: u32 = 112;

/// By global name, sheets after triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Element {
    /// The sheets' bit, above 40 bits of id.
    name: u64,
    triangle: TriangleId,
}

impl Element {
    fn id(self) -> u64 {
        self.name & ((1 << 40) - 1)
    }

    fn is_sheet(self) -> u32 {
        (self.name >> 40) as u32
    }
}

/// Where the faces of a complex lie.
struct Keys<'a> {
    r: &'a Resolved,
    c: &'a Complex,
    /// The vertex of the arrangement that each vertex is.
    vertices: &'a [VertexId],
    names: &'a Names<'a>,
    /// Elements through each vertex of the complex, rising.
    through: Csr<Element>,
}

/// The keys of all faces. `vertices`, `faces`: of the arrangement, for each vertex and each face of the complex; `names`: of its mesh and planes.
///
/// Errors: `Inconsistent` for a face without a name (a fault of the library).
pub fn face_keys(
    a: &Arrangement,
    c: &Complex,
    vertices: &[VertexId],
    faces: &Csr<FaceId>,
    names: &Names,
) -> Result<Vec<Key>> {
    let r = &a.resolved;
    let keys = Keys { r, c, vertices, names, through: elements_through(r, vertices, names) };
    let of = |f: usize| {
        let name = keys.face(FaceId::of(f), faces.row(f)[0]);
        name.map(key).ok_or_else(|| Error::inconsistent(format!("no edge of face {f} has a name")))
    };
    (0..c.face_count()).into_par_iter().with_min_len(1 << 8).map(of).collect()
}

fn element(r: &Resolved, names: &Names, triangle: TriangleId) -> Element {
    let name = match r.soup.sheet(triangle) {
        Some(p) => 1 << 40 | names.plane(p),
        None => names.triangle(triangle),
    };
    Element { name, triangle }
}

fn elements_through(r: &Resolved, vertices: &[VertexId], names: &Names) -> Csr<Element> {
    let mut number = vec![VertexId::NONE; r.vertex_count()];
    vertices.iter().enumerate().for_each(|(i, v)| number[v.at()] = VertexId::of(i));
    let mut pairs = Vec::new();
    for (f, corners) in r.faces.iter().enumerate() {
        for b in r.births_of(FaceId::of(f)) {
            let e = element(r, names, b.triangle);
            pairs.extend(corners.map(|v| number[v.at()]).into_iter().filter(|v| v.is_some()).map(|v| (v.at(), e)));
        }
    }
    pairs.par_sort_unstable();
    pairs.dedup();
    Csr::from_pairs(vertices.len(), pairs.into_iter())
}

impl Keys<'_> {
    /// The key of a face, `part` one of those that it consists of.
    fn face(&self, f: FaceId, part: FaceId) -> Option<u128> {
        let first = self.r.births_of(part).map(|b| (element(self.r, self.names, b.triangle), b.same)).min()?;
        let loops = || self.c.loops_of(f).map(|l| &self.c.corner_vertices[self.c.corners_of(l)]);
        let mut least = None;
        for corners in loops().filter(|l| l.len() > 1) {
            for (i, &u) in corners.iter().enumerate() {
                let v = corners[(i + 1) % corners.len()];
                let name = if first.1 { self.half_edge(first.0, u, v) } else { self.half_edge(first.0, v, u) };
                least = least.into_iter().chain(name?).min();
            }
        }
        least.or_else(|| loops().next()?.iter().filter_map(|v| self.corner(*v)).min())
    }

    /// `Some(None)` if the same elements hold both ends.
    fn half_edge(&self, t: Element, u: VertexId, v: VertexId) -> Option<Option<u128>> {
        let (of_u, of_v) = (self.through.row(u.at()), self.through.row(v.at()));
        let in_one = |a: &[Element], b: &[Element]| a.iter().copied().find(|e| b.binary_search(e).is_err());
        let (d, end) = match (in_one(of_u, of_v), in_one(of_v, of_u)) {
            (Some(d), _) => (d, 0),
            (None, Some(d)) => (d, 1),
            (None, None) => return Some(None),
        };
        let both = || of_u.iter().copied().filter(|e| of_v.binary_search(e).is_ok());
        let bits = d.is_sheet() | end << 1 | self.rises(u, v) << 2;
        if let Some(c) = both().find(|c| !self.coplanar(t.triangle, c.triangle)) {
            let tag = LINE + (t.is_sheet() | c.is_sheet() << 1 | bits << 2);
            return Some(Some(pack(tag, t.id(), c.id(), d.id())));
        }
        let side = |c: Element| (0..3).find(|&k| self.on_side(c, k, u) && self.on_side(c, k, v)).map(|k| (c, k));
        let (c, k) = both().find_map(side)?;
        Some(Some(pack(SIDE + (t.is_sheet() | bits << 1) + 16 * k as u32, t.id(), c.id(), d.id())))
    }

    /// A corner of a face that is all that its births have in common.
    fn corner(&self, v: VertexId) -> Option<u128> {
        if let Origin::Mesh(w) = self.c.origins[v.at()] {
            let (id, corner) = self.names.vertex(w);
            return Some(pack(WHOLE + corner, id, 0, 0));
        }
        let on = |e: Element| (0..3).filter(move |&k| self.on_side(e, k, v)).map(move |k| (e, k));
        let mut sides = self.through.row(v.at()).iter().flat_map(|e| on(*e));
        let (b, k) = sides.next()?;
        let ends = |(e, k): (Element, usize)| {
            let corners = self.r.soup.mesh.corners(e.triangle);
            [corners[k], corners[(k + 1) % 3]].map(Point::Vertex)
        };
        let other = |s: &(Element, usize)| ends(*s).iter().any(|x| !self.is_on(b, k, x));
        let (c, l) = sides.find(other)?;
        Some(pack(CROSSING + (3 * k + l) as u32, b.id(), c.id(), 0))
    }

    /// 1 if u comes before v by x, then y, then z.
    fn rises(&self, u: VertexId, v: VertexId) -> u32 {
        let (x, y) = (self.c.coords[u.at()], self.c.coords[v.at()]);
        let point = |v: VertexId| self.r.point(self.vertices[v.at()]);
        let order = |axis: usize| exact::compare_rounded(x[axis], y[axis], || point(u), || point(v), axis);
        (0..3).map(order).find(|o| o.is_ne()).is_some_and(|o| o.is_lt()) as u32
    }

    fn coplanar(&self, a: TriangleId, b: TriangleId) -> bool {
        let soup = &self.r.soup;
        let (corners, support) = match (soup.sheet(a), soup.sheet(b)) {
            (Some(p), Some(q)) => return soup.half_spaces.stands[p.at()] == soup.half_spaces.stands[q.at()],
            (None, _) => (soup.mesh.corners(a), soup.support(b)),
            (Some(_), None) => (soup.mesh.corners(b), soup.support(a)),
        };
        a == b || corners.iter().all(|x| exact::support_side(&support, &Point::Vertex(*x)).is_zero())
    }

    /// Whether a vertex in an element's plane is on the line of one of its sides. Sheets have none.
    fn on_side(&self, e: Element, k: usize, v: VertexId) -> bool {
        e.is_sheet() == 0 && self.is_on(e, k, &self.r.point(self.vertices[v.at()]))
    }

    fn is_on(&self, e: Element, k: usize, x: &Point) -> bool {
        let corners = self.r.soup.mesh.corners(e.triangle);
        let (axis, _) = self.r.soup.open_axis(e.triangle);
        let (i, j) = seen_along(axis);
        let [a, b] = [corners[k], corners[(k + 1) % 3]].map(Point::Vertex);
        exact::turn_projected(&a, &b, x, i, j).is_zero()
    }
}

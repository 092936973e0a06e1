//! Cells of an arrangement as cells of a complex, like those that planes cut: with shells, moments, face styles, exact coordinates.
//!
//! Cells are first gathered in regions: each cell is one of its own, or those that a selection takes are joined where they share a face. Faces between two
//! regions, or a region and the outside, are kept. Parts of one triangle with the same births become one face where an edge has no other faces: such an
//! edge is one of the triangulation alone. So faces do not depend on how their triangles were triangulated; they have holes, slits where an edge has the face on
//! both sides, and isolated vertices where something else touches them.
//!
//! A loop is an orbit: from a side of a part to its next one, across the inner edges that come between. The outer loop has the least vertex of the face
//! (by x, then y, then z: it is a corner of the convex hull). Shells come from the radial order around all edges ([`crate::complex::shells`]); those of the outside
//! are left out, and each of the others belongs to the region of its half-faces.
//!
//! Invariant: regions are connected across faces, so each has one outer shell. Faces are by their lowest part, vertices by id.
//!
//! Degenerate cases: faces that divide nothing are not there, and vertices that only they have neither; a face may have no cell behind it (input
//! that faces inward).
//!
//! Cost: linear in the faces kept, sorts of edges, a radial sort around each edge with more than two faces.

use super::planar::quick_side;
use super::{Arrangement, Birth, Resolved};
use crate::base::{
    CellId, ComponentId, Csr, Error, FaceId, LoopId, PlaneId, Result, Run, ShellId, Status, TriangleId, UnionFind,
    VertexId,
};
use crate::complex::loops::find_edges;
use crate::complex::shells::{Joined, Shells, fill_cells, find_shells, outer_shells};
use crate::complex::{Complex, HalfFace, SupportId};
use crate::exact::{self, Support};
use crate::mesh::edges::{EdgeTable, edge_table};
use rayon::prelude::*;
use std::cmp::Ordering;

/// Cells of an arrangement as a complex, and what there its elements are.
#[derive(Clone, Debug, Default)]
pub struct Solids {
    pub complex: Complex,
    /// The vertex of the arrangement that each vertex is, rising.
    pub vertices: Vec<VertexId>,
    /// The faces of the arrangement that make up each face, rising.
    pub faces: Csr<FaceId>,
}

/// Each bounded cell as a region: cell `c` of the arrangement is cell `c - 1`.
pub fn every_cell(a: &Arrangement) -> Vec<CellId> {
    (0..a.cell_count()).map(|c| if c == 0 { CellId::NONE } else { CellId::of(c - 1) }).collect()
}

/// Cells that are inside (one entry for each; the unbounded one false) joined where they share a face, numbered by their lowest.
pub fn joined_cells(a: &Arrangement, inside: &[bool]) -> Vec<CellId> {
    let mut sets = UnionFind::new(a.cell_count());
    for &face in &a.cells.patch_face {
        let [b, f] = a.face_cells(face).map(|c| c.at());
        if inside[b] && inside[f] {
            sets.union(b, f);
        }
    }
    let mut number = vec![CellId::NONE; a.cell_count()];
    let mut next = 0;
    for c in (0..a.cell_count()).filter(|&c| inside[c]) {
        let lowest = sets.find(c);
        if number[lowest].is_none() {
            number[lowest] = CellId::of(next);
            next += 1;
        }
        number[c] = number[lowest];
    }
    number
}

/// Makes a complex of regions: the one of each cell, `NONE` for those outside, the unbounded one among them; numbered without gaps.
///
/// Errors: `BadArgument` for a table of another length; `TooLarge`; `Cancelled`; `Inconsistent` if shells and cells contradict one another (a fault of
/// the library).
pub fn solids(a: &Arrangement, region: &[CellId], run: &mut Run) -> Result<Solids> {
    if region.len() != a.cell_count() || region.first().is_some_and(|r| r.is_some()) {
        let message = "a table of regions with one entry for each cell is wanted, none for the unbounded one";
        return Err(Error::new(Status::BadArgument, message));
    }
    run.stage("faces", 0.0)?;
    let r = &a.resolved;
    let of = |f: FaceId| a.face_cells(f).map(|c| if c.is_none() { CellId::NONE } else { region[c.at()] });
    let differ = |f: &FaceId| {
        let [b, f] = of(*f);
        b != f
    };
    let kept: Vec<FaceId> = (0..r.faces.len()).map(FaceId::of).filter(differ).collect();
    let parts = Parts::new(r, &kept);
    let faces = parts.rows();
    run.tick("faces", 0.2)?;
    let planes = r.soup.planes().to_vec();
    let mut c = Complex { mesh: r.soup.mesh.clone(), planes, two_sided: true, ..Complex::default() };
    let vertices = fill_faces(&mut c, r, &parts, &faces);
    c.face_support = (0..faces.len()).map(|f| parts.support_id(faces.row(f)[0])).collect();
    c.face_tag = vec![0; faces.len()];
    c.coords = vertices.iter().map(|v| r.coords(*v)).collect();
    c.origins = vertices.iter().map(|v| r.origin(*v)).collect();
    c.vertex_planes = planes_through(r, &vertices);
    c.face_plane = (0..faces.len()).map(|f| plane_of(&c, FaceId::of(f))).collect();
    (c.edges, c.corner_edges) = find_edges(&c.loop_offsets, &c.corner_vertices);
    if 2 * faces.len() > i32::MAX as usize || c.corner_vertices.len() > i32::MAX as usize {
        return Err(Error::new(Status::TooLarge, "the cells have more elements than 32-bit indices can number"));
    }
    run.stage("shells", 0.5)?;
    let all = find_shells(&c, &Joined::nothing(&c), || |_| None)?;
    let side = |h: HalfFace| of(kept[faces.row(h.face())[0] as usize])[h.front() as usize];
    let (shells, cell_of) = bounded_shells(&all, side)?;
    let cells = region.iter().filter(|r| r.is_some()).map(|r| r.at() + 1).max().unwrap_or(0);
    let outer = outer_shells(&c, &shells, &cell_of, cells)?;
    fill_cells(&mut c, &shells, cells, &cell_of, |s| outer[cell_of[s.at()].at()] == s);
    let mut bodies = UnionFind::new(cells);
    for [b, f] in c.face_cells.iter().filter(|s| s[0].is_some() && s[1].is_some()) {
        bodies.union(b.at(), f.at());
    }
    c.cell_component = bodies.labels().0.into_iter().map(ComponentId).collect();
    run.end_stage();
    let faces = Csr { offsets: faces.offsets, items: faces.items.into_iter().map(|i| kept[i as usize]).collect() };
    Ok(Solids { complex: c, vertices, faces })
}

/// The faces that are kept, by place in the list, with their edges.
struct Parts<'a> {
    r: &'a Resolved,
    kept: &'a [FaceId],
    table: EdgeTable,
}

impl<'a> Parts<'a> {
    fn new(r: &'a Resolved, kept: &'a [FaceId]) -> Self {
        let triangles: Vec<[VertexId; 3]> = kept.iter().map(|f| r.faces[f.at()]).collect();
        Self { r, kept, table: edge_table(r.vertex_count(), &triangles) }
    }

    fn corners(&self, i: u32) -> [VertexId; 3] {
        self.r.faces[self.kept[i as usize].at()]
    }

    fn support(&self, i: u32) -> TriangleId {
        self.r.support[self.kept[i as usize].at()]
    }

    /// Of the lowest of coincident planes, or a triangle.
    fn support_id(&self, i: u32) -> SupportId {
        let (soup, t) = (&self.r.soup, self.support(i));
        soup.sheet(t).map_or(SupportId::Triangle(t), |p| SupportId::Plane(soup.half_spaces.stands[p.at()]))
    }

    /// The part across a side, and its side, where both are one face.
    fn across(&self, i: u32, k: usize) -> Option<(u32, usize)> {
        let [a, b] = self.table.edge_uses.row(self.table.triangle_edges[i as usize][k]) else { return None };
        let other = if a.triangle.0 == i { b } else { a };
        let j = other.triangle.0;
        let [f, g] = [i, j].map(|i| self.kept[i as usize]);
        let one = a.forward() != b.forward()
            && f.at() >= self.r.whole
            && g.at() >= self.r.whole
            && self.support(i) == self.support(j)
            && births(self.r, f) == births(self.r, g);
        one.then(|| (j, other.side()))
    }

    /// The parts of each face, rising; faces by their lowest part.
    fn rows(&self) -> Csr<u32> {
        let count = self.kept.len();
        let mut sets = UnionFind::new(count);
        for (i, f) in self.kept.iter().enumerate() {
            if f.at() < self.r.whole {
                continue;
            }
            for k in 0..3 {
                if let Some((j, _)) = self.across(i as u32, k) {
                    sets.union(i, j as usize);
                }
            }
        }
        let (of, faces) = sets.labels();
        Csr::from_pairs(faces, of.iter().enumerate().map(|(i, &f)| (f as usize, i as u32)))
    }
}

/// The planes of half-spaces through each vertex, of coincident ones the lowest.
fn planes_through(r: &Resolved, vertices: &[VertexId]) -> Csr<PlaneId> {
    let (planes, stands) = (r.soup.planes(), &r.soup.half_spaces.stands);
    if planes.is_empty() {
        return Csr { offsets: vec![0; vertices.len() + 1], items: Vec::new() };
    }
    let on = |v: VertexId, p: &PlaneId| {
        let plane = &planes[p.at()];
        stands[p.at()] == *p
            && quick_side(plane, &r.coords(v)).is_none()
            && exact::support_side(&Support::Plane(*plane), &r.point(v)).is_zero()
    };
    let all: Vec<Vec<PlaneId>> = vertices
        .par_iter()
        .with_min_len(1 << 10)
        .map(|&v| (0..planes.len()).map(PlaneId::of).filter(|p| on(v, p)).collect())
        .collect();
    let mut rows = Csr::with_capacity(vertices.len(), 0);
    all.iter().for_each(|row| rows.push_row(row));
    rows
}

/// The plane that a whole face lies on: the one through all vertices of its outer loop, which are on no line.
fn plane_of(c: &Complex, f: FaceId) -> PlaneId {
    let corners = c.corners_of(LoopId(c.face_loops[f.at()]));
    let [first, rest @ ..] = &c.corner_vertices[corners] else { return PlaneId::NONE };
    let whole = |p: &&PlaneId| rest.iter().all(|v| c.vertex_planes.row(*v).contains(p));
    c.vertex_planes.row(*first).iter().find(whole).copied().unwrap_or(PlaneId::NONE)
}

/// All births of a face that has several.
fn births(r: &Resolved, f: FaceId) -> Option<&[Birth]> {
    r.shared.binary_search(&f).ok().map(|i| r.births.row(i))
}

/// Fills loops, outer ones first; returns the vertices that they have, rising, by which corners are numbered.
fn fill_faces(c: &mut Complex, r: &Resolved, parts: &Parts, faces: &Csr<u32>) -> Vec<VertexId> {
    let mut loops: Csr<VertexId> = Csr::with_capacity(faces.len(), 3 * faces.len());
    // The first loop of each face, and vertices inside faces by face.
    let mut first = vec![0u32];
    let mut inner: Vec<(u32, VertexId)> = Vec::new();
    let mut used = vec![false; r.vertex_count()];
    // The last face that has each vertex on its boundary, plus one; sides that are in a loop.
    let mut seen = vec![0u32; r.vertex_count()];
    let mut done = vec![false; 3 * parts.kept.len()];
    for (f, row) in faces.rows().enumerate() {
        let stamp = f as u32 + 1;
        let start = loops.len();
        if let [i] = *row {
            loops.push_row(&parts.corners(i));
        } else {
            for (i, k) in row.iter().flat_map(|&i| (0..3).map(move |k| (i, k))) {
                if !done[3 * i as usize + k] && parts.across(i, k).is_none() {
                    trace(parts, i, k, &mut done, &mut loops);
                }
            }
            outer_first(r, &mut loops, start);
        }
        let corners = loops.offsets[start] as usize..loops.items.len();
        for &v in &loops.items[corners] {
            used[v.at()] = true;
            seen[v.at()] = stamp;
        }
        for v in row.iter().flat_map(|&i| parts.corners(i)) {
            if std::mem::replace(&mut seen[v.at()], stamp) != stamp {
                inner.push((f as u32, v));
            }
        }
        first.push(loops.len() as u32);
    }
    inner.retain(|x| used[x.1.at()]);
    let vertices: Vec<VertexId> = (0..used.len()).filter(|&v| used[v]).map(VertexId::of).collect();
    let mut number = vec![VertexId::NONE; used.len()];
    vertices.iter().enumerate().for_each(|(i, v)| number[v.at()] = VertexId::of(i));
    (c.face_loops, c.loop_offsets) = (vec![0], vec![0]);
    c.corner_vertices = Vec::with_capacity(loops.items.len() + inner.len());
    let mut lone = inner.into_iter().peekable();
    for f in 0..faces.len() {
        for l in first[f]..first[f + 1] {
            c.corner_vertices.extend(loops.row(l as usize).iter().map(|v| number[v.at()]));
            c.loop_offsets.push(c.corner_vertices.len() as u32);
        }
        while let Some((_, v)) = lone.next_if(|x| x.0 as usize == f) {
            c.corner_vertices.push(number[v.at()]);
            c.loop_offsets.push(c.corner_vertices.len() as u32);
        }
        c.face_loops.push(c.loop_offsets.len() as u32 - 1);
    }
    vertices
}

/// The loop that begins with a side of a part.
fn trace(parts: &Parts, i: u32, k: usize, done: &mut [bool], loops: &mut Csr<VertexId>) {
    let (mut i, mut k) = (i, k);
    while !std::mem::replace(&mut done[3 * i as usize + k], true) {
        loops.items.push(parts.corners(i)[k]);
        k = (k + 1) % 3;
        while let Some((j, side)) = parts.across(i, k) {
            (i, k) = (j, (side + 1) % 3);
        }
    }
    loops.end_row();
}

/// Puts the loop with the least vertex before the others from `start` on.
fn outer_first(r: &Resolved, loops: &mut Csr<VertexId>, start: usize) {
    if loops.len() == start + 1 {
        return;
    }
    let less = |a: VertexId, b: VertexId| {
        let (x, y) = (r.coords(a), r.coords(b));
        let order = |axis: usize| exact::compare_rounded(x[axis], y[axis], || r.point(a), || r.point(b), axis);
        a != b && (0..3).map(order).find(|o| o.is_ne()) == Some(Ordering::Less)
    };
    let least = |l: usize| loops.row(l).iter().copied().reduce(|a, b| if less(b, a) { b } else { a });
    let mut outer = (start, least(start));
    for l in start + 1..loops.len() {
        let other = least(l);
        if let (Some(a), Some(b)) = (other, outer.1)
            && less(a, b)
        {
            outer = (l, other);
        }
    }
    let order = std::iter::once(outer.0).chain((start..loops.len()).filter(|&l| l != outer.0));
    let rows: Vec<Vec<VertexId>> = order.map(|l| loops.row(l).to_vec()).collect();
    loops.items.truncate(loops.offsets[start] as usize);
    loops.offsets.truncate(start + 1);
    rows.iter().for_each(|row| loops.push_row(row));
}

/// The shells of regions, numbered anew, and the region of each.
fn bounded_shells(all: &Shells, side: impl Fn(HalfFace) -> CellId) -> Result<(Shells, Vec<CellId>)> {
    let regions: Vec<CellId> = all.lowest.iter().map(|h| side(*h)).collect();
    for (h, s) in all.of.iter().enumerate() {
        if s.is_none() || side(HalfFace(h as u32)) != regions[s.at()] {
            return Err(Error::inconsistent(format!("half-face {h} is in a shell of another cell")));
        }
    }
    let mut number = vec![ShellId::NONE; regions.len()];
    let (mut lowest, mut cell_of) = (Vec::new(), Vec::new());
    for (s, &cell) in regions.iter().enumerate().filter(|(_, c)| c.is_some()) {
        number[s] = ShellId::of(lowest.len());
        lowest.push(all.lowest[s]);
        cell_of.push(cell);
    }
    let of = all.of.iter().map(|s| number[s.at()]).collect();
    Ok((Shells { of, lowest }, cell_of))
}

impl Solids {
    /// What a complex promises, and places in the arrangement for all its vertices and faces.
    pub fn check(&self, a: &Arrangement) -> std::result::Result<(), String> {
        let c = &self.complex;
        crate::complex::check(c)?;
        self.faces.check()?;
        if self.faces.len() != c.face_count() || self.vertices.len() != c.vertex_count() {
            return Err("as many places as elements".into());
        }
        if self.vertices.windows(2).any(|w| w[0] >= w[1]) || self.faces.rows().any(|row| row.is_empty()) {
            return Err("vertices do not rise, or a face is of nothing".into());
        }
        match self.vertices.iter().zip(&c.origins).position(|(v, origin)| a.origin(*v) != *origin) {
            Some(v) => Err(format!("vertex {v} is another point")),
            None => Ok(()),
        }
    }
}

//! Stage 7: everything into one complex with one numbering.
//!
//! Vertices: the mesh's, points on mesh edges, points in triangles, points inside. Edges: pieces of mesh edges, of chords, of lines.
//! Faces: uncut triangles in input order, faces of cut triangles, faces of planes by plane id.

use super::classify::KnifeId;
use super::faces::SectionFaces;
use super::lines::{InnerPoints, Lines};
use super::patches::Whole;
use super::surface::Surface;
use super::triangles::edge_piece;
use crate::base::parallel::{Writer, ranges, write_parts};
use crate::base::{Csr, EdgeId, PlaneId, TriangleId, VertexId};
use crate::complex::{Complex, SupportId};
use crate::mesh::TriMesh;
use std::ops::Range;
use std::sync::Arc;

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

/// The planes of each vertex by id: the sets of all carriers one behind the other.
fn vertex_planes(surface: &Surface, inner: &InnerPoints) -> Csr<PlaneId> {
    let sources = [&surface.classified.vertex_knives, &surface.points.knives, &surface.sub.point_knives, &inner.knives];
    let mut parts: Vec<(&Csr<KnifeId>, Range<usize>, u32)> = Vec::new();
    let mut base = 0;
    for source in sources {
        parts.extend(ranges(source.len(), LEAST).into_iter().map(|range| (source, range, base)));
        base += source.items.len() as u32;
    }
    let lengths: Vec<usize> = parts.iter().map(|p| p.1.len()).chain([1]).collect();
    let offsets = write_parts(&lengths, |i, out| match parts.get(i) {
        Some((source, range, base)) => out.extend(source.offsets[range.clone()].iter().map(|o| o + base)),
        None => out.push(base),
    });
    // One set after the other; only sets of several planes can be in another order than their knives.
    let items = |p: &(&Csr<KnifeId>, Range<usize>, u32)| p.0.offsets[p.1.start] as usize..p.0.offsets[p.1.end] as usize;
    let id = |k: &KnifeId| surface.knives.ids[k.at()];
    let sorted = surface.knives.ids.is_sorted();
    let lengths: Vec<usize> = parts.iter().map(|p| items(p).len()).collect();
    let items = write_parts(&lengths, |i, out| {
        let (source, range, _) = &parts[i];
        if sorted {
            return out.extend(source.items[items(&parts[i])].iter().map(id));
        }
        let mut set = Vec::new();
        for row in range.clone().map(|r| source.row(r)).filter(|row| !row.is_empty()) {
            if let [k] = row {
                out.push(id(k));
                continue;
            }
            set.clear();
            set.extend(row.iter().map(id));
            set.sort_unstable();
            out.extend(set.iter().copied());
        }
    });
    Csr { offsets, items }
}

/// Pieces of mesh edges, chords and lines, in this order.
fn edges(surface: &Surface, lines: &Lines) -> Vec<[VertexId; 2]> {
    let (mesh, points, pieces) = (surface.mesh, surface.points, &surface.sub.pieces);
    enum Part {
        Mesh(Range<usize>),
        Chords(Range<usize>),
        Lines(Range<usize>),
    }
    let of = |count: usize| ranges(count, LEAST).into_iter();
    let parts: Vec<Part> = of(mesh.edges.len())
        .map(Part::Mesh)
        .chain(of(pieces.len()).map(Part::Chords))
        .chain(of(lines.ends.len()).map(Part::Lines))
        .collect();
    let length = |part: &Part| match part {
        Part::Mesh(r) => r.len() + (points.first[r.end] - points.first[r.start]) as usize,
        Part::Chords(r) => r.len(),
        Part::Lines(r) => r.len() + (lines.points.offsets[r.end] - lines.points.offsets[r.start]) as usize,
    };
    let lengths: Vec<usize> = parts.iter().map(length).collect();
    write_parts(&lengths, |i, out| match &parts[i] {
        Part::Mesh(range) => {
            for e in range.clone() {
                let [mut from, to] = mesh.edges[e];
                for i in points.first[e]..points.first[e + 1] {
                    let v = VertexId(surface.numbering.first_edge_point + i);
                    out.push([from, v]);
                    from = v;
                }
                out.push([from, to]);
            }
        }
        Part::Chords(range) => out.extend(pieces[range.clone()].iter().copied()),
        Part::Lines(range) => {
            for s in range.clone() {
                let [mut from, to] = lines.ends[s];
                for &v in lines.points.row(s) {
                    out.push([from, v]);
                    from = v;
                }
                out.push([from, to]);
            }
        }
    })
}

/// The lowest plane that holds a whole triangle.
fn plane_of_triangle(surface: &Surface, t: TriangleId) -> PlaneId {
    let [a, b, c] = surface.mesh.triangles[t.at()].map(|v| surface.set(v));
    if a.is_empty() || b.is_empty() || c.is_empty() {
        return PlaneId::NONE;
    }
    let common = a.iter().filter(|k| b.contains(k) && c.contains(k));
    common.map(|k| surface.knives.ids[k.at()]).min().unwrap_or(PlaneId::NONE)
}

/// Some consecutive faces.
enum Part {
    /// Uncut triangles, by place among them.
    Whole(Range<usize>),
    /// Faces of cut triangles.
    Cut(Range<usize>),
    /// The faces of a section: of plane `plane` of a list of planes.
    Section { list: usize, plane: usize, knife: KnifeId },
}

/// Where a part's faces start in the complex, and how many they are.
struct Place {
    faces: usize,
    loops: usize,
    corners: usize,
}

/// The faces and their corners, array by array; see [`assemble`].
struct Faces<'a> {
    surface: &'a Surface<'a>,
    whole: &'a Whole,
    sections: &'a [SectionFaces],
    parts: Vec<Part>,
    /// Of each part, and at last the ends.
    places: Vec<Place>,
}

impl<'a> Faces<'a> {
    /// Sections come by plane id.
    fn new(surface: &'a Surface<'a>, whole: &'a Whole, sections: &'a [SectionFaces]) -> Self {
        let sub = surface.sub;
        let planes = sections.iter().enumerate().flat_map(|(list, s)| (0..s.planes.len() - 1).map(move |p| (list, p)));
        let mut by_id: Vec<_> = planes.enumerate().map(|(k, at)| (surface.knives.ids[k], KnifeId::of(k), at)).collect();
        by_id.sort_unstable();
        let of = |count: usize| ranges(count, LEAST).into_iter();
        let parts: Vec<Part> = of(whole.triangles.len())
            .map(Part::Whole)
            .chain(of(sub.faces.len()).map(Part::Cut))
            .chain(by_id.into_iter().map(|(_, knife, (list, plane))| Part::Section { list, plane, knife }))
            .collect();
        let mut at = Place { faces: 0, loops: 0, corners: 0 };
        let mut places = Vec::with_capacity(parts.len() + 1);
        for part in &parts {
            let (faces, loops, corners) = match part {
                Part::Whole(r) => (r.len(), r.len(), 3 * r.len()),
                Part::Cut(r) => (r.len(), r.len(), (sub.faces.offsets[r.end] - sub.faces.offsets[r.start]) as usize),
                &Part::Section { list, plane, .. } => {
                    let s = &sections[list];
                    let faces = s.planes[plane] as usize..s.planes[plane + 1] as usize;
                    let loops = s.faces[faces.start] as usize..s.faces[faces.end] as usize;
                    let corners = s.loops.offsets[loops.end] - s.loops.offsets[loops.start];
                    (faces.len(), loops.len(), corners as usize)
                }
            };
            let next = Place { faces: at.faces + faces, loops: at.loops + loops, corners: at.corners + corners };
            places.push(std::mem::replace(&mut at, next));
        }
        places.push(at);
        Self { surface, whole, sections, parts, places }
    }

    /// An array with as many elements per part as the differences of `count`, plus one at the end if given.
    fn write<T: Copy + Send + Sync>(
        &self,
        count: impl Fn(&Place) -> usize,
        last: Option<T>,
        write: impl Fn(&Part, &Place, &mut Writer<T>) + Sync,
    ) -> Vec<T> {
        let lengths = self.places.windows(2).map(|w| count(&w[1]) - count(&w[0]));
        let lengths: Vec<usize> = lengths.chain(last.map(|_| 1)).collect();
        write_parts(&lengths, |i, out| match (self.parts.get(i), last) {
            (Some(part), _) => write(part, &self.places[i], out),
            (None, Some(last)) => out.push(last),
            (None, None) => {}
        })
    }

    /// The faces of a section, as loops behind one another: the first loop of each face.
    fn section_faces(&self, list: usize, plane: usize) -> &[u32] {
        let s = &self.sections[list];
        &s.faces[s.planes[plane] as usize..s.planes[plane + 1] as usize]
    }

    /// The loops of a section, as corners behind one another: the first corner of each loop.
    fn section_loops(&self, list: usize, plane: usize) -> &[u32] {
        let s = &self.sections[list];
        let loop_of = |face: u32| s.faces[face as usize] as usize;
        &s.loops.offsets[loop_of(s.planes[plane])..loop_of(s.planes[plane + 1])]
    }

    fn section_corners(&self, list: usize, plane: usize) -> &[(VertexId, EdgeId)] {
        let s = &self.sections[list];
        let corner_of = |face: u32| s.loops.offsets[s.faces[face as usize] as usize] as usize;
        &s.loops.items[corner_of(s.planes[plane])..corner_of(s.planes[plane + 1])]
    }

    fn corner_vertices(&self) -> Vec<VertexId> {
        let (mesh, faces) = (self.surface.mesh, &self.surface.sub.faces);
        self.write(
            |p| p.corners,
            None,
            |part, _, out| match part {
                Part::Whole(r) => {
                    self.whole.triangles[r.clone()].iter().for_each(|t| out.extend(mesh.triangles[t.at()]));
                }
                Part::Cut(r) => {
                    let corners = faces.offsets[r.start] as usize..faces.offsets[r.end] as usize;
                    out.extend(faces.items[corners].iter().map(|c| c.0));
                }
                &Part::Section { list, plane, .. } => {
                    out.extend(self.section_corners(list, plane).iter().map(|c| c.0));
                }
            },
        )
    }

    fn corner_edges(&self) -> Vec<EdgeId> {
        let (mesh, faces) = (self.surface.mesh, &self.surface.sub.faces);
        let piece = |e: EdgeId| EdgeId(edge_piece(self.surface.points, e));
        self.write(
            |p| p.corners,
            None,
            |part, _, out| match part {
                Part::Whole(r) => {
                    let edges = |t: &TriangleId| mesh.triangle_edges[t.at()].map(piece);
                    self.whole.triangles[r.clone()].iter().for_each(|t| out.extend(edges(t)));
                }
                Part::Cut(r) => {
                    let corners = faces.offsets[r.start] as usize..faces.offsets[r.end] as usize;
                    out.extend(faces.items[corners].iter().map(|c| c.1));
                }
                &Part::Section { list, plane, .. } => {
                    out.extend(self.section_corners(list, plane).iter().map(|c| c.1));
                }
            },
        )
    }

    fn loop_offsets(&self) -> Vec<u32> {
        let faces = &self.surface.sub.faces;
        let end = self.places[self.parts.len()].corners as u32;
        self.write(
            |p| p.loops,
            Some(end),
            |part, place, out| {
                let base = place.corners as u32;
                match part {
                    Part::Whole(r) => out.extend((0..r.len() as u32).map(|i| base + 3 * i)),
                    Part::Cut(r) => {
                        let first = faces.offsets[r.start];
                        out.extend(faces.offsets[r.clone()].iter().map(|o| o - first + base));
                    }
                    &Part::Section { list, plane, .. } => {
                        let loops = self.section_loops(list, plane);
                        out.extend(loops.iter().map(|l| l - loops[0] + base));
                    }
                }
            },
        )
    }

    fn face_loops(&self) -> Vec<u32> {
        let end = self.places[self.parts.len()].loops as u32;
        self.write(
            |p| p.faces,
            Some(end),
            |part, place, out| {
                let base = place.loops as u32;
                match part {
                    Part::Whole(r) | Part::Cut(r) => out.extend((0..r.len() as u32).map(|i| base + i)),
                    &Part::Section { list, plane, .. } => {
                        let faces = self.section_faces(list, plane);
                        out.extend(faces.iter().map(|f| f - faces[0] + base));
                    }
                }
            },
        )
    }

    /// One value per face: of its triangle, or of its section.
    fn of_faces<T: Copy + Send + Sync>(
        &self,
        triangle: impl Fn(TriangleId) -> T + Sync,
        section: impl Fn(PlaneId) -> T + Sync,
    ) -> Vec<T> {
        self.write(
            |p| p.faces,
            None,
            |part, _, out| match part {
                Part::Whole(r) => out.extend(self.whole.triangles[r.clone()].iter().map(|&t| triangle(t))),
                Part::Cut(r) => out.extend(self.surface.sub.face_triangle[r.clone()].iter().map(|&t| triangle(t))),
                &Part::Section { list, plane, knife } => {
                    let value = section(self.surface.knives.ids[knife.at()]);
                    out.extend(std::iter::repeat_n(value, self.section_faces(list, plane).len()));
                }
            },
        )
    }
}

/// A complex without cells and without the vertices' origins and coordinates yet (they are still read, and are
/// moved in at the end), and the first face id of each section.
pub fn assemble(
    mesh: &Arc<TriMesh>,
    surface: &Surface,
    whole: &Whole,
    lines: &Lines,
    inner: &InnerPoints,
    sections: &[SectionFaces],
) -> (Complex, Vec<u32>) {
    let faces = Faces::new(surface, whole, sections);
    let mut first_face = vec![0; surface.knives.len()];
    for (part, place) in faces.parts.iter().zip(&faces.places) {
        if let Part::Section { knife, .. } = part {
            first_face[knife.at()] = place.faces as u32;
        }
    }
    let tag = |t: TriangleId| mesh.tags.get(t.at()).copied().unwrap_or(0);
    let complex = Complex {
        mesh: mesh.clone(),
        planes: surface.input_planes.to_vec(),
        vertex_planes: vertex_planes(surface, inner),
        edges: edges(surface, lines),
        face_loops: faces.face_loops(),
        loop_offsets: faces.loop_offsets(),
        corner_vertices: faces.corner_vertices(),
        corner_edges: faces.corner_edges(),
        face_support: faces.of_faces(SupportId::Triangle, SupportId::Plane),
        face_plane: faces.of_faces(|t| plane_of_triangle(surface, t), |p| p),
        face_tag: faces.of_faces(tag, |_| 0),
        ..Default::default()
    };
    (complex, first_face)
}

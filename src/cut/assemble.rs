//! Stage 7: everything into one complex with one numbering.
//!
//! Vertices: the mesh's, points on mesh edges, points in triangles, points inside. Edges: pieces of mesh edges, of chords, of lines.
//! Faces: uncut triangles in input order, faces of cut triangles, faces of planes by plane id.

use super::classify::KnifeId;
use super::faces::SectionFaces;
use super::lines::{InnerPoints, Lines};
use super::surface::Surface;
use super::triangles::edge_piece;
use crate::base::{Csr, EdgeId, PlaneId, TriangleId, VertexId};
use crate::complex::{Complex, SupportId};
use crate::mesh::TriMesh;
use std::sync::Arc;

/// The planes of each vertex by id.
fn vertex_planes(surface: &Surface, inner: &InnerPoints) -> Csr<PlaneId> {
    let count = surface.origins.len();
    let mut rows = Csr::with_capacity(count + inner.names.len(), count / 2);
    let mut push = |set: &[KnifeId]| {
        let start = rows.items.len();
        rows.items.extend(set.iter().map(|k| surface.knives.ids[k.at()]));
        rows.items[start..].sort_unstable();
        rows.end_row();
    };
    (0..count).for_each(|v| push(surface.set(VertexId::of(v))));
    inner.knives.rows().for_each(&mut push);
    rows
}

/// Pieces of mesh edges, chords and lines, in this order.
fn edges(surface: &Surface, lines: &Lines) -> Vec<[VertexId; 2]> {
    let (mesh, points) = (surface.mesh, surface.points);
    let line_pieces = lines.ends.len() + lines.points.items.len();
    let mut edges = Vec::with_capacity(mesh.edges.len() + points.edge.len() + surface.sub.pieces.len() + line_pieces);
    for (e, &[a, b]) in mesh.edges.iter().enumerate() {
        let mut from = a;
        for i in points.first[e]..points.first[e + 1] {
            let v = VertexId(surface.numbering.first_edge_point + i);
            edges.push([from, v]);
            from = v;
        }
        edges.push([from, b]);
    }
    edges.extend_from_slice(&surface.sub.pieces);
    for (s, &[from, to]) in lines.ends.iter().enumerate() {
        let mut from = from;
        for &v in lines.points.row(s) {
            edges.push([from, v]);
            from = v;
        }
        edges.push([from, to]);
    }
    edges
}

struct FaceWriter<'a> {
    c: &'a mut Complex,
}

impl FaceWriter<'_> {
    fn corner(&mut self, v: VertexId, e: EdgeId) {
        self.c.corner_vertices.push(v);
        self.c.corner_edges.push(e);
    }
    fn end_loop(&mut self) {
        self.c.loop_offsets.push(self.c.corner_vertices.len() as u32);
    }
    fn end_face(&mut self, support: SupportId, plane: PlaneId, tag: i32) {
        self.c.face_loops.push(self.c.loop_offsets.len() as u32 - 1);
        self.c.face_support.push(support);
        self.c.face_plane.push(plane);
        self.c.face_tag.push(tag);
    }
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

/// A complex without cells and without the vertices' origins and coordinates yet (they are still read, and are
/// moved in at the end), and the first face id of each section.
pub fn assemble(
    mesh: &Arc<TriMesh>,
    surface: &Surface,
    lines: &Lines,
    inner: &InnerPoints,
    sections: &[SectionFaces],
) -> (Complex, Vec<u32>) {
    let sub = surface.sub;
    let mut c = Complex {
        mesh: mesh.clone(),
        planes: surface.input_planes.to_vec(),
        vertex_planes: vertex_planes(surface, inner),
        edges: edges(surface, lines),
        face_loops: vec![0],
        loop_offsets: vec![0],
        ..Default::default()
    };
    let corners = 3 * (mesh.triangles.len() - sub.cut.len())
        + sub.faces.items.len()
        + sections.iter().map(|s| s.loops.items.len()).sum::<usize>();
    let faces =
        mesh.triangles.len() - sub.cut.len() + sub.faces.len() + sections.iter().map(|s| s.faces.len()).sum::<usize>();
    c.corner_vertices.reserve_exact(corners);
    c.corner_edges.reserve_exact(corners);
    c.loop_offsets.reserve(faces);
    c.face_loops.reserve_exact(faces);
    c.face_support.reserve_exact(faces);
    c.face_plane.reserve_exact(faces);
    c.face_tag.reserve_exact(faces);
    let tag = |t: TriangleId| mesh.tags.get(t.at()).copied().unwrap_or(0);
    let mut out = FaceWriter { c: &mut c };
    let mut cut = sub.cut.iter().peekable();
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let t = TriangleId::of(t);
        if cut.next_if(|&&next| next == t).is_some() {
            continue;
        }
        for (v, e) in corners.iter().zip(mesh.triangle_edges[t.at()]) {
            out.corner(*v, EdgeId(edge_piece(surface.points, e)));
        }
        out.end_loop();
        out.end_face(SupportId::Triangle(t), plane_of_triangle(surface, t), tag(t));
    }
    for (f, &t) in sub.face_triangle.iter().enumerate() {
        sub.faces.row(f).iter().for_each(|&(v, e)| out.corner(v, e));
        out.end_loop();
        out.end_face(SupportId::Triangle(t), plane_of_triangle(surface, t), tag(t));
    }
    let mut order: Vec<usize> = (0..sections.len()).collect();
    order.sort_unstable_by_key(|&k| surface.knives.ids[k]);
    let mut first_face = vec![0; sections.len()];
    for k in order {
        let plane = surface.knives.ids[k];
        first_face[k] = out.c.face_support.len() as u32;
        for loops in sections[k].faces.rows() {
            for &l in loops {
                sections[k].loops.row(l as usize).iter().for_each(|&(v, e)| out.corner(v, e));
                out.end_loop();
            }
            out.end_face(SupportId::Plane(plane), plane, 0);
        }
    }
    (c, first_face)
}

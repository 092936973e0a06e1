//! Pass-through: what no plane touches is joined on the mesh, without looking at the complex.
//!
//! An uncut triangle is a face by itself, and uncut triangles come first among the faces, in input order. Two of them at a mesh
//! edge that no plane crosses or holds, and that nobody else uses, have one wedge of solid between them: their backs belong to
//! one shell. That settles nearly all edges of fine input; `complex::shells` is left with those around the cuts.
//!
//! Cost: linear in mesh edges, shared out among threads; union-find on uncut triangles.

use super::classify::Classified;
use super::edges::EdgePoints;
use crate::base::parallel::{concat, map_ranges};
use crate::base::{EdgeId, FaceId, SharedUnionFind, TriangleId};
use crate::complex::HalfFace;
use crate::complex::shells::Joined;
use crate::exact::counters;
use crate::mesh::TriMesh;
use std::sync::atomic::{AtomicU64, Ordering};

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

/// The triangles that are faces by themselves.
#[derive(Debug, Default)]
pub struct Whole {
    /// In input order: face `f` is triangle `triangles[f]`.
    pub triangles: Vec<TriangleId>,
    /// The face of each triangle, `NONE` for those that are cut.
    pub face: Vec<FaceId>,
}

/// The triangles that are not in the rising list `cut`.
pub fn whole_triangles(mesh: &TriMesh, cut: &[TriangleId]) -> Whole {
    let parts = map_ranges(mesh.triangles.len(), LEAST, |range| {
        let (first, end) = (TriangleId::of(range.start), TriangleId::of(range.end));
        let before = cut.partition_point(|&t| t < first);
        let here = &cut[before..cut.partition_point(|&t| t < end)];
        let mut whole = Vec::with_capacity(range.len() - here.len());
        let mut face = Vec::with_capacity(range.len());
        let mut next = here.iter().copied().peekable();
        for t in range.clone().map(TriangleId::of) {
            if next.next_if_eq(&t).is_some() {
                face.push(FaceId::NONE);
            } else {
                face.push(FaceId::of(range.start - before + whole.len()));
                whole.push(t);
            }
        }
        (whole, face)
    });
    let (triangles, face) = parts.into_iter().unzip();
    Whole { triangles: concat(triangles), face: concat(face) }
}

/// Joins the backs of whole triangles across the mesh edges that these alone use. `face_count` is that of the complex;
/// `first_chord_piece`, its number of pieces of mesh edges.
pub fn join_whole(
    mesh: &TriMesh,
    classified: &Classified,
    points: &EdgePoints,
    whole: &Whole,
    face_count: usize,
    first_chord_piece: u32,
) -> Joined {
    let classes = SharedUnionFind::new(2 * face_count);
    let words = (first_chord_piece as usize).div_ceil(64);
    let open: Vec<AtomicU64> = (0..words).map(|_| AtomicU64::new(0)).collect();
    let on_planes = &classified.edges_on;
    let (first, face) = (&points.first[..], &whole.face[..]);
    let uses = map_ranges(mesh.edges.len(), LEAST, |range| {
        let (first, face, classes) = (first, face, &classes);
        let mut uses = Vec::new();
        let mut on = on_planes[on_planes.partition_point(|(e, _)| e.at() < range.start)..].iter().peekable();
        let mut settled = 0;
        // Pieces rise with edges: words are written one by one, and only the first and the last are shared between threads.
        let (mut word, mut bits) = (0, 0u64);
        let flush = |word: usize, bits: u64| {
            if bits != 0 {
                open[word].fetch_or(bits, Ordering::Relaxed);
            }
        };
        for e in range.map(EdgeId::of) {
            let mut plain = first[e.at()] == first[e.at() + 1];
            while on.next_if(|o| o.0 == e).is_some() {
                plain = false;
            }
            let row = mesh.edge_uses.row(e);
            if let [a, b] = row
                && plain
            {
                let (a, b) = (face[a.triangle.at()], face[b.triangle.at()]);
                if a.is_some() && b.is_some() {
                    classes.union(HalfFace::new(a, false).at(), HalfFace::new(b, false).at());
                    settled += 1;
                    continue;
                }
            }
            let pieces = e.0 + first[e.at()]..=e.0 + first[e.at() + 1];
            for piece in pieces.clone() {
                if piece as usize / 64 != word {
                    flush(word, bits);
                    (word, bits) = (piece as usize / 64, 0);
                }
                bits |= 1 << (piece % 64);
            }
            // A whole triangle's edges are whole.
            let whole = row.iter().map(|u| (face[u.triangle.at()], u.forward())).filter(|u| u.0.is_some());
            uses.extend(whole.map(|(f, forward)| (EdgeId(*pieces.start()), HalfFace::new(f, forward))));
        }
        flush(word, bits);
        counters::count_many(counters::Predicate::RadialOrder, counters::Tier::Topology, settled);
        uses
    });
    let mut open: Vec<u64> = open.into_iter().map(AtomicU64::into_inner).collect();
    // Chord pieces share the last word.
    if !first_chord_piece.is_multiple_of(64)
        && let Some(last) = open.last_mut()
    {
        *last |= !0 << (first_chord_piece % 64);
    }
    Joined { classes, first_face: whole.triangles.len(), uses: concat(uses), open }
}

//! Pass-through: what no plane touches is joined on the mesh, without looking at the complex.
//!
//! An uncut triangle is a face by itself, and uncut triangles come first among the faces, in input order. Two of them at a mesh
//! edge that no plane crosses or holds, and that nobody else uses, have one wedge of solid between them: their backs belong to
//! one shell. That settles nearly all edges of fine input; `complex::shells` is left with those around the cuts.
//!
//! Cost: union-find on uncut triangles, shared out among threads; a bit for each mesh edge; linear in cut triangles.

use super::classify::Classified;
use super::edges::EdgePoints;
use crate::base::bits::ones;
use crate::base::parallel::{concat, map_ranges};
use crate::base::{EdgeId, FaceId, SharedUnionFind, TriangleId};
use crate::complex::HalfFace;
use crate::complex::shells::Joined;
use crate::exact::counters;
use crate::mesh::TriMesh;
use crate::mesh::shells::{FirstUse, has_fans, neighbours_are_near};
use rayon::prelude::*;
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
    cut: &[TriangleId],
    whole: &Whole,
    face_count: usize,
    first_chord_piece: u32,
) -> Joined {
    let classes = SharedUnionFind::new(2 * face_count);
    let left = edges_left(mesh, classified, cut);
    let is_left = |e: EdgeId| left[e.at() / 64] >> (e.at() % 64) & 1 != 0;
    let back = |t: TriangleId| HalfFace::new(whole.face[t.at()], false).at();
    if neighbours_are_near(&mesh.edge_uses) {
        let first_use = FirstUse::new(&mesh.edge_uses);
        // Half-faces `2 f` of whole faces; what lies behind them is nobody's here.
        classes.join_blocks(LEAST, |range, block| {
            let faces = range.start.div_ceil(2)..range.end.div_ceil(2).min(whole.triangles.len());
            for t in faces.map(|f| whole.triangles[f]) {
                let first = |e: EdgeId| back(if is_left(e) { t } else { first_use.of(e) });
                block.join(back(t), mesh.triangle_edges[t.at()].map(first));
            }
        });
    } else {
        map_ranges(mesh.edges.len(), LEAST, |range| {
            for e in range.map(EdgeId::of).filter(|&e| !is_left(e)) {
                let [a, b] = [0, 1].map(|i| back(mesh.edge_uses.row(e)[i].triangle));
                classes.union(a, b);
            }
        });
    }
    let open: Vec<AtomicU64> = (0..(first_chord_piece as usize).div_ceil(64)).map(|_| AtomicU64::new(0)).collect();
    let parts = map_ranges(left.len(), LEAST / 64, |range| {
        let (mut uses, mut count) = (Vec::new(), 0);
        // Pieces rise with edges: words are written one by one, and only the first and the last are shared between threads.
        let (mut word, mut mask) = (0, 0u64);
        let flush = |word: usize, mask: u64| {
            if mask != 0 {
                open[word].fetch_or(mask, Ordering::Relaxed);
            }
        };
        for e in ones(64 * range.start, &left[range]) {
            count += 1;
            let (first, last) = (e as u32 + points.first[e], e as u32 + points.first[e + 1]);
            for piece in first..=last {
                if piece as usize / 64 != word {
                    flush(word, mask);
                    (word, mask) = (piece as usize / 64, 0);
                }
                mask |= 1 << (piece % 64);
            }
            // A whole triangle's edges are whole.
            let row = mesh.edge_uses.row(e).iter().map(|u| (whole.face[u.triangle.at()], u.forward()));
            let row = row.filter(|u| u.0.is_some());
            uses.extend(row.map(|(f, forward)| (EdgeId(first), HalfFace::new(f, forward))));
        }
        flush(word, mask);
        (uses, count)
    });
    let (uses, counts): (Vec<_>, Vec<usize>) = parts.into_iter().unzip();
    let mut open: Vec<u64> = open.into_iter().map(AtomicU64::into_inner).collect();
    // Chord pieces share the last word.
    if !first_chord_piece.is_multiple_of(64)
        && let Some(last) = open.last_mut()
    {
        *last |= !0 << (first_chord_piece % 64);
    }
    let settled = mesh.edges.len() - counts.iter().sum::<usize>();
    counters::count_many(counters::Predicate::RadialOrder, counters::Tier::Topology, settled as u64);
    Joined { classes, first_face: whole.triangles.len(), uses: concat(uses), open }
}

/// One bit for each mesh edge: it is not used by two whole triangles alone, or lies in a plane. Cut triangles have all edges
/// that planes cross.
fn edges_left(mesh: &TriMesh, classified: &Classified, cut: &[TriangleId]) -> Vec<u64> {
    let left: Vec<AtomicU64> = (0..mesh.edges.len().div_ceil(64)).map(|_| AtomicU64::new(0)).collect();
    // Neighbours and planes name most of them again.
    let set = |e: usize| {
        let (word, bit) = (&left[e / 64], 1 << (e % 64));
        if word.load(Ordering::Relaxed) & bit == 0 {
            word.fetch_or(bit, Ordering::Relaxed);
        }
    };
    let (cut, on) = (cut.par_iter().with_min_len(LEAST), classified.edges_on.par_iter().with_min_len(LEAST));
    cut.for_each(|t| mesh.triangle_edges[t.at()].into_iter().for_each(|e| set(e.at())));
    on.for_each(|(e, _)| set(e.at()));
    if has_fans(&mesh.edge_uses) {
        let fans = (0..mesh.edges.len()).into_par_iter().with_min_len(LEAST);
        fans.filter(|&e| mesh.edge_uses.range(e).len() > 2).for_each(set);
    }
    left.into_iter().map(AtomicU64::into_inner).collect()
}

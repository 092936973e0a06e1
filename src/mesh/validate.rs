//! Defects of a triangle list, each named by the ids of the input.
//!
//! Every check looks at what can be judged in spite of the other defects: a triangle with an index out of range has no
//! corners to be degenerate, but the other triangles have; edges at its remaining corners are not called open, since
//! the missing triangle may well be the one that closes them.
//!
//! Valid: non-manifold edges (any balanced number of uses) and vertices, several components, voids. Degenerate cases of
//! the checks themselves: −0 equals +0; a triangle with a repeated corner is degenerate and its sides cancel.
//!
//! Cost: linear, shared out among threads; exact arithmetic only for triangles that are nearly degenerate.

use super::edges::EdgeTable;
use super::projection::collinear;
use crate::base::parallel::map_ranges;
use crate::base::{Culprit, DefectKind, VertexId};
use std::sync::atomic::{AtomicU64, Ordering};

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

/// Vertices with a coordinate that is not finite.
pub fn non_finite(vertices: &[[f64; 3]], defects: &mut Vec<Culprit>) {
    let found = collect(vertices.len(), |v| !is_finite(&vertices[v]));
    defects.extend(found.iter().map(|&v| Culprit::new(DefectKind::NonFiniteCoordinate, &[v as i64])));
}

/// Positions below `count` that are found, rising.
fn collect(count: usize, found: impl Fn(usize) -> bool + Sync) -> Vec<usize> {
    map_ranges(count, LEAST, |range| range.filter(|&i| found(i)).collect::<Vec<_>>()).concat()
}

#[inline(always)]
pub fn is_finite(x: &[f64; 3]) -> bool {
    x[0].is_finite() & x[1].is_finite() & x[2].is_finite()
}

/// Corner indices outside `0..vertex_count`.
pub fn out_of_range(vertex_count: usize, triangles: &[[i32; 3]], defects: &mut Vec<Culprit>) {
    for t in collect(triangles.len(), |t| !triangles[t].iter().all(|&i| in_range(i, vertex_count))) {
        for (k, &i) in triangles[t].iter().enumerate() {
            if !in_range(i, vertex_count) {
                defects.push(Culprit::new(DefectKind::IndexOutOfRange, &[t as i64, k as i64, i as i64]));
            }
        }
    }
}

/// A negative index wraps to a number beyond every count.
#[inline(always)]
pub fn in_range(index: i32, vertex_count: usize) -> bool {
    (index as u32 as usize) < vertex_count
}

/// Groups of vertices with equal coordinates, as pairs (lowest of the group, another), sorted. `counts` tells which
/// vertices to compare, finite and without −0.
///
/// A vertex marks a bit that a mixture of its coordinates names, out of sixteen bits per vertex; only where a bit was marked twice are the
/// vertices sorted and compared (one in sixteen or so, and all that are equal). Which bits those are does not depend on
/// the order of the marks.
pub fn duplicates(vertices: &[[f64; 3]], counts: impl Fn(u32) -> bool + Sync) -> Vec<[u32; 2]> {
    let words = (vertices.len() / 4).next_power_of_two();
    let table = || -> Vec<AtomicU64> { (0..words).map(|_| AtomicU64::new(0)).collect() };
    let (marked, again) = (table(), table());
    let place = |v: u32| {
        let bits = mixture(&vertices[v as usize]) >> 32;
        ((bits >> 6) as usize & (words - 1), 1u64 << (bits & 63))
    };
    let alone = rayon::current_num_threads() == 1;
    map_ranges(vertices.len(), LEAST, |range| {
        for v in range.map(|v| v as u32).filter(|&v| counts(v)) {
            let (word, bit) = place(v);
            let was_marked = if alone {
                let before = marked[word].load(Ordering::Relaxed);
                marked[word].store(before | bit, Ordering::Relaxed);
                before & bit != 0
            } else {
                // (In one expression it is one locked instruction, else a loop of them.)
                marked[word].fetch_or(bit, Ordering::Relaxed) & bit != 0
            };
            if was_marked {
                again[word].fetch_or(bit, Ordering::Relaxed);
            }
        }
    });
    let candidates = collect(vertices.len(), |v| {
        let (word, bit) = place(v as u32);
        again[word].load(Ordering::Relaxed) & bit != 0 && counts(v as u32)
    });
    let bits = |v: usize| vertices[v].map(f64::to_bits);
    let mut keys: Vec<([u64; 3], u32)> = candidates.into_iter().map(|v| (bits(v), v as u32)).collect();
    keys.sort_unstable();
    let mut pairs = Vec::new();
    for same in keys.chunk_by(|a, b| a.0 == b.0) {
        pairs.extend(same[1..].iter().map(|&(_, v)| [same[0].1, v]));
    }
    pairs.sort_unstable();
    pairs
}

/// The upper 32 bits depend on every bit of the coordinates, the lower 32 are zero.
#[inline(always)]
fn mixture(x: &[f64; 3]) -> u64 {
    const ODD: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut h = 0u64;
    for c in x {
        h = (h ^ c.to_bits()).wrapping_mul(ODD);
        h ^= h >> 32;
    }
    h.wrapping_mul(ODD) & 0xffff_ffff_0000_0000
}

/// Triangles whose corners lie on a line. Those with a corner that is not finite cannot be judged.
pub fn degenerate(vertices: &[[f64; 3]], triangles: &[[VertexId; 3]], found: impl FnMut(usize)) {
    let is_degenerate = |t: usize| {
        let [a, b, c] = triangles[t];
        let (pa, pb, pc) = (&vertices[a.at()], &vertices[b.at()], &vertices[c.at()]);
        let repeated = a == b || b == c || c == a;
        repeated || ([pa, pb, pc].into_iter().all(is_finite) && collinear(pa, pb, pc))
    };
    collect(triangles.len(), is_degenerate).into_iter().for_each(found);
}

/// Edges whose uses do not balance: `found(edge, kind)`.
pub fn unbalanced(table: &EdgeTable, mut found: impl FnMut(usize, DefectKind)) {
    let is_unbalanced = |e: usize| {
        let uses = table.edge_uses.row(e);
        // The usual edge first: two uses, opposite.
        if let [a, b] = uses {
            return a.forward() == b.forward();
        }
        2 * uses.iter().filter(|u| u.forward()).count() != uses.len()
    };
    for e in collect(table.edges.len(), is_unbalanced) {
        let even = table.edge_uses.row(e).len().is_multiple_of(2);
        found(e, if even { DefectKind::InconsistentOrientation } else { DefectKind::OpenEdge });
    }
}

/// A defect in words.
pub fn describe(culprit: &Culprit) -> String {
    let [a, b, c] = culprit.ids;
    match culprit.kind {
        DefectKind::NonFiniteCoordinate => format!("vertex {a} has a coordinate that is not finite"),
        DefectKind::IndexOutOfRange => format!("corner {b} of triangle {a} refers to vertex {c}, which does not exist"),
        DefectKind::DegenerateTriangle => format!("triangle {a} is degenerate: its corners lie on a line"),
        DefectKind::OpenEdge => {
            format!("the edge between vertices {a} and {b} is open: an odd number of triangles use it (triangle {c})")
        }
        DefectKind::InconsistentOrientation => format!(
            "the triangles at the edge between vertices {a} and {b} are not oriented consistently (triangle {c})"
        ),
        DefectKind::DuplicateVertex => format!("vertices {a} and {b} have equal coordinates"),
        DefectKind::WrongNesting => {
            format!("the shell of triangle {a} is oriented against its nesting: solids face outward, voids inward")
        }
        DefectKind::ZeroVolume => format!("the shell of triangle {a} has no volume"),
        DefectKind::SelfIntersection => format!("triangles {a} and {b} meet outside what they share by index"),
        DefectKind::Empty => "the mesh has no triangles".into(),
        DefectKind::NonFinitePlane => format!("plane {a} has a coefficient that is not finite"),
        DefectKind::ZeroNormal => format!("plane {a} has a zero normal"),
        DefectKind::DegenerateSimplex => {
            format!("simplex {a} is degenerate: its corners lie in a plane (in two dimensions: on a line)")
        }
        DefectKind::OverlappingSimplices => {
            format!("simplices {a} and {b} lie on the same side of a face that they share")
        }
        DefectKind::UnbalancedEdge => {
            format!("operand {a}: its triangles do not balance at an edge (vertices {b} and {c}; -1: none)")
        }
    }
}

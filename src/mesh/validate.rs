//! Defects of a triangle list, each named by the ids of the input.
//!
//! Every check looks at what can be judged in spite of the other defects: a triangle with an index out of range has no
//! corners to be degenerate, but the other triangles have; edges at its remaining corners are not called open, since
//! the missing triangle may well be the one that closes them.
//!
//! Valid: non-manifold edges (any balanced number of uses) and vertices, several components, voids. Degenerate cases of
//! the checks themselves: −0 equals +0; a triangle with a repeated corner is degenerate and its sides cancel.
//!
//! Cost: linear, and n log n on 64-bit integers for duplicate vertices; exact arithmetic only for triangles that are
//! nearly degenerate.

use super::edges::EdgeTable;
use super::projection::collinear;
use crate::base::{Culprit, DefectKind, VertexId};

/// Vertices with a coordinate that is not finite.
pub fn non_finite(vertices: &[[f64; 3]], defects: &mut Vec<Culprit>) {
    for (v, x) in vertices.iter().enumerate() {
        if !is_finite(x) {
            defects.push(Culprit::new(DefectKind::NonFiniteCoordinate, &[v as i64]));
        }
    }
}

#[inline(always)]
pub fn is_finite(x: &[f64; 3]) -> bool {
    x[0].is_finite() & x[1].is_finite() & x[2].is_finite()
}

/// Corner indices outside `0..vertex_count`.
pub fn out_of_range(vertex_count: usize, triangles: &[[i32; 3]], defects: &mut Vec<Culprit>) {
    for (t, corners) in triangles.iter().enumerate() {
        if corners.iter().all(|&i| in_range(i, vertex_count)) {
            continue;
        }
        for (k, &i) in corners.iter().enumerate() {
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

/// Groups of vertices with equal coordinates, as pairs (lowest of the group, another), sorted. `used` lists the
/// vertices to compare, finite and without −0.
///
/// Sorted by 32 bits of a mixture of the coordinates (a sort of plain integers), then by the coordinates themselves
/// among equals.
pub fn duplicates(vertices: &[[f64; 3]], used: impl Iterator<Item = u32>) -> Vec<[u32; 2]> {
    let mut keys: Vec<u64> = used.map(|v| mixture(&vertices[v as usize]) | v as u64).collect();
    keys.sort_unstable();
    let mut pairs = Vec::new();
    let mut group: Vec<u32> = Vec::new();
    let mut start = 0;
    for i in 1..=keys.len() {
        if i < keys.len() && keys[i] >> 32 == keys[start] >> 32 {
            continue;
        }
        if i - start > 1 {
            group.clear();
            group.extend(keys[start..i].iter().map(|&k| k as u32));
            let bits = |&v: &u32| vertices[v as usize].map(f64::to_bits);
            group.sort_by(|a, b| bits(a).cmp(&bits(b)).then(a.cmp(b)));
            for same in group.chunk_by(|a, b| bits(a) == bits(b)) {
                pairs.extend(same[1..].iter().map(|&v| [same[0], v]));
            }
        }
        start = i;
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
pub fn degenerate(vertices: &[[f64; 3]], triangles: &[[VertexId; 3]], mut found: impl FnMut(usize)) {
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        let (pa, pb, pc) = (&vertices[a.at()], &vertices[b.at()], &vertices[c.at()]);
        let repeated = a == b || b == c || c == a;
        if repeated || ([pa, pb, pc].into_iter().all(is_finite) && collinear(pa, pb, pc)) {
            found(t);
        }
    }
}

/// Edges whose uses do not balance: `found(edge, kind)`.
pub fn unbalanced(table: &EdgeTable, mut found: impl FnMut(usize, DefectKind)) {
    for (e, uses) in table.edge_uses.rows().enumerate() {
        // The usual edge first: two uses, opposite.
        if uses.len() == 2 && uses[0].forward() != uses[1].forward() {
            continue;
        }
        let forward = uses.iter().filter(|u| u.forward()).count();
        if 2 * forward != uses.len() {
            let even = uses.len() % 2 == 0;
            found(e, if even { DefectKind::InconsistentOrientation } else { DefectKind::OpenEdge });
        }
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
    }
}

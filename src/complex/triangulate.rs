//! Faces as triangles, without new vertices. Every vertex and edge in the closure of a face is in its loops, and all
//! of them are used: straight angles, slits, isolated vertices.
//!
//! Nearly all faces are convex: one pass over the turns finds out, and a fan from the lexicographically smallest vertex (a
//! property of the points, not of their labels) is the answer, with no further decision unless there are straight
//! angles. Other faces are bridged into one polygon and clipped ear by ear. No triangle is degenerate, exactly.
//! Cost: linear for convex faces, see [`super::ears`] and [`super::bridge`] for others.

use super::bridge::{BridgeScratch, bridge_face};
use super::data::Complex;
use super::ears::{EarScratch, clip};
use super::projection::{Projection, compare_points, projection, turn};
use crate::base::{Csr, FaceId, VertexId};
use crate::exact::Sign;
use std::cmp::Ordering;
use std::collections::VecDeque;

/// Buffers reused from face to face.
#[derive(Default)]
pub struct TriangulateScratch {
    bridge: BridgeScratch,
    ears: EarScratch,
    polygon: Vec<VertexId>,
    turns: Vec<Sign>,
    ring: VecDeque<VertexId>,
}

/// The triangles of each face, oriented like it: row `f` holds those of face `f`. An error only where a face
/// contradicts itself (input that intersects itself, with the exact check off).
pub fn triangulated(c: &Complex) -> Result<Csr<[VertexId; 3]>, String> {
    let mut out = Csr::with_capacity(c.face_count(), c.corner_vertices.len());
    let mut scratch = TriangulateScratch::default();
    for f in (0..c.face_count()).map(FaceId::of) {
        triangulate_face(c, f, &mut scratch, &mut out.items)?;
        out.end_row();
    }
    Ok(out)
}

/// Appends the triangles of one face to `out`.
pub fn triangulate_face(
    c: &Complex,
    f: FaceId,
    s: &mut TriangulateScratch,
    out: &mut Vec<[VertexId; 3]>,
) -> Result<(), String> {
    let corners = &c.corner_vertices[c.face_corners(f)];
    let single = c.face_loops[f.at() + 1] - c.face_loops[f.at()] == 1;
    if single && corners.len() == 3 {
        out.push([corners[0], corners[1], corners[2]]);
        return Ok(());
    }
    let pr = projection(c, f);
    s.polygon.clear();
    if single {
        // From the smallest point on; a vertex met several times counts where it is met first, as loops do.
        let start = (0..corners.len()).reduce(|i, j| match compare_points(c, corners[j], corners[i]) {
            Ordering::Less => j,
            _ => i,
        });
        s.polygon.extend_from_slice(corners);
        s.polygon.rotate_left(start.unwrap_or(0));
        if convex(c, pr, s) {
            return fan(c, pr, s, out).map_err(|m| format!("face {}: {m}", f.0));
        }
    } else {
        bridge_face(c, f, &mut s.bridge, &mut s.polygon)?;
    }
    clip(c, pr, &s.polygon, &mut s.ears, out).map_err(|m| format!("face {}: {m}", f.0))
}

/// Fills the turns at all corners and tells whether none is to the right. A zero turn is a straight angle, except at
/// the tip of a slit, where the polygon goes back to where it came from.
fn convex(c: &Complex, pr: Projection, s: &mut TriangulateScratch) -> bool {
    let n = s.polygon.len();
    s.turns.clear();
    for i in 0..n {
        let (a, b, d) = (s.polygon[(i + n - 1) % n], s.polygon[i], s.polygon[(i + 1) % n]);
        let sign = turn(c, pr, a, b, d);
        if sign == Sign::Negative || sign == Sign::Zero && a == d {
            return false;
        }
        s.turns.push(sign);
    }
    true
}

/// A convex polygon whose first corner is strictly convex: a fan from there. With straight angles, a fan from one apex
/// after the other: a corner is cut off when it is strictly convex and the rest does not lie on one line, which
/// for a convex rest is the turn at its next corner as seen from the apex.
fn fan(c: &Complex, pr: Projection, s: &mut TriangulateScratch, out: &mut Vec<[VertexId; 3]>) -> Result<(), String> {
    let p = &mut s.polygon;
    if s.turns.iter().all(|&t| t == Sign::Positive) {
        out.extend((1..p.len() - 1).map(|i| [p[0], p[i], p[i + 1]]));
        return Ok(());
    }
    // A ring that is rotated: the apex is ring[0], the candidate ring[1].
    let ring = &mut s.ring;
    ring.clear();
    ring.extend(p.iter());
    let mut idle = 0;
    while ring.len() > 3 {
        let (a, b, d, e) = (ring[0], ring[1], ring[2], ring[3]);
        // The rest is a, d, e, ...; e on the line of d and a lies between them (beyond either, the polygon would
        // not be convex there), and so does then all the rest.
        if turn(c, pr, a, b, d) == Sign::Positive && turn(c, pr, d, e, a) != Sign::Zero {
            out.push([a, b, d]);
            ring.remove(1);
            idle = 0;
        } else {
            ring.rotate_left(1);
            idle += 1;
            if idle > ring.len() {
                return Err("its boundary crosses itself".into());
            }
        }
    }
    out.push([ring[0], ring[1], ring[2]]);
    Ok(())
}

//! Holes bridged: a face with holes as one weakly simple polygon, by bridges between existing vertices that cross nothing.
//!
//! One sweep over the face's corners in lexicographic order, with the strips of face between two edges as the state. A
//! hole's first corner lies strictly inside one strip; the bridge goes to the corner that last touched that strip.
//! No vertex and no edge lies between the two, so the bridge crosses nothing, exactly, and it goes to a smaller point;
//! so every hole is joined to the outer loop in the end.
//!
//! The sweep is over corners, not vertices: a vertex that a loop visits several times has one corner per sector of
//! face, and each is an event of its own. Loops of one connected face never share a vertex. Degenerate cases: equal
//! first coordinates (the order is lexicographic, as if the plane were sheared by an infinitesimal), slits (both sides of a slit
//! are boundaries of strips), isolated vertices (they split no strip, but are bridged and can carry bridges).
//! Cost: n log n comparisons for n corners, plus moving the strips of the state.

use super::data::Complex;
use super::projection::{Projection, compare, projection, turn};
use crate::base::{Csr, FaceId, VertexId};
use crate::exact::Sign;
use std::cmp::Ordering;

/// Face between a lower and an upper side, both named by the corner at which they start; a lower side is walked to
/// the right, an upper one to the left.
#[derive(Clone, Copy, Debug)]
struct Strip {
    lower: u32,
    upper: u32,
    /// The corner that touched this strip last: nothing lies between it and the sweep.
    last: u32,
}

/// What a corner does to the strips, in the order in which the corners at one vertex must do it: strips end before
/// those around them merge, and a strip is split before new ones start in between.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// Both sides to the left, convex: a strip ends.
    End,
    /// Both sides to the left, reflex (or the right tip of a slit): two strips become one.
    Merge,
    /// A strip goes on with another lower side.
    Lower,
    /// A strip goes on with another upper side.
    Upper,
    /// Both sides to the right, reflex (or the left tip of a slit): a strip is split. An isolated vertex only marks it.
    Split,
    /// Both sides to the right, convex: a new strip.
    Start,
}

/// A bridge's end at `corner`, leading to `to`; `own` where `corner` is the hole's.
#[derive(Clone, Copy, Debug)]
struct End {
    corner: u32,
    to: u32,
    own: bool,
}

/// Buffers reused from face to face.
#[derive(Default)]
pub struct BridgeScratch {
    next: Vec<u32>,
    prev: Vec<u32>,
    first_of_loop: Vec<u32>,
    kinds: Vec<Kind>,
    events: Vec<u32>,
    strips: Vec<Strip>,
    ends: Vec<End>,
    end_offsets: Vec<u32>,
    frames: Vec<Frame>,
    polygon: Vec<u32>,
}

/// A loop being walked: from `start`, now at `at`; bridges `ends[i..stop]` of this visit are still to be taken.
#[derive(Clone, Copy)]
struct Frame {
    start: u32,
    at: u32,
    i: u32,
    stop: u32,
    back: bool,
}

/// One face seen from the sweep: corners are numbered from the face's first.
struct Sweep<'a> {
    c: &'a Complex,
    pr: Projection,
    base: usize,
}

impl Sweep<'_> {
    fn vertex(&self, k: u32) -> VertexId {
        self.c.corner_vertices[self.base + k as usize]
    }
    /// `v` against the line of the lower side starting at corner `k` and ending at corner `n`: positive above.
    fn above(&self, k: u32, n: u32, v: VertexId) -> Sign {
        turn(self.c, self.pr, self.vertex(k), self.vertex(n), v)
    }
}

/// All faces as single polygons: one row of vertices per face, counter-clockwise about the face's normal. Faces without
/// holes are their outer loop. An error only where the face contradicts itself (input that intersects itself).
pub fn bridged(c: &Complex) -> Result<Csr<VertexId>, String> {
    let mut out = Csr::with_capacity(c.face_count(), c.corner_vertices.len());
    let mut scratch = BridgeScratch::default();
    for f in (0..c.face_count()).map(FaceId::of) {
        bridge_face(c, f, &mut scratch, &mut out.items)?;
        out.end_row();
    }
    Ok(out)
}

/// Appends one face's polygon to `out`.
pub fn bridge_face(c: &Complex, f: FaceId, s: &mut BridgeScratch, out: &mut Vec<VertexId>) -> Result<(), String> {
    let corners = c.face_corners(f);
    if c.face_loops[f.at() + 1] - c.face_loops[f.at()] == 1 {
        out.extend_from_slice(&c.corner_vertices[corners]);
        return Ok(());
    }
    let sweep = Sweep { c, pr: projection(c, f), base: corners.start };
    link(c, f, s);
    find_bridges(&sweep, s).map_err(|m| format!("face {}: {m}", f.0))?;
    sort_ends(&sweep, s);
    walk(s);
    out.extend(s.polygon.iter().map(|&k| sweep.vertex(k)));
    Ok(())
}

/// Next and previous corners, and the first corner of each corner's loop, numbered from the face's first corner.
fn link(c: &Complex, f: FaceId, s: &mut BridgeScratch) {
    let all = c.face_corners(f);
    let (base, n) = (all.start, all.len());
    s.next.clear();
    s.prev.clear();
    s.first_of_loop.clear();
    for l in c.loops_of(f) {
        let r = c.corners_of(l);
        let (a, b) = ((r.start - base) as u32, (r.end - base) as u32);
        for k in a..b {
            s.next.push(if k + 1 == b { a } else { k + 1 });
            s.prev.push(if k == a { b - 1 } else { k - 1 });
            s.first_of_loop.push(a);
        }
    }
    debug_assert_eq!(s.next.len(), n);
}

/// Fills `ends` with both ends of every bridge.
fn find_bridges(w: &Sweep, s: &mut BridgeScratch) -> Result<(), String> {
    let n = s.next.len() as u32;
    let (next, prev) = (&s.next, &s.prev);
    let later = |k: u32, other: u32| compare(w.c, w.pr, w.vertex(k), w.vertex(other)) == Ordering::Less;
    s.kinds.clear();
    s.kinds.extend((0..n).map(|k| {
        let (after, before) = (next[k as usize], prev[k as usize]);
        let convex = || turn(w.c, w.pr, w.vertex(before), w.vertex(k), w.vertex(after)) == Sign::Positive;
        match (after == k, later(k, after), later(k, before)) {
            (true, ..) => Kind::Split,
            (_, false, false) if convex() => Kind::End,
            (_, false, false) => Kind::Merge,
            (_, true, false) => Kind::Lower,
            (_, false, true) => Kind::Upper,
            (_, true, true) if convex() => Kind::Start,
            (_, true, true) => Kind::Split,
        }
    }));
    let kinds = &s.kinds;
    s.events.clear();
    s.events.extend(0..n);
    s.events.sort_by(|&a, &b| {
        compare(w.c, w.pr, w.vertex(a), w.vertex(b))
            .then_with(|| kinds[a as usize].cmp(&kinds[b as usize]))
            .then(a.cmp(&b))
    });
    s.strips.clear();
    s.ends.clear();
    let strips = &mut s.strips;
    // Whether a loop has been met; the outer loop needs no bridge.
    let mut met = vec![false; n as usize];
    met[0] = true;
    for &k in &s.events {
        let v = w.vertex(k);
        let (after, before) = (next[k as usize], prev[k as usize]);
        // Strips whose lower side is strictly below v.
        let below = strips.partition_point(|t| {
            let (a, b) = (t.lower, next[t.lower as usize]);
            w.vertex(a) != v && w.vertex(b) != v && w.above(a, b, v) == Sign::Positive
        });
        let kind = kinds[k as usize];
        let isolated = after == k;
        let first = s.first_of_loop[k as usize] as usize;
        if kind == Kind::Split {
            // Strictly inside a strip: nothing ends or starts at v but this corner's own sides and other starts.
            let Some(i) = below.checked_sub(1) else { return Err("a hole outside".into()) };
            let strip = strips[i];
            if !met[first] {
                met[first] = true;
                s.ends.push(End { corner: k, to: strip.last, own: true });
                s.ends.push(End { corner: strip.last, to: k, own: false });
            }
            if isolated {
                strips[i].last = k;
            } else {
                strips[i] = Strip { lower: strip.lower, upper: before, last: k };
                strips.insert(i + 1, Strip { lower: k, upper: strip.upper, last: k });
            }
        } else if kind == Kind::Start {
            // Of the lower sides that start at v as well, those below the new one.
            let at = strips.partition_point(|t| {
                let (a, b) = (t.lower, next[t.lower as usize]);
                if w.vertex(a) == v {
                    turn(w.c, w.pr, v, w.vertex(b), w.vertex(after)) == Sign::Positive
                } else {
                    w.above(a, b, v) == Sign::Positive
                }
            });
            strips.insert(at, Strip { lower: k, upper: before, last: k });
        } else {
            // A strip at v: the last one strictly below, or one whose lower side touches v.
            let mut i = below.saturating_sub(1);
            let wanted = |t: &Strip| if kind == Kind::Lower { t.lower == before } else { t.upper == k };
            while i < strips.len() && !wanted(&strips[i]) {
                let (a, b) = (strips[i].lower, next[strips[i].lower as usize]);
                if i >= below && w.vertex(a) != v && w.vertex(b) != v {
                    return Err("its loops cross".into());
                }
                i += 1;
            }
            if i == strips.len() {
                return Err("its loops cross".into());
            }
            if kind == Kind::Lower {
                strips[i] = Strip { lower: k, upper: strips[i].upper, last: k };
            } else if kind == Kind::Upper {
                strips[i] = Strip { lower: strips[i].lower, upper: before, last: k };
            } else if kind == Kind::End {
                if strips[i].lower != before {
                    return Err("its loops cross".into());
                }
                strips.remove(i);
            } else {
                if strips.get(i + 1).is_none_or(|t| t.lower != before) {
                    return Err("its loops cross".into());
                }
                strips[i] = Strip { lower: strips[i].lower, upper: strips[i + 1].upper, last: k };
                strips.remove(i + 1);
            }
        }
    }
    Ok(())
}

/// Orders the bridges' ends by corner, and at one corner clockwise through its sector from the side on which the
/// polygon arrives: the order in which a walk with the face on its left meets them.
fn sort_ends(w: &Sweep, s: &mut BridgeScratch) {
    let n = s.next.len();
    s.ends.sort_by_key(|e| e.corner);
    s.end_offsets.clear();
    s.end_offsets.resize(n + 1, 0);
    for e in &s.ends {
        s.end_offsets[e.corner as usize + 1] += 1;
    }
    for k in 0..n {
        s.end_offsets[k + 1] += s.end_offsets[k];
        let group = &mut s.ends[s.end_offsets[k] as usize..s.end_offsets[k + 1] as usize];
        if group.len() < 2 {
            continue;
        }
        let at = w.vertex(k as u32);
        // An isolated vertex is entered and left by its own bridge, which so is the first.
        let arrive = if s.next[k] == k as u32 {
            let own = group.iter().position(|e| e.own).unwrap_or(0);
            group.swap(0, own);
            w.vertex(group[0].to)
        } else {
            w.vertex(s.prev[k])
        };
        // Clockwise from the arriving side: below half a turn, half a turn, above; zero only for that side itself.
        let half = |e: &End| match turn(w.c, w.pr, at, arrive, w.vertex(e.to)) {
            _ if w.vertex(e.to) == arrive => 0,
            Sign::Negative => 1,
            Sign::Zero => 2,
            Sign::Positive => 3,
        };
        for i in 1..group.len() {
            let mut j = i;
            while j > 0 {
                let (a, b) = (half(&group[j - 1]), half(&group[j]));
                let (p, q) = (w.vertex(group[j - 1].to), w.vertex(group[j].to));
                if a < b || a == b && turn(w.c, w.pr, at, p, q) != Sign::Positive {
                    break;
                }
                group.swap(j - 1, j);
                j -= 1;
            }
        }
    }
}

/// The polygon: the outer loop, and at each bridge the hole that it leads to, from the hole's corner round to it again.
fn walk(s: &mut BridgeScratch) {
    let (ends, offsets) = (&s.ends, &s.end_offsets);
    // A hole's first corner is visited twice: on arrival the ends clockwise after its own bridge are met, on return
    // those before it.
    let own = |k: u32| {
        let r = offsets[k as usize]..offsets[k as usize + 1];
        r.clone().find(|&i| ends[i as usize].own).map_or((r.start, r.start), |i| (i + 1, i))
    };
    let out = &mut s.polygon;
    out.clear();
    s.frames.clear();
    s.frames.push(Frame { start: 0, at: 0, i: offsets[0], stop: offsets[1], back: false });
    out.push(0);
    while !s.frames.is_empty() {
        let last = s.frames.len() - 1;
        let (top, outer) = (&mut s.frames[last], last == 0);
        if top.i < top.stop {
            let hole = ends[top.i as usize].to;
            top.i += 1;
            out.push(hole);
            s.frames.push(Frame {
                start: hole,
                at: hole,
                i: own(hole).0,
                stop: offsets[hole as usize + 1],
                back: false,
            });
            continue;
        }
        let next = s.next[top.at as usize];
        if !top.back && next != top.start {
            (top.at, top.i, top.stop) = (next, offsets[next as usize], offsets[next as usize + 1]);
            out.push(next);
            continue;
        }
        if !top.back && top.at != next && !outer {
            *top = Frame { start: next, at: next, i: offsets[next as usize], stop: own(next).1, back: true };
            out.push(next);
            continue;
        }
        s.frames.pop();
        if let Some(parent) = s.frames.last() {
            out.push(parent.at);
        }
    }
}

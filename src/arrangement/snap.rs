//! Snapping where triangles meet that should not: what is nearer than a given distance comes to be shared by index.
//!
//! Of the triangles in contact, corners near one another become one; edges are split at corners near them, and two edges near one another at
//! a common new corner; a triangle is split at a corner near its inside. Two sheets that rounding has entangled so come to have the same
//! corners and edges there, hence the same triangles, which cancel.
//!
//! Invariant: each step is a map of complexes (corners onto corners, after a subdivision), so what was closed remains closed, with the same
//! orientation. Distances are judged in doubles: they only propose. Nothing further than the distance moves or is bent.
//!
//! Cost: a microsecond for each pair of triangles in contact; linear in triangles.

use crate::base::vector::{cross, dot, length, minus};
use crate::base::{TriangleId, UnionFind};
use std::collections::BTreeMap;

/// Triangles after snapping, and the one that each is a part of.
#[derive(Default)]
pub struct Snapped {
    pub triangles: Vec<[i32; 3]>,
    pub source: Vec<u32>,
    /// Corners merged, and places where an edge or a triangle was split.
    pub count: usize,
    /// How far a coordinate of the surface may have gone.
    pub moved: f64,
}

impl Snapped {
    /// As many triangles run along each edge as against it; three corners each.
    pub fn check(&self) -> Result<(), String> {
        if self.source.len() != self.triangles.len() {
            return Err("as many sources as triangles".into());
        }
        if let Some(t) = self.triangles.iter().find(|t| !whole(t)) {
            return Err(format!("a triangle on {t:?}"));
        }
        let mut sides: Vec<([i32; 2], bool)> =
            self.triangles.iter().flat_map(|t| [0, 1, 2].map(|i| (edge(t, i), t[i] < t[(i + 1) % 3]))).collect();
        sides.sort_unstable();
        let open = |same: &&[([i32; 2], bool)]| 2 * same.iter().filter(|s| s.1).count() != same.len();
        match sides.chunk_by(|a, b| a.0 == b.0).find(open) {
            Some(same) => Err(format!("the edge {:?} is open", same[0].0)),
            None => Ok(()),
        }
    }
}

/// A place on an edge, lower end first, where it is split.
type Split = ([i32; 2], f64, i32);

/// Snaps around contacts. New corners are added behind the others.
pub fn snap(coords: &mut Vec<[f64; 3]>, triangles: &[[i32; 3]], contacts: &[[TriangleId; 2]], near: f64) -> Snapped {
    let mut sets = UnionFind::new(coords.len());
    let mut count = 0;
    for pair in contacts {
        let corners: Vec<usize> = pair.iter().flat_map(|t| triangles[t.at()]).map(|v| v as usize).collect();
        for (i, &v) in corners.iter().enumerate() {
            for &w in &corners[..i] {
                if v != w && length(minus(coords[v], coords[w])) <= near {
                    count += sets.union(v, w) as usize;
                }
            }
        }
    }
    let now = |t: &[i32; 3], sets: &mut UnionFind| t.map(|v| sets.find(v as usize) as i32);
    let merged: Vec<[i32; 3]> = triangles.iter().map(|t| now(t, &mut sets)).collect();
    let mut splits: Vec<Split> = Vec::new();
    let mut inner: BTreeMap<u32, i32> = BTreeMap::new();
    let mut crossings: BTreeMap<[[i32; 2]; 2], i32> = BTreeMap::new();
    for [p, q] in contacts {
        for (t, other) in [(p, q), (q, p)] {
            let (t_corners, other) = (merged[t.at()], merged[other.at()]);
            if !whole(&t_corners) {
                continue;
            }
            for v in t_corners {
                near_edges(coords, &t_corners, v, near, &mut splits);
            }
            for v in other.into_iter().filter(|v| !t_corners.contains(v)) {
                if !near_edges(coords, &t_corners, v, near, &mut splits)
                    && near_inside(coords, &t_corners, coords[v as usize], near)
                {
                    inner.entry(t.0).or_insert(v);
                }
            }
        }
        let (p, q) = (merged[p.at()], merged[q.at()]);
        if whole(&p) && whole(&q) {
            for (e, f) in (0..9).map(|k| (edge(&p, k / 3), edge(&q, k % 3))) {
                near_crossing(coords, [e.min(f), e.max(f)], near, &mut splits, &mut crossings);
            }
        }
    }
    splits.sort_by(|a, b| (a.0, a.2).cmp(&(b.0, b.2)).then(a.1.total_cmp(&b.1)));
    splits.dedup_by_key(|s| (s.0, s.2));
    splits.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    count += splits.len() + inner.len();
    let mut out = Snapped { triangles: Vec::with_capacity(merged.len()), source: Vec::new(), count, moved: near };
    for (t, &corners) in merged.iter().enumerate() {
        let lists = [0, 1, 2].map(|i| split_list(&splits, corners[i], corners[(i + 1) % 3]));
        match inner.get(&(t as u32)) {
            Some(&v) => {
                for (i, list) in lists.into_iter().enumerate() {
                    let part = [corners[i], corners[(i + 1) % 3], v];
                    split_by(part, [list, Vec::new(), Vec::new()], |t| out.triangles.push(t));
                }
            }
            None => split_by(corners, lists, |t| out.triangles.push(t)),
        }
        out.source.resize(out.triangles.len(), t as u32);
    }
    out
}

fn whole(t: &[i32; 3]) -> bool {
    t[0] != t[1] && t[1] != t[2] && t[2] != t[0]
}

/// Splits a triangle at corners on its edges, from each corner to the next in this order. Parts that lose a corner are left out.
pub(super) fn split_by(corners: [i32; 3], lists: [Vec<i32>; 3], mut out: impl FnMut([i32; 3])) {
    let mut stack: Vec<Piece> = vec![(corners, lists)];
    while let Some(piece) = stack.pop() {
        match halves(piece) {
            Ok(two) => stack.extend(two),
            Err(t) if whole(&t) => out(t),
            Err(_) => {}
        }
    }
}

/// Corners, and where each edge from one to the next is split still, in this direction.
type Piece = ([i32; 3], [Vec<i32>; 3]);

/// The two parts on either side of a split, or the triangle that has none.
fn halves((corners, mut lists): Piece) -> Result<[Piece; 2], [i32; 3]> {
    let Some(i) = (0..3).max_by_key(|&i| lists[i].len()).filter(|&i| !lists[i].is_empty()) else {
        return Err(corners);
    };
    let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
    let [mut before, next, last] = [0, 1, 2].map(|k| std::mem::take(&mut lists[(i + k) % 3]));
    let behind = before.split_off(before.len() / 2 + 1);
    let Some(m) = before.pop() else { return Err(corners) };
    Ok([([a, m, c], [before, Vec::new(), last]), ([m, b, c], [behind, next, Vec::new()])])
}

fn split_list(splits: &[Split], from: i32, to: i32) -> Vec<i32> {
    let name = [from.min(to), from.max(to)];
    let start = splits.partition_point(|s| s.0 < name);
    let mut list: Vec<i32> = splits[start..].iter().take_while(|s| s.0 == name).map(|s| s.2).collect();
    if from > to {
        list.reverse();
    }
    list
}

fn edge(t: &[i32; 3], i: usize) -> [i32; 2] {
    let (a, b) = (t[i], t[(i + 1) % 3]);
    [a.min(b), a.max(b)]
}

/// Splits the edges of a triangle that are near a corner and do not end there. Returns whether there are any.
pub(super) fn near_edges(coords: &[[f64; 3]], t: &[i32; 3], v: i32, near: f64, splits: &mut Vec<Split>) -> bool {
    let before = splits.len();
    for e in [0, 1, 2].map(|i| edge(t, i)).into_iter().filter(|e| !e.contains(&v)) {
        let [a, b] = e.map(|w| coords[w as usize]);
        let (along, to) = (minus(b, a), minus(coords[v as usize], a));
        let s = dot(to, along) / dot(along, along);
        if s > 0.0 && s < 1.0 && length(cross(to, along)) <= near * length(along) {
            splits.push((e, s, v));
        }
    }
    splits.len() > before
}

/// Whether a point is near the inside of a triangle.
fn near_inside(coords: &[[f64; 3]], t: &[i32; 3], x: [f64; 3], near: f64) -> bool {
    let [a, b, c] = t.map(|v| coords[v as usize]);
    let normal = cross(minus(b, a), minus(c, a));
    let inside = [(a, b), (b, c), (c, a)].iter().all(|&(p, q)| dot(cross(minus(q, p), minus(x, p)), normal) > 0.0);
    inside && dot(minus(x, a), normal).abs() <= near * length(normal)
}

/// Splits two edges at a common new corner where they pass near one another.
fn near_crossing(
    coords: &mut Vec<[f64; 3]>,
    edges: [[i32; 2]; 2],
    near: f64,
    splits: &mut Vec<Split>,
    crossings: &mut BTreeMap<[[i32; 2]; 2], i32>,
) {
    let [e, f] = edges;
    if e.iter().any(|v| f.contains(v)) || crossings.contains_key(&edges) {
        return;
    }
    let [[a, b], [c, d]] = edges.map(|e| e.map(|v| coords[v as usize]));
    let (u, v, w) = (minus(b, a), minus(d, c), minus(c, a));
    let normal = cross(u, v);
    let square = dot(normal, normal);
    let (s, t) = (dot(cross(w, v), normal) / square, dot(cross(w, u), normal) / square);
    // Edges that are nearly parallel pass near one another's ends, if they do at all.
    let inside = |x: f64| x > 0.0 && x < 1.0;
    if !(inside(s) && inside(t)) || dot(w, normal).abs() > near * square.sqrt() {
        return;
    }
    let [x, y]: [[f64; 3]; 2] =
        [(a, u, s), (c, v, t)].map(|(from, along, s)| std::array::from_fn(|i| from[i] + s * along[i]));
    let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * x[i] + 0.5 * y[i]);
    if [a, b, c, d].iter().any(|&end| length(minus(middle, end)) <= near) {
        return;
    }
    let new = coords.len() as i32;
    coords.push(middle);
    crossings.insert(edges, new);
    splits.extend([(e, s, new), (f, t, new)]);
}

//! What the repair works on: the triangles of a complex with the shells on either side of each, over doubles that may move
//! and vertices that may merge.
//!
//! Invariant: every triangle stands for itself in the shell behind it and, reversed, in the shell before it (the outside
//! counts as a shell), so the triangles of a shell always close. Merging vertices keeps that: a triangle that loses a
//! corner is nothing, and triangles that come to have the same corners are added up, shell by shell. Only sums with one
//! shell behind and one before (or none at all) are accepted: then it is a triangulated complex again. A shell whose
//! triangles are all gone is gone, and with its outer shell a cell.

use super::data::Complex;
use crate::base::{Csr, FaceId, ShellId, TriangleId, VertexId};

/// Triangles between shells.
pub struct Work {
    pub coords: Vec<[f64; 3]>,
    pub triangles: Vec<[VertexId; 3]>,
    /// The face that each triangle is a part of, never falling.
    pub face: Vec<FaceId>,
    /// The shells behind and before each triangle; `NONE` is the outside.
    pub shells: Vec<[ShellId; 2]>,
    /// False for triangles that are gone; they keep their place.
    pub alive: Vec<bool>,
    /// The vertex that each vertex was merged into (which may have been merged in turn): itself, if it was not.
    pub merged: Vec<VertexId>,
}

impl Work {
    pub fn new(c: &Complex, rows: &Csr<[VertexId; 3]>) -> Self {
        let n = rows.items.len();
        let mut face = Vec::with_capacity(n);
        for f in 0..c.face_count() {
            face.resize(rows.offsets[f + 1] as usize, FaceId::of(f));
        }
        let mut shell_of = vec![ShellId::NONE; 2 * c.face_count()];
        for s in 0..c.shell_faces.len() {
            c.shell_faces.row(s).iter().for_each(|h| shell_of[h.at()] = ShellId::of(s));
        }
        Self {
            coords: c.coords.clone(),
            triangles: rows.items.clone(),
            shells: face.iter().map(|f| [2 * f.at(), 2 * f.at() + 1].map(|h| shell_of[h])).collect(),
            face,
            alive: vec![true; n],
            merged: (0..c.vertex_count()).map(VertexId::of).collect(),
        }
    }

    pub fn corners(&self, t: TriangleId) -> [[f64; 3]; 3] {
        self.triangles[t.at()].map(|v| self.coords[v.at()])
    }

    /// The vertex that stands for `v` now. Merges are few, and chains of them short.
    pub fn now(&self, mut v: VertexId) -> VertexId {
        while self.merged[v.at()] != v {
            v = self.merged[v.at()];
        }
        v
    }

    /// Merges `group` into its first vertex, given the triangles at all of them, rising and each once. The triangles that
    /// changed are appended to `changed`. False, and nothing changes, if that would not leave a complex.
    pub fn merge(&mut self, group: &[VertexId], around: &[TriangleId], changed: &mut Vec<TriangleId>) -> bool {
        let into = group[0];
        let done = self.add_up(around, |v| if group.contains(&v) { into } else { v }, changed);
        if done {
            for &v in group {
                self.merged[v.at()] = into;
            }
        }
        done
    }

    /// Renames the corners of `some` triangles (rising) and adds up those that are equal then.
    pub fn add_up(
        &mut self,
        some: &[TriangleId],
        renamed: impl Fn(VertexId) -> VertexId,
        changed: &mut Vec<TriangleId>,
    ) -> bool {
        // Sorted corners, whether sorting kept the orientation, triangle.
        let mut left: Vec<([VertexId; 3], bool, TriangleId)> = Vec::with_capacity(some.len());
        for &t in some {
            let [a, b, c] = self.triangles[t.at()].map(&renamed);
            if a != b && b != c && c != a {
                let (sorted, even) = sort_corners([a, b, c]);
                left.push((sorted, even, t));
            }
        }
        left.sort_unstable_by_key(|&(corners, _, t)| (corners, t));
        // For each set of equal triangles, the shells behind and before what is left of them.
        let mut sums: Vec<(TriangleId, bool, Option<[ShellId; 2]>)> = Vec::with_capacity(left.len());
        for equal in left.chunk_by(|x, y| x.0 == y.0) {
            let Some(sum) = self.sum(equal) else { return false };
            sums.push((equal[0].2, equal[0].1, sum));
        }
        for &t in some {
            self.alive[t.at()] = false;
        }
        for (t, even, sum) in sums {
            let Some([behind, before]) = sum else { continue };
            // The lowest stands for all, looking its own way.
            self.shells[t.at()] = if even { [behind, before] } else { [before, behind] };
            self.triangles[t.at()] = self.triangles[t.at()].map(&renamed);
            self.alive[t.at()] = true;
            changed.push(t);
        }
        true
    }

    /// The shells behind and before what equal triangles add up to, for their corners in sorted order; `Some(None)` if
    /// they cancel; `None` if more than one triangle would be left.
    fn sum(&self, equal: &[([VertexId; 3], bool, TriangleId)]) -> Option<Option<[ShellId; 2]>> {
        if let [one] = equal {
            return Some(Some(self.oriented(*one)));
        }
        let both = |&x| {
            let [behind, before] = self.oriented(x);
            [(behind, 1), (before, -1)]
        };
        let mut terms: Vec<(ShellId, i32)> = equal.iter().flat_map(both).collect();
        terms.sort_unstable();
        let nets = terms.chunk_by(|x, y| x.0 == y.0).map(|s| (s[0].0, s.iter().map(|x| x.1).sum::<i32>()));
        let mut nets = nets.filter(|x| x.1 != 0);
        match (nets.next(), nets.next(), nets.next()) {
            (None, ..) => Some(None),
            (Some((behind, 1)), Some((before, -1)), None) | (Some((before, -1)), Some((behind, 1)), None) => {
                Some(Some([behind, before]))
            }
            _ => None,
        }
    }

    fn oriented(&self, (_, even, t): ([VertexId; 3], bool, TriangleId)) -> [ShellId; 2] {
        let [a, b] = self.shells[t.at()];
        if even { [a, b] } else { [b, a] }
    }
}

/// Corners in rising order, and whether they turn the same way.
pub fn sort_corners([a, b, c]: [VertexId; 3]) -> ([VertexId; 3], bool) {
    let mut s = [a, b, c];
    s.sort_unstable();
    (s, s == [a, b, c] || s == [b, c, a] || s == [c, a, b])
}

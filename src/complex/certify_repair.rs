//! Local repairs of a triangulated complex on doubles: flips, moves, merges.
//!
//! Each looks at one defect at a time, in the order of triangles, and a flip or a move stays if the triangles around it
//! then have fewer defects (triangles without area weigh most). Merges are kept whenever they leave a complex: they end.
//! So the result depends on the complex alone.
//!
//! - *Flip*: the diagonal between two triangles of one face. It costs nothing, no vertex moves. With equal defects (or,
//!   for slivers, some more) it is flipped as well if the lower of the two triangles gets higher: so
//!   a fan of slivers along nearly straight edges is taken apart.
//! - *Move*: a vertex by a few units, one unit being an ulp of the largest |coordinate| of the bounding box. The first
//!   directions tried are those of the TopoCut paper's section 6.1: the normals of the faces that it may be on the wrong side of, and
//!   the lines on which it may be in the wrong order; then axes and diagonals.
//! - *Merge*: vertices at one place, later a few units apart. Cells too thin for doubles go this way.
//!
//! Vertices of the input mesh take part in moves and in merges with each other only in the last levels: the host has
//! them too, and what nothing has cut relies on them. Fixed vertices never do.
//!
//! One box hierarchy serves all rounds: nothing moves further than [`REACH`], and flipped triangles are found through each
//! other's boxes. Cost: some hundred pairs of triangles for each attempt; most attempts end with the pairs in contact.

use super::certify_check::{apart, degenerate};
use super::certify_work::{Work, sort_corners};
use super::data::Complex;
use crate::base::vector::{cross, length, minus};
use crate::base::{Csr, TriangleId, UnionFind, VertexId};
use crate::mesh::bvh::Bvh;
use crate::mesh::self_intersection::contact;

/// Boxes are widened by this many units when neighbours are looked for: more than all moves since the hierarchy was built.
const REACH: f64 = 4096.0;
/// A triangle without area weighs as much as this many contacts: it may hide some.
const FLAT: usize = 1000;
/// Levels of effort, from merges of equal vertices only to merges over 2^(LEVELS - 2) units.
pub const LEVELS: u32 = 10;
/// From here on, vertices of the mesh move too, and vertices merge that no edge joins.
const LAST_RESORT: u32 = 5;
/// A triangle whose height is less than this part of the edge to be flipped is a sliver: worth many contacts to be rid of, since
/// the next flips take them.
const SLIVER: f64 = 1.0 / 1024.0;
const SLACK: usize = 64;
/// More rounds of flips than any chain of flips has needed, by far.
const FLIP_ROUNDS: usize = 32;

/// Two triangles in contact, or twice a triangle without area.
pub type Defect = [TriangleId; 2];

/// A repair going on.
pub struct Mender<'a> {
    complex: &'a Complex,
    pub work: &'a mut Work,
    bvh: &'a Bvh,
    /// Origins in the mesh; fixed by the caller.
    mesh: &'a [bool],
    fixed: &'a [bool],
    unit: f64,
    /// Rings of triangles that were flipped with each other: where the hierarchy finds one, all may be.
    ring: Vec<TriangleId>,
    /// What changed since the last look.
    changed: Vec<TriangleId>,
    /// All that ever changed.
    pub touched: Vec<TriangleId>,
    pub defects: Vec<Defect>,
    near: Vec<TriangleId>,
    pairs: Vec<Defect>,
}

impl<'a> Mender<'a> {
    pub fn new(
        complex: &'a Complex,
        work: &'a mut Work,
        bvh: &'a Bvh,
        mesh: &'a [bool],
        fixed: &'a [bool],
        unit: f64,
        defects: Vec<Defect>,
    ) -> Self {
        let ring = (0..work.triangles.len()).map(TriangleId::of).collect();
        let (changed, touched, near, pairs) = Default::default();
        Self { complex, work, bvh, mesh, fixed, unit, ring, changed, touched, defects, near, pairs }
    }

    /// One level of effort. Afterwards `defects` are what is left, as far as the neighbourhoods tell.
    pub fn level(&mut self, level: u32) {
        let last_resort = level >= LAST_RESORT;
        let reach = if level == 0 { 0.0 } else { (1u32 << (level - 1)) as f64 };
        self.merges(reach * self.unit, last_resort);
        self.look();
        for _ in 0..FLIP_ROUNDS {
            if self.defects.is_empty() || !self.flips() {
                break;
            }
            self.look();
        }
        self.moves(4 << level.min(6), last_resort);
        self.look();
    }

    /// Finds the defects again around what changed.
    fn look(&mut self) {
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        changed.retain(|t| self.work.alive[t.at()]);
        let mut found = std::mem::take(&mut self.defects);
        found.retain(|&d| self.open(d));
        self.collect_pairs(&changed);
        found.extend(self.pairs.iter().filter(|&&p| self.meets(p)).map(|&[a, b]| [a.min(b), a.max(b)]));
        found.extend(changed.iter().filter(|t| self.flat(**t)).map(|&t| [t, t]));
        found.sort_unstable();
        found.dedup();
        self.defects = found;
        self.touched.append(&mut changed);
        self.changed = changed;
    }

    /// Whether a defect is still there.
    fn open(&self, [a, b]: Defect) -> bool {
        self.work.alive[a.at()]
            && self.work.alive[b.at()]
            && if a == b { self.flat(a) } else { self.meets([a, b]) || self.flat(a) || self.flat(b) }
    }

    fn flat(&self, t: TriangleId) -> bool {
        degenerate(&self.work.coords, &self.work.triangles[t.at()])
    }

    fn meets(&self, [a, b]: Defect) -> bool {
        let w = &*self.work;
        let (p, q) = (&w.triangles[a.at()], &w.triangles[b.at()]);
        !apart(&w.coords, p, q) && !self.flat(a) && !self.flat(b) && contact(&w.coords, p, q)
    }

    /// The living triangles near the box of some points, rising, in `self.near`.
    fn find_near(&mut self, points: &[[f64; 3]]) {
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in points {
            for i in 0..3 {
                lo[i] = lo[i].min(p[i] - REACH * self.unit);
                hi[i] = hi[i].max(p[i] + REACH * self.unit);
            }
        }
        let (out, ring, alive) = (&mut self.near, &self.ring, &self.work.alive);
        out.clear();
        self.bvh.meeting_box(&lo, &hi, |first| {
            let mut t = first;
            loop {
                if alive[t.at()] {
                    out.push(t);
                }
                t = ring[t.at()];
                if t == first {
                    break;
                }
            }
        });
        out.sort_unstable();
        out.dedup();
    }

    /// The living triangles at a vertex, rising.
    fn star(&mut self, v: VertexId) -> Vec<TriangleId> {
        self.find_near(&[self.work.coords[v.at()]]);
        self.near.iter().copied().filter(|t| self.work.triangles[t.at()].contains(&v)).collect()
    }

    /// All pairs of one of `changed` (rising) with any triangle near it, in `self.pairs`.
    fn collect_pairs(&mut self, changed: &[TriangleId]) {
        self.pairs.clear();
        for &t in changed {
            self.find_near(&self.work.corners(t));
            let others = self.near.iter().filter(|&&o| o != t && (o > t || changed.binary_search(&o).is_err()));
            self.pairs.extend(others.map(|&o| [t, o]));
        }
    }

    /// What is wrong with `changed` now; pairs in contact come first in `self.pairs` afterwards.
    fn weigh(&mut self, changed: &[TriangleId]) -> usize {
        self.collect_pairs(changed);
        let mut first = 0;
        for i in 0..self.pairs.len() {
            if self.meets(self.pairs[i]) {
                self.pairs.swap(first, i);
                first += 1;
            }
        }
        first + FLAT * changed.iter().filter(|t| self.flat(**t)).count()
    }

    /// The same for the pairs at hand; `limit` if it is no less.
    fn weigh_again(&self, changed: &[TriangleId], limit: usize) -> usize {
        let mut weight = FLAT * changed.iter().filter(|t| self.flat(**t)).count();
        for &p in &self.pairs {
            if weight >= limit {
                return limit;
            }
            weight += self.meets(p) as usize;
        }
        weight.min(limit)
    }

    /// Tries a flip over each side of the triangles in defects; whether there was one.
    fn flips(&mut self) -> bool {
        let mut any = false;
        for i in 0..self.defects.len() {
            for t in self.defects[i] {
                for side in 0..3 {
                    if self.work.alive[t.at()]
                        && self.open(self.defects[i])
                        && let Some(o) = self.mate(t, side)
                    {
                        any |= self.flip(t, o, side);
                    }
                }
            }
        }
        any
    }

    /// The triangle of the same face across a side of `t`, if that side is not an edge of the face.
    fn mate(&mut self, t: TriangleId, side: usize) -> Option<TriangleId> {
        let corners = self.work.triangles[t.at()];
        let (u, v) = (corners[side], corners[(side + 1) % 3]);
        self.find_near(&[self.work.coords[u.at()], self.work.coords[v.at()]]);
        let w = &*self.work;
        let across = |o: &&TriangleId| {
            let q = w.triangles[o.at()];
            w.face[o.at()] == w.face[t.at()] && (0..3).any(|k| q[k] == v && q[(k + 1) % 3] == u)
        };
        let mate = *self.near.iter().find(across)?;
        let c = self.complex;
        let mut loops = c.loops_of(w.face[t.at()]).map(|l| &c.corner_vertices[c.corners_of(l)]);
        let is_edge = loops.any(|l| {
            (0..l.len()).any(|k| {
                let (a, b) = (w.now(l[k]), w.now(l[(k + 1) % l.len()]));
                (a, b) == (u, v) || (a, b) == (v, u)
            })
        });
        (!is_edge && w.shells[t.at()] == w.shells[mate.at()]).then_some(mate)
    }

    /// Flips the edge between two triangles if that is better.
    fn flip(&mut self, a: TriangleId, b: TriangleId, side: usize) -> bool {
        let (p, q) = (self.work.triangles[a.at()], self.work.triangles[b.at()]);
        let (u, v, x) = (p[side], p[(side + 1) % 3], p[(side + 2) % 3]);
        let Some(y) = q.into_iter().find(|z| *z != u && *z != v) else { return false };
        if x == y {
            return false;
        }
        let changed = [a.min(b), a.max(b)];
        let before = self.weigh(&changed);
        let height = |m: &Self| m.height(a).min(m.height(b));
        let low = height(self);
        self.work.triangles[a.at()] = [x, u, y];
        self.work.triangles[b.at()] = [y, v, x];
        let [from, to] = [u, v].map(|z| self.work.coords[z.at()]);
        let allowed = if low < SLIVER * length(minus(from, to)) { before + SLACK } else { before };
        let now = self.weigh_again(&changed, allowed + 1);
        // An edge that is there already would be one too many, unless both triangles are: then four add up to what
        // is left of a flat piece of a cell.
        let with_edge = |m: &Self| {
            let other = |t: &&TriangleId| {
                let corners = &m.work.triangles[t.at()];
                !changed.contains(t) && corners.contains(&x) && corners.contains(&y)
            };
            let mut found: Vec<TriangleId> = m.pairs.iter().flatten().filter(other).copied().collect();
            found.sort_unstable();
            found.dedup();
            found
        };
        let mut there = with_edge(self);
        if there.is_empty() && (now < before || now <= allowed && height(self) > low) {
            self.join_rings(a, b);
            self.changed.extend(changed);
            return true;
        }
        let sorted = |m: &Self, t: TriangleId| sort_corners(m.work.triangles[t.at()]).0;
        let new = changed.map(|t| sorted(self, t));
        there.retain(|&t| new.contains(&sorted(self, t)));
        if there.len() == 2 {
            there.extend(changed);
            there.sort_unstable();
            if self.work.add_up(&there, |v| v, &mut self.changed) {
                there.iter().for_each(|&t| self.join_rings(a, t));
                return true;
            }
        }
        (self.work.triangles[a.at()], self.work.triangles[b.at()]) = (p, q);
        false
    }

    /// About a triangle's least height: a preference, no decision.
    fn height(&self, t: TriangleId) -> f64 {
        let [a, b, c] = self.work.corners(t);
        let (u, v) = (minus(b, a), minus(c, a));
        length(cross(u, v)) / length(u).max(length(v)).max(length(minus(c, b)))
    }

    fn join_rings(&mut self, a: TriangleId, b: TriangleId) {
        let mut t = self.ring[a.at()];
        while t != a {
            if t == b {
                return;
            }
            t = self.ring[t.at()];
        }
        self.ring.swap(a.at(), b.at());
    }

    /// Moves vertices of the triangles in defects, those that the planes made first.
    fn moves(&mut self, most: i32, last_resort: bool) {
        for i in 0..self.defects.len() {
            let defect = self.defects[i];
            if !self.open(defect) {
                continue;
            }
            let mut vertices: Vec<VertexId> = defect.iter().flat_map(|t| self.work.triangles[t.at()]).collect();
            vertices.sort_unstable_by_key(|v| (self.mesh[v.at()], *v));
            vertices.dedup();
            vertices.retain(|v| !self.fixed[v.at()] && (last_resort || !self.mesh[v.at()]));
            for v in vertices {
                if self.step(v, &self.directions(v, defect), most) && !self.open(defect) {
                    break;
                }
            }
        }
    }

    /// The directions of the paper's heuristic, both ways.
    fn directions(&self, v: VertexId, defect: Defect) -> Vec<[f64; 3]> {
        let x = self.work.coords[v.at()];
        let mut towards = Vec::with_capacity(16);
        for t in defect {
            let [a, b, c] = self.work.corners(t);
            towards.push(cross(minus(b, a), minus(c, a)));
            towards.extend([a, b, c].map(|p| minus(p, x)));
        }
        towards.retain(|d| d.iter().any(|x| *x != 0.0));
        for i in 0..towards.len() {
            towards.push(towards[i].map(|x| -x));
        }
        towards
    }

    /// Moves a vertex by up to `most` units to where it leaves the fewest defects, if that is fewer than now.
    fn step(&mut self, v: VertexId, towards: &[[f64; 3]], most: i32) -> bool {
        let star = self.star(v);
        let before = self.weigh(&star);
        let home = self.work.coords[v.at()];
        let (mut best, mut place, mut k) = (before, home, 1);
        while k <= most && best > 0 {
            for d in towards.iter().chain(&DIRECTIONS) {
                let size = d.iter().fold(0.0f64, |m, x| m.max(x.abs()));
                let x: [f64; 3] = std::array::from_fn(|i| home[i] + (d[i] / size * k as f64).round() * self.unit + 0.0);
                if x == home || x.iter().any(|x| !x.is_finite()) {
                    continue;
                }
                self.work.coords[v.at()] = x;
                let weight = self.weigh_again(&star, best);
                if weight < best {
                    (best, place) = (weight, x);
                }
                if best == 0 {
                    break;
                }
            }
            k *= 2;
        }
        self.work.coords[v.at()] = place;
        if best < before {
            self.changed.extend_from_slice(&star);
        }
        best < before
    }

    /// Merges vertices of the triangles in defects that are within `reach` of each other: of one triangle; as a last resort also
    /// of two that meet.
    fn merges(&mut self, reach: f64, last_resort: bool) {
        let corners = |w: &Work, d: Defect| d.map(|t| w.triangles[t.at()]);
        let mut vertices: Vec<VertexId> = self.defects.iter().flat_map(|&d| corners(self.work, d)).flatten().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut sets = UnionFind::new(vertices.len());
        let coords = &self.work.coords;
        let mut try_pair = |u: VertexId, v: VertexId| {
            if (0..3).all(|i| (coords[u.at()][i] - coords[v.at()][i]).abs() <= reach)
                && let (Ok(i), Ok(j)) = (vertices.binary_search(&u), vertices.binary_search(&v))
            {
                sets.union(i, j);
            }
        };
        for &d in &self.defects {
            let [p, q] = corners(self.work, d);
            for t in [p, q] {
                (0..3).for_each(|i| try_pair(t[i], t[(i + 1) % 3]));
            }
            if last_resort {
                p.into_iter().for_each(|u| q.into_iter().for_each(|v| try_pair(u, v)));
            }
        }
        let (labels, count) = sets.labels();
        let groups = Csr::from_pairs(count, labels.iter().zip(&vertices).map(|(&l, &v)| (l as usize, v)));
        let mut group = Vec::new();
        for row in groups.rows().filter(|r| r.len() > 1) {
            group.clear();
            group.extend_from_slice(row);
            // What may move least stays.
            group.sort_by_key(|v| (!self.fixed[v.at()], !self.mesh[v.at()], *v));
            if self.fixed[group[1].at()] || self.mesh[group[1].at()] && !last_resort {
                continue;
            }
            let mut star: Vec<TriangleId> = group.iter().flat_map(|&v| self.star(v)).collect();
            star.sort_unstable();
            star.dedup();
            self.work.merge(&group, &star, &mut self.changed);
        }
    }
}

/// Axes, then diagonals of faces, then of the cube.
const DIRECTIONS: [[f64; 3]; 26] = directions();

const fn directions() -> [[f64; 3]; 26] {
    let mut all = [[0.0; 3]; 26];
    let (mut n, mut axes) = (0, 1);
    while axes <= 3 {
        let mut code = 0;
        while code < 27 {
            let d = [code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1];
            if (d[0] != 0) as i32 + (d[1] != 0) as i32 + (d[2] != 0) as i32 == axes {
                all[n] = [d[0] as f64, d[1] as f64, d[2] as f64];
                n += 1;
            }
            code += 1;
        }
        axes += 1;
    }
    all
}

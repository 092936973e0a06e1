//! Stage: every triangle, split along the lattice into convex pieces, one per box: first between z planes, each strip between y
//! planes, each of those between x planes.
//!
//! A piece is a cycle of points with their slabs, so splitting reads no coordinates: in a convex cycle every plane strictly
//! between the extreme slabs has two points, one on the rising chain and one on the falling one. New points arise on z chords alone,
//! where x and y planes cross them, and on y chords, where x planes do; the order along a y chord is the planes' own, and along
//! a z chord x and y planes are merged by the side of a node with respect to the triangle: x is met before y exactly where the node is
//! on the side that the triangle's normal tells (zero: both are met in one point, the node).
//!
//! Degenerate cases have no branch: a corner on a plane is a point with an odd slab; a triangle in a plane has equal odd slabs and
//! its pieces belong to the box on its fluid side; what only touches a plane is not split by it.
//!
//! Invariant: pieces tile the part of the surface in the block's closed box; each side of a piece is a side of one other piece or lies on
//! the rim of the block. Cost: linear in the pieces and their corners.

use super::ground::{Ground, Slabs, Walk, on_plane};
use super::touched::others;
use crate::base::{BoxId, Csr, SquareId, TriangleId, VertexId, parallel};
use crate::cut::classify::{KnifeId, members_between};
use crate::exact::{self, Sign};
use crate::mesh::projection::turn;

/// A side that two pieces of one triangle share, in a plane that crosses the triangle: directed along n_P × n_T, so that the fluid is on
/// its left, in the square given.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chord {
    pub ends: [VertexId; 2],
    pub triangle: TriangleId,
    pub square: SquareId,
}

/// The surface in the block.
#[derive(Debug, Default)]
pub struct Pieces {
    /// Corners of each piece, counter-clockwise like its triangle; by rising triangle.
    pub corners: Csr<VertexId>,
    pub triangle: Vec<TriangleId>,
    /// The box on the fluid side.
    pub in_box: Vec<BoxId>,
    /// Chords with their planes.
    pub chords: Vec<(KnifeId, Chord)>,
    /// Points inside triangles: numbered behind the points on mesh edges.
    pub point_triangle: Vec<TriangleId>,
    pub point_slabs: Vec<Slabs>,
    /// The lexicographically first pair of planes through the point that cross the triangle in different lines.
    pub point_pair: Vec<[KnifeId; 2]>,
}

const BLOCK: usize = 4096;

pub fn pieces(ground: &Ground) -> Pieces {
    let count = ground.mesh.triangles.len();
    let blocks = parallel::map_ranges(count, BLOCK, |range| {
        let (mut scratch, mut out) = (Scratch::default(), Pieces::default());
        for t in range {
            scratch.triangle(ground, TriangleId::of(t), &mut out);
        }
        out
    });
    join(ground, blocks)
}

/// Joins blocks: points inside triangles move up by what came before.
fn join(ground: &Ground, mut blocks: Vec<Pieces>) -> Pieces {
    if blocks.len() == 1 {
        return blocks.pop().expect("one block");
    }
    let first = ground.first_inner_point();
    let total = |f: fn(&Pieces) -> usize| blocks.iter().map(f).sum::<usize>();
    let mut all = Pieces::default();
    all.corners.items.reserve_exact(total(|b| b.corners.items.len()));
    all.corners.offsets.reserve_exact(total(|b| b.triangle.len()));
    all.triangle.reserve_exact(total(|b| b.triangle.len()));
    all.in_box.reserve_exact(total(|b| b.in_box.len()));
    all.chords.reserve_exact(total(|b| b.chords.len()));
    all.point_triangle.reserve_exact(total(|b| b.point_triangle.len()));
    all.point_slabs.reserve_exact(total(|b| b.point_triangle.len()));
    all.point_pair.reserve_exact(total(|b| b.point_triangle.len()));
    for block in blocks {
        let moved = all.point_triangle.len() as u32;
        let vertex = |v: VertexId| if v.0 >= first { VertexId(v.0 + moved) } else { v };
        let base = all.corners.items.len() as u32;
        all.corners.items.extend(block.corners.items.iter().map(|&v| vertex(v)));
        all.corners.offsets.extend(block.corners.offsets[1..].iter().map(|o| o + base));
        all.triangle.extend(block.triangle);
        all.in_box.extend(block.in_box);
        all.chords.extend(block.chords.into_iter().map(|(k, c)| (k, Chord { ends: c.ends.map(vertex), ..c })));
        all.point_triangle.extend(block.point_triangle);
        all.point_slabs.extend(block.point_slabs);
        all.point_pair.extend(block.point_pair);
    }
    all
}

/// A corner of a piece.
#[derive(Clone, Copy, Debug, Default)]
struct Corner {
    v: VertexId,
    s: Slabs,
}

/// The parts of one level of splitting.
#[derive(Default)]
struct Level {
    part: Vec<Corner>,
    chord: Vec<Corner>,
    before: Vec<Corner>,
}

#[derive(Default)]
struct Scratch {
    cycle: Vec<Corner>,
    levels: [Level; 3],
}

/// What one triangle's pieces have in common.
struct Triangle<'a> {
    ground: &'a Ground,
    t: TriangleId,
    corners: [[f64; 3]; 3],
    /// Extreme slabs of the corners.
    low: Slabs,
    high: Slabs,
    /// Signs of the normal's components, once needed.
    normal: [Option<Sign>; 3],
    first_inner: u32,
}

impl Triangle<'_> {
    fn normal(&mut self, axis: usize) -> Sign {
        let [a, b, c] = &self.corners;
        *self.normal[axis].get_or_insert_with(|| turn(a, b, c, axis))
    }

    fn new_point(&mut self, s: Slabs, out: &mut Pieces) -> Corner {
        // The first pair of axes whose planes cross the triangle in different lines: the triangle is not along the third.
        let pair = [(0, 1, 2), (0, 2, 1), (1, 2, 0)]
            .into_iter()
            .find(|&(a, b, c)| on_plane(s[a]) && on_plane(s[b]) && self.normal(c) != Sign::Zero)
            .map(|(a, b, _)| [self.ground.knife(a, s[a] / 2), self.ground.knife(b, s[b] / 2)]);
        debug_assert!(pair.is_some());
        let v = VertexId(self.first_inner + out.point_triangle.len() as u32);
        out.point_triangle.push(self.t);
        out.point_slabs.push(s);
        out.point_pair.push(pair.unwrap_or_default());
        Corner { v, s }
    }

    /// The points inside the z chord from `a` to `b`.
    fn along_z_chord(&mut self, a: &Corner, b: &Corner, out: &mut Pieces, chord: &mut Vec<Corner>) {
        let mut x = Planes::between(a.s[0], b.s[0]);
        let mut y = Planes::between(a.s[1], b.s[1]);
        let mut walk = Walk::new(a.s, b.s);
        let z = self.ground.lattice.nodes[2][(a.s[2] / 2) as usize];
        loop {
            let (take_x, take_y) = match (x.next, y.next) {
                (None, None) => break,
                (Some(_), None) => (true, false),
                (None, Some(_)) => (false, true),
                (Some(i), Some(j)) => {
                    let nodes = &self.ground.lattice.nodes;
                    let node = [nodes[0][i as usize], nodes[1][j as usize], z];
                    let [p, q, r] = &self.corners;
                    // At the x plane, n·(node − point) = n_y·(node − point)_y: whether y is still ahead.
                    let side = exact::orient3d(p, q, r, &node);
                    let ahead = side * self.normal(1) * if y.rising { Sign::Positive } else { Sign::Negative };
                    (ahead != Sign::Negative, ahead != Sign::Positive)
                }
            };
            if take_x {
                walk.reach(0, x.take());
            }
            if take_y {
                walk.reach(1, y.take());
            }
            chord.push(self.new_point(walk.here(), out));
            walk.leave();
        }
    }

    /// The points inside the y chord from `a` to `b`, within one z layer.
    fn along_y_chord(&mut self, a: &Corner, b: &Corner, z: u32, out: &mut Pieces, chord: &mut Vec<Corner>) {
        let mut x = Planes::between(a.s[0], b.s[0]);
        while x.next.is_some() {
            let s = [2 * x.take() + 1, a.s[1], z];
            chord.push(self.new_point(s, out));
        }
    }

    /// One piece, with its place in the lattice: even slabs are layers, odd ones planes that it lies in.
    fn finish(&mut self, part: &[Corner], place: Slabs, out: &mut Pieces) {
        self.chords(part, &place, out);
        let mut at = [0; 3];
        for a in 0..3 {
            // In a plane, the fluid is behind the normal.
            let layer = match place[a] {
                s if !on_plane(s) => s,
                s if self.normal(a) == Sign::Positive => s - 1,
                s => s + 1,
            };
            if layer == 0 || layer == self.ground.behind(a) {
                return;
            }
            at[a] = layer as usize / 2 - 1;
        }
        out.corners.items.extend(part.iter().map(|c| c.v));
        out.corners.end_row();
        out.triangle.push(self.t);
        out.in_box.push(self.ground.lattice.box_id(at));
    }

    /// The sides of a piece that one plane across the triangle has made. Each is a side of the piece below the plane and of the one above:
    /// the lower emits it, unless it is outside the block. Sides on two planes are emitted where they arise (`on_two_planes`).
    fn chords(&mut self, part: &[Corner], place: &Slabs, out: &mut Pieces) {
        let mut u = part[part.len() - 1];
        for &v in part {
            let crossed = |a: usize| {
                let s = u.s[a];
                s == v.s[a] && on_plane(s) && s > self.low[a] && s < self.high[a]
            };
            let made_by = [crossed(0), crossed(1), crossed(2)];
            if let [true, false, false] | [false, true, false] | [false, false, true] = made_by {
                let a = if made_by[0] { 0 } else { 1 + made_by[2] as usize };
                let below = place[a] < u.s[a];
                if below || u.s[a] == 1 {
                    // Above the plane the piece is walked along n_P × n_T.
                    let ends = if below { [v.v, u.v] } else { [u.v, v.v] };
                    self.push_chord(a, &u.s, &v.s, ends, out);
                }
            }
            u = v;
        }
    }

    /// Emits a chord of a plane normal to `axis`, between points in the given slabs, unless the square on its left is outside the block.
    fn push_chord(&mut self, axis: usize, u: &Slabs, v: &Slabs, ends: [VertexId; 2], out: &mut Pieces) {
        let mut at = [0; 2];
        for (at, g) in at.iter_mut().zip(others(axis)) {
            // On a grid line the left is behind the triangle's normal: it is normal to the chord, and not along the plane's.
            let layer = match u[g].min(v[g]) {
                s if !on_plane(s) => s,
                s if u[g] != v[g] => s + 1,
                s if self.normal(g) == Sign::Positive => s - 1,
                s => s + 1,
            };
            if layer == 0 || layer == self.ground.behind(g) {
                return;
            }
            *at = layer as usize / 2 - 1;
        }
        let square = self.ground.lattice.square_id(axis, at);
        out.chords.push((self.ground.knife(axis, u[axis] / 2), Chord { ends, triangle: self.t, square }));
    }

    /// A chord of a plane normal to `axis` that lies in a second plane as well, hence on a grid line: it bounds faces of both planes in all
    /// four quadrants around the line, also where neither piece beside it is in the block. `chord`: its points from the rising chain to the
    /// falling one; `before`: a corner of the part below the first plane.
    fn on_two_planes(
        &mut self,
        axis: usize,
        a: &Corner,
        b: &Corner,
        before: &Corner,
        inner: &[Corner],
        out: &mut Pieces,
    ) {
        let on = |g: usize| {
            g != axis && on_plane(a.s[g]) && a.s[g] == b.s[g] && self.low[g] < a.s[g] && a.s[g] < self.high[g]
        };
        let Some(other) = (0..3).find(|&g| on(g)) else { return };
        let mut u = *a;
        for &v in inner.iter().chain(std::iter::once(b)) {
            if self.ground.in_block(&u.s) && self.ground.in_block(&v.s) {
                // The part below the first plane is walked against n_P × n_T; it is below or above the second.
                let against = [v.v, u.v];
                let below = before.s[other] < a.s[other];
                let second = if below { against } else { [u.v, v.v] };
                self.push_chord(axis, &u.s, &v.s, against, out);
                self.push_chord(other, &u.s, &v.s, second, out);
            }
            u = v;
        }
    }
}

/// The planes of an axis strictly between two slabs, in order from the first to the second.
struct Planes {
    next: Option<u32>,
    last: u32,
    rising: bool,
}

impl Planes {
    #[inline(always)]
    fn between(from: u32, to: u32) -> Self {
        let range = members_between(from, to);
        let rising = from < to;
        match (range.is_empty(), rising) {
            (true, _) => Planes { next: None, last: 0, rising },
            (_, true) => Planes { next: Some(range.start), last: range.end - 1, rising },
            (_, false) => Planes { next: Some(range.end - 1), last: range.start, rising },
        }
    }
    #[inline(always)]
    fn take(&mut self) -> u32 {
        let here = self.next.unwrap_or(self.last);
        self.next = (here != self.last).then(|| if self.rising { here + 1 } else { here.wrapping_sub(1) });
        here
    }
}

impl Scratch {
    fn triangle(&mut self, ground: &Ground, t: TriangleId, out: &mut Pieces) {
        let corners = ground.mesh.triangles[t.at()];
        let s = corners.map(|v| ground.slabs[v.at()]);
        let low: Slabs = std::array::from_fn(|a| s[0][a].min(s[1][a]).min(s[2][a]));
        let high: Slabs = std::array::from_fn(|a| s[0][a].max(s[1][a]).max(s[2][a]));
        if (0..3).any(|a| high[a] == 0 || low[a] == ground.behind(a)) {
            return;
        }
        let mut triangle = Triangle {
            ground,
            t,
            corners: ground.mesh.corners(t),
            low,
            high,
            normal: [None; 3],
            first_inner: ground.first_inner_point(),
        };
        self.cycle.clear();
        for (i, e) in ground.mesh.triangle_edges[t.at()].into_iter().enumerate() {
            self.cycle.push(Corner { v: corners[i], s: s[i] });
            let range = ground.points.first[e.at()]..ground.points.first[e.at() + 1];
            let first = ground.first_edge_point();
            let point = |p: u32| Corner { v: VertexId(first + p), s: ground.slabs[(first + p) as usize] };
            if ground.mesh.edges[e.at()][0] == corners[i] {
                self.cycle.extend(range.map(point));
            } else {
                self.cycle.extend(range.rev().map(point));
            }
        }
        let [z_level, y_level, x_level] = &mut self.levels;
        // The levels are nested; each borrows the buffers of the next.
        let context = std::cell::RefCell::new((&mut triangle, out));
        split(
            &self.cycle,
            2,
            ground.behind(2),
            z_level,
            &mut |a, b, before, chord| {
                let (triangle, out) = &mut *context.borrow_mut();
                triangle.along_z_chord(a, b, out, chord);
                triangle.on_two_planes(2, a, b, before, chord, out);
            },
            &mut |strip, z| {
                split(
                    strip,
                    1,
                    ground.behind(1),
                    y_level,
                    &mut |a, b, before, chord| {
                        let (triangle, out) = &mut *context.borrow_mut();
                        triangle.along_y_chord(a, b, z, out, chord);
                        triangle.on_two_planes(1, a, b, before, chord, out);
                    },
                    &mut |cell, y| {
                        split(cell, 0, ground.behind(0), x_level, &mut |_, _, _, _| {}, &mut |part, x| {
                            let (triangle, out) = &mut *context.borrow_mut();
                            triangle.finish(part, [x, y, z], out);
                        });
                    },
                );
            },
        );
    }
}

/// Splits a convex cycle along the planes of one axis and emits the parts inside the block, from low to high, each with its place.
/// `inner` appends the new points on a chord between two corners, the third one being a corner below the chord.
#[inline]
fn split(
    cycle: &[Corner],
    axis: usize,
    behind: u32,
    level: &mut Level,
    inner: &mut impl FnMut(&Corner, &Corner, &Corner, &mut Vec<Corner>),
    emit: &mut impl FnMut(&[Corner], u32),
) {
    let n = cycle.len();
    let slab = |i: usize| cycle[i].s[axis];
    let (mut low, mut high, mut bottom) = (slab(0), slab(0), 0);
    for i in 1..n {
        if slab(i) < low {
            (low, bottom) = (slab(i), i);
        }
        high = high.max(slab(i));
    }
    let crossing = members_between(low, high);
    if crossing.is_empty() {
        // A part that touches the plane below it is above it.
        let place = if low == high { low } else { (low + 1) & !1 };
        if place != 0 && place != behind {
            emit(cycle, place);
        }
        return;
    }
    let Level { part, chord, before } = level;
    let next = |i: usize| if i + 1 == n { 0 } else { i + 1 };
    let previous = |i: usize| if i == 0 { n - 1 } else { i - 1 };
    // Up along the rising chain (counter-clockwise), down the falling one.
    let (mut up, mut down) = (bottom, bottom);
    let (mut last_up, mut last_down) = (None, bottom);
    before.clear();
    for rank in crossing {
        let plane = 2 * rank + 1;
        while slab(up) != plane {
            up = next(up);
        }
        while slab(down) != plane {
            down = previous(down);
        }
        chord.clear();
        inner(&cycle[up], &cycle[down], &cycle[previous(up)], chord);
        if plane != 1 {
            part.clear();
            match last_up {
                None => walk(cycle, down, up, part),
                Some(from) => walk(cycle, from, up, part),
            }
            part.extend_from_slice(chord);
            if last_up.is_some() {
                walk(cycle, down, last_down, part);
                part.extend(before.iter().rev());
            }
            emit(part, plane - 1);
        }
        (last_up, last_down) = (Some(up), down);
        std::mem::swap(chord, before);
    }
    if let Some(up) = last_up
        && slab(up) + 1 != behind
    {
        part.clear();
        walk(cycle, up, last_down, part);
        part.extend(before.iter().rev());
        emit(part, slab(up) + 1);
    }
}

/// Appends the corners from one place to another, both included, counter-clockwise.
#[inline]
fn walk(cycle: &[Corner], from: usize, to: usize, out: &mut Vec<Corner>) {
    if from <= to {
        out.extend_from_slice(&cycle[from..=to]);
    } else {
        out.extend_from_slice(&cycle[from..]);
        out.extend_from_slice(&cycle[..=to]);
    }
}

impl Pieces {
    /// Every piece has three corners or more, and points inside triangles are on two planes or more.
    pub fn check(&self) -> Result<(), String> {
        self.corners.check()?;
        if let Some(i) = self.corners.rows().position(|row| row.len() < 3) {
            return Err(format!("piece {i} has less than three corners"));
        }
        if self.triangle.len() != self.corners.len() || self.in_box.len() != self.corners.len() {
            return Err("pieces do not match their triangles and boxes".into());
        }
        if let Some(i) = self.point_slabs.iter().position(|s| s.iter().filter(|&&s| on_plane(s)).count() < 2) {
            return Err(format!("point {i} inside a triangle is on less than two planes"));
        }
        Ok(())
    }
}

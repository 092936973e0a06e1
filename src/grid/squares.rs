//! Stage: the faces in grid planes, as far as touched boxes are beside them: each plane's section with the surface's chords, the mesh
//! edges that lie in it, and the segments of grid lines, traced into loops.
//!
//! A face lies in one square of its plane, and so does each half-edge that has one on its left: the pieces of the surface are split at
//! all grid lines. So half-edges are sorted by square, and nearly every square is traced on its own: where no two half-edges of a
//! square leave the same vertex, the one that leaves where another arrives is the next, and no direction is compared. All other
//! squares (features that meet in a vertex, slits, holes, touching vertices) are left to `square_stars`, square by square.
//! Of the lattice only segments beside touched boxes are in the graph; all half-edges around a square agree in that.
//!
//! Invariant: faces rise by axis, plane, square, then lowest half-edge (chords by triangle, mesh edges, grid segments), where their
//! outer loops start. Planes are independent. Cost: linear; what one plane needs stays in the cache.

use super::data::FULL_CELL;
use super::ground::{Slabs, on_plane};
use super::lines::{AllSlabs, Lines};
use super::pieces::Chord;
use super::touched::{Touched, others};
use crate::base::{CellId, Csr, EdgeId, NodeId, Result, SquareId, VertexId, parallel};
use crate::cut::classify::KnifeId;
use crate::cut::faces::AllVertices;
use crate::cut::sections::{Piece, Section, edge_pieces};
use std::cmp::Ordering;

/// Faces in grid planes, by axis, plane, then square.
#[derive(Debug, Default)]
pub struct Squares {
    /// Faces normal to axis `a` are `axis_faces[a]..axis_faces[a + 1]`.
    pub axis_faces: [u32; 4],
    /// Loops of each face (counts summed up), corners of each loop.
    pub face_loops: Vec<u32>,
    pub loops: Csr<VertexId>,
    /// The lowest node of each face's square.
    pub node: Vec<NodeId>,
    /// What is below and above each square: a touched box, by its place among them, `FULL_CELL`, or `NONE`.
    pub sides: Vec<[CellId; 2]>,
}

/// What the planes' graphs are made of, by plane.
pub struct Contents {
    pub chords: Csr<Chord>,
    pub edges: Csr<EdgeId>,
    pub vertices: Csr<VertexId>,
}

/// What this stage reads.
pub struct Scene<'a> {
    pub all: &'a AllVertices<'a>,
    pub slabs: AllSlabs<'a>,
    pub lines: &'a Lines,
    pub touched: &'a Touched,
    pub contents: &'a Contents,
}

/// One plane: its knife, axis and node; u and w are its axes, right-handed about the normal.
#[derive(Clone, Copy)]
pub struct PlaneOf {
    pub knife: KnifeId,
    pub axis: usize,
    pub rank: u32,
    pub u: usize,
    pub w: usize,
}

/// A half-edge with a face on its left. `id`: twice its piece's place in the plane (chords, mesh edges, grid segments), 1 more where it runs
/// against the piece. `square`: the place of its square among those of the plane beside touched boxes.
#[derive(Clone, Copy, Debug, Default)]
pub struct HalfEdge {
    pub from: VertexId,
    pub to: VertexId,
    pub id: u32,
    pub square: u32,
}

pub fn squares(scene: &Scene) -> Result<Squares> {
    let ground = scene.slabs.ground;
    let planes: Vec<PlaneOf> = (0..3)
        .flat_map(|axis| (0..ground.lattice.nodes[axis].len() as u32).map(move |rank| (axis, rank)))
        .map(|(axis, rank)| {
            let knife = ground.knife(axis, rank);
            PlaneOf { knife, axis, rank, u: (axis + 1) % 3, w: (axis + 2) % 3 }
        })
        .collect();
    let parts = parallel::map_ranges(planes.len(), 1, |range| {
        let mut out = Squares { face_loops: vec![0], ..Default::default() };
        let mut buffers = Buffers::default();
        for plane in &planes[range] {
            scene.plane(plane, &mut buffers, &mut out)?;
            out.axis_faces[plane.axis + 1..].fill(out.node.len() as u32);
        }
        Ok(out)
    });
    Ok(join(parts.into_iter().collect::<Result<_>>()?))
}

/// The faces of all parts, in order.
fn join(mut parts: Vec<Squares>) -> Squares {
    if parts.len() == 1 {
        return parts.pop().expect("one part");
    }
    let mut out = Squares::default();
    for part in &parts {
        (0..4).for_each(|a| out.axis_faces[a] += part.axis_faces[a]);
    }
    let first = parallel::offsets(parts.iter().map(|p| p.loops.len()));
    for (part, &first) in parts.iter_mut().zip(&first) {
        // Each part but the last gives its end to the next one as its start.
        part.face_loops.iter_mut().for_each(|l| *l += first as u32);
    }
    let last = parts.len() - 1;
    parts[..last].iter_mut().for_each(|p| p.face_loops.truncate(p.node.len()));
    out.face_loops = parallel::concat(parts.iter_mut().map(|p| std::mem::take(&mut p.face_loops)).collect());
    out.node = parallel::concat(parts.iter_mut().map(|p| std::mem::take(&mut p.node)).collect());
    out.sides = parallel::concat(parts.iter_mut().map(|p| std::mem::take(&mut p.sides)).collect());
    out.loops = Csr::concat(parts.into_iter().map(|p| p.loops).collect());
    out
}

#[derive(Default)]
struct Buffers {
    wanted: Wanted,
    /// Pieces of mesh edges in the plane.
    edges: Vec<Piece>,
    boxes: Vec<u64>,
    half_edges: Vec<HalfEdge>,
    /// The half-edges by square, and where those of each square start.
    sorted: Vec<HalfEdge>,
    starts: Vec<u32>,
    /// Mesh vertices inside squares.
    inside: Vec<(u32, VertexId)>,
    bare: Vec<VertexId>,
    table: Table,
    done: Vec<bool>,
    section: Section,
}

/// The squares of a plane beside touched boxes: a bit each, by `SquareId`, and the numbers of bits before each word.
#[derive(Default)]
struct Wanted {
    bits: Vec<u64>,
    before: Vec<u32>,
    count: usize,
}

impl Wanted {
    fn fill(&mut self, scene: &Scene, p: &PlaneOf) {
        let lattice = &scene.slabs.ground.lattice;
        let [fast, slow] = others(p.axis);
        let bits = &scene.touched.along[fast];
        let rank = p.rank as usize;
        self.bits.clear();
        // One more word, so that rows may reach into it.
        self.bits.resize(lattice.square_count(p.axis).div_ceil(64) + 1, 0);
        for j in 0..lattice.count(slow) {
            let start = j * lattice.count(fast);
            for layer in rank.saturating_sub(1)..(rank + 1).min(lattice.count(p.axis)) {
                let row = if slow < p.axis { bits.row(j, layer) } else { bits.row(layer, j) };
                for (w, &word) in row.iter().enumerate().filter(|(_, word)| **word != 0) {
                    let (at, shift) = (start / 64 + w, start % 64);
                    self.bits[at] |= word << shift;
                    if shift != 0 {
                        self.bits[at + 1] |= word >> (64 - shift);
                    }
                }
            }
        }
        self.before.clear();
        let mut count = 0;
        self.before.extend(self.bits.iter().map(|w| {
            count += w.count_ones();
            count - w.count_ones()
        }));
        self.count = count as usize;
    }
    /// The place of a square among those beside touched boxes, if it is one.
    #[inline(always)]
    fn place(&self, s: SquareId) -> Option<u32> {
        let (word, bit) = (self.bits[s.at() / 64], 1u64 << (s.0 % 64));
        (word & bit != 0).then(|| self.before[s.at() / 64] + (word & (bit - 1)).count_ones())
    }
}

/// The half-edges of one square by the vertex that they leave: slots of earlier rounds are free.
#[derive(Default)]
struct Table {
    slots: Vec<Slot>,
    round: u32,
    shift: u32,
}

#[derive(Clone, Copy, Default)]
struct Slot {
    from: VertexId,
    at: u32,
    round: u32,
}

impl Table {
    #[inline(always)]
    fn slot(&self, v: VertexId) -> usize {
        let mut at = (v.0.wrapping_mul(0x9E37_79B9) >> self.shift) as usize;
        while self.slots[at].round == self.round && self.slots[at].from != v {
            at = (at + 1) & (self.slots.len() - 1);
        }
        at
    }
    /// Whether no two of the half-edges leave the same vertex.
    #[inline]
    fn fill(&mut self, row: &[HalfEdge]) -> bool {
        let size = (2 * row.len()).next_power_of_two().max(64);
        if size > self.slots.len() || self.round == u32::MAX {
            self.slots.clear();
            self.slots.resize(size, Slot::default());
            (self.round, self.shift) = (0, 32 - size.trailing_zeros());
        }
        self.round += 1;
        let mut single = true;
        for (at, h) in row.iter().enumerate() {
            let slot = self.slot(h.from);
            single &= self.slots[slot].round != self.round;
            self.slots[slot] = Slot { from: h.from, at: at as u32, round: self.round };
        }
        single
    }
    #[inline(always)]
    fn get(&self, v: VertexId) -> Option<usize> {
        let slot = &self.slots[self.slot(v)];
        (slot.round == self.round).then_some(slot.at as usize)
    }
}

impl Scene<'_> {
    fn plane(&self, p: &PlaneOf, buffers: &mut Buffers, out: &mut Squares) -> Result<()> {
        let Buffers { wanted, edges, boxes, half_edges, sorted, starts, inside, bare, table, done, section } = buffers;
        let ground = self.slabs.ground;
        wanted.fill(self, p);
        if wanted.count == 0 {
            return Ok(());
        }
        half_edges.clear();
        let chords = self.contents.chords.row(p.knife);
        for (i, c) in chords.iter().enumerate() {
            let square = wanted.place(c.square);
            debug_assert!(square.is_some());
            let [from, to] = c.ends;
            half_edges.extend(square.map(|square| HalfEdge { from, to, id: 2 * i as u32, square }));
        }
        edges.clear();
        for &e in self.contents.edges.row(p.knife) {
            edge_pieces(self.all.surface, e, p.knife, edges);
        }
        for (i, piece) in edges.iter().enumerate() {
            let beside = self.beside(p, piece.ends);
            for (side, _) in [piece.left, piece.right].into_iter().enumerate().filter(|s| s.1) {
                let (from, to) = (piece.ends[side], piece.ends[1 - side]);
                let id = (2 * (chords.len() + i) + side) as u32;
                let square = beside[side].and_then(|s| wanted.place(s));
                half_edges.extend(square.map(|square| HalfEdge { from, to, id, square }));
            }
        }
        let first_line = (2 * (chords.len() + edges.len())) as u32;
        let mut next = first_line;
        self.grid_segments(p, true, wanted, &mut next, half_edges, boxes)?;
        self.grid_segments(p, false, wanted, &mut next, half_edges, boxes)?;
        sort_by_square(half_edges, wanted.count, starts, sorted);
        inside.clear();
        for &v in self.contents.vertices.row(p.knife) {
            let s = self.slabs.of(v);
            let at = others(p.axis).map(|a| s[a]);
            // On a grid line a vertex without a piece is not in the fluid: pieces of the line would end there.
            if ground.in_block(&s) && !at.iter().any(|&s| on_plane(s)) {
                let square = ground.lattice.square_id(p.axis, at.map(|s| s as usize / 2 - 1));
                inside.extend(wanted.place(square).map(|n| (n, v)));
            }
        }
        inside.sort_unstable();
        let mut candidates = &inside[..];
        let mut n = 0;
        for (w, &word) in wanted.bits.iter().enumerate() {
            let mut left = word;
            while left != 0 {
                let square = SquareId::of(64 * w + left.trailing_zeros() as usize);
                left &= left - 1;
                let row = &sorted[starts[n] as usize..starts[n + 1] as usize];
                let here;
                (here, candidates) = candidates.split_at(candidates.partition_point(|c| c.0 == n as u32));
                n += 1;
                if row.is_empty() {
                    continue;
                }
                let single = table.fill(row);
                bare.clear();
                bare.extend(here.iter().map(|c| c.1).filter(|&v| table.get(v).is_none()));
                if !(single && bare.is_empty() && trace(row, table, first_line, done, out)) {
                    self.faces_of_square(p, row, edges, bare, section, out)?;
                }
                let faces = out.face_loops.len() - 1 - out.node.len();
                let (node, sides) = self.place(p, square);
                out.node.extend(std::iter::repeat_n(node, faces));
                out.sides.extend(std::iter::repeat_n(sides, faces));
            }
        }
        Ok(())
    }

    /// The squares on the left and the right of a piece of the surface; `None` outside the block.
    fn beside(&self, p: &PlaneOf, ends: [VertexId; 2]) -> [Option<SquareId>; 2] {
        let ground = self.slabs.ground;
        let [a, b] = ends.map(|v| self.slabs.of(v));
        if !ground.in_block(&a) || !ground.in_block(&b) {
            return [None; 2];
        }
        let slab = |g: usize| match a[g].min(b[g]) {
            s if on_plane(s) && a[g] != b[g] => s + 1,
            s => s,
        };
        let mut sides = [[slab(p.u), slab(p.w)]; 2];
        for (i, along, left_of_up) in [(0, p.w, 0), (1, p.u, 1)] {
            let s = sides[0][i];
            if !on_plane(s) {
                continue;
            }
            // Upwards along w the left is −u; along u it is +w.
            let up = match a[along].cmp(&b[along]) {
                Ordering::Equal => self.all.compare_coordinate(ends[0], ends[1], along),
                order => order,
            } == Ordering::Less;
            let low = if up { left_of_up } else { 1 - left_of_up };
            (sides[low][i], sides[1 - low][i]) = (s - 1, s + 1);
        }
        sides.map(|[u, w]| {
            if [(u, p.u), (w, p.w)].iter().any(|&(s, g)| s == 0 || s == ground.behind(g)) {
                return None;
            }
            let at = if p.u < p.w { [u, w] } else { [w, u] };
            Some(ground.lattice.square_id(p.axis, at.map(|s| s as usize / 2 - 1)))
        })
    }

    /// The segments of the grid lines of a plane along one of its axes. `next`: twice the place of the next piece.
    fn grid_segments(
        &self,
        p: &PlaneOf,
        along_u: bool,
        wanted: &Wanted,
        next: &mut u32,
        half_edges: &mut Vec<HalfEdge>,
        boxes: &mut Vec<u64>,
    ) -> Result<()> {
        let lattice = &self.slabs.ground.lattice;
        let (axis, across) = if along_u { (p.u, p.w) } else { (p.w, p.u) };
        let [b, c] = others(axis);
        let rows = [lattice.count(b), lattice.count(c)];
        let stride = |a: usize| if a == others(p.axis)[0] { 1 } else { lattice.count(others(p.axis)[0]) as u32 };
        let (step, row_step) = (stride(axis), stride(across));
        for rank in 0..lattice.nodes[across].len() {
            let place = if b == across { [rank, p.rank as usize] } else { [p.rank as usize, rank] };
            self.touched.along[axis].around(place[0], place[1], rows, boxes);
            if boxes.iter().all(|w| *w == 0) {
                // A line that the surface meets has touched boxes around it.
                continue;
            }
            let row = rank as u32 * row_step;
            let (has_low, has_high) = (rank > 0, rank < lattice.count(across));
            self.lines.each_segment(self.slabs, axis, place, boxes, |from, to, layer| {
                let high = row + layer * step;
                let low = if has_low { wanted.place(SquareId(high.wrapping_sub(row_step))) } else { None };
                let high = if has_high { wanted.place(SquareId(high)) } else { None };
                // Along +u the left is +w; along +w it is −u.
                let (left, right) = if along_u { (high, low) } else { (low, high) };
                half_edges.extend(left.map(|square| HalfEdge { from, to, id: *next, square }));
                half_edges.extend(right.map(|square| HalfEdge { from: to, to: from, id: *next + 1, square }));
                *next += 2;
            })?;
        }
        Ok(())
    }

    /// The lowest node of a square, and what is below and above it.
    #[inline]
    fn place(&self, p: &PlaneOf, square: SquareId) -> (NodeId, [CellId; 2]) {
        let lattice = &self.slabs.ground.lattice;
        let [fast, slow] = others(p.axis);
        let mut at = [p.rank as usize; 3];
        [at[fast], at[slow]] = lattice.square_at(p.axis, square);
        let node = lattice.node_id(at);
        let mut side = |layer: Option<usize>| match layer.filter(|&l| l < lattice.count(p.axis)) {
            None => CellId::NONE,
            Some(layer) => {
                at[p.axis] = layer;
                if self.touched.get(at) { CellId::of(self.touched.rank(at)) } else { FULL_CELL }
            }
        };
        (node, [side((p.rank as usize).checked_sub(1)), side(Some(p.rank as usize))])
    }

    /// Slabs of any vertex.
    #[inline(always)]
    pub fn slabs_of(&self, v: VertexId) -> Slabs {
        match v.0.checked_sub(self.lines.first_node) {
            None => self.slabs.of(v),
            Some(n) => self.slabs.ground.lattice.node_at(self.lines.nodes[n as usize]).map(|i| 2 * i as u32 + 1),
        }
    }
}

/// A counting sort: `sorted[starts[n]..starts[n + 1]]` are those of square `n`, in the order given.
fn sort_by_square(half_edges: &[HalfEdge], count: usize, starts: &mut Vec<u32>, sorted: &mut Vec<HalfEdge>) {
    starts.clear();
    starts.resize(count + 1, 0);
    half_edges.iter().for_each(|h| starts[h.square as usize] += 1);
    let mut sum = 0;
    for start in starts.iter_mut() {
        sum += *start;
        *start = sum;
    }
    sorted.resize(half_edges.len(), HalfEdge::default());
    // From the back, each start moves down to where it belongs.
    for h in half_edges.iter().rev() {
        let start = &mut starts[h.square as usize];
        *start -= 1;
        sorted[*start as usize] = *h;
    }
}

/// Traces the loops of a square, each the outer one of a face, where no two half-edges leave the same vertex. False (and nothing is
/// written) where that is not all: a loop of surface pieces beside others may be a hole, and contradictions are to be named.
#[inline]
fn trace(row: &[HalfEdge], table: &Table, first_line: u32, done: &mut Vec<bool>, out: &mut Squares) -> bool {
    let (first_loop, first_corner) = (out.loops.len(), out.loops.items.len());
    let mut lines_in_all = true;
    done.clear();
    done.resize(row.len(), false);
    let mut fails = false;
    for start in 0..row.len() {
        if done[start] {
            continue;
        }
        let (mut at, mut has_line) = (start, false);
        let length = out.loops.items.len();
        loop {
            let h = &row[at];
            fails |= done[at];
            done[at] = true;
            has_line |= h.id >= first_line;
            out.loops.items.push(h.from);
            match table.get(h.to) {
                Some(next) if next == start => break,
                Some(next) if !fails => at = next,
                _ => {
                    fails = true;
                    break;
                }
            }
        }
        lines_in_all &= has_line;
        fails |= out.loops.items.len() - length < 3;
        if fails {
            break;
        }
        out.loops.end_row();
        out.face_loops.push(out.loops.len() as u32);
    }
    if !fails && (lines_in_all || out.loops.len() == first_loop + 1) {
        return true;
    }
    out.loops.items.truncate(first_corner);
    out.loops.offsets.truncate(first_loop + 1);
    out.face_loops.truncate(out.node.len() + 1);
    false
}

impl Squares {
    pub fn check(&self) -> std::result::Result<(), String> {
        self.loops.check()?;
        if self.face_loops.len() != self.node.len() + 1
            || *self.face_loops.last().unwrap() as usize != self.loops.len()
            || self.axis_faces[3] as usize != self.node.len()
            || self.sides.len() != self.node.len()
        {
            return Err("faces in grid planes do not match their loops".into());
        }
        Ok(())
    }
}

//! Stage 3: every triangle that planes cross, as a planar subdivision (paper, sections 3.1 and 4).
//!
//! In a triangle a plane is a chord between two points of the boundary cycle, directed so that the plane's positive
//! side is on its left. Chords with the same ends are one chord with several planes. Two chords cross inside exactly
//! when their ends interleave on the boundary. Along a chord, two crossing chords are ordered by their ends unless the three cross each
//! other pairwise: only then a 3×3 determinant of corner values is asked, and its zero means that the three meet in
//! one point. Around a point, chords are ordered by their ends. Everything else is `next` pointers.
//!
//! A triangle is convex and chords run from boundary to boundary, so all faces are convex: one loop, no holes.
//!
//! Invariant: each directed chord piece and each boundary piece is in exactly one loop. Degenerate cases (chords through
//! corners, several planes through a point or a chord) need no branch of their own: they are shared ends and merged groups.
//! Cost: pieces of the output times the logarithm of the pieces per chord. Blocks of triangles are independent.

use super::classify::{Classified, KnifeId, Knives};
use super::edges::EdgePoints;
use crate::base::parallel::{concat, map_ranges, offsets, write_parts};
use crate::base::{Csr, EdgeId, PlaneId, TriangleId, VertexId};
use crate::exact::{self, Sign, counters};
use crate::mesh::TriMesh;
use std::cmp::Ordering;

/// A knife on a chord; `flip` when its positive side is on the right of the chord.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChordKnife {
    pub knife: KnifeId,
    pub flip: bool,
}

/// All chords, their pieces, the points inside triangles, and the faces of cut triangles.
#[derive(Debug, Default)]
pub struct Subdivision {
    /// The triangles that some chord crosses, rising.
    pub cut: Vec<TriangleId>,
    pub chord_triangle: Vec<TriangleId>,
    pub chord_knives: Csr<ChordKnife>,
    /// Chord `c` has pieces `chord_pieces[c]..chord_pieces[c + 1]`; piece ids follow one another along it.
    pub chord_pieces: Vec<u32>,
    /// Ends of each piece, directed like its chord.
    pub pieces: Vec<[VertexId; 2]>,
    /// Points inside triangles: their triangle and all knives through them, rising.
    pub point_triangle: Vec<TriangleId>,
    pub point_knives: Csr<KnifeId>,
    /// The two knives that represent each such point: lexicographically first by plane id, on different chords.
    pub point_pair: Vec<[KnifeId; 2]>,
    /// Faces of cut triangles: corners (vertex, edge to the next corner).
    pub face_triangle: Vec<TriangleId>,
    pub faces: Csr<(VertexId, EdgeId)>,
}

/// Where this stage's elements are numbered: the first ids of points inside triangles and of chord pieces.
#[derive(Clone, Copy, Debug)]
pub struct Numbering {
    pub first_edge_point: u32,
    pub first_inner_point: u32,
    pub first_chord_piece: u32,
}

const BLOCK: usize = 512;

/// Mesh edge pieces: edge `e` has pieces from `edge_piece(e)` on, along the edge. With `points.first` as prefix sums,
/// edge `e` starts at `e + first[e]`.
#[inline(always)]
pub fn edge_piece(points: &EdgePoints, e: EdgeId) -> u32 {
    e.0 + points.first[e.at()]
}

pub fn subdivide(
    mesh: &TriMesh,
    knives: &Knives,
    classified: &Classified,
    points: &EdgePoints,
    numbering: Numbering,
) -> Subdivision {
    let crossed = |e: EdgeId| !classified.edge_crossings.range(e).is_empty();
    let cut = concat(map_ranges(mesh.triangles.len(), 1 << 13, |range| {
        let cut = |t: &usize| mesh.triangle_edges[*t].iter().any(|&e| crossed(e));
        range.filter(cut).map(TriangleId::of).collect()
    }));
    let blocks = map_ranges(cut.len(), BLOCK, |range| {
        let mut scratch = Scratch::default();
        let mut block = Subdivision { chord_pieces: vec![0], ..Default::default() };
        for &t in &cut[range] {
            scratch.subdivide(mesh, knives, classified, points, numbering, t, &mut block);
        }
        block
    });
    join(cut, blocks, numbering)
}

/// Joins blocks: ids that are local to a block (points inside triangles, chord pieces) move up by what came before.
fn join(cut: Vec<TriangleId>, mut blocks: Vec<Subdivision>, numbering: Numbering) -> Subdivision {
    if blocks.len() == 1 {
        return Subdivision { cut, ..blocks.pop().expect("one block") };
    }
    let points = offsets(blocks.iter().map(|b| b.point_triangle.len()));
    let pieces = offsets(blocks.iter().map(|b| b.pieces.len()));
    let vertex = |i: usize, v: VertexId| {
        if v.0 >= numbering.first_inner_point { VertexId(v.0 + points[i] as u32) } else { v }
    };
    let edge = |i: usize, e: EdgeId| {
        if e.0 >= numbering.first_chord_piece { EdgeId(e.0 + pieces[i] as u32) } else { e }
    };
    // Moved up on the way, not before.
    let lengths: Vec<usize> = blocks.iter().map(|b| b.pieces.len()).collect();
    let all_pieces = write_parts(&lengths, |i, out| {
        out.extend(blocks[i].pieces.iter().map(|piece| piece.map(|v| vertex(i, v))));
    });
    let face_offsets = Csr::concat_offsets(&blocks.iter().map(|b| &b.faces).collect::<Vec<_>>());
    let corners: Vec<Vec<(VertexId, EdgeId)>> = blocks.iter_mut().map(|b| std::mem::take(&mut b.faces.items)).collect();
    let lengths: Vec<usize> = corners.iter().map(Vec::len).collect();
    let corners = write_parts(&lengths, |i, out| {
        out.extend(corners[i].iter().map(|&(v, e)| (vertex(i, v), edge(i, e))));
    });
    // A block's own list begins with 0, and ends with what the next one begins with.
    let lengths: Vec<usize> = blocks.iter().map(|b| b.chord_pieces.len() - 1).chain([1]).collect();
    let chord_pieces = write_parts(&lengths, |i, out| match blocks.get(i) {
        Some(b) => out.extend(b.chord_pieces[..b.chord_pieces.len() - 1].iter().map(|p| p + pieces[i] as u32)),
        None => out.push(pieces[i] as u32),
    });
    fn all<T>(blocks: &mut [Subdivision], part: impl Fn(&mut Subdivision) -> &mut T) -> Vec<T>
    where
        T: Default,
    {
        blocks.iter_mut().map(|b| std::mem::take(part(b))).collect()
    }
    Subdivision {
        cut,
        chord_triangle: concat(all(&mut blocks, |b| &mut b.chord_triangle)),
        chord_knives: Csr::concat(all(&mut blocks, |b| &mut b.chord_knives)),
        chord_pieces,
        pieces: all_pieces,
        point_triangle: concat(all(&mut blocks, |b| &mut b.point_triangle)),
        point_knives: Csr::concat(all(&mut blocks, |b| &mut b.point_knives)),
        point_pair: concat(all(&mut blocks, |b| &mut b.point_pair)),
        face_triangle: concat(all(&mut blocks, |b| &mut b.face_triangle)),
        faces: Csr { offsets: face_offsets, items: corners },
    }
}

/// A chord by its places on the boundary cycle, low place first.
#[derive(Clone, Copy, Debug)]
struct Chord {
    low: u32,
    high: u32,
    /// Directed from the low place to the high one.
    rising: bool,
    knife: KnifeId,
}

impl Chord {
    fn head(&self) -> u32 {
        if self.rising { self.high } else { self.low }
    }
}

/// An outgoing half-edge at a local vertex; sorted counter-clockwise by `key`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Spoke {
    vertex: u32,
    key: u32,
    half_edge: u32,
}

#[derive(Default)]
struct Scratch {
    /// The boundary cycle: vertices, and the edge piece from each to the next.
    cycle: Vec<(VertexId, EdgeId)>,
    chords: Vec<Chord>,
    /// Knives of each distinct chord, rising by chord.
    knives_of_chords: Vec<(u32, ChordKnife)>,
    open: Vec<u32>,
    closing: Vec<u32>,
    /// Crossing pairs of chords, and the point where each lies.
    pairs: Vec<[u32; 2]>,
    pair_point: Vec<u32>,
    crossing_offsets: Vec<u32>,
    /// Per chord: (other chord, pair), ordered from the low end on.
    crossings: Vec<(u32, u32)>,
    /// Whether a crossing is the same point as the one before it along the chord.
    tied: Vec<bool>,
    /// Per chord, local vertices from the low end to the high end.
    stations: Csr<u32>,
    spokes: Vec<Spoke>,
    /// Origin and edge of each half-edge; `next` and visit marks.
    half_edges: Vec<(u32, EdgeId)>,
    next: Vec<u32>,
    /// The first inner point of the current triangle, within the block.
    first_point: u32,
    knives: Vec<KnifeId>,
}

impl Scratch {
    #[allow(clippy::too_many_arguments)]
    fn subdivide(
        &mut self,
        mesh: &TriMesh,
        knives: &Knives,
        classified: &Classified,
        points: &EdgePoints,
        numbering: Numbering,
        t: TriangleId,
        out: &mut Subdivision,
    ) {
        self.collect_chords(mesh, classified, points, numbering, t);
        self.merge_chords();
        self.find_crossings();
        self.order_crossings(mesh, knives, t);
        self.place_points(mesh, knives, classified, t, out);
        self.link(numbering, t, out);
        self.trace(numbering, t, out);
    }

    /// The boundary cycle, and one chord per knife that crosses an edge of the triangle: a knife in two of the three rising
    /// lists runs from edge to edge, a knife in one of them runs through the opposite corner.
    fn collect_chords(
        &mut self,
        mesh: &TriMesh,
        classified: &Classified,
        points: &EdgePoints,
        numbering: Numbering,
        t: TriangleId,
    ) {
        self.cycle.clear();
        self.chords.clear();
        let corners = mesh.triangles[t.at()];
        let edges = mesh.triangle_edges[t.at()];
        let mut corner_place = [0u32; 3];
        let mut forward = [false; 3];
        for s in 0..3 {
            let e = edges[s];
            corner_place[s] = self.cycle.len() as u32;
            forward[s] = mesh.edges[e.at()][0] == corners[s];
            let (count, first) = (points.count(e) as u32, numbering.first_edge_point + points.first[e.at()]);
            let piece = edge_piece(points, e);
            if forward[s] {
                self.cycle.push((corners[s], EdgeId(piece)));
                self.cycle.extend((0..count).map(|i| (VertexId(first + i), EdgeId(piece + i + 1))));
            } else {
                self.cycle.push((corners[s], EdgeId(piece + count)));
                self.cycle.extend((0..count).rev().map(|i| (VertexId(first + i), EdgeId(piece + i))));
            }
        }
        let ranges = edges.map(|e| classified.edge_crossings.range(e));
        let mut cursor = ranges.clone().map(|r| r.start);
        loop {
            let head = |s: usize| -> Option<KnifeId> {
                (cursor[s] < ranges[s].end).then(|| classified.edge_crossings.items[cursor[s]].knife)
            };
            let Some(knife) = (0..3).filter_map(head).min() else { break };
            let here: [bool; 3] = [head(0) == Some(knife), head(1) == Some(knife), head(2) == Some(knife)];
            let place = |s: usize| -> u32 {
                let (rank, count) = (points.rank[cursor[s]], points.count(edges[s]) as u32);
                corner_place[s] + 1 + if forward[s] { rank } else { count - 1 - rank }
            };
            // The first side hit: the chord from there to the other end has the corner before it on its left.
            let s = here.iter().position(|&h| h).unwrap();
            let from = place(s);
            let to = match (s + 1..3).find(|&o| here[o]) {
                Some(o) => place(o),
                None => corner_place[(s + 2) % 3],
            };
            let corner_positive = classified.edge_crossings.items[cursor[s]].low_positive == forward[s];
            let (tail, head_place) = if corner_positive { (from, to) } else { (to, from) };
            self.chords.push(Chord {
                low: tail.min(head_place),
                high: tail.max(head_place),
                rising: tail < head_place,
                knife,
            });
            for s in 0..3 {
                cursor[s] += here[s] as usize;
            }
        }
    }

    /// Sorts chords by their ends (low end rising, then high end falling, as `find_crossings` wants them) and merges
    /// those with equal ends: pencils of planes.
    fn merge_chords(&mut self) {
        self.knives_of_chords.clear();
        if self.chords.len() > 1 {
            self.chords.sort_by_key(|c| (c.low, u32::MAX - c.high, c.knife));
        }
        let mut kept = 0usize;
        for i in 0..self.chords.len() {
            let chord = self.chords[i];
            if kept == 0 || (self.chords[kept - 1].low, self.chords[kept - 1].high) != (chord.low, chord.high) {
                self.chords[kept] = chord;
                kept += 1;
            }
            let leader = self.chords[kept - 1];
            let flip = leader.rising != chord.rising;
            self.knives_of_chords.push((kept as u32 - 1, ChordKnife { knife: chord.knife, flip }));
        }
        self.chords.truncate(kept);
    }

    /// Chords whose ends interleave strictly. Walks the boundary with the open chords in order of opening: a chord that
    /// closes crosses those opened after it that are still open. At one place, chords close before others open, so that
    /// shared ends do not count. Cost: chords and crossings.
    fn find_crossings(&mut self) {
        self.pairs.clear();
        let count = self.chords.len();
        if count > 1 {
            self.open.clear();
            self.closing.clear();
            self.closing.extend(0..count as u32);
            let chords = &self.chords;
            // Of chords that close at one place, the one opened last closes first.
            self.closing.sort_by_key(|&c| (chords[c as usize].high, u32::MAX - c));
            let mut opened = 0usize;
            for &c in &self.closing {
                let chord = chords[c as usize];
                while opened < count && chords[opened].low < chord.high {
                    self.open.push(opened as u32);
                    opened += 1;
                }
                let at = self.open.iter().rposition(|&o| o == c).expect("a chord closes after it opens");
                // Later openers that end where this one ends, or start where it ends, were handled by the order.
                for &o in &self.open[at + 1..] {
                    self.pairs.push([c.min(o), c.max(o)]);
                }
                self.open.remove(at);
            }
        }
        // Per chord, its crossings: count, prefix sums, fill.
        self.crossing_offsets.clear();
        self.crossing_offsets.resize(count + 1, 0);
        for pair in &self.pairs {
            self.crossing_offsets[pair[0] as usize + 1] += 1;
            self.crossing_offsets[pair[1] as usize + 1] += 1;
        }
        for c in 0..count {
            self.crossing_offsets[c + 1] += self.crossing_offsets[c];
        }
        self.crossings.clear();
        self.crossings.resize(self.pairs.len() * 2, (0, 0));
        if self.pairs.is_empty() {
            return;
        }
        let mut fill = std::mem::take(&mut self.open);
        fill.clear();
        fill.extend_from_slice(&self.crossing_offsets[..count]);
        for (i, &[a, b]) in self.pairs.iter().enumerate() {
            for (c, other) in [(a, b), (b, a)] {
                self.crossings[fill[c as usize] as usize] = (other, i as u32);
                fill[c as usize] += 1;
            }
        }
        self.open = fill;
    }

    fn order_crossings(&mut self, mesh: &TriMesh, knives: &Knives, t: TriangleId) {
        self.tied.clear();
        self.tied.resize(self.crossings.len(), false);
        if self.pairs.is_empty() {
            return;
        }
        let corners = mesh.corners(t);
        let places = self.cycle.len() as u32;
        for c in 0..self.chords.len() {
            let range = self.crossing_offsets[c] as usize..self.crossing_offsets[c + 1] as usize;
            if range.len() < 2 {
                continue;
            }
            let chords = &self.chords;
            let compare = |x: &(u32, u32), y: &(u32, u32)| {
                compare_along(&corners, knives, places, &chords[c], &chords[x.0 as usize], &chords[y.0 as usize])
            };
            self.crossings[range.clone()].sort_by(compare);
            for i in range.start + 1..range.end {
                self.tied[i] = compare(&self.crossings[i - 1], &self.crossings[i]) == Ordering::Equal;
            }
        }
    }

    /// Points where chords cross: runs of tied crossings along a chord are one point, and the point of a pair of chords is
    /// the same from both. Emits the points with their complete sets and the stations of every chord.
    fn place_points(
        &mut self,
        mesh: &TriMesh,
        knives: &Knives,
        classified: &Classified,
        t: TriangleId,
        out: &mut Subdivision,
    ) {
        let places = self.cycle.len() as u32;
        self.pair_point.clear();
        self.pair_point.resize(self.pairs.len(), u32::MAX);
        self.stations.items.clear();
        self.stations.offsets.truncate(1);
        self.first_point = out.point_triangle.len() as u32;
        let mut count = 0u32;
        for c in 0..self.chords.len() {
            let range = self.crossing_offsets[c] as usize..self.crossing_offsets[c + 1] as usize;
            self.stations.items.push(self.chords[c].low);
            let mut at = range.start;
            while at < range.end {
                let end = at + 1 + self.tied[at + 1..range.end].iter().take_while(|&&tied| tied).count();
                let run = &self.crossings[at..end];
                let known = run.iter().map(|x| self.pair_point[x.1 as usize]).min().unwrap();
                let point = if known != u32::MAX { known } else { count };
                if point == count {
                    count += 1;
                    self.knives.clear();
                    // The lowest plane of each chord, and the two lowest of these: the point's representative.
                    let mut pair = [(PlaneId::NONE, KnifeId::default()); 2];
                    for chord in std::iter::once(c as u32).chain(run.iter().map(|x| x.0)) {
                        let from = self.knives_of_chords.partition_point(|k| k.0 < chord);
                        let same = self.knives_of_chords[from..].iter().take_while(|k| k.0 == chord);
                        self.knives.extend(same.clone().map(|k| k.1.knife));
                        let low = same.map(|k| (knives.ids[k.1.knife.at()], k.1.knife)).min().unwrap();
                        if low < pair[0] {
                            pair = [low, pair[0]];
                        } else if low < pair[1] {
                            pair[1] = low;
                        }
                    }
                    out.point_pair.push([pair[0].1, pair[1].1]);
                    let [a, b, c] = mesh.triangles[t.at()].map(|v| classified.vertex_knives.row(v));
                    if !a.is_empty() && !b.is_empty() && !c.is_empty() {
                        self.knives.extend(a.iter().filter(|k| b.contains(k) && c.contains(k)));
                    }
                    self.knives.sort_unstable();
                    out.point_knives.push_row(&self.knives);
                    out.point_triangle.push(t);
                }
                for x in run {
                    self.pair_point[x.1 as usize] = point;
                }
                self.stations.items.push(places + point);
                at = end;
            }
            self.stations.items.push(self.chords[c].high);
            self.stations.end_row();
        }
    }

    fn vertex(&self, numbering: Numbering, station: u32) -> VertexId {
        let places = self.cycle.len() as u32;
        if station < places {
            self.cycle[station as usize].0
        } else {
            VertexId(numbering.first_inner_point + self.first_point + station - places)
        }
    }

    /// Emits chords and pieces, and links half-edges: boundary piece `b` is half-edge `b`; piece `j` of a chord is half-edge
    /// `places + 2j` from its low end on and `… + 1` back.
    fn link(&mut self, numbering: Numbering, t: TriangleId, out: &mut Subdivision) {
        let places = self.cycle.len() as u32;
        self.half_edges.clear();
        self.half_edges.extend(self.cycle.iter().enumerate().map(|(b, &(_, e))| (b as u32, e)));
        self.spokes.clear();
        let mut entry = 0;
        for (c, chord) in self.chords.iter().enumerate() {
            let stations = self.stations.row(c);
            let (count, base) = (stations.len() - 1, out.pieces.len());
            for g in 0..count {
                let along = if chord.rising { g } else { count - 1 - g };
                let edge = EdgeId::of(numbering.first_chord_piece as usize + base + along);
                let half_edge = self.half_edges.len() as u32;
                let key_up = if g == 0 { chord.high - chord.low } else { chord.high };
                let key_down = if g + 1 == count { chord.low + places - chord.high } else { chord.low };
                self.spokes.push(Spoke { vertex: stations[g], key: key_up, half_edge });
                self.spokes.push(Spoke { vertex: stations[g + 1], key: key_down, half_edge: half_edge + 1 });
                self.half_edges.push((stations[g], edge));
                self.half_edges.push((stations[g + 1], edge));
                // Emitted from the tail on.
                let (from, to) = if chord.rising { (g, g + 1) } else { (count - g, count - g - 1) };
                out.pieces.push([self.vertex(numbering, stations[from]), self.vertex(numbering, stations[to])]);
            }
            out.chord_triangle.push(t);
            out.chord_pieces.push(out.pieces.len() as u32);
            while entry < self.knives_of_chords.len() && self.knives_of_chords[entry].0 == c as u32 {
                out.chord_knives.items.push(self.knives_of_chords[entry].1);
                entry += 1;
            }
            out.chord_knives.end_row();
        }
        self.spokes.sort_unstable();
        self.next.clear();
        self.next.resize(self.half_edges.len(), 0);
        for b in 0..places {
            self.next[b as usize] = if b + 1 == places { 0 } else { b + 1 };
        }
        let twin = |h: u32| ((h - places) ^ 1) + places;
        let mut at = 0;
        while at < self.spokes.len() {
            let vertex = self.spokes[at].vertex;
            let end = at + self.spokes[at..].iter().take_while(|s| s.vertex == vertex).count();
            let star = &self.spokes[at..end];
            // Arriving, the next half-edge is the first one clockwise of the way back.
            for w in star.windows(2) {
                self.next[twin(w[1].half_edge) as usize] = w[0].half_edge;
            }
            let (first, last) = (star[0].half_edge, star[star.len() - 1].half_edge);
            if vertex < places {
                self.next[twin(first) as usize] = vertex;
                self.next[(if vertex == 0 { places - 1 } else { vertex - 1 }) as usize] = last;
            } else {
                self.next[twin(first) as usize] = last;
            }
            at = end;
        }
    }

    /// Orbits of `next` are the faces.
    fn trace(&mut self, numbering: Numbering, t: TriangleId, out: &mut Subdivision) {
        for start in 0..self.half_edges.len() {
            if self.next[start] == u32::MAX {
                continue;
            }
            let mut h = start;
            while self.next[h] != u32::MAX {
                let (station, edge) = self.half_edges[h];
                out.faces.items.push((self.vertex(numbering, station), edge));
                let next = self.next[h] as usize;
                self.next[h] = u32::MAX;
                h = next;
            }
            out.faces.end_row();
            out.face_triangle.push(t);
        }
    }
}

/// Orders the points where chords x and y cross chord c, from c's low end on.
///
/// Each has one end on either side of c. If the ends come in the same order on both sides, that is the order of the points.
/// Otherwise x and y cross each other, and the sign of y's plane at the point of c and x decides: the point has
/// barycentric weights c × x over the corner values, whose sum has the sign of the turn from c to x, which the ends tell.
fn compare_along(corners: &[[f64; 3]; 3], knives: &Knives, places: u32, c: &Chord, x: &Chord, y: &Chord) -> Ordering {
    let inside = |o: &Chord| if c.low < o.low && o.low < c.high { (o.low, o.high) } else { (o.high, o.low) };
    let ((in_x, out_x), (in_y, out_y)) = (inside(x), inside(y));
    let behind = |out: u32| if out <= c.low { c.low - out } else { c.low + places - out };
    let (one, other) = (in_x.cmp(&in_y), behind(out_x).cmp(&behind(out_y)));
    if one == other || other == Ordering::Equal {
        counters::count_topology(counters::Predicate::TriangleOrder);
        return one;
    }
    if one == Ordering::Equal {
        counters::count_topology(counters::Predicate::TriangleOrder);
        return other;
    }
    let determinant =
        exact::triangle_determinant(corners, knives.plane(c.knife), knives.plane(x.knife), knives.plane(y.knife));
    // Left of a rising chord is the arc outside (low, high); heads on the left turn counter-clockwise.
    let head_on_left = (x.head() == in_x) != c.rising;
    let y_at_point = if head_on_left { determinant } else { -determinant };
    let low_positive = (y.low < c.low && c.low < y.high) != y.rising;
    match (y_at_point, low_positive) {
        (Sign::Zero, _) => Ordering::Equal,
        (Sign::Positive, true) | (Sign::Negative, false) => Ordering::Less,
        _ => Ordering::Greater,
    }
}

impl Subdivision {
    pub fn check(&self) -> Result<(), String> {
        self.chord_knives.check()?;
        self.point_knives.check()?;
        self.faces.check()?;
        if *self.chord_pieces.last().unwrap() as usize != self.pieces.len() {
            return Err("chord pieces do not end at the number of pieces".into());
        }
        for c in 0..self.chord_triangle.len() {
            let run = &self.pieces[self.chord_pieces[c] as usize..self.chord_pieces[c + 1] as usize];
            if run.is_empty() || run.windows(2).any(|w| w[0][1] != w[1][0]) {
                return Err(format!("the pieces of chord {c} do not follow one another"));
            }
        }
        Ok(())
    }
}

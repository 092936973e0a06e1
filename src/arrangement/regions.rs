//! The quick way through a graph within one triangle: its regions are walked, and each is cut up by itself.
//!
//! Where many segments cross in a triangle, most sides of any triangulation are pieces already and most regions have three to six corners. So
//! nothing is located and no piece is forced in: pieces are sorted around each vertex, regions are walked along them, ears are cut off, and sides
//! within a region are flipped where rounded coordinates prefer that, as everywhere ([`super::triangulate`]).
//!
//! Sorting around a vertex needs turns of pieces that go to the same hand only; cutting an ear off needs that its tip is strictly convex and that no corner of the region which is
//! not lies in it, or on it. A region with different corners always has such an ear, straight angles or not: the leaf of a triangulation.
//!
//! Only graphs in one piece whose regions have different corners, and not too many, are taken; all others, with holes or ends that lead nowhere, are left to
//! the general way. Which way is taken depends on the graph and on rounded coordinates.
//!
//! Cost: some comparisons of doubles for each end of a piece and each corner of a region.

use super::triangulate::{NONE, Triangulation, Vertices};
use crate::base::VertexId;
use crate::exact::Sign;

/// Corners of a region at most: ears are looked for one by one.
const MOST: usize = 48;

/// A graph with numbered vertices, and what is found of it. Kept between graphs for its memory.
#[derive(Default)]
pub struct Regions {
    /// The vertices of the graph, rising; numbers are places here.
    pub vertices: Vec<VertexId>,
    /// Pieces by numbers.
    pub pieces: Vec<[u32; 2]>,
    /// Ends of pieces by vertex: the piece and which end, `piece << 1 | end`. As a half-edge it leads from this end to the other one.
    ends: Vec<u64>,
    first: Vec<u32>,
    around: Vec<u32>,
    /// The half-edge that follows each one, with the same region on its left.
    next: Vec<u32>,
    seen: Vec<u32>,
    corners: Vec<u32>,
    /// Of each side of a region, from its corner on: the triangle and the side there that are across, if they are.
    beyond: Vec<(u32, u32)>,
    convex: Vec<bool>,
}

impl Regions {
    /// Takes a graph and numbers its vertices: ends of pieces and lone ones.
    pub fn number(&mut self, pieces: &[[VertexId; 2]], lone: &[VertexId]) {
        self.ends.clear();
        self.ends.extend(pieces.iter().flatten().enumerate().map(|(h, v)| (v.0 as u64) << 32 | h as u64));
        self.ends.extend(lone.iter().map(|v| (v.0 as u64) << 32 | NONE as u64));
        self.ends.sort_unstable();
        self.vertices.clear();
        self.first.clear();
        self.around.clear();
        self.pieces.clear();
        self.pieces.resize(pieces.len(), [0; 2]);
        for &end in &self.ends {
            let (v, h) = (VertexId((end >> 32) as u32), end as u32);
            if self.vertices.last() != Some(&v) {
                self.vertices.push(v);
                self.first.push(self.around.len() as u32);
            }
            if h != NONE {
                self.pieces[h as usize / 2][h as usize % 2] = self.vertices.len() as u32 - 1;
                self.around.push(h);
            }
        }
        self.first.push(self.around.len() as u32);
    }

    #[inline(always)]
    fn from(&self, h: u32) -> u32 {
        self.pieces[h as usize / 2][h as usize % 2]
    }
    #[inline(always)]
    fn to(&self, h: u32) -> u32 {
        self.from(h ^ 1)
    }

    /// Triangulates the inside of a triangle with these corners, to the left; `None` if the graph is not of the kind that is taken here. Neighbours are
    /// known within regions only.
    pub fn triangulate(&mut self, vertices: &impl Vertices, corners: [u32; 3]) -> Option<Triangulation> {
        let (count, pieces) = (self.vertices.len(), self.pieces.len());
        if self.first.windows(2).any(|w| w[1] - w[0] < 2) {
            return None;
        }
        self.link(vertices);
        let outside = self.outside(vertices, corners[0]);
        let mut made = Triangulation::empty(count, 2 * count);
        let mut sides = Vec::with_capacity(count);
        self.seen.clear();
        self.seen.resize(count, 0);
        let mut walked = 0;
        const DONE: u32 = NONE;
        // The outside is walked like a region, and not cut up.
        for start in std::iter::once(outside).chain(0..2 * pieces as u32) {
            if self.next[start as usize] == DONE {
                continue;
            }
            walked += 1;
            self.corners.clear();
            let mut h = start;
            while self.next[h as usize] != DONE {
                let v = self.from(h);
                if start != outside && std::mem::replace(&mut self.seen[v as usize], walked) == walked {
                    return None;
                }
                self.corners.push(v);
                h = std::mem::replace(&mut self.next[h as usize], DONE);
            }
            if start != outside {
                self.cut_up(vertices, &mut made, &mut sides)?;
            }
        }
        // Euler: with more components there would be more ways around.
        if walked as usize + count != pieces + 2 {
            return None;
        }
        made.fair(vertices, &sides);
        Some(made)
    }

    /// Sorts pieces around each vertex, counterclockwise, and finds which half-edge follows which.
    fn link(&mut self, vertices: &impl Vertices) {
        self.next.clear();
        self.next.resize(2 * self.pieces.len(), NONE);
        let mut around = std::mem::take(&mut self.around);
        for v in 0..self.vertices.len() {
            let row = &mut around[self.first[v] as usize..self.first[v + 1] as usize];
            // Those toward later vertices first: pieces opposite to one another, which are many, are never asked for their turn.
            let (v, mut later) = (v as u32, 0);
            for i in 0..row.len() {
                let h = row[i];
                let to = self.to(h);
                let mut from = later;
                let mut j = i;
                if vertices.comes_before(v, to) {
                    row.copy_within(later..i, later + 1);
                    (from, j, later) = (0, later, later + 1);
                }
                // Rows are short: an insertion sort.
                while j > from && vertices.turn(v, to, self.to(row[j - 1])) == Sign::Positive {
                    row[j] = row[j - 1];
                    j -= 1;
                }
                row[j] = h;
            }
            // Who arrives along a piece leaves along the one before it, clockwise: what is between is on the left.
            let mut before = row[row.len() - 1];
            for &h in row.iter() {
                self.next[(h ^ 1) as usize] = before;
                before = h;
            }
        }
        self.around = around;
    }

    /// The half-edge from a corner of the triangle that has the outside on its left: the last one, counterclockwise, of less than half a turn.
    fn outside(&self, vertices: &impl Vertices, corner: u32) -> u32 {
        let row = &self.around[self.first[corner as usize] as usize..self.first[corner as usize + 1] as usize];
        let later = |last: u32, h: u32| {
            let turn = vertices.turn(corner, self.to(last), self.to(h));
            if turn == Sign::Positive { h } else { last }
        };
        row.iter().copied().reduce(later).unwrap_or(0)
    }

    /// Cuts the region at hand into triangles; adds the sides within it, one of the two each, to `sides`. `None` if it has too many corners or no certain ears.
    fn cut_up(
        &mut self,
        vertices: &impl Vertices,
        made: &mut Triangulation,
        sides: &mut Vec<(u32, usize)>,
    ) -> Option<()> {
        let (corners, beyond, convex) = (&mut self.corners, &mut self.beyond, &mut self.convex);
        if corners.len() > MOST {
            return None;
        }
        // What is not certain counts as not convex, and as within an ear: exact signs here are mostly those of straight angles, which are dear.
        let certainly = |a: u32, b: u32, c: u32, sign: Sign| vertices.quick_turn(a, b, c) == Some(sign);
        let is_convex = |c: &[u32], i: usize| {
            let n = c.len();
            certainly(c[(i + n - 1) % n], c[i], c[(i + 1) % n], Sign::Positive)
        };
        beyond.clear();
        beyond.resize(corners.len(), (NONE, 0));
        convex.clear();
        convex.extend((0..corners.len()).map(|i| is_convex(corners, i)));
        while corners.len() > 3 {
            let n = corners.len();
            let around = |i: usize| [(i + n - 1) % n, i, (i + 1) % n];
            let length = |i: usize| {
                let [p, _, q] = around(i).map(|k| vertices.place(corners[k]));
                (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1])
            };
            let is_free = |i: usize| {
                let ear = around(i);
                let [p, v, q] = ear.map(|k| corners[k]);
                let within = |k: usize| {
                    let turn = |a: u32, b: u32| !certainly(a, b, corners[k], Sign::Negative);
                    !convex[k] && !ear.contains(&k) && turn(p, v) && turn(v, q) && turn(q, p)
                };
                !(0..n).any(within)
            };
            // The ear with the shortest side within: a good start.
            let mut best = (f64::INFINITY, NONE as usize);
            for (i, _) in convex.iter().enumerate().filter(|(_, convex)| **convex) {
                let length = length(i);
                if (length < best.0 || best.1 == NONE as usize) && is_free(i) {
                    best = (length, i);
                }
            }
            if best.1 == NONE as usize {
                return None;
            }
            let [before, i, after] = around(best.1);
            let t = made.join([before, i, after].map(|k| corners[k]), [beyond[before], beyond[i], (NONE, 0)]);
            // The third side is no piece.
            made.pieces[t as usize] &= 0b011;
            sides.push((t, 2));
            beyond[before] = (t, 2);
            corners.remove(i);
            beyond.remove(i);
            convex.remove(i);
            let (before, after) = (before - (before > i) as usize, after - (after > i) as usize);
            for k in [before, after] {
                if !convex[k] {
                    convex[k] = is_convex(corners, k);
                }
            }
        }
        if !convex[0] && vertices.turn(corners[0], corners[1], corners[2]) != Sign::Positive {
            return None;
        }
        made.join([corners[0], corners[1], corners[2]], [beyond[0], beyond[1], beyond[2]]);
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vertices of a triangle on a grid of integers, small enough for doubles to be exact.
    struct Grid(Vec<[f64; 2]>);

    impl Vertices for Grid {
        fn place(&self, v: u32) -> [f64; 2] {
            self.0[v as usize]
        }
        fn turn(&self, a: u32, b: u32, c: u32) -> Sign {
            let [a, b, c] = [a, b, c].map(|v| self.0[v as usize]);
            Sign::of((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
        }
        fn quick_turn(&self, a: u32, b: u32, c: u32) -> Option<Sign> {
            // As little as the real one tells.
            Some(self.turn(a, b, c)).filter(|s| !s.is_zero())
        }
        fn comes_before(&self, a: u32, b: u32) -> bool {
            let ([a, c], [b, d]) = (self.0[a as usize], self.0[b as usize]);
            a < b || (a == b && c < d)
        }
    }

    fn made(places: &[[f64; 2]], pieces: &[[u32; 2]], lone: &[u32]) -> Option<Triangulation> {
        let ids = |p: &[u32; 2]| p.map(VertexId);
        let mut regions = Regions::default();
        regions.number(
            &pieces.iter().map(ids).collect::<Vec<_>>(),
            &lone.iter().map(|v| VertexId(*v)).collect::<Vec<_>>(),
        );
        assert_eq!((regions.vertices.len(), &regions.pieces[..]), (places.len(), pieces));
        let grid = Grid(places.to_vec());
        let made = regions.triangulate(&grid, [0, 1, 2])?;
        assert_eq!(made.check(&grid), Ok(()));
        let area = |c: &[u32; 3]| {
            let [a, b, c] = c.map(|v| places[v as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        };
        assert_eq!(made.corners.iter().map(area).sum::<f64>(), area(&[0, 1, 2]));
        // Every piece is a side, of one triangle at the border and of two within.
        let is_side = |c: &[u32; 3], p: &[u32; 2]| p.iter().all(|v| c.contains(v));
        let on_border = |p: &[u32; 2]| {
            let lines = [[0, 1], [1, 2], [2, 0]];
            lines.iter().any(|[a, b]| p.iter().all(|&v| grid.turn(*a, *b, v).is_zero()))
        };
        for p in pieces {
            assert_eq!(made.corners.iter().filter(|c| is_side(c, p)).count(), 2 - on_border(p) as usize, "{p:?}");
        }
        Some(made)
    }

    const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [24.0, 0.0], [0.0, 24.0]];

    #[test]
    fn crossing_segments_straight_angles_and_regions_that_are_not_convex() {
        // Two segments from side to side that cross in vertex 7.
        let mut places = CORNERS.to_vec();
        places.extend([[8.0, 0.0], [0.0, 8.0], [8.0, 16.0], [16.0, 8.0], [8.0, 8.0]]);
        let border = [[0, 3], [0, 4], [1, 3], [1, 6], [2, 4], [2, 5], [5, 6]];
        let cross = [[3, 7], [4, 7], [5, 7], [6, 7]];
        let all: Vec<[u32; 2]> = border.iter().chain(&cross).copied().collect();
        assert_eq!(made(&places, &all, &[]).expect("regions").corners.len(), 7);
        // One of them alone, straight on in vertex 6; then with a bend there to either side.
        for (bend, vertical) in [([8.0, 8.0], true), ([4.0, 8.0], true), ([15.0, 8.0], true), ([8.0, 3.0], false)] {
            let mut places = CORNERS.to_vec();
            let ends = if vertical { [[8.0, 0.0], [8.0, 16.0]] } else { [[2.0, 0.0], [20.0, 0.0]] };
            places.extend([ends[0], ends[1], bend]);
            let border = if vertical {
                vec![[0, 2], [0, 3], [1, 3], [1, 4], [2, 4]]
            } else {
                vec![[0, 2], [0, 3], [1, 2], [1, 4], [3, 4]]
            };
            let all: Vec<[u32; 2]> = border.into_iter().chain([[3, 5], [4, 5]]).collect();
            assert_eq!(made(&places, &all, &[]).expect("regions").corners.len(), 5, "{bend:?}");
        }
    }

    #[test]
    fn holes_ends_and_lone_vertices_are_left_to_others() {
        let border = [[0, 1], [0, 2], [1, 2]];
        let mut places = CORNERS.to_vec();
        places.extend([[4.0, 4.0], [8.0, 4.0], [4.0, 8.0]]);
        let hole: Vec<[u32; 2]> = border.iter().chain(&[[3, 4], [3, 5], [4, 5]]).copied().collect();
        assert!(made(&places, &hole, &[]).is_none());
        // A triangle within that hangs at a corner: the region around it comes to that corner twice.
        let hanging = [[0, 1], [0, 2], [0, 3], [0, 4], [1, 2], [3, 4]];
        assert!(made(&places[..5], &hanging, &[]).is_none());
        assert!(made(&places[..4], &[[0, 1], [0, 2], [0, 3], [1, 2]], &[]).is_none());
        assert!(made(&places[..4], &border, &[3]).is_none());
    }
}

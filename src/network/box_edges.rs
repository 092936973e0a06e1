//! The edges of a box that the network crosses, and their points. Each node has six edges: along x, y, z, and the diagonals of the squares
//! in xy, xz, yz whose lowest node it is; a bit each. The vertices on an edge are found by counting bits, without hashing or sorting.
//!
//! Words: 64 nodes of an x-row, padded; vertices are numbered by row, word, slot, bit, and along each edge.
//! Parallel: rows are shared out, ids shifted afterwards; the result does not depend on how.

use super::data::Values;
use super::domain::BoxGrid;
use super::points::{Edge, EdgePoints, EdgeWork, Span, arrangement_points, interface_points, share_material};
use super::signs::{Label, SignRows, Signs};
use super::table::{CUBE_EDGES, SLOTS};
use crate::base::parallel::{concat, map_ranges};
use crate::base::{Csr, FunctionId, NodeId};
use std::ops::Range;

/// Rows in one task at least.
const LEAST: usize = 128;

/// One slot of 64 nodes.
#[derive(Clone, Copy, Default)]
pub struct EdgeWord {
    /// Nodes whose edge has points.
    bits: u64,
    /// Nodes whose edge has several.
    several: u64,
    /// The first vertex of the first of them.
    first: u32,
    /// Where the edges with several points have the numbers of those that are not the first.
    more: u32,
}

pub struct BoxEdges<'a> {
    grid: &'a BoxGrid,
    row_words: usize,
    /// Row r, word w, slot s: `words[(r * row_words + w) * 6 + s]`.
    words: Vec<EdgeWord>,
    more: Vec<u32>,
    /// Of each point.
    functions: Csr<FunctionId>,
    /// Rows that were worked on together, and the number of points in them.
    parts: Vec<(Range<usize>, usize)>,
}

impl EdgeWord {
    #[inline(always)]
    fn span(&self, bit: usize, more: &[u32]) -> Span {
        let below = (1u64 << bit) - 1;
        let mut first = self.first + (self.bits & below).count_ones();
        let mut count = 1;
        if self.several != 0 {
            let before = (self.several & below).count_ones() as usize;
            let more = &more[self.more as usize..];
            first += more[..before].iter().sum::<u32>();
            if self.several >> bit & 1 == 1 {
                count += more[before];
            }
        }
        Span { first, count }
    }
}

impl BoxEdges<'_> {
    /// The points on an edge of the cube whose lowest node is bit `bit` of the row; it must have some.
    /// `rows`: rows of the cube's four edges along x (steps in y and z: 00, 10, 01, 11).
    #[inline(always)]
    pub fn span(&self, rows: &[usize; 4], bit: usize, cube_edge: usize) -> Span {
        let edge = &CUBE_EDGES[cube_edge];
        let bit = bit + edge.steps[0];
        let row = rows[edge.steps[1] + 2 * edge.steps[2]];
        let at = (row * self.row_words + bit / 64) * SLOTS + edge.slot;
        self.words[at].span(bit % 64, &self.more)
    }
}

/// What differs between arrangements and interfaces.
trait Rows: Sync {
    type Work: Default;
    /// The edges with points of the nodes of a word; `None` if there are none.
    fn bits(&self, grid: &BoxGrid, place: Place, work: &mut Self::Work) -> Option<[u64; SLOTS]>;
    /// Appends the points of one of them.
    fn points(&self, at: At, edge: &Edge, work: &mut Self::Work, out: &mut Csr<FunctionId>) -> u32;
}

/// An edge of a word, and the row and place in the row of its ends.
struct At {
    slot: usize,
    bit: usize,
    ends: [[usize; 2]; 2],
}

/// A word: nodes (64 word .., j, k).
#[derive(Clone, Copy)]
struct Place {
    j: usize,
    k: usize,
    row: usize,
    word: usize,
}

/// Steps of the two ends of an edge in a slot, for nodes with even and odd i + j + k: diagonals join odd nodes.
const ENDS: [[[usize; 2]; SLOTS]; 2] =
    [[[0, 1], [0, 2], [0, 4], [1, 2], [1, 4], [2, 4]], [[0, 1], [0, 2], [0, 4], [0, 3], [0, 5], [0, 6]]];

/// Calls `visit` for the edges of a word that have points, in order.
#[inline(always)]
fn word_edges(
    grid: &BoxGrid,
    place: Place,
    slot: usize,
    mut bits: u64,
    mut visit: impl FnMut(usize, &[usize; 2], &Edge),
) {
    let Place { j, k, row, word } = place;
    let row_nodes = grid.cells()[0] + 1;
    while bits != 0 {
        let bit = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        let i = word * 64 + bit;
        let node = row * row_nodes + i;
        let ends = &ENDS[(i + j + k) & 1][slot];
        let place_of =
            |s: usize| [grid.ticks(0)[i + (s & 1)], grid.ticks(1)[j + (s >> 1 & 1)], grid.ticks(2)[k + (s >> 2)]];
        let edge = Edge { nodes: ends.map(|s| NodeId::of(node + step(grid, s))), places: ends.map(place_of) };
        visit(bit, ends, &edge);
    }
}

fn build<'a, R: Rows>(grid: &'a BoxGrid, rows: &R) -> BoxEdges<'a> {
    let [nx, ny, nz] = grid.cells();
    let row_words = (nx + 1).div_ceil(64);
    let parts = map_ranges((ny + 1) * (nz + 1), LEAST, |range| {
        let mut words = vec![EdgeWord::default(); range.len() * row_words * SLOTS];
        let (mut more, mut functions) = (Vec::new(), Csr::default());
        let mut work = R::Work::default();
        for row in range.clone() {
            let (j, k) = (row % (ny + 1), row / (ny + 1));
            for word in 0..row_words {
                let place = Place { j, k, row, word };
                let Some(bits) = rows.bits(grid, place, &mut work) else { continue };
                for (slot, &bits) in bits.iter().enumerate() {
                    if bits == 0 {
                        continue;
                    }
                    let out = &mut words[((row - range.start) * row_words + word) * SLOTS + slot];
                    *out = EdgeWord { bits, several: 0, first: functions.len() as u32, more: more.len() as u32 };
                    word_edges(grid, place, slot, bits, |bit, ends, edge| {
                        let ends = ends.map(|s| [row + (s >> 1 & 1) + (s >> 2) * (ny + 1), word * 64 + bit + (s & 1)]);
                        let count = rows.points(At { slot, bit, ends }, edge, &mut work, &mut functions);
                        debug_assert!(count > 0);
                        if count > 1 {
                            out.several |= 1 << bit;
                            more.push(count - 1);
                        }
                    });
                }
            }
        }
        (range, words, more, functions)
    });
    let (mut words, mut more, mut functions, mut ranges) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut first, mut first_more) = (0, 0);
    for (range, mut w, m, f) in parts {
        if first > 0 {
            w.iter_mut().filter(|w| w.bits != 0).for_each(|w| {
                w.first += first;
                w.more += first_more;
            });
        }
        first += f.len() as u32;
        first_more += m.len() as u32;
        words.push(w);
        more.push(m);
        ranges.push((range, f.len()));
        functions.push(f);
    }
    BoxEdges {
        grid,
        row_words,
        words: concat(words),
        more: concat(more),
        functions: Csr::concat(functions),
        parts: ranges,
    }
}

impl EdgePoints for BoxEdges<'_> {
    fn functions(&self) -> &Csr<FunctionId> {
        &self.functions
    }

    fn take_functions(&mut self) -> Csr<FunctionId> {
        std::mem::take(&mut self.functions)
    }

    fn lengths(&self) -> Vec<usize> {
        self.parts.iter().map(|p| p.1).collect()
    }

    #[inline]
    fn edges(&self, part: usize, mut visit: impl FnMut(&Edge, u32)) {
        let rows = self.grid.cells()[1] + 1;
        for row in self.parts[part].0.clone() {
            for word in 0..self.row_words {
                let place = Place { j: row % rows, k: row / rows, row, word };
                let at = (row * self.row_words + word) * SLOTS;
                for (slot, words) in self.words[at..at + SLOTS].iter().enumerate() {
                    word_edges(self.grid, place, slot, words.bits, |bit, _, edge| {
                        let count = if words.several >> bit & 1 == 1 { words.span(bit, &self.more).count } else { 1 };
                        visit(edge, count);
                    });
                }
            }
        }
    }
}

/// From a node to another corner of the cube whose lowest corner it is.
#[inline(always)]
fn step(grid: &BoxGrid, corner: usize) -> usize {
    let strides = grid.strides();
    (corner & 1) * strides[0] + (corner >> 1 & 1) * strides[1] + (corner >> 2) * strides[2]
}

/// Bits of the nodes of a word with even and odd i + j + k.
#[inline(always)]
fn parities(place: Place) -> [u64; 2] {
    const EVEN: u64 = 0x5555_5555_5555_5555;
    if (place.j + place.k) & 1 == 0 { [EVEN, !EVEN] } else { [!EVEN, EVEN] }
}

struct ArrangementRows<'a> {
    values: &'a Values<'a>,
    signs: &'a SignRows,
}

#[derive(Default)]
struct ArrangementWork {
    /// The functions that cross edges of the word, and which.
    entries: Vec<(FunctionId, [u64; SLOTS])>,
    edge: EdgeWork,
}

impl Rows for ArrangementRows<'_> {
    type Work = ArrangementWork;

    fn bits(&self, grid: &BoxGrid, place: Place, work: &mut Self::Work) -> Option<[u64; SLOTS]> {
        let [_, ny, nz] = grid.cells();
        let Place { j, k, row, word } = place;
        let signs = self.signs;
        // Rows in the directions y, z, yz; without one, the row itself (signs do not differ from themselves).
        let y = if j < ny { row + 1 } else { row };
        let z = if k < nz { row + ny + 1 } else { row };
        let yz = if j < ny && k < nz { row + ny + 2 } else { row };
        let at = |r: usize| (signs.word(r, word), (word + 1 < signs.row_words).then(|| signs.word(r, word + 1)));
        let (a, b, c, d) = (at(row), at(y), at(z), at(yz));
        let [even, odd] = parities(place);
        let (has_y, has_z) = (if j < ny { u64::MAX } else { 0 }, if k < nz { u64::MAX } else { 0 });
        work.entries.clear();
        let mut all = [0; SLOTS];
        for f in 0..signs.functions {
            let next = |r: &(&[Signs], Option<&[Signs]>)| r.0[f].shifted(r.1.map_or(Signs::default(), |r| r[f]));
            let (o, oy, oz, oyz) = (a.0[f], b.0[f], c.0[f], d.0[f]);
            let (ox, oxy, oxz) = (next(&a), next(&b), next(&c));
            // Behind the last node signs are zero, and nothing crosses.
            let bits = [
                o.crossing(ox),
                o.crossing(oy),
                o.crossing(oz),
                (odd & o.crossing(oxy) | even & ox.crossing(oy)) & has_y,
                (odd & o.crossing(oxz) | even & ox.crossing(oz)) & has_z,
                (odd & o.crossing(oyz) | even & oy.crossing(oz)) & has_y & has_z,
            ];
            if bits.iter().fold(0, |any, b| any | b) != 0 {
                work.entries.push((FunctionId::of(f), bits));
                all.iter_mut().zip(bits).for_each(|(all, b)| *all |= b);
            }
        }
        (!work.entries.is_empty()).then_some(all)
    }

    #[inline]
    fn points(&self, at: At, edge: &Edge, work: &mut Self::Work, out: &mut Csr<FunctionId>) -> u32 {
        let zeros = at.ends.iter().all(|&[row, i]| self.signs.zero(row, i));
        if let ([(f, _)], false) = (&work.entries[..], zeros) {
            return arrangement_points(self.values, edge, std::iter::once(*f), false, &mut work.edge, out);
        }
        let crossing = work.entries.iter().filter(|e| e.1[at.slot] >> at.bit & 1 == 1).map(|e| e.0);
        arrangement_points(self.values, edge, crossing, zeros, &mut work.edge, out)
    }
}

/// The edges of a box that an arrangement crosses, and its points there.
pub fn arrangement_edges<'a>(grid: &'a BoxGrid, values: &Values, signs: &SignRows) -> BoxEdges<'a> {
    build(grid, &ArrangementRows { values, signs })
}

struct InterfaceRows<'a> {
    values: &'a Values<'a>,
    labels: &'a [Label],
}

impl Rows for InterfaceRows<'_> {
    type Work = EdgeWork;

    fn bits(&self, grid: &BoxGrid, place: Place, _: &mut EdgeWork) -> Option<[u64; SLOTS]> {
        let [nx, ny, nz] = grid.cells();
        let Place { j, k, row, word } = place;
        // The nodes of the word in a row, and the one behind them; an absent row is replaced by the row itself and masked.
        let (begin, end) = (word * 64, (word * 64 + 65).min(nx + 1));
        let at = |row: usize| &self.labels[row * (nx + 1) + begin..row * (nx + 1) + end];
        let (has_y, has_z) = (j < ny, k < nz);
        let o = at(row);
        let y = at(if has_y { row + 1 } else { row });
        let z = at(if has_z { row + ny + 1 } else { row });
        let yz = at(if has_y && has_z { row + ny + 2 } else { row });
        let uniform = |r: &[Label]| r.iter().fold(0, |any, l| any | l.difference(o[0])) == 0;
        if uniform(o) && uniform(y) && uniform(z) && uniform(yz) {
            return None;
        }
        let differ = |a: &[Label], b: &[Label]| {
            a.iter().zip(b).take(64).enumerate().fold(0u64, |w, (i, (a, b))| w | ((a.difference(*b) != 0) as u64) << i)
        };
        let [even, odd] = parities(place);
        let mut bits = [differ(o, &o[1..]), 0, 0, 0, 0, 0];
        // Of the nodes of the word only: where a word is full, the node behind it belongs to the next.
        if has_y {
            bits[1] = differ(o, y);
            bits[3] = odd & differ(o, &y[1..]) | even & differ(&o[1..], y);
        }
        if has_z {
            bits[2] = differ(o, z);
            bits[4] = odd & differ(o, &z[1..]) | even & differ(&o[1..], z);
        }
        if has_y && has_z {
            bits[5] = odd & differ(o, yz) | even & differ(y, z);
        }
        // Ties at nodes: the edge is crossed only if its ends have no material in common.
        for (slot, bits) in bits.iter_mut().enumerate() {
            let mut left = *bits;
            while left != 0 {
                let bit = left.trailing_zeros() as usize;
                left &= left - 1;
                let node = row * (nx + 1) + begin + bit;
                let [a, b] = ENDS[(begin + bit + j + k) & 1][slot].map(|s| node + step(grid, s));
                if (self.labels[a].tied() || self.labels[b].tied())
                    && share_material(self.values, NodeId::of(a), NodeId::of(b))
                {
                    *bits &= !(1 << bit);
                }
            }
        }
        Some(bits)
    }

    #[inline]
    fn points(&self, _: At, edge: &Edge, work: &mut EdgeWork, out: &mut Csr<FunctionId>) -> u32 {
        interface_points(self.values, edge, work, out)
    }
}

/// The edges of a box where the largest material changes, and the points where it does.
pub fn interface_edges<'a>(grid: &'a BoxGrid, values: &Values, labels: &[Label]) -> BoxEdges<'a> {
    build(grid, &InterfaceRows { values, labels })
}

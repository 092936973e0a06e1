//! Stage: the grid lines. Where each meets the surface, in order; whether the fluid is before and behind each of these hits; hence which
//! nodes are in the fluid; and the segments of the lines that faces of touched boxes need.
//!
//! A line's points are ordered by slab, and by coordinate only within a slab. Between two hits nothing changes, so a row of nodes is
//! filled in runs. Rows without a hit are uniform; they take their label from a line across: of the column of first nodes, of that
//! column's own first row, and only if no line at all is hit from outside knowledge (the whole mesh, or a known node).
//!
//! Segments are not stored where all of the four boxes around are untouched: they cost nothing but bits. Invariant: the label behind
//! a hit is the label before the next one; a contradiction means that the surface intersects itself.

use super::ground::{Ground, Slabs, on_plane};
use super::inside::{Spokes, beside};
use super::lattice::Lattice;
use super::pieces::Pieces;
use super::touched::{Bits, Ranks, Touched, others};
use crate::base::{Csr, Error, NodeId, Result, VertexId};
use crate::cut::surface::Surface;
use rayon::prelude::*;

/// Hits of the lines along one axis.
#[derive(Debug, Default)]
pub struct Hits {
    /// Rows as those of the nodes (`Bits` of nodes); points of the surface in order.
    pub points: Csr<VertexId>,
    /// Per entry: fluid before, fluid behind.
    pub beside: Vec<[bool; 2]>,
}

/// Lines and nodes of the block.
#[derive(Debug, Default)]
pub struct Lines {
    pub hits: [Hits; 3],
    /// Nodes in the fluid, not on the surface: rows along x.
    pub inside: Bits,
    /// Those at touched boxes, which become vertices, in order from `first_node` on.
    pub needed: Bits,
    pub ranks: Ranks,
    pub first_node: u32,
    pub nodes: Vec<NodeId>,
}

/// Slabs of all points of the surface.
#[derive(Clone, Copy)]
pub struct AllSlabs<'a> {
    pub ground: &'a Ground,
    pub pieces: &'a Pieces,
}

impl AllSlabs<'_> {
    #[inline(always)]
    pub fn of(&self, v: VertexId) -> Slabs {
        match v.at().checked_sub(self.ground.slabs.len()) {
            None => self.ground.slabs[v.at()],
            Some(i) => self.pieces.point_slabs[i],
        }
    }
    pub fn each(&self) -> impl Iterator<Item = Slabs> + Clone {
        self.ground.slabs.iter().chain(&self.pieces.point_slabs).copied()
    }
}

/// What to take a node for where no grid line meets the surface: asked at most once, for the block's first node.
pub type Known<'a> = dyn Fn() -> Result<bool> + 'a;

pub fn lines(surface: &Surface, slabs: AllSlabs, touched: &Touched, known: &Known) -> Result<Lines> {
    let ground = slabs.ground;
    let lattice = &ground.lattice;
    let first_node = slabs.ground.first_inner_point() + slabs.pieces.point_triangle.len() as u32;
    let mut lines = Lines { hits: hits(slabs), first_node, ..Default::default() };
    for axis in 0..3 {
        label(surface, slabs, axis, &mut lines.hits[axis])?;
    }
    let counts = lattice.node_counts();
    lines.inside = Bits::new(0, counts);
    fill_nodes(slabs, &mut lines, known)?;
    lines.needed = needed(lattice, touched, &lines.inside);
    lines.ranks = Ranks::new(&lines.needed);
    lines.nodes.reserve_exact(lines.ranks.count);
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            Bits::each(lines.needed.row(j, k), |i| lines.nodes.push(lattice.node_id([i, j, k])));
        }
    }
    Ok(lines)
}

/// The row of nodes along `axis` that a point on two planes of the other axes lies on.
#[inline(always)]
fn row_of(lattice: &Lattice, axis: usize, s: &Slabs) -> usize {
    let [b, c] = others(axis);
    s[b] as usize / 2 + lattice.nodes[b].len() * (s[c] as usize / 2)
}

fn hits(slabs: AllSlabs) -> [Hits; 3] {
    let lattice = &slabs.ground.lattice;
    // Nearly all points are on one plane: those on two are listed once, then sorted into rows.
    let mut on_lines: Vec<(VertexId, Slabs)> = Vec::new();
    for (v, s) in slabs.each().enumerate() {
        let planes = (s[0] & 1) + (s[1] & 1) + (s[2] & 1);
        if planes >= 2 && slabs.ground.in_block(&s) {
            on_lines.push((VertexId::of(v), s));
        }
    }
    std::array::from_fn(|axis| {
        let [b, c] = others(axis);
        let pairs = on_lines
            .iter()
            .filter(|(_, s)| on_plane(s[b]) && on_plane(s[c]))
            .map(|(v, s)| (row_of(lattice, axis, s), *v));
        let points = Csr::from_pairs(lattice.nodes[b].len() * lattice.nodes[c].len(), pairs);
        Hits { points, beside: Vec::new() }
    })
}

fn label(surface: &Surface, slabs: AllSlabs, axis: usize, hits: &mut Hits) -> Result<()> {
    const ROWS: usize = 1024;
    hits.beside = vec![[false; 2]; hits.points.items.len()];
    let offsets = &hits.points.offsets;
    // Rows are sorted and labelled apart from each other, in blocks that own their part of both arrays.
    let mut blocks = Vec::new();
    let (mut points, mut beside) = (&mut hits.points.items[..], &mut hits.beside[..]);
    for start in (0..offsets.len() - 1).step_by(ROWS) {
        let end = (start + ROWS).min(offsets.len() - 1);
        let count = (offsets[end] - offsets[start]) as usize;
        let (p, b);
        (p, points) = std::mem::take(&mut points).split_at_mut(count);
        (b, beside) = std::mem::take(&mut beside).split_at_mut(count);
        blocks.push((&offsets[start..=end], p, b));
    }
    blocks.into_par_iter().try_for_each_init(Spokes::default, |spokes, (offsets, points, beside)| {
        for w in offsets.windows(2) {
            let range = (w[0] - offsets[0]) as usize..(w[1] - offsets[0]) as usize;
            label_row(surface, slabs, axis, &mut points[range.clone()], &mut beside[range], spokes)?;
        }
        Ok(())
    })
}

fn label_row(
    surface: &Surface,
    slabs: AllSlabs,
    axis: usize,
    row: &mut [VertexId],
    labels: &mut [[bool; 2]],
    spokes: &mut Spokes,
) -> Result<()> {
    if row.len() > 1 {
        row.sort_by(|&a, &b| {
            let order = slabs.of(a)[axis].cmp(&slabs.of(b)[axis]);
            order.then_with(|| surface.compare_coordinate(a, b, axis))
        });
    }
    for (label, &v) in labels.iter_mut().zip(row.iter()) {
        *label = beside(slabs.ground, surface, v, axis, spokes);
    }
    match labels.windows(2).position(|w| w[0][1] != w[1][0]) {
        None => Ok(()),
        Some(i) => {
            let x = surface.coords[row[i].at()];
            Err(Error::inconsistent(format!(
                "the grid line along axis {axis} through ({}, {}, {}) is inside the fluid at one end of a segment and outside at \
                 the other: the surface intersects itself",
                x[0], x[1], x[2]
            )))
        }
    }
}

/// Calls `run(first node, end node, inside)` for the runs of nodes of a row with hits; nodes on the surface are in none.
#[inline]
fn runs(slabs: AllSlabs, axis: usize, hits: &Hits, row: usize, nodes: u32, mut run: impl FnMut(u32, u32, bool)) {
    let range = hits.points.range(row);
    let mut from = 0;
    for i in range.clone() {
        let s = slabs.of(hits.points.items[i])[axis];
        // Nodes before the hit: 2q + 1 < s.
        let to = s / 2;
        if from < to {
            run(from, to, hits.beside[i][0]);
        }
        from = s.div_ceil(2);
    }
    if from < nodes && !range.is_empty() {
        run(from, nodes, hits.beside[range.end - 1][1]);
    }
}

#[inline]
fn set_range(row: &mut [u64], from: usize, to: usize) {
    for (w, word) in row.iter_mut().enumerate().take(to.div_ceil(64)).skip(from / 64) {
        let low = from.saturating_sub(w * 64);
        let high = (to - w * 64).min(64);
        *word |= (!0u64 >> (64 - (high - low))) << low;
    }
}

fn fill_nodes(slabs: AllSlabs, lines: &mut Lines, known: &Known) -> Result<()> {
    let [nx, ny, nz] = slabs.ground.lattice.node_counts();
    let Lines { hits, inside, .. } = lines;
    // The column of first nodes: its status at (0, j, k), for rows along x without a hit.
    let uniform = || -> Result<bool> {
        // No line along z through the first nodes is hit: they are all alike, and any line that leaves them tells.
        for k in 0..nz {
            if let Some(&first) = hits[1].points.row(nx * k).first() {
                let at = hits[1].points.range(nx * k).start;
                debug_assert!(slabs.of(first)[1] > 1);
                return Ok(hits[1].beside[at][0]);
            }
        }
        if let Some(&first) = hits[0].points.items.first() {
            debug_assert!(slabs.of(first)[0] > 1);
            return Ok(hits[0].beside[0][0]);
        }
        known()
    };
    let mut first_column = vec![false; nz];
    if hits[2].points.row(0usize).is_empty() {
        // Asked only if some row needs it.
        if (0..nz).any(|k| hits[1].points.row(nx * k).is_empty())
            && (0..ny * nz).any(|r| hits[0].points.row(r).is_empty())
        {
            first_column = vec![uniform()?; nz];
        }
    } else {
        runs(slabs, 2, &hits[2], 0, nz as u32, |from, to, value| {
            first_column[from as usize..to as usize].fill(value);
        });
    }
    let mut first_nodes = vec![false; ny * nz];
    for k in 0..nz {
        let row = &mut first_nodes[ny * k..ny * (k + 1)];
        if hits[1].points.row(nx * k).is_empty() {
            row.fill(first_column[k]);
        } else {
            runs(slabs, 1, &hits[1], nx * k, ny as u32, |from, to, value| {
                row[from as usize..to as usize].fill(value);
            });
        }
    }
    let words = inside.words;
    inside.bits.par_chunks_mut(words).zip(first_nodes).with_min_len(1024).enumerate().for_each(|(r, (row, first))| {
        if hits[0].points.row(r).is_empty() {
            if first {
                set_range(row, 0, nx);
            }
        } else {
            runs(slabs, 0, &hits[0], r, nx as u32, |from, to, value| {
                if value {
                    set_range(row, from as usize, to as usize);
                }
            });
        }
    });
    Ok(())
}

/// Nodes in the fluid with a touched box around them.
fn needed(lattice: &Lattice, touched: &Touched, inside: &Bits) -> Bits {
    let counts = lattice.node_counts();
    let mut out = Bits::new(0, counts);
    let rows = [lattice.count(1), lattice.count(2)];
    let mut boxes = Vec::new();
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            touched.along[0].around(j, k, rows, &mut boxes);
            let (to, from) = (out.row_mut(j, k), inside.row(j, k));
            let mut carry = 0;
            for (w, (to, from)) in to.iter_mut().zip(from).enumerate() {
                let word = boxes.get(w).copied().unwrap_or(0);
                *to = (word | word << 1 | carry) & from;
                carry = word >> 63;
            }
        }
    }
    out
}

fn disagreement(axis: usize) -> Error {
    Error::inconsistent(format!(
        "a node is in the fluid as seen along axis {axis} and outside as seen along x: the surface intersects itself"
    ))
}

impl Lines {
    /// The vertex of a needed node; `NONE` if the node is not one.
    #[inline(always)]
    fn node_vertex(&self, [i, j, k]: [usize; 3]) -> VertexId {
        if self.needed.get(i, j, k) {
            VertexId(self.first_node + self.ranks.of(&self.needed, i, j, k))
        } else {
            VertexId::NONE
        }
    }

    /// Calls `segment(from, to, layer)` for each elementary segment in the fluid on the line along `axis` through nodes `b`, `c` of the
    /// other axes, as far as touched boxes are around it. `boxes`: their rows around the line (`Bits::around`).
    ///
    /// Fails where this line has a node in the fluid that the line along x through it has outside: the surface intersects itself.
    #[inline]
    pub fn each_segment(
        &self,
        slabs: AllSlabs,
        axis: usize,
        [b, c]: [usize; 2],
        boxes: &[u64],
        mut segment: impl FnMut(VertexId, VertexId, u32),
    ) -> Result<()> {
        let lattice = &slabs.ground.lattice;
        let nodes = lattice.nodes[axis].len() as u32;
        let node = |q: u32| {
            let mut at = [0; 3];
            let [ob, oc] = others(axis);
            (at[axis], at[ob], at[oc]) = (q as usize, b, c);
            at
        };
        let row = b + lattice.nodes[others(axis)[0]].len() * c;
        let range = self.hits[axis].points.range(row);
        let mut agreed = true;
        let mut segment = |from: VertexId, to: VertexId, layer: u32| {
            agreed &= from.is_some() && to.is_some();
            if agreed {
                segment(from, to, layer);
            }
        };
        let mut stretch = |from: Option<VertexId>, to: Option<VertexId>, first: u32, end: u32| {
            if first >= end {
                if let (Some(from), Some(to)) = (from, to) {
                    segment(from, to, first - 1);
                }
                return;
            }
            if let Some(from) = from {
                segment(from, self.node_vertex(node(first)), first - 1);
            }
            // Layers first..end - 1 between nodes.
            let words = first as usize / 64..(end as usize - 1).div_ceil(64);
            for (w, &word) in boxes.iter().enumerate().take(words.end).skip(words.start) {
                let low = (first as usize).saturating_sub(w * 64);
                let high = (end as usize - 1 - w * 64).min(64);
                if low >= high {
                    continue;
                }
                let mut left = word & ((!0u64 >> (64 - (high - low))) << low);
                while left != 0 {
                    let q = (w * 64) as u32 + left.trailing_zeros();
                    left &= left - 1;
                    segment(self.node_vertex(node(q)), self.node_vertex(node(q + 1)), q);
                }
            }
            if let Some(to) = to {
                segment(self.node_vertex(node(end - 1)), to, end - 1);
            }
        };
        if range.is_empty() {
            if self.inside.get(node(0)[0], node(0)[1], node(0)[2]) {
                stretch(None, None, 0, nodes);
            }
            return if agreed { Ok(()) } else { Err(disagreement(axis)) };
        }
        let hits = &self.hits[axis];
        let mut from: Option<VertexId> = None;
        let mut first = 0;
        for i in range.clone() {
            let v = hits.points.items[i];
            let s = slabs.of(v)[axis];
            if hits.beside[i][0] {
                stretch(from, Some(v), first, s / 2);
            }
            (from, first) = (Some(v), s.div_ceil(2));
        }
        if hits.beside[range.end - 1][1] {
            stretch(from, None, first, nodes);
        }
        if agreed { Ok(()) } else { Err(disagreement(axis)) }
    }

    pub fn check(&self) -> std::result::Result<(), String> {
        for hits in &self.hits {
            hits.points.check()?;
            if hits.beside.len() != hits.points.items.len() {
                return Err("hits of grid lines have no labels".into());
            }
        }
        if self.nodes.len() != self.ranks.count || self.nodes.windows(2).any(|w| w[0] >= w[1]) {
            return Err("nodes are not numbered in order".into());
        }
        Ok(())
    }
}

//! Patches → cells: radial order around edges with more than two faces, then lines through space (`nesting`).
//!
//! Around an edge, faces in exact radial order bound one wedge of space between each two neighbours: the sides that look into it are sides of one cell. A
//! shell is a class of sides joined so. All sides of one cell are one shell, or shells of different edge-connected components of
//! the surface, which lines join.
//!
//! The order is found from supports' normals and the axis along which the edge rises; no constructed direction is read (`complex::radial`). Two faces in one
//! half-plane would overlap: resolved faces do not.
//!
//! Cost: a sort around each such edge; the lines as told there; the rest is linear.

use super::patches::{HalfPatch, Patches, Walk};
use super::{Cells, Resolved, nesting};
use crate::base::parallel::map_ranges;
use crate::base::{CellId, Error, FaceId, Result, Run, SharedUnionFind, Status, UnionFind, VertexId, Watch};
use crate::complex::radial::sort_around;
use crate::complex::{HalfFace, SupportId};
use crate::exact;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Elements in one task at least.
const LEAST: usize = 1 << 10;
const BLOCK: usize = 1 << 16;
/// Fans between two looks at the caller's wish to stop.
const OFTEN: usize = 64;

/// Joins the sides of patches to cells. Errors: `Cancelled`; `Internal` where resolved faces overlap.
pub fn cells(r: &Resolved, patches: Patches, run: &mut Run) -> Result<Cells> {
    let count = patches.lowest.len();
    // The outside first, so that its set is number 0; then sides of patches.
    let sets = SharedUnionFind::new(1 + 2 * count);
    let mut start = 0;
    while start < patches.fans.len() {
        let block = start..patches.fans.len().min(start + BLOCK);
        let join = |range: std::ops::Range<usize>, watch: &Watch| {
            let mut order = Vec::new();
            for e in block.start + range.start..block.start + range.end {
                if e % OFTEN == 0 {
                    watch.check()?;
                }
                join_around(r, &patches, e, &mut order, &sets)?;
            }
            Ok(())
        };
        let outcomes = run.watched("cells", 0.8, |watch| map_ranges(block.len(), LEAST, |range| join(range, watch)))?;
        outcomes.into_iter().collect::<Result<()>>()?;
        start = block.end;
        run.tick("cells", 0.8)?;
    }
    let mut components = UnionFind::new(count);
    for row in patches.fans.rows() {
        let patch = |w: &Walk| patches.behind[w.face().at()].patch().at();
        row[1..].iter().for_each(|w| {
            components.union(patch(&row[0]), patch(w));
        });
    }
    let (component, component_count) = components.labels();
    run.stage("nesting", 0.85)?;
    nesting::join(r, &patches, &component, component_count, &sets, run)?;
    let (cell, lowest) = sets.labels(|_| true);
    let side = |h: HalfPatch| if h.is_none() { CellId::NONE } else { CellId(cell[1 + h.at()]) };
    let mut of = vec![CellId::NONE; 2 * r.faces.len()];
    of.par_chunks_exact_mut(2).zip(&patches.behind).with_min_len(1 << 14).for_each(|(of, &behind)| {
        if !behind.is_none() {
            [of[0], of[1]] = [side(behind), side(behind.other())];
        }
    });
    let mut first = vec![HalfFace(u32::MAX); lowest.len()];
    for h in 0..2 * count {
        let half_face = HalfFace::new(patches.lowest[h / 2], h & 1 != 0);
        let place = &mut first[cell[1 + h] as usize];
        *place = half_face.min(*place);
    }
    let patch = patches.behind.par_iter().with_min_len(1 << 14).map(|h| h.patch()).collect();
    let Patches { lowest: patch_face, multiplicity, .. } = patches;
    Ok(Cells { patch, patch_face, multiplicity, of, cell_count: lowest.len(), lowest: first })
}

/// Joins the sides that look into the same wedge around a fan's edge.
fn join_around(r: &Resolved, p: &Patches, e: usize, order: &mut Vec<u32>, sets: &SharedUnionFind) -> Result<()> {
    let walks = p.fans.row(e);
    let (axis, rises) = edge_axis(r, p.fan_ends[e])?;
    order.clear();
    order.extend(0..walks.len() as u32);
    let walk = |i: u32| walks[i as usize];
    let triangle = |i: u32| r.support[walk(i).face().at()];
    let same = |i: u32, j: u32| walk(i).forward() == walk(j).forward();
    let support = |i: u32| SupportId::Triangle(triangle(i));
    let normal = |i: u32| r.soup.direction(triangle(i));
    sort_around(order, axis, rises, support, normal, same);
    for (k, &i) in order.iter().enumerate() {
        let j = order[if k + 1 == order.len() { 0 } else { k + 1 }];
        if triangle(i) == triangle(j) && same(i, j) {
            return Err(overlap(walk(i).face(), walk(j).face()));
        }
        // Turning counterclockwise, a face that walks the edge forward is met on its back and left on its front.
        let far = p.side(HalfFace::new(walk(i).face(), walk(i).forward()));
        let near = p.side(HalfFace::new(walk(j).face(), !walk(j).forward()));
        sets.union(1 + far.at(), 1 + near.at());
    }
    Ok(())
}

/// An axis along which the ends of an edge differ, and whether the coordinate rises from the first to the second.
fn edge_axis(r: &Resolved, [a, b]: [VertexId; 2]) -> Result<(usize, bool)> {
    let (x, y) = (r.coords(a), r.coords(b));
    // The widest first: it nearly always differs already when rounded.
    let best = (0..3).max_by(|&i, &j| (x[i] - y[i]).abs().total_cmp(&(x[j] - y[j]).abs())).unwrap_or(0);
    for axis in [best, (best + 1) % 3, (best + 2) % 3] {
        match exact::compare_rounded(x[axis], y[axis], || r.point(a), || r.point(b), axis) {
            Ordering::Equal => {}
            order => return Ok((axis, order == Ordering::Less)),
        }
    }
    Err(Error::new(Status::Internal, format!("vertices {} and {} are the same point", a.0, b.0)))
}

pub(super) fn overlap(f: FaceId, g: FaceId) -> Error {
    Error::new(Status::Internal, format!("faces {} and {} of the arrangement overlap", f.0, g.0))
}

impl Cells {
    /// What [`cells`] promises: every face that divides has two different cells, cells are numbered by lowest half-face behind the unbounded one.
    pub fn check(&self) -> std::result::Result<(), String> {
        self.multiplicity.check()?;
        if self.of.len() != 2 * self.patch.len() || self.lowest.len() != self.cell_count {
            return Err("cells: lengths differ".into());
        }
        let mut next = 1;
        for (h, &c) in self.of.iter().enumerate() {
            if c.is_none() != self.patch[h / 2].is_none() {
                return Err(format!("half-face {h} has a cell and no patch, or the other way round"));
            }
            if c.is_none() {
                continue;
            }
            if c == self.of[h ^ 1] {
                return Err(format!("face {} has cell {} on both sides", h / 2, c.0));
            }
            if c.at() > next || (c.at() == next && self.lowest[next] != HalfFace(h as u32)) {
                return Err(format!("cell {} is not numbered by its lowest half-face", c.0));
            }
            next = next.max(c.at() + 1);
        }
        if next != self.cell_count {
            return Err("a cell has no half-face".into());
        }
        Ok(())
    }
}

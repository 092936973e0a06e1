//! Aggregation of small cells: a map from each cut cell to the cell or full box that stands for it, so that the volume
//! fractions of what is merged add up to a minimum at least. The geometry stays as it is.
//!
//! In rounds: every aggregate that is too small names its largest face (ties: the larger fraction beyond, then the lower face) to another
//! aggregate or a full box; then, from the smallest aggregate up, those that are still too small merge across the face they
//! named. So chains end as soon as they suffice. A full box suffices at once. A round at least halves the number of
//! aggregates that are too small and can merge, and looks only at faces that still lead from one; nothing depends on threads.
//! Cost: linear in the faces of small cells, times the (few) rounds. Memory: 25 bytes per cell, 4 per such face.

use super::data::{FULL_CELL, GridCells};
use super::full_faces::box_beside;
use super::moments::{GridMoments, cell_boxes};
use crate::base::{BoxId, CellId, FaceId, UnionFind};

#[derive(Clone, Copy, Debug)]
pub struct AggregateOptions {
    /// The volume fraction that an aggregate must reach: the sum of its members', each relative to its own box. At most 1,
    /// which a full box always reaches (more is taken for 1).
    pub minimum: f64,
}

impl Default for AggregateOptions {
    fn default() -> Self {
        Self { minimum: 0.5 }
    }
}

/// Which cells stand together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aggregates {
    /// Per cell: the member that stands for its aggregate, the one with the largest fraction (then the lowest); `FULL_CELL` for a full box.
    pub cell: Vec<CellId>,
    /// And the box of that cell, or the full box.
    pub in_box: Vec<BoxId>,
    /// Cells that stand for an aggregate below the minimum, rising: all its faces are at walls, at the block's boundary or marked.
    pub too_small: Vec<CellId>,
}

/// What a face offers to the aggregate on one of its sides. Later is better.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct Offer {
    area: f64,
    fraction: f64,
    face: FaceId,
    /// The side of the face that the aggregate is on.
    side: usize,
}

impl Offer {
    fn beats(&self, other: &Option<Offer>) -> bool {
        let Some(o) = other else { return true };
        (self.area, self.fraction) > (o.area, o.fraction)
            || (self.area, self.fraction) == (o.area, o.fraction) && self.face < o.face
    }
}

/// Aggregates the small cells of a block. Nothing merges across a face in a grid plane that `closed_faces` marks (a byte per
/// such face, not zero), nor with a cell that `closed_cells` marks.
pub fn aggregate(
    g: &GridCells,
    m: &GridMoments,
    options: &AggregateOptions,
    closed_faces: Option<&[u8]>,
    closed_cells: Option<&[u8]>,
) -> Aggregates {
    let cells = g.cell_count();
    let minimum = options.minimum.min(1.0);
    let mut sets = UnionFind::new(cells);
    // Of each aggregate, at its root: the sum of fractions (a full box counts 1), and the full box.
    let mut sum = m.cell_fraction.clone();
    let mut full = vec![BoxId::NONE; cells];
    let closed = |marks: Option<&[u8]>, i: usize| marks.is_some_and(|m| m[i] != 0);
    let first = g.plane_faces[0];
    let is_open = |k: usize| {
        let sides = g.square_cells[k];
        let usable = |c: CellId| c == FULL_CELL || c.is_some() && !closed(closed_cells, c.at());
        let small = |c: CellId| c.is_some() && c != FULL_CELL && m.cell_fraction[c.at()] < minimum;
        !closed(closed_faces, k) && sides.iter().all(|&c| usable(c)) && sides.iter().any(|&c| small(c))
    };
    let mut faces: Vec<FaceId> =
        (0..g.square_cells.len()).filter(|&k| is_open(k)).map(|k| FaceId(first + k as u32)).collect();
    let mut offers: Vec<Option<Offer>> = vec![None; cells];
    while !faces.is_empty() {
        let mut waiting: Vec<usize> = Vec::new();
        faces.retain(|&f| {
            let k = (f.0 - first) as usize;
            let sides = g.square_cells[k];
            let roots = sides.map(|c| (c != FULL_CELL).then(|| sets.find(c.at())));
            if roots[0] == roots[1] {
                return false;
            }
            let mut live = false;
            for side in 0..2 {
                let Some(root) = roots[side] else { continue };
                if sum[root] < minimum {
                    live = true;
                    let other = sides[1 - side];
                    let fraction = if other == FULL_CELL { 1.0 } else { m.cell_fraction[other.at()] };
                    let offer = Offer { area: m.face_area[k], fraction, face: f, side };
                    if offers[root].is_none() {
                        waiting.push(root);
                    }
                    if offer.beats(&offers[root]) {
                        offers[root] = Some(offer);
                    }
                }
            }
            live
        });
        waiting.sort_unstable_by(|&a, &b| sum[a].total_cmp(&sum[b]).then(a.cmp(&b)));
        for root in waiting {
            let Some(offer) = offers[root].take() else { continue };
            let here = sets.find(root);
            if sum[here] >= minimum {
                continue;
            }
            let other = g.square_cells[(offer.face.0 - first) as usize][1 - offer.side];
            if other == FULL_CELL {
                full[here] = box_beside(g, offer.face, 1 - offer.side);
                sum[here] += 1.0;
                continue;
            }
            let there = sets.find(other.at());
            if here != there {
                let total = sum[here] + sum[there];
                // Only aggregates that suffice have a full box, so at most one of the two does.
                let with = if full[here].is_some() { full[here] } else { full[there] };
                sets.union(here, there);
                let root = here.min(there);
                (sum[root], full[root]) = (total, with);
            }
        }
    }
    represent(g, m, minimum, sets, &sum, &full)
}

fn represent(
    g: &GridCells,
    m: &GridMoments,
    minimum: f64,
    mut sets: UnionFind,
    sum: &[f64],
    full: &[BoxId],
) -> Aggregates {
    let cells = g.cell_count();
    let boxes = cell_boxes(g);
    let roots: Vec<u32> = (0..cells).map(|c| sets.find(c) as u32).collect();
    let mut best: Vec<CellId> = (0..cells).map(CellId::of).collect();
    for (c, &root) in roots.iter().enumerate() {
        let b = &mut best[root as usize];
        if m.cell_fraction[c] > m.cell_fraction[b.at()] {
            *b = CellId::of(c);
        }
    }
    let mut out = Aggregates::default();
    for (c, &root) in roots.iter().enumerate() {
        let root = root as usize;
        let (cell, in_box) =
            if full[root].is_some() { (FULL_CELL, full[root]) } else { (best[root], boxes[best[root].at()]) };
        out.cell.push(cell);
        out.in_box.push(in_box);
        if cell.at() == c && sum[root] < minimum {
            out.too_small.push(cell);
        }
    }
    out
}

impl Aggregates {
    /// A cell that stands for others stands for itself, and is in its own box.
    pub fn check(&self, g: &GridCells) -> Result<(), String> {
        let boxes = cell_boxes(g);
        for (c, &r) in self.cell.iter().enumerate() {
            if r == FULL_CELL {
                if g.flags[self.in_box[c].at()] != super::data::FULL {
                    return Err(format!("cell {c} belongs to a box that is not full"));
                }
            } else if self.cell[r.at()] != r || self.in_box[c] != boxes[r.at()] {
                return Err(format!("cell {c} belongs to cell {}, which does not stand for itself", r.0));
            }
        }
        Ok(())
    }
}

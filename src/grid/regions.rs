//! Connected regions of fluid, through full boxes and cut cells.
//!
//! Full boxes count as runs along x: a row of boxes between two walls is one. Runs of neighbouring rows that overlap are
//! connected, and so are the cells (or runs) on the two sides of each face in a grid plane; cells that touch along
//! edges or at vertices are not. Regions are numbered by their lowest box, then cell.
//! Cost: a byte per box, the rest linear in runs, cells and faces; memory: 16 bytes per run, 8 per cell.

use super::data::{CUT, FULL, FULL_CELL, GridCells};
use super::exact_moments::fans;
use super::full_faces::box_beside;
use crate::base::{BoxId, CellId, FaceId, RegionId, UnionFind};
use crate::complex::exact_values::Coordinates;
use crate::exact::{Sign, orient3d};
use crate::mesh::inside::holds;
use rayon::prelude::*;
use rug::Rational;

/// The region of every cut cell and of every full box; of full boxes as runs along x.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Regions {
    pub count: usize,
    /// The region of each cell.
    pub cell_region: Vec<RegionId>,
    /// Row `j + ny·k` of boxes has runs `row_runs[row]..row_runs[row + 1]`.
    pub row_runs: Vec<u32>,
    /// Run `r` is boxes `run_boxes[r][0]..run_boxes[r][1]`, as rising ids; all of them full, those before and after are not (or
    /// in another row).
    pub run_boxes: Vec<[BoxId; 2]>,
    pub run_region: Vec<RegionId>,
}

/// Where a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointPlace {
    Region(RegionId),
    /// Not in the fluid.
    Solid,
    /// On the surface, exactly.
    Surface,
    /// Outside the block's closed box (or not finite).
    Beyond,
}

/// The regions of a block.
pub fn regions(g: &GridCells) -> Regions {
    let mut out = runs(g);
    let runs = out.run_boxes.len();
    let cells = g.cell_count();
    let mut sets = UnionFind::new(runs + cells);
    join_runs(g, &out, &mut sets);
    for (k, sides) in g.square_cells.iter().enumerate() {
        if sides.iter().any(|c| c.is_none()) {
            continue;
        }
        let f = FaceId(g.plane_faces[0] + k as u32);
        let [a, b] = [0, 1].map(|side| match sides[side] {
            FULL_CELL => out.run_of(g, box_beside(g, f, side)).expect("a full box is in a run"),
            c => runs + c.at(),
        });
        sets.union(a, b);
    }
    let (labels, count) = sets.labels();
    // By lowest box, then cell (a run comes before the cells of other boxes only as its box does; no box has both).
    let mut least = vec![u64::MAX; count];
    for (r, boxes) in out.run_boxes.iter().enumerate() {
        let least = &mut least[labels[r] as usize];
        *least = (*least).min((boxes[0].0 as u64) << 32);
    }
    for (b, range) in g.cut_boxes.iter().zip(g.box_cells.windows(2)) {
        for c in range[0]..range[1] {
            let least = &mut least[labels[runs + c as usize] as usize];
            *least = (*least).min((b.0 as u64) << 32 | c as u64);
        }
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_unstable_by_key(|&i| least[i]);
    let mut number = vec![RegionId::NONE; count];
    order.iter().enumerate().for_each(|(n, &i)| number[i] = RegionId::of(n));
    out.count = count;
    out.run_region = labels[..runs].iter().map(|&l| number[l as usize]).collect();
    out.cell_region = labels[runs..].iter().map(|&l| number[l as usize]).collect();
    out
}

/// The runs of full boxes, without regions.
fn runs(g: &GridCells) -> Regions {
    let nx = g.lattice.count(0);
    let rows: Vec<(Vec<u32>, Vec<[BoxId; 2]>)> = g
        .flags
        .par_chunks(nx * g.lattice.count(1))
        .enumerate()
        .map(|(k, layer)| {
            let first = k * layer.len();
            let (mut counts, mut runs) = (Vec::new(), Vec::new());
            for (j, row) in layer.chunks(nx).enumerate() {
                let before = runs.len();
                let mut i = 0;
                while let Some(start) = row[i..].iter().position(|&f| f == FULL) {
                    let start = i + start;
                    i = row[start..].iter().position(|&f| f != FULL).map_or(nx, |n| start + n);
                    runs.push([start, i].map(|x| BoxId::of(first + j * nx + x)));
                }
                counts.push((runs.len() - before) as u32);
            }
            (counts, runs)
        })
        .collect();
    let mut out = Regions { row_runs: vec![0], ..Default::default() };
    for (counts, runs) in rows {
        for n in counts {
            out.row_runs.push(out.row_runs[out.row_runs.len() - 1] + n);
        }
        out.run_boxes.extend(runs);
    }
    out
}

/// Joins runs of neighbouring rows that overlap.
fn join_runs(g: &GridCells, r: &Regions, sets: &mut UnionFind) {
    let [nx, ny, nz] = [0, 1, 2].map(|a| g.lattice.count(a));
    let mut join = |low: usize, high: usize| {
        let shift = ((high - low) * nx) as u32;
        let (mut a, a_end) = (r.row_runs[low] as usize, r.row_runs[low + 1] as usize);
        let (mut b, b_end) = (r.row_runs[high] as usize, r.row_runs[high + 1] as usize);
        while a < a_end && b < b_end {
            let [p, q] = r.run_boxes[a].map(|x| x.0 + shift);
            let [s, t] = r.run_boxes[b].map(|x| x.0);
            if p < t && s < q {
                sets.union(a, b);
            }
            if q < t { a += 1 } else { b += 1 }
        }
    };
    for k in 0..nz {
        for j in 0..ny {
            let row = j + ny * k;
            if j + 1 < ny {
                join(row, row + 1);
            }
            if k + 1 < nz {
                join(row, row + ny);
            }
        }
    }
}

impl Regions {
    /// The run that holds a full box.
    fn run_of(&self, g: &GridCells, b: BoxId) -> Option<usize> {
        let row = b.at() / g.lattice.count(0);
        let (first, end) = (self.row_runs[row] as usize, self.row_runs[row + 1] as usize);
        let r = first + self.run_boxes[first..end].partition_point(|run| run[1] <= b);
        (r < end && self.run_boxes[r][0] <= b).then_some(r)
    }

    /// The region of a full box; `NONE` for others, whose cells may be in several.
    pub fn region_of_box(&self, g: &GridCells, b: BoxId) -> RegionId {
        self.run_of(g, b).map_or(RegionId::NONE, |r| self.run_region[r])
    }

    /// A byte per cell and a byte per box: 1 for the region's cells and full boxes.
    pub fn mask(&self, g: &GridCells, region: RegionId) -> (Vec<u8>, Vec<u8>) {
        let cells = self.cell_region.iter().map(|&r| (r == region) as u8).collect();
        let mut boxes = vec![0; g.lattice.box_count()];
        for (run, &r) in self.run_boxes.iter().zip(&self.run_region) {
            if r == region {
                boxes[run[0].at()..run[1].at()].fill(1);
            }
        }
        (cells, boxes)
    }

    /// The region that holds a point, exactly. A point on a grid plane belongs to the fluid around it, which is one region.
    /// Cost: linear in the mesh's triangles, and in a cut box some hundred microseconds per cell of ordinary size.
    pub fn at_point(&self, g: &GridCells, x: &[f64; 3]) -> PointPlace {
        let mut at = [0; 3];
        for a in 0..3 {
            let nodes = &g.lattice.nodes[a];
            if !(nodes[0] <= x[a] && x[a] <= nodes[nodes.len() - 1]) {
                return PointPlace::Beyond;
            }
            at[a] = nodes.partition_point(|n| *n <= x[a]).min(nodes.len() - 1) - 1;
        }
        if on_surface(g, x) {
            return PointPlace::Surface;
        }
        let b = g.lattice.box_id(at);
        match g.flags[b.at()] {
            FULL => PointPlace::Region(self.region_of_box(g, b)),
            CUT => {
                // From the box's low sides into the box, from the block's high sides back.
                let high: [bool; 3] = std::array::from_fn(|a| x[a] == g.lattice.nodes[a][at[a] + 1]);
                let cell = g.cells_of(b).map(CellId).find(|&c| holds_point(g, c, x, high));
                cell.map_or(PointPlace::Solid, |c| PointPlace::Region(self.cell_region[c.at()]))
            }
            _ => PointPlace::Solid,
        }
    }

    /// Runs are full boxes, all of them, and sorted; regions are numbered by their lowest box, then cell.
    pub fn check(&self, g: &GridCells) -> Result<(), String> {
        let nx = g.lattice.count(0);
        let mut full = vec![false; g.flags.len()];
        for (row, w) in self.row_runs.windows(2).enumerate() {
            let mut end = row * nx;
            for r in w[0] as usize..w[1] as usize {
                let [a, b] = self.run_boxes[r].map(BoxId::at);
                if a < end || a >= b || b > (row + 1) * nx {
                    return Err(format!("run {r} is not in order"));
                }
                full[a..b].fill(true);
                end = b + 1;
            }
        }
        if full.iter().zip(&g.flags).any(|(run, flag)| *run != (*flag == FULL)) {
            return Err("the runs are not the full boxes".into());
        }
        let mut first: Vec<(BoxId, CellId, RegionId)> = Vec::new();
        first.extend(self.run_boxes.iter().zip(&self.run_region).map(|(b, &r)| (b[0], CellId(0), r)));
        for (b, w) in g.cut_boxes.iter().zip(g.box_cells.windows(2)) {
            first.extend((w[0]..w[1]).map(|c| (*b, CellId(c), self.cell_region[c as usize])));
        }
        first.sort_unstable();
        let mut next = 0;
        for (b, _, r) in first {
            if r.at() > next || r.at() >= self.count {
                return Err(format!("region {} in box {} is numbered too early", r.0, b.0));
            }
            next += (r.at() == next) as usize;
        }
        if next != self.count {
            return Err(format!("{} regions, but {next} are used", self.count));
        }
        Ok(())
    }
}

/// Whether a triangle holds the point.
fn on_surface(g: &GridCells, x: &[f64; 3]) -> bool {
    g.mesh.triangles.par_iter().any(|t| {
        let q = t.map(|v| g.mesh.vertices[v.at()]);
        let near = |a: usize| {
            let (low, high) = (q[0][a].min(q[1][a]).min(q[2][a]), q[0][a].max(q[1][a]).max(q[2][a]));
            low <= x[a] && x[a] <= high
        };
        (0..3).all(near) && orient3d(&q[0], &q[1], &q[2], x) == Sign::Zero && holds(&q, x)
    })
}

fn det(a: &Coordinates, b: &Coordinates, c: &Coordinates) -> Rational {
    let term = |i: usize, j: usize, k: usize| &a[i] * (Rational::from(&b[j] * &c[k]) - Rational::from(&b[k] * &c[j]));
    term(0, 1, 2) + term(1, 2, 0) + term(2, 0, 1)
}

/// Whether a cell holds a point of its closed box that is not on the surface: the winding number of its surface around the
/// point moved a little into the box, by a ray in that direction; another direction if the ray meets an edge.
fn holds_point(g: &GridCells, c: CellId, x: &[f64; 3], high: [bool; 3]) -> bool {
    let origin = x.map(|x| Rational::from_f64(x).unwrap_or_default());
    'directions: for k in 1i64.. {
        let size = [Rational::from(7 * k), Rational::from(3 * k * k + 1), Rational::from(2 * k * k * k + 5)];
        let mut axis = 0;
        let direction = size.map(|s| {
            axis += 1;
            if high[axis - 1] { -s } else { s }
        });
        let (mut winding, mut degenerate) = (0, false);
        for h in g.cell_faces(c) {
            fans(g, h.face(), &origin, |[p, q, r]| {
                // In a plane with the point: not ahead, whatever its edges. (So are fan triangles without area.)
                let height = det(p, q, r).cmp0() as i32;
                if height == 0 {
                    return;
                }
                let turns = [det(&direction, p, q), det(&direction, q, r), det(&direction, r, p)];
                let turns = turns.map(|d| d.cmp0() as i32);
                if turns.contains(&1) && turns.contains(&-1) {
                    return;
                }
                if turns.contains(&0) {
                    degenerate = true;
                    return;
                }
                // Ahead, and seen from behind: the ray leaves.
                if height == turns[0] {
                    winding += if h.front() { -turns[0] } else { turns[0] };
                }
            });
            if degenerate {
                continue 'directions;
            }
        }
        return winding > 0;
    }
    unreachable!("some direction meets no edge")
}

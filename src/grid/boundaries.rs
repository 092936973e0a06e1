//! Walls: area vectors and centroids per cell, per cell and tag, and per wall; which walls and boxes cells have. Values stand for the exact
//! ones as in [`super::moments`]: fixed-point sums ([`super::wall_sums`]), then rationals.
//!
//! Closure: a cell's wall area vector and the areas of its faces in grid planes sum to zero within half an ulp per term.
//! Cost: some 500 ns per cut cell on one thread; memory: the outputs, and 16 bytes per triangle.

use super::cell_sums::on_high_side;
use super::data::GridCells;
use super::exact_moments;
use super::fixed_point::{Frames, Interval};
use super::gathered::{Gathered, normals_of};
use super::moments::{BOXES, GridMoments, ITEMS, cell_boxes, is_square, settle_all, split, tasks};
use super::wall_sums::{Normal, WallSums, WallValues};
use crate::base::processor::dispatched;
use crate::base::{BoxId, CellId, Csr, FaceId, TriangleId};
use rayon::prelude::*;
use std::ops::Range;

/// The walls of each cell together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundaries {
    /// Area vector: points out of the fluid.
    pub area: Vec<[f64; 3]>,
    /// ∫ x |dA| / ∫ |dA| over the cell's walls; the cell's centroid if it has none.
    pub centroid: Vec<[f64; 3]>,
    /// 1: a value is beyond the range of doubles, see [`GridMoments`].
    pub flags: Vec<u8>,
    /// How many cells needed rationals.
    pub exact_cells: usize,
}

/// Walls by cell and tag: entry `i` of row `cell` is the tag, with its area vector (out of the fluid) and area-weighted
/// centroid. Tags rise within a row; without tags, every cell with walls has the one tag 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TagMoments {
    pub tags: Csr<i32>,
    pub area: Vec<[f64; 3]>,
    pub centroid: Vec<[f64; 3]>,
}

/// Area vector (out of the fluid) and centroid per wall.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WallMoments {
    pub area: Vec<[f64; 3]>,
    pub centroid: Vec<[f64; 3]>,
}

#[inline(never)]
fn normals(g: &GridCells) -> Vec<Normal> {
    let mut out = vec![Normal::default(); g.mesh.triangles.len()];
    // Only triangles that carry a wall; walls are sorted by triangle.
    out.par_chunks_mut(ITEMS).enumerate().for_each(|(i, out)| {
        let first = i * ITEMS;
        let start = g.wall_triangle.partition_point(|t| t.at() < first);
        let end = first + out.len();
        let mut last = TriangleId::NONE;
        for &t in g.wall_triangle[start..].iter().take_while(|t| t.at() < end) {
            if t != last {
                out[t.at() - first] = Normal::of(&g.mesh, t);
                last = t;
            }
        }
    });
    out
}

/// Places in output arrays for the cells of a run of boxes.
struct Out<'a> {
    area: &'a mut [[f64; 3]],
    centroid: &'a mut [[f64; 3]],
    flags: &'a mut [u8],
}

/// The walls of all cut cells, on the current rayon pool.
pub fn boundaries(g: &GridCells, of_cells: &GridMoments) -> Boundaries {
    let frames = Frames::new(&g.lattice, g.extent);
    let normals = normals(g);
    let n = g.cell_count();
    let mut out =
        Boundaries { area: vec![[0.0; 3]; n], centroid: vec![[0.0; 3]; n], flags: vec![0; n], exact_cells: 0 };
    let (runs, sizes) = tasks(g);
    out.exact_cells = split(&mut out.area, &sizes)
        .into_par_iter()
        .zip_eq(split(&mut out.centroid, &sizes))
        .zip_eq(split(&mut out.flags, &sizes))
        .zip_eq(runs)
        .map(|(((area, centroid), flags), boxes)| {
            run(g, &frames, &normals, of_cells, boxes, Out { area, centroid, flags })
        })
        .sum();
    out
}

/// Boxes whose walls are gathered together.
const BOXES_AT_ONCE: usize = 24;

dispatched! {
    /// The cells of a run of boxes; returns how many needed rationals.
    fn run(
        g: &GridCells,
        frames: &Frames,
        normals: &[Normal],
        of_cells: &GridMoments,
        boxes: Range<usize>,
        out: Out<'_>,
    ) -> usize = run_as
}

#[inline(always)]
fn run_as<const FUSED: bool>(
    g: &GridCells,
    frames: &Frames,
    normals: &[Normal],
    of_cells: &GridMoments,
    boxes: Range<usize>,
    out: Out<'_>,
) -> usize {
    let (mut gathered, mut directions, mut exact) = (Gathered::default(), Vec::new(), 0);
    let walls = g.wall_count() as u32;
    let first = g.box_cells[boxes.start];
    for start in boxes.clone().step_by(BOXES_AT_ONCE) {
        let boxes = start..(start + BOXES_AT_ONCE).min(boxes.end);
        let cells = |i: usize| (g.box_cells[i]..g.box_cells[i + 1]).map(CellId);
        let walls_of = |c: CellId| g.cell_faces(c).iter().map(|h| h.face()).filter(|f| f.0 < walls);
        gathered.clear();
        boxes.clone().flat_map(cells).flat_map(walls_of).for_each(|f| gathered.push(g, f));
        gathered.corners(g);
        gathered.positions(g);
        normals_of(g, normals, boxes.clone().flat_map(cells).flat_map(walls_of), &mut directions);
        let mut wall = 0;
        for i in boxes {
            let frame = frames.of_box(&g.lattice, g.cut_boxes[i]);
            for c in cells(i) {
                let mine = wall..wall + walls_of(c).count();
                wall = mine.end;
                gathered.place(&frame, mine.end);
                let k = (c.0 - first) as usize;
                if mine.is_empty() {
                    out.centroid[k] = of_cells.cell_centroid[c.at()];
                    continue;
                }
                let values = one_cell::<FUSED>(g, frame, c, &gathered, &directions, mine).unwrap_or_else(|| {
                    let (values, beyond) = exact_walls(g, exact_moments::cell_wall_faces(g, c));
                    exact += 1;
                    out.flags[k] = beyond as u8;
                    values
                });
                out.area[k] = [values[0], values[1], values[2]];
                out.centroid[k] = [values[3], values[4], values[5]];
            }
        }
    }
    exact
}

/// The values of a cell with walls; `None` if something is undecided.
#[inline(always)]
fn one_cell<const FUSED: bool>(
    g: &GridCells,
    frame: [&Interval; 3],
    c: CellId,
    gathered: &Gathered,
    directions: &[Normal],
    mine: Range<usize>,
) -> Option<WallValues> {
    if !frame.iter().all(|x| x.ordinary) {
        return None;
    }
    let mut sums = WallSums::new(frame, &gathered.wall(mine.start)[0]);
    for w in mine {
        sums.wall(gathered.wall(w), directions[w]);
    }
    let first = g.plane_faces[0];
    for h in g.cell_faces(c).iter().filter(|h| h.face().0 >= first) {
        let f = h.face();
        sums.plane(g.face_axis(f), on_high_side(*h), is_square(g, f));
    }
    sums.values::<FUSED>(true)
}

#[cold]
fn exact_walls(g: &GridCells, faces: impl Iterator<Item = FaceId>) -> (WallValues, bool) {
    settle_all(&exact_moments::walls(g, faces))
}

/// The walls of each cell, rising: with `wall_triangle` and the mesh's tags, the input behind each cell. Cost: linear.
pub fn cell_walls(g: &GridCells) -> Csr<FaceId> {
    let pairs = g.wall_cell.iter().enumerate().map(|(f, c)| (c.at(), FaceId::of(f)));
    Csr::from_pairs(g.cell_count(), pairs)
}

/// The moments of some walls of one cell.
fn some_walls(g: &GridCells, frames: &Frames, normals: &[Normal], b: BoxId, faces: &[FaceId]) -> WallValues {
    let frame = frames.of_box(&g.lattice, b);
    let fast = || {
        if !frame.iter().all(|x| x.ordinary) {
            return None;
        }
        let mut gathered = Gathered::default();
        gathered.clear();
        faces.iter().for_each(|&f| gathered.push(g, f));
        gathered.corners(g);
        gathered.positions(g);
        gathered.place(&frame, faces.len());
        let mut sums = WallSums::new(frame, &gathered.wall(0)[0]);
        for (w, f) in faces.iter().enumerate() {
            sums.wall(gathered.wall(w), normals[g.wall_triangle[f.at()].at()]);
        }
        sums.values::<false>(false)
    };
    fast().unwrap_or_else(|| exact_walls(g, faces.iter().copied()).0)
}

/// Wall area vector and centroid per wall. Cost: some 200 ns per wall; memory: 48 bytes per wall.
pub fn wall_moments(g: &GridCells) -> WallMoments {
    let frames = Frames::new(&g.lattice, g.extent);
    let (normals, boxes) = (normals(g), cell_boxes(g));
    let (area, centroid) = (0..g.wall_count())
        .into_par_iter()
        .with_min_len(ITEMS)
        .map(|f| {
            let f = FaceId::of(f);
            let [a, b, c, x, y, z] = some_walls(g, &frames, &normals, boxes[g.wall_cell[f.at()].at()], &[f]);
            ([a, b, c], [x, y, z])
        })
        .unzip();
    WallMoments { area, centroid }
}

/// Wall area vector and centroid per cell and tag. Cost: as for the cells' walls; cells of one tag copy their values.
pub fn tag_moments(g: &GridCells, of_cells: &Boundaries) -> TagMoments {
    let frames = Frames::new(&g.lattice, g.extent);
    let (normals, boxes) = (normals(g), cell_boxes(g));
    let mut walls = cell_walls(g);
    let tag = |f: FaceId| g.mesh.tags.get(g.wall_triangle[f.at()].at()).copied().unwrap_or(0);
    let mut out = TagMoments::default();
    // Stable: walls of one tag stay in order.
    for c in 0..g.cell_count() {
        let row = walls.row_mut(c);
        row.sort_by_key(|&f| tag(f));
        for (i, &f) in row.iter().enumerate() {
            if i == 0 || tag(row[i - 1]) != tag(f) {
                out.tags.items.push(tag(f));
            }
        }
        out.tags.end_row();
    }
    let rows = |c: usize| {
        let (row, faces) = (out.tags.row(c), walls.row(c));
        let (g, frames, normals, boxes) = (&g, &frames, &normals, &boxes);
        row.iter().map(move |&t| {
            if row.len() == 1 {
                return (of_cells.area[c], of_cells.centroid[c]);
            }
            let from = faces.partition_point(|&f| tag(f) < t);
            let to = faces.partition_point(|&f| tag(f) <= t);
            let [a, b, d, x, y, z] = some_walls(g, frames, normals, boxes[c], &faces[from..to]);
            ([a, b, d], [x, y, z])
        })
    };
    let (area, centroid) = (0..g.cell_count()).into_par_iter().with_min_len(BOXES).flat_map_iter(rows).unzip();
    (out.area, out.centroid) = (area, centroid);
    out
}

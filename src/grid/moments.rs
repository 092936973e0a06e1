//! The arrays of embedded-boundary solvers, first part: volumes, volume fractions and centroids of cut cells; areas, area fractions and
//! centroids of faces in grid planes. (The walls are in [`super::boundaries`].)
//!
//! Every double stands for its exact value as [`super::settle`] says: within 0.5003 ulp, and a function of the exact value
//! alone, so nothing depends on threads, order or block layout. Fixed-point sums ([`super::cell_sums`], [`super::face_sums`]) with certified
//! bounds decide nearly always; rationals ([`super::exact_moments`]) do the rest: boxes out of
//! range (beyond 2^±240), cells far smaller than their box.
//!
//! Cost: about 1 µs per cut cell with its faces, on one thread; memory: the outputs, and 24 bytes per face.

use super::cell_sums::{BodyValues, CellSums, on_high_side};
use super::data::GridCells;
use super::exact_moments;
use super::face_sums::{PlaneArea, plane_face, whole_square};
use super::fixed_point::{Frames, Interval, power};
use super::gathered::{Gathered, GatheredFaces, prefetch_position};
use super::refined;
use super::settle::{settle, settle_rational};
use crate::base::processor::dispatched;
use crate::base::{BoxId, CellId, FaceId};
use crate::complex::HalfFace;
use rayon::prelude::*;
use rug::Rational;
use std::ops::Range;

/// See [`moments`]. Arrays of faces start at the first face in a grid plane. A flag of 1: a value of that cell or face is
/// beyond the range of doubles; it is infinite, or zero although the exact value is not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GridMoments {
    pub cell_volume: Vec<f64>,
    /// Volume over the box's volume, in (0, 1].
    pub cell_fraction: Vec<f64>,
    pub cell_centroid: Vec<[f64; 3]>,
    pub face_area: Vec<f64>,
    /// Area over the square's area, in (0, 1].
    pub face_fraction: Vec<f64>,
    pub face_centroid: Vec<[f64; 3]>,
    pub cell_flags: Vec<u8>,
    pub face_flags: Vec<u8>,
    /// How many cells and faces needed rationals.
    pub exact_cells: usize,
    pub exact_faces: usize,
}

/// Boxes per task.
pub(super) const BOXES: usize = 512;
/// Faces or triangles per task.
pub(super) const ITEMS: usize = 4096;

/// Rounds rationals, and flags what is out of range.
pub(super) fn settle_all<const N: usize>(values: &[Rational; N]) -> ([f64; N], bool) {
    let mut out = [0.0; N];
    let mut beyond = false;
    for (out, x) in out.iter_mut().zip(values) {
        *out = settle_rational(x);
        beyond |= out.is_infinite() || *out == 0.0 && !x.is_zero();
    }
    (out, beyond)
}

/// Places in output arrays for a run of faces.
struct FaceOut<'a> {
    areas: &'a mut [PlaneArea],
    area: &'a mut [f64],
    fraction: &'a mut [f64],
    centroid: &'a mut [[f64; 3]],
    flags: &'a mut [u8],
}

/// All moments of cut cells and of faces in grid planes, on the current rayon pool.
pub fn moments(g: &GridCells) -> GridMoments {
    let frames = Frames::new(&g.lattice, g.extent);
    let faces = g.square_node.len();
    let mut areas = vec![PlaneArea::default(); faces];
    let mut out = GridMoments {
        face_area: vec![0.0; faces],
        face_fraction: vec![0.0; faces],
        face_centroid: vec![[0.0; 3]; faces],
        face_flags: vec![0; faces],
        ..Default::default()
    };
    out.exact_faces = areas
        .par_chunks_mut(ITEMS)
        .zip_eq(out.face_area.par_chunks_mut(ITEMS))
        .zip_eq(out.face_fraction.par_chunks_mut(ITEMS))
        .zip_eq(out.face_centroid.par_chunks_mut(ITEMS))
        .zip_eq(out.face_flags.par_chunks_mut(ITEMS))
        .enumerate()
        .map(|(i, ((((areas, area), fraction), centroid), flags))| {
            face_run(g, &frames, i * ITEMS, FaceOut { areas, area, fraction, centroid, flags })
        })
        .sum();
    cells(g, &frames, &areas, &mut out);
    out
}

/// Faces whose corners are gathered together.
const FACES_AT_ONCE: usize = 64;

dispatched! {
    /// Faces from `first` on; returns how many needed rationals.
    fn face_run(g: &GridCells, frames: &Frames, first: usize, out: FaceOut<'_>) -> usize = face_run_as
}

#[inline(always)]
fn face_run_as<const FUSED: bool>(g: &GridCells, frames: &Frames, first: usize, mut out: FaceOut<'_>) -> usize {
    let mut exact = 0;
    let mut gathered = GatheredFaces::default();
    // Which are not whole squares: their numbers of corners; 0 for those that are.
    let mut counts = Vec::with_capacity(FACES_AT_ONCE);
    let (count, planes) = (out.area.len(), g.plane_faces[0] as usize);
    let mut start = 0;
    while start < count {
        let axis = g.face_axis(FaceId::of(planes + first + start));
        // Faces of one axis.
        let last = g.plane_faces[axis + 1] as usize - planes - first;
        let end = (start + FACES_AT_ONCE).min(count).min(last);
        gathered.clear();
        counts.clear();
        for k in start..end {
            let f = FaceId::of(planes + first + k);
            let whole = is_square(g, f);
            if !whole {
                gathered.push(g, f);
            }
            counts.push(if whole { 0 } else { g.face_corners(f).len() });
        }
        gathered.positions(g, others(axis));
        for k in start..end {
            let ahead = planes + first + k + FACES_AT_ONCE;
            if ahead < g.face_count() {
                g.face_corners(FaceId::of(ahead)).iter().for_each(|&v| prefetch_position(g, v));
            }
            exact += one_face::<FUSED>(g, frames, first, k, axis, counts[k - start], &mut gathered, &mut out) as usize;
        }
        start = end;
    }
    exact
}

/// The axes that follow one.
#[inline(always)]
pub(super) fn others(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

/// Face `k` of a run, with so many corners (0: the whole square); true if it needed rationals.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn one_face<const FUSED: bool>(
    g: &GridCells,
    frames: &Frames,
    first: usize,
    k: usize,
    axis: usize,
    corners: usize,
    gathered: &mut GatheredFaces,
    out: &mut FaceOut,
) -> bool {
    let at = g.lattice.node_at(g.square_node[first + k]);
    let [b, c] = others(axis);
    let (fb, fc) = (&frames.axes[b][at[b]], &frames.axes[c][at[c]]);
    out.centroid[k][axis] = g.lattice.nodes[axis][at[axis]];
    let f = FaceId::of(g.plane_faces[0] as usize + first + k);
    let spots = gathered.place([fb, fc], corners);
    let values = if !(fb.ordinary && fc.ordinary) {
        None
    } else if corners == 0 {
        let whole = fb.size.times_as::<FUSED>(fc.size);
        let scale = power(fb.exponent + fc.exponent);
        // Two lengths of at most 55 bits: the product of pairs is off by less than 2⁻¹⁰⁰.
        let area = settle(whole.scaled(scale), whole.hi * scale * power(-96));
        out.areas[k] = whole_square(fb, fc);
        area.map(|area| [area, 1.0, fb.middle, fc.middle])
    } else {
        let loops = &g.loop_offsets[g.face_loops[f.at()] as usize..=g.face_loops[f.at() + 1] as usize];
        let (area, values) = plane_face::<FUSED>(spots, loops, [fb, fc]);
        out.areas[k] = area;
        values
    };
    let decided = values.is_some();
    let values = values.unwrap_or_else(|| {
        let (values, beyond) = settle_all(&exact_face(g, at, f, axis));
        out.flags[k] = beyond as u8;
        values
    });
    [out.area[k], out.fraction[k], out.centroid[k][b], out.centroid[k][c]] = values;
    !decided
}

/// Four corners, all of them nodes off the surface: the whole square. Nodes come last among the vertices.
#[inline(always)]
pub(super) fn is_square(g: &GridCells, f: FaceId) -> bool {
    let corners = g.face_corners(f);
    corners.len() == 4
        && g.face_loops[f.at() + 1] - g.face_loops[f.at()] == 1
        && corners.iter().all(|v| v.0 >= g.constructed.end)
}

/// Area, fraction, and the centroid's two coordinates.
#[cold]
fn exact_face(g: &GridCells, at: [usize; 3], f: FaceId, axis: usize) -> [Rational; 4] {
    let (area, centroid) = exact_moments::face(g, f);
    let of = |x: f64| Rational::from_f64(x).unwrap_or_default();
    let length = |a: usize| of(g.lattice.nodes[a][at[a] + 1]) - of(g.lattice.nodes[a][at[a]]);
    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
    let area = Rational::from(&area[axis] / 2);
    let fraction = &area / (length(b) * length(c));
    [area, fraction, centroid[b].clone(), centroid[c].clone()]
}

/// Places in output arrays for the cells of a run of boxes.
struct CellOut<'a> {
    volume: &'a mut [f64],
    fraction: &'a mut [f64],
    centroid: &'a mut [[f64; 3]],
    flags: &'a mut [u8],
}

/// Splits an array at the first cells of the tasks.
pub(super) fn split<'a, T>(mut all: &'a mut [T], sizes: &[usize]) -> Vec<&'a mut [T]> {
    let mut out = Vec::with_capacity(sizes.len());
    for &n in sizes {
        let (head, tail) = all.split_at_mut(n);
        out.push(head);
        all = tail;
    }
    out
}

/// Runs of boxes, one a task, and the number of cells in each.
pub(super) fn tasks(g: &GridCells) -> (Vec<Range<usize>>, Vec<usize>) {
    let boxes = g.cut_boxes.len();
    let runs: Vec<Range<usize>> = (0..boxes).step_by(BOXES).map(|b| b..(b + BOXES).min(boxes)).collect();
    let sizes = runs.iter().map(|r| (g.box_cells[r.end] - g.box_cells[r.start]) as usize).collect();
    (runs, sizes)
}

fn cells(g: &GridCells, frames: &Frames, areas: &[PlaneArea], out: &mut GridMoments) {
    let n = g.cell_count();
    out.cell_volume = vec![0.0; n];
    out.cell_fraction = vec![0.0; n];
    out.cell_centroid = vec![[0.0; 3]; n];
    out.cell_flags = vec![0; n];
    let (runs, sizes) = tasks(g);
    out.exact_cells = split(&mut out.cell_volume, &sizes)
        .into_par_iter()
        .zip_eq(split(&mut out.cell_fraction, &sizes))
        .zip_eq(split(&mut out.cell_centroid, &sizes))
        .zip_eq(split(&mut out.cell_flags, &sizes))
        .zip_eq(runs)
        .map(|((((volume, fraction), centroid), flags), boxes)| {
            cell_run(g, frames, areas, boxes, CellOut { volume, fraction, centroid, flags })
        })
        .sum();
}

/// Boxes whose walls are gathered together.
const BOXES_AT_ONCE: usize = 24;

dispatched! {
    /// The cells of a run of boxes; returns how many needed rationals.
    fn cell_run(g: &GridCells, frames: &Frames, areas: &[PlaneArea], boxes: Range<usize>, out: CellOut<'_>) -> usize = cell_run_as
}

#[inline(always)]
fn cell_run_as<const FUSED: bool>(
    g: &GridCells,
    frames: &Frames,
    areas: &[PlaneArea],
    boxes: Range<usize>,
    mut out: CellOut<'_>,
) -> usize {
    let mut exact = 0;
    let first = g.box_cells[boxes.start];
    let (mut now, mut next) = (Listed::default(), Listed::default());
    let run = |start: usize| start..(start + BOXES_AT_ONCE).min(boxes.end);
    now.list(g, areas, run(boxes.start));
    while !now.boxes.is_empty() {
        next.list(g, areas, run(now.boxes.end));
        now.gathered.positions(g);
        let mut ahead = next.gathered.vertices().iter();
        let share = ahead.len().div_ceil(now.ends.len());
        let (mut from, mut ends) = ((0, 0), now.ends.iter());
        for i in now.boxes.clone() {
            let b = g.cut_boxes[i];
            let frame = frames.of_box(&g.lattice, b);
            for c in g.box_cells[i]..g.box_cells[i + 1] {
                ahead.by_ref().take(share).for_each(|&v| prefetch_position(g, v));
                let Some(&to) = ends.next() else { break };
                now.gathered.place(&frame, to.0);
                let cell = Cell {
                    g,
                    frame,
                    faces: g.cell_faces(CellId(c)),
                    gathered: &now.gathered,
                    walls: from.0..to.0,
                    planes: &now.planes[from.1..to.1],
                };
                from = to;
                let ordinary = frame.iter().all(|x| x.ordinary);
                let values =
                    if ordinary { cell.values::<false, FUSED>().or_else(|| cell.again(CellId(c))) } else { None };
                exact += values.is_none() as usize;
                put_cell(g, b, CellId(c), values, (c - first) as usize, &mut out);
            }
        }
        std::mem::swap(&mut now, &mut next);
    }
    exact
}

/// What the cells of some boxes are made of. While one list is worked on, the memory that the next one needs is on its way.
#[derive(Default)]
struct Listed {
    boxes: Range<usize>,
    gathered: Gathered,
    planes: Vec<PlaneArea>,
    /// The ends of each cell's walls and planes.
    ends: Vec<(usize, usize)>,
}

impl Listed {
    #[inline(always)]
    fn list(&mut self, g: &GridCells, areas: &[PlaneArea], boxes: Range<usize>) {
        let walls = g.wall_count() as u32;
        self.gathered.clear();
        self.planes.clear();
        self.ends.clear();
        for i in boxes.clone() {
            for c in g.box_cells[i]..g.box_cells[i + 1] {
                for h in g.cell_faces(CellId(c)) {
                    let f = h.face();
                    match f.0.checked_sub(walls) {
                        None => self.gathered.push(g, f),
                        Some(k) => self.planes.push(areas[k as usize]),
                    }
                }
                self.ends.push((self.gathered.len(), self.planes.len()));
            }
        }
        self.gathered.corners(g);
        self.boxes = boxes;
    }
}

/// A cell, its gathered walls, and the areas of its other faces.
struct Cell<'a> {
    g: &'a GridCells,
    frame: [&'a Interval; 3],
    faces: &'a [HalfFace],
    gathered: &'a Gathered,
    walls: Range<usize>,
    planes: &'a [PlaneArea],
}

impl Cell<'_> {
    /// Volume, fraction and centroid, if they are decided.
    #[inline(always)]
    fn values<const FULL: bool, const FUSED: bool>(&self) -> Option<BodyValues> {
        let origin = if self.walls.is_empty() { [0; 4] } else { self.gathered.wall(self.walls.start)[0].h };
        let mut sums = CellSums::new(self.frame, origin);
        for w in self.walls.clone() {
            sums.wall::<FULL>(self.gathered.wall(w));
        }
        let first = self.g.plane_faces[0];
        for (h, area) in self.faces.iter().filter(|h| h.face().0 >= first).zip(self.planes) {
            sums.plane::<FULL>(area, self.g.face_axis(h.face()), on_high_side(*h));
        }
        sums.values::<FULL, FUSED>()
    }

    /// With rests, which few cells need, then with better coordinates.
    #[cold]
    #[inline(never)]
    fn again(&self, c: CellId) -> Option<BodyValues> {
        self.values::<true, false>().or_else(|| refined::body(self.g, self.frame, c))
    }
}

/// Writes a cell's values, from rationals if they are not there yet.
#[inline(always)]
fn put_cell(g: &GridCells, b: BoxId, c: CellId, values: Option<BodyValues>, k: usize, out: &mut CellOut) {
    let values = values.unwrap_or_else(|| {
        let (values, beyond) = settle_all(&exact_moments::body(g, b, c));
        out.flags[k] = beyond as u8;
        values
    });
    [out.volume[k], out.fraction[k]] = [values[0], values[1]];
    out.centroid[k] = [values[2], values[3], values[4]];
}

/// The box of each cell. Cost: linear.
pub fn cell_boxes(g: &GridCells) -> Vec<BoxId> {
    let mut out = Vec::with_capacity(g.cell_count());
    for (b, cells) in g.cut_boxes.iter().zip(g.box_cells.windows(2)) {
        out.resize(out.len() + (cells[1] - cells[0]) as usize, *b);
    }
    out
}

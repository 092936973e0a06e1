//! The arrays of embedded-boundary solvers: volumes, volume fractions and centroids of cut cells; areas, area fractions and
//! centroids of faces in grid planes; area vectors and centroids of walls, per cell, per cell and tag, and per wall.
//!
//! Every double stands for its exact value as [`super::settle`] says: within 0.5003 ulp, and a function of the exact value
//! alone, so nothing depends on threads, order or block layout. Fixed-point sums ([`super::cell_sums`]) with certified
//! bounds decide nearly always; rationals ([`super::exact_moments`]) do the rest: exact zeros of sums that are not zero term by term, boxes out of
//! range (beyond 2^±240), cells far smaller than their box.
//!
//! Closure: a cell's wall area vector and the areas of its faces in grid planes sum to zero within half an ulp per term.
//! Cost: about 1 µs per cut cell with its faces, on one thread; memory: the outputs, and 24 bytes per face, 16 per triangle.

use super::cell_sums::{
    BodyValues, CellSums, Gathered, Normal, PlaneArea, WallValues, on_high_side, plane_face, position,
};
use super::data::GridCells;
use super::exact_moments;
use super::fixed_point::{Frames, Interval, Place, power};
use super::settle::{settle, settle_rational};
use crate::base::{BoxId, CellId, Csr, FaceId, TriangleId};
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
    /// The walls' area vector: points out of the fluid.
    pub boundary_area: Vec<[f64; 3]>,
    /// ∫ x |dA| / ∫ |dA| over the cell's walls; the cell's centroid if it has none.
    pub boundary_centroid: Vec<[f64; 3]>,
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

/// Boxes per task.
const BOXES: usize = 512;
/// Faces or triangles per task.
const ITEMS: usize = 4096;

/// Rounds rationals, and flags what is out of range.
fn settle_all<const N: usize>(values: &[Rational; N]) -> ([f64; N], bool) {
    let mut out = [0.0; N];
    let mut beyond = false;
    for (out, x) in out.iter_mut().zip(values) {
        *out = settle_rational(x);
        beyond |= out.is_infinite() || *out == 0.0 && !x.is_zero();
    }
    (out, beyond)
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

/// The intervals of a plane face's square along the two axes that follow its own.
fn square_frames<'a>(g: &GridCells, frames: &'a Frames, face: usize, axis: usize) -> ([&'a Interval; 2], [usize; 2]) {
    let at = g.lattice.node_at(g.square_node[face]);
    let axes = [(axis + 1) % 3, (axis + 2) % 3];
    (axes.map(|a| &frames.axes[a][at[a]]), axes)
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
    let normals = normals(g);
    cells(g, &frames, &normals, &areas, &mut out);
    out
}

/// Faces whose corners are gathered together.
const FACES_AT_ONCE: usize = 64;

/// Faces from `first` on; returns how many needed rationals. Corners are gathered in a loop of their own, see [`Gathered`].
#[inline(never)]
fn face_run(g: &GridCells, frames: &Frames, first: usize, mut out: FaceOut) -> usize {
    let mut exact = 0;
    let mut places: Vec<[Place; 2]> = Vec::new();
    let count = out.area.len();
    for start in (0..count).step_by(FACES_AT_ONCE) {
        let run = start..(start + FACES_AT_ONCE).min(count);
        places.clear();
        for k in run.clone() {
            let f = FaceId(g.plane_faces[0] + (first + k) as u32);
            if is_square(g, f) {
                continue;
            }
            let ([fb, fc], [b, c]) = square_frames(g, frames, first + k, g.face_axis(f));
            places.extend(g.face_corners(f).iter().map(|&v| {
                let (x, r) = position(g, v);
                [fb.place(x[b], r[b]), fc.place(x[c], r[c])]
            }));
        }
        let mut rest = &places[..];
        for k in run {
            let f = FaceId(g.plane_faces[0] + (first + k) as u32);
            let (mine, others) = rest.split_at(if is_square(g, f) { 0 } else { g.face_corners(f).len() });
            rest = others;
            exact += one_face(g, frames, first, k, mine, &mut out) as usize;
        }
    }
    exact
}

/// Face `k` of a run; true if it needed rationals.
#[inline(always)]
fn one_face(g: &GridCells, frames: &Frames, first: usize, k: usize, places: &[[Place; 2]], out: &mut FaceOut) -> bool {
    let f = FaceId(g.plane_faces[0] + (first + k) as u32);
    let axis = g.face_axis(f);
    let ([fb, fc], [b, c]) = square_frames(g, frames, first + k, axis);
    let level = g.lattice.nodes[axis][g.lattice.node_at(g.square_node[first + k])[axis]];
    out.centroid[k][axis] = level;
    let values = if !(fb.ordinary && fc.ordinary) {
        None
    } else if is_square(g, f) {
        let whole = fb.size.times(fc.size);
        let scale = power(fb.exponent + fc.exponent);
        // Two lengths of at most 55 bits: the product of pairs is off by less than 2⁻¹⁰⁰.
        let area = settle(whole.scaled(scale), whole.hi * scale * power(-96));
        out.areas[k] = whole_square(fb, fc);
        area.map(|area| [area, 1.0, fb.middle, fc.middle])
    } else {
        let loops = &g.loop_offsets[g.face_loops[f.at()] as usize..=g.face_loops[f.at() + 1] as usize];
        let (area, values) = plane_face(places, loops, [fb, fc]);
        out.areas[k] = area;
        values
    };
    let decided = values.is_some();
    let values = values.unwrap_or_else(|| {
        let (values, beyond) = settle_all(&exact_face(g, first + k, f, axis));
        out.flags[k] = beyond as u8;
        values
    });
    [out.area[k], out.fraction[k], out.centroid[k][b], out.centroid[k][c]] = values;
    !decided
}

/// Four corners, all of them nodes off the surface: the whole square. Nodes come last among the vertices.
#[inline(always)]
fn is_square(g: &GridCells, f: FaceId) -> bool {
    let corners = g.face_corners(f);
    corners.len() == 4
        && g.face_loops[f.at() + 1] - g.face_loops[f.at()] == 1
        && corners.iter().all(|v| v.0 >= g.constructed.end)
}

fn whole_square(b: &Interval, c: &Interval) -> PlaneArea {
    let (x, y) = (b.length, c.length);
    let rest = x.h as f64 * y.l + x.l * y.h as f64;
    PlaneArea::new(2 * (x.h as i128 * y.h as i128 + rest.round_ties_even() as i128), 4096.0, true)
}

/// Area, fraction, and the centroid's two coordinates.
fn exact_face(g: &GridCells, face: usize, f: FaceId, axis: usize) -> [Rational; 4] {
    let (area, centroid) = exact_moments::face(g, f);
    let at = g.lattice.node_at(g.square_node[face]);
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
    boundary_area: &'a mut [[f64; 3]],
    boundary_centroid: &'a mut [[f64; 3]],
    flags: &'a mut [u8],
}

/// Splits an array at the first cells of the tasks.
fn split<'a, T>(mut all: &'a mut [T], sizes: &[usize]) -> Vec<&'a mut [T]> {
    let mut out = Vec::with_capacity(sizes.len());
    for &n in sizes {
        let (head, tail) = all.split_at_mut(n);
        out.push(head);
        all = tail;
    }
    out
}

/// Runs of boxes, one a task, and the number of cells in each.
fn tasks(g: &GridCells) -> (Vec<Range<usize>>, Vec<usize>) {
    let boxes = g.cut_boxes.len();
    let runs: Vec<Range<usize>> = (0..boxes).step_by(BOXES).map(|b| b..(b + BOXES).min(boxes)).collect();
    let sizes = runs.iter().map(|r| (g.box_cells[r.end] - g.box_cells[r.start]) as usize).collect();
    (runs, sizes)
}

fn cells(g: &GridCells, frames: &Frames, normals: &[Normal], areas: &[PlaneArea], out: &mut GridMoments) {
    let n = g.cell_count();
    out.cell_volume = vec![0.0; n];
    out.cell_fraction = vec![0.0; n];
    out.cell_centroid = vec![[0.0; 3]; n];
    out.boundary_area = vec![[0.0; 3]; n];
    out.boundary_centroid = vec![[0.0; 3]; n];
    out.cell_flags = vec![0; n];
    let (runs, sizes) = tasks(g);
    let columns = split(&mut out.cell_volume, &sizes)
        .into_par_iter()
        .zip_eq(split(&mut out.cell_fraction, &sizes))
        .zip_eq(split(&mut out.cell_centroid, &sizes))
        .zip_eq(split(&mut out.boundary_area, &sizes))
        .zip_eq(split(&mut out.boundary_centroid, &sizes))
        .zip_eq(split(&mut out.cell_flags, &sizes));
    out.exact_cells = columns
        .zip_eq(runs)
        .map(|((((((volume, fraction), centroid), boundary_area), boundary_centroid), flags), boxes)| {
            let out = CellOut { volume, fraction, centroid, boundary_area, boundary_centroid, flags };
            cell_run(g, frames, normals, areas, boxes, out)
        })
        .sum();
}

/// Boxes whose walls are gathered together.
const BOXES_AT_ONCE: usize = 24;

/// The cells of a run of boxes; returns how many needed rationals.
#[inline(never)]
fn cell_run(
    g: &GridCells,
    frames: &Frames,
    normals: &[Normal],
    areas: &[PlaneArea],
    boxes: Range<usize>,
    mut out: CellOut,
) -> usize {
    let (mut gathered, mut planes, mut exact) = (Gathered::default(), Vec::new(), 0);
    let walls = g.wall_count() as u32;
    let first = g.box_cells[boxes.start];
    let mut ends = Vec::new();
    for start in boxes.clone().step_by(BOXES_AT_ONCE) {
        let run = start..(start + BOXES_AT_ONCE).min(boxes.end);
        gathered.clear();
        planes.clear();
        ends.clear();
        for i in run.clone() {
            for c in g.box_cells[i]..g.box_cells[i + 1] {
                for h in g.cell_faces(CellId(c)) {
                    let f = h.face();
                    match f.0.checked_sub(walls) {
                        None => gathered.push(g, f),
                        Some(k) => planes.push(areas[k as usize]),
                    }
                }
            }
            ends.push(gathered.len());
        }
        gathered.corners(g, normals);
        for (i, &end) in run.clone().zip(&ends) {
            gathered.place(g, &frames.of_box(&g.lattice, g.cut_boxes[i]), end);
        }
        let (mut wall, mut plane) = (0, 0);
        for i in run {
            let b = g.cut_boxes[i];
            let frame = frames.of_box(&g.lattice, b);
            for c in g.box_cells[i]..g.box_cells[i + 1] {
                let faces = g.cell_faces(CellId(c));
                let count = faces.iter().filter(|h| h.face().0 < walls).count();
                let (from, to) = (wall, wall + count);
                let mine = &planes[plane..plane + faces.len() - count];
                (wall, plane) = (to, plane + mine.len());
                let values = if frame.iter().all(|x| x.ordinary) {
                    one_cell(g, frame, faces, walls, &gathered, from..to, mine)
                } else {
                    (None, None)
                };
                exact += put_cell(g, b, CellId(c), count > 0, values, (c - first) as usize, &mut out) as usize;
            }
        }
    }
    exact
}

/// Volume, fraction and centroid; and the walls' values, if there are walls; what is decided of them.
#[inline(always)]
fn one_cell(
    g: &GridCells,
    frame: [&Interval; 3],
    faces: &[HalfFace],
    walls: u32,
    gathered: &Gathered,
    mine: Range<usize>,
    planes: &[PlaneArea],
) -> (Option<BodyValues>, Option<WallValues>) {
    let has_walls = !mine.is_empty();
    let origin = if has_walls { gathered.wall(mine.start).0[0] } else { Default::default() };
    let mut sums = CellSums::new(frame, origin);
    for w in mine {
        sums.wall::<true>(gathered.wall(w));
    }
    let mut next = planes.iter();
    for h in faces.iter().filter(|h| h.face().0 >= walls) {
        let Some(area) = next.next() else { break };
        sums.plane(area, g.face_axis(h.face()), on_high_side(*h));
    }
    (sums.body(), if has_walls { sums.walls(true) } else { None })
}

/// Writes a cell's values, from rationals where they are not there yet; true if that was so.
#[inline(always)]
fn put_cell(
    g: &GridCells,
    b: BoxId,
    c: CellId,
    has_walls: bool,
    (body, boundary): (Option<BodyValues>, Option<WallValues>),
    k: usize,
    out: &mut CellOut,
) -> bool {
    let exact = body.is_none() || boundary.is_none() && has_walls;
    let body = body.unwrap_or_else(|| {
        let (values, beyond) = settle_all(&exact_moments::body(g, b, c));
        out.flags[k] |= beyond as u8;
        values
    });
    [out.volume[k], out.fraction[k]] = [body[0], body[1]];
    out.centroid[k] = [body[2], body[3], body[4]];
    if has_walls {
        let boundary = boundary.unwrap_or_else(|| {
            let (values, beyond) = exact_walls(g, exact_moments::cell_wall_faces(g, c));
            out.flags[k] |= beyond as u8;
            values
        });
        out.boundary_area[k] = [boundary[0], boundary[1], boundary[2]];
        out.boundary_centroid[k] = [boundary[3], boundary[4], boundary[5]];
    } else {
        out.boundary_centroid[k] = out.centroid[k];
    }
    exact
}

#[cold]
fn exact_walls(g: &GridCells, faces: impl Iterator<Item = FaceId>) -> (WallValues, bool) {
    settle_all(&exact_moments::walls(g, faces))
}

/// The walls of each cell, rising: with `wall_triangle` and the mesh's tags, the input behind each cell. Cost: linear.
pub fn cell_walls(g: &GridCells) -> Csr<FaceId> {
    Csr::from_positions(g.cell_count(), g.wall_cell.len(), |range| range.map(|f| (g.wall_cell[f].at(), FaceId::of(f))))
}

/// The box of each cell. Cost: linear.
pub fn cell_boxes(g: &GridCells) -> Vec<BoxId> {
    let mut out = Vec::with_capacity(g.cell_count());
    for (b, cells) in g.cut_boxes.iter().zip(g.box_cells.windows(2)) {
        out.resize(out.len() + (cells[1] - cells[0]) as usize, *b);
    }
    out
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
        gathered.corners(g, normals);
        gathered.place(g, &frame, faces.len());
        let mut sums = CellSums::new(frame, gathered.wall(0).0[0]);
        (0..faces.len()).for_each(|w| sums.wall::<false>(gathered.wall(w)));
        sums.walls(false)
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
pub fn tag_moments(g: &GridCells, of_cells: &GridMoments) -> TagMoments {
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
                return (of_cells.boundary_area[c], of_cells.boundary_centroid[c]);
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

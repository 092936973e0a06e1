//! The polygons in the cubes of a box. Words of 64 cubes are skipped where nothing happens; a cube with one function (two materials) and no zero at a
//! corner is one look into the table of cubes; in others each of the five tetrahedra is looked at by itself.
//!
//! Order: cubes by row and place, tetrahedra within the cube: by id. Cost: a few operations on words per function and 64 cubes, and the output.

use super::box_edges::BoxEdges;
use super::domain::{BoxGrid, CUBE_TETS, PER_CUBE};
use super::polygons::{Active, Context, Pieces, Simplex, arrangement_polygons, interface_polygons};
use super::signs::{Label, SignRows, Signs};
use super::table::{CUBES, TET_EDGES};
use crate::base::parallel::map_ranges;
use crate::base::{FunctionId, NodeId, TetId};

/// Rows of cubes in one task at least.
const LEAST: usize = 64;

/// A cube at its place: row of its lowest node and of its three neighbours in y and z, and numbers.
struct Cube {
    rows: [usize; 4],
    i: usize,
    number: usize,
    parity: usize,
    first: NodeId,
}

impl Cube {
    #[inline(always)]
    fn simplex(&self, grid: &BoxGrid, t: usize) -> Simplex {
        let [_, sy, sz] = grid.strides();
        let node = |c: usize| NodeId::of(self.first.at() + (c & 1) + (c >> 1 & 1) * sy + (c >> 2) * sz);
        let tet = TetId::of(self.number * PER_CUBE + t);
        Simplex { dim: 3, tet, nodes: CUBE_TETS[self.parity][t].map(node), positive: true }
    }
}

/// Calls `visit` for ranges of rows of cubes at once, and `row` for each row in them.
fn each_row(grid: &BoxGrid, row: impl Fn(usize, usize, &mut Pieces, &mut Work) + Sync) -> Vec<Pieces> {
    let [_, ny, nz] = grid.cells();
    map_ranges(ny * nz, LEAST, |range| {
        let (mut out, mut work) = (Pieces::default(), Work::default());
        for r in range {
            row(r % ny, r / ny, &mut out, &mut work);
        }
        out
    })
}

#[derive(Default)]
struct Work {
    /// Active functions of a word: cubes, and signs at the eight corners of each.
    entries: Vec<(FunctionId, u64, [Signs; 8])>,
    /// Those of a cube: function, positive and negative corners.
    cube: Vec<(FunctionId, u8, u8)>,
    tet: Vec<Active>,
    materials: Vec<(FunctionId, [f64; 8])>,
    left: Vec<FunctionId>,
    mixed: Vec<u32>,
}

/// Bits of a cube's corners for those of a tetrahedron.
#[inline(always)]
fn of_tet(corners: &[usize; 4], cube: u8) -> u8 {
    (cube >> corners[0] & 1)
        | (cube >> corners[1] & 1) << 1
        | (cube >> corners[2] & 1) << 2
        | (cube >> corners[3] & 1) << 3
}

/// All polygons of a cube with one function (two materials) without zeros.
#[inline]
fn table_polygons(cube: &Cube, edges: &BoxEdges, code: u8, set: u32, active: usize, out: &mut Pieces) {
    let entry = &CUBES[cube.parity][code as usize];
    let mut ids = [0u32; 18];
    let mut left = entry.edges;
    while left != 0 {
        let e = left.trailing_zeros() as usize;
        left &= left - 1;
        ids[e] = edges.span(&cube.rows, cube.i, e).first;
    }
    for polygon in &entry.polygons[..entry.len as usize] {
        for &e in &polygon.points[..polygon.len as usize] {
            out.polygons.items.push(ids[e as usize]);
        }
        out.end_polygon(set, [TetId::of(cube.number * PER_CUBE + polygon.tet as usize); 2]);
    }
    out.count_active(active, entry.len as u64);
}

fn cube_at(grid: &BoxGrid, i: usize, j: usize, k: usize) -> Cube {
    let [_, ny, _] = grid.cells();
    let row = j + (ny + 1) * k;
    Cube {
        rows: [row, row + 1, row + ny + 1, row + ny + 2],
        i,
        number: grid.cube_number([i, j, k]),
        parity: (i + j + k) & 1,
        first: grid.node([i, j, k]),
    }
}

/// Those of an arrangement.
pub fn arrangement_cubes(grid: &BoxGrid, context: &Context, signs: &SignRows, edges: &BoxEdges) -> Vec<Pieces> {
    let [nx, ny, _] = grid.cells();
    each_row(grid, |j, k, out, work| {
        let row = j + (ny + 1) * k;
        let rows = [row, row + 1, row + ny + 1, row + ny + 2];
        for word in 0..nx.div_ceil(64) {
            let valid = u64::MAX >> (64 - 64.min(nx - word * 64));
            let union = word_entries(signs, &rows, word, valid, &mut work.entries);
            let mut left = union;
            while left != 0 {
                let bit = left.trailing_zeros() as usize;
                left &= left - 1;
                let cube = cube_at(grid, word * 64 + bit, j, k);
                work.cube.clear();
                for (f, active, corners) in &work.entries {
                    if active >> bit & 1 == 1 {
                        let (mut positive, mut negative) = (0u8, 0u8);
                        for (c, s) in corners.iter().enumerate() {
                            positive |= ((s.positive >> bit & 1) as u8) << c;
                            negative |= ((s.negative >> bit & 1) as u8) << c;
                        }
                        work.cube.push((*f, positive, negative));
                    }
                }
                if let [(f, positive, negative)] = work.cube[..]
                    && positive | negative == u8::MAX
                {
                    let set = out.sets.single(f);
                    table_polygons(&cube, edges, positive, set, 1, out);
                } else {
                    arrangement_cube(grid, context, &cube, edges, work, out);
                }
            }
        }
    })
}

/// The functions that are active in some cube of a word, with those cubes; and all of these cubes.
#[inline]
fn word_entries(
    signs: &SignRows,
    rows: &[usize; 4],
    word: usize,
    valid: u64,
    entries: &mut Vec<(FunctionId, u64, [Signs; 8])>,
) -> u64 {
    entries.clear();
    let here = rows.map(|r| signs.word(r, word));
    let next = rows.map(|r| (word + 1 < signs.row_words).then(|| signs.word(r, word + 1)));
    let mut union = 0;
    for f in 0..signs.functions {
        let (mut positive, mut negative) = (u64::MAX, u64::MAX);
        let corners: [Signs; 8] = std::array::from_fn(|c| {
            let s = here[c >> 1][f];
            if c & 1 == 0 { s } else { s.shifted(next[c >> 1].map_or(Signs::default(), |n| n[f])) }
        });
        for s in &corners {
            positive &= s.positive;
            negative &= s.negative;
        }
        let active = !(positive | negative) & valid;
        if active != 0 {
            union |= active;
            entries.push((FunctionId::of(f), active, corners));
        }
    }
    union
}

/// A cube with several functions or zeros.
fn arrangement_cube(
    grid: &BoxGrid,
    context: &Context,
    cube: &Cube,
    edges: &BoxEdges,
    work: &mut Work,
    out: &mut Pieces,
) {
    for (t, corners) in CUBE_TETS[cube.parity].iter().enumerate() {
        work.tet.clear();
        for &(function, positive, negative) in &work.cube {
            let (positive, negative) = (of_tet(corners, positive), of_tet(corners, negative));
            if positive != 15 && negative != 15 {
                work.tet.push(Active { function, positive, negative });
            }
        }
        if work.tet.is_empty() {
            continue;
        }
        out.count_active(work.tet.len(), 1);
        let s = cube.simplex(grid, t);
        let span = |e: usize| edges.span(&cube.rows, cube.i, TET_EDGES[cube.parity][t][e] as usize);
        arrangement_polygons(context, &s, &work.tet, span, out);
    }
}

/// Those of an interface.
pub fn interface_cubes(grid: &BoxGrid, context: &Context, labels: &[Label], edges: &BoxEdges) -> Vec<Pieces> {
    let [nx, ny, _] = grid.cells();
    each_row(grid, |j, k, out, work| {
        let row = j + (ny + 1) * k;
        let rows = [row, row + 1, row + ny + 1, row + ny + 2].map(|r| &labels[r * (nx + 1)..(r + 1) * (nx + 1)]);
        // Not one and the same material alone at all corners.
        work.mixed.clear();
        work.mixed.extend((0..nx).map(|i| {
            let o = rows[0][i];
            rows.iter().fold(0, |d, r| d | o.difference(r[i]) | o.difference(r[i + 1]))
        }));
        for i in 0..nx {
            if work.mixed[i] != 0 {
                interface_cube(grid, context, &cube_at(grid, i, j, k), labels, edges, work, out);
            }
        }
    })
}

fn interface_cube(
    grid: &BoxGrid,
    context: &Context,
    cube: &Cube,
    labels: &[Label],
    edges: &BoxEdges,
    work: &mut Work,
    out: &mut Pieces,
) {
    let [_, sy, sz] = grid.strides();
    let nodes: [NodeId; 8] =
        std::array::from_fn(|c| NodeId::of(cube.first.at() + (c & 1) + (c >> 1 & 1) * sy + (c >> 2) * sz));
    let values = |f: FunctionId| nodes.map(|n| context.values.at(f, n));
    // Materials that are the largest at some corner first; then all that none of those exceeds at all corners.
    let mut tops = [(FunctionId::NONE, [0.0; 8]); 8];
    let mut count = 0;
    for n in nodes {
        let f = labels[n.at()].material();
        if !tops[..count].iter().any(|t| t.0 == f) {
            tops[count] = (f, values(f));
            count += 1;
        }
    }
    let below = |x: &[f64; 8], y: &[f64; 8]| x.iter().zip(y).all(|(x, y)| x < y);
    work.materials.clear();
    for f in (0..context.values.len()).map(FunctionId::of) {
        match tops[..count].iter().find(|t| t.0 == f) {
            Some(&top) => work.materials.push(top),
            None => {
                let x = values(f);
                if !tops[..count].iter().any(|t| below(&x, &t.1)) {
                    work.materials.push((f, x));
                }
            }
        }
    }
    if let [(a, x), (b, y)] = work.materials[..] {
        let (mut positive, mut negative) = (0u8, 0u8);
        for c in 0..8 {
            positive |= ((x[c] > y[c]) as u8) << c;
            negative |= ((x[c] < y[c]) as u8) << c;
        }
        if positive | negative == u8::MAX {
            let set = out.sets.pair(a, b);
            table_polygons(cube, edges, positive, set, 2, out);
            return;
        }
    }
    for (t, corners) in CUBE_TETS[cube.parity].iter().enumerate() {
        let below = |x: &[f64; 8], y: &[f64; 8]| corners.iter().all(|&c| x[c] < y[c]);
        work.left.clear();
        for (f, x) in &work.materials {
            if !work.materials.iter().any(|(_, y)| below(x, y)) {
                work.left.push(*f);
            }
        }
        if work.left.len() < 2 {
            continue;
        }
        out.count_active(work.left.len(), 1);
        let s = cube.simplex(grid, t);
        let span = |e: usize| edges.span(&cube.rows, cube.i, TET_EDGES[cube.parity][t][e] as usize);
        interface_polygons(context, &s, &work.left, span, out);
    }
}

//! The cells of a large grid against the general cut, one by one: a sphere of many triangles, cut by a whole fine grid through `lap_grid`, and by
//! the planes of a small block of it with `cut`. In every box of the block: the same cells, with the same faces on the same triangles and
//! planes, the same exact corners, the same exact volumes; and the arrays hold what these volumes round to.
//!
//! By default a coarse sphere on 40³ boxes; with `LAPIDARY_LONG=1` the sphere of 1 310 720 triangles on 512³ boxes (a gigabyte and a half).

mod common;
#[path = "common/grid_reference.rs"]
mod grid_reference;

use common::{Soup, build_soup, cuboid, flipped, merging, together};
use grid_reference::reference;
use lapidary::base::{BoxId, CellId, FaceId};
use lapidary::capi::{context::*, grid::*, grid_moments::*, mesh::*};
use lapidary::complex::exact_values::cell_volume;
use lapidary::grid::settle::settle_rational;
use lapidary::grid::{CUT, EMPTY, FULL, GridCells, Lattice, exact_moments};
use rug::Rational;
use std::collections::HashMap;
use std::ptr::{null, null_mut};
use std::sync::Arc;

/// A corner's exact coordinates.
type Corner = [Rational; 3];

/// What a face lies on, and its loops of exact corners, each from its lowest, the outer loop first.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Face {
    /// The triangle of a wall; or the axis and the coordinate of a grid plane.
    triangle: Option<u32>,
    plane: Option<(usize, u64)>,
    /// Which side of it the cell is on.
    front: bool,
    loops: Vec<Vec<Corner>>,
}

/// What a cell is: its faces as a set, and its exact volume.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Cell {
    volume: Rational,
    faces: Vec<Face>,
}

fn face(g: &GridCells, f: FaceId, front: bool, known: &mut HashMap<u32, Corner>) -> Face {
    let mut loops: Vec<Vec<Corner>> = g
        .loops_of(f)
        .map(|l| {
            let corners = g.corners_of(l).iter();
            let mut points: Vec<Corner> =
                corners.map(|&v| known.entry(v.0).or_insert_with(|| exact_moments::vertex(g, v)).clone()).collect();
            let least = (0..points.len()).min_by(|&i, &j| points[i].cmp(&points[j])).unwrap();
            points.rotate_left(least);
            points
        })
        .collect();
    loops[1..].sort();
    let wall = f.at() < g.wall_count();
    let plane = g.face_plane(f).map(|p| {
        let (axis, node) = g.lattice.plane_at(p);
        (axis, g.lattice.nodes[axis][node].to_bits())
    });
    Face { triangle: wall.then(|| g.wall_triangle[f.at()].0), plane, front, loops }
}

/// The cells of a box as a set, with volumes by cell.
fn cells_of(
    g: &GridCells,
    b: BoxId,
    known: &mut HashMap<u32, Corner>,
    volume: &dyn Fn(CellId) -> Rational,
) -> Vec<Cell> {
    let mut cells: Vec<Cell> = g
        .cells_of(b)
        .map(|c| {
            let faces = g.cell_faces(CellId(c)).iter();
            let mut faces: Vec<Face> = faces.map(|h| face(g, h.face(), h.front(), known)).collect();
            faces.sort();
            Cell { volume: volume(CellId(c)), faces }
        })
        .collect();
    cells.sort();
    cells
}

/// Compares the boxes `low..low + size` of an n³ grid around the sphere.
fn compare(level: usize, n: usize, low: [usize; 3], size: usize, outside: bool) {
    let (vertices, triangles) = common::icosphere::icosphere(level);
    let nodes: Vec<f64> = (0..=n).map(|i| -1.1 + 2.2 * i as f64 / n as f64).collect();
    let count = nodes.len() as i64;
    let high = low.map(|i| (i + size) as i64);
    let block = Lattice::new([&nodes; 3], low.map(|i| i as i64), high).expect("a block");

    // The general cut: for the outside, of a cuboid around the grid with the sphere as a void.
    let soup = Soup { vertices: vertices.clone(), triangles: triangles.clone() };
    let soup = if outside { together(&[flipped(soup), cuboid([-2.0; 3], [2.0; 3])]) } else { soup };
    let general = reference(Arc::new(build_soup(&soup, merging()).expect("a valid mesh")), block.clone());
    let mut known = HashMap::new();
    let boxes: Vec<BoxId> = (0..block.box_count()).map(BoxId::of).collect();
    let volume = |c: CellId| cell_volume(&general.complex, general.cells[c.at()]);
    let expected: Vec<Vec<Cell>> = boxes.iter().map(|&b| cells_of(&general.grid, b, &mut known, &volume)).collect();
    let flags = general.grid.flags.clone();
    drop(general);

    let (mut context, mut mesh, mut grid) = (null_mut(), null_mut(), null_mut());
    // SAFETY: pointers are valid for the calls, or NULL where the header allows it; handles are freed once, last.
    unsafe {
        assert_eq!(lap_context_new(&mut context), 0);
        let (xyz, indices) = (vertices.as_ptr().cast(), triangles.as_ptr().cast());
        let (n_vertices, n_triangles) = (vertices.len() as i64, triangles.len() as i64);
        assert_eq!(lap_mesh_new(context, n_vertices, xyz, n_triangles, indices, null(), null(), &mut mesh), 0);
        let mut options = std::mem::zeroed();
        assert_eq!(lap_grid_options_init(&mut options, size_of::<lap_grid_options>() as i32), 0);
        options.outside = outside as i32;
        let [x, y, z] = [nodes.as_ptr(); 3];
        assert_eq!(lap_grid_new(context, mesh, count, x, count, y, count, z, &options, &mut grid), 0);
        let (mut n_cells, mut volumes, mut fractions) = (0, null(), null());
        assert_eq!(lap_grid_cell_moments(grid, &mut n_cells, &mut volumes, &mut fractions, null_mut(), null_mut()), 0);
        let [volumes, fractions] =
            [volumes, fractions].map(|x: *const f64| std::slice::from_raw_parts(x, n_cells as usize));
        let g: &GridCells = &(*grid).data;
        check(g, &block, low, &boxes, &flags, &expected, volumes, fractions);
        println!("    of a grid of {n}³ boxes with {n_cells} cells, {n_triangles} triangles, outside: {outside}");
        assert_eq!(lap_grid_free(grid), 0);
        assert_eq!(lap_mesh_free(mesh), 0);
        assert_eq!(lap_context_free(context), 0);
    }
}

#[allow(clippy::too_many_arguments)]
fn check(
    g: &GridCells,
    block: &Lattice,
    low: [usize; 3],
    boxes: &[BoxId],
    flags: &[u8],
    expected: &[Vec<Cell>],
    volumes: &[f64],
    fractions: &[f64],
) {
    let mut known = HashMap::new();
    let (mut kinds, mut cells, mut faces, mut walls) = ([0; 3], 0, 0, 0);
    for &b in boxes {
        let at = block.box_at(b);
        let whole = g.lattice.box_id([0, 1, 2].map(|a| at[a] + low[a]));
        let flag = g.flags[whole.at()];
        assert_eq!(flag, flags[b.at()], "box {at:?}");
        kinds[flag as usize] += 1;
        let (about, _, size) = exact_moments::box_values(g, whole);
        let volume = |c: CellId| {
            let volume = exact_moments::cell(g, c, &about, false).volume;
            assert_eq!(volumes[c.at()].to_bits(), settle_rational(&volume).to_bits());
            assert_eq!(fractions[c.at()].to_bits(), settle_rational(&(&volume / size.clone())).to_bits());
            volume
        };
        let found = cells_of(g, whole, &mut known, &volume);
        assert_eq!(found, expected[b.at()], "box {at:?}");
        cells += found.len();
        faces += found.iter().map(|c| c.faces.len()).sum::<usize>();
        walls += found.iter().flat_map(|c| &c.faces).filter(|f| f.triangle.is_some()).count();
    }
    let [empty, full, cut] = [EMPTY, FULL, CUT].map(|k| kinds[k as usize]);
    println!(
        "{cells} cells with {faces} faces ({walls} walls) and {} corners agree exactly with the general cut",
        known.len()
    );
    println!("    in {} boxes: {empty} empty, {full} full, {cut} cut", boxes.len());
    assert!(empty > 0 && full > 0 && cut > 0 && cells >= cut && walls >= cut);
}

#[test]
fn a_block_of_a_large_grid_agrees_with_the_general_cut() {
    // Boxes around the point of the sphere in direction (1, 1, 1), and around the pole of z.
    let (level, n, size) = if std::env::var_os("LAPIDARY_LONG").is_some() { (8, 512, 32) } else { (5, 40, 8) };
    let at = |x: f64| (((x + 1.1) / 2.2 * n as f64) as usize - size / 2).min(n - size);
    let diagonal = [at((1.0f64 / 3.0).sqrt()); 3];
    let pole = [at(0.0), at(0.0), at(1.0)];
    for outside in [false, true] {
        compare(level, n, diagonal, size, outside);
        compare(level, n, pole, size, outside);
    }
}

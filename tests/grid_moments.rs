//! The arrays of grid cells against rationals from the general cut.

#![allow(clippy::needless_range_loop)]

mod common;
#[path = "common/grid_reference.rs"]
mod grid_reference;
#[path = "common/solids.rs"]
mod solids;

use common::*;
use grid_reference::{Reference, inside, outside};
use lapidary::base::{CellId, FaceId};
use lapidary::complex::exact_values::{cell_values, face_values};
use lapidary::grid::boundaries::boundaries;
use lapidary::grid::exact_moments;
use lapidary::grid::moments::{GridMoments, cell_boxes, moments};
use lapidary::grid::second_moments::second_moments;
use lapidary::grid::settle::settle_rational;
use rug::Rational;
use solids::Random;

fn of(x: f64) -> Rational {
    Rational::from_f64(x).unwrap()
}

fn same(what: &str, x: f64, exact: &Rational) {
    let expected = settle_rational(exact);
    assert_eq!(x.to_bits(), expected.to_bits(), "{what} is {x:e}, not {expected:e}");
}

/// Every value stands for the exact one, which the general complex gives.
fn compare(name: &str, r: &Reference) -> GridMoments {
    let (g, c) = (&r.grid, &r.complex);
    let mut m = moments(g);
    let walls_of = boundaries(g, &m);
    // Cells that need rationals for either.
    m.exact_cells += walls_of.exact_cells;
    let mut k = 0;
    for (b, range) in g.cut_boxes.iter().zip(g.box_cells.windows(2)) {
        let [low, high] = g.lattice.corners(*b);
        let size = (0..3).fold(Rational::from(1), |s, i| s * (of(high[i]) - of(low[i])));
        for cell in range[0]..range[1] {
            let what = |value: &str| format!("{name}: {value} of cell {cell}");
            let (volume, centroid) = cell_values(c, r.cells[k]);
            same(&what("volume"), m.cell_volume[k], &volume);
            same(&what("fraction"), m.cell_fraction[k], &(volume / &size));
            for i in 0..3 {
                same(&what("centroid"), m.cell_centroid[k][i], &centroid[i]);
            }
            let walls: Vec<FaceId> = exact_moments::cell_wall_faces(g, CellId(cell)).collect();
            let mut sum: [Rational; 3] = Default::default();
            for f in &walls {
                let area = face_values(c, r.faces[f.at()]).area;
                area.into_iter().zip(&mut sum).for_each(|(a, s)| *s += a);
            }
            for i in 0..3 {
                same(&what("boundary area"), walls_of.area[k][i], &sum[i]);
            }
            let exact = exact_moments::walls(g, walls.iter().copied());
            for i in 0..3 {
                let x = walls_of.centroid[k][i];
                if walls.is_empty() {
                    assert_eq!(x, m.cell_centroid[k][i]);
                } else {
                    same(&what("boundary centroid"), x, &exact[3 + i]);
                }
            }
            k += 1;
        }
    }
    assert_eq!(k, g.cell_count());
    let first = g.plane_faces[0] as usize;
    for (k, node) in g.square_node.iter().enumerate() {
        let f = FaceId::of(first + k);
        let axis = g.face_axis(f);
        let exact = face_values(c, r.faces[first + k]);
        let what = |value: &str| format!("{name}: {value} of face {}", f.0);
        same(&what("area"), m.face_area[k], &exact.area[axis]);
        let at = g.lattice.node_at(*node);
        let length = |a: usize| of(g.lattice.nodes[a][at[a] + 1]) - of(g.lattice.nodes[a][at[a]]);
        let size = length((axis + 1) % 3) * length((axis + 2) % 3);
        same(&what("fraction"), m.face_fraction[k], &(exact.area[axis].clone() / size));
        for i in 0..3 {
            same(&what("centroid"), m.face_centroid[k][i], &exact.centroid[i]);
        }
    }
    m
}

fn uniform(low: f64, high: f64, boxes: usize) -> Vec<f64> {
    (0..=boxes).map(|i| low + (high - low) * i as f64 / boxes as f64).collect()
}

fn report(name: &str, r: &Reference, m: &GridMoments) {
    println!(
        "{name}: {} cells ({} by rationals), {} faces ({})",
        r.grid.cell_count(),
        m.exact_cells,
        m.face_area.len(),
        m.exact_faces
    );
}

fn run(name: &str, soup: &Soup, nodes: [&[f64]; 3]) -> [(Reference, GridMoments); 2] {
    [("inside", inside(soup, nodes)), ("outside", outside(soup, nodes))].map(|(side, r)| {
        let name = format!("{name}, {side}");
        let m = compare(&name, &r);
        report(&name, &r, &m);
        (r, m)
    })
}

#[test]
fn star_inside_and_outside() {
    let mut random = Random(7);
    let soup = solids::star(2, || 0.5 + 0.4 * random.unit());
    let soup = solids::mapped(soup, [[0.62, 0.04, 0.0], [0.02, 0.58, 0.1], [0.0, 0.06, 0.66]]);
    let nodes = [uniform(-1.3, 1.2, 9), uniform(-1.2, 1.3, 8), uniform(-1.25, 1.25, 7)];
    for (r, m) in run("star", &soup, [&nodes[0], &nodes[1], &nodes[2]]) {
        assert!(r.grid.cell_count() > 100);
        assert!(m.exact_cells * 20 <= r.grid.cell_count() && m.exact_faces * 20 <= m.face_area.len());
    }
}

/// Walls on grid planes, and between them; 53-bit nodes: a third of the centroids are midpoints.
#[test]
fn boxes_need_no_rationals() {
    let nodes = [uniform(-0.7, 1.3, 5), uniform(-0.31, 1.77, 6), uniform(-1.1, 1.3, 7)];
    let slices = [&nodes[0][..], &nodes[1], &nodes[2]];
    let on_planes = cuboid([nodes[0][1], nodes[1][2], nodes[2][1]], [nodes[0][4], nodes[1][5], nodes[2][4]]);
    let between = cuboid([-0.41, 0.1, -0.77], [1.03, 1.4, 0.9]);
    for soup in [on_planes, between] {
        for (_, m) in run("box", &soup, slices) {
            assert_eq!((m.exact_cells, m.exact_faces), (0, 0));
        }
    }
}

/// Prisms along z: normals without that component, centroids in the middle.
#[test]
fn prisms() {
    let nodes = [uniform(-1.1, 1.3, 6), uniform(-1.21, 1.3, 7), uniform(-1.0, 1.3, 3)];
    let slices = [&nodes[0][..], &nodes[1], &nodes[2]];
    let mut soup = Soup::default();
    let n = 9;
    for z in [-0.83, 1.07] {
        soup.vertices.extend((0..n).map(|k| {
            let angle = k as f64 * std::f64::consts::TAU / n as f64 + 0.1;
            [angle.cos(), angle.sin(), z]
        }));
    }
    for k in 0..n {
        let (a, b) = (k, (k + 1) % n);
        soup.triangles.extend([[a, b, b + n], [a, b + n, a + n]]);
        if k >= 2 {
            soup.triangles.extend([[0, k, k - 1], [n, n + k - 1, n + k]]);
        }
    }
    for (r, m) in run("prism", &soup, slices) {
        assert!(m.exact_cells * 10 <= r.grid.cell_count() && m.exact_faces * 10 <= m.face_area.len());
    }
}

/// A thin plate through boxes, bodies within one box, several parts in a box, voids.
#[test]
fn plates_and_bodies() {
    let nodes = uniform(-1.0, 1.0, 4);
    let slices = [&nodes[..]; 3];
    let plate = solids::mapped(
        cuboid([-0.9, -0.83, -0.001], [0.93, 0.87, 0.001]),
        [[0.9, 0.1, 0.3], [-0.1, 0.95, 0.2], [-0.3, -0.1, 0.9]],
    );
    run("plate", &plate, slices);
    let bodies = together(&[
        cuboid([0.1, 0.1, 0.1], [0.2, 0.3, 0.4]),
        tetrahedron([[0.25, 0.25, 0.1], [0.4, 0.3, 0.1], [0.3, 0.45, 0.1], [0.3, 0.3, 0.4]]),
        flipped(cuboid([0.12, 0.12, 0.15], [0.18, 0.2, 0.3])),
        cuboid([-0.75, -0.9, -0.75], [-0.25, 0.9, -0.7]),
    ]);
    run("bodies", &bodies, slices);
    let mut random = Random(11);
    for _ in 0..3 {
        let voxels =
            solids::mapped(solids::voxels(&mut random, 4, 40), [[0.3, 0.05, 0.0], [0.0, 0.3, 0.07], [0.04, 0.0, 0.3]]);
        let nodes = uniform(-0.2, 1.7, 3);
        run("voxels", &voxels, [&nodes; 3]);
    }
    // On lattice positions.
    let voxels = solids::voxels(&mut random, 4, 50);
    let nodes = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0];
    run("voxels on planes", &voxels, [&nodes, &nodes, &[0.0, 2.0, 4.0]]);
}

/// Boxes of unlike sides, far from the origin, tiny and huge.
#[test]
fn scales() {
    let tetrahedron = tetrahedron([[0.1, 0.17, 0.13], [0.9, 0.31, 0.2], [0.3, 0.87, 0.21], [0.4, 0.37, 0.93]]);
    for (scale, shift) in [(1.0, 4096.0), (2f64.powi(40), 0.0), (1e-30, 1e-20), (1e-120, 0.0), (1e110, 0.0)] {
        let x = |x: f64| x * scale + shift;
        let soup = Soup { vertices: tetrahedron.vertices.iter().map(|v| v.map(x)).collect(), ..tetrahedron.clone() };
        let nodes = [uniform(x(0.0), x(1.0), 3), uniform(x(0.0), x(1.0), 40), vec![x(0.0), x(0.3), x(0.30001), x(1.0)]];
        let nodes = nodes.map(|mut n| {
            n.dedup();
            n
        });
        let r = inside(&soup, [&nodes[0], &nodes[1], &nodes[2]]);
        let m = compare("scaled", &r);
        report(&format!("{scale:e}"), &r, &m);
    }
}

/// Tiny corners: fixed point stays relative to the cell.
#[test]
fn small_cells() {
    let mut nodes = uniform(-1.0, 1.0, 2);
    nodes[1] = 0.3;
    for size in [1e-3, 1e-5, 1e-7] {
        let at = |x: f64| 0.3 + x * size;
        let soup =
            tetrahedron([[-0.7, -0.6, -0.9], [at(3.1), -0.4, 0.1], [-0.3, at(2.3), -0.1], [-0.1, -0.2, at(1.7)]]);
        let r = inside(&soup, [&nodes; 3]);
        let m = compare("small", &r);
        report("small", &r, &m);
        assert!(m.cell_fraction.iter().any(|&f| f < size));
        assert!(m.exact_cells == 0 || size < 1e-4);
    }
}

/// Second moments: of boxes by their closed form; the first moments and the general formula elsewhere.
#[test]
fn second_order() {
    // Between the grid's planes: every cell is a box.
    let nodes = [uniform(-0.7, 1.3, 3), uniform(-0.31, 1.77, 4), uniform(-1.1, 1.3, 3)];
    let (low, high) = ([-0.41, 0.1, -0.77], [1.03, 1.4, 0.9]);
    let r = inside(&cuboid(low, high), [&nodes[0], &nodes[1], &nodes[2]]);
    let g = &r.grid;
    let m = second_moments(g);
    for (k, b) in cell_boxes(g).into_iter().enumerate() {
        let [from, to] = g.lattice.corners(b);
        // Powers integrated over each side of the cell, about the middle of the box.
        let sides: [[Rational; 3]; 3] = std::array::from_fn(|i| {
            let c = (of(from[i]) + of(to[i])) / 2;
            let (p, q) = (of(from[i].max(low[i])) - &c, of(to[i].min(high[i])) - c);
            let power = |x: &Rational, n: usize| (0..n).fold(Rational::from(1), |y, _| y * x);
            [1, 2, 3].map(|n| (power(&q, n) - power(&p, n)) / n as u32)
        });
        let integral = |n: [usize; 3]| (0..3).fold(Rational::from(1), |y, i| y * &sides[i][n[i]]);
        for i in 0..3 {
            same("first", m.first[k][i], &integral(std::array::from_fn(|a| (a == i) as usize)));
        }
        for (x, [i, j]) in m.second[k].iter().zip(exact_moments::PAIRS) {
            same("second", *x, &integral(std::array::from_fn(|a| (a == i) as usize + (a == j) as usize)));
        }
    }
    let mut random = Random(3);
    let soup = solids::star(2, || 0.5 + 0.4 * random.unit());
    let soup = solids::mapped(soup, [[0.62, 0.04, 0.0], [0.02, 0.58, 0.1], [0.0, 0.06, 0.66]]);
    let nodes = [uniform(-1.3, 1.2, 6), uniform(-1.2, 1.3, 5), uniform(-1.25, 1.25, 4)];
    let r = inside(&soup, [&nodes[0], &nodes[1], &nodes[2]]);
    let g = &r.grid;
    let m = second_moments(g);
    for (k, b) in cell_boxes(g).into_iter().enumerate() {
        let (_, middle, _) = exact_moments::box_values(g, b);
        let (volume, centroid) = cell_values(&r.complex, r.cells[k]);
        let exact = exact_moments::cell(g, CellId::of(k), &middle, true);
        for i in 0..3 {
            same("first", m.first[k][i], &((centroid[i].clone() - &middle[i]) * &volume));
        }
        for (x, exact) in m.second[k].iter().zip(&exact.second) {
            same("second", *x, exact);
        }
    }
    println!("{} cells, {} by rationals", g.cell_count(), m.exact_cells);
    assert!(m.exact_cells * 10 < g.cell_count());
}

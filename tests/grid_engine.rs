//! The grid engine against the general cut, cell by cell: boxes, faces with their corners, volumes, arrays.

mod common;
#[path = "common/grid_reference.rs"]
mod grid_reference;
#[path = "common/solids.rs"]
mod solids;

use common::*;
use grid_reference::{Reference, inside, outside, whole};
use lapidary::base::{CellId, FaceId, Run};
use lapidary::grid::boundaries::{Boundaries, boundaries};
use lapidary::grid::moments::{GridMoments, moments};
use lapidary::grid::{FULL_CELL, GridCells, GridOptions, cut_grid};
use solids::Random;
use std::sync::Arc;

type Bits = [u64; 3];

/// A face by what it is: the loops' coordinates, each from its lowest corner, the outer loop first.
fn shape(g: &GridCells, f: FaceId) -> (u8, Vec<Vec<Bits>>) {
    let kind = if f.at() < g.wall_count() { 3 } else { g.face_axis(f) as u8 };
    let mut loops: Vec<Vec<Bits>> = g
        .loops_of(f)
        .map(|l| {
            let mut points: Vec<Bits> = g.corners_of(l).iter().map(|v| g.coords[v.at()].map(f64::to_bits)).collect();
            let least = (0..points.len()).min_by_key(|&i| points[i]).unwrap();
            points.rotate_left(least);
            points
        })
        .collect();
    loops[1..].sort();
    (kind, loops)
}

/// What a cell is: its faces with their sides, and its numbers.
type CellShape = (Vec<(u8, Vec<Vec<Bits>>, bool)>, Vec<u64>);

/// The cells of each cut box as sets.
fn cells(g: &GridCells, m: &GridMoments, walls: &Boundaries) -> Vec<(u32, Vec<CellShape>)> {
    let mut out = Vec::new();
    for (b, w) in g.cut_boxes.iter().zip(g.box_cells.windows(2)) {
        let mut members: Vec<CellShape> = (w[0]..w[1])
            .map(|c| {
                let mut faces: Vec<_> = g
                    .cell_faces(CellId(c))
                    .iter()
                    .map(|h| {
                        let (kind, loops) = shape(g, h.face());
                        (kind, loops, h.front())
                    })
                    .collect();
                faces.sort();
                let c = c as usize;
                let mut numbers = vec![m.cell_volume[c], m.cell_fraction[c]];
                numbers.extend(m.cell_centroid[c].iter().chain(&walls.area[c]).chain(&walls.centroid[c]));
                (faces, numbers.into_iter().map(f64::to_bits).collect())
            })
            .collect();
        members.sort();
        out.push((b.0, members));
    }
    out
}

/// A face in a grid plane: its square, axis and loops, which sides have a cell or a full box, and its numbers.
type PlaneFace = (u32, u8, Vec<Vec<Bits>>, [u8; 2], Vec<u64>);

/// Faces in grid planes as a set.
fn faces(g: &GridCells, m: &GridMoments) -> Vec<PlaneFace> {
    let mut out: Vec<_> = (0..g.square_node.len())
        .map(|k| {
            let (kind, loops) = shape(g, FaceId::of(g.plane_faces[0] as usize + k));
            let sides = g.square_cells[k].map(|c| (c.is_none() as u8) * 2 + (c == FULL_CELL) as u8);
            let numbers = [m.face_area[k], m.face_fraction[k]].into_iter().chain(m.face_centroid[k]);
            (g.square_node[k].0, kind, loops, sides, numbers.map(f64::to_bits).collect())
        })
        .collect();
    out.sort();
    out
}

fn compare(name: &str, soup: &Soup, nodes: [&[f64]; 3]) {
    for out in [false, true] {
        let Reference { grid, .. } = if out { outside(soup, nodes) } else { inside(soup, nodes) };
        let mesh = Arc::new(build_soup(soup, merging()).expect("a valid mesh"));
        let options = GridOptions { outside: out, ..Default::default() };
        let g = cut_grid(&mesh, whole(nodes), &options, &mut Run::quiet()).expect("a grid that can be cut");
        let name = format!("{name}, {}", if out { "outside" } else { "inside" });
        assert_eq!(g.flags, grid.flags, "{name}");
        assert_eq!(g.cut_boxes, grid.cut_boxes, "{name}");
        assert_eq!(g.cell_count(), grid.cell_count(), "{name}");
        let (m, reference) = (moments(&g), moments(&grid));
        let (walls, theirs) = (boundaries(&g, &m), boundaries(&grid, &reference));
        for (a, b) in cells(&g, &m, &walls).iter().zip(&cells(&grid, &reference, &theirs)) {
            assert_eq!(a, b, "{name}");
        }
        for (a, b) in faces(&g, &m).iter().zip(&faces(&grid, &reference)) {
            assert_eq!(a, b, "{name}");
        }
        assert_eq!((g.square_node.len(), g.wall_count()), (grid.square_node.len(), grid.wall_count()), "{name}");
        println!("{name}: {} cells, {} faces", g.cell_count(), g.square_node.len());
    }
}

fn uniform(low: f64, high: f64, boxes: usize) -> Vec<f64> {
    (0..=boxes).map(|i| low + (high - low) * i as f64 / boxes as f64).collect()
}

#[test]
fn stars() {
    let mut random = Random(7);
    let soup = solids::star(2, || 0.5 + 0.4 * random.unit());
    let soup = solids::mapped(soup, [[0.62, 0.04, 0.0], [0.02, 0.58, 0.1], [0.0, 0.06, 0.66]]);
    let nodes = [uniform(-1.3, 1.2, 19), uniform(-1.2, 1.3, 8), uniform(-1.25, 1.25, 7)];
    compare("star", &soup, [&nodes[0], &nodes[1], &nodes[2]]);
    // Integer vertices on grid planes.
    let nodes = uniform(-16.0, 16.0, 8);
    compare("octahedral", &solids::ball(2), [&nodes; 3]);
}

#[test]
fn plates_bodies_voxels() {
    let nodes = uniform(-1.0, 1.0, 4);
    let plate = solids::mapped(
        cuboid([-0.9, -0.83, -0.001], [0.93, 0.87, 0.001]),
        [[0.9, 0.1, 0.3], [-0.1, 0.95, 0.2], [-0.3, -0.1, 0.9]],
    );
    compare("plate", &plate, [&nodes; 3]);
    let bodies = together(&[
        cuboid([0.1, 0.1, 0.1], [0.2, 0.3, 0.4]),
        flipped(cuboid([0.12, 0.12, 0.15], [0.18, 0.2, 0.3])),
        cuboid([-0.75, -0.9, -0.75], [-0.25, 0.9, -0.7]),
    ]);
    compare("bodies", &bodies, [&nodes; 3]);
    let mut random = Random(11);
    for _ in 0..4 {
        let voxels = solids::voxels(&mut random, 4, 45);
        let nodes = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0];
        compare("voxels", &voxels, [&nodes, &nodes, &[-0.5, 0.7, 2.0, 4.0, 4.5]]);
    }
}

/// A sphere on 32³ boxes.
#[test]
fn sphere() {
    let soup = solids::mapped(solids::ball(4), [[0.06, 0.0, 0.0], [0.0, 0.06, 0.001], [0.002, 0.0, 0.06]]);
    let nodes = uniform(-1.05, 1.05, 32);
    compare("sphere", &soup, [&nodes; 3]);
}

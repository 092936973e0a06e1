//! Aggregation of small cells: what it must give by definition.

mod common;
#[path = "common/grid_reference.rs"]
mod grid_reference;
#[path = "common/solids.rs"]
mod solids;

use common::*;
use grid_reference::{inside, outside};
use lapidary::base::{BoxId, CellId, FaceId};
use lapidary::grid::aggregate::{AggregateOptions, Aggregates, aggregate};
use lapidary::grid::full_faces::box_beside;
use lapidary::grid::moments::{GridMoments, cell_boxes, moments};
use lapidary::grid::{FULL_CELL, GridCells};
use solids::Random;
use std::collections::BTreeMap;

fn uniform(low: f64, high: f64, boxes: usize) -> Vec<f64> {
    (0..=boxes).map(|i| low + (high - low) * i as f64 / boxes as f64).collect()
}

/// The two sides of a face as members: (box, cell).
fn sides(g: &GridCells, k: usize) -> Option<[(BoxId, CellId); 2]> {
    let f = FaceId::of(g.plane_faces[0] as usize + k);
    let cells = g.square_cells[k];
    if cells.iter().any(|c| c.is_none()) {
        return None;
    }
    let boxes = cell_boxes(g);
    let item = |s: usize| match cells[s] {
        FULL_CELL => (box_beside(g, f, s), FULL_CELL),
        c => (boxes[c.at()], c),
    };
    Some([item(0), item(1)])
}

fn check(
    name: &str,
    g: &GridCells,
    m: &GridMoments,
    minimum: f64,
    faces: Option<&[u8]>,
    cells: Option<&[u8]>,
) -> Aggregates {
    let a = aggregate(g, m, &AggregateOptions { minimum }, faces, cells);
    assert_eq!(a.check(g), Ok(()), "{name}");
    let stands = |c: usize| (a.in_box[c], a.cell[c]);
    let mut members: BTreeMap<(BoxId, CellId), Vec<usize>> = BTreeMap::new();
    (0..g.cell_count()).for_each(|c| members.entry(stands(c)).or_default().push(c));
    let links: Vec<([(BoxId, CellId); 2], bool)> = (0..g.square_cells.len())
        .filter_map(|k| {
            let marked = |c: CellId| c != FULL_CELL && cells.is_some_and(|m| m[c.at()] != 0);
            sides(g, k).map(|s| (s, faces.is_some_and(|m| m[k] != 0) || s.iter().any(|s| marked(s.1))))
        })
        .collect();
    let name_of = |(b, c): (BoxId, CellId)| if c == FULL_CELL { (b, c) } else { stands(c.at()) };
    let mut too_small = Vec::new();
    for (&rep, list) in &members {
        let own: f64 = list.iter().map(|&c| m.cell_fraction[c]).sum();
        let sum = own + (rep.1 == FULL_CELL) as u8 as f64;
        // Big cells stay alone unless small ones come to them.
        if list.len() > 1 || rep.1 == FULL_CELL {
            assert!(list.iter().any(|&c| m.cell_fraction[c] < minimum), "{name}: nothing small in {rep:?}");
        }
        if rep.1 != FULL_CELL {
            let largest = list.iter().map(|&c| m.cell_fraction[c]).fold(0.0, f64::max);
            assert_eq!(m.cell_fraction[rep.1.at()], largest, "{name}: the largest stands for all");
        }
        // Connected through open faces among its own members.
        let mut reached = vec![rep];
        let mut i = 0;
        while i < reached.len() {
            for ([p, q], closed) in &links {
                for (from, to) in [(p, q), (q, p)] {
                    if *from == reached[i] && !closed && name_of(*to) == rep && !reached.contains(to) {
                        // A full box links only to the cells that it stands for.
                        if to.1 != FULL_CELL || *to == rep {
                            reached.push(*to);
                        }
                    }
                }
            }
            i += 1;
        }
        let cells_reached = reached.iter().filter(|r| r.1 != FULL_CELL).count();
        assert_eq!(cells_reached, list.len(), "{name}: {rep:?} is not connected");
        if sum < minimum * (1.0 - 1e-12) {
            // Then nothing is left to merge with.
            for ([p, q], closed) in &links {
                assert!(*closed || (name_of(*p) == rep) == (name_of(*q) == rep), "{name}: {rep:?} could be larger");
            }
            too_small.push(rep.1);
        }
    }
    too_small.sort();
    assert_eq!(a.too_small, too_small, "{name}");
    let threads = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    assert_eq!(threads.install(|| aggregate(g, m, &AggregateOptions { minimum }, faces, cells)), a);
    a
}

#[test]
fn definitions_hold() {
    let mut random = Random(7);
    let soup = solids::star(2, || 0.5 + 0.4 * random.unit());
    let soup = solids::mapped(soup, [[0.62, 0.04, 0.0], [0.02, 0.58, 0.1], [0.0, 0.06, 0.66]]);
    let nodes = [uniform(-1.3, 1.2, 9), uniform(-1.2, 1.3, 8), uniform(-1.25, 1.25, 7)];
    let nodes = [&nodes[0][..], &nodes[1], &nodes[2]];
    for r in [inside(&soup, nodes), outside(&soup, nodes)] {
        let (g, m) = (&r.grid, moments(&r.grid));
        for minimum in [0.0, 0.1, 0.5, 0.99, 1.0] {
            let a = check("star", g, &m, minimum, None, None);
            if minimum == 0.0 {
                assert!(a.cell.iter().enumerate().all(|(c, r)| r.at() == c), "nothing is too small");
            }
            let faces: Vec<u8> = g.square_cells.iter().map(|_| (random.below(3) == 0) as u8).collect();
            let cells: Vec<u8> = (0..g.cell_count()).map(|_| (random.below(5) == 0) as u8).collect();
            let b = check("marked", g, &m, minimum, Some(&faces), Some(&cells));
            for (c, _) in cells.iter().enumerate().filter(|(_, m)| **m != 0) {
                assert_eq!(b.cell[c], CellId::of(c), "a marked cell stays alone");
            }
        }
    }
}

/// A wall at 0.95 of a row of boxes: each sliver goes to the full box across its large face, not along the wall.
#[test]
fn slivers_go_to_the_full_box() {
    let nodes = uniform(0.0, 4.0, 4);
    let soup = cuboid([0.0; 3], [3.05, 4.0, 4.0]);
    let r = inside(&soup, [&nodes; 3]);
    let m = moments(&r.grid);
    let a = check("slab", &r.grid, &m, 0.2, None, None);
    let boxes = cell_boxes(&r.grid);
    let mut slivers = 0;
    assert_eq!(boxes.len(), r.grid.cell_count());
    for (c, &b) in boxes.iter().enumerate() {
        let at = r.grid.lattice.box_at(b);
        if at[0] == 3 {
            slivers += 1;
            assert_eq!(a.in_box[c], r.grid.lattice.box_id([2, at[1], at[2]]));
        } else {
            assert_eq!(a.cell[c], CellId::of(c));
        }
    }
    assert_eq!(slivers, 16);
    assert!(a.too_small.is_empty());
}

/// A tapered wedge along x, one box high: a chain ends as soon as it suffices.
#[test]
fn chains_end() {
    let (xs, ys) = (uniform(0.0, 10.0, 10), [0.0, 1.0]);
    // Height x/10 at x: cell i has fraction (2 i + 1) / 20.
    let soup = Soup {
        vertices: vec![
            [0.0, 0.0, 0.0],
            [10.0, 0.0, 0.0],
            [10.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [10.0, 0.0, 1.0],
            [10.0, 1.0, 1.0],
        ],
        triangles: vec![[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [0, 3, 5], [0, 5, 2]],
    };
    let r = inside(&soup, [&xs, &ys, &ys]);
    let m = moments(&r.grid);
    let fractions: Vec<f64> = (0..10).map(|i| (2 * i + 1) as f64 / 20.0).collect();
    m.cell_fraction.iter().zip(&fractions).for_each(|(a, b)| assert!((a - b).abs() < 1e-15));
    // 0.05 + 0.15 + 0.25 + 0.35 suffice for 0.5; 0.45 then goes to 0.55.
    let a = check("wedge", &r.grid, &m, 0.5, None, None);
    let of: Vec<usize> = a.cell.iter().map(|c| c.at()).collect();
    assert_eq!(of, [3, 3, 3, 3, 5, 5, 6, 7, 8, 9]);
    // Closed in the middle: the first two are on their own.
    let f = (0..r.grid.square_cells.len()).find(|&k| r.grid.square_cells[k] == [CellId(1), CellId(2)]).unwrap();
    let mut marks = vec![0; r.grid.square_cells.len()];
    marks[f] = 1;
    let a = check("closed wedge", &r.grid, &m, 0.5, Some(&marks), None);
    assert_eq!(a.too_small, [CellId(1)]);
    assert_eq!(a.cell[..2], [CellId(1), CellId(1)]);
}

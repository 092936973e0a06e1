//! Connected regions, points in them, and the faces that full boxes imply, against flooding over single boxes and cells.

mod common;
#[path = "common/grid_reference.rs"]
mod grid_reference;
#[path = "common/solids.rs"]
mod solids;

use common::*;
use grid_reference::{Reference, inside, outside};
use lapidary::base::{BoxId, CellId, FaceId, NodeId, RegionId};
use lapidary::grid::full_faces::{box_beside, full_faces, full_links};
use lapidary::grid::regions::{PointPlace, Regions, regions};
use lapidary::grid::{CUT, FULL, FULL_CELL, GridCells};
use solids::Random;
use std::collections::{BTreeMap, BTreeSet};

/// Regions by flooding: an item is a cell or a full box; neighbours by faces, and between full boxes by the lattice.
fn flood(g: &GridCells) -> (Vec<usize>, BTreeMap<BoxId, usize>, usize) {
    let mut neighbours: BTreeMap<(u32, u32), Vec<(u32, u32)>> = BTreeMap::new();
    let item = |c: CellId, b: BoxId| (b.0, if c == FULL_CELL { u32::MAX } else { c.0 });
    for (b, w) in g.cut_boxes.iter().zip(g.box_cells.windows(2)) {
        for c in w[0]..w[1] {
            neighbours.entry((b.0, c)).or_default();
        }
    }
    for b in (0..g.flags.len()).filter(|&b| g.flags[b] == FULL) {
        let at = g.lattice.box_at(BoxId::of(b));
        let list = neighbours.entry((b as u32, u32::MAX)).or_default();
        for a in 0..3 {
            for up in [false, true] {
                let mut to = at;
                to[a] = if up { at[a] + 1 } else { at[a].wrapping_sub(1) };
                if to[a] < g.lattice.count(a) && g.flags[g.lattice.box_id(to).at()] == FULL {
                    list.push((g.lattice.box_id(to).0, u32::MAX));
                }
            }
        }
    }
    for (k, sides) in g.square_cells.iter().enumerate() {
        if sides.iter().all(|c| c.is_some()) {
            let f = FaceId::of(g.plane_faces[0] as usize + k);
            let [a, b] = [0, 1].map(|s| item(sides[s], box_beside(g, f, s)));
            neighbours.get_mut(&a).expect("an item").push(b);
            neighbours.get_mut(&b).expect("an item").push(a);
        }
    }
    // Items rise by box, then cell: so do the regions' numbers.
    let mut found: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    let mut count = 0;
    for start in neighbours.keys() {
        if found.contains_key(start) {
            continue;
        }
        let mut open = vec![*start];
        while let Some(x) = open.pop() {
            if found.insert(x, count).is_none() {
                open.extend(&neighbours[&x]);
            }
        }
        count += 1;
    }
    let mut cells = vec![usize::MAX; g.cell_count()];
    let mut full = BTreeMap::new();
    for ((b, c), r) in found {
        if c == u32::MAX {
            full.insert(BoxId(b), r);
        } else {
            cells[c as usize] = r;
        }
    }
    (cells, full, count)
}

fn compare(name: &str, g: &GridCells) -> Regions {
    let r = regions(g);
    assert_eq!(r.check(g), Ok(()), "{name}");
    let (cells, full, count) = flood(g);
    assert_eq!(r.count, count, "{name}");
    assert_eq!(r.cell_region.iter().map(|r| r.at()).collect::<Vec<_>>(), cells, "{name}");
    for b in (0..g.flags.len()).map(BoxId::of) {
        let expected = full.get(&b).map_or(RegionId::NONE, |&r| RegionId::of(r));
        assert_eq!(r.region_of_box(g, b), expected, "{name}: box {}", b.0);
    }
    for region in 0..count {
        let (of_cells, of_boxes) = r.mask(g, RegionId::of(region));
        assert!(of_cells.iter().zip(&cells).all(|(&m, &r)| (m == 1) == (r == region)));
        assert!(of_boxes.iter().enumerate().all(|(b, &m)| (m == 1) == (full.get(&BoxId::of(b)) == Some(&region))));
    }
    let threads = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    assert_eq!(threads.install(|| regions(g)), r);
    squares(name, g);
    r
}

/// Each square with fluid on it is a face or an implied square, and links lead to all full neighbours.
fn squares(name: &str, g: &GridCells) {
    for axis in 0..3 {
        let stored: BTreeSet<NodeId> = (g.plane_faces[axis]..g.plane_faces[axis + 1])
            .map(|f| g.square_node[(f - g.plane_faces[0]) as usize])
            .collect();
        for node in 0..g.lattice.nodes[axis].len() {
            let implied = full_faces(g, axis, node);
            assert!(implied.low_node.windows(2).all(|w| w[0] < w[1]), "{name}");
            let mut rest = implied.low_node.iter().zip(&implied.boxes);
            for n in 0..g.lattice.nodes.iter().map(Vec::len).product() {
                let n = NodeId::of(n);
                let at = g.lattice.node_at(n);
                if at[axis] != node || (0..3).any(|a| a != axis && at[a] == g.lattice.count(a)) {
                    continue;
                }
                let beside = [0, 1].map(|side| {
                    let mut at = at;
                    at[axis] = (at[axis] + side).wrapping_sub(1);
                    if at[axis] < g.lattice.count(axis) { g.lattice.box_id(at) } else { BoxId::NONE }
                });
                if beside.iter().any(|b| b.is_some() && g.flags[b.at()] == FULL) && !stored.contains(&n) {
                    assert_eq!(rest.next(), Some((&n, &beside)), "{name}");
                }
            }
            assert_eq!(rest.next(), None, "{name}: more squares");
        }
    }
    let links = full_links(g);
    let mut found = BTreeSet::new();
    for ((&cell, &face), &b) in links.cell.iter().zip(&links.face).zip(&links.full) {
        assert_eq!(g.flags[b.at()], FULL);
        assert!(g.cell_faces(cell).iter().any(|h| h.face() == face), "{name}: the face is the cell's");
        assert!(found.insert((cell.0, b.0)), "{name}: one square between a cell and a full box");
    }
    // Counted from the boxes: a full box and a cut one share one face.
    let mut expected = 0;
    for b in (0..g.flags.len()).filter(|&b| g.flags[b] == FULL) {
        let at = g.lattice.box_at(BoxId::of(b));
        for a in 0..3 {
            for up in [false, true] {
                let mut to = at;
                to[a] = if up { at[a] + 1 } else { at[a].wrapping_sub(1) };
                expected += (to[a] < g.lattice.count(a) && g.flags[g.lattice.box_id(to).at()] == CUT) as usize;
            }
        }
    }
    assert_eq!(found.len(), expected, "{name}");
}

fn uniform(low: f64, high: f64, boxes: usize) -> Vec<f64> {
    (0..=boxes).map(|i| low + (high - low) * i as f64 / boxes as f64).collect()
}

/// Cell centroids of convex cells are in their regions; so are middles of full boxes.
fn middles(r: &Reference, regions: &Regions) {
    let g = &r.grid;
    for (b, _) in &r.full {
        let [low, high] = g.lattice.corners(*b);
        let x = std::array::from_fn(|a| 0.5 * (low[a] + high[a]));
        assert_eq!(regions.at_point(g, &x), PointPlace::Region(regions.region_of_box(g, *b)));
        assert_eq!(regions.at_point(g, &low), PointPlace::Region(regions.region_of_box(g, *b)));
        assert_eq!(regions.at_point(g, &high), PointPlace::Region(regions.region_of_box(g, *b)));
    }
}

#[test]
fn star() {
    let mut random = Random(7);
    let soup = solids::star(2, || 0.5 + 0.4 * random.unit());
    let soup = solids::mapped(soup, [[0.62, 0.04, 0.0], [0.02, 0.58, 0.1], [0.0, 0.06, 0.66]]);
    let nodes = [uniform(-1.3, 1.2, 9), uniform(-1.2, 1.3, 8), uniform(-1.25, 1.25, 7)];
    let nodes = [&nodes[0][..], &nodes[1], &nodes[2]];
    for r in [inside(&soup, nodes), outside(&soup, nodes)] {
        let found = compare("star", &r.grid);
        assert_eq!(found.count, 1);
        middles(&r, &found);
    }
}

/// A hollow body: fluid within and around it, and a smaller body in a single box.
#[test]
fn shells_separate() {
    let nodes = uniform(-1.0, 1.0, 8);
    let wall = together(&[cuboid([-0.6; 3], [0.6, 0.55, 0.7]), flipped(cuboid([-0.52; 3], [0.5, 0.45, 0.65]))]);
    let small = together(&[cuboid([0.76; 3], [0.98; 3]), flipped(cuboid([0.8; 3], [0.9; 3]))]);
    let soup = together(&[wall, small]);
    let r = outside(&soup, [&nodes; 3]);
    let found = compare("hollow", &r.grid);
    assert_eq!(found.count, 3);
    middles(&r, &found);
    let g = &r.grid;
    let at = |x: [f64; 3]| found.at_point(g, &x);
    let region = |i: usize| PointPlace::Region(RegionId::of(i));
    assert_eq!(at([-1.0; 3]), region(0));
    assert_eq!(at([0.0; 3]), region(1));
    assert_eq!(at([0.85; 3]), region(2));
    assert_eq!(at([1.0; 3]), region(0));
    assert_eq!(at([0.99, 0.85, 0.85]), region(0));
    assert_eq!(at([0.55, 0.0, 0.0]), PointPlace::Solid);
    assert_eq!(at([0.77, 0.85, 0.85]), PointPlace::Solid);
    // On a face, an edge, a corner; one step beside.
    assert_eq!(at([0.6, 0.1, 0.2]), PointPlace::Surface);
    assert_eq!(at([0.5, 0.45, 0.2]), PointPlace::Surface);
    assert_eq!(at([0.8; 3]), PointPlace::Surface);
    assert_eq!(at([0.6f64.next_up(), 0.1, 0.2]), region(0));
    assert_eq!(at([0.6f64.next_down(), 0.1, 0.2]), PointPlace::Solid);
    assert_eq!(at([0.5f64.next_down(), 0.1, 0.2]), region(1));
    assert_eq!(at([1.0f64.next_up(), 0.0, 0.0]), PointPlace::Beyond);
    assert_eq!(at([f64::NAN, 0.0, 0.0]), PointPlace::Beyond);
    // Within: the solid is the fluid.
    let r = inside(&soup, [&nodes; 3]);
    let found = compare("wall", &r.grid);
    assert_eq!(found.count, 2);
    assert_eq!(found.at_point(&r.grid, &[0.55, 0.0, 0.0]), region(0));
    assert_eq!(found.at_point(&r.grid, &[0.77, 0.85, 0.85]), region(1));
    assert_eq!(found.at_point(&r.grid, &[0.0; 3]), PointPlace::Solid);
}

/// Plates split boxes, and space; cells that touch along an edge are not connected.
#[test]
fn plates_split() {
    let nodes = uniform(-1.0, 1.0, 4);
    let plate = solids::mapped(
        cuboid([-9.0, -9.0, -0.001], [9.0, 9.0, 0.001]),
        [[0.9, 0.1, 0.3], [-0.1, 0.95, 0.2], [-0.3, -0.1, 0.9]],
    );
    let r = outside(&plate, [&nodes; 3]);
    let found = compare("plate", &r.grid);
    assert_eq!(found.count, 2);
    assert!(r.grid.box_cells.windows(2).any(|w| w[1] - w[0] == 2), "the plate splits boxes");
    let mut random = Random(5);
    for round in 0..6 {
        let voxels = solids::voxels(&mut random, 5, 35);
        let nodes = if round % 2 == 0 { uniform(0.0, 5.0, 5) } else { uniform(-0.3, 5.4, 4) };
        let r = inside(&voxels, [&nodes; 3]);
        compare("voxels", &r.grid);
        compare("around voxels", &outside(&voxels, [&nodes; 3]).grid);
    }
}

//! The cells of a grid against the general cut by the same planes, cell by cell and exactly; invariants on random solids with everything in
//! degenerate position.

mod common;
#[path = "common/solids.rs"]
mod solids;

use common::random::Random;
use common::{Soup, build_soup, cuboid, flipped, together};
use lapidary::base::{BoxId, CellId, Run};
use lapidary::complex::{self, Complex, exact_values};
use lapidary::cut::{CutOptions, cut};
use lapidary::grid::{CUT, EMPTY, FULL, GridCells, GridOptions, Lattice, cut_grid, to_complex};
use lapidary::mesh::{MeshOptions, TriMesh};
use rug::Rational;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a cell is, without ids: exact volume, sorted vertices, number of faces.
type Shape = (Rational, Vec<[u64; 3]>, usize);

fn shape(c: &Complex, k: CellId) -> Shape {
    let mut vertices: Vec<[u64; 3]> = c
        .cell_faces(k)
        .iter()
        .flat_map(|h| c.corner_vertices[c.face_corners(h.face())].iter())
        .map(|v| c.coords[v.at()].map(f64::to_bits))
        .collect();
    vertices.sort_unstable();
    vertices.dedup();
    (exact_values::cell_volume(c, k), vertices, c.cell_faces(k).len())
}

/// The box that holds a cell: rounding is monotone, so rounded coordinates tell.
fn box_of(c: &Complex, k: CellId, lattice: &Lattice) -> Option<BoxId> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for h in c.cell_faces(k) {
        for v in &c.corner_vertices[c.face_corners(h.face())] {
            for a in 0..3 {
                low[a] = low[a].min(c.coords[v.at()][a]);
                high[a] = high[a].max(c.coords[v.at()][a]);
            }
        }
    }
    let mut at = [0; 3];
    for a in 0..3 {
        let n = &lattice.nodes[a];
        if low[a] < n[0] || high[a] > n[n.len() - 1] {
            return None;
        }
        at[a] = n.partition_point(|x| *x <= low[a]) - 1;
        assert!(high[a] <= n[at[a] + 1], "a cell crosses a plane");
    }
    Some(lattice.box_id(at))
}

fn by_box(c: &Complex, lattice: &Lattice) -> BTreeMap<BoxId, Vec<Shape>> {
    let mut out: BTreeMap<BoxId, Vec<Shape>> = BTreeMap::new();
    for k in (0..c.cell_count()).map(CellId::of) {
        if let Some(b) = box_of(c, k, lattice) {
            out.entry(b).or_default().push(shape(c, k));
        }
    }
    out.values_mut().for_each(|shapes| shapes.sort());
    out
}

fn box_volume(lattice: &Lattice, b: BoxId) -> Rational {
    let [low, high] = lattice.corners(b);
    (0..3).fold(Rational::from(1), |v, a| {
        v * (Rational::from_f64(high[a]).unwrap() - Rational::from_f64(low[a]).unwrap())
    })
}

/// Compares with the general cut of `solid` by the grid's planes, box by box.
fn compare(name: &str, grid: &GridCells, solid: &Arc<TriMesh>) {
    assert_eq!(grid.check(), Ok(()), "{name}");
    let own = to_complex(grid);
    assert_eq!(complex::check_part(&own), Ok(()), "{name}");
    let general = cut(solid, &grid.planes, &CutOptions::default(), &mut Run::quiet()).expect(name);
    let expected = by_box(&general.complex, &grid.lattice);
    let found = by_box(&own, &grid.lattice);
    for b in (0..grid.lattice.box_count()).map(BoxId::of) {
        let at = grid.lattice.box_at(b);
        let theirs = expected.get(&b).map_or(&[][..], |v| v);
        let ours = found.get(&b).map_or(&[][..], |v| v);
        assert_eq!(ours.len(), grid.cells_of(b).len(), "{name}: box {at:?}");
        match grid.flags[b.at()] {
            EMPTY => assert!(theirs.is_empty() && ours.is_empty(), "{name}: box {at:?} is empty"),
            FULL => {
                assert!(ours.is_empty(), "{name}: box {at:?} is full");
                assert_eq!(theirs.len(), 1, "{name}: box {at:?} is full");
                assert_eq!(theirs[0].0, box_volume(&grid.lattice, b), "{name}: box {at:?} is full");
                assert!(theirs[0].1.len() == 8, "{name}: the surface touches the full box {at:?}");
            }
            CUT => {
                // Walls of the domain itself may lie on the grid's own planes: vertices and faces agree unless they are split there.
                let volumes = |s: &[Shape]| s.iter().map(|s| s.0.clone()).collect::<Vec<_>>();
                assert_eq!(volumes(ours), volumes(theirs), "{name}: box {at:?}");
                assert_eq!(ours, theirs, "{name}: box {at:?}");
            }
            other => panic!("{name}: flag {other}"),
        }
    }
}

fn block(nodes: &[Vec<f64>; 3]) -> Lattice {
    let n = [&nodes[0][..], &nodes[1][..], &nodes[2][..]];
    Lattice::new(n, [0; 3], [0, 1, 2].map(|a| nodes[a].len() as i64 - 1)).expect("a lattice")
}

fn run(mesh: &Arc<TriMesh>, lattice: &Lattice, outside: bool) -> GridCells {
    let options = GridOptions { outside, known: None };
    cut_grid(mesh, lattice.clone(), &options, &mut Run::quiet()).expect("a grid")
}

/// Both sides of a solid on one grid. The grid's box holds the solid in its interior where the outside is compared.
fn both_sides(name: &str, soup: &Soup, nodes: &[Vec<f64>; 3]) {
    let Ok(mesh) = build_soup(soup, MeshOptions::default()) else { return };
    let mesh = Arc::new(mesh);
    let lattice = block(nodes);
    compare(&format!("{name}, inside"), &run(&mesh, &lattice, false), &mesh);
    let (low, high) = ([0, 1, 2].map(|a| nodes[a][0]), [0, 1, 2].map(|a| *nodes[a].last().unwrap()));
    let within = (0..3).all(|a| low[a] < mesh.bbox[0][a] && mesh.bbox[1][a] < high[a]);
    if within {
        // The domain around the solid, as a solid: one plane further out on every side, so that its own faces are on no grid plane.
        let out = cuboid(low.map(|x| x - 1.0), high.map(|x| x + 1.0));
        let domain = build_soup(&together(&[out, flipped(soup.clone())]), MeshOptions::default()).expect(name);
        compare(&format!("{name}, outside"), &run(&mesh, &lattice, true), &Arc::new(domain));
    }
}

/// Rising multiples of a quarter around a solid of the given size, about as many as asked for.
fn nodes(random: &mut Random, low: i64, high: i64, count: u64) -> Vec<f64> {
    let mut n: Vec<i64> = (0..count).map(|_| 4 * low + random.below(4 * (high - low) as u64 + 1) as i64).collect();
    n.extend([4 * low, 4 * high]);
    if random.below(2) == 0 {
        // Whole numbers: on the solid's own planes.
        n.iter_mut().for_each(|x| *x = *x / 4 * 4);
    }
    n.sort_unstable();
    n.dedup();
    n.into_iter().map(|x| x as f64 / 4.0).collect()
}

fn rounds() -> u64 {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(30)
}

#[test]
fn voxels_on_and_off_grid_planes() {
    for seed in 0..rounds() {
        let mut random = Random(seed + 1);
        let soup = solids::voxels(&mut random, 4, 40);
        let n = std::array::from_fn(|_| nodes(&mut random, -1, 6, 6));
        both_sides(&format!("voxels {seed}"), &soup, &n);
    }
}

#[test]
fn stars_and_balls() {
    for seed in 0..rounds() {
        let mut random = Random(seed + 1000);
        let soup = if seed % 2 == 0 {
            solids::star(1 + (seed / 2 % 2) as usize, || 1.0 + 3.0 * random.unit())
        } else {
            let mut s = solids::ball(1 + (seed / 2 % 2) as usize);
            s.vertices.iter_mut().for_each(|x| *x = x.map(|c| (4.0 * c).round() / 2.0));
            s
        };
        let mut random = Random(seed + 2000);
        let n = std::array::from_fn(|_| nodes(&mut random, -6, 6, 2 + seed % 9));
        both_sides(&format!("ball {seed}"), &soup, &n);
    }
}

#[test]
fn several_bodies_in_one_box() {
    // Nested shells and islands, in boxes that hold several of them, cut and uncut.
    for seed in 0..rounds() {
        let mut random = Random(seed + 3000);
        let mut parts = Vec::new();
        for i in 0..3 {
            for j in 0..2 {
                let o = [4.0 * i as f64, 4.0 * j as f64, 0.0];
                let at = |r: f64| cuboid(o.map(|x| x + 2.0 - r), o.map(|x| x + 2.0 + r));
                parts.push(at(1.75));
                if random.below(2) == 0 {
                    parts.push(flipped(at(1.25)));
                    if random.below(2) == 0 {
                        parts.push(at(0.75));
                    }
                }
            }
        }
        let soup = together(&parts);
        let n = [
            nodes(&mut random, -1, 13, seed % 5),
            nodes(&mut random, -1, 9, seed % 4),
            nodes(&mut random, -1, 5, seed % 3),
        ];
        both_sides(&format!("bodies {seed}"), &soup, &n);
    }
}

//! Real models on grids whose planes pass exactly through their vertices: invariants, exact volumes, and four blocks against one.
//!
//! The models are CGAL's (`LAPIDARY_CGAL_MESHES`); a few by default, all with `LAPIDARY_LONG=1`.

mod common;

use common::models::each_model_or_all;
use common::random::Random;
use common::{Soup, cuboid, together};
use lapidary::base::{CellId, FaceId, Run, VertexId};
use lapidary::complex::{Complex, Key, check_part};
use lapidary::exact::residue::{Residue, point_residues};
use lapidary::grid::{FULL, FULL_CELL, GridCells, GridOptions, Lattice, cut_grid, keys, to_complex};
use lapidary::mesh::{MeshInput, MeshOptions, TriMesh, build_patch};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// About `count` boxes along each axis around a mesh; the grid is shifted so that a plane passes exactly through a vertex, and a quarter
/// of the other planes is moved onto vertices near them.
fn nodes(mesh: &TriMesh, count: usize, random: &mut Random) -> [Vec<f64>; 3] {
    std::array::from_fn(|a| {
        let (low, high) = (mesh.bbox[0][a], mesh.bbox[1][a]);
        let step = (high - low) / (count as f64 - 2.5);
        let mut sorted: Vec<f64> = mesh.vertices.iter().map(|x| x[a]).collect();
        sorted.sort_by(f64::total_cmp);
        let vertex = mesh.vertices[random.below(mesh.vertices.len() as u64) as usize][a];
        let before = ((vertex - low) / step).floor() + 1.0;
        let mut nodes: Vec<f64> = (0..=count).map(|i| vertex + (i as f64 - before) * step).collect();
        assert!(nodes.contains(&vertex));
        for x in nodes.iter_mut().skip(1) {
            if random.below(4) == 0 {
                let near = sorted.partition_point(|v| v < x);
                if near < sorted.len() && sorted[near] - *x < step {
                    *x = sorted[near];
                }
            }
        }
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        assert!(nodes[0] < low && *nodes.last().unwrap() > high, "the grid holds the mesh");
        nodes
    })
}

fn lattice(nodes: &[Vec<f64>; 3], low: [usize; 3], high: [usize; 3]) -> Lattice {
    let n = [&nodes[0][..], &nodes[1][..], &nodes[2][..]];
    Lattice::new(n, low.map(|x| x as i64), high.map(|x| x as i64)).expect("a lattice")
}

fn det(a: &[Residue; 3], b: &[Residue; 3], c: &[Residue; 3]) -> Residue {
    (0..3).fold(Residue::ZERO, |sum, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        sum + a[i] * (b[j] * c[k] - b[k] * c[j])
    })
}

fn solid6(mesh: &TriMesh) -> Residue {
    let corners = |t: usize| mesh.corners(lapidary::base::TriangleId::of(t)).map(|p| p.map(Residue::from_f64));
    (0..mesh.triangles.len()).fold(Residue::ZERO, |sum, t| {
        let [a, b, c] = corners(t);
        sum + det(&a, &b, &c)
    })
}

/// Six times the volume of the cut cells, and that each shell's area vectors add up to zero, modulo two primes.
fn cells6(c: &Complex) -> Residue {
    let points: Vec<[Residue; 3]> = (0..c.vertex_count())
        .into_par_iter()
        .map(|v| {
            let x = c.point(VertexId::of(v));
            point_residues(&x).unwrap_or_else(|| {
                lapidary::exact::rational(&x).map(|x| Residue::from_rational(&x).expect("no prime in a denominator"))
            })
        })
        .collect();
    let face = |f: FaceId| -> ([Residue; 3], Residue) {
        let (mut area, mut cone) = ([Residue::ZERO; 3], Residue::ZERO);
        for l in c.loops_of(f) {
            let r = c.corners_of(l);
            let first = points[c.corner_vertices[c.face_corners(f).start].at()];
            for k in r.clone() {
                let next = if k + 1 == r.end { r.start } else { k + 1 };
                let (a, b) = (points[c.corner_vertices[k].at()], points[c.corner_vertices[next].at()]);
                for (i, sum) in area.iter_mut().enumerate() {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    *sum += a[j] * b[k] - a[k] * b[j];
                }
                cone += det(&first, &a, &b);
            }
        }
        (area, cone)
    };
    let mut total = Residue::ZERO;
    for k in (0..c.cell_count()).map(CellId::of) {
        let mut area = [Residue::ZERO; 3];
        for h in c.cell_faces(k) {
            let (a, cone) = face(h.face());
            for (sum, x) in area.iter_mut().zip(a) {
                if h.front() { *sum -= x } else { *sum += x }
            }
            if h.front() { total -= cone } else { total += cone }
        }
        assert!(area.iter().all(|x| x.is_zero()), "the faces of cell {} do not close", k.0);
    }
    total
}

fn full6(grid: &GridCells) -> Residue {
    let six = Residue::from_i64(6);
    let full = grid.flags.iter().enumerate().filter(|(_, f)| **f == FULL);
    full.fold(Residue::ZERO, |sum, (b, _)| {
        let [low, high] = grid.lattice.corners(lapidary::base::BoxId::of(b));
        let side = |a: usize| Residue::from_f64(high[a]) - Residue::from_f64(low[a]);
        sum + six * side(0) * side(1) * side(2)
    })
}

fn invariants(name: &str, grid: &GridCells) -> Residue {
    assert_eq!(grid.check(), Ok(()), "{name}");
    let c = to_complex(grid);
    assert_eq!(check_part(&c), Ok(()), "{name}");
    cells6(&c) + full6(grid)
}

/// A cell without ids: its box in the whole grid and its faces' keys, sorted.
type Named = ([i64; 3], Vec<(Key, bool)>);

struct Parts {
    cells: Vec<Named>,
    /// Coordinates' bits by vertex key.
    vertices: BTreeMap<Key, [u64; 3]>,
    /// Per face key: keys of its vertices, loop by loop as they stand, from the smallest of each loop on.
    faces: BTreeMap<Key, Vec<Vec<Key>>>,
    flags: BTreeMap<[i64; 3], u8>,
    shared: Vec<Key>,
}

fn parts(grid: &GridCells, triangle_ids: Option<&[i64]>) -> Parts {
    let (vertex_keys, face_keys) = keys::keys(grid, triangle_ids).expect("keys");
    let global = |at: [usize; 3]| -> [i64; 3] { std::array::from_fn(|a| at[a] as i64 + grid.lattice.first[a]) };
    let mut out = Parts {
        cells: Vec::new(),
        vertices: BTreeMap::new(),
        faces: BTreeMap::new(),
        flags: BTreeMap::new(),
        shared: Vec::new(),
    };
    for (v, k) in vertex_keys.iter().enumerate() {
        assert!(out.vertices.insert(*k, grid.coords[v].map(f64::to_bits)).is_none(), "two vertices of one key");
    }
    for (f, k) in face_keys.iter().enumerate() {
        let mut loops: Vec<Vec<Key>> = grid
            .loops_of(FaceId::of(f))
            .map(|l| {
                let mut keys: Vec<Key> = grid.corners_of(l).iter().map(|v| vertex_keys[v.at()]).collect();
                // The smallest rotation: a vertex may occur more than once.
                let n = keys.len();
                let best =
                    (0..n).min_by_key(|&i| keys[i..].iter().chain(&keys[..i]).copied().collect::<Vec<_>>()).unwrap();
                keys.rotate_left(best);
                keys
            })
            .collect();
        loops[1..].sort();
        assert!(out.faces.insert(*k, loops).is_none(), "two faces of one key");
    }
    for (b, w) in grid.cut_boxes.iter().zip(grid.box_cells.windows(2)) {
        for c in (w[0]..w[1]).map(CellId) {
            let mut faces: Vec<(Key, bool)> =
                grid.cell_faces(c).iter().map(|h| (face_keys[h.face().at()], h.front())).collect();
            faces.sort_unstable();
            out.cells.push((global(grid.lattice.box_at(*b)), faces));
        }
    }
    for (b, &f) in grid.flags.iter().enumerate() {
        out.flags.insert(global(grid.lattice.box_at(lapidary::base::BoxId::of(b))), f);
    }
    for (i, cells) in grid.square_cells.iter().enumerate() {
        // The block's faces towards other blocks or the end of the grid.
        let inner = cells.iter().all(|c| c.is_some() || *c == FULL_CELL);
        if !inner {
            out.shared.push(face_keys[grid.wall_count() + i]);
        }
    }
    out
}

/// The triangles that meet a closed box (their bounding boxes do: more is allowed), as a patch, with their ids in the whole.
fn patch(mesh: &TriMesh, l: &Lattice) -> (Arc<TriMesh>, Vec<i64>) {
    let mut ids = Vec::new();
    let mut number = vec![-1i32; mesh.vertices.len()];
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let x = corners.map(|v| mesh.vertices[v.at()]);
        let meets = (0..3).all(|a| {
            let (low, high) = (l.nodes[a][0], *l.nodes[a].last().unwrap());
            x.iter().any(|p| p[a] >= low) && x.iter().any(|p| p[a] <= high)
        });
        if meets {
            ids.push(t as i64);
            triangles.push(corners.map(|v| {
                if number[v.at()] < 0 {
                    number[v.at()] = vertices.len() as i32;
                    vertices.push(mesh.vertices[v.at()]);
                }
                number[v.at()]
            }));
        }
    }
    let input = MeshInput { vertices: &vertices, triangles: &triangles, tags: None };
    (Arc::new(build_patch(&input, &MeshOptions::default(), &mut Run::quiet()).expect("a patch")), ids)
}

fn blocks_agree(name: &str, mesh: &Arc<TriMesh>, nodes: &[Vec<f64>; 3], whole: &GridCells, outside: bool) {
    let counts: [usize; 3] = std::array::from_fn(|a| nodes[a].len() - 1);
    let one = parts(whole, None);
    let mut cells = Vec::new();
    let mut flags = BTreeMap::new();
    let mut vertices: BTreeMap<Key, [u64; 3]> = BTreeMap::new();
    let mut faces: BTreeMap<Key, (usize, Vec<Vec<Key>>)> = BTreeMap::new();
    let half = [counts[0] / 2, counts[1] / 3];
    for (b, block) in [[0, 0], [1, 0], [0, 1], [1, 1]].into_iter().enumerate() {
        let low = [block[0] * half[0], block[1] * half[1], 0];
        let high = [
            if block[0] == 0 { half[0] } else { counts[0] },
            if block[1] == 0 { half[1] } else { counts[1] },
            counts[2],
        ];
        let l = lattice(nodes, low, high);
        // One block in two gets only its own triangles.
        let (mesh, ids, known) = if b % 2 == 0 {
            (mesh.clone(), None, None)
        } else {
            let (patch, ids) = patch(mesh, &l);
            // The mesh is in the interior of the grid: the corner of the whole grid in this block is outside of it.
            let corner = [block[0] * (high[0] - low[0]), block[1] * (high[1] - low[1]), 0];
            (patch, Some(ids), Some((corner, outside)))
        };
        let options = GridOptions { outside, known };
        let grid = cut_grid(&mesh, l, &options, &mut Run::quiet()).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(grid.check(), Ok(()), "{name}");
        let own = parts(&grid, ids.as_deref());
        cells.extend(own.cells);
        flags.extend(own.flags);
        for (k, x) in own.vertices {
            let known = *vertices.entry(k).or_insert(x);
            assert_eq!(known, x, "{name}: two blocks round a vertex differently");
        }
        for (k, loops) in own.faces {
            let entry = faces.entry(k).or_insert((0, loops.clone()));
            entry.0 += 1;
            assert_eq!(entry.1, loops, "{name}: two blocks have different faces of one key");
        }
    }
    cells.sort();
    let mut expected = one.cells;
    expected.sort();
    assert!(cells == expected, "{name}: the blocks' cells are not those of the whole");
    assert!(flags == one.flags, "{name}: the blocks' flags are not those of the whole");
    assert!(vertices == one.vertices, "{name}: the blocks' vertices are not those of the whole");
    let united: BTreeMap<Key, Vec<Vec<Key>>> = faces.iter().map(|(k, f)| (*k, f.1.clone())).collect();
    assert!(united == one.faces, "{name}: the blocks' faces are not those of the whole");
    assert!(one.shared.iter().all(|k| faces[k].0 == 1), "{name}: a face at the end of the grid is in two blocks");
}

fn model(name: &str, soup: &Soup, mesh: &Arc<TriMesh>, count: usize, seed: u64) {
    let nodes = nodes(mesh, count, &mut Random(seed));
    let counts = [nodes[0].len() - 1, nodes[1].len() - 1, nodes[2].len() - 1];
    let l = lattice(&nodes, [0; 3], counts);
    let solid = solid6(mesh);
    let domain = {
        let (low, high) = ([0, 1, 2].map(|a| nodes[a][0]), [0, 1, 2].map(|a| *nodes[a].last().unwrap()));
        let side = |a: usize| Residue::from_f64(high[a]) - Residue::from_f64(low[a]);
        Residue::from_i64(6) * side(0) * side(1) * side(2)
    };
    for outside in [false, true] {
        let what = format!("{name} on {counts:?}{}", if outside { ", outside" } else { "" });
        let options = GridOptions { outside, known: None };
        let grid = cut_grid(mesh, l.clone(), &options, &mut Run::quiet()).unwrap_or_else(|e| panic!("{what}: {e}"));
        let volume = invariants(&what, &grid);
        let expected = if outside { domain - solid } else { solid };
        assert!(volume == expected, "{what}: the volumes do not add up");
        // The outside takes as long again; one side per model suffices for the blocks.
        if outside == (soup.triangles.len().is_multiple_of(2)) {
            blocks_agree(&what, mesh, &nodes, &grid, outside);
        }
    }
}

#[test]
fn models_on_grids_through_their_vertices() {
    let everything = std::env::var_os("LAPIDARY_LONG").is_some();
    let mut done = 0;
    each_model_or_all("LAPIDARY_LONG", 1500, |name, soup, mesh| {
        for count in [16, 64] {
            if everything || count == 16 || soup.triangles.len() < 800 {
                model(name, soup, &mesh, count, 7 * count as u64 + soup.triangles.len() as u64);
                done += 1;
            }
        }
    });
    println!("{done} grids");
}

#[test]
fn a_box_with_walls_on_grid_planes() {
    // Every wall, edge and corner of the bodies lies on grid planes; the block boundaries run through them.
    let soup = together(&[
        cuboid([1.0, 1.0, 1.0], [4.0, 3.0, 3.0]),
        cuboid([5.0, 1.0, 1.0], [6.0, 2.0, 2.0]),
        cuboid([2.0, 5.0, 2.0], [3.0, 6.0, 4.0]),
    ]);
    let mesh = Arc::new(common::build_soup(&soup, MeshOptions::default()).unwrap());
    let nodes: [Vec<f64>; 3] = std::array::from_fn(|_| (0..9).map(f64::from).collect());
    let l = lattice(&nodes, [0; 3], [8; 3]);
    for outside in [false, true] {
        let options = GridOptions { outside, known: None };
        let grid = cut_grid(&mesh, l.clone(), &options, &mut Run::quiet()).unwrap();
        let volume = invariants("walls on planes", &grid);
        let expected = Residue::from_i64(6) * Residue::from_i64(if outside { 512 - 15 } else { 15 });
        assert!(volume == expected);
        blocks_agree("walls on planes", &mesh, &nodes, &grid, outside);
    }
}

#[test]
fn a_patch_without_a_triangle_names_the_open_edge() {
    let mut soup = cuboid([1.0; 3], [2.0; 3]);
    soup.triangles.remove(5);
    let input = MeshInput { vertices: &soup.vertices, triangles: &soup.triangles, tags: None };
    let mesh = Arc::new(build_patch(&input, &MeshOptions::default(), &mut Run::quiet()).unwrap());
    let nodes: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0, 1.5, 3.0]);
    let options = GridOptions { outside: true, known: Some(([0; 3], true)) };
    let error = cut_grid(&mesh, lattice(&nodes, [0; 3], [2; 3]), &options, &mut Run::quiet()).unwrap_err();
    assert_eq!(error.status, lapidary::base::Status::BadMesh);
    assert_eq!(error.culprits[0].kind, lapidary::base::DefectKind::OpenEdge);
    // No triangle at all, and a block beyond the hole, are no error.
    let nothing = MeshInput { vertices: &[], triangles: &[], tags: None };
    let mesh = Arc::new(build_patch(&nothing, &MeshOptions::default(), &mut Run::quiet()).unwrap());
    for inside in [false, true] {
        let options = GridOptions { outside: false, known: Some(([1; 3], inside)) };
        let grid = cut_grid(&mesh, lattice(&nodes, [0; 3], [2; 3]), &options, &mut Run::quiet()).unwrap();
        assert!(grid.flags.iter().all(|&f| (f == FULL) == inside));
    }
}

//! Cells of arrangements as cells of a complex: all checks, exact volumes, moments, face styles; on cubes in every position, grids of cubes, real models.

use lapidary::arrangement::solids::{Solids, every_cell, joined_cells, solids};
use lapidary::arrangement::volumes::{cell_volumes, volume};
use lapidary::arrangement::{Arrangement, ArrangementOptions, Operand, Selection, arrange, choose, extract};
use lapidary::base::{CellId, Run, Status};
use lapidary::complex::exact_values::cell_volume;
use lapidary::complex::keys::{names, vertex_keys};
use lapidary::complex::{
    CertifyOptions, FaceStyle, GlobalIds, Key, SupportId, certify, check, check_volumes, euler, faces_as, moments,
};
use lapidary::exact::round_rational;
use rug::Rational;
use std::collections::BTreeMap;

#[path = "common/mod.rs"]
mod common;
#[path = "common/grid_cubes.rs"]
mod grid_cubes;
use common::random::Random;
use grid_cubes::{GridCubes, operands};

type Arrays = (Vec<[f64; 3]>, Vec<[i32; 3]>);

fn arranged(meshes: &[Arrays]) -> Arrangement {
    let operands: Vec<Operand> = meshes.iter().map(|(vertices, triangles)| Operand { vertices, triangles }).collect();
    arrange(&operands, &ArrangementOptions::default(), &mut Run::quiet()).unwrap()
}

fn made(a: &Arrangement) -> Solids {
    let s = solids(a, &every_cell(a), &mut Run::quiet()).unwrap();
    s.check(a).unwrap();
    s
}

/// Everything that a complex promises, and the arrangement's own volumes.
fn assert_whole(a: &Arrangement, what: &str) -> Solids {
    let s = made(a);
    let c = &s.complex;
    check(c).unwrap_or_else(|e| panic!("{what}: {e}"));
    check_volumes(c).unwrap_or_else(|e| panic!("{what}: {e}"));
    lapidary::complex::check::check_exact(c).unwrap_or_else(|e| panic!("{what}: {e}"));
    let volumes = cell_volumes(a);
    assert_eq!(c.cell_count() + 1, volumes.len(), "{what}");
    let rounded = moments(c);
    for (k, expected) in volumes[1..].iter().enumerate() {
        assert_eq!(cell_volume(c, CellId::of(k)), *expected, "{what}: cell {k}");
        assert_eq!(rounded.cell_volume[k].to_bits(), round_rational(expected).to_bits(), "{what}: cell {k}");
    }
    // Every face that divides is in one face of the complex, on its sides.
    let mut seen = vec![false; a.face_count()];
    for (f, row) in s.faces.rows().enumerate() {
        for &g in row {
            assert!(!std::mem::replace(&mut seen[g.at()], true), "{what}: face {} twice", g.0);
            let cells = a.face_cells(g).map(|c| if c.0 == 0 { CellId::NONE } else { CellId(c.0 - 1) });
            assert_eq!(c.face_cells[f], cells, "{what}: face {f}");
        }
    }
    for (f, seen) in seen.iter().enumerate() {
        assert_eq!(*seen, a.cells.patch[f].is_some(), "{what}: face {f}");
    }
    // Each style has all faces, the triangulated one as many triangles as loops and corners say.
    for style in [FaceStyle::Holes, FaceStyle::Bridged, FaceStyle::Triangulated] {
        let made = faces_as(c, style).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert!((0..c.face_count()).all(|f| made.source_face.contains(&lapidary::base::FaceId::of(f))), "{what}");
    }
    s
}

/// A box with one diagonal a side.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> Arrays {
    let corner = |i: usize| [0, 1, 2].map(|a| if i >> a & 1 == 0 { low[a] } else { high[a] });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

fn unit(x: f64, y: f64, z: f64) -> Arrays {
    cuboid([x, y, z], [x + 1.0, y + 1.0, z + 1.0])
}

#[test]
fn a_cube() {
    let a = arranged(&[unit(0.0, 0.0, 0.0)]);
    let s = assert_whole(&a, "cube");
    let c = &s.complex;
    assert_eq!((c.vertex_count(), c.edge_count(), c.face_count(), c.cell_count()), (8, 18, 12, 1));
    assert_eq!(euler(c), Ok(1));
    let m = moments(c);
    assert_eq!((m.cell_volume[0], m.cell_centroid[0]), (1.0, [0.5; 3]));
    assert_eq!(m.face_area_vector[0], [0.0, 0.0, -0.5]);
    assert_eq!(c.cell_component[0].0, 0);
}

#[test]
fn cubes_in_every_position() {
    for (x, y, z, cells) in [
        (0.5, 0.25, 0.0, 3),
        (0.5, 0.25, 0.125, 3),
        (1.0, 0.0, 0.0, 2),
        (1.0, 0.5, 0.25, 2),
        (1.0, 1.0, 0.0, 2),
        (1.0, 1.0, 1.0, 2),
        (0.0, 0.0, 0.0, 1),
        (3.0, 0.0, 0.0, 2),
    ] {
        let what = format!("shift {x} {y} {z}");
        let meshes = [unit(0.0, 0.0, 0.0), unit(x, y, z)];
        let a = arranged(&meshes);
        let s = assert_whole(&a, &what);
        assert_eq!(s.complex.cell_count(), cells, "{what}");
        // The same with the second one inside out: faces without a cell behind them.
        let mut turned = meshes.clone();
        turned[1].1.iter_mut().for_each(|t| t.swap(1, 2));
        let b = arranged(&turned);
        let t = assert_whole(&b, &what);
        assert_eq!(t.complex.cell_count(), cells, "{what}");
        if cells == 2 && x == 3.0 {
            assert!(t.complex.face_cells.iter().any(|c| c[0].is_none()));
        }
    }
}

#[test]
fn holes_slits_and_isolated_vertices() {
    // A small cube on the middle of a large one's side: a hole, and a face between them.
    let big = cuboid([0.0; 3], [4.0; 3]);
    let a = arranged(&[big.clone(), cuboid([1.0, 0.25, 4.0], [1.5, 0.75, 5.0])]);
    let s = assert_whole(&a, "on top");
    let holes = |s: &Solids| s.complex.face_loops.windows(2).map(|w| w[1] - w[0] - 1).sum::<u32>();
    assert_eq!(holes(&s), 1);
    // Within, not touching: the outer cell has a void.
    let a = arranged(&[big.clone(), cuboid([1.0; 3], [2.0; 3])]);
    let s = assert_whole(&a, "void");
    assert_eq!((s.complex.cell_count(), s.complex.shell_faces.len(), euler(&s.complex)), (2, 3, Ok(1)));
    assert!(s.complex.cell_shells.windows(2).any(|w| w[1] - w[0] == 2));
    // A tip that touches a side from outside, and one from inside.
    for (z, what) in [(1.0, "outside"), (-1.0, "inside")] {
        let tip = (
            vec![[1.0, 0.5, 4.0], [1.5, 0.5, 4.0 + z], [1.0, 1.0, 4.0 + z], [0.75, 0.25, 4.0 + z]],
            vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]],
        );
        let mut tip: Arrays = tip;
        if z > 0.0 {
            tip.1.iter_mut().for_each(|t| t.swap(1, 2));
        }
        let a = arranged(&[big.clone(), tip]);
        let s = assert_whole(&a, what);
        assert_eq!(holes(&s), 1, "{what}");
        let c = &s.complex;
        let lone = (0..c.loop_offsets.len() - 1).find(|&l| c.loop_offsets[l + 1] - c.loop_offsets[l] == 1).unwrap();
        assert_eq!(c.coords[c.corner_vertices[c.loop_offsets[lone] as usize].at()], [1.0, 0.5, 4.0], "{what}");
    }
    // An edge that lies in a side: the face has it on both its sides.
    let roof = (
        vec![[0.5, 0.25, 4.0], [1.5, 1.25, 4.0], [0.5, 1.25, 5.0], [1.5, 0.25, 5.0]],
        vec![[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]],
    );
    let mut roof: Arrays = roof;
    let a = arranged(&[big.clone(), roof.clone()]);
    roof.1.iter_mut().for_each(|t| t.swap(1, 2));
    for a in [a, arranged(&[big, roof])] {
        let s = assert_whole(&a, "roof");
        let c = &s.complex;
        let f = (0..c.face_count()).find(|&f| c.face_loops[f + 1] - c.face_loops[f] == 2).unwrap();
        let hole = c.face_loops[f] as usize + 1;
        assert_eq!(c.loop_offsets[hole + 1] - c.loop_offsets[hole], 2);
    }
}

#[test]
fn faces_do_not_depend_on_their_triangulation() {
    // Operands in another order, and triangles from another corner on: other ids, the same faces up to names.
    let [x, y, z] = [unit(0.0, 0.0, 0.0), unit(0.5, 0.25, 0.125), cuboid([-0.25, 0.25, 0.5], [2.0, 0.75, 0.625])];
    let mut w = [z.clone(), y.clone(), x.clone()];
    w.iter_mut().flat_map(|m| &mut m.1).for_each(|t| t.rotate_left(1));
    let [a, b] = [arranged(&[x, y, z]), arranged(&w)].map(|a| assert_whole(&a, "order").complex);
    let counts = |c: &lapidary::complex::Complex| (c.vertex_count(), c.edge_count(), c.face_count(), c.cell_count());
    assert_eq!(counts(&a), counts(&b));
    let polygons = |c: &lapidary::complex::Complex| {
        let corners = |f: usize| {
            let mut all: Vec<[u64; 3]> = c
                .face_corners(lapidary::base::FaceId::of(f))
                .map(|k| c.coords[c.corner_vertices[k].at()].map(f64::to_bits))
                .collect();
            all.sort_unstable();
            all
        };
        let mut all: Vec<_> = (0..c.face_count()).map(corners).collect();
        all.sort_unstable();
        all
    };
    assert_eq!(polygons(&a), polygons(&b));
    // Whole and cut triangles alike lie on triangles.
    assert!(a.face_support.iter().all(|s| matches!(s, SupportId::Triangle(_))));
    // No two vertices have one key.
    let ids = GlobalIds::default();
    let mut keys = vertex_keys(&a, &names(&a.mesh, &a.planes, &ids).unwrap());
    keys.sort_unstable();
    assert!(keys.windows(2).all(|w| w[0] != w[1]));
}

#[test]
fn vertices_that_arrangements_share_have_one_key() {
    // The same two cubes with a third one that touches one of them elsewhere, and global ids that do not rise with positions.
    let [x, y, z] = [unit(0.0, 0.0, 0.0), unit(0.5, 0.25, 0.125), cuboid([-1.0, -1.0, -1.0], [0.25, 0.25, 0.25])];
    let keys = |a: &Arrangement, ids: &dyn Fn(usize) -> i64| {
        let c = made(a).complex;
        let ids: Vec<i64> = (0..c.mesh.triangles.len()).map(ids).collect();
        let ids = GlobalIds { triangles: Some(&ids), ..GlobalIds::default() };
        let keys = vertex_keys(&c, &names(&c.mesh, &c.planes, &ids).unwrap());
        c.coords.iter().map(|x| x.map(f64::to_bits)).zip(keys).collect::<BTreeMap<[u64; 3], Key>>()
    };
    let number = |i: usize| [200, 100, 300][i / 12] + (i % 12) as i64;
    let two = keys(&arranged(&[x.clone(), y.clone()]), &number);
    let three = keys(&arranged(&[z, x, y]), &|i| number((i + 24) % 36));
    let mut all: Vec<Key> = three.values().copied().collect();
    all.sort_unstable();
    assert!(all.windows(2).all(|w| w[0] != w[1]));
    let shared = two.iter().filter(|(x, key)| three.get(*x).is_some_and(|k| k == *key)).count();
    // All but what the third cube swallows or names anew.
    let expected = two.keys().filter(|x| three.contains_key(*x)).count();
    assert!(shared == expected && shared > 15, "{shared} of {expected}, {} in all", two.len());
}

#[test]
fn cubes_of_a_grid() {
    let mut random = Random(7);
    let mut cells = 0;
    for round in 0..200 {
        let n = 1 + random.below(3) as usize;
        let g = GridCubes::random(&mut random, n, 1 + (round % 4), 50, &[-1, 1, 1, 2]);
        let map = if round % 2 == 0 {
            [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]
        } else {
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        };
        let meshes = g.meshes(map);
        let a = arrange(&operands(&meshes), &ArrangementOptions::default(), &mut Run::quiet()).unwrap();
        let what = format!("round {round}");
        let s = assert_whole(&a, &what);
        cells += s.complex.cell_count();
        // What is inside something, as one solid.
        let inside = choose(&a, Selection::Union).unwrap();
        let joined = solids(&a, &joined_cells(&a, &inside), &mut Run::quiet()).unwrap();
        joined.check(&a).unwrap();
        check_volumes(&joined.complex).unwrap();
        let sum: Rational = (0..joined.complex.cell_count()).map(|k| cell_volume(&joined.complex, CellId::of(k))).sum();
        assert_eq!(sum, volume(&a, &extract(&a, &inside).unwrap()), "{what}");
        assert!(joined.complex.face_cells.iter().all(|c| c[0].is_none() != c[1].is_none()), "{what}");
    }
    assert!(cells > 500, "{cells} cells");
}

#[test]
fn random_triangles() {
    // Tetrahedra on small integer points: everything is degenerate.
    let mut random = Random(11);
    for round in 0..300 {
        let size = 2 + random.below(4);
        let meshes: Vec<Arrays> = (0..1 + random.below(4))
            .map(|_| {
                let point = |r: &mut Random| [0; 3].map(|_| r.below(size + 1) as f64);
                let points = (0..4).map(|_| point(&mut random)).collect();
                (points, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
            })
            .collect();
        assert_whole(&arranged(&meshes), &format!("round {round}"));
    }
}

#[test]
fn certified() {
    let a = arranged(&[unit(0.0, 0.0, 0.0), cuboid([0.1, 0.2, 0.3], [1.1, 1.3, 1.7])]);
    let s = made(&a);
    let c = certify(&s.complex, &CertifyOptions::default(), &mut Run::quiet()).unwrap();
    assert!(c.report.certified);
    assert_eq!(c.cell_count, 3);
}

#[test]
fn bad_tables() {
    let a = arranged(&[unit(0.0, 0.0, 0.0)]);
    for table in [vec![CellId::NONE], vec![CellId(0), CellId(0)]] {
        let e = solids(&a, &table, &mut Run::quiet()).unwrap_err();
        assert_eq!(e.status, Status::BadArgument);
    }
    let nothing = arranged(&[]);
    assert_eq!(made(&nothing).complex.cell_count(), 0);
}

//! Meshes that overlap themselves: CGAL's models that intersect themselves, spheres merged into one mesh, and surfaces wound around more than once.

use lapidary::arrangement::volumes::{cell_volumes, six_volume_residue, volume};
use lapidary::arrangement::{Arrangement, Selection};
use lapidary::base::CellId;
use rug::Rational;
use std::collections::BTreeSet;
use std::time::Instant;

#[path = "common/mod.rs"]
mod common;
#[path = "common/solid_oracle.rs"]
mod solid_oracle;
use common::random::Random;
use common::shapes::{geodesic, grid_cube, moved, rotation, shifted};
use common::{Soup, cgal_meshes, flipped, read_off, together};
use solid_oracle::{arranged, assert_solid, dense, extracted, signed_volume};

/// The volumes of cells that the mesh winds around in the positive sense, of all as often as it does.
fn wound_around(a: &Arrangement) -> [Rational; 2] {
    let (mut inside, mut sum) = (Rational::new(), Rational::new());
    for (c, v) in cell_volumes(a).into_iter().enumerate() {
        assert!((c == 0) == (v == 0) && v >= 0, "cell {c} has the volume {v}");
        let w: i32 = a.winding(CellId::of(c)).iter().map(|w| w.1).sum();
        if w > 0 {
            inside += &v;
        }
        sum += v * w;
    }
    [inside, sum]
}

/// Resolves one mesh: solid, and its volume that of the cells inside. Returns it and the winding numbers that there are.
fn resolved(s: &Soup, what: &str) -> (Rational, BTreeSet<i32>) {
    let started = Instant::now();
    let a = arranged(&[s]);
    let made = started.elapsed();
    let e = extracted(&a, Selection::Resolve);
    assert_solid(&a, &e, what);
    let v = volume(&a, &e);
    assert_eq!(wound_around(&a), [v.clone(), signed_volume(s)], "{what}");
    // Of one operand the union is the same.
    assert_eq!(extracted(&a, Selection::Union), e, "{what}");
    let windings: BTreeSet<i32> = (0..a.cell_count()).map(|c| dense(&a, c)[0]).collect();
    println!(
        "{what}: {} triangles, {} pairs that meet, {} cells, winding numbers {windings:?}, {} triangles resolved; {made:?}, in all {:?}",
        s.triangles.len(),
        a.resolved.pair_count,
        a.cell_count(),
        e.triangles.len(),
        started.elapsed()
    );
    (v, windings)
}

/// Resolving what was resolved changes nothing, where all corners are doubles or were rounded without coming to meet: here only that a model is
/// solid, and that its winding numbers are whole is checked in the library, patch by patch.
#[test]
fn models_that_intersect_themselves() {
    let Some(folder) = cgal_meshes() else { return };
    let mut found = 0;
    for name in ["bones", "bull", "camel", "cow", "elk", "man"] {
        let path = folder.join(format!("{name}.off"));
        let Ok(s) = read_off(&path) else {
            println!("skipped: {} cannot be read", path.display());
            continue;
        };
        found += 1;
        let (v, windings) = resolved(&s, name);
        assert!(v > 0 && windings.contains(&0) && windings.contains(&1), "{name}");
        // Turned inside out the numbers change their signs, and what was wound around the other way is inside.
        let a = arranged(&[&flipped(s.clone())]);
        let e = extracted(&a, Selection::Resolve);
        let back: BTreeSet<i32> = (0..a.cell_count()).map(|c| -dense(&a, c)[0]).collect();
        assert_eq!(back, windings, "{name}");
        let negative: Rational =
            cell_volumes(&a).into_iter().enumerate().filter(|(c, _)| dense(&a, *c)[0] > 0).map(|c| c.1).sum();
        assert_eq!(volume(&a, &e), negative, "{name}");
        assert_eq!(wound_around(&a)[1], -signed_volume(&s), "{name}");
    }
    println!("{found} models");
    assert!(found == 6 || !folder.join("bones.off").exists());
}

/// In random rotation, with random exact centres, so close that some points are in many.
fn spheres(count: usize, n: i32, random: &mut Random) -> Vec<Soup> {
    let ball = geodesic(n);
    let place = |random: &mut Random| std::array::from_fn(|_| random.signed());
    (0..count).map(|_| moved(&ball, rotation(random), 1.0, place(random))).collect()
}

/// 80 000 triangles.
#[test]
fn ten_spheres_in_one_mesh() {
    let all = spheres(10, 20, &mut Random(10));
    let merged = together(&all);
    assert_eq!(merged.triangles.len(), 80_000);
    let started = Instant::now();
    let one = arranged(&[&merged]);
    let resolve = extracted(&one, Selection::Resolve);
    println!("one mesh: {} cells; {:?}", one.cell_count(), started.elapsed());
    let each = arranged(&all.iter().collect::<Vec<_>>());
    let union = extracted(&each, Selection::Union);
    println!("ten: {} cells; {:?}", each.cell_count(), started.elapsed());
    assert_eq!((one.cell_count(), one.face_count()), (each.cell_count(), each.face_count()));
    // The same triangles on the same corners; only who they come from has other names.
    assert_eq!((&resolve.coords, &resolve.triangles), (&union.coords, &union.triangles));
    for (&v, &w) in resolve.vertices.iter().zip(&union.vertices) {
        assert_eq!(one.origin(v), each.origin(w));
    }
    let residue = six_volume_residue(&one, &resolve);
    assert!(residue.is_some() && residue == six_volume_residue(&each, &union));
    // Cell by cell: wound around as often as there are spheres around it.
    let mut most = 0;
    for c in 0..one.cell_count() {
        let vector = dense(&each, c);
        assert!(vector.iter().all(|w| (0..=1).contains(w)));
        assert_eq!(dense(&one, c), [vector.iter().sum::<i32>()]);
        most = most.max(vector.iter().sum());
    }
    assert!(most >= 4, "{most}");
    // At least two of the ten: what is wound around more than once.
    let table: Vec<bool> = (0..one.cell_count()).map(|c| dense(&one, c)[0] >= 2).collect();
    let twice = extracted(&one, Selection::Table(&table));
    let expected = extracted(&each, Selection::AtLeast(2));
    assert_eq!((&twice.coords, &twice.triangles), (&expected.coords, &expected.triangles));
    assert_solid(&one, &resolve, "ten spheres");
    println!("solid; {:?}", started.elapsed());
}

/// The same with exact volumes, on fewer triangles.
#[test]
fn ten_coarse_spheres_in_one_mesh() {
    let all = spheres(10, 4, &mut Random(11));
    let (v, windings) = resolved(&together(&all), "ten coarse spheres");
    let each = arranged(&all.iter().collect::<Vec<_>>());
    assert_eq!(volume(&each, &extracted(&each, Selection::Union)), v);
    assert!(windings.contains(&4), "{windings:?}");
}

#[test]
fn wound_around_twice() {
    let a = grid_cube(30, [0.0; 3], 1.0);
    let both = together(&[a.clone(), shifted(&a, [0.5, 0.25, 0.0])]);
    let (v, windings) = resolved(&both, "two cubes in one mesh");
    assert_eq!((v, windings), (Rational::from((2_767_125, 100)), BTreeSet::from([0, 1, 2])));
    let all = arranged(&[&both]);
    let mut cells: Vec<(i32, Rational)> =
        cell_volumes(&all).into_iter().enumerate().map(|(c, v)| (dense(&all, c)[0], v)).collect();
    cells.sort();
    // Two corners that touch nowhere, and what both have.
    let some = Rational::from((67_125, 100));
    let expected = [(0, Rational::new()), (1, some.clone()), (1, some.clone()), (2, Rational::from(27_000) - some)];
    assert_eq!(cells, expected);
    // One turned inside out: the numbers are 1, -1 and 0, and the part in common is outside.
    let both = together(&[a.clone(), flipped(shifted(&a, [0.5, 0.25, 0.0]))]);
    let (v, windings) = resolved(&both, "one inside the other, turned");
    assert_eq!((v, windings), (Rational::from((67_125, 100)), BTreeSet::from([-1, 0, 1])));
}

/// A closed tube along a ring of corners, square in section, with corners that are multiples of 2⁻¹⁶.
fn tube(ring: &[[f64; 3]], half: f64) -> Soup {
    let n = ring.len();
    let snap = |x: f64| (x * 65_536.0).round() / 65_536.0;
    let mut s = Soup::default();
    for i in 0..n {
        let (p, q) = (ring[(i + n - 1) % n], ring[(i + 1) % n]);
        let d: [f64; 3] = std::array::from_fn(|k| q[k] - p[k]);
        // Across the way, level, and upward.
        let length = d[0].hypot(d[1]);
        let side = [-d[1] / length * half, d[0] / length * half];
        for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            s.vertices.push([ring[i][0] + a * side[0], ring[i][1] + a * side[1], ring[i][2] + b * half].map(snap));
        }
    }
    for i in 0..n {
        for k in 0..4 {
            let at = |i: usize, k: usize| (4 * (i % n) + k % 4) as i32;
            let [a, b, c, d] = [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)];
            s.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    s
}

/// A ring that goes round two and five times before it closes, through itself.
#[test]
fn a_ring_through_itself() {
    for (turns, n) in [(2, 61), (5, 173)] {
        let ring: Vec<[f64; 3]> = (0..n)
            .map(|i| {
                let t = std::f64::consts::TAU * f64::from(i) / f64::from(n);
                let (t, r) = (t * f64::from(turns), 3.0 + 0.4 * t.cos());
                [r * t.cos(), r * t.sin(), 0.3 * (t / f64::from(turns)).sin()]
            })
            .collect();
        let s = tube(&ring, 0.5);
        assert!(signed_volume(&s) > 0);
        let (v, windings) = resolved(&s, &format!("{turns} times round"));
        assert!(v < signed_volume(&s) && windings.contains(&2), "{windings:?}");
    }
}

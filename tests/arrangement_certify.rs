//! Booleans on certified doubles.

use lapidary::arrangement::certify::{CertifiedSurface, CertifyOptions, certify};
use lapidary::arrangement::{ArrangementOptions, Operand, Selection, arrange, choose, extract};
use lapidary::base::{Run, TriangleId, VertexId};
use lapidary::mesh::self_intersection::contact;
use std::time::Instant;

#[path = "common/mod.rs"]
mod common;
use common::random::Random;
use common::shapes::{geodesic, grid_cube, moved, rotation, shifted};
use common::{Soup, build_soup, cgal_meshes, checking, read_off};

fn boolean(operands: &[&Soup], selection: Selection) -> CertifiedSurface {
    let mut run = Run::quiet();
    let all: Vec<Operand> =
        operands.iter().map(|s| Operand { vertices: &s.vertices, triangles: &s.triangles }).collect();
    let a = arrange(&all, &ArrangementOptions {}, &mut run).unwrap();
    let e = extract(&a, &choose(&a, selection).unwrap()).unwrap();
    certify(&e, &CertifyOptions::default(), &mut run).unwrap()
}

fn soup(c: &CertifiedSurface) -> Soup {
    Soup { vertices: c.coords.clone(), triangles: c.triangles.clone() }
}

fn show(what: &str, c: &CertifiedSurface, started: Instant) {
    let r = &c.report;
    println!(
        "{what}: certified {}, {} -> {} triangles, {} moved by {:.3e} at most, {} merged, {} thin, {} snapped, {} remain; {:?}",
        r.certified,
        r.triangles_before,
        r.triangles_after,
        r.moved,
        r.largest_move,
        r.merged,
        r.thin_cells,
        r.snapped,
        r.remaining.len(),
        started.elapsed()
    );
    r.rounds.iter().for_each(|x| println!("   {x:?}"));
}

/// Half a cell apart in planes that are nearly the same.
fn nearly_coplanar(n: i32, turn: [[f64; 3]; 3]) -> [Soup; 2] {
    let a = grid_cube(n, [0.0; 3], 1.0);
    [moved(&a, turn, 1.0, [0.0; 3]), moved(&shifted(&a, [0.5, 0.25, 0.0]), turn, 1.0, [0.0; 3])]
}

/// By means that know nothing of arrangements: each place once, no two triangles in contact, valid nesting of shells.
fn assert_solid(c: &CertifiedSurface, what: &str) {
    let r = &c.report;
    assert!(r.certified && r.remaining.is_empty(), "{what}: {r:?}");
    assert_eq!((c.births.len(), c.flipped.len()), (c.triangles.len(), c.triangles.len()), "{what}");
    assert_eq!(r.triangles_after, c.triangles.len(), "{what}");
    if !c.triangles.is_empty() {
        build_soup(&soup(c), checking()).unwrap_or_else(|e| panic!("{what}: {e:?}"));
    }
}

/// Certified, or the report lists what an independent search finds.
fn assert_honest(c: &CertifiedSurface, what: &str) {
    if c.report.certified {
        return assert_solid(c, what);
    }
    let triangles: Vec<[VertexId; 3]> = c.triangles.iter().map(|t| t.map(|v| VertexId(v as u32))).collect();
    let open: Vec<[TriangleId; 2]> = c.report.remaining.iter().copied().filter(|p| p[0] != p[1]).collect();
    assert!(!open.is_empty(), "{what}: nothing remains, but it is not certified");
    for p in &open {
        assert!(contact(&c.coords, &triangles[p[0].at()], &triangles[p[1].at()]), "{what}: {p:?}");
    }
    let most = 1.max(CertifyOptions::default().growth) * c.report.triangles_before.max(16);
    assert!(c.triangles.len() <= most, "{what}");
}

fn pair(n: i32, random: &mut Random) -> [Soup; 2] {
    nearly_coplanar(n, rotation(random))
}

#[test]
fn nearly_coplanar_grids() {
    let mut certified = [[0; 4]; 2];
    for n in [1, 2, 4, 10] {
        let mut random = Random(n as u64);
        for k in 0..3 {
            let [a, b] = pair(n, &mut random);
            let all =
                [Selection::Union, Selection::Intersection, Selection::Difference, Selection::SymmetricDifference];
            for (i, s) in all.into_iter().enumerate() {
                let started = Instant::now();
                let c = boolean(&[&a, &b], s);
                let what = format!("{n} squares a side, rotation {k}, selection {i}");
                show(&what, &c, started);
                if i < 2 {
                    assert_solid(&c, &what)
                } else {
                    assert_honest(&c, &what)
                }
                certified[0][i] += c.report.certified as usize;
                certified[1][i] += 1;
            }
        }
    }
    println!("certified {certified:?}");
    // How far differences and symmetric differences get: a step back shows here.
    assert!(certified[0][2] >= 4 && certified[0][3] >= 2, "{certified:?}");
}

#[test]
fn two_cubes() {
    let a = grid_cube(1, [0.0; 3], 1.0);
    let mut random = Random(5);
    for k in 0..50 {
        let b = moved(&a, rotation(&mut random), 1.0, [0.3, 0.2, 0.1]);
        for s in [Selection::Union, Selection::Intersection, Selection::Difference, Selection::SymmetricDifference] {
            assert_solid(&boolean(&[&a, &b], s), &format!("pair {k}"));
        }
    }
    // Exact from the start: nothing is rounded, nothing changes.
    let c = boolean(&[&a, &shifted(&a, [0.5, 0.25, 0.125])], Selection::Union);
    assert_solid(&c, "on the axes");
    assert_eq!((c.report.moved, c.report.merged, c.report.rounds.len()), (0, 0, 1));
    assert_eq!(c.report.triangles_after, c.report.triangles_before);
    // Nothing at all.
    let c = boolean(&[&a, &a], Selection::Difference);
    assert!(c.report.certified && c.triangles.is_empty());
}

/// Each result goes straight into the next.
#[test]
fn chains() {
    for seed in 0..10 {
        let mut random = Random(seed);
        let ball = geodesic(4);
        let mut solid = grid_cube(3, [-1.0; 3], 2.0 / 3.0);
        for step in 0..5 {
            let shift = std::array::from_fn(|_| random.signed());
            let other = moved(&ball, rotation(&mut random), 0.8, shift);
            let s = if step % 2 == 0 { Selection::Difference } else { Selection::Union };
            let c = boolean(&[&solid, &other], s);
            assert_solid(&c, &format!("chain {seed}, step {step}"));
            solid = soup(&c);
        }
    }
}

#[test]
fn bunnies() {
    let Some(meshes) = cgal_meshes() else { return };
    let Ok(a) = read_off(&meshes.join("bunny00.off")) else { return println!("skipped: no bunny00.off") };
    let size = a.vertices.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let b = moved(&a, rotation(&mut Random(7)), 1.0, [size / 5.0; 3]);
    for s in [Selection::Union, Selection::Difference] {
        let started = Instant::now();
        let c = boolean(&[&a, &b], s);
        show("bunnies", &c, started);
        assert_solid(&c, "bunnies");
    }
}

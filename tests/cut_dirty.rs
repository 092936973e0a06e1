//! Meshes that intersect themselves, with the exact check off: an error, or a complex that passes `check` and whose derived
//! values can be asked for. Never a panic. `LAPIDARY_FUZZ=n` runs n rounds of each.

mod common;
#[path = "common/solids.rs"]
mod solids;

use common::Soup;
use lapidary::base::{CellId, FaceId, Run, Status, VertexId};
use lapidary::complex::{
    Complex, FaceStyle, adjacency, check, check_volumes, euler, exact_values, faces_as, keys, moments, solid_euler,
};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::Plane;
use lapidary::mesh::{MeshInput, MeshOptions, build};
use solids::*;
use std::sync::Arc;

fn rounds(default: u64) -> u64 {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

/// Asks for everything that derives from a complex; results may be errors.
fn use_all(c: &Complex, exactly: bool) {
    let m = moments(c);
    assert_eq!((m.cell_volume.len(), m.face_flags.len()), (c.cell_count(), c.face_count()));
    let _ = (adjacency(c), euler(c), solid_euler(&c.mesh), check_volumes(c));
    let names = keys::names(&c.mesh, &c.planes, &Default::default()).unwrap();
    assert_eq!(keys::vertex_keys(c, &names).len(), c.vertex_count());
    assert!(keys::face_keys(c, &names).is_ok_and(|k| k.len() == c.face_count()));
    for style in [FaceStyle::Holes, FaceStyle::Bridged, FaceStyle::Triangulated] {
        if let Ok(rows) = faces_as(c, style) {
            assert!(rows.vertices.iter().all(|v| v.at() < c.vertex_count()));
        }
    }
    if exactly {
        (0..c.cell_count()).for_each(|k| drop(exact_values::cell_volume_string(c, CellId::of(k))));
        (0..c.face_count()).for_each(|f| drop(exact_values::face_values(c, FaceId::of(f))));
        (0..c.vertex_count()).for_each(|v| drop(exact_values::vertex_strings(c, VertexId::of(v))));
    }
}

#[derive(Default, Debug)]
struct Tally {
    meshes: usize,
    errors: usize,
    complexes: usize,
}

fn one(soup: &Soup, planes: &[Plane], exactly: bool, tally: &mut Tally) -> Result<(), String> {
    let input = MeshInput { vertices: &soup.vertices, triangles: &soup.triangles, tags: None };
    let mesh = match build(&input, &MeshOptions::default(), &mut Run::quiet()) {
        Ok(mesh) => Arc::new(mesh),
        Err(e) if matches!(e.status, Status::BadMesh | Status::Inconsistent) => return Ok(()),
        Err(e) => return Err(format!("{:?}: {}", e.status, e.message)),
    };
    mesh.check()?;
    tally.meshes += 1;
    match cut(&mesh, planes, &CutOptions::default(), &mut Run::quiet()) {
        Ok(result) => {
            tally.complexes += 1;
            check(&result.complex)?;
            use_all(&result.complex, exactly);
            Ok(())
        }
        Err(e) if e.status == Status::Inconsistent => {
            tally.errors += 1;
            Ok(())
        }
        Err(e) => Err(format!("{:?}: {}", e.status, e.message)),
    }
}

fn attack(seed: u64, count: u64, mut case: impl FnMut(&mut Random) -> (Soup, Vec<Plane>)) {
    let (mut failed, mut tally) = (Vec::new(), Tally::default());
    for round in 0..count {
        let (soup, planes) = case(&mut Random(seed.wrapping_mul(1 << 32).wrapping_add(round)));
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| one(&soup, &planes, true, &mut tally)));
        if let Err(message) = outcome.unwrap_or(Err("panic".into())) {
            failed.push(format!("round {round}: {message}\n{soup:?}\n{planes:?}"));
        }
    }
    println!("{tally:?}");
    assert!(failed.is_empty(), "{} of {count} failed:\n{}", failed.len(), failed[..failed.len().min(3)].join("\n\n"));
    assert!(tally.complexes > 0 && tally.meshes as u64 * 4 > count, "{tally:?} of {count}");
}

/// Vertices of cubes pulled to other places of the lattice.
#[test]
fn pulled_vertices() {
    attack(21, rounds(300), |r| {
        let (size, fill) = (1 + r.below(3) as i32, 20 + r.below(75));
        let mut s = voxels(r, size, fill);
        for _ in 0..1 + r.below(3) {
            let v = r.below(s.vertices.len() as u64) as usize;
            s.vertices[v] = [0; 3].map(|_| r.within(6) / 2.0);
        }
        let count = 1 + r.below(6) as usize;
        let p = planes(r, &s, count, true);
        (s, p)
    });
}

/// Several solids and voids in any position, equal ones too.
#[test]
fn overlapping_shells() {
    attack(22, rounds(300), |r| {
        let parts: Vec<Soup> = (0..2 + r.below(3))
            .map(|_| {
                let mut s = if r.below(2) == 0 { star(0, || (1 + r.below(3)) as f64) } else { common::cube(-1.0, 1.0) };
                let shift = [0; 3].map(|_| r.within(2));
                s.vertices.iter_mut().for_each(|x| (0..3).for_each(|i| x[i] += shift[i]));
                if r.below(4) == 0 { common::flipped(s) } else { s }
            })
            .collect();
        let mut s = common::together(&parts);
        // Half of the time one solid where vertices coincide.
        if r.below(2) == 0 {
            let first = |x: &[f64; 3]| s.vertices.iter().position(|y| y == x).unwrap() as i32;
            let number: Vec<i32> = s.vertices.iter().map(first).collect();
            s.triangles.iter_mut().for_each(|t| *t = t.map(|v| number[v as usize]));
        }
        let count = 1 + r.below(6) as usize;
        let p = planes(r, &s, count, true);
        (s, p)
    });
}

/// Stars with lengths of any sign: turned inside out in parts.
#[test]
fn inverted_stars() {
    attack(23, rounds(300), |r| {
        let levels = r.below(2) as usize;
        let s = star(levels, || [1.0, 2.0, -1.0, 3.0, 1.0 + r.signed() / 2.0][r.below(5) as usize]);
        let count = 1 + r.below(6) as usize;
        let p = planes(r, &s, count, true);
        (s, p)
    });
}

/// The six closed models of CGAL's that intersect themselves, by planes through vertices and on a grid.
#[test]
fn models_that_intersect_themselves() {
    let Some(folder) = common::cgal_meshes() else { return };
    let mut complexes = 0;
    for name in ["bones", "bull", "camel", "cow", "elk", "man"] {
        let path = folder.join(format!("{name}.off"));
        let soup = common::read_mesh(&path).unwrap();
        let mut r = Random(5);
        let mut tally = Tally::default();
        let bound = |f: fn(f64, f64) -> f64, start: f64| {
            soup.vertices.iter().fold([start; 3], |m, x| std::array::from_fn(|i| f(m[i], x[i])))
        };
        let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
        let grid = |n: usize| -> Vec<Plane> {
            (0..3 * n)
                .map(|i| {
                    let (axis, k) = (i % 3, i / 3);
                    let mut n_ = [0.0; 3];
                    n_[axis] = 1.0;
                    Plane { n: n_, d: -(low[axis] + (high[axis] - low[axis]) * (k + 1) as f64 / (n + 1) as f64) }
                })
                .collect()
        };
        for round in 0..rounds(4) {
            let p = match round {
                0 => Vec::new(),
                1 => grid(4),
                2 => grid(23),
                _ => {
                    let mut p = planes(&mut r, &soup, 8, false);
                    p.extend((0..3).map(|i| {
                        let x = soup.vertices[r.below(soup.vertices.len() as u64) as usize];
                        let mut n = [0.0; 3];
                        n[i] = 1.0;
                        Plane { n, d: -x[i] }
                    }));
                    p
                }
            };
            one(&soup, &p, false, &mut tally).unwrap_or_else(|e| panic!("{name}, round {round}: {e}"));
        }
        let refused = common::build_soup(&soup, Default::default()).err().map(|e| e.message);
        println!("{name}: {tally:?} {}", refused.unwrap_or_default());
        complexes += tally.complexes;
    }
    assert!(complexes > 0);
}

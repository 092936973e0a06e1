//! Random degenerate cuts (small integer planes through everything), and meshes that intersect themselves, with the check off:
//! the former must be right, the latter give an error or a complex that passes `check`, and never panic or hang.

mod common;

use common::random::Random;
use lapidary::base::{CellId, Run, Status};
use lapidary::complex::{Complex, check, check_volumes, euler, solid_euler};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::{Plane, Sign, Support, support_side};
use lapidary::mesh::{MeshInput, MeshOptions, TriMesh, build};
use std::path::Path;
use std::sync::Arc;

/// Rounds of each fuzz: `LAPIDARY_FUZZ=n` for more.
fn rounds(default: u64) -> u64 {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

/// No cell lies on both sides of a plane.
fn one_sided(c: &Complex) -> Result<(), String> {
    for i in 0..c.cell_count() {
        let mut corners: Vec<_> = c
            .cell_faces(CellId::of(i))
            .iter()
            .flat_map(|h| c.corner_vertices[c.face_corners(h.face())].iter().copied())
            .collect();
        corners.sort_unstable();
        corners.dedup();
        for (p, plane) in c.planes.iter().enumerate() {
            let sides = |wanted| corners.iter().any(|&v| support_side(&Support::Plane(*plane), &c.point(v)) == wanted);
            if sides(Sign::Positive) && sides(Sign::Negative) {
                return Err(format!("cell {i} lies on both sides of plane {p}"));
            }
        }
    }
    Ok(())
}

fn right(mesh: &Arc<TriMesh>, planes: &[Plane]) -> Result<(), String> {
    let c = cut(mesh, planes, &CutOptions::default(), &mut Run::quiet()).map_err(|e| e.message)?.complex;
    check(&c)?;
    check_volumes(&c)?;
    one_sided(&c)?;
    let (got, wanted) = (euler(&c)?, solid_euler(mesh));
    if got != wanted {
        return Err(format!("Euler characteristic {got}, expected {wanted}"));
    }
    Ok(())
}

/// Solids of few triangles, all on small integers, with every kind of contact by shared index.
fn solids() -> Vec<(&'static str, common::Soup)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cut-small");
    let read = |name: &str| common::read_obj(&folder.join(name)).unwrap();
    let tets = common::together(&[
        common::tetrahedron([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]),
        common::tetrahedron([[0.0, 0.0, 0.0], [0.0, -2.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 0.0, -2.0]]),
    ]);
    let void = common::together(&[common::cube(-2.0, 2.0), common::flipped(common::cube(-1.0, 1.0))]);
    let nested = common::together(&[
        common::cube(-4.0, 4.0),
        common::flipped(common::cube(-3.0, 3.0)),
        common::cube(-2.0, 2.0),
        common::flipped(common::cube(-1.0, 1.0)),
    ]);
    vec![
        ("cube", read("cube2.obj")),
        ("square torus", read("sqtorus.obj")),
        ("cube with a cubic void", read("cube_void_cube.obj")),
        ("cube with a void", read("cube_void.obj")),
        ("simplecase", read("simplecase.obj")),
        ("two cubes", read("two_cubes.obj")),
        ("tetrahedra at a vertex", tets),
        ("void", void),
        ("nested", nested),
    ]
}

#[test]
fn small_integer_planes() {
    let mut random = Random(7);
    let merged = MeshOptions { merge_duplicate_vertices: true, ..Default::default() };
    let mut failed = Vec::new();
    for (name, soup) in solids() {
        let mesh = Arc::new(common::build_soup(&soup, merged).unwrap());
        for round in 0..rounds(60) {
            let count = 1 + random.below(9);
            let mut planes: Vec<Plane> =
                (0..count).map(|_| Plane { n: [0; 3].map(|_| random.within(2)), d: random.within(4) / 2.0 }).collect();
            planes.retain(|p| p.n != [0.0; 3]);
            let outcome = std::panic::catch_unwind(|| right(&mesh, &planes)).unwrap_or(Err("panic".into()));
            if let Err(message) = outcome {
                failed.push(format!("{name}, round {round}: {message}; planes {planes:?}"));
            }
        }
    }
    assert!(failed.is_empty(), "{} failed: {:#?}", failed.len(), &failed[..failed.len().min(5)]);
}

/// A closed mesh with its vertices moved at random to small integers: closed and balanced, and nearly always self-intersecting.
#[test]
fn self_intersecting_meshes_do_no_harm() {
    let mut random = Random(11);
    let (mut errors, mut complexes, mut invalid) = (0, 0, 0);
    let mut failed = Vec::new();
    for (name, soup) in solids() {
        for round in 0..rounds(150) {
            let mut moved = soup.clone();
            let fixed = random.below(2) == 0;
            for x in moved.vertices.iter_mut() {
                if !fixed || random.below(4) == 0 {
                    *x = [0; 3].map(|_| random.within(3));
                }
            }
            let input = MeshInput { vertices: &moved.vertices, triangles: &moved.triangles, tags: None };
            let outcome = std::panic::catch_unwind(|| {
                // Degenerate triangles and duplicate points are found by the mesh; what passes goes on.
                let Ok(mesh) = build(&input, &MeshOptions::default(), &mut Run::quiet()) else { return Ok(None) };
                let mut planes = vec![Plane { n: [1.0, 0.0, 0.0], d: 0.0 }, Plane { n: [0.0, 1.0, 1.0], d: -1.0 }];
                planes.push(Plane { n: [1.0, -1.0, 0.0], d: 0.0 });
                planes.push(Plane { n: [0.0, 0.0, 1.0], d: -1.0 });
                match cut(&Arc::new(mesh), &planes, &CutOptions::default(), &mut Run::quiet()) {
                    Ok(result) => check(&result.complex).map(|()| Some(true)),
                    Err(e) if e.status == Status::Inconsistent => Ok(Some(false)),
                    Err(e) => Err(e.message),
                }
            });
            match outcome.unwrap_or(Err("panic".into())) {
                Ok(None) => invalid += 1,
                Ok(Some(true)) => complexes += 1,
                Ok(Some(false)) => errors += 1,
                Err(message) => failed.push(format!("{name}, round {round}: {message}; {:?}", moved.vertices)),
            }
        }
    }
    println!("{invalid} invalid meshes, {errors} errors, {complexes} complexes");
    assert!(failed.is_empty(), "{} failed: {:#?}", failed.len(), &failed[..failed.len().min(5)]);
    assert!(errors > 10 && complexes > 10);
}

//! Every closed valid mesh of the optional CGAL data set under every kind of plane set: the complex is what it claims
//! to be, its Euler characteristic is the solid's, and the cells' exact volumes add up to the solid's.
//!
//! A quick subset by default; all with `LAPIDARY_ALL=1 cargo test --release --test cut_models`.

mod common;

use common::random::Random;
use lapidary::base::Run;
use lapidary::complex::{check, check_volumes, euler, solid_euler};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::Plane;
use lapidary::mesh::TriMesh;
use std::sync::Arc;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn axis_plane(axis: usize, x: f64) -> Plane {
    let mut n = [0.0; 3];
    n[axis] = 1.0;
    Plane { n, d: -x }
}

/// The plane through `x` with normal `n`, as well as doubles can say it.
fn through(n: [f64; 3], x: [f64; 3]) -> Plane {
    Plane { n, d: -dot(n, x) }
}

fn grid(mesh: &TriMesh, count: usize) -> Vec<Plane> {
    let [low, high] = mesh.bbox;
    (0..3)
        .flat_map(|a| {
            (0..count).map(move |i| axis_plane(a, low[a] + (high[a] - low[a]) * i as f64 / (count - 1) as f64))
        })
        .collect()
}

fn arbitrary(mesh: &TriMesh, count: usize, random: &mut Random) -> Vec<Plane> {
    let [low, high] = mesh.bbox;
    (0..count)
        .map(|_| {
            let n = [0; 3].map(|_| 2.0 * random.unit() - 1.0);
            let x = std::array::from_fn(|a| low[a] + (high[a] - low[a]) * random.unit());
            through(n, x)
        })
        .collect()
}

/// Planes through vertices of the mesh exactly (axis-parallel), through edges and faces as well as doubles can say it: exactly where
/// coordinates have few bits, within rounding elsewhere.
fn incident(mesh: &TriMesh, count: usize, random: &mut Random) -> Vec<Plane> {
    let corner = |t: usize, k: usize| mesh.vertices[mesh.triangles[t][k].at()];
    let mut planes = Vec::new();
    for i in 0..count {
        let t = random.below(mesh.triangles.len() as u64) as usize;
        let [a, b, c] = [corner(t, 0), corner(t, 1), corner(t, 2)];
        planes.push(axis_plane(i % 3, a[i % 3]));
        let sideways = [0; 3].map(|_| random.below(5) as f64 - 2.0);
        planes.push(through(cross(minus(b, a), sideways), a));
        planes.push(through(cross(minus(b, a), minus(c, a)), a));
    }
    planes.retain(|p| p.n != [0.0; 3]);
    planes
}

/// The mesh on a grid of 15-bit integers, where planes through edges and faces are exact; `None` if that breaks it.
fn on_integers(soup: &common::Soup) -> Option<TriMesh> {
    let bound = soup.vertices.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let mut soup = soup.clone();
    for x in soup.vertices.iter_mut().flatten() {
        *x = (*x / bound * 16384.0).round();
    }
    let options = lapidary::mesh::MeshOptions { check_self_intersection: true, ..Default::default() };
    common::build_soup(&soup, options).ok()
}

fn verify(name: &str, what: &str, mesh: &Arc<TriMesh>, planes: &[Plane], failed: &mut Vec<String>) {
    let outcome =
        cut(mesh, planes, &CutOptions::default(), &mut Run::quiet()).map_err(|e| e.message).and_then(|result| {
            check(&result.complex)?;
            check_volumes(&result.complex)?;
            let (got, wanted) = (euler(&result.complex)?, solid_euler(mesh));
            if got == wanted { Ok(()) } else { Err(format!("Euler characteristic {got}, expected {wanted}")) }
        });
    if let Err(message) = outcome {
        println!("{name} {what}: {message}");
        failed.push(format!("{name} {what}: {message}"));
    }
}

#[test]
fn all_plane_sets_on_real_models() {
    let (Some(file), Some(folder)) = (common::shared("oracles/closed-meshes.json"), common::cgal_meshes()) else {
        return;
    };
    let everything = std::env::var_os("LAPIDARY_ALL").is_some();
    let all: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    let (mut failed, mut runs, mut exact) = (Vec::new(), 0, 0);
    let meshes = all["meshes"].as_array().unwrap();
    let clean: Vec<_> = meshes.iter().filter(|m| m["self_intersecting_pairs"] == 0).collect();
    assert_eq!(clean.len(), 73);
    for entry in clean {
        let name = entry["file"].as_str().unwrap();
        if !everything && entry["triangles"].as_u64().unwrap() > 3000 {
            continue;
        }
        let mut soup = common::read_mesh(&folder.join(name)).unwrap();
        let mesh = match common::build_soup(&soup, Default::default()) {
            Ok(mesh) => mesh,
            // A few files are inside out as a whole: turned, they must be valid.
            Err(e) => {
                assert!(e.culprits.iter().all(|c| c.kind == lapidary::base::DefectKind::WrongNesting), "{name}: {e}");
                println!("{name} is inside out: turned");
                soup = common::flipped(soup);
                common::build_soup(&soup, Default::default()).unwrap()
            }
        };
        let mesh = Arc::new(mesh);
        let mut random = Random(soup.triangles.len() as u64);
        let mut sets = vec![
            ("A5", grid(&mesh, 5)),
            ("A10", grid(&mesh, 10)),
            ("R10", arbitrary(&mesh, 10, &mut random)),
            ("R30", arbitrary(&mesh, 30, &mut random)),
            ("incident", incident(&mesh, 6, &mut random)),
            ("box", grid(&mesh, 2)),
        ];
        if everything || soup.triangles.len() < 500 {
            sets.push(("R100", arbitrary(&mesh, 100, &mut random)));
        }
        for (what, planes) in &sets {
            verify(name, what, &mesh, planes, &mut failed);
            runs += 1;
        }
        if let Some(mesh) = on_integers(&soup) {
            let mesh = Arc::new(mesh);
            for what in ["integers 1", "integers 2"] {
                verify(name, what, &mesh, &incident(&mesh, 6, &mut random), &mut failed);
                (runs, exact) = (runs + 1, exact + 1);
            }
        }
    }
    println!("{runs} cuts, {exact} of them with planes exactly through edges and faces");
    assert!(runs > 100 && exact > 20);
    assert!(failed.is_empty(), "{failed:#?}");
}

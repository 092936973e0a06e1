//! What many tests cut: every closed valid mesh of the optional CGAL data set, plane sets, and the small cases of
//! `tests/data/cut-small`.
#![allow(dead_code)]

use super::random::Random;
use super::{Soup, build_soup, cgal_meshes, flipped, read_mesh, read_obj, shared};
use lapidary::exact::Plane;
use lapidary::mesh::{MeshOptions, TriMesh};
use std::path::Path;
use std::sync::Arc;

/// Calls `f` with name, soup and mesh of every closed mesh of CGAL's data that is free of self-intersection, up to
/// `limit` triangles (all with `LAPIDARY_ALL`). False, with the reason printed, if the data is not there.
pub fn each_model(limit: u64, f: impl FnMut(&str, &Soup, Arc<TriMesh>)) -> bool {
    each_model_or_all("LAPIDARY_ALL", limit, f)
}

/// The same; the variable that asks for all models.
pub fn each_model_or_all(variable: &str, limit: u64, mut f: impl FnMut(&str, &Soup, Arc<TriMesh>)) -> bool {
    let (Some(file), Some(folder)) = (shared("oracles/closed-meshes.json"), cgal_meshes()) else {
        return false;
    };
    let everything = std::env::var_os(variable).is_some();
    let all: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    let meshes = all["meshes"].as_array().unwrap();
    let clean: Vec<_> = meshes.iter().filter(|m| m["self_intersecting_pairs"] == 0).collect();
    assert_eq!(clean.len(), 73);
    for entry in clean {
        let name = entry["file"].as_str().unwrap();
        if !everything && entry["triangles"].as_u64().unwrap() > limit {
            continue;
        }
        let mut soup = read_mesh(&folder.join(name)).unwrap();
        let mesh = match build_soup(&soup, Default::default()) {
            Ok(mesh) => mesh,
            // A few files are inside out as a whole: turned, they must be valid.
            Err(e) => {
                assert!(e.culprits.iter().all(|c| c.kind == lapidary::base::DefectKind::WrongNesting), "{name}: {e}");
                println!("{name} is inside out: turned");
                soup = flipped(soup);
                build_soup(&soup, Default::default()).unwrap()
            }
        };
        f(name, &soup, Arc::new(mesh));
    }
    true
}

/// The mesh on a grid of 15-bit integers, where planes through edges and faces are exact; `None` if that breaks it.
pub fn on_integers(soup: &Soup) -> Option<TriMesh> {
    let bound = soup.vertices.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let mut soup = soup.clone();
    for x in soup.vertices.iter_mut().flatten() {
        *x = (*x / bound * 16384.0).round();
    }
    let options = MeshOptions { check_self_intersection: true, ..Default::default() };
    build_soup(&soup, options).ok()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn axis_plane(axis: usize, x: f64) -> Plane {
    let mut n = [0.0; 3];
    n[axis] = 1.0;
    Plane { n, d: -x }
}

/// The plane through `x` with normal `n`, as well as doubles can say it.
pub fn through(n: [f64; 3], x: [f64; 3]) -> Plane {
    Plane { n, d: -dot(n, x) }
}

/// `count` axis-parallel planes per axis, evenly over the bounding box, its faces included.
pub fn grid(mesh: &TriMesh, count: usize) -> Vec<Plane> {
    let [low, high] = mesh.bbox;
    (0..3)
        .flat_map(|a| {
            (0..count).map(move |i| axis_plane(a, low[a] + (high[a] - low[a]) * i as f64 / (count - 1) as f64))
        })
        .collect()
}

pub fn arbitrary(mesh: &TriMesh, count: usize, random: &mut Random) -> Vec<Plane> {
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
pub fn incident(mesh: &TriMesh, count: usize, random: &mut Random) -> Vec<Plane> {
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

/// A mesh and planes.
#[derive(Clone)]
pub struct Case {
    pub name: String,
    pub soup: Soup,
    pub planes: Vec<Plane>,
}

/// The cases of `tests/data/cut-small`.
pub fn small_cases() -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cut-small");
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.retain(|p| p.extension().is_some_and(|e| e == "json"));
    files.sort();
    let read = |path: &std::path::PathBuf| {
        let case: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let row = |p: &serde_json::Value| {
            let x: Vec<f64> = p.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
            Plane { n: [x[0], x[1], x[2]], d: x[3] }
        };
        Case {
            name: path.file_stem().unwrap().to_string_lossy().into(),
            soup: read_obj(&folder.join(case["mesh"].as_str().unwrap())).unwrap(),
            planes: case["planes"].as_array().unwrap().iter().map(row).collect(),
        }
    };
    files.iter().map(read).collect()
}

/// A fixed permutation of `n` things.
pub fn permutation(n: usize, mut seed: u64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        order.swap(i, (seed >> 33) as usize % (i + 1));
    }
    order
}

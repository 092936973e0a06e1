//! What is derived from cuts of a real model: moments against rationals, faces in every style, exact sums; and how long
//! each takes (printed).

mod common;

use lapidary::base::{CellId, FaceId, Run};
use lapidary::complex::check::check_exact;
use lapidary::complex::exact_values::{cell_values, cell_volume, face_values, mesh_volume, tree_sum};
use lapidary::complex::keys::{face_keys, names, vertex_keys};
use lapidary::complex::{Complex, FaceStyle, adjacency, check, check_volumes, euler, faces_as, moments};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::{Plane, round_rational};
use lapidary::mesh::TriMesh;
use std::sync::Arc;
use std::time::Instant;

fn timed<T>(what: &str, count: usize, unit: &str, f: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let x = f();
    let t = start.elapsed().as_secs_f64();
    println!("  {what}: {:.2} ms, {:.0} ns per {unit}", t * 1e3, t * 1e9 / count as f64);
    x
}

fn derive(name: &str, mesh: &Arc<TriMesh>, planes: &[Plane]) {
    let c: Complex = cut(mesh, planes, &CutOptions::default(), &mut Run::quiet()).expect("a valid cut").complex;
    let corners = c.corner_vertices.len();
    println!(
        "{name}: {} vertices, {} faces, {} cells, {corners} corners",
        c.vertex_count(),
        c.face_count(),
        c.cell_count()
    );
    let m = timed("moments", corners, "corner", || moments(&c));
    println!("    {} faces and {} cells by rationals", m.exact_faces, m.exact_cells);
    timed("triangulated", corners, "corner", || faces_as(&c, FaceStyle::Triangulated)).unwrap();
    timed("bridged", corners, "corner", || faces_as(&c, FaceStyle::Bridged)).unwrap();
    timed("adjacency", corners, "corner", || adjacency(&c)).unwrap();
    timed("Euler characteristic", corners, "corner", || euler(&c)).unwrap();
    let names = names(&c.mesh, &c.planes, &Default::default()).unwrap();
    timed("keys of vertices", c.vertex_count(), "vertex", || vertex_keys(&c, &names));
    timed("keys of faces", c.face_count(), "face", || face_keys(&c, &names)).unwrap();
    timed("check", corners, "corner", || check(&c)).unwrap();
    timed("check of volumes", corners, "corner", || check_volumes(&c)).unwrap();
    // The exact values are compared with definitions elsewhere; here they are the oracle, on a sample.
    for f in (0..c.face_count()).step_by(c.face_count() / 500 + 1).map(FaceId::of) {
        let exact = face_values(&c, f);
        assert_eq!(m.face_area_vector[f.at()], exact.area.map(|x| round_rational(&x)), "{name}: face {}", f.0);
        assert_eq!(m.face_centroid[f.at()], exact.centroid.map(|x| round_rational(&x)), "{name}: face {}", f.0);
    }
    for k in (0..c.cell_count()).step_by(c.cell_count() / 50 + 1).map(CellId::of) {
        if c.cell_faces(k).len() > 3000 {
            continue;
        }
        let (volume, centroid) = cell_values(&c, k);
        assert_eq!(m.cell_volume[k.at()], round_rational(&volume), "{name}: cell {}", k.0);
        assert_eq!(m.cell_centroid[k.at()], centroid.map(|x| round_rational(&x)), "{name}: cell {}", k.0);
    }
    if c.face_count() < 30000 {
        timed("exact volumes", corners, "corner", || {
            let sum = tree_sum((0..c.cell_count()).map(|k| cell_volume(&c, CellId::of(k))).collect());
            assert_eq!(sum, mesh_volume(&c.mesh), "{name}: volumes");
        });
        timed("exact check", corners, "corner", || check_exact(&c)).unwrap();
    }
}

fn grid(mesh: &TriMesh, count: usize) -> Vec<Plane> {
    let [low, high] = mesh.bbox;
    let plane = |axis: usize, i: usize| {
        let mut n = [0.0; 3];
        n[axis] = 1.0;
        Plane { n, d: -(low[axis] + (high[axis] - low[axis]) * (i as f64 + 0.5) / count as f64) }
    };
    (0..3).flat_map(|a| (0..count).map(move |i| (a, i))).map(|(a, i)| plane(a, i)).collect()
}

fn oblique(mesh: &TriMesh, count: usize) -> Vec<Plane> {
    let [low, high] = mesh.bbox;
    let plane = |i: usize| {
        let t = i as f64 + 1.0;
        let n = [(1.3 * t).sin(), (2.7 * t).cos(), (0.9 * t * t).sin()];
        let x = |a: usize| low[a] + (high[a] - low[a]) * (0.5 + 0.3 * (t * (a as f64 + 1.7)).sin());
        Plane { n, d: -(n[0] * x(0) + n[1] * x(1) + n[2] * x(2)) }
    };
    (0..count).map(plane).collect()
}

#[test]
fn derived_from_a_model() {
    let Some(file) = common::shared("data/meshes/rocker-arm.obj") else { return };
    let soup = common::read_mesh(&file).unwrap();
    let mesh = Arc::new(common::build_soup(&soup, common::merging()).unwrap());
    derive("uncut", &mesh, &[]);
    derive("grid of 10", &mesh, &grid(&mesh, 10));
    derive("grid of 60", &mesh, &grid(&mesh, 60));
    derive("10 oblique planes", &mesh, &oblique(&mesh, 10));
    derive("60 oblique planes", &mesh, &oblique(&mesh, 60));
}

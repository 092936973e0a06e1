//! Pairs that flat stars settle have nothing in common beyond what they share by index: every one of them is asked exactly.

use lapidary::arrangement::soup::soup;
use lapidary::arrangement::stars::flat_stars;
use lapidary::arrangement::{Operand, Soup};
use lapidary::base::Run;
use lapidary::mesh::bvh::build_bvh;
use lapidary::mesh::self_intersection::contact;

mod common;
use common::icosphere::icosphere;
use common::random::Random;

/// How many pairs of triangles whose boxes meet are settled, and how many there are.
fn settled(vertices: &[[f64; 3]], triangles: &[[i32; 3]], what: &str) -> [usize; 2] {
    let soup: Soup = soup(&[Operand { vertices, triangles }], &mut Run::quiet()).expect(what);
    let mesh = &*soup.mesh;
    let stars = flat_stars(mesh);
    let mut counts = [0; 2];
    build_bvh(&mesh.vertices, &mesh.triangles).meeting_pairs(|a, b| {
        let [p, q] = [a, b].map(|t| &mesh.triangles[t.at()]);
        counts[1] += 1;
        if stars.settle(p, q) {
            counts[0] += 1;
            assert!(!contact(&mesh.vertices, p, q), "{what}: triangles {} and {} meet", a.0, b.0);
        }
        true
    });
    counts
}

#[test]
fn smooth_surfaces_are_settled() {
    let (vertices, triangles) = icosphere(4);
    let [some, all] = settled(&vertices, &triangles, "icosphere");
    assert!(20 * some > 19 * all, "{some} of {all}");
}

/// Small whole coordinates: triangles fold onto one another, turn back, stand upright, coincide.
#[test]
fn small_whole_coordinates() {
    let mut random = Random(7);
    let (mut some, mut all, mut meet) = (0, 0, 0);
    for round in 0..3000 {
        // A sphere's connections with any positions.
        let (mut vertices, triangles) = icosphere(round % 2);
        let bound = 1 + (round % 7) as i64;
        vertices.iter_mut().for_each(|x| {
            // Now and then near the sphere, so that stars are flat in places.
            let keep = random.below(3) == 0;
            *x = x.map(|c| if keep { (c * bound as f64).round() } else { random.within(bound) });
        });
        let what = format!("round {round}");
        let [a, b] = settled(&vertices, &triangles, &what);
        (some, all) = (some + a, all + b);
        meet += (a < b) as usize;
    }
    println!("{some} of {all} pairs settled");
    assert!(some > 1000 && meet > 1000, "{some} of {all}, {meet}");
}

#[test]
fn models() {
    let Some(folder) = common::cgal_meshes() else {
        println!("skipped: no CGAL meshes (LAPIDARY_CGAL_MESHES)");
        return;
    };
    let (mut files, mut some, mut all) = (0, 0, 0);
    let mut paths: Vec<_> = std::fs::read_dir(folder).expect("a folder").map(|f| f.expect("a file").path()).collect();
    paths.sort();
    for path in paths.iter().filter(|p| p.extension().is_some_and(|e| e == "off")) {
        let Ok(mesh) = common::read_off(path) else { continue };
        let inside = |t: &[i32; 3]| t.iter().all(|&v| (0..mesh.vertices.len() as i32).contains(&v));
        if mesh.triangles.len() > 100_000 || mesh.triangles.is_empty() || !mesh.triangles.iter().all(inside) {
            continue;
        }
        let [a, b] = settled(&mesh.vertices, &mesh.triangles, &path.display().to_string());
        (files, some, all) = (files + 1, some + a, all + b);
    }
    println!("{files} files, {some} of {all} pairs settled");
    assert!(files > 50 && 2 * some > all, "{files} files, {some} of {all}");
}

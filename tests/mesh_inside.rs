//! Points against solids: every lattice point around shapes whose inside is known, and random points against winding numbers in
//! rationals.

#[path = "common/brute.rs"]
mod brute;
mod common;
#[path = "common/solids.rs"]
mod solids;

use brute::{Surface, point};
use common::random::Random;
use common::*;
use lapidary::base::TriangleId;
use lapidary::mesh::bvh::build_bvh;
use lapidary::mesh::{Place, TriMesh, locate};

fn places(mesh: &TriMesh, points: impl Iterator<Item = [f64; 3]>, expected: impl Fn([f64; 3]) -> Place) -> [usize; 3] {
    let bvh = build_bvh(&mesh.vertices, &mesh.triangles);
    let mut seen = [0; 3];
    for x in points {
        let found = locate(mesh, &bvh, &x);
        assert_eq!(found, expected(x), "{x:?}");
        seen[found as usize] += 1;
    }
    seen
}

fn lattice(low: i32, high: i32) -> impl Iterator<Item = [f64; 3]> {
    let halves = move || (2 * low..=2 * high).map(|i| f64::from(i) / 2.0);
    halves().flat_map(move |x| halves().flat_map(move |y| halves().map(move |z| [x, y, z])))
}

#[test]
fn a_box_with_a_void() {
    // Rays along the diagonals of squares, along edges and through vertices: all of it ties.
    let soup = together(&[cube(0.0, 6.0), flipped(cuboid([2.0; 3], [4.0, 4.0, 5.0]))]);
    let mesh = build_soup(&soup, merging()).unwrap();
    let within = |x: [f64; 3], lo: [f64; 3], hi: [f64; 3]| {
        let inside = (0..3).all(|i| lo[i] < x[i] && x[i] < hi[i]);
        let outside = (0..3).any(|i| x[i] < lo[i] || hi[i] < x[i]);
        if inside {
            Place::Inside
        } else if outside {
            Place::Outside
        } else {
            Place::Surface
        }
    };
    let seen = places(&mesh, lattice(-1, 7), |x| {
        match (within(x, [0.0; 3], [6.0; 3]), within(x, [2.0; 3], [4.0, 4.0, 5.0])) {
            (_, Place::Surface) => Place::Surface,
            (_, Place::Inside) => Place::Outside,
            (outer, _) => outer,
        }
    });
    assert!(seen.iter().all(|&n| n > 100), "{seen:?}");
}

#[test]
fn random_voxels_touch_themselves() {
    let mut random = Random(5);
    for _ in 0..3 {
        let soup = solids::voxels(&mut random, 3, 50);
        let mesh = build_soup(&soup, merging()).unwrap();
        let surface = Surface { triangles: mesh_triangles(&mesh) };
        places(&mesh, lattice(-1, 4), |x| by_rationals(&surface, x));
    }
}

#[test]
fn a_star_at_any_scale() {
    for scale in [1.0, 2f64.powi(-1060), 2f64.powi(1000)] {
        let mut random = Random(9);
        let mut soup = solids::star(2, || 1.0 + random.below(3) as f64);
        soup.vertices.iter_mut().flatten().for_each(|c| *c *= scale);
        let mesh = build_soup(&soup, merging()).unwrap();
        let surface = Surface { triangles: mesh_triangles(&mesh) };
        let mut points: Vec<[f64; 3]> = (0..200).map(|_| [0; 3].map(|_| 8.0 * random.signed() * scale)).collect();
        points.extend(&mesh.vertices);
        let seen = places(&mesh, points.into_iter(), |x| by_rationals(&surface, x));
        assert!(seen.iter().all(|&n| n > 15), "{seen:?}");
    }
}

fn mesh_triangles(mesh: &TriMesh) -> Vec<[brute::P; 3]> {
    (0..mesh.triangles.len()).map(|t| mesh.corners(TriangleId::of(t)).map(point)).collect()
}

fn by_rationals(surface: &Surface, x: [f64; 3]) -> Place {
    let x = point(x);
    if surface.touches(&x) {
        Place::Surface
    } else if surface.strictly_inside(&x) {
        Place::Inside
    } else {
        Place::Outside
    }
}

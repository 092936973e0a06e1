//! Cost grows with the output: many planes on few triangles, many shells, large pencils. Every cut is checked in full; times are
//! printed (`--nocapture`). `LAPIDARY_SCALE=1` runs the full sizes.

mod common;
#[path = "common/solids.rs"]
mod solids;

use common::Soup;
use lapidary::base::Run;
use lapidary::complex::{Complex, adjacency, check, check_volumes, euler, moments, solid_euler};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::Plane;
use lapidary::mesh::{MeshInput, MeshOptions, build};
use solids::*;
use std::sync::Arc;
use std::time::Instant;

fn full() -> bool {
    std::env::var_os("LAPIDARY_SCALE").is_some()
}

fn run(name: &str, soup: &Soup, planes: &[Plane]) -> Complex {
    let start = Instant::now();
    let input = MeshInput { vertices: &soup.vertices, triangles: &soup.triangles, tags: None };
    let mesh = Arc::new(build(&input, &MeshOptions::default(), &mut Run::quiet()).expect("a valid mesh"));
    let built = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let result = cut(&mesh, planes, &CutOptions::default(), &mut Run::quiet()).expect("a cut");
    let time = start.elapsed().as_secs_f64();
    let c = result.complex;
    let start = Instant::now();
    let m = moments(&c);
    let moments_time = start.elapsed().as_secs_f64();
    let start = Instant::now();
    adjacency(&c).expect("mates");
    let adjacency_time = start.elapsed().as_secs_f64();
    println!(
        "{name}: build {built:.3} s, cut {time:.3} s, moments {moments_time:.3} s ({} + {} rational), adjacency {adjacency_time:.3} s; \
         {} vertices, {} faces, {} cells, {:.2} µs per corner",
        m.exact_cells,
        m.exact_faces,
        c.vertex_count(),
        c.face_count(),
        c.cell_count(),
        time * 1e6 / c.corner_vertices.len() as f64
    );
    let stages: Vec<String> = result.stages.iter().map(|(n, t)| format!("{n} {:.1}", t * 1e3)).collect();
    println!("    ms: {}", stages.join(", "));
    check(&c).unwrap();
    check_volumes(&c).unwrap();
    assert_eq!(euler(&c), Ok(solid_euler(&mesh)), "{name}");
    c
}

fn cube() -> Soup {
    common::cube(-1.0, 1.0)
}

fn plane(n: [f64; 3], d: f64) -> Plane {
    Plane { n, d }
}

fn unit_axis(axis: usize) -> [f64; 3] {
    std::array::from_fn(|i| (i == axis) as i32 as f64)
}

/// `count` planes across each axis, evenly within (−1, 1).
fn grid(count: usize) -> Vec<Plane> {
    let at = |i: usize| 1.0 - 2.0 * (i + 1) as f64 / (count + 1) as f64;
    (0..3).flat_map(|axis| (0..count).map(move |i| plane(unit_axis(axis), at(i)))).collect()
}

#[test]
fn parallel_planes() {
    let count = if full() { 20_000 } else { 1000 };
    let mut random = Random(1);
    let oblique: Vec<Plane> =
        (0..count).map(|i| plane([3.0, -1.0, 2.0], 11.0 * (i as f64 / count as f64 - 0.5))).collect();
    let c = run("parallel, oblique", &cube(), &oblique);
    assert!(c.cell_count() <= count + 1 && c.cell_count() > count);
    // Each in a scale of its own, in any order.
    let scaled: Vec<Plane> = (0..count)
        .map(|_| {
            let s = random.signed() * 2f64.powi(random.below(60) as i32 - 30);
            plane([s, 0.0, 0.0], s * random.signed())
        })
        .collect();
    run("parallel, scaled", &cube(), &scaled);
}

#[test]
fn grid_in_a_cube() {
    let n = if full() { 60 } else { 24 };
    let c = run("grid", &cube(), &grid(n));
    assert_eq!(c.cell_count(), (n + 1).pow(3));
}

#[test]
fn planes_through_the_centre() {
    let n = if full() { 300 } else { 60 };
    let mut random = Random(2);
    let planes: Vec<Plane> = (0..n).map(|_| plane([0; 3].map(|_| random.signed()), 0.0)).collect();
    let c = run("through the centre", &cube(), &planes);
    // General planes through a point: n (n − 1) + 2 cones.
    assert_eq!(c.cell_count(), n * (n - 1) + 2);
}

#[test]
fn random_planes_in_a_cube() {
    let n = if full() { 120 } else { 40 };
    let mut random = Random(9);
    let planes: Vec<Plane> = (0..n).map(|_| plane([0; 3].map(|_| random.signed()), random.signed() / 4.0)).collect();
    run("random planes", &cube(), &planes);
}

#[test]
fn pencils() {
    let n = if full() { 1000 } else { 300 };
    // Through the z axis; through a line off the diagonal; all with integer normals.
    let upright: Vec<Plane> = (0..n).map(|i| plane([i as f64 - 100.5, 57.0, 0.0], 0.0)).collect();
    let c = run("pencil, upright", &cube(), &upright);
    assert_eq!(c.cell_count(), 2 * n);
    // a (x + y + z − 1/2) + b (x − 2y + 1/4)
    let oblique: Vec<Plane> = (0..n)
        .map(|i| {
            let (a, b) = (i as f64 - 117.0, 64.0);
            plane([a + b, a - 2.0 * b, a], -a / 2.0 + b / 4.0)
        })
        .collect();
    let c = run("pencil, oblique", &cube(), &oblique);
    assert_eq!(c.cell_count(), 2 * n);
}

/// A sphere with `count`³ small voids on a lattice.
fn cheese(levels: usize, count: usize) -> Soup {
    let mut outer = ball(levels);
    for x in &mut outer.vertices {
        let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        *x = x.map(|x| x / length);
    }
    let mut parts = vec![outer];
    let step = 1.0 / count as f64;
    for i in 0..count.pow(3) {
        let at = [i % count, i / count % count, i / count / count].map(|k| (k as f64 + 0.5) * step - 0.5);
        let mut void = common::flipped(ball(1));
        for x in &mut void.vertices {
            *x = std::array::from_fn(|k| x[k] * step * 0.2 + at[k]);
        }
        parts.push(void);
    }
    common::together(&parts)
}

#[test]
fn sphere_with_many_voids() {
    let (levels, count) = if full() { (7, 10) } else { (5, 6) };
    let soup = cheese(levels, count);
    println!("{} triangles", soup.triangles.len());
    let c = run("voids, no planes", &soup, &[]);
    assert_eq!((c.cell_count(), c.shell_faces.len()), (1, 1 + count.pow(3)));
    run("voids, one plane", &soup, &[plane([1.0, 0.0, 0.0], 0.013)]);
    run("voids, grid off the voids", &soup, &grid(count));
    // Through the middles of the voids, exactly through their vertices.
    let middles: Vec<Plane> = (0..3)
        .flat_map(|axis| {
            (0..count).map(move |k| plane(unit_axis(axis), -((k as f64 + 0.5) * (1.0 / count as f64) - 0.5)))
        })
        .collect();
    run("voids, grid through the voids", &soup, &middles);
    // A layer of planes that touch all voids of a row from one side.
    let touching: Vec<Plane> = soup
        .vertices
        .iter()
        .skip(soup.vertices.len() - 18 * count)
        .step_by(18)
        .map(|x| plane([0.0, 1.0, 0.0], -x[1]))
        .collect();
    run("voids, touched", &soup, &touching);
}

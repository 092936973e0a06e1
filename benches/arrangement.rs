//! Times unions of meshes per stage, in memory, minimum of repeats:
//! `cargo bench --bench arrangement -- (CASE | MESH...) [REPEATS]` with CASE one of
//!
//! - `bunnies`: `bunny00.off` of CGAL's meshes (`LAPIDARY_CGAL_MESHES`), and itself rotated and shifted by a fifth of its size
//! - `rocker-arms`: `../shared/data/meshes/rocker-arm.obj`, and itself shifted by a twentieth of its size
//! - `squares`: two cubes of edge 30, 30 × 30 squares a side, shifted by half a square
//! - `cubes`: 50 unit cubes, randomly rotated, centres uniform in [0, 2]³
//! - `spheres [N]`: two unit spheres of 20 N² triangles (N = 181), centres 0.8 apart
//!
//! `THREADS` sets the number of threads (1).

use lapidary::arrangement::{ArrangementOptions, Operand, Selection, arrange, choose, extract};
use lapidary::base::Run;
use std::path::Path;
use std::time::Instant;

#[path = "../tests/common/mod.rs"]
mod common;
use common::Soup;
use common::random::Random;
use common::shapes::{geodesic, grid_cube, moved, rotation, shifted};

fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM")).unwrap_or("");
    line.split_whitespace().nth(1).and_then(|x| x.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

fn diagonal(soup: &Soup) -> f64 {
    let range = |i: usize| {
        let all = soup.vertices.iter().map(|x| x[i]);
        all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
    };
    (0..3).map(|i| range(i).powi(2)).sum::<f64>().sqrt()
}

fn operands(case: &str, size: Option<i32>, files: &[&String]) -> Vec<Soup> {
    match case {
        "bunnies" => {
            let path = common::cgal_meshes().expect("LAPIDARY_CGAL_MESHES").join("bunny00.off");
            let a = common::read_off(&path).expect("a mesh");
            let d = 0.2 * diagonal(&a);
            let b = moved(&a, rotation(&mut Random(1)), 1.0, [d, 0.0, 0.0]);
            vec![a, b]
        }
        "rocker-arms" => {
            let a =
                common::read_obj(&common::shared("data/meshes/rocker-arm.obj").expect("../shared")).expect("a mesh");
            let d = diagonal(&a) / 20.0;
            let b = shifted(&a, [d * 0.6, d * 0.48, d * 0.64]);
            vec![a, b]
        }
        "squares" => {
            vec![grid_cube(30, [0.0; 3], 1.0), grid_cube(30, [0.5, 0.25, 0.0], 1.0)]
        }
        "cubes" => {
            let mut random = Random(1);
            let cube = grid_cube(1, [-0.5; 3], 1.0);
            let mut one = || {
                let m = rotation(&mut random);
                moved(&cube, m, 1.0, std::array::from_fn(|_| 2.0 * random.unit()))
            };
            (0..50).map(|_| one()).collect()
        }
        "spheres" => {
            let a = geodesic(size.unwrap_or(181));
            let b = shifted(&a, [0.8 * 0.36, 0.8 * 0.48, 0.8 * 0.8]);
            vec![a, b]
        }
        _ => files.iter().map(|f| common::read_mesh(Path::new(f)).expect("a mesh")).collect(),
    }
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let Some(case) = args.first() else {
        println!("usage: (bunnies|rocker-arms|squares|cubes|spheres [N]|MESH...) [REPEATS]");
        return;
    };
    let files: Vec<&String> = args.iter().filter(|a| a.parse::<usize>().is_err()).collect();
    let numbers: Vec<usize> = args.iter().filter_map(|a| a.parse().ok()).collect();
    let size = (case == "spheres" && numbers.len() > 1).then(|| numbers[0] as i32);
    let repeats = numbers.last().copied().unwrap_or(5);
    let soups = operands(case, size, &files);
    let operands: Vec<Operand> =
        soups.iter().map(|s| Operand { vertices: &s.vertices, triangles: &s.triangles }).collect();
    let threads = std::env::var("THREADS").ok().and_then(|t| t.parse().ok()).unwrap_or(1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let _keeper = lapidary::base::blocks::Keeper::new();
    let input: usize = operands.iter().map(|o| o.triangles.len()).sum();
    let before = peak();
    let mut best: Vec<(&'static str, f64)> = Vec::new();
    for repeat in 0..repeats {
        let start = Instant::now();
        let (stages, a, out) = pool.install(|| {
            let mut a = arrange(&operands, &ArrangementOptions::default(), &mut Run::quiet()).expect("an arrangement");
            let mut stages = std::mem::take(&mut a.stages);
            let extracting = Instant::now();
            let inside = choose(&a, Selection::Union).expect("a selection");
            let out = extract(&a, &inside).expect("a mesh");
            stages.push(("union", extracting.elapsed().as_secs_f64()));
            (stages, a, out)
        });
        let total = start.elapsed().as_secs_f64();
        let all = stages.into_iter().chain([("total", total)]);
        if repeat == 0 {
            best = all.collect();
            println!(
                "{} triangles; {} vertices, {} faces, {} patches, {} cells, {} pairs; union {} triangles",
                input,
                a.vertex_count(),
                a.face_count(),
                a.patch_count(),
                a.cell_count(),
                a.resolved.pair_count,
                out.triangles.len()
            );
            println!("{:.0} MB peak, {before:.0} of them before", peak());
        } else {
            best.iter_mut().zip(all).for_each(|(b, s)| b.1 = b.1.min(s.1));
        }
    }
    best.iter().for_each(|(name, seconds)| println!("{name:>20} {:9.3} ms", seconds * 1e3));
}

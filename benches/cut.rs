//! Times a cut per stage, in memory, minimum of repeats, on one thread: `cargo bench --bench cut -- MESH [A N | R N] [repeats]`.

use lapidary::base::Run;
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::Plane;
use lapidary::mesh::{MeshInput, MeshOptions, build};
use std::sync::Arc;

#[path = "../tests/common/mod.rs"]
mod common;
use common::random::Random;

fn planes(kind: &str, count: usize, bbox: [[f64; 3]; 2]) -> Vec<Plane> {
    let [low, high] = bbox;
    if kind == "A" {
        let at = |a: usize, i: usize| low[a] + (high[a] - low[a]) * i as f64 / (count - 1) as f64;
        let plane = |a: usize, i: usize| Plane { n: std::array::from_fn(|j| (j == a) as u8 as f64), d: -at(a, i) };
        return (0..3).flat_map(|a| (0..count).map(move |i| plane(a, i))).collect();
    }
    let mut random = Random(1);
    let mut one = || {
        let n: [f64; 3] = std::array::from_fn(|_| 2.0 * random.unit() - 1.0);
        let x: [f64; 3] = std::array::from_fn(|a| low[a] + (high[a] - low[a]) * random.unit());
        Plane { n, d: -(n[0] * x[0] + n[1] * x[1] + n[2] * x[2]) }
    };
    (0..count).map(|_| one()).collect()
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let [file, kind, count, rest @ ..] = &args[..] else {
        println!("usage: MESH (A|R) COUNT [REPEATS]");
        return;
    };
    let count: usize = count.parse().expect("COUNT is a number");
    let repeats: usize = rest.first().map_or(5, |r| r.parse().expect("REPEATS is a number"));
    let soup = common::read_mesh(std::path::Path::new(file)).expect("a mesh");
    let input = MeshInput { vertices: &soup.vertices, triangles: &soup.triangles, tags: None };
    let threads = std::env::var("THREADS").ok().and_then(|t| t.parse().ok()).unwrap_or(1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let _keeper = lapidary::base::blocks::Keeper::new();
    let mut best: Vec<(&'static str, f64)> = Vec::new();
    let mut total = f64::INFINITY;
    for _ in 0..repeats {
        let start = std::time::Instant::now();
        let (mesh_time, result) = pool.install(|| {
            let mesh = Arc::new(build(&input, &MeshOptions::default(), &mut Run::quiet()).expect("a valid mesh"));
            let mesh_time = start.elapsed().as_secs_f64();
            let planes = planes(kind, count, mesh.bbox);
            (mesh_time, cut(&mesh, &planes, &CutOptions::default(), &mut Run::quiet()).expect("a cut"))
        });
        let elapsed = start.elapsed().as_secs_f64();
        total = total.min(elapsed);
        let stages: Vec<_> = std::iter::once(("mesh", mesh_time)).chain(result.stages).collect();
        if best.is_empty() {
            let c = &result.complex;
            println!(
                "{} vertices, {} edges, {} faces, {} cells",
                c.vertex_count(),
                c.edge_count(),
                c.face_count(),
                c.cell_count()
            );
            best = stages;
        } else {
            best.iter_mut().zip(stages).for_each(|(b, s)| b.1 = b.1.min(s.1));
        }
    }
    best.iter().for_each(|(name, seconds)| println!("{name:>12} {:9.3} ms", seconds * 1e3));
    println!("{:>12} {:9.3} ms", "total", total * 1e3);
}

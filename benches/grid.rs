//! Times cutting a grid and its arrays per stage, in memory, minimum of repeats:
//! `cargo bench --bench grid -- [LEVEL N (inside|outside) [REPEATS]]`. Without arguments, an icosphere of level 6 on 64³ to 512³
//! boxes, inside and outside. `THREADS` sets the number of threads (1).
//!
//! Prints the sum of fractions times box volumes against the exact volume of the mesh, as a relative error, and the
//! peak memory of the process; for one configuration's own peak, give it as arguments.

use lapidary::base::Run;
use lapidary::complex::exact_values::mesh_volume;
use lapidary::grid::aggregate::{AggregateOptions, aggregate};
use lapidary::grid::full_faces::{full_faces, full_links};
use lapidary::grid::moments::{GridMoments, moments};
use lapidary::grid::regions::regions;
use lapidary::grid::{FULL, GridCells, GridOptions, Lattice, cut_grid};
use lapidary::mesh::{MeshInput, MeshOptions, build};
use rug::Rational;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

/// An icosahedron with each triangle split in four `level` times, vertices on the unit sphere.
fn icosphere(level: usize) -> (Vec<[f64; 3]>, Vec<[i32; 3]>) {
    let t = (1.0 + 5f64.sqrt()) / 2.0;
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    for (a, b) in [(-1.0, t), (1.0, t), (-1.0, -t), (1.0, -t)] {
        vertices.push([a, b, 0.0]);
    }
    for (a, b) in [(-1.0, t), (1.0, t), (-1.0, -t), (1.0, -t)] {
        vertices.push([0.0, a, b]);
    }
    for (a, b) in [(t, -1.0), (t, 1.0), (-t, -1.0), (-t, 1.0)] {
        vertices.push([a, 0.0, b]);
    }
    let unit = |x: [f64; 3]| {
        let r = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
        x.map(|c| c / r)
    };
    vertices.iter_mut().for_each(|x| *x = unit(*x));
    let mut triangles: Vec<[i32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..level {
        let mut middles: HashMap<[i32; 2], i32> = HashMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for t in &triangles {
            let m = [0, 1, 2].map(|i| {
                let (a, b) = (t[i].min(t[(i + 1) % 3]), t[i].max(t[(i + 1) % 3]));
                *middles.entry([a, b]).or_insert_with(|| {
                    let (p, q) = (vertices[a as usize], vertices[b as usize]);
                    vertices.push(unit(std::array::from_fn(|k| p[k] + q[k])));
                    vertices.len() as i32 - 1
                })
            });
            finer.extend([[t[0], m[0], m[2]], [t[1], m[1], m[0]], [t[2], m[2], m[1]], m]);
        }
        triangles = finer;
    }
    (vertices, triangles)
}

/// Seconds that this thread has been running, for a machine that is not quiet.
fn processor_time() -> f64 {
    let mut t = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the structure is valid for writing, which is all that the call asks for.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut t) };
    t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9
}

/// The process' peak memory in megabytes, where the system tells.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM")).unwrap_or("");
    line.split_whitespace().nth(1).and_then(|x| x.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

/// Relative error of the fractions' sum. Box volumes of the grid are equal but for roundings, so they count one by one;
/// Neumaier's sum keeps the roundings of 10⁸ terms out of the figure.
fn volume_error(g: &GridCells, m: &GridMoments, exact: &Rational) -> f64 {
    let (mut sum, mut low) = (0.0f64, 0.0f64);
    let mut add = |x: f64| {
        let s: f64 = sum + x;
        low += if sum.abs() >= x.abs() { (sum - s) + x } else { (x - s) + sum };
        sum = s;
    };
    let widths: [Vec<f64>; 3] = std::array::from_fn(|a| g.lattice.nodes[a].windows(2).map(|w| w[1] - w[0]).collect());
    let [nx, ny, nz] = std::array::from_fn(|a| g.lattice.count(a));
    for k in 0..nz {
        for j in 0..ny {
            let row = nx * (j + ny * k);
            for i in 0..nx {
                if g.flags[row + i] == FULL {
                    add(widths[0][i] * widths[1][j] * widths[2][k]);
                }
            }
        }
    }
    for (b, cells) in g.cut_boxes.iter().zip(g.box_cells.windows(2)) {
        let [i, j, k] = g.lattice.box_at(*b);
        for c in cells[0]..cells[1] {
            add(m.cell_fraction[c as usize] * (widths[0][i] * widths[1][j] * widths[2][k]));
        }
    }
    let total = Rational::from_f64(sum).unwrap() + Rational::from_f64(low).unwrap();
    let error = (total - exact) / exact.clone();
    error.to_f64()
}

fn measure(level: usize, n: usize, outside: bool, repeats: usize) {
    let (vertices, triangles) = icosphere(level);
    let input = MeshInput { vertices: &vertices, triangles: &triangles, tags: None };
    let mesh = Arc::new(build(&input, &MeshOptions::default(), &mut Run::quiet()).expect("a valid mesh"));
    let nodes: Vec<f64> = (0..=n).map(|i| -1.1 + 2.2 * i as f64 / n as f64).collect();
    let lattice = Lattice::new([&nodes; 3], [0; 3], [n as i64; 3]).expect("a grid");
    let options = GridOptions { outside, ..Default::default() };
    let mut best: Vec<(&'static str, f64)> = Vec::new();
    let mut last = None;
    for _ in 0..repeats {
        // One grid at a time counts towards the peak.
        drop(last.take());
        let mut times = Vec::new();
        let mut run = Run::quiet();
        let g = cut_grid(&mesh, lattice.clone(), &options, &mut run).expect("a grid that can be cut");
        times.extend(run.take_stages());
        let cut: f64 = times.iter().map(|t| t.1).sum();
        times.push(("CUT", cut));
        fn time(times: &mut Vec<(&'static str, f64)>, name: &'static str, start: Instant) {
            times.push((name, start.elapsed().as_secs_f64()));
        }
        let start = Instant::now();
        let m = moments(&g);
        time(&mut times, "MOMENTS", start);
        let after = peak();
        let (start, busy) = (Instant::now(), processor_time());
        assert!(moments(&g) == m);
        time(&mut times, "MOMENTS again", start);
        times.push(("processor time of that", processor_time() - busy));
        let start = Instant::now();
        let r = regions(&g);
        time(&mut times, "regions", start);
        let start = Instant::now();
        let a = aggregate(&g, &m, &AggregateOptions { minimum: 0.3 }, None, None);
        time(&mut times, "aggregate", start);
        let start = Instant::now();
        let links = full_links(&g);
        time(&mut times, "links", start);
        let start = Instant::now();
        let plane = full_faces(&g, 0, n / 2);
        time(&mut times, "one plane's full faces", start);
        println!(
            "  {} regions, {} lone aggregates, {} links, {} full faces in the middle plane; peak {after:.0} MB with moments",
            r.count,
            a.too_small.len(),
            links.cell.len(),
            plane.low_node.len()
        );
        if best.is_empty() {
            best = times;
        } else {
            best.iter_mut().zip(times).for_each(|(b, s)| b.1 = b.1.min(s.1));
        }
        last = Some((g, m));
    }
    let (g, m) = last.expect("at least one repeat");
    let side = if outside { "outside" } else { "inside" };
    println!("icosphere {level} ({} triangles), {n}³ boxes, {side}:", triangles.len());
    println!(
        "  {} cut boxes, {} cells, {} walls, {} plane faces, {} vertices; by rationals: {} cells, {} faces",
        g.cut_boxes.len(),
        g.cell_count(),
        g.wall_count(),
        g.square_node.len(),
        g.coords.len(),
        m.exact_cells,
        m.exact_faces
    );
    for (name, seconds) in &best {
        println!("  {name:>24} {:10.3} ms", seconds * 1e3);
    }
    let mut exact = mesh_volume(&mesh);
    if outside {
        let size = Rational::from_f64(nodes[n]).unwrap() - Rational::from_f64(nodes[0]).unwrap();
        exact = Rational::from(&size * &size) * &size - exact;
    }
    println!("  relative error of the volume {:.2e}", volume_error(&g, &m, &exact));
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let threads = std::env::var("THREADS").ok().and_then(|t| t.parse().ok()).unwrap_or(1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let number = |i: usize, or: usize| args.get(i).map_or(or, |a| a.parse().expect("a number"));
    pool.install(|| {
        if args.is_empty() {
            for n in [64, 128, 256, 512] {
                measure(6, n, false, 1);
                measure(6, n, true, 1);
            }
        } else {
            measure(number(0, 6), number(1, 64), args.get(2).is_some_and(|a| a == "outside"), number(3, 1));
        }
    });
}

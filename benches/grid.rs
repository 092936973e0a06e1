//! Times cutting a grid and its arrays, in memory, minimum of repeats:
//!
//! `cargo bench --bench grid -- host LEVEL N (inside|outside) [REPEATS]`: an icosphere on N³ boxes as a host has it, through the C functions:
//! `lap_grid_new`, then fractions and centroids of cells and of faces in grid planes; nothing else runs.
//!
//! `cargo bench --bench grid -- [LEVEL N (inside|outside) [REPEATS]]`: stage by stage, from Rust, and what else can be asked for. Without
//! arguments, an icosphere of level 6 on 64³ to 512³ boxes, inside and outside.
//!
//! `THREADS` sets the number of threads (1). Both print the sum of fractions times box volumes against the exact volume of the mesh, as a
//! relative error, and the peak memory of the process; for one configuration's own peak, give it as arguments.

#[path = "../tests/common/icosphere.rs"]
mod icosphere;

use icosphere::icosphere;
use lapidary::base::Run;
use lapidary::capi::{context::*, grid::*, grid_boxes::*, grid_moments::*, mesh::*};
use lapidary::complex::exact_values::mesh_volume;
use lapidary::grid::aggregate::{AggregateOptions, aggregate};
use lapidary::grid::boundaries::boundaries;
use lapidary::grid::full_faces::{full_faces, full_links};
use lapidary::grid::moments::moments;
use lapidary::grid::regions::regions;
use lapidary::grid::{FULL, GridOptions, Lattice, cut_grid};
use lapidary::mesh::{MeshInput, MeshOptions, TriMesh, build};
use rug::Rational;
use std::ptr::{null, null_mut};
use std::sync::Arc;
use std::time::Instant;

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
fn volume_error(nodes: [&[f64]; 3], flags: &[u8], cells: impl Iterator<Item = (usize, f64)>, exact: &Rational) -> f64 {
    let (mut sum, mut low) = (0.0f64, 0.0f64);
    let mut add = |x: f64| {
        let s: f64 = sum + x;
        low += if sum.abs() >= x.abs() { (sum - s) + x } else { (x - s) + sum };
        sum = s;
    };
    let widths = nodes.map(|n| n.windows(2).map(|w| w[1] - w[0]).collect::<Vec<f64>>());
    let [nx, ny, _] = [0, 1, 2].map(|a| widths[a].len());
    let volume = |b: usize| widths[0][b % nx] * widths[1][b / nx % ny] * widths[2][b / nx / ny];
    for (row, flags) in flags.chunks(nx).enumerate() {
        let area = widths[1][row % ny] * widths[2][row / ny];
        flags.iter().zip(&widths[0]).filter(|(f, _)| **f == FULL).for_each(|(_, w)| add(w * area));
    }
    cells.for_each(|(b, fraction)| add(fraction * volume(b)));
    let total = Rational::from_f64(sum).unwrap() + Rational::from_f64(low).unwrap();
    let error = (total - exact) / exact.clone();
    error.to_f64()
}

/// The exact volume of the fluid in a grid that holds the whole mesh.
fn fluid_volume(mesh: &TriMesh, nodes: &[f64], outside: bool) -> Rational {
    let volume = mesh_volume(mesh);
    if !outside {
        return volume;
    }
    let size = Rational::from_f64(nodes[nodes.len() - 1]).unwrap() - Rational::from_f64(nodes[0]).unwrap();
    Rational::from(&size * &size) * &size - volume
}

fn uniform(n: usize) -> Vec<f64> {
    (0..=n).map(|i| -1.1 + 2.2 * i as f64 / n as f64).collect()
}

/// An array that a C function hands out.
fn borrowed<'a, T>(data: *const T, count: i64) -> &'a [T] {
    assert!(count == 0 || !data.is_null());
    // SAFETY: the library says that so many values are there, until the grid is freed; callers use them before that.
    if count == 0 { &[] } else { unsafe { std::slice::from_raw_parts(data, count as usize) } }
}

/// What a host does to get the arrays of a solver: a mesh, a grid, fractions and centroids.
fn host(level: usize, n: usize, outside: bool, repeats: usize, threads: i32) {
    let (vertices, triangles) = icosphere(level);
    let nodes = uniform(n);
    let count = nodes.len() as i64;
    let (mut context, mut mesh) = (null_mut(), null_mut());
    // SAFETY: pointers are valid for the calls, or NULL where the header allows it; handles are freed once, last.
    unsafe {
        assert_eq!(lap_context_new(&mut context), 0);
        assert_eq!(lap_context_set_threads(context, threads), 0);
        let (xyz, indices) = (vertices.as_ptr().cast(), triangles.as_ptr().cast());
        let (n_vertices, n_triangles) = (vertices.len() as i64, triangles.len() as i64);
        assert_eq!(lap_mesh_new(context, n_vertices, xyz, n_triangles, indices, null(), null(), &mut mesh), 0);
        drop((vertices, triangles));
        let exact = fluid_volume(&(*mesh).mesh, &nodes, outside);
        let mut options = std::mem::zeroed();
        assert_eq!(lap_grid_options_init(&mut options, size_of::<lap_grid_options>() as i32), 0);
        options.outside = outside as i32;
        let (mut cutting, mut arrays, mut both) = (f64::MAX, f64::MAX, f64::MAX);
        for last in (0..repeats).rev() {
            let mut grid = null_mut();
            let start = Instant::now();
            let [x, y, z] = [nodes.as_ptr(); 3];
            assert_eq!(lap_grid_new(context, mesh, count, x, count, y, count, z, &options, &mut grid), 0);
            let cut = start.elapsed().as_secs_f64();
            let (mut cells, mut fractions, mut centroids) = (0, null(), null());
            assert_eq!(
                lap_grid_cell_moments(grid, &mut cells, null_mut(), &mut fractions, &mut centroids, null_mut()),
                0
            );
            let (mut faces, mut area_fractions, mut face_centroids) = (0, null(), null());
            assert_eq!(
                lap_grid_plane_face_moments(
                    grid,
                    &mut faces,
                    null_mut(),
                    &mut area_fractions,
                    &mut face_centroids,
                    null_mut()
                ),
                0
            );
            let all = start.elapsed().as_secs_f64();
            (cutting, arrays, both) = (cutting.min(cut), arrays.min(all - cut), both.min(all));
            if last == 0 {
                let peak = peak();
                let (mut boxes, mut flags) = (0, null());
                assert_eq!(lap_grid_flags(grid, &mut boxes, &mut flags), 0);
                let (mut cut_count, mut cut_boxes, mut offsets) = (0, null(), null());
                assert_eq!(lap_grid_cut_boxes(grid, &mut cut_count, &mut cut_boxes, &mut offsets), 0);
                let (cut_boxes, offsets) = (borrowed(cut_boxes, cut_count), borrowed(offsets, cut_count + 1));
                let fractions = borrowed(fractions, cells);
                let parts = cut_boxes
                    .iter()
                    .zip(offsets.windows(2))
                    .flat_map(|(b, w)| (w[0]..w[1]).map(move |c| (*b as usize, fractions[c as usize])));
                let error = volume_error([&nodes; 3], borrowed(flags, boxes), parts, &exact);
                let side = if outside { "outside" } else { "inside" };
                println!("icosphere {level} ({n_triangles} triangles), {n}³ boxes, {side}, through lap_grid:");
                println!("  {cut_count} cut boxes, {cells} cells, {faces} faces in grid planes; threads: {threads}");
                println!(
                    "  cutting {cutting:.3} s, arrays {arrays:.3} s, together {both:.3} s; peak memory {peak:.0} MB"
                );
                println!("  relative error of the sum of fractions times box volumes: {error:.2e}");
                assert!(error.abs() <= 1e-12);
            }
            assert_eq!(lap_grid_free(grid), 0);
        }
        assert_eq!(lap_mesh_free(mesh), 0);
        assert_eq!(lap_context_free(context), 0);
    }
}

fn measure(level: usize, n: usize, outside: bool, repeats: usize) {
    let (vertices, triangles) = icosphere(level);
    let input = MeshInput { vertices: &vertices, triangles: &triangles, tags: None };
    let mesh = Arc::new(build(&input, &MeshOptions::default(), &mut Run::quiet()).expect("a valid mesh"));
    let nodes = uniform(n);
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
        let walls = boundaries(&g, &m);
        time(&mut times, "boundaries", start);
        assert_eq!(walls.area.len(), g.cell_count());
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
    let exact = fluid_volume(&mesh, &nodes, outside);
    let boxes = g.cut_boxes.iter().zip(g.box_cells.windows(2));
    let cells = boxes.flat_map(|(b, w)| (w[0]..w[1]).map(|c| (b.at(), m.cell_fraction[c as usize])));
    println!("  relative error of the volume {:.2e}", volume_error([&nodes; 3], &g.flags, cells, &exact));
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let threads = std::env::var("THREADS").ok().and_then(|t| t.parse().ok()).unwrap_or(1);
    let number = |i: usize, or: usize| args.get(i).map_or(or, |a| a.parse().expect("a number"));
    let outside = args.iter().any(|a| a == "outside");
    if args.first().is_some_and(|a| a == "host") {
        host(number(1, 6), number(2, 64), outside, number(4, 1), threads as i32);
        return;
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        if args.is_empty() {
            for n in [64, 128, 256, 512] {
                measure(6, n, false, 1);
                measure(6, n, true, 1);
            }
        } else {
            measure(number(0, 6), number(1, 64), outside, number(3, 1));
        }
    });
}

//! Seconds per stage from node values to vertices and polygons, or on to regions, the minimum of repeats, and the peak memory of the process.

#[path = "../../tests/common/functions.rs"]
pub mod functions;

use lapidary::base::Run;
use lapidary::base::blocks::Keeper;
use lapidary::network::local::Setting;
use lapidary::network::regions::Method;
use lapidary::network::topology::find_topology;
use lapidary::network::{BoxGrid, Domain, Kind, Values, extract};
use std::path::Path;

fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM")).unwrap_or("");
    line.split_whitespace().nth(1).and_then(|n| n.parse::<f64>().ok()).unwrap_or(f64::NAN) / 1024.0
}

pub fn main(arguments: &[String], regions: bool) {
    let [file, n, rest @ ..] = arguments else { panic!("FILE N") };
    let n: u32 = n.parse().expect("a number of cubes");
    let number = |i: usize, default: usize| rest.get(i).map_or(default, |t| t.parse().expect("a number"));
    let (threads, repeats) = (number(0, 1), number(1, 5));
    let kind = match rest.get(2).map(String::as_str) {
        Some("mi") => Kind::Interface,
        Some(_) => Kind::Arrangement,
        None if file.contains("mi-") => Kind::Interface,
        None => Kind::Arrangement,
    };
    let grid = BoxGrid::new([n; 3], Some([[-1.0; 3], [1.0; 3]])).expect("a box");
    let values = functions::sphere_values(&grid, &functions::read_spheres(Path::new(file)));
    let before = peak();
    let arrays: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
    let values = Values { functions: &arrays, stride: 1 };
    let domain = Domain::Box(grid);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let _keeper = Keeper::new();
    let mut best: Vec<(&str, f64)> = Vec::new();
    let mut least = f64::INFINITY;
    for _ in 0..repeats {
        let start = std::time::Instant::now();
        let network = pool.install(|| {
            let mut run = Run::quiet();
            let network = extract(&domain, &values, kind, &mut run).expect("a network");
            let setting = Setting { network: &network, domain: &domain, values };
            let topology = regions.then(|| find_topology(&setting, Method::Automatic, &mut run).expect("regions"));
            (network, topology, run.take_stages())
        });
        let seconds = start.elapsed().as_secs_f64();
        let (network, topology, stages) = network;
        least = least.min(seconds);
        if best.is_empty() {
            let active: u64 = network.active.iter().sum();
            println!(
                "active {active} {:?}, vertices {}, polygons {}, corners {}",
                network.active,
                network.vertex_count(),
                network.polygon_count(),
                network.polygons.items.len()
            );
            if let Some(t) = topology {
                println!(
                    "edges {}, patches {}, chains {}, corners {}, shells {}, components {}, regions {}",
                    t.edges.len(),
                    t.patches.len(),
                    t.chains.len(),
                    t.chains.corners.len(),
                    t.shells.len(),
                    t.patches.component_count,
                    t.regions.len()
                );
            }
            best = stages;
        } else {
            best.iter_mut().zip(stages).for_each(|(b, s)| b.1 = b.1.min(s.1));
        }
    }
    for (name, seconds) in &best {
        println!("{name:>12} {:8.1} ms", seconds * 1e3);
    }
    println!(
        "{:>12} {:8.1} ms, {threads} threads; peak {:.0} MB, before it {before:.0} MB",
        "all",
        least * 1e3,
        peak()
    );
}

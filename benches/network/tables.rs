//! Look-ups for batches of simplices: nanoseconds for one table entry with its symmetry, for polygons read in place, and for the complex
//! written out; and what the incremental construction takes. Best of several rounds. An argument keeps the lines that contain it.

use lapidary::network::simplex::tables::{find_arrangement_1, find_arrangement_2, find_interface_2, find_interface_3};
use lapidary::network::simplex::{
    FaceSupport, Found, Kind, Scratch, SimplexComplex, View, arrangement_incremental, find_table, interface_incremental,
};
use std::hint::black_box;
use std::time::Instant;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }
    fn unit(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 30) as f64 - 1.0
    }
}

const COUNT: usize = 4096;
const ROUNDS: usize = 60;

/// Nanoseconds per simplex.
fn best(mut run: impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        run();
        best = best.min(start.elapsed().as_nanos() as f64 / COUNT as f64);
    }
    best
}

fn measure(wanted: &[String], name: &str, kind: Kind, n: usize, mut value: impl FnMut(&mut Random) -> f64) {
    if wanted.first().is_some_and(|w| !name.contains(w)) {
        return;
    }
    let mut r = Random(1);
    let mut values: Vec<[f64; 4]> = vec![];
    while values.len() < n * COUNT {
        let f: [f64; 4] = std::array::from_fn(|_| value(&mut r));
        // Functions that cross.
        if kind == Kind::Interface || f.iter().any(|&x| x > 0.0) && f.iter().any(|&x| x < 0.0) {
            values.push(f);
        }
    }
    let mut found: Vec<Found> = Vec::with_capacity(COUNT);
    let look_up = best(|| {
        found.clear();
        found.extend(black_box(&values).chunks_exact(n).map(|v| match (kind, v) {
            (Kind::Arrangement, [f]) => find_arrangement_1(f),
            (Kind::Arrangement, [f, g]) => find_arrangement_2(f, g),
            (_, [f, g]) => find_interface_2(f, g),
            (_, [f, g, h]) => find_interface_3(f, g, h),
            _ => unreachable!(),
        }));
        black_box(&found);
    });
    let mut points: Vec<(u8, u8)> = vec![];
    let polygons = best(|| {
        points.clear();
        for &found in black_box(&found) {
            let view = View::new(found);
            for f in 0..view.entry.faces.len() {
                let face = view.face(f);
                if !matches!(face.support, FaceSupport::Facet(_)) {
                    points.extend(face.vertices().map(|v| {
                        let (carrier, functions) = view.vertex(v);
                        (carrier.0, functions)
                    }));
                }
            }
        }
        black_box(&points);
    });
    let (mut scratch, mut complex) = (Scratch::default(), SimplexComplex::default());
    let whole = best(|| {
        for v in black_box(&values).chunks_exact(n) {
            View::new(find_table(kind, 3, v.as_flattened()).expect("a table")).fill(&mut complex);
            black_box(&complex);
        }
    });
    let build = if kind == Kind::Arrangement { arrangement_incremental } else { interface_incremental };
    let incremental = best(|| {
        for v in black_box(&values).chunks_exact(n) {
            build(3, v.as_flattened(), &mut scratch, &mut complex);
            black_box(&complex);
        }
    });
    println!("{name:<34}{look_up:9.1}{polygons:12.1}{whole:12.1}{incremental:14.1}");
}

pub fn main(wanted: &[String]) {
    println!(
        "{:<34}{:>9}{:>12}{:>12}{:>14}",
        "ns for one tetrahedron", "look-up", "polygons", "written out", "incremental"
    );
    let functions = [(Kind::Arrangement, 1), (Kind::Arrangement, 2), (Kind::Interface, 2), (Kind::Interface, 3)];
    for (kind, n) in functions {
        let name = match kind {
            Kind::Arrangement => format!("arrangement, {n} crossing"),
            Kind::Interface => format!("interface, {n} random"),
        };
        measure(wanted, &name, kind, n, Random::unit);
        measure(wanted, &format!("{name}, -1 0 1"), kind, n, |r| (r.next() % 3) as f64 - 1.0);
    }
}

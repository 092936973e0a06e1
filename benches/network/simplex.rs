//! Single tetrahedra (and triangles) by the incremental construction: the time of one call, mean over many inputs, best of
//! several rounds. An argument keeps the lines that contain it.

use lapidary::network::simplex::{
    Scratch, SimplexComplex, arrangement as with_tables, arrangement_incremental as arrangement,
    interface_incremental as interface,
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

type Build = fn(usize, &[f64], &mut Scratch, &mut SimplexComplex);

type Input<'a> = &'a dyn Fn(&mut Random) -> Vec<f64>;

type Shape = (usize, usize, Build, usize);

fn measure(wanted: &[String], name: &str, (count, rounds, build, dim): Shape, input: impl Fn(&mut Random) -> Vec<f64>) {
    if wanted.first().is_some_and(|w| !name.contains(w)) {
        return;
    }
    let mut r = Random(1);
    let inputs: Vec<Vec<f64>> = (0..count).map(|_| input(&mut r)).collect();
    let (mut scratch, mut complex) = (Scratch::default(), SimplexComplex::default());
    let mut best = f64::INFINITY;
    let mut cells = 0;
    for _ in 0..rounds {
        let start = Instant::now();
        cells = 0;
        for values in &inputs {
            build(dim, black_box(values), &mut scratch, &mut complex);
            cells += black_box(&complex).cell_count();
        }
        best = best.min(start.elapsed().as_nanos() as f64 / count as f64);
    }
    println!("{name:<44} {:10.2} us {:12.1} cells", best / 1000.0, cells as f64 / count as f64);
}

pub fn main(wanted: &[String]) {
    let reals = |n: usize, dim: usize| move |r: &mut Random| (0..n * (dim + 1)).map(|_| r.unit()).collect::<Vec<f64>>();
    let small = |n: usize| move |r: &mut Random| (0..n * 4).map(|_| (r.next() % 3) as f64 - 1.0).collect::<Vec<f64>>();
    // Every function crosses: its signs at the corners are not all alike.
    let crossing = |n: usize| {
        move |r: &mut Random| {
            let mut values = Vec::with_capacity(4 * n);
            while values.len() < 4 * n {
                let f: [f64; 4] = std::array::from_fn(|_| r.unit());
                if f.iter().any(|&x| x > 0.0) && f.iter().any(|&x| x < 0.0) {
                    values.extend(f);
                }
            }
            values
        }
    };
    // As networks and batches ask: the first two of them from a table.
    for n in [3, 10] {
        for (name, input) in [("random", &reals(n, 3) as Input), ("crossing", &crossing(n))] {
            measure(wanted, &format!("arrangement, {n} {name}, tables"), (512, 40, with_tables, 3), input);
        }
    }
    for n in [1, 2, 3, 10, 30, 100] {
        let (count, rounds) = if n < 30 { (512, 40) } else { (4, 5) };
        measure(wanted, &format!("arrangement, {n} random"), (count, rounds, arrangement, 3), reals(n, 3));
        measure(wanted, &format!("arrangement, {n} crossing"), (count, rounds, arrangement, 3), crossing(n));
        measure(wanted, &format!("interface, {n} random"), (count, rounds, interface, 3), reals(n, 3));
    }
    // All through the centre; all through one line. Their values are short, so sums and multiples are exact.
    let short = |r: &mut Random| (r.next() % 4096) as f64 - 2048.0;
    let point = |n: usize| {
        move |r: &mut Random| {
            let f = |r: &mut Random| {
                let [a, b, c] = [short(r), short(r), short(r)];
                [a, b, c, -a - b - c]
            };
            (0..n).flat_map(|_| f(r)).collect::<Vec<f64>>()
        }
    };
    let line = |n: usize| {
        move |r: &mut Random| {
            let f = |k: f64, l: f64| [k + l, l - k, k - l, -k - l];
            (0..n).flat_map(|_| f(short(r), short(r))).collect::<Vec<f64>>()
        }
    };
    for n in [4, 30] {
        measure(wanted, &format!("arrangement, {n} through a point"), (16, 10, arrangement, 3), point(n));
        measure(wanted, &format!("arrangement, {n} through a line"), (16, 10, arrangement, 3), line(n));
        measure(wanted, &format!("interface, {n} equal at a point"), (16, 10, interface, 3), point(n));
    }
    measure(wanted, "interface, 1000 random", (2, 3, interface, 3), reals(1000, 3));
    for n in [3, 10] {
        measure(wanted, &format!("arrangement, {n} in -1, 0, 1"), (512, 20, arrangement, 3), small(n));
        measure(wanted, &format!("interface, {n} in -1, 0, 1"), (512, 20, interface, 3), small(n));
        measure(wanted, &format!("arrangement, {n} random, triangle"), (512, 20, arrangement, 2), reals(n, 2));
        measure(wanted, &format!("interface, {n} random, triangle"), (512, 20, interface, 2), reals(n, 2));
    }
}

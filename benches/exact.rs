//! Nanoseconds per predicate and tier: `cargo bench --bench exact`. Generic input (filters decide) and degenerate input
//! (exact zeros); the best of several rounds over the same inputs. An argument keeps the lines that contain it.

use lapidary::exact::planes::group;
use lapidary::exact::predicates::*;
use lapidary::exact::tiers::{big_sign, bounded_sign, exact_sign};
use lapidary::exact::*;
use std::hint::black_box;
use std::time::Instant;

const INPUTS: usize = 512;
const ROUNDS: usize = 40;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 11
    }
    fn unit(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn vector(&mut self) -> [f64; 3] {
        [self.unit(), self.unit(), self.unit()]
    }
    /// Twelve bits: products and sums of three are exact in doubles.
    fn short(&mut self) -> [f64; 3] {
        self.vector().map(|x| (x * 2048.0).round() / 2048.0)
    }
    fn plane(&mut self) -> Plane {
        Plane { n: self.vector(), d: self.unit() / 8.0 }
    }
}

fn measure<T, R>(name: &str, inputs: &[T], f: impl Fn(&T) -> R) {
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    if wanted.is_some_and(|w| !name.contains(&w)) {
        return;
    }
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        for x in inputs {
            black_box(f(black_box(x)));
        }
        best = best.min(start.elapsed().as_nanos() as f64 / inputs.len() as f64);
    }
    println!("{name:<52} {best:8.1} ns");
}

fn inputs<T>(seed: u64, f: impl Fn(&mut Random) -> T) -> Vec<T> {
    let mut r = Random(seed);
    (0..INPUTS).map(|_| f(&mut r)).collect()
}

fn main() {
    // A plane exactly through a point.
    let through = |r: &mut Random, v: &[f64; 3]| {
        let n = r.short();
        Plane { n, d: -(n[0] * v[0] + n[1] * v[1] + n[2] * v[2]) }
    };

    let generic = inputs(1, |r| (r.plane(), r.vector()));
    let zero = inputs(2, |r| {
        let v = r.short();
        (through(r, &v), v)
    });
    measure("side, generic", &generic, |(p, v)| side(p, v));
    measure("side, generic: bounded alone", &generic, |(p, v)| bounded_sign(&Side(p, v)));
    measure("side, generic: exact alone", &generic, |(p, v)| exact_sign(&Side(p, v)));
    measure("side, generic: any size alone", &generic, |(p, v)| big_sign(&Side(p, v)));
    measure("side, zero", &zero, |(p, v)| side(p, v));
    let filters: Vec<_> = generic.iter().map(|(p, v)| (PlaneFilter::new(p, &[1.0; 3]), *v)).collect();
    measure("side, generic: static filter", &filters, |(f, v)| f.exact_side(v));

    let edges = inputs(3, |r| (r.vector(), r.vector(), r.plane(), r.plane()));
    let ties = inputs(4, |r| {
        let (a, b) = (r.short(), r.short());
        let m = std::array::from_fn(|i| (a[i] + b[i]) / 2.0);
        (a, b, through(r, &m), through(r, &m))
    });
    measure("edge order, generic", &edges, |(a, b, p, q)| compare_on_edge(a, b, p, q));
    measure("edge order, generic: exact alone", &edges, |(a, b, p, q)| exact_sign(&EdgeOrder(a, b, p, q)));
    measure("edge order, tie", &ties, |(a, b, p, q)| compare_on_edge(a, b, p, q));

    let triangles = inputs(5, |r| ([r.vector(), r.vector(), r.vector()], r.plane(), r.plane(), r.plane()));
    let concurrent = inputs(6, |r| {
        let t = [r.short(), r.short(), r.short()];
        let m = std::array::from_fn(|i| (t[0][i] + t[1][i]) / 4.0 + t[2][i] / 2.0);
        (t, through(r, &m), through(r, &m), through(r, &m))
    });
    measure("triangle order, generic", &triangles, |(t, p, q, r)| triangle_determinant(t, p, q, r));
    measure("triangle order, generic: bounded alone", &triangles, |(t, p, q, r)| {
        bounded_sign(&TriangleOrder(t, p, q, r))
    });
    measure("triangle order, generic: exact alone", &triangles, |(t, p, q, r)| exact_sign(&TriangleOrder(t, p, q, r)));
    measure("triangle order, generic: any size alone", &triangles, |(t, p, q, r)| big_sign(&TriangleOrder(t, p, q, r)));
    measure("triangle order, concurrent (zero)", &concurrent, |(t, p, q, r)| triangle_determinant(t, p, q, r));

    let normals = inputs(7, |r| [r.vector(), r.vector(), r.vector()].map(Direction::Plane));
    let flat = inputs(8, |r| {
        let (u, v) = (r.short(), r.short());
        [u, v, std::array::from_fn(|i| u[i] + v[i])].map(Direction::Plane)
    });
    measure("determinant of normals, generic", &normals, |[u, v, w]| determinant(u, v, w));
    measure("determinant of normals, zero", &flat, |[u, v, w]| determinant(u, v, w));
    let corners = inputs(9, |r| [r.vector(), r.vector(), r.vector(), r.vector()]);
    measure("orient3d, generic", &corners, |[a, b, c, d]| orient3d(a, b, c, d));
    measure("orient3d, zero", &corners, |[a, b, c, _]| orient3d(a, b, c, a));

    let rows = inputs(10, |r| [r.vector(), r.vector(), r.vector()]);
    measure("3x3 of function values, generic", &rows, |[a, b, c]| {
        determinant_of_rows(&[Row::Values(a), Row::Values(b), Row::Values(c)])
    });
    measure("3x3 of function values, zero", &rows, |[a, b, _]| {
        determinant_of_rows(&[Row::Values(a), Row::Values(b), Row::Difference(a, b)])
    });

    let points = inputs(11, |r| {
        let t = [r.vector(), r.vector(), r.vector()];
        [
            Point::EdgePlane { a: t[0], b: t[1], p: r.plane() },
            Point::TrianglePlanes { t, p: r.plane(), q: r.plane() },
            Point::Planes { p: r.plane(), q: r.plane(), r: r.plane() },
        ]
    });
    for (i, name) in ["edge and plane", "triangle and planes", "three planes"].into_iter().enumerate() {
        let p: Vec<Point> = points.iter().map(|p| p[i]).collect();
        let pairs: Vec<_> = p.iter().copied().zip(p.iter().copied().skip(1)).collect();
        measure(&format!("coordinate order, {name}"), &pairs, |(a, b)| compare_coordinate(a, b, 0));
        measure(&format!("coordinate order, {name}: exact alone"), &pairs, |(a, b)| {
            exact_sign(&CoordinateOrder(a, b, 0))
        });
        let far = Support::Plane(Plane { n: [0.3, 0.4, 0.5], d: 0.1 });
        measure(&format!("point side, {name}"), &p, |p| support_side(&far, p));
        measure(&format!("approximation, {name}"), &p, approx);
        measure(&format!("rounding (three coordinates), {name}"), &p, round);
    }
    // All three coordinates are general; x and y are exact ties.
    let middles = inputs(12, |r| {
        let half = |r: &mut Random| {
            let a = 1.0 + f64::from_bits(0x3ff0_0000_0000_0000 | (r.next() & !1)) - 1.0;
            (a, f64::from_bits(0x3ff0_0000_0000_0000 | (r.next() | 1)))
        };
        let ((ax, bx), (ay, by)) = (half(r), half(r));
        Point::EdgePlane { a: [ax, ay, -1.0], b: [bx, by, 1.0], p: Plane { n: [0.0, 0.0, 1.0], d: 0.0 } }
    });
    measure("rounding, two exact ties", &middles, round);
    measure("exact rational point", &middles, rational);

    let mut r = Random(13);
    let planes: Vec<Plane> = (0..10_000).map(|_| Plane { n: r.vector(), d: r.unit() }).collect();
    let grid: Vec<Plane> = (0..10_000)
        .map(|i| {
            let mut p = Plane { n: [0.0; 3], d: r.unit() };
            p.n[i % 3] = if i % 2 == 0 { 1.0 } else { -1.0 };
            p
        })
        .collect();
    for (name, planes) in [("random", planes), ("of three families", grid)] {
        let start = Instant::now();
        black_box(group(&planes));
        println!("grouping 10 000 planes, {name}: {:.2} ms", start.elapsed().as_secs_f64() * 1e3);
    }
}

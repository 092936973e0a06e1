//! Correct rounding, approximations and exact coordinates of symbolic points, against rationals.

mod exact_reference;

use exact_reference as reference;
use exact_reference::{KINDS, Q, Random, nearest, number, plane, q, q3, symbolic, triangle, vector};
use lapidary::exact::counters::{self, Predicate, Tier};
use lapidary::exact::residue::{PRIMES, point_residues};
use lapidary::exact::*;
use rug::Integer;

fn same_bits(found: f64, expected: f64, what: impl Fn() -> String) {
    assert_eq!(found.to_bits(), expected.to_bits(), "{found:e} {expected:e} {}", what());
}

#[test]
fn rationals_round_to_nearest_even() {
    let mut r = Random(1);
    let tiny = Q::from((1, Integer::from(1) << 3000));
    let (mut n, mut ties) = (0u64, 0u64);
    for i in 0..60_000 {
        let x = match i % 4 {
            0 => f64::from_bits(r.bits()),
            1 => f64::from_bits(r.below(1 << 54)),
            2 => f64::from_bits(0x7fe0_0000_0000_0000 | r.below(1 << 53)),
            _ => f64::from_bits((r.below(2047) << 52) | [0, 1, (1 << 52) - 1][r.below(3) as usize]),
        };
        if !x.is_finite() {
            continue;
        }
        let up = if x.next_up().is_finite() { q(x.next_up()) } else { Q::from(Integer::from(1) << 1024) };
        let middle: Q = Q::from(q(x) + up) / 2;
        let even = if x.to_bits() & 1 == 0 { x } else { x.next_up() };
        same_bits(round_rational(&middle), even + 0.0, || format!("tie above {x:e}"));
        same_bits(round_rational(&Q::from(&middle - &tiny)), x + 0.0, || format!("below the tie above {x:e}"));
        same_bits(round_rational(&Q::from(&middle + &tiny)), x.next_up() + 0.0, || format!("above it, {x:e}"));
        same_bits(round_rational(&q(x)), x + 0.0, || format!("{x:e} itself"));
        ties += 1;
        let any = Q::from((Integer::from(r.bits()), Integer::from(r.bits() | 1))) << (r.below(2200) as i32 - 1100);
        same_bits(round_rational(&any), nearest(&any), || format!("{any}"));
        n += 5;
    }
    same_bits(round_rational(&Q::new()), 0.0, || "zero".into());
    same_bits(round_rational(&-tiny), 0.0, || "zero is +0, from below as well".into());
    println!("{n} rationals, {ties} exact ties");
}

#[test]
fn symbolic_points_round_to_nearest_even() {
    let mut n = 0u64;
    for (kind, name) in KINDS.iter().enumerate() {
        let mut r = Random(2000 + kind as u64);
        for _ in 0..3000 {
            let near = vector(&mut r, kind);
            let (x, exact) = symbolic(&mut r, kind, &near);
            let found = round(&x);
            let rationals = rational(&x);
            let bounds = approx(&x);
            for i in 0..3 {
                let what = || format!("{name} {i} {x:?}");
                assert_eq!(rationals[i], exact[i], "{}", what());
                same_bits(found[i], nearest(&exact[i]), what);
                same_bits(round_rational(&exact[i]), nearest(&exact[i]), what);
                if bounds.err[i].is_finite() {
                    let off = Q::from(&exact[i] - q(bounds.x[i])).abs();
                    assert!(off <= q(bounds.err[i]), "{}", what());
                }
                n += 3;
            }
        }
    }
    println!("{n} coordinates");
}

/// Midpoints of edges with full mantissas: half of the coordinates with neighbouring exponents are exact ties.
#[test]
fn edge_midpoints() {
    let mut r = Random(3);
    let mut ties = 0u64;
    let total = 20_000;
    counters::enable(true);
    counters::take();
    for _ in 0..total {
        let (mut a, mut b) = (vector(&mut r, 0).map(|x| x + 3.0), vector(&mut r, 0).map(|x| x + 3.0));
        (a[2], b[2]) = (-b[2], b[2]);
        let p = Plane { n: [0.0, 0.0, 0.1], d: 0.0 };
        let x = Point::EdgePlane { a, b, p };
        let found = round(&x);
        for k in 0..3 {
            let exact = Q::from(q(a[k]) + q(b[k])) / 2;
            same_bits(found[k], nearest(&exact), || format!("{k} {x:?}"));
            let off = Q::from(&exact - q(found[k]));
            let gap = q(found[k].next_up()) - q(found[k]);
            let gap_below = q(found[k]) - q(found[k].next_down());
            ties += (off == gap / 2 || -off == gap_below / 2) as u64;
        }
    }
    let counts = counters::take();
    counters::enable(false);
    let exact = counts.get(Predicate::Rounding, Tier::Exact);
    println!("{ties} exact ties; {exact} on the stack, {} beyond", counts.get(Predicate::Rounding, Tier::Big));
    assert!(ties > 5_000);
    assert_eq!(counts.get(Predicate::Rounding, Tier::Big), 0);
    assert!(exact >= ties);
}

/// Points on edges and in triangles by axis-parallel planes with normals of length 1 and others: what a Cartesian grid asks for. Mixed
/// magnitudes, exact ties and near ties, subnormals, planes through corners or nearly. Where numbers are ordinary, interpolation must decide.
#[test]
fn points_on_axis_parallel_planes() {
    let mut r = Random(77);
    let unit = |r: &mut Random, kind: usize, axis: usize, at: f64| {
        let mut n = [0.0; 3];
        n[axis] = match kind {
            0..3 => [1.0, -1.0][r.below(2) as usize],
            _ => [0.5, -3.0, 1.0][r.below(3) as usize],
        };
        Plane { n, d: -at * n[axis] }
    };
    let between = |r: &mut Random, a: f64, b: f64| match r.below(4) {
        0 => (a + b) / 2.0,
        1 => a.min(b).next_up(),
        2 => a + (b - a) * 0.125,
        _ => a + (b - a) * r.unit(),
    };
    let (mut n, mut ties) = (0u64, 0u64);
    for i in 0..40_000 {
        let kind = i % 6;
        let magnitude = |r: &mut Random| match kind {
            0 => r.signed(),
            // Short mantissas: exact ties.
            1 => (r.below(1 << 20) as f64 - 524_288.0) * 2f64.powi(r.below(3) as i32 * 33),
            2 => r.signed() * 2f64.powi(r.below(600) as i32 - 300),
            3 => (r.below(64) as f64 - 32.0) / 8.0,
            4 => f64::from_bits(r.below(1 << 53)) * [1.0, -1.0][r.below(2) as usize],
            _ => 1.0 + r.below(1 << 10) as f64 * f64::EPSILON,
        };
        let vertex = |r: &mut Random| -> [f64; 3] { [magnitude(r), magnitude(r), magnitude(r)] };
        let t = [vertex(&mut r), vertex(&mut r), vertex(&mut r)];
        let axis = r.below(3) as usize;
        let at = between(&mut r, t[0][axis], t[1][axis]);
        let p = unit(&mut r, kind, axis, at);
        let other = (axis + 1 + r.below(2) as usize) % 3;
        let at = between(&mut r, t[1][other], t[2][other]);
        let q = unit(&mut r, kind, other, at);
        let edge = Point::EdgePlane { a: t[0], b: t[1], p };
        let inner = Point::TrianglePlanes { t, p, q };
        let value = |p: &Plane, x: &[f64; 3]| reference::plane_value(p, &q3(x));
        // What is asked of the library: ends on different sides, a triangle that the planes meet in one point.
        let crosses = value(&p, &t[0]) * value(&p, &t[1]) < 0;
        let areas: Q = (0..3)
            .map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                value(&p, &t[j]) * value(&q, &t[k]) - value(&p, &t[k]) * value(&q, &t[j])
            })
            .fold(Q::new(), |sum, x| sum + x);
        for (x, defined) in [(edge, crosses), (inner, areas != 0)] {
            if !defined {
                continue;
            }
            let exact = rational(&x);
            let found = round(&x);
            for i in 0..3 {
                same_bits(found[i], nearest(&exact[i]), || format!("{i} {x:?}"));
                let up = Q::from(q_of(found[i].next_up()) + q_of(found[i])) / 2;
                let down = Q::from(q_of(found[i].next_down()) + q_of(found[i])) / 2;
                ties += (exact[i] == up || exact[i] == down) as u64;
                n += 1;
            }
        }
    }
    println!("{n} coordinates, {ties} exact ties");
    assert!(ties > 1000);

    counters::enable(true);
    counters::take();
    for _ in 0..2000 {
        let (a, b) = (vector(&mut r, 0), vector(&mut r, 0).map(|x| x + 5.0));
        let x = Point::EdgePlane { a, b, p: Plane { n: [0.0, 1.0, 0.0], d: -2.5 } };
        round(&x);
    }
    let counts = counters::take();
    counters::enable(false);
    assert_eq!(counts.get(Predicate::Rounding, Tier::Filter), 2000);
    assert!(counts.get(Predicate::Rounding, Tier::Bounded) >= 3999);
}

fn q_of(x: f64) -> Q {
    if x.is_finite() { q(x) } else { Q::new() }
}

/// Coordinates at the ends of the range: subnormal ties, overflow, zero.
#[test]
fn ends_of_the_range() {
    let least = f64::from_bits(1);
    for (a, b, expected) in [
        (0.0, least, 0.0),
        (least, 2.0 * least, 2.0 * least),
        (2.0 * least, 3.0 * least, 2.0 * least),
        (-least, 0.0, 0.0),
        (-least, least, 0.0),
        (f64::MIN_POSITIVE, f64::MIN_POSITIVE.next_down(), f64::MIN_POSITIVE),
        (f64::MAX, f64::MAX.next_down(), f64::MAX.next_down()),
        (1.0, 1.0f64.next_up(), 1.0),
        (1.0, 1.0f64.next_down(), 1.0),
        (-1.0, -1.0f64.next_up(), -1.0),
    ] {
        // x at 1/2 between a and b, by a plane that is not crosswise to x.
        let p = Plane { n: [0.0, 1.0, 0.0], d: 0.0 };
        let x = Point::EdgePlane { a: [a, -1.0, 0.0], b: [b, 1.0, 0.0], p };
        same_bits(round(&x)[0], expected, || format!("{x:?}"));
    }
    // x = -d / n beyond the range, and below it.
    let at = |n: f64, d: f64| Point::Planes {
        p: Plane { n: [n, 0.0, 0.0], d },
        q: Plane { n: [n, 1.0, 0.0], d },
        r: Plane { n: [0.0, 1.0, 1.0], d: 0.0 },
    };
    same_bits(round(&at(1e-200, 1e200))[0], f64::NEG_INFINITY, || "overflow".into());
    same_bits(round(&at(1e200, 1e-200))[0], 0.0, || "underflow to +0".into());
    // The same through the general path: an oblique frame.
    let x = Point::Planes {
        p: Plane { n: [1e-200, 1e-200, 0.0], d: -1e200 },
        q: Plane { n: [1e-200, -1e-200, 0.0], d: -1e200 },
        r: Plane { n: [1.0, 0.0, 1.0], d: 0.0 },
    };
    let found = round(&x);
    assert_eq!(found.map(f64::to_bits), [f64::INFINITY, 0.0, f64::NEG_INFINITY].map(f64::to_bits));
}

/// Rounding depends on the point alone, not on which carriers name it.
#[test]
fn one_point_by_many_names() {
    let mut r = Random(4);
    for kind in [0, 1, 7, 8] {
        for _ in 0..500 {
            let t = triangle(&mut r, kind);
            let near = std::array::from_fn(|i| (t[0][i] + t[1][i] + t[2][i]) / 3.0);
            let (p, o) = (plane(&mut r, kind, &near), plane(&mut r, kind, &near));
            let a = Point::TrianglePlanes { t, p, q: o };
            if reference::point(&a).is_none() {
                continue;
            }
            let turned = [t[2], t[0], t[1]];
            let s = [Support::Plane(o), Support::Triangle(turned), Support::Plane(p)];
            let b = Point::TrianglePlanes { t: [t[1], t[0], t[2]], p: o, q: p };
            let c = Point::Supports(s);
            let bits = |x: &Point| round(x).map(f64::to_bits);
            assert_eq!(bits(&a), bits(&b), "{a:?}");
            assert_eq!(bits(&a), bits(&c), "{a:?}");
            for axis in 0..3 {
                assert!(compare_coordinate(&a, &c, axis).is_eq(), "{a:?}");
            }
        }
    }
}

#[test]
fn residues_follow_rationals() {
    for p in PRIMES {
        assert_ne!(Integer::from(p).is_probably_prime(40), rug::integer::IsPrime::No);
    }
    let mut r = Random(5);
    let mut points = 0;
    for kind in 0..KINDS.len() {
        for _ in 0..400 {
            let (x, y) = (number(&mut r, kind), number(&mut r, kind));
            let (rx, ry) = (Residue::from_f64(x), Residue::from_f64(y));
            let of = |x: &Q| Residue::from_rational(x).expect("powers of two are invertible");
            assert_eq!(rx, of(&q(x)));
            assert_eq!(rx + ry, of(&(q(x) + q(y))));
            assert_eq!(rx - ry, of(&(q(x) - q(y))));
            assert_eq!(rx * ry, of(&(q(x) * q(y))));
            assert_eq!(-rx, of(&-q(x)));
            if x != 0.0 {
                assert_eq!(rx * rx.inverse().unwrap(), Residue::ONE);
            }
            let near = vector(&mut r, kind);
            let (s, exact) = symbolic(&mut r, kind, &near);
            if let Some(found) = point_residues(&s) {
                points += 1;
                for i in 0..3 {
                    assert_eq!(Some(found[i]), Residue::from_rational(&exact[i]), "{s:?}");
                }
            }
        }
    }
    assert_eq!(points, 4000);
    assert_eq!(Residue::ZERO.inverse(), None);
    for x in [f64::MAX, f64::MIN_POSITIVE, f64::from_bits(1), 0.0, -0.0, 1.0, -1.0, 0.1] {
        assert_eq!(Some(Residue::from_f64(x)), Residue::from_rational(&q(x)), "{x:e}");
    }
    for x in [i64::MIN, -1, 0, 1, i64::MAX] {
        assert_eq!(Residue::from_i64(x), Residue::from_integer(&Integer::from(x)));
    }
}

/// The sum of signed tetrahedra over a closed surface does not depend on the apex.
#[test]
fn residues_add_up() {
    let mut r = Random(6);
    let v: [[f64; 3]; 4] = std::array::from_fn(|_| vector(&mut r, 0));
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let volume = |apex: &[f64; 3]| -> Residue {
        let of = |v: &[f64; 3]| -> [Residue; 3] {
            std::array::from_fn(|i| Residue::from_f64(v[i]) - Residue::from_f64(apex[i]))
        };
        faces.iter().map(|f| ring::det3(&of(&v[f[0]]), &of(&v[f[1]]), &of(&v[f[2]]))).sum()
    };
    let exact = reference::leibniz(&[1, 2, 3].map(|i| reference::sub(&q3(&v[i]), &q3(&v[0]))));
    assert_eq!(Some(volume(&[0.0; 3])), Residue::from_rational(&exact));
    assert_eq!(volume(&[0.0; 3]), volume(&[0.1, 1e30, -1e-30]));
}

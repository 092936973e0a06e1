//! Every predicate, every tier by itself, against rationals: random, degenerate, nearly degenerate, subnormal, tiny,
//! huge and mixed input.

mod exact_reference;

use exact_reference as reference;
use exact_reference::{KINDS, Q, Random, normal, number, plane, q, q3, sign, support, symbolic, triangle, vector};
use lapidary::exact::fixed::Int;
use lapidary::exact::predicates::*;
use lapidary::exact::ring::{Expression, Ring};
use lapidary::exact::rows::RowDeterminant;
use lapidary::exact::tiers::{big_sign, bounded_sign, fixed_sign};
use lapidary::exact::*;
use rug::Integer;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Comparisons made by all tests of this file, and how often each tier knew (bounded, 4, 8, 16, 32 limbs, any size).
static COMPARED: AtomicU64 = AtomicU64::new(0);
static KNEW: [AtomicU64; 6] = [const { AtomicU64::new(0) }; 6];

fn same<T: PartialEq + std::fmt::Debug>(found: T, expected: T, what: impl Fn() -> String) {
    COMPARED.fetch_add(1, Relaxed);
    assert_eq!(found, expected, "{}", what());
}

/// Each tier may pass; if it answers, it is right. The widest one always answers.
fn tiers<const M: usize, E: Expression<M>>(x: &E, expected: Sign, what: impl Fn() -> String) {
    let answers = [
        bounded_sign(x),
        fixed_sign::<M, 4, E>(x),
        fixed_sign::<M, 8, E>(x),
        fixed_sign::<M, 16, E>(x),
        fixed_sign::<M, 32, E>(x),
        Some(big_sign(x)),
    ];
    for (i, a) in answers.into_iter().enumerate() {
        if let Some(a) = a {
            KNEW[i].fetch_add(1, Relaxed);
            same(a, expected, || format!("tier {i}: {}", what()));
        }
    }
}

fn over_kinds(seed: u64, each: usize, mut f: impl FnMut(&mut Random, usize)) {
    for kind in 0..KINDS.len() {
        let mut r = Random(seed * 1000 + kind as u64);
        for _ in 0..each {
            f(&mut r, kind);
        }
    }
}

#[test]
fn sides() {
    over_kinds(1, 4000, |r, kind| {
        let v = vector(r, kind);
        let p = plane(r, kind, &v);
        let expected = sign(&reference::plane_value(&p, &q3(&v)));
        let what = || format!("side {p:?} {v:?}");
        same(side(&p, &v), expected, what);
        tiers(&Side(&p, &v), expected, what);
        let bounds = vector(r, kind);
        let max_abs: [f64; 3] = std::array::from_fn(|i| v[i].abs().max(bounds[i].abs()));
        let f = PlaneFilter::new(&p, &max_abs);
        if let Some(s) = f.side(&v) {
            same(s, expected, || format!("filter {}", what()));
        }
        same(f.exact_side(&v), expected, || format!("filtered {}", what()));
    });
}

#[test]
fn axis_planes_are_always_decided_by_the_filter() {
    over_kinds(2, 1000, |r, kind| {
        let axis = r.below(3) as usize;
        let mut p = Plane { n: [0.0; 3], d: number(r, kind) };
        p.n[axis] = number(r, kind);
        let place = -p.d / p.n[axis];
        if !place.is_finite() {
            return;
        }
        for x in [place, place.next_up(), place.next_down(), number(r, kind)] {
            if !x.is_finite() {
                continue;
            }
            let mut v = vector(r, kind);
            v[axis] = x;
            let f = PlaneFilter::new(&p, &v.map(f64::abs));
            let expected = sign(&reference::plane_value(&p, &q3(&v)));
            same(f.side(&v), Some(expected), || format!("{p:?} {v:?}"));
        }
    });
}

#[test]
fn orders_on_edges() {
    over_kinds(3, 2500, |r, kind| {
        let (a, b) = (vector(r, kind), vector(r, kind));
        let middle = std::array::from_fn(|i| a[i] / 2.0 + b[i] / 2.0);
        let p = plane(r, kind, &middle);
        let mut o = plane(r, kind, &middle);
        if r.below(4) == 0 {
            // The same plane, written otherwise.
            let s = [2.0, -1.0, 3.0][r.below(3) as usize];
            o = Plane { n: p.n.map(|x| x * s), d: p.d * s };
        }
        if o.n.iter().chain([&o.d]).any(|x| !x.is_finite()) {
            return;
        }
        let (qa, qb) = (q3(&a), q3(&b));
        let value = |p: &Plane| [reference::plane_value(p, &qa), reference::plane_value(p, &qb)];
        let ([pa, pb], [oa, ob]) = (value(&p), value(&o));
        if sign(&pa) * sign(&pb) != Sign::Negative || sign(&oa) * sign(&ob) != Sign::Negative {
            return;
        }
        let difference = Q::from(&oa * &pb) - Q::from(&pa * &ob);
        let (tp, to) = (Q::from(&pa / Q::from(&pa - &pb)), Q::from(&oa / Q::from(&oa - &ob)));
        let what = || format!("edge {a:?} {b:?} {p:?} {o:?}");
        same(compare_on_edge(&a, &b, &p, &o), tp.cmp(&to), what);
        tiers(&EdgeOrder(&a, &b, &p, &o), sign(&difference), what);
    });
}

#[test]
fn orders_in_triangles() {
    over_kinds(4, 1500, |r, kind| {
        let t = triangle(r, kind);
        let inside = std::array::from_fn(|i| t[0][i] / 2.0 + t[1][i] / 4.0 + t[2][i] / 4.0);
        let planes = [plane(r, kind, &inside), plane(r, kind, &inside), plane(r, kind, &inside)];
        let corners = t.map(|c| q3(&c));
        let m = planes.map(|p| [0, 1, 2].map(|i| reference::plane_value(&p, &corners[i])));
        let expected = sign(&reference::leibniz(&m));
        let what = || format!("triangle {t:?} {planes:?}");
        let [a, b, c] = &planes;
        same(triangle_determinant(&t, a, b, c), expected, what);
        tiers(&TriangleOrder(&t, a, b, c), expected, what);
    });
}

#[test]
fn sides_of_symbolic_points() {
    over_kinds(5, 1500, |r, kind| {
        let near = vector(r, kind);
        let (x, exact) = symbolic(r, kind, &near);
        let s = match (r.below(6), &x) {
            // A support of the point itself.
            (0, Point::EdgePlane { p, .. } | Point::TrianglePlanes { p, .. } | Point::Planes { p, .. }) => {
                Support::Plane(*p)
            }
            (0, Point::EdgeTriangle { t, .. }) => Support::Triangle(*t),
            (1, Point::TrianglePlanes { t, .. }) => Support::Triangle(*t),
            _ => support(r, kind, &near),
        };
        let expected = sign(&reference::support_value(&s, &exact));
        let what = || format!("point side {s:?} {x:?}");
        same(support_side(&s, &x), expected, what);
        tiers(&PointSide(&s, &x), expected, what);
    });
}

#[test]
fn coordinates_of_symbolic_points() {
    over_kinds(6, 1500, |r, kind| {
        let near = vector(r, kind);
        let (a, qa) = symbolic(r, kind, &near);
        let (b, qb) = if r.below(8) == 0 { (a, qa.clone()) } else { symbolic(r, kind, &near) };
        for axis in 0..3 {
            let what = || format!("coordinate {axis} {a:?} {b:?}");
            let expected = qa[axis].cmp(&qb[axis]);
            same(compare_coordinate(&a, &b, axis), expected, what);
            tiers(&CoordinateOrder(&a, &b, axis), Sign::from_ordering(expected), what);
        }
    });
}

#[test]
fn turns_of_symbolic_points() {
    over_kinds(7, 400, |r, kind| {
        let near = vector(r, kind);
        let p = [symbolic(r, kind, &near), symbolic(r, kind, &near), symbolic(r, kind, &near)];
        let [(a, qa), (b, qb), (c, qc)] = &p;
        let (ax, ay) = [(0, 1), (1, 2), (2, 0), (1, 0)][r.below(4) as usize];
        let (u, v) = (reference::sub(qb, qa), reference::sub(qc, qa));
        let expected = sign(&(Q::from(&u[ax] * &v[ay]) - Q::from(&u[ay] * &v[ax])));
        let what = || format!("turn {ax} {ay} {a:?} {b:?} {c:?}");
        same(turn_projected(a, b, c, ax, ay), expected, what);
        tiers(&TurnProjected([a, b, c], ax, ay), expected, what);
    });
}

/// Symbolic points against their own rounded coordinates: everything cancels down to the last bits, without being zero.
#[test]
fn points_next_to_their_rounded_selves() {
    over_kinds(19, 1500, |r, kind| {
        let near = vector(r, kind);
        let (x, exact) = symbolic(r, kind, &near);
        let c = round(&x);
        if c.iter().any(|c| !c.is_finite()) {
            return;
        }
        let (v, qc) = (Point::Vertex(c), q3(&c));
        for axis in 0..3 {
            let what = || format!("coordinate {axis} {x:?} {c:?}");
            let expected = exact[axis].cmp(&qc[axis]);
            same(compare_coordinate(&x, &v, axis), expected, what);
            tiers(&CoordinateOrder(&x, &v, axis), Sign::from_ordering(expected), what);
        }
        let n = normal(r, kind);
        let d = -(n[0] * c[0] + n[1] * c[1] + n[2] * c[2]);
        let mut t = triangle(r, kind);
        t[0] = c;
        let supports = [Support::Plane(Plane { n, d: if d.is_finite() { d } else { 1.0 } }), Support::Triangle(t)];
        for s in &supports {
            let expected = sign(&reference::support_value(s, &exact));
            let what = || format!("point side {s:?} {x:?}");
            same(support_side(s, &x), expected, what);
            tiers(&PointSide(s, &x), expected, what);
        }
        let (y, qy) = symbolic(r, kind, &near);
        let (u, w) = (reference::sub(&qc, &exact), reference::sub(&qy, &exact));
        let expected = sign(&(Q::from(&u[0] * &w[1]) - Q::from(&u[1] * &w[0])));
        let what = || format!("turn {x:?} {c:?} {y:?}");
        same(turn_projected(&x, &v, &y, 0, 1), expected, what);
        tiers(&TurnProjected([&x, &v, &y], 0, 1), expected, what);
    });
}

fn some_direction(r: &mut Random, kind: usize) -> Direction {
    match r.below(4) {
        0 => Direction::Plane(normal(r, kind)),
        3 => Direction::Gradient(reference::gradient(r, kind)),
        1 => Direction::Triangle(triangle(r, kind)),
        _ => Direction::Between(vector(r, kind), vector(r, kind)),
    }
}

#[test]
fn directions() {
    over_kinds(8, 2000, |r, kind| {
        let mut d: [Direction; 4] = std::array::from_fn(|_| some_direction(r, kind));
        if r.below(2) == 0 {
            d = std::array::from_fn(|_| Direction::Plane(normal(r, kind)));
        }
        if r.below(3) == 0 {
            d[2] = d[r.below(2) as usize];
        }
        let [a, b, c, e] = &d;
        let [qa, qb, qc, qe] = d.map(|d| reference::direction(&d));
        let what = || format!("directions {d:?}");

        let expected = sign(&reference::leibniz(&[qa.clone(), qb.clone(), qc.clone()]));
        same(determinant(a, b, c), expected, what);
        tiers(&Determinant(a, b, c), expected, what);

        let expected = sign(&reference::dot(&qa, &qb));
        same(dot(a, b), expected, what);
        tiers(&Dot(a, b), expected, what);

        let expected = sign(&reference::dot(&reference::cross(&qa, &qb), &reference::cross(&qc, &qe)));
        same(cross_dot_cross(a, b, c, e), expected, what);
        tiers(&CrossDotCross([a, b, c, e]), expected, what);
    });
}

#[test]
fn orientations() {
    over_kinds(9, 3000, |r, kind| {
        let mut v = [vector(r, kind), vector(r, kind), vector(r, kind), vector(r, kind)];
        match r.below(4) {
            // Nearly in the plane of the others; nearly on a line with two of them.
            0 => v[3] = std::array::from_fn(|i| v[0][i] / 4.0 + v[1][i] / 4.0 + v[2][i] / 2.0),
            1 => v[2] = std::array::from_fn(|i| v[0][i] / 2.0 + v[1][i] / 2.0),
            _ => {}
        }
        let [a, b, c, d] = &v;
        let [qa, qb, qc, qd] = v.map(|x| q3(&x));
        let what = || format!("orientation {v:?}");
        let (ab, ac) = (reference::sub(&qb, &qa), reference::sub(&qc, &qa));
        let n = reference::cross(&ab, &ac);
        let expected = sign(&reference::dot(&n, &reference::sub(&qd, &qa)));
        same(orient3d(a, b, c, d), expected, what);
        tiers(&Orient3d([a, b, c, d]), expected, what);
        same(collinear(a, b, c), n.iter().all(|x| *x == 0), what);
        let (i, j) = [(1, 2), (2, 0), (0, 1)][r.below(3) as usize];
        tiers(&Turn2d([a, b, c], i, j), sign(&n[3 - i - j]), what);
    });
}

#[test]
fn central_projections() {
    over_kinds(10, 2500, |r, kind| {
        let (apex, b, mut c) = (vector(r, kind), vector(r, kind), vector(r, kind));
        if r.below(3) == 0 {
            // On one line with the apex, where nothing rounds.
            c = std::array::from_fn(|i| b[i] / 2.0 + apex[i] / 2.0);
        }
        let (n, axis) = (normal(r, kind), r.below(3) as usize);
        let (qn, qa) = (q3(&n), q3(&apex));
        let (w, u) = (reference::sub(&q3(&b), &qa), reference::sub(&q3(&c), &qa));
        let (nw, nu) = (reference::dot(&qn, &w), reference::dot(&qn, &u));
        if sign(&nw) * sign(&nu) != Sign::Positive {
            return;
        }
        let what = || format!("projection {apex:?} {b:?} {c:?} {n:?} {axis}");
        let (x, y) = (Q::from(&w[axis] / nw.abs()), Q::from(&u[axis] / nu.abs()));
        same(compare_projected(&apex, &b, &c, &n, axis), x.cmp(&y), what);
        let e = Projected { apex: &apex, b: &b, c: &c, n: &n, axis };
        tiers(&e, Sign::from_ordering(x.cmp(&y)), what);
    });
}

fn determinants_of_size<const M: usize>(seed: u64, each: usize) {
    over_kinds(seed, each, |r, kind| {
        let values: [[[f64; M]; 2]; M] =
            std::array::from_fn(|_| std::array::from_fn(|_| std::array::from_fn(|_| number(r, kind))));
        let repeat = (r.below(3) == 0).then(|| (r.below(M as u64) as usize, r.below(M as u64) as usize));
        let sorts: [u64; M] = std::array::from_fn(|_| r.below(5));
        let rows: [Row<M>; M] = std::array::from_fn(|i| {
            let i = if repeat.is_some_and(|(to, _)| to == i) { repeat.unwrap().1 } else { i };
            match sorts[i] {
                0 => Row::Ones,
                1 | 2 => Row::Difference(&values[i][0], &values[i][1]),
                _ => Row::Values(&values[i][0]),
            }
        });
        let exact = rows.map(|row| -> [Q; M] {
            std::array::from_fn(|i| match row {
                Row::Values(a) => q(a[i]),
                Row::Difference(a, b) => q(a[i]) - q(b[i]),
                Row::Ones => Q::from(1),
            })
        });
        let expected = sign(&reference::leibniz(&exact));
        let what = || format!("rows {rows:?}");
        same(determinant_of_rows(&rows), expected, what);
        tiers(&RowDeterminant(&rows), expected, what);
    });
}

#[test]
fn determinants_of_function_values() {
    determinants_of_size::<1>(11, 500);
    determinants_of_size::<2>(12, 1500);
    determinants_of_size::<3>(13, 1500);
    determinants_of_size::<4>(14, 1000);
}

/// Integers on the stack against rug, with limbs at the ends of their range: equal, or lost and then really too wide.
fn integers_of_width<const N: usize>(seed: u64) {
    let mut r = Random(seed);
    let limbs = |r: &mut Random| -> Vec<i64> {
        let n = 1 + r.below(N as u64) as usize;
        let ends = [0, 1, -1, i64::MIN, i64::MAX, i64::MIN + 1];
        (0..n).map(|_| if r.below(2) == 0 { ends[r.below(6) as usize] } else { r.bits() as i64 }).collect()
    };
    let build = |l: &[i64]| -> (Int<N>, Integer) {
        let shift = Int::<N>::scaled(2f64.powi(64), 0);
        l.iter()
            .fold((Int::small(0), Integer::new()), |(x, q), &l| (x.times(&shift).plus(&Int::small(l)), (q << 64) + l))
    };
    let mut fitted = 0;
    let mut check = |x: &Int<N>, q: &Integer| match x.to_integer() {
        Some(found) => {
            same(&found, q, || "integer".into());
            assert_eq!(x.sign(), Some(Sign::from_ordering(q.cmp0())));
            fitted += 1;
        }
        // Lost only close to the capacity.
        None => assert!(q.significant_bits() as usize >= 64 * (N - 1) - 2, "{q}"),
    };
    for _ in 0..5000 {
        let v: [Vec<i64>; 7] = std::array::from_fn(|_| limbs(&mut r));
        let short = r.below(2) == 0;
        let v = v.map(|l| build(if short { &l[..1] } else { &l }));
        if v.iter().any(|(x, _)| x.sign().is_none()) {
            continue;
        }
        let [(a, qa), (b, qb), (c, qc), (d, qd), (e, qe), (f, qf), (g, qg)] = v;
        check(&a, &qa);
        check(&a.plus(&b), &Integer::from(&qa + &qb));
        check(&a.minus(&b), &Integer::from(&qa - &qb));
        check(&a.negated(), &Integer::from(-&qa));
        // What is lost on the way is lost at the end, even if it would fit again: look at what surely stays.
        let (ab, cd) = (Integer::from(&qa * &qb), Integer::from(&qc * &qd));
        check(&a.times(&b), &ab);
        if ab.significant_bits().max(cd.significant_bits()) as usize <= 64 * (N - 1) - 8 {
            check(&Int::minor(&a, &c, &d, &b), &Integer::from(&ab - &cd));
            let ef = Integer::from(&qe * &qf);
            if ef.significant_bits() as usize <= 64 * (N - 1) - 8 {
                let v = [b, d, f];
                let dot: Integer = ab + cd + ef;
                check(&Int::dot(&[a, c, e], &v), &dot);
                check(&Int::plane_value(&[a, c, e, g], &v), &(dot + qg));
            }
        }
    }
    assert!(fitted > 10_000, "{fitted}");
}

#[test]
fn integers_on_the_stack() {
    integers_of_width::<4>(15);
    integers_of_width::<8>(16);
    integers_of_width::<16>(17);
    let mut r = Random(18);
    for _ in 0..20_000 {
        // A double on any exponent up to its own lowest bit.
        let x = f64::from_bits(r.bits());
        if !x.is_finite() || x == 0.0 {
            continue;
        }
        let e = lift::lsb(x) - r.below(300) as i32;
        let exact = q(x) * (Q::from(1) << -e);
        assert!(exact.is_integer());
        let narrow = Int::<4>::scaled(x, e).to_integer();
        same(Int::<8>::scaled(x, e).to_integer().as_ref(), Some(exact.numer()), || format!("{x:e} {e}"));
        assert!(narrow.is_none() || narrow.as_ref() == Some(exact.numer()));
        assert!(narrow.is_some() || exact.numer().significant_bits() >= 128);
    }
}

/// Products of 1e-170 vanish in doubles; the signs do not.
#[test]
fn underflow_trap() {
    let t = 1e-170;
    let (o, x, y, z) = ([0.0; 3], [t, 0.0, 0.0], [0.0, t, 0.0], [0.0, 0.0, t]);
    assert!(!collinear(&o, &x, &y));
    assert_eq!(turn_projected(&Point::Vertex(o), &Point::Vertex(x), &Point::Vertex(y), 0, 1), Sign::Positive);
    assert_eq!(turn_projected(&Point::Vertex(o), &Point::Vertex(y), &Point::Vertex(x), 0, 1), Sign::Negative);
    assert_eq!(orient3d(&o, &x, &y, &z), Sign::Positive);
    assert_eq!(orient3d(&o, &y, &x, &z), Sign::Negative);
    assert_eq!(side(&Plane { n: [t, 0.0, 0.0], d: 0.0 }, &x), Sign::Positive);
    let least = f64::from_bits(1);
    assert_eq!(side(&Plane { n: [least; 3], d: -least }, &[0.25, 0.25, 0.5]), Sign::Zero);
    assert_eq!(side(&Plane { n: [least; 3], d: -least }, &[0.25, 0.25, 0.5f64.next_up()]), Sign::Positive);
    assert_eq!(side(&Plane { n: [f64::MAX; 3], d: f64::MAX }, &[f64::MAX, -f64::MAX, -1.0]), Sign::Zero);
}

/// A cheap predicate in bulk makes the million by itself; tests that ran before are in the printed number too.
#[test]
fn a_million_comparisons() {
    over_kinds(20, 20_000, |r, kind| {
        let v = vector(r, kind);
        let p = plane(r, kind, &v);
        let expected = sign(&reference::plane_value(&p, &q3(&v)));
        let what = || format!("side {p:?} {v:?}");
        same(side(&p, &v), expected, what);
        tiers(&Side(&p, &v), expected, what);
    });
    let n = COMPARED.load(Relaxed);
    println!("at least {n} comparisons, no disagreement; tiers knew {KNEW:?}");
    assert!(n >= 1_000_000, "{n}");
    assert!(KNEW.iter().all(|k| k.load(Relaxed) > 10_000), "{KNEW:?}");
}

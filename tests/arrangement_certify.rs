//! Booleans on certified doubles.

use lapidary::arrangement::certify::{CertifiedSurface, CertifyOptions, certify};
use lapidary::arrangement::flatten::flatten;
use lapidary::arrangement::slabs::slabs;
use lapidary::arrangement::{
    Arrangement, ArrangementOptions, Extraction, Operand, Selection, arrange, choose, extract, volumes,
};
use lapidary::base::{Run, TriangleId, VertexId};
use lapidary::complex::exact_values::volume_of_triangles;
use lapidary::mesh::bvh::build_bvh;
use lapidary::mesh::self_intersection::{contact, self_intersections};
use rug::Rational;
use std::time::Instant;

#[path = "common/mod.rs"]
mod common;
#[path = "common/doubles_oracle.rs"]
mod doubles_oracle;
use common::random::Random;
use common::shapes::{geodesic, grid_cube, moved, rotation, shifted};
use common::{Soup, build_soup, cgal_meshes, checking, read_off};
use doubles_oracle::{Probes, judge};

fn arranged(operands: &[&Soup]) -> Arrangement {
    let all: Vec<Operand> =
        operands.iter().map(|s| Operand { vertices: &s.vertices, triangles: &s.triangles }).collect();
    arrange(&all, &ArrangementOptions {}, &mut Run::quiet()).unwrap()
}

fn certified(e: &Extraction) -> CertifiedSurface {
    certify(&e.coords, &e.triangles, &CertifyOptions::default(), &mut Run::quiet()).unwrap()
}

fn boolean(operands: &[&Soup], selection: Selection) -> CertifiedSurface {
    let a = arranged(operands);
    certified(&extract(&a, &choose(&a, selection).unwrap()).unwrap())
}

fn soup(c: &CertifiedSurface) -> Soup {
    Soup { vertices: c.coords.clone(), triangles: c.triangles.clone() }
}

fn show(what: &str, c: &CertifiedSurface, started: Instant) {
    let r = &c.report;
    println!(
        "{what}: certified {}, {} -> {} triangles, {} moved by {:.3e} at most, {} gone, {} thin, {} snapped, {} remain; {:?}",
        r.certified,
        r.triangles_before,
        r.triangles_after,
        r.moved,
        r.largest_move,
        r.gone,
        r.thin_cells,
        r.snapped,
        r.remaining.len(),
        started.elapsed()
    );
    r.rounds.iter().for_each(|x| println!("   {x:?}"));
}

/// By means that know nothing of arrangements: each place once, no two triangles in contact, valid nesting of shells.
fn assert_solid(c: &CertifiedSurface, what: &str) {
    let r = &c.report;
    assert!(r.certified && r.remaining.is_empty(), "{what}: {:?}", r.rounds);
    assert_eq!((c.sources.len(), c.against.len()), (c.triangles.len(), c.triangles.len()), "{what}");
    assert_eq!(r.triangles_after, c.triangles.len(), "{what}");
    if !c.triangles.is_empty() {
        build_soup(&soup(c), checking()).unwrap_or_else(|e| panic!("{what}: {e:?}"));
    }
    // Arranged again nothing meets, and all of it bounds what it winds around: it goes straight into the next boolean.
    let again = arranged(&[&soup(c)]);
    assert_eq!((again.resolved.pair_count, again.vertex_count()), (0, c.coords.len()), "{what}");
    let solid = extract(&again, &choose(&again, Selection::Resolve).unwrap()).unwrap();
    assert_eq!(solid.triangles.len(), c.triangles.len(), "{what}");
    assert!(solid.flipped.iter().all(|f| !f), "{what}");
}

/// The exact volume differs from that of the exact solid by no more than the largest move of the surface explains.
fn assert_near(c: &CertifiedSurface, a: &Arrangement, e: &Extraction, what: &str) {
    let triangles: Vec<[u32; 3]> = c.triangles.iter().map(|t| t.map(|v| v as u32)).collect();
    let off = (volume_of_triangles(&c.coords, &triangles) - volumes::volume(a, e)).to_f64().abs();
    let area: f64 = e.triangles.iter().map(|t| area(t.map(|v| e.coords[v as usize]))).sum();
    let most = (c.report.largest_move + c.report.unit) * area * 3.0;
    assert!(off <= most, "{what}: volume off by {off:e}, {most:e} is explained");
    assert!(c.report.largest_move <= 64.0 * c.report.unit, "{what}: moved by {:e}", c.report.largest_move);
}

fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let side = |p: [f64; 3], i: usize| p[i] - a[i];
    let part = |i: usize, j: usize| side(b, i) * side(c, j) - side(b, j) * side(c, i);
    0.5 * (part(0, 1).powi(2) + part(1, 2).powi(2) + part(2, 0).powi(2)).sqrt()
}

/// What flattening proposes is closed, on fewer triangles in contact, and the parts that it takes are what they say.
#[test]
fn flattened() {
    let turn = rotation(&mut Random(5));
    let [a, b] = [[0.0; 3], [0.5, 0.25, 0.0]].map(|shift| moved(&grid_cube(5, shift, 1.0), turn, 1.0, [0.0; 3]));
    let arrangement = arranged(&[&a, &b]);
    let e = extract(&arrangement, &choose(&arrangement, Selection::SymmetricDifference).unwrap()).unwrap();
    let triangles: Vec<[i32; 3]> = e.triangles.iter().map(|t| t.map(|v| v as i32)).collect();
    let contacts = |coords: &[[f64; 3]], triangles: &[[i32; 3]]| -> Vec<[TriangleId; 2]> {
        let flat: Vec<bool> = triangles.iter().map(|t| is_flat(t.map(|v| coords[v as usize]))).collect();
        let others: Vec<usize> = (0..triangles.len()).filter(|&t| !flat[t]).collect();
        let corners: Vec<[VertexId; 3]> = others.iter().map(|&t| triangles[t].map(|v| VertexId(v as u32))).collect();
        let pairs = self_intersections(coords, &corners, &build_bvh(coords, &corners), usize::MAX);
        pairs.into_iter().map(|p| p.map(|t| TriangleId::of(others[t.at()]))).collect()
    };
    let before = contacts(&e.coords, &triangles);
    let near = 8.0 * 10.0 * f64::EPSILON;
    let found = slabs(&e.coords, &triangles, &before, near, &mut Run::quiet()).unwrap();
    assert!(found.len() >= 2, "{}", found.len());
    found.iter().for_each(|s| assert_eq!(s.check(&triangles), Ok(())));
    let mut coords = e.coords.clone();
    let made = flatten(&mut coords, &triangles, &before, near, 0.25 * near, &mut Run::quiet()).unwrap();
    assert_eq!(made.check(), Ok(()));
    assert!(made.count > 0 && made.moved <= 4.0 * near && made.triangles.len() < triangles.len());
    let after = contacts(&coords, &made.triangles);
    println!("{} contacts, {} after, {} parts", before.len(), after.len(), found.len());
    assert!(after.len() < before.len());
}

/// In rationals.
fn is_flat(t: [[f64; 3]; 3]) -> bool {
    let [a, b, c] = t.map(|p| p.map(|x| Rational::from_f64(x).unwrap()));
    let part = |i: usize, j: usize| {
        let side = |p: &[Rational; 3], k: usize| Rational::from(&p[k] - &a[k]);
        side(&b, i) * side(&c, j) - side(&b, j) * side(&c, i)
    };
    [part(0, 1), part(1, 2), part(2, 0)].iter().all(|x| *x == 0)
}

/// What may not be repaired is reported as an independent search finds it.
#[test]
fn only_checked() {
    let options = CertifyOptions { check_only: true, ..CertifyOptions::default() };
    let mut found = 0;
    for seed in 0..20 {
        let turn = rotation(&mut Random(seed));
        let [a, b] = [[0.0; 3], [0.5, 0.25, 0.0]].map(|shift| moved(&grid_cube(2, shift, 1.0), turn, 1.0, [0.0; 3]));
        let arrangement = arranged(&[&a, &b]);
        let e = extract(&arrangement, &choose(&arrangement, Selection::Difference).unwrap()).unwrap();
        let c = certify(&e.coords, &e.triangles, &options, &mut Run::quiet()).unwrap();
        assert_eq!(c.coords, e.coords);
        let triangles: Vec<[VertexId; 3]> = e.triangles.iter().map(|t| t.map(VertexId)).collect();
        let flat: Vec<bool> = e.triangles.iter().map(|t| is_flat(t.map(|v| e.coords[v as usize]))).collect();
        let mut all: Vec<[TriangleId; 2]> = Vec::new();
        for i in 0..triangles.len() {
            let meets = |&j: &usize| !flat[i] && !flat[j] && contact(&e.coords, &triangles[j], &triangles[i]);
            all.extend((0..i).filter(meets).map(|j| [j, i].map(TriangleId::of)));
            all.extend(flat[i].then_some([TriangleId::of(i); 2]));
        }
        all.sort_unstable();
        assert_eq!(c.report.remaining, all, "rotation {seed}");
        assert!(!c.report.certified || all.is_empty(), "rotation {seed}");
        found += !all.is_empty() as usize;
    }
    assert!(found > 2, "{found}");
    // And a solid inside out is none, though nothing meets.
    let reversed: Vec<[u32; 3]> =
        grid_cube(1, [0.0; 3], 1.0).triangles.iter().map(|t| [t[0], t[2], t[1]].map(|v| v as u32)).collect();
    let c = certify(&grid_cube(1, [0.0; 3], 1.0).vertices, &reversed, &options, &mut Run::quiet()).unwrap();
    assert!(!c.report.certified && c.report.remaining.is_empty());
}

const OPERATIONS: [Selection; 4] =
    [Selection::Union, Selection::Intersection, Selection::Difference, Selection::SymmetricDifference];

/// All four operations on two soups: certified, near, within seconds.
fn all_certified(a: &Soup, b: &Soup, what: &str) {
    let arrangement = arranged(&[a, b]);
    for (i, s) in OPERATIONS.into_iter().enumerate() {
        let e = extract(&arrangement, &choose(&arrangement, s).unwrap()).unwrap();
        let started = Instant::now();
        let c = certified(&e);
        let what = format!("{what}, operation {i}");
        show(&what, &c, started);
        assert_solid(&c, &what);
        assert_near(&c, &arrangement, &e, &what);
    }
}

/// Cubes of grids, rotated by an irrational angle and rounded, both apart: planes that are the same become nearly the same.
#[test]
fn nearly_coplanar_grids() {
    for n in [1, 2, 4, 10] {
        let mut random = Random(n as u64);
        for k in 0..3 {
            let turn = rotation(&mut random);
            let a = grid_cube(n, [0.0; 3], 1.0);
            let turned = |s: &Soup| moved(s, turn, 1.0, [0.0; 3]);
            let size = f64::from(n);
            // Half a cell apart; a cell apart; sharing a face, an edge; sunk in.
            let shifts = [[0.5, 0.25, 0.0], [1.0, 0.0, 0.0], [size, 0.0, 0.0], [size, 0.5, 0.0], [size, size, 0.25]];
            for (j, shift) in shifts.into_iter().enumerate() {
                let what = format!("{n} squares a side, rotation {k}, shift {j}");
                all_certified(&turned(&a), &turned(&shifted(&a, shift)), &what);
            }
            // Finer squares on the same cube, and a smaller one inside that touches from within.
            let fine = grid_cube(2 * n + 1, [0.0; 3], size / f64::from(2 * n + 1));
            all_certified(&turned(&a), &turned(&fine), &format!("{n} squares a side, rotation {k}, finer"));
            let inner = grid_cube(n, [0.0, 0.25 * size, 0.0], 0.5);
            all_certified(&turned(&a), &turned(&inner), &format!("{n} squares a side, rotation {k}, inside"));
        }
    }
}

/// Points in and around cubes of n squares a side at `lows`, and in which cubes each is. They are at both sides of the middle of each triangle
/// but for very little, and in the middle of each part into which squares divide space.
fn probes(cubes: &[Soup; 2], lows: [[f64; 3]; 2], n: i32) -> Vec<([f64; 3], [bool; 2])> {
    let little = 2f64.powi(-35);
    let mut points = Vec::new();
    for cube in cubes {
        for t in &cube.triangles {
            let c = t.map(|v| cube.vertices[v as usize]);
            let middle: [f64; 3] = std::array::from_fn(|i| (c[0][i] + c[1][i] + c[2][i]) / 3.0);
            let axis = (0..3).find(|&i| c[0][i] == c[1][i] && c[0][i] == c[2][i]).unwrap();
            points.extend([-little, little].map(|off| {
                let mut p = middle;
                p[axis] += off;
                p
            }));
        }
    }
    let along = || -1..=n + 1;
    let at = |i: i32, shift: f64| f64::from(i) + shift;
    let column = |i, j| along().map(move |k| [at(i, 0.125), at(j, 0.375), at(k, 0.625)]);
    points.extend(along().flat_map(|i| along().flat_map(move |j| column(i, j))));
    let within = |p: &[f64; 3]| {
        lows.map(|low| {
            // Nowhere near the planes of sides, so rounding of what is turned decides nothing.
            let far = |i: usize| [low[i], low[i] + f64::from(n)].iter().all(|x| (p[i] - x).abs() > 0.9 * little);
            assert!((0..3).all(far), "{p:?} is near a side");
            (0..3).all(|i| low[i] < p[i] && p[i] < low[i] + f64::from(n))
        })
    };
    points.into_iter().map(|p| (p, within(&p))).collect()
}

/// A boolean as text, and what it says of a point.
type Operation = (&'static str, fn([bool; 2]) -> bool);

/// Judged by what cubes are, and in whole numbers.
#[test]
fn nearly_coplanar_grids_of_thirty() {
    let operations: [Operation; 5] = [
        ("0 | 1", |[a, b]| a || b),
        ("0 & 1", |[a, b]| a && b),
        ("0 - 1", |[a, b]| a && !b),
        ("1 - 0", |[a, b]| b && !a),
        ("0 ^ 1", |[a, b]| a != b),
    ];
    let turn = rotation(&mut Random(30));
    let turned = |s: &Soup| moved(s, turn, 1.0, [0.0; 3]);
    let mut repaired = 0;
    for shift in [[0.5, 0.25, 0.0], [1.0, 0.0, 0.25], [30.0, 0.5, 0.25], [30.0, 0.0, 0.0]] {
        let cubes = [[0.0; 3], shift].map(|low| grid_cube(30, low, 1.0));
        let known = probes(&cubes, [[0.0; 3], shift], 30);
        let places = turned(&Soup { vertices: known.iter().map(|p| p.0).collect(), triangles: Vec::new() }).vertices;
        let [a, b] = cubes.each_ref().map(turned);
        let arrangement = arranged(&[&a, &b]);
        for (text, inside) in operations {
            let what = format!("30 squares a side, shift {shift:?}, {text}");
            let e = extract(&arrangement, &choose(&arrangement, Selection::Expression(text)).unwrap()).unwrap();
            let started = Instant::now();
            let c = certified(&e);
            show(&what, &c, started);
            assert!(c.report.certified && c.report.remaining.is_empty(), "{what}");
            assert_near(&c, &arrangement, &e, &what);
            let expected = |inside: fn([bool; 2]) -> bool| -> Probes {
                places.iter().zip(&known).map(|(p, k)| (*p, inside(k.1))).collect()
            };
            assert_eq!(judge(&soup(&c), &expected(inside)), Ok(()), "{what}");
            // The judge sees another solid, and what was not repaired.
            assert!(judge(&soup(&c), &expected(|[a, b]| a && b || !a && !b)).is_err(), "{what}");
            if c.report.snapped > 0 {
                let rounded = Soup {
                    vertices: e.coords.clone(),
                    triangles: e.triangles.iter().map(|t| t.map(|v| v as i32)).collect(),
                };
                assert!(judge(&rounded, &Vec::new()).is_err(), "{what}");
                repaired += 1;
            }
            println!("   judged after {:?}", started.elapsed());
        }
    }
    assert!(repaired >= 3, "{repaired}");
}

/// Three at once, and a curved surface against itself with every corner moved by units.
#[test]
fn nearly_the_same() {
    let turn = rotation(&mut Random(3));
    let a = grid_cube(4, [0.0; 3], 1.0);
    let all: Vec<Soup> = [[0.0; 3], [0.5, 0.25, 0.0], [0.25, 0.5, 0.0]]
        .map(|shift| moved(&shifted(&a, shift), turn, 1.0, [0.0; 3]))
        .into();
    let three = arranged(&[&all[0], &all[1], &all[2]]);
    for text in ["0 - 1 - 2", "0 ^ 1 ^ 2", "(0 | 1) - 2", "0 & !(1 & 2)"] {
        let e = extract(&three, &choose(&three, Selection::Expression(text)).unwrap()).unwrap();
        let c = certified(&e);
        assert_solid(&c, text);
        assert_near(&c, &three, &e, text);
    }
    let ball = geodesic(6);
    for seed in 0..3 {
        let mut random = Random(seed);
        let mut other = ball.clone();
        other.vertices.iter_mut().flatten().for_each(|x| *x += f64::EPSILON * random.signed());
        all_certified(&ball, &other, &format!("balls, {seed}"));
    }
}

#[test]
fn two_cubes() {
    let a = grid_cube(1, [0.0; 3], 1.0);
    let mut random = Random(5);
    for k in 0..50 {
        let b = moved(&a, rotation(&mut random), 1.0, [0.3, 0.2, 0.1]);
        for s in [Selection::Union, Selection::Intersection, Selection::Difference, Selection::SymmetricDifference] {
            assert_solid(&boolean(&[&a, &b], s), &format!("pair {k}"));
        }
    }
    // Exact from the start: nothing is rounded, nothing changes.
    let c = boolean(&[&a, &shifted(&a, [0.5, 0.25, 0.125])], Selection::Union);
    assert_solid(&c, "on the axes");
    assert_eq!((c.report.moved, c.report.gone, c.report.rounds.len()), (0, 0, 1));
    assert_eq!(c.report.triangles_after, c.report.triangles_before);
    // Nothing at all.
    let c = boolean(&[&a, &a], Selection::Difference);
    assert!(c.report.certified && c.triangles.is_empty());
}

/// Each result goes straight into the next.
#[test]
fn chains() {
    for seed in 0..10 {
        let mut random = Random(seed);
        let ball = geodesic(4);
        let mut solid = grid_cube(3, [-1.0; 3], 2.0 / 3.0);
        for step in 0..5 {
            let shift = std::array::from_fn(|_| random.signed());
            let other = moved(&ball, rotation(&mut random), 0.8, shift);
            let s = if step % 2 == 0 { Selection::Difference } else { Selection::Union };
            let c = boolean(&[&solid, &other], s);
            assert_solid(&c, &format!("chain {seed}, step {step}"));
            solid = soup(&c);
        }
    }
}

#[test]
fn bunnies() {
    let Some(meshes) = cgal_meshes() else { return };
    let Ok(a) = read_off(&meshes.join("bunny00.off")) else { return println!("skipped: no bunny00.off") };
    let size = a.vertices.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let b = moved(&a, rotation(&mut Random(7)), 1.0, [size / 5.0; 3]);
    for s in [Selection::Union, Selection::Difference] {
        let started = Instant::now();
        let c = boolean(&[&a, &b], s);
        show("bunnies", &c, started);
        assert_solid(&c, "bunnies");
    }
    if std::env::var_os("LAPIDARY_LONG").is_none() {
        return;
    }
    // Nearly itself: thousands of small sheets. A minute.
    let mut random = Random(8);
    let mut other = a.clone();
    other.vertices.iter_mut().flatten().for_each(|x| *x += *x * f64::EPSILON * random.signed());
    all_certified(&a, &other, "bunny");
}

/// Powers of two and the number of threads change nothing.
#[test]
fn the_same_at_any_scale_and_with_any_threads() {
    let turn = rotation(&mut Random(6));
    let made = |scale: f64| {
        let two = [[0.0; 3], [0.5, 0.25, 0.0]].map(|shift| moved(&grid_cube(3, shift, 1.0), turn, 1.0, [0.0; 3]));
        let [a, b] = two.map(|mut s| {
            s.vertices.iter_mut().flatten().for_each(|x| *x *= scale);
            s
        });
        boolean(&[&a, &b], Selection::SymmetricDifference)
    };
    let one = made(1.0);
    assert_solid(&one, "at its size");
    assert!(one.report.snapped > 0);
    for power in [40, -40, 120, -120] {
        let scale = 2f64.powi(power);
        let c = made(scale);
        assert!(c.triangles == one.triangles && c.sources == one.sources && c.against == one.against, "{power}");
        assert!(c.coords.iter().flatten().zip(one.coords.iter().flatten()).all(|(x, y)| *x == y * scale), "{power}");
        assert_eq!(c.report.largest_move, one.report.largest_move * scale);
    }
    // Where squares overflow or vanish it may fail to certify, but it says so.
    for power in [-1000, -540, 500, 1000] {
        let c = made(2f64.powi(power));
        println!("scale 2^{power}: certified {}", c.report.certified);
        if c.report.certified {
            assert_solid(&c, "at an extreme");
        }
    }
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(pool.install(|| made(1.0)), one);
    }
}

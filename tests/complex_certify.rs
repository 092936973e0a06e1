//! Certified doubles: the exact check against all pairs in rationals, repairs of cells too thin for doubles, what must not
//! move, and every closed valid mesh of the optional CGAL data set under six kinds of plane sets, in the form of the
//! TopoCut paper's Table 2.
//!
//! A quick subset by default; all with `LAPIDARY_LONG=1 cargo test --release --test complex_certify -- --nocapture`.

mod common;
#[path = "common/complexes.rs"]
mod complexes;

use common::models::{arbitrary, axis_plane, each_model_or_all, grid};
use common::random::Random;
use common::{build_soup, tetrahedron};
use complexes::{P, cross, cube, cut_cube, dot, minus, plane, point};
use lapidary::base::{CellId, FaceId, Run, TriangleId, VertexId};
use lapidary::complex::certify_check::{Surface, contacts, volume_sign};
use lapidary::complex::{CertifiedComplex, CertifyOptions, Complex, certify};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::{Plane, Sign};
use lapidary::mesh::bvh::build_bvh;
use rug::Rational;
use std::collections::BTreeMap;
use std::sync::Arc;

// The oracle: the intersection of two triangles as the hull of the points where sides of either meet the other,
// in rationals, by clipping parameters of segments.

/// The part of segment ab in a triangle, as its two ends.
fn clip(a: &P, b: &P, t: &[P; 3]) -> Option<[P; 2]> {
    let n = cross(&minus(&t[1], &t[0]), &minus(&t[2], &t[0]));
    let (mut low, mut high) = (Rational::new(), Rational::from(1));
    // Every condition is a linear function of the parameter that must not be negative.
    let mut demand = |at_a: Rational, at_b: Rational| -> bool {
        let slope = Rational::from(&at_b - &at_a);
        if slope == 0 {
            return at_a >= 0;
        }
        let zero = -at_a / &slope;
        if slope > 0 && zero > low {
            low = zero;
        } else if slope < 0 && zero < high {
            high = zero;
        }
        low <= high
    };
    let height = |x: &P| dot(&n, &minus(x, &t[0]));
    let mut inside = demand(height(a), height(b)) && demand(-height(a), -height(b));
    for i in 0..3 {
        let side = |x: &P| dot(&cross(&minus(&t[(i + 1) % 3], &t[i]), &minus(x, &t[i])), &n);
        inside = inside && demand(side(a), side(b));
    }
    let at = |s: &Rational| -> P {
        let d = minus(b, a);
        std::array::from_fn(|i| Rational::from(&d[i] * s) + &a[i])
    };
    inside.then(|| [at(&low), at(&high)])
}

fn on_segment(x: &P, a: &P, b: &P) -> bool {
    let (d, e) = (minus(b, a), minus(x, a));
    cross(&d, &e).iter().all(|c| *c == 0) && dot(&d, &e) >= 0 && dot(&d, &e) <= dot(&d, &d)
}

/// Whether two triangles with area meet outside the hull of the corners that they share by index.
fn meet(points: &[P], p: &[VertexId; 3], q: &[VertexId; 3]) -> bool {
    let shared: Vec<&P> = p.iter().filter(|v| q.contains(v)).map(|v| &points[v.at()]).collect();
    let allowed = |x: &P| match shared[..] {
        [a] => x == a,
        [a, b] => on_segment(x, a, b),
        _ => false,
    };
    let of = |t: &[VertexId; 3]| t.map(|v| points[v.at()].clone());
    let (tp, tq) = (of(p), of(q));
    [(&tp, &tq), (&tq, &tp)].into_iter().any(|(s, t)| {
        (0..3).any(|i| clip(&s[i], &s[(i + 1) % 3], t).is_some_and(|ends| ends.iter().any(|x| !allowed(x))))
    })
}

fn flat(points: &[P], t: &[VertexId; 3]) -> bool {
    let [a, b, c] = t.map(|v| &points[v.at()]);
    cross(&minus(b, a), &minus(c, a)).iter().all(|x| *x == 0)
}

/// All defects among triangles, by all pairs: twice a triangle without area, or two that meet.
fn brute(coords: &[[f64; 3]], triangles: &[[VertexId; 3]]) -> Vec<[TriangleId; 2]> {
    let points: Vec<P> = coords.iter().map(|x| point(*x)).collect();
    let is_flat: Vec<bool> = triangles.iter().map(|t| flat(&points, t)).collect();
    let boxes: Vec<[[f64; 2]; 3]> = triangles
        .iter()
        .map(|t| {
            std::array::from_fn(|i| {
                let x = t.map(|v| coords[v.at()][i]);
                [x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2])]
            })
        })
        .collect();
    // Boxes apart: the only shortcut, for the sake of time.
    let apart = |i: usize, j: usize| (0..3).any(|k| boxes[i][k][1] < boxes[j][k][0] || boxes[j][k][1] < boxes[i][k][0]);
    let mut found = Vec::new();
    for i in 0..triangles.len() {
        if is_flat[i] {
            found.push([TriangleId::of(i); 2]);
        }
        for j in i + 1..triangles.len() {
            if !is_flat[i] && !is_flat[j] && !apart(i, j) && meet(&points, &triangles[i], &triangles[j]) {
                found.push([TriangleId::of(i), TriangleId::of(j)]);
            }
        }
    }
    found.sort_unstable();
    found
}

fn checked(coords: &[[f64; 3]], triangles: &[[VertexId; 3]], marked: &[bool]) -> Vec<[TriangleId; 2]> {
    let alive = vec![true; triangles.len()];
    let s = Surface { coords, triangles, alive: &alive, marked, sides: &[], proven: &[] };
    contacts(&s, &build_bvh(coords, triangles))
}

#[test]
fn the_check_equals_all_pairs_in_rationals() {
    let mut random = Random(7);
    let (mut defects, mut clean) = (0, 0);
    for round in 0..300 {
        // Few places, so that everything touches everything; some a few ulps apart; shared corners are common.
        let n = 4 + random.below(12) as usize;
        let nudge = |random: &mut Random, x: f64| match round % 3 {
            0 => x,
            _ => x * (1.0 + random.below(3) as f64 * f64::EPSILON),
        };
        let coords: Vec<[f64; 3]> = (0..n)
            .map(|_| {
                [0; 3].map(|_| {
                    let x = random.within(2);
                    nudge(&mut random, x)
                })
            })
            .collect();
        let mut triangles = Vec::new();
        while triangles.len() < 10 {
            let t = [0; 3].map(|_| VertexId::of(random.below(n as u64) as usize));
            let mut sorted = t;
            sorted.sort_unstable();
            let repeated = triangles.iter().any(|o: &[VertexId; 3]| {
                let mut o = *o;
                o.sort_unstable();
                o == sorted
            });
            if sorted[0] != sorted[1] && sorted[1] != sorted[2] && !repeated {
                triangles.push(t);
            }
            if n == 4 && triangles.len() == 4 {
                break;
            }
        }
        let all = brute(&coords, &triangles);
        assert_eq!(checked(&coords, &triangles, &vec![true; triangles.len()]), all, "round {round}");
        // With marks: those that a marked triangle takes part in.
        let marked: Vec<bool> = triangles.iter().map(|_| random.below(3) == 0).collect();
        let is_flat = |t: TriangleId| all.contains(&[t; 2]);
        let wanted: Vec<_> = all.iter().copied().filter(|p| p.iter().any(|t| marked[t.at()])).collect();
        let got = checked(&coords, &triangles, &marked);
        let of_flat = |p: &&[TriangleId; 2]| !p.iter().any(|t| is_flat(*t) && !marked[t.at()]);
        assert_eq!(got.iter().filter(of_flat).collect::<Vec<_>>(), wanted.iter().collect::<Vec<_>>(), "round {round}");
        defects += all.len();
        clean += triangles.len() * (triangles.len() - 1) / 2 - all.len().min(45);
    }
    assert!(defects > 1000 && clean > 1000, "{defects} defects, {clean} clean pairs");
}

#[test]
fn the_sign_of_a_volume_is_exact() {
    let tet = |points: [[f64; 3]; 4]| {
        let t = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t: [usize; 3]| t.map(VertexId::of));
        volume_sign(&points, t.into_iter())
    };
    let (a, b, c) = ([0.1, 0.2, 0.3], [1.1, 0.2, 0.3], [0.1, 1.2, 0.3]);
    assert_eq!(tet([a, b, c, [0.3, 0.4, 0.3f64.next_up()]]), Sign::Positive);
    assert_eq!(tet([a, b, c, [0.3, 0.4, 0.3]]), Sign::Zero);
    assert_eq!(tet([a, b, c, [0.3, 0.4, 0.3f64.next_down()]]), Sign::Negative);
    // Products far below the least subnormal.
    let s = 1e-200;
    assert_eq!(tet([[0.0; 3], [s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, s]]), Sign::Positive);
    assert_eq!(tet([[0.0; 3], [s, 0.0, 0.0], [0.0, 0.0, s], [0.0, s, 0.0]]), Sign::Negative);
}

fn run(c: &Complex, options: &CertifyOptions) -> CertifiedComplex {
    let done = certify(c, options, &mut Run::quiet()).unwrap();
    done.check().unwrap();
    let maps = [
        (done.vertex_map.iter().map(|v| v.0).collect::<Vec<_>>(), done.coords.len(), c.vertex_count()),
        (done.face_map.iter().map(|f| f.0).collect(), done.triangles.len(), c.face_count()),
        (done.cell_map.iter().map(|k| k.0).collect(), done.cell_count, c.cell_count()),
    ];
    for (map, new, old) in maps {
        // Every number is met, and without the merged ones they rise.
        assert_eq!(map.len(), old);
        let mut met = vec![false; new];
        map.iter().filter(|&&i| i != u32::MAX).for_each(|&i| met[i as usize] = true);
        assert!(met.iter().all(|m| *m));
    }
    let r = &done.report;
    assert_eq!(r.removed_cells, done.cell_map.iter().filter(|k| k.is_none()).count());
    assert_eq!(r.removed_faces, done.face_map.iter().filter(|f| f.is_none()).count());
    assert_eq!(r.certified, r.open_faces.is_empty() && r.open_cells.is_empty());
    assert!(r.open_faces.iter().all(|[a, b]| a <= b && b.at() < c.face_count()));
    done
}

/// Six times the exact volume of each cell on the doubles.
fn volumes(done: &CertifiedComplex) -> Vec<Rational> {
    let mut six = vec![Rational::new(); done.cell_count];
    for (t, cells) in done.triangles.items.iter().zip(&done.triangle_cells) {
        let [a, b, c] = t.map(|v| point(done.coords[v.at()]));
        let cone = dot(&a, &cross(&b, &c));
        for (k, sign) in [(cells[0], 1), (cells[1], -1)] {
            if k.is_some() {
                six[k.at()] += Rational::from(&cone * sign);
            }
        }
    }
    six
}

/// What a certificate says, by the oracle.
fn verify(done: &CertifiedComplex) {
    assert!(done.report.certified, "{:?}", done.report);
    assert_eq!(brute(&done.coords, &done.triangles.items), Vec::<[TriangleId; 2]>::new());
    assert!(volumes(done).iter().all(|v| *v > 0));
}

fn cut_of(soup: &common::Soup, planes: &[Plane]) -> Complex {
    let mesh = Arc::new(build_soup(soup, Default::default()).unwrap());
    cut(&mesh, planes, &CutOptions::default(), &mut Run::quiet()).unwrap().complex
}

fn reference() -> common::Soup {
    tetrahedron([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
}

/// Planes i/n per axis: their points nearly lie on the tetrahedron's slanted face, or exactly.
fn thirds(n: usize) -> Vec<Plane> {
    (0..3).flat_map(|a| (0..=n).map(move |i| axis_plane(a, i as f64 / n as f64))).collect()
}

#[test]
fn what_rounds_well_stays_as_it_is() {
    let c = cut_cube(&[plane([1.0, 0.0, 0.0], -0.3), plane([0.3, 1.0, 0.7], -0.9), plane([0.1, 0.7, 1.3], -1.1)]);
    for c in [c, cube()] {
        let done = run(&c, &CertifyOptions { check_input: true, ..Default::default() });
        verify(&done);
        assert_eq!(done.coords, c.coords);
        assert!(done.vertex_map.iter().enumerate().all(|(i, v)| *v == VertexId::of(i)));
        assert!(done.face_map.iter().enumerate().all(|(i, f)| *f == FaceId::of(i)));
        assert!(done.cell_map.iter().enumerate().all(|(i, k)| *k == CellId::of(i)));
        assert_eq!((done.report.moved, done.report.merged, done.report.largest_move), (0, 0, 0.0));
        for (t, cells) in done.triangle_cells.iter().enumerate() {
            let f = done.triangles.offsets.partition_point(|&o| o as usize <= t) - 1;
            assert_eq!(*cells, c.face_cells[f]);
        }
    }
}

/// Planes one ulp apart have room for a cell between them.
#[test]
fn a_slab_of_one_ulp_stays() {
    let soup = common::cube(0.0, 2.0);
    let up = 1.0f64.next_up();
    let c = cut_of(&soup, &[axis_plane(0, 1.0), axis_plane(0, up), axis_plane(1, 0.7)]);
    assert_eq!(c.cell_count(), 6);
    let done = run(&c, &CertifyOptions::default());
    verify(&done);
    assert_eq!((done.report.moved, done.report.removed_cells), (0, 0));
}

/// Two planes 7x = d that differ, but not after rounding x: what is between them has no volume.
#[test]
fn a_slab_of_less_than_an_ulp_goes() {
    let soup = common::cube(0.0, 2.0);
    let mut d = 7.5f64;
    while d / 7.0 != d.next_up() / 7.0 {
        d = d.next_up();
    }
    let planes = [plane([7.0, 0.0, 0.0], -d), plane([7.0, 0.0, 0.0], -d.next_up()), axis_plane(1, 0.7)];
    let c = cut_of(&soup, &planes);
    let same = (0..c.vertex_count()).any(|v| (0..v).any(|u| c.coords[u] == c.coords[v]));
    assert!(same, "the planes are not close enough");
    let done = run(&c, &CertifyOptions::default());
    verify(&done);
    assert!(done.report.removed_cells > 0 && done.report.merged > 0 && done.report.removed_faces > 0);
    assert!(done.report.flat_before + done.report.contacts_before > 0);
    assert_eq!((done.report.largest_move, done.report.moved_mesh_vertices), (0.0, 0));
    // Nothing is lost of the cube.
    assert_eq!(volumes(&done).into_iter().fold(Rational::new(), |a, b| a + b), 48);
    // A removed cell lies between the two planes.
    for k in (0..c.cell_count()).filter(|&k| done.cell_map[k].is_none()) {
        let vertices = || c.cell_faces(CellId::of(k)).iter().flat_map(|h| &c.corner_vertices[c.face_corners(h.face())]);
        assert!(vertices().all(|v| (c.coords[v.at()][0] - d / 7.0).abs() < 1e-15));
    }
}

#[test]
fn cells_at_nearly_common_points_go() {
    for n in [5, 9] {
        let c = cut_of(&reference(), &thirds(n));
        let only = run(&c, &CertifyOptions { check_only: true, ..Default::default() });
        // Of pairs, those that bound one cell or the outside.
        let mut before = brute(&only.coords, &only.triangles.items);
        let any = !before.is_empty();
        before.retain(|[a, b]| only.triangle_cells[a.at()].iter().any(|k| only.triangle_cells[b.at()].contains(k)));
        assert_eq!(any, !before.is_empty());
        let flat = before.iter().filter(|[a, b]| a == b).count();
        assert_eq!((only.report.flat_before, only.report.contacts_before), (flat, before.len() - flat), "n = {n}");
        assert_eq!(only.report.certified, before.is_empty());
        assert_eq!((only.coords, only.report.moved), (c.coords.clone(), 0));
        let done = run(&c, &CertifyOptions::default());
        verify(&done);
        assert!(done.report.largest_move <= 16.0 * done.report.unit && done.report.moved_mesh_vertices == 0);
        if n == 9 {
            assert!(flat > 0 && done.report.removed_cells > 0);
        }
    }
}

/// Needles: tetrahedra a few ulps thin, cut across and along.
#[test]
fn needles_are_mended() {
    let mut random = Random(11);
    let (mut broken, mut moved) = (0, 0);
    for round in 0..60 {
        let e = f64::EPSILON * (1 + round % 5) as f64;
        let a = [1.0 + random.unit(), 1.0 + random.unit(), 1.0 + random.unit()];
        let along = [random.signed(), random.signed(), random.signed()];
        let at = |s: f64, i: usize| -> [f64; 3] {
            std::array::from_fn(|k| a[k] + s * along[k] + if k == i { 4.0 * e } else { 0.0 })
        };
        let mut points = [at(0.0, 3), at(0.3, 0), at(0.6, 1), at(1.0, 2)];
        let p = points.map(point);
        let volume = dot(&cross(&minus(&p[1], &p[0]), &minus(&p[2], &p[0])), &minus(&p[3], &p[0]));
        if volume == 0 {
            continue;
        }
        if volume < 0 {
            points.swap(0, 1);
        }
        let n = || std::array::from_fn::<f64, 3, _>(|_| 0.0);
        let mut planes = Vec::new();
        for _ in 0..3 {
            let mut normal = n();
            normal.iter_mut().for_each(|x| *x = random.signed());
            let s = random.unit();
            planes.push(common::models::through(normal, at(s, 3)));
        }
        let c = cut_of(&tetrahedron(points), &planes);
        let done = run(&c, &CertifyOptions::default());
        broken += (done.report.flat_before + done.report.contacts_before + done.report.shells_before > 0) as usize;
        moved += done.report.moved;
        if done.report.certified {
            verify(&done);
        } else {
            assert!(!brute(&done.coords, &done.triangles.items).is_empty() || !done.report.open_cells.is_empty());
        }
    }
    assert!(broken > 20 && moved > 0, "{broken} broken, {moved} moved");
}

#[test]
fn fixed_vertices_stay() {
    let c = cut_of(&reference(), &thirds(9));
    let free = run(&c, &CertifyOptions::default());
    assert!(free.report.moved + free.report.merged > 0);
    // Everything: nothing moves, nothing merges, and it is told.
    let done = run(&c, &CertifyOptions { fixed: vec![true; c.vertex_count()], ..Default::default() });
    assert_eq!((done.report.moved, done.report.merged, &done.coords), (0, 0, &c.coords));
    assert!(!done.report.certified && !done.report.open_faces.is_empty());
    // The vertices on one plane: these stay, others may merge into them.
    for p in 0..30 {
        let fixed: Vec<bool> = c.vertex_planes.rows().map(|row| row.iter().any(|q| q.at() == p)).collect();
        let done = run(&c, &CertifyOptions { fixed: fixed.clone(), ..Default::default() });
        for v in (0..c.vertex_count()).filter(|&v| fixed[v]) {
            assert!(done.vertex_map[v].is_some());
            assert_eq!(done.coords[done.vertex_map[v].at()], c.coords[v]);
        }
        if done.report.certified && p == 3 {
            verify(&done);
        }
    }
}

#[test]
fn threads_make_no_difference() {
    let c = cut_of(&reference(), &thirds(9));
    let with = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
        pool.install(|| run(&c, &CertifyOptions::default()))
    };
    let one = with(1);
    assert!(one.report.merged > 0);
    for n in [2, 3] {
        assert!(with(n) == one, "{n} threads");
    }
}

/// A removed cell is listed; scaled by a power of two the same ones are.
#[test]
fn scaling_by_powers_of_two_changes_nothing() {
    let done = |scale: f64| {
        let mut soup = reference();
        soup.vertices.iter_mut().flatten().for_each(|x| *x *= scale);
        let mut planes = thirds(9);
        planes.iter_mut().for_each(|p| p.d *= scale);
        run(&cut_of(&soup, &planes), &CertifyOptions::default())
    };
    let one = done(1.0);
    for scale in [1024.0, 2f64.powi(-60), 2f64.powi(300), 2f64.powi(-300)] {
        let other = done(scale);
        assert_eq!(other.triangles, one.triangles);
        assert_eq!(other.cell_map, one.cell_map);
        assert!(other.coords.iter().flatten().zip(one.coords.iter().flatten()).all(|(x, y)| *x == y * scale));
    }
}

#[derive(Default)]
struct Row {
    cuts: usize,
    clean_before: usize,
    certified: usize,
    moved: usize,
    merged: usize,
    cells: usize,
    largest: f64,
}

#[test]
fn real_models_are_certified() {
    let mut table: BTreeMap<usize, Row> = BTreeMap::new();
    let names = ["A5", "A10", "A20", "R10", "R30", "R100"];
    let mut failed = Vec::new();
    let there = each_model_or_all("LAPIDARY_LONG", 1500, |name, soup, mesh| {
        let mut random = Random(soup.triangles.len() as u64);
        let sets = [
            grid(&mesh, 5),
            grid(&mesh, 10),
            grid(&mesh, 20),
            arbitrary(&mesh, 10, &mut random),
            arbitrary(&mesh, 30, &mut random),
            arbitrary(&mesh, 100, &mut random),
        ];
        for (k, planes) in sets.iter().enumerate() {
            let c = cut(&mesh, planes, &CutOptions::default(), &mut Run::quiet()).unwrap().complex;
            let done = run(&c, &CertifyOptions::default());
            let r = &done.report;
            let row = table.entry(k).or_default();
            row.cuts += 1;
            row.clean_before += (r.flat_before + r.contacts_before + r.shells_before == 0) as usize;
            row.certified += r.certified as usize;
            row.moved += r.moved - r.merged.min(r.moved);
            row.merged += r.merged;
            row.cells += r.removed_cells;
            row.largest = row.largest.max(r.largest_move / r.unit);
            if !r.certified {
                failed.push(format!("{name} {}: {r:?}", names[k]));
            }
            // Again from scratch, all pairs, over the result.
            let marked = vec![true; done.triangles.items.len()];
            if !checked(&done.coords, &done.triangles.items, &marked).is_empty() && r.certified {
                failed.push(format!("{name} {}: certified, but is not", names[k]));
            }
        }
    });
    if !there {
        return;
    }
    let line = |what: &str, f: &dyn Fn(&Row) -> String| {
        println!("| {what} | {} |", table.values().map(f).collect::<Vec<_>>().join(" | "));
    };
    let share = |n: usize, of: usize| format!("{:.1} %", 100.0 * n as f64 / of as f64);
    println!("| | {} |", names.join(" | "));
    println!("| --- |{}", " ---: |".repeat(names.len()));
    line("without self-intersection, before repair", &|r| share(r.clean_before, r.cuts));
    line("certified", &|r| share(r.certified, r.cuts));
    line("vertices moved", &|r| r.moved.to_string());
    line("largest move, units", &|r| r.largest.to_string());
    line("vertices merged", &|r| r.merged.to_string());
    line("cells removed", &|r| r.cells.to_string());
    assert!(failed.is_empty(), "{failed:#?}");
}

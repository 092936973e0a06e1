//! One simplex: expected counts under every order of the functions, a construction straight from definitions in rationals, scaling,
//! degenerate and extreme values; `check` on everything.

use lapidary::exact::barycentric::distinct_planes;
use lapidary::network::simplex::*;
use rug::Rational;
use std::collections::BTreeSet;

type Values = Vec<Vec<f64>>;

#[derive(Default)]
struct Bench {
    scratch: Scratch,
    complex: SimplexComplex,
}

impl Bench {
    fn run(&mut self, kind: Kind, dim: usize, values: &[Vec<f64>]) -> &SimplexComplex {
        let flat = values.concat();
        match kind {
            Kind::Arrangement => arrangement(dim, &flat, &mut self.scratch, &mut self.complex),
            Kind::Interface => interface(dim, &flat, &mut self.scratch, &mut self.complex),
        }
        if let Err(e) = check(&self.complex, &flat) {
            panic!("{kind:?} of {values:?}: {e}");
        }
        &self.complex
    }
}

/// Elements by dimension: vertices, (edges,) faces, cells.
fn counts(c: &SimplexComplex) -> [usize; 4] {
    [c.vertex_count(), c.edge_count(), c.face_count(), c.cell_count()]
}

/// All orders of 0..n.
fn orders(n: usize) -> Vec<Vec<usize>> {
    let mut out = vec![vec![]];
    for k in 0..n {
        out = out
            .iter()
            .flat_map(|o| {
                (0..=k).map(move |i| {
                    let mut o = o.clone();
                    o.insert(i, k);
                    o
                })
            })
            .collect();
    }
    out
}

fn ordered(values: &[Vec<f64>], order: &[usize]) -> Values {
    order.iter().map(|&i| values[i].clone()).collect()
}

#[test]
fn expected_counts_in_every_order() {
    let cases: serde_json::Value = serde_json::from_str(include_str!("data/simplex-cases.json")).unwrap();
    let mut bench = Bench::default();
    for (kind, key) in [(Kind::Arrangement, "arrangement"), (Kind::Interface, "material_interface")] {
        for case in cases[key].as_array().unwrap() {
            let dim = case["dim"].as_u64().unwrap() as usize;
            let input: Values = serde_json::from_value(case["input"].clone()).unwrap();
            for order in orders(input.len()) {
                // Tied materials keep their order: the same labels, not only the same counts.
                let values = ordered(&input, &order);
                let c = bench.run(kind, dim, &values);
                let half_faces = c.cell_faces.items.len();
                let corners = |h: &LocalHalfFace| c.face_vertices.row(h.face()).len();
                for (what, expected) in case["expect"].as_object().unwrap() {
                    let found = match (what.as_str(), dim) {
                        ("cells", _) => c.cell_count(),
                        ("vertices", _) => c.vertex_count(),
                        ("faces", _) => c.face_count(),
                        ("half_faces", 3) | ("half_edges", 2) => half_faces,
                        ("half_edges", 3) => c.cell_faces.items.iter().map(corners).sum(),
                        ("unique_planes", _) => distinct_planes(dim, &values.concat()),
                        other => panic!("{other:?}"),
                    };
                    assert_eq!(
                        found as u64,
                        expected.as_u64().unwrap(),
                        "{what} of {} in order {order:?}",
                        case["name"]
                    );
                }
            }
        }
    }
}

#[test]
fn five_materials_of_which_one_is_everywhere_largest() {
    let f = [[1., 1., 0., -1.], [1., 0., 0., 0.], [1., -1., 0., 1.], [0., 1., 0., 1.], [1., 1., 1., 1.]];
    let f: Values = f.iter().map(|f| f.to_vec()).collect();
    let mut bench = Bench::default();
    for order in orders(5) {
        let c = bench.run(Kind::Interface, 3, &ordered(&f, &order));
        assert_eq!(counts(c), [4, 6, 4, 1], "{order:?}");
        assert_eq!(order[c.cell_owner[0].at()], 4);
    }
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }
    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }
    fn unit(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 30) as f64 - 1.0
    }
    /// Integers from -m to m.
    fn integers(&mut self, n: usize, dim: usize, m: u64) -> Values {
        (0..n).map(|_| (0..=dim).map(|_| self.below(2 * m + 1) as f64 - m as f64).collect()).collect()
    }
    fn reals(&mut self, n: usize, dim: usize) -> Values {
        (0..n).map(|_| (0..=dim).map(|_| self.unit()).collect()).collect()
    }
}

impl Random {
    /// Functions that nearly vanish (materials that are nearly equal) at a common point, on a common line or on a common plane:
    /// combinations of few functions with a zero inside, rounded.
    fn nearly_concurrent(&mut self, n: usize, dim: usize, rank: usize) -> Values {
        let weights: Vec<f64> = (0..=dim).map(|_| 1.5 + self.unit()).collect();
        let base: Values = (0..rank)
            .map(|_| {
                let mut f: Vec<f64> = (0..=dim).map(|_| self.unit()).collect();
                f[dim] = -(0..dim).map(|i| f[i] * weights[i]).sum::<f64>() / weights[dim];
                f
            })
            .collect();
        let combine = |r: &mut Self| -> Vec<f64> {
            let k: Vec<f64> = base.iter().map(|_| r.unit()).collect();
            (0..=dim).map(|i| base.iter().zip(&k).map(|(f, k)| f[i] * k).sum()).collect()
        };
        (0..n).map(|_| combine(self)).collect()
    }
}

/// Rank of a matrix of rationals; and a vector of its kernel if that has one dimension.
fn eliminate(mut m: Vec<Vec<Rational>>, columns: usize) -> (usize, Option<Vec<Rational>>) {
    let mut pivots = vec![];
    let mut row = 0;
    for c in 0..columns {
        let Some(p) = (row..m.len()).find(|&r| m[r][c] != 0) else { continue };
        m.swap(row, p);
        let inverse = m[row][c].clone().recip();
        m[row].iter_mut().for_each(|x| *x *= &inverse);
        let pivot = m[row].clone();
        for (_, other) in m.iter_mut().enumerate().filter(|(r, _)| *r != row) {
            let k = other[c].clone();
            other.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= Rational::from(p * &k));
        }
        pivots.push(c);
        row += 1;
    }
    let kernel = (pivots.len() + 1 == columns).then(|| {
        let free = (0..columns).find(|c| !pivots.contains(c)).unwrap();
        let mut x = vec![Rational::new(); columns];
        x[free] = Rational::from(1);
        for (r, &c) in pivots.iter().enumerate() {
            x[c] = -m[r][free].clone();
        }
        x
    });
    (pivots.len(), kernel)
}

fn rational(x: f64) -> Rational {
    Rational::from_f64(x).unwrap()
}

/// All subsets of `k` of `0..n`, rising.
fn subsets(n: usize, k: usize) -> Vec<Vec<usize>> {
    if k == 0 {
        return vec![vec![]];
    }
    (k - 1..n)
        .flat_map(|last| {
            subsets(last, k - 1).into_iter().map(move |mut s| {
                s.push(last);
                s
            })
        })
        .collect()
}

/// Points where `k` independent ones of these linear forms (in barycentric or lifted coordinates) vanish, that pass.
fn meets(rows: &[Vec<Rational>], accept: impl Fn(&[Rational]) -> bool, dim: usize) -> BTreeSet<Vec<Rational>> {
    let columns = rows[0].len();
    let mut out = BTreeSet::new();
    for s in subsets(rows.len(), columns - 1) {
        let (_, kernel) = eliminate(s.iter().map(|&i| rows[i].clone()).collect(), columns);
        if let Some(x) = kernel {
            let sum = x[..=dim].iter().fold(Rational::new(), |s, x| s + x);
            if sum != 0 {
                let x: Vec<Rational> = x.into_iter().map(|x| x / &sum).collect();
                if accept(&x) {
                    out.insert(x);
                }
            }
        }
    }
    out
}

fn dot(a: &[Rational], b: &[Rational]) -> Rational {
    a.iter().zip(b).fold(Rational::new(), |s, (a, b)| s + Rational::from(a * b))
}

fn rank_of(points: &[&Vec<Rational>]) -> usize {
    points.first().map_or(0, |p| eliminate(points.iter().map(|&p| p.clone()).collect(), p.len()).0)
}

fn facets(dim: usize) -> impl Iterator<Item = Vec<Rational>> {
    (0..=dim).map(move |i| (0..=dim).map(|j| Rational::from((i == j) as i32)).collect())
}

/// Counts of the arrangement from incidences: vertices are the points of rank dim; each line of the planes' has one segment fewer
/// than vertices; Euler's formula gives the rest, in each plane and in all.
fn expected_arrangement(dim: usize, values: &[Vec<f64>]) -> [usize; 4] {
    let mut planes: Vec<Vec<Rational>> = facets(dim).collect();
    for f in values {
        let f: Vec<Rational> = f.iter().map(|&x| rational(x)).collect();
        if f.iter().any(|x| *x != 0) && planes.iter().all(|p| eliminate(vec![p.clone(), f.clone()], dim + 1).0 == 2) {
            planes.push(f);
        }
    }
    let points = meets(&planes, |x| x.iter().all(|x| *x >= 0), dim);
    let points: Vec<&Vec<Rational>> = points.iter().collect();
    let on = |p: &Vec<Rational>| -> BTreeSet<usize> { (0..points.len()).filter(|&i| dot(p, points[i]) == 0).collect() };
    let on: Vec<BTreeSet<usize>> = planes.iter().map(on).collect();
    let pick = |s: &BTreeSet<usize>| -> Vec<&Vec<Rational>> { s.iter().map(|&i| points[i]).collect() };
    // In 2-D the planes are the lines.
    let lines: BTreeSet<BTreeSet<usize>> = if dim == 2 {
        on.iter().filter(|s| s.len() >= 2).cloned().collect()
    } else {
        subsets(planes.len(), 2)
            .iter()
            .map(|s| on[s[0]].intersection(&on[s[1]]).copied().collect::<BTreeSet<_>>())
            .filter(|s| s.len() >= 2)
            .collect()
    };
    let segments: usize = lines.iter().map(|l| l.len() - 1).sum();
    let v = points.len();
    if dim == 2 {
        return [v, 0, segments, 1 + segments - v];
    }
    let mut faces = 0;
    for s in on.iter().filter(|s| rank_of(&pick(s)) == 3) {
        let edges: usize = lines.iter().filter(|l| l.is_subset(s)).map(|l| l.len() - 1).sum();
        faces += 1 + edges - s.len();
    }
    [v, segments, faces, v + faces - segments - 1]
}

/// Counts of the interface from the polyhedron above the envelope: vertices are its points of full rank; cells and faces
/// are the sets of vertices on one hyperplane, on two, of the right rank.
fn expected_interface(dim: usize, values: &[Vec<f64>]) -> [usize; 4] {
    let lift = |f: Vec<Rational>, w: i32| -> Vec<Rational> { f.into_iter().chain([Rational::from(w)]).collect() };
    let mut planes: Vec<Vec<Rational>> = facets(dim).map(|f| lift(f, 0)).collect();
    for f in values {
        let f = lift(f.iter().map(|&x| rational(x)).collect(), -1);
        if !planes.contains(&f) {
            planes.push(f);
        }
    }
    let inside = |x: &[Rational]| {
        planes.iter().enumerate().all(|(i, p)| {
            let d = dot(p, x);
            if i <= dim { d >= 0 } else { d <= 0 }
        })
    };
    let points = meets(&planes, inside, dim);
    let points: Vec<&Vec<Rational>> = points.iter().collect();
    let on = |p: &Vec<Rational>| -> BTreeSet<usize> { (0..points.len()).filter(|&i| dot(p, points[i]) == 0).collect() };
    let on: Vec<BTreeSet<usize>> = planes.iter().map(on).collect();
    let rank = |s: &BTreeSet<usize>| rank_of(&s.iter().map(|&i| points[i]).collect::<Vec<_>>());
    let owners: Vec<usize> = (dim + 1..planes.len()).filter(|&i| rank(&on[i]) == dim + 1).collect();
    let real: Vec<usize> = (0..=dim).chain(owners.iter().copied()).collect();
    let shared = |s: &[usize]| -> BTreeSet<usize> {
        s.iter()
            .map(|&i| &on[real[i]])
            .fold((0..points.len()).collect(), |a: BTreeSet<usize>, b| a.intersection(b).copied().collect())
    };
    let faces = |k: usize, wanted: usize| {
        let sets: BTreeSet<BTreeSet<usize>> = subsets(real.len(), k)
            .iter()
            .filter(|s| real[s[k - 1]] > dim)
            .map(|s| shared(s))
            .filter(|s| rank(s) == wanted)
            .collect();
        sets.len()
    };
    let edges = if dim == 3 { faces(3, 2) } else { 0 };
    [points.len(), edges, faces(2, dim), owners.len()]
}

fn expected(kind: Kind, dim: usize, values: &[Vec<f64>]) -> [usize; 4] {
    match kind {
        Kind::Arrangement => expected_arrangement(dim, values),
        Kind::Interface => expected_interface(dim, values),
    }
}

const KINDS: [Kind; 2] = [Kind::Arrangement, Kind::Interface];

/// Some seconds; with LAPIDARY_LONG=1 5000 simplices of each kind and number, a quarter of an hour.
#[test]
fn degenerate_and_nearly_so_agree_with_rationals() {
    let long = std::env::var_os("LAPIDARY_LONG").is_some();
    let mut bench = Bench::default();
    let mut r = Random(7);
    for kind in KINDS {
        for dim in [2, 3] {
            for n in 1..=if long { 7 } else { 5 } {
                for m in [1, 2, 5] {
                    for _ in 0..if long { 5000 } else { 40 } {
                        let values =
                            if m == 5 { r.nearly_concurrent(n, dim, 1 + n % 3) } else { r.integers(n, dim, m) };
                        let found = counts(bench.run(kind, dim, &values));
                        assert_eq!(found, expected(kind, dim, &values), "{kind:?} {dim} {values:?}");
                    }
                }
            }
        }
    }
}

/// A signature that does not depend on the order of functions: for each element its carrier and its functions, by their original numbers.
fn signature(c: &SimplexComplex, order: &[usize]) -> Vec<Vec<Vec<usize>>> {
    let names = |row: &[LocalFunction]| -> Vec<usize> {
        let mut s: Vec<usize> = row.iter().map(|f| order[f.at()]).collect();
        s.sort_unstable();
        s
    };
    let vertex = |v: LocalVertex| -> Vec<usize> {
        [c.vertex_carrier[v.at()].0 as usize + 1000].into_iter().chain(names(c.vertex_functions.row(v))).collect()
    };
    let mut vertices: Vec<Vec<usize>> = (0..c.vertex_count()).map(|v| vertex(LocalVertex::of(v))).collect();
    let mut faces: Vec<Vec<usize>> = (0..c.face_count())
        .map(|f| {
            let mut corners: Vec<Vec<usize>> = c.face_vertices.row(f).iter().map(|&v| vertex(v)).collect();
            corners.sort();
            let mut all = names(c.face_functions(LocalFace::of(f)));
            all.extend(corners.concat());
            all
        })
        .collect();
    let mut cells: Vec<Vec<usize>> = (0..c.cell_count())
        .map(|k| match c.kind {
            Kind::Interface => {
                [vec![order[c.cell_owner[k].at()], c.cell_faces.row(k).len()], names(c.cell_materials.row(k))].concat()
            }
            Kind::Arrangement => {
                let sign = |f: usize| c.cell_sign(LocalCell::of(k), LocalFunction::of(f)).to_i8() + 1;
                let mut s: Vec<(usize, usize)> = (0..order.len()).map(|f| (order[f], sign(f) as usize)).collect();
                s.sort_unstable();
                s.into_iter().map(|x| x.1).chain([c.cell_faces.row(k).len()]).collect()
            }
        })
        .collect();
    vertices.sort();
    faces.sort();
    cells.sort();
    vec![vertices, faces, cells]
}

#[test]
fn orders_and_scales_change_nothing() {
    let mut bench = Bench::default();
    let mut r = Random(11);
    for kind in KINDS {
        for dim in [2, 3] {
            for case in 0..60 {
                let n = 2 + case % 6;
                let mut values = match case % 3 {
                    0 => r.integers(n, dim, 1),
                    1 => r.reals(n, dim),
                    _ => r.nearly_concurrent(n, dim, 1 + case / 3 % 3),
                };
                if case % 4 == 1 {
                    // A doubled, a negated and an equal function.
                    values.push(values[0].iter().map(|x| 2.0 * x).collect());
                    values.push(values[1].iter().map(|x| -x).collect());
                    values.push(values[0].clone());
                }
                let all: Vec<usize> = (0..values.len()).collect();
                let expected = signature(bench.run(kind, dim, &values), &all);
                for _ in 0..6 {
                    let mut order = all.clone();
                    for i in (1..order.len()).rev() {
                        order.swap(i, r.below(i as u64 + 1) as usize);
                    }
                    // The lowest of equal materials owns: they keep their order.
                    let mut k = 0;
                    while kind == Kind::Interface && k < order.len() {
                        match (k + 1..order.len())
                            .find(|&j| values[order[j]] == values[order[k]] && order[j] < order[k])
                        {
                            Some(j) => order.swap(j, k),
                            None => k += 1,
                        }
                    }
                    assert_eq!(
                        signature(bench.run(kind, dim, &ordered(&values, &order)), &order),
                        expected,
                        "{values:?} {order:?}"
                    );
                }
                for e in [-900, -300, 300, 900] {
                    let s = 2f64.powi(e);
                    let scaled: Values = values.iter().map(|f| f.iter().map(|x| x * s).collect()).collect();
                    assert_eq!(signature(bench.run(kind, dim, &scaled), &all), expected, "{values:?} by 2^{e}");
                }
                if kind == Kind::Arrangement {
                    let power = |k: usize| 2f64.powi([900, -900, 0, -1000, 20][k % 5]);
                    let scaled: Values =
                        values.iter().enumerate().map(|(k, f)| f.iter().map(|x| x * power(k)).collect()).collect();
                    assert_eq!(signature(bench.run(kind, dim, &scaled), &all), expected, "{values:?} mixed");
                }
            }
        }
    }
}

/// The construction may begin with what a table says of the first two functions: for every pair of sign patterns, with what ties there are
/// among small integers, the rest of the complex is the one that begins with the bare simplex.
#[test]
fn beginning_with_a_table_changes_nothing() {
    let mut bench = Bench::default();
    let (mut scratch, mut bare) = (Scratch::default(), SimplexComplex::default());
    let mut r = Random(23);
    let mut crossed = [0; 3];
    for patterns in 0..6561usize {
        let sign = |k: usize| [-1.0, 0.0, 1.0][patterns / 3usize.pow(k as u32) % 3];
        let most = 1 + patterns as u64 % 4;
        let mut values: Values =
            (0..2).map(|f| (0..4).map(|c| sign(4 * f + c) * (1 + r.below(most)) as f64).collect()).collect();
        crossed[values.iter().filter(|f| f.contains(&-1.0) && f.contains(&1.0)).count()] += 1;
        values.extend(if patterns % 2 == 0 { r.integers(2, 3, 2) } else { r.reals(2, 3) });
        if patterns % 5 == 0 {
            values.push(values[patterns % 2].iter().map(|x| -3.0 * x).collect());
        }
        let all: Vec<usize> = (0..values.len()).collect();
        let flat = values.concat();
        arrangement_incremental(3, &flat, &mut scratch, &mut bare);
        check(&bare, &flat).unwrap();
        assert_eq!(signature(bench.run(Kind::Arrangement, 3, &values), &all), signature(&bare, &all), "{values:?}");
    }
    assert!(crossed.iter().all(|&n| n > 100), "{crossed:?}");
}

#[test]
fn mixed_magnitudes() {
    let mut bench = Bench::default();
    let mut r = Random(13);
    let numbers = [
        0.0,
        5e-324,
        -5e-324,
        1e-308,
        1e-200,
        -1e-200,
        1.0,
        -1.0,
        1.0 + f64::EPSILON,
        1e16,
        -1e300,
        f64::MAX,
        f64::MIN,
    ];
    for kind in KINDS {
        for dim in [2, 3] {
            for case in 0..150 {
                let n = 1 + case % 4;
                let values: Values = (0..n)
                    .map(|_| (0..=dim).map(|_| numbers[r.below(numbers.len() as u64) as usize]).collect())
                    .collect();
                let found = counts(bench.run(kind, dim, &values));
                assert_eq!(found, expected(kind, dim, &values), "{kind:?} {dim} {values:?}");
            }
        }
    }
}

#[test]
fn planes_through_one_line_one_point_and_nearly_so() {
    let mut bench = Bench::default();
    // A pencil: f + k g vanishes where f and g do.
    let pencil = |k: f64| vec![1.0 + k, -1.0 + k, 1.0 - k, -1.0 - k];
    let values: Values = (0..12).map(|k| pencil(k as f64)).collect();
    let c = bench.run(Kind::Arrangement, 3, &values);
    assert_eq!(counts(c), expected_arrangement(3, &values));
    let mut values: Values = (0..5).map(|k| pencil(k as f64)).collect();
    values.push(vec![1.0 + f64::EPSILON, -1.0, 1.0, -1.0]);
    values.push(vec![1.0, -1.0, 1.0, -1.0 + f64::EPSILON]);
    let c = bench.run(Kind::Arrangement, 3, &values);
    assert_eq!(counts(c), expected_arrangement(3, &values));
    // Through the centre: values that add up to zero.
    let mut r = Random(17);
    let values: Values = (0..7)
        .map(|_| {
            let f = r.integers(1, 2, 9).remove(0);
            let last = -f.iter().sum::<f64>();
            [f, vec![last]].concat()
        })
        .collect();
    let c = bench.run(Kind::Arrangement, 3, &values);
    assert_eq!(counts(c), expected_arrangement(3, &values));
}

/// A polygon of 80 sides, tangents of a circle around the centre, which the last function cuts in two.
#[test]
fn long_loops() {
    let mut bench = Bench::default();
    let n = 80;
    let tangent = |k: usize| {
        let a = (k * 33 % n) as f64 / n as f64 * std::f64::consts::TAU;
        let corner = |t: f64| (t * std::f64::consts::TAU / 3.0 - a).cos() - 0.25;
        vec![corner(0.0), corner(1.0), corner(2.0)]
    };
    let mut values: Values = (0..n).map(tangent).collect();
    values.push(vec![0.1, -0.1, 0.0]);
    let longest = |rows: &mut dyn Iterator<Item = usize>| rows.max().unwrap();
    let c = bench.run(Kind::Arrangement, 2, &values);
    assert_eq!(longest(&mut c.cell_faces.rows().map(|r| r.len())), n / 2 + 2);
    // The same as materials around one that is zero.
    values.insert(0, vec![0.0; 3]);
    let c = bench.run(Kind::Interface, 2, &values);
    assert_eq!(longest(&mut c.cell_faces.rows().map(|r| r.len())), n / 2 + 2);
    // In a tetrahedron, the same on planes through its last corner.
    let values: Values = values[..=n].iter().map(|f| [&f[..], &[0.0]].concat()).collect();
    let c = bench.run(Kind::Interface, 3, &values);
    assert_eq!(longest(&mut c.face_vertices.rows().map(|r| r.len())), n);
}

#[test]
fn ties_are_named() {
    let mut bench = Bench::default();
    let flat = |rows: &[[f64; 4]]| -> Values { rows.iter().map(|r| r.to_vec()).collect() };
    // f, 2f, -f share one plane; a zero function and one that touches at an edge split nothing.
    let f = [1.0, 1.0, -1.0, -1.0];
    let c = bench.run(
        Kind::Arrangement,
        3,
        &flat(&[f, f.map(|x| 2.0 * x), f.map(|x| -x), [0.0; 4], [0.0, 0.0, 1.0, 2.0], [0.0, 0.0, 0.0, -1.0]]),
    );
    assert_eq!(c.cell_count(), 2);
    let inner: Vec<usize> = (0..c.face_count()).filter(|&f| c.face_cells[f][1].is_some()).collect();
    assert_eq!(inner.len(), 1);
    let ids = |row: &[LocalFunction]| row.iter().map(|f| f.at()).collect::<Vec<_>>();
    assert_eq!(ids(c.face_functions(LocalFace::of(inner[0]))), [0, 1, 2]);
    let range = c.plane_functions.range(c.face_plane[inner[0]]);
    assert_eq!(&c.plane_opposite[range], [false, false, true]);
    assert_eq!(c.zero_functions, [0b1000]);
    assert_eq!(ids(c.plane_functions.row(3usize)), [5]);
    assert_eq!(ids(c.vertex_functions.row(0usize)), [4, 5]);
    // Equal materials: the first owns; one that is largest on a facet only has no cell but is named there.
    let c = bench.run(
        Kind::Interface,
        3,
        &flat(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0], [0.0; 4], [-1.0, -1.0, -1.0, 1.0]]),
    );
    assert_eq!(c.cell_count(), 1);
    assert_eq!(ids(c.cell_materials.row(0usize)), [0, 1]);
    let facet = (0..4).find(|&f| c.face_support[f] == FaceSupport::Facet(3)).unwrap();
    assert_eq!(ids(c.face_functions(LocalFace::of(facet))), [0, 1, 2]);
    assert_eq!(ids(c.vertex_functions.row(3usize)), [0, 1, 3]);
}

#[test]
fn many_functions() {
    let mut bench = Bench::default();
    let mut r = Random(19);
    for kind in KINDS {
        for dim in [2, 3] {
            let values = r.reals(if kind == Kind::Arrangement { 14 } else { 40 }, dim);
            bench.run(kind, dim, &values);
        }
    }
    // Labels of more than one word.
    let values: Values = (0..70).map(|k| vec![k as f64 - 30.5, k as f64 - 40.25, 1.0, 2.0]).collect();
    bench.run(Kind::Arrangement, 3, &values);
}

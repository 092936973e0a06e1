//! Whether what was extracted from an arrangement is a solid, found by means that share nothing with how it was made: rationals, and boxes of
//! rounded corners that pair up the triangles to be asked.
#![allow(dead_code)]

use super::common::Soup;
use lapidary::arrangement::{
    Arrangement, ArrangementOptions, Extraction, Operand, Selection, arrange, choose, extract,
};
use lapidary::base::{CellId, Run, UnionFind, VertexId};
use lapidary::exact::residue::point_residues;
use lapidary::exact::{self, Residue};
use lapidary::mesh::bvh::build_bvh;
use rug::Rational;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// An exact point.
pub type P = [Rational; 3];

pub fn operands<'a>(soups: &[&'a Soup]) -> Vec<Operand<'a>> {
    soups.iter().map(|s| Operand { vertices: &s.vertices, triangles: &s.triangles }).collect()
}

pub fn arranged(soups: &[&Soup]) -> Arrangement {
    arrange(&operands(soups), &ArrangementOptions::default(), &mut Run::quiet()).expect("an arrangement")
}

pub fn extracted(a: &Arrangement, selection: Selection) -> Extraction {
    extract(a, &choose(a, selection).expect("a bounded selection")).expect("a solid")
}

/// Winding numbers of a cell, one for each operand.
pub fn dense(a: &Arrangement, c: usize) -> Vec<i32> {
    let mut row = vec![0; a.operand_count()];
    a.winding(CellId::of(c)).iter().for_each(|w| row[w.0.at()] = w.1);
    row
}

pub fn exact_point(x: &[f64; 3]) -> P {
    x.map(|c| Rational::from_f64(c).expect("a finite number"))
}

pub fn minus(a: &P, b: &P) -> P {
    std::array::from_fn(|i| Rational::from(&a[i] - &b[i]))
}

pub fn cross(a: &P, b: &P) -> P {
    let minor = |i: usize, j: usize| Rational::from(&a[i] * &b[j]) - Rational::from(&a[j] * &b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

pub fn dot(a: &P, b: &P) -> Rational {
    (0..3).map(|i| Rational::from(&a[i] * &b[i])).sum()
}

pub fn is_zero(a: &P) -> bool {
    a.iter().all(|x| x.is_zero())
}

/// Six times the volume that a mesh winds around, counted as often as it does, modulo two primes.
pub fn six_volume(s: &Soup) -> Residue {
    let p: Vec<[Residue; 3]> = s.vertices.iter().map(|x| x.map(Residue::from_f64)).collect();
    let cone = |t: &[i32; 3]| {
        let [a, b, c] = t.map(|v| p[v as usize]);
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
    };
    s.triangles.iter().map(cone).sum()
}

/// The volume that a mesh winds around, counted as often as it does.
pub fn signed_volume(s: &Soup) -> Rational {
    let p: Vec<P> = s.vertices.iter().map(exact_point).collect();
    let cone = |t: &[i32; 3]| dot(&p[t[0] as usize], &cross(&p[t[1] as usize], &p[t[2] as usize]));
    s.triangles.iter().map(cone).sum::<Rational>() / 6
}

/// The common points of a segment and a triangle (closed), as a segment: none, or two ends that may be equal.
pub fn segment_in_triangle(s: [&P; 2], t: [&P; 3]) -> Option<[P; 2]> {
    let normal = cross(&minus(t[1], t[0]), &minus(t[2], t[0]));
    let heights = s.map(|p| dot(&normal, &minus(p, t[0])));
    let at = |x: &Rational| -> P { std::array::from_fn(|i| Rational::from(&s[1][i] - &s[0][i]) * x + &s[0][i]) };
    // The parameters within the triangle's plane, then within each side.
    let (mut lo, mut hi) = (Rational::new(), Rational::from(1));
    if !(heights[0].is_zero() && heights[1].is_zero()) {
        if heights[0].cmp0() == heights[1].cmp0() {
            return None;
        }
        let x = &heights[0] / Rational::from(&heights[0] - &heights[1]);
        (lo, hi) = (x.clone(), x);
    }
    for k in 0..3 {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        let inward = cross(&normal, &minus(b, a));
        let [f, g] = [&lo, &hi].map(|x| dot(&inward, &minus(&at(x), a)));
        match (f.cmp0(), g.cmp0()) {
            (Ordering::Less, Ordering::Less) => return None,
            (Ordering::Less, _) => {
                let x = &f / Rational::from(&f - &g);
                lo += Rational::from(&hi - &lo) * x;
            }
            (_, Ordering::Less) => {
                let x = &f / Rational::from(&f - &g);
                hi = Rational::from(&hi - &lo) * x + &lo;
            }
            _ => {}
        }
    }
    Some([at(&lo), at(&hi)])
}

/// Everything that two triangles have in common lies in the corners and edges that they share by index.
pub fn fit<I: Copy + PartialEq>(points: impl Fn(I) -> P, f: &[I; 3], g: &[I; 3]) -> bool {
    let (pf, pg) = (f.map(&points), g.map(&points));
    let shared: Vec<&P> = (0..3).filter(|&i| g.contains(&f[i])).map(|i| &pf[i]).collect();
    if shared.len() == 3 {
        return false;
    }
    let on_shared = |x: &P| match shared[..] {
        [] => false,
        [a] => a == x,
        [a, b, ..] => {
            let (d, e) = (minus(b, a), minus(x, a));
            is_zero(&cross(&d, &e)) && dot(&d, &e) >= 0 && dot(&d, &minus(x, b)) <= 0
        }
    };
    for (s, t) in [(&pf, &pg), (&pg, &pf)] {
        for k in 0..3 {
            if let Some(ends) = segment_in_triangle([&s[k], &s[(k + 1) % 3]], t.each_ref())
                && !ends.iter().all(on_shared)
            {
                return false;
            }
        }
    }
    true
}

/// Where a corner is off the plane of a triangle, if doubles tell that for sure: corners are within an ulp or so of what is exact.
fn certain_side(t: &[[f64; 3]; 3], x: &[f64; 3]) -> Option<bool> {
    let d = |p: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| p[i] - t[0][i]) };
    let (e, f, g) = (d(&t[1]), d(&t[2]), d(x));
    let mut det = 0.0;
    let size = |v: &[f64; 3]| v.iter().map(|c| c.abs()).sum::<f64>();
    for (i, x) in g.iter().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        det += x * (e[j] * f[k] - e[k] * f[j]);
    }
    let most = t.iter().chain([x]).flatten().fold(0.0f64, |m, c| m.max(c.abs()));
    let (a, b, c) = (size(&e), size(&f), size(&g));
    // 100 times what first-order errors of the coordinates and of the arithmetic come to.
    let bound = 100.0 * f64::EPSILON * (most * (a * b + b * c + c * a) + a * b * c);
    (det.abs() > bound).then_some(det > 0.0)
}

/// All that is not shared of one is surely on one side of the other's plane.
fn off_plane(coords: &[[f64; 3]], f: &[u32; 3], g: &[u32; 3]) -> bool {
    let of = |t: &[u32; 3]| t.map(|v| coords[v as usize]);
    let mut sides = f.iter().filter(|v| !g.contains(v)).map(|&v| certain_side(&of(g), &coords[v as usize]));
    let Some(first) = sides.next() else { return false };
    first.is_some() && sides.all(|s| s == first)
}

/// Seen along some axis, the line of an edge of one has its third corner surely on one side, and all of the other but ends of that edge
/// surely on the other side: then what they have in common is what they share of the edge.
fn off_edge(coords: &[[f64; 3]], f: &[u32; 3], g: &[u32; 3]) -> bool {
    let x = |v: u32| &coords[v as usize];
    let most = f.iter().chain(g).flat_map(|&v| x(v)).fold(0.0f64, |m, c| m.max(c.abs()));
    (0..3).any(|axis| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let turn = |a: u32, b: u32, c: u32| {
            let (a, b, c) = (x(a), x(b), x(c));
            let (p, q) = ([b[i] - a[i], b[j] - a[j]], [c[i] - a[i], c[j] - a[j]]);
            let (l, r) = (p[0] * q[1], p[1] * q[0]);
            let bound = 50.0
                * f64::EPSILON
                * (most * (p[0].abs() + p[1].abs() + q[0].abs() + q[1].abs() + most * f64::EPSILON)
                    + l.abs()
                    + r.abs());
            ((l - r).abs() > bound).then_some(l > r)
        };
        (0..3).any(|k| {
            let (a, b, c) = (f[k], f[(k + 1) % 3], f[(k + 2) % 3]);
            let Some(inside) = turn(a, b, c) else { return false };
            g.iter().all(|&v| v == a || v == b || turn(a, b, v) == Some(!inside))
        })
    })
}

/// Whether doubles tell that two triangles have nothing in common but what they share by index.
pub fn surely_apart(coords: &[[f64; 3]], f: &[u32; 3], g: &[u32; 3]) -> bool {
    [(f, g), (g, f)].into_iter().any(|(f, g)| off_plane(coords, f, g) || off_edge(coords, f, g))
}

/// Stands for an exact point: its rounded coordinates, and what it is modulo two primes. Points with equal ones are the same but for a chance of 2⁻³⁶⁶.
pub type Place = [u64; 9];

pub fn place(a: &Arrangement, v: VertexId) -> Place {
    let (x, r) = (a.coords(v), point_residues(&a.point(v)).expect("no prime divides it"));
    std::array::from_fn(|i| if i < 3 { x[i].to_bits() } else { r[(i - 3) / 2].0[(i - 3) % 2] })
}

/// The exact points of an extraction.
pub fn points_of(a: &Arrangement, e: &Extraction) -> Vec<P> {
    e.vertices.iter().map(|&v| exact::rational(&a.point(v))).collect()
}

/// Distinct corners with rounded coordinates, no triangle without area, each edge walked as often both ways, no two triangles in contact but in what
/// they share, and winding number 1 behind every triangle and 0 before it.
pub fn assert_solid(a: &Arrangement, e: &Extraction, what: &str) {
    let n = e.triangles.len();
    assert!(e.births.len() == n && e.flipped.len() == n && e.faces.len() == n, "{what}: lengths");
    assert_eq!(e.vertices.len(), e.coords.len(), "{what}: lengths");
    let points = points_of(a, e);
    let places: BTreeSet<Place> = e.vertices.iter().map(|&v| place(a, v)).collect();
    assert_eq!(places.len(), points.len(), "{what}: corners at one place");
    let mut edges: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (i, t) in e.triangles.iter().enumerate() {
        for k in 0..3 {
            let (from, to) = (t[k], t[(k + 1) % 3]);
            edges.entry([from.min(to), from.max(to)]).or_default().push((i, from < to));
        }
    }
    // Triangles joined across edges with two.
    let mut sheets = UnionFind::new(n);
    for (ends, uses) in &edges {
        let forward = uses.iter().filter(|u| u.1).count();
        assert_eq!(2 * forward, uses.len(), "{what}: the edge {ends:?} is not balanced");
        if let [x, y] = uses[..] {
            sheets.union(x.0, y.0);
        }
    }
    let corners: Vec<[VertexId; 3]> = e.triangles.iter().map(|t| t.map(VertexId)).collect();
    let point = |v: u32| points[v as usize].clone();
    build_bvh(&e.coords, &corners).meeting_pairs(|s, t| {
        let (f, g) = (&e.triangles[s.at()], &e.triangles[t.at()]);
        if !surely_apart(&e.coords, f, g) {
            assert!(fit(point, f, g), "{what}: triangles {} and {} meet", s.0, t.0);
        }
        true
    });
    let (sheet, count) = sheets.labels();
    let mut seen = vec![false; count];
    for t in 0..n {
        if !std::mem::replace(&mut seen[sheet[t] as usize], true) {
            assert_eq!(windings(e, &points, t), [1, 0], "{what}: winding numbers behind and before triangle {t}");
        }
    }
}

/// Winding numbers just behind and before a triangle: a line through a point inside it tells them by what it leaves beyond that.
fn windings(e: &Extraction, points: &[P], t: usize) -> [i64; 2] {
    let [a, b, c] = e.triangles[t].map(|v| &points[v as usize]);
    let normal = cross(&minus(b, a), &minus(c, a));
    assert!(!is_zero(&normal), "triangle {t} has no area");
    let axis = (0..3).max_by(|&i, &j| normal[i].cmp_abs(&normal[j])).unwrap();
    let beyond = (2i64..).find_map(|k| {
        let p: P = std::array::from_fn(|i| {
            let sum = Rational::from(&b[i] * k) + Rational::from(&c[i] * (k * k)) + &a[i];
            sum / (1 + k + k * k)
        });
        let near = p.each_ref().map(|c| c.to_f64());
        let others = (0..e.triangles.len()).filter(|&o| o != t && may_cross(e, o, &near, axis));
        others.map(|o| crossing(e, points, o, &p, axis)).sum::<Option<i64>>()
    });
    let beyond = beyond.expect("one of the lines meets no edge");
    if normal[axis] > 0 { [beyond + 1, beyond] } else { [beyond, beyond - 1] }
}

/// Whether a line along an axis through a point (to within many units in the last place) is in a triangle's box.
fn may_cross(e: &Extraction, t: usize, p: &[f64; 3], axis: usize) -> bool {
    [(axis + 1) % 3, (axis + 2) % 3].into_iter().all(|i| {
        let x = e.triangles[t].map(|v| e.coords[v as usize][i]);
        let margin = 1e-12 * x.iter().fold(p[i].abs(), |m, c| m.max(c.abs()));
        x.iter().any(|c| *c >= p[i] - margin) && x.iter().any(|c| *c <= p[i] + margin)
    })
}

/// What a triangle adds to the winding number of a point below it along an axis; `None` if the line through the point meets its boundary.
fn crossing(e: &Extraction, points: &[P], t: usize, p: &P, axis: usize) -> Option<i64> {
    let seen = [(axis + 1) % 3, (axis + 2) % 3];
    let q = e.triangles[t].map(|v| &points[v as usize]);
    let d: [[Rational; 2]; 3] = q.map(|x| seen.map(|i| Rational::from(&x[i] - &p[i])));
    let turn = |i: usize, j: usize| Rational::from(&d[i][0] * &d[j][1]).cmp(&Rational::from(&d[i][1] * &d[j][0]));
    let turns = [turn(0, 1), turn(1, 2), turn(2, 0)];
    if turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater) {
        return Some(0);
    }
    if turns.contains(&Ordering::Equal) {
        return None;
    }
    let normal = cross(&minus(q[1], q[0]), &minus(q[2], q[0]));
    let below = dot(&normal, &minus(p, q[0])) / &normal[axis];
    assert!(!below.is_zero(), "triangle {t} goes through the inside of another one");
    Some(if below > 0 {
        0
    } else if turns[0] == Ordering::Greater {
        1
    } else {
        -1
    })
}

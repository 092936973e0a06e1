//! Many operands: unions of cubes and spheres in random rotation, three hundred operands, all cells of eight spheres; and that the order of
//! operands is nothing to the geometry.

use lapidary::arrangement::volumes::{cell_volumes, six_volume_residue, volume};
use lapidary::arrangement::{Arrangement, Selection};
use lapidary::base::{CellId, FaceId};
use lapidary::exact::{Residue, Sign, orient3d};
use rug::Rational;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

#[path = "common/mod.rs"]
mod common;
#[path = "common/solid_oracle.rs"]
mod solid_oracle;
use common::random::Random;
use common::shapes::{geodesic, grid_cube, moved, rotation};
use common::{Soup, cuboid};
use solid_oracle::{Place, arranged, assert_solid, dense, extracted, place, six_volume};

/// Copies in random rotation, centres (of what is around the origin) uniform in a cube.
fn scattered(s: &Soup, count: usize, scale: f64, side: f64, random: &mut Random) -> Vec<Soup> {
    let place = |random: &mut Random| std::array::from_fn(|_| side * random.unit());
    (0..count).map(|_| moved(s, rotation(random), scale, place(random))).collect()
}

fn all(soups: &[Soup]) -> Arrangement {
    arranged(&soups.iter().collect::<Vec<_>>())
}

/// Six times a volume modulo two primes: sums of thousands of exact volumes have denominators of tens of thousands of digits.
fn six(a: &Arrangement, s: Selection) -> Residue {
    six_volume_residue(a, &extracted(a, s)).expect("no prime divides a denominator")
}

/// Each operand winds around its inside once and is as large as it was; what is in k of them or more counts k times in their sum.
fn assert_sums(a: &Arrangement, soups: &[Soup], what: &str) {
    let mut most = 0;
    for c in 0..a.cell_count() {
        let row = a.winding(CellId::of(c));
        assert!(row.iter().all(|w| w.1 == 1), "{what}: cell {c}");
        most = most.max(row.len());
    }
    for (i, s) in soups.iter().enumerate() {
        assert!(six(a, Selection::Expression(&i.to_string())) == six_volume(s), "{what}: operand {i}");
    }
    let layers: Residue = (1..=most as u32).map(|k| six(a, Selection::AtLeast(k))).sum();
    assert!(layers == soups.iter().map(six_volume).sum(), "{what}");
    assert!(six(a, Selection::AtLeast(1)) == six(a, Selection::Union), "{what}");
}

/// The segments between triangles of different planes: what a surface is, whatever its triangles.
fn creases(a: &Arrangement, s: Selection) -> BTreeSet<[Place; 2]> {
    let e = extracted(a, s);
    let places: Vec<Place> = e.vertices.iter().map(|&v| place(a, v)).collect();
    let mut edges: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (i, t) in e.triangles.iter().enumerate() {
        for k in 0..3 {
            let (p, q) = (t[k], t[(k + 1) % 3]);
            edges.entry([p.min(q), p.max(q)]).or_default().push(i);
        }
    }
    let support = |t: usize| a.resolved.soup.mesh.corners(a.resolved.support[e.faces[t].at()]);
    let flat = |ts: &[usize]| match ts {
        [s, t] => {
            let [p, q, r] = support(*s);
            support(*t).iter().all(|x| orient3d(&p, &q, &r, x).is_zero())
        }
        _ => false,
    };
    let ends = |k: &[u32; 2]| {
        let mut ends = k.map(|v| places[v as usize]);
        ends.sort();
        ends
    };
    edges.iter().filter(|(_, ts)| !flat(ts)).map(|(k, _)| ends(k)).collect()
}

/// The places of all corners of faces.
fn corners(a: &Arrangement) -> BTreeSet<Place> {
    let mut used: Vec<_> = a.resolved.faces.iter().flatten().copied().collect();
    used.sort();
    used.dedup();
    used.into_iter().map(|v| place(a, v)).collect()
}

/// How many cells there are of each winding vector, as the list of operands that a cell is inside of.
fn vectors(a: &Arrangement, name: impl Fn(usize) -> usize) -> BTreeMap<Vec<usize>, usize> {
    let mut found: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
    for c in 0..a.cell_count() {
        let mut inside: Vec<usize> = a.winding(CellId::of(c)).iter().map(|w| name(w.0.at())).collect();
        inside.sort();
        *found.entry(inside).or_default() += 1;
    }
    found
}

/// The same operands in another order: the same corners, creases, cells, volumes.
fn assert_order_is_nothing(a: &Arrangement, soups: &[Soup], random: &mut Random, what: &str) {
    let mut order: Vec<usize> = (0..soups.len()).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, random.below(i as u64 + 1) as usize);
    }
    let b = arranged(&order.iter().map(|&i| &soups[i]).collect::<Vec<_>>());
    assert_eq!((a.face_count(), a.cell_count()), (b.face_count(), b.cell_count()), "{what}");
    assert_eq!(a.resolved.pair_count, b.resolved.pair_count, "{what}");
    assert!(corners(a) == corners(&b), "{what}: other corners");
    assert!(creases(a, Selection::Union) == creases(&b, Selection::Union), "{what}: other creases");
    assert!(vectors(a, |i| i) == vectors(&b, |i| order[i]), "{what}: other cells");
    for k in 1..6 {
        assert!(six(a, Selection::AtLeast(k)) == six(&b, Selection::AtLeast(k)), "{what}: another volume");
    }
}

fn union_of(soups: &[Soup], what: &str, random: &mut Random) {
    let started = Instant::now();
    let a = all(soups);
    let e = extracted(&a, Selection::Union);
    println!(
        "{what}: {} pairs that meet, {} cells, union of {} triangles; {:?}",
        a.resolved.pair_count,
        a.cell_count(),
        e.triangles.len(),
        started.elapsed()
    );
    assert_solid(&a, &e, what);
    println!("solid; {:?}", started.elapsed());
    assert_sums(&a, soups, what);
    println!("volumes; {:?}", started.elapsed());
    assert_order_is_nothing(&a, soups, random, what);
    println!("another order; {:?}", started.elapsed());
    if long() {
        assert_solid(&a, &extracted(&a, Selection::AtLeast(5)), what);
        println!("at least five; {:?}", started.elapsed());
    }
}

fn long() -> bool {
    std::env::var_os("LAPIDARY_LONG").is_some()
}

#[test]
fn fifty_cubes() {
    let mut random = Random(50);
    let cube = cuboid([-0.5; 3], [0.5; 3]);
    union_of(&scattered(&cube, 50, 1.0, 2.0, &mut random), "50 cubes", &mut random);
}

#[test]
fn fifty_spheres() {
    let mut random = Random(51);
    let ball = geodesic(if long() { 10 } else { 3 });
    union_of(&scattered(&ball, 50, 0.5, 2.5, &mut random), "50 spheres", &mut random);
}

/// Cubes and spheres, every seventh one given twice: coplanar with itself.
#[test]
fn three_hundred_operands() {
    let mut random = Random(300);
    let (cube, ball) = (grid_cube(1, [-0.5; 3], 1.0), geodesic(1));
    let mut soups = Vec::new();
    while soups.len() < 300 {
        let s = if soups.len() % 2 == 0 { &cube } else { &ball };
        soups.extend(scattered(s, 1, 0.8, 4.0, &mut random));
        if soups.len() % 7 == 0 {
            soups.push(soups[soups.len() - 1].clone());
        }
    }
    soups.truncate(300);
    union_of(&soups, "300 operands", &mut random);
}

/// Whether a point is inside a closed convex-or-not mesh: the winding number along a ray, by signs of determinants of doubles. `None` on an edge.
fn winding_of(s: &Soup, p: &[f64; 3]) -> Option<i32> {
    let far = [p[0] + 64.0, p[1], p[2]];
    let mut sum = 0;
    for t in &s.triangles {
        let [a, b, c] = t.map(|v| s.vertices[v as usize]);
        let outside = |i: usize| {
            let x = [a[i], b[i], c[i]];
            x.iter().all(|x| *x < p[i]) || x.iter().all(|x| *x > p[i])
        };
        if outside(1) || outside(2) || [a, b, c].iter().all(|x| x[0] < p[0]) {
            continue;
        }
        let turns = [(a, b), (b, c), (c, a)].map(|(u, v)| orient3d(p, &far, &u, &v));
        if turns.contains(&Sign::Positive) && turns.contains(&Sign::Negative) {
            continue;
        }
        let (near, beyond) = (orient3d(&a, &b, &c, p), orient3d(&a, &b, &c, &far));
        if turns.contains(&Sign::Zero) || near.is_zero() {
            return None;
        }
        if near != beyond {
            sum += if beyond == Sign::Positive { 1 } else { -1 };
        }
    }
    Some(sum)
}

fn vector_at(soups: &[Soup], p: &[f64; 3]) -> Option<Vec<i32>> {
    soups.iter().map(|s| winding_of(s, p)).collect()
}

/// Points close before and behind the middle of a face, nearer and nearer.
fn near_face(a: &Arrangement, f: FaceId, front: bool, step: f64) -> [f64; 3] {
    let x = a.resolved.faces[f.at()].map(|v| a.coords(v));
    let d = |i: usize| -> [f64; 3] { std::array::from_fn(|k| x[i][k] - x[0][k]) };
    let (u, v) = (d(1), d(2));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let size = n.iter().map(|c| c * c).sum::<f64>().sqrt();
    let along = if front { step } else { -step } / size;
    std::array::from_fn(|k| (x[0][k] + x[1][k] + x[2][k]) / 3.0 + along * n[k])
}

#[test]
fn all_cells_of_eight_spheres() {
    let mut random = Random(8);
    let soups = scattered(&geodesic(if long() { 16 } else { 6 }), 8, 1.0, 0.9, &mut random);
    let started = Instant::now();
    let a = all(&soups);
    let vectors: BTreeSet<Vec<i32>> = (0..a.cell_count()).map(|c| dense(&a, c)).collect();
    println!("{} cells with {} vectors; {:?}", a.cell_count(), vectors.len(), started.elapsed());
    // Eight spheres in general position have 128 cells at most, so 256 vectors cannot be; facets add tiny cells near where three spheres meet.
    assert!(vectors.len() > 90 && vectors.contains(&vec![1; 8]) && vectors.contains(&vec![0; 8]));
    assert!(vectors.iter().flatten().all(|w| (0..2).contains(w)));
    // Every point of space is in a cell that there is.
    let mut met: BTreeSet<Vec<i32>> = BTreeSet::new();
    for _ in 0..if long() { 200_000 } else { 4_000 } {
        let p = std::array::from_fn(|_| 2.9 * random.unit() - 1.0);
        if let Some(v) = vector_at(&soups, &p) {
            assert!(vectors.contains(&v), "{p:?}: {v:?}");
            met.insert(v);
        }
    }
    println!("{} of them met; {:?}", met.len(), started.elapsed());
    assert!(3 * met.len() > 2 * vectors.len());
    // Every cell has a witness: a point near one of its faces that is where its numbers say.
    let volumes = cell_volumes(&a);
    let mut of_cell: Vec<Vec<(FaceId, bool)>> = vec![Vec::new(); a.cell_count()];
    for f in 0..a.face_count() {
        for (side, c) in a.face_cells(FaceId::of(f)).into_iter().enumerate() {
            of_cell[c.at()].push((FaceId::of(f), side == 1));
        }
    }
    for (c, faces) in of_cell.iter().enumerate() {
        let of = |t: &(FaceId, bool)| {
            [1e-6, 1e-9, 1e-12].iter().any(|&h| vector_at(&soups, &near_face(&a, t.0, t.1, h)) == Some(dense(&a, c)))
        };
        assert!(faces.iter().take(50).any(of), "cell {c} of the volume {} has no witness", volumes[c].to_f64());
    }
    println!("witnesses; {:?}", started.elapsed());
    // What any two have in common is the same without the others.
    for i in 0..8 {
        for j in (0..i).filter(|j| long() || (i + j) % 4 == 0) {
            let sum: Rational =
                (0..a.cell_count()).filter(|&c| dense(&a, c)[i] * dense(&a, c)[j] > 0).map(|c| &volumes[c]).sum();
            let two = arranged(&[&soups[i], &soups[j]]);
            assert!(volume(&two, &extracted(&two, Selection::Intersection)) == sum, "{i} and {j}");
        }
    }
    println!("pairs; {:?}", started.elapsed());
    assert_order_is_nothing(&a, &soups, &mut random, "eight spheres");
    println!("another order; {:?}", started.elapsed());
    // Each cell alone is a solid, and residues agree with volumes in sum.
    let mut sum: Option<Residue> = None;
    for c in 1..a.cell_count() {
        let table: Vec<bool> = (0..a.cell_count()).map(|d| d == c).collect();
        let e = extracted(&a, Selection::Table(&table));
        if c % 8 == 1 {
            assert_solid(&a, &e, &format!("cell {c}"));
        }
        let r = six_volume_residue(&a, &e);
        sum = match (sum, r) {
            (Some(s), Some(r)) => Some(s + r),
            (s, r) => s.or(r),
        };
    }
    assert_eq!(sum, six_volume_residue(&a, &extracted(&a, Selection::Union)));
    println!("each cell; {:?}", started.elapsed());
}

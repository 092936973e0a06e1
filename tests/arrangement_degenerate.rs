//! Booleans of cubes made of grids, whose sides lie on one another: everything is degenerate, and volumes are known. Each once along the axes, and once
//! turned so that nothing is parallel to an axis.

use lapidary::arrangement::volumes::{cell_volumes, volume};
use lapidary::arrangement::{Arrangement, Extraction, Selection};
use lapidary::exact;
use rug::Rational;

#[path = "common/mod.rs"]
mod common;
#[path = "common/solid_oracle.rs"]
mod solid_oracle;
use common::shapes::{Matrix, grid_cube, moved, shifted};
use common::{Soup, build_soup, checking, flipped, together};
use solid_oracle::{arranged, assert_solid, dense, extracted, signed_volume};

/// As it is, and nine times the rotation of the quaternion (1, 2, 2, 0): multiples of a quarter stay such.
const TURNS: [(Matrix, i64); 2] = [
    ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], 1),
    ([[1.0, 8.0, 4.0], [8.0, 1.0, -4.0], [-4.0, 4.0, -7.0]], 729),
];

/// Union, intersection, the two differences, symmetric difference, at least two, resolve.
const NAMES: [&str; 7] = ["union", "intersection", "0 - 1", "1 - 0", "xor", "at least 2", "resolve"];

fn selections() -> [Selection<'static>; 7] {
    use Selection::*;
    [Union, Intersection, Difference, Expression("1 - 0"), SymmetricDifference, AtLeast(2), Resolve]
}

/// All corners are doubles here, so a mesh with checks is one more judge: no two triangles meet, shells are nested as a solid's are.
fn assert_exact_solid(a: &Arrangement, e: &Extraction, what: &str) {
    for (&v, x) in e.vertices.iter().zip(&e.coords) {
        let exact = exact::rational(&a.point(v));
        assert!((0..3).all(|i| Rational::from_f64(x[i]).unwrap() == exact[i]), "{what}: {exact:?} is not a double");
    }
    if e.triangles.is_empty() {
        return;
    }
    let triangles = e.triangles.iter().map(|t| t.map(|v| v as i32)).collect();
    let soup = Soup { vertices: e.coords.clone(), triangles };
    let mesh = build_soup(&soup, checking()).unwrap_or_else(|e| panic!("{what}: {e:?}"));
    assert_eq!(mesh.triangles.len(), e.triangles.len(), "{what}");
}

/// All extractions of two operands, their volumes (before turning) and sizes. Solid all of them; small ones also by rationals.
fn booleans(first: &Soup, second: &Soup, expected: [Rational; 7], what: &str) {
    for (turn, scale) in TURNS {
        let [p, q] = [first, second].map(|s| moved(s, turn, 1.0, [0.0; 3]));
        let a = arranged(&[&p, &q]);
        let what = format!("{what}, turned by {}", turn[0][0]);
        let mut found: Vec<Rational> = Vec::new();
        let mut solids: Vec<Extraction> = Vec::new();
        for (i, s) in selections().into_iter().enumerate() {
            let what = format!("{what}: {}", NAMES[i]);
            let e = extracted(&a, s);
            if let Some(same) = solids.iter().position(|other| *other == e) {
                assert_eq!(found[same], Rational::from(&expected[i] * scale), "{what}");
                found.push(found[same].clone());
                solids.push(e);
                continue;
            }
            assert_exact_solid(&a, &e, &what);
            if e.triangles.len() < 1500 {
                assert_solid(&a, &e, &what);
            }
            let v = volume(&a, &e);
            assert_eq!(e.triangles.is_empty(), v == 0, "{what}");
            assert_eq!(v, Rational::from(&expected[i] * scale), "{what}");
            found.push(v);
            solids.push(e);
        }
        let [union, both, one, other, xor, ..] = &found[..] else { unreachable!() };
        let [v, w] = [&p, &q].map(signed_volume);
        let inside = |v: &Rational| if *v > 0 { v.clone() } else { Rational::new() };
        let (v, w) = (inside(&v), inside(&w));
        assert_eq!(Rational::from(union + both), Rational::from(&v + &w), "{what}");
        assert_eq!(*one, v - both, "{what}");
        assert_eq!(*other, w - both, "{what}");
        assert_eq!(*xor, Rational::from(union - both), "{what}");
        // Cells fill the union.
        assert_eq!(cell_volumes(&a).into_iter().sum::<Rational>(), *union, "{what}");
    }
}

/// Volumes of two operands of these volumes with so much in common.
fn overlapping(a: Rational, b: Rational, both: Rational) -> [Rational; 7] {
    let union = Rational::from(&a + &b) - &both;
    let xor = Rational::from(&union - &both);
    let (one, other) = (a - &both, b - &both);
    [union.clone(), both.clone(), one, other, xor, both, union]
}

fn whole(x: i64) -> Rational {
    Rational::from(x)
}

/// Edge 30, 30 × 30 quads a side.
fn cube() -> Soup {
    grid_cube(30, [0.0; 3], 1.0)
}

fn beside(shift: [f64; 3], both: Rational, what: &str) {
    beside_of(cube(), shift, both, what);
}

fn beside_of(a: Soup, shift: [f64; 3], both: Rational, what: &str) {
    booleans(&a, &shifted(&a, shift), overlapping(whole(27_000), whole(27_000), both), what);
}

#[test]
fn sharing_a_face() {
    beside([30.0, 0.0, 0.0], whole(0), "sharing a face");
    // The union 54 000, the difference 27 000, the intersection nothing.
    let expected = overlapping(whole(27_000), whole(27_000), whole(0));
    assert_eq!(expected[..3], [whole(54_000), whole(0), whole(27_000)]);
    // What divides nothing between them in the union is gone, and the rest is closed: 10 squares' worth of sides.
    let a = cube();
    let both = arranged(&[&a, &shifted(&a, [30.0, 0.0, 0.0])]);
    assert_eq!(extracted(&both, Selection::Union).triangles.len(), 10 * 2 * 900);
}

#[test]
fn sharing_half_a_face_an_edge_a_corner() {
    let coarse = || grid_cube(10, [0.0; 3], 3.0);
    beside_of(coarse(), [0.0, 30.0, 15.5], whole(0), "sharing half a face");
    beside_of(coarse(), [30.0, 30.0, 0.25], whole(0), "sharing an edge in part");
    beside_of(coarse(), [30.0, -30.0, 0.0], whole(0), "sharing an edge");
    beside_of(coarse(), [30.0, 30.0, 30.0], whole(0), "sharing a corner");
}

#[test]
fn shifted_by_half_a_cell_and_a_quarter() {
    let both: Rational = Rational::from((59, 2)) * Rational::from((119, 4)) * 30;
    beside([0.5, 0.25, 0.0], both.clone(), "half a cell and a quarter");
    assert_eq!(whole(27_000) - both, Rational::from((67_125, 100)));
    // And in all directions.
    let both: Rational = Rational::from((59, 2)) * Rational::from((119, 4)) * Rational::from((121, 8));
    beside_of(grid_cube(10, [0.0; 3], 3.0), [0.5, 0.25, 14.875], both, "half a cell, a quarter and an eighth");
}

#[test]
fn shifted_by_cells() {
    // A slab of 1 × 30 × 30 is left.
    beside([1.0, 0.0, 0.0], whole(27_000 - 900), "one cell along x");
    beside([0.0, 0.0, -1.0], whole(27_000 - 900), "one cell along z");
    beside_of(grid_cube(10, [0.0; 3], 3.0), [3.0, 3.0, 0.0], whole(27 * 27 * 30), "one cell along x and y");
    beside([29.0, 29.0, 29.0], whole(1), "all but one cell");
}

#[test]
fn inside_one_another_and_touching() {
    let a = cube();
    let inside = |n: i32, low: [f64; 3], step: f64, what: &str| {
        let side = Rational::from_f64(step).unwrap() * n;
        let v = Rational::from(side.square_ref()) * side;
        booleans(&a, &grid_cube(n, low, step), overlapping(whole(27_000), v.clone(), v), what);
    };
    inside(10, [0.0; 3], 1.0, "in a corner, on the grid");
    inside(10, [10.0, 10.0, 0.0], 1.0, "on one side, on the grid");
    inside(10, [0.25, 20.0, 20.0], 1.0, "along an edge, off the grid");
    inside(20, [10.0, 0.0, 5.5], 0.75, "on one side, in a finer grid");
    inside(60, [0.0; 3], 0.5, "all of it, in a grid twice as fine");
    inside(10, [0.0; 3], 3.0, "all of it, in a coarser grid");
    inside(5, [3.0; 3], 0.5, "not touching");
}

#[test]
fn itself() {
    let a = cube();
    booleans(&a, &a, overlapping(whole(27_000), whole(27_000), whole(27_000)), "itself");
    // The union is the mesh, triangle by triangle.
    let both = arranged(&[&a, &a]);
    let e = extracted(&both, Selection::Union);
    let given: Vec<[[f64; 3]; 3]> = a.triangles.iter().map(|t| t.map(|v| a.vertices[v as usize])).collect();
    let got: Vec<[[f64; 3]; 3]> = e.triangles.iter().map(|t| t.map(|v| e.coords[v as usize])).collect();
    assert_eq!((given, both.cell_count()), (got, 2));
    assert_eq!(dense(&both, 1), [1, 1]);
    assert_eq!(e.births, (0..a.triangles.len() as u32).map(|t| (lapidary::base::OperandId(0), t)).collect::<Vec<_>>());
    assert!(e.flipped.iter().all(|f| !f));
    // Twice the same in one operand: wound around twice, inside once.
    let twice = arranged(&[&together(&[a.clone(), a.clone()])]);
    assert_eq!((twice.cell_count(), dense(&twice, 1)), (2, vec![2]));
    assert_eq!(volume(&twice, &extracted(&twice, Selection::Resolve)), whole(27_000));
}

/// What a mesh that is turned inside out winds around has the winding number −1: outside, as everything that is not positive.
#[test]
fn its_reverse() {
    let a = cube();
    let back = flipped(a.clone());
    let v = || whole(27_000);
    let none = || whole(0);
    // As sum, which is what resolve asks for, nothing is left.
    booleans(&a, &back, [v(), none(), v(), none(), v(), none(), none()], "its reverse");
    let both = arranged(&[&a, &back]);
    assert_eq!((both.cell_count(), dense(&both, 1)), (2, vec![1, -1]));
    // In one operand the two cancel: no face divides anything.
    let nothing = arranged(&[&together(&[a, back.clone()])]);
    assert_eq!((nothing.cell_count(), nothing.patch_count(), nothing.face_count()), (1, 0, 10_800));
    let alone = arranged(&[&back]);
    assert_eq!((alone.cell_count(), dense(&alone, 1)), (2, vec![-1]));
    assert!(extracted(&alone, Selection::Union).triangles.is_empty());
    assert_eq!(cell_volumes(&alone)[1], whole(27_000));
}

/// Each triangle in four, at the middles of its sides.
fn refined(s: &Soup) -> Soup {
    let mut fine = Soup { vertices: s.vertices.clone(), triangles: Vec::new() };
    let mut middles = std::collections::BTreeMap::new();
    for t in &s.triangles {
        let m = [0, 1, 2].map(|i| {
            let (p, q) = (t[i].min(t[(i + 1) % 3]), t[i].max(t[(i + 1) % 3]));
            *middles.entry((p, q)).or_insert_with(|| {
                let [x, y] = [p, q].map(|v| s.vertices[v as usize]);
                fine.vertices.push(std::array::from_fn(|k| 0.5 * (x[k] + y[k])));
                fine.vertices.len() as i32 - 1
            })
        });
        fine.triangles.extend([[t[0], m[0], m[2]], [t[1], m[1], m[0]], [t[2], m[2], m[1]], m]);
    }
    fine
}

#[test]
fn a_refined_copy() {
    let a = cube();
    let all = || overlapping(whole(27_000), whole(27_000), whole(27_000));
    booleans(&a, &refined(&a), all(), "a refined copy");
    if std::env::var_os("LAPIDARY_LONG").is_some() {
        booleans(&refined(&refined(&a)), &a, all(), "refined twice");
    }
    // Only where the finer one has them are there corners.
    let fine = refined(&a);
    let both = arranged(&[&a, &fine]);
    assert_eq!(extracted(&both, Selection::Union).triangles.len(), fine.triangles.len());
    let back = flipped(fine);
    let nothing = arranged(&[&together(&[a, back])]);
    assert_eq!((nothing.cell_count(), nothing.patch_count()), (1, 0));
}

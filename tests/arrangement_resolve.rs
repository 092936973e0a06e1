//! The resolved surface of soups in which everything is degenerate, against rationals: faces meet in common vertices and edges only, and the parts of a
//! triangle are the triangle.

use lapidary::arrangement::clusters::clusters;
use lapidary::arrangement::crossings::crossings;
use lapidary::arrangement::intersect::intersect;
use lapidary::arrangement::resolve::resolve;
use lapidary::arrangement::soup::soup;
use lapidary::arrangement::{Operand, Resolved};
use lapidary::base::{FaceId, Run, VertexId};
use lapidary::exact;
use rug::Rational;

#[path = "common/mod.rs"]
mod common;
#[path = "common/solid_oracle.rs"]
mod solid_oracle;
use common::random::Random;
use solid_oracle::{P, cross, fit, minus, surely_apart};

type Arrays = (Vec<[f64; 3]>, Vec<[i32; 3]>);

fn resolved(operands: &[Arrays]) -> Resolved {
    let operands: Vec<Operand> = operands.iter().map(|(vertices, triangles)| Operand { vertices, triangles }).collect();
    let mut run = Run::quiet();
    let soup = soup(&operands, &mut run).expect("a soup");
    soup.check().expect("soup");
    let contacts = intersect(&soup, &mut run).expect("contacts");
    contacts.check(&soup).expect("contacts");
    let clusters = clusters(&contacts);
    clusters.check(&contacts).expect("clusters");
    let pairs = contacts.pair_count;
    let graphs = crossings(&soup, contacts, &clusters, &mut run).expect("graphs");
    graphs.check(&soup, &clusters).expect("graphs");
    let resolved = resolve(soup, graphs, &clusters, pairs, &mut run).expect("a resolved surface");
    resolved.check().expect("resolved");
    resolved
}

fn assert_right(r: &Resolved, seed: u64) {
    let points: Vec<P> = (0..r.vertex_count()).map(|v| exact::rational(&r.point(VertexId::of(v)))).collect();
    let coords: Vec<[f64; 3]> = (0..r.vertex_count()).map(|v| r.coords(VertexId::of(v))).collect();
    for (i, f) in r.faces.iter().enumerate() {
        for (j, g) in r.faces[..i].iter().enumerate() {
            if surely_apart(&coords, &f.map(|v| v.0), &g.map(|v| v.0)) {
                continue;
            }
            assert!(fit(|v: VertexId| points[v.at()].clone(), f, g), "seed {seed}: faces {i} and {j} meet");
        }
    }
    let area = |t: [&P; 3]| cross(&minus(t[1], t[0]), &minus(t[2], t[0]));
    let mesh = &r.soup.mesh;
    let mut sums: Vec<P> = mesh.triangles.iter().map(|_| std::array::from_fn(|_| Rational::new())).collect();
    for (i, f) in r.faces.iter().enumerate() {
        let part = area(f.map(|v| &points[v.at()]));
        for birth in r.births_of(FaceId::of(i)) {
            let sum = &mut sums[birth.triangle.at()];
            for k in 0..3 {
                if birth.same {
                    sum[k] += &part[k];
                } else {
                    sum[k] -= &part[k];
                }
            }
        }
    }
    for (t, corners) in mesh.triangles.iter().enumerate() {
        assert_eq!(sums[t], area(corners.map(|v| &points[v.at()])), "seed {seed}: the parts of triangle {t}");
    }
}

/// Triangles with whole coordinates within a bound.
fn soup_of(r: &mut Random, count: usize, bound: i64) -> Arrays {
    let vertices = (0..3 * count).map(|_| std::array::from_fn(|_| r.within(bound))).collect();
    (vertices, (0..count as i32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect())
}

fn rounds() -> u64 {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(1)
}

#[test]
fn soups_of_small_integers() {
    for seed in 0..60 * rounds() {
        let mut r = Random(seed);
        let (count, bound) = (2 + r.below(7) as usize, 1 + r.below(3) as i64);
        let operands = [soup_of(&mut r, count, bound), soup_of(&mut r, 1, bound)];
        assert_right(&resolved(&operands), seed);
    }
}

#[test]
fn soups_in_one_plane() {
    for seed in 0..60 * rounds() {
        let mut r = Random(1 << 32 | seed);
        let count = 2 + r.below(6) as usize;
        let (mut vertices, triangles) = soup_of(&mut r, count, 3);
        for x in &mut vertices {
            x[2] = x[0] - 2.0 * x[1];
        }
        let other = soup_of(&mut r, 2, 3);
        assert_right(&resolved(&[(vertices, triangles), other]), seed);
    }
}

#[test]
fn soups_in_general_position() {
    for seed in 0..30 * rounds() {
        let mut r = Random(2 << 32 | seed);
        let vertices = (0..18).map(|_| std::array::from_fn(|_| r.signed())).collect();
        let triangles = (0..6).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        assert_right(&resolved(&[(vertices, triangles)]), seed);
    }
}

/// Scaling by a power of two changes no name and no order.
#[test]
fn scales_do_not_matter() {
    for seed in 0..10 {
        let mut r = Random(3 << 32 | seed);
        let (vertices, triangles) = soup_of(&mut r, 6, 2);
        let first = resolved(&[(vertices.clone(), triangles.clone())]);
        for scale in [2f64.powi(300), 2f64.powi(-300)] {
            let scaled = vertices.iter().map(|x| x.map(|c| c * scale)).collect();
            let other = resolved(&[(scaled, triangles.clone())]);
            assert_eq!(first.faces, other.faces);
            assert_eq!(first.points.origins, other.points.origins);
        }
    }
}

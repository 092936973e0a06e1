//! Random closed soups of small whole coordinates: every extraction is a solid by an independent judge, volumes add up, neither the order of
//! operands nor threads matter. `LAPIDARY_FUZZ=n`: n rounds; `LAPIDARY_FUZZ_MINUTES=n`: as many as there are in that time;
//! `LAPIDARY_FUZZ_SEED=n`: other soups.

use lapidary::arrangement::volumes::{cell_volumes, volume};
use lapidary::arrangement::{Arrangement, Selection};
use lapidary::base::CellId;
use rug::Rational;
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

#[path = "common/mod.rs"]
mod common;
#[path = "common/solid_oracle.rs"]
mod solid_oracle;
use common::random::Random;
use common::{Soup, cuboid, flipped, together};
use solid_oracle::{Place, arranged, assert_solid, dense, extracted, place, signed_volume};

fn from_environment(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

/// Boundaries of tetrahedra and boxes in any orientation, flat ones and copies included; maybe sheared, so that nothing is along an axis.
fn soup(r: &mut Random, range: i64) -> Soup {
    let mut parts = Vec::new();
    let pool: Vec<[f64; 3]> = (0..6).map(|_| std::array::from_fn(|_| r.within(range))).collect();
    for _ in 0..1 + r.below(4) {
        let mut s = if r.below(3) > 0 {
            let vertices = (0..4).map(|_| pool[r.below(6) as usize]).collect();
            Soup { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] }
        } else {
            let (a, b) = (pool[r.below(6) as usize], pool[r.below(6) as usize]);
            cuboid(a, b)
        };
        if r.below(2) == 0 {
            s = flipped(s);
        }
        if r.below(5) == 0 {
            parts.push(s.clone());
        }
        parts.push(s);
    }
    together(&parts)
}

/// Cells by winding vector: how many, and how large in all; and all places of corners of faces.
fn summary(a: &Arrangement, names: &[usize]) -> (Vec<(Vec<i32>, Rational)>, BTreeSet<Place>) {
    let volumes = cell_volumes(a);
    let vector = |c: usize| {
        let row = dense(a, c);
        let mut named = vec![0; row.len()];
        names.iter().zip(row).for_each(|(&n, w)| named[n] = w);
        named
    };
    let mut cells: Vec<(Vec<i32>, Rational)> = volumes.into_iter().enumerate().map(|(c, v)| (vector(c), v)).collect();
    cells.sort();
    let mut used: Vec<_> = a.resolved.faces.iter().flatten().copied().collect();
    used.sort();
    used.dedup();
    (cells, used.into_iter().map(|v| place(a, v)).collect())
}

#[test]
fn soups_of_small_whole_numbers() {
    let mut r = Random(from_environment("LAPIDARY_FUZZ_SEED", 0) << 32 | 17);
    let (started, minutes) = (Instant::now(), from_environment("LAPIDARY_FUZZ_MINUTES", 0));
    let least = if minutes > 0 { 0 } else { from_environment("LAPIDARY_FUZZ", 150) };
    let (mut rounds, mut solids, mut triangles) = (0, 0, 0);
    while rounds < least || started.elapsed() < Duration::from_secs(60 * minutes) {
        let round = rounds;
        rounds += 1;
        let range = [1, 1, 2, 3, 5][r.below(5) as usize];
        let mut soups: Vec<Soup> = (0..1 + r.below(4)).map(|_| soup(&mut r, range)).collect();
        if r.below(3) == 0 {
            let m: [[f64; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| r.within(3)));
            soups.iter_mut().for_each(|s| *s = common::shapes::moved(s, m, 1.0, [0.0; 3]));
        }
        let given: Vec<&Soup> = soups.iter().collect();
        let a = arranged(&given);
        let what = format!("round {round}");
        let mut weighted = Rational::new();
        for (c, v) in cell_volumes(&a).into_iter().enumerate() {
            assert!((c == 0) == (v == 0) && v >= 0, "{what}: cell {c}");
            weighted += v * a.winding(CellId::of(c)).iter().map(|w| w.1).sum::<i32>();
        }
        assert!(weighted == soups.iter().map(signed_volume).sum::<Rational>(), "{what}");
        use Selection::*;
        for (i, s) in
            [Union, Intersection, Difference, SymmetricDifference, AtLeast(2), Resolve].into_iter().enumerate()
        {
            let e = extracted(&a, s);
            assert_solid(&a, &e, &format!("{what}, selection {i}"));
            assert_eq!(e.triangles.is_empty(), volume(&a, &e) == 0, "{what}, selection {i}");
            solids += !e.triangles.is_empty() as usize;
            triangles += e.triangles.len();
        }
        // A checkerboard of cells meets itself in edges and corners wherever it can.
        let table: Vec<bool> = (0..a.cell_count()).map(|c| c > 0 && r.below(2) == 0).collect();
        assert_solid(&a, &extracted(&a, Table(&table)), &what);
        let order: Vec<usize> = (0..soups.len()).rev().collect();
        let b = arranged(&order.iter().map(|&i| &soups[i]).collect::<Vec<_>>());
        let names: Vec<usize> = (0..soups.len()).collect();
        assert!(summary(&a, &names) == summary(&b, &order), "{what}: the order of operands matters");
        assert_eq!(a.resolved.pair_count, b.resolved.pair_count, "{what}");
    }
    println!("{rounds} rounds: {solids} solids of {triangles} triangles");
    assert!(solids as u64 > rounds && triangles > 10 * solids);
}

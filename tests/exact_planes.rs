//! Families of planes against a quadratic search in rationals; counters.

mod exact_reference;

use exact_reference::{Q, Q3, Random, cross, normal, number, plane, q, q3, vector};
use lapidary::base::PlaneId;
use lapidary::exact::counters::{self, Counts, PREDICATES, Predicate, TIERS, Tier};
use lapidary::exact::planes::{Grouping, group};
use lapidary::exact::*;

fn parallel(a: &Q3, b: &Q3) -> bool {
    cross(a, b).iter().all(|x| *x == 0)
}

/// Place of a plane along a direction parallel to its normal: the t of the point t n on it.
fn place(p: &Plane, n: &Q3) -> Q {
    let i = (0..3).find(|&i| n[i] != 0).unwrap();
    // p.n = c n, so n.x = -d / c.
    -q(p.d) / (q(p.n[i]) / &n[i])
}

fn compare_with_search(planes: &[Plane], g: &Grouping) {
    g.check(planes).unwrap();
    let n: Vec<Q3> = planes.iter().map(|p| q3(&p.n)).collect();
    let mut lowest = Vec::new();
    for i in 0..planes.len() {
        let first = (0..=i).find(|&j| parallel(&n[i], &n[j])).unwrap();
        let twin = (0..=i).find(|&j| parallel(&n[i], &n[j]) && place(&planes[i], &n[i]) == place(&planes[j], &n[i]));
        assert_eq!(g.representative[i], PlaneId::of(twin.unwrap()));
        if first == i {
            lowest.push(i);
        }
        assert_eq!(lowest[g.family_of[i].at()], first, "families rise by their lowest member");
    }
    assert_eq!(g.families.len(), lowest.len());
    let mut members = 0;
    for (f, family) in g.families.iter().enumerate() {
        assert_eq!(family.direction, planes[lowest[f]].n);
        let direction = &n[lowest[f]];
        let places: Vec<Q> = family.members.iter().map(|m| place(&planes[m.at()], direction)).collect();
        assert!(places.windows(2).all(|w| w[0] < w[1]), "members rise along the direction");
        for (m, &along) in family.members.iter().zip(&family.along) {
            let i = (0..3).find(|&i| direction[i] != 0).unwrap();
            assert_eq!(along, n[m.at()][i].cmp0() == direction[i].cmp0());
        }
        members += family.members.len();
    }
    assert_eq!(members, (0..planes.len()).filter(|&i| g.representative[i] == PlaneId::of(i)).count());
}

#[test]
fn families_of_degenerate_sets() {
    for seed in 0..60 {
        let mut r = Random(seed);
        let kind = [1, 2, 8, 3, 6, 0, 5, 4][seed as usize % 8];
        let mut planes: Vec<Plane> = Vec::new();
        for _ in 0..60 {
            let p = match (r.below(4), planes.len()) {
                (0..=2, 1..) => {
                    // Parallel to an earlier one, perhaps the same, written with another factor (exact for powers of two, nearly
                    // parallel for others where the product rounds).
                    let o = planes[r.below(planes.len() as u64) as usize];
                    let s = [1.0, -1.0, 2.0, -0.5, 3.0, 0.1][r.below(6) as usize];
                    let d = match r.below(3) {
                        0 => o.d * s,
                        1 => (o.d * s).next_up(),
                        _ => number(&mut r, kind),
                    };
                    Plane { n: o.n.map(|x| x * s), d }
                }
                _ => {
                    let v = vector(&mut r, kind);
                    plane(&mut r, kind, &v)
                }
            };
            if p.n != [0.0; 3] && p.n.iter().chain([&p.d]).all(|x| x.is_finite()) {
                planes.push(p);
            }
        }
        compare_with_search(&planes, &group(&planes));
    }
}

#[test]
fn families_at_the_ends_of_the_range() {
    let least = f64::from_bits(1);
    let planes = [
        Plane { n: [1.0, 1e300, 0.0], d: 1.0 },
        Plane { n: [1e-300, 1.0, 0.0], d: 1.0 },
        Plane { n: [least, 0.0, f64::MAX], d: f64::MAX },
        Plane { n: [2.0 * least, 0.0, f64::MAX], d: f64::MAX },
        Plane { n: [-least, -0.0, -f64::MAX], d: -f64::MAX },
        Plane { n: [-0.0, 0.0, least], d: 1.0 },
        Plane { n: [0.0, -0.0, -2.0 * least], d: -2.0 },
        Plane { n: [0.0, 0.0, 1.0], d: f64::MAX },
        Plane { n: [0.0, 0.0, 1.0], d: -0.0 },
        Plane { n: [0.0, 0.0, -1.0], d: 0.0 },
    ];
    let g = group(&planes);
    compare_with_search(&planes, &g);
    assert_eq!(g.representative[4], PlaneId(2));
    assert_eq!(g.representative[6], PlaneId(5));
    assert_eq!(g.representative[9], PlaneId(8));
    assert_eq!(group(&[]), Grouping::default());
}

/// A permutation of the planes permutes the classes.
#[test]
fn grouping_does_not_depend_on_order() {
    let mut r = Random(77);
    let n = 400;
    let planes: Vec<Plane> = (0..n).map(|_| Plane { n: normal(&mut r, 1), d: number(&mut r, 1) }).collect();
    let mut order: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        order.swap(i, r.below(i as u64 + 1) as usize);
    }
    let moved: Vec<Plane> = order.iter().map(|&i| planes[i]).collect();
    let (g, h) = (group(&planes), group(&moved));
    compare_with_search(&planes, &g);
    assert_eq!(g.families.len(), h.families.len());
    for i in 0..n {
        for j in 0..i {
            let (a, b) = (order[i], order[j]);
            assert_eq!(h.representative[i] == h.representative[j], g.representative[a] == g.representative[b]);
            assert_eq!(h.family_of[i] == h.family_of[j], g.family_of[a] == g.family_of[b]);
        }
    }
}

#[test]
fn counters_see_each_tier() {
    let unit = Plane { n: [1.0, 2.0, 3.0], d: -6.0 };
    counters::enable(false);
    counters::take();
    side(&unit, &[5.0; 3]);
    assert_eq!(counters::take(), Counts::default(), "off by default");
    counters::enable(true);
    side(&unit, &[5.0; 3]);
    side(&unit, &[1.0; 3]);
    side(&Plane { n: [1e300, 1.0, 0.0], d: 0.0 }, &[1e-300, -1e-320, 0.0]);
    side(&Plane { n: [1e300, -1e300, 1e-300], d: 0.0 }, &[1.0, 1.0, 1e-300]);
    counters::count_topology(Predicate::CyclicOrder);
    counters::count_many(Predicate::Side, Tier::Topology, 7);
    let mut c = counters::take();
    counters::enable(false);
    assert_eq!(TIERS.map(|t| c.get(Predicate::Side, t)), [7, 2, 0, 1, 1]);
    assert_eq!(c.get(Predicate::CyclicOrder, Tier::Topology), 1);
    assert_eq!(counters::take(), Counts::default());
    c.merge(&c.clone());
    assert_eq!(c.tier(Tier::Topology), 16);
    let names: Vec<_> = PREDICATES.iter().map(|p| p.name()).collect();
    assert_eq!(names[0], "side");
    assert_eq!(TIERS.map(Tier::name), ["topology", "filter", "bounded", "exact", "big"]);
}

/// Another thread's counts are its own.
#[test]
fn counters_are_per_thread() {
    counters::enable(true);
    counters::take();
    let other = std::thread::spawn(|| {
        side(&Plane { n: [1.0, 0.0, 0.0], d: 0.0 }, &[1.0; 3]);
        (counters::enabled(), counters::take())
    })
    .join()
    .unwrap();
    assert_eq!(other, (false, Counts::default()));
    assert_eq!(counters::take(), Counts::default());
    counters::enable(false);
}

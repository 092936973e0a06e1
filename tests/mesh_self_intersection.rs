//! The exact self-intersection check and its box hierarchy against brute force.

mod common;
use common::*;
use lapidary::base::{DefectKind::*, TriangleId, VertexId};
use lapidary::mesh::bvh::build_bvh;
use lapidary::mesh::self_intersection::{contact, self_intersections};
use rug::Rational;

fn random(seed: u64) -> impl FnMut(u64) -> u64 {
    let mut state = seed | 1;
    move |n| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) % n
    }
}

type Q3 = [Rational; 3];

fn minus(a: &Q3, b: &Q3) -> Q3 {
    std::array::from_fn(|i| Rational::from(&a[i] - &b[i]))
}
fn cross(a: &Q3, b: &Q3) -> Q3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        Rational::from(&a[j] * &b[k]) - Rational::from(&a[k] * &b[j])
    })
}
fn dot(a: &Q3, b: &Q3) -> Rational {
    (0..3).fold(Rational::new(), |s, i| s + Rational::from(&a[i] * &b[i]))
}

/// Keeps of a convex polygon (or segment, or point) what lies where n·(x − o) ≥ 0.
fn clip(polygon: &[Q3], n: &Q3, o: &Q3) -> Vec<Q3> {
    let mut out = Vec::new();
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let (da, db) = (dot(n, &minus(a, o)), dot(n, &minus(b, o)));
        if da >= 0 {
            out.push(a.clone());
        }
        if (da > 0 && db < 0) || (da < 0 && db > 0) {
            let t = &da / Rational::from(&da - &db);
            out.push(std::array::from_fn(|k| &a[k] + Rational::from(&b[k] - &a[k]) * &t));
        }
    }
    out
}

/// Clips one triangle by the other's plane and sides; whether any corner of what is left is not on the shared part.
fn contact_by_clipping(vertices: &[[f64; 3]], p: &[VertexId; 3], q: &[VertexId; 3]) -> bool {
    let point = |v: &VertexId| vertices[v.at()].map(|c| Rational::from_f64(c).unwrap());
    let (t, s) = (p.each_ref().map(point), q.each_ref().map(point));
    let n = cross(&minus(&s[1], &s[0]), &minus(&s[2], &s[0]));
    let back = n.clone().map(|c| -c);
    let mut left = clip(&clip(&t, &n, &s[0]), &back, &s[0]);
    for i in 0..3 {
        let inward = cross(&n, &minus(&s[(i + 1) % 3], &s[i]));
        left = clip(&left, &inward, &s[i]);
    }
    let shared: Vec<Q3> = p.iter().filter(|v| q.contains(v)).map(point).collect();
    left.iter().any(|x| match &shared[..] {
        [] => true,
        [v] => x != v,
        [a, b] => {
            let (e, d) = (minus(b, a), minus(x, a));
            let along = dot(&e, &d);
            cross(&e, &d).iter().any(|c| !c.is_zero()) || along < 0 || along > dot(&e, &e)
        }
        _ => true,
    })
}

#[test]
fn pairs_on_a_small_grid_agree_with_clipping() {
    let mut r = random(0x1234_5678_9abc_def1);
    let mut seen = [[0; 2]; 4];
    for round in 0..60_000 {
        // Small grids make coplanar, touching and folded pairs common; every third round lies in one plane.
        let size = 2 + round % 3;
        let flat = round % 3 == 0;
        let vertices: Vec<[f64; 3]> = (0..6)
            .map(|_| {
                let [x, y, z] = [r(size), r(size), r(size)].map(|c| c as f64 * 0.1);
                if flat { [x, y, x + y] } else { [x, y, z] }
            })
            .collect();
        let shared = r(4) as usize;
        let mut q = [3, 4, 5];
        q[..shared].copy_from_slice(&[0, 1, 2][..shared]);
        q.rotate_left(r(3) as usize);
        if r(2) == 0 {
            q.swap(0, 1);
        }
        let (p, q) = ([0, 1, 2].map(VertexId), q.map(VertexId));
        // A shared index is one place; two indices may be, too. Corners on a line are not for this check.
        let degenerate = |t: &[VertexId; 3]| {
            let [a, b, c] = t.map(|v| vertices[v.at()]);
            lapidary::exact::collinear(&a, &b, &c)
        };
        if degenerate(&p) || degenerate(&q) {
            continue;
        }
        let expected = contact_by_clipping(&vertices, &p, &q);
        assert_eq!(contact(&vertices, &p, &q), expected, "{vertices:?} {p:?} {q:?}");
        assert_eq!(contact(&vertices, &q, &p), expected, "{vertices:?} {q:?} {p:?}");
        seen[shared][expected as usize] += 1;
    }
    // Enough of every kind to mean something (all three corners shared is always a contact).
    assert!(seen[..3].iter().flatten().all(|&n| n > 500) && seen[3][1] > 500, "{seen:?}");
}

#[test]
fn pairs_within_an_ulp_of_contact() {
    // A point on a triangle's plane, moved by one ulp, in coordinates where rounding errors matter.
    let third: f64 = 1.0 / 3.0;
    let triangle = [[0.0, 0.0, third], [1.0, 0.0, third], [0.0, 1.0, third]];
    for (z, expected) in [(third, true), (f64::from_bits(third.to_bits() + 1), false)] {
        let mut vertices = triangle.to_vec();
        vertices.extend([[0.25, 0.25, z], [0.3, 0.25, 1.0], [0.25, 0.3, 1.0]]);
        assert_eq!(contact(&vertices, &[0, 1, 2].map(VertexId), &[3, 4, 5].map(VertexId)), expected);
    }
}

#[test]
fn hierarchy_finds_what_brute_force_finds() {
    let mut r = random(42);
    for n in [0usize, 1, 2, 4, 5, 9, 100, 400] {
        for scale in [1e-310, 1.0, 1e305] {
            let mut soup = Soup::default();
            for t in 0..n {
                let at: [u64; 3] = std::array::from_fn(|_| r(40));
                for _ in 0..3 {
                    soup.vertices.push(at.map(|c| (c as f64 + r(6) as f64) * scale));
                }
                soup.triangles.push([0, 1, 2].map(|k| 3 * t as i32 + k));
            }
            let triangles: Vec<[VertexId; 3]> = soup.triangles.iter().map(|t| t.map(|i| VertexId(i as u32))).collect();
            let bvh = build_bvh(&soup.vertices, &triangles);
            bvh.check().unwrap();
            let bounds = |t: usize| {
                let c = triangles[t].map(|v| soup.vertices[v.at()]);
                let lo: [f64; 3] = std::array::from_fn(|i| c[0][i].min(c[1][i]).min(c[2][i]));
                let hi: [f64; 3] = std::array::from_fn(|i| c[0][i].max(c[1][i]).max(c[2][i]));
                (lo, hi)
            };
            let meet = |a: &([f64; 3], [f64; 3]), b: &([f64; 3], [f64; 3])| {
                (0..3).all(|i| a.0[i] <= b.1[i] && b.0[i] <= a.1[i])
            };
            let mut pairs = Vec::new();
            bvh.meeting_pairs(|a, b| {
                pairs.push([a.min(b), a.max(b)]);
                true
            });
            pairs.sort();
            let found = pairs.len();
            pairs.dedup();
            assert_eq!(found, pairs.len(), "a pair came twice");
            let mut boxes_meet = 0;
            for a in 0..n {
                for b in a + 1..n {
                    if meet(&bounds(a), &bounds(b)) {
                        boxes_meet += 1;
                        assert!(pairs.binary_search(&[TriangleId::of(a), TriangleId::of(b)]).is_ok());
                    }
                }
            }
            // Candidates may exceed, not by much.
            assert!(found <= boxes_meet + boxes_meet / 10 + 5, "{found} {boxes_meet}");
            for t in 0..n.min(50) {
                let (lo, hi) = bounds(t);
                for axis in 0..3 {
                    let mut hits = vec![false; n];
                    bvh.meeting_ray(&lo, &hi, axis, true, |t| hits[t.at()] = true);
                    let mut ray = (lo, hi);
                    ray.1[axis] = f64::INFINITY;
                    assert!((0..n).all(|u| hits[u] || !meet(&ray, &bounds(u))));
                    hits.fill(false);
                    bvh.meeting_ray(&lo, &hi, axis, false, |t| hits[t.at()] = true);
                    let mut ray = (lo, hi);
                    ray.0[axis] = f64::NEG_INFINITY;
                    assert!((0..n).all(|u| hits[u] || !meet(&ray, &bounds(u))));
                }
            }
        }
    }
}

#[test]
fn ten_thousand_equal_boxes_do_not_deepen_the_hierarchy() {
    let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]];
    let triangles = vec![[0, 1, 2].map(VertexId); 10_000];
    let bvh = build_bvh(&vertices, &triangles);
    bvh.check().unwrap();
    let mut hits = 0;
    bvh.meeting_box(&[0.5; 3], &[0.5; 3], |_| hits += 1);
    assert_eq!(hits, 10_000);
    // The cap holds.
    assert_eq!(self_intersections(&vertices, &triangles, &bvh, 77).len(), 77);
    assert_eq!(self_intersections(&vertices, &triangles, &bvh, 0).len(), 0);
}

#[test]
fn solids_in_contact() {
    let cases = [
        ("apart", cuboid([2.0, 0.0, 0.0], [3.0, 1.0, 1.0]), false),
        ("crossing", cuboid([0.5; 3], [1.5; 3]), true),
        ("touching in a face", cuboid([1.0, 0.25, 0.25], [2.0, 0.75, 0.75]), true),
        ("touching along an edge", cuboid([1.0, 1.0, 0.25], [2.0, 2.0, 0.75]), true),
        ("a corner on a face", tetrahedron([[1.0, 0.5, 0.5], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 0.0, 1.0]]), true),
        ("an ulp away", cuboid([1.0 + f64::EPSILON, 0.25, 0.25], [2.0, 0.75, 0.75]), false),
    ];
    for (name, other, expected) in cases {
        let soup = together(&[cube(0.0, 1.0), other]);
        assert!(build_soup(&soup, Default::default()).is_ok(), "{name}: the check is an option");
        match build_soup(&soup, checking()) {
            Ok(mesh) => {
                mesh.check().unwrap();
                assert!(!expected, "{name}");
            }
            Err(e) => {
                assert!(expected, "{name}: {e}");
                assert!(
                    e.culprits.iter().all(|c| c.kind == SelfIntersection && c.ids[0] < 12 && c.ids[1] >= 12),
                    "{name}"
                );
                assert!(e.message.contains("meet outside what they share"));
            }
        }
    }
}

#[test]
fn shared_by_index_is_no_contact() {
    let mut options = checking();
    options.merge_duplicate_vertices = true;
    let whole = cube(0.0, 1.0);
    let at_corner = together(&[whole.clone(), cube(1.0, 2.0)]);
    let along_edge = together(&[whole.clone(), cuboid([1.0, 1.0, 0.0], [2.0, 2.0, 1.0])]);
    assert!(build_soup(&at_corner, options).is_ok());
    assert!(build_soup(&along_edge, options).is_ok());
    // The same corner as two vertices is a contact, and a duplicate.
    let kinds: Vec<_> = defects(&at_corner, checking()).iter().map(|c| c.kind).collect();
    assert!(kinds[0] == DuplicateVertex && kinds[1..].iter().all(|k| *k == SelfIntersection) && kinds.len() > 1);
    // Two cubes with a common face: four triangles coincide in pairs.
    let faces = together(&[whole, cuboid([1.0, 0.0, 0.0], [2.0, 1.0, 1.0])]);
    let found = build_soup(&faces, options).unwrap_err().culprits;
    assert!(found.iter().any(|c| c.kind == SelfIntersection));
}

//! Keys of the faces of complexes that are made of an arrangement's cells: no two faces share one, and they stay with their faces when operands and
//! triangles are given in another order with their global ids carried along, and in complexes of joined cells.

use lapidary::arrangement::keys::face_keys;
use lapidary::arrangement::solids::{Solids, every_cell, joined_cells, solids};
use lapidary::arrangement::{Arrangement, ArrangementOptions, Operand, Selection, arrange, arrange_with, choose};
use lapidary::base::{FaceId, Run};
use lapidary::complex::keys::{names, vertex_keys};
use lapidary::complex::{GlobalIds, Key};
use lapidary::exact::Plane;
use std::collections::{BTreeMap, BTreeSet};

#[path = "common/mod.rs"]
mod common;
#[path = "common/solid_oracle.rs"]
mod solid_oracle;
use common::models::permutation;
use common::random::Random;
use common::shapes::{geodesic, grid_cube, moved, rotation, shifted};
use common::{Soup, cuboid, flipped, together};
use solid_oracle::{Place, place};

/// Tags of faces' keys, by form.
const FORMS: [(&str, std::ops::Range<i64>); 4] =
    [("line", 8..40), ("side", 40..88), ("corner", 88..91), ("crossing", 112..121)];

/// What a face is, whatever its ids: its edges, and how it faces.
type Face = Vec<[Place; 2]>;

/// Operands with the global id of each triangle, and half-spaces with theirs.
#[derive(Clone, Default)]
struct Input {
    soups: Vec<(Soup, Vec<i64>)>,
    planes: Vec<(Plane, i64)>,
}

impl Input {
    fn new(soups: &[Soup], planes: &[Plane]) -> Self {
        let mut next = 0..;
        let soups = soups.iter().map(|s| (s.clone(), next.by_ref().take(s.triangles.len()).collect())).collect();
        Self { soups, planes: planes.iter().copied().zip(0..).collect() }
    }

    /// Operands, triangles of each, and half-spaces in another order.
    fn reordered(&self, seed: u64) -> Self {
        let order = |n: usize| permutation(n, seed);
        let soup = |i: &usize| {
            let (s, ids) = &self.soups[*i];
            let order = order(ids.len());
            let triangles = order.iter().map(|&t| s.triangles[t]).collect();
            (Soup { vertices: s.vertices.clone(), triangles }, order.iter().map(|&t| ids[t]).collect())
        };
        Self {
            soups: order(self.soups.len()).iter().map(soup).collect(),
            planes: order(self.planes.len()).iter().map(|&i| self.planes[i]).collect(),
        }
    }

    fn arranged(&self) -> Arrangement {
        let operands: Vec<Operand> =
            self.soups.iter().map(|(s, _)| Operand { vertices: &s.vertices, triangles: &s.triangles }).collect();
        let planes: Vec<Plane> = self.planes.iter().map(|p| p.0).collect();
        let (options, mut run) = (ArrangementOptions::default(), Run::quiet());
        let bounds = Some([[-4.0; 3], [9.0; 3]]);
        match planes.is_empty() {
            true => arrange(&operands, &options, &mut run).unwrap(),
            false => arrange_with(&operands, &planes, bounds, &options, &mut run).unwrap(),
        }
    }

    /// The global id of each triangle that is left: sides of the box go by their half-space.
    fn triangle_ids(&self, a: &Arrangement) -> Vec<i64> {
        let soup = &a.resolved.soup;
        let of = |(i, range): (usize, &[u32])| -> Vec<i64> {
            let places = &soup.source[range[0] as usize..range[1] as usize];
            places
                .iter()
                .map(|&place| match self.soups.get(i) {
                    Some((_, ids)) => ids[place as usize],
                    None => 1_000_000 + 12 * self.planes[i - self.soups.len()].1 + place as i64,
                })
                .collect()
        };
        soup.first_triangle.windows(2).enumerate().flat_map(of).collect()
    }
}

fn keyed(input: &Input, a: &Arrangement, s: &Solids, what: &str) -> BTreeMap<Face, Key> {
    let (triangles, planes) = (input.triangle_ids(a), input.planes.iter().map(|p| p.1).collect::<Vec<i64>>());
    let ids = GlobalIds { triangles: Some(&triangles), planes: Some(&planes), plane_map: None };
    let c = &s.complex;
    let names = names(&c.mesh, &c.planes, &ids).unwrap();
    let keys = face_keys(a, c, &s.vertices, &s.faces, &names).unwrap_or_else(|e| panic!("{what}: {e:?}"));
    let mut all: BTreeSet<Key> = keys.iter().copied().collect();
    assert_eq!(all.len(), c.face_count(), "{what}: two faces with one key");
    let vertices = vertex_keys(c, &names);
    assert!(vertices.iter().all(|k| !all.contains(k)), "{what}: a vertex with the key of a face");
    all.extend(vertices);
    assert!(all.iter().all(|k| k.0[0] >= 0), "{what}: a negative key");
    let face = |f: usize| {
        let mut edges: Face = Vec::new();
        for l in c.loops_of(FaceId::of(f)) {
            let corners = &c.corner_vertices[c.corners_of(l)];
            for (i, v) in corners.iter().enumerate() {
                let ends = [*v, corners[(i + 1) % corners.len()]].map(|v| place(a, s.vertices[v.at()]));
                edges.push([ends[0].min(ends[1]), ends[0].max(ends[1])]);
            }
        }
        edges.sort();
        edges
    };
    let told: BTreeMap<Face, Key> = (0..c.face_count()).map(|f| (face(f), keys[f])).collect();
    assert_eq!(told.len(), c.face_count(), "{what}: two faces with one boundary");
    told
}

/// All that may not change keys; counts them by form.
fn check(input: &Input, forms: &mut [usize; 4], what: &str) {
    let a = input.arranged();
    let s = solids(&a, &every_cell(&a), &mut Run::quiet()).unwrap();
    let told = keyed(input, &a, &s, what);
    for key in told.values() {
        let form = FORMS.iter().position(|f| f.1.contains(&(key.0[0] >> 56))).expect("a tag of faces");
        forms[form] += 1;
    }
    for seed in 1..3 {
        let other = input.reordered(seed);
        let b = other.arranged();
        let t = solids(&b, &every_cell(&b), &mut Run::quiet()).unwrap();
        assert!(told == keyed(&other, &b, &t, what), "{what}: in another order");
    }
    for selection in [Selection::Union, Selection::Difference, Selection::AtLeast(2)] {
        let inside = choose(&a, selection).unwrap();
        let joined = solids(&a, &joined_cells(&a, &inside), &mut Run::quiet()).unwrap();
        for (face, key) in keyed(input, &a, &joined, what) {
            assert!(told.get(&face).is_none_or(|k| *k == key), "{what}: of joined cells");
        }
    }
}

fn show(forms: &[usize; 4]) {
    let text: Vec<String> = FORMS.iter().zip(forms).map(|(f, n)| format!("{n} by {}", f.0)).collect();
    println!("{}", text.join(", "));
}

/// Boundaries of tetrahedra and boxes of small whole coordinates, flat ones and copies that cancel included.
fn soup(r: &mut Random, range: i64) -> Soup {
    let mut parts = Vec::new();
    let pool: Vec<[f64; 3]> = (0..6).map(|_| std::array::from_fn(|_| r.within(range))).collect();
    for _ in 0..1 + r.below(3) {
        let mut s = if r.below(3) > 0 {
            let vertices = (0..4).map(|_| pool[r.below(6) as usize]).collect();
            Soup { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] }
        } else {
            cuboid(pool[r.below(6) as usize], pool[r.below(6) as usize])
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

/// A triangle and the same one the other way round: nothing but births.
fn folded(corners: [[f64; 3]; 3]) -> Soup {
    Soup { vertices: corners.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 1]] }
}

#[test]
fn degenerate_soups() {
    let rounds = std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(300);
    let seed = std::env::var("LAPIDARY_FUZZ_SEED").ok().and_then(|n| n.parse().ok()).unwrap_or(0u64);
    let mut r = Random(seed << 32 | 23);
    let mut forms = [0; 4];
    for round in 0..rounds {
        let range = [1, 1, 2, 3][r.below(4) as usize];
        let mut soups: Vec<Soup> = (0..1 + r.below(4)).map(|_| soup(&mut r, range)).collect();
        // Folds on the sides of what there is.
        for _ in 0..r.below(3) {
            let corners = std::array::from_fn(|_| [r.within(range), r.within(range), r.within(1) * range as f64]);
            soups.push(folded(corners));
        }
        if r.below(3) == 0 {
            let m: [[f64; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| r.within(3)));
            soups.iter_mut().for_each(|s| *s = moved(s, m, 1.0, [0.0; 3]));
        }
        check(&Input::new(&soups, &[]), &mut forms, &format!("round {round}"));
    }
    show(&forms);
    assert!(forms[0] > 10 * rounds && forms[1] > rounds / 20, "{forms:?}");
}

#[test]
fn folds_within_a_side() {
    // Faces that nothing but their births tells: folds within a side, apart, through one another, and any that there are.
    let cube = cuboid([0.0; 3], [4.0; 3]);
    let fold = |x: [[f64; 2]; 3]| folded(x.map(|[x, y]| [x, y, 4.0]));
    let one = fold([[0.5, 0.25], [1.5, 0.25], [1.0, 0.4375]]);
    let star = [fold([[2.0, 0.25], [3.0, 0.25], [2.5, 0.75]]), fold([[2.0, 0.625], [3.0, 0.625], [2.5, 0.125]])];
    let other = star.each_ref().map(|s| shifted(s, [0.125, 0.75, 0.0]));
    let mut forms = [0; 4];
    let mut run = |folds: Vec<Soup>, what: &str| {
        let soups: Vec<Soup> = std::iter::once(cube.clone()).chain(folds).collect();
        check(&Input::new(&soups, &[]), &mut forms, what);
    };
    run(vec![one.clone()], "one");
    run(vec![one.clone(), shifted(&one, [1.5, 0.0, 0.0])], "apart");
    run(star.to_vec(), "a star");
    run(star.into_iter().chain(other).chain([one]).collect(), "two stars");
    let mut r = Random(31);
    for round in 0..200 {
        let mut folds = Vec::new();
        while folds.len() < 1 + round % 5 {
            let x: [[f64; 2]; 3] = std::array::from_fn(|_| [0; 2].map(|_| r.below(17) as f64 / 4.0));
            folds.push(fold(x));
        }
        run(folds, &format!("round {round}"));
    }
    show(&forms);
    assert!(forms[0] > 1000 && forms[1] > 500 && forms[2] > 100 && forms[3] >= 3, "{forms:?}");
}

#[test]
fn solids_in_general_position() {
    let mut random = Random(5);
    let mut forms = [0; 4];
    for round in 0..10 {
        let turn = rotation(&mut random);
        let a = grid_cube(3, [0.0; 3], 1.0);
        let b = moved(&geodesic(3), turn, 1.5, [1.0, 1.25, 0.5]);
        let c = moved(&shifted(&a, [0.5, 0.25, 0.0]), turn, 1.0, [0.0; 3]);
        check(
            &Input::new(&[a.clone(), b, c, shifted(&a, [1.0, 0.0, 0.5])], &[]),
            &mut forms,
            &format!("round {round}"),
        );
    }
    show(&forms);
    assert!(forms[0] > 5000 && forms[1] > 500, "{forms:?}");
}

/// Another operand changes the keys of those faces only that it cuts or touches.
#[test]
fn another_operand() {
    let mut r = Random(37);
    let mut common = 0;
    for round in 0..20 {
        let a = grid_cube(2, [0.0; 3], 1.0);
        let input = Input::new(&[a.clone(), moved(&a, rotation(&mut r), 1.0, [0.5, 1.25, 0.75])], &[]);
        // It is the first one, by name and by place.
        let mut more = input.clone();
        more.soups.iter_mut().for_each(|(_, ids)| ids.iter_mut().for_each(|id| *id += 1000));
        let ball = moved(&geodesic(2), rotation(&mut r), 0.75, [r.unit() * 2.0, r.unit() * 2.0, r.unit() * 2.0]);
        let before = more.clone();
        let ids = (0..ball.triangles.len() as i64).collect();
        more.soups.insert(0, (ball, ids));
        let what = format!("round {round}");
        let [x, y] = [&before, &more].map(|input| {
            let arrangement = input.arranged();
            let s = solids(&arrangement, &every_cell(&arrangement), &mut Run::quiet()).unwrap();
            keyed(input, &arrangement, &s, &what)
        });
        for (face, key) in &x {
            if let Some(k) = y.get(face) {
                assert!(k == key, "{what}");
                common += 1;
            }
        }
        assert!(x.len() < y.len(), "{what}");
    }
    assert!(common > 1000, "{common}");
}

#[test]
fn half_spaces() {
    let mut r = Random(29);
    let mut forms = [0; 4];
    for round in 0..150 {
        let soups: Vec<Soup> = (0..r.below(3)).map(|_| soup(&mut r, 2)).collect();
        // Some through corners, some that coincide, face to face as well; some are sides of the box.
        let mut planes: Vec<Plane> = Vec::new();
        for _ in 0..1 + r.below(4) {
            let n: [f64; 3] = std::array::from_fn(|_| r.within(1));
            if n != [0.0; 3] {
                planes.push(Plane { n, d: r.within(5) });
            }
        }
        if let (0, Some(p)) = (r.below(3), planes.first().copied()) {
            planes.push(Plane { n: p.n.map(|x| -2.0 * x), d: -2.0 * p.d });
        }
        if !planes.is_empty() {
            check(&Input::new(&soups, &planes), &mut forms, &format!("round {round}"));
        }
    }
    show(&forms);
    assert!(forms[0] > 5000 && forms[1] > 0, "{forms:?}");
}

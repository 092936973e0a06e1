//! Half-spaces among operands: meshes cut by planes give the cells that the cut engine gives, with the same exact volumes; soups that intersect
//! themselves keep their winding numbers; every degenerate position of planes and box.

use lapidary::arrangement::solids::{every_cell, solids};
use lapidary::arrangement::volumes::{cell_volumes, volume};
use lapidary::arrangement::{
    Arrangement, ArrangementOptions, Operand, Selection, arrange, arrange_with, choose, extract,
};
use lapidary::base::{CellId, OperandId, Run, Status};
use lapidary::complex::check::check_exact;
use lapidary::complex::exact_values::cell_volume;
use lapidary::complex::{check, check_volumes, moments};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::{Plane, Sign, counters, round_rational};
use lapidary::mesh::TriMesh;
use rug::Rational;
use std::collections::BTreeMap;
use std::sync::Arc;

#[path = "common/mod.rs"]
mod common;
use common::models::{arbitrary, each_model, grid, incident, on_integers};
use common::random::Random;
use common::{Soup, build_soup, cgal_meshes, read_mesh};

type Bounds = Option<[[f64; 3]; 2]>;

fn operands(meshes: &[Soup]) -> Vec<Operand<'_>> {
    meshes.iter().map(|m| Operand { vertices: &m.vertices, triangles: &m.triangles }).collect()
}

fn arranged(meshes: &[Soup], planes: &[Plane], bounds: Bounds) -> Arrangement {
    let options = ArrangementOptions::default();
    arrange_with(&operands(meshes), planes, bounds, &options, &mut Run::quiet()).unwrap()
}

fn dense(a: &Arrangement, c: usize) -> Vec<i32> {
    let mut row = vec![0; a.operand_count()];
    a.winding(CellId::of(c)).iter().for_each(|w| row[w.0.at()] = w.1);
    row
}

/// A box with one diagonal a side.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> Soup {
    let corner = |i: usize| [0, 1, 2].map(|a| if i >> a & 1 == 0 { low[a] } else { high[a] });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    Soup { vertices: (0..8).map(corner).collect(), triangles }
}

/// Volumes of the cells of a solid cut by planes, and whether each is in the half-space of the first plane.
fn cut_volumes(mesh: &Arc<TriMesh>, planes: &[Plane]) -> Vec<(Rational, bool)> {
    let c = cut(mesh, planes, &CutOptions::default(), &mut Run::quiet()).unwrap().complex;
    let within = |k: usize| {
        planes.first().is_some_and(|p| {
            let corners = c.cell_faces(CellId::of(k)).iter().flat_map(|h| c.face_corners(h.face()));
            corners
                .map(|i| {
                    lapidary::exact::support_side(&lapidary::exact::Support::Plane(*p), &c.point(c.corner_vertices[i]))
                })
                .find(|s| *s != Sign::Zero)
                == Some(Sign::Negative)
        })
    };
    (0..c.cell_count()).map(|k| (cell_volume(&c, CellId::of(k)), within(k))).collect()
}

/// All that must hold of meshes and half-spaces, whatever they are.
fn verified(meshes: &[Soup], planes: &[Plane], bounds: Bounds, what: &str) -> Arrangement {
    let a = arranged(meshes, planes, bounds);
    a.resolved.check().unwrap_or_else(|e| panic!("{what}: {e}"));
    a.cells.check().unwrap_or_else(|e| panic!("{what}: {e}"));
    a.winding.check(&a.cells).unwrap_or_else(|e| panic!("{what}: {e}"));
    let volumes = cell_volumes(&a);
    let n = meshes.len();
    assert!(volumes[1..].iter().all(|v| *v > 0), "{what}");
    // Of each half-space what of the box is in it.
    let [lo, hi] = if planes.is_empty() { [[0.0; 3], [1.0; 3]] } else { a.resolved.soup.half_spaces.bounds };
    let room = Arc::new(build_soup(&cuboid(lo, hi), Default::default()).unwrap());
    for i in 0..planes.len() {
        let mut sum = Rational::new();
        for (c, v) in volumes.iter().enumerate() {
            let w = dense(&a, c)[n + i];
            assert!(w == 0 || w == 1, "{what}: half-space {i} in cell {c}: {w}");
            if w == 1 {
                sum += v;
            }
        }
        let expected: Rational = cut_volumes(&room, &planes[i..=i]).into_iter().filter(|c| c.1).map(|c| c.0).sum();
        assert_eq!(sum, expected, "{what}: half-space {i}");
    }
    // Meshes are as they are without half-spaces.
    let alone = arrange(&operands(meshes), &ArrangementOptions::default(), &mut Run::quiet()).unwrap();
    let by_vector = |a: &Arrangement, volumes: Vec<Rational>| {
        let mut all: BTreeMap<Vec<i32>, Rational> = BTreeMap::new();
        for (c, v) in volumes.into_iter().enumerate() {
            *all.entry(dense(a, c)[..n].to_vec()).or_default() += v;
        }
        all.remove(&vec![0; n]);
        all
    };
    assert_eq!(by_vector(&a, volumes), by_vector(&alone, cell_volumes(&alone)), "{what}");
    a
}

/// As a complex everything holds, too.
fn whole(a: &Arrangement, what: &str) {
    let s = solids(a, &every_cell(a), &mut Run::quiet()).unwrap();
    s.check(a).unwrap_or_else(|e| panic!("{what}: {e}"));
    check(&s.complex).unwrap_or_else(|e| panic!("{what}: {e}"));
    check_volumes(&s.complex).unwrap_or_else(|e| panic!("{what}: {e}"));
    check_exact(&s.complex).unwrap_or_else(|e| panic!("{what}: {e}"));
    let m = moments(&s.complex);
    for (k, v) in cell_volumes(a)[1..].iter().enumerate() {
        assert_eq!(cell_volume(&s.complex, CellId::of(k)), *v, "{what}: cell {k}");
        assert_eq!(m.cell_volume[k], round_rational(v), "{what}: cell {k}");
    }
}

/// The cells of a solid are those that the cut engine makes.
fn like_cut(soup: &Soup, mesh: &Arc<TriMesh>, planes: &[Plane], what: &str) -> usize {
    let a = verified(std::slice::from_ref(soup), planes, None, what);
    let volumes = cell_volumes(&a);
    let mut ours: Vec<Rational> =
        volumes.into_iter().enumerate().filter(|(c, _)| dense(&a, *c)[0] > 0).map(|(_, v)| v).collect();
    let mut theirs: Vec<Rational> = cut_volumes(mesh, planes).into_iter().map(|c| c.0).collect();
    ours.sort();
    theirs.sort();
    assert!(ours == theirs, "{what}: {} cells, {} by the cut engine", ours.len(), theirs.len());
    ours.len()
}

fn plane(n: [f64; 3], d: f64) -> Plane {
    Plane { n, d }
}

/// A plane through three points of small whole numbers.
fn through([a, b, c]: [[f64; 3]; 3]) -> Option<Plane> {
    let to = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (u, v) = (to(b), to(c));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    (n != [0.0; 3]).then(|| plane(n, -(n[0] * a[0] + n[1] * a[1] + n[2] * a[2])))
}

#[test]
fn a_cube_and_planes() {
    let cube = cuboid([0.0; 3], [4.0; 3]);
    let mesh = Arc::new(build_soup(&cube, Default::default()).unwrap());
    let third = plane([3.0, 0.0, 0.0], -1.0);
    for (planes, cells, what) in [
        (vec![], 1, "none"),
        (vec![plane([1.0, 0.0, 0.0], -1.0)], 2, "across"),
        (vec![third], 2, "at a third"),
        (vec![plane([0.1; 3], -0.7)], 2, "a corner, not in doubles"),
        (vec![plane([1.0, 1.0, 1.0], 0.0)], 1, "touches a corner"),
        (vec![plane([1.0, 1.0, 0.0], 0.0)], 1, "touches an edge"),
        (vec![plane([1.0, 0.0, 0.0], 0.0)], 1, "in a side, facing in"),
        (vec![plane([-1.0, 0.0, 0.0], 0.0)], 1, "in a side, facing out"),
        (vec![plane([1.0, -1.0, 0.0], 0.0)], 2, "through two edges"),
        (vec![plane([1.0, -1.0, 0.0], 0.0), plane([2.0, -2.0, 0.0], 0.0)], 2, "twice the same"),
        (vec![plane([1.0, -1.0, 0.0], 0.0), plane([-1.0, 1.0, 0.0], 0.0)], 2, "both ways"),
        (vec![plane([1.0, 1.0, 1.0], -6.0), plane([1.0, -1.0, 0.0], 0.0)], 4, "two"),
        (
            vec![plane([1.0, -1.0, 0.0], 0.0), plane([0.0, 1.0, -1.0], 0.0), plane([1.0, 0.0, -1.0], 0.0)],
            6,
            "three through a line",
        ),
        (vec![plane([1.0, 0.0, 0.0], 100.0)], 1, "misses everything"),
        (vec![plane([1.0, 0.0, 0.0], -100.0)], 1, "everything is in it"),
        (vec![plane([1.0, 0.0, 0.0], -1.0), plane([1.0, 0.0, 0.0], -2.0), plane([-1.0, 0.0, 0.0], 3.0)], 4, "parallel"),
    ] {
        assert_eq!(like_cut(&cube, &mesh, &planes, what), cells, "{what}");
        if !planes.is_empty() {
            whole(&arranged(std::slice::from_ref(&cube), &planes, None), what);
        }
    }
    let a = verified(std::slice::from_ref(&cube), &[third], None, "volumes");
    let of = |text: &str| volume(&a, &extract(&a, &choose(&a, Selection::Expression(text)).unwrap()).unwrap());
    assert_eq!(of("0 & 1"), Rational::from((16, 3)));
    assert_eq!(of("0 - 1"), Rational::from((176, 3)));
    let e = choose(&a, Selection::Expression("!1")).unwrap_err();
    assert_eq!(e.status, Status::BadArgument);
    // The plane's faces are its operand's thirteenth.
    let e = extract(&a, &choose(&a, Selection::Expression("0 & 1")).unwrap()).unwrap();
    assert!(e.births.contains(&(OperandId::of(1), 12)));
    assert!(e.births.iter().all(|b| b.0.at() == 0 || b.1 == 12));
}

#[test]
fn boxes() {
    // Nothing but half-spaces: a tetrahedron, in boxes that hold it, cut it, touch it, miss it.
    let planes = [
        plane([-1.0, 0.0, 0.0], 0.0),
        plane([0.0, -1.0, 0.0], 0.0),
        plane([0.0, 0.0, -1.0], 0.0),
        plane([1.0; 3], -3.0),
    ];
    for (low, high, expected, what) in [
        ([-1.0; 3], [4.0; 3], Rational::from((9, 2)), "holds it"),
        ([0.0; 3], [3.0; 3], Rational::from((9, 2)), "its sides on the box"),
        ([0.0; 3], [1.0; 3], Rational::from(1), "touches the plane"),
        ([-1.0; 3], [1.0; 3], Rational::from(1), "cut"),
        ([1.0; 3], [2.0; 3], Rational::from(0), "touches in a corner"),
        ([-2.0; 3], [0.0; 3], Rational::from(0), "the other corner"),
        ([5.0; 3], [6.0; 3], Rational::from(0), "misses"),
        ([0.25, 0.25, -0.5], [0.5, 0.5, 8.0], Rational::from((9, 64)), "a column"),
    ] {
        let a = verified(&[], &planes, Some([low, high]), what);
        whole(&a, what);
        let inside = choose(&a, Selection::Intersection).unwrap();
        assert_eq!(volume(&a, &extract(&a, &inside).unwrap()), expected, "{what}");
    }
    // A mesh that reaches out of the box: it is whole, the half-space is not.
    let cube = [cuboid([0.0; 3], [4.0; 3])];
    for bounds in [
        [[1.0; 3], [2.0; 3]],
        [[1.0, 1.0, 1.0], [9.0, 9.0, 9.0]],
        [[0.0; 3], [4.0; 3]],
        [[-1.0, 0.0, 1.0], [4.0, 3.0, 5.0]],
    ] {
        for planes in
            [&planes[3..], &planes[2..], &planes[..], &[plane([0.0, 0.0, 1.0], -1.0), plane([0.0, 0.0, 1.0], -4.0)][..]]
        {
            let what = format!("{bounds:?} {planes:?}");
            whole(&verified(&cube, planes, Some(bounds), &what), &what);
        }
    }
    for (bounds, planes, status) in [
        (Some([[0.0; 3], [1.0, 0.0, 1.0]]), &planes[..], Status::BadArgument),
        (Some([[0.0; 3], [1.0, f64::NAN, 1.0]]), &planes[..], Status::BadArgument),
        (None, &planes[..], Status::BadArgument),
        (Some([[0.0; 3], [1.0; 3]]), &[plane([0.0; 3], 1.0)][..], Status::BadPlane),
        (Some([[0.0; 3], [1.0; 3]]), &[plane([f64::INFINITY; 3], 1.0)][..], Status::BadPlane),
    ] {
        let options = ArrangementOptions::default();
        let e = arrange_with(&[], planes, bounds, &options, &mut Run::quiet()).unwrap_err();
        assert_eq!(e.status, status);
    }
}

#[test]
fn small_soups_and_planes() {
    // Tetrahedra and planes on small whole numbers: everything is degenerate. Bounds on and off the same numbers.
    let mut random = Random(5);
    let (mut cells, mut planes_in_all) = (0, 0);
    for round in 0..250 {
        let size = 2 + random.below(3);
        let mut point = || [0; 3].map(|_| random.below(size + 1) as f64);
        let meshes: Vec<Soup> = (0..round % 4)
            .map(|_| Soup {
                vertices: (0..4).map(|_| point()).collect(),
                triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
            })
            .collect();
        let planes: Vec<Plane> = (0..1 + round % 5).filter_map(|_| through([point(), point(), point()])).collect();
        if planes.is_empty() {
            continue;
        }
        let bounds = match round % 3 {
            0 => [[-1.0; 3], [size as f64 + 1.5; 3]],
            1 => [[0.0; 3], [size as f64; 3]],
            _ => [[0.0, 0.5, 1.0], [size as f64 + 1.0, size as f64 - 0.5, size as f64]],
        };
        let what = format!("round {round}");
        let a = verified(&meshes, &planes, Some(bounds), &what);
        whole(&a, &what);
        cells += a.cell_count();
        planes_in_all += planes.len();
    }
    assert!(cells > 2000 && planes_in_all > 500, "{cells} cells, {planes_in_all} planes");
}

/// Everything times a power of two, planes times another one.
fn scaled(
    meshes: &[Soup],
    planes: &[Plane],
    bounds: [[f64; 3]; 2],
    [k, m]: [i32; 2],
) -> (Vec<Soup>, Vec<Plane>, Bounds) {
    let two = |x: f64, k: i32| x * 2f64.powi(k / 2) * 2f64.powi(k - k / 2);
    let place = |x: &[f64; 3]| x.map(|c| two(c, k));
    let mesh = |s: &Soup| Soup { vertices: s.vertices.iter().map(place).collect(), triangles: s.triangles.clone() };
    let plane = |p: &Plane| plane(p.n.map(|c| two(c, m)), two(p.d, k + m));
    (meshes.iter().map(mesh).collect(), planes.iter().map(plane).collect(), Some(bounds.map(|x| place(&x))))
}

#[test]
fn coordinates_and_planes_of_any_magnitude() {
    // Small whole numbers times powers of two: a few of the least doubles there are, and up to the largest ones.
    let mut random = Random(12);
    for round in 0..60 {
        let mut point = || [0; 3].map(|_| random.below(7) as f64);
        let meshes: Vec<Soup> = (0..round % 4)
            .map(|_| Soup {
                vertices: (0..4).map(|_| point()).collect(),
                triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
            })
            .collect();
        let planes: Vec<Plane> = (0..2 + round % 3).filter_map(|_| through([point(), point(), point()])).collect();
        if planes.is_empty() {
            continue;
        }
        let bounds = [[0.0; 3], [7.0; 3]];
        let expected = arranged(&meshes, &planes, Some(bounds)).cell_count();
        for powers in [[-1074, 1010], [-1074, 0], [-1072, 600], [-1060, 900], [1020, -1070], [1021, 0], [1020, -600]] {
            let (meshes, planes, bounds) = scaled(&meshes, &planes, bounds, powers);
            let finite = planes.iter().all(|p| p.d.is_finite() && p.n.iter().all(|c| c.is_finite()));
            if finite {
                let what = format!("round {round}, times two to the {powers:?}");
                let a = verified(&meshes, &planes, bounds, &what);
                assert_eq!(a.cell_count(), expected, "{what}");
            }
        }
    }
}

#[test]
fn models_are_cut_as_by_the_cut_engine() {
    let mut runs = 0;
    let there = each_model(800, |name, soup, mesh| {
        let mut random = Random(soup.triangles.len() as u64);
        let sets = [
            ("grid", grid(&mesh, 2)),
            ("arbitrary", arbitrary(&mesh, 4, &mut random)),
            ("incident", incident(&mesh, 3, &mut random)),
        ];
        for (what, planes) in &sets {
            like_cut(soup, &mesh, planes, &format!("{name} {what}"));
            runs += 1;
        }
        if let Some(whole_numbers) = on_integers(soup) {
            let mesh = Arc::new(whole_numbers);
            let triangles = mesh.triangles.iter().map(|t| t.map(|v| v.0 as i32)).collect();
            let soup = Soup { vertices: mesh.vertices.clone(), triangles };
            like_cut(&soup, &mesh, &incident(&mesh, 4, &mut random), &format!("{name} whole numbers"));
            runs += 1;
        }
    });
    assert!(!there || runs > 20, "{runs} runs");
}

#[test]
fn a_mesh_that_intersects_itself() {
    let Some(folder) = cgal_meshes() else { return };
    let bull = read_mesh(&folder.join("bull.off")).unwrap();
    let mesh = [bull];
    let (mut lo, mut hi) = (mesh[0].vertices[0], mesh[0].vertices[0]);
    for x in &mesh[0].vertices {
        for i in 0..3 {
            lo[i] = lo[i].min(x[i]);
            hi[i] = hi[i].max(x[i]);
        }
    }
    let middle = |i: usize| 0.5 * (lo[i] + hi[i]);
    let planes = [
        plane([1.0, 0.0, 0.0], -middle(0)),
        plane([0.3, 0.5, -0.7], -(0.3 * middle(0) + 0.5 * middle(1) - 0.7 * middle(2))),
        plane([0.0, 3.0, 1.0], -(3.0 * mesh[0].vertices[7][1] + mesh[0].vertices[7][2])),
    ];
    let a = verified(&mesh, &planes, None, "bull");
    let resolved = choose(&a, Selection::Expression("0")).unwrap();
    let total = volume(&a, &extract(&a, &resolved).unwrap());
    let alone = arrange(&operands(&mesh), &ArrangementOptions::default(), &mut Run::quiet()).unwrap();
    let expected = volume(&alone, &extract(&alone, &choose(&alone, Selection::Resolve).unwrap()).unwrap());
    assert_eq!(total, expected);
    let sum: Rational =
        cell_volumes(&a).into_iter().enumerate().filter(|(c, _)| dense(&a, *c)[0] > 0).map(|(_, v)| v).sum();
    assert_eq!(sum, expected);
    println!("bull: {} cells, {} without planes", a.cell_count(), alone.cell_count());
}

#[test]
fn parallel_planes_cost_their_square_at_most() {
    // Each side of the box is cut into strips, and each half-space has what of them is in it.
    let decisions = |n: usize| {
        let planes: Vec<Plane> = (0..n).map(|i| plane([1.0, 0.0, 0.0], -(i as f64) / n as f64)).collect();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| {
            counters::take();
            counters::enable(true);
            let a = arranged(&[], &planes, Some([[-2.0; 3], [2.0; 3]]));
            counters::enable(false);
            assert_eq!(a.cell_count(), n + 1);
            let counts = counters::take();
            counters::TIERS.iter().map(|t| counts.tier(*t)).sum::<u64>()
        })
    };
    let [some, twice] = [100, 200].map(decisions);
    assert!(some > 0 && twice < 5 * some, "{some} decisions for 100 planes, {twice} for 200");
}

#[test]
fn threads_do_not_matter() {
    let mut random = Random(9);
    let (vertices, triangles) = common::icosphere::icosphere(3);
    let soup = Soup { vertices, triangles };
    let mesh = build_soup(&soup, Default::default()).unwrap();
    let mut planes = arbitrary(&mesh, 12, &mut random);
    planes.extend(grid(&mesh, 3));
    planes.extend(incident(&mesh, 4, &mut random));
    let meshes = [soup];
    let made = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let a = arranged(&meshes, &planes, None);
            let s = solids(&a, &every_cell(&a), &mut Run::quiet()).unwrap();
            (a, s)
        })
    };
    let (one, s) = made(1);
    for threads in [2, 5] {
        let (other, t) = made(threads);
        assert_eq!(one.resolved.faces, other.resolved.faces);
        assert_eq!(one.resolved.support, other.resolved.support);
        assert_eq!(one.resolved.births, other.resolved.births);
        assert_eq!(one.resolved.points.origins, other.resolved.points.origins);
        assert_eq!(one.cells.of, other.cells.of);
        assert_eq!(one.winding.rows, other.winding.rows);
        assert_eq!(s.faces, t.faces);
        assert_eq!(s.complex.corner_vertices, t.complex.corner_vertices);
        assert_eq!(s.complex.shell_faces, t.complex.shell_faces);
    }
}

//! Regions as volumes: exact volumes against simplices cut up in rationals, and all that complexes promise.

mod common;

use common::functions::evaluate;
use common::random::Random;
use lapidary::base::{CellId, NodeId, PolygonId, RegionId, Run, Status, TetId, VertexId};
use lapidary::complex::check::check_exact;
use lapidary::complex::exact_values::{cell_values, cell_volume, mesh_volume};
use lapidary::complex::{CertifyOptions, Complex, HalfFace, Origin, SupportId};
use lapidary::complex::{adjacency, certify, check, check_volumes, moments};
use lapidary::exact::round_rational;
use lapidary::network::exact_vertices::exact_vertex;
use lapidary::network::local::Setting;
use lapidary::network::regions::Method;
use lapidary::network::topology::{Topology, find_topology};
use lapidary::network::volumes::volumes;
use lapidary::network::{BoxGrid, Domain, Kind, Network, TetMesh, Values, extract};
use rug::Rational;
use std::collections::BTreeMap;

const KINDS: [Kind; 2] = [Kind::Arrangement, Kind::Interface];

fn rounds(default: usize) -> usize {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

fn of(x: f64) -> Rational {
    Rational::from_f64(x).unwrap()
}

/// A corner: x, y, z, then the value of each function.
type Corner = Vec<Rational>;

/// Cuts a simplex where a form changes sign: at an edge whose ends have opposite signs, until there is none.
fn cut(simplex: [Corner; 4], form: &dyn Fn(&Corner) -> Rational, out: &mut Vec<[Corner; 4]>) {
    let at = simplex.each_ref().map(form);
    for i in 0..4 {
        for j in 0..i {
            if at[i].cmp0().is_ne() && at[i].cmp0() == at[j].cmp0().reverse() {
                let t = &at[i] / Rational::from(&at[i] - &at[j]);
                let between = |(a, b): (&Rational, &Rational)| Rational::from(b - a) * &t + a;
                let point: Corner = simplex[i].iter().zip(&simplex[j]).map(between).collect();
                for k in [i, j] {
                    let mut part = simplex.clone();
                    part[k] = point.clone();
                    cut(part, form, out);
                }
                return;
            }
        }
    }
    out.push(simplex);
}

fn volume(simplex: &[Corner; 4]) -> Rational {
    let d: Vec<[Rational; 3]> =
        (1..4).map(|k| std::array::from_fn(|i| Rational::from(&simplex[k][i] - &simplex[0][i]))).collect();
    let minor = |i: usize, j: usize| Rational::from(&d[1][i] * &d[2][j]) - Rational::from(&d[1][j] * &d[2][i]);
    let six: Rational = minor(1, 2) * &d[0][0] + minor(2, 0) * &d[0][1] + minor(0, 1) * &d[0][2];
    six.abs() / 6
}

/// The volume with each label (signs, or the material), and in all.
fn reference(domain: &Domain, arrays: &[Vec<f64>], kind: Kind) -> (BTreeMap<Vec<i32>, Rational>, Rational) {
    let (mut by_label, mut all) = (BTreeMap::new(), Rational::new());
    let n = arrays.len();
    for t in 0..domain.tet_count() {
        let corner = |node: NodeId| -> Corner {
            let x = domain.coordinates(node).map(of);
            x.into_iter().chain(arrays.iter().map(|f| of(f[node.at()]))).collect()
        };
        let mut parts = vec![domain.corners(TetId::of(t)).map(corner)];
        all += volume(&parts[0]);
        let mut apply = |form: &dyn Fn(&Corner) -> Rational| {
            let mut next = Vec::new();
            std::mem::take(&mut parts).into_iter().for_each(|s| cut(s, form, &mut next));
            parts = next;
        };
        for i in 0..n {
            match kind {
                Kind::Arrangement => apply(&|c| c[3 + i].clone()),
                Kind::Interface => (0..i).for_each(|j| apply(&|c| Rational::from(&c[3 + i] - &c[3 + j]))),
            }
        }
        for part in &parts {
            let middle: Vec<Rational> =
                (0..n).map(|f| part.iter().fold(Rational::new(), |sum, c| sum + &c[3 + f])).collect();
            let label = match kind {
                Kind::Arrangement => middle.iter().map(|x| x.cmp0() as i32).collect(),
                Kind::Interface => vec![(0..n).rev().max_by(|&i, &j| middle[i].cmp(&middle[j])).unwrap() as i32],
            };
            *by_label.entry(label).or_default() += volume(part);
        }
    }
    (by_label, all)
}

fn label(topology: &Topology, kind: Kind, r: usize) -> Vec<i32> {
    match kind {
        Kind::Arrangement => topology.regions.signs_of(RegionId::of(r)).iter().map(|s| s.to_i8() as i32).collect(),
        Kind::Interface => vec![topology.regions.materials[r].0 as i32],
    }
}

/// Makes the complex by both methods, and holds it to all that complexes and this one promise.
fn regions(domain: &Domain, arrays: &[Vec<f64>], kind: Kind) -> (Network, Topology, Complex) {
    let functions: Vec<&[f64]> = arrays.iter().map(Vec::as_slice).collect();
    let values = Values { functions: &functions, stride: 1 };
    let network = extract(domain, &values, kind, &mut Run::quiet()).unwrap();
    let setting = Setting { network: &network, domain, values };
    let topology = find_topology(&setting, Method::Automatic, &mut Run::quiet()).unwrap();
    let c = volumes(&setting, &topology, &mut Run::quiet()).unwrap();
    c.mesh.check().unwrap();
    check(&c).unwrap();
    check_volumes(&c).unwrap();
    check_exact(&c).unwrap();
    // Cells are regions, faces polygons, vertices those of the network.
    assert_eq!(c.cell_count(), topology.regions.len());
    let walls = c.face_count() - network.polygon_count();
    for f in 0..c.face_count() {
        match c.face_support[f] {
            SupportId::Level(p) => {
                assert_eq!(f - walls, p.at());
                let beside = [false, true].map(|front| topology.region_beside(p, front).0);
                assert_eq!(c.face_cells[f].map(|c| c.0), beside);
            }
            support => assert!(f < walls && matches!(support, SupportId::Triangle(_))),
        }
    }
    for v in (0..c.vertex_count()).map(VertexId::of) {
        if let Origin::Level(i) = c.origins[v.at()] {
            let named = c.levels.vertices[i as usize];
            assert_eq!(c.coords[v.at()], network.vertices[named.at()]);
            let place = lapidary::exact::rational(&c.point(v));
            assert_eq!(place, exact_vertex(&network, domain, &values, named));
        }
    }
    (network, topology, c)
}

/// The same, with volumes as cut up.
fn compare(domain: &Domain, arrays: &[Vec<f64>], kind: Kind) -> (Network, Topology, Complex) {
    let (network, topology, c) = regions(domain, arrays, kind);
    let (expected, all) = reference(domain, arrays, kind);
    let (mut found, mut sum) = (BTreeMap::new(), Rational::new());
    let rounded = moments(&c);
    for cell in (0..c.cell_count()).map(CellId::of) {
        let (volume, centroid) = cell_values(&c, cell);
        assert_eq!(volume, cell_volume(&c, cell));
        assert_eq!(rounded.cell_volume[cell.at()], round_rational(&volume));
        assert_eq!(rounded.cell_centroid[cell.at()], centroid.each_ref().map(round_rational));
        sum += &volume;
        *found.entry(label(&topology, kind, cell.at())).or_default() += volume;
    }
    assert_eq!(found, expected);
    assert_eq!(sum, all);
    assert_eq!(mesh_volume(&c.mesh), all);
    (network, topology, c)
}

fn random_values(random: &mut Random, functions: usize, nodes: usize, bound: i64) -> Vec<Vec<f64>> {
    (0..functions).map(|_| (0..nodes).map(|_| random.within(bound)).collect()).collect()
}

#[test]
fn spheres_on_small_grids() {
    for n in 2..=4 {
        let grid = BoxGrid::new([n; 3], Some([[-1.0; 3], [1.0; 3]])).unwrap();
        // Whole numbers: squares of distances in steps of the grid.
        let square = |x: &[f64; 3]| x.iter().map(|c| (c * n as f64).powi(2)).sum::<f64>().round();
        let r = (n * n) as f64;
        let ball = |x: &[f64; 3]| r / 2.0 - square(x);
        let outer = |x: &[f64; 3]| 2.0 * r - square(x);
        let half = |x: &[f64; 3]| x[0] * n as f64 + 1.0;
        let domain = Domain::Box(grid.clone());
        let one = evaluate(&grid, &[ball]);
        let (_, _, c) = compare(&domain, &one, Kind::Arrangement);
        assert_eq!(c.cell_count(), 2);
        // The ball does not touch the box: a wall of a void.
        assert_eq!(c.shell_faces.len(), 3);
        type Function<'a> = &'a dyn Fn(&[f64; 3]) -> f64;
        let functions: [Function; 3] = [&ball, &outer, &half];
        let three = evaluate(&grid, &functions.map(|f| move |x: &[f64; 3]| f(x)));
        for kind in KINDS {
            compare(&domain, &three, kind);
        }
    }
}

#[test]
fn degenerate_boxes() {
    let mut random = Random(1);
    for round in 0..rounds(40) {
        let cells = [[1, 1, 1], [2, 2, 2], [1, 3, 2], [2, 2, 3]][round % 4];
        let grid = BoxGrid::new(cells, Some([[-1.0, 0.0, 0.25], [1.0, 0.75, 3.0]])).unwrap();
        let bound = [1, 1, 2, 100][random.below(4) as usize];
        let n = 1 + random.below(3) as usize;
        let mut arrays = random_values(&mut random, n, grid.node_count(), bound);
        if round % 3 == 0 {
            arrays.iter_mut().flatten().filter(|x| **x != 0.0).for_each(|x| *x = x.abs());
            let at = random.below(grid.node_count() as u64) as usize;
            arrays[0][at] *= -1.0;
        }
        for kind in KINDS {
            compare(&Domain::Box(grid.clone()), &arrays, kind);
        }
    }
}

fn explicit(grid: &BoxGrid) -> (Vec<[f64; 3]>, Vec<[i32; 4]>) {
    let vertices = (0..grid.node_count()).map(|n| grid.coordinates(NodeId::of(n))).collect();
    let tets = (0..grid.tet_count()).map(|t| grid.corners(TetId::of(t)).map(|n| n.0 as i32)).collect();
    (vertices, tets)
}

#[test]
fn rings_cavities_and_parts() {
    let mut random = Random(2);
    for round in 0..rounds(40) {
        let grid = BoxGrid::new([[2, 2, 2], [3, 3, 3]][round % 2], None).unwrap();
        let (vertices, tets) = explicit(&grid);
        let percent = [95, 80, 50, 25][random.below(4) as usize];
        let mut tets: Vec<[i32; 4]> = tets.into_iter().filter(|_| random.below(100) < percent).collect();
        if tets.is_empty() {
            continue;
        }
        // Some turned inside out by their order.
        tets.iter_mut().filter(|_| random.below(2) == 0).for_each(|t| t.swap(0, 2));
        let domain = Domain::Mesh(TetMesh::tets(vertices.clone(), &tets).unwrap());
        let bound = [0, 1, 2, 100][random.below(4) as usize];
        let n = 1 + random.below(2) as usize;
        let arrays = random_values(&mut random, n, vertices.len(), bound);
        for kind in KINDS {
            compare(&domain, &arrays, kind);
        }
    }
}

#[test]
fn a_ring_and_a_cube_apart() {
    let grid = BoxGrid::new([5, 3, 1], None).unwrap();
    let (vertices, tets) = explicit(&grid);
    let inside = |tet: &[i32; 4]| {
        let center = [0, 1].map(|k| tet.iter().map(|&n| vertices[n as usize][k]).sum::<f64>() / 4.0);
        let cube = center.map(|c| c.floor() as i32);
        (cube[0] < 3 && cube != [1, 1]) || cube == [4, 0]
    };
    let tets: Vec<[i32; 4]> = tets.iter().copied().filter(inside).collect();
    let domain = Domain::Mesh(TetMesh::tets(vertices.clone(), &tets).unwrap());
    let values = |f: &dyn Fn(&[f64; 3]) -> f64| vec![vertices.iter().map(f).collect::<Vec<f64>>()];
    let sorted = |c: &Complex| {
        let mut all: Vec<Rational> = (0..c.cell_count()).map(|k| cell_volume(c, CellId::of(k))).collect();
        all.sort();
        all
    };
    // The ring is 8 cubes.
    let (_, _, c) = compare(&domain, &values(&|_| 1.0), Kind::Arrangement);
    assert_eq!(sorted(&c), [1, 8]);
    assert_eq!(c.cell_component.iter().map(|k| k.0).collect::<std::collections::BTreeSet<_>>().len(), 2);
    let (_, _, c) = compare(&domain, &values(&|x| x[1] - 1.5), Kind::Arrangement);
    assert_eq!(sorted(&c), [1, 4, 4]);
}

#[test]
fn voids_within_voids() {
    // Nested balls, and one beside: the outermost region has two voids, shells of balls one each.
    let grid = BoxGrid::new([16; 3], Some([[-1.0; 3], [1.0; 3]])).unwrap();
    let ball = |c: f64, r: f64| move |x: &[f64; 3]| r - ((x[0] - c).powi(2) + x[1] * x[1] + x[2] * x[2]).sqrt();
    let arrays = evaluate(&grid, &[ball(-0.3, 0.6), ball(-0.3, 0.4), ball(-0.3, 0.17), ball(0.65, 0.23)]);
    let (network, topology, c) = regions(&Domain::Box(grid), &arrays, Kind::Arrangement);
    assert_eq!((c.cell_count(), c.shell_faces.len()), (5, 9));
    let mut shells: Vec<u32> = c.cell_shells.windows(2).map(|w| w[1] - w[0]).collect();
    shells.sort_unstable();
    assert_eq!(shells, [1, 1, 2, 2, 3]);
    let total = (0..5).map(|k| cell_volume(&c, CellId::of(k))).fold(Rational::new(), |sum, v| sum + v);
    assert_eq!(total, 8);
    // Each half-face of a polygon is in a shell of the region that it borders, and closed shells have neighbours across every edge.
    let walls = c.face_count() - network.polygon_count();
    for p in 0..network.polygon_count() {
        for front in [false, true] {
            let region = topology.region_beside(PolygonId::of(p), front);
            let half = HalfFace::new(lapidary::base::FaceId::of(walls + p), front);
            assert!(c.cell_faces(CellId(region.0)).binary_search(&half).is_ok() || shells.len() > 1);
        }
    }
    adjacency(&c).unwrap();
}

#[test]
fn pieces_that_end_inside_a_region() {
    // Zero on one square of a plane between cubes, positive elsewhere: one region on both sides.
    let grid = BoxGrid::new([3, 3, 2], None).unwrap();
    let mut values = vec![1.0; grid.node_count()];
    for (i, j) in [(1, 1), (2, 1), (1, 2), (2, 2)] {
        values[grid.node([i, j, 1]).at()] = 0.0;
    }
    let (_, _, c) = compare(&Domain::Box(grid), &[values], Kind::Arrangement);
    assert_eq!(c.cell_shells, [0, 2]);
    assert_eq!(c.shell_faces.row(1usize).len(), 4);
}

#[test]
fn on_any_number_of_threads() {
    let grid = BoxGrid::new([24; 3], Some([[-1.0; 3], [1.0; 3]])).unwrap();
    let ball = |c: f64, r: f64| move |x: &[f64; 3]| r - ((x[0] - c).powi(2) + x[1] * x[1] + x[2] * x[2]).sqrt();
    let arrays = evaluate(&grid, &[ball(-0.3, 0.9), ball(0.3, 0.9), ball(0.0, 0.4)]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (_, _, c) = pool.install(|| regions(&Domain::Box(grid.clone()), &arrays, Kind::Interface));
        (
            c.origins,
            c.corner_vertices,
            c.corner_edges,
            c.face_cells,
            c.cell_shells,
            c.shell_faces,
            c.levels.supports.clone(),
        )
    };
    let one = on(1);
    assert!(one == on(2) && one == on(8));
}

#[test]
fn what_has_no_volumes() {
    let make = |mesh: TetMesh, arrays: &[Vec<f64>]| {
        let functions: Vec<&[f64]> = arrays.iter().map(Vec::as_slice).collect();
        let values = Values { functions: &functions, stride: 1 };
        let domain = Domain::Mesh(mesh);
        let network = extract(&domain, &values, Kind::Arrangement, &mut Run::quiet()).unwrap();
        let setting = Setting { network: &network, domain: &domain, values };
        let topology = find_topology(&setting, Method::Automatic, &mut Run::quiet()).unwrap();
        volumes(&setting, &topology, &mut Run::quiet()).unwrap_err()
    };
    let flat = TetMesh::triangles(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &[[0, 1, 2]]).unwrap();
    let error = make(flat, &[vec![1.0, -1.0, 1.0]]);
    assert_eq!((error.status, error.message.contains("two dimensions")), (Status::BadArgument, true));
    assert_eq!(make(TetMesh::tets(Vec::new(), &[]).unwrap(), &[]).status, Status::BadMesh);
    // Two tetrahedra with nodes of their own in one place.
    let mut places = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    places.push(places[1]);
    let twice = TetMesh::tets(places, &[[0, 1, 2, 3], [0, 5, 2, 4]]).unwrap();
    let error = make(twice, &[vec![1.0; 6]]);
    assert_eq!(error.status, Status::BadMesh);
    assert_eq!(error.culprits[0].ids[..2], [1, 5]);
}

#[test]
fn rounded_regions_are_certified() {
    let grid = BoxGrid::new([12; 3], Some([[-1.0; 3], [1.0; 3]])).unwrap();
    let ball = |c: f64, r: f64| move |x: &[f64; 3]| r - ((x[0] - c).powi(2) + x[1] * x[1] + x[2] * x[2]).sqrt();
    let arrays = evaluate(&grid, &[ball(-0.31, 0.613), ball(0.29, 0.587), ball(0.017, 0.371)]);
    for kind in KINDS {
        let (_, _, c) = regions(&Domain::Box(grid.clone()), &arrays, kind);
        let done = certify(&c, &CertifyOptions::default(), &mut Run::quiet()).unwrap();
        assert!(done.report.certified, "{kind:?}: {:?}", done.report);
        assert!(done.report.removed_cells == 0 && done.report.moved_mesh_vertices == 0);
    }
}

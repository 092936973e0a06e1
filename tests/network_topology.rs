//! Patches, chains, shells and regions of networks: known counts, every method against a plain grouping of all cells of all simplices, and
//! everything that may not change the result.

mod common;

use common::functions::{evaluate, read_spheres, sphere_values};
use common::random::Random;
use common::shared;
use lapidary::base::{FunctionId, NodeId, PolygonId, RegionId, Run, Status, TetId, UnionFind};
use lapidary::exact::Sign;
use lapidary::network::csg::{Boundary, Choice, boundary, choose};
use lapidary::network::local::{Local, Setting};
use lapidary::network::regions::Method;
use lapidary::network::simplex::{self, FaceSupport, LocalCell, LocalFunction, Scratch, SimplexComplex};
use lapidary::network::ties::tied_materials;
use lapidary::network::topology::{Topology, find_topology};
use lapidary::network::{BoxGrid, Domain, Kind, Network, TetMesh, Values, extract};
use std::collections::HashMap;

const KINDS: [Kind; 2] = [Kind::Arrangement, Kind::Interface];

fn rounds(default: usize) -> usize {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

fn cube(n: u32) -> BoxGrid {
    BoxGrid::new([n; 3], Some([[-1.0; 3], [1.0; 3]])).unwrap()
}

fn slices(arrays: &[Vec<f64>]) -> Vec<&[f64]> {
    arrays.iter().map(Vec::as_slice).collect()
}

/// The network and what it forms, by both methods, checked.
fn topology(domain: &Domain, arrays: &[Vec<f64>], kind: Kind) -> (Network, Topology) {
    let functions = slices(arrays);
    let values = Values { functions: &functions, stride: 1 };
    let network = extract(domain, &values, kind, &mut Run::quiet()).unwrap();
    let setting = Setting { network: &network, domain, values };
    let found = find_topology(&setting, Method::Automatic, &mut Run::quiet()).unwrap();
    found.check(&setting).unwrap();
    let classes = find_topology(&setting, Method::Classes, &mut Run::quiet()).unwrap();
    // A region without shells may be seen from another simplex.
    assert_eq!(found.regions.of_shell, classes.regions.of_shell);
    assert_eq!(found.regions.signs, classes.regions.signs);
    assert_eq!(found.regions.materials, classes.regions.materials);
    (network, found)
}

/// What a cell is: signs of all functions, or its material alone.
type Label = Vec<i32>;

fn label_of(complex: &SimplexComplex, n: usize, cell: LocalCell) -> Label {
    match complex.kind {
        Kind::Arrangement => (0..n).map(|f| complex.cell_sign(cell, LocalFunction::of(f)).to_i8() as i32).collect(),
        Kind::Interface => vec![complex.cell_owner[cell.at()].0 as i32],
    }
}

fn region_label(topology: &Topology, kind: Kind, r: usize) -> Label {
    match kind {
        Kind::Arrangement => topology.regions.signs_of(RegionId::of(r)).iter().map(|s| s.to_i8() as i32).collect(),
        Kind::Interface => vec![topology.regions.materials[r].0 as i32],
    }
}

/// Cells of all simplices, grouped across facets: the group and label of each cell.
struct Grouping {
    /// First cell of each simplex.
    first: Vec<usize>,
    labels: Vec<Label>,
    group: Vec<u32>,
    count: usize,
}

/// What tells the pieces of a facet apart: the signs of the functions there, or the values of the largest material at its nodes.
fn piece(complex: &SimplexComplex, cell: LocalCell, facet: &[NodeId], values: &Values) -> Vec<u64> {
    match complex.kind {
        Kind::Arrangement => (0..values.len())
            .map(|f| {
                let zero = facet.iter().all(|&n| values.at(FunctionId::of(f), n) == 0.0);
                let sign = if zero { Sign::Zero } else { complex.cell_sign(cell, LocalFunction::of(f)) };
                sign.to_i8() as u64
            })
            .collect(),
        Kind::Interface => {
            let owner = FunctionId(complex.cell_owner[cell.at()].0);
            facet.iter().map(|&n| (values.at(owner, n) + 0.0).to_bits()).collect()
        }
    }
}

fn grouping(domain: &Domain, values: &Values, kind: Kind) -> Grouping {
    let (dim, n) = (domain.dim(), values.len());
    let (mut scratch, mut complexes) = (Scratch::default(), Vec::new());
    let (mut first, mut labels) = (vec![0], Vec::new());
    for t in 0..domain.tet_count() {
        let corners = domain.corners(TetId::of(t));
        let flat: Vec<f64> =
            (0..n).flat_map(|f| corners[..=dim].iter().map(move |&node| values.at(FunctionId::of(f), node))).collect();
        let mut complex = SimplexComplex::default();
        match kind {
            Kind::Arrangement => simplex::arrangement(dim, &flat, &mut scratch, &mut complex),
            Kind::Interface => simplex::interface(dim, &flat, &mut scratch, &mut complex),
        }
        labels.extend((0..complex.cell_count()).map(|c| label_of(&complex, n, LocalCell::of(c))));
        first.push(labels.len());
        complexes.push(complex);
    }
    let mut groups = UnionFind::new(labels.len());
    for t in 0..domain.tet_count() {
        let corners = domain.corners(TetId::of(t));
        for k in 0..=dim {
            let Some((other, _)) = domain.opposite(TetId::of(t), k) else { continue };
            let mut facet: Vec<NodeId> = (0..=dim).filter(|&i| i != k).map(|i| corners[i]).collect();
            facet.sort_unstable();
            let pieces = |t: usize, k: usize| {
                let complex: &SimplexComplex = &complexes[t];
                let at = complex.face_support.iter().zip(&complex.face_cells);
                let cells = at.filter(move |(s, _)| **s == FaceSupport::Facet(k as u8)).map(|(_, cells)| cells[0]);
                cells.map(|c| (piece(complex, c, &facet, values), first[t] + c.at())).collect::<HashMap<_, _>>()
            };
            let back = (0..=dim).find(|&i| domain.opposite(other, i).is_some_and(|(o, _)| o.at() == t)).unwrap();
            let (here, there) = (pieces(t, k), pieces(other.at(), back));
            assert_eq!(here.len(), there.len());
            for (key, &a) in &here {
                let b = there[key];
                let vanishes = |f: usize| facet.iter().all(|&node| values.at(FunctionId::of(f), node) == 0.0);
                let free = kind == Kind::Interface || (0..n).all(|f| !vanishes(f) || labels[a][f] == 0);
                if labels[a] == labels[b] && free {
                    groups.union(a, b);
                }
            }
        }
    }
    let (group, count) = groups.labels();
    Grouping { first, labels, group, count }
}

/// Regions are the groups, side by side at every polygon.
fn compare(domain: &Domain, arrays: &[Vec<f64>], kind: Kind) -> (Network, Topology) {
    let (network, found) = topology(domain, arrays, kind);
    let functions = slices(arrays);
    let values = Values { functions: &functions, stride: 1 };
    let setting = Setting { network: &network, domain, values };
    let groups = grouping(domain, &values, kind);
    let regions = found.regions.len();
    let mut all: Vec<Label> = (0..regions).map(|r| region_label(&found, kind, r)).collect();
    let mut expected = vec![Label::new(); groups.count];
    for (c, label) in groups.labels.iter().enumerate() {
        expected[groups.group[c] as usize] = label.clone();
    }
    let mut group_of = vec![u32::MAX; regions];
    let (mut local, mut walls) = (Local::default(), Vec::new());
    for p in (0..network.polygon_count()).map(PolygonId::of) {
        for front in [true, false] {
            let tet = network.polygon_tets[p.at()][!front as usize];
            local.build(&setting, tet);
            let cell = local.cell_beside(&setting, p, front, &mut walls).unwrap();
            let label: Label = match kind {
                Kind::Arrangement => {
                    let mut signs = vec![Sign::Zero; arrays.len()];
                    local.signs(&setting, cell, &mut signs);
                    signs.iter().map(|s| s.to_i8() as i32).collect()
                }
                Kind::Interface => vec![local.owner(cell).0 as i32],
            };
            let region = found.region_beside(p, front).at();
            assert_eq!(label, all[region]);
            let cells = groups.first[tet.at()]..groups.first[tet.at() + 1];
            let c = cells.into_iter().find(|&c| groups.labels[c] == label).expect("a cell with this label");
            assert!([u32::MAX, groups.group[c]].contains(&group_of[region]), "a region in two groups");
            group_of[region] = groups.group[c];
        }
    }
    let mut taken: Vec<u32> = group_of.into_iter().filter(|&g| g != u32::MAX).collect();
    taken.sort_unstable();
    assert!(taken.windows(2).all(|w| w[0] != w[1]), "a group in two regions");
    all.sort_unstable();
    expected.sort_unstable();
    assert_eq!(all, expected);
    (network, found)
}

/// Edges, patches, chains, shells, components, regions.
fn counts(t: &Topology) -> [usize; 6] {
    [t.edges.len(), t.patches.len(), t.chains.len(), t.shells.len(), t.patches.component_count, t.regions.len()]
}

#[test]
fn counts_of_the_paper() {
    let expected = [
        ("ia-spheres-4", Kind::Arrangement, [295706, 32, 24, 16, 1, 16]),
        ("mi-spheres-4", Kind::Interface, [234078, 6, 3, 4, 1, 4]),
        ("ia-nested-18", Kind::Arrangement, [1519950, 18, 0, 36, 18, 19]),
    ];
    for (name, kind, expected) in expected {
        let Some(path) = shared(&format!("data/functions/{name}.json")) else { return };
        let grid = cube(99);
        let arrays = sphere_values(&grid, &read_spheres(&path));
        let (_, found) = topology(&Domain::Box(grid), &arrays, kind);
        assert_eq!(counts(&found), expected, "{name}");
    }
}

/// The mesh has as many half-edges one way as the other; returns six times its volume.
fn closed_volume(network: &Network, mesh: &Boundary) -> f64 {
    let mut sides = Vec::new();
    let mut volume = 0.0;
    let place = |v: u32| network.vertices[mesh.vertices[v as usize].at()];
    for row in mesh.polygons.rows() {
        sides.extend((0..row.len()).map(|k| (row[k], row[(k + 1) % row.len()])));
        for k in 2..row.len() {
            let [a, b, c] = [row[0], row[k - 1], row[k]].map(place);
            volume += a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
    }
    let mut back: Vec<_> = sides.iter().map(|&(a, b)| (b, a)).collect();
    sides.sort_unstable();
    back.sort_unstable();
    assert_eq!(sides, back, "the boundary is open");
    volume
}

#[test]
fn solids_of_regions() {
    let grid = cube(24);
    let ball = |c: f64, r: f64| move |x: &[f64; 3]| r - ((x[0] - c).powi(2) + x[1] * x[1] + x[2] * x[2]).sqrt();
    let arrays = evaluate(&grid, &[ball(-0.2, 0.5), ball(0.2, 0.5), ball(0.0, 0.2)]);
    let (network, found) = topology(&Domain::Box(grid), &arrays, Kind::Arrangement);
    let solid = |text: &str, triangles: bool| {
        let chosen = choose(&network, &found, Choice::Expression(text)).unwrap();
        let table = choose(&network, &found, Choice::Table(&chosen)).unwrap();
        let mut asked = |r: RegionId| chosen[r.at()];
        assert_eq!(choose(&network, &found, Choice::Callback(&mut asked)).unwrap(), table);
        boundary(&network, &found, &chosen, triangles)
    };
    let volume = |text: &str| {
        let (mesh, fans) = (solid(text, false), solid(text, true));
        assert!(fans.polygons.rows().all(|row| row.len() == 3));
        assert_eq!(mesh.vertices, fans.vertices);
        let volume = closed_volume(&network, &mesh);
        assert!((volume - closed_volume(&network, &fans)).abs() < 1e-12);
        volume
    };
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
    let [a, b, both] = ["0", "1", "0 & 1"].map(volume);
    assert!(a > 0.0 && b > 0.0 && both > 0.0);
    close(volume("0 | 1"), a + b - both);
    close(volume("0 ^ 1"), a + b - 2.0 * both);
    close(volume("0 & !1"), a - both);
    close(volume("(0 | 1) & -2"), a + b - both - volume("2"));
    // All of it has no boundary inside the domain, and neither has nothing.
    assert_eq!(solid("true", false), Boundary::default());
    assert_eq!(solid("false", false), Boundary::default());
    // Faces between chosen regions vanish.
    assert!(
        solid("0 | 1", false).births.iter().all(|&p| found.region_beside(p, true) != found.region_beside(p, false))
    );
    let inner = |p: &PolygonId| {
        [true, false].iter().all(|&front| {
            let signs = found.regions.signs_of(found.region_beside(*p, front));
            signs[0] == Sign::Positive || signs[1] == Sign::Positive
        })
    };
    assert!(!solid("0 | 1", false).births.iter().any(inner));
    let wrong = choose(&network, &found, Choice::Table(&[true])).unwrap_err();
    assert_eq!(wrong.status, Status::BadArgument);
}

/// Whole numbers in [−bound, bound] at every node.
fn random_values(random: &mut Random, functions: usize, nodes: usize, bound: i64) -> Vec<Vec<f64>> {
    (0..functions).map(|_| (0..nodes).map(|_| random.within(bound)).collect()).collect()
}

fn explicit(grid: &BoxGrid) -> (Vec<[f64; 3]>, Vec<[i32; 4]>) {
    let vertices = (0..grid.node_count()).map(|n| grid.coordinates(NodeId::of(n))).collect();
    let tets = (0..grid.tet_count()).map(|t| grid.corners(TetId::of(t)).map(|n| n.0 as i32)).collect();
    (vertices, tets)
}

#[test]
fn degenerate_boxes_against_all_cells() {
    let mut random = Random(1);
    for round in 0..rounds(60) {
        let cells = [[1, 1, 1], [2, 2, 2], [1, 3, 2], [3, 3, 3]][round % 4];
        let grid = BoxGrid::new(cells, None).unwrap();
        let bound = [1, 1, 2, 100][random.below(4) as usize];
        let n = 1 + random.below(if bound == 1 { 4 } else { 3 }) as usize;
        let mut arrays = random_values(&mut random, n, grid.node_count(), bound);
        // Mostly of one sign now and then, so that there are voids and pieces without a node.
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

/// Some of the tetrahedra of a box: rings, cavities, parts, parts that touch in edges and nodes only.
fn part(random: &mut Random, grid: &BoxGrid, percent: u64) -> TetMesh {
    let (vertices, tets) = explicit(grid);
    let tets: Vec<[i32; 4]> = tets.into_iter().filter(|_| random.below(100) < percent).collect();
    // Some turned inside out by their order.
    let tets: Vec<[i32; 4]> =
        tets.into_iter().map(|[a, b, c, d]| if random.below(2) == 0 { [b, a, c, d] } else { [c, a, b, d] }).collect();
    TetMesh::tets(vertices, &tets).unwrap()
}

#[test]
fn parts_of_boxes_against_all_cells() {
    let mut random = Random(2);
    for round in 0..rounds(60) {
        let grid = BoxGrid::new([[2, 2, 2], [3, 3, 2]][round % 2], None).unwrap();
        let percent = [100, 80, 50, 25][random.below(4) as usize];
        let mesh = part(&mut random, &grid, percent);
        let bound = [0, 1, 2, 100][random.below(4) as usize];
        let n = 1 + random.below(3) as usize;
        let arrays = random_values(&mut random, n, grid.node_count(), bound);
        for kind in KINDS {
            compare(&Domain::Mesh(mesh.clone()), &arrays, kind);
        }
    }
}

#[test]
fn many_functions_in_few_simplices() {
    let mut random = Random(4);
    let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    for (bound, tets) in
        [(100, &[[0, 1, 2, 3]][..]), (100, &[[0, 1, 2, 3], [1, 2, 3, 4]]), (3, &[[0, 1, 2, 3], [4, 1, 2, 3]])]
    {
        let domain = Domain::Mesh(TetMesh::tets(vertices.to_vec(), tets).unwrap());
        let arrays = random_values(&mut random, 14, vertices.len(), bound);
        for kind in KINDS {
            compare(&domain, &arrays, kind);
        }
    }
}

#[test]
fn triangles_against_all_cells() {
    let mut random = Random(3);
    for round in 0..rounds(100) {
        let n = 1 + round % 4;
        let node = |i: usize, j: usize| (i + (n + 1) * j) as i32;
        let vertices: Vec<[f64; 2]> =
            (0..(n + 1) * (n + 1)).map(|k| [(k % (n + 1)) as f64, (k / (n + 1)) as f64]).collect();
        let percent = [100, 70][random.below(2) as usize];
        let mut triangles = Vec::new();
        for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)];
            for triangle in [[a, b, d], [a, c, d]] {
                if random.below(100) < percent {
                    triangles.push(triangle);
                }
            }
        }
        let mesh = TetMesh::triangles(&vertices, &triangles).unwrap();
        let bound = [0, 1, 2, 100][random.below(4) as usize];
        let functions = 1 + random.below(4) as usize;
        let arrays = random_values(&mut random, functions, vertices.len(), bound);
        for kind in KINDS {
            compare(&Domain::Mesh(mesh.clone()), &arrays, kind);
        }
    }
}

/// A function of space.
type Function<'a> = &'a dyn Fn(&[f64; 3]) -> f64;

#[test]
fn planes_and_spheres_through_nodes() {
    let grid = cube(20);
    let domain = Domain::Box(grid.clone());
    let of = |functions: &[Function], kind: Kind| {
        let functions: Vec<_> = functions.iter().map(|f| move |x: &[f64; 3]| f(x)).collect();
        compare(&domain, &evaluate(&grid, &functions), kind).1
    };
    let (x, y, z) = (&|x: &[f64; 3]| x[0], &|x: &[f64; 3]| x[1], &|x: &[f64; 3]| x[2]);
    let ball = &|x: &[f64; 3]| 0.5 - (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    let (minus_x, zero) = (&|x: &[f64; 3]| -x[0], &|_: &[f64; 3]| 0.0);
    // Three planes: 12 quarters, 6 half-axes.
    let planes = of(&[x, y, z], Kind::Arrangement);
    assert_eq!(counts(&planes)[1..], [12, 6, 8, 1, 8]);
    assert_eq!(planes.chains.corners.len(), 7);
    let both = of(&[x, minus_x], Kind::Arrangement);
    assert_eq!(counts(&both)[1..], [1, 0, 2, 1, 2]);
    let both = of(&[x, minus_x], Kind::Interface);
    assert_eq!(counts(&both)[1..], [1, 0, 2, 1, 2]);
    let twice = of(&[ball, ball, zero], Kind::Arrangement);
    assert_eq!(counts(&twice)[1..], [1, 0, 2, 1, 2]);
    assert_eq!(twice.regions.signs.iter().filter(|s| s.is_zero()).count(), 2);
    assert_eq!(counts(&of(&[zero, zero], Kind::Interface)), [0, 0, 0, 0, 0, 1]);
    assert_eq!(counts(&of(&[], Kind::Arrangement)), [0, 0, 0, 0, 0, 1]);
    let apple = of(&[ball, x], Kind::Arrangement);
    assert_eq!(counts(&apple)[1..], [4, 1, 4, 1, 4]);
    assert_eq!(apple.chains.is_loop, [true]);
}

#[test]
fn a_dangling_piece_has_one_side() {
    // Zero on one square of a plane between cubes, positive elsewhere: one region on both sides.
    let grid = BoxGrid::new([3, 3, 2], None).unwrap();
    let mut values = vec![1.0; grid.node_count()];
    for (i, j) in [(1, 1), (2, 1), (1, 2), (2, 2)] {
        values[grid.node([i, j, 1]).at()] = 0.0;
    }
    let (network, found) = compare(&Domain::Box(grid), &[values], Kind::Arrangement);
    assert_eq!(network.polygon_count(), 2);
    assert_eq!(counts(&found), [5, 1, 0, 1, 1, 1]);
    assert_eq!(found.patches.one_sided.len(), 1);
}

#[test]
fn rings_and_parts() {
    // A ring of cubes around a hole, and a cube apart; the function crosses the ring twice, so there are two halves.
    let grid = BoxGrid::new([5, 3, 1], None).unwrap();
    let (vertices, tets) = explicit(&grid);
    let inside = |tet: &[i32; 4]| {
        let center = [0, 1].map(|k| tet.iter().map(|&n| vertices[n as usize][k]).sum::<f64>() / 4.0);
        let cube = center.map(|c| c.floor() as i32);
        (cube[0] < 3 && cube != [1, 1]) || cube == [4, 0]
    };
    let tets: Vec<[i32; 4]> = tets.iter().copied().filter(inside).collect();
    let mesh = TetMesh::tets(vertices.clone(), &tets).unwrap();
    let domain = Domain::Mesh(mesh);
    let value = |f: &dyn Fn(&[f64; 3]) -> f64| vec![vertices.iter().map(f).collect::<Vec<f64>>()];
    // (Through the hole, not through nodes; the cube apart is on the lower side.)
    let (_, crossed) = compare(&domain, &value(&|x| x[1] - 1.5), Kind::Arrangement);
    assert_eq!(counts(&crossed)[1..], [2, 0, 4, 2, 3]);
    // Not crossed: a ring and a cube.
    let (_, whole) = compare(&domain, &value(&|_| 1.0), Kind::Arrangement);
    assert_eq!(counts(&whole), [0, 0, 0, 0, 0, 2]);
    // Cutting off a corner of the ring and its opposite: two patches again.
    let (_, diagonal) = compare(&domain, &value(&|x| x[0] - x[1] + 0.25), Kind::Arrangement);
    assert_eq!(counts(&diagonal)[1..], [2, 0, 4, 2, 3]);
}

#[test]
fn the_order_of_functions_and_nodes_does_not_matter() {
    let mut random = Random(5);
    for round in 0..rounds(12) {
        let grid = BoxGrid::new([2, 2, 3], None).unwrap();
        let (vertices, tets) = explicit(&grid);
        let arrays = random_values(&mut random, 3, grid.node_count(), [1, 100][round % 2]);
        let mut order: Vec<usize> = (0..vertices.len()).collect();
        for i in (1..order.len()).rev() {
            order.swap(i, random.below(i as u64 + 1) as usize);
        }
        let mut to = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| to[old] = new as i32);
        let mut moved: Vec<[i32; 4]> = tets.iter().map(|t| t.map(|n| to[n as usize])).collect();
        for i in (1..moved.len()).rev() {
            moved.swap(i, random.below(i as u64 + 1) as usize);
        }
        let places = order.iter().map(|&old| vertices[old]).collect();
        let renumbered = Domain::Mesh(TetMesh::tets(places, &moved).unwrap());
        let taken: Vec<Vec<f64>> = arrays.iter().map(|a| order.iter().map(|&old| a[old]).collect()).collect();
        for kind in KINDS {
            let (_, one) = compare(&Domain::Box(grid.clone()), &arrays, kind);
            let (_, other) = compare(&renumbered, &taken, kind);
            assert_eq!(counts(&one), counts(&other));
            assert_eq!(one.chains.corners.len(), other.chains.corners.len());
            // Ties between materials go by their order.
            if kind == Kind::Arrangement {
                let turned = [arrays[2].clone(), arrays[0].clone(), arrays[1].clone()];
                let (_, turned) = compare(&Domain::Box(grid.clone()), &turned, kind);
                assert_eq!(counts(&one), counts(&turned));
                let labels = |t: &Topology, by: [usize; 3]| {
                    let mut all: Vec<Label> = (0..t.regions.len())
                        .map(|r| {
                            let label = region_label(t, kind, r);
                            by.map(|k| label[k]).to_vec()
                        })
                        .collect();
                    all.sort();
                    all
                };
                assert_eq!(labels(&one, [2, 0, 1]), labels(&turned, [0, 1, 2]));
            }
        }
    }
}

#[test]
fn threads_do_not_matter() {
    let grid = cube(40);
    let ball = |c: [f64; 3], r: f64| move |x: &[f64; 3]| r - (0..3).map(|k| (x[k] - c[k]).powi(2)).sum::<f64>().sqrt();
    let balls = [ball([0.0; 3], 0.5), ball([0.25, 0.0, 0.0], 0.5), ball([0.0, 0.3, 0.1], 0.45), ball([0.0; 3], 0.9)];
    let mut arrays = evaluate(&grid, &balls);
    arrays.push(evaluate(&grid, &[|x: &[f64; 3]| x[2]]).remove(0));
    for kind in KINDS {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| topology(&Domain::Box(grid.clone()), &arrays, kind))
        };
        let one = on(1);
        assert!(one == on(2) && one == on(8));
    }
}

/// The tied set of each region by its definition, from all cells of all simplices.
fn expected_ties(domain: &Domain, values: &Values, groups: &Grouping) -> Vec<(i32, Vec<u32>)> {
    let mut all: Vec<Option<(i32, Vec<u32>)>> = vec![None; groups.count];
    for t in 0..domain.tet_count() {
        let corners = domain.corners(TetId::of(t));
        let corners = &corners[..=domain.dim()];
        for c in groups.first[t]..groups.first[t + 1] {
            let owner = groups.labels[c][0] as u32;
            let equal =
                |f: u32| corners.iter().all(|&n| values.at(FunctionId(f), n) == values.at(FunctionId(owner), n));
            let slot = &mut all[groups.group[c] as usize];
            match slot {
                None => *slot = Some((owner as i32, (0..values.len() as u32).filter(|&f| equal(f)).collect())),
                Some((_, tied)) => tied.retain(|&f| equal(f)),
            }
        }
    }
    let mut all: Vec<_> = all.into_iter().flatten().collect();
    all.sort();
    all
}

#[test]
fn materials_that_are_equal_throughout() {
    let mut random = Random(6);
    let mut several = 0;
    for round in 0..rounds(60) {
        let grid = BoxGrid::new([[1, 1, 1], [2, 2, 2], [1, 3, 2], [3, 3, 3]][round % 4], None).unwrap();
        let percent = [100, 70][random.below(2) as usize];
        let mesh = part(&mut random, &grid, percent);
        let domain = Domain::Mesh(mesh);
        let n = 2 + random.below(2) as usize;
        let mut arrays = random_values(&mut random, n, grid.node_count(), 1);
        // A copy before or behind, and one that differs at a node or two only.
        arrays.insert(random.below(2) as usize * n, arrays[0].clone());
        let mut nearly = arrays[1].clone();
        nearly[random.below(grid.node_count() as u64) as usize] += random.within(1);
        arrays.push(nearly);
        let (network, found) = compare(&domain, &arrays, Kind::Interface);
        let functions = slices(&arrays);
        let values = Values { functions: &functions, stride: 1 };
        let ties = tied_materials(&Setting { network: &network, domain: &domain, values }, &found.regions).unwrap();
        let row = |r: usize| (found.regions.materials[r].0 as i32, ties.row(r).iter().map(|f| f.0).collect());
        let mut all: Vec<(i32, Vec<u32>)> = (0..found.regions.len()).map(row).collect();
        all.sort();
        several += all.iter().filter(|x| x.1.len() > 1).count();
        assert_eq!(all, expected_ties(&domain, &values, &grouping(&domain, &values, Kind::Interface)));
    }
    assert!(several > 20);
}

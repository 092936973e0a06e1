//! Vertices and polygons of networks on boxes and meshes: known counts, invariants, everything that may not change the result, and a plain
//! union of the complexes of all simplices.

mod common;

use common::functions::{evaluate, read_spheres, sphere_values};
use common::random::Random;
use lapidary::base::{FunctionId, NodeId, Run, TetId};
use lapidary::exact::{Sign, round_rational};
use lapidary::network::simplex::{self, FaceSupport, LocalFace, LocalFunction, LocalVertex, Scratch, SimplexComplex};
use lapidary::network::{BoxGrid, Domain, Kind, Network, TetMesh, Values, extract};
use rug::Rational;
use std::collections::BTreeMap;

const KINDS: [Kind; 2] = [Kind::Arrangement, Kind::Interface];

/// More of them with `LAPIDARY_FUZZ=n`.
fn rounds(default: usize) -> usize {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

fn cube(n: u32) -> BoxGrid {
    BoxGrid::new([n; 3], Some([[-1.0; 3], [1.0; 3]])).unwrap()
}

/// The network, checked.
fn network(domain: &Domain, arrays: &[Vec<f64>], kind: Kind) -> Network {
    let arrays: Vec<&[f64]> = arrays.iter().map(Vec::as_slice).collect();
    let values = Values { functions: &arrays, stride: 1 };
    let network = extract(domain, &values, kind, &mut Run::quiet()).unwrap();
    assert_eq!(network.check(domain, &values), Ok(()));
    network
}

/// V − E + F.
fn euler(network: &Network) -> i64 {
    let mut edges: Vec<_> = network
        .polygons
        .rows()
        .flat_map(|row| (0..row.len()).map(move |i| (row[i], row[(i + 1) % row.len()])))
        .map(|(a, b)| (a.min(b), a.max(b)))
        .collect();
    edges.sort_unstable();
    edges.dedup();
    network.vertex_count() as i64 - edges.len() as i64 + network.polygon_count() as i64
}

/// A point as its weights at nodes, exactly; weights sum to 1.
type Point = Vec<(NodeId, Rational)>;

/// The one point of the simplex of these nodes where all rows vanish, by elimination.
fn solve(nodes: &[NodeId], mut rows: Vec<Vec<Rational>>) -> Point {
    let n = nodes.len();
    rows.iter_mut().for_each(|row| row.push(Rational::new()));
    rows.push(vec![Rational::from(1); n + 1]);
    let mut rank = 0;
    for column in 0..n {
        let pivot = (rank..rows.len()).find(|&r| rows[r][column] != 0).expect("one point");
        rows.swap(rank, pivot);
        let lead = rows[rank][column].clone();
        rows[rank].iter_mut().for_each(|x| *x /= &lead);
        let pivot = rows[rank].clone();
        for row in rows.iter_mut().enumerate().filter(|(r, _)| *r != rank).map(|(_, row)| row) {
            let factor = row[column].clone();
            if factor != 0 {
                row.iter_mut().zip(&pivot).for_each(|(x, y)| *x -= Rational::from(y * &factor));
            }
        }
        rank += 1;
    }
    assert!(rows[rank..].iter().all(|row| row[n] == 0), "the rows vanish in no point");
    let mut point: Point = (0..n).map(|i| (nodes[i], rows[i][n].clone())).collect();
    point.sort();
    point
}

fn rational(x: f64) -> Rational {
    Rational::from_f64(x).unwrap()
}

/// Rows that vanish where these functions do (where these materials are equal).
fn rows(kind: Kind, arrays: &[Vec<f64>], functions: &[FunctionId], nodes: &[NodeId]) -> Vec<Vec<Rational>> {
    let of = |f: FunctionId| nodes.iter().map(|n| rational(arrays[f.at()][n.at()])).collect::<Vec<_>>();
    match kind {
        Kind::Arrangement => functions.iter().map(|&f| of(f)).collect(),
        Kind::Interface => {
            let first = of(functions[0]);
            let minus = |f: FunctionId| of(f).into_iter().zip(&first).map(|(x, y)| x - y).collect();
            functions[1..].iter().map(|&f| minus(f)).collect()
        }
    }
}

fn value(array: &[f64], point: &Point) -> Rational {
    point.iter().map(|(n, w)| rational(array[n.at()]) * w).sum()
}

/// The exact point of a vertex, which is in its open carrier, has exactly the functions that it lists, and rounds to its coordinates.
fn exact_vertex(network: &Network, domain: &Domain, arrays: &[Vec<f64>], v: usize) -> Point {
    let nodes: Vec<NodeId> = network.vertex_nodes[v].iter().copied().filter(|n| n.is_some()).collect();
    let functions = network.vertex_functions.row(v);
    let point = solve(&nodes, if nodes.len() == 1 { vec![] } else { rows(network.kind, arrays, functions, &nodes) });
    assert!(point.iter().all(|(_, w)| *w > 0), "vertex {v} is not in its open carrier");
    let at: Vec<Rational> = arrays.iter().map(|array| value(array, &point)).collect();
    let level = match network.kind {
        Kind::Arrangement => Rational::new(),
        Kind::Interface => at.iter().max().unwrap().clone(),
    };
    let expected: Vec<_> = (0..at.len()).filter(|&f| at[f] == level).map(FunctionId::of).collect();
    assert_eq!(functions, expected, "functions of vertex {v}");
    for axis in 0..3 {
        let x: Rational = point.iter().map(|(n, w)| rational(domain.coordinates(*n)[axis]) * w).sum();
        assert_eq!(network.vertices[v][axis].to_bits(), round_rational(&x).to_bits());
    }
    point
}

/// A polygon as what it is: its loop from its smallest point on, its functions with orientations, the simplices on its sides.
type Polygon = (Vec<Point>, Vec<(FunctionId, Sign)>, [TetId; 2]);

fn rotated(mut points: Vec<Point>, dim: usize) -> Vec<Point> {
    if dim == 3 {
        let least = (0..points.len()).min_by_key(|&i| &points[i]).unwrap();
        points.rotate_left(least);
    }
    points
}

fn polygons(network: &Network, domain: &Domain, arrays: &[Vec<f64>]) -> Vec<Polygon> {
    let points: Vec<Point> = (0..network.vertex_count()).map(|v| exact_vertex(network, domain, arrays, v)).collect();
    let mut all: Vec<Polygon> = (0..network.polygon_count())
        .map(|p| {
            let row = network.polygons.row(p).iter().map(|v| points[v.at()].clone()).collect();
            let set = network.set_of(p).iter().map(|item| (item.function, item.orientation)).collect();
            (rotated(row, network.dim), set, network.polygon_tets[p])
        })
        .collect();
    all.sort();
    all
}

/// A face of a simplex's complex: its loop (normal towards the positive side), the labels of its two sides.
struct Piece {
    points: Vec<Point>,
    /// IA: the signs of all functions; MI: the owner.
    labels: [Vec<Sign>; 2],
    owners: [FunctionId; 2],
    facet: Option<usize>,
}

fn pieces(domain: &Domain, arrays: &[Vec<f64>], kind: Kind, tet: TetId) -> Vec<Piece> {
    let dim = domain.dim();
    let nodes = &domain.corners(tet)[..=dim];
    let flat: Vec<f64> = arrays.iter().flat_map(|a| nodes.iter().map(|n| a[n.at()])).collect();
    let (mut scratch, mut complex) = (Scratch::default(), SimplexComplex::default());
    match kind {
        Kind::Arrangement => simplex::arrangement(dim, &flat, &mut scratch, &mut complex),
        Kind::Interface => simplex::interface(dim, &flat, &mut scratch, &mut complex),
    }
    let point = |v: LocalVertex| {
        let carrier = complex.vertex_carrier[v.at()];
        let open: Vec<NodeId> = carrier.corners().map(|c| nodes[c]).collect();
        if open.len() == 1 {
            return solve(&open, vec![]);
        }
        let functions: Vec<_> = complex.vertex_functions.row(v).iter().map(|f| FunctionId(f.0)).collect();
        solve(&open, rows(kind, arrays, &functions, &open))
    };
    (0..complex.face_count())
        .map(|f| {
            let face = LocalFace::of(f);
            let mut points: Vec<Point> = complex.face_vertices.row(face).iter().map(|&v| point(v)).collect();
            if domain.orientation(tet) == Sign::Negative {
                points.reverse();
            }
            let cells = complex.face_cells[f];
            let functions = match kind {
                Kind::Arrangement => arrays.len(),
                Kind::Interface => 0,
            };
            let label = |c: simplex::LocalCell| {
                (0..if c.is_none() { 0 } else { functions })
                    .map(|k| complex.cell_sign(c, LocalFunction::of(k)))
                    .collect()
            };
            let owner = |c: simplex::LocalCell| match kind {
                Kind::Interface if c.is_some() => FunctionId(complex.cell_owner[c.at()].0),
                _ => FunctionId::NONE,
            };
            let facet = match complex.face_support[f] {
                FaceSupport::Facet(i) => Some(i as usize),
                _ => None,
            };
            Piece { points: rotated(points, dim), labels: cells.map(label), owners: cells.map(owner), facet }
        })
        .collect()
}

/// By definition: the faces of all simplices' complexes, those on facets where the two sides differ (or a function vanishes).
fn plain_union(domain: &Domain, arrays: &[Vec<f64>], kind: Kind) -> Vec<Polygon> {
    let mut all = Vec::new();
    // Pieces of facets by their points.
    let mut open: BTreeMap<Vec<Point>, (TetId, usize, Piece)> = BTreeMap::new();
    let set_of = |points: &[Point], labels: &[Vec<Sign>; 2], owners: &[FunctionId; 2]| match kind {
        Kind::Arrangement => {
            let zero = |f: usize| points.iter().all(|p| value(&arrays[f], p) == 0);
            let one = |f: usize| !(labels[0][f].is_zero() && labels[1][f].is_zero());
            let item = |f: usize| (FunctionId::of(f), Sign::from_ordering(labels[0][f].cmp(&labels[1][f])));
            (0..arrays.len()).filter(|&f| zero(f) && one(f)).map(item).collect::<Vec<_>>()
        }
        Kind::Interface if owners[0] != owners[1] => vec![(owners[0], Sign::Positive), (owners[1], Sign::Negative)],
        Kind::Interface => vec![],
    };
    for tet in (0..domain.tet_count()).map(TetId::of) {
        for piece in pieces(domain, arrays, kind, tet) {
            if piece.facet.is_none() {
                all.push((piece.points.clone(), set_of(&piece.points, &piece.labels, &piece.owners), [tet; 2]));
                continue;
            }
            let mut key = piece.points.clone();
            key.sort();
            let Some((other, _, first)) = open.remove(&key) else {
                open.insert(key, (tet, piece.facet.unwrap(), piece));
                continue;
            };
            // Towards the inside of the lower simplex, until the rule says otherwise.
            let labels = [first.labels[0].clone(), piece.labels[0].clone()];
            let owners = [first.owners[0], piece.owners[0]];
            let mut set = set_of(&first.points, &labels, &owners);
            if set.is_empty() {
                continue;
            }
            let flipped = match kind {
                Kind::Arrangement => {
                    let first = set.iter().map(|item| item.1).find(|o| !o.is_zero());
                    first.is_none_or(|o| o == Sign::Negative)
                }
                Kind::Interface => owners[0] > owners[1],
            };
            let (mut points, mut tets) = (first.points, [other, tet]);
            if flipped {
                set.iter_mut().for_each(|item| item.1 = -item.1);
                points.reverse();
                points = rotated(points, domain.dim());
                tets.reverse();
                if kind == Kind::Interface {
                    set = vec![(owners[1], Sign::Positive), (owners[0], Sign::Negative)];
                }
            }
            all.push((points, set, tets));
        }
    }
    // What has no partner is on the boundary of the domain.
    assert!(open.values().all(|(tet, facet, _)| domain.opposite(*tet, *facet).is_none()), "pieces of a facet differ");
    all.sort();
    all
}

/// The box written out as tetrahedra, some of them turned inside out.
fn explicit(grid: &BoxGrid) -> Domain {
    let vertices = (0..grid.node_count()).map(|n| grid.coordinates(NodeId::of(n))).collect();
    let tets: Vec<[i32; 4]> = (0..grid.tet_count())
        .map(|t| {
            let mut nodes = grid.corners(TetId::of(t)).map(|n| n.0 as i32);
            if t % 3 == 1 {
                nodes.swap(t % 4, (t + 1) % 4);
            }
            nodes
        })
        .collect();
    Domain::Mesh(TetMesh::tets(vertices, &tets).unwrap())
}

fn random_signs(random: &mut Random, nodes: usize, functions: usize) -> Vec<Vec<f64>> {
    (0..functions).map(|_| (0..nodes).map(|_| random.within(1)).collect()).collect()
}

/// Every degeneracy there is, on boxes and on the same simplices written out.
#[test]
fn random_signs_agree_with_the_union_of_all_simplices() {
    let mut random = Random(1);
    let rounds = rounds(60);
    for round in 0..rounds {
        let cells = [[2, 2, 2], [1, 1, 2], [1, 1, 1], [2, 1, 1]][round % 4];
        let grid = BoxGrid::new(cells, None).unwrap();
        let functions = 1 + round % 5;
        let arrays = random_signs(&mut random, grid.node_count(), functions);
        for kind in KINDS {
            let domain = Domain::Box(grid.clone());
            let expected = plain_union(&domain, &arrays, kind);
            let found = polygons(&network(&domain, &arrays, kind), &domain, &arrays);
            assert!(found == expected, "round {round}, {kind:?}: {} and {}", found.len(), expected.len());
            let mesh = explicit(&grid);
            let found = polygons(&network(&mesh, &arrays, kind), &mesh, &arrays);
            assert!(found == plain_union(&mesh, &arrays, kind), "round {round}, {kind:?}, mesh");
        }
    }
}

/// A square of n × n cells in two triangles each, of either orientation.
fn triangles(n: usize) -> Domain {
    let node = |i: usize, j: usize| (i + (n + 1) * j) as i32;
    let vertices: Vec<[f64; 2]> =
        (0..(n + 1) * (n + 1)).map(|v| [(v % (n + 1)) as f64, (v / (n + 1)) as f64]).collect();
    let mut all = Vec::new();
    for (i, j) in (0..n * n).map(|c| (c % n, c / n)) {
        let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)];
        all.extend(if (i + j) % 2 == 0 { [[a, b, d], [a, d, c]] } else { [[a, c, b], [d, b, c]] });
    }
    Domain::Mesh(TetMesh::triangles(&vertices, &all).unwrap())
}

#[test]
fn random_signs_in_the_plane() {
    let mut random = Random(2);
    for round in 0..rounds(100) {
        let domain = triangles(1 + round % 3);
        let arrays = random_signs(&mut random, domain.node_count(), 1 + round % 6);
        for kind in KINDS {
            let found = polygons(&network(&domain, &arrays, kind), &domain, &arrays);
            assert!(found == plain_union(&domain, &arrays, kind), "round {round}, {kind:?}");
        }
    }
}

/// A file of functions, its kind, active simplices, vertices, polygons, V − E + F.
struct Known(&'static str, Kind, &'static [u64], usize, usize, i64);

#[test]
fn known_counts() {
    let known = [
        Known("ia-spheres-4", Kind::Arrangement, &[0, 166436, 5208, 67], 113984, 181737, 113984 - 295706 + 181737),
        Known("mi-spheres-4", Kind::Interface, &[0, 0, 138713, 1727], 91545, 142533, 91545 - 234078 + 142533),
        Known("ia-nested-18", Kind::Arrangement, &[0, 932164], 587822, 932164, 36),
    ];
    for Known(name, kind, active, vertices, polygons, characteristic) in known {
        let Some(path) = common::shared(&format!("data/functions/{name}.json")) else { return };
        let grid = cube(99);
        let arrays = sphere_values(&grid, &read_spheres(&path));
        let network = network(&Domain::Box(grid), &arrays, kind);
        assert_eq!(network.active, active, "{name}");
        assert_eq!((network.vertex_count(), network.polygon_count()), (vertices, polygons), "{name}");
        assert_eq!(euler(&network), characteristic, "{name}");
    }
}

/// Spheres around the center of the box and its corners, planes through nodes: zeros at nodes, on edges, on faces of tetrahedra. As functions of
/// whole numbers, so that they are what they say.
fn symmetric(grid: &BoxGrid) -> Vec<Vec<f64>> {
    let n = grid.cells()[0] as i64;
    let at = |node: usize| grid.place(NodeId::of(node)).map(|i| 2 * i as i64 - n);
    let all = |f: &dyn Fn([i64; 3]) -> i64| (0..grid.node_count()).map(|v| f(at(v)) as f64).collect();
    let r = n / 2;
    vec![
        all(&|[x, y, z]| r * r - x * x - y * y - z * z),
        all(&|[x, _, _]| x),
        all(&|[_, y, z]| y + z),
        all(&|[x, y, z]| x + y - z),
        all(&|[x, y, z]| r * r - (x - r) * (x - r) - y * y - z * z),
        all(&|[x, _, _]| -x),
        all(&|[x, y, z]| r - x.abs() - y.abs() - z.abs()),
    ]
}

#[test]
fn symmetric_functions() {
    for n in [4, 6, 20, 40, 100] {
        let grid = cube(n);
        let arrays = symmetric(&grid);
        let domain = Domain::Box(grid);
        // Alone, a sphere and an octahedron are closed, and planes are disks, whose boundary is that of the box.
        for (f, characteristic) in [(0, 2), (1, 1), (2, 1), (6, 2)] {
            let network = network(&domain, &arrays[f..=f], Kind::Arrangement);
            assert_eq!(euler(&network), characteristic, "function {f} at {n}");
        }
        // The plane x = 0 lies on faces of the grid: 2 n² triangles of nodes.
        let plane = network(&domain, &arrays[1..=1], Kind::Arrangement);
        assert_eq!(plane.polygon_count(), if n % 2 == 0 { 2 * (n * n) as usize } else { 0 });
        if n <= 40 {
            for kind in KINDS {
                network(&domain, &arrays, kind);
            }
        }
    }
    let domain = Domain::Box(cube(4));
    let Domain::Box(grid) = &domain else { unreachable!() };
    let arrays = symmetric(grid);
    for kind in KINDS {
        let found = polygons(&network(&domain, &arrays, kind), &domain, &arrays);
        assert!(found == plain_union(&domain, &arrays, kind), "{kind:?}");
    }
}

/// Functions of ordinary position on a small box.
fn waves(grid: &BoxGrid, functions: usize) -> Vec<Vec<f64>> {
    let mut random = Random(7);
    let one = |_| {
        let [a, b, c, d] = [0; 4].map(|_| 4.0 * random.signed());
        let f = move |x: &[f64; 3]| (a * x[0]).sin() + (b * x[1]).cos() + (c * x[2]).sin() - 0.1 * d;
        evaluate(grid, &[f]).remove(0)
    };
    (0..functions).map(one).collect()
}

/// Arrays for the tests of what does not matter: ordinary and degenerate.
fn samples(grid: &BoxGrid) -> [Vec<Vec<f64>>; 3] {
    [waves(grid, 5), symmetric(grid), random_signs(&mut Random(3), grid.node_count(), 4)]
}

#[test]
fn threads_do_not_matter() {
    let grid = cube(16);
    for arrays in samples(&grid) {
        for (domain, kind) in
            [(Domain::Box(grid.clone()), KINDS), (explicit(&grid), KINDS)].iter().flat_map(|(d, k)| k.map(|k| (d, k)))
        {
            let on = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| network(domain, &arrays, kind))
            };
            let one = on(1);
            assert!(one.polygon_count() > 0);
            assert!(on(2) == one && on(8) == one, "{kind:?}");
        }
    }
}

#[test]
fn strides_do_not_matter() {
    let grid = cube(6);
    let domain = Domain::Box(grid.clone());
    for arrays in samples(&grid) {
        let n = arrays.len();
        let mixed: Vec<f64> = (0..grid.node_count() * n).map(|i| arrays[i % n][i / n]).collect();
        let functions: Vec<&[f64]> = (0..n).map(|f| &mixed[f..]).collect();
        let values = Values { functions: &functions, stride: n };
        for (domain, kind) in [(&domain, KINDS), (&explicit(&grid), KINDS)].iter().flat_map(|(d, k)| k.map(|k| (*d, k)))
        {
            let found = extract(domain, &values, kind, &mut Run::quiet()).unwrap();
            assert!(found == network(domain, &arrays, kind), "{kind:?}");
        }
    }
}

#[test]
fn boxes_agree_with_their_simplices_written_out() {
    let grid = BoxGrid::new([7, 4, 5], Some([[-1.0, 0.0, 2.0], [1.0, 1.5, 2.5]])).unwrap();
    for arrays in [waves(&grid, 6), random_signs(&mut Random(5), grid.node_count(), 3)] {
        for kind in KINDS {
            let (domain, mesh) = (Domain::Box(grid.clone()), explicit(&grid));
            let (a, b) = (network(&domain, &arrays, kind), network(&mesh, &arrays, kind));
            assert_eq!(a.active, b.active);
            assert!(polygons(&a, &domain, &arrays) == polygons(&b, &mesh, &arrays), "{kind:?}");
        }
    }
}

/// A box whose nodes are mirrored along x has its cubes' parities changed if it has an even number of nodes there; with an odd number the
/// tetrahedra are mirrored, and so must be the network.
#[test]
fn mirrored_boxes_have_mirrored_networks() {
    let grid = cube(6);
    let domain = Domain::Box(grid.clone());
    for axis in 0..3 {
        let mirror = |node: NodeId| {
            let mut place = grid.place(node);
            place[axis] = grid.cells()[axis] - place[axis];
            grid.node(place)
        };
        for arrays in samples(&grid) {
            let mirrored: Vec<Vec<f64>> =
                arrays.iter().map(|a| (0..a.len()).map(|v| a[mirror(NodeId::of(v)).at()]).collect()).collect();
            for kind in KINDS {
                let (a, b) = (network(&domain, &arrays, kind), network(&domain, &mirrored, kind));
                // Loops without direction: where no sign differs, the normal depends on the numbers of the simplices.
                let plain = |network: &Network, arrays: &[Vec<f64>], mirror: &dyn Fn(NodeId) -> NodeId| {
                    let mut all: Vec<_> = polygons(network, &domain, arrays)
                        .into_iter()
                        .map(|(mut points, set, _)| {
                            points.iter_mut().for_each(|p| {
                                p.iter_mut().for_each(|(n, _)| *n = mirror(*n));
                                p.sort();
                            });
                            points.sort();
                            (points, set)
                        })
                        .collect();
                    all.sort();
                    all
                };
                assert!(plain(&a, &arrays, &mirror) == plain(&b, &mirrored, &|n| n), "axis {axis}, {kind:?}");
            }
        }
    }
}

#[test]
fn the_order_of_functions_does_not_matter() {
    let grid = cube(5);
    let domain = Domain::Box(grid.clone());
    for arrays in [waves(&grid, 5), symmetric(&grid), random_signs(&mut Random(9), grid.node_count(), 4)] {
        let n = arrays.len();
        // Function f of the permuted list is `order[f]`.
        let order: Vec<usize> = (0..n).map(|f| (f * 3 + 1) % n).collect();
        assert_eq!(order.iter().copied().collect::<std::collections::BTreeSet<_>>().len(), n);
        let permuted: Vec<Vec<f64>> = order.iter().map(|&f| arrays[f].clone()).collect();
        let (a, b) = (network(&domain, &arrays, Kind::Arrangement), network(&domain, &permuted, Kind::Arrangement));
        assert_eq!(a.active, b.active);
        let plain = |network: &Network, arrays: &[Vec<f64>], name: &dyn Fn(FunctionId) -> FunctionId| {
            let mut all: Vec<_> = polygons(network, &domain, arrays)
                .into_iter()
                .map(|(mut points, set, _)| {
                    points.sort();
                    let mut set: Vec<FunctionId> = set.iter().map(|item| name(item.0)).collect();
                    set.sort();
                    (points, set)
                })
                .collect();
            all.sort();
            all
        };
        let name = |f: FunctionId| FunctionId::of(order[f.at()]);
        assert!(plain(&a, &arrays, &|f| f) == plain(&b, &permuted, &name));
    }
    // Materials, where no two are equal at a node: nothing is tied.
    let arrays = waves(&grid, 5);
    let order = [3, 1, 4, 0, 2];
    let permuted: Vec<Vec<f64>> = order.iter().map(|&f| arrays[f].clone()).collect();
    let (a, b) = (network(&domain, &arrays, Kind::Interface), network(&domain, &permuted, Kind::Interface));
    assert_eq!(
        (a.active.clone(), a.vertex_count(), a.polygon_count()),
        (b.active.clone(), b.vertex_count(), b.polygon_count())
    );
    let sorted = |network: &Network| {
        let mut vertices = network.vertices.iter().map(|x| x.map(f64::to_bits)).collect::<Vec<_>>();
        vertices.sort();
        vertices
    };
    assert_eq!(sorted(&a), sorted(&b));
}

#[test]
fn scaling_by_powers_of_two_does_not_matter() {
    let grid = cube(8);
    let domain = Domain::Box(grid.clone());
    // Whole numbers and their like, so that nothing is lost in subnormal numbers.
    for arrays in [symmetric(&grid), random_signs(&mut Random(4), grid.node_count(), 4)] {
        for kind in KINDS {
            let one = network(&domain, &arrays, kind);
            for exponent in [-900, 900, -1060] {
                // In two steps: 2^-1060 is not a normal number.
                let (a, b) = (2f64.powi(exponent / 2), 2f64.powi(exponent - exponent / 2));
                let scaled: Vec<Vec<f64>> = arrays.iter().map(|x| x.iter().map(|v| v * a * b).collect()).collect();
                assert!(network(&domain, &scaled, kind) == one, "{kind:?}, 2^{exponent}");
            }
        }
        // Each function by its own power.
        let scaled: Vec<Vec<f64>> = arrays
            .iter()
            .enumerate()
            .map(|(f, x)| x.iter().map(|v| v * 2f64.powi(if f % 2 == 0 { 900 } else { -900 })).collect())
            .collect();
        assert!(network(&domain, &scaled, Kind::Arrangement) == network(&domain, &arrays, Kind::Arrangement));
    }
}

/// Loops from their lowest vertices on.
fn loops(network: &Network) -> Vec<Vec<u32>> {
    let rotated = |row: &[lapidary::base::VertexId]| {
        let mut row: Vec<u32> = row.iter().map(|v| v.0).collect();
        let least = (0..row.len()).min_by_key(|&i| row[i]).unwrap();
        row.rotate_left(least);
        row
    };
    network.polygons.rows().map(rotated).collect()
}

#[test]
fn equal_opposite_and_zero_functions() {
    let grid = cube(5);
    let domain = Domain::Box(grid.clone());
    let f = waves(&grid, 1).remove(0);
    let one = network(&domain, std::slice::from_ref(&f), Kind::Arrangement);
    let times = |k: f64| f.iter().map(|x| k * x).collect::<Vec<f64>>();
    let many = network(&domain, &[f.clone(), f.clone(), times(-1.0), times(2.0), times(0.0)], Kind::Arrangement);
    // Loops may start elsewhere.
    assert!(loops(&one) == loops(&many) && one.vertices == many.vertices);
    assert_eq!(many.sets.len(), 1);
    let orientations: Vec<_> =
        many.sets.row(0usize).iter().map(|item| (item.function.0, item.orientation.to_i8())).collect();
    assert_eq!(orientations, [(0, 1), (1, 1), (2, -1), (3, 1)]);
    assert!(many.vertex_functions.rows().all(|row| row.len() == 5));
    // Equal materials: the lowest owns everything; two that cross, one of them twice, have the interface of the two.
    let equal = network(&domain, &[f.clone(), f.clone()], Kind::Interface);
    assert_eq!((equal.polygon_count(), equal.vertex_count()), (0, 0));
    let twice = network(&domain, &[times(0.0), f.clone(), f.clone()], Kind::Interface);
    let once = network(&domain, &[times(0.0), f.clone()], Kind::Interface);
    assert!(loops(&twice) == loops(&once) && twice.sets == once.sets);
    assert!(once.vertices == one.vertices);
    // No functions, one material.
    for (arrays, kind) in [(vec![], Kind::Arrangement), (vec![f.clone()], Kind::Interface)] {
        assert_eq!(network(&domain, &arrays, kind).vertex_count(), 0);
    }
}

#[test]
fn bad_values_are_named() {
    let grid = cube(3);
    let mut arrays = waves(&grid, 3);
    arrays[1][17] = f64::NAN;
    arrays[2][5] = f64::INFINITY;
    for (domain, kind) in
        [(Domain::Box(grid.clone()), KINDS), (explicit(&grid), KINDS)].iter().flat_map(|(d, k)| k.map(|k| (d, k)))
    {
        let try_it = |arrays: &[Vec<f64>], stride: usize| {
            let functions: Vec<&[f64]> = arrays.iter().map(Vec::as_slice).collect();
            extract(domain, &Values { functions: &functions, stride }, kind, &mut Run::quiet())
        };
        let message = try_it(&arrays, 1).unwrap_err().message;
        assert!(
            message.contains("function 1") && message.contains("17") || message.contains("function 2"),
            "{message}"
        );
        assert!(try_it(&[vec![0.0; 63]], 1).is_err());
        assert!(try_it(&[vec![0.0; 64]], 2).is_err());
        assert!(try_it(&[vec![0.0; 64]], 0).is_err());
    }
    let domain = Domain::Box(grid);
    assert!(extract(&domain, &Values { functions: &[], stride: 1 }, Kind::Interface, &mut Run::quiet()).is_err());
}

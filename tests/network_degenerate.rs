//! What breaks networks elsewhere, with all that follows from polygons: ties, level sets made of faces of tetrahedra, values at the ends of the range,
//! curves along edges of the domain, equal and opposite functions. (Rings and parts: `network_topology`, `network_volumes`; single
//! simplices: `network_simplex`, `network_brute_force`.)

mod common;

use common::functions::evaluate;
use lapidary::base::{CellId, EdgeId, RegionId, Run};
use lapidary::complex::exact_values::{cell_values, cell_volume};
use lapidary::complex::{Complex, check};
use lapidary::network::carrier::{edge_carrier, node_count};
use lapidary::network::local::Setting;
use lapidary::network::regions::Method;
use lapidary::network::ties::tied_materials;
use lapidary::network::topology::{Topology, find_topology};
use lapidary::network::volumes::volumes;
use lapidary::network::{BoxGrid, Domain, Kind, Network, TetMesh, Values, extract};
use rug::Rational;

const KINDS: [Kind; 2] = [Kind::Arrangement, Kind::Interface];
const SIZES: [u32; 3] = [20, 40, 100];

/// A network of arrays on a domain, what it forms by both methods, and its volumes if wanted; everything checked.
struct Found {
    network: Network,
    topology: Topology,
    complex: Option<Complex>,
    ties: Vec<Vec<u32>>,
}

fn find(domain: &Domain, arrays: &[Vec<f64>], kind: Kind, with_volumes: bool) -> Found {
    let functions: Vec<&[f64]> = arrays.iter().map(Vec::as_slice).collect();
    let values = Values { functions: &functions, stride: 1 };
    let run = &mut Run::quiet();
    let network = extract(domain, &values, kind, run).unwrap();
    network.check(domain, &values).unwrap();
    let setting = Setting { network: &network, domain, values };
    let topology = find_topology(&setting, Method::Automatic, run).unwrap();
    topology.check(&setting).unwrap();
    let classes = find_topology(&setting, Method::Classes, run).unwrap().regions;
    let regions = &topology.regions;
    assert!(regions.of_shell == classes.of_shell && regions.signs == classes.signs);
    assert!(regions.materials == classes.materials);
    let complex = with_volumes.then(|| {
        let complex = volumes(&setting, &topology, run).unwrap();
        check(&complex).unwrap();
        complex
    });
    let ties = match kind {
        Kind::Arrangement => Vec::new(),
        Kind::Interface => {
            let ties = tied_materials(&setting, regions).unwrap();
            ties.rows().map(|row| row.iter().map(|f| f.0).collect()).collect()
        }
    };
    Found { network, topology, complex, ties }
}

impl Found {
    /// Patches, chains, shells, components, regions, corners.
    fn counts(&self) -> [usize; 6] {
        let t = &self.topology;
        let components = t.patches.component_count;
        [t.patches.len(), t.chains.len(), t.shells.len(), components, t.regions.len(), t.chains.corners.len()]
    }

    fn label(&self, r: usize) -> Vec<i32> {
        match self.network.kind {
            Kind::Arrangement => {
                self.topology.regions.signs_of(RegionId::of(r)).iter().map(|s| s.to_i8() as i32).collect()
            }
            Kind::Interface => vec![self.topology.regions.materials[r].0 as i32],
        }
    }

    fn labels(&self) -> Vec<Vec<i32>> {
        let mut all: Vec<_> = (0..self.topology.regions.len()).map(|r| self.label(r)).collect();
        all.sort();
        all
    }

    /// How many nodes the edges along chains have behind them: 2 on edges of the domain, 3 on faces, 4 inside.
    fn chain_carriers(&self) -> [usize; 5] {
        let mut counts = [0; 5];
        for &e in &self.topology.chains.edges.items {
            let [u, v] = self.topology.edges.ends_of(EdgeId(e.0));
            counts[node_count(&edge_carrier(&self.network, u, v))] += 1;
        }
        counts
    }

    /// Exact volume and the side of the centroid along an axis.
    fn half(&self, r: usize, axis: usize) -> (Rational, i32) {
        let (volume, centroid) = cell_values(self.complex.as_ref().unwrap(), CellId::of(r));
        (volume, centroid[axis].cmp0() as i32)
    }
}

fn cube(n: u32) -> (BoxGrid, Domain) {
    let grid = BoxGrid::new([n; 3], Some([[-1.0; 3], [1.0; 3]])).unwrap();
    (grid.clone(), Domain::Box(grid))
}

/// Whole numbers: twice the steps from the middle, so that functions are what they say.
fn whole(grid: &BoxGrid, f: impl Fn([i64; 3]) -> i64) -> Vec<f64> {
    let n = grid.cells()[0] as i64;
    let at = |node: usize| grid.place(lapidary::base::NodeId::of(node)).map(|i| 2 * i as i64 - n);
    (0..grid.node_count()).map(|node| f(at(node)) as f64).collect()
}

fn signs(n: usize) -> Vec<Vec<i32>> {
    let mut all: Vec<Vec<i32>> =
        (0..1 << n).map(|k: i32| (0..n).map(|f| if k >> f & 1 == 1 { 1 } else { -1 }).collect()).collect();
    all.sort();
    all
}

#[test]
fn five_materials_in_any_order() {
    let rows = [[1., 1., 0., -1.], [1., 0., 0., 0.], [1., -1., 0., 1.], [0., 1., 0., 1.], [1., 1., 1., 1.]];
    let places = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let domain = Domain::Mesh(TetMesh::tets(places, &[[0, 1, 2, 3]]).unwrap());
    let mut orders = vec![vec![]];
    for k in 0..5 {
        let insert = |order: &Vec<usize>, at: usize| {
            let mut order = order.clone();
            order.insert(at, k);
            order
        };
        orders = orders.iter().flat_map(|order| (0..=k).map(move |at| insert(order, at))).collect();
    }
    assert_eq!(orders.len(), 120);
    for order in orders {
        let arrays: Vec<Vec<f64>> = order.iter().map(|&k| rows[k].to_vec()).collect();
        let found = find(&domain, &arrays, Kind::Interface, true);
        let largest = order.iter().position(|&k| k == 4).unwrap() as u32;
        assert_eq!(found.counts(), [0, 0, 0, 0, 1, 0]);
        assert_eq!((found.labels(), &found.ties), (vec![vec![largest as i32]], &vec![vec![largest]]));
        let c = found.complex.unwrap();
        assert_eq!((c.cell_count(), c.face_count(), c.vertex_count()), (1, 4, 4));
        assert_eq!(cell_volume(&c, CellId(0)), Rational::from((1, 6)));
    }
}

#[test]
fn values_scaled_by_2_to_900() {
    let (grid, domain) = cube(12);
    let ball = |c: [f64; 3], r: f64| move |x: &[f64; 3]| r - (0..3).map(|k| (x[k] - c[k]).powi(2)).sum::<f64>().sqrt();
    let balls = [ball([0.0; 3], 0.5), ball([0.5, 0.0, 0.0], 0.5), ball([0.0, 0.3, 0.1], 0.45), ball([0.1; 3], 0.9)];
    let symmetric = vec![
        whole(&grid, |[x, y, z]| 100 - x * x - y * y - z * z),
        whole(&grid, |[x, _, _]| x),
        whole(&grid, |[x, y, z]| x + y - z),
        whole(&grid, |[x, y, z]| 6 - x.abs() - y.abs() - z.abs()),
    ];
    for arrays in [evaluate(&grid, &balls), symmetric] {
        for kind in KINDS {
            let one = find(&domain, &arrays, kind, false);
            for power in [900, -900] {
                let scaled: Vec<Vec<f64>> =
                    arrays.iter().map(|x| x.iter().map(|v| v * 2f64.powi(power)).collect()).collect();
                let other = find(&domain, &scaled, kind, false);
                assert!(one.network == other.network && one.topology == other.topology, "{kind:?}, 2^{power}");
            }
        }
        // Functions of an arrangement each by its own.
        let mixed: Vec<Vec<f64>> = (arrays.iter().enumerate())
            .map(|(f, x)| x.iter().map(|v| v * 2f64.powi(if f % 2 == 0 { 900 } else { -900 })).collect())
            .collect();
        let [one, other] = [&arrays, &mixed].map(|arrays| find(&domain, arrays, Kind::Arrangement, false));
        assert!(one.network == other.network && one.topology == other.topology);
    }
}

#[test]
fn axis_planes_are_faces_of_tetrahedra() {
    for n in SIZES {
        let (grid, domain) = cube(n);
        let [x, y, z] = [0, 1, 2].map(|axis| whole(&grid, |place| place[axis]));
        let found = find(&domain, &[x.clone(), y, z], Kind::Arrangement, n == 20);
        assert_eq!(found.counts(), [12, 6, 8, 1, 8, 7]);
        assert_eq!(found.labels(), signs(3));
        assert_eq!(found.network.polygon_count(), 3 * 2 * (n * n) as usize);
        // The axes are edges of the grid.
        assert_eq!(found.chain_carriers(), [0, 0, 3 * n as usize, 0, 0]);
        if let Some(complex) = &found.complex {
            assert!((0..8).all(|k| cell_volume(complex, CellId(k)) == 1));
        }
        // The plane x and its opposite: one plane, two halves, each where it says.
        let minus = whole(&grid, |[x, _, _]| -x);
        for kind in KINDS {
            let both = find(&domain, &[x.clone(), minus.clone()], kind, n == 20);
            assert_eq!(both.counts(), [1, 0, 2, 1, 2, 0]);
            assert_eq!(both.network.polygon_count(), 2 * (n * n) as usize);
            let expected = match kind {
                Kind::Arrangement => vec![vec![-1, 1], vec![1, -1]],
                Kind::Interface => vec![vec![0], vec![1]],
            };
            assert_eq!(both.labels(), expected);
            for r in (0..2).filter(|_| both.complex.is_some()) {
                let side = match kind {
                    Kind::Arrangement => both.label(r)[0],
                    Kind::Interface => 1 - 2 * both.label(r)[0],
                };
                assert_eq!(both.half(r, 0), (Rational::from(4), side));
            }
        }
    }
}

#[test]
fn symmetric_spheres_through_nodes() {
    for n in SIZES {
        let (grid, domain) = cube(n);
        let r = n as i64 / 2;
        let sphere = whole(&grid, |[x, y, z]| r * r - x * x - y * y - z * z);
        let octahedron = whole(&grid, |[x, y, z]| r - x.abs() - y.abs() - z.abs());
        let zero = vec![0.0; grid.node_count()];
        for f in [&sphere, &octahedron] {
            let alone = find(&domain, std::slice::from_ref(f), Kind::Arrangement, n == 20);
            assert_eq!(alone.counts(), [1, 0, 2, 1, 2, 0]);
            assert_eq!(alone.labels(), signs(1));
            // With a function that is zero everywhere: the same surface, and labels with zeros.
            let with_zero = find(&domain, &[zero.clone(), f.clone()], Kind::Arrangement, false);
            assert_eq!(with_zero.network.polygon_count(), alone.network.polygon_count());
            assert_eq!(with_zero.labels(), [[0, -1], [0, 1]]);
            // As a material against zero.
            let material = find(&domain, &[zero.clone(), f.clone()], Kind::Interface, false);
            assert_eq!((material.counts(), material.labels()), (alone.counts(), vec![vec![0], vec![1]]));
            assert_eq!(material.network.vertices, alone.network.vertices);
        }
        // The octahedron is inside of the sphere and touches it at six nodes, where both have their tips.
        let both = find(&domain, &[sphere.clone(), octahedron], Kind::Arrangement, n == 20);
        assert_eq!(both.topology.regions.len(), 3);
        assert_eq!(both.labels(), [[-1, -1], [1, -1], [1, 1]]);
        assert_eq!(both.topology.patches.component_count, 1);
        let halves = find(&domain, &[sphere, whole(&grid, |[x, _, _]| x)], Kind::Arrangement, false);
        assert_eq!(halves.counts(), [4, 1, 4, 1, 4, 0]);
        assert_eq!(halves.labels(), signs(2));
        assert_eq!(halves.topology.chains.is_loop, [true]);
    }
}

#[test]
fn a_function_that_is_zero_everywhere() {
    for n in SIZES {
        let (grid, domain) = cube(n);
        let zero = vec![0.0; grid.node_count()];
        let alone = find(&domain, std::slice::from_ref(&zero), Kind::Arrangement, n == 20);
        assert_eq!((alone.counts(), alone.labels()), ([0, 0, 0, 0, 1, 0], vec![vec![0]]));
        assert!(alone.complex.is_none_or(|c| cell_volume(&c, CellId(0)) == 8));
        let twice = find(&domain, &[zero.clone(), zero.clone()], Kind::Interface, false);
        assert_eq!((twice.counts(), twice.labels()), ([0, 0, 0, 0, 1, 0], vec![vec![0]]));
        assert_eq!(twice.ties, [[0, 1]]);
    }
    // Zero on one half only: its label there, and the faces between.
    let (grid, domain) = cube(20);
    let half = whole(&grid, |[x, _, _]| x.max(0));
    let found = find(&domain, &[half], Kind::Arrangement, true);
    assert_eq!((found.counts(), found.labels()), ([1, 0, 2, 1, 2, 0], vec![vec![0], vec![1]]));
    assert_eq!(found.network.polygon_count(), 800);
    (0..2).for_each(|r| assert_eq!(found.half(r, 0), (Rational::from(4), 2 * found.label(r)[0] - 1)));
}

#[test]
fn curves_on_edges_and_faces_of_tetrahedra() {
    for n in [6, 20] {
        let (grid, domain) = cube(n);
        let edges = n as usize;
        // Two planes that meet in the z axis.
        let (x, y) = (whole(&grid, |[x, _, _]| x), whole(&grid, |[_, y, _]| y));
        let found = find(&domain, &[x.clone(), y.clone()], Kind::Arrangement, true);
        assert_eq!((found.counts(), found.labels()), ([4, 1, 4, 1, 4, 2], signs(2)));
        assert_eq!(found.chain_carriers(), [0, 0, edges, 0, 0]);
        // Three materials around it.
        let zero = vec![0.0; grid.node_count()];
        let found = find(&domain, &[zero, x.clone(), y], Kind::Interface, true);
        assert_eq!((found.counts(), found.labels()), ([3, 1, 3, 1, 3, 2], vec![vec![0], vec![1], vec![2]]));
        assert_eq!(found.chain_carriers(), [0, 0, edges, 0, 0]);
        // A plane of faces crossed askew: the curve runs over the faces.
        let askew = whole(&grid, |[_, y, z]| 7 * y + 2 * z + 1);
        let found = find(&domain, &[x, askew], Kind::Arrangement, true);
        assert_eq!((found.counts(), found.labels()), ([4, 1, 4, 1, 4, 2], signs(2)));
        let [.., on_edges, on_faces, inside] = found.chain_carriers();
        assert!(on_faces >= edges && on_edges == 0 && inside == 0);
    }
}

#[test]
fn equal_and_opposite_functions() {
    for n in [7, 20] {
        let (grid, domain) = cube(n);
        let ball = |x: &[f64; 3]| 0.61 - ((x[0] - 0.1).powi(2) + x[1] * x[1] + x[2] * x[2]).sqrt();
        let f = evaluate(&grid, &[ball]).remove(0);
        let minus: Vec<f64> = f.iter().map(|x| -x).collect();
        let alone = find(&domain, std::slice::from_ref(&f), Kind::Arrangement, true);
        let volume = |found: &Found, label: &[i32]| {
            let r = (0..found.topology.regions.len()).find(|&r| found.label(r) == label).expect("a region");
            found.half(r, 0).0
        };
        let (inner, outer) = (volume(&alone, &[1]), volume(&alone, &[-1]));
        assert!(inner < 1 && outer > 7);
        let equal = find(&domain, &[f.clone(), f.clone()], Kind::Arrangement, true);
        assert_eq!((equal.counts(), equal.labels()), ([1, 0, 2, 1, 2, 0], vec![vec![-1, -1], vec![1, 1]]));
        assert!(volume(&equal, &[1, 1]) == inner && volume(&equal, &[-1, -1]) == outer);
        let opposite = find(&domain, &[f.clone(), minus.clone()], Kind::Arrangement, true);
        assert_eq!((opposite.counts(), opposite.labels()), ([1, 0, 2, 1, 2, 0], vec![vec![-1, 1], vec![1, -1]]));
        assert!(volume(&opposite, &[1, -1]) == inner && volume(&opposite, &[-1, 1]) == outer);
        // Of equal materials the lowest owns all.
        let equal = find(&domain, &[f.clone(), f.clone()], Kind::Interface, true);
        assert_eq!((equal.counts(), equal.labels()), ([0, 0, 0, 0, 1, 0], vec![vec![0]]));
        assert_eq!(equal.ties, [[0, 1]]);
        let opposite = find(&domain, &[f.clone(), minus.clone(), f.clone()], Kind::Interface, true);
        assert_eq!((opposite.counts(), opposite.labels()), ([1, 0, 2, 1, 2, 0], vec![vec![0], vec![1]]));
        assert!(volume(&opposite, &[0]) == inner && volume(&opposite, &[1]) == outer);
        let mut ties = opposite.ties.clone();
        ties.sort();
        assert_eq!(ties, [vec![0, 2], vec![1]]);
    }
}

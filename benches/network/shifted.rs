//! Table 2 of the networks paper: four spheres on a grid of 100³ nodes over [−1, 1]³, each shifted from the one before by ε in one random direction;
//! for interfaces a fifth function that is zero everywhere. Every input is built twice, with the functions in two orders.
//!
//! Exact signs: the library's own network, its regions and their labels, compared as a whole (polygons by the bits of their corners and the functions
//! that they lie on). Signs in doubles (feature `plain-signs`): the complex of every simplex that more than one function or material may
//! divide, as in Table 1; a type II failure in one simplex is one of the input, else a type I failure. Prints Markdown; fails if exact signs are not
//! consistent every time.

use super::degeneracies::{Builder, Random, outcome, print_row, variants};
use super::grid::functions::{Sphere, sphere_values};
use lapidary::base::{Run, TetId};
use lapidary::network::local::Setting;
use lapidary::network::regions::Method;
use lapidary::network::simplex::Kind;
use lapidary::network::topology::find_topology;
use lapidary::network::{BoxGrid, Domain, Values, extract};
use std::panic::set_hook;

const STEPS: [(f64, &str); 4] = [(1e-7, "1e-7"), (4e-7, "4e-7"), (7e-7, "7e-7"), (1e-6, "1e-6")];

/// Values at the nodes, one array per function.
fn input(r: &mut Random, grid: &BoxGrid, kind: Kind, step: f64) -> Vec<Vec<f64>> {
    let direction = loop {
        let d: [f64; 3] = std::array::from_fn(|_| r.signed());
        let square: f64 = d.iter().map(|x| x * x).sum();
        if square > 0.01 && square < 1.0 {
            break d.map(|x| x / square.sqrt());
        }
    };
    let center: [f64; 3] = std::array::from_fn(|_| 0.1 * r.signed());
    let sphere =
        |i: usize| Sphere { center: std::array::from_fn(|k| center[k] + i as f64 * step * direction[k]), radius: 0.5 };
    let spheres: Vec<Sphere> = (0..4).map(sphere).collect();
    let mut values = sphere_values(grid, &spheres);
    if kind == Kind::Interface {
        values.push(vec![0.0; grid.node_count()]);
    }
    values
}

/// A network and its regions in a form that does not depend on the order of the functions.
#[derive(PartialEq)]
struct Whole {
    /// Corners and functions, sorted.
    polygons: Vec<(Vec<[u64; 3]>, Vec<usize>)>,
    patches: usize,
    chains: usize,
    /// Signs of the functions, or the material, sorted.
    labels: Vec<Vec<i32>>,
}

fn whole(domain: &Domain, values: &[Vec<f64>], kind: Kind, order: &[usize]) -> Option<Whole> {
    let arrays: Vec<&[f64]> = order.iter().map(|&f| values[f].as_slice()).collect();
    let values = Values { functions: &arrays, stride: 1 };
    let network = extract(domain, &values, kind, &mut Run::quiet()).ok()?;
    let setting = Setting { network: &network, domain, values };
    let topology = find_topology(&setting, Method::Automatic, &mut Run::quiet()).ok()?;
    topology.check(&setting).ok()?;
    let polygon = |p: usize| {
        let mut corners: Vec<_> =
            network.polygons.row(p).iter().map(|v| network.vertices[v.at()].map(f64::to_bits)).collect();
        corners.sort_unstable();
        let mut set: Vec<usize> = network.set_of(p).iter().map(|item| order[item.function.at()]).collect();
        set.sort_unstable();
        (corners, set)
    };
    let mut polygons: Vec<_> = (0..network.polygon_count()).map(polygon).collect();
    polygons.sort_unstable();
    let regions = &topology.regions;
    let mut labels: Vec<Vec<i32>> = match kind {
        Kind::Interface => regions.materials.iter().map(|m| vec![order[m.at()] as i32]).collect(),
        Kind::Arrangement => regions
            .signs
            .chunks(order.len())
            .map(|signs| {
                let mut label = vec![0; order.len()];
                signs.iter().zip(order).for_each(|(s, &f)| label[f] = s.to_i8().into());
                label
            })
            .collect(),
    };
    labels.sort_unstable();
    Some(Whole { polygons, patches: topology.patches.len(), chains: topology.chains.len(), labels })
}

/// The outcome with signs in doubles: that of the worst simplex.
fn by_simplices(
    builder: &mut Builder,
    domain: &Domain,
    values: &[Vec<f64>],
    kind: Kind,
    orders: &[Vec<usize>; 2],
) -> usize {
    let mut worst = 0;
    for t in (0..domain.tet_count()).map(TetId::of) {
        let nodes = domain.corners(t);
        let at = |f: usize| -> [f64; 4] { std::array::from_fn(|c| values[f][nodes[c].at()]) };
        let all: Vec<[f64; 4]> = (0..values.len()).map(at).collect();
        let divided = match kind {
            Kind::Arrangement => {
                all.iter().filter(|v| v.iter().any(|x| *x > 0.0) && v.iter().any(|x| *x < 0.0)).count() > 1
            }
            Kind::Interface => {
                let largest =
                    |c: usize| (0..all.len()).fold(0, |best, f| if all[f][c] > all[best][c] { f } else { best });
                (1..4).any(|c| largest(c) != largest(0))
            }
        };
        if divided {
            let both = [0, 1].map(|i| builder.structure(kind, &all, &orders[i]));
            worst = worst.max(outcome(&both));
            if worst == 2 {
                break;
            }
        }
    }
    worst
}

pub fn main(arguments: &[String]) {
    let count = arguments.first().map_or(100, |n| n.parse().expect("a number of inputs"));
    let cubes = arguments.get(1).map_or(99, |n| n.parse().expect("a number of cubes along an axis"));
    set_hook(Box::new(|_| ()));
    let domain = Domain::Box(BoxGrid::new([cubes; 3], Some([[-1.0; 3], [1.0; 3]])).expect("a box"));
    let Domain::Box(grid) = &domain else { return };
    println!("| shift | signs | success | type I | type II |\n|---|---|---:|---:|---:|");
    let mut consistent = true;
    for (kind, name) in [(Kind::Arrangement, "IA"), (Kind::Interface, "MI")] {
        for &plain in variants() {
            for (step, what) in STEPS {
                let mut counts = [0; 3];
                for i in 0..count {
                    let mut r = Random((kind as u64) << 36 | i as u64);
                    let values = input(&mut r, grid, kind, step);
                    let forward: Vec<usize> = (0..values.len()).collect();
                    let orders = [forward.clone(), forward.into_iter().rev().collect()];
                    counts[match plain {
                        false => outcome(&[0, 1].map(|i| whole(&domain, &values, kind, &orders[i]))),
                        true => by_simplices(&mut Builder::new(true), &domain, &values, kind, &orders),
                    }] += 1;
                }
                print_row(&format!("{name} {what}"), plain, counts);
                consistent &= plain || counts[0] == count;
            }
        }
    }
    assert!(consistent, "exact signs that are not consistent");
}

//! The exact coordinates of a vertex, on demand, as rationals.
//!
//! On the open sub-simplex that carries it a vertex is where a function or more are zero (of an interface: where materials are equal). Its
//! barycentric coordinates are the null vector of their values there: Gaussian elimination over all functions that the vertex
//! lists, of which some may depend on others. It is unique, since otherwise the vertex would not be a point, and its sum is not zero.
//! Cost: some microseconds.

use super::data::{Network, Values};
use super::domain::Domain;
use super::simplex::Kind;
use crate::base::{FunctionId, VertexId};
use rug::Rational;

/// Only values that were found to be finite are converted.
fn of(x: f64) -> Rational {
    Rational::from_f64(x).unwrap_or_default()
}

/// x, y, z; the values are those that the network was made of.
pub fn exact_vertex(network: &Network, domain: &Domain, values: &Values, v: VertexId) -> [Rational; 3] {
    let nodes = network.vertex_nodes[v.at()];
    let count = nodes.iter().filter(|n| n.is_some()).count();
    let row = |f: FunctionId| nodes[..count].iter().map(|&n| of(values.at(f, n))).collect::<Vec<_>>();
    let functions = network.vertex_functions.row(v);
    let mut forms: Vec<Vec<Rational>> = match network.kind {
        Kind::Arrangement => functions.iter().map(|&f| row(f)).collect(),
        Kind::Interface => {
            let first = row(functions[0]);
            let difference = |f: FunctionId| row(f).iter().zip(&first).map(|(a, b)| Rational::from(a - b)).collect();
            functions[1..].iter().map(|&f| difference(f)).collect()
        }
    };
    // Reduced row echelon form; one column is left without a pivot.
    let mut pivots = Vec::new();
    let mut free = count - 1;
    for column in 0..count {
        let rank = pivots.len();
        match (rank..forms.len()).find(|&r| !forms[r][column].is_zero()) {
            Some(at) => {
                forms.swap(rank, at);
                let pivot = forms[rank][column].clone();
                forms[rank].iter_mut().for_each(|x| *x /= &pivot);
                let row = forms[rank].clone();
                for (_, other) in forms.iter_mut().enumerate().filter(|(r, _)| *r != rank) {
                    let factor = other[column].clone();
                    other.iter_mut().zip(&row).for_each(|(x, y)| *x -= Rational::from(&factor * y));
                }
                pivots.push(column);
            }
            None => free = column,
        }
    }
    let mut weights = vec![Rational::new(); count];
    weights[free] = Rational::from(1);
    for (r, &column) in pivots.iter().enumerate() {
        weights[column] = Rational::from(-&forms[r][free]);
    }
    let sum = weights.iter().fold(Rational::new(), |sum, w| sum + w);
    let mut point: [Rational; 3] = Default::default();
    for (weight, &node) in weights.iter().zip(&nodes[..count]) {
        for (to, x) in point.iter_mut().zip(domain.coordinates(node)) {
            *to += weight * of(x) / &sum;
        }
    }
    point
}

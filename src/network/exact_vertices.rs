//! The exact place of a vertex, on demand: as a symbolic point, and as rationals.
//!
//! On the open sub-simplex that carries it a vertex is where a function or more are zero (of an interface: where materials are equal). It lists all
//! of them, of which some may depend on others; as many as its carrier has dimensions are independent there, and fix it: the
//! first such, greedily.
//! Cost: next to nothing where no function is dependent, else some microseconds.

use super::data::{Network, Values};
use super::domain::Domain;
use super::simplex::Kind;
use crate::base::{FunctionId, VertexId};
use crate::exact::{self, Linear, Zero};
use rug::Rational;

/// The place of a vertex; the values are those that the network was made of.
pub fn symbolic_vertex(network: &Network, domain: &Domain, values: &Values, v: VertexId) -> Zero {
    let nodes = network.vertex_nodes[v.at()];
    let count = nodes.iter().filter(|n| n.is_some()).count();
    let mut zero = Zero { dim: count as u32 - 1, ..Zero::default() };
    for (corner, &node) in zero.corners.iter_mut().zip(&nodes[..count]) {
        *corner = domain.coordinates(node);
    }
    let row =
        |f: FunctionId| -> [f64; 4] { std::array::from_fn(|k| if k < count { values.at(f, nodes[k]) } else { 0.0 }) };
    let functions = network.vertex_functions.row(v);
    let forms = match network.kind {
        Kind::Arrangement => functions,
        Kind::Interface => &functions[1..],
    };
    let second = match network.kind {
        Kind::Arrangement => [0.0; 4],
        Kind::Interface => row(functions[0]),
    };
    let mut found = 0;
    let mut reduced: Vec<Vec<Rational>> = Vec::new();
    for &f in forms {
        if found + 1 == count {
            break;
        }
        let form = Linear { first: row(f), second };
        if forms.len() + 1 == count || independent(&form, count, &mut reduced) {
            zero.functions[found] = form;
            found += 1;
        }
    }
    zero
}

/// Whether a form does not depend on those that were taken, which are in echelon form; if so it is taken.
fn independent(form: &Linear, count: usize, reduced: &mut Vec<Vec<Rational>>) -> bool {
    // Only values that were found to be finite are converted.
    let of = |x: f64| Rational::from_f64(x).unwrap_or_default();
    let mut row: Vec<Rational> = (0..count).map(|k| of(form.first[k]) - of(form.second[k])).collect();
    let lead = |row: &[Rational]| row.iter().position(|x| !x.is_zero());
    for other in reduced.iter() {
        let at = lead(other).expect("only rows that are not zero are taken");
        let factor = Rational::from(&row[at] / &other[at]);
        row.iter_mut().zip(other).for_each(|(x, y)| *x -= Rational::from(&factor * y));
    }
    let taken = lead(&row).is_some();
    if taken {
        reduced.push(row);
    }
    taken
}

/// x, y, z; the values are those that the network was made of.
pub fn exact_vertex(network: &Network, domain: &Domain, values: &Values, v: VertexId) -> [Rational; 3] {
    exact::rational(&symbolic_vertex(network, domain, values, v))
}

//! Points of the network on open edges of the domain: where functions change sign (IA), where the largest material changes (MI).
//!
//! Invariant: the points of an edge are in order from its lower node to its higher one, and different; each has *all* functions that vanish
//! (all materials that are largest) there, those included that do so on the whole edge. So every simplex that has the edge finds its own
//! functions in them, and nothing depends on which simplex looked first (DESIGN §11, "Stitching tets").
//!
//! Degenerate cases: zeros at nodes belong to the nodes; equal zeros of several functions are one point, found by exact comparison. Cost: one comparison for each
//! two functions that cross one edge; one rounding per point.

use super::data::Values;
use super::simplex::Kind;
use crate::base::parallel::Writer;
use crate::base::{Csr, FunctionId, NodeId};
use crate::exact::{OnEdge, Row, compare_zeros, round_symbolic};
use std::cmp::Ordering;

/// Where the points on edges come from once they are counted: parts of consecutive ids, written one by one into the arrays of all vertices.
pub trait EdgePoints: Sync {
    /// All functions (materials) of each point.
    fn functions(&self) -> &Csr<FunctionId>;
    fn take_functions(&mut self) -> Csr<FunctionId>;
    /// The number of points in each part.
    fn lengths(&self) -> Vec<usize>;
    /// Calls `visit` for the edges of a part with the number of their points, in the order of ids.
    fn edges(&self, part: usize, visit: impl FnMut(&Edge, u32));
}

/// Correctly rounded coordinates of the points of a part.
pub fn write_places<P: EdgePoints>(
    kind: Kind,
    values: &Values,
    points: &P,
    functions: &Csr<FunctionId>,
    (part, first): (usize, usize),
    out: &mut Writer<[f64; 3]>,
) {
    let mut v = first;
    points.edges(part, |edge, count| {
        for _ in 0..count {
            out.push(place(kind, values, edge, functions.row(v)));
            v += 1;
        }
    });
}

/// The point of an edge where these functions vanish (materials are equal).
#[inline(always)]
fn place(kind: Kind, values: &Values, edge: &Edge, functions: &[FunctionId]) -> [f64; 3] {
    let mut x = functions.iter().map(|&f| values_at(values, f, edge));
    let first = x.next().expect("a point has a function");
    // Some may vanish (be equal) on the whole edge; others then do not.
    match kind {
        Kind::Arrangement => {
            let f = if first == [0.0; 2] {
                x.find(|f| *f != [0.0; 2]).expect("a function crosses the edge")
            } else {
                first
            };
            round_symbolic(&OnEdge { corners: edge.places, row: Row::Values(&f) })
        }
        Kind::Interface => {
            let other = x.find(|f| *f != first).expect("the largest material changes");
            round_symbolic(&OnEdge { corners: edge.places, row: Row::Difference(&first, &other) })
        }
    }
}

/// An edge, lower node first.
pub struct Edge {
    pub nodes: [NodeId; 2],
    pub places: [[f64; 3]; 2],
}

/// A function that crosses an edge, with its values at the ends.
type Crossing = (FunctionId, [f64; 2]);

/// Working memory.
#[derive(Default)]
pub struct EdgeWork {
    crossings: Vec<Crossing>,
    functions: Vec<FunctionId>,
}

#[inline(always)]
fn values_at(values: &Values, f: FunctionId, edge: &Edge) -> [f64; 2] {
    edge.nodes.map(|n| values.at(f, n))
}

/// Appends the functions of the points where functions cross an edge, and returns how many points: of those of `crossing`, which have opposite signs at the ends.
/// `zeros`: whether some function may vanish on the whole edge.
#[inline]
pub fn arrangement_points(
    values: &Values,
    edge: &Edge,
    crossing: impl Iterator<Item = FunctionId> + Clone,
    zeros: bool,
    work: &mut EdgeWork,
    out: &mut Csr<FunctionId>,
) -> u32 {
    let mut rest = crossing.clone();
    let first = rest.next();
    if let (Some(f), None, false) = (first, rest.next(), zeros) {
        out.push_row(&[f]);
        return 1;
    }
    several_points(values, edge, crossing, zeros, work, out)
}

#[inline(never)]
fn several_points(
    values: &Values,
    edge: &Edge,
    crossing: impl Iterator<Item = FunctionId>,
    zeros: bool,
    work: &mut EdgeWork,
    out: &mut Csr<FunctionId>,
) -> u32 {
    work.crossings.clear();
    work.crossings.extend(crossing.map(|f| (f, values_at(values, f, edge))));
    work.functions.clear();
    if zeros {
        let all = (0..values.len()).map(FunctionId::of);
        work.functions.extend(all.filter(|&f| values_at(values, f, edge) == [0.0; 2]));
    }
    let order = |a: &Crossing, b: &Crossing| compare_zeros(&Row::Values(&a.1), &Row::Values(&b.1));
    work.crossings.sort_unstable_by(|a, b| order(a, b).then(a.0.cmp(&b.0)));
    let mut count = 0;
    for same in work.crossings.chunk_by(|a, b| order(a, b) == Ordering::Equal) {
        let start = out.items.len();
        out.items.extend(same.iter().map(|c| c.0));
        out.items.extend_from_slice(&work.functions);
        out.items[start..].sort_unstable();
        out.end_row();
        count += 1;
    }
    count
}

/// Whether some material is the largest at both ends: it then is on the whole edge, and nothing changes there.
pub fn share_material(values: &Values, a: NodeId, b: NodeId) -> bool {
    let largest =
        |n: NodeId| (0..values.len()).map(|f| values.at(FunctionId::of(f), n)).fold(f64::NEG_INFINITY, f64::max);
    let (x, y) = (largest(a), largest(b));
    (0..values.len()).map(FunctionId::of).any(|f| values.at(f, a) == x && values.at(f, b) == y)
}

/// Appends the materials of the points of an edge where the largest material changes, and returns how many points. No material may be the largest at both ends.
///
/// Walks the upper envelope from the lower node: behind each point, the material with the greatest value at the other end is the largest of those
/// tied there, and the next point is where the first of those that are greater at the other end overtakes it.
pub fn interface_points(values: &Values, edge: &Edge, work: &mut EdgeWork, out: &mut Csr<FunctionId>) -> u32 {
    let all = || (0..values.len()).map(FunctionId::of);
    let mut current = FunctionId(0);
    let mut ends = values_at(values, current, edge);
    for f in all().skip(1) {
        let x = values_at(values, f, edge);
        if x[0] > ends[0] || (x[0] == ends[0] && x[1] > ends[1]) {
            (current, ends) = (f, x);
        }
    }
    let mut count = 0;
    loop {
        // Those that overtake, the first ones to do so.
        work.crossings.clear();
        for f in all() {
            let x = values_at(values, f, edge);
            if x[1] <= ends[1] {
                continue;
            }
            let order = match work.crossings.first() {
                None => Ordering::Equal,
                Some((_, y)) => compare_zeros(&Row::Difference(&x, &ends), &Row::Difference(y, &ends)),
            };
            if order == Ordering::Less {
                work.crossings.clear();
            }
            if order != Ordering::Greater {
                work.crossings.push((f, x));
            }
        }
        let Some(&(mut next, mut next_ends)) = work.crossings.first() else { return count };
        let start = out.items.len();
        for &(f, x) in &work.crossings {
            out.items.push(f);
            if x[1] > next_ends[1] {
                (next, next_ends) = (f, x);
            }
        }
        // The current one, and those that equal it on the whole edge.
        out.items.push(current);
        out.items.extend(all().filter(|&f| f != current && values_at(values, f, edge) == ends));
        out.items[start..].sort_unstable();
        out.end_row();
        (current, ends) = (next, next_ends);
        count += 1;
    }
}

/// The points of one edge: consecutive vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    pub first: u32,
    pub count: u32,
}

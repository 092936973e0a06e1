//! One numbering for all vertices, and the network as flat arrays.
//!
//! Vertices on edges have their ids already. Nodes follow in their order, found by the marks that polygons left; then points on facets, which the simplices
//! on both sides have noted: sorted by nodes and functions, equal ones are one (their function lists are complete, so equal points have equal
//! lists and different ones do not); then points inside simplices, in order. Cost: linear, and a sort of the points on facets.

use super::data::{Network, Values};
use super::domain::Domain;
use super::points::{EdgePoints, write_places};
use super::polygons::{CarrierPoints, Marks, Pieces, reference};
use super::sets::rank;
use super::simplex::Kind;
use crate::base::parallel::{concat, offsets, ranges, write_parts};
use crate::base::{Csr, Error, FunctionId, NodeId, Result, Status, VertexId};
use crate::exact::{InTetrahedron, InTriangle, Row, round_symbolic};
use rayon::prelude::*;

/// Points in one task at least.
const LEAST: usize = 1 << 10;

/// The vertex of each node on the network, by counting bits.
struct NodeRanks {
    words: Vec<u64>,
    /// The marked nodes before each word.
    before: Vec<u32>,
}

impl NodeRanks {
    fn new(marks: &Marks) -> Self {
        let words: Vec<u64> = marks.words().collect();
        let mut sum = 0;
        let before = words.iter().map(|w| {
            sum += w.count_ones();
            sum - w.count_ones()
        });
        Self { before: before.collect(), words }
    }
    fn rank(&self, node: u32) -> u32 {
        let (word, bit) = (node as usize / 64, node % 64);
        self.before[word] + (self.words[word] & ((1 << bit) - 1)).count_ones()
    }
    fn nodes(&self) -> impl Iterator<Item = NodeId> + '_ {
        let bits = |(w, &word): (usize, &u64)| super::mesh_edges::bits(word).map(move |b| NodeId::of(w * 64 + b));
        self.words.iter().enumerate().flat_map(bits)
    }
}

/// The points on facets, each once: its first note, and for each task the numbers of its notes.
fn unify(parts: &[Pieces]) -> (Vec<(u32, u32)>, Vec<Vec<u32>>) {
    let mut all: Vec<(u32, u32)> = Vec::new();
    for (p, part) in parts.iter().enumerate() {
        all.extend((0..part.facet_points.nodes.len()).map(|i| (p as u32, i as u32)));
    }
    let key = |&(p, i): &(u32, u32)| {
        let points = &parts[p as usize].facet_points;
        (points.nodes[i as usize], points.functions.row(i as usize))
    };
    all.par_sort_unstable_by(|a, b| key(a).cmp(&key(b)).then(a.cmp(b)));
    let mut numbers: Vec<Vec<u32>> = parts.iter().map(|p| vec![0; p.facet_points.nodes.len()]).collect();
    let mut first = Vec::new();
    for same in all.chunk_by(|a, b| key(a) == key(b)) {
        for &(p, i) in same {
            numbers[p as usize][i as usize] = first.len() as u32;
        }
        first.push(same[0]);
    }
    (first, numbers)
}

/// Correctly rounded coordinates of a point on a facet or inside a simplex.
fn place(kind: Kind, domain: &Domain, values: &Values, points: &CarrierPoints, i: usize) -> [f64; 3] {
    let nodes = points.nodes[i];
    let functions = points.encoding[i];
    if nodes[3].is_none() {
        let nodes = [nodes[0], nodes[1], nodes[2]];
        let x = functions.map(|f| if f.is_none() { [0.0; 3] } else { nodes.map(|n| values.at(f, n)) });
        let rows = match kind {
            Kind::Arrangement => [Row::Values(&x[0]), Row::Values(&x[1])],
            Kind::Interface => [Row::Difference(&x[1], &x[0]), Row::Difference(&x[2], &x[0])],
        };
        return round_symbolic(&InTriangle { corners: nodes.map(|n| domain.coordinates(n)), rows });
    }
    let x = functions.map(|f| if f.is_none() { [0.0; 4] } else { nodes.map(|n| values.at(f, n)) });
    let rows = match kind {
        Kind::Arrangement => [Row::Values(&x[0]), Row::Values(&x[1]), Row::Values(&x[2])],
        Kind::Interface => {
            [Row::Difference(&x[1], &x[0]), Row::Difference(&x[2], &x[0]), Row::Difference(&x[3], &x[0])]
        }
    };
    round_symbolic(&InTetrahedron { corners: nodes.map(|n| domain.coordinates(n)), rows })
}

/// All functions that vanish at a node (all materials that are largest there), rising.
fn functions_at(kind: Kind, values: &Values, node: NodeId, out: &mut Vec<FunctionId>) {
    let all = (0..values.len()).map(FunctionId::of);
    let level = match kind {
        Kind::Arrangement => 0.0,
        Kind::Interface => all.clone().map(|f| values.at(f, node)).fold(f64::NEG_INFINITY, f64::max),
    };
    out.extend(all.filter(|&f| values.at(f, node) == level));
}

/// Arrays of all parts behind one another, with every item renamed; in place if there is one part.
fn renamed<T: Copy + Send>(
    parts: &mut [Pieces],
    take: impl Fn(&mut Pieces) -> Vec<u32>,
    rename: impl Fn(usize, u32) -> T + Sync,
) -> Vec<T> {
    let mut arrays: Vec<Vec<u32>> = parts.iter_mut().map(take).collect();
    if arrays.len() == 1 {
        return arrays.pop().expect("one part").into_iter().map(|x| rename(0, x)).collect();
    }
    let lengths: Vec<usize> = arrays.iter().map(Vec::len).collect();
    write_parts(&lengths, |p, out| out.extend(arrays[p].iter().map(|&x| rename(p, x))))
}

pub fn assemble<P: EdgePoints>(
    kind: Kind,
    domain: &Domain,
    values: &Values,
    mut edge_points: P,
    marks: Marks,
    mut parts: Vec<Pieces>,
) -> Result<Network> {
    let nodes = NodeRanks::new(&marks);
    let (facet_first, facet_numbers) = unify(&parts);
    let on_nodes = edge_points.functions().len();
    let on_facets = on_nodes + nodes.nodes().count();
    let inside = on_facets + facet_first.len();
    let inside_starts = offsets(parts.iter().map(|p| p.inside_points.nodes.len()));
    let total = inside + inside_starts.last().expect("offsets end with the sum");
    if total >= reference::NODE as usize {
        return Err(Error::new(Status::TooLarge, "2^30 vertices or more"));
    }

    // The parts of the vertices: those on edges, then nodes, then all others.
    let mut functions = edge_points.take_functions();
    let mut lengths = edge_points.lengths();
    let edge_parts = lengths.len();
    let edge_starts = offsets(lengths.iter().copied());
    let on_node: Vec<NodeId> = nodes.nodes().collect();
    let facet = facet_first.iter().map(|&(p, i)| (&parts[p as usize].facet_points, i as usize));
    let inner = parts.iter().flat_map(|p| (0..p.inside_points.nodes.len()).map(move |i| (&p.inside_points, i)));
    let others: Vec<(&CarrierPoints, usize)> = facet.chain(inner).collect();
    let ranges = ranges(others.len(), LEAST);
    lengths.push(on_node.len());
    lengths.extend(ranges.iter().map(|r| r.len()));
    let vertices = write_parts(&lengths, |p, out| {
        if p < edge_parts {
            write_places(kind, values, &edge_points, &functions, (p, edge_starts[p]), out);
        } else if p == edge_parts {
            out.extend(on_node.iter().map(|&n| domain.coordinates(n)));
        } else {
            out.extend(
                others[ranges[p - edge_parts - 1].clone()].iter().map(|(x, i)| place(kind, domain, values, x, *i)),
            );
        }
    });
    let vertex_nodes = write_parts(&lengths, |p, out| {
        if p < edge_parts {
            edge_points.edges(p, |edge, count| {
                let [a, b] = edge.nodes;
                (0..count).for_each(|_| out.push([a, b, NodeId::NONE, NodeId::NONE]));
            });
        } else if p == edge_parts {
            out.extend(on_node.iter().map(|&n| [n, NodeId::NONE, NodeId::NONE, NodeId::NONE]));
        } else {
            out.extend(others[ranges[p - edge_parts - 1].clone()].iter().map(|(x, i)| x.nodes[*i]));
        }
    });
    for &node in &on_node {
        functions_at(kind, values, node, &mut functions.items);
        functions.end_row();
    }
    for (points, i) in &others {
        functions.push_row(points.functions.row(*i));
    }

    let (sets, set_ids) = rank(&parts.iter().map(|p| &p.sets).collect::<Vec<_>>());
    drop(others);
    let corners: usize = parts.iter().map(|p| p.polygons.items.len()).sum();
    if corners >= i32::MAX as usize {
        return Err(Error::new(Status::TooLarge, "2^31 corners of polygons or more"));
    }
    let vertex = |p: usize, r: u32| {
        let at = (r & !reference::TAG) as usize;
        VertexId::of(match r & reference::TAG {
            reference::EDGE => at,
            reference::NODE => on_nodes + nodes.rank(at as u32) as usize,
            reference::FACET => on_facets + facet_numbers[p][at] as usize,
            _ => inside + inside_starts[p] + at,
        })
    };
    let items = renamed(&mut parts, |part| std::mem::take(&mut part.polygons.items), vertex);
    let polygon_set = renamed(&mut parts, |part| std::mem::take(&mut part.set), |p, s| set_ids[p][s as usize]);
    let starts = offsets(parts.iter().map(|p| *p.polygons.offsets.last().expect("offsets start with 0") as usize));
    let mut polygon_offsets = renamed(
        &mut parts,
        |part| {
            let mut offsets = std::mem::take(&mut part.polygons.offsets);
            offsets.pop();
            offsets
        },
        |p, o| o + starts[p] as u32,
    );
    polygon_offsets.push(corners as u32);
    let mut active: Vec<u64> = Vec::new();
    for part in &parts {
        active.resize(active.len().max(part.active.len()), 0);
        active.iter_mut().zip(&part.active).for_each(|(sum, n)| *sum += n);
    }
    let polygon_tets = concat(parts.iter_mut().map(|p| std::mem::take(&mut p.tets)).collect());
    Ok(Network {
        kind,
        dim: domain.dim(),
        function_count: values.len(),
        vertices,
        vertex_nodes,
        vertex_functions: functions,
        polygons: Csr { offsets: polygon_offsets, items },
        polygon_set,
        polygon_tets,
        sets,
        active,
    })
}

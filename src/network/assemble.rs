//! One numbering for all vertices, and the network as flat arrays.
//!
//! Vertices on edges have their ids already. Nodes follow in their order, found by the marks that polygons left; then points on facets, which the simplices
//! on both sides have noted: sorted by nodes and functions, equal ones are one (their function lists are complete, so equal points have equal
//! lists and different ones do not); then points inside simplices, in order. Cost: linear, and a sort of the points on facets.

use super::data::{Network, Values};
use super::domain::Domain;
use super::points::EdgePoints;
use super::polygons::{CarrierPoints, Marks, Pieces, reference};
use super::sets::rank;
use super::simplex::Kind;
use crate::base::parallel::{concat, map_ranges, offsets, write_parts};
use crate::base::{Csr, Error, FunctionId, NodeId, Result, Status, VertexId};
use crate::exact::{InTetrahedron, InTriangle, Row, round_symbolic};

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
    all.sort_unstable_by(|a, b| key(a).cmp(&key(b)).then(a.cmp(b)));
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

pub fn assemble(
    kind: Kind,
    domain: &Domain,
    values: &Values,
    edge_points: EdgePoints,
    marks: Marks,
    mut parts: Vec<Pieces>,
) -> Result<Network> {
    let nodes = NodeRanks::new(&marks);
    let (facet_first, facet_numbers) = unify(&parts);
    let on_nodes = edge_points.len();
    let on_facets = on_nodes + nodes.nodes().count();
    let inside = on_facets + facet_first.len();
    let inside_starts = offsets(parts.iter().map(|p| p.inside_points.nodes.len()));
    let total = inside + inside_starts.last().expect("offsets end with the sum");
    if total >= reference::NODE as usize {
        return Err(Error::new(Status::TooLarge, "2^30 vertices or more"));
    }

    // Vertices behind those on edges.
    let mut vertices = vec![edge_points.coordinates];
    let mut vertex_nodes = vec![edge_points.nodes];
    let mut vertex_functions = vec![edge_points.functions];
    if total > on_nodes {
        let mut functions = Csr::default();
        let mut carriers = Vec::new();
        let mut places = Vec::new();
        for node in nodes.nodes() {
            functions_at(kind, values, node, &mut functions.items);
            functions.end_row();
            carriers.push([node, NodeId::NONE, NodeId::NONE, NodeId::NONE]);
            places.push(domain.coordinates(node));
        }
        let facet = facet_first.iter().map(|&(p, i)| (&parts[p as usize].facet_points, i as usize));
        let inner = parts.iter().flat_map(|p| (0..p.inside_points.nodes.len()).map(move |i| (&p.inside_points, i)));
        let rest: Vec<(&CarrierPoints, usize)> = facet.chain(inner).collect();
        for (points, i) in &rest {
            functions.push_row(points.functions.row(*i));
            carriers.push(points.nodes[*i]);
        }
        vertices.push(places);
        vertices.extend(map_ranges(rest.len(), LEAST, |range| {
            rest[range].iter().map(|(points, i)| place(kind, domain, values, points, *i)).collect::<Vec<_>>()
        }));
        vertex_nodes.push(carriers);
        vertex_functions.push(functions);
    }

    let (sets, set_ids) = rank(&parts.iter().map(|p| &p.sets).collect::<Vec<_>>());
    let lengths: Vec<usize> = parts.iter().map(|p| p.set.len()).collect();
    let polygon_set = write_parts(&lengths, |p, out| {
        out.extend(parts[p].set.iter().map(|&s| set_ids[p][s as usize]));
    });
    let lengths: Vec<usize> = parts.iter().map(|p| p.polygons.items.len()).collect();
    if lengths.iter().sum::<usize>() >= i32::MAX as usize {
        return Err(Error::new(Status::TooLarge, "2^31 corners of polygons or more"));
    }
    let items = write_parts(&lengths, |p, out| {
        out.extend(parts[p].polygons.items.iter().map(|&r| {
            let at = (r & !reference::TAG) as usize;
            VertexId::of(match r & reference::TAG {
                reference::EDGE => at,
                reference::NODE => on_nodes + nodes.rank(at as u32) as usize,
                reference::FACET => on_facets + facet_numbers[p][at] as usize,
                _ => inside + inside_starts[p] + at,
            })
        }));
    });
    let starts = offsets(lengths.into_iter());
    let mut ends: Vec<usize> = parts.iter().map(|p| p.set.len()).collect();
    ends.push(1);
    let polygon_offsets = write_parts(&ends, |p, out| match parts.get(p) {
        Some(part) => out.extend(part.polygons.offsets[..part.set.len()].iter().map(|o| o + starts[p] as u32)),
        None => out.push(starts[p] as u32),
    });
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
        vertices: concat(vertices),
        vertex_nodes: concat(vertex_nodes),
        vertex_functions: Csr::concat(vertex_functions),
        polygons: Csr { offsets: polygon_offsets, items },
        polygon_set,
        polygon_tets,
        sets,
        active,
    })
}

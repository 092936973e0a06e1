//! Nodes of the domain that the network does not touch, joined along edges that it does not touch.
//!
//! A node is *free* if no vertex of the network is there and the simplices around it hang together across their facets (in a box all
//! do). All cells of the simplices around a free node that contain it are in one region, so free nodes stand for regions; two of them that are joined by
//! an edge without a vertex of the network are in the same one.
//!
//! In a box, rows of free nodes along x between blocked edges are *runs*: one bit a node, 64 nodes at once, and one member of the union-find
//! a run. Runs in neighbouring rows are joined once where they begin to touch. The diagonals of the cubes' faces matter only where
//! one of the face's sides is blocked or one of its nodes is not free: elsewhere the sides join the same nodes.
//! In a mesh every node is a member, and the edges are those of the tetrahedra.
//!
//! Cost: a few bits a node for boxes, linear in the simplices for meshes.

use super::domain::BoxGrid;
use super::{Domain, Network, TetMesh};
use crate::base::{NodeId, UnionFind};

/// Which nodes are free, and the members that stand for them.
#[derive(Default)]
pub struct Runs {
    free: Vec<u64>,
    count: usize,
    // Of a box:
    /// One bit for each node that begins a run, and how many of them are before each word.
    starts: Vec<u64>,
    before: Vec<u32>,
    /// Edges along each axis that have a vertex or leave the row, by lower node.
    blocked: [Vec<u64>; 3],
    /// Diagonals that have a vertex, by lower node: in the xy plane falling and rising, xz, yz.
    diagonals: Vec<u8>,
}

#[inline(always)]
fn bit(bits: &[u64], i: usize) -> bool {
    bits[i / 64] >> (i % 64) & 1 != 0
}

#[inline(always)]
fn set(bits: &mut [u64], i: usize) {
    bits[i / 64] |= 1 << (i % 64);
}

/// The 64 bits from position `i` on (0 behind the end).
#[inline(always)]
fn word_at(bits: &[u64], i: usize) -> u64 {
    let (w, s) = (i / 64, i % 64);
    let low = bits.get(w).map_or(0, |x| x >> s);
    if s == 0 { low } else { low | bits.get(w + 1).map_or(0, |x| x << (64 - s)) }
}

impl Runs {
    /// How many members the classes have.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The member for a node; `None` if it is not free.
    #[inline]
    pub fn member(&self, node: NodeId) -> Option<usize> {
        let i = node.at();
        if !bit(&self.free, i) {
            return None;
        }
        if self.starts.is_empty() {
            return Some(i);
        }
        let upto = self.starts[i / 64] & (u64::MAX >> (63 - i % 64));
        Some((self.before[i / 64] + upto.count_ones()) as usize - 1)
    }

    /// Members that stand for something.
    pub fn members(&self) -> impl Iterator<Item = (usize, NodeId)> + '_ {
        let heads = if self.starts.is_empty() { &self.free } else { &self.starts };
        let nodes = heads.iter().enumerate().flat_map(|(w, &word)| {
            let mut bits = word;
            std::iter::from_fn(move || {
                let at = bits.trailing_zeros() as usize;
                bits &= bits.wrapping_sub(1);
                (at < 64).then(|| NodeId::of(64 * w + at))
            })
        });
        let dense = !self.starts.is_empty();
        nodes.enumerate().map(move |(k, node)| (if dense { k } else { node.at() }, node))
    }
}

/// The vertices on open edges of the domain, by edge: the edge's nodes, and the range of vertices on it, from the lower node to the higher.
pub fn edge_vertices(network: &Network) -> impl Iterator<Item = ([NodeId; 2], std::ops::Range<usize>)> + '_ {
    let nodes = &network.vertex_nodes;
    let mut at = 0;
    std::iter::from_fn(move || {
        let here = *nodes.get(at)?;
        if here[1].is_none() || here[2].is_some() {
            return None;
        }
        let start = at;
        while at < nodes.len() && nodes[at] == here {
            at += 1;
        }
        Some(([here[0], here[1]], start..at))
    })
}

/// The vertices at nodes.
pub fn node_vertices(network: &Network) -> impl Iterator<Item = NodeId> + '_ {
    let first = network.vertex_nodes.partition_point(|n| n[1].is_some() && n[2].is_none());
    network.vertex_nodes[first..].iter().take_while(|n| n[1].is_none()).map(|n| n[0])
}

/// Finds the free nodes and their runs. `singular`: nodes that are not free though no vertex is there.
pub fn find_runs(network: &Network, domain: &Domain, singular: &[NodeId]) -> Runs {
    let nodes = domain.node_count();
    let words = nodes.div_ceil(64);
    let mut free = vec![u64::MAX; words];
    if !nodes.is_multiple_of(64) {
        free[words - 1] = (1 << (nodes % 64)) - 1;
    }
    node_vertices(network).chain(singular.iter().copied()).for_each(|n| free[n.at() / 64] &= !(1 << (n.at() % 64)));
    let grid = match domain {
        Domain::Box(grid) => grid,
        Domain::Mesh(mesh) => {
            let lonely = |&n: &usize| mesh.node_tets.row(n).is_empty();
            (0..nodes).filter(lonely).for_each(|n| free[n / 64] &= !(1 << (n % 64)));
            return Runs { free, count: nodes, ..Runs::default() };
        }
    };
    let mut blocked = [(); 3].map(|_| vec![0u64; words]);
    let mut diagonals = vec![0u8; nodes];
    for ([a, b], _) in edge_vertices(network) {
        match direction(grid, a, b) {
            Direction::Axis(axis) => set(&mut blocked[axis], a.at()),
            Direction::Diagonal(slot) => diagonals[a.at()] |= 1 << slot,
        }
    }
    // Rows along x end.
    let (row, rows) = (grid.strides()[1], nodes / grid.strides()[1]);
    (0..rows).for_each(|r| set(&mut blocked[0], r * row + row - 1));
    let mut starts = vec![0u64; words];
    let mut before = Vec::with_capacity(words);
    let (mut count, mut last) = (0u32, 0u64);
    for w in 0..words {
        // The node before is free, and so is the edge from there.
        let passes = free[w] & !blocked[0][w];
        starts[w] = free[w] & !(passes << 1 | last);
        last = passes >> 63;
        before.push(count);
        count += starts[w].count_ones();
    }
    Runs { free, starts, before, count: count as usize, blocked, diagonals }
}

/// Joins the members (at positions `base..` of the classes) that edges without vertices join.
pub fn join_runs(runs: &Runs, network: &Network, domain: &Domain, base: usize, classes: &mut UnionFind) {
    match domain {
        Domain::Box(grid) => join_in_box(runs, network, grid, base, classes),
        Domain::Mesh(mesh) => join_in_mesh(runs, network, mesh, base, classes),
    }
}

/// The way from a node to a higher neighbour.
enum Direction {
    Axis(usize),
    /// One of the six diagonals from an odd node to higher ones.
    Diagonal(u32),
}

fn direction(grid: &BoxGrid, a: NodeId, b: NodeId) -> Direction {
    let (p, q) = (grid.place(a), grid.place(b));
    let differs = |axis: usize| p[axis] != q[axis];
    match [differs(0), differs(1), differs(2)] {
        [true, false, false] => Direction::Axis(0),
        [false, true, false] => Direction::Axis(1),
        [false, false, true] => Direction::Axis(2),
        [true, true, _] => Direction::Diagonal((q[0] > p[0]) as u32),
        [true, false, true] => Direction::Diagonal(2 + (q[0] > p[0]) as u32),
        _ => Direction::Diagonal(4 + (q[1] > p[1]) as u32),
    }
}

fn join_in_box(runs: &Runs, network: &Network, grid: &BoxGrid, base: usize, classes: &mut UnionFind) {
    let (strides, nodes) = (grid.strides(), grid.node_count());
    let row = strides[1];
    let rows_in_layer = strides[2] / row;
    let member = |n: usize| base + runs.member(NodeId::of(n)).expect("a free node");
    for (axis, &step) in strides.iter().enumerate().skip(1) {
        let (mut carry, end) = (0u64, nodes - step);
        for (w, n) in (0..end).step_by(64).enumerate() {
            let mut open = runs.free[w] & word_at(&runs.free, n + step) & !runs.blocked[axis][w];
            if end - n < 64 {
                open &= (1 << (end - n)) - 1;
            }
            // Runs of both rows that touched at the node before touch here again.
            let mut fresh = open & (runs.starts[w] | word_at(&runs.starts, n + step) | !(open << 1 | carry));
            carry = open >> 63;
            while fresh != 0 {
                let i = n + fresh.trailing_zeros() as usize;
                fresh &= fresh - 1;
                // Behind the last row of a layer is the next layer.
                if axis == 2 || !(i / row + 1).is_multiple_of(rows_in_layer) {
                    classes.union(member(i), member(i + step));
                }
            }
        }
    }
    // The diagonal of the square at a node in the plane of two axes, in that order: it joins the odd corners.
    let mut join = |corner: [usize; 3], [d, e]: [usize; 2]| {
        if corner[d] >= grid.cells()[d] || corner[e] >= grid.cells()[e] {
            return;
        }
        let low = grid.node(corner).at();
        let rises = corner.iter().sum::<usize>() & 1 == 1;
        let (a, b) = if rises { (low, low + strides[d] + strides[e]) } else { (low + strides[d], low + strides[e]) };
        let slot = 2 * (d + e - 1) + rises as usize;
        if runs.diagonals[a] >> slot & 1 == 0 && bit(&runs.free, a) && bit(&runs.free, b) {
            classes.union(member(a), member(b));
        }
    };
    let lower = |mut place: [usize; 3], axis: usize| {
        place[axis] = place[axis].wrapping_sub(1);
        place
    };
    for ([a, b], _) in edge_vertices(network) {
        if let Direction::Axis(axis) = direction(grid, a, b) {
            let place = grid.place(a);
            for other in (0..3).filter(|&o| o != axis) {
                let plane = [axis.min(other), axis.max(other)];
                join(place, plane);
                if place[other] > 0 {
                    join(lower(place, other), plane);
                }
            }
        }
    }
    for n in node_vertices(network) {
        let place = grid.place(n);
        for [d, e] in [[0, 1], [0, 2], [1, 2]] {
            // A coordinate below 0 wraps around, to one that is beyond the last square.
            for corner in [place, lower(place, d), lower(place, e), lower(lower(place, d), e)] {
                join(corner, [d, e]);
            }
        }
    }
}

fn join_in_mesh(runs: &Runs, network: &Network, mesh: &TetMesh, base: usize, classes: &mut UnionFind) {
    // Both ends of a blocked edge are marked; of such pairs the list is asked.
    let mut near = vec![0u64; mesh.vertices.len().div_ceil(64)];
    let mut blocked: Vec<[NodeId; 2]> = edge_vertices(network).map(|(nodes, _)| nodes).collect();
    blocked.iter().flatten().for_each(|n| set(&mut near, n.at()));
    blocked.sort_unstable();
    for corners in &mesh.tets {
        let corners = &corners[..=mesh.dim];
        for (k, &a) in corners.iter().enumerate() {
            for &b in &corners[k + 1..] {
                let open = bit(&runs.free, a.at()) && bit(&runs.free, b.at());
                let listed = || blocked.binary_search(&[a.min(b), a.max(b)]).is_ok();
                if open && !(bit(&near, a.at()) && bit(&near, b.at()) && listed()) {
                    classes.union(base + a.at(), base + b.at());
                }
            }
        }
    }
}

/// Nodes around which the simplices do not hang together across facets with that node, rising; and, in three dimensions, edges of the domain
/// around which they do not.
pub fn find_singular(mesh: &TetMesh) -> (Vec<NodeId>, Vec<[NodeId; 2]>) {
    let (mut on_boundary, mut edges) = (vec![false; mesh.vertices.len()], Vec::new());
    for (t, corners) in mesh.tets.iter().enumerate() {
        for k in (0..=mesh.dim).filter(|&k| mesh.neighbours[t][k].is_none()) {
            let facet = |i: usize| corners[i];
            let others: [usize; 3] = std::array::from_fn(|j| (k + 1 + j) % (mesh.dim + 1));
            let others = &others[..mesh.dim];
            others.iter().for_each(|&i| on_boundary[facet(i).at()] = true);
            for (j, &i) in others.iter().enumerate() {
                let (a, b) = (facet(i), facet(others[(j + 1) % others.len()]));
                edges.push([a.min(b), a.max(b)]);
            }
        }
    }
    let singular_node = |n: usize| {
        let row = mesh.node_tets.row(n);
        let mut fans = UnionFind::new(row.len());
        for (i, t) in row.iter().enumerate() {
            for k in 0..=mesh.dim {
                let behind = mesh.neighbours[t.at()][k];
                if behind.is_some() && mesh.tets[t.at()][k].at() != n {
                    fans.union(i, row.binary_search(&behind).expect("the facet has the node"));
                }
            }
        }
        fans.labels().1 > 1
    };
    let nodes = (0..mesh.vertices.len()).filter(|&n| on_boundary[n] && singular_node(n)).map(NodeId::of).collect();
    if mesh.dim == 2 {
        return (nodes, Vec::new());
    }
    // A fan has two boundary facets.
    edges.sort_unstable();
    let singular = edges.chunk_by(|a, b| a == b).filter(|same| same.len() > 2).map(|same| same[0]).collect();
    (nodes, singular)
}

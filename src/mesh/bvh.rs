//! A flat hierarchy of boxes over triangles.
//!
//! Triangles are sorted along a Morton curve of their box centres; a node splits where the highest bit changes, equal
//! codes in the middle, down to leaves of [`LEAF`] triangles. Children lie behind their parent, the two next to each
//! other, so boxes are gathered by one walk backward, and nothing recurses. Depth is at most 63 + 32.
//!
//! Invariant: boxes are kept as `f32` under one map that never falls (shift, scale by a power of two, round), and a query
//! goes through the same map, so that two boxes which meet always meet after it. The reverse need not hold: the answers
//! are candidates.
//!
//! Degenerate cases: flat boxes, all centres equal, coordinates of any finite magnitude; no triangles: no answers.
//!
//! Cost: building n log n (a sort of integers); a query as usual, logarithmic plus its answers. The result depends on
//! coordinates and ids only.

use crate::base::{TriangleId, VertexId, Watch};

/// Triangles per leaf.
const LEAF: usize = 4;
/// More than the depth of any tree, see above.
const STACK: usize = 128;

/// Lowest and highest corner, mapped.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Box32 {
    lo: [f32; 3],
    hi: [f32; 3],
}

impl Box32 {
    const NOTHING: Self = Self { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3] };

    #[inline(always)]
    fn meets(&self, o: &Self) -> bool {
        (self.lo[0] <= o.hi[0])
            & (self.lo[1] <= o.hi[1])
            & (self.lo[2] <= o.hi[2])
            & (o.lo[0] <= self.hi[0])
            & (o.lo[1] <= self.hi[1])
            & (o.lo[2] <= self.hi[2])
    }

    #[inline(always)]
    fn add(&mut self, o: &Self) {
        for i in 0..3 {
            self.lo[i] = self.lo[i].min(o.lo[i]);
            self.hi[i] = self.hi[i].max(o.hi[i]);
        }
    }
}

/// An inner node has `count` 0 and its children at `first` and `first + 1`; a leaf holds `count` triangles from `first`.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Box32,
    first: u32,
    count: u32,
}

/// The hierarchy. Made by [`build_bvh`].
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// Box and id of each triangle, in curve order.
    boxes: Vec<Box32>,
    ids: Vec<TriangleId>,
    centre: [f64; 3],
    scale: f64,
}

/// Builds the hierarchy over all `triangles`. Coordinates are finite.
pub fn build_bvh(vertices: &[[f64; 3]], triangles: &[[VertexId; 3]]) -> Bvh {
    build_bvh_watched(vertices, triangles, &Watch::quiet())
}

/// Triangles between two looks at the caller's wish to stop.
const OFTEN: usize = 1 << 13;

/// The same; told to stop it returns a hierarchy of nothing.
pub fn build_bvh_watched(vertices: &[[f64; 3]], triangles: &[[VertexId; 3]], watch: &Watch) -> Bvh {
    let n = triangles.len();
    let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for v in triangles.iter().flatten() {
        for i in 0..3 {
            lo[i] = lo[i].min(vertices[v.at()][i]);
            hi[i] = hi[i].max(vertices[v.at()][i]);
        }
    }
    let centre: [f64; 3] = std::array::from_fn(|i| if n == 0 { 0.0 } else { lo[i] * 0.5 + hi[i] * 0.5 });
    let half = (0..3).map(|i| (hi[i] - centre[i]).max(centre[i] - lo[i])).fold(0.0, f64::max);
    let mut bvh =
        Bvh { nodes: Vec::new(), boxes: Vec::with_capacity(n), ids: Vec::new(), centre, scale: scale_for(half) };
    if n == 0 {
        return bvh;
    }
    let mut keys = Vec::with_capacity(n);
    for (t, corners) in triangles.iter().enumerate() {
        if t % OFTEN == 0 && !watch.go_on() {
            return bvh;
        }
        let mut bounds = Box32::NOTHING;
        for v in corners {
            let x = bvh.map(&vertices[v.at()]);
            bounds.add(&Box32 { lo: x, hi: x });
        }
        keys.push((morton(&bounds), t as u32));
        bvh.boxes.push(bounds);
    }
    keys.sort_unstable();
    if !watch.go_on() {
        return bvh;
    }
    bvh.boxes = keys.iter().map(|&(_, t)| bvh.boxes[t as usize]).collect();
    bvh.ids = keys.iter().map(|&(_, t)| TriangleId(t)).collect();
    if !watch.go_on() {
        return bvh;
    }
    split(&keys, &mut bvh);
    for i in (0..bvh.nodes.len()).rev() {
        let node = bvh.nodes[i];
        let (first, count) = (node.first as usize, node.count as usize);
        let mut bounds = Box32::NOTHING;
        if count == 0 {
            bounds.add(&bvh.nodes[first].bounds);
            bounds.add(&bvh.nodes[first + 1].bounds);
        } else {
            bvh.boxes[first..first + count].iter().for_each(|b| bounds.add(b));
        }
        bvh.nodes[i].bounds = bounds;
    }
    bvh
}

/// A power of two that brings `half` near 1, so that neither `f32` range nor its subnormals matter. Where the power
/// itself would leave the range of doubles, the nearest one that does not.
fn scale_for(half: f64) -> f64 {
    let exponent = (half.to_bits() >> 52 & 0x7ff) as i64 - 1023;
    let power = (-exponent).clamp(-1022, 1023);
    f64::from_bits(((power + 1023) as u64) << 52)
}

/// 21 bits per axis of the box centre, interleaved. Mapped coordinates lie within [−2, 2].
fn morton(b: &Box32) -> u64 {
    let mut code = 0;
    for i in 0..3 {
        let middle = (b.lo[i] as f64 + b.hi[i] as f64) * 0.5;
        let cell = ((middle + 2.0) * (1u64 << 19) as f64).clamp(0.0, 2_097_151.0) as u64;
        code |= spread(cell) << i;
    }
    code
}

/// Moves bit i to bit 3i.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

/// Makes the nodes over the sorted keys, without boxes.
fn split(keys: &[(u64, u32)], bvh: &mut Bvh) {
    const EMPTY: Node = Node { bounds: Box32::NOTHING, first: 0, count: 0 };
    bvh.nodes.reserve(keys.len() / 2 + 1);
    bvh.nodes.push(EMPTY);
    let mut stack = vec![(0u32, 0u32, keys.len() as u32)];
    while let Some((node, start, end)) = stack.pop() {
        if (end - start) as usize <= LEAF {
            bvh.nodes[node as usize] = Node { first: start, count: end - start, ..EMPTY };
            continue;
        }
        let range = &keys[start as usize..end as usize];
        let differ = range[0].0 ^ range[range.len() - 1].0;
        let middle = if differ == 0 {
            range.len() / 2
        } else {
            let bit = 1u64 << differ.ilog2();
            range.partition_point(|k| k.0 & bit == 0)
        };
        let (children, middle) = (bvh.nodes.len() as u32, start + middle as u32);
        bvh.nodes[node as usize].first = children;
        bvh.nodes.extend([EMPTY; 2]);
        stack.push((children + 1, middle, end));
        stack.push((children, start, middle));
    }
}

/// Two nodes, maybe the same.
pub type NodePair = (u32, u32);

impl Bvh {
    /// The map that never falls, per axis.
    #[inline(always)]
    fn map(&self, x: &[f64; 3]) -> [f32; 3] {
        std::array::from_fn(|i| ((x[i] - self.centre[i]) * self.scale) as f32)
    }

    /// Visits all triangles whose box meets the box from `lo` to `hi` (infinite sides allowed, NaN not).
    #[inline]
    pub fn meeting_box(&self, lo: &[f64; 3], hi: &[f64; 3], mut visit: impl FnMut(TriangleId)) {
        if self.nodes.is_empty() {
            return;
        }
        let query = Box32 { lo: self.map(lo), hi: self.map(hi) };
        let mut stack = [0u32; STACK];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let node = &self.nodes[stack[depth] as usize];
            if !node.bounds.meets(&query) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.first + 1;
                stack[depth + 1] = node.first;
                depth += 2;
                continue;
            }
            for i in node.first as usize..(node.first + node.count) as usize {
                if self.boxes[i].meets(&query) {
                    visit(self.ids[i]);
                }
            }
        }
    }

    /// Visits all triangles whose box meets the ray along `axis` (toward +∞ if `positive`) from any point of the box
    /// from `lo` to `hi`.
    #[inline]
    pub fn meeting_ray(
        &self,
        lo: &[f64; 3],
        hi: &[f64; 3],
        axis: usize,
        positive: bool,
        visit: impl FnMut(TriangleId),
    ) {
        let (mut lo, mut hi) = (*lo, *hi);
        if positive {
            hi[axis] = f64::INFINITY;
        } else {
            lo[axis] = f64::NEG_INFINITY;
        }
        self.meeting_box(&lo, &hi, visit);
    }

    /// Visits all pairs of triangles whose boxes meet, each pair once, until `visit` returns false.
    pub fn meeting_pairs(&self, visit: impl FnMut(TriangleId, TriangleId) -> bool) {
        self.pairs_among(self.root_pair(), |_, _| true, visit);
    }

    /// The same pairs in parts, for several threads: pairs of nodes, some `count` of them or more if there are so many.
    pub fn node_pairs(&self, count: usize) -> Vec<NodePair> {
        let mut pairs = self.root_pair();
        loop {
            let before = pairs.len();
            if before >= count {
                return pairs;
            }
            let mut finer = Vec::with_capacity(4 * before);
            for &pair in &pairs {
                if !self.divide(pair, &mut finer) {
                    finer.push(pair);
                }
            }
            if finer == pairs {
                return pairs;
            }
            pairs = finer;
        }
    }

    /// Those of [`Bvh::meeting_pairs`] that are below a pair of nodes, until `visit` returns false.
    pub fn meeting_pairs_below(&self, pair: NodePair, visit: impl FnMut(TriangleId, TriangleId) -> bool) {
        self.pairs_among(vec![pair], |_, _| true, visit);
    }

    fn root_pair(&self) -> Vec<NodePair> {
        if self.nodes.is_empty() { Vec::new() } else { vec![(0, 0)] }
    }

    /// The pairs of [`Bvh::meeting_pairs`] of which one triangle at least is `marked`. What holds no marked triangle is
    /// passed by whole nodes, so the cost grows with the marked ones.
    pub fn meeting_marked_pairs(&self, marked: &[bool], mut visit: impl FnMut(TriangleId, TriangleId) -> bool) {
        let mut has = vec![false; self.nodes.len()];
        for i in (0..self.nodes.len()).rev() {
            let node = &self.nodes[i];
            let (first, count) = (node.first as usize, node.count as usize);
            has[i] = match count {
                0 => has[first] || has[first + 1],
                _ => self.ids[first..first + count].iter().any(|t| marked[t.at()]),
            };
        }
        self.pairs_among(
            self.root_pair(),
            |a, b| has[a as usize] || has[b as usize],
            |a, b| !(marked[a.at()] || marked[b.at()]) || visit(a, b),
        );
    }

    /// Divides a pair of nodes of which one has children: adds the pairs of these, last first. False where there are none.
    #[inline(always)]
    fn divide(&self, (a, b): NodePair, pairs: &mut Vec<NodePair>) -> bool {
        let (p, q) = (&self.nodes[a as usize], &self.nodes[b as usize]);
        if a == b {
            if p.count == 0 {
                let (l, r) = (p.first, p.first + 1);
                pairs.extend([(l, r), (r, r), (l, l)]);
            }
            return p.count == 0;
        }
        if !p.bounds.meets(&q.bounds) {
            return true;
        }
        match (p.count == 0, q.count == 0) {
            (true, true) => {
                let (l, r, m, s) = (p.first, p.first + 1, q.first, q.first + 1);
                pairs.extend([(r, s), (r, m), (l, s), (l, m)]);
            }
            (true, false) => pairs.extend([(p.first + 1, b), (p.first, b)]),
            (false, true) => pairs.extend([(a, q.first + 1), (a, q.first)]),
            (false, false) => return false,
        }
        true
    }

    /// Pairs below those pairs of nodes that are `wanted`, until `visit` returns false.
    fn pairs_among(
        &self,
        mut stack: Vec<NodePair>,
        wanted: impl Fn(u32, u32) -> bool,
        mut visit: impl FnMut(TriangleId, TriangleId) -> bool,
    ) {
        while let Some((a, b)) = stack.pop() {
            if !wanted(a, b) || self.divide((a, b), &mut stack) {
                continue;
            }
            let (p, q) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            let go_on = if a == b { self.pairs_in_leaf(p, &mut visit) } else { self.pairs_of_leaves(p, q, &mut visit) };
            if !go_on {
                return;
            }
        }
    }

    fn pairs_in_leaf(&self, p: &Node, visit: &mut impl FnMut(TriangleId, TriangleId) -> bool) -> bool {
        let range = p.first as usize..(p.first + p.count) as usize;
        for i in range.clone() {
            for j in i + 1..range.end {
                if self.boxes[i].meets(&self.boxes[j]) && !visit(self.ids[i], self.ids[j]) {
                    return false;
                }
            }
        }
        true
    }

    fn pairs_of_leaves(&self, p: &Node, q: &Node, visit: &mut impl FnMut(TriangleId, TriangleId) -> bool) -> bool {
        for i in p.first as usize..(p.first + p.count) as usize {
            if !self.boxes[i].meets(&q.bounds) {
                continue;
            }
            for j in q.first as usize..(q.first + q.count) as usize {
                if self.boxes[i].meets(&self.boxes[j]) && !visit(self.ids[i], self.ids[j]) {
                    return false;
                }
            }
        }
        true
    }

    /// Every triangle is in one leaf, every box within its parent's, no depth beyond the stack of a query.
    pub fn check(&self) -> Result<(), String> {
        let mut seen = vec![false; self.ids.len()];
        let mut stack = if self.nodes.is_empty() { vec![] } else { vec![(0usize, 1usize)] };
        while let Some((i, depth)) = stack.pop() {
            let node = &self.nodes[i];
            if depth + 1 >= STACK {
                return Err(format!("node {i} of the box hierarchy is too deep"));
            }
            let within = |b: &Box32| (0..3).all(|k| node.bounds.lo[k] <= b.lo[k] && b.hi[k] <= node.bounds.hi[k]);
            if node.count == 0 {
                for child in [node.first as usize, node.first as usize + 1] {
                    if child <= i || !within(&self.nodes[child].bounds) {
                        return Err(format!("node {child} of the box hierarchy is not within its parent"));
                    }
                    stack.push((child, depth + 1));
                }
                continue;
            }
            for k in node.first as usize..(node.first + node.count) as usize {
                if !within(&self.boxes[k]) || std::mem::replace(&mut seen[self.ids[k].at()], true) {
                    return Err(format!("triangle {} is misplaced in the box hierarchy", self.ids[k].0));
                }
            }
        }
        if seen.contains(&false) { Err("the box hierarchy misses a triangle".into()) } else { Ok(()) }
    }
}

//! Where the surface's points are in the lattice: one *slab* per axis (2r + 1: on plane r; 2r: between planes r − 1 and r; 0 and
//! 2n + 2: before and behind the block of n boxes). From here on nearly every question is an integer comparison.
//!
//! Mesh vertices get theirs from `cut::classify`; a point on a mesh edge from its place in the sorted row of the edge's
//! crossings: walking along the edge, every slab that is not passed is known. No coordinate is read.

use super::lattice::Lattice;
use crate::base::{Culprit, DefectKind, Error, Result, Status, VertexId};
use crate::cut::classify::{Classified, KnifeId, Knives, classify};
use crate::cut::edges::{EdgePoints, edge_points};
use crate::mesh::{EdgeUse, TriMesh};
use rayon::prelude::*;
use std::sync::Arc;

/// A slab per axis.
pub type Slabs = [u32; 3];

/// Whether a slab is a plane's.
#[inline(always)]
pub fn on_plane(slab: u32) -> bool {
    slab & 1 != 0
}

/// The first two stages: what is known of the mesh's vertices and edges.
#[derive(Debug, Default)]
pub struct Ground {
    pub mesh: Arc<TriMesh>,
    pub lattice: Lattice,
    pub knives: Knives,
    pub classified: Classified,
    pub points: EdgePoints,
    /// Of mesh vertices, then of points on mesh edges.
    pub slabs: Vec<Slabs>,
    /// The first knife of each axis; its planes follow one another by rising node.
    pub first_knife: [u32; 3],
}

impl Ground {
    pub fn new(mesh: &Arc<TriMesh>, lattice: &Lattice) -> Result<Self> {
        let planes = lattice.planes();
        let [low, high] = mesh.bbox;
        let max_abs = std::array::from_fn(|i| low[i].abs().max(high[i].abs()));
        let knives = Knives::new(&planes, max_abs);
        let first_knife = std::array::from_fn(|a| knives.knife_of[lattice.plane(a, 0).at()].0);
        debug_assert!((0..3).all(|a| {
            (0..lattice.nodes[a].len()).all(|r| {
                let k = knives.knife_of[lattice.plane(a, r).at()];
                k.0 == first_knife[a] + r as u32 && !knives.reversed[k.at()]
            })
        }));
        let mut classified = classify(mesh, &knives);
        let mut points = edge_points(mesh, &knives, &classified);
        // Read no more: the points and their slabs say it all.
        (classified.edge_crossings, points.rank) = Default::default();
        let mut ground = Ground {
            mesh: mesh.clone(),
            lattice: lattice.clone(),
            knives,
            classified,
            points,
            slabs: Vec::new(),
            first_knife,
        };
        ground.fill_slabs();
        Ok(ground)
    }

    pub fn first_edge_point(&self) -> u32 {
        self.mesh.vertices.len() as u32
    }
    pub fn first_inner_point(&self) -> u32 {
        self.first_edge_point() + self.points.edge.len() as u32
    }
    #[inline(always)]
    pub fn knife(&self, axis: usize, rank: u32) -> KnifeId {
        KnifeId(self.first_knife[axis] + rank)
    }
    /// The axis and rank of a knife.
    #[inline(always)]
    pub fn axis_of(&self, k: KnifeId) -> (usize, u32) {
        let mut best = (0, u32::MAX);
        for (a, first) in self.first_knife.into_iter().enumerate() {
            let rank = k.0.wrapping_sub(first);
            if rank < best.1 {
                best = (a, rank);
            }
        }
        best
    }
    /// The slab behind the last plane of an axis.
    #[inline(always)]
    pub fn behind(&self, axis: usize) -> u32 {
        2 * self.lattice.nodes[axis].len() as u32
    }
    /// Whether a point is in the block's closed box.
    #[inline(always)]
    pub fn in_block(&self, s: &Slabs) -> bool {
        (0..3).all(|a| s[a] != 0 && s[a] != self.behind(a))
    }

    fn fill_slabs(&mut self) {
        let family = self.first_knife.map(|k| self.knives.family[k as usize] as usize);
        let vertices = self.mesh.vertices.len();
        let mut slabs = vec![[0; 3]; vertices + self.points.edge.len()];
        let (of_vertices, of_points) = slabs.split_at_mut(vertices);
        let sides = &self.classified.sides;
        of_vertices.par_iter_mut().with_min_len(4096).enumerate().for_each(|(v, s)| {
            *s = family.map(|f| sides.slab(VertexId::of(v), f));
        });
        // Points of one edge follow one another; an edge's row starts from its lower vertex.
        let mut rest = of_points;
        for (e, &[a, b]) in self.mesh.edges.iter().enumerate() {
            let count = (self.points.first[e + 1] - self.points.first[e]) as usize;
            if count == 0 {
                continue;
            }
            let (row, after) = rest.split_at_mut(count);
            rest = after;
            let mut walk = Walk::new(of_vertices[a.at()], of_vertices[b.at()]);
            for (i, slot) in row.iter_mut().enumerate() {
                for &k in self.points.knives.row((self.points.first[e] as usize) + i) {
                    let (axis, rank) = self.axis_of(k);
                    walk.reach(axis, rank);
                }
                *slot = walk.here();
                walk.leave();
            }
        }
        self.slabs = slabs;
    }

    /// Whether every edge that meets the block's closed box is walked as often one way as the other. A patch of a mesh may have open edges
    /// elsewhere; here one means that a triangle is missing.
    pub fn require_balance(&self) -> Result<()> {
        let open = |uses: &[EdgeUse]| 2 * uses.iter().filter(|u| u.forward()).count() != uses.len();
        for (e, uses) in self.mesh.edge_uses.rows().enumerate() {
            if !open(uses) {
                continue;
            }
            let [a, b] = self.mesh.edges[e].map(|v| self.slabs[v.at()]);
            let mut walk = Walk::new(a, b);
            let mut meets = self.in_block(&a) || self.in_block(&b) || self.in_block(&walk.here());
            for p in self.points.first[e]..self.points.first[e + 1] {
                let s = self.slabs[(self.first_edge_point() + p) as usize];
                (0..3).filter(|&a| on_plane(s[a])).for_each(|a| walk.reach(a, s[a] / 2));
                meets |= self.in_block(&walk.here());
                walk.leave();
                meets |= self.in_block(&walk.here());
            }
            if meets {
                let [a, b] = self.mesh.edges[e].map(|v| self.mesh.vertex_source[v.at()] as i64);
                let triangle = uses[0].triangle.0 as i64;
                let culprit = Culprit::new(DefectKind::OpenEdge, &[a.min(b), a.max(b), triangle]);
                let message =
                    format!("edge ({}, {}) meets the block and is open: a triangle is missing", a.min(b), a.max(b));
                return Err(Error::with(Status::BadMesh, message, vec![culprit]));
            }
        }
        Ok(())
    }

    /// Slabs rise or fall strictly along an edge where its ends' do, and its points' sets are the planes they say.
    pub fn check(&self) -> std::result::Result<(), String> {
        for e in 0..self.mesh.edges.len() {
            for p in self.points.first[e]..self.points.first[e + 1] {
                let s = self.slabs[(self.first_edge_point() + p) as usize];
                let set: Vec<KnifeId> = (0..3).filter(|&a| on_plane(s[a])).map(|a| self.knife(a, s[a] / 2)).collect();
                let mut row = self.points.knives.row(p as usize).to_vec();
                row.sort_unstable_by_key(|&k| self.axis_of(k));
                if row != set {
                    return Err(format!("the slabs of point {p} on mesh edge {e} are not those of its planes"));
                }
            }
        }
        Ok(())
    }
}

/// Slabs along a straight walk from one point to another.
pub struct Walk {
    at: Slabs,
    to: Slabs,
}

impl Walk {
    /// Just beyond the start.
    #[inline(always)]
    pub fn new(from: Slabs, to: Slabs) -> Self {
        let mut walk = Walk { at: from, to };
        walk.leave();
        walk
    }
    /// The walk meets a plane.
    #[inline(always)]
    pub fn reach(&mut self, axis: usize, rank: u32) {
        self.at[axis] = 2 * rank + 1;
    }
    #[inline(always)]
    pub fn here(&self) -> Slabs {
        self.at
    }
    /// On from the planes just met, but for those that the walk stays in.
    #[inline(always)]
    pub fn leave(&mut self) {
        for a in 0..3 {
            if on_plane(self.at[a]) && self.at[a] != self.to[a] {
                self.at[a] = if self.to[a] > self.at[a] { self.at[a] + 1 } else { self.at[a] - 1 };
            }
        }
    }
}

//! The input: a closed triangle mesh from flat arrays, its adjacency, its defects by name, its shells and how
//! they nest.

pub mod build;
pub mod bvh;
pub mod edges;
pub mod inside;
pub mod nesting;
pub mod projection;
pub mod ray;
pub mod self_intersection;
pub mod shells;
pub mod update;
pub mod validate;
pub mod volume;

pub use build::{MeshInput, MeshOptions, build, build_patch};
pub use inside::{Place, locate};
pub use nesting::next_anchor;
pub use shells::{WedgeScratch, wedge_mates};
pub use update::update_coordinates;

use crate::base::{ComponentId, Csr, EdgeId, ShellId, TriangleId, VertexId};

/// One use of an edge by a triangle: the triangle, which of its sides (side k joins corners k and k+1), and
/// whether the triangle walks the edge from its lower vertex to its higher one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct EdgeUse {
    pub triangle: TriangleId,
    /// `side | forward << 2`
    pub code: u8,
}

impl EdgeUse {
    pub fn new(triangle: TriangleId, side: usize, forward: bool) -> Self {
        Self { triangle, code: side as u8 | (forward as u8) << 2 }
    }
    #[inline(always)]
    pub fn side(self) -> usize {
        (self.code & 3) as usize
    }
    #[inline(always)]
    pub fn forward(self) -> bool {
        self.code & 4 != 0
    }
}

/// A shell of the surface: triangles connected through wedges of solid (two triangles at an edge belong
/// together when the wedge between them is inside). Two solids that share an edge are two shells.
#[derive(Clone, Debug)]
pub struct Shell {
    /// A triangle of the shell, the lowest.
    pub triangle: TriangleId,
    /// The edge-connected component of the surface that it belongs to.
    pub component: ComponentId,
    /// Encloses solid (true) or is the wall of a void (false).
    pub outer: bool,
    /// For a void: how it hangs in the solid around it.
    pub anchor: Option<Anchor>,
}

/// The segment from a void's wall through solid to the first surface it meets: from the point of `from` with
/// barycentric weights 1 : k : k² over its corners `order[0]`, `order[1]`, `order[2]`, along `axis` in direction
/// `positive`, to the interior of triangle `hit`. Anchors form a tree: from void to void they lead to an outer shell.
#[derive(Clone, Copy, Debug)]
pub struct Anchor {
    pub from: TriangleId,
    /// Nearly always 0, 1, 2.
    pub order: [u8; 3],
    pub k: u32,
    pub axis: usize,
    pub positive: bool,
    pub hit: TriangleId,
}

/// A closed, valid triangle mesh. Made by [`build`]; only [`update_coordinates`] changes it.
#[derive(Clone, Debug, Default)]
pub struct TriMesh {
    /// Vertices that triangles use, in input order.
    pub vertices: Vec<[f64; 3]>,
    /// The input index of each vertex (merged duplicates: the lowest).
    pub vertex_source: Vec<u32>,
    pub triangles: Vec<[VertexId; 3]>,
    /// One tag per triangle, or empty.
    pub tags: Vec<i32>,
    /// Lower vertex first; sorted.
    pub edges: Vec<[VertexId; 2]>,
    /// Side k joins corners k and k+1 (mod 3).
    pub triangle_edges: Vec<[EdgeId; 3]>,
    /// The uses of each edge, by triangle id.
    pub edge_uses: Csr<EdgeUse>,
    /// The shell of each triangle.
    pub triangle_shell: Vec<ShellId>,
    pub shells: Vec<Shell>,
    pub component_count: usize,
    /// Lowest and highest corner of the bounding box.
    pub bbox: [[f64; 3]; 2],
}

impl TriMesh {
    #[inline(always)]
    pub fn corners(&self, t: TriangleId) -> [[f64; 3]; 3] {
        let [a, b, c] = self.triangles[t.at()];
        [self.vertices[a.at()], self.vertices[b.at()], self.vertices[c.at()]]
    }

    /// What [`build`] promises: sorted adjacency that matches the triangles, balanced edges, vertices all used and within
    /// the bounding box, shells numbered by lowest triangle within one component, and an anchor tree for voids.
    pub fn check(&self) -> Result<(), String> {
        edges::check_edges(&self.triangles, &self.edges, &self.triangle_edges, &self.edge_uses)?;
        let balance = |uses: &[EdgeUse]| 2 * uses.iter().filter(|u| u.forward()).count() == uses.len();
        if let Some(e) = self.edge_uses.rows().position(|uses| !balance(uses)) {
            return Err(format!("edge {e} is not balanced"));
        }
        let mut used = vec![false; self.vertices.len()];
        self.triangles.iter().flatten().for_each(|v| used[v.at()] = true);
        if used.contains(&false) || self.vertex_source.len() != self.vertices.len() {
            return Err("a vertex is not used or has no source".into());
        }
        if self.vertex_source.windows(2).any(|w| w[0] >= w[1]) {
            return Err("vertices are not in input order".into());
        }
        let [lo, hi] = self.bbox;
        if self.vertices.iter().any(|x| (0..3).any(|i| !(lo[i] <= x[i] && x[i] <= hi[i]))) {
            return Err("a vertex is outside the bounding box".into());
        }
        if self.triangle_shell.len() != self.triangles.len()
            || !(self.tags.is_empty() || self.tags.len() == self.triangles.len())
        {
            return Err("lengths differ".into());
        }
        self.check_shells()
    }

    fn check_shells(&self) -> Result<(), String> {
        let mut next = 0;
        for (t, s) in self.triangle_shell.iter().enumerate() {
            if s.at() == next {
                if self.shells.get(next).is_none_or(|s| s.triangle != TriangleId::of(t)) {
                    return Err(format!("shell {next} does not start at triangle {t}"));
                }
                next += 1;
            } else if s.at() > next {
                return Err(format!("shell {} is numbered too early", s.0));
            }
        }
        if next != self.shells.len() || self.shells.iter().any(|s| s.component.at() >= self.component_count) {
            return Err("the number of shells or components is wrong".into());
        }
        for start in 0..self.shells.len() {
            let mut s = start;
            let mut steps = 0;
            while !self.shells[s].outer {
                let Some(anchor) = self.shells[s].anchor else { return Err(format!("void {s} has no anchor")) };
                if self.triangle_shell[anchor.from.at()].at() != s {
                    return Err(format!("the anchor of void {s} starts elsewhere"));
                }
                s = self.triangle_shell[anchor.hit.at()].at();
                steps += 1;
                if steps > self.shells.len() {
                    return Err(format!("the anchors from void {start} go in a circle"));
                }
            }
        }
        Ok(())
    }
}

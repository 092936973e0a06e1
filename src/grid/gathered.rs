//! What sums over cells and faces read, gathered before anything is computed: the arrays it comes from are in another order, so that each
//! look-up is likely to miss the cache; in loops of nothing else, many misses overlap.

use super::data::GridCells;
use super::fixed_point::{Framing, Interval, Spot};
use super::wall_sums::Normal;
use crate::base::processor::prefetch;
use crate::base::{FaceId, TriangleId, VertexId};

/// Coordinates and residual of a vertex. Without a branch on its kind: that would be mispredicted half the time, and then the
/// look-ups that follow wait.
#[inline(always)]
pub fn position(g: &GridCells, v: VertexId) -> ([f64; 3], [f64; 3]) {
    let i = v.0.wrapping_sub(g.constructed.start) as usize;
    let there = i < g.residuals.len();
    let r = g.residuals.get(if there { i } else { 0 }).copied().unwrap_or_default();
    let weight = f64::from(there as u8);
    (g.coords[v.at()], r.map(|r| r * weight))
}

/// Asks for what [`position`] will read.
#[inline(always)]
pub fn prefetch_position(g: &GridCells, v: VertexId) {
    prefetch(&g.coords, v.at());
    // For a vertex without a residual the address is another's, or none; that does no harm.
    prefetch(&g.residuals, v.0.wrapping_sub(g.constructed.start) as usize);
}

/// Coordinates and residual in the lanes of [`Spot`]s.
type Raw<const N: usize> = ([f64; N], [f64; N]);

/// The walls of some boxes with their corners' places.
#[derive(Default)]
pub struct Gathered {
    /// Wall `w` has corners `offsets[w]..offsets[w + 1]`.
    offsets: Vec<u32>,
    spots: Vec<Spot<4>>,
    starts: Vec<[u32; 2]>,
    vertices: Vec<VertexId>,
    raw: Vec<Raw<4>>,
}

impl Gathered {
    pub fn clear(&mut self) {
        self.offsets.clear();
        self.offsets.push(0);
        self.spots.clear();
        self.starts.clear();
        self.vertices.clear();
        self.raw.clear();
    }
    /// The number of walls that are there.
    pub fn len(&self) -> usize {
        self.starts.len()
    }
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }
    /// Takes a wall, which has one loop, so that loop and face have the same number.
    #[inline(always)]
    pub fn push(&mut self, g: &GridCells, f: FaceId) {
        self.starts.push([g.loop_offsets[f.at()], g.loop_offsets[f.at() + 1]]);
    }
    /// To be called when all walls are there.
    #[inline(always)]
    pub fn corners(&mut self, g: &GridCells) {
        for &[from, to] in &self.starts {
            // A few at a time: a call to copy them would cost more.
            for &v in &g.corners[from as usize..to as usize] {
                self.vertices.push(v);
            }
            self.offsets.push(self.vertices.len() as u32);
        }
    }
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }
    /// To be called then, before [`place`](Self::place).
    #[inline(always)]
    pub fn positions(&mut self, g: &GridCells) {
        for &v in &self.vertices {
            let ([x, y, z], [p, q, r]) = position(g, v);
            self.raw.push(([x, y, z, 0.0], [p, q, r, 0.0]));
        }
    }
    /// Places of the next walls, up to wall `end`, in a box.
    #[inline(always)]
    pub fn place(&mut self, frame: &[&Interval; 3], end: usize) {
        let framing = Framing::of(frame);
        let raw = &self.raw[self.spots.len()..self.offsets[end] as usize];
        for (x, r) in raw {
            self.spots.push(framing.spot(x, r));
        }
    }
    #[inline(always)]
    pub fn wall(&self, w: usize) -> &[Spot<4>] {
        &self.spots[self.offsets[w] as usize..self.offsets[w + 1] as usize]
    }
}

/// Normals of walls, next to a [`Gathered`] of the same.
pub fn normals_of(g: &GridCells, normals: &[Normal], faces: impl Iterator<Item = FaceId>, out: &mut Vec<Normal>) {
    let triangle = |f: FaceId| -> TriangleId { g.wall_triangle[f.at()] };
    out.clear();
    out.extend(faces.map(|f| normals[triangle(f).at()]));
}

/// Some faces in planes normal to one axis, with their corners' places along the other two.
#[derive(Default)]
pub struct GatheredFaces {
    vertices: Vec<VertexId>,
    raw: Vec<Raw<2>>,
    spots: Vec<Spot<2>>,
}

impl GatheredFaces {
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.raw.clear();
        self.spots.clear();
    }
    #[inline(always)]
    pub fn push(&mut self, g: &GridCells, f: FaceId) {
        for &v in g.face_corners(f) {
            self.vertices.push(v);
        }
    }
    /// To be called when all faces are there.
    #[inline(always)]
    pub fn positions(&mut self, g: &GridCells, [b, c]: [usize; 2]) {
        for &v in &self.vertices {
            let (x, r) = position(g, v);
            self.raw.push(([x[b], x[c]], [r[b], r[c]]));
        }
    }
    /// Places of the next face, which has so many corners.
    #[inline(always)]
    pub fn place(&mut self, frames: [&Interval; 2], count: usize) -> &[Spot<2>] {
        let framing = Framing::of(&frames);
        let from = self.spots.len();
        for (x, r) in &self.raw[from..from + count] {
            self.spots.push(framing.spot(x, r));
        }
        &self.spots[from..]
    }
}

//! Half-face adjacency, on demand: for each half-face and each of its sides, the half-face and side across that edge
//! in the same cell (the two walls of a wedge).
//!
//! Within an edge, a cell with exactly two uses has one wedge there and
//! topology answers; only a cell that is met more than once around one edge needs the radial order, which is
//! taken from the normals ([`super::radial`]).
//! Degenerate cases: a slit is one face using an edge twice (the face is its own mate); an isolated vertex has no edge
//! and no mate; half-faces outside the solid have no mates. Cost: linear, plus the radial order of ambiguous edges.

use super::data::{Complex, HalfFace};
use super::radial::{EdgeUses, wedge_pairs};
use crate::base::{CellId, EdgeId, FaceId};

/// One side of one corner: `corner << 1 | front`, the side from the corner to the next of its loop as a wall of the
/// cell behind (back) or before (front) the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct HalfCorner(pub u32);

impl HalfCorner {
    /// No mate: an isolated vertex, or outside the solid.
    pub const NONE: Self = Self(u32::MAX);

    #[inline(always)]
    pub fn new(corner: usize, front: bool) -> Self {
        Self((corner as u32) << 1 | front as u32)
    }
    /// The corner's position in `corner_vertices` and `corner_edges`.
    #[inline(always)]
    pub fn corner(self) -> usize {
        (self.0 >> 1) as usize
    }
    #[inline(always)]
    pub fn front(self) -> bool {
        self.0 & 1 != 0
    }
    #[inline(always)]
    pub fn at(self) -> usize {
        self.0 as usize
    }
    #[inline(always)]
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }
}

/// See [`adjacency`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Adjacency {
    /// `mates[h.at()]` is the half-corner across the edge of `h` in the same cell, `NONE` without edge or cell.
    pub mates: Vec<HalfCorner>,
    /// The face of each corner.
    pub corner_face: Vec<FaceId>,
    /// The next corner of the loop of each corner.
    pub corner_next: Vec<u32>,
}

impl Adjacency {
    pub fn half_face(&self, h: HalfCorner) -> HalfFace {
        HalfFace::new(self.corner_face[h.corner()], h.front())
    }
}

/// The face of each corner.
pub fn corner_faces(c: &Complex) -> Vec<FaceId> {
    let mut faces = vec![FaceId::NONE; c.corner_vertices.len()];
    for f in (0..c.face_count()).map(FaceId::of) {
        faces[c.face_corners(f)].fill(f);
    }
    faces
}

/// The next corner of the loop of each corner.
pub fn corner_nexts(c: &Complex) -> Vec<u32> {
    let mut next: Vec<u32> = (1..=c.corner_vertices.len() as u32).collect();
    for w in c.loop_offsets.windows(2) {
        if w[1] > w[0] {
            next[w[1] as usize - 1] = w[0];
        }
    }
    next
}

/// The mates of all half-corners. An error where the complex contradicts itself (an edge with an odd number of uses in a
/// cell, or coplanar faces on the same side of an edge), which only an input that intersects itself can cause.
pub fn adjacency(c: &Complex) -> Result<Adjacency, String> {
    let corner_face = corner_faces(c);
    let corner_next = corner_nexts(c);
    let mut mates = vec![HalfCorner::NONE; 2 * c.corner_vertices.len()];
    let uses = EdgeUses::new(c);
    let (mut row, mut walls, mut scratch) = (Vec::new(), Vec::<(CellId, HalfCorner)>::new(), Vec::new());
    for e in (0..c.edge_count()).map(EdgeId::of) {
        uses.row(c, e, &mut row);
        walls.clear();
        for u in &row {
            for front in [false, true] {
                let cell = c.face_cells[u.face.at()][front as usize];
                if cell.is_some() {
                    walls.push((cell, HalfCorner::new(u.corner as usize, front)));
                }
            }
        }
        walls.sort_unstable();
        let mut ambiguous = false;
        for run in walls.chunk_by(|a, b| a.0 == b.0) {
            match run {
                [(_, a), (_, b)] => {
                    mates[a.at()] = *b;
                    mates[b.at()] = *a;
                }
                _ if run.len() % 2 != 0 => {
                    return Err(format!("edge {}: cell {} uses it {} times", e.0, run[0].0.0, run.len()));
                }
                _ => ambiguous = true,
            }
        }
        if ambiguous {
            wedge_pairs(c, e, &row, None, &mut scratch, |i, a, j, b| {
                let of = |i: u32, h: HalfFace| HalfCorner::new(row[i as usize].corner as usize, h.front());
                mates[of(i, a).at()] = of(j, b);
                mates[of(j, b).at()] = of(i, a);
            })
            .map_err(|e| e.message)?;
        }
    }
    Ok(Adjacency { mates, corner_face, corner_next })
}

//! Half-face adjacency, on demand: for each half-face and each of its sides, the half-face and side across that edge
//! in the same cell (the two walls of a wedge).
//!
//! The uses of each edge come from a counting sort. Within an edge, a cell with exactly two uses has one wedge there and
//! topology answers; only a cell that is met more than once around one edge needs the radial order, which is
//! taken from the normals alone (DESIGN §11).
//! Degenerate cases: a slit is one face using an edge twice (the face is its own mate); an isolated vertex has no edge
//! and no mate; half-faces outside the solid have no mates. Cost: linear, plus the radial order of ambiguous edges.

use super::data::{Complex, HalfFace, SupportId};
use super::projection::compare_axis;
use crate::base::{CellId, EdgeId, FaceId, VertexId};
use crate::exact::{self, Direction, Sign};
use std::cmp::Ordering;

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

/// One use of an edge: a corner whose side is the edge.
#[derive(Clone, Copy, Debug)]
pub struct Use {
    pub corner: u32,
    pub face: FaceId,
    /// The face walks the edge from its first vertex to its second.
    pub forward: bool,
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
    let uses = crate::base::Csr::from_pairs(
        c.edge_count(),
        c.corner_edges.iter().enumerate().filter(|(_, e)| e.is_some()).map(|(k, e)| (e.at(), k as u32)),
    );
    let mut walls: Vec<(CellId, HalfCorner)> = Vec::new();
    let mut here: Vec<Use> = Vec::new();
    let mut pairs = Vec::new();
    for e in (0..c.edge_count()).map(EdgeId::of) {
        walls.clear();
        for &k in uses.row(e) {
            let cells = c.face_cells[corner_face[k as usize].at()];
            for front in [false, true] {
                if cells[front as usize].is_some() {
                    walls.push((cells[front as usize], HalfCorner::new(k as usize, front)));
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
            here.clear();
            here.extend(uses.row(e).iter().map(|&corner| Use {
                corner,
                face: corner_face[corner as usize],
                forward: c.corner_vertices[corner as usize] == c.edges[e.at()][0],
            }));
            pairs.clear();
            wedge_pairs(c, e, &here, &mut pairs)?;
            for &(a, b) in &pairs {
                mates[a.at()] = b;
                mates[b.at()] = a;
            }
        }
    }
    Ok(Adjacency { mates, corner_face, corner_next })
}

/// The normal of a face's support, as a direction.
pub fn face_normal(c: &Complex, f: FaceId) -> Direction {
    match c.face_support[f.at()] {
        SupportId::Plane(p) => Direction::Plane(c.planes[p.at()].n),
        SupportId::Triangle(t) => Direction::Triangle(c.mesh.corners(t)),
    }
}

/// Sign of the axis `e` (first to second vertex) along a × b, for two supports through the edge that are not
/// parallel: the edge is parallel to a × b, so one coordinate in which that is not zero decides.
fn along_cross(c: &Complex, e: EdgeId, a: &Direction, b: &Direction) -> Sign {
    for axis in 0..3 {
        let mut unit = [0.0; 3];
        unit[axis] = 1.0;
        let s = exact::determinant(a, b, &Direction::Plane(unit));
        if s != Sign::Zero {
            let [p, q]: [VertexId; 2] = c.edges[e.at()];
            return match compare_axis(c, p, q, axis) {
                Ordering::Less => s,
                Ordering::Greater => -s,
                Ordering::Equal => Sign::Zero,
            };
        }
    }
    Sign::Zero
}

/// Pairs the walls of each wedge around an edge: all uses in radial order, then each with its successor.
///
/// A use with support normal n that walks the edge forward lies in the half-plane n × d of the axis d; backward, in −n × d.
/// So the half-planes are in the order of the vectors m = ±n about d, and m points counter-clockwise from its
/// half-plane: the front of a forward use and the back of a backward use look counter-clockwise.
pub fn wedge_pairs(
    c: &Complex,
    e: EdgeId,
    uses: &[Use],
    pairs: &mut Vec<(HalfCorner, HalfCorner)>,
) -> Result<(), String> {
    let normals: Vec<Direction> = uses.iter().map(|u| face_normal(c, u.face)).collect();
    let flip = |i: usize, s: Sign| if uses[i].forward { s } else { -s };
    let parallel =
        |i: usize, j: usize| exact::cross_dot_cross(&normals[i], &normals[j], &normals[i], &normals[j]) == Sign::Zero;
    // The axis, as the cross product of the first use's normal and some other's, times a sign.
    let other = (1..uses.len()).find(|&j| !parallel(0, j));
    let along = other.map_or(Sign::Positive, |j| along_cross(c, e, &normals[0], &normals[j]));
    // Sign of the sine of the angle from m_i to m_j about the axis.
    let sine = |i: usize, j: usize| match other {
        None => Sign::Zero,
        Some(r) => {
            let s = exact::cross_dot_cross(&normals[i], &normals[j], &normals[0], &normals[r]) * along;
            flip(i, flip(j, s))
        }
    };
    let same = |i: usize, j: usize| flip(i, flip(j, exact::dot(&normals[i], &normals[j]))) == Sign::Positive;
    // Place of j's angle from use 0: 0 = the same, 1 = below half a turn, 2 = half a turn, 3 = above.
    let half = |j: usize| match sine(0, j) {
        Sign::Positive => 1,
        Sign::Negative => 3,
        Sign::Zero if same(0, j) => 0,
        Sign::Zero => 2,
    };
    let halves: Vec<u8> = (0..uses.len()).map(half).collect();
    let mut order: Vec<usize> = (0..uses.len()).collect();
    // Insertion: few uses, and contradictory answers can neither hang nor panic.
    for at in 1..order.len() {
        let mut k = at;
        while k > 0 {
            let (a, b) = (order[k - 1], order[k]);
            if halves[a] < halves[b] || halves[a] == halves[b] && sine(a, b) != Sign::Negative {
                break;
            }
            order.swap(k - 1, k);
            k -= 1;
        }
    }
    for (at, &a) in order.iter().enumerate() {
        let b = order[(at + 1) % order.len()];
        if a != b && sine(a, b) == Sign::Zero && same(a, b) {
            return Err(format!("edge {}: faces {} and {} overlap there", e.0, uses[a].face.0, uses[b].face.0));
        }
        let ahead = HalfCorner::new(uses[a].corner as usize, uses[a].forward);
        let behind = HalfCorner::new(uses[b].corner as usize, !uses[b].forward);
        let cell = |h: HalfCorner, f: FaceId| c.face_cells[f.at()][h.front() as usize];
        let (x, y) = (cell(ahead, uses[a].face), cell(behind, uses[b].face));
        if x != y {
            return Err(format!(
                "edge {}: the wedge between faces {} and {} belongs to two cells",
                e.0, uses[a].face.0, uses[b].face.0
            ));
        }
        if x.is_some() {
            pairs.push((ahead, behind));
        }
    }
    Ok(())
}

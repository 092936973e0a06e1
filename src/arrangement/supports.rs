//! What a triangle id stands for, and half-spaces among operands.
//!
//! A half-space n·x + d < 0 has no corners in doubles, and needs none: exact predicates ask supports. The part of its plane within the bounds (a box) is a
//! *sheet*. Sheets have triangle ids behind those of the soup's triangles, so that they are members of clusters, carriers of segments and births like
//! triangles; who asks for geometry asks here. A sheet has no edges of its own: its outline is where the box's triangles meet its plane.
//!
//! The operand of a half-space is the boundary of what it has in common with the box: its sheet, and those parts of the box's sides that are in it. The
//! box's twelve triangles are there once for each half-space, so that parts have births in every one; all but the first twelve are *passive*: nothing
//! asks for them before [`super::clip`] deals out the parts of the first ones.
//!
//! Of coincident planes (equal or opposite) the lowest stands for all where points and segments are named; the others lie on it.

use super::Soup;
use crate::base::{OperandId, PlaneId, TriangleId};
use crate::complex::Origin;
use crate::complex::data::origin_point;
use crate::exact::{Direction, Plane, Point, Sign, Support};
use crate::mesh::projection;

/// The triangles of a box.
pub const BOX: usize = 12;

/// Half-spaces, which are operands behind the meshes, and the box that bounds them all.
#[derive(Clone, Debug, Default)]
pub struct HalfSpaces {
    /// Where n·x + d < 0.
    pub planes: Vec<Plane>,
    /// The lowest of the planes that coincide with each.
    pub stands: Vec<PlaneId>,
    /// Lowest and highest corner of the box.
    pub bounds: [[f64; 3]; 2],
    /// How many operands come before.
    pub meshes: usize,
}

/// Sides of the box: corners are numbered by bits for x, y, z; outward.
pub const BOX_TRIANGLES: [[i32; 3]; BOX] = [
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
];

/// The corners of a box.
pub fn box_corners(bounds: &[[f64; 3]; 2]) -> [[f64; 3]; 8] {
    std::array::from_fn(|i| std::array::from_fn(|axis| bounds[i >> axis & 1][axis]))
}

impl Soup {
    pub fn planes(&self) -> &[Plane] {
        &self.half_spaces.planes
    }

    /// The plane of a sheet.
    #[inline(always)]
    pub fn sheet(&self, t: TriangleId) -> Option<PlaneId> {
        t.at().checked_sub(self.mesh.triangles.len()).map(PlaneId::of)
    }

    #[inline(always)]
    pub fn sheet_of(&self, p: PlaneId) -> TriangleId {
        TriangleId::of(self.mesh.triangles.len() + p.at())
    }

    /// Of half-space `i`, the place of its first box triangle.
    fn box_start(&self, i: usize) -> usize {
        self.first_triangle[self.half_spaces.meshes + i] as usize
    }

    /// The side of the box, 0 to 11, that a triangle of the first half-space is.
    #[inline(always)]
    pub fn box_side(&self, t: TriangleId) -> Option<usize> {
        if self.planes().is_empty() {
            return None;
        }
        t.at().checked_sub(self.box_start(0)).filter(|k| *k < BOX)
    }

    /// A side of the box as a triangle of half-space `i`.
    pub fn box_triangle(&self, i: usize, side: usize) -> TriangleId {
        TriangleId::of(self.box_start(i) + side)
    }

    /// A box triangle that is there to be named only.
    #[inline(always)]
    pub fn is_passive(&self, t: TriangleId) -> bool {
        self.planes().len() > 1 && t.at() >= self.box_start(1) && t.at() < self.mesh.triangles.len()
    }

    #[inline]
    pub fn support(&self, t: TriangleId) -> Support {
        match self.sheet(t) {
            None => Support::Triangle(self.mesh.corners(t)),
            Some(p) => Support::Plane(self.planes()[p.at()]),
        }
    }

    pub fn direction(&self, t: TriangleId) -> Direction {
        match self.sheet(t) {
            None => Direction::Triangle(self.mesh.corners(t)),
            Some(p) => Direction::Plane(self.planes()[p.at()].n),
        }
    }

    /// How a triangle or sheet turns, seen along an axis: counterclockwise where its normal points along it.
    #[inline]
    pub fn turn_along(&self, t: TriangleId, axis: usize) -> Sign {
        match self.sheet(t) {
            None => {
                let [a, b, c] = self.mesh.corners(t);
                projection::turn(&a, &b, &c, axis)
            }
            Some(p) => Sign::of(self.planes()[p.at()].n[axis]),
        }
    }

    /// An axis along which a triangle or sheet is seen with area, and how it turns there.
    #[inline]
    pub fn open_axis(&self, t: TriangleId) -> (usize, Sign) {
        match self.sheet(t) {
            None => projection::open_axis(&self.mesh.corners(t)),
            Some(p) => {
                let n = &self.planes()[p.at()].n;
                let axis = (1..3).fold(0, |best, i| if n[i].abs() > n[best].abs() { i } else { best });
                (axis, Sign::of(n[axis]))
            }
        }
    }

    /// The exact point that an origin names.
    #[inline]
    pub fn point(&self, origin: Origin) -> Point {
        origin_point(&self.mesh, self.planes(), origin)
    }

    /// The operand that a triangle or sheet belongs to.
    pub fn operand(&self, t: TriangleId) -> OperandId {
        match self.sheet(t) {
            None => OperandId::of(self.first_triangle.partition_point(|&first| first <= t.0) - 1),
            Some(p) => OperandId::of(self.half_spaces.meshes + p.at()),
        }
    }

    /// The place of a triangle in its operand's list; of a half-space the sides of the box are 0 to 11, the sheet is 12.
    pub fn place(&self, t: TriangleId) -> u32 {
        self.source.get(t.at()).map_or(BOX as u32, |place| *place)
    }

    /// For each triangle its number where the triangles of all operands, as they were given, count one behind the other; a half-space counts
    /// thirteen.
    pub fn given(&self) -> Vec<u32> {
        let (mut first, mut given) = (0, Vec::with_capacity(self.source.len()));
        for (i, (range, dropped)) in self.first_triangle.windows(2).zip(&self.dropped).enumerate() {
            given.extend(self.source[range[0] as usize..range[1] as usize].iter().map(|s| first + s));
            first += range[1] - range[0] + dropped + (!self.planes().is_empty() && i >= self.half_spaces.meshes) as u32;
        }
        given
    }
}

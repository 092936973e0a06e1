//! A block of a rectilinear grid: three rising arrays of node coordinates, and where they are in the whole grid. The coordinates
//! are the only truth about where planes are; nothing is recomputed from a spacing.

use super::touched::others;
use crate::base::{BoxId, Error, NodeId, PlaneId, Result, SquareId, Status};
use crate::exact::Plane;

/// A block of a grid: `counts[a]` boxes along axis `a`, between `counts[a] + 1` nodes. Indices are local to the block; x runs
/// fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lattice {
    /// The block's node coordinates, strictly rising.
    pub nodes: [Vec<f64>; 3],
    /// The index of the block's first node in the whole grid, and the number of nodes there.
    pub first: [i64; 3],
    pub total: [i64; 3],
}

impl Lattice {
    /// The block of boxes `low[a]..high[a]` of a grid with the given nodes.
    ///
    /// Errors: `BadArgument` if an axis has fewer than two nodes or nodes that are not finite or do not rise, or if the block is empty
    /// or outside; `TooLarge` if its nodes are too many for 32-bit ids.
    pub fn new(nodes: [&[f64]; 3], low: [i64; 3], high: [i64; 3]) -> Result<Self> {
        let mut lattice = Lattice::default();
        for a in 0..3 {
            let count = nodes[a].len();
            let bad = |message: String| Err(Error::new(Status::BadArgument, message));
            let name = ["x", "y", "z"][a];
            if count < 2 {
                return bad(format!("the grid has {count} nodes along {name}: at least 2 are needed"));
            }
            if let Some(i) = nodes[a].iter().position(|x| !x.is_finite()) {
                return bad(format!("node {i} along {name} is not finite"));
            }
            if let Some(i) = nodes[a].windows(2).position(|w| w[0] >= w[1]) {
                return bad(format!("nodes {i} and {} along {name} do not rise", i + 1));
            }
            if low[a] < 0 || low[a] >= high[a] || high[a] >= count as i64 {
                let boxes = count - 1;
                return bad(format!(
                    "boxes {}..{} along {name} are not a block of the grid's {boxes}",
                    low[a], high[a]
                ));
            }
            // −0 becomes +0, so that equal coordinates have equal bits.
            lattice.nodes[a] = nodes[a][low[a] as usize..=high[a] as usize].iter().map(|x| x + 0.0).collect();
            lattice.first[a] = low[a];
            lattice.total[a] = count as i64;
        }
        let count = lattice.nodes.iter().map(|n| n.len() as u128).product::<u128>();
        if count >= i32::MAX as u128 {
            return Err(Error::new(Status::TooLarge, format!("{count} nodes are more than 32-bit ids can number")));
        }
        Ok(lattice)
    }

    /// Number of boxes along an axis.
    #[inline(always)]
    pub fn count(&self, axis: usize) -> usize {
        self.nodes[axis].len() - 1
    }
    /// Number of nodes along each axis.
    pub fn node_counts(&self) -> [usize; 3] {
        [self.nodes[0].len(), self.nodes[1].len(), self.nodes[2].len()]
    }
    pub fn box_count(&self) -> usize {
        self.count(0) * self.count(1) * self.count(2)
    }
    #[inline(always)]
    pub fn box_id(&self, [i, j, k]: [usize; 3]) -> BoxId {
        BoxId((i + self.count(0) * (j + self.count(1) * k)) as u32)
    }
    #[inline(always)]
    pub fn box_at(&self, b: BoxId) -> [usize; 3] {
        let (nx, ny) = (self.count(0), self.count(1));
        let row = b.at() / nx;
        [b.at() - row * nx, row % ny, row / ny]
    }
    #[inline(always)]
    pub fn node_id(&self, [i, j, k]: [usize; 3]) -> NodeId {
        let (nx, ny) = (self.nodes[0].len(), self.nodes[1].len());
        NodeId((i + nx * (j + ny * k)) as u32)
    }
    #[inline(always)]
    pub fn node_at(&self, n: NodeId) -> [usize; 3] {
        let (nx, ny) = (self.nodes[0].len(), self.nodes[1].len());
        let row = n.at() / nx;
        [n.at() - row * nx, row % ny, row / ny]
    }
    /// Number of squares of a plane normal to an axis.
    pub fn square_count(&self, axis: usize) -> usize {
        others(axis).map(|a| self.count(a)).iter().product()
    }
    /// The square of a plane normal to `axis` in the given layers of the other two axes.
    #[inline(always)]
    pub fn square_id(&self, axis: usize, [fast, slow]: [usize; 2]) -> SquareId {
        SquareId((fast + self.count(others(axis)[0]) * slow) as u32)
    }
    /// The layers of a square.
    #[inline(always)]
    pub fn square_at(&self, axis: usize, square: SquareId) -> [usize; 2] {
        let n = self.count(others(axis)[0]) as u32;
        [(square.0 % n) as usize, (square.0 / n) as usize]
    }
    /// The low and high corner of a box.
    pub fn corners(&self, b: BoxId) -> [[f64; 3]; 2] {
        let at = self.box_at(b);
        [0, 1].map(|d| std::array::from_fn(|a| self.nodes[a][at[a] + d]))
    }
    /// The id of the plane through the given node of an axis: x's planes first, then y's, then z's.
    #[inline(always)]
    pub fn plane(&self, axis: usize, node: usize) -> PlaneId {
        let before: usize = self.nodes[..axis].iter().map(Vec::len).sum();
        PlaneId::of(before + node)
    }
    /// The axis and node of a plane.
    #[inline(always)]
    pub fn plane_at(&self, p: PlaneId) -> (usize, usize) {
        let mut node = p.at();
        for axis in 0..2 {
            if node < self.nodes[axis].len() {
                return (axis, node);
            }
            node -= self.nodes[axis].len();
        }
        (2, node)
    }
    /// The id of a plane in the whole grid.
    pub fn global_plane(&self, p: PlaneId) -> i64 {
        let (axis, node) = self.plane_at(p);
        self.total[..axis].iter().sum::<i64>() + self.first[axis] + node as i64
    }
    /// All planes, normals along the axes.
    pub fn planes(&self) -> Vec<Plane> {
        let plane = |a: usize, x: f64| Plane { n: std::array::from_fn(|i| (i == a) as u8 as f64), d: 0.0 - x };
        (0..3).flat_map(|a| self.nodes[a].iter().map(move |&x| plane(a, x))).collect()
    }
}

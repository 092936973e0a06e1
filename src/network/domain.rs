//! The domain of a network: a box of cubes given by its dimensions alone, five tetrahedra a cube, nothing stored; or a
//! conforming mesh of tetrahedra or of triangles in the plane ([`TetMesh`]).
//!
//! A cube is split into a tetrahedron at each of its four *even* corners (i + j + k even), spanned by the corner and its three
//! neighbours, and the inner tetrahedron of its four odd corners. So cubes side by side agree: the diagonal of a face of
//! a cube joins its two odd corners.
//!
//! Invariant: simplices of a box are positively oriented, det(b − a, c − a, d − a) > 0; those of a mesh may have either
//! orientation, which is known exactly. *Facet* i of a simplex is the one without corner i.

use super::tet_mesh::TetMesh;
use crate::base::{Error, NodeId, Result, Status, TetId};
use crate::exact::Sign;

/// Simplices of a domain fill less than this, nodes too: two bits of an id are left for tags.
pub const LIMIT: usize = 1 << 30;

/// Tetrahedra per cube.
pub const PER_CUBE: usize = 5;

/// Corners of a cube are numbered dx + 2 dy + 4 dz. Those of its tetrahedra, by the parity of i + j + k of its corner 0: four corner
/// tetrahedra (first the corner itself, then its neighbours), then the inner one.
pub const CUBE_TETS: [[[usize; 4]; PER_CUBE]; 2] = [
    [[0, 1, 2, 4], [3, 2, 1, 7], [5, 4, 7, 1], [6, 7, 4, 2], [1, 2, 4, 7]],
    [[1, 3, 0, 5], [2, 0, 3, 6], [4, 6, 5, 0], [7, 5, 6, 3], [0, 5, 3, 6]],
];

/// A box of nx × ny × nz cubes. Node (i, j, k) is number i + (nx + 1)(j + (ny + 1) k), cube (i, j, k) is i + nx (j + ny k), and its tetrahedra
/// are 5 cube .. 5 cube + 5.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxGrid {
    cells: [usize; 3],
    /// Coordinates of the nodes along each axis.
    ticks: [Vec<f64>; 3],
}

impl BoxGrid {
    /// `cells`: cubes along each axis, 1 or more. `bounds`: node i of n + 1 along an axis is at (i/n)·(max − min) + min, as written, in doubles;
    /// without bounds it is at i.
    ///
    /// Errors: `BadArgument` for a count below 1, bounds that are not finite or not rising; `TooLarge` for 2³⁰ tetrahedra or more.
    /// Cost: that of the coordinates along the axes.
    pub fn new(cells: [u32; 3], bounds: Option<[[f64; 3]; 2]>) -> Result<Self> {
        if cells.contains(&0) {
            return Err(Error::new(Status::BadArgument, "a box needs a cube or more along each axis"));
        }
        let cells = cells.map(|n| n as usize);
        let nodes = cells.iter().try_fold(1usize, |all, n| all.checked_mul(n + 1));
        let tets = cells.iter().try_fold(PER_CUBE, |all, &n| all.checked_mul(n));
        if !(nodes.is_some_and(|n| n < LIMIT) && tets.is_some_and(|n| n < LIMIT)) {
            return Err(Error::new(Status::TooLarge, "a box of 2^30 tetrahedra or nodes, or more"));
        }
        let mut ticks = [const { Vec::new() }; 3];
        for axis in 0..3 {
            let n = cells[axis];
            ticks[axis] = match bounds {
                None => (0..=n).map(|i| i as f64).collect(),
                Some([min, max]) => {
                    let (min, max) = (min[axis], max[axis]);
                    if !(min < max && (max - min).is_finite() && min.is_finite()) {
                        return Err(Error::new(Status::BadArgument, format!("bad bounds of a box along axis {axis}")));
                    }
                    // (Adding +0 turns −0 into +0.)
                    (0..=n).map(|i| (i as f64 / n as f64) * (max - min) + min + 0.0).collect()
                }
            };
        }
        Ok(Self { cells, ticks })
    }

    /// Cubes along each axis.
    #[inline(always)]
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// Coordinates of the nodes along an axis.
    pub fn ticks(&self, axis: usize) -> &[f64] {
        &self.ticks[axis]
    }

    #[inline(always)]
    pub fn node_count(&self) -> usize {
        self.cells.iter().map(|n| n + 1).product()
    }

    #[inline(always)]
    pub fn tet_count(&self) -> usize {
        self.cells.iter().product::<usize>() * PER_CUBE
    }

    #[inline(always)]
    pub fn node(&self, [i, j, k]: [usize; 3]) -> NodeId {
        NodeId::of(i + (self.cells[0] + 1) * (j + (self.cells[1] + 1) * k))
    }

    #[inline(always)]
    pub fn place(&self, node: NodeId) -> [usize; 3] {
        let (nx, ny) = (self.cells[0] + 1, self.cells[1] + 1);
        let (row, i) = (node.at() / nx, node.at() % nx);
        [i, row % ny, row / ny]
    }

    #[inline(always)]
    pub fn coordinates(&self, node: NodeId) -> [f64; 3] {
        let [i, j, k] = self.place(node);
        [self.ticks[0][i], self.ticks[1][j], self.ticks[2][k]]
    }

    /// Nodes to step along the axes.
    #[inline(always)]
    pub fn strides(&self) -> [usize; 3] {
        let (nx, ny) = (self.cells[0] + 1, self.cells[1] + 1);
        [1, nx, nx * ny]
    }

    #[inline(always)]
    pub fn cube_number(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.cells[0] * (j + self.cells[1] * k)
    }

    #[inline(always)]
    pub fn cube_place(&self, cube: usize) -> [usize; 3] {
        let (row, i) = (cube / self.cells[0], cube % self.cells[0]);
        [i, row % self.cells[1], row / self.cells[1]]
    }

    pub fn corners(&self, tet: TetId) -> [NodeId; 4] {
        let [i, j, k] = self.cube_place(tet.at() / PER_CUBE);
        let first = self.node([i, j, k]);
        let strides = self.strides();
        CUBE_TETS[(i + j + k) & 1][tet.at() % PER_CUBE].map(|c| {
            let steps = (c & 1) * strides[0] + (c >> 1 & 1) * strides[1] + (c >> 2) * strides[2];
            NodeId::of(first.at() + steps)
        })
    }

    /// The corner tetrahedron of a cube at one of its even corners.
    #[inline]
    fn corner_tet(&self, cube: [usize; 3], corner: usize) -> TetId {
        let parity = cube.iter().sum::<usize>() & 1;
        let at = CUBE_TETS[parity][..4].iter().position(|t| t[0] == corner).expect("an even corner");
        TetId::of(self.cube_number(cube) * PER_CUBE + at)
    }

    /// See [`Domain::opposite`].
    pub fn opposite(&self, tet: TetId, facet: usize) -> Option<(TetId, NodeId)> {
        let cube = self.cube_place(tet.at() / PER_CUBE);
        let parity = cube.iter().sum::<usize>() & 1;
        let corners = CUBE_TETS[parity][tet.at() % PER_CUBE];
        let node = |cube: [usize; 3], c: usize| self.node(std::array::from_fn(|axis| cube[axis] + (c >> axis & 1)));
        if tet.at() % PER_CUBE == 4 {
            // The corner of the cube opposite to the one that the facet lacks.
            let even = corners[facet] ^ 7;
            return Some((self.corner_tet(cube, even), node(cube, even)));
        }
        let even = corners[0];
        if facet == 0 {
            return Some((TetId::of(self.cube_number(cube) * PER_CUBE + 4), node(cube, even ^ 7)));
        }
        // On a face of the cube: the corner tetrahedron of the same node in the cube behind that face.
        let axis = (even ^ corners[facet]).trailing_zeros() as usize;
        let mut behind = cube;
        if even >> axis & 1 == 1 {
            behind[axis] += 1;
            if behind[axis] == self.cells[axis] {
                return None;
            }
        } else {
            behind[axis] = behind[axis].checked_sub(1)?;
        }
        let mirrored = even ^ (1 << axis);
        Some((self.corner_tet(behind, mirrored), node(behind, even)))
    }

    /// Calls `visit` for the cubes around a node, rising, with the number of the corner that the node is.
    #[inline]
    fn cubes_around(&self, node: NodeId, mut visit: impl FnMut([usize; 3], usize)) {
        let place = self.place(node);
        for c in (0..8usize).rev() {
            let cube: [usize; 3] = std::array::from_fn(|axis| place[axis].wrapping_sub(c >> axis & 1));
            if (0..3).all(|axis| cube[axis] < self.cells[axis]) {
                visit(cube, c);
            }
        }
    }

    fn tets_around(&self, node: NodeId, visit: &mut impl FnMut(TetId, [NodeId; 4])) {
        self.cubes_around(node, |cube, c| {
            let parity = cube.iter().sum::<usize>() & 1;
            for (t, corners) in CUBE_TETS[parity].iter().enumerate() {
                if corners.contains(&c) {
                    let tet = TetId::of(self.cube_number(cube) * PER_CUBE + t);
                    visit(tet, self.corners(tet));
                }
            }
        });
    }
}

/// Where functions are given.
#[derive(Clone, Debug)]
pub enum Domain {
    Box(BoxGrid),
    Mesh(TetMesh),
}

impl Domain {
    /// 2 or 3.
    #[inline(always)]
    pub fn dim(&self) -> usize {
        match self {
            Domain::Box(_) => 3,
            Domain::Mesh(mesh) => mesh.dim,
        }
    }

    pub fn node_count(&self) -> usize {
        match self {
            Domain::Box(grid) => grid.node_count(),
            Domain::Mesh(mesh) => mesh.vertices.len(),
        }
    }

    pub fn tet_count(&self) -> usize {
        match self {
            Domain::Box(grid) => grid.tet_count(),
            Domain::Mesh(mesh) => mesh.tets.len(),
        }
    }

    /// The nodes of a simplex; in two dimensions the fourth is `NONE`.
    #[inline]
    pub fn corners(&self, tet: TetId) -> [NodeId; 4] {
        match self {
            Domain::Box(grid) => grid.corners(tet),
            Domain::Mesh(mesh) => mesh.tets[tet.at()],
        }
    }

    #[inline]
    pub fn coordinates(&self, node: NodeId) -> [f64; 3] {
        match self {
            Domain::Box(grid) => grid.coordinates(node),
            Domain::Mesh(mesh) => mesh.vertices[node.at()],
        }
    }

    /// The sign of det(b − a, c − a, d − a) for corners a, b, c, d (in two dimensions of det(b − a, c − a)); never zero.
    #[inline]
    pub fn orientation(&self, tet: TetId) -> Sign {
        match self {
            Domain::Box(_) => Sign::Positive,
            Domain::Mesh(mesh) => mesh.orientation(tet),
        }
    }

    /// The simplex on the other side of the facet without corner `facet`, and its node that is not on that facet; `None` at the boundary.
    #[inline]
    pub fn opposite(&self, tet: TetId, facet: usize) -> Option<(TetId, NodeId)> {
        match self {
            Domain::Box(grid) => grid.opposite(tet, facet),
            Domain::Mesh(mesh) => mesh.opposite(tet, facet),
        }
    }

    /// The simplices that have all these nodes (1 to 4 of them, `NONE` ignored), rising, into `out`.
    /// Cost: that of the simplices around the first node.
    pub fn around(&self, nodes: &[NodeId], out: &mut Vec<TetId>) {
        out.clear();
        let mut add = |tet: TetId, corners: [NodeId; 4]| {
            if nodes.iter().all(|n| n.is_none() || corners.contains(n)) {
                out.push(tet);
            }
        };
        match self {
            Domain::Box(grid) => grid.tets_around(nodes[0], &mut add),
            Domain::Mesh(mesh) => mesh.node_tets.row(nodes[0]).iter().for_each(|&t| add(t, mesh.tets[t.at()])),
        }
    }

    /// The nodes joined to one by an edge, rising, into `out`.
    pub fn neighbours(&self, node: NodeId, out: &mut Vec<NodeId>) {
        out.clear();
        let mut add = |_: TetId, corners: [NodeId; 4]| {
            out.extend(corners.iter().filter(|&&n| n != node && n.is_some()));
        };
        match self {
            Domain::Box(grid) => grid.tets_around(node, &mut add),
            Domain::Mesh(mesh) => mesh.node_tets.row(node).iter().for_each(|&t| add(t, mesh.tets[t.at()])),
        }
        out.sort_unstable();
        out.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn explicit(grid: &BoxGrid) -> TetMesh {
        let vertices = (0..grid.node_count()).map(|n| grid.coordinates(NodeId::of(n))).collect();
        let tets: Vec<[i32; 4]> =
            (0..grid.tet_count()).map(|t| grid.corners(TetId::of(t)).map(|n| n.0 as i32)).collect();
        TetMesh::tets(vertices, &tets).unwrap()
    }

    #[test]
    fn arithmetic_agrees_with_the_tetrahedra_written_out() {
        for cells in [[1, 1, 1], [2, 3, 2], [3, 2, 4]] {
            let grid = BoxGrid::new(cells, Some([[-1.0, 0.0, 2.0], [1.0, 3.0, 5.0]])).unwrap();
            let (grid, mesh) = (Domain::Box(grid.clone()), Domain::Mesh(explicit(&grid)));
            assert_eq!((grid.node_count(), grid.tet_count()), (mesh.node_count(), mesh.tet_count()));
            for t in 0..grid.tet_count() {
                let tet = TetId::of(t);
                assert_eq!(grid.orientation(tet), mesh.orientation(tet));
                for facet in 0..4 {
                    assert_eq!(grid.opposite(tet, facet), mesh.opposite(tet, facet), "tet {t}, facet {facet}");
                }
            }
            let (mut a, mut b) = (Vec::new(), Vec::new());
            let (mut c, mut d) = (Vec::new(), Vec::new());
            for n in 0..grid.node_count() {
                let node = NodeId::of(n);
                grid.around(&[node], &mut a);
                mesh.around(&[node], &mut b);
                assert_eq!(a, b);
                grid.neighbours(node, &mut c);
                mesh.neighbours(node, &mut d);
                assert_eq!(c, d);
                for &other in &c {
                    grid.around(&[node, other], &mut a);
                    mesh.around(&[node, other], &mut b);
                    assert_eq!(a, b);
                    assert!(!a.is_empty());
                }
            }
        }
    }

    #[test]
    fn bad_boxes_are_refused() {
        assert_eq!(BoxGrid::new([0, 1, 1], None).unwrap_err().status, Status::BadArgument);
        assert_eq!(BoxGrid::new([2000, 2000, 2000], None).unwrap_err().status, Status::TooLarge);
        assert_eq!(BoxGrid::new([u32::MAX; 3], None).unwrap_err().status, Status::TooLarge);
        for bounds in [[[0.0; 3], [1.0, 0.0, 1.0]], [[0.0; 3], [1.0, f64::NAN, 1.0]], [[-1e308; 3], [1e308; 3]]] {
            assert_eq!(BoxGrid::new([2; 3], Some(bounds)).unwrap_err().status, Status::BadArgument);
        }
    }
}

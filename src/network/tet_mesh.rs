//! Conforming meshes of tetrahedra, or of triangles in the plane, as domains: checked once, with the neighbours across
//! facets and the simplices around each node.
//!
//! Invariant: every simplex has its exact orientation, never zero; a facet has one or two simplices, on different sides.
//! Simplices whose interiors meet without sharing a facet are not looked for: the network is then the union of what each simplex holds.
//! Nodes without simplices are fine. Cost: linear; facets are sorted within the buckets of their lowest nodes.

use super::domain::LIMIT;
use crate::base::parallel::map_ranges;
use crate::base::{Csr, Culprit, DefectKind, Error, NodeId, Result, Status, TetId};
use crate::exact::{Row, Sign, determinant_of_rows, orient3d};

/// Simplices in one task at least.
const LEAST: usize = 1 << 12;

#[derive(Clone, Debug)]
pub struct TetMesh {
    /// 2 or 3.
    pub dim: usize,
    /// In two dimensions with a third coordinate of 0.
    pub vertices: Vec<[f64; 3]>,
    /// In two dimensions the fourth node is `NONE`.
    pub tets: Vec<[NodeId; 4]>,
    positive: Vec<bool>,
    /// The simplex behind each facet (facet i: without corner i), `NONE` at the boundary.
    pub neighbours: Vec<[TetId; 4]>,
    /// The simplices of each node, rising.
    pub node_tets: Csr<TetId>,
}

impl TetMesh {
    /// A mesh of tetrahedra, in either orientation.
    ///
    /// Errors: `BadMesh` with the defects found (coordinates that are not finite, indices out of range, degenerate simplices; where there are none,
    /// facets with two simplices on one side); `TooLarge` for 2³⁰ nodes or simplices or more.
    pub fn tets(vertices: Vec<[f64; 3]>, tets: &[[i32; 4]]) -> Result<Self> {
        Self::new(3, vertices, tets.len(), |t| tets[t])
    }

    /// A mesh of triangles in the plane, in either orientation. Errors: as for [`TetMesh::tets`].
    pub fn triangles(vertices: &[[f64; 2]], triangles: &[[i32; 3]]) -> Result<Self> {
        let vertices = vertices.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        Self::new(2, vertices, triangles.len(), |t| {
            let [a, b, c] = triangles[t];
            [a, b, c, -1]
        })
    }

    fn new(
        dim: usize,
        mut vertices: Vec<[f64; 3]>,
        count: usize,
        corners: impl Fn(usize) -> [i32; 4] + Sync,
    ) -> Result<Self> {
        if vertices.len() >= LIMIT || count >= LIMIT {
            return Err(Error::new(Status::TooLarge, "2^30 nodes or simplices, or more"));
        }
        // −0 becomes +0.
        vertices.iter_mut().flatten().for_each(|x| *x += 0.0);
        let mut defects = input_defects(dim, &vertices, count, &corners);
        let tets: Vec<[NodeId; 4]> = (0..count).map(|t| corners(t).map(|n| NodeId(n as u32))).collect();
        let mut positive = Vec::new();
        if defects.is_empty() {
            let signs =
                map_ranges(count, LEAST, |r| r.map(|t| orientation(dim, &vertices, &tets[t])).collect::<Vec<_>>())
                    .concat();
            let flat = (0..count).filter(|&t| signs[t].is_zero());
            defects.extend(flat.map(|t| Culprit::new(DefectKind::DegenerateSimplex, &[t as i64])));
            positive = signs.iter().map(|&s| s == Sign::Positive).collect();
        }
        if !defects.is_empty() {
            return Err(bad_mesh(defects));
        }
        let pairs = tets.iter().enumerate();
        let pairs = pairs.flat_map(move |(t, c)| c[..=dim].iter().map(move |n| (n.at(), TetId::of(t))));
        let node_tets = Csr::from_pairs(vertices.len(), pairs);
        let neighbours = neighbours(dim, vertices.len(), &tets, &positive)?;
        Ok(Self { dim, vertices, tets, positive, neighbours, node_tets })
    }

    #[inline(always)]
    pub fn orientation(&self, tet: TetId) -> Sign {
        if self.positive[tet.at()] { Sign::Positive } else { Sign::Negative }
    }

    /// See [`super::Domain::opposite`].
    #[inline]
    pub fn opposite(&self, tet: TetId, facet: usize) -> Option<(TetId, NodeId)> {
        let behind = self.neighbours[tet.at()][facet];
        if behind.is_none() {
            return None;
        }
        let at = self.neighbours[behind.at()].iter().position(|&t| t == tet).expect("neighbours are mutual");
        Some((behind, self.tets[behind.at()][at]))
    }
}

fn bad_mesh(mut defects: Vec<Culprit>) -> Error {
    defects.sort_unstable();
    let message = crate::mesh::validate::describe(&defects[0]);
    Error::with(Status::BadMesh, message, defects)
}

fn input_defects(
    dim: usize,
    vertices: &[[f64; 3]],
    count: usize,
    corners: &impl Fn(usize) -> [i32; 4],
) -> Vec<Culprit> {
    let mut defects = Vec::new();
    for (v, x) in vertices.iter().enumerate() {
        if !x.iter().all(|c| c.is_finite()) {
            defects.push(Culprit::new(DefectKind::NonFiniteCoordinate, &[v as i64]));
        }
    }
    for t in 0..count {
        for (k, &n) in corners(t)[..=dim].iter().enumerate() {
            if n as u32 as usize >= vertices.len() {
                defects.push(Culprit::new(DefectKind::IndexOutOfRange, &[t as i64, k as i64, n as i64]));
            }
        }
    }
    defects
}

fn orientation(dim: usize, vertices: &[[f64; 3]], corners: &[NodeId; 4]) -> Sign {
    let x = |k: usize| &vertices[corners[k].at()];
    if dim == 3 {
        // Of the library's own predicate: d above the triangle abc, seen with abc counterclockwise.
        return orient3d(x(0), x(1), x(2), x(3));
    }
    let [a, b, c] = [0, 1, 2].map(|k| [x(k)[0], x(k)[1]]);
    determinant_of_rows(&[Row::Difference(&b, &a), Row::Difference(&c, &a)])
}

/// A facet in the bucket of its lowest node.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Facet {
    /// The other nodes, rising.
    others: [NodeId; 2],
    tet: TetId,
    facet: u32,
}

/// The facet without corner k: its lowest node and the rest; and whether sorting its nodes was an odd permutation of their order within the simplex.
fn facet_of(dim: usize, corners: &[NodeId; 4], k: usize) -> (NodeId, [NodeId; 2], bool) {
    let mut nodes = [NodeId::NONE; 3];
    let mut n = 0;
    for (i, &c) in corners[..=dim].iter().enumerate() {
        if i != k {
            nodes[n] = c;
            n += 1;
        }
    }
    let mut odd = false;
    for (a, b) in [(0, 1), (1, 2), (0, 1)] {
        if nodes[a] > nodes[b] {
            nodes.swap(a, b);
            odd = !odd;
        }
    }
    (nodes[0], [nodes[1], nodes[2]], odd)
}

fn neighbours(dim: usize, nodes: usize, tets: &[[NodeId; 4]], positive: &[bool]) -> Result<Vec<[TetId; 4]>> {
    let pairs = tets.iter().enumerate().flat_map(move |(t, corners)| {
        (0..=dim).map(move |k| {
            let (lowest, others, _) = facet_of(dim, corners, k);
            (lowest.at(), Facet { others, tet: TetId::of(t), facet: k as u32 })
        })
    });
    let mut buckets: Csr<Facet> = Csr::from_pairs(nodes, pairs);
    let mut out = vec![[TetId::NONE; 4]; tets.len()];
    let mut defects = Vec::new();
    // Which side of its sorted nodes a facet's simplex is on: corner k is moved behind the others by dim − k swaps.
    let side = |f: &Facet| {
        let k = f.facet as usize;
        positive[f.tet.at()] ^ facet_of(dim, &tets[f.tet.at()], k).2 ^ ((dim - k) & 1 == 1)
    };
    for n in 0..nodes {
        let row = buckets.row_mut(n);
        row.sort_unstable();
        for same in row.chunk_by(|a, b| a.others == b.others) {
            // Of three or more, two are on one side.
            for (i, a) in same.iter().enumerate().take(2) {
                for b in &same[i + 1..] {
                    if side(a) == side(b) {
                        defects.push(Culprit::new(DefectKind::OverlappingSimplices, &[a.tet.0 as i64, b.tet.0 as i64]));
                    }
                }
            }
            if let [a, b] = same {
                out[a.tet.at()][a.facet as usize] = b.tet;
                out[b.tet.at()][b.facet as usize] = a.tet;
            }
        }
    }
    if defects.is_empty() { Ok(out) } else { Err(bad_mesh(defects)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 5] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];

    fn kinds(result: Result<TetMesh>) -> Vec<Culprit> {
        result.unwrap_err().culprits
    }

    #[test]
    fn either_orientation_is_accepted() {
        for tets in [[[0, 1, 2, 3], [0, 1, 2, 4]], [[1, 0, 2, 3], [2, 0, 4, 1]], [[3, 0, 1, 2], [4, 2, 1, 0]]] {
            let mesh = TetMesh::tets(CORNERS.to_vec(), &tets).unwrap();
            let facet = tets[0].iter().position(|&n| n == 3).unwrap();
            assert_eq!(mesh.opposite(TetId(0), facet), Some((TetId(1), NodeId(4))));
            let open = mesh.neighbours.iter().flatten().filter(|t| t.is_none()).count();
            assert_eq!(open, 6);
        }
        let mesh = TetMesh::tets(CORNERS.to_vec(), &[[0, 1, 2, 3], [1, 0, 2, 3]]);
        assert_eq!(kinds(mesh).len(), 4);
    }

    #[test]
    fn defects_have_names() {
        let mesh = TetMesh::tets(CORNERS.to_vec(), &[[0, 1, 2, 3], [0, 1, 3, 4]]);
        assert_eq!(kinds(mesh), [Culprit::new(DefectKind::DegenerateSimplex, &[1])]);
        let mesh = TetMesh::tets(CORNERS.to_vec(), &[[0, 1, 2, 5], [0, 1, 3, -1]]);
        let bad = |t, n| Culprit::new(DefectKind::IndexOutOfRange, &[t, 3, n]);
        assert_eq!(kinds(mesh), [bad(0, 5), bad(1, -1)]);
        let mut corners = CORNERS.to_vec();
        corners.push([0.0, 0.0, 2.0]);
        let mesh = TetMesh::tets(corners.clone(), &[[0, 1, 2, 3], [0, 1, 2, 5]]);
        assert_eq!(kinds(mesh), [Culprit::new(DefectKind::OverlappingSimplices, &[0, 1])]);
        corners[4][1] = f64::NAN;
        let mesh = TetMesh::tets(corners, &[[0, 1, 2, 3]]);
        assert_eq!(kinds(mesh), [Culprit::new(DefectKind::NonFiniteCoordinate, &[4])]);
    }

    #[test]
    fn triangles_of_the_plane() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let mesh = TetMesh::triangles(&corners, &[[0, 1, 2], [1, 2, 3]]).unwrap();
        assert_eq!(mesh.opposite(TetId(0), 0), Some((TetId(1), NodeId(3))));
        assert_eq!([0, 1].map(|t| mesh.orientation(TetId(t))), [Sign::Positive, Sign::Negative]);
        let mesh = TetMesh::triangles(&corners, &[[0, 1, 2], [0, 1, 3]]);
        assert_eq!(kinds(mesh), [Culprit::new(DefectKind::OverlappingSimplices, &[0, 1])]);
        let line = [[0.0, 0.0], [1e-300, 1e-300], [1e300, 1e300]];
        let mesh = TetMesh::triangles(&line, &[[0, 1, 2]]);
        assert_eq!(kinds(mesh), [Culprit::new(DefectKind::DegenerateSimplex, &[0])]);
    }
}

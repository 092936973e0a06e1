//! The complex of one simplex as plain flat arrays: cells, faces, edges, vertices, the simplex's own boundary included.
//!
//! `dim` is 3 (tetrahedron) or 2 (triangle). *Faces* have dimension dim - 1 and separate cells; in 2-D they are segments and there are
//! no edges. Every cell and every face is convex, no vertex of a face lies straight between its neighbours, and no edge has a vertex
//! inside it: the complex is fixed by the functions alone. Which elements there are does not depend on the order of
//! the functions, only their numbers do.
//!
//! Ties. IA: a function that vanishes identically, or on a lower-dimensional part of the boundary only, splits nothing; functions with
//! the same zero plane (f, 2f, -f) share it. MI: of materials that are equal everywhere the first owns the cell; a material that is
//! largest on a lower-dimensional set only has no cell and splits nothing. All of them are named on the elements on which they
//! vanish (are largest).

use crate::base::Csr;
use crate::base::ids::ids;
use crate::exact::Sign;

ids! {
    /// A vertex of a simplex's complex. The simplex's own corners come first, in order.
    LocalVertex,
    /// An edge of the complex (3-D only).
    LocalEdge,
    /// A face of the complex: a polygon in 3-D, a segment in 2-D.
    LocalFace,
    /// A cell of the complex.
    LocalCell,
    /// A function (material), by its place in the list of values.
    LocalFunction,
    /// What a face lies on: a row of [`SimplexComplex::plane_functions`].
    LocalPlane,
}

/// The open sub-simplex that holds a point, as the set of its corners: bit c is set where barycentric coordinate c is not zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Carrier(pub u8);

impl Carrier {
    /// 0 for a corner, 1 for an edge, 2 for a triangle, 3 for the inside of a tetrahedron.
    #[inline(always)]
    pub fn dim(self) -> usize {
        self.0.count_ones() as usize - 1
    }
    #[inline(always)]
    pub fn has(self, corner: usize) -> bool {
        self.0 >> corner & 1 != 0
    }
    /// The smallest sub-simplex that holds both.
    #[inline(always)]
    pub fn join(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
    /// Whether this one is in the closure of the other.
    #[inline(always)]
    pub fn within(self, other: Self) -> bool {
        self.0 & !other.0 == 0
    }
    /// Corners, rising.
    pub fn corners(self) -> impl Iterator<Item = usize> + Clone {
        (0..4).filter(move |&c| self.has(c))
    }
}

/// One side of a face: `face << 1 | side`, side 0 the positive one, 1 the negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct LocalHalfFace(pub u32);

impl LocalHalfFace {
    #[inline(always)]
    pub fn new(face: LocalFace, side: usize) -> Self {
        Self(face.0 << 1 | side as u32)
    }
    #[inline(always)]
    pub fn face(self) -> LocalFace {
        LocalFace(self.0 >> 1)
    }
    /// 0: the cell is on the face's positive side; 1: on its negative side.
    #[inline(always)]
    pub fn side(self) -> usize {
        (self.0 & 1) as usize
    }
}

/// Which of the two complexes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Kind {
    /// IA: planes f = 0.
    #[default]
    Arrangement,
    /// MI: planes f = g, where no other material is larger.
    Interface,
}

/// What a face lies on, and which side of it is positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FaceSupport {
    /// The facet opposite to a corner; its positive side is the simplex. (Functions may vanish there as well.)
    Facet(u8),
    /// IA, inside the simplex: the lowest function that vanishes there; positive where the function is.
    Function(LocalFunction),
    /// MI, inside the simplex: the owners a < b of the cells on its positive and negative side (positive where f_a - f_b is).
    Pair(LocalFunction, LocalFunction),
}

/// The complex. Filled by [`super::arrangement()`] or [`super::interface()`], and reused: its arrays keep their memory.
#[derive(Clone, Debug, Default)]
pub struct SimplexComplex {
    pub kind: Kind,
    /// 3 or 2.
    pub dim: usize,
    /// How many functions (materials) there were.
    pub functions: usize,

    pub vertex_carrier: Vec<Carrier>,
    /// The encoding of section 5.1, padded with `NONE`: the point of the open carrier (of dimension d) where these functions vanish
    /// (IA: d of them) or are equal (MI: d + 1), rising. In degenerate places there are other choices, and materials without a cell
    /// may be among them.
    pub vertex_encoding: Vec<[LocalFunction; 4]>,
    /// *All* functions that vanish at each vertex (MI: all materials that are largest there), rising. IA: those that vanish everywhere
    /// are left out.
    pub vertex_functions: Csr<LocalFunction>,

    /// The ends of each edge (3-D; empty in 2-D).
    pub edges: Vec<[LocalVertex; 2]>,

    /// 3-D: the corners of each face, counterclockwise when seen from its positive side. 2-D: its two ends; the
    /// positive side is on the left of the way from the first to the second. (All this in a simplex of positive orientation:
    /// det(b - a, c - a, d - a) > 0; in others the other way round.)
    pub face_vertices: Csr<LocalVertex>,
    /// 3-D: for each entry of `face_vertices.items` the edge from there to the next corner of its face. Empty in 2-D.
    pub face_edges: Vec<LocalEdge>,
    pub face_support: Vec<FaceSupport>,
    /// The row of `plane_functions` for each face. IA: coplanar faces share it; MI: each face has its own.
    pub face_plane: Vec<LocalPlane>,
    /// The cells on the positive and on the negative side of each face; `NONE` outside of the simplex.
    pub face_cells: Vec<[LocalCell; 2]>,

    /// All functions that vanish on a face (MI: materials that are largest on all of it), rising; without those that vanish everywhere.
    /// IA: rows 0..=dim are the simplex's facets.
    pub plane_functions: Csr<LocalFunction>,
    /// IA: for each entry of `plane_functions.items`, whether the function is negative on the positive side of the plane.
    pub plane_opposite: Vec<bool>,

    /// The half-faces of each cell.
    pub cell_faces: Csr<LocalHalfFace>,
    /// IA: row c, bit k (in words of 64): function k is positive in cell c. See [`SimplexComplex::cell_sign`].
    pub cell_positive: Vec<u64>,
    /// IA: bit k: function k vanishes everywhere.
    pub zero_functions: Vec<u64>,
    /// MI: the owner of each cell.
    pub cell_owner: Vec<LocalFunction>,
    /// MI: all materials that are largest in the whole cell, rising (the owner is the first).
    pub cell_materials: Csr<LocalFunction>,
}

impl SimplexComplex {
    pub fn vertex_count(&self) -> usize {
        self.vertex_carrier.len()
    }
    pub fn edge_count(&self) -> usize {
        self.edges.len()
    }
    pub fn face_count(&self) -> usize {
        self.face_support.len()
    }
    pub fn cell_count(&self) -> usize {
        self.cell_faces.len()
    }

    /// Words of 64 functions in a row of `cell_positive`.
    #[inline(always)]
    pub fn label_words(&self) -> usize {
        self.functions.div_ceil(64)
    }
    /// IA: which functions are positive in a cell, 64 in each word.
    #[inline(always)]
    pub fn cell_label(&self, c: LocalCell) -> &[u64] {
        let n = self.label_words();
        &self.cell_positive[c.at() * n..(c.at() + 1) * n]
    }
    /// IA: the sign of a function inside a cell.
    #[inline]
    pub fn cell_sign(&self, c: LocalCell, f: LocalFunction) -> Sign {
        let (word, bit) = (f.at() / 64, f.at() % 64);
        if self.cell_label(c)[word] >> bit & 1 != 0 {
            Sign::Positive
        } else if self.zero_functions[word] >> bit & 1 != 0 {
            Sign::Zero
        } else {
            Sign::Negative
        }
    }

    /// All functions that vanish on a face (MI: that are largest on it), rising.
    #[inline(always)]
    pub fn face_functions(&self, f: LocalFace) -> &[LocalFunction] {
        self.plane_functions.row(self.face_plane[f.at()])
    }
    /// Edges of a face, each from the corner at the same place of `face_vertices` to the next (3-D).
    #[inline(always)]
    pub fn edges_of(&self, f: LocalFace) -> &[LocalEdge] {
        &self.face_edges[self.face_vertices.range(f)]
    }
    /// The smallest sub-simplex that holds a face.
    pub fn face_carrier(&self, f: LocalFace) -> Carrier {
        self.face_vertices.row(f).iter().fold(Carrier(0), |c, v| c.join(self.vertex_carrier[v.at()]))
    }
    /// The smallest sub-simplex that holds an edge.
    pub fn edge_carrier(&self, e: LocalEdge) -> Carrier {
        let [a, b] = self.edges[e.at()].map(|v| self.vertex_carrier[v.at()]);
        a.join(b)
    }
    /// Functions that vanish on a whole edge (MI: that are largest on it), rising: those of both of its ends.
    pub fn edge_functions(&self, e: LocalEdge) -> impl Iterator<Item = LocalFunction> {
        let [a, b] = self.edges[e.at()].map(|v| self.vertex_functions.row(v));
        a.iter().copied().filter(|f| b.binary_search(f).is_ok())
    }
}

/// Working memory, reused between calls. One per thread.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    pub(super) work: super::work::Work,
    pub(super) maps: super::export::Maps,
}

//! What goes into a network and what comes out of it, as plain flat arrays (DESIGN §5).
//!
//! Two dimensions are the same structs one dimension down: a simplex is a triangle, a polygon is a segment of two vertices,
//! fourth nodes are `NONE`, and third coordinates are 0.

use super::simplex::Kind;
use crate::base::{Csr, Error, FunctionId, NodeId, Result, SetId, Status, TetId, VertexId};
use crate::exact::Sign;

/// Borrowed function values at the nodes: that of function `f` at node `i` is `functions[f][i * stride]`.
#[derive(Clone, Copy, Debug)]
pub struct Values<'a> {
    pub functions: &'a [&'a [f64]],
    /// 1 for one array per function; the number of functions where they are interleaved.
    pub stride: usize,
}

impl Values<'_> {
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.functions.len()
    }

    pub fn is_empty(&self) -> bool {
        self.functions.is_empty()
    }

    #[inline(always)]
    pub fn at(&self, f: FunctionId, node: NodeId) -> f64 {
        self.functions[f.at()][node.at() * self.stride]
    }

    /// Every array reaches to the last node.
    pub fn check(&self, nodes: usize) -> Result<()> {
        if self.stride == 0 {
            return Err(Error::new(Status::BadArgument, "the stride of function values is 0"));
        }
        let least = nodes.saturating_sub(1).saturating_mul(self.stride) + (nodes > 0) as usize;
        match self.functions.iter().position(|f| f.len() < least) {
            Some(f) => Err(Error::new(Status::BadArgument, format!("function {f} has too few values"))),
            None => Ok(()),
        }
    }
}

/// A function that vanishes on a polygon (of an interface: one of the two materials that meet there).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SetItem {
    pub function: FunctionId,
    /// Arrangement: how the function's sign changes along the polygon's normal: `Positive` if it rises (− to +, − to 0, 0 to +),
    /// `Negative` if it falls, `Zero` if it is the same on both sides. Interface: `Positive` for the material on the positive side, else `Negative`.
    pub orientation: Sign,
}

/// Vertices and polygons of an implicit arrangement or a material interface.
///
/// Vertices: no two are the same point, every one is a corner of a polygon. First those on open edges of the domain, then at nodes, then on
/// open faces, then inside simplices.
///
/// Polygons: convex, in the order of the simplices they were found in; a polygon on the face between two simplices once, with
/// the lower one. Loops run counterclockwise seen from the positive side.
/// Of an arrangement: the normal points to the side where the lowest function with different signs on the two sides is greater;
/// where no sign differs, into the simplex with the greater id. Of an interface: to the side of the lower material.
/// (In two dimensions: the positive side is on the left of the way from the first vertex to the second.)
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    pub kind: Kind,
    /// 2 or 3.
    pub dim: usize,
    pub function_count: usize,

    /// Correctly rounded coordinates.
    pub vertices: Vec<[f64; 3]>,
    /// The open node, edge, face or simplex that holds each vertex: its nodes, rising, then `NONE`.
    pub vertex_nodes: Vec<[NodeId; 4]>,
    /// Every function that vanishes at each vertex (of an interface: every material that is maximal there), rising.
    pub vertex_functions: Csr<FunctionId>,

    /// The vertices of each polygon.
    pub polygons: Csr<VertexId>,
    pub polygon_set: Vec<SetId>,
    /// The simplices on the positive and negative sides; the same one twice for a polygon inside a simplex.
    pub polygon_tets: Vec<[TetId; 2]>,
    /// The distinct sets, in lexicographic order; items of a set rise by function.
    /// Arrangement: every function that vanishes on the polygon and not on both simplices beside it; the first with a sign that differs on the sides
    /// has orientation `Positive`. Interface: `[(a, Positive), (b, Negative)]` with a < b.
    pub sets: Csr<SetItem>,

    /// `active[k]` simplices have k active functions (k ≥ 1; of an interface: k ≥ 2 materials that no other one exceeds at all corners).
    pub active: Vec<u64>,
}

impl Network {
    #[inline(always)]
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    #[inline(always)]
    pub fn polygon_count(&self) -> usize {
        self.polygon_set.len()
    }

    /// The functions of a polygon.
    #[inline(always)]
    pub fn set_of(&self, polygon: usize) -> &[SetItem] {
        self.sets.row(self.polygon_set[polygon])
    }
}

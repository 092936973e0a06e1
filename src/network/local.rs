//! The cells of one simplex once more, under the names that the network has for their parts.
//!
//! What surrounds an edge, and what is before a polygon, is told by the complexes of the simplices there. Few are asked (those around one
//! edge of each chain, one for each region's label, those at ties), so nothing is kept from when the polygons were made: they are built again.
//!
//! The names agree because vertices are their complete sets of functions within a carrier: a vertex of the complex and
//! one of the network are the same point exactly if carrier and functions are the same. A face is found through one of its edges: of the faces of
//! one plane at an edge there are two at most, on its two sides, and they walk the edge in opposite directions.
//!
//! Cost of building: that of the simplex's complex, and of n function values at its corners.

use super::edges::walk;
use super::simplex::{self, Carrier, FaceSupport, LocalCell, LocalFace, LocalVertex, Scratch, SimplexComplex};
use super::{Domain, Kind, Network, Values};
use crate::base::{Csr, FunctionId, NodeId, PolygonId, TetId, VertexId};
use crate::exact::Sign;
use std::cmp::Ordering;

/// A network and what it was made from.
#[derive(Clone, Copy)]
pub struct Setting<'a> {
    pub network: &'a Network,
    pub domain: &'a Domain,
    pub values: Values<'a>,
}

/// The complex of one simplex; reused from one simplex to the next.
#[derive(Default)]
pub struct Local {
    pub tet: TetId,
    pub corners: [NodeId; 4],
    /// The functions that take part, rising.
    pub functions: Vec<FunctionId>,
    pub complex: SimplexComplex,
    /// The simplex has positive orientation, so that loops run as they say.
    upright: bool,
    values: Vec<f64>,
    scratch: Scratch,
    /// Of large complexes: vertices by carrier and functions, and the faces at each. Empty for small ones, which are looked through.
    by_name: Vec<LocalVertex>,
    faces_at: Csr<LocalFace>,
}

/// Complexes with more vertices get an index.
const SMALL: usize = 64;

/// What is on one side of a sector: a face that contains an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wall {
    pub face: LocalFace,
    /// Seen from the face's positive side, which is on the left of the edge when walked from its first to its second vertex:
    /// turning counterclockwise about the edge one comes to the positive side.
    pub forward: bool,
}

impl Local {
    /// Builds the complex of a simplex.
    pub fn build(&mut self, setting: &Setting, tet: TetId) {
        self.tet = tet;
        self.corners = setting.domain.corners(tet);
        self.upright = setting.domain.orientation(tet) == Sign::Positive;
        let dim = setting.domain.dim();
        active_functions(setting, &self.corners[..=dim], &mut self.functions);
        self.values.clear();
        for &f in &self.functions {
            self.values.extend(self.corners[..=dim].iter().map(|&node| setting.values.at(f, node)));
        }
        match setting.network.kind {
            Kind::Arrangement => simplex::arrangement(dim, &self.values, &mut self.scratch, &mut self.complex),
            Kind::Interface => simplex::interface(dim, &self.values, &mut self.scratch, &mut self.complex),
        }
        self.by_name.clear();
        let complex = &self.complex;
        let vertices = complex.vertex_count();
        if vertices > SMALL {
            self.by_name.extend((0..vertices).map(LocalVertex::of));
            let name = |v: &LocalVertex| (complex.vertex_carrier[v.at()], complex.vertex_functions.row(*v));
            self.by_name.sort_unstable_by(|a, b| name(a).cmp(&name(b)));
            let faces = (0..complex.face_count()).map(LocalFace::of);
            let corners = faces.flat_map(|f| complex.face_vertices.row(f).iter().map(move |v| (v.at(), f)));
            self.faces_at.fill(vertices, corners);
        }
    }

    /// Builds the complex unless it is there.
    pub fn build_once(&mut self, setting: &Setting, tet: TetId) {
        if self.tet != tet || self.complex.cell_count() == 0 {
            self.build(setting, tet);
        }
    }

    fn function(&self, f: simplex::LocalFunction) -> FunctionId {
        self.functions[f.at()]
    }

    /// The carrier with these nodes (`NONE` ignored), if the simplex has them all.
    fn carrier(&self, nodes: &[NodeId; 4]) -> Option<Carrier> {
        let mut mask = 0;
        for node in nodes.iter().filter(|n| n.is_some()) {
            mask |= 1 << self.corners.iter().position(|c| c == node)?;
        }
        Some(Carrier(mask))
    }

    /// The vertex that the network calls `v`. The network's functions there include those that vanish in all of this simplex, which its complex
    /// leaves out.
    pub fn vertex(&self, network: &Network, v: VertexId) -> Option<LocalVertex> {
        let carrier = self.carrier(&network.vertex_nodes[v.at()])?;
        let functions = network.vertex_functions.row(v);
        let vanishes = |f: FunctionId| {
            let Ok(k) = self.functions.binary_search(&f) else { return false };
            self.complex.kind == simplex::Kind::Arrangement && self.complex.zero_functions[k / 64] >> (k % 64) & 1 != 0
        };
        // Local numbers rise with the functions'.
        let wanted = || functions.iter().copied().filter(|&f| !vanishes(f));
        let order = |w: LocalVertex| {
            let here = self.complex.vertex_carrier[w.at()];
            here.cmp(&carrier).then_with(|| match carrier.dim() {
                0 => Ordering::Equal,
                _ => self.complex.vertex_functions.row(w).iter().map(|&f| self.function(f)).cmp(wanted()),
            })
        };
        if !self.by_name.is_empty() {
            let at = self.by_name.binary_search_by(|&w| order(w)).ok()?;
            return Some(self.by_name[at]);
        }
        (0..self.complex.vertex_count()).map(LocalVertex::of).find(|&w| order(w).is_eq())
    }

    /// The faces that contain the edge between two vertices of the network (in two dimensions, a vertex given twice); the direction is that
    /// of walking from `u` to `v`.
    pub fn walls(&self, network: &Network, [u, v]: [VertexId; 2], out: &mut Vec<Wall>) {
        out.clear();
        let (Some(u), Some(v)) = (self.vertex(network, u), self.vertex(network, v)) else { return };
        let (few, all) = match self.by_name.is_empty() {
            true => (&[][..], 0..self.complex.face_count()),
            false => (self.faces_at.row(u), 0..0),
        };
        for f in few.iter().copied().chain(all.map(LocalFace::of)) {
            let corners = self.complex.face_vertices.row(f);
            let Some(at) = corners.iter().position(|&c| c == u) else { continue };
            let n = corners.len();
            let forward = if self.complex.dim == 2 {
                at == 0
            } else if corners[if at + 1 == n { 0 } else { at + 1 }] == v {
                true
            } else if corners[if at == 0 { n - 1 } else { at - 1 }] == v {
                false
            } else {
                continue;
            };
            out.push(Wall { face: f, forward: forward == self.upright });
        }
    }

    /// Whether a polygon that contains the edge is this wall, and if so whether the polygon's front is the face's positive side.
    pub fn is_polygon(&self, setting: &Setting, wall: Wall, [u, v]: [VertexId; 2], p: PolygonId) -> Option<bool> {
        let network = setting.network;
        let tets = network.polygon_tets[p.at()];
        let same = match self.complex.face_support[wall.face.at()] {
            FaceSupport::Facet(facet) => {
                let (other, _) = setting.domain.opposite(self.tet, facet as usize)?;
                if tets != [self.tet, other] && tets != [other, self.tet] {
                    return None;
                }
                tets[0] == self.tet
            }
            _ if tets != [self.tet; 2] => return None,
            FaceSupport::Function(f) => {
                let f = self.function(f);
                network.set_of(p.at()).iter().find(|item| item.function == f)?.orientation == Sign::Positive
            }
            FaceSupport::Pair(a, b) => {
                let functions = [self.function(a), self.function(b)];
                if !network.set_of(p.at()).iter().map(|item| item.function).eq(functions) {
                    return None;
                }
                true
            }
        };
        (walk(network, p, u, v)? == (wall.forward == same)).then_some(same)
    }

    /// The cell before one side of a polygon that borders this simplex; `None` if the polygon is not in its complex.
    pub fn cell_beside(
        &self,
        setting: &Setting,
        p: PolygonId,
        front: bool,
        walls: &mut Vec<Wall>,
    ) -> Option<LocalCell> {
        let corners = setting.network.polygons.row(p);
        let edge = if self.complex.dim == 2 { [corners[0]; 2] } else { [corners[0], corners[1]] };
        self.walls(setting.network, edge, walls);
        walls.iter().find_map(|&wall| {
            let same = self.is_polygon(setting, wall, edge, p)?;
            let [positive, negative] = self.complex.face_cells[wall.face.at()];
            let cell = if same == front { positive } else { negative };
            cell.is_some().then_some(cell)
        })
    }

    /// The signs of all functions inside a cell (arrangement).
    pub fn signs(&self, setting: &Setting, cell: LocalCell, out: &mut [Sign]) {
        let mut active = self.functions.iter().enumerate().peekable();
        for (f, sign) in out.iter_mut().enumerate() {
            *sign = match active.next_if(|(_, a)| a.at() == f) {
                Some((k, _)) => self.complex.cell_sign(cell, simplex::LocalFunction::of(k)),
                None => Sign::of(setting.values.at(FunctionId::of(f), self.corners[0])),
            };
        }
    }

    /// The material that owns a cell (interface).
    pub fn owner(&self, cell: LocalCell) -> FunctionId {
        self.function(self.complex.cell_owner[cell.at()])
    }
}

/// The functions that take part in a simplex, rising. Arrangement: those that are neither positive at all corners nor negative at all. Interface: those
/// that no other one exceeds at all corners.
/// Cost: linear in the functions for arrangements; for interfaces, times the number of those that remain.
pub fn active_functions(setting: &Setting, corners: &[NodeId], out: &mut Vec<FunctionId>) {
    out.clear();
    let values = &setting.values;
    let all = (0..values.len()).map(FunctionId::of);
    match setting.network.kind {
        Kind::Arrangement => out.extend(all.filter(|&f| {
            let signs = corners.iter().fold([true; 2], |[positive, negative], &node| {
                let value = values.at(f, node);
                [positive && value > 0.0, negative && value < 0.0]
            });
            signs == [false; 2]
        })),
        Kind::Interface => {
            let exceeds = |a: FunctionId, b: FunctionId| corners.iter().all(|&n| values.at(a, n) > values.at(b, n));
            for f in all {
                if !out.iter().any(|&g| exceeds(g, f)) {
                    out.retain(|&g| !exceeds(f, g));
                    out.push(f);
                }
            }
        }
    }
}

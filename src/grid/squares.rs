//! Stage: the faces in grid planes, as far as touched boxes are beside them: each plane's section with the surface's chords, the mesh
//! edges that lie in it, and the segments of grid lines, traced into loops. One face lies in one square of the plane.
//!
//! The graph of a plane is that of `cut::sections`, thinned: of the lattice only segments beside touched boxes are in it, and a
//! half-edge has a face only where the square on its left is one of a touched box. All half-edges around one square agree in that, so
//! the loops of the squares that are built close. Around a vertex on a grid line the order is that of the eight directions (along
//! the axes, or in an open quadrant), from slabs alone; only half-edges in one quadrant are compared by value.
//!
//! Holes, touching vertices and slits: as in `cut::faces`, which finds the faces. Planes are independent.

use super::data::FULL_CELL;
use super::ground::{Slabs, on_plane};
use super::inside::eighth;
use super::lines::{AllSlabs, Lines};
use super::pieces::Chord;
use super::touched::{Touched, others};
use crate::base::{CellId, Csr, EdgeId, NodeId, Result, VertexId};
use crate::cut::classify::KnifeId;
use crate::cut::faces::{AllVertices, SectionFaces, faces_of};
use crate::cut::sections::{Carrier, LocalMap, Piece, Section, edge_pieces};
use crate::exact::{Sign, sort_cyclic};
use rayon::prelude::*;
use std::cmp::Ordering;

/// Faces in grid planes, by axis, then plane.
#[derive(Debug, Default)]
pub struct Squares {
    /// Faces normal to axis `a` are `axis_faces[a]..axis_faces[a + 1]`.
    pub axis_faces: [u32; 4],
    /// Loops of each face (counts summed up), corners of each loop.
    pub face_loops: Vec<u32>,
    pub loops: Csr<VertexId>,
    /// The lowest node of each face's square.
    pub node: Vec<NodeId>,
    /// What is below and above each square: a touched box, by its place among them, `FULL_CELL`, or `NONE`.
    pub sides: Vec<[CellId; 2]>,
}

/// What the planes' graphs are made of, by plane.
pub struct Contents {
    pub chords: Csr<Chord>,
    pub edges: Csr<EdgeId>,
    pub vertices: Csr<VertexId>,
}

/// What this stage reads.
pub struct Scene<'a> {
    pub all: &'a AllVertices<'a>,
    pub slabs: AllSlabs<'a>,
    pub lines: &'a Lines,
    pub touched: &'a Touched,
    pub contents: &'a Contents,
}

/// One plane: its knife, axis and node; u and w are its axes, right-handed about the normal.
#[derive(Clone, Copy)]
struct PlaneOf {
    knife: KnifeId,
    axis: usize,
    rank: u32,
    u: usize,
    w: usize,
}

pub fn squares(scene: &Scene) -> Result<Squares> {
    let ground = scene.slabs.ground;
    let planes: Vec<PlaneOf> = (0..3)
        .flat_map(|axis| (0..ground.lattice.nodes[axis].len() as u32).map(move |rank| (axis, rank)))
        .map(|(axis, rank)| {
            let knife = ground.knife(axis, rank);
            PlaneOf { knife, axis, rank, u: (axis + 1) % 3, w: (axis + 2) % 3 }
        })
        .collect();
    let mut out = Squares { face_loops: vec![0], ..Default::default() };
    // An axis at a time: what is joined is held twice only in part.
    for planes in planes.chunk_by(|p, q| p.axis == q.axis) {
        let parts: Vec<Result<Squares>> =
            planes.par_iter().map_init(Buffers::default, |buffers, plane| scene.plane(plane, buffers)).collect();
        let total = |count: fn(&Squares) -> usize| parts.iter().flatten().map(count).sum::<usize>();
        out.face_loops.reserve_exact(total(|p| p.node.len()));
        out.loops.items.reserve_exact(total(|p| p.loops.items.len()));
        out.loops.offsets.reserve_exact(total(|p| p.loops.len()));
        out.node.reserve_exact(total(|p| p.node.len()));
        out.sides.reserve_exact(total(|p| p.node.len()));
        for part in parts {
            let part = part?;
            let (loops, corners) = (out.loops.len() as u32, out.loops.items.len() as u32);
            out.face_loops.extend(part.face_loops[1..].iter().map(|l| l + loops));
            out.loops.items.extend(part.loops.items);
            out.loops.offsets.extend(part.loops.offsets[1..].iter().map(|o| o + corners));
            out.node.extend(part.node);
            out.sides.extend(part.sides);
        }
        out.axis_faces[planes[0].axis + 1..].fill(out.node.len() as u32);
    }
    Ok(out)
}

#[derive(Default)]
struct Buffers {
    map: LocalMap,
    section: Section,
    boxes: Vec<u64>,
    order: Vec<(u8, u32)>,
    row: Vec<u32>,
    vertices: Vec<VertexId>,
    faces: SectionFaces,
}

impl Scene<'_> {
    #[inline(always)]
    fn slabs_of(&self, v: VertexId) -> Slabs {
        match v.0.checked_sub(self.lines.first_node) {
            None => self.slabs.of(v),
            Some(n) => self.slabs.ground.lattice.node_at(self.lines.nodes[n as usize]).map(|i| 2 * i as u32 + 1),
        }
    }

    /// Whether the square of a plane in the given layers is one of a touched box.
    #[inline(always)]
    fn wanted(&self, p: &PlaneOf, u: i64, w: i64) -> bool {
        let lattice = &self.slabs.ground.lattice;
        if u < 0 || w < 0 || u >= lattice.count(p.u) as i64 || w >= lattice.count(p.w) as i64 {
            return false;
        }
        let mut at = [0; 3];
        (at[p.u], at[p.w]) = (u as usize, w as usize);
        let rank = p.rank as usize;
        let mut side = |layer: usize| {
            at[p.axis] = layer;
            self.touched.get(at)
        };
        (rank > 0 && side(rank - 1)) || (rank < lattice.count(p.axis) && side(rank))
    }

    fn plane(&self, p: &PlaneOf, buffers: &mut Buffers) -> Result<Squares> {
        let Buffers { map, section, boxes, order, row, vertices, faces } = buffers;
        let ground = self.slabs.ground;
        section.knife = p.knife;
        section.pieces.clear();
        for c in self.contents.chords.row(p.knife) {
            let carrier = Carrier::Chord(c.triangle);
            section.pieces.push(Piece { ends: c.ends, edge: EdgeId::NONE, carrier, left: true, right: false });
        }
        let first_edge = section.pieces.len();
        for &e in self.contents.edges.row(p.knife) {
            edge_pieces(self.all.surface, e, p.knife, &mut section.pieces);
        }
        let mut kept = first_edge;
        for i in first_edge..section.pieces.len() {
            if section.pieces[i].ends.iter().all(|&v| ground.in_block(&self.slabs.of(v))) {
                section.pieces.swap(kept, i);
                kept += 1;
            }
        }
        section.pieces.truncate(kept);
        section.pieces.iter_mut().for_each(|piece| self.trim(p, piece));
        self.grid_segments(p, true, &mut section.pieces, boxes)?;
        self.grid_segments(p, false, &mut section.pieces, boxes)?;
        let mut out = Squares { face_loops: vec![0], ..Default::default() };
        if section.pieces.is_empty() {
            return Ok(out);
        }
        map.prepare(self.all.origins.len());
        section.gather_stars(map);
        self.sort_stars(p, section, order, row);
        vertices.clear();
        let on_plane = self.contents.vertices.row(p.knife);
        vertices.extend(on_plane.iter().filter(|&&v| ground.in_block(&self.slabs.of(v))));
        faces.clear();
        let outcome = faces_of(self.all, vertices, section, map, false, faces);
        map.clear(section);
        section.vertices.clear();
        outcome?;
        for &first in &faces.faces[..faces.faces.len() - 1] {
            let outer = faces.loops.row(first as usize);
            let node = self.square_of(p, outer.iter().map(|c| c.0));
            out.node.push(node);
            out.sides.push(self.sides(p, node));
        }
        out.loops.items.extend(faces.loops.items.iter().map(|c| c.0));
        out.loops.offsets.clone_from(&faces.loops.offsets);
        out.face_loops.clone_from(&faces.faces);
        Ok(out)
    }

    /// Takes the faces off a surface piece's sides that are outside the block: only pieces on its rim have such a side.
    fn trim(&self, p: &PlaneOf, piece: &mut Piece) {
        let [a, b] = piece.ends.map(|v| self.slabs.of(v));
        for (axis, other, sign) in [(p.u, p.w, true), (p.w, p.u, false)] {
            let s = a[axis];
            let behind = self.slabs.ground.behind(axis);
            if s != b[axis] || !on_plane(s) || (s != 1 && s + 1 != behind) {
                continue;
            }
            // Upwards along w the left is −u; along u it is +w.
            let up = match a[other].cmp(&b[other]) {
                Ordering::Equal => self.all.compare_coordinate(piece.ends[0], piece.ends[1], other),
                order => order,
            } == Ordering::Less;
            let left_is_low = up == sign;
            if s == 1 {
                *(if left_is_low { &mut piece.left } else { &mut piece.right }) = false;
            }
            if s + 1 == behind {
                *(if left_is_low { &mut piece.right } else { &mut piece.left }) = false;
            }
        }
    }

    /// The segments of the grid lines of a plane along one of its axes.
    fn grid_segments(&self, p: &PlaneOf, along_u: bool, pieces: &mut Vec<Piece>, boxes: &mut Vec<u64>) -> Result<()> {
        let lattice = &self.slabs.ground.lattice;
        let (axis, across) = if along_u { (p.u, p.w) } else { (p.w, p.u) };
        let [b, c] = others(axis);
        let rows = [lattice.count(b), lattice.count(c)];
        for rank in 0..lattice.nodes[across].len() {
            let place = if b == across { [rank, p.rank as usize] } else { [p.rank as usize, rank] };
            self.touched.along[axis].around(place[0], place[1], rows, boxes);
            let other = self.slabs.ground.knife(across, rank as u32);
            self.lines.each_segment(self.slabs, axis, place, boxes, |from, to, layer| {
                let (layer, rank) = (layer as i64, rank as i64);
                // Along +u the left is +w; along +w it is −u.
                let (left, right) = if along_u {
                    (self.wanted(p, layer, rank), self.wanted(p, layer, rank - 1))
                } else {
                    (self.wanted(p, rank - 1, layer), self.wanted(p, rank, layer))
                };
                if left || right {
                    let carrier = Carrier::Line { other, against: false, ends: [from, to] };
                    pieces.push(Piece { ends: [from, to], edge: EdgeId::NONE, carrier, left, right });
                }
            })?;
        }
        Ok(())
    }

    fn sort_stars(&self, p: &PlaneOf, section: &mut Section, order: &mut Vec<(u8, u32)>, row: &mut Vec<u32>) {
        for v in 0..section.vertices.len() {
            let range = section.star.range(v);
            if range.len() <= 2 {
                continue;
            }
            let s = self.slabs_of(section.vertices[v]);
            let turn = |a: u32, b: u32| section.turn(self.all.surface, a, b);
            if !on_plane(s[p.u]) && !on_plane(s[p.w]) {
                row.clear();
                row.extend_from_slice(&section.star.items[range.clone()]);
                sort_cyclic(row, |a, b| turn(*a, *b), |a, b| a != b);
                section.star.items[range].copy_from_slice(row);
                continue;
            }
            order.clear();
            order.extend(section.star.items[range.clone()].iter().map(|&h| (self.direction(p, section, &s, h), h)));
            order.sort_by(|a, b| {
                a.0.cmp(&b.0).then_with(|| match a.0 & 1 != 0 {
                    // Half-edges of lines lie along an axis: these are the surface's.
                    true => match turn(a.1, b.1) {
                        Sign::Positive => Ordering::Less,
                        Sign::Zero => Ordering::Equal,
                        Sign::Negative => Ordering::Greater,
                    },
                    false => Ordering::Equal,
                })
            });
            section.star.items[range].iter_mut().zip(order.iter()).for_each(|(h, o)| *h = o.1);
        }
    }

    /// The direction of a half-edge from a vertex on a grid line, in eighths of a turn. On one line alone, a half-plane beside it counts as
    /// a quadrant.
    #[inline]
    fn direction(&self, p: &PlaneOf, section: &Section, s: &Slabs, h: u32) -> u8 {
        let target = section.target(h);
        let t = self.slabs_of(target);
        let (du, dw) = (t[p.u].cmp(&s[p.u]), t[p.w].cmp(&s[p.w]));
        let exactly = |axis: usize, by_slab: Ordering| match by_slab {
            Ordering::Equal => self.all.compare_coordinate(target, section.origin(h), axis),
            order => order,
        };
        match (on_plane(s[p.u]), on_plane(s[p.w])) {
            (true, true) => eighth(du, dw),
            // On a line along u: above it, below it, or on it.
            (false, true) => match dw {
                Ordering::Greater => 1,
                Ordering::Less => 5,
                Ordering::Equal => eighth(exactly(p.u, du), Ordering::Equal),
            },
            _ => match du {
                Ordering::Greater => 7,
                Ordering::Less => 3,
                Ordering::Equal => eighth(Ordering::Equal, exactly(p.w, dw)),
            },
        }
    }

    /// What is below and above a square.
    fn sides(&self, p: &PlaneOf, node: NodeId) -> [CellId; 2] {
        let lattice = &self.slabs.ground.lattice;
        let mut at = lattice.node_at(node);
        let mut side = |layer: Option<usize>| match layer.filter(|&l| l < lattice.count(p.axis)) {
            None => CellId::NONE,
            Some(layer) => {
                at[p.axis] = layer;
                if self.touched.get(at) { CellId::of(self.touched.rank(at)) } else { FULL_CELL }
            }
        };
        [side((p.rank as usize).checked_sub(1)), side(Some(p.rank as usize))]
    }

    /// The square that holds a loop of more than a line.
    fn square_of(&self, p: &PlaneOf, corners: impl Iterator<Item = VertexId>) -> NodeId {
        let mut low: Slabs = [u32::MAX; 3];
        for v in corners {
            let s = self.slabs_of(v);
            (low[p.u], low[p.w]) = (low[p.u].min(s[p.u]), low[p.w].min(s[p.w]));
        }
        let mut at = [0; 3];
        at[p.axis] = p.rank as usize;
        // The lowest corner is on the square's lower line or within its layer.
        for a in [p.u, p.w] {
            at[a] = (low[a] as usize).div_ceil(2).saturating_sub(1);
        }
        self.slabs.ground.lattice.node_id(at)
    }
}

impl Squares {
    pub fn check(&self) -> std::result::Result<(), String> {
        self.loops.check()?;
        if self.face_loops.len() != self.node.len() + 1
            || *self.face_loops.last().unwrap() as usize != self.loops.len()
            || self.axis_faces[3] as usize != self.node.len()
            || self.sides.len() != self.node.len()
        {
            return Err("faces in grid planes do not match their loops".into());
        }
        Ok(())
    }
}

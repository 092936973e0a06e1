//! The faces of a square whose loops do not follow from vertices alone: features that meet in a vertex, slits, holes, touching vertices.
//! Half-edges are ordered around each vertex, then `cut::faces` finds the faces, as it does for planes. What one square has
//! on its left is a union of whole sectors, so the half-edges of the square alone tell which one is next.
//!
//! Around a vertex on a grid line the order is that of the eight directions (along the axes, or in an open quadrant), from slabs alone; only
//! half-edges in one quadrant are compared by value.

use super::ground::{Slabs, on_plane};
use super::inside::eighth;
use super::squares::{HalfEdge, PlaneOf, Scene, Squares};
use crate::base::{Csr, EdgeId, Result, VertexId};
use crate::cut::faces::{SectionFaces, faces_of};
use crate::cut::sections::{Carrier, Piece, Section};
use crate::exact::{Sign, sort_cyclic};
use std::cmp::Ordering;

impl Scene<'_> {
    /// Appends the faces of one square. `edges`: the pieces of mesh edges in the plane; `bare`: mesh vertices in the square that no half-edge
    /// leaves.
    pub fn faces_of_square(
        &self,
        p: &PlaneOf,
        row: &[HalfEdge],
        edges: &[Piece],
        bare: &[VertexId],
        section: &mut Section,
        out: &mut Squares,
    ) -> Result<()> {
        section.knife = p.knife;
        section.pieces.clear();
        for (i, h) in row.iter().enumerate() {
            let against = h.id & 1 != 0;
            if i == 0 || row[i - 1].id / 2 != h.id / 2 {
                let ends = if against { [h.to, h.from] } else { [h.from, h.to] };
                let carrier = self.carrier(p, ends, h.id as usize / 2, edges);
                section.pieces.push(Piece { ends, edge: EdgeId::NONE, carrier, left: false, right: false });
            }
            if let Some(piece) = section.pieces.last_mut() {
                *(if against { &mut piece.right } else { &mut piece.left }) = true;
            }
        }
        gather_stars(section);
        self.sort_stars(p, section);
        let mut faces = SectionFaces::default();
        faces_of(self.all, bare.iter().copied(), section, false, &mut faces)?;
        for loops in faces.faces.windows(2) {
            for l in loops[0]..loops[1] {
                out.loops.items.extend(faces.loops.row(l as usize).iter().map(|c| c.0));
                out.loops.end_row();
            }
            out.face_loops.push(out.loops.len() as u32);
        }
        Ok(())
    }

    /// What the piece at a place in the plane lies on.
    fn carrier(&self, p: &PlaneOf, ends: [VertexId; 2], place: usize, edges: &[Piece]) -> Carrier {
        let chords = self.contents.chords.row(p.knife);
        if let Some(chord) = chords.get(place) {
            return Carrier::Chord(chord.triangle);
        }
        if let Some(piece) = edges.get(place - chords.len()) {
            return piece.carrier;
        }
        let [a, b] = ends.map(|v| self.slabs_of(v));
        let across = if a[p.w] == b[p.w] && on_plane(a[p.w]) { p.w } else { p.u };
        Carrier::Line { other: self.slabs.ground.knife(across, a[across] / 2), against: false, ends }
    }

    fn sort_stars(&self, p: &PlaneOf, section: &mut Section) {
        let (mut row, mut order): (Vec<u32>, Vec<(u8, u32)>) = Default::default();
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
                sort_cyclic(&mut row, |a, b| turn(*a, *b), |a, b| a != b);
                section.star.items[range].copy_from_slice(&row);
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
}

/// Numbers the vertices of a square's pieces and gathers the half-edges that leave each, in no order yet.
fn gather_stars(section: &mut Section) {
    let mut leaving: Vec<(VertexId, u32)> = Vec::with_capacity(2 * section.pieces.len());
    for (i, piece) in section.pieces.iter().enumerate() {
        leaving.extend([(piece.ends[0], 2 * i as u32), (piece.ends[1], 2 * i as u32 + 1)]);
    }
    leaving.sort_unstable();
    section.vertices.clear();
    section.star = Csr::default();
    for star in leaving.chunk_by(|a, b| a.0 == b.0) {
        section.vertices.push(star[0].0);
        section.star.items.extend(star.iter().map(|l| l.1));
        section.star.end_row();
    }
}

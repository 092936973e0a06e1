//! Whether fluid lies just beyond a point of the surface along an axis (DESIGN §11, "Inside without rays").
//!
//! A point inside a triangle: the normal's sign tells. A point on a mesh edge or a mesh vertex: in the grid plane through it that
//! holds the axis, the triangles around it leave *spokes*; the axis falls into one sector between them, whose label the
//! spokes bear. Spokes are put into the eight directions (along the axes, or in an open quadrant) by signs of
//! normals; only those in one quadrant are compared with each other. A spoke along the axis: the surface itself is there, no fluid.
//!
//! Cost: constant inside triangles; linear in the triangles around the point elsewhere.

use super::ground::Ground;
use crate::base::{EdgeId, TriangleId, VertexId};
use crate::cut::classify::KnifeId;
use crate::cut::sections::{Carrier, Piece, Section, edge_sides, touching_is_inside};
use crate::cut::surface::Surface;
use crate::exact::Sign;
use crate::mesh::projection::turn;
use std::cmp::Ordering;

/// Buffers for the spokes around a point.
#[derive(Default)]
pub struct Spokes {
    section: Section,
    /// Direction (eighths of a turn, counter-clockwise from the axis) and half-edge.
    order: Vec<(u8, u32)>,
}

/// Whether there is fluid just before and just behind vertex `v`, going along `axis`. The vertex is on a plane of each
/// other axis.
pub fn beside(ground: &Ground, surface: &Surface, v: VertexId, axis: usize, spokes: &mut Spokes) -> [bool; 2] {
    if v.0 >= ground.first_inner_point() {
        let t = surface.sub.point_triangle[(v.0 - ground.first_inner_point()) as usize];
        let [a, b, c] = &ground.mesh.corners(t);
        let n = turn(a, b, c, axis);
        return [n == Sign::Positive, n == Sign::Negative];
    }
    let normal = (axis + 2) % 3;
    let knife = ground.knife(normal, ground.slabs[v.at()][normal] / 2);
    spokes.gather(ground, surface, v, axis, knife);
    if spokes.order.is_empty() {
        let inside = v.0 < ground.first_edge_point() && touching_is_inside(surface, v, knife);
        return [inside; 2];
    }
    let label = |direction: u8| {
        let (section, order) = (&spokes.section, &spokes.order);
        let at = order.partition_point(|s| s.0 < direction);
        if order.get(at).is_some_and(|s| s.0 == direction) {
            return false;
        }
        section.inside_left(order[if at == 0 { order.len() - 1 } else { at - 1 }].1)
    };
    [label(4), label(0)]
}

/// The direction with the given signs, in eighths of a turn.
#[inline]
pub fn eighth(x: Ordering, y: Ordering) -> u8 {
    match (x, y) {
        (Ordering::Greater, Ordering::Equal) => 0,
        (Ordering::Greater, Ordering::Greater) => 1,
        (Ordering::Equal, Ordering::Greater) => 2,
        (Ordering::Less, Ordering::Greater) => 3,
        (Ordering::Less, Ordering::Equal) => 4,
        (Ordering::Less, Ordering::Less) => 5,
        (Ordering::Equal, Ordering::Less) => 6,
        (Ordering::Greater, Ordering::Less) => 7,
        (Ordering::Equal, Ordering::Equal) => 8,
    }
}

impl Spokes {
    fn gather(&mut self, ground: &Ground, surface: &Surface, v: VertexId, axis: usize, knife: KnifeId) {
        self.section.knife = knife;
        self.section.pieces.clear();
        self.order.clear();
        let mesh = &ground.mesh;
        let sides = &ground.classified.sides;
        let side = |v: VertexId| sides.side(&ground.knives, knife, v);
        if v.0 < ground.first_edge_point() {
            for &e in surface.edges_of_vertex(v) {
                let [a, b] = mesh.edges[e.at()];
                if side(if a == v { b } else { a }) == Sign::Zero {
                    self.along_edge(surface, e, axis, knife, if a == v { &[false] } else { &[true] });
                }
                // Each triangle at v has one side that starts there.
                for u in mesh.edge_uses.row(e) {
                    let corners = mesh.triangles[u.triangle.at()];
                    if corners[u.side()] == v {
                        let (p, q) = (side(corners[(u.side() + 1) % 3]), side(corners[(u.side() + 2) % 3]));
                        // Seen from v the third corner is on the left.
                        if p == -q && p != Sign::Zero {
                            self.chord(ground, u.triangle, axis, q == Sign::Positive);
                        }
                    }
                }
            }
        } else {
            let e = ground.points.edge[(v.0 - ground.first_edge_point()) as usize];
            if side(mesh.edges[e.at()][0]) == Sign::Zero {
                self.along_edge(surface, e, axis, knife, &[false, true]);
            } else {
                for u in mesh.edge_uses.row(e) {
                    // Seen from the side into the triangle, the side's start is on the left.
                    let start = mesh.triangles[u.triangle.at()][u.side()];
                    self.chord(ground, u.triangle, axis, side(start) == Sign::Positive);
                }
            }
        }
        let section = &self.section;
        self.order.sort_by(|a, b| {
            a.0.cmp(&b.0).then_with(|| match section.turn(surface, a.1, b.1) {
                Sign::Positive => Ordering::Less,
                Sign::Zero => Ordering::Equal,
                Sign::Negative => Ordering::Greater,
            })
        });
    }

    /// The half-edges of a mesh edge in the plane that leave the point: along it, or back.
    fn along_edge(&mut self, surface: &Surface, e: EdgeId, axis: usize, knife: KnifeId, backs: &[bool]) {
        let (left, right) = edge_sides(surface, e, knife);
        let [a, b] = surface.mesh.edges[e.at()];
        let (x, y) = (&surface.mesh.vertices[a.at()], &surface.mesh.vertices[b.at()]);
        let along = |i: usize| y[i].partial_cmp(&x[i]).unwrap_or(Ordering::Equal);
        for &back in backs {
            let turned = |o: Ordering| if back { o.reverse() } else { o };
            let direction = eighth(turned(along(axis)), turned(along((axis + 1) % 3)));
            self.push(Carrier::MeshEdge(e), direction, back, left, right);
        }
    }

    /// The half-edge of a chord that leaves the point, along n_P × n_T or against it.
    fn chord(&mut self, ground: &Ground, t: TriangleId, axis: usize, along: bool) {
        let [a, b, c] = &ground.mesh.corners(t);
        // With P's normal along the third axis, n_P × n = (−n_y, n_x).
        let (nx, ny) = (turn(a, b, c, axis), turn(a, b, c, (axis + 1) % 3));
        let (x, y) = if along { (-ny, nx) } else { (ny, -nx) };
        self.push(Carrier::Chord(t), eighth(x.to_ordering(), y.to_ordering()), !along, true, false);
    }

    fn push(&mut self, carrier: Carrier, direction: u8, back: bool, left: bool, right: bool) {
        let piece = self.section.pieces.len() as u32;
        self.section.pieces.push(Piece { ends: [VertexId::NONE; 2], edge: EdgeId::NONE, carrier, left, right });
        self.order.push((direction, 2 * piece + back as u32));
    }
}

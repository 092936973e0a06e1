//! Stage 4: where each plane meets the surface, as a graph in the plane with labels: which side of each piece is inside
//! the solid (paper, sections 3.2 and 4.1, appendix C).
//!
//! In plane P the surface leaves chord pieces (inside on the left when directed along n_P × n_T) and mesh edges that lie in P
//! (inside on neither, either or both sides). The *star* of a vertex is the counter-clockwise cycle of half-edges that
//! leave it; between two neighbours is a sector with one label. No ray is shot: whether a line P∩Q is inside beyond a vertex follows
//! from the sector that its direction falls into, and that follows from the side of Q on which the far ends of the star's
//! half-edges lie. Only where all of them are on one side and there are several sectors is a direction compared numerically.
//!
//! Directions are never constructed: in P, the direction of P∩Q is n_P × n_Q and (n_P×a)×(n_P×b) = n_P·det(n_P, a, b), so all
//! comparisons are 3×3 determinants of input normals (DESIGN §11).
//!
//! A vertex of P without any such half-edge is touched by the solid's surface from one side: its whole neighbourhood in P
//! has one label, found from the extreme edge of its fan (`touching_is_inside`).

use super::classify::KnifeId;
use super::surface::Surface;
use crate::base::{Csr, EdgeId, Error, Result, TriangleId, VertexId};
use crate::exact::{self, Direction, Sign, counters, sort_cyclic};
use crate::mesh::{self, EdgeUse};
use std::cmp::Ordering;

/// What a piece of a section lies on besides the plane.
#[derive(Clone, Copy, Debug)]
pub enum Carrier {
    /// A chord: the piece runs along +(n_P × n_T).
    Chord(TriangleId),
    /// A mesh edge in the plane: the piece runs from its lower vertex to its higher.
    MeshEdge(EdgeId),
    /// A line P∩Q: the piece runs along +(n_P × n_Q), or against it; `ends` are those of the whole inside segment, on the
    /// surface: a plane that crosses the segment has its ends on its two sides.
    Line { other: KnifeId, against: bool, ends: [VertexId; 2] },
}

#[derive(Clone, Copy, Debug)]
pub struct Piece {
    pub ends: [VertexId; 2],
    pub edge: EdgeId,
    pub carrier: Carrier,
    /// Whether left and right of the piece are inside the solid.
    pub left: bool,
    pub right: bool,
}

/// The graph of one plane. Half-edge `2i` runs along piece `i`, `2i + 1` against it.
#[derive(Debug, Default)]
pub struct Section {
    pub knife: KnifeId,
    pub pieces: Vec<Piece>,
    /// Vertices of the graph, in order of first use.
    pub vertices: Vec<VertexId>,
    /// Half-edges that leave each vertex, counter-clockwise.
    pub star: Csr<u32>,
}

/// A map from vertex ids to places in `Section::vertices`, reused between sections.
#[derive(Default)]
pub struct LocalMap {
    /// One more than the place, 0 for none: memory that no section touches is never brought in.
    place: Vec<u32>,
}

impl LocalMap {
    /// Room for so many vertices, while the map is empty.
    pub fn prepare(&mut self, vertex_count: usize) {
        if self.place.len() < vertex_count {
            self.place = vec![0; vertex_count];
        }
    }
    #[inline(always)]
    pub fn get(&self, v: VertexId) -> Option<usize> {
        (self.place[v.at()] as usize).checked_sub(1)
    }
    pub fn clear(&mut self, section: &Section) {
        for v in &section.vertices {
            self.place[v.at()] = 0;
        }
    }
}

/// What work on one section after the other needs, reused. The map is filled from `Section::gather_stars` on until it is cleared.
#[derive(Default)]
pub struct SectionScratch {
    pub section: Section,
    pub map: LocalMap,
}

impl Section {
    #[inline(always)]
    pub fn origin(&self, h: u32) -> VertexId {
        self.pieces[h as usize / 2].ends[h as usize & 1]
    }
    #[inline(always)]
    pub fn target(&self, h: u32) -> VertexId {
        self.pieces[h as usize / 2].ends[1 - (h as usize & 1)]
    }
    /// Whether the solid is inside on the left of a half-edge: then the half-edge bounds a face.
    #[inline(always)]
    pub fn inside_left(&self, h: u32) -> bool {
        let piece = &self.pieces[h as usize / 2];
        if h & 1 == 0 { piece.left } else { piece.right }
    }

    /// Numbers the vertices and gathers and sorts the stars. `map` is left filled.
    pub fn build_stars(&mut self, surface: &Surface, map: &mut LocalMap) {
        self.gather_stars(map);
        self.sort_stars(surface);
    }

    /// Numbers the vertices and gathers the stars, in no order yet. `map` is left filled.
    fn gather_stars(&mut self, map: &mut LocalMap) {
        map.clear(self);
        self.vertices.clear();
        for piece in &self.pieces {
            for v in piece.ends {
                if map.place[v.at()] == 0 {
                    self.vertices.push(v);
                    map.place[v.at()] = self.vertices.len() as u32;
                }
            }
        }
        let ends = self
            .pieces
            .iter()
            .enumerate()
            .flat_map(|(i, p)| [(p.ends[0], 2 * i as u32), (p.ends[1], 2 * i as u32 + 1)]);
        self.star.fill(self.vertices.len(), ends.map(|(v, h)| (map.place[v.at()] as usize - 1, h)));
    }

    fn sort_stars(&mut self, surface: &Surface) {
        let mut row = Vec::new();
        for v in 0..self.vertices.len() {
            let range = self.star.range(v);
            if range.len() <= 2 {
                counters::count_topology(counters::Predicate::CyclicOrder);
                continue;
            }
            row.clear();
            row.extend_from_slice(&self.star.items[range.clone()]);
            if let Some(order) = self.crossing_of_two_lines(surface, &row) {
                counters::count_topology(counters::Predicate::CyclicOrder);
                self.star.items[range].copy_from_slice(&order);
                continue;
            }
            let mut computed = false;
            // A line first: against a line, the order of surface pieces is the side of a plane, mostly known.
            if let Some(at) =
                row.iter().position(|&h| matches!(self.pieces[h as usize / 2].carrier, Carrier::Line { .. }))
            {
                row.swap(0, at);
            }
            let turn = |a: &u32, b: &u32| {
                computed |= self.line(*a).is_none() && self.line(*b).is_none();
                self.turn(surface, *a, *b)
            };
            sort_cyclic(&mut row, turn, |a, b| self.opposite(*a, *b));
            count_order(computed);
            self.star.items[range].copy_from_slice(&row);
        }
    }

    /// The star of a plain point inside, where two lines cross: one side tells the order of all four half-edges.
    fn crossing_of_two_lines(&self, surface: &Surface, row: &[u32]) -> Option<[u32; 4]> {
        let &[a, b, c, d] = row else { return None };
        let line = |h: u32| self.line(h).map(|l| l.0);
        let [la, lb, lc, ld] = [line(a)?, line(b)?, line(c)?, line(d)?];
        let (back, x, y) = if la == lb && lc == ld {
            (b, c, d)
        } else if la == lc && lb == ld {
            (c, b, d)
        } else if la == ld && lb == lc {
            (d, b, c)
        } else {
            return None;
        };
        match self.turn(surface, a, x) {
            Sign::Positive => Some([a, x, back, y]),
            Sign::Negative => Some([a, y, back, x]),
            Sign::Zero => None,
        }
    }

    /// A half-edge's direction: a covector m (its direction is n_P × m, negated if the flag is set), or a vector.
    fn heading(&self, surface: &Surface, h: u32) -> Heading {
        let back = h & 1 != 0;
        match self.pieces[h as usize / 2].carrier {
            Carrier::Chord(t) => Heading::Across(Direction::Triangle(surface.mesh.corners(t)), back),
            Carrier::Line { other, against, .. } => Heading::Across(surface.knives.normal(other), back != against),
            Carrier::MeshEdge(e) => {
                let [a, b] = surface.mesh.edges[e.at()].map(|v| surface.mesh.vertices[v.at()]);
                Heading::Along(Direction::Between(a, b), back)
            }
        }
    }

    /// The other plane of a half-edge on a line, and whether the half-edge runs against n_P × n_Q.
    fn line(&self, h: u32) -> Option<(KnifeId, bool)> {
        match self.pieces[h as usize / 2].carrier {
            Carrier::Line { other, against, .. } => Some((other, against != (h & 1 != 0))),
            _ => None,
        }
    }

    /// A vertex of the surface ahead of a half-edge: on the same side of every plane through the half-edge's origin as the
    /// half-edge itself.
    fn ahead(&self, h: u32) -> VertexId {
        match self.pieces[h as usize / 2].carrier {
            Carrier::Line { ends, .. } => ends[1 - (h as usize & 1)],
            _ => self.target(h),
        }
    }

    /// Sign of the sine of the angle from half-edge `a` to half-edge `b` (both leave the same vertex).
    pub fn turn(&self, surface: &Surface, a: u32, b: u32) -> Sign {
        // Left of +(n_P × n_Q) is the negative side of Q.
        if let Some((q, against)) = self.line(b) {
            negate_if(surface.side(q, self.ahead(a)), against)
        } else if let Some((q, against)) = self.line(a) {
            negate_if(-surface.side(q, self.ahead(b)), against)
        } else {
            self.turn_by_value(surface, a, b)
        }
    }

    fn turn_by_value(&self, surface: &Surface, a: u32, b: u32) -> Sign {
        if a / 2 == b / 2 {
            return Sign::Zero;
        }
        let n = surface.knives.normal(self.knife);
        match (self.heading(surface, a), self.heading(surface, b)) {
            (Heading::Across(l, ls), Heading::Across(m, ms)) => negate_if(exact::determinant(&n, &l, &m), ls != ms),
            (Heading::Across(m, s), Heading::Along(w, t)) => negate_if(-exact::dot(&m, &w), s != t),
            (Heading::Along(w, t), Heading::Across(m, s)) => negate_if(exact::dot(&m, &w), s != t),
            (Heading::Along(w, s), Heading::Along(x, t)) => negate_if(exact::determinant(&n, &w, &x), s != t),
        }
    }

    /// Two half-edges on a common line that leave the same vertex are opposite unless they overlap, which a valid surface
    /// excludes: only a half-edge compared with itself is equal.
    fn opposite(&self, a: u32, b: u32) -> bool {
        a != b
    }

    /// Whether the solid is inside just beyond vertex `v` along ±(n_P × n_Q) (`against`: the minus sign). `next` is the
    /// next vertex of the surface in that direction: a half-edge that leads there makes the segment part of the surface.
    pub fn inside_along(
        &self,
        surface: &Surface,
        map: &LocalMap,
        v: VertexId,
        q: KnifeId,
        against: bool,
        next: VertexId,
    ) -> Result<bool> {
        let Some(place) = map.get(v) else {
            // A point of an edge or a triangle is without a star only if the edge or triangle lies in the plane with
            // nothing inside beside it.
            let is_corner = v.0 < surface.numbering.first_edge_point;
            return Ok(is_corner && touching_is_inside(surface, v, self.knife));
        };
        let star = self.star.row(place);
        // Where a half-edge is, counter-clockwise from the direction: 1 left of the line, 2 straight back, 3 right.
        let code = |h: u32| -> u8 {
            match negate_if(surface.side(q, self.target(h)), against) {
                Sign::Negative => 1,
                Sign::Zero => 2,
                Sign::Positive => 3,
            }
        };
        let mut fall = None;
        let mut previous = code(star[star.len() - 1]);
        let mut previous_at = star.len() - 1;
        for (i, &h) in star.iter().enumerate() {
            if self.target(h) == next {
                return Ok(false);
            }
            let here = code(h);
            if previous > here {
                fall = Some(previous_at);
            }
            (previous, previous_at) = (here, i);
        }
        count_order(fall.is_none() && star.len() > 1);
        let gap = match fall {
            Some(gap) => gap,
            None if star.len() == 1 => 0,
            // All on one side of the line: the direction is in the sector wider than 180 degrees.
            None => (0..star.len())
                .find(|&i| self.turn_by_value(surface, star[i], star[(i + 1) % star.len()]) == Sign::Negative)
                .ok_or_else(|| Error::inconsistent(format!("no sector at vertex {} holds a line", v.0)))?,
        };
        Ok(self.inside_left(star[gap]))
    }
}

/// Counts an order of directions: known, or computed from coordinates. (The signs computed for it are counted by tier
/// under `Direction`.)
fn count_order(computed: bool) {
    let tier = if computed { counters::Tier::Filter } else { counters::Tier::Topology };
    counters::count(counters::Predicate::CyclicOrder, tier);
}

enum Heading {
    Across(Direction, bool),
    Along(Direction, bool),
}

#[inline(always)]
pub fn negate_if(sign: Sign, negate: bool) -> Sign {
    if negate { -sign } else { sign }
}

/// What lies in each plane, by counting sort.
pub struct PlaneContents {
    /// Chords in each knife, and whether the knife's positive side is on the chord's right.
    pub chords: Csr<(u32, bool)>,
    /// Mesh edges in each knife.
    pub edges: Csr<EdgeId>,
    /// Mesh vertices on each knife.
    pub vertices: Csr<VertexId>,
}

pub fn plane_contents(surface: &Surface) -> PlaneContents {
    let count = surface.knives.len();
    let chords = &surface.sub.chord_knives;
    let edges = &surface.classified.edges_on;
    PlaneContents {
        chords: Csr::from_positions(count, chords.len(), |range| {
            range.flat_map(|c| chords.row(c).iter().map(move |k| (k.knife.at(), (c as u32, k.flip))))
        }),
        edges: Csr::from_positions(count, edges.len(), |range| edges[range].iter().map(|&(e, k)| (k.at(), e))),
        vertices: vertices_on(count, &surface.classified.vertex_knives),
    }
}

/// Mesh vertices on each of `count` knives.
pub fn vertices_on(count: usize, vertex_knives: &Csr<KnifeId>) -> Csr<VertexId> {
    Csr::from_positions(count, vertex_knives.len(), |range| {
        range.flat_map(|v| vertex_knives.row(v).iter().map(move |k| (k.at(), VertexId::of(v))))
    })
}

/// Adds the surface's pieces in one plane.
pub fn surface_pieces(surface: &Surface, contents: &PlaneContents, knife: KnifeId, pieces: &mut Vec<Piece>) {
    let sub = surface.sub;
    for &(chord, flip) in contents.chords.row(knife) {
        let carrier = Carrier::Chord(sub.chord_triangle[chord as usize]);
        let range = sub.chord_pieces[chord as usize]..sub.chord_pieces[chord as usize + 1];
        for i in range {
            let [a, b] = sub.pieces[i as usize];
            let ends = if flip { [b, a] } else { [a, b] };
            let edge = EdgeId(surface.numbering.first_chord_piece + i);
            pieces.push(Piece { ends, edge, carrier, left: true, right: false });
        }
    }
    for &e in contents.edges.row(knife) {
        edge_pieces(surface, e, knife, pieces);
    }
}

/// The pieces of a mesh edge that lies in a plane, unless neither side of it is inside.
pub fn edge_pieces(surface: &Surface, e: EdgeId, knife: KnifeId, pieces: &mut Vec<Piece>) {
    let (left, right) = edge_sides(surface, e, knife);
    if !left && !right {
        return;
    }
    let first = super::triangles::edge_piece(surface.points, e);
    let count = surface.points.count(e) as u32;
    let first_point = surface.numbering.first_edge_point + surface.points.first[e.at()];
    let [a, b] = surface.mesh.edges[e.at()];
    let at = |i: u32| if i == 0 { a } else { VertexId(first_point + i - 1) };
    for i in 0..=count {
        let ends = [at(i), if i == count { b } else { at(i + 1) }];
        pieces.push(Piece { ends, edge: EdgeId(first + i), carrier: Carrier::MeshEdge(e), left, right });
    }
}

/// The corner of a triangle that is not on its side `side`.
fn apex(surface: &Surface, u: EdgeUse) -> VertexId {
    surface.mesh.triangles[u.triangle.at()][(u.side() + 2) % 3]
}

/// Which sides of a mesh edge (from its lower vertex to its higher) are inside the solid, in a plane that holds the edge.
///
/// Solid wedges run counter-clockwise around the edge from a triangle that walks it backward to one that walks it
/// forward. The half-plane on the left is n_P × w, so the turn from a triangle to it is minus the side of the
/// triangle's apex; a wedge wider than 180 degrees is told from a narrow one only where that matters.
pub fn edge_sides(surface: &Surface, e: EdgeId, knife: KnifeId) -> (bool, bool) {
    let mut mates = Vec::new();
    mesh::wedge_mates(surface.mesh, e, &mut Default::default(), &mut mates);
    let mut sides = [false; 2];
    for [backward, forward] in mates {
        let side_of = |u: EdgeUse| surface.classified.sides.side(surface.knives, knife, apex(surface, u));
        let (from, to) = (side_of(backward), side_of(forward));
        for (inside, (enter, leave)) in sides.iter_mut().zip([(-from, to), (from, -to)]) {
            let (in_enter, in_leave) = (enter == Sign::Positive, leave == Sign::Positive);
            *inside |= match (in_enter, in_leave) {
                (true, true) => true,
                (false, false) => false,
                _ => match wedge_turn(surface, e, backward, forward) {
                    Sign::Positive => false,
                    Sign::Zero => in_enter,
                    Sign::Negative => true,
                },
            };
        }
    }
    (sides[0], sides[1])
}

/// Sign of the sine of the wedge's angle: positive below 180 degrees.
fn wedge_turn(surface: &Surface, e: EdgeId, backward: EdgeUse, forward: EdgeUse) -> Sign {
    let x = |v: VertexId| &surface.mesh.vertices[v.at()];
    let [a, b] = surface.mesh.edges[e.at()];
    exact::orient3d(x(a), x(b), x(apex(surface, backward)), x(apex(surface, forward)))
}

/// Whether the neighbourhood in P of a mesh vertex on P that no piece of P's section touches is inside the solid.
///
/// If some mesh edge at the vertex lies in P, it does so among coplanar triangles or outside: not inside. Else the fan lies
/// strictly on one side or both. Seen by central projection from the vertex, the fan on one side is a set of polygons in a
/// plane parallel to P, and P's neighbourhood is their unbounded region; at the lexicographically lowest polygon
/// vertex, that is at an extreme mesh edge, the region is the sector wider than 180 degrees.
pub fn touching_is_inside(surface: &Surface, v: VertexId, knife: KnifeId) -> bool {
    let mesh = surface.mesh;
    let n = surface.knives.plane(knife).n;
    let (ax, ay) = projection_axes(&n);
    let mut best: Option<(EdgeId, VertexId)> = None;
    let mut side = Sign::Zero;
    for &e in surface.edges_of_vertex(v) {
        let [a, b] = mesh.edges[e.at()];
        let far = if a == v { b } else { a };
        let here = surface.classified.sides.side(surface.knives, knife, far);
        if here == Sign::Zero {
            return false;
        }
        if side == Sign::Zero || here == side {
            let better = match best {
                None => true,
                Some((_, old)) => {
                    let x = |v: VertexId| &mesh.vertices[v.at()];
                    exact::compare_projected(x(v), x(far), x(old), &n, ax)
                        .then_with(|| exact::compare_projected(x(v), x(far), x(old), &n, ay))
                        == Ordering::Less
                }
            };
            if better {
                best = Some((e, far));
            }
            side = here;
        }
    }
    let Some((e, _)) = best else { return false };
    let mut mates = Vec::new();
    mesh::wedge_mates(mesh, e, &mut Default::default(), &mut mates);
    mates.iter().any(|&[backward, forward]| wedge_turn(surface, e, backward, forward) == Sign::Negative)
}

/// Two coordinate axes in which a plane is seen without folding and with its normal towards the viewer: counter-clockwise in the
/// plane is counter-clockwise in the projection.
pub fn projection_axes(n: &[f64; 3]) -> (usize, usize) {
    let k = (0..3).max_by(|&i, &j| n[i].abs().total_cmp(&n[j].abs())).unwrap();
    let (x, y) = ((k + 1) % 3, (k + 2) % 3);
    if n[k] > 0.0 { (x, y) } else { (y, x) }
}

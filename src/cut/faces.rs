//! Stage 6: the faces of each plane: its section with the lines added, as loops, and holes joined to the face around them
//! (paper, section 4.2; DESIGN §11, "Nesting in cut").
//!
//! A loop with a piece of a line is an outer loop: a line runs on through every obstacle to the outer boundary, so what it
//! belongs to is connected to that boundary. Hole loops are therefore whole uncut curves of the surface, slits along mesh
//! edges, and single touching vertices: few. Whether an uncut curve is outer or a hole follows from the sector at its lexicographically lowest
//! vertex; a hole is joined by its first hit from there, never by parity.

use super::lines::Lines;
use super::sections::{Carrier, LocalMap, Piece, PlaneContents, Section, projection_axes, touching_is_inside};
use super::surface::Surface;
use crate::base::{Csr, EdgeId, Error, Result, VertexId};
use crate::complex::locate::{PlanarPoints, RayStart, Strips};
use crate::complex::loops::trace_loops;
use crate::complex::{Origin, data::origin_point};
use crate::exact::{self, Point, Sign, counters};
use rayon::prelude::*;
use std::cmp::Ordering;

/// All vertices, inner ones included.
pub struct AllVertices<'a> {
    pub surface: &'a Surface<'a>,
    pub origins: &'a [Origin],
    pub coords: &'a [[f64; 3]],
}

impl AllVertices<'_> {
    pub fn point(&self, v: VertexId) -> Point {
        origin_point(self.surface.mesh, self.surface.input_planes, self.origins[v.at()])
    }

    /// Orders two vertices by a coordinate.
    pub fn compare_coordinate(&self, a: VertexId, b: VertexId, axis: usize) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        let (x, y) = (self.coords[a.at()][axis], self.coords[b.at()][axis]);
        exact::compare_rounded(x, y, || self.point(a), || self.point(b), axis)
    }
}

/// The vertices of one plane, as its subdivision is seen.
pub struct Seen<'a> {
    pub all: &'a AllVertices<'a>,
    pub axes: (usize, usize),
}

impl PlanarPoints for Seen<'_> {
    fn compare_height(&self, a: VertexId, b: VertexId) -> Ordering {
        self.all.compare_coordinate(a, b, self.axes.1)
    }
    fn turn(&self, a: VertexId, b: VertexId, c: VertexId) -> Sign {
        if a == b || b == c || a == c {
            return Sign::Zero;
        }
        let point = |v| self.all.point(v);
        exact::turn_projected(&point(a), &point(b), &point(c), self.axes.0, self.axes.1)
    }
    fn rounded_height(&self, v: VertexId) -> f64 {
        self.all.coords[v.at()][self.axes.1]
    }
}

struct FromVertex<'a> {
    seen: &'a Seen<'a>,
    vertex: VertexId,
}

impl RayStart for FromVertex<'_> {
    fn compare_height(&self, v: VertexId) -> Ordering {
        self.seen.compare_height(v, self.vertex)
    }
    fn turn(&self, a: VertexId, b: VertexId) -> Sign {
        self.seen.turn(a, b, self.vertex)
    }
    fn rounded_height(&self) -> f64 {
        self.seen.rounded_height(self.vertex)
    }
}

/// The faces of one plane.
#[derive(Debug, Default)]
pub struct SectionFaces {
    /// Loops of each face, outer loop first.
    pub faces: Csr<u32>,
    /// Corners of each loop: vertex, and edge to the next corner (`NONE` for a single vertex).
    pub loops: Csr<(VertexId, EdgeId)>,
    /// The face on the left of each half-edge, kept where voids may have to be located.
    pub face_of_half_edge: Vec<u32>,
}

/// Adds the lines to all sections and finds their faces. `first_line_edge` is the first edge id of line pieces.
pub fn section_faces(
    all: &AllVertices,
    contents: &PlaneContents,
    sections: &mut [Section],
    lines: &Lines,
    first_line_edge: u32,
    keep_half_edges: bool,
) -> Result<Vec<SectionFaces>> {
    let lines_of = Csr::from_pairs(
        sections.len(),
        (0..lines.knives.len()).flat_map(|l| lines.knives.range(l).map(move |k| (l, k))).map(|(l, k)| {
            let knife = lines.knives.items[k];
            (knife.knife.at(), (l as u32, knife))
        }),
    );
    sections
        .par_iter_mut()
        .enumerate()
        .map_init(LocalMap::default, |map, (k, section)| {
            for &(l, knife) in lines_of.row(k) {
                for s in lines.segments[l as usize]..lines.segments[l as usize + 1] {
                    let points = lines.points.range(s as usize);
                    let first = first_line_edge + s + points.start as u32;
                    let [from, to] = lines.ends[s as usize];
                    let carrier = Carrier::Line { other: knife.other, against: knife.against, ends: [from, to] };
                    let inner = &lines.points.items[points];
                    let mut previous = from;
                    for (i, &v) in inner.iter().chain(std::iter::once(&to)).enumerate() {
                        let ends = [previous, v];
                        let edge = EdgeId(first + i as u32);
                        section.pieces.push(Piece { ends, edge, carrier, left: true, right: true });
                        previous = v;
                    }
                }
            }
            map.prepare(all.origins.len());
            section.build_stars(all.surface, map);
            let bare = contents.vertices.row(section.knife).iter().copied().filter(|&v| map.get(v).is_none());
            let faces = faces_of(all, bare, section, keep_half_edges);
            map.clear(section);
            faces
        })
        .collect()
}

/// The faces of one section with its lines. `bare`: the mesh vertices on the plane that no piece ends at, which may touch a face.
pub fn faces_of(
    all: &AllVertices,
    bare: impl Iterator<Item = VertexId>,
    section: &Section,
    keep_half_edges: bool,
) -> Result<SectionFaces> {
    let surface = all.surface;
    let loops = trace_loops(2 * section.pieces.len(), &section.star, |h| section.inside_left(h)).map_err(|h| {
        Error::inconsistent(format!(
            "the section of plane {} is inside on one side of a corner and outside on the other at vertex {}: the surface \
             intersects itself",
            surface.knives.ids[section.knife.at()].0,
            section.target(h).0
        ))
    })?;
    let touching: Vec<VertexId> = bare.filter(|&v| touching_is_inside(surface, v, section.knife)).collect();
    let axes = projection_axes(&surface.knives.plane(section.knife).n);
    let seen = Seen { all, axes };
    let is_line = |h: u32| matches!(section.pieces[h as usize / 2].carrier, Carrier::Line { .. });
    // Outer loops, and the lowest vertex of every hole loop.
    let mut face_of_loop = vec![u32::MAX; loops.len() + touching.len()];
    let mut outer_count = 0u32;
    let mut holes: Vec<(u32, VertexId)> = Vec::new();
    for (l, row) in loops.rows().enumerate() {
        let lowest = if loops.len() == 1 || row.iter().any(|&h| is_line(h)) {
            counters::count_topology(counters::Predicate::LoopOrientation);
            None
        } else {
            counters::count(counters::Predicate::LoopOrientation, counters::Tier::Filter);
            hole_bottom(all, surface, section, row, axes)
        };
        match lowest {
            None if row.len() < 3 => {
                return Err(Error::inconsistent(format!(
                    "the section of plane {} has a face without area: the surface intersects itself",
                    surface.knives.ids[section.knife.at()].0
                )));
            }
            None => {
                face_of_loop[l] = outer_count;
                outer_count += 1;
            }
            Some(v) => holes.push((l as u32, v)),
        }
    }
    holes.extend(touching.iter().enumerate().map(|(i, &v)| ((loops.len() + i) as u32, v)));
    let mut loop_of = Vec::new();
    if !holes.is_empty() || keep_half_edges {
        loop_of = vec![u32::MAX; 2 * section.pieces.len()];
        for (l, row) in loops.rows().enumerate() {
            row.iter().for_each(|&h| loop_of[h as usize] = l as u32);
        }
    }
    if !holes.is_empty() {
        join_holes(section, &seen, &holes, &loop_of, &mut face_of_loop)?;
    }
    let mut out = SectionFaces::default();
    for row in loops.rows() {
        out.loops.items.extend(row.iter().map(|&h| (section.origin(h), section.pieces[h as usize / 2].edge)));
        out.loops.end_row();
    }
    for &v in &touching {
        out.loops.push_row(&[(v, EdgeId::NONE)]);
    }
    // Outer loops first: they were numbered in loop order, and the counting sort keeps that order within a face.
    let is_hole = |l: u32| holes.binary_search_by_key(&l, |h| h.0).is_ok();
    let count = face_of_loop.len() as u32;
    let ordered = (0..count).filter(|&l| !is_hole(l)).chain((0..count).filter(|&l| is_hole(l)));
    out.faces = Csr::from_pairs(outer_count as usize, ordered.map(|l| (face_of_loop[l as usize] as usize, l)));
    if keep_half_edges {
        out.face_of_half_edge =
            loop_of.iter().map(|&l| if l == u32::MAX { l } else { face_of_loop[l as usize] }).collect();
    }
    Ok(out)
}

/// For a loop of surface pieces alone: `None` if it is an outer loop, its lexicographically lowest vertex if it is a hole.
///
/// All of the loop is to the right of that vertex, so the loop is a hole exactly when one of its corners there has
/// its sector on the far side: from the outgoing half-edge counter-clockwise through −x to the way back.
fn hole_bottom(
    all: &AllVertices,
    surface: &Surface,
    section: &Section,
    row: &[u32],
    axes: (usize, usize),
) -> Option<VertexId> {
    let mut lowest = section.origin(row[0]);
    for &h in &row[1..] {
        let v = section.origin(h);
        let order = all.compare_coordinate(v, lowest, axes.0).then_with(|| all.compare_coordinate(v, lowest, axes.1));
        if order == Ordering::Less {
            lowest = v;
        }
    }
    let hole = (0..row.len()).filter(|&i| section.origin(row[i]) == lowest).any(|i| {
        let (out, back) = (row[i], row[if i == 0 { row.len() - 1 } else { i - 1 }] ^ 1);
        section.turn(surface, back, out) != Sign::Negative
    });
    hole.then_some(lowest)
}

fn join_holes(
    section: &Section,
    seen: &Seen,
    holes: &[(u32, VertexId)],
    loop_of: &[u32],
    face_of_loop: &mut [u32],
) -> Result<()> {
    let pieces: Vec<[VertexId; 2]> = section.pieces.iter().map(|p| p.ends).collect();
    let strips = Strips::new(&pieces, seen, holes.len());
    let mut seen_from: Vec<u32> = Vec::with_capacity(holes.len());
    for &(_, vertex) in holes {
        let hit = strips.first_hit(&pieces, seen, &FromVertex { seen, vertex }).map(|h| loop_of[h as usize]);
        match hit {
            Some(l) if l != u32::MAX => seen_from.push(l),
            _ => {
                return Err(Error::inconsistent(format!(
                    "no face of plane {} surrounds the hole at vertex {}: the surface intersects itself",
                    seen.all.surface.knives.ids[section.knife.at()].0,
                    vertex.0
                )));
            }
        }
    }
    // A hit loop may be a hole itself; its bottom is lexicographically lower, so the chain ends at an outer loop.
    for (i, &(l, _)) in holes.iter().enumerate() {
        let mut at = seen_from[i];
        let mut steps = 0;
        while face_of_loop[at as usize] == u32::MAX {
            let next = holes.binary_search_by_key(&at, |h| h.0).ok();
            steps += 1;
            let Some(next) = next.filter(|_| steps <= holes.len()) else {
                return Err(Error::inconsistent("hole loops of a plane see each other in a circle"));
            };
            at = seen_from[next];
        }
        face_of_loop[l as usize] = face_of_loop[at as usize];
    }
    Ok(())
}

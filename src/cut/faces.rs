//! Stage 6: the faces of each plane: its section with the lines added, as loops, and holes joined to the face around them
//! (paper, section 4.2; DESIGN §11, "Nesting in cut").
//!
//! A loop with a piece of a line is an outer loop: a line runs on through every obstacle to the outer boundary, so what it
//! belongs to is connected to that boundary. Hole loops are therefore whole uncut curves of the surface, slits along mesh
//! edges, and single touching vertices: few. Whether an uncut curve is outer or a hole follows from the sector at its lexicographically lowest
//! vertex; a hole is joined by its first hit from there, never by parity.

use super::classify::KnifeId;
use super::lines::{LineKnife, Lines};
use super::sections::{Carrier, Piece, PlaneContents, Section, SectionScratch, projection_axes, touching_is_inside};
use super::surface::Surface;
use crate::base::parallel::{Pool, each_part, offsets};
use crate::base::{Csr, EdgeId, Error, Result, VertexId};
use crate::complex::locate::{PlanarPoints, RayStart, Strips};
use crate::complex::loops::trace_loops;
use crate::complex::{Origin, data::origin_point};
use crate::exact::{self, Point, Sign, counters};
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

/// The faces of some planes, one plane behind the other.
#[derive(Debug)]
pub struct SectionFaces {
    /// Plane `i` of them has faces `planes[i]..planes[i + 1]`.
    pub planes: Vec<u32>,
    /// Face `f` has loops `faces[f]..faces[f + 1]`, the outer loop first.
    pub faces: Vec<u32>,
    /// Corners of each loop: vertex, and edge to the next corner (`NONE` for a single vertex).
    pub loops: Csr<(VertexId, EdgeId)>,
    /// Each plane's graph, and the face (among the plane's) on the left of each half-edge; kept where voids may have to be located.
    pub graphs: Vec<(Section, Vec<u32>)>,
}

impl Default for SectionFaces {
    fn default() -> Self {
        Self { planes: vec![0], faces: vec![0], loops: Csr::default(), graphs: Vec::new() }
    }
}

impl SectionFaces {
    /// Forgets all planes, and keeps the memory.
    pub fn clear(&mut self) {
        self.planes.truncate(1);
        self.faces.truncate(1);
        self.loops.offsets.truncate(1);
        self.loops.items.clear();
        self.graphs.clear();
    }
}

/// Adds the lines to all sections, given by the surface's pieces in them, and finds their faces: for each list of planes, theirs.
/// `first_line_edge` is the first edge id of line pieces.
pub fn section_faces(
    all: &AllVertices,
    contents: &PlaneContents,
    pieces: Vec<Csr<Piece>>,
    lines: &Lines,
    first_line_edge: u32,
    pool: &Pool<SectionScratch>,
    keep_graphs: bool,
) -> Result<Vec<SectionFaces>> {
    let lines_of = Csr::from_positions(all.surface.knives.len(), lines.knives.len(), |range| {
        range.flat_map(|l| lines.knives.row(l).iter().map(move |k| (k.knife.at(), (l as u32, *k))))
    });
    let first = offsets(pieces.iter().map(Csr::len));
    let parts = each_part(pieces, |i, pieces| {
        pool.with(|SectionScratch { section, map }| {
            let mut out = SectionFaces::default();
            for (row, k) in (first[i]..first[i + 1]).enumerate() {
                section.knife = KnifeId::of(k);
                section.pieces.clear();
                section.pieces.extend_from_slice(pieces.row(row));
                for &(l, knife) in lines_of.row(k) {
                    add_line(lines, l as usize, &knife, first_line_edge, &mut section.pieces);
                }
                map.prepare(all.origins.len());
                section.build_stars(all.surface, map);
                let bare = contents.vertices.row(k).iter().copied().filter(|&v| map.get(v).is_none());
                let outcome = faces_of(all, bare, section, keep_graphs, &mut out);
                map.clear(section);
                section.vertices.clear();
                outcome?;
                if keep_graphs {
                    out.graphs.last_mut().expect("a graph per plane").0 = std::mem::take(section);
                }
            }
            Ok(out)
        })
    });
    // The first error, whichever thread was faster.
    parts.into_iter().collect()
}

/// Adds the pieces of a line to those of one of its planes.
fn add_line(lines: &Lines, l: usize, knife: &LineKnife, first_line_edge: u32, pieces: &mut Vec<Piece>) {
    for s in lines.segments[l]..lines.segments[l + 1] {
        let points = lines.points.range(s as usize);
        let first = first_line_edge + s + points.start as u32;
        let [from, to] = lines.ends[s as usize];
        let carrier = Carrier::Line { other: knife.other, against: knife.against, ends: [from, to] };
        let mut previous = from;
        for (i, &v) in lines.points.items[points].iter().chain(std::iter::once(&to)).enumerate() {
            let edge = EdgeId(first + i as u32);
            pieces.push(Piece { ends: [previous, v], edge, carrier, left: true, right: true });
            previous = v;
        }
    }
}

/// Adds the faces of one section with its lines. `bare`: the mesh vertices on the plane that no
/// piece ends at, which may touch a face.
pub fn faces_of(
    all: &AllVertices,
    bare: impl Iterator<Item = VertexId>,
    section: &Section,
    keep_graph: bool,
    out: &mut SectionFaces,
) -> Result<()> {
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
    if !holes.is_empty() || keep_graph {
        loop_of = vec![u32::MAX; 2 * section.pieces.len()];
        for (l, row) in loops.rows().enumerate() {
            row.iter().for_each(|&h| loop_of[h as usize] = l as u32);
        }
    }
    if !holes.is_empty() {
        join_holes(section, &seen, &holes, &loop_of, &mut face_of_loop)?;
    }
    let corner = |h: u32| (section.origin(h), section.pieces[h as usize / 2].edge);
    let mut push_loop = |l: usize| {
        match touching.get(l.wrapping_sub(loops.len())) {
            Some(&v) => out.loops.items.push((v, EdgeId::NONE)),
            None => out.loops.items.extend(loops.row(l).iter().map(|&h| corner(h))),
        }
        out.loops.end_row();
    };
    // Outer loops are numbered in loop order.
    let first = *out.faces.last().expect("an offset before the first face");
    let face_count = out.faces.len() as u32 - 1;
    if holes.is_empty() {
        (0..loops.len()).for_each(&mut push_loop);
        out.faces.extend((1..=outer_count).map(|f| first + f));
    } else {
        // Outer loops first: the counting sort keeps the order within a face.
        let is_hole = |l: u32| holes.binary_search_by_key(&l, |h| h.0).is_ok();
        let count = face_of_loop.len() as u32;
        let ordered = (0..count).filter(|&l| !is_hole(l)).chain((0..count).filter(|&l| is_hole(l)));
        let faces = Csr::from_pairs(outer_count as usize, ordered.map(|l| (face_of_loop[l as usize] as usize, l)));
        faces.items.iter().for_each(|&l| push_loop(l as usize));
        out.faces.extend(faces.offsets[1..].iter().map(|end| first + end));
    }
    out.planes.push(face_count + outer_count);
    if keep_graph {
        let face = |&l: &u32| if l == u32::MAX { l } else { face_of_loop[l as usize] };
        out.graphs.push((Section::default(), loop_of.iter().map(face).collect()));
    }
    Ok(())
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

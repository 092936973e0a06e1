//! Stage 8: which cell holds each void (DESIGN §11, "Nesting in cut").
//!
//! A shell with no plane face on it is a whole, uncut shell of the mesh. If that is the wall of a void, it belongs to the cell around it.
//! The mesh knows, for each void, a segment from an interior point of one of its triangles through solid to the first
//! surface it meets (`mesh::Anchor`). If no plane separates the two ends, the cell is the one behind the face hit. Otherwise it
//! is the cell before the first plane crossed, found by locating the crossing point in that plane's section.
//! A segment that meets two planes at once, or a plane exactly where it ends, is replaced by the next one.
//!
//! Voids are few: this stage works in rationals.

use super::classify::{KnifeId, Knives};
use super::faces::{AllVertices, Seen};
use super::sections::{Section, projection_axes};
use crate::base::{Error, FaceId, Result, ShellId, TriangleId, VertexId};
use crate::complex::locate::{RayStart, Strips};
use crate::complex::shells::Shells;
use crate::complex::{Complex, HalfFace, SupportId};
use crate::exact::{self, Plane, Sign};
use crate::mesh::{self, Anchor, TriMesh};
use rug::Rational;
use std::cmp::Ordering;

/// What the search for voids' cells reads of the cut so far.
pub struct Located<'a> {
    pub all: &'a AllVertices<'a>,
    /// Of each section, its graph and the face on the left of each half-edge.
    pub graphs: Vec<&'a (Section, Vec<u32>)>,
    /// The first face id of each section.
    pub first_face: &'a [u32],
}

/// For each shell of the complex: the half-face of the shell around it, if it is the wall of a void.
pub fn hosts(c: &Complex, shells: &Shells, located: &Located) -> Result<Vec<Option<HalfFace>>> {
    let mut hosts = vec![None; shells.lowest.len()];
    if c.mesh.shells.iter().all(|s| s.outer) {
        return Ok(hosts);
    }
    let mut cut = vec![false; shells.lowest.len()];
    for (h, s) in shells.of.iter().enumerate() {
        if s.is_some() && matches!(c.face_support[h / 2], SupportId::Plane(_)) {
            cut[s.at()] = true;
        }
    }
    for (s, &h) in shells.lowest.iter().enumerate() {
        let SupportId::Triangle(t) = c.face_support[h.face().at()] else { continue };
        let shell = c.mesh.triangle_shell[t.at()];
        if !cut[s] && !c.mesh.shells[shell.at()].outer {
            hosts[s] = Some(host_of_void(c, shell, located)?);
        }
    }
    Ok(hosts)
}

fn host_of_void(c: &Complex, shell: ShellId, located: &Located) -> Result<HalfFace> {
    let mut anchor = c.mesh.shells[shell.at()].anchor;
    while let Some(here) = anchor {
        if let Some(half_face) = follow(c, &here, located)? {
            return Ok(half_face);
        }
        anchor = mesh::next_anchor(&c.mesh, &here);
    }
    Err(Error::inconsistent(format!(
        "no solid surrounds the void at triangle {}",
        c.mesh.shells[shell.at()].triangle.0
    )))
}

/// The half-face that an anchor leads to; `None` if the anchor is degenerate with respect to the planes.
fn follow(c: &Complex, anchor: &Anchor, located: &Located) -> Result<Option<HalfFace>> {
    let mesh = &c.mesh;
    let knives = located.all.surface.knives;
    let start = weighted_point(mesh, anchor);
    let end = ray_end(mesh, &start, anchor);
    // The first plane on the way, as a fraction of it.
    let mut first: Option<(Rational, KnifeId)> = None;
    let mut tied = false;
    for k in (0..knives.len()).map(KnifeId::of) {
        // Where no corner of either triangle is on the other side, neither are the points in them: nearly all planes.
        let corners = [anchor.from, anchor.hit].into_iter().flat_map(|t| mesh.triangles[t.at()]);
        let mut sides = corners.map(|v| located.all.surface.side(k, v)).filter(|&s| s != Sign::Zero);
        if sides.next().is_some_and(|first| sides.all(|s| s == first)) {
            continue;
        }
        let plane = knives.plane(k);
        let (from, to) = (value(plane, &start), value(plane, &end));
        match (sign(&from), sign(&to)) {
            (Sign::Zero, Sign::Zero) => return Ok(None),
            (a, b) if a == b => continue,
            // The plane of the triangle hit: no crossing before it.
            (_, Sign::Zero) if mesh.corners(anchor.hit).iter().all(|x| exact::side(plane, x) == Sign::Zero) => continue,
            (_, Sign::Zero) | (Sign::Zero, _) => return Ok(None),
            _ => {}
        }
        let at = from.clone() / (from - to);
        match first.as_ref().map(|f| at.cmp(&f.0)) {
            Some(Ordering::Equal) => tied = true,
            Some(Ordering::Greater) => {}
            _ => {
                first = Some((at, k));
                tied = false;
            }
        }
    }
    if tied {
        return Ok(None);
    }
    match first {
        None => Ok(Some(HalfFace::new(sub_face(c, anchor.hit, &end, located)?, false))),
        Some((at, k)) => {
            let crossing: [Rational; 3] =
                std::array::from_fn(|i| start[i].clone() + at.clone() * (end[i].clone() - &start[i]));
            let front = sign(&value(knives.plane(k), &start)) == Sign::Positive;
            let face = locate_in_section(located, k, &crossing)?;
            Ok(Some(HalfFace::new(face, front)))
        }
    }
}

fn sign(x: &Rational) -> Sign {
    match x.cmp0() {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

fn exactly(x: f64) -> Rational {
    Rational::from_f64(x).expect("input coordinates are finite")
}

fn value(p: &Plane, x: &[Rational; 3]) -> Rational {
    let mut sum = exactly(p.d);
    for (n, x) in p.n.iter().zip(x) {
        sum += exactly(*n) * x;
    }
    sum
}

/// The point of an anchor's triangle with weights 1 : k : k², over the corners in the anchor's order.
fn weighted_point(mesh: &TriMesh, anchor: &Anchor) -> [Rational; 3] {
    let corners = mesh.corners(anchor.from);
    let corners = anchor.order.map(|i| corners[i as usize]);
    let k = Rational::from(anchor.k);
    let weights = [Rational::from(1), k.clone(), k.clone() * k];
    let total: Rational = weights.iter().fold(Rational::new(), |sum, w| sum + w);
    std::array::from_fn(|i| {
        let sum = corners.iter().zip(&weights).fold(Rational::new(), |sum, (x, w)| sum + exactly(x[i]) * w);
        sum / &total
    })
}

/// Where the axis-parallel ray of an anchor meets the plane of the triangle hit.
fn ray_end(mesh: &TriMesh, start: &[Rational; 3], anchor: &Anchor) -> [Rational; 3] {
    let [a, b, c] = mesh.corners(anchor.hit).map(|x| x.map(exactly));
    let minus =
        |x: &[Rational; 3], y: &[Rational; 3]| -> [Rational; 3] { std::array::from_fn(|i| x[i].clone() - &y[i]) };
    let (u, v) = (minus(&b, &a), minus(&c, &a));
    let n: [Rational; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        u[j].clone() * &v[k] - u[k].clone() * &v[j]
    });
    let to = minus(&a, start);
    let height = (0..3).fold(Rational::new(), |sum, i| sum + to[i].clone() * &n[i]);
    let mut end = start.clone();
    end[anchor.axis] += height / &n[anchor.axis];
    end
}

/// The face of a triangle in which a point of it lies that is on no chord.
fn sub_face(c: &Complex, t: TriangleId, x: &[Rational; 3], located: &Located) -> Result<FaceId> {
    let surface = located.all.surface;
    // Uncut triangles come first, then the faces of cut ones, both by triangle.
    let uncut = surface.mesh.triangles.len() - surface.sub.cut.len();
    let of_triangles = uncut + surface.sub.faces.len();
    let run = |range: std::ops::Range<usize>| {
        let triangle = |f: &SupportId| matches!(*f, SupportId::Triangle(o) if o < t);
        let first = range.start + c.face_support[range.clone()].partition_point(triangle);
        (first..range.end).take_while(|&f| c.face_support[f] == SupportId::Triangle(t))
    };
    let faces = run(0..uncut).chain(run(uncut..of_triangles)).map(FaceId::of);
    let chords =
        surface.sub.chord_triangle.partition_point(|&o| o < t)..surface.sub.chord_triangle.partition_point(|&o| o <= t);
    let wanted: Vec<(KnifeId, Sign)> = chords
        .map(|chord| surface.sub.chord_knives.row(chord)[0].knife)
        .map(|k| (k, sign(&value(surface.knives.plane(k), x))))
        .collect();
    for f in faces {
        let corners = &c.corner_vertices[c.face_corners(f)];
        let agrees = wanted.iter().all(|&(k, side)| {
            corners.iter().map(|&v| surface.side(k, v)).find(|&s| s != Sign::Zero).is_none_or(|s| s == side)
        });
        if agrees {
            return Ok(f);
        }
    }
    Err(Error::inconsistent(format!("no face of triangle {} holds a point of it", t.0)))
}

struct FromRational<'a> {
    seen: &'a Seen<'a>,
    x: Rational,
    y: Rational,
    rounded: f64,
}

impl RayStart for FromRational<'_> {
    fn compare_height(&self, v: VertexId) -> Ordering {
        let rounded = self.seen.all.coords[v.at()][self.seen.axes.1];
        if rounded != self.rounded {
            return rounded.total_cmp(&self.rounded);
        }
        exact::rational(&self.seen.all.point(v))[self.seen.axes.1].cmp(&self.y)
    }
    fn turn(&self, a: VertexId, b: VertexId) -> Sign {
        let [a, b] = [a, b].map(|v| exact::rational(&self.seen.all.point(v)));
        let (ax, ay) = self.seen.axes;
        let (ux, uy) = (b[ax].clone() - &a[ax], b[ay].clone() - &a[ay]);
        let (vx, vy) = (self.x.clone() - &a[ax], self.y.clone() - &a[ay]);
        sign(&(ux * vy - uy * vx))
    }
    fn rounded_height(&self) -> f64 {
        self.rounded
    }
}

/// The face of a plane's section that holds a point which is on no other plane and inside the solid.
fn locate_in_section(located: &Located, k: KnifeId, x: &[Rational; 3]) -> Result<FaceId> {
    let (section, face_of_half_edge) = located.graphs[k.at()];
    let knives: &Knives = located.all.surface.knives;
    let axes = projection_axes(&knives.plane(k).n);
    let seen = Seen { all: located.all, axes };
    let pieces: Vec<[VertexId; 2]> = section.pieces.iter().map(|p| p.ends).collect();
    let start = FromRational {
        seen: &seen,
        x: x[axes.0].clone(),
        y: x[axes.1].clone(),
        rounded: exact::round_rational(&x[axes.1]),
    };
    let hit = Strips::new(&pieces, &seen, 1).first_hit(&pieces, &seen, &start);
    match hit.map(|h| face_of_half_edge[h as usize]) {
        Some(face) if face != u32::MAX => Ok(FaceId(located.first_face[k.at()] + face)),
        _ => Err(Error::inconsistent(format!("a void is outside the section of plane {}", knives.ids[k.at()].0))),
    }
}

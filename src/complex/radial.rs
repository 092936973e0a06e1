//! Radial order of faces around an edge → which half-faces bound the same wedge.
//!
//! Around edge w (from its first vertex to its second), a face with normal N that walks the edge forward lies in the half-plane
//! N × w, backward in −N × w; turning counter-clockwise about w, a forward face is met on its back and left on its front.
//! So between neighbours in the cycle lies one wedge: of the half-face on the one's far side and the half-face on the other's near side.
//!
//! The order is known without arithmetic for an edge of the surface alone (two faces), and for one plane's face between two
//! faces of the surface (solid wedges run from a backward to a forward surface face). Otherwise the turn between two faces is the sign of
//! w·(N×M). Both factors are parallel, so one coordinate axis tells: the sign of w there (exact order of the
//! edge's ends) times the sign of (N×M) there (a 3×3 determinant of input normals). No constructed direction is read.
//!
//! Two faces in one half-plane would be one face: they occur only where the input intersects itself.

use super::projection::compare_axis;
use super::{Complex, HalfFace, SupportId};
use crate::base::{EdgeId, Error, FaceId, PlaneId, Result};
use crate::exact::{self, Direction, Sign, counters, sort_cyclic};
use std::cmp::Ordering;

/// One walk of a face along an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct FaceUse {
    pub face: FaceId,
    pub forward: bool,
    /// The corner of the face from which the edge is walked.
    pub corner: u32,
}

impl FaceUse {
    /// The half-face on the counter-clockwise side.
    fn far(self) -> HalfFace {
        HalfFace::new(self.face, self.forward)
    }
    /// The half-face on the clockwise side.
    fn near(self) -> HalfFace {
        HalfFace::new(self.face, !self.forward)
    }
}

/// The uses of every edge: corners chained per edge, so that the many edges with two uses cost two reads and no sort.
pub struct EdgeUses {
    /// The last corner that walks each edge.
    last: Vec<u32>,
    /// The corner before it that walks the same edge.
    before: Vec<u32>,
    corner_face: Vec<FaceId>,
}

impl EdgeUses {
    pub fn new(c: &Complex) -> Self {
        const NONE: u32 = u32::MAX;
        let corners = c.corner_vertices.len();
        let mut uses = EdgeUses {
            last: vec![NONE; c.edge_count()],
            before: Vec::with_capacity(corners),
            corner_face: Vec::with_capacity(corners),
        };
        for f in 0..c.face_count() {
            let face = FaceId::of(f);
            let range = c.face_corners(face);
            uses.corner_face.resize(range.end, face);
            for k in range {
                let edge = c.corner_edges[k];
                let before = if edge.is_none() { NONE } else { std::mem::replace(&mut uses.last[edge.at()], k as u32) };
                uses.before.push(before);
            }
        }
        uses
    }

    /// All uses of an edge, by rising corner.
    pub fn row(&self, c: &Complex, edge: EdgeId, row: &mut Vec<FaceUse>) {
        row.clear();
        let mut k = self.last[edge.at()];
        while k != u32::MAX {
            let forward = c.edges[edge.at()][0] == c.corner_vertices[k as usize];
            row.push(FaceUse { face: self.corner_face[k as usize], forward, corner: k });
            k = self.before[k as usize];
        }
        row.reverse();
    }
}

fn on_surface(c: &Complex, u: FaceUse) -> bool {
    !c.two_sided && matches!(c.face_support[u.face.at()], SupportId::Triangle(_))
}

/// Whether a half-face faces the inside of the solid: before a surface face is the outside. Once cells are known, they tell: of a part of a
/// solid, a face on a plane may have a cell on one side only.
fn is_inside(c: &Complex, u: FaceUse, h: HalfFace) -> bool {
    match c.face_cells.get(u.face.at()) {
        Some(cells) => cells[h.front() as usize].is_some(),
        None => !(on_surface(c, u) && h.front()),
    }
}

/// Calls `pair(i, hi, j, hj)` for each wedge around an edge that is inside: the uses `i` and `j` that bound it and their
/// half-faces. `along` may say that the edge is known to run along n_P × n_Q of two planes P, Q.
pub fn wedge_pairs(
    c: &Complex,
    edge: EdgeId,
    uses: &[FaceUse],
    along: Option<[PlaneId; 2]>,
    scratch: &mut Vec<u32>,
    mut pair: impl FnMut(u32, HalfFace, u32, HalfFace),
) -> Result<()> {
    if let [a, b] = *uses
        && a.forward != b.forward
        && on_surface(c, a)
        && on_surface(c, b)
    {
        counters::count_topology(counters::Predicate::RadialOrder);
        let (i, j) = if a.forward { (1, 0) } else { (0, 1) };
        pair(i, HalfFace::new(uses[i as usize].face, false), j, HalfFace::new(uses[j as usize].face, false));
        return Ok(());
    }
    // One or two that have the inside all around them: there is one order.
    if let [a] | [a, _] = *uses
        && uses.iter().all(|&u| is_inside(c, u, u.far()) && is_inside(c, u, u.near()))
    {
        counters::count_topology(counters::Predicate::RadialOrder);
        let b = uses[uses.len() - 1];
        pair(0, a.far(), uses.len() as u32 - 1, b.near());
        if uses.len() == 2 {
            pair(1, b.far(), 0, a.near());
        }
        return Ok(());
    }
    if uses.len() == 3
        && uses.iter().all(|&u| on_surface(c, u) || (is_inside(c, u, u.far()) && is_inside(c, u, u.near())))
        && let Some(p) = (0..3).find(|&i| !on_surface(c, uses[i]))
    {
        let (i, j) = ((p + 1) % 3, (p + 2) % 3);
        if on_surface(c, uses[i]) && on_surface(c, uses[j]) && uses[i].forward != uses[j].forward {
            counters::count_topology(counters::Predicate::RadialOrder);
            let (forward, backward) = if uses[i].forward { (i, j) } else { (j, i) };
            pair(backward as u32, uses[backward].far(), p as u32, uses[p].near());
            pair(p as u32, uses[p].far(), forward as u32, uses[forward].near());
            return Ok(());
        }
    }
    if let Some(order) = crossing_of_two_planes(c, uses, along) {
        counters::count_topology(counters::Predicate::RadialOrder);
        for (k, &i) in order.iter().enumerate() {
            let j = order[(k + 1) % 4];
            pair(i, uses[i as usize].far(), j, uses[j as usize].near());
        }
        return Ok(());
    }
    // The signs computed here are counted by tier under `Direction`.
    counters::count(counters::Predicate::RadialOrder, counters::Tier::Filter);
    let Some((axis, along)) = edge_axis(c, edge) else { return Err(contradiction(edge)) };
    scratch.clear();
    scratch.extend(0..uses.len() as u32);
    let normal = |i: u32| face_normal(c, uses[i as usize].face);
    let same = |i: u32, j: u32| uses[i as usize].forward == uses[j as usize].forward;
    let support = |i: u32| c.face_support[uses[i as usize].face.at()];
    sort_around(scratch, axis, along, support, normal, same);
    for (k, &i) in scratch.iter().enumerate() {
        let j = scratch[if k + 1 == scratch.len() { 0 } else { k + 1 }];
        let (from, to) = (uses[i as usize], uses[j as usize]);
        match (is_inside(c, from, from.far()), is_inside(c, to, to.near())) {
            (true, true) => pair(i, from.far(), j, to.near()),
            (false, false) => {}
            _ => return Err(contradiction(edge)),
        }
    }
    Ok(())
}

/// Sorts half-planes around an edge counter-clockwise about its direction. Each is given by the support and the normal of its face and by
/// whether the face walks the edge the same way as another's; `along`: the edge's coordinate along `axis` rises.
pub fn sort_around(
    items: &mut [u32],
    axis: usize,
    along: bool,
    support: impl Fn(u32) -> SupportId,
    normal: impl Fn(u32) -> Direction,
    same: impl Fn(u32, u32) -> bool,
) {
    let mut unit = [0.0; 3];
    unit[axis] = 1.0;
    let unit = Direction::Plane(unit);
    sort_cyclic(
        items,
        |&i, &j| {
            if support(i) == support(j) {
                return Sign::Zero;
            }
            let sign = exact::determinant(&normal(i), &normal(j), &unit);
            if same(i, j) == along { sign } else { -sign }
        },
        |&i, &j| {
            if support(i) == support(j) {
                return !same(i, j);
            }
            let sign = exact::dot(&normal(i), &normal(j));
            (sign == Sign::Positive) != same(i, j)
        },
    );
}

/// The cycle around a plain line inside, where two planes cross: the line's direction tells the order of all four faces.
fn crossing_of_two_planes(c: &Complex, uses: &[FaceUse], along: Option<[PlaneId; 2]>) -> Option<[u32; 4]> {
    let [p, q] = along?;
    if uses.len() != 4 {
        return None;
    }
    let find = |plane: PlaneId, forward: bool| {
        let is = |u: &FaceUse| u.forward == forward && c.face_support[u.face.at()] == SupportId::Plane(plane);
        uses.iter().position(is).map(|i| i as u32)
    };
    // Forward faces lie in N × w; w = n_P × n_Q turns P's to Q's counter-clockwise.
    Some([find(p, true)?, find(q, true)?, find(p, false)?, find(q, false)?])
}

fn contradiction(edge: EdgeId) -> Error {
    Error::inconsistent(format!(
        "faces around edge {} do not alternate between inside and outside: the surface intersects itself",
        edge.0
    ))
}

/// The normal of a face's support.
pub fn face_normal(c: &Complex, f: FaceId) -> Direction {
    match c.face_support[f.at()] {
        SupportId::Triangle(t) => Direction::Triangle(c.mesh.corners(t)),
        SupportId::Plane(p) => Direction::Plane(c.planes[p.at()].n),
        SupportId::Level(p) => Direction::Gradient(c.levels.supports[p.at()]),
    }
}

/// An axis in which the edge's ends differ, and whether the coordinate rises along the edge.
fn edge_axis(c: &Complex, edge: EdgeId) -> Option<(usize, bool)> {
    let [a, b] = c.edges[edge.at()];
    let (xa, xb) = (&c.coords[a.at()], &c.coords[b.at()]);
    // The widest first: it nearly always differs already when rounded.
    let best = (0..3).max_by(|&i, &j| (xa[i] - xb[i]).abs().total_cmp(&(xa[j] - xb[j]).abs())).unwrap();
    [best, (best + 1) % 3, (best + 2) % 3].into_iter().find_map(|axis| match compare_axis(c, a, b, axis) {
        Ordering::Equal => None,
        order => Some((axis, order == Ordering::Less)),
    })
}

//! The order of polygons around an edge.
//!
//! The simplices around the edge are taken apart into *sectors*: their cells that contain the edge. Each sector lies between two walls, faces that
//! contain the edge; seen along the edge it begins at the one and ends, counterclockwise, at the other. Behind a face inside a simplex is
//! another sector of that simplex, behind a facet one of the neighbour, behind a facet of the domain's boundary nothing. So the order is read off
//! cell by cell, wherever the edge is: inside a simplex, on a facet, on an edge of the domain. No coordinate and no predicate is asked.
//!
//! The sectors between two polygons are one *wedge*. At the boundary the order has gaps; where the domain itself is not a manifold
//! there are several fans, given one after another.
//!
//! Direction: turning counterclockwise about the edge from its first to its second vertex, a polygon that walks the edge forward is met on its
//! back and left on its front.
//!
//! Cost: that of the complexes of the simplices around the edge.

use super::local::{Local, Setting, Wall};
use super::patches::{HalfPatch, Patches};
use super::simplex::{FaceSupport, LocalCell};
use crate::base::{Error, NodeId, PolygonId, Result, TetId, VertexId};

/// A polygon in the order around an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Around {
    pub polygon: PolygonId,
    /// It walks the edge from its first to its second vertex.
    pub forward: bool,
    /// The way counterclockwise to the next polygon leads out of the domain.
    pub gap: bool,
}

impl Around {
    /// The side met first, turning counterclockwise.
    pub fn near(&self, patches: &Patches) -> HalfPatch {
        patches.side(self.polygon, !self.forward)
    }
    /// The side met last.
    pub fn far(&self, patches: &Patches) -> HalfPatch {
        patches.side(self.polygon, self.forward)
    }
}

/// What is behind a wall.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Behind {
    /// The sector of this cell of the same simplex.
    Cell(LocalCell),
    /// The sector of this simplex that touches the same facet.
    Tet(TetId),
    Outside,
}

#[derive(Clone, Copy)]
struct Side {
    polygon: PolygonId,
    behind: Behind,
}

/// A cell that contains the edge, between its first wall and its last one.
#[derive(Clone, Copy)]
struct Sector {
    tet: TetId,
    cell: LocalCell,
    first: Option<Side>,
    last: Option<Side>,
}

/// Working memory.
#[derive(Default)]
pub struct Scratch {
    pub local: Local,
    pub tets: Vec<TetId>,
    walls: Vec<Wall>,
    sectors: Vec<Sector>,
    visited: Vec<bool>,
}

/// The polygons around an edge counterclockwise: around the lowest one first, which comes first if there is no gap; a fan begins behind a gap.
/// `edge`: its vertices (in two dimensions a vertex, twice); `carrier`: the nodes of the open sub-simplex that holds it; `polygons`: those around it.
pub fn around_edge(
    setting: &Setting,
    edge: [VertexId; 2],
    carrier: &[NodeId; 4],
    polygons: &[PolygonId],
    scratch: &mut Scratch,
    out: &mut Vec<Around>,
) -> Result<()> {
    out.clear();
    find_sectors(setting, edge, carrier, polygons, scratch)?;
    let sectors = &scratch.sectors;
    let lost = || Error::inconsistent(format!("the cells around edge {:?} of the network contradict each other", edge));
    let forward = |p: PolygonId| super::edges::walk(setting.network, p, edge[0], edge[1]);
    let starts_at = |p: PolygonId| sectors.iter().position(|s| s.first.is_some_and(|side| side.polygon == p));
    let ends_at = |p: PolygonId| sectors.iter().position(|s| s.last.is_some_and(|side| side.polygon == p));
    let index = |p: PolygonId| polygons.iter().position(|&q| q == p);
    scratch.visited.clear();
    scratch.visited.resize(polygons.len(), false);
    while let Some(k) = scratch.visited.iter().position(|v| !v) {
        // Clockwise until a gap or round to the start; then counterclockwise to the other end.
        let first = polygons[k];
        let mut at = ends_at(first);
        let (mut start, mut closed) = (first, false);
        for step in 0.. {
            let Some(s) = at else { break };
            let side = sectors[s].first.ok_or_else(lost)?;
            if side.polygon.is_some() {
                if side.polygon == first {
                    closed = true;
                    start = first;
                    break;
                }
                start = side.polygon;
            }
            at = step_to(sectors, s, side, |sector| sector.last)?;
            if step > sectors.len() {
                return Err(lost());
            }
        }
        let mut p = start;
        loop {
            let k = index(p).ok_or_else(lost)?;
            if std::mem::replace(&mut scratch.visited[k], true) {
                return Err(lost());
            }
            out.push(Around { polygon: p, forward: forward(p).ok_or_else(lost)?, gap: false });
            let mut at = starts_at(p);
            let mut next = PolygonId::NONE;
            for step in 0.. {
                let Some(s) = at else { break };
                let side = sectors[s].last.ok_or_else(lost)?;
                if side.polygon.is_some() {
                    next = side.polygon;
                    break;
                }
                at = step_to(sectors, s, side, |sector| sector.first)?;
                if step > sectors.len() {
                    return Err(lost());
                }
            }
            if next.is_none() {
                if closed {
                    return Err(lost());
                }
                out.last_mut().expect("one polygon").gap = true;
                break;
            }
            if next == start {
                if !closed {
                    return Err(lost());
                }
                break;
            }
            p = next;
        }
    }
    Ok(())
}

/// The sector behind a wall, `None` outside of the domain. `wall`: the wall of that sector which is the same face.
fn step_to(
    sectors: &[Sector],
    from: usize,
    side: Side,
    wall: impl Fn(&Sector) -> Option<Side>,
) -> Result<Option<usize>> {
    let tet = sectors[from].tet;
    let found = match side.behind {
        Behind::Outside => return Ok(None),
        Behind::Cell(cell) => sectors.iter().position(|s| s.tet == tet && s.cell == cell),
        Behind::Tet(other) => {
            sectors.iter().position(|s| s.tet == other && wall(s).is_some_and(|side| side.behind == Behind::Tet(tet)))
        }
    };
    match found {
        Some(s) => Ok(Some(s)),
        None => Err(Error::inconsistent("a facet has a cell on one side and none on the other")),
    }
}

fn find_sectors(
    setting: &Setting,
    edge: [VertexId; 2],
    carrier: &[NodeId; 4],
    polygons: &[PolygonId],
    scratch: &mut Scratch,
) -> Result<()> {
    let Scratch { local, tets, walls, sectors, .. } = scratch;
    sectors.clear();
    setting.domain.around(&carrier[..super::carrier::node_count(carrier)], tets);
    for &tet in tets.iter() {
        local.build_once(setting, tet);
        local.walls(setting.network, edge, walls);
        if walls.is_empty() {
            return Err(Error::inconsistent(format!("edge {edge:?} of the network is missing in simplex {}", tet.0)));
        }
        let begin = sectors.len();
        let sector_of = |sectors: &mut Vec<Sector>, cell: LocalCell| {
            begin
                + sectors[begin..].iter().position(|s| s.cell == cell).unwrap_or_else(|| {
                    sectors.push(Sector { tet, cell, first: None, last: None });
                    sectors.len() - 1 - begin
                })
        };
        for &wall in walls.iter() {
            let polygon = polygons.iter().copied().find(|&p| local.is_polygon(setting, wall, edge, p).is_some());
            let polygon = polygon.unwrap_or(PolygonId::NONE);
            let [positive, negative] = local.complex.face_cells[wall.face.at()];
            // Counterclockwise behind the wall, and before it.
            let (after, before) = if wall.forward { (positive, negative) } else { (negative, positive) };
            let behind = |cell: LocalCell| match local.complex.face_support[wall.face.at()] {
                FaceSupport::Facet(facet) => match setting.domain.opposite(tet, facet as usize) {
                    Some((other, _)) => Behind::Tet(other),
                    None => Behind::Outside,
                },
                _ => Behind::Cell(cell),
            };
            if after.is_some() {
                let s = sector_of(sectors, after);
                sectors[s].first = Some(Side { polygon, behind: behind(before) });
            }
            if before.is_some() {
                let s = sector_of(sectors, before);
                sectors[s].last = Some(Side { polygon, behind: behind(after) });
            }
        }
    }
    Ok(())
}

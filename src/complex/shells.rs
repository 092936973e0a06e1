//! Half-faces → shells → cells.
//!
//! A shell is a class of half-faces joined across edges by wedges. Shells are numbered by their lowest half-face. A shell is the outer
//! boundary of a cell, unless the engine says that it is the wall of a void and names a half-face of the shell around it;
//! a chain of such answers ends at an outer shell. Cells are numbered by their outer shells, and voids follow in shell order.
//!
//! Cost: linear in the face corners, times the inverse Ackermann function.

use super::radial::{EdgeUses, wedge_pairs};
use super::{Complex, HalfFace, SupportId};
use crate::base::{CellId, Csr, EdgeId, Error, FaceId, PlaneId, Result, ShellId, UnionFind};
use crate::exact::counters;

/// The shell of each half-face (`NONE` for the front of a surface face), and the lowest half-face of each shell.
pub struct Shells {
    pub of: Vec<ShellId>,
    pub lowest: Vec<HalfFace>,
}

/// `along(edge)`, asked at most once per edge, by rising id, may name two planes P, Q along whose n_P × n_Q the edge runs.
pub fn find_shells(c: &Complex, mut along: impl FnMut(EdgeId) -> Option<[PlaneId; 2]>) -> Result<Shells> {
    let uses = EdgeUses::new(c);
    let mut classes = UnionFind::new(2 * c.face_count());
    let (mut row, mut scratch, mut simple) = (Vec::new(), Vec::new(), 0);
    for edge in (0..c.edge_count()).map(EdgeId::of) {
        if let Some([a, b]) = uses.surface_pair(c, edge) {
            classes.union(HalfFace::new(a, false).at(), HalfFace::new(b, false).at());
            simple += 1;
            continue;
        }
        uses.row(c, edge, &mut row);
        wedge_pairs(c, edge, &row, along(edge), &mut scratch, |_, a, _, b| {
            classes.union(a.at(), b.at());
        })?;
    }
    counters::count_many(counters::Predicate::RadialOrder, counters::Tier::Topology, simple);
    let mut shells = Shells { of: vec![ShellId::NONE; 2 * c.face_count()], lowest: Vec::new() };
    for f in 0..c.face_count() {
        let one_sided = matches!(c.face_support[f], SupportId::Triangle(_));
        for front in [false, true] {
            if front && one_sided {
                continue;
            }
            let h = HalfFace::new(FaceId::of(f), front);
            let root = classes.find(h.at());
            // Roots are the lowest members, so a class is met first at its root.
            if shells.of[root].is_none() {
                shells.of[root] = ShellId::of(shells.lowest.len());
                shells.lowest.push(h);
            }
            shells.of[h.at()] = shells.of[root];
        }
    }
    Ok(shells)
}

/// Fills the cells of a complex from its shells. `host(shell)` is `None` for an outer shell and, for the wall of a void, a half-face of the
/// shell around it.
pub fn form_cells(c: &mut Complex, shells: &Shells, host: &[Option<HalfFace>]) -> Result<()> {
    let count = shells.lowest.len();
    let mut cell_of = vec![CellId::NONE; count];
    let mut cells = 0;
    for s in 0..count {
        if host[s].is_none() {
            cell_of[s] = CellId::of(cells);
            cells += 1;
        }
    }
    for s in 0..count {
        let (mut at, mut steps) = (s, 0);
        while cell_of[at].is_none() {
            at = match host[at] {
                Some(h) if steps <= count => shells.of[h.at()].at(),
                _ => return Err(Error::inconsistent("walls of voids enclose each other")),
            };
            steps += 1;
        }
        cell_of[s] = cell_of[at];
    }
    // Shells by cell, the outer one first; then half-faces by shell.
    let outer = (0..count).filter(|&s| host[s].is_none());
    let voids = (0..count).filter(|&s| host[s].is_some());
    let by_cell = Csr::from_pairs(cells, outer.chain(voids).map(|s| (cell_of[s].at(), ShellId::of(s))));
    let mut place = vec![0u32; count];
    by_cell.items.iter().enumerate().for_each(|(i, s)| place[s.at()] = i as u32);
    let half_faces = shells.of.iter().enumerate().filter(|(_, s)| s.is_some());
    c.shell_faces = Csr::from_pairs(count, half_faces.map(|(h, s)| (place[s.at()] as usize, HalfFace(h as u32))));
    c.cell_shells = by_cell.offsets;
    c.face_cells = (0..c.face_count())
        .map(|f| {
            [2 * f, 2 * f + 1].map(|h| if shells.of[h].is_none() { CellId::NONE } else { cell_of[shells.of[h].at()] })
        })
        .collect();
    match c.face_cells.iter().position(|[a, b]| a == b) {
        None => Ok(()),
        Some(f) => {
            Err(Error::inconsistent(format!("face {f} has the same cell on both sides: the surface intersects itself")))
        }
    }
}

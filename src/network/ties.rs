//! Which materials are equal throughout a region of an interface, on demand.
//!
//! The lowest of equal materials owns a region; the others of its *tied set* equal it at every node of every simplex with a part of the region.
//! Candidates are those that do in one simplex, most often none; with candidates the region is walked through, across facets that its
//! cells touch on both sides, until none is left or all of it was seen. A cell is where its owner is largest in a simplex, which is
//! convex: so a simplex has one cell of an owner at most.
//!
//! Cost: next to nothing for a region without candidates; else linear in its simplices, with a complex for each in which other
//! materials take part; a bit for each simplex of the domain.

use super::Kind;
use super::local::{Local, Setting};
use super::regions::Regions;
use super::simplex::FaceSupport;
use crate::base::parallel::map_ranges;
use crate::base::{Csr, Error, FunctionId, RegionId, Result, Status, TetId};

/// The materials that are equal throughout each region, its owner first, rising.
///
/// Errors: `BadArgument` for an arrangement.
pub fn tied_materials(setting: &Setting, regions: &Regions) -> Result<Csr<FunctionId>> {
    if setting.network.kind != Kind::Interface {
        return Err(Error::new(Status::BadArgument, "regions of an arrangement have no materials"));
    }
    let parts = map_ranges(regions.len(), 1, |range| {
        let (mut rows, mut walk) = (Csr::default(), Walk::default());
        for r in range.map(RegionId::of) {
            let owner = regions.materials[r.at()];
            let mut tied: Vec<FunctionId> =
                (0..setting.values.len()).map(FunctionId::of).filter(|&f| f > owner).collect();
            walk.through(setting, owner, regions.simplices[r.at()], &mut tied);
            rows.items.push(owner);
            rows.items.append(&mut tied);
            rows.end_row();
        }
        rows
    });
    Ok(Csr::concat(parts))
}

/// Working memory.
#[derive(Default)]
struct Walk {
    /// A bit for each simplex; all are clear between regions.
    seen: Vec<u64>,
    list: Vec<TetId>,
    local: Local,
}

impl Walk {
    /// Keeps those of `tied` that equal the owner in all simplices of its region, from one of them on.
    fn through(&mut self, setting: &Setting, owner: FunctionId, first: TetId, tied: &mut Vec<FunctionId>) {
        let domain = setting.domain;
        let mut at = 0;
        self.list.push(first);
        while let Some(&tet) = self.list.get(at) {
            at += 1;
            let corners = domain.corners(tet);
            let corners = &corners[..=domain.dim()];
            let equal =
                |f: &FunctionId| corners.iter().all(|&n| setting.values.at(*f, n) == setting.values.at(owner, n));
            tied.retain(equal);
            if tied.is_empty() {
                break;
            }
            if self.seen.is_empty() {
                self.seen = vec![0; domain.tet_count().div_ceil(64)];
            }
            self.see(tet);
            // Alone the largest, but for those that equal it everywhere and are higher: all of the simplex is in the region.
            let others = (0..setting.values.len()).map(FunctionId::of).filter(|&f| f != owner);
            let below = |f: FunctionId| corners.iter().all(|&n| setting.values.at(f, n) < setting.values.at(owner, n));
            let whole = others.into_iter().all(|f| below(f) || f > owner && equal(&f));
            let mut open = [whole; 4];
            if !whole {
                self.local.build(setting, tet);
                open = touched(&self.local, owner);
            }
            for (facet, _) in open.iter().enumerate().take(domain.dim() + 1).filter(|(_, open)| **open) {
                let Some((other, _)) = domain.opposite(tet, facet) else { continue };
                if self.is_seen(other) {
                    continue;
                }
                self.local.build(setting, other);
                let back = (0..=domain.dim()).find(|&k| domain.opposite(other, k).is_some_and(|(t, _)| t == tet));
                if back.is_some_and(|back| touched(&self.local, owner)[back]) {
                    self.see(other);
                    self.list.push(other);
                }
            }
        }
        for tet in self.list.drain(..) {
            if let Some(word) = self.seen.get_mut(tet.at() / 64) {
                *word &= !(1 << (tet.at() % 64));
            }
        }
    }

    fn is_seen(&self, tet: TetId) -> bool {
        self.seen[tet.at() / 64] >> (tet.at() % 64) & 1 != 0
    }

    fn see(&mut self, tet: TetId) {
        self.seen[tet.at() / 64] |= 1 << (tet.at() % 64);
    }
}

/// The facets that the cell of an owner touches.
fn touched(local: &Local, owner: FunctionId) -> [bool; 4] {
    let mut facets = [false; 4];
    let complex = &local.complex;
    for (support, cells) in complex.face_support.iter().zip(&complex.face_cells) {
        if let FaceSupport::Facet(facet) = support {
            facets[*facet as usize] |= local.owner(cells[0]) == owner;
        }
    }
    facets
}

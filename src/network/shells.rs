//! Shells: sides of patches that bound one region along edges.
//!
//! Two half-patches with a wedge between them, around some chain, bound the same region. The sides of a patch that has one side
//! only, or an open edge inside the domain, are in one shell. (Across manifold edges each side of a patch continues as itself.) A shell is a
//! class of half-patches; shells are numbered by their lowest one.
//!
//! Cost: linear in the chains.

use super::chains::Chains;
use super::patches::{HalfPatch, Patches};
use crate::base::{Csr, ShellId, UnionFind};

/// The shells of a network.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shells {
    /// The shell of each half-patch.
    pub of: Vec<ShellId>,
    /// The half-patches of each shell, rising.
    pub half_patches: Csr<HalfPatch>,
}

impl Shells {
    pub fn len(&self) -> usize {
        self.half_patches.len()
    }

    pub fn is_empty(&self) -> bool {
        self.half_patches.is_empty()
    }

    #[inline(always)]
    pub fn of(&self, h: HalfPatch) -> ShellId {
        self.of[h.at()]
    }

    /// Each half-patch in one shell; shells numbered by lowest half-patch, never across two components.
    pub fn check(&self, patches: &Patches) -> Result<(), String> {
        self.half_patches.check()?;
        if self.of.len() != 2 * patches.len() || self.half_patches.items.len() != self.of.len() {
            return Err("counts of shells differ".into());
        }
        let mut lowest = None;
        for (s, row) in self.half_patches.rows().enumerate() {
            if row.is_empty() || row.iter().any(|h| self.of(*h).at() != s) || row.windows(2).any(|w| w[0] >= w[1]) {
                return Err(format!("half-patches of shell {s}"));
            }
            if lowest >= Some(row[0]) {
                return Err(format!("shell {s} is not numbered by its lowest half-patch"));
            }
            lowest = Some(row[0]);
            let component = |h: HalfPatch| patches.component[h.patch().at()];
            if row.iter().any(|&h| component(h) != component(row[0])) {
                return Err(format!("shell {s} is in two components"));
            }
        }
        Ok(())
    }
}

/// Joins half-patches across the wedges around chains.
pub fn find_shells(patches: &Patches, chains: &Chains) -> Shells {
    let mut classes = UnionFind::new(2 * patches.len());
    for &p in &patches.one_sided {
        classes.union(HalfPatch::new(p, false).at(), HalfPatch::new(p, true).at());
    }
    for c in 0..chains.len() {
        for [a, b] in chains.wedges(c) {
            classes.union(a.at(), b.at());
        }
    }
    let (of, count) = classes.labels();
    let half_patches = Csr::from_pairs(count, of.iter().enumerate().map(|(h, &s)| (s as usize, HalfPatch(h as u32))));
    Shells { of: of.into_iter().map(ShellId).collect(), half_patches }
}

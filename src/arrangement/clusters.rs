//! Clusters: triangles in one plane that overlap, directly or through others (section 3.1 of the paper). They are triangulated together, so that
//! where they overlap their parts are the same.
//!
//! Cost: union-find over the cut triangles.

use super::data::{Clusters, Contacts};
use crate::base::{Csr, TriangleId, UnionFind};

/// The cut triangles by cluster.
pub fn clusters(contacts: &Contacts) -> Clusters {
    let place = |t: TriangleId| contacts.cut.partition_point(|&c| c < t);
    let mut sets = UnionFind::new(contacts.cut.len());
    for [a, b] in &contacts.overlaps {
        sets.union(place(*a), place(*b));
    }
    // Sets are numbered by their lowest members, and members come in order.
    let (of, count) = sets.labels();
    let members = of.iter().zip(&contacts.cut).map(|(&set, &t)| (set as usize, t));
    Clusters { members: Csr::from_pairs(count, members) }
}

impl Clusters {
    /// Every cut triangle is in one cluster; members rise, clusters rise by their lowest.
    pub fn check(&self, contacts: &Contacts) -> Result<(), String> {
        self.members.check()?;
        let mut all = self.members.items.clone();
        all.sort_unstable();
        if all != contacts.cut {
            return Err("clusters do not hold the cut triangles once each".into());
        }
        let firsts: Vec<_> = self.members.rows().map(|r| r.first()).collect();
        if firsts.windows(2).any(|w| w[0] >= w[1]) || self.members.rows().any(|r| r.windows(2).any(|w| w[0] >= w[1])) {
            return Err("clusters are not in order".into());
        }
        Ok(())
    }
}

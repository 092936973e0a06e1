//! From polygons to regions: all that follows from a network's vertices and polygons (section 7 of the networks paper).

use super::chains::{Chains, find_chains};
use super::edges::{Edges, find_edges};
use super::local::Setting;
use super::patches::{HalfPatch, Patches, find_patches};
use super::regions::{Method, Regions, find_regions};
use super::shells::{Shells, find_shells};
use crate::base::{PolygonId, RegionId, Result, Run};

/// What the polygons of a network form.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Topology {
    pub edges: Edges,
    pub patches: Patches,
    pub chains: Chains,
    pub shells: Shells,
    pub regions: Regions,
}

impl Topology {
    /// The region before one side of a polygon.
    #[inline]
    pub fn region_beside(&self, p: PolygonId, front: bool) -> RegionId {
        self.regions.beside(&self.patches, &self.shells, p, front)
    }

    /// The region before one side of a patch.
    #[inline]
    pub fn region_of(&self, side: HalfPatch) -> RegionId {
        self.regions.of_shell[self.shells.of(side).at()]
    }

    /// Everything that each stage promises. Cost: linear.
    pub fn check(&self, setting: &Setting) -> std::result::Result<(), String> {
        self.edges.check(setting.network)?;
        self.patches.check(setting.network, &self.edges)?;
        self.chains.check(&self.edges, &self.patches, setting.network.dim)?;
        self.shells.check(&self.patches)?;
        self.regions.check(setting, &self.patches, &self.shells)
    }
}

/// Edges, patches, chains, shells, regions. Stages are reported to `run` under these names; the same result on any number of threads.
///
/// Errors: `Cancelled`; `Inconsistent` if the network is not that of the values.
/// Cost: linear in the corners of polygons, and that of the regions' method.
pub fn find_topology(setting: &Setting, method: Method, run: &mut Run) -> Result<Topology> {
    run.stage("edges", 0.75)?;
    let edges = find_edges(setting.network);
    run.stage("patches", 0.85)?;
    let patches = find_patches(setting.network, setting.domain, &edges);
    run.stage("chains", 0.9)?;
    let chains = find_chains(setting, &edges, &patches)?;
    run.stage("shells", 0.93)?;
    let shells = find_shells(&patches, &chains);
    run.stage("regions", 0.95)?;
    let regions = find_regions(setting, &patches, &shells, method)?;
    run.end_stage();
    Ok(Topology { edges, patches, chains, shells, regions })
}

//! The region that a facet of the domain looks into, found by a walk from simplex to simplex.
//!
//! A simplex without a polygon is all in one region, and so are its neighbours, up to the first one that has a polygon: of that, the cell that was entered
//! tells, by a polygon beside it. Simplices nearest to some polygon of the network are tried first, so in the open the walk is straight; the order
//! makes no difference for what is found.
//!
//! Cost: that of the simplices which are tried: in a box about as many as along an axis; at worst all of the region.

use super::local::{Local, Setting};
use super::simplex::{FaceSupport, LocalFace};
use super::topology::Topology;
use super::walls::TetPolygons;
use crate::base::{Error, RegionId, Result, TetId};
use hashbrown::HashSet;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The region beside a facet, inside its simplex. The facet has no side of a polygon inside.
pub fn region_at(
    setting: &Setting,
    topology: &Topology,
    polygons: &TetPolygons,
    (tet, facet): (TetId, u8),
) -> Result<RegionId> {
    let regions = &topology.regions;
    if regions.len() == 1 {
        return Ok(RegionId(0));
    }
    let (network, domain) = (setting.network, setting.domain);
    let target = network.vertices.first().copied().unwrap_or_default();
    // Doubles that are not negative are in the order of their bits.
    let distance = |tet: TetId| {
        let x = domain.coordinates(domain.corners(tet)[0]);
        (0..3).map(|i| (x[i] - target[i]) * (x[i] - target[i])).sum::<f64>().to_bits()
    };
    // Never iterated.
    let mut seen = HashSet::new();
    let mut next = BinaryHeap::new();
    seen.insert(tet);
    next.push(Reverse((distance(tet), tet, facet)));
    while let Some(Reverse((_, tet, facet))) = next.pop() {
        if polygons.of(tet).next().is_some() {
            return beside(setting, topology, polygons, tet, facet);
        }
        for i in 0..=domain.dim() {
            let Some((other, _)) = domain.opposite(tet, i) else { continue };
            if seen.insert(other) {
                let back = (0..=domain.dim()).find(|&k| domain.opposite(other, k).is_some_and(|(t, _)| t == tet));
                let back = back.ok_or_else(|| Error::inconsistent("a facet is seen from one side only"))?;
                next.push(Reverse((distance(other), other, back as u8)));
            }
        }
    }
    // A part of the domain that no polygon touches.
    let empty = |r: &RegionId| regions.shells.row(*r).is_empty() && seen.contains(&regions.simplices[r.at()]);
    let found = (0..regions.len()).map(RegionId::of).find(empty);
    found.ok_or_else(|| Error::inconsistent(format!("no region has simplex {}", tet.0)))
}

/// The same for a simplex with polygons.
fn beside(setting: &Setting, topology: &Topology, polygons: &TetPolygons, tet: TetId, facet: u8) -> Result<RegionId> {
    let network = setting.network;
    // One on a facet, if there is none inside: then the simplex is one cell.
    let inside = polygons.of(tet).any(|p| network.polygon_tets[p.at()] == [tet; 2]);
    if let (false, Some(p)) = (inside, polygons.of(tet).next()) {
        return Ok(topology.region_beside(p, network.polygon_tets[p.at()][0] == tet));
    }
    let (mut local, mut walls) = (Local::default(), Vec::new());
    local.build(setting, tet);
    let complex = &local.complex;
    let mut faces = (0..complex.face_count()).map(LocalFace::of);
    let face = faces.find(|f| complex.face_support[f.at()] == FaceSupport::Facet(facet));
    let cell = face.map(|f| complex.face_cells[f.at()][0]);
    for p in polygons.of(tet) {
        for (side, front) in [true, false].into_iter().enumerate() {
            let here = network.polygon_tets[p.at()][side] == tet;
            if here && local.cell_beside(setting, p, front, &mut walls) == cell {
                return Ok(topology.region_beside(p, front));
            }
        }
    }
    Err(Error::inconsistent(format!("a cell of simplex {} has no polygon", tet.0)))
}

//! The boundary of a domain as a closed surface, and the pieces that the network cuts its triangles into.
//!
//! A piece is a face of the complex of its simplex on a facet; a simplex without a polygon inside has whole facets. Every corner of a piece is a node or
//! a vertex of the network: what crosses a facet inside a simplex ends a polygon there. So pieces and polygons fit together, as do
//! pieces on both sides of an edge, which see the same points on it.
//!
//! Cost: linear in the boundary and its pieces; a sort of the polygons by simplex; a complex for each simplex on the boundary that has a polygon.

use super::domain::{BoxGrid, PER_CUBE};
use super::local::{Local, Setting};
use super::simplex::{FaceSupport, LocalFace};
use super::table::FACETS;
use super::{Domain, Network};
use crate::base::parallel::map_ranges;
use crate::base::{Csr, Error, NodeId, PolygonId, Result, Run, TetId, TriangleId, VertexId};
use crate::exact::Sign;
use crate::mesh::TriMesh;
use crate::mesh::build::{MeshInput, MeshOptions, build};
use rayon::prelude::*;

/// The polygons of each simplex, those on its facets included.
pub struct TetPolygons(Vec<(TetId, PolygonId)>);

impl TetPolygons {
    pub fn new(network: &Network) -> Self {
        let mut pairs: Vec<(TetId, PolygonId)> = Vec::with_capacity(network.polygon_count());
        for (p, &[a, b]) in network.polygon_tets.iter().enumerate() {
            pairs.push((a, PolygonId::of(p)));
            if a != b {
                pairs.push((b, PolygonId::of(p)));
            }
        }
        pairs.par_sort_unstable();
        Self(pairs)
    }

    /// Those of a simplex, rising.
    pub fn of(&self, tet: TetId) -> impl Iterator<Item = PolygonId> + Clone + '_ {
        let first = self.0.partition_point(|pair| pair.0 < tet);
        self.0[first..].iter().take_while(move |pair| pair.0 == tet).map(|pair| pair.1)
    }
}

/// The surface of a domain.
pub struct Boundary {
    /// One triangle for each facet, its normal outward; `vertex_source` has the nodes, rising.
    pub mesh: TriMesh,
    /// The simplex and the number of the facet of each triangle, rising.
    pub facets: Vec<(TetId, u8)>,
}

impl Boundary {
    /// The mesh vertex at a node.
    pub fn vertex(&self, node: NodeId) -> Option<VertexId> {
        self.mesh.vertex_source.binary_search(&node.0).ok().map(VertexId::of)
    }
}

/// The facets that have a simplex on one side only, rising.
fn boundary_facets(domain: &Domain) -> Vec<(TetId, u8)> {
    match domain {
        Domain::Mesh(mesh) => {
            let open = |t: usize| (0..=mesh.dim).filter(move |&i| mesh.neighbours[t][i].is_none());
            let facets = (0..mesh.tets.len()).flat_map(|t| open(t).map(move |i| (TetId::of(t), i as u8)));
            facets.collect()
        }
        Domain::Box(grid) => box_facets(grid),
    }
}

fn box_facets(grid: &BoxGrid) -> Vec<(TetId, u8)> {
    let [nx, ny, nz] = grid.cells();
    let mut facets = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            let inner = j > 0 && j + 1 < ny && k > 0 && k + 1 < nz;
            let mut i = 0;
            while i < nx {
                let cube = grid.cube_number([i, j, k]);
                for tet in (cube * PER_CUBE..(cube + 1) * PER_CUBE).map(TetId::of) {
                    let open = (0..4).filter(|&facet| grid.opposite(tet, facet).is_none());
                    facets.extend(open.map(|facet| (tet, facet as u8)));
                }
                i = if inner && i == 0 { (nx - 1).max(1) } else { i + 1 };
            }
        }
    }
    facets
}

/// The nodes of a facet, counterclockwise seen from outside of its simplex.
fn outward(domain: &Domain, tet: TetId, facet: u8) -> [NodeId; 3] {
    let corners = domain.corners(tet);
    let [a, b, c] = FACETS[1][facet as usize].map(|k| corners[k]);
    if domain.orientation(tet) == Sign::Positive { [a, c, b] } else { [a, b, c] }
}

/// Errors: `BadMesh` for a domain without simplices, or two nodes of its boundary in one place; `TooLarge`; `Cancelled`.
pub fn find_boundary(domain: &Domain, run: &mut Run) -> Result<Boundary> {
    let facets = boundary_facets(domain);
    let mut corners: Vec<[NodeId; 3]> = facets.iter().map(|&(tet, facet)| outward(domain, tet, facet)).collect();
    let options = MeshOptions { merge_duplicate_vertices: false, check_self_intersection: false };
    let as_triangles = |corners: &[[NodeId; 3]]| -> Vec<[i32; 3]> {
        corners.iter().map(|corners| corners.map(|n| n.0 as i32)).collect()
    };
    let mesh = match domain {
        // Defects name the nodes.
        Domain::Mesh(mesh) => {
            let triangles = as_triangles(&corners);
            build(&MeshInput { vertices: &mesh.vertices, triangles: &triangles, tags: None }, &options, run)?
        }
        Domain::Box(_) => {
            let mut nodes: Vec<NodeId> = corners.iter().flatten().copied().collect();
            nodes.sort_unstable();
            nodes.dedup();
            let number = |n: NodeId| NodeId::of(nodes.partition_point(|&m| m < n));
            corners.iter_mut().flatten().for_each(|n| *n = number(*n));
            let vertices: Vec<[f64; 3]> = nodes.iter().map(|&n| domain.coordinates(n)).collect();
            let triangles = as_triangles(&corners);
            let mut mesh = build(&MeshInput { vertices: &vertices, triangles: &triangles, tags: None }, &options, run)?;
            mesh.vertex_source.iter_mut().for_each(|v| *v = nodes[*v as usize].0);
            mesh
        }
    };
    Ok(Boundary { mesh, facets })
}

/// The pieces of the triangles, in their order.
pub struct Walls {
    pub loops: Csr<VertexId>,
    pub triangle: Vec<TriangleId>,
}

/// Cuts the triangles. `name`: what the vertices of the network are called in the loops; nodes go by their mesh vertices.
pub fn cut_walls(
    setting: &Setting,
    boundary: &Boundary,
    polygons: &TetPolygons,
    name: impl Fn(VertexId) -> VertexId + Sync,
) -> Result<Walls> {
    let network = setting.network;
    let inside = |tet: TetId| polygons.of(tet).any(|p| network.polygon_tets[p.at()] == [tet; 2]);
    let lost =
        |tet: TetId| Error::inconsistent(format!("a facet of simplex {} has a point that the network has not", tet.0));
    let parts = map_ranges(boundary.facets.len(), 1 << 10, |range| {
        let (mut loops, mut triangle) = (Csr::default(), Vec::new());
        let (mut local, mut names) = (Local::default(), Vec::new());
        let mut named = TetId::NONE;
        for t in range {
            let (tet, facet) = boundary.facets[t];
            if !inside(tet) {
                loops.push_row(&boundary.mesh.triangles[t]);
                triangle.push(TriangleId::of(t));
                continue;
            }
            if named != tet {
                named = tet;
                local.build(setting, tet);
                names.clear();
                names.resize(local.complex.vertex_count(), VertexId::NONE);
                for v in polygons.of(tet).flat_map(|p| network.polygons.row(p)) {
                    let here = local.vertex(network, *v).ok_or_else(|| lost(tet))?;
                    names[here.at()] = name(*v);
                }
            }
            let complex = &local.complex;
            for f in (0..complex.face_count()).map(LocalFace::of) {
                if complex.face_support[f.at()] != FaceSupport::Facet(facet) {
                    continue;
                }
                // Loops of an upright complex run counterclockwise seen from inside.
                let start = loops.items.len();
                for v in complex.face_vertices.row(f) {
                    let carrier = complex.vertex_carrier[v.at()];
                    let known = match carrier.dim() {
                        0 => boundary.vertex(local.corners[carrier.0.trailing_zeros() as usize]),
                        _ => Some(names[v.at()]).filter(|v| v.is_some()),
                    };
                    loops.items.push(known.ok_or_else(|| lost(tet))?);
                }
                if setting.domain.orientation(tet) == Sign::Positive {
                    loops.items[start..].reverse();
                }
                loops.end_row();
                triangle.push(TriangleId::of(t));
            }
        }
        Ok((loops, triangle))
    });
    let (loops, triangle) = parts.into_iter().collect::<Result<Vec<_>>>()?.into_iter().unzip();
    Ok(Walls { loops: Csr::concat(loops), triangle: crate::base::parallel::concat(triangle) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_have_the_facets_of_their_tetrahedra() {
        for cells in [[1, 1, 1], [2, 1, 3], [3, 4, 3]] {
            let grid = BoxGrid::new(cells, None).unwrap();
            let open = |t: TetId| (0..4).filter(|&i| grid.opposite(t, i).is_none()).collect::<Vec<_>>();
            let all = (0..grid.tet_count()).map(TetId::of);
            let expected: Vec<_> = all.flat_map(|t| open(t).into_iter().map(move |i| (t, i as u8))).collect();
            assert_eq!(box_facets(&grid), expected);
            let [x, y, z] = cells.map(|n| n as usize);
            assert_eq!(expected.len(), 4 * (x * y + y * z + z * x));
        }
    }
}

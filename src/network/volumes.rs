//! The regions of a network as cells of a complex: closed, with shells and moments like those that planes cut.
//!
//! Faces: the pieces of the domain's boundary ([`super::walls`]), by triangle, then the polygons of the network. Vertices: the nodes of the boundary, then the
//! network's other vertices. Cells: the regions. All in the order of their ids. A polygon with one region on both sides is a face of
//! its cell twice.
//!
//! Half-faces are joined across edges as in every complex ([`crate::complex::shells`]); those of a shell border one region, of which a polygon tells,
//! or where the shell has none a walk through the domain ([`super::locate`]).
//!
//! Cost: linear in the network and the boundary, sorts of edges and polygons, and what `walls` and `locate` need.

use super::data::Network;
use super::exact_vertices::symbolic_vertex;
use super::local::Setting;
use super::locate::region_at;
use super::simplex::Kind;
use super::topology::Topology;
use super::walls::{Boundary, TetPolygons, cut_walls, find_boundary};
use crate::base::parallel::{concat, map_ranges};
use crate::base::{CellId, Csr, Error, FaceId, FunctionId, PlaneId, PolygonId, Result, Run, Status, VertexId};
use crate::complex::bodies::assign_components;
use crate::complex::loops::find_edges;
use crate::complex::shells::{Joined, fill_cells, find_shells, outer_shells};
use crate::complex::{Complex, HalfFace, Levels, Origin, SupportId};
use crate::exact::{Gradient, Linear, Sign, Zero};
use std::sync::Arc;

/// Elements in one task at least.
const LEAST: usize = 1 << 10;

/// The regions as volumes: cell `i` is region `i`, polygon `p` is face `p` behind those of the boundary, and `levels.vertices` has the network's
/// names of vertices. Exact: points and supports are symbolic.
///
/// Errors: `BadArgument` in two dimensions; `BadMesh` for a domain without simplices, or one with two nodes of its boundary in
/// one place; `TooLarge`; `Cancelled`; `Inconsistent` if network, topology and values do not belong together.
pub fn volumes(setting: &Setting, topology: &Topology, run: &mut Run) -> Result<Complex> {
    let (network, domain) = (setting.network, setting.domain);
    if domain.dim() != 3 {
        return Err(Error::new(Status::BadArgument, "regions in two dimensions have no volumes"));
    }
    let boundary = find_boundary(domain, run)?;
    run.stage("walls", 0.3)?;
    let polygons = TetPolygons::new(network);
    let names = name_vertices(network, &boundary);
    let walls = cut_walls(setting, &boundary, &polygons, |v| names[v.at()])?;
    run.stage("levels", 0.4)?;
    let mut c = Complex { levels: Arc::new(find_levels(setting, &boundary, &names)), ..Complex::default() };
    fill_vertices(&mut c, network, &boundary);
    run.stage("faces", 0.5)?;
    let wall_count = walls.triangle.len();
    let faces = wall_count + network.polygon_count();
    let first = walls.loops.items.len() as u32;
    c.face_loops = (0..=faces as u32).collect();
    c.loop_offsets = walls.loops.offsets;
    c.loop_offsets.extend(network.polygons.offsets[1..].iter().map(|&x| first + x));
    c.corner_vertices = walls.loops.items;
    c.corner_vertices.extend(network.polygons.items.iter().map(|v| names[v.at()]));
    c.face_support = walls.triangle.into_iter().map(SupportId::Triangle).collect();
    c.face_support.extend((0..network.polygon_count()).map(|p| SupportId::Level(PolygonId::of(p))));
    c.face_plane = vec![PlaneId::NONE; faces];
    c.face_tag = vec![0; faces];
    (c.edges, c.corner_edges) = find_edges(&c.loop_offsets, &c.corner_vertices);
    let Boundary { mesh, facets } = boundary;
    c.mesh = Arc::new(mesh);
    if 2 * faces > i32::MAX as usize || c.corner_vertices.len() > i32::MAX as usize {
        return Err(Error::new(Status::TooLarge, "the regions have more elements than 32-bit indices can number"));
    }

    run.stage("cells", 0.7)?;
    let shells = find_shells(&c, &Joined::nothing(&c), || |_| None)?;
    let mut cell_of = vec![CellId::NONE; shells.lowest.len()];
    for p in (0..network.polygon_count()).map(PolygonId::of) {
        for front in [false, true] {
            let shell = shells.of[HalfFace::new(FaceId::of(wall_count + p.at()), front).at()];
            let cell = CellId(topology.region_beside(p, front).0);
            let known = &mut cell_of[shell.at()];
            if known.is_some() && *known != cell {
                return Err(Error::inconsistent(format!("a shell at polygon {} borders two regions", p.0)));
            }
            *known = cell;
        }
    }
    for (cell, lowest) in cell_of.iter_mut().zip(&shells.lowest).filter(|(cell, _)| cell.is_none()) {
        let SupportId::Triangle(t) = c.face_support[lowest.face().at()] else { continue };
        *cell = CellId(region_at(setting, topology, &polygons, facets[t.at()])?.0);
    }
    let cells = topology.regions.len();
    let outer = outer_shells(&c, &shells, &cell_of, cells)?;
    fill_cells(&mut c, &shells, cells, &cell_of, |s| outer[cell_of[s.at()].at()] == s);
    assign_components(&mut c)?;
    run.end_stage();
    Ok(c)
}

/// What the complex calls the vertices of the network.
fn name_vertices(network: &Network, boundary: &Boundary) -> Vec<VertexId> {
    let mut next = boundary.mesh.vertices.len();
    let mut others = || {
        next += 1;
        VertexId::of(next - 1)
    };
    let name = |nodes: &[crate::base::NodeId; 4]| match nodes[1].is_none() {
        true => boundary.vertex(nodes[0]).unwrap_or_else(&mut others),
        false => others(),
    };
    network.vertex_nodes.iter().map(name).collect()
}

fn find_levels(setting: &Setting, boundary: &Boundary, names: &[VertexId]) -> Levels {
    let network = setting.network;
    let on_surface = boundary.mesh.vertices.len();
    let vertices: Vec<VertexId> =
        (0..network.vertex_count()).map(VertexId::of).filter(|v| names[v.at()].at() >= on_surface).collect();
    let point = |v: VertexId| symbolic_vertex(network, setting.domain, &setting.values, v);
    let points =
        map_ranges(vertices.len(), LEAST, |range| vertices[range].iter().map(|&v| point(v)).collect::<Vec<Zero>>());
    let supports = map_ranges(network.polygon_count(), LEAST, |range| {
        range.map(|p| gradient(setting, PolygonId::of(p))).collect::<Vec<Gradient>>()
    });
    Levels { points: concat(points), vertices, supports: concat(supports) }
}

/// A function that vanishes on a polygon and rises along its normal, on a simplex beside it where it does not vanish everywhere.
fn gradient(setting: &Setting, p: PolygonId) -> Gradient {
    let (network, domain, values) = (setting.network, setting.domain, &setting.values);
    let tets = network.polygon_tets[p.at()];
    let set = network.set_of(p.at());
    let mut gradient = Gradient { corners: [[0.0; 3]; 4], function: Linear::default() };
    for (side, &tet) in tets.iter().enumerate() {
        let nodes = domain.corners(tet);
        let row = |f: FunctionId| nodes.map(|n| values.at(f, n));
        let mut function = Linear::default();
        let mut falls = false;
        if network.kind == Kind::Interface {
            function = Linear { first: row(set[0].function), second: row(set[1].function) };
        } else if let Some(item) = set.iter().find(|item| row(item.function) != [0.0; 4]) {
            function.first = row(item.function);
            falls = if tets[0] == tets[1] {
                item.orientation == Sign::Negative
            } else {
                // It has one sign here, and the normal points into the first simplex.
                function.first.iter().any(|&x| x > 0.0) != (side == 0)
            };
        }
        if function.first == function.second {
            continue;
        }
        if falls {
            function.first = function.first.map(|x| -x);
        }
        gradient = Gradient { corners: nodes.map(|n| domain.coordinates(n)), function };
        if domain.orientation(tet) == Sign::Negative {
            gradient.corners.swap(0, 1);
            gradient.function.first.swap(0, 1);
            gradient.function.second.swap(0, 1);
        }
        break;
    }
    gradient
}

fn fill_vertices(c: &mut Complex, network: &Network, boundary: &Boundary) {
    let levels = &c.levels;
    c.coords = boundary.mesh.vertices.clone();
    c.coords.extend(levels.vertices.iter().map(|v| network.vertices[v.at()]));
    c.origins = (0..boundary.mesh.vertices.len()).map(|v| Origin::Mesh(VertexId::of(v))).collect();
    c.origins.extend((0..levels.points.len() as u32).map(Origin::Level));
    c.vertex_planes = Csr { offsets: vec![0; c.coords.len() + 1], items: Vec::new() };
}

//! Cut: a closed triangle mesh by planes into the cells between them (the TopoCut paper, DESIGN §4).
//!
//! Stages in pipeline order: [`classify`] → [`edges`] → [`triangles`] → [`sections`] and [`lines`] → [`faces`] →
//! [`assemble`] → shells and cells (`complex::shells`) → [`voids`].

pub mod assemble;
pub mod classify;
pub mod edges;
pub mod faces;
pub mod lines;
pub mod patches;
pub mod sections;
pub mod surface;
pub mod triangles;
pub mod voids;

use crate::base::parallel::Pool;
use crate::base::{Error, PlaneId, Result, Run, Status};
use crate::complex::{Complex, Origin, shells};
use crate::exact::{self, Plane};
use crate::mesh::TriMesh;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// Nothing to choose yet.
#[derive(Clone, Copy, Debug, Default)]
pub struct CutOptions {}

/// The cells into which planes divide a solid.
#[derive(Debug, Default)]
pub struct Cut {
    pub complex: Complex,
    /// For each input plane the lowest plane that coincides with it.
    pub plane_map: Vec<PlaneId>,
    /// Seconds per stage, in order.
    pub stages: Vec<(&'static str, f64)>,
}

/// Cuts a solid along planes. Faces, edges and vertices outside the closed solid are not built. Runs on the current rayon
/// pool; the result does not depend on its size.
///
/// Errors: `BadPlane` with every plane that is not finite or has a zero normal; `TooLarge`; `Cancelled`; `Inconsistent`
/// if the mesh intersects itself in a way that shows.
pub fn cut(mesh: &Arc<TriMesh>, planes: &[Plane], _options: &CutOptions, run: &mut Run) -> Result<Cut> {
    exact::planes::validate(planes)?;
    limit(planes.len())?;
    run.stage("classify", 0.0)?;
    let [low, high] = mesh.bbox;
    let max_abs = std::array::from_fn(|i| low[i].abs().max(high[i].abs()));
    let knives = classify::Knives::new(planes, max_abs);
    let classified = classify::classify(mesh, &knives);
    debug_assert_eq!(classified.check(mesh, &knives), Ok(()));
    limit(mesh.edges.len() + classified.edge_crossings.items.len())?;
    run.stage("edges", 0.15)?;
    let points = edges::edge_points(mesh, &knives, &classified);
    debug_assert_eq!(points.check(), Ok(()));
    let first_edge_point = mesh.vertices.len() as u32;
    let numbering = triangles::Numbering {
        first_edge_point,
        first_inner_point: first_edge_point + points.edge.len() as u32,
        first_chord_piece: (mesh.edges.len() + points.edge.len()) as u32,
    };
    run.stage("triangles", 0.25)?;
    let sub = triangles::subdivide(mesh, &knives, &classified, &points, numbering);
    debug_assert_eq!(sub.check(), Ok(()));
    limit(numbering.first_inner_point as usize + sub.point_triangle.len())?;
    limit(numbering.first_chord_piece as usize + sub.pieces.len())?;
    run.stage("round", 0.4)?;
    let mut origins = surface::surface_origins(mesh, &knives, &points, &sub);
    let mut coords = Vec::with_capacity(origins.len());
    coords.par_extend(mesh.vertices.par_iter().with_min_len(1 << 13));
    round_from(mesh, planes, &origins, &mut coords);
    let surface_count = origins.len();
    let vertex_edges = OnceLock::new();
    let ground = surface::Ground {
        mesh,
        knives: &knives,
        classified: &classified,
        points: &points,
        sub: &sub,
        numbering,
        input_planes: planes,
        vertex_edges: &vertex_edges,
    };
    run.stage("lines", 0.5)?;
    let surface = ground.with(&origins, &coords);
    let contents = sections::plane_contents(&surface);
    let pool = Pool::default();
    let (pieces, mut lines) = lines::sections_and_lines(&surface, &contents, &pool)?;
    let inner = lines::number_inner(&surface, &mut lines, surface_count as u32);
    debug_assert_eq!(lines.check(), Ok(()));
    limit(surface_count + inner.names.len())?;
    let first_line_edge = numbering.first_chord_piece + sub.pieces.len() as u32;
    limit(first_line_edge as usize + lines.ends.len() + lines.points.items.len())?;
    run.stage("round inner", 0.6)?;
    origins.reserve_exact(inner.names.len());
    origins.par_extend(inner.names.par_iter().with_min_len(1 << 13).map(|&[p, q, r]| Origin::Planes(p, q, r)));
    round_from(mesh, planes, &origins, &mut coords);
    run.stage("faces", 0.65)?;
    let surface = ground.with(&origins[..surface_count], &coords[..surface_count]);
    let all = faces::AllVertices { surface: &surface, origins: &origins, coords: &coords };
    let has_voids = mesh.shells.iter().any(|s| !s.outer);
    let sections = faces::section_faces(&all, &contents, pieces, &lines, first_line_edge, &pool, has_voids)?;
    drop((contents, pool));
    run.stage("assemble", 0.75)?;
    let whole = patches::whole_triangles(mesh, &sub.cut);
    let (mut complex, first_face) = assemble::assemble(mesh, &surface, &whole, &lines, &inner, &sections);
    limit(complex.corner_vertices.len())?;
    (complex.origins, complex.coords) = (origins, coords);
    run.stage("cells", 0.85)?;
    let surface = ground.with(&complex.origins[..surface_count], &complex.coords[..surface_count]);
    let mesh_pieces = numbering.first_chord_piece;
    let joined = patches::join_whole(mesh, &classified, &points, &sub.cut, &whole, complex.face_count(), mesh_pieces);
    let found = shells::find_shells(&complex, &joined, || lines.directions(&surface, first_line_edge))?;
    run.stage("voids", 0.95)?;
    let all = faces::AllVertices { surface: &surface, origins: &complex.origins, coords: &complex.coords };
    let graphs = sections.iter().flat_map(|s| &s.graphs).collect();
    let located = voids::Located { all: &all, graphs, first_face: &first_face };
    let hosts = voids::hosts(&complex, &found, &located)?;
    shells::form_cells(&mut complex, &found, &hosts)?;
    crate::complex::bodies::assign_components(&mut complex)?;
    let plane_map = knives.knife_of.iter().map(|k| knives.ids[k.at()]).collect();
    run.end_stage();
    Ok(Cut { complex, plane_map, stages: run.take_stages() })
}

/// Ids are 32-bit, and half-faces and half-edges take one bit of them.
fn limit(count: usize) -> Result<()> {
    if count < (i32::MAX / 2) as usize {
        return Ok(());
    }
    Err(Error::new(Status::TooLarge, format!("{count} elements are more than 32-bit ids can number")))
}

/// Correctly rounded coordinates of the origins that have none yet.
fn round_from(mesh: &TriMesh, planes: &[Plane], origins: &[Origin], coords: &mut Vec<[f64; 3]>) {
    let rest = &origins[coords.len()..];
    coords.reserve_exact(rest.len());
    let rounded = |&origin: &Origin| exact::round(&crate::complex::data::origin_point(mesh, planes, origin));
    coords.par_extend(rest.par_iter().with_min_len(256).map(rounded));
}

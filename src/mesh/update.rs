//! Moved coordinates on the same connectivity: the adjacency is kept, everything that depends on where vertices are is judged and
//! computed anew.
//!
//! Invariant: the mesh is afterwards what [`super::build`] makes of the new coordinates, array by array; after an error it is as
//! it was. Who holds the mesh otherwise (a cut, a grid) keeps the old one: it is copied first.
//!
//! Degenerate cases: as in building; vertices that have become equal are a defect, since merging would change the connectivity.
//! Cost: linear, about a third of that of building; a copy of the adjacency if somebody else holds the mesh.

use super::build::{bad_mesh, bounding_box, intersections, shell_list, signs, zero_volumes};
use super::shells::{Sets, Surface};
use super::{MeshOptions, TriMesh, bvh, nesting, shells, validate};
use crate::base::{Culprit, DefectKind, Error, Result, Run, ShellId, Status};
use rayon::prelude::*;
use std::sync::Arc;

/// Moves the vertices of a mesh; `vertices` are in the order of [`TriMesh::vertices`]. Of the options, only the check for
/// self-intersections counts.
///
/// Errors: `BadArgument` for another number of vertices; `BadMesh` with all defects, ids being those of the mesh's own vertices and
/// triangles; `Inconsistent`, `Cancelled` as in building.
pub fn update_coordinates(
    mesh: &mut Arc<TriMesh>,
    vertices: &[[f64; 3]],
    options: &MeshOptions,
    run: &mut Run,
) -> Result<()> {
    if vertices.len() != mesh.vertices.len() {
        let (given, held) = (vertices.len(), mesh.vertices.len());
        return Err(Error::new(Status::BadArgument, format!("{given} vertices for a mesh of {held}")));
    }
    run.stage("mesh: coordinates", 0.0)?;
    let mut defects = Vec::new();
    validate::non_finite(vertices, &mut defects);
    let vertices: Vec<[f64; 3]> = vertices.par_iter().with_min_len(1 << 13).map(|x| x.map(|c| c + 0.0)).collect();
    let finite = |v: u32| validate::is_finite(&vertices[v as usize]);
    let equal = validate::duplicates(&vertices, finite);
    defects.extend(equal.iter().map(|p| Culprit::new(DefectKind::DuplicateVertex, &p.map(i64::from))));
    validate::degenerate(&vertices, &mesh.triangles, |t| {
        defects.push(Culprit::new(DefectKind::DegenerateTriangle, &[t as i64]));
    });
    if !defects.is_empty() {
        return Err(bad_mesh(defects));
    }
    run.stage("mesh: shells", 0.4)?;
    let surface =
        Surface { vertices: &vertices, triangles: &mesh.triangles, edges: &mesh.edges, edge_uses: &mesh.edge_uses };
    // Components follow from the connectivity; shells do where no edge has more than two triangles.
    let shells = shells::shells(surface).unwrap_or_else(|| Sets {
        of: mesh.triangle_shell.iter().map(|s| s.0).collect(),
        lowest: mesh.shells.iter().map(|s| s.triangle.0).collect(),
    });
    let components =
        Sets { of: mesh.triangle_shell.iter().map(|s| mesh.shells[s.at()].component.0).collect(), lowest: Vec::new() };
    let signs = signs(&vertices, &mesh.triangles, &shells);
    let list = shell_list(&components, &shells, &signs);
    zero_volumes(&list, &signs, |t| t as i64, &mut defects);
    if options.check_self_intersection {
        run.stage("mesh: self-intersection", 0.6)?;
        let tree = bvh::build_bvh(&vertices, &mesh.triangles);
        intersections(&vertices, &mesh.triangles, &tree, |t| t as i64, &mut defects);
    }
    if !defects.is_empty() {
        return Err(bad_mesh(defects));
    }
    run.stage("mesh: nesting", 0.9)?;
    let mesh = Arc::make_mut(mesh);
    let bbox = bounding_box(&vertices);
    let old_vertices = std::mem::replace(&mut mesh.vertices, vertices);
    let old_bbox = std::mem::replace(&mut mesh.bbox, bbox);
    let triangle_shell = shells.of.into_iter().map(ShellId).collect();
    let old_of = std::mem::replace(&mut mesh.triangle_shell, triangle_shell);
    let old_shells = std::mem::replace(&mut mesh.shells, list);
    let outcome = match nesting::nest(mesh) {
        Ok(wrong) if wrong.is_empty() => Ok(()),
        Ok(wrong) => Err(bad_mesh(wrong)),
        Err(error) => Err(error),
    };
    if outcome.is_err() {
        (mesh.vertices, mesh.bbox) = (old_vertices, old_bbox);
        (mesh.triangle_shell, mesh.shells) = (old_of, old_shells);
    }
    run.end_stage();
    outcome
}

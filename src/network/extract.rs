//! From function values at the nodes of a domain to vertices and polygons: the pipeline of the first half of a network.

use super::assemble::assemble;
use super::data::{Network, Values};
use super::domain::{Domain, LIMIT};
use super::points::EdgePoints;
use super::polygons::{Context, Marks};
use super::signs::{labels, node_signs, sign_rows};
use super::simplex::Kind;
use super::{box_cubes, box_edges, mesh_cells, mesh_edges};
use crate::base::{Error, Result, Run, Status};

/// Vertices and polygons of the arrangement (interface) of functions that are linear on each simplex of the domain.
///
/// Errors: `BadArgument` for a value that is not finite, arrays that are too short, an interface without materials; `TooLarge` beyond 2³⁰
/// vertices or functions; `Cancelled`. Cost: reading the values once, and linear in active simplices; in a simplex with n ≥ 3 active functions that of its complex.
pub fn extract(domain: &Domain, values: &Values, kind: Kind, run: &mut Run) -> Result<Network> {
    values.check(domain.node_count())?;
    if values.len() >= LIMIT {
        return Err(Error::new(Status::TooLarge, "2^30 functions or more"));
    }
    if kind == Kind::Interface && values.is_empty() {
        return Err(Error::new(Status::BadArgument, "an interface needs a material"));
    }
    let marks = Marks::new(domain.node_count());
    run.stage("signs", 0.0)?;
    let network = match (domain, kind) {
        (Domain::Box(grid), Kind::Arrangement) => {
            let [nx, ny, nz] = grid.cells();
            let signs = sign_rows(values, nx + 1, (ny + 1) * (nz + 1))?;
            run.stage("points", 0.15)?;
            let edges = box_edges::arrangement_edges(grid, values, &signs);
            run.stage("polygons", 0.4)?;
            let context = Context { kind, domain, values, edge_functions: edges.functions(), marks: &marks };
            let parts = box_cubes::arrangement_cubes(grid, &context, &signs, &edges);
            run.stage("assemble", 0.65)?;
            assemble(kind, domain, values, edges, marks, parts)
        }
        (Domain::Box(grid), Kind::Interface) => {
            let labels = labels(values, domain.node_count())?;
            run.stage("points", 0.15)?;
            let edges = box_edges::interface_edges(grid, values, &labels);
            run.stage("polygons", 0.4)?;
            let context = Context { kind, domain, values, edge_functions: edges.functions(), marks: &marks };
            let parts = box_cubes::interface_cubes(grid, &context, &labels, &edges);
            run.stage("assemble", 0.65)?;
            assemble(kind, domain, values, edges, marks, parts)
        }
        (Domain::Mesh(mesh), Kind::Arrangement) => {
            let signs = node_signs(values, domain.node_count())?;
            run.stage("points", 0.15)?;
            let edges = mesh_edges::arrangement_edges(mesh, values, &signs);
            run.stage("polygons", 0.4)?;
            let context = Context { kind, domain, values, edge_functions: edges.functions(), marks: &marks };
            let parts = mesh_cells::arrangement_cells(mesh, &context, &signs, &edges);
            run.stage("assemble", 0.65)?;
            assemble(kind, domain, values, edges, marks, parts)
        }
        (Domain::Mesh(mesh), Kind::Interface) => {
            let labels = labels(values, domain.node_count())?;
            run.stage("points", 0.15)?;
            let edges = mesh_edges::interface_edges(mesh, values, &labels);
            run.stage("polygons", 0.4)?;
            let context = Context { kind, domain, values, edge_functions: edges.functions(), marks: &marks };
            let parts = mesh_cells::interface_cells(mesh, &context, &labels, &edges);
            run.stage("assemble", 0.65)?;
            assemble(kind, domain, values, edges, marks, parts)
        }
    }?;
    run.end_stage();
    Ok(network)
}

//! The cut cells as an ordinary `Complex`, on demand: with edges and each vertex's planes.
//!
//! Full boxes are not in it, so a face towards one has a cell on one side only, and that may be the upper side: no owner then, since
//! normals stay along the axes. Elements keep their ids. The complex is not the whole solid: `check_part` applies, `check_volumes` and the Euler
//! characteristic of the solid do not.
//!
//! Cost: linear, and a sort of the corners that finds edges; about twice the memory of what is kept.

use super::data::{FULL_CELL, GridCells};
use crate::base::{CellId, ComponentId, Csr, FaceId, PlaneId, VertexId};
use crate::complex::loops::find_edges;
use crate::complex::{Complex, SupportId};

/// All planes through a vertex, by rising id.
pub fn planes_through(grid: &GridCells, v: VertexId) -> impl Iterator<Item = PlaneId> + '_ {
    let bits = grid.on_planes[v.at()];
    (0..3).filter(move |a| bits >> a & 1 != 0).map(move |a| grid.plane_through(v, a))
}

/// The lowest plane that holds a whole wall.
fn plane_of_wall(grid: &GridCells, f: FaceId) -> PlaneId {
    let corners = grid.face_corners(f);
    let common = corners.iter().fold(7, |bits, v| bits & grid.on_planes[v.at()]);
    let first = grid.coords[corners[0].at()];
    // On one plane of an axis each, but perhaps on different ones.
    let axis = (0..3).find(|&a| common >> a & 1 != 0 && corners.iter().all(|v| grid.coords[v.at()][a] == first[a]));
    axis.map_or(PlaneId::NONE, |a| grid.lattice.plane(a, grid.lattice.nodes[a].partition_point(|n| *n < first[a])))
}

pub fn to_complex(grid: &GridCells) -> Complex {
    let faces = grid.face_count();
    let walls = grid.wall_count();
    let real = |c: CellId| if c == FULL_CELL { CellId::NONE } else { c };
    let mut face_cells: Vec<[CellId; 2]> = grid.wall_cell.iter().map(|&c| [c, CellId::NONE]).collect();
    face_cells.extend(grid.square_cells.iter().map(|cells| cells.map(real)));
    let (edges, corner_edges) = find_edges(&grid.loop_offsets, &grid.corners);
    let mut vertex_planes = Csr::with_capacity(grid.vertex_count(), 2 * grid.vertex_count());
    for v in 0..grid.vertex_count() {
        vertex_planes.items.extend(planes_through(grid, VertexId::of(v)));
        vertex_planes.end_row();
    }
    let tag = |f: usize| match grid.wall_triangle.get(f) {
        Some(t) => grid.mesh.tags.get(t.at()).copied().unwrap_or(0),
        None => 0,
    };
    let support = |f: FaceId| match grid.face_plane(f) {
        None => SupportId::Triangle(grid.wall_triangle[f.at()]),
        Some(p) => SupportId::Plane(p),
    };
    let plane = |f: FaceId| grid.face_plane(f).unwrap_or_else(|| plane_of_wall(grid, f));
    let mut cell_component = vec![ComponentId(0); grid.cell_count()];
    for f in (0..walls).rev() {
        let shell = grid.mesh.triangle_shell[grid.wall_triangle[f].at()];
        cell_component[grid.wall_cell[f].at()] = grid.mesh.shells[shell.at()].component;
    }
    Complex {
        mesh: grid.mesh.clone(),
        planes: grid.planes.clone(),
        levels: Default::default(),
        two_sided: false,
        origins: (0..grid.vertex_count()).map(|v| grid.origin(VertexId::of(v))).collect(),
        coords: grid.coords.clone(),
        vertex_planes,
        edges,
        face_loops: grid.face_loops.clone(),
        loop_offsets: grid.loop_offsets.clone(),
        corner_vertices: grid.corners.clone(),
        corner_edges,
        face_support: (0..faces).map(FaceId::of).map(support).collect(),
        face_plane: (0..faces).map(FaceId::of).map(plane).collect(),
        face_tag: (0..faces).map(tag).collect(),
        face_cells,
        cell_shells: grid.cell_shells.clone(),
        shell_faces: grid.shell_faces.clone(),
        cell_component,
    }
}

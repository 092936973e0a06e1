//! Grid: the boxes of a rectilinear grid against a surface: full, empty or cut into polyhedra.
//!
//! Stages in pipeline order: [`ground`] → [`pieces`] → [`points`] → [`touched`] → [`lines`] (with [`inside`]) → [`squares`] → [`cells`] (with
//! [`voids`]) → [`assemble`]. On demand: [`moments`], [`boundaries`], [`regions`], [`aggregate`], [`full_faces`], [`keys`], [`to_complex`].

pub mod aggregate;
pub mod assemble;
pub mod boundaries;
pub mod cell_sums;
pub mod cells;
pub mod check;
pub mod data;
pub mod exact_moments;
pub mod face_sums;
pub mod fixed_point;
pub mod full_faces;
pub mod gathered;
pub mod ground;
pub mod inside;
pub mod keys;
pub mod lattice;
pub mod lines;
pub mod moments;
pub mod oriented;
pub mod pieces;
pub mod points;
pub mod refined;
pub mod regions;
pub mod second_moments;
pub mod settle;
pub mod square_stars;
pub mod squares;
pub mod to_complex;
pub mod touched;
pub mod voids;
pub mod wall_sums;

use crate::base::{Csr, Error, Result, Run, Status};
use crate::cut::classify::KnifeId;
use crate::cut::faces::AllVertices;
use crate::cut::sections::vertices_on;
use crate::cut::surface;
use crate::cut::triangles::{Numbering, Subdivision};
use crate::mesh::TriMesh;
use crate::mesh::bvh::build_bvh;
use crate::mesh::inside::{Place, locate};
use ground::{Ground, on_plane};
use lines::AllSlabs;
use pieces::Pieces;
use std::sync::{Arc, OnceLock};
use touched::Touched;

pub use data::{CUT, EMPTY, FULL, FULL_CELL, GridCells, Origins};
pub use keys::keys;
pub use lattice::Lattice;
pub use to_complex::to_complex;

/// What to take for fluid, and where the block's fluid is known.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridOptions {
    /// The fluid is outside the mesh.
    pub outside: bool,
    /// For a patch of a mesh: a node of the block, and whether it is in the fluid (not on the surface). `None`: the mesh is whole.
    pub known: Option<([usize; 3], bool)>,
}

/// Cuts the boxes of a block along a surface. Runs on the current rayon pool; the result does not depend on its size.
///
/// Errors: `TooLarge`; `Cancelled`; `Inconsistent` if the surface intersects itself in a way that shows, or if a patch lacks triangles.
pub fn cut_grid(mesh: &Arc<TriMesh>, lattice: Lattice, options: &GridOptions, run: &mut Run) -> Result<GridCells> {
    run.stage("classify", 0.0)?;
    let given = mesh;
    let mesh = oriented::oriented(given, options.outside);
    let ground = Ground::new(&mesh, &lattice)?;
    debug_assert_eq!(ground.check(), Ok(()));
    limit(ground.slabs.len())?;
    if options.known.is_some() {
        ground.require_balance()?;
    }
    run.stage("pieces", 0.1)?;
    let mut pieces = pieces::pieces(&ground);
    debug_assert_eq!(pieces.check(), Ok(()));
    limit(ground.slabs.len() + pieces.point_triangle.len())?;
    limit(pieces.corners.items.len())?;
    run.stage("points", 0.25)?;
    let planes = lattice.planes();
    let mut points = points::points(&ground, &pieces, &planes);
    run.stage("touched", 0.4)?;
    let slabs = AllSlabs { ground: &ground, pieces: &pieces };
    let mut touched = Touched::new(&lattice, slabs.each());
    let (knife_count, edges_on) = (ground.knives.len(), &ground.classified.edges_on);
    let contents = squares::Contents {
        chords: Csr::from_positions(knife_count, pieces.chords.len(), |range| {
            pieces.chords[range].iter().map(|&(k, c)| (k.at(), c))
        }),
        edges: Csr::from_positions(knife_count, edges_on.len(), |range| {
            edges_on[range].iter().map(|&(e, k)| (k.at(), e))
        }),
        vertices: vertices_on(knife_count, &ground.classified.vertex_knives),
    };
    pieces.chords = Vec::new();
    run.stage("lines", 0.45)?;
    let sub = inner_points(&ground, &pieces);
    let vertex_edges = OnceLock::new();
    let surface_ground = surface::Ground {
        mesh: &mesh,
        knives: &ground.knives,
        classified: &ground.classified,
        points: &ground.points,
        sub: &sub,
        numbering: Numbering {
            first_edge_point: ground.first_edge_point(),
            first_inner_point: ground.first_inner_point(),
            first_chord_piece: (mesh.edges.len() + ground.points.edge.len()) as u32,
        },
        input_planes: &planes,
        vertex_edges: &vertex_edges,
    };
    let known = || match options.known {
        Some((_, inside)) => Ok(inside),
        None => {
            let first: [f64; 3] = std::array::from_fn(|a| lattice.nodes[a][0]);
            let bvh = build_bvh(&given.vertices, &given.triangles);
            Ok((locate(given, &bvh, &first) == Place::Inside) != options.outside)
        }
    };
    let slabs = AllSlabs { ground: &ground, pieces: &pieces };
    let lines = lines::lines(&surface_ground.with(&points.origins, &points.coords), slabs, &touched, &known)?;
    debug_assert_eq!(lines.check(), Ok(()));
    limit(points.origins.len() + lines.nodes.len())?;
    run.stage("faces", 0.55)?;
    let surface_count = points.origins.len();
    points.add_nodes(&lattice, &lines.nodes);
    let surface = surface_ground.with(&points.origins[..surface_count], &points.coords[..surface_count]);
    let all = AllVertices { surface: &surface, origins: &points.origins, coords: &points.coords };
    let scene = squares::Scene { all: &all, slabs, lines: &lines, touched: &touched, contents: &contents };
    let squares = squares::squares(&scene)?;
    debug_assert_eq!(squares.check(), Ok(()));
    limit(pieces.corners.items.len() + squares.loops.items.len())?;
    // What is no longer read goes before the largest arrays are made.
    let kinds = [ground.first_edge_point(), ground.first_inner_point(), lines.first_node].map(|v| v as usize);
    let inside = lines.inside;
    touched.forget_lines();
    (pieces.point_triangle, pieces.point_slabs, pieces.point_pair) = Default::default();
    drop((contents, sub, ground, lines.hits, lines.needed, lines.ranks, lines.nodes));
    run.stage("cells", 0.75)?;
    let of_box = cells::by_box(&lattice, &pieces, &squares, &touched);
    pieces.in_box = Vec::new();
    let faces = cells::Faces {
        mesh: &mesh,
        lattice: &lattice,
        planes: &planes,
        points: &points,
        pieces: &pieces,
        squares: &squares,
        touched: &touched,
        of_box,
    };
    let cells = cells::cells(&faces)?;
    debug_assert_eq!(cells.check(), Ok(()));
    drop(faces);
    run.stage("assemble", 0.9)?;
    let grid =
        assemble::assemble(assemble::Found { mesh, lattice, kinds, inside, pieces, points, squares, touched, cells });
    run.end_stage();
    Ok(grid)
}

/// Ids are 32-bit, and half-faces take one bit of them.
fn limit(count: usize) -> Result<()> {
    if count < (i32::MAX / 2) as usize {
        return Ok(());
    }
    Err(Error::new(Status::TooLarge, format!("{count} elements are more than 32-bit ids can number")))
}

/// The points inside triangles as the stages of `cut` know them.
fn inner_points(ground: &Ground, pieces: &Pieces) -> Subdivision {
    let mut sub = Subdivision { point_triangle: pieces.point_triangle.clone(), ..Default::default() };
    for s in &pieces.point_slabs {
        let mut set = [KnifeId::default(); 3];
        let mut count = 0;
        for a in (0..3).filter(|&a| on_plane(s[a])) {
            set[count] = ground.knife(a, s[a] / 2);
            count += 1;
        }
        set[..count].sort_unstable();
        sub.point_knives.push_row(&set[..count]);
    }
    sub
}

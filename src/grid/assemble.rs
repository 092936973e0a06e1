//! Stage: everything into one set of arrays. Vertices that no face uses go; the order stays: mesh vertices, points on mesh edges, points in
//! triangles, nodes.

use super::cells::Cells;
use super::data::{CUT, EMPTY, FULL, GridCells, Origins};
use super::lattice::Lattice;
use super::pieces::Pieces;
use super::points::Points;
use super::squares::Squares;
use super::touched::{Bits, Touched};
use crate::base::{CellId, VertexId};
use crate::mesh::TriMesh;
use std::sync::Arc;

/// A byte per box.
fn flags(lattice: &Lattice, touched: &Touched, inside: &Bits, cells: &Cells) -> Vec<u8> {
    let (nx, ny) = (lattice.count(0), lattice.count(1));
    let mut flags = vec![EMPTY; lattice.box_count()];
    for (r, row) in flags.chunks_exact_mut(nx).enumerate() {
        let (j, k) = (r % ny, r / ny);
        // The lowest node tells of a box that the surface does not touch.
        let (nodes, boxes) = (inside.row(j, k), touched.along[0].row(j, k));
        for (w, chunk) in row.chunks_mut(64).enumerate() {
            let full = nodes[w] & !boxes[w];
            if full == !0 {
                chunk.fill(FULL);
            } else if full != 0 {
                Bits::each(&[full], |i| {
                    if let Some(flag) = chunk.get_mut(i) {
                        *flag = FULL;
                    }
                });
            }
        }
    }
    for (b, w) in touched.boxes.iter().zip(cells.box_cells.windows(2)) {
        if w[0] < w[1] {
            flags[b.at()] = CUT;
        }
    }
    flags
}

/// The vertices that faces use: new numbers for old ones, and how many of each kind there are.
struct Numbering {
    number: Vec<VertexId>,
    ends: [usize; 3],
}

fn renumber(pieces: &Pieces, squares: &Squares, starts: [usize; 3], total: usize) -> Numbering {
    let mut number = vec![VertexId::NONE; total];
    for v in pieces.corners.items.iter().chain(&squares.loops.items) {
        number[v.at()] = VertexId(0);
    }
    let mut count = 0;
    let mut ends = [0; 3];
    for (v, n) in number.iter_mut().enumerate() {
        (0..3).filter(|&i| starts[i] == v).for_each(|i| ends[i] = count as usize);
        if n.is_some() {
            *n = VertexId(count);
            count += 1;
        }
    }
    (0..3).filter(|&i| starts[i] == total).for_each(|i| ends[i] = count as usize);
    Numbering { number, ends }
}

/// Keeps the items of used vertices.
fn keep<T: Copy>(items: &mut Vec<T>, number: &[VertexId]) {
    let mut to = 0;
    for from in 0..items.len() {
        if number[from].is_some() {
            items[to] = items[from];
            to += 1;
        }
    }
    items.truncate(to);
    items.shrink_to_fit();
}

/// What the stages found.
pub struct Found {
    pub mesh: Arc<TriMesh>,
    pub lattice: Lattice,
    /// The first point on a mesh edge, the first in a triangle, the first node.
    pub kinds: [usize; 3],
    /// Nodes in the fluid.
    pub inside: Bits,
    pub pieces: Pieces,
    pub points: Points,
    pub squares: Squares,
    pub touched: Touched,
    pub cells: Cells,
}

pub fn assemble(found: Found) -> GridCells {
    let Found { mesh, lattice, kinds, inside, pieces, mut points, mut squares, touched, cells } = found;
    let numbering = renumber(&pieces, &squares, kinds, points.origins.len());
    let number = &numbering.number;
    keep(&mut points.on_planes, number);
    let used = points.origins.iter().zip(number).filter(|(_, n)| n.is_some()).map(|(o, _)| *o);
    let origins = Origins::new(&lattice, used);
    points.origins = Vec::new();
    keep(&mut points.coords, number);
    keep(&mut points.residuals, &number[kinds[0]..kinds[2]]);
    let walls = pieces.triangle.len();
    let mut grid = GridCells {
        planes: lattice.planes(),
        on_planes: points.on_planes,
        constructed: numbering.ends[0] as u32..numbering.ends[2] as u32,
        residuals: points.residuals,
        extent: points.extent,
        origins,
        coords: points.coords,
        wall_triangle: pieces.triangle,
        wall_cell: vec![CellId::NONE; walls],
        plane_faces: squares.axis_faces.map(|f| f + walls as u32),
        ..Default::default()
    };
    grid.corners = pieces.corners.items;
    let first_corner = grid.corners.len() as u32;
    grid.corners.reserve_exact(squares.loops.items.len());
    grid.corners.append(&mut squares.loops.items);
    grid.corners.iter_mut().for_each(|v| *v = number[v.at()]);
    grid.loop_offsets = pieces.corners.offsets;
    grid.loop_offsets.reserve_exact(squares.loops.len());
    grid.loop_offsets.extend(squares.loops.offsets[1..].iter().map(|o| o + first_corner));
    grid.face_loops.reserve_exact(walls + squares.face_loops.len());
    grid.face_loops.extend(0..=walls as u32);
    grid.face_loops.extend(squares.face_loops[1..].iter().map(|l| l + walls as u32));
    drop(numbering);
    grid.flags = flags(&lattice, &touched, &inside, &cells);
    // Sides that are touched boxes become cells below.
    grid.square_cells = squares.sides;
    grid.square_node = squares.node;
    grid.box_cells.push(0);
    for (&b, w) in touched.boxes.iter().zip(cells.box_cells.windows(2)) {
        if w[0] < w[1] {
            grid.cut_boxes.push(b);
            grid.box_cells.push(w[1]);
        }
    }
    grid.cell_shells = cells.cell_shells;
    grid.shell_faces = cells.shell_faces;
    for c in 0..grid.cell_shells.len() - 1 {
        let (a, b) = (grid.cell_shells[c] as usize, grid.cell_shells[c + 1] as usize);
        let range = grid.shell_faces.offsets[a] as usize..grid.shell_faces.offsets[b] as usize;
        for h in &grid.shell_faces.items[range] {
            match h.face().at().checked_sub(walls) {
                None => grid.wall_cell[h.face().at()] = CellId::of(c),
                Some(i) => grid.square_cells[i][h.front() as usize] = CellId::of(c),
            }
        }
    }
    grid.mesh = mesh;
    grid.lattice = lattice;
    grid
}

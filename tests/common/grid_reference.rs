//! What cutting a grid must give, made from the general cut by the grid's planes: slow, and sharing nothing with the grid
//! engine but the data. Full boxes are found by their cells' vertices; cells outside the grid are dropped.
#![allow(dead_code)]

use lapidary::base::{BoxId, CellId, Csr, FaceId, NodeId, PlaneId, Run, VertexId};
use lapidary::complex::{Complex, HalfFace, Origin, SupportId};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::{rational, round_rational};
use lapidary::grid::{CUT, EMPTY, FULL, FULL_CELL, GridCells, Lattice, Origins};
use lapidary::mesh::TriMesh;
use rug::Rational;
use std::sync::Arc;

use super::common::{Soup, build_soup, cuboid, flipped, merging, together};

/// The grid's cells, and where they come from in the general cut.
pub struct Reference {
    pub grid: GridCells,
    pub complex: Complex,
    /// The complex' cell of each cell, and the complex' face of each face.
    pub cells: Vec<CellId>,
    pub faces: Vec<FaceId>,
    /// The complex' cell of each full box, by rising box.
    pub full: Vec<(BoxId, CellId)>,
}

/// Whole grids, fluid inside the mesh.
pub fn inside(soup: &Soup, nodes: [&[f64]; 3]) -> Reference {
    let mesh = build_soup(soup, merging()).expect("a valid mesh");
    reference(Arc::new(mesh), whole(nodes))
}

pub fn whole(nodes: [&[f64]; 3]) -> Lattice {
    Lattice::new(nodes, [0; 3], nodes.map(|n| n.len() as i64 - 1)).expect("a grid")
}

/// The fluid is outside the mesh: a box around the grid, with the bodies as voids.
pub fn outside(soup: &Soup, nodes: [&[f64]; 3]) -> Reference {
    let mut low = nodes.map(|n| n[0]);
    let mut high = nodes.map(|n| n[n.len() - 1]);
    for x in &soup.vertices {
        for i in 0..3 {
            low[i] = low[i].min(x[i]);
            high[i] = high[i].max(x[i]);
        }
    }
    let around = cuboid(low.map(|x| x - 1.0), high.map(|x| x + 1.0));
    inside(&together(&[flipped(soup.clone()), around]), nodes)
}

pub fn reference(mesh: Arc<TriMesh>, lattice: Lattice) -> Reference {
    let planes = lattice.planes();
    let c = cut(&mesh, &planes, &CutOptions::default(), &mut Run::quiet()).expect("a cut").complex;
    let exact: Vec<[Rational; 3]> = (0..c.vertex_count()).map(|v| rational(&c.point(VertexId::of(v)))).collect();
    let boxes: Vec<Option<[usize; 3]>> = (0..c.cell_count()).map(|k| box_of(&c, &exact, &lattice, k)).collect();

    // Boxes and their cells.
    let mut by_box: Vec<Vec<CellId>> = vec![Vec::new(); lattice.box_count()];
    for (k, b) in boxes.iter().enumerate() {
        if let Some(b) = b {
            by_box[lattice.box_id(*b).at()].push(CellId::of(k));
        }
    }
    let is_full = |cells: &[CellId]| {
        let [k] = cells else { return false };
        c.cell_faces(*k).iter().all(|h| {
            matches!(c.face_support[h.face().at()], SupportId::Plane(_))
                && c.face_corners(h.face()).all(|i| {
                    let v = c.corner_vertices[i];
                    matches!(c.origins[v.at()], Origin::Planes(..))
                })
        })
    };
    let mut g = GridCells { mesh: mesh.clone(), planes, ..Default::default() };
    g.extent = mesh.bbox.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    g.box_cells.push(0);
    let mut full = Vec::new();
    let mut cells: Vec<CellId> = Vec::new();
    let mut number = vec![CellId::NONE; c.cell_count()];
    for (b, members) in by_box.iter().enumerate() {
        let flag = match members.len() {
            0 => EMPTY,
            _ if is_full(members) => FULL,
            _ => CUT,
        };
        g.flags.push(flag);
        if flag == FULL {
            number[members[0].at()] = FULL_CELL;
            full.push((BoxId::of(b), members[0]));
        }
        if flag == CUT {
            for &k in members {
                number[k.at()] = CellId::of(cells.len());
                cells.push(k);
            }
            g.cut_boxes.push(BoxId::of(b));
            g.box_cells.push(cells.len() as u32);
        }
    }

    // Faces: walls by triangle, then by axis, plane and square.
    let at = |k: CellId| if k.is_some() { boxes[k.at()] } else { None };
    let name = |k: CellId| if k.is_some() { number[k.at()] } else { CellId::NONE };
    let is_cell = |k: CellId| k.is_some() && k != FULL_CELL;
    let mut faces: Vec<((usize, u32, u32), FaceId)> = Vec::new();
    for f in (0..c.face_count()).map(FaceId::of) {
        let [owner, neighbour] = c.face_cells[f.at()];
        match c.face_support[f.at()] {
            SupportId::Triangle(t) if is_cell(name(owner)) => faces.push(((0, t.0, f.0), f)),
            SupportId::Plane(p) if is_cell(name(owner)) || is_cell(name(neighbour)) => {
                faces.push(((1, p.0, square(&lattice, p, at(owner), at(neighbour)).0), f));
            }
            _ => {}
        }
    }
    faces.sort();
    let faces: Vec<FaceId> = faces.into_iter().map(|(_, f)| f).collect();
    let mut face_number = vec![FaceId::NONE; c.face_count()];
    faces.iter().enumerate().for_each(|(i, f)| face_number[f.at()] = FaceId::of(i));

    // Vertices: of the mesh, constructed, nodes.
    let mut used = vec![false; c.vertex_count()];
    faces.iter().for_each(|&f| c.face_corners(f).for_each(|i| used[c.corner_vertices[i].at()] = true));
    let kind = |v: usize| match c.origins[v] {
        Origin::Mesh(_) => 0,
        Origin::Edge(..) | Origin::Triangle(..) => 1,
        Origin::Planes(..) => 2,
        other => unreachable!("a grid's vertex {other:?}"),
    };
    let mut order: Vec<usize> = (0..c.vertex_count()).filter(|&v| used[v]).collect();
    order.sort_by_key(|&v| (kind(v), v));
    let mut vertex_number = vec![VertexId::NONE; c.vertex_count()];
    let before = |k: usize| order.iter().filter(|&&v| kind(v) < k).count() as u32;
    g.constructed = before(1)..before(2);
    g.origins = Origins::new(&lattice, order.iter().map(|&v| c.origins[v]));
    for (i, &v) in order.iter().enumerate() {
        vertex_number[v] = VertexId::of(i);
        g.coords.push(c.coords[v]);
        g.on_planes.push(c.vertex_planes.row(v).iter().fold(0, |m, &p| m | 1 << lattice.plane_at(p).0));
        if kind(v) == 1 {
            g.residuals.push(std::array::from_fn(|a| {
                round_rational(&(&exact[v][a] - Rational::from_f64(c.coords[v][a]).unwrap()))
            }));
        }
    }

    g.face_loops.push(0);
    g.loop_offsets.push(0);
    for &f in &faces {
        for l in c.loops_of(f) {
            g.corners.extend(c.corners_of(l).map(|i| vertex_number[c.corner_vertices[i].at()]));
            g.loop_offsets.push(g.corners.len() as u32);
        }
        g.face_loops.push(g.loop_offsets.len() as u32 - 1);
        let [owner, neighbour] = c.face_cells[f.at()];
        match c.face_support[f.at()] {
            SupportId::Triangle(t) => {
                g.wall_triangle.push(t);
                g.wall_cell.push(name(owner));
            }
            SupportId::Plane(p) => {
                g.square_node.push(square(&lattice, p, at(owner), at(neighbour)));
                g.square_cells.push([name(owner), name(neighbour)]);
            }
            SupportId::Level(_) => unreachable!("a level in a cut by planes"),
        }
    }
    let first = g.wall_triangle.len();
    let axis_of = |f: FaceId| match c.face_support[f.at()] {
        SupportId::Plane(p) => lattice.plane_at(p).0,
        SupportId::Triangle(_) | SupportId::Level(_) => unreachable!("a wall among plane faces"),
    };
    let end = |a: usize| (first + faces[first..].iter().filter(|f| axis_of(**f) < a).count()) as u32;
    g.plane_faces = [end(0), end(1), end(2), end(3)];

    g.cell_shells.push(0);
    g.shell_faces = Csr::default();
    for &k in &cells {
        for s in c.cell_shells[k.at()]..c.cell_shells[k.at() + 1] {
            let row = c.shell_faces.row(s as usize).iter();
            let mut row: Vec<HalfFace> = row.map(|h| HalfFace::new(face_number[h.face().at()], h.front())).collect();
            row.sort();
            g.shell_faces.push_row(&row);
        }
        g.cell_shells.push(g.shell_faces.len() as u32);
    }
    g.lattice = lattice;
    Reference { grid: g, complex: c, cells, faces, full }
}

/// The box that holds a cell, if it is one of the grid's.
fn box_of(c: &Complex, exact: &[[Rational; 3]], lattice: &Lattice, k: usize) -> Option<[usize; 3]> {
    let mut at = [0; 3];
    for a in 0..3 {
        let values = c.cell_faces(CellId::of(k)).iter().flat_map(|h| c.face_corners(h.face()));
        let values = values.map(|i| &exact[c.corner_vertices[i].at()][a]);
        let low = values.clone().min().expect("a cell has corners");
        let nodes = &lattice.nodes[a];
        let below = nodes.partition_point(|x| Rational::from_f64(*x).unwrap() <= *low);
        if below == 0 || below == nodes.len() {
            return None;
        }
        assert!(*values.max().unwrap() <= Rational::from_f64(nodes[below]).unwrap(), "cell {k} leaves its box");
        at[a] = below - 1;
    }
    Some(at)
}

/// The lowest node of the square of a plane between two cells' boxes.
fn square(lattice: &Lattice, p: PlaneId, below: Option<[usize; 3]>, above: Option<[usize; 3]>) -> NodeId {
    let (axis, node) = lattice.plane_at(p);
    let mut at = below.or(above).expect("a face of a cell");
    at[axis] = node;
    lattice.node_id(at)
}

//! Stage: the half-faces of each touched box, joined into shells and cells.
//!
//! A half-face's box is known: a wall's from its piece, a plane face's two from its square. So cells never reach beyond a box, and
//! shells are found box by box: half-faces that share an edge belong together where they bound one wedge of fluid. At nearly every edge a
//! box has two half-faces, and they do. Where it has more (solids that touch along an edge), the faces are sorted around it.
//! An edge is the straight segment between two vertices, hence their pair.
//!
//! A shell with a face in a grid plane is the outer one of a cell. A shell without is a whole, uncut shell of the surface: its volume tells
//! whether it encloses fluid (a cell of its own) or is a void's wall, which `voids` then hangs into its cell.
//!
//! Invariant: each half-face is in one shell, each edge of a shell is walked once each way. Cost: linear; a small table of a box's edges,
//! reused, instead of numbered edges for the whole complex (those would cost more memory than all that is kept).

use super::data::FULL_CELL;
use super::lattice::Lattice;
use super::pieces::Pieces;
use super::points::Points;
use super::squares::Squares;
use super::touched::Touched;
use super::voids;
use crate::base::{Csr, Error, FaceId, Result, TriangleId, VertexId, parallel};
use crate::complex::data::origin_point;
use crate::complex::{HalfFace, SupportId, radial};
use crate::exact::{self, Direction, Plane, Point, Sign};
use crate::mesh::TriMesh;
use crate::mesh::volume::volume_signs;
use std::cmp::Ordering;

/// The cells of all touched boxes, in order.
#[derive(Debug, Default)]
pub struct Cells {
    /// Per touched box: its cells.
    pub box_cells: Vec<u32>,
    pub cell_shells: Vec<u32>,
    pub shell_faces: Csr<HalfFace>,
}

/// What the search for shells reads.
pub struct Faces<'a> {
    pub mesh: &'a TriMesh,
    pub lattice: &'a Lattice,
    pub planes: &'a [Plane],
    pub points: &'a Points,
    pub pieces: &'a Pieces,
    pub squares: &'a Squares,
    pub touched: &'a Touched,
    /// The half-faces of each touched box, rising.
    pub of_box: Csr<HalfFace>,
}

impl Faces<'_> {
    pub fn point(&self, v: VertexId) -> Point {
        origin_point(self.mesh, self.planes, self.points.origins[v.at()])
    }
    /// Orders two vertices by a coordinate.
    pub fn compare_coordinate(&self, a: VertexId, b: VertexId, axis: usize) -> Ordering {
        let (x, y) = (self.points.coords[a.at()][axis], self.points.coords[b.at()][axis]);
        exact::compare_rounded(x, y, || self.point(a), || self.point(b), axis)
    }
    pub fn walls(&self) -> u32 {
        self.pieces.triangle.len() as u32
    }
    /// The triangle of a wall, or the axis of a face in a grid plane.
    pub fn support(&self, f: FaceId) -> std::result::Result<TriangleId, usize> {
        match f.0.checked_sub(self.walls()) {
            None => Ok(self.pieces.triangle[f.at()]),
            Some(i) => Err((i >= self.squares.axis_faces[1]) as usize + (i >= self.squares.axis_faces[2]) as usize),
        }
    }
    /// Calls `visit` with each loop of a face.
    #[inline]
    pub fn each_loop(&self, f: FaceId, mut visit: impl FnMut(&[VertexId])) {
        match f.0.checked_sub(self.walls()) {
            None => visit(self.pieces.corners.row(f)),
            Some(i) => {
                let i = i as usize;
                for l in self.squares.face_loops[i]..self.squares.face_loops[i + 1] {
                    visit(self.squares.loops.row(l as usize));
                }
            }
        }
    }
}

/// Sorts the half-faces by touched box.
pub fn by_box(lattice: &Lattice, pieces: &Pieces, squares: &Squares, touched: &Touched) -> Csr<HalfFace> {
    let walls = pieces.triangle.len();
    // Once, since positions are walked twice.
    let ranks: Vec<u32> = pieces.in_box.iter().map(|&b| touched.rank(lattice.box_at(b)) as u32).collect();
    Csr::from_positions(touched.boxes.len(), walls + squares.sides.len(), |range| {
        range.map(FaceId::of).flat_map(|face| {
            let sides = match ranks.get(face.at()) {
                Some(&b) => [Some(b as usize), None],
                None => squares.sides[face.at() - walls].map(|side| (side < FULL_CELL).then(|| side.at())),
            };
            let half_face = move |(front, side): (usize, Option<usize>)| Some((side?, HalfFace::new(face, front == 1)));
            sides.into_iter().enumerate().filter_map(half_face)
        })
    })
}

const BOXES: usize = 4096;

pub fn cells(faces: &Faces) -> Result<Cells> {
    let count = faces.touched.boxes.len();
    let parts: Vec<Result<Cells>> = parallel::map_ranges(count, BOXES, |range| {
        let mut out = Cells { box_cells: vec![0], cell_shells: vec![0], ..Default::default() };
        let mut scratch = Scratch::default();
        for b in range {
            scratch.cells_of_box(faces, b, &mut out)?;
            out.box_cells.push(out.cell_shells.len() as u32 - 1);
        }
        Ok(out)
    });
    if parts.len() == 1 {
        return parts.into_iter().next().expect("one part");
    }
    let mut all = Cells { box_cells: vec![0], cell_shells: vec![0], ..Default::default() };
    all.shell_faces.items.reserve_exact(faces.of_box.items.len());
    for part in parts {
        let part = part?;
        let (cells, shells) = (all.cell_shells.len() as u32 - 1, all.shell_faces.len() as u32);
        let items = all.shell_faces.items.len() as u32;
        all.box_cells.extend(part.box_cells[1..].iter().map(|c| c + cells));
        all.cell_shells.extend(part.cell_shells[1..].iter().map(|s| s + shells));
        all.shell_faces.offsets.extend(part.shell_faces.offsets[1..].iter().map(|o| o + items));
        all.shell_faces.items.extend(part.shell_faces.items);
    }
    Ok(all)
}

/// An edge of a box, in the table: its ends, the first half-face at it, how many there are, and in which round the slot was taken: slots of
/// earlier rounds are free.
#[derive(Clone, Copy, Default)]
struct Slot {
    ends: u64,
    first: u32,
    count: u16,
    round: u16,
}

#[derive(Default)]
struct Scratch {
    table: Vec<Slot>,
    round: u16,
    parent: Vec<u32>,
    /// Edges with more than two half-faces.
    crowded: Vec<u64>,
    uses: Vec<Use>,
    order: Vec<u32>,
    /// Shell of each half-face of the box; lowest half-face of each shell; whether a shell has a face in a grid plane.
    shell: Vec<u32>,
    open: Vec<bool>,
    /// The cell's outer shell of each shell.
    outer: Vec<u32>,
}

/// A use of an edge: by which half-face of the box, and whether its face walks it from its lower vertex.
#[derive(Clone, Copy, Debug)]
struct Use {
    half_face: HalfFace,
    local: u32,
    forward: bool,
}

#[inline(always)]
fn key(a: VertexId, b: VertexId) -> u64 {
    let (low, high) = if a < b { (a.0, b.0) } else { (b.0, a.0) };
    (low as u64) << 32 | high as u64
}

fn find(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

fn union(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parent, a), find(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}

impl Scratch {
    fn cells_of_box(&mut self, faces: &Faces, b: usize, out: &mut Cells) -> Result<()> {
        let half_faces = faces.of_box.row(b);
        if half_faces.is_empty() {
            return Ok(());
        }
        self.join(faces, half_faces)?;
        let mut shells = 0;
        self.shell.clear();
        self.open.clear();
        for (i, h) in half_faces.iter().enumerate() {
            let root = find(&mut self.parent, i as u32) as usize;
            let shell = if root == i {
                shells += 1;
                self.open.push(false);
                shells - 1
            } else {
                self.shell[root]
            };
            self.shell.push(shell);
            self.open[shell as usize] |= h.face().0 >= faces.walls();
        }
        self.outer.clear();
        self.outer.extend(0..shells);
        if self.open.contains(&false) {
            self.hang_voids(faces, b)?;
        }
        for outer in 0..shells {
            if self.outer[outer as usize] != outer {
                continue;
            }
            let mut write = |shell: u32| {
                let own = half_faces.iter().zip(&self.shell).filter(|(_, s)| **s == shell).map(|(h, _)| *h);
                out.shell_faces.items.extend(own);
                out.shell_faces.end_row();
            };
            write(outer);
            (0..shells).filter(|&s| s != outer && self.outer[s as usize] == outer).for_each(write);
            out.cell_shells.push(out.shell_faces.len() as u32);
        }
        Ok(())
    }

    /// Joins half-faces across the edges of a box.
    fn join(&mut self, faces: &Faces, half_faces: &[HalfFace]) -> Result<()> {
        let mut corners = 0;
        for h in half_faces {
            faces.each_loop(h.face(), |row| corners += row.len());
        }
        let size = (2 * corners).next_power_of_two().max(self.table.len());
        if size > self.table.len() || self.round == u16::MAX {
            self.table.clear();
            self.table.resize(size, Slot::default());
            self.round = 0;
        }
        self.round += 1;
        let shift = 64 - size.trailing_zeros();
        let mut odd = 0;
        self.parent.clear();
        self.parent.extend(0..half_faces.len() as u32);
        self.crowded.clear();
        let Scratch { table, round, parent, crowded, .. } = self;
        for (i, h) in half_faces.iter().enumerate() {
            faces.each_loop(h.face(), |row| {
                if row.len() < 2 {
                    return;
                }
                let mut from = row[row.len() - 1];
                for &to in row {
                    let ends = key(from, to);
                    from = to;
                    let mut at = (ends.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> shift) as usize;
                    loop {
                        let slot = &mut table[at];
                        if slot.round != *round {
                            *slot = Slot { ends, first: i as u32, count: 1, round: *round };
                            odd += 1;
                            break;
                        }
                        if slot.ends == ends {
                            slot.count = slot.count.saturating_add(1);
                            odd = if slot.count & 1 == 0 { odd - 1 } else { odd + 1 };
                            match slot.count {
                                2 => union(parent, slot.first, i as u32),
                                3 => crowded.push(ends),
                                _ => {}
                            }
                            break;
                        }
                        at = (at + 1) & (size - 1);
                    }
                }
            });
        }
        if odd != 0 {
            let open = table.iter().filter(|slot| slot.round == *round && slot.count & 1 != 0);
            return Err(contradiction(faces, open.map(|slot| slot.ends).min().unwrap_or(0)));
        }
        if !self.crowded.is_empty() {
            self.join_crowded(faces, half_faces)?;
        }
        Ok(())
    }

    /// Joins anew where an edge has more than two half-faces: two of them alone would have been joined too early.
    fn join_crowded(&mut self, faces: &Faces, half_faces: &[HalfFace]) -> Result<()> {
        self.crowded.sort_unstable();
        self.parent.clear();
        self.parent.extend(0..half_faces.len() as u32);
        let mut all: Vec<(u64, Use)> = Vec::new();
        for (i, &half_face) in half_faces.iter().enumerate() {
            faces.each_loop(half_face.face(), |row| {
                if row.len() < 2 {
                    return;
                }
                let mut from = row[row.len() - 1];
                for &to in row {
                    all.push((key(from, to), Use { half_face, local: i as u32, forward: from < to }));
                    from = to;
                }
            });
        }
        all.sort_by_key(|u| u.0);
        for run in all.chunk_by(|a, b| a.0 == b.0) {
            if let [a, b] = run {
                union(&mut self.parent, a.1.local, b.1.local);
                continue;
            }
            self.uses.clear();
            self.uses.extend(run.iter().map(|u| u.1));
            self.join_around(faces, run[0].0)?;
        }
        Ok(())
    }

    fn join_around(&mut self, faces: &Faces, ends: u64) -> Result<()> {
        let [a, b] = [VertexId((ends >> 32) as u32), VertexId(ends as u32)];
        let (x, y) = (&faces.points.coords[a.at()], &faces.points.coords[b.at()]);
        let best = (0..3).max_by(|&i, &j| (x[i] - y[i]).abs().total_cmp(&(x[j] - y[j]).abs())).unwrap();
        let axis = [best, (best + 1) % 3, (best + 2) % 3].into_iter().find_map(|axis| {
            match faces.compare_coordinate(a, b, axis) {
                Ordering::Equal => None,
                order => Some((axis, order == Ordering::Less)),
            }
        });
        let Some((axis, along)) = axis else { return Err(contradiction(faces, ends)) };
        let Scratch { uses, order, parent, .. } = self;
        order.clear();
        order.extend(0..uses.len() as u32);
        let support = |i: u32| match faces.support(uses[i as usize].half_face.face()) {
            Ok(t) => SupportId::Triangle(t),
            Err(axis) => SupportId::Plane(crate::base::PlaneId::of(axis)),
        };
        let normal = |i: u32| match faces.support(uses[i as usize].half_face.face()) {
            Ok(t) => Direction::Triangle(faces.mesh.corners(t)),
            Err(axis) => Direction::Plane(std::array::from_fn(|k| (k == axis) as u8 as f64)),
        };
        let same = |i: u32, j: u32| uses[i as usize].forward == uses[j as usize].forward;
        radial::sort_around(order, axis, along, support, normal, same);
        for (k, &i) in order.iter().enumerate() {
            let j = order[if k + 1 == order.len() { 0 } else { k + 1 }];
            let (from, to) = (uses[i as usize], uses[j as usize]);
            // Counter-clockwise of a face is its front if it walks the edge forward, clockwise its back.
            match (from.half_face.front() == from.forward, to.half_face.front() != to.forward) {
                (true, true) => union(parent, from.local, to.local),
                (false, false) => {}
                _ => return Err(contradiction(faces, ends)),
            }
        }
        Ok(())
    }

    /// Islands are cells; walls of voids are hung into the cell around them.
    fn hang_voids(&mut self, faces: &Faces, b: usize) -> Result<()> {
        let half_faces = faces.of_box.row(b);
        let count = self.open.len();
        let walls: Vec<TriangleId> = half_faces.iter().filter_map(|h| faces.support(h.face()).ok()).collect();
        // Walls come first among the half-faces of a box.
        let shell_of: Vec<u32> =
            self.shell[..walls.len()].iter().map(|&s| if self.open[s as usize] { u32::MAX } else { s }).collect();
        let triangles: Vec<[VertexId; 3]> = walls.iter().map(|t| faces.mesh.triangles[t.at()]).collect();
        let signs = volume_signs(&faces.mesh.vertices, &triangles, &shell_of, count);
        let is_void: Vec<bool> = (0..count).map(|s| !self.open[s] && signs[s] != Sign::Positive).collect();
        if !is_void.contains(&true) {
            return Ok(());
        }
        let scene = voids::Box { faces, number: b, shell: &self.shell, triangles: &triangles, walls: &walls };
        self.outer = voids::hang(&scene, &is_void)?;
        Ok(())
    }
}

fn contradiction(faces: &Faces, ends: u64) -> Error {
    let x = faces.points.coords[(ends >> 32) as usize];
    Error::inconsistent(format!(
        "faces around an edge at ({}, {}, {}) do not alternate between inside and outside: the surface intersects itself, or a \
         block lacks some of its triangles",
        x[0], x[1], x[2]
    ))
}

impl Cells {
    pub fn check(&self) -> std::result::Result<(), String> {
        self.shell_faces.check()?;
        if *self.cell_shells.last().unwrap() as usize != self.shell_faces.len()
            || *self.box_cells.last().unwrap() as usize + 1 != self.cell_shells.len()
        {
            return Err("cells do not match their shells and boxes".into());
        }
        Ok(())
    }
}

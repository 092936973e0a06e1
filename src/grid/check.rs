//! Is a `GridCells` what its fields say?

use super::data::{FULL_CELL, GridCells};
use crate::base::{CellId, FaceId, VertexId};
use crate::complex::Origin;

impl GridCells {
    /// What the data promises: offsets, ranges, flags that match the cells, cells that match their faces, squares in their planes, and that
    /// vertices are where their bits say. Cost: linear.
    pub fn check(&self) -> Result<(), String> {
        let ensure = |holds: bool, what: &str| if holds { Ok(()) } else { Err(what.to_string()) };
        let (walls, faces, cells) = (self.wall_count(), self.face_count(), self.cell_count());
        ensure(self.flags.len() == self.lattice.box_count(), "a flag per box")?;
        ensure(
            self.coords.len() == self.origins.len() && self.on_planes.len() == self.origins.len(),
            "a vertex's data",
        )?;
        ensure(self.residuals.len() == self.constructed.len(), "a residual per constructed vertex")?;
        ensure(self.wall_cell.len() == walls && self.plane_faces[0] as usize == walls, "walls come first")?;
        ensure(self.plane_faces[3] as usize == faces, "faces in planes end the faces")?;
        ensure(
            self.square_node.len() == faces - walls && self.square_cells.len() == faces - walls,
            "a square per face",
        )?;
        ensure(self.wall_triangle.is_sorted(), "walls by rising triangle")?;
        ensure(self.cut_boxes.windows(2).all(|w| w[0] < w[1]), "cut boxes rise")?;
        ensure(self.box_cells.len() == self.cut_boxes.len() + 1, "a range of cells per cut box")?;
        ensure(self.box_cells.windows(2).all(|w| w[0] < w[1]), "a cell in every cut box")?;
        ensure(self.box_cells.last().copied() == Some(cells as u32), "cut boxes hold all cells")?;
        let cut = self.flags.iter().enumerate().filter(|(_, f)| **f == super::CUT).map(|(b, _)| b as u32);
        ensure(cut.eq(self.cut_boxes.iter().map(|b| b.0)), "cut boxes have their flag")?;
        self.shell_faces.check()?;
        let mut box_of = vec![0u32; cells];
        for (b, w) in self.cut_boxes.iter().zip(self.box_cells.windows(2)) {
            box_of[w[0] as usize..w[1] as usize].fill(b.0);
        }
        let mut seen = vec![0u8; faces];
        for c in (0..cells).map(CellId::of) {
            for h in self.cell_faces(c) {
                seen[h.face().at()] |= 1 << h.front() as u8;
                let at = self.lattice.box_at(crate::base::BoxId(box_of[c.at()]));
                match h.face().at().checked_sub(walls) {
                    None => ensure(!h.front() && self.wall_cell[h.face().at()] == c, "a wall's cell")?,
                    Some(i) => {
                        let axis = self.face_axis(h.face());
                        let mut node = at;
                        node[axis] += !h.front() as usize;
                        ensure(self.square_cells[i][h.front() as usize] == c, "a square's cell")?;
                        ensure(
                            self.lattice.node_id(node) == self.square_node[i],
                            "a square is a side of its cell's box",
                        )?;
                    }
                }
            }
        }
        for (f, &seen) in seen.iter().enumerate() {
            let both = match f.checked_sub(walls) {
                None => 1,
                Some(i) => {
                    let is_cell = self.square_cells[i].map(|c| c.is_some() && c != FULL_CELL);
                    for (side, cell) in self.square_cells[i].iter().enumerate().filter(|(_, c)| **c == FULL_CELL) {
                        let axis = self.face_axis(FaceId::of(f));
                        let mut at = self.lattice.node_at(self.square_node[i]);
                        ensure(side == 1 || at[axis] > 0, "a full box beyond the block")?;
                        at[axis] -= (side == 0) as usize;
                        let flag = self.flags[self.lattice.box_id(at).at()];
                        ensure(*cell == FULL_CELL && flag == super::FULL, "a full neighbour has its flag")?;
                    }
                    is_cell[0] as u8 | (is_cell[1] as u8) << 1
                }
            };
            ensure(both != 0 && seen == both, "each half-face of a face is in its cell")?;
        }
        for v in (0..self.vertex_count()).map(VertexId::of) {
            for a in (0..3).filter(|a| self.on_planes[v.at()] >> a & 1 != 0) {
                ensure(
                    self.lattice.nodes[a].binary_search_by(|n| n.total_cmp(&self.coords[v.at()][a])).is_ok(),
                    "a vertex on a plane",
                )?;
            }
            if let Origin::Mesh(m) = self.origin(v) {
                ensure(self.coords[v.at()] == self.mesh.vertices[m.at()], "a mesh vertex's coordinates")?;
            }
        }
        Ok(())
    }
}

//! Many simplices in one call, with equally many functions each: their complexes behind one another in one set of flat arrays, whose
//! ids run through all of them.
//!
//! The result is that of one call for each simplex, in order, on any number of threads. Arrays keep their memory from
//! call to call. Cost: the constructions, and a copy of what they made.

use super::data::{Kind, LocalCell, LocalEdge, LocalFace, LocalFunction, LocalHalfFace, LocalPlane, LocalVertex};
use super::data::{Scratch, SimplexComplex};
use super::{Found, arrangement, check, find_table, interface};
use crate::base::{Csr, Error, Status, parallel};
use std::ops::Range;

/// Fewer simplices than this are not worth another thread.
const LEAST: usize = 256;

/// What is asked for.
#[derive(Clone, Copy)]
pub struct Order<'a> {
    pub kind: Kind,
    /// 3 or 2.
    pub dim: usize,
    pub simplices: usize,
    /// Of each simplex.
    pub functions: usize,
    /// `values[(simplex * functions + function) * (dim + 1) + corner]`, finite.
    pub values: &'a [f64],
}

impl Order<'_> {
    /// The values of some simplices.
    fn of(&self, range: Range<usize>) -> &[f64] {
        let each = self.functions * (self.dim + 1);
        &self.values[range.start * each..range.end * each]
    }

    /// Counts fit the values, all values are finite, and an interface has a material.
    pub fn validate(&self) -> Result<(), Error> {
        let bad = |message: String| Err(Error::new(Status::BadArgument, message));
        if self.kind == Kind::Interface && self.functions == 0 {
            return bad("an interface needs at least one material".into());
        }
        let count = self.simplices.checked_mul(self.functions).and_then(|n| n.checked_mul(self.dim + 1));
        if count != Some(self.values.len()) {
            return bad(format!("{} values do not fit the counts", self.values.len()));
        }
        if let Some(i) = self.values.iter().position(|x| !x.is_finite()) {
            let (corner, row) = (i % (self.dim + 1), i / (self.dim + 1));
            let (function, simplex) = (row % self.functions, row / self.functions);
            let x = self.values[i];
            return bad(format!("the value of function {function} at corner {corner} of simplex {simplex} is {x}"));
        }
        Ok(())
    }
}

/// The complexes, and where those of each simplex begin in them.
#[derive(Default)]
pub struct SimplexBatch {
    /// `functions`, `kind` and `dim` are those of every simplex; rows of `zero_functions` follow one another.
    pub all: SimplexComplex,
    /// One more than there are simplices.
    pub first_vertex: Vec<LocalVertex>,
    pub first_edge: Vec<LocalEdge>,
    pub first_face: Vec<LocalFace>,
    pub first_cell: Vec<LocalCell>,
    pub first_plane: Vec<LocalPlane>,
    /// Those of the order, for exact values.
    pub values: Vec<f64>,
    scratch: Scratch,
    one: SimplexComplex,
}

impl SimplexBatch {
    pub fn len(&self) -> usize {
        self.first_cell.len().saturating_sub(1)
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn clear(&mut self, order: &Order) {
        let all = &mut self.all;
        (all.kind, all.dim, all.functions) = (order.kind, order.dim, order.functions);
        all.vertex_carrier.clear();
        all.vertex_encoding.clear();
        clear(&mut all.vertex_functions);
        all.edges.clear();
        clear(&mut all.face_vertices);
        all.face_edges.clear();
        all.face_support.clear();
        all.face_plane.clear();
        all.face_cells.clear();
        clear(&mut all.plane_functions);
        all.plane_opposite.clear();
        clear(&mut all.cell_faces);
        all.cell_positive.clear();
        all.zero_functions.clear();
        all.cell_owner.clear();
        clear(&mut all.cell_materials);
        self.first_vertex.clear();
        self.first_edge.clear();
        self.first_face.clear();
        self.first_cell.clear();
        self.first_plane.clear();
        self.end_simplex();
        self.values.clear();
    }

    fn end_simplex(&mut self) {
        self.first_vertex.push(LocalVertex::of(self.all.vertex_count()));
        self.first_edge.push(LocalEdge::of(self.all.edge_count()));
        self.first_face.push(LocalFace::of(self.all.face_count()));
        self.first_cell.push(LocalCell::of(self.all.cell_count()));
        self.first_plane.push(LocalPlane::of(self.all.plane_functions.len()));
    }

    /// Replaces what is here. The order must be valid. After an error nothing is here.
    pub fn build(&mut self, order: &Order) -> Result<(), Error> {
        let ranges = parallel::ranges(order.simplices, LEAST);
        let made = match &ranges[..] {
            [whole] => self.build_range(order, whole.clone()),
            _ => self.build_parts(order),
        };
        match made {
            Ok(()) => self.values.extend_from_slice(order.values),
            Err(_) => self.clear(order),
        }
        made
    }

    fn build_parts(&mut self, order: &Order) -> Result<(), Error> {
        self.clear(order);
        let parts = parallel::map_ranges(order.simplices, LEAST, |range| {
            let mut part = SimplexBatch::default();
            part.build_range(order, range).map(|()| part)
        });
        for part in parts {
            let part = part?;
            let from = [self.all.vertex_count(), self.all.edge_count(), self.all.face_count(), self.all.cell_count()];
            let planes = self.all.plane_functions.len();
            append(&mut self.all, &part.all)?;
            self.first_vertex.extend(part.first_vertex[1..].iter().map(|v| LocalVertex::of(v.at() + from[0])));
            self.first_edge.extend(part.first_edge[1..].iter().map(|e| LocalEdge::of(e.at() + from[1])));
            self.first_face.extend(part.first_face[1..].iter().map(|f| LocalFace::of(f.at() + from[2])));
            self.first_cell.extend(part.first_cell[1..].iter().map(|c| LocalCell::of(c.at() + from[3])));
            self.first_plane.extend(part.first_plane[1..].iter().map(|p| LocalPlane::of(p.at() + planes)));
        }
        Ok(())
    }

    fn build_range(&mut self, order: &Order, range: Range<usize>) -> Result<(), Error> {
        self.clear(order);
        for simplex in range {
            let values = order.of(simplex..simplex + 1);
            match order.kind {
                Kind::Arrangement => arrangement(order.dim, values, &mut self.scratch, &mut self.one),
                Kind::Interface => interface(order.dim, values, &mut self.scratch, &mut self.one),
            }
            append(&mut self.all, &self.one)?;
            self.end_simplex();
        }
        Ok(())
    }

    /// Leaves nothing but memory.
    pub fn forget(&mut self) {
        let nothing = Order { kind: self.all.kind, dim: self.all.dim, simplices: 0, functions: 0, values: &[] };
        self.clear(&nothing);
    }

    /// The values of the functions of the simplex at a place of the list of simplices.
    fn values_of(&self, simplex: usize) -> &[f64] {
        let each = self.all.functions * (self.all.dim + 1);
        &self.values[simplex * each..(simplex + 1) * each]
    }
    /// Those of the simplex that a vertex belongs to.
    pub fn values_at_vertex(&self, v: LocalVertex) -> &[f64] {
        self.values_of(self.first_vertex.partition_point(|first| *first <= v) - 1)
    }
    /// Those of the simplex that a cell belongs to.
    pub fn values_at_cell(&self, c: LocalCell) -> &[f64] {
        self.values_of(self.first_cell.partition_point(|first| *first <= c) - 1)
    }

    /// What the look-up tables have for a simplex; `None` if its complex was constructed.
    pub fn found(&self, simplex: usize) -> Option<Found> {
        find_table(self.all.kind, self.all.dim, self.values_of(simplex))
    }

    /// IA: the sign of every function in every cell, cell by cell.
    pub fn signs(&self) -> Vec<i32> {
        let all = &self.all;
        let words = all.label_words();
        let mut signs = Vec::with_capacity(all.cell_count() * all.functions);
        for simplex in 0..self.len() {
            let zero = &all.zero_functions[simplex * words..(simplex + 1) * words];
            for c in (self.first_cell[simplex].at()..self.first_cell[simplex + 1].at()).map(LocalCell::of) {
                let positive = all.cell_label(c);
                signs.extend((0..all.functions).map(|f| {
                    let (word, bit) = (f / 64, f % 64);
                    if zero[word] >> bit & 1 != 0 { 0 } else { 2 * (positive[word] >> bit & 1) as i32 - 1 }
                }));
            }
        }
        signs
    }

    /// The complex of one simplex, with ids of its own. Cost: a copy.
    pub fn simplex(&self, i: usize) -> SimplexComplex {
        let all = &self.all;
        let vertices = self.first_vertex[i].at()..self.first_vertex[i + 1].at();
        let edges = self.first_edge[i].at()..self.first_edge[i + 1].at();
        let faces = self.first_face[i].at()..self.first_face[i + 1].at();
        let cells = self.first_cell[i].at()..self.first_cell[i + 1].at();
        let planes = self.first_plane[i].at()..self.first_plane[i + 1].at();
        let (vertex, edge) = (vertices.start as u32, edges.start as u32);
        let (face, cell, plane) = (faces.start as u32, cells.start as u32, planes.start as u32);
        let same = |f: LocalFunction| f;
        let local = |c: LocalCell| if c.is_none() { c } else { LocalCell(c.0 - cell) };
        let corners = if all.dim == 2 { 0..0 } else { items_of(&all.face_vertices, faces.clone()) };
        // What the other kind has is not there at all.
        let words = all.label_words();
        let (labels, zero, opposite, owned) = match all.kind {
            Kind::Arrangement => (
                cells.start * words..cells.end * words,
                i * words..(i + 1) * words,
                items_of(&all.plane_functions, planes.clone()),
                0..0,
            ),
            Kind::Interface => (0..0, 0..0, 0..0, cells.clone()),
        };
        SimplexComplex {
            kind: all.kind,
            dim: all.dim,
            functions: all.functions,
            vertex_carrier: all.vertex_carrier[vertices.clone()].to_vec(),
            vertex_encoding: all.vertex_encoding[vertices.clone()].to_vec(),
            vertex_functions: rows_of(&all.vertex_functions, vertices, same),
            edges: all.edges[edges].iter().map(|e| e.map(|v| LocalVertex(v.0 - vertex))).collect(),
            face_vertices: rows_of(&all.face_vertices, faces.clone(), |v| LocalVertex(v.0 - vertex)),
            face_edges: all.face_edges[corners].iter().map(|e| LocalEdge(e.0 - edge)).collect(),
            face_support: all.face_support[faces.clone()].to_vec(),
            face_plane: all.face_plane[faces.clone()].iter().map(|p| LocalPlane(p.0 - plane)).collect(),
            face_cells: all.face_cells[faces].iter().map(|sides| sides.map(local)).collect(),
            plane_functions: rows_of(&all.plane_functions, planes, same),
            plane_opposite: all.plane_opposite[opposite].to_vec(),
            cell_faces: rows_of(&all.cell_faces, cells, |h| LocalHalfFace(h.0 - 2 * face)),
            cell_positive: all.cell_positive[labels].to_vec(),
            zero_functions: all.zero_functions[zero].to_vec(),
            cell_owner: all.cell_owner[owned.clone()].to_vec(),
            cell_materials: rows_of(&all.cell_materials, owned, same),
        }
    }

    /// That the parts are in order, and each complex consistent.
    pub fn check(&self) -> Result<(), String> {
        let ends = [
            (self.first_vertex.last().map(|v| v.at()), self.all.vertex_count()),
            (self.first_edge.last().map(|e| e.at()), self.all.edge_count()),
            (self.first_face.last().map(|f| f.at()), self.all.face_count()),
            (self.first_cell.last().map(|c| c.at()), self.all.cell_count()),
            (self.first_plane.last().map(|p| p.at()), self.all.plane_functions.len()),
        ];
        if ends.iter().any(|(last, count)| last.unwrap_or(0) != *count) {
            return Err("the parts of a batch do not add up".into());
        }
        (0..self.len())
            .try_for_each(|i| check(&self.simplex(i), self.values_of(i)).map_err(|e| format!("simplex {i}: {e}")))
    }
}

/// The items of some rows.
fn items_of<T>(rows: &Csr<T>, range: Range<usize>) -> Range<usize> {
    rows.offsets[range.start] as usize..rows.offsets[range.end] as usize
}

/// Some rows; items may be numbers that begin elsewhere.
fn rows_of<T: Copy>(rows: &Csr<T>, range: Range<usize>, shift: impl Fn(T) -> T) -> Csr<T> {
    let items = items_of(rows, range.clone());
    let base = items.start as u32;
    Csr {
        offsets: rows.offsets[range.start..=range.end].iter().map(|o| o - base).collect(),
        items: rows.items[items].iter().map(|x| shift(*x)).collect(),
    }
}

fn clear<T>(rows: &mut Csr<T>) {
    rows.offsets.clear();
    rows.offsets.push(0);
    rows.items.clear();
}

/// Rows behind rows; items may be numbers that begin elsewhere.
fn append_rows<T: Copy>(to: &mut Csr<T>, from: &Csr<T>, shift: impl Fn(T) -> T) {
    let base = to.items.len() as u32;
    to.offsets.extend(from.offsets[1..].iter().map(|o| o + base));
    to.items.extend(from.items.iter().map(|x| shift(*x)));
}

/// One complex behind another.
fn append(to: &mut SimplexComplex, from: &SimplexComplex) -> Result<(), Error> {
    let long = |a: usize, b: usize| a + b > i32::MAX as usize;
    if long(to.vertex_functions.items.len(), from.vertex_functions.items.len())
        || long(to.face_vertices.items.len(), from.face_vertices.items.len())
        // Half-faces are numbered by twice the face.
        || long(to.cell_faces.items.len(), 2 * from.face_count())
        || long(to.plane_functions.items.len(), from.plane_functions.items.len())
        || long(to.cell_materials.items.len(), from.cell_materials.items.len())
    {
        return Err(Error::new(Status::TooLarge, "the result has more elements than 32-bit indices can number"));
    }
    let (vertex, edge) = (to.vertex_count() as u32, to.edge_count() as u32);
    let (face, cell) = (to.face_count() as u32, to.cell_count() as u32);
    let plane = to.plane_functions.len() as u32;
    let same = |f: LocalFunction| f;
    to.vertex_carrier.extend_from_slice(&from.vertex_carrier);
    to.vertex_encoding.extend_from_slice(&from.vertex_encoding);
    append_rows(&mut to.vertex_functions, &from.vertex_functions, same);
    to.edges.extend(from.edges.iter().map(|e| e.map(|v| LocalVertex(v.0 + vertex))));
    append_rows(&mut to.face_vertices, &from.face_vertices, |v| LocalVertex(v.0 + vertex));
    to.face_edges.extend(from.face_edges.iter().map(|e| LocalEdge(e.0 + edge)));
    to.face_support.extend_from_slice(&from.face_support);
    to.face_plane.extend(from.face_plane.iter().map(|p| LocalPlane(p.0 + plane)));
    let shifted = |c: LocalCell| if c.is_none() { c } else { LocalCell(c.0 + cell) };
    to.face_cells.extend(from.face_cells.iter().map(|sides| sides.map(shifted)));
    append_rows(&mut to.plane_functions, &from.plane_functions, same);
    to.plane_opposite.extend_from_slice(&from.plane_opposite);
    append_rows(&mut to.cell_faces, &from.cell_faces, |h| LocalHalfFace(h.0 + 2 * face));
    to.cell_positive.extend_from_slice(&from.cell_positive);
    to.zero_functions.extend_from_slice(&from.zero_functions);
    to.cell_owner.extend_from_slice(&from.cell_owner);
    append_rows(&mut to.cell_materials, &from.cell_materials, same);
    Ok(())
}

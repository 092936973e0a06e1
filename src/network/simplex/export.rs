//! From the working arenas to the complex that callers read: what is gone is left out, numbers are made dense, walls and summit
//! of an interface and the apex of a triangle disappear, sets of functions are completed, cells get their labels.
//!
//! Cost: linear in the result (labels: cells times words of 64 functions).

use super::arrangement::{EVERYWHERE, NOWHERE};
use super::data::*;
use super::work::{FACETS, NONE, SUMMIT, State, Work};
use crate::exact::Sign;
use std::mem::take;

/// Numbers of working elements in the result.
#[derive(Clone, Debug, Default)]
pub(super) struct Maps {
    vertices: Vec<u32>,
    edges: Vec<u32>,
    faces: Vec<u32>,
    /// The interface's cells; the arrangement's planes.
    rows: Vec<u32>,
    /// The vertex of each number in the result.
    order: Vec<u32>,
    set: Vec<LocalFunction>,
}

impl SimplexComplex {
    pub(super) fn clear(&mut self, kind: Kind, dim: usize, functions: usize) {
        (self.kind, self.dim, self.functions) = (kind, dim, functions);
        self.vertex_carrier.clear();
        self.vertex_encoding.clear();
        self.edges.clear();
        self.face_edges.clear();
        self.face_support.clear();
        self.face_plane.clear();
        self.face_cells.clear();
        self.plane_opposite.clear();
        self.cell_positive.clear();
        self.zero_functions.clear();
        self.cell_owner.clear();
        for csr in [&mut self.vertex_functions, &mut self.plane_functions, &mut self.cell_materials] {
            csr.items.clear();
            csr.offsets.truncate(1);
        }
        self.face_vertices.items.clear();
        self.face_vertices.offsets.truncate(1);
        self.cell_faces.items.clear();
        self.cell_faces.offsets.truncate(1);
    }
}

pub(super) fn arrangement(work: &mut Work, maps: &mut Maps, dim: usize, out: &mut SimplexComplex) {
    let n = work.values.len();
    // What is overwritten below need not be cleared.
    let (mut loop_vertices, mut loop_edges, mut half_faces) = (vec![], vec![], vec![]);
    if dim == 3 {
        loop_vertices = take(&mut out.face_vertices.items);
        loop_edges = take(&mut out.face_edges);
        half_faces = take(&mut out.cell_faces.items);
    }
    out.clear(Kind::Arrangement, dim, n);
    let plain = planes(work, maps, dim, out);

    // The apex, which is above the triangle, is left out.
    let apex = if dim == 2 { 3 } else { work.vertices.len() };
    let (below, above) = (&work.vertices[..apex], work.vertices.get(apex + 1..).unwrap_or(&[]));
    let vertices = || below.iter().chain(above);
    out.vertex_carrier.extend(vertices().map(|v| Carrier(v.carrier)));
    out.vertex_encoding.extend(vertices().map(|v| v.functions().map(LocalFunction)));
    if plain && work.more.is_empty() {
        // As many functions as the carrier has dimensions; what is written beyond is overwritten.
        let total = extend_offsets(&mut out.vertex_functions.offsets, vertices().map(|v| v.size as u32 - 1));
        let items = &mut out.vertex_functions.items;
        items.resize(total + 4, LocalFunction::NONE);
        for (&at, encoding) in out.vertex_functions.offsets.iter().zip(&out.vertex_encoding) {
            items[at as usize..at as usize + 4].copy_from_slice(encoding);
        }
        items.truncate(total);
    } else {
        for v in (0..work.vertices.len()).filter(|&v| v != apex) {
            maps.set.clear();
            for p in work.vertices[v].planes {
                // (The triangle itself has no row.)
                if p != NONE && maps.rows[p as usize] != NONE {
                    maps.set.extend_from_slice(out.plane_functions.row(maps.rows[p as usize] as usize));
                }
            }
            more(work, v, |p| match maps.rows[p as usize] {
                // It touches here only.
                NONE => maps.set.push(LocalFunction(p - FACETS)),
                row => maps.set.extend_from_slice(out.plane_functions.row(row as usize)),
            });
            maps.set.sort_unstable();
            out.vertex_functions.push_row(&maps.set);
        }
    }

    let cells = |f: &super::work::Face| f.cells.map(LocalCell);
    let support = |p: u32| match p {
        0..FACETS => FaceSupport::Facet(p as u8),
        _ => FaceSupport::Function(LocalFunction(p - FACETS)),
    };
    if dim == 3 {
        out.edges.extend(work.edges.iter().map(|e| e.ends.map(LocalVertex)));
        out.face_support.extend(work.faces.iter().map(|f| support(f.plane)));
        out.face_plane.extend(work.faces.iter().map(|f| LocalPlane(maps.rows[f.plane as usize])));
        out.face_cells.extend(work.faces.iter().map(cells));
        let total = extend_offsets(&mut out.face_vertices.offsets, work.faces.iter().map(|f| f.len));
        work.corners.extend_from_slice(&[[NONE; 2]; BLOCK]);
        loop_vertices.resize(total + BLOCK, LocalVertex::NONE);
        loop_edges.resize(total + BLOCK, LocalEdge::NONE);
        for (face, &at) in work.faces.iter().zip(&out.face_vertices.offsets) {
            let corners = &work.corners[face.at as usize..];
            let (vertices, edges) = (&mut loop_vertices[at as usize..], &mut loop_edges[at as usize..]);
            in_blocks(face.len, |k| {
                *block_mut(vertices, k) = block(corners, k).map(|c| LocalVertex(c[0]));
                *block_mut(edges, k) = block(corners, k).map(|c| LocalEdge(c[1]));
            });
        }
        loop_vertices.truncate(total);
        loop_edges.truncate(total);
        let total = extend_offsets(&mut out.cell_faces.offsets, work.cells.iter().map(|c| c.len));
        work.half_faces.extend_from_slice(&[NONE; BLOCK]);
        half_faces.resize(total + BLOCK, LocalHalfFace(NONE));
        for (cell, &at) in work.cells.iter().zip(&out.cell_faces.offsets) {
            let (from, to) = (&work.half_faces[cell.at as usize..], &mut half_faces[at as usize..]);
            in_blocks(cell.len, |k| *block_mut(to, k) = block(from, k).map(LocalHalfFace));
        }
        half_faces.truncate(total);
        (out.face_vertices.items, out.face_edges, out.cell_faces.items) = (loop_vertices, loop_edges, half_faces);
    } else {
        maps.faces.clear();
        for face in &work.faces {
            if face.plane == 3 {
                maps.faces.push(NONE);
                continue;
            }
            maps.faces.push(out.face_support.len() as u32);
            let ends = segment(work, face.at, face.len, false).map(|v| LocalVertex(v - (v > 3) as u32));
            out.face_vertices.push_row(&ends);
            out.face_support.push(support(face.plane));
            out.face_plane.push(LocalPlane(maps.rows[face.plane as usize]));
            out.face_cells.push(cells(face));
        }
        for cell in &work.cells {
            let halves = &work.half_faces[cell.at as usize..(cell.at + cell.len) as usize];
            let kept = halves.iter().filter(|&&h| work.faces[(h >> 1) as usize].plane != 3);
            let mapped = kept.map(|&h| LocalHalfFace(maps.faces[(h >> 1) as usize] << 1 | h & 1));
            out.cell_faces.items.extend(mapped);
            out.cell_faces.end_row();
        }
    }
    labels(work, out);
}

/// Rows of three to eight items, nearly all of them: a block is copied at once, and what it brings along from behind its row is overwritten
/// by the next one. So there is a block more at the end of all that is read or written so.
const BLOCK: usize = 8;

/// Visits where the blocks of a row of `len` items begin.
#[inline(always)]
fn in_blocks(len: u32, mut visit: impl FnMut(usize)) {
    let mut k = 0;
    while k < len as usize {
        visit(k);
        k += BLOCK;
    }
}

#[inline(always)]
fn block<T>(items: &[T], at: usize) -> &[T; BLOCK] {
    items[at..].first_chunk().expect("a block more than there are items")
}

#[inline(always)]
fn block_mut<T>(items: &mut [T], at: usize) -> &mut [T; BLOCK] {
    items[at..].first_chunk_mut().expect("a block more than there are items")
}

/// Rows of planes: facets, then the distinct planes of functions. Returns whether each function has at most a plane of its own.
fn planes(work: &Work, maps: &mut Maps, dim: usize, out: &mut SimplexComplex) -> bool {
    let n = work.values.len();
    let mut plain = true;
    maps.rows.clear();
    maps.rows.resize(n + FACETS as usize, NONE);
    let mut count = 0;
    for row in &mut maps.rows[..=dim] {
        *row = count;
        count += 1;
    }
    for f in 0..n {
        let plane = work.function_plane[f];
        if plane == f as u32 + FACETS {
            maps.rows[plane as usize] = count;
            count += 1;
        } else if plane < EVERYWHERE {
            plain = false;
        }
    }
    if plain {
        out.plane_functions.offsets.resize(dim + 2, 0);
        for f in 0..n {
            if work.function_plane[f] < EVERYWHERE {
                out.plane_functions.push_row(&[LocalFunction(f as u32)]);
            }
        }
        out.plane_opposite.resize(out.plane_functions.items.len(), false);
        return true;
    }
    // Count, prefix sum, fill.
    let offsets = &mut out.plane_functions.offsets;
    offsets.resize(count as usize + 1, 0);
    let row_of =
        |f: usize| Some(work.function_plane[f]).filter(|&p| p < EVERYWHERE).map(|p| maps.rows[p as usize] as usize);
    (0..n).filter_map(row_of).for_each(|r| offsets[r + 1] += 1);
    for r in 0..count as usize {
        offsets[r + 1] += offsets[r];
    }
    let total = offsets[count as usize] as usize;
    out.plane_functions.items.resize(total, LocalFunction::NONE);
    out.plane_opposite.resize(total, false);
    for f in (0..n).rev() {
        if let Some(r) = row_of(f) {
            // Filled from behind, so each offset moves down from the next row's start to its own.
            offsets[r + 1] -= 1;
            let at = offsets[r + 1] as usize;
            out.plane_functions.items[at] = LocalFunction(f as u32);
            out.plane_opposite[at] = work.function_opposite[f];
        }
    }
    // Entry r + 1 now holds row r's start.
    offsets.remove(0);
    offsets.push(total as u32);
    false
}

/// Adds the ends of rows of these lengths; returns the last.
fn extend_offsets(offsets: &mut Vec<u32>, lengths: impl Iterator<Item = u32>) -> usize {
    let mut end = 0;
    offsets.extend(lengths.map(|n| {
        end += n;
        end
    }));
    end as usize
}

/// Visits the planes at a vertex beyond its own.
fn more(work: &Work, v: usize, mut visit: impl FnMut(u32)) {
    let mut i = work.more_head[v];
    while i != NONE {
        let [p, next] = work.more[i as usize];
        visit(p);
        i = next;
    }
}

/// The ends of the segment over which a face through the apex stands, with the face's positive side on the left (`turned`: on the
/// right). The face counterclockwise from there is apex, second, first: seen from the apex, its normal points left.
fn segment(work: &Work, at: u32, len: u32, turned: bool) -> [u32; 2] {
    debug_assert_eq!(len, 3);
    let corner = |k: u32| work.corners[(at + k % 3) as usize][0];
    let apex = (0..3).find(|&k| work.vertices[corner(k) as usize].carrier == 0b1000).expect("a face through the apex");
    let (a, b) = (corner(apex + 1), corner(apex + 2));
    if turned { [a, b] } else { [b, a] }
}

/// Labels of cells: those of one cell by its vertices' signs, all others from there, through faces, where the functions of the face's
/// plane change their signs.
fn labels(work: &mut Work, out: &mut SimplexComplex) {
    let n = work.values.len();
    let words = out.label_words();
    out.zero_functions.resize(words, 0);
    out.cell_positive.resize(words * out.cell_count(), 0);
    for f in 0..n {
        let (word, bit) = (f / 64, 1u64 << (f % 64));
        let positive = match work.function_plane[f] {
            EVERYWHERE => {
                out.zero_functions[word] |= bit;
                false
            }
            NOWHERE => work.values[f].iter().any(|&x| x > 0.0),
            p if p < FACETS => !work.function_opposite[f],
            p => {
                let rep = (p - FACETS) as usize;
                let known = if rep < f {
                    out.cell_positive[rep / 64] >> (rep % 64) & 1 != 0
                } else {
                    sign_in_first_cell(work, f) == Sign::Positive
                };
                known != work.function_opposite[f]
            }
        };
        out.cell_positive[word] |= if positive { bit } else { 0 };
    }
    let seen = n as u32 + 1;
    let mut unseen = out.cell_count() - 1;
    work.stack.clear();
    work.stack.push(0);
    work.cells[0].mark = seen;
    while unseen > 0 {
        let c = work.stack.pop().expect("cells hang together");
        for half in out.cell_faces.row(c as usize) {
            let f = half.face();
            let other = out.face_cells[f.at()][1 - half.side()];
            if other.is_none() || work.cells[other.at()].mark == seen {
                continue;
            }
            work.cells[other.at()].mark = seen;
            unseen -= 1;
            let (from, to) = (c as usize * words, other.at() * words);
            out.cell_positive.copy_within(from..from + words, to);
            for g in out.plane_functions.row(out.face_plane[f.at()]) {
                out.cell_positive[to + g.at() / 64] ^= 1 << (g.at() % 64);
            }
            work.stack.push(other.0);
        }
    }
}

/// The sign of a function inside cell 0, which it does not cross: that of any of its vertices where it does not vanish.
fn sign_in_first_cell(work: &mut Work, f: usize) -> Sign {
    let (at, len) = (work.cells[0].at as usize, work.cells[0].len as usize);
    for exactly in [false, true] {
        for k in at..at + len {
            let face = work.faces[(work.half_faces[k] >> 1) as usize];
            for i in face.at..face.at + face.len {
                let v = work.corners[i as usize][0];
                let sign = if exactly { work.exact_sign(f, v) as i32 } else { work.filtered_sign(f, v) };
                if sign != 0 {
                    return if sign > 0 { Sign::Positive } else { Sign::Negative };
                }
            }
        }
    }
    unreachable!("a cell on which a function with a plane vanishes")
}

pub(super) fn interface(work: &mut Work, maps: &mut Maps, dim: usize, out: &mut SimplexComplex) {
    let n = work.values.len();
    out.clear(Kind::Interface, dim, n);

    // Corners first, in order.
    maps.vertices.clear();
    maps.vertices.resize(work.vertices.len(), NONE);
    maps.order.clear();
    maps.order.resize(dim + 1, NONE);
    for (v, vertex) in work.vertices.iter().enumerate() {
        let c = vertex.carrier;
        if vertex.state == State::Dead || v as u32 == SUMMIT || dim == 2 && c >> 3 != 0 {
            continue;
        }
        if c.is_power_of_two() {
            let corner = c.trailing_zeros();
            maps.order[corner as usize] = v as u32;
            maps.vertices[v] = corner;
        } else {
            maps.vertices[v] = maps.order.len() as u32;
            maps.order.push(v as u32);
        }
    }
    for &v in &maps.order {
        let vertex = &work.vertices[v as usize];
        out.vertex_carrier.push(Carrier(vertex.carrier));
        let encoded = vertex.functions().map(LocalFunction);
        out.vertex_encoding.push(encoded);
        let start = out.vertex_functions.items.len();
        out.vertex_functions.items.extend(encoded.into_iter().take_while(|f| f.is_some()));
        if vertex.state == State::More {
            more(work, v as usize, |p| out.vertex_functions.items.push(LocalFunction(p - FACETS)));
            out.vertex_functions.items[start..].sort_unstable();
        }
        out.vertex_functions.end_row();
    }

    maps.edges.clear();
    if dim == 3 {
        for edge in &work.edges {
            if edge.ends[0] == NONE || edge.ends[1] == SUMMIT || edge.ends[0] == SUMMIT {
                maps.edges.push(NONE);
            } else {
                maps.edges.push(out.edges.len() as u32);
                out.edges.push(edge.ends.map(|v| LocalVertex(maps.vertices[v as usize])));
            }
        }
    }

    maps.rows.clear();
    let mut count = 0;
    for (c, cell) in work.cells.iter().enumerate() {
        let owns = c >= FACETS as usize && cell.len != 0;
        maps.rows.push(if owns { count } else { NONE });
        if owns {
            count += 1;
            let mut m = c as u32 - FACETS;
            out.cell_owner.push(LocalFunction(m));
            while m != NONE {
                out.cell_materials.items.push(LocalFunction(m));
                m = work.twin[m as usize];
            }
            out.cell_materials.end_row();
        }
    }

    // In the work the higher cell is on the positive side; here the lower of two owners is.
    maps.faces.clear();
    for face in &work.faces {
        let [high, low] = face.cells;
        if face.len == 0 || high < FACETS || dim == 2 && low == 3 {
            maps.faces.push(NONE);
            continue;
        }
        maps.faces.push(out.face_support.len() as u32);
        let turned = low >= FACETS;
        let vertex = |v: u32| LocalVertex(maps.vertices[v as usize]);
        if dim == 2 {
            let ends = segment(work, face.at, face.len, turned).map(vertex);
            out.face_vertices.items.extend_from_slice(&ends);
        } else {
            let corners = &work.corners[face.at as usize..(face.at + face.len) as usize];
            let edge = |e: u32| LocalEdge(maps.edges[e as usize]);
            if turned {
                out.face_vertices.items.extend(corners.iter().rev().map(|c| vertex(c[0])));
                let (last, rest) = corners.split_last().expect("corners");
                out.face_edges.extend(rest.iter().rev().map(|c| edge(c[1])));
                out.face_edges.push(edge(last[1]));
            } else {
                out.face_vertices.items.extend(corners.iter().map(|c| vertex(c[0])));
                out.face_edges.extend(corners.iter().map(|c| edge(c[1])));
            }
        }
        out.face_vertices.end_row();
        let cell = |c: u32| LocalCell(maps.rows[c as usize]);
        out.face_plane.push(LocalPlane(out.face_plane.len() as u32));
        if turned {
            let (a, b) = (LocalFunction(low - FACETS), LocalFunction(high - FACETS));
            out.face_support.push(FaceSupport::Pair(a, b));
            out.face_cells.push([cell(low), cell(high)]);
        } else {
            out.face_support.push(FaceSupport::Facet(low as u8));
            out.face_cells.push([cell(high), LocalCell::NONE]);
        }
        face_materials(work, maps, out, face.at, face.len, face.cells);
    }

    for (c, cell) in work.cells.iter().enumerate() {
        if maps.rows[c] == NONE {
            continue;
        }
        for &half in &work.half_faces[cell.at as usize..(cell.at + cell.len) as usize] {
            let f = half >> 1;
            if maps.faces[f as usize] != NONE {
                let turned = work.faces[f as usize].cells[1] >= FACETS;
                out.cell_faces.items.push(LocalHalfFace(maps.faces[f as usize] << 1 | (half & 1) ^ turned as u32));
            }
        }
        out.cell_faces.end_row();
    }
}

/// The row of materials that are largest on a face: its owners; or, if all of its corners have more than their planes, what three
/// corners (in 2-D two), which are not on a line, share.
fn face_materials(work: &Work, maps: &mut Maps, out: &mut SimplexComplex, at: u32, len: u32, [high, low]: [u32; 2]) {
    let corners = || work.corners[at as usize..(at + len) as usize].iter().map(|c| c[0] as usize);
    let known = |v: &usize| maps.vertices[*v] != NONE;
    let items = &mut out.plane_functions.items;
    if corners().filter(known).any(|v| work.vertices[v].state == State::Plain) {
        if low >= FACETS {
            items.push(LocalFunction(low - FACETS));
        }
        items.push(LocalFunction(high - FACETS));
    } else {
        let mut rows = corners().filter(known).take(3).map(|v| out.vertex_functions.row(maps.vertices[v] as usize));
        maps.set.clear();
        maps.set.extend_from_slice(rows.next().expect("corners"));
        for row in rows {
            maps.set.retain(|m| row.binary_search(m).is_ok());
        }
        items.extend_from_slice(&maps.set);
    }
    out.plane_functions.end_row();
}

//! The upper envelope of materials in one simplex (section 4.2), one material after another.
//!
//! The envelope of materials f_k over the simplex bounds the polyhedron P = {(x, w): w >= f_k(x) for all k, x in the simplex}: its
//! facets are the graphs of the materials that own a cell, and the vertical walls over the simplex's facets. With a *summit* added
//! at w = infinity, P is a 4-polytope, and its boundary a complex of cells (owners and walls), faces (between two of them),
//! edges and vertices on the 3-sphere. The first material makes it a 4-simplex. A further material i cuts P by a
//! half-space: the part below its graph goes, and the section is the new cell. So where the paper splits and merges, here the positive
//! part of every crossed element is dropped and the hole is closed by one new cell, whose face towards each crossed cell (wall) is
//! that one's section. Nothing is left over that would have to be merged: what is there is the face lattice of P, which
//! depends on P alone, not on the order of the materials. Cells of materials that are pushed out vanish by themselves.
//!
//! Signs are those of f_i minus the envelope. All vertices are looked at (one dot product each; that finds ties as well);
//! then the cells with a positive vertex are flooded through faces with one.
//!
//! Degenerate cases. A material that is largest on a vertex, an edge or a face of P only has no positive vertex, splits nothing and is
//! noted at the vertices. One that is equal to an older one everywhere is the same case, and the older one's *twin*. A face on
//! which f_i equals the envelope and of whose cells one is dropped becomes a face of the new cell. The summit is always
//! negative, so some part always stays.

use super::data::{Kind, Scratch, SimplexComplex};
use super::export;
use super::table_view::View;
use super::tables::find_table;
use super::work::{Class, FACETS, NONE, State, Work};

/// The material interface of `values.len() / (dim + 1)` materials (at least one) in a simplex of dimension `dim` (2 or 3).
/// `values`: finite, material-major, `values[m * (dim + 1) + corner]`. Cost: two or three materials are looked up ([`super::tables`]), others
/// take some nanoseconds for each material and vertex, some hundred for each element that is made.
pub fn interface(dim: usize, values: &[f64], scratch: &mut Scratch, out: &mut SimplexComplex) {
    match find_table(Kind::Interface, dim, values) {
        Some(found) => View::new(found).fill(out),
        None => interface_incremental(dim, values, scratch, out),
    }
}

/// The same without tables, which are made from it. Elements have other numbers.
pub fn interface_incremental(dim: usize, values: &[f64], scratch: &mut Scratch, out: &mut SimplexComplex) {
    debug_assert!(dim == 2 || dim == 3);
    debug_assert!(values.len() > dim);
    let Scratch { work, maps } = scratch;
    work.start(dim, values, true);
    work.start_simplex();
    work.dropped.clear();
    work.twin.clear();
    work.twin.resize(work.values.len(), NONE);
    for i in 1..work.values.len() {
        insert(work, dim, i);
    }
    work.flush_counters();
    export::interface(work, maps, dim, out);
    debug_assert!(out.functions > 12 || super::check(out, values).is_ok(), "{:?}", super::check(out, values));
}

fn insert(work: &mut Work, dim: usize, i: usize) {
    work.round = i as u32 + 1;
    work.zeros.clear();
    let mut seed = NONE;
    for v in 0..work.vertices.len() as u32 {
        if work.vertices[v as usize].state != State::Dead && work.new_sign(v) > 0 {
            seed = v;
            work.dropped.push(v);
        }
    }
    if work.zeros.len() >= 4 && seed == NONE {
        find_twin(work, i);
    }
    if seed != NONE {
        cut_away(work, i, seed);
    }
    if !work.zeros.is_empty() {
        work.record_zeros(dim);
    }
}

/// A material that is nowhere larger than the envelope and equal to an owner everywhere.
#[cold]
fn find_twin(work: &mut Work, i: usize) {
    let owner = |&j: &usize| work.cells[FACETS as usize + j].len != 0 && work.values[j] == work.values[i];
    if let Some(mut j) = (0..i).find(owner) {
        while work.twin[j] != NONE {
            j = work.twin[j] as usize;
        }
        work.twin[j] = i as u32;
    }
}

/// Cuts away what lies below material `i`, starting at a vertex that does.
fn cut_away(work: &mut Work, i: usize, seed: u32) {
    let cell = i as u32 + FACETS;
    let edge = work.vertex_edge[seed as usize];
    let face = work.edges[edge as usize].face;
    work.stack.clear();
    let start = work.faces[face as usize].cells[0];
    work.stack.push(start);
    work.cells[start as usize].mark = work.round;
    work.moved.clear();
    work.dropped_edges.clear();
    work.dropped_faces.clear();
    while let Some(c) = work.stack.pop() {
        let (at, len) = (work.cells[c as usize].at as usize, work.cells[c as usize].len as usize);
        work.kept.clear();
        for k in at..at + len {
            let half = work.half_faces[k];
            let f = half >> 1;
            let seen = work.faces[f as usize].mark >> 3 == work.round;
            let class = work.class::<false>(f);
            match class {
                Class::Negative => {
                    work.kept.push(half);
                    work.follow_section(half, false);
                    continue;
                }
                Class::Crossed => {
                    work.kept.push(half);
                    work.follow_section(half, true);
                }
                Class::Positive if seen => {}
                Class::Positive => work.dropped_faces.push(f),
                Class::Zero => {
                    take_over(work, half, cell);
                    continue;
                }
            }
            let other = work.faces[f as usize].cells[(!half & 1) as usize];
            if work.cells[other as usize].mark != work.round {
                work.cells[other as usize].mark = work.round;
                work.stack.push(other);
            }
        }
        if work.kept.is_empty() {
            work.cells[c as usize].len = 0;
        } else {
            let face = work.close_section([cell, c], NONE);
            point_to(work, face);
            work.moved.push(face << 1);
            let mut halves = std::mem::take(&mut work.kept);
            halves.push(face << 1 | 1);
            work.set_cell(c, &halves);
            work.kept = halves;
        }
    }
    let halves = std::mem::take(&mut work.moved);
    work.set_cell(cell, &halves);
    work.moved = halves;
    for v in work.dropped.drain(..) {
        work.vertices[v as usize].state = State::Dead;
        work.free_vertices.push(v);
    }
    for e in work.dropped_edges.drain(..) {
        work.edges[e as usize].ends = [NONE; 2];
        work.free_edges.push(e);
    }
    for f in work.dropped_faces.drain(..) {
        work.faces[f as usize].len = 0;
        work.free_faces.push(f);
    }
}

/// A face on which the new material equals the envelope, of a cell that is dropped: the new cell's from now on.
#[cold]
fn take_over(work: &mut Work, half: u32, cell: u32) {
    let f = half >> 1;
    let face = &mut work.faces[f as usize];
    // The new cell has the highest number, and the higher one is on the positive side.
    if half & 1 != 0 {
        let (at, len) = (face.at as usize, face.len as usize);
        face.cells[1] = face.cells[0];
        let corners = &mut work.corners[at..at + len];
        // Each entry holds the edge to the next vertex: after turning round, that of the one before.
        corners.reverse();
        let first = corners[0][1];
        for k in 0..len - 1 {
            corners[k][1] = corners[k + 1][1];
        }
        corners[len - 1][1] = first;
        // The other cell's entry.
        let other = work.faces[f as usize].cells[1] as usize;
        let (at, len) = (work.cells[other].at as usize, work.cells[other].len as usize);
        let entry = work.half_faces[at..at + len].iter_mut().find(|h| **h >> 1 == f).expect("a face of the cell");
        *entry = f << 1 | 1;
    }
    work.faces[f as usize].cells[0] = cell;
    point_to(work, f);
    work.moved.push(f << 1);
}

/// Its vertices and edges stay, so they lead to this face, which does.
fn point_to(work: &mut Work, f: u32) {
    let (at, len) = (work.faces[f as usize].at as usize, work.faces[f as usize].len as usize);
    for k in at..at + len {
        let [v, e] = work.corners[k];
        work.vertex_edge[v as usize] = e;
        work.edges[e as usize].face = f;
    }
}

//! The arrangement of linear functions in one simplex (section 4.1), one function after another.
//!
//! A new function with corner values of both signs meets an edge of the simplex. Walking along that edge's parts finds the
//! place, and from there the cells that the function crosses are flooded: through faces that it crosses, and through faces with an
//! edge on which it vanishes (where cells meet that share no more than the edge). So only its zone is visited; by the zone theorem
//! that is O(k^2) for k planes, O(n^3) in all, which is the size of the result.
//!
//! Degenerate cases. Corner values without both signs split nothing: the function vanishes nowhere, on a corner or an edge of the
//! simplex (its vertices there note it), on a facet (the facet's plane notes it) or everywhere. If the place is a vertex,
//! the flood first goes through all faces at which the function touches, until it has met either a cell that is crossed or a
//! face on which the function vanishes; then its plane is an older one, and nothing is split.

use super::data::{Kind, Scratch, SimplexComplex};
use super::export;
use super::table_view::View;
use super::tables::find_table;
use super::work::{Class, EDGE_CORNERS, FACETS, NONE, Work};

/// In `function_plane`: the function vanishes everywhere; it vanishes at most on a corner or an edge of the simplex.
pub(super) const EVERYWHERE: u32 = NONE - 1;
pub(super) const NOWHERE: u32 = NONE;

/// Up to so many vertices get their signs in one pass, which is faster than asking for each whether it has one.
const FEW: usize = 48;

/// The arrangement of `values.len() / (dim + 1)` functions (any number, none included) in a simplex of dimension `dim` (2 or 3).
/// `values`: finite, function-major, `values[f * (dim + 1) + corner]`. Cost: one or two functions are looked up ([`super::tables`]), others
/// take a few hundred nanoseconds for each cell; see the head of this file.
pub fn arrangement(dim: usize, values: &[f64], scratch: &mut Scratch, out: &mut SimplexComplex) {
    match find_table(Kind::Arrangement, dim, values) {
        Some(found) => View::new(found).fill(out),
        None => construct::<true>(dim, values, scratch, out),
    }
}

/// The same without tables, which are made from it. Elements have other numbers.
pub fn arrangement_incremental(dim: usize, values: &[f64], scratch: &mut Scratch, out: &mut SimplexComplex) {
    construct::<false>(dim, values, scratch, out);
}

/// `TABLES`: the first two functions may come from a table.
fn construct<const TABLES: bool>(dim: usize, values: &[f64], scratch: &mut Scratch, out: &mut SimplexComplex) {
    debug_assert!(dim == 2 || dim == 3);
    let Scratch { work, maps } = scratch;
    work.start(dim, values, false);
    work.function_plane.clear();
    work.function_opposite.clear();
    let n = work.values.len();
    let entered = if TABLES && dim == 3 && n > 2 && work.enter_first_two() { 2 } else { 0 };
    if entered == 0 {
        work.start_simplex();
    }
    for f in entered..n {
        insert(work, dim, f);
    }
    work.flush_counters();
    export::arrangement(work, maps, dim, out);
    debug_assert!(out.functions > 12 || super::check(out, values).is_ok(), "{:?}", super::check(out, values));
}

fn insert(work: &mut Work, dim: usize, f: usize) {
    work.round = f as u32 + 1;
    work.zeros.clear();
    let values = work.values[f];
    let (mut positive, mut negative) = (0u8, 0u8);
    for (c, x) in values.into_iter().enumerate() {
        positive |= ((x > 0.0) as u8) << c;
        negative |= ((x < 0.0) as u8) << c;
    }
    let (mut plane, mut opposite) = (f as u32 + FACETS, false);
    if positive != 0 && negative != 0 {
        work.all_signs = work.vertices.len() <= FEW;
        if work.all_signs {
            for v in 0..work.vertices.len() as u32 {
                work.new_sign(v);
            }
        }
        if let Some(old) = split(work, positive, negative) {
            plane = old;
            let other = &work.values[(old - FACETS) as usize];
            let c = other.iter().position(|&x| x != 0.0).expect("a plane");
            opposite = (other[c] > 0.0) != (values[c] > 0.0);
        } else if !work.zeros.is_empty() {
            work.record_zeros(dim);
        }
    } else {
        // It vanishes on the corners' span where it is zero, and nowhere else.
        let zero = !(positive | negative) & 0b1111;
        match zero.count_ones() {
            4 => plane = EVERYWHERE,
            3 => {
                plane = (positive | negative).trailing_zeros();
                opposite = positive == 0;
            }
            0 => plane = NOWHERE,
            _ => {
                plane = NOWHERE;
                for v in 0..work.vertices.len() {
                    if work.vertices[v].carrier & !zero == 0 {
                        work.zeros.push(v as u32);
                    }
                }
                work.record_zeros(dim);
            }
        }
    }
    work.function_plane.push(plane);
    work.function_opposite.push(opposite);
}

/// Splits all that the current function crosses; or returns the older plane on which it vanishes.
fn split(work: &mut Work, positive: u8, negative: u8) -> Option<u32> {
    let (seed, mut found) = seed(work, positive, negative);
    work.stack.clear();
    work.stack.push(seed);
    work.cells[seed as usize].mark = work.round;
    while let Some(c) = work.stack.pop() {
        let (at, len) = (work.cells[c as usize].at as usize, work.cells[c as usize].len as usize);
        work.kept.clear();
        work.moved.clear();
        let mut sides = 0u8;
        for k in at..at + len {
            let half = work.half_faces[k];
            let f = half >> 1;
            let class = work.class::<true>(f);
            match class {
                Class::Negative => {
                    sides |= 1;
                    work.kept.push(half);
                    work.follow_section(half, false);
                }
                Class::Positive => {
                    sides |= 2;
                    work.moved.push(half);
                }
                Class::Crossed => {
                    sides |= 3;
                    work.kept.push(half);
                    work.moved.push(work.faces[f as usize].child << 1 | half & 1);
                    work.follow_section(half, true);
                }
                Class::Zero => return Some(work.faces[f as usize].plane),
            }
            let on = class == Class::Crossed || work.faces[f as usize].cut != NONE || (!found && work.touched(f));
            if on {
                let other = work.faces[f as usize].cells[(!half & 1) as usize];
                if other != NONE && work.cells[other as usize].mark != work.round {
                    work.cells[other as usize].mark = work.round;
                    work.stack.push(other);
                }
            }
        }
        if sides == 3 {
            found = true;
            let new = work.cells.len() as u32;
            let face = work.close_section([new, c], work.round - 1 + FACETS);
            for i in 0..work.moved.len() {
                let half = work.moved[i];
                work.faces[(half >> 1) as usize].cells[(half & 1) as usize] = new;
            }
            let mut halves = std::mem::take(&mut work.moved);
            halves.push(face << 1);
            work.push_cell(&halves);
            work.cells[new as usize].mark = work.round;
            work.moved = halves;
            let mut halves = std::mem::take(&mut work.kept);
            halves.push(face << 1 | 1);
            work.set_cell(c, &halves);
            work.kept = halves;
        }
    }
    None
}

/// A cell at an edge of the simplex where the function changes its sign; and whether it is sure to be crossed.
fn seed(work: &mut Work, positive: u8, negative: u8) -> (u32, bool) {
    let unlike = |[a, b]: [u32; 2]| (positive >> a & negative >> b | negative >> a & positive >> b) & 1 != 0;
    let on = EDGE_CORNERS.iter().position(|&e| unlike(e)).expect("corners of both signs");
    let mut e = work.first_part[on];
    let start = if positive >> EDGE_CORNERS[on][0] & 1 != 0 { 1 } else { -1 };
    loop {
        let edge = work.edges[e as usize];
        let s = work.sign(edge.ends[1]);
        if s != start {
            return (work.faces[edge.face as usize].cells[0], s != 0);
        }
        e = edge.next;
    }
}

//! Moments of cut cells to order 2 about the middle of their boxes, on demand.
//!
//! A cell is the signed sum of the tetrahedra from the middle over fans of its faces; over a tetrahedron 0 a b c with d =
//! det(a, b, c) and s = a + b + c, ∫ x_i = d s_i / 24 and ∫ x_i x_j = d (a_i a_j + b_i b_j + c_i c_j + s_i s_j) / 120. In pairs of doubles,
//! in units of the box (where all coordinates are at most 1/2), with a static bound; values stand for the exact ones as
//! [`super::settle`] says. What the bound leaves open is computed with rationals: exact zeros by symmetry (some hundred
//! microseconds each), very small cells. Cost otherwise: some 10 µs per cell.

use super::data::GridCells;
use super::exact_moments::{self, PAIRS};
use super::fixed_point::{Frames, Interval, Place, UNITS, power};
use super::gathered::position;
use super::moments::cell_boxes;
use super::settle::{Pair, settle, settle_rational, two_sum};
use crate::base::{BoxId, CellId, VertexId};
use rayon::prelude::*;

/// Per cell, about the exact middle c of its box.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SecondMoments {
    /// ∫ (x − c)_i dV
    pub first: Vec<[f64; 3]>,
    /// ∫ (x − c)_i (x − c)_j dV for ij = xx, yy, zz, xy, yz, zx.
    pub second: Vec<[f64; 6]>,
    /// How many cells needed rationals.
    pub exact_cells: usize,
}

/// First and second moments of all cut cells. Memory: 72 bytes per cell, and 4 while it runs.
pub fn second_moments(g: &GridCells) -> SecondMoments {
    let frames = Frames::new(&g.lattice, g.extent);
    let boxes = cell_boxes(g);
    let values: Vec<([f64; 9], bool)> = (0..g.cell_count())
        .into_par_iter()
        .with_min_len(256)
        .map(|c| {
            let (c, b) = (CellId::of(c), boxes[c]);
            match fast(g, &frames, b, c) {
                Some(values) => (values, false),
                None => (exact(g, b, c), true),
            }
        })
        .collect();
    SecondMoments {
        first: values.iter().map(|(v, _)| [v[0], v[1], v[2]]).collect(),
        second: values.iter().map(|(v, _)| std::array::from_fn(|i| v[3 + i])).collect(),
        exact_cells: values.iter().filter(|v| v.1).count(),
    }
}

fn exact(g: &GridCells, b: BoxId, c: CellId) -> [f64; 9] {
    let (_, middle, _) = exact_moments::box_values(g, b);
    let m = exact_moments::cell(g, c, &middle, true);
    std::array::from_fn(|i| settle_rational(if i < 3 { &m.first[i] } else { &m.second[i - 3] }))
}

/// A place over 2^exponent, less half the box.
fn from_middle(p: Place, frame: &Interval) -> Pair {
    let whole = Pair::joined((p.h >> 32 << 32) as f64, (p.h as u32) as f64);
    let x = whole.plus(Pair::of(p.l)).scaled(1.0 / UNITS);
    let half = frame.size.scaled(0.5);
    x.plus(Pair { hi: -half.hi, lo: -half.lo })
}

fn fast(g: &GridCells, frames: &Frames, b: BoxId, c: CellId) -> Option<[f64; 9]> {
    let frame = frames.of_box(&g.lattice, b);
    if !frame.iter().all(|x| x.ordinary) {
        return None;
    }
    let place = |v: VertexId| -> [Pair; 3] {
        let (x, r) = position(g, v);
        std::array::from_fn(|i| from_middle(frame[i].place(x[i], r[i]), frame[i]))
    };
    let mut sums = [Pair::default(); 9];
    let mut count = 0.0;
    for h in g.cell_faces(c) {
        for l in g.loops_of(h.face()) {
            let corners = g.corners_of(l);
            if corners.len() < 3 {
                continue;
            }
            let a = place(corners[0]);
            let mut p = place(corners[1]);
            for &v in &corners[2..] {
                let q = place(v);
                add_tetrahedron(&mut sums, &a, &p, &q, h.front());
                count += 1.0;
                p = q;
            }
        }
    }
    // Coordinates are off by η, below 1/2 otherwise: a determinant (below 1) by 10 η, the sum of products (at most 3) by 12 η;
    // and a dozen roundings of pairs, each below 2⁻⁹⁸ of terms below 4.
    let slack = frame[0].slack.max(frame[1].slack).max(frame[2].slack);
    let eta = slack / UNITS + power(-97);
    let err = count * (50.0 * eta + power(-92)) + power(-100);
    let e = frame.map(|x| x.exponent);
    let whole = e[0] + e[1] + e[2];
    let mut out = [0.0; 9];
    for (k, out) in out.iter_mut().enumerate() {
        let (divisor, exponent) = match k {
            0..3 => (24.0, whole + e[k]),
            _ => (120.0, whole + e[PAIRS[k - 3][0]] + e[PAIRS[k - 3][1]]),
        };
        if exponent.abs() > 900 {
            return None;
        }
        let scale = power(exponent);
        let x = sums[k].over(Pair::of(divisor), 1.0 / divisor);
        *out = settle(x.scaled(scale), err * scale)?;
    }
    Some(out)
}

#[inline(always)]
fn add_tetrahedron(sums: &mut [Pair; 9], a: &[Pair; 3], b: &[Pair; 3], c: &[Pair; 3], front: bool) {
    let minor = |i: usize, j: usize| {
        let (p, q) = (b[i].times(c[j]), b[j].times(c[i]));
        p.plus(Pair { hi: -q.hi, lo: -q.lo })
    };
    let mut d = a[0].times(minor(1, 2)).plus(a[1].times(minor(2, 0))).plus(a[2].times(minor(0, 1)));
    if front {
        d = Pair { hi: -d.hi, lo: -d.lo };
    }
    let s: [Pair; 3] = std::array::from_fn(|i| two_sum(a[i].hi, b[i].hi).plus(Pair::of(a[i].lo + b[i].lo)).plus(c[i]));
    for i in 0..3 {
        sums[i] = sums[i].plus(d.times(s[i]));
    }
    for (sum, [i, j]) in sums[3..].iter_mut().zip(PAIRS) {
        let q = a[i].times(a[j]).plus(b[i].times(b[j])).plus(c[i].times(c[j])).plus(s[i].times(s[j]));
        *sum = sum.plus(q.times(d));
    }
}

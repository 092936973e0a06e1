//! Points of a simplex where linear functions vanish that are given by their values at its corners (section 5 of the networks paper): on an
//! edge one function, in a triangle two, in a tetrahedron three. The weights of the corners are the minors of the rows of values.
//!
//! Invariant: rows are functions, or exact differences of two; together they vanish in one point of the open simplex.
//! Where that fails the result is unspecified (no panic). Cost: as for other symbolic points (`round.rs`).

use super::Sign;
use super::interpolate;
use super::points::{Shape, Symbolic};
use super::ring::{Kernel, Ring, cross};
use super::rows::{Row, determinant_of_rows};
use super::types::{Linear, Zero};
use std::cmp::Ordering;

/// Where a function vanishes between two corners.
#[derive(Clone, Copy, Debug)]
pub struct OnEdge<'a> {
    pub corners: [[f64; 3]; 2],
    pub row: Row<'a, 2>,
}

/// Where two functions vanish in a triangle.
#[derive(Clone, Copy, Debug)]
pub struct InTriangle<'a> {
    pub corners: [[f64; 3]; 3],
    pub rows: [Row<'a, 3>; 2],
}

/// Where three functions vanish in a tetrahedron.
#[derive(Clone, Copy, Debug)]
pub struct InTetrahedron<'a> {
    pub corners: [[f64; 3]; 4],
    pub rows: [Row<'a, 4>; 3],
}

/// An axis along which all corners agree.
#[inline(always)]
fn common<const M: usize>(corners: &[[f64; 3]; M], axis: usize) -> Option<(f64, f64)> {
    corners.iter().all(|c| c[axis] == corners[0][axis]).then_some((corners[0][axis], 1.0))
}

impl Symbolic for OnEdge<'_> {
    fn shape<K: Kernel>(&self, k: &K) -> Shape<K::N> {
        let [v, w] = k.row(&self.row);
        // The weight of each end is the value at the other one, up to the sign that makes v + w the denominator.
        Shape::Two([w.negated(), v], [k.point(&self.corners[0]), k.point(&self.corners[1])])
    }
    #[inline(always)]
    fn plain(&self, axis: usize) -> Option<(f64, f64)> {
        common(&self.corners, axis)
    }
    #[inline(always)]
    fn quick(&self, open: &[bool; 3]) -> [Option<f64>; 3] {
        interpolate::between(&self.corners[0], &self.corners[1], &self.row, open)
    }
}

impl Symbolic for InTriangle<'_> {
    fn shape<K: Kernel>(&self, k: &K) -> Shape<K::N> {
        let w = cross(&k.row(&self.rows[0]), &k.row(&self.rows[1]));
        let [a, b, c] = &self.corners;
        Shape::Three(w, [k.point(a), k.point(b), k.point(c)])
    }
    fn plain(&self, axis: usize) -> Option<(f64, f64)> {
        common(&self.corners, axis)
    }
    fn quick(&self, open: &[bool; 3]) -> [Option<f64>; 3] {
        interpolate::within(&self.corners, &self.rows, open)
    }
}

impl Symbolic for InTetrahedron<'_> {
    fn shape<K: Kernel>(&self, k: &K) -> Shape<K::N> {
        let [p, q, r] = self.rows.map(|row| k.row(&row));
        // Minors of the last two rows, then of all three without one column, with alternating signs.
        let m = |i: usize, j: usize| K::N::minor(&q[i], &q[j], &r[i], &r[j]);
        let minor = |i: usize, j: usize, l: usize| {
            p[i].times(&m(j, l)).minus(&p[j].times(&m(i, l))).plus(&p[l].times(&m(i, j)))
        };
        let w = [minor(1, 2, 3), minor(0, 2, 3).negated(), minor(0, 1, 3), minor(0, 1, 2).negated()];
        let [a, b, c, d] = &self.corners;
        Shape::Four(w, [k.point(a), k.point(b), k.point(c), k.point(d)])
    }
    fn plain(&self, axis: usize) -> Option<(f64, f64)> {
        common(&self.corners, axis)
    }
    fn quick(&self, _: &[bool; 3]) -> [Option<f64>; 3] {
        [None; 3]
    }
}

impl Linear {
    /// The values at the first `M` corners, 4 at most.
    #[inline]
    pub fn row<const M: usize>(&self) -> Row<'_, M> {
        const { assert!(M <= 4) };
        let (first, second) = (self.first.first_chunk().expect("M <= 4"), self.second.first_chunk().expect("M <= 4"));
        if second.iter().all(|&x| x == 0.0) { Row::Values(first) } else { Row::Difference(first, second) }
    }
}

impl Symbolic for Zero {
    fn shape<K: Kernel>(&self, k: &K) -> Shape<K::N> {
        let ([a, b, c, d], [p, q, r]) = (self.corners, &self.functions);
        match self.dim {
            0 => Shape::One(k.point(&a)),
            1 => OnEdge { corners: [a, b], row: p.row() }.shape(k),
            2 => InTriangle { corners: [a, b, c], rows: [p.row(), q.row()] }.shape(k),
            _ => InTetrahedron { corners: [a, b, c, d], rows: [p.row(), q.row(), r.row()] }.shape(k),
        }
    }
    fn plain(&self, axis: usize) -> Option<(f64, f64)> {
        let [first, rest @ ..] = &self.corners;
        rest[..self.dim.min(3) as usize].iter().all(|c| c[axis] == first[axis]).then_some((first[axis], 1.0))
    }
    fn quick(&self, open: &[bool; 3]) -> [Option<f64>; 3] {
        let ([a, b, c, _], [p, q, _]) = (self.corners, &self.functions);
        match self.dim {
            1 => OnEdge { corners: [a, b], row: p.row() }.quick(open),
            2 => InTriangle { corners: [a, b, c], rows: [p.row(), q.row()] }.quick(open),
            _ => [None; 3],
        }
    }
}

/// Both functions change sign between the ends of an edge: compares where, from the first end to the second.
///
/// The zero of f is at t = f₀/(f₀ − f₁); the difference of two such is g₀f₁ − f₀g₁ over the product of the two denominators, which have
/// the signs of f₀ and g₀.
pub fn compare_zeros(f: &Row<'_, 2>, g: &Row<'_, 2>) -> Ordering {
    let d = determinant_of_rows(&[*g, *f]);
    if d.is_zero() {
        return Ordering::Equal;
    }
    (d * first_sign(f) * first_sign(g)).to_ordering()
}

/// The sign of a function at the first end. (The rounded difference of two doubles has the sign of the exact one.)
#[inline(always)]
fn first_sign(row: &Row<'_, 2>) -> Sign {
    match row {
        Row::Values(v) => Sign::of(v[0]),
        Row::Difference(a, b) => Sign::of(a[0] - b[0]),
        Row::Ones => Sign::Positive,
    }
}

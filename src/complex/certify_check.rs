//! The exact check of a triangulated complex on doubles: the coordinates as they are, each the exact number that it is.
//!
//! A defect is one of
//! - a triangle without area (two corners with equal coordinates, or three on a line): none is permitted, since what lies
//!   along its longest side would meet the other two sides;
//! - two triangles that meet outside what they share by index, be it of one face, of two, or of two parts of the surface.
//!   Vertices with equal coordinates show here: the triangles around them meet;
//! - a shell whose signed volume does not have its sign (outer positive, void negative): inverted or flat.
//!
//! Without any, every shell is an embedded surface around its inside, so each cell has winding number 1 inside and 0
//! outside; these add up to that of the solid's surface, which is embedded as well, so no two cells overlap. So it is enough
//! to ask about pairs that bound one cell, or the outside: two triangles without a common cell that met would have
//! two cells overlap.
//!
//! Only `marked` triangles are asked: those with a vertex that may not be where the exact one is, and those that exact
//! geometry does not have. Two others meet as in the exact complex, which is right already. Nor are pairs asked that bound only
//! cells which are seen whole from a point inside ([`star_shaped`]): most cells, and all boxes.
//! Cost: some nanoseconds per triangle for that; a box hierarchy over the other triangles; then some five pairs per marked one,
//! nearly all of which a filter decides.

use super::exact_values::{lowest_exponent, triangle_cone};
use crate::base::{CellId, TriangleId, VertexId};
use crate::exact::Sign;
use crate::mesh::bvh::Bvh;
use crate::mesh::projection::collinear;
use crate::mesh::self_intersection::contact;
use rayon::prelude::*;
use rug::Integer;

/// Pairs that wait to be decided in parallel.
const BATCH: usize = 1 << 16;

/// A triangulated complex on doubles, or a part of one.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    pub coords: &'a [[f64; 3]],
    pub triangles: &'a [[VertexId; 3]],
    /// False for triangles that are not there.
    pub alive: &'a [bool],
    /// Those of which one takes part in every defect; alive.
    pub marked: &'a [bool],
    /// The cells behind and before each triangle, `NONE` for the outside. Empty: all pairs are asked about.
    pub sides: &'a [[CellId; 2]],
    /// Cells within which nothing meets. Empty: none.
    pub proven: &'a [bool],
}

impl Surface<'_> {
    /// Whether this cell, or the outside, has to be asked about.
    pub fn is_open(&self, k: CellId) -> bool {
        k.is_none() || !self.proven.get(k.at()).is_some_and(|p| *p)
    }

    /// Whether two triangles bound one cell, or the outside, that has to be asked about.
    #[inline]
    fn related(&self, a: TriangleId, b: TriangleId) -> bool {
        if self.sides.is_empty() {
            return true;
        }
        let other = &self.sides[b.at()];
        self.sides[a.at()].iter().any(|k| other.contains(k) && self.is_open(*k))
    }
}

/// Whether all triangles of a cell, which face outward, are seen from their middle with their inside, certainly and even if
/// every corner moves by half an ulp of `size`, the largest |coordinate| of all.
///
/// Then the cell is star-shaped, so its triangles meet only as they share corners, have area, and enclose a positive volume: on the
/// way from the exact corners to the rounded ones no triangle passes the point, so it keeps the winding number of the exact
/// cell there, 0 or 1; every triangle covers a positive part of the sphere around the point, so it is 1; and
/// then no direction is covered twice.
///
/// With u = 2⁻⁵³, M = `size` and D the largest difference to the point in a triangle (at most 2M), a difference is off by 3uM in
/// all; a determinant changes by 9·2D² times that, and its evaluation adds 10u·6D³: together below 256uMD², with room for higher
/// orders. Underflow is excluded by magnitude.
pub fn star_shaped(coords: &[[f64; 3]], size: f64, triangles: impl Iterator<Item = [VertexId; 3]> + Clone) -> bool {
    let (mut o, mut n) = ([0.0f64; 3], 0.0);
    for v in triangles.clone().flatten() {
        for i in 0..3 {
            o[i] += coords[v.at()][i];
        }
        n += 1.0;
    }
    let o = o.map(|x| x / n);
    for t in triangles {
        let [a, b, c] = t.map(|v| std::array::from_fn::<f64, 3, _>(|i| coords[v.at()][i] - o[i]));
        let d = a.iter().chain(&b).chain(&c).fold(0.0f64, |m, x| m.max(x.abs()));
        let det = a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        let bound = 128.0 * f64::EPSILON * size * d * d;
        // Also false for NaN.
        if !(det > bound && bound > 1e-250) {
            return false;
        }
    }
    true
}

/// Whether the three corners are on one line, exactly.
pub fn degenerate(coords: &[[f64; 3]], t: &[VertexId; 3]) -> bool {
    let [a, b, c] = t.map(|v| &coords[v.at()]);
    collinear(a, b, c)
}

/// Whether the boxes of two triangles do not meet. (Those of the hierarchy are wider.)
#[inline]
pub fn apart(coords: &[[f64; 3]], p: &[VertexId; 3], q: &[VertexId; 3]) -> bool {
    let of = |t: &[VertexId; 3], i: usize| {
        let x = t.map(|v| coords[v.at()][i]);
        (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]))
    };
    (0..3).any(|i| {
        let ((a, b), (c, d)) = (of(p, i), of(q, i));
        b < c || d < a
    })
}

/// The marked triangles without area, each twice, and the pairs with a marked triangle that meet outside what they share by index,
/// lower id first; all sorted. A triangle without area has no plane to ask about and is in no pair.
pub fn contacts(s: &Surface, bvh: &Bvh) -> Vec<[TriangleId; 2]> {
    let is_flat = |t: &usize| s.marked[*t] && degenerate(s.coords, &s.triangles[*t]);
    let flat: Vec<TriangleId> =
        (0..s.triangles.len()).into_par_iter().with_min_len(4096).filter(is_flat).map(TriangleId::of).collect();
    let mut found: Vec<[TriangleId; 2]> = flat.iter().map(|&t| [t, t]).collect();
    let decide = |pairs: &mut Vec<[TriangleId; 2]>, found: &mut Vec<[TriangleId; 2]>| {
        let meet = |p: &&[TriangleId; 2]| {
            !p.iter().any(|t| flat.binary_search(t).is_ok())
                && contact(s.coords, &s.triangles[p[0].at()], &s.triangles[p[1].at()])
        };
        found.par_extend(pairs.par_iter().with_min_len(512).filter(meet).map(|&[a, b]| [a.min(b), a.max(b)]));
        pairs.clear();
    };
    let mut pairs = Vec::with_capacity(BATCH);
    bvh.meeting_marked_pairs(s.marked, |a, b| {
        let [p, q] = [a, b].map(|t| &s.triangles[t.at()]);
        if s.alive[a.at()] && s.alive[b.at()] && s.related(a, b) && !apart(s.coords, p, q) {
            pairs.push([a, b]);
            if pairs.len() == BATCH {
                decide(&mut pairs, &mut found);
            }
        }
        true
    });
    decide(&mut pairs, &mut found);
    found.sort_unstable();
    found
}

/// The sign of the volume that oriented triangles enclose. Cost: a few nanoseconds per triangle, about a microsecond
/// where the bound does not decide.
///
/// Relative to the first corner, with each difference rounded, a determinant is within 10u of its permanent (as in
/// `exact::orient3d`); adding n of them adds nu of the sum of magnitudes, which are below the permanents. All of that
/// is doubled. Sums that are subnormal or infinite are not trusted.
pub fn volume_sign(coords: &[[f64; 3]], triangles: impl Iterator<Item = [VertexId; 3]> + Clone) -> Sign {
    let mut origin = None;
    let (mut sum, mut size, mut n) = (0.0f64, 0.0f64, 0.0f64);
    for t in triangles.clone() {
        let o: [f64; 3] = *origin.get_or_insert(coords[t[0].at()]);
        let [a, b, c] = t.map(|v| std::array::from_fn::<f64, 3, _>(|i| coords[v.at()][i] - o[i]));
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            let (x, y) = (b[j] * c[k], b[k] * c[j]);
            sum += a[i] * (x - y);
            size += a[i].abs() * (x.abs() + y.abs());
        }
        n += 3.0;
    }
    let bound = 2.0 * (10.0 + n) * (f64::EPSILON / 2.0) * size;
    if size > 1e-280 && size < 1e300 && sum.abs() > bound {
        return Sign::of(sum);
    }
    exact_volume_sign(coords, triangles)
}

#[cold]
fn exact_volume_sign(coords: &[[f64; 3]], triangles: impl Iterator<Item = [VertexId; 3]> + Clone) -> Sign {
    let exponent = lowest_exponent(triangles.clone().flatten().flat_map(|v| coords[v.at()]));
    let mut sum = Integer::new();
    for t in triangles {
        sum += triangle_cone(&t.map(|v| coords[v.at()]), exponent);
    }
    match sum.cmp0() {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

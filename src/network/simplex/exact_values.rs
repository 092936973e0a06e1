//! Exact values on demand, as rationals: barycentric coordinates of vertices, and volumes of cells as parts of the simplex (areas in a
//! triangle). No geometry is needed: barycentric coordinates are all that functions know.
//!
//! A vertex is the null vector of its encoding's forms on its carrier, by minors (equation 4 of the paper); a cell is the sum of
//! cones over its faces from corner 0, by determinants of the coordinates of the other corners. Cost: some microseconds for a
//! vertex and for a corner of a face.

use super::data::{Kind, LocalCell, LocalVertex, SimplexComplex};
use crate::complex::exact_values::tree_sum;
use rug::Rational;

/// Barycentric coordinates, one per corner of the simplex; the last is 0 in a triangle.
pub type Barycentric = [Rational; 4];

fn of(x: f64) -> Rational {
    // Only values that were found to be finite are converted.
    Rational::from_f64(x).unwrap_or_default()
}

fn product(a: &Rational, b: &Rational) -> Rational {
    Rational::from(a * b)
}

fn det3(a: [&Rational; 3], b: [&Rational; 3], c: [&Rational; 3]) -> Rational {
    let minor = |i: usize, j: usize| product(b[i], c[j]) - product(b[j], c[i]);
    product(a[0], &minor(1, 2)) - product(a[1], &minor(0, 2)) + product(a[2], &minor(0, 1))
}

/// A vertex; `values` are those that the complex was made of.
pub fn vertex(c: &SimplexComplex, values: &[f64], v: LocalVertex) -> Barycentric {
    let corners: Vec<usize> = c.vertex_carrier[v.at()].corners().collect();
    let d = corners.len() - 1;
    let code = c.vertex_encoding[v.at()];
    let value = |k: usize, corner: usize| of(values[code[k].at() * (c.dim + 1) + corner]);
    let forms: Vec<Vec<Rational>> = match c.kind {
        Kind::Arrangement => (0..d).map(|k| corners.iter().map(|&i| value(k, i)).collect()).collect(),
        Kind::Interface => (1..=d).map(|k| corners.iter().map(|&i| value(k, i) - value(0, i)).collect()).collect(),
    };
    // The minor without a column, with the sign of the cofactor.
    let cofactor = |j: usize| -> Rational {
        let column: Vec<usize> = (0..=d).filter(|&i| i != j).collect();
        let row = |k: usize| -> [&Rational; 3] { std::array::from_fn(|i| &forms[k][column[i]]) };
        let minor = match d {
            0 => Rational::from(1),
            1 => forms[0][column[0]].clone(),
            2 => {
                let x = |k: usize, i: usize| &forms[k][column[i]];
                product(x(0, 0), x(1, 1)) - product(x(0, 1), x(1, 0))
            }
            _ => det3(row(0), row(1), row(2)),
        };
        if j % 2 == 1 { -minor } else { minor }
    };
    let x: Vec<Rational> = (0..=d).map(cofactor).collect();
    let sum = x.iter().fold(Rational::new(), |s, x| s + x);
    let mut all = Barycentric::default();
    for (corner, x) in corners.into_iter().zip(x) {
        all[corner] = x / &sum;
    }
    all
}

/// The volume of a cell, as a part of the simplex.
pub fn cell_volume(c: &SimplexComplex, values: &[f64], cell: LocalCell) -> Rational {
    let mut cones = Vec::new();
    for h in c.cell_faces.row(cell) {
        let ring: Vec<Barycentric> = c.face_vertices.row(h.face()).iter().map(|&v| vertex(c, values, v)).collect();
        let mut cone = |x: Rational| cones.push(if h.side() == 0 { x } else { -x });
        // Determinants of whole coordinates with corner 0 behind: all that is left of them are the minors without its column.
        if c.dim == 2 {
            let [a, b] = [&ring[0], &ring[1]];
            cone(product(&a[1], &b[2]) - product(&a[2], &b[1]));
        } else {
            let rest = |i: usize| -> [&Rational; 3] { std::array::from_fn(|k| &ring[i][k + 1]) };
            (2..ring.len()).for_each(|i| cone(-det3(rest(0), rest(i - 1), rest(i))));
        }
    }
    tree_sum(cones)
}

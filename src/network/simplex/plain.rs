//! The same constructions with the naive predicate: determinants evaluated in doubles, their signs believed. Compiled for the benchmark
//! of section 8.1 only (feature `plain-signs`), which shows what exactness is good for.
//!
//! Where believed signs leave no way to go on, the construction panics, and the benchmark counts that: a face with more or
//! fewer than two places where the function vanishes on its boundary, a section that does not close. What is left over
//! may still be no complex; whoever asks for it has to look.

use super::data::Scratch;
use super::work::Work;
use std::array::from_fn;

impl Scratch {
    /// Whether signs are those of doubles from now on.
    pub fn set_plain_signs(&mut self, plain: bool) {
        self.work.plain = plain;
    }
}

/// By the first row, as written.
fn determinant(n: usize, m: &[[f64; 4]; 4]) -> f64 {
    let minor = |a: usize, b: usize, i: usize, j: usize| m[a][i] * m[b][j] - m[a][j] * m[b][i];
    let three = |r: [usize; 3], c: [usize; 3]| {
        m[r[0]][c[0]] * minor(r[1], r[2], c[1], c[2]) - m[r[0]][c[1]] * minor(r[1], r[2], c[0], c[2])
            + m[r[0]][c[2]] * minor(r[1], r[2], c[0], c[1])
    };
    match n {
        1 => m[0][0],
        2 => minor(0, 1, 0, 1),
        3 => three([0, 1, 2], [0, 1, 2]),
        _ => {
            m[0][0] * three([1, 2, 3], [1, 2, 3]) - m[0][1] * three([1, 2, 3], [0, 2, 3])
                + m[0][2] * three([1, 2, 3], [0, 1, 3])
                - m[0][3] * three([1, 2, 3], [0, 1, 2])
        }
    }
}

fn sign(x: f64) -> i32 {
    (x > 0.0) as i32 - (x < 0.0) as i32
}

impl Work {
    /// The sign of the current function at a vertex: det(A')/det(A) of section 5.2, each in doubles.
    pub fn plain_sign(&mut self, v: u32) -> i32 {
        let vertex = self.vertices[v as usize];
        let sign = if vertex.size == 0 {
            // The summit is above everything.
            -1
        } else {
            let ids = vertex.functions();
            let n = vertex.size as usize;
            let mut corners = [0; 4];
            let mut rest = vertex.carrier;
            for c in &mut corners[..n] {
                *c = rest.trailing_zeros() as usize;
                rest &= rest - 1;
            }
            let row = |f: usize| -> [f64; 4] {
                from_fn(|k| match self.interface {
                    true => self.values[f][corners[k]] - self.values[ids[0] as usize][corners[k]],
                    false => self.values[f][corners[k]],
                })
            };
            let first = self.interface as usize;
            let mut m: [[f64; 4]; 4] = from_fn(|k| if k + 1 < n { row(ids[first + k] as usize) } else { [1.0; 4] });
            let below = determinant(n, &m);
            m[n - 1] = row(self.round as usize - 1);
            sign(determinant(n, &m)) * sign(below)
        };
        self.vertices[v as usize].mark = self.round << 2 | (sign + 1) as u32;
        if sign == 0 {
            self.zeros.push(v);
        }
        sign
    }

    /// A plane that does not hold a convex polygon meets its boundary in two places if it crosses, else at most in a vertex or an edge.
    pub fn refuse_ambiguous(&self, f: u32) {
        if !self.plain {
            return;
        }
        let face = self.faces[f as usize];
        let corners = &self.corners[face.at as usize..(face.at + face.len) as usize];
        let signs = || corners.iter().map(|c| self.known_sign(c[0]));
        let next = || signs().cycle().skip(1);
        let (positive, negative) = (signs().any(|s| s > 0), signs().any(|s| s < 0));
        let zeros = signs().filter(|s| *s == 0).count();
        let zero_edges = signs().zip(next()).filter(|(a, b)| *a == 0 && *b == 0).count();
        let cuts = signs().zip(next()).filter(|(a, b)| a * b < 0).count();
        let clear = match positive && negative {
            true => cuts + zeros == 2,
            false => !(positive || negative) || zeros < 2 || zeros == 2 && zero_edges == 1,
        };
        assert!(clear, "a face that is cut in other than two places");
    }

    /// A section has fewer corners than there are vertices.
    pub fn refuse_endless(&self, corners: usize) {
        assert!(!self.plain || corners <= self.vertices.len(), "a section that does not close");
    }
}

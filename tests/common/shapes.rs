//! Operands for arrangements: cubes whose sides are grids, geodesic spheres, and their images under rotations.
#![allow(dead_code)]

use super::Soup;
use super::random::Random;
use std::collections::HashMap;

/// Rows of a matrix.
pub type Matrix = [[f64; 3]; 3];

/// A third of it is a rotation that leaves nothing parallel to an axis.
pub const THREE_TURNS: Matrix = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]];

/// `matrix * x * scale + shift` for every vertex, in doubles.
pub fn moved(soup: &Soup, matrix: Matrix, scale: f64, shift: [f64; 3]) -> Soup {
    let image =
        |x: &[f64; 3]| std::array::from_fn(|i| (0..3).map(|k| matrix[i][k] * x[k]).sum::<f64>() * scale + shift[i]);
    Soup { vertices: soup.vertices.iter().map(image).collect(), triangles: soup.triangles.clone() }
}

pub fn shifted(soup: &Soup, shift: [f64; 3]) -> Soup {
    moved(soup, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], 1.0, shift)
}

/// A rotation, uniform among all, rounded.
pub fn rotation(random: &mut Random) -> Matrix {
    // A point of the unit ball in four dimensions, as a quaternion.
    let q = loop {
        let q: [f64; 4] = std::array::from_fn(|_| random.signed());
        let square: f64 = q.iter().map(|x| x * x).sum();
        if (0.01..1.0).contains(&square) {
            break q.map(|x| x / square.sqrt());
        }
    };
    let [w, x, y, z] = q;
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// The cube from `low` to `low + n * step` with n × n squares a side, each of two triangles.
pub fn grid_cube(n: i32, low: [f64; 3], step: f64) -> Soup {
    let mut soup = Soup::default();
    let mut numbers: HashMap<[i32; 3], i32> = HashMap::new();
    let mut number = |p: [i32; 3]| {
        *numbers.entry(p).or_insert_with(|| {
            soup.vertices.push(std::array::from_fn(|i| low[i] + step * f64::from(p[i])));
            soup.vertices.len() as i32 - 1
        })
    };
    for axis in 0..3 {
        for (at, outward) in [(0, false), (n, true)] {
            for i in 0..n {
                for j in 0..n {
                    let corner = |a: i32, b: i32| {
                        let mut p = [0; 3];
                        (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (at, i + a, j + b);
                        p
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(&mut number);
                    let pair = if outward { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                    soup.triangles.extend(pair);
                }
            }
        }
    }
    soup
}

/// An icosahedron with n² triangles for each face, on the unit sphere.
pub fn geodesic(n: i32) -> Soup {
    let (corners, faces) = super::icosphere::icosphere(0);
    let mut soup = Soup::default();
    let mut numbers: HashMap<Vec<(i32, i32)>, i32> = HashMap::new();
    for f in &faces {
        // The point with weights i, j, n - i - j; named by those corners that count.
        let mut number = |i: i32, j: i32| {
            let weights = [(f[0], n - i - j), (f[1], i), (f[2], j)];
            let mut name: Vec<(i32, i32)> = weights.into_iter().filter(|w| w.1 > 0).collect();
            name.sort_unstable();
            *numbers.entry(name.clone()).or_insert_with(|| {
                let x: [f64; 3] = std::array::from_fn(|k| {
                    name.iter().map(|&(v, w)| f64::from(w) * corners[v as usize][k]).sum::<f64>()
                });
                let r = x.iter().map(|c| c * c).sum::<f64>().sqrt();
                soup.vertices.push(x.map(|c| c / r));
                soup.vertices.len() as i32 - 1
            })
        };
        for i in 0..n {
            for j in 0..n - i {
                let [a, b, c] = [number(i, j), number(i + 1, j), number(i, j + 1)];
                soup.triangles.push([a, b, c]);
                if i + j + 2 <= n {
                    let d = number(i + 1, j + 1);
                    soup.triangles.push([b, d, c]);
                }
            }
        }
    }
    soup
}

//! The unit sphere as tests and benchmarks of grids take it.

use std::collections::HashMap;

/// An icosahedron with each triangle split in four `level` times, vertices on the unit sphere.
pub fn icosphere(level: usize) -> (Vec<[f64; 3]>, Vec<[i32; 3]>) {
    let t = (1.0 + 5f64.sqrt()) / 2.0;
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    for (a, b) in [(-1.0, t), (1.0, t), (-1.0, -t), (1.0, -t)] {
        vertices.push([a, b, 0.0]);
    }
    for (a, b) in [(-1.0, t), (1.0, t), (-1.0, -t), (1.0, -t)] {
        vertices.push([0.0, a, b]);
    }
    for (a, b) in [(t, -1.0), (t, 1.0), (-t, -1.0), (-t, 1.0)] {
        vertices.push([a, 0.0, b]);
    }
    let unit = |x: [f64; 3]| {
        let r = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
        x.map(|c| c / r)
    };
    vertices.iter_mut().for_each(|x| *x = unit(*x));
    let mut triangles: Vec<[i32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..level {
        let mut middles: HashMap<[i32; 2], i32> = HashMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for t in &triangles {
            let m = [0, 1, 2].map(|i| {
                let (a, b) = (t[i].min(t[(i + 1) % 3]), t[i].max(t[(i + 1) % 3]));
                *middles.entry([a, b]).or_insert_with(|| {
                    let (p, q) = (vertices[a as usize], vertices[b as usize]);
                    vertices.push(unit(std::array::from_fn(|k| p[k] + q[k])));
                    vertices.len() as i32 - 1
                })
            });
            finer.extend([[t[0], m[0], m[2]], [t[1], m[1], m[0]], [t[2], m[2], m[1]], m]);
        }
        triangles = finer;
    }
    (vertices, triangles)
}

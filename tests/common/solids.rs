//! Random closed meshes and random planes, degenerate on purpose.
#![allow(dead_code)]

use super::common::Soup;
pub use super::common::random::Random;
use lapidary::exact::Plane;

/// A random set of unit cubes of a lattice: components, voids, non-manifold edges and vertices by shared index; each square
/// is split along a random diagonal.
pub fn voxels(random: &mut Random, size: i32, fill: u64) -> Soup {
    let cell = |f: &[bool], p: [i32; 3]| {
        p.iter().all(|x| (0..size).contains(x)) && f[((p[2] * size + p[1]) * size + p[0]) as usize]
    };
    let mut filled: Vec<bool> = (0..size.pow(3)).map(|_| random.below(100) < fill).collect();
    filled[0] = true;
    let n = size + 1;
    let mut numbers = vec![-1; n.pow(3) as usize];
    let mut soup = Soup::default();
    for z in 0..size {
        for y in 0..size {
            for x in 0..size {
                let p = [x, y, z];
                if !cell(&filled, p) {
                    continue;
                }
                for axis in 0..3 {
                    for up in [0, 1] {
                        let mut q = p;
                        q[axis] += 2 * up - 1;
                        if cell(&filled, q) {
                            continue;
                        }
                        let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
                            let mut v = p;
                            v[axis] += up;
                            v[(axis + 1) % 3] += a;
                            v[(axis + 2) % 3] += b;
                            let i = ((v[2] * n + v[1]) * n + v[0]) as usize;
                            if numbers[i] < 0 {
                                numbers[i] = soup.vertices.len() as i32;
                                soup.vertices.push(v.map(f64::from));
                            }
                            numbers[i]
                        });
                        if up == 0 {
                            corners.reverse();
                        }
                        let k = random.below(2) as usize;
                        let c = |i: usize| corners[(i + k) % 4];
                        soup.triangles.extend([[c(0), c(1), c(2)], [c(0), c(2), c(3)]]);
                    }
                }
            }
        }
    }
    soup
}

/// Spheres of triangles over the octahedron, each triangle split in four `levels` times; vertices on integer directions.
pub fn ball(levels: usize) -> Soup {
    let mut s = Soup {
        vertices: vec![
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ],
        triangles: vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
    };
    for _ in 0..levels {
        let mut middles = std::collections::BTreeMap::new();
        let mut triangles = Vec::with_capacity(4 * s.triangles.len());
        for t in &s.triangles {
            let m = [0, 1, 2].map(|i| {
                let (a, b) = (t[i].min(t[(i + 1) % 3]), t[i].max(t[(i + 1) % 3]));
                *middles.entry([a, b]).or_insert_with(|| {
                    let [a, b] = [a, b].map(|v| s.vertices[v as usize]);
                    s.vertices.push(std::array::from_fn(|k| a[k] + b[k]));
                    s.vertices.len() as i32 - 1
                })
            });
            triangles.extend([[t[0], m[0], m[2]], [t[1], m[1], m[0]], [t[2], m[2], m[1]], m]);
        }
        s.triangles = triangles;
    }
    s
}

/// A star-shaped solid around the origin: fixed directions (small integers), each as long as `radius` says. Any positive
/// lengths are valid, if directions times lengths are exact.
pub fn star(levels: usize, mut radius: impl FnMut() -> f64) -> Soup {
    let mut s = ball(levels);
    for x in &mut s.vertices {
        let r = radius();
        *x = x.map(|x| x * r + 0.0);
    }
    s
}

/// A linear map.
pub fn mapped(mut s: Soup, rows: [[f64; 3]; 3]) -> Soup {
    for x in &mut s.vertices {
        *x = rows.map(|r| r[0] * x[0] + r[1] * x[1] + r[2] * x[2] + 0.0);
    }
    s
}

/// An integer map of positive determinant.
pub fn shear(random: &mut Random) -> [[f64; 3]; 3] {
    loop {
        let m: [[f64; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| random.within(2)));
        let minor = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
        if m[0][0] * minor(1, 2) + m[0][1] * minor(2, 0) + m[0][2] * minor(0, 1) > 0.0 {
            return m;
        }
    }
}

/// The plane through three points; exact for small integers. `None` on a line.
pub fn through(t: [[f64; 3]; 3]) -> Option<Plane> {
    let u: [f64; 3] = std::array::from_fn(|i| t[1][i] - t[0][i]);
    let v: [f64; 3] = std::array::from_fn(|i| t[2][i] - t[0][i]);
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let d = -(n[0] * t[0][0] + n[1] * t[0][1] + n[2] * t[0][2]);
    (n != [0.0; 3] && n.iter().all(|x| x.is_finite()) && d.is_finite()).then_some(Plane { n, d })
}

fn combined(p: &Plane, a: f64, q: &Plane, b: f64) -> Plane {
    Plane { n: std::array::from_fn(|i| a * p.n[i] + b * q.n[i]), d: a * p.d + b * q.d }
}

/// Random planes around a mesh: through vertices and triangles, of small integers, parallel, in pencils, coincident in another
/// scale, a step of the last place apart, of random doubles.
pub fn planes(random: &mut Random, s: &Soup, count: usize, doubles: bool) -> Vec<Plane> {
    let mut out: Vec<Plane> = Vec::new();
    while out.len() < count {
        let vertex = |r: &mut Random| s.vertices[r.below(s.vertices.len() as u64) as usize];
        let old = |r: &mut Random, out: &[Plane]| out[r.below(out.len() as u64) as usize];
        let kind = random.below(if doubles { 12 } else { 9 });
        let plane = match kind {
            0 | 1 => Some(Plane { n: [0; 3].map(|_| random.within(2)), d: random.within(6) / 2.0 }),
            2 => through([vertex(random), vertex(random), vertex(random)]),
            3 => {
                let t = s.triangles[random.below(s.triangles.len() as u64) as usize];
                through(t.map(|v| s.vertices[v as usize]))
            }
            // Through one vertex.
            4 => {
                let (x, n) = (vertex(random), [0; 3].map(|_| random.within(3)));
                Some(Plane { n, d: -(n[0] * x[0] + n[1] * x[1] + n[2] * x[2]) })
            }
            _ if out.is_empty() => None,
            // A pencil.
            5 | 6 => {
                let (p, q) = (old(random, &out), old(random, &out));
                Some(combined(&p, random.within(3), &q, random.within(3)))
            }
            7 => {
                let scale = [-1.0, 2.0, -3.0, 0.5, -2f64.powi(90), 2f64.powi(-90)][random.below(6) as usize];
                Some(combined(&old(random, &out), scale, &Plane::default(), 0.0))
            }
            8 => {
                let mut p = old(random, &out);
                p.d += random.within(2) * p.n.iter().fold(0.0, |m: f64, x| m.max(x.abs())) / 2.0;
                Some(p)
            }
            9 => Some(Plane { n: [0; 3].map(|_| random.signed()), d: random.signed() }),
            10 => {
                let mut p = old(random, &out);
                p.d = p.d.next_up();
                Some(p)
            }
            _ => {
                let mut p = old(random, &out);
                let i = random.below(3) as usize;
                p.n[i] = p.n[i].next_down();
                Some(p)
            }
        };
        out.extend(plane.filter(|p| p.n != [0.0; 3] && p.d.is_finite() && p.n.iter().all(|x| x.is_finite())));
    }
    out
}

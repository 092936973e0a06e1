//! Cuts of random small solids by random planes against an oracle in rationals that works from definitions alone
//! (`common/brute.rs`): points, edges, planes through points, volumes by sides, components, styles. Degenerate on purpose, in
//! every range of magnitude. `LAPIDARY_FUZZ=n` runs n rounds of each.

#[path = "common/brute.rs"]
mod brute;
mod common;
#[path = "common/solids.rs"]
mod solids;

use common::Soup;
use lapidary::base::{Run, VertexId};
use lapidary::complex::check::check_exact;
use lapidary::complex::{check, check_volumes};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::Plane;
use lapidary::mesh::{MeshInput, MeshOptions, TriMesh, build};
use solids::*;
use std::sync::Arc;

fn rounds(default: u64) -> u64 {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

/// Does a plane go through a vertex where the triangles are not one fan? There the Euler characteristic by umbrellas may
/// change (see `complex::euler`).
fn pinched(mesh: &TriMesh, planes: &[Plane]) -> bool {
    (0..mesh.vertices.len()).map(VertexId::of).any(|v| {
        let fan: Vec<_> = mesh.triangles.iter().filter(|t| t.contains(&v)).collect();
        let mut reached = vec![false; fan.len()];
        let mut stack = vec![0];
        while let Some(i) = stack.pop() {
            reached[i] = true;
            let shared = |j: &usize| fan[i].iter().filter(|w| fan[*j].contains(w)).count() == 2;
            let next: Vec<usize> = (0..fan.len()).filter(|j| !reached[*j] && shared(j)).collect();
            stack.extend(next);
        }
        let crossed = mesh.edge_uses.rows().zip(&mesh.edges).any(|(uses, e)| uses.len() > 2 && e.contains(&v));
        let x = brute::point(mesh.vertices[v.at()]);
        (crossed || reached.contains(&false)) && planes.iter().any(|p| brute::Flat::of(p).value(&x).is_zero())
    })
}

/// `Ok(false)`: not a valid mesh.
fn verify(soup: &Soup, planes: &[Plane], check_mesh: bool) -> Result<bool, String> {
    let tags: Vec<i32> = (0..soup.triangles.len() as i32).map(|t| 1000 - 7 * t).collect();
    let input = MeshInput { vertices: &soup.vertices, triangles: &soup.triangles, tags: Some(&tags) };
    let options = MeshOptions { check_self_intersection: check_mesh, ..Default::default() };
    let mesh = match build(&input, &options, &mut Run::quiet()) {
        Ok(mesh) => Arc::new(mesh),
        Err(_) if check_mesh => return Ok(false),
        Err(e) => return Err(format!("the mesh: {} {:?}", e.message, e.culprits)),
    };
    let result = cut(&mesh, planes, &CutOptions::default(), &mut Run::quiet()).map_err(|e| e.message)?;
    let c = &result.complex;
    check(c)?;
    check_volumes(c).or_else(|e| if e.contains("prime") { Ok(()) } else { Err(e) })?;
    if !pinched(&mesh, planes) {
        check_exact(c)?;
    }
    brute::compare(c, &result.plane_map, &brute::Oracle::new(&mesh, planes))?;
    Ok(true)
}

/// Runs rounds of a case each; reports the first failures with their input.
fn attack(seed: u64, count: u64, check_mesh: bool, mut case: impl FnMut(&mut Random) -> (Soup, Vec<Plane>)) {
    let mut failed = Vec::new();
    let mut valid = 0;
    for round in 0..count {
        let mut random = Random(seed.wrapping_mul(1 << 32).wrapping_add(round));
        let (soup, planes) = case(&mut random);
        let outcome = std::panic::catch_unwind(|| verify(&soup, &planes, check_mesh)).unwrap_or(Err("panic".into()));
        match outcome {
            Ok(good) => valid += good as u64,
            Err(message) => failed.push(format!(
                "round {round}: {message}\nvertices {:?}\ntriangles {:?}\nplanes {planes:?}",
                soup.vertices, soup.triangles
            )),
        }
    }
    let first: Vec<&String> = failed.iter().take(3).collect();
    assert!(
        failed.is_empty(),
        "{} of {count} failed:\n{}",
        failed.len(),
        first.iter().map(|s| s.as_str()).collect::<Vec<_>>().join("\n\n")
    );
    assert!(2 * valid > count, "only {valid} of {count} meshes are valid");
}

#[test]
fn cubes_on_a_lattice() {
    attack(1, rounds(60), false, |r| {
        let (size, fill) = (1 + r.below(3) as i32, 20 + r.below(75));
        let mut s = voxels(r, size, fill);
        if r.below(2) == 0 {
            let map = shear(r);
            s = mapped(s, map);
        }
        let count = 1 + r.below(6) as usize;
        let p = planes(r, &s, count, false);
        (s, p)
    });
}

/// Mesh vertices moved off the lattice, by doubles with all bits: nothing is coplanar any more, contacts stay.
#[test]
fn cubes_off_the_lattice() {
    attack(2, rounds(30), true, |r| {
        let (size, fill) = (1 + r.below(3) as i32, 20 + r.below(60));
        let mut s = voxels(r, size, fill);
        for x in &mut s.vertices {
            *x = x.map(|x| x + r.signed() * 0.15);
        }
        let count = 1 + r.below(5) as usize;
        let p = planes(r, &s, count, true);
        (s, p)
    });
}

/// Shells in shells, with other solids in the voids.
#[test]
fn nested_solids() {
    attack(3, rounds(30), false, |r| {
        let mut parts = Vec::new();
        let depth = 2 + r.below(3);
        for k in 0..depth {
            // Directions of one ball, radii in rings that do not meet: solid and void by turns.
            let low = (1 << (2 * (depth - k))) as f64;
            let part = star(1, || low + r.below(2) as f64 * low / 4.0);
            parts.push(if k % 2 == 0 { part } else { common::flipped(part) });
        }
        if r.below(2) == 0 {
            let far = common::cuboid([990.0, -1.0, -2.0], [992.0, 3.0, 4.0]);
            parts.push(far);
        }
        let s = common::together(&parts);
        let count = 1 + r.below(5) as usize;
        let p = planes(r, &s, count, false);
        (s, p)
    });
}

#[test]
fn stars() {
    attack(4, rounds(40), false, |r| {
        let s = match r.below(3) {
            0 => star(0, || (1 + r.below(4)) as f64),
            1 => star(1, || (1 + r.below(4)) as f64),
            _ => star(1, || (1.5 + r.signed()) as f32 as f64),
        };
        let doubles = r.below(2) == 0;
        let count = 1 + r.below(7) as usize;
        let p = planes(r, &s, count, doubles);
        (s, p)
    });
}

/// Many planes through few points and lines, inside, on and outside the surface.
#[test]
fn concurrent_planes() {
    attack(6, rounds(40), false, |r| {
        let s = match r.below(3) {
            0 => common::cube(-2.0, 2.0),
            1 => star(0, || (1 + r.below(4)) as f64),
            _ => {
                let mut s = voxels(r, 2, 70);
                s.vertices.iter_mut().for_each(|x| *x = x.map(|x| 2.0 * x - 2.0));
                s
            }
        };
        let knots: Vec<[f64; 3]> = (0..1 + r.below(2)).map(|_| [0; 3].map(|_| r.within(3) / 2.0)).collect();
        let mut p = Vec::new();
        for _ in 0..4 + r.below(6) {
            let knot = |r: &mut Random| knots[r.below(knots.len() as u64) as usize];
            let x = knot(r);
            let mut n = [0; 3].map(|_| r.within(2));
            if r.below(3) == 0 {
                // Along the line between the knots, or along an axis.
                let y = knots[knots.len() - 1];
                let d: [f64; 3] = if x == y { [0.0, 0.0, 1.0] } else { std::array::from_fn(|i| 2.0 * (y[i] - x[i])) };
                n = [n[1] * d[2] - n[2] * d[1], n[2] * d[0] - n[0] * d[2], n[0] * d[1] - n[1] * d[0]];
            }
            if n != [0.0; 3] {
                p.push(Plane { n, d: -(n[0] * x[0] + n[1] * x[1] + n[2] * x[2]) });
            }
        }
        (s, p)
    });
}

/// Normals and offsets at both ends of the exponents, against mesh coordinates near 1 and near the ends.
#[test]
fn planes_of_any_magnitude() {
    attack(7, rounds(15), false, |r| {
        let mut s = star(r.below(2) as usize, || (1 + r.below(4)) as f64);
        let k = [0, 0, 1, -1, 990, -990][r.below(6) as usize];
        let by = |x: f64, k: i32| x * 2f64.powi(k / 2) * 2f64.powi(k - k / 2);
        s.vertices.iter_mut().for_each(|x| *x = x.map(|x| by(x, k)));
        let mut p: Vec<Plane> = Vec::new();
        for _ in 0..1 + r.below(5) {
            let ends = |r: &mut Random| {
                [1e-300, 1e300, 1.0, 0.0, 5e-324, -f64::MAX, 1e-170, -1e150][r.below(8) as usize] * r.signed()
            };
            let mut n = [0; 3].map(|_| ends(r));
            let mut d = ends(r);
            match r.below(4) {
                // All of one magnitude.
                0 | 1 => {
                    let m = [-1000, -500, 500, 900][r.below(4) as usize];
                    n = [0; 3].map(|_| by(r.signed(), m));
                    d = by(r.signed(), (m + k).clamp(-1070, 1020));
                }
                // Nearly an old one.
                2 if !p.is_empty() => {
                    let q = p[r.below(p.len() as u64) as usize];
                    (n, d) = (q.n, q.d.next_up());
                    let i = r.below(3) as usize;
                    if r.below(2) == 0 {
                        n[i] = n[i].next_up();
                        d = q.d;
                    }
                }
                _ => {}
            }
            if n != [0.0; 3] && d.is_finite() && n.iter().all(|x| x.is_finite()) {
                p.push(Plane { n, d });
            }
        }
        (s, p)
    });
}

/// Coordinates of every magnitude in one mesh: a star of fixed directions is valid with any lengths.
#[test]
fn mixed_magnitudes() {
    let power = |r: &mut Random, low: i32, high: i32| {
        let k = low + r.below((high - low + 1) as u64) as i32;
        2f64.powi(k / 2) * 2f64.powi(k - k / 2)
    };
    attack(5, rounds(30), false, |r| {
        let (low, high) = [(-565, 498), (-40, 40), (-1070, -1000), (900, 1015)][r.below(4) as usize];
        let levels = r.below(2) as usize;
        let s = star(levels, || power(r, low, high));
        let mut p = Vec::new();
        for _ in 0..1 + r.below(4) {
            let x = s.vertices[r.below(s.vertices.len() as u64) as usize];
            let scale = power(r, -500, 0);
            let n = [0; 3].map(|_| r.within(2) * power(r, -30, 0) * scale);
            let d = match r.below(3) {
                0 => 0.0,
                1 => -n[0] * x[0],
                _ => n[1] * power(r, low, high) / 2.0,
            };
            if n != [0.0; 3] && d.is_finite() {
                p.push(Plane { n, d });
            }
        }
        (s, p)
    });
}

/// Mesh and planes scaled by powers of two, as far as all stays exact.
#[test]
fn scaled_to_the_ends() {
    let mut r = Random(77);
    let mut failed = Vec::new();
    let mut tried = 0;
    for round in 0..rounds(12) {
        let (size, fill) = (1 + r.below(2) as i32, 30 + r.below(60));
        let s = if round % 2 == 0 { voxels(&mut r, size, fill) } else { star(0, || (1 + r.below(3)) as f64) };
        let count = 1 + r.below(4) as usize;
        let p = planes(&mut r, &s, count, round % 3 == 0);
        for k in [-1070, -1022, -510, -170, 300, 510, 900, 1018] {
            for j in [0, -500, -1000, 900] {
                // In two steps, as 2^−1070 has no reciprocal.
                let by = |x: f64, k: i32| x * 2f64.powi(k / 2) * 2f64.powi(k - k / 2);
                let back = |x: f64, k: i32| by(by(x, k), -k) == x && by(x, k).is_finite();
                let exact = s.vertices.iter().flatten().all(|&x| back(x, k))
                    && p.iter().all(|p| p.n.iter().all(|&x| back(x, j)) && back(p.d, j + k));
                if !exact {
                    continue;
                }
                let scaled = Soup { vertices: s.vertices.iter().map(|x| x.map(|x| by(x, k))).collect(), ..s.clone() };
                let cuts: Vec<Plane> =
                    p.iter().map(|p| Plane { n: p.n.map(|x| by(x, j)), d: by(p.d, j + k) }).collect();
                tried += 1;
                let outcome = std::panic::catch_unwind(|| verify(&scaled, &cuts, false)).unwrap_or(Err("panic".into()));
                if let Err(message) = outcome {
                    failed.push(format!("round {round}, 2^{k}, planes 2^{j}: {message}; {scaled:?}; {cuts:?}"));
                }
            }
        }
    }
    assert!(tried > 20, "{tried}");
    assert!(failed.is_empty(), "{} of {tried} failed:\n{}", failed.len(), failed[..failed.len().min(3)].join("\n\n"));
}

/// The values of a plane at the two ends of a segment are finite, their difference is not.
#[test]
fn values_near_the_largest_double() {
    let p = [([1.0, 0.0, 0.0], -0.5), ([0.0, 1.0, 0.0], -0.5), ([0.0, 0.0, 8e307], 0.0), ([0.25, 0.0, 1.0], 1.0)];
    let p = p.map(|(n, d)| Plane { n, d });
    for reversed in [false, true] {
        let p = p.map(|p| if reversed { Plane { n: p.n.map(|x| -x), d: -p.d } } else { p });
        assert_eq!(verify(&common::cube(-2.0, 2.0), &p, false), Ok(true));
    }
}

//! Flat stars: vertices around which triangles certainly meet in common edges and the vertex alone. Nearly all pairs of triangles whose boxes meet are
//! neighbours on a smooth surface; those that share such a vertex need no further look.
//!
//! A star is flat if every edge at the vertex has two uses, one each way, and, seen along an axis, all its triangles turn the same way and go round the
//! vertex once. The uses chain the triangles to cycles. Each cycle of triangles that turn the same way goes round at least once, so there
//! is one cycle, and its triangles, seen as wedges of less than half a turn, tile the plane around the vertex. Two of them have a side in common
//! where they are neighbours, which is their common edge, else the vertex; and no triangle is seen from the side, so over each point seen there is one
//! point of it. Hence they meet in that edge or vertex alone.
//!
//! How often triangles go round: as often as one of them passes a half-line from the vertex, which is told by comparing coordinates. Only turns can be
//! uncertain, and then the star does not count as flat: that costs time, and nothing else depends on it.
//!
//! Invariant: what is gathered at a vertex does not depend on the order of triangles. Cost: three turns for a triangle, in doubles.

use crate::base::{EdgeId, TriangleId, VertexId};
use crate::exact::Sign;
use crate::mesh::TriMesh;
use crate::mesh::projection::{certain_turn, seen_along};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU16, Ordering};

/// One bit for each vertex: its star is flat.
pub struct FlatStars(Vec<u64>);

/// Vertices, triangles or edges in one task at least.
const LEAST: usize = 1 << 13;

/// What is known of a vertex, seen along three axes. Bits 0 to 5: some triangle does not turn in the positive, negative sense, axis by axis.
/// Bits 6 to 11: for each axis, how many triangles pass the half-line, 2 standing for more than one.
struct Seen(Vec<AtomicU16>);

/// No axis will do.
const HOPELESS: u16 = 0b11_1111;

impl Seen {
    /// Adds what one triangle tells: bits as above.
    #[inline(always)]
    fn add(&self, v: VertexId, bits: u16, alone: bool) {
        let place = &self.0[v.at()];
        let sum = |old: u16| {
            let mut new = old | bits & HOPELESS;
            for shift in [6, 8, 10] {
                let count = ((old >> shift & 3) + (bits >> shift & 3)).min(2);
                new = new & !(3 << shift) | count << shift;
            }
            new
        };
        let old = place.load(Ordering::Relaxed);
        if sum(old) == old {
            return;
        }
        if alone {
            place.store(sum(old), Ordering::Relaxed);
        } else {
            // Never fails: the closure always has an answer.
            let _ = place.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |old| Some(sum(old)));
        }
    }
}

/// Finds the flat stars of a mesh, of any quality.
pub fn flat_stars(mesh: &TriMesh) -> FlatStars {
    let seen = Seen((0..mesh.vertices.len()).into_par_iter().with_min_len(LEAST).map(|_| AtomicU16::new(0)).collect());
    let alone = rayon::current_num_threads() == 1;
    (0..mesh.triangles.len()).into_par_iter().with_min_len(LEAST).for_each(|t| {
        let corners = mesh.triangles[t];
        for (v, bits) in corners.into_iter().zip(told(&mesh.corners(TriangleId::of(t)))) {
            seen.add(v, bits, alone);
        }
    });
    (0..mesh.edges.len()).into_par_iter().with_min_len(LEAST).for_each(|e| {
        let paired = matches!(mesh.edge_uses.row(EdgeId::of(e)), [a, b] if a.forward() != b.forward());
        if !paired {
            mesh.edges[e].into_iter().for_each(|v| seen.add(v, HOPELESS, alone));
        }
    });
    let flat = |seen: &AtomicU16| {
        let bits = seen.load(Ordering::Relaxed);
        (0..3).any(|axis| bits >> (2 * axis) & 3 != 3 && bits >> (6 + 2 * axis) & 3 == 1)
    };
    let word = |seen: &[AtomicU16]| seen.iter().enumerate().fold(0, |word, (i, s)| word | (flat(s) as u64) << i);
    FlatStars(seen.0.par_chunks(64).with_min_len(LEAST / 64).map(word).collect())
}

/// What a triangle tells each of its corners.
#[inline(always)]
fn told(x: &[[f64; 3]; 3]) -> [u16; 3] {
    let mut bits = [0; 3];
    for axis in 0..3 {
        let (u, v) = seen_along(axis);
        let [a, b, c] = x;
        let turn = certain_turn(b[u] - a[u], b[v] - a[v], c[u] - a[u], c[v] - a[v]);
        let not = match turn {
            Some(Sign::Positive) => 0b10,
            Some(Sign::Negative) => 0b01,
            _ => 0b11,
        };
        for i in 0..3 {
            let (from, to, at) = (x[(i + 1) % 3][v], x[(i + 2) % 3][v], x[i][v]);
            bits[i] |= not << (2 * axis) | ((from < at && to >= at) as u16) << (6 + 2 * axis);
        }
    }
    bits
}

impl FlatStars {
    /// Whether two triangles share a corner with a flat star: then they have nothing in common but what they share by index.
    #[inline(always)]
    pub fn settle(&self, a: &[VertexId; 3], b: &[VertexId; 3]) -> bool {
        a.iter().any(|v| b.contains(v) && self.0[v.at() / 64] >> (v.at() % 64) & 1 != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Run;
    use crate::mesh::{MeshInput, MeshOptions, build};

    /// A closed fan around vertex 0 over a polygon in the plane z = 0, closed by an apex on the other side.
    fn double_fan(ring: &[[f64; 2]], top: f64) -> TriMesh {
        let n = ring.len() as i32;
        let mut vertices = vec![[0.0, 0.0, top], [0.0, 0.0, -8.0]];
        vertices.extend(ring.iter().map(|p| [p[0], p[1], 0.0]));
        let next = |i: i32| 2 + (i + 1) % n;
        let triangles: Vec<[i32; 3]> = (0..n).flat_map(|i| [[0, 2 + i, next(i)], [1, next(i), 2 + i]]).collect();
        let input = MeshInput { vertices: &vertices, triangles: &triangles, tags: None };
        build(&input, &MeshOptions::default(), &mut Run::quiet()).expect("a closed mesh")
    }

    fn flat(mesh: &TriMesh, v: usize) -> bool {
        flat_stars(mesh).0[v / 64] >> (v % 64) & 1 != 0
    }

    #[test]
    fn once_round_is_flat_and_twice_is_not() {
        let star = |turns: usize, n: usize| -> Vec<[f64; 2]> {
            (0..n).map(|i| std::f64::consts::TAU * (turns * i) as f64 / n as f64).map(|t| [t.cos(), t.sin()]).collect()
        };
        for n in [3, 4, 5, 7, 40] {
            let mesh = double_fan(&star(1, n), 8.0);
            assert!(flat(&mesh, 0) && flat(&mesh, 1), "{n}");
            // A dent is as flat as a tip.
            assert!(flat(&double_fan(&star(1, n), -4.0), 0), "{n}");
        }
        for (turns, n) in [(2, 5), (2, 7), (3, 7)] {
            let mesh = double_fan(&star(turns, n), 8.0);
            assert!(!flat(&mesh, 0) && !flat(&mesh, 1), "{turns} of {n}");
        }
    }

    #[test]
    fn what_turns_back_or_stands_upright_is_not_flat() {
        // The third corner lies behind the second, seen along any axis.
        let back = [[4.0, 0.0], [2.0, 4.0], [3.0, 2.0], [-4.0, 4.0], [-4.0, -4.0], [2.0, -4.0]];
        assert!(!flat(&double_fan(&back, 0.5), 0));
        // Axes through corners: passing the half-line counts once.
        let cross = [[4.0, 0.0], [0.0, 4.0], [-4.0, 0.0], [0.0, -4.0]];
        assert!(flat(&double_fan(&cross, 8.0), 0));
    }

    #[test]
    fn stars_with_edges_of_one_use_or_four_are_not_flat() {
        // Seen along z, corners 2 and 4 are in front of the triangles opposite to them.
        let vertices = [[0.0, 0.0, 0.0], [9.0, 0.0, 1.0], [4.0, 1.0, 9.0], [4.0, 8.0, 2.0], [4.0, 2.0, -9.0]];
        let tet = |a: i32, b: i32, c: i32, d: i32| [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        // Two tetrahedra that share the edge 0 - 1 and more.
        let triangles: Vec<[i32; 3]> = [tet(0, 1, 3, 2), tet(0, 3, 1, 4)].concat();
        let soup = crate::arrangement::soup::soup(
            &[crate::arrangement::Operand { vertices: &vertices, triangles: &triangles }],
            &mut Run::quiet(),
        );
        let soup = soup.expect("a soup");
        let stars: Vec<bool> = (0..5).map(|v| flat(&soup.mesh, v)).collect();
        assert_eq!(stars, [false, false, true, false, true]);
        // One triangle less: its edges are open.
        let triangles = &triangles[..7];
        let soup = crate::arrangement::soup::soup(
            &[crate::arrangement::Operand { vertices: &vertices, triangles }],
            &mut Run::quiet(),
        );
        assert!(soup.is_ok_and(|soup| !flat(&soup.mesh, 4) && flat(&soup.mesh, 2)));
    }
}

//! Faces triangulated and bridged: random faces with holes, slits, pinched and isolated vertices, seen along every axis.

#[path = "common/random.rs"]
mod random;

#[path = "common/complexes.rs"]
mod complexes;

use complexes::*;
use lapidary::base::{FaceId, VertexId};
use lapidary::complex::{Complex, FaceStyle, faces_as};
use lapidary::exact::Plane;
use random::Random;
use rug::Rational;
use std::collections::BTreeMap;

type Area = Rational;

/// Twice the signed area of triangle a, b, d along the face's normal, up to one positive factor per face.
fn area(c: &Complex, f: FaceId, [a, b, d]: [VertexId; 3]) -> Area {
    let [a, b, d] = [a, b, d].map(|v| coordinates(c, v));
    let n = match c.face_support[f.at()] {
        lapidary::complex::SupportId::Plane(p) => point(c.planes[p.at()].n),
        lapidary::complex::SupportId::Triangle(t) => {
            let k = c.mesh.corners(t).map(point);
            cross(&minus(&k[1], &k[0]), &minus(&k[2], &k[0]))
        }
        lapidary::complex::SupportId::Level(_) => unreachable!("a level in a cut by planes"),
    };
    dot(&n, &cross(&minus(&b, &a), &minus(&d, &a)))
}

fn polygon_area(c: &Complex, f: FaceId, loops: &[Vec<VertexId>]) -> Area {
    let mut sum = Area::new();
    for l in loops {
        for i in 1..l.len().saturating_sub(1) {
            sum += area(c, f, [l[0], l[i], l[i + 1]]);
        }
    }
    sum
}

fn directed(loops: &[Vec<VertexId>]) -> BTreeMap<[VertexId; 2], i32> {
    let mut sides = BTreeMap::new();
    for l in loops.iter().filter(|l| l.len() > 1) {
        for i in 0..l.len() {
            *sides.entry([l[i], l[(i + 1) % l.len()]]).or_insert(0) += 1;
        }
    }
    sides
}

/// Rows of each face in a style.
fn rows(c: &Complex, style: FaceStyle) -> Vec<Vec<Vec<VertexId>>> {
    let a = faces_as(c, style).expect("a valid face");
    let mut out = vec![Vec::new(); c.face_count()];
    for (i, f) in a.source_face.iter().enumerate() {
        out[f.at()].push(a.vertices[a.offsets[i] as usize..a.offsets[i + 1] as usize].to_vec());
    }
    out
}

/// All three styles of every face: positive triangles, the same area, the same boundary, every vertex used, inner sides
/// in pairs. (Positive triangles whose boundary is the face's and whose area is the face's cannot overlap.)
fn verify(name: &str, c: &Complex) {
    let (holes, bridged, triangles) =
        (rows(c, FaceStyle::Holes), rows(c, FaceStyle::Bridged), rows(c, FaceStyle::Triangulated));
    for f in (0..c.face_count()).map(FaceId::of) {
        let (holes, bridged, triangles) = (&holes[f.at()], &bridged[f.at()], &triangles[f.at()]);
        let whole = polygon_area(c, f, holes);
        let corners: usize = holes.iter().map(|l| l.len()).sum();
        let lone = holes.iter().filter(|l| l.len() == 1).count();
        // Bridged: one polygon, of the same area; each bridge adds two sides.
        assert_eq!(bridged.len(), 1, "{name}");
        let polygon = &bridged[0];
        assert_eq!(polygon.len(), corners + 2 * (holes.len() - 1) - lone, "{name}: sides of the bridged polygon");
        assert_eq!(polygon_area(c, f, bridged), whole, "{name}: area of the bridged polygon");
        let (before, mut after) = (directed(holes), directed(bridged));
        for (side, n) in &before {
            *after.get_mut(side).unwrap_or_else(|| panic!("{name}: a side got lost")) -= n;
        }
        after.retain(|_, n| *n != 0);
        assert_eq!(after.len(), 2 * (holes.len() - 1), "{name}: bridges");
        for ([a, b], n) in &after {
            assert!(*n == 1 && after.contains_key(&[*b, *a]), "{name}: a bridge that is not walked both ways");
        }
        // Triangulated.
        assert_eq!(triangles.len(), polygon.len() - 2, "{name}: number of triangles");
        let mut sum = Area::new();
        for t in triangles {
            let x = area(c, f, [t[0], t[1], t[2]]);
            assert!(x > 0, "{name}: a degenerate or inverted triangle {t:?}");
            sum += x;
        }
        assert_eq!(sum, whole, "{name}: area of the triangles");
        let mut sides = directed(triangles);
        for (side, n) in &before {
            *sides.entry(*side).or_insert(0) -= n;
        }
        // What is left are inner sides, once each way (a slit's sides are both boundary).
        for ([a, b], n) in &sides {
            assert!(*n >= 0 && sides.get(&[*b, *a]).copied().unwrap_or(0) == *n, "{name}: side {a:?} {b:?}");
        }
        let mut used: Vec<VertexId> = triangles.iter().flatten().copied().collect();
        let mut all: Vec<VertexId> = holes.iter().flatten().copied().collect();
        used.sort();
        used.dedup();
        all.sort();
        all.dedup();
        assert_eq!(used, all, "{name}: vertices used");
    }
}

#[test]
fn small_complexes() {
    for (name, c) in all() {
        verify(name, &c);
    }
}

/// Cells of a lattice, connected through sides without walls; its loops.
struct Lattice {
    size: i32,
    face: Vec<bool>,
    /// Walls inside the face: above cell (x, y), and right of it.
    wall: Vec<[bool; 2]>,
    lone: Vec<[i32; 2]>,
}

impl Lattice {
    fn random(size: i32, random: &mut Random, holes: u64, walls: u64) -> Self {
        let cells = (size * size) as usize;
        let mut l = Lattice {
            size,
            face: (0..cells).map(|_| random.below(100) >= holes).collect(),
            wall: (0..cells).map(|_| [random.below(100) < walls, random.below(100) < walls]).collect(),
            lone: Vec::new(),
        };
        // The connected part around the first filled cell, by flooding.
        let mut reached = vec![false; cells];
        let start = l.face.iter().position(|&f| f).unwrap();
        let mut stack = vec![[start as i32 % size, start as i32 / size]];
        reached[start] = true;
        while let Some([x, y]) = stack.pop() {
            for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let to = [x + dx, y + dy];
                let from = [x.min(to[0]), y.min(to[1])];
                if l.cell(to) && !l.wall[(from[1] * size + from[0]) as usize][dx.unsigned_abs() as usize] {
                    let at = (to[1] * size + to[0]) as usize;
                    if !reached[at] {
                        reached[at] = true;
                        stack.push(to);
                    }
                }
            }
        }
        l.face = reached;
        for y in 1..size {
            for x in 1..size {
                if random.below(10) == 0 && (0..4).all(|d| !l.side([x, y], d)) && l.cell([x, y]) {
                    l.lone.push([x, y]);
                }
            }
        }
        l
    }
    fn cell(&self, [x, y]: [i32; 2]) -> bool {
        (0..self.size).contains(&x) && (0..self.size).contains(&y) && self.face[(y * self.size + x) as usize]
    }
    /// Whether the side from lattice point p in direction d (east, north, west, south) has face on its left and is
    /// boundary or wall.
    fn side(&self, [x, y]: [i32; 2], d: usize) -> bool {
        let (left, right) = match d {
            0 => ([x, y], [x, y - 1]),
            1 => ([x - 1, y], [x, y]),
            2 => ([x - 1, y - 1], [x - 1, y]),
            _ => ([x, y - 1], [x - 1, y - 1]),
        };
        if !self.cell(left) {
            return false;
        }
        let from = [left[0].min(right[0]), left[1].min(right[1])];
        !self.cell(right) || self.wall[(from[1] * self.size + from[0]) as usize][d % 2]
    }
    /// Loops as orbits of "next": clockwise through the sector from the side on which one arrives. The outer loop first.
    fn loops(&self) -> Vec<Vec<[i32; 2]>> {
        let n = self.size + 1;
        let step = [[1, 0], [0, 1], [-1, 0], [0, -1]];
        let mut done = vec![[false; 4]; (n * n) as usize];
        let mut out: Vec<Vec<[i32; 2]>> = Vec::new();
        for start in (0..n * n).map(|i| [i % n, i / n]) {
            for first in 0..4 {
                let (mut p, mut d) = (start, first);
                if !self.side(p, d) || done[(p[1] * n + p[0]) as usize][d] {
                    continue;
                }
                let mut l = Vec::new();
                while !done[(p[1] * n + p[0]) as usize][d] {
                    done[(p[1] * n + p[0]) as usize][d] = true;
                    l.push(p);
                    p = [p[0] + step[d][0], p[1] + step[d][1]];
                    d = [1, 0, 3, 2].map(|turn| (d + turn) % 4).into_iter().find(|&d| self.side(p, d)).unwrap();
                }
                out.push(l);
            }
        }
        let area = |l: &Vec<[i32; 2]>| -> i32 {
            (0..l.len())
                .map(|i| {
                    let (a, b) = (l[i], l[(i + 1) % l.len()]);
                    a[0] * b[1] - a[1] * b[0]
                })
                .sum()
        };
        let outer = out.iter().position(|l| area(l) > 0).unwrap();
        out.swap(0, outer);
        out.extend(self.lone.iter().map(|p| vec![*p]));
        out
    }
    /// As a face in space: coordinate `axis` is a linear function of the other two.
    fn complex(&self, axis: usize, up: bool) -> Complex {
        let mut ids = BTreeMap::new();
        let mut points = Vec::new();
        let mut loops = Vec::new();
        for l in self.loops() {
            loops.push(
                l.iter()
                    .map(|&p| {
                        *ids.entry(p).or_insert_with(|| {
                            // Sheared, so that no two directions are parallel to an axis.
                            let (x, y) = ((7 * p[0] + 2 * p[1]) as f64, (5 * p[1] - 3 * p[0]) as f64);
                            let mut q = [0.0; 3];
                            let (u, v) =
                                if up { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
                            (q[u], q[v], q[axis]) = (x, y, 0.25 * x - 0.5 * y + 3.0);
                            points.push(q);
                            points.len() as u32 - 1
                        })
                    })
                    .collect::<Vec<u32>>(),
            );
        }
        let (u, v) = if up { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
        let s = if up { 1.0 } else { -1.0 };
        let mut n = [0.0; 3];
        (n[u], n[v], n[axis]) = (-0.25 * s, 0.5 * s, s);
        flat_face(&points, Plane { n, d: -3.0 * s }, &loops)
    }
}

#[test]
fn random_lattice_faces() {
    let mut random = Random(362436069);
    let (mut holes, mut lone) = (0, 0);
    for round in 0..600 {
        let size = 2 + random.below(9) as i32;
        let l = Lattice::random(size, &mut random, 5 + round % 30, [0, 10, 30][round as usize % 3]);
        let c = l.complex(round as usize % 3, round % 2 == 0);
        holes += c.face_loops[1] - 1;
        lone += l.lone.len();
        verify(&format!("lattice {round}"), &c);
    }
    println!("{holes} holes, {lone} of them isolated vertices");
    assert!(holes > 1000 && lone > 300);
}

/// Thousands of corners, holes and slits in one face.
#[test]
fn large_lattice_face() {
    let mut random = Random(521288629);
    let l = Lattice::random(90, &mut random, 15, 15);
    let c = l.complex(2, true);
    let start = std::time::Instant::now();
    faces_as(&c, FaceStyle::Triangulated).unwrap();
    let time = start.elapsed();
    println!("{} corners, {} loops: {time:?}", c.corner_vertices.len(), c.face_loops[1]);
    verify("large", &c);
}

/// A round hole: the worst case for ears, since few corners are convex and triangles are thin.
#[test]
fn round_hole() {
    let ring = |n: usize, r: f64| -> Vec<[f64; 3]> {
        (0..n)
            .map(|i| {
                let t = i as f64 / n as f64 * std::f64::consts::TAU;
                [(r * t.cos()).round(), (r * t.sin()).round(), 1.0]
            })
            .collect()
    };
    for n in [1000usize, 8000] {
        let mut points = vec![[-2e6, -2e6, 1.0], [2e6, -2e6, 1.0], [2e6, 2e6, 1.0], [-2e6, 2e6, 1.0]];
        points.extend(ring(n, 1e6));
        let hole: Vec<u32> = (4..points.len() as u32).rev().collect();
        let c = flat_face(&points, plane([0.0, 0.0, 1.0], -1.0), &[vec![0, 1, 2, 3], hole]);
        let start = std::time::Instant::now();
        faces_as(&c, FaceStyle::Triangulated).unwrap();
        println!("{n} corners around a hole: {:?}", start.elapsed());
        verify("round hole", &c);
    }
}

/// A convex face with straight angles on every side; no fan from one vertex does.
#[test]
fn straight_angles() {
    for per_side in 1..6 {
        let corners = [[0, 0], [12, 0], [12, 12], [0, 12]].map(|p: [i32; 2]| p.map(|x| x * 5));
        for sides in 1..16 {
            let mut points = Vec::new();
            for i in 0..4 {
                let (a, b) = (corners[i], corners[(i + 1) % 4]);
                let n = if sides >> i & 1 == 1 { per_side } else { 0 };
                for k in 0..=n {
                    let at = |j: usize| (a[j] * (n + 1 - k) + b[j] * k) as f64 / (n + 1) as f64;
                    points.push([at(0), at(1), 0.0]);
                }
            }
            let l: Vec<u32> = (0..points.len() as u32).collect();
            verify("straight", &flat_face(&points, plane([0.0, 0.0, 1.0], 0.0), &[l]));
        }
    }
    // A triangle with straight angles on two sides and one.
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 1.0, 0.0]];
    for start in 0..6 {
        let l: Vec<u32> = (0..6).map(|i| (i + start) % 6).collect();
        verify("triangle", &flat_face(&points, plane([0.0, 0.0, 1.0], 0.0), &[l]));
    }
}

/// Nothing but the points decides: labels and where loops start in memory do not.
#[test]
fn labels_change_nothing() {
    let mut random = Random(88675123);
    let l = Lattice::random(7, &mut random, 15, 10);
    let c = l.complex(1, true);
    let n = c.vertex_count() as u32;
    let relabel = |v: u32| (v * 5 + 3) % n;
    if n.is_multiple_of(5) {
        panic!("choose another factor");
    }
    let mut points = vec![[0.0; 3]; n as usize];
    for v in 0..n {
        points[relabel(v) as usize] = c.coords[v as usize];
    }
    let loops: Vec<Vec<u32>> =
        c.loops_of(FaceId(0)).map(|l| c.corners_of(l).map(|k| relabel(c.corner_vertices[k].0)).collect()).collect();
    let d = flat_face(&points, c.planes[0], &loops);
    for style in [FaceStyle::Bridged, FaceStyle::Triangulated] {
        let (a, b) = (faces_as(&c, style).unwrap(), faces_as(&d, style).unwrap());
        assert_eq!(
            a.vertices.iter().map(|v| relabel(v.0)).collect::<Vec<_>>(),
            b.vertices.iter().map(|v| v.0).collect::<Vec<_>>()
        );
    }
}

/// A face that contradicts itself is an error, not a hang.
#[test]
fn crossing_loops_are_an_error() {
    let points = [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    let c = flat_face(&points, plane([0.0, 0.0, 1.0], 0.0), &[vec![0, 1, 2, 3]]);
    assert!(faces_as(&c, FaceStyle::Triangulated).is_err());
    let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0], [5.0, 5.0, 0.0]];
    let c = flat_face(&points, plane([0.0, 0.0, 1.0], 0.0), &[vec![0, 1, 2, 3], vec![4]]);
    assert!(faces_as(&c, FaceStyle::Bridged).is_err());
}

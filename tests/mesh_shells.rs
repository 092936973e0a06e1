//! Components, shells at non-manifold edges and vertices, nesting, orientation, anchors.

mod common;
use common::*;
use lapidary::base::{DefectKind::*, EdgeId, ShellId, Status, TriangleId};
use lapidary::mesh::bvh::build_bvh;
use lapidary::mesh::ray::{RayStart, Scene};
use lapidary::mesh::shells::{WedgeScratch, wedge_mates};
use lapidary::mesh::{MeshOptions, TriMesh};
use rug::Rational;

fn built(soup: &Soup) -> TriMesh {
    let mesh = build_soup(soup, merging()).unwrap_or_else(|e| panic!("{e}"));
    mesh.check().unwrap();
    check_anchors(&mesh);
    mesh
}

fn wrong(soup: &Soup) -> Vec<i64> {
    let found = build_soup(soup, merging()).expect_err("wrong nesting").culprits;
    assert!(found.iter().all(|c| c.kind == WrongNesting), "{found:?}");
    found.iter().map(|c| c.ids[0]).collect()
}

/// Every anchor hits what the ray really hits first, by exact distances over all triangles, on its solid side.
fn check_anchors(mesh: &TriMesh) {
    let bvh = build_bvh(&mesh.vertices, &mesh.triangles);
    bvh.check().unwrap();
    let scene = Scene { vertices: &mesh.vertices, triangles: &mesh.triangles, bvh: &bvh };
    let exact = |x: [f64; 3]| x.map(|c| Rational::from_f64(c).unwrap());
    for (s, shell) in mesh.shells.iter().enumerate() {
        let Some(a) = shell.anchor else { continue };
        assert!(!shell.outer);
        assert_ne!(mesh.triangle_shell[a.hit.at()], ShellId::of(s));
        let corners = a.order.map(|i| exact(mesh.corners(a.from)[i as usize]));
        let k = Rational::from(a.k);
        let weights = [Rational::from(1), k.clone(), Rational::from(&k * &k)];
        let total = Rational::from(1) + &k + &weights[2];
        let x: [Rational; 3] = std::array::from_fn(|i| {
            let sum = (0..3).fold(Rational::new(), |s, c| s + Rational::from(&corners[c][i] * &weights[c]));
            sum / &total
        });
        let start = RayStart { from: a.from, order: a.order, k: a.k, axis: a.axis, positive: a.positive };
        // One by one: behind the first hit the ray may meet edges.
        let mut crossings = Vec::new();
        for t in (0..mesh.triangles.len()).map(TriangleId::of) {
            let _ = scene.crossings(&start, |u| t == u, &mut crossings);
        }
        let mut found: Vec<(Rational, TriangleId, bool)> = Vec::new();
        for c in crossings {
            let q = mesh.corners(c.triangle).map(exact);
            let minus = |a: &[Rational; 3], i: usize| Rational::from(&a[i] - &q[0][i]);
            let normal: [Rational; 3] = std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                minus(&q[1], j) * minus(&q[2], k) - minus(&q[1], k) * minus(&q[2], j)
            });
            let height = (0..3).fold(Rational::new(), |s, i| s + minus(&x, i) * &normal[i]);
            let distance = -height / &normal[a.axis] * if a.positive { 1 } else { -1 };
            assert!(distance > 0);
            found.push((distance, c.triangle, c.leaves));
        }
        let first = found.iter().min().unwrap();
        assert_eq!((first.1, first.2), (a.hit, true));
    }
}

/// Wedges around an axis: tetrahedra between the directions given by index, in twelfths of a turn (on a square, so that
/// coordinates are exact).
fn wedges_around(parts: &[(usize, usize)]) -> Soup {
    const RING: [[f64; 2]; 12] = [
        [4., 0.],
        [4., 2.],
        [2., 4.],
        [0., 4.],
        [-2., 4.],
        [-4., 2.],
        [-4., 0.],
        [-4., -2.],
        [-2., -4.],
        [0., -4.],
        [2., -4.],
        [4., -2.],
    ];
    let at = |i: usize| [RING[i % 12][0], RING[i % 12][1], 0.5];
    let solids = parts.iter().map(|&(a, b)| tetrahedron([[0.0; 3], at(a), at(b), [0.0, 0.0, 1.0]]));
    together(&solids.collect::<Vec<_>>())
}

#[test]
fn two_tetrahedra_sharing_a_vertex_or_an_edge() {
    let a = tetrahedron([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let b = tetrahedron([[0.0; 3], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]);
    let b = flipped(b);
    let at_vertex = built(&together(&[a.clone(), b]));
    assert_eq!((at_vertex.vertices.len(), at_vertex.shells.len(), at_vertex.component_count), (7, 2, 2));
    let c = tetrahedron([[0.0; 3], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]);
    let at_edge = built(&together(&[a, c]));
    assert_eq!((at_edge.vertices.len(), at_edge.edges.len()), (6, 11));
    assert_eq!((at_edge.shells.len(), at_edge.component_count), (2, 1));
}

#[test]
fn two_cubes_sharing_an_edge() {
    let mesh = built(&together(&[cube(0.0, 1.0), cuboid([1.0, 1.0, 0.0], [2.0, 2.0, 1.0])]));
    assert_eq!((mesh.vertices.len(), mesh.shells.len(), mesh.component_count), (14, 2, 1));
    assert_eq!(mesh.triangle_shell[..12], [ShellId(0); 12]);
    assert_eq!(mesh.triangle_shell[12..], [ShellId(1); 12]);
}

#[test]
fn wedges_at_an_edge_in_any_order() {
    // Five wedges, one of them wider than a quarter turn; rotated through the list so that every triangle comes first.
    let mut parts = [(0, 1), (2, 3), (4, 5), (6, 8), (9, 11)];
    for turn in 0..12 {
        parts.rotate_left(2);
        let turned: Vec<(usize, usize)> = parts.iter().map(|&(a, b)| (a + turn, b + turn)).collect();
        let mesh = built(&wedges_around(&turned));
        assert_eq!((mesh.shells.len(), mesh.component_count), (5, 1));
        let axis = (0..mesh.edges.len()).find(|&e| mesh.edge_uses.row(e).len() == 10).unwrap();
        let mut pairs = Vec::new();
        wedge_mates(&mesh, EdgeId::of(axis), &mut WedgeScratch::default(), &mut pairs);
        assert_eq!(pairs.len(), 5);
        for [back, fore] in pairs {
            assert!(!back.forward() && fore.forward());
            // A wedge is a tetrahedron of four consecutive triangles.
            assert_eq!(back.triangle.0 / 4, fore.triangle.0 / 4);
        }
    }
}

#[test]
fn wedges_wider_than_half_a_turn() {
    // A solid that fills all but two wedges: its four triangles at the axis make one shell.
    let hull = |a: usize, b: usize| wedges_around(&[(a, b)]);
    let void = flipped(together(&[hull(0, 1), hull(5, 7)]));
    let mesh = built(&together(&[cuboid([-9.0; 3], [9.0; 3]), void]));
    // Seen from the solid, the two voids touch along an edge, and the solid goes on between them on both sides.
    assert_eq!((mesh.shells.len(), mesh.component_count), (2, 2));
    assert!(mesh.shells[0].outer && !mesh.shells[1].outer);
}

#[test]
fn contradictory_wedges_do_not_hang() {
    // Coinciding and overlapping wedges: some answer, each time the same.
    for parts in [vec![(0, 2), (1, 3)], vec![(0, 3), (0, 3)], vec![(0, 4), (1, 2), (1, 2), (3, 5)]] {
        let soup = wedges_around(&parts);
        let first = build_soup(&soup, merging()).map(|m| format!("{m:?}")).map_err(|e| format!("{e:?}"));
        let second = build_soup(&soup, merging()).map(|m| format!("{m:?}")).map_err(|e| format!("{e:?}"));
        assert_eq!(first, second);
    }
}

#[test]
fn orientation_alternates_with_depth() {
    let shells: Vec<Soup> = (0..5).map(|i| cube(i as f64, 20.0 - i as f64)).collect();
    // Every choice of orientations; a shell is wrong if it goes against the one right around it.
    for choice in 0..32u32 {
        let parts: Vec<Soup> = shells
            .iter()
            .enumerate()
            .map(|(i, s)| if choice >> i & 1 == 0 { s.clone() } else { flipped(s.clone()) })
            .collect();
        let soup = together(&parts);
        let outer = |i: usize| choice >> i & 1 == 0;
        let expected: Vec<i64> =
            (0..5).filter(|&i| outer(i) == (i > 0 && outer(i - 1))).map(|i| 12 * i as i64).collect();
        if expected.is_empty() {
            let mesh = built(&soup);
            assert_eq!(mesh.shells.iter().map(|s| s.outer).collect::<Vec<_>>(), (0..5).map(outer).collect::<Vec<_>>());
        } else {
            assert_eq!(wrong(&soup), expected);
        }
    }
}

#[test]
fn an_inward_mesh_alone() {
    assert_eq!(wrong(&flipped(cube(0.0, 1.0))), [0]);
    // Beside a good one; the message names the shell.
    let soup = together(&[cube(0.0, 1.0), flipped(cube(2.0, 3.0))]);
    assert_eq!(wrong(&soup), [12]);
    let error = build_soup(&soup, MeshOptions::default()).unwrap_err();
    assert_eq!(error.status, Status::BadMesh);
    assert!(error.message.contains("the shell of triangle 12"), "{error}");
}

#[test]
fn voids_touching_each_other_and_the_wall() {
    // Two voids that share an edge; a third that shares a vertex with the wall (by merging).
    let voids = [
        cuboid([2.0; 3], [3.0; 3]),
        cuboid([3.0, 3.0, 2.0], [4.0, 4.0, 3.0]),
        tetrahedron([[0.0; 3], [1.0, 0.5, 0.5], [0.5, 1.0, 0.5], [0.5, 0.5, 1.0]]),
    ];
    let mut parts = vec![cube(0.0, 5.0)];
    parts.extend(voids.map(flipped));
    let mesh = built(&together(&parts));
    // The two voids that share an edge are one shell of the solid around them.
    assert_eq!(mesh.shells.iter().map(|s| s.outer).collect::<Vec<_>>(), [true, false, false]);
}

/// A ring of square section around an axis: 4 × `n` quads.
fn ring(n: usize, centre: [f64; 3], axis: usize, radius: f64, half: f64) -> Soup {
    let mut soup = Soup::default();
    for i in 0..n {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        for (dr, dz) in [(-half, -half), (half, -half), (half, half), (-half, half)] {
            let mut x = centre;
            x[(axis + 1) % 3] += (radius + dr) * angle.cos();
            x[(axis + 2) % 3] += (radius + dr) * angle.sin();
            x[axis] += dz;
            soup.vertices.push(x);
        }
    }
    for i in 0..n {
        let (a, b) = (4 * i as i32, 4 * ((i + 1) % n) as i32);
        for k in 0..4 {
            let l = (k + 1) % 4;
            soup.triangles.extend([[a + k, b + k, b + l], [a + k, b + l, a + l]]);
        }
    }
    soup
}

#[test]
fn a_chain_of_linked_voids() {
    // Each link's nearest surface is another link's in most directions: anchors must still lead out.
    let links: Vec<Soup> =
        (0..20).map(|i| flipped(ring(24, [1.2 * i as f64, 0.0, 0.0], 1 + i % 2, 1.0, 0.125))).collect();
    for order in [1, 3, 7, 19] {
        let mut parts: Vec<Soup> = (0..20).map(|i| links[i * order % 20].clone()).collect();
        if order == 19 {
            parts.reverse();
        }
        parts.push(cuboid([-5.0; 3], [30.0, 5.0, 5.0]));
        let mesh = built(&together(&parts));
        assert_eq!((mesh.shells.len(), mesh.component_count), (21, 21));
        // With the check: links do not touch.
        assert!(build_soup(&together(&parts), checking()).is_ok());
    }
}

#[test]
fn voids_in_front_of_each_other() {
    // The first void's lowest vertex is the tip of a spike; the middle of its flank lies behind the second void, whose
    // lowest wall lies behind the first one's hook. The nearest rays would make them hang on each other.
    let outline =
        [[0., 0.], [14., 0.], [14., 6.], [0.5, 6.], [0.5, 1.5], [1.5, 1.5], [1.5, 5.5], [12., 5.5], [12., 1.]];
    let inside = [[0, 1, 8], [1, 2, 8], [8, 2, 7], [7, 2, 6], [2, 3, 6], [3, 4, 6], [4, 5, 6]];
    let n = outline.len() as i32;
    let mut hooked = Soup::default();
    for z in [0.0, 1.0] {
        hooked.vertices.extend(outline.iter().map(|p| [p[0], p[1], z]));
    }
    for t in inside {
        hooked.triangles.extend([[t[0], t[2], t[1]], t.map(|i| i + n)]);
    }
    for (i, j) in (0..n).map(|i| (i, (i + 1) % n)) {
        hooked.triangles.extend([[i, j, j + n], [i, j + n, i + n]]);
    }
    let plate = cuboid([2.0, 0.3, 0.1], [3.0, 5.0, 0.9]);
    for parts in [[hooked.clone(), plate.clone()], [plate, hooked]] {
        let [a, b] = parts.map(flipped);
        let soup = together(&[cube(-30.0, 30.0), a, b]);
        assert!(build_soup(&soup, checking()).is_ok());
        built(&soup);
    }
}

/// xorshift.
fn random(seed: u64) -> impl FnMut(u64) -> u64 {
    let mut state = seed;
    move |n| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) % n
    }
}

#[test]
fn tangles_of_linked_voids() {
    // Coarse rings in any position, whose cheapest rays often hit one another in a circle.
    let mut r = random(0x9e37_79b9_7f4a_7c15);
    let mut tangles = 0;
    for _ in 0..3000 {
        let mut parts = vec![cube(-9.0, 9.0)];
        for _ in 0..2 + r(2) {
            let mut link = ring(3 + r(3) as usize, [0.0; 3], 2, 2.0, 0.25);
            // A shear of a rotation will do: nothing here needs right angles.
            let m: [[f64; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| r(17) as f64 / 8.0 - 1.0));
            let shift: [f64; 3] = std::array::from_fn(|_| r(17) as f64 / 4.0 - 2.0);
            let det = (0..3).fold(0.0, |s, i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                s + m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j])
            });
            if det == 0.0 {
                continue;
            }
            for v in &mut link.vertices {
                let x = *v;
                *v = std::array::from_fn(|i| m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2] + shift[i]);
            }
            parts.push(if det > 0.0 { flipped(link) } else { link });
        }
        let soup = together(&parts);
        if build_soup(&soup, checking()).is_ok() {
            built(&soup);
            tangles += 1;
        }
    }
    assert!(tangles > 100, "only {tangles} without contact");
}

#[test]
fn rays_through_edges_and_vertices_are_evaded() {
    // A grid of equal voids: rays from centroids line up with diagonals, edges and corners of others when k is unlucky.
    let mut parts = vec![cube(-1.0, 20.0)];
    for i in 0..216 {
        let (x, y, z) = ((i % 6) as f64 * 3.0, (i / 6 % 6) as f64 * 3.0, (i / 36) as f64 * 3.0);
        // An octahedron whose apexes lie on common lines with those of the others.
        let p = |dx: f64, dy: f64, dz: f64| [x + dx, y + dy, z + dz];
        let vertices = [p(1., 0., 0.), p(-1., 0., 0.), p(0., 1., 0.), p(0., -1., 0.), p(0., 0., 1.), p(0., 0., -1.)];
        let mut triangles = Vec::new();
        for (a, b) in [(0, 2), (2, 1), (1, 3), (3, 0)] {
            triangles.extend([[b, a, 4], [a, b, 5]]);
        }
        parts.push(Soup { vertices: vertices.iter().map(|v| v.map(|c| c + 0.5)).collect(), triangles });
    }
    let mesh = built(&together(&parts));
    assert_eq!(mesh.shells.iter().filter(|s| !s.outer).count(), 216);
}

#[test]
fn random_trees_of_boxes() {
    let mut random = random(0x2545_f491_4f6c_dd1d);
    for _ in 0..40 {
        // Each box is split into 2 × 2 × 2 cells, with children well inside some of them.
        let mut boxes: Vec<([f64; 3], f64, usize, Option<usize>)> = vec![([0.0; 3], 1024.0, 0, None)];
        let mut i = 0;
        while i < boxes.len() && boxes.len() < 60 {
            let (lo, size, depth, _) = boxes[i];
            for cell in 0..8 {
                if size > 8.0 && random(3) == 0 {
                    let child = std::array::from_fn(|k| lo[k] + size / 8.0 + (cell >> k & 1) as f64 * size / 2.0);
                    boxes.push((child, size / 4.0, depth + 1, Some(i)));
                }
            }
            i += 1;
        }
        // In any order.
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        for i in (1..order.len()).rev() {
            order.swap(i, random(i as u64 + 1) as usize);
        }
        let odd_one = (random(2) == 0).then(|| random(boxes.len() as u64) as usize);
        let outer = |b: usize| (boxes[b].2.is_multiple_of(2)) != (odd_one == Some(b));
        let part = |&b: &usize| {
            let (lo, size, ..) = boxes[b];
            let solid = cuboid(lo, lo.map(|c| c + size));
            if outer(b) { solid } else { flipped(solid) }
        };
        let soup = together(&order.iter().map(part).collect::<Vec<_>>());
        let mut expected: Vec<i64> = (0..boxes.len())
            .filter(|&b| outer(b) == boxes[b].3.is_some_and(outer))
            .map(|b| 12 * order.iter().position(|&o| o == b).unwrap() as i64)
            .collect();
        expected.sort();
        if expected.is_empty() {
            built(&soup);
        } else {
            assert_eq!(wrong(&soup), expected);
        }
    }
}

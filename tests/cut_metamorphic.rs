//! What must not change: permuting planes, triangles or vertices, the 48 symmetries of the cube, scaling by powers of two, and the
//! number of threads leave the cut the same (DESIGN §1): exact points, edges, loops, faces and cells compared as sets, volumes
//! bit by bit; arrays bit by bit for any number of threads.

mod common;

use common::models::{Case, permutation, small_cases as cases};
use lapidary::base::{CellId, FaceId, Run, VertexId};
use lapidary::complex::{Complex, moments};
use lapidary::cut::{CutOptions, cut};
use lapidary::exact::{Plane, rational};
use rug::Rational;
use std::collections::BTreeSet;
use std::sync::Arc;

fn cut_case(case: &Case) -> Complex {
    let mesh = Arc::new(common::build_soup(&case.soup, Default::default()).unwrap());
    cut(&mesh, &case.planes, &CutOptions::default(), &mut Run::quiet()).unwrap().complex
}

/// A face: its loops, each as the sorted set of its edges.
type Loops = Vec<Vec<[usize; 2]>>;

/// A complex without names: vertices are exact points in lexicographic order, everything else a set of what bounds it; cells
/// carry the bits of their volume.
#[derive(PartialEq, Eq, Debug)]
struct Nameless {
    points: Vec<[Rational; 3]>,
    edges: BTreeSet<[usize; 2]>,
    faces: BTreeSet<Loops>,
    cells: BTreeSet<(u64, Vec<Loops>)>,
}

/// `map` moves an exact point before it is named.
fn nameless(c: &Complex, map: impl Fn([Rational; 3]) -> [Rational; 3], volume_scale: f64) -> Nameless {
    let points: Vec<[Rational; 3]> = (0..c.vertex_count()).map(|v| map(rational(&c.point(VertexId::of(v))))).collect();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].cmp(&points[b]));
    let mut name = vec![0; points.len()];
    order.iter().enumerate().for_each(|(i, &v)| name[v] = i);
    let pair = |a: VertexId, b: VertexId| {
        let (a, b) = (name[a.at()], name[b.at()]);
        [a.min(b), a.max(b)]
    };
    let face = |f: FaceId| -> Loops {
        let mut loops: Vec<Vec<[usize; 2]>> = c
            .loops_of(f)
            .map(|l| {
                let corners = &c.corner_vertices[c.corners_of(l)];
                let next = |k: usize| corners[if k + 1 == corners.len() { 0 } else { k + 1 }];
                let mut edges: Vec<_> = (0..corners.len()).map(|k| pair(corners[k], next(k))).collect();
                edges.sort_unstable();
                edges
            })
            .collect();
        loops.sort();
        loops
    };
    let faces: Vec<_> = (0..c.face_count()).map(|f| face(FaceId::of(f))).collect();
    let volumes = moments(c).cell_volume;
    let cell = |i: usize| {
        let mut own: Vec<_> = c.cell_faces(CellId::of(i)).iter().map(|h| faces[h.face().at()].clone()).collect();
        own.sort();
        ((volumes[i] * volume_scale).to_bits(), own)
    };
    let result = Nameless {
        edges: c.edges.iter().map(|e| pair(e[0], e[1])).collect(),
        cells: (0..c.cell_count()).map(cell).collect(),
        faces: faces.iter().cloned().collect(),
        points: order.iter().map(|&v| points[v].clone()).collect(),
    };
    assert_eq!(
        (result.edges.len(), result.faces.len(), result.cells.len()),
        (c.edge_count(), c.face_count(), c.cell_count())
    );
    result
}

#[test]
fn permutations_change_nothing() {
    for case in cases() {
        let base = nameless(&cut_case(&case), |x| x, 1.0);
        let mut planes = case.clone();
        planes.planes = permutation(case.planes.len(), 1).iter().map(|&i| case.planes[i]).collect();
        assert!(nameless(&cut_case(&planes), |x| x, 1.0) == base, "{}: planes permuted", case.name);
        let mut triangles = case.clone();
        triangles.soup.triangles = permutation(case.soup.triangles.len(), 2)
            .iter()
            .enumerate()
            .map(|(k, &i)| {
                let mut t = case.soup.triangles[i];
                t.rotate_left(k % 3);
                t
            })
            .collect();
        assert!(nameless(&cut_case(&triangles), |x| x, 1.0) == base, "{}: triangles permuted", case.name);
        let mut vertices = case.clone();
        let order = permutation(case.soup.vertices.len(), 3);
        order.iter().enumerate().for_each(|(new, &old)| vertices.soup.vertices[new] = case.soup.vertices[old]);
        let mut inverse = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| inverse[old] = new as i32);
        vertices.soup.triangles.iter_mut().flatten().for_each(|v| *v = inverse[*v as usize]);
        assert!(nameless(&cut_case(&vertices), |x| x, 1.0) == base, "{}: vertices permuted", case.name);
    }
}

#[test]
fn coefficients_may_be_scaled_and_reversed() {
    for case in cases() {
        let base = nameless(&cut_case(&case), |x| x, 1.0);
        let mut other = case.clone();
        for (i, p) in other.planes.iter_mut().enumerate() {
            let s = [-1.0, 0.25, -1024.0][i % 3];
            *p = Plane { n: p.n.map(|n| n * s), d: p.d * s };
        }
        assert!(nameless(&cut_case(&other), |x| x, 1.0) == base, "{}: planes scaled", case.name);
    }
}

#[test]
fn symmetries_of_the_cube() {
    for case in cases() {
        let base = nameless(&cut_case(&case), |x| x, 1.0);
        for axes in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            for signs in 0..8u32 {
                let sign = |i: usize| if signs >> i & 1 == 1 { -1.0 } else { 1.0 };
                let map = |x: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| sign(i) * x[axes[i]]) };
                let mut other = case.clone();
                other.soup.vertices.iter_mut().for_each(|x| *x = map(*x));
                other.planes.iter_mut().for_each(|p| p.n = map(p.n));
                let odd = axes == [0, 2, 1] || axes == [2, 1, 0] || axes == [1, 0, 2];
                if odd != (signs.count_ones() % 2 == 1) {
                    other.soup = common::flipped(other.soup);
                }
                let back = |x: [Rational; 3]| {
                    let mut old = x.clone();
                    for i in 0..3 {
                        old[axes[i]] = if sign(i) < 0.0 { -x[i].clone() } else { x[i].clone() };
                    }
                    old
                };
                assert!(nameless(&cut_case(&other), back, 1.0) == base, "{}: axes {axes:?}, signs {signs}", case.name);
            }
        }
    }
}

#[test]
fn scaling_by_powers_of_two() {
    for case in cases() {
        let base = nameless(&cut_case(&case), |x| x, 1.0);
        for power in [200i32, -200] {
            let s = 2f64.powi(power);
            let mut other = case.clone();
            other.soup.vertices.iter_mut().flatten().for_each(|x| *x *= s);
            other.planes.iter_mut().for_each(|p| p.d *= s);
            let down = Rational::from_f64(1.0 / s).unwrap();
            // The cube of the scale is a power of two within range: volumes scale exactly.
            let volume = 2f64.powi(-3 * power);
            let scaled = nameless(&cut_case(&other), |x| x.map(|c| c * &down), volume);
            assert!(scaled == base, "{}: scaled by 2^{power}", case.name);
        }
    }
}

#[test]
fn threads_change_no_bit() {
    let bits = |c: &Complex| {
        let x: Vec<u64> = c.coords.iter().flatten().map(|x| x.to_bits()).collect();
        let m = moments(c);
        let values = [&m.cell_volume].into_iter().flatten().chain(m.cell_centroid.iter().flatten());
        let values = values.chain(m.face_area_vector.iter().flatten()).chain(m.face_centroid.iter().flatten());
        let y: Vec<u64> = values.map(|x| x.to_bits()).collect();
        (x, y)
    };
    for case in cases() {
        let mut results = [1, 2, 8].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let c = cut_case(&case);
                let b = bits(&c);
                (c, b)
            })
        });
        let [(a, a_bits), rest @ ..] = &mut results;
        for (b, b_bits) in rest {
            assert!(a_bits == b_bits, "{}: coordinates or moments", case.name);
            assert!(
                a.origins == b.origins && a.vertex_planes == b.vertex_planes && a.edges == b.edges,
                "{}",
                case.name
            );
            assert!(a.face_loops == b.face_loops && a.loop_offsets == b.loop_offsets, "{}", case.name);
            assert!(a.corner_vertices == b.corner_vertices && a.corner_edges == b.corner_edges, "{}", case.name);
            assert!(a.face_support == b.face_support && a.face_plane == b.face_plane, "{}", case.name);
            assert!(a.face_cells == b.face_cells && a.face_tag == b.face_tag, "{}", case.name);
            assert!(a.cell_shells == b.cell_shells && a.shell_faces == b.shell_faces, "{}", case.name);
            assert!(a.cell_component == b.cell_component, "{}", case.name);
        }
    }
}

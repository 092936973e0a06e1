//! Exact values on demand: coordinates, areas, volumes and centroids as rationals, and as canonical strings
//! ("num/den" in lowest terms with a positive denominator, integers without "/1"), which CGAL's and GMP's rationals read.
//!
//! Polygons are integrated in the projection along the largest component of their support's normal; the other two
//! components follow from the normal, which is input. Sums run over a balanced tree, so that a long sum costs its size
//! times a logarithm and not its square; triangles that no plane has cut are summed as integers on a common exponent.
//! Cost: some microseconds per corner.

use super::data::{Complex, HalfFace, Origin, SupportId};
use super::projection::{Projection, projection};
use crate::base::{CellId, FaceId, VertexId};
use crate::exact::{self, lift};
use crate::mesh::TriMesh;
use rug::{Integer, Rational};

/// Exact coordinates.
pub type Coordinates = [Rational; 3];

pub fn vertex(c: &Complex, v: VertexId) -> Coordinates {
    exact::rational(&c.point(v))
}

/// The exact coordinates of a vertex as canonical strings.
pub fn vertex_strings(c: &Complex, v: VertexId) -> [String; 3] {
    vertex(c, v).map(|x| x.to_string())
}

fn of(x: f64) -> Rational {
    // Only input is converted, and that is finite.
    Rational::from_f64(x).unwrap_or_default()
}

fn product(a: &Rational, b: &Rational) -> Rational {
    Rational::from(a * b)
}

/// Sums by halves: the numbers stay as small as their count allows.
pub fn tree_sum(mut terms: Vec<Rational>) -> Rational {
    while terms.len() > 1 {
        let half = terms.len().div_ceil(2);
        for i in 0..terms.len() - half {
            let last = terms.len() - 1;
            let x = terms.swap_remove(last);
            terms[i] += x;
        }
    }
    terms.pop().unwrap_or_default()
}

/// The normal of a support and its value n·x at any point of it.
pub(crate) fn support(c: &Complex, f: FaceId) -> (Coordinates, Rational) {
    let minus =
        |a: &Coordinates, b: &Coordinates| -> Coordinates { std::array::from_fn(|i| Rational::from(&a[i] - &b[i])) };
    let cross = |u: &Coordinates, v: &Coordinates| -> Coordinates {
        std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            product(&u[j], &v[k]) - product(&u[k], &v[j])
        })
    };
    let dot =
        |a: &Coordinates, b: &Coordinates| (0..3).map(|i| product(&a[i], &b[i])).fold(Rational::new(), |s, x| s + x);
    match c.face_support[f.at()] {
        SupportId::Plane(p) => {
            let p = &c.planes[p.at()];
            (p.n.map(of), -of(p.d))
        }
        SupportId::Triangle(t) => {
            let [a, b, d] = c.mesh.corners(t).map(|p| p.map(of));
            let n = cross(&minus(&b, &a), &minus(&d, &a));
            let value = dot(&n, &a);
            (n, value)
        }
        SupportId::Level(p) => {
            // The gradient times the determinant of the sides at a: see `exact::predicates::direction`.
            let g = &c.levels.supports[p.at()];
            let [a, b, d, e] = g.corners.map(|p| p.map(of));
            let f: [Rational; 4] = std::array::from_fn(|i| of(g.function.first[i]) - of(g.function.second[i]));
            let (u, v, w) = (minus(&b, &a), minus(&d, &a), minus(&e, &a));
            let rise: Coordinates = std::array::from_fn(|i| Rational::from(&f[i + 1] - &f[0]));
            let (vw, wu, uv) = (cross(&v, &w), cross(&w, &u), cross(&u, &v));
            let n: Coordinates = std::array::from_fn(|i| {
                product(&rise[0], &vw[i]) + product(&rise[1], &wu[i]) + product(&rise[2], &uv[i])
            });
            let value = dot(&n, &a) - dot(&u, &vw) * &f[0];
            (n, value)
        }
    }
}

/// Twice the area of a face as it appears in its projection (positive), and if wanted the sum of cross products
/// times (q + q'), whose sixth part is the first moment; both relative to the first corner, which is returned too.
fn integrate(c: &Complex, f: FaceId, pr: Projection, first: bool) -> (Rational, Coordinates, Coordinates) {
    let corners = c.face_corners(f);
    let origin = vertex(c, c.corner_vertices[corners.start]);
    let mut area = Vec::with_capacity(corners.len());
    let mut moments: [Vec<Rational>; 3] = Default::default();
    for l in c.loops_of(f) {
        let q: Vec<Coordinates> = c
            .corners_of(l)
            .map(|k| {
                let p = vertex(c, c.corner_vertices[k]);
                std::array::from_fn(|i| Rational::from(&p[i] - &origin[i]))
            })
            .collect();
        for i in 0..q.len() {
            let (a, b) = (&q[i], &q[(i + 1) % q.len()]);
            let cross = product(&a[pr.ax], &b[pr.ay]) - product(&a[pr.ay], &b[pr.ax]);
            if first {
                for axis in 0..3 {
                    moments[axis].push(Rational::from(&a[axis] + &b[axis]) * &cross);
                }
            }
            area.push(cross);
        }
    }
    (tree_sum(area), moments.map(tree_sum), origin)
}

/// Area vector and centroid of a face.
#[derive(Clone, Debug)]
pub struct FaceValues {
    pub area: Coordinates,
    pub centroid: Coordinates,
}

pub fn face_values(c: &Complex, f: FaceId) -> FaceValues {
    let pr = projection(c, f);
    let (doubled, moments, origin) = integrate(c, f, pr, true);
    let (n, _) = support(c, f);
    let scale = Rational::from(&doubled / 2) / n[3 - pr.ax - pr.ay].clone().abs();
    let divisor = Rational::from(&doubled * 3);
    let mut axis = 0;
    let centroid = moments.map(|m| {
        axis += 1;
        if divisor.is_zero() { origin[axis - 1].clone() } else { m / &divisor + &origin[axis - 1] }
    });
    FaceValues { area: n.map(|x| x * &scale), centroid }
}

/// Six times the signed volume of the cone from the coordinate origin over a face seen from behind.
fn cone(c: &Complex, f: FaceId) -> Rational {
    let pr = projection(c, f);
    let (n, value) = support(c, f);
    if value.is_zero() {
        return value;
    }
    integrate(c, f, pr, false).0 * value / n[3 - pr.ax - pr.ay].clone().abs()
}

/// The corners of a face that is a triangle of input vertices.
fn uncut(c: &Complex, f: FaceId) -> Option<[[f64; 3]; 3]> {
    let [x, y, z] = c.corner_vertices[c.face_corners(f)] else { return None };
    match [x, y, z].map(|v| c.origins[v.at()]) {
        [Origin::Mesh(x), Origin::Mesh(y), Origin::Mesh(z)] => Some([x, y, z].map(|v| c.mesh.vertices[v.at()])),
        _ => None,
    }
}

/// The lowest exponent of two in any of these numbers.
pub(crate) fn lowest_exponent(numbers: impl Iterator<Item = f64>) -> i32 {
    numbers.filter(|&x| x != 0.0).map(|x| lift::split(x).1).min().unwrap_or(0)
}

fn scaled(x: f64, exponent: i32) -> Integer {
    if x == 0.0 {
        return Integer::new();
    }
    let (m, s) = lift::split(x);
    let r = Integer::from(m) << (s - exponent) as u32;
    if x < 0.0 { -r } else { r }
}

/// Six times the signed volume of the cone from the origin over a triangle, with coordinates in units of 2^exponent.
pub(crate) fn triangle_cone(t: &[[f64; 3]; 3], exponent: i32) -> Integer {
    let [a, b, d] = t.map(|p| p.map(|x| scaled(x, exponent)));
    let minor = |i: usize, j: usize| Integer::from(&b[i] * &d[j]) - Integer::from(&b[j] * &d[i]);
    minor(1, 2) * &a[0] + minor(2, 0) * &a[1] + minor(0, 1) * &a[2]
}

/// A sum of [`triangle_cone`]s as a volume.
fn volume_of(sum: Integer, exponent: i32) -> Rational {
    Rational::from((sum, 6)) << (3 * exponent)
}

fn sign(h: HalfFace, x: Rational) -> Rational {
    if h.front() { -x } else { x }
}

/// The exact volume of a cell.
pub fn cell_volume(c: &Complex, cell: CellId) -> Rational {
    volume_within(c, c.cell_faces(cell))
}

/// The exact volume that a closed set of half-faces bounds, seen from inside: of the wall of a void it is negative.
pub fn volume_within(c: &Complex, faces: &[HalfFace]) -> Rational {
    let whole = || faces.iter().filter_map(|h| uncut(c, h.face()).map(|t| (*h, t)));
    let exponent = lowest_exponent(whole().flat_map(|(_, t)| t.into_iter().flatten()));
    let mut sum = Integer::new();
    for (h, t) in whole() {
        let x = triangle_cone(&t, exponent);
        if h.front() { sum -= x } else { sum += x }
    }
    let rest = faces.iter().filter(|h| uncut(c, h.face()).is_none());
    tree_sum(rest.map(|h| sign(*h, cone(c, h.face()))).collect()) / 6 + volume_of(sum, exponent)
}

/// The exact volume of a cell as a canonical string.
pub fn cell_volume_string(c: &Complex, cell: CellId) -> String {
    cell_volume(c, cell).to_string()
}

/// The exact volume of the solid that a mesh bounds.
pub fn mesh_volume(mesh: &TriMesh) -> Rational {
    volume_of_corners(&mesh.vertices, mesh.triangles.iter().map(|t| t.map(|v| v.at())))
}

/// The exact volume that closed triangles bound.
pub fn volume_of_triangles(coords: &[[f64; 3]], triangles: &[[u32; 3]]) -> Rational {
    volume_of_corners(coords, triangles.iter().map(|t| t.map(|v| v as usize)))
}

fn volume_of_corners(coords: &[[f64; 3]], triangles: impl Iterator<Item = [usize; 3]>) -> Rational {
    let exponent = lowest_exponent(coords.iter().flatten().copied());
    let cone = |t: [usize; 3]| triangle_cone(&t.map(|v| coords[v]), exponent);
    volume_of(triangles.fold(Integer::new(), |s, t| s + cone(t)), exponent)
}

/// The exact volume of the solid that a mesh bounds, as a canonical string.
pub fn mesh_volume_string(mesh: &TriMesh) -> String {
    mesh_volume(mesh).to_string()
}

/// The exact volume and centroid of a cell.
pub fn cell_values(c: &Complex, cell: CellId) -> (Rational, Coordinates) {
    // A cone from the origin over a face has its centroid at 3/4 of the face's; over a triangle, at a quarter of its
    // corners' sum, so whole triangles add up as integers here too.
    let faces = c.cell_faces(cell);
    let whole = || faces.iter().filter_map(|h| uncut(c, h.face()).map(|t| (*h, t)));
    let exponent = lowest_exponent(whole().flat_map(|(_, t)| t.into_iter().flatten()));
    let (mut sum, mut first) = (Integer::new(), [const { Integer::ZERO }; 3]);
    for (h, t) in whole() {
        let mut x = triangle_cone(&t, exponent);
        if h.front() {
            x = -x;
        }
        for (axis, m) in first.iter_mut().enumerate() {
            let corners = t.iter().fold(Integer::new(), |s, p| s + scaled(p[axis], exponent));
            *m += corners * &x;
        }
        sum += x;
    }
    let mut cones = vec![volume_of(sum, exponent) * 6];
    let mut moments = first.map(|m| vec![Rational::from((m, 3)) << (4 * exponent)]);
    for h in faces.iter().filter(|h| uncut(c, h.face()).is_none()) {
        let x = sign(*h, cone(c, h.face()));
        if x.is_zero() {
            continue;
        }
        let centroid = face_values(c, h.face()).centroid;
        for axis in 0..3 {
            moments[axis].push(product(&centroid[axis], &x));
        }
        cones.push(x);
    }
    let six = tree_sum(cones);
    let centroid = moments.map(|m| {
        let m = tree_sum(m);
        if six.is_zero() { m } else { m * Rational::from((3, 4)) / &six }
    });
    (six / 6, centroid)
}

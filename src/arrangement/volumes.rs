//! Exact volumes of cells and of what is extracted: rationals on demand, and residues modulo two primes for sums over very much.
//!
//! Six times a volume is a sum of determinants over triangles. Whole input triangles add up as integers on a common exponent. Parts of cut triangles are
//! gathered by support: in its plane n·x = c the sum over parts is c/n_i times their projected area along axis i, and that is a sum over the edges that
//! do not cancel: points inside what is gathered are never evaluated. Rationals are added over a balanced tree.
//!
//! Cost: a microsecond for a whole triangle, some for an edge around the parts; the number itself may be long: it has the denominators of all
//! constructed points on its boundary. A residue costs as much as its three corners.

use super::{Arrangement, Extraction, Resolved};
use crate::base::{FaceId, TriangleId, VertexId};
use crate::complex::exact_values::{lowest_exponent, tree_sum, triangle_cone};
use crate::exact::{self, Residue, Support, residue};
use crate::mesh::projection::seen_along;
use rug::{Integer, Rational};

/// One face in one sum.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Term {
    sum: u32,
    support: TriangleId,
    face: FaceId,
    reversed: bool,
}

/// Six times the signed volume of the cone from the coordinate origin over the faces of each sum. `whole` and `parts` are sorted.
fn cones(r: &Resolved, sums: usize, mut terms: Vec<Term>) -> Vec<Rational> {
    terms.sort_unstable();
    let whole = |t: &Term| t.face.at() < r.whole;
    let corners = |f: FaceId| r.faces[f.at()].map(|v| r.soup.mesh.vertices[v.at()]);
    let exponent = lowest_exponent(terms.iter().filter(|t| whole(t)).flat_map(|t| corners(t.face)).flatten());
    let mut integers = vec![Integer::new(); sums];
    for t in terms.iter().filter(|t| whole(t)) {
        let x = triangle_cone(&corners(t.face), exponent);
        if t.reversed { integers[t.sum as usize] -= x } else { integers[t.sum as usize] += x }
    }
    let mut rest: Vec<Vec<Rational>> = vec![Vec::new(); sums];
    let (mut edges, mut loose) = (Vec::new(), Vec::new());
    let parts: Vec<Term> = terms.into_iter().filter(|t| !whole(t)).collect();
    for group in parts.chunk_by(|a, b| (a.sum, a.support) == (b.sum, b.support)) {
        edges.clear();
        for t in group {
            let [a, b, c] = r.faces[t.face.at()];
            let corners = if t.reversed { [a, c, b] } else { [a, b, c] };
            for i in 0..3 {
                let (from, to) = (corners[i], corners[(i + 1) % 3]);
                edges.push((from.min(to), from.max(to), from < to));
            }
        }
        edges.sort_unstable();
        // How often each is walked forward more than backward.
        loose.clear();
        for same in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let net: i64 = same.iter().map(|e| if e.2 { 1 } else { -1 }).sum();
            if net != 0 {
                loose.push((same[0].0, same[0].1, net));
            }
        }
        rest[group[0].sum as usize].push(cone_in_plane(r, group[0].support, &loose));
    }
    let volume = |sum: Integer| Rational::from(sum) << (3 * exponent);
    integers.into_iter().zip(rest).map(|(whole, parts)| volume(whole) + tree_sum(parts)).collect()
}

/// Six times the cone over what the edges (lower end, higher end, how often) go around in a triangle's plane.
fn cone_in_plane(r: &Resolved, support: TriangleId, edges: &[(VertexId, VertexId, i64)]) -> Rational {
    let (axis, _) = r.soup.open_axis(support);
    let (u, v) = seen_along(axis);
    let of = |x: f64| Rational::from_f64(x).unwrap_or_default();
    let (normal, value): ([Rational; 3], Rational) = match r.soup.support(support) {
        Support::Plane(p) => (p.n.map(of), -of(p.d)),
        Support::Triangle(t) => {
            let t = t.map(|p| p.map(of));
            let side = |k: usize, i: usize| Rational::from(&t[k][i] - &t[0][i]);
            let normal: [Rational; 3] = std::array::from_fn(|i| {
                let (j, k) = seen_along(i);
                side(1, j) * side(2, k) - side(1, k) * side(2, j)
            });
            let value = (0..3).fold(Rational::new(), |sum, i| sum + Rational::from(&normal[i] * &t[0][i]));
            (normal, value)
        }
    };
    if value.is_zero() {
        return value;
    }
    let crosses = edges.iter().map(|&(a, b, times)| {
        let (a, b) = (exact::rational(&r.point(a)), exact::rational(&r.point(b)));
        (Rational::from(&a[u] * &b[v]) - Rational::from(&a[v] * &b[u])) * times
    });
    // A normal that points along the axis and an area that turns counterclockwise, seen along it, go together.
    tree_sum(crosses.collect()) * value / &normal[axis]
}

/// The exact volume of each cell; of the unbounded one: 0.
pub fn cell_volumes(a: &Arrangement) -> Vec<Rational> {
    let term = |(f, of): (usize, &[crate::base::CellId])| {
        let (patch, face) = (a.cells.patch[f], FaceId::of(f));
        let first = a.cells.patch_face[patch.at()];
        // All faces of a patch have the same cell behind them, or before those that are turned the other way.
        let reversed = of[0] != a.face_cells(first)[0];
        Term { sum: patch.0, support: a.resolved.support[f], face, reversed }
    };
    let dividing = a.cells.of.chunks_exact(2).enumerate().filter(|(f, _)| a.cells.patch[*f].is_some());
    let patches = cones(&a.resolved, a.patch_count(), dividing.map(term).collect());
    let mut cells: Vec<Vec<Rational>> = vec![Vec::new(); a.cell_count()];
    for (&face, cone) in a.cells.patch_face.iter().zip(patches) {
        let [back, front] = a.face_cells(face);
        if front.at() != 0 {
            cells[front.at()].push(-cone.clone());
        }
        if back.at() != 0 {
            cells[back.at()].push(cone);
        }
    }
    cells.into_iter().map(|terms| tree_sum(terms) / 6).collect()
}

/// The exact volume of what is extracted, from its triangles.
pub fn volume(a: &Arrangement, e: &Extraction) -> Rational {
    let term = |(&face, corners): (&FaceId, &[u32; 3])| {
        let r = &a.resolved;
        let reversed = !same_turn(&r.faces[face.at()], &corners.map(|v| e.vertices[v as usize]));
        Term { sum: 0, support: r.support[face.at()], face, reversed }
    };
    let terms = e.faces.iter().zip(&e.triangles).map(term).collect();
    cones(&a.resolved, 1, terms).pop().unwrap_or_default() / 6
}

/// Six times the volume of what is extracted modulo two primes; `None` if one of them divides a denominator.
pub fn six_volume_residue(a: &Arrangement, e: &Extraction) -> Option<Residue> {
    let mut points = Vec::with_capacity(e.vertices.len());
    for &v in &e.vertices {
        points.push(residue::point_residues(&a.point(v))?);
    }
    Some(e.triangles.iter().map(|t| determinant(t.map(|v| points[v as usize]))).sum())
}

fn determinant([a, b, c]: [[Residue; 3]; 3]) -> Residue {
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
}

/// Whether two lists of the same three corners turn the same way.
fn same_turn(a: &[VertexId; 3], b: &[VertexId; 3]) -> bool {
    (0..3).any(|i| (0..3).all(|k| a[k] == b[(k + i) % 3]))
}

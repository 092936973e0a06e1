//! Moments of grid cells and faces as rationals, straight from the definitions: what fixed point cannot decide is computed
//! here, and tests compare with it. Every face is a fan of triangles, every loop its own; a cell is the signed sum of the
//! tetrahedra from its box's low corner. Cost: some hundred microseconds per cell.

use super::data::GridCells;
use crate::base::{BoxId, CellId, FaceId};
use crate::complex::HalfFace;
use crate::complex::exact_values::{Coordinates, tree_sum};
use crate::exact::rational;
use rug::{Integer, Rational};

/// The exact coordinates of a vertex.
pub fn vertex(g: &GridCells, v: crate::base::VertexId) -> Coordinates {
    rational(&crate::complex::data::origin_point(&g.mesh, &g.planes, g.origin(v)))
}

fn times(a: &Rational, b: &Rational) -> Rational {
    Rational::from(a * b)
}

fn cross(a: &Coordinates, b: &Coordinates) -> Coordinates {
    let minor = |i: usize, j: usize| times(&a[i], &b[j]) - times(&a[j], &b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn minus(a: &Coordinates, b: &Coordinates) -> Coordinates {
    std::array::from_fn(|i| Rational::from(&a[i] - &b[i]))
}

/// Calls `with` for the fan triangles of a face, relative to a point. What is walked twice cancels.
pub fn fans(g: &GridCells, f: FaceId, origin: &Coordinates, mut with: impl FnMut([&Coordinates; 3])) {
    for l in g.loops_of(f) {
        let points: Vec<Coordinates> = g.corners_of(l).iter().map(|&v| minus(&vertex(g, v), origin)).collect();
        for k in 2..points.len() {
            with([&points[0], &points[k - 1], &points[k]]);
        }
    }
}

fn of(x: [f64; 3]) -> Coordinates {
    x.map(|x| Rational::from_f64(x).unwrap_or_default())
}

/// Doubled area vector, and centroid (where there is an area) of a face.
pub fn face(g: &GridCells, f: FaceId) -> (Coordinates, Coordinates) {
    let origin = vertex(g, g.face_corners(f)[0]);
    let mut area: [Vec<Rational>; 3] = Default::default();
    let mut parts: Vec<(Coordinates, Coordinates)> = Vec::new();
    fans(g, f, &origin, |[a, b, c]| {
        let n = cross(&minus(b, a), &minus(c, a));
        n.iter().zip(&mut area).for_each(|(n, sum)| sum.push(n.clone()));
        parts.push((n, std::array::from_fn(|i| Rational::from(&a[i] + &b[i]) + &c[i])));
    });
    let area = area.map(tree_sum);
    // Any component that is not zero weighs the triangles of a plane face.
    let Some(axis) = (0..3).find(|&i| !area[i].is_zero()) else { return (area, origin) };
    let divisor = Rational::from(&area[axis] * 3);
    let centroid = std::array::from_fn(|i| {
        let sum = tree_sum(parts.iter().map(|(n, s)| times(&n[axis], &s[i])).collect());
        sum / &divisor + &origin[i]
    });
    (area, centroid)
}

/// Moments of a cell: volume, ∫ (x − c)_i, and ∫ (x − c)_i (x − c)_j for ij = xx, yy, zz, xy, yz, zx.
pub struct CellMoments {
    pub volume: Rational,
    pub first: Coordinates,
    pub second: [Rational; 6],
}

/// The pairs of axes of second moments.
pub const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];

/// Moments of a cell about a point.
pub fn cell(g: &GridCells, c: CellId, about: &Coordinates, second: bool) -> CellMoments {
    let mut volume = Vec::new();
    let mut first: [Vec<Rational>; 3] = Default::default();
    let mut seconds: [Vec<Rational>; 6] = Default::default();
    for &h in g.cell_faces(c) {
        fans(g, h.face(), about, |[a, b, c]| {
            let n = cross(b, c);
            let mut det = times(&a[0], &n[0]) + times(&a[1], &n[1]) + times(&a[2], &n[2]);
            if h.front() {
                det = -det;
            }
            let s: Coordinates = std::array::from_fn(|i| Rational::from(&a[i] + &b[i]) + &c[i]);
            for i in 0..3 {
                first[i].push(times(&s[i], &det));
            }
            if second {
                for (sum, [i, j]) in seconds.iter_mut().zip(PAIRS) {
                    let q = times(&a[i], &a[j]) + times(&b[i], &b[j]) + times(&c[i], &c[j]) + times(&s[i], &s[j]);
                    sum.push(q * &det);
                }
            }
            volume.push(det);
        });
    }
    CellMoments {
        volume: tree_sum(volume) / 6,
        first: first.map(|x| tree_sum(x) / 24),
        second: seconds.map(|x| tree_sum(x) / 120),
    }
}

/// Low corner, middle and volume of a box.
pub fn box_values(g: &GridCells, b: BoxId) -> (Coordinates, Coordinates, Rational) {
    let [low, high] = g.lattice.corners(b).map(of);
    let middle = std::array::from_fn(|i| Rational::from(&low[i] + &high[i]) / 2);
    let size = minus(&high, &low);
    (low, middle, times(&size[0], &size[1]) * &size[2])
}

/// Volume, fraction of the box, and centroid.
pub fn body(g: &GridCells, b: BoxId, c: CellId) -> [Rational; 5] {
    let (low, _, size) = box_values(g, b);
    let m = cell(g, c, &low, false);
    let fraction = &m.volume / size;
    let [x, y, z] = std::array::from_fn(|i| {
        if m.volume.is_zero() { low[i].clone() } else { times(&m.first[i], &m.volume.clone().recip()) + &low[i] }
    });
    [m.volume, fraction, x, y, z]
}

/// Area vector and area-weighted centroid of some walls. The weights are square roots, taken to 320 bits.
pub fn walls(g: &GridCells, faces: impl Iterator<Item = FaceId>) -> [Rational; 6] {
    let mut area: [Vec<Rational>; 3] = Default::default();
    let mut first: [Vec<Rational>; 3] = Default::default();
    let mut weights = Vec::new();
    for f in faces {
        let (n, centroid) = face(g, f);
        let square = times(&n[0], &n[0]) + times(&n[1], &n[1]) + times(&n[2], &n[2]);
        let w = root(&square);
        for i in 0..3 {
            first[i].push(times(&w, &centroid[i]));
            area[i].push(n[i].clone());
        }
        weights.push(w);
    }
    let total = tree_sum(weights);
    let [a, b, c] = area.map(|x| tree_sum(x) / 2);
    let [x, y, z] = first.map(|x| if total.is_zero() { Rational::new() } else { tree_sum(x) / &total });
    [a, b, c, x, y, z]
}

/// The square root, exact for squares of rationals, else to 320 bits.
fn root(x: &Rational) -> Rational {
    let product = Integer::from(x.numer() * x.denom());
    let size = product.significant_bits() / 2;
    let shift = 320u32.saturating_sub(size.min(320));
    Rational::from((Integer::from(&product << (2 * shift)).sqrt(), Integer::from(x.denom() << shift)))
}

/// Half-faces of a cell that are walls.
pub fn cell_wall_faces(g: &GridCells, c: CellId) -> impl Iterator<Item = FaceId> + '_ {
    let walls = g.wall_count() as u32;
    g.cell_faces(c).iter().map(|h: &HalfFace| h.face()).filter(move |f| f.0 < walls)
}

//! Stage: correctly rounded coordinates of the points on mesh edges and in triangles, and what rounding took away.
//!
//! A coordinate on a grid plane is that plane's node. Of the rest, a point on a mesh edge is (a·(b_l − a_l) + (c − a_l)(b − a))/(b_l − a_l)
//! for the plane x_l = c; a point in a triangle with normal n on two planes has a_c − (n_a(x_a − a_a) + n_b(x_b − a_b))/n_c.
//! Numerator and denominator are double-doubles with bounds, so is their quotient; where it does not decide how to round (exact
//! ties are common), `exact::round` does. Cost: about 0.1 µs per point.

use super::ground::{Ground, on_plane};
use super::pieces::Pieces;
use crate::base::{EdgeId, TriangleId, VertexId};
use crate::complex::Origin;
use crate::complex::data::origin_point;
use crate::exact::double_double::DoubleDouble;
use crate::exact::ring::Ring;
use crate::exact::{self, Plane};
use rayon::prelude::*;
use rug::Rational;

/// Points on the surface: mesh vertices, points on mesh edges, points in triangles.
#[derive(Debug, Default)]
pub struct Points {
    pub origins: Vec<Origin>,
    pub coords: Vec<[f64; 3]>,
    /// Of points on mesh edges and in triangles: exact coordinates less rounded ones, within 2⁻⁹⁰·extent.
    pub residuals: Vec<[f64; 3]>,
    pub extent: f64,
}

pub fn points(ground: &Ground, pieces: &Pieces, planes: &[Plane]) -> Points {
    let mesh = &ground.mesh;
    let constructed = ground.points.edge.len() + pieces.point_triangle.len();
    let mut origins = Vec::with_capacity(mesh.vertices.len() + constructed);
    origins.extend((0..mesh.vertices.len()).map(|v| Origin::Mesh(VertexId::of(v))));
    let id = |k| ground.knives.ids[crate::cut::classify::KnifeId::at(k)];
    origins.extend(ground.points.edge.iter().zip(&ground.points.lead).map(|(&e, &k)| Origin::Edge(e, id(k))));
    origins.extend(
        pieces.point_triangle.iter().zip(&pieces.point_pair).map(|(&t, &[p, q])| Origin::Triangle(t, id(p), id(q))),
    );
    let extent = mesh.bbox.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut coords = Vec::with_capacity(origins.len());
    coords.extend_from_slice(&mesh.vertices);
    coords.resize(origins.len(), [0.0; 3]);
    let mut residuals = vec![[0.0; 3]; constructed];
    let first = mesh.vertices.len();
    let allowed = extent * (0.25 * f64::EPSILON * f64::EPSILON * 16384.0);
    coords[first..].par_iter_mut().zip(&mut residuals).with_min_len(1024).zip(&origins[first..]).enumerate().for_each(
        |(i, ((x, low), &origin))| {
            let slabs = match i.checked_sub(ground.points.edge.len()) {
                None => &ground.slabs[first + i],
                Some(inner) => &pieces.point_slabs[inner],
            };
            let node = |a: usize| on_plane(slabs[a]).then(|| ground.lattice.nodes[a][slabs[a] as usize / 2]);
            let known = [node(0), node(1), node(2)];
            let decided = match origin {
                Origin::Edge(e, p) => on_edge(ground, e, ground.lattice.plane_at(p).0, known, x, low, allowed),
                Origin::Triangle(t, ..) => in_triangle(ground, t, known, x, low, allowed),
                _ => false,
            };
            if !decided {
                let point = origin_point(mesh, planes, origin);
                *x = exact::round(&point);
                let exactly = exact::rational(&point);
                *low = std::array::from_fn(|a| match Rational::from_f64(x[a]) {
                    Some(rounded) => exact::round_rational(&(exactly[a].clone() - rounded)),
                    None => 0.0,
                });
            }
        },
    );
    Points { origins, coords, residuals, extent }
}

/// Fills in a coordinate and its residual; false if the bound leaves them open.
#[inline(always)]
fn settle(n: &DoubleDouble, d: &DoubleDouble, allowed: f64, x: &mut f64, low: &mut f64) -> bool {
    let Some(q) = n.over(d) else { return false };
    if !(q.err <= allowed) {
        return false;
    }
    let (lower, upper) = (q.hi + (q.lo - q.err).next_down(), q.hi + (q.lo + q.err).next_up());
    if lower != upper {
        return false;
    }
    *x = lower + 0.0;
    // Exact: the two are neighbours at most.
    *low = (q.hi - lower) + q.lo;
    true
}

#[inline(always)]
fn difference(x: f64, y: f64) -> DoubleDouble {
    let (hi, lo) = exact::double_double::two_sum(x, -y);
    DoubleDouble { hi, lo, err: 0.0 }
}

fn on_edge(
    ground: &Ground,
    e: EdgeId,
    lead: usize,
    known: [Option<f64>; 3],
    x: &mut [f64; 3],
    low: &mut [f64; 3],
    allowed: f64,
) -> bool {
    let [a, b] = ground.mesh.edges[e.at()].map(|v| &ground.mesh.vertices[v.at()]);
    let Some(plane) = known[lead] else { return false };
    let (run, way) = (difference(b[lead], a[lead]), difference(plane, a[lead]));
    for i in 0..3 {
        match known[i] {
            Some(node) => x[i] = node,
            None if a[i] == b[i] => x[i] = a[i],
            None => {
                let n = DoubleDouble::exactly(a[i]).times(&run).plus(&way.times(&difference(b[i], a[i])));
                if !settle(&n, &run, allowed, &mut x[i], &mut low[i]) {
                    return false;
                }
            }
        }
    }
    true
}

fn in_triangle(
    ground: &Ground,
    t: TriangleId,
    known: [Option<f64>; 3],
    x: &mut [f64; 3],
    low: &mut [f64; 3],
    allowed: f64,
) -> bool {
    let Some(open) = known.iter().position(Option::is_none) else {
        *x = known.map(Option::unwrap_or_default);
        return true;
    };
    let (i, j) = ((open + 1) % 3, (open + 2) % 3);
    let (Some(p), Some(q)) = (known[i], known[j]) else { return false };
    (x[i], x[j]) = (p, q);
    let [a, b, c] = ground.mesh.corners(t);
    let (u, v): ([_; 3], [_; 3]) =
        (std::array::from_fn(|k| difference(b[k], a[k])), std::array::from_fn(|k| difference(c[k], a[k])));
    let minor = |k: usize, l: usize| u[k].times(&v[l]).minus(&u[l].times(&v[k]));
    let (ni, nj, no) = (minor(j, open), minor(open, i), minor(i, j));
    let moved = ni.times(&difference(p, a[i])).plus(&nj.times(&difference(q, a[j])));
    let n = DoubleDouble::exactly(a[open]).times(&no).minus(&moved);
    settle(&n, &no, allowed, &mut x[open], &mut low[open])
}

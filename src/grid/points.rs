//! Stage: correctly rounded coordinates of the points on mesh edges and in triangles, and what rounding took away.
//!
//! A coordinate on a grid plane is that plane's node. Of the rest, a point on a mesh edge is a + t(b − a), t = (c − a_l)/(b_l − a_l) for the
//! plane x_l = c; a point in a triangle with normal n on two planes has a_c − (n_a(x_a − a_a) + n_b(x_b − a_b))/n_c.
//! They are evaluated as double-doubles with bounds; where these do not decide how to round (exact ties are common), `exact::round` does. Cost: about 0.1 µs per point.

use super::ground::{Ground, Slabs, on_plane};
use super::lattice::Lattice;
use super::pieces::Pieces;
use crate::base::{EdgeId, NodeId, TriangleId, VertexId};
use crate::complex::Origin;
use crate::complex::data::origin_point;
use crate::exact::double_double::DoubleDouble;
use crate::exact::ring::Ring;
use crate::exact::{self, Plane};
use crate::mesh::TriMesh;
use rayon::prelude::*;
use rug::Rational;

/// Points on the surface: mesh vertices, points on mesh edges, points in triangles.
#[derive(Debug, Default)]
pub struct Points {
    pub origins: Vec<Origin>,
    pub coords: Vec<[f64; 3]>,
    /// Bit `a`: on a plane normal to axis `a`.
    pub on_planes: Vec<u8>,
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
            let values = match origin {
                Origin::Edge(e, p) => on_edge(mesh, e, ground.lattice.plane_at(p).0, known, allowed),
                Origin::Triangle(t, ..) => in_triangle(mesh, t, known, allowed),
                _ => None,
            };
            let exactly = || origin_point(mesh, planes, origin);
            let Some(values) = values else {
                let point = exactly();
                *x = exact::round(&point);
                let rational = exact::rational(&point);
                *low = std::array::from_fn(|a| match Rational::from_f64(x[a]) {
                    Some(rounded) => exact::round_rational(&(rational[a].clone() - rounded)),
                    None => 0.0,
                });
                return;
            };
            let mut decided = true;
            for a in 0..3 {
                match (known[a], &values[a]) {
                    (_, Some(q)) => decided &= settle(q, &mut x[a], &mut low[a]),
                    (node, None) => x[a] = node.unwrap_or_default(),
                }
            }
            if !decided {
                // An exact tie, or nearly: the value is as good as before.
                *x = exact::round(&exactly());
                for a in 0..3 {
                    if let Some(q) = &values[a] {
                        low[a] = (q.hi - x[a]) + q.lo;
                    }
                }
            }
        },
    );
    let bits = |s: &Slabs| (0..3).fold(0, |bits, a| bits | (on_plane(s[a]) as u8) << a);
    let on_planes = ground.slabs.iter().chain(&pieces.point_slabs).map(bits).collect();
    Points { origins, coords, on_planes, residuals, extent }
}

/// Fills in a coordinate and its residual from a value with a bound that is small enough; whether the bound decides how to round.
#[inline(always)]
fn settle(q: &DoubleDouble, x: &mut f64, low: &mut f64) -> bool {
    let (lower, upper) = (q.hi + (q.lo - q.err).next_down(), q.hi + (q.lo + q.err).next_up());
    *x = lower + 0.0;
    // Exact: the two are neighbours at most.
    *low = (q.hi - lower) + q.lo;
    lower == upper
}

#[inline(always)]
fn difference(x: f64, y: f64) -> DoubleDouble {
    let (hi, lo) = exact::double_double::two_sum(x, -y);
    DoubleDouble { hi, lo, err: 0.0 }
}

impl Points {
    /// Appends nodes of the lattice.
    pub fn add_nodes(&mut self, lattice: &Lattice, nodes: &[NodeId]) {
        self.origins.reserve_exact(nodes.len());
        self.coords.reserve_exact(nodes.len());
        for &n in nodes {
            let at = lattice.node_at(n);
            let [p, q, r] = std::array::from_fn(|a| lattice.plane(a, at[a]));
            self.origins.push(Origin::Planes(p, q, r));
            self.coords.push(std::array::from_fn(|a| lattice.nodes[a][at[a]]));
        }
        self.on_planes.resize(self.origins.len(), 7);
    }
}

/// A point's coordinates, as far as they are not on planes: values with bounds.
pub(super) type Values = [Option<DoubleDouble>; 3];

/// `None` where a bound is larger than allowed.
pub(super) fn on_edge(mesh: &TriMesh, e: EdgeId, lead: usize, known: [Option<f64>; 3], allowed: f64) -> Option<Values> {
    let [a, b] = mesh.edges[e.at()].map(|v| &mesh.vertices[v.at()]);
    let t = difference(known[lead]?, a[lead]).over(&difference(b[lead], a[lead]))?;
    let mut values = [None; 3];
    for i in (0..3).filter(|&i| known[i].is_none()) {
        let x = DoubleDouble::exactly(a[i]);
        let x = if a[i] == b[i] { x } else { x.plus(&t.times(&difference(b[i], a[i]))) };
        values[i] = Some(x);
        if x.err.is_nan() || x.err > allowed {
            return None;
        }
    }
    Some(values)
}

pub(super) fn in_triangle(mesh: &TriMesh, t: TriangleId, known: [Option<f64>; 3], allowed: f64) -> Option<Values> {
    let mut values = [None; 3];
    let Some(open) = known.iter().position(Option::is_none) else { return Some(values) };
    let (i, j) = ((open + 1) % 3, (open + 2) % 3);
    let (p, q) = (known[i]?, known[j]?);
    let [a, b, c] = mesh.corners(t);
    let (u, v): ([_; 3], [_; 3]) =
        (std::array::from_fn(|k| difference(b[k], a[k])), std::array::from_fn(|k| difference(c[k], a[k])));
    let minor = |k: usize, l: usize| u[k].times(&v[l]).minus(&u[l].times(&v[k]));
    let (ni, nj, no) = (minor(j, open), minor(open, i), minor(i, j));
    let moved = ni.times(&difference(p, a[i])).plus(&nj.times(&difference(q, a[j])));
    let x = DoubleDouble::exactly(a[open]).minus(&moved.over(&no)?);
    values[open] = Some(x);
    (x.err <= allowed).then_some(values)
}

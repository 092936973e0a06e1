//! The points on the surface after stages 2 and 3, whatever carries them: mesh vertices, points on mesh edges, points inside
//! triangles. For each: the complete set of planes through it, its symbolic point, its rounded coordinates, and its side of
//! any plane: from the set, from the carrier's corners, from a filter, and exactly, in this order.

use super::classify::{Classified, KnifeId, Knives, Place, each_through, members_between, search_slab};
use super::edges::EdgePoints;
use super::triangles::{Numbering, Subdivision};
use crate::base::parallel::{ranges, write_parts};
use crate::base::{Csr, EdgeId, PlaneId, VertexId};
use crate::complex::Origin;
use crate::complex::data::origin_point;
use crate::exact::{self, Point, Sign, counters};
use crate::mesh::TriMesh;
use std::cmp::Ordering;
use std::ops::Range;
use std::sync::OnceLock;

/// What the stages up to the surface have found.
#[derive(Clone, Copy)]
pub struct Ground<'a> {
    pub mesh: &'a TriMesh,
    pub knives: &'a Knives,
    pub classified: &'a Classified,
    pub points: &'a EdgePoints,
    pub sub: &'a Subdivision,
    pub numbering: Numbering,
    pub input_planes: &'a [exact::Plane],
    /// Mesh edges at each mesh vertex on a knife; made when a plane first touches a vertex without crossing the surface there.
    pub vertex_edges: &'a OnceLock<Csr<EdgeId>>,
}

impl<'a> Ground<'a> {
    /// With the surface's vertices, which move while inner ones are added behind them.
    pub fn with<'b>(&self, origins: &'b [Origin], coords: &'b [[f64; 3]]) -> Surface<'b>
    where
        'a: 'b,
    {
        Surface { ground: *self, origins, coords }
    }
}

/// What the stages after the surface read.
pub struct Surface<'a> {
    ground: Ground<'a>,
    /// Symbolic points, by vertex id; the coordinates are their correct roundings.
    pub origins: &'a [Origin],
    pub coords: &'a [[f64; 3]],
}

impl<'a> std::ops::Deref for Surface<'a> {
    type Target = Ground<'a>;
    fn deref(&self) -> &Ground<'a> {
        &self.ground
    }
}

impl Surface<'_> {
    /// The mesh edges at a mesh vertex that is on some knife.
    pub fn edges_of_vertex(&self, v: VertexId) -> &[EdgeId] {
        // On one thread: while it waited for others it might take up a task that comes here again.
        let all = self.vertex_edges.get_or_init(|| {
            let ends = self.classified.edges_at.iter().flat_map(|&e| self.mesh.edges[e.at()].map(|v| (v.at(), e)));
            Csr::from_pairs(self.mesh.vertices.len(), ends)
        });
        all.row(v)
    }

    /// All knives through a vertex of the surface, rising.
    #[inline]
    pub fn set(&self, v: VertexId) -> &[KnifeId] {
        if v.0 < self.numbering.first_edge_point {
            self.classified.vertex_knives.row(v)
        } else if v.0 < self.numbering.first_inner_point {
            self.points.knives.row((v.0 - self.numbering.first_edge_point) as usize)
        } else {
            self.sub.point_knives.row((v.0 - self.numbering.first_inner_point) as usize)
        }
    }

    /// The mesh vertices whose hull carries the point.
    #[inline]
    pub fn carrier(&self, v: VertexId) -> ([VertexId; 3], usize) {
        if v.0 < self.numbering.first_edge_point {
            ([v; 3], 1)
        } else if v.0 < self.numbering.first_inner_point {
            let e = self.points.edge[(v.0 - self.numbering.first_edge_point) as usize];
            let [a, b] = self.mesh.edges[e.at()];
            ([a, b, b], 2)
        } else {
            let t = self.sub.point_triangle[(v.0 - self.numbering.first_inner_point) as usize];
            (self.mesh.triangles[t.at()], 3)
        }
    }

    pub fn point(&self, v: VertexId) -> Point {
        origin_point(self.mesh, self.input_planes, self.origins[v.at()])
    }

    /// The side of a plane on which a vertex of the surface lies.
    pub fn side(&self, k: KnifeId, v: VertexId) -> Sign {
        if self.set(v).binary_search(&k).is_ok() {
            counters::count_topology(counters::Predicate::PointSide);
            return Sign::Zero;
        }
        let (corners, count) = self.carrier(v);
        let mut seen = [false; 3];
        for c in &corners[..count] {
            seen[(self.classified.sides.side(self.knives, k, *c) as i8 + 1) as usize] = true;
        }
        match (seen[0], seen[2]) {
            (true, false) => {
                counters::count_topology(counters::Predicate::PointSide);
                Sign::Negative
            }
            (false, true) => {
                counters::count_topology(counters::Predicate::PointSide);
                Sign::Positive
            }
            _ => self.side_by_value(k, v),
        }
    }

    fn side_by_value(&self, k: KnifeId, v: VertexId) -> Sign {
        let (value, bound) = self.knives.value_at_rounded(k, &self.coords[v.at()]);
        if value > bound {
            counters::count_filter(counters::Predicate::PointSide);
            Sign::Positive
        } else if value < -bound {
            counters::count_filter(counters::Predicate::PointSide);
            Sign::Negative
        } else {
            exact::support_side(&exact::Support::Plane(*self.knives.plane(k)), &self.point(v))
        }
    }

    /// Slabs and masks of a vertex of the surface: what the carrier's corners agree on is inherited, the planes through
    /// the point are known, and only what is left is evaluated.
    pub fn place(&self, v: VertexId, out: &mut Place) {
        let sides = &self.classified.sides;
        let (corners, count) = self.carrier(v);
        out.slabs.clear();
        out.masks.clear();
        out.slabs.extend_from_slice(sides.slabs_of(corners[0]));
        out.masks.extend_from_slice(sides.masks_of(corners[0]));
        if count == 1 {
            return;
        }
        let set = self.set(v);
        let multi = out.slabs.len();
        for f in 0..multi {
            let (mut low, mut high) = (out.slabs[f], out.slabs[f]);
            for c in &corners[1..count] {
                let slab = sides.slab(*c, f);
                (low, high) = (low.min(slab), high.max(slab));
            }
            if low == high {
                continue;
            }
            let (first, last) = (self.knives.families[f], self.knives.families[f + 1]);
            let at = set.partition_point(|k| k.0 < first);
            out.slabs[f] = if at < set.len() && set[at].0 < last {
                2 * (set[at].0 - first) + 1
            } else {
                let between = members_between(low, high);
                search_slab(self.knives, first, between.start, between.end, |k| self.side_by_value(k, v))
            };
        }
        // A point strictly inside its carrier is on the positive side where some corner is and none is negative.
        for w in 0..out.masks.len() / 2 {
            let (mut positive, mut negative) = (0u64, 0u64);
            for c in &corners[..count] {
                let m = &sides.masks_of(*c)[w * 2..];
                positive |= m[0];
                negative |= m[1];
            }
            let mut open = positive & negative;
            (out.masks[w * 2], out.masks[w * 2 + 1]) = (positive & !negative, negative & !positive);
            while open != 0 {
                let bit = open.trailing_zeros() as usize;
                open &= open - 1;
                let k = KnifeId::of(*self.knives.families.last().unwrap() as usize + w * 64 + bit);
                if set.binary_search(&k).is_ok() {
                    continue;
                }
                match self.side_by_value(k, v) {
                    Sign::Positive => out.masks[w * 2] |= 1 << bit,
                    Sign::Negative => out.masks[w * 2 + 1] |= 1 << bit,
                    Sign::Zero => {}
                }
            }
        }
        debug_assert!({
            let mut through = Vec::new();
            each_through(self.knives, (&out.slabs, &out.masks), |k| through.push(k));
            through == set
        });
    }

    /// Orders two vertices of the surface by a coordinate.
    pub fn compare_coordinate(&self, a: VertexId, b: VertexId, axis: usize) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        let (x, y) = (self.coords[a.at()][axis], self.coords[b.at()][axis]);
        exact::compare_rounded(x, y, || self.point(a), || self.point(b), axis)
    }
}

/// Origins of all points on the surface, by vertex id.
pub fn surface_origins(mesh: &TriMesh, knives: &Knives, points: &EdgePoints, sub: &Subdivision) -> Vec<Origin> {
    let id = |k: KnifeId| -> PlaneId { knives.ids[k.at()] };
    let counts = [mesh.vertices.len(), points.edge.len(), sub.point_triangle.len()];
    let parts: Vec<(usize, Range<usize>)> =
        (0..3).flat_map(|kind| ranges(counts[kind], 1 << 13).into_iter().map(move |range| (kind, range))).collect();
    let lengths: Vec<usize> = parts.iter().map(|p| p.1.len()).collect();
    write_parts(&lengths, |i, out| {
        let (kind, range) = parts[i].clone();
        match kind {
            0 => out.extend(range.map(|v| Origin::Mesh(VertexId::of(v)))),
            1 => out.extend(range.map(|i| Origin::Edge(points.edge[i], id(points.lead[i])))),
            _ => out.extend(range.map(|i| {
                let [p, q] = sub.point_pair[i];
                Origin::Triangle(sub.point_triangle[i], id(p), id(q))
            })),
        }
    })
}

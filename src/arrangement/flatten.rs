//! Sheets that doubles cannot tell apart become one: flat parts of a surface, thinner than few units, are replaced by their overlay.
//!
//! A part ([`super::slabs`]) is seen along an axis. There it is an arrangement of triangles in one plane, which the stages for coplanar triangles
//! resolve exactly: faces that meet in common vertices and edges only, each with all triangles that it is a part of. Those that run one way and those that run the
//! other cancel; what remains is one sheet, or as many as the winding number steps. Constructed corners are rounded, and that is resolved again until nothing is
//! constructed any more. Then every corner gets back its height above the plane: its own, or if it is new, one between those of the corners of a
//! triangle that it is in. Seen along the axis the sheet has no folds, whatever its heights are: so nothing in it meets that should not.
//!
//! Invariants. Each step maps corners onto corners and edges onto paths, after a subdivision, and triangles onto what lies within (chain maps): what was closed
//! remains closed. Triangles that lie flat along the axis go by splitting the edge that is opposite to their middle corner in all that have it. Triangles beyond the
//! part that have an edge in common with it get that edge's path. Heights of corners that are there already do not change, but where two come to lie at one
//! place: so nothing moves further than the part is thick, and new corners are rounded by half a unit when they are made.
//! Nothing is decided in doubles but heights. Termination: so many rounds, and so many corners for each triangle, or the part stays as it is.
//!
//! Corners and edges nearer than a grain are snapped together in each round, so that what is constructed has room to be rounded: without that a round may breed
//! more corners than it settles.
//!
//! Rejected: snapping both sheets to one another's corners and edges in space. The diagonals of split triangles differ between sheets and cross again, without end.
//! Moving one sheet by a few units instead changes which side is thin, and needs to know which sheet is whose.
//!
//! Cost: two or three arrangements of the part in its plane.

use super::slabs::{Slab, slabs};
use super::snap::{Snapped, near_edges, split_by};
use super::{Operand, Resolved, clusters, crossings, intersect, resolve, soup};
use crate::base::vector::{length, minus};
use crate::base::{FaceId, Result, Run, TriangleId, UnionFind, VertexId};
use crate::mesh::bvh::build_bvh;
use crate::mesh::projection::seen_along;
use crate::mesh::validate;

/// Rounds for one part, and rounds in which flat triangles go.
const ROUNDS: usize = 24;
const SWEEPS: usize = 64;
/// A part may come to have so many times the triangles that it had, and some.
const GROWTH: usize = 8;

/// A triangle of a part: corners by their numbers there, and the triangle of the surface that it is of.
type Piece = ([i32; 3], u32);

/// A part, seen along an axis.
struct Level {
    /// Two coordinates as they are, and zero.
    places: Vec<[f64; 3]>,
    /// Heights above the plane.
    heights: Vec<f64>,
    pieces: Vec<Piece>,
    /// The number that stands for one that has come to lie at the same place.
    stands: Vec<i32>,
    /// Edges of the surface at the border of the part, and the path that each has become.
    border: Vec<[i32; 2]>,
    paths: Vec<Vec<i32>>,
}

/// What replaces a part, in numbers of the surface's corners; new ones are behind those there are.
struct Leveled {
    pieces: Vec<Piece>,
    new: Vec<[f64; 3]>,
    stands: Vec<[i32; 2]>,
    paths: Vec<([i32; 2], Vec<i32>)>,
    thickness: f64,
}

/// Flattens what is in contact and within a distance of a plane, with corners and edges further apart than `grain`. New corners are added behind the others. Errors: `Cancelled`.
pub fn flatten(
    coords: &mut Vec<[f64; 3]>,
    triangles: &[[i32; 3]],
    contacts: &[[TriangleId; 2]],
    near: f64,
    grain: f64,
    run: &mut Run,
) -> Result<Snapped> {
    let mut stands: Vec<i32> = (0..coords.len() as i32).collect();
    let mut paths: Vec<([i32; 2], Vec<i32>)> = Vec::new();
    let mut gone = vec![false; triangles.len()];
    let mut out = Snapped::default();
    for slab in slabs(coords, triangles, contacts, near, run)? {
        let mut level = level_of(coords, triangles, &slab);
        if !level.resolve(grain, run)? {
            continue;
        }
        let made = level.raised(&slab, coords);
        if !made.new.iter().flatten().all(|x| x.is_finite()) {
            continue;
        }
        if made.pieces.len() == slab.members.len() && made.new.is_empty() && made.stands.is_empty() {
            continue;
        }
        coords.extend(made.new);
        made.stands.iter().for_each(|[v, w]| stands[*v as usize] = *w);
        slab.members.iter().for_each(|t| gone[*t as usize] = true);
        out.count += slab.members.len();
        out.moved = out.moved.max(made.thickness).max(grain);
        for (corners, t) in made.pieces {
            out.triangles.push(corners);
            out.source.push(t);
        }
        paths.extend(made.paths);
    }
    paths.sort_unstable();
    let path = |a: i32, b: i32| match paths.binary_search_by_key(&[a.min(b), a.max(b)], |p| p.0) {
        Ok(i) if a < b => paths[i].1.clone(),
        Ok(i) => paths[i].1.iter().rev().copied().collect(),
        Err(_) => Vec::new(),
    };
    for (t, corners) in triangles.iter().enumerate().filter(|(t, _)| !gone[*t]) {
        let lists = [0, 1, 2].map(|i| path(corners[i], corners[(i + 1) % 3]));
        let now = corners.map(|v| stands[v as usize]);
        split_by(now, lists, |part| out.triangles.push(part));
        out.source.resize(out.triangles.len(), t as u32);
    }
    Ok(out)
}

fn level_of(coords: &[[f64; 3]], triangles: &[[i32; 3]], slab: &Slab) -> Level {
    let number = |v: i32| slab.corners.partition_point(|w| *w < v) as i32;
    let (u, v) = seen_along(slab.flat.axis);
    let at = || slab.corners.iter().map(|c| coords[*c as usize]);
    debug_assert_eq!(slab.check(triangles), Ok(()));
    let own = |t: u32| triangles[t as usize];
    let edge = |t: [i32; 3], i: usize| [t[i].min(t[(i + 1) % 3]), t[i].max(t[(i + 1) % 3])];
    let mut edges: Vec<[i32; 2]> = slab.members.iter().flat_map(|t| [0, 1, 2].map(|i| edge(own(*t), i))).collect();
    edges.sort_unstable();
    edges.dedup();
    let others = slab.others.iter().flat_map(|t| [0, 1, 2].map(|i| edge(own(*t), i)));
    let shared = others.filter(|e| edges.binary_search(e).is_ok());
    let mut border: Vec<[i32; 2]> = shared.collect();
    border.sort_unstable();
    border.dedup();
    Level {
        places: at().map(|x| [x[u], x[v], 0.0]).collect(),
        heights: at().map(|x| x[slab.flat.axis] - slab.flat.height(x)).collect(),
        pieces: slab.members.iter().map(|t| (own(*t).map(number), *t)).collect(),
        stands: (0..slab.corners.len() as i32).collect(),
        paths: border.iter().map(|e| e.map(number).to_vec()).collect(),
        border,
    }
}

impl Level {
    /// Until no two pieces meet but in common corners and edges, and all corners are doubles. Returns whether that came to an end.
    fn resolve(&mut self, grain: f64, run: &mut Run) -> Result<bool> {
        let most = GROWTH * (self.pieces.len() + 64);
        for _ in 0..ROUNDS {
            run.tick("flatten", 0.0)?;
            self.merge();
            self.snap_near(grain, run)?;
            run.tick("flatten", 0.0)?;
            if !self.without_flat() || self.pieces.len() > most {
                return Ok(false);
            }
            if self.round(run)? == 0 {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Corners at one place become the lowest of them.
    fn merge(&mut self) {
        self.places.iter_mut().flatten().for_each(|c| *c += 0.0);
        let pairs = validate::duplicates(&self.places, |_| true);
        let mut lowest: Vec<i32> = (0..self.places.len() as i32).collect();
        pairs.iter().for_each(|&[low, other]| lowest[other as usize] = low as i32);
        self.replace(&lowest);
    }

    fn replace(&mut self, by: &[i32]) {
        self.stands.iter_mut().for_each(|v| *v = by[*v as usize]);
        self.pieces.iter_mut().for_each(|(t, _)| *t = t.map(|v| by[v as usize]));
        self.pieces.retain(|([a, b, c], _)| a != b && b != c && c != a);
        for path in &mut self.paths {
            path.iter_mut().for_each(|v| *v = by[*v as usize]);
            path.dedup();
        }
    }

    /// Corners near one another become the lowest of them; edges are split at corners near them. So what is constructed has room to be rounded.
    fn snap_near(&mut self, grain: f64, run: &mut Run) -> Result<()> {
        let corners: Vec<[VertexId; 3]> = self.pieces.iter().map(|(t, _)| t.map(|v| VertexId(v as u32))).collect();
        let tree = build_bvh(&self.places, &corners);
        let mut used: Vec<usize> = corners.iter().flatten().map(|v| v.at()).collect();
        used.sort_unstable();
        used.dedup();
        let mut near: Vec<(usize, TriangleId)> = Vec::new();
        for &v in &used {
            let [lo, hi] = [-2.0, 2.0].map(|s| self.places[v].map(|x| x + s * grain));
            tree.meeting_box(&lo, &hi, |t| near.push((v, t)));
        }
        run.tick("flatten", 0.0)?;
        let mut sets = UnionFind::new(self.places.len());
        for &(v, t) in &near {
            for w in corners[t.at()].map(|w| w.at()) {
                if length(minus(self.places[v], self.places[w])) <= grain {
                    sets.union(v, w);
                }
            }
        }
        let mut lowest: Vec<i32> = (0..self.places.len() as i32).collect();
        for &v in used.iter().rev() {
            lowest[sets.find(v)] = v as i32;
        }
        let by: Vec<i32> = (0..self.places.len()).map(|v| lowest[sets.find(v)]).collect();
        let mut splits: Vec<([i32; 2], f64, i32)> = Vec::new();
        for (v, t) in near {
            let (v, t) = (by[v], corners[t.at()].map(|w| by[w.at()]));
            if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                near_edges(&self.places, &t, v, grain, &mut splits);
            }
        }
        run.tick("flatten", 0.0)?;
        self.replace(&by);
        splits.sort_by_key(|s| (s.0, s.2));
        splits.dedup_by_key(|s| (s.0, s.2));
        splits.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        self.refine(|e| {
            let start = splits.partition_point(|s| s.0 < e);
            splits[start..].iter().take_while(|s| s.0 == e).map(|s| s.2).collect()
        });
        Ok(())
    }

    /// Splits edges until no piece lies flat. Returns whether that came to an end.
    fn without_flat(&mut self) -> bool {
        for _ in 0..SWEEPS {
            let corners: Vec<[VertexId; 3]> = self.pieces.iter().map(|(t, _)| t.map(|v| VertexId(v as u32))).collect();
            let mut splits: Vec<([i32; 2], i32)> = Vec::new();
            validate::degenerate(&self.places, &corners, |t| {
                let mut t = self.pieces[t].0;
                // Along a line the first coordinate that differs orders places.
                t.sort_by(|v, w| {
                    let [x, y] = [v, w].map(|v| self.places[*v as usize]);
                    x[0].total_cmp(&y[0]).then(x[1].total_cmp(&y[1]))
                });
                splits.push(([t[0].min(t[2]), t[0].max(t[2])], t[1]));
            });
            if splits.is_empty() {
                return true;
            }
            splits.sort_unstable();
            splits.dedup_by_key(|s| s.0);
            self.refine(|e| match splits.binary_search_by_key(&e, |s| s.0) {
                Ok(i) => vec![splits[i].1],
                Err(_) => Vec::new(),
            });
        }
        false
    }

    /// Replaces edges by paths: `within` tells what is between the ends, from the lower to the higher, of an edge.
    fn refine(&mut self, within: impl Fn([i32; 2]) -> Vec<i32>) {
        let list = |a: i32, b: i32| {
            let mut all = within([a.min(b), a.max(b)]);
            if a > b {
                all.reverse();
            }
            all
        };
        let mut pieces = Vec::with_capacity(self.pieces.len());
        for &(t, source) in &self.pieces {
            let lists = [0, 1, 2].map(|i| list(t[i], t[(i + 1) % 3]));
            split_by(t, lists, |part| pieces.push((part, source)));
        }
        self.pieces = pieces;
        self.refine_paths(list);
    }

    fn refine_paths(&mut self, list: impl Fn(i32, i32) -> Vec<i32>) {
        for path in &mut self.paths {
            let mut now = vec![path[0]];
            for w in path.windows(2) {
                now.extend(list(w[0], w[1]));
                now.push(w[1]);
            }
            *path = now;
        }
    }

    /// Resolves all pieces and rounds what is constructed. Returns how many corners that were.
    fn round(&mut self, run: &mut Run) -> Result<usize> {
        let triangles: Vec<[i32; 3]> = self.pieces.iter().map(|p| p.0).collect();
        let soup = soup::soup(&[Operand { vertices: &self.places, triangles: &triangles }], run)?;
        let contacts = intersect::intersect(&soup, run)?;
        let clusters = clusters::clusters(&contacts);
        let pairs = contacts.pair_count;
        let graphs = crossings::crossings(&soup, contacts, &clusters, run)?;
        let mesh = soup.mesh.clone();
        let (known, count) = (mesh.vertices.len(), self.places.len());
        let number = |v: VertexId| match v.at().checked_sub(known) {
            None => mesh.vertex_source[v.at()] as i32,
            Some(k) => (count + k) as i32,
        };
        let mut in_soup = vec![VertexId::NONE; count];
        mesh.vertex_source.iter().enumerate().for_each(|(new, v)| in_soup[*v as usize] = VertexId::of(new));
        self.refine_paths(|a, b| {
            let [p, q] = [a, b].map(|v| in_soup[v as usize]);
            let edge = mesh.edges.binary_search(&[p.min(q), p.max(q)]).ok();
            let place = edge.and_then(|e| graphs.split_edges.binary_search(&crate::base::EdgeId::of(e)).ok());
            let mut all: Vec<i32> =
                place.map(|i| graphs.edge_points.row(i).iter().map(|v| number(*v)).collect()).unwrap_or_default();
            if p > q {
                all.reverse();
            }
            all
        });
        let resolved = resolve::resolve(soup, graphs, &clusters, pairs, run)?;
        debug_assert_eq!(resolved.check(), Ok(()));
        let new = resolved.points.coords.len();
        self.places.extend_from_slice(&resolved.points.coords);
        self.heights.resize(count + new, f64::NAN);
        let mut pieces = Vec::with_capacity(resolved.faces.len());
        for (f, corners) in resolved.faces.iter().enumerate() {
            let corners = corners.map(number);
            let support = self.pieces[resolved.soup.source[resolved.support[f].at()] as usize].0;
            for v in corners.iter().map(|v| *v as usize) {
                if self.heights[v].is_nan() {
                    self.heights[v] = self.between(support, self.places[v]);
                }
            }
            pieces.extend(self.remaining(&resolved, FaceId::of(f), corners));
        }
        self.pieces = pieces;
        Ok(new)
    }

    /// A face as often as it is left when births that run against one another cancel.
    fn remaining(&self, r: &Resolved, f: FaceId, [a, b, c]: [i32; 3]) -> impl Iterator<Item = Piece> + use<> {
        let net: i32 = r.births_of(f).map(|b| if b.same { 1 } else { -1 }).sum();
        let corners = if net < 0 { [a, c, b] } else { [a, b, c] };
        let source = r
            .births_of(f)
            .find(|b| b.same == (net > 0))
            .map(|b| self.pieces[r.soup.source[b.triangle.at()] as usize].1);
        let piece = source.map(|source| (corners, source));
        std::iter::repeat_n(piece, net.unsigned_abs() as usize).flatten()
    }

    /// A height between those of a piece's corners, by where a place is in it.
    fn between(&self, t: [i32; 3], x: [f64; 3]) -> f64 {
        let at = t.map(|v| self.places[v as usize]);
        let turn = |p: [f64; 3], q: [f64; 3]| (p[0] - x[0]) * (q[1] - x[1]) - (p[1] - x[1]) * (q[0] - x[0]);
        let sign = (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]);
        let weights =
            [turn(at[1], at[2]), turn(at[2], at[0]), turn(at[0], at[1])].map(|w| (w * sign.signum()).max(0.0));
        let sum: f64 = weights.iter().sum();
        let heights = t.map(|v| self.heights[v as usize]);
        if sum > 0.0 { (0..3).map(|i| weights[i] / sum * heights[i]).sum() } else { heights[0] }
    }

    /// Back above the plane.
    fn raised(self, slab: &Slab, coords: &[[f64; 3]]) -> Leveled {
        let (u, v) = seen_along(slab.flat.axis);
        let old = slab.corners.len();
        // Corners that are made and then come to lie at the place of others are not needed.
        let mut used = vec![false; self.places.len()];
        self.pieces
            .iter()
            .flat_map(|p| p.0)
            .chain(self.paths.iter().flatten().copied())
            .for_each(|v| used[v as usize] = true);
        let mut new = Vec::new();
        let mut number = slab.corners.clone();
        for ((place, height), used) in self.places.iter().zip(&self.heights).zip(&used).skip(old) {
            number.push((coords.len() + new.len()) as i32);
            if *used {
                let mut x = [0.0; 3];
                (x[u], x[v]) = (place[0], place[1]);
                x[slab.flat.axis] = slab.flat.height(x) + height;
                new.push(x);
            }
        }
        let of = |v: &i32| number[*v as usize];
        let inner = |path: &Vec<i32>| path.get(1..path.len() - 1).unwrap_or_default().iter().map(of).collect();
        let stands = self.stands.iter().zip(&slab.corners).map(|(s, v)| [*v, of(s)]).filter(|[v, w]| v != w).collect();
        let bounds = self.heights[..old].iter().fold([0.0f64; 2], |[lo, hi], h| [lo.min(*h), hi.max(*h)]);
        Leveled {
            pieces: self.pieces.iter().map(|(t, source)| (t.map(|v| of(&v)), *source)).collect(),
            new,
            stands,
            paths: self.border.iter().zip(&self.paths).map(|(e, p)| (*e, inner(p))).collect(),
            thickness: bounds[1] - bounds[0],
        }
    }
}

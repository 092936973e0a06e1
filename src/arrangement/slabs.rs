//! Flat parts of a surface that lie within few units of one plane and touch themselves: sheets that doubles cannot tell apart.
//!
//! A seed is a pair of triangles in contact. From it a part grows, over common corners and over contacts, as far as all corners of its triangles are
//! within a given distance of a plane; the plane is that of the larger triangle first, then one through three corners of the part that
//! are far apart, as long as that takes in more. So a part as wide as a face is found from one of its triangles.
//!
//! Invariant: no two parts have a corner in common; the two triangles of the seed are in it. Planes and distances are judged in doubles: what is
//! found only proposes ([`super::flatten`]).
//!
//! Rejected: joining pairs of triangles that are near where they overlap. A wall is near a sheet where they meet, and slivers have no
//! plane, so everything hangs together.
//!
//! Cost: linear in a part, for each of its planes, some four; seeds within a part that was found cost nothing.

use crate::base::vector::{cross, dot, length, minus};
use crate::base::{Csr, Result, Run, TriangleId};

/// Planes tried for a part, and seeds that may lead to nothing.
const PLANES: usize = 12;
const FAILURES: usize = 1 << 8;

/// A plane with a normal of length 1.
#[derive(Clone, Copy, Debug)]
pub struct Flat {
    origin: [f64; 3],
    normal: [f64; 3],
    /// The axis along which it is seen largest.
    pub axis: usize,
}

impl Flat {
    fn through(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> Option<Self> {
        let normal = cross(minus(b, a), minus(c, a));
        let size = length(normal);
        let normal = normal.map(|x| x / size);
        let axis = (1..3).fold(0, |best, i| if normal[i].abs() > normal[best].abs() { i } else { best });
        (size > 0.0 && normal.iter().all(|x| x.is_finite())).then_some(Self { origin: a, normal, axis })
    }

    fn distance(&self, x: [f64; 3]) -> f64 {
        dot(self.normal, minus(x, self.origin)).abs()
    }

    /// The coordinate along the axis of the point of the plane that has these other coordinates.
    pub fn height(&self, x: [f64; 3]) -> f64 {
        let mut y = minus(x, self.origin);
        y[self.axis] = 0.0;
        self.origin[self.axis] - dot(self.normal, y) / self.normal[self.axis]
    }
}

/// A part: its triangles, their corners, and the other triangles at these, rising.
pub struct Slab {
    pub flat: Flat,
    pub members: Vec<u32>,
    pub corners: Vec<i32>,
    pub others: Vec<u32>,
}

impl Slab {
    /// Members' corners are its corners; what else has one of these is in `others`.
    pub fn check(&self, triangles: &[[i32; 3]]) -> std::result::Result<(), String> {
        let inside = |v: &i32| self.corners.binary_search(v).is_ok();
        for (t, corners) in triangles.iter().enumerate() {
            let t = t as u32;
            let [member, other] = [&self.members, &self.others].map(|list| list.binary_search(&t).is_ok());
            if member && !corners.iter().all(inside) || other == member && corners.iter().any(inside) {
                return Err(format!("triangle {t}"));
            }
        }
        Ok(())
    }
}

/// What parts are searched in.
struct Search<'a> {
    coords: &'a [[f64; 3]],
    triangles: &'a [[i32; 3]],
    around: Csr<u32>,
    partners: Csr<u32>,
    near: f64,
    /// The search that has seen a corner and a triangle: counts, so that nothing is cleared.
    seen_corner: Vec<u32>,
    seen: Vec<u32>,
    count: u32,
}

/// Finds such parts around contacts. Errors: `Cancelled`.
pub fn slabs(
    coords: &[[f64; 3]],
    triangles: &[[i32; 3]],
    contacts: &[[TriangleId; 2]],
    near: f64,
    run: &mut Run,
) -> Result<Vec<Slab>> {
    let corners = || triangles.iter().enumerate().flat_map(|(t, c)| c.iter().map(move |v| (*v as usize, t as u32)));
    let both = || contacts.iter().flat_map(|[p, q]| [(p.at(), q.0), (q.at(), p.0)]);
    let mut search = Search {
        coords,
        triangles,
        around: Csr::from_pairs(coords.len(), corners()),
        partners: Csr::from_pairs(triangles.len(), both()),
        near,
        seen_corner: vec![0; coords.len()],
        seen: vec![0; triangles.len()],
        count: 0,
    };
    let square = |t: TriangleId| {
        let [a, b, c] = triangles[t.at()].map(|v| coords[v as usize]);
        let normal = cross(minus(b, a), minus(c, a));
        dot(normal, normal)
    };
    // The larger triangle of each pair first, and pairs by that.
    let order = |p: &[TriangleId; 2]| if square(p[0]) < square(p[1]) { [p[1], p[0]] } else { *p };
    let mut seeds: Vec<[TriangleId; 2]> = contacts.iter().map(order).collect();
    seeds.sort_by(|p, q| square(q[0]).total_cmp(&square(p[0])).then(p.cmp(q)));
    let mut taken = vec![false; coords.len()];
    let (mut found, mut failures): (Vec<Slab>, usize) = (Vec::new(), 0);
    for seed in seeds {
        let free = |t: &TriangleId| triangles[t.at()].iter().all(|v| !taken[*v as usize]);
        if !seed.iter().all(free) {
            continue;
        }
        run.tick("flatten", 0.0)?;
        match search.widest(seed[0]) {
            Some(mut slab)
                if slab.members.binary_search(&seed[1].0).is_ok()
                    && slab.corners.iter().all(|v| !taken[*v as usize]) =>
            {
                slab.corners.iter().for_each(|v| taken[*v as usize] = true);
                let around = slab.corners.iter().flat_map(|v| search.around.row(*v as usize));
                slab.others = around.copied().filter(|t| slab.members.binary_search(t).is_err()).collect();
                slab.others.sort_unstable();
                slab.others.dedup();
                found.push(slab);
            }
            _ => failures += 1,
        }
        if failures > FAILURES {
            break;
        }
    }
    Ok(found)
}

impl Search<'_> {
    fn widest(&mut self, seed: TriangleId) -> Option<Slab> {
        let [a, b, c] = self.triangles[seed.at()].map(|v| self.coords[v as usize]);
        let mut flat = Flat::through(a, b, c)?;
        let mut best: Option<Slab> = None;
        for _ in 0..PLANES {
            let slab = self.grow(flat, seed);
            if best.as_ref().is_some_and(|b| slab.members.len() <= b.members.len()) {
                break;
            }
            let wider = self.plane_of(&slab.corners);
            best = (!slab.members.is_empty()).then_some(slab);
            match wider {
                Some(wider) => flat = wider,
                None => break,
            }
        }
        best
    }

    fn grow(&mut self, flat: Flat, seed: TriangleId) -> Slab {
        self.count += 1;
        let (mut members, mut corners, mut stack) = (Vec::new(), Vec::new(), vec![seed.0]);
        while let Some(t) = stack.pop() {
            let within = |v: &i32| flat.distance(self.coords[*v as usize]) <= self.near;
            if std::mem::replace(&mut self.seen[t as usize], self.count) == self.count
                || !self.triangles[t as usize].iter().all(within)
            {
                continue;
            }
            members.push(t);
            stack.extend_from_slice(self.partners.row(t as usize));
            for v in self.triangles[t as usize] {
                if std::mem::replace(&mut self.seen_corner[v as usize], self.count) != self.count {
                    corners.push(v);
                    stack.extend_from_slice(self.around.row(v as usize));
                }
            }
        }
        members.sort_unstable();
        corners.sort_unstable();
        Slab { flat, members, corners, others: Vec::new() }
    }

    /// The plane through three corners that are far apart.
    fn plane_of(&self, corners: &[i32]) -> Option<Flat> {
        let at = |v: i32| self.coords[v as usize];
        let farthest =
            |far: &dyn Fn([f64; 3]) -> f64| corners.iter().map(|v| at(*v)).max_by(|x, y| far(*x).total_cmp(&far(*y)));
        let from = |a: [f64; 3]| move |x: [f64; 3]| dot(minus(x, a), minus(x, a));
        let a = farthest(&from(at(*corners.first()?)))?;
        let b = farthest(&from(a))?;
        let off = |x: [f64; 3]| {
            let normal = cross(minus(b, a), minus(x, a));
            dot(normal, normal)
        };
        Flat::through(a, b, farthest(&off)?)
    }
}

//! Equal points become one: by their correctly rounded coordinates first, exactly where these are equal (DESIGN §11, "Identity of a vertex").
//!
//! Rounding to nearest is monotone, so points whose rounded coordinates differ are different. Points with equal ones are compared exactly,
//! axis by axis. So one point has one id whatever edges and triangles it was found by, and no list of incidences has to be complete for that.
//!
//! Cost: n log n comparisons of doubles; a microsecond for each exact one.

use super::data::{Points, Soup};
use crate::base::{VertexId, Watch};
use crate::complex::Origin;
use crate::exact;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Gives ids to points: soup vertices keep theirs, known points too, and of new ones that are equal the least origin stands for all.
///
/// `origins`: sorted, each once. Returns the id of each. (Told to stop it returns something or other.)
pub fn unify(soup: &Soup, points: &mut Points, origins: &[Origin], watch: &Watch) -> Vec<VertexId> {
    let first = soup.mesh.vertices.len();
    /// A place with its name: an id, or the number of a new origin.
    struct Entry {
        at: [f64; 3],
        id: VertexId,
        new: u32,
    }
    let rounded = |origin: &Origin| match *origin {
        Origin::Mesh(v) => soup.mesh.vertices[v.at()],
        _ if watch.go_on() => exact::round(&soup.point(*origin)),
        _ => [0.0; 3],
    };
    let entry = |(i, origin): (usize, &Origin)| {
        let id = if let Origin::Mesh(v) = *origin { v } else { VertexId::NONE };
        Entry { at: rounded(origin), id, new: i as u32 }
    };
    let mut entries: Vec<Entry> = origins.par_iter().with_min_len(64).enumerate().map(entry).collect();
    if !watch.go_on() {
        return Vec::new();
    }
    let known = points.coords.iter().enumerate();
    entries.extend(known.map(|(i, &at)| Entry { at, id: VertexId::of(first + i), new: u32::MAX }));
    // Within a place those with ids first, then new ones by origin.
    let order = |a: &Entry, b: &Entry| compare_places(&a.at, &b.at).then(a.id.cmp(&b.id)).then(a.new.cmp(&b.new));
    entries.par_sort_unstable_by(order);
    let origin_of = |e: &Entry, points: &Points| match e.id {
        id if id.is_none() => origins[e.new as usize],
        id if id.at() < first => Origin::Mesh(id),
        id => points.origins[id.at() - first],
    };
    let mut ids = vec![VertexId::NONE; origins.len()];
    // The entry that stands for each new origin.
    let mut leaders: Vec<(u32, u32)> = Vec::new();
    let mut start = 0;
    while start < entries.len() && (start % 64 != 0 || watch.go_on()) {
        let end = start + entries[start..].iter().take_while(|e| e.at == entries[start].at).count();
        for i in start..end {
            let e = &entries[i];
            if e.new == u32::MAX {
                continue;
            }
            let same = |j: &usize| equal(soup, origin_of(&entries[*j], points), origin_of(e, points));
            let leader = (start..i).find(same).unwrap_or(i);
            match entries[leader].id {
                id if id.is_some() => ids[e.new as usize] = id,
                _ => leaders.push((e.new, entries[leader].new)),
            }
        }
        start = end;
    }
    // New ids in the order of the origins that stand for others.
    leaders.sort_unstable();
    for &(new, leader) in &leaders {
        if new == leader {
            ids[new as usize] = VertexId::of(first + points.origins.len());
            points.origins.push(origins[new as usize]);
            points.coords.push([f64::NAN; 3]);
        }
    }
    for e in &entries {
        if e.new != u32::MAX && ids[e.new as usize].is_some() && ids[e.new as usize].at() >= first {
            points.coords[ids[e.new as usize].at() - first] = e.at;
        }
    }
    leaders.iter().for_each(|&(new, leader)| ids[new as usize] = ids[leader as usize]);
    ids
}

fn compare_places(a: &[f64; 3], b: &[f64; 3]) -> Ordering {
    // No NaN, no −0.
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
}

/// Two points with equal rounded coordinates.
fn equal(soup: &Soup, a: Origin, b: Origin) -> bool {
    if a == b {
        return true;
    }
    if let (Origin::Mesh(_), Origin::Mesh(_)) = (a, b) {
        return false;
    }
    let (a, b) = (soup.point(a), soup.point(b));
    (0..3).all(|axis| exact::compare_coordinate(&a, &b, axis) == Ordering::Equal)
}

/// Rounded coordinates of a vertex, constructed or not.
#[inline(always)]
pub fn place(soup: &Soup, points: &Points, v: VertexId) -> [f64; 3] {
    match v.at().checked_sub(soup.mesh.vertices.len()) {
        None => soup.mesh.vertices[v.at()],
        Some(i) => points.coords[i],
    }
}

#[inline(always)]
pub fn origin(soup: &Soup, points: &Points, v: VertexId) -> Origin {
    match v.at().checked_sub(soup.mesh.vertices.len()) {
        None => Origin::Mesh(v),
        Some(i) => points.origins[i],
    }
}

/// The exact point of a vertex.
#[inline]
pub fn point(soup: &Soup, points: &Points, v: VertexId) -> exact::Point {
    soup.point(origin(soup, points, v))
}

/// Orders two vertices by a coordinate, exactly.
#[inline]
pub fn compare(soup: &Soup, points: &Points, a: VertexId, b: VertexId, axis: usize) -> Ordering {
    if a == b {
        return Ordering::Equal;
    }
    let (x, y) = (place(soup, points, a)[axis], place(soup, points, b)[axis]);
    exact::compare_rounded(x, y, || point(soup, points, a), || point(soup, points, b), axis)
}

/// An axis in which two different vertices differ, the one with the largest difference if doubles can tell.
pub fn open_axis(soup: &Soup, points: &Points, a: VertexId, b: VertexId) -> usize {
    let (x, y) = (place(soup, points, a), place(soup, points, b));
    let size = |i: usize| (x[i] - y[i]).abs();
    let best = (1..3).fold(0, |best, i| if size(i) > size(best) { i } else { best });
    if size(best) > 0.0 {
        return best;
    }
    (0..3).find(|&i| compare(soup, points, a, b, i) != Ordering::Equal).unwrap_or(0)
}

impl Points {
    /// As many coordinates as origins, none a soup vertex, all rounded, no two the same point.
    pub fn check(&self, soup: &Soup) -> Result<(), String> {
        if self.origins.len() != self.coords.len() || self.origins.iter().any(|o| matches!(o, Origin::Mesh(_))) {
            return Err("constructed points and their coordinates differ".into());
        }
        for (i, (origin, at)) in self.origins.iter().zip(&self.coords).enumerate() {
            if exact::round(&soup.point(*origin)).map(f64::to_bits) != at.map(f64::to_bits) {
                return Err(format!("constructed point {i} is not rounded"));
            }
        }
        let mut all: Vec<usize> = (0..self.coords.len()).collect();
        all.sort_unstable_by(|&a, &b| compare_places(&self.coords[a], &self.coords[b]));
        for same in all.chunk_by(|&a, &b| self.coords[a] == self.coords[b]) {
            for (k, &a) in same.iter().enumerate() {
                if same[..k].iter().any(|&b| equal(soup, self.origins[a], self.origins[b])) {
                    return Err(format!("constructed point {a} has two ids"));
                }
            }
        }
        Ok(())
    }
}

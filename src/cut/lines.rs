//! Stage 5: the lines in which two planes meet, cut to the inside of the solid, and the points where further planes cross them
//! (paper, sections 3.1 and 3.2).
//!
//! A line P∩Q matters only where it meets the surface: at the surface vertices whose plane sets hold both. Those are
//! gathered per pair and ordered along n_P × n_Q by one coordinate. The planes that contain the line are the intersection of
//! the sets of any two of its points; the pair of its two lowest knives owns it, other pairs of the pencil skip it. A segment
//! between neighbours is inside if the sector that it leaves into is (`Section::inside_along`); both ends must agree.
//!
//! Planes that cross an inside segment are those with opposite signs at its ends: a comparison of slabs and masks. Within a
//! family their order is known; between families it is the order of the crossing points, exactly, and planes that tie
//! cross at one point. A point inside the solid is named by its lexicographically first independent triple; the same
//! point is met on each of its lines, and the names are unified by sorting (stage `number_inner`).
//!
//! Lines outside the solid, and points on them, are never generated.

use super::classify::{KnifeId, Place, each_common, each_crossing};
use super::sections::{LocalMap, Piece, PlaneContents, Section, SectionScratch, surface_pieces};
use super::surface::Surface;
use crate::base::parallel::{Pool, concat, map_ranges, offsets, recast, write_parts};
use crate::base::{Csr, EdgeId, Error, PlaneId, Result, VertexId};
use crate::exact::{self, Direction, Point, Sign, counters};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// A plane on a line: the line's direction is +(n_P × n_other), or minus that if `against`.
#[derive(Clone, Copy, Debug, Default)]
pub struct LineKnife {
    pub knife: KnifeId,
    pub other: KnifeId,
    pub against: bool,
}

/// Lines with their inside segments. Every line is directed along n_P × n_Q of its two lowest knives P < Q.
#[derive(Debug, Default)]
pub struct Lines {
    pub knives: Csr<LineKnife>,
    /// Line `l` has segments `segments[l]..segments[l + 1]`.
    pub segments: Vec<u32>,
    pub ends: Vec<[VertexId; 2]>,
    /// Points inside each segment, in order; filled with vertex ids by `number_inner`.
    pub points: Csr<VertexId>,
    /// For each entry of `points`: the first independent triple of knives.
    names: Vec<[KnifeId; 3]>,
    /// For each entry of `points`: all knives through it.
    sets: Csr<KnifeId>,
}

/// The lines, and the surface's pieces in each plane: lists of some consecutive planes each, in order.
pub fn sections_and_lines(
    surface: &Surface,
    contents: &PlaneContents,
    pool: &Pool<SectionScratch>,
) -> Result<(Vec<Csr<Piece>>, Lines)> {
    let shared = pairs_by_knife(surface);
    let vertex_count = surface.origins.len();
    let parts = map_ranges(surface.knives.len(), 1, |range| {
        pool.with(|SectionScratch { section, map }| {
            map.prepare(vertex_count);
            let mut scratch = Scratch::default();
            let mut pieces = Csr::default();
            let mut lines = Lines { segments: vec![0], ..Default::default() };
            for knife in range.map(KnifeId::of) {
                section.knife = knife;
                section.pieces.clear();
                surface_pieces(surface, contents, knife, &mut section.pieces);
                section.build_stars(surface, map);
                let outcome = scratch.lines_of(surface, section, map, shared.row(knife), &mut lines);
                map.clear(section);
                section.vertices.clear();
                outcome?;
                pieces.push_row(&section.pieces);
            }
            Ok((pieces, lines))
        })
    });
    // The first error, whichever thread was faster.
    let (pieces, lines) = parts.into_iter().collect::<Result<Vec<_>>>()?.into_iter().unzip();
    Ok((pieces, Lines::concat(lines)))
}

/// For each knife P the surface vertices that it shares with a higher knife Q.
fn pairs_by_knife(surface: &Surface) -> Csr<(KnifeId, VertexId)> {
    Csr::from_positions(surface.knives.len(), surface.origins.len(), |range| {
        range.map(VertexId::of).flat_map(|v| {
            let set = surface.set(v);
            let lower = set.len().saturating_sub(1);
            (0..lower).flat_map(move |i| set[i + 1..].iter().map(move |&q| (set[i].at(), (q, v))))
        })
    })
}

impl Lines {
    /// For edges of lines, by rising id: the two planes along whose n_P × n_Q each runs. Line pieces have ids from
    /// `first_edge` on.
    pub fn directions<'a>(
        &'a self,
        surface: &'a Surface,
        first_edge: u32,
    ) -> impl FnMut(EdgeId) -> Option<[PlaneId; 2]> + 'a {
        let mut line = usize::MAX;
        // A segment with n points has n + 1 pieces.
        let end =
            move |l: usize| first_edge + self.segments[l + 1] + self.points.offsets[self.segments[l + 1] as usize];
        move |edge| {
            if edge.0 < first_edge {
                return None;
            }
            if line == usize::MAX {
                // Where to start: the first line that ends behind the edge.
                let (mut low, mut high) = (0, self.knives.len());
                while low < high {
                    let middle = (low + high) / 2;
                    if end(middle) <= edge.0 { low = middle + 1 } else { high = middle }
                }
                line = low;
            }
            while edge.0 >= end(line) {
                line += 1;
            }
            let row = self.knives.row(line);
            Some([row[0].knife, row[1].knife].map(|k| surface.knives.ids[k.at()]))
        }
    }

    /// All parts behind one another.
    fn concat(mut parts: Vec<Lines>) -> Lines {
        if parts.len() == 1 {
            return parts.pop().expect("one part");
        }
        fn all<T: Default>(parts: &mut [Lines], of: impl Fn(&mut Lines) -> &mut T) -> Vec<T> {
            parts.iter_mut().map(|p| std::mem::take(of(p))).collect()
        }
        let first = offsets(parts.iter().map(|p| p.ends.len()));
        // A part's own list begins with 0, and ends with what the next one begins with.
        let lengths: Vec<usize> = parts.iter().map(|p| p.segments.len() - 1).chain([1]).collect();
        let segments = write_parts(&lengths, |i, out| match parts.get(i) {
            Some(part) => out.extend(part.segments[..lengths[i]].iter().map(|s| s + first[i] as u32)),
            None => out.push(first[i] as u32),
        });
        Lines {
            knives: Csr::concat(all(&mut parts, |p| &mut p.knives)),
            segments,
            ends: concat(all(&mut parts, |p| &mut p.ends)),
            points: Csr::concat(all(&mut parts, |p| &mut p.points)),
            names: concat(all(&mut parts, |p| &mut p.names)),
            sets: Csr::concat(all(&mut parts, |p| &mut p.sets)),
        }
    }

    pub fn check(&self) -> std::result::Result<(), String> {
        self.knives.check()?;
        self.points.check()?;
        if *self.segments.last().unwrap() as usize != self.ends.len() || self.points.len() != self.ends.len() {
            return Err("segments of lines do not match their ends".into());
        }
        Ok(())
    }
}

/// Points inside the solid, by vertex id from the first inner one on.
#[derive(Debug, Default)]
pub struct InnerPoints {
    /// The planes of each point's name, rising.
    pub names: Vec<[PlaneId; 3]>,
    pub knives: Csr<KnifeId>,
}

/// Unifies the points that several lines met: equal names are equal points. Numbers them by name.
pub fn number_inner(surface: &Surface, lines: &mut Lines, first: u32) -> InnerPoints {
    let (names, sets) = (std::mem::take(&mut lines.names), std::mem::take(&mut lines.sets));
    let mut order: Vec<([KnifeId; 3], u32)> =
        names.par_iter().with_min_len(LEAST).enumerate().map(|(i, &n)| (n, i as u32)).collect();
    drop(names);
    order.par_sort_unstable();
    let is_first = |i: usize| i == 0 || order[i - 1].0 != order[i].0;
    let (starts, counts): (Vec<usize>, Vec<usize>) =
        map_ranges(order.len(), LEAST, |range| (range.start, range.filter(|&i| is_first(i)).count()))
            .into_iter()
            .unzip();
    let before = offsets(counts.into_iter());
    let vertices: Vec<AtomicU32> =
        (0..order.len()).into_par_iter().with_min_len(LEAST).map(|_| AtomicU32::new(0)).collect();
    let parts = map_ranges(order.len(), LEAST, |range| {
        let part = starts.partition_point(|&s| s < range.start);
        let count = before[part + 1] - before[part];
        let mut inner = InnerPoints { names: Vec::with_capacity(count), knives: Csr::with_capacity(count, 3 * count) };
        for (i, &(_, at)) in range.clone().zip(&order[range]) {
            if is_first(i) {
                let set = sets.row(at as usize);
                inner.names.push(plane_name(surface, set));
                inner.knives.push_row(set);
            }
            // One that begins before the part is the last one there.
            let number = before[part] + inner.names.len() - 1;
            vertices[at as usize].store(first + number as u32, Relaxed);
        }
        inner
    });
    // SAFETY: an id is a transparent word, and so is an atomic one.
    lines.points.items = unsafe { recast(vertices) };
    let (names, knives) = parts.into_iter().map(|p| (p.names, p.knives)).unzip();
    InnerPoints { names: concat(names), knives: Csr::concat(knives) }
}

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

/// The lexicographically first independent triple of a set, by plane id.
fn plane_name(surface: &Surface, set: &[KnifeId]) -> [PlaneId; 3] {
    let id = |k: KnifeId| surface.knives.ids[k.at()];
    if let [a, b, c] = *set {
        let mut name = [id(a), id(b), id(c)];
        name.sort_unstable();
        return name;
    }
    let mut knives = set.to_vec();
    knives.sort_unstable_by_key(|&k| id(k));
    first_independent(surface, &knives).map(id)
}

/// The first independent triple of planes through one point. Distinct planes with a common point are never parallel, so
/// the first two always belong to it.
fn first_independent(surface: &Surface, set: &[KnifeId]) -> [KnifeId; 3] {
    let n = |k: KnifeId| surface.knives.normal(k);
    let third = set[2..].iter().copied().find(|&k| exact::determinant(&n(set[0]), &n(set[1]), &n(k)) != Sign::Zero);
    [set[0], set[1], third.unwrap_or(set[set.len() - 1])]
}

/// The two lowest knives in both of two rising sets.
fn first_two_common(a: &[KnifeId], b: &[KnifeId]) -> Option<[KnifeId; 2]> {
    let mut common = [KnifeId::default(); 2];
    let (mut i, mut j, mut count) = (0, 0, 0);
    while count < 2 {
        match a.get(i)?.cmp(b.get(j)?) {
            Ordering::Less => i += 1,
            Ordering::Greater => j += 1,
            Ordering::Equal => {
                common[count] = a[i];
                (i, j, count) = (i + 1, j + 1, count + 1);
            }
        }
    }
    Some(common)
}

/// Points of one section on four planes or more, found on its lines so far. What crosses at one point of one line crosses
/// there on every other line through that point, so n planes through a point cost n² exact comparisons in all and not n³.
#[derive(Default)]
struct Gathered {
    sets: Csr<KnifeId>,
    names: Vec<[KnifeId; 3]>,
    /// Per knife the last entry of `links` with it, per entry the point and the entry before.
    last: Vec<u32>,
    links: Vec<(u32, u32)>,
    /// Per knife its point on the current line, `NO_POINT` if none is known.
    label: Vec<u32>,
    labelled: Vec<KnifeId>,
}

const NO_POINT: u32 = u32::MAX;

impl Gathered {
    fn start_section(&mut self, knife_count: usize) {
        for &k in &self.sets.items {
            self.last[k.at()] = NO_POINT;
        }
        self.last.resize(knife_count, NO_POINT);
        self.label.resize(knife_count, NO_POINT);
        self.sets.items.clear();
        self.sets.offsets.truncate(1);
        self.names.clear();
        self.links.clear();
    }

    fn add(&mut self, set: &[KnifeId], name: [KnifeId; 3]) {
        for k in set {
            self.links.push((self.names.len() as u32, self.last[k.at()]));
            self.last[k.at()] = self.links.len() as u32 - 1;
        }
        self.sets.push_row(set);
        self.names.push(name);
    }

    /// Labels what is known to cross the section's line with plane q.
    fn start_line(&mut self, q: KnifeId) {
        for k in self.labelled.drain(..) {
            self.label[k.at()] = NO_POINT;
        }
        let mut at = self.last[q.at()];
        while at != NO_POINT {
            let (point, before) = self.links[at as usize];
            for &k in self.sets.row(point as usize) {
                self.label[k.at()] = point;
                self.labelled.push(k);
            }
            at = before;
        }
    }
}

#[derive(Default)]
struct Scratch {
    gathered: Gathered,
    shared: Vec<(KnifeId, VertexId)>,
    line: Vec<VertexId>,
    pencil: Vec<KnifeId>,
    places: [Place; 2],
    crossing: Vec<CrossingKnife>,
    set: Vec<KnifeId>,
}

/// A plane that crosses a segment: where, as a fraction of it, with a bound.
#[derive(Clone, Copy, Debug)]
struct CrossingKnife {
    knife: KnifeId,
    at: f64,
    bound: f64,
    from_positive: bool,
    /// Its point among those gathered, `NO_POINT` if none: one label, one point.
    label: u32,
}

impl Scratch {
    fn lines_of(
        &mut self,
        surface: &Surface,
        section: &Section,
        map: &LocalMap,
        shared: &[(KnifeId, VertexId)],
        out: &mut Lines,
    ) -> Result<()> {
        self.shared.clear();
        self.shared.extend_from_slice(shared);
        self.shared.sort_unstable();
        self.gathered.start_section(surface.knives.len());
        let mut at = 0;
        while at < self.shared.len() {
            let q = self.shared[at].0;
            let end = at + self.shared[at..].iter().take_while(|s| s.0 == q).count();
            self.line.clear();
            self.line.extend(self.shared[at..end].iter().map(|s| s.1));
            at = end;
            if self.line.len() < 2 {
                continue;
            }
            let (a, b) = (surface.set(self.line[0]), surface.set(self.line[1]));
            // Most pairs of a large pencil are not its lowest: that must show after two steps, not after all its planes.
            if first_two_common(a, b) != Some([section.knife, q]) {
                continue;
            }
            self.pencil.clear();
            each_common(a, b, |k| self.pencil.push(k));
            self.line(surface, section, map, q, out)?;
        }
        Ok(())
    }

    fn line(
        &mut self,
        surface: &Surface,
        section: &Section,
        map: &LocalMap,
        q: KnifeId,
        out: &mut Lines,
    ) -> Result<()> {
        let (axis, rising) = line_axis(surface, section.knife, q);
        let order = |a: &VertexId, b: &VertexId| {
            let order = surface.compare_coordinate(*a, *b, axis);
            if rising { order } else { order.reverse() }
        };
        self.line.sort_by(order);
        self.gathered.start_line(q);
        let first = out.ends.len();
        let line = std::mem::take(&mut self.line);
        for pair in line.windows(2) {
            let inside = section.inside_along(surface, map, pair[0], q, false, pair[1])?;
            if inside != section.inside_along(surface, map, pair[1], q, true, pair[0])? {
                return Err(Error::inconsistent(format!(
                    "the line of planes {} and {} is inside the solid at one end of a segment and outside at the other: \
                     the surface intersects itself",
                    surface.knives.ids[section.knife.at()].0,
                    surface.knives.ids[q.at()].0
                )));
            }
            if inside {
                self.segment(surface, section.knife, q, [pair[0], pair[1]], out);
            }
        }
        self.line = line;
        if out.ends.len() > first {
            out.segments.push(out.ends.len() as u32);
            for &k in &self.pencil {
                out.knives.items.push(line_knife(surface, section.knife, q, k));
            }
            out.knives.end_row();
        }
        Ok(())
    }

    /// One inside segment: the planes that cross it, in order, with ties merged.
    fn segment(&mut self, surface: &Surface, p: KnifeId, q: KnifeId, ends: [VertexId; 2], out: &mut Lines) {
        let [from, to] = &mut self.places;
        surface.place(ends[0], from);
        surface.place(ends[1], to);
        self.crossing.clear();
        let (crossing, labels) = (&mut self.crossing, &self.gathered.label);
        each_crossing(surface.knives, (&from.slabs, &from.masks), (&to.slabs, &to.masks), |knife, sign| {
            let label = labels[knife.at()];
            crossing.push(CrossingKnife { knife, at: 0.0, bound: 0.0, from_positive: sign == Sign::Positive, label });
        });
        if self.crossing.len() > 1 {
            self.order_crossings(surface, p, q, ends);
        }
        let mut at = 0;
        while at < self.crossing.len() {
            let leader = self.crossing[at];
            self.set.clear();
            self.set.extend_from_slice(&self.pencil);
            self.set.push(leader.knife);
            at += 1;
            while at < self.crossing.len()
                && compare_crossings(surface, p, q, &leader, &self.crossing[at]) == Ordering::Equal
            {
                self.set.push(self.crossing[at].knife);
                at += 1;
            }
            self.set.sort_unstable();
            let name = match *self.set {
                [a, b, c] => [a, b, c],
                _ if leader.label != NO_POINT => self.gathered.names[leader.label as usize],
                _ => {
                    let name = first_independent(surface, &self.set);
                    self.gathered.add(&self.set, name);
                    name
                }
            };
            out.names.push(name);
            out.sets.push_row(&self.set);
            out.points.items.push(VertexId::NONE);
        }
        out.points.end_row();
        out.ends.push(ends);
    }

    fn order_crossings(&mut self, surface: &Surface, p: KnifeId, q: KnifeId, ends: [VertexId; 2]) {
        for c in &mut self.crossing {
            (c.at, c.bound) = crossing_fraction(surface, c.knife, ends);
        }
        self.crossing.sort_by(|a, b| compare_crossings(surface, p, q, a, b));
    }
}

/// Where plane k crosses the segment, as a fraction: t = v/(v − w) with v, w the plane's values at the ends.
///
/// The computed v and w (at rounded coordinates) are within E of the true values, which have opposite signs, and
/// ∂t/∂v = −w/(v−w)², ∂t/∂w = v/(v−w)², so to first order |dt| ≤ E/|v−w|. With E ≤ |v−w|/16 the higher orders add less than
/// a fifth, rounding adds 3u; the bound takes twice the first order plus 4u. If E is larger nothing is certain; nor if
/// the difference of two finite values overflows.
fn crossing_fraction(surface: &Surface, k: KnifeId, ends: [VertexId; 2]) -> (f64, f64) {
    let (v, bound) = surface.knives.value_at_rounded(k, &surface.coords[ends[0].at()]);
    let (w, _) = surface.knives.value_at_rounded(k, &surface.coords[ends[1].at()]);
    let difference = v - w;
    if bound * 16.0 < difference.abs() && difference.is_finite() {
        (v / difference, 2.0 * bound / difference.abs() + 2.0 * f64::EPSILON)
    } else {
        (0.5, f64::INFINITY)
    }
}

fn compare_crossings(surface: &Surface, p: KnifeId, q: KnifeId, a: &CrossingKnife, b: &CrossingKnife) -> Ordering {
    let knives = surface.knives;
    if a.label == b.label && a.label != NO_POINT {
        counters::count_topology(counters::Predicate::PointOrder);
        return Ordering::Equal;
    }
    if knives.family[a.knife.at()] == knives.family[b.knife.at()] {
        counters::count_topology(counters::Predicate::PointOrder);
        // Rising ranks where the segment starts below the family.
        let below = a.from_positive == knives.reversed[a.knife.at()];
        return if below { a.knife.cmp(&b.knife) } else { b.knife.cmp(&a.knife) };
    }
    let gap = b.at - a.at;
    if gap.abs() > a.bound + b.bound {
        counters::count_filter(counters::Predicate::PointOrder);
        return if gap > 0.0 { Ordering::Less } else { Ordering::Greater };
    }
    // Exactly: the side of b's plane on which a's point lies, against the side where the segment starts.
    let point = Point::Planes { p: *knives.plane(p), q: *knives.plane(q), r: *knives.plane(a.knife) };
    let side = exact::support_side(&exact::Support::Plane(*knives.plane(b.knife)), &point);
    match (side, b.from_positive) {
        (Sign::Zero, _) => Ordering::Equal,
        (Sign::Positive, true) | (Sign::Negative, false) => Ordering::Less,
        _ => Ordering::Greater,
    }
}

/// An axis along which the line P∩Q is strictly monotone, and whether the coordinate rises along n_P × n_Q.
fn line_axis(surface: &Surface, p: KnifeId, q: KnifeId) -> (usize, bool) {
    let (n, m) = (surface.knives.plane(p).n, surface.knives.plane(q).n);
    let d = [n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2], n[0] * m[1] - n[1] * m[0]];
    let best = (0..3).max_by(|&i, &j| d[i].abs().total_cmp(&d[j].abs())).unwrap();
    let unit = |axis: usize| {
        let mut e = [0.0; 3];
        e[axis] = 1.0;
        Direction::Plane(e)
    };
    for axis in [best, (best + 1) % 3, (best + 2) % 3] {
        match exact::determinant(&Direction::Plane(n), &Direction::Plane(m), &unit(axis)) {
            Sign::Zero => continue,
            sign => return (axis, sign == Sign::Positive),
        }
    }
    unreachable!("planes with a common point that are distinct are not parallel")
}

/// How the line of p and q (directed along n_p × n_q) is seen in plane k of its pencil.
fn line_knife(surface: &Surface, p: KnifeId, q: KnifeId, k: KnifeId) -> LineKnife {
    if k == p {
        return LineKnife { knife: k, other: q, against: false };
    }
    if k == q {
        return LineKnife { knife: k, other: p, against: true };
    }
    let n = |k: KnifeId| surface.knives.normal(k);
    let against = exact::cross_dot_cross(&n(p), &n(q), &n(k), &n(p)) == Sign::Negative;
    LineKnife { knife: k, other: p, against }
}

//! Lines through space, which join the shells of each cell.
//!
//! From each edge-connected component of the surface one line runs along the x axis, through a rational point inside one of its faces. The faces
//! that it crosses, in order, bound one cell between each two neighbours; before the first and behind the last one it is outside.
//!
//! That is enough. A cell sees each component from one region of that component's complement, through one shell (the component is connected across
//! edges, the complement of a region too, so the region's boundary is connected). Of the components that a cell touches all but one show it their
//! outer shell. Behind the last crossing with such a component the line is in that cell; it next meets another component there: the one around the cell, or an
//! outer shell, and then the same holds behind the last crossing with that. So in the end it joins the outer shell to the one around, or to the
//! outside. The same is true of every component that the line crosses: those need no line of their own. Components without one get theirs in rounds of growing
//! size, so that thousands of components behind one another cost a few lines and thousands beside one another a few rounds.
//!
//! Every component has a face that is not parallel to the axis: else winding would not change across its faces.
//!
//! All faces that divide are looked at once a round; the lines lie in strips of rising y, sorted by z within a strip. A box of a face's rounded
//! corners holds a line exactly where the rounded line is in it or where that does not matter: rounding is monotone. Signs: doubles with a bound, then rationals. A line
//! that meets the edge of a face (or runs in one) starts again from another point of its face: with weights 1 : k : k² of the corners, which lie on no line,
//! only finitely many k do.
//!
//! Cost: a few nanoseconds per face and round, microseconds per crossing.

use super::Resolved;
use super::cells::overlap;
use super::patches::Patches;
use crate::base::parallel::{concat, map_ranges};
use crate::base::{Error, FaceId, Result, Run, SharedUnionFind, Status, Watch};
use crate::complex::HalfFace;
use crate::exact::{self, Plane, Sign, Support};
use crate::mesh::projection::{ROUNDOFF, TINY};
use crate::mesh::ray::height;
use rug::{Integer, Rational};
use std::cmp::Ordering;

/// The axis of all lines, and the two that are seen along it.
const AXIS: usize = 0;
const SEEN: [usize; 2] = [1, 2];

/// Lines in the first round, and how much larger each next round is.
const FIRST: usize = 16;
const GROWTH: usize = 8;

/// Faces in one task at least, and between two looks at the caller's wish to stop.
const LEAST: usize = 1 << 14;
const OFTEN: usize = 1 << 10;

/// A line parallel to the axis through a point of a face.
struct Line {
    component: u32,
    face: FaceId,
    k: u32,
    /// Where it is, as seen along the axis.
    exact: [Rational; 2],
    rounded: [f64; 2],
}

/// A face that a line crosses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Hit {
    line: u32,
    /// The half-face that is seen behind it, looking back, plus one; or `DEGENERATE`, which sorts before all: the line cannot be used.
    code: u32,
}

const DEGENERATE: u32 = 0;

/// Joins, in `sets` (number 0 is the outside, then sides of patches), what lines see. `component` is that of each patch.
pub fn join(
    r: &Resolved,
    patches: &Patches,
    component: &[u32],
    count: usize,
    sets: &SharedUnionFind,
    run: &mut Run,
) -> Result<()> {
    let start = starts(r, patches, component, count)?;
    run.watched("nesting", 0.87, |watch| join_all(r, patches, component, &start, sets, watch))?
}

/// [`join`] from the lowest face of each component. Told to stop it returns any error.
fn join_all(
    r: &Resolved,
    patches: &Patches,
    component: &[u32],
    start: &[FaceId],
    sets: &SharedUnionFind,
    watch: &Watch,
) -> Result<()> {
    let count = start.len();
    let margins = margins(r);
    let mut served = vec![false; count];
    let (mut again, mut next, mut size): (Vec<Line>, usize, usize) = (Vec::new(), 0, FIRST);
    loop {
        // Components are taken in order; a line that was of no use comes again with the next k.
        let mut lines: Vec<Line> = Vec::new();
        for line in again.drain(..) {
            watch.check()?;
            if !served[line.component as usize] {
                lines.push(Line::new(r, line.component, line.face, line.k + 1)?);
            }
        }
        while next < count && lines.len() < size {
            watch.check()?;
            if !served[next] {
                lines.push(Line::new(r, next as u32, start[next], 2)?);
            }
            next += 1;
        }
        if lines.is_empty() {
            return Ok(());
        }
        let mut hits = scan(r, patches, &lines, &margins, watch);
        watch.check()?;
        hits.sort_unstable();
        let mut met = hits.chunk_by(|a, b| a.line == b.line);
        for (i, line) in lines.into_iter().enumerate() {
            watch.check()?;
            let own = HalfFace::new(line.face, true).0 | 1;
            match met.next() {
                Some([hit, ..]) if hit.line as usize == i && hit.code == DEGENERATE => again.push(line),
                Some(hits) if hits[0].line as usize == i && hits.iter().any(|h| (h.code - 1) | 1 == own) => {
                    for h in in_order(r, &line, hits)?.windows(2) {
                        let side = |h: Option<HalfFace>| h.map_or(0, |h| 1 + patches.side(h).at());
                        // From the far side of the one to the near side of the other.
                        sets.union(side(h[0]), side(h[1].map(|h| HalfFace(h.0 ^ 1))));
                    }
                    for h in hits {
                        let patch = patches.behind[FaceId((h.code - 1) >> 1).at()].patch();
                        served[component[patch.at()] as usize] = true;
                    }
                }
                _ => return Err(Error::new(Status::Internal, "a line misses the face that it goes through")),
            }
        }
        size = size.saturating_mul(GROWTH);
    }
}

/// The lowest face of each component that is not parallel to the axis.
fn starts(r: &Resolved, patches: &Patches, component: &[u32], count: usize) -> Result<Vec<FaceId>> {
    let mut start = vec![FaceId::NONE; count];
    let mut missing = count;
    for (f, side) in patches.behind.iter().enumerate() {
        if missing == 0 {
            break;
        }
        if side.is_none() {
            continue;
        }
        let place = &mut start[component[side.patch().at()] as usize];
        if place.is_none() && r.soup.turn_along(r.support[f], AXIS) != Sign::Zero {
            *place = FaceId::of(f);
            missing -= 1;
        }
    }
    if missing > 0 {
        return Err(Error::new(Status::Internal, "a component of the surface is parallel to an axis"));
    }
    Ok(start)
}

impl Line {
    fn new(r: &Resolved, component: u32, face: FaceId, k: u32) -> Result<Self> {
        if k == u32::MAX {
            return Err(Error::new(Status::Internal, "no line through a face can be used"));
        }
        let corners = r.faces[face.at()].map(|v| exact::rational(&r.point(v)));
        let k_big = Integer::from(k);
        let square = Integer::from(k_big.square_ref());
        let total = Integer::from(&k_big + &square) + 1u32;
        let exact = SEEN.map(|i| {
            let sum = Rational::from(&corners[1][i] * &k_big) + Rational::from(&corners[2][i] * &square);
            (sum + &corners[0][i]) / &total
        });
        let rounded = [exact::round_rational(&exact[0]), exact::round_rational(&exact[1])];
        Ok(Self { component, face, k, exact, rounded })
    }
}

/// Bounds for the error of a difference of two rounded coordinates along each seen axis: each is off by half an ulp of the largest coordinate, and so
/// is their difference once more (it is below twice that coordinate).
fn margins(r: &Resolved) -> [f64; 2] {
    let [lo, hi] = r.soup.mesh.bbox;
    SEEN.map(|i| 4.0 * ROUNDOFF * lo[i].abs().max(hi[i].abs()) + f64::MIN_POSITIVE)
}

/// Lines by strips of rising first coordinate, and by the second one within a strip.
struct Strips {
    /// Lowest and highest first coordinate of each strip.
    bounds: Vec<[f64; 2]>,
    /// Lines of strip `s`: `order[s * width..]`.
    order: Vec<u32>,
    width: usize,
}

impl Strips {
    fn new(lines: &[Line]) -> Self {
        let mut order: Vec<u32> = (0..lines.len() as u32).collect();
        let at = |i: u32, axis: usize| lines[i as usize].rounded[axis];
        order.sort_by(|&a, &b| at(a, 0).total_cmp(&at(b, 0)));
        let width = lines.len().isqrt().max(1);
        let strip_bounds = |strip: &mut [u32]| {
            let bounds = [at(strip[0], 0), at(strip[strip.len() - 1], 0)];
            strip.sort_by(|&a, &b| at(a, 1).total_cmp(&at(b, 1)));
            bounds
        };
        let bounds = order.chunks_mut(width).map(strip_bounds).collect();
        Self { bounds, order, width }
    }

    /// Lines within a closed box.
    #[inline(always)]
    fn within(&self, lines: &[Line], lo: [f64; 2], hi: [f64; 2], mut visit: impl FnMut(u32)) {
        let from = if self.bounds.len() == 1 { 0 } else { self.bounds.partition_point(|b| b[1] < lo[0]) };
        for s in from..self.bounds.len() {
            if self.bounds[s][0] > hi[0] {
                return;
            }
            let start = s * self.width;
            let strip = &self.order[start..self.order.len().min(start + self.width)];
            let second = |i: u32| lines[i as usize].rounded[1];
            for &i in &strip[strip.partition_point(|&i| second(i) < lo[1])..] {
                if second(i) > hi[1] {
                    break;
                }
                let x = lines[i as usize].rounded[0];
                if lo[0] <= x && x <= hi[0] {
                    visit(i);
                }
            }
        }
    }
}

/// All crossings of lines with faces that divide, in no particular order; told to stop, some of them.
fn scan(r: &Resolved, patches: &Patches, lines: &[Line], margins: &[f64; 2], watch: &Watch) -> Vec<Hit> {
    let strips = Strips::new(lines);
    let found = map_ranges(r.faces.len(), LEAST, |range| {
        let mut hits = Vec::new();
        for f in range {
            if f % OFTEN == 0 && !watch.go_on() {
                break;
            }
            let q = r.faces[f].map(|v| {
                let x = r.coords(v);
                [x[SEEN[0]], x[SEEN[1]]]
            });
            let lo = [0, 1].map(|i| q[0][i].min(q[1][i]).min(q[2][i]));
            let hi = [0, 1].map(|i| q[0][i].max(q[1][i]).max(q[2][i]));
            strips.within(lines, lo, hi, |line| {
                if patches.behind[f].is_none() {
                    return;
                }
                match crosses(r, f, &q, &lines[line as usize], margins) {
                    Crossing::None => {}
                    Crossing::Along(positive) => {
                        hits.push(Hit { line, code: HalfFace::new(FaceId::of(f), positive).0 + 1 })
                    }
                    Crossing::Degenerate => hits.push(Hit { line, code: DEGENERATE }),
                }
            });
        }
        hits
    });
    concat(found)
}

enum Crossing {
    None,
    /// Whether the normal points along the axis.
    Along(bool),
    Degenerate,
}

/// Whether a line crosses the inside of a face, whose corners are at `q` as seen along the axis, rounded.
fn crosses(r: &Resolved, f: usize, q: &[[f64; 2]; 3], line: &Line, margins: &[f64; 2]) -> Crossing {
    let mut zero = false;
    let mut turns = Sign::Zero;
    let mut exact: Option<[[Rational; 2]; 3]> = None;
    for i in 0..3 {
        let j = (i + 1) % 3;
        let sign = certain_turn(&q[i], &q[j], &line.rounded, margins).unwrap_or_else(|| {
            let q = exact.get_or_insert_with(|| {
                r.faces[f].map(|v| {
                    let [x, y, z] = exact::rational(&r.point(v));
                    let all = [x, y, z];
                    SEEN.map(|i| Rational::from(&all[i] - &line.exact[i - SEEN[0]]))
                })
            });
            let order = Rational::from(&q[i][0] * &q[j][1]).cmp(&Rational::from(&q[j][0] * &q[i][1]));
            match order {
                Ordering::Less => Sign::Negative,
                Ordering::Equal => Sign::Zero,
                Ordering::Greater => Sign::Positive,
            }
        });
        if sign == Sign::Zero {
            zero = true;
        } else if turns == Sign::Zero {
            turns = sign;
        } else if turns != sign {
            return Crossing::None;
        }
    }
    // On the boundary as seen along the axis, or the face is seen edge-on and the line is in its plane.
    if zero { Crossing::Degenerate } else { Crossing::Along(turns == Sign::Positive) }
}

/// The turn a → b around p, where each coordinate is rounded: a difference is off by at most its margin m, so the two products x₁y₂ and x₂y₁ by
/// (|x₁| + |x₂|)·m_y + (|y₁| + |y₂|)·m_x + 2·m_x·m_y, and their roundings; twice that is used. Overflow certifies nothing.
#[inline(always)]
fn certain_turn(a: &[f64; 2], b: &[f64; 2], p: &[f64; 2], m: &[f64; 2]) -> Option<Sign> {
    let (x1, y1, x2, y2) = (a[0] - p[0], a[1] - p[1], b[0] - p[0], b[1] - p[1]);
    let (left, right) = (x1 * y2, x2 * y1);
    let det = left - right;
    let moved = (x1.abs() + x2.abs() + m[0]) * m[1] + (y1.abs() + y2.abs() + m[1]) * m[0];
    let bound = 2.0 * moved + 8.0 * ROUNDOFF * (left.abs() + right.abs()) + TINY;
    if det > bound {
        Some(Sign::Positive)
    } else if det < -bound {
        Some(Sign::Negative)
    } else {
        None
    }
}

/// The faces that a line crosses in the order in which it does, each by the side that is seen behind it; nothing before the first and behind
/// the last one.
fn in_order(r: &Resolved, line: &Line, hits: &[Hit]) -> Result<Vec<Option<HalfFace>>> {
    struct Met {
        far: HalfFace,
        range: [f64; 2],
        height: Option<Rational>,
    }
    let met = |h: &Hit| {
        let far = HalfFace(h.code - 1);
        let x = r.faces[far.face().at()].map(|v| r.coords(v)[AXIS]);
        let range = [x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2])];
        Met { far, range, height: None }
    };
    let mut all: Vec<Met> = hits.iter().map(met).collect();
    all.sort_by(|a, b| a.range[0].total_cmp(&b.range[0]).then(a.far.cmp(&b.far)));
    let p = [Rational::new(), line.exact[0].clone(), line.exact[1].clone()];
    let mut from = 0;
    while from < all.len() {
        // A run of ranges each of which reaches into those before it: the exact places decide. Rounding is monotone, so runs are in order.
        let mut to = from + 1;
        let mut highest = all[from].range[1];
        while to < all.len() && all[to].range[0] <= highest {
            highest = highest.max(all[to].range[1]);
            to += 1;
        }
        if to > from + 1 {
            for m in &mut all[from..to] {
                m.height = Some(match r.soup.support(r.support[m.far.face().at()]) {
                    Support::Triangle(t) => height(&p, &t, AXIS),
                    Support::Plane(plane) => plane_height(&p, &plane),
                });
            }
            all[from..to].sort_by(|a, b| a.height.cmp(&b.height));
            if let Some(w) = all[from..to].windows(2).find(|w| w[0].height == w[1].height) {
                return Err(overlap(w[0].far.face(), w[1].far.face()));
            }
        }
        from = to;
    }
    Ok(std::iter::once(None).chain(all.into_iter().map(|m| Some(m.far))).chain([None]).collect())
}

/// Where a line along the axis through a point meets a plane that is not parallel to it.
fn plane_height(p: &[Rational; 3], plane: &Plane) -> Rational {
    let of = |x: f64| Rational::from_f64(x).unwrap_or_default();
    let sum = SEEN.iter().fold(of(plane.d), |sum, &i| sum + of(plane.n[i]) * &p[i]);
    -sum / of(plane.n[AXIS])
}

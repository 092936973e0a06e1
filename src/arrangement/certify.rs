//! Certified doubles: the boundary of what is inside, on double coordinates, checked exactly, repaired by iterated rounding, with a report
//! (DESIGN §7).
//!
//! A round takes the surface on rounded coordinates as one operand and arranges it exactly. What winds around in the positive sense is
//! a solid, and its boundary is exact; where all its corners are doubles it is the result, and that is the proof: faces of an arrangement
//! meet in common vertices and edges only, and between them are the winding numbers 0 and 1. Otherwise its constructed corners are rounded, and
//! the next round begins. Only corners constructed in a round move in it, by half a unit in the last place, so where nothing meets nothing changes.
//!
//! Before each round flat parts around contacts, sheets that doubles cannot tell apart, become one sheet each ([`super::flatten`]). From the second round on, what is
//! still in contact is snapped ([`super::snap`]), and thin cells that rounding would break go over to a neighbour.
//!
//! Invariants. What a round begins with is closed, as flattening and snapping keep closed what was (checked in debug builds; the arrangement refuses what is not
//! balanced). Nothing is certified but by an exact arrangement that constructs nothing. It ends: so many rounds, so many flattenings and snaps in each, so many triangles
//! and contacts; what is not certified then says so.
//!
//! Degenerate cases: corners that come to lie at one place become one; triangles without corners left go, and those whose corners come to lie
//! on a line are dropped by the arrangement, which splits the edge opposite.
//!
//! Cost: an arrangement of the surface for each round; mostly two.

use super::flatten::flatten;
use super::snap::{Snapped, snap};
use super::{Arrangement, ArrangementOptions, Extraction, Operand, Selection, arrange, choose, extract};
use crate::base::vector::{cross, dot, length, minus};
use crate::base::{FaceId, Result, Run, TriangleId, UnionFind, VertexId, Watch};
use crate::exact::{self, Point};
use crate::mesh::bvh::build_bvh_watched;
use crate::mesh::self_intersection::self_intersections_watched;
use crate::mesh::validate;
use std::cmp::Ordering;

/// Contacts listed in a report at most.
pub const MAX_LISTED: usize = 1 << 16;

/// Cells of so many units are thin.
const THIN: f64 = 4.0;

/// A round snaps within two units, after every other round twice as many: not in the first one, as most need no more than rounding. So often
/// at most the distance doubles, and so often at most a round snaps.
const LEVELS: usize = 4;
const SNAPS: usize = 8;

/// Corners between two looks at the caller's wish to stop.
const OFTEN: usize = 16;
/// Flat parts of so many units on either side of a plane become one sheet; with each level twice as thick. So often at most a round flattens.
const FLAT: f64 = 8.0;
const FLATTENINGS: usize = 4;

/// Corners and edges of such a sheet have room of so many units.
const GRAIN: f64 = 2.0;

/// What the caller decides.
#[derive(Clone, Copy, Debug)]
pub struct CertifyOptions {
    /// Check and report, change nothing.
    pub check_only: bool,
    /// Rounds at most.
    pub rounds: usize,
    /// The surface may come to have so many times the triangles that it had. (As many contacts as triangles are too many in any case.)
    pub growth: usize,
}

impl Default for CertifyOptions {
    fn default() -> Self {
        Self { check_only: false, rounds: 30, growth: 4 }
    }
}

/// One round: the surface that it began with, and what was wrong with that.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Round {
    pub triangles: usize,
    /// Triangles without area, and pairs of others in contact beyond what they share by index.
    pub flat: usize,
    pub contacts: usize,
    /// Corners of the exact solid that doubles do not have.
    pub rounded: usize,
}

/// What was found and what was done.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CertifyReport {
    /// Nothing remains: no two triangles meet beyond common vertices and edges, and the winding numbers are 0 and 1.
    pub certified: bool,
    /// In order.
    pub rounds: Vec<Round>,
    /// Places where corners, edges and triangles near one another were snapped together.
    pub snapped: usize,
    /// Cells hardly thicker than a unit, with corners that doubles do not have, that were left out or filled in.
    pub thin_cells: usize,
    /// Corners of the result at places where the surface has none, and places of the surface at which the result has none.
    pub moved: usize,
    pub gone: usize,
    /// Triangles of the surface of which no part is left.
    pub removed: usize,
    /// The sum over rounds of the largest move of a coordinate by rounding in each, and of the distances within which was snapped: a bound
    /// on how far the surface went from where correct rounding had it, but for what thin cells took away.
    pub largest_move: f64,
    /// An ulp of the largest coordinate.
    pub unit: f64,
    /// Triangles of the correctly rounded surface, and of the result.
    pub triangles_before: usize,
    pub triangles_after: usize,
    /// If it is not certified: triangles of the result without area (twice the same one), and pairs of them in contact, sorted;
    /// at most [`MAX_LISTED`]. None, if it winds around something in another sense than once.
    pub remaining: Vec<[TriangleId; 2]>,
}

/// A closed surface of triangles on doubles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CertifiedSurface {
    /// Each place once.
    pub coords: Vec<[f64; 3]>,
    /// Counterclockwise seen from outside.
    pub triangles: Vec<[i32; 3]>,
    /// The triangle of the surface that was certified that each is a part of, but for rounding; and whether it runs against it.
    pub sources: Vec<TriangleId>,
    pub against: Vec<bool>,
    pub report: CertifyReport,
}

/// Certifies a closed surface, what was extracted from an arrangement say. Runs on the current rayon pool; the result does not depend on its size.
///
/// What cannot be certified is returned as it was in the round with the fewest contacts, and the report says so. Errors: as of [`arrange`].
pub fn certify(
    coords: &[[f64; 3]],
    triangles: &[[u32; 3]],
    options: &CertifyOptions,
    run: &mut Run,
) -> Result<CertifiedSurface> {
    let unit = unit(coords);
    let mut now = CertifiedSurface {
        coords: coords.to_vec(),
        triangles: triangles.iter().map(|t| t.map(|v| v as i32)).collect(),
        sources: (0..triangles.len()).map(TriangleId::of).collect(),
        against: vec![false; triangles.len()],
        report: CertifyReport { triangles_before: triangles.len(), unit, ..CertifyReport::default() },
    };
    if options.check_only {
        check(&mut now, run)?;
    } else {
        repair(&mut now, options, run)?;
    }
    run.set_part([0.0, 1.0]);
    now.report.triangles_after = now.triangles.len();
    [now.report.moved, now.report.gone] = places(coords, &now.coords);
    let mut left = vec![false; triangles.len()];
    now.sources.iter().for_each(|t| left[t.at()] = true);
    now.report.removed = left.iter().filter(|l| !**l).count();
    Ok(now)
}

/// Says what is wrong with a surface.
fn check(now: &mut CertifiedSurface, run: &mut Run) -> Result<()> {
    let found = defects(now, MAX_LISTED, run)?;
    let mut round = found.round(now.triangles.len());
    if found.flat.is_empty() && found.contacts.is_empty() {
        let operand = Operand { vertices: &now.coords, triangles: &now.triangles };
        let a = arrange(&[operand], &ArrangementOptions {}, run)?;
        let solid = extract(&a, &choose(&a, Selection::Resolve)?)?;
        round.rounded = run.watched("certify", 1.0, |watch| rounded(&a, &solid, watch))?.count;
        now.report.certified = solid.flipped.iter().filter(|flipped| !**flipped).count() == now.triangles.len();
    }
    now.report.rounds.push(round);
    now.report.remaining = found.listed();
    Ok(())
}

fn repair(now: &mut CertifiedSurface, options: &CertifyOptions, run: &mut Run) -> Result<()> {
    let (before, unit) = (now.triangles.len().max(16), now.report.unit);
    let most = options.growth.saturating_mul(before);
    let mut best: Option<(Found, CertifiedSurface)> = None;
    run.tick("certify", 0.0)?;
    loop {
        tidy(now);
        // As nobody knows how many rounds there are, each takes half of what is left of the whole.
        let left = 0.5f64.powi(now.report.rounds.len() as i32);
        run.set_part([1.0 - left, 1.0 - 0.5 * left]);
        run.tick("contacts", 0.0)?;
        let mut found = defects(now, most + 1, run)?;
        let level = now.report.rounds.len().saturating_sub(1) / 2;
        let near = if now.report.rounds.is_empty() { 0.0 } else { unit * f64::from(2 << level.min(LEVELS)) };
        now.report.rounds.push(found.round(now.triangles.len()));
        // Work that nobody knows the extent of: the fraction stands still.
        run.set_part([1.0 - left; 2]);
        for _ in 0..FLATTENINGS {
            let distance = unit * FLAT * f64::from(1 << level.min(LEVELS));
            let made = match found.contacts.is_empty() {
                true => Snapped::default(),
                false => flatten(&mut now.coords, &now.triangles, &found.contacts, distance, GRAIN * unit, run)?,
            };
            if !replaced(now, made) {
                break;
            }
            tidy(now);
            found = defects(now, most + 1, run)?;
        }
        for _ in 0..SNAPS {
            if near == 0.0 || found.contacts.is_empty() {
                break;
            }
            let made = snap(&mut now.coords, &now.triangles, &found.contacts, near);
            if !replaced(now, made) {
                break;
            }
            tidy(now);
            found = defects(now, most + 1, run)?;
        }
        let (triangles, contacts, rounds) = (now.triangles.len(), found.contacts.len(), now.report.rounds.len());
        if best.as_ref().is_none_or(|(b, _)| contacts < b.contacts.len()) {
            best = Some((found, now.clone()));
        }
        if rounds > options.rounds || triangles > most || contacts > before {
            break;
        }
        run.set_part([1.0 - left, 1.0 - 0.5 * left]);
        let operand = Operand { vertices: &now.coords, triangles: &now.triangles };
        let a = arrange(&[operand], &ArrangementOptions {}, run)?;
        run.tick("certify", 0.0)?;
        let mut inside = choose(&a, Selection::Resolve)?;
        let mut solid = extract(&a, &inside)?;
        run.tick("certify", 0.0)?;
        let mut made = run.watched("certify", 0.0, |watch| rounded(&a, &solid, watch))?;
        if made.count > 0 {
            let turned = turn_thin_cells(&a, &made.corners, THIN * unit, &mut inside);
            if turned > 0 {
                now.report.thin_cells += turned;
                solid = extract(&a, &inside)?;
                made = run.watched("certify", 0.0, |watch| rounded(&a, &solid, watch))?;
            }
        }
        *now = next(std::mem::take(now), &solid);
        run.tick("certify", 0.0)?;
        if let Some(round) = now.report.rounds.last_mut() {
            round.rounded = made.count;
        }
        now.report.largest_move += made.largest;
        if made.count == 0 {
            now.report.certified = true;
            return Ok(());
        }
    }
    if let Some((found, surface)) = best {
        let rounds = std::mem::take(&mut now.report.rounds);
        *now = surface;
        now.report.rounds = rounds;
        now.report.remaining = found.listed();
    }
    Ok(())
}

/// How many places the second list has that the first does not, and the other way round.
fn places(before: &[[f64; 3]], after: &[[f64; 3]]) -> [usize; 2] {
    let sorted = |coords: &[[f64; 3]]| {
        let mut all: Vec<[u64; 3]> = coords.iter().map(|x| x.map(|x| (x + 0.0).to_bits())).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    let (before, after) = (sorted(before), sorted(after));
    let common = after.iter().filter(|x| before.binary_search(x).is_ok()).count();
    [after.len() - common, before.len() - common]
}

/// Takes over what was snapped. Returns whether anything was.
fn replaced(s: &mut CertifiedSurface, made: Snapped) -> bool {
    if made.count > 0 {
        debug_assert_eq!(made.check(), Ok(()));
        s.report.snapped += made.count;
        s.report.largest_move += made.moved;
        s.sources = made.source.iter().map(|t| s.sources[*t as usize]).collect();
        s.against = made.source.iter().map(|t| s.against[*t as usize]).collect();
        s.triangles = made.triangles;
    }
    made.count > 0
}

/// Corners that lie at one place become the lowest of them. Triangles that lose a corner go, triangles on the same corners that face one another
/// cancel, and corners that no triangle has go.
fn tidy(s: &mut CertifiedSurface) {
    s.coords.iter_mut().flatten().for_each(|c| *c += 0.0);
    let pairs = validate::duplicates(&s.coords, |_| true);
    let mut number: Vec<i32> = (0..s.coords.len() as i32).collect();
    pairs.iter().for_each(|&[lowest, other]| number[other as usize] = lowest as i32);
    s.triangles.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
    let mut keep: Vec<bool> = s.triangles.iter().map(|[a, b, c]| a != b && b != c && c != a).collect();
    // By corners; those that are turned one way, then those turned the other way.
    let name = |[a, b, c]: [i32; 3]| {
        let mut sorted = [a, b, c];
        sorted.sort_unstable();
        (sorted, (a < b) as u8 + (b < c) as u8 + (c < a) as u8 == 2)
    };
    let mut all: Vec<(([i32; 3], bool), u32)> = s.triangles.iter().map(|t| name(*t)).zip(0..).collect();
    all.sort_unstable();
    for same in all.chunk_by(|x, y| x.0.0 == y.0.0).filter(|same| same.len() > 1) {
        let first = same.partition_point(|x| !x.0.1);
        let gone = first.min(same.len() - first);
        same[..gone].iter().chain(&same[first..first + gone]).for_each(|x| keep[x.1 as usize] = false);
    }
    retain_triangles(s, &keep);
}

/// Leaves out triangles, and corners that no other one has.
fn retain_triangles(s: &mut CertifiedSurface, keep: &[bool]) {
    retain(&mut s.triangles, keep);
    retain(&mut s.sources, keep);
    retain(&mut s.against, keep);
    let mut used = vec![false; s.coords.len()];
    s.triangles.iter().flatten().for_each(|v| used[*v as usize] = true);
    let mut place = 0;
    let new: Vec<i32> = used
        .iter()
        .map(|u| {
            place += *u as i32;
            place - 1
        })
        .collect();
    s.triangles.iter_mut().flatten().for_each(|v| *v = new[*v as usize]);
    retain(&mut s.coords, &used);
}

fn retain<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    items.retain(|_| keep.next() == Some(&true));
}

/// What is wrong with a surface.
struct Found {
    flat: Vec<TriangleId>,
    contacts: Vec<[TriangleId; 2]>,
}

impl Found {
    fn round(&self, triangles: usize) -> Round {
        Round { triangles, flat: self.flat.len(), contacts: self.contacts.len(), rounded: 0 }
    }
    fn listed(self) -> Vec<[TriangleId; 2]> {
        let mut all: Vec<_> = self.flat.into_iter().map(|t| [t; 2]).chain(self.contacts).collect();
        all.sort_unstable();
        all.truncate(MAX_LISTED);
        all
    }
}

/// Triangles without area, rising, and pairs of others in contact, sorted, so many at most.
fn defects(s: &CertifiedSurface, limit: usize, run: &mut Run) -> Result<Found> {
    let triangles: Vec<[VertexId; 3]> = s.triangles.iter().map(|t| t.map(|v| VertexId(v as u32))).collect();
    let mut flat = Vec::new();
    validate::degenerate(&s.coords, &triangles, |t| flat.push(TriangleId::of(t)));
    let mut gone = flat.iter().peekable();
    let source: Vec<TriangleId> =
        (0..triangles.len()).map(TriangleId::of).filter(|t| gone.next_if_eq(&t).is_none()).collect();
    let others: Vec<[VertexId; 3]> = source.iter().map(|t| triangles[t.at()]).collect();
    let contacts = run.watched("contacts", 0.0, |watch| {
        let tree = build_bvh_watched(&s.coords, &others, watch);
        self_intersections_watched(&s.coords, &others, &tree, limit, watch)
    })?;
    let contacts = contacts.into_iter().map(|p| p.map(|t| source[t.at()])).collect();
    Ok(Found { flat, contacts })
}

/// How many corners of a solid are not the doubles they round to, and a bound on how far in a coordinate.
struct Rounded {
    count: usize,
    largest: f64,
    /// One entry for each vertex of the arrangement.
    corners: Vec<bool>,
}

/// (Told to stop it returns something or other.)
fn rounded(a: &Arrangement, solid: &Extraction, watch: &Watch) -> Rounded {
    let mut all = Rounded { count: 0, largest: 0.0, corners: vec![false; a.vertex_count()] };
    let input = a.resolved.soup.mesh.vertices.len();
    for (i, (v, x)) in solid.vertices.iter().zip(&solid.coords).enumerate().filter(|(_, (v, _))| v.at() >= input) {
        if i % OFTEN == 0 && !watch.go_on() {
            break;
        }
        let (exact, double) = (a.point(*v), Point::Vertex(*x));
        for axis in (0..3).filter(|&i| exact::compare_coordinate(&exact, &double, i) != Ordering::Equal) {
            all.corners[v.at()] = true;
            let size = x[axis].abs();
            all.largest = all.largest.max(0.5 * (size - size.next_down()).max(size.next_up().min(f64::MAX) - size));
        }
    }
    all.count = all.corners.iter().filter(|c| **c).count();
    all
}

/// An ulp of the largest coordinate.
fn unit(coords: &[[f64; 3]]) -> f64 {
    let largest = coords.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    largest - largest.next_down()
}

/// Cells with a corner that doubles do not have, and hardly thicker than what rounding moves, go over to what they have most area in common with:
/// two sheets that rounding entangles come apart nowhere else. Which cells these are is judged in doubles: any choice of cells is a solid.
/// Returns how many changed.
fn turn_thin_cells(a: &Arrangement, corners: &[bool], thickness: f64, inside: &mut [bool]) -> usize {
    let count = a.cell_count();
    let (mut volume, mut area, mut hit) = (vec![0.0f64; count], vec![0.0f64; count], vec![false; count]);
    let mut common = vec![0.0f64; a.patch_count()];
    let origin: Vec<[f64; 3]> = (0..count)
        .map(|c| a.cells.lowest.get(c).map_or([0.0; 3], |h| a.coords(a.resolved.faces[h.face().at()][0])))
        .collect();
    for (f, corner) in a.resolved.faces.iter().enumerate() {
        let f = FaceId::of(f);
        let [behind, before] = a.face_cells(f);
        if behind.is_none() {
            continue;
        }
        let x = corner.map(|v| a.coords(v));
        let normal = cross(minus(x[1], x[0]), minus(x[2], x[0]));
        let size = 0.5 * length(normal);
        common[a.cells.patch[f.at()].at()] += size;
        for (c, sign) in [(behind, 1.0), (before, -1.0)] {
            volume[c.at()] += sign * dot(normal, minus(x[0], origin[c.at()])) / 6.0;
            area[c.at()] += size;
            hit[c.at()] |= corner.iter().any(|v| corners[v.at()]);
        }
    }
    let thin = |c: usize| c > 0 && hit[c] && volume[c] <= 0.5 * area[c] * thickness;
    // The cell of each set that is not thin, if there is one yet.
    let mut anchor: Vec<Option<usize>> = (0..count).map(|c| (!thin(c)).then_some(c)).collect();
    let mut sets = UnionFind::new(count);
    let mut order: Vec<usize> = (0..a.patch_count()).collect();
    order.sort_by(|&p, &q| common[q].total_cmp(&common[p]).then(p.cmp(&q)));
    for p in order {
        let roots = a.face_cells(a.cells.patch_face[p]).map(|c| sets.find(c.at()));
        let both = roots.map(|r| anchor[r]);
        if roots[0] != roots[1] && (both[0].is_none() || both[1].is_none()) {
            sets.union(roots[0], roots[1]);
            anchor[sets.find(roots[0])] = both[0].or(both[1]);
        }
    }
    let before = inside.to_vec();
    for c in 0..count {
        if let Some(fat) = anchor[sets.find(c)] {
            inside[c] = before[fat];
        }
    }
    before.iter().zip(inside).filter(|(x, y)| x != y).count()
}

/// The solid, with the sources of the surface that it was made from.
fn next(from: CertifiedSurface, solid: &Extraction) -> CertifiedSurface {
    let of = |i: usize| solid.births[i].1 as usize;
    CertifiedSurface {
        coords: solid.coords.clone(),
        triangles: solid.triangles.iter().map(|t| t.map(|v| v as i32)).collect(),
        sources: (0..solid.births.len()).map(|i| from.sources[of(i)]).collect(),
        against: (0..solid.births.len()).map(|i| from.against[of(i)] != solid.flipped[i]).collect(),
        report: from.report,
    }
}

//! Half-faces → shells → cells.
//!
//! A shell is a class of half-faces joined across edges by wedges. Shells are numbered by their lowest half-face. A shell is the outer
//! boundary of a cell, unless the engine says that it is the wall of a void and names a half-face of the shell around it;
//! a chain of such answers ends at an outer shell. Cells are numbered by their outer shells, and voids follow in shell order.
//!
//! Edges around which an engine has joined the half-faces already are passed over ([`Joined`]): those of the uncut surface, nearly all of
//! them on fine input.
//!
//! Cost: linear in the face corners, times the inverse Ackermann function; all of it shared out among threads.

use super::exact_values::volume_within;
use super::radial::{FaceUse, wedge_pairs};
use super::{Complex, HalfFace, SupportId};
use crate::base::bits::ones;
use crate::base::csr::Walk;
use crate::base::parallel::map_ranges;
use crate::base::{CellId, Csr, EdgeId, Error, FaceId, PlaneId, Result, SharedUnionFind, ShellId};
use crate::exact::counters;
use rayon::prelude::*;
use std::ops::Range;

/// The shell of each half-face (`NONE` for the front of a surface face), and the lowest half-face of each shell.
pub struct Shells {
    pub of: Vec<ShellId>,
    pub lowest: Vec<HalfFace>,
}

/// What an engine has joined already, and what it has left.
pub struct Joined {
    /// Classes of half-faces.
    pub classes: SharedUnionFind,
    /// Faces before this one use only edges that are settled, besides those of `uses`.
    pub first_face: usize,
    /// Their other uses of edges: the half-face on the counter-clockwise side.
    pub uses: Vec<(EdgeId, HalfFace)>,
    /// One bit for each edge of a first few: it is not settled. All later edges are not.
    pub open: Vec<u64>,
}

impl Joined {
    pub fn nothing(c: &Complex) -> Self {
        let classes = SharedUnionFind::new(2 * c.face_count());
        Self { classes, first_face: 0, uses: Vec::new(), open: Vec::new() }
    }
}

/// The edges that are not settled, numbered without gaps.
struct OpenEdges<'a> {
    words: &'a [u64],
    /// How many bits are set before each word, and in all.
    before: Vec<u32>,
}

impl<'a> OpenEdges<'a> {
    fn new(words: &'a [u64]) -> Self {
        let mut sum = 0;
        let mut before = Vec::with_capacity(words.len() + 1);
        before.push(0);
        before.extend(words.iter().map(|w| {
            sum += w.count_ones();
            sum
        }));
        Self { words, before }
    }
    /// Number of places in bit words, and how many of them are open.
    fn low(&self) -> (usize, usize) {
        (64 * self.words.len(), self.before[self.words.len()] as usize)
    }
    fn count(&self, edge_count: usize) -> usize {
        let (places, open) = self.low();
        open + edge_count.saturating_sub(places)
    }
    #[inline(always)]
    fn number(&self, edge: EdgeId) -> usize {
        let (word, bit) = (edge.at() / 64, edge.at() % 64);
        match self.words.get(word) {
            Some(bits) => (self.before[word] + (bits & ((1 << bit) - 1)).count_ones()) as usize,
            None => edge.at() - 64 * self.words.len() + self.before[self.words.len()] as usize,
        }
    }
    /// The open edges with numbers in a range, rising.
    fn in_range(&self, range: Range<usize>) -> impl Iterator<Item = EdgeId> {
        let (places, open) = self.low();
        let low = range.start.min(open)..range.end.min(open);
        let word = self.before.partition_point(|&n| n as usize <= low.start) - 1;
        let places_set = ones(64 * word, &self.words[word..]).map(EdgeId::of);
        let skip = low.start - self.before[word] as usize;
        let high = range.start.max(open)..range.end.max(open);
        places_set.skip(skip).take(low.len()).chain(high.map(move |n| EdgeId::of(n - open + places)))
    }
}

/// The uses of open edges, by number of the edge: the half-face on the counter-clockwise side of each.
struct OpenUses<'a> {
    c: &'a Complex,
    joined: &'a Joined,
    open: &'a OpenEdges<'a>,
}

// SAFETY: only reads what is borrowed.
unsafe impl Walk<HalfFace> for OpenUses<'_> {
    /// The uses that were left, then the faces.
    fn positions(&self) -> usize {
        self.joined.uses.len() + self.c.face_count() - self.joined.first_face
    }
    #[inline]
    fn walk(&self, positions: Range<usize>, mut visit: impl FnMut(usize, HalfFace)) {
        let left = self.joined.uses.len();
        for &(edge, h) in &self.joined.uses[positions.start.min(left)..positions.end.min(left)] {
            visit(self.open.number(edge), h);
        }
        let c = self.c;
        let face = |position: usize| self.joined.first_face + position.max(left) - left;
        let faces = face(positions.start)..face(positions.end);
        let mut k = c.loop_offsets[c.face_loops[faces.start] as usize] as usize;
        for f in faces.map(FaceId::of) {
            let end = c.face_corners(f).end;
            for (&v, &edge) in c.corner_vertices[k..end].iter().zip(&c.corner_edges[k..end]) {
                if edge.is_some() {
                    visit(self.open.number(edge), HalfFace::new(f, c.edges[edge.at()][0] == v));
                }
            }
            k = end;
        }
    }
}

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

/// `along()` makes a function that may name two planes P, Q along whose n_P × n_Q an edge runs; it is asked at most once per
/// edge, by rising id.
pub fn find_shells<F>(c: &Complex, joined: &Joined, along: impl Fn() -> F + Sync) -> Result<Shells>
where
    F: FnMut(EdgeId) -> Option<[PlaneId; 2]>,
{
    let classes = &joined.classes;
    let open = OpenEdges::new(&joined.open);
    let row_count = open.count(c.edge_count());
    let uses = Csr::from_walk(row_count, &OpenUses { c, joined, open: &open });
    let on_surface = |h: HalfFace| !c.two_sided && matches!(c.face_support[h.face().at()], SupportId::Triangle(_));
    let outcomes = map_ranges(row_count, LEAST, |range| {
        let (mut row, mut scratch, mut simple) = (Vec::new(), Vec::new(), 0);
        let mut along = along();
        for (n, edge) in range.clone().zip(open.in_range(range)) {
            match *uses.row(n) {
                [] => {}
                [a, b] if on_surface(a) && on_surface(b) => {
                    classes.union(HalfFace::new(a.face(), false).at(), HalfFace::new(b.face(), false).at());
                    simple += 1;
                }
                ref all => {
                    row.clear();
                    let face_use = |h: &HalfFace| FaceUse { face: h.face(), forward: h.front(), corner: u32::MAX };
                    row.extend(all.iter().map(face_use));
                    wedge_pairs(c, edge, &row, along(edge), &mut scratch, |_, a, _, b| {
                        classes.union(a.at(), b.at());
                    })?;
                }
            }
        }
        counters::count_many(counters::Predicate::RadialOrder, counters::Tier::Topology, simple);
        Ok(())
    });
    // The first error by edge, whichever thread was faster.
    outcomes.into_iter().collect::<Result<()>>()?;
    let outside = |h: usize| h & 1 != 0 && on_surface(HalfFace(h as u32));
    let (of, lowest) = classes.labels(|h| !outside(h));
    let of = of.into_iter().map(ShellId).collect();
    Ok(Shells { of, lowest: lowest.into_iter().map(HalfFace).collect() })
}

/// Fills the cells of a complex from its shells. `host(shell)` is `None` for an outer shell and, for the wall of a void, a half-face of the
/// shell around it.
pub fn form_cells(c: &mut Complex, shells: &Shells, host: &[Option<HalfFace>]) -> Result<()> {
    if host.iter().all(Option::is_none) {
        // A cell per shell: nothing to look up.
        let count = shells.lowest.len();
        c.cell_shells = (0..=count as u32).collect();
        sort_half_faces(c, shells, count, |s| s.at(), |s| CellId(s.0));
    } else {
        let (cell_of, cells) = hang_voids(shells, host)?;
        fill_cells(c, shells, cells, &cell_of, |s| host[s.at()].is_none());
    }
    let same = |range: Range<usize>| range.into_iter().find(|&f| c.face_cells[f][0] == c.face_cells[f][1]);
    match map_ranges(c.face_count(), LEAST, same).into_iter().flatten().next() {
        None => Ok(()),
        Some(f) => {
            Err(Error::inconsistent(format!("face {f} has the same cell on both sides: the surface intersects itself")))
        }
    }
}

/// Fills the cells of a complex from its shells, given the cell of each, of which one is the outer one.
pub fn fill_cells(
    c: &mut Complex,
    shells: &Shells,
    cells: usize,
    cell_of: &[CellId],
    is_outer: impl Fn(ShellId) -> bool,
) {
    // Shells by cell, the outer one first.
    let count = cell_of.len();
    let all = || (0..count).map(ShellId::of);
    let (outer, voids) = (all().filter(|&s| is_outer(s)), all().filter(|&s| !is_outer(s)));
    let by_cell = Csr::from_pairs(cells, outer.chain(voids).map(|s| (cell_of[s.at()].at(), s)));
    let mut place = vec![0u32; count];
    by_cell.items.iter().enumerate().for_each(|(i, s)| place[s.at()] = i as u32);
    c.cell_shells = by_cell.offsets;
    let cell = |s: ShellId| if s.is_none() { CellId::NONE } else { cell_of[s.at()] };
    sort_half_faces(c, shells, count, |s| place[s.at()] as usize, cell);
}

/// The outer shell of each cell, given the cell of each shell: it reaches farthest along x; where several reach as far, it is the one with positive
/// volume. `Inconsistent` for a cell without one.
pub fn outer_shells(c: &Complex, shells: &Shells, cell_of: &[CellId], cells: usize) -> Result<Vec<ShellId>> {
    let of_cell = Csr::from_pairs(cells, cell_of.iter().enumerate().map(|(s, cell)| (cell.at(), ShellId::of(s))));
    let lost = |cell: usize| Error::inconsistent(format!("cell {cell} has no outer shell"));
    if of_cell.rows().all(|row| row.len() == 1) {
        return Ok(of_cell.items);
    }
    // Rounding keeps the order of coordinates.
    let mut reach = vec![f64::NEG_INFINITY; cell_of.len()];
    let half_faces =
        || shells.of.iter().enumerate().map(|(h, s)| (HalfFace(h as u32), *s)).filter(|(_, s)| s.is_some());
    for (h, s) in half_faces() {
        for &v in &c.corner_vertices[c.face_corners(h.face())] {
            reach[s.at()] = reach[s.at()].max(c.coords[v.at()][0]);
        }
    }
    let mut outer = Vec::with_capacity(cells);
    for (cell, row) in of_cell.rows().enumerate() {
        let far = row.iter().map(|s| reach[s.at()]).fold(f64::NEG_INFINITY, f64::max);
        let mut farthest = row.iter().copied().filter(|s| reach[s.at()] == far);
        let first = farthest.next().ok_or_else(|| lost(cell))?;
        let positive = |s: &ShellId| {
            let faces: Vec<HalfFace> = half_faces().filter(|(_, t)| t == s).map(|(h, _)| h).collect();
            volume_within(c, &faces) > 0
        };
        outer.push(match farthest.next() {
            None => first,
            Some(second) => [first, second].into_iter().chain(farthest).find(positive).ok_or_else(|| lost(cell))?,
        });
    }
    Ok(outer)
}

/// The cell of each shell, and the number of cells.
fn hang_voids(shells: &Shells, host: &[Option<HalfFace>]) -> Result<(Vec<CellId>, usize)> {
    let count = host.len();
    let mut cell_of = vec![CellId::NONE; count];
    let mut cells = 0;
    for s in 0..count {
        if host[s].is_none() {
            cell_of[s] = CellId::of(cells);
            cells += 1;
        }
    }
    for s in 0..count {
        let (mut at, mut steps) = (s, 0);
        while cell_of[at].is_none() {
            at = match host[at] {
                Some(h) if steps <= count => shells.of[h.at()].at(),
                _ => return Err(Error::inconsistent("walls of voids enclose each other")),
            };
            steps += 1;
        }
        cell_of[s] = cell_of[at];
    }
    Ok((cell_of, cells))
}

/// Half-faces by shell, given where each shell is among all, and the cells of each face.
fn sort_half_faces(
    c: &mut Complex,
    shells: &Shells,
    count: usize,
    place: impl Fn(ShellId) -> usize + Sync,
    cell: impl Fn(ShellId) -> CellId + Sync,
) {
    let place = &place;
    c.shell_faces = Csr::from_positions(count, shells.of.len(), |range| {
        let half_faces = range.clone().zip(&shells.of[range]).filter(|(_, s)| s.is_some());
        half_faces.map(move |(h, &s)| (place(s), HalfFace(h as u32)))
    });
    c.face_cells = shells.of.par_chunks_exact(2).with_min_len(LEAST).map(|of| [cell(of[0]), cell(of[1])]).collect();
}

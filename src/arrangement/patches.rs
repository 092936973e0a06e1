//! Faces → patches: net multiplicities, balance at every edge, faces joined across edges with two faces (section 3.2 of the paper).
//!
//! The net multiplicity of a face counts, per operand, its births that are oriented like it less those that are not. A face where all are zero divides
//! nothing and is left out, so that an edge may turn out to have two faces, or none. At every edge the faces that walk it forward and those that
//! walk it backward must have equal sums, for each operand: else the operand has a boundary there.
//!
//! Edges come from two places. Those of the soup have their uses in the soup; only those on which parts of cut triangles lie are looked up among
//! the edges of the parts, for which a table is made. Soup edges that are split have cut triangles only, so nothing of them is left.
//!
//! Across an edge with two faces that walk it in opposite directions the two continue each other, with equal multiplicities: such faces are one *sheet*. Two
//! faces that walk it in the same direction have opposite multiplicities (parts of supports that are oriented unlike): their sheets are one *patch*,
//! the one reversed. A patch has the same cell all along each of its sides.
//!
//! Edges with more faces are handed on as *fans*, for the radial order.
//!
//! Cost: linear in the edges; some nanoseconds for an edge of the soup that nothing touches.

use super::{Multiplicity, Operand, Resolved};
use crate::base::parallel::map_ranges;
use crate::base::{
    Csr, Culprit, DefectKind, EdgeId, Error, FaceId, OperandId, PatchId, Result, Run, SharedUnionFind, Status,
    TriangleId, UnionFind, VertexId, Watch,
};
use crate::complex::HalfFace;
use crate::mesh::EdgeUse;
use crate::mesh::edges::{EdgeTable, edge_table};
use rayon::prelude::*;
use std::ops::Range;

/// A side of a patch: `patch << 1 | front`, with respect to the patch's lowest face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(transparent)]
pub struct HalfPatch(pub u32);

impl HalfPatch {
    pub const NONE: Self = Self(u32::MAX);

    #[inline(always)]
    pub fn of(h: usize) -> Self {
        Self(h as u32)
    }
    #[inline(always)]
    pub fn patch(self) -> PatchId {
        if self.is_none() { PatchId::NONE } else { PatchId(self.0 >> 1) }
    }
    #[inline(always)]
    pub fn is_none(self) -> bool {
        self.0 == u32::MAX
    }
    #[inline(always)]
    pub fn at(self) -> usize {
        self.0 as usize
    }
    #[inline(always)]
    pub fn other(self) -> Self {
        Self(self.0 ^ 1)
    }
}

/// One walk of a face along an edge: `face << 1 | forward`, from the lower end of the edge to the higher one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(transparent)]
pub struct Walk(pub u32);

impl Walk {
    #[inline(always)]
    fn new(face: FaceId, forward: bool) -> Self {
        Self(face.0 << 1 | forward as u32)
    }
    #[inline(always)]
    pub fn face(self) -> FaceId {
        FaceId(self.0 >> 1)
    }
    #[inline(always)]
    pub fn forward(self) -> bool {
        self.0 & 1 != 0
    }
}

/// An edge at which an operand does not balance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Unbalanced {
    pub operand: OperandId,
    pub ends: [VertexId; 2],
    /// One of the operand's triangles there.
    pub triangle: TriangleId,
}

/// Faces by patch, and the edges where more than two meet.
#[derive(Clone, Debug)]
pub struct Patches {
    /// The side of its patch that is behind each face; `NONE` for faces that divide nothing.
    pub behind: Vec<HalfPatch>,
    /// The lowest face of each patch; patches are numbered by it.
    pub lowest: Vec<FaceId>,
    /// Net multiplicities along the lowest face, per patch.
    pub multiplicity: Csr<Multiplicity>,
    /// Edges with more than two faces that divide, lower end first.
    pub fan_ends: Vec<[VertexId; 2]>,
    /// Their faces, rising.
    pub fans: Csr<Walk>,
    /// Every operand and edge that does not balance: what else is here means nothing unless this is empty.
    pub unbalanced: Vec<Unbalanced>,
}

impl Patches {
    /// The side of its patch that a half-face is on.
    #[inline(always)]
    pub fn side(&self, h: HalfFace) -> HalfPatch {
        let behind = self.behind[h.face().at()];
        if h.front() { behind.other() } else { behind }
    }

    pub fn check(&self, r: &Resolved) -> std::result::Result<(), String> {
        self.multiplicity.check()?;
        self.fans.check()?;
        let n = self.lowest.len();
        if self.behind.len() != r.faces.len() || self.multiplicity.len() != n || self.fans.len() != self.fan_ends.len()
        {
            return Err("patches: lengths differ".into());
        }
        let mut next = 0;
        for (f, side) in self.behind.iter().enumerate().filter(|(_, side)| !side.is_none()) {
            let p = side.patch().at();
            if p > next || (p == next && (self.lowest.get(p) != Some(&FaceId::of(f)) || side.0 & 1 != 0)) {
                return Err(format!("patch {p} is not numbered by its lowest face"));
            }
            next = next.max(p + 1);
        }
        if next != n || self.multiplicity.rows().any(|row| row.is_empty() || row.iter().any(|m| m.1 == 0)) {
            return Err("a patch has no face or no multiplicity".into());
        }
        if self.fans.rows().any(|row| row.len() < 3 || row.windows(2).any(|w| w[0] >= w[1])) {
            return Err("a fan has less than three faces, or they are not sorted".into());
        }
        Ok(())
    }
}

/// What is known about each face.
struct Faces<'a> {
    r: &'a Resolved,
    /// The whole face of which each triangle is the support.
    of_triangle: Vec<FaceId>,
    /// A bit for each face that is shared; empty if none is.
    shared: Vec<u64>,
    /// The net multiplicities of shared faces.
    net: Csr<Multiplicity>,
}

impl<'a> Faces<'a> {
    fn new(r: &'a Resolved) -> Self {
        let mut of_triangle = vec![FaceId::NONE; r.soup.mesh.triangles.len()];
        r.support[..r.whole].iter().enumerate().for_each(|(f, t)| of_triangle[t.at()] = FaceId::of(f));
        let mut shared = vec![0u64; if r.shared.is_empty() { 0 } else { r.faces.len().div_ceil(64) }];
        r.shared.iter().for_each(|f| shared[f.at() / 64] |= 1 << (f.at() % 64));
        let mut net = Csr::with_capacity(r.shared.len(), r.shared.len());
        // Births are by triangle, so by operand.
        for births in r.births.rows() {
            let start = net.items.len();
            for b in births {
                let (operand, sign) = (r.soup.operand(b.triangle), if b.same { 1 } else { -1 });
                match net.items[start..].last_mut() {
                    Some((last, sum)) if *last == operand => *sum += sign,
                    _ => net.items.push((operand, sign)),
                }
            }
            let mut kept = start;
            for i in start..net.items.len() {
                net.items[kept] = net.items[i];
                kept += (net.items[i].1 != 0) as usize;
            }
            net.items.truncate(kept);
            net.end_row();
        }
        Self { r, of_triangle, shared, net }
    }

    #[inline(always)]
    fn is_shared(&self, f: FaceId) -> bool {
        !self.shared.is_empty() && self.shared[f.at() / 64] >> (f.at() % 64) & 1 != 0
    }
    fn shared_net(&self, f: FaceId) -> &[Multiplicity] {
        self.net.row(self.r.shared.binary_search(&f).unwrap_or(0))
    }
    /// Whether the face has a multiplicity.
    #[inline(always)]
    fn divides(&self, f: FaceId) -> bool {
        !self.is_shared(f) || !self.shared_net(f).is_empty()
    }
    fn each_net(&self, f: FaceId, mut visit: impl FnMut(Multiplicity)) {
        if self.is_shared(f) {
            self.shared_net(f).iter().for_each(|&m| visit(m));
        } else {
            visit((self.r.soup.operand(self.r.support[f.at()]), 1));
        }
    }
    /// A triangle of an operand that a face is a part of, if it is of any.
    fn triangle_of(&self, f: FaceId, operand: OperandId) -> Option<TriangleId> {
        let is = |t: TriangleId| self.r.soup.operand(t) == operand;
        if self.is_shared(f) {
            let births = self.r.births.row(self.r.shared.binary_search(&f).unwrap_or(0));
            return births.iter().map(|b| b.triangle).find(|&t| is(t));
        }
        Some(self.r.support[f.at()]).filter(|&t| is(t))
    }
}

/// The operand of a triangle, asked again and again for neighbours.
struct Near<'a> {
    first: &'a [u32],
    range: Range<u32>,
}

impl<'a> Near<'a> {
    fn new(first: &'a [u32]) -> Self {
        Self { first, range: 0..0 }
    }
    /// Whether two triangles are of one operand.
    #[inline(always)]
    fn same(&mut self, a: TriangleId, b: TriangleId) -> bool {
        if !self.range.contains(&a.0) {
            let i = self.first.partition_point(|&first| first <= a.0) - 1;
            self.range = self.first[i]..self.first[i + 1];
        }
        self.range.contains(&b.0)
    }
}

/// What a range of edges yields: where patches do not simply go on.
#[derive(Default)]
struct Found {
    /// Faces that walk an edge in the same direction.
    unlike: Vec<[FaceId; 2]>,
    fan_ends: Vec<[VertexId; 2]>,
    fans: Csr<Walk>,
    unbalanced: Vec<Unbalanced>,
    sums: Vec<(OperandId, i64)>,
}

impl Found {
    /// Takes the faces that divide at an edge, rising. `walks` has them all.
    fn edge(&mut self, faces: &Faces, ends: [VertexId; 2], walks: &mut Vec<Walk>, sheets: &SharedUnionFind) {
        walks.retain(|w| faces.divides(w.face()));
        if walks.is_empty() {
            return;
        }
        self.sums.clear();
        for w in walks.iter() {
            faces.each_net(w.face(), |(i, m)| self.sums.push((i, if w.forward() { m as i64 } else { -m as i64 })));
        }
        self.sums.sort_unstable();
        let mut balanced = true;
        for sum in self.sums.chunk_by(|a, b| a.0 == b.0) {
            if sum.iter().map(|s| s.1).sum::<i64>() != 0 {
                balanced = false;
                let triangle = walks.iter().find_map(|w| faces.triangle_of(w.face(), sum[0].0));
                let triangle = triangle.unwrap_or(TriangleId::NONE);
                self.unbalanced.push(Unbalanced { operand: sum[0].0, ends, triangle });
            }
        }
        match walks[..] {
            _ if !balanced => {}
            [a, b] if a.forward() != b.forward() => sheets.union(a.face().at(), b.face().at()),
            [a, b] => self.unlike.push([a.face(), b.face()]),
            _ => {
                walks.sort_unstable();
                self.fan_ends.push(ends);
                self.fans.push_row(walks);
            }
        }
    }
}

/// Edges in one task at least, and edges whose findings are put together at once.
const LEAST: usize = 1 << 14;
const BLOCK: usize = 1 << 21;
/// Edges between two looks at the caller's wish to stop.
const OFTEN: usize = 1 << 10;

/// Joins faces to patches. Errors: `Cancelled`.
pub fn patches(r: &Resolved, run: &mut Run) -> Result<Patches> {
    let faces = Faces::new(r);
    run.tick("patches", 0.7)?;
    let mesh = &r.soup.mesh;
    let parts = edge_table(r.vertex_count(), &r.faces[r.whole..]);
    run.tick("patches", 0.7)?;
    let places = soup_edges(r, &parts);
    // Edges of the soup that are among those of the parts.
    let mut taken = vec![0u64; mesh.edges.len().div_ceil(64)];
    places.iter().filter(|e| e.is_some()).for_each(|e| taken[e.at() / 64] |= 1 << (e.at() % 64));
    let sheets = SharedUnionFind::new(r.faces.len());
    run.tick("patches", 0.7)?;
    let mut found = Vec::new();
    let mut start = 0;
    while start < mesh.edges.len() {
        let block = start..mesh.edges.len().min(start + BLOCK);
        let look = |range: Range<usize>, watch: &Watch| {
            let mut found = Found::default();
            let mut walks = Vec::new();
            let mut near = Near::new(&r.soup.first_triangle);
            for e in block.start + range.start..block.start + range.end {
                if e % OFTEN == 0 && !watch.go_on() {
                    break;
                }
                if taken[e / 64] >> (e % 64) & 1 != 0 {
                    continue;
                }
                let uses = mesh.edge_uses.row(e);
                if let [a, b] = uses {
                    let (f, g) = (faces.of_triangle[a.triangle.at()], faces.of_triangle[b.triangle.at()]);
                    if f.is_some() && g.is_some() && a.forward() != b.forward() {
                        let plain = faces.shared.is_empty() || !(faces.is_shared(f) || faces.is_shared(g));
                        if plain && near.same(a.triangle, b.triangle) {
                            sheets.union(f.at(), g.at());
                            continue;
                        }
                    }
                }
                walks.clear();
                walks_of_soup(&faces, uses, &mut walks);
                found.edge(&faces, mesh.edges[e], &mut walks, &sheets);
            }
            found
        };
        let watched = |watch: &Watch| map_ranges(block.len(), LEAST, |range| look(range, watch));
        found.extend(run.watched("patches", 0.7, watched)?);
        start = block.end;
        run.tick("patches", 0.7)?;
    }
    let mut start = 0;
    while start < parts.edges.len() {
        let block = start..parts.edges.len().min(start + BLOCK);
        let look = |range: Range<usize>, watch: &Watch| {
            let mut found = Found::default();
            let mut walks = Vec::new();
            let edges = block.start + range.start..block.start + range.end;
            for (e, &place) in edges.clone().zip(&places[edges]) {
                if e % OFTEN == 0 && !watch.go_on() {
                    break;
                }
                walks.clear();
                if place.is_some() {
                    walks_of_soup(&faces, mesh.edge_uses.row(place), &mut walks);
                }
                let face = |u: &EdgeUse| FaceId::of(r.whole + u.triangle.at());
                walks.extend(parts.edge_uses.row(e).iter().map(|u| Walk::new(face(u), u.forward())));
                found.edge(&faces, parts.edges[e], &mut walks, &sheets);
            }
            found
        };
        let watched = |watch: &Watch| map_ranges(block.len(), LEAST, |range| look(range, watch));
        found.extend(run.watched("patches", 0.72, watched)?);
        start = block.end;
        run.tick("patches", 0.72)?;
    }
    drop((parts, places, taken));
    let unlike = found.iter().flat_map(|f| &f.unlike).copied();
    let sheet_sides = |count: usize, of: &[u32]| sides(count, of, unlike.clone());
    let (of, lowest) = sheets.labels(|f| faces.divides(FaceId::of(f)));
    drop(sheets);
    run.tick("patches", 0.75)?;
    let (sheet_side, first_sheets) = sheet_sides(lowest.len(), &of)?;
    run.tick("patches", 0.75)?;
    let behind = of.into_par_iter().with_min_len(LEAST).map(|s| match s {
        u32::MAX => HalfPatch::NONE,
        s => sheet_side[s as usize],
    });
    let behind = behind.collect();
    let lowest: Vec<FaceId> = first_sheets.iter().map(|&s| FaceId(lowest[s as usize])).collect();
    let mut multiplicity = Csr::with_capacity(lowest.len(), lowest.len());
    for &f in &lowest {
        faces.each_net(f, |m| multiplicity.items.push(m));
        multiplicity.end_row();
    }
    run.tick("patches", 0.75)?;
    let mut unbalanced: Vec<Unbalanced> = found.iter().flat_map(|f| &f.unbalanced).copied().collect();
    unbalanced.sort_unstable();
    let fan_ends = found.iter().flat_map(|f| &f.fan_ends).copied().collect();
    let fans = Csr::concat(found.into_iter().map(|f| f.fans).collect());
    Ok(Patches { behind, lowest, multiplicity, fan_ends, fans, unbalanced })
}

/// At most so many edges are listed in an error.
const LISTED: usize = 100;

/// The error for edges that do not balance.
pub fn unbalanced_error(r: &Resolved, operands: &[Operand], edges: &[Unbalanced]) -> Error {
    // The operand's own name for a position; only on the way to an error.
    let vertex = |u: &Unbalanced, end: VertexId| -> i64 {
        let x = r.coords(end);
        let input = end.at() < r.soup.mesh.vertices.len();
        let of = operands.get(u.operand.at()).filter(|_| input);
        of.and_then(|o| o.vertices.iter().position(|v| *v == x)).map_or(-1, |v| v as i64)
    };
    let culprit = |u: &Unbalanced| {
        let [a, b] = u.ends.map(|end| vertex(u, end));
        Culprit::new(DefectKind::UnbalancedEdge, &[u.operand.0 as i64, a, b])
    };
    let culprits: Vec<Culprit> = edges.iter().take(LISTED).map(culprit).collect();
    let message = match (edges, &culprits[..]) {
        ([u, ..], [culprit, ..]) => {
            let name = |i: usize| {
                // (With an exponent where it is short so.)
                let [x, y, z] = r.coords(u.ends[i]);
                match culprit.ids[i + 1] {
                    -1 => format!("({x:?}, {y:?}, {z:?})"),
                    v => format!("vertex {v} ({x:?}, {y:?}, {z:?})"),
                }
            };
            let source = r.soup.source.get(u.triangle.at()).map_or(String::new(), |t| format!(", triangle {t}"));
            let more = if edges.len() > 1 { format!(" (and {} more edges)", edges.len() - 1) } else { String::new() };
            format!(
                "operand {}{source}: its triangles do not balance at the edge from {} to {}{more}",
                u.operand.0,
                name(0),
                name(1)
            )
        }
        _ => String::new(),
    };
    Error::with(Status::BadMesh, message, culprits)
}

/// The whole faces at an edge of the soup. Of triangles with equal corners only the lowest is a face.
fn walks_of_soup(faces: &Faces, uses: &[EdgeUse], walks: &mut Vec<Walk>) {
    let face = |u: &EdgeUse| Some(faces.of_triangle[u.triangle.at()]).filter(|f| f.is_some());
    walks.extend(uses.iter().filter_map(|u| face(u).map(|f| Walk::new(f, u.forward()))));
}

/// For each edge of the parts the same edge of the soup, `NONE` if there is none. Both are sorted.
fn soup_edges(r: &Resolved, parts: &EdgeTable) -> Vec<EdgeId> {
    let (edges, inputs) = (&r.soup.mesh.edges, r.soup.mesh.vertices.len());
    let places = map_ranges(parts.edges.len(), LEAST, |range| {
        let mut from = 0;
        let mut places = Vec::with_capacity(range.len());
        for ends in &parts.edges[range] {
            if ends[1].at() >= inputs {
                places.push(EdgeId::NONE);
                continue;
            }
            from += edges[from..].partition_point(|e| e < ends);
            places.push(if edges.get(from) == Some(ends) { EdgeId::of(from) } else { EdgeId::NONE });
        }
        places
    });
    crate::base::parallel::concat(places)
}

/// Joins sheets whose faces walk an edge in the same direction. Returns the side of its patch that is behind each sheet, and the lowest sheet
/// of each patch.
fn sides(count: usize, sheet: &[u32], unlike: impl Iterator<Item = [FaceId; 2]>) -> Result<(Vec<HalfPatch>, Vec<u32>)> {
    // Sides of sheets; the lowest member of a set tells which side of the lowest sheet it is.
    let mut sets = UnionFind::new(2 * count);
    for [a, b] in unlike {
        let (a, b) = (sheet[a.at()] as usize, sheet[b.at()] as usize);
        sets.union(2 * a, 2 * b + 1);
        sets.union(2 * a + 1, 2 * b);
    }
    let mut patch = vec![u32::MAX; count];
    let mut lowest = Vec::new();
    let mut behind = Vec::with_capacity(count);
    for s in 0..count {
        let root = sets.find(2 * s);
        if sets.find(2 * s + 1) == root {
            // Balance along the way round would make the multiplicity its own negative.
            return Err(Error::new(Status::Internal, "a patch with one side"));
        }
        if root == 2 * s {
            patch[s] = lowest.len() as u32;
            lowest.push(s as u32);
        }
        behind.push(HalfPatch(patch[root / 2] << 1 | (root & 1) as u32));
    }
    Ok((behind, lowest))
}

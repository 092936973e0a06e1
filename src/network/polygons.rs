//! The polygons of one simplex, from its active functions (materials) to vertices on its nodes, edges, facets and inside.
//!
//! One function that changes sign (two materials) goes through the table of sign codes; more need the complex of the simplex
//! (`simplex/`). Functions that vanish on a corner or an edge only split nothing and are left out; those that vanish on a facet matter for the pieces
//! of that facet.
//!
//! Pieces of a facet are polygons if the labels on its two sides differ, or if a function vanishes there that does not vanish on both sides; the lower
//! simplex emits them. Its own complex divides the facet as the other one would: what crosses a facet is active on both sides. The other side's labels follow
//! from the values at its node that is not on the facet. Facets on the boundary of the domain have no polygons.

use super::data::{SetItem, Values};
use super::domain::Domain;
use super::points::Span;
use super::sets::SetTable;
use super::simplex::{
    Carrier, FaceSupport, Kind, LocalFace, LocalFunction, LocalVertex, Scratch, SimplexComplex, arrangement, interface,
};
use super::table::{EDGE_OF_MASK, FACETS, LOOPS};
use crate::base::{Csr, FunctionId, NodeId, TetId};
use crate::exact::Sign;
use std::sync::atomic::{AtomicU64, Ordering};

/// A vertex before all are numbered: a tag in the two highest bits.
pub mod reference {
    pub const TAG: u32 = 3 << 30;
    /// The id of a vertex on an edge.
    pub const EDGE: u32 = 0;
    /// A node.
    pub const NODE: u32 = 1 << 30;
    /// A place in the list of points on facets.
    pub const FACET: u32 = 2 << 30;
    /// A place in the list of points inside simplices.
    pub const INSIDE: u32 = 3 << 30;
}

/// Nodes on the network, marked by whoever finds them.
pub struct Marks(Vec<AtomicU64>);

impl Marks {
    pub fn new(nodes: usize) -> Self {
        Self((0..nodes.div_ceil(64)).map(|_| AtomicU64::new(0)).collect())
    }
    #[inline]
    fn set(&self, node: NodeId) {
        // Which of two tasks comes first makes no difference.
        self.0[node.at() / 64].fetch_or(1 << (node.at() % 64), Ordering::Relaxed);
    }
    pub fn words(&self) -> impl Iterator<Item = u64> + '_ {
        self.0.iter().map(|w| w.load(Ordering::Relaxed))
    }
}

/// Points on facets or inside simplices: the nodes of the carrier, the functions there, and those that give the place.
#[derive(Default)]
pub struct CarrierPoints {
    pub nodes: Vec<[NodeId; 4]>,
    pub functions: Csr<FunctionId>,
    pub encoding: Vec<[FunctionId; 4]>,
}

/// What a task finds.
#[derive(Default)]
pub struct Pieces {
    pub polygons: Csr<u32>,
    pub set: Vec<u32>,
    pub tets: Vec<[TetId; 2]>,
    pub sets: SetTable,
    pub facet_points: CarrierPoints,
    pub inside_points: CarrierPoints,
    /// Simplices by number of active functions.
    pub active: Vec<u64>,
    /// Working memory of whoever feeds the simplices: active functions, and materials.
    pub active_functions: Vec<Active>,
    pub materials: Vec<FunctionId>,
    work: Work,
}

#[derive(Default)]
struct Work {
    scratch: Scratch,
    complex: SimplexComplex,
    values: Vec<f64>,
    /// The functions that are in the complex.
    functions: Vec<FunctionId>,
    split: Vec<Active>,
    flat: Vec<Active>,
    vertices: Vec<u32>,
    items: Vec<SetItem>,
}

/// What all tasks share.
pub struct Context<'a> {
    pub kind: Kind,
    pub domain: &'a Domain,
    pub values: &'a Values<'a>,
    /// Of the points on edges.
    pub edge_functions: &'a Csr<FunctionId>,
    pub marks: &'a Marks,
}

/// A simplex, positively oriented or not.
pub struct Simplex {
    pub dim: usize,
    pub tet: TetId,
    pub nodes: [NodeId; 4],
    pub positive: bool,
}

/// An active function: corners where it is positive and where it is negative.
#[derive(Clone, Copy, Debug)]
pub struct Active {
    pub function: FunctionId,
    pub positive: u8,
    pub negative: u8,
}

/// A facet with polygons.
#[derive(Clone, Copy)]
struct Facet {
    set: u32,
    tets: [TetId; 2],
    /// The positive side is not that of the simplex.
    flipped: bool,
}

fn sign_at(mask_positive: u8, mask_negative: u8, corner: usize) -> Sign {
    Sign::of((mask_positive >> corner & 1) as f64 - (mask_negative >> corner & 1) as f64)
}

/// By sign of the difference of two signs, as numbers.
fn rise(from: Sign, to: Sign) -> Sign {
    Sign::from_ordering(to.cmp(&from))
}

impl Pieces {
    /// Counts an active simplex.
    #[inline]
    pub fn count_active(&mut self, functions: usize, simplices: u64) {
        if self.active.len() <= functions {
            self.active.resize(functions + 1, 0);
        }
        self.active[functions] += simplices;
    }

    #[inline(always)]
    pub fn end_polygon(&mut self, set: u32, tets: [TetId; 2]) {
        self.polygons.end_row();
        self.set.push(set);
        self.tets.push(tets);
    }

    /// The vertex of a table: a node, or the only point on an edge.
    #[inline(always)]
    fn push_point(&mut self, context: &Context, s: &Simplex, mask: u8, edges: &impl Fn(usize) -> Span) {
        if mask.is_power_of_two() {
            self.push_node(context, s.nodes[mask.trailing_zeros() as usize]);
        } else {
            let span = edges(EDGE_OF_MASK[mask as usize] as usize);
            debug_assert_eq!(span.count, 1);
            self.polygons.items.push(span.first);
        }
    }

    #[inline(always)]
    fn push_node(&mut self, context: &Context, node: NodeId) {
        context.marks.set(node);
        self.polygons.items.push(reference::NODE | node.0);
    }

    /// The loop of the table for a code.
    #[inline]
    fn push_loop(&mut self, context: &Context, s: &Simplex, code: u8, set: u32, edges: &impl Fn(usize) -> Span) {
        let found = &LOOPS[s.dim - 2][code as usize];
        if found.len == 0 {
            return;
        }
        let points = &found.points[..found.len as usize];
        if s.positive {
            points.iter().for_each(|&p| self.push_point(context, s, p, edges));
        } else {
            points.iter().rev().for_each(|&p| self.push_point(context, s, p, edges));
        }
        self.end_polygon(set, [s.tet; 2]);
    }

    /// A whole facet.
    fn push_facet(&mut self, context: &Context, s: &Simplex, i: usize, facet: &Facet) {
        let corners = &FACETS[s.dim - 2][i][..s.dim];
        if s.positive != facet.flipped {
            corners.iter().for_each(|&c| self.push_node(context, s.nodes[c]));
        } else {
            corners.iter().rev().for_each(|&c| self.push_node(context, s.nodes[c]));
        }
        self.end_polygon(facet.set, facet.tets);
    }

    /// A face of the local complex.
    fn push_face(
        &mut self,
        context: &Context,
        s: &Simplex,
        face: LocalFace,
        flipped: bool,
        edges: &impl Fn(usize) -> Span,
    ) {
        let range = self.work.complex.face_vertices.range(face);
        let count = range.len();
        for k in 0..count {
            let at = if s.positive != flipped { k } else { count - 1 - k };
            let v = self.work.complex.face_vertices.items[range.start + at];
            let reference = self.vertex(context, s, v, edges);
            self.polygons.items.push(reference);
        }
    }

    /// The vertex of the local complex, found once.
    fn vertex(&mut self, context: &Context, s: &Simplex, v: LocalVertex, edges: &impl Fn(usize) -> Span) -> u32 {
        let known = self.work.vertices[v.at()];
        if known != u32::MAX {
            return known;
        }
        let carrier = self.work.complex.vertex_carrier[v.at()];
        let found = match carrier.dim() {
            0 => {
                let node = s.nodes[carrier.0.trailing_zeros() as usize];
                context.marks.set(node);
                reference::NODE | node.0
            }
            1 => self.edge_vertex(context, v, edges(EDGE_OF_MASK[carrier.0 as usize] as usize)),
            d => self.carrier_vertex(context, s, v, carrier, d == s.dim),
        };
        self.work.vertices[v.at()] = found;
        found
    }

    /// The one of the points on an edge that has a function of the vertex: the edge's points have all functions, and no function that crosses the
    /// edge vanishes at two of them. Of an interface: the one with the same materials.
    fn edge_vertex(&self, context: &Context, v: LocalVertex, span: Span) -> u32 {
        if span.count == 1 {
            return span.first;
        }
        let local = self.work.complex.vertex_functions.row(v);
        let global = |f: &LocalFunction| self.work.functions[f.at()];
        let ids = span.first..span.first + span.count;
        let same = |id: &u32| {
            let row = context.edge_functions.row(*id as usize);
            match context.kind {
                Kind::Interface => row.len() == local.len() && row.iter().zip(local).all(|(a, b)| *a == global(b)),
                // Functions that vanish on the whole edge are at all of its points, and there is another one.
                Kind::Arrangement => local.iter().all(|f| row.binary_search(&global(f)).is_ok()),
            }
        };
        ids.into_iter().find(same).expect("the points of an edge are the same in every simplex")
    }

    /// A point inside a facet or the simplex, noted for later.
    fn carrier_vertex(
        &mut self,
        context: &Context,
        s: &Simplex,
        v: LocalVertex,
        carrier: Carrier,
        inside: bool,
    ) -> u32 {
        let mut nodes = [NodeId::NONE; 4];
        let mut n = 0;
        for c in carrier.corners() {
            nodes[n] = s.nodes[c];
            n += 1;
        }
        nodes[..n].sort_unstable();
        let Work { complex, functions, flat, .. } = &self.work;
        let out = if inside { &mut self.inside_points } else { &mut self.facet_points };
        let global = |f: &LocalFunction| if f.is_none() { FunctionId::NONE } else { functions[f.at()] };
        let start = out.functions.items.len();
        out.functions.items.extend(complex.vertex_functions.row(v).iter().map(global));
        if context.kind == Kind::Arrangement {
            // Functions that vanish on the whole simplex are not in the complex.
            out.functions.items.extend(flat.iter().filter(|a| a.positive | a.negative == 0).map(|a| a.function));
            out.functions.items[start..].sort_unstable();
        }
        out.functions.end_row();
        out.encoding.push(complex.vertex_encoding[v.at()].map(|f| global(&f)));
        out.nodes.push(nodes);
        let at = out.nodes.len() as u32 - 1;
        (if inside { reference::INSIDE } else { reference::FACET }) | at
    }

    /// Fills the local complex for the functions in `work.functions`.
    fn build_complex(&mut self, context: &Context, s: &Simplex) {
        let work = &mut self.work;
        work.values.clear();
        for &f in &work.functions {
            work.values.extend(s.nodes[..=s.dim].iter().map(|&n| context.values.at(f, n)));
        }
        match context.kind {
            Kind::Arrangement => arrangement(s.dim, &work.values, &mut work.scratch, &mut work.complex),
            Kind::Interface => interface(s.dim, &work.values, &mut work.scratch, &mut work.complex),
        }
        work.vertices.clear();
        work.vertices.resize(work.complex.vertex_count(), u32::MAX);
    }
}

/// The polygons of an arrangement in a simplex. `active`: functions that are neither positive nor negative at all corners, rising; `edges`: the points on an
/// edge (number as in [`super::table::EDGES`]) that some of them crosses.
pub fn arrangement_polygons(
    context: &Context,
    s: &Simplex,
    active: &[Active],
    edges: impl Fn(usize) -> Span,
    out: &mut Pieces,
) {
    let full = (1u8 << (s.dim + 1)) - 1;
    if let [a] = active
        && a.positive | a.negative == full
    {
        let set = out.sets.single(a.function);
        out.push_loop(context, s, a.positive | a.negative << 4, set, &edges);
        return;
    }
    out.work.split.clear();
    out.work.flat.clear();
    for &a in active {
        if a.positive != 0 && a.negative != 0 {
            out.work.split.push(a);
        } else if (a.positive | a.negative).count_ones() <= 1 {
            out.work.flat.push(a);
        }
    }
    let mut facets = [None; 4];
    let mut crossed = false;
    if !out.work.flat.is_empty() {
        for (i, facet) in facets[..=s.dim].iter_mut().enumerate() {
            *facet = arrangement_facet(context, s, i, out);
            let corners = full & !(1 << i);
            let split = &out.work.split;
            crossed |= facet.is_some() && split.iter().any(|a| a.positive & corners != 0 && a.negative & corners != 0);
        }
    }
    if out.work.split.len() < 2 && !crossed {
        if let [a] = out.work.split[..] {
            let set = out.sets.single(a.function);
            out.push_loop(context, s, a.positive | a.negative << 4, set, &edges);
        }
        for (i, facet) in facets.iter().enumerate() {
            if let Some(facet) = facet {
                out.push_facet(context, s, i, facet);
            }
        }
        return;
    }
    // Those that split, and those that vanish on a facet, since its points name them.
    out.work.functions.clear();
    let takes_part = |a: &&Active| {
        a.positive | a.negative != 0
            && (a.positive != 0 && a.negative != 0 || (a.positive | a.negative).count_ones() == 1)
    };
    out.work.functions.extend(active.iter().filter(takes_part).map(|a| a.function));
    out.build_complex(context, s);
    for face in (0..out.work.complex.face_count()).map(LocalFace::of) {
        match out.work.complex.face_support[face.at()] {
            FaceSupport::Facet(i) => {
                if let Some(facet) = facets[i as usize] {
                    out.push_face(context, s, face, facet.flipped, &edges);
                    out.end_polygon(facet.set, facet.tets);
                }
            }
            _ => {
                out.push_face(context, s, face, false, &edges);
                let Work { complex, functions, items, .. } = &mut out.work;
                items.clear();
                for at in complex.plane_functions.range(complex.face_plane[face.at()]) {
                    let function = functions[complex.plane_functions.items[at].at()];
                    let orientation = if complex.plane_opposite[at] { Sign::Negative } else { Sign::Positive };
                    items.push(SetItem { function, orientation });
                }
                let set = out.sets.intern(&out.work.items);
                out.end_polygon(set, [s.tet; 2]);
            }
        }
    }
}

/// What a facet carries, if it has polygons that this simplex emits: the functions that vanish on it and not on both sides. (All of its pieces
/// carry the same: a function that vanishes on a piece vanishes on the facet.)
fn arrangement_facet(context: &Context, s: &Simplex, i: usize, out: &mut Pieces) -> Option<Facet> {
    let corners = ((1u8 << (s.dim + 1)) - 1) & !(1 << i);
    let Work { flat, items, .. } = &mut out.work;
    if flat.iter().all(|a| (a.positive | a.negative) & corners != 0) {
        return None;
    }
    let (behind, node) = context.domain.opposite(s.tet, i).filter(|o| o.0 > s.tet)?;
    items.clear();
    for a in flat.iter().filter(|a| (a.positive | a.negative) & corners == 0) {
        let here = sign_at(a.positive, a.negative, i);
        let there = Sign::of(context.values.at(a.function, node));
        if !(here.is_zero() && there.is_zero()) {
            items.push(SetItem { function: a.function, orientation: rise(there, here) });
        }
    }
    if items.is_empty() {
        return None;
    }
    // The normal points where the first function that changes rises; else into the greater simplex, which is the other one.
    let first = items.iter().map(|item| item.orientation).find(|o| !o.is_zero()).unwrap_or(Sign::Negative);
    let flipped = first == Sign::Negative;
    if flipped {
        items.iter_mut().for_each(|item| item.orientation = -item.orientation);
    }
    let set = out.sets.intern(&out.work.items);
    let tets = if flipped { [behind, s.tet] } else { [s.tet, behind] };
    Some(Facet { set, tets, flipped })
}

/// The polygons of an interface in a simplex. `materials`: those that no other one exceeds at all corners, rising, two or more; `edges`: the
/// points on an edge where the largest material changes.
pub fn interface_polygons(
    context: &Context,
    s: &Simplex,
    materials: &[FunctionId],
    edges: impl Fn(usize) -> Span,
    out: &mut Pieces,
) {
    if let &[a, b] = materials {
        let (mut positive, mut negative) = (0u8, 0u8);
        for (c, &node) in s.nodes[..=s.dim].iter().enumerate() {
            let (x, y) = (context.values.at(a, node), context.values.at(b, node));
            positive |= ((x > y) as u8) << c;
            negative |= ((x < y) as u8) << c;
        }
        pair_polygons(context, s, [a, b], positive, negative, edges, out);
        return;
    }
    out.work.functions.clear();
    out.work.functions.extend_from_slice(materials);
    out.build_complex(context, s);
    for face in (0..out.work.complex.face_count()).map(LocalFace::of) {
        match out.work.complex.face_support[face.at()] {
            FaceSupport::Facet(i) => {
                let tied = out.work.complex.face_functions(face);
                if tied.len() == 1 {
                    continue;
                }
                let Some((behind, node)) = context.domain.opposite(s.tet, i as usize) else { continue };
                if behind < s.tet {
                    continue;
                }
                let Work { complex, functions, .. } = &out.work;
                let here = functions[complex.cell_owner[complex.face_cells[face.at()][0].at()].at()];
                let there = largest(context, tied.iter().map(|f| functions[f.at()]), node);
                if let Some(facet) = interface_facet(s, [here, there], behind, &mut out.sets) {
                    out.push_face(context, s, face, facet.flipped, &edges);
                    out.end_polygon(facet.set, facet.tets);
                }
            }
            FaceSupport::Pair(a, b) => {
                out.push_face(context, s, face, false, &edges);
                let [a, b] = [a, b].map(|f| out.work.functions[f.at()]);
                let set = out.sets.pair(a, b);
                out.end_polygon(set, [s.tet; 2]);
            }
            FaceSupport::Function(_) => unreachable!("an interface lies on pairs"),
        }
    }
}

/// Two materials a < b, by the signs of their difference.
#[inline]
pub fn pair_polygons(
    context: &Context,
    s: &Simplex,
    [a, b]: [FunctionId; 2],
    positive: u8,
    negative: u8,
    edges: impl Fn(usize) -> Span,
    out: &mut Pieces,
) {
    let full = (1u8 << (s.dim + 1)) - 1;
    if positive != 0 && negative != 0 {
        let set = out.sets.pair(a, b);
        out.push_loop(context, s, positive | negative << 4, set, &edges);
        return;
    }
    let zero = full & !(positive | negative);
    if (zero.count_ones() as usize) < s.dim {
        return;
    }
    for i in (0..=s.dim).filter(|&i| zero | 1 << i == full) {
        let Some((behind, node)) = context.domain.opposite(s.tet, i) else { continue };
        if behind < s.tet {
            continue;
        }
        let here = if negative >> i & 1 == 1 { b } else { a };
        let there = largest(context, [a, b].into_iter(), node);
        if let Some(facet) = interface_facet(s, [here, there], behind, &mut out.sets) {
            out.push_facet(context, s, i, &facet);
        }
    }
}

/// The owner, of these materials, of the side of a facet that a node is on, where they are equal on the facet.
fn largest(context: &Context, materials: impl Iterator<Item = FunctionId>, node: NodeId) -> FunctionId {
    let better = |best: FunctionId, f: FunctionId| {
        if context.values.at(f, node) > context.values.at(best, node) { f } else { best }
    };
    materials.reduce(better).expect("two materials or more")
}

/// A piece of a facet between two owners: that of the simplex, and that behind.
fn interface_facet(s: &Simplex, [here, there]: [FunctionId; 2], behind: TetId, sets: &mut SetTable) -> Option<Facet> {
    match here.cmp(&there) {
        std::cmp::Ordering::Less => Some(Facet { set: sets.pair(here, there), tets: [s.tet, behind], flipped: false }),
        std::cmp::Ordering::Greater => {
            Some(Facet { set: sets.pair(there, here), tets: [behind, s.tet], flipped: true })
        }
        std::cmp::Ordering::Equal => None,
    }
}

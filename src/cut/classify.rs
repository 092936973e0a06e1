//! Stage 1: where every mesh vertex is with respect to every plane (paper, appendix B), and which planes cross
//! which mesh edges.
//!
//! There is no |V|×|P| matrix of signs. Planes are grouped into families of parallel planes; a vertex has one
//! *slab index* per family of two or more (2k: strictly between members k−1 and k; 2k+1: on member k), found by
//! binary search, and two bit masks (positive, negative) over the planes that have no parallel. Every later
//! question (sign, planes crossing a segment, planes through a vertex) is an integer comparison or a bit operation.
//!
//! Coincident planes have been merged before: the lowest id stands for all. A distinct plane is a *knife* here,
//! numbered family by family and by rank within the family, so that enumerating a segment's crossings family by
//! family gives rising knife ids.
//!
//! Cost: |V|·(Σ log m over families + single planes); crossings grow with their number.

use crate::base::parallel::{concat, map_ranges};
use crate::base::{Csr, EdgeId, PlaneId, VertexId};
use crate::exact::{self, Direction, Plane, PlaneFilter, Sign, counters};
use crate::mesh::TriMesh;

/// A distinct plane: families in order, members by rank, single planes last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct KnifeId(pub u32);

impl KnifeId {
    #[inline(always)]
    pub fn of(i: usize) -> Self {
        Self(i as u32)
    }
    #[inline(always)]
    pub fn at(self) -> usize {
        self.0 as usize
    }
}

impl crate::base::csr::Offset for KnifeId {
    #[inline(always)]
    fn at(self) -> usize {
        self.0 as usize
    }
}

/// The distinct planes, in families.
#[derive(Debug, Default)]
pub struct Knives {
    pub planes: Vec<Plane>,
    /// The input id of each knife: the lowest of the coincident planes.
    pub ids: Vec<PlaneId>,
    /// Family `f` (of two members or more) has knives `families[f]..families[f + 1]`; single planes follow.
    pub families: Vec<u32>,
    /// Whether the knife's normal points against its family's direction.
    pub reversed: Vec<bool>,
    /// The family of each knife; single planes have families of their own behind the others.
    pub family: Vec<u32>,
    filters: Vec<PlaneFilter>,
    /// Per family: what finds slabs without asking for signs, if its planes are axis-parallel.
    places: Vec<Option<Places>>,
    /// Per knife: bound of |n·x̃ + d| below which the sign at a correctly rounded point is not certain.
    rounded_bound: Vec<f64>,
    /// Input plane → knife of its coincidence class.
    pub knife_of: Vec<KnifeId>,
}

impl Knives {
    pub fn new(planes: &[Plane], max_abs: [f64; 3]) -> Self {
        let grouping = exact::group(planes);
        let mut knives =
            Knives { families: vec![0], knife_of: vec![KnifeId::default(); planes.len()], ..Default::default() };
        for single in [false, true] {
            for family in &grouping.families {
                if (family.members.len() == 1) != single {
                    continue;
                }
                let number = if single {
                    (knives.families.len() - 1 + knives.planes.len() - *knives.families.last().unwrap() as usize) as u32
                } else {
                    (knives.families.len() - 1) as u32
                };
                for (&id, &along) in family.members.iter().zip(&family.along) {
                    knives.planes.push(planes[id.at()]);
                    knives.ids.push(id);
                    knives.reversed.push(!along);
                    knives.family.push(number);
                }
                if !single {
                    knives.families.push(knives.planes.len() as u32);
                }
            }
        }
        for (i, id) in knives.ids.iter().enumerate() {
            knives.knife_of[id.at()] = KnifeId::of(i);
        }
        for (i, &representative) in grouping.representative.iter().enumerate() {
            knives.knife_of[i] = knives.knife_of[representative.at()];
        }
        knives.filters = knives.planes.iter().map(|p| PlaneFilter::new(p, &max_abs)).collect();
        knives.places = (0..knives.multi_count()).map(|f| Places::new(&knives, f)).collect();
        knives.rounded_bound = knives.planes.iter().map(|p| rounded_bound(p, max_abs)).collect();
        knives
    }

    pub fn len(&self) -> usize {
        self.planes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.planes.is_empty()
    }

    #[inline(always)]
    pub fn plane(&self, k: KnifeId) -> &Plane {
        &self.planes[k.at()]
    }

    #[inline(always)]
    pub fn normal(&self, k: KnifeId) -> Direction {
        Direction::Plane(self.planes[k.at()].n)
    }

    fn multi_count(&self) -> usize {
        self.families.len() - 1
    }

    fn single_base(&self) -> usize {
        *self.families.last().unwrap() as usize
    }

    #[inline]
    fn side_of_input(&self, k: usize, x: &[f64; 3]) -> Sign {
        match self.filters[k].side(x) {
            Some(sign) => sign,
            None => exact::side(&self.planes[k], x),
        }
    }

    /// The sign of n·x + d from the correctly rounded coordinates of x, where it is certain; and the rounded value.
    #[inline]
    pub fn value_at_rounded(&self, k: KnifeId, x: &[f64; 3]) -> (f64, f64) {
        let p = &self.planes[k.at()];
        (p.n[0] * x[0] + p.n[1] * x[1] + p.n[2] * x[2] + p.d, self.rounded_bound[k.at()])
    }
}

/// Bound on |fl(n·x̃ + d) − (n·x + d)| for |x| ≤ max_abs and x̃ the doubles nearest to x.
///
/// With u = 2⁻⁵³ the rounding of x contributes u·Σ|nᵢ||xᵢ|, three products and three sums at most
/// γ₄ ≤ 4.01u of S = Σ|nᵢ||xᵢ| + |d| (|x̃| ≤ (1+u)|x|); 6u·S bounds both, and computing S itself in doubles loses less
/// than the step from 6u to 8u. Each product and each subnormal coordinate may lose half a subnormal ulp besides,
/// scaled by |n| for the coordinates. Overflow gives an infinite bound, and nothing is then certain.
fn rounded_bound(p: &Plane, max_abs: [f64; 3]) -> f64 {
    let tiny = f64::MIN_POSITIVE;
    let mut sum = p.d.abs();
    for (n, m) in p.n.iter().zip(max_abs) {
        sum += n.abs() * (m + tiny) + tiny;
    }
    let bound = sum * (4.0 * f64::EPSILON) + tiny;
    if bound.is_nan() { f64::INFINITY } else { bound }
}

/// Slab indices and masks of the mesh vertices.
#[derive(Debug, Default)]
pub struct Sides {
    multi: usize,
    words: usize,
    single_base: usize,
    single_count: usize,
    /// `slabs[v·multi + f]`
    slabs: Vec<u32>,
    /// `masks[(v·words + w)·2]` positive, `… + 1` negative.
    masks: Vec<u64>,
}

impl Sides {
    #[inline(always)]
    pub fn slab(&self, v: VertexId, family: usize) -> u32 {
        self.slabs[v.at() * self.multi + family]
    }
    #[inline(always)]
    pub fn slabs_of(&self, v: VertexId) -> &[u32] {
        &self.slabs[v.at() * self.multi..(v.at() + 1) * self.multi]
    }
    #[inline(always)]
    pub fn masks_of(&self, v: VertexId) -> &[u64] {
        &self.masks[v.at() * self.words * 2..(v.at() + 1) * self.words * 2]
    }
    /// Side of a mesh vertex with respect to a knife: topology from here on.
    #[inline]
    pub fn side(&self, knives: &Knives, k: KnifeId, v: VertexId) -> Sign {
        let i = k.at();
        if i < self.single_base {
            let family = knives.family[i] as usize;
            let on = 2 * (k.0 - knives.families[family]) + 1;
            let slab = self.slab(v, family);
            match (slab.cmp(&on), knives.reversed[i]) {
                (std::cmp::Ordering::Equal, _) => Sign::Zero,
                (std::cmp::Ordering::Less, false) | (std::cmp::Ordering::Greater, true) => Sign::Negative,
                _ => Sign::Positive,
            }
        } else {
            let bit = i - self.single_base;
            let masks = &self.masks_of(v)[bit / 64 * 2..];
            let probe = 1u64 << (bit % 64);
            if masks[0] & probe != 0 {
                Sign::Positive
            } else if masks[1] & probe != 0 {
                Sign::Negative
            } else {
                Sign::Zero
            }
        }
    }
}

/// A point in slab space: where it is with respect to every plane. What [`Sides`] holds for mesh vertices, for any
/// other point.
#[derive(Clone, Debug, Default)]
pub struct Place {
    pub slabs: Vec<u32>,
    pub masks: Vec<u64>,
}

/// Members of a family strictly between two slab indices, as ranks.
#[inline(always)]
pub fn members_between(a: u32, b: u32) -> std::ops::Range<u32> {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    low.div_ceil(2)..high / 2
}

/// Calls `hit(knife, sign at the first point)` for every knife with strictly opposite signs at two points given by
/// their slabs and masks, by rising knife.
#[inline]
pub fn each_crossing(knives: &Knives, a: (&[u32], &[u64]), b: (&[u32], &[u64]), mut hit: impl FnMut(KnifeId, Sign)) {
    for (f, (&sa, &sb)) in a.0.iter().zip(b.0).enumerate() {
        if sa == sb {
            continue;
        }
        let base = knives.families[f];
        for rank in members_between(sa, sb) {
            let k = KnifeId(base + rank);
            let positive = (sa > sb) != knives.reversed[k.at()];
            hit(k, if positive { Sign::Positive } else { Sign::Negative });
        }
    }
    let base = knives.single_base();
    for (w, (ma, mb)) in a.1.chunks_exact(2).zip(b.1.chunks_exact(2)).enumerate() {
        let mut crossing = (ma[0] & mb[1]) | (ma[1] & mb[0]);
        while crossing != 0 {
            let bit = crossing.trailing_zeros() as usize;
            crossing &= crossing - 1;
            let sign = if ma[0] >> bit & 1 != 0 { Sign::Positive } else { Sign::Negative };
            hit(KnifeId::of(base + w * 64 + bit), sign);
        }
    }
}

/// Calls `hit(knife)` for every knife through a point, by rising knife.
#[inline]
pub fn each_through(knives: &Knives, place: (&[u32], &[u64]), mut hit: impl FnMut(KnifeId)) {
    for (f, &slab) in place.0.iter().enumerate() {
        if slab & 1 != 0 {
            hit(KnifeId(knives.families[f] + slab / 2));
        }
    }
    let base = knives.single_base();
    let count = knives.len() - base;
    for (w, m) in place.1.chunks_exact(2).enumerate() {
        let valid = if count - w * 64 >= 64 { !0 } else { (1u64 << (count - w * 64)) - 1 };
        let mut on = !(m[0] | m[1]) & valid;
        while on != 0 {
            hit(KnifeId::of(base + w * 64 + on.trailing_zeros() as usize));
            on &= on - 1;
        }
    }
}

/// One knife that crosses a mesh edge between its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Crossing {
    pub knife: KnifeId,
    /// Whether the edge's lower vertex is on the positive side.
    pub low_positive: bool,
}

/// The whole classification.
#[derive(Debug, Default)]
pub struct Classified {
    pub sides: Sides,
    /// Knives through each mesh vertex, rising.
    pub vertex_knives: Csr<KnifeId>,
    /// Knives that cross each mesh edge between its ends, rising.
    pub edge_crossings: Csr<Crossing>,
    /// Mesh edges that lie in some knife, with those knives: rising edges, then knives.
    pub edges_on: Vec<(EdgeId, KnifeId)>,
    /// Mesh edges with an end on some knife, rising.
    pub edges_at: Vec<EdgeId>,
}

pub fn classify(mesh: &TriMesh, knives: &Knives) -> Classified {
    let count = mesh.vertices.len();
    let multi = knives.multi_count();
    let single_base = knives.single_base();
    let single_count = knives.len() - single_base;
    let words = single_count.div_ceil(64);
    let mut sides = Sides {
        multi,
        words,
        single_base,
        single_count,
        slabs: vec![0; count * multi],
        masks: vec![0; count * words * 2],
    };
    fill_slabs(mesh, knives, &mut sides);
    fill_masks(mesh, knives, &mut sides);
    let vertex_knives = knives_through(count, knives, &sides);
    let parts = map_ranges(mesh.edges.len(), CHUNK, |range| {
        let mut crossings = Csr::with_capacity(range.len(), range.len() / 4);
        let (mut on, mut at) = (Vec::new(), Vec::new());
        for (e, &[a, b]) in range.clone().zip(&mesh.edges[range]) {
            let (from, to) = ((sides.slabs_of(a), sides.masks_of(a)), (sides.slabs_of(b), sides.masks_of(b)));
            each_crossing(knives, from, to, |knife, sign| {
                crossings.items.push(Crossing { knife, low_positive: sign == Sign::Positive });
            });
            crossings.end_row();
            let (on_a, on_b) = (vertex_knives.row(a), vertex_knives.row(b));
            if !on_a.is_empty() || !on_b.is_empty() {
                at.push(EdgeId::of(e));
                each_common(on_a, on_b, |k| on.push((EdgeId::of(e), k)));
            }
        }
        (crossings, (on, at))
    });
    let (crossings, (on, at)): (Vec<_>, (Vec<_>, Vec<_>)) = parts.into_iter().unzip();
    let edge_crossings = Csr::concat(crossings);
    Classified { sides, vertex_knives, edge_crossings, edges_on: concat(on), edges_at: concat(at) }
}

/// A family of axis-parallel planes: no double lies strictly between a plane and the double nearest to it, so comparisons with the latter tell
/// the slab of a vertex, exactly.
#[derive(Clone, Debug)]
struct Places {
    axis: usize,
    /// 1, or -1 if the family goes down the axis: places are multiplied by it.
    direction: f64,
    /// The nearest doubles, not falling along the family.
    nearest: Vec<f64>,
    /// By how much a slab index rises with a member at whose nearest double the vertex is: 0 below, 1 on, 2 above the plane.
    at: Vec<u32>,
}

impl Places {
    fn new(knives: &Knives, family: usize) -> Option<Self> {
        let members = knives.families[family] as usize..knives.families[family + 1] as usize;
        let (axis, .., above) = knives.filters[members.start].on_axis()?;
        let up = (above == Sign::Positive) != knives.reversed[members.start];
        let mut places = Self { axis, direction: if up { 1.0 } else { -1.0 }, nearest: Vec::new(), at: Vec::new() };
        for k in members {
            let (_, place, at, _) = knives.filters[k].on_axis()?;
            places.nearest.push(places.direction * place);
            let at = if knives.reversed[k] { -at } else { at };
            places.at.push((at.to_i8() + 1) as u32);
        }
        debug_assert!(places.nearest.is_sorted());
        Some(places)
    }

    /// Up to so many members are counted one by one, without a branch: above which of a few planes a vertex is cannot be guessed.
    const FEW: usize = 16;

    #[inline(always)]
    fn slab(&self, x: &[f64; 3]) -> u32 {
        let x = self.direction * x[self.axis];
        if self.nearest.len() <= Self::FEW {
            let rise = |(&place, &at): (&f64, &u32)| 2 * (x > place) as u32 + if x == place { at } else { 0 };
            return self.nearest.iter().zip(&self.at).map(rise).sum();
        }
        let below = self.nearest.partition_point(|&place| place < x);
        let here = self.nearest[below..].iter().take_while(|&&place| place == x).count();
        2 * below as u32 + self.at[below..below + here].iter().sum::<u32>()
    }
}

fn fill_slabs(mesh: &TriMesh, knives: &Knives, sides: &mut Sides) {
    use rayon::prelude::*;
    let multi = sides.multi;
    if multi == 0 {
        return;
    }
    sides.slabs.par_chunks_mut(multi * CHUNK).zip(mesh.vertices.par_chunks(CHUNK)).for_each(|(slabs, vertices)| {
        for (slab, x) in slabs.chunks_exact_mut(multi).zip(vertices) {
            for (f, s) in slab.iter_mut().enumerate() {
                if let Some(places) = &knives.places[f] {
                    *s = places.slab(x);
                    continue;
                }
                let (first, last) = (knives.families[f], knives.families[f + 1]);
                *s = search_slab(knives, first, 0, last - first, |k| knives.side_of_input(k.at(), x));
            }
        }
    });
}

/// Vertices in one parallel task: large enough to hide the cost of a task, small enough to share out.
const CHUNK: usize = 4096;

/// Binary search for the slab among members `low..high` of a family that starts at knife `base`; the point is known
/// to be above all members before `low` and below all from `high` on.
#[inline]
pub fn search_slab(
    knives: &Knives,
    base: u32,
    mut low: u32,
    mut high: u32,
    mut side: impl FnMut(KnifeId) -> Sign,
) -> u32 {
    while low < high {
        let middle = (low + high) / 2;
        let k = KnifeId(base + middle);
        match (side(k), knives.reversed[k.at()]) {
            (Sign::Zero, _) => return 2 * middle + 1,
            (Sign::Positive, false) | (Sign::Negative, true) => low = middle + 1,
            _ => high = middle,
        }
    }
    2 * low
}

fn fill_masks(mesh: &TriMesh, knives: &Knives, sides: &mut Sides) {
    use rayon::prelude::*;
    let (words, base, count) = (sides.words, sides.single_base, sides.single_count);
    if words == 0 {
        return;
    }
    sides.masks.par_chunks_mut(words * 2 * CHUNK).zip(mesh.vertices.par_chunks(CHUNK)).for_each(|(masks, vertices)| {
        // Plane by plane, without a branch: the few vertices whose sign the bound does not settle come afterwards.
        for i in 0..count {
            let (word, bit) = (i / 64 * 2, i % 64);
            let knife = KnifeId::of(base + i);
            let mut open = 0;
            for (mask, x) in masks.chunks_exact_mut(words * 2).zip(vertices) {
                let (value, bound) = knives.value_at_rounded(knife, x);
                let (positive, negative) = ((value > bound) as u64, (value < -bound) as u64);
                mask[word] |= positive << bit;
                mask[word + 1] |= negative << bit;
                open += 1 - (positive | negative);
            }
            counters::count_many(counters::Predicate::Side, counters::Tier::Filter, vertices.len() as u64 - open);
            if open == 0 {
                continue;
            }
            for (mask, x) in masks.chunks_exact_mut(words * 2).zip(vertices) {
                if (mask[word] | mask[word + 1]) >> bit & 1 == 0 {
                    match knives.side_of_input(base + i, x) {
                        Sign::Positive => mask[word] |= 1 << bit,
                        Sign::Negative => mask[word + 1] |= 1 << bit,
                        Sign::Zero => {}
                    }
                }
            }
        }
    });
}

fn knives_through(count: usize, knives: &Knives, sides: &Sides) -> Csr<KnifeId> {
    let parts = map_ranges(count, CHUNK, |range| {
        let mut rows = Csr::with_capacity(range.len(), 0);
        for v in range.map(VertexId::of) {
            each_through(knives, (sides.slabs_of(v), sides.masks_of(v)), |k| rows.items.push(k));
            rows.end_row();
        }
        rows
    });
    Csr::concat(parts)
}

/// Calls `hit` for the common members of two rising lists.
#[inline]
pub fn each_common<T: Copy + Ord>(a: &[T], b: &[T], mut hit: impl FnMut(T)) {
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => {
                hit(a[i]);
                i += 1;
                j += 1;
            }
        }
    }
}

impl Classified {
    pub fn check(&self, mesh: &TriMesh, knives: &Knives) -> Result<(), String> {
        self.vertex_knives.check()?;
        self.edge_crossings.check()?;
        for (e, [a, b]) in mesh.edges.iter().enumerate() {
            for c in self.edge_crossings.row(e) {
                let (sa, sb) = (self.sides.side(knives, c.knife, *a), self.sides.side(knives, c.knife, *b));
                if sa != -sb || sa == Sign::Zero || (sa == Sign::Positive) != c.low_positive {
                    return Err(format!("knife {} does not cross mesh edge {e}", c.knife.0));
                }
            }
        }
        Ok(())
    }
}

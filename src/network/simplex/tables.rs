//! Look-up tables for the complex of one simplex (section 6 of the networks paper): arrangements of one and two functions, interfaces of two and
//! three materials, in tetrahedra and triangles.
//!
//! The *type* of a corner is what values there say by comparisons alone: the signs of one function (3 types) or of two (9), the order
//! of two materials (3) or of three (13). Zeros and ties are types like others, so no input leaves the tables. What types do not say is, on
//! an edge whose ends have *opposite* types (both functions change sign; three materials, all different, are in opposite orders), the order of
//! two points: one sign each, less, equal or greater. The two tiers are these. Nothing else matters: the construction asks
//! for signs of a function at points on edges only (what two functions cut inside a facet or the simplex is new, and not asked about),
//! and each of these follows from the types at the ends or is one of the signs above.
//!
//! Symmetries. Corners are sorted by type, so the first tier is indexed by multisets: 15, 495 and 1820 of them in tetrahedra, not 81,
//! 6561 and 28561. Its record says which pairs of sorted corners are opposite; their signs are the digits of an index to the second tier,
//! whose record names an *entry*, a permutation of corners, and a symmetry of functions (exchange, change of signs; permutation of
//! materials) that makes the complex from the entry's. Digits that no values give lead to no entry.
//!
//! The data (`tables.bin`: entries and second tier) come from the incremental construction by `tests/network_tables.rs`, which makes them again
//! and compares. They are decoded by the compiler. Cost of a look-up: some ten nanoseconds, and a few for each opposite edge; where
//! rounded products are equal, one exact determinant.

use super::data::Kind;
use crate::exact::Sign;
use crate::exact::barycentric::{Function, determinant};
use crate::exact::counters::{Predicate, Tier, count};

const BYTES: &[u8] = include_bytes!("tables.bin");

/// One of the eight tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Table {
    pub kind: Kind,
    pub dim: usize,
    /// Functions, materials.
    pub functions: usize,
    /// Types of a corner.
    pub types: usize,
    /// Its records in the first tier.
    first: usize,
}

/// Arrangements of one and two functions, interfaces of two and three materials; in triangles, then in tetrahedra.
pub const TABLES: [Table; 8] = {
    let mut out = [Table { kind: Kind::Arrangement, dim: 2, functions: 1, types: 3, first: 0 }; 8];
    let mut first = 0;
    let mut i = 0;
    while i < 8 {
        (out[i].functions, out[i].types) = [(1, 3), (2, 9), (2, 3), (3, 13)][i % 4];
        if i % 4 >= 2 {
            out[i].kind = Kind::Interface;
        }
        out[i].dim = 2 + i / 4;
        out[i].first = first;
        first += multisets(out[i].types, out[i].dim + 1);
        i += 1;
    }
    out
};
const MAINS: usize = TABLES[7].first + multisets(13, 4);

/// How many multisets of `m` of `types` things there are.
const fn multisets(types: usize, m: usize) -> usize {
    let (mut out, mut i) = (1, 0);
    while i < m {
        out = out * (types + i) / (i + 1);
        i += 1;
    }
    out
}

/// By place in the sorted corners, and type: what it adds to the rank of a multiset.
const RANKS: [[u16; 13]; 4] = {
    let mut out = [[0; 13]; 4];
    let mut i = 0;
    while i < 4 {
        let mut t = 0;
        while t < 13 {
            out[i][t] = multisets(t, i + 1) as u16;
            t += 1;
        }
        i += 1;
    }
    out
};

/// The first tier: where the second one starts, and the pairs of sorted corners with opposite types.
#[derive(Clone, Copy, Debug)]
pub struct Main {
    pub types: [u8; 4],
    pub first: u16,
    pub count: u8,
    /// The lower place, and the higher one in the next two bits.
    pub pairs: [u8; 4],
}

/// Types of three materials by 9 a + 3 b + c with a, b, c = 0, 1, 2 where the first is smaller than, equal to, larger than the second, the
/// first the third, the second the third. (255: no order.)
pub const ORDERS: [u8; 27] = {
    let mut out = [u8::MAX; 27];
    let mut next = 0;
    let mut i = 0;
    while i < 27 {
        let (a, b, c) = (i / 9, i / 3 % 3, i % 3);
        // The difference of the first and the third is the sum of the two others.
        let sum = a + c;
        if a == 1 && b == c || c == 1 && b == a || a == c && b == a || (sum == 2 && a != c) {
            out[i] = next;
            next += 1;
        }
        i += 1;
    }
    assert!(next == 13);
    out
};

/// Whether two types make an edge between them ambiguous.
const fn opposite(types: usize, s: usize, t: usize) -> bool {
    match types {
        9 => s + t == 8 && s / 3 != 1 && s % 3 != 1,
        13 => {
            let mut i = 0;
            while ORDERS[i] as usize != s {
                i += 1;
            }
            i / 9 != 1 && i / 3 % 3 != 1 && i % 3 != 1 && ORDERS[26 - i] as usize == t
        }
        _ => false,
    }
}

pub static MAIN: [Main; MAINS] = MAIN_TIER.0;
/// Records of the second tier.
pub const BRANCH_COUNT: usize = MAIN_TIER.1;

const MAIN_TIER: ([Main; MAINS], usize) = {
    let mut out = [Main { types: [0; 4], first: 0, count: 0, pairs: [0; 4] }; MAINS];
    let (mut at, mut next, mut table) = (0, 0, 0);
    while table < 8 {
        let Table { dim, types, first, .. } = TABLES[table];
        assert!(at == first);
        // By rank: the last corner's type is the slowest. In a triangle the fourth corner has none.
        let mut t = [0; 4];
        while t[dim] < types {
            let main = &mut out[at];
            main.first = next as u16;
            let mut size = 1;
            let mut j = 0;
            while j <= dim {
                main.types[j] = t[j] as u8;
                let mut i = 0;
                while i < j {
                    if opposite(types, t[i], t[j]) {
                        main.pairs[main.count as usize] = (i | j << 2) as u8;
                        main.count += 1;
                        size *= 3;
                    }
                    i += 1;
                }
                j += 1;
            }
            next += size;
            at += 1;
            let mut i = 0;
            while i < dim && t[i] == t[i + 1] {
                t[i] = 0;
                i += 1;
            }
            t[i] += 1;
        }
        table += 1;
    }
    assert!(at == MAINS && next < 1 << 16);
    (out, next)
};

/// The second tier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// Of [`ENTRIES`]; [`Found::NOTHING`] where no values lead.
    pub entry: u16,
    /// Of [`PERMUTATIONS`]: the simplex's corner for each of the entry's.
    pub corners: u8,
    /// Of [`SYMMETRIES`]: the functions for the entry's.
    pub functions: u8,
}

impl Found {
    pub const NOTHING: u16 = u16::MAX;
}

/// A vertex of an entry (the first ones are the corners): sets of corners and of functions as masks, see
/// [`super::SimplexComplex`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EntryVertex {
    pub carrier: u8,
    pub functions: u8,
    pub encoding: u8,
}

#[derive(Clone, Copy, Debug)]
pub struct EntryFace {
    /// In the entry's corners.
    pub start: u8,
    pub len: u8,
    /// A corner: the facet opposite to it; [`EntryFace::INSIDE`].
    pub facet: u8,
    /// All functions that vanish (materials that are largest) on it, and those of them that are negative on its positive side.
    pub functions: u8,
    pub opposite: u8,
    /// On the positive and the negative side; 255 outside of the simplex.
    pub cells: [u8; 2],
}

impl EntryFace {
    pub const INSIDE: u8 = 4;
}

#[derive(Clone, Copy, Debug)]
pub struct EntryCell {
    /// How many half-faces it has; cells follow one another in the entry's half-faces.
    pub len: u8,
    /// Positive functions; materials that are largest.
    pub label: u8,
}

/// A complex.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub vertices: &'static [EntryVertex],
    pub edges: &'static [[u8; 2]],
    pub faces: &'static [EntryFace],
    /// Vertices of faces and the edges from there to the next (in a triangle 255).
    pub corners: &'static [[u8; 2]],
    pub cells: &'static [EntryCell],
    pub half_faces: &'static [u8],
    /// Functions that vanish everywhere.
    pub zero: u8,
    pub table: Table,
}

/// The file: how many entries, vertices, edges, faces, corners, cells, half-faces, as `u32`; the second tier, four bytes each; of each entry its
/// table, `zero`, and six numbers of elements in the order of [`Entry`]; then all elements of each kind.
const SIZES: [usize; 7] = {
    let mut out = [0; 7];
    let mut i = 0;
    while i < 7 {
        out[i] = u16_at(4 * i) as usize | (u16_at(4 * i + 2) as usize) << 16;
        i += 1;
    }
    out
};
const STARTS: [usize; 9] = {
    let mut out = [28; 9];
    out[1] = out[0] + 4 * BRANCH_COUNT;
    let mut i = 0;
    while i < 7 {
        out[i + 2] = out[i + 1] + SIZES[i] * [8, 3, 2, 7, 2, 2, 1][i];
        i += 1;
    }
    assert!(out[8] == BYTES.len());
    out
};

const fn u16_at(at: usize) -> u16 {
    BYTES[at] as u16 | (BYTES[at + 1] as u16) << 8
}

pub static BRANCHES: [Found; BRANCH_COUNT] = {
    let mut out = [Found { entry: 0, corners: 0, functions: 0 }; BRANCH_COUNT];
    let mut i = 0;
    while i < BRANCH_COUNT {
        let at = STARTS[0] + 4 * i;
        out[i] = Found { entry: u16_at(at), corners: BYTES[at + 2], functions: BYTES[at + 3] };
        assert!(out[i].entry == Found::NOTHING || (out[i].entry as usize) < SIZES[0]);
        assert!(out[i].corners < 24 && out[i].functions < 14);
        i += 1;
    }
    out
};

static VERTICES: [EntryVertex; SIZES[1]] = {
    let mut out = [EntryVertex { carrier: 0, functions: 0, encoding: 0 }; SIZES[1]];
    let mut i = 0;
    while i < SIZES[1] {
        let at = STARTS[2] + 3 * i;
        out[i] = EntryVertex { carrier: BYTES[at], functions: BYTES[at + 1], encoding: BYTES[at + 2] };
        i += 1;
    }
    out
};

static FACES: [EntryFace; SIZES[3]] = {
    let mut out = [EntryFace { start: 0, len: 0, facet: 0, functions: 0, opposite: 0, cells: [0; 2] }; SIZES[3]];
    let mut i = 0;
    while i < SIZES[3] {
        let at = STARTS[4] + 7 * i;
        out[i] = EntryFace {
            start: BYTES[at],
            len: BYTES[at + 1],
            facet: BYTES[at + 2],
            functions: BYTES[at + 3],
            opposite: BYTES[at + 4],
            cells: [BYTES[at + 5], BYTES[at + 6]],
        };
        i += 1;
    }
    out
};

static CELLS: [EntryCell; SIZES[5]] = {
    let mut out = [EntryCell { len: 0, label: 0 }; SIZES[5]];
    let mut i = 0;
    while i < SIZES[5] {
        let at = STARTS[6] + 2 * i;
        out[i] = EntryCell { len: BYTES[at], label: BYTES[at + 1] };
        i += 1;
    }
    out
};

/// The next `count` of a list, after `from`.
const fn part<T>(all: &'static [T], from: usize, count: usize) -> &'static [T] {
    all.split_at(from).1.split_at(count).0
}

/// The complexes, up to symmetry.
pub static ENTRIES: [Entry; SIZES[0]] = {
    const EMPTY: Entry = Entry {
        vertices: &[],
        edges: &[],
        faces: &[],
        corners: &[],
        cells: &[],
        half_faces: &[],
        zero: 0,
        table: TABLES[0],
    };
    let mut out = [EMPTY; SIZES[0]];
    let mut from = [0; 6];
    let mut i = 0;
    while i < SIZES[0] {
        let at = STARTS[1] + 8 * i;
        let mut count = [0; 6];
        let mut k = 0;
        while k < 6 {
            count[k] = BYTES[at + 2 + k] as usize;
            k += 1;
        }
        out[i] = Entry {
            vertices: part(&VERTICES, from[0], count[0]),
            edges: part(pairs(STARTS[3], STARTS[4]), from[1], count[1]),
            faces: part(&FACES, from[2], count[2]),
            corners: part(pairs(STARTS[5], STARTS[6]), from[3], count[3]),
            cells: part(&CELLS, from[4], count[4]),
            half_faces: part(BYTES, STARTS[7] + from[5], count[5]),
            zero: BYTES[at + 1],
            table: TABLES[BYTES[at] as usize],
        };
        k = 0;
        while k < 6 {
            from[k] += count[k];
            k += 1;
        }
        i += 1;
    }
    out
};

const fn pairs(start: usize, end: usize) -> &'static [[u8; 2]] {
    part(BYTES, start, end - start).as_chunks().0
}

/// Permutations of four corners in the order of the numbers they spell; those of three are the ones that end in 3.
pub static PERMUTATIONS: [[u8; 4]; 24] = ALL_PERMUTATIONS;
const ALL_PERMUTATIONS: [[u8; 4]; 24] = {
    let mut out = [[0; 4]; 24];
    let (mut n, mut i) = (0, 0);
    while i < 256 {
        let p = [i / 64, i / 16 % 4, i / 4 % 4, i % 4];
        if 1 << p[0] | 1 << p[1] | 1 << p[2] | 1 << p[3] == 15 {
            out[n] = [p[0] as u8, p[1] as u8, p[2] as u8, p[3] as u8];
            n += 1;
        }
        i += 1;
    }
    out
};

/// The number of a permutation by the number it spells with base 4.
static PERMUTATION: [u8; 256] = {
    let mut out = [u8::MAX; 256];
    let mut n = 0;
    while n < 24 {
        out[spelled(ALL_PERMUTATIONS[n]) as usize] = n as u8;
        n += 1;
    }
    out
};

const fn spelled(p: [u8; 4]) -> u8 {
    p[0] << 6 | p[1] << 4 | p[2] << 2 | p[3]
}

/// First the second one, then the first.
static COMPOSED: [[u8; 24]; 24] = {
    let mut out = [[0; 24]; 24];
    let mut i = 0;
    while i < 576 {
        let (p, q) = (ALL_PERMUTATIONS[i / 24], ALL_PERMUTATIONS[i % 24]);
        let pq = [p[q[0] as usize], p[q[1] as usize], p[q[2] as usize], p[q[3] as usize]];
        let mut n = 0;
        while spelled(ALL_PERMUTATIONS[n]) != spelled(pq) {
            n += 1;
        }
        out[i / 24][i % 24] = n as u8;
        i += 1;
    }
    out
};

/// A symmetry of functions: the function for each of an entry's, and the set of those of the entry's that change their signs.
#[derive(Clone, Copy, Debug)]
pub struct Symmetry {
    pub to: [u8; 3],
    pub flip: u8,
}

/// Arrangements: 2 s + 1 if functions are exchanged, with the set s of those that change signs. Interfaces: 8 + the permutations in
/// order; those of two materials are the first and the third.
pub static SYMMETRIES: [Symmetry; 14] = {
    let mut out = [Symmetry { to: [0, 1, 2], flip: 0 }; 14];
    let mut i = 0;
    while i < 8 {
        if i & 1 == 1 {
            out[i].to = [1, 0, 2];
        }
        out[i].flip = i as u8 >> 1;
        i += 1;
    }
    while i < 14 {
        out[i].to = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]][i - 8];
        i += 1;
    }
    out
};

/// The two tiers, for corners of these types. `order(a, b)`: the sign of the determinant of the two functions (differences of the
/// second and third material to the first) at corners a and b, which are opposite.
#[inline(always)]
fn find<const M: usize>(table: &Table, types: [u8; M], order: impl Fn(u8, u8) -> Sign) -> Found {
    // Type and corner; a fourth that is not there stays last.
    let mut keys = [u8::MAX; 4];
    for c in 0..M {
        keys[c] = types[c] << 2 | c as u8;
    }
    let [a, b, c, d] = keys;
    let (a, b) = (a.min(b), a.max(b));
    let (c, d) = (c.min(d), c.max(d));
    let (a, c) = (a.min(c), a.max(c));
    let (b, d) = (b.min(d), b.max(d));
    let (b, c) = (b.min(c), b.max(c));
    let keys = [a, b, c, d];
    let mut rank = table.first;
    for i in 0..M {
        rank += RANKS[i][(keys[i] >> 2) as usize] as usize;
    }
    let main = &MAIN[rank];
    let corner = keys.map(|k| k & 3);
    let mut digits = 0;
    for &pair in &main.pairs[..main.count as usize & 7] {
        let sign = order(corner[(pair & 3) as usize], corner[(pair >> 2) as usize]);
        digits = 3 * digits + (sign.to_i8() + 1) as usize;
    }
    let branch = BRANCHES[main.first as usize + digits];
    debug_assert_ne!(branch.entry, Found::NOTHING);
    let sorted = PERMUTATION[spelled(corner) as usize] as usize;
    Found { corners: COMPOSED[sorted][branch.corners as usize % 24], ..branch }
}

#[inline(always)]
fn three(x: f64, y: f64) -> u8 {
    1 + (x > y) as u8 - (x < y) as u8
}

/// The table's number from dimension (corners less one) and place in [`TABLES`].
const fn table<const M: usize>(i: usize) -> &'static Table {
    &TABLES[4 * (M - 3) + i]
}

/// The arrangement of one function in a simplex with M corners.
#[inline]
pub fn find_arrangement_1<const M: usize>(f: &[f64; M]) -> Found {
    find::<M>(table::<M>(0), f.map(|x| three(x, 0.0)), |_, _| unreachable!("one function"))
}

/// The arrangement of two functions.
#[inline]
pub fn find_arrangement_2<const M: usize>(f: &[f64; M], g: &[f64; M]) -> Found {
    let types: [u8; M] = std::array::from_fn(|c| 3 * three(f[c], 0.0) + three(g[c], 0.0));
    find::<M>(table::<M>(1), types, |a, b| {
        let (i, j) = (a as usize, b as usize);
        let (p, q) = (f[i] * g[j], f[j] * g[i]);
        // Rounding is monotonous (underflow and overflow as well), so where results differ they are in the right order.
        if p != q {
            count(Predicate::Barycentric, Tier::Filter);
            return Sign::of(if p > q { 1.0 } else { -1.0 });
        }
        exact_order(a, b, &[Function::Values(f), Function::Values(g)])
    })
}

/// The interface of two materials.
#[inline]
pub fn find_interface_2<const M: usize>(f: &[f64; M], g: &[f64; M]) -> Found {
    find::<M>(table::<M>(2), std::array::from_fn(|c| three(f[c], g[c])), |_, _| unreachable!("two materials"))
}

/// The interface of three materials.
#[inline]
pub fn find_interface_3<const M: usize>(f: &[f64; M], g: &[f64; M], h: &[f64; M]) -> Found {
    let types: [u8; M] = std::array::from_fn(|c| {
        ORDERS[(9 * three(f[c], g[c]) + 3 * three(f[c], h[c]) + three(g[c], h[c])) as usize % 27]
    });
    find::<M>(table::<M>(3), types, |a, b| {
        let (i, j) = (a as usize, b as usize);
        let (p, q) = ((g[i] - f[i]) * (h[j] - f[j]), (g[j] - f[j]) * (h[i] - f[i]));
        // Two roundings of differences and one of the product each: below 4u of it (u = 2^-53), and of sums of both again 2u. What
        // underflow loses is below the slack. Overflow gives NaN or infinity on both sides, which is no decision.
        let (d, bound) = (p - q, 4.0 * f64::EPSILON * (p.abs() + q.abs()));
        if d.abs() > bound && bound > 1e-280 {
            count(Predicate::Barycentric, Tier::Filter);
            return Sign::of(d);
        }
        exact_order(a, b, &[Function::Difference(g, f), Function::Difference(h, f)])
    })
}

/// Both functions at both corners. (Determinants take corners rising.)
#[cold]
#[inline(never)]
fn exact_order(a: u8, b: u8, functions: &[Function<'_>; 2]) -> Sign {
    let sign = determinant(1 << a | 1 << b, functions);
    if a < b { sign } else { -sign }
}

/// By number of functions; `None` where there is no table. Function-major values, as for [`super::arrangement()`].
#[inline]
pub fn find_table(kind: Kind, dim: usize, values: &[f64]) -> Option<Found> {
    fn with<const M: usize>(kind: Kind, values: &[f64]) -> Option<Found> {
        Some(match (kind, values.as_chunks::<M>().0) {
            (Kind::Arrangement, [f]) => find_arrangement_1(f),
            (Kind::Arrangement, [f, g]) => find_arrangement_2(f, g),
            (Kind::Interface, [f, g]) => find_interface_2(f, g),
            (Kind::Interface, [f, g, h]) => find_interface_3(f, g, h),
            _ => return None,
        })
    }
    if dim == 3 { with::<4>(kind, values) } else { with::<3>(kind, values) }
}

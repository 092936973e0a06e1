//! Stage: which boxes the surface touches: those whose closed box holds a point of it. One bit per box, along each axis.
//!
//! Every piece of the surface that meets a closed box has a corner there (the contact is a face of the convex piece, and the
//! pieces are split at all planes), so the points alone tell.

use super::ground::{Slabs, on_plane};
use super::lattice::Lattice;
use crate::base::BoxId;

/// The two axes other than the given one, rising.
#[inline(always)]
pub fn others(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// Rows of bits along one axis; rows are numbered by the other two, the lower one fastest.
#[derive(Clone, Debug, Default)]
pub struct Bits {
    pub words: usize,
    /// Number of rows along the lower of the other axes.
    pub stride: usize,
    pub bits: Vec<u64>,
}

impl Bits {
    pub fn new(axis: usize, counts: [usize; 3]) -> Self {
        let [b, c] = others(axis);
        let words = counts[axis].div_ceil(64);
        Bits { words, stride: counts[b], bits: vec![0; words * counts[b] * counts[c]] }
    }
    #[inline(always)]
    pub fn row(&self, b: usize, c: usize) -> &[u64] {
        let start = (b + self.stride * c) * self.words;
        &self.bits[start..start + self.words]
    }
    #[inline(always)]
    pub fn row_mut(&mut self, b: usize, c: usize) -> &mut [u64] {
        let start = (b + self.stride * c) * self.words;
        &mut self.bits[start..start + self.words]
    }
    #[inline(always)]
    pub fn get(&self, i: usize, b: usize, c: usize) -> bool {
        self.bits[(b + self.stride * c) * self.words + i / 64] >> (i % 64) & 1 != 0
    }
    #[inline(always)]
    pub fn set(&mut self, i: usize, b: usize, c: usize) {
        self.bits[(b + self.stride * c) * self.words + i / 64] |= 1 << (i % 64);
    }
    /// Calls `visit` for each set bit of a row, rising.
    #[inline]
    pub fn each(row: &[u64], mut visit: impl FnMut(usize)) {
        for (w, &word) in row.iter().enumerate() {
            let mut left = word;
            while left != 0 {
                visit(w * 64 + left.trailing_zeros() as usize);
                left &= left - 1;
            }
        }
    }
    /// The OR of up to four rows around a line: rows `b − 1`, `b` by `c − 1`, `c` as far as they exist.
    pub fn around(&self, b: usize, c: usize, rows: [usize; 2], out: &mut Vec<u64>) {
        out.clear();
        out.resize(self.words, 0);
        for c in c.saturating_sub(1)..=c.min(rows[1] - 1) {
            for b in b.saturating_sub(1)..=b.min(rows[0] - 1) {
                out.iter_mut().zip(self.row(b, c)).for_each(|(o, w)| *o |= w);
            }
        }
    }
}

/// Numbers of set bits, in the order of the bits.
#[derive(Clone, Debug, Default)]
pub struct Ranks {
    before: Vec<u32>,
    pub count: usize,
}

impl Ranks {
    pub fn new(bits: &Bits) -> Self {
        let mut count = 0;
        let mut before = Vec::with_capacity(bits.bits.len());
        for w in &bits.bits {
            before.push(count);
            count += w.count_ones();
        }
        Ranks { before, count: count as usize }
    }
    /// The number of a bit among the set ones.
    #[inline(always)]
    pub fn of(&self, bits: &Bits, i: usize, b: usize, c: usize) -> u32 {
        let word = (b + bits.stride * c) * bits.words + i / 64;
        self.before[word] + (bits.bits[word] & ((1u64 << (i % 64)) - 1)).count_ones()
    }
}

/// The boxes that the surface touches.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    /// Per axis: rows of boxes along it.
    pub along: [Bits; 3],
    pub ranks: Ranks,
    /// Rising.
    pub boxes: Vec<BoxId>,
}

/// The layers of boxes whose closure holds a slab.
#[inline(always)]
pub fn layers(slab: u32, boxes: usize) -> std::ops::Range<usize> {
    let rank = slab as usize / 2;
    if on_plane(slab) {
        rank.saturating_sub(1)..(rank + 1).min(boxes)
    } else if rank == 0 || rank > boxes {
        0..0
    } else {
        rank - 1..rank
    }
}

impl Touched {
    pub fn new(lattice: &Lattice, points: impl Iterator<Item = Slabs>) -> Self {
        let counts = std::array::from_fn(|a| lattice.count(a));
        let mut x = Bits::new(0, counts);
        for s in points {
            for k in layers(s[2], counts[2]) {
                for j in layers(s[1], counts[1]) {
                    for i in layers(s[0], counts[0]) {
                        x.set(i, j, k);
                    }
                }
            }
        }
        let (mut y, mut z) = (Bits::new(1, counts), Bits::new(2, counts));
        let ranks = Ranks::new(&x);
        let mut boxes = Vec::with_capacity(ranks.count);
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                Bits::each(x.row(j, k), |i| {
                    boxes.push(lattice.box_id([i, j, k]));
                    y.set(j, i, k);
                    z.set(k, i, j);
                });
            }
        }
        Touched { along: [x, y, z], ranks, boxes }
    }
    /// Frees the rows along y and z.
    pub fn forget_lines(&mut self) {
        (self.along[1], self.along[2]) = Default::default();
    }
    #[inline(always)]
    pub fn get(&self, [i, j, k]: [usize; 3]) -> bool {
        self.along[0].get(i, j, k)
    }
    /// The place of a touched box among them.
    #[inline(always)]
    pub fn rank(&self, [i, j, k]: [usize; 3]) -> usize {
        self.ranks.of(&self.along[0], i, j, k) as usize
    }
}

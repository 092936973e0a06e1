//! Signs of an arrangement's functions at the nodes, as bits: where a function is positive and where it is negative (neither:
//! it is zero). And, for an interface, the largest material at each node.
//!
//! On a box a word holds 64 nodes of an x-row (rows are padded to whole words with zeros), with the words of all functions side by side, so
//! that what happens at 64 edges or cubes takes a few operations on words. On a mesh, whose nodes are read at random, a word holds 64
//! functions of one node.
//!
//! Errors: a value that is not finite, with its function and node. Cost: that of reading the values once.

use super::data::Values;
use crate::base::parallel::{map_ranges, ranges, write_parts};
use crate::base::{Error, FunctionId, NodeId, Result, Status};

/// Nodes in one task at least.
const LEAST: usize = 1 << 14;

/// Rows in which a function is read before the next one: memory is fetched ahead along few streams at a time only.
const BLOCK: usize = 32;

/// Sets of nodes (or functions): where values are positive, where negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Signs {
    pub positive: u64,
    pub negative: u64,
}

impl Signs {
    /// Those one place further.
    #[inline(always)]
    pub fn shifted(self, next: Signs) -> Signs {
        Signs { positive: self.positive >> 1 | next.positive << 63, negative: self.negative >> 1 | next.negative << 63 }
    }
    /// Where the two have opposite signs.
    #[inline(always)]
    pub fn crossing(self, other: Signs) -> u64 {
        self.positive & other.negative | self.negative & other.positive
    }
}

/// Signs along the x-rows of a box.
pub struct SignRows {
    pub functions: usize,
    /// Words in a row.
    pub row_words: usize,
    /// Row r, word w, function f: `words[(r * row_words + w) * functions + f]`.
    words: Vec<Signs>,
    /// Where some function is zero, by row and word.
    zeros: Vec<u64>,
}

impl SignRows {
    /// The signs of all functions at 64 nodes; zeros behind the last row (there is always one to read).
    #[inline(always)]
    pub fn word(&self, row: usize, word: usize) -> &[Signs] {
        let at = (row * self.row_words + word) * self.functions;
        &self.words[at..at + self.functions]
    }
    /// Whether some function is zero at a node.
    #[inline(always)]
    pub fn zero(&self, row: usize, i: usize) -> bool {
        self.zeros[row * self.row_words + i / 64] >> (i % 64) & 1 == 1
    }
}

/// Up to 64 values of a function from a node on, in a row.
#[inline(always)]
fn values_of<'a>(values: &Values<'a>, f: usize, first: usize, count: usize, buffer: &'a mut [f64; 64]) -> &'a [f64] {
    let all = values.functions[f];
    if values.stride == 1 {
        return &all[first..first + count];
    }
    for (i, x) in buffer[..count].iter_mut().enumerate() {
        *x = all[(first + i) * values.stride];
    }
    &buffer[..count]
}

/// The signs of up to 64 values; `None` if one is not finite.
#[inline(always)]
fn signs_of(values: &[f64]) -> Option<Signs> {
    let mut signs = Signs::default();
    // Not zero where a value is not finite.
    let mut odd = 0;
    let pairs = values.chunks_exact(8);
    let rest = pairs.remainder();
    let behind = values.len() - rest.len();
    for (i, x) in pairs.enumerate() {
        let (positive, negative, difference) = eight(x.try_into().expect("eight values"));
        signs.positive |= positive << (8 * i);
        signs.negative |= negative << (8 * i);
        odd |= difference;
    }
    for (i, &x) in rest.iter().enumerate() {
        signs.positive |= ((x > 0.0) as u64) << (behind + i);
        signs.negative |= ((x < 0.0) as u64) << (behind + i);
        odd |= !x.is_finite() as u64;
    }
    (odd == 0).then_some(signs)
}

/// Where eight values are positive, where negative; and something that is not 0 if one is not finite.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn eight(x: &[f64; 8]) -> (u64, u64, u64) {
    use std::arch::x86_64::*;
    // SAFETY: every x86-64 processor has SSE2, and these only compute. (Compilers do not find the instruction that collects sign bits, which halves
    // the time of this stage.)
    unsafe {
        let zero = _mm_setzero_pd();
        let (mut positive, mut negative, mut odd) = (0, 0, zero);
        for k in 0..4 {
            let v = _mm_set_pd(x[2 * k + 1], x[2 * k]);
            positive |= _mm_movemask_pd(_mm_cmplt_pd(zero, v)) << (2 * k);
            negative |= _mm_movemask_pd(_mm_cmplt_pd(v, zero)) << (2 * k);
            // 0 or NaN.
            odd = _mm_or_pd(odd, _mm_sub_pd(v, v));
        }
        let [low, high] = [odd, _mm_unpackhi_pd(odd, odd)].map(|x| _mm_cvtsd_f64(x).to_bits());
        (positive as u64, negative as u64, low | high)
    }
}

#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
fn eight(x: &[f64; 8]) -> (u64, u64, u64) {
    x.iter().enumerate().fold((0, 0, 0), |(p, n, odd), (i, &x)| {
        (p | ((x > 0.0) as u64) << i, n | ((x < 0.0) as u64) << i, odd | !x.is_finite() as u64)
    })
}

#[inline(always)]
fn finite(values: &[f64]) -> bool {
    values.iter().fold(true, |ok, x| ok & (x.abs() < f64::INFINITY))
}

fn not_finite(values: &Values, f: usize, first: usize, count: usize) -> Error {
    let at = |i: usize| values.at(FunctionId::of(f), NodeId::of(i));
    let node = (first..first + count).find(|&i| !at(i).is_finite()).expect("a value that is not finite");
    Error::new(Status::BadArgument, format!("the value of function {f} at node {node} is not finite"))
}

/// Of a box with rows of `row_nodes` nodes.
pub fn sign_rows(values: &Values, row_nodes: usize, rows: usize) -> Result<SignRows> {
    let (n, row_words) = (values.len(), row_nodes.div_ceil(64));
    let parts = ranges(rows, LEAST.div_ceil(row_nodes));
    let lengths: Vec<usize> = parts.iter().map(|r| r.len() * row_words * n).collect();
    let bad = std::sync::Mutex::new(None::<(usize, usize, usize)>);
    let words = write_parts(&lengths, |p, out| {
        let mut buffer = [0.0; 64];
        let mut block = vec![Signs::default(); BLOCK * row_words * n];
        for first_row in parts[p].clone().step_by(BLOCK) {
            let rows = BLOCK.min(parts[p].end - first_row);
            for f in 0..n {
                for at in 0..rows * row_words {
                    let (row, word) = (first_row + at / row_words, at % row_words);
                    let (first, count) = (row * row_nodes + word * 64, 64.min(row_nodes - word * 64));
                    let signs = signs_of(values_of(values, f, first, count, &mut buffer));
                    if signs.is_none() {
                        // The first in order of nodes, whoever finds it.
                        let mut bad = bad.lock().expect("no panic while it is held");
                        let this = (first, f, count);
                        *bad = Some(bad.map_or(this, |b| b.min(this)));
                    }
                    block[at * n + f] = signs.unwrap_or_default();
                }
            }
            out.extend(block[..rows * row_words * n].iter().copied());
        }
    });
    if let Some((first, f, count)) = bad.into_inner().expect("no panic while it is held") {
        return Err(not_finite(values, f, first, count));
    }
    let zeros = |word: usize| {
        let count = 64.min(row_nodes - word % row_words * 64);
        let all = u64::MAX >> (64 - count);
        words[word * n..(word + 1) * n].iter().fold(0, |z, s| z | all & !(s.positive | s.negative))
    };
    let zeros = map_ranges(rows * row_words, LEAST / 64, |r| r.map(zeros).collect::<Vec<_>>()).concat();
    Ok(SignRows { functions: n, row_words, words, zeros })
}

/// Signs at the nodes of a mesh.
pub struct NodeSigns {
    /// Words of 64 functions for a node.
    pub words: usize,
    signs: Vec<Signs>,
}

impl NodeSigns {
    #[inline(always)]
    pub fn of(&self, node: NodeId) -> &[Signs] {
        &self.signs[node.at() * self.words..(node.at() + 1) * self.words]
    }
}

pub fn node_signs(values: &Values, nodes: usize) -> Result<NodeSigns> {
    let (n, words) = (values.len(), values.len().div_ceil(64));
    let signs = map_ranges(nodes, LEAST, |range| {
        let mut out = vec![Signs::default(); range.len() * words];
        let mut buffer = [0.0; 64];
        for first in range.clone().step_by(64) {
            let count = 64.min(range.end - first);
            for f in 0..n {
                let x = values_of(values, f, first, count, &mut buffer);
                if !finite(x) {
                    return Err(not_finite(values, f, first, count));
                }
                for (i, &x) in x.iter().enumerate() {
                    let signs = &mut out[(first - range.start + i) * words + f / 64];
                    signs.positive |= ((x > 0.0) as u64) << (f % 64);
                    signs.negative |= ((x < 0.0) as u64) << (f % 64);
                }
            }
        }
        Ok(out)
    });
    let signs = signs.into_iter().collect::<Result<Vec<_>>>()?.concat();
    Ok(NodeSigns { words, signs })
}

/// The largest material at a node: the lowest of them, and whether there are several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Label(u32);

impl Label {
    pub const TIE: u32 = 1 << 31;
    #[inline(always)]
    pub fn material(self) -> FunctionId {
        FunctionId(self.0 & !Self::TIE)
    }
    #[inline(always)]
    pub fn tied(self) -> bool {
        self.0 & Self::TIE != 0
    }
    /// Bits that differ, or [`Label::TIE`] where either is tied: 0 where one and the same material is the largest at both, alone.
    #[inline(always)]
    pub fn difference(self, other: Label) -> u32 {
        self.0 ^ other.0 | (self.0 | other.0) & Self::TIE
    }
}

/// The largest material at each node.
pub fn labels(values: &Values, nodes: usize) -> Result<Vec<Label>> {
    let parts = map_ranges(nodes, LEAST, |range| {
        let mut out = Vec::with_capacity(range.len());
        let mut buffer = [0.0; 64];
        // (Labels as wide as values: two at a time.)
        let (mut best, mut label) = ([0.0; 64 * BLOCK], [0u64; 64 * BLOCK]);
        for block in range.clone().step_by(64 * BLOCK) {
            let size = (64 * BLOCK).min(range.end - block);
            label[..size].fill(0);
            for f in 0..values.len() {
                for at in (0..size).step_by(64) {
                    let (first, count) = (block + at, 64.min(size - at));
                    let x = values_of(values, f, first, count, &mut buffer);
                    if !finite(x) {
                        return Err(not_finite(values, f, first, count));
                    }
                    let (best, label) = (&mut best[at..at + count], &mut label[at..at + count]);
                    if f == 0 {
                        best.copy_from_slice(x);
                        continue;
                    }
                    for ((&x, b), label) in x.iter().zip(best).zip(label) {
                        let tied = if x == *b { *label | Label::TIE as u64 } else { *label };
                        *label = if x > *b { f as u64 } else { tied };
                        *b = if x > *b { x } else { *b };
                    }
                }
            }
            out.extend(label[..size].iter().map(|&l| Label(l as u32)));
        }
        Ok(out)
    });
    Ok(crate::base::parallel::concat(parts.into_iter().collect::<Result<Vec<_>>>()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_any_number_of_values() {
        for n in 0..=64usize {
            let all: Vec<f64> =
                (0..n).map(|i| [1.0, -1.0, 0.0, -0.0, 5e-324, -f64::MAX, 3.0][(i * i + n) % 7]).collect();
            let signs = signs_of(&all).unwrap();
            for b in 0..64 {
                let x = all.get(b).copied().unwrap_or(0.0);
                assert_eq!((signs.positive >> b & 1 == 1, signs.negative >> b & 1 == 1), (x > 0.0, x < 0.0));
            }
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                for i in 0..n {
                    let mut all = all.clone();
                    all[i] = bad;
                    assert_eq!(signs_of(&all), None);
                    assert!(!finite(&all));
                }
            }
        }
    }
}

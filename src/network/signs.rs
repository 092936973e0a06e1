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

#[inline(always)]
fn signs_of(values: &[f64]) -> Signs {
    let mut signs = Signs::default();
    for (b, &x) in values.iter().enumerate() {
        signs.positive |= ((x > 0.0) as u64) << b;
        signs.negative |= ((x < 0.0) as u64) << b;
    }
    signs
}

/// Whether all are finite: the exponent of no value is the largest.
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
        for row in parts[p].clone() {
            for word in 0..row_words {
                let (first, count) = (row * row_nodes + word * 64, 64.min(row_nodes - word * 64));
                for f in 0..n {
                    let x = values_of(values, f, first, count, &mut buffer);
                    if !finite(x) {
                        // The first in order of nodes, whoever finds it.
                        let mut bad = bad.lock().expect("no panic while it is held");
                        let this = (first, f, count);
                        *bad = Some(bad.map_or(this, |b| b.min(this)));
                    }
                    out.push(signs_of(x));
                }
            }
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
    let parts = ranges(nodes, LEAST);
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
    debug_assert_eq!(parts.len(), signs.len());
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
        for first in range.clone().step_by(64) {
            let count = 64.min(range.end - first);
            let (mut best, mut label) = ([0.0; 64], [0u32; 64]);
            for f in 0..values.len() {
                let x = values_of(values, f, first, count, &mut buffer);
                if !finite(x) {
                    return Err(not_finite(values, f, first, count));
                }
                if f == 0 {
                    best[..count].copy_from_slice(x);
                    continue;
                }
                for i in 0..count {
                    let (x, b) = (x[i], best[i]);
                    label[i] = if x > b { f as u32 } else { label[i] | ((x == b) as u32) << 31 };
                    best[i] = if x > b { x } else { b };
                }
            }
            out.extend(label[..count].iter().map(|&l| Label(l)));
        }
        Ok(out)
    });
    Ok(crate::base::parallel::concat(parts.into_iter().collect::<Result<Vec<_>>>()?))
}

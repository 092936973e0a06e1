//! Union-find over positions `0..n`, with path halving. The root of a set is always its lowest member, so the
//! outcome is independent of the order of the unions. Cost: amortised O(log n) per operation, nearly constant in
//! practice (linking by index in place of rank costs no memory).

use super::parallel::{concat, map_ranges, offsets};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

/// Disjoint sets of positions.
#[derive(Clone, Debug)]
pub struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    /// `n` sets of one member each.
    pub fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    pub fn len(&self) -> usize {
        self.parent.len()
    }

    pub fn is_empty(&self) -> bool {
        self.parent.is_empty()
    }

    /// The lowest member of the set that holds `i`.
    #[inline]
    pub fn find(&mut self, i: usize) -> usize {
        let mut i = i as u32;
        loop {
            let up = self.parent[i as usize];
            if up == i {
                return i as usize;
            }
            let next = self.parent[up as usize];
            self.parent[i as usize] = next;
            i = next;
        }
    }

    /// Joins the sets of `a` and `b`; true if they were two.
    #[inline]
    pub fn union(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b)] = a.min(b) as u32;
        a != b
    }

    /// Numbers the sets 0, 1, 2, ... by their lowest members. Returns the set of each position and the number of
    /// sets. Cost: linear, because parents never exceed their children.
    pub fn labels(&self) -> (Vec<u32>, usize) {
        let mut labels = vec![0u32; self.parent.len()];
        let mut count = 0;
        for (i, &up) in self.parent.iter().enumerate() {
            labels[i] = if up as usize == i {
                count += 1;
                count - 1
            } else {
                labels[up as usize]
            };
        }
        (labels, count as usize)
    }
}

/// Disjoint sets of positions that several threads join at once. Links lead from higher to lower positions only, so the root of a set
/// is its lowest member in the end, whatever the order of the unions.
///
/// Relaxed atomics suffice: a place that is not a root only ever comes to hold another of its ancestors, and a root is linked
/// by compare-and-swap. On one thread there are no locked instructions.
#[derive(Debug)]
pub struct SharedUnionFind {
    parent: Vec<AtomicU32>,
    alone: bool,
}

impl SharedUnionFind {
    /// `n` sets of one member each, for the threads of the current rayon pool.
    pub fn new(n: usize) -> Self {
        let parent = (0..n as u32).into_par_iter().with_min_len(1 << 14).map(AtomicU32::new).collect();
        Self { parent, alone: rayon::current_num_threads() == 1 }
    }

    /// A member of the set that holds `i`, the lowest one once all unions are done.
    #[inline]
    pub fn find(&self, i: usize) -> usize {
        let parent = &self.parent[..];
        let mut i = i as u32;
        loop {
            // Of a root as of all that hang on one directly, without telling them apart.
            let up = parent[i as usize].load(Ordering::Relaxed);
            let next = parent[up as usize].load(Ordering::Relaxed);
            if next == up {
                return up as usize;
            }
            parent[i as usize].store(next, Ordering::Relaxed);
            i = next;
        }
    }

    #[inline]
    pub fn union(&self, a: usize, b: usize) {
        // Nearly always they are together already, under one root.
        if self.parent[a].load(Ordering::Relaxed) != self.parent[b].load(Ordering::Relaxed) {
            self.join(a, b);
        }
    }

    fn join(&self, a: usize, b: usize) {
        let (mut a, mut b) = (a, b);
        loop {
            (a, b) = (self.find(a), self.find(b));
            if a == b {
                return;
            }
            let (low, high) = (a.min(b) as u32, a.max(b) as u32);
            let root = &self.parent[high as usize];
            if self.alone {
                root.store(low, Ordering::Relaxed);
                return;
            }
            if root.compare_exchange(high, low, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
                return;
            }
        }
    }

    /// Joins pairs that mostly lie near one another: `walk(range, block)` hands those of some positions to `block`. Each block of positions is
    /// worked on by one thread, which joins what is within without a locked instruction and without waiting for lines
    /// of the cache that another one writes; pairs of two blocks follow. Nobody else may join meanwhile.
    pub fn join_blocks<'a>(&'a self, least: usize, walk: impl Fn(Range<usize>, &mut Block<'a>) + Sync) {
        let later = map_ranges(self.parent.len(), least, |range| {
            let mut block = Block { sets: self, start: range.start, end: range.end, later: Vec::new() };
            walk(range, &mut block);
            block.later
        });
        later.par_iter().for_each(|pairs| pairs.iter().for_each(|p| self.union(p[0] as usize, p[1] as usize)));
    }

    /// When all unions are done: the set of each position, numbered by lowest member, and these lowest members. Positions that
    /// `counts` does not admit (they are in no set with another) get `u32::MAX` and no number.
    pub fn labels(&self, counts: impl Fn(usize) -> bool + Sync) -> (Vec<u32>, Vec<u32>) {
        const LEAST: usize = 1 << 14;
        let n = self.parent.len();
        if self.alone {
            // Parents never exceed their children.
            let (mut of, mut roots): (Vec<u32>, Vec<u32>) = (Vec::with_capacity(n), Vec::new());
            for (i, up) in self.parent.iter().enumerate() {
                let up = up.load(Ordering::Relaxed) as usize;
                of.push(if up != i {
                    of[up]
                } else if counts(i) {
                    roots.push(i as u32);
                    roots.len() as u32 - 1
                } else {
                    u32::MAX
                });
            }
            return (of, roots);
        }
        // A bit for each root, and how many of them are set before each word: a root's place among all.
        let is_root = |i: usize| self.parent[i].load(Ordering::Relaxed) == i as u32 && counts(i);
        let words = n.div_ceil(64);
        let word_of =
            |w: usize| (64 * w..n.min(64 * w + 64)).fold(0u64, |bits, i| bits | (is_root(i) as u64) << (i % 64));
        let bits: Vec<u64> = (0..words).into_par_iter().with_min_len(LEAST / 64).map(word_of).collect();
        let before = offsets(bits.iter().map(|b| b.count_ones() as usize));
        let roots = concat(map_ranges(words, LEAST / 64, |range| {
            let mut roots = Vec::with_capacity(before[range.end] - before[range.start]);
            for w in range {
                let mut rest = bits[w];
                while rest != 0 {
                    roots.push((64 * w) as u32 + rest.trailing_zeros());
                    rest &= rest - 1;
                }
            }
            roots
        }));
        let place = |i: usize| before[i / 64] as u32 + (bits[i / 64] & ((1 << (i % 64)) - 1)).count_ones();
        // Within a part as on one thread: a parent's label is there already. Parents in earlier parts lead to their roots.
        let mut of = vec![0u32; n];
        let part = n.div_ceil(4 * rayon::current_num_threads()).max(LEAST);
        of.par_chunks_mut(part).enumerate().for_each(|(p, of)| {
            let start = p * part;
            for i in 0..of.len() {
                let up = self.parent[start + i].load(Ordering::Relaxed) as usize;
                of[i] = if up >= start && up < start + i {
                    of[up - start]
                } else if up == start + i {
                    if counts(up) { place(up) } else { u32::MAX }
                } else {
                    place(self.find(up))
                };
            }
        });
        (of, roots)
    }
}

/// A block of positions that one thread alone works on; see [`SharedUnionFind::join_blocks`].
pub struct Block<'a> {
    sets: &'a SharedUnionFind,
    start: usize,
    /// Only for assertions.
    end: usize,
    later: Vec<[u32; 2]>,
}

impl Block<'_> {
    /// Joins a position of the block with others that are not above it; with itself means not at all.
    ///
    /// Whether two are together already is a coin toss on a surface, so nothing asks: the lowest of the roots becomes the parent of all.
    #[inline]
    pub fn join(&mut self, at: usize, others: [usize; 3]) {
        debug_assert!(at < self.end && others.iter().all(|&o| o <= at));
        // Nobody has left the block yet: roots are roots of this thread's alone.
        let root = |other: usize| self.sets.find(if other < self.start { at } else { other });
        let [own, a, b, c] = [self.sets.find(at), root(others[0]), root(others[1]), root(others[2])];
        let low = own.min(a).min(b.min(c));
        for root in [own, a, b, c] {
            self.sets.parent[root].store(low as u32, Ordering::Relaxed);
        }
        if others.iter().any(|&o| o < self.start) {
            self.later.extend(others.iter().filter(|&&o| o < self.start).map(|&o| [o as u32, at as u32]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_lowest_and_labels_rise() {
        let mut sets = UnionFind::new(7);
        assert!(sets.union(6, 2));
        assert!(sets.union(2, 5));
        assert!(!sets.union(5, 6));
        assert!(sets.union(1, 3));
        assert_eq!((0..7).map(|i| sets.find(i)).collect::<Vec<_>>(), [0, 1, 2, 1, 4, 2, 2]);
        assert_eq!(sets.labels(), (vec![0, 1, 2, 1, 3, 2, 2], 4));
    }

    #[test]
    fn shared_sets_agree_with_those_of_one_thread() {
        let n = 100_000;
        let pairs: Vec<[usize; 2]> = (0..n).map(|i| [i, (i * 7919 + 13) % n]).filter(|p| p[0] % 3 != 0).collect();
        let mut sets = UnionFind::new(n);
        for p in &pairs {
            sets.union(p[0], p[1]);
        }
        for threads in [1, 3] {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
                let shared = SharedUnionFind::new(n);
                pairs.par_iter().for_each(|p| shared.union(p[0], p[1]));
                let (of, roots) = shared.labels(|_| true);
                assert_eq!((of, roots.len()), sets.labels());
                // Pairs in blocks, each with its higher position; some twice.
                let down = |i: usize, step: usize| i - (i * 7919 + step) % (i.min(3 * step) + 1);
                let others = |i: usize| [down(i, 5), if i.is_multiple_of(3) { down(i, 700) } else { i }, down(i, 5)];
                let odd = |i: &usize| i % 2 == 1;
                let mut sets = UnionFind::new(n);
                for i in (0..n).filter(odd) {
                    others(i).iter().for_each(|&o| _ = sets.union(i, o));
                }
                let shared = SharedUnionFind::new(n);
                shared.join_blocks(1000, |range, block| range.filter(odd).for_each(|i| block.join(i, others(i))));
                let (of, roots) = shared.labels(|_| true);
                assert_eq!((of, roots.len()), sets.labels());
                assert!(roots.len() > 10 && roots.len() < n / 2);
            });
        }
    }
}

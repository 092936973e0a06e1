//! Compressed sparse rows: everything of varying length lives in one flat array with offsets, filled by
//! count, prefix sum, fill. No per-element `Vec`.

use super::parallel::{self, each_part};
use std::ops::Range;

/// What can index a row.
pub trait Offset: Copy {
    fn at(self) -> usize;
}

impl Offset for usize {
    #[inline(always)]
    fn at(self) -> usize {
        self
    }
}

/// Pairs of a row and an item in a fixed order, at positions `0..positions()`; at a position there may be none or several.
///
/// # Safety
/// A walk over the same positions yields the same pairs whenever it is made: places are counted in one walk and written in
/// the next.
pub unsafe trait Walk<T>: Sync {
    fn positions(&self) -> usize;
    fn walk(&self, positions: Range<usize>, visit: impl FnMut(usize, T));
}

/// The pairs of `of(positions)`.
struct Positions<F>(usize, F);

// SAFETY: the functions given to `from_positions` only read what is borrowed and does not change meanwhile.
unsafe impl<T, I: Iterator<Item = (usize, T)>, F: Fn(Range<usize>) -> I + Sync> Walk<T> for Positions<F> {
    fn positions(&self) -> usize {
        self.0
    }
    #[inline]
    fn walk(&self, positions: Range<usize>, mut visit: impl FnMut(usize, T)) {
        for (row, item) in (self.1)(positions) {
            visit(row, item);
        }
    }
}

/// Row `i` is `items[offsets[i]..offsets[i + 1]]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Csr<T> {
    pub offsets: Vec<u32>,
    pub items: Vec<T>,
}

impl<T> Default for Csr<T> {
    fn default() -> Self {
        Self { offsets: vec![0], items: Vec::new() }
    }
}

impl<T> Csr<T> {
    pub fn with_capacity(rows: usize, items: usize) -> Self {
        let mut offsets = Vec::with_capacity(rows + 1);
        offsets.push(0);
        Self { offsets, items: Vec::with_capacity(items) }
    }

    /// Number of rows.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    #[inline(always)]
    pub fn range(&self, i: impl Offset) -> std::ops::Range<usize> {
        let i = i.at();
        self.offsets[i] as usize..self.offsets[i + 1] as usize
    }

    #[inline(always)]
    pub fn row(&self, i: impl Offset) -> &[T] {
        &self.items[self.range(i)]
    }

    #[inline(always)]
    pub fn row_mut(&mut self, i: impl Offset) -> &mut [T] {
        let range = self.range(i);
        &mut self.items[range]
    }

    /// Ends the row that was being pushed to `items`.
    #[inline(always)]
    pub fn end_row(&mut self) {
        self.offsets.push(self.items.len() as u32);
    }

    pub fn push_row(&mut self, row: &[T])
    where
        T: Copy,
    {
        self.items.extend_from_slice(row);
        self.end_row();
    }

    pub fn rows(&self) -> impl Iterator<Item = &[T]> {
        (0..self.len()).map(|i| self.row(i))
    }

    /// The rows of all parts behind one another.
    pub fn concat(mut parts: Vec<Self>) -> Self
    where
        T: Copy + Send + Sync,
    {
        if parts.len() == 1 {
            return parts.pop().expect("one part");
        }
        let offsets = Self::concat_offsets(&parts.iter().collect::<Vec<_>>());
        Self { offsets, items: parallel::concat(parts.into_iter().map(|p| p.items).collect()) }
    }

    /// The offsets of all parts behind one another.
    pub fn concat_offsets(parts: &[&Self]) -> Vec<u32>
    where
        T: Sync,
    {
        let first = parallel::offsets(parts.iter().map(|p| p.items.len()));
        // The last part is the end of all.
        let lengths: Vec<usize> = parts.iter().map(|p| p.len()).chain([1]).collect();
        parallel::write_parts(&lengths, |i, out| match parts.get(i) {
            Some(part) => out.extend(part.offsets[..part.len()].iter().map(|o| o + first[i] as u32)),
            None => out.push(first[i] as u32),
        })
    }

    /// Sorts `(row, item)` pairs into rows, keeping the order of the pairs within a row (a counting sort), on one thread.
    /// `pairs` is walked twice. Cost: linear.
    pub fn from_pairs<I>(rows: usize, pairs: I) -> Self
    where
        T: Copy + Default,
        I: Iterator<Item = (usize, T)> + Clone,
    {
        let mut sorted = Self::default();
        sorted.fill(rows, pairs);
        sorted
    }

    /// The same, into buffers that are there already.
    pub fn fill<I>(&mut self, rows: usize, pairs: I)
    where
        T: Copy + Default,
        I: Iterator<Item = (usize, T)> + Clone,
    {
        self.offsets.clear();
        self.offsets.resize(rows + 1, 0);
        let (_, starts) = self.offsets.split_first_mut().expect("an offset before the first row");
        pairs.clone().for_each(|(row, _)| starts[row] += 1);
        let sum = starts_of(&mut [starts], 0);
        self.items.clear();
        self.items.resize(sum as usize, T::default());
        // Filling moves each start to the end of its row.
        pairs.for_each(|(row, item)| {
            self.items[starts[row] as usize] = item;
            starts[row] += 1;
        });
    }

    /// The same for pairs that come from positions `0..count`, in their order; `of` yields those of a range of positions. Shared
    /// out among the threads of the current rayon pool as in [`Csr::from_walk`].
    pub fn from_positions<I>(rows: usize, count: usize, of: impl Fn(Range<usize>) -> I + Sync) -> Self
    where
        T: Copy + Send,
        I: Iterator<Item = (usize, T)>,
    {
        Self::from_walk(rows, &Positions(count, of))
    }

    /// The same for a walk: a loop written out is faster than nested iterators. Each thread counts the pairs of some positions by row,
    /// and then writes them where those of earlier positions end. Cost: linear, and a count per row and thread.
    pub fn from_walk(rows: usize, pairs: &impl Walk<T>) -> Self
    where
        T: Copy + Send,
    {
        let count = pairs.positions();
        // Counts of many rows by many threads would be more than the pairs.
        let most = rayon::current_num_threads().min(4.max((1 << 20) / rows.max(1)));
        let parts = (count / LEAST).clamp(1, most);
        let positions = |p: usize| count * p / parts..count * (p + 1) / parts;
        let mut offsets = vec![0u32; rows + 1];
        // The last part counts in `offsets` itself, behind each row's start.
        let mut before: Vec<Vec<u32>> = (1..parts).map(|_| vec![0u32; rows]).collect();
        let mut starts: Vec<&mut [u32]> = before.iter_mut().map(Vec::as_mut_slice).chain([&mut offsets[1..]]).collect();
        each_part(starts.iter_mut().collect(), |p, counts| pairs.walk(positions(p), |row, _| counts[row] += 1));
        // From counts to starts, by ranges of rows.
        let bands = if parts == 1 { 1 } else { (rows / LEAST).clamp(1, 4 * parts) };
        let mut split: Vec<Vec<&mut [u32]>> = (0..bands).map(|_| Vec::with_capacity(parts)).collect();
        for mut rest in starts.iter_mut().map(|s| &mut s[..]) {
            for (b, band) in split.iter_mut().enumerate() {
                let (part, behind) = rest.split_at_mut(rows * (b + 1) / bands - rows * b / bands);
                band.push(part);
                rest = behind;
            }
        }
        let totals = match bands {
            1 => vec![0],
            _ => each_part(split.iter_mut().collect(), |_, band| {
                band.iter().map(|counts| counts.iter().sum::<u32>() as usize).sum()
            }),
        };
        let first = parallel::offsets(totals.into_iter());
        let ends = each_part(split, |b, mut band| starts_of(&mut band, first[b] as u32));
        let total = ends[bands - 1] as usize;
        let mut items: Vec<T> = Vec::with_capacity(total);
        let room = Room(items.as_mut_ptr());
        each_part(starts, |p, next| {
            let room = &room;
            pairs.walk(positions(p), |row, item| {
                let at = next[row] as usize;
                assert!(at < total, "a walk is repeated");
                // SAFETY: within the capacity. Starts lie as far apart as each part has pairs in each row, and a walk
                // repeated yields as many, so every place is written once, by one thread.
                unsafe { room.0.add(at).write(item) };
                next[row] += 1;
            });
        });
        // SAFETY: as many places as there are pairs, and each has been written.
        unsafe { items.set_len(total) };
        Self { offsets, items }
    }

    /// Offsets start at 0, never fall, and end at the number of items.
    pub fn check(&self) -> Result<(), String> {
        if self.offsets.first() != Some(&0) {
            return Err("CSR offsets do not start at 0".into());
        }
        if let Some(i) = self.offsets.windows(2).position(|w| w[0] > w[1]) {
            return Err(format!("CSR offsets fall after row {i}"));
        }
        if *self.offsets.last().unwrap() as usize != self.items.len() {
            return Err("CSR offsets do not end at the number of items".into());
        }
        Ok(())
    }
}

/// Positions or rows in one task at least.
const LEAST: usize = 1 << 12;

/// The places that threads write to.
struct Room<T>(*mut T);

// SAFETY: threads only write values of `T` through it, each to places of its own.
unsafe impl<T: Send> Sync for Room<T> {}

/// Turns the counts of several parts, by row, into starts: of each row, one part behind the other. Returns where the last row ends.
fn starts_of(parts: &mut [&mut [u32]], first: u32) -> u32 {
    let mut sum = first;
    match parts {
        [starts] => starts.iter_mut().for_each(|n| (*n, sum) = (sum, sum + *n)),
        _ => {
            for row in 0..parts[0].len() {
                parts.iter_mut().for_each(|starts| (starts[row], sum) = (sum, sum + starts[row]));
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_sorted_alike_on_any_number_of_threads() {
        for (rows, count) in [(103, 0), (103, 5), (9000, 40_000), (20_000, 3)] {
            let pairs = (0..count).filter(|i| i % 7 != 0).map(|i| ((i * 7919) % rows, i as u32));
            let mut expected = Csr::default();
            for row in 0..rows {
                pairs.clone().filter(|p| p.0 == row && count < 100).for_each(|p| expected.items.push(p.1));
                expected.end_row();
            }
            let sorted = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let of =
                    |positions: Range<usize>| positions.filter(|i| i % 7 != 0).map(|i| ((i * 7919) % rows, i as u32));
                pool.install(|| Csr::from_positions(rows, count, of))
            };
            assert_eq!(sorted(1), Csr::from_pairs(rows, pairs.clone()));
            let one = sorted(1);
            assert_eq!(one.check(), Ok(()));
            assert!(count >= 100 || one == expected);
            assert!(one.rows().enumerate().all(|(r, row)| row.iter().all(|&i| (i as usize * 7919) % rows == r)));
            assert!(one.rows().all(|row| row.windows(2).all(|w| w[0] < w[1])));
            [2, 5].iter().for_each(|&threads| assert_eq!(sorted(threads), one));
        }
    }
}

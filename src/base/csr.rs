//! Compressed sparse rows: everything of varying length lives in one flat array with offsets, filled by
//! count, prefix sum, fill. No per-element `Vec`.

use super::parallel;
use rayon::prelude::*;

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

/// Pairs of a row and an item, in a fixed order.
pub trait Walk<T>: Sync {
    fn walk(&self, visit: impl FnMut(usize, T));
}

/// Those of an iterator.
struct Pairs<I>(I);

impl<T, I: Iterator<Item = (usize, T)> + Clone + Sync> Walk<T> for Pairs<I> {
    #[inline]
    fn walk(&self, mut visit: impl FnMut(usize, T)) {
        for (row, item) in self.0.clone() {
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
        let first = parallel::offsets(parts.iter().map(|p| p.items.len()));
        // The last part is the end of all.
        let lengths: Vec<usize> = parts.iter().map(Self::len).chain([1]).collect();
        let offsets = parallel::write_parts(&lengths, |i, out| match parts.get(i) {
            Some(part) => out.extend(part.offsets[..part.len()].iter().map(|o| o + first[i] as u32)),
            None => out.push(first[i] as u32),
        });
        Self { offsets, items: parallel::concat(parts.into_iter().map(|p| p.items).collect()) }
    }

    /// Sorts `(row, item)` pairs into rows, keeping the order of the pairs within a row (a counting sort).
    /// `pairs` is walked twice. Cost: linear; shared out among threads as in [`Csr::from_walk`].
    pub fn from_pairs<I>(rows: usize, pairs: I) -> Self
    where
        T: Copy + Default + Send,
        I: Iterator<Item = (usize, T)> + Clone + Send + Sync,
    {
        Self::from_walk(rows, &Pairs(pairs))
    }

    /// The same for pairs that come from a walk: a loop written out is faster than nested iterators. Each thread of the current
    /// rayon pool takes a range of rows, and walks all pairs twice to find those that are in it.
    pub fn from_walk(rows: usize, pairs: &impl Walk<T>) -> Self
    where
        T: Copy + Default + Send,
    {
        let parts = if rows < 1 << 12 { 1 } else { rayon::current_num_threads().clamp(1, rows) };
        let bounds: Vec<usize> = (0..=parts).map(|p| rows * p / parts).collect();
        let mut offsets = vec![0u32; rows + 1];
        // Behind each row's start within its range; `offsets[0]` stays 0.
        let totals = each_part(split(&mut offsets[1..], bounds.windows(2).map(|w| w[1] - w[0])), |p, starts| {
            let (first, counts) = (bounds[p], &mut *starts);
            pairs.walk(move |row, _| {
                if let Some(n) = counts.get_mut(row.wrapping_sub(first)) {
                    *n += 1;
                }
            });
            let mut sum = 0;
            for n in starts.iter_mut() {
                (*n, sum) = (sum, sum + *n);
            }
            sum as usize
        });
        let mut items = vec![T::default(); totals.iter().sum()];
        let starts = split(&mut offsets[1..], bounds.windows(2).map(|w| w[1] - w[0]));
        let parts = starts.into_iter().zip(split(&mut items, totals.iter().copied())).collect();
        each_part(parts, |p, (starts, items)| {
            let (first, next) = (bounds[p], &mut *starts);
            pairs.walk(move |row, item| {
                if let Some(at) = next.get_mut(row.wrapping_sub(first)) {
                    items[*at as usize] = item;
                    *at += 1;
                }
            });
            // Filling has moved each start to the end of its row.
            let base = totals[..p].iter().sum::<usize>() as u32;
            if base != 0 {
                starts.iter_mut().for_each(|end| *end += base);
            }
        });
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

/// Consecutive parts of a slice.
fn split<T>(mut slice: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    lengths
        .map(|length| {
            let (part, behind) = std::mem::take(&mut slice).split_at_mut(length);
            slice = behind;
            part
        })
        .collect()
}

/// Runs over parts, at once if there are several.
fn each_part<P: Send, R: Send>(parts: Vec<P>, body: impl Fn(usize, P) -> R + Sync + Send) -> Vec<R> {
    match parts.len() {
        1 => parts.into_iter().map(|part| body(0, part)).collect(),
        _ => parts.into_par_iter().enumerate().with_max_len(1).map(|(p, part)| body(p, part)).collect(),
    }
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
                pool.install(|| Csr::from_pairs(rows, pairs.clone()))
            };
            let one = sorted(1);
            assert_eq!(one.check(), Ok(()));
            assert!(count >= 100 || one == expected);
            assert!(one.rows().enumerate().all(|(r, row)| row.iter().all(|&i| (i as usize * 7919) % rows == r)));
            assert!(one.rows().all(|row| row.windows(2).all(|w| w[0] < w[1])));
            [2, 5].iter().for_each(|&threads| assert_eq!(sorted(threads), one));
        }
    }
}

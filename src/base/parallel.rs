//! Loops over flat arrays that give the same result on any number of threads: ranges of positions are worked on independently,
//! and what they yield is put together in order. On one thread there is one range, and nothing is copied.

use rayon::prelude::*;
use std::mem::MaybeUninit;
use std::ops::Range;

/// Consecutive ranges that cover `0..count`: one on one thread, else several per thread (they differ in work) of `least`
/// positions or more.
pub fn ranges(count: usize, least: usize) -> Vec<Range<usize>> {
    let threads = rayon::current_num_threads();
    let parts = if threads == 1 { 1 } else { (count / least.max(1)).clamp(1, 4 * threads) };
    (0..parts).map(|i| count * i / parts..count * (i + 1) / parts).collect()
}

/// What `body` yields for each of [`ranges`], in order.
pub fn map_ranges<R: Send>(count: usize, least: usize, body: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    let ranges = ranges(count, least);
    match ranges.len() {
        // Without leaving the thread.
        1 => ranges.into_iter().map(&body).collect(),
        _ => ranges.into_par_iter().with_max_len(1).map(&body).collect(),
    }
}

/// Fills one part of an array from front to back.
pub struct Writer<'a, T> {
    rest: std::slice::IterMut<'a, MaybeUninit<T>>,
}

impl<T: Copy> Writer<'_, T> {
    /// Panics where the part is full already.
    #[inline(always)]
    pub fn push(&mut self, value: T) {
        self.rest.next().expect("room in this part").write(value);
    }
    #[inline]
    pub fn extend(&mut self, values: impl IntoIterator<Item = T>) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

/// An array in parts of known lengths, each filled by `write(part, writer)`; panics if a part is not filled.
/// Cost: that of the writes; the array is not zeroed before.
pub fn write_parts<T: Copy + Send>(lengths: &[usize], write: impl Fn(usize, &mut Writer<T>) + Sync) -> Vec<T> {
    let total = lengths.iter().sum();
    let mut all: Vec<T> = Vec::with_capacity(total);
    let mut rest = &mut all.spare_capacity_mut()[..total];
    let mut parts = Vec::with_capacity(lengths.len());
    for (i, &length) in lengths.iter().enumerate() {
        let (part, behind) = rest.split_at_mut(length);
        rest = behind;
        parts.push((i, part));
    }
    let fill = |(i, part): (usize, &mut [MaybeUninit<T>])| {
        let mut writer = Writer { rest: part.iter_mut() };
        write(i, &mut writer);
        assert_eq!(writer.rest.len(), 0, "part {i} is not filled");
    };
    if lengths.len() == 1 || rayon::current_num_threads() == 1 {
        parts.into_iter().for_each(fill);
    } else {
        parts.into_par_iter().with_max_len(1).for_each(fill);
    }
    // SAFETY: the parts cover the first `total` places, and each was found to be filled to its end.
    unsafe { all.set_len(total) };
    all
}

/// All parts behind one another.
pub fn concat<T: Copy + Send + Sync>(mut parts: Vec<Vec<T>>) -> Vec<T> {
    if parts.len() == 1 {
        return parts.pop().expect("one part");
    }
    let lengths: Vec<usize> = parts.iter().map(Vec::len).collect();
    write_parts(&lengths, |i, out| out.extend(parts[i].iter().copied()))
}

/// `0`, then the sums of the first values, the last one being the sum of all.
pub fn offsets(lengths: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut sum = 0;
    let mut all = vec![0];
    all.extend(lengths.map(|n| {
        sum += n;
        sum
    }));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pool(threads: usize) -> rayon::ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
    }

    #[test]
    fn parts_in_order_on_any_number_of_threads() {
        for threads in [1, 2, 5] {
            pool(threads).install(|| {
                for count in [0usize, 1, 7, 1000] {
                    let parts = map_ranges(count, 3, |r| r.map(|i| i as u32).collect::<Vec<_>>());
                    assert_eq!(concat(parts), (0..count as u32).collect::<Vec<_>>());
                }
                let lengths = [3, 0, 2];
                assert_eq!(write_parts(&lengths, |i, out| out.extend((0..lengths[i]).map(|j| (i, j)))).len(), 5);
            });
        }
    }

    #[test]
    #[should_panic(expected = "not filled")]
    fn a_part_that_is_not_filled_is_noticed() {
        write_parts::<u8>(&[2], |_, out| out.push(1));
    }
}

//! Loops over flat arrays that give the same result on any number of threads: ranges of positions are worked on independently,
//! and what they yield is put together in order. On one thread there is one range, and nothing is copied.

use rayon::prelude::*;
use std::mem::MaybeUninit;
use std::ops::Range;
use std::sync::Mutex;

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
    /// All that is left.
    pub fn fill(&mut self, value: T) {
        std::mem::take(&mut self.rest).into_slice().fill(MaybeUninit::new(value));
    }
    #[inline]
    pub fn extend(&mut self, values: impl IntoIterator<Item = T>) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

/// Runs over parts, at once if there are several and threads for them; what `body` yields, in order.
pub fn each_part<P: Send, R: Send>(parts: Vec<P>, body: impl Fn(usize, P) -> R + Sync + Send) -> Vec<R> {
    if parts.len() == 1 || rayon::current_num_threads() == 1 {
        return parts.into_iter().enumerate().map(|(i, part)| body(i, part)).collect();
    }
    parts.into_par_iter().enumerate().with_max_len(1).map(|(i, part)| body(i, part)).collect()
}

/// An array that is being written in parts.
struct Parts<T>(Vec<T>);

impl<T: Copy + Send> Parts<T> {
    fn of(lengths: &[usize]) -> Self {
        Self(Vec::with_capacity(lengths.iter().sum()))
    }
    fn writers(&mut self, lengths: &[usize]) -> Vec<Writer<'_, T>> {
        let mut rest = self.0.spare_capacity_mut();
        lengths
            .iter()
            .map(|&length| {
                let (part, behind) = std::mem::take(&mut rest).split_at_mut(length);
                rest = behind;
                Writer { rest: part.iter_mut() }
            })
            .collect()
    }
    /// # Safety
    /// All parts are full.
    unsafe fn done(mut self, lengths: &[usize]) -> Vec<T> {
        // SAFETY: the parts cover the first places, so many.
        unsafe { self.0.set_len(lengths.iter().sum()) };
        self.0
    }
}

impl<T> Writer<'_, T> {
    /// Panics where the part is not full.
    fn end(self, part: usize) {
        assert_eq!(self.rest.len(), 0, "part {part} is not filled");
    }
}

/// An array in parts of known lengths, each filled by `write(part, writer)`; panics if a part is not filled.
/// Cost: that of the writes; the array is not zeroed before.
pub fn write_parts<T: Copy + Send>(lengths: &[usize], write: impl Fn(usize, &mut Writer<T>) + Sync + Send) -> Vec<T> {
    let mut all = Parts::of(lengths);
    each_part(all.writers(lengths), |i, mut writer| {
        write(i, &mut writer);
        writer.end(i);
    });
    // SAFETY: each part was found to be filled to its end.
    unsafe { all.done(lengths) }
}

/// Three arrays at once, in as many parts each.
pub fn write_parts3<A: Copy + Send, B: Copy + Send, C: Copy + Send>(
    lengths: [&[usize]; 3],
    write: impl Fn(usize, &mut Writer<A>, &mut Writer<B>, &mut Writer<C>) + Sync + Send,
) -> (Vec<A>, Vec<B>, Vec<C>) {
    assert!(lengths[1].len() == lengths[0].len() && lengths[2].len() == lengths[0].len(), "as many parts of each");
    let (mut a, mut b, mut c) = (Parts::of(lengths[0]), Parts::of(lengths[1]), Parts::of(lengths[2]));
    let writers = a.writers(lengths[0]).into_iter().zip(b.writers(lengths[1])).zip(c.writers(lengths[2])).collect();
    each_part(writers, |i, ((mut a, mut b), mut c)| {
        write(i, &mut a, &mut b, &mut c);
        a.end(i);
        b.end(i);
        c.end(i);
    });
    // SAFETY: each part was found to be filled to its end; there are as many of each.
    unsafe { (a.done(lengths[0]), b.done(lengths[1]), c.done(lengths[2])) }
}

/// An array taken for one of another type, where it is.
///
/// # Safety
/// Both types have the same layout, and every value of the one is a value of the other.
pub unsafe fn recast<A, B>(array: Vec<A>) -> Vec<B> {
    const { assert!(size_of::<A>() == size_of::<B>() && align_of::<A>() == align_of::<B>()) };
    let mut array = std::mem::ManuallyDrop::new(array);
    // SAFETY: the same allocation, which nobody else frees; lengths count elements of the same size.
    unsafe { Vec::from_raw_parts(array.as_mut_ptr().cast(), array.len(), array.capacity()) }
}

/// Buffers that tasks take and leave behind for others: there are as many as tasks that run at once.
#[derive(Debug, Default)]
pub struct Pool<T>(Mutex<Vec<T>>);

impl<T: Default> Pool<T> {
    pub fn with<R>(&self, task: impl FnOnce(&mut T) -> R) -> R {
        let mut buffers = self.all().pop().unwrap_or_default();
        let result = task(&mut buffers);
        self.all().push(buffers);
        result
    }
    /// The lock is held for a push or a pop only: what a task that panicked has left is whole.
    fn all(&self) -> std::sync::MutexGuard<'_, Vec<T>> {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
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

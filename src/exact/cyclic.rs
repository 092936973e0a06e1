//! Cyclic order of directions from pairwise turns alone: chords around a vertex of a plane, half-planes around an
//! edge. Written once for all engines.
//!
//! The turn of two directions is the sign of the sine of the angle from the first to the second. That is no linear
//! order; measured from a fixed first direction it is one: equal to it, left of it, opposite to it, right of it, and
//! within the left and the right half the turn itself. Every direction is compared with the first once, then a stable
//! merge sort does the rest.
//!
//! Degenerate cases: equal directions keep the order in which they came. Contradictory answers (directions of a
//! self-intersecting input) give some permutation, the same each time: the number of comparisons is fixed by the
//! length, never by the answers, so there is nothing to hang or panic (the standard sort may panic there).
//!
//! Cost: n − 1 turns against the first, then at most n·log₂ n. No allocation up to [`SMALL`] directions.

use super::Sign;

/// Up to so many directions are sorted on the stack.
pub const SMALL: usize = 16;

/// Where a direction lies as seen from the first one, in counter-clockwise order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Same,
    Left,
    Opposite,
    Right,
}

/// Sorts directions counter-clockwise, starting at `items[0]`.
///
/// `turn(a, b)` is the sign of the sine of the angle from `a` to `b`. Where it is zero, `opposite(a, b)` says whether
/// they point away from each other (true) or the same way (false). Equal directions stay in the order given; those
/// equal to `items[0]` follow it at the start.
pub fn sort_cyclic<T: Copy>(
    items: &mut [T],
    mut turn: impl FnMut(&T, &T) -> Sign,
    mut opposite: impl FnMut(&T, &T) -> bool,
) {
    let n = items.len();
    if n < 3 {
        return;
    }
    let first = items[0];
    let mut part = |x: &T| match turn(&first, x) {
        Sign::Positive => Part::Left,
        Sign::Negative => Part::Right,
        Sign::Zero if opposite(&first, x) => Part::Opposite,
        Sign::Zero => Part::Same,
    };
    if n <= SMALL {
        let mut keyed = [(Part::Same, first); SMALL];
        for (slot, x) in keyed[1..n].iter_mut().zip(&items[1..]) {
            *slot = (part(x), *x);
        }
        insertion_sort(&mut keyed[..n], &mut turn);
        for (x, slot) in items.iter_mut().zip(&keyed) {
            *x = slot.1;
        }
        return;
    }
    let mut from = Vec::with_capacity(n);
    from.push((Part::Same, first));
    from.extend(items[1..].iter().map(|x| (part(x), *x)));
    merge_sort(&mut from, &mut turn);
    for (x, slot) in items.iter_mut().zip(&from) {
        *x = slot.1;
    }
}

/// Whether `b` has to come before `a`, which was given first.
#[inline]
fn swapped<T>(a: &(Part, T), b: &(Part, T), turn: &mut impl FnMut(&T, &T) -> Sign) -> bool {
    match a.0.cmp(&b.0) {
        std::cmp::Ordering::Less => false,
        std::cmp::Ordering::Greater => true,
        // Directions within one of these parts span less than half a turn, so the turn orders them.
        std::cmp::Ordering::Equal if matches!(a.0, Part::Left | Part::Right) => turn(&a.1, &b.1) == Sign::Negative,
        std::cmp::Ordering::Equal => false,
    }
}

/// Binary insertion: stable, and at most ⌈log₂ i⌉ comparisons for the i-th item.
fn insertion_sort<T: Copy>(items: &mut [(Part, T)], turn: &mut impl FnMut(&T, &T) -> Sign) {
    for i in 1..items.len() {
        let x = items[i];
        let (mut lo, mut hi) = (0, i);
        while lo < hi {
            let mid = (lo + hi) / 2;
            if swapped(&items[mid], &x, turn) {
                hi = mid;
            } else {
                lo = mid + 1;
            }
        }
        items.copy_within(lo..i, lo + 1);
        items[lo] = x;
    }
}

/// Bottom-up merge sort over runs of insertion sort.
fn merge_sort<T: Copy>(items: &mut Vec<(Part, T)>, turn: &mut impl FnMut(&T, &T) -> Sign) {
    const RUN: usize = 8;
    let n = items.len();
    for run in items.chunks_mut(RUN) {
        insertion_sort(run, turn);
    }
    let mut to = items.clone();
    let mut width = RUN;
    while width < n {
        let mut start = 0;
        while start < n {
            let (mid, end) = ((start + width).min(n), (start + 2 * width).min(n));
            let (mut a, mut b) = (start, mid);
            for slot in &mut to[start..end] {
                let take_b = b < end && (a == mid || swapped(&items[a], &items[b], turn));
                *slot = if take_b { items[b] } else { items[a] };
                if take_b {
                    b += 1;
                } else {
                    a += 1;
                }
            }
            start = end;
        }
        std::mem::swap(items, &mut to);
        width *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sign(x: i64) -> Sign {
        match x.signum() {
            1 => Sign::Positive,
            -1 => Sign::Negative,
            _ => Sign::Zero,
        }
    }
    fn sort(items: &mut [(i64, i64, usize)]) {
        sort_cyclic(items, |a, b| sign(a.0 * b.1 - a.1 * b.0), |a, b| a.0 * b.0 + a.1 * b.1 < 0);
    }
    /// Angle from the first direction, as a rank: half turns and the slope within, by brute force over all pairs.
    fn is_cyclic(items: &[(i64, i64, usize)]) -> bool {
        let first = items[0];
        let angle = |d: &(i64, i64, usize)| {
            let (cross, dot) = (first.0 * d.1 - first.1 * d.0, first.0 * d.0 + first.1 * d.1);
            let a = (cross as f64).atan2(dot as f64);
            if a < 0.0 { a + std::f64::consts::TAU } else { a }
        };
        items.windows(2).all(|w| {
            let same = w[0].0 * w[1].1 == w[0].1 * w[1].0 && w[0].0 * w[1].0 + w[0].1 * w[1].1 > 0;
            if same { w[0].2 < w[1].2 } else { angle(&w[0]) < angle(&w[1]) }
        })
    }

    #[test]
    fn sorts_every_length_from_every_start() {
        let mut state = 88172645463325252u64;
        let mut random = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state
        };
        for n in 1..60 {
            for _ in 0..20 {
                let mut items = Vec::new();
                while items.len() < n {
                    let (x, y) = ((random() % 9) as i64 - 4, (random() % 9) as i64 - 4);
                    if (x, y) != (0, 0) {
                        items.push((x, y, items.len()));
                    }
                }
                let first = items[0];
                sort(&mut items);
                assert_eq!(items[0], first);
                assert!(is_cyclic(&items), "{items:?}");
            }
        }
    }

    #[test]
    fn contradictory_answers_end_in_a_permutation() {
        for n in [3usize, 10, 16, 17, 100, 1000] {
            let mut items: Vec<usize> = (0..n).collect();
            let mut turns = 0;
            sort_cyclic(
                &mut items,
                |a, b| {
                    turns += 1;
                    sign((a * 7 + b * 13) as i64 % 3 - 1)
                },
                |a, b| (a + b) % 2 == 0,
            );
            assert!(turns <= n * (2 + n.ilog2() as usize));
            items.sort();
            assert!(items.iter().enumerate().all(|(i, &x)| i == x));
        }
    }
}

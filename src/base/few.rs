//! Sorting and copying of rows that hold a handful of items, of which there are millions.

/// Sorts keys: insertion for the usual handful, which arrives nearly in order; the library's sort beyond. (A network of comparisons
/// without branches is a third faster on buckets alone, but not within the building of a mesh, where it was measured.)
#[inline]
pub fn sort_few(row: &mut [u64]) {
    if row.len() > 24 {
        row.sort_unstable();
        return;
    }
    for i in 1..row.len() {
        let item = row[i];
        let mut j = i;
        while j > 0 && row[j - 1] > item {
            row[j] = row[j - 1];
            j -= 1;
        }
        row[j] = item;
    }
}

/// Copies a row. Two to eight items are moved by two copies of a fixed size, which overlap: a call of the library's costs more.
#[inline(always)]
pub fn copy_few<T: Copy>(to: &mut [T], from: &[T]) {
    assert_eq!(to.len(), from.len());
    match from.len() {
        4..=8 => copy_ends::<4, T>(to, from),
        2..4 => copy_ends::<2, T>(to, from),
        _ => to.copy_from_slice(from),
    }
}

#[inline(always)]
fn copy_ends<const N: usize, T: Copy>(to: &mut [T], from: &[T]) {
    let (first, last) = (from.first_chunk::<N>(), from.last_chunk::<N>());
    let (first, last) = (*first.expect("N items"), *last.expect("N items"));
    *to.first_chunk_mut().expect("N items") = first;
    *to.last_chunk_mut().expect("N items") = last;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_lengths() {
        let mut x = 1u64;
        let mut next = || {
            x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            x >> 40
        };
        for len in (0..60).chain([1000]) {
            let mut row: Vec<u64> = (0..len).map(|i| if i % 7 == 3 { u64::MAX } else { next() % 50 }).collect();
            let mut expected = row.clone();
            expected.sort();
            sort_few(&mut row);
            assert_eq!(row, expected);
        }
    }

    #[test]
    fn copies_of_all_lengths() {
        for len in 0..20u32 {
            let from: Vec<u32> = (1..=len).collect();
            let mut to = vec![0; len as usize];
            copy_few(&mut to, &from);
            assert_eq!(to, from);
        }
    }
}

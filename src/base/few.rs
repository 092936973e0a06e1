//! Sorting of rows that hold a handful of keys, of which there are millions.

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
}

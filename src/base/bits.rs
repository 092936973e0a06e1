//! Sets as bits in words.

/// The places of the bits that are set, rising; the first word holds places from `base` on.
pub fn ones(base: usize, words: &[u64]) -> impl Iterator<Item = usize> {
    words.iter().enumerate().flat_map(move |(w, &word)| {
        let mut rest = word;
        std::iter::from_fn(move || {
            let bit = rest.trailing_zeros() as usize;
            rest &= rest.wrapping_sub(1);
            (bit < 64).then_some(base + 64 * w + bit)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_and_last_bits() {
        let places: Vec<usize> = ones(128, &[1 | 1 << 63, 0, 0b110]).collect();
        assert_eq!(places, [128, 191, 257, 258]);
        assert_eq!(ones(0, &[!0]).count(), 64);
    }
}

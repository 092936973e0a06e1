//! Union-find over positions `0..n`, with path halving. The root of a set is always its lowest member, so the
//! outcome is independent of the order of the unions. Cost: amortised O(log n) per operation, nearly constant in
//! practice (linking by index in place of rank costs no memory).

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
}

//! Compressed sparse rows: everything of varying length lives in one flat array with offsets, filled by
//! count, prefix sum, fill. No per-element `Vec`.

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

    /// Sorts `(row, item)` pairs into rows, keeping the order of the pairs within a row (a counting sort).
    /// `pairs` is walked twice. Cost: linear.
    pub fn from_pairs<I>(rows: usize, pairs: I) -> Self
    where
        T: Copy + Default,
        I: Iterator<Item = (usize, T)> + Clone,
    {
        let mut offsets = vec![0u32; rows + 1];
        for (row, _) in pairs.clone() {
            offsets[row + 1] += 1;
        }
        for i in 0..rows {
            offsets[i + 1] += offsets[i];
        }
        let mut fill = offsets.clone();
        let mut items = vec![T::default(); offsets[rows] as usize];
        for (row, item) in pairs {
            items[fill[row] as usize] = item;
            fill[row] += 1;
        }
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

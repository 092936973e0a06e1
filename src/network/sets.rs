//! Sets of functions, each kept once. Ids are given in the order of arrival; [`rank`] then orders the sets of all tasks by what they are.

use super::data::SetItem;
use crate::base::{Csr, FunctionId, SetId};
use crate::exact::Sign;
use hashbrown::HashTable;

/// Sets in the order of their arrival.
#[derive(Default)]
pub struct SetTable {
    pub items: Csr<SetItem>,
    /// Never iterated.
    table: HashTable<u32>,
    /// The set of one function with orientation `Positive`, 0 if none yet, else one more than its number.
    single: Vec<u32>,
    last: u32,
}

fn hash(items: &[SetItem]) -> u64 {
    items.iter().fold(0, |h: u64, item| {
        let x = (item.function.0 as u64) << 2 | (item.orientation.to_i8() + 1) as u64;
        (h.rotate_left(23) ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    })
}

impl SetTable {
    pub fn intern(&mut self, items: &[SetItem]) -> u32 {
        if (self.last as usize) < self.items.len() && self.items.row(self.last as usize) == items {
            return self.last;
        }
        let rows = &self.items;
        let found = self.table.find(hash(items), |&i| rows.row(i as usize) == items).copied();
        self.last = found.unwrap_or_else(|| {
            let id = self.items.len() as u32;
            self.items.push_row(items);
            let rows = &self.items;
            self.table.insert_unique(hash(items), id, |&i| hash(rows.row(i as usize)));
            id
        });
        self.last
    }

    /// The set of one function.
    #[inline]
    pub fn single(&mut self, f: FunctionId) -> u32 {
        if self.single.len() <= f.at() {
            self.single.resize(f.at() + 1, 0);
        }
        if self.single[f.at()] == 0 {
            self.single[f.at()] = 1 + self.intern(&[SetItem { function: f, orientation: Sign::Positive }]);
        }
        self.single[f.at()] - 1
    }

    /// The set of two materials, the lower one on the positive side.
    #[inline]
    pub fn pair(&mut self, a: FunctionId, b: FunctionId) -> u32 {
        debug_assert!(a < b);
        let item = |function, orientation| SetItem { function, orientation };
        self.intern(&[item(a, Sign::Positive), item(b, Sign::Negative)])
    }
}

/// The distinct sets of several tables in lexicographic order, and for each table the new ids of its sets.
pub fn rank(tables: &[&SetTable]) -> (Csr<SetItem>, Vec<Vec<SetId>>) {
    let row = |&(t, i): &(u32, u32)| tables[t as usize].items.row(i as usize);
    let mut all: Vec<(u32, u32)> = Vec::new();
    for (t, table) in tables.iter().enumerate() {
        all.extend((0..table.items.len()).map(|i| (t as u32, i as u32)));
    }
    all.sort_unstable_by(|a, b| row(a).cmp(row(b)));
    let mut sets = Csr::default();
    let mut ids: Vec<Vec<SetId>> = tables.iter().map(|t| vec![SetId::NONE; t.items.len()]).collect();
    for same in all.chunk_by(|a, b| row(a) == row(b)) {
        for &(t, i) in same {
            ids[t as usize][i as usize] = SetId::of(sets.len());
        }
        sets.push_row(row(&same[0]));
    }
    (sets, ids)
}

//! The winding-number vector of each cell (section 3.3 of the paper).
//!
//! The unbounded cell has zeros. Across a patch from behind to before, each operand's number falls by its net multiplicity there: a closed mesh that
//! is oriented outward has its inside behind. So the numbers spread from cell to cell; then every patch is asked whether they agree, which closes all
//! cycles of the graph of cells and patches.
//!
//! Rows are sparse: an operand that a cell is outside of takes no room.
//!
//! Cost: linear in patches times the length of rows.

use super::{Cells, Multiplicity, Winding};
use crate::base::{CellId, Csr, Error, PatchId, Result, Status};
use crate::complex::HalfFace;

/// Spreads and verifies winding numbers. Errors: `Internal` if they contradict one another, naming the patch.
pub fn winding(cells: &Cells) -> Result<Winding> {
    let count = cells.cell_count;
    // The patches around each cell, by the side that looks into it.
    let sides = |p: usize| {
        let f = cells.patch_face[p];
        [false, true].map(|front| (cells.of[HalfFace::new(f, front).at()].at(), (PatchId::of(p), front)))
    };
    let around = Csr::from_pairs(count, (0..cells.patch_face.len()).flat_map(sides));
    // Rows in the order in which cells are reached, and the place of each.
    let mut reached: Csr<Multiplicity> = Csr::with_capacity(count, count);
    let mut place = vec![u32::MAX; count];
    let mut queue = Vec::with_capacity(count);
    reached.end_row();
    place[0] = 0;
    queue.push(0usize);
    let mut row = Vec::new();
    let mut at = 0;
    while at < queue.len() {
        let c = queue[at];
        for &(p, front) in around.row(c) {
            let other = cells.of[HalfFace::new(cells.patch_face[p.at()], !front).at()].at();
            if place[other] != u32::MAX {
                continue;
            }
            place[other] = queue.len() as u32;
            queue.push(other);
            row.clear();
            // The cell before the patch has less.
            sum(reached.row(at), cells.multiplicity.row(p), if front { 1 } else { -1 }, &mut row)?;
            reached.push_row(&row);
        }
        at += 1;
    }
    if queue.len() != count {
        return Err(Error::new(Status::Internal, "a cell is not connected to the outside"));
    }
    let mut rows = Csr::with_capacity(count, reached.items.len());
    place.iter().for_each(|&at| rows.push_row(reached.row(at as usize)));
    let winding = Winding { rows };
    match winding.contradiction(cells)? {
        None => Ok(winding),
        Some(p) => {
            let message =
                format!("winding numbers on the two sides of patch {} do not differ by its multiplicity", p.0);
            Err(Error::new(Status::Internal, message))
        }
    }
}

/// `a + sign·b`, zeros left out.
fn sum(a: &[Multiplicity], b: &[Multiplicity], sign: i32, out: &mut Vec<Multiplicity>) -> Result<()> {
    let (mut i, mut j) = (0, 0);
    while i < a.len() || j < b.len() {
        let operand = match (a.get(i), b.get(j)) {
            (Some(x), Some(y)) => x.0.min(y.0),
            (Some(x), None) => x.0,
            (None, Some(y)) => y.0,
            (None, None) => break,
        };
        let mut total = 0i64;
        if let Some(x) = a.get(i).filter(|x| x.0 == operand) {
            total += x.1 as i64;
            i += 1;
        }
        if let Some(y) = b.get(j).filter(|y| y.0 == operand) {
            total += sign as i64 * y.1 as i64;
            j += 1;
        }
        if total != 0 {
            let too_large = |_| Error::new(Status::TooLarge, "a winding number is more than 32 bits can hold");
            out.push((operand, i32::try_from(total).map_err(too_large)?));
        }
    }
    Ok(())
}

impl Winding {
    /// The first patch across which numbers do not step by its multiplicity.
    fn contradiction(&self, cells: &Cells) -> Result<Option<PatchId>> {
        let mut row = Vec::new();
        for (p, &f) in cells.patch_face.iter().enumerate() {
            let [back, front] = [false, true].map(|front| cells.of[HalfFace::new(f, front).at()]);
            row.clear();
            sum(self.rows.row(front), cells.multiplicity.row(p), 1, &mut row)?;
            if row != self.rows.row(back) {
                return Ok(Some(PatchId::of(p)));
            }
        }
        Ok(None)
    }

    /// Rows rise by operand without zeros, the unbounded cell has none, and every patch steps by its multiplicity.
    pub fn check(&self, cells: &Cells) -> std::result::Result<(), String> {
        self.rows.check()?;
        if self.rows.len() != cells.cell_count || !self.rows.row(CellId(0)).is_empty() {
            return Err("winding: lengths differ, or the outside is not 0".into());
        }
        let bad = |row: &[Multiplicity]| row.windows(2).any(|w| w[0].0 >= w[1].0) || row.iter().any(|m| m.1 == 0);
        if self.rows.rows().any(bad) {
            return Err("a row of winding numbers is not sorted or has a zero".into());
        }
        match self.contradiction(cells).map_err(|e| e.message)? {
            None => Ok(()),
            Some(p) => Err(format!("winding numbers do not step by the multiplicity of patch {}", p.0)),
        }
    }
}

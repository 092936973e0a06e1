//! Booleans: which cells are inside, and the boundary between inside and outside.
//!
//! A point is inside an operand where its winding number there is positive; a selection says for each cell whether it is inside. The faces
//! with inside behind and outside before them, or the other way round, are the result, turned so that their normals point outward. Faces that divide
//! nothing have no cells and are never part of it. So the result is solid: its faces are faces of the arrangement, which meet in common
//! vertices and edges only and are all different, and around every edge inside and outside alternate.
//!
//! The unbounded cell must be outside: what is not bounded has no boundary mesh that tells so.
//!
//! Cost: linear in cells (times the expression) and faces; an arrangement answers any number of selections.

use super::{Arrangement, Birth, Multiplicity};
use crate::base::expression::Expression;
use crate::base::{CellId, Error, FaceId, OperandId, Result, Status, VertexId};

/// What is to be inside.
pub enum Selection<'a> {
    /// In any operand. Of one operand this resolves it: what its surface winds around in the positive sense.
    Union,
    /// In all operands (of no operands: nothing).
    Intersection,
    /// In the first operand and in no other one.
    Difference,
    /// In an odd number of operands.
    SymmetricDifference,
    /// In at least so many operands, one or more.
    AtLeast(u32),
    /// Where all winding numbers have a positive sum: in the mesh that all operands are together.
    Resolve,
    /// Text as in [`parse`].
    Expression(&'a str),
    /// One entry for each cell.
    Table(&'a [bool]),
    /// Asked for each cell, rising, with the winding number of every operand.
    Callback(&'a mut dyn FnMut(CellId, &[i32]) -> bool),
}

/// The boundary of what is inside: a solid mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extraction {
    /// The vertices of the arrangement that are corners, rising.
    pub vertices: Vec<VertexId>,
    /// Their coordinates, correctly rounded.
    pub coords: Vec<[f64; 3]>,
    /// Corners as places in `vertices`, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The face of the arrangement that each triangle is, rising.
    pub faces: Vec<FaceId>,
    /// The operand and the triangle, by its place in the operand's list, that each is a part of: the lowest one of those whose operand's
    /// winding number changes there.
    pub births: Vec<(OperandId, u32)>,
    /// Whether it runs against that triangle.
    pub flipped: Vec<bool>,
}

/// Parses an expression over operands: `(0 | 1) & !2`. A number is true inside that operand; `!` not, `&` and, `-` and not, `^` one but not
/// both, `|` or: `&` and `-` (as strong as one another, from left to right) before `^` before `|`; brackets; `true`, `false`.
///
/// Errors: `BadArgument` with the place of the first character that does not fit, or the number of an operand that there is not.
pub fn parse(text: &str, operand_count: usize) -> Result<Expression<OperandId>> {
    Expression::parse(text, "an operand", |rest| {
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        if digits == 0 {
            return Ok(None);
        }
        match rest[..digits].parse::<usize>() {
            Ok(i) if i < operand_count => Ok(Some((OperandId::of(i), digits))),
            _ => Err((0, "there is no such operand")),
        }
    })
}

/// Which cells a selection takes. Errors: `BadArgument` for a bad expression, a table of another length, or where the unbounded cell (number 0)
/// would be inside.
pub fn choose(a: &Arrangement, selection: Selection) -> Result<Vec<bool>> {
    let operands = a.operand_count();
    let positive = |row: &[Multiplicity]| row.iter().filter(|w| w.1 > 0).count();
    let rows = || a.winding.rows.rows();
    let inside: Vec<bool> = match selection {
        Selection::Union => rows().map(|row| positive(row) > 0).collect(),
        Selection::Intersection => rows().map(|row| operands > 0 && positive(row) == operands).collect(),
        Selection::Difference => {
            rows().map(|row| row.first().is_some_and(|w| w.0.at() == 0 && w.1 > 0) && positive(row) == 1).collect()
        }
        Selection::SymmetricDifference => rows().map(|row| positive(row) % 2 == 1).collect(),
        Selection::AtLeast(k) => rows().map(|row| positive(row) >= k as usize).collect(),
        Selection::Resolve => rows().map(|row| row.iter().map(|w| i64::from(w.1)).sum::<i64>() > 0).collect(),
        Selection::Expression(text) => {
            let expression = parse(text, operands)?;
            let mut stack = Vec::new();
            let mut value = |row: &[Multiplicity]| {
                let inside = |i: OperandId| row.binary_search_by_key(&i, |w| w.0).is_ok_and(|at| row[at].1 > 0);
                expression.evaluate(inside, &mut stack)
            };
            rows().map(&mut value).collect()
        }
        Selection::Table(table) if table.len() == a.cell_count() => table.to_vec(),
        Selection::Table(table) => {
            let message = format!("a table of {} entries for {} cells", table.len(), a.cell_count());
            return Err(Error::new(Status::BadArgument, message));
        }
        Selection::Callback(ask) => {
            let mut dense = vec![0; operands];
            let mut answer = |c: usize, row: &[Multiplicity]| {
                row.iter().for_each(|w| dense[w.0.at()] = w.1);
                let inside = ask(CellId::of(c), &dense);
                row.iter().for_each(|w| dense[w.0.at()] = 0);
                inside
            };
            rows().enumerate().map(|(c, row)| answer(c, row)).collect()
        }
    };
    match inside.first() {
        Some(true) => Err(Error::new(
            Status::BadArgument,
            "the selection takes in the unbounded cell, where all winding numbers are 0: the result has no end",
        )),
        _ => Ok(inside),
    }
}

/// The boundary of the cells that are inside (one entry for each cell, the unbounded one false; see [`choose`]).
pub fn extract(a: &Arrangement, inside: &[bool]) -> Result<Extraction> {
    if inside.len() != a.cell_count() || inside.first() == Some(&true) {
        return Err(Error::new(Status::BadArgument, "a table of cells with one entry each is wanted, the first false"));
    }
    let mut out = Extraction::default();
    let resolved = &a.resolved;
    let mut shared = 0;
    let mut number = vec![u32::MAX; a.vertex_count()];
    for (f, sides) in a.cells.of.chunks_exact(2).enumerate() {
        // Only faces that divide have cells; the two are different ones there.
        let flipped = match sides {
            [back, _] if back.is_none() => continue,
            [back, front] => match (inside[back.at()], inside[front.at()]) {
                (true, false) => false,
                (false, true) => true,
                _ => continue,
            },
            _ => continue,
        };
        let face = FaceId::of(f);
        while resolved.shared.get(shared).is_some_and(|&s| s < face) {
            shared += 1;
        }
        let [p, q, r] = resolved.faces[f];
        let corners = if flipped { [p, r, q] } else { [p, q, r] };
        corners.iter().for_each(|v| number[v.at()] = 0);
        let birth = if resolved.shared.get(shared) == Some(&face) {
            let net = a.cells.multiplicity.row(a.cells.patch[f]);
            let counts = |b: &&Birth| net.binary_search_by_key(&resolved.soup.operand(b.triangle), |m| m.0).is_ok();
            resolved.births.row(shared).iter().find(counts).copied()
        } else {
            None
        };
        let birth = birth.unwrap_or(Birth { triangle: resolved.support[f], same: true });
        out.triangles.push(corners.map(|v| v.0));
        out.faces.push(face);
        out.births.push((resolved.soup.operand(birth.triangle), resolved.soup.place(birth.triangle)));
        out.flipped.push(flipped == birth.same);
    }
    for (v, n) in number.iter_mut().enumerate().filter(|(_, n)| **n == 0) {
        *n = out.vertices.len() as u32;
        out.vertices.push(VertexId::of(v));
        out.coords.push(a.coords(VertexId::of(v)));
    }
    out.triangles.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
    Ok(out)
}

//! Solids made of regions: which regions, by an expression, a table or a function; and the boundary of their union.
//!
//! A region is in or out as a whole. The boundary is made of those polygons that have a chosen region on one side and another on the other; faces between two
//! chosen regions vanish. Loops run counterclockwise seen from outside the solid. Where the solid reaches the domain's boundary its own boundary is
//! open; elsewhere it is closed: around every edge inside the domain chosen and other wedges alternate.
//!
//! Expressions are text: `(0 & !1) | 2`. A number is true where that function is positive (of an interface: where it is the material); `-k` where function k
//! is negative, `=k` where it is zero; `!` not, `&` and, `a - b` and not, `^` one but not both, `|` or, in this order of strength; brackets; `true`, `false`.
//!
//! Cost: linear in the polygons; choosing, in regions times the expression.

use super::data::Network;
use super::simplex::Kind;
use super::topology::Topology;
use crate::base::expression::Expression;
use crate::base::{Csr, Error, FunctionId, PolygonId, RegionId, Result, Status, VertexId};
use crate::exact::Sign;

/// What is to be chosen.
pub enum Choice<'a> {
    /// Text, as told above.
    Expression(&'a str),
    /// One entry for each region.
    Table(&'a [bool]),
    /// Asked for each region, rising.
    Callback(&'a mut dyn FnMut(RegionId) -> bool),
}

/// The boundary of a union of regions, as an oriented mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundary {
    /// Vertices of the network, rising.
    pub vertices: Vec<VertexId>,
    /// Convex loops of positions in `vertices`, counterclockwise seen from outside.
    pub polygons: Csr<u32>,
    /// The polygon of the network that each comes from, rising (several times where it was triangulated).
    pub births: Vec<PolygonId>,
    /// Whether it runs against that polygon.
    pub flipped: Vec<bool>,
}

/// A function that has this sign (or is, or is not, the material).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Has(FunctionId, Sign);

/// Parses an expression over the signs of functions.
///
/// Errors: `BadArgument` with the place of the first character that does not fit, or the number of a function that there is not.
pub fn parse(text: &str, function_count: usize) -> Result<Expression<Has>> {
    Expression::parse(text, "a function", |rest| {
        let sign = match rest.as_bytes().first() {
            Some(b'-') => Sign::Negative,
            Some(b'=') => Sign::Zero,
            Some(b'0'..=b'9') => Sign::Positive,
            _ => return Ok(None),
        };
        let start = (sign != Sign::Positive) as usize;
        let digits = rest[start..].bytes().take_while(u8::is_ascii_digit).count();
        match rest[start..start + digits].parse::<usize>() {
            Ok(f) if f < function_count => Ok(Some((Has(FunctionId::of(f), sign), start + digits))),
            Err(_) if digits == 0 => Err((start, "a number of a function is expected")),
            _ => Err((start, "there is no such function")),
        }
    })
}

/// Which regions a choice takes. Errors: `BadArgument` for a bad expression or a table of another length.
pub fn choose(network: &Network, topology: &Topology, choice: Choice) -> Result<Vec<bool>> {
    let regions = &topology.regions;
    match choice {
        Choice::Table(table) if table.len() == regions.len() => Ok(table.to_vec()),
        Choice::Table(table) => {
            let message = format!("a table of {} entries for {} regions", table.len(), regions.len());
            Err(Error::new(Status::BadArgument, message))
        }
        Choice::Callback(chosen) => Ok((0..regions.len()).map(|r| chosen(RegionId::of(r))).collect()),
        Choice::Expression(text) => {
            let expression = parse(text, network.function_count)?;
            let mut stack = Vec::new();
            let value = |r: usize| match network.kind {
                Kind::Arrangement => {
                    let signs = regions.signs_of(RegionId::of(r));
                    expression.evaluate(|Has(f, sign)| signs[f.at()] == sign, &mut stack)
                }
                Kind::Interface => {
                    let material = regions.materials[r];
                    let sign = |f: FunctionId| if f == material { Sign::Positive } else { Sign::Negative };
                    expression.evaluate(|Has(f, wanted)| sign(f) == wanted, &mut stack)
                }
            };
            Ok((0..regions.len()).map(value).collect())
        }
    }
}

/// The boundary of the union of the chosen regions, optionally in triangles: fans around the lowest vertex of each polygon.
pub fn boundary(network: &Network, topology: &Topology, chosen: &[bool], triangles: bool) -> Boundary {
    let mut out = Boundary::default();
    // Of each side of a patch.
    let inside: Vec<bool> = topology.shells.of.iter().map(|s| chosen[topology.regions.of_shell[s.at()].at()]).collect();
    let mut number = vec![u32::MAX; network.vertex_count()];
    let mut fan = Vec::new();
    for (p, corners) in network.polygons.rows().enumerate() {
        let p = PolygonId::of(p);
        let front = topology.patches.side(p, true);
        // The normal of the boundary points out of the solid.
        let flipped = match (inside[front.at()], inside[front.other().at()]) {
            (false, true) => false,
            (true, false) => true,
            _ => continue,
        };
        corners.iter().for_each(|v| number[v.at()] = 0);
        let loops = if triangles && network.dim == 3 {
            fan.clear();
            triangulate(corners, &mut fan);
            fan.chunks_exact(3)
        } else {
            corners.chunks_exact(corners.len())
        };
        for corners in loops {
            let at = out.polygons.items.len();
            out.polygons.items.extend(corners.iter().map(|v| v.0));
            if flipped {
                // The first corner stays first.
                let first = (network.dim == 3) as usize;
                out.polygons.items[at + first..].reverse();
            }
            out.polygons.end_row();
            out.births.push(p);
            out.flipped.push(flipped);
        }
    }
    for (v, n) in number.iter_mut().enumerate().filter(|(_, n)| **n == 0) {
        *n = out.vertices.len() as u32;
        out.vertices.push(VertexId::of(v));
    }
    out.polygons.items.iter_mut().for_each(|v| *v = number[*v as usize]);
    out
}

/// A convex polygon as a fan of triangles around its lowest vertex, in its own direction.
pub fn triangulate(corners: &[VertexId], out: &mut Vec<VertexId>) {
    let n = corners.len();
    let first = (0..n).min_by_key(|&k| corners[k]).unwrap_or(0);
    let corner = |k: usize| corners[(first + k) % n];
    for k in 2..n {
        out.extend([corner(0), corner(k - 1), corner(k)]);
    }
}

/// All polygons of the network as triangles: fans around the lowest vertex of each, and the polygon of each triangle. (In two dimensions there are none.)
pub fn triangles(network: &Network) -> (Vec<VertexId>, Vec<PolygonId>) {
    let count: usize = network.polygons.rows().map(|row| row.len().saturating_sub(2)).sum();
    let (mut corners, mut births) = (Vec::with_capacity(3 * count), Vec::with_capacity(count));
    for (p, row) in network.polygons.rows().enumerate() {
        triangulate(row, &mut corners);
        births.resize(corners.len() / 3, PolygonId::of(p));
    }
    (corners, births)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions() {
        let value = |text: &str, signs: [i8; 3]| {
            let sign = |f: FunctionId| Sign::of(signs[f.at()] as f64);
            parse(text, 3).unwrap().evaluate(|Has(f, wanted)| sign(f) == wanted, &mut Vec::new())
        };
        for bits in 0..8 {
            let signs = [0, 1, 2].map(|k| if bits >> k & 1 == 1 { 1 } else { -1 });
            let [a, b, c] = signs.map(|s| s > 0);
            assert_eq!(value("(0 & !1) | 2", signs), (a & !b) | c);
            assert_eq!(value("0|1&2", signs), a | (b & c));
            assert_eq!(value("0^1&2|!!0", signs), (a ^ (b & c)) | a);
            assert_eq!(value("!(0|1)&true", signs), !(a | b));
            assert_eq!(value("-0 & (false | 2)", signs), !a & c);
        }
        assert!(value("=1 & !1 & !-1", [1, 0, 1]));
        assert!(value("0 - 1 --2", [1, -1, 1]) && !value("0-1-2", [1, -1, 1]));
        for (text, place) in
            [("", 1), ("0 &", 4), ("0 1", 3), ("(0", 3), ("0)", 2), ("3", 1), ("x", 1), ("& 0", 1), ("-", 2), ("()", 2)]
        {
            let error = parse(text, 3).unwrap_err();
            assert!(error.message.starts_with(&format!("expression, character {place}:")), "{text}: {}", error.message);
        }
        assert!(parse("é", 3).is_err());
        assert!(parse(&"9".repeat(60), 3).is_err());
    }
}

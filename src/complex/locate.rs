//! First hit of a ray in a planar subdivision: from a point towards −x, turned a little towards −y (direction (−1, −ε)).
//! A hole loop is joined to the loop that its lowest vertex sees first; a point is located in a face the same way.
//!
//! All decisions are exact comparisons of symbolic points, through [`PlanarPoints`]. The perturbation puts vertices at the
//! ray's height above it: a piece is hit when its lower end is strictly below the ray's height and its upper end is
//! not. Pieces do not cross, so of two hit pieces the nearer is told by an end of one against the line of the other.
//!
//! Cost: pieces are bucketed by strips of height when there are many queries; a query then looks at its strip alone.

use crate::base::{Csr, VertexId};
use crate::exact::Sign;
use std::cmp::Ordering;

/// Exact comparisons of the subdivision's vertices, in the projection in which it is seen.
pub trait PlanarPoints: Sync {
    /// Orders two vertices by height (the projection's second axis).
    fn compare_height(&self, a: VertexId, b: VertexId) -> Ordering;
    /// Sign of the turn a → b → c.
    fn turn(&self, a: VertexId, b: VertexId, c: VertexId) -> Sign;
    /// The correctly rounded height: monotone, so it can exclude pieces.
    fn rounded_height(&self, v: VertexId) -> f64;
}

/// The point where a ray starts.
pub trait RayStart {
    /// A vertex's height against the start's.
    fn compare_height(&self, v: VertexId) -> Ordering;
    /// Sign of the turn a → b → start.
    fn turn(&self, a: VertexId, b: VertexId) -> Sign;
    fn rounded_height(&self) -> f64;
}

/// Pieces in strips of height.
pub struct Strips {
    low: f64,
    scale: f64,
    pieces: Csr<u32>,
}

impl Strips {
    pub fn new(pieces: &[[VertexId; 2]], points: &impl PlanarPoints, queries: usize) -> Self {
        let heights = |p: &[VertexId; 2]| p.map(|v| points.rounded_height(v));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for h in pieces.iter().flat_map(heights) {
            (low, high) = (low.min(h), high.max(h));
        }
        let count = if queries < 4 { 1 } else { (pieces.len() / 4).clamp(1, 4096) };
        // An infinite or zero extent puts all pieces in one strip: slow, never wrong.
        let scale = count as f64 / (high - low);
        let mut strips = Strips { low, scale: if scale.is_finite() { scale } else { 0.0 }, pieces: Csr::default() };
        let rows = pieces.iter().enumerate().flat_map(|(i, p)| {
            let [a, b] = heights(p).map(|h| strips.strip(h, count));
            (a.min(b)..=a.max(b)).map(move |s| (s, i as u32))
        });
        strips.pieces = Csr::from_pairs(count, rows);
        strips
    }

    fn strip(&self, height: f64, count: usize) -> usize {
        (((height - self.low) * self.scale) as usize).min(count - 1)
    }

    /// The half-edge whose left side the ray meets first; `None` if nothing is hit. A piece through the start itself is passed.
    pub fn first_hit(
        &self,
        pieces: &[[VertexId; 2]],
        points: &impl PlanarPoints,
        start: &impl RayStart,
    ) -> Option<u32> {
        let height = start.rounded_height();
        let mut best: Option<(u32, [VertexId; 2])> = None;
        for &i in self.pieces.row(self.strip(height, self.pieces.len())) {
            let [a, b] = pieces[i as usize];
            let (ha, hb) = (points.rounded_height(a), points.rounded_height(b));
            if (ha > height && hb > height) || (ha < height && hb < height) {
                continue;
            }
            let above = |v: VertexId| start.compare_height(v) != Ordering::Less;
            let (low, high, half_edge) = match (above(a), above(b)) {
                // The start is on the right of the piece upwards: on the left of the half-edge downwards.
                (false, true) => (a, b, 2 * i + 1),
                (true, false) => (b, a, 2 * i),
                _ => continue,
            };
            if start.turn(low, high) != Sign::Negative {
                continue;
            }
            if best.is_none_or(|(_, other)| right_of(points, [low, high], other)) {
                best = Some((half_edge, [low, high]));
            }
        }
        best.map(|(half_edge, _)| half_edge)
    }
}

/// Whether piece `a` is right of piece `b` where both pass just below one height; each is given lower end first.
fn right_of(points: &impl PlanarPoints, a: [VertexId; 2], b: [VertexId; 2]) -> bool {
    let by_lower = if points.compare_height(a[0], b[0]) != Ordering::Less {
        points.turn(b[0], b[1], a[0])
    } else {
        -points.turn(a[0], a[1], b[0])
    };
    if by_lower != Sign::Zero {
        return by_lower == Sign::Negative;
    }
    // They start at one vertex: the upper end that is lower decides.
    if points.compare_height(a[1], b[1]) != Ordering::Greater {
        points.turn(b[0], b[1], a[1]) == Sign::Negative
    } else {
        points.turn(a[0], a[1], b[1]) == Sign::Positive
    }
}

//! Ear clipping of a weakly simple polygon, for faces that are not convex.
//!
//! A corner is an ear if it turns strictly left and no corner that does not (reflex, straight, the tip of a slit) lies
//! in its closed triangle, those at its own three vertices apart. Closed, because a vertex on the new diagonal would be left
//! behind as a T-junction; so no triangle is ever degenerate and every vertex is used.
//! Why vertices of the same id may be ignored: the open triangle at a left turn is face, so no edge of the boundary
//! enters it without ending in it.
//!
//! Ears are taken in rounds from the polygon's first corner, the neighbours of a clipped corner waiting for the next round:
//! about half of a convex chain goes each round and triangles stay compact. The ear test looks up the obstacles in a
//! grid over the *rounded* coordinates: rounding is monotone, so a vertex in the exact triangle is in the rounded
//! bounding box. In each row of the grid only the columns that the triangle meets are visited.
//! Cost: n tests; n^1.5 visits for the thin fans around a round hole, near n log n otherwise.

use super::data::Complex;
use super::projection::{Projection, turn};
use crate::base::VertexId;
use crate::exact::Sign;

/// Below this, every obstacle is tested against the bounding box: no grid is made.
const SMALL: usize = 48;
const NONE: u32 = u32::MAX;

/// Buffers reused from face to face.
#[derive(Default)]
pub struct EarScratch {
    next: Vec<u32>,
    prev: Vec<u32>,
    /// Corners that do not turn strictly left and are still there.
    obstacle: Vec<bool>,
    gone: Vec<bool>,
    queue: std::collections::VecDeque<(u32, u32)>,
    /// A queue entry counts only if it carries its corner's newest stamp.
    stamp: Vec<u32>,
    obstacles: Vec<u32>,
    /// What was last found in the way of each corner: it mostly still is (a corner of the outline sees the same hole
    /// again and again while its neighbours are clipped).
    blocker: Vec<u32>,
    grid: Grid,
}

#[derive(Default)]
struct Grid {
    columns: usize,
    rows: usize,
    low: [f64; 2],
    scale: [f64; 2],
    /// Triangles may be followed row by row: coordinates are fine enough against the cells.
    fine: bool,
    offsets: Vec<u32>,
    items: Vec<u32>,
}

struct Face<'a> {
    c: &'a Complex,
    pr: Projection,
    polygon: &'a [VertexId],
}

impl Face<'_> {
    fn turn(&self, i: u32, j: u32, k: u32) -> Sign {
        turn(self.c, self.pr, self.polygon[i as usize], self.polygon[j as usize], self.polygon[k as usize])
    }
    fn xy(&self, i: u32) -> [f64; 2] {
        let p = &self.c.coords[self.polygon[i as usize].at()];
        [p[self.pr.ax], p[self.pr.ay]]
    }
    /// Whether corner `z` lies in the closed triangle of the left turn i, j, k, and at none of its vertices.
    fn blocks(&self, z: u32, [i, j, k]: [u32; 3], [low, high]: [[f64; 2]; 2]) -> bool {
        let p = self.xy(z);
        if p[0] < low[0] || p[0] > high[0] || p[1] < low[1] || p[1] > high[1] {
            return false;
        }
        let v = self.polygon[z as usize];
        if [i, j, k].iter().any(|&t| self.polygon[t as usize] == v) {
            return false;
        }
        self.turn(i, j, z) != Sign::Negative
            && self.turn(j, k, z) != Sign::Negative
            && self.turn(k, i, z) != Sign::Negative
    }
}

/// Appends the triangles of a polygon (counter-clockwise in the projection) to `out`: two fewer than it has corners. An
/// error only where the polygon contradicts itself.
pub fn clip(
    c: &Complex,
    pr: Projection,
    polygon: &[VertexId],
    s: &mut EarScratch,
    out: &mut Vec<[VertexId; 3]>,
) -> Result<(), String> {
    let n = polygon.len() as u32;
    let face = Face { c, pr, polygon };
    s.next.clear();
    s.next.extend((0..n).map(|i| if i + 1 == n { 0 } else { i + 1 }));
    s.prev.clear();
    s.prev.extend((0..n).map(|i| if i == 0 { n - 1 } else { i - 1 }));
    s.gone.clear();
    s.gone.resize(n as usize, false);
    s.stamp.clear();
    s.stamp.resize(n as usize, 0);
    s.obstacle.clear();
    for i in 0..n {
        s.obstacle.push(face.turn(s.prev[i as usize], i, s.next[i as usize]) != Sign::Positive);
    }
    s.obstacles.clear();
    s.obstacles.extend((0..n).filter(|&i| s.obstacle[i as usize]));
    let gridded = s.obstacles.len() > SMALL;
    if gridded {
        s.grid.fill(&face, &s.obstacles);
    }
    s.blocker.clear();
    s.blocker.resize(n as usize, NONE);
    s.queue.clear();
    s.queue.extend((0..n).map(|i| (i, 0)));
    let (mut left, mut idle) = (n, false);
    while left > 3 {
        let Some((j, stamp)) = s.queue.pop_front() else {
            // Clipping elsewhere can free an ear that touched a vertex; once more round, and then it is an error.
            if idle {
                return Err("its boundary crosses itself".into());
            }
            idle = true;
            let stamp = &s.stamp;
            s.queue.extend((0..n).filter(|&i| !s.gone[i as usize]).map(|i| (i, stamp[i as usize])));
            continue;
        };
        let at = j as usize;
        if s.gone[at] || s.stamp[at] != stamp || s.obstacle[at] {
            continue;
        }
        let t = [s.prev[at], j, s.next[at]];
        let (a, b, d) = (face.xy(t[0]), face.xy(t[1]), face.xy(t[2]));
        let low = [a[0].min(b[0]).min(d[0]), a[1].min(b[1]).min(d[1])];
        let high = [a[0].max(b[0]).max(d[0]), a[1].max(b[1]).max(d[1])];
        let blocked = |z: u32| s.obstacle[z as usize] && face.blocks(z, t, [low, high]);
        if s.blocker[at] != NONE && blocked(s.blocker[at]) {
            continue;
        }
        let found = if gridded {
            s.grid.find([a, b, d], low, high, blocked)
        } else {
            s.obstacles.iter().copied().find(|&z| blocked(z))
        };
        if let Some(z) = found {
            s.blocker[at] = z;
            continue;
        }
        out.push(t.map(|i| polygon[i as usize]));
        (s.gone[at], s.obstacle[at]) = (true, false);
        (left, idle) = (left - 1, false);
        let (p, q) = (t[0], t[2]);
        s.next[p as usize] = q;
        s.prev[q as usize] = p;
        for i in [p, q] {
            let k = i as usize;
            s.obstacle[k] = s.obstacle[k] && face.turn(s.prev[k], i, s.next[k]) != Sign::Positive;
            s.stamp[k] += 1;
            s.queue.push_back((i, s.stamp[k]));
        }
    }
    // The rest, if the polygon was a polygon.
    let Some(i) = (0..n).find(|&i| !s.gone[i as usize]) else { return Ok(()) };
    let t = [s.prev[i as usize], i, s.next[i as usize]];
    if left == 3 && face.turn(t[0], t[1], t[2]) == Sign::Positive {
        out.push(t.map(|i| polygon[i as usize]));
        return Ok(());
    }
    Err("its boundary crosses itself".into())
}

impl Grid {
    fn fill(&mut self, face: &Face, obstacles: &[u32]) {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for &i in obstacles {
            let p = face.xy(i);
            for a in 0..2 {
                low[a] = low[a].min(p[a]);
                high[a] = high[a].max(p[a]);
            }
        }
        let side = (obstacles.len() as f64).sqrt().ceil().min(2048.0) as usize;
        (self.columns, self.rows, self.low) = (side, side, low);
        self.fine = true;
        for a in 0..2 {
            let size = high[a] - low[a];
            let scale = side as f64 / size;
            // One column if the extent is zero or beyond doubles: any monotone assignment will do.
            self.scale[a] = if scale.is_finite() && scale > 0.0 { scale } else { 0.0 };
            self.fine &= size > low[a].abs().max(high[a].abs()) * 1e-9 && size.is_finite() && self.scale[a] > 0.0;
        }
        let cells = self.columns * self.rows;
        self.offsets.clear();
        self.offsets.resize(cells + 1, 0);
        for &i in obstacles {
            let cell = self.cell(face.xy(i));
            self.offsets[cell + 1] += 1;
        }
        for k in 0..cells {
            self.offsets[k + 1] += self.offsets[k];
        }
        self.items.clear();
        self.items.resize(obstacles.len(), NONE);
        // Filled from the back, so that offsets end up as row starts again.
        for &i in obstacles.iter().rev() {
            let cell = self.cell(face.xy(i));
            self.offsets[cell + 1] -= 1;
            self.items[self.offsets[cell + 1] as usize] = i;
        }
        for k in 0..cells {
            self.offsets[k] = self.offsets[k + 1];
        }
        self.offsets[cells] = obstacles.len() as u32;
    }

    /// Monotone in x: what lies between two coordinates lies between their columns.
    fn place(&self, x: f64, a: usize) -> usize {
        let k = (x - self.low[a]) * self.scale[a];
        // A negative or undefined number goes to 0, a large one to the end.
        (k as usize).min(if a == 0 { self.columns } else { self.rows } - 1)
    }

    fn cell(&self, p: [f64; 2]) -> usize {
        self.place(p[1], 1) * self.columns + self.place(p[0], 0)
    }

    /// An item near the triangle that satisfies `blocked`.
    fn find(&self, t: [[f64; 2]; 3], low: [f64; 2], high: [f64; 2], blocked: impl Fn(u32) -> bool) -> Option<u32> {
        let (first, last) = (self.place(low[1], 1), self.place(high[1], 1));
        let (left, right) = (self.place(low[0], 0), self.place(high[0], 0));
        for row in first..=last {
            let (mut from, mut to) = (left, right);
            if self.fine && last > first + 1 {
                // The triangle between the row's bounds, widened by one row and one column: cells are larger than
                // any rounding of coordinates or of this arithmetic by many orders of magnitude.
                let bottom = self.low[1] + (row as f64 - 1.0) / self.scale[1];
                let top = self.low[1] + (row as f64 + 2.0) / self.scale[1];
                let (mut a, mut b) = (f64::INFINITY, f64::NEG_INFINITY);
                for k in 0..3 {
                    let (p, q) =
                        if t[k][1] <= t[(k + 1) % 3][1] { (t[k], t[(k + 1) % 3]) } else { (t[(k + 1) % 3], t[k]) };
                    if q[1] < bottom || p[1] > top {
                        continue;
                    }
                    let rise = q[1] - p[1];
                    // A side within few rows counts whole.
                    let x = |y: f64| {
                        if rise * self.scale[1] < 3.0 { None } else { Some(p[0] + (q[0] - p[0]) * ((y - p[1]) / rise)) }
                    };
                    for end in [(p, bottom, p[1] < bottom), (q, top, q[1] > top)] {
                        let values = match x(end.1) {
                            Some(x) if end.2 => [x, x],
                            Some(_) => [end.0[0], end.0[0]],
                            None => [p[0], q[0]],
                        };
                        for x in values {
                            (a, b) = (a.min(x), b.max(x));
                        }
                    }
                }
                if a > b {
                    continue;
                }
                from = from.max(self.place(a, 0).saturating_sub(1));
                to = to.min(self.place(b, 0) + 1);
            }
            if from > to {
                continue;
            }
            let r =
                self.offsets[row * self.columns + from] as usize..self.offsets[row * self.columns + to + 1] as usize;
            if let Some(&z) = self.items[r].iter().find(|&&z| blocked(z)) {
                return Some(z);
            }
        }
        None
    }
}

//! Constrained triangulation of a planar straight-line graph, exact: incremental, with located insertion, then the pieces one by one.
//!
//! Validity comes from exact turns alone. Delaunay is a preference (DESIGN §11): an edge is flipped where rounded coordinates see a vertex within the
//! other triangle's circle, but only in strictly convex quadrilaterals; a budget ends it. So walks are short and triangles fair, and
//! nothing hangs on the in-circle test.
//!
//! Invariant: all triangles turn strictly positive; their union is the start (one triangle, or a frame around everything); sides fit.
//! Degenerate cases: vertices on sides of the start and on one another's lines are insertions into an edge; nothing is collinear afterwards.
//! Pieces have no vertices inside and do not cross, so flips bring every piece in.
//! Cost: vertices are inserted along a space-filling curve, so n log n for the sort and nearly linear for the rest. A piece that is not there costs
//! up to the square of the sides that cross it: so the missing ones of a family, chords of parallel planes say, do not come one beside the other, where each
//! has to cross as much as the first, but far apart, and halve what is left to be crossed.

use crate::base::{Error, Watch};
use crate::exact::Sign;
use std::collections::VecDeque;

/// Vertices, and pieces, between two looks at the caller's wish to stop.
const OFTEN: usize = 32;
/// Sides that cross a piece, between two such looks.
const FLIPS: usize = 1 << 12;

/// No neighbour.
pub const NONE: u32 = u32::MAX;

/// What the triangulation knows of its vertices, which are numbers.
pub trait Vertices {
    /// Rounded coordinates in the plane, for preferences only.
    fn place(&self, v: u32) -> [f64; 2];
    /// The exact turn a → b → c.
    fn turn(&self, a: u32, b: u32, c: u32) -> Sign;
    /// The same where doubles tell.
    fn quick_turn(&self, a: u32, b: u32, c: u32) -> Option<Sign>;
    /// Whether a vertex comes before another one by its coordinates in the plane, exactly, the first one first.
    fn comes_before(&self, a: u32, b: u32) -> bool;
}

/// Triangles with their neighbours: side k joins corners k and k + 1.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    pub corners: Vec<[u32; 3]>,
    /// The triangle across each side, or `NONE`.
    pub across: Vec<[u32; 3]>,
    /// Bit k: side k is a piece.
    pub pieces: Vec<u8>,
    /// A triangle at each vertex.
    at: Vec<u32>,
    /// Flips that may still be made for fairness.
    budget: usize,
    stack: Vec<(u32, u32)>,
}

fn contradiction() -> Error {
    Error::inconsistent("a triangulation does not fit its graph")
}

/// Triangulates: `start` are triangles that cover all `count` vertices and fit one another, as in [`Triangulation`]; `order` the other vertices in
/// a good order of insertion; `pieces` edges that have to be there. Told to stop it returns any error.
pub fn triangulate(
    vertices: &impl Vertices,
    count: usize,
    start: (&[[u32; 3]], &[[u32; 3]]),
    order: &[u32],
    pieces: &[[u32; 2]],
    watch: &Watch,
) -> Result<Triangulation, Error> {
    let mut t = Triangulation {
        corners: start.0.to_vec(),
        across: start.1.to_vec(),
        pieces: vec![0; start.0.len()],
        at: vec![NONE; count],
        budget: 64 * count,
        stack: Vec::new(),
    };
    for (i, corners) in start.0.iter().enumerate() {
        corners.iter().for_each(|&v| t.at[v as usize] = i as u32);
    }
    let look = |i: usize| if i % OFTEN == OFTEN - 1 { watch.check() } else { Ok(()) };
    let mut last = 0;
    for (i, &v) in order.iter().enumerate() {
        look(i)?;
        last = t.insert(vertices, v, last)?;
    }
    let missing: Vec<[u32; 2]> = pieces.iter().filter(|p| !t.mark(p[0], p[1])).copied().collect();
    for (i, place) in halving(missing.len()).enumerate() {
        look(i)?;
        let [a, b] = missing[place];
        t.force(vertices, a, b, watch)?;
    }
    Ok(t)
}

/// All numbers below a count, each far from those before it.
fn halving(count: usize) -> impl Iterator<Item = usize> {
    let bits = count.next_power_of_two().ilog2();
    (0..1usize << bits)
        .map(move |i| i.reverse_bits().checked_shr(usize::BITS - bits).unwrap_or(0))
        .filter(move |i| *i < count)
}

/// Numbers of vertices along a space-filling curve.
pub fn curve_order(vertices: &impl Vertices, of: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut all: Vec<(u64, u32)> = of.map(|v| (0, v)).collect();
    let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &(_, v) in &all {
        let x = vertices.place(v);
        for i in 0..2 {
            lo[i] = lo[i].min(x[i]);
            hi[i] = hi[i].max(x[i]);
        }
    }
    let spread = |x: u64| -> u64 {
        let x = (x | x << 16) & 0x0000_ffff_0000_ffff;
        let x = (x | x << 8) & 0x00ff_00ff_00ff_00ff;
        let x = (x | x << 4) & 0x0f0f_0f0f_0f0f_0f0f;
        let x = (x | x << 2) & 0x3333_3333_3333_3333;
        (x | x << 1) & 0x5555_5555_5555_5555
    };
    for (code, v) in &mut all {
        let x = vertices.place(*v);
        let cell = |i: usize| (((x[i] - lo[i]) / (hi[i] - lo[i])) * 65535.0) as u64;
        *code = spread(cell(0).min(65535)) | spread(cell(1).min(65535)) << 1;
    }
    all.sort_unstable();
    all.into_iter().map(|(_, v)| v).collect()
}

impl Triangulation {
    /// No triangles yet, of so many vertices.
    pub fn empty(count: usize, triangles: usize) -> Self {
        Self {
            corners: Vec::with_capacity(triangles),
            across: Vec::with_capacity(triangles),
            pieces: Vec::with_capacity(triangles),
            at: vec![NONE; count],
            budget: 64 * count,
            stack: Vec::new(),
        }
    }

    /// Adds a triangle beside others: across each side the triangle and the side of it that are there; where there is none yet the side counts as a piece.
    /// Returns its number.
    pub fn join(&mut self, corners: [u32; 3], beyond: [(u32, u32); 3]) -> u32 {
        let t = self.corners.len() as u32;
        let mut pieces = 0;
        for (k, (n, side)) in beyond.into_iter().enumerate() {
            match n {
                NONE => pieces |= 1 << k,
                _ => self.across[n as usize][side as usize] = t,
            }
        }
        self.corners.push(corners);
        self.across.push(beyond.map(|(n, _)| n));
        self.pieces.push(pieces);
        t
    }

    #[inline(always)]
    fn side_of(&self, t: u32, neighbour: u32) -> usize {
        self.across[t as usize].iter().position(|&n| n == neighbour).unwrap_or(0)
    }

    /// Tells the neighbour across side k of t that it is t, not `was`.
    fn link(&mut self, t: u32, k: usize, was: u32) {
        let n = self.across[t as usize][k];
        if n != NONE {
            let back = self.side_of(n, was);
            self.across[n as usize][back] = t;
        }
    }

    fn set(&mut self, t: u32, corners: [u32; 3], across: [u32; 3], pieces: u8) {
        self.corners[t as usize] = corners;
        self.across[t as usize] = across;
        self.pieces[t as usize] = pieces;
        corners.iter().for_each(|&v| self.at[v as usize] = t);
    }

    fn add(&mut self) -> u32 {
        self.corners.push([0; 3]);
        self.across.push([NONE; 3]);
        self.pieces.push(0);
        self.corners.len() as u32 - 1
    }

    /// The triangle that holds a vertex, and the side that it is on, if on one.
    fn locate(&self, vertices: &impl Vertices, v: u32, from: u32) -> Result<(u32, Option<usize>), Error> {
        let look = |t: u32, came: u32| -> Result<(u32, Option<usize>), u32> {
            let corners = &self.corners[t as usize];
            let mut on = None;
            for k in 0..3 {
                if came != NONE && self.across[t as usize][k] == came {
                    continue;
                }
                match vertices.turn(corners[k], corners[(k + 1) % 3], v) {
                    Sign::Negative => return Err(self.across[t as usize][k]),
                    Sign::Zero => on = Some(k),
                    Sign::Positive => {}
                }
            }
            // (The side that it came through: v is strictly beyond it, seen from there.)
            Ok((t, on))
        };
        let (mut t, mut came) = (from, NONE);
        for _ in 0..self.corners.len() + 8 {
            match look(t, came) {
                Ok(found) => return Ok(found),
                Err(NONE) => return Err(contradiction()),
                Err(next) => (t, came) = (next, t),
            }
        }
        // A walk in a circle, which only triangulations far from Delaunay have.
        (0..self.corners.len() as u32).find_map(|t| look(t, NONE).ok()).ok_or_else(contradiction)
    }

    /// Inserts a vertex; a triangle at it.
    fn insert(&mut self, vertices: &impl Vertices, v: u32, from: u32) -> Result<u32, Error> {
        let (t, on) = self.locate(vertices, v, from)?;
        let Some(k) = on else {
            let ([a, b, c], [ab, bc, ca]) = (self.corners[t as usize], self.across[t as usize]);
            let (u, w) = (self.add(), self.add());
            self.set(t, [a, b, v], [ab, u, w], 0);
            self.set(u, [b, c, v], [bc, w, t], 0);
            self.set(w, [c, a, v], [ca, t, u], 0);
            self.link(u, 0, t);
            self.link(w, 0, t);
            self.fair(vertices, &[(t, 0), (u, 0), (w, 0)]);
            return Ok(self.at[v as usize]);
        };
        let n = self.across[t as usize][k];
        let halves = |s: &Self, t: u32, k: usize| {
            let c = |i: usize| s.corners[t as usize][(k + i) % 3];
            let x = |i: usize| s.across[t as usize][(k + i) % 3];
            ([c(0), c(1), c(2)], [x(1), x(2)])
        };
        let ([a, b, c], [bc, ca]) = halves(self, t, k);
        if v == a || v == b || v == c {
            return Err(contradiction());
        }
        let u = self.add();
        if n == NONE {
            self.set(t, [a, v, c], [NONE, u, ca], 0);
            self.set(u, [v, b, c], [NONE, bc, t], 0);
            self.link(u, 1, t);
            self.fair(vertices, &[(t, 2), (u, 1)]);
            return Ok(self.at[v as usize]);
        }
        let back = self.side_of(n, t);
        let ([_, _, d], [ad, db]) = halves(self, n, back);
        let w = self.add();
        // t: a v c, u: v b c; n: b v d, w: v a d.
        self.set(t, [a, v, c], [w, u, ca], 0);
        self.set(u, [v, b, c], [n, bc, t], 0);
        self.set(n, [b, v, d], [u, w, db], 0);
        self.set(w, [v, a, d], [t, ad, n], 0);
        self.link(u, 1, t);
        self.link(w, 1, n);
        self.fair(vertices, &[(t, 2), (u, 1), (n, 2), (w, 1)]);
        Ok(self.at[v as usize])
    }

    /// Whether the two triangles at a side form a strictly convex quadrilateral. Its corners: the side from a to b, c behind it, d beyond it.
    fn convex(&self, vertices: &impl Vertices, t: u32, k: usize) -> Option<[u32; 4]> {
        let n = self.across[t as usize][k];
        if n == NONE {
            return None;
        }
        let back = self.side_of(n, t);
        let c = |i: usize| self.corners[t as usize][(k + i) % 3];
        let (a, b, c, d) = (c(0), c(1), c(2), self.corners[n as usize][(back + 2) % 3]);
        let convex = vertices.turn(c, d, b) == Sign::Positive && vertices.turn(d, c, a) == Sign::Positive;
        convex.then_some([a, b, c, d])
    }

    /// Turns the side into the other diagonal: t becomes c a d with side 2 from d to c... and its neighbour d b c. Returns the neighbour.
    fn flip(&mut self, t: u32, k: usize) -> u32 {
        let n = self.across[t as usize][k];
        let back = self.side_of(n, t);
        let at = |x: &[u32; 3], i: usize| x[i % 3];
        let (ct, xt, cn, xn) =
            (self.corners[t as usize], self.across[t as usize], self.corners[n as usize], self.across[n as usize]);
        let (pt, pn) = (self.pieces[t as usize], self.pieces[n as usize]);
        let (a, b, c, d) = (at(&ct, k), at(&ct, k + 1), at(&ct, k + 2), at(&cn, back + 2));
        let (bc, ca, ad, db) = (at(&xt, k + 1), at(&xt, k + 2), at(&xn, back + 1), at(&xn, back + 2));
        let bit = |p: u8, i: usize, to: usize| (p >> (i % 3) & 1) << to;
        self.set(t, [c, a, d], [ca, ad, n], bit(pt, k + 2, 0) | bit(pn, back + 1, 1));
        self.set(n, [d, b, c], [db, bc, t], bit(pn, back + 2, 0) | bit(pt, k + 1, 1));
        self.link(t, 1, n);
        self.link(n, 1, t);
        n
    }

    /// Flips what rounded coordinates find unfair, from some sides on.
    pub fn fair(&mut self, vertices: &impl Vertices, sides: &[(u32, usize)]) {
        let mut stack = std::mem::take(&mut self.stack);
        stack.extend(sides.iter().map(|&(t, k)| (t, k as u32)));
        while let Some((t, k)) = stack.pop() {
            let k = k as usize;
            if self.budget == 0 || self.pieces[t as usize] >> k & 1 != 0 {
                continue;
            }
            let n = self.across[t as usize][k];
            if n == NONE {
                continue;
            }
            let back = self.side_of(n, t);
            let c = |i: usize| vertices.place(self.corners[t as usize][(k + i) % 3]);
            if !in_circle(c(0), c(1), c(2), vertices.place(self.corners[n as usize][(back + 2) % 3])) {
                continue;
            }
            if self.convex(vertices, t, k).is_none() {
                continue;
            }
            self.budget -= 1;
            let n = self.flip(t, k);
            stack.extend([(t, 1), (n, 0), (t, 0), (n, 1)]);
        }
        self.stack = stack;
    }

    /// The triangles at a vertex: calls `visit(triangle, corner)` until it answers.
    fn around<T>(&self, v: u32, mut visit: impl FnMut(u32, usize) -> Option<T>) -> Option<T> {
        let start = self.at[v as usize];
        let corner = |t: u32| self.corners[t as usize].iter().position(|&c| c == v).unwrap_or(0);
        // Counterclockwise, and if that ends at the border, the other way.
        let mut t = start;
        loop {
            let i = corner(t);
            if let Some(found) = visit(t, i) {
                return Some(found);
            }
            t = self.across[t as usize][(i + 2) % 3];
            if t == start {
                return None;
            }
            if t == NONE {
                break;
            }
        }
        let mut t = self.across[start as usize][corner(start)];
        while t != NONE {
            let i = corner(t);
            if let Some(found) = visit(t, i) {
                return Some(found);
            }
            t = self.across[t as usize][i];
        }
        None
    }

    /// The triangle and its side from a to b.
    fn side(&self, a: u32, b: u32) -> Option<(u32, usize)> {
        self.around(a, |t, i| (self.corners[t as usize][(i + 1) % 3] == b).then_some((t, i)))
    }

    fn mark(&mut self, a: u32, b: u32) -> bool {
        let mut found = false;
        for (a, b) in [(a, b), (b, a)] {
            if let Some((t, k)) = self.side(a, b) {
                self.pieces[t as usize] |= 1 << k;
                found = true;
            }
        }
        found
    }

    /// Brings a piece in: sides that cross it are flipped until none does (in some order that always works).
    fn force(&mut self, vertices: &impl Vertices, a: u32, b: u32, watch: &Watch) -> Result<(), Error> {
        if self.mark(a, b) {
            // Flips for another one have brought it in.
            return Ok(());
        }
        let exit = self.around(a, |t, i| {
            let (x, y) = (self.corners[t as usize][(i + 1) % 3], self.corners[t as usize][(i + 2) % 3]);
            (vertices.turn(a, x, b) == Sign::Positive && vertices.turn(a, b, y) == Sign::Positive)
                .then_some((t, (i + 1) % 3))
        });
        let Some((mut t, mut k)) = exit else { return Err(contradiction()) };
        let mut crossing = VecDeque::new();
        loop {
            if self.pieces[t as usize] >> k & 1 != 0 {
                return Err(contradiction());
            }
            crossing.push_back([self.corners[t as usize][k], self.corners[t as usize][(k + 1) % 3]]);
            let n = self.across[t as usize][k];
            if n == NONE || crossing.len() > self.corners.len() {
                return Err(contradiction());
            }
            let back = self.side_of(n, t);
            let d = self.corners[n as usize][(back + 2) % 3];
            if d == b {
                break;
            }
            // The side from x to y was crossed with x on the right: d replaces one of them.
            (t, k) = match vertices.turn(a, b, d) {
                Sign::Positive => (n, (back + 1) % 3),
                Sign::Negative => (n, (back + 2) % 3),
                Sign::Zero => return Err(contradiction()),
            };
        }
        let mut patience = 8 * (crossing.len() + 4) * (crossing.len() + 4);
        while let Some([x, y]) = crossing.pop_front() {
            let Some((t, k)) = self.side(x, y) else { return Err(contradiction()) };
            if patience == 0 {
                return Err(contradiction());
            }
            patience -= 1;
            if patience % FLIPS == 0 {
                watch.check()?;
            }
            let Some([_, _, c, d]) = self.convex(vertices, t, k) else {
                crossing.push_back([x, y]);
                continue;
            };
            self.flip(t, k);
            let ends = |v: u32| v == a || v == b;
            if !ends(c) && !ends(d) && vertices.turn(a, b, c) != vertices.turn(a, b, d) {
                crossing.push_back([c, d]);
            }
        }
        if self.mark(a, b) { Ok(()) } else { Err(contradiction()) }
    }

    /// Strictly positive triangles whose sides fit.
    pub fn check(&self, vertices: &impl Vertices) -> Result<(), String> {
        for (t, corners) in self.corners.iter().enumerate() {
            if vertices.turn(corners[0], corners[1], corners[2]) != Sign::Positive {
                return Err(format!("triangle {t} does not turn to the left"));
            }
            for k in 0..3 {
                let n = self.across[t][k];
                if n == NONE {
                    continue;
                }
                let back = self.side_of(n, t as u32);
                let other = &self.corners[n as usize];
                let fits = other[back] == corners[(k + 1) % 3] && other[(back + 1) % 3] == corners[k];
                if !fits || self.across[n as usize][back] != t as u32 {
                    return Err(format!("side {k} of triangle {t} does not fit its neighbour"));
                }
                if (self.pieces[t] >> k & 1) != (self.pieces[n as usize] >> back & 1) {
                    return Err(format!("side {k} of triangle {t} is a piece on one side only"));
                }
            }
        }
        Ok(())
    }
}

/// Whether d lies within the circle through a, b, c by a clear margin. A preference.
fn in_circle(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let row = |p: [f64; 2]| {
        let (x, y) = (p[0] - d[0], p[1] - d[1]);
        [x, y, x * x + y * y]
    };
    let (a, b, c) = (row(a), row(b), row(c));
    let minors = [b[0] * c[1] - b[1] * c[0], c[0] * a[1] - c[1] * a[0], a[0] * b[1] - a[1] * b[0]];
    let det = a[2] * minors[0] + b[2] * minors[1] + c[2] * minors[2];
    let size = a[2] * minors[0].abs() + b[2] * minors[1].abs() + c[2] * minors[2].abs();
    det > 1e-10 * size
}

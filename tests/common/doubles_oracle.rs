//! Whether triangles over doubles are a solid, and which one, found by means that share nothing with the library: doubles with bounds, whole
//! numbers where these cannot tell, a sweep, and columns of triangles.
#![allow(dead_code)]

use super::common::Soup;
use rug::{Integer, Rational};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// What is known of points: where they are, and whether that is in the solid.
pub type Probes = Vec<([f64; 3], bool)>;

/// Distinct places, no triangle without area or twice, each edge walked as often both ways, no two triangles with more in common than what they share
/// by index, and around each probe winding number 1 or 0 as it is inside or not.
pub fn judge(s: &Soup, probes: &Probes) -> Result<(), String> {
    let places: BTreeSet<[u64; 3]> = s.vertices.iter().map(|x| x.map(|c| (c + 0.0).to_bits())).collect();
    if places.len() != s.vertices.len() {
        return Err("two vertices at one place".into());
    }
    let mut edges: BTreeMap<[i32; 2], i32> = BTreeMap::new();
    let mut different = BTreeSet::new();
    let exact = Exact::new(&s.vertices);
    for (i, t) in s.triangles.iter().enumerate() {
        for k in 0..3 {
            let (from, to) = (t[k], t[(k + 1) % 3]);
            *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
        let mut corners = *t;
        corners.sort_unstable();
        if !different.insert(corners) {
            return Err(format!("triangle {i} is there twice"));
        }
        if (0..3).all(|axis| exact.turn(t.map(|v| v as usize), axis).is_eq()) {
            return Err(format!("triangle {i} has no area"));
        }
    }
    if let Some((ends, _)) = edges.iter().find(|e| *e.1 != 0) {
        return Err(format!("the edge {ends:?} is not balanced"));
    }
    contacts(s, &exact)?;
    let columns = Columns::new(s);
    for (p, inside) in probes {
        let w = columns.winding(p)?;
        if w != *inside as i32 {
            return Err(format!("{p:?} is wound around {w} times, and inside: {inside}"));
        }
    }
    Ok(())
}

/// No two triangles meet wrongly. Pairs by a sweep along x.
fn contacts(s: &Soup, exact: &Exact) -> Result<(), String> {
    let boxes: Vec<[[f64; 2]; 3]> = s.triangles.iter().map(|t| box_of(s, t)).collect();
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_unstable_by(|&a, &b| boxes[a][0][0].total_cmp(&boxes[b][0][0]));
    let mut open: Vec<usize> = Vec::new();
    for &t in &order {
        open.retain(|&o| boxes[o][0][1] >= boxes[t][0][0]);
        for &o in &open {
            if (1..3).any(|i| boxes[o][i][1] < boxes[t][i][0] || boxes[t][i][1] < boxes[o][i][0]) {
                continue;
            }
            let [f, g] = [o, t].map(|i| s.triangles[i].map(|v| v as usize));
            if exact.meet_wrongly(&f, &g) {
                return Err(format!("triangles {o} and {t} meet"));
            }
        }
        open.push(t);
    }
    Ok(())
}

fn box_of(s: &Soup, t: &[i32; 3]) -> [[f64; 2]; 3] {
    std::array::from_fn(|i| {
        let x = t.map(|v| s.vertices[v as usize][i]);
        [x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2])]
    })
}

/// Triangles by squares of y and z, to be met by rays along x.
struct Columns<'a> {
    s: &'a Soup,
    low: [f64; 2],
    step: [f64; 2],
    side: usize,
    rows: Vec<Vec<usize>>,
}

impl<'a> Columns<'a> {
    fn new(s: &'a Soup) -> Self {
        let side = (s.triangles.len() as f64).sqrt() as usize + 1;
        let end = |i: usize, f: fn(f64, f64) -> f64, start: f64| s.vertices.iter().fold(start, |m, x| f(m, x[i]));
        let low = [1, 2].map(|i| end(i, f64::min, f64::INFINITY));
        let high = [1, 2].map(|i| end(i, f64::max, f64::NEG_INFINITY));
        let step = [0, 1].map(|i| (high[i] - low[i]) / side as f64);
        let mut columns = Self { s, low, step, side, rows: vec![Vec::new(); side * side] };
        for (t, corners) in s.triangles.iter().enumerate() {
            let b = box_of(s, corners);
            let [ys, zs] = [0, 1].map(|i| columns.place(b[i + 1][0], i)..=columns.place(b[i + 1][1], i));
            for y in ys {
                zs.clone().for_each(|z| columns.rows[y * side + z].push(t));
            }
        }
        columns
    }

    /// Never falls as x rises.
    fn place(&self, x: f64, i: usize) -> usize {
        (((x - self.low[i]) / self.step[i]).max(0.0) as usize).min(self.side - 1)
    }

    /// By the triangles that a ray towards +x meets, the point a little in front of where it is in z.
    fn winding(&self, p: &[f64; 3]) -> Result<i32, String> {
        if self.s.triangles.is_empty() {
            return Ok(0);
        }
        let mut sum = 0;
        for &t in &self.rows[self.place(p[1], 0) * self.side + self.place(p[2], 1)] {
            let c = self.s.triangles[t].map(|v| &self.s.vertices[v as usize]);
            let mut turns = 0;
            for k in 0..3 {
                let (a, b) = (c[k], c[(k + 1) % 3]);
                let (up, down) = (a[1] <= p[1] && p[1] < b[1], b[1] <= p[1] && p[1] < a[1]);
                if up || down {
                    let (low, high) = if up { (a, b) } else { (b, a) };
                    if turn([low, high, p], 0).unwrap_or_else(|| whole_turn(&whole(&[low, high, p]), 0)).is_gt() {
                        turns += if up { 1 } else { -1 };
                    }
                }
            }
            // Seen against the ray a triangle that turns to the left has its front at larger x: it is met if the point is behind it.
            let of = || side([c[0], c[1], c[2], p]).unwrap_or_else(|| whole_side(&whole(&[c[0], c[1], c[2], p])));
            match (turns, if turns == 0 { Ordering::Less } else { of() }) {
                (0, _) => {}
                (_, Ordering::Equal) => return Err(format!("{p:?} is on triangle {t}")),
                (n, of) => sum += if (of == Ordering::Less) == (n > 0) { n } else { 0 },
            }
        }
        Ok(sum)
    }
}

/// Doubles, and whole numbers that are as many times as large.
struct Exact<'a> {
    near: &'a [[f64; 3]],
    whole: Vec<[Integer; 3]>,
}

impl<'a> Exact<'a> {
    fn new(near: &'a [[f64; 3]]) -> Self {
        Self { near, whole: whole(&near.iter().collect::<Vec<_>>()) }
    }

    /// Seen along an axis.
    fn turn(&self, t: [usize; 3], axis: usize) -> Ordering {
        turn(t.map(|v| &self.near[v]), axis).unwrap_or_else(|| whole_turn(&t.map(|v| &self.whole[v]), axis))
    }

    /// `Greater`: from the last corner the others turn to the left.
    fn side(&self, t: [usize; 4]) -> Ordering {
        side(t.map(|v| &self.near[v])).unwrap_or_else(|| whole_side(&t.map(|v| &self.whole[v])))
    }

    /// Triangles with an area have more in common than what they share by index. Sharing a corner, they meet elsewhere only if the edge opposite to it in one
    /// of them meets the other; sharing an edge, only if one is folded onto the other.
    fn meet_wrongly(&self, f: &[usize; 3], g: &[usize; 3]) -> bool {
        let shared: Vec<usize> = f.iter().copied().filter(|v| g.contains(v)).collect();
        let others = |t: &[usize; 3]| -> Vec<usize> { t.iter().copied().filter(|v| !shared.contains(v)).collect() };
        let sides = |t: &[usize; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        match shared[..] {
            [] => {
                sides(f).iter().any(|s| self.segment_meets(*s, g)) || sides(g).iter().any(|s| self.segment_meets(*s, f))
            }
            [_] => [(f, g), (g, f)].into_iter().any(|(t, u)| {
                let o = others(t);
                self.segment_meets([o[0], o[1]], u)
            }),
            [a, b] => {
                let (c, d) = (others(f)[0], others(g)[0]);
                let axis = self.open_axis(f);
                self.side([a, b, c, d]).is_eq() && self.turn([a, b, c], axis) == self.turn([a, b, d], axis)
            }
            _ => true,
        }
    }

    fn open_axis(&self, t: &[usize; 3]) -> usize {
        (0..3).find(|&axis| self.turn(*t, axis).is_ne()).expect("a triangle with an area")
    }

    fn segment_meets(&self, [p, q]: [usize; 2], t: &[usize; 3]) -> bool {
        let [a, b, c] = *t;
        let (x, y) = (self.side([a, b, c, p]), self.side([a, b, c, q]));
        if x == y && x.is_ne() {
            return false;
        }
        if x.is_ne() || y.is_ne() {
            // The line goes past all edges on one side.
            let past = [[a, b], [b, c], [c, a]].map(|[d, e]| self.side([p, q, d, e]));
            return !(past.contains(&Ordering::Less) && past.contains(&Ordering::Greater));
        }
        let axis = self.open_axis(t);
        let left = self.turn(*t, axis);
        let within =
            |v: usize| [[a, b], [b, c], [c, a]].iter().all(|[d, e]| self.turn([*d, *e, v], axis) != left.reverse());
        let crosses = |[d, e]: [usize; 2]| {
            let apart = |x: Ordering, y: Ordering| x == y && x.is_ne();
            let [s, t, u, v] = [[p, q, d], [p, q, e], [d, e, p], [d, e, q]].map(|t| self.turn(t, axis));
            // All on one line: then an end of one is within the other, which is seen from corners.
            !apart(s, t) && !apart(u, v) && [s, t, u, v].iter().any(|o| o.is_ne())
        };
        within(p) || within(q) || [[a, b], [b, c], [c, a]].into_iter().any(crosses)
    }
}

/// All points times the least power of two that makes them whole.
fn whole(points: &[&[f64; 3]]) -> Vec<[Integer; 3]> {
    let bits = |x: f64| match Rational::from_f64(x) {
        Some(x) => x.denom().significant_bits() - 1,
        None => panic!("{x} is not finite"),
    };
    let most = points.iter().flat_map(|x| x.iter()).map(|x| bits(*x)).max().unwrap_or(0);
    let times = |x: &f64| (Rational::from_f64(*x).unwrap() << most).into_numer_denom().0;
    points.iter().map(|x| x.each_ref().map(times)).collect()
}

/// Which way three points turn, seen along an axis, if doubles tell.
fn turn([a, b, c]: [&[f64; 3]; 3], axis: usize) -> Option<Ordering> {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let (l, r) = ((b[i] - a[i]) * (c[j] - a[j]), (b[j] - a[j]) * (c[i] - a[i]));
    // Each product has three rounding errors of half an ulp, their difference one more.
    let size = l.abs() + r.abs();
    ((l - r).abs() > 4.0 * f64::EPSILON * size && size > 1e-200).then(|| l.total_cmp(&r))
}

fn whole_turn<P: std::borrow::Borrow<[Integer; 3]>>(p: &[P], axis: usize) -> Ordering {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let d = |k: usize, i: usize| Integer::from(&p[k].borrow()[i] - &p[0].borrow()[i]);
    (d(1, i) * d(2, j)).cmp(&(d(1, j) * d(2, i)))
}

/// Where a point is off a triangle's plane, if doubles tell: `Greater` on the side from which the triangle turns to the left.
fn side(p: [&[f64; 3]; 4]) -> Option<Ordering> {
    let d = |k: usize| -> [f64; 3] { std::array::from_fn(|i| p[k][i] - p[0][i]) };
    let (e, f, g) = (d(1), d(2), d(3));
    let (mut sum, mut size) = (0.0, 0.0);
    for (i, x) in g.iter().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (l, r) = (x * (e[j] * f[k]), x * (e[k] * f[j]));
        sum += l - r;
        size += l.abs() + r.abs();
    }
    // Five rounding errors in each product, five more in sums.
    (sum.abs() > 10.0 * f64::EPSILON * size && size > 1e-200).then(|| sum.total_cmp(&0.0))
}

fn whole_side<P: std::borrow::Borrow<[Integer; 3]>>(p: &[P]) -> Ordering {
    let d =
        |k: usize| -> [Integer; 3] { std::array::from_fn(|i| Integer::from(&p[k].borrow()[i] - &p[0].borrow()[i])) };
    let (e, f, g) = (d(1), d(2), d(3));
    let mut sum = Integer::new();
    for (i, x) in g.iter().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        sum += (Integer::from(&e[j] * &f[k]) - Integer::from(&e[k] * &f[j])) * x;
    }
    sum.cmp0()
}

//! Table 1 of the networks paper: linear functions in a tetrahedron whose planes nearly share a point, a segment, a triangle or a
//! quadrilateral; 4 functions for arrangements, and 5 materials whose differences are such for interfaces. Each input is built
//! twice, with the functions in two orders. *Success*: the same complex both times. *Type I*: another one. *Type II*: no complex in one
//! of them, because signs contradict each other: the construction cannot go on, or what it leaves is not closed.
//!
//! With the feature `plain-signs` the table has rows for the same construction with the naive predicate. Prints Markdown; fails if
//! exact signs are not consistent every time.

use lapidary::network::simplex::{
    FaceSupport, Kind, LocalCell, LocalFace, LocalFunction, LocalVertex, Scratch, SimplexComplex, arrangement,
    interface,
};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// In [−1, 1), with all 53 bits.
    pub fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    /// Values at the corners.
    fn function(&mut self) -> [f64; 4] {
        std::array::from_fn(|_| self.signed())
    }
    /// A point inside the tetrahedron.
    fn point(&mut self) -> [f64; 4] {
        let x: [f64; 4] = std::array::from_fn(|_| 0.05 + self.signed().abs());
        let sum: f64 = x.iter().sum();
        x.map(|x| x / sum)
    }
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Point,
    Segment,
    Triangle,
    Quadrilateral,
}

const SHAPES: [(Shape, &str); 4] =
    [(Shape::Point, "point"), (Shape::Segment, "segment"), (Shape::Triangle, "tri"), (Shape::Quadrilateral, "quad")];

fn value(f: &[f64; 4], x: &[f64; 4]) -> f64 {
    (0..4).map(|c| f[c] * x[c]).sum()
}

/// A function that vanishes at a point, but for rounding.
fn through(r: &mut Random, x: &[f64; 4]) -> [f64; 4] {
    let f = r.function();
    let v = value(&f, x);
    f.map(|y| y - v)
}

/// Functions whose planes nearly share a shape.
fn functions(r: &mut Random, shape: Shape, count: usize) -> Vec<[f64; 4]> {
    let many = |make: &mut dyn FnMut() -> [f64; 4]| (0..count).map(|_| make()).collect();
    match shape {
        Shape::Point => {
            let x = r.point();
            many(&mut || through(r, &x))
        }
        // Combinations of two planes through an inner point share a line through it.
        Shape::Segment => {
            let x = r.point();
            let (f, g) = (through(r, &x), through(r, &x));
            many(&mut || {
                let (s, t) = (r.signed(), r.signed());
                std::array::from_fn(|c| s * f[c] + t * g[c])
            })
        }
        // Multiples of one function whose plane cuts off one corner, or two.
        Shape::Triangle | Shape::Quadrilateral => {
            let cut = if matches!(shape, Shape::Triangle) { 1 } else { 2 };
            let first = r.bits() as usize % 4;
            let f: [f64; 4] = std::array::from_fn(|c| {
                let x = r.signed().abs();
                if (c + 4 - first) % 4 < cut { -x } else { x }
            });
            many(&mut || {
                let s = r.signed();
                f.map(|x| s * x)
            })
        }
    }
}

fn input(r: &mut Random, kind: Kind, shape: Shape) -> Vec<[f64; 4]> {
    match kind {
        Kind::Arrangement => functions(r, shape, 4),
        Kind::Interface => {
            let base = r.function();
            let differences = functions(r, shape, 5);
            differences.iter().map(|f| std::array::from_fn(|c| base[c] + f[c])).collect()
        }
    }
}

/// One or the other construction, with exact signs or with plain ones.
pub struct Builder {
    plain: bool,
    scratch: Scratch,
    complex: SimplexComplex,
}

impl Builder {
    pub fn new(plain: bool) -> Self {
        #[allow(unused_mut)]
        let mut scratch = Scratch::default();
        #[cfg(feature = "plain-signs")]
        scratch.set_plain_signs(plain);
        Self { plain, scratch, complex: SimplexComplex::default() }
    }

    /// The complex of functions in an order, in a form that does not depend on it; `None` if there is no complex.
    pub fn structure(&mut self, kind: Kind, functions: &[[f64; 4]], order: &[usize]) -> Option<Structure> {
        let values: Vec<f64> = order.iter().flat_map(|&f| functions[f]).collect();
        let made = catch_unwind(AssertUnwindSafe(|| {
            match kind {
                Kind::Arrangement => arrangement(3, &values, &mut self.scratch, &mut self.complex),
                Kind::Interface => interface(3, &values, &mut self.scratch, &mut self.complex),
            }
            closed(&self.complex).then(|| structure(&self.complex, order))
        }));
        made.unwrap_or_else(|_| {
            // Half done.
            *self = Self::new(self.plain);
            None
        })
    }
}

/// Every cell is bounded by a sphere: each edge of its faces is in two of them, and Euler's formula holds.
fn closed(c: &SimplexComplex) -> bool {
    (0..c.cell_count()).map(LocalCell::of).all(|cell| {
        let mut edges = Vec::new();
        let mut vertices = Vec::new();
        for h in c.cell_faces.row(cell) {
            if c.face_cells[h.face().at()][h.side()] != cell {
                return false;
            }
            edges.extend_from_slice(c.edges_of(h.face()));
            vertices.extend_from_slice(c.face_vertices.row(h.face()));
        }
        edges.sort_unstable();
        vertices.sort_unstable();
        vertices.dedup();
        let twice = edges.chunks(2).all(|e| e.len() == 2 && e[0] == e[1]);
        let named = edges.windows(2).all(|e| e[0] <= e[1]) && vertices.iter().all(|v| v.at() < c.vertex_count());
        edges.dedup();
        twice && named && vertices.len() + c.cell_faces.row(cell).len() == edges.len() + 2
    })
}

/// Cells by label, with their faces: what each lies on, its corners' carriers, and the label beyond.
pub type Structure = Vec<(Vec<i32>, Vec<(Vec<usize>, Vec<u8>, Vec<i32>)>)>;

fn structure(c: &SimplexComplex, order: &[usize]) -> Structure {
    // Functions by their numbers in the input.
    let label = |cell: LocalCell| -> Vec<i32> {
        if cell.is_none() {
            return Vec::new();
        }
        match c.kind {
            Kind::Arrangement => {
                let mut signs = vec![0; order.len()];
                for (k, &f) in order.iter().enumerate() {
                    signs[f] = c.cell_sign(cell, LocalFunction::of(k)).to_i8().into();
                }
                signs
            }
            Kind::Interface => vec![order[c.cell_owner[cell.at()].at()] as i32],
        }
    };
    let support = |f: LocalFace| -> Vec<usize> {
        if let FaceSupport::Facet(i) = c.face_support[f.at()] {
            return vec![i as usize];
        }
        let mut set: Vec<usize> = c.face_functions(f).iter().map(|g| 4 + order[g.at()]).collect();
        set.sort();
        set
    };
    let mut cells: Structure = (0..c.cell_count())
        .map(LocalCell::of)
        .map(|cell| {
            let mut faces: Vec<_> = c
                .cell_faces
                .row(cell)
                .iter()
                .map(|h| {
                    let f = h.face();
                    let carrier = |v: &LocalVertex| c.vertex_carrier[v.at()].0;
                    let mut carriers: Vec<u8> = c.face_vertices.row(f).iter().map(carrier).collect();
                    carriers.sort();
                    (support(f), carriers, label(c.face_cells[f.at()][1 - h.side()]))
                })
                .collect();
            faces.sort();
            (label(cell), faces)
        })
        .collect();
    cells.sort();
    cells
}

/// One input in two orders, by what came of each: 0 for success, 1 and 2 for failures of type I and II.
pub fn outcome<T: PartialEq>(both: &[Option<T>; 2]) -> usize {
    match both {
        [Some(a), Some(b)] if a == b => 0,
        [Some(_), Some(_)] => 1,
        _ => 2,
    }
}

/// Counts of [`outcome`] as a row of a table.
pub fn print_row(what: &str, plain: bool, counts: [usize; 3]) {
    let all: usize = counts.iter().sum();
    let [success, one, two] = counts.map(|n| format!("{:.2} %", 100.0 * n as f64 / all as f64));
    let signs = if plain { "doubles" } else { "exact" };
    println!("| {what} | {signs} | {success} | {one} | {two} |");
}

/// With exact signs, and with plain ones where the build has them.
pub fn variants() -> &'static [bool] {
    if cfg!(feature = "plain-signs") { &[false, true] } else { &[false] }
}

/// Success, type I, type II.
fn tally(kind: Kind, shape: Shape, plain: bool, count: usize) -> [usize; 3] {
    let mut builder = Builder::new(plain);
    let mut counts = [0; 3];
    for i in 0..count {
        let mut r = Random((shape as u64) << 40 | (kind as u64) << 36 | i as u64);
        let functions = input(&mut r, kind, shape);
        let forward: Vec<usize> = (0..functions.len()).collect();
        let backward: Vec<usize> = forward.iter().rev().copied().collect();
        let both = [forward, backward].map(|order| builder.structure(kind, &functions, &order));
        counts[outcome(&both)] += 1;
    }
    counts
}

pub fn main(arguments: &[String]) {
    let count = arguments.first().map_or(10_000, |n| n.parse().expect("a number of inputs"));
    // What gives up says so by a panic, thousands of times.
    std::panic::set_hook(Box::new(|_| ()));
    println!("| degeneracy | signs | success | type I | type II |\n|---|---|---:|---:|---:|");
    let mut consistent = true;
    for (kind, name) in [(Kind::Arrangement, "IA"), (Kind::Interface, "MI")] {
        for &plain in variants() {
            for (shape, what) in SHAPES {
                let counts = tally(kind, shape, plain, count);
                print_row(&format!("{name} {what}"), plain, counts);
                consistent &= plain || counts[0] == count;
            }
        }
    }
    assert!(consistent, "exact signs that are not consistent");
}

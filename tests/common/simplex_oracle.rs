//! What linear functions do to one simplex, straight from definitions, in rationals and barycentric coordinates: cells are
//! intersections of half-spaces, kept as vertices and the planes that hold them (double description); faces and edges are what
//! the cells' vertices span. Slow, and without a formula of the library's.
#![allow(dead_code, clippy::needless_range_loop)]

use lapidary::network::simplex::Kind;
use rug::Rational;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// Barycentric coordinates, one per corner of the simplex.
pub type Point = Vec<Rational>;
/// Positions in [`Oracle::points`].
pub type Points = BTreeSet<usize>;

/// What an element is in: f > 0, f = 0, f < 0 for each function.
pub type Signs = Vec<Ordering>;

#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Label {
    Signs(Signs),
    /// The owner, and all materials that equal it.
    Material(usize, Vec<usize>),
}

pub struct Cell {
    pub label: Label,
    pub points: Points,
    pub facets: Vec<Points>,
    /// Its part of the volume of the simplex.
    pub volume: Rational,
}

/// A face of dimension dim − 1, with the one or two cells that it bounds.
pub struct Face {
    pub cells: Vec<usize>,
    /// The corner of the simplex opposite to the facet that the face lies in.
    pub facet: Option<usize>,
}

pub struct Oracle {
    pub kind: Kind,
    pub dim: usize,
    /// Function by function, corner by corner.
    pub functions: Vec<Vec<Rational>>,
    forms: Vec<Vec<Rational>>,
    /// The forms that do not vanish everywhere.
    real: u64,
    pub points: Vec<Point>,
    ids: BTreeMap<Point, usize>,
    zero: Vec<u64>,
    positive: Vec<u64>,
    pub cells: Vec<Cell>,
    pub faces: BTreeMap<Points, Face>,
    /// In a tetrahedron.
    pub edges: BTreeSet<[usize; 2]>,
}

fn dot(a: &[Rational], b: &[Rational]) -> Rational {
    a.iter().zip(b).fold(Rational::new(), |s, (x, y)| s + Rational::from(x * y))
}

/// By elimination.
pub fn determinant(mut rows: Vec<Vec<Rational>>) -> Rational {
    let mut product = Rational::from(1);
    for k in 0..rows.len() {
        let Some(pivot) = (k..rows.len()).find(|&i| !rows[i][k].is_zero()) else { return Rational::new() };
        if pivot != k {
            rows.swap(pivot, k);
            product = -product;
        }
        product *= &rows[k][k];
        for i in k + 1..rows.len() {
            let factor = Rational::from(&rows[i][k] / &rows[k][k]);
            for j in k..rows.len() {
                let less = Rational::from(&rows[k][j] * &factor);
                rows[i][j] -= less;
            }
        }
    }
    product
}

/// The one point where some forms vanish, if it is one: elimination with the sum of coordinates 1.
pub fn meet(forms: &[&[Rational]]) -> Option<Point> {
    let n = forms.len() + 1;
    let mut rows: Vec<Vec<Rational>> =
        forms.iter().map(|f| f.iter().cloned().chain([Rational::new()]).collect()).collect();
    rows.push(vec![Rational::from(1); n + 1]);
    for k in 0..n {
        let pivot = (k..n).find(|&i| !rows[i][k].is_zero())?;
        rows.swap(pivot, k);
        let lead = rows[k][k].clone();
        rows[k].iter_mut().for_each(|x| *x /= &lead);
        for i in (0..n).filter(|&i| i != k) {
            let factor = rows[i][k].clone();
            for j in 0..=n {
                let less = Rational::from(&rows[k][j] * &factor);
                rows[i][j] -= less;
            }
        }
    }
    Some(rows.into_iter().map(|row| row[n].clone()).collect())
}

/// A convex polytope of full dimension: its vertices and the forms that hold it.
#[derive(Clone)]
struct Polytope {
    points: Vec<usize>,
    forms: u64,
}

impl Oracle {
    /// `values[function * (dim + 1) + corner]`.
    pub fn new(kind: Kind, dim: usize, values: &[f64]) -> Self {
        let exact = |row: &[f64]| row.iter().map(|&x| Rational::from_f64(x).expect("finite")).collect();
        let functions: Vec<Vec<Rational>> = values.chunks(dim + 1).map(exact).collect();
        let mut forms: Vec<Vec<Rational>> =
            (0..=dim).map(|i| (0..=dim).map(|j| Rational::from((i == j) as i32)).collect()).collect();
        let n = functions.len();
        match kind {
            Kind::Arrangement => forms.extend(functions.iter().cloned()),
            Kind::Interface => {
                for a in 0..n {
                    for b in 0..a {
                        let difference = |i: usize| Rational::from(&functions[b][i] - &functions[a][i]);
                        forms.push((0..=dim).map(difference).collect());
                    }
                }
            }
        }
        assert!(forms.len() <= 64, "the oracle is for few functions");
        let real = (0..forms.len()).filter(|&k| forms[k].iter().any(|x| !x.is_zero())).map(|k| 1 << k).sum();
        let mut oracle = Self {
            kind,
            dim,
            functions,
            forms,
            real,
            points: Vec::new(),
            ids: BTreeMap::new(),
            zero: Vec::new(),
            positive: Vec::new(),
            cells: Vec::new(),
            faces: BTreeMap::new(),
            edges: BTreeSet::new(),
        };
        oracle.make_cells();
        oracle.make_faces();
        oracle
    }

    /// The form f_b − f_a, b < a.
    fn difference(&self, a: usize, b: usize) -> usize {
        self.dim + 1 + a * (a - 1) / 2 + b
    }

    fn point(&mut self, x: Point) -> usize {
        if let Some(&id) = self.ids.get(&x) {
            return id;
        }
        let (mut zero, mut positive) = (0, 0);
        for (k, form) in self.forms.iter().enumerate() {
            match dot(form, &x).cmp0() {
                Ordering::Equal => zero |= 1 << k,
                Ordering::Greater => positive |= 1 << k,
                Ordering::Less => {}
            }
        }
        self.ids.insert(x.clone(), self.points.len());
        self.points.push(x);
        self.zero.push(zero);
        self.positive.push(positive);
        self.points.len() - 1
    }

    fn sign(&self, form: usize, point: usize) -> Ordering {
        if self.zero[point] >> form & 1 == 1 {
            Ordering::Equal
        } else if self.positive[point] >> form & 1 == 1 {
            Ordering::Greater
        } else {
            Ordering::Less
        }
    }

    /// Is the smallest face that contains both just the segment between them?
    fn adjacent(&self, p: &Polytope, u: usize, v: usize) -> bool {
        let common = self.zero[u] & self.zero[v] & p.forms;
        p.points.iter().all(|&w| w == u || w == v || self.zero[w] & common != common)
    }

    /// The part where a form has a sign or is zero, if it has a volume.
    fn clip(&mut self, p: &Polytope, form: usize, side: Ordering) -> Option<Polytope> {
        let on = |s: &Self, want: Ordering| -> Vec<usize> {
            p.points.iter().copied().filter(|&v| s.sign(form, v) == want).collect()
        };
        let (kept, lost) = (on(self, side), on(self, side.reverse()));
        if kept.is_empty() {
            return None;
        }
        let mut points = kept.clone();
        points.extend(on(self, Ordering::Equal));
        for &u in &kept {
            for &v in &lost {
                if self.adjacent(p, u, v) {
                    let (gu, gv) = (dot(&self.forms[form], &self.points[u]), dot(&self.forms[form], &self.points[v]));
                    let t = &gu / Rational::from(&gu - &gv);
                    let mix = |i: usize| {
                        let (a, b) = (&self.points[u][i], &self.points[v][i]);
                        Rational::from(b - a) * &t + a
                    };
                    let x = (0..=self.dim).map(mix).collect();
                    points.push(self.point(x));
                }
            }
        }
        Some(Polytope { points, forms: p.forms | 1 << form })
    }

    fn whole(&mut self) -> Polytope {
        let dim = self.dim;
        let corner = |i: usize| (0..=dim).map(|j| Rational::from((i == j) as i32)).collect();
        let points = (0..=dim).map(|i| self.point(corner(i))).collect();
        Polytope { points, forms: (1 << (dim + 1)) - 1 }
    }

    fn make_cells(&mut self) {
        let n = self.functions.len();
        let mut found: Vec<(Polytope, Label)> = Vec::new();
        let whole = self.whole();
        match self.kind {
            Kind::Arrangement => {
                let mut parts = vec![whole];
                for form in self.dim + 1..self.forms.len() {
                    if self.real >> form & 1 == 0 {
                        continue;
                    }
                    let sides = [Ordering::Less, Ordering::Greater];
                    parts = parts.iter().flat_map(|p| sides.map(|side| self.clip(p, form, side))).flatten().collect();
                }
                for p in parts {
                    let sign = |f: usize| {
                        let signs = p.points.iter().map(|&v| self.sign(self.dim + 1 + f, v));
                        signs.reduce(|a, b| a.then(b)).unwrap_or(Ordering::Equal)
                    };
                    let label = Label::Signs((0..n).map(sign).collect());
                    found.push((p, label));
                }
            }
            Kind::Interface => {
                for a in 0..n {
                    let tied: Vec<usize> = (0..n).filter(|&b| self.functions[a] == self.functions[b]).collect();
                    if tied[0] < a {
                        continue;
                    }
                    let mut part = Some(whole.clone());
                    for b in (0..n).filter(|b| !tied.contains(b)) {
                        let (form, side) = if b < a {
                            (self.difference(a, b), Ordering::Less)
                        } else {
                            (self.difference(b, a), Ordering::Greater)
                        };
                        part = part.and_then(|p| self.clip(&p, form, side));
                    }
                    found.extend(part.map(|p| (p, Label::Material(a, tied))));
                }
                if n == 0 {
                    found.push((whole, Label::Material(0, Vec::new())));
                }
            }
        }
        self.cells = found.into_iter().map(|(p, label)| self.cell(p, label)).collect();
    }

    fn cell(&mut self, p: Polytope, label: Label) -> Cell {
        let tight = |k: usize| -> Points { p.points.iter().copied().filter(|&v| self.zero[v] >> k & 1 == 1).collect() };
        let used = p.forms & self.real;
        let held: BTreeSet<Points> = (0..self.forms.len()).filter(|k| used >> k & 1 == 1).map(tight).collect();
        let maximal = |s: &&Points| held.iter().all(|t| t == *s || !t.is_superset(s));
        let facets: Vec<Points> = held.iter().filter(maximal).cloned().collect();
        let mut edges = Vec::new();
        for (i, &u) in p.points.iter().enumerate() {
            for &v in &p.points[..i] {
                if self.adjacent(&p, u, v) {
                    edges.push([u.min(v), u.max(v)]);
                }
            }
        }
        let volume = self.volume(&p, &facets, &edges);
        if self.dim == 3 {
            self.edges.extend(edges);
        }
        Cell { label, points: p.points.iter().copied().collect(), facets, volume }
    }

    /// A fan of simplices from one vertex over the faces that it is not on.
    fn volume(&self, p: &Polytope, facets: &[Points], edges: &[[usize; 2]]) -> Rational {
        let apex = p.points[0];
        let part = |corners: &[usize]| determinant(corners.iter().map(|&v| self.points[v].clone()).collect()).abs();
        let far = facets.iter().filter(|f| !f.contains(&apex));
        far.fold(Rational::new(), |sum, f| {
            if self.dim == 2 {
                let ends: Vec<usize> = f.iter().copied().collect();
                return sum + part(&[apex, ends[0], ends[1]]);
            }
            let ring = cycle(f, edges);
            (2..ring.len()).fold(sum, |s, i| s + part(&[apex, ring[0], ring[i - 1], ring[i]]))
        })
    }

    fn make_faces(&mut self) {
        for (c, cell) in self.cells.iter().enumerate() {
            for points in &cell.facets {
                let facet = (0..=self.dim).find(|&i| points.iter().all(|&p| self.points[p][i].is_zero()));
                let face = self.faces.entry(points.clone()).or_insert(Face { cells: Vec::new(), facet });
                face.cells.push(c);
            }
        }
        for face in self.faces.values() {
            // The oracle's own check: cells meet face to face.
            assert_eq!(face.cells.len(), if face.facet.is_some() { 1 } else { 2 });
        }
        let total = self.cells.iter().fold(Rational::new(), |s, c| s + &c.volume);
        assert_eq!(total, 1);
    }

    /// The corners whose coordinates are positive, as a mask.
    pub fn carrier(&self, p: usize) -> u8 {
        (0..=self.dim).filter(|&i| !self.points[p][i].is_zero()).map(|i| 1 << i).sum()
    }

    /// Arrangement: the functions that vanish at all these points. Interface: the materials maximal at all.
    pub fn holding(&self, points: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut left: Vec<usize> = (0..self.functions.len()).collect();
        for p in points {
            let values: Vec<Rational> = self.functions.iter().map(|f| dot(f, &self.points[p])).collect();
            match self.kind {
                Kind::Arrangement => left.retain(|&f| values[f].is_zero()),
                Kind::Interface => left.retain(|&f| values.iter().all(|v| *v <= values[f])),
            }
        }
        left
    }

    /// The vertices of all cells.
    pub fn vertices(&self) -> Points {
        self.cells.iter().flat_map(|c| c.points.iter().copied()).collect()
    }

    /// Vertices found another way, of an arrangement: each set of dim planes that meet in one point of the simplex.
    pub fn vertices_by_planes(&self) -> BTreeSet<Point> {
        let mut found = BTreeSet::new();
        let real: Vec<&[Rational]> =
            (0..self.forms.len()).filter(|k| self.real >> k & 1 == 1).map(|k| self.forms[k].as_slice()).collect();
        let mut keep = |chosen: &[&[Rational]]| {
            found.extend(meet(chosen).filter(|x| x.iter().all(|c| c.cmp0() != Ordering::Less)));
        };
        for i in 0..real.len() {
            for j in 0..i {
                if self.dim == 2 {
                    keep(&[real[i], real[j]]);
                } else {
                    (0..j).for_each(|k| keep(&[real[i], real[j], real[k]]));
                }
            }
        }
        found
    }
}

/// The vertices of a convex polygon in order, from the edges of the polytope that it is a face of.
fn cycle(face: &Points, edges: &[[usize; 2]]) -> Vec<usize> {
    let next = |v: usize, not: &[usize]| {
        let ends = edges.iter().filter_map(|&[a, b]| if a == v { Some(b) } else { (b == v).then_some(a) });
        ends.into_iter().find(|w| face.contains(w) && !not.contains(w))
    };
    let mut ring = vec![*face.first().expect("a face has vertices")];
    while let Some(v) = next(ring[ring.len() - 1], &ring) {
        ring.push(v);
    }
    assert_eq!(ring.len(), face.len(), "the edges of a face are one cycle");
    ring
}

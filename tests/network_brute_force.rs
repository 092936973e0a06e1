//! The local complex of one simplex against an oracle in rationals that works from definitions alone
//! (`common/simplex_oracle.rs`): cells with labels and volumes, faces with what they lie on and both cells, vertices with
//! carriers and everything that goes through them. Degenerate on purpose, in every range of magnitude. `LAPIDARY_FUZZ=n` runs
//! n rounds of each.

mod common;
#[path = "common/simplex_oracle.rs"]
mod simplex_oracle;

use common::random::Random;
use lapidary::network::simplex::{
    FaceSupport, Kind, LocalCell, LocalFace, LocalFunction, LocalPlane, LocalVertex, Scratch, SimplexComplex,
    arrangement, check, exact_values, interface,
};
use rug::Rational;
use simplex_oracle::{Label, Oracle, Points, determinant, meet};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::panic::AssertUnwindSafe;

/// What is out of order between a complex and what it must be.
type Outcome = Result<(), String>;

fn ensure(holds: bool, what: impl FnOnce() -> String) -> Outcome {
    if holds { Ok(()) } else { Err(what()) }
}

fn numbers(list: &[LocalFunction]) -> Vec<usize> {
    list.iter().map(|f| f.at()).collect()
}

/// The determinant of points: positive where a simplex on them is oriented like the whole one.
fn turn(oracle: &Oracle, points: &[usize]) -> Rational {
    determinant(points.iter().map(|&p| oracle.points[p].clone()).collect())
}

/// All functions named on points: without those that vanish everywhere.
fn named(oracle: &Oracle, points: impl IntoIterator<Item = usize>) -> Vec<usize> {
    let mut list = oracle.holding(points);
    if oracle.kind == Kind::Arrangement {
        list.retain(|&f| oracle.functions[f].iter().any(|x| !x.is_zero()));
    }
    list
}

struct Comparison<'a> {
    c: &'a SimplexComplex,
    o: &'a Oracle,
    values: &'a [f64],
    /// The oracle's point of each vertex, and its cell of each cell.
    point: Vec<usize>,
    cell: Vec<usize>,
}

impl<'a> Comparison<'a> {
    fn run(c: &'a SimplexComplex, o: &'a Oracle, values: &'a [f64]) -> Outcome {
        let mut comparison = Comparison { c, o, values, point: Vec::new(), cell: Vec::new() };
        comparison.vertices()?;
        comparison.cells()?;
        comparison.edges()?;
        let faces: BTreeSet<Points> =
            (0..c.face_count()).map(|f| comparison.face(LocalFace::of(f))).collect::<Result<_, _>>()?;
        ensure(faces.len() == c.face_count(), || "a face comes twice".into())?;
        ensure(faces.len() == o.faces.len(), || format!("{} faces, not {}", faces.len(), o.faces.len()))?;
        comparison.planes()?;
        comparison.volumes()
    }

    /// A vertex is fixed by its carrier and all that is named on it; its encoding must give the same point.
    fn vertices(&mut self) -> Outcome {
        let (c, o) = (self.c, self.o);
        let wanted: BTreeMap<(u8, Vec<usize>), usize> =
            o.vertices().into_iter().map(|p| ((o.carrier(p), named(o, [p])), p)).collect();
        ensure(c.vertex_count() == wanted.len(), || format!("{} vertices, not {}", c.vertex_count(), wanted.len()))?;
        for v in 0..c.vertex_count() {
            let (carrier, list) = (c.vertex_carrier[v], numbers(c.vertex_functions.row(LocalVertex::of(v))));
            let key = (carrier.0, list);
            let &p = wanted.get(&key).ok_or_else(|| format!("vertex {v} is none: {key:?}"))?;
            ensure(v > o.dim || carrier.0 == 1 << v, || format!("corner {v} is not vertex {v}"))?;
            let dim = carrier.0.count_ones() as usize - 1;
            let size = dim + (o.kind == Kind::Interface) as usize;
            let code = c.vertex_encoding[v];
            let (used, rest) = code.split_at(size);
            ensure(used.iter().all(|f| key.1.contains(&f.at())), || format!("vertex {v} is not on {used:?}"))?;
            ensure(rest.iter().all(|f| *f == LocalFunction::NONE), || {
                format!("vertex {v}: code {code:?} is too long")
            })?;
            let mut forms: Vec<Vec<Rational>> = match o.kind {
                Kind::Arrangement => used.iter().map(|f| o.functions[f.at()].clone()).collect(),
                Kind::Interface => {
                    let first = &o.functions[used[0].at()];
                    let less = |f: &Vec<Rational>| f.iter().zip(first).map(|(a, b)| Rational::from(a - b)).collect();
                    used[1..].iter().map(|f| less(&o.functions[f.at()])).collect()
                }
            };
            let facets = (0..=o.dim).filter(|&i| !carrier.has(i));
            forms.extend(facets.map(|i| (0..=o.dim).map(|j| Rational::from((i == j) as i32)).collect()));
            let forms: Vec<&[Rational]> = forms.iter().map(|f| f.as_slice()).collect();
            ensure(meet(&forms).as_ref() == Some(&o.points[p]), || format!("vertex {v} is not where its code says"))?;
            let exact = exact_values::vertex(c, self.values, LocalVertex::of(v));
            ensure(exact[..=o.dim] == o.points[p][..], || format!("the exact coordinates of vertex {v}: {exact:?}"))?;
            self.point.push(p);
        }
        let distinct: BTreeSet<usize> = self.point.iter().copied().collect();
        ensure(distinct.len() == self.point.len(), || "a vertex comes twice".into())
    }

    /// Cells by label.
    fn cells(&mut self) -> Outcome {
        let (c, o) = (self.c, self.o);
        ensure(c.cell_count() == o.cells.len(), || format!("{} cells, not {}", c.cell_count(), o.cells.len()))?;
        for cell in (0..c.cell_count()).map(LocalCell::of) {
            let label = match o.kind {
                Kind::Arrangement => {
                    let sign = |f| c.cell_sign(cell, LocalFunction::of(f)).to_i8().cmp(&0);
                    Label::Signs((0..c.functions).map(sign).collect())
                }
                Kind::Interface => Label::Material(c.cell_owner[cell.at()].at(), numbers(c.cell_materials.row(cell))),
            };
            let found = o.cells.iter().position(|other| other.label == label);
            let found = found.ok_or_else(|| format!("cell {cell:?} is none: {label:?}"))?;
            self.cell.push(found);
            let facets: BTreeSet<Points> = c.cell_faces.row(cell).iter().map(|h| self.points(h.face())).collect();
            let wanted: BTreeSet<Points> = o.cells[found].facets.iter().cloned().collect();
            ensure(facets == wanted, || format!("faces of {cell:?}: {facets:?}, not {wanted:?}"))?;
            ensure(facets.len() == c.cell_faces.row(cell).len(), || format!("{cell:?} has a face twice"))?;
            for h in c.cell_faces.row(cell) {
                ensure(c.face_cells[h.face().at()][h.side()] == cell, || format!("{h:?} is not of {cell:?}"))?;
            }
        }
        Ok(())
    }

    fn edges(&self) -> Outcome {
        let ends = self.c.edges.iter().map(|e| {
            let [a, b] = e.map(|v| self.point[v.at()]);
            [a.min(b), a.max(b)]
        });
        let found: BTreeSet<[usize; 2]> = ends.collect();
        ensure(found.len() == self.c.edge_count(), || "an edge comes twice".into())?;
        ensure(found == self.o.edges, || format!("edges {found:?}, not {:?}", self.o.edges))
    }

    fn points(&self, f: LocalFace) -> Points {
        self.c.face_vertices.row(f).iter().map(|v| self.point[v.at()]).collect()
    }

    fn face(&self, f: LocalFace) -> Result<Points, String> {
        let (c, o) = (self.c, self.o);
        let points = self.points(f);
        let wanted = o.faces.get(&points).ok_or_else(|| format!("{f:?} is no face: {points:?}"))?;
        let ring: Vec<usize> = c.face_vertices.row(f).iter().map(|v| self.point[v.at()]).collect();
        ensure(ring.len() == points.len(), || format!("{f:?} has a vertex twice"))?;
        // What it lies on, and what is on its sides.
        let list = named(o, points.iter().copied());
        ensure(numbers(c.face_functions(f)) == list, || {
            format!("{f:?} is on {:?}, not {list:?}", numbers(c.face_functions(f)))
        })?;
        let sides = c.face_cells[f.at()].map(|cell| (cell != LocalCell::NONE).then(|| self.cell[cell.at()]));
        let mut both: Vec<usize> = sides.iter().flatten().copied().collect();
        both.sort();
        ensure(both == wanted.cells, || format!("{f:?} is between {sides:?}, not {:?}", wanted.cells))?;
        let support = c.face_support[f.at()];
        let label = |side: usize| sides[side].map(|cell| &o.cells[cell].label);
        let right = match (support, wanted.facet) {
            (FaceSupport::Facet(i), Some(j)) => i as usize == j && sides[1].is_none(),
            (FaceSupport::Function(g), None) => {
                let sign = |side| match label(side) {
                    Some(Label::Signs(signs)) => signs[g.at()],
                    _ => Ordering::Equal,
                };
                list[0] == g.at() && sign(0) == Ordering::Greater && sign(1) == Ordering::Less
            }
            (FaceSupport::Pair(a, b), None) => {
                let owner = |side| match label(side) {
                    Some(Label::Material(owner, _)) => Some(*owner),
                    _ => None,
                };
                a < b && owner(0) == Some(a.at()) && owner(1) == Some(b.at())
            }
            _ => false,
        };
        ensure(right, || format!("{f:?} lies on {support:?} between {:?} and {:?}", label(0), label(1)))?;
        // Its direction: anticlockwise, or the positive side on the left, for whoever is on the positive side.
        let cell = sides[0].expect("a face has a cell on its positive side");
        let eye = *o.cells[cell].points.difference(&points).next().expect("a cell is more than its face");
        let n = ring.len();
        for i in 0..n {
            let next = ring[(i + 1) % n];
            if o.dim == 2 {
                ensure(i == 1 || turn(o, &[ring[i], next, eye]) > 0, || format!("{f:?} is reversed"))?;
                continue;
            }
            let seen = turn(o, &[ring[i], next, ring[(i + 2) % n], eye]);
            ensure(seen > 0, || format!("{f:?} is reversed, or not convex at corner {i}"))?;
            let [a, b] = c.edges[c.edges_of(f)[i].at()].map(|v| self.point[v.at()]);
            let same = [a, b] == [ring[i], next] || [b, a] == [ring[i], next];
            ensure(same, || format!("edge {i} of {f:?} is not between its corners"))?;
        }
        Ok(points)
    }

    /// Coplanar faces share a plane, whose functions are told on which side they are negative.
    fn planes(&self) -> Outcome {
        let (c, o) = (self.c, self.o);
        if o.kind == Kind::Interface {
            return Ok(());
        }
        for f in (0..c.face_count()).map(LocalFace::of) {
            let plane = c.face_plane[f.at()];
            if let FaceSupport::Facet(i) = c.face_support[f.at()] {
                ensure(plane.at() == i as usize, || format!("{f:?} of facet {i} is on {plane:?}"))?;
            } else {
                ensure(plane.at() > o.dim, || format!("{f:?} inside is on {plane:?}"))?;
                for g in (0..f.at()).map(LocalFace::of) {
                    let coplanar =
                        c.face_functions(f) == c.face_functions(g) && o.faces[&self.points(g)].facet.is_none();
                    ensure(coplanar == (plane == c.face_plane[g.at()]), || format!("planes of {f:?} and {g:?}"))?;
                }
            }
            let cell = self.cell[c.face_cells[f.at()][0].at()];
            let Label::Signs(signs) = &o.cells[cell].label else { return Err("a cell without signs".into()) };
            let range = c.plane_functions.range(plane);
            for (g, opposite) in c.plane_functions.items[range.clone()].iter().zip(&c.plane_opposite[range]) {
                ensure((signs[g.at()] == Ordering::Less) == *opposite, || format!("the side of {g:?} on {plane:?}"))?;
            }
        }
        Ok(())
    }

    /// From the complex's own faces: cones over them from a corner, with the sign of the side.
    fn volumes(&self) -> Outcome {
        let (c, o) = (self.c, self.o);
        for cell in (0..c.cell_count()).map(LocalCell::of) {
            let mut sum = Rational::new();
            for h in c.cell_faces.row(cell) {
                let ring: Vec<usize> = c.face_vertices.row(h.face()).iter().map(|v| self.point[v.at()]).collect();
                let mut cone = Rational::new();
                if o.dim == 2 {
                    cone += turn(o, &[ring[0], ring[1], self.point[0]]);
                } else {
                    for i in 2..ring.len() {
                        cone += turn(o, &[ring[0], ring[i - 1], ring[i], self.point[0]]);
                    }
                }
                if h.side() == 0 { sum += cone } else { sum -= cone }
            }
            let wanted = &o.cells[self.cell[cell.at()]].volume;
            ensure(sum == *wanted, || format!("volume {sum} of {cell:?}, not {wanted}"))?;
            ensure(exact_values::cell_volume(c, self.values, cell) == *wanted, || format!("the volume of {cell:?}"))?;
        }
        Ok(())
    }
}

fn rounds(default: u64) -> u64 {
    std::env::var("LAPIDARY_FUZZ").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

#[derive(Default)]
struct Engine {
    scratch: Scratch,
    complex: SimplexComplex,
}

impl Engine {
    /// Builds, and compares. The same arrays over and over: nothing may be left of what was there before.
    fn verify(&mut self, kind: Kind, dim: usize, values: &[f64]) -> Outcome {
        match kind {
            Kind::Arrangement => arrangement(dim, values, &mut self.scratch, &mut self.complex),
            Kind::Interface => interface(dim, values, &mut self.scratch, &mut self.complex),
        }
        check(&self.complex, values)?;
        Comparison::run(&self.complex, &Oracle::new(kind, dim, values), values)
    }
}

/// Rounds of one case each, in tetrahedra and triangles by turns, both kinds; reports the first failures with their input.
fn attack(seed: u64, count: u64, mut case: impl FnMut(&mut Random, Kind, usize) -> Vec<f64>) {
    let mut failed = Vec::new();
    let mut engine = Engine::default();
    for round in 0..count {
        for kind in [Kind::Arrangement, Kind::Interface] {
            let mut random = Random(seed.wrapping_mul(1 << 32).wrapping_add(round));
            // Four of five are tetrahedra.
            let dim = if round % 5 == 4 { 2 } else { 3 };
            let values = case(&mut random, kind, dim);
            let verified = AssertUnwindSafe(|| engine.verify(kind, dim, &values));
            if let Err(message) = std::panic::catch_unwind(verified).unwrap_or(Err("panic".into())) {
                failed.push(format!("round {round}, {kind:?} in {dim}-D: {message}\nvalues {values:?}"));
                engine = Engine::default();
            }
        }
    }
    let first: Vec<&str> = failed.iter().take(3).map(|s| s.as_str()).collect();
    assert!(failed.is_empty(), "{} of {} failed:\n{}", failed.len(), 2 * count, first.join("\n\n"));
}

/// Values with f and g at corners, function by function.
fn fill(n: usize, dim: usize, mut value: impl FnMut(usize, usize) -> f64) -> Vec<f64> {
    (0..n * (dim + 1)).map(|i| value(i / (dim + 1), i % (dim + 1))).collect()
}

/// −1, 0 and 1: planes through corners, edges and faces, common points and lines, equal planes. 5000 tetrahedra.
fn small(n: u64) {
    attack(n, rounds(6250), |r, kind, dim| {
        // An interface has a material.
        let n = n.max((kind == Kind::Interface) as u64) as usize;
        fill(n, dim, |_, _| r.within(1))
    });
}

#[test]
fn no_or_one_function_of_small_integers() {
    small(0);
    small(1);
}
#[test]
fn two_functions_of_small_integers() {
    small(2);
}
#[test]
fn three_functions_of_small_integers() {
    small(3);
}
#[test]
fn four_functions_of_small_integers() {
    small(4);
}
#[test]
fn five_functions_of_small_integers() {
    small(5);
}
#[test]
fn six_functions_of_small_integers() {
    small(6);
}
#[test]
fn seven_functions_of_small_integers() {
    small(7);
}

/// Larger integers: fewer coincidences, and those that there are lie inside.
#[test]
fn integers() {
    attack(11, rounds(1500), |r, _, dim| {
        let (n, bound) = (1 + r.below(6) as usize, 2 + r.below(3) as i64);
        fill(n, dim, |_, _| r.within(bound))
    });
}

#[test]
fn all_bits() {
    attack(12, rounds(400), |r, _, dim| {
        let n = 1 + r.below(6) as usize;
        fill(n, dim, |_, _| r.signed())
    });
}

/// Each function (of an arrangement) or all (of an interface) scaled by a power of two that leaves little room.
#[test]
fn scaled_by_far() {
    attack(13, rounds(500), |r, kind, dim| {
        let n = 1 + r.below(5) as usize;
        let whole = r.below(2) == 0;
        let mut factor = 1.0;
        fill(n, dim, |f, corner| {
            if corner == 0 && (f == 0 || kind == Kind::Arrangement) {
                factor = [2f64.powi(900), 2f64.powi(-900), 1.0][r.below(3) as usize];
            }
            factor * if whole { r.within(2) } else { r.signed() }
        })
    });
}

/// The smallest and the largest numbers that there are, side by side.
#[test]
fn the_ends_of_the_range() {
    const ENDS: [f64; 8] = [0.0, 5e-324, 1e-323, f64::MIN_POSITIVE, 1.0, 1e-160, 1e200, f64::MAX];
    attack(14, rounds(500), |r, _, dim| {
        let n = 1 + r.below(4) as usize;
        fill(n, dim, |_, _| {
            let x = ENDS[r.below(8) as usize];
            if r.below(2) == 0 { x } else { -x }
        })
    });
}

/// Functions made of two or three others: copies, opposites, multiples, sums and the zero function.
#[test]
fn dependent_functions() {
    attack(15, rounds(1500), |r, _, dim| {
        let (n, base) = (2 + r.below(5) as usize, 1 + r.below(3) as usize);
        // Whole numbers, so that sums are exact.
        let origin = fill(base, dim, |_, _| r.within(5));
        let weights: Vec<f64> = (0..n * base).map(|_| r.within(2)).collect();
        let value = |f: usize, i: usize| (0..base).map(|b| weights[f * base + b] * origin[b * (dim + 1) + i]).sum();
        fill(n, dim, value)
    });
}

/// Planes that would share a point or a line, or be one, if doubles were exact; materials whose differences are such.
#[test]
fn nearly_degenerate() {
    attack(16, rounds(400), |r, kind, dim| {
        let n = 2 + r.below(4) as usize;
        let (base, common) = (1 + r.below(3) as usize, r.below(2) as f64);
        let origin = fill(base, dim, |_, _| r.signed());
        let offset: Vec<f64> = (0..=dim).map(|_| r.signed() * common).collect();
        let weights: Vec<f64> = (0..n * base).map(|_| r.signed()).collect();
        fill(n, dim, |f, i| {
            let x: f64 = (0..base).map(|b| weights[f * base + b] * origin[b * (dim + 1) + i]).sum();
            if kind == Kind::Interface { x + offset[i] } else { x }
        })
    });
}

/// Whatever is changed in a complex is noticed.
#[test]
fn the_comparison_notices_what_is_wrong() {
    type Change = fn(&mut SimplexComplex);
    const BOTH: &[(&str, Change)] = &[
        ("carrier", |c| c.vertex_carrier[4].0 ^= 8),
        ("order", |c| c.vertex_carrier.swap(0, 1)),
        ("code", |c| c.vertex_encoding[4][0] = LocalFunction::NONE),
        ("functions of a vertex", |c| c.vertex_functions.items[0].0 ^= 1),
        ("edge", |c| c.edges[0][0] = c.edges[0][1]),
        ("edge of a face", |c| c.face_edges.swap(0, 1)),
        ("corner", |c| c.face_vertices.items.swap(0, 1)),
        ("direction", |c| c.face_vertices.row_mut(2usize).reverse()),
        ("support", |c| c.face_support[0] = FaceSupport::Facet(7)),
        ("sides", |c| c.face_cells[0].swap(0, 1)),
        ("functions of a face", |c| c.plane_functions.items[0].0 ^= 1),
        ("faces of a cell", |c| c.cell_faces.items.reverse()),
    ];
    const ARRANGEMENT: &[(&str, Change)] = &[
        ("plane", |c| c.face_plane[0] = LocalPlane(5)),
        ("side of a function", |c| c.plane_opposite[0] ^= true),
        ("label", |c| c.cell_positive[0] ^= 1),
        ("zero", |c| c.zero_functions[0] ^= 4),
    ];
    const INTERFACE: &[(&str, Change)] =
        &[("owner", |c| c.cell_owner.swap(0, 1)), ("materials", |c| c.cell_materials.items[0].0 ^= 1)];
    let values = [1.0, -2.0, 3.0, -4.0, 2.0, 1.0, -5.0, -1.0, 0.0, 0.0, 0.0, 0.0];
    for (kind, own) in [(Kind::Arrangement, ARRANGEMENT), (Kind::Interface, INTERFACE)] {
        let mut engine = Engine::default();
        engine.verify(kind, 3, &values).unwrap();
        let oracle = Oracle::new(kind, 3, &values);
        for (what, change) in BOTH.iter().chain(own) {
            let mut changed = engine.complex.clone();
            change(&mut changed);
            let noticed =
                std::panic::catch_unwind(|| Comparison::run(&changed, &oracle, &values)).unwrap_or(Err("panic".into()));
            assert!(noticed.is_err(), "{kind:?}: a wrong {what} is not noticed");
        }
    }
}

/// The oracle itself: vertices are where planes meet, and the counts are those of published cases.
#[test]
fn the_oracle_finds_the_vertices_another_way() {
    for round in 0..400 {
        let mut r = Random(round);
        let dim = 2 + (round % 2) as usize;
        let n = r.below(5) as usize;
        let values: Vec<f64> = (0..n * (dim + 1)).map(|_| r.within(2)).collect();
        let oracle = Oracle::new(Kind::Arrangement, dim, &values);
        let found = oracle.vertices().into_iter().map(|v| oracle.points[v].clone()).collect();
        assert_eq!(oracle.vertices_by_planes(), found, "{dim} {values:?}");
    }
}

#[test]
fn the_oracle_knows_the_shared_cases() {
    let Some(path) = common::shared("oracles/simplex-cases.json") else { return };
    let cases: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    for (kind, name) in [(Kind::Arrangement, "arrangement"), (Kind::Interface, "material_interface")] {
        let list = cases[name].as_array().unwrap();
        assert!(!list.is_empty());
        for case in list {
            let dim = case["dim"].as_u64().unwrap() as usize;
            let rows = case["input"].as_array().unwrap();
            let values: Vec<f64> =
                rows.iter().flat_map(|row| row.as_array().unwrap()).map(|x| x.as_f64().unwrap()).collect();
            let oracle = Oracle::new(kind, dim, &values);
            let facets: usize = oracle.cells.iter().map(|c| c.facets.len()).sum();
            for (key, count) in case["expect"].as_object().unwrap() {
                let got = match (key.as_str(), dim) {
                    ("cells", _) => oracle.cells.len(),
                    ("vertices", _) => oracle.vertices().len(),
                    ("half_faces", 3) | ("half_edges", 2) => facets,
                    ("faces", _) => oracle.faces.len(),
                    _ => continue,
                };
                assert_eq!(got as u64, count.as_u64().unwrap(), "{key} of {}", case["name"]);
            }
        }
    }
}

//! The tables of one simplex: made again from the incremental construction and compared; looked-up complexes against incremental
//! ones, element by element, for every type of corners and for values that are hard to tell apart.
//!
//! With `LAPIDARY_WRITE_TABLES` set to a path the first test writes the data there instead: `src/network/simplex/tables.bin`.

use lapidary::network::simplex::tables::*;
use lapidary::network::simplex::*;
use std::collections::BTreeMap;

mod common;
use common::random::Random;

/// Values of functions at corners.
type Values = Vec<Vec<f64>>;

#[derive(Default)]
struct Bench {
    scratch: Scratch,
    complex: SimplexComplex,
    flat: Vec<f64>,
}

impl Bench {
    fn incremental(&mut self, kind: Kind, values: &Values) -> &SimplexComplex {
        let dim = self.flatten(values);
        match kind {
            Kind::Arrangement => arrangement_incremental(dim, &self.flat, &mut self.scratch, &mut self.complex),
            Kind::Interface => interface_incremental(dim, &self.flat, &mut self.scratch, &mut self.complex),
        }
        &self.complex
    }

    fn looked_up(&mut self, kind: Kind, values: &Values) -> (&SimplexComplex, View) {
        let dim = self.flatten(values);
        let view = View::new(find_table(kind, dim, &self.flat).expect("a table"));
        view.fill(&mut self.complex);
        (&self.complex, view)
    }

    fn flatten(&mut self, values: &Values) -> usize {
        self.flat.clear();
        values.iter().for_each(|f| self.flat.extend(f));
        values[0].len() - 1
    }
}

/// A complex with numbers that depend on nothing but the complex: vertices by carrier and functions, cells by label, the others by
/// their vertices. Sets are masks.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Raw {
    zero: u8,
    /// Carrier, functions.
    vertices: Vec<[u8; 2]>,
    edges: Vec<[u8; 2]>,
    faces: Vec<RawFace>,
    /// Label, half-faces.
    cells: Vec<(u8, Vec<u8>)>,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct RawFace {
    facet: u8,
    /// Vertices and edges, the lowest vertex first.
    corners: Vec<[u8; 2]>,
    functions: u8,
    opposite: u8,
    cells: [u8; 2],
    support: FaceSupport,
    /// IA: its plane.
    plane: u32,
}

fn mask<'a>(set: impl IntoIterator<Item = &'a LocalFunction>) -> u8 {
    set.into_iter().filter(|f| f.is_some()).fold(0, |m, f| m | 1 << f.0)
}

/// New numbers from the order of keys.
fn numbers<K: Ord>(count: usize, key: impl Fn(usize) -> K) -> (Vec<usize>, Vec<u8>) {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|&i| key(i));
    let mut numbers = vec![0; count];
    order.iter().enumerate().for_each(|(new, &old)| numbers[old] = new as u8);
    (order, numbers)
}

/// That complex; and the encodings of its vertices.
fn raw(c: &SimplexComplex) -> (Raw, Vec<u8>) {
    let vertex = |v: usize| [c.vertex_carrier[v].0, mask(c.vertex_functions.row(v))];
    let (vertices, vertex_number) = numbers(c.vertex_count(), |v| (v > c.dim).then(|| vertex(v)));
    let ends = |e: usize| {
        let mut ends = c.edges[e].map(|v| vertex_number[v.at()]);
        ends.sort();
        ends
    };
    let (edges, edge_number) = numbers(c.edge_count(), ends);
    let arrangement = c.kind == Kind::Arrangement;
    let label =
        |k: usize| if arrangement { c.cell_positive[k] as u8 } else { mask(c.cell_materials.row(LocalCell::of(k))) };
    let (cells, cell_number) = numbers(c.cell_count(), label);
    if !arrangement {
        for k in 0..c.cell_count() {
            assert_eq!(c.cell_owner[k].0, label(k).trailing_zeros());
        }
    }
    let face = |f: usize| {
        let range = c.face_vertices.range(f);
        let edge = |at: usize| c.face_edges.get(at).map_or(u8::MAX, |e| edge_number[e.at()]);
        let corner = |at: usize| [vertex_number[c.face_vertices.items[at].at()], edge(at)];
        let mut corners: Vec<[u8; 2]> = range.map(corner).collect();
        if c.dim == 3 {
            let first = (0..corners.len()).min_by_key(|&k| corners[k]).unwrap();
            corners.rotate_left(first);
        }
        let plane = c.face_plane[f];
        let functions = c.plane_functions.row(plane);
        let opposite = c.plane_functions.range(plane).filter(|&at| arrangement && c.plane_opposite[at]);
        RawFace {
            facet: if let FaceSupport::Facet(i) = c.face_support[f] { i } else { EntryFace::INSIDE },
            corners,
            functions: mask(functions),
            opposite: mask(opposite.map(|at| &c.plane_functions.items[at])),
            cells: c.face_cells[f].map(|k| if k.is_none() { u8::MAX } else { cell_number[k.at()] }),
            support: c.face_support[f],
            plane: if arrangement { plane.0 } else { 0 },
        }
    };
    let (faces, face_number) = numbers(c.face_count(), face);
    let half_faces = |k: usize| {
        let half = |h: &LocalHalfFace| face_number[h.face().at()] << 1 | h.side() as u8;
        let mut out: Vec<u8> = c.cell_faces.row(LocalCell::of(k)).iter().map(half).collect();
        out.sort();
        out
    };
    let encoding = |&v: &usize| mask(&c.vertex_encoding[v]);
    let raw = Raw {
        zero: c.zero_functions.first().map_or(0, |&z| z as u8),
        vertices: vertices.iter().map(|&v| vertex(v)).collect(),
        edges: edges.iter().map(|&e| ends(e)).collect(),
        faces: faces.iter().map(|&f| face(f)).collect(),
        cells: cells.iter().map(|&k| (label(k), half_faces(k))).collect(),
    };
    (raw, vertices.iter().map(encoding).collect())
}

/// Values for corners of these types, between 1 and 4 deciding about opposite ones.
fn values_of(table: &Table, types: &[u8], slopes: &[u8]) -> Values {
    let sign = |x: u8| x as f64 - 1.0;
    let corner = |c: usize| -> Vec<f64> {
        let (t, s) = (types[c], slopes[c] as f64);
        match (table.kind, table.functions) {
            (Kind::Arrangement, 1) => vec![sign(t)],
            (Kind::Arrangement, _) => vec![sign(t / 3) * (5.0 - s), sign(t % 3) * s],
            (Kind::Interface, 2) => vec![sign(t), 0.0],
            _ => {
                let i = ORDERS.iter().position(|&o| o == t).unwrap() as u8;
                let (a, b, c) = (sign(i / 9), sign(i / 3 % 3), sign(i % 3));
                let score = [a + b, c - a, -b - c];
                let value = |x: f64| {
                    if a * b * c == 0.0 {
                        x
                    } else if x == 0.0 {
                        s
                    } else if x > 0.0 {
                        5.0
                    } else {
                        0.0
                    }
                };
                score.into_iter().map(value).collect()
            }
        }
    };
    let corners: Vec<Vec<f64>> = (0..types.len()).map(corner).collect();
    (0..table.functions).map(|f| corners.iter().map(|c| c[f]).collect()).collect()
}

/// The index to the second tier.
fn digits(table: &Table, main: &Main, values: &Values) -> usize {
    let pairs = main.pairs[..main.count as usize].iter();
    pairs.fold(0, |index, &pair| {
        let (i, j) = ((pair & 3) as usize, (pair >> 2) as usize);
        let row = |c: usize| match table.kind {
            Kind::Arrangement => [values[0][c], values[1][c]],
            Kind::Interface => [values[1][c] - values[0][c], values[2][c] - values[0][c]],
        };
        let ([a, b], [c, d]) = (row(i), row(j));
        let sign = (a * d).partial_cmp(&(b * c)).unwrap() as i32;
        3 * index + (sign + 1) as usize
    })
}

/// All rows of `m` numbers from 1 to 4.
fn all_slopes(m: usize) -> impl Iterator<Item = Vec<u8>> {
    (0..1usize << (2 * m)).map(move |i| (0..m).map(|c| 1 + (i >> (2 * c) & 3) as u8).collect())
}

/// The records of the first tier that belong to a table.
fn mains(table: usize) -> &'static [Main] {
    let size = |t: &Table| (0..=t.dim).fold(1, |n, i| n * (t.types + i) / (i + 1));
    let start: usize = TABLES[..table].iter().map(size).sum();
    &MAIN[start..start + size(&TABLES[table])]
}

/// Symmetries of a table's functions, the one that does nothing first.
fn symmetries(table: &Table) -> &'static [u8] {
    match (table.kind, table.functions) {
        (Kind::Arrangement, 1) => &[0, 2],
        (Kind::Arrangement, _) => &[0, 1, 2, 3, 4, 5, 6, 7],
        (Kind::Interface, 2) => &[8, 10],
        _ => &[8, 9, 10, 11, 12, 13],
    }
}

fn permutations(dim: usize) -> impl Iterator<Item = u8> {
    (0..24).filter(move |&p| dim == 3 || PERMUTATIONS[p as usize][3] == 3)
}

fn transformed(values: &Values, corners: u8, functions: u8) -> Values {
    let (p, s) = (PERMUTATIONS[corners as usize], SYMMETRIES[functions as usize]);
    let mut out = values.clone();
    for (f, row) in values.iter().enumerate() {
        for (c, &x) in row.iter().enumerate() {
            out[s.to[f] as usize][p[c] as usize] = if s.flip >> f & 1 == 1 { -x } else { x };
        }
    }
    out
}

/// The file.
fn generate() -> Vec<u8> {
    let mut bench = Bench::default();
    let mut branches = vec![Found { entry: Found::NOTHING, corners: 0, functions: 0 }; BRANCH_COUNT];
    let mut entries: Vec<(usize, Raw, Vec<u8>)> = vec![];
    for (t, table) in TABLES.iter().enumerate() {
        // All images of the entries, and how they come from them.
        let mut images: BTreeMap<Raw, Found> = BTreeMap::new();
        for main in mains(t) {
            let types = &main.types[..=table.dim];
            let slopes = if main.count == 0 { 1 } else { usize::MAX };
            for slopes in all_slopes(table.dim + 1).take(slopes) {
                let values = values_of(table, types, &slopes);
                let branch = &mut branches[main.first as usize + digits(table, main, &values)];
                if branch.entry != Found::NOTHING {
                    continue;
                }
                let (complex, encodings) = raw(bench.incremental(table.kind, &values));
                if !images.contains_key(&complex) {
                    for &functions in symmetries(table) {
                        for corners in permutations(table.dim) {
                            let image = transformed(&values, corners, functions);
                            let found = Found { entry: entries.len() as u16, corners, functions };
                            images.entry(raw(bench.incremental(table.kind, &image)).0).or_insert(found);
                        }
                    }
                    entries.push((t, complex.clone(), encodings));
                }
                *branch = images[&complex];
            }
        }
    }

    let mut lists: [Vec<u8>; 6] = Default::default();
    let mut heads: Vec<u8> = vec![];
    for (table, entry, encodings) in &entries {
        let [vertices, edges, faces, corners, cells, half_faces] = &mut lists;
        for ([carrier, functions], encoding) in entry.vertices.iter().zip(encodings) {
            vertices.extend([carrier, functions, encoding]);
        }
        edges.extend(entry.edges.as_flattened());
        let mut start = 0;
        for f in &entry.faces {
            let len = f.corners.len();
            faces.extend([start as u8, len as u8, f.facet, f.functions, f.opposite, f.cells[0], f.cells[1]]);
            corners.extend(f.corners.as_flattened());
            start += len;
        }
        let mut halves = 0;
        for (label, list) in &entry.cells {
            cells.extend([list.len() as u8, *label]);
            half_faces.extend(list);
            halves += list.len();
        }
        assert!(start < 256 && halves < 256 && entry.faces.len() <= 64);
        heads.extend([*table as u8, entry.zero]);
        let counts = [entry.vertices.len(), entry.edges.len(), entry.faces.len(), start, entry.cells.len(), halves];
        heads.extend(counts.map(|n| n as u8));
    }
    let sizes = [3, 2, 7, 2, 2, 1];
    let counts = [entries.len()].into_iter().chain(lists.iter().zip(sizes).map(|(list, size)| list.len() / size));
    let mut out: Vec<u8> = counts.flat_map(|n| (n as u32).to_le_bytes()).collect();
    for b in &branches {
        out.extend(b.entry.to_le_bytes());
        out.extend([b.corners, b.functions]);
    }
    out.extend(heads);
    lists.iter().for_each(|list| out.extend(list));
    out
}

#[test]
fn tables_are_what_the_construction_makes() {
    let bytes = generate();
    if let Ok(path) = std::env::var("LAPIDARY_WRITE_TABLES") {
        std::fs::write(path, &bytes).unwrap();
        return;
    }
    let file = include_bytes!("../src/network/simplex/tables.bin");
    assert_eq!(file.len(), bytes.len(), "the size of tables.bin");
    let different = file.iter().zip(&bytes).position(|(a, b)| a != b);
    assert_eq!(different, None, "a byte of tables.bin");
}

/// Compares both ways for one input; with `and_check` also the looked-up complex with exact signs of the values.
fn compare(bench: &mut Bench, kind: Kind, values: &Values, and_check: bool) {
    let expected = bench.incremental(kind, values);
    let (planes, opposite) = (expected.plane_functions.clone(), expected.plane_opposite.clone());
    let (expected, _) = raw(expected);
    let (complex, view) = bench.looked_up(kind, values);
    let (found, _) = raw(complex);
    assert_eq!(found, expected, "{kind:?} of {values:?}");
    if kind == Kind::Arrangement {
        assert_eq!((&complex.plane_functions, &complex.plane_opposite), (&planes, &opposite), "{kind:?} of {values:?}");
    }
    compare_view(&view, complex);
    if and_check && let Err(e) = check(&bench.complex, &bench.flat) {
        panic!("{kind:?} of {values:?}: {e}");
    }
}

/// What is read in place is what is written out.
fn compare_view(view: &View, c: &SimplexComplex) {
    assert_eq!(view.entry.faces.len(), c.face_count());
    for v in 0..view.entry.vertices.len() as u8 {
        let at = view.number(v).at();
        let (carrier, functions) = view.vertex(v);
        assert_eq!(carrier, c.vertex_carrier[at]);
        assert_eq!(functions, mask(c.vertex_functions.row(at)));
        assert_eq!(view.encoding(v), mask(&c.vertex_encoding[at]));
    }
    for (f, support) in c.face_support.iter().enumerate() {
        let face = view.face(f);
        assert_eq!((&face.support, face.cells), (support, c.face_cells[f]));
        assert_eq!(face.functions, mask(c.face_functions(LocalFace::of(f))));
        assert!(face.vertices().map(|v| view.number(v)).eq(c.face_vertices.row(f).iter().copied()));
        let plane = c.plane_functions.range(c.face_plane[f]);
        let opposite = plane.filter(|&at| c.plane_opposite.get(at) == Some(&true));
        assert_eq!(face.opposite, mask(opposite.map(|at| &c.plane_functions.items[at])));
    }
    assert_eq!(view.zero() as u64, c.zero_functions.first().copied().unwrap_or(0));
    for k in (0..c.cell_count()).map(LocalCell::of) {
        match c.kind {
            Kind::Arrangement => assert_eq!(view.label(k) as u64, c.cell_positive[k.at()]),
            Kind::Interface => assert_eq!(view.label(k), mask(c.cell_materials.row(k))),
        }
    }
}

/// All types of all corners, in every order, with several values each.
#[test]
fn every_type_at_every_corner() {
    let mut bench = Bench::default();
    let mut random = Random(5);
    for table in &TABLES {
        let m = table.dim + 1;
        for code in 0..table.types.pow(m as u32) {
            let types: Vec<u8> = (0..m).map(|c| (code / table.types.pow(c as u32) % table.types) as u8).collect();
            for _ in 0..3 {
                let slopes: Vec<u8> = (0..m).map(|_| 1 + random.below(4) as u8).collect();
                compare(&mut bench, table.kind, &values_of(table, &types, &slopes), true);
            }
        }
    }
}

#[test]
fn one_and_two_functions_with_all_small_integers() {
    let mut bench = Bench::default();
    for dim in [2, 3] {
        let m = dim + 1;
        for code in 0..5usize.pow(2 * m as u32) {
            let value = |i: usize| (code / 5usize.pow(i as u32) % 5) as f64 - 2.0;
            let values: Values = (0..2).map(|f| (0..m).map(|c| value(f * m + c)).collect()).collect();
            compare(&mut bench, Kind::Arrangement, &values, false);
            if values[1].iter().all(|&x| x == 0.0) {
                compare(&mut bench, Kind::Arrangement, &values[..1].to_vec(), true);
                compare(&mut bench, Kind::Interface, &values, true);
            }
        }
    }
}

#[test]
fn random_small_integers() {
    let mut bench = Bench::default();
    let mut random = Random(7);
    for i in 0..200_000 {
        let (dim, bound) = (2 + i % 2, 1 + (i / 2 % 4) as i64);
        let mut values =
            |n: usize| -> Values { (0..n).map(|_| (0..=dim).map(|_| random.within(bound)).collect()).collect() };
        compare(&mut bench, Kind::Interface, &values(3), i % 8 == 0);
        compare(&mut bench, Kind::Interface, &values(2), i % 8 == 0);
        compare(&mut bench, Kind::Arrangement, &values(2), i % 8 == 0);
    }
}

/// Reals; the same with points on edges that nearly or wholly coincide; scaled to the ends of the range.
#[test]
fn values_that_are_hard_to_tell_apart() {
    let mut bench = Bench::default();
    let mut random = Random(11);
    let near = |x: f64, random: &mut Random| f64::from_bits((x.to_bits() as i64 + random.within(2) as i64) as u64);
    for i in 0..100_000 {
        let dim = 2 + i % 2;
        let row = |random: &mut Random| -> Vec<f64> { (0..=dim).map(|_| random.signed()).collect() };
        let (f, factor) = (row(&mut random), 1.0 + random.unit());
        // Nearly proportional to f.
        let g: Vec<f64> = f.iter().map(|x| near(x * factor, &mut random)).collect();
        let h = row(&mut random);
        let add = |x: &[f64], y: &[f64]| -> Vec<f64> { x.iter().zip(y).map(|(x, y)| x + y).collect() };
        let scale = [1.0, 2f64.powi(900), 2f64.powi(-900), 2f64.powi(-1060)][i / 2 % 4];
        let scaled = |values: &[&Vec<f64>]| -> Values {
            values.iter().map(|row| row.iter().map(|x| x * scale).collect()).collect()
        };
        compare(&mut bench, Kind::Arrangement, &scaled(&[&f, &g]), i % 8 == 0);
        compare(&mut bench, Kind::Arrangement, &scaled(&[&f, &h]), i % 8 == 0);
        compare(&mut bench, Kind::Interface, &scaled(&[&f, &g, &h]), i % 8 == 0);
        compare(&mut bench, Kind::Interface, &scaled(&[&h, &add(&h, &f), &add(&h, &g)]), i % 8 == 0);
        compare(&mut bench, Kind::Interface, &scaled(&[&f, &g]), i % 8 == 0);
    }
}

/// Every record of the second tier is right or empty, and most combinations of signs on opposite edges exist.
#[test]
fn no_more_than_what_can_be_is_there() {
    let there = BRANCHES.iter().filter(|b| b.entry != Found::NOTHING).count();
    assert!(there >= MAIN.len() && there < BRANCH_COUNT);
    for (t, table) in TABLES.iter().enumerate() {
        for main in mains(t) {
            let all = &BRANCHES[main.first as usize..][..3usize.pow(main.count as u32)];
            for b in all.iter().filter(|b| b.entry != Found::NOTHING) {
                assert_eq!(ENTRIES[b.entry as usize].table, *table);
            }
        }
    }
}

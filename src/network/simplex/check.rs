//! What must hold of a simplex's complex, tested from its arrays and the values alone.
//!
//! Structure: ids in range, faces in the cells that list them, loops that are walked once each way by the two faces at an edge of a cell,
//! Euler's formula for a ball. Geometry: encodings name independent functions; the sets of functions at vertices, on faces and in cells
//! are those that exact signs give, no more and no fewer; each function is nowhere on the wrong side of a cell; cells on the
//! two sides of a face differ exactly where its plane says.
//!
//! Cost: (vertices + half-edges of cells) times functions; for tests and debug builds.

use super::data::*;
use crate::exact::Sign;
use crate::exact::barycentric::{Function, orientation, sign_at};

type Outcome = Result<(), String>;

macro_rules! ensure {
    ($what:expr, $($text:tt)*) => {
        if !$what {
            return Err(format!($($text)*));
        }
    };
}

/// The values that a complex was made from, four a function (a triangle's apex has 0).
fn padded(c: &SimplexComplex, values: &[f64]) -> Vec<[f64; 4]> {
    let m = c.dim + 1;
    let at = |row: &[f64], i: usize| row.get(i).copied().unwrap_or(0.0);
    values.chunks_exact(m).map(|row| std::array::from_fn(|i| at(row, i))).collect()
}

/// Whether a complex is right for the values that it was made from; else what is wrong.
pub fn check(c: &SimplexComplex, values: &[f64]) -> Outcome {
    ensure!(c.dim == 2 || c.dim == 3, "dimension {}", c.dim);
    let values = padded(c, values);
    ensure!(values.len() == c.functions, "{} functions, not {}", c.functions, values.len());
    check_sizes(c)?;
    check_loops(c)?;
    check_cells(c)?;
    check_vertices(c, &values)?;
    match c.kind {
        Kind::Arrangement => check_arrangement(c, &values),
        Kind::Interface => check_interface(c, &values),
    }
}

fn check_sizes(c: &SimplexComplex) -> Outcome {
    let (v, f, n) = (c.vertex_count(), c.face_count(), c.cell_count());
    ensure!(c.vertex_encoding.len() == v && c.vertex_functions.len() == v, "arrays of vertices");
    ensure!(c.face_vertices.len() == f && c.face_cells.len() == f && c.face_plane.len() == f, "arrays of faces");
    ensure!(c.face_edges.len() == if c.dim == 3 { c.face_vertices.items.len() } else { 0 }, "edges of faces");
    ensure!(c.plane_functions.len() > c.face_plane.iter().map(|p| p.at()).max().unwrap_or(0), "planes");
    ensure!(c.plane_functions.offsets.is_sorted() && c.vertex_functions.offsets.is_sorted(), "rows of functions");
    match c.kind {
        Kind::Arrangement => {
            ensure!(c.cell_positive.len() == n * c.label_words(), "labels of cells");
            ensure!(c.zero_functions.len() == c.label_words(), "functions that vanish everywhere");
            ensure!(c.plane_opposite.len() == c.plane_functions.items.len(), "orientations of functions");
        }
        Kind::Interface => ensure!(c.cell_owner.len() == n && c.cell_materials.len() == n, "owners of cells"),
    }
    for i in 0..=c.dim {
        ensure!(c.vertex_carrier[i] == Carrier(1 << i), "vertex {i} is not corner {i}");
    }
    let whole = (1 << (c.dim + 1)) - 1;
    ensure!(c.vertex_carrier.iter().all(|x| x.0 != 0 && x.0 <= whole), "carriers");
    let rising = |row: &[LocalFunction]| row.is_sorted_by(|a, b| a < b) && row.iter().all(|f| f.at() < c.functions);
    ensure!(c.vertex_functions.rows().all(rising), "functions of vertices");
    ensure!(c.plane_functions.rows().all(rising), "functions of planes");
    // A ball: vertices - edges + faces - cells = 1, one dimension down vertices - faces + cells = 1.
    let euler = if c.dim == 3 { v + f == c.edge_count() + n + 1 } else { v + n == f + 1 };
    ensure!(euler, "Euler: {v} vertices, {} edges, {f} faces, {n} cells", c.edge_count());
    Ok(())
}

fn check_loops(c: &SimplexComplex) -> Outcome {
    for f in 0..c.face_count() {
        let f = LocalFace::of(f);
        let row = c.face_vertices.row(f);
        ensure!(row.iter().all(|v| v.at() < c.vertex_count()), "face {f:?}: a vertex that is not there");
        ensure!(if c.dim == 3 { row.len() >= 3 } else { row.len() == 2 }, "face {f:?} has {} corners", row.len());
        let mut sorted = row.to_vec();
        sorted.sort_unstable();
        sorted.dedup();
        ensure!(sorted.len() == row.len(), "face {f:?} has a corner twice");
        if c.dim == 3 {
            for (k, e) in c.edges_of(f).iter().enumerate() {
                let (a, b) = (row[k], row[(k + 1) % row.len()]);
                let ends = c.edges[e.at()];
                ensure!(ends == [a, b] || ends == [b, a], "face {f:?}: edge {e:?} at corner {k}");
            }
        }
    }
    // No two edges between the same vertices; none that no face has.
    let mut edges: Vec<[LocalVertex; 2]> = c.edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    ensure!(edges.is_sorted_by(|a, b| a < b), "two edges between the same vertices");
    let mut used = vec![false; c.edge_count()];
    c.face_edges.iter().for_each(|e| used[e.at()] = true);
    ensure!(used.iter().all(|&u| u), "an edge without a face");
    Ok(())
}

fn check_cells(c: &SimplexComplex) -> Outcome {
    let mut listed = vec![[0; 2]; c.face_count()];
    // Per edge (in 2-D: per vertex), times left minus times entered in the current cell, and times seen.
    let mut balance = vec![[0i32; 2]; if c.dim == 3 { c.edge_count() } else { c.vertex_count() }];
    for cell in 0..c.cell_count() {
        let halves = c.cell_faces.row(cell);
        ensure!(halves.len() > c.dim, "cell {cell} has {} faces", halves.len());
        let visit = |balance: &mut Vec<[i32; 2]>, half: LocalHalfFace| {
            let row = c.face_vertices.row(half.face());
            // Seen from outside of the cell, a face's loop runs as it does seen from its positive side if that is outside.
            let way = if half.side() == 1 { 1 } else { -1 };
            let mut add = |i: usize, way: i32| {
                balance[i][0] += way;
                balance[i][1] += 1;
            };
            if c.dim == 2 {
                add(row[0].at(), way);
                add(row[1].at(), -way);
                return;
            }
            for (&v, e) in row.iter().zip(c.edges_of(half.face())) {
                add(e.at(), if c.edges[e.at()][0] == v { way } else { -way });
            }
        };
        for &half in halves {
            listed[half.face().at()][half.side()] += 1;
            ensure!(c.face_cells[half.face().at()][half.side()].at() == cell, "cell {cell} lists {half:?}");
            visit(&mut balance, half);
        }
        for &half in halves {
            let row = c.face_vertices.row(half.face()).iter().map(|v| v.at());
            let edges = c.edges_of_or_none(half.face()).iter().map(|e| e.at());
            let mut ids: Vec<usize> = if c.dim == 3 { edges.collect() } else { row.collect() };
            for i in ids.drain(..) {
                ensure!(
                    balance[i] == [0, 2] || balance[i] == [0, 0],
                    "cell {cell} is not closed at {i}: {:?}",
                    balance[i]
                );
                balance[i] = [0; 2];
            }
        }
    }
    for (f, cells) in c.face_cells.iter().enumerate() {
        for side in 0..2 {
            let expected = cells[side].is_some() as i32;
            ensure!(listed[f][side] == expected, "face {f}: {} cells list side {side}", listed[f][side]);
        }
        let facet = matches!(c.face_support[f], FaceSupport::Facet(_));
        ensure!(cells[0].is_some() && cells[1].is_none() == facet, "face {f}: cells {cells:?}");
        if let FaceSupport::Facet(k) = c.face_support[f] {
            ensure!(!c.face_carrier(LocalFace::of(f)).has(k as usize), "face {f} is not on facet {k}");
        }
    }
    Ok(())
}

impl SimplexComplex {
    fn edges_of_or_none(&self, f: LocalFace) -> &[LocalEdge] {
        if self.dim == 3 { self.edges_of(f) } else { &[] }
    }
}

/// The sign of a function (interface: of its difference to the envelope) at a vertex, from the encoding.
fn sign(c: &SimplexComplex, values: &[[f64; 4]], f: usize, v: LocalVertex) -> Sign {
    let (through, base) = through(c, values, v);
    let of = match base {
        Some(base) => Function::Difference(&values[f], base),
        None => Function::Values(&values[f]),
    };
    sign_at(c.vertex_carrier[v.at()].0, &through, of)
}

/// The functions (or differences to the first material) that fix a vertex, and that first material's values.
fn through<'a>(c: &SimplexComplex, values: &'a [[f64; 4]], v: LocalVertex) -> (Vec<Function<'a>>, Option<&'a [f64]>) {
    let ids = c.vertex_encoding[v.at()].iter().filter(|f| f.is_some()).map(|f| &values[f.at()][..]);
    match c.kind {
        Kind::Arrangement => (ids.map(Function::Values).collect(), None),
        Kind::Interface => {
            let base = ids.clone().next().expect("a material");
            (ids.skip(1).map(|f| Function::Difference(f, base)).collect(), Some(base))
        }
    }
}

fn check_vertices(c: &SimplexComplex, values: &[[f64; 4]]) -> Outcome {
    let everywhere = |f: usize| c.kind == Kind::Arrangement && values[f].iter().all(|&x| x == 0.0);
    for v in (0..c.vertex_count()).map(LocalVertex::of) {
        let carrier = c.vertex_carrier[v.at()];
        let (through, _) = through(c, values, v);
        ensure!(through.len() == carrier.dim(), "vertex {v:?}: {} functions on {carrier:?}", through.len());
        ensure!(!orientation(carrier.0, &through).is_zero(), "vertex {v:?} is not a point");
        let row = c.vertex_functions.row(v);
        for f in 0..values.len() {
            let s = sign(c, values, f, v);
            ensure!(c.kind == Kind::Arrangement || s != Sign::Positive, "vertex {v:?} is below material {f}");
            let listed = row.binary_search(&LocalFunction::of(f)).is_ok();
            ensure!(listed == (s.is_zero() && !everywhere(f)), "vertex {v:?}: function {f} is {s:?}, listed: {listed}");
        }
    }
    Ok(())
}

/// The functions that all corners of a face have.
fn shared(c: &SimplexComplex, f: usize) -> Vec<LocalFunction> {
    let row = c.face_vertices.row(f);
    let mut set = c.vertex_functions.row(row[0]).to_vec();
    for &v in row {
        set.retain(|f| c.vertex_functions.row(v).binary_search(f).is_ok());
    }
    set
}

fn check_arrangement(c: &SimplexComplex, values: &[[f64; 4]]) -> Outcome {
    for cell in (0..c.cell_count()).map(LocalCell::of) {
        for f in 0..values.len() {
            let label = c.cell_sign(cell, LocalFunction::of(f));
            let mut seen = Sign::Zero;
            for half in c.cell_faces.row(cell) {
                for &v in c.face_vertices.row(half.face()) {
                    let s = sign(c, values, f, v);
                    ensure!(s.is_zero() || s == label, "cell {cell:?}: function {f} is {label:?}, {s:?} at {v:?}");
                    seen = if s.is_zero() { seen } else { s };
                }
            }
            ensure!(seen == label, "cell {cell:?}: function {f} is {label:?}, but {seen:?}");
        }
    }
    for f in 0..c.face_count() {
        let plane = c.face_plane[f];
        let row = c.plane_functions.row(plane);
        ensure!(row == shared(c, f), "face {f} is on {row:?}, its corners on {:?}", shared(c, f));
        let [front, back] = c.face_cells[f];
        match c.face_support[f] {
            FaceSupport::Facet(k) => ensure!(plane.at() == k as usize, "face {f} on facet {k} has plane {plane:?}"),
            support => {
                ensure!(support == FaceSupport::Function(row[0]), "face {f}: {support:?} of {row:?}");
                for g in (0..values.len()).map(LocalFunction::of) {
                    let differ = c.cell_sign(front, g) != c.cell_sign(back, g);
                    ensure!(differ == row.contains(&g), "face {f}: function {g:?} on its sides");
                }
            }
        }
        for (g, at) in row.iter().zip(c.plane_functions.range(plane)) {
            let s = if c.plane_opposite[at] { Sign::Negative } else { Sign::Positive };
            ensure!(c.cell_sign(front, *g) == s, "face {f}: orientation of {g:?}");
        }
    }
    Ok(())
}

fn check_interface(c: &SimplexComplex, values: &[[f64; 4]]) -> Outcome {
    for cell in 0..c.cell_count() {
        let owner = c.cell_owner[cell];
        ensure!(c.cell_owner[..cell].iter().all(|&o| o < owner), "owners of cells do not rise");
        let vertices = || c.cell_faces.row(cell).iter().flat_map(|h| c.face_vertices.row(h.face()));
        for &v in vertices() {
            ensure!(c.vertex_functions.row(v).contains(&owner), "cell {cell}: {owner:?} is not largest at {v:?}");
        }
        let equal: Vec<_> =
            (0..values.len()).filter(|&m| values[m] == values[owner.at()]).map(LocalFunction::of).collect();
        ensure!(c.cell_materials.row(cell) == equal, "cell {cell}: materials {:?}", c.cell_materials.row(cell));
        ensure!(equal[0] == owner, "cell {cell}: {owner:?} is not the first of {equal:?}");
    }
    for f in 0..c.face_count() {
        let row = c.plane_functions.row(c.face_plane[f]);
        ensure!(row == shared(c, f), "face {f} is on {row:?}, its corners on {:?}", shared(c, f));
        if let FaceSupport::Pair(a, b) = c.face_support[f] {
            let owners = c.face_cells[f].map(|cell| c.cell_owner[cell.at()]);
            ensure!(owners == [a, b] && a < b, "face {f}: {a:?}, {b:?} between {owners:?}");
        }
    }
    Ok(())
}

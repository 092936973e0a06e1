//! Small complexes, built from definitions with rationals: triangles split by planes one at a time, sections clipped or
//! listed by hand, vertices named by searching their carriers. Nothing here shares a formula with the library.
#![allow(dead_code)]

use lapidary::base::{CellId, ComponentId, Csr, EdgeId, FaceId, PlaneId, Run, TriangleId, VertexId};
use lapidary::complex::{Complex, HalfFace, Origin, SupportId, adjacency};
use lapidary::exact::{self, Plane};
use lapidary::mesh::{MeshInput, MeshOptions, TriMesh, build};
use rug::Rational;
use std::collections::BTreeMap;
use std::sync::Arc;

pub type P = [Rational; 3];
/// Vertices and triangles.
pub type Arrays = (Vec<[f64; 3]>, Vec<[i32; 3]>);

pub fn point(x: [f64; 3]) -> P {
    x.map(|x| Rational::from_f64(x).unwrap())
}

pub fn minus(a: &P, b: &P) -> P {
    std::array::from_fn(|i| Rational::from(&a[i] - &b[i]))
}

pub fn dot(a: &P, b: &P) -> Rational {
    (0..3).fold(Rational::new(), |s, i| s + Rational::from(&a[i] * &b[i]))
}

pub fn cross(a: &P, b: &P) -> P {
    let minor = |i: usize, j: usize| Rational::from(&a[i] * &b[j]) - Rational::from(&a[j] * &b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn value(p: &Plane, x: &P) -> Rational {
    dot(&point(p.n), x) + Rational::from_f64(p.d).unwrap()
}

fn along(a: &P, b: &P, t: &Rational) -> P {
    std::array::from_fn(|i| Rational::from(&b[i] - &a[i]) * t + &a[i])
}

/// The parts of a convex polygon where `value` is negative and positive (a polygon in the zero set is in neither).
fn split(polygon: &[P], values: &[Rational]) -> [Vec<P>; 2] {
    let mut parts = [Vec::new(), Vec::new()];
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        let (a, b) = (&values[i], &values[j]);
        for (k, part) in parts.iter_mut().enumerate() {
            if a.is_zero() || (*a > 0) == (k == 1) {
                part.push(polygon[i].clone());
            }
        }
        if *a < 0 && *b > 0 || *a > 0 && *b < 0 {
            let x = along(&polygon[i], &polygon[j], &(a / Rational::from(a - b)));
            parts[0].push(x.clone());
            parts[1].push(x);
        }
    }
    // A part without a vertex off the plane is only the contact.
    for (k, part) in parts.iter_mut().enumerate() {
        if !values.iter().any(|v| !v.is_zero() && (*v > 0) == (k == 1)) {
            part.clear();
        }
    }
    parts
}

struct Piece {
    support: SupportId,
    plane: PlaneId,
    loops: Vec<Vec<P>>,
    /// Behind, before.
    cells: [Option<u32>; 2],
}

/// Collects faces, then makes a complex of them.
pub struct Builder {
    pub mesh: Arc<TriMesh>,
    pub planes: Vec<Plane>,
    pieces: Vec<Piece>,
}

pub fn mesh(vertices: &[[f64; 3]], triangles: &[[i32; 3]]) -> Arc<TriMesh> {
    let input = MeshInput { vertices, triangles, tags: None };
    Arc::new(build(&input, &MeshOptions::default(), &mut Run::quiet()).expect("a valid mesh"))
}

impl Builder {
    pub fn new(mesh: Arc<TriMesh>, planes: &[Plane]) -> Self {
        Self { mesh, planes: planes.to_vec(), pieces: Vec::new() }
    }

    /// Splits every triangle by every plane; `cell` names the cell behind a piece by its sides of all planes and its
    /// triangle.
    pub fn triangles(&mut self, cell: &dyn Fn(&[i8], TriangleId) -> u32) {
        for t in (0..self.mesh.triangles.len()).map(TriangleId::of) {
            let corners = self.mesh.corners(t).map(point);
            let n = cross(&minus(&corners[1], &corners[0]), &minus(&corners[2], &corners[0]));
            let mut pieces = vec![(corners.to_vec(), Vec::new())];
            let mut plane = PlaneId::NONE;
            for (i, p) in self.planes.iter().enumerate() {
                let mut next = Vec::new();
                for (polygon, signs) in pieces {
                    let values: Vec<Rational> = polygon.iter().map(|x| value(p, x)).collect();
                    if values.iter().all(|v| v.is_zero()) {
                        plane = plane.min(PlaneId::of(i));
                        let side = if dot(&n, &point(p.n)) > 0 { -1 } else { 1 };
                        next.push((polygon, with(&signs, side)));
                        continue;
                    }
                    for (k, part) in split(&polygon, &values).into_iter().enumerate() {
                        if !part.is_empty() {
                            next.push((part, with(&signs, 2 * k as i8 - 1)));
                        }
                    }
                }
                pieces = next;
            }
            for (polygon, signs) in pieces {
                let cells = [Some(cell(&signs, t)), None];
                self.pieces.push(Piece { support: SupportId::Triangle(t), plane, loops: vec![polygon], cells });
            }
        }
    }

    /// A face on a plane, from its loops (counter-clockwise about the normal, holes clockwise) in integer coordinates.
    pub fn section(&mut self, plane: usize, behind: u32, before: u32, loops: &[&[[i32; 3]]]) {
        let loops = loops.iter().map(|l| l.iter().map(|p| p.map(Rational::from)).collect()).collect();
        let plane = PlaneId::of(plane);
        let cells = [Some(behind), Some(before)];
        self.pieces.push(Piece { support: SupportId::Plane(plane), plane, loops, cells });
    }

    /// All sections of a convex solid, split by the other planes; cells are named by sides.
    pub fn convex_sections(&mut self, cell: &dyn Fn(&[i8]) -> u32) {
        for (i, p) in self.planes.clone().iter().enumerate() {
            let triangles: Vec<[P; 3]> =
                (0..self.mesh.triangles.len()).map(|t| self.mesh.corners(TriangleId::of(t)).map(point)).collect();
            let outward = |t: &[P; 3]| cross(&minus(&t[1], &t[0]), &minus(&t[2], &t[0]));
            if triangles.iter().any(|t| t.iter().all(|x| value(p, x).is_zero())) {
                continue;
            }
            let mut pieces = vec![(square(p, &self.mesh), Vec::new())];
            for t in &triangles {
                let n = outward(t);
                let inside = |x: &P| dot(&n, &minus(x, &t[0]));
                let polygon = std::mem::take(&mut pieces[0].0);
                let values: Vec<Rational> = polygon.iter().map(inside).collect();
                pieces[0].0 = split(&polygon, &values)[0].clone();
                if pieces[0].0.is_empty() {
                    break;
                }
            }
            if pieces[0].0.is_empty() {
                continue;
            }
            for (j, q) in self.planes.iter().enumerate() {
                let mut next = Vec::new();
                for (polygon, signs) in pieces {
                    if i == j {
                        next.push((polygon, with(&signs, 0)));
                        continue;
                    }
                    let values: Vec<Rational> = polygon.iter().map(|x| value(q, x)).collect();
                    for (k, part) in split(&polygon, &values).into_iter().enumerate() {
                        if !part.is_empty() {
                            next.push((part, with(&signs, 2 * k as i8 - 1)));
                        }
                    }
                }
                pieces = next;
            }
            for (polygon, signs) in pieces {
                let side = |s: i8| {
                    let mut all = signs.clone();
                    all[i] = s;
                    Some(cell(&all))
                };
                let cells = [side(-1), side(1)];
                let plane = PlaneId::of(i);
                self.pieces.push(Piece { support: SupportId::Plane(plane), plane, loops: vec![polygon], cells });
            }
        }
    }

    /// The complex: edges subdivided at every vertex on them, cells renumbered without gaps, shells by adjacency.
    pub fn build(self) -> Complex {
        let mut ids: BTreeMap<P, u32> = BTreeMap::new();
        for x in self.pieces.iter().flat_map(|p| p.loops.iter().flatten()) {
            ids.insert(x.clone(), 0);
        }
        let points: Vec<P> = ids.keys().cloned().collect();
        for (i, id) in ids.values_mut().enumerate() {
            *id = i as u32;
        }
        let mut c = Complex { mesh: self.mesh.clone(), planes: self.planes.clone(), ..Complex::default() };
        for x in &points {
            let on = (0..self.planes.len()).filter(|&p| value(&self.planes[p], x).is_zero());
            let on: Vec<PlaneId> = on.map(PlaneId::of).collect();
            c.origins.push(origin(&self.mesh, &self.planes, &on, x));
            c.vertex_planes.push_row(&on);
        }
        c.coords = (0..points.len()).map(|v| exact::round(&c.point(VertexId::of(v)))).collect();
        let mut edges: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut cells: BTreeMap<u32, u32> = BTreeMap::new();
        c.face_loops = vec![0];
        c.loop_offsets = vec![0];
        for piece in &self.pieces {
            for l in &piece.loops {
                let start = c.corner_vertices.len();
                for i in 0..l.len() {
                    let (a, b) = (&l[i], &l[(i + 1) % l.len()]);
                    c.corner_vertices.push(VertexId(ids[a]));
                    let d = minus(b, a);
                    // Vertices strictly between, in order.
                    let mut between: Vec<(Rational, u32)> = Vec::new();
                    for (x, &id) in &ids {
                        let e = minus(x, a);
                        let t = dot(&e, &d);
                        if t > 0 && t < dot(&d, &d) && cross(&e, &d).iter().all(|x| x.is_zero()) {
                            between.push((t, id));
                        }
                    }
                    between.sort();
                    c.corner_vertices.extend(between.iter().map(|(_, id)| VertexId(*id)));
                }
                let n = c.corner_vertices.len();
                for k in start..n {
                    let (a, b) = (c.corner_vertices[k].0, c.corner_vertices[if k + 1 == n { start } else { k + 1 }].0);
                    if n == start + 1 {
                        c.corner_edges.push(EdgeId::NONE);
                    } else {
                        let next = edges.len() as u32;
                        c.corner_edges.push(EdgeId(*edges.entry([a.min(b), a.max(b)]).or_insert(next)));
                    }
                }
                c.loop_offsets.push(n as u32);
            }
            c.face_loops.push(c.loop_offsets.len() as u32 - 1);
            c.face_support.push(piece.support);
            c.face_plane.push(piece.plane);
            c.face_tag.push(0);
            c.face_cells.push(piece.cells.map(|k| match k {
                None => CellId::NONE,
                Some(k) => {
                    let next = cells.len() as u32;
                    CellId(*cells.entry(k).or_insert(next))
                }
            }));
        }
        c.edges = vec![[VertexId(0); 2]; edges.len()];
        for ([a, b], e) in edges {
            c.edges[e as usize] = [VertexId(a), VertexId(b)];
        }
        c.cell_component = vec![ComponentId(0); cells.len()];
        add_shells(&mut c);
        c
    }
}

fn with(signs: &[i8], s: i8) -> Vec<i8> {
    let mut all = signs.to_vec();
    all.push(s);
    all
}

/// A quadrilateral in a plane that covers a mesh, counter-clockwise about the normal.
fn square(p: &Plane, mesh: &TriMesh) -> Vec<P> {
    let n = point(p.n);
    let axis = (0..3).find(|&i| !n[i].is_zero()).unwrap();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let size = mesh.vertices.iter().flatten().fold(0.0, |s: f64, x| s.max(x.abs()));
    let size = Rational::from_f64(2.0 * size).unwrap();
    let mut corners: Vec<P> = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
        .iter()
        .map(|s| {
            let mut x: P = Default::default();
            x[u] = size.clone() * s[0];
            x[v] = size.clone() * s[1];
            let rest = value(p, &x);
            x[axis] = -rest / &n[axis];
            x
        })
        .collect();
    if n[axis] < 0 {
        corners.reverse();
    }
    corners
}

/// The lowest-dimensional carrier of a point, and the lowest planes that fix it there.
fn origin(mesh: &TriMesh, planes: &[Plane], on: &[PlaneId], x: &P) -> Origin {
    if let Some(v) = mesh.vertices.iter().position(|v| point(*v) == *x) {
        return Origin::Mesh(VertexId::of(v));
    }
    for (e, ends) in mesh.edges.iter().enumerate() {
        let [a, b] = ends.map(|v| point(mesh.vertices[v.at()]));
        let (d, w) = (minus(&b, &a), minus(x, &a));
        let t = dot(&w, &d);
        if cross(&d, &w).iter().all(|x| x.is_zero()) && t > 0 && t < dot(&d, &d) {
            let p = on.iter().find(|p| !dot(&point(planes[p.at()].n), &d).is_zero()).expect("a plane crosses the edge");
            return Origin::Edge(EdgeId::of(e), *p);
        }
    }
    let normal = |p: PlaneId| point(planes[p.at()].n);
    for t in (0..mesh.triangles.len()).map(TriangleId::of) {
        let k = mesh.corners(t).map(point);
        let n = cross(&minus(&k[1], &k[0]), &minus(&k[2], &k[0]));
        let left = |i: usize| dot(&n, &cross(&minus(&k[(i + 1) % 3], &k[i]), &minus(x, &k[i]))) > 0;
        if dot(&n, &minus(x, &k[0])).is_zero() && (0..3).all(left) {
            for (i, &p) in on.iter().enumerate() {
                for &q in &on[i + 1..] {
                    if !dot(&n, &cross(&normal(p), &normal(q))).is_zero() {
                        return Origin::Triangle(t, p, q);
                    }
                }
            }
        }
    }
    for (i, &p) in on.iter().enumerate() {
        for (j, &q) in on.iter().enumerate().skip(i + 1) {
            for &r in &on[j + 1..] {
                if !dot(&normal(p), &cross(&normal(q), &normal(r))).is_zero() {
                    return Origin::Planes(p, q, r);
                }
            }
        }
    }
    panic!("a point on too few carriers");
}

/// Shells from adjacency; the outer shell (positive volume) first.
fn add_shells(c: &mut Complex) {
    let a = adjacency(c).expect("half-faces pair up");
    let mut label: Vec<usize> = (0..2 * c.face_count()).collect();
    loop {
        let mut changed = false;
        for (h, &m) in a.mates.iter().enumerate() {
            if m.is_none() {
                continue;
            }
            let (x, y) = (HalfFace::new(a.corner_face[h / 2], h % 2 == 1).at(), a.half_face(m).at());
            let low = label[x].min(label[y]);
            changed |= label[x] != low || label[y] != low;
            (label[x], label[y]) = (low, low);
        }
        if !changed {
            break;
        }
    }
    c.cell_shells = vec![0];
    for cell in (0..c.cell_count()).map(CellId::of) {
        let mut shells: BTreeMap<usize, Vec<HalfFace>> = BTreeMap::new();
        for h in (0..2 * c.face_count() as u32).map(HalfFace) {
            if c.face_cells[h.face().at()][h.front() as usize] == cell {
                shells.entry(label[h.at()]).or_default().push(h);
            }
        }
        let mut rows: Vec<Vec<HalfFace>> = shells.into_values().collect();
        rows.sort_by_key(|r| r.iter().fold(Rational::new(), |s, h| s + signed_cone(c, *h)) < 0);
        for row in rows {
            c.shell_faces.push_row(&row);
        }
        c.cell_shells.push(c.shell_faces.len() as u32);
    }
}

pub fn coordinates(c: &Complex, v: VertexId) -> P {
    exact::rational(&c.point(v))
}

/// The triangles of a fan over each loop: signed, they cover the face.
pub fn fans(c: &Complex, f: FaceId) -> Vec<[P; 3]> {
    let mut out = Vec::new();
    for l in c.loops_of(f) {
        let x: Vec<P> = c.corners_of(l).map(|k| coordinates(c, c.corner_vertices[k])).collect();
        for i in 1..x.len().saturating_sub(1) {
            out.push([x[0].clone(), x[i].clone(), x[i + 1].clone()]);
        }
    }
    out
}

/// Six times the signed volume between the origin and a half-face.
pub fn signed_cone(c: &Complex, h: HalfFace) -> Rational {
    let sum = fans(c, h.face()).iter().fold(Rational::new(), |s, [a, b, d]| s + dot(a, &cross(b, d)));
    if h.front() { -sum } else { sum }
}

/// The volume and the centroid of a cell, by tetrahedra from the origin.
pub fn cell_by_tetrahedra(c: &Complex, k: CellId) -> (Rational, P) {
    let (mut six, mut first): (Rational, P) = Default::default();
    for h in c.cell_faces(k) {
        for t in fans(c, h.face()) {
            let det = dot(&t[0], &cross(&t[1], &t[2]));
            let det = if h.front() { -det } else { det };
            for i in 0..3 {
                first[i] += Rational::from(&t[0][i] + &t[1][i]) * &det + Rational::from(&t[2][i] * &det);
            }
            six += det;
        }
    }
    let divisor = Rational::from(&six * 4);
    (six / 6, first.map(|x| x / &divisor))
}

/// The area vector and the centroid of a face, by triangles.
pub fn face_by_triangles(c: &Complex, f: FaceId) -> (P, P) {
    let mut area: P = Default::default();
    let triangles = fans(c, f);
    for [a, b, d] in &triangles {
        let n = cross(&minus(b, a), &minus(d, a));
        for i in 0..3 {
            area[i] += n[i].clone() / 2;
        }
    }
    // Weights along the area vector are signed areas times a constant.
    let (mut sum, mut first): (Rational, P) = Default::default();
    for [a, b, d] in &triangles {
        let w = dot(&area, &cross(&minus(b, a), &minus(d, a)));
        for i in 0..3 {
            first[i] += (Rational::from(&a[i] + &b[i]) + &d[i]) * &w / 3;
        }
        sum += w;
    }
    let centroid = first.map(|x| x / &sum);
    (area, centroid)
}

/// A box's vertices and triangles; `inward` for the wall of a void.
pub fn cuboid(low: [f64; 3], high: [f64; 3], base: i32, inward: bool) -> Arrays {
    let vertices = (0..8).map(|i| std::array::from_fn(|a| if i >> a & 1 == 1 { high[a] } else { low[a] })).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut triangles = Vec::new();
    for [a, b, c, d] in quads.map(|q: [i32; 4]| q.map(|i| i + base)) {
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    if inward {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    (vertices, triangles)
}

fn join(parts: Vec<Arrays>) -> Arc<TriMesh> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (v, t) in parts {
        vertices.extend(v);
        triangles.extend(t);
    }
    mesh(&vertices, &triangles)
}

pub fn plane(n: [f64; 3], d: f64) -> Plane {
    Plane { n, d }
}

/// The uncut solid of a mesh with one cell.
pub fn uncut(mesh: Arc<TriMesh>) -> Complex {
    let mut b = Builder::new(mesh, &[]);
    b.triangles(&|_, _| 0);
    b.build()
}

/// Any planes through a convex solid: a cell is a vector of sides.
pub fn convex_cut(mesh: Arc<TriMesh>, planes: &[Plane]) -> Complex {
    let name = |signs: &[i8]| signs.iter().fold(1, |k, &s| 2 * k + (s > 0) as u32);
    let mut b = Builder::new(mesh, planes);
    b.triangles(&|signs, _| name(signs));
    b.convex_sections(&name);
    b.build()
}

pub fn cube() -> Complex {
    uncut(join(vec![cuboid([0.0; 3], [2.0; 3], 0, false)]))
}

pub fn cube_in_two() -> Complex {
    convex_cut(join(vec![cuboid([0.0; 3], [2.0; 3], 0, false)]), &[plane([0.0, 0.0, 1.0], -1.0)])
}

/// A cube of side 6 under any planes.
pub fn cut_cube(planes: &[Plane]) -> Complex {
    convex_cut(join(vec![cuboid([0.0; 3], [6.0; 3], 0, false)]), planes)
}

pub fn cube_with_void() -> Complex {
    uncut(join(vec![cuboid([0.0; 3], [6.0; 3], 0, false), cuboid([2.0; 3], [4.0; 3], 8, true)]))
}

/// The cube with a void, cut through both: the section is a square with a square hole.
pub fn square_hole() -> Complex {
    let mesh = join(vec![cuboid([0.0; 3], [6.0; 3], 0, false), cuboid([2.0; 3], [4.0; 3], 8, true)]);
    let mut b = Builder::new(mesh, &[plane([0.0, 0.0, 1.0], -3.0)]);
    b.triangles(&|signs, _| (signs[0] > 0) as u32);
    let hole: &[[i32; 3]] = &[[2, 2, 3], [2, 4, 3], [4, 4, 3], [4, 2, 3]];
    b.section(0, 0, 1, &[&OUTER, hole]);
    b.build()
}

const OUTER: [[i32; 3]; 4] = [[0, 0, 3], [6, 0, 3], [6, 6, 3], [0, 6, 3]];

/// A void whose lowest vertex lies on the plane: the section has an isolated vertex.
pub fn touching_vertex() -> Complex {
    let void = [[3.0, 3.0, 3.0], [2.0, 2.0, 4.0], [4.0, 2.0, 4.0], [3.0, 4.0, 4.0]];
    let walls = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]].map(|t: [i32; 3]| t.map(|i| i + 8));
    let mesh = join(vec![cuboid([0.0; 3], [6.0; 3], 0, false), (void.to_vec(), walls.to_vec())]);
    let mut b = Builder::new(mesh, &[plane([0.0, 0.0, 1.0], -3.0)]);
    b.triangles(&|signs, _| (signs[0] > 0) as u32);
    b.section(0, 0, 1, &[&OUTER, &[[3, 3, 3]]]);
    b.build()
}

/// A void whose lowest edge lies on the plane: the section has a slit, around which the upper cell has two wedges.
pub fn touching_edge() -> Complex {
    let void = [[2.0, 3.0, 3.0], [4.0, 3.0, 3.0], [3.0, 2.0, 5.0], [3.0, 4.0, 5.0]];
    let walls = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t: [i32; 3]| t.map(|i| i + 8));
    let mesh = join(vec![cuboid([0.0; 3], [6.0; 3], 0, false), (void.to_vec(), walls.to_vec())]);
    let mut b = Builder::new(mesh, &[plane([0.0, 0.0, 1.0], -3.0)]);
    b.triangles(&|signs, _| (signs[0] > 0) as u32);
    b.section(0, 0, 1, &[&OUTER, &[[2, 3, 3], [4, 3, 3]]]);
    b.build()
}

/// Two tetrahedra that share one vertex: two cells.
pub fn two_tetrahedra() -> Complex {
    let v = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
        [0.0, 0.0, 1.0],
        [-1.0, 0.0, -1.0],
        [0.0, -1.0, -1.0],
        [0.0, 0.0, -1.0],
    ];
    let one = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let two = [[0, 4, 5], [0, 6, 4], [0, 5, 6], [4, 6, 5]];
    let mesh = mesh(&v, &[one, two].concat());
    let mut b = Builder::new(mesh, &[]);
    b.triangles(&|_, t| (t.0 >= 4) as u32);
    let mut c = b.build();
    c.cell_component = vec![ComponentId(0), ComponentId(1)];
    c
}

/// The surface of some of the unit cubes of a lattice, as triangles.
pub fn voxels(filled: &dyn Fn([i32; 3]) -> bool, size: i32) -> Arc<TriMesh> {
    let mut ids: BTreeMap<[i32; 3], i32> = BTreeMap::new();
    let mut triangles = Vec::new();
    let mut vertices = Vec::new();
    for (x, y, z) in (0..size).flat_map(|x| (0..size).flat_map(move |y| (0..size).map(move |z| (x, y, z)))) {
        if !filled([x, y, z]) {
            continue;
        }
        for axis in 0..3 {
            for up in [false, true] {
                let mut other = [x, y, z];
                other[axis] += if up { 1 } else { -1 };
                if filled(other) {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let mut quad = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| {
                    let mut p = [x, y, z];
                    p[axis] += up as i32;
                    (p[u], p[v]) = (p[u] + i, p[v] + j);
                    *ids.entry(p).or_insert_with(|| {
                        vertices.push(p.map(f64::from));
                        vertices.len() as i32 - 1
                    })
                });
                if !up {
                    quad.reverse();
                }
                triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
            }
        }
    }
    mesh(&vertices, &triangles)
}

/// A square ring of eight boxes.
pub fn ring() -> Arc<TriMesh> {
    voxels(&|[x, y, z]| z == 0 && (0..3).contains(&x) && (0..3).contains(&y) && (x != 1 || y != 1), 3)
}

/// The ring cut across the hole into two halves, at x = 3/2: the section is two separate squares.
pub fn ring_in_two() -> Complex {
    let mut b = Builder::new(ring(), &[plane([2.0, 0.0, 0.0], -3.0)]);
    b.triangles(&|signs, _| (signs[0] > 0) as u32);
    for y in [0.0, 2.0] {
        let corner = |dy: f64, z: f64| point([1.5, y + dy, z]);
        let square = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        let (support, plane) = (SupportId::Plane(PlaneId(0)), PlaneId(0));
        b.pieces.push(Piece { support, plane, loops: vec![square], cells: [Some(0), Some(1)] });
    }
    b.build()
}

/// Every small complex, by name.
pub fn all() -> Vec<(&'static str, Complex)> {
    let p = |n, d| plane(n, d);
    vec![
        ("cube", cube()),
        ("cube in two", cube_in_two()),
        ("cube with void", cube_with_void()),
        ("square hole", square_hole()),
        ("touching vertex", touching_vertex()),
        ("touching edge", touching_edge()),
        ("two tetrahedra", two_tetrahedra()),
        ("pit", pit(&[], &|_| ())),
        ("pit on a plane", pit(&[p([0.0, 0.0, 1.0], -3.0)], &|b| b.section(0, 0, 1, &[&OUTER, &[[3, 3, 3]]]))),
        (
            "pit on a line",
            pit(&[p([0.0, 0.0, 2.0], -6.0), p([0.0, 1.0, -1.0], 0.0)], &|b| {
                // The second plane leans away from the pit and touches it at its tip, as the first does.
                b.section(0, 0, 2, &[&[[0, 0, 3], [6, 0, 3], [6, 3, 3], [3, 3, 3], [0, 3, 3]]]);
                b.section(0, 1, 3, &[&[[0, 3, 3], [3, 3, 3], [6, 3, 3], [6, 6, 3], [0, 6, 3]]]);
                b.section(1, 0, 1, &[&[[0, 0, 0], [0, 3, 3], [3, 3, 3], [6, 3, 3], [6, 0, 0]]]);
                b.section(1, 2, 3, &[&[[0, 3, 3], [0, 6, 6], [6, 6, 6], [6, 3, 3], [3, 3, 3]]]);
            }),
        ),
        ("ring", uncut(ring())),
        ("ring in two", ring_in_two()),
        ("diagonal", cut_cube(&[p([1.0, 1.0, 1.0], -6.0), p([1.0, -1.0, 0.0], 0.0), p([0.0, 0.0, 1.0], -6.0)])),
        ("pencil", cut_cube(&[p([1.0, 0.0, 0.0], -3.0), p([0.0, 1.0, 0.0], -3.0), p([1.0, 1.0, 0.0], -6.0)])),
        (
            "grid",
            cut_cube(&[
                p([1.0, 0.0, 0.0], -2.0),
                p([1.0, 0.0, 0.0], -4.0),
                p([0.0, 1.0, 0.0], -1.1),
                p([0.0, 1.0, 0.0], -4.7),
                p([0.0, 0.0, 1.0], -0.3),
                p([0.0, 0.0, 3.0], -5.0),
            ]),
        ),
        (
            "askew",
            cut_cube(&[
                p([0.3, 0.7, -0.2], -1.9),
                p([1.7, -0.4, 0.9], -4.1),
                p([0.11, 0.13, 1.1], -3.3),
                p([-0.5, 0.9, 0.4], -0.7),
            ]),
        ),
    ]
}

/// A complex of one face on a plane and nothing else (its vertices are mesh vertices): for what looks at faces alone.
/// `points[i]` is in the plane; loops index points.
pub fn flat_face(points: &[[f64; 3]], support: Plane, loops: &[Vec<u32>]) -> Complex {
    let mut c = Complex::default();
    let mesh = TriMesh { vertices: points.to_vec(), ..TriMesh::default() };
    c.mesh = Arc::new(mesh);
    c.planes = vec![support];
    c.origins = (0..points.len()).map(|v| Origin::Mesh(VertexId::of(v))).collect();
    c.coords = points.to_vec();
    c.vertex_planes = Csr::from_pairs(points.len(), (0..points.len()).map(|v| (v, PlaneId(0))));
    c.loop_offsets = vec![0];
    for l in loops {
        c.corner_vertices.extend(l.iter().map(|&v| VertexId(v)));
        c.corner_edges.extend(l.iter().map(|_| EdgeId::NONE));
        c.loop_offsets.push(c.corner_vertices.len() as u32);
    }
    c.face_loops = vec![0, loops.len() as u32];
    c.face_support = vec![SupportId::Plane(PlaneId(0))];
    c.face_plane = vec![PlaneId(0)];
    c.face_tag = vec![0];
    c.face_cells = vec![[CellId::NONE; 2]];
    c
}

/// A cube of side 6 with a pit in its top, a pyramid with its tip at (3, 3, 3); a cell is a vector of sides.
pub fn pit(planes: &[Plane], sections: &dyn Fn(&mut Builder)) -> Complex {
    let (mut vertices, mut triangles) = cuboid([0.0; 3], [6.0; 3], 0, false);
    // The top is made anew, as a frame.
    triangles.truncate(10);
    vertices.extend([[2.0, 2.0, 6.0], [4.0, 2.0, 6.0], [4.0, 4.0, 6.0], [2.0, 4.0, 6.0], [3.0; 3]]);
    let (outer, inner, tip) = ([4, 5, 7, 6], [8, 9, 10, 11], 12);
    for i in 0..4 {
        let j = (i + 1) % 4;
        triangles.extend([[outer[i], outer[j], inner[j]], [outer[i], inner[j], inner[i]], [inner[i], inner[j], tip]]);
    }
    let mut b = Builder::new(mesh(&vertices, &triangles), planes);
    b.triangles(&|signs, _| signs.iter().fold(0, |k, &s| 2 * k + (s > 0) as u32));
    sections(&mut b);
    b.build()
}

//! What a cut must be, straight from definitions, in rationals: which points and edges there are, the volume on every
//! combination of sides, the planes through each vertex. Slow, and without a formula of the library's.
#![allow(dead_code, clippy::needless_range_loop)]

use lapidary::base::{CellId, FaceId, PlaneId, TriangleId, VertexId};
use lapidary::complex::{Complex, FaceStyle, HalfFace, Origin, SupportId, adjacency, exact_values, faces_as, moments};
use lapidary::exact::Plane;
use lapidary::mesh::TriMesh;
use rug::Rational;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

pub type P = [Rational; 3];
pub type Outcome = Result<(), String>;

pub fn point(x: [f64; 3]) -> P {
    x.map(|x| Rational::from_f64(x).expect("a finite coordinate"))
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
pub fn det(a: &P, b: &P, c: &P) -> Rational {
    dot(a, &cross(b, c))
}
fn is_zero(a: &P) -> bool {
    a.iter().all(|x| x.is_zero())
}
fn along(a: &P, b: &P, t: &Rational) -> P {
    std::array::from_fn(|i| Rational::from(&b[i] - &a[i]) * t + &a[i])
}
fn signum(x: &Rational) -> i8 {
    x.cmp0() as i8
}

/// A plane n·x + d = 0 in rationals.
#[derive(Clone, Debug, PartialEq)]
pub struct Flat {
    pub n: P,
    pub d: Rational,
}

impl Flat {
    pub fn of(p: &Plane) -> Self {
        Self { n: point(p.n), d: Rational::from_f64(p.d).unwrap() }
    }
    pub fn through(t: &[P; 3]) -> Self {
        let n = cross(&minus(&t[1], &t[0]), &minus(&t[2], &t[0]));
        let d = -dot(&n, &t[0]);
        Self { n, d }
    }
    pub fn value(&self, x: &P) -> Rational {
        dot(&self.n, x) + &self.d
    }
    /// Divided by the first coefficient that is not zero: equal for coincident planes.
    fn canonical(&self) -> Self {
        let lead = self.n.iter().find(|x| !x.is_zero()).expect("a normal").clone();
        Self { n: std::array::from_fn(|i| Rational::from(&self.n[i] / &lead)), d: Rational::from(&self.d / &lead) }
    }
}

/// The point on three planes, if it is one.
fn meet(p: [&Flat; 3]) -> Option<P> {
    let [a, b, c] = p;
    let whole = det(&a.n, &b.n, &c.n);
    if whole.is_zero() {
        return None;
    }
    let parts = [cross(&b.n, &c.n), cross(&c.n, &a.n), cross(&a.n, &b.n)];
    Some(std::array::from_fn(|i| {
        let sum = Rational::from(&parts[0][i] * &a.d)
            + Rational::from(&parts[1][i] * &b.d)
            + Rational::from(&parts[2][i] * &c.d);
        -(sum / &whole)
    }))
}

/// A closed surface of triangles.
pub struct Surface {
    pub triangles: Vec<[P; 3]>,
}

impl Surface {
    /// Does the point lie on a triangle?
    pub fn touches(&self, x: &P) -> bool {
        self.triangles.iter().any(|t| {
            let n = Flat::through(t);
            n.value(x).is_zero()
                && (0..3).all(|i| {
                    let side = cross(&minus(&t[(i + 1) % 3], &t[i]), &minus(x, &t[i]));
                    dot(&side, &n.n) >= 0
                })
        })
    }

    /// The winding number around a point that is not on the surface: signed crossings of a ray; another ray if it meets an
    /// edge or a vertex.
    fn winding(&self, x: &P) -> i32 {
        'rays: for k in 1i64.. {
            let direction = [Rational::from(k), Rational::from(3 * k * k + 1), Rational::from(7 - 2 * k * k * k)];
            let mut sum = 0;
            for t in &self.triangles {
                let from = [0, 1, 2].map(|i| minus(&t[i], x));
                let turns = [0, 1, 2].map(|i| signum(&det(&direction, &from[i], &from[(i + 1) % 3])));
                if turns.contains(&1) && turns.contains(&-1) {
                    continue;
                }
                if turns.contains(&0) {
                    continue 'rays;
                }
                let height = signum(&det(&from[0], &from[1], &from[2]));
                // Turns +1: the triangle is seen from behind, so the ray leaves if the triangle is in front.
                if turns[0] == height {
                    sum += turns[0] as i32;
                }
            }
            return sum;
        }
        unreachable!("some ray is in general position")
    }

    pub fn strictly_inside(&self, x: &P) -> bool {
        !self.touches(x) && self.winding(x) > 0
    }
}

/// Everything that a cut of a mesh by planes must have.
pub struct Oracle {
    pub surface: Surface,
    /// Distinct planes, and the lowest input plane of each.
    pub planes: Vec<Flat>,
    pub ids: Vec<PlaneId>,
    pub plane_map: Vec<PlaneId>,
    pub points: BTreeSet<P>,
    pub edges: BTreeSet<[P; 2]>,
    /// By side of each distinct plane.
    pub volumes: BTreeMap<Vec<i8>, Rational>,
}

fn distinct(planes: &[Plane]) -> (Vec<Flat>, Vec<PlaneId>, Vec<PlaneId>) {
    let flats: Vec<Flat> = planes.iter().map(Flat::of).collect();
    let names: Vec<Flat> = flats.iter().map(Flat::canonical).collect();
    let first: Vec<usize> = names.iter().map(|n| names.iter().position(|m| m == n).unwrap()).collect();
    let lowest: Vec<usize> = (0..planes.len()).filter(|&i| first[i] == i).collect();
    (
        lowest.iter().map(|&i| flats[i].clone()).collect(),
        lowest.iter().map(|&i| PlaneId::of(i)).collect(),
        first.into_iter().map(PlaneId::of).collect(),
    )
}

/// Splits a tetrahedron at edges that cross a plane until none does; collects six times the signed volume by sides.
fn split(tet: [P; 4], planes: &[Flat], at: usize, sides: &mut Vec<i8>, volumes: &mut BTreeMap<Vec<i8>, Rational>) {
    if at == planes.len() {
        let [a, b, c, d] = &tet;
        *volumes.entry(sides.clone()).or_default() += det(&minus(b, a), &minus(c, a), &minus(d, a));
        return;
    }
    let values = [0, 1, 2, 3].map(|i| planes[at].value(&tet[i]));
    for i in 0..4 {
        for j in 0..4 {
            if values[i] > 0 && values[j] < 0 {
                let x = along(&tet[i], &tet[j], &(&values[i] / Rational::from(&values[i] - &values[j])));
                for k in [i, j] {
                    let mut part = tet.clone();
                    part[k] = x.clone();
                    split(part, planes, at, sides, volumes);
                }
                return;
            }
        }
    }
    sides.push(if values.iter().any(|v| *v > 0) { 1 } else { -1 });
    split(tet, planes, at + 1, sides, volumes);
    sides.pop();
}

fn ordered(a: &P, b: &P) -> [P; 2] {
    if a < b { [a.clone(), b.clone()] } else { [b.clone(), a.clone()] }
}

impl Oracle {
    pub fn new(mesh: &TriMesh, input: &[Plane]) -> Self {
        let (planes, ids, plane_map) = distinct(input);
        let vertices: Vec<P> = mesh.vertices.iter().map(|x| point(*x)).collect();
        let corners = |t: &[VertexId; 3]| t.map(|v| vertices[v.at()].clone());
        let surface = Surface { triangles: mesh.triangles.iter().map(corners).collect() };
        let mut mesh_edges: BTreeSet<[P; 2]> = BTreeSet::new();
        for t in &surface.triangles {
            mesh_edges.extend((0..3).map(|i| ordered(&t[i], &t[(i + 1) % 3])));
        }
        let mut points: BTreeSet<P> = vertices.iter().cloned().collect();
        for [a, b] in &mesh_edges {
            for p in &planes {
                let (va, vb) = (p.value(a), p.value(b));
                if signum(&va) * signum(&vb) == -1 {
                    points.insert(along(a, b, &(&va / Rational::from(&va - &vb))));
                }
            }
        }
        let within = |t: &[P; 3], x: &P| {
            let n = cross(&minus(&t[1], &t[0]), &minus(&t[2], &t[0]));
            (0..3).all(|i| dot(&cross(&minus(&t[(i + 1) % 3], &t[i]), &minus(x, &t[i])), &n) > 0)
        };
        for t in &surface.triangles {
            let support = Flat::through(t);
            for (i, p) in planes.iter().enumerate() {
                let crosses = |p: &Flat| {
                    let s = [0, 1, 2].map(|k| signum(&p.value(&t[k])));
                    s.contains(&1) && s.contains(&-1)
                };
                if !crosses(p) {
                    continue;
                }
                for q in &planes[..i] {
                    if let Some(x) = meet([&support, p, q])
                        && within(t, &x)
                    {
                        points.insert(x);
                    }
                }
            }
        }
        let mut lines: Vec<[usize; 2]> = Vec::new();
        for (i, p) in planes.iter().enumerate() {
            for (j, q) in planes[..i].iter().enumerate() {
                if is_zero(&cross(&p.n, &q.n)) {
                    continue;
                }
                lines.push([i, j]);
                for r in &planes[..j] {
                    if let Some(x) = meet([p, q, r])
                        && !points.contains(&x)
                        && surface.strictly_inside(&x)
                    {
                        points.insert(x);
                    }
                }
            }
        }
        // Edges: neighbours on a line whose middle is inside what carries it. Lexicographic order is the order along a line.
        let sorted: Vec<&P> = points.iter().collect();
        let on = |p: &Flat| -> Vec<bool> { sorted.iter().map(|x| p.value(x).is_zero()).collect() };
        let on_planes: Vec<Vec<bool>> = planes.iter().map(on).collect();
        let half = Rational::from((1, 2));
        let mut edges = BTreeSet::new();
        let mut add = |p: &[bool], q: &[bool], inside: &dyn Fn(&P) -> bool| {
            let row: Vec<&P> = (0..sorted.len()).filter(|&i| p[i] && q[i]).map(|i| sorted[i]).collect();
            for w in row.windows(2) {
                if inside(&along(w[0], w[1], &half)) {
                    edges.insert(ordered(w[0], w[1]));
                }
            }
        };
        for [a, b] in &mesh_edges {
            let u = minus(b, a);
            let line: Vec<bool> = sorted.iter().map(|x| is_zero(&cross(&u, &minus(x, a)))).collect();
            add(&line, &line, &|x| a < x && x < b);
        }
        for t in &surface.triangles {
            let support = Flat::through(t);
            let on_support = on(&support);
            for (i, p) in planes.iter().enumerate() {
                if !is_zero(&cross(&p.n, &support.n)) {
                    add(&on_planes[i], &on_support, &|x| within(t, x));
                }
            }
        }
        for [p, q] in lines {
            add(&on_planes[p], &on_planes[q], &|x| surface.strictly_inside(x));
        }
        let mut volumes = BTreeMap::new();
        let apex = &vertices[0];
        for [a, b, c] in &surface.triangles {
            if !det(&minus(a, apex), &minus(b, apex), &minus(c, apex)).is_zero() {
                split([apex.clone(), a.clone(), b.clone(), c.clone()], &planes, 0, &mut Vec::new(), &mut volumes);
            }
        }
        volumes.retain(|_, v| !v.is_zero());
        volumes.values_mut().for_each(|v| *v /= 6);
        Self { surface, planes, ids, plane_map, points, edges, volumes }
    }
}

/// The exact point of a vertex, from its origin.
fn exact_point(c: &Complex, v: usize) -> P {
    let flat = |p: PlaneId| Flat::of(&c.planes[p.at()]);
    match c.origins[v] {
        Origin::Mesh(m) => point(c.mesh.vertices[m.at()]),
        Origin::Edge(e, p) => {
            let [a, b] = c.mesh.edges[e.at()].map(|v| point(c.mesh.vertices[v.at()]));
            let (va, vb) = (flat(p).value(&a), flat(p).value(&b));
            along(&a, &b, &(&va / Rational::from(&va - &vb)))
        }
        Origin::Triangle(t, p, q) => {
            meet([&Flat::through(&c.mesh.corners(t).map(point)), &flat(p), &flat(q)]).expect("an independent pair")
        }
        Origin::Planes(p, q, r) => meet([&flat(p), &flat(q), &flat(r)]).expect("an independent triple"),
        other => unreachable!("a cut's vertex {other:?}"),
    }
}

/// Is `x` the double nearest to `exact`, ties to even, zero as +0?
pub fn correctly_rounded(x: f64, exact: &Rational) -> bool {
    if x == 0.0 && x.is_sign_negative() {
        return false;
    }
    let far = |y: f64| -> Rational {
        // One step beyond the largest double is where it would be without an end of the exponents.
        let end = || Rational::from_f64(f64::MAX).unwrap() + (Rational::from(1) << 971);
        let y = match Rational::from_f64(y) {
            Some(y) => y,
            None if y > 0.0 => end(),
            None => -end(),
        };
        (y - exact).abs()
    };
    let own = far(x);
    [x.next_up(), x.next_down()].into_iter().all(|y| match own.cmp(&far(y)) {
        Ordering::Less => true,
        Ordering::Equal => x.to_bits() & 1 == 0,
        Ordering::Greater => false,
    })
}

fn ensure(holds: bool, message: impl FnOnce() -> String) -> Outcome {
    if holds { Ok(()) } else { Err(message()) }
}

/// Compares a cut with the oracle: plane map, points, planes through them, edges, volumes by sides, roundings, shells, areas.
pub fn compare(c: &Complex, plane_map: &[PlaneId], oracle: &Oracle) -> Outcome {
    ensure(plane_map == oracle.plane_map, || format!("plane map {plane_map:?}, expected {:?}", oracle.plane_map))?;
    let points: Vec<P> = (0..c.vertex_count()).map(|v| exact_point(c, v)).collect();
    let set: BTreeSet<P> = points.iter().cloned().collect();
    ensure(set.len() == points.len(), || "two vertices in one place".into())?;
    let difference = |got: &BTreeSet<P>, wanted: &BTreeSet<P>| {
        let first = |a: &BTreeSet<P>, b: &BTreeSet<P>| a.difference(b).next().map(|x| x.clone().map(|x| x.to_string()));
        format!(
            "{} points, expected {}; too many {:?}, missing {:?}",
            got.len(),
            wanted.len(),
            first(got, wanted),
            first(wanted, got)
        )
    };
    ensure(set == oracle.points, || difference(&set, &oracle.points))?;
    let signs: Vec<Vec<i8>> =
        points.iter().map(|x| oracle.planes.iter().map(|p| signum(&p.value(x))).collect()).collect();
    for (v, x) in points.iter().enumerate() {
        let wanted: Vec<PlaneId> =
            (0..oracle.planes.len()).filter(|&p| signs[v][p] == 0).map(|p| oracle.ids[p]).collect();
        ensure(c.vertex_planes.row(v) == wanted, || {
            format!("vertex {v}: planes {:?}, expected {wanted:?}", c.vertex_planes.row(v))
        })?;
        for i in 0..3 {
            let beyond = x[i].clone().abs() > Rational::from_f64(f64::MAX).unwrap();
            ensure(beyond || correctly_rounded(c.coords[v][i], &x[i]), || {
                format!("vertex {v}: {:?} is not {}", c.coords[v], x[i])
            })?;
        }
    }
    let edges: BTreeSet<[P; 2]> = c.edges.iter().map(|e| ordered(&points[e[0].at()], &points[e[1].at()])).collect();
    ensure(edges.len() == c.edge_count(), || "two edges in one place".into())?;
    ensure(edges == oracle.edges, || {
        let first = |a: &BTreeSet<[P; 2]>, b: &BTreeSet<[P; 2]>| {
            a.difference(b).next().map(|e| e.clone().map(|x| x.map(|x| x.to_string())))
        };
        format!(
            "{} edges, expected {}; too many {:?}, missing {:?}",
            edges.len(),
            oracle.edges.len(),
            first(&edges, &oracle.edges),
            first(&oracle.edges, &edges)
        )
    })?;
    areas(c, &points, oracle)?;
    cells(c, &points, &signs, oracle)?;
    components(c)?;
    styles(c, &points)
}

fn support(c: &Complex, f: FaceId) -> Flat {
    match c.face_support[f.at()] {
        SupportId::Triangle(t) => Flat::through(&c.mesh.corners(t).map(point)),
        SupportId::Plane(p) => Flat::of(&c.planes[p.at()]),
        SupportId::Level(_) => unreachable!("a level in a cut by planes"),
    }
}

/// Twice the signed area of closed polygons along a normal, times the normal's length.
fn area(n: &P, points: &[P], loops: &[&[VertexId]]) -> Rational {
    let origin = &points[loops[0][0].at()];
    let mut sum = Rational::new();
    for l in loops {
        for i in 0..l.len() {
            let [a, b] = [l[i], l[(i + 1) % l.len()]].map(|v| minus(&points[v.at()], origin));
            sum += det(n, &a, &b);
        }
    }
    sum
}

fn loops_of(c: &Complex, f: FaceId) -> Vec<&[VertexId]> {
    c.loops_of(f).map(|l| &c.corner_vertices[c.corners_of(l)]).collect()
}

/// The faces on a triangle have its area in all and its tag; each names the lowest plane that it lies on.
fn areas(c: &Complex, points: &[P], oracle: &Oracle) -> Outcome {
    let mut sums = vec![Rational::new(); c.mesh.triangles.len()];
    for f in (0..c.face_count()).map(FaceId::of) {
        let flat = support(c, f);
        let x = area(&flat.n, points, &loops_of(c, f));
        ensure(x > 0, || format!("face {}: area {x}", f.0))?;
        let name = flat.canonical();
        let plane = oracle.planes.iter().position(|p| p.canonical() == name).map_or(PlaneId::NONE, |p| oracle.ids[p]);
        ensure(c.face_plane[f.at()] == plane, || {
            format!("face {}: plane {:?}, expected {plane:?}", f.0, c.face_plane[f.at()])
        })?;
        let tag = match c.face_support[f.at()] {
            SupportId::Triangle(t) => {
                sums[t.at()] += x;
                c.mesh.tags.get(t.at()).copied().unwrap_or(0)
            }
            SupportId::Plane(_) | SupportId::Level(_) => 0,
        };
        ensure(c.face_tag[f.at()] == tag, || format!("face {}: tag {}", f.0, c.face_tag[f.at()]))?;
    }
    for (t, sum) in sums.iter().enumerate() {
        let n = Flat::through(&c.mesh.corners(TriangleId::of(t)).map(point)).n;
        ensure(*sum == dot(&n, &n), || format!("the faces on triangle {t} do not have its area"))?;
    }
    Ok(())
}

/// Half-faces of one shell in triangles, as walls of the cell.
fn walls(c: &Complex, points: &[P], shell: usize, triangles: &[Vec<[VertexId; 3]>]) -> Surface {
    let mut out = Vec::new();
    for h in c.shell_faces.row(shell) {
        for t in &triangles[h.face().at()] {
            let [a, b, d] = t.map(|v| points[v.at()].clone());
            out.push(if h.front() { [a, d, b] } else { [a, b, d] });
        }
    }
    Surface { triangles: out }
}

fn triangles_of(c: &Complex) -> Result<Vec<Vec<[VertexId; 3]>>, String> {
    let rows = faces_as(c, FaceStyle::Triangulated)?;
    let mut out = vec![Vec::new(); c.face_count()];
    for (i, f) in rows.source_face.iter().enumerate() {
        let r = &rows.vertices[rows.offsets[i] as usize..rows.offsets[i + 1] as usize];
        out[f.at()].push([r[0], r[1], r[2]]);
    }
    Ok(out)
}

/// Six times the signed volume of a closed surface.
fn volume(s: &Surface) -> Rational {
    s.triangles.iter().fold(Rational::new(), |sum, [a, b, d]| sum + det(a, b, d))
}

/// Each cell on one side of every plane; volumes by sides; shells in one piece, the outer one around the voids.
fn cells(c: &Complex, points: &[P], signs: &[Vec<i8>], oracle: &Oracle) -> Outcome {
    let triangles = triangles_of(c)?;
    let values = moments(c);
    let mut volumes: BTreeMap<Vec<i8>, Rational> = BTreeMap::new();
    for cell in (0..c.cell_count()).map(CellId::of) {
        let mut sides = vec![0i8; oracle.planes.len()];
        for h in c.cell_faces(cell) {
            for v in &c.corner_vertices[c.face_corners(h.face())] {
                for (side, s) in sides.iter_mut().zip(&signs[v.at()]) {
                    ensure(*side * s >= 0, || format!("cell {} on both sides of a plane", cell.0))?;
                    *side |= s;
                }
            }
        }
        let shells = c.cell_shells[cell.at()] as usize..c.cell_shells[cell.at() + 1] as usize;
        let surfaces: Vec<Surface> = shells.map(|s| walls(c, points, s, &triangles)).collect();
        let mut whole = Rational::new();
        for (i, s) in surfaces.iter().enumerate() {
            let six = volume(s);
            ensure((six > 0) == (i == 0), || format!("cell {}: shell {i} has six times the volume {six}", cell.0))?;
            whole += six;
            if i > 0 {
                // A void's wall lies within the outer shell, no matter where on it one asks.
                let [a, b, d] = &s.triangles[0];
                let third = Rational::from((1, 3));
                let x: P = std::array::from_fn(|k| (Rational::from(&a[k] + &b[k]) + &d[k]) * &third);
                ensure(surfaces[0].strictly_inside(&x), || format!("cell {}: void {i} is elsewhere", cell.0))?;
                for (j, other) in surfaces.iter().enumerate().skip(1) {
                    ensure(i == j || other.winding(&x) == 0, || format!("cell {}: voids in one another", cell.0))?;
                }
            }
        }
        whole /= 6;
        ensure(whole > 0, || format!("cell {}: volume {whole}", cell.0))?;
        ensure(exact_values::cell_volume(c, cell) == whole, || format!("cell {}: its exact volume differs", cell.0))?;
        if values.cell_flags[cell.at()] == 0 {
            ensure(correctly_rounded(values.cell_volume[cell.at()], &whole), || {
                format!("cell {}: volume {} is not {whole}", cell.0, values.cell_volume[cell.at()])
            })?;
        }
        *volumes.entry(sides).or_default() += whole;
    }
    ensure(volumes == oracle.volumes, || format!("volumes {volumes:?}, expected {:?}", oracle.volumes))?;
    // Each shell hangs together across edges.
    let mates = adjacency(c)?;
    for s in 0..c.shell_faces.len() {
        let row = c.shell_faces.row(s);
        let mut seen = BTreeSet::from([row[0]]);
        let mut stack = vec![row[0]];
        while let Some(h) = stack.pop() {
            for k in c.face_corners(h.face()) {
                let mate = mates.mates[k << 1 | h.front() as usize];
                if mate.0 != u32::MAX {
                    let next: HalfFace = mates.half_face(mate);
                    if seen.insert(next) {
                        stack.push(next);
                    }
                }
            }
        }
        ensure(seen.iter().eq(row.iter()), || format!("shell {s} is not one piece"))?;
    }
    Ok(())
}

/// A cell has the component of its outer walls, and of the cells next to it.
fn components(c: &Complex) -> Outcome {
    // Components by shared edges.
    let m = &c.mesh;
    let mut name: Vec<usize> = (0..m.triangles.len()).collect();
    let shares = |a: &[VertexId; 3], b: &[VertexId; 3]| a.iter().filter(|v| b.contains(v)).count() >= 2;
    loop {
        let before = name.clone();
        for i in 0..name.len() {
            for j in 0..name.len() {
                if name[j] < name[i] && shares(&m.triangles[i], &m.triangles[j]) {
                    name[i] = name[j];
                }
            }
        }
        if name == before {
            break;
        }
    }
    let mut numbers: Vec<usize> = name.clone();
    numbers.sort_unstable();
    numbers.dedup();
    for f in 0..c.face_count() {
        let [a, b] = c.face_cells[f];
        if b.is_some() {
            ensure(c.cell_component[a.at()] == c.cell_component[b.at()], || format!("face {f}: between components"))?;
        } else if let SupportId::Triangle(t) = c.face_support[f]
            && m.shells[m.triangle_shell[t.at()].at()].outer
        {
            let number = numbers.binary_search(&name[t.at()]).unwrap();
            ensure(c.cell_component[a.at()].at() == number, || format!("face {f}: its cell is of another component"))?;
        }
    }
    Ok(())
}

/// Bridged and triangulated faces: the same area, no inverted triangle, every side of the face used as often, the rest in pairs.
fn styles(c: &Complex, points: &[P]) -> Outcome {
    for style in [FaceStyle::Bridged, FaceStyle::Triangulated] {
        let rows = faces_as(c, style)?;
        let mut own: Vec<Vec<&[VertexId]>> = vec![Vec::new(); c.face_count()];
        for (i, f) in rows.source_face.iter().enumerate() {
            own[f.at()].push(&rows.vertices[rows.offsets[i] as usize..rows.offsets[i + 1] as usize]);
        }
        for f in (0..c.face_count()).map(FaceId::of) {
            let (n, loops, own) = (support(c, f).n, loops_of(c, f), &own[f.at()]);
            if loops.len() == 1 && loops[0].len() == 3 {
                ensure(own[..] == loops[..], || format!("face {}: a triangle is not itself", f.0))?;
                continue;
            }
            ensure(style == FaceStyle::Triangulated || own.len() == 1, || format!("face {}: not one polygon", f.0))?;
            ensure(own.iter().all(|l| area(&n, points, &[l]) > 0), || format!("face {}: an inverted part", f.0))?;
            ensure(area(&n, points, own) == area(&n, points, &loops), || format!("face {}: area", f.0))?;
            let mut sides: BTreeMap<[VertexId; 2], i32> = BTreeMap::new();
            for (parts, step) in [(own, 1), (&loops, -1)] {
                for l in parts.iter().filter(|l| l.len() > 1) {
                    (0..l.len()).for_each(|i| *sides.entry([l[i], l[(i + 1) % l.len()]]).or_insert(0) += step);
                }
            }
            let paired = sides.iter().all(|([a, b], n)| *n >= 0 && sides.get(&[*b, *a]).copied().unwrap_or(0) == *n);
            ensure(paired, || format!("face {}: sides of its parts", f.0))?;
            let all = |parts: &[&[VertexId]]| parts.iter().flat_map(|l| l.iter().copied()).collect::<BTreeSet<_>>();
            ensure(all(own) == all(&loops), || format!("face {}: vertices of its parts", f.0))?;
        }
    }
    Ok(())
}

//! Is a complex what DESIGN §7 and §10 say it is? Three levels: [`check`] is combinatorial and symbolic, [`check_volumes`]
//! sums areas and volumes exactly modulo two primes, both in linear time; [`check_exact`] asks the kernel whether each
//! vertex lies on the support of each of its faces, and the Euler characteristic.
//!
//! Every message names the element. Nothing here repairs or panics: a complex from outside may be wrong in any way.

// An axis indexes several arrays at once.
#![allow(clippy::needless_range_loop)]

use super::adjacency::{adjacency, corner_faces, corner_nexts};
use super::data::{Complex, HalfFace, Origin, SupportId};
use super::euler::{euler_with, is_pinched, solid_euler};
use super::exact_values;
use crate::base::{CellId, Csr, EdgeId, FaceId, TriangleId, VertexId};
use crate::exact::residue::point_residues;
use crate::exact::{self, Residue, Sign, Support};
use rayon::prelude::*;

type Check = Result<(), String>;

fn ensure(holds: bool, message: impl FnOnce() -> String) -> Check {
    if holds { Ok(()) } else { Err(message()) }
}

/// All structural invariants. Cost: linear, and the sorts that find duplicates.
pub fn check(c: &Complex) -> Check {
    if c.two_sided {
        return check_part(c);
    }
    for (f, cells) in c.face_cells.iter().enumerate() {
        ensure(cells[0].is_some(), || format!("face {f}: no owner"))?;
        let within = matches!(c.face_support.get(f), Some(SupportId::Plane(_) | SupportId::Level(_)));
        ensure(!within || cells[1].is_some(), || format!("face {f}: on a plane or level alone, with one cell"))?;
    }
    check_part(c)
}

/// The same for some of a solid's cells: a face on a plane alone may have one, on either side.
pub fn check_part(c: &Complex) -> Check {
    arrays(c)?;
    vertices(c)?;
    let faces = corner_faces(c);
    loops(c)?;
    faces_and_cells(c)?;
    shells(c)?;
    closed_shells(c, &faces)?;
    supports(c)?;
    duplicates(c)
}

/// Lengths, offsets and id ranges: what everything else relies on.
fn arrays(c: &Complex) -> Check {
    let (nv, ne, nf, nc) = (c.vertex_count(), c.edge_count(), c.face_count(), c.cell_count());
    let limit = i32::MAX as usize;
    ensure(nv <= limit && ne <= limit && nf <= limit && c.corner_vertices.len() <= limit, || {
        "too many elements".into()
    })?;
    ensure(c.coords.len() == nv, || "as many coordinates as vertices".into())?;
    ensure(c.vertex_planes.len() == nv, || "as many rows of planes as vertices".into())?;
    c.vertex_planes.check()?;
    c.shell_faces.check()?;
    ensure(c.face_plane.len() == nf && c.face_tag.len() == nf && c.face_cells.len() == nf, || {
        "as many planes, tags and cells as faces".into()
    })?;
    ensure(c.corner_edges.len() == c.corner_vertices.len(), || "as many corner edges as corners".into())?;
    let csr = |name: &str, offsets: &[u32], rows: usize, items: usize| {
        ensure(offsets.len() == rows + 1 && offsets[0] == 0, || format!("{name}: wrong number of offsets"))?;
        ensure(offsets.windows(2).all(|w| w[0] < w[1]), || format!("{name}: an empty row"))?;
        ensure(offsets[rows] as usize == items, || format!("{name}: offsets do not end at the number of items"))
    };
    csr("face_loops", &c.face_loops, nf, c.loop_offsets.len().saturating_sub(1))?;
    csr("loop_offsets", &c.loop_offsets, c.loop_offsets.len().saturating_sub(1), c.corner_vertices.len())?;
    csr("cell_shells", &c.cell_shells, nc, c.shell_faces.len())?;
    csr("shell_faces", &c.shell_faces.offsets, c.shell_faces.len(), c.shell_faces.items.len())?;
    ensure(c.corner_vertices.iter().all(|v| v.at() < nv), || "a corner's vertex out of range".into())?;
    ensure(c.corner_edges.iter().all(|e| e.is_none() || e.at() < ne), || "a corner's edge out of range".into())?;
    ensure(c.edges.iter().flatten().all(|v| v.at() < nv), || "an edge's vertex out of range".into())?;
    ensure(c.face_plane.iter().all(|p| p.is_none() || p.at() < c.planes.len()), || {
        "a face's plane out of range".into()
    })?;
    ensure(c.vertex_planes.items.iter().all(|p| p.at() < c.planes.len()), || "a vertex's plane out of range".into())?;
    ensure(c.face_cells.iter().flatten().all(|k| k.is_none() || k.at() < nc), || "a face's cell out of range".into())?;
    ensure(c.shell_faces.items.iter().all(|h| h.face().at() < nf), || "a shell's face out of range".into())?;
    let components = if c.two_sided { nc } else { c.mesh.component_count };
    ensure(c.cell_component.iter().all(|k| k.at() < components), || "a cell's component out of range".into())?;
    let known = |s: &SupportId| match s {
        SupportId::Triangle(t) => t.at() < c.mesh.triangles.len(),
        SupportId::Plane(p) => p.at() < c.planes.len(),
        SupportId::Level(p) => p.at() < c.levels.supports.len(),
    };
    ensure(c.face_support.iter().all(known), || "a face's support out of range".into())
}

/// Vertices: planes rising, origins in range and consistent with the planes, coordinates finite and no −0.
fn vertices(c: &Complex) -> Check {
    let m = &c.mesh;
    for v in 0..c.vertex_count() {
        let planes = c.vertex_planes.row(v);
        ensure(planes.windows(2).all(|w| w[0] < w[1]), || format!("vertex {v}: planes not rising"))?;
        let on = |p| planes.binary_search(&p).is_ok();
        let good = match c.origins[v] {
            Origin::Mesh(i) => i.at() < m.vertices.len() && c.coords[v] == m.vertices[i.at()],
            Origin::Edge(e, p) => e.at() < m.edges.len() && on(p),
            Origin::Triangle(t, p, q) => t.at() < m.triangles.len() && p < q && on(p) && on(q),
            Origin::Planes(p, q, r) => p < q && q < r && on(p) && on(q) && on(r),
            Origin::EdgeTriangle(e, t) => e.at() < m.edges.len() && t.at() < m.triangles.len(),
            Origin::Edges(e, f) => e < f && f.at() < m.edges.len(),
            Origin::Triangles(t, u, v) => t < u && u < v && v.at() < m.triangles.len(),
            Origin::TrianglesPlane(t, u, p) => t < u && u.at() < m.triangles.len() && on(p),
            Origin::Level(i) => c.levels.points.get(i as usize).is_some_and(|zero| zero.dim <= 3),
        };
        ensure(good, || format!("vertex {v}: its origin {:?} does not fit", c.origins[v]))?;
        let plain = |x: &f64| !x.is_nan() && (*x != 0.0 || x.is_sign_positive());
        ensure(c.coords[v].iter().all(plain), || format!("vertex {v}: coordinates {:?}", c.coords[v]))?;
    }
    Ok(())
}

/// Loops follow edges; every edge and vertex is used; a lone corner has no edge and is no outer loop.
fn loops(c: &Complex) -> Check {
    let next = corner_nexts(c);
    let mut edge_used = vec![false; c.edge_count()];
    let mut vertex_used = vec![false; c.vertex_count()];
    for f in (0..c.face_count()).map(FaceId::of) {
        for (i, l) in c.loops_of(f).enumerate() {
            let r = c.corners_of(l);
            let lone = r.len() == 1;
            ensure(r.len() > 1 || i > 0, || format!("face {}: outer loop of one vertex", f.0))?;
            ensure(r.len() > 2 || i > 0, || format!("face {}: outer loop of two vertices", f.0))?;
            for k in r {
                let v = c.corner_vertices[k];
                vertex_used[v.at()] = true;
                let e = c.corner_edges[k];
                ensure(e.is_none() == lone, || {
                    format!("face {}: corner {k} without an edge, or a lone one with", f.0)
                })?;
                if lone {
                    continue;
                }
                edge_used[e.at()] = true;
                let w = c.corner_vertices[next[k] as usize];
                let ends = c.edges[e.at()];
                ensure(ends == [v, w] || ends == [w, v], || {
                    format!("face {}: corner {k} goes from vertex {} to {}, its edge {} does not", f.0, v.0, w.0, e.0)
                })?;
            }
        }
    }
    let unused = |used: &[bool], name| match used.iter().position(|u| !u) {
        Some(i) => Err(format!("{name} {i} is in no face")),
        None => Ok(()),
    };
    unused(&edge_used, "edge")?;
    unused(&vertex_used, "vertex")
}

/// Each face has an owner; a face on a triangle has no neighbour unless faces are two-sided; only one on a level may have a cell on both sides (it then
/// ends inside the cell); the plane of a face on a plane is that plane; its tag is its triangle's.
fn faces_and_cells(c: &Complex) -> Check {
    for f in 0..c.face_count() {
        let [owner, neighbour] = c.face_cells[f];
        ensure(owner.is_some() || neighbour.is_some(), || format!("face {f}: no cell"))?;
        let level = matches!(c.face_support[f], SupportId::Level(_));
        ensure(owner != neighbour || level, || format!("face {f}: the same cell on both sides"))?;
        let tag = match c.face_support[f] {
            SupportId::Triangle(t) => {
                ensure(neighbour.is_none() || c.two_sided, || format!("face {f}: on a triangle, with two cells"))?;
                if c.mesh.tags.is_empty() { 0 } else { c.mesh.tags[t.at()] }
            }
            SupportId::Plane(p) => {
                ensure(c.face_plane[f] == p, || format!("face {f}: lies on another plane than its support"))?;
                0
            }
            SupportId::Level(_) => 0,
        };
        ensure(c.face_tag[f] == tag, || format!("face {f}: tag {} instead of {tag}", c.face_tag[f]))?;
    }
    Ok(())
}

/// Shells partition the half-faces that have a cell, each in a shell of that cell.
fn shells(c: &Complex) -> Check {
    let mut seen = vec![false; 2 * c.face_count()];
    for cell in (0..c.cell_count()).map(CellId::of) {
        for s in c.cell_shells[cell.at()]..c.cell_shells[cell.at() + 1] {
            let row = c.shell_faces.row(s as usize);
            ensure(row.windows(2).all(|w| w[0] < w[1]), || format!("shell {s}: half-faces not rising"))?;
            for h in row {
                ensure(c.face_cells[h.face().at()][h.front() as usize] == cell, || {
                    format!("shell {s} of cell {}: face {} is not the cell's there", cell.0, h.face().0)
                })?;
                ensure(!seen[h.at()], || format!("face {}: in two shells", h.face().0))?;
                seen[h.at()] = true;
            }
        }
    }
    for (i, seen) in seen.iter().enumerate() {
        let h = HalfFace(i as u32);
        let cell = c.face_cells[h.face().at()][h.front() as usize];
        ensure(cell.is_none() || *seen, || format!("face {}: in no shell of cell {}", h.face().0, cell.0))?;
    }
    Ok(())
}

/// Around each edge the half-faces of one shell are as many forward as backward.
fn closed_shells(c: &Complex, corner_face: &[FaceId]) -> Check {
    let mut shell_of = vec![u32::MAX; 2 * c.face_count()];
    for s in 0..c.shell_faces.len() {
        for h in c.shell_faces.row(s) {
            shell_of[h.at()] = s as u32;
        }
    }
    let uses = Csr::from_pairs(
        c.edge_count(),
        c.corner_edges.iter().enumerate().filter(|(_, e)| e.is_some()).map(|(k, e)| (e.at(), k as u32)),
    );
    // (shell, walked forward as seen from inside the shell's cell)
    let mut walls: Vec<(u32, bool)> = Vec::new();
    for e in (0..c.edge_count()).map(EdgeId::of) {
        walls.clear();
        for &k in uses.row(e) {
            let forward = c.corner_vertices[k as usize] == c.edges[e.at()][0];
            for front in [false, true] {
                let shell = shell_of[HalfFace::new(corner_face[k as usize], front).at()];
                if shell != u32::MAX {
                    walls.push((shell, forward != front));
                }
            }
        }
        walls.sort_unstable();
        for run in walls.chunk_by(|a, b| a.0 == b.0) {
            let forward = run.iter().filter(|w| w.1).count();
            ensure(2 * forward == run.len(), || format!("shell {}: open at edge {}", run[0].0, e.0))?;
        }
    }
    Ok(())
}

/// The mesh elements of a triangle that hold a point of a given origin.
fn on_triangle(c: &Complex, o: Origin, t: TriangleId) -> bool {
    let m = &c.mesh;
    match o {
        Origin::Mesh(v) => m.triangles[t.at()].contains(&v),
        Origin::Edge(e, _) => m.triangle_edges[t.at()].contains(&e),
        Origin::Triangle(s, _, _) => s == t,
        Origin::Planes(..) => false,
        Origin::EdgeTriangle(e, s) => s == t || m.triangle_edges[t.at()].contains(&e),
        Origin::Edges(e, f) => m.triangle_edges[t.at()].iter().any(|&k| k == e || k == f),
        Origin::Triangles(a, b, d) => a == t || b == t || d == t,
        Origin::TrianglesPlane(a, b, _) => a == t || b == t,
        Origin::Level(i) => {
            let (zero, corners) = (&c.levels.points[i as usize], m.corners(t));
            zero.corners[..=zero.dim as usize].iter().all(|x| corners.contains(x))
        }
    }
}

/// Every vertex of a face lies on the face's support by its incidences (two-sided: `check_exact` asks), and on its plane as well.
fn supports(c: &Complex) -> Check {
    for f in (0..c.face_count()).map(FaceId::of) {
        for k in c.face_corners(f) {
            let v = c.corner_vertices[k];
            let on = |p| c.vertex_planes.row(v).binary_search(&p).is_ok();
            let plane = c.face_plane[f.at()];
            ensure(plane.is_none() || on(plane), || {
                format!("face {}: vertex {} is not on plane {}", f.0, v.0, plane.0)
            })?;
            if let (SupportId::Triangle(t), false) = (c.face_support[f.at()], c.two_sided) {
                ensure(on_triangle(c, c.origins[v.at()], t), || {
                    format!("face {}: vertex {} is not on triangle {}", f.0, v.0, t.0)
                })?;
            }
        }
    }
    Ok(())
}

/// No two vertices of one origin, no two edges with the same ends *and* the same faces around them, no two faces with
/// the same first loop. (Straight edges have different ends, so equal ends mean equal edges.)
fn duplicates(c: &Complex) -> Check {
    let mut origins: Vec<(Origin, usize)> = c.origins.iter().copied().zip(0..).collect();
    origins.par_sort_unstable();
    if let Some(w) = origins.windows(2).find(|w| w[0].0 == w[1].0) {
        return Err(format!("vertices {} and {} are the same: {:?}", w[0].1, w[1].1, w[0].0));
    }
    let mut edges: Vec<([VertexId; 2], usize)> = Vec::with_capacity(c.edge_count());
    for (i, &[a, b]) in c.edges.iter().enumerate() {
        ensure(a != b, || format!("edge {i}: from vertex {} to itself", a.0))?;
        edges.push(([a.min(b), a.max(b)], i));
    }
    edges.par_sort_unstable();
    if let Some(w) = edges.windows(2).find(|w| w[0].0 == w[1].0) {
        return Err(format!("edges {} and {} are the same", w[0].1, w[1].1));
    }
    // A directed edge and a support determine the face on its left, so one side of a face is its own alone.
    let mut sides: Vec<(SupportId, EdgeId, bool, FaceId)> = Vec::with_capacity(c.corner_edges.len());
    for f in (0..c.face_count()).map(FaceId::of) {
        for k in c.face_corners(f) {
            let e = c.corner_edges[k];
            if e.is_some() {
                sides.push((c.face_support[f.at()], e, c.corner_vertices[k] == c.edges[e.at()][0], f));
            }
        }
    }
    sides.par_sort_unstable();
    match sides.windows(2).find(|w| (w[0].0, w[0].1, w[0].2) == (w[1].0, w[1].1, w[1].2)) {
        Some(w) => Err(format!("faces {} and {} overlap at edge {}", w[0].3.0, w[1].3.0, w[0].1.0)),
        None => Ok(()),
    }
}

/// Areas and volumes, exactly but modulo two primes: each face is flat, each shell closes, the outer shells and voids of
/// the cells add up to the mesh's volume. Cost: linear.
pub fn check_volumes(c: &Complex) -> Check {
    let point = |v: usize| -> Result<[Residue; 3], String> {
        let x = c.point(VertexId::of(v));
        if let Some(r) = point_residues(&x) {
            return Ok(r);
        }
        // The homogeneous denominator is not reduced; the rational coordinates are.
        let mut out = [Residue::ZERO; 3];
        for (o, x) in out.iter_mut().zip(exact::rational(&x)) {
            *o = Residue::from_rational(&x).ok_or("a prime divides a denominator")?;
        }
        Ok(out)
    };
    let points: Vec<[Residue; 3]> = (0..c.vertex_count()).into_par_iter().map(point).collect::<Result<_, _>>()?;
    let minus = |a: &[Residue; 3], b: &[Residue; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: &[Residue; 3], b: &[Residue; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    // Twice the area vector, and twice three times the volume of the cone from the origin.
    let face = |f: usize| -> Result<([Residue; 3], Residue), String> {
        let r = c.face_corners(FaceId::of(f));
        let p0 = points[c.corner_vertices[r.start].at()];
        let mut area = [Residue::ZERO; 3];
        for l in c.loops_of(FaceId::of(f)) {
            let r = c.corners_of(l);
            let mut a = minus(&points[c.corner_vertices[r.end - 1].at()], &p0);
            for k in r {
                let b = minus(&points[c.corner_vertices[k].at()], &p0);
                for i in 0..3 {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    area[i] += a[j] * b[k] - a[k] * b[j];
                }
                a = b;
            }
        }
        for k in r {
            let q = minus(&points[c.corner_vertices[k].at()], &p0);
            ensure(dot(&area, &q).is_zero(), || format!("face {f}: not flat at vertex {}", c.corner_vertices[k].0))?;
        }
        ensure(area.iter().any(|x| !x.is_zero()), || format!("face {f}: without area"))?;
        Ok((area, dot(&area, &p0)))
    };
    let faces: Vec<_> = (0..c.face_count()).into_par_iter().map(face).collect::<Result<_, _>>()?;
    let mut total = Residue::ZERO;
    for s in 0..c.shell_faces.len() {
        let mut area = [Residue::ZERO; 3];
        for h in c.shell_faces.row(s) {
            let (a, v) = faces[h.face().at()];
            for i in 0..3 {
                if h.front() { area[i] -= a[i] } else { area[i] += a[i] }
            }
            if h.front() { total -= v } else { total += v }
        }
        ensure(area.iter().all(|x| x.is_zero()), || format!("shell {s}: its area vectors do not add up to zero"))?;
    }
    if c.two_sided {
        return Ok(());
    }
    let mut solid = Residue::ZERO;
    for t in (0..c.mesh.triangles.len()).map(TriangleId::of) {
        let [a, b, d] = c.mesh.corners(t).map(|p| p.map(Residue::from_f64));
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            solid += a[i] * (b[j] * d[k] - b[k] * d[j]);
        }
    }
    ensure(total == solid, || "the cells' volumes do not add up to the mesh's".into())
}

/// Whether every vertex of a face is on its support, in rationals.
fn on_level(c: &Complex, f: FaceId) -> Check {
    let (n, value) = exact_values::support(c, f);
    c.face_corners(f).into_iter().try_for_each(|k| {
        let v = c.corner_vertices[k];
        let x = exact_values::vertex(c, v);
        let sum = n.iter().zip(&x).fold(rug::Rational::new(), |sum, (n, x)| sum + rug::Rational::from(n * x));
        ensure(sum == value, || format!("face {}: vertex {} is not on it", f.0, v.0))
    })
}

/// What needs exact geometry: each vertex on the planes that it names and on the support of its faces, coordinates
/// correctly rounded, cells with positive volume, and the Euler characteristic of the solid (of a network's regions where nothing is pinched; not of cells of an arrangement). For tests: a rational volume
/// per cell.
pub fn check_exact(c: &Complex) -> Check {
    (0..c.vertex_count()).into_par_iter().try_for_each(|v| {
        let x = c.point(VertexId::of(v));
        for p in c.vertex_planes.row(v) {
            let side = exact::support_side(&Support::Plane(c.planes[p.at()]), &x);
            ensure(side == Sign::Zero, || format!("vertex {v}: not on plane {}", p.0))?;
        }
        ensure(c.coords[v] == exact::round(&x), || format!("vertex {v}: coordinates not correctly rounded"))
    })?;
    (0..c.face_count()).into_par_iter().map(FaceId::of).try_for_each(|f| {
        let s = match c.face_support[f.at()] {
            SupportId::Plane(p) => Support::Plane(c.planes[p.at()]),
            SupportId::Triangle(t) => Support::Triangle(c.mesh.corners(t)),
            SupportId::Level(_) => return on_level(c, f),
        };
        c.face_corners(f).into_iter().try_for_each(|k| {
            let v = c.corner_vertices[k];
            let side = exact::support_side(&s, &c.point(v));
            ensure(side == Sign::Zero, || format!("face {}: vertex {} is not on it", f.0, v.0))
        })
    })?;
    (0..c.cell_count()).into_par_iter().map(CellId::of).try_for_each(|k| {
        ensure(exact_values::cell_volume(c, k) > 0, || format!("cell {}: its volume is not positive", k.0))
    })?;
    let adjacency = adjacency(c)?;
    // What cells of an arrangement make up together is known to nothing else.
    if c.two_sided {
        return Ok(());
    }
    if !c.levels.supports.is_empty() && is_pinched(c, &adjacency) {
        return Ok(());
    }
    let (euler, solid) = (euler_with(c, &adjacency), solid_euler(&c.mesh));
    ensure(euler == solid, || format!("Euler characteristic {euler}, the solid's is {solid}"))
}

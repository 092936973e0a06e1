//! Certified doubles: a complex as triangles over double coordinates that were checked exactly, repaired where rounding
//! brought defects back, and a report that says what was done and what could not be mended (DESIGN §7).
//!
//! The exact triangulation (no new vertices) is read over the correctly rounded coordinates, checked ([`super::certify_check`]),
//! repaired around each defect ([`super::certify_repair`]) and checked again, all pairs of changed triangles against all others;
//! pairs of unchanged ones have been seen already. The complex itself stays as it is.
//!
//! Invariant of the result: the triangles of every cell close, whatever was merged. If the report says so, it is free of
//! defects. Cost: the check, about as much as the cut; repairs some milliseconds each.

use super::certify_check::{Surface, contacts, star_shaped, volume_sign};
use super::certify_repair::{Defect, LEVELS, Mender};
use super::certify_work::Work;
use super::data::{Complex, Origin};
use super::triangulate::triangulated;
use crate::base::{CellId, Csr, Error, FaceId, Result, Run, ShellId, TriangleId, VertexId};
use crate::exact::Sign;
use crate::mesh::bvh::build_bvh;
use rayon::prelude::*;

/// How often a repair may start again from what the check after it still finds.
const PASSES: usize = 4;

/// What the caller decides.
#[derive(Clone, Debug, Default)]
pub struct CertifyOptions {
    /// Vertices that stay where they are: one entry per vertex of the complex, or empty.
    pub fixed: Vec<bool>,
    /// Repair nothing.
    pub check_only: bool,
    /// Ask about pairs of uncut input triangles too (they meet only if the input intersects itself).
    pub check_input: bool,
}

/// What was found and what was done. Lengths are in the unit of the coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CertifyReport {
    /// Nothing remains.
    pub certified: bool,
    /// Before any repair: triangles without area, pairs of triangles in contact that bound one cell or the outside, shells with
    /// the wrong sign of volume.
    pub flat_before: usize,
    pub contacts_before: usize,
    pub shells_before: usize,
    /// Vertices that are not at their correctly rounded coordinates, and how many of these are vertices of the mesh.
    pub moved: usize,
    pub moved_mesh_vertices: usize,
    /// The largest change of a coordinate, merged vertices included; and the unit of a move.
    pub largest_move: f64,
    pub unit: f64,
    /// Vertices merged into others; faces and cells that are gone.
    pub merged: usize,
    pub removed_faces: usize,
    pub removed_cells: usize,
    /// Faces of the complex in contact, or twice one with a triangle without area or folded onto another: sorted, each pair once.
    pub open_faces: Vec<[FaceId; 2]>,
    /// Cells of the complex whose volume, or that of a void in them, does not have its sign (asked where no faces are open).
    pub open_cells: Vec<CellId>,
}

/// A complex on doubles. Vertices, faces and cells are numbered anew without those that are gone, in the same order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CertifiedComplex {
    pub coords: Vec<[f64; 3]>,
    /// The triangles of each face, oriented like it.
    pub triangles: Csr<[VertexId; 3]>,
    /// The cells behind and before each triangle (`NONE`: outside). All triangles of a face have the same, but where a
    /// cell between two faces went.
    pub triangle_cells: Vec<[CellId; 2]>,
    pub cell_count: usize,
    /// From the complex's ids to those here; a merged vertex has the one that it was merged into; `NONE` for what is gone.
    pub vertex_map: Vec<VertexId>,
    pub face_map: Vec<FaceId>,
    pub cell_map: Vec<CellId>,
    pub report: CertifyReport,
}

/// Certifies a complex. Runs on the current rayon pool; the result does not depend on its size.
///
/// Errors: `Inconsistent` if a face contradicts itself (input that intersects itself), `Cancelled`.
pub fn certify(c: &Complex, options: &CertifyOptions, run: &mut Run) -> Result<CertifiedComplex> {
    run.stage("triangulate", 0.0)?;
    let rows = triangulated(c).map_err(Error::inconsistent)?;
    let mut work = Work::new(c, &rows);
    drop(rows);
    let mesh: Vec<bool> = c.origins.iter().map(|o| matches!(o, Origin::Mesh(_))).collect();
    let not_fixed = if options.fixed.is_empty() { vec![false; c.vertex_count()] } else { Vec::new() };
    let fixed = if options.fixed.is_empty() { &not_fixed } else { &options.fixed };
    let exact = |t: &[VertexId; 3]| !options.check_input && t.iter().all(|v| mesh[v.at()]);
    let mut marked: Vec<bool> = work.triangles.iter().map(|t| !exact(t)).collect();
    run.stage("check", 0.1)?;
    let sides: Vec<[CellId; 2]> = work.face.iter().map(|f| c.face_cells[f.at()]).collect();
    // Input that intersects itself has no exact cells to start from.
    let proven = if options.check_input { Vec::new() } else { proven_cells(c, &work, &sides) };
    let mut defects = find_first(&work, &sides, &proven, &marked, options.check_input);
    let mut shells = if defects.is_empty() { open_shells(c, &work, &proven) } else { Vec::new() };
    let flat_before = defects.iter().filter(|[a, b]| a == b).count();
    let unit = unit(c);
    let mut report = CertifyReport {
        flat_before,
        contacts_before: defects.len() - flat_before,
        shells_before: shells.len(),
        unit,
        ..Default::default()
    };
    let mut bvh = None;
    for pass in 0..PASSES {
        if options.check_only || defects.is_empty() {
            break;
        }
        let old = bvh.take().unwrap_or_else(|| build_bvh(&work.coords, &work.triangles));
        run.stage("repair", 0.4 + 0.1 * pass as f64)?;
        marked.iter_mut().for_each(|m| *m = false);
        defects.iter().flatten().for_each(|t| marked[t.at()] = true);
        let mut mender = Mender::new(c, &mut work, &old, &mesh, fixed, unit, std::mem::take(&mut defects));
        for level in 0..LEVELS {
            if mender.defects.is_empty() {
                break;
            }
            mender.level(level);
            run.tick("repair", 0.4 + 0.1 * pass as f64)?;
        }
        mender.touched.iter().for_each(|t| marked[t.at()] = true);
        run.stage("check again", 0.45 + 0.1 * pass as f64)?;
        let new = build_bvh(&work.coords, &work.triangles);
        marked.iter_mut().zip(&work.alive).for_each(|(m, a)| *m &= *a);
        let (sides, proven) = Default::default();
        let surface = Surface {
            coords: &work.coords,
            triangles: &work.triangles,
            alive: &work.alive,
            marked: &marked,
            sides,
            proven,
        };
        defects = contacts(&surface, &new);
        bvh = Some(new);
        shells = if defects.is_empty() { open_shells(c, &work, &[]) } else { Vec::new() };
    }
    run.stage("number", 0.95)?;
    report.open_faces =
        defects.iter().map(|d| d.map(|t| work.face[t.at()])).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    report.open_faces.sort_unstable();
    report.open_faces.dedup();
    let cell_of_shell = |s: ShellId| CellId::of(c.cell_shells.partition_point(|&first| first <= s.0) - 1);
    report.open_cells = shells.into_iter().map(cell_of_shell).collect();
    report.open_cells.dedup();
    report.certified = report.open_faces.is_empty() && report.open_cells.is_empty();
    let result = number(c, &work, &mesh, report);
    debug_assert_eq!(result.check(), Ok(()));
    run.end_stage();
    Ok(result)
}

/// An ulp of the largest |coordinate| of the bounding box.
fn unit(c: &Complex) -> f64 {
    let largest = c.mesh.bbox.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let up = largest.next_up() - largest;
    if up.is_finite() { up } else { largest - largest.next_down() }
}

/// The cells that are seen whole from a point inside.
fn proven_cells(c: &Complex, w: &Work, sides: &[[CellId; 2]]) -> Vec<bool> {
    let both = sides.iter().enumerate().flat_map(|(t, &[behind, before])| {
        let t = TriangleId::of(t);
        [(behind, (t, false)), (before, (t, true))].into_iter().filter(|x| x.0.is_some())
    });
    let rows = Csr::from_pairs(c.cell_count(), both.map(|(k, side)| (k.at(), side)));
    let size = c.mesh.bbox.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let proven = |k: usize| {
        c.cell_shells[k + 1] - c.cell_shells[k] == 1
            && star_shaped(&w.coords, size, rows.row(k).iter().map(|&side| outward(w, side)))
    };
    (0..c.cell_count()).into_par_iter().with_min_len(64).map(proven).collect()
}

fn outward(w: &Work, (t, front): (TriangleId, bool)) -> [VertexId; 3] {
    let [a, b, c] = w.triangles[t.at()];
    if front { [a, c, b] } else { [a, b, c] }
}

/// All defects of a complex that nothing has changed yet. Only triangles at cells that are not proven, or at the outside, come
/// into the hierarchy.
fn find_first(w: &Work, sides: &[[CellId; 2]], proven: &[bool], marked: &[bool], all_pairs: bool) -> Vec<Defect> {
    let whole = Surface { coords: &w.coords, triangles: &w.triangles, alive: &w.alive, marked, sides, proven };
    let open = |t: &usize| sides[*t].iter().any(|k| whole.is_open(*k));
    let some: Vec<TriangleId> = (0..w.triangles.len()).filter(open).map(TriangleId::of).collect();
    let triangles: Vec<[VertexId; 3]> = some.iter().map(|t| w.triangles[t.at()]).collect();
    let marked: Vec<bool> = some.iter().map(|t| marked[t.at()]).collect();
    let sides: Vec<[CellId; 2]> = if all_pairs { Vec::new() } else { some.iter().map(|t| sides[t.at()]).collect() };
    let bvh = build_bvh(&w.coords, &triangles);
    let alive = vec![true; some.len()];
    let part = Surface { triangles: &triangles, alive: &alive, marked: &marked, sides: &sides, ..whole };
    contacts(&part, &bvh).into_iter().map(|d| d.map(|t| some[t.at()])).collect()
}

/// The shells whose volume does not have its sign: outer ones positive, voids negative. Those of proven cells have.
fn open_shells(c: &Complex, w: &Work, proven: &[bool]) -> Vec<ShellId> {
    let mut expected = vec![Sign::Zero; c.shell_faces.len()];
    for k in (0..c.cell_count()).filter(|&k| !proven.get(k).is_some_and(|p| *p)) {
        let (first, end) = (c.cell_shells[k] as usize, c.cell_shells[k + 1] as usize);
        expected[first..end].fill(Sign::Negative);
        expected[first] = Sign::Positive;
    }
    let asked = |s: ShellId| s.is_some() && !expected[s.at()].is_zero();
    let sides = (0..w.triangles.len()).filter(|&t| w.alive[t]).flat_map(|t| {
        let [behind, before] = w.shells[t];
        [(behind, (TriangleId::of(t), false)), (before, (TriangleId::of(t), true))]
    });
    let sides = sides.filter(|x| asked(x.0)).map(|(s, side)| (s.at(), side));
    let rows = Csr::from_pairs(c.shell_faces.len(), sides);
    let wrong = |s: &usize| {
        let row = rows.row(*s);
        !row.is_empty() && volume_sign(&w.coords, row.iter().map(|&side| outward(w, side))) != expected[*s]
    };
    (0..c.shell_faces.len()).into_par_iter().with_min_len(64).filter(wrong).map(ShellId::of).collect()
}

/// Numbers what is left, and finishes the report.
fn number(c: &Complex, w: &Work, mesh: &[bool], mut report: CertifyReport) -> CertifiedComplex {
    let mut used = vec![false; c.vertex_count()];
    let mut shell_used = vec![false; c.shell_faces.len()];
    let mut face_used = vec![false; c.face_count()];
    let living = || (0..w.triangles.len()).filter(|&t| w.alive[t]);
    for t in living() {
        w.triangles[t].iter().for_each(|v| used[v.at()] = true);
        w.shells[t].iter().filter(|s| s.is_some()).for_each(|s| shell_used[s.at()] = true);
        face_used[w.face[t].at()] = true;
    }
    let mut out = CertifiedComplex::default();
    let mut new_vertex = vec![VertexId::NONE; c.vertex_count()];
    for v in (0..c.vertex_count()).filter(|&v| used[v]) {
        new_vertex[v] = VertexId::of(out.coords.len());
        out.coords.push(w.coords[v]);
    }
    out.vertex_map = (0..c.vertex_count()).map(|v| new_vertex[w.now(VertexId::of(v)).at()]).collect();
    for (v, of_mesh) in mesh.iter().enumerate() {
        let now = w.now(VertexId::of(v)).at();
        report.merged += (now != v) as usize;
        if used[now] && w.coords[now] != c.coords[v] {
            report.moved += 1;
            report.moved_mesh_vertices += *of_mesh as usize;
            let by = (0..3).map(|i| (w.coords[now][i] - c.coords[v][i]).abs()).fold(0.0, f64::max);
            report.largest_move = report.largest_move.max(by);
        }
    }
    let mut cells = 0;
    for k in 0..c.cell_count() {
        // A cell without its outer shell has no inside left; its voids went with it or are open.
        let there = shell_used[c.cell_shells[k] as usize..c.cell_shells[k + 1] as usize].contains(&true);
        out.cell_map.push(if there { CellId::of(cells) } else { CellId::NONE });
        cells += there as usize;
    }
    (out.cell_count, report.removed_cells) = (cells, c.cell_count() - cells);
    let mut cell_of_shell = vec![CellId::NONE; c.shell_faces.len()];
    for k in 0..c.cell_count() {
        cell_of_shell[c.cell_shells[k] as usize..c.cell_shells[k + 1] as usize].fill(out.cell_map[k]);
    }
    let cell = |s: ShellId| if s.is_none() { CellId::NONE } else { cell_of_shell[s.at()] };
    let mut faces = 0;
    out.face_map = face_used
        .iter()
        .map(|&there| {
            faces += there as usize;
            if there { FaceId::of(faces - 1) } else { FaceId::NONE }
        })
        .collect();
    report.removed_faces = c.face_count() - faces;
    out.triangles = Csr::with_capacity(faces, w.triangles.len());
    let mut last = FaceId::NONE;
    for t in living() {
        if last.is_some() && w.face[t] != last {
            out.triangles.end_row();
        }
        last = w.face[t];
        out.triangles.items.push(w.triangles[t].map(|v| new_vertex[v.at()]));
        out.triangle_cells.push(w.shells[t].map(cell));
    }
    if last.is_some() {
        out.triangles.end_row();
    }
    out.report = report;
    out
}

impl CertifiedComplex {
    /// Ids in range and all used, triangles with three corners between two cells, and the triangles of every cell closed.
    pub fn check(&self) -> std::result::Result<(), String> {
        self.triangles.check()?;
        if self.triangle_cells.len() != self.triangles.items.len() {
            return Err("as many pairs of cells as triangles".into());
        }
        let faces = self.face_map.iter().filter(|f| f.is_some()).count();
        if self.triangles.len() != faces || self.triangles.rows().any(|r| r.is_empty()) {
            return Err("a face without triangles, or one that no face became".into());
        }
        let mut used = vec![false; self.coords.len()];
        let mut inside = vec![false; self.cell_count];
        let mut sides = Vec::with_capacity(6 * self.triangles.items.len());
        for (t, (corners, cells)) in self.triangles.items.iter().zip(&self.triangle_cells).enumerate() {
            let [a, b, d] = *corners;
            if a == b || b == d || d == a || corners.iter().any(|v| v.at() >= self.coords.len()) {
                return Err(format!("triangle {t} has no three corners"));
            }
            if cells[0] == cells[1] || cells.iter().any(|k| k.is_some() && k.at() >= self.cell_count) {
                return Err(format!("triangle {t} is not between two cells"));
            }
            corners.iter().for_each(|v| used[v.at()] = true);
            for (k, front) in [(cells[0], false), (cells[1], true)].into_iter().filter(|x| x.0.is_some()) {
                inside[k.at()] = true;
                for (u, v) in [(a, b), (b, d), (d, a)] {
                    let forward = (u < v) != front;
                    sides.push((k, u.min(v), u.max(v), if forward { 1 } else { -1 }));
                }
            }
        }
        if used.contains(&false) || inside.contains(&false) {
            return Err("a vertex or a cell without triangles".into());
        }
        sides.sort_unstable();
        let open =
            sides.chunk_by(|x, y| (x.0, x.1, x.2) == (y.0, y.1, y.2)).find(|e| e.iter().map(|x| x.3).sum::<i32>() != 0);
        match open {
            Some(e) => Err(format!("cell {} is open at vertices {} and {}", e[0].0.0, e[0].1.0, e[0].2.0)),
            None => Ok(()),
        }
    }
}

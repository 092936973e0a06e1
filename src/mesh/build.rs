//! From flat arrays to a valid mesh, or to the list of everything that is wrong with them.
//!
//! Stages: indices and coordinates → used vertices, duplicates → degenerate triangles → edges and their balance →
//! components, shells, volumes → self-intersection (optional) → nesting. Every stage judges what the defects found so
//! far still let it judge; at the end there is a mesh without defects or an error with all of them, sorted, the first one in
//! words. Ids in defects are those of the input.
//!
//! Degenerate cases: −0 becomes +0 on the way in, so equal coordinates have equal bits; vertices that no triangle uses are
//! dropped (but a coordinate that is not finite is a defect even there: the array is not what the caller believes).
//!
//! Cost: linear, and shared out among threads; about 0.05 µs per triangle for one shell.

use super::edges::{EdgeTable, edge_table};
use super::shells::{Sets, Surface};
use super::{Shell, TriMesh, bvh, nesting, self_intersection, shells, validate, volume};
use crate::base::parallel::map_ranges;
use crate::base::{ComponentId, Culprit, DefectKind, Error, Result, Run, ShellId, Status, TriangleId, VertexId};
use crate::exact::Sign;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// A triangle mesh as flat arrays, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct MeshInput<'a> {
    pub vertices: &'a [[f64; 3]],
    /// Corners counter-clockwise as seen from outside the solid.
    pub triangles: &'a [[i32; 3]],
    /// One per triangle.
    pub tags: Option<&'a [i32]>,
}

#[derive(Clone, Copy, Debug, Default)]
pub struct MeshOptions {
    /// Vertices with equal coordinates become one (the lowest); otherwise they are a defect.
    pub merge_duplicate_vertices: bool,
    /// Look for triangles that meet outside what they share by index, exactly.
    pub check_self_intersection: bool,
}

/// At most so many self-intersections are listed: a soup of n triangles may have n² / 2.
pub const MAX_SELF_INTERSECTIONS: usize = 1 << 20;

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

/// Largest numbers of vertices and triangles: vertices and corners are numbered by `i32`.
pub const MAX_VERTICES: usize = i32::MAX as usize;
pub const MAX_TRIANGLES: usize = i32::MAX as usize / 3;

/// Triangles on the way through the checks, with what their ids were in the input.
#[derive(Default)]
struct Work {
    vertices: Vec<[f64; 3]>,
    vertex_source: Vec<u32>,
    triangles: Vec<[VertexId; 3]>,
    /// Empty when no triangle was left out.
    triangle_source: Vec<u32>,
    /// Vertices at which a triangle was left out, and whether one was left out that may close any edge.
    suspect: Vec<bool>,
    all_suspect: bool,
}

impl Work {
    fn triangle(&self, t: usize) -> i64 {
        self.triangle_source.get(t).map_or(t as i64, |&s| s as i64)
    }
    fn vertex(&self, v: VertexId) -> i64 {
        self.vertex_source[v.at()] as i64
    }
    /// `number` gives a vertex's number here, `u32::MAX` if it is not used.
    fn set_suspects(&mut self, suspects: &[u32], number: impl Fn(u32) -> u32) {
        if !suspects.is_empty() {
            self.suspect = vec![false; self.vertices.len()];
        }
        for &v in suspects {
            if let Some(suspect) = self.suspect.get_mut(number(v) as usize) {
                *suspect = true;
            }
        }
    }
    fn is_suspect(&self, v: VertexId) -> bool {
        self.all_suspect || self.suspect.get(v.at()).is_some_and(|s| *s)
    }
}

/// Builds and validates a mesh.
///
/// Errors: `TooLarge` for counts beyond [`MAX_VERTICES`] or [`MAX_TRIANGLES`]; `BadArgument` for tags of another length;
/// `BadMesh` with all defects that can be determined; `Inconsistent` where self-intersecting input, unchecked, leaves the
/// nesting undecided; `Cancelled`.
pub fn build(input: &MeshInput, options: &MeshOptions, run: &mut Run) -> Result<TriMesh> {
    check_counts(input)?;
    run.stage("mesh: coordinates and indices", 0.0)?;
    let mut defects = Vec::new();
    validate::non_finite(input.vertices, &mut defects);
    validate::out_of_range(input.vertices.len(), input.triangles, &mut defects);
    if input.triangles.is_empty() {
        defects.push(Culprit::new(DefectKind::Empty, &[]));
        return Err(bad_mesh(defects));
    }
    let work = gather(input, options, &mut defects);
    validate::degenerate(&work.vertices, &work.triangles, |t| {
        defects.push(Culprit::new(DefectKind::DegenerateTriangle, &[work.triangle(t)]));
    });

    run.stage("mesh: edges", 0.2)?;
    let table = edge_table(work.vertices.len(), &work.triangles);
    let mut balanced = true;
    validate::unbalanced(&table, |e, kind| {
        balanced = false;
        let [lo, hi] = table.edges[e];
        if !work.is_suspect(lo) && !work.is_suspect(hi) {
            let t = table.edge_uses.row(e)[0].triangle;
            let (a, b) = (work.vertex(lo), work.vertex(hi));
            defects.push(Culprit::new(kind, &[a.min(b), a.max(b), work.triangle(t.at())]));
        }
    });

    run.stage("mesh: shells", 0.5)?;
    let components = shells::components(&table.triangle_edges, &table.edge_uses);
    if !defects.is_empty() {
        diagnose(&work, &table, &components, options, run, &mut defects)?;
        return Err(bad_mesh(defects));
    }
    let surface = surface(&work, &table);
    let shells = shells::shells(surface);
    let signs = signs(&work.vertices, &work.triangles, shells.as_ref().unwrap_or(&components));
    let mut mesh = assemble(work, table, components, shells, &signs);
    mesh.tags = input.tags.map(<[i32]>::to_vec).unwrap_or_default();
    zero_volumes(&mesh.shells, &signs, |t| t as i64, &mut defects);

    if options.check_self_intersection {
        run.stage("mesh: self-intersection", 0.6)?;
        let tree = bvh::build_bvh(&mesh.vertices, &mesh.triangles);
        intersections(&mesh.vertices, &mesh.triangles, &tree, |t| t as i64, &mut defects);
    }
    if defects.is_empty() {
        run.stage("mesh: nesting", 0.9)?;
        defects = nesting::nest(&mut mesh)?;
    }
    if !defects.is_empty() {
        return Err(bad_mesh(defects));
    }
    run.end_stage();
    Ok(mesh)
}

/// Builds part of a mesh: some of its triangles, perhaps none, so edges may be open. What is there is checked as [`build`] does; balance of edges,
/// shells and nesting are not, nor self-intersection. Each edge-connected component counts as an outer shell. Only `cut_grid` takes such a mesh;
/// it requires balance where the mesh meets its block.
///
/// Errors: as for [`build`], without those that need the whole mesh. An edge with more uses one way than the other is no error.
pub fn build_patch(input: &MeshInput, options: &MeshOptions, run: &mut Run) -> Result<TriMesh> {
    check_counts(input)?;
    run.stage("mesh: coordinates and indices", 0.0)?;
    let mut defects = Vec::new();
    validate::non_finite(input.vertices, &mut defects);
    validate::out_of_range(input.vertices.len(), input.triangles, &mut defects);
    let work = gather(input, options, &mut defects);
    validate::degenerate(&work.vertices, &work.triangles, |t| {
        defects.push(Culprit::new(DefectKind::DegenerateTriangle, &[work.triangle(t)]));
    });
    if !defects.is_empty() {
        return Err(bad_mesh(defects));
    }
    run.stage("mesh: edges", 0.2)?;
    let table = edge_table(work.vertices.len(), &work.triangles);
    let components = shells::components(&table.triangle_edges, &table.edge_uses);
    let signs = vec![Sign::Positive; components.lowest.len()];
    let mut mesh = assemble(work, table, components, None, &signs);
    mesh.tags = input.tags.map(<[i32]>::to_vec).unwrap_or_default();
    run.end_stage();
    Ok(mesh)
}

fn check_counts(input: &MeshInput) -> Result<()> {
    let (v, t) = (input.vertices.len(), input.triangles.len());
    if v > MAX_VERTICES {
        return Err(Error::new(Status::TooLarge, format!("{v} vertices; at most {MAX_VERTICES} are possible")));
    }
    if t > MAX_TRIANGLES {
        return Err(Error::new(Status::TooLarge, format!("{t} triangles; at most {MAX_TRIANGLES} are possible")));
    }
    if let Some(tags) = input.tags
        && tags.len() != t
    {
        return Err(Error::new(Status::BadArgument, format!("{} tags for {t} triangles", tags.len())));
    }
    Ok(())
}

/// All defects, sorted; the first one in words.
pub(super) fn bad_mesh(mut defects: Vec<Culprit>) -> Error {
    defects.sort_unstable();
    defects.dedup();
    let first = validate::describe(&defects[0]);
    let message = match defects.len() - 1 {
        0 => first,
        1 => format!("{first}; and 1 more defect"),
        n => format!("{first}; and {n} more defects"),
    };
    Error::with(Status::BadMesh, message, defects)
}

/// Leaves out triangles without three vertices, merges or reports duplicate vertices, drops unused ones and numbers the
/// rest in input order.
fn gather(input: &MeshInput, options: &MeshOptions, defects: &mut Vec<Culprit>) -> Work {
    let count = input.vertices.len();
    let all_in_range = !defects.iter().any(|d| d.kind == DefectKind::IndexOutOfRange);
    let all_finite = !defects.iter().any(|d| d.kind == DefectKind::NonFiniteCoordinate);
    let mut work = Work::default();
    let kept: Vec<[i32; 3]>;
    let mut triangles = input.triangles;
    let mut suspects: Vec<u32> = Vec::new();
    if !all_in_range {
        let whole = |t: &[i32; 3]| t.iter().all(|&i| validate::in_range(i, count));
        kept = triangles.iter().copied().filter(whole).collect();
        work.triangle_source = (0..triangles.len() as u32).filter(|&t| whole(&triangles[t as usize])).collect();
        for t in triangles.iter().filter(|t| !whole(t)) {
            let valid = t.iter().filter(|&&i| validate::in_range(i, count));
            suspects.extend(valid.clone().map(|&i| i as u32));
            work.all_suspect |= valid.count() < 2;
        }
        triangles = &kept;
    }

    // First which vertices are used, then their numbers.
    let used: Vec<AtomicBool> = (0..count).map(|_| AtomicBool::new(false)).collect();
    map_ranges(triangles.len(), LEAST, |range| {
        triangles[range].iter().flatten().for_each(|&i| used[i as usize].store(true, Ordering::Relaxed));
    });
    let is_used = |v: u32| used[v as usize].load(Ordering::Relaxed);
    let plus_zero: Vec<[f64; 3]> = input.vertices.par_iter().with_min_len(LEAST).map(|x| x.map(|c| c + 0.0)).collect();
    let comparable = |v: u32| is_used(v) && (all_finite || validate::is_finite(&plus_zero[v as usize]));
    let pairs = validate::duplicates(&plus_zero, comparable);
    if (pairs.is_empty() || !options.merge_duplicate_vertices) && (0..count as u32).all(is_used) {
        // Every vertex keeps its number.
        let duplicate = |p: &[u32; 2]| Culprit::new(DefectKind::DuplicateVertex, &p.map(i64::from));
        defects.extend(pairs.iter().map(duplicate));
        work.triangles = triangles.par_iter().with_min_len(LEAST).map(|t| t.map(|i| VertexId(i as u32))).collect();
        work.vertices = plus_zero;
        work.vertex_source = (0..count as u32).collect();
        work.set_suspects(&suspects, |v| v);
        return work;
    }
    const UNUSED: u32 = u32::MAX;
    let mut number: Vec<u32> = (0..count as u32).map(|v| if is_used(v) { 0 } else { UNUSED }).collect();
    if options.merge_duplicate_vertices {
        for &[_, other] in &pairs {
            number[other as usize] = UNUSED;
        }
    } else {
        let duplicate = |p: &[u32; 2]| Culprit::new(DefectKind::DuplicateVertex, &p.map(i64::from));
        defects.extend(pairs.iter().map(duplicate));
    }
    work.vertex_source = (0..count as u32).filter(|&v| number[v as usize] != UNUSED).collect();
    for (new, &v) in work.vertex_source.iter().enumerate() {
        number[v as usize] = new as u32;
    }
    if options.merge_duplicate_vertices {
        for &[lowest, other] in &pairs {
            number[other as usize] = number[lowest as usize];
        }
    }
    work.triangles = triangles.iter().map(|t| t.map(|i| VertexId(number[i as usize]))).collect();
    if work.vertex_source.len() == count {
        work.vertices = plus_zero;
    } else {
        work.vertices = work.vertex_source.iter().map(|&v| plus_zero[v as usize]).collect();
    }
    work.set_suspects(&suspects, |v| number[v as usize]);
    work
}

fn surface<'a>(work: &'a Work, table: &'a EdgeTable) -> Surface<'a> {
    Surface { vertices: &work.vertices, triangles: &work.triangles, edges: &table.edges, edge_uses: &table.edge_uses }
}

/// The sign of each set's volume.
pub(super) fn signs(vertices: &[[f64; 3]], triangles: &[[VertexId; 3]], shells: &Sets) -> Vec<Sign> {
    volume::volume_signs(vertices, triangles, &shells.of, shells.lowest.len())
}

/// Lowest and highest corner; of no vertices, the origin.
pub fn bounding_box(vertices: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let wider = |[mut lo, mut hi]: [[f64; 3]; 2], x: &[f64; 3], y: &[f64; 3]| {
        for i in 0..3 {
            lo[i] = lo[i].min(x[i]);
            hi[i] = hi[i].max(y[i]);
        }
        [lo, hi]
    };
    let parts = map_ranges(vertices.len(), LEAST, |range| {
        let start = [vertices.get(range.start).copied().unwrap_or_default(); 2];
        vertices[range].iter().fold(start, |b, x| wider(b, x, x))
    });
    parts.iter().fold(parts[0], |b, p| wider(b, &p[0], &p[1]))
}

fn assemble(work: Work, table: EdgeTable, components: Sets, shells: Option<Sets>, signs: &[Sign]) -> TriMesh {
    let component_count = components.lowest.len();
    let list = shell_list(&components, shells.as_ref().unwrap_or(&components), signs);
    let of = shells.map_or(components.of, |s| s.of);
    TriMesh {
        shells: list,
        bbox: bounding_box(&work.vertices),
        vertices: work.vertices,
        vertex_source: work.vertex_source,
        triangles: work.triangles,
        tags: Vec::new(),
        edges: table.edges,
        triangle_edges: table.triangle_edges,
        edge_uses: table.edge_uses,
        triangle_shell: of.into_iter().map(ShellId).collect(),
        component_count,
    }
}

/// Without anchors yet.
pub(super) fn shell_list(components: &Sets, shells: &Sets, signs: &[Sign]) -> Vec<Shell> {
    let shell = |(&lowest, &sign): (&u32, &Sign)| Shell {
        triangle: TriangleId(lowest),
        component: ComponentId(components.of[lowest as usize]),
        outer: sign == Sign::Positive,
        anchor: None,
    };
    shells.lowest.iter().zip(signs).map(shell).collect()
}

pub(super) fn zero_volumes(shells: &[Shell], signs: &[Sign], name: impl Fn(usize) -> i64, defects: &mut Vec<Culprit>) {
    for (shell, _) in shells.iter().zip(signs).filter(|(_, s)| **s == Sign::Zero) {
        defects.push(Culprit::new(DefectKind::ZeroVolume, &[name(shell.triangle.at())]));
    }
}

pub(super) fn intersections(
    vertices: &[[f64; 3]],
    triangles: &[[VertexId; 3]],
    tree: &bvh::Bvh,
    name: impl Fn(usize) -> i64,
    defects: &mut Vec<Culprit>,
) {
    let pairs = self_intersection::self_intersections(vertices, triangles, tree, MAX_SELF_INTERSECTIONS);
    let ids = pairs.iter().map(|p| p.map(|t| name(t.at())));
    defects.extend(ids.map(|p| Culprit::new(DefectKind::SelfIntersection, &p)));
}

/// What can still be said of a mesh with defects: shells without volume among the components that are whole, and
/// self-intersections among the triangles that are. Nesting cannot be judged: what is missing may enclose the rest.
fn diagnose(
    work: &Work,
    table: &EdgeTable,
    components: &Sets,
    options: &MeshOptions,
    run: &mut Run,
    defects: &mut Vec<Culprit>,
) -> Result<()> {
    let mut good_triangle: Vec<bool> =
        work.triangles.iter().map(|t| t.iter().all(|v| validate::is_finite(&work.vertices[v.at()]))).collect();
    validate::degenerate(&work.vertices, &work.triangles, |t| good_triangle[t] = false);
    let mut good_component = vec![true; components.lowest.len()];
    for (t, corners) in work.triangles.iter().enumerate() {
        if !good_triangle[t] || corners.iter().any(|&v| work.is_suspect(v)) {
            good_component[components.of[t] as usize] = false;
        }
    }
    validate::unbalanced(table, |e, _| {
        good_component[components.of[table.edge_uses.row(e)[0].triangle.at()] as usize] = false;
    });
    // Whole components are meshes of their own.
    let part: Vec<usize> = (0..work.triangles.len()).filter(|&t| good_component[components.of[t] as usize]).collect();
    let triangles: Vec<[VertexId; 3]> = part.iter().map(|&t| work.triangles[t]).collect();
    let own = edge_table(work.vertices.len(), &triangles);
    let own_components = shells::components(&own.triangle_edges, &own.edge_uses);
    let surface =
        Surface { vertices: &work.vertices, triangles: &triangles, edges: &own.edges, edge_uses: &own.edge_uses };
    let own_shells = shells::shells(surface).unwrap_or_else(|| own_components.clone());
    let signs = signs(&work.vertices, &triangles, &own_shells);
    zero_volumes(&shell_list(&own_components, &own_shells, &signs), &signs, |t| work.triangle(part[t]), defects);

    if options.check_self_intersection {
        run.stage("mesh: self-intersection", 0.6)?;
        let part: Vec<usize> = (0..work.triangles.len()).filter(|&t| good_triangle[t]).collect();
        let triangles: Vec<[VertexId; 3]> = part.iter().map(|&t| work.triangles[t]).collect();
        let tree = bvh::build_bvh(&work.vertices, &triangles);
        intersections(&work.vertices, &triangles, &tree, |t| work.triangle(part[t]), defects);
    }
    Ok(())
}

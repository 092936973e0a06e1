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
//! Cost: linear but for the sort of vertices that finds duplicates; about 0.1 µs per triangle for one shell.

use super::edges::{EdgeTable, edge_table};
use super::shells::Surface;
use super::{Shell, TriMesh, bvh, nesting, self_intersection, shells, validate, volume};
use crate::base::{ComponentId, Culprit, DefectKind, Error, Result, Run, ShellId, Status, TriangleId, VertexId};
use crate::exact::Sign;

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
    let components = shells::components(work.triangles.len(), &table.edge_uses);
    if !defects.is_empty() {
        diagnose(&work, &table, &components, options, run, &mut defects)?;
        return Err(bad_mesh(defects));
    }
    let surface = surface(&work, &table);
    let (triangle_shell, shell_count) = shells::shells(surface, &components);
    let signs = volume::volume_signs(&work.vertices, &work.triangles, &triangle_shell, shell_count);
    let mut mesh = assemble(work, table, &components, &triangle_shell, &signs);
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
    let components = shells::components(work.triangles.len(), &table.edge_uses);
    let signs = vec![Sign::Positive; components.1];
    let triangle_shell = components.0.clone();
    let mut mesh = assemble(work, table, &components, &triangle_shell, &signs);
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
fn bad_mesh(mut defects: Vec<Culprit>) -> Error {
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
    const UNUSED: u32 = u32::MAX;
    let mut number = vec![UNUSED; count];
    for &i in triangles.iter().flatten() {
        number[i as usize] = 0;
    }
    let plus_zero: Vec<[f64; 3]> = input.vertices.iter().map(|x| x.map(|c| c + 0.0)).collect();
    let comparable =
        |&v: &u32| number[v as usize] != UNUSED && (all_finite || validate::is_finite(&plus_zero[v as usize]));
    let pairs = validate::duplicates(&plus_zero, (0..count as u32).filter(comparable));
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
    if !suspects.is_empty() {
        work.suspect = vec![false; work.vertices.len()];
        for v in suspects {
            if number[v as usize] != UNUSED {
                work.suspect[number[v as usize] as usize] = true;
            }
        }
    }
    work
}

fn surface<'a>(work: &'a Work, table: &'a EdgeTable) -> Surface<'a> {
    Surface { vertices: &work.vertices, triangles: &work.triangles, edges: &table.edges, edge_uses: &table.edge_uses }
}

fn assemble(
    work: Work,
    table: EdgeTable,
    components: &(Vec<u32>, usize),
    triangle_shell: &[u32],
    signs: &[Sign],
) -> TriMesh {
    let mut lo = work.vertices.first().copied().unwrap_or_default();
    let mut hi = lo;
    for x in &work.vertices {
        for i in 0..3 {
            lo[i] = lo[i].min(x[i]);
            hi[i] = hi[i].max(x[i]);
        }
    }
    TriMesh {
        shells: shell_list(&components.0, triangle_shell, signs),
        vertices: work.vertices,
        vertex_source: work.vertex_source,
        triangles: work.triangles,
        tags: Vec::new(),
        edges: table.edges,
        triangle_edges: table.triangle_edges,
        edge_uses: table.edge_uses,
        triangle_shell: triangle_shell.iter().map(|&s| ShellId(s)).collect(),
        component_count: components.1,
        bbox: [lo, hi],
    }
}

/// Shells are numbered by lowest triangle, so the first triangle of a new number is that one.
fn shell_list(components: &[u32], triangle_shell: &[u32], signs: &[Sign]) -> Vec<Shell> {
    let mut list: Vec<Shell> = Vec::with_capacity(signs.len());
    for (t, &s) in triangle_shell.iter().enumerate() {
        if s as usize == list.len() {
            list.push(Shell {
                triangle: TriangleId::of(t),
                component: ComponentId(components[t]),
                outer: signs[s as usize] == Sign::Positive,
                anchor: None,
            });
        }
    }
    list
}

fn zero_volumes(shells: &[Shell], signs: &[Sign], name: impl Fn(usize) -> i64, defects: &mut Vec<Culprit>) {
    for (shell, _) in shells.iter().zip(signs).filter(|(_, s)| **s == Sign::Zero) {
        defects.push(Culprit::new(DefectKind::ZeroVolume, &[name(shell.triangle.at())]));
    }
}

fn intersections(
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
    components: &(Vec<u32>, usize),
    options: &MeshOptions,
    run: &mut Run,
    defects: &mut Vec<Culprit>,
) -> Result<()> {
    let mut good_triangle: Vec<bool> =
        work.triangles.iter().map(|t| t.iter().all(|v| validate::is_finite(&work.vertices[v.at()]))).collect();
    validate::degenerate(&work.vertices, &work.triangles, |t| good_triangle[t] = false);
    let mut good_component = vec![true; components.1];
    for (t, corners) in work.triangles.iter().enumerate() {
        if !good_triangle[t] || corners.iter().any(|&v| work.is_suspect(v)) {
            good_component[components.0[t] as usize] = false;
        }
    }
    validate::unbalanced(table, |e, _| {
        good_component[components.0[table.edge_uses.row(e)[0].triangle.at()] as usize] = false;
    });
    // Whole components are meshes of their own.
    let part: Vec<usize> = (0..work.triangles.len()).filter(|&t| good_component[components.0[t] as usize]).collect();
    let triangles: Vec<[VertexId; 3]> = part.iter().map(|&t| work.triangles[t]).collect();
    let own = edge_table(work.vertices.len(), &triangles);
    let own_components = shells::components(triangles.len(), &own.edge_uses);
    let surface =
        Surface { vertices: &work.vertices, triangles: &triangles, edges: &own.edges, edge_uses: &own.edge_uses };
    let (shell_of, count) = shells::shells(surface, &own_components);
    let signs = volume::volume_signs(&work.vertices, &triangles, &shell_of, count);
    zero_volumes(&shell_list(&own_components.0, &shell_of, &signs), &signs, |t| work.triangle(part[t]), defects);

    if options.check_self_intersection {
        run.stage("mesh: self-intersection", 0.6)?;
        let part: Vec<usize> = (0..work.triangles.len()).filter(|&t| good_triangle[t]).collect();
        let triangles: Vec<[VertexId; 3]> = part.iter().map(|&t| work.triangles[t]).collect();
        let tree = bvh::build_bvh(&work.vertices, &triangles);
        intersections(&work.vertices, &triangles, &tree, |t| work.triangle(part[t]), defects);
    }
    Ok(())
}

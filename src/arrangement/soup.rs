//! All operands as one list of triangles: bit-equal positions become one vertex, triangles without area go.
//!
//! Invariant: vertices are used, distinct and in order of first appearance; triangles keep their order, have three corners and area, and
//! rise by operand. Dropping a triangle without area changes no winding number; edges may then meet in T-junctions, which later stages split.
//!
//! Degenerate cases: −0 equals +0; operands without triangles; triangles with equal corners (in one operand or several) stay: they count.
//! Cost: linear but for the vertices whose positions may be equal, which are sorted.

use super::data::{Operand, Soup};
use super::supports::{BOX_TRIANGLES, HalfSpaces, box_corners};
use crate::base::parallel::map_ranges;
use crate::base::{Culprit, DefectKind, Error, Result, Run, Status, VertexId};
use crate::exact::{self, Plane};
use crate::mesh::build::{MAX_TRIANGLES, MAX_VERTICES, bounding_box};
use crate::mesh::edges::edge_table;
use crate::mesh::{TriMesh, validate};
use rayon::prelude::*;
use std::sync::Arc;

/// Elements in one task at least.
const LEAST: usize = 1 << 13;

/// Joins the operands.
///
/// Errors: `TooLarge`; `BadMesh` with every coordinate that is not finite and every index out of range. The ids of culprits count through all
/// operands, one behind the other; the message names the operand.
pub fn soup(operands: &[Operand], run: &mut Run) -> Result<Soup> {
    run.stage("soup", 0.0)?;
    let first_vertex = offsets(operands.iter().map(|o| o.vertices.len()), MAX_VERTICES, "vertices")?;
    let first_input = offsets(operands.iter().map(|o| o.triangles.len()), MAX_TRIANGLES, "triangles")?;
    validated(operands, &first_vertex, &first_input)?;
    run.tick("soup", 0.0)?;
    let count = *first_vertex.last().unwrap_or(&0) as usize;
    let mut positions: Vec<[f64; 3]> = Vec::with_capacity(count);
    for o in operands {
        positions.par_extend(o.vertices.par_iter().with_min_len(LEAST).map(|x| x.map(|c| c + 0.0)));
    }
    // The lowest vertex of those at one position stands for all.
    let pairs = validate::duplicates(&positions, |_| true);
    run.tick("soup", 0.0)?;
    let mut number: Vec<u32> = (0..count as u32).collect();
    pairs.iter().for_each(|&[lowest, other]| number[other as usize] = lowest);
    let mut triangles: Vec<[VertexId; 3]> = Vec::with_capacity(*first_input.last().unwrap_or(&0) as usize);
    for (o, first) in operands.iter().zip(&first_vertex) {
        let corners = |t: &[i32; 3]| t.map(|i| VertexId(number[*first as usize + i as usize]));
        triangles.par_extend(o.triangles.par_iter().with_min_len(LEAST).map(corners));
    }
    let mut without_area = Vec::new();
    validate::degenerate(&positions, &triangles, |t| without_area.push(t));
    run.tick("soup", 0.0)?;
    let mut gone = without_area.iter().copied().peekable();
    let mut source = Vec::with_capacity(triangles.len() - without_area.len());
    let (mut first_triangle, mut dropped) = (vec![0], Vec::with_capacity(operands.len()));
    for range in first_input.windows(2) {
        let before = source.len();
        source.extend((range[0]..range[1]).filter(|&t| gone.next_if_eq(&(t as usize)).is_none()).map(|t| t - range[0]));
        dropped.push(range[1] - range[0] - (source.len() - before) as u32);
        first_triangle.push(source.len() as u32);
    }
    let mut next = without_area.iter().copied().peekable();
    let mut at = 0;
    triangles.retain(|_| {
        at += 1;
        next.next_if_eq(&(at - 1)).is_none()
    });
    let (vertices, vertex_source) = number_used(positions, &mut triangles);
    run.tick("soup", 0.0)?;
    let table = edge_table(vertices.len(), &triangles);
    run.tick("soup", 0.0)?;
    let mesh = TriMesh {
        bbox: bounding_box(&vertices),
        vertices,
        vertex_source,
        triangles,
        edges: table.edges,
        triangle_edges: table.triangle_edges,
        edge_uses: table.edge_uses,
        ..TriMesh::default()
    };
    Ok(Soup { mesh: Arc::new(mesh), first_triangle, source, dropped, half_spaces: HalfSpaces::default() })
}

/// Joins the operands, and behind them half-spaces n·x + d < 0 within bounds (the lowest and the highest corner of a box; `None`: the box of all meshes,
/// with as much room on each side as it is large).
///
/// Errors: as [`soup`]; `BadPlane` with every plane that is not finite or has a zero normal; `BadArgument` for bounds that are no box, or where there are
/// neither bounds nor vertices.
pub fn soup_with(operands: &[Operand], planes: &[Plane], bounds: Option<[[f64; 3]; 2]>, run: &mut Run) -> Result<Soup> {
    if planes.is_empty() {
        return soup(operands, run);
    }
    exact::planes::validate(planes)?;
    let bounds = match bounds {
        Some(bounds) => bounds.map(|x| x.map(|c| c + 0.0)),
        None => room_around(operands)?,
    };
    if (0..3).any(|i| bounds[0][i] >= bounds[1][i] || bounds.iter().any(|x| !x[i].is_finite())) {
        let message = format!("the bounds of half-spaces are no box: {:?} to {:?}", bounds[0], bounds[1]);
        return Err(Error::new(Status::BadArgument, message));
    }
    let corners = box_corners(&bounds);
    let mut all = operands.to_vec();
    all.extend(planes.iter().map(|_| Operand { vertices: &corners, triangles: &BOX_TRIANGLES }));
    let mut soup = soup(&all, run)?;
    let stands = exact::planes::group(planes).representative;
    soup.half_spaces = HalfSpaces { planes: planes.to_vec(), stands, bounds, meshes: operands.len() };
    Ok(soup)
}

/// The box of all vertices, larger on each side by its largest extent.
fn room_around(operands: &[Operand]) -> Result<[[f64; 3]; 2]> {
    let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for x in operands.iter().flat_map(|o| o.vertices).filter(|x| x.iter().all(|c| c.is_finite())) {
        for i in 0..3 {
            lo[i] = lo[i].min(x[i]);
            hi[i] = hi[i].max(x[i]);
        }
    }
    if lo[0] > hi[0] {
        return Err(Error::new(Status::BadArgument, "half-spaces need bounds where meshes have no vertices"));
    }
    let extent = (0..3).fold(0.0f64, |m, i| m.max(hi[i] - lo[i])).min(f64::MAX);
    let down = |x: f64| (x - extent).next_down().max(f64::MIN);
    let up = |x: f64| (x + extent).next_up().min(f64::MAX);
    Ok([lo.map(down), hi.map(up)])
}

fn offsets(lengths: impl Iterator<Item = usize>, most: usize, what: &str) -> Result<Vec<u32>> {
    let mut all = vec![0u32];
    let mut sum = 0usize;
    for n in lengths {
        sum = sum.saturating_add(n);
        if sum > most {
            return Err(Error::new(Status::TooLarge, format!("{sum} {what} or more; at most {most} are possible")));
        }
        all.push(sum as u32);
    }
    Ok(all)
}

/// Every coordinate and every index.
fn validated(operands: &[Operand], first_vertex: &[u32], first_triangle: &[u32]) -> Result<()> {
    let mut all: Vec<Culprit> = Vec::new();
    let mut first = None;
    for (i, o) in operands.iter().enumerate() {
        let mut defects = Vec::new();
        validate::non_finite(o.vertices, &mut defects);
        validate::out_of_range(o.vertices.len(), o.triangles, &mut defects);
        if let (None, Some(d)) = (&first, defects.first()) {
            first = Some(format!("operand {i}: {}", validate::describe(d)));
        }
        for mut d in defects {
            let of_triangle = d.kind == DefectKind::IndexOutOfRange;
            d.ids[0] += if of_triangle { first_triangle[i] } else { first_vertex[i] } as i64;
            all.push(d);
        }
    }
    match first {
        None => Ok(()),
        Some(message) => Err(Error::with(Status::BadMesh, message, all)),
    }
}

/// Leaves out vertices that no triangle uses, and numbers the others anew.
fn number_used(positions: Vec<[f64; 3]>, triangles: &mut [[VertexId; 3]]) -> (Vec<[f64; 3]>, Vec<u32>) {
    let mut used = vec![false; positions.len()];
    triangles.iter().flatten().for_each(|v| used[v.at()] = true);
    let vertex_source: Vec<u32> = (0..positions.len() as u32).filter(|&v| used[v as usize]).collect();
    if vertex_source.len() == positions.len() {
        return (positions, vertex_source);
    }
    let mut number = vec![0u32; positions.len()];
    vertex_source.iter().enumerate().for_each(|(new, &v)| number[v as usize] = new as u32);
    triangles.par_iter_mut().with_min_len(LEAST).for_each(|t| *t = t.map(|v| VertexId(number[v.at()])));
    (vertex_source.iter().map(|&v| positions[v as usize]).collect(), vertex_source)
}

impl Soup {
    pub fn operand_count(&self) -> usize {
        self.first_triangle.len() - 1
    }

    /// Sorted adjacency, distinct vertices that are used, triangles with three corners.
    pub fn check(&self) -> std::result::Result<(), String> {
        let m = &self.mesh;
        crate::mesh::edges::check_edges(&m.triangles, &m.edges, &m.triangle_edges, &m.edge_uses)?;
        if self.source.len() != m.triangles.len() || self.first_triangle.last() != Some(&(self.source.len() as u32)) {
            return Err("as many sources as triangles".into());
        }
        if !validate::duplicates(&m.vertices, |_| true).is_empty() {
            return Err("two vertices at one position".into());
        }
        let twice = map_ranges(m.triangles.len(), LEAST, |range| {
            m.triangles[range].iter().any(|[a, b, c]| a == b || b == c || c == a)
        });
        if twice.contains(&true) { Err("a triangle with equal corners".into()) } else { Ok(()) }
    }
}

//! Euler characteristic (DESIGN §7): V − E + Σ_faces (1 − hole loops) − Σ_cells ½ Σ_shells χ(shell).
//!
//! The result is the Euler characteristic of the solid itself, whatever planes cut it, because each cell counts as the
//! open set that it is: −½ χ of the closed surface that bounds it once contacts are pulled apart.
//!
//! χ(shell) is counted over half-face orbits: its vertices are the orbits of corners under "next half-face around this
//! vertex in this cell" (a pinched vertex counts once per umbrella), its edges are the wedges, its faces are discs
//! less their holes. An isolated vertex is a hole loop of one corner: its half-faces lose 1 for the hole, and the corner
//! is an orbit of its own. A ball contributes −1, a solid torus 0, a ball with a void −2.
//!
//! Degenerate case: the tip of a dent or of a void on a plane (an isolated vertex), or on a line or point of planes. The
//! directions from there into the cell above form a convex cone of planes less the cones of u umbrellas of the surface: a region with u + 1
//! rims, χ = 1 − u. Pulled apart, the surface has a tube there instead of u + 1 discs. So an orbit that consists of
//! plane faces alone counts 1 − 2u, where u other orbits of its cell meet it at its vertex: that is 1 nearly always.
//! (Where the *input* surface is pinched at a vertex in the same way, an umbrella inside another, both expressions
//! count umbrellas; they may then differ if a plane goes through that vertex.)
//! Cost: linear, almost (union-find).

use super::adjacency::{Adjacency, HalfCorner, adjacency};
use super::data::{Complex, Origin, SupportId};
use crate::base::union_find::UnionFind;
use crate::base::{CellId, EdgeId};
use crate::mesh::shells::{WedgeScratch, wedge_mates};
use crate::mesh::{EdgeUse, TriMesh};
use rayon::prelude::*;

/// Euler characteristic of a complex. An error where the half-faces do not pair up (see [`adjacency`]).
pub fn euler(c: &Complex) -> Result<i64, String> {
    Ok(euler_with(c, &adjacency(c)?))
}

/// As [`euler`], with the adjacency at hand.
pub fn euler_with(c: &Complex, a: &Adjacency) -> i64 {
    let mut total = c.vertex_count() as i64 - c.edge_count() as i64;
    for w in c.face_loops.windows(2) {
        total += 2 - (w[1] - w[0]) as i64;
    }
    let doubled: i64 = shell_euler(c, a).iter().sum();
    // Each χ is even where the shell is closed and orientable, which half-face orbits always are.
    total - doubled / 2
}

/// Corners of half-faces joined around vertices, within cells.
fn umbrellas(c: &Complex, a: &Adjacency) -> UnionFind {
    let mut orbits = UnionFind::new(a.mates.len());
    for h in (0..a.mates.len() as u32).map(HalfCorner) {
        let mate = a.mates[h.at()];
        if mate.is_none() || mate < h {
            continue;
        }
        let next = |h: HalfCorner| HalfCorner::new(a.corner_next[h.corner()] as usize, h.front());
        if c.corner_vertices[h.corner()] == c.corner_vertices[mate.corner()] {
            orbits.union(h.at(), mate.at());
            orbits.union(next(h).at(), next(mate).at());
        } else {
            orbits.union(h.at(), next(mate).at());
            orbits.union(next(h).at(), mate.at());
        }
    }
    orbits
}

/// Whether several umbrellas of one cell, or of the solid, share a vertex. If one is inside another, as those of voids that touch the outer
/// shell in a point are, pulled apart they are no discs, and [`euler`] is not that of the solid. (Cells of planes are convex but for the input
/// surface, which [`shell_euler`] knows; regions of a network may be of any form.)
pub fn is_pinched(c: &Complex, a: &Adjacency) -> bool {
    let mut orbits = solid_umbrellas(&c.mesh);
    if (0..3 * c.mesh.triangles.len()).filter(|&i| orbits.find(i) == i).count() > c.mesh.vertices.len() {
        return true;
    }
    let mut orbits = umbrellas(c, a);
    let mut places = Vec::new();
    for h in (0..a.mates.len() as u32).map(HalfCorner) {
        let half = a.half_face(h);
        let cell = c.face_cells[half.face().at()][half.front() as usize];
        if cell.is_some() && orbits.find(h.at()) == h.at() {
            places.push((c.corner_vertices[h.corner()], cell));
        }
    }
    places.sort_unstable();
    places.windows(2).any(|w| w[0] == w[1])
}

/// χ of each shell, over half-face orbits.
pub fn shell_euler(c: &Complex, a: &Adjacency) -> Vec<i64> {
    let mut shell_of = vec![u32::MAX; 2 * c.face_count()];
    for s in 0..c.shell_faces.len() {
        for h in c.shell_faces.row(s) {
            shell_of[h.at()] = s as u32;
        }
    }
    let mut chi = vec![0i64; c.shell_faces.len()];
    let mut sides = vec![0i64; chi.len()];
    for h in (0..a.mates.len() as u32).map(HalfCorner).filter(|h| !a.mates[h.at()].is_none()) {
        sides[shell_of[a.half_face(h).at()] as usize] += 1;
    }
    let mut orbits = umbrellas(c, a);
    let mut on_surface = vec![false; a.mates.len()];
    for h in (0..a.mates.len() as u32).map(HalfCorner) {
        if matches!(c.face_support[a.corner_face[h.corner()].at()], SupportId::Triangle(_)) {
            on_surface[orbits.find(h.at())] = true;
        }
    }
    // (vertex, cell) of orbits of plane faces alone where the surface can have a tip, rising.
    let place =
        |h: HalfCorner| (c.corner_vertices[h.corner()], c.face_cells[a.half_face(h).face().at()][h.front() as usize]);
    let mut inner = Vec::new();
    for h in (0..a.mates.len() as u32).map(HalfCorner) {
        let shell = shell_of[a.half_face(h).at()];
        if shell != u32::MAX && orbits.find(h.at()) == h.at() {
            chi[shell as usize] += 1;
            if !on_surface[h.at()] && matches!(c.origins[c.corner_vertices[h.corner()].at()], Origin::Mesh(_)) {
                inner.push((place(h), shell));
            }
        }
    }
    inner.sort_unstable();
    if !inner.is_empty() {
        for h in (0..a.mates.len() as u32).map(HalfCorner).filter(|h| on_surface[h.at()]) {
            if shell_of[a.half_face(h).at()] != u32::MAX
                && orbits.find(h.at()) == h.at()
                && let Ok(i) = inner.binary_search_by_key(&place(h), |x| x.0)
            {
                chi[inner[i].1 as usize] -= 2;
            }
        }
    }
    for s in 0..chi.len() {
        chi[s] -= sides[s] / 2;
        for h in c.shell_faces.row(s) {
            let f = h.face().at();
            chi[s] += 2 - (c.face_loops[f + 1] - c.face_loops[f]) as i64;
        }
    }
    chi
}

/// χ of one cell's closure as the formula sees it: ½ Σ_shells χ(shell), from [`shell_euler`].
pub fn cell_euler(c: &Complex, shells: &[i64], cell: CellId) -> i64 {
    let (a, b) = (c.cell_shells[cell.at()] as usize, c.cell_shells[cell.at() + 1] as usize);
    shells[a..b].iter().sum::<i64>() / 2
}

/// The same expression on the uncut solid: its faces are the triangles, its shells the mesh's (triangles paired across
/// edges through wedges of solid), its bodies the cells.
pub fn solid_euler(mesh: &TriMesh) -> i64 {
    let mut orbits = solid_umbrellas(mesh);
    let orbits = (0..3 * mesh.triangles.len()).filter(|&i| orbits.find(i) == i).count() as i64;
    // Every triangle has one wall, its inner side: χ of all shells together is orbits − 3T/2 + T.
    let (v, e, t) = (mesh.vertices.len() as i64, mesh.edges.len() as i64, mesh.triangles.len() as i64);
    v - e + t - (2 * orbits - t) / 4
}

/// Corners of triangles joined around vertices, within the solid.
fn solid_umbrellas(mesh: &TriMesh) -> UnionFind {
    let sides = 3 * mesh.triangles.len();
    let mut orbits = UnionFind::new(sides);
    let corner = |u: EdgeUse, end: usize| 3 * u.triangle.at() + (u.side() + end) % 3;
    let mut scratch = WedgeScratch::default();
    let mut pairs = Vec::new();
    for e in (0..mesh.edges.len()).map(EdgeId::of) {
        wedge_mates(mesh, e, &mut scratch, &mut pairs);
        // One walks the edge backward, the other forward.
        for &[a, b] in &pairs {
            orbits.union(corner(a, 0), corner(b, 1));
            orbits.union(corner(a, 1), corner(b, 0));
        }
    }
    orbits
}

/// Vertices − edges + polygons of a mesh, as the point set that it is; of segments (polygons of two corners): vertices − edges.
pub fn surface_euler<'a>(vertex_count: usize, polygons: impl Iterator<Item = &'a [u32]>) -> i64 {
    let (mut edges, mut faces) = (Vec::new(), 0);
    for corners in polygons {
        faces += (corners.len() > 2) as i64;
        let next = corners.iter().cycle().skip(1);
        edges.extend(corners.iter().zip(next).map(|(&a, &b)| [a.min(b), a.max(b)]));
    }
    edges.par_sort_unstable();
    edges.dedup();
    vertex_count as i64 - edges.len() as i64 + faces
}

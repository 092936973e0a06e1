//! Stage: which cell of a box holds each void (a closed shell in the box whose fluid is outside it).
//!
//! With one outer shell in the box there is nothing to ask. Otherwise a ray goes from inside one of the void's triangles into the fluid, along an
//! axis. Behind its last crossing with the void's own shell it is in the fluid around the void; what it meets next, another shell or the
//! face where it leaves the box, bounds the same cell. Nothing is counted, so nested voids and islands need no order.
//! A ray through an edge or a vertex is replaced by the next one.
//!
//! Cost: a ray per void, in rationals; the tree of the box's triangles is built once per box.

use super::cells::Faces;
use crate::base::{Error, FaceId, Result, TriangleId, UnionFind, VertexId};
use crate::exact::{self, Sign};
use crate::mesh::bvh::build_bvh;
use crate::mesh::projection::turn;
use crate::mesh::ray::{RayStart, Scene};
use rug::Rational;

/// The half-faces of one box, walls first.
pub struct Box<'a> {
    pub faces: &'a Faces<'a>,
    /// Among the touched boxes.
    pub number: usize,
    /// The shell of each half-face.
    pub shell: &'a [u32],
    /// The triangles of the walls, in order.
    pub triangles: &'a [[VertexId; 3]],
    pub walls: &'a [TriangleId],
}

const RAYS: u32 = 64;

/// For each shell the outer shell of its cell.
pub fn hang(scene: &Box, is_void: &[bool]) -> Result<Vec<u32>> {
    let outer: Vec<u32> = (0..is_void.len() as u32).filter(|&s| !is_void[s as usize]).collect();
    let host = match *outer {
        [] => return Err(lost(scene)),
        [one] => return Ok((0..is_void.len() as u32).map(|s| if is_void[s as usize] { one } else { s }).collect()),
        _ => &outer,
    };
    let mesh = scene.faces.mesh;
    let bvh = build_bvh(&mesh.vertices, scene.triangles);
    let rays = Scene { vertices: &mesh.vertices, triangles: scene.triangles, bvh: &bvh };
    let mut same = UnionFind::new(is_void.len());
    for (void, _) in is_void.iter().enumerate().filter(|(_, v)| **v) {
        let beyond = beyond(scene, &rays, void as u32)?;
        same.union(void, beyond as usize);
    }
    let mut of_set = vec![u32::MAX; is_void.len()];
    for &o in host {
        of_set[same.find(o as usize)] = o;
    }
    let hosts: Vec<u32> = (0..is_void.len()).map(|s| of_set[same.find(s)]).collect();
    // Two outer shells never bound one cell, and every void is in some cell.
    if hosts.contains(&u32::MAX) || host.iter().any(|&o| hosts[o as usize] != o) {
        return Err(lost(scene));
    }
    Ok(hosts)
}

fn lost(scene: &Box) -> Error {
    let at = scene.faces.lattice.box_at(scene.faces.touched.boxes[scene.number]);
    Error::inconsistent(format!(
        "no fluid surrounds a closed shell in box ({}, {}, {}) of the block: the surface intersects itself",
        at[0], at[1], at[2]
    ))
}

/// A shell of the cell that holds a void.
fn beyond(scene: &Box, rays: &Scene, void: u32) -> Result<u32> {
    let Some(from) = scene.shell.iter().position(|&s| s == void) else { return Err(lost(scene)) };
    let [a, b, c] = scene.triangles[from].map(|v| &rays.vertices[v.at()]);
    for k in 1..=RAYS {
        for axis in 0..3 {
            let normal = turn(a, b, c, axis);
            if normal == Sign::Zero {
                continue;
            }
            // The fluid is behind the normal.
            let positive = normal == Sign::Negative;
            let start = RayStart { from: TriangleId::of(from), order: [0, 1, 2], k, axis, positive };
            if let Some(shell) = follow(scene, rays, void, &start)? {
                return Ok(shell);
            }
        }
    }
    Err(lost(scene))
}

/// What the ray meets behind its last crossing with the void; `None` if it is degenerate.
fn follow(scene: &Box, rays: &Scene, void: u32, start: &RayStart) -> Result<Option<u32>> {
    let Ok(crossings) = rays.ordered_crossings(start) else { return Ok(None) };
    let lattice = scene.faces.lattice;
    let corners = lattice.corners(scene.faces.touched.boxes[scene.number]);
    let exit = Rational::from_f64(corners[start.positive as usize][start.axis]).unwrap_or_default();
    let in_box = |x: &Rational| if start.positive { *x <= exit } else { *x >= exit };
    let shells: Vec<u32> = crossings.iter().filter(|c| in_box(&c.0)).map(|c| scene.shell[c.1.triangle.at()]).collect();
    let behind = shells.iter().rposition(|&s| s == void).map_or(0, |i| i + 1);
    if let Some(&next) = shells.get(behind) {
        return Ok(Some(next));
    }
    Ok(face_at(scene, start, &rays.start_point(start)))
}

/// The shell of the face through which the ray leaves the box; `None` if it leaves through an edge or a vertex.
fn face_at(scene: &Box, start: &RayStart, x: &[Rational; 3]) -> Option<u32> {
    let faces = scene.faces;
    let half_faces = faces.of_box.row(scene.number);
    for (i, h) in half_faces.iter().enumerate().skip(scene.walls.len()) {
        // A back half-face is on the lower side of its plane: the box's upper side.
        if faces.support(h.face()) == Err(start.axis)
            && h.front() != start.positive
            && holds(faces, h.face(), start.axis, x)?
        {
            return Some(scene.shell[i]);
        }
    }
    None
}

/// Whether a face in a grid plane holds a point, seen along the plane's axis: crossings to one side, counted half-open. `None` on an edge.
fn holds(faces: &Faces, f: FaceId, axis: usize, x: &[Rational; 3]) -> Option<bool> {
    let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
    let point = |v: VertexId| exact::rational(&faces.point(v));
    let mut inside = false;
    let mut on_edge = false;
    faces.each_loop(f, |row| {
        let mut from = point(row[row.len() - 1]);
        for &v in row {
            let to = point(v);
            if (from[w] <= x[w]) != (to[w] <= x[w]) {
                let turn = (to[u].clone() - &from[u]) * (x[w].clone() - &from[w])
                    - (to[w].clone() - &from[w]) * (x[u].clone() - &from[u]);
                on_edge |= turn.is_zero();
                inside ^= turn.is_positive() == (to[w] > from[w]);
            } else if from[w] == x[w] && to[w] == x[w] {
                on_edge |= (from[u] <= x[u]) != (to[u] <= x[u]) || from[u] == x[u] || to[u] == x[u];
            }
            from = to;
        }
    });
    if on_edge { None } else { Some(inside) }
}

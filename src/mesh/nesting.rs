//! Which shell lies in which, whether orientation alternates with depth, and how voids hang in their solids.
//!
//! A shell encloses another when a ray from the other crosses it unevenly: leaving once more than entering, counted over all
//! its triangles on an axis-parallel ray from an interior rational point of one triangle (see [`super::ray`]). The winding
//! of a shell is constant along any other, so one point decides, and no order along the ray is needed. Not from vertices:
//! two shells may share one. The shells around a shell form a chain; the one that lies in all the others is its parent.
//! Outer shells belong into voids or into nothing, voids into outer shells.
//!
//! A void's anchor is a segment through solid to another shell that is closer to the outer shell: anchors form a tree
//! rooted in outer shells. Voids are taken by their lexicographically lowest vertex. From near that vertex, on the lowest
//! edge there, the ray toward −x meets no void of a later turn, so every void finds an anchor; the ranks of attempts below
//! try the cheap rays first, which nearly always do.
//!
//! Degenerate cases: rays that meet edges or vertices are dropped for the next k. On self-intersecting input windings need not
//! be 0 or 1, and rays may never be clean: attempts are limited, and the shell is reported.
//!
//! Cost: one ray per shell, and a few per void; nothing with a single shell.

use super::projection::turn;
use super::ray::{Crossing, RayStart, Scene};
use super::{Anchor, Shell, TriMesh};
use crate::base::{Csr, Culprit, DefectKind, Error, Result, ShellId, TriangleId};
use crate::exact::Sign;

/// Rays from one triangle before the input is called contradictory. Each k fails only if its ray meets an edge or a
/// vertex.
const MAX_K: u32 = 4096;

/// Finds the nesting of `mesh.shells`, whose volume signs are known, and sets the anchors of voids.
/// Returns the shells that contradict their nesting; anchors are made only if there are none.
/// Errors: `Inconsistent` where rays contradict one another, which needs self-intersecting input.
pub fn nest(mesh: &mut TriMesh) -> Result<Vec<Culprit>> {
    if mesh.shells.len() < 2 {
        let wrong = mesh.shells.iter().filter(|s| !s.outer);
        return Ok(wrong.map(|s| Culprit::new(DefectKind::WrongNesting, &[s.triangle.0 as i64])).collect());
    }
    let bvh = super::bvh::build_bvh(&mesh.vertices, &mesh.triangles);
    let scene = Scene { vertices: &mesh.vertices, triangles: &mesh.triangles, bvh: &bvh };
    let around = enclosing(mesh, scene)?;
    let mut wrong = Vec::new();
    for (s, shell) in mesh.shells.iter().enumerate() {
        // The innermost has the most around itself. Equal depths need self-intersecting input; the lowest id decides.
        let parent = around.row(s).iter().copied().max_by_key(|p| (around.row(*p).len(), std::cmp::Reverse(*p)));
        let in_solid = parent.is_some_and(|p| mesh.shells[p.at()].outer);
        if shell.outer == in_solid {
            wrong.push(Culprit::new(DefectKind::WrongNesting, &[shell.triangle.0 as i64]));
        }
    }
    if wrong.is_empty() && mesh.shells.iter().any(|s| !s.outer) {
        let anchors = anchors(mesh, scene)?;
        for (shell, anchor) in mesh.shells.iter_mut().zip(anchors) {
            shell.anchor = anchor;
        }
    }
    Ok(wrong)
}

/// For each shell, the shells around it, rising.
fn enclosing(mesh: &TriMesh, scene: Scene) -> Result<Csr<ShellId>> {
    let mut around = Csr::with_capacity(mesh.shells.len(), mesh.shells.len());
    let mut crossings: Vec<Crossing> = Vec::new();
    let mut counts: Vec<(ShellId, i32)> = Vec::new();
    for (s, shell) in mesh.shells.iter().enumerate() {
        let s = ShellId::of(s);
        let (axis, positive) = shortest_way_out(mesh, shell.triangle);
        let clean = (1..MAX_K).any(|k| {
            let start = RayStart { from: shell.triangle, order: [0, 1, 2], k, axis, positive };
            crossings.clear();
            scene.crossings(&start, |t| mesh.triangle_shell[t.at()] != s, &mut crossings).is_ok()
        });
        if !clean {
            return Err(contradiction(shell));
        }
        counts.clear();
        counts.extend(crossings.iter().map(|c| (mesh.triangle_shell[c.triangle.at()], if c.leaves { 1 } else { -1 })));
        counts.sort_unstable();
        for same in counts.chunk_by(|a, b| a.0 == b.0) {
            if same.iter().map(|c| c.1).sum::<i32>() != 0 {
                around.items.push(same[0].0);
            }
        }
        around.end_row();
    }
    Ok(around)
}

fn contradiction(shell: &Shell) -> Error {
    let t = shell.triangle.0;
    Error::inconsistent(format!(
        "the shell of triangle {t} touches or crosses other triangles: no ray from it is clean (run the self-intersection \
         check)"
    ))
}

/// An axis along which the triangle has area, and the direction in which the bounding box ends soonest: short rays meet
/// few triangles. A matter of cost alone.
fn shortest_way_out(mesh: &TriMesh, t: TriangleId) -> (usize, bool) {
    let corners = mesh.corners(t);
    let mut best = (f64::INFINITY, 0, false);
    let mut found = false;
    for axis in 0..3 {
        if turn(&corners[0], &corners[1], &corners[2], axis) == Sign::Zero {
            continue;
        }
        for positive in [false, true] {
            let x = corners[0][axis];
            let way = if positive { mesh.bbox[1][axis] - x } else { x - mesh.bbox[0][axis] };
            if !found || way < best.0 {
                best = (way, axis, positive);
                found = true;
            }
        }
    }
    (best.1, best.2)
}

/// The anchors of all voids.
fn anchors(mesh: &TriMesh, scene: Scene) -> Result<Vec<Option<Anchor>>> {
    let count = mesh.shells.len();
    let of_voids = mesh.triangle_shell.iter().enumerate().filter(|(_, s)| !mesh.shells[s.at()].outer);
    let members = Csr::from_pairs(count, of_voids.map(|(t, s)| (s.at(), TriangleId::of(t))));
    let mut finder = Finder { mesh, scene, rooted: mesh.shells.iter().map(|s| s.outer).collect(), scratch: Vec::new() };
    let mut anchors: Vec<Option<Anchor>> = vec![None; count];
    let mut waiting: Vec<usize> = (0..count).filter(|&s| !mesh.shells[s].outer).collect();
    let lowest = |s: &usize| {
        let corners = members.row(*s).iter().flat_map(|t| mesh.corners(*t));
        corners.min_by(compare_points).unwrap_or_default()
    };
    waiting.sort_by_cached_key(|s| (PointKey(lowest(s)), *s));
    let mut rank = 0;
    while !waiting.is_empty() {
        if rank == RANKS {
            return Err(contradiction(&mesh.shells[waiting[0]]));
        }
        let before = waiting.len();
        waiting.retain(|&s| {
            anchors[s] = finder.find(rank, members.row(s));
            finder.rooted[s] = anchors[s].is_some();
            anchors[s].is_none()
        });
        // What was found makes room for cheaper attempts at the rest.
        rank = if waiting.len() < before { 0 } else { rank + 1 };
    }
    Ok(anchors)
}

/// The next anchor of a void after one that an engine could not use (its ray is degenerate with respect to something
/// besides the mesh): from the same triangle, further along k. Leads to the same shell or to an outer one, so that
/// chains of voids stay chains. Builds the BVH anew: a rare path.
pub fn next_anchor(mesh: &TriMesh, previous: &Anchor) -> Option<Anchor> {
    let bvh = super::bvh::build_bvh(&mesh.vertices, &mesh.triangles);
    let scene = Scene { vertices: &mesh.vertices, triangles: &mesh.triangles, bvh: &bvh };
    let before = mesh.triangle_shell[previous.hit.at()];
    let rooted = (0..mesh.shells.len()).map(|s| mesh.shells[s].outer || s == before.at()).collect();
    let mut finder = Finder { mesh, scene, rooted, scratch: Vec::new() };
    let Anchor { from, order, axis, positive, .. } = *previous;
    (previous.k + 1..MAX_K).find_map(|k| finder.attempt(RayStart { from, order, k, axis, positive }))
}

fn compare_points(a: &[f64; 3], b: &[f64; 3]) -> std::cmp::Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
}

/// Points in lexicographic order (finite, without −0, so the total order is the numeric one).
#[derive(PartialEq)]
struct PointKey([f64; 3]);

impl Eq for PointKey {}
impl PartialOrd for PointKey {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for PointKey {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        compare_points(&self.0, &other.0)
    }
}

const RANKS: usize = 3;
const DIRECTIONS: [(usize, bool); 6] = [(0, false), (0, true), (1, false), (1, true), (2, false), (2, true)];
const ORDERS: [[u8; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]];

/// Looks for anchors.
struct Finder<'a> {
    mesh: &'a TriMesh,
    scene: Scene<'a>,
    /// Shells whose anchors lead to an outer shell.
    rooted: Vec<bool>,
    scratch: Vec<(f64, TriangleId)>,
}

impl Finder<'_> {
    /// Attempts of a rank, the later the dearer: (0) toward −x from triangles at the lowest vertex; (1) the same in all six
    /// directions; (2) toward −x from ever closer to the lowest vertex along each of its edges, which cannot fail on valid
    /// input unless k runs out of bits.
    fn find(&mut self, rank: usize, members: &[TriangleId]) -> Option<Anchor> {
        let directions = if rank == 1 { &DIRECTIONS[..] } else { &DIRECTIONS[..1] };
        let orders = if rank == 2 { &ORDERS[..] } else { &ORDERS[..1] };
        for &(axis, positive) in directions {
            let extreme = self.extreme(members, axis, positive);
            for &from in members {
                if !self.mesh.corners(from).contains(&extreme) || !self.faces_solid(from, axis, positive) {
                    continue;
                }
                for &order in orders {
                    for step in 0..if rank == 2 { 32 } else { 4 } {
                        let k = if rank == 2 { 1 << step } else { 1 + step };
                        if let Some(anchor) = self.attempt(RayStart { from, order, k, axis, positive }) {
                            return Some(anchor);
                        }
                    }
                }
            }
        }
        None
    }

    fn attempt(&mut self, start: RayStart) -> Option<Anchor> {
        let crossing = self.scene.first_crossing(&start, &mut self.scratch).ok()??;
        // Solid up to there needs a normal along the ray; anything else is a contradiction in the input.
        if !crossing.leaves || !self.rooted[self.mesh.triangle_shell[crossing.triangle.at()].at()] {
            return None;
        }
        let RayStart { from, order, k, axis, positive } = start;
        Some(Anchor { from, order, k, axis, positive, hit: crossing.triangle })
    }

    /// The outermost vertex in a direction, ties by the coordinates that follow.
    fn extreme(&self, members: &[TriangleId], axis: usize, positive: bool) -> [f64; 3] {
        let sign = if positive { -1.0 } else { 1.0 };
        let key = |p: &[f64; 3]| PointKey([p[axis] * sign, p[(axis + 1) % 3], p[(axis + 2) % 3]]);
        let corners = members.iter().flat_map(|t| self.mesh.corners(*t));
        corners.min_by(|a, b| key(a).cmp(&key(b))).unwrap_or_default()
    }

    /// Whether the direction leads from a triangle into the solid behind it.
    fn faces_solid(&self, t: TriangleId, axis: usize, positive: bool) -> bool {
        let [a, b, c] = self.mesh.corners(t);
        let along = turn(&a, &b, &c, axis);
        along == if positive { Sign::Negative } else { Sign::Positive }
    }
}

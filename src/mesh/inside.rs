//! Whether a point is inside a solid, outside, or on its surface, exactly.
//!
//! A ray from the point towards +x counts the triangles that it crosses, each with the sign of its normal's x: the sum is
//! the winding number, 1 inside and 0 outside. Where the ray would meet an edge or a vertex it is moved by (0, ε, ε²), ε
//! infinitely small: of the three turns that say whether a triangle is crossed none is then zero, unless the triangle is seen
//! edge-on, and such a triangle is never crossed. Whether a crossing is ahead needs no ε: a triangle crossed by the moved
//! ray holds the point's projection, so if the point were on its plane it would be on the triangle, and then it is on the
//! surface, which is asked first.
//!
//! Cost: logarithmic in the triangles, plus a few tens of nanoseconds for each whose box the ray meets.

use super::TriMesh;
use super::bvh::Bvh;
use super::projection::{open_axis, seen_along, turn};
use crate::base::TriangleId;
use crate::exact::{Sign, orient3d};

/// Where a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Outside,
    Surface,
    Inside,
}

/// Where a finite point is with respect to the solid that a mesh bounds; `bvh` is that of the mesh's triangles.
pub fn locate(mesh: &TriMesh, bvh: &Bvh, x: &[f64; 3]) -> Place {
    let mut winding = 0;
    let mut on_surface = false;
    bvh.meeting_ray(x, x, 0, true, |t: TriangleId| {
        if on_surface {
            return;
        }
        let q = mesh.corners(t);
        let side = orient3d(&q[0], &q[1], &q[2], x);
        if side == Sign::Zero {
            on_surface = holds(&q, x);
            return;
        }
        // Ahead: behind a triangle whose normal points along the ray, or before one whose normal points against it.
        let turns = crossed(&q, x);
        if turns != Sign::Zero && turns != side {
            winding += i32::from(turns.to_i8());
        }
    });
    match (on_surface, winding > 0) {
        (true, _) => Place::Surface,
        (false, true) => Place::Inside,
        (false, false) => Place::Outside,
    }
}

/// Whether a point of the triangle's plane is on the triangle.
pub fn holds(q: &[[f64; 3]; 3], x: &[f64; 3]) -> bool {
    let (axis, sense) = open_axis(q);
    (0..3).all(|i| {
        let s = turn(&q[i], &q[(i + 1) % 3], x, axis);
        s == Sign::Zero || s == sense
    })
}

/// The sign of the x of the triangle's normal if the line through the moved point along x crosses the triangle, else zero.
fn crossed(q: &[[f64; 3]; 3], x: &[f64; 3]) -> Sign {
    let first = moved_turn(&q[0], &q[1], x);
    if first == Sign::Zero || moved_turn(&q[1], &q[2], x) != first || moved_turn(&q[2], &q[0], x) != first {
        return Sign::Zero;
    }
    first
}

/// The turn a → b → x + (0, ε, ε²) seen along x; zero only if a and b are seen as one point.
#[inline]
fn moved_turn(a: &[f64; 3], b: &[f64; 3], x: &[f64; 3]) -> Sign {
    let (u, v) = seen_along(0);
    let s = turn(a, b, x, 0);
    // (b − a) × (x − a) grows by ε·(a_v − b_v) + ε²·(b_u − a_u).
    let compare = |x: f64, y: f64| if x > y { Sign::Positive } else { Sign::Negative };
    if s != Sign::Zero {
        s
    } else if a[v] != b[v] {
        compare(a[v], b[v])
    } else if a[u] != b[u] {
        compare(b[u], a[u])
    } else {
        Sign::Zero
    }
}

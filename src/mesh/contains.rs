//! Whether a point is inside a closed mesh: crossings of a ray along +x with the surface, counted by parity.
//!
//! The point is taken to be moved by (0, ε, ε²), so that the ray passes beside every edge and vertex: a turn that is zero takes the sign of
//! its derivative. Exact; the point must not be on the surface. Cost: linear in the triangles, most of which their extent rejects.

use super::TriMesh;
use super::projection::turn;
use crate::base::TriangleId;
use crate::exact::{self, Sign};

/// Whether a point that is not on the surface is inside the mesh, voids being outside.
pub fn contains(mesh: &TriMesh, x: &[f64; 3]) -> bool {
    let mut inside = false;
    for t in 0..mesh.triangles.len() {
        inside ^= crosses(&mesh.corners(TriangleId::of(t)), x);
    }
    inside
}

/// Whether the ray from x towards +x, a little off, goes through a triangle.
fn crosses(q: &[[f64; 3]; 3], x: &[f64; 3]) -> bool {
    let beside = |a: usize| q.iter().all(|p| p[a] < x[a]) || q.iter().all(|p| p[a] > x[a]);
    if beside(1) || beside(2) || q.iter().all(|p| p[0] < x[0]) {
        return false;
    }
    let mut common = None;
    for i in 0..3 {
        let (a, b) = (&q[i], &q[(i + 1) % 3]);
        let s = match turn(a, b, x, 0) {
            // (b − a) × (x − a) grows with −(b − a)_z as y does, then with (b − a)_y as z does.
            Sign::Zero if a[2] != b[2] => Sign::of(a[2] - b[2]),
            Sign::Zero => Sign::of(b[1] - a[1]),
            s => s,
        };
        match common {
            None => common = Some(s),
            Some(first) if first != s => return false,
            _ => {}
        }
    }
    match common {
        // Seen along +x the corners run counter-clockwise where the normal points to +x: the ray meets the triangle if x is behind.
        Some(s) if s != Sign::Zero => exact::orient3d(&q[0], &q[1], &q[2], x) == -s,
        _ => false,
    }
}

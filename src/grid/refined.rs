//! Cells that fixed point leaves undecided because of its coordinates: slivers, whose volume is of the size of the uncertainty, and
//! values near a border of the strip around a midpoint. Residuals are known to 2⁻⁹⁰ of the mesh's extent by contract, but the double-doubles that
//! they came from are mostly good to 2⁻¹⁰². So these cells' corners are evaluated once more, now with their own bounds, and the same sums run
//! with the smaller slack. What remains undecided is left to rationals. Cost: some 10 µs per cell.

use super::cell_sums::{BodyValues, CellSums, on_high_side};
use super::data::GridCells;
use super::face_sums::{PlaneArea, plane_face, whole_square};
use super::fixed_point::{Framing, Interval, Spot, power};
use super::moments::{is_square, others};
use super::points::{in_triangle, on_edge};
use crate::base::{CellId, VertexId};
use crate::complex::Origin;

/// Coordinates, what rounding took away from them, and by how much their sum is off at most; `None` if that is not known.
fn position(g: &GridCells, v: VertexId) -> Option<([f64; 3], [f64; 3], f64)> {
    let x = g.coords[v.at()];
    let known = std::array::from_fn(|a| (g.on_planes[v.at()] >> a & 1 != 0).then_some(x[a]));
    let values = match g.origin(v) {
        Origin::Edge(e, p) => on_edge(&g.mesh, e, g.lattice.plane_at(p).0, known, f64::INFINITY)?,
        Origin::Triangle(t, ..) => in_triangle(&g.mesh, t, known, f64::INFINITY)?,
        _ => [None; 3],
    };
    let (mut rest, mut err) = ([0.0; 3], 0.0);
    for a in 0..3 {
        if let Some(value) = &values[a] {
            // The difference of neighbours is exact; the sum is rounded.
            rest[a] = (value.hi - x[a]) + value.lo;
            err = f64::max(err, value.err + rest[a].abs() * power(-50));
        }
    }
    Some((x, rest, err))
}

/// Volume, fraction and centroid of a cell in a box of ordinary intervals.
pub fn body(g: &GridCells, frame: [&Interval; 3], c: CellId) -> Option<BodyValues> {
    let faces = g.cell_faces(c);
    let mut corners = Vec::new();
    let mut err = 0.0;
    for h in faces {
        for &v in g.face_corners(h.face()) {
            let (x, rest, off) = position(g, v)?;
            err = f64::max(err, off);
            corners.push((x, rest));
        }
    }
    // Places are off by roundings of what is below 2⁻⁵³ of the extent, too.
    let frame = frame.map(|x| Interval { slack: (err + g.extent * power(-103)) * x.scale + power(-42), ..*x });
    let [x, y, z] = &frame;
    let framing = Framing::<4>::of(&[x, y, z]);
    let spots: Vec<Spot<4>> =
        corners.iter().map(|([x, y, z], [p, q, r])| framing.spot(&[*x, *y, *z, 0.0], &[*p, *q, *r, 0.0])).collect();
    let walls = g.plane_faces[0];
    let mut sums: Option<CellSums> = None;
    let mut rest = &spots[..];
    // Walls come first in every shell, and the first shell has some if any has.
    for h in faces {
        let f = h.face();
        let (mine, behind) = rest.split_at(g.face_corners(f).len());
        rest = behind;
        let is_wall = f.0 < walls;
        let origin = if is_wall { mine[0].h } else { [0; 4] };
        let sums = sums.get_or_insert_with(|| CellSums::new([x, y, z], origin));
        if is_wall {
            sums.wall::<true>(mine);
            continue;
        }
        let axis = g.face_axis(f);
        let [b, c] = others(axis);
        let area: PlaneArea = if is_square(g, f) {
            whole_square(&frame[b], &frame[c])
        } else {
            let mine: Vec<Spot<2>> = mine.iter().map(|s| Spot { h: [s.h[b], s.h[c]], l: [s.l[b], s.l[c]] }).collect();
            let loops = &g.loop_offsets[g.face_loops[f.at()] as usize..=g.face_loops[f.at() + 1] as usize];
            plane_face::<false>(&mine, loops, [&frame[b], &frame[c]]).0
        };
        sums.plane::<true>(&area, axis, on_high_side(*h));
    }
    sums?.values::<true, false>()
}

//! Half-spaces within their box: which parts of sheets and of the box's sides belong to which half-space.
//!
//! A part of a side of the box is on one side of every plane (planes have cut it), so a corner off the plane tells whether it is in the half-space; a part
//! that lies in the plane is in it if the plane's normal points out of the box there. So each gets the half-spaces that hold it as births, and a
//! part in none is gone. Sheets have been cut down to the box; a part of a sheet in a side of the box is gone, too: what of the box lies there, is in the half-space or not.
//! After this the births of a half-space are the boundary of what it has in common with the box: it balances at every edge.
//!
//! Cost: for each part of the box's sides and each plane a sign in doubles, rarely exact.

use super::Resolved;
use super::data::Birth;
use super::supports::{BOX, BOX_TRIANGLES};
use crate::base::{FaceId, PlaneId, Result, Run};
use crate::exact::{Sign, Support};

/// Faces and planes between two looks at whether the caller wants to stop, about.
const LOOKS: usize = 1 << 18;

/// Deals out the births of half-spaces. Errors: `Cancelled`.
pub fn clip(r: &mut Resolved, run: &mut Run) -> Result<()> {
    if r.soup.planes().is_empty() {
        return Ok(());
    }
    let often = LOOKS / r.soup.planes().len() + 1;
    let mut kept = Resolved { pair_count: r.pair_count, ..Resolved::default() };
    let (mut births, mut shared) = (Vec::new(), 0);
    for f in (0..r.faces.len()).map(FaceId::of) {
        if f.at() % often == 0 {
            run.tick("resolve", 0.65)?;
        }
        while r.shared.get(shared).is_some_and(|s| *s < f) {
            shared += 1;
        }
        let single = [Birth { triangle: r.support[f.at()], same: true }];
        let given = if r.shared.get(shared) == Some(&f) { r.births.row(shared) } else { &single };
        births.clear();
        let side = given.iter().find_map(|b| r.soup.box_side(b.triangle).map(|side| (side, b.same)));
        births.extend(given.iter().filter(|b| {
            let of_half_space = r.soup.sheet(b.triangle).is_some() && side.is_some();
            !of_half_space && r.soup.box_side(b.triangle).is_none()
        }));
        if let Some((side, same)) = side {
            let within = (0..r.soup.planes().len()).filter(|&i| holds(r, f, side, PlaneId::of(i)));
            births.extend(within.map(|i| Birth { triangle: r.soup.box_triangle(i, side), same }));
            births.sort_unstable();
        }
        let Some(&Birth { triangle, same }) = births.first() else { continue };
        let [a, b, c] = r.faces[f.at()];
        if births.len() > 1 {
            kept.shared.push(FaceId::of(kept.faces.len()));
            kept.births.items.extend(births.iter().map(|b| Birth { same: b.same == same, ..*b }));
            kept.births.end_row();
        }
        kept.faces.push(if same { [a, b, c] } else { [a, c, b] });
        kept.support.push(triangle);
        kept.whole += (f.at() < r.whole) as usize;
    }
    kept.soup = std::mem::take(&mut r.soup);
    kept.points = std::mem::take(&mut r.points);
    *r = kept;
    Ok(())
}

/// Whether a part of a side of the box is in a half-space.
fn holds(r: &Resolved, f: FaceId, side: usize, p: PlaneId) -> bool {
    let plane = r.soup.planes()[p.at()];
    let support = Support::Plane(plane);
    for v in r.faces[f.at()] {
        let quick = super::planar::quick_side(&plane, &r.coords(v));
        let sign = quick.unwrap_or_else(|| crate::exact::support_side(&support, &r.point(v)));
        if sign != Sign::Zero {
            return sign == Sign::Negative;
        }
    }
    // In the plane: sides 4 k to 4 k + 3 are across axis k, two at its lower end first.
    debug_assert_eq!(BOX_TRIANGLES.len(), BOX);
    (plane.n[side / 4] > 0.0) == (side % 4 >= 2)
}

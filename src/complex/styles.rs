//! The three ways in which a host may want its faces (DESIGN §7): with holes, bridged, triangulated. No style adds a
//! vertex.

use super::bridge::bridged;
use super::data::Complex;
use super::triangulate::triangulated;
use crate::base::{FaceId, VertexId};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceStyle {
    /// One row per loop: the outer loop of each face, then its holes (clockwise; an isolated vertex is a row of one).
    Holes,
    /// One row per face: holes joined to the outer loop by bridges, each walked twice.
    Bridged,
    /// One row per triangle.
    Triangulated,
}

/// Rows of vertices: row `i` is `vertices[offsets[i]..offsets[i + 1]]` and belongs to face `source_face[i]`; rows are in
/// order of faces and turn counter-clockwise about the face's normal (holes clockwise).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaceArrays {
    pub offsets: Vec<u32>,
    pub vertices: Vec<VertexId>,
    pub source_face: Vec<FaceId>,
}

/// All faces of a complex in a style. The result depends on the complex alone. An error only where a face contradicts
/// itself (input that intersects itself, with the exact check off). Cost: linear for convex faces.
pub fn faces_as(c: &Complex, style: FaceStyle) -> Result<FaceArrays, String> {
    let faces = (0..c.face_count()).map(FaceId::of);
    Ok(match style {
        FaceStyle::Holes => FaceArrays {
            offsets: c.loop_offsets.clone(),
            vertices: c.corner_vertices.clone(),
            source_face: faces.flat_map(|f| c.loops_of(f).map(move |_| f)).collect(),
        },
        FaceStyle::Bridged => {
            let rows = bridged(c)?;
            FaceArrays { offsets: rows.offsets, vertices: rows.items, source_face: faces.collect() }
        }
        FaceStyle::Triangulated => {
            let rows = triangulated(c)?;
            let count = rows.items.len() as u32;
            FaceArrays {
                offsets: (0..=count).map(|i| 3 * i).collect(),
                vertices: rows.items.into_iter().flatten().collect(),
                source_face: faces
                    .flat_map(|f| {
                        rows.offsets[f.at()..=f.at() + 1]
                            .windows(2)
                            .flat_map(move |w| (w[0]..w[1]).map(move |_| f))
                            .collect::<Vec<_>>()
                    })
                    .collect(),
            }
        }
    })
}

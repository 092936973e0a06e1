//! The noun `lap_surface`: the boundary of a solid that is a union of a network's regions or of an arrangement's cells.

use super::complex::lap_complex;
use super::context::{lap_context, with_context};
use super::derived::{keep, lend_complex, on_demand, once, too_many_elements};
use super::guard::guard;
use super::view::{address, handle, put};
use crate::arrangement::certify::CertifyReport;
use crate::arrangement::solids::{joined_cells, solids};
use crate::arrangement::{Arrangement, Extraction, extract, volumes};
use crate::base::{Error, FaceId, OperandId, Status, VertexId};
use crate::complex::exact_values::volume_of_triangles;
use crate::complex::surface_euler;
use crate::exact::round_rational;
use crate::network::Network;
use crate::network::csg::Boundary;
use rug::Rational;
use std::ffi::c_char;
use std::sync::{Arc, OnceLock};

/// The boundary of a union of regions of a network, or of cells of an arrangement: an oriented mesh. What is between two that were
/// both chosen is gone. It is closed, except where a solid of regions reaches the boundary of the network's domain. It needs neither the network
/// nor the arrangement to stay alive (and keeps what it needs of the latter).
///
/// Immutable: a const handle may be used from many threads at once; what is computed on demand is computed once.
pub struct lap_surface {
    made: Made,
    threads: usize,
    /// Of triangles, which the engine keeps without.
    offsets: OnceLock<Vec<u32>>,
    volume: OnceLock<Rational>,
    euler: OnceLock<i64>,
}

enum Made {
    Regions { boundary: Boundary, xyz: Vec<[f64; 3]> },
    Cells(Box<Solid>),
    Certified(Box<Certified>),
}

/// Doubles as they are, with where they come from: an arrangement's vertices and faces, and the operands' triangles.
pub(super) struct Certified {
    pub xyz: Vec<[f64; 3]>,
    pub corners: Vec<[u32; 3]>,
    /// `NONE` for a vertex at another place than any that the arrangement's surface has.
    pub vertices: Vec<VertexId>,
    pub faces: Vec<FaceId>,
    /// Against the faces of the arrangement.
    pub turned: Vec<bool>,
    pub operands: Vec<OperandId>,
    pub triangles: Vec<u32>,
    pub flipped: Vec<bool>,
    pub report: CertifyReport,
}

/// What a surface of triangles has of each, whichever it is.
pub(super) struct Births<'a> {
    pub faces: &'a [FaceId],
    pub turned: &'a [bool],
    pub operands: &'a [OperandId],
    pub triangles: &'a [u32],
    pub flipped: &'a [bool],
}

/// What an arrangement gives.
struct Solid {
    arrangement: Arc<Arrangement>,
    extraction: Extraction,
    operands: Vec<OperandId>,
    triangles: Vec<u32>,
    /// Against the faces of the arrangement.
    turned: Vec<bool>,
    /// The cells that are in it.
    inside: Vec<bool>,
    complex: OnceLock<lap_complex>,
}

const _: () = {
    const fn shared_between_threads<T: Send + Sync>() {}
    shared_between_threads::<lap_surface>();
};

impl lap_surface {
    pub fn of_regions(network: &Network, boundary: Boundary, threads: usize) -> Result<Self, Error> {
        // Triangles may be more than polygons.
        counted(boundary.polygons.items.len())?;
        let xyz = boundary.vertices.iter().map(|v| network.vertices[v.at()]).collect();
        Ok(Self::new(Made::Regions { boundary, xyz }, threads))
    }

    pub fn of_cells(arrangement: &Arc<Arrangement>, inside: &[bool], threads: usize) -> Result<Self, Error> {
        let mut extraction = extract(arrangement, inside)?;
        counted(3 * extraction.triangles.len())?;
        let (operands, triangles) = std::mem::take(&mut extraction.births).into_iter().unzip();
        let faces = &arrangement.resolved.faces;
        // A triangle that runs against its face begins at the same corner.
        let turned = |(t, f): (&[u32; 3], &crate::base::FaceId)| extraction.vertices[t[1] as usize] != faces[f.at()][1];
        let turned = extraction.triangles.iter().zip(&extraction.faces).map(turned).collect();
        let (arrangement, inside) = (arrangement.clone(), inside.to_vec());
        let solid = Solid { arrangement, extraction, operands, triangles, turned, inside, complex: OnceLock::new() };
        Ok(Self::new(Made::Cells(Box::new(solid)), threads))
    }

    pub(super) fn of_certified(certified: Certified, threads: usize) -> Result<Self, Error> {
        counted(3 * certified.corners.len())?;
        Ok(Self::new(Made::Certified(Box::new(certified)), threads))
    }

    fn new(made: Made, threads: usize) -> Self {
        Self { made, threads, offsets: OnceLock::new(), volume: OnceLock::new(), euler: OnceLock::new() }
    }

    /// Corners of all polygons, or of triangles, as places in the vertices.
    fn corners(&self) -> &[u32] {
        match &self.made {
            Made::Regions { boundary, .. } => &boundary.polygons.items,
            Made::Cells(solid) => solid.extraction.triangles.as_flattened(),
            Made::Certified(certified) => certified.corners.as_flattened(),
        }
    }

    fn count(&self) -> usize {
        match &self.made {
            Made::Regions { boundary, .. } => boundary.polygons.len(),
            Made::Cells(solid) => solid.extraction.triangles.len(),
            Made::Certified(certified) => certified.corners.len(),
        }
    }

    fn offsets(&self) -> &[u32] {
        match &self.made {
            Made::Regions { boundary, .. } => &boundary.polygons.offsets,
            Made::Cells(_) | Made::Certified(_) => {
                self.offsets.get_or_init(|| (0..=self.count() as u32).map(|i| 3 * i).collect())
            }
        }
    }

    /// Coordinates, and the vertex of the network or the arrangement that each is.
    pub(super) fn vertices(&self) -> (&[[f64; 3]], &[VertexId]) {
        match &self.made {
            Made::Regions { boundary, xyz } => (xyz, &boundary.vertices),
            Made::Cells(solid) => (&solid.extraction.coords, &solid.extraction.vertices),
            Made::Certified(certified) => (&certified.xyz, &certified.vertices),
        }
    }

    /// An error for the surface of a network.
    pub(super) fn births(&self) -> Result<Births<'_>, Status> {
        match &self.made {
            Made::Regions { .. } => Err(Status::BadArgument),
            Made::Cells(s) => Ok(Births {
                faces: &s.extraction.faces,
                turned: &s.turned,
                operands: &s.operands,
                triangles: &s.triangles,
                flipped: &s.extraction.flipped,
            }),
            Made::Certified(c) => Ok(Births {
                faces: &c.faces,
                turned: &c.turned,
                operands: &c.operands,
                triangles: &c.triangles,
                flipped: &c.flipped,
            }),
        }
    }

    /// An error for any other surface.
    pub(super) fn certified(&self) -> Result<&Certified, Status> {
        match &self.made {
            Made::Certified(certified) => Ok(certified),
            _ => Err(Status::BadArgument),
        }
    }

    /// Triangles as places in the vertices.
    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        match &self.made {
            Made::Regions { .. } => &[],
            Made::Cells(solid) => &solid.extraction.triangles,
            Made::Certified(certified) => &certified.corners,
        }
    }

    fn volume(&self) -> Result<&Rational, Status> {
        let compute = || match &self.made {
            Made::Regions { .. } => Rational::new(),
            Made::Cells(solid) => volumes::volume(&solid.arrangement, &solid.extraction),
            Made::Certified(c) => volume_of_triangles(&c.xyz, &c.corners),
        };
        match &self.made {
            Made::Regions { .. } => Err(Status::BadArgument),
            _ => on_demand(self.threads, &self.volume, compute),
        }
    }
}

fn counted(corners: usize) -> Result<(), Error> {
    match corners > i32::MAX as usize {
        true => Err(Error::new(Status::TooLarge, "the result has more elements than 32-bit indices can number")),
        false => Ok(()),
    }
}

/// Frees a surface and all that was borrowed from it. NULL is allowed and does nothing.
///
/// Errors: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_free(surface: *mut lap_surface) -> i32 {
    guard(|_| {
        if !surface.is_null() {
            drop(unsafe { Box::from_raw(surface) });
        }
        Ok(())
    })
}

/// The vertices of a surface.
///
/// Outputs (each may be NULL; borrowed until the surface is freed): count; xyz: 3 × count coordinates, each the double nearest to the
/// exact one (unless certified, see lap_surface_certify); sources: the vertex of the network or of the arrangement that each is, rising.
///
/// Errors: LAP_ERR_NULL_POINTER if surface is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_vertices(
    surface: *const lap_surface,
    count: *mut i64,
    xyz: *mut *const f64,
    sources: *mut *const i32,
) -> i32 {
    guard(|_| {
        let surface = unsafe { handle(surface) }?;
        let (coords, vertices) = surface.vertices();
        unsafe {
            put(count, coords.len() as i64);
            put(xyz, address(coords));
            put(sources, address(vertices));
        }
        Ok(())
    })
}

/// The polygons of a surface, convex; of an arrangement, or if a network's was made so, triangles.
///
/// Outputs (each may be NULL; borrowed until the surface is freed): count; offsets: count + 1; vertices: those of polygon p are vertices[offsets[p]]
/// up to, not including, vertices[offsets[p + 1]], anticlockwise seen from outside the solid (in two dimensions: the solid is on
/// the right of the way from the first to the second), as places in lap_surface_vertices; births: the polygon of the network, or the face of the
/// arrangement, that each comes from, rising (unless certified); flipped: a byte for each, 1 where it runs against that one.
///
/// Errors: LAP_ERR_NULL_POINTER if surface is NULL. Threads: any. Cost: none; the offsets of triangles are filled at the first call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_polygons(
    surface: *const lap_surface,
    count: *mut i64,
    offsets: *mut *const i32,
    vertices: *mut *const i32,
    births: *mut *const i32,
    flipped: *mut *const u8,
) -> i32 {
    guard(|_| {
        let surface = unsafe { handle(surface) }?;
        let (of_birth, of_flip) = match (&surface.made, surface.births()) {
            (Made::Regions { boundary, .. }, _) => (address(&boundary.births), address(&boundary.flipped)),
            (_, births) => births.map(|b| (address(b.faces), address(b.turned)))?,
        };
        unsafe {
            put(count, surface.count() as i64);
            if !offsets.is_null() {
                put(offsets, address(surface.offsets()));
            }
            put(vertices, address(surface.corners()));
            put(births, of_birth);
            put(flipped, of_flip);
        }
        Ok(())
    })
}

/// The triangles of an arrangement's surface, and the input triangles that they are parts of.
///
/// Outputs (each may be NULL; borrowed until the surface is freed): count; vertices: 3 × count places in lap_surface_vertices, anticlockwise
/// seen from outside the solid; operands, triangles: of each the operand, and the triangle by its place in that operand's list, of several that
/// lie there the first whose operand's winding number changes; flipped: a byte for each, 1 where it runs against that triangle.
///
/// Errors: LAP_ERR_NULL_POINTER if surface is NULL; LAP_ERR_BAD_ARGUMENT for the surface of a network. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_triangles(
    surface: *const lap_surface,
    count: *mut i64,
    vertices: *mut *const i32,
    operands: *mut *const i32,
    triangles: *mut *const i32,
    flipped: *mut *const u8,
) -> i32 {
    guard(|_| {
        let surface = unsafe { handle(surface) }?;
        let of = surface.births()?;
        unsafe {
            put(count, surface.count() as i64);
            put(vertices, address(surface.corners()));
            put(operands, address(of.operands));
            put(triangles, address(of.triangles));
            put(flipped, address(of.flipped));
        }
        Ok(())
    })
}

/// The Euler characteristic of a surface: vertices - edges + polygons (in two dimensions: vertices - segments). Of a sphere 2, of a torus 0;
/// where parts touch in a vertex or an edge, that counts once.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: a sort of all edges at the first call, then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_euler(surface: *const lap_surface, euler: *mut i64) -> i32 {
    guard(|_| {
        let surface = unsafe { handle(surface) }?;
        if euler.is_null() {
            return Err(Status::NullPointer);
        }
        let vertices = surface.vertices().0.len();
        let (offsets, corners) = (surface.offsets(), surface.corners());
        let count = || {
            let polygon = |w: &[u32]| &corners[w[0] as usize..w[1] as usize];
            surface_euler(vertices, offsets.windows(2).map(polygon))
        };
        unsafe { put(euler, *on_demand(surface.threads, &surface.euler, count)?) };
        Ok(())
    })
}

/// The volume of the solid that an arrangement's surface bounds, in cubed units of the input: the double nearest to the exact volume (of
/// the exact vertices, not of the rounded ones; of a certified surface, of its own).
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for the surface of a network; LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: an exact sum
/// over the triangles at the first call, some microseconds for each that a cut input triangle was divided into; then none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_volume(surface: *const lap_surface, volume: *mut f64) -> i32 {
    guard(|_| {
        let surface = unsafe { handle(surface) }?;
        if volume.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(volume, round_rational(surface.volume()?)) };
        Ok(())
    })
}

/// The exact volume of the solid that an arrangement's surface bounds as a canonical string, "num/den" or "num" for an integer, in decimal.
///
/// volume: valid until the next call with this context. A GMP or CGAL rational reads it.
///
/// Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for the surface of a network; LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: as for
/// lap_surface_volume; the string grows with the number of constructed vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_volume_exact(
    context: *mut lap_context,
    surface: *const lap_surface,
    volume: *mut *const c_char,
) -> i32 {
    with_context(context, |state, _| {
        let surface = unsafe { handle(surface) }.map_err(|s| Error::new(s, "surface is NULL"))?;
        if volume.is_null() {
            return Err(Error::new(Status::NullPointer, "volume is NULL"));
        }
        let exact = surface.volume().map_err(|s| match s {
            Status::BadArgument => Error::new(s, "the surface is that of a network, which does not tell exact volumes"),
            other => Error::new(other, "no threads to be had"),
        })?;
        unsafe { put(volume, keep(state, &exact.to_string())) };
        Ok(())
    })
}

/// The solid that an arrangement's surface bounds as a complex, as lap_arrangement_complex: a cell for each part that is connected across faces, of
/// which the cells of the arrangement that were chosen are joined.
///
/// complex: borrowed until the surface is freed; do not free it.
///
/// Errors: LAP_ERR_BAD_ARGUMENT for the surface of a network and for a certified one (as an operand it makes an arrangement that has its cells);
/// LAP_ERR_TOO_LARGE, LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: as there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_surface_complex(
    context: *mut lap_context,
    surface: *const lap_surface,
    complex: *mut *const lap_complex,
) -> i32 {
    with_context(context, |state, host| {
        let find = || {
            let surface = unsafe { handle(surface) }.map_err(|s| Error::new(s, "surface is NULL"))?;
            let made = match &surface.made {
                Made::Cells(solid) => Ok(solid),
                Made::Regions { .. } => Err("the surface is that of a network: lap_network_complex has its regions"),
                Made::Certified(_) => {
                    Err("the surface is certified: its cells are those of the arrangement that it makes as an operand")
                }
            };
            let solid = made.map_err(|message| Error::new(Status::BadArgument, message))?;
            once(&solid.complex, || {
                let a = &solid.arrangement;
                let made = state.run(host, |run| solids(a, &joined_cells(a, &solid.inside), run))?;
                lap_complex::of_arrangement(made, a, surface.threads).map_err(too_many_elements)
            })
        };
        unsafe { lend_complex(complex, find) }
    })
}

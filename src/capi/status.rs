//! Numbers that are pinned for ever: status codes, defect kinds, and the version.
//!
//! They repeat `base::error` as plain `i32` constants, because C has to see `#define`s and Fortran has to copy
//! them. The assertions below keep the two in step at compile time.

use super::guard::guard;
use super::view::put;
use crate::base::{DefectKind, Status};
use std::ffi::{CStr, c_char};

/// Success.
pub const LAP_OK: i32 = 0;
/// A pointer that must not be NULL is NULL.
pub const LAP_ERR_NULL_POINTER: i32 = 1;
/// A count, an index, an option or a constant is out of its range.
pub const LAP_ERR_BAD_ARGUMENT: i32 = 2;
/// A count exceeds the 32-bit index type.
pub const LAP_ERR_TOO_LARGE: i32 = 3;
/// The input mesh has defects; lap_context_last_defects lists them.
pub const LAP_ERR_BAD_MESH: i32 = 4;
/// A plane is not finite or has a zero normal; lap_context_last_defects lists them.
pub const LAP_ERR_BAD_PLANE: i32 = 5;
/// The progress callback asked to stop. Nothing is left behind.
pub const LAP_ERR_CANCELLED: i32 = 6;
/// Memory or a thread could not be had.
pub const LAP_ERR_OUT_OF_MEMORY: i32 = 7;
/// The geometry contradicts itself: the input intersects itself and was not checked for it.
pub const LAP_ERR_INCONSISTENT: i32 = 8;
/// A fault of the library. The process and all handles stay usable.
pub const LAP_ERR_INTERNAL: i32 = 9;
/// The context is in use: by another thread, or by the very call whose callback makes this one.
pub const LAP_ERR_BUSY: i32 = 10;

/// A coordinate is NaN or infinite. ids: vertex
pub const LAP_DEFECT_NON_FINITE_COORDINATE: i32 = 1;
/// A vertex index is negative or too large. ids: triangle, corner (0, 1, 2), the index as given
pub const LAP_DEFECT_INDEX_OUT_OF_RANGE: i32 = 2;
/// The corners of a triangle lie on a line, exactly. ids: triangle
pub const LAP_DEFECT_DEGENERATE_TRIANGLE: i32 = 3;
/// The triangles at an edge do not balance in number. ids: vertex, vertex, one triangle there
pub const LAP_DEFECT_OPEN_EDGE: i32 = 4;
/// The triangles at an edge balance in number, not in orientation. ids: vertex, vertex, one triangle there
pub const LAP_DEFECT_INCONSISTENT_ORIENTATION: i32 = 5;
/// Two vertices have equal coordinates. ids: lower vertex, higher vertex
pub const LAP_DEFECT_DUPLICATE_VERTEX: i32 = 6;
/// Signed volume does not alternate with nesting depth. ids: a triangle of the shell
pub const LAP_DEFECT_WRONG_NESTING: i32 = 7;
/// A shell without volume. ids: a triangle of the shell
pub const LAP_DEFECT_ZERO_VOLUME: i32 = 8;
/// Two triangles meet outside what they share by index. ids: triangle, triangle
pub const LAP_DEFECT_SELF_INTERSECTION: i32 = 9;
/// There are no triangles. ids: none
pub const LAP_DEFECT_EMPTY: i32 = 10;
/// A coefficient of a plane is NaN or infinite. ids: plane
pub const LAP_DEFECT_NON_FINITE_PLANE: i32 = 11;
/// The normal of a plane is zero. ids: plane
pub const LAP_DEFECT_ZERO_NORMAL: i32 = 12;
/// The corners of a tetrahedron lie in a plane, or those of a triangle of the plane on a line, exactly (equal corners included). ids: simplex
pub const LAP_DEFECT_DEGENERATE_SIMPLEX: i32 = 13;
/// Two simplices lie on the same side of a face that they share, or more than two share it. ids: lower simplex, higher simplex
pub const LAP_DEFECT_OVERLAPPING_SIMPLICES: i32 = 14;
/// The triangles of an operand do not balance at an edge, as point sets. ids: operand, and those of its vertices that the edge joins (-1: the edge
/// ends between vertices, where triangles cut one another)
pub const LAP_DEFECT_UNBALANCED_EDGE: i32 = 15;

const _: () = {
    assert!(LAP_OK == Status::Ok as i32);
    assert!(LAP_ERR_NULL_POINTER == Status::NullPointer as i32);
    assert!(LAP_ERR_BAD_ARGUMENT == Status::BadArgument as i32);
    assert!(LAP_ERR_TOO_LARGE == Status::TooLarge as i32);
    assert!(LAP_ERR_BAD_MESH == Status::BadMesh as i32);
    assert!(LAP_ERR_BAD_PLANE == Status::BadPlane as i32);
    assert!(LAP_ERR_CANCELLED == Status::Cancelled as i32);
    assert!(LAP_ERR_OUT_OF_MEMORY == Status::OutOfMemory as i32);
    assert!(LAP_ERR_INCONSISTENT == Status::Inconsistent as i32);
    assert!(LAP_ERR_INTERNAL == Status::Internal as i32);
    assert!(LAP_ERR_BUSY == Status::Busy as i32);
    assert!(LAP_DEFECT_NON_FINITE_COORDINATE == DefectKind::NonFiniteCoordinate as i32);
    assert!(LAP_DEFECT_INDEX_OUT_OF_RANGE == DefectKind::IndexOutOfRange as i32);
    assert!(LAP_DEFECT_DEGENERATE_TRIANGLE == DefectKind::DegenerateTriangle as i32);
    assert!(LAP_DEFECT_OPEN_EDGE == DefectKind::OpenEdge as i32);
    assert!(LAP_DEFECT_INCONSISTENT_ORIENTATION == DefectKind::InconsistentOrientation as i32);
    assert!(LAP_DEFECT_DUPLICATE_VERTEX == DefectKind::DuplicateVertex as i32);
    assert!(LAP_DEFECT_WRONG_NESTING == DefectKind::WrongNesting as i32);
    assert!(LAP_DEFECT_ZERO_VOLUME == DefectKind::ZeroVolume as i32);
    assert!(LAP_DEFECT_SELF_INTERSECTION == DefectKind::SelfIntersection as i32);
    assert!(LAP_DEFECT_EMPTY == DefectKind::Empty as i32);
    assert!(LAP_DEFECT_NON_FINITE_PLANE == DefectKind::NonFinitePlane as i32);
    assert!(LAP_DEFECT_ZERO_NORMAL == DefectKind::ZeroNormal as i32);
    assert!(LAP_DEFECT_DEGENERATE_SIMPLEX == DefectKind::DegenerateSimplex as i32);
    assert!(LAP_DEFECT_OVERLAPPING_SIMPLICES == DefectKind::OverlappingSimplices as i32);
    assert!(LAP_DEFECT_UNBALANCED_EDGE == DefectKind::UnbalancedEdge as i32);
};

/// The version of the library that is running.
///
/// Outputs (each may be NULL): the three numbers, and "major.minor.patch" as a string that lives as long as the
/// process. Versions with equal major number are compatible (with major number 0: with equal minor number).
///
/// Errors: none. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_version(
    major: *mut i32,
    minor: *mut i32,
    patch: *mut i32,
    text: *mut *const c_char,
) -> i32 {
    const TEXT: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(text) => text,
        Err(_) => panic!("a version has no NUL inside"),
    };
    guard(|_| {
        unsafe {
            put(major, number(env!("CARGO_PKG_VERSION_MAJOR")));
            put(minor, number(env!("CARGO_PKG_VERSION_MINOR")));
            put(patch, number(env!("CARGO_PKG_VERSION_PATCH")));
            put(text, TEXT.as_ptr());
        }
        Ok(())
    })
}

const fn number(digits: &str) -> i32 {
    let (bytes, mut value, mut i) = (digits.as_bytes(), 0, 0);
    while i < bytes.len() {
        value = value * 10 + (bytes[i] - b'0') as i32;
        i += 1;
    }
    value
}

/// The name of a status code, for example "LAP_ERR_BAD_MESH"; "LAP_ERR_?" for a number that is no status code.
///
/// name: the string lives as long as the process.
///
/// Errors: LAP_ERR_NULL_POINTER if name is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_status_name(status: i32, name: *mut *const c_char) -> i32 {
    guard(|_| {
        if name.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(name, status_name(status).as_ptr()) };
        Ok(())
    })
}

/// The name of a defect kind, for example "LAP_DEFECT_OPEN_EDGE"; "LAP_DEFECT_?" for a number that is none.
///
/// name: the string lives as long as the process.
///
/// Errors: LAP_ERR_NULL_POINTER if name is NULL. Threads: any. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_defect_name(kind: i32, name: *mut *const c_char) -> i32 {
    guard(|_| {
        if name.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(name, defect_name(kind).as_ptr()) };
        Ok(())
    })
}

fn status_name(status: i32) -> &'static CStr {
    match status {
        LAP_OK => c"LAP_OK",
        LAP_ERR_NULL_POINTER => c"LAP_ERR_NULL_POINTER",
        LAP_ERR_BAD_ARGUMENT => c"LAP_ERR_BAD_ARGUMENT",
        LAP_ERR_TOO_LARGE => c"LAP_ERR_TOO_LARGE",
        LAP_ERR_BAD_MESH => c"LAP_ERR_BAD_MESH",
        LAP_ERR_BAD_PLANE => c"LAP_ERR_BAD_PLANE",
        LAP_ERR_CANCELLED => c"LAP_ERR_CANCELLED",
        LAP_ERR_OUT_OF_MEMORY => c"LAP_ERR_OUT_OF_MEMORY",
        LAP_ERR_INCONSISTENT => c"LAP_ERR_INCONSISTENT",
        LAP_ERR_INTERNAL => c"LAP_ERR_INTERNAL",
        LAP_ERR_BUSY => c"LAP_ERR_BUSY",
        _ => c"LAP_ERR_?",
    }
}

fn defect_name(kind: i32) -> &'static CStr {
    match kind {
        LAP_DEFECT_NON_FINITE_COORDINATE => c"LAP_DEFECT_NON_FINITE_COORDINATE",
        LAP_DEFECT_INDEX_OUT_OF_RANGE => c"LAP_DEFECT_INDEX_OUT_OF_RANGE",
        LAP_DEFECT_DEGENERATE_TRIANGLE => c"LAP_DEFECT_DEGENERATE_TRIANGLE",
        LAP_DEFECT_OPEN_EDGE => c"LAP_DEFECT_OPEN_EDGE",
        LAP_DEFECT_INCONSISTENT_ORIENTATION => c"LAP_DEFECT_INCONSISTENT_ORIENTATION",
        LAP_DEFECT_DUPLICATE_VERTEX => c"LAP_DEFECT_DUPLICATE_VERTEX",
        LAP_DEFECT_WRONG_NESTING => c"LAP_DEFECT_WRONG_NESTING",
        LAP_DEFECT_ZERO_VOLUME => c"LAP_DEFECT_ZERO_VOLUME",
        LAP_DEFECT_SELF_INTERSECTION => c"LAP_DEFECT_SELF_INTERSECTION",
        LAP_DEFECT_EMPTY => c"LAP_DEFECT_EMPTY",
        LAP_DEFECT_NON_FINITE_PLANE => c"LAP_DEFECT_NON_FINITE_PLANE",
        LAP_DEFECT_ZERO_NORMAL => c"LAP_DEFECT_ZERO_NORMAL",
        LAP_DEFECT_DEGENERATE_SIMPLEX => c"LAP_DEFECT_DEGENERATE_SIMPLEX",
        LAP_DEFECT_OVERLAPPING_SIMPLICES => c"LAP_DEFECT_OVERLAPPING_SIMPLICES",
        LAP_DEFECT_UNBALANCED_EDGE => c"LAP_DEFECT_UNBALANCED_EDGE",
        _ => c"LAP_DEFECT_?",
    }
}

//! Errors that name the element. A `Status` is the number that crosses the C boundary; an `Error` carries the
//! message and every culprit found.

/// Status codes, pinned: a number once given is never given another meaning (`lapidary.h` repeats them).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    Ok = 0,
    /// A pointer that must not be null is null.
    NullPointer = 1,
    /// A count, option or enum value out of its range.
    BadArgument = 2,
    /// A count beyond the 32-bit index type.
    TooLarge = 3,
    /// The input mesh has defects; they are listed.
    BadMesh = 4,
    /// A plane is not finite or has a zero normal.
    BadPlane = 5,
    /// The progress callback asked to stop.
    Cancelled = 6,
    /// Memory could not be had.
    OutOfMemory = 7,
    /// The geometry contradicts itself: the input intersects itself (with the exact check off).
    Inconsistent = 8,
    /// A fault of the library (a caught panic).
    Internal = 9,
    /// The context is in use, by another thread or by the call whose callback asks.
    Busy = 10,
}

/// What is wrong with an element of the input mesh. Numbers are pinned, as for [`Status`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum DefectKind {
    /// ids: vertex
    NonFiniteCoordinate = 1,
    /// ids: triangle, corner (0..3), and the index as given
    IndexOutOfRange = 2,
    /// The corners lie on a line, exactly (two equal corners included). ids: triangle
    DegenerateTriangle = 3,
    /// The triangles at an edge do not balance in number. ids: vertex, vertex, one triangle there
    OpenEdge = 4,
    /// The triangles at an edge balance in number, not in orientation. ids: vertex, vertex, one triangle there
    InconsistentOrientation = 5,
    /// Two vertices have equal coordinates. ids: lower vertex, higher vertex
    DuplicateVertex = 6,
    /// Signed volume does not alternate with nesting depth. ids: a triangle of the shell
    WrongNesting = 7,
    /// A shell without volume. ids: a triangle of the shell
    ZeroVolume = 8,
    /// Two triangles meet outside what they share by index. ids: triangle, triangle
    SelfIntersection = 9,
    /// No triangles at all. ids: none
    Empty = 10,
    /// Plane with a coefficient that is not finite. ids: plane
    NonFinitePlane = 11,
    /// Plane with a zero normal. ids: plane
    ZeroNormal = 12,
    /// The corners of a tetrahedron lie in a plane, or those of a triangle of the plane on a line, exactly (equal corners
    /// included). ids: simplex
    DegenerateSimplex = 13,
    /// Two simplices lie on the same side of a face that they share (or more than two share it). ids: lower simplex, higher simplex
    OverlappingSimplices = 14,
    /// The triangles of an operand do not balance at an edge, as point sets. ids: operand, and those of its vertices that the edge joins (−1: the
    /// edge ends between vertices, where triangles cut one another)
    UnbalancedEdge = 15,
}

/// One defect: its kind and the ids of the elements, −1 where unused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Culprit {
    pub kind: DefectKind,
    pub ids: [i64; 3],
}

impl Culprit {
    pub fn new(kind: DefectKind, ids: &[i64]) -> Self {
        let mut all = [-1; 3];
        all[..ids.len()].copy_from_slice(ids);
        Self { kind, ids: all }
    }
}

#[derive(Clone, Debug)]
pub struct Error {
    pub status: Status,
    pub message: String,
    pub culprits: Vec<Culprit>,
}

pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    pub fn new(status: Status, message: impl Into<String>) -> Self {
        Self { status, message: message.into(), culprits: Vec::new() }
    }
    pub fn with(status: Status, message: impl Into<String>, culprits: Vec<Culprit>) -> Self {
        Self { status, message: message.into(), culprits }
    }
    pub fn inconsistent(message: impl Into<String>) -> Self {
        Self::new(Status::Inconsistent, message)
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

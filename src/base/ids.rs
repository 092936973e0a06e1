//! Typed 32-bit ids. A bare integer is never an element: the compiler keeps a vertex from being used as an edge.

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// "No such element"; never a valid id, since counts are limited to `i32::MAX`.
            pub const NONE: Self = Self(u32::MAX);

            /// The id of position `i`. Counts are checked against `i32::MAX` where arrays come in.
            #[inline(always)]
            pub fn of(i: usize) -> Self {
                debug_assert!(i < u32::MAX as usize);
                Self(i as u32)
            }
            /// The position that this id names.
            #[inline(always)]
            pub fn at(self) -> usize {
                self.0 as usize
            }
            #[inline(always)]
            pub fn is_none(self) -> bool {
                self.0 == u32::MAX
            }
            #[inline(always)]
            pub fn is_some(self) -> bool {
                self.0 != u32::MAX
            }
        }

        impl $crate::base::csr::Offset for $name {
            #[inline(always)]
            fn at(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

ids! {
    /// A vertex, of the input mesh or of an output complex (the mesh's vertices come first there).
    VertexId,
    /// An edge, of the input mesh or of an output complex.
    EdgeId,
    /// A triangle of the input mesh.
    TriangleId,
    /// A cutting plane, by its place in the caller's list.
    PlaneId,
    /// A family of parallel planes.
    FamilyId,
    /// A face of an output complex.
    FaceId,
    /// A loop of a face: a cyclic run of corners.
    LoopId,
    /// A cell of an output complex.
    CellId,
    /// A shell: a closed, edge-connected set of half-faces; of the input mesh, or of a cell.
    ShellId,
    /// An edge-connected component of the input surface.
    ComponentId,
    /// A box of a block of a rectilinear grid: i + nx·(j + ny·k).
    BoxId,
    /// A node of a block of a rectilinear grid: i + (nx + 1)·(j + (ny + 1)·k); or a node of the domain of a network.
    NodeId,
    /// A square of one plane of a rectilinear grid: i + n·j, i along the lower of the plane's two axes, which has n boxes.
    SquareId,
    /// A connected region of fluid in a block of a grid.
    RegionId,
    /// A simplex of the domain of a network: a tetrahedron, or a triangle in the plane.
    TetId,
    /// A function of a network (of a material interface: a material), by its place in the caller's list.
    FunctionId,
    /// A set of functions that polygons of a network lie on.
    SetId,
    /// A polygon of a network.
    PolygonId,
    /// A patch of a network or of an arrangement: polygons connected across manifold edges.
    PatchId,
    /// An operand of an arrangement, by its place in the caller's list.
    OperandId,
}

/// For engines with elements of their own.
pub(crate) use ids;

! Lapidary: exact partitions of 3-D space, for Fortran. include/lapidary.f90 is generated from include/lapidary.h and
! fortran/template.f90: do not edit it. What the calls do, their units, ownership, errors and costs: in the comments
! below, which are those of the C header.
!
! How C is written in Fortran here:
!
!   status        Every function returns integer(c_int32_t): LAP_OK or one of LAP_ERR_*.
!   handles       type(c_ptr). A call that makes or lends one sets a type(c_ptr) variable.
!   NULL          Outputs, input arrays and options are optional: leave out what you do not want, and use keywords for
!                 the rest. For a handle or a user pointer NULL is c_null_ptr, for a callback c_null_funptr.
!   input arrays  Assumed-size: pass a whole array of any rank, xyz(3, n) for example. Elements are in C's order then.
!   options       Derived types with bind(c). Fill them first:
!                 status = lap_mesh_options_init(options, int(c_sizeof(options), c_int32_t))
!   views         A call lends an address and a count, valid as long as the handle and not to be written. lap_view
!                 makes array pointers of them: call lap_view(address, count, array) for array(:), and
!                 call lap_view(address, 3, count, array) for array(:, :) of three rows and a column per element.
!                 uint8_t is integer(c_int8_t), which is signed.
!   strings       lap_text(address) is a copy of a C string.
!   callbacks     bind(c) procedures with the interface lap_progress, lap_log or lap_choose, handed over as c_funloc(procedure).
!
! Indices. Array pointers count from 1; ids and offsets in arrays count from 0 as in C, and -1 is none. So element i of
! C is array(i + 1), and row i (from 0) of a CSR pair is items(offsets(i + 1) + 1 : offsets(i + 2)). Or give a pointer
! the lower bound 0, and ids index it as they are:
!
!   real(c_double), pointer :: xyz(:, :)
!   call lap_view(address, 3, count, xyz)
!   xyz(1:, 0:) => xyz
!   x = xyz(:, corner_vertices(k))
!
! Build: compile this file with the compiler of the program (module files are not portable) and link the library. With
! CMake, target_link_libraries(program PRIVATE lapidary::fortran) does both; for several programs in one folder make one
! library that links it, so that the module file is written once.
module lapidary
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_double, c_f_pointer, c_funptr, c_int32_t, c_int64_t, &
    c_int8_t, c_ptr, c_size_t
  implicit none
  private

  ! What a call has lent, as an array: lap_view(address, count, array(:)) or
  ! lap_view(address, rows, count, array(:, :)). NULL, or a count of 0: an array of size 0.
  public :: lap_view
  interface lap_view
    module procedure view_int8, view_int32, view_int64, view_double
    module procedure columns_int32, columns_int64, columns_double
  end interface

  ! A copy of a C string ('' for NULL).
  public :: lap_text

  ! What a view of nothing points to.
  integer(c_int8_t), target, save :: no_int8(0)
  integer(c_int32_t), target, save :: no_int32(0)
  integer(c_int64_t), target, save :: no_int64(0)
  real(c_double), target, save :: no_double(0)

  ! Success.
  integer(c_int32_t), parameter, public :: LAP_OK = 0
  ! A pointer that must not be NULL is NULL.
  integer(c_int32_t), parameter, public :: LAP_ERR_NULL_POINTER = 1
  ! A count, an index, an option or a constant is out of its range.
  integer(c_int32_t), parameter, public :: LAP_ERR_BAD_ARGUMENT = 2
  ! A count exceeds the 32-bit index type.
  integer(c_int32_t), parameter, public :: LAP_ERR_TOO_LARGE = 3
  ! The input mesh has defects; lap_context_last_defects lists them.
  integer(c_int32_t), parameter, public :: LAP_ERR_BAD_MESH = 4
  ! A plane is not finite or has a zero normal; lap_context_last_defects lists them.
  integer(c_int32_t), parameter, public :: LAP_ERR_BAD_PLANE = 5
  ! The progress callback asked to stop. Nothing is left behind.
  integer(c_int32_t), parameter, public :: LAP_ERR_CANCELLED = 6
  ! Memory or a thread could not be had.
  integer(c_int32_t), parameter, public :: LAP_ERR_OUT_OF_MEMORY = 7
  ! The geometry contradicts itself: the input intersects itself and was not checked for it.
  integer(c_int32_t), parameter, public :: LAP_ERR_INCONSISTENT = 8
  ! A fault of the library. The process and all handles stay usable.
  integer(c_int32_t), parameter, public :: LAP_ERR_INTERNAL = 9
  ! The context is in use: by another thread, or by the very call whose callback makes this one.
  integer(c_int32_t), parameter, public :: LAP_ERR_BUSY = 10
  ! A coordinate is NaN or infinite. ids: vertex
  integer(c_int32_t), parameter, public :: LAP_DEFECT_NON_FINITE_COORDINATE = 1
  ! A vertex index is negative or too large. ids: triangle, corner (0, 1, 2), the index as given
  integer(c_int32_t), parameter, public :: LAP_DEFECT_INDEX_OUT_OF_RANGE = 2
  ! The corners of a triangle lie on a line, exactly. ids: triangle
  integer(c_int32_t), parameter, public :: LAP_DEFECT_DEGENERATE_TRIANGLE = 3
  ! The triangles at an edge do not balance in number. ids: vertex, vertex, one triangle there
  integer(c_int32_t), parameter, public :: LAP_DEFECT_OPEN_EDGE = 4
  ! The triangles at an edge balance in number, not in orientation. ids: vertex, vertex, one triangle there
  integer(c_int32_t), parameter, public :: LAP_DEFECT_INCONSISTENT_ORIENTATION = 5
  ! Two vertices have equal coordinates. ids: lower vertex, higher vertex
  integer(c_int32_t), parameter, public :: LAP_DEFECT_DUPLICATE_VERTEX = 6
  ! Signed volume does not alternate with nesting depth. ids: a triangle of the shell
  integer(c_int32_t), parameter, public :: LAP_DEFECT_WRONG_NESTING = 7
  ! A shell without volume. ids: a triangle of the shell
  integer(c_int32_t), parameter, public :: LAP_DEFECT_ZERO_VOLUME = 8
  ! Two triangles meet outside what they share by index. ids: triangle, triangle
  integer(c_int32_t), parameter, public :: LAP_DEFECT_SELF_INTERSECTION = 9
  ! There are no triangles. ids: none
  integer(c_int32_t), parameter, public :: LAP_DEFECT_EMPTY = 10
  ! A coefficient of a plane is NaN or infinite. ids: plane
  integer(c_int32_t), parameter, public :: LAP_DEFECT_NON_FINITE_PLANE = 11
  ! The normal of a plane is zero. ids: plane
  integer(c_int32_t), parameter, public :: LAP_DEFECT_ZERO_NORMAL = 12
  ! The corners of a tetrahedron lie in a plane, or those of a triangle of the plane on a line, exactly (equal corners
  ! included). ids: simplex
  integer(c_int32_t), parameter, public :: LAP_DEFECT_DEGENERATE_SIMPLEX = 13
  ! Two simplices lie on the same side of a face that they share, or more than two share it. ids: lower simplex, higher
  ! simplex
  integer(c_int32_t), parameter, public :: LAP_DEFECT_OVERLAPPING_SIMPLICES = 14
  ! The triangles of an operand do not balance at an edge, as point sets. ids: operand, and those of its vertices that
  ! the edge joins (-1: the edge ends between vertices, where triangles cut one another)
  integer(c_int32_t), parameter, public :: LAP_DEFECT_UNBALANCED_EDGE = 15
  ! Largest number of threads of a context.
  integer(c_int32_t), parameter, public :: LAP_MAX_THREADS = 1024
  ! Level of a log message: what the library does and why.
  integer(c_int32_t), parameter, public :: LAP_LOG_INFO = 0
  ! A point outside the solid.
  integer(c_int32_t), parameter, public :: LAP_PLACE_OUTSIDE = -1
  ! A point on the surface of the solid.
  integer(c_int32_t), parameter, public :: LAP_PLACE_SURFACE = 0
  ! A point inside the solid.
  integer(c_int32_t), parameter, public :: LAP_PLACE_INSIDE = 1
  ! A vertex of the input mesh. ids: its index in the caller's array
  integer(c_int32_t), parameter, public :: LAP_VERTEX_MESH = 0
  ! Where an edge of the mesh crosses a plane. ids: the two vertices of the edge, the lowest plane
  integer(c_int32_t), parameter, public :: LAP_VERTEX_EDGE = 1
  ! Inside a triangle of the mesh, on two planes. ids: triangle, plane, plane
  integer(c_int32_t), parameter, public :: LAP_VERTEX_TRIANGLE = 2
  ! Inside the solid, on three planes. ids: plane, plane, plane
  integer(c_int32_t), parameter, public :: LAP_VERTEX_PLANES = 3
  ! Where triangles of an arrangement meet. ids: three triangles; or one at an edge, one that it crosses, and -1
  integer(c_int32_t), parameter, public :: LAP_VERTEX_TRIANGLES = 4
  ! A point of a network's domain where functions vanish (materials are equal). ids: the network's vertex, -1, -1
  integer(c_int32_t), parameter, public :: LAP_VERTEX_LEVEL = 5
  ! Where two triangles of an arrangement and the plane of a half-space meet. ids: triangle, triangle, plane
  integer(c_int32_t), parameter, public :: LAP_VERTEX_TRIANGLES_PLANE = 6
  ! A face that lies on a triangle of the input mesh.
  integer(c_int32_t), parameter, public :: LAP_SUPPORT_TRIANGLE = 0
  ! A face that lies on a plane.
  integer(c_int32_t), parameter, public :: LAP_SUPPORT_PLANE = 1
  ! A polygon of a network.
  integer(c_int32_t), parameter, public :: LAP_SUPPORT_LEVEL = 2
  ! Faces with holes: one polygon per loop.
  integer(c_int32_t), parameter, public :: LAP_FACES_HOLES = 0
  ! Every hole joined to its outer loop by a bridge that is walked twice: one polygon per face.
  integer(c_int32_t), parameter, public :: LAP_FACES_BRIDGED = 1
  ! Triangles.
  integer(c_int32_t), parameter, public :: LAP_FACES_TRIANGLES = 2
  ! The open box holds no fluid.
  integer(c_int32_t), parameter, public :: LAP_BOX_EMPTY = 0
  ! The closed box misses the surface and is fluid: one cell, the box itself, which is not stored as a polyhedron.
  integer(c_int32_t), parameter, public :: LAP_BOX_FULL = 1
  ! The surface touches the closed box, and the open box holds fluid: one or more cells, stored as polyhedra. A box with
  ! a wall on its side and a volume fraction of 1 is cut.
  integer(c_int32_t), parameter, public :: LAP_BOX_CUT = 2
  ! Where a cell is named: there is none, the face is on the boundary of the block.
  integer(c_int32_t), parameter, public :: LAP_CELL_NONE = -1
  ! Where a cell is named: the one cell of a full box.
  integer(c_int32_t), parameter, public :: LAP_CELL_FULL = -2
  ! Nothing is told about a node: the mesh is whole.
  integer(c_int32_t), parameter, public :: LAP_NODE_UNKNOWN = 0
  ! The node is in the fluid, and not on the surface.
  integer(c_int32_t), parameter, public :: LAP_NODE_FLUID = 1
  ! The node is neither in the fluid nor on the surface.
  integer(c_int32_t), parameter, public :: LAP_NODE_SOLID = 2
  ! Where a point is: not in the fluid.
  integer(c_int32_t), parameter, public :: LAP_REGION_SOLID = -1
  ! Where a point is: on the surface, exactly.
  integer(c_int32_t), parameter, public :: LAP_REGION_SURFACE = -2
  ! Where a point is: outside the block's closed box.
  integer(c_int32_t), parameter, public :: LAP_REGION_BEYOND = -3
  ! The arrangement (IA): the planes where a function is zero divide the simplex.
  integer(c_int32_t), parameter, public :: LAP_SIMPLEX_ARRANGEMENT = 0
  ! The material interface (MI): cells are where a material is the largest.
  integer(c_int32_t), parameter, public :: LAP_SIMPLEX_INTERFACE = 1
  ! A face in a facet of the simplex; its positive side is the simplex. ids: the corner opposite to the facet
  integer(c_int32_t), parameter, public :: LAP_SIMPLEX_FACET = 0
  ! A face on the plane of a function, inside the simplex; positive where the function is. ids: the lowest such function
  integer(c_int32_t), parameter, public :: LAP_SIMPLEX_FUNCTION = 1
  ! A face between two materials; positive where the first is larger. ids: the owners of the cells on its positive and
  ! on its negative side, the first one lower
  integer(c_int32_t), parameter, public :: LAP_SIMPLEX_PAIR = 2
  ! The implicit arrangement (IA): surfaces are where functions are zero.
  integer(c_int32_t), parameter, public :: LAP_NETWORK_ARRANGEMENT = 0
  ! The material interface (MI): surfaces are where the largest function, the material, changes.
  integer(c_int32_t), parameter, public :: LAP_NETWORK_INTERFACE = 1
  ! Regions are found by rays through the grid where these tell (a box, no vertex of the network at a node), else as
  ! LAP_REGIONS_CLASSES.
  integer(c_int32_t), parameter, public :: LAP_REGIONS_AUTOMATIC = 0
  ! Regions are found as classes of nodes, shells and cells, whatever the domain. The same regions, more time.
  integer(c_int32_t), parameter, public :: LAP_REGIONS_CLASSES = 1
  ! What is inside any operand.
  integer(c_int32_t), parameter, public :: LAP_EXTRACT_UNION = 0
  ! What is inside all operands.
  integer(c_int32_t), parameter, public :: LAP_EXTRACT_INTERSECTION = 1
  ! What is inside the first operand and no other one.
  integer(c_int32_t), parameter, public :: LAP_EXTRACT_DIFFERENCE = 2
  ! What is inside an odd number of operands.
  integer(c_int32_t), parameter, public :: LAP_EXTRACT_SYMMETRIC_DIFFERENCE = 3
  ! What is inside at least so many operands, one or more.
  integer(c_int32_t), parameter, public :: LAP_EXTRACT_AT_LEAST = 4
  ! Where the winding numbers of all operands have a positive sum: what is inside, were all one mesh.
  integer(c_int32_t), parameter, public :: LAP_EXTRACT_RESOLVE = 5
  ! Handle lap_arrangement (type(c_ptr)). The cells into which triangle meshes, the operands, divide space, each with
  ! its winding number for every operand; solids made of cells (lap_arrangement_extract). Exact for any finite
  ! coordinates.
  !
  ! Operands. Any number of meshes that intersect themselves and one another, with several components, nested, with
  ! non-manifold edges, with duplicate and overlapping triangles in any orientation, with triangles without area (which
  ! are dropped). What is asked of each is that its triangles balance at every edge, as point sets: as many on one side
  ! run along it as against it (T-junctions that cancel are fine). Then every point off the surface has a winding
  ! number, an integer: how often the surface goes around it, positive where it faces outward. A point is inside an
  ! operand where that is positive.
  !
  ! Vertices: the points that operands give, equal ones once, then those where triangles meet; not all of them are
  ! corners of faces. Faces: triangles that meet in common vertices and edges only, no two with the same corners; each
  ! is a part of one input triangle or of several that lie on one another there, its births, and runs like the first of
  ! them. Patch: faces joined across edges with two faces. Cell: a connected part of space without faces that divide;
  ! number 0 is the unbounded one. Where births cancel in every operand a face divides nothing: it has no patch and no
  ! cells. Triangles and vertices of all operands, where they are one number, count through the operands, one behind the
  ! other (lap_arrangement_operands). Half-spaces may be operands too (lap_arrangement_new_half_spaces).
  !
  ! Immutable: a const handle may be used from many threads at once; what is computed on demand is computed once.
  ! Handle lap_certified (type(c_ptr)). A complex as triangles over doubles that were checked exactly, repaired where
  ! rounding had made triangles meet, and a report. Immutable: a const handle may be used from many threads at once.
  !
  ! Certified means: no triangle is without area; no two triangles meet but in a vertex or an edge that they share by
  ! index (all pairs, of all faces); every cell's outer surface encloses a positive volume, every void in it a negative
  ! one. All of that holds exactly for the doubles as they are, so the cells are disjoint solids that fill the input up
  ! to the changes that the report tells.
  !
  ! Vertices, faces and cells have numbers of their own here, in the complex's order without those that are gone; maps
  ! lead from the complex's numbers to these. Where nothing had to be repaired both are the same. The complex stays as
  ! it is.
  ! Handle lap_complex (type(c_ptr)). Vertices, edges, faces and cells. Belongs to the handle that it was borrowed from.
  ! Ids are positions in the arrays, from 0. Immutable: a const handle may be used from many threads at once; what is
  ! computed on demand is computed once.
  !
  ! Half-faces: side s of face f is the half-face 2 f + s. Side 0 is the back, from which the face's normal points away;
  ! it belongs to the cell behind the face, the owner, whose outward normal the face's normal is. Side 1 is the front;
  ! it belongs to the neighbour, and there the outward normal is the face's normal reversed.
  ! Handle lap_context (type(c_ptr)). What calls need besides their data: threads, callbacks, the last error, predicate
  ! counters. One thread uses a context at a time; any number of contexts may exist. Other handles do not need the
  ! context that made them once they are made, so it may be freed before them. Do not carry a context over a fork().
  ! Handle lap_cut (type(c_ptr)). The cells into which planes divide a solid, and how they were found. Immutable: a
  ! const handle may be used from many threads at once.
  ! Handle lap_grid (type(c_ptr)). A block of a rectilinear grid, cut by a surface: a byte per box, polyhedra for the
  ! boxes that are cut, and on demand the arrays of embedded-boundary solvers.
  !
  ! Boxes and nodes. A block of nx × ny × nz boxes has (nx + 1) × (ny + 1) × (nz + 1) nodes. Box (i, j, k) of the
  ! block has the number i + nx (j + ny k), its low corner is node (i, j, k), and node (i, j, k) has the number i + (nx
  ! + 1) (j + (ny + 1) k). All indices count from the block's low corner unless it says that they are of the whole grid.
  !
  ! Cells. Box b holds as many cells as the surface divides its fluid into; they are numbered by rising box. A cell is
  ! bounded by faces: walls, which lie on triangles of the mesh, and faces in grid planes, which join two cells or lie
  ! on the boundary of the block. Half-faces are those of lap_complex: 2 f + s, side 0 behind the face's normal, side 1
  ! before it. The normal of a wall points out of the fluid (so only side 0 of it is used), that of a face in a grid
  ! plane along the axis (so side 0 belongs to the cell with the lower index).
  !
  ! Immutable: a const handle may be used from many threads at once; what is computed on demand is computed once.
  ! Handle lap_mesh (type(c_ptr)). A closed triangle mesh that bounds a solid: the triangles of every edge balance in
  ! orientation, solids are oriented outward and voids inward. Any genus, several components, voids, non-manifold edges
  ! and vertices. A const handle may be used from many threads at once; only lap_mesh_update_coordinates changes a mesh.
  ! Handle lap_network (type(c_ptr)). The network of piecewise linear functions on a domain of tetrahedra (in two
  ! dimensions: triangles): vertices, polygons, and what they form. Exact for any finite values.
  !
  ! Domain. A simplex is a tetrahedron (triangle); a node is a vertex of the domain, where functions have their values;
  ! in a simplex they are linear. A box of nx × ny × nz cubes has node (i, j, k) at i + (nx + 1) (j + (ny + 1) k),
  ! cube (i, j, k) at i + nx (j + ny k), and five tetrahedra a cube, 5 c to 5 c + 4 of cube c: one at each corner with
  ! even i + j + k, then the one between the corners with odd i + j + k.
  !
  ! Arrangement: polygons are pieces of the zero sets of functions. A function that is zero on a lower-dimensional part
  ! of a simplex only does not split it. A piece of the face between two simplices is a polygon if the sign of a
  ! function differs on its sides, or if a function is zero on it and in neither simplex. Functions that are zero on one
  ! polygon are listed with it as a set. Interface: polygons are where the regions of two materials meet; where
  ! materials are equal on a whole piece, the lowest owns it. There are no polygons on the boundary of the domain.
  !
  ! Polygons are convex and lie in one simplex or on the face between two. Normals: arrangement: to the positive side of
  ! the lowest function that has different signs on the two sides (where none has: into the simplex with the higher
  ! number); interface: into the lower material. Loops run anticlockwise seen from the tip of the normal.
  !
  ! Patch: polygons joined across edges that have two polygons with one set of functions (and are not on the boundary of
  ! the domain). Chain: a longest path or loop along other edges with two or more polygons, around which the same
  ! patches meet. (An edge with one polygon is a border.) Corner: a vertex where chains end. Component: patches that
  ! share vertices. Shell: sides of patches that bound one region along chains. Region: a part of the domain without
  ! polygons inside, bounded by shells; its label is the sign of every function, or the material. The side of a patch is
  ! 2 p + s for patch p: s is 0 behind its normal, 1 before it.
  !
  ! Two dimensions: polygons are segments, from the first vertex to the second, with the normal to the left; edges are
  ! vertices (both ends are the same); each vertex of the chain kind is a chain and a corner by itself; fourth nodes are
  ! -1, third coordinates 0.
  !
  ! Immutable: a const handle may be used from many threads at once; what is computed on demand is computed once.
  ! Handle lap_simplex (type(c_ptr)). The complexes of tetrahedra or triangles, each divided by linear functions that
  ! are given by their values at its corners: cells, faces, edges and vertices, the simplex's own boundary included.
  ! Exact for any finite values.
  !
  ! Faces separate cells: polygons in a tetrahedron, segments in a triangle, where there are no edges. Cells and faces
  ! are convex, without straight corners, so the complex is fixed by the functions alone; their order changes numbers,
  ! and nothing else. Ids count through all simplices of a call: those of simplex s are the ones between offsets that
  ! lap_simplex_offsets tells. A simplex's own corners are its first vertices. In one whose corners are oriented the
  ! other way than det(b - a, c - a, d - a) > 0, anticlockwise is to be read as clockwise.
  !
  ! Ties. Arrangement: a function that is zero everywhere, or on a lower-dimensional part of the boundary only, divides
  ! nothing; functions with the same plane (f, 2 f, -f) share its faces. Interface: of materials that are equal
  ! everywhere the lowest owns the cell; a material that is largest on a lower-dimensional set only has no cell and
  ! divides nothing. All of them are named where they are zero (largest).
  !
  ! Half-faces: side 0 of face f, 2 f, is its positive side, side 1, 2 f + 1, its negative one. (A face of lap_complex
  ! has its owner behind it, on side 0: that is the negative side of its normal.)
  !
  ! One handle is filled again and again, and keeps its memory; filling it needs it alone. Otherwise a const handle may
  ! be used from many threads at once.
  ! Handle lap_surface (type(c_ptr)). The boundary of a union of regions of a network, or of cells of an arrangement: an
  ! oriented mesh. What is between two that were both chosen is gone. It is closed, except where a solid of regions
  ! reaches the boundary of the network's domain. It needs neither the network nor the arrangement to stay alive (and
  ! keeps what it needs of the latter).
  !
  ! Immutable: a const handle may be used from many threads at once; what is computed on demand is computed once.

  public :: lap_progress
  abstract interface
    ! Progress of a call: the name of its stage (valid during the callback) and the fraction of the whole call that is
    ! done, from 0 to 1, never falling. Return 0 to go on, anything else to cancel the call.
    !
    ! Runs on the thread that made the call and under the floating-point environment which that thread had. Must return
    ! normally (no exception, no longjmp) and must not use the same context (LAP_ERR_BUSY).
    integer(c_int32_t) function lap_progress(user, stage, fraction) bind(c)
      import :: c_double, c_int32_t, c_ptr
      type(c_ptr), value :: user
      type(c_ptr), value :: stage
      real(c_double), value :: fraction
    end function
  end interface

  public :: lap_log
  abstract interface
    ! A log message (valid during the callback) and its level, LAP_LOG_INFO. The same rules as for lap_progress.
    subroutine lap_log(user, level, message) bind(c)
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: user
      integer(c_int32_t), value :: level
      type(c_ptr), value :: message
    end subroutine
  end interface

  ! Options of lap_mesh_new; filled by lap_mesh_options_init.
  type, bind(c), public :: lap_mesh_options
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
    ! Nonzero: vertices with equal coordinates become one (the lowest index stands for all). 0, the default: they are a
    ! defect.
    integer(c_int32_t) :: merge_duplicate_vertices
    ! Nonzero: find every pair of triangles that meet outside a vertex or an edge which they share, exactly. 0, the
    ! default: self-intersecting input gives LAP_ERR_INCONSISTENT or a result of unspecified geometry, never a crash.
    integer(c_int32_t) :: check_self_intersection
  end type

  ! Options of lap_cut_new; filled by lap_cut_options_init.
  type, bind(c), public :: lap_cut_options
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
    ! Nonzero: run lap_complex_check on the result and fail with LAP_ERR_INCONSISTENT if it does not hold. 0, the
    ! default: do not.
    integer(c_int32_t) :: check
  end type

  ! Options of lap_certified_new; filled by lap_certify_options_init.
  type, bind(c), public :: lap_certify_options
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
    ! Nonzero: check and report, repair nothing. 0, the default: repair.
    integer(c_int32_t) :: check_only
    ! Nonzero: ask also about pairs of triangles of the input that no plane has cut. They meet only if the input
    ! intersects itself, so this is for input that was not checked. 0, the default: do not.
    integer(c_int32_t) :: check_input
  end type

  ! What lap_certified_report writes. Lengths are in the unit of the coordinates.
  type, bind(c), public :: lap_certify_report
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
    ! 1 if nothing remains, else 0: then lap_certified_open says where.
    integer(c_int32_t) :: certified
    ! With correctly rounded coordinates, before any repair: triangles without area; pairs of triangles that meet, of
    ! those that bound one cell, or the outside (if any meet, some of these do); outer surfaces and voids of cells whose
    ! volume does not have its sign (asked only where the other two are 0).
    integer(c_int64_t) :: flat_before
    integer(c_int64_t) :: contacts_before
    integer(c_int64_t) :: volumes_before
    ! Vertices of the complex that are not at their correctly rounded coordinates any more, those that were merged into
    ! others included; how many of them are vertices of the input mesh; how many were merged.
    integer(c_int64_t) :: moved_vertices
    integer(c_int64_t) :: moved_mesh_vertices
    integer(c_int64_t) :: merged_vertices
    ! Faces and cells that are gone: those of which too little is left for doubles. The maps list them.
    integer(c_int64_t) :: removed_faces
    integer(c_int64_t) :: removed_cells
    ! What lap_certified_open lists.
    integer(c_int64_t) :: open_pairs
    integer(c_int64_t) :: open_cells
    ! The largest change of any coordinate; and the unit in which vertices are moved: one ulp of the largest
    ! |coordinate| of the mesh's bounding box.
    real(c_double) :: largest_move
    real(c_double) :: move_unit
  end type

  ! Options of lap_grid_new and lap_grid_new_patch; filled by lap_grid_options_init.
  type, bind(c), public :: lap_grid_options
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
    ! Nonzero: the fluid is outside the solid, as in external flow (the grid's box minus the bodies). 0, the default:
    ! the fluid is the solid's inside.
    integer(c_int32_t) :: outside
    ! Nonzero: run lap_grid_check on the result and fail with LAP_ERR_INCONSISTENT if it does not hold. 0, the default:
    ! do not.
    integer(c_int32_t) :: check
    ! The block: boxes block_low[a] up to, not including, block_high[a] of the whole grid along axis a (0: x, 1: y, 2:
    ! z). -1 as block_high[a] stands for the number of boxes. Default: 0 and -1, the whole grid.
    integer(c_int32_t) :: block_low(3)
    integer(c_int32_t) :: block_high(3)
    ! For a patch: what is known about node known_node (its indices in the whole grid; a node of the block):
    ! LAP_NODE_FLUID or LAP_NODE_SOLID. Default: LAP_NODE_UNKNOWN.
    integer(c_int32_t) :: known
    integer(c_int32_t) :: known_node(3)
  end type

  ! Options of lap_network_new_*; filled by lap_network_options_init.
  type, bind(c), public :: lap_network_options
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
    ! LAP_NETWORK_ARRANGEMENT, the default, or LAP_NETWORK_INTERFACE.
    integer(c_int32_t) :: kind
    ! How regions are found: LAP_REGIONS_AUTOMATIC, the default, or LAP_REGIONS_CLASSES.
    integer(c_int32_t) :: regions
    ! Nonzero: keep a copy of the values and of the mesh, which lap_network_vertex_exact, lap_network_region_ties,
    ! lap_network_complex and lap_network_check need. 0, the default: do not.
    integer(c_int32_t) :: keep_values
  end type

  public :: lap_choose
  abstract interface
    ! Whether a region is in the solid: return 0 if not, anything else if it is.
    !
    ! Runs on the thread that made the call and under the floating-point environment which that thread had. Must return
    ! normally (no exception, no longjmp) and must not use the same context (LAP_ERR_BUSY).
    integer(c_int32_t) function lap_choose(user, region) bind(c)
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: user
      integer(c_int32_t), value :: region
    end function
  end interface

  ! Options of lap_arrangement_new; filled by lap_arrangement_options_init. There is nothing to choose yet.
  type, bind(c), public :: lap_arrangement_options
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
  end type

  ! One operand of an arrangement: any triangle mesh that balances at its edges (see lap_arrangement). Its arrays are
  ! borrowed for the call.
  type, bind(c), public :: lap_operand
    integer(c_int64_t) :: n_vertices
    ! 3 × n_vertices coordinates, each taken as the exact number that it is.
    type(c_ptr) :: xyz
    integer(c_int64_t) :: n_triangles
    ! 3 × n_triangles vertex indices from 0, anticlockwise seen from outside.
    type(c_ptr) :: indices
  end type

  public :: lap_inside
  abstract interface
    ! Whether a cell is in the solid: return 0 if not, anything else if it is. winding: its winding number for each of
    ! the n_operands operands (valid during the callback); the cell is inside those where it is positive.
    !
    ! Runs on the thread that made the call and under the floating-point environment which that thread had, while no
    ! work of the library runs with this context. Must return normally (no exception, no longjmp) and must not use the
    ! same context (LAP_ERR_BUSY); handles and other contexts may be used.
    integer(c_int32_t) function lap_inside(user, cell, n_operands, winding) bind(c)
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: user
      integer(c_int32_t), value :: cell
      integer(c_int64_t), value :: n_operands
      type(c_ptr), value :: winding
    end function
  end interface

  ! Options of lap_surface_certify; filled by lap_surface_certify_options_init.
  type, bind(c), public :: lap_surface_certify_options
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
    ! Nonzero: check and report, repair nothing. 0, the default: repair.
    integer(c_int32_t) :: check_only
    ! How many rounds of repair there may be, 1 or more; 0, the default: the library's own bound. Most surfaces need one
    ! or two.
    integer(c_int32_t) :: max_rounds
  end type

  ! What lap_surface_certified_report writes. Lengths are in the unit of the coordinates.
  type, bind(c), public :: lap_surface_certify_report
    ! Size of this struct in bytes, as the caller was compiled.
    integer(c_int32_t) :: struct_size
    ! 1 if nothing remains, else 0: then lap_surface_certified_open says where.
    integer(c_int32_t) :: certified
    ! With correctly rounded coordinates, before any repair: triangles without area; pairs of others that meet beyond
    ! what they share by index (counted up to a bound that grows with the triangles).
    integer(c_int64_t) :: flat_before
    integer(c_int64_t) :: contacts_before
    ! Rounds of repair, each an exact arrangement of the surface, that were needed; the last one changed nothing.
    integer(c_int64_t) :: rounds
    integer(c_int64_t) :: triangles_before
    integer(c_int64_t) :: triangles_after
    ! Triangles of the surface of which no part is left.
    integer(c_int64_t) :: removed_triangles
    ! Vertices of the result at places where the surface has none.
    integer(c_int64_t) :: moved_vertices
    ! Places of vertices of the surface at which the result has none.
    integer(c_int64_t) :: gone_vertices
    ! Places where vertices, edges and triangles near one another were made to share vertices.
    integer(c_int64_t) :: snapped
    ! Cells too thin for doubles that were left out of the solid or filled in.
    integer(c_int64_t) :: thin_cells
    ! What lap_surface_certified_open lists.
    integer(c_int64_t) :: open_pairs
    ! A bound on how far the surface went in any coordinate from where its correctly rounded vertices have it, thin
    ! cells apart.
    real(c_double) :: largest_move
    ! One ulp of the largest |coordinate|.
    real(c_double) :: move_unit
  end type

  public :: lap_version
  interface
    ! The version of the library that is running.
    !
    ! Outputs (each may be NULL): the three numbers, and "major.minor.patch" as a string that lives as long as the
    ! process. Versions with equal major number are compatible (with major number 0: with equal minor number).
    !
    ! Errors: none. Threads: any. Cost: none.
    integer(c_int32_t) function lap_version(major, minor, patch, text) bind(c, name="lap_version")
      import :: c_int32_t, c_ptr
      integer(c_int32_t), intent(inout), optional :: major
      integer(c_int32_t), intent(inout), optional :: minor
      integer(c_int32_t), intent(inout), optional :: patch
      type(c_ptr), intent(inout), optional :: text
    end function
  end interface

  public :: lap_status_name
  interface
    ! The name of a status code, for example "LAP_ERR_BAD_MESH"; "LAP_ERR_?" for a number that is no status code.
    !
    ! name: the string lives as long as the process.
    !
    ! Errors: LAP_ERR_NULL_POINTER if name is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_status_name(status, name) bind(c, name="lap_status_name")
      import :: c_int32_t, c_ptr
      integer(c_int32_t), value :: status
      type(c_ptr), intent(inout), optional :: name
    end function
  end interface

  public :: lap_defect_name
  interface
    ! The name of a defect kind, for example "LAP_DEFECT_OPEN_EDGE"; "LAP_DEFECT_?" for a number that is none.
    !
    ! name: the string lives as long as the process.
    !
    ! Errors: LAP_ERR_NULL_POINTER if name is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_defect_name(kind, name) bind(c, name="lap_defect_name")
      import :: c_int32_t, c_ptr
      integer(c_int32_t), value :: kind
      type(c_ptr), intent(inout), optional :: name
    end function
  end interface

  public :: lap_context_new
  interface
    ! Makes a context: one thread, no callbacks, counters off.
    !
    ! context: receives the handle; free it with lap_context_free. The pool's threads are started when first needed.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: an allocation.
    integer(c_int32_t) function lap_context_new(context) bind(c, name="lap_context_new")
      import :: c_int32_t, c_ptr
      type(c_ptr), intent(inout), optional :: context
    end function
  end interface

  public :: lap_context_free
  interface
    ! Frees a context and all that was borrowed from it. NULL is allowed and does nothing.
    !
    ! Errors: LAP_ERR_BUSY if called from one of the context's callbacks; nothing is freed then.
    integer(c_int32_t) function lap_context_free(context) bind(c, name="lap_context_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
    end function
  end interface

  public :: lap_context_set_threads
  interface
    ! Sets how many worker threads the calls with this context use: 1 (the default) to LAP_MAX_THREADS. Results do not
    ! depend on it, bit for bit. With 1, a call computes in one worker thread while the calling thread waits.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT, LAP_ERR_BUSY. Cost: none; a pool of the old size is let go.
    integer(c_int32_t) function lap_context_set_threads(context, threads) bind(c, name="lap_context_set_threads")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      integer(c_int32_t), value :: threads
    end function
  end interface

  public :: lap_context_threads
  interface
    ! The number of worker threads that calls with this context use.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
    integer(c_int32_t) function lap_context_threads(context, threads) bind(c, name="lap_context_threads")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      integer(c_int32_t), intent(inout), optional :: threads
    end function
  end interface

  public :: lap_context_set_progress
  interface
    ! Sets the progress callback (NULL: none) and the pointer that is handed to it.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: some microseconds per call-back.
    integer(c_int32_t) function lap_context_set_progress(context, callback, &
      user) bind(c, name="lap_context_set_progress")
      import :: c_funptr, c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_funptr), value :: callback
      type(c_ptr), value :: user
    end function
  end interface

  public :: lap_context_set_log
  interface
    ! Sets the log callback (NULL: none) and the pointer that is handed to it. The library never writes to a file, to
    ! the standard output or to the standard error by itself.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: some microseconds per call-back.
    integer(c_int32_t) function lap_context_set_log(context, callback, user) bind(c, name="lap_context_set_log")
      import :: c_funptr, c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_funptr), value :: callback
      type(c_ptr), value :: user
    end function
  end interface

  public :: lap_context_last_error
  interface
    ! How the last call with this context ended: its status (LAP_OK after success) and its message ("" after success),
    ! which names the offending element. Calls of lap_context_last_error, lap_context_last_defects, lap_context_threads
    ! and lap_context_counter* leave both as they are.
    !
    ! Outputs (each may be NULL). message is valid until the next call with this context.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
    integer(c_int32_t) function lap_context_last_error(context, status, message) bind(c, name="lap_context_last_error")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      integer(c_int32_t), intent(inout), optional :: status
      type(c_ptr), intent(inout), optional :: message
    end function
  end interface

  public :: lap_context_last_defects
  interface
    ! All defects that the last call with this context found (none after success).
    !
    ! Outputs (each may be NULL): count; kinds: count numbers LAP_DEFECT_*; ids: 3 × count, the elements of each defect
    ! as LAP_DEFECT_* says, in the caller's numbering, -1 where unused. The arrays are valid until the next call with
    ! this context.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
    integer(c_int32_t) function lap_context_last_defects(context, count, kinds, &
      ids) bind(c, name="lap_context_last_defects")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: kinds
      type(c_ptr), intent(inout), optional :: ids
    end function
  end interface

  public :: lap_context_counters_enable
  interface
    ! Switches the predicate counters on (nonzero) or off (0, the default). They tell, per predicate and per tier, how
    ! many decisions the making of meshes and cuts with this context took.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost when on: a few percent of a call.
    integer(c_int32_t) function lap_context_counters_enable(context, on) bind(c, name="lap_context_counters_enable")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      integer(c_int32_t), value :: on
    end function
  end interface

  public :: lap_context_counters_reset
  interface
    ! Sets all predicate counters to 0.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
    integer(c_int32_t) function lap_context_counters_reset(context) bind(c, name="lap_context_counters_reset")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
    end function
  end interface

  public :: lap_context_counters_count
  interface
    ! How many predicate counters there are.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
    integer(c_int32_t) function lap_context_counters_count(context, count) bind(c, name="lap_context_counters_count")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      integer(c_int32_t), intent(inout), optional :: count
    end function
  end interface

  public :: lap_context_counter
  interface
    ! Predicate counter i, from 0: its name ("predicate.tier") and its value, summed over all calls since it was reset.
    ! Tiers: topology (it was known already), filter (a few operations in double), bounded (a running error bound),
    ! exact (integers on the stack), big (integers of any size).
    !
    ! Outputs (each may be NULL). name lives as long as the process.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT if there is no such counter, LAP_ERR_BUSY. Cost: none.
    integer(c_int32_t) function lap_context_counter(context, i, name, value) bind(c, name="lap_context_counter")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      integer(c_int32_t), value :: i
      type(c_ptr), intent(inout), optional :: name
      integer(c_int64_t), intent(inout), optional :: value
    end function
  end interface

  public :: lap_mesh_options_init
  interface
    ! Fills mesh options with the defaults.
    !
    ! struct_size: pass (int32_t)sizeof(lap_mesh_options); no more than that is written, so a program compiled against
    ! an older header keeps working.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
    integer(c_int32_t) function lap_mesh_options_init(options, struct_size) bind(c, name="lap_mesh_options_init")
      import :: c_int32_t, lap_mesh_options
      type(lap_mesh_options), intent(inout), optional :: options
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_mesh_new
  interface
    ! Makes a mesh from flat arrays.
    !
    ! Inputs (borrowed for the call): xyz: 3 × n_vertices coordinates, each taken as the exact number that it is, in
    ! any unit; indices: 3 × n_triangles vertex indices from 0, anticlockwise seen from outside the solid; tags:
    ! n_triangles numbers that are carried to the faces of results (boundary patch, body), or NULL; options: or NULL for
    ! the defaults. Vertices that no triangle uses are allowed. mesh: receives the handle, NULL after an error; free it
    ! with lap_mesh_free.
    !
    ! Errors: LAP_ERR_BAD_MESH with all defects found (lap_context_last_defects): coordinates that are not finite,
    ! indices out of range, degenerate triangles, open edges, inconsistent orientation, wrong nesting, no triangles, and
    ! if asked for self-intersections; LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT, LAP_ERR_TOO_LARGE, LAP_ERR_CANCELLED,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: n log n; with the check for self-intersections several times that.
    integer(c_int32_t) function lap_mesh_new(context, n_vertices, xyz, n_triangles, indices, tags, options, &
      mesh) bind(c, name="lap_mesh_new")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_mesh_options
      type(c_ptr), value :: context
      integer(c_int64_t), value :: n_vertices
      real(c_double), intent(in), optional :: xyz(*)
      integer(c_int64_t), value :: n_triangles
      integer(c_int32_t), intent(in), optional :: indices(*)
      integer(c_int32_t), intent(in), optional :: tags(*)
      type(lap_mesh_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: mesh
    end function
  end interface

  public :: lap_mesh_update_coordinates
  interface
    ! Moves the vertices of a mesh and keeps its connectivity: the adjacency is reused, everything that depends on
    ! coordinates is checked and computed anew, so that the mesh is afterwards what lap_mesh_new would make of them.
    !
    ! The handle is not const: no other thread may use it meanwhile, and what was borrowed from it (lap_mesh_vertices,
    ! lap_mesh_bounds, ...) is no longer valid. Cuts and grids made from the mesh before keep the mesh that they were
    ! made from. After an error the mesh is unchanged.
    !
    ! Inputs (borrowed for the call): xyz: 3 × n_vertices coordinates in the order of lap_mesh_vertices, which is the
    ! caller's own order unless there were unused or merged vertices; options: or NULL for the defaults; only
    ! check_self_intersection counts, and vertices that have become equal are a defect.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT if n_vertices is not the number of vertices of the mesh; LAP_ERR_BAD_MESH with all
    ! defects found (lap_context_last_defects; ids are those of the mesh); LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE,
    ! LAP_ERR_INCONSISTENT, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear, about a third of that
    ! of lap_mesh_new; a copy of the mesh if a cut or a grid holds it.
    integer(c_int32_t) function lap_mesh_update_coordinates(context, mesh, n_vertices, xyz, &
      options) bind(c, name="lap_mesh_update_coordinates")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_mesh_options
      type(c_ptr), value :: context
      type(c_ptr), value :: mesh
      integer(c_int64_t), value :: n_vertices
      real(c_double), intent(in), optional :: xyz(*)
      type(lap_mesh_options), intent(in), optional :: options
    end function
  end interface

  public :: lap_mesh_validate
  interface
    ! Runs every check of lap_mesh_new, the one for self-intersections included, without making a mesh.
    !
    ! Inputs as for lap_mesh_new (options may be NULL; check_self_intersection is taken as set). n_defects (may be NULL)
    ! receives how many defects there are.
    !
    ! Errors: those of lap_mesh_new: LAP_OK means that the mesh is valid, after LAP_ERR_BAD_MESH
    ! lap_context_last_defects lists all defects. Cost: that of lap_mesh_new with the check for self-intersections.
    integer(c_int32_t) function lap_mesh_validate(context, n_vertices, xyz, n_triangles, indices, options, &
      n_defects) bind(c, name="lap_mesh_validate")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_mesh_options
      type(c_ptr), value :: context
      integer(c_int64_t), value :: n_vertices
      real(c_double), intent(in), optional :: xyz(*)
      integer(c_int64_t), value :: n_triangles
      integer(c_int32_t), intent(in), optional :: indices(*)
      type(lap_mesh_options), intent(in), optional :: options
      integer(c_int64_t), intent(inout), optional :: n_defects
    end function
  end interface

  public :: lap_mesh_free
  interface
    ! Frees a mesh. NULL is allowed and does nothing. Results made from the mesh stay valid.
    !
    ! Errors: none.
    integer(c_int32_t) function lap_mesh_free(mesh) bind(c, name="lap_mesh_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: mesh
    end function
  end interface

  public :: lap_mesh_counts
  interface
    ! How many elements a mesh has: vertices (those that triangles use), triangles (all that were given), edges,
    ! components (sets of triangles connected through edges), shells (sets of triangles connected through wedges of
    ! solid at their edges; two solids that share an edge are two shells).
    !
    ! Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if mesh is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_mesh_counts(mesh, vertices, triangles, edges, components, &
      shells) bind(c, name="lap_mesh_counts")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int64_t), intent(inout), optional :: vertices
      integer(c_int64_t), intent(inout), optional :: triangles
      integer(c_int64_t), intent(inout), optional :: edges
      integer(c_int64_t), intent(inout), optional :: components
      integer(c_int64_t), intent(inout), optional :: shells
    end function
  end interface

  public :: lap_mesh_bounds
  interface
    ! The bounding box of a mesh.
    !
    ! bounds: receives a pointer to 6 doubles, lowest x, y, z and highest x, y, z; borrowed until the mesh is freed.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
    integer(c_int32_t) function lap_mesh_bounds(mesh, bounds) bind(c, name="lap_mesh_bounds")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: mesh
      type(c_ptr), intent(inout), optional :: bounds
    end function
  end interface

  public :: lap_mesh_vertices
  interface
    ! The vertices of a mesh as it is held: those that triangles use, merged if asked for.
    !
    ! Outputs (each may be NULL; borrowed until the mesh is freed): count; xyz: 3 × count; sources: count indices of
    ! the vertices in the caller's array.
    !
    ! Errors: LAP_ERR_NULL_POINTER if mesh is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_mesh_vertices(mesh, count, xyz, sources) bind(c, name="lap_mesh_vertices")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: xyz
      type(c_ptr), intent(inout), optional :: sources
    end function
  end interface

  public :: lap_mesh_triangles
  interface
    ! The triangles of a mesh, in the caller's order.
    !
    ! Outputs (each may be NULL; borrowed until the mesh is freed): count; vertices: 3 × count positions in the array
    ! of lap_mesh_vertices; tags: count numbers as given, NULL if none were given.
    !
    ! Errors: LAP_ERR_NULL_POINTER if mesh is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_mesh_triangles(mesh, count, vertices, tags) bind(c, name="lap_mesh_triangles")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: tags
    end function
  end interface

  public :: lap_mesh_volume
  interface
    ! The volume of the solid, in cubed units of the input: the double nearest to the exact volume.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: an exact sum over the triangles at the first call, then none.
    integer(c_int32_t) function lap_mesh_volume(mesh, volume) bind(c, name="lap_mesh_volume")
      import :: c_double, c_int32_t, c_ptr
      type(c_ptr), value :: mesh
      real(c_double), intent(inout), optional :: volume
    end function
  end interface

  public :: lap_mesh_volume_exact
  interface
    ! The exact volume of the solid as a canonical string, "num/den" or "num" for an integer, in decimal.
    !
    ! volume: valid until the next call with this context. A GMP or CGAL rational reads it.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: an exact sum over the triangles at the
    ! first call, then none.
    integer(c_int32_t) function lap_mesh_volume_exact(context, mesh, volume) bind(c, name="lap_mesh_volume_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: mesh
      type(c_ptr), intent(inout), optional :: volume
    end function
  end interface

  public :: lap_mesh_euler
  interface
    ! The Euler characteristic of the solid, by the expression of lap_complex_euler: ball 1, ball with a void 2, solid
    ! torus 0, two tetrahedra sharing a vertex 1.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: linear at the first call, then none.
    integer(c_int32_t) function lap_mesh_euler(mesh, euler) bind(c, name="lap_mesh_euler")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: mesh
      integer(c_int64_t), intent(inout), optional :: euler
    end function
  end interface

  public :: lap_mesh_locate
  interface
    ! Where points are with respect to the solid, exactly. (For example: what is known about a node, for a rank that
    ! holds only a part of the mesh. See lap_grid_new_patch.)
    !
    ! Inputs (borrowed for the call): mesh; points: 3 × count finite coordinates. places: receives count numbers
    ! LAP_PLACE_*, valid until the next call with this context.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT with a message that names the first point that is not finite; LAP_ERR_NULL_POINTER,
    ! LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: n log n in the triangles at the first call, then
    ! logarithmic for each point, plus some tens of nanoseconds for each triangle whose bounding box a ray from the
    ! point towards +x meets.
    integer(c_int32_t) function lap_mesh_locate(context, mesh, count, points, places) bind(c, name="lap_mesh_locate")
      import :: c_double, c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: mesh
      integer(c_int64_t), value :: count
      real(c_double), intent(in), optional :: points(*)
      type(c_ptr), intent(inout), optional :: places
    end function
  end interface

  public :: lap_cut_options_init
  interface
    ! Fills cut options with the defaults.
    !
    ! struct_size: pass (int32_t)sizeof(lap_cut_options); no more than that is written, so a program compiled against an
    ! older header keeps working.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
    integer(c_int32_t) function lap_cut_options_init(options, struct_size) bind(c, name="lap_cut_options_init")
      import :: c_int32_t, lap_cut_options
      type(lap_cut_options), intent(inout), optional :: options
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_cut_new
  interface
    ! Cuts a solid along planes.
    !
    ! Inputs (borrowed for the call): mesh; planes: 4 × n_planes numbers, a, b, c, d for the plane a x + b y + c z + d
    ! = 0, each taken as the exact number that it is, in any position and of any length (coincident planes count once;
    ! n_planes may be 0); options: or NULL for the defaults. The positive side of a plane is where a x + b y + c z + d >
    ! 0. cut: receives the handle, NULL after an error or cancel; free it with lap_cut_free. It does not need the mesh
    ! handle or the context to stay alive.
    !
    ! Errors: LAP_ERR_BAD_PLANE with all defects found (not finite, zero normal), LAP_ERR_INCONSISTENT for input that
    ! intersects itself, LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT, LAP_ERR_TOO_LARGE, LAP_ERR_CANCELLED,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: grows with the size of the result and n log n of the input.
    integer(c_int32_t) function lap_cut_new(context, mesh, n_planes, planes, options, cut) bind(c, name="lap_cut_new")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_cut_options
      type(c_ptr), value :: context
      type(c_ptr), value :: mesh
      integer(c_int64_t), value :: n_planes
      real(c_double), intent(in), optional :: planes(*)
      type(lap_cut_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: cut
    end function
  end interface

  public :: lap_cut_free
  interface
    ! Frees a cut and all that was borrowed from it, its complex included. NULL is allowed and does nothing.
    !
    ! Errors: none.
    integer(c_int32_t) function lap_cut_free(cut) bind(c, name="lap_cut_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: cut
    end function
  end interface

  public :: lap_cut_complex
  interface
    ! The cells, faces, edges and vertices of a cut.
    !
    ! complex: borrowed until the cut is freed; do not free it.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
    integer(c_int32_t) function lap_cut_complex(cut, complex) bind(c, name="lap_cut_complex")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: cut
      type(c_ptr), intent(inout), optional :: complex
    end function
  end interface

  public :: lap_cut_plane_map
  interface
    ! Which planes coincide.
    !
    ! Outputs (each may be NULL; borrowed until the cut is freed): count: the number of planes given; map: for each, the
    ! lowest index of the planes that coincide with it (its own, if there is no lower one). The complex speaks of planes
    ! by these lowest indices only. Opposite orientation does not keep planes from coinciding.
    !
    ! Errors: LAP_ERR_NULL_POINTER if cut is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_cut_plane_map(cut, count, map) bind(c, name="lap_cut_plane_map")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: cut
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: map
    end function
  end interface

  public :: lap_cut_stage_count
  interface
    ! How many stages the cut ran through.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
    integer(c_int32_t) function lap_cut_stage_count(cut, count) bind(c, name="lap_cut_stage_count")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: cut
      integer(c_int32_t), intent(inout), optional :: count
    end function
  end interface

  public :: lap_cut_stage
  interface
    ! Stage i of the cut, from 0, in the order in which they ran: its name and its time in seconds.
    !
    ! Outputs (each may be NULL). name is borrowed until the cut is freed.
    !
    ! Errors: LAP_ERR_NULL_POINTER if cut is NULL, LAP_ERR_BAD_ARGUMENT if there is no such stage. Threads: any. Cost:
    ! none.
    integer(c_int32_t) function lap_cut_stage(cut, i, name, seconds) bind(c, name="lap_cut_stage")
      import :: c_double, c_int32_t, c_ptr
      type(c_ptr), value :: cut
      integer(c_int32_t), value :: i
      type(c_ptr), intent(inout), optional :: name
      real(c_double), intent(inout), optional :: seconds
    end function
  end interface

  public :: lap_cut_statistic_count
  interface
    ! How many statistics there are: two per predicate, "predicate.topological" and "predicate.numerical": how many
    ! decisions of this cut followed from topology alone, and how many were computed from numbers. All 0 unless the
    ! context counted (lap_context_counters_enable).
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
    integer(c_int32_t) function lap_cut_statistic_count(cut, count) bind(c, name="lap_cut_statistic_count")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: cut
      integer(c_int32_t), intent(inout), optional :: count
    end function
  end interface

  public :: lap_cut_statistic
  interface
    ! Statistic i, from 0: its name and its value.
    !
    ! Outputs (each may be NULL). name is borrowed until the cut is freed.
    !
    ! Errors: LAP_ERR_NULL_POINTER if cut is NULL, LAP_ERR_BAD_ARGUMENT if there is no such statistic. Threads: any.
    ! Cost: none.
    integer(c_int32_t) function lap_cut_statistic(cut, i, name, value) bind(c, name="lap_cut_statistic")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: cut
      integer(c_int32_t), value :: i
      type(c_ptr), intent(inout), optional :: name
      integer(c_int64_t), intent(inout), optional :: value
    end function
  end interface

  public :: lap_complex_counts
  interface
    ! How many elements a complex has. loops, corners: of all faces; shells: of all cells.
    !
    ! Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_complex_counts(complex, vertices, edges, faces, cells, loops, corners, &
      shells) bind(c, name="lap_complex_counts")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: vertices
      integer(c_int64_t), intent(inout), optional :: edges
      integer(c_int64_t), intent(inout), optional :: faces
      integer(c_int64_t), intent(inout), optional :: cells
      integer(c_int64_t), intent(inout), optional :: loops
      integer(c_int64_t), intent(inout), optional :: corners
      integer(c_int64_t), intent(inout), optional :: shells
    end function
  end interface

  public :: lap_complex_vertices
  interface
    ! The coordinates of the vertices: each the double nearest to the exact coordinate (ties to even, zero as +0), in
    ! the units of the input. Vertices of the input mesh come first.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count; xyz: 3 × count.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_complex_vertices(complex, count, xyz) bind(c, name="lap_complex_vertices")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: xyz
    end function
  end interface

  public :: lap_complex_vertex_origins
  interface
    ! What each vertex is, symbolically.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count; kinds: count numbers LAP_VERTEX_*; ids: 3 × count, as
    ! LAP_VERTEX_* says, in the caller's numbering, -1 where unused.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: linear at the first call, then none.
    integer(c_int32_t) function lap_complex_vertex_origins(complex, count, kinds, &
      ids) bind(c, name="lap_complex_vertex_origins")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: kinds
      type(c_ptr), intent(inout), optional :: ids
    end function
  end interface

  public :: lap_complex_vertex_planes
  interface
    ! All planes through each vertex, rising (of coincident planes the lowest).
    !
    ! Outputs (each may be NULL; borrowed as the complex): count: the number of vertices; offsets: count + 1; planes:
    ! those of vertex v are planes[offsets[v]] up to, not including, planes[offsets[v + 1]].
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_complex_vertex_planes(complex, count, offsets, &
      planes) bind(c, name="lap_complex_vertex_planes")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: planes
    end function
  end interface

  public :: lap_complex_edges
  interface
    ! The edges.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count; vertices: 2 × count.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_complex_edges(complex, count, vertices) bind(c, name="lap_complex_edges")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
    end function
  end interface

  public :: lap_complex_faces
  interface
    ! The faces with their holes. A face is a set of loops, the outer loop first, then holes; seen with the face's
    ! normal up, the outer loop runs anticlockwise and holes run clockwise. A loop is a cyclic run of corners. An edge
    ! with the face on both its sides is walked twice; an isolated vertex inside a face is a hole of one corner and no
    ! edge.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count: the number of faces; face_loops: count + 1, face f has
    ! the loops face_loops[f] up to, not including, face_loops[f + 1]; loop_corners: number of loops + 1, loop l has the
    ! corners loop_corners[l] up to, not including, loop_corners[l + 1]; corner_vertices: the vertex of each corner;
    ! corner_edges: the edge from each corner to the next of its loop (from the last to the first), -1 for an isolated
    ! vertex.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_complex_faces(complex, count, face_loops, loop_corners, corner_vertices, &
      corner_edges) bind(c, name="lap_complex_faces")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: face_loops
      type(c_ptr), intent(inout), optional :: loop_corners
      type(c_ptr), intent(inout), optional :: corner_vertices
      type(c_ptr), intent(inout), optional :: corner_edges
    end function
  end interface

  public :: lap_complex_face_supports
  interface
    ! What each face lies on. A face on both a triangle and a plane has the triangle as its support, and the plane as
    ! well; a face of a network's complex is a polygon of the network or lies on a triangle of its domain's boundary.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count; kinds: count numbers LAP_SUPPORT_*; ids: count indices
    ! of triangles, planes or polygons, in the caller's numbering; planes: for each face the lowest plane that it lies
    ! on, -1 if none; tags: for each face the tag of its triangle, 0 for faces on planes only and without tags. The
    ! normal of a face is that of its support: of the triangle, (a, b, c) of the plane, or the polygon's.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: linear at the first call, then none.
    integer(c_int32_t) function lap_complex_face_supports(complex, count, kinds, ids, planes, &
      tags) bind(c, name="lap_complex_face_supports")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: kinds
      type(c_ptr), intent(inout), optional :: ids
      type(c_ptr), intent(inout), optional :: planes
      type(c_ptr), intent(inout), optional :: tags
    end function
  end interface

  public :: lap_complex_face_cells
  interface
    ! The cells on the two sides of each face.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count: the number of faces; cells: 2 × count, the owner
    ! (behind the face, on the side that its normal points away from), and the neighbour (before it), -1 outside the
    ! solid (in the complex of an arrangement that may be either).
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_complex_face_cells(complex, count, cells) bind(c, name="lap_complex_face_cells")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_complex_cells
  interface
    ! The cells. A cell is bounded by shells, the outer shell first, then voids; a shell is a closed set of half-faces.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count: the number of cells; cell_shells: count + 1, cell c
    ! has the shells cell_shells[c] up to, not including, cell_shells[c + 1]; shell_faces: number of shells + 1, shell s
    ! has the half-faces half_faces[shell_faces[s]] up to, not including, half_faces[shell_faces[s + 1]]; half_faces: 2
    ! f + side, side 0 where the normal of face f points out of the cell, 1 where it points into it; rising in each
    ! shell.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_complex_cells(complex, count, cell_shells, shell_faces, &
      half_faces) bind(c, name="lap_complex_cells")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: cell_shells
      type(c_ptr), intent(inout), optional :: shell_faces
      type(c_ptr), intent(inout), optional :: half_faces
    end function
  end interface

  public :: lap_complex_cell_components
  interface
    ! The component of the input mesh (0 up to lap_mesh_counts' components) that each cell belongs to: that of the
    ! surface which encloses it. In the complex of an arrangement cells that are joined across faces have one number,
    ! from 0.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count: the number of cells; components: count.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_complex_cell_components(complex, count, &
      components) bind(c, name="lap_complex_cell_components")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: components
    end function
  end interface

  public :: lap_complex_cell_side
  interface
    ! The side of a plane that a cell is on: side receives 1 where a x + b y + c z + d > 0, -1 where it is < 0.
    !
    ! cell: from 0; plane: index in the caller's array (any of coincident planes).
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a cell or plane that is not there, or for the complex of an
    ! arrangement (planes cut only what is within the bounds of half-spaces, and winding numbers tell where cells are).
    ! Threads: any. Cost: one exact sign, and a walk over those vertices of the cell that lie on the plane.
    integer(c_int32_t) function lap_complex_cell_side(complex, cell, plane, side) bind(c, name="lap_complex_cell_side")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int32_t), value :: cell
      integer(c_int32_t), value :: plane
      integer(c_int32_t), intent(inout), optional :: side
    end function
  end interface

  public :: lap_complex_cell_moments
  interface
    ! The moments of the cells: volume and centroid, in powers of the units of the input.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count: the number of cells; volumes: count; centroids: 3 ×
    ! count; flags: count, nonzero where a moment is beyond the range of double (it is then infinite, or 0). Every
    ! number is the double nearest to the exact one.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INTERNAL. Threads: any. Cost: one walk over all faces at
    ! the first call, then none.
    integer(c_int32_t) function lap_complex_cell_moments(complex, count, volumes, centroids, &
      flags) bind(c, name="lap_complex_cell_moments")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: volumes
      type(c_ptr), intent(inout), optional :: centroids
      type(c_ptr), intent(inout), optional :: flags
    end function
  end interface

  public :: lap_complex_face_moments
  interface
    ! The moments of the faces: area vector (along the face's normal, its length the area) and centroid.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count: the number of faces; area_vectors: 3 × count;
    ! centroids: 3 × count; flags: count, nonzero where a moment is beyond the range of double (it is then infinite, or
    ! 0). Every number is the double nearest to the exact one.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INTERNAL. Threads: any. Cost: one walk over all faces at
    ! the first call, then none.
    integer(c_int32_t) function lap_complex_face_moments(complex, count, area_vectors, centroids, &
      flags) bind(c, name="lap_complex_face_moments")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: area_vectors
      type(c_ptr), intent(inout), optional :: centroids
      type(c_ptr), intent(inout), optional :: flags
    end function
  end interface

  public :: lap_complex_polygons
  interface
    ! The faces as plain polygons, without new vertices.
    !
    ! style: LAP_FACES_HOLES, LAP_FACES_BRIDGED or LAP_FACES_TRIANGLES. Outputs (each may be NULL; borrowed as the
    ! complex): count: the number of polygons; offsets: count + 1; vertices: those of polygon i are vertices[offsets[i]]
    ! up to, not including, vertices[offsets[i + 1]]; faces: for each polygon the face that it is a part of, never
    ! falling. Polygons run anticlockwise seen with the face's normal up (holes clockwise).
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_BAD_ARGUMENT for an unknown style, LAP_ERR_INTERNAL.
    ! Threads: any. Cost: n log n in the size of each face at the first call for a style, then none.
    integer(c_int32_t) function lap_complex_polygons(complex, style, count, offsets, vertices, &
      faces) bind(c, name="lap_complex_polygons")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int32_t), value :: style
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: faces
    end function
  end interface

  public :: lap_complex_adjacency
  interface
    ! What follows across each edge on the surface of the same cell: adjacent(half-face, edge).
    !
    ! The half-corner 2 c + s is side s of the face of corner c, along the edge from corner c to the next of its loop.
    ! Its mate is the half-corner that meets it at that edge inside the same cell.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count: the number of corners, as in lap_complex_faces; mates:
    ! 2 × count: mates[2 c + s] is the mate of half-corner 2 c + s, -1 outside the solid and for an isolated vertex;
    ! faces: count: the face of each corner. So the half-face across is 2 faces[m / 2] + m % 2 for a mate m.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INCONSISTENT if half-faces do not pair up (input that
    ! intersects itself). Threads: any. Cost: linear, and radial orders around edges that a cell meets more than once,
    ! at the first call; then none.
    integer(c_int32_t) function lap_complex_adjacency(complex, count, mates, &
      faces) bind(c, name="lap_complex_adjacency")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: mates
      type(c_ptr), intent(inout), optional :: faces
    end function
  end interface

  public :: lap_complex_euler
  interface
    ! The Euler characteristic of the complex and of the solid that it was made from; a correct complex has both equal.
    ! Vertices - edges + sum over faces of (1 - holes) - sum over cells of half the Euler characteristics of their
    ! shells (a vertex counts once per umbrella; where the tip of a void or of a dent touches a plane, the shells there
    ! count as joined by a tube). Of a network's complex they may differ where shells of one region touch in a point.
    !
    ! Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_INCONSISTENT if half-faces do
    ! not pair up (input that intersects itself). Threads: any. Cost: linear at the first call, then none.
    integer(c_int32_t) function lap_complex_euler(complex, output, input) bind(c, name="lap_complex_euler")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: output
      integer(c_int64_t), intent(inout), optional :: input
    end function
  end interface

  public :: lap_complex_check
  interface
    ! Checks that a complex is consistent: indices in range, loops and shells closed, each face owned by one or two
    ! cells, Euler characteristics equal.
    !
    ! Errors: LAP_ERR_INCONSISTENT with a message that names the element; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: linear.
    integer(c_int32_t) function lap_complex_check(context, complex) bind(c, name="lap_complex_check")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: complex
    end function
  end interface

  public :: lap_complex_vertex_exact
  interface
    ! The exact coordinates of a vertex as canonical strings, "num/den" or "num" for an integer, in decimal. A GMP or
    ! CGAL rational reads them.
    !
    ! Outputs (each may be NULL): x, y, z: valid until the next call with this context.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a vertex that is not there, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: some microseconds.
    integer(c_int32_t) function lap_complex_vertex_exact(context, complex, vertex, x, y, &
      z) bind(c, name="lap_complex_vertex_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: complex
      integer(c_int32_t), value :: vertex
      type(c_ptr), intent(inout), optional :: x
      type(c_ptr), intent(inout), optional :: y
      type(c_ptr), intent(inout), optional :: z
    end function
  end interface

  public :: lap_complex_cell_volume_exact
  interface
    ! The exact volume of a cell as a canonical string, "num/den" or "num" for an integer, in decimal.
    !
    ! volume: valid until the next call with this context.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a cell that is not there, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: an exact sum over the cell's faces; the string grows with the number of planes that bound the
    ! cell.
    integer(c_int32_t) function lap_complex_cell_volume_exact(context, complex, cell, &
      volume) bind(c, name="lap_complex_cell_volume_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: complex
      integer(c_int32_t), value :: cell
      type(c_ptr), intent(inout), optional :: volume
    end function
  end interface

  public :: lap_mesh_set_triangle_ids
  interface
    ! Gives the triangles of a mesh global ids, for keys: of results that are made from it afterwards. Without, the id
    ! of a triangle is its index.
    !
    ! Inputs (borrowed for the call): ids: n_triangles numbers, one per triangle that the mesh was made of, in that
    ! order, each from 0 up to, not including, 2^40, no two equal. Two meshes that hold parts of one surface give a
    ! triangle the same id, and list its corners in the same order. No other call may use the mesh meanwhile.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for another number of ids, an id out of range, or two that are
    ! equal; LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear if the ids rise, else n log n.
    integer(c_int32_t) function lap_mesh_set_triangle_ids(context, mesh, n_triangles, &
      ids) bind(c, name="lap_mesh_set_triangle_ids")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: mesh
      integer(c_int64_t), value :: n_triangles
      integer(c_int64_t), intent(in), optional :: ids(*)
    end function
  end interface

  public :: lap_cut_set_plane_ids
  interface
    ! Gives the planes of a cut global ids, for keys. Without, the id of a plane is its index.
    !
    ! Inputs (borrowed for the call): ids: n_planes numbers, one per plane that was given to lap_cut_new, in that order,
    ! each from 0 up to, not including, 2^40, no two equal. Of coincident planes the smallest id stands for all. Only
    ! before the first call of lap_complex_vertex_keys or lap_complex_face_keys; no other call may use the cut
    ! meanwhile.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for another number of ids, an id out of range, two that are
    ! equal, or if there are keys already; LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear if the
    ! ids rise, else n log n.
    integer(c_int32_t) function lap_cut_set_plane_ids(context, cut, n_planes, &
      ids) bind(c, name="lap_cut_set_plane_ids")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: cut
      integer(c_int64_t), value :: n_planes
      integer(c_int64_t), intent(in), optional :: ids(*)
    end function
  end interface

  public :: lap_complex_vertex_keys
  interface
    ! The keys of the vertices: 128 bits each, made from global ids of triangles and planes alone
    ! (lap_mesh_set_triangle_ids, lap_cut_set_plane_ids). No two vertices have the same key, and no vertex has that of a
    ! face. Two complexes cut from parts of the same mesh by some of the same planes give a vertex that they share the
    ! same key, if both know all triangles that contain it: a block that is given every triangle which meets its closed
    ! box, and the planes that bound it, does. (Arrangements promise less: a point where more triangles meet than are
    ! needed to name it goes by those among which it was found first.)
    !
    ! Outputs (each may be NULL; borrowed as the complex): count; keys: 2 × count, the first number of a pair never
    ! negative. What the numbers are: the 7 high bits of the first are the kind of the point, then follow three numbers
    ! of 40 bits, as for lap_complex_vertex_origins; elements of the mesh go by the smallest id of the triangles that
    ! contain them. Kinds: 0, 1, 2: corner 0, 1, 2 of a triangle; 3, 4, 5: on the side from corner 0, 1, 2 of a triangle
    ! to the next, and the smallest plane that crosses it there; 6: inside a triangle, on two planes; 7: on three
    ! planes.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_BAD_ARGUMENT for that of a network,
    ! LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first call, then none.
    integer(c_int32_t) function lap_complex_vertex_keys(complex, count, keys) bind(c, name="lap_complex_vertex_keys")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: keys
    end function
  end interface

  public :: lap_complex_face_keys
  interface
    ! The keys of the faces, as lap_complex_vertex_keys: no two faces have the same key, and a face that two complexes
    ! share has the same key in both. A key names one edge of the face's boundary with its direction, and so the face on
    ! its left.
    !
    ! In complexes of arrangements (lap_arrangement_complex, lap_surface_complex) triangles are named by their places
    ! among those of all operands, one behind the other (a half-space counts thirteen), and half-spaces by theirs among
    ! half-spaces. Faces with the same boundary have the same key in all complexes of one arrangement and of
    ! arrangements of the same operands in the same order. Operands that are added behind the others change the keys of
    ! those faces only that they cut or touch.
    !
    ! Outputs (each may be NULL; borrowed as the complex): count; keys: 2 × count, the first number of a pair never
    ! negative.
    !
    ! Errors: LAP_ERR_NULL_POINTER if complex is NULL, LAP_ERR_BAD_ARGUMENT for that of a network, LAP_ERR_INCONSISTENT
    ! for input to a cut that intersects itself, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first call,
    ! then none.
    integer(c_int32_t) function lap_complex_face_keys(complex, count, keys) bind(c, name="lap_complex_face_keys")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: complex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: keys
    end function
  end interface

  public :: lap_certify_options_init
  interface
    ! Fills options of lap_certified_new with the defaults.
    !
    ! struct_size: pass (int32_t)sizeof(lap_certify_options); no more than that is written.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
    integer(c_int32_t) function lap_certify_options_init(options, struct_size) bind(c, name="lap_certify_options_init")
      import :: c_int32_t, lap_certify_options
      type(lap_certify_options), intent(inout), optional :: options
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_certified_new
  interface
    ! Triangulates a complex without new vertices, checks the triangles exactly over the correctly rounded coordinates,
    ! and repairs what rounding broke.
    !
    ! Repairs are tried in this order, each around a defect only, and kept if they help: vertices at one place are
    ! merged, and cells without volume go with them; diagonals of faces are flipped; vertices made by planes are moved
    ! by few units, first across the faces and along the lines whose order they break; vertices a few units apart are
    ! merged. Vertices of the input mesh are moved, and vertices that no edge joins merged, only where all of that
    ! failed. So the report is to be read: a result may be uncertified, and says so.
    !
    ! Inputs (borrowed for the call): complex; fixed_planes: n_fixed_planes indices of planes, as the complex uses them
    ! (of coincident planes the lowest): vertices on these planes, block boundaries say, stay where they are;
    ! fixed_vertices: n_fixed_vertices indices of further vertices that do; options: or NULL for the defaults. Others
    ! may be merged into a vertex that stays. certified: receives the handle, NULL after an error or cancel; free it
    ! with lap_certified_free. It does not need the complex to stay alive.
    !
    ! Errors: LAP_ERR_INCONSISTENT if a face contradicts itself (input that intersects itself), LAP_ERR_NULL_POINTER,
    ! LAP_ERR_BAD_ARGUMENT (an index out of range included), LAP_ERR_TOO_LARGE, LAP_ERR_CANCELLED,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. That something remains uncertified is no error. Cost: n log n of the
    ! triangles, mostly for those with a vertex made by planes; about a millisecond for each place that has to be
    ! repaired.
    integer(c_int32_t) function lap_certified_new(context, complex, n_fixed_planes, fixed_planes, n_fixed_vertices, &
      fixed_vertices, options, certified) bind(c, name="lap_certified_new")
      import :: c_int32_t, c_int64_t, c_ptr, lap_certify_options
      type(c_ptr), value :: context
      type(c_ptr), value :: complex
      integer(c_int64_t), value :: n_fixed_planes
      integer(c_int32_t), intent(in), optional :: fixed_planes(*)
      integer(c_int64_t), value :: n_fixed_vertices
      integer(c_int32_t), intent(in), optional :: fixed_vertices(*)
      type(lap_certify_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: certified
    end function
  end interface

  public :: lap_certified_free
  interface
    ! Frees what was certified and all that was borrowed from it. NULL is allowed and does nothing.
    !
    ! Errors: none.
    integer(c_int32_t) function lap_certified_free(certified) bind(c, name="lap_certified_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: certified
    end function
  end interface

  public :: lap_certified_counts
  interface
    ! How many elements are left.
    !
    ! Outputs: each may be NULL.
    !
    ! Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_certified_counts(certified, vertices, triangles, faces, &
      cells) bind(c, name="lap_certified_counts")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: certified
      integer(c_int64_t), intent(inout), optional :: vertices
      integer(c_int64_t), intent(inout), optional :: triangles
      integer(c_int64_t), intent(inout), optional :: faces
      integer(c_int64_t), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_certified_vertices
  interface
    ! The vertices.
    !
    ! Outputs (each may be NULL; borrowed as the handle): count; xyz: 3 × count coordinates.
    !
    ! Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_certified_vertices(certified, count, xyz) bind(c, name="lap_certified_vertices")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: certified
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: xyz
    end function
  end interface

  public :: lap_certified_triangles
  interface
    ! The triangles, by faces.
    !
    ! Outputs (each may be NULL; borrowed as the handle): count; vertices: 3 × count, anticlockwise seen with the
    ! face's normal up; cells: 2 × count, the cell behind each triangle and the cell before it (-1: outside), as
    ! lap_complex_face_cells has them for faces; face_count; face_triangles: face_count + 1: face f has the triangles
    ! face_triangles[f] up to, not including, face_triangles[f + 1]. Where a cell between two faces went, in whole or in
    ! part, triangles of both are one: it is in the face with the lower number, between the cells that are left.
    !
    ! Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_certified_triangles(certified, count, vertices, cells, face_count, &
      face_triangles) bind(c, name="lap_certified_triangles")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: certified
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: cells
      integer(c_int64_t), intent(inout), optional :: face_count
      type(c_ptr), intent(inout), optional :: face_triangles
    end function
  end interface

  public :: lap_certified_maps
  interface
    ! From the complex's vertices, faces and cells to those here.
    !
    ! Outputs (each may be NULL; borrowed as the handle): n_vertices, n_faces, n_cells: the numbers of the complex;
    ! vertices, faces, cells: for each the index here, -1 for one that is gone. A vertex that was merged has the index
    ! of the one that stands for it.
    !
    ! Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_certified_maps(certified, n_vertices, vertices, n_faces, faces, n_cells, &
      cells) bind(c, name="lap_certified_maps")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: certified
      integer(c_int64_t), intent(inout), optional :: n_vertices
      type(c_ptr), intent(inout), optional :: vertices
      integer(c_int64_t), intent(inout), optional :: n_faces
      type(c_ptr), intent(inout), optional :: faces
      integer(c_int64_t), intent(inout), optional :: n_cells
      type(c_ptr), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_certified_report
  interface
    ! The report.
    !
    ! report: written; struct_size: pass (int32_t)sizeof(lap_certify_report); no more than that is written.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096. Threads: any.
    ! Cost: none.
    integer(c_int32_t) function lap_certified_report(certified, report, &
      struct_size) bind(c, name="lap_certified_report")
      import :: c_int32_t, c_ptr, lap_certify_report
      type(c_ptr), value :: certified
      type(lap_certify_report), intent(inout), optional :: report
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_certified_open
  interface
    ! What remains uncertified, in numbers of the complex (not of this handle).
    !
    ! Outputs (each may be NULL; borrowed as the handle): n_pairs; pairs: 2 × n_pairs faces whose triangles meet, the
    ! lower first; twice the same face for one that meets itself or has a triangle without area; n_cells; cells: those
    ! with a volume, or a void, of the wrong sign (asked only if there are no pairs). All are empty for a certified
    ! result.
    !
    ! Errors: LAP_ERR_NULL_POINTER if certified is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_certified_open(certified, n_pairs, pairs, n_cells, &
      cells) bind(c, name="lap_certified_open")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: certified
      integer(c_int64_t), intent(inout), optional :: n_pairs
      type(c_ptr), intent(inout), optional :: pairs
      integer(c_int64_t), intent(inout), optional :: n_cells
      type(c_ptr), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_grid_options_init
  interface
    ! Fills grid options with the defaults.
    !
    ! struct_size: pass (int32_t)sizeof(lap_grid_options); no more than that is written, so a program compiled against
    ! an older header keeps working.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
    integer(c_int32_t) function lap_grid_options_init(options, struct_size) bind(c, name="lap_grid_options_init")
      import :: c_int32_t, lap_grid_options
      type(lap_grid_options), intent(inout), optional :: options
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_grid_new
  interface
    ! Cuts a block of a rectilinear grid along the surface of a solid.
    !
    ! Inputs (borrowed for the call): mesh; x, y, z: the n_x, n_y, n_z coordinates of the whole grid's nodes along each
    ! axis, strictly rising, at least two, each taken as the exact number that it is: they alone say where the grid's
    ! planes are, and ranks that pass the same numbers get the same planes; options: or NULL for the defaults (the whole
    ! grid, fluid inside the solid). Grid planes may pass through vertices and edges of the mesh, and triangles may lie
    ! in them. grid: receives the handle, NULL after an error or cancel; free it with lap_grid_free. It does not need
    ! the mesh handle or the context to stay alive.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT with a message that names the node for coordinates that are not finite or do not
    ! rise, for a block that is empty or outside the grid, and for a known node outside the block; LAP_ERR_INCONSISTENT
    ! for input that intersects itself; LAP_ERR_TOO_LARGE if the block has 2147483647 nodes or more or the result more
    ! elements than 32-bit indices can number; LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: a byte per box, else it grows with the number of cut boxes and of triangles.
    integer(c_int32_t) function lap_grid_new(context, mesh, n_x, x, n_y, y, n_z, z, options, &
      grid) bind(c, name="lap_grid_new")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_grid_options
      type(c_ptr), value :: context
      type(c_ptr), value :: mesh
      integer(c_int64_t), value :: n_x
      real(c_double), intent(in), optional :: x(*)
      integer(c_int64_t), value :: n_y
      real(c_double), intent(in), optional :: y(*)
      integer(c_int64_t), value :: n_z
      real(c_double), intent(in), optional :: z(*)
      type(lap_grid_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: grid
    end function
  end interface

  public :: lap_grid_new_patch
  interface
    ! Cuts a block of a rectilinear grid along the part of a surface that is in it: for a rank that does not hold the
    ! whole mesh.
    !
    ! Inputs (borrowed for the call): xyz, indices, tags: as for lap_mesh_new, of some triangles of a mesh, among them
    ! all that meet the closed box of the block (it suffices that their bounding boxes do; more do not harm; there may
    ! be none); triangle_ids: n_triangles ids, each from 0 up to, not including, 2^40, no two equal: the triangles'
    ! places in the whole mesh, of which keys are made; or NULL, then they are their places here; n_x to z: the whole
    ! grid's nodes, as for lap_grid_new; options: with the block, and one node of it that is known to be in the fluid or
    ! not (lap_mesh_locate tells, where the whole mesh is). Blocks that share a face, cut from parts of one mesh with
    ! the same vertex order in each triangle, give it the same key and its vertices the same coordinates, bit for bit.
    ! grid: receives the handle, NULL after an error or cancel; free it with lap_grid_free.
    !
    ! Errors: LAP_ERR_BAD_MESH as for lap_mesh_new, except that edges may be open where they do not meet the closed box
    ! of the block, and nesting is not checked: the ids of an open edge's defect are those of this call's arrays, and it
    ! means that a triangle is missing; LAP_ERR_BAD_ARGUMENT as for lap_grid_new, if no node is known, and for ids that
    ! are out of range or equal; others as for lap_grid_new. Cost: as lap_grid_new, and n log n in the vertices.
    integer(c_int32_t) function lap_grid_new_patch(context, n_vertices, xyz, n_triangles, indices, tags, triangle_ids, &
      n_x, x, n_y, y, n_z, z, options, grid) bind(c, name="lap_grid_new_patch")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_grid_options
      type(c_ptr), value :: context
      integer(c_int64_t), value :: n_vertices
      real(c_double), intent(in), optional :: xyz(*)
      integer(c_int64_t), value :: n_triangles
      integer(c_int32_t), intent(in), optional :: indices(*)
      integer(c_int32_t), intent(in), optional :: tags(*)
      integer(c_int64_t), intent(in), optional :: triangle_ids(*)
      integer(c_int64_t), value :: n_x
      real(c_double), intent(in), optional :: x(*)
      integer(c_int64_t), value :: n_y
      real(c_double), intent(in), optional :: y(*)
      integer(c_int64_t), value :: n_z
      real(c_double), intent(in), optional :: z(*)
      type(lap_grid_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: grid
    end function
  end interface

  public :: lap_grid_free
  interface
    ! Frees a grid and all that was borrowed from it, its complex included. NULL is allowed and does nothing.
    !
    ! Errors: none.
    integer(c_int32_t) function lap_grid_free(grid) bind(c, name="lap_grid_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: grid
    end function
  end interface

  public :: lap_grid_complex
  interface
    ! The cut cells as an ordinary complex, on which all functions for lap_complex work. Its cells and its faces are
    ! numbered as here, and so are its vertices; its planes are the block's grid planes, those across x first, then y,
    ! then z, each by rising coordinate, with the equation x - node = 0. Its triangles are those of the mesh; where the
    ! fluid is outside they are reversed. A face towards a full box or on the boundary of the block has a cell on one
    ! side only, which may be the front. The volume and the Euler characteristic are those of the cut cells, not of the
    ! solid.
    !
    ! complex: borrowed until the grid is freed; do not free it.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE, LAP_ERR_INCONSISTENT. Threads: any. Cost: linear in the cut cells
    ! and about as much memory again, at the first call, then none.
    integer(c_int32_t) function lap_grid_complex(grid, complex) bind(c, name="lap_grid_complex")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: grid
      type(c_ptr), intent(inout), optional :: complex
    end function
  end interface

  public :: lap_grid_check
  interface
    ! Checks that a cut grid is consistent: indices in range, loops closed, faces between the cells that name them,
    ! cells closed.
    !
    ! Errors: LAP_ERR_INCONSISTENT with a message that names the element; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: linear in the cut cells, and a pass over the flags.
    integer(c_int32_t) function lap_grid_check(context, grid) bind(c, name="lap_grid_check")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: grid
    end function
  end interface

  public :: lap_grid_stage_count
  interface
    ! How many stages the making of the grid ran through.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
    integer(c_int32_t) function lap_grid_stage_count(grid, count) bind(c, name="lap_grid_stage_count")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int32_t), intent(inout), optional :: count
    end function
  end interface

  public :: lap_grid_stage
  interface
    ! Stage i, from 0, in the order in which they ran: its name and its time in seconds.
    !
    ! Outputs (each may be NULL). name is borrowed until the grid is freed.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_BAD_ARGUMENT if there is no such stage. Threads: any. Cost:
    ! none.
    integer(c_int32_t) function lap_grid_stage(grid, i, name, seconds) bind(c, name="lap_grid_stage")
      import :: c_double, c_int32_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int32_t), value :: i
      type(c_ptr), intent(inout), optional :: name
      real(c_double), intent(inout), optional :: seconds
    end function
  end interface

  public :: lap_grid_block
  interface
    ! The block and the whole grid.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): boxes: 3 numbers, the boxes of the block along x, y,
    ! z; first: 3 numbers, the indices of the block's first box in the whole grid; total: 3 numbers, the boxes of the
    ! whole grid; x, y, z: boxes[0] + 1, boxes[1] + 1, boxes[2] + 1 coordinates of the block's nodes, as given (-0 as
    ! 0).
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_grid_block(grid, boxes, first, total, x, y, z) bind(c, name="lap_grid_block")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: grid
      type(c_ptr), intent(inout), optional :: boxes
      type(c_ptr), intent(inout), optional :: first
      type(c_ptr), intent(inout), optional :: total
      type(c_ptr), intent(inout), optional :: x
      type(c_ptr), intent(inout), optional :: y
      type(c_ptr), intent(inout), optional :: z
    end function
  end interface

  public :: lap_grid_counts
  interface
    ! How many boxes there are of each kind, and how many elements the cut boxes have: cells; faces, of which the first
    ! so many are walls; vertices.
    !
    ! Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: one pass over the
    ! flags at the first call, then none.
    integer(c_int32_t) function lap_grid_counts(grid, empty, full, cut, cells, faces, walls, &
      vertices) bind(c, name="lap_grid_counts")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: empty
      integer(c_int64_t), intent(inout), optional :: full
      integer(c_int64_t), intent(inout), optional :: cut
      integer(c_int64_t), intent(inout), optional :: cells
      integer(c_int64_t), intent(inout), optional :: faces
      integer(c_int64_t), intent(inout), optional :: walls
      integer(c_int64_t), intent(inout), optional :: vertices
    end function
  end interface

  public :: lap_grid_flags
  interface
    ! What each box is: LAP_BOX_EMPTY, LAP_BOX_FULL or LAP_BOX_CUT.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of boxes of the block; flags:
    ! count, box (i, j, k) at i + nx (j + ny k).
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_grid_flags(grid, count, flags) bind(c, name="lap_grid_flags")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: flags
    end function
  end interface

  public :: lap_grid_cut_boxes
  interface
    ! The boxes that are cut, and their cells.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut boxes; boxes: count numbers
    ! of boxes, rising; box_cells: count + 1: box boxes[i] has the cells box_cells[i] up to, not including, box_cells[i
    ! + 1].
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_grid_cut_boxes(grid, count, boxes, box_cells) bind(c, name="lap_grid_cut_boxes")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: boxes
      type(c_ptr), intent(inout), optional :: box_cells
    end function
  end interface

  public :: lap_grid_box_cells
  interface
    ! From every box to its cells, for those who have the memory: as lap_grid_cut_boxes, but for all boxes.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of boxes; offsets: count + 1: box
    ! b has the cells offsets[b] up to, not including, offsets[b + 1]; none unless it is cut.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: 4 bytes per box and a pass over them at the
    ! first call, then none.
    integer(c_int32_t) function lap_grid_box_cells(grid, count, offsets) bind(c, name="lap_grid_box_cells")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
    end function
  end interface

  public :: lap_grid_box
  interface
    ! One box of the block: what it is, and its cells.
    !
    ! i, j, k: the box, from the block's low corner. Outputs (each may be NULL): flag: LAP_BOX_*; first: its first cell,
    ! 0 unless it is cut; count: the number of its cells, 0 unless it is cut.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_BAD_ARGUMENT for a box outside the block. Threads: any.
    ! Cost: a binary search.
    integer(c_int32_t) function lap_grid_box(grid, i, j, k, flag, first, count) bind(c, name="lap_grid_box")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int32_t), value :: i
      integer(c_int32_t), value :: j
      integer(c_int32_t), value :: k
      integer(c_int32_t), intent(inout), optional :: flag
      integer(c_int32_t), intent(inout), optional :: first
      integer(c_int32_t), intent(inout), optional :: count
    end function
  end interface

  public :: lap_grid_vertices
  interface
    ! The vertices of the cut cells: each coordinate the double nearest to the exact one (ties to even, zero as +0), in
    ! the units of the input. A coordinate on a grid plane is the node's, bit for bit.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count; xyz: 3 × count; on_planes: count numbers,
    ! bit a (1, 2, 4) set where the vertex lies on a grid plane across axis a (x, y, z), exactly.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_grid_vertices(grid, count, xyz, on_planes) bind(c, name="lap_grid_vertices")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: xyz
      type(c_ptr), intent(inout), optional :: on_planes
    end function
  end interface

  public :: lap_grid_faces
  interface
    ! The faces of the cut cells, with their holes: walls first, then faces in grid planes. A face is a set of loops,
    ! the outer loop first, then holes; seen with the face's normal up, the outer loop runs anticlockwise and holes run
    ! clockwise. A loop is a cyclic run of corners; an isolated vertex inside a face is a hole of one corner. A wall has
    ! one loop. Two blocks that share a face may start its loops at different corners.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of faces; face_loops: count + 1,
    ! face f has the loops face_loops[f] up to, not including, face_loops[f + 1]; loop_corners: number of loops + 1,
    ! loop l has the corners loop_corners[l] up to, not including, loop_corners[l + 1]; corner_vertices: the vertex of
    ! each corner.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_grid_faces(grid, count, face_loops, loop_corners, &
      corner_vertices) bind(c, name="lap_grid_faces")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: face_loops
      type(c_ptr), intent(inout), optional :: loop_corners
      type(c_ptr), intent(inout), optional :: corner_vertices
    end function
  end interface

  public :: lap_grid_walls
  interface
    ! The walls: faces 0 up to count. Each is the part of a triangle of the mesh inside one box.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of walls; triangles: count: the
    ! triangle that each lies on, by its place in the caller's array or, where triangle ids were given, by its id; never
    ! falling in the order of places; tags: count: the tag of that triangle, NULL if the mesh has none; cells: count:
    ! the cell that the wall bounds.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the walls at
    ! the first call that asks for triangles or tags, then none.
    integer(c_int32_t) function lap_grid_walls(grid, count, triangles, tags, cells) bind(c, name="lap_grid_walls")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: triangles
      type(c_ptr), intent(inout), optional :: tags
      type(c_ptr), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_grid_plane_faces
  interface
    ! The faces in grid planes that bound cut cells: all after the walls. Face first + i is square i's, or a part of it.
    ! Squares between full boxes, or between a full box and the boundary of the block, are not among them
    ! (lap_grid_full_faces).
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): first: the number of walls, hence the first face;
    ! count: the number of faces in grid planes; axes: 4 faces: those across axis a (0: x, 1: y, 2: z) are axes[a] up
    ! to, not including, axes[a + 1], by rising plane; nodes: count: the number of the lowest node of the square of the
    ! grid that holds the face; cells: 2 × count: the cell on the lower side and the one on the upper side,
    ! LAP_CELL_FULL for that of a full box, LAP_CELL_NONE at the block's boundary. Never NONE on both sides. The square
    ! of node (i, j, k) across x lies between the boxes (i - 1, j, k) and (i, j, k), and so on; the normals point along
    ! the axis.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_grid_plane_faces(grid, first, count, axes, nodes, &
      cells) bind(c, name="lap_grid_plane_faces")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: first
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: axes
      type(c_ptr), intent(inout), optional :: nodes
      type(c_ptr), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_grid_cells
  interface
    ! The cut cells. A cell is bounded by shells, the outer shell first, then voids; a shell is a closed set of
    ! half-faces.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cells; boxes: count: the number
    ! of the box that holds the cell, never falling; cell_shells: count + 1, cell c has the shells cell_shells[c] up to,
    ! not including, cell_shells[c + 1]; shell_faces: number of shells + 1, shell s has the half-faces
    ! half_faces[shell_faces[s]] up to, not including, half_faces[shell_faces[s + 1]]; half_faces: 2 f + side, side 0
    ! where the normal of face f points out of the cell, 1 where it points into it; rising in each shell.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the cells at
    ! the first call that asks for boxes, then none.
    integer(c_int32_t) function lap_grid_cells(grid, count, boxes, cell_shells, shell_faces, &
      half_faces) bind(c, name="lap_grid_cells")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: boxes
      type(c_ptr), intent(inout), optional :: cell_shells
      type(c_ptr), intent(inout), optional :: shell_faces
      type(c_ptr), intent(inout), optional :: half_faces
    end function
  end interface

  public :: lap_grid_vertex_keys
  interface
    ! The keys of the vertices, as lap_complex_vertex_keys makes them: from the ids of triangles and the places of
    ! planes in the whole grid, so that blocks which share a vertex give it the same key.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count; keys: 2 × count, the first number of a pair
    ! never negative. Plane i across x has the number i, i counted in the whole grid; those across y follow, then those
    ! across z.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_INCONSISTENT for input that intersects itself,
    ! LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: some hundred nanoseconds per vertex and face at the first call of this
    ! or lap_grid_face_keys, then none.
    integer(c_int32_t) function lap_grid_vertex_keys(grid, count, keys) bind(c, name="lap_grid_vertex_keys")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: keys
    end function
  end interface

  public :: lap_grid_face_keys
  interface
    ! The keys of the faces, walls first, as lap_complex_face_keys makes them: the face that two blocks share has the
    ! same key in both, and no other face has.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count; keys: 2 × count, the first number of a pair
    ! never negative.
    !
    ! Errors: as lap_grid_vertex_keys, and so are threads and cost.
    integer(c_int32_t) function lap_grid_face_keys(grid, count, keys) bind(c, name="lap_grid_face_keys")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: keys
    end function
  end interface

  public :: lap_grid_cell_moments
  interface
    ! Volumes of the cut cells.
    !
    ! Conventions of all these arrays: lengths, areas and volumes are in powers of the input's unit; fractions are
    ! relative to the whole box or to the whole square of the grid, so in (0, 1]; coordinates are absolute, not relative
    ! to the box. A box that is full has fraction 1 and its middle as its centroid, one that is empty has fraction 0. A
    ! box in several parts has several cells, whose fractions add up. Every number is within one unit in the last place
    ! of the exact value and depends on that value alone: not on threads, blocks or the order of the input. Sums close
    ! accordingly: the areas of a cell's faces in grid planes and its boundary area vector cancel within half a unit in
    ! the last place per term.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; volumes: count;
    ! fractions: count, volume over the volume of the box; centroids: 3 × count; flags: count, nonzero where a value of
    ! this cell (boundary included) is beyond the range of double: it is then infinite, or 0.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: about a microsecond and a
    ! half per cut cell at the first call of this function, lap_grid_cell_boundaries or lap_grid_plane_face_moments,
    ! then none. The flags look at boundaries: the first call that asks for them costs what lap_grid_cell_boundaries
    ! does.
    integer(c_int32_t) function lap_grid_cell_moments(grid, count, volumes, fractions, centroids, &
      flags) bind(c, name="lap_grid_cell_moments")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: volumes
      type(c_ptr), intent(inout), optional :: fractions
      type(c_ptr), intent(inout), optional :: centroids
      type(c_ptr), intent(inout), optional :: flags
    end function
  end interface

  public :: lap_grid_cell_second_moments
  interface
    ! Moments of the cut cells to order 2 about the middle of each cell's box, for reconstructions of higher order.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; first: 3 × count,
    ! the integrals of (x - m)_i over the cell, m being the exact middle of its box; second: 6 × count, the integrals
    ! of (x - m)_i (x - m)_j for ij = xx, yy, zz, xy, yz, zx. Of a full box with sides a, b, c and volume V they are 0
    ! and V a²/12, V b²/12, V c²/12, 0, 0, 0.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: about ten microseconds
    ! per cut cell at the first call, more where a moment is exactly zero by symmetry; then none. Memory: 72 bytes per
    ! cell.
    integer(c_int32_t) function lap_grid_cell_second_moments(grid, count, first, &
      second) bind(c, name="lap_grid_cell_second_moments")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: first
      type(c_ptr), intent(inout), optional :: second
    end function
  end interface

  public :: lap_grid_cell_boundaries
  interface
    ! The embedded boundary of each cut cell: all its walls together.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; area_vectors: 3 ×
    ! count, the sum of the area vectors of the cell's walls, pointing out of the fluid; centroids: 3 × count, the mean
    ! of the positions on the walls, weighted by area (the cell's centroid if it has no wall).
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: about a microsecond per
    ! cut cell, and lap_grid_cell_moments, at the first call, then none. Memory: 49 bytes per cell.
    integer(c_int32_t) function lap_grid_cell_boundaries(grid, count, area_vectors, &
      centroids) bind(c, name="lap_grid_cell_boundaries")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: area_vectors
      type(c_ptr), intent(inout), optional :: centroids
    end function
  end interface

  public :: lap_grid_plane_face_moments
  interface
    ! The faces in grid planes, in the order of lap_grid_plane_faces, which says what cells each joins.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of faces in grid planes; areas:
    ! count; fractions: count, area over the area of the square; centroids: 3 × count, the coordinate across the plane
    ! being the plane's node, bit for bit; flags: count, nonzero where a value is beyond the range of double: it is then
    ! infinite, or 0. The area vector of a face is its area along the axis.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: as lap_grid_cell_moments.
    integer(c_int32_t) function lap_grid_plane_face_moments(grid, count, areas, fractions, centroids, &
      flags) bind(c, name="lap_grid_plane_face_moments")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: areas
      type(c_ptr), intent(inout), optional :: fractions
      type(c_ptr), intent(inout), optional :: centroids
      type(c_ptr), intent(inout), optional :: flags
    end function
  end interface

  public :: lap_grid_wall_moments
  interface
    ! The walls one by one, in the order of lap_grid_walls, which says what triangle, tag and cell each has.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of walls; area_vectors: 3 ×
    ! count, pointing out of the fluid; centroids: 3 × count.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: some 200 ns and 48 bytes
    ! per wall at the first call, then none.
    integer(c_int32_t) function lap_grid_wall_moments(grid, count, area_vectors, &
      centroids) bind(c, name="lap_grid_wall_moments")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: area_vectors
      type(c_ptr), intent(inout), optional :: centroids
    end function
  end interface

  public :: lap_grid_cell_walls
  interface
    ! The walls of each cut cell.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; offsets: count + 1;
    ! walls: those of cell c are walls[offsets[c]] up to, not including, walls[offsets[c + 1]], rising. With
    ! lap_grid_walls they lead to the triangles and tags behind a cell.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the walls at
    ! the first call, then none.
    integer(c_int32_t) function lap_grid_cell_walls(grid, count, offsets, walls) bind(c, name="lap_grid_cell_walls")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: walls
    end function
  end interface

  public :: lap_grid_cell_tags
  interface
    ! The embedded boundary of each cut cell by tag of the triangles: what a boundary patch has of the cell.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of cut cells; offsets: count + 1:
    ! cell c has the entries offsets[c] up to, not including, offsets[c + 1]; tags: the tag of each entry, rising in a
    ! cell (0 for a mesh without tags); area_vectors: 3 per entry, pointing out of the fluid; centroids: 3 per entry,
    ! weighted by area.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: as
    ! lap_grid_cell_boundaries, and again for cells with several tags, at the first call, then none.
    integer(c_int32_t) function lap_grid_cell_tags(grid, count, offsets, tags, area_vectors, &
      centroids) bind(c, name="lap_grid_cell_tags")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: tags
      type(c_ptr), intent(inout), optional :: area_vectors
      type(c_ptr), intent(inout), optional :: centroids
    end function
  end interface

  public :: lap_grid_full_faces
  interface
    ! The faces of full boxes that are not stored, of one grid plane: squares between two full boxes, and squares of
    ! full boxes at the block's boundary. (A square between a full box and a cut one is a face of the cut box:
    ! lap_grid_plane_faces.)
    !
    ! axis: 0, 1, 2 for the planes across x, y, z; node: the plane, from the block's low corner. Outputs (each may be
    ! NULL; valid until the next call with this context): count; nodes: count, the number of the lowest node of each
    ! square, rising; boxes: 2 × count, the numbers of the full boxes on the lower and on the upper side, -1 beyond the
    ! block.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for an axis or a plane that is not there; LAP_ERR_NULL_POINTER,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the boxes beside the plane.
    integer(c_int32_t) function lap_grid_full_faces(context, grid, axis, node, count, nodes, &
      boxes) bind(c, name="lap_grid_full_faces")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: grid
      integer(c_int32_t), value :: axis
      integer(c_int32_t), value :: node
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: nodes
      type(c_ptr), intent(inout), optional :: boxes
    end function
  end interface

  public :: lap_grid_full_links
  interface
    ! The links from cut cells to full neighbours: those faces in grid planes that have LAP_CELL_FULL on a side.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count; cells: count, the cut cell; faces: count, the
    ! face between the two, rising; boxes: count, the number of the full box.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the faces at
    ! the first call, then none.
    integer(c_int32_t) function lap_grid_full_links(grid, count, cells, faces, &
      boxes) bind(c, name="lap_grid_full_links")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: cells
      type(c_ptr), intent(inout), optional :: faces
      type(c_ptr), intent(inout), optional :: boxes
    end function
  end interface

  public :: lap_grid_regions
  interface
    ! The connected regions of fluid in the block. Cells and full boxes are connected through faces in grid planes, not
    ! along edges or at vertices. Regions are numbered by their lowest box, then cell.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): n_regions: the number of regions; count: the number
    ! of cut cells; cell_regions: count, the region of each. For full boxes see lap_grid_box_region and
    ! lap_grid_region_runs.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: a pass over the flags,
    ! and linear in cells and faces, at the first call, then none.
    integer(c_int32_t) function lap_grid_regions(grid, n_regions, count, cell_regions) bind(c, name="lap_grid_regions")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: n_regions
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: cell_regions
    end function
  end interface

  public :: lap_grid_region_runs
  interface
    ! The regions of all full boxes, as runs along x.
    !
    ! Outputs (each may be NULL; borrowed until the grid is freed): count: the number of rows of boxes, ny nz; row_runs:
    ! count + 1: row j + ny k has the runs row_runs[row] up to, not including, row_runs[row + 1]; run_boxes: 2 per run:
    ! the boxes numbered run_boxes[2 r] up to, not including, run_boxes[2 r + 1], all of them full, rising; run_regions:
    ! one per run.
    !
    ! Errors: LAP_ERR_NULL_POINTER if grid is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: as lap_grid_regions.
    integer(c_int32_t) function lap_grid_region_runs(grid, count, row_runs, run_boxes, &
      run_regions) bind(c, name="lap_grid_region_runs")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: row_runs
      type(c_ptr), intent(inout), optional :: run_boxes
      type(c_ptr), intent(inout), optional :: run_regions
    end function
  end interface

  public :: lap_grid_box_region
  interface
    ! The region of a full box.
    !
    ! i, j, k: the box, from the block's low corner. region: receives its region, -1 if the box is not full (the cells
    ! of a cut box may be in several).
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a box outside the block, LAP_ERR_OUT_OF_MEMORY. Threads:
    ! any. Cost: as lap_grid_regions at the first call, then a binary search.
    integer(c_int32_t) function lap_grid_box_region(grid, i, j, k, region) bind(c, name="lap_grid_box_region")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: grid
      integer(c_int32_t), value :: i
      integer(c_int32_t), value :: j
      integer(c_int32_t), value :: k
      integer(c_int32_t), intent(inout), optional :: region
    end function
  end interface

  public :: lap_grid_region_at
  interface
    ! The region that holds a point, exactly. A point on a grid plane belongs to the fluid around it.
    !
    ! region: receives a region from 0, or LAP_REGION_SOLID, LAP_REGION_SURFACE, LAP_REGION_BEYOND.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT if a coordinate is not finite; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: as lap_grid_regions at the first call; linear in the mesh's triangles, and in a cut box some
    ! hundred microseconds for each cell of ordinary size.
    integer(c_int32_t) function lap_grid_region_at(context, grid, x, y, z, region) bind(c, name="lap_grid_region_at")
      import :: c_double, c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: grid
      real(c_double), value :: x
      real(c_double), value :: y
      real(c_double), value :: z
      integer(c_int32_t), intent(inout), optional :: region
    end function
  end interface

  public :: lap_grid_region_mask
  interface
    ! What belongs to a region, for example to the one that holds a given point (lap_grid_region_at).
    !
    ! region: from 0. Outputs (each may be NULL; valid until the next call with this context): n_cells: the number of
    ! cut cells; cells: n_cells numbers, 1 for the region's cells, else 0; n_boxes: the number of boxes; boxes: n_boxes
    ! numbers, 1 for the region's full boxes, else 0.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for a region that is not there; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: as lap_grid_regions at the first call; a byte per box, written.
    integer(c_int32_t) function lap_grid_region_mask(context, grid, region, n_cells, cells, n_boxes, &
      boxes) bind(c, name="lap_grid_region_mask")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: grid
      integer(c_int32_t), value :: region
      integer(c_int64_t), intent(inout), optional :: n_cells
      type(c_ptr), intent(inout), optional :: cells
      integer(c_int64_t), intent(inout), optional :: n_boxes
      type(c_ptr), intent(inout), optional :: boxes
    end function
  end interface

  public :: lap_grid_aggregate
  interface
    ! Aggregates small cells: maps each cut cell to the cell or the full box that stands for it, so that the volume
    ! fractions of what stands together add up to `minimum` at least, where that can be had. Each small aggregate merges
    ! across its largest face in a grid plane (ties: the larger fraction beyond, then the lower face), small ones first,
    ! until it suffices. The geometry stays as it is, and so do all other arrays.
    !
    ! Inputs (borrowed for the call): minimum: a volume fraction, from 0; closed_faces: a number per face in a grid
    ! plane, in the order of lap_grid_plane_faces, not 0 where nothing may merge across it, or NULL; closed_cells: a
    ! number per cut cell, not 0 where it may merge with none, or NULL. Outputs (each may be NULL; valid until the next
    ! call with this context): count: the number of cut cells; cells: count, the cell that stands for each (itself, for
    ! one that stands alone), or LAP_CELL_FULL; boxes: count, the number of the box of that cell, or of the full box;
    ! n_small: how many aggregates stay below the minimum; small: n_small cells that stand for them, rising.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for a minimum that is negative or not finite; LAP_ERR_NULL_POINTER,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: that of lap_grid_cell_moments at the first call; linear in the faces of
    ! small cells, times the few rounds in which they merge.
    integer(c_int32_t) function lap_grid_aggregate(context, grid, minimum, closed_faces, closed_cells, count, cells, &
      boxes, n_small, small) bind(c, name="lap_grid_aggregate")
      import :: c_double, c_int32_t, c_int64_t, c_int8_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: grid
      real(c_double), value :: minimum
      integer(c_int8_t), intent(in), optional :: closed_faces(*)
      integer(c_int8_t), intent(in), optional :: closed_cells(*)
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: cells
      type(c_ptr), intent(inout), optional :: boxes
      integer(c_int64_t), intent(inout), optional :: n_small
      type(c_ptr), intent(inout), optional :: small
    end function
  end interface

  public :: lap_simplex_new
  interface
    ! Makes a handle without simplices, to be filled by lap_simplex_compute.
    !
    ! simplex: receives the handle; free it with lap_simplex_free.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: an allocation.
    integer(c_int32_t) function lap_simplex_new(simplex) bind(c, name="lap_simplex_new")
      import :: c_int32_t, c_ptr
      type(c_ptr), intent(inout), optional :: simplex
    end function
  end interface

  public :: lap_simplex_free
  interface
    ! Frees a handle and all that was borrowed from it. NULL is allowed and does nothing.
    !
    ! Errors: none.
    integer(c_int32_t) function lap_simplex_free(simplex) bind(c, name="lap_simplex_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: simplex
    end function
  end interface

  public :: lap_simplex_compute
  interface
    ! Divides simplices, all alike in kind, dimension and number of functions.
    !
    ! Inputs (borrowed for the call): kind: LAP_SIMPLEX_ARRANGEMENT or LAP_SIMPLEX_INTERFACE; dim: 3 for tetrahedra, 2
    ! for triangles; n_simplices: may be 0; n_functions: of each simplex, or materials; an arrangement may have none;
    ! values: n_simplices × n_functions × (dim + 1) numbers, value (s, f, c) of function f at corner c of simplex s at
    ! (s n_functions + f) (dim + 1) + c. simplex: what it had is replaced, and what was borrowed from it is no longer
    ! valid; after an error it has no simplices.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for a kind or dimension that there is not, a negative count, an interface of no
    ! materials, and, with a message that names function, corner and simplex, for a value that is NaN or infinite;
    ! LAP_ERR_TOO_LARGE if the result has more elements than 32-bit indices can number; LAP_ERR_NULL_POINTER,
    ! LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: of each simplex, as its complex is large: an
    ! arrangement of n functions has up to n^3 / 6 cells, and costs n^3 steps or less; and some microseconds for the
    ! call, so pass many at a time. Simplices are shared out among the context's threads.
    integer(c_int32_t) function lap_simplex_compute(context, simplex, kind, dim, n_simplices, n_functions, &
      values) bind(c, name="lap_simplex_compute")
      import :: c_double, c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: simplex
      integer(c_int32_t), value :: kind
      integer(c_int32_t), value :: dim
      integer(c_int64_t), value :: n_simplices
      integer(c_int64_t), value :: n_functions
      real(c_double), intent(in), optional :: values(*)
    end function
  end interface

  public :: lap_simplex_counts
  interface
    ! How many elements the complexes of all simplices have together.
    !
    ! Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_simplex_counts(simplex, simplices, vertices, edges, faces, &
      cells) bind(c, name="lap_simplex_counts")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: simplices
      integer(c_int64_t), intent(inout), optional :: vertices
      integer(c_int64_t), intent(inout), optional :: edges
      integer(c_int64_t), intent(inout), optional :: faces
      integer(c_int64_t), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_simplex_offsets
  interface
    ! Which elements are those of each simplex: of simplex s the vertices vertices[s] up to, not including, vertices[s +
    ! 1], and alike the edges, faces, cells and planes.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of simplices;
    ! vertices, edges, faces, cells, planes: count + 1 each.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_simplex_offsets(simplex, count, vertices, edges, faces, cells, &
      planes) bind(c, name="lap_simplex_offsets")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: edges
      type(c_ptr), intent(inout), optional :: faces
      type(c_ptr), intent(inout), optional :: cells
      type(c_ptr), intent(inout), optional :: planes
    end function
  end interface

  public :: lap_simplex_tables
  interface
    ! Where the complex of each simplex comes from: a look-up table (one or two functions, two or three materials), or
    ! construction.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of simplices;
    ! n_entries: how many entries the tables have in all, complexes that no permutation of corners and no symmetry of
    ! functions makes alike; entries: count, the entry of each simplex, -1 where it was constructed; corners: 4 ×
    ! count, the simplex's corner for each of the entry's; functions: 3 × count, the function (material) for each of
    ! the entry's; -1 where there is none; flips: a byte for each, bit k set where the entry's function k has the
    ! opposite sign.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: some ten nanoseconds a simplex at the first
    ! call, then none.
    integer(c_int32_t) function lap_simplex_tables(simplex, count, n_entries, entries, corners, functions, &
      flips) bind(c, name="lap_simplex_tables")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int64_t), intent(inout), optional :: n_entries
      type(c_ptr), intent(inout), optional :: entries
      type(c_ptr), intent(inout), optional :: corners
      type(c_ptr), intent(inout), optional :: functions
      type(c_ptr), intent(inout), optional :: flips
    end function
  end interface

  public :: lap_simplex_vertices
  interface
    ! What each vertex is: the point of an open sub-simplex (corner, edge, triangle, tetrahedron; of dimension d) where
    ! some functions are zero, or some materials equal.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; carriers: count numbers,
    ! bit c (1, 2, 4, 8) set for each corner c of the sub-simplex; codes: 4 × count, the d functions that are zero
    ! there and fix the point (or the d + 1 materials that are equal), then -1; where more go through the point there
    ! are other choices.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_simplex_vertices(simplex, count, carriers, &
      codes) bind(c, name="lap_simplex_vertices")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: carriers
      type(c_ptr), intent(inout), optional :: codes
    end function
  end interface

  public :: lap_simplex_vertex_functions
  interface
    ! All functions that are zero at each vertex, without those that are zero everywhere, rising; or all materials that
    ! are largest there.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of vertices;
    ! offsets: count + 1; functions: those of vertex v are functions[offsets[v]] up to, not including,
    ! functions[offsets[v + 1]].
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_simplex_vertex_functions(simplex, count, offsets, &
      functions) bind(c, name="lap_simplex_vertex_functions")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: functions
    end function
  end interface

  public :: lap_simplex_edges
  interface
    ! The edges of tetrahedra; there are none in triangles.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; vertices: 2 × count.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_simplex_edges(simplex, count, vertices) bind(c, name="lap_simplex_edges")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
    end function
  end interface

  public :: lap_simplex_faces
  interface
    ! The faces: in a tetrahedron the corners of each polygon, anticlockwise as seen from its positive side; in a
    ! triangle the two ends of each segment, its positive side on the left of the way from the first to the second.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; offsets: count + 1, face f
    ! has the corners offsets[f] up to, not including, offsets[f + 1]; vertices: the vertex of each corner; edges: the
    ! edge from each corner to the next of its face (from the last to the first), NULL in triangles.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_simplex_faces(simplex, count, offsets, vertices, &
      edges) bind(c, name="lap_simplex_faces")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: edges
    end function
  end interface

  public :: lap_simplex_face_supports
  interface
    ! What each face lies on, and the cells on its two sides.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; kinds: count numbers
    ! LAP_SIMPLEX_FACET, LAP_SIMPLEX_FUNCTION or LAP_SIMPLEX_PAIR; ids: 2 × count, as these say, -1 where unused;
    ! planes: for each face the plane that it lies on (see lap_simplex_planes); cells: 2 × count, those on its positive
    ! and on its negative side, -1 outside of the simplex.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: kinds and ids: linear at the first call, then
    ! none.
    integer(c_int32_t) function lap_simplex_face_supports(simplex, count, kinds, ids, planes, &
      cells) bind(c, name="lap_simplex_face_supports")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: kinds
      type(c_ptr), intent(inout), optional :: ids
      type(c_ptr), intent(inout), optional :: planes
      type(c_ptr), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_simplex_planes
  interface
    ! Planes that faces lie on, with all functions that are zero on them, rising, without those that are zero
    ! everywhere. Arrangement: those of a simplex are its facets (facet c is opposite to corner c; functions may be zero
    ! there as well), then planes inside, which all coplanar faces share. Interface: one for each face, with all
    ! materials that are largest on the whole face.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count; offsets: count + 1;
    ! functions: those of plane p are functions[offsets[p]] up to, not including, functions[offsets[p + 1]]; opposite:
    ! arrangement: for each of these functions 1 where it is negative on the positive side of the plane, 0 where it is
    ! positive; interface: NULL.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_simplex_planes(simplex, count, offsets, functions, &
      opposite) bind(c, name="lap_simplex_planes")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: functions
      type(c_ptr), intent(inout), optional :: opposite
    end function
  end interface

  public :: lap_simplex_cells
  interface
    ! The half-faces that bound each cell.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of cells;
    ! offsets: count + 1; half_faces: those of cell c are half_faces[offsets[c]] up to, not including,
    ! half_faces[offsets[c + 1]]; 2 f where the cell is on the positive side of face f, 2 f + 1 where it is on the
    ! negative one.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_simplex_cells(simplex, count, offsets, &
      half_faces) bind(c, name="lap_simplex_cells")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: half_faces
    end function
  end interface

  public :: lap_simplex_cell_signs
  interface
    ! The sign of every function in each cell of an arrangement.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of cells;
    ! functions: n, the number of functions; signs: count × n, sign (c, f) at c n + f: -1, 1, or 0 where the function
    ! is zero on the whole simplex.
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL; LAP_ERR_BAD_ARGUMENT for an interface. Threads: any. Cost: linear
    ! at the first call, then none.
    integer(c_int32_t) function lap_simplex_cell_signs(simplex, count, functions, &
      signs) bind(c, name="lap_simplex_cell_signs")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int64_t), intent(inout), optional :: functions
      type(c_ptr), intent(inout), optional :: signs
    end function
  end interface

  public :: lap_simplex_cell_materials
  interface
    ! The material of each cell of an interface.
    !
    ! Outputs (each may be NULL; borrowed until the handle is filled again or freed): count: the number of cells;
    ! owners: count numbers, the lowest material that is largest in the cell; offsets: count + 1; materials: all that
    ! are, which are equal everywhere, rising: those of cell c are materials[offsets[c]] up to, not including,
    ! materials[offsets[c + 1]].
    !
    ! Errors: LAP_ERR_NULL_POINTER if simplex is NULL; LAP_ERR_BAD_ARGUMENT for an arrangement. Threads: any. Cost:
    ! none.
    integer(c_int32_t) function lap_simplex_cell_materials(simplex, count, owners, offsets, &
      materials) bind(c, name="lap_simplex_cell_materials")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: simplex
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: owners
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: materials
    end function
  end interface

  public :: lap_simplex_vertex_exact
  interface
    ! The exact barycentric coordinates of a vertex, one for each corner of its simplex, as canonical strings, "num/den"
    ! or "num" for an integer, in decimal. They are not negative, and their sum is 1. A GMP or CGAL rational reads them.
    !
    ! Outputs (each may be NULL): a, b, c, d: valid until the next call with this context; d is "0" in a triangle.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a vertex that is not there, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: some microseconds.
    integer(c_int32_t) function lap_simplex_vertex_exact(context, simplex, vertex, a, b, c, &
      d) bind(c, name="lap_simplex_vertex_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: simplex
      integer(c_int32_t), value :: vertex
      type(c_ptr), intent(inout), optional :: a
      type(c_ptr), intent(inout), optional :: b
      type(c_ptr), intent(inout), optional :: c
      type(c_ptr), intent(inout), optional :: d
    end function
  end interface

  public :: lap_simplex_cell_volume_exact
  interface
    ! The exact volume of a cell as a part of its simplex's volume (in a triangle: area), as a canonical string,
    ! "num/den" or "num" for an integer, in decimal. Those of the cells of a simplex have the sum 1.
    !
    ! volume: valid until the next call with this context.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a cell that is not there, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: some microseconds for each corner of each face.
    integer(c_int32_t) function lap_simplex_cell_volume_exact(context, simplex, cell, &
      volume) bind(c, name="lap_simplex_cell_volume_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: simplex
      integer(c_int32_t), value :: cell
      type(c_ptr), intent(inout), optional :: volume
    end function
  end interface

  public :: lap_simplex_check
  interface
    ! Checks that the complexes are consistent: indices in range, faces closed, between the cells that name them and
    ! oriented as they say, cells closed.
    !
    ! Errors: LAP_ERR_INCONSISTENT with a message that names the element; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: linear.
    integer(c_int32_t) function lap_simplex_check(context, simplex) bind(c, name="lap_simplex_check")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: simplex
    end function
  end interface

  public :: lap_network_options_init
  interface
    ! Fills network options with the defaults.
    !
    ! struct_size: pass (int32_t)sizeof(lap_network_options); no more than that is written, so a program compiled
    ! against an older header keeps working.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
    integer(c_int32_t) function lap_network_options_init(options, struct_size) bind(c, name="lap_network_options_init")
      import :: c_int32_t, lap_network_options
      type(lap_network_options), intent(inout), optional :: options
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_network_new_box
  interface
    ! The network of functions on a box of cubes, of which nothing is stored.
    !
    ! Inputs (borrowed for the call): cells: 3 numbers, cubes along x, y and z, 1 or more; bounds: lowest x, y, z,
    ! highest x, y, z: node i of n + 1 along an axis is at (i / n) (highest - lowest) + lowest, computed in doubles as
    ! written; or NULL: then it is at i; n_functions: functions, or materials; an arrangement may have none; values:
    ! that of function f at node i is values[f × function_stride + i × node_stride], so with one array per function
    ! behind the other the strides are the number of nodes and 1, and with interleaved values 1 and n_functions;
    ! options: or NULL for the defaults. network: receives the handle, NULL after an error or cancel; free it with
    ! lap_network_free. It does not need the context to stay alive.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for cells below 1, bounds that are not finite or do not rise, a stride below 1, a
    ! negative count, an interface of no materials, an option that there is not, and, with a message that names function
    ! and node, for a value that is NaN or infinite; LAP_ERR_TOO_LARGE if the box has 2^30 nodes or tetrahedra or more,
    ! or the result more elements than 32-bit indices can number; LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: reading the values once, else it grows with the simplices that surfaces
    ! cross and the polygons in them.
    integer(c_int32_t) function lap_network_new_box(context, cells, bounds, n_functions, values, function_stride, &
      node_stride, options, network) bind(c, name="lap_network_new_box")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_network_options
      type(c_ptr), value :: context
      integer(c_int32_t), intent(in), optional :: cells(*)
      real(c_double), intent(in), optional :: bounds(*)
      integer(c_int64_t), value :: n_functions
      real(c_double), intent(in), optional :: values(*)
      integer(c_int64_t), value :: function_stride
      integer(c_int64_t), value :: node_stride
      type(lap_network_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: network
    end function
  end interface

  public :: lap_network_new_tets
  interface
    ! The network of functions on a conforming mesh of tetrahedra: any, connected or not, with holes and handles.
    !
    ! Inputs (borrowed for the call): xyz: 3 × n_nodes coordinates; tets: 4 × n_tets nodes; the corners of a
    ! tetrahedron in either orientation; nodes without tetrahedra are allowed. Two tetrahedra that share three nodes
    ! must lie on different sides of that face. (Tetrahedra that overlap without sharing a face are not looked for: the
    ! network is then the union of what each holds.) Others as for lap_network_new_box, with values at the n_nodes
    ! nodes. network: receives the handle, NULL after an error or cancel; free it with lap_network_free.
    !
    ! Errors: LAP_ERR_BAD_MESH with LAP_DEFECT_NON_FINITE_COORDINATE, LAP_DEFECT_INDEX_OUT_OF_RANGE,
    ! LAP_DEFECT_DEGENERATE_SIMPLEX or LAP_DEFECT_OVERLAPPING_SIMPLICES; LAP_ERR_TOO_LARGE for 2^30 nodes or tetrahedra
    ! or more; others as for lap_network_new_box. Cost: linear in the mesh; faces are sorted around their lowest nodes.
    integer(c_int32_t) function lap_network_new_tets(context, n_nodes, xyz, n_tets, tets, n_functions, values, &
      function_stride, node_stride, options, network) bind(c, name="lap_network_new_tets")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_network_options
      type(c_ptr), value :: context
      integer(c_int64_t), value :: n_nodes
      real(c_double), intent(in), optional :: xyz(*)
      integer(c_int64_t), value :: n_tets
      integer(c_int32_t), intent(in), optional :: tets(*)
      integer(c_int64_t), value :: n_functions
      real(c_double), intent(in), optional :: values(*)
      integer(c_int64_t), value :: function_stride
      integer(c_int64_t), value :: node_stride
      type(lap_network_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: network
    end function
  end interface

  public :: lap_network_new_triangles
  interface
    ! The network of functions on a conforming mesh of triangles in the plane: the same one dimension down.
    !
    ! Inputs (borrowed for the call): xy: 2 × n_nodes coordinates; triangles: 3 × n_triangles nodes, in either
    ! orientation; others as for lap_network_new_tets. network: receives the handle, NULL after an error or cancel; free
    ! it with lap_network_free.
    !
    ! Errors: as for lap_network_new_tets. Cost: as well.
    integer(c_int32_t) function lap_network_new_triangles(context, n_nodes, xy, n_triangles, triangles, n_functions, &
      values, function_stride, node_stride, options, network) bind(c, name="lap_network_new_triangles")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_network_options
      type(c_ptr), value :: context
      integer(c_int64_t), value :: n_nodes
      real(c_double), intent(in), optional :: xy(*)
      integer(c_int64_t), value :: n_triangles
      integer(c_int32_t), intent(in), optional :: triangles(*)
      integer(c_int64_t), value :: n_functions
      real(c_double), intent(in), optional :: values(*)
      integer(c_int64_t), value :: function_stride
      integer(c_int64_t), value :: node_stride
      type(lap_network_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: network
    end function
  end interface

  public :: lap_network_free
  interface
    ! Frees a network and all that was borrowed from it. NULL is allowed and does nothing. (Surfaces made from it stay.)
    !
    ! Errors: none.
    integer(c_int32_t) function lap_network_free(network) bind(c, name="lap_network_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: network
    end function
  end interface

  public :: lap_network_check
  interface
    ! Checks that a network is consistent with what it was made from: vertices in the simplices and on the functions
    ! that they name, labels that come back around every edge, and everything formed of them.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT if it was made without keep_values; LAP_ERR_INCONSISTENT with a message that names
    ! the element; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: a sort of all edges.
    integer(c_int32_t) function lap_network_check(context, network) bind(c, name="lap_network_check")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: network
    end function
  end interface

  public :: lap_network_stage_count
  interface
    ! How many stages the making of the network ran through.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_stage_count(network, count) bind(c, name="lap_network_stage_count")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int32_t), intent(inout), optional :: count
    end function
  end interface

  public :: lap_network_stage
  interface
    ! Stage i, from 0, in the order in which they ran: its name and its time in seconds.
    !
    ! Outputs (each may be NULL). name is borrowed until the network is freed.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL, LAP_ERR_BAD_ARGUMENT if there is no such stage. Threads: any.
    ! Cost: none.
    integer(c_int32_t) function lap_network_stage(network, i, name, seconds) bind(c, name="lap_network_stage")
      import :: c_double, c_int32_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int32_t), value :: i
      type(c_ptr), intent(inout), optional :: name
      real(c_double), intent(inout), optional :: seconds
    end function
  end interface

  public :: lap_network_counts
  interface
    ! How many elements a network has.
    !
    ! Outputs: each may be NULL; polygons are what the networks paper calls faces. Errors: LAP_ERR_NULL_POINTER if
    ! network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_counts(network, vertices, edges, polygons, patches, chains, corners, &
      components, shells, regions) bind(c, name="lap_network_counts")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: vertices
      integer(c_int64_t), intent(inout), optional :: edges
      integer(c_int64_t), intent(inout), optional :: polygons
      integer(c_int64_t), intent(inout), optional :: patches
      integer(c_int64_t), intent(inout), optional :: chains
      integer(c_int64_t), intent(inout), optional :: corners
      integer(c_int64_t), intent(inout), optional :: components
      integer(c_int64_t), intent(inout), optional :: shells
      integer(c_int64_t), intent(inout), optional :: regions
    end function
  end interface

  public :: lap_network_input
  interface
    ! What a network was made from.
    !
    ! Outputs (each may be NULL): kind: LAP_NETWORK_*; dim: the dimension, 2 or 3; functions: how many functions or
    ! materials.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_input(network, kind, dim, functions) bind(c, name="lap_network_input")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int32_t), intent(inout), optional :: kind
      integer(c_int32_t), intent(inout), optional :: dim
      integer(c_int64_t), intent(inout), optional :: functions
    end function
  end interface

  public :: lap_network_active
  interface
    ! Active simplices by how many functions are active in them: those that are neither positive nor negative at all
    ! corners; of an interface the materials that no other one exceeds at all corners, where there are two or more.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; simplices: count numbers, simplices[k]
    ! simplices have k active functions.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_active(network, count, simplices) bind(c, name="lap_network_active")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: simplices
    end function
  end interface

  public :: lap_network_vertices
  interface
    ! The vertices: no two are the same point, each is a corner of a polygon.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; xyz: 3 × count coordinates, each the
    ! double nearest to the exact one (zero is +0); nodes: 4 × count: the nodes of the smallest simplex (node, edge,
    ! triangle, tetrahedron) of the domain that holds the vertex, rising, then -1.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_vertices(network, count, xyz, nodes) bind(c, name="lap_network_vertices")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: xyz
      type(c_ptr), intent(inout), optional :: nodes
    end function
  end interface

  public :: lap_network_vertex_functions
  interface
    ! All functions that are zero at each vertex; of an interface all materials that are largest there.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count: the number of vertices; offsets: count +
    ! 1; functions: those of vertex v are functions[offsets[v]] up to, not including, functions[offsets[v + 1]], rising.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_vertex_functions(network, count, offsets, &
      functions) bind(c, name="lap_network_vertex_functions")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: functions
    end function
  end interface

  public :: lap_network_polygons
  interface
    ! The polygons, in the order of their simplices.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; vertices: those of
    ! polygon p are vertices[offsets[p]] up to, not including, vertices[offsets[p + 1]], anticlockwise seen from the tip
    ! of its normal; sets: of each polygon, the functions that it lies on (see lap_network_sets); simplices: 2 × count:
    ! those before and behind it, the same one twice for a polygon inside a simplex.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_polygons(network, count, offsets, vertices, sets, &
      simplices) bind(c, name="lap_network_polygons")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: sets
      type(c_ptr), intent(inout), optional :: simplices
    end function
  end interface

  public :: lap_network_sets
  interface
    ! The different sets of functions that polygons lie on, in lexicographic order.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; functions: those of
    ! set s are functions[offsets[s]] up to, not including, functions[offsets[s + 1]], rising; of an interface two
    ! materials; orientations: one for each of these: how the sign of the function changes along the normal, 1 if it
    ! rises, -1 if it falls, 0 if it is the same on both sides; of an interface 1 for the material before the polygon,
    ! -1 for the one behind it.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_sets(network, count, offsets, functions, &
      orientations) bind(c, name="lap_network_sets")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: functions
      type(c_ptr), intent(inout), optional :: orientations
    end function
  end interface

  public :: lap_network_edges
  interface
    ! The edges, and the polygons around each.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; vertices: 2 × count, the lower vertex
    ! first; offsets: count + 1; polygons: those of edge e are polygons[offsets[e]] up to, not including,
    ! polygons[offsets[e + 1]], rising.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_edges(network, count, vertices, offsets, &
      polygons) bind(c, name="lap_network_edges")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: polygons
    end function
  end interface

  public :: lap_network_polygon_patches
  interface
    ! The patch of each polygon.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count: the number of polygons; patches: count;
    ! turned: count bytes, 1 where the normal of the polygon is against that of the lowest polygon of its patch, which
    ! is the patch's. (Only polygons with one label on both sides can be, or those of a patch with one side only.)
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: turned: linear at the
    ! first call; then none.
    integer(c_int32_t) function lap_network_polygon_patches(network, count, patches, &
      turned) bind(c, name="lap_network_polygon_patches")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: patches
      type(c_ptr), intent(inout), optional :: turned
    end function
  end interface

  public :: lap_network_patches
  interface
    ! The patches, numbered by their lowest polygons.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; polygons: those of
    ! patch p are polygons[offsets[p]] up to, not including, polygons[offsets[p + 1]], rising; they have one set of
    ! functions; components: the component of each patch, numbered by their lowest polygons.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the polygons
    ! at the first call, then none.
    integer(c_int32_t) function lap_network_patches(network, count, offsets, polygons, &
      components) bind(c, name="lap_network_patches")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: polygons
      type(c_ptr), intent(inout), optional :: components
    end function
  end interface

  public :: lap_network_chains
  interface
    ! The chains, numbered by their lowest edges.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; edge_offsets: count + 1; edges: those of
    ! chain c are edges[edge_offsets[c]] up to, not including, edges[edge_offsets[c + 1]], along it; vertex_offsets:
    ! count + 1; vertices: along it, one more than edges (in two dimensions one), a loop begins and ends with the same;
    ! loops: count bytes, 1 where a chain closes without a corner.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_chains(network, count, edge_offsets, edges, vertex_offsets, vertices, &
      loops) bind(c, name="lap_network_chains")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: edge_offsets
      type(c_ptr), intent(inout), optional :: edges
      type(c_ptr), intent(inout), optional :: vertex_offsets
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: loops
    end function
  end interface

  public :: lap_network_chain_patches
  interface
    ! The order of patches around each chain.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count: the number of chains; offsets: count + 1;
    ! sides: those of chain c are sides[offsets[c]] up to, not including, sides[offsets[c + 1]]: anticlockwise about its
    ! direction (seen against it), the side of each patch that is met first, 2 p + s; a patch may be there several
    ! times; gaps: for each of these a byte, 1 where the way from there to the next one (from the last to the first)
    ! leads out of the domain.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_chain_patches(network, count, offsets, sides, &
      gaps) bind(c, name="lap_network_chain_patches")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: sides
      type(c_ptr), intent(inout), optional :: gaps
    end function
  end interface

  public :: lap_network_corners
  interface
    ! The corners: vertices where chains end.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; vertices: count, rising.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_corners(network, count, vertices) bind(c, name="lap_network_corners")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
    end function
  end interface

  public :: lap_network_shells
  interface
    ! The shells: sides of patches that bound one region along edges.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; sides: those of shell
    ! s are sides[offsets[s]] up to, not including, sides[offsets[s + 1]], rising, 2 p + s' for patch p; regions: the
    ! region of each shell.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_shells(network, count, offsets, sides, &
      regions) bind(c, name="lap_network_shells")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: sides
      type(c_ptr), intent(inout), optional :: regions
    end function
  end interface

  public :: lap_network_regions
  interface
    ! The regions: first those with shells, by their lowest shells, then parts of the domain that no polygon touches, by
    ! their lowest nodes.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; offsets: count + 1; shells: those of
    ! region r are shells[offsets[r]] up to, not including, shells[offsets[r + 1]], rising; simplices: one that holds a
    ! part of each region.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_regions(network, count, offsets, shells, &
      simplices) bind(c, name="lap_network_regions")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: shells
      type(c_ptr), intent(inout), optional :: simplices
    end function
  end interface

  public :: lap_network_region_signs
  interface
    ! The sign of every function in each region of an arrangement.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count: the number of regions; functions: n, the
    ! number of functions; signs: count × n, that of function f in region r at r n + f: -1, 1, or 0 where the function
    ! is zero on the whole region.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL; LAP_ERR_BAD_ARGUMENT for an interface. Threads: any. Cost: none.
    integer(c_int32_t) function lap_network_region_signs(network, count, functions, &
      signs) bind(c, name="lap_network_region_signs")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int64_t), intent(inout), optional :: functions
      type(c_ptr), intent(inout), optional :: signs
    end function
  end interface

  public :: lap_network_region_materials
  interface
    ! The material of each region of an interface: the largest there, of equal ones the lowest. (Which others equal it
    ! throughout, lap_network_region_ties tells.)
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count: the number of regions; materials: count.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL; LAP_ERR_BAD_ARGUMENT for an arrangement. Threads: any. Cost:
    ! none.
    integer(c_int32_t) function lap_network_region_materials(network, count, &
      materials) bind(c, name="lap_network_region_materials")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: materials
    end function
  end interface

  public :: lap_network_region_ties
  interface
    ! The materials that are equal throughout each region of an interface: its owner, which is the lowest, and those
    ! that equal it at every node of every simplex with a part of the region.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count: the number of regions; offsets: count + 1;
    ! materials: those of region r are materials[offsets[r]] up to, not including, materials[offsets[r + 1]], rising.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for an arrangement, or if the network was made without keep_values;
    ! LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: at the first call linear in the simplices of
    ! regions with equal materials, then none.
    integer(c_int32_t) function lap_network_region_ties(context, network, count, offsets, &
      materials) bind(c, name="lap_network_region_ties")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: materials
    end function
  end interface

  public :: lap_network_complex
  interface
    ! The regions of a network in three dimensions as volumes: a complex on which all functions for lap_complex work but
    ! those for keys (there are none: LAP_ERR_BAD_ARGUMENT). Its mesh is the boundary of the domain, a triangle for each
    ! face of a tetrahedron on it.
    !
    ! Cells are the regions, in their order. Faces are the pieces that the network leaves of the boundary's triangles,
    ! by triangle, then the polygons of the network, in their order: polygon p is face n_faces - n_polygons + p. A
    ! polygon with one region on both sides has one cell twice. Vertices are the nodes on the boundary (LAP_VERTEX_MESH,
    ! with their numbers as nodes), rising, then the network's other vertices (LAP_VERTEX_LEVEL), rising. Volumes,
    ! moments and coordinates are exact as for all complexes.
    !
    ! complex: borrowed until the network is freed; do not free it.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT in two dimensions, or if the network was made without keep_values; LAP_ERR_BAD_MESH
    ! with LAP_DEFECT_EMPTY for a domain without tetrahedra, or LAP_DEFECT_DUPLICATE_VERTEX where two nodes on its
    ! boundary are in one place; LAP_ERR_TOO_LARGE, LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: at the first call linear in the network and the boundary, with a sort of all edges, then none.
    ! Memory: some 300 bytes a vertex and 250 a polygon.
    integer(c_int32_t) function lap_network_complex(context, network, complex) bind(c, name="lap_network_complex")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: network
      type(c_ptr), intent(inout), optional :: complex
    end function
  end interface

  public :: lap_network_triangles
  interface
    ! All polygons as triangles, without new vertices; in two dimensions there are none.
    !
    ! Outputs (each may be NULL; borrowed until the network is freed): count; vertices: 3 × count, anticlockwise as the
    ! polygon; polygons: that of each triangle, rising.
    !
    ! Errors: LAP_ERR_NULL_POINTER if network is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first
    ! call, then none.
    integer(c_int32_t) function lap_network_triangles(network, count, vertices, &
      polygons) bind(c, name="lap_network_triangles")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: network
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: polygons
    end function
  end interface

  public :: lap_network_vertex_exact
  interface
    ! The exact coordinates of a vertex, as canonical strings, "num/den" or "num" for an integer, in decimal. A GMP or
    ! CGAL rational reads them.
    !
    ! Outputs (each may be NULL): x, y, z: valid until the next call with this context.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for a vertex that is not there, or if the network was made without keep_values;
    ! LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: some microseconds.
    integer(c_int32_t) function lap_network_vertex_exact(context, network, vertex, x, y, &
      z) bind(c, name="lap_network_vertex_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: network
      integer(c_int32_t), value :: vertex
      type(c_ptr), intent(inout), optional :: x
      type(c_ptr), intent(inout), optional :: y
      type(c_ptr), intent(inout), optional :: z
    end function
  end interface

  public :: lap_network_csg
  interface
    ! The boundary of the regions that a boolean expression chooses.
    !
    ! expression: text, borrowed for the call, such as "(0 & !1) | 2". A number stands for "that function is positive"
    ! (of an interface: "it is that material"), -k for "function k is negative", =k for "function k is zero"; ! is not,
    ! & and, ^ one but not both, | or, in this order of strength; brackets; true and false. Spaces are free. triangles:
    ! nonzero: polygons are split into triangles, without new vertices. surface: receives the handle, NULL after an
    ! error; free it with lap_surface_free. It does not need the network.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT with a message that names the first character that does not fit;
    ! LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the polygons, and the regions times the
    ! expression.
    integer(c_int32_t) function lap_network_csg(context, network, expression, triangles, &
      surface) bind(c, name="lap_network_csg")
      import :: c_char, c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: network
      character(kind=c_char), intent(in), optional :: expression(*)
      integer(c_int32_t), value :: triangles
      type(c_ptr), intent(inout), optional :: surface
    end function
  end interface

  public :: lap_network_csg_table
  interface
    ! The boundary of the regions that a table chooses.
    !
    ! table: n_regions bytes, borrowed for the call, nonzero for each region of the network that is chosen; n_regions:
    ! as many as the network has. Others as for lap_network_csg.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for a table of another length; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: linear in the polygons.
    integer(c_int32_t) function lap_network_csg_table(context, network, n_regions, table, triangles, &
      surface) bind(c, name="lap_network_csg_table")
      import :: c_int32_t, c_int64_t, c_int8_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: network
      integer(c_int64_t), value :: n_regions
      integer(c_int8_t), intent(in), optional :: table(*)
      integer(c_int32_t), value :: triangles
      type(c_ptr), intent(inout), optional :: surface
    end function
  end interface

  public :: lap_network_csg_callback
  interface
    ! The boundary of the regions that a callback chooses; it is asked once for each region, rising.
    !
    ! user: handed to the callback. Others as for lap_network_csg.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the polygons, and the
    ! callbacks.
    integer(c_int32_t) function lap_network_csg_callback(context, network, callback, user, triangles, &
      surface) bind(c, name="lap_network_csg_callback")
      import :: c_funptr, c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: network
      type(c_funptr), value :: callback
      type(c_ptr), value :: user
      integer(c_int32_t), value :: triangles
      type(c_ptr), intent(inout), optional :: surface
    end function
  end interface

  public :: lap_arrangement_options_init
  interface
    ! Fills arrangement options with the defaults.
    !
    ! struct_size: pass (int32_t)sizeof(lap_arrangement_options); no more than that is written, so a program compiled
    ! against an older header keeps working.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
    integer(c_int32_t) function lap_arrangement_options_init(options, &
      struct_size) bind(c, name="lap_arrangement_options_init")
      import :: c_int32_t, lap_arrangement_options
      type(lap_arrangement_options), intent(inout), optional :: options
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_arrangement_new
  interface
    ! Finds the cells into which operands divide space.
    !
    ! Inputs (borrowed for the call): operands: n_operands of them; no operands, and operands without triangles, are
    ! allowed; options: or NULL for the defaults. arrangement: receives the handle, NULL after an error or cancel; free
    ! it with lap_arrangement_free. It needs neither the operands nor the context to stay alive.
    !
    ! Errors: LAP_ERR_BAD_MESH with a message that names the operand, and all defects of one kind
    ! (lap_context_last_defects): LAP_DEFECT_NON_FINITE_COORDINATE and LAP_DEFECT_INDEX_OUT_OF_RANGE (vertices and
    ! triangles count through the operands), or LAP_DEFECT_UNBALANCED_EDGE (the first hundred; the message counts them);
    ! LAP_ERR_TOO_LARGE, LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT for a negative count, LAP_ERR_CANCELLED,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: n log n in the triangles to find those that meet; some microseconds for
    ! each pair that does; else memory is touched.
    integer(c_int32_t) function lap_arrangement_new(context, n_operands, operands, options, &
      arrangement) bind(c, name="lap_arrangement_new")
      import :: c_int32_t, c_int64_t, c_ptr, lap_arrangement_options, lap_operand
      type(c_ptr), value :: context
      integer(c_int64_t), value :: n_operands
      type(lap_operand), intent(in), optional :: operands(*)
      type(lap_arrangement_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: arrangement
    end function
  end interface

  public :: lap_arrangement_new_half_spaces
  interface
    ! Finds the cells into which operands and half-spaces divide space. Half-space i is operand n_operands + i, in
    ! expressions as well.
    !
    ! Inputs (borrowed for the call): n_half_spaces, planes: 4 × n_half_spaces numbers a, b, c, d, each taken as the
    ! exact number that it is: the half-space is where a x + b y + c z + d < 0, so (a, b, c) points out of it. bounds:
    ! six numbers, the lowest and the highest corner of a box, or NULL for the box of all vertices of operands with as
    ! much room on each side as it is large. A half-space is its part within that box; farther out its winding number is
    ! 0. So what is chosen by half-spaces alone ends at the box, and what is inside a mesh that is in the box is not
    ! touched by it. Others as for lap_arrangement_new.
    !
    ! Planes may have any position: through vertices and edges, on triangles, coincident or opposite, three through a
    ! line, through the box's corners and on its sides, beside everything. As births a half-space has thirteen
    ! triangles: 0 to 11 are parts of the sides of the box, 12 is its plane. Where vertices and triangles count through
    ! the operands it counts for eight vertices (the box's corners) and thirteen triangles. In the complex of the
    ! arrangement faces on planes alone have those as supports (LAP_SUPPORT_PLANE), with the index of the half-space (of
    ! coincident planes the lowest).
    !
    ! Errors: as lap_arrangement_new; LAP_ERR_BAD_PLANE with all planes that are not finite
    ! (LAP_DEFECT_NON_FINITE_PLANE) or have no normal (LAP_DEFECT_ZERO_NORMAL); LAP_ERR_BAD_ARGUMENT for bounds that are
    ! no box (finite, the lowest corner lower in every coordinate), or NULL where operands have no vertices. Cost: as
    ! there, for each half-space a look at every vertex and triangle, and in each plane about the square of the number
    ! of planes that it meets in the box: n planes in general position make some n³ / 6 cells there, n parallel ones n
    ! + 1 and n² births.
    integer(c_int32_t) function lap_arrangement_new_half_spaces(context, n_operands, operands, n_half_spaces, planes, &
      bounds, options, arrangement) bind(c, name="lap_arrangement_new_half_spaces")
      import :: c_double, c_int32_t, c_int64_t, c_ptr, lap_arrangement_options, lap_operand
      type(c_ptr), value :: context
      integer(c_int64_t), value :: n_operands
      type(lap_operand), intent(in), optional :: operands(*)
      integer(c_int64_t), value :: n_half_spaces
      real(c_double), intent(in), optional :: planes(*)
      real(c_double), intent(in), optional :: bounds(*)
      type(lap_arrangement_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: arrangement
    end function
  end interface

  public :: lap_arrangement_free
  interface
    ! Frees an arrangement and all that was borrowed from it. NULL is allowed and does nothing. Surfaces made from it
    ! stay.
    !
    ! Errors: none.
    integer(c_int32_t) function lap_arrangement_free(arrangement) bind(c, name="lap_arrangement_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: arrangement
    end function
  end interface

  public :: lap_arrangement_counts
  interface
    ! How many elements an arrangement has. cells: the unbounded one included; intersecting_pairs: pairs of input
    ! triangles that meet outside of what they share; dropped: input triangles without area.
    !
    ! Outputs: each may be NULL. Errors: LAP_ERR_NULL_POINTER if arrangement is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_arrangement_counts(arrangement, vertices, faces, patches, cells, &
      intersecting_pairs, dropped) bind(c, name="lap_arrangement_counts")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: vertices
      integer(c_int64_t), intent(inout), optional :: faces
      integer(c_int64_t), intent(inout), optional :: patches
      integer(c_int64_t), intent(inout), optional :: cells
      integer(c_int64_t), intent(inout), optional :: intersecting_pairs
      integer(c_int64_t), intent(inout), optional :: dropped
    end function
  end interface

  public :: lap_arrangement_operands
  interface
    ! The operands of an arrangement, as they were given.
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): count; first_vertices, first_triangles: count
    ! + 1 numbers each: vertices and triangles of operand i, where they count through all operands, are from place i up
    ! to, not including, place i + 1; dropped: of each the number of triangles without area.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_arrangement_operands(arrangement, count, first_vertices, first_triangles, &
      dropped) bind(c, name="lap_arrangement_operands")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: first_vertices
      type(c_ptr), intent(inout), optional :: first_triangles
      type(c_ptr), intent(inout), optional :: dropped
    end function
  end interface

  public :: lap_arrangement_stage_count
  interface
    ! How many stages the making of the arrangement ran through.
    !
    ! Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: none.
    integer(c_int32_t) function lap_arrangement_stage_count(arrangement, &
      count) bind(c, name="lap_arrangement_stage_count")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int32_t), intent(inout), optional :: count
    end function
  end interface

  public :: lap_arrangement_stage
  interface
    ! Stage i, from 0, in the order in which they ran: its name and its time in seconds.
    !
    ! Outputs (each may be NULL). name is borrowed until the arrangement is freed.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_BAD_ARGUMENT if there is no such stage. Threads: any.
    ! Cost: none.
    integer(c_int32_t) function lap_arrangement_stage(arrangement, i, name, &
      seconds) bind(c, name="lap_arrangement_stage")
      import :: c_double, c_int32_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int32_t), value :: i
      type(c_ptr), intent(inout), optional :: name
      real(c_double), intent(inout), optional :: seconds
    end function
  end interface

  public :: lap_arrangement_vertices
  interface
    ! The vertices. No two are the same point; not all of them are corners of faces.
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): count; xyz: 3 × count coordinates, each the
    ! double nearest to the exact one (zero is +0).
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: a copy at the
    ! first call, then none.
    integer(c_int32_t) function lap_arrangement_vertices(arrangement, count, &
      xyz) bind(c, name="lap_arrangement_vertices")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: xyz
    end function
  end interface

  public :: lap_arrangement_vertex_origins
  interface
    ! What each vertex is, symbolically: LAP_VERTEX_MESH, or LAP_VERTEX_TRIANGLES; with half-spaces any but
    ! LAP_VERTEX_LEVEL, planes by the index of the half-space (of coincident ones the lowest).
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): count; kinds: count numbers LAP_VERTEX_*;
    ! ids: 3 × count, as LAP_VERTEX_* says, vertices and triangles counting through all operands (of equal vertices the
    ! first), -1 where unused.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the
    ! first call, then none.
    integer(c_int32_t) function lap_arrangement_vertex_origins(arrangement, count, kinds, &
      ids) bind(c, name="lap_arrangement_vertex_origins")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: kinds
      type(c_ptr), intent(inout), optional :: ids
    end function
  end interface

  public :: lap_arrangement_vertex_exact
  interface
    ! The exact coordinates of a vertex as canonical strings, "num/den" or "num" for an integer, in decimal. A GMP or
    ! CGAL rational reads them.
    !
    ! Outputs (each may be NULL): x, y, z: valid until the next call with this context.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for a vertex that is not there; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: some microseconds.
    integer(c_int32_t) function lap_arrangement_vertex_exact(context, arrangement, vertex, x, y, &
      z) bind(c, name="lap_arrangement_vertex_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: arrangement
      integer(c_int32_t), value :: vertex
      type(c_ptr), intent(inout), optional :: x
      type(c_ptr), intent(inout), optional :: y
      type(c_ptr), intent(inout), optional :: z
    end function
  end interface

  public :: lap_arrangement_faces
  interface
    ! The faces. Those that are whole input triangles come first, in their order, then the parts of others.
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): count; vertices: 3 × count; patches: of
    ! each, -1 where a face divides nothing; cells: 2 × count: the cell behind it, which its normal points away from,
    ! and the cell before it; -1 where it divides nothing. Seen from the tip of its normal a face runs anticlockwise.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_arrangement_faces(arrangement, count, vertices, patches, &
      cells) bind(c, name="lap_arrangement_faces")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: patches
      type(c_ptr), intent(inout), optional :: cells
    end function
  end interface

  public :: lap_arrangement_face_births
  interface
    ! The input triangles that each face is a part of.
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): count: the number of faces; offsets: count +
    ! 1; operands, triangles, reversed: those of face f are from place offsets[f] up to, not including, place offsets[f
    ! + 1]: the operand, the triangle by its place in that operand's list, and a byte, 1 where it runs against the face.
    ! They rise; the first runs like the face.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL; LAP_ERR_TOO_LARGE if they are more than 32-bit indices can
    ! number; LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear at the first call, then none.
    integer(c_int32_t) function lap_arrangement_face_births(arrangement, count, offsets, operands, triangles, &
      reversed) bind(c, name="lap_arrangement_face_births")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: operands
      type(c_ptr), intent(inout), optional :: triangles
      type(c_ptr), intent(inout), optional :: reversed
    end function
  end interface

  public :: lap_arrangement_patches
  interface
    ! The patches, numbered by their lowest faces.
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): count; faces: the lowest face of each; cells:
    ! 2 × count: behind and before that face, and so behind and before all faces of the patch (those that run the other
    ! way: before and behind); offsets: count + 1; operands, multiplicities: those of patch p are from place offsets[p]
    ! up to, not including, place offsets[p + 1]: operands, rising, and how many triangles of it run like the lowest
    ! face, less those that run against it. So much is the winding number behind higher than the one before it. Operands
    ! where that is 0 are left out.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the
    ! patches at the first call, then none.
    integer(c_int32_t) function lap_arrangement_patches(arrangement, count, faces, cells, offsets, operands, &
      multiplicities) bind(c, name="lap_arrangement_patches")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: faces
      type(c_ptr), intent(inout), optional :: cells
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: operands
      type(c_ptr), intent(inout), optional :: multiplicities
    end function
  end interface

  public :: lap_arrangement_cells
  interface
    ! The winding numbers of each cell: a sparse vector. Cell 0, the unbounded one, has none; the others are numbered by
    ! their lowest half-faces.
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): count: the number of cells; offsets: count +
    ! 1; operands, windings: those of cell c are from place offsets[c] up to, not including, place offsets[c + 1]:
    ! operands, rising, and the winding number of each; operands where it is 0 are left out.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: linear in the
    ! cells at the first call, then none.
    integer(c_int32_t) function lap_arrangement_cells(arrangement, count, offsets, operands, &
      windings) bind(c, name="lap_arrangement_cells")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: operands
      type(c_ptr), intent(inout), optional :: windings
    end function
  end interface

  public :: lap_arrangement_cell_volumes
  interface
    ! The volume of each cell, in cubed units of the input: the double nearest to the exact volume; of cell 0, the
    ! unbounded one, 0.
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): count: the number of cells; volumes: count.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: an exact sum over
    ! all faces at the first call, a microsecond for a whole triangle and some for a part of one; then none.
    integer(c_int32_t) function lap_arrangement_cell_volumes(arrangement, count, &
      volumes) bind(c, name="lap_arrangement_cell_volumes")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: volumes
    end function
  end interface

  public :: lap_arrangement_cell_volume_exact
  interface
    ! The exact volume of a cell as a canonical string, "num/den" or "num" for an integer, in decimal; of cell 0, the
    ! unbounded one, "0".
    !
    ! volume: valid until the next call with this context.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for a cell that is not there; LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: as for lap_arrangement_cell_volumes; the string grows with the number of constructed vertices
    ! on the cell's boundary.
    integer(c_int32_t) function lap_arrangement_cell_volume_exact(context, arrangement, cell, &
      volume) bind(c, name="lap_arrangement_cell_volume_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: arrangement
      integer(c_int32_t), value :: cell
      type(c_ptr), intent(inout), optional :: volume
    end function
  end interface

  public :: lap_arrangement_complex
  interface
    ! The bounded cells as a complex on which all functions for lap_complex work. Its mesh is that of all operands:
    ! vertices and triangles count through them.
    !
    ! Cell c is cell c + 1 of the arrangement, and so has the winding numbers that lap_arrangement_cells gives for that.
    ! Faces are those of the arrangement that divide, those parts of one triangle with the same births joined that only
    ! the triangulation separates: with holes, by the lowest part. A face lies on the first triangle that it is a part
    ! of (LAP_SUPPORT_TRIANGLE); there may be a cell on either of its sides, or on both. Vertices are those of the
    ! arrangement that such faces have, rising. lap_arrangement_complex_places tells which.
    !
    ! complex: borrowed until the arrangement is freed; do not free it.
    !
    ! Errors: LAP_ERR_TOO_LARGE, LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: at
    ! the first call linear in the faces, with a sort of all edges, then none. Memory: some 200 bytes a face.
    integer(c_int32_t) function lap_arrangement_complex(context, arrangement, &
      complex) bind(c, name="lap_arrangement_complex")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: arrangement
      type(c_ptr), intent(inout), optional :: complex
    end function
  end interface

  public :: lap_arrangement_complex_places
  interface
    ! Where the vertices and faces of the complex of an arrangement come from. Only after lap_arrangement_complex.
    !
    ! Outputs (each may be NULL; borrowed until the arrangement is freed): n_vertices: of the complex; vertices: for
    ! each that of the arrangement; n_faces: of the complex; offsets: n_faces + 1; faces: face f of the complex consists
    ! of the faces faces[offsets[f]] up to, not including, faces[offsets[f + 1]] of the arrangement.
    !
    ! Errors: LAP_ERR_NULL_POINTER if arrangement is NULL, LAP_ERR_BAD_ARGUMENT if there is no complex yet. Threads:
    ! any. Cost: none.
    integer(c_int32_t) function lap_arrangement_complex_places(arrangement, n_vertices, vertices, n_faces, offsets, &
      faces) bind(c, name="lap_arrangement_complex_places")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: arrangement
      integer(c_int64_t), intent(inout), optional :: n_vertices
      type(c_ptr), intent(inout), optional :: vertices
      integer(c_int64_t), intent(inout), optional :: n_faces
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: faces
    end function
  end interface

  public :: lap_arrangement_extract
  interface
    ! The surface of a boolean of all operands: solid, which is to say that its triangles meet in common vertices and
    ! edges only, no two are the same, none is without area (before coordinates are rounded), and around every edge
    ! inside and outside alternate. Any number of solids can be made from one arrangement.
    !
    ! operation: LAP_EXTRACT_*; at_least: how many operands, for LAP_EXTRACT_AT_LEAST (else it is not looked at).
    ! surface: receives the handle, NULL after an error; free it with lap_surface_free. It keeps what it needs of the
    ! arrangement, which may be freed before it.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for an operation that there is not, or at_least below 1; LAP_ERR_NULL_POINTER,
    ! LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in cells and faces.
    integer(c_int32_t) function lap_arrangement_extract(context, arrangement, operation, at_least, &
      surface) bind(c, name="lap_arrangement_extract")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: arrangement
      integer(c_int32_t), value :: operation
      integer(c_int32_t), value :: at_least
      type(c_ptr), intent(inout), optional :: surface
    end function
  end interface

  public :: lap_arrangement_extract_expression
  interface
    ! The surface of the cells that a boolean expression over the operands takes.
    !
    ! expression: text, borrowed for the call, such as "(0 | 1) & !2". A number stands for "inside that operand", from
    ! 0; ! is not, & and, - and not, ^ one but not both, | or: & and - (as strong as one another, from left to right)
    ! before ^ before |; brackets; true and false. Spaces are free. Others as for lap_arrangement_extract.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT with a message that names the first character that does not fit or the operand that
    ! there is not, or if the expression takes in the unbounded cell; LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the faces, and the cells times the expression.
    integer(c_int32_t) function lap_arrangement_extract_expression(context, arrangement, expression, &
      surface) bind(c, name="lap_arrangement_extract_expression")
      import :: c_char, c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: arrangement
      character(kind=c_char), intent(in), optional :: expression(*)
      type(c_ptr), intent(inout), optional :: surface
    end function
  end interface

  public :: lap_arrangement_extract_table
  interface
    ! The surface of the cells that a table takes.
    !
    ! table: n_cells bytes, borrowed for the call, nonzero for each cell that is taken; the first, of the unbounded
    ! cell, is 0; n_cells: as many as the arrangement has. Others as for lap_arrangement_extract.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for a table of another length, or one that takes in the unbounded cell;
    ! LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the faces.
    integer(c_int32_t) function lap_arrangement_extract_table(context, arrangement, n_cells, table, &
      surface) bind(c, name="lap_arrangement_extract_table")
      import :: c_int32_t, c_int64_t, c_int8_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: arrangement
      integer(c_int64_t), value :: n_cells
      integer(c_int8_t), intent(in), optional :: table(*)
      type(c_ptr), intent(inout), optional :: surface
    end function
  end interface

  public :: lap_arrangement_extract_callback
  interface
    ! The surface of the cells that a callback takes; it is asked once for each cell, rising, the unbounded one (number
    ! 0, which it must not take) included.
    !
    ! user: handed to the callback. Others as for lap_arrangement_extract.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT if the unbounded cell is taken; LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: linear in the faces, and in cells times operands, and the callbacks.
    integer(c_int32_t) function lap_arrangement_extract_callback(context, arrangement, callback, user, &
      surface) bind(c, name="lap_arrangement_extract_callback")
      import :: c_funptr, c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: arrangement
      type(c_funptr), value :: callback
      type(c_ptr), value :: user
      type(c_ptr), intent(inout), optional :: surface
    end function
  end interface

  public :: lap_surface_free
  interface
    ! Frees a surface and all that was borrowed from it. NULL is allowed and does nothing.
    !
    ! Errors: none.
    integer(c_int32_t) function lap_surface_free(surface) bind(c, name="lap_surface_free")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: surface
    end function
  end interface

  public :: lap_surface_vertices
  interface
    ! The vertices of a surface.
    !
    ! Outputs (each may be NULL; borrowed until the surface is freed): count; xyz: 3 × count coordinates, each the
    ! double nearest to the exact one (unless certified, see lap_surface_certify); sources: the vertex of the network or
    ! of the arrangement that each is, rising.
    !
    ! Errors: LAP_ERR_NULL_POINTER if surface is NULL. Threads: any. Cost: none.
    integer(c_int32_t) function lap_surface_vertices(surface, count, xyz, sources) bind(c, name="lap_surface_vertices")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: surface
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: xyz
      type(c_ptr), intent(inout), optional :: sources
    end function
  end interface

  public :: lap_surface_polygons
  interface
    ! The polygons of a surface, convex; of an arrangement, or if a network's was made so, triangles.
    !
    ! Outputs (each may be NULL; borrowed until the surface is freed): count; offsets: count + 1; vertices: those of
    ! polygon p are vertices[offsets[p]] up to, not including, vertices[offsets[p + 1]], anticlockwise seen from outside
    ! the solid (in two dimensions: the solid is on the right of the way from the first to the second), as places in
    ! lap_surface_vertices; births: the polygon of the network, or the face of the arrangement, that each comes from,
    ! rising (unless certified); flipped: a byte for each, 1 where it runs against that one.
    !
    ! Errors: LAP_ERR_NULL_POINTER if surface is NULL. Threads: any. Cost: none; the offsets of triangles are filled at
    ! the first call.
    integer(c_int32_t) function lap_surface_polygons(surface, count, offsets, vertices, births, &
      flipped) bind(c, name="lap_surface_polygons")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: surface
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: offsets
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: births
      type(c_ptr), intent(inout), optional :: flipped
    end function
  end interface

  public :: lap_surface_triangles
  interface
    ! The triangles of an arrangement's surface, and the input triangles that they are parts of.
    !
    ! Outputs (each may be NULL; borrowed until the surface is freed): count; vertices: 3 × count places in
    ! lap_surface_vertices, anticlockwise seen from outside the solid; operands, triangles: of each the operand, and the
    ! triangle by its place in that operand's list, of several that lie there the first whose operand's winding number
    ! changes; flipped: a byte for each, 1 where it runs against that triangle.
    !
    ! Errors: LAP_ERR_NULL_POINTER if surface is NULL; LAP_ERR_BAD_ARGUMENT for the surface of a network. Threads: any.
    ! Cost: none.
    integer(c_int32_t) function lap_surface_triangles(surface, count, vertices, operands, triangles, &
      flipped) bind(c, name="lap_surface_triangles")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: surface
      integer(c_int64_t), intent(inout), optional :: count
      type(c_ptr), intent(inout), optional :: vertices
      type(c_ptr), intent(inout), optional :: operands
      type(c_ptr), intent(inout), optional :: triangles
      type(c_ptr), intent(inout), optional :: flipped
    end function
  end interface

  public :: lap_surface_euler
  interface
    ! The Euler characteristic of a surface: vertices - edges + polygons (in two dimensions: vertices - segments). Of a
    ! sphere 2, of a torus 0; where parts touch in a vertex or an edge, that counts once.
    !
    ! Errors: LAP_ERR_NULL_POINTER, LAP_ERR_OUT_OF_MEMORY. Threads: any. Cost: a sort of all edges at the first call,
    ! then none.
    integer(c_int32_t) function lap_surface_euler(surface, euler) bind(c, name="lap_surface_euler")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: surface
      integer(c_int64_t), intent(inout), optional :: euler
    end function
  end interface

  public :: lap_surface_volume
  interface
    ! The volume of the solid that an arrangement's surface bounds, in cubed units of the input: the double nearest to
    ! the exact volume (of the exact vertices, not of the rounded ones; of a certified surface, of its own).
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for the surface of a network; LAP_ERR_OUT_OF_MEMORY. Threads:
    ! any. Cost: an exact sum over the triangles at the first call, some microseconds for each that a cut input triangle
    ! was divided into; then none.
    integer(c_int32_t) function lap_surface_volume(surface, volume) bind(c, name="lap_surface_volume")
      import :: c_double, c_int32_t, c_ptr
      type(c_ptr), value :: surface
      real(c_double), intent(inout), optional :: volume
    end function
  end interface

  public :: lap_surface_volume_exact
  interface
    ! The exact volume of the solid that an arrangement's surface bounds as a canonical string, "num/den" or "num" for
    ! an integer, in decimal.
    !
    ! volume: valid until the next call with this context. A GMP or CGAL rational reads it.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for the surface of a network; LAP_ERR_OUT_OF_MEMORY,
    ! LAP_ERR_BUSY. Cost: as for lap_surface_volume; the string grows with the number of constructed vertices.
    integer(c_int32_t) function lap_surface_volume_exact(context, surface, &
      volume) bind(c, name="lap_surface_volume_exact")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: surface
      type(c_ptr), intent(inout), optional :: volume
    end function
  end interface

  public :: lap_surface_complex
  interface
    ! The solid that an arrangement's surface bounds as a complex, as lap_arrangement_complex: a cell for each part that
    ! is connected across faces, of which the cells of the arrangement that were chosen are joined.
    !
    ! complex: borrowed until the surface is freed; do not free it.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for the surface of a network and for a certified one (as an operand it makes an
    ! arrangement that has its cells); LAP_ERR_TOO_LARGE, LAP_ERR_NULL_POINTER, LAP_ERR_CANCELLED,
    ! LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. Cost: as there.
    integer(c_int32_t) function lap_surface_complex(context, surface, complex) bind(c, name="lap_surface_complex")
      import :: c_int32_t, c_ptr
      type(c_ptr), value :: context
      type(c_ptr), value :: surface
      type(c_ptr), intent(inout), optional :: complex
    end function
  end interface

  public :: lap_surface_certify_options_init
  interface
    ! Fills options of lap_surface_certify with the defaults.
    !
    ! struct_size: pass (int32_t)sizeof(lap_surface_certify_options); no more than that is written.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT if the size is not a multiple of 4 in 4..4096.
    integer(c_int32_t) function lap_surface_certify_options_init(options, &
      struct_size) bind(c, name="lap_surface_certify_options_init")
      import :: c_int32_t, lap_surface_certify_options
      type(lap_surface_certify_options), intent(inout), optional :: options
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_surface_certify
  interface
    ! Makes of an arrangement's surface one that is solid on its doubles: no triangle is without area, no two meet but
    ! in a vertex or an edge that they share by index, every place is one vertex, and every point is wound around once
    ! or not at all. All of that is checked exactly, and repaired where rounding broke it; whether it holds is in the
    ! report. A certified surface can go straight into the next lap_arrangement_new: its coordinates and triangles as
    ! they are are the operand.
    !
    ! Repair goes in rounds: the rounded surface is arranged exactly, what it winds around in the positive sense is
    ! kept, and vertices made by that are rounded. From the second round on, vertices, edges and triangles that meet are
    ! made to share vertices within few units first, and cells hardly thicker than a unit go. So parts that are thinner
    ! than doubles can tell may vanish. Where nothing has to be repaired the result has the same vertices and triangles
    ! as the surface, in the same order but for vertices at one place.
    !
    ! Inputs: surface: of an arrangement, or certified already; it stays as it is; options: or NULL for the defaults.
    ! certified: receives the handle, NULL after an error or cancel; free it with lap_surface_free. It keeps nothing of
    ! the surface or of the arrangement. Of it lap_surface_vertices tells in sources the lowest vertex of the
    ! arrangement whose rounded coordinates those are, -1 for one at another place; lap_surface_polygons and
    ! lap_surface_triangles tell the face and the input triangle that each is a part of, but for rounding (not rising
    ! any more), and whether it runs against these; lap_surface_volume and lap_surface_volume_exact are of the doubles
    ! as they are.
    !
    ! Errors: LAP_ERR_BAD_ARGUMENT for the surface of a network and for options that there are not,
    ! LAP_ERR_NULL_POINTER, LAP_ERR_TOO_LARGE, LAP_ERR_CANCELLED, LAP_ERR_OUT_OF_MEMORY, LAP_ERR_BUSY. That something
    ! remains uncertified is no error. Cost: an arrangement of the surface for each round.
    integer(c_int32_t) function lap_surface_certify(context, surface, options, &
      certified) bind(c, name="lap_surface_certify")
      import :: c_int32_t, c_ptr, lap_surface_certify_options
      type(c_ptr), value :: context
      type(c_ptr), value :: surface
      type(lap_surface_certify_options), intent(in), optional :: options
      type(c_ptr), intent(inout), optional :: certified
    end function
  end interface

  public :: lap_surface_certified_report
  interface
    ! The report of a certified surface.
    !
    ! report: written; struct_size: pass (int32_t)sizeof(lap_surface_certify_report); no more than that is written.
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for a surface that lap_surface_certify did not make, and if the
    ! size is not a multiple of 4 in 4..4096. Threads: any. Cost: none.
    integer(c_int32_t) function lap_surface_certified_report(certified, report, &
      struct_size) bind(c, name="lap_surface_certified_report")
      import :: c_int32_t, c_ptr, lap_surface_certify_report
      type(c_ptr), value :: certified
      type(lap_surface_certify_report), intent(inout), optional :: report
      integer(c_int32_t), value :: struct_size
    end function
  end interface

  public :: lap_surface_certified_open
  interface
    ! What remains uncertified, in numbers of the triangles of the certified surface.
    !
    ! Outputs (each may be NULL; borrowed until the surface is freed): n_pairs; pairs: 2 × n_pairs triangles that meet,
    ! the lower first; twice the same one for a triangle without area. At most 65536 are listed. None for a certified
    ! result, nor for one whose triangles meet nowhere but wind around something in another sense than once (only with
    ! check_only).
    !
    ! Errors: LAP_ERR_NULL_POINTER; LAP_ERR_BAD_ARGUMENT for a surface that lap_surface_certify did not make. Threads:
    ! any. Cost: none.
    integer(c_int32_t) function lap_surface_certified_open(certified, n_pairs, &
      pairs) bind(c, name="lap_surface_certified_open")
      import :: c_int32_t, c_int64_t, c_ptr
      type(c_ptr), value :: certified
      integer(c_int64_t), intent(inout), optional :: n_pairs
      type(c_ptr), intent(inout), optional :: pairs
    end function
  end interface

contains

  function lap_text(address) result(text)
    type(c_ptr), intent(in) :: address
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer :: i, length
    interface
      function strlen(s) bind(c, name="strlen") result(length)
        import :: c_ptr, c_size_t
        type(c_ptr), value :: s
        integer(c_size_t) :: length
      end function
    end interface
    length = 0
    if (c_associated(address)) length = int(strlen(address))
    allocate (character(len=length) :: text)
    if (length == 0) return
    call c_f_pointer(address, letters, [length])
    do i = 1, length
      text(i:i) = letters(i)
    end do
  end function

  subroutine view_int8(address, count, view)
    type(c_ptr), intent(in) :: address
    integer(c_int64_t), intent(in) :: count
    integer(c_int8_t), pointer, intent(out) :: view(:)
    view => no_int8
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [count])
  end subroutine

  subroutine view_int32(address, count, view)
    type(c_ptr), intent(in) :: address
    integer(c_int64_t), intent(in) :: count
    integer(c_int32_t), pointer, intent(out) :: view(:)
    view => no_int32
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [count])
  end subroutine

  subroutine columns_int32(address, rows, count, view)
    type(c_ptr), intent(in) :: address
    integer, intent(in) :: rows
    integer(c_int64_t), intent(in) :: count
    integer(c_int32_t), pointer, intent(out) :: view(:, :)
    view(1:rows, 1:0) => no_int32
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [int(rows, c_int64_t), count])
  end subroutine

  subroutine view_int64(address, count, view)
    type(c_ptr), intent(in) :: address
    integer(c_int64_t), intent(in) :: count
    integer(c_int64_t), pointer, intent(out) :: view(:)
    view => no_int64
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [count])
  end subroutine

  subroutine columns_int64(address, rows, count, view)
    type(c_ptr), intent(in) :: address
    integer, intent(in) :: rows
    integer(c_int64_t), intent(in) :: count
    integer(c_int64_t), pointer, intent(out) :: view(:, :)
    view(1:rows, 1:0) => no_int64
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [int(rows, c_int64_t), count])
  end subroutine

  subroutine view_double(address, count, view)
    type(c_ptr), intent(in) :: address
    integer(c_int64_t), intent(in) :: count
    real(c_double), pointer, intent(out) :: view(:)
    view => no_double
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [count])
  end subroutine

  subroutine columns_double(address, rows, count, view)
    type(c_ptr), intent(in) :: address
    integer, intent(in) :: rows
    integer(c_int64_t), intent(in) :: count
    real(c_double), pointer, intent(out) :: view(:, :)
    view(1:rows, 1:0) => no_double
    if (c_associated(address) .and. count > 0) call c_f_pointer(address, view, [int(rows, c_int64_t), count])
  end subroutine
end module

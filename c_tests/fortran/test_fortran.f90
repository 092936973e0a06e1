! The Fortran module: makes a mesh, cuts it, reads every kind of view, takes the error path, counts callbacks.
module checks
  use, intrinsic :: iso_c_binding
  use lapidary
  implicit none
  integer :: failures = 0, total = 0
  ! What the callbacks have seen.
  real(c_double) :: last_fraction = -1
  integer :: calls = 0, messages = 0

contains

  subroutine check(holds, what)
    logical, intent(in) :: holds
    character(len=*), intent(in) :: what
    total = total + 1
    if (holds) return
    failures = failures + 1
    print '(2a)', "does not hold: ", what
  end subroutine

  subroutine ok(status, what)
    integer(c_int32_t), intent(in) :: status
    character(len=*), intent(in) :: what
    call check(status == LAP_OK, what // " succeeds")
  end subroutine

  ! Stops the call in its second half if user points to a number that is not 0.
  integer(c_int32_t) function progress(user, stage, fraction) bind(c)
    type(c_ptr), value :: user, stage
    real(c_double), value :: fraction
    integer(c_int32_t), pointer :: stop_it
    call c_f_pointer(user, stop_it)
    calls = calls + 1
    call check(fraction >= last_fraction .and. fraction <= 1, "fractions rise")
    call check(len(lap_text(stage)) > 0, "a stage has a name")
    last_fraction = fraction
    progress = 0
    if (fraction > 0.5) progress = stop_it
  end function

  subroutine log(user, level, message) bind(c)
    type(c_ptr), value :: user, message
    integer(c_int32_t), value :: level
    call check(.not. c_associated(user), "no user pointer for the log")
    call check(level == LAP_LOG_INFO, "the level of a log message")
    call check(len(lap_text(message)) > 0, "a log message")
    messages = messages + 1
  end subroutine

  ! The cells inside an even number of operands, the unbounded one left out.
  integer(c_int32_t) function inside_both(user, cell, n_operands, winding) bind(c)
    type(c_ptr), value :: user, winding
    integer(c_int32_t), value :: cell
    integer(c_int64_t), value :: n_operands
    integer(c_int32_t), pointer :: numbers(:)
    call check(.not. c_associated(user), "no user pointer for the choice")
    call lap_view(winding, n_operands, numbers)
    inside_both = merge(1, 0, cell > 0 .and. mod(count(numbers > 0), 2) == 0)
  end function
end module

program test_fortran
  use, intrinsic :: iso_c_binding
  use lapidary
  use checks
  implicit none

  ! A cube [0, 2]^3, anticlockwise from outside; tags: its sides.
  real(c_double), parameter :: cube(3, 8) = reshape(real( &
    [0, 0, 0, 2, 0, 0, 0, 2, 0, 2, 2, 0, 0, 0, 2, 2, 0, 2, 0, 2, 2, 2, 2, 2], c_double), [3, 8])
  integer(c_int32_t), parameter :: triangles(3, 12) = reshape(int( &
    [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5], &
    c_int32_t), [3, 12])
  integer(c_int32_t) :: tags(12)
  type(c_ptr) :: context, mesh

  tags = [10, 10, 11, 11, 12, 12, 13, 13, 14, 14, 15, 15]
  context = c_null_ptr
  mesh = c_null_ptr
  call versions()
  call ok(lap_context_new(context), "lap_context_new")
  call ok(lap_mesh_new(context, 8_c_int64_t, cube, 12_c_int64_t, triangles, tags, mesh=mesh), "lap_mesh_new")
  call mesh_views()
  call cut_views()
  call boxes()
  call errors()
  call callbacks()
  call booleans()
  call ok(lap_mesh_free(mesh), "lap_mesh_free")
  call ok(lap_mesh_free(c_null_ptr), "lap_mesh_free of NULL")
  call ok(lap_context_free(context), "lap_context_free")
  print '(i0, a, i0, a)', total, " checks, ", failures, " failures"
  if (failures > 0 .or. total == 0) stop 1, quiet=.true.

contains

  subroutine versions()
    integer(c_int32_t) :: major, minor, patch
    type(c_ptr) :: text
    character(len=40) :: joined
    text = c_null_ptr
    major = -1
    minor = -1
    patch = -1
    call ok(lap_version(major, minor, patch, text), "lap_version")
    write (joined, '(i0, ".", i0, ".", i0)') major, minor, patch
    call check(lap_text(text) == trim(joined), "the version is its three numbers")
    call ok(lap_version(), "lap_version without outputs")
    call ok(lap_status_name(LAP_ERR_BAD_MESH, text), "lap_status_name")
    call check(lap_text(text) == "LAP_ERR_BAD_MESH", "the name of a status")
    call check(lap_text(c_null_ptr) == "", "no text")
  end subroutine

  subroutine mesh_views()
    integer(c_int64_t) :: vertices, faces, count, euler
    real(c_double) :: volume
    real(c_double), pointer :: bounds(:), xyz(:, :)
    type(c_ptr) :: address
    address = c_null_ptr
    call ok(lap_mesh_counts(mesh, vertices=vertices, triangles=faces), "lap_mesh_counts")
    call check(vertices == 8 .and. faces == 12, "counts of the mesh")
    call ok(lap_mesh_bounds(mesh, address), "lap_mesh_bounds")
    call lap_view(address, 6_c_int64_t, bounds)
    call check(all(bounds == [0, 0, 0, 2, 2, 2]), "bounds")
    call ok(lap_mesh_vertices(mesh, count, xyz=address), "lap_mesh_vertices")
    call lap_view(address, 3, count, xyz)
    call check(all(shape(xyz) == [3, 8]), "shape of xyz")
    call check(all(xyz == cube), "coordinates of the mesh")
    call ok(lap_mesh_volume(mesh, volume), "lap_mesh_volume")
    call check(volume == 8, "the volume of the mesh")
    call ok(lap_mesh_euler(mesh, euler), "lap_mesh_euler")
    call check(euler == 1, "a ball")
    call ok(lap_mesh_volume_exact(context, mesh, address), "lap_mesh_volume_exact")
    call check(lap_text(address) == "8", "the exact volume as text")
  end subroutine

  ! x = 1 and y = 1/2: cells of 1, 1, 3 and 3.
  subroutine cut_views()
    real(c_double), parameter :: planes(4, 2) = reshape([1d0, 0d0, 0d0, -1d0, 0d0, 2d0, 0d0, -1d0], [4, 2])
    type(lap_cut_options) :: options
    type(c_ptr) :: cut, complex, a, b, c
    integer(c_int64_t) :: count, vertices, faces, cells, n
    integer(c_int32_t) :: side, cell, corner, face
    real(c_double), pointer :: volumes(:), centroids(:, :), xyz(:, :)
    integer(c_int32_t), pointer :: offsets(:), corners(:), of_faces(:), sides(:, :), tag(:)
    integer(c_int64_t), pointer :: keys(:, :)
    integer(c_int8_t), pointer :: flags(:)
    real(c_double) :: area(3), sum_of_areas
    cut = c_null_ptr
    complex = c_null_ptr
    a = c_null_ptr
    b = c_null_ptr
    c = c_null_ptr
    call ok(lap_cut_options_init(options, int(c_sizeof(options), c_int32_t)), "lap_cut_options_init")
    call check(options%struct_size == c_sizeof(options) .and. options%check == 0, "default options")
    options%check = 1
    call ok(lap_cut_new(context, mesh, 2_c_int64_t, planes, options, cut), "lap_cut_new")
    call ok(lap_cut_complex(cut, complex), "lap_cut_complex")
    call ok(lap_complex_counts(complex, vertices=vertices, faces=faces, cells=cells), "lap_complex_counts")
    call check(cells == 4, "four cells")

    call ok(lap_complex_cell_moments(complex, count, a, b, c), "lap_complex_cell_moments")
    call lap_view(a, count, volumes)
    call lap_view(b, 3, count, centroids)
    call lap_view(c, count, flags)
    call check(count == 4 .and. size(volumes) == 4 .and. all(shape(centroids) == [3, 4]), "sizes of the moments")
    call check(sum(volumes) == 8 .and. minval(volumes) == 1 .and. maxval(volumes) == 3, "volumes")
    call check(all(centroids(3, :) == 1) .and. all(flags == 0), "centroids and flags")
    do cell = 0, 3
      call ok(lap_complex_cell_side(complex, cell, 1_c_int32_t, side), "lap_complex_cell_side")
      call check(merge(3d0, 1d0, side > 0) == volumes(cell + 1), "the large cells are beyond y = 1/2")
      call check(merge(1.25d0, 0.25d0, side > 0) == centroids(2, cell + 1), "and so are their centroids")
    end do

    ! Rows of a CSR pair, ids as indices from 0: the areas of the triangles on the input's sides add up.
    call ok(lap_complex_vertices(complex, count, a), "lap_complex_vertices")
    call lap_view(a, 3, count, xyz)
    xyz(1:, 0:) => xyz
    call check(count == vertices .and. all(xyz(:, 0:7) == cube), "the mesh's vertices come first")
    call ok(lap_complex_face_supports(complex, count, tags=a), "lap_complex_face_supports")
    call lap_view(a, count, tag)
    tag(0:) => tag
    call ok(lap_complex_polygons(complex, LAP_FACES_TRIANGLES, count, a, b, c), "lap_complex_polygons")
    call lap_view(a, count + 1, offsets)
    offsets(0:) => offsets
    call lap_view(b, int(offsets(count), c_int64_t), corners)
    call lap_view(c, count, of_faces)
    sum_of_areas = 0
    do n = 0, count - 1
      associate (row => corners(offsets(n) + 1:offsets(n + 1)))
        call check(size(row) == 3, "a triangle has three corners")
        if (tag(of_faces(n + 1)) == 0) cycle
        area = cross(xyz(:, row(2)) - xyz(:, row(1)), xyz(:, row(3)) - xyz(:, row(1)))
        sum_of_areas = sum_of_areas + norm2(area) / 2
      end associate
    end do
    call check(abs(sum_of_areas - 24) < 1d-12, "the area of the cube")

    call ok(lap_complex_face_cells(complex, count, a), "lap_complex_face_cells")
    call lap_view(a, 2, count, sides)
    call check(count == faces .and. minval(sides(1, :)) == 0 .and. minval(sides(2, :)) == -1, "cells of the faces")

    call ok(lap_complex_vertex_keys(complex, count, a), "lap_complex_vertex_keys")
    call lap_view(a, 2, count, keys)
    call check(count == vertices .and. all(keys(1, :) >= 0), "keys")
    do n = 2, count
      do corner = 1, int(n) - 1
        if (all(keys(:, corner) == keys(:, n))) call check(.false., "keys differ")
      end do
    end do
    do face = 0, 1
      call ok(lap_complex_cell_volume_exact(context, complex, face, a), "lap_complex_cell_volume_exact")
      call check(index(" 1 3 ", " " // lap_text(a) // " ") > 0, "exact volumes")
    end do
    call ok(lap_cut_free(cut), "lap_cut_free")
  end subroutine

  function cross(u, v) result(w)
    real(c_double), intent(in) :: u(3), v(3)
    real(c_double) :: w(3)
    w = [u(2) * v(3) - u(3) * v(2), u(3) * v(1) - u(1) * v(3), u(1) * v(2) - u(2) * v(1)]
  end function

  ! Fluid outside the cube: of 27 boxes the middle one is empty, the others are cut.
  subroutine boxes()
    real(c_double), parameter :: nodes(4) = [-1d0, 0.5d0, 1.5d0, 3d0]
    type(lap_grid_options) :: options
    type(c_ptr) :: grid, a, b
    integer(c_int64_t) :: empty, full, cells, count
    integer(c_int8_t), pointer :: flags(:, :, :)
    real(c_double), pointer :: volumes(:), fractions(:)
    grid = c_null_ptr
    a = c_null_ptr
    b = c_null_ptr
    call ok(lap_grid_options_init(options, int(c_sizeof(options), c_int32_t)), "lap_grid_options_init")
    call check(options%struct_size == c_sizeof(options), "the size of the grid's options")
    call check(all(options%block_low == 0) .and. all(options%block_high == -1), "default block")
    call check(options%known == LAP_NODE_UNKNOWN, "no known node")
    options%outside = 1
    call ok(lap_grid_new(context, mesh, 4_c_int64_t, nodes, 4_c_int64_t, nodes, 4_c_int64_t, nodes, options, grid), &
      "lap_grid_new")
    call ok(lap_grid_counts(grid, empty=empty, full=full, cells=cells), "lap_grid_counts")
    call check(empty == 1 .and. full == 0 .and. cells == 26, "counts of boxes and cells")
    call ok(lap_grid_flags(grid, count, a), "lap_grid_flags")
    call check(count == 27, "a flag per box")
    call c_f_pointer(a, flags, [3, 3, 3])
    call check(flags(2, 2, 2) == LAP_BOX_EMPTY .and. flags(1, 2, 3) == LAP_BOX_CUT, "flags by i, j, k")
    call ok(lap_grid_cell_moments(grid, count, a, b), "lap_grid_cell_moments")
    call lap_view(a, count, volumes)
    call lap_view(b, count, fractions)
    call check(count == 26 .and. sum(volumes) == 64 - 8, "the volume around the cube")
    call check(all(fractions > 0 .and. fractions < 1), "fractions")
    call ok(lap_grid_free(grid), "lap_grid_free")
  end subroutine

  subroutine errors()
    real(c_double), parameter :: planes(4, 2) = reshape([1d0, 0d0, 0d0, -1d0, 0d0, 0d0, 0d0, 1d0], [4, 2])
    integer(c_int32_t) :: status, kept
    integer(c_int64_t) :: count
    type(c_ptr) :: cut, message, a, b
    integer(c_int32_t), pointer :: kinds(:)
    integer(c_int64_t), pointer :: ids(:, :)
    real(c_double), pointer :: nothing(:, :)
    cut = context
    message = c_null_ptr
    a = c_null_ptr
    b = c_null_ptr
    status = lap_cut_new(context, mesh, 2_c_int64_t, planes, cut=cut)
    call check(status == LAP_ERR_BAD_PLANE, "a plane without a normal is refused")
    call check(.not. c_associated(cut), "there is no cut")
    call ok(lap_context_last_error(context, kept, message), "lap_context_last_error")
    call check(kept == LAP_ERR_BAD_PLANE, "the status is kept")
    call check(index(lap_text(message), "plane 1") > 0, "the message names the plane")
    call ok(lap_context_last_defects(context, count, a, b), "lap_context_last_defects")
    call lap_view(a, count, kinds)
    call lap_view(b, 3, count, ids)
    call check(count == 1 .and. all(kinds == LAP_DEFECT_ZERO_NORMAL), "the kind of the defect")
    call check(all(ids(:, 1) == [1, -1, -1]), "the plane of the defect")
    call check(lap_cut_new(context, mesh, 2_c_int64_t, cut=cut) == LAP_ERR_NULL_POINTER, "an absent array is NULL")
    call check(lap_cut_new(c_null_ptr, mesh, 2_c_int64_t, planes, cut=cut) == LAP_ERR_NULL_POINTER, "no context")
    call lap_view(c_null_ptr, 3, 0_c_int64_t, nothing)
    call check(all(shape(nothing) == [3, 0]), "a view of nothing")
  end subroutine

  subroutine callbacks()
    real(c_double), parameter :: plane(4) = [1d0, 1d0, 1d0, -2d0]
    integer(c_int32_t), target :: stop_it
    type(c_ptr) :: cut
    cut = c_null_ptr
    stop_it = 0
    call ok(lap_context_set_progress(context, c_funloc(progress), c_loc(stop_it)), "lap_context_set_progress")
    call ok(lap_context_set_log(context, c_funloc(log), c_null_ptr), "lap_context_set_log")
    call ok(lap_cut_new(context, mesh, 1_c_int64_t, plane, cut=cut), "lap_cut_new with callbacks")
    call check(calls > 2 .and. last_fraction > 0.9d0, "progress to the end")
    call ok(lap_cut_free(cut), "lap_cut_free")
    stop_it = 1
    last_fraction = -1
    call check(lap_cut_new(context, mesh, 1_c_int64_t, plane, cut=cut) == LAP_ERR_CANCELLED, "cancelled")
    call check(.not. c_associated(cut) .and. last_fraction < 1, "nothing is left of a cancelled call")
    call ok(lap_context_set_progress(context, c_null_funptr, c_null_ptr), "no progress")
    call ok(lap_context_set_log(context, c_null_funptr, c_null_ptr), "no log")
  end subroutine

  ! The cube, and the same moved by 1 along every axis.
  subroutine booleans()
    real(c_double), target :: xyz(3, 8), moved(3, 8)
    integer(c_int32_t), target :: corners(3, 12)
    type(lap_operand) :: operands(2)
    type(lap_arrangement_options) :: options
    type(lap_surface_certify_report) :: report
    type(c_ptr) :: arrangement, surface, certified, text, offsets, numbers
    integer(c_int64_t) :: cells, count, triangles_there
    integer(c_int32_t), pointer :: rows(:)
    real(c_double) :: volume
    arrangement = c_null_ptr
    surface = c_null_ptr
    certified = c_null_ptr
    text = c_null_ptr
    offsets = c_null_ptr
    numbers = c_null_ptr
    xyz = cube
    moved = cube + 1
    corners = triangles
    operands%n_vertices = 8
    operands%n_triangles = 12
    operands(1)%xyz = c_loc(xyz)
    operands(2)%xyz = c_loc(moved)
    operands(1)%indices = c_loc(corners)
    operands(2)%indices = c_loc(corners)
    call ok(lap_arrangement_options_init(options, int(c_sizeof(options), c_int32_t)), "lap_arrangement_options_init")
    call ok(lap_arrangement_new(context, 2_c_int64_t, operands, options, arrangement), "lap_arrangement_new")
    call ok(lap_arrangement_counts(arrangement, cells=cells), "lap_arrangement_counts")
    call check(cells == 4, "the cells of two cubes")
    call ok(lap_arrangement_cells(arrangement, count, offsets, windings=numbers), "lap_arrangement_cells")
    call lap_view(offsets, count + 1, rows)
    call check(rows(5) == 4, "winding numbers")
    call lap_view(numbers, 4_c_int64_t, rows)
    call check(all(rows == 1), "are all 1")
    call ok(lap_arrangement_extract(context, arrangement, LAP_EXTRACT_UNION, 0, surface), "lap_arrangement_extract")
    call ok(lap_surface_volume(surface, volume), "lap_surface_volume")
    call check(volume == 15, "the volume of the union")
    call ok(lap_surface_certify(context, surface, certified=certified), "lap_surface_certify")
    call ok(lap_surface_certified_report(certified, report, int(c_sizeof(report), c_int32_t)), "lap_surface_certified_report")
    call check(report%certified == 1 .and. report%contacts_before == 0, "a certified union")
    call ok(lap_surface_volume(certified, volume), "its volume")
    call check(volume == 15, "the volume of the certified union")
    call ok(lap_surface_free(certified), "lap_surface_free")
    call ok(lap_surface_free(surface), "lap_surface_free")
    call ok(lap_arrangement_extract_expression(context, arrangement, "0 - 1" // c_null_char, surface), "an expression")
    call ok(lap_surface_volume_exact(context, surface, text), "lap_surface_volume_exact")
    call check(lap_text(text) == "7", "the volume of the difference")
    call ok(lap_surface_free(surface), "lap_surface_free")
    call ok(lap_arrangement_extract_callback(context, arrangement, c_funloc(inside_both), c_null_ptr, surface), "a callback")
    call ok(lap_surface_triangles(surface, triangles_there), "lap_surface_triangles")
    call ok(lap_surface_volume(surface, volume), "lap_surface_volume")
    call check(triangles_there > 0 .and. volume == 1, "the volume of the intersection")
    call ok(lap_surface_free(surface), "lap_surface_free")
    call ok(lap_arrangement_free(arrangement), "lap_arrangement_free")
  end subroutine
end program

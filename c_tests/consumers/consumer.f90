! The smallest Fortran host: cuts a tetrahedron by one plane and counts the cells. Exit status 0: as expected.
program consumer
  use, intrinsic :: iso_c_binding
  use lapidary
  implicit none
  real(c_double), parameter :: xyz(3, 4) = reshape([0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 0d0, 1d0], [3, 4])
  integer(c_int32_t), parameter :: triangles(3, 4) = reshape([0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3], [3, 4])
  real(c_double), parameter :: plane(4) = [1d0, 1d0, 1d0, -0.5d0]
  type(c_ptr) :: context = c_null_ptr, mesh = c_null_ptr, cut = c_null_ptr, complex = c_null_ptr, text = c_null_ptr
  integer(c_int64_t) :: cells = 0
  integer(c_int32_t) :: status, freed

  status = lap_version(text=text)
  if (status == LAP_OK) status = lap_context_new(context)
  if (status == LAP_OK) status = lap_mesh_new(context, 4_c_int64_t, xyz, 4_c_int64_t, triangles, mesh=mesh)
  if (status == LAP_OK) status = lap_cut_new(context, mesh, 1_c_int64_t, plane, cut=cut)
  if (status == LAP_OK) status = lap_cut_complex(cut, complex)
  if (status == LAP_OK) status = lap_complex_counts(complex, cells=cells)
  print '(3a, i0, a, i0, a)', "lapidary ", lap_text(text), ": status ", status, ", ", cells, " cells"
  freed = lap_cut_free(cut)
  freed = lap_mesh_free(mesh)
  freed = lap_context_free(context)
  if (status /= LAP_OK .or. cells /= 2) stop 1
end program

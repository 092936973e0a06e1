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

! @GENERATED@

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
! @VIEWS@
end module

# Runs cargo and gives the result as two imported targets.
#
# Cargo knows what is out of date, CMake does not: `lapidary_cargo` therefore runs at every build (a fraction of a
# second when nothing changed), and the copies below change only when the library did, so that nothing relinks in vain.

find_program(LAPIDARY_CARGO cargo HINTS "$ENV{CARGO_HOME}/bin" "$ENV{HOME}/.cargo/bin" REQUIRED
             DOC "cargo, which builds the library")

if(DEFINED ENV{CARGO_TARGET_DIR})
  set(lapidary_default_target_dir "$ENV{CARGO_TARGET_DIR}")
else()
  set(lapidary_default_target_dir "${PROJECT_SOURCE_DIR}/target")
endif()
set(LAPIDARY_CARGO_TARGET_DIR "${lapidary_default_target_dir}" CACHE PATH
    "Cargo's build directory; by default the source tree's, so that cargo and CMake share one build")

set(lapidary_built_so "${LAPIDARY_CARGO_TARGET_DIR}/release/liblapidary.so")
set(lapidary_built_a "${LAPIDARY_CARGO_TARGET_DIR}/release/liblapidary.a")

# The ABI changes with the major version; build.rs writes the same name into the library.
set(lapidary_soname "liblapidary.so.${PROJECT_VERSION_MAJOR}")
set(lapidary_library_dir "${PROJECT_BINARY_DIR}/lib")
set(lapidary_so "${lapidary_library_dir}/liblapidary.so.${PROJECT_VERSION}")
set(lapidary_a "${lapidary_library_dir}/liblapidary.a")
file(MAKE_DIRECTORY "${lapidary_library_dir}")

# What the static library needs from the system, as `rustc --print native-static-libs` lists it.
set(lapidary_system_libraries gcc_s util rt pthread m dl c)

add_custom_target(
  lapidary_cargo ALL
  COMMAND "${CMAKE_COMMAND}" -E env --unset=MAKEFLAGS "CARGO_TARGET_DIR=${LAPIDARY_CARGO_TARGET_DIR}"
          "${LAPIDARY_CARGO}" build --release --locked --lib --manifest-path "${PROJECT_SOURCE_DIR}/Cargo.toml"
  COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${lapidary_built_so}" "${lapidary_so}"
  COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${lapidary_built_a}" "${lapidary_a}"
  COMMAND "${CMAKE_COMMAND}" -E create_symlink "liblapidary.so.${PROJECT_VERSION}"
          "${lapidary_library_dir}/${lapidary_soname}"
  COMMAND "${CMAKE_COMMAND}" -E create_symlink "${lapidary_soname}" "${lapidary_library_dir}/liblapidary.so"
  BYPRODUCTS "${lapidary_so}" "${lapidary_a}"
  WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
  COMMENT "Building liblapidary with cargo"
  USES_TERMINAL VERBATIM)

add_library(lapidary::lapidary SHARED IMPORTED GLOBAL)
set_target_properties(
  lapidary::lapidary
  PROPERTIES IMPORTED_LOCATION "${lapidary_so}"
             IMPORTED_SONAME "${lapidary_soname}"
             INTERFACE_INCLUDE_DIRECTORIES "${PROJECT_SOURCE_DIR}/include")
add_dependencies(lapidary::lapidary lapidary_cargo)

add_library(lapidary::static STATIC IMPORTED GLOBAL)
set_target_properties(
  lapidary::static
  PROPERTIES IMPORTED_LOCATION "${lapidary_a}"
             INTERFACE_INCLUDE_DIRECTORIES "${PROJECT_SOURCE_DIR}/include"
             INTERFACE_LINK_LIBRARIES "${lapidary_system_libraries}")
add_dependencies(lapidary::static lapidary_cargo)

# Module files belong to one compiler, so the module comes as a source: each target that links this compiles it.
add_library(lapidary::fortran INTERFACE IMPORTED GLOBAL)
set_target_properties(
  lapidary::fortran PROPERTIES INTERFACE_SOURCES "${PROJECT_SOURCE_DIR}/include/lapidary.f90"
                               INTERFACE_LINK_LIBRARIES lapidary::lapidary)

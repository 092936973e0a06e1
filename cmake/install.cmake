# Install rules: libraries with their links, headers, the Fortran module as source, package config, pkg-config file, licences.

install(PROGRAMS "${lapidary_so}" DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(FILES "${lapidary_library_dir}/${lapidary_soname}" "${lapidary_library_dir}/liblapidary.so" "${lapidary_a}"
        DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        FILES_MATCHING PATTERN "lapidary.h" PATTERN "lapidary.hpp" PATTERN "lapidary.f90")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE-MIT" "${PROJECT_SOURCE_DIR}/LICENSE-APACHE"
        DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/licenses/lapidary")

set(lapidary_config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/lapidary")
configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/lapidary-config.cmake.in" "${PROJECT_BINARY_DIR}/lapidary-config.cmake"
  INSTALL_DESTINATION "${lapidary_config_dir}"
  PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR
  NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 every minor version may break the ABI.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/lapidary-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/lapidary-config.cmake" "${PROJECT_BINARY_DIR}/lapidary-config-version.cmake"
        DESTINATION "${lapidary_config_dir}")

# pkg-config finds the prefix from where the file lies, so an installed tree can be moved. The way up from the file's
# directory to the prefix has to be counted: LIBDIR may be lib, lib64 or lib/x86_64-linux-gnu.
set(lapidary_pc_dir "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  set(lapidary_pc_prefix "${CMAKE_INSTALL_PREFIX}")
  set(lapidary_pc_libdir "${CMAKE_INSTALL_LIBDIR}")
else()
  file(RELATIVE_PATH lapidary_pc_up "/${lapidary_pc_dir}" "/")
  string(REGEX REPLACE "/$" "" lapidary_pc_up "${lapidary_pc_up}")
  set(lapidary_pc_prefix "\${pcfiledir}/${lapidary_pc_up}")
  set(lapidary_pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
endif()
if(IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
  set(lapidary_pc_includedir "${CMAKE_INSTALL_INCLUDEDIR}")
else()
  set(lapidary_pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
endif()
list(TRANSFORM lapidary_system_libraries PREPEND "-l" OUTPUT_VARIABLE lapidary_pc_private)
list(JOIN lapidary_pc_private " " lapidary_pc_private)
configure_file("${PROJECT_SOURCE_DIR}/cmake/lapidary.pc.in" "${PROJECT_BINARY_DIR}/lapidary.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/lapidary.pc" DESTINATION "${lapidary_pc_dir}")

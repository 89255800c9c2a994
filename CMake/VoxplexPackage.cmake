# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# What find_package(Voxplex) reads, in the build tree and in the install tree, and the version header.

include(CMakePackageConfigHelpers)

set(_voxplex_build_package "${CMAKE_BINARY_DIR}/${VOXPLEX_PACKAGE_DESTINATION}")
configure_file(CMake/voxplex-config.cmake.in "${_voxplex_build_package}/voxplex-config.cmake" @ONLY)
write_basic_package_version_file("${_voxplex_build_package}/voxplex-config-version.cmake"
  VERSION       "${VOXPLEX_VERSION}"
  COMPATIBILITY SameMinorVersion)
install(
  FILES
    "${_voxplex_build_package}/voxplex-config.cmake"
    "${_voxplex_build_package}/voxplex-config-version.cmake"
  DESTINATION "${VOXPLEX_PACKAGE_DESTINATION}"
  COMPONENT   development)
install(
  FILES       LICENSE
  DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/licenses/voxplex"
  COMPONENT   runtime)

# voxplexVersion.h, for the program: link VoxplexVersion.
configure_file(CMake/voxplexVersion.h.in "${CMAKE_BINARY_DIR}/include/voxplexVersion.h" @ONLY)
add_library(VoxplexVersion INTERFACE)
target_include_directories(VoxplexVersion INTERFACE "${CMAKE_BINARY_DIR}/include")

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Builds VTK::Voxplex and VTK::VoxplexIO against an installed VTK: scans the vtk.module files and lets VTK
# re-enter the root CMakeLists.txt, and enter IO/.

set(_voxplex_module_files "${CMAKE_CURRENT_SOURCE_DIR}/vtk.module")
if (VOXPLEX_HAVE_IO)
  list(APPEND _voxplex_module_files "${CMAKE_CURRENT_SOURCE_DIR}/IO/vtk.module")
endif ()
vtk_module_scan(
  MODULE_FILES      ${_voxplex_module_files}
  PROVIDES_MODULES  voxplex_modules
  WANT_BY_DEFAULT   ON
  HIDE_MODULES_FROM_CACHE ON
  ENABLE_TESTS      OFF)

# VTK places a module at ${CMAKE_BINARY_DIR}/<its path below CMAKE_SOURCE_DIR>. For a module at the
# root that path is empty and the build directory would be entered twice; seen from one folder above
# it is the repository's name.
function (voxplex_build_module)
  set(CMAKE_SOURCE_DIR "${CMAKE_CURRENT_SOURCE_DIR}/..")
  vtk_module_build(
    MODULES             ${voxplex_modules}
    PACKAGE             Voxplex
    INSTALL_EXPORT      Voxplex
    VERSION             "${VOXPLEX_VERSION}"
    SOVERSION           "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}"
    ENABLE_WRAPPING     "${VOXPLEX_HAVE_PYTHON}"
    HEADERS_DESTINATION "${VOXPLEX_HEADERS_DESTINATION}"
    CMAKE_DESTINATION   "${VOXPLEX_PACKAGE_DESTINATION}"
    HIERARCHY_DESTINATION "${CMAKE_INSTALL_LIBDIR}/vtk/hierarchy/Voxplex"
    TEST_DIRECTORY_NAME NONE) # Testing/ is added by the root CMakeLists.txt
endfunction ()
voxplex_build_module()

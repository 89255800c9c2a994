# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Installed documentation, and the packages that CPack makes of what is installed: `cpack` in the build
# folder leaves voxplex_<version>_<architecture>.deb, where dpkg is there, and a .tar.gz.
#
# One Debian package has everything: program, libraries, Python package, headers and CMake files. Those
# who only run the program need no compiler for it; libvtk9-dev, which building against it takes, is
# suggested.

set(_voxplex_doc "${CMAKE_INSTALL_DATAROOTDIR}/doc/voxplex")
install(
  FILES       README.md CONTRIBUTING.md CHANGELOG.md
  DESTINATION "${_voxplex_doc}"
  COMPONENT   documentation)
install(
  DIRECTORY   Documentation
  DESTINATION "${_voxplex_doc}"
  COMPONENT   documentation)

# The manual page is what `voxplex --help all` prints; commands in it keep their lines.
find_program(VOXPLEX_HELP2MAN help2man)
mark_as_advanced(VOXPLEX_HELP2MAN)
if (TARGET voxplex AND VOXPLEX_HELP2MAN)
  set(_voxplex_page "${CMAKE_CURRENT_BINARY_DIR}/voxplex.1")
  add_custom_command(OUTPUT "${_voxplex_page}.gz"
    COMMAND "${VOXPLEX_HELP2MAN}" --no-info --help-option "--help all" --name "label images to conforming simplex meshes"
      --output "${_voxplex_page}" "$<TARGET_FILE:voxplex>"
    COMMAND sed -i "s/^voxplex .*/.EX\\n&\\n.EE/" "${_voxplex_page}"
    COMMAND gzip -9 -n -f "${_voxplex_page}"
    DEPENDS voxplex
    VERBATIM)
  add_custom_target(VoxplexManualPage ALL DEPENDS "${_voxplex_page}.gz")
  install(
    FILES       "${_voxplex_page}.gz"
    DESTINATION "${CMAKE_INSTALL_MANDIR}/man1"
    COMPONENT   documentation)
else ()
  voxplex_skip("the manual page" "the program is not built, or help2man was not found (apt-get install help2man)")
endif ()

# --- What Debian wants besides --------------------------------------------------------------------

set(VOXPLEX_PACKAGE_MAINTAINER "The Voxplex developers <voxplex@example.org>" CACHE STRING
  "The maintainer field of the Debian package")
mark_as_advanced(VOXPLEX_PACKAGE_MAINTAINER)
find_program(VOXPLEX_DPKG_SHLIBDEPS dpkg-shlibdeps)
mark_as_advanced(VOXPLEX_DPKG_SHLIBDEPS)
set(_voxplex_debian "${CMAKE_CURRENT_BINARY_DIR}/debian")

if (VOXPLEX_DPKG_SHLIBDEPS)
  file(READ LICENSE _voxplex_license)
  string(STRIP "${_voxplex_license}" _voxplex_license)
  string(REGEX REPLACE "\n\n" "\n.\n" _voxplex_license "${_voxplex_license}")
  string(REGEX REPLACE "\n" "\n " _voxplex_license "${_voxplex_license}")
  configure_file(Packaging/debian/copyright.in "${_voxplex_debian}/copyright" @ONLY)
  configure_file(Packaging/debian/shlibs.in "${_voxplex_debian}/shlibs" @ONLY)
  file(TIMESTAMP CHANGELOG.md _voxplex_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  configure_file(Packaging/debian/changelog.in "${_voxplex_debian}/changelog" @ONLY)
  execute_process(
    COMMAND gzip -9 -n -c "${_voxplex_debian}/changelog"
    OUTPUT_FILE "${_voxplex_debian}/changelog.gz"
    COMMAND_ERROR_IS_FATAL ANY)
  install(
    FILES       "${_voxplex_debian}/copyright" "${_voxplex_debian}/changelog.gz"
    DESTINATION "${_voxplex_doc}"
    COMPONENT   documentation)
  install(
    FILES       Packaging/debian/lintian-overrides
    DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/lintian/overrides"
    RENAME      voxplex
    COMPONENT   documentation)
endif ()

# --- CPack ----------------------------------------------------------------------------------------

set(CPACK_PACKAGE_NAME "voxplex")
set(CPACK_PACKAGE_VERSION "${VOXPLEX_VERSION}")
set(CPACK_PACKAGE_VENDOR "The Voxplex developers")
set(CPACK_PACKAGE_CONTACT "${VOXPLEX_PACKAGE_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "label images to conforming simplex meshes")
set(CPACK_PACKAGE_DESCRIPTION
"Voxplex turns segmented images into meshes for finite elements: 3D label
images into tetrahedra, time series of them into pentatopes of space-time.
Tissues share the nodes of their interfaces, and the image's origin, spacing
and axes are honoured.

This package holds the program voxplex, the Python package voxplex, the VTK
modules VTK::Voxplex and VTK::VoxplexIO, and a filter for ITK, with their
headers and CMake files.")
set(CPACK_RESOURCE_FILE_LICENSE "${CMAKE_CURRENT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS "${CMAKE_CURRENT_SOURCE_DIR}/Packaging/debian/before-packing.cmake")

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION "science")
set(CPACK_DEBIAN_PACKAGE_PRIORITY "optional")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  "${CMAKE_CURRENT_SOURCE_DIR}/Packaging/debian/triggers" # has ldconfig run
  "${_voxplex_debian}/shlibs")
if (VOXPLEX_HAVE_PYTHON)
  # The wrapped modules are for one version of Python.
  math(EXPR _voxplex_next_python "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${_voxplex_next_python}), python3-numpy")
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-vtk9") # for the wrapped classes, not for functions
  list(APPEND CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA # byte code: made at installation, removed with the package
    "${CMAKE_CURRENT_SOURCE_DIR}/Packaging/debian/postinst" "${CMAKE_CURRENT_SOURCE_DIR}/Packaging/debian/prerm")
endif ()
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libvtk9-dev, paraview")

set(CPACK_GENERATOR "TGZ")
if (VOXPLEX_DPKG_SHLIBDEPS)
  list(APPEND CPACK_GENERATOR "DEB")
endif ()
set(CPACK_SOURCE_GENERATOR "TGZ")
set(CPACK_SOURCE_IGNORE_FILES "/\\\\.git/" "/build/" "/__pycache__/")
include(CPack)

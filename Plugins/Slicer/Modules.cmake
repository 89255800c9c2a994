# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Installs the modules for 3D Slicer, which no Slicer is needed for. The CLI module is a link to the program, under the
# name that Slicer shows; the program finds its libraries and files from the place that the link points to.
if (NOT TARGET voxplex OR WIN32)
  voxplex_skip("the modules for 3D Slicer" "the voxplex program is not built, or the system is Windows")
  return ()
endif ()

set(_voxplex_slicer "${CMAKE_INSTALL_LIBDIR}/voxplex-${VOXPLEX_VERSION}/Slicer")
set(VOXPLEX_SLICER_CLI "${CMAKE_BINARY_DIR}/${_voxplex_slicer}/cli-modules/SegmentationToTetMesh") # as far from bin as installed
file(RELATIVE_PATH _voxplex_target "/prefix/${_voxplex_slicer}/cli-modules" "/prefix/${CMAKE_INSTALL_BINDIR}/voxplex")
file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/${_voxplex_slicer}/cli-modules")
file(CREATE_LINK "${_voxplex_target}" "${VOXPLEX_SLICER_CLI}" SYMBOLIC)
install(FILES "${VOXPLEX_SLICER_CLI}" DESTINATION "${_voxplex_slicer}/cli-modules" COMPONENT slicer)
install(DIRECTORY "${CMAKE_CURRENT_LIST_DIR}/VoxplexMesher/"
  DESTINATION "${_voxplex_slicer}/qt-scripted-modules"
  COMPONENT slicer
  FILES_MATCHING
    PATTERN "*.json"
    PATTERN "*.py"
    PATTERN "*.png")

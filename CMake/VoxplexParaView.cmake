# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Builds the ParaView plugin and its tests, against ParaView and the VTK that it brings; nothing else.
#
# The plugin takes the modules VTK::Voxplex and VTK::VoxplexIO in (Plugins/ParaView/CMakeLists.txt).

find_package(ParaView 5.11 QUIET)
voxplex_require("${ParaView_FOUND}" "ParaView 5.11 with its development files"
  "paraview-dev, or Scripts/install-paraview where libvtk9-dev is installed, too" ParaView_DIR)
voxplex_find_libraries()
include(CMake/VoxplexFindIO.cmake) # sets VOXPLEX_HAVE_IO: whether the plugin reads segmentations

if (VOXPLEX_BUILD_TESTING)
  enable_testing()
endif ()

paraview_plugin_scan(
  PLUGIN_FILES     "${CMAKE_CURRENT_SOURCE_DIR}/Plugins/ParaView/paraview.plugin"
  PROVIDES_PLUGINS voxplex_plugins
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)

# voxplex.plugins.xml lies beside the plugin's folder, in the build tree and in the install tree. With
# its path in PV_PLUGIN_CONFIG_FILE, ParaView loads the plugin when it starts.
set(VOXPLEX_PARAVIEW_SUBDIRECTORY "paraview-${ParaView_VERSION_MAJOR}.${ParaView_VERSION_MINOR}/plugins")
paraview_plugin_build(
  PLUGINS              ${voxplex_plugins}
  AUTOLOAD             ${voxplex_plugins}
  PLUGINS_FILE_NAME    "voxplex.plugins.xml"
  LIBRARY_SUBDIRECTORY "${VOXPLEX_PARAVIEW_SUBDIRECTORY}"
  PLUGINS_COMPONENT    paraview
  TARGET_COMPONENT     paraview
  INSTALL_HEADERS      OFF)

# No folder is below itself: Qt 6 walks all of them.
function (voxplex_check_folders folder)
  if (folder IN_LIST ARGN)
    message(FATAL_ERROR "The folder ${folder} is below itself")
  endif ()
  get_property(_voxplex_below DIRECTORY "${folder}" PROPERTY SUBDIRECTORIES)
  foreach (_voxplex_folder IN LISTS _voxplex_below)
    voxplex_check_folders("${_voxplex_folder}" "${folder}" ${ARGN})
  endforeach ()
endfunction ()
voxplex_check_folders("${CMAKE_SOURCE_DIR}")

if (VOXPLEX_BUILD_TESTING)
  add_subdirectory(Testing/Plugins/ParaView)
endif ()

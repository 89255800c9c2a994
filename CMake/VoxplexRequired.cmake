# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# The dependencies without which nothing can be built. Each one missing says how to get it.

function (voxplex_require found what debian_package variable)
  if (NOT found)
    message(FATAL_ERROR
      "Voxplex needs ${what}, which was not found.\n"
      "  Debian, Ubuntu: apt-get install ${debian_package}\n"
      "  Elsewhere: pass -D${variable}=<folder with its CMake config>.\n"
      "  Scripts/install-dependencies installs all that building needs on Debian 12.")
  endif ()
endfunction ()

macro (voxplex_find_libraries)
  find_package(CGAL 5.0 QUIET)
  voxplex_require("${CGAL_FOUND}" "CGAL 5 (its kernels only)" "libcgal-dev" CGAL_DIR)
  find_package(Boost 1.74 QUIET)
  voxplex_require("${Boost_FOUND}" "Boost 1.74 (header files only)" "libboost-dev" Boost_DIR)
  find_package(nlohmann_json 3.11 QUIET)
  voxplex_require("${nlohmann_json_FOUND}" "nlohmann's JSON for C++ 3.11" "nlohmann-json3-dev" nlohmann_json_DIR)
endmacro ()

macro (voxplex_find_vtk)
  find_package(VTK 9.0 QUIET
    COMPONENTS CommonCore CommonDataModel CommonExecutionModel)
  voxplex_require("${VTK_FOUND}" "VTK 9.0 or newer" "libvtk9-dev" VTK_DIR)
endmacro ()

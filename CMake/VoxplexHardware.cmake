# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Optional libraries that know the hardware: hwloc (which processors are near each other) and PAPI
# (the processors' counters). Sets VOXPLEX_HARDWARE_LIBRARIES, VOXPLEX_HARDWARE_INCLUDES and
# VOXPLEX_HARDWARE_DEFINITIONS for the kernel. Files, not targets: an export of a static build would
# have to carry targets along.

option(VOXPLEX_USE_HWLOC "Place threads by the machine's topology (where hwloc 2.3 is found)" ON)
option(VOXPLEX_USE_PAPI "Count TLB and cache misses per thread with PAPI" OFF)

set(VOXPLEX_HARDWARE_LIBRARIES)
set(VOXPLEX_HARDWARE_INCLUDES)
set(VOXPLEX_HARDWARE_DEFINITIONS)

find_package(PkgConfig QUIET)

# Adds a library if its header and its file are there; sets VOXPLEX_HAVE_<name>.
macro (voxplex_find_hardware_library name package header library)
  if (PkgConfig_FOUND)
    pkg_check_modules(VOXPLEX_PC_${name} QUIET ${package})
  endif ()
  find_path(VOXPLEX_${name}_INCLUDE_DIR ${header} HINTS ${VOXPLEX_PC_${name}_INCLUDE_DIRS})
  find_library(VOXPLEX_${name}_LIBRARY ${library} HINTS ${VOXPLEX_PC_${name}_LIBRARY_DIRS})
  mark_as_advanced(VOXPLEX_${name}_INCLUDE_DIR VOXPLEX_${name}_LIBRARY)
  set(VOXPLEX_HAVE_${name} OFF)
  if (VOXPLEX_${name}_INCLUDE_DIR AND VOXPLEX_${name}_LIBRARY)
    set(VOXPLEX_HAVE_${name} ON)
    list(APPEND VOXPLEX_HARDWARE_LIBRARIES "${VOXPLEX_${name}_LIBRARY}")
    list(APPEND VOXPLEX_HARDWARE_INCLUDES "${VOXPLEX_${name}_INCLUDE_DIR}")
    list(APPEND VOXPLEX_HARDWARE_DEFINITIONS VOXPLEX_HAVE_${name})
  endif ()
endmacro ()

if (VOXPLEX_USE_HWLOC)
  # hwloc/memattrs.h came with hwloc 2.3; parts of hwloc can be left out since 2.1.
  voxplex_find_hardware_library(HWLOC "hwloc>=2.3" hwloc/memattrs.h hwloc)
  if (NOT VOXPLEX_HAVE_HWLOC)
    voxplex_skip("Placing threads by the machine's topology"
      "hwloc 2.3 was not found (apt-get install libhwloc-dev)")
  endif ()
endif ()
if (VOXPLEX_USE_PAPI)
  voxplex_find_hardware_library(PAPI papi papi.h papi)
  if (NOT VOXPLEX_HAVE_PAPI)
    message(FATAL_ERROR "VOXPLEX_USE_PAPI is on, but PAPI was not found (apt-get install libpapi-dev).")
  endif ()
endif ()

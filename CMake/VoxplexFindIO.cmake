# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Sets VOXPLEX_HAVE_IO: whether the module VTK::VoxplexIO, which reads and writes files, can be built,
# and if not, says why. Sets VOXPLEX_GDCM_LIBRARIES and VOXPLEX_GDCM_INCLUDE_DIRECTORIES; leaves the targets of VTK's readers
# and writers in the calling folder.

set(VOXPLEX_HAVE_IO OFF)

# The component names of VTK's modules that IO/vtk.module lists.
set(_voxplex_io_components
  CommonCore CommonDataModel CommonExecutionModel CommonMisc IOCore IOGeometry IOLegacy IOXML expat hdf5 png tiff zlib)

if (WIN32)
  voxplex_skip("reading and writing of files" "images are read by a process of its own, which is started as on POSIX systems only")
  return ()
endif ()

# As a library of its own, or as ITK brings it (3D Slicer).
find_package(GDCM 3.0 QUIET)
if (GDCM_FOUND)
  set(VOXPLEX_GDCM_LIBRARIES gdcmMSFF)
  set(VOXPLEX_GDCM_INCLUDE_DIRECTORIES ${GDCM_INCLUDE_DIRS})
else ()
  find_package(ITK 5.2 QUIET COMPONENTS ITKGDCM)
  if (NOT ITK_FOUND)
    voxplex_skip("reading and writing of files" "GDCM was not found (apt-get install libgdcm-dev libgdcm-tools)")
    return ()
  endif ()
  set(VOXPLEX_GDCM_LIBRARIES ${ITK_LIBRARIES})
  set(VOXPLEX_GDCM_INCLUDE_DIRECTORIES ${ITK_INCLUDE_DIRS})
endif ()
if (NOT ParaView_FOUND) # which brings a VTK of its own
  find_package(VTK 9.1 QUIET COMPONENTS ${_voxplex_io_components})
  if (NOT VTK_FOUND)
    voxplex_skip("reading and writing of files" "VTK was found without its readers and writers, or is older than 9.1")
    return ()
  endif ()
endif ()

set(VOXPLEX_HAVE_IO ON)

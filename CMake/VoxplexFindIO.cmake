# Sets VOXPLEX_HAVE_IO: whether the module VTK::VoxplexIO, which reads and writes files, can be built,
# and if not, says why. Leaves the targets of ITK and of VTK's writers in the calling folder.

set(VOXPLEX_HAVE_IO OFF)

# The component names of VTK's modules that IO/vtk.module lists.
set(_voxplex_io_components
  CommonCore CommonDataModel CommonExecutionModel CommonMisc IOCore IOGeometry IOLegacy IOXML hdf5)

find_package(ITK 5.2 QUIET COMPONENTS ITKCommon ITKIOImageBase ITKGDCM ITKIOGDCM ITKImageIO)
if (NOT ITK_FOUND)
  voxplex_skip("reading and writing of files" "ITK was not found (apt-get install libinsighttoolkit5-dev libgdcm-tools)")
  return ()
endif ()
find_package(ZLIB QUIET)
if (NOT ZLIB_FOUND)
  voxplex_skip("reading and writing of files" "zlib was not found (apt-get install zlib1g-dev)")
  return ()
endif ()
if (NOT ParaView_FOUND) # which brings a VTK of its own
  find_package(VTK 9.1 QUIET COMPONENTS ${_voxplex_io_components})
  if (NOT VTK_FOUND)
    voxplex_skip("reading and writing of files" "VTK was found without its readers and writers, or is older than 9.1")
    return ()
  endif ()
endif ()

set(VOXPLEX_HAVE_IO ON)

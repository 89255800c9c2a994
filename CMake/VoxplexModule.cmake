# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Declares the module VTK::Voxplex. Read by the root CMakeLists.txt when VTK's build system enters it, and for the ParaView
# plugin from a folder of the build.
#
# The objects of the kernel, of Segmentation/ and of the table of parameters go into the module's library: nothing of them is
# installed, neither a library nor a header, and their symbols stay hidden.

if (NOT COMMAND voxplex_skip) # the tests say through it what they leave out
  function (voxplex_skip what why)
    message(STATUS "Voxplex leaves out: ${what}: ${why}")
  endfunction ()
endif ()

get_filename_component(voxplex_root "${CMAKE_CURRENT_LIST_DIR}" DIRECTORY)
set(voxplex_filters "${voxplex_root}/Filters")

find_package(Threads REQUIRED)
find_package(CGAL REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
foreach (voxplex_part IN ITEMS Kernel Parameters Segmentation)
  if (NOT TARGET Voxplex${voxplex_part})
    add_subdirectory("${voxplex_root}/${voxplex_part}" ${voxplex_part})
  endif ()
endforeach ()

vtk_module_add_module(VTK::Voxplex
  CLASSES
    ${voxplex_filters}/vtkImageToPentatopeMeshFilter
    ${voxplex_filters}/vtkImageToSimplexMeshFilter
    ${voxplex_filters}/vtkImageToTetMeshFilter
    ${voxplex_filters}/vtkMasksToSegmentation
    ${voxplex_filters}/vtkMeshingStatistics
    ${voxplex_filters}/vtkPentatopeMeshTimeSlice
    ${voxplex_filters}/vtkSegmentationRepair
    ${voxplex_filters}/vtkSimplexMeshInterfaces
    ${voxplex_filters}/vtkSimplexMeshQuality
  PRIVATE_HEADERS
    ${voxplex_filters}/Private/ChosenArray.h
    ${voxplex_filters}/Private/ElementSizes.h
    ${voxplex_filters}/Private/Execution.h
    ${voxplex_filters}/Private/FiguresJson.h
    ${voxplex_filters}/Private/FrameGathering.h
    ${voxplex_filters}/Private/LabelledMesh.h
    ${voxplex_filters}/Private/Lists.h
    ${voxplex_filters}/Private/MeshOutput.h
    ${voxplex_filters}/Private/MeshingMessages.h
    ${voxplex_filters}/Private/OutputArrays.h
    ${voxplex_filters}/Private/QualityRun.h
    ${voxplex_filters}/Private/QualityTables.h
    ${voxplex_filters}/Private/SimplexMeshRun.h
    ${voxplex_filters}/Private/SmpThreads.h
  SOURCES
    ${voxplex_filters}/Private/ChosenArray.cxx
    ${voxplex_filters}/Private/ElementSizes.cxx
    ${voxplex_filters}/Private/LabelledMesh.cxx
    ${voxplex_filters}/Private/MeshOutput.cxx
    ${voxplex_filters}/Private/MeshingJson.cxx
    ${voxplex_filters}/Private/MeshingMessages.cxx
    ${voxplex_filters}/Private/PentatopeOutput.cxx
    ${voxplex_filters}/Private/QualityJson.cxx
    ${voxplex_filters}/Private/QualityRun.cxx
    ${voxplex_filters}/Private/QualityTables.cxx
    ${voxplex_filters}/Private/SmpThreads.cxx
    ${voxplex_root}/Segmentation/SegmentationChecks.cxx
    ${voxplex_root}/Segmentation/SegmentationRepair.cxx
    ${voxplex_root}/Segmentation/ThinRidges.cxx
    $<TARGET_OBJECTS:VoxplexExact>
    $<FILTER:$<TARGET_OBJECTS:VoxplexKernel>,EXCLUDE,[.]gch$> # a precompiled header is no object
    $<TARGET_OBJECTS:VoxplexParameters>
    $<TARGET_OBJECTS:VoxplexSegmentation>)

vtk_module_include(VTK::Voxplex
  PUBLIC
    "$<BUILD_INTERFACE:${voxplex_filters}>"
  PRIVATE
    "${voxplex_root}/Kernel"
    "${voxplex_root}/Parameters"
    "${voxplex_root}/Segmentation") # and Filters/, for Private/

# The kernel's headers want C++20; the module's own headers do not.
vtk_module_compile_features(VTK::Voxplex
  PRIVATE
    cxx_std_20)

# vtkSMPTools.h of VTK 9.0 and 9.1 is not valid C++20.
set_source_files_properties(${voxplex_filters}/Private/SmpThreads.cxx PROPERTIES
  COMPILE_OPTIONS "${CMAKE_CXX17_STANDARD_COMPILE_OPTION}")

# As in the kernel: inline functions of its headers are compiled here, too.
vtk_module_compile_options(VTK::Voxplex
  PRIVATE
    -ffp-contract=off -Wall -Wextra -Wshadow
    $<$<BOOL:${VOXPLEX_WARNINGS_AS_ERRORS}>:-Werror>)

# The objects bring no libraries with them: threads and what knows the hardware, and GMP and MPFR for
# CGAL's exact numbers. Only CGAL's libraries are wanted, not its compiler flags.
get_target_property(voxplex_kernel_libraries VoxplexKernel INTERFACE_LINK_LIBRARIES)
vtk_module_link(VTK::Voxplex
  PRIVATE
    "$<LINK_ONLY:CGAL::CGAL>"
    "$<BUILD_INTERFACE:nlohmann_json::nlohmann_json>" # header files only
    ${voxplex_kernel_libraries})

# What is not exported by name stays inside, as in the kernel.
set_target_properties(Voxplex PROPERTIES
  CXX_VISIBILITY_PRESET hidden
  VISIBILITY_INLINES_HIDDEN ON)

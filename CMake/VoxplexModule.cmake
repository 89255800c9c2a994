# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Declares the module VTK::Voxplex. Read by the root CMakeLists.txt when VTK's build system enters it.
#
# The objects of the kernel and of the table of parameters go into the module's library: nothing of them is
# installed, neither a library nor a header, and their symbols stay hidden.

if (NOT COMMAND voxplex_skip) # the tests say through it what they leave out
  function (voxplex_skip what why)
    message(STATUS "Voxplex leaves out: ${what}: ${why}")
  endfunction ()
endif ()

find_package(Threads REQUIRED)
find_package(CGAL REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
foreach (voxplex_part IN ITEMS Kernel Parameters)
  if (NOT TARGET Voxplex${voxplex_part})
    add_subdirectory(${voxplex_part})
  endif ()
endforeach ()

vtk_module_add_module(VTK::Voxplex
  CLASSES
    Filters/vtkImageToPentatopeMeshFilter
    Filters/vtkImageToSimplexMeshFilter
    Filters/vtkImageToTetMeshFilter
    Filters/vtkMeshingStatistics
    Filters/vtkPentatopeMeshTimeSlice
    Filters/vtkSimplexMeshQuality
  PRIVATE_HEADERS
    Filters/Private/ChosenArray.h
    Filters/Private/ElementSizes.h
    Filters/Private/Execution.h
    Filters/Private/FiguresJson.h
    Filters/Private/FrameGathering.h
    Filters/Private/HiddenVoxels.h
    Filters/Private/LabelledMesh.h
    Filters/Private/Lists.h
    Filters/Private/MeshOutput.h
    Filters/Private/MeshingMessages.h
    Filters/Private/OutputArrays.h
    Filters/Private/QualityRun.h
    Filters/Private/QualityTables.h
    Filters/Private/SimplexMeshRun.h
    Filters/Private/SmpThreads.h
  SOURCES
    Filters/Private/ChosenArray.cxx
    Filters/Private/ElementSizes.cxx
    Filters/Private/HiddenVoxels.cxx
    Filters/Private/LabelledMesh.cxx
    Filters/Private/MeshOutput.cxx
    Filters/Private/MeshingJson.cxx
    Filters/Private/MeshingMessages.cxx
    Filters/Private/PentatopeOutput.cxx
    Filters/Private/QualityJson.cxx
    Filters/Private/QualityRun.cxx
    Filters/Private/QualityTables.cxx
    Filters/Private/SmpThreads.cxx
    $<TARGET_OBJECTS:VoxplexExact>
    $<FILTER:$<TARGET_OBJECTS:VoxplexKernel>,EXCLUDE,[.]gch$> # a precompiled header is no object
    $<TARGET_OBJECTS:VoxplexParameters>)

vtk_module_include(VTK::Voxplex
  PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/Filters>"
  PRIVATE
    "${CMAKE_CURRENT_SOURCE_DIR}/Kernel"
    "${CMAKE_CURRENT_SOURCE_DIR}/Parameters") # and Filters/, for Private/

# The kernel's headers want C++20; the module's own headers do not.
vtk_module_compile_features(VTK::Voxplex
  PRIVATE
    cxx_std_20)

# vtkSMPTools.h of VTK 9.0 and 9.1 is not valid C++20.
set_source_files_properties(Filters/Private/SmpThreads.cxx PROPERTIES
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

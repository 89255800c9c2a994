# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Sets ITK_FOUND: whether vtkSegmentationRepair, the one class that needs ITK, is built.
include(CheckCXXSourceCompiles)
set(ITKVtkGlue_LOADED ON) # or ITK 5.4 loads all of VTK
find_package(ITK 5.2 QUIET COMPONENTS ITKCommon ITKDistanceMap ITKLabelMap)
if (ITK_FOUND)
  set(CMAKE_REQUIRED_INCLUDES ${ITK_INCLUDE_DIRS})
  check_cxx_source_compiles("#include <itkConfigure.h>\nint main() {}" VOXPLEX_ITK_TAKES_THIS_COMPILER)
  unset(CMAKE_REQUIRED_INCLUDES)
  set(ITK_FOUND ${VOXPLEX_ITK_TAKES_THIS_COMPILER}) # the headers of Debian's ITK 5.2 know GCC only
endif ()

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Sets VOXPLEX_HAVE_PYTHON: whether VTK's Python wrapping can be used, and if not, says why.

set(VOXPLEX_HAVE_PYTHON OFF)

if (NOT BUILD_SHARED_LIBS)
  voxplex_skip("Python" "BUILD_SHARED_LIBS is off")
  return ()
endif ()

find_package(VTK QUIET
  COMPONENTS CommonCore CommonDataModel CommonExecutionModel
  OPTIONAL_COMPONENTS Python WrappingPythonCore WrappingTools)
if (NOT TARGET VTK::WrappingPythonCore OR NOT TARGET VTK::Python OR NOT TARGET VTK::WrapPython)
  voxplex_skip("Python"
    "VTK was found without its Python wrapping (apt-get install python3-vtk9 python3-dev; if the PATH has another interpreter before VTK's own, pass -DPython3_EXECUTABLE=/usr/bin/python3)")
  return ()
endif ()

set(VOXPLEX_HAVE_PYTHON ON)

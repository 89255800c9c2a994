# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# The Python package `voxplex`: VTK's wrapping of the modules, and the layer of Python/voxplex.
#
# Build tree: PYTHONPATH=<build>/${VOXPLEX_PYTHON_DESTINATION}.
# Install tree: <prefix>/${VOXPLEX_PYTHON_DESTINATION}.

vtk_module_python_default_destination(_voxplex_python_destination MAJOR_VERSION 3)
set(VOXPLEX_PYTHON_DESTINATION "${_voxplex_python_destination}" CACHE STRING
  "Where the Python package goes, relative to the build folder and to the install prefix")
mark_as_advanced(VOXPLEX_PYTHON_DESTINATION)

vtk_module_wrap_python(
  MODULES             ${voxplex_modules}
  TARGET              VoxplexPython
  PYTHON_PACKAGE      voxplex
  MODULE_DESTINATION  "${VOXPLEX_PYTHON_DESTINATION}"
  LIBRARY_DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  CMAKE_DESTINATION   "${VOXPLEX_PACKAGE_DESTINATION}"
  BUILD_STATIC        OFF
  INSTALL_EXPORT      Voxplex)

# --- The layer in Python --------------------------------------------------------------------------

include(CMake/VoxplexPythonLayer.cmake)
file(RELATIVE_PATH _voxplex_program
  "/prefix/${VOXPLEX_PYTHON_DESTINATION}/voxplex" "/prefix/${CMAKE_INSTALL_BINDIR}/voxplex")
set(_voxplex_python_folder "${CMAKE_BINARY_DIR}/${VOXPLEX_PYTHON_DESTINATION}/voxplex")
voxplex_python_layer("${_voxplex_python_folder}" "${_voxplex_program}" "${VOXPLEX_PYTHON_DESTINATION}/voxplex" python)

# Types of the wrapped classes.
foreach (_voxplex_file IN ITEMS vtkVoxplex.pyi vtkVoxplexIO.pyi)
  configure_file("Python/voxplex/${_voxplex_file}" "${_voxplex_python_folder}/${_voxplex_file}" COPYONLY)
  install(
    FILES       "${_voxplex_python_folder}/${_voxplex_file}"
    DESTINATION "${VOXPLEX_PYTHON_DESTINATION}/voxplex"
    COMPONENT   python)
endforeach ()

# What importlib.metadata and pip list read.
set(_voxplex_dist_info "${VOXPLEX_PYTHON_DESTINATION}/voxplex-${VOXPLEX_VERSION}.dist-info")
configure_file(Python/METADATA.in "${CMAKE_BINARY_DIR}/${_voxplex_dist_info}/METADATA" @ONLY)
file(WRITE "${CMAKE_BINARY_DIR}/${_voxplex_dist_info}/INSTALLER" "cmake\n")
install(
  FILES
    "${CMAKE_BINARY_DIR}/${_voxplex_dist_info}/METADATA"
    "${CMAKE_BINARY_DIR}/${_voxplex_dist_info}/INSTALLER"
  DESTINATION "${_voxplex_dist_info}"
  COMPONENT   python)

# What a test needs in its environment to import the package from the build tree. An interpreter that
# was not built with the address sanitizer must load its run-time first, and the C++ library with it,
# whose functions the run-time wants to intercept.
set(VOXPLEX_PYTHON_TEST_ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/${VOXPLEX_PYTHON_DESTINATION}")
if (CMAKE_CXX_FLAGS MATCHES "-fsanitize=[a-z,]*address")
  set(_voxplex_preload)
  foreach (_voxplex_library IN ITEMS libasan.so libstdc++.so.6)
    execute_process(
      COMMAND "${CMAKE_CXX_COMPILER}" "-print-file-name=${_voxplex_library}"
      OUTPUT_VARIABLE _voxplex_file
      OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(APPEND _voxplex_preload ":${_voxplex_file}")
  endforeach ()
  list(APPEND VOXPLEX_PYTHON_TEST_ENVIRONMENT
    "LD_PRELOAD=${_voxplex_preload}" "ASAN_OPTIONS=detect_leaks=0")
endif ()

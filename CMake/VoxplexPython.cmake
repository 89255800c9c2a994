# The Python package `voxplex`: VTK's wrapping of the module, and an __init__.py that exports it.
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

set(_voxplex_python_folder "${CMAKE_BINARY_DIR}/${VOXPLEX_PYTHON_DESTINATION}/voxplex")
configure_file(Filters/Python/voxplex/__init__.py.in "${_voxplex_python_folder}/__init__.py" @ONLY)
install(
  FILES       "${_voxplex_python_folder}/__init__.py"
  DESTINATION "${VOXPLEX_PYTHON_DESTINATION}/voxplex"
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

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# The part of the package `voxplex` that is written in Python, the same with the wrapped classes and in the wheel.

set(_voxplex_python_files
  __init__.py
  __main__.py
  errors.py
  examples.py
  fields.py
  files.py
  images.py
  measuring.py
  meshes.py
  program.py
  py.typed
  pyvista_accessor.py
  vtkdata.py
  xmlfiles.py)

# Made from the table of parameters.
set(_voxplex_made_files
  meshing.py
  options.py
  sources.py)

# Assembles it in `folder`, and installs it.
#
# program: where the command line program is, seen from there
function (voxplex_python_layer folder program destination component)
  foreach (_voxplex_file IN LISTS _voxplex_python_files)
    configure_file("Python/voxplex/${_voxplex_file}" "${folder}/${_voxplex_file}" COPYONLY)
  endforeach ()
  set(_voxplex_program "${program}")
  configure_file(Python/voxplex/installation.py.in "${folder}/installation.py" @ONLY)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  foreach (_voxplex_file IN LISTS _voxplex_made_files)
    add_custom_command(
      OUTPUT "${folder}/${_voxplex_file}"
      COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Parameters/write_python.py"
        "$<TARGET_FILE:voxplexParameters>" "${CMAKE_CURRENT_SOURCE_DIR}/Python/voxplex/${_voxplex_file}.in"
        "${folder}/${_voxplex_file}"
      DEPENDS voxplexParameters Parameters/write_python.py "Python/voxplex/${_voxplex_file}.in"
      VERBATIM)
  endforeach ()
  list(TRANSFORM _voxplex_python_files PREPEND "${folder}/")
  list(TRANSFORM _voxplex_made_files PREPEND "${folder}/")
  add_custom_target(VoxplexMeshingPy ALL DEPENDS ${_voxplex_made_files})
  install(
    FILES       ${_voxplex_python_files} ${_voxplex_made_files} "${folder}/installation.py"
    DESTINATION "${destination}"
    COMPONENT   "${component}")
endfunction ()

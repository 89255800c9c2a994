# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
if (NOT VOXPLEX_HAVE_PYTHON)
  return ()
endif ()
find_package(Python3 QUIET COMPONENTS Interpreter)

# voxplex_python_example(name expected argument...): what it prints has a match of a regular expression.
function (voxplex_python_example name expected)
  add_test(NAME Examples.Python.${name}
    COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Python/${name}.py" ${ARGN})
  set_tests_properties(Examples.Python.${name} PROPERTIES
    ENVIRONMENT "${VOXPLEX_PYTHON_TEST_ENVIRONMENT}"
    TIMEOUT 600 LABELS Examples PASS_REGULAR_EXPRESSION "${expected}")
endfunction ()

set(_voxplex_output "${CMAKE_CURRENT_BINARY_DIR}")
voxplex_python_example(mesh_segmentation "label 3: [1-9][0-9]+ tetrahedra"
  --output "${_voxplex_output}/phantom.vtu" --interfaces "${_voxplex_output}/phantom.vtp")
voxplex_python_example(mesh_masks "aorta  .*rib_left_9 .*rib_left_10 .* tetrahedra of 100 structures"
  --output "${_voxplex_output}/whole-body.vtu")
voxplex_python_example(mesh_moving_anatomy "t = 0.80 s: chamber 1[0-9][0-9][0-9] mm"
  --output "${_voxplex_output}/moving-anatomy")
# Orders of convergence of linear elements; the agent that remains is the blood that never left, 46.5 % of it.
voxplex_python_example(heat_in_moving_ball "order of convergence: (1.[89]|2.[0-3])[0-9] of u, (0.9|1.)"
  --output "${_voxplex_output}/heat")
voxplex_python_example(contrast_in_ventricle "remains: 0.4[5-8][0-9]; blood that never left: 0.4[56]"
  --output "${_voxplex_output}/contrast")

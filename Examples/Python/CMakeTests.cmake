# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
if (NOT VOXPLEX_HAVE_PYTHON)
  return ()
endif ()
find_package(Python3 QUIET COMPONENTS Interpreter)
add_test(NAME Examples.Python.mesh_segmentation
  COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Python/mesh_segmentation.py"
    --output "${CMAKE_CURRENT_BINARY_DIR}/phantom.vtu"
    --interfaces "${CMAKE_CURRENT_BINARY_DIR}/phantom.vtp")
set_tests_properties(Examples.Python.mesh_segmentation PROPERTIES
  ENVIRONMENT "${VOXPLEX_PYTHON_TEST_ENVIRONMENT}"
  TIMEOUT 600 LABELS Examples PASS_REGULAR_EXPRESSION "label 3: [1-9][0-9]+ tetrahedra")
add_test(NAME Examples.Python.mesh_masks
  COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Python/mesh_masks.py"
    --output "${CMAKE_CURRENT_BINARY_DIR}/whole-body.vtu")
set_tests_properties(Examples.Python.mesh_masks PROPERTIES
  ENVIRONMENT "${VOXPLEX_PYTHON_TEST_ENVIRONMENT}"
  TIMEOUT 600 LABELS Examples PASS_REGULAR_EXPRESSION "aorta  .*rib_left_9 .*rib_left_10 .* tetrahedra of 100 structures")
add_test(NAME Examples.Python.mesh_moving_anatomy
  COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Python/mesh_moving_anatomy.py"
    --output "${CMAKE_CURRENT_BINARY_DIR}/moving-anatomy")
set_tests_properties(Examples.Python.mesh_moving_anatomy PROPERTIES
  ENVIRONMENT "${VOXPLEX_PYTHON_TEST_ENVIRONMENT}"
  TIMEOUT 600 LABELS Examples PASS_REGULAR_EXPRESSION "t = 0.80 s: chamber 1[0-9][0-9][0-9] mm")
# Orders of convergence of linear elements; the agent that remains is the blood that never left, 46.5 % of it.
add_test(NAME Examples.Python.heat_in_moving_ball
  COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Python/heat_in_moving_ball.py"
    --output "${CMAKE_CURRENT_BINARY_DIR}/heat")
set_tests_properties(Examples.Python.heat_in_moving_ball PROPERTIES
  ENVIRONMENT "${VOXPLEX_PYTHON_TEST_ENVIRONMENT}"
  TIMEOUT 600 LABELS Examples PASS_REGULAR_EXPRESSION "order of convergence: (1.[89]|2.[0-3])[0-9] of u, (0.9|1.)")
add_test(NAME Examples.Python.contrast_in_ventricle
  COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/Python/contrast_in_ventricle.py"
    --output "${CMAKE_CURRENT_BINARY_DIR}/contrast")
set_tests_properties(Examples.Python.contrast_in_ventricle PROPERTIES
  ENVIRONMENT "${VOXPLEX_PYTHON_TEST_ENVIRONMENT}"
  TIMEOUT 600 LABELS Examples PASS_REGULAR_EXPRESSION "remains: 0.4[5-8][0-9]; blood that never left: 0.4[56]")

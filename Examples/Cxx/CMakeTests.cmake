# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Builds the examples as a project outside of this one and runs them: MeshBall against this build tree,
# all of them against the install tree that Testing/Packaging makes.
find_package(VTK QUIET OPTIONAL_COMPONENTS IOXML)
if (NOT TARGET VTK::IOXML)
  voxplex_skip("Examples/Cxx" "VTK was found without IOXML")
  return ()
endif ()

# Builds a target of them in a folder of the name, with further CMake options, and runs MeshBall.
function (voxplex_add_build_test name target)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/Cxx/${name}")
  add_test(NAME "Examples.Cxx.${name}"
    COMMAND "${CMAKE_CTEST_COMMAND}"
      --build-and-test "${CMAKE_CURRENT_SOURCE_DIR}/Cxx" "${folder}"
      --build-generator "${CMAKE_GENERATOR}"
      --build-target "${target}"
      --build-options
        "-DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}"
        "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}"
        "-DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}"
        "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}"
        "-DVTK_DIR=${VTK_DIR}"
        ${ARGN}
      --test-command "${folder}/MeshBall" "${folder}/ball.vtu")
  set_tests_properties("Examples.Cxx.${name}" PROPERTIES
    TIMEOUT 1200 LABELS Examples PASS_REGULAR_EXPRESSION "[1-9][0-9]+ tetrahedra")
endfunction ()
voxplex_add_build_test(BuildTree MeshBall
  "-DVoxplex_DIR=${CMAKE_BINARY_DIR}/${VOXPLEX_PACKAGE_DESTINATION}")

get_property(installed GLOBAL PROPERTY VOXPLEX_TESTS_INSTALLATION)
if (NOT installed)
  return ()
endif ()
voxplex_add_build_test(InstallTree all "-DCMAKE_PREFIX_PATH=${VOXPLEX_TEST_PREFIX}.moved")
set_tests_properties(Examples.Cxx.InstallTree PROPERTIES
  FIXTURES_REQUIRED VoxplexInstalled FIXTURES_SETUP VoxplexExamples)

find_package(Python3 QUIET COMPONENTS Interpreter)
execute_process(
  COMMAND "${Python3_EXECUTABLE}" -c "import numpy, vtkmodules.vtkIOXML"
  RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
if (missing)
  voxplex_skip("Examples.Cxx.Run" "${Python3_EXECUTABLE} has no numpy or no VTK (set Python3_EXECUTABLE)")
  return ()
endif ()
add_test(NAME Examples.Cxx.Run
  COMMAND "${Python3_EXECUTABLE}" -B "${CMAKE_SOURCE_DIR}/Testing/Packaging/TestExamples.py" -v)
set_tests_properties(Examples.Cxx.Run PROPERTIES
  ENVIRONMENT "PYTHONPATH=${CMAKE_SOURCE_DIR}/Testing/Support;VOXPLEX_EXAMPLES=${CMAKE_CURRENT_BINARY_DIR}/Cxx/InstallTree"
  FIXTURES_REQUIRED VoxplexExamples TIMEOUT 600 LABELS Examples)

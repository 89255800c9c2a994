# Builds the example as a project outside of this one, against this build tree, and runs it.
find_package(VTK QUIET OPTIONAL_COMPONENTS IOXML)
if (NOT TARGET VTK::IOXML)
  voxplex_skip("Examples/Cxx" "VTK was found without IOXML")
  return ()
endif ()

set(_voxplex_example "${CMAKE_CURRENT_BINARY_DIR}/Cxx")
add_test(NAME Examples.Cxx.MeshBall
  COMMAND "${CMAKE_CTEST_COMMAND}"
    --build-and-test "${CMAKE_CURRENT_SOURCE_DIR}/Cxx" "${_voxplex_example}"
    --build-generator "${CMAKE_GENERATOR}"
    --build-options
      "-DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}"
      "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}"
      "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}"
      "-DVTK_DIR=${VTK_DIR}"
      "-DVoxplex_DIR=${CMAKE_BINARY_DIR}/${VOXPLEX_PACKAGE_DESTINATION}"
    --test-command "${_voxplex_example}/MeshBall" "${_voxplex_example}/ball.vtu")
set_tests_properties(Examples.Cxx.MeshBall PROPERTIES
  TIMEOUT 600 LABELS Examples PASS_REGULAR_EXPRESSION "[1-9][0-9]+ tetrahedra")

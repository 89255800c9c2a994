# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# What include(${Slicer_USE_FILE}) brings: the macros for modules. See SlicerConfig.cmake.
set(EXTENSION_NAME "${PROJECT_NAME}")
option(BUILD_TESTING "Build the tests of the extension" ON)

macro (slicerMacroBuildScriptedModule)
  cmake_parse_arguments(module "WITH_GENERIC_TESTS" "NAME" "SCRIPTS;RESOURCES" ${ARGN})
  if (module_UNPARSED_ARGUMENTS OR NOT module_NAME)
    message(FATAL_ERROR "slicerMacroBuildScriptedModule(${ARGN})")
  endif ()
  foreach (file IN LISTS module_SCRIPTS module_RESOURCES)
    get_source_file_property(generated "${file}" GENERATED)
    if (NOT generated AND NOT EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
      message(FATAL_ERROR "there is no ${file}")
    endif ()
    get_filename_component(folder "${file}" DIRECTORY)
    if (IS_ABSOLUTE "${folder}") # as Slicer's macro takes what is made in the build tree
      file(RELATIVE_PATH folder "${CMAKE_CURRENT_BINARY_DIR}" "${folder}")
    endif ()
    install(FILES "${file}"
      DESTINATION "${Slicer_INSTALL_QTSCRIPTEDMODULES_LIB_DIR}/${folder}" COMPONENT RuntimeLibraries)
  endforeach ()
endmacro ()

macro (slicer_add_python_unittest)
  cmake_parse_arguments(unittest "" "SCRIPT" "" ${ARGN})
  if (NOT EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${unittest_SCRIPT}")
    message(FATAL_ERROR "there is no ${unittest_SCRIPT}")
  endif ()
endmacro ()

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Read by cpack when the files are installed and before they are packed: what only a Debian package leaves out.
if (NOT CPACK_GENERATOR STREQUAL "DEB")
  return ()
endif ()

file(REMOVE_RECURSE "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share/licenses") # the copyright file has it

# The compiler's name, which CMake's way to strip files leaves in.
find_program(STRIP strip REQUIRED)
file(GLOB_RECURSE paths LIST_DIRECTORIES OFF "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*")
foreach (path IN LISTS paths)
  file(READ "${path}" magic LIMIT 4 HEX)
  if (magic STREQUAL "7f454c46" AND NOT IS_SYMLINK "${path}") # an ELF file
    execute_process(COMMAND "${STRIP}" --remove-section=.comment "${path}" COMMAND_ERROR_IS_FATAL ANY)
  endif ()
endforeach ()

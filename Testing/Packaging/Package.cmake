# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Makes the Debian package of the build tree BUILD in FOLDER and unpacks it into FOLDER/root.
#   cmake -DBUILD=... -DFOLDER=... -DCPACK=... -DCONFIG=... -P Package.cmake
foreach (variable IN ITEMS BUILD FOLDER CPACK)
  if (NOT ${variable})
    message(FATAL_ERROR "${variable} is not set")
  endif ()
endforeach ()
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
execute_process(
  COMMAND "${CPACK}" -G DEB -C "${CONFIG}" -B "${FOLDER}" --config "${BUILD}/CPackConfig.cmake"
  RESULT_VARIABLE failed
  OUTPUT_VARIABLE output
  ERROR_VARIABLE output)
if (failed)
  message(FATAL_ERROR "cpack failed:\n${output}")
endif ()
file(GLOB package "${FOLDER}/*.deb")
list(LENGTH package count)
if (NOT count EQUAL 1)
  message(FATAL_ERROR "cpack left ${count} packages: ${package}")
endif ()
execute_process(
  COMMAND dpkg -x "${package}" "${FOLDER}/root"
  RESULT_VARIABLE failed)
if (failed)
  message(FATAL_ERROR "dpkg could not unpack ${package}")
endif ()

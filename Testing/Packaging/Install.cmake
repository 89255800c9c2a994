# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Installs the build tree BUILD into PREFIX.moved: installed into PREFIX, and moved from there.
#   cmake -DBUILD=... -DPREFIX=... -DCONFIG=... -P Install.cmake
foreach (variable IN ITEMS BUILD PREFIX)
  if (NOT ${variable})
    message(FATAL_ERROR "${variable} is not set")
  endif ()
endforeach ()
file(REMOVE_RECURSE "${PREFIX}" "${PREFIX}.moved")
execute_process(
  COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${PREFIX}" --config "${CONFIG}"
  RESULT_VARIABLE failed
  OUTPUT_QUIET)
if (failed)
  message(FATAL_ERROR "installation failed")
endif ()
file(RENAME "${PREFIX}" "${PREFIX}.moved")

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Slicer wants these of each extension, and writes them into the package's description.
set(description "")
foreach (name IN ITEMS NAME HOMEPAGE CATEGORY CONTRIBUTORS DESCRIPTION ICONURL SCREENSHOTURLS DEPENDS)
  if (NOT EXTENSION_${name})
    message(FATAL_ERROR "EXTENSION_${name} is not set")
  endif ()
  string(APPEND description "${name} ${EXTENSION_${name}}\n")
endforeach ()
file(WRITE "${CMAKE_BINARY_DIR}/${EXTENSION_NAME}.description" "${description}")

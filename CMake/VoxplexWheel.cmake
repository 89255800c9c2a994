# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# What the wheel (pyproject.toml) has beside the program: the package that starts it. The prefix is the package's folder.

include(CMake/VoxplexPythonLayer.cmake)
voxplex_python_layer("${CMAKE_BINARY_DIR}/wheel" "${CMAKE_INSTALL_BINDIR}/voxplex" . wheel)

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Slicer writes the extension's CMake package here. See SlicerConfig.cmake.

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# macOS from Linux, by Scripts/test-cross: the compiler of Zig, which has header files of macOS, compiles and links; nothing
# runs. The command line sets CMAKE_SYSTEM_PROCESSOR and VOXPLEX_CROSS_ROOT (common.cmake), which has the compiler in bin/.
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_C_COMPILER "${VOXPLEX_CROSS_ROOT}/bin/cc")
set(CMAKE_CXX_COMPILER "${VOXPLEX_CROSS_ROOT}/bin/c++")
set(CMAKE_AR "${VOXPLEX_CROSS_ROOT}/bin/ar" CACHE FILEPATH "archiver")
set(CMAKE_RANLIB "${VOXPLEX_CROSS_ROOT}/bin/ranlib" CACHE FILEPATH "indexer of archives")
# Boost 1.74 wants std::unary_function, and GMP's header <cfloat>, which leaves NAN to <cmath>, and this to it, in strict C++.
set(CMAKE_CXX_FLAGS_INIT
  "-D_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION -U__STRICT_ANSI__ -include cfloat")
set(CMAKE_INSTALL_NAME_TOOL true) # for libraries that are installed
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# What both toolchains have in common. VOXPLEX_CROSS_ROOT is a folder with all that is not the compiler's:
# Scripts/test-cross puts header files of CGAL and Boost there, and GMP and GoogleTest, which it compiles.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VOXPLEX_CROSS_ROOT)
set(CMAKE_FIND_ROOT_PATH "${VOXPLEX_CROSS_ROOT}")
foreach (kind IN ITEMS LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach ()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(Boost_NO_BOOST_CMAKE ON)
# CGAL wants to find MPFR beside GMP, and calls nothing of it here.
set(MPFR_LIBRARIES "${VOXPLEX_CROSS_ROOT}/lib/libgmp.a" CACHE FILEPATH "in place of MPFR")

# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Windows from Linux, by Scripts/test-cross: mingw-w64 compiles, Wine runs. The command line sets VOXPLEX_CROSS_ROOT
# (common.cmake), which also has headers of the compiler, repaired.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_CROSSCOMPILING_EMULATOR wine)
set(CMAKE_CXX_FLAGS_INIT "-isystem ${VOXPLEX_CROSS_ROOT}/repaired")
set(CMAKE_EXE_LINKER_FLAGS_INIT -static) # then no library of the compiler has to be found when a test runs
include("${CMAKE_CURRENT_LIST_DIR}/common.cmake")

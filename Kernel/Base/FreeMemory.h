// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FreeMemory.h
 * @brief Returns memory to the system.
 */
#ifndef voxplex_FreeMemory_h
#define voxplex_FreeMemory_h

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace voxplex
{

/**
 * Returns memory that was freed to the system, where the C library offers it (glibc). Otherwise the
 * process may keep it, and what is allocated next comes on top. Thread-safe. The time grows with
 * the memory that the process has.
 */
inline void ReturnFreeMemory()
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

} // namespace voxplex

#endif

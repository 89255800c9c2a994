// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ProcessMemory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace voxplex::cli
{

void KeepFreedMemory()
{
#ifdef __GLIBC__
  constexpr int BytesAtOnce = 64 << 20; // address space; pages that are not used take no memory
  constexpr int MostArenas = 16;        // each keeps what its threads have freed
  mallopt(M_MMAP_MAX, 0);               // large arrays are not mapped one by one
  mallopt(M_TRIM_THRESHOLD, -1);        // never
  mallopt(M_TOP_PAD, BytesAtOnce);
  mallopt(M_ARENA_MAX, MostArenas);
#endif
}

} // namespace voxplex::cli

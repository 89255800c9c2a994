// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VoxelMemory.h"

#include "ScalarImage.h"

#include <new>

#include <unistd.h>

namespace voxplex::io
{

std::uint64_t MemoryOfMachine()
{
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
    static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::shared_ptr<void> NewVoxels(std::size_t bytes)
{
  if (bytes > MemoryOfMachine())
  {
    throw std::bad_alloc();
  }
  return AllocateVoxels(bytes);
}

} // namespace voxplex::io

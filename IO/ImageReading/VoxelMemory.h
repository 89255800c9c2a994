// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VoxelMemory.h
 * @brief Memory for voxels in this process.
 */
#ifndef voxplex_io_VoxelMemory_h
#define voxplex_io_VoxelMemory_h

#include <cstddef>
#include <cstdint>
#include <memory>

namespace voxplex::io
{

/** In bytes. */
std::uint64_t MemoryOfMachine();

/** In which nothing is set. @throws std::bad_alloc, also if the machine has less memory than that */
std::shared_ptr<void> NewVoxels(std::size_t bytes);

} // namespace voxplex::io

#endif

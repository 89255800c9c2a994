// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SharedMemory.h
 * @brief Memory that has a file descriptor, so that two processes can have it.
 */
#ifndef voxplex_io_SharedMemory_h
#define voxplex_io_SharedMemory_h

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

namespace voxplex::io
{

/** @throws std::bad_alloc if the machine has less */
void RefuseMoreThanMemory(std::uint64_t bytes);

/** A descriptor of no bytes yet, which is closed when a program is executed; -1 if there is none to be had. */
int MakeSharedMemory();

/** Appends to the memory of a descriptor, and gives back what no pointer refers to any more. */
class SharedMemoryWriter
{
public:
  explicit SharedMemoryWriter(int descriptor)
    : Descriptor(descriptor)
  {
  }

  /** @throws std::bad_alloc if the machine has less memory than that */
  std::shared_ptr<void> Allocate(std::size_t bytes);

  /** Where an allocation begins. @throws std::out_of_range for other memory */
  std::uint64_t OffsetOf(const void* allocation) const { return this->Offsets.at(allocation); }

private:
  int Descriptor;
  std::uint64_t Size = 0;
  std::map<const void*, std::uint64_t> Offsets;
};

/** How many bytes there are, of which nobody can take any away from now on; 0 if that cannot be had. */
std::uint64_t FixSharedMemory(int descriptor);

/** The memory from an offset on, for as long as the pointer lives; the descriptor may be closed. @throws
 * std::bad_alloc */
std::shared_ptr<void> MapSharedMemory(int descriptor, std::uint64_t offset, std::size_t bytes);

} // namespace voxplex::io

#endif

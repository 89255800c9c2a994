// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PageMemory.h
 * @brief What the kernel asks the system itself for: memory by pages, and how much there is.
 */
#ifndef voxplex_PageMemory_h
#define voxplex_PageMemory_h

#include <cstddef>
#include <cstdint>

namespace voxplex
{

/**
 * Allocates at least 64 KiB, which go back to the system as soon as they are freed. A C library may keep memory of
 * this size, and then what is allocated next comes on top. Thread-safe.
 * @return aligned to 64 bytes; pages that are not touched take no memory
 * @throws std::bad_alloc
 */
void* AllocatePages(std::size_t bytes);

/** @param bytes as they were asked for */
void FreePages(void* pages, std::size_t bytes);

/** Bytes of memory that the machine has. */
std::uint64_t PhysicalMemory();

} // namespace voxplex

#endif

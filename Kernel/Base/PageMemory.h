// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PageMemory.h
 * @brief Memory that goes back to the system as soon as it is freed.
 */
#ifndef voxplex_PageMemory_h
#define voxplex_PageMemory_h

#include <cstddef>
#include <new>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace voxplex
{

/**
 * Allocates at least 64 KiB. A C library may keep memory of this size after it is freed, and then
 * what is allocated next comes on top. So this asks the system itself for pages, where it can
 * (POSIX). Thread-safe.
 * @return aligned to 64 bytes; pages that are not touched take no memory
 * @throws std::bad_alloc
 */
inline void* AllocatePages(std::size_t bytes)
{
#if __has_include(<sys/mman.h>)
  void* const pages =
    ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  return pages;
#else
  return ::operator new(bytes, std::align_val_t(64));
#endif
}

/** @param bytes as they were asked for */
inline void FreePages(void* pages, [[maybe_unused]] std::size_t bytes)
{
#if __has_include(<sys/mman.h>)
  ::munmap(pages, bytes);
#else
  ::operator delete(pages, std::align_val_t(64));
#endif
}

} // namespace voxplex

#endif

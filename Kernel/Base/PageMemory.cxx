// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/PageMemory.h"

#include <new>

#ifdef _WIN32
#include <windows.h>
#else
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace voxplex
{

#ifdef _WIN32 // which has no mmap and no sysconf

void* AllocatePages(std::size_t bytes)
{
  void* const pages = VirtualAlloc(nullptr, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
  if (!pages)
  {
    throw std::bad_alloc();
  }
  return pages;
}

void FreePages(void* pages, std::size_t)
{
  VirtualFree(pages, 0, MEM_RELEASE);
}

std::uint64_t PhysicalMemory()
{
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof(status);
  return GlobalMemoryStatusEx(&status) ? status.ullTotalPhys : 0;
}

#else

void* AllocatePages(std::size_t bytes)
{
  void* const pages =
    ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  return pages;
}

void FreePages(void* pages, std::size_t bytes)
{
  ::munmap(pages, bytes);
}

std::uint64_t PhysicalMemory()
{
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
    static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

#endif

} // namespace voxplex

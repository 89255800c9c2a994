// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SharedMemory.h"

#include <cstdio>
#include <new>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace voxplex::io
{
namespace
{

std::uint64_t PageSize()
{
  return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/** Maps whole pages around what is asked for. */
std::shared_ptr<void> Map(int descriptor, std::uint64_t offset, std::size_t bytes, int flags,
  [[maybe_unused]] bool isGivenBack)
{
  const std::uint64_t inPage = offset % PageSize();
  const std::size_t length = bytes + static_cast<std::size_t>(inPage);
  const auto start = static_cast<off_t>(offset - inPage);
  void* const pages = mmap(nullptr, length, PROT_READ | PROT_WRITE, flags, descriptor, start);
  if (pages == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  return { static_cast<std::byte*>(pages) + inPage,
    [=](void*)
    {
      munmap(pages, length);
#if defined(FALLOC_FL_PUNCH_HOLE)
      if (isGivenBack)
      {
        [[maybe_unused]] const int done = fallocate(descriptor,
          FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, start, static_cast<off_t>(length));
      }
#endif
    } };
}

} // namespace

void RefuseMoreThanMemory(std::uint64_t bytes)
{
  if (bytes / PageSize() > static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)))
  {
    throw std::bad_alloc();
  }
}

int MakeSharedMemory()
{
#if defined(MFD_ALLOW_SEALING)
  return memfd_create("voxplex-voxels", MFD_CLOEXEC | MFD_ALLOW_SEALING);
#else
  std::FILE* const file = std::tmpfile(); // which has no name
  const int descriptor = file ? fcntl(fileno(file), F_DUPFD_CLOEXEC, 3) : -1;
  if (file)
  {
    std::fclose(file);
  }
  return descriptor;
#endif
}

std::shared_ptr<void> SharedMemoryWriter::Allocate(std::size_t bytes)
{
  RefuseMoreThanMemory(bytes);
  const std::uint64_t offset = this->Size;
  this->Size += (bytes + PageSize() - 1) / PageSize() * PageSize();
  if (ftruncate(this->Descriptor, static_cast<off_t>(this->Size)) != 0)
  {
    throw std::bad_alloc();
  }
  const std::shared_ptr<void> memory = Map(this->Descriptor, offset, bytes, MAP_SHARED, true);
  this->Offsets[memory.get()] = offset;
  return memory;
}

std::uint64_t FixSharedMemory(int descriptor)
{
#if defined(F_ADD_SEALS)
  if (fcntl(descriptor, F_ADD_SEALS, F_SEAL_SHRINK) != 0)
  {
    return 0;
  }
#endif
  struct stat status
  {
  };
  return fstat(descriptor, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

std::shared_ptr<void> MapSharedMemory(int descriptor, std::uint64_t offset, std::size_t bytes)
{
#if defined(MAP_POPULATE)
  constexpr int flags = MAP_SHARED | MAP_POPULATE;
#else
  constexpr int flags = MAP_SHARED;
#endif
  return Map(descriptor, offset, bytes, flags, false);
}

} // namespace voxplex::io

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file KillSwitch.cxx
 * @brief Preloaded, kills the process as kill -9 does at a chosen one of the steps by which it changes files.
 *
 * Steps are: to open a regular file for writing, to write to one, to close one through stdio, to rename and to
 * remove. Writing is killed when the first half is in the file, and all others before they happen. The step comes
 * from the environment variable VOXPLEX_KILL_AT or a call of VoxplexKillAt(), and counts from 1; 0 switches off.
 */
#include <atomic>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

namespace
{

long FromEnvironment()
{
  const char* text = std::getenv("VOXPLEX_KILL_AT");
  return text ? std::atol(text) : 0;
}

/** Smaller blocks are not counted as steps: VTK and stdio write numbers one by one, in hundreds of blocks. */
constexpr size_t SmallestBlock = 256;

/** Steps that are left; 0 if the switch is off. */
std::atomic<long> StepsLeft = FromEnvironment();

/** The function that this library hides. */
template <typename T>
T* Hidden(const char* name)
{
  return reinterpret_cast<T*>(dlsym(RTLD_NEXT, name));
}

bool IsRegular(int descriptor)
{
  struct stat status;
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

/** Whether this step is the one. */
bool IsTheStep()
{
  return StepsLeft > 0 && --StepsLeft == 0;
}

void Kill()
{
  raise(SIGKILL);
}

void Step()
{
  if (IsTheStep())
  {
    Kill();
  }
}

bool Writes(const char* mode)
{
  return std::strpbrk(mode, "wa+") != nullptr;
}

void StepIfWriting(int flags)
{
  if ((flags & O_ACCMODE) != O_RDONLY)
  {
    Step();
  }
}

/** The permissions for a new file, the third argument of open(). */
mode_t TakeMode(int flags, va_list arguments)
{
  return flags & (O_CREAT | O_TMPFILE) ? static_cast<mode_t>(va_arg(arguments, unsigned)) : 0;
}

} // namespace

extern "C"
{
  void VoxplexKillAt(long step)
  {
    StepsLeft = step;
  }

  FILE* fopen(const char* path, const char* mode)
  {
    static auto* const hidden = Hidden<FILE*(const char*, const char*)>("fopen");
    if (Writes(mode))
    {
      Step();
    }
    return hidden(path, mode);
  }

  FILE* fopen64(const char* path, const char* mode)
  {
    static auto* const hidden = Hidden<FILE*(const char*, const char*)>("fopen64");
    if (Writes(mode))
    {
      Step();
    }
    return hidden(path, mode);
  }

  int open(const char* path, int flags, ...)
  {
    static auto* const hidden = Hidden<int(const char*, int, ...)>("open");
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = TakeMode(flags, arguments);
    va_end(arguments);
    StepIfWriting(flags);
    return hidden(path, flags, mode);
  }

  int open64(const char* path, int flags, ...)
  {
    static auto* const hidden = Hidden<int(const char*, int, ...)>("open64");
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = TakeMode(flags, arguments);
    va_end(arguments);
    StepIfWriting(flags);
    return hidden(path, flags, mode);
  }

  ssize_t write(int descriptor, const void* data, size_t size)
  {
    static auto* const hidden = Hidden<ssize_t(int, const void*, size_t)>("write");
    if (size >= SmallestBlock && IsRegular(descriptor) && IsTheStep())
    {
      hidden(descriptor, data, size / 2);
      Kill();
    }
    return hidden(descriptor, data, size);
  }

  ssize_t writev(int descriptor, const iovec* parts, int count)
  {
    static auto* const hidden = Hidden<ssize_t(int, const iovec*, int)>("writev");
    if (IsRegular(descriptor) && IsTheStep())
    {
      hidden(descriptor, parts, count / 2);
      Kill();
    }
    return hidden(descriptor, parts, count);
  }

  size_t fwrite(const void* data, size_t size, size_t count, FILE* file)
  {
    static auto* const hidden = Hidden<size_t(const void*, size_t, size_t, FILE*)>("fwrite");
    if (size * count >= SmallestBlock && IsRegular(fileno(file)) && IsTheStep())
    {
      hidden(data, size, count / 2, file);
      std::fflush(file);
      Kill();
    }
    return hidden(data, size, count, file);
  }

  int fclose(FILE* file)
  {
    static auto* const hidden = Hidden<int(FILE*)>("fclose");
    if ((fcntl(fileno(file), F_GETFL) & O_ACCMODE) != O_RDONLY && IsRegular(fileno(file)))
    {
      Step();
    }
    return hidden(file);
  }

  int rename(const char* from, const char* to) noexcept
  {
    static auto* const hidden = Hidden<int(const char*, const char*)>("rename");
    Step();
    return hidden(from, to);
  }

  int unlink(const char* path) noexcept
  {
    static auto* const hidden = Hidden<int(const char*)>("unlink");
    Step();
    return hidden(path);
  }

  int remove(const char* path) noexcept
  {
    static auto* const hidden = Hidden<int(const char*)>("remove");
    Step();
    return hidden(path);
  }
}

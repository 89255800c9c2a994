// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "InputFile.h"

#include "FileError.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace voxplex::io
{
namespace
{

#ifdef _WIN32 // where opening never waits, files have kinds, and a position is set before it is read

constexpr int Flags = O_RDONLY | O_BINARY | O_NOINHERIT;
using Status = struct _stat64;

int StatusOf(int file, Status* status)
{
  return _fstat64(file, status);
}

ssize_t ReadSome(int file, std::byte* to, std::size_t bytes, std::uint64_t position)
{
  return _lseeki64(file, static_cast<std::int64_t>(position), SEEK_SET) < 0
    ? -1
    : read(file, to, static_cast<unsigned>(bytes));
}

#else

constexpr int Flags = O_RDONLY | O_NONBLOCK | O_CLOEXEC;
using Status = struct stat;

int StatusOf(int file, Status* status)
{
  return fstat(file, status);
}

ssize_t ReadSome(int file, std::byte* to, std::size_t bytes, std::uint64_t position)
{
  return pread(file, to, bytes, static_cast<off_t>(position));
}

#endif

} // namespace

InputFile::InputFile(const std::string& path)
  : Name(path)
  , File(open(path.c_str(), Flags))
{
  if (this->File < 0)
  {
    throw FileError(std::strerror(errno));
  }
  Status status{};
  if (StatusOf(this->File, &status) != 0 || !S_ISREG(status.st_mode))
  {
    close(this->File);
    throw FileError("it is not a regular file");
  }
  this->Bytes = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile()
{
  close(this->File);
}

std::size_t InputFile::ReadAt(std::uint64_t position, std::span<std::byte> to) const
{
  constexpr std::size_t most = 1 << 30; // of one call
  std::size_t done = 0;
  while (done < to.size() && position + done < this->Bytes)
  {
    const ssize_t got =
      ReadSome(this->File, to.data() + done, std::min(most, to.size() - done), position + done);
    if (got < 0 && errno == EINTR)
    {
      continue;
    }
    if (got < 0)
    {
      throw FileError(std::strerror(errno));
    }
    if (got == 0)
    {
      break;
    }
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::string InputFile::Beginning(std::size_t length) const
{
  std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(length, this->Bytes)), '\0');
  text.resize(this->ReadAt(0, std::as_writable_bytes(std::span(text))));
  return text;
}

} // namespace voxplex::io

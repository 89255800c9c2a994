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

InputFile::InputFile(const std::string& path)
  : Name(path)
  , File(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC))
{
  if (this->File < 0)
  {
    throw FileError(std::strerror(errno));
  }
  struct stat status = {};
  if (fstat(this->File, &status) != 0 || !S_ISREG(status.st_mode))
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
    const ssize_t got = pread(this->File, to.data() + done, std::min(most, to.size() - done),
      static_cast<off_t>(position + done));
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

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InputFile.h
 * @brief A regular file that is open for reading.
 */
#ifndef voxplex_io_InputFile_h
#define voxplex_io_InputFile_h

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace voxplex::io
{

/** Opening and reading never wait, as they would for a FIFO. */
class InputFile
{
public:
  /** @throws FileError with the reason: no such file, not allowed, not a regular file */
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& Path() const { return this->Name; }
  std::uint64_t Size() const { return this->Bytes; }
  int Descriptor() const { return this->File; }

  /** @return how many bytes there were at this position; fewer than asked for only at the end of the file */
  std::size_t ReadAt(std::uint64_t position, std::span<std::byte> to) const;

  /** The first bytes: `length` of them, or all that there are. */
  std::string Beginning(std::size_t length) const;

private:
  std::string Name;
  std::uint64_t Bytes = 0;
  int File = -1;
};

} // namespace voxplex::io

#endif

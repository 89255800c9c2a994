// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "TextFile.h"

#include "FileError.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

namespace voxplex::io
{
namespace
{
constexpr std::size_t BufferSize = 1 << 16;
}

TextFile::TextFile(const std::string& path)
  : File(std::fopen(path.c_str(), "wb"))
{
  if (!this->File)
  {
    throw FileError(std::strerror(errno));
  }
  this->Buffer.reserve(BufferSize + 256);
}

TextFile& TextFile::operator<<(std::string_view text)
{
  this->Buffer += text;
  if (this->Buffer.size() >= BufferSize)
  {
    this->Flush();
  }
  return *this;
}

TextFile& TextFile::operator<<(double value)
{
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return *this << std::string_view(text.data(), static_cast<std::size_t>(end - text.data()));
}

void TextFile::Flush()
{
  if (std::fwrite(this->Buffer.data(), 1, this->Buffer.size(), this->File.get()) !=
    this->Buffer.size())
  {
    throw FileError(std::strerror(errno));
  }
  this->Buffer.clear();
}

void TextFile::Close()
{
  this->Flush();
  if (std::fclose(this->File.release()) != 0)
  {
    throw FileError(std::strerror(errno));
  }
}

} // namespace voxplex::io

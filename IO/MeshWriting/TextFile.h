// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TextFile.h
 * @brief A buffered text file with numbers that do not depend on the locale.
 */
#ifndef voxplex_io_TextFile_h
#define voxplex_io_TextFile_h

#include <concepts>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace voxplex::io
{

/** Append with operator<<; call Close() at the end, or the file counts as failed. */
class TextFile
{
public:
  /** @throws FileError */
  explicit TextFile(const std::string& path);

  TextFile& operator<<(std::string_view text);
  TextFile& operator<<(char character) { return *this << std::string_view(&character, 1); }
  /** The shortest text that reads back as the same number. */
  TextFile& operator<<(double value);
  template <std::integral T>
  TextFile& operator<<(T value)
  {
    return *this << std::string_view(std::to_string(value));
  }

  /** Writes what is left. @throws FileError, here or earlier, if the disk is full */
  void Close();

private:
  void Flush();

  struct Closer
  {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Closer> File;
  std::string Buffer;
};

} // namespace voxplex::io

#endif

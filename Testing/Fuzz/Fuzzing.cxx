// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Fuzzing.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <unistd.h>

namespace fs = std::filesystem;

namespace voxplex::fuzz
{
namespace
{

struct Folder
{
  fs::path Path = fs::temp_directory_path() / ("voxplex-fuzz-" + std::to_string(getpid()));

  Folder() { fs::create_directories(this->Path); }
  ~Folder()
  {
    std::error_code ignored;
    fs::remove_all(this->Path, ignored);
  }
};

} // namespace

void Fail(const std::string& what)
{
  std::fprintf(stderr, "fuzzer: %s\n", what.c_str());
  std::abort();
}

std::string PathOf(const std::string& name)
{
  static const Folder folder;
  return (folder.Path / name).string();
}

void Write(const std::string& path, const void* data, std::size_t size)
{
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (!file || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0)
  {
    Fail("cannot write " + path);
  }
}

void CheckRefusal(std::string_view message, const std::string& path)
{
  if (message.find(path) == std::string_view::npos)
  {
    Fail("the message does not name the file: " + std::string(message));
  }
  if (message.find('\n') != std::string_view::npos)
  {
    Fail("the message has several lines: " + std::string(message));
  }
}

} // namespace voxplex::fuzz

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "WholeFile.h"

#include "FileError.h"

#include <atomic>

#include <unistd.h>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

/** No two files of this process, and none of another, have the same, be it one that was killed. */
fs::path HiddenName(const fs::path& folder, const fs::path& target)
{
  static std::atomic<unsigned> count = 0;
  const std::string begin = ".voxplex-" + std::to_string(getpid()) + "-file";
  std::error_code ignored;
  fs::path path;
  do
  {
    path = folder / (begin + std::to_string(count++) + target.extension().string());
  } while (fs::exists(path, ignored));
  return path;
}

} // namespace

WholeFile::WholeFile(const std::string& path)
  : Target(path)
{
  const fs::path folder = this->Target.has_parent_path() ? this->Target.parent_path() : ".";
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored))
  {
    throw FileError("there is no folder '" + folder.string() + "'; create it first");
  }
  const fs::file_status status = fs::status(this->Target, ignored);
  if (fs::is_directory(status))
  {
    throw FileError("it is a folder; give a file name");
  }
  if (fs::exists(status) && !fs::is_regular_file(status))
  {
    throw FileError("it exists and is not a regular file");
  }
  this->Temporary = HiddenName(folder, this->Target).string();
}

WholeFile::~WholeFile()
{
  std::error_code ignored;
  fs::remove(this->Temporary, ignored);
}

void WholeFile::RemoveOlder() const
{
  std::error_code ignored;
  fs::remove(this->Target, ignored);
}

void WholeFile::Commit()
{
  std::error_code error;
  fs::rename(this->Temporary, this->Target, error);
  if (error)
  {
    throw FileError(error.message());
  }
}

} // namespace voxplex::io

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "WholeFiles.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <unistd.h>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

fs::path FolderOf(const fs::path& path)
{
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/** Absolute and without links, whether the file exists or not. */
fs::path Canonical(const fs::path& path)
{
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
}

void CheckTarget(const std::string& path)
{
  std::error_code ignored;
  const fs::path folder = FolderOf(path);
  if (!fs::is_directory(folder, ignored))
  {
    throw OutputError(path, "there is no folder '" + folder.string() + "'; create it first");
  }
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status))
  {
    throw OutputError(path, "it is a folder; give a file name");
  }
  if (fs::exists(status) && !fs::is_regular_file(status))
  {
    throw OutputError(path, "it exists and is not a regular file");
  }
}

/**
 * A hidden name beside the file that no other file has. Creates this file and removes it: no other test
 * of a folder's permissions holds on every file system.
 */
std::string HiddenName(const std::string& path)
{
  const std::string extension = fs::path(path).extension().string();
  std::string name = (FolderOf(path) / (".voxplex-XXXXXX" + extension)).string();
  const int descriptor = mkstemps(name.data(), static_cast<int>(extension.size()));
  if (descriptor < 0)
  {
    throw OutputError(
      path, "its folder does not take new files (" + std::generic_category().message(errno) + ")");
  }
  close(descriptor);
  unlink(name.c_str());
  return name;
}

} // namespace

WholeFiles::~WholeFiles()
{
  for (const auto& [path, file] : this->Files)
  {
    std::error_code ignored;
    fs::remove(file.Temporary, ignored);
  }
}

void WholeFiles::Add(const std::string& path, const std::string& companion)
{
  CheckTarget(path);
  if (!this->Targets.insert(Canonical(path).string()).second)
  {
    throw OutputError(path, "two outputs have this name");
  }
  this->Files[path] = { HiddenName(path), !companion.empty() };
  if (!companion.empty())
  {
    this->Add(companion);
  }
}

void WholeFiles::ForbidOverwriting(const std::string& inputPath) const
{
  for (const auto& [path, file] : this->Files)
  {
    std::error_code ignored;
    if (fs::equivalent(path, inputPath, ignored))
    {
      throw OutputError(path, "it is the input");
    }
  }
}

const std::string& WholeFiles::TemporaryPath(const std::string& path) const
{
  return this->Files.at(path).Temporary;
}

void WholeFiles::WriteText(
  const std::string& path, const std::function<void(TextFile& file)>& write) const
{
  try
  {
    TextFile file(this->TemporaryPath(path));
    write(file);
    file.Close();
  }
  catch (const FileError& error)
  {
    throw OutputError(path, error.what());
  }
}

void WholeFiles::Commit()
{
  // Killed at any point, this leaves no file beside a companion of another run: an older file goes
  // before its companion changes, and the new one comes after it.
  for (const auto& [path, file] : this->Files)
  {
    if (file.HasCompanion)
    {
      std::error_code ignored;
      fs::remove(path, ignored);
    }
  }
  for (const bool hasCompanion : { false, true })
  {
    for (const auto& [path, file] : this->Files)
    {
      if (file.HasCompanion == hasCompanion)
      {
        this->Move(path, file);
      }
    }
  }
  this->Files.clear();
}

void WholeFiles::Move(const std::string& path, const File& file)
{
  std::error_code error;
  fs::rename(file.Temporary, path, error);
  if (error)
  {
    throw OutputError(path, error.message());
  }
}

} // namespace voxplex::io

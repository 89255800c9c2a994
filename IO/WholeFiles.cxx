// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "WholeFiles.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <random>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
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

/** Where a path leads: the file itself, or that behind its symbolic links, which need not exist. */
fs::path TargetOf(const std::string& path)
{
  // The system is asked first: it knows circles, and links of other users that it does not follow.
  std::error_code error;
  if (fs::status(path, error).type() == fs::file_type::none)
  {
    throw OutputError(path,
      error == std::errc::too_many_symbolic_link_levels
        ? "its symbolic links lead in a circle; remove them"
        : error.message());
  }
  fs::path target = path;
  while (fs::is_symlink(fs::symlink_status(target, error)))
  {
    target = target.parent_path() / fs::read_symlink(target, error);
  }
  return target;
}

#ifdef _WIN32 // where users have what rights the folder gives them

bool IsWritable(const std::string& path)
{
  return access(path.c_str(), W_OK) == 0;
}

void CopyPermissions(const std::string&, const std::string&) {}

#else

bool IsWritable(const std::string& path)
{
  return faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0;
}

/** Gives a new file the permissions of the one that it replaces, and its owner and group if the user may. */
void CopyPermissions(const std::string& from, const std::string& to)
{
  struct stat old = {};
  if (stat(from.c_str(), &old) != 0)
  {
    return; // a new name: the file has what the process gives to new files
  }
  // Users who are not root may give the group only. Permissions come last: chown() takes some of them away.
  constexpr auto sameOwner = static_cast<uid_t>(-1);
  [[maybe_unused]] const bool given =
    chown(to.c_str(), old.st_uid, old.st_gid) == 0 || chown(to.c_str(), sameOwner, old.st_gid) == 0;
  chmod(to.c_str(), old.st_mode & 0777);
}

#endif

/** @param path as it was given, for messages */
void CheckTarget(const std::string& path, const fs::path& target)
{
  std::error_code ignored;
  const fs::path folder = FolderOf(target);
  if (!fs::is_directory(folder, ignored))
  {
    throw OutputError(path, "there is no folder '" + folder.string() + "'; create it first");
  }
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status))
  {
    throw OutputError(path, "it is a folder; give a file name");
  }
  if (!fs::exists(status))
  {
    return;
  }
  if (!fs::is_regular_file(status))
  {
    throw OutputError(path, "it exists and is not a regular file");
  }
  if (!IsWritable(target.string()))
  {
    throw OutputError(path,
      "the file that is there is write-protected (" + std::generic_category().message(errno) +
        "); make it writable, or take another name");
  }
}

/**
 * A hidden name in a folder that no other file has. Creates this file and removes it: no other test
 * of a folder's permissions holds on every file system.
 *
 * @param path as it was given, for its extension and for messages
 */
std::string HiddenName(const std::string& path, const fs::path& folder)
{
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789";
  const std::string extension = fs::path(path).extension().string();
  std::random_device random;
  std::string name;
  int descriptor = -1;
  do
  {
    std::string unique(6, ' ');
    std::generate(
      unique.begin(), unique.end(), [&]() { return letters[random() % letters.size()]; });
    name = (folder / (".voxplex-" + unique + extension)).string();
    descriptor = open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, 0600);
  } while (descriptor < 0 && errno == EEXIST);
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
  const fs::path target = TargetOf(path);
  CheckTarget(path, target);
  if (!this->Targets.insert(Canonical(target).string()).second)
  {
    throw OutputError(path, "two outputs have this name");
  }
  this->Files[path] = { target.string(), HiddenName(path, FolderOf(target)), !companion.empty() };
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
  for (const auto& [path, file] : this->Files)
  {
    CopyPermissions(file.Target, file.Temporary);
  }
  // Killed at any point, this leaves no file beside a companion of another run: an older file goes
  // before its companion changes, and the new one comes after it.
  for (const auto& [path, file] : this->Files)
  {
    if (file.HasCompanion)
    {
      std::error_code ignored;
      fs::remove(file.Target, ignored);
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
  fs::rename(file.Temporary, file.Target, error);
  if (error)
  {
    throw OutputError(path, error.message());
  }
}

} // namespace voxplex::io

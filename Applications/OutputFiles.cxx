// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "OutputFiles.h"

#include "Errors.h"
#include "FileError.h"

#include <vtkSimplexMeshWriter.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace voxplex::cli
{
namespace
{

[[noreturn]] void Refuse(const std::string& path, const std::string& reason)
{
  throw RunError("cannot write '" + path + "': " + reason);
}

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

/** A hidden name that is free in the folder. A process that was killed may have left files there. */
std::string FreeName(const fs::path& target, std::size_t number)
{
  const std::string begin = ".voxplex-" + std::to_string(getpid()) + "-" + std::to_string(number);
  fs::path path;
  std::error_code ignored;
  int attempt = 0;
  do
  {
    const std::string more = attempt == 0 ? "" : "-" + std::to_string(attempt);
    path = FolderOf(target) / (begin + more + target.extension().string());
    ++attempt;
  } while (fs::exists(path, ignored));
  return path.string();
}

/** Creates and removes the temporary: the only test that holds on every file system. */
void ProbeFolder(const std::string& path, const std::string& temporary)
{
  const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0)
  {
    Refuse(path, std::string("its folder does not take new files (") + std::strerror(errno) + ")");
  }
  close(descriptor);
  unlink(temporary.c_str());
}

} // namespace

OutputFiles::~OutputFiles()
{
  for (const auto& [path, temporary] : this->Files)
  {
    unlink(temporary.Path.c_str());
    Interruption::ForgetTemporary(temporary.Record);
  }
}

void OutputFiles::Add(const std::string& path)
{
  std::error_code ignored;
  const fs::path target(path);
  const fs::path folder = FolderOf(target);
  if (!fs::is_directory(folder, ignored))
  {
    Refuse(path, "there is no folder '" + folder.string() + "'; create it first");
  }
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status))
  {
    Refuse(path, "it is a folder; give a file name");
  }
  if (fs::exists(status) && !fs::is_regular_file(status))
  {
    Refuse(path, "it exists and is not a regular file");
  }
  if (!this->Targets.insert(Canonical(target).string()).second)
  {
    Refuse(path, "two outputs have this name");
  }
  const std::string temporary = FreeName(target, this->Files.size());
  ProbeFolder(path, temporary);
  this->Files[path] = { temporary, Interruption::AddTemporary(temporary) };
}

void OutputFiles::ForbidOverwriting(const std::string& inputPath) const
{
  for (const auto& [path, temporary] : this->Files)
  {
    std::error_code ignored;
    if (fs::equivalent(path, inputPath, ignored))
    {
      Refuse(path, "it is the input");
    }
  }
}

const std::string& OutputFiles::TemporaryPath(const std::string& path) const
{
  const auto file = this->Files.find(path);
  if (file == this->Files.end())
  {
    throw std::logic_error("OutputFiles: '" + path + "' was not announced");
  }
  return file->second.Path;
}

void OutputFiles::WriteText(
  const std::string& path, const std::function<void(io::TextFile& file)>& write) const
{
  try
  {
    io::TextFile file(this->TemporaryPath(path));
    write(file);
    file.Close();
  }
  catch (const io::FileError& error)
  {
    Refuse(path, error.what());
  }
}

void OutputFiles::Commit()
{
  const Interruption::Deferral deferral;
  // The two files of a format are never of different meshes, even if the process ends in between.
  for (const auto& [path, temporary] : this->Files)
  {
    if (!vtkSimplexMeshWriter::CompanionOf(path).empty())
    {
      unlink(path.c_str());
    }
  }
  for (const auto& [path, temporary] : this->Files)
  {
    if (std::rename(temporary.Path.c_str(), path.c_str()) != 0)
    {
      Refuse(path, std::strerror(errno));
    }
    Interruption::ForgetTemporary(temporary.Record);
  }
  this->Files.clear();
}

} // namespace voxplex::cli

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WholeFile.h
 * @brief A file that appears whole or not at all.
 */
#ifndef voxplex_io_WholeFile_h
#define voxplex_io_WholeFile_h

#include <filesystem>
#include <string>

namespace voxplex::io
{

/** Is written beside its place under a temporary name, which Commit() changes; else it is removed. */
class WholeFile
{
public:
  /** @throws FileError: the folder does not exist, or the name is that of a folder or device */
  explicit WholeFile(const std::string& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /** Where to write; the extension is that of the file. */
  const std::string& TemporaryPath() const { return this->Temporary; }

  /** Removes an older file from its place, if there is one, before Commit() does. */
  void RemoveOlder() const;

  /** Moves the file to its place, where it replaces an older one. @throws FileError */
  void Commit();

private:
  std::filesystem::path Target;
  std::string Temporary;
};

} // namespace voxplex::io

#endif

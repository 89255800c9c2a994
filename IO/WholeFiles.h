// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WholeFiles.h
 * @brief Files that appear whole or not at all.
 */
#ifndef voxplex_io_WholeFiles_h
#define voxplex_io_WholeFiles_h

#include "FileError.h"
#include "MeshWriting/TextFile.h"

#include <functional>
#include <map>
#include <set>
#include <string>

namespace voxplex::io
{

/** A file cannot be written; the message names it. */
class OutputError : public FileError
{
public:
  OutputError(const std::string& path, const std::string& reason)
    : FileError("cannot write '" + path + "': " + reason)
  {
  }
};

/**
 * Each file is written beside its place under a hidden name, which Commit() changes when all files are
 * complete. Without Commit() the destructor removes them, and older files stay as they were.
 *
 * A path may be a symbolic link, also one to nothing yet: the file appears where it leads, and the link stays. Of a
 * file with several names (hard links) only this one gets the new contents. A file that replaces another has its
 * permissions, and its owner and group if the user may give them; access control lists are not kept.
 */
class WholeFiles
{
public:
  WholeFiles() = default;
  ~WholeFiles();
  WholeFiles(const WholeFiles&) = delete;
  WholeFiles& operator=(const WholeFiles&) = delete;

  /**
   * Announces a file, and checks at once that it can be written.
   *
   * @param companion a second file, announced with the first, which refers to it; may be empty. The two
   *   are never of two runs, even if Commit() is killed.
   * @throws OutputError: the folder does not exist or takes no files, or the name is that of a folder,
   *   of a device, of a write-protected file, of a file announced before, or of a link that leads to itself
   */
  void Add(const std::string& path, const std::string& companion = {});

  /** Refuses to overwrite a file that is read. @throws OutputError */
  void ForbidOverwriting(const std::string& inputPath) const;

  /** Where to write an announced file; the extension is that of the path. */
  const std::string& TemporaryPath(const std::string& path) const;

  /** Writes a text file that was announced. @throws OutputError */
  void WriteText(const std::string& path, const std::function<void(TextFile& file)>& write) const;

  /** Moves all files to their places, where they replace older ones. @throws OutputError */
  void Commit();

private:
  struct File
  {
    std::string Target; ///< the path, or where its symbolic links lead
    std::string Temporary;
    bool HasCompanion = false;
  };

  void Move(const std::string& path, const File& file);

  std::map<std::string, File> Files; ///< by the path that was given
  std::set<std::string> Targets;     ///< the same files, absolute and without links
};

} // namespace voxplex::io

#endif

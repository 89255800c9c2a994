// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutputFiles.h
 * @brief Output files that appear whole or not at all.
 *
 * Each file is written beside its final place under a hidden temporary name; when all of them are
 * complete, Commit() renames them. If something goes wrong before, the temporaries are removed and
 * older files of the same names stay as they were.
 */
#ifndef voxplex_cli_OutputFiles_h
#define voxplex_cli_OutputFiles_h

#include "Interruption.h"
#include "MeshWriting/TextFile.h"

#include <functional>
#include <map>
#include <set>
#include <string>

namespace voxplex::cli
{

class OutputFiles
{
public:
  OutputFiles() = default;
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /**
   * Announces a file and checks at once that it can be written.
   *
   * @throws RunError: the folder does not exist or is not writable, the name is that of a folder or
   *   device, or of a file announced before
   */
  void Add(const std::string& path);

  /** Refuses to overwrite a file that is read. @throws RunError */
  void ForbidOverwriting(const std::string& inputPath) const;

  /** Where to write the content of an announced file; same extension as path. */
  const std::string& TemporaryPath(const std::string& path) const;

  /** Writes a text file that was announced. @throws RunError */
  void WriteText(
    const std::string& path, const std::function<void(io::TextFile& file)>& write) const;

  /** Moves all files to their places. @throws RunError */
  void Commit();

private:
  struct Temporary
  {
    std::string Path;
    Interruption::TemporaryFile* Record;
  };
  std::map<std::string, Temporary> Files; ///< by the path that was given
  std::set<std::string> Targets;          ///< the same files, absolute and without links
};

} // namespace voxplex::cli

#endif

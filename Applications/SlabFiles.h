// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlabFiles.h
 * @brief What --slabs writes: each slab of a space-time mesh alone.
 */
#ifndef voxplex_cli_SlabFiles_h
#define voxplex_cli_SlabFiles_h

#include <string>

class vtkUnstructuredGrid;

namespace voxplex::io
{
class WholeFiles;
}

namespace voxplex::cli
{

/**
 * @brief PREFIX0.vtu, PREFIX1.vtu, ..., one for each slab. Their format is that of --output, or .vtu without it.
 *
 * How many there are is known only when the mesh is there. The first one is there always.
 */
class SlabFiles
{
public:
  SlabFiles(std::string prefix, const std::string& output);

  /** Announces the first one, so that what cannot be written is known before any work. @throws io::OutputError */
  void AnnounceFirst(io::WholeFiles& files) const;

  /** Announces the others. @throws io::OutputError */
  void AnnounceOthers(io::WholeFiles& files, vtkUnstructuredGrid* mesh) const;

  /** @throws RunError with the writer's reason */
  void Write(
    vtkUnstructuredGrid* mesh, vtkUnstructuredGrid* boundary, const io::WholeFiles& files) const;

private:
  std::string NameOf(int slab) const;

  const std::string Prefix;
  const std::string Extension;
};

} // namespace voxplex::cli

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeFiles.h
 * @brief What --slices writes, the mesh at several times and a collection that ParaView plays, and what
 * --slabs writes, each slab of a space-time mesh alone.
 */
#ifndef voxplex_cli_SpaceTimeFiles_h
#define voxplex_cli_SpaceTimeFiles_h

#include <vtkSmartPointer.h>

#include <optional>
#include <string>
#include <vector>

class vtkDataObject;
class vtkPentatopeMeshTimeSlice;
class vtkUnstructuredGrid;

namespace voxplex::io
{
class WholeFiles;
}

namespace voxplex::cli
{

/** The names of the files, with the folder that the user gave. */
struct SliceFiles
{
  std::string Collection; ///< heart.pvd, of the prefix heart_
  std::vector<std::string> Slices;
  std::vector<double> Times; ///< of the slices, increasing

  /**
   * PREFIX0.vtu, PREFIX1.vtu, ... and PREFIX.pvd, the latter without an underscore, hyphen or dot at
   * the end of the prefix.
   *
   * @param frameTimes of the image, increasing
   * @param count how many, equally spaced from the first to the last frame, both included; if
   * missing, one at the time of each frame
   */
  SliceFiles(
    const std::string& prefix, const std::vector<double>& frameTimes, std::optional<int> count);
};

/**
 * @param option without dashes
 * @param example of a prefix
 * @throws UsageError: an empty name, or what is rather that of a file
 */
void CheckFilePrefix(
  const std::string& option, const std::string& prefix, const std::string& example);

/** Takes one slice after the other out of a pentatope mesh. */
class Slicer
{
public:
  /** @param compress as for WriteMeshFile() */
  Slicer(vtkUnstructuredGrid* mesh, bool compress);
  ~Slicer();

  /**
   * Writes the slice at a time: a .vtu file of tetrahedra with the cell array Label, and the time as
   * field data TimeValue.
   *
   * @throws io::FileError
   */
  void Write(double time, const std::string& path, const io::WholeFiles& files);

private:
  vtkSmartPointer<vtkPentatopeMeshTimeSlice> Filter;
  const bool Compress;
};

/** Writes the collection; it names the slices relative to its own place. @throws io::OutputError */
void WriteCollection(const SliceFiles& slices, const io::WholeFiles& files);

//----------------------------------------------------------------------------------------------------
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

  /** @param boundary may be null @throws io::FileError with the writer's reason */
  void Write(vtkUnstructuredGrid* mesh, vtkDataObject* boundary, const io::WholeFiles& files,
    bool compress) const;

private:
  std::string NameOf(int slab) const;

  const std::string Prefix;
  const std::string Extension;
};

} // namespace voxplex::cli

#endif

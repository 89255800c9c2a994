// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TIFFStack.h
 * @brief What the description in a TIFF file says about its pages.
 */
#ifndef voxplex_io_TIFFStack_h
#define voxplex_io_TIFFStack_h

#include "Placement.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace voxplex::io
{

struct Reading;

/** What the directories of the file say. */
struct TIFFPages
{
  std::vector<std::size_t>
    Directories; ///< of each full page, which is neither a reduced image nor a mask
  std::int64_t Width = 0;
  std::int64_t Length = 0;
  bool IsUInt16 = false;

  /** As many pages follow each other from the first on, if none had a directory. */
  std::int64_t Contiguous = 1;

  /** Of the first page, and so are all below. Empty if there is none. */
  std::string Description;
  bool HasUnit = false;     ///< whether resolutions are for an inch or a centimetre
  double XResolution = 0.0; ///< voxels for a length; 0 if there is none
  double YResolution = 0.0;

  std::int64_t Count() const { return static_cast<std::int64_t>(this->Directories.size()); }
};

/** How the pages make an image of three or four dimensions. */
struct TIFFStack
{
  std::int64_t Slices = 1;
  std::int64_t Frames = 1;
  std::vector<std::size_t>
    Pages; ///< of each slice of the first frame, then those of the second, ...

  /** The file has a directory for the first page only, and the others follow it without one. */
  bool IsContiguous = false;
  /** Numbers are stored as unsigned, and 32768 stands for 0. */
  bool IsSignedWithOffset = false;

  Vector3 Spacing{ 1.0, 1.0, 1.0 };
  std::optional<Vector3> Origin; ///< nothing if the description has none
  double TimeStep = 1.0;
};

/**
 * Understands the descriptions of ImageJ ("ImageJ=..."), SCIFIO ("SCIFIO=..."), tifffile ({"shape": ...}) and OME
 * (XML). With another description, or none, pages are slices. Lengths keep the unit that they have. Warnings name it,
 * and what had to be guessed.
 *
 * @throws FileError: metadata that do not fit the pages, or are damaged; channels; several images; parts in other
 * files; one slice alone
 */
TIFFStack DescribeStack(const TIFFPages& pages, Reading& reading);

} // namespace voxplex::io

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadImage.h
 * @brief Reads a 3D or 4D image from a file or folder.
 */
#ifndef voxplex_io_ReadImage_h
#define voxplex_io_ReadImage_h

#include "LabelTable.h"
#include "MaskUnion.h"
#include "ScalarImage.h"

#include <functional>
#include <string>
#include <vector>

namespace voxplex::io
{

struct ImageRequest
{
  std::string Path; ///< a file, or a folder with a DICOM series
  std::string
    Series; ///< UID of the series to read from a folder, or its beginning; may be empty if there is one
  bool DataFilesAnywhere =
    false; ///< whether a header may name files that are not in its folder or below
  Overlap Rule = Overlap::Smallest; ///< of segments in several layers
  double MaskThreshold = 0.5;       ///< above which probabilities are inside

  /** Called several times a second, with the part that has been read, where that is known. If false, Stopped is thrown. */
  std::function<bool(double)> Proceed;
};

/** Reading was stopped, as the caller wanted. */
struct Stopped
{
};

/** What is known of an image beside its voxels and its place. */
struct ImageNotes
{
  LabelTable Labels;                 ///< names and colours that the file has itself
  std::vector<std::string> Warnings; ///< what was odd but could be read, one line each
  ///@{
  /** The same of what the file does not say, and the reader guessed: the spacing, or origin and directions. */
  std::vector<std::string> SpacingGuesses;
  std::vector<std::string> PlaceGuesses;
  ///@}
  std::vector<std::string>
    Files; ///< that were read, if they are others than those that were asked for
};

struct ImageAnswer : ImageNotes
{
  ScalarImage Image;
};

/**
 * Reads an image in the scalar type that the file has. The first bytes of a file tell its format, not its name: NRRD,
 * NIfTI, ANALYZE, MetaImage, DICOM, TIFF, VTK, MGH, GIPL, MRC. A fourth dimension is time; last dimensions of length 1
 * do not count, so that an image with one frame is a 3D image. Warnings begin with the name of the image. Never prints.
 *
 * Formats that a library reads (DICOM, TIFF, VTK, folders of slices) are read in a process of its own, which may open no
 * other files and has limits of memory and time: whatever the file does to the library, this process lives. If that
 * process cannot be started, they are not read. All else is read here, by code of voxplex.
 *
 * Any thread may call it at any time.
 *
 * @throws FileError that names the image: no such file, another format, truncated, damaged, no single numbers in three
 * or four dimensions, a place that is none; the reading process cannot be started, crashed or reached a limit
 * @throws Stopped
 */
ImageAnswer ReadImage(const ImageRequest& request);

} // namespace voxplex::io

#endif

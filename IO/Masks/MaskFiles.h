// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MaskFiles.h
 * @brief Masks, each in a file of its own, as one label image.
 */
#ifndef voxplex_io_MaskFiles_h
#define voxplex_io_MaskFiles_h

#include "ImageReading/ReadImage.h"

#include <string>
#include <vector>

namespace voxplex::io
{

/**
 * Reads what one path or several name.
 *
 * Several files, and those of a folder that holds images and no DICOM file, are masks: labels 1, 2, ... in the order
 * given (of a folder in that of names, rib_2 before rib_10), named by the files without extensions. They are read one
 * after the other, and each is forgotten before the next; if their grids differ, all are read again. Anything else is
 * read by ReadImage().
 *
 * A mask whose file does not say where it lies is put where another one of its size lies; see MasksOnGrid::TakePlace().
 *
 * @param paths not empty
 * @param request its path is not used
 * @param resample whether masks are resampled to the finest grid, by nearest neighbour, if their grids differ by more
 *   than whole voxels
 * @param isPlaced whether the place of the result will be replaced, so that masks must have one
 * @throws FileError as ReadImage(), and for such grids otherwise, sizes of masks without a place that no other has,
 * different units of length, time frames, single slices, and values of no mask
 */
ImageAnswer ReadImageOrMasks(
  const std::vector<std::string>& paths, const ImageRequest& request, bool resample, bool isPlaced);

} // namespace voxplex::io

#endif

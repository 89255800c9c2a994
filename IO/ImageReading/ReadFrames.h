// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadFrames.h
 * @brief Reads an image with several time frames with ITK: four axes, or a list of frames.
 */
#ifndef voxplex_io_ReadFrames_h
#define voxplex_io_ReadFrames_h

#include "ScalarImage.h"

#include <string>
#include <vector>

namespace itk
{
class ImageIOBase;
}

namespace voxplex::io
{

/** How many axes the image has, apart from last ones of length 1; at least 3. */
unsigned CountAxes(const itk::ImageIOBase& io);

/**
 * Whether what ITK presents as components of a 3D image are time frames: an NRRD file with an axis
 * of the kind 'list', as 3D Slicer writes sequences, that does not hold the layers of a
 * segmentation.
 */
bool ComponentsAreFrames(const std::string& path, const itk::ImageIOBase& io);

/**
 * Reads the frames that io, which has read the header, describes: four axes, or components that are
 * frames. Times are those of the fourth axis. Those of a list are the "axis index values" of 3D
 * Slicer, else they have the spacing of the list's axis and begin at 0. What is not known is taken
 * to be 1, with a warning if the format has a place for it.
 *
 * @param warnings receives what was odd but could be read, one line each
 * @throws FileError: axes that mix space and time, singular axes, time that does not increase
 */
ScalarImage ReadFrames(
  const std::string& path, itk::ImageIOBase& io, std::vector<std::string>& warnings);

} // namespace voxplex::io

#endif

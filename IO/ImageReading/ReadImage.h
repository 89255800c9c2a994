// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadImage.h
 * @brief Reads a 3D or 4D image with ITK, without copying it.
 */
#ifndef voxplex_io_ReadImage_h
#define voxplex_io_ReadImage_h

#include "ScalarImage.h"

#include <string>
#include <vector>

namespace voxplex::io
{

/**
 * Reads one file of any format that ITK knows, or a folder with a DICOM series, in the scalar type
 * that the file has. A fourth dimension is time; last dimensions of length 1 do not count, so that an
 * image with one frame is a 3D image. Never prints.
 *
 * @param path file or folder
 * @param series UID of the series to read from a folder; may be empty if there is only one
 * @param warnings receives what the reading libraries found odd but could read, one line each
 * @throws FileError: no such file, not readable, unknown format, truncated, more than four
 *   dimensions, several components that are not time frames, spacing that is not positive and
 *   finite, a direction matrix that mixes time with space, several series
 */
ScalarImage ReadImage(
  const std::string& path, const std::string& series, std::vector<std::string>& warnings);

} // namespace voxplex::io

#endif

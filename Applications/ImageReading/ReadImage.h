// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadImage.h
 * @brief Reads a 3D image with ITK, without copying it.
 */
#ifndef voxplex_cli_ReadImage_h
#define voxplex_cli_ReadImage_h

#include "ScalarImage.h"

#include <string>
#include <vector>

namespace voxplex::cli
{

/**
 * Reads one file of any format that ITK knows, or a folder with a DICOM series, in the scalar type
 * that the file has. Never prints.
 *
 * @param path file or folder
 * @param series UID of the series to read from a folder; may be empty if there is only one
 * @param warnings receives what the reading libraries found odd but could read, one line each
 * @throws RunError: no such file, not readable, unknown format, truncated, more than three
 *   dimensions, several components, spacing that is not positive and finite, several series
 */
ScalarImage ReadImage(
  const std::string& path, const std::string& series, std::vector<std::string>& warnings);

} // namespace voxplex::cli

#endif

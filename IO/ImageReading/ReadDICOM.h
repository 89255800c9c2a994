// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadDICOM.h
 * @brief Volumes from DICOM: series of files with a slice each, and files with several frames.
 *
 * Slices are placed by Image Position and Orientation (Patient) and Pixel Spacing. Their files' names, order and
 * numbers do not matter. What has no place in space, or no single value a voxel, is refused with its name.
 */
#ifndef voxplex_io_ReadDICOM_h
#define voxplex_io_ReadDICOM_h

#include "InputFile.h"
#include "Reading.h"
#include "ScalarImage.h"

#include <string>

namespace voxplex::io
{

bool IsDICOM(const InputFile& file);

/** One slice, or the frames of a file. */
ScalarImage ReadDICOMFile(const std::string& path, Reading& reading);

/** @param series UID, or how it begins; may be empty if there is one series */
ScalarImage ReadDICOMFolder(const std::string& path, const std::string& series, Reading& reading);

} // namespace voxplex::io

#endif

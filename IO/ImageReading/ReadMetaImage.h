// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadMetaImage.h
 * @brief Reads MetaImage files (itk.org/Wiki/MetaIO/Documentation), attached and detached, in 3D and 4D.
 */
#ifndef voxplex_io_ReadMetaImage_h
#define voxplex_io_ReadMetaImage_h

#include "ScalarImage.h"

#include <string>

namespace voxplex::io
{

class InputFile;
struct Reading;

/** A text that gives NDims. */
bool IsMetaImage(const InputFile& file);

/**
 * Binary, compressed and text voxels in one file, one file a slice (LIST, patterns), or behind the header. A fourth
 * axis is time. Coordinates are LPS. @throws FileError
 */
ScalarImage ReadMetaImage(const std::string& path, Reading& reading);

} // namespace voxplex::io

#endif

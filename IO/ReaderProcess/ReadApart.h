// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadApart.h
 * @brief Reads an image in a process of its own.
 */
#ifndef voxplex_io_ReadApart_h
#define voxplex_io_ReadApart_h

#include "ImageReading/ReadImage.h"

#include <optional>

namespace voxplex::io
{

/** Nothing if no process could be started. @throws FileError as ReadImage() does */
std::optional<ImageAnswer> ReadApart(const ImageRequest& request);

} // namespace voxplex::io

#endif

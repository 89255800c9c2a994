// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadNRRD.h
 * @brief Reads NRRD files (teem.sourceforge.net/nrrd/format.html), attached and detached, in 3D and 4D.
 */
#ifndef voxplex_io_ReadNRRD_h
#define voxplex_io_ReadNRRD_h

#include "ScalarImage.h"

#include <string>

namespace voxplex::io
{

class InputFile;
struct Reading;

bool IsNRRD(const InputFile& file);

/**
 * Encodings raw, gzip, text and hex. Spaces are turned into LPS; those that do not say where left is (scanner-xyz,
 * 3D-right-handed, 3D-left-handed, a space dimension only) are taken for LPS, with a warning.
 *
 * A fourth axis of time is one of the space ("...-time"), of the kind time or list (3D Slicer's sequences, with the
 * times of their "axis 0 index values"), or the last of four that have no space. It may be at any place in the file.
 * Segments of 3D Slicer are given as labels.
 *
 * @throws FileError
 */
ScalarImage ReadNRRD(const std::string& path, Reading& reading);

} // namespace voxplex::io

#endif

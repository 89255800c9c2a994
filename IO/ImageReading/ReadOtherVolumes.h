// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadOtherVolumes.h
 * @brief Reads GIPL and MRC files: a binary header of fixed length, and numbers.
 */
#ifndef voxplex_io_ReadOtherVolumes_h
#define voxplex_io_ReadOtherVolumes_h

#include "ScalarImage.h"

#include <string>

namespace voxplex::io
{

class InputFile;
struct Reading;

/** Guy's Image Processing Lab, packed by gzip or not. */
bool IsGIPL(const InputFile& file);

/** Coordinates are LPS along the axes. @throws FileError */
ScalarImage ReadGIPL(const std::string& path, Reading& reading);

/** Electron microscopy: MRC2014, and what programs before it wrote with the word "MAP ". */
bool IsMRC(const InputFile& file);

/**
 * Modes 0, 1, 2 and 6. Bytes are signed, as MRC2014 has them, unless IMOD says otherwise; if the header is older and
 * some are negative, there is a warning. Columns, rows and sections may run along any of the axes. Lengths are in
 * angstrom, with a warning. If the cell is 0, the spacing is 1, with a warning.
 *
 * @throws FileError
 */
ScalarImage ReadMRC(const std::string& path, Reading& reading);

} // namespace voxplex::io

#endif

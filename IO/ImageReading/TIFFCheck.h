// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TIFFCheck.h
 * @brief What ITK's copy of libtiff cannot stand.
 *
 * - It takes memory for the values that a tag claims, and for all strips that the size of the image claims,
 *   before it reads them.
 * - It follows directories in circles.
 * - ITK divides by the sizes of tiles, and reads a text of one byte up to the next 0.
 */
#ifndef voxplex_io_TIFFCheck_h
#define voxplex_io_TIFFCheck_h

#include <string>

namespace voxplex::io
{

/**
 * Walks through the directories of a TIFF or BigTIFF file; other files pass.
 *
 * @return what is wrong, or an empty string
 */
std::string FindFaultOfTIFF(const std::string& path);

} // namespace voxplex::io

#endif

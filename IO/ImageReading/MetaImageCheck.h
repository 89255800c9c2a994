// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetaImageCheck.h
 * @brief What MetaIO, ITK's reader of MetaImage files, cannot stand or reads in another way than TextHeader.
 *
 * - It copies names and texts to where 254 bytes have room.
 * - A line that is no field makes it take the next lines for its value, and so do numbers that are missing.
 * - It reads the fields in any number, and keeps the last of each; their names are as in the format, letter by letter.
 * - It trusts lists and patterns of data files: their blanks, their numbers and that there are enough files.
 */
#ifndef voxplex_io_MetaImageCheck_h
#define voxplex_io_MetaImageCheck_h

#include <string>

namespace voxplex::io
{

/**
 * Checks the header of a MetaImage file, line by line. What passes is for MetaIO what it is for TextHeader.
 *
 * @return what is wrong, or an empty string
 */
std::string FindFaultOfMetaImage(const std::string& path);

} // namespace voxplex::io

#endif

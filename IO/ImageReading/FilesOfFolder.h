// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FilesOfFolder.h
 * @brief What both processes ask of the files of a folder: masks in the host, slices in the reading process.
 */
#ifndef voxplex_io_FilesOfFolder_h
#define voxplex_io_FilesOfFolder_h

#include <string>
#include <vector>

namespace voxplex::io
{

/** By the four letters that tell it, without parsing anything; false for what cannot be opened. */
bool IsDICOMFile(const std::string& path);
/** With the numbers in names as numbers. */
std::vector<std::string> SortByNumbers(const std::vector<std::string>& names);

} // namespace voxplex::io

#endif

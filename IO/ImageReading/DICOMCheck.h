// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DICOMCheck.h
 * @brief What GDCM 3.0 cannot stand.
 *
 * - It takes memory for the length that an element claims, up to 4 GiB, before it reads the element, and
 *   fills up what the file lacks.
 * - It follows nested sequences by recursion, to the end of the stack.
 */
#ifndef voxplex_io_DICOMCheck_h
#define voxplex_io_DICOMCheck_h

#include <string>

namespace voxplex::io
{

/**
 * Walks through the elements of a DICOM file, with or without a preamble; other files pass. An element must not claim more bytes than the file has left,
 * and sequences may be nested 64 deep. Files that are compressed as a whole (transfer syntax 'deflated')
 * pass.
 *
 * @return what is wrong, or an empty string
 */
std::string FindFaultOfDICOM(const std::string& path);

} // namespace voxplex::io

#endif

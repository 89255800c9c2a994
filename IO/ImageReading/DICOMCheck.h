// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DICOMCheck.h
 * @brief What GDCM 3.0 cannot stand.
 *
 * - It takes memory for the length that an element claims, up to 4 GiB, before it reads the element, and
 *   fills up what the file lacks.
 * - It follows nested sequences by recursion, to the end of the stack.
 * - Where a file breaks the grammar of DICOM it begins anew by that of some faulty writer, and finds other lengths.
 * - As Debian builds it, it aborts the program where an element is not of the type that its dictionary says.
 */
#ifndef voxplex_io_DICOMCheck_h
#define voxplex_io_DICOMCheck_h

#include <string>

namespace voxplex::io
{

/**
 * Walks through the elements of a DICOM file, with or without a preamble, to its end; other files pass. An element must
 * not claim more bytes than there are in what holds it, and must be of the type that the dictionary says, and sequences may
 * be nested 64 deep. Files that are compressed as a whole (transfer syntax 'deflated') are unpacked into memory.
 *
 * @return what is wrong, or an empty string
 */
std::string FindFaultOfDICOM(const std::string& path);

/** Whether the file has the mark of DICOM. The bytes before it do not count: they may be the header of a TIFF. */
bool HasPreambleOfDICOM(const std::string& path);

} // namespace voxplex::io

#endif

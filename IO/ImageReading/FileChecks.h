// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FileChecks.h
 * @brief What ITK 5.2 reads without complaint although it should not.
 *
 * - A spacing of 0, NaN or infinity in a NIfTI or NRRD header is replaced by 1.
 * - So is a time step. 0 in NIfTI and NaN in NRRD stand for 'unknown' there, and pass.
 * - Of a truncated NIfTI file the missing voxels are read as 0.
 * - A NIfTI header with more than 7 dimensions makes it read what is not there.
 */
#ifndef voxplex_io_FileChecks_h
#define voxplex_io_FileChecks_h

#include <optional>
#include <string>

namespace voxplex::io
{

/**
 * Checks header and size of a NIfTI-1 file, compressed or not; other files pass.
 *
 * @return what is wrong, or an empty string
 */
std::string FindFaultOfNIfTI(const std::string& path);

/** When the frames of a NIfTI-1 file are. */
struct NIfTITimes
{
  double First; ///< toffset, which ITK does not read
  double Step;  ///< pixdim[4]; 0 means 'unknown'; ITK makes it 1
};

/** Nothing if it is another file, or has one frame. */
std::optional<NIfTITimes> ReadTimesOfNIfTI(const std::string& path);

/** Checks the spacings in the text header of an NRRD or MetaImage file. Returns as above. */
std::string FindFaultOfTextHeader(const std::string& path);

} // namespace voxplex::io

#endif

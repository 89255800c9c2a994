// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadNIfTI.h
 * @brief Reads NIfTI-1 and NIfTI-2 (nifti.nimh.nih.gov), in one file or two, and ANALYZE 7.5, from which they come.
 */
#ifndef voxplex_io_ReadNIfTI_h
#define voxplex_io_ReadNIfTI_h

#include "ScalarImage.h"

#include <string>

namespace voxplex::io
{

class InputFile;
struct Reading;

/** Of two files either counts: the header beside what is called .img must be one. Each may be packed by gzip. */
bool IsNIfTI(const InputFile& file);

/**
 * The image lies where the sform says, if its code is positive, else where the qform says, if its code is; nibabel and
 * FSL do so, too. If both are there and differ, a warning tells by how much. If neither is, it lies along the axes of
 * RAS from 0, with a warning. Lengths in metres or micrometres are turned into millimetres, and times in milliseconds
 * or microseconds into seconds; numbers with other units, or none, are those of the file. Voxels are scaled as
 * scl_slope and scl_inter say. ANALYZE does not say how an image lies: along the axes of LPS, with a warning.
 *
 * @throws FileError
 */
ScalarImage ReadNIfTI(const std::string& path, Reading& reading);

} // namespace voxplex::io

#endif

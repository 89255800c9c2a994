// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VTKFileStructure.h
 * @brief Whether a .vti file is whole.
 *
 * VTK's reader leaves voxels as they were where no piece has them, and where data end before they should.
 */
#ifndef voxplex_io_VTKFileStructure_h
#define voxplex_io_VTKFileStructure_h

#include "InputFile.h"

namespace voxplex::io
{

/**
 * @throws FileError: XML that is not well-formed, several pieces, a piece that is not all of the image, arrays that are
 * shorter than they claim
 */
void CheckStructureOfVTI(const InputFile& file);

} // namespace voxplex::io

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageFile.h
 * @brief The label image that was read, as a file of its own.
 */
#ifndef voxplex_cli_ImageFile_h
#define voxplex_cli_ImageFile_h

#include <string>

class vtkAlgorithm;
class vtkSegmentationReader;

namespace voxplex::cli
{

/**
 * Writes all frames of a reader, or of what repairs them (`source`), as NRRD: raw voxels, their place, the times of frames, and the names and colours of labels as 3D
 * Slicer's .seg.nrrd has them.
 *
 * @throws io::FileError
 */
void WriteImage(vtkSegmentationReader* reader, vtkAlgorithm* source, const std::string& path);

} // namespace voxplex::cli

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadVTK.h
 * @brief VTK's own images: legacy .vtk with the dataset STRUCTURED_POINTS, and XML .vti, by VTK's readers.
 *
 * Labels are the array of numbers with one component, of the points or of the cells. Of several it is the active
 * scalars. A cell with a label is a voxel, so that the first voxel lies half a spacing from the origin. What
 * vtkGhostType hides is background. Coordinates are taken as LPS.
 */
#ifndef voxplex_io_ReadVTK_h
#define voxplex_io_ReadVTK_h

#include "InputFile.h"
#include "Reading.h"
#include "ScalarImage.h"

#include <string>

namespace voxplex::io
{

/** By how the file begins; it may hold something else than an image. */
bool IsVTK(const InputFile& file);

/**
 * VTK has one window for the messages of all threads. While a file is read, those of this thread are collected, and
 * nothing of them is shown in it. vtkLogger prints them nevertheless, unless its verbosity is off.
 *
 * @throws FileError: other datasets, several arrays to choose from, vectors and colours, time steps, and all that VTK
 * calls an error
 */
ScalarImage ReadVTK(const std::string& path, Reading& reading);

} // namespace voxplex::io

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VTKImage.h
 * @brief From the image that was read to vtkImageData, without copying voxels, and the labels that it has.
 */
#ifndef voxplex_io_VTKImage_h
#define voxplex_io_VTKImage_h

#include "ImageReading/ScalarImage.h"
#include "LabelTable.h"
#include "Space.h"

#include <vtkSmartPointer.h>

class vtkImageData;

namespace voxplex::io
{

/**
 * One frame as an image that refers to the voxels of the argument and keeps them alive. For
 * Space::RAS, the first two physical coordinates change sign.
 */
vtkSmartPointer<vtkImageData> ToVTKImage(const ScalarImage& image, Space space, int frame = 0);

/** Removes labels that no voxel of any frame has. Ends when all of them have been seen. */
void KeepLabelsOf(const ScalarImage& image, LabelTable& table);

} // namespace voxplex::io

#endif

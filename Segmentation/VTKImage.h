// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VTKImage.h
 * @brief From vtkImageData to an image without VTK, and back.
 */
#ifndef voxplex_VTKImage_h
#define voxplex_VTKImage_h

#include "LabelTable.h"
#include "ScalarImage.h"
#include "Space.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkImageData;

namespace voxplex
{

/**
 * Labels are the array of numbers with one component, of the points or of the cells. Of several it is the active
 * scalars. What is hidden (ImageVoxels.h) is background. SPACE tells the coordinates, which become LPS.
 *
 * @param table receives names and colours of labels
 * @param warnings receives what was odd, a line each, without the name of the image
 * @throws InputError with the reason alone ("it has ...")
 */
ScalarImage TakeVTKImage(vtkImageData* image, const VoxelAllocator& allocate, LabelTable& table,
  std::vector<std::string>& warnings);
/** The same without voxels. */
ScalarImage PlaceOfVTKImage(vtkImageData* image);

/**
 * One frame as an image that refers to the voxels of the argument and keeps them alive. For
 * Space::RAS, the first two physical coordinates change sign.
 */
vtkSmartPointer<vtkImageData> ToVTKImage(const ScalarImage& image, Space space, int frame = 0);

/** The same, with SPACE and the table in the field data. */
void FillVTKImage(vtkImageData* output, const ScalarImage& image, Space space,
  const LabelTable& table, int frame = 0);

/** Removes labels that no voxel of any frame has. Ends when all of them have been seen. */
void KeepLabelsOf(const ScalarImage& image, LabelTable& table);

} // namespace voxplex

#endif

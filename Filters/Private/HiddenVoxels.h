// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HiddenVoxels.h
 * @brief Voxels that an image hides (VTK's blanking), and arrays in which they are background.
 *
 * The arrays vtkGhostType say what is hidden, as in VTK: points with HIDDENPOINT, cells with
 * HIDDENCELL or REFINEDCELL, and cells with a hidden corner. A point is also hidden if all cells
 * around it are. Duplicates (DUPLICATEPOINT, DUPLICATECELL) are not hidden: they are voxels of the
 * image.
 */
#ifndef voxplex_Private_HiddenVoxels_h
#define voxplex_Private_HiddenVoxels_h

#include "Private/ChosenArray.h"

#include "vtkDataArray.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkImageData;

namespace voxplex
{

/**
 * @param cells whether voxels are the image's cells, or its points
 * @param what what the image is called in messages
 * @return whether each voxel is hidden; empty if none is
 * @throws InputError if an array vtkGhostType has not one value for each point or cell
 */
std::vector<char> FindHiddenVoxels(vtkImageData* image, bool cells, const std::string& what);

/**
 * A copy in which hidden voxels have the label 0, or are NaN. Grey values become real numbers for that.
 * @param hidden of FindHiddenVoxels()
 */
vtkSmartPointer<vtkDataArray> WithoutHidden(
  vtkDataArray* array, const std::vector<char>& hidden, ImageContent content);

} // namespace voxplex

#endif

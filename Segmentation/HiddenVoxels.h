// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HiddenVoxels.h
 * @brief Voxels that an image hides (VTK's blanking): the one rule, for filters in memory and for files.
 *
 * The arrays vtkGhostType say what is hidden, as in VTK: points with HIDDENPOINT, cells with
 * HIDDENCELL or REFINEDCELL, and cells with a hidden corner. A point is also hidden if all cells
 * around it are. Duplicates (DUPLICATEPOINT, DUPLICATECELL) are not hidden: they are voxels of the
 * image.
 */
#ifndef voxplex_HiddenVoxels_h
#define voxplex_HiddenVoxels_h

#include <vector>

class vtkImageData;

namespace voxplex
{

/**
 * @param cells whether voxels are the image's cells, or its points
 * @return whether each voxel is hidden; empty if none is
 * @throws std::length_error if an array vtkGhostType has not one value for each point or cell
 */
std::vector<char> FindHiddenVoxels(vtkImageData* image, bool cells);

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageVoxels.h
 * @brief Where the voxels of a vtkImageData lie, and which it hides (VTK's blanking): the one rule, for filters in
 * memory and for files.
 *
 * Voxels are the points or the cells, which lie at their centres. VTK takes an image that is one point thick for one
 * layer of cells.
 *
 * The arrays vtkGhostType say what is hidden, as in VTK: points with HIDDENPOINT, cells with
 * HIDDENCELL or REFINEDCELL, and cells with a hidden corner. A point is also hidden if all cells
 * around it are. Duplicates (DUPLICATEPOINT, DUPLICATECELL) are not hidden: they are voxels of the
 * image.
 */
#ifndef voxplex_ImageVoxels_h
#define voxplex_ImageVoxels_h

#include <vtkSmartPointer.h>

#include <array>
#include <cstdint>
#include <vector>

class vtkDataArray;
class vtkImageData;

namespace voxplex
{

/** Voxel (i, j, k) lies at First + i Steps[0] + j Steps[1] + k Steps[2]. */
struct VoxelPlaces
{
  std::array<std::int64_t, 3> Dimensions; ///< below 1 if the image is empty
  std::array<std::array<double, 3>, 3> Steps;
  std::array<double, 3> First;
};

/** @param cells whether voxels are the image's cells, or its points */
VoxelPlaces PlacesOf(vtkImageData* image, bool cells);

/**
 * @param cells whether voxels are the image's cells, or its points
 * @return whether each voxel is hidden; empty if none is
 * @throws std::length_error if an array vtkGhostType has not one value for each point or cell
 */
std::vector<char> FindHiddenVoxels(vtkImageData* image, bool cells);

/** The array itself if its values lie contiguously in memory in a type with a name, else a copy. */
vtkSmartPointer<vtkDataArray> Contiguous(vtkDataArray* array);

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfacePoints.h
 * @brief Points all over the interfaces of a label image: to measure distances from a mesh.
 */
#ifndef voxplex_InterfacePoints_h
#define voxplex_InterfacePoints_h

#include "Domain/LabelField.h"
#include "Geometry/Point.h"
#include "Image/LabelImage.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * The centres of all faces between voxels of different labels, in the image's frame; beyond the image all
 * is background. By axis, then by voxel; the same for any number of threads. Linear in the voxels of the
 * image's crop.
 *
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<Point<3>> VoxelFaceCentres(
  const LabelImage<3>& image, unsigned threads, const std::stop_token& stop = {});

/**
 * For each of these faces, where the line between the centres of its two voxels crosses the interface of
 * the label field: as every voxel centre keeps its label, there is such a point. To a thousandth of a
 * voxel.
 *
 * @param field made from the image
 */
std::vector<Point<3>> SmoothInterfacePoints(const LabelImage<3>& image, const LabelField<3>& field,
  unsigned threads, const std::stop_token& stop = {});

} // namespace voxplex

#endif

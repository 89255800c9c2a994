// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfacePoints.h
 * @brief Sample points on all interfaces of a label image, for measuring distances to a mesh.
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
 * The centres of all faces between voxels of different labels, in the image's frame. Beyond the
 * image all voxels are background. The centres are ordered by axis, then by voxel; the order does
 * not depend on the number of threads. The time is linear in the voxels of the image's crop.
 *
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<Point<3>> VoxelFaceCentres(
  const LabelImage<3>& image, unsigned threads, const std::stop_token& stop = {});

/**
 * For each face of VoxelFaceCentres(), the point where the line between the centres of its two
 * voxels crosses the interface of the label field, to a thousandth of a voxel. This point exists
 * because every voxel centre keeps its label.
 *
 * @param field the label field of the same image
 */
std::vector<Point<3>> SmoothInterfacePoints(const LabelImage<3>& image, const LabelField<3>& field,
  unsigned threads, const std::stop_token& stop = {});

} // namespace voxplex

#endif

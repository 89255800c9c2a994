// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceSamples.h
 * @brief Sample points on all interfaces of a label image, at about equal distances.
 */
#ifndef voxplex_InterfaceSamples_h
#define voxplex_InterfaceSamples_h

#include "Domain/Domain.h"
#include "Image/LabelImage.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/** Points of interfaces, and the two labels of each, the smaller label first. */
template <int D>
struct LabelChanges
{
  std::vector<Point<D>> Points;
  std::vector<std::array<LabelId, 2>> Labels;
};

/**
 * The image is cut into cells of about `spacing`. A step goes from a voxel to the next along an
 * axis. For each ordered pair of labels, a cell keeps the step between these labels that is nearest
 * to the cell's centre. The step gives one point: where the domain's label changes between the two
 * voxels' centres. So both sides of a sheet are sampled, even of a very thin one.
 *
 * Flat faces where the border of the image cuts the object get no points.
 *
 * Points are moved by up to a thousandth of the smallest voxel spacing. The displacement is a
 * pseudo-random vector that depends on the voxel alone. Without it flat faces of an image would
 * give lattices, whose points are co-spherical everywhere.
 *
 * Cost: one pass over the bounding box of the foreground, and one search for each point.
 *
 * @param domain must have the label of the image at every voxel centre
 * @param spacing in units of the frame; cells have at least one voxel along each axis
 * @param threads 0 means all cores; neither the points nor their order depend on it
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
LabelChanges<D> SampleLabelChanges(const LabelImage<D>& image, const Domain<D>& domain,
  double spacing, unsigned threads, const std::stop_token& stop);

extern template LabelChanges<3> SampleLabelChanges<3>(
  const LabelImage<3>&, const Domain<3>&, double, unsigned, const std::stop_token&);
extern template LabelChanges<4> SampleLabelChanges<4>(
  const LabelImage<4>&, const Domain<4>&, double, unsigned, const std::stop_token&);

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceSamples.h
 * @brief Points on all interfaces of a label image, about equally dense everywhere.
 */
#ifndef voxplex_InterfaceSamples_h
#define voxplex_InterfaceSamples_h

#include "Domain/Domain.h"
#include "Image/LabelImage.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/** Points of interfaces, and between which labels: the smaller one first. */
struct LabelChanges
{
  std::vector<Point<3>> Points;
  std::vector<std::array<LabelId, 2>> Labels;
};

/**
 * The image is cut in cells of about `spacing`. Of all steps from voxel to voxel that begin in a cell and
 * go from one label to another, the one nearest to the cell's centre gives a point where the domain's label
 * changes between the two voxels' centres; so both sides of a sheet are sampled, however thin it is.
 *
 * Points are moved by up to a thousandth of the smallest voxel spacing, each by a pseudo-random vector that
 * depends on its voxel alone: flat faces of an image would otherwise give lattices, whose points are
 * co-spherical everywhere.
 *
 * Cost: one pass over the bounding box of the foreground, and one search for each point.
 *
 * @param domain has the label of the image at every voxel centre
 * @param spacing in units of the frame; cells have at least one voxel along each axis
 * @param threads 0 means all cores; neither the points nor their order depend on it
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
LabelChanges SampleLabelChanges(const LabelImage<3>& image, const Domain<3>& domain, double spacing,
  unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JunctionSeeds.h
 * @brief Feature points along the curves where interfaces meet.
 */
#ifndef voxplex_JunctionSeeds_h
#define voxplex_JunctionSeeds_h

#include "Junctions/JunctionCurves.h"
#include "Refinement/Rules/FeatureSeed.h"

#include <array>
#include <functional>
#include <vector>

namespace voxplex
{

/** The sampling distance of the interfaces of these labels at a point. */
using JunctionDelta = std::function<double(const Point<3>&, const std::array<LabelId, 3>&)>;

/**
 * Seeds at the corners of junctions, and at equal steps of about delta along the curves between
 * them.
 *
 * Inserted before refinement, they make edges of the mesh follow the junctions. Without them the
 * rules insert vertices beside the junctions, and the mesh's junctions zigzag. The seeds replace
 * the protecting balls of Boltcheva, Yvinec and Boissonnat (Mesh generation from 3D multi-material
 * images, 2009), which need weighted points.
 *
 * Closed curves around parts smaller than delta are left out. So are corners near other corners.
 *
 * @param largest upper bound of the values of `delta`
 */
std::vector<FeatureSeed<3>> SampleJunctions(
  const JunctionCurves& junctions, const JunctionDelta& delta, double largest);

} // namespace voxplex

#endif

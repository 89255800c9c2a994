// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JunctionSeeds.h
 * @brief Feature points along the curves where interfaces meet.
 */
#ifndef voxplex_JunctionSeeds_h
#define voxplex_JunctionSeeds_h

#include "Junctions/JunctionCurves.h"
#include "Refinement/FeatureSeed.h"

#include <array>
#include <functional>
#include <vector>

namespace voxplex
{

/** The sampling density of the interfaces of these labels at a point. */
using JunctionDelta = std::function<double(const Point<3>&, const std::array<LabelId, 3>&)>;

/**
 * Points on the corners, and on the curves between them in equal steps of about delta. Inserted before
 * refinement they make edges of the mesh follow the junctions; without them R1 and R3 put vertices of interfaces anywhere
 * beside these, and the mesh's junctions zigzag. They take the place of the protecting balls of Boltcheva, Yvinec
 * and Boissonnat (Mesh generation from 3D multi-material images, 2009), which need weighted points.
 *
 * Closed curves around what is smaller than delta are left out, corners near others, too.
 *
 * @param largest upper bound of what delta returns
 */
std::vector<FeatureSeed<3>> SampleJunctions(
  const JunctionCurves& junctions, const JunctionDelta& delta, double largest);

} // namespace voxplex

#endif

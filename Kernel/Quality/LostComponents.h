// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LostComponents.h
 * @brief Which connected components of an image are missing from a mesh.
 */
#ifndef voxplex_LostComponents_h
#define voxplex_LostComponents_h

#include "Image/Components.h"
#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * Components of which no element of their label has its centroid within a voxel, along each axis.
 *
 * O(elements + components): neighbouring voxels are looked at only for labels that seem to miss one.
 *
 * @param components of `image`
 * @param mesh in the frame of the image
 * @param wanted which components are looked for (Components::FindWanted)
 * @param threads 0 means all cores; the result does not depend on it
 * @return numbers of components, increasing
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const SimplexMesh<D>& mesh, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop = {});

/**
 * One element for each of some components by which FindLostComponents() finds it: the one with the largest
 * normalized volume. Components that are lost have none.
 *
 * O(elements), by one thread.
 *
 * @return numbers of elements, increasing, each once
 * @throws std::bad_alloc
 */
template <int D>
std::vector<std::uint32_t> FindWitnessesOf(const std::vector<std::uint32_t>& components,
  const Components<D>& all, const LabelImage<D>& image, const SimplexMesh<D>& mesh);

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LostComponents.h
 * @brief Which connected components of an image are missing from a mesh.
 */
#ifndef voxplex_LostComponents_h
#define voxplex_LostComponents_h

#include "Image/Components.h"
#include "Mesh/LabelledCells.h"
#include "Mesh/LabelledTriangulation.h"
#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * Finds lost components. A component is lost if no element of its label has its centroid within one
 * voxel of the component along each axis. If components are those of frames (Components::Extent),
 * the centroid is that of the element's cut at the frame's time, and has to be in the frame.
 *
 * O(elements + components). Neighbouring voxels are searched only near components that contain no
 * centroid; for these, a bit per voxel of the crop is needed.
 *
 * @param components the components of `image`
 * @param mesh in the frame of the image
 * @param wanted the components to look for (Components::FindWanted)
 * @param threads 0 means all cores; the result does not depend on it
 * @return numbers of the lost components, increasing
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const SimplexMesh<D>& mesh, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop = {});

/** The same for LabelledTriangulation or LabelledCells. */
template <int D, typename Elements>
std::vector<std::uint32_t> FindLostComponents(const Components<D>& components,
  const LabelImage<D>& image, const Elements& elements, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop = {});

/**
 * Finds a witness of each component: the first of the elements that have their centroid in it, as
 * FindLostComponents() sees it; if there is none, the first of those that have it within one voxel.
 * For the rest, see FindLostComponents().
 *
 * @param elements LabelledCells
 * @return by component; None if it is lost or not wanted
 */
template <int D, typename Elements>
std::vector<std::uint32_t> FindFirstWitnesses(const Components<D>& components,
  const LabelImage<D>& image, const Elements& elements, const std::vector<bool>& wanted,
  unsigned threads, const std::stop_token& stop = {});

} // namespace voxplex

#endif

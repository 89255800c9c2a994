// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshTopology.h
 * @brief Where the topology of a mesh is not that of its image: pieces, unions and contacts.
 */
#ifndef voxplex_MeshTopology_h
#define voxplex_MeshTopology_h

#include "Conformity/ComponentStatistics.h"
#include "Image/Components.h"
#include "Image/LabelContacts.h"
#include "Mesh/LabelledCells.h"
#include "Mesh/SimplexMesh.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * Lists the components whose elements are in several pieces, and the pieces that unite components
 * which do not touch in the image: Broken and United of the statistics. The worst come first.
 *
 * O(n) for n elements; if pieces unite components, also linear in the
 * voxels of these.
 *
 * @param wanted the components to look for (Components::FindWanted)
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
void ComparePieces(const LabelledCells<D>& elements, const Components<D>& components,
  const LabelImage<D>& image, const std::vector<bool>& wanted, ComponentStatistics& statistics,
  unsigned threads, const std::stop_token& stop);

/**
 * Finds the interfaces of a mesh between two labels, or a label and background, that do not touch near
 * there in the image (LabelContacts::TouchNear). The largest come first.
 *
 * A few look-ups of voxels for each facet.
 *
 * @param image the contacts are of it, in the frame of the mesh
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::vector<FalseContact> FindFalseContacts(const SimplexMesh<D>& mesh, const LabelImage<D>& image,
  unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceTopology.h
 * @brief Counts for reports: junctions of the interfaces of a mesh, and non-manifold edges of the
 * boundary of a label. InterfaceEdges.h has the edges themselves.
 */
#ifndef voxplex_InterfaceTopology_h
#define voxplex_InterfaceTopology_h

#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * Edges of the boundary of one label. The boundary consists of all facets with the label on one
 * side.
 */
struct LabelTopology
{
  std::int64_t Label = 0;
  std::uint64_t BoundaryEdges = 0;
  /** Boundary edges that do not have exactly two facets of the boundary. */
  std::uint64_t NonManifoldEdges = 0;
  std::uint64_t NonManifoldEdgesAtJunctions = 0; ///< non-manifold edges at a junction
};

/**
 * At a junction, three or more labels meet, including background. The labels at an edge or a point
 * are those of the facets that share it.
 */
struct InterfaceTopology
{
  std::uint64_t InterfaceEdges = 0; ///< of all facets, each once
  std::uint64_t JunctionEdges = 0;  ///< edges where three or more labels meet
  std::uint64_t JunctionPoints = 0; ///< ends of junction edges
  std::uint64_t Corners = 0;        ///< points where four or more labels meet
  /**
   * Junction points, without corners, at which the number of junction edges is not two. Here a
   * junction that should be a polyline ends or branches.
   */
  std::uint64_t IrregularJunctionPoints = 0;

  ///@{
  /** Sums over all labels but background: an edge counts once for each label that has it. */
  std::uint64_t BoundaryEdges = 0;
  std::uint64_t NonManifoldEdges = 0;
  std::uint64_t NonManifoldEdgesAtJunctions = 0;
  ///@}

  std::vector<LabelTopology> Labels; ///< sorted by label, without background
};

/**
 * Measures the interfaces of a mesh (Facets and FacetLabels). O(n) for n facets, if few facets
 * share a point. The result does not depend on the number of threads.
 *
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
InterfaceTopology MeasureTopology(
  const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop = {});

} // namespace voxplex

#endif

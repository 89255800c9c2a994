// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceTopology.h
 * @brief Counts for reports: junctions of the interfaces of a mesh, and edges where the boundary of a label is no
 * manifold. Which edges these are is InterfaceEdges' to say.
 */
#ifndef voxplex_InterfaceTopology_h
#define voxplex_InterfaceTopology_h

#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Edges of the boundary of one label: all facets that have it on one side. */
struct LabelTopology
{
  std::int64_t Label = 0;
  std::uint64_t BoundaryEdges = 0;
  std::uint64_t NonManifoldEdges =
    0; ///< of those, edges without exactly two facets of the boundary
  std::uint64_t NonManifoldEdgesAtJunctions = 0; ///< of those, edges at a junction
};

/**
 * A junction is where three or more labels, background counted, meet: around an edge by the facets that
 * share it, around a point by the facets that share that.
 */
struct InterfaceTopology
{
  std::uint64_t InterfaceEdges = 0; ///< of all facets, each once
  std::uint64_t JunctionEdges = 0;  ///< with three or more labels around
  std::uint64_t JunctionPoints = 0; ///< ends of junction edges
  std::uint64_t Corners = 0;        ///< points where four or more labels meet
  /**
   * Junction points that are no corners and where other than two junction edges meet: ends and
   * branchings of what should be a polyline.
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
 * Measures the interfaces of a mesh, Facets and FacetLabels. O(n) for n facets of which few share a
 * point; the result does not depend on the number of threads.
 *
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
InterfaceTopology MeasureTopology(
  const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop = {});

} // namespace voxplex

#endif

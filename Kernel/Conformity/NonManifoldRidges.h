// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file NonManifoldRidges.h
 * @brief Finds the ridges of a triangulation at which the boundary of a label is not manifold.
 *
 * A ridge is a face of D - 1 vertices: an edge in 3D, a triangle in 4D.
 */
#ifndef voxplex_NonManifoldRidges_h
#define voxplex_NonManifoldRidges_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"
#include "Image/LabelImage.h"
#include "Quality/InterfaceEdges.h"

#include <array>
#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The facets of the interfaces of a triangulation. */
template <int D>
struct InterfaceFacets
{
  UninitialisedVector<std::array<VertexId, static_cast<std::size_t>(D)>> Facets;
  UninitialisedVector<std::array<LabelId, 2>> Labels; ///< on both sides of each
};

/**
 * Finds them, in the order of the simplices on the side of the larger label. For parameters, time
 * and errors see FindNonManifoldRidges().
 */
template <int D>
InterfaceFacets<D> FindInterfaceFacets(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, unsigned threads, const std::stop_token& stop);

/**
 * Finds the ridges that some label has in more than one group of neighbouring simplices. Background
 * does not count as a label. It has all outside of the hull.
 *
 * No thread may change the triangulation during the call. Takes time linear in the number of
 * simplices.
 *
 * @param labels by simplex id; those of unused ids are background
 * @param threads 0 means all cores; the result does not depend on it
 * @return with vertex ids, and in their order
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidges(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, unsigned threads = 1, const std::stop_token& stop = {});

/**
 * Finds those of some living simplices. Takes time linear in their number. For the rest, see
 * FindNonManifoldRidges().
 */
template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidgesOf(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, const std::vector<SimplexId>& simplices, unsigned threads = 1,
  const std::stop_token& stop = {});

extern template std::vector<InterfaceRidge<3>> FindNonManifoldRidges<3>(
  const Triangulation<3>&, std::span<const LabelId>, unsigned, const std::stop_token&);
extern template std::vector<InterfaceRidge<4>> FindNonManifoldRidges<4>(
  const Triangulation<4>&, std::span<const LabelId>, unsigned, const std::stop_token&);
extern template std::vector<InterfaceRidge<3>> FindNonManifoldRidgesOf<3>(const Triangulation<3>&,
  std::span<const LabelId>, const std::vector<SimplexId>&, unsigned, const std::stop_token&);
extern template std::vector<InterfaceRidge<4>> FindNonManifoldRidgesOf<4>(const Triangulation<4>&,
  std::span<const LabelId>, const std::vector<SimplexId>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif

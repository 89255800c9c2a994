// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceVertices.h
 * @brief Marks the vertices on the interfaces of a triangulation (VertexRecord::OnInterface).
 */
#ifndef voxplex_InterfaceVertices_h
#define voxplex_InterfaceVertices_h

#include "Delaunay/Triangulation.h"
#include "Image/LabelImage.h"

#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * Marks the vertices of all facets between simplices of different labels. Facets on the box do not count.
 * Takes time linear in the numbers of simplices and vertices.
 *
 * No thread may change the triangulation during the call.
 * @param labels of each simplex id
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end
 */
template <int D>
void MarkInterfaceVertices(Triangulation<D>& triangulation, std::span<const LabelId> labels,
  unsigned threads, const std::stop_token& stop);

/**
 * Marks the vertices of simplices that are new or have another label than when vertices were marked
 * last. The rest keep their marks. Takes time linear in the sizes of the vertices' stars.
 */
template <int D>
void MarkInterfaceVerticesOf(Triangulation<D>& triangulation, std::span<const LabelId> labels,
  const std::vector<SimplexId>& changed, unsigned threads, const std::stop_token& stop);

extern template void MarkInterfaceVertices<3>(
  Triangulation<3>&, std::span<const LabelId>, unsigned, const std::stop_token&);
extern template void MarkInterfaceVertices<4>(
  Triangulation<4>&, std::span<const LabelId>, unsigned, const std::stop_token&);
extern template void MarkInterfaceVerticesOf<3>(Triangulation<3>&, std::span<const LabelId>,
  const std::vector<SimplexId>&, unsigned, const std::stop_token&);
extern template void MarkInterfaceVerticesOf<4>(Triangulation<4>&, std::span<const LabelId>,
  const std::vector<SimplexId>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceVertices.h
 * @brief The vertices on the interfaces of a triangulation, without a mesh.
 */
#ifndef voxplex_InterfaceVertices_h
#define voxplex_InterfaceVertices_h

#include "Delaunay/Triangulation.h"
#include "Image/Domain.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * The vertices of all facets between tetrahedra of different labels, in the order of their ids: those of the facets that
 * ExtractMesh() makes.
 *
 * @param triangulation refined, so that the balls of which SimplexState::NearSurface is not set meet no interface
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end
 *
 * Time linear in the numbers of simplices and vertices.
 */
std::vector<Point<3>> FindInterfaceVertices(const Triangulation<3>& triangulation,
  const Domain<3>& image, unsigned threads = 1, const std::stop_token& stop = {});

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceStatistics.h
 * @brief What was done for the interfaces of a mesh.
 */
#ifndef voxplex_InterfaceStatistics_h
#define voxplex_InterfaceStatistics_h

#include <cstdint>

namespace voxplex
{

/** What was done for the interfaces of a mesh in 3D, besides the rules. */
struct InterfaceStatistics
{
  std::uint64_t JunctionCurves = 0; ///< pieces between corners, and closed ones
  std::uint64_t Corners = 0;        ///< where four labels meet
  std::uint64_t JunctionSeeds = 0;  ///< feature points on them, at most
  unsigned Rounds = 0;              ///< times that refinement went on for the sake of interfaces
  std::uint64_t Seeds = 0;          ///< feature points inserted then, at most
  std::uint64_t NonManifoldRepaired = 0; ///< edges that were not manifold on a label's boundary
  std::uint64_t NonManifoldOpened =
    0; ///< of these, edges around which tetrahedra were cut in pieces
  std::uint64_t NonManifoldLeft =
    0; ///< that still are not; none if they were not looked for (MeshingOptions::Manifold)
};

} // namespace voxplex

#endif

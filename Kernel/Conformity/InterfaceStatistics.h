// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceStatistics.h
 * @brief Statistics of the work on interfaces.
 */
#ifndef voxplex_InterfaceStatistics_h
#define voxplex_InterfaceStatistics_h

#include <cstdint>

namespace voxplex
{

/** Changes made for the interfaces of a mesh, in addition to the rules. In 4D, read triangles for edges. */
struct InterfaceStatistics
{
  std::uint64_t JunctionCurves = 0; ///< pieces between corners, and closed ones
  std::uint64_t Corners = 0;        ///< where four labels meet
  std::uint64_t JunctionSeeds = 0;  ///< feature points on them, at most
  unsigned Rounds = 0;              ///< times refinement was resumed to correct interfaces
  std::uint64_t Seeds = 0;          ///< feature points inserted in these rounds, at most
  unsigned LayerRounds = 0;         ///< times refinement was resumed to show hidden layers
  std::uint64_t LayerSeeds = 0;     ///< feature points inserted in these rounds, at most
  /** Edges where the boundary of a label was not manifold and is; of all inspections together. */
  std::uint64_t NonManifoldRepaired = 0;
  /** Repaired edges around which tetrahedra were cut in pieces. */
  std::uint64_t NonManifoldOpened = 0;
  /** Edges that still are not manifold; 0 if not looked for (InterfaceOptions::Manifold). */
  std::uint64_t NonManifoldLeft = 0;

  /** `before` edges were still not manifold; `left` of them could not be opened. */
  void CountOpened(std::uint64_t before, std::uint64_t left)
  {
    this->NonManifoldOpened = before - left;
    this->NonManifoldRepaired += this->NonManifoldOpened;
    this->NonManifoldLeft = left;
  }
};

} // namespace voxplex

#endif

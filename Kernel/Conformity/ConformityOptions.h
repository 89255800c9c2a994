// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ConformityOptions.h
 * @brief What the mesh keeps of the image: components and interfaces.
 */
#ifndef voxplex_ConformityOptions_h
#define voxplex_ConformityOptions_h

#include <cstdint>

namespace voxplex
{

/** The options of the connected components of labels. */
struct ComponentOptions
{
  /**
   * Connected components (through faces) with at least this number of voxels get elements, however
   * large delta is. So does the largest component of each label, however small it is. 0: components
   * are not checked. Components that still have no element are in ComponentStatistics::Lost. In
   * space-time, the same holds for the components of each frame: the mesh has elements there at
   * the time of the frame.
   */
  std::int64_t Smallest = 8;
  /**
   * If true, the components that are checked are sampled as finely as their thickness requires from
   * the start, however large delta is; and so are layers that the mesh hides (HiddenLayers), and gaps
   * in components (JoinPieces), unless InterfaceOptions::Rounds is 0. If false, a component that is thin
   * compared with delta is only as exact as delta allows, but has at least one element, and layers and
   * gaps are sampled where it takes few elements.
   */
  bool Exact = false;
};

/** The options of interfaces. */
struct InterfaceOptions
{
  /**
   * Start with points on the curves where three or more labels meet, so that edges of the mesh
   * follow these curves; 3D only.
   */
  bool SampleJunctions = true;
  /**
   * How many times, at most, refinement is resumed because interfaces of the image are too far from
   * those of the mesh (DistanceCheck), or because interfaces of the mesh are not manifold. 0: never.
   */
  unsigned Rounds = 8;
  /**
   * Make the boundary of every label manifold: two of its facets meet at each edge, in space-time at
   * each triangle. Some simplices may be cut in pieces for this (OpenRidges); the pieces are not
   * Delaunay. Does not depend on Rounds.
   */
  bool Manifold = true;
  /**
   * Move vertices of interfaces so that facets lie on the interfaces on average, and volumes are
   * right (FitInterfaces). The mesh is then no longer exactly Delaunay. In 3D only if the mesh is
   * optimised.
   */
  bool Fit = true;
};

} // namespace voxplex

#endif

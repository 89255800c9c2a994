// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceOptions.h
 * @brief Requirements on the interfaces of a mesh, besides the angles of their triangles.
 */
#ifndef voxplex_InterfaceOptions_h
#define voxplex_InterfaceOptions_h

namespace voxplex
{

struct InterfaceOptions
{
  /**
   * How many times, at most, refinement is resumed because interfaces of the image are too far from
   * those of the mesh (UniformInterfaceCheck, GradedInterfaceCheck), or because interfaces of the
   * mesh are not manifold. 0: never.
   */
  unsigned Rounds = 8;
  /**
   * Make the boundary of every label manifold: two of its facets meet at each edge. Some tetrahedra
   * may be cut in pieces for this (MakeSpindles); the pieces are not Delaunay. Does not depend on
   * Rounds.
   */
  bool Manifold = true;
};

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceOptions.h
 * @brief What the interfaces of a mesh have to be like, besides their triangles' angles.
 */
#ifndef voxplex_InterfaceOptions_h
#define voxplex_InterfaceOptions_h

namespace voxplex
{

struct InterfaceOptions
{
  /**
   * How often refinement goes on, at most, because interfaces of the image are farther from those of the mesh than
   * 1.5 delta, or because those of the mesh are not manifold; 0: never.
   */
  unsigned Rounds = 8;
  /**
   * Make the boundary of every label manifold: two of its facets meet at each edge. Where that takes pieces of tetrahedra,
   * these are not Delaunay (MakeSpindles). Does not depend on Rounds.
   */
  bool Manifold = true;
};

} // namespace voxplex

#endif

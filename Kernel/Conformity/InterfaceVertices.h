// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceVertices.h
 * @brief The vertices on the interfaces of a triangulation, without a mesh.
 */
#ifndef voxplex_InterfaceVertices_h
#define voxplex_InterfaceVertices_h

#include "Base/UninitialisedVector.h"
#include "Conformity/SeenSimplices.h"
#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"

#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief The vertices of all facets between simplices of different labels. ExtractMesh() makes the
 * same facets. The set can be updated after further refinement.
 *
 * Not thread safe; uses threads of its own. No thread may change the triangulation during a call.
 */
template <int D>
class InterfaceVertices
{
public:
  /** Positions, each in the order of the vertices' ids. */
  struct Changes
  {
    std::span<const Point<D>> Added; ///< valid until the next call
    std::vector<Point<D>> Gone;
  };

  /**
   * The references must outlive the object.
   * @param threads 0 means all cores; results do not depend on it
   */
  InterfaceVertices(const Triangulation<D>& triangulation, const Domain<D>& image,
    unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * Returns the changes since the last call. At the first call, all vertices are added. The
   * triangulation must be refined then: if SimplexState::NearSurface of a simplex is not set, its
   * circumball meets no interface.
   *
   * The first call takes time linear in the numbers of simplices and vertices. A later call takes
   * little time for each of these, and time linear in the sizes of the stars of the vertices with
   * new simplices. If most simplices are new, it takes as long as the first, and some time to
   * compare positions.
   * @throws Cancelled if a stop was requested before the end
   */
  Changes Update();

  /** Frees all memory. The next Update() is then a first one. */
  void Forget();

private:
  void FindAll(bool isRefined);
  Changes FindAllAgain();
  Changes FindChanges(const UninitialisedVector<VertexId>& candidates);
  UninitialisedVector<VertexId> VerticesOfNewSimplices();
  LabelId LabelOf(SimplexId s) const;
  /** Which of the known vertices are no longer alive: 1 or 0. */
  UninitialisedVector<std::uint8_t> AreRemoved() const;
  /** Drops known vertices. @return their positions */
  std::vector<Point<D>> Drop(std::span<const std::uint8_t> isGone);
  /** Which of these vertices are on interfaces: 1 or 0. */
  UninitialisedVector<std::uint8_t> AreOnInterfaces(std::span<const VertexId> vertices) const;
  bool IsOnInterface(VertexId v) const;

  const Triangulation<D>& Source;
  const Domain<D>& Image;
  const unsigned Threads;
  const std::stop_token Stop;
  SeenSimplices<D> Seen;
  UninitialisedVector<VertexId> Known;     ///< interface vertices at the last call, ascending
  UninitialisedVector<Point<D>> Positions; ///< of these
  std::vector<Point<D>> LastAdded;         ///< by a call that was not the first
};

extern template class InterfaceVertices<3>;
extern template class InterfaceVertices<4>;

} // namespace voxplex

#endif

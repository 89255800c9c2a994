// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Stores.h
 * @brief Records of vertices and simplices.
 *
 * Numbering in a simplex with vertices v[0] ... v[D] (drawn for D = 3):
 *
 *            v[3]
 *             .               Facet i is opposite v[i]. Neighbour n[i] is on its other side. It is
 *            /|\              None if facet i lies on the box (there is no infinite vertex).
 *           / | \
 *          /  |  \            det(v[1]-v[0], ..., v[D]-v[0]) > 0. For D = 3, seen from v[3], the
 *    v[0] .---|---. v[2]      other vertices are in counter-clockwise order (order of VTK_TETRA).
 *          \  |  /
 *           \ | /
 *            \|/
 *             ' v[1]
 */
#ifndef voxplex_Stores_h
#define voxplex_Stores_h

#include "Delaunay/ChunkedArray.h"
#include "Geometry/Circumball.h"
#include "Geometry/Point.h"
#include "Image/LabelImage.h"

#include <array>
#include <atomic>
#include <cstdint>

namespace voxplex
{

using VertexId = std::uint32_t;
using SimplexId = std::uint32_t;

/** No vertex, no simplex. */
inline constexpr std::uint32_t None = 0xffffffffu;

/** Identifies a worker in the lock word of a vertex. 0 means that no worker owns the vertex. */
using WorkerId = std::uint16_t;
inline constexpr unsigned MaximumNumberOfWorkers = 0xffffu;

/** The origin of a vertex (thesis, sections 2.1 and 2.2). */
enum class VertexKind : std::uint8_t
{
  Box,     ///< on the box: a corner or a projected circumcentre; never removed
  Free,    ///< a circumcentre, inside or on a flat end of the object; refinement may remove it
  Feature, ///< on an interface; never removed
  Shared   ///< a circumcentre on a plane that two slabs of space-time share; never removed
};

template <int D>
struct VertexRecord
{
  Point<D> Position;
  SimplexId Incident;  ///< any simplex of the star
  std::uint32_t Local; ///< its number within the operation that owns the vertex
  WorkerId Owner;      ///< the worker that may change the star; 0 if none; accessed atomically
  VertexKind Kind;
  bool Alive;
  bool OnInterface; ///< by the labels of the last inspection; see MarkInterfaceVertices()
};

/** In 3D a record is one cache line. A step of the cavity search reads one record. */
template <int D>
struct alignas(D == 3 ? 64 : 16) SimplexRecord
{
  std::array<VertexId, static_cast<std::size_t>(D + 1)> V;
  std::array<SimplexId, static_cast<std::size_t>(D + 1)> N;
  /**
   * If the ball is not reliable, Radius2 is NaN. Then every filter fails, and exact code decides.
   */
  Circumball<D> Ball;
};

enum class SimplexMark : std::uint8_t
{
  Unused, ///< not part of the triangulation
  Alive,
  Cavity, ///< in the cavity (or star) of the current operation
  Outside ///< not in conflict, as the current operation has found and remembers
};

/** Data of a simplex for the refinement. */
struct SimplexState
{
  std::uint32_t Generation; ///< incremented whenever the simplex dies; accessed atomically
  LabelId Label;            ///< label of the circumcentre; valid if Labelled
  bool Labelled;
  bool NearSurface; ///< its circumball may meet an interface
  /** Whether an inspection has given it a label (Triangulation::Labels()), and has nothing to mend around it. */
  bool Examined;

  /** A thread may call this even if it owns no vertex of the simplex. */
  std::uint32_t CurrentGeneration() const
  {
    // const_cast: C++20 has no atomic_ref to const. The value is only read.
    return std::atomic_ref<std::uint32_t>(const_cast<std::uint32_t&>(this->Generation))
      .load(std::memory_order_relaxed);
  }
};

} // namespace voxplex

#endif

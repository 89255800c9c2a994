// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Stores.h
 * @brief Records of vertices and simplices.
 *
 * Numbering in a simplex with vertices v[0] ... v[D] (drawn for D = 3):
 *
 *            v[3]
 *             .               facet i lies opposite v[i]; neighbour n[i] is on its other side,
 *            /|\              or None where facet i lies on the box (there is no infinite vertex).
 *           / | \
 *          /  |  \            det(v[1]-v[0], ..., v[D]-v[0]) > 0: seen from v[3] the
 *    v[0] .---|---. v[2]      others turn counter-clockwise for D = 3 (VTK_TETRA's order).
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

/** Names a thread in the lock word of a vertex; 0 is nobody. */
using WorkerId = std::uint16_t;
inline constexpr unsigned MaximumNumberOfWorkers = 0xffffu;

/** Where a vertex comes from (thesis, sections 2.1 and 2.2). */
enum class VertexKind : std::uint8_t
{
  Box,    ///< on the box: a corner or a projected circumcentre; never removed
  Free,   ///< a circumcentre, inside or on a flat end of the object; R6 may remove it
  Feature ///< on an interface; never removed
};

template <int D>
struct VertexRecord
{
  Point<D> Position;
  SimplexId Incident;  ///< some simplex of the star
  std::uint32_t Local; ///< scratch of the operation that owns the vertex: its number there
  WorkerId Owner;      ///< whoever may change the star, 0 if nobody; accessed atomically
  VertexKind Kind;
  bool Alive;
};

/** One cache line in 3D: a step of the cavity search reads one record. */
template <int D>
struct alignas(D == 3 ? 64 : 16) SimplexRecord
{
  std::array<VertexId, static_cast<std::size_t>(D + 1)> V;
  std::array<SimplexId, static_cast<std::size_t>(D + 1)> N;
  /** Radius2 is NaN where the ball is not reliable: every filter then fails and exact code decides. */
  Circumball<D> Ball;
};

enum class SimplexMark : std::uint8_t
{
  Unused, ///< not part of the triangulation
  Alive,
  Cavity, ///< in the cavity (or star) of the operation under way
  Outside ///< tested by the operation under way and not in conflict
};

/** What the refinement knows of a simplex. */
struct SimplexState
{
  std::uint32_t Generation; ///< incremented whenever the simplex dies; accessed atomically
  LabelId Label;            ///< label of the circumcentre, valid if Labelled
  bool Labelled;
  bool NearSurface; ///< its circumball may meet an interface

  /** Whoever holds no vertex of the simplex may call this. */
  std::uint32_t CurrentGeneration() const
  {
    // const_cast: atomic_ref to const is not in C++20; only read here
    return std::atomic_ref<std::uint32_t>(const_cast<std::uint32_t&>(this->Generation))
      .load(std::memory_order_relaxed);
  }
};

} // namespace voxplex

#endif

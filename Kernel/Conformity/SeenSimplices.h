// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SeenSimplices.h
 * @brief Tells which simplices of a triangulation are new.
 */
#ifndef voxplex_SeenSimplices_h
#define voxplex_SeenSimplices_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace voxplex
{

/**
 * @brief Remembers simplices by their ids and generations, in two bytes each.
 *
 * No thread may change the triangulation during a call.
 */
template <int D>
class SeenSimplices
{
public:
  /** @param triangulation must outlive this object */
  explicit SeenSimplices(const Triangulation<D>& triangulation)
    : Source(triangulation)
  {
  }

  bool IsEmpty() const { return this->Seen.empty(); }
  /** Frees all memory. All simplices are new then. */
  void Forget() { this->Seen = UninitialisedVector<std::uint16_t>(); }

  /** Makes room for the simplex ids that there are now. Call this before See(). */
  void MakeRoom()
  {
    // A few more, but not twice as many.
    const std::size_t ids = this->Source.SimplexIdEnd();
    if (ids > this->Seen.capacity())
    {
      this->Seen.reserve(ids + ids / 16);
    }
    this->Seen.resize(ids, NotKnown);
  }

  /**
   * Remembers a simplex. Threads may call this for different ids at the same time.
   * @return whether it is alive, and was not there when its id was seen last. A simplex whose
   *   generation does not fit into two bytes, as few do, is new each time.
   */
  bool See(SimplexId s)
  {
    const std::uint16_t now = this->Source.IsAlive(s)
      ? static_cast<std::uint16_t>(
          std::min<std::uint32_t>(this->Source.State(s).Generation, NotKnown))
      : NotKnown;
    const bool isNew = now != this->Seen[s] || now == NotKnown;
    this->Seen[s] = now;
    return isNew && this->Source.IsAlive(s);
  }

private:
  static constexpr std::uint16_t NotKnown = 0xffff; ///< or not alive

  const Triangulation<D>& Source;
  UninitialisedVector<std::uint16_t> Seen; ///< the generation of each id
};

} // namespace voxplex

#endif

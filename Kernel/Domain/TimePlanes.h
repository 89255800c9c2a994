// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TimePlanes.h
 * @brief The hyperplanes of constant time that a space-time mesh conforms to.
 */
#ifndef voxplex_TimePlanes_h
#define voxplex_TimePlanes_h

#include <algorithm>
#include <cstddef>
#include <vector>

namespace voxplex
{

/**
 * @brief Planes t = constant inside of a space-time mesh, and whether its two ends are the same.
 *
 * Planes divide the mesh into slabs. No pentatope has vertices on both sides of a plane. Times are
 * those of the mesher's frame.
 */
struct TimePlanes
{
  std::vector<double> Times; ///< ascending, strictly between the first and the last time
  /** The mesh's ends are congruent: the last state of the object is its first one. */
  bool Periodic = false;
  double First = 0.0; ///< time of the first flat end, if Periodic
  double Last = 0.0;  ///< time of the last flat end, if Periodic

  /** Whether meshes have to conform to anything. */
  bool Exist() const { return this->Periodic || !this->Times.empty(); }

  std::size_t NumberOfSlabs() const { return this->Times.size() + 1; }

  /** Whether a point of this time lies on a plane inside of the mesh. O(log planes). */
  bool AreAt(double time) const
  {
    return std::binary_search(this->Times.begin(), this->Times.end(), time);
  }

  /** Whether a point of this time has a twin at the other end. */
  bool IsPeriodicEnd(double time) const
  {
    return this->Periodic && (time == this->First || time == this->Last);
  }

  /** Whether facets of this time are to be the same from both sides: on a plane, or at a periodic end. */
  bool HaveFacetsAt(double time) const { return this->AreAt(time) || this->IsPeriodicEnd(time); }

  /** The number of the slab that a time lies in; a time on a plane lies in the slab after it. */
  std::size_t SlabAt(double time) const
  {
    return static_cast<std::size_t>(
      std::upper_bound(this->Times.begin(), this->Times.end(), time) - this->Times.begin());
  }
};

} // namespace voxplex

#endif

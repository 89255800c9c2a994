// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JunctionCurves.h
 * @brief The curves where three labels meet, and the corners where four do.
 */
#ifndef voxplex_JunctionCurves_h
#define voxplex_JunctionCurves_h

#include "Image/BitMask.h"
#include "Image/LabelField.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief The junctions of a label image as polylines.
 *
 * A lattice of half a voxel is cut in tetrahedra (Freudenthal's subdivision, six a cell, the same in all
 * cells). A triangle whose corners have three labels is crossed by a junction of the three, by Sperner's
 * lemma; a tetrahedron with three labels has exactly two such triangles, which are joined, and one with
 * four labels has four and is a corner. So curves are closed or end in corners, whatever the labels. On
 * its triangle a point is where the smoothed indicators of the three labels are equal, taken as linear there.
 *
 * Background counts as a label. Curves are looked for in cells between voxels of three labels or more and
 * followed from there; one that never comes to such a cell, where a third label wins by interpolation
 * alone, is not found.
 *
 * Immutable after construction: safe to call from any thread. Takes time linear in the number of surface
 * voxels, memory linear in the length of the curves.
 */
class JunctionCurves
{
public:
  /**
   * @param image, field, sites a label image, where its interfaces are, and its surface voxels; not referenced
   *   after construction
   * @param threads 0 means all cores; the result does not depend on it
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  JunctionCurves(const LabelImage<3>& image, const LabelField<3>& field, const BitMask<3>& sites,
    unsigned threads = 1, const std::stop_token& stop = {});

  /** A polyline. */
  struct Curve
  {
    std::vector<Point<3>>
      Points; ///< in order, in the frame; a closed one does not repeat the first
    std::array<LabelId, 3> Labels; ///< that meet there, ascending
    bool IsClosed;
  };

  /** In the order in which they come up on the lattice. */
  const std::vector<Curve>& Curves() const { return this->All; }
  /** Places where four labels meet: there curves end. */
  std::size_t NumberOfCorners() const { return this->Corners; }

private:
  std::vector<Curve> All;
  std::size_t Corners = 0;
};

} // namespace voxplex

#endif

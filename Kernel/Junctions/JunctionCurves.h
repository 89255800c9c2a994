// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JunctionCurves.h
 * @brief The curves where three labels meet, and the corners where four do; the edges of the faces where the image cuts
 *   the object.
 */
#ifndef voxplex_JunctionCurves_h
#define voxplex_JunctionCurves_h

#include "Domain/LabelField.h"
#include "Domain/ScalarField.h"
#include "Image/BitMask.h"

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
 * Curves have points on the sides of cells only, but next to corners and in rings inside of one: six tetrahedra to a cell make
 * curves zigzag that have a point in each.
 *
 * Background counts as a label. So does, behind each face where the image cuts the object, the space outside
 * of the image, a label of its own for each: so the edges of these faces are curves, on them to rounding, and corners of
 * the image's box are corners. Curves are looked for in cells between voxels of three labels or more and
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
   * @param image, field, sites a label image, where its interfaces are (a LabelField<3> or ScalarField<3>), and its
   *   surface voxels; not referenced after construction
   * @param threads 0 means all cores; the result does not depend on it
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  template <typename Field>
  JunctionCurves(const LabelImage<3>& image, const Field& field, const BitMask<3>& sites,
    unsigned threads = 1, const std::stop_token& stop = {});

  /** A polyline. */
  struct Curve
  {
    std::vector<Point<3>>
      Points; ///< in order, in the frame; a closed one does not repeat the first
    std::array<LabelId, 3> Labels; ///< that meet there, ascending; 0 for the outside of the image
    bool IsClosed;
  };

  /** In the order in which they come up on the lattice. */
  const std::vector<Curve>& Curves() const { return this->All; }
  /** Places where four labels meet, the outside of the image included: there curves end. */
  std::size_t NumberOfCorners() const { return this->Corners; }

private:
  std::vector<Curve> All;
  std::size_t Corners = 0;
};

} // namespace voxplex

#endif

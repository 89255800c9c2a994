// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file JunctionCurves.h
 * @brief The curves where three labels meet, and the corners where four labels meet. Also the edges
 * of the cut faces.
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
 * A lattice of half a voxel is cut into tetrahedra (Freudenthal's subdivision, six in a cube, the
 * same in all cubes). If the corners of a triangle have three labels, a junction of the three
 * crosses the triangle, by Sperner's lemma. A tetrahedron with three labels has exactly two such
 * triangles, and the curve joins them. A tetrahedron with four labels has four such triangles and
 * is a corner. So for all labels, curves are closed or end in corners. A point of a curve lies on
 * its triangle where the smoothed indicators of the three labels, taken as linear there, are equal.
 *
 * Curves have points on the faces of cubes only, except next to corners and in rings inside of a
 * cube. With a point in each of the six tetrahedra of a cube, curves would zigzag.
 *
 * Background counts as a label. If the image cuts the object at a face, the space behind that face
 * counts as a label, too, a separate one for each face. So the edges of these faces are curves that
 * lie on them up to rounding, and corners of the image's box are corners. The search starts in
 * cells between voxels of three labels or more and follows curves from there. If a curve never
 * passes such a cell (a third label wins by interpolation alone), it is not found.
 *
 * Immutable after construction: safe to call from any thread. Takes time linear in the number of
 * surface voxels, and memory linear in the length of the curves.
 */
class JunctionCurves
{
public:
  /**
   * @param image, field, sites a label image, its interfaces (a LabelField<3> or ScalarField<3>),
   *   and its surface voxels; not referenced after construction
   * @param threads 0 means all cores; the result does not depend on it
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  template <typename Field>
  JunctionCurves(const LabelImage<3>& image, const Field& field, const BitMask<3>& sites,
    unsigned threads = 1, const std::stop_token& stop = {});

  /** A polyline. */
  struct Curve
  {
    /** In order, in the frame. A closed curve does not repeat its first point. */
    std::vector<Point<3>> Points;
    /** The labels that meet there, ascending; 0 for the outside of the image. */
    std::array<LabelId, 3> Labels;
    bool IsClosed;
  };

  /** In the order in which the curves are found on the lattice. */
  const std::vector<Curve>& Curves() const { return this->All; }
  /**
   * The number of places where four labels meet and curves end. The outside of the image counts as
   * a label.
   */
  std::size_t NumberOfCorners() const { return this->Corners; }

private:
  std::vector<Curve> All;
  std::size_t Corners = 0;
};

} // namespace voxplex

#endif

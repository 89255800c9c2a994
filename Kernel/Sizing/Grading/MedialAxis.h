// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MedialAxis.h
 * @brief Points of the medial axis of the interfaces, from a sample of these.
 */
#ifndef voxplex_MedialAxis_h
#define voxplex_MedialAxis_h

#include "Geometry/Point.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/** Which circumballs of the sample count as medial. Lengths are in units of the sample. */
struct MedialBalls
{
  /** Upper bound of the radius: larger local feature sizes are not used. 0: no ball is medial. */
  double LargestRadius = 1.0;
  /**
   * Lower bound of the salience: the height above the ball at which the planes meet that touch the
   * ball at its points of contact. It is the height of the edge or bump outside the ball, and
   * infinite for a sheet. Edges and bumps that voxels leave are lower than a voxel.
   */
  double Salience = 0.0;
  /** Smallest angle at which the centre sees the points of contact, degrees, 0 to 180. */
  double ContactAngle = 90.0;
};

/**
 * The poles of a sample (thesis, section 2.6.1; Amenta and Bern 1999). The poles of a point are the
 * farthest of its Voronoi vertices on either side of the interface. The first pole is the farthest
 * of all; the second is the farthest on the side opposite to the first. They are taken from the
 * Delaunay triangulation of the sample (D(Z) in the thesis), which needs the sample alone.
 *
 * The medial axis has a branch into every edge of the interfaces, also where three labels meet, and
 * into every stair of voxels. At its end the local feature size is 0, and no sampling is fine
 * enough. Poles on such branches are recognised by their points of contact and left out (the object
 * angle of Dey and Zhao 2004; for balls of few voxels the salience takes its place).
 *
 * Cost: the triangulation by all threads; about six simplices a point in 3D.
 *
 * @param sample points in any order, also none; two equal points count as one
 * @param threads 0 means all cores; the result does not depend on it
 * @return centres, in lexicographic order, without duplicates
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::vector<Point<D>> FindPoles(const std::vector<Point<D>>& sample, const MedialBalls& which,
  unsigned threads, const std::stop_token& stop);

extern template std::vector<Point<3>> FindPoles<3>(
  const std::vector<Point<3>>&, const MedialBalls&, unsigned, const std::stop_token&);
extern template std::vector<Point<4>> FindPoles<4>(
  const std::vector<Point<4>>&, const MedialBalls&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif

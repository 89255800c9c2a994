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

/** Which balls count as medial. Lengths are in units of the sample. */
struct MedialBalls
{
  /** Larger ones are left out: nobody asks for so large a local feature size. 0: all are. */
  double LargestRadius = 1.0;
  /**
   * Where the planes that touch the ball at its points of contact meet is so far above the ball, at least:
   * the height of the edge or bump that the ball is not part of. Those that voxels leave are lower than a
   * voxel. Infinite for a sheet.
   */
  double Salience = 0.0;
  /** At least at this angle the points of contact are seen from the centre, degrees, 0 to 180. */
  double ContactAngle = 90.0;
};

/**
 * The poles of a sample (thesis, section 2.6.1; Amenta and Bern 1999): of the Voronoi vertices of a point
 * that lie on either side of the interface the farthest. They are taken from the Delaunay triangulation of
 * the sample, the thesis' D(Z), which needs nothing but the sample: the second side is the one away from
 * the farthest of all Voronoi vertices.
 *
 * The medial axis has a branch into every edge of the interfaces, those along which three labels meet
 * among them, and into every stair that voxels have left: there the local feature size is 0, and no sampling
 * would be dense enough. Poles on such branches are told by their points of contact (the object angle of Dey and
 * Zhao 2004; the salience is what is left of it where the ball is small beside a voxel) and left out.
 *
 * Cost: that of the triangulation, by all threads; about six simplices a point.
 *
 * @param sample points in any order, as few as there may be; one that is there twice counts once
 * @param threads 0 means all cores; the result does not depend on it
 * @return centres, in lexicographic order, none twice
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<Point<3>> FindPoles(const std::vector<Point<3>>& sample, const MedialBalls& which,
  unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif

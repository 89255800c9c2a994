// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeFrame.h
 * @brief How a series of images lies in space and time.
 *
 * In space as one of its images does (ImageFrame). The fourth coordinate of the kernel's frame is
 * the time since the first image, in units of length: multiplied by the time scale. The matrix of
 * the kernel's grid is thus block diagonal, and what it returns has the same handedness in physical
 * space-time as in physical space.
 */
#ifndef voxplex_SpaceTimeFrame_h
#define voxplex_SpaceTimeFrame_h

#include "Image/ImageFrame.h"

#include <algorithm>
#include <cstdint>

namespace voxplex
{

struct SpaceTimeFrame
{
  GridGeometry<4> Grid;
  ImageFrame Space;
  double FirstTime = 0.0;
  double LastTime = 0.0;
  double TimeScale = 1.0; ///< length per unit of time

  /** Position of a point of the frame in physical space. */
  Point<3> Position(const Point<4>& p) const { return this->Space.ToWorld({ p[0], p[1], p[2] }); }

  /** Its time: the last image's in the frame's last hyperplane, to the bit. */
  double Time(const Point<4>& p) const
  {
    const double end =
      this->Grid.IndexToFrame[3][3] * static_cast<double>(this->Grid.Dimensions[3] - 1);
    return p[3] >= end ? this->LastTime
                       : std::min(this->LastTime, this->FirstTime + p[3] / this->TimeScale);
  }

  /** (x, y, z, t). */
  Point<4> ToWorld(const Point<4>& p) const
  {
    const Point<3> x = this->Position(p);
    return { x[0], x[1], x[2], this->Time(p) };
  }
};

/** A series of `images` images at equal distances in time; images >= 2, first < last, timeScale > 0. */
inline SpaceTimeFrame MakeSpaceTimeFrame(
  const ImageFrame& space, std::int64_t images, double first, double last, double timeScale)
{
  SpaceTimeFrame frame;
  frame.Space = space;
  frame.FirstTime = first;
  frame.LastTime = last;
  frame.TimeScale = timeScale;
  for (std::size_t r = 0; r < 3; ++r)
  {
    frame.Grid.Dimensions[r] = space.Grid.Dimensions[r];
    for (std::size_t c = 0; c < 3; ++c)
    {
      frame.Grid.IndexToFrame[r][c] = space.Grid.IndexToFrame[r][c];
    }
  }
  frame.Grid.Dimensions[3] = images;
  frame.Grid.IndexToFrame[3][3] = (last - first) / static_cast<double>(images - 1) * timeScale;
  return frame;
}

} // namespace voxplex

#endif

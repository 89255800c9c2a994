// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageBorder.h
 * @brief The planes on which the border of an image cuts the object.
 */
#ifndef voxplex_ImageBorder_h
#define voxplex_ImageBorder_h

#include "Geometry/Point.h"

namespace voxplex
{

/**
 * @brief The object ends flat on these planes; beyond them all is background.
 *
 * A set of planes is a number: bit 2 a + end stands for the plane at the lower (0) or upper (1) end of axis a. All methods
 * are const and safe to call from any number of threads.
 */
template <int D>
class ImageBorder
{
public:
  /** The planes that p lies on. Interface points that a Domain finds there lie on them up to rounding. */
  virtual unsigned FacesAt(const Point<D>& p) const = 0;

  /** Whether p lies beyond one of the planes. */
  virtual bool IsBeyond(const Point<D>& p) const = 0;

  /** Whether p lies beyond none of the planes by more than rounding. */
  virtual bool IsWithin(const Point<D>& p) const = 0;

  /** The point on all of some planes to which p moves along the axes of the image. */
  virtual Point<D> MoveOnto(const Point<D>& p, unsigned faces) const = 0;

  /**
   * A point near p where an interface meets the planes of p, or where one of these meets another plane.
   * @param p on a plane
   * @param reach how far away the point may be
   * @return false if none was found
   */
  virtual bool FindEdge(const Point<D>& p, double reach, Point<D>& z) const = 0;

protected:
  ~ImageBorder() = default;
};

} // namespace voxplex

#endif

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
 * @brief The planes on which the object ends flat. Beyond them is background only. The flat parts of the
 * object's boundary that lie on them are its *cut faces*: there the image cuts the object.
 *
 * A set of planes is a number: bit 2 a + end stands for the plane at the lower (0) or upper (1) end
 * of axis a. All methods are const and safe to call from any number of threads.
 */
template <int D>
class ImageBorder
{
public:
  /**
   * The planes on which p lies. Interface points that a Domain finds on a plane lie on it up to
   * rounding.
   */
  virtual unsigned FacesAt(const Point<D>& p) const = 0;

  /** Whether p lies beyond one of the planes. */
  virtual bool IsBeyond(const Point<D>& p) const = 0;

  /** Whether p lies on the object's side of all planes, or on a plane up to rounding. */
  virtual bool IsWithin(const Point<D>& p) const = 0;

  /** p moved along the axes of the image onto all planes of a set. */
  virtual Point<D> MoveOnto(const Point<D>& p, unsigned faces) const = 0;

  /**
   * A point near p where an interface, or another plane, meets the planes of p.
   * @param p a point on a plane
   * @param reach the largest distance of the point from p
   * @return false if no such point was found
   */
  virtual bool FindEdge(const Point<D>& p, double reach, Point<D>& z) const = 0;

protected:
  ~ImageBorder() = default;
};

} // namespace voxplex

#endif

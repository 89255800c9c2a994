// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Domain.h
 * @brief The interface through which the refinement rules see the object to be meshed.
 */
#ifndef voxplex_Domain_h
#define voxplex_Domain_h

#include "Domain/ImageBorder.h"
#include "Geometry/Box.h"
#include "Image/LabelImage.h"

namespace voxplex
{

/**
 * @brief A partition of space into labels, with interfaces between them.
 *
 * The interfaces (the boundary of Omega in the thesis) are where Label() changes. ImageDomain is
 * the domain of a label image, or of the inside of an isosurface of a grey-value image. All methods
 * are const and safe to call from any number of threads.
 */
template <int D>
class Domain
{
public:
  virtual ~Domain() = default;

  /** Bounding box of all labels but background. All interfaces lie inside or on it. */
  virtual Box<D> Bounds() const = 0;

  /**
   * Whether the object has a flat end on the lower (0) or upper (1) face of Bounds() along the last
   * axis: the first or last frame of a space-time image. A point beyond such a face has the label
   * and the interface points of its projection onto the face.
   */
  virtual bool HasTimeBorder(unsigned) const { return false; }

  /**
   * Label of a point. Outside of Bounds() it is 0 (background), except beyond a flat end
   * (HasTimeBorder()).
   */
  virtual LabelId Label(const Point<D>& p) const = 0;

  /** The value that a label id has in the image. */
  virtual std::int64_t LabelValue(LabelId id) const = 0;

  /** Lower bound of the distance from p to the nearest interface. The cost is one table look-up. */
  virtual double DistanceBound(const Point<D>& p) const = 0;

  /**
   * A quick estimate of cfp(p), for a first test that decides most points. An interface point that
   * is nearly as close to p as the closest one lies within about `error` of z. This is not a bound:
   * where an interface bends sharply, the distance may be a few times larger.
   * @param label Label(p)
   * @return false if no interface point was found
   */
  virtual bool NearSurfacePoint(
    const Point<D>& p, LabelId label, Point<D>& z, double& error) const = 0;

  /** What StartSearch() has found out about a point: a line from it that meets an interface. */
  struct Search
  {
    bool IsStarted = false;
    Point<D> End;  ///< where the line ends, in coordinates of the domain's own
    Point<D> Step; ///< from End to the point
    double Length; ///< of Step, in the frame
    /** Two places End + T Step on the line, and the margins of the point's label there. */
    struct
    {
      double T;
      double Margin;
    } Outside, Inside;
  };
  /** NearSurfacePoint(), and the start of the search for the closest surface point. */
  virtual bool StartSearch(
    const Point<D>& p, LabelId label, Point<D>& z, double& error, Search&) const
  {
    return this->NearSurfacePoint(p, label, z, error);
  }
  /** ClosestSurfacePoint(). @param search of the same point and label, by StartSearch() if at all */
  virtual bool FinishSearch(const Search&, const Point<D>& p, LabelId label, Point<D>& z) const
  {
    return this->ClosestSurfacePoint(p, label, z);
  }

  /**
   * cfp(p) of the thesis: the point of an interface that is closest to p, to about half a voxel.
   * @param label Label(p)
   * @return false if no interface point was found
   */
  virtual bool ClosestSurfacePoint(const Point<D>& p, LabelId label, Point<D>& z) const = 0;

  /**
   * The point where the segment from a to b first leaves the label of a. Features thinner than half
   * a voxel may be missed.
   * @param labelOfA Label(a)
   * @return false if no change of label was found
   */
  virtual bool FirstCrossing(
    const Point<D>& a, LabelId labelOfA, const Point<D>& b, Point<D>& z) const = 0;

  /**
   * The planes on which the border of the image cuts the object; null if it does not. Only in 3D.
   */
  virtual const ImageBorder<D>* Border() const { return nullptr; }

  /**
   * An interface point on a flat end: about the closest one to p on that end.
   * @param p a point on the flat end, within a few voxels of an interface
   * @return false if none was found
   */
  virtual bool ClosestSurfacePointOnEnd(const Point<D>&, Point<D>&) const { return false; }
};

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Domain.h
 * @brief All that the refinement rules ask of what is being meshed.
 */
#ifndef voxplex_Domain_h
#define voxplex_Domain_h

#include "Geometry/Box.h"
#include "Image/LabelImage.h"

namespace voxplex
{

/** Bounds of a distance: Lower <= distance <= Upper. */
struct DistanceInterval
{
  double Lower;
  double Upper;
};

/**
 * @brief A partition of space into labels, with interfaces between them.
 *
 * The interfaces (the boundary of Omega of the thesis) are where Label() changes. An image is one such
 * domain (ImageDomain), be it one of labels or the inside of an isosurface of a grey-value image. All methods
 * are const and safe to call from any number of threads.
 */
template <int D>
class Domain
{
public:
  virtual ~Domain() = default;

  /** Bounding box of everything that is not background; all interfaces lie inside or on it. */
  virtual Box<D> Bounds() const = 0;

  /**
   * Whether the object ends flat on the lower (0) or upper (1) face of Bounds() along the last axis:
   * the first and last frame of a space-time image. Beyond such a face all is as on the face: a point
   * there has the label of its projection, and interface points are those of the projection.
   */
  virtual bool IsFlatEnd(unsigned) const { return false; }

  /** Label of a point; 0 (background) outside of Bounds(), but for what lies beyond a flat end. */
  virtual LabelId Label(const Point<D>& p) const = 0;

  /** The image's value of a label id. */
  virtual std::int64_t LabelValue(LabelId id) const = 0;

  /** Bounds of the distance from p to the nearest interface; cheap: one table look-up. */
  virtual DistanceInterval DistanceBounds(const Point<D>& p) const = 0;

  /**
   * A quick estimate of cfp(p): an interface point nearly as close to p as the closest lies about
   * `error` from z. Not a bound: where an interface bends sharply it may be a few times farther. For
   * a first test that settles most points.
   * @param label Label(p)
   * @return false if no interface point was found
   */
  virtual bool NearSurfacePoint(
    const Point<D>& p, LabelId label, Point<D>& z, double& error) const = 0;

  /**
   * cfp(p) of the thesis: a point of an interface that is closest to p, up to about half a voxel.
   * @param label Label(p)
   * @return false if no interface point was found
   */
  virtual bool ClosestSurfacePoint(const Point<D>& p, LabelId label, Point<D>& z) const = 0;

  /**
   * Where the segment from a to b first leaves the label of a (up to features thinner than half a
   * voxel).
   * @param labelOfA Label(a)
   * @return false if no change of label was found
   */
  virtual bool FirstCrossing(
    const Point<D>& a, LabelId labelOfA, const Point<D>& b, Point<D>& z) const = 0;

  /** Whether the border of the image cuts the object: it ends flat there, on planes. Only in 3D. */
  virtual bool IsCut() const { return false; }

  /**
   * Which of these planes p lies on: bit 2 a + end for that at the lower (0)
   * or upper (1) end of axis a. Interface points that methods of this class find there lie on them up to rounding.
   */
  virtual unsigned CutFaces(const Point<D>&) const { return 0; }

  /** Whether p lies beyond one of these planes, where all is background. */
  virtual bool IsBeyondCutFaces(const Point<D>&) const { return false; }

  /** Whether p lies beyond none of these planes by more than rounding. */
  virtual bool IsWithinCutFaces(const Point<D>&) const { return true; }

  /** The point on all of these planes to which p moves along the axes of the image. */
  virtual Point<D> MoveOntoCutFaces(const Point<D>& p, unsigned) const { return p; }

  /**
   * A point near p where an interface meets the cut faces of p, or where one of these meets another.
   * @param p on a cut face
   * @param reach how far away it may be
   * @return false if none was found
   */
  virtual bool NearCutEdge(const Point<D>&, double /*reach*/, Point<D>& /*z*/) const
  {
    return false;
  }

  /**
   * An interface point on a flat end, near to p and about closest among those on that end.
   * @param p a point on the flat end, within a few voxels of an interface
   * @return false if none was found
   */
  virtual bool ClosestSurfacePointOnEnd(const Point<D>&, Point<D>&) const { return false; }
};

} // namespace voxplex

#endif

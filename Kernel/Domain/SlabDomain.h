// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlabDomain.h
 * @brief The part of a space-time domain between two times, as the refinement rules see it.
 */
#ifndef voxplex_SlabDomain_h
#define voxplex_SlabDomain_h

#include "Domain/Domain.h"

namespace voxplex
{

/**
 * @brief A domain between two time planes. Beyond a plane, everything is as it is on the plane.
 *
 * So a plane is a flat end (Domain::HasTimeBorder()), as the first and the last frame of an image
 * are: a point beyond it has the label and the interface points of its projection onto it. All
 * interface points lie in the slab; those on a plane have the plane's time to the bit.
 *
 * Immutable: all methods are const and safe to call from any thread. A query takes one or two
 * queries of the whole domain; ClosestSurfacePoint() near a plane up to four.
 */
class SlabDomain final : public Domain<4>
{
public:
  /**
   * @param whole must outlive this
   * @param first, last times of the planes; infinite: the slab reaches to the domain's own end
   */
  SlabDomain(const Domain<4>& whole, double first, double last);

  Box<4> Bounds() const override;
  bool HasTimeBorder(unsigned end) const override;
  LabelId Label(const Point<4>& p) const override { return this->Whole.Label(this->Clamp(p)); }
  std::int64_t LabelValue(LabelId id) const override { return this->Whole.LabelValue(id); }
  /** A bound of the distance from the whole domain's interfaces. */
  double DistanceBound(const Point<4>& p) const override
  {
    return this->Whole.DistanceBound(this->Clamp(p));
  }
  /** Finds nothing if the estimate lies outside of the slab. */
  bool NearSurfacePoint(
    const Point<4>& p, LabelId label, Point<4>& z, double& error) const override;
  /**
   * If the closest interface point of the whole domain lies beyond a plane: the closest point that
   * is found on the plane, or on the way to where the closest point projects onto it. None may be found
   * although there is one.
   */
  bool ClosestSurfacePoint(const Point<4>& p, LabelId label, Point<4>& z) const override;
  /** Beyond a plane, the segment is replaced by its projection onto the plane. */
  bool FirstCrossing(
    const Point<4>& a, LabelId labelOfA, const Point<4>& b, Point<4>& z) const override;
  bool ClosestSurfacePointOnEnd(const Point<4>& p, Point<4>& z) const override
  {
    return this->Whole.ClosestSurfacePointOnEnd(p, z);
  }

private:
  /** p, or its projection onto the plane beyond which it lies. */
  Point<4> Clamp(Point<4> p) const;
  bool IsOutside(const Point<4>& p) const { return p[3] < this->First || p[3] > this->Last; }
  /** FirstCrossing() of a segment within the slab. */
  bool FirstCrossingWithin(
    const Point<4>& a, LabelId labelOfA, const Point<4>& b, Point<4>& z) const;

  const Domain<4>& Whole;
  const double First; ///< time of the plane or flat end; infinite if there is none
  const double Last;
};

} // namespace voxplex

#endif

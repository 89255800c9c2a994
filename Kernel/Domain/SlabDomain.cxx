// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain/SlabDomain.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

namespace
{

/**
 * How far the search goes from a point towards the projection of an interface point onto a plane,
 * in distances between the two. An interface that is not parallel to the time axis may meet the
 * plane farther away.
 */
constexpr double Overshoot = 1.5;

} // namespace

SlabDomain::SlabDomain(const Domain<4>& whole, double first, double last)
  : Whole(whole)
  , First(whole.HasTimeBorder(0) ? std::max(first, whole.Bounds().Min[3]) : first)
  , Last(whole.HasTimeBorder(1) ? std::min(last, whole.Bounds().Max[3]) : last)
{
}

Box<4> SlabDomain::Bounds() const
{
  Box<4> bounds = this->Whole.Bounds();
  bounds.Min[3] = std::max(bounds.Min[3], this->First);
  bounds.Max[3] = std::min(bounds.Max[3], this->Last);
  return bounds;
}

bool SlabDomain::HasTimeBorder(unsigned end) const
{
  return std::isfinite(end == 0 ? this->First : this->Last);
}

Point<4> SlabDomain::Clamp(Point<4> p) const
{
  p[3] = std::clamp(p[3], this->First, this->Last);
  return p;
}

//------------------------------------------------------------------------------------------------
bool SlabDomain::NearSurfacePoint(
  const Point<4>& p, LabelId label, Point<4>& z, double& error) const
{
  return this->Whole.NearSurfacePoint(this->Clamp(p), label, z, error) && !this->IsOutside(z);
}

bool SlabDomain::ClosestSurfacePoint(const Point<4>& p, LabelId label, Point<4>& z) const
{
  Point<4> q = this->Clamp(p);
  if (!this->Whole.ClosestSurfacePoint(q, label, z))
  {
    return false;
  }
  if (!this->IsOutside(z))
  {
    return true;
  }
  q =
    this->Bounds().Clamp(q); // circumcentres may be very far away; there is background up to there
  const Point<4> beyond = z;
  const Point<4> projection = this->Clamp(beyond);
  Point<4> candidate;
  bool found = false;
  const auto take = [&](const Point<4>& x)
  {
    if (!found || Distance2(x, q) < Distance2(z, q))
    {
      z = x;
      found = true;
    }
  };
  if (this->FirstCrossingWithin(q, label, Interpolate(q, projection, Overshoot), candidate))
  {
    take(candidate);
  }
  // Where the segment from q to the closest point meets the plane: no interface lies before it.
  const double time = projection[3];
  Point<4> onPlane =
    q[3] == beyond[3] ? q : Interpolate(q, beyond, (time - q[3]) / (beyond[3] - q[3]));
  onPlane[3] = time;
  if (this->Whole.ClosestSurfacePointOnEnd(onPlane, candidate))
  {
    take(candidate);
  }
  return found;
}

//------------------------------------------------------------------------------------------------
bool SlabDomain::FirstCrossingWithin(
  const Point<4>& a, LabelId labelOfA, const Point<4>& b, Point<4>& z) const
{
  const Point<4> end = this->Clamp(b);
  if (!this->Whole.FirstCrossing(a, labelOfA, end, z))
  {
    return false;
  }
  z[3] = std::clamp(z[3], std::min(a[3], end[3]), std::max(a[3], end[3])); // rounding
  return true;
}

bool SlabDomain::FirstCrossing(
  const Point<4>& a, LabelId labelOfA, const Point<4>& b, Point<4>& z) const
{
  // The parts before, between and after the planes. Each of the first two may be empty.
  Point<4> from = this->Clamp(a);
  std::array<double, 2> planes = { this->First, this->Last };
  if (a[3] > b[3])
  {
    std::swap(planes[0], planes[1]);
  }
  for (const double time : planes)
  {
    const double part = (time - a[3]) / (b[3] - a[3]);
    if (part > 0.0 && part < 1.0)
    {
      Point<4> to = Interpolate(a, b, part);
      to[3] = time;
      if (this->FirstCrossingWithin(from, labelOfA, to, z))
      {
        return true;
      }
      from = to;
    }
  }
  return this->FirstCrossingWithin(from, labelOfA, b, z);
}

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// An analytic domain, where every answer is known.
#ifndef voxplex_BallDomain_h
#define voxplex_BallDomain_h

#include "Image/Domain.h"

#include <algorithm>
#include <cmath>

namespace voxplex::checks
{

/** A ball of label 5 in background: exact answers, no image. */
class BallDomain : public Domain<3>
{
public:
  explicit BallDomain(double radius)
    : R(radius)
  {
  }
  Box<3> Bounds() const override
  {
    return { { -this->R, -this->R, -this->R }, { this->R, this->R, this->R } };
  }
  LabelId Label(const Point<3>& p) const override { return Norm(p) < this->R ? 1 : 0; }
  std::int64_t LabelValue(LabelId id) const override { return id == 1 ? 5 : 0; }
  DistanceInterval DistanceBounds(const Point<3>& p) const override
  {
    const double d = std::abs(Norm(p) - this->R);
    return { std::max(0.0, d - this->Slack), d + this->Slack };
  }
  bool ClosestSurfacePoint(const Point<3>& p, LabelId, Point<3>& z) const override
  {
    const double norm = Norm(p);
    if (norm == 0.0)
    {
      z = { this->R, 0.0, 0.0 };
      return true;
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
      z[i] = p[i] * this->R / norm;
    }
    return true;
  }
  bool NearSurfacePoint(const Point<3>& p, LabelId label, Point<3>& z, double& error) const override
  {
    error = 0.0;
    return this->ClosestSurfacePoint(p, label, z);
  }
  bool FirstCrossing(const Point<3>& a, LabelId, const Point<3>& b, Point<3>& z) const override
  {
    const Point<3> d = Subtract(b, a);
    const double qa = Dot(d, d);
    const double qb = Dot(a, d);
    const double qc = Dot(a, a) - this->R * this->R;
    const double root = std::sqrt(std::max(0.0, qb * qb - qa * qc));
    for (const double t : { (-qb - root) / qa, (-qb + root) / qa })
    {
      if (t >= 0.0 && t <= 1.0)
      {
        z = Interpolate(a, b, t);
        return true;
      }
    }
    return false;
  }
  static double Norm(const Point<3>& p) { return std::sqrt(Dot(p, p)); }

  double R;
  double Slack = 0.05;
};

/** The box in which the mesher would refine a ball. */
inline Box<3> Around(const BallDomain& ball, double delta)
{
  Box<3> box = ball.Bounds();
  for (std::size_t a = 0; a < 3; ++a)
  {
    box.Min[a] -= 2.0 * delta;
    box.Max[a] += 2.0 * delta;
  }
  return box;
}

} // namespace voxplex::checks

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// An analytic domain, where every answer is known.
#ifndef voxplex_BallDomain_h
#define voxplex_BallDomain_h

#include "Domain/Domain.h"

#include <algorithm>
#include <cmath>

namespace voxplex::checks
{

/** A ball of label 5 in background: exact answers, no image. */
template <int D>
class BallDomainOf : public Domain<D>
{
public:
  explicit BallDomainOf(double radius)
    : R(radius)
  {
  }
  Box<D> Bounds() const override
  {
    Box<D> box;
    box.Min.fill(-this->R);
    box.Max.fill(this->R);
    return box;
  }
  LabelId Label(const Point<D>& p) const override { return Norm(p) < this->R ? 1 : 0; }
  std::int64_t LabelValue(LabelId id) const override { return id == 1 ? 5 : 0; }
  double DistanceBound(const Point<D>& p) const override
  {
    return std::max(0.0, std::abs(Norm(p) - this->R) - this->Slack);
  }
  bool ClosestSurfacePoint(const Point<D>& p, LabelId, Point<D>& z) const override
  {
    const double norm = Norm(p);
    if (norm == 0.0)
    {
      z.fill(0.0);
      z[0] = this->R;
      return true;
    }
    for (std::size_t i = 0; i < z.size(); ++i)
    {
      z[i] = p[i] * this->R / norm;
    }
    return true;
  }
  bool NearSurfacePoint(const Point<D>& p, LabelId label, Point<D>& z, double& error) const override
  {
    error = 0.0;
    return this->ClosestSurfacePoint(p, label, z);
  }
  bool FirstCrossing(const Point<D>& a, LabelId, const Point<D>& b, Point<D>& z) const override
  {
    const Point<D> d = Subtract(b, a);
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
  static double Norm(const Point<D>& p) { return std::sqrt(Dot(p, p)); }

  double R;
  double Slack = 0.05;
};

using BallDomain = BallDomainOf<3>;

} // namespace voxplex::checks

#endif

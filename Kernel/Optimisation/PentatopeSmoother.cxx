// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/PentatopeSmoother.h"

#include "Geometry/SimplexQuality.h"
#include "Geometry/SymmetricEigen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace voxplex
{

namespace
{

/** Lengths of steps, in shortest edges. */
constexpr double FirstStep = 0.3;
constexpr double ShortestStep = 0.01;
constexpr double DifferenceStep = 1e-4;

/** Steps of one vertex, those that fail included. */
constexpr unsigned MostSteps = 12;

/** A vertex of an interface moves at most this far, in shortest edges. */
constexpr double LongestMove = 0.25;

/**
 * A direction is normal to an interface if this part of its facets' area faces it. Less is
 * curvature.
 */
constexpr double NormalShare = 0.15;

} // namespace

//------------------------------------------------------------------------------------------------
bool PentatopeSmoother::Improve(std::uint32_t v, double target, double tolerance)
{
  this->Tolerance = tolerance;
  this->Start = this->Target.PointOf(v);
  this->GatherStar(v);
  if (this->Tried.empty() || this->Star.front().Quality >= target)
  {
    return false;
  }
  this->GatherNormals(v);
  double worst = this->Star.front().Quality;
  bool moved = false;
  double step = FirstStep * this->ShortestEdge;
  for (unsigned k = 0; k < MostSteps && worst < target; ++k)
  {
    Point<4> direction = this->GradientOfWorst(v, DifferenceStep * this->ShortestEdge);
    this->Project(direction);
    const double length = std::sqrt(Dot(direction, direction));
    if (!(length > 0.0))
    {
      break;
    }
    Point<4> p = this->Target.PointOf(v);
    for (std::size_t a = 0; a < 4; ++a)
    {
      p[a] += step * direction[a] / length;
    }
    if (this->MayMoveTo(v, p) && this->Try(p, worst))
    {
      this->Target.Move(v, p);
      for (std::size_t s = 0; s < this->Tried.size(); ++s)
      {
        this->Star[s].Quality = this->Tried[s];
      }
      this->PutWorstFirst();
      worst = this->Star.front().Quality;
      moved = true;
    }
    else
    {
      step *= 0.5;
      if (step < ShortestStep * this->ShortestEdge)
      {
        break;
      }
    }
  }
  for (std::size_t s = 0; moved && s < this->Tried.size(); ++s)
  {
    this->Target.SetQuality(this->Star[s].Id, this->Star[s].Quality);
  }
  return moved;
}

void PentatopeSmoother::GatherStar(std::uint32_t v)
{
  this->Star.clear();
  std::size_t inside = 0;
  double shortest2 = std::numeric_limits<double>::infinity();
  for (const std::uint32_t s : this->Target.StarOf(v))
  {
    const PentatopeComplex::Vertices& corners = this->Target.CornersOf(s);
    std::uint32_t place = 0;
    for (std::uint32_t k = 0; k < 5; ++k)
    {
      if (corners[k] == v)
      {
        place = k;
      }
      else
      {
        shortest2 = std::min(shortest2, Distance2(this->Target.PointOf(corners[k]), this->Start));
      }
    }
    const LabelId label = this->Target.LabelOf(s);
    inside += label != 0 ? 1 : 0;
    this->Star.push_back({ s, place, label, this->Target.QualityOf(s), -1.0 });
  }
  this->ShortestEdge = std::sqrt(shortest2);
  this->Tried.resize(inside);
  std::partition(
    this->Star.begin(), this->Star.end(), [](const Around& one) { return one.Label != 0; });
  this->PutWorstFirst();
}

void PentatopeSmoother::PutWorstFirst()
{
  const auto end = this->Star.begin() + static_cast<std::ptrdiff_t>(this->Tried.size());
  const auto worst = std::min_element(this->Star.begin(), end,
    [](const Around& a, const Around& b)
    { return std::pair(a.Quality, a.Id) < std::pair(b.Quality, b.Id); });
  std::iter_swap(this->Star.begin(), worst);
}

void PentatopeSmoother::GatherNormals(std::uint32_t v)
{
  this->Normals.clear();
  const std::span<const std::uint32_t> facets = this->Target.FacetsAt(v);
  this->IsOnInterface = !facets.empty();
  if (!this->IsOnInterface)
  {
    return;
  }
  std::array<Point<4>, 4> sum{};
  double total = 0.0;
  for (const std::uint32_t f : facets)
  {
    const std::array<std::uint32_t, 4>& corners = this->Target.Facet(f);
    const Point<4>& origin = this->Target.PointOf(corners[0]);
    const Point<4> normal = Cross(Subtract(this->Target.PointOf(corners[1]), origin),
      Subtract(this->Target.PointOf(corners[2]), origin),
      Subtract(this->Target.PointOf(corners[3]), origin));
    const double area = std::sqrt(Dot(normal, normal));
    for (std::size_t a = 0; a < 4 && area > 0.0; ++a)
    {
      for (std::size_t b = 0; b < 4; ++b)
      {
        sum[a][b] += normal[a] * normal[b] / area;
      }
    }
    total += area;
  }
  const SymmetricEigen<4> eigen = EigenOf<4>(sum);
  for (std::size_t k = 0; k < 4; ++k)
  {
    if (eigen.Values[k] > NormalShare * total)
    {
      this->Normals.push_back(eigen.Vectors[k]);
    }
  }
}

/** Removes what a direction has of the normals, unless tolerated, and time on a flat end. */
void PentatopeSmoother::Project(Point<4>& direction) const
{
  for (std::size_t k = 0; k < this->Normals.size() && this->Tolerance == 0.0; ++k)
  {
    const double part = Dot(direction, this->Normals[k]);
    for (std::size_t a = 0; a < 4; ++a)
    {
      direction[a] -= part * this->Normals[k][a];
    }
  }
  if (this->IsOnInterface && this->Limits.IsOnEnd(this->Start))
  {
    direction[3] = 0.0;
  }
}

/** By forward differences. */
Point<4> PentatopeSmoother::GradientOfWorst(std::uint32_t v, double step) const
{
  const Around& worst = this->Star.front();
  Point<4> gradient;
  for (std::size_t a = 0; a < 4; ++a)
  {
    Point<4> p = this->Target.PointOf(v);
    p[a] += step;
    gradient[a] = ShapeOf(this->PointsWith(worst, p)).Quality - worst.Quality;
  }
  return gradient;
}

bool PentatopeSmoother::MayMoveTo(std::uint32_t v, const Point<4>& p) const
{
  if (!this->IsOnInterface)
  {
    return true;
  }
  const Point<4> moved = Subtract(p, this->Originals[v]);
  const double farthest = LongestMove * this->ShortestEdge;
  const bool isTolerated = this->Tolerance == 0.0 ||
    std::all_of(this->Normals.begin(), this->Normals.end(),
      [&](const Point<4>& normal) { return std::abs(Dot(moved, normal)) <= this->Tolerance; });
  return isTolerated && Dot(moved, moved) <= farthest * farthest &&
    this->Limits.Shortening(moved) >= 1.0 && this->Limits.IsNearImage(p);
}

/** Whether all qualities at p are above `floor`, and all bounds are kept. */
bool PentatopeSmoother::Try(const Point<4>& p, double floor)
{
  for (std::size_t s = this->Tried.size(); s < this->Star.size(); ++s)
  {
    if (!(SignedVolume<4>(this->PointsWith(this->Star[s], p).data()) > this->Star[s].Quality))
    {
      return false;
    }
  }
  for (std::size_t s = 0; s < this->Tried.size(); ++s)
  {
    const PentatopeShape shape = ShapeOf(this->PointsWith(this->Star[s], p));
    if (!(shape.Quality > floor) || !this->Allows(this->Star[s], shape))
    {
      // What fails at one point is likely to fail at the next one.
      std::swap(this->Star[s], this->Star[std::min<std::size_t>(s, 1)]);
      return false;
    }
    this->Tried[s] = shape.Quality;
  }
  return true;
}

bool PentatopeSmoother::Allows(Around& one, const PentatopeShape& shape) const
{
  if (this->Target.Allows(shape, 0.0, one.Label))
  {
    return true;
  }
  if (one.OldRatio < 0.0)
  {
    one.OldRatio = ShapeOf(this->PointsWith(one, this->Start)).Ratio;
  }
  return this->Target.Allows(shape, one.OldRatio, one.Label);
}

std::array<const Point<4>*, 5> PentatopeSmoother::PointsWith(
  const Around& one, const Point<4>& p) const
{
  std::array<const Point<4>*, 5> points = this->Target.PointsOf(this->Target.CornersOf(one.Id));
  points[one.Place] = &p;
  return points;
}

} // namespace voxplex

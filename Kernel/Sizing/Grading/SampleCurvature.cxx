// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/Grading/SampleCurvature.h"

#include "Base/MixBits.h"
#include "Geometry/SymmetricEigen.h"
#include "Sizing/Grading/PointBounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace voxplex
{

namespace
{

/** Each level has about a quarter of the points of the one before, twice as far apart. */
constexpr std::size_t PointsOfNext = 4;

/** Largest radius that a level serves, in spacings of the level: about 450 points. */
constexpr double LargestRadius = 12.0;

/** Fewer points are not enough to tell a bend from a plane. */
constexpr std::size_t FewestPoints = 8;

/** Levels with fewer points than this are not made. */
constexpr std::size_t SmallestLevel = 256;

/** Edge of a cell, in spacings of its level. */
constexpr double CellSpacings = 2.0;

/** Whether the k-th point belongs to the next level; pseudo-random. */
bool IsOfNext(std::uint64_t k)
{
  return MixBits(k + 1) % PointsOfNext == 0;
}

/** The number of points, their centre, and their covariance. */
class Moments
{
public:
  void Add(const Point<3>& p)
  {
    ++this->Points;
    for (std::size_t a = 0; a < 3; ++a)
    {
      this->Sum[a] += p[a];
      for (std::size_t b = 0; b <= a; ++b)
      {
        this->Products[a][b] += p[a] * p[b];
      }
    }
  }

  std::size_t Count() const { return this->Points; }

  /** The curvature of a sphere with such points, without the roughness. */
  double Curvature(double roughness) const
  {
    const double weight = 1.0 / static_cast<double>(this->Points);
    std::array<Point<3>, 3> covariance;
    double trace = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      for (std::size_t b = 0; b <= a; ++b)
      {
        covariance[a][b] = covariance[b][a] =
          weight * (this->Products[a][b] - weight * this->Sum[a] * this->Sum[b]);
      }
      trace += covariance[a][a];
    }
    const double smallest = SmallestEigenvalue<3>(covariance);
    const double along = trace - std::max(smallest, 0.0); // r^2 / 2
    const double bend = std::max(smallest - roughness * roughness, 0.0);
    return along > 0.0 ? std::sqrt(12.0 * bend) / along : 0.0;
  }

private:
  std::size_t Points = 0;
  Point<3> Sum{};
  std::array<Point<3>, 3> Products{}; ///< the lower half
};

} // namespace

//------------------------------------------------------------------------------------------------
SampleCurvature::Level::Level(const std::vector<Member>& members, const Box<3>& bounds, double cell)
  : Grid(bounds, CellEdge(bounds, cell))
  , First(CountCells(this->Grid.Cells) + 1)
  , Members(members.size())
{
  for (const Member& member : members)
  {
    ++this->First[this->Grid.CellOf(member.Position) + 1];
  }
  std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
  std::vector<std::uint32_t> next = this->First;
  for (const Member& member : members)
  {
    this->Members[next[this->Grid.CellOf(member.Position)]++] = member;
  }
}

//------------------------------------------------------------------------------------------------
SampleCurvature::SampleCurvature(
  const std::vector<Point<3>>& points, const std::vector<Labels>& labels, double spacing)
  : Spacing(spacing)
{
  const Box<3> bounds = BoundsOf(points);
  std::vector<Member> members;
  members.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    members.push_back({ points[k], labels[k] });
  }
  do
  {
    this->Levels.emplace_back(members, bounds, CellSpacings * spacing);
    std::vector<Member> some;
    for (std::size_t k = 0; k < members.size(); ++k)
    {
      if (IsOfNext(k))
      {
        some.push_back(members[k]);
      }
    }
    members = std::move(some);
    spacing *= 2.0;
  } while (members.size() >= SmallestLevel);
}

//------------------------------------------------------------------------------------------------
double SampleCurvature::At(
  const Point<3>& p, const Labels& labels, double radius, double roughness) const
{
  std::size_t number = 0;
  for (double largest = LargestRadius * this->Spacing;
       radius > largest && number + 1 < this->Levels.size(); largest *= 2.0)
  {
    ++number;
  }
  const Level& level = this->Levels[number];
  std::array<std::size_t, 3> low;
  std::array<std::size_t, 3> high;
  for (std::size_t a = 0; a < 3; ++a)
  {
    low[a] = level.Grid.CellAlong(a, p[a] - radius);
    high[a] = level.Grid.CellAlong(a, p[a] + radius);
  }
  Moments moments;
  for (std::size_t z = low[2]; z <= high[2]; ++z)
  {
    for (std::size_t y = low[1]; y <= high[1]; ++y)
    {
      const std::size_t row = OffsetOf({ 0, y, z }, level.Grid.Cells);
      for (std::size_t k = level.First[row + low[0]]; k < level.First[row + high[0] + 1]; ++k)
      {
        const Point<3> offset = Subtract(level.Members[k].Position, p);
        if (Dot(offset, offset) <= radius * radius && level.Members[k].Of == labels)
        {
          moments.Add(offset);
        }
      }
    }
  }
  return moments.Count() < FewestPoints ? 0.0 : moments.Curvature(roughness);
}

} // namespace voxplex

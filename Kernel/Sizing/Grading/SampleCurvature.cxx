// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/Grading/SampleCurvature.h"

#include "Base/GridIndex.h"
#include "Base/MixBits.h"
#include "Geometry/SymmetricEigen.h"
#include "Sizing/Grading/PointBounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

/** Each level has about this part of the points of the one before, twice as far apart. */
template <int D>
constexpr std::size_t PointsOfNext = D == 3 ? 4 : 8;

/** Largest radius that a level serves, in spacings of the level: about 450 points. */
template <int D>
constexpr double LargestRadius = D == 3 ? 12.0 : 4.75;

/** Fewer points are not enough to tell a bend from a plane. */
template <int D>
constexpr std::size_t FewestPoints = D == 3 ? 8 : 10;

/** Levels with fewer points than this are not made. */
constexpr std::size_t SmallestLevel = 256;

/** Edge of a cell, in spacings of its level. */
constexpr double CellSpacings = 2.0;

/** Whether the k-th point belongs to the next level; pseudo-random. */
template <int D>
bool IsOfNext(std::uint64_t k)
{
  return MixBits(k + 1) % PointsOfNext<D> == 0;
}

/** The number of points, their centre, and their covariance. */
template <int D>
class Moments
{
public:
  void Add(const Point<D>& p)
  {
    ++this->Points;
    for (std::size_t a = 0; a < D; ++a)
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
    std::array<Point<D>, static_cast<std::size_t>(D)> covariance;
    double trace = 0.0;
    for (std::size_t a = 0; a < D; ++a)
    {
      for (std::size_t b = 0; b <= a; ++b)
      {
        covariance[a][b] = covariance[b][a] =
          weight * (this->Products[a][b] - weight * this->Sum[a] * this->Sum[b]);
      }
      trace += covariance[a][a];
    }
    double smallest = SmallestEigenvalue<D>(covariance);
    if (D == 4) // a plane fits few points too well
    {
      smallest *= static_cast<double>(this->Points) / static_cast<double>(this->Points - D);
    }
    const double along = trace - std::max(smallest, 0.0); // r^2 / 2; in 4D 3 r^2 / 5
    const double bend = std::max(smallest - roughness * roughness, 0.0);
    constexpr double Factor = (D - 1) * (D + 3);
    return along > 0.0 ? std::sqrt(Factor * bend) / along : 0.0;
  }

private:
  std::size_t Points = 0;
  Point<D> Sum{};
  std::array<Point<D>, static_cast<std::size_t>(D)> Products{}; ///< the lower half
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
SampleCurvature<D>::Level::Level(
  const std::vector<Member>& members, const Box<D>& bounds, double cell)
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
template <int D>
SampleCurvature<D>::SampleCurvature(
  const std::vector<Point<D>>& points, const std::vector<Labels>& labels, double spacing)
  : Spacing(spacing)
{
  const Box<D> bounds = BoundsOf<D>(points);
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
      if (IsOfNext<D>(k))
      {
        some.push_back(members[k]);
      }
    }
    members = std::move(some);
    spacing *= 2.0;
  } while (members.size() >= SmallestLevel);
}

//------------------------------------------------------------------------------------------------
template <int D>
double SampleCurvature<D>::At(
  const Point<D>& p, const Labels& labels, double radius, double roughness, double unknown) const
{
  std::size_t number = 0;
  for (double largest = LargestRadius<D> * this->Spacing;
       radius > largest && number + 1 < this->Levels.size(); largest *= 2.0)
  {
    ++number;
  }
  const Level& level = this->Levels[number];
  std::array<std::int64_t, static_cast<std::size_t>(D)> low;
  std::array<std::int64_t, static_cast<std::size_t>(D)> high;
  for (std::size_t a = 0; a < D; ++a)
  {
    low[a] = static_cast<std::int64_t>(level.Grid.CellAlong(a, p[a] - radius));
    high[a] = static_cast<std::int64_t>(level.Grid.CellAlong(a, p[a] + radius));
  }
  const auto width = static_cast<std::size_t>(high[0] - low[0] + 1);
  high[0] = low[0]; // the first cells of rows
  const Point<D> centre = p;
  const Labels own = labels;
  const double radius2 = radius * radius;
  Moments<D> moments;
  ForEachIndex(low, high,
    [&](const auto& index)
    {
      typename CellGrid<D>::Index cell;
      std::copy(index.begin(), index.end(), cell.begin());
      const std::size_t first = OffsetOf(cell, level.Grid.Cells);
      const std::span<const Member> row(level.Members.data() + level.First[first],
        level.First[first + width] - level.First[first]);
      Moments<D> sums = moments; // a copy stays in registers
      for (const Member& member : row)
      {
        const Point<D> offset = Subtract(member.Position, centre);
        if (Dot(offset, offset) <= radius2 && member.Of == own)
        {
          sums.Add(offset);
        }
      }
      moments = sums;
    });
  return moments.Count() < FewestPoints<D> ? unknown : moments.Curvature(roughness);
}

template class SampleCurvature<3>;
template class SampleCurvature<4>;

} // namespace voxplex

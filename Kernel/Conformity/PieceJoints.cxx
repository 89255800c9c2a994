// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/PieceJoints.h"

#include "Base/GridIndex.h"
#include "Conformity/ChangeRules.h"
#include "Geometry/SimplexQuality.h"
#include "Mesh/LabelledTriangulation.h"
#include "Mesh/SimplexLabels.h"
#include "Parallel/ParallelFor.h"
#include "Quality/ComponentPieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

namespace voxplex
{

namespace
{

/** A search from a piece ends after this number of simplices, and of ways that are not allowed. */
constexpr std::size_t MostLookedAt = 20000;
constexpr unsigned MostWays = 32;

/** Around a gap, faces are sampled within this many longest edges of the simplices there. */
constexpr double GapRadius = 0.5;

//------------------------------------------------------------------------------------------------
template <int D>
class PieceJoiner
{
public:
  using Index = typename GridGeometry<D>::Index;

  PieceJoiner(const Triangulation<D>& triangulation, std::span<LabelId> labels,
    const ManifoldRepairOptions<D>& options, const std::stop_token& stop)
    : Mesh(triangulation)
    , Labels(labels)
    , Of(*options.Kept)
    , Before(labels.begin(), labels.end())
    , Near(triangulation, labels, Before)
    , Rules(this->Near, labels, options)
    , Pieces(LabelledTriangulation<D>(triangulation, labels),
        FindPieces<D>(LabelledTriangulation<D>(triangulation, labels), stop), Of.All, Of.Image,
        stop)
    , Joined(this->Pieces.All().size())
    , Stop(stop)
  {
  }

  JoinedPieces<D> Join()
  {
    std::vector<std::uint32_t> largest(this->Of.All.All().size(), None); // piece, by component
    for (std::uint32_t p = 0; p < this->Pieces.All().size(); ++p)
    {
      const auto& piece = this->Pieces.All()[p];
      if (piece.Component != None && this->Of.Wanted[piece.Component])
      {
        std::uint32_t& best = largest[piece.Component];
        best = best == None || piece.Volume > this->Pieces.All()[best].Volume ? p : best;
      }
    }
    std::vector<std::vector<SimplexId>> simplices(this->Pieces.All().size()); // of smaller pieces
    std::vector<std::uint32_t> smaller;
    for (std::size_t s = 0; s < this->Labels.size(); ++s)
    {
      const std::uint32_t p = this->Pieces.Of(s);
      const std::uint32_t c = p == None ? None : this->Pieces.All()[p].Component;
      if (c != None && largest[c] != None && largest[c] != p)
      {
        if (simplices[p].empty())
        {
          smaller.push_back(p);
        }
        simplices[p].push_back(static_cast<SimplexId>(s));
      }
    }
    for (const std::uint32_t p : smaller)
    {
      ThrowIfStopped(this->Stop);
      this->JoinPiece(p, simplices[p]);
    }
    std::sort(this->Result.Relabelled.begin(), this->Result.Relabelled.end());
    return std::move(this->Result);
  }

private:
  void JoinPiece(std::uint32_t p, const std::vector<SimplexId>& of)
  {
    const LabelId label = this->Pieces.All()[p].Label;
    std::vector<SimplexId> way;
    std::uint32_t other = None;
    unsigned ways = 0;
    this->ForEachWay(p, of, true,
      [&](std::vector<SimplexId> next, std::uint32_t to)
      {
        const repair::Change change{ std::move(next), label };
        if (change.Cells.empty() || (!this->Rules.Dents(change) && this->Rules.IsAllowed(change)))
        {
          way = change.Cells;
          other = to;
          return true;
        }
        return ++ways == MostWays;
      });
    if (other != None)
    {
      for (const SimplexId s : way)
      {
        this->Labels[s] = label;
        this->Pieces.Move(s, p);
        this->Result.Relabelled.push_back(s);
      }
      this->Joined.Join(p, other);
      return;
    }
    this->ForEachWay(p, of, false,
      [&](std::vector<SimplexId> next, std::uint32_t)
      {
        way = std::move(next);
        return true;
      });
    if (this->Pieces.All()[p].Volume >= this->Of.SmallestGap)
    {
      this->AddGap(this->Pieces.All()[p].Component, way.empty() ? of : way);
    }
  }

  /**
   * Finds ways from a piece to others of its component that it is not joined with, the shortest first.
   * @param of the simplices of the piece
   * @param onInterfaces whether ways lead through simplices only that have all vertices on interfaces
   * @param visit visit(way, other piece) tells whether to stop
   */
  template <typename Visit>
  void ForEachWay(
    std::uint32_t p, const std::vector<SimplexId>& of, bool onInterfaces, const Visit& visit)
  {
    const auto& piece = this->Pieces.All()[p];
    std::unordered_map<SimplexId, SimplexId> comesFrom;
    std::vector<SimplexId> front;
    for (const SimplexId s : of)
    {
      if (this->Labels[s] == piece.Label)
      {
        comesFrom.emplace(s, None);
        front.push_back(s);
      }
    }
    for (std::size_t k = 0; k < front.size() && k < of.size() + MostLookedAt; ++k)
    {
      for (const SimplexId next : this->Mesh.GetSimplex(front[k]).N)
      {
        if (next == None || comesFrom.contains(next))
        {
          continue;
        }
        if (this->Labels[next] == piece.Label)
        {
          const std::uint32_t other = this->Pieces.Of(next);
          if (this->Pieces.All()[other].Component == piece.Component &&
            this->Joined.Find(other) != this->Joined.Find(p))
          {
            std::vector<SimplexId> way;
            for (SimplexId s = front[k]; comesFrom.at(s) != None; s = comesFrom.at(s))
            {
              way.push_back(s);
            }
            if (visit(std::move(way), other))
            {
              return;
            }
          }
        }
        else if ((!onInterfaces || this->IsOnInterfaces(next)) &&
          this->Passes(piece.Component, next))
        {
          comesFrom.emplace(next, front[k]);
          front.push_back(next);
        }
      }
    }
  }

  bool IsOnInterfaces(SimplexId s) const
  {
    const auto& v = this->Mesh.GetSimplex(s).V;
    return std::all_of(
      v.begin(), v.end(), [this](VertexId x) { return this->Near.IsOnInterface(x); });
  }

  void AddGap(std::uint32_t component, const std::vector<SimplexId>& way)
  {
    for (const SimplexId s : way)
    {
      const auto points = this->PointsOf(s);
      double longest2 = 0.0;
      for (std::size_t i = 0; i <= D; ++i)
      {
        for (std::size_t j = 0; j < i; ++j)
        {
          longest2 = std::max(longest2, Distance2(points[i], points[j]));
        }
      }
      const double radius =
        std::max(this->Of.Image.Grid().VoxelDiagonal(), GapRadius * std::sqrt(longest2));
      this->Result.Gaps.push_back({ { CentroidOf(points), radius }, component });
    }
  }

  /** Whether a component passes a simplex. */
  bool Passes(std::uint32_t component, SimplexId s) const
  {
    const auto toIndex = [this](const Point<D>& p)
    {
      Point<D> index = this->Of.Image.Grid().ToIndex(p);
      for (std::size_t a = 0; a < D; ++a)
      {
        index[a] -= static_cast<double>(this->Of.Image.CropOrigin()[a]);
      }
      return index;
    };
    std::array<Point<D>, D + 1> points = this->PointsOf(s);
    for (Point<D>& p : points)
    {
      p = toIndex(p);
    }
    const Point<D> centroid = CentroidOf(points);
    const auto isIn = [&](const Point<D>& p)
    {
      Index voxel;
      for (std::size_t a = 0; a < D; ++a)
      {
        voxel[a] = std::llround(p[a]);
      }
      return this->Of.All.At(voxel) == component;
    };
    Index low;
    Index high;
    for (std::size_t a = 0; a < D; ++a)
    {
      const auto [least, most] = std::minmax_element(points.begin(), points.end(),
        [a](const Point<D>& p, const Point<D>& q) { return p[a] < q[a]; });
      low[a] = std::llround(std::ceil((*least)[a]));
      high[a] = std::llround(std::floor((*most)[a]));
    }
    bool passes = isIn(centroid);
    for (std::size_t i = 0; i <= D; ++i)
    {
      Point<D> facet{};
      for (std::size_t a = 0; a < D; ++a)
      {
        facet[a] = centroid[a] + (centroid[a] - points[i][a]) / D;
      }
      passes = passes || isIn(facet);
      for (std::size_t j = 0; j < i; ++j)
      {
        passes = passes || isIn(Interpolate(points[i], points[j], 0.5));
      }
    }
    ForEachIndex(low, high,
      [&](const Index& at)
      { passes = passes || (this->Of.All.At(at) == component && Contains(points, at)); });
    return passes;
  }

  /** Whether the centre of a voxel is in or on a simplex; both in indices. */
  static bool Contains(const std::array<Point<D>, D + 1>& points, const Index& voxel)
  {
    constexpr double Tolerance = 1e-9; // centres may be on facets
    std::array<const Point<D>*, D + 1> corners;
    Point<D> centre;
    for (std::size_t i = 0; i <= D; ++i)
    {
      corners[i] = &points[i];
    }
    for (std::size_t a = 0; a < D; ++a)
    {
      centre[a] = static_cast<double>(voxel[a]);
    }
    const double whole = SignedVolume<D>(corners.data());
    for (std::size_t i = 0; i <= D; ++i)
    {
      auto part = corners;
      part[i] = &centre;
      if (SignedVolume<D>(part.data()) < -Tolerance * whole)
      {
        return false;
      }
    }
    return true;
  }

  std::array<Point<D>, D + 1> PointsOf(SimplexId s) const
  {
    std::array<Point<D>, D + 1> points;
    for (std::size_t i = 0; i <= D; ++i)
    {
      points[i] = this->Mesh.Position(this->Mesh.GetSimplex(s).V[i]);
    }
    return points;
  }

  static Point<D> CentroidOf(const std::array<Point<D>, D + 1>& points)
  {
    Point<D> centroid{};
    for (const Point<D>& p : points)
    {
      for (std::size_t a = 0; a < D; ++a)
      {
        centroid[a] += p[a] / (D + 1);
      }
    }
    return centroid;
  }

  const Triangulation<D>& Mesh;
  const std::span<LabelId> Labels;
  const KeptComponents<D>& Of;
  const SimplexLabels Before;
  const repair::Neighbourhood<D> Near;
  const repair::ChangeRules<D> Rules;
  ComponentPieces<D> Pieces;
  DisjointSets Joined; ///< pieces
  const std::stop_token& Stop;
  JoinedPieces<D> Result;
};

} // namespace

template <int D>
JoinedPieces<D> JoinPieces(const Triangulation<D>& triangulation, std::span<LabelId> labels,
  const ManifoldRepairOptions<D>& options, const std::stop_token& stop)
{
  return PieceJoiner<D>(triangulation, labels, options, stop).Join();
}

template JoinedPieces<3> JoinPieces<3>(const Triangulation<3>&, std::span<LabelId>,
  const ManifoldRepairOptions<3>&, const std::stop_token&);
template JoinedPieces<4> JoinPieces<4>(const Triangulation<4>&, std::span<LabelId>,
  const ManifoldRepairOptions<4>&, const std::stop_token&);

} // namespace voxplex

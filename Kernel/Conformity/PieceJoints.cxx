// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/PieceJoints.h"

#include "Conformity/ChangeRules.h"
#include "Geometry/SimplexQuality.h"
#include "Mesh/LabelledTriangulation.h"
#include "Parallel/ParallelFor.h"
#include "Quality/ComponentPieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

namespace voxplex
{

namespace
{

/**
 * A search from a piece ends after this number of simplices, and of ways that are not allowed. Pieces that
 * may have gaps are worth more.
 */
constexpr std::size_t MostLookedAt = 2000;
constexpr unsigned MostWays = 16;
constexpr unsigned MostWaysOfSmall = 4;

/** Pieces of more simplices keep their label, unless they are smaller than a voxel. */
constexpr std::size_t MostGivenAway = 5;

/** Around a gap, faces are sampled within this many longest edges of the simplices there. */
constexpr double GapRadius = 0.5;

//------------------------------------------------------------------------------------------------
template <int D>
class PieceJoiner
{
public:
  PieceJoiner(const Triangulation<D>& triangulation, std::span<LabelId> labels,
    const ManifoldRepairOptions<D>& options, GapOptions gaps, unsigned threads,
    const std::stop_token& stop)
    : Mesh(triangulation)
    , Labels(labels)
    , Of(*options.Kept)
    , Gaps(gaps)
    , Near(triangulation, labels)
    , Rules(this->Near, labels, options)
    , Pieces(LabelledTriangulation<D>(triangulation, labels), Of.All, Of.Image, PieceShares::OfSome,
        threads, stop)
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
      if (piece.Component != None)
      {
        std::uint32_t& best = largest[piece.Component];
        best = best == None || piece.Size > this->Pieces.All()[best].Size ? p : best;
      }
    }
    std::map<std::uint32_t, Simplices> smaller; // of the other pieces
    for (SimplexId s = 0; s < this->Labels.size(); ++s)
    {
      const std::uint32_t p = this->Pieces.Of(s);
      const std::uint32_t c = p == None ? None : this->Pieces.All()[p].Component;
      if (c != None && largest[c] != p)
      {
        smaller[p].push_back(s);
      }
    }
    for (const auto& [p, simplices] : smaller)
    {
      ThrowIfStopped(this->Stop);
      this->JoinPiece(p, simplices);
    }
    std::sort(this->Result.Relabelled.begin(), this->Result.Relabelled.end());
    return std::move(this->Result);
  }

private:
  using Simplices = std::vector<SimplexId>;

  void JoinPiece(std::uint32_t p, Simplices of)
  {
    const auto& piece = this->Pieces.All()[p];
    std::erase_if(of, [&](SimplexId s) { return this->Labels[s] != piece.Label; });
    const bool isWanted = this->Of.Wanted[piece.Component];
    const double volume = this->Near.VolumeOf(of);
    const bool mayBeGap = isWanted && volume >= this->Gaps.Smallest;
    bool isDone = of.empty();
    if (isWanted && !isDone)
    {
      isDone = this->Connect(p, of, repair::Leeway::Usual, mayBeGap ? MostWays : MostWaysOfSmall);
    }
    if (mayBeGap && !isDone && this->Gaps.AreLast)
    {
      isDone = this->Connect(p, of, repair::Leeway::OffInterfaces, MostWays);
    }
    const bool isSmall =
      volume < this->Of.Image.Grid().VoxelVolume() || (!mayBeGap && of.size() <= MostGivenAway);
    const bool isSampled = mayBeGap && !this->Gaps.AreLast;
    if (isDone || (isSmall && !isSampled && this->GiveAway(of)) || !mayBeGap)
    {
      return;
    }
    Simplices gap = of;
    this->ForEachWay(p, of, false,
      [&](Simplices way)
      {
        gap = std::move(way);
        return true;
      });
    this->AddGap(piece.Component, gap);
  }

  /** Connects a piece along the first way that is allowed. @param most ways that are tried */
  bool Connect(std::uint32_t p, const Simplices& of, repair::Leeway leeway, unsigned most)
  {
    bool isDone = false;
    this->ForEachWay(p, of, leeway == repair::Leeway::Usual,
      [&](Simplices way)
      {
        isDone = this->StaysBeside(this->Pieces.All()[p].Component, way) &&
          this->Give({ std::move(way), this->Pieces.All()[p].Label }, leeway);
        return isDone || --most == 0;
      });
    return isDone;
  }

  /** Gives a piece the label beside it with the largest common area that is allowed, if there is one. */
  bool GiveAway(const Simplices& of)
  {
    std::map<LabelId, double> areas;
    for (const SimplexId s : of)
    {
      for (unsigned i = 0; i <= D; ++i)
      {
        const LabelId beside = this->Near.LabelBeside(s, i);
        if (beside != this->Labels[s])
        {
          areas[beside] +=
            FacetMeasure(this->Mesh.Points(repair::FacetOf<D>(this->Mesh.GetSimplex(s).V, i)));
        }
      }
    }
    std::multimap<double, LabelId> sorted;
    for (const auto& [label, area] : areas)
    {
      sorted.emplace(-area, label);
    }
    for (const auto& [area, label] : sorted)
    {
      if (this->Give({ of, label }, repair::Leeway::WholePiece))
      {
        return true;
      }
    }
    return false;
  }

  /** Makes a change if it is allowed. */
  bool Give(const repair::Change& change, repair::Leeway leeway)
  {
    if (this->Rules.Dents(change) || !this->Rules.IsAllowed(change, leeway))
    {
      return false;
    }
    std::uint32_t piece = None; // one of those beside, which are one now
    for (const SimplexId s : change.Cells)
    {
      this->Labels[s] = change.Label;
      this->Result.Relabelled.push_back(s);
      for (const SimplexId n : this->Mesh.GetSimplex(s).N)
      {
        if (change.Label != 0 && n != None && this->Labels[n] == change.Label && !change.Touches(n))
        {
          const std::uint32_t beside = this->Pieces.Of(n);
          if (piece != None)
          {
            this->Joined.Join(piece, beside);
          }
          piece = beside;
        }
      }
    }
    for (const SimplexId s : change.Cells)
    {
      this->Pieces.Move(s, piece);
    }
    return true;
  }

  /**
   * Finds ways from a piece to others of its component that it is not joined with, the shortest first.
   * @param of the simplices of the piece
   * @param onInterfaces whether ways lead through simplices only that have all vertices on interfaces
   * @param visit visit(way) tells whether to stop
   */
  template <typename Visit>
  void ForEachWay(std::uint32_t p, const Simplices& of, bool onInterfaces, const Visit& visit)
  {
    const auto& piece = this->Pieces.All()[p];
    std::unordered_map<SimplexId, SimplexId> comesFrom;
    Simplices front = of;
    for (const SimplexId s : of)
    {
      comesFrom.emplace(s, None);
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
            Simplices way;
            for (SimplexId s = front[k]; comesFrom.at(s) != None; s = comesFrom.at(s))
            {
              way.push_back(s);
            }
            if (visit(std::move(way)))
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

  /** Whether the vertices that a way brings onto interfaces are between voxels of the component and others. */
  bool StaysBeside(std::uint32_t component, const Simplices& way) const
  {
    const auto isBeside = [&](VertexId v)
    {
      const Point<D> at = this->Of.Image.ToCrop(this->Near.Position(v));
      typename GridGeometry<D>::Index low;
      typename GridGeometry<D>::Index high;
      for (std::size_t a = 0; a < D; ++a)
      {
        low[a] = static_cast<std::int64_t>(std::floor(at[a]));
        high[a] = low[a] + 1;
      }
      std::array<bool, 2> has{};
      ForEachIndex(
        low, high, [&](const auto& voxel) { has[this->Of.All.At(voxel) == component] = true; });
      return has[0] && has[1];
    };
    return std::all_of(way.begin(), way.end(),
      [&](SimplexId s)
      {
        const auto& v = this->Mesh.GetSimplex(s).V;
        return std::all_of(v.begin(), v.end(),
          [&](VertexId x) { return this->Near.IsOnInterface(x) || isBeside(x); });
      });
  }

  void AddGap(std::uint32_t component, const Simplices& way)
  {
    for (const SimplexId s : way)
    {
      const auto points = this->Mesh.Points(this->Mesh.GetSimplex(s).V);
      double longest2 = 0.0;
      for (const Point<D>* p : points)
      {
        for (const Point<D>* q : points)
        {
          longest2 = std::max(longest2, Distance2(*p, *q));
        }
      }
      const double radius =
        std::max(this->Of.Image.Grid().VoxelDiagonal(), GapRadius * std::sqrt(longest2));
      this->Result.Gaps.push_back({ { Centroid(points), radius }, component });
    }
  }

  /** Whether voxels of a component have the centroid of a simplex, of a facet of it, or of an edge. */
  bool Passes(std::uint32_t component, SimplexId s) const
  {
    const auto points = this->Mesh.Points(this->Mesh.GetSimplex(s).V);
    const Point<D> centroid = Centroid(points);
    const auto isIn = [&](const Point<D>& p)
    { return this->Of.All.At(this->Of.Image.VoxelAt(p)) == component; };
    bool passes = isIn(centroid);
    for (std::size_t i = 0; i <= D && !passes; ++i)
    {
      passes = isIn(Interpolate(*points[i], centroid, (D + 1.0) / D));
      for (std::size_t j = 0; j < i && !passes; ++j)
      {
        passes = isIn(Interpolate(*points[i], *points[j], 0.5));
      }
    }
    return passes;
  }

  const Triangulation<D>& Mesh;
  const std::span<LabelId> Labels;
  const KeptComponents<D>& Of;
  const GapOptions Gaps;
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
  const ManifoldRepairOptions<D>& options, GapOptions gaps, unsigned threads,
  const std::stop_token& stop)
{
  return PieceJoiner<D>(triangulation, labels, options, gaps, threads, stop).Join();
}

template JoinedPieces<3> JoinPieces<3>(const Triangulation<3>&, std::span<LabelId>,
  const ManifoldRepairOptions<3>&, GapOptions, unsigned, const std::stop_token&);
template JoinedPieces<4> JoinPieces<4>(const Triangulation<4>&, std::span<LabelId>,
  const ManifoldRepairOptions<4>&, GapOptions, unsigned, const std::stop_token&);

} // namespace voxplex

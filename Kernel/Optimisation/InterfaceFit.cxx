// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/InterfaceFit.h"

#include "Geometry/SimplexQuality.h"
#include "Optimisation/MoveLimits.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

/** Mean distance of a quadric from a chord of four points, over the distance at the centroid. */
constexpr double MeanOverCentroid = 4.0 / 5.0;

/** In the second and later rounds, vertices make up for neighbours that had to stay. */
constexpr unsigned Rounds = 3;

/** Jacobi iterations of a round. More of them would fit noise: displacements would alternate between neighbours. */
constexpr unsigned Iterations = 4;

/** The search for an interface goes this far, in longest edges of the facet. */
constexpr double Reach = 0.5;

/** A vertex is moved at most this far, in shortest edges of the facets around it. */
constexpr double LongestMove = 0.25;

/** Shorter steps, in the same edges, are not made. */
constexpr double ShortestStep = 0.005;

/** Targets are raised by at most this factor in a round. */
constexpr double LargestRaise = 1.25;

/** How often a step is halved before it is dropped. */
constexpr unsigned Halvings = 2;

/** Squared circumradii stay below this times the squared size: a little less, for rounding. */
constexpr double BelowSize = 1.0 - 1e-9;

/** Simplices outside of the object keep at least this part of their volume. */
constexpr double VolumeKeptOutside = 0.1;

/** The steps of a fit, and the data that one step passes to the next. */
class Fit
{
public:
  Fit(const Triangulation<4>& triangulation, const Domain<4>& surfaces, const SimplexLabels& labels,
    const FitBounds& bounds, unsigned threads, const std::stop_token& stop)
    : Source(triangulation)
    , Surfaces(surfaces)
    , Labels(labels)
    , Bounds(bounds)
    , Limits(bounds.Image, surfaces, bounds.Planes)
    , Threads(threads)
    , Stop(stop)
  {
  }

  FittedPositions Run()
  {
    this->CopyPositions();
    this->FindTwins();
    this->FindFacets();
    this->FindVertices();
    this->MeasureFacets();
    this->FindSimplices();
    if (this->Bounds.Guard)
    {
      this->AreHolders = this->Bounds.Guard->FindHolders(
        LabelledTriangulation<4>(this->Source, this->Labels), this->Threads, this->Stop);
    }
    for (unsigned round = 0; round < Rounds; ++round)
    {
      this->FindSteps();
      this->DropShortSteps();
      this->KeepShapes();
      this->TakeSteps();
      this->RaiseTargets();
    }
    return { std::move(this->Positions), this->Corners.size() };
  }

private:
  /** A facet between two labels. */
  struct Facet
  {
    std::array<VertexId, 4> V; ///< ordered so that the normal points out of the larger label
    LabelId Inner;             ///< the larger label
    LabelId Outer;
    Point<4> Normal; ///< of unit length
    double Weight;   ///< volume; 0 if no interface was found
    double Target;   ///< mean of the vertices' displacements along the normal
    double Residual;
    double ShortestEdge;
  };

  /** A vertex of a facet. Several threads access different ones. */
  struct Corner
  {
    VertexId Id;
    VertexId Twin;       ///< moves alike; or None
    Point<4> Moved;      ///< the steps of the rounds before
    Point<4> Step;       ///< of this round
    double ShortestEdge; ///< of the facets around it
    bool KeepsTime;
    std::uint8_t Halved; ///< how often the step was halved
    std::uint8_t Mark;   ///< a simplex of this vertex is not good; see KeepShapes()
  };

  template <typename Function>
  void ForChunks(std::size_t iterations, Function&& function)
  {
    ParallelFor(0, iterations, ChunkCounts::Grain, this->Threads, std::forward<Function>(function),
      this->Stop);
  }

  /** Vertices of the last end of a periodic mesh are known by their twins at the first one. */
  VertexId FirstOf(VertexId v) const
  {
    return this->Twins.empty() || this->Twins[v] == None || this->Twins[v] > v ? v : this->Twins[v];
  }

  void FindTwins()
  {
    if (this->Bounds.Twins.empty())
    {
      return;
    }
    this->Twins.assign(this->Source.VertexIdEnd(), None);
    for (const auto& [first, last] : this->Bounds.Twins)
    {
      this->Twins[first] = last;
      this->Twins[last] = first;
    }
  }

  void CopyPositions()
  {
    this->Positions.resize(this->Source.VertexIdEnd());
    this->HasChanged.assign(this->Source.VertexIdEnd(), 0);
    this->ForChunks(this->Positions.size(),
      [this](std::size_t first, std::size_t last)
      {
        for (auto v = static_cast<VertexId>(first); v < last; ++v)
        {
          this->Positions[v] = this->Source.Position(v);
        }
      });
  }

  /** Calls function(s, i) for facet i of each simplex s where the label beyond is smaller. */
  template <typename Function>
  void ForFacetsIn(std::size_t first, std::size_t last, Function&& function) const
  {
    for (auto s = static_cast<SimplexId>(first); s < last; ++s)
    {
      if (this->Labels[s] == 0)
      {
        continue;
      }
      const auto& neighbours = this->Source.GetSimplex(s).N;
      for (unsigned i = 0; i < 5; ++i)
      {
        // A facet without a neighbour lies on the box, on a flat end.
        if (neighbours[i] != None && this->Labels[neighbours[i]] < this->Labels[s])
        {
          function(s, i);
        }
      }
    }
  }

  void FindFacets()
  {
    ChunkCounts counts(this->Labels.size());
    this->ForChunks(this->Labels.size(),
      [&](std::size_t first, std::size_t last)
      {
        std::size_t n = 0;
        this->ForFacetsIn(first, last, [&n](SimplexId, unsigned) { ++n; });
        counts.OfChunk(first) = n;
      });
    this->Facets.resize(counts.TurnIntoPlaces());
    this->ForChunks(this->Labels.size(),
      [&](std::size_t first, std::size_t last)
      {
        std::size_t f = counts.OfChunk(first);
        this->ForFacetsIn(first, last,
          [&](SimplexId s, unsigned i)
          {
            const auto& simplex = this->Source.GetSimplex(s);
            Facet& facet = this->Facets[f++];
            unsigned m = 0;
            for (unsigned k = 0; k < 5; ++k)
            {
              if (k != i)
              {
                facet.V[m++] = simplex.V[k];
              }
            }
            if (i % 2 == 1)
            {
              std::swap(facet.V[0], facet.V[1]);
            }
            facet.Inner = this->Labels[s];
            facet.Outer = this->Labels[simplex.N[i]];
          });
      });
  }

  /** Lists the vertices of facets, and the facets of each vertex. */
  void FindVertices()
  {
    const std::size_t n = 4 * this->Facets.size();
    UninitialisedVector<std::uint64_t> memory(2 * n);
    this->ForChunks(this->Facets.size(),
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t f = first; f < last; ++f)
        {
          for (std::size_t k = 0; k < 4; ++k)
          {
            memory[4 * f + k] = (std::uint64_t{ this->FirstOf(this->Facets[f].V[k]) } << 32) | f;
          }
        }
      });
    const std::span<std::uint64_t> all(memory);
    const std::span<const std::uint64_t> sorted = ParallelRadixSort(
      all.first(n), all.last(n),
      static_cast<unsigned>(std::bit_width(std::uint64_t{ this->Source.VertexIdEnd() })),
      [](std::uint64_t record) { return record >> 32; }, this->Threads, this->Stop);

    this->Ranks.assign(this->Source.VertexIdEnd(), None);
    this->FacetsOf.resize(n);
    for (std::size_t k = 0; k < n; ++k)
    {
      const auto v = static_cast<VertexId>(sorted[k] >> 32);
      if (this->Corners.empty() || this->Corners.back().Id != v)
      {
        const bool keepsTime = this->Limits.KeepsTime(this->Source.Position(v));
        const VertexId twin = this->Twins.empty() ? None : this->Twins[v];
        this->Ranks[v] = static_cast<std::uint32_t>(this->Corners.size());
        if (twin != None)
        {
          this->Ranks[twin] = this->Ranks[v];
        }
        this->Corners.push_back({ v, twin, {}, {}, 0.0, keepsTime, 0, 0 });
        this->FirstFacet.push_back(k);
      }
      this->FacetsOf[k] = static_cast<std::uint32_t>(sorted[k]);
    }
    this->FirstFacet.push_back(n);
  }

  void MeasureFacets()
  {
    this->ForChunks(this->Facets.size(),
      [this](std::size_t first, std::size_t last)
      {
        for (std::size_t f = first; f < last; ++f)
        {
          this->Measure(this->Facets[f]);
        }
      });
  }

  void Measure(Facet& facet) const
  {
    std::array<const Point<4>*, 4> p;
    Point<4> centroid{};
    for (std::size_t k = 0; k < 4; ++k)
    {
      p[k] = &this->Source.Position(facet.V[k]);
      for (std::size_t a = 0; a < 4; ++a)
      {
        centroid[a] += 0.25 * (*p[k])[a];
      }
    }
    facet.Normal = Cross(Subtract(*p[1], *p[0]), Subtract(*p[2], *p[0]), Subtract(*p[3], *p[0]));
    const double length = std::sqrt(Dot(facet.Normal, facet.Normal));
    double shortest2 = Distance2(*p[1], *p[0]);
    double longest2 = shortest2;
    for (const auto& [i, j] : { std::pair{ 2, 0 }, { 3, 0 }, { 2, 1 }, { 3, 1 }, { 3, 2 } })
    {
      const double edge2 =
        Distance2(*p[static_cast<std::size_t>(i)], *p[static_cast<std::size_t>(j)]);
      shortest2 = std::min(shortest2, edge2);
      longest2 = std::max(longest2, edge2);
    }
    facet.ShortestEdge = std::sqrt(shortest2);
    facet.Weight = 0.0;
    facet.Target = 0.0;
    if (!(length > 0.0))
    {
      return;
    }
    for (double& x : facet.Normal)
    {
      x /= length;
    }
    double height = 0.0;
    if (this->FindHeight(facet, centroid, Reach * std::sqrt(longest2), height))
    {
      facet.Weight = length;
      facet.Target = MeanOverCentroid * height;
    }
  }

  /**
   * The distance from a facet's centroid to the interface, along the normal; negative if the
   * interface is on the inner side.
   */
  bool FindHeight(const Facet& facet, const Point<4>& centroid, double reach, double& height) const
  {
    const LabelId label = this->Surfaces.Label(centroid);
    if (label != facet.Inner && label != facet.Outer)
    {
      return false;
    }
    const double sign = label == facet.Inner ? 1.0 : -1.0;
    Point<4> end;
    for (std::size_t a = 0; a < 4; ++a)
    {
      end[a] = centroid[a] + sign * reach * facet.Normal[a];
    }
    Point<4> z;
    if (!this->Surfaces.FirstCrossing(centroid, label, end, z))
    {
      return false;
    }
    height = sign * Distance(centroid, z);
    return true;
  }

  /** Solves for the steps of this round. */
  void FindSteps()
  {
    for (unsigned iteration = 0; iteration < Iterations; ++iteration)
    {
      this->ForChunks(this->Facets.size(),
        [this](std::size_t first, std::size_t last)
        {
          for (std::size_t f = first; f < last; ++f)
          {
            Facet& facet = this->Facets[f];
            double mean = 0.0;
            for (const VertexId v : facet.V)
            {
              const Corner& corner = this->Corners[this->Ranks[v]];
              mean += 0.25 * (Dot(facet.Normal, corner.Moved) + Dot(facet.Normal, corner.Step));
            }
            facet.Residual = this->TargetFactor * facet.Target - mean;
          }
        });
      this->ForChunks(this->Corners.size(),
        [this](std::size_t first, std::size_t last)
        {
          for (std::size_t c = first; c < last; ++c)
          {
            this->MoveByResiduals(c);
          }
        });
    }
  }

  void MoveByResiduals(std::size_t c)
  {
    Corner& corner = this->Corners[c];
    Point<4> sum{};
    double weights = 0.0;
    corner.ShortestEdge = std::numeric_limits<double>::infinity();
    for (std::size_t k = this->FirstFacet[c]; k < this->FirstFacet[c + 1]; ++k)
    {
      const Facet& facet = this->Facets[this->FacetsOf[k]];
      corner.ShortestEdge = std::min(corner.ShortestEdge, facet.ShortestEdge);
      weights += facet.Weight;
      for (std::size_t a = 0; a < 4; ++a)
      {
        sum[a] += facet.Weight * facet.Residual * facet.Normal[a];
      }
    }
    if (weights == 0.0)
    {
      return;
    }
    Point<4> total;
    for (std::size_t a = 0; a < 4; ++a)
    {
      total[a] = corner.Moved[a] + corner.Step[a] + sum[a] / weights;
    }
    total[3] = corner.KeepsTime ? 0.0 : total[3];
    const double length = std::sqrt(Dot(total, total));
    double factor = std::min(1.0, LongestMove * corner.ShortestEdge / length); // inf if length is 0
    factor = std::min(factor, this->Limits.Shortening(total));
    for (std::size_t a = 0; a < 4; ++a)
    {
      corner.Step[a] = factor * total[a] - corner.Moved[a];
    }
  }

  /** Sets the position to which the shortened step leads. */
  void Place(Corner& corner)
  {
    static constexpr std::array<double, Halvings + 2> shares = { 1.0, 0.5, 0.25, 0.0 };
    const Point<4>& p = this->Source.Position(corner.Id);
    for (std::size_t a = 0; a < 4; ++a)
    {
      this->Positions[corner.Id][a] =
        p[a] + (corner.Moved[a] + shares[corner.Halved] * corner.Step[a]);
    }
    if (corner.Twin != None)
    {
      Point<4>& twin = this->Positions[corner.Twin];
      std::copy_n(this->Positions[corner.Id].begin(), 3, twin.begin()); // the time stays
    }
  }

  void SetChanged(const Corner& corner, std::uint8_t changed)
  {
    this->HasChanged[corner.Id] = changed;
    if (corner.Twin != None)
    {
      this->HasChanged[corner.Twin] = changed;
    }
  }

  /** Lists the simplices with a vertex of a facet. */
  void FindSimplices()
  {
    const auto touches = [this](SimplexId s)
    {
      const auto& v = this->Source.GetSimplex(s).V;
      return this->Source.IsAlive(s) &&
        std::any_of(v.begin(), v.end(), [this](VertexId x) { return this->Ranks[x] != None; });
    };
    ChunkCounts counts(this->Labels.size());
    this->ForChunks(this->Labels.size(),
      [&](std::size_t first, std::size_t last)
      {
        std::size_t n = 0;
        for (auto s = static_cast<SimplexId>(first); s < last; ++s)
        {
          n += touches(s) ? 1 : 0;
        }
        counts.OfChunk(first) = n;
      });
    this->Simplices.resize(counts.TurnIntoPlaces());
    this->ForChunks(this->Labels.size(),
      [&](std::size_t first, std::size_t last)
      {
        std::size_t k = counts.OfChunk(first);
        for (auto s = static_cast<SimplexId>(first); s < last; ++s)
        {
          if (touches(s))
          {
            this->Simplices[k++] = s;
          }
        }
      });
  }

  /** Shortens steps until every simplex is good. Each pass shortens at least one. */
  void KeepShapes()
  {
    for (bool areGood = false; !areGood;)
    {
      std::atomic<bool> anyBad{ false };
      this->ForChunks(this->Simplices.size(),
        [&](std::size_t first, std::size_t last)
        {
          for (std::size_t k = first; k < last; ++k)
          {
            const SimplexId s = this->Simplices[k];
            if (this->HasChangedVertex(s) && !this->IsGood(s))
            {
              anyBad.store(true, std::memory_order_relaxed);
              this->MarkCornersOf(s);
            }
          }
        });
      areGood = !anyBad.load(std::memory_order_relaxed);
      for (Corner& corner : this->Corners)
      {
        this->SetChanged(corner, corner.Mark);
        corner.Halved = static_cast<std::uint8_t>(corner.Halved + corner.Mark);
        corner.Mark = 0;
        this->Place(corner);
      }
    }
  }

  /**
   * Vertices that had to stay leave volume behind. Raises the targets, so that the others make up
   * for it.
   */
  void RaiseTargets()
  {
    double wanted = 0.0;
    double reached = 0.0;
    for (const Facet& facet : this->Facets)
    {
      wanted += facet.Weight * facet.Target;
      for (const VertexId v : facet.V)
      {
        reached += facet.Weight * 0.25 * Dot(facet.Normal, this->Corners[this->Ranks[v]].Moved);
      }
    }
    if (wanted * reached > 0.0)
    {
      this->TargetFactor *= std::clamp(wanted / reached, 1.0, LargestRaise);
    }
  }

  void DropShortSteps()
  {
    for (Corner& corner : this->Corners)
    {
      const bool isWorthIt = Dot(corner.Step, corner.Step) >=
        ShortestStep * ShortestStep * corner.ShortestEdge * corner.ShortestEdge;
      this->SetChanged(corner, isWorthIt ? 1 : 0);
      corner.Step = isWorthIt ? corner.Step : Point<4>{};
      corner.Halved = 0;
      this->Place(corner);
      while (corner.Halved <= Halvings && !this->Limits.IsNearImage(this->Positions[corner.Id]))
      {
        ++corner.Halved;
        this->Place(corner);
      }
    }
  }

  void TakeSteps()
  {
    for (Corner& corner : this->Corners)
    {
      corner.Moved = Subtract(this->Positions[corner.Id], this->Source.Position(corner.Id));
      corner.Step = {};
    }
  }

  bool HasChangedVertex(SimplexId s) const
  {
    const auto& v = this->Source.GetSimplex(s).V;
    return std::any_of(v.begin(), v.end(), [this](VertexId x) { return this->HasChanged[x] != 0; });
  }

  void MarkCornersOf(SimplexId s)
  {
    for (const VertexId v : this->Source.GetSimplex(s).V)
    {
      if (this->Ranks[v] != None && this->Corners[this->Ranks[v]].Halved <= Halvings)
      {
        // Relaxed: threads write the same number, and the end of the loop orders it.
        std::atomic_ref<std::uint8_t>(this->Corners[this->Ranks[v]].Mark)
          .store(1, std::memory_order_relaxed);
      }
    }
  }

  /** Whether the moved simplex is positively oriented, and keeps the bounds or gets no worse. */
  bool IsGood(SimplexId s) const
  {
    const auto& v = this->Source.GetSimplex(s).V;
    std::array<const Point<4>*, 5> after;
    std::array<const Point<4>*, 5> before;
    bool hasMoved = false;
    for (std::size_t k = 0; k < 5; ++k)
    {
      after[k] = &this->Positions[v[k]];
      before[k] = &this->Source.Position(v[k]);
      hasMoved |= *after[k] != *before[k];
    }
    if (!hasMoved)
    {
      return true;
    }
    const double volume = SignedVolume<4>(after.data());
    if (this->Labels[s] == 0)
    {
      return volume > VolumeKeptOutside * SignedVolume<4>(before.data());
    }
    if (!(volume > 0.0) ||
      (!this->AreHolders.empty() && this->AreHolders[s] != 0 &&
        !this->Bounds.Guard->Keeps(this->Labels[s], before, after)))
    {
      return false;
    }
    const Circumball<4> ball = CircumballOf(after);
    const double shape = NormalizedVolume<4>(after.data(), ball.Radius2);
    const double ratio = RadiusEdgeRatio<4>(after.data(), ball.Radius2);
    if (shape >= this->Bounds.NormalizedVolume && ratio <= this->Bounds.RadiusEdgeRatio &&
      !this->Bounds.Sizing)
    {
      return true;
    }
    const Circumball<4> ballBefore = CircumballOf(before);
    return shape >= std::min(this->Bounds.NormalizedVolume,
                      NormalizedVolume<4>(before.data(), ballBefore.Radius2)) &&
      ratio <= std::max(this->Bounds.RadiusEdgeRatio,
                 RadiusEdgeRatio<4>(before.data(), ballBefore.Radius2)) &&
      this->HasRightSize(ball, ballBefore, this->Labels[s]);
  }

  /**
   * Whether a simplex of a label is below the element size at its new centre, or, compared with that
   * size, no larger than before. Sizes are asked for where the label is only, as in refinement.
   */
  bool HasRightSize(const Circumball<4>& ball, const Circumball<4>& before, LabelId label) const
  {
    if (!this->Bounds.Sizing)
    {
      return true;
    }
    if (this->Surfaces.Label(ball.Center) != label)
    {
      return false;
    }
    const double size = this->Bounds.Sizing->ElementSize(ball.Center, label);
    if (ball.Radius2 < BelowSize * size * size)
    {
      return true;
    }
    if (this->Surfaces.Label(before.Center) != label)
    {
      return false;
    }
    const double sizeBefore = this->Bounds.Sizing->ElementSize(before.Center, label);
    return ball.Radius2 * sizeBefore * sizeBefore <= before.Radius2 * size * size;
  }

  static Circumball<4> CircumballOf(const std::array<const Point<4>*, 5>& points)
  {
    Circumball<4> ball;
    if (!ComputeCircumball<4>(points.data(), ball))
    {
      ComputeCircumballExactly<4>(points.data(), ball);
    }
    return ball;
  }

  const Triangulation<4>& Source;
  const Domain<4>& Surfaces;
  const SimplexLabels& Labels;
  const FitBounds Bounds;
  const MoveLimits Limits;
  const unsigned Threads;
  const std::stop_token& Stop;
  UninitialisedVector<Facet> Facets;
  std::vector<Corner> Corners;
  double TargetFactor = 1.0;
  UninitialisedVector<SimplexId> Simplices; ///< those with a corner
  std::vector<std::uint8_t> AreHolders;     ///< by simplex id; empty if there are none
  std::vector<std::size_t> FirstFacet;      ///< of each corner, in FacetsOf; and the end
  UninitialisedVector<std::uint32_t> FacetsOf;
  UninitialisedVector<Point<4>> Positions; ///< of each vertex id, with the steps of this round
  std::vector<std::uint8_t> HasChanged;    ///< of each vertex id, since its simplices were checked
  std::vector<std::uint32_t> Ranks;        ///< place in Corners of each vertex id, or None
  std::vector<VertexId> Twins;             ///< of each vertex id, or None; empty if there are none
};

} // namespace

//------------------------------------------------------------------------------------------------
FittedPositions FitInterfaces(const Triangulation<4>& triangulation, const Domain<4>& surfaces,
  const SimplexLabels& labels, const FitBounds& bounds, unsigned threads,
  const std::stop_token& stop)
{
  return Fit(triangulation, surfaces, labels, bounds, threads, stop).Run();
}

} // namespace voxplex

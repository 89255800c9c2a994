// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Fit/InterfaceFit.h"

#include "Geometry/SimplexQuality.h"
#include "Mesh/InterfaceFacets.h"
#include "Optimisation/Fit/FitShapes.h"
#include "Optimisation/Fit/InterfaceOffsets.h"
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

/** Mean distance of a quadric from a chord of D points, over the distance at the centroid. */
template <int D>
constexpr double MeanOverCentroid = D / (D + 1.0);

/**
 * In the second and later rounds, vertices make up for neighbours that had to stay. With two rounds in
 * 4D, a ball of four delta across lacks 14 % of its volume, with three 5 %.
 */
template <int D>
constexpr unsigned Rounds = D == 3 ? 2 : 3;

/** Jacobi iterations of a round. More of them would fit noise: displacements would alternate between neighbours. */
template <int D>
constexpr unsigned Iterations = D == 3 ? 3 : 4;

/** The search for an interface goes this far, in longest edges of the facet. */
constexpr double Reach = 0.5;

/** A vertex is moved at most this far, in shortest edges of the facets around it. */
constexpr double LongestMove = 0.25;

/** Shorter steps, in the same edges, are not made. */
constexpr double ShortestStep = 0.005;

/** How often a step is halved before it is dropped. */
constexpr unsigned Halvings = 1;

/** The steps of a fit, and the data that one step passes to the next. */
template <int D>
class Fit
{
public:
  Fit(Complex<D>& complex, const Domain<D>& surfaces, const FitBounds<D>& bounds, unsigned threads,
    const std::stop_token& stop)
    : Mesh(complex)
    , Originals(complex.Points)
    , Surfaces(surfaces)
    , Bounds(bounds)
    , Limits(bounds.Image, surfaces, bounds.Planes)
    , Shapes(complex, surfaces, bounds, this->Originals)
    , Threads(threads)
    , Stop(stop)
    , HasChanged(complex.Points.size(), 0)
    , Ranks(complex.Points.size(), None)
  {
  }

  /** @return the number of vertices of interfaces */
  std::uint64_t Run()
  {
    this->FindFacets();
    this->FindVertices();
    this->MeasureFacets();
    this->FindInterfaces();
    for (unsigned round = 0; round < Rounds<D>; ++round)
    {
      for (unsigned iteration = 0; iteration < Iterations<D>; ++iteration)
      {
        this->BalanceVolumes();
        this->FindSteps();
      }
      this->DropShortSteps();
      this->KeepShapes();
      this->TakeSteps();
    }
    return this->Moving.size();
  }

private:
  /** A facet between two labels. What vertices ask for comes first. */
  struct Facet
  {
    Point<D> Normal; ///< of unit length
    double Weight;   ///< the area; 0 if no interface was found
    double Residual; ///< what the target is missing, without the offset
    double ShortestEdge;
    std::uint32_t Interface; ///< its number in Offsets
    LabelId Inner;           ///< the larger label
    LabelId Outer;
    typename Complex<D>::Facet V; ///< ordered so that the normal points out of the larger label
    double Area;
    double Target;   ///< mean of the vertices' displacements along the normal
    double Centroid; ///< before all steps, along the normal
    double Gain;     ///< volume that the inner label gains here
  };

  /** A vertex of a facet. Several threads access different ones. */
  struct Corner
  {
    std::uint32_t Id;
    std::uint32_t Twin;  ///< moves alike; or None
    Point<D> Moved;      ///< the steps of the rounds before
    Point<D> Step;       ///< of this round
    double ShortestEdge; ///< of the facets around it
    unsigned Held;       ///< MoveLimits::HeldAt()
    std::uint8_t Halved; ///< how often the step was halved
    std::uint8_t Mark;   ///< a simplex of this vertex is not good; see KeepShapes()
  };

  template <typename Function>
  void ForChunks(std::size_t iterations, Function&& function)
  {
    ParallelFor(0, iterations, ChunkCounts::Grain, this->Threads, std::forward<Function>(function),
      this->Stop);
  }

  template <typename Function>
  void ForFacets(Function&& function)
  {
    this->ForChunks(this->Facets.size(),
      [&](std::size_t first, std::size_t last)
      {
        std::for_each(this->Facets.begin() + static_cast<std::ptrdiff_t>(first),
          this->Facets.begin() + static_cast<std::ptrdiff_t>(last), function);
      });
  }

  /** Vertices of the last end of a periodic mesh are known by their twins at the first one. */
  std::uint32_t FirstOf(std::uint32_t v) const
  {
    return std::min(v, this->Mesh.TwinOf(v)); // None is the largest number
  }

  /** A facet beyond which there is nothing lies on the box, on a flat end. */
  void FindFacets()
  {
    ListInterfaces(
      this->Mesh.Labels, [this](std::uint32_t s) -> const auto& { return this->Mesh.Cells[s].N; },
      BeyondEnd::Nothing, [this](std::size_t number) { this->Facets.resize(number); },
      [this](std::size_t place, std::uint32_t s, unsigned i, LabelId beside)
      {
        Facet& facet = this->Facets[place];
        facet.V = OutwardFacet(this->Mesh.Cells[s].V, i);
        facet.Inner = this->Mesh.Labels[s];
        facet.Outer = beside;
      },
      this->Threads, this->Stop);
  }

  /** Lists the vertices of facets, and the facets of each vertex. */
  void FindVertices()
  {
    const std::size_t n = D * this->Facets.size();
    UninitialisedVector<std::uint64_t> memory(2 * n);
    this->ForChunks(this->Facets.size(),
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t f = first; f < last; ++f)
        {
          for (std::size_t k = 0; k < D; ++k)
          {
            memory[D * f + k] = (std::uint64_t{ this->FirstOf(this->Facets[f].V[k]) } << 32) | f;
          }
        }
      });
    const std::span<std::uint64_t> all(memory);
    const std::span<const std::uint64_t> sorted = ParallelRadixSort(
      all.first(n), all.last(n),
      static_cast<unsigned>(std::bit_width(std::uint64_t{ this->Mesh.Points.size() })),
      [](std::uint64_t record) { return record >> 32; }, this->Threads, this->Stop);

    this->FacetsOf.resize(n);
    for (std::size_t k = 0; k < n; ++k)
    {
      const auto v = static_cast<std::uint32_t>(sorted[k] >> 32);
      if (this->Moving.empty() || this->Moving.back().Id != v)
      {
        const unsigned held = this->Limits.HeldAt(this->Originals[v]);
        const std::uint32_t twin = this->Mesh.TwinOf(v);
        this->Ranks[v] = static_cast<std::uint32_t>(this->Moving.size());
        if (twin != None)
        {
          this->Ranks[twin] = this->Ranks[v];
        }
        this->Moving.push_back({ v, twin, {}, {}, 0.0, held, 0, 0 });
        this->FirstFacet.push_back(k);
      }
      this->FacetsOf[k] = static_cast<std::uint32_t>(sorted[k]);
    }
    this->FirstFacet.push_back(n);
  }

  void MeasureFacets()
  {
    this->ForFacets([this](Facet& facet) { this->Measure(facet); });
  }

  void Measure(Facet& facet) const
  {
    std::array<Point<D>, static_cast<std::size_t>(D)> p;
    Point<D> centroid{};
    double shortest2 = std::numeric_limits<double>::infinity();
    double longest2 = 0.0;
    for (std::size_t k = 0; k < D; ++k)
    {
      p[k] = this->Originals[facet.V[k]];
      for (std::size_t a = 0; a < D; ++a)
      {
        centroid[a] += p[k][a] / D;
      }
      for (std::size_t i = 0; i < k; ++i)
      {
        const double edge2 = Distance2(p[i], p[k]);
        shortest2 = std::min(shortest2, edge2);
        longest2 = std::max(longest2, edge2);
      }
    }
    facet.Normal = FacetNormal(p);
    const double length = std::sqrt(Dot(facet.Normal, facet.Normal));
    facet.ShortestEdge = std::sqrt(shortest2);
    facet.Area = length / (D == 3 ? 2.0 : 6.0);
    facet.Weight = 0.0;
    facet.Target = 0.0;
    facet.Centroid = 0.0;
    if (!(length > 0.0))
    {
      return;
    }
    for (double& x : facet.Normal)
    {
      x /= length;
    }
    facet.Centroid = Dot(facet.Normal, centroid);
    double height = 0.0;
    if (this->FindHeight(facet, centroid, Reach * std::sqrt(longest2), height))
    {
      facet.Weight = facet.Area;
      facet.Target = MeanOverCentroid<D> * height;
    }
  }

  /**
   * The distance from a facet's centroid to the interface, along the normal; negative if the
   * interface is on the inner side.
   */
  bool FindHeight(const Facet& facet, const Point<D>& centroid, double reach, double& height) const
  {
    const LabelId label = this->Surfaces.Label(centroid);
    if (label != facet.Inner && label != facet.Outer)
    {
      return false;
    }
    const double sign = label == facet.Inner ? 1.0 : -1.0;
    Point<D> end;
    for (std::size_t a = 0; a < D; ++a)
    {
      end[a] = centroid[a] + sign * reach * facet.Normal[a];
    }
    Point<D> z;
    if (!this->Surfaces.FirstCrossing(centroid, label, end, z))
    {
      return false;
    }
    height = sign * Distance(centroid, z);
    return true;
  }

  /**
   * Finds the interfaces, and the volumes that labels are to gain: what they are to have more than the
   * mesh, or, if volumes are not given, what the targets promise.
   */
  void FindInterfaces()
  {
    for (Facet& facet : this->Facets)
    {
      facet.Interface =
        this->Offsets.Add(facet.Inner, facet.Outer, facet.Weight, facet.ShortestEdge);
      facet.Gain = facet.Weight * facet.Target;
      facet.Residual = facet.Target;
    }
    if (this->Bounds.Volumes.empty())
    {
      this->Wanted.assign(this->Offsets.NumberOfLabels(), 0.0);
      this->AddGains(this->Wanted, 1.0);
      return;
    }
    this->Wanted.assign(this->Bounds.Volumes.begin(), this->Bounds.Volumes.end());
    for (const Facet& facet : this->Facets)
    {
      const double volume = facet.Area * facet.Centroid / D; // divergence theorem
      this->Wanted[facet.Inner] -= volume;
      this->Wanted[facet.Outer] += volume;
    }
  }

  /** Adds the gains at all facets, times a factor, to the volumes of labels. */
  void AddGains(std::vector<double>& volumes, double factor) const
  {
    for (const Facet& facet : this->Facets)
    {
      volumes[facet.Inner] += factor * facet.Gain;
      volumes[facet.Outer] -= factor * facet.Gain;
    }
  }

  /**
   * Moves interfaces as a whole, so that labels gain what is missing: at first, of what the targets
   * promise; then, of what steps have reached.
   */
  void BalanceVolumes()
  {
    if (this->HasSteps)
    {
      this->MeasureGains();
    }
    this->HasSteps = true;
    std::vector<double> missing = this->Wanted;
    this->AddGains(missing, -1.0);
    this->Offsets.Share(std::move(missing));
  }

  /** Finds what facets have gained, and what they are missing. */
  void MeasureGains()
  {
    this->ForFacets([this](Facet& facet) { this->MeasureGain(facet); });
  }

  void MeasureGain(Facet& facet) const
  {
    std::array<Point<D>, static_cast<std::size_t>(D)> p;
    double centroid = 0.0;
    for (std::size_t k = 0; k < D; ++k)
    {
      p[k] = this->Mesh.Points[facet.V[k]];
      centroid += Dot(facet.Normal, p[k]) / D;
    }
    const double step = centroid - facet.Centroid;
    facet.Residual = facet.Target - step;
    facet.Gain = facet.Weight * step;
    if constexpr (D == 3) // exactly, once all facets of a label are summed (divergence theorem)
    {
      facet.Gain = (0.5 * Dot(FacetNormal(p), p[0]) - facet.Area * facet.Centroid) / D;
    }
  }

  /** Solves for the steps of this round. */
  void FindSteps()
  {
    this->ForChunks(this->Moving.size(),
      [this](std::size_t first, std::size_t last)
      {
        for (std::size_t c = first; c < last; ++c)
        {
          this->MoveByResiduals(c);
          this->Place(this->Moving[c]);
        }
      });
  }

  void MoveByResiduals(std::size_t c)
  {
    Corner& corner = this->Moving[c];
    Point<D> sum{};
    double weights = 0.0;
    corner.ShortestEdge = std::numeric_limits<double>::infinity();
    for (std::size_t k = this->FirstFacet[c]; k < this->FirstFacet[c + 1]; ++k)
    {
      const Facet& facet = this->Facets[this->FacetsOf[k]];
      corner.ShortestEdge = std::min(corner.ShortestEdge, facet.ShortestEdge);
      weights += facet.Weight;
      const double pull = facet.Weight * (facet.Residual + this->Offsets[facet.Interface]);
      for (std::size_t a = 0; a < D; ++a)
      {
        sum[a] += pull * facet.Normal[a];
      }
    }
    if (weights == 0.0)
    {
      return;
    }
    Point<D> total;
    for (std::size_t a = 0; a < D; ++a)
    {
      total[a] = corner.Moved[a] + corner.Step[a] + sum[a] / weights;
    }
    total = this->Limits.Hold(this->Originals[corner.Id], total, corner.Held);
    const double length = std::sqrt(Dot(total, total));
    double factor = std::min(1.0, LongestMove * corner.ShortestEdge / length); // inf if length is 0
    factor = std::min(factor, this->Limits.Shortening(total));
    for (std::size_t a = 0; a < D; ++a)
    {
      corner.Step[a] = factor * total[a] - corner.Moved[a];
    }
  }

  /** Sets the position to which the shortened step leads. */
  void Place(Corner& corner)
  {
    static constexpr std::array<double, Halvings + 2> shares = { 1.0, 0.5, 0.0 };
    const Point<D>& p = this->Originals[corner.Id];
    for (std::size_t a = 0; a < D; ++a)
    {
      this->Mesh.Points[corner.Id][a] =
        p[a] + (corner.Moved[a] + shares[corner.Halved] * corner.Step[a]);
    }
    if (corner.Twin != None)
    {
      Point<D>& twin = this->Mesh.Points[corner.Twin];
      std::copy_n(this->Mesh.Points[corner.Id].begin(), D - 1, twin.begin()); // the time stays
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

  template <typename Function>
  void ForCorners(Function&& function)
  {
    this->ForChunks(this->Moving.size(),
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t c = first; c < last; ++c)
        {
          function(this->Moving[c]);
        }
      });
  }

  /** Shortens steps until every cell is good. Each pass shortens at least one. */
  void KeepShapes()
  {
    for (bool areGood = false; !areGood;)
    {
      std::atomic<bool> anyBad{ false };
      this->ForChunks(this->Mesh.Cells.size(),
        [&](std::size_t first, std::size_t last)
        {
          for (auto s = static_cast<std::uint32_t>(first); s < last; ++s)
          {
            if (this->HasChangedVertex(this->Mesh.Cells[s].V) && !this->Shapes.IsGood(s))
            {
              anyBad.store(true, std::memory_order_relaxed);
              this->MarkCornersOf(this->Mesh.Cells[s].V);
            }
          }
        });
      if constexpr (D == 3)
      {
        this->ForFacets(
          [&](const Facet& facet)
          {
            if (this->HasChangedVertex(facet.V) && !this->Shapes.HasGoodAngles(facet.V))
            {
              anyBad.store(true, std::memory_order_relaxed);
              this->MarkCornersOf(facet.V);
            }
          });
      }
      areGood = !anyBad.load(std::memory_order_relaxed);
      this->ForCorners(
        [this](Corner& corner)
        {
          this->SetChanged(corner, corner.Mark);
          corner.Halved = static_cast<std::uint8_t>(corner.Halved + corner.Mark);
          corner.Mark = 0;
          this->Place(corner);
        });
    }
  }

  void DropShortSteps()
  {
    this->ForCorners(
      [this](Corner& corner)
      {
        const bool isWorthIt = Dot(corner.Step, corner.Step) >=
          ShortestStep * ShortestStep * corner.ShortestEdge * corner.ShortestEdge;
        this->SetChanged(corner, isWorthIt ? 1 : 0);
        corner.Step = isWorthIt ? corner.Step : Point<D>{};
        corner.Halved = 0;
        this->Place(corner);
        while (corner.Halved <= Halvings && !this->Limits.IsNearImage(this->Mesh.Points[corner.Id]))
        {
          ++corner.Halved;
          this->Place(corner);
        }
      });
  }

  void TakeSteps()
  {
    this->ForCorners(
      [this](Corner& corner)
      {
        corner.Moved = Subtract(this->Mesh.Points[corner.Id], this->Originals[corner.Id]);
        corner.Step = {};
      });
  }

  template <typename Vertices>
  bool HasChangedVertex(const Vertices& v) const
  {
    return std::any_of(
      v.begin(), v.end(), [this](std::uint32_t x) { return this->HasChanged[x] != 0; });
  }

  template <typename Vertices>
  void MarkCornersOf(const Vertices& vertices)
  {
    for (const std::uint32_t v : vertices)
    {
      if (this->Ranks[v] != None && this->Moving[this->Ranks[v]].Halved <= Halvings)
      {
        // Relaxed: threads write the same number, and the end of the loop orders it.
        std::atomic_ref<std::uint8_t>(this->Moving[this->Ranks[v]].Mark)
          .store(1, std::memory_order_relaxed);
      }
    }
  }

  Complex<D>& Mesh;                              ///< its points have the steps of this round
  const UninitialisedVector<Point<D>> Originals; ///< the points before all steps
  const Domain<D>& Surfaces;
  const FitBounds<D> Bounds;
  const MoveLimits<D> Limits;
  FitShapes<D> Shapes;
  const unsigned Threads;
  const std::stop_token& Stop;
  UninitialisedVector<Facet> Facets;
  std::vector<Corner> Moving;
  InterfaceOffsets Offsets;
  std::vector<double>
    Wanted;              ///< the volume that each label is to gain; of background it is not used
  bool HasSteps = false; ///< whether any vertex has been moved
  std::vector<std::size_t> FirstFacet; ///< of each corner, in FacetsOf; and the end
  UninitialisedVector<std::uint32_t> FacetsOf;
  std::vector<std::uint8_t> HasChanged; ///< of each vertex, since its cells were checked
  std::vector<std::uint32_t> Ranks;     ///< place in Moving of each vertex, or None
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::uint64_t FitInterfaces(Complex<D>& complex, const Domain<D>& surfaces,
  const FitBounds<D>& bounds, unsigned threads, const std::stop_token& stop)
{
  return Fit<D>(complex, surfaces, bounds, threads, stop).Run();
}

template std::uint64_t FitInterfaces<3>(
  Complex<3>&, const Domain<3>&, const FitBounds<3>&, unsigned, const std::stop_token&);
template std::uint64_t FitInterfaces<4>(
  Complex<4>&, const Domain<4>&, const FitBounds<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

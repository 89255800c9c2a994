// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldRepair.h"

#include "Base/UninitialisedVector.h"
#include "Conformity/RepairNeighbourhood.h"
#include "Geometry/SimplexQuality.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

using namespace repair;

template <int D>
using Facet = std::array<VertexId, static_cast<std::size_t>(D)>;

/** The vertices of a simplex but vertex i, in cyclic order. */
template <int D>
Facet<D> FacetOf(const std::array<VertexId, static_cast<std::size_t>(D + 1)>& v, unsigned i)
{
  Facet<D> facet;
  for (unsigned k = 0; k < facet.size(); ++k)
  {
    facet[k] = v[(i + k + 1) % v.size()];
  }
  return facet;
}

/** The facets of the interfaces of a triangulation. */
template <int D>
struct InterfaceFacets
{
  UninitialisedVector<Facet<D>> Facets;
  UninitialisedVector<std::array<LabelId, 2>> Labels; ///< on both sides of each
  UninitialisedVector<std::uint8_t> OnHull;           ///< of the triangulation
};

/** The facets are in the order of the simplices on the side of the larger label. */
template <int D>
InterfaceFacets<D> FindInterfaceFacets(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, unsigned threads, const std::stop_token& stop)
{
  /** Calls visit(simplex, number of the facet, label beside) for the facets of a chunk. */
  const auto forEachOf = [&](std::size_t first, std::size_t last, auto&& visit)
  {
    for (auto s = static_cast<SimplexId>(first); s < last; ++s)
    {
      if (labels[s] == 0)
      {
        continue;
      }
      const auto& simplex = triangulation.GetSimplex(s);
      for (unsigned i = 0; i <= D; ++i)
      {
        const LabelId beside = simplex.N[i] == None ? LabelId{ 0 } : labels[simplex.N[i]];
        if (beside < labels[s])
        {
          visit(s, i, beside);
        }
      }
    }
  };
  const auto forChunks = [&](auto&& function)
  { ParallelFor(0, labels.size(), ChunkCounts::Grain, threads, function, stop); };
  ChunkCounts places(labels.size());
  forChunks(
    [&](std::size_t first, std::size_t last)
    {
      std::size_t number = 0;
      forEachOf(first, last, [&](SimplexId, unsigned, LabelId) { ++number; });
      places.OfChunk(first) = number;
    });
  const std::size_t number = places.TurnIntoPlaces();
  InterfaceFacets<D> all;
  all.Facets.resize(number);
  all.Labels.resize(number);
  all.OnHull.resize(number);
  forChunks(
    [&](std::size_t first, std::size_t last)
    {
      std::size_t place = places.OfChunk(first);
      forEachOf(first, last,
        [&](SimplexId s, unsigned i, LabelId beside)
        {
          const auto& simplex = triangulation.GetSimplex(s);
          all.Facets[place] = FacetOf<D>(simplex.V, i);
          all.Labels[place] = { labels[s], beside };
          all.OnHull[place] = simplex.N[i] == None ? 1 : 0;
          ++place;
        });
    });
  return all;
}

//------------------------------------------------------------------------------------------------
/** Finds and applies changes that leave fewer bad ridges. */
template <int D>
class RidgeRepair
{
public:
  RidgeRepair(const Triangulation<D>& triangulation, std::span<LabelId> labels,
    std::vector<std::uint8_t> onInterface, const ManifoldRepairOptions<D>& options)
    : Labels(labels)
    , Near(triangulation, labels, std::move(onInterface))
    , FacetCosine(std::cos(options.Shape.FacetAngle * std::numbers::pi / 180.0))
    , JunctionCosine(std::cos(options.Shape.JunctionFacetAngle * std::numbers::pi / 180.0))
    , Surfaces(options.Surfaces)
    , Sizing(options.Sizing)
    , Keeps(options.Keeps)
  {
  }

  /** Applies the best change around a ridge. @return false if none helps */
  bool Mend(const Ridge<D>& ridge)
  {
    std::optional<Change> best;
    bool bestDents = true;
    int bestGain = 0;
    double bestVolume = 0.0;
    for (Change& change : this->ChangesAt(ridge))
    {
      const int gain = this->GainOf(change);
      const double volume = this->VolumeOf(change);
      const bool dents = this->Dents(change);
      const bool isBetter = dents != bestDents ? bestDents
        : gain != bestGain                     ? gain > bestGain
                                               : volume < bestVolume;
      if (gain > 0 && isBetter && this->IsAllowed(change))
      {
        bestDents = dents;
        bestGain = gain;
        bestVolume = volume;
        best = std::move(change);
      }
    }
    if (!best)
    {
      return false;
    }
    for (const SimplexId t : best->Cells)
    {
      this->Labels[t] = best->Label;
      this->Changed.insert(t);
    }
    return true;
  }

  bool IsBad(const Ridge<D>& ridge) const
  {
    return this->Near.StateOf(ridge, this->Near.StarOf(ridge).front()).Bad != 0;
  }

  const std::set<SimplexId>& GetChanged() const { return this->Changed; }

  /**
   * The bad ridges now, in the order of their vertices. Only ridges that were bad before, and ridges
   * of changed simplices, need to be checked.
   * @param before the bad ridges before any change
   */
  std::vector<InterfaceRidge<D>> FindLeft(const std::vector<InterfaceRidge<D>>& before) const
  {
    std::vector<InterfaceRidge<D>> left;
    const std::vector<CellRidge> changed = this->RidgesOf(this->Changed);
    for (const InterfaceRidge<D>& ridge : before)
    {
      const auto at = std::lower_bound(changed.begin(), changed.end(), ridge.Vertices,
        [](const CellRidge& r, const Ridge<D>& vertices) { return r.Vertices < vertices; });
      if (at == changed.end() || at->Vertices != ridge.Vertices)
      {
        left.push_back(ridge);
      }
    }
    for (const CellRidge& ridge : changed)
    {
      const auto state = this->Near.StateOf(ridge.Vertices, ridge.Cell);
      if (state.Bad > 0)
      {
        left.push_back({ ridge.Vertices, state.IsJunction });
      }
    }
    std::sort(left.begin(), left.end(),
      [](const auto& a, const auto& b) { return a.Vertices < b.Vertices; });
    return left;
  }

private:
  Facet<D> FacetOf(SimplexId t, unsigned i) const
  {
    return voxplex::FacetOf<D>(this->Near.VerticesOf(t), i);
  }

  /**
   * All candidate changes: each simplex around the ridge, and each run of a label, gets a label
   * beside it.
   */
  std::vector<Change> ChangesAt(const Ridge<D>& ridge) const
  {
    const std::vector<SimplexId> star = this->Near.StarOf(ridge);
    std::vector<std::vector<SimplexId>> groups;
    std::set<SimplexId> grouped;
    for (const SimplexId t : star)
    {
      if (this->Labels[t] == 0) // is not in the mesh
      {
        continue;
      }
      groups.push_back({ t });
      if (!grouped.insert(t).second)
      {
        continue;
      }
      std::vector<SimplexId> run{ t };
      for (std::size_t k = 0; k < run.size(); ++k)
      {
        for (unsigned i = 0; i <= D; ++i)
        {
          const SimplexId other = this->Near.Beside(run[k], i);
          if (std::binary_search(star.begin(), star.end(), other) &&
            this->Labels[other] == this->Labels[t] && grouped.insert(other).second)
          {
            run.push_back(other);
          }
        }
      }
      if (run.size() > 1)
      {
        groups.push_back(std::move(run));
      }
    }
    std::vector<Change> changes;
    for (const std::vector<SimplexId>& group : groups)
    {
      std::set<LabelId> labels;
      for (const SimplexId t : group)
      {
        for (unsigned i = 0; i <= D; ++i)
        {
          labels.insert(this->Near.LabelBeside(t, i));
        }
      }
      labels.erase(this->Labels[group.front()]);
      for (const LabelId label : labels)
      {
        changes.push_back({ group, label });
      }
    }
    return changes;
  }

  /** A ridge, and a simplex that has it. */
  struct CellRidge
  {
    Ridge<D> Vertices;
    SimplexId Cell;
  };

  /** The ridges of some simplices, ascending. */
  template <typename Cells>
  std::vector<CellRidge> RidgesOf(const Cells& cells) const
  {
    std::vector<CellRidge> ridges;
    for (const SimplexId t : cells)
    {
      auto v = this->Near.VerticesOf(t);
      std::sort(v.begin(), v.end());
      for (unsigned i = 0; i <= D; ++i)
      {
        for (unsigned j = 0; j < i; ++j)
        {
          CellRidge& ridge = ridges.emplace_back();
          ridge.Cell = t;
          std::size_t n = 0;
          for (unsigned k = 0; k <= D; ++k)
          {
            if (k != i && k != j)
            {
              ridge.Vertices[n++] = v[k];
            }
          }
        }
      }
    }
    std::sort(ridges.begin(), ridges.end(),
      [](const CellRidge& a, const CellRidge& b) { return a.Vertices < b.Vertices; });
    ridges.erase(std::unique(ridges.begin(), ridges.end(),
                   [](const CellRidge& a, const CellRidge& b) { return a.Vertices == b.Vertices; }),
      ridges.end());
    return ridges;
  }

  /** Neighbourhood::GainAt(), summed over all ridges. */
  int GainOf(const Change& change) const
  {
    int gain = 0;
    for (const CellRidge& ridge : this->RidgesOf(change.Cells))
    {
      gain += this->Near.GainAt(ridge.Vertices, ridge.Cell, change);
    }
    return gain;
  }

  double VolumeOf(const Change& change) const
  {
    double volume = 0.0;
    for (const SimplexId t : change.Cells)
    {
      std::array<const Point<D>*, D + 1> points;
      for (unsigned i = 0; i <= D; ++i)
      {
        points[i] = &this->Near.Position(this->Near.VerticesOf(t)[i]);
      }
      volume += std::abs(SignedVolume<D>(points.data()));
    }
    return volume;
  }

  bool IsAllowed(const Change& change) const
  {
    bool leavesSome = false;
    for (const SimplexId t : change.Cells)
    {
      if (this->IsTooLarge(t, change.Label) || (this->Keeps && this->Keeps(t)))
      {
        return false;
      }
      const LabelId own = this->Labels[t];
      for (const VertexId v : this->Near.VerticesOf(t))
      {
        if (!this->Near.IsOnInterface(v))
        {
          return false;
        }
        if (!leavesSome)
        {
          const std::vector<SimplexId>& star = this->Near.StarOf(v);
          leavesSome = std::any_of(star.begin(), star.end(),
            [&](SimplexId other) { return this->Labels[other] == own && !change.Touches(other); });
        }
      }
      for (unsigned i = 0; i <= D; ++i)
      {
        if (change.Label == 0 && this->Near.Beside(t, i) == None)
        {
          return false;
        }
        const bool isNew = this->Near.LabelBeside(t, i) == own &&
          !change.Touches(this->Near.Beside(t, i)); // the facet becomes an interface facet
        if (isNew && !this->HasGoodAngles(t, i, change))
        {
          return false;
        }
      }
    }
    return leavesSome && !this->UncoversSharpFacet(change);
  }

  /**
   * Whether a change takes a junction away from an interface facet whose angles are allowed at
   * junctions only.
   */
  bool UncoversSharpFacet(const Change& change) const
  {
    if constexpr (D != 3)
    {
      return false;
    }
    for (const SimplexId t : change.Cells)
    {
      for (const VertexId v : this->Near.VerticesOf(t))
      {
        if (!this->IsAtJunction(v, nullptr) || this->IsAtJunction(v, &change))
        {
          continue;
        }
        for (const SimplexId s : this->Near.StarOf(v))
        {
          for (unsigned i = 0; i <= D; ++i)
          {
            const SimplexId beside = this->Near.Beside(s, i);
            const LabelId other =
              beside == None ? LabelId{ 0 } : this->Near.LabelOf(beside, &change);
            if (this->Near.VerticesOf(s)[i] != v && other < this->Near.LabelOf(s, &change) &&
              this->SharpnessOf(s, i) == Sharpness::AtJunctionsOnly &&
              !this->HasJunction(s, i, change))
            {
              return true;
            }
          }
        }
      }
    }
    return false;
  }

  /** Whether a tetrahedron is larger than the elements of a label may be. */
  bool IsTooLarge(SimplexId t, LabelId label) const
  {
    if (!this->Sizing || label == 0)
    {
      return false;
    }
    const Circumball<D> ball = this->Near.Circumball(t);
    const double size = this->Sizing->ElementSize(ball.Center, label);
    return ball.Radius2 > size * size;
  }

  /**
   * Whether a change drops a tetrahedron with a facet on a flat face where the image cuts the
   * object.
   */
  bool Dents(const Change& change) const
  {
    const ImageBorder<D>* const border = this->Surfaces ? this->Surfaces->Border() : nullptr;
    if (!border || change.Label != 0)
    {
      return false;
    }
    for (const SimplexId t : change.Cells)
    {
      for (unsigned i = 0; i <= D; ++i)
      {
        unsigned faces = ~0u;
        for (const VertexId v : this->FacetOf(t, i))
        {
          faces &= border->FacesAt(this->Near.Position(v));
        }
        if (faces != 0)
        {
          return true;
        }
      }
    }
    return false;
  }

  /** Where a facet with these angles may be; anywhere in 4D. */
  enum class Sharpness
  {
    Anywhere,
    AtJunctionsOnly,
    Nowhere
  };
  Sharpness SharpnessOf(SimplexId t, unsigned i) const
  {
    if constexpr (D != 3)
    {
      return Sharpness::Anywhere;
    }
    const Facet<D> facet = this->FacetOf(t, i);
    Sharpness sharpness = Sharpness::Anywhere;
    for (unsigned k = 0; k < 3; ++k)
    {
      const Point<D>& p = this->Near.Position(facet[k]);
      const Point<D> a = Subtract(this->Near.Position(facet[(k + 1) % 3]), p);
      const Point<D> b = Subtract(this->Near.Position(facet[(k + 2) % 3]), p);
      const double lengths = std::sqrt(Dot(a, a) * Dot(b, b));
      if (Dot(a, b) > this->JunctionCosine * lengths)
      {
        return Sharpness::Nowhere;
      }
      sharpness = Dot(a, b) > this->FacetCosine * lengths ? Sharpness::AtJunctionsOnly : sharpness;
    }
    return sharpness;
  }

  bool HasGoodAngles(SimplexId t, unsigned i, const Change& change) const
  {
    const Sharpness sharpness = this->SharpnessOf(t, i);
    return sharpness == Sharpness::Anywhere ||
      (sharpness == Sharpness::AtJunctionsOnly && this->HasJunction(t, i, change));
  }

  /** Whether a vertex of a facet is at a junction after a change. */
  bool HasJunction(SimplexId t, unsigned i, const Change& change) const
  {
    const Facet<D> facet = this->FacetOf(t, i);
    return std::any_of(
      facet.begin(), facet.end(), [&](VertexId v) { return this->IsAtJunction(v, &change); });
  }

  /** Whether three or more labels, including background, meet at a vertex. */
  bool IsAtJunction(VertexId v, const Change* change) const
  {
    std::array<LabelId, 2> known{};
    unsigned count = 0;
    for (const SimplexId t : this->Near.StarOf(v))
    {
      const LabelId label = this->Near.LabelOf(t, change);
      if (std::find(known.begin(), known.begin() + count, label) == known.begin() + count)
      {
        if (count == known.size())
        {
          return true;
        }
        known[count++] = label;
      }
    }
    return false;
  }

  const std::span<LabelId> Labels; ///< by simplex id
  const Neighbourhood<D> Near;
  const double FacetCosine;
  const double JunctionCosine; ///< at least FacetCosine
  const Domain<D>* const Surfaces;
  const SizingField<D>* const Sizing;
  const std::function<bool(SimplexId)> Keeps;
  std::set<SimplexId> Changed;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
ManifoldRepairResult<D> RepairManifold(const Triangulation<D>& triangulation,
  std::span<LabelId> labels, const ManifoldRepairOptions<D>& options, unsigned threads,
  const std::stop_token& stop)
{
  const InterfaceFacets<D> interfaces =
    FindInterfaceFacets<D>(triangulation, labels, threads, stop);
  const std::vector<InterfaceRidge<D>> ridges =
    FindNonManifoldRidges<D>(std::span<const Facet<D>>(interfaces.Facets),
      std::span<const std::array<LabelId, 2>>(interfaces.Labels), triangulation.VertexIdEnd(),
      threads, stop);
  if (ridges.empty())
  {
    return {};
  }
  std::vector<std::uint8_t> onInterface(triangulation.VertexIdEnd());
  for (std::size_t f = 0; f < interfaces.Facets.size(); ++f)
  {
    for (const VertexId v : interfaces.Facets[f])
    {
      // Vertices inside of a flat end are on no interface of the image.
      onInterface[v] = onInterface[v] != 0 || interfaces.OnHull[f] == 0 ? 1 : 0;
    }
  }
  RidgeRepair<D> repair(triangulation, labels, std::move(onInterface), options);
  std::size_t changes = 0;
  constexpr auto Never = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> failedAfter(ridges.size(), Never); ///< after so many changes
  for (bool again = true; again;)
  {
    again = false;
    for (std::size_t r = 0; r < ridges.size(); ++r)
    {
      ThrowIfStopped(stop);
      if (failedAfter[r] == changes)
      {
        continue; // nothing has changed since
      }
      if (repair.IsBad(ridges[r].Vertices) && repair.Mend(ridges[r].Vertices))
      {
        ++changes;
        again = true;
      }
      else
      {
        failedAfter[r] = changes;
      }
    }
  }
  const std::set<SimplexId>& changed = repair.GetChanged();
  return { ridges.size(), repair.FindLeft(ridges), { changed.begin(), changed.end() } };
}

template ManifoldRepairResult<3> RepairManifold<3>(const Triangulation<3>&, std::span<LabelId>,
  const ManifoldRepairOptions<3>&, unsigned, const std::stop_token&);
template ManifoldRepairResult<4> RepairManifold<4>(const Triangulation<4>&, std::span<LabelId>,
  const ManifoldRepairOptions<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

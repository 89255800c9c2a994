// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldRepair.h"

#include "Base/UninitialisedVector.h"
#include "Conformity/RidgeRepair.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

using namespace repair;

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
/** When something around each vertex has changed last. */
class ChangeStamps
{
public:
  explicit ChangeStamps(std::size_t vertices)
    : Last(vertices, 0)
  {
  }

  /** @param time not before any other */
  template <typename Vertices>
  void Set(const Vertices& vertices, std::uint32_t time)
  {
    for (const VertexId v : vertices)
    {
      this->Last[v] = time;
    }
  }

  /** Whether something around one of these vertices has changed after a time. */
  bool AnyAfter(const std::vector<VertexId>& vertices, std::uint32_t time) const
  {
    return std::any_of(
      vertices.begin(), vertices.end(), [&](VertexId v) { return this->Last[v] > time; });
  }

private:
  std::vector<std::uint32_t> Last;
};

/**
 * Mends bad ridges one after the other, in passes, until nothing helps any more.
 *
 * At the beginning of a pass, threads look for changes. If there are many ridges, they mend parts of
 * space, each part with labels of its own; otherwise they look at each ridge alone. Then the
 * changes are made in the order of the list. If something around a ridge is not as the thread had
 * it, a change is looked for again. So the result is that of one thread.
 */
template <int D>
class RepairTeam
{
public:
  RepairTeam(const Triangulation<D>& triangulation, std::span<LabelId> labels,
    std::span<const std::uint8_t> onInterface, const ManifoldRepairOptions<D>& options,
    const std::vector<InterfaceRidge<D>>& ridges, unsigned threads, const std::stop_token& stop)
    : Source(triangulation)
    , Labels(labels)
    , OnInterface(onInterface)
    , Options(options)
    , Ridges(ridges)
    , Threads(NumberOfThreads(threads))
    , Stop(stop)
    , Finder(triangulation, labels, onInterface, options)
    , Changes(triangulation.VertexIdEnd())
    , Entries(ridges.size())
  {
    // Labels are copied for each part, so it must have many ridges.
    const std::size_t fewest = std::max(FewestOfPart, labels.size() / SimplicesPerRidge);
    const std::size_t parts =
      std::min<std::size_t>({ this->Threads, MostParts, ridges.size() / fewest });
    if (parts > 1)
    {
      this->Parts.resize(parts);
      this->ForParts([&](std::size_t p)
        { this->Parts[p] = std::make_unique<Part>(triangulation, labels, onInterface, options); });
      this->FindParts();
    }
  }

  void Mend()
  {
    std::size_t before = 0;
    do
    {
      before = this->Relabelled.size();
      ++this->Pass;
      if (this->Parts.empty() && this->Threads > 1)
      {
        this->ProposeForEach();
      }
      this->ForParts([this](std::size_t p) { this->Try(*this->Parts[p]); });
      for (std::uint32_t r = 0; r < this->Entries.size(); ++r)
      {
        ThrowIfStopped(this->Stop);
        this->Mend(r);
      }
      for (const std::unique_ptr<Part>& part : this->Parts)
      {
        this->Update(*part, before);
      }
    } while (this->Relabelled.size() > before);
  }

  /** The simplices that have another label. */
  std::set<SimplexId> GetChanged() const
  {
    return { this->Relabelled.begin(), this->Relabelled.end() };
  }

  std::vector<InterfaceRidge<D>> FindLeft() const
  {
    return this->Finder.FindLeft(this->Ridges, this->GetChanged());
  }

private:
  /** A part has labels of its own, 2 bytes a simplex. */
  static constexpr std::size_t MostParts = 8;
  static constexpr std::size_t FewestOfPart = 32; ///< ridges; trying fewer is not worth a thread
  static constexpr std::size_t SimplicesPerRidge = 5000; ///< at most, of all simplices and one part

  /** What a thread needs to try a part. */
  struct Part
  {
    Part(const Triangulation<D>& triangulation, std::span<const LabelId> labels,
      std::span<const std::uint8_t> onInterface, const ManifoldRepairOptions<D>& options)
      : Labels(labels.begin(), labels.end())
      , Finder(triangulation, this->Labels, onInterface, options)
      , Tried(triangulation.VertexIdEnd())
      , Surprises(triangulation.VertexIdEnd())
    {
    }

    std::vector<std::uint32_t> Ridges; ///< ascending
    std::vector<LabelId> Labels;
    const RidgeRepair<D> Finder;
    std::vector<SimplexId> Relabelled; ///< in this pass
    ChangeStamps Tried;                ///< its own changes; time is the pass
    ChangeStamps Surprises; ///< where it does not know the labels that there are; time is the pass
  };

  /** The last proposal for a ridge. */
  struct Entry
  {
    Proposal Proposed;
    Part* TriedBy = nullptr;
    std::uint32_t TriedIn = 0; ///< the pass
    std::uint32_t Time = 0;    ///< the number of changes when it was right
    bool IsMade = false;
  };

  template <typename Function>
  void ForParts(const Function& function)
  {
    ParallelFor(
      0, this->Parts.size(), 1, static_cast<unsigned>(this->Parts.size()),
      [&](std::size_t p, std::size_t) { function(p); }, this->Stop);
  }

  /** Cuts space into slabs with as many ridges each. */
  void FindParts()
  {
    const auto placeOf = [this](std::uint32_t r) -> const Point<D>&
    { return this->Source.Position(this->Ridges[r].Vertices[0]); };
    std::vector<std::uint32_t> order(this->Ridges.size());
    std::iota(order.begin(), order.end(), 0);
    std::size_t longest = 0;
    double length = -1.0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(D); ++a)
    {
      const auto [first, last] = std::minmax_element(order.begin(), order.end(),
        [&](std::uint32_t r, std::uint32_t q) { return placeOf(r)[a] < placeOf(q)[a]; });
      if (placeOf(*last)[a] - placeOf(*first)[a] > length)
      {
        length = placeOf(*last)[a] - placeOf(*first)[a];
        longest = a;
      }
    }
    std::sort(order.begin(), order.end(),
      [&](std::uint32_t r, std::uint32_t q) { return placeOf(r)[longest] < placeOf(q)[longest]; });
    for (std::size_t k = 0; k < order.size(); ++k)
    {
      this->Parts[k * this->Parts.size() / order.size()]->Ridges.push_back(order[k]);
    }
    for (const std::unique_ptr<Part>& part : this->Parts)
    {
      std::sort(part->Ridges.begin(), part->Ridges.end());
    }
  }

  /** Whether nothing around a ridge has changed since it had its proposal. */
  bool IsRight(const Entry& entry) const
  {
    return entry.IsMade && !this->Changes.AnyAfter(entry.Proposed.Seen, entry.Time);
  }

  /** Finds a change for each ridge as if there were no other. */
  void ProposeForEach()
  {
    constexpr std::size_t RidgesAtOnce = 8; // near each other, so that stars are found once
    ParallelFor(
      0, this->Entries.size(), RidgesAtOnce, this->Threads,
      [&](std::size_t first, std::size_t last)
      {
        const RidgeRepair<D> finder(this->Source, this->Labels, this->OnInterface, this->Options);
        for (std::size_t r = first; r < last; ++r)
        {
          Entry& entry = this->Entries[r];
          if (!this->IsRight(entry))
          {
            entry.Proposed = finder.Propose(this->Ridges[r].Vertices);
            entry.IsMade = true;
            entry.Time = this->Time;
          }
        }
      },
      this->Stop);
  }

  /** Mends a part by changes of its own labels. */
  void Try(Part& part)
  {
    for (const std::uint32_t r : part.Ridges)
    {
      ThrowIfStopped(this->Stop);
      Entry& entry = this->Entries[r];
      if (this->IsRight(entry) && !part.Tried.AnyAfter(entry.Proposed.Seen, this->Pass - 1))
      {
        continue;
      }
      entry.Proposed = part.Finder.Propose(this->Ridges[r].Vertices);
      entry.IsMade = true;
      entry.TriedBy = &part;
      entry.TriedIn = this->Pass;
      if (entry.Proposed.Best)
      {
        for (const SimplexId t : entry.Proposed.Best->Cells)
        {
          part.Labels[t] = entry.Proposed.Best->Label;
          part.Relabelled.push_back(t);
        }
        this->Stamp(part.Tried, entry.Proposed.Best, this->Pass);
      }
    }
  }

  /** Makes the change that a thread has tried, or another one if that did not see the labels that there are. */
  void Mend(std::uint32_t r)
  {
    Entry& entry = this->Entries[r];
    const bool isTried = entry.TriedIn == this->Pass;
    bool isKnown = isTried; // by the part
    if (isTried ? entry.TriedBy->Surprises.AnyAfter(entry.Proposed.Seen, this->Pass - 1)
                : !this->IsRight(entry))
    {
      const std::optional<Change> tried = std::exchange(entry.Proposed.Best, std::nullopt);
      entry.Proposed = this->Finder.Propose(this->Ridges[r].Vertices);
      entry.IsMade = true;
      isKnown = isTried && tried == entry.Proposed.Best;
      if (isTried && !isKnown)
      {
        this->Stamp(entry.TriedBy->Surprises, tried, this->Pass);
      }
    }
    entry.Time = this->Time;
    if (!entry.Proposed.Best)
    {
      return;
    }
    ++this->Time;
    for (const SimplexId t : entry.Proposed.Best->Cells)
    {
      this->Labels[t] = entry.Proposed.Best->Label;
      this->Relabelled.push_back(t);
    }
    this->Stamp(this->Changes, entry.Proposed.Best, this->Time);
    for (const std::unique_ptr<Part>& part : this->Parts)
    {
      if (!isKnown || part.get() != entry.TriedBy)
      {
        this->Stamp(part->Surprises, entry.Proposed.Best, this->Pass);
      }
    }
  }

  void Stamp(ChangeStamps& stamps, const std::optional<Change>& change, std::uint32_t time) const
  {
    for (const SimplexId t : change ? change->Cells : std::vector<SimplexId>())
    {
      stamps.Set(this->Source.GetSimplex(t).V, time);
    }
  }

  /** Gives a part the labels that there are now. @param before length of Relabelled before this pass */
  void Update(Part& part, std::size_t before) const
  {
    const auto update = [&](SimplexId t) { part.Labels[t] = this->Labels[t]; };
    std::for_each(part.Relabelled.begin(), part.Relabelled.end(), update);
    std::for_each(this->Relabelled.begin() + static_cast<std::ptrdiff_t>(before),
      this->Relabelled.end(), update);
    part.Relabelled.clear();
  }

  const Triangulation<D>& Source;
  const std::span<LabelId> Labels; ///< by simplex id
  const std::span<const std::uint8_t> OnInterface;
  const ManifoldRepairOptions<D>& Options;
  const std::vector<InterfaceRidge<D>>& Ridges;
  const unsigned Threads;
  const std::stop_token& Stop;
  const RidgeRepair<D> Finder;
  ChangeStamps Changes;                     ///< time is the number of changes
  std::vector<Entry> Entries;               ///< of each ridge
  std::vector<std::unique_ptr<Part>> Parts; ///< none: one thread
  std::vector<SimplexId> Relabelled;        ///< may be repeated
  std::uint32_t Time = 0;
  std::uint32_t Pass = 0;
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
  RepairTeam<D> team(triangulation, labels, onInterface, options, ridges, threads, stop);
  team.Mend();
  const std::set<SimplexId> changed = team.GetChanged();
  return { ridges.size(), team.FindLeft(), { changed.begin(), changed.end() } };
}

template ManifoldRepairResult<3> RepairManifold<3>(const Triangulation<3>&, std::span<LabelId>,
  const ManifoldRepairOptions<3>&, unsigned, const std::stop_token&);
template ManifoldRepairResult<4> RepairManifold<4>(const Triangulation<4>&, std::span<LabelId>,
  const ManifoldRepairOptions<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldRepair.h"

#include "Conformity/ChangeStamps.h"
#include "Conformity/Recollection.h"
#include "Conformity/RidgeRepair.h"
#include "Mesh/SimplexLabels.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

using namespace repair;

//------------------------------------------------------------------------------------------------
/**
 * Mends bad ridges one after the other, in passes, until nothing helps any more.
 *
 * At the beginning of a pass, threads look for changes. If there are many ridges, they mend parts of
 * space, each part with labels of its own; otherwise they look at each ridge alone. Then the
 * changes are made in the order of the list. If something around a ridge is not as the thread had
 * it, a change is looked for again. So the result is that of one thread.
 *
 * After an earlier call, threads look at each ridge alone for which what was found then is not
 * right.
 */
template <int D>
class RepairTeam
{
public:
  RepairTeam(const Triangulation<D>& triangulation, std::span<LabelId> labels,
    std::span<const LabelId> before, const ManifoldRepairOptions<D>& options,
    const std::vector<InterfaceRidge<D>>& ridges, unsigned threads, const std::stop_token& stop,
    const RepairMemory<D>* memory)
    : Source(triangulation)
    , Labels(labels)
    , LabelsBefore(before)
    , Options(options)
    , Ridges(ridges)
    , Threads(NumberOfThreads(threads))
    , Stop(stop)
    , Finder(triangulation, labels, before, options)
    , Changes(triangulation.VertexIdEnd())
    , Entries(ridges.size())
  {
    if (memory && !memory->Records.empty())
    {
      this->Recalled.emplace(triangulation, memory->Changed, memory->Records, ridges,
        [](const InterfaceRidge<D>& ridge) -> const Ridge<D>& { return ridge.Vertices; });
      return;
    }
    // Labels are copied for each part, so it must have many ridges.
    const std::size_t fewest = std::max(FewestOfPart, labels.size() / SimplicesPerRidge);
    const std::size_t parts =
      std::min<std::size_t>({ this->Threads, MostParts, ridges.size() / fewest });
    if (parts > 1)
    {
      this->Parts.resize(parts);
      this->ForParts([&](std::size_t p)
        { this->Parts[p] = std::make_unique<Part>(triangulation, labels, before, options); });
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

  /** The simplices that have another label, ascending. */
  std::vector<SimplexId> GetChanged() const
  {
    std::vector<SimplexId> changed = this->Relabelled;
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
  }

  std::vector<InterfaceRidge<D>> FindLeft(const std::vector<SimplexId>& changed) const
  {
    return this->Finder.FindLeft(this->Ridges, changed);
  }

  /** What was found for each ridge. */
  std::vector<ProposalRecord<Ridge<D>>> TakeRecords()
  {
    std::vector<ProposalRecord<Ridge<D>>> records(this->Ridges.size());
    for (std::size_t r = 0; r < records.size(); ++r)
    {
      records[r] = { this->Ridges[r].Vertices, std::move(this->Entries[r].History) };
    }
    return records;
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
      std::span<const LabelId> before, const ManifoldRepairOptions<D>& options)
      : Labels(labels.begin(), labels.end())
      , Finder(triangulation, this->Labels, before, options)
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

  using Shared = ProposalHistory::Shared;

  /** The proposals for a ridge. */
  struct Entry
  {
    Shared Proposed; ///< the last one; null: none
    Part* TriedBy = nullptr;
    std::uint32_t TriedIn = 0; ///< the pass
    std::uint32_t Time = 0;    ///< the number of changes when it was right
    ProposalHistory History;   ///< those that were right
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
    return entry.Proposed && !this->Changes.AnyAfter(entry.Proposed->Seen, entry.Time);
  }

  Shared Propose(const RidgeRepair<D>& finder, std::size_t r) const
  {
    return std::make_shared<const Proposal>(finder.Propose(this->Ridges[r].Vertices));
  }

  /** What an earlier call has found for a ridge in this pass, if it is right; otherwise null. */
  Shared Recall(std::size_t r) const
  {
    return this->Recalled ? this->Recalled->Find(r, this->Pass) : nullptr;
  }

  /** Finds a change for each ridge as if there were no other. */
  void ProposeForEach()
  {
    constexpr std::size_t RidgesAtOnce = 8; // near each other, so that stars are found once
    ParallelFor(
      0, this->Entries.size(), RidgesAtOnce, this->Threads,
      [&](std::size_t first, std::size_t last)
      {
        const RidgeRepair<D> finder(this->Source, this->Labels, this->LabelsBefore, this->Options);
        for (std::size_t r = first; r < last; ++r)
        {
          Entry& entry = this->Entries[r];
          if (!this->IsRight(entry) && !this->Recall(r))
          {
            entry.Proposed = this->Propose(finder, r);
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
      if (this->IsRight(entry) && !part.Tried.AnyAfter(entry.Proposed->Seen, this->Pass - 1))
      {
        continue;
      }
      entry.Proposed = this->Propose(part.Finder, r);
      entry.TriedBy = &part;
      entry.TriedIn = this->Pass;
      if (const std::optional<Change>& best = entry.Proposed->Best)
      {
        for (const SimplexId t : best->Cells)
        {
          part.Labels[t] = best->Label;
          part.Relabelled.push_back(t);
        }
        this->Stamp(part.Tried, best, this->Pass);
      }
    }
  }

  /** Makes the best change around a ridge, if there is one. */
  void Mend(std::uint32_t r)
  {
    Entry& entry = this->Entries[r];
    bool isKnown = false; // by the part
    if (const Shared recalled = this->Recall(r))
    {
      entry.Proposed = recalled;
    }
    else
    {
      isKnown = this->Correct(r);
    }
    entry.History.Add(this->Pass, entry.Proposed);
    entry.Time = this->Time;
    const std::optional<Change>& best = entry.Proposed->Best;
    if (!best)
    {
      return;
    }
    ++this->Time;
    for (const SimplexId t : best->Cells)
    {
      this->Labels[t] = best->Label;
      this->Relabelled.push_back(t);
    }
    this->Stamp(this->Changes, best, this->Time);
    for (const std::unique_ptr<Part>& part : this->Parts)
    {
      if (!isKnown || part.get() != entry.TriedBy)
      {
        this->Stamp(part->Surprises, best, this->Pass);
      }
    }
  }

  /**
   * Looks for a change again if a thread that has tried one did not see the labels that there are.
   * @return whether a part has tried the change that is right
   */
  bool Correct(std::uint32_t r)
  {
    Entry& entry = this->Entries[r];
    const bool isTried = entry.TriedIn == this->Pass;
    bool isKnown = isTried;
    if (isTried ? entry.TriedBy->Surprises.AnyAfter(entry.Proposed->Seen, this->Pass - 1)
                : !this->IsRight(entry))
    {
      const Shared tried = std::exchange(entry.Proposed, this->Propose(this->Finder, r));
      isKnown = isTried && tried->Best == entry.Proposed->Best;
      if (isTried && !isKnown)
      {
        this->Stamp(entry.TriedBy->Surprises, tried->Best, this->Pass);
      }
    }
    if (this->Recalled)
    {
      this->Recalled->Compare(r, this->Pass, *entry.Proposed);
    }
    return isKnown;
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
  const std::span<const LabelId> LabelsBefore;
  const ManifoldRepairOptions<D>& Options;
  const std::vector<InterfaceRidge<D>>& Ridges;
  const unsigned Threads;
  const std::stop_token& Stop;
  const RidgeRepair<D> Finder;
  ChangeStamps Changes;                     ///< time is the number of changes
  std::vector<Entry> Entries;               ///< of each ridge
  std::optional<Recollection<D>> Recalled;  ///< none: nothing is known
  std::vector<std::unique_ptr<Part>> Parts; ///< none: one thread
  std::vector<SimplexId> Relabelled;        ///< may be repeated
  std::uint32_t Time = 0;
  std::uint32_t Pass = 0;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
ManifoldRepairResult<D> RepairManifold(const Triangulation<D>& triangulation,
  std::span<LabelId> labels, const std::vector<InterfaceRidge<D>>& ridges,
  const ManifoldRepairOptions<D>& options, unsigned threads, const std::stop_token& stop,
  RepairMemory<D>* memory)
{
  if (ridges.empty())
  {
    if (memory)
    {
      memory->Records.clear();
    }
    return {};
  }
  const SimplexLabels before(labels.begin(), labels.end());
  RepairTeam<D> team(triangulation, labels, before, options, ridges, threads, stop, memory);
  team.Mend();
  std::vector<SimplexId> changed = team.GetChanged();
  std::vector<InterfaceRidge<D>> left = team.FindLeft(changed);
  if (memory)
  {
    memory->Records = team.TakeRecords();
  }
  return { std::move(left), std::move(changed) };
}

template ManifoldRepairResult<3> RepairManifold<3>(const Triangulation<3>&, std::span<LabelId>,
  const std::vector<InterfaceRidge<3>>&, const ManifoldRepairOptions<3>&, unsigned,
  const std::stop_token&, RepairMemory<3>*);
template ManifoldRepairResult<4> RepairManifold<4>(const Triangulation<4>&, std::span<LabelId>,
  const std::vector<InterfaceRidge<4>>&, const ManifoldRepairOptions<4>&, unsigned,
  const std::stop_token&, RepairMemory<4>*);

} // namespace voxplex

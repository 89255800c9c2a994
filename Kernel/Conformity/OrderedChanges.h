// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OrderedChanges.h
 * @brief Changes of labels around defects, found by several threads, with the result of one.
 */
#ifndef voxplex_OrderedChanges_h
#define voxplex_OrderedChanges_h

#include "Conformity/RepairNeighbourhood.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex::repair
{

/**
 * What is best for a defect, as long as no simplex around the vertices that were seen gets another
 * label.
 */
struct Proposal
{
  std::optional<Change> Best; ///< none: it is no defect any more, or nothing helps
  std::vector<VertexId> Seen; ///< may be repeated
};

/**
 * @brief Changes labels around one defect after the other.
 *
 * Before a pass, threads propose a change for each defect as if there were no other. Then changes are
 * made in the order of the defects. One that is not right any more, because a label around what it
 * has seen has changed, is proposed again. So the result is that of one thread (deterministic
 * reservations: Blelloch, Fineman, Gibbons and Shun, 2012).
 *
 * A pass takes time linear in the number of defects, and in the stars of the vertices seen.
 */
template <int D>
class OrderedChanges
{
public:
  /**
   * All must outlive this object. No thread may change the triangulation.
   * @param labels by simplex id; changed
   * @param threads 0 means all cores
   */
  OrderedChanges(const Triangulation<D>& triangulation, std::span<LabelId> labels,
    std::size_t defects, unsigned threads, const std::stop_token& stop)
    : Source(triangulation)
    , Labels(labels)
    , Threads(NumberOfThreads(threads))
    , Stop(stop)
    , LastChanges(triangulation.VertexIdEnd(), 0)
    , Entries(defects)
  {
  }

  /**
   * @param makeFinder makes an object that a thread proposes with. It may read the labels.
   * @param propose propose(finder, k) gives the Proposal for defect k
   * @return whether a label was changed
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  template <typename MakeFinder, typename Propose>
  bool Pass(const MakeFinder& makeFinder, const Propose& propose)
  {
    if (this->Threads > 1)
    {
      constexpr std::size_t DefectsAtOnce = 8; // near each other, so that stars are found once
      ParallelFor(
        0, this->Entries.size(), DefectsAtOnce, this->Threads,
        [&](std::size_t first, std::size_t last)
        {
          const auto finder = makeFinder();
          for (std::size_t k = first; k < last; ++k)
          {
            this->Update(k, finder, propose);
          }
        },
        this->Stop);
    }
    const std::uint32_t before = this->Time;
    const auto finder = makeFinder();
    for (std::size_t k = 0; k < this->Entries.size(); ++k)
    {
      ThrowIfStopped(this->Stop);
      this->Update(k, finder, propose);
      if (const std::optional<Change>& best = this->Entries[k].Of.Best)
      {
        this->Make(*best);
      }
    }
    return this->Time > before;
  }

  /** The simplices that were given labels. */
  const std::set<SimplexId>& GetChanged() const { return this->Changed; }

private:
  struct KnownProposal
  {
    Proposal Of;
    std::uint32_t Time = 0; ///< the number of changes when it was proposed, plus 1; 0: never
  };

  /** Proposes a change, unless the one that there is is right. */
  template <typename Finder, typename Propose>
  void Update(std::size_t k, const Finder& finder, const Propose& propose)
  {
    KnownProposal& entry = this->Entries[k];
    const bool isRight = entry.Time != 0 &&
      std::all_of(entry.Of.Seen.begin(), entry.Of.Seen.end(),
        [&](VertexId v) { return this->LastChanges[v] < entry.Time; });
    if (!isRight)
    {
      entry = { propose(finder, k), this->Time };
    }
  }

  void Make(const Change& change)
  {
    for (const SimplexId t : change.Cells)
    {
      this->Labels[t] = change.Label;
      this->Changed.insert(t);
      for (const VertexId v : this->Source.GetSimplex(t).V)
      {
        this->LastChanges[v] = this->Time;
      }
    }
    ++this->Time;
  }

  const Triangulation<D>& Source;
  const std::span<LabelId> Labels;
  const unsigned Threads;
  const std::stop_token& Stop;
  std::vector<std::uint32_t> LastChanges; ///< around each vertex: the time of the last
  std::vector<KnownProposal> Entries;     ///< of each defect
  std::set<SimplexId> Changed;
  std::uint32_t Time = 1; ///< the number of changes, plus 1
};

} // namespace voxplex::repair

#endif

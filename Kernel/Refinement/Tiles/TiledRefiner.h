// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TiledRefiner.h
 * @brief Refinement whose result does not depend on the number of threads.
 */
#ifndef voxplex_TiledRefiner_h
#define voxplex_TiledRefiner_h

#include "Refinement/RefinerBase.h"
#include "Refinement/Seeding.h"
#include "Refinement/TeamOptions.h"
#include "Refinement/Tiles/CoarseLattice.h"
#include "Refinement/Tiles/Tiles.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief Refines the triangulation of a context by a set of rules. The result is the same for any
 * number of threads, bit for bit.
 *
 * Space is cut into tiles. Each tile is refined by one thread, by the sequential algorithm, beside
 * the others. Nothing that a tile's thread reads is written by another (WorkerZone). So the result
 * for a tile does not depend on when it is refined, or by which thread. There are no locks.
 *
 * An element is put off if it cannot be refined inside of its tile: for example, if its cavity has a
 * vertex outside. When all tiles are done, space is cut elsewhere, and the elements that were put
 * off are tried again. What is left after some tilings is refined by one thread. Slivers (R7) come
 * last, as in Refiner.
 *
 * The order of all lists is that of tiles, not that of threads. Ids depend on threads. No rule asks
 * for their order, and in the end they are replaced (Triangulation::Renumber).
 *
 * A coarse lattice of points (MakeCoarseLattice) and a coarse sample of the interfaces make
 * circumballs small compared with tiles from the start.
 *
 * Rules is a class as in Refiner.
 */
template <typename Rules>
class TiledRefiner : public RefinerBase<Rules::Dimension>
{
public:
  static constexpr int D = Rules::Dimension;
  using typename RefinerBase<D>::Monitor;

  /**
   * @param options Threads and FineGrained; the others have no effect
   * @param seeds, start as in Refiner. If seeds are not inserted everywhere, the ids of the
   *   triangulation must not depend on threads: it was made by a TiledRefiner.
   */
  explicit TiledRefiner(RefinementContext<D>& context, const TeamOptions& options,
    std::vector<FeatureSeed<D>> seeds = {}, RefinementStart start = RefinementStart::Everywhere)
    : RefinerBase<D>(context)
    , Seeds(std::move(seeds))
    , Start(start)
    , Delta(context.Sizing.Equivalent())
  {
    const unsigned threads = std::max(1u, options.Threads);
    for (unsigned t = 0; t < threads; ++t)
    {
      this->Workers.push_back(std::make_unique<RefinementWorker<D>>(context));
    }
    if (options.FineGrained && threads > 1)
    {
      this->Sharing = std::make_unique<LoopSharing>(threads);
      this->HelpEachOther(*this->Sharing);
    }
  }

  /**
   * Refines until no rule applies. Call it once.
   * @return false if goOn stopped refinement
   * @throws std::bad_alloc
   */
  bool Run(const Monitor& goOn)
  {
    this->GoOn = &goOn;
    const Work slivers = this->RefineAll(this->FindWork(), true);
    this->RefineAll(slivers, false);
    if (this->NumberOfTiles > 0)
    {
      this->Context.Mesh.Renumber(this->Threads());
    }
    return !this->IsStopped();
  }

  std::vector<ThreadStatistics> GetThreadStatistics() const
  {
    std::vector<ThreadStatistics> threads(this->Workers.size());
    for (std::size_t t = 0; t < threads.size(); ++t)
    {
      threads[t].Insertions = this->Workers[t]->Statistics.Insertions();
      threads[t].Removals = this->Workers[t]->Statistics.Removed;
      if (this->Sharing)
      {
        threads[t].HelpedLoops = this->Sharing->GetCounts(static_cast<unsigned>(t)).Loops;
        threads[t].HelpedIterations = this->Sharing->GetCounts(static_cast<unsigned>(t)).Iterations;
      }
    }
    return threads;
  }

  /** The number of tiles that were refined beside others. */
  std::size_t GetNumberOfTiles() const { return this->NumberOfTiles; }

private:
  using Entry = PoorElementList::Entry;
  using Counts = std::unordered_map<typename RegionalWork<D>::Region, std::uint32_t>;

  // In delta. Chosen on seven atlases, by the evaluations of the longest tile of each tiling.
  static constexpr double SampleSpacing = 3.0;
  static constexpr double LatticeSpacing = 5.0;
  static constexpr double LatticeClearance = 1.5;

  /**
   * An element is put off without an evaluation if a ball around its circumcentre does not fit into
   * the tile. Its radius is this, in circumradii. Cavities are rarely larger.
   */
  static constexpr double Reach = 2.0;

  /** With less work, one thread does it all. */
  static constexpr std::size_t FewestEntries = 512;
  /**
   * A triangulation that was refined before needs more work than one entry for this many simplices,
   * since renumbering it also takes time.
   */
  static constexpr std::size_t SimplicesPerEntry = 16;
  /** After this many tilings, one thread does what is left. */
  static constexpr unsigned MostTilings = 16;

  /** What is to be done. */
  struct Work
  {
    std::vector<Entry> Entries;
    std::vector<Entry> Slivers; ///< taken when Entries is empty
    std::vector<PendingRemoval<D>> Removals;

    std::size_t Size() const
    {
      return this->Entries.size() + this->Slivers.size() + this->Removals.size();
    }
    void Append(const Work& more)
    {
      const auto append = [](auto& to, const auto& from)
      { to.insert(to.end(), from.begin(), from.end()); };
      append(this->Entries, more.Entries);
      append(this->Slivers, more.Slivers);
      append(this->Removals, more.Removals);
    }
  };

  /** Counts a task as finished, also if it throws. */
  class Finished
  {
  public:
    explicit Finished(std::atomic<std::size_t>& unfinished)
      : Unfinished(unfinished)
    {
    }
    ~Finished() { --this->Unfinished; }
    Finished(const Finished&) = delete;
    Finished& operator=(const Finished&) = delete;

  private:
    std::atomic<std::size_t>& Unfinished;
  };

  /** The work of one tile. */
  struct TileTask
  {
    HalfOpenBox<D> Extent;
    Work ToDo;
    Work PutOff;
    Counts Counted; ///< insertions, by region
  };

  unsigned Threads() const { return static_cast<unsigned>(this->Workers.size()); }
  bool IsStopped() const { return this->Stopped.load(std::memory_order_relaxed); }

  /** Inserts the seeds, and finds the simplices that may be poor. One thread does it. */
  Work FindWork()
  {
    RefinementWorker<D>& worker = *this->Workers[0];
    std::vector<SimplexId> simplices;
    if (this->Start == RefinementStart::AtSeeds)
    {
      this->Fewest =
        std::max<std::size_t>(FewestEntries, this->Context.Mesh.SimplexIdEnd() / SimplicesPerEntry);
      InsertSeeds<Rules>(this->Context, worker, this->Seeds);
      simplices = this->FindReaching();
    }
    else
    {
      InsertCoarseLattice(this->Context, worker,
        MakeCoarseLattice(this->Context, LatticeSpacing * this->Delta,
          LatticeClearance * this->Delta, this->Threads()));
      worker.ScreensLater = true;
      InsertSeeds<Rules>(this->Context, worker, this->Seeds);
      const double spacing = SampleSpacing * this->Delta;
      InsertSeeds<Rules>(this->Context, worker,
        SampleInterfaces(this->Context, spacing, 0.5 * spacing, this->Threads()));
      worker.ScreensLater = false;
      simplices = this->LivingSimplices();
    }
    this->template Screen<Rules>(worker, simplices.data(), simplices.data() + simplices.size());
    Work work;
    worker.Poor.TakeAll(work.Entries, work.Slivers);
    return work;
  }

  /**
   * Refines with one tiling after the other. What does not fit into the tiles of the last one is
   * refined by one thread.
   * @param putsSliversOff R7 is not applied
   * @return the slivers that were put off
   */
  Work RefineAll(Work work, bool putsSliversOff)
  {
    const Box<D>& box = this->Context.Mesh.GetBox();
    Work slivers;
    for (unsigned pass = 0; work.Size() > 0 && !this->IsStopped(); ++pass)
    {
      std::vector<TileItem<D>> items = this->ItemsOf(work);
      const bool isLittle = items.size() < this->Fewest || pass >= MostTilings;
      std::vector<Tile<D>> tiles =
        isLittle ? TileCutter<D>::Whole(items) : TileCutter<D>::Cut(items, box);
      // If circumballs are too large for tiles, one thread refines the largest.
      const double smallest = tiles.size() == 1 && !isLittle && pass == 0
        ? TileCutter<D>::LargestReach(items, box) / Reach
        : 0.0;
      this->NumberOfTiles += tiles.size() > 1 ? tiles.size() : 0;
      std::vector<TileTask> tasks = this->Distribute(tiles, work);
      this->RefineTiles(tasks, smallest, putsSliversOff);
      work = {};
      for (TileTask& task : tasks)
      {
        if (putsSliversOff)
        {
          slivers.Slivers.insert(
            slivers.Slivers.end(), task.PutOff.Slivers.begin(), task.PutOff.Slivers.end());
          task.PutOff.Slivers.clear();
        }
        work.Append(task.PutOff);
        for (const auto& [region, insertions] : task.Counted)
        {
          this->Context.Work.Add(region, insertions);
        }
      }
    }
    return slivers;
  }

  /**
   * Where the work is: entries, then slivers, then removals. An entry is at its circumcentre. What
   * is void has no item.
   */
  std::vector<TileItem<D>> ItemsOf(const Work& work) const
  {
    constexpr std::size_t grain = 4096;
    constexpr double nothing = -1.0; // a reach
    const Triangulation<D>& mesh = this->Context.Mesh;
    std::vector<TileItem<D>> items(work.Size());
    const auto fill = [&](std::size_t begin, std::size_t end, auto&& itemOf)
    {
      ParallelFor(begin, end, grain, this->Threads(),
        [&](std::size_t first, std::size_t last)
        {
          for (std::size_t i = first; i < last; ++i)
          {
            items[i] = itemOf(i - begin);
            items[i].Number = static_cast<std::uint32_t>(i);
          }
        });
    };
    const auto itemOfEntry = [&](const Entry& e)
    {
      if (!this->IsAlive(e))
      {
        return TileItem<D>{ {}, nothing, 0 };
      }
      const Circumball<D> ball = mesh.GetCircumball(e.Id);
      return TileItem<D>{ ball.Center, Reach * std::sqrt(ball.Radius2), 0 };
    };
    const std::size_t slivers = work.Entries.size();
    const std::size_t removals = slivers + work.Slivers.size();
    fill(0, slivers, [&](std::size_t i) { return itemOfEntry(work.Entries[i]); });
    fill(slivers, removals, [&](std::size_t i) { return itemOfEntry(work.Slivers[i]); });
    fill(removals, items.size(),
      [&](std::size_t i)
      {
        const PendingRemoval<D>& removal = work.Removals[i];
        const auto& vertex = mesh.GetVertex(removal.Vertex);
        const bool isDue = vertex.Alive && vertex.Position == removal.Position;
        return TileItem<D>{ mesh.Position(removal.Feature), isDue ? removal.Radius : nothing, 0 };
      });
    std::erase_if(items, [](const TileItem<D>& item) { return item.Reach == nothing; });
    return items;
  }

  /** Items that do not fit into their tiles are put off, so no thread looks at them. */
  static std::vector<TileTask> Distribute(const std::vector<Tile<D>>& tiles, const Work& work)
  {
    const std::size_t slivers = work.Entries.size();
    const std::size_t removals = slivers + work.Slivers.size();
    const auto select = [&](const std::vector<std::uint32_t>& items)
    {
      Work selected;
      for (const std::uint32_t i : items)
      {
        if (i < slivers)
        {
          selected.Entries.push_back(work.Entries[i]);
        }
        else if (i < removals)
        {
          selected.Slivers.push_back(work.Slivers[i - slivers]);
        }
        else
        {
          selected.Removals.push_back(work.Removals[i - removals]);
        }
      }
      return selected;
    };
    std::vector<TileTask> tasks;
    for (const Tile<D>& tile : tiles)
    {
      tasks.push_back({ tile.Extent, select(tile.Inside), select(tile.Across), {} });
    }
    return tasks;
  }

  /** @param smallest simplices with a smaller circumradius are put off */
  void RefineTiles(std::vector<TileTask>& tasks, double smallest, bool putsSliversOff)
  {
    std::vector<std::size_t> order(tasks.size()); // long tasks first
    std::iota(order.begin(), order.end(), std::size_t{ 0 });
    std::stable_sort(order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return tasks[a].ToDo.Size() > tasks[b].ToDo.Size(); });
    std::atomic<std::size_t> next{ 0 };
    std::atomic<std::size_t> unfinished{ tasks.size() };
    const std::size_t threads =
      this->Sharing ? this->Workers.size() : std::min(tasks.size(), this->Workers.size());
    ParallelFor(0, threads, 1, this->Threads(),
      [&](std::size_t thread, std::size_t)
      {
        // Ids of a single tile are not replaced, so they must come from the first worker, as those before.
        const bool mayTake = thread == 0 || order.size() > 1;
        for (std::size_t k = mayTake ? next++ : order.size(); k < order.size(); k = next++)
        {
          const Finished finished(unfinished);
          this->RefineTile(*this->Workers[thread], tasks[order[k]], smallest, putsSliversOff);
        }
        while (this->Sharing && unfinished != 0)
        {
          this->Sharing->HelpUntil(
            static_cast<unsigned>(thread), [&unfinished] { return unfinished == 0; });
        }
      });
  }

  void RefineTile(RefinementWorker<D>& me, TileTask& task, double smallest, bool putsSliversOff)
  {
    WorkerZone<D> zone{ task.Extent, putsSliversOff, false, {} };
    me.Zone = &zone;
    me.Kernel.Zone = &zone.Extent;
    for (const Entry& e : task.ToDo.Entries)
    {
      me.Poor.Push(e.Id, e.Generation);
    }
    for (const Entry& e : task.ToDo.Slivers)
    {
      me.Poor.PushLast(e.Id, e.Generation);
    }
    me.PendingRemovals = std::move(task.ToDo.Removals);
    task.ToDo = {};
    Rules rules(this->Context, me);
    std::uint64_t turns = 0;
    while (this->MayGoOn(turns))
    {
      if (!me.PendingRemovals.empty())
      {
        this->RemovePending(me, rules, task.PutOff);
      }
      else if (putsSliversOff ? me.Poor.OnlyLast() : me.Poor.Empty())
      {
        break;
      }
      else
      {
        this->RefineNext(me, rules, smallest, task.PutOff);
      }
    }
    me.Poor.TakeAll(task.PutOff.Entries, task.PutOff.Slivers);
    me.PendingRemovals.clear();
    me.Zone = nullptr;
    me.Kernel.Zone = nullptr;
    task.Counted = std::move(zone.Work);
  }

  void RemovePending(RefinementWorker<D>& me, Rules& rules, Work& putOff)
  {
    const PendingRemoval<D> removal = me.PendingRemovals.back();
    if (rules.RemovePending() == RuleOutcome::Contended)
    {
      me.PendingRemovals.pop_back();
      putOff.Removals.push_back(removal);
    }
  }

  void RefineNext(RefinementWorker<D>& me, Rules& rules, double smallest, Work& putOff)
  {
    const Entry e = me.Poor.Pop();
    if (!this->IsAlive(e))
    {
      return;
    }
    me.Zone->HasLeft = false;
    const RuleOutcome outcome =
      this->Fits(me, e, smallest) ? rules.Refine(e.Id) : RuleOutcome::Contended;
    if (outcome == RuleOutcome::Contended || (outcome == RuleOutcome::Good && me.Zone->HasLeft))
    {
      putOff.Entries.push_back(e);
    }
    else if (outcome == RuleOutcome::Changed && this->IsAlive(e))
    {
      me.Poor.Push(e.Id, e.Generation);
    }
  }

  /** Whether a living simplex and its surroundings are in the worker's tile. */
  bool Fits(RefinementWorker<D>& me, const Entry& e, double smallest)
  {
    if (this->Context.Mesh.Lock(me.Kernel, e.Id, e.Generation) != LockOutcome::Locked)
    {
      return false;
    }
    const Circumball<D> ball = this->Context.Mesh.GetCircumball(e.Id);
    return !(ball.Radius2 < smallest * smallest) &&
      me.Zone->Extent.ContainsBall(ball.Center, Reach * std::sqrt(ball.Radius2));
  }

  /** Asks the caller now and then. */
  bool MayGoOn(std::uint64_t& turns)
  {
    if ((++turns & 255u) == 0 && *this->GoOn && !(*this->GoOn)(this->Context.Mesh.VertexIdEnd()))
    {
      this->Stopped.store(true, std::memory_order_relaxed);
    }
    return !this->IsStopped();
  }

  const std::vector<FeatureSeed<D>> Seeds;
  const RefinementStart Start;
  std::unique_ptr<LoopSharing> Sharing; ///< null if threads do not help each other
  const double Delta; ///< a uniform sampling distance that gives about as many vertices
  std::size_t Fewest = FewestEntries;
  std::size_t NumberOfTiles = 0;
  const Monitor* GoOn = nullptr;
  std::atomic<bool> Stopped{ false };
};

} // namespace voxplex

#endif

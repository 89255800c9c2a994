// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause

#include "Refinement/Tiles/TiledRefiner.h"

#include "Refinement/Rules/Seeding.h"
#include "Refinement/Tiles/CoarseLattice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace voxplex
{

namespace
{

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

} // namespace

template <typename Rules>
TiledRefiner<Rules>::TiledRefiner(RefinementContext<D>& context, const TeamOptions& options,
  std::vector<FeatureSeed<D>> seeds, RefinementStart start)
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

template <typename Rules>
bool TiledRefiner<Rules>::Run(const Monitor& goOn)
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

template <typename Rules>
std::vector<ThreadStatistics> TiledRefiner<Rules>::GetThreadStatistics() const
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

template <typename Rules>
auto TiledRefiner<Rules>::FindWork() -> Work
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
      MakeCoarseLattice(this->Context, LatticeSpacing * this->Delta, LatticeClearance * this->Delta,
        this->Threads()));
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

template <typename Rules>
auto TiledRefiner<Rules>::RefineAll(Work work, bool defersSlivers) -> Work
{
  const Box<D>& box = this->Context.Mesh.GetBox();
  Work slivers;
  for (unsigned pass = 0; work.Size() > 0 && !this->IsStopped(); ++pass)
  {
    std::vector<TileItem<D>> items = this->MakeItems(work);
    const bool isLittle = items.size() < this->Fewest || pass >= MostTilings;
    std::vector<Tile<D>> tiles =
      (isLittle ? TileCutter<D>::Whole(items) : TileCutter<D>::Cut(items, box)).Tiles;
    // If circumballs are too large for tiles, one thread refines the largest.
    const double smallest = tiles.size() == 1 && !isLittle && pass == 0
      ? TileCutter<D>::LargestReach(items, box) / Reach
      : 0.0;
    this->NumberOfTiles += tiles.size() > 1 ? tiles.size() : 0;
    std::vector<TileTask> tasks = this->Distribute(tiles, work);
    this->RefineTiles(tasks, smallest, defersSlivers);
    work = {};
    for (TileTask& task : tasks)
    {
      if (defersSlivers)
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

template <typename Rules>
auto TiledRefiner<Rules>::MakeItems(const Work& work) const -> std::vector<TileItem<D>>
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

template <typename Rules>
auto TiledRefiner<Rules>::Distribute(const std::vector<Tile<D>>& tiles, const Work& work)
  -> std::vector<TileTask>
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

template <typename Rules>
void TiledRefiner<Rules>::RefineTiles(
  std::vector<TileTask>& tasks, double smallest, bool defersSlivers)
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
        this->RefineTile(*this->Workers[thread], tasks[order[k]], smallest, defersSlivers);
      }
      while (this->Sharing && unfinished != 0)
      {
        this->Sharing->HelpUntil(
          static_cast<unsigned>(thread), [&unfinished] { return unfinished == 0; });
      }
    });
}

template <typename Rules>
void TiledRefiner<Rules>::RefineTile(
  RefinementWorker<D>& me, TileTask& task, double smallest, bool defersSlivers)
{
  WorkerZone<D> zone{ task.Extent, defersSlivers, false, {} };
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
    else if (defersSlivers ? me.Poor.OnlyLast() : me.Poor.Empty())
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

template <typename Rules>
void TiledRefiner<Rules>::RemovePending(RefinementWorker<D>& me, Rules& rules, Work& putOff)
{
  const PendingRemoval<D> removal = me.PendingRemovals.back();
  if (rules.RemovePending() == RuleOutcome::Contended)
  {
    me.PendingRemovals.pop_back();
    putOff.Removals.push_back(removal);
  }
}

template <typename Rules>
void TiledRefiner<Rules>::RefineNext(
  RefinementWorker<D>& me, Rules& rules, double smallest, Work& putOff)
{
  const Entry e = me.Poor.Pop();
  if (!this->IsAlive(e))
  {
    return;
  }
  me.Zone->NeedsOutside = false;
  const RuleOutcome outcome =
    this->Fits(me, e, smallest) ? rules.Refine(e.Id) : RuleOutcome::Contended;
  if (outcome == RuleOutcome::Contended || (outcome == RuleOutcome::Good && me.Zone->NeedsOutside))
  {
    putOff.Entries.push_back(e);
  }
  else if (outcome == RuleOutcome::Changed && this->IsAlive(e))
  {
    me.Poor.Push(e.Id, e.Generation);
  }
}

template <typename Rules>
bool TiledRefiner<Rules>::Fits(RefinementWorker<D>& me, const Entry& e, double smallest)
{
  if (this->Context.Mesh.Lock(me.Kernel, e.Id, e.Generation) != LockOutcome::Locked)
  {
    return false;
  }
  const Circumball<D> ball = this->Context.Mesh.GetCircumball(e.Id);
  return !(ball.Radius2 < smallest * smallest) &&
    me.Zone->Extent.ContainsBall(ball.Center, Reach * std::sqrt(ball.Radius2));
}

template <typename Rules>
bool TiledRefiner<Rules>::MayGoOn(std::uint64_t& turns)
{
  if ((++turns & 255u) == 0 && *this->GoOn && !(*this->GoOn)(this->Context.Mesh.VertexIdEnd()))
  {
    this->Stopped.store(true, std::memory_order_relaxed);
  }
  return !this->IsStopped();
}

template class TiledRefiner<Rules3D>;
template class TiledRefiner<Rules4D>;

} // namespace voxplex

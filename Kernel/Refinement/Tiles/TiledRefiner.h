// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TiledRefiner.h
 * @brief Refinement whose result does not depend on the number of threads.
 */
#ifndef voxplex_TiledRefiner_h
#define voxplex_TiledRefiner_h

#include "Refinement/RefinerBase.h"
#include "Refinement/Rules/FeatureSeed.h"
#include "Refinement/Rules/Rules3D.h"
#include "Refinement/Rules/Rules4D.h"
#include "Refinement/Scheduling/TeamOptions.h"
#include "Geometry/Tiles.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <unordered_map>
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
 * An element is put off if it cannot be refined inside of its tile: for example, if its cavity has
 * a vertex outside. When all tiles are done, space is cut elsewhere, and the elements that were put
 * off are tried again. What is left after some tilings is refined by one thread. Slivers come last,
 * as in Refiner.
 *
 * The order of all lists is that of tiles, not that of threads. Ids depend on threads. No rule asks
 * for their order, and in the end they are replaced (Triangulation::Renumber).
 *
 * A coarse lattice of points (MakeCoarseLattice) and a coarse sample of the interfaces make
 * circumballs small compared with tiles from the start.
 *
 * Rules is Rules3D or Rules4D.
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
    std::vector<FeatureSeed<D>> seeds = {}, RefinementStart start = RefinementStart::Everywhere);

  /**
   * Refines until no rule applies. Call it once.
   * @return false if goOn stopped refinement
   * @throws std::bad_alloc
   */
  bool Run(const Monitor& goOn);

  std::vector<ThreadStatistics> GetThreadStatistics() const;

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
  Work FindWork();

  /**
   * Refines with one tiling after the other. What does not fit into the tiles of the last one is
   * refined by one thread.
   * @param defersSlivers the sliver rule is not applied
   * @return the slivers that were put off
   */
  Work RefineAll(Work work, bool defersSlivers);

  /**
   * Where the work is: entries, then slivers, then removals. An entry is at its circumcentre. What
   * is void has no item.
   */
  std::vector<TileItem<D>> MakeItems(const Work& work) const;

  /** Items that do not fit into their tiles are put off, so no thread looks at them. */
  static std::vector<TileTask> Distribute(const std::vector<Tile<D>>& tiles, const Work& work);

  /** @param smallest simplices with a smaller circumradius are put off */
  void RefineTiles(std::vector<TileTask>& tasks, double smallest, bool defersSlivers);

  void RefineTile(RefinementWorker<D>& me, TileTask& task, double smallest, bool defersSlivers);

  void RemovePending(RefinementWorker<D>& me, Rules& rules, Work& putOff);

  void RefineNext(RefinementWorker<D>& me, Rules& rules, double smallest, Work& putOff);

  /** Whether a living simplex and its surroundings are in the worker's tile. */
  bool Fits(RefinementWorker<D>& me, const Entry& e, double smallest);

  /** Asks the caller now and then. */
  bool MayGoOn(std::uint64_t& turns);

  const std::vector<FeatureSeed<D>> Seeds;
  const RefinementStart Start;
  std::unique_ptr<LoopSharing> Sharing; ///< null if threads do not help each other
  const double Delta; ///< a uniform sampling distance that gives about as many vertices
  std::size_t Fewest = FewestEntries;
  std::size_t NumberOfTiles = 0;
  const Monitor* GoOn = nullptr;
  std::atomic<bool> Stopped{ false };
};

extern template class TiledRefiner<Rules3D>;
extern template class TiledRefiner<Rules4D>;

} // namespace voxplex

#endif

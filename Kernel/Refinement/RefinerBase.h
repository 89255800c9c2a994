// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinerBase.h
 * @brief What the ways to refine have in common: workers, their results, where refinement starts.
 */
#ifndef voxplex_RefinerBase_h
#define voxplex_RefinerBase_h

#include "Parallel/ParallelCollect.h"
#include "Refinement/RefinementContext.h"
#include "Sizing/LoweredCells.h"

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace voxplex
{

/** The simplices that are judged by the rules first. */
enum class RefinementStart
{
  Everywhere,
  AtSeeds ///< and where LocalDelta has lowered bounds
};

/** @brief The base of Refiner and TiledRefiner. */
template <int D>
class RefinerBase
{
public:
  /**
   * Called every few hundred evaluations with the number of vertices so far. Several threads may
   * call it at once. If it returns false, refinement stops.
   */
  using Monitor = std::function<bool(std::uint64_t vertices)>;

  /** The sum over all threads. */
  RuleStatistics GetRuleStatistics() const
  {
    RuleStatistics sum;
    for (const auto& worker : this->Workers)
    {
      sum += worker->Statistics;
      sum.Created += worker->Kernel.NumberOfCreated;
    }
    return sum;
  }
  /** The regions where rules began to give way, of all threads. */
  std::vector<RelaxedRegion<D>> GetRelaxedRegions() const
  {
    std::vector<RelaxedRegion<D>> regions;
    for (const auto& worker : this->Workers)
    {
      regions.insert(regions.end(), worker->RelaxedRegions.begin(), worker->RelaxedRegions.end());
    }
    return regions;
  }
  PredicateStatistics GetPredicateStatistics() const
  {
    PredicateStatistics sum;
    for (const auto& worker : this->Workers)
    {
      sum += worker->Kernel.GetPredicateStatistics();
    }
    return sum;
  }

protected:
  explicit RefinerBase(RefinementContext<D>& context)
    : Context(context)
  {
  }
  ~RefinerBase() = default;

  bool IsAlive(const PoorElementList::Entry& e) const
  {
    return this->Context.Mesh.State(e.Id).CurrentGeneration() == e.Generation;
  }

  /** From now on workers may help each other. Call it when all of them are there. */
  void HelpEachOther(LoopSharing& sharing)
  {
    for (const auto& worker : this->Workers)
    {
      worker->Kernel.Help.Sharing = &sharing;
      worker->Kernel.Help.Number = static_cast<unsigned>(this->Helpers.size());
      worker->Kernel.Help.Team = &this->Helpers;
      this->Helpers.push_back(&worker->Kernel);
    }
  }

  /** Ascending. */
  std::vector<SimplexId> LivingSimplices() const
  {
    std::vector<SimplexId> simplices;
    for (SimplexId s = 0; s < this->Context.Mesh.SimplexIdEnd(); ++s)
    {
      if (this->Context.Mesh.IsAlive(s))
      {
        simplices.push_back(s);
      }
    }
    return simplices;
  }

  /** The simplices whose circumball reaches a lowered bound, ascending. */
  std::vector<SimplexId> FindReaching() const
  {
    const LocalDelta<D>* const local = this->Context.Sizing.Sources().Local;
    if (!local || !local->HasLowered())
    {
      return {};
    }
    const Triangulation<D>& mesh = this->Context.Mesh;
    const LoweredCells<D> lowered(*local);
    constexpr std::size_t grain = 8192;
    return ParallelCollect<SimplexId>(mesh.SimplexIdEnd(), grain,
      static_cast<unsigned>(this->Workers.size()),
      [&](std::size_t first, std::size_t last, std::vector<SimplexId>& reaching)
      {
        for (auto s = static_cast<SimplexId>(first); s < last; ++s)
        {
          if (mesh.State(s).NearSurface && mesh.IsAlive(s))
          {
            const Circumball<D> ball = mesh.GetCircumball(s);
            if (lowered.AnyWithin(ball.Center, std::sqrt(ball.Radius2)))
            {
              reaching.push_back(s);
            }
          }
        }
      });
  }

  /** Pushes the simplices that may be poor to a worker's list. */
  template <typename Rules>
  void Screen(RefinementWorker<D>& worker, const SimplexId* first, const SimplexId* last)
  {
    worker.Kernel.Created.Clear();
    for (; first != last; ++first)
    {
      worker.Kernel.Created.ReserveMore(1);
      worker.Kernel.Created.Push(*first);
    }
    Rules(this->Context, worker).ScreenCreated();
  }

  RefinementContext<D>& Context;
  std::vector<std::unique_ptr<RefinementWorker<D>>> Workers;

private:
  std::vector<typename Triangulation<D>::Worker*> Helpers; ///< see HelpEachOther()
};

} // namespace voxplex

#endif

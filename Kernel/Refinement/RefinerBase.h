// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinerBase.h
 * @brief What the ways to refine have in common: workers, their results, where refinement starts.
 */
#ifndef voxplex_RefinerBase_h
#define voxplex_RefinerBase_h

#include "Refinement/RefinementContext.h"
#include "Sizing/LoweredCells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

  /**
   * The simplices whose circumball reaches a lowered bound, ascending. Those of a cell hang together
   * through facets: they are found from the one at a point of it.
   */
  std::vector<SimplexId> FindReaching()
  {
    const LocalDelta<D>* const local = this->Context.Sizing.Sources().Local;
    if (!local || !local->HasLowered())
    {
      return {};
    }
    const Triangulation<D>& mesh = this->Context.Mesh;
    const LoweredCells<D> lowered(*local);
    std::vector<bool> isSeen(mesh.SimplexIdEnd());
    std::vector<SimplexId> reaching;
    const auto look = [&](SimplexId s)
    {
      if (s != None && !isSeen[s])
      {
        isSeen[s] = true;
        const Circumball<D> ball = mesh.GetCircumball(s);
        if (lowered.AnyWithin(ball.Center, std::sqrt(ball.Radius2)))
        {
          reaching.push_back(s);
        }
      }
    };
    SimplexId near = mesh.FirstAlive();
    for (const auto& cell : local->Lowered())
    {
      for (const double fraction : { 0.5, 0.4, 0.6 }) // there may be a vertex
      {
        const Point<D> p = mesh.GetBox().Clamp(local->PointIn(cell, fraction));
        const SimplexId at = mesh.FindConflict(this->Workers[0]->Kernel, p, near);
        if (at != None)
        {
          near = at;
          look(at);
          break;
        }
      }
    }
    for (std::size_t k = 0; k < reaching.size(); ++k)
    {
      for (const SimplexId s : mesh.GetSimplex(reaching[k]).N)
      {
        look(s);
      }
    }
    std::erase_if(reaching, [&](SimplexId s) { return !mesh.State(s).NearSurface; });
    std::sort(reaching.begin(), reaching.end());
    return reaching;
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

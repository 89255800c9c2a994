// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldLabels.h"

#include "Base/UninitialisedVector.h"
#include "Conformity/ChangeRules.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/RepairNeighbourhood.h"
#include "Parallel/ParallelCollect.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 8192;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
ManifoldLabeller<D>::ManifoldLabeller(Triangulation<D>& triangulation,
  const ManifoldRepairOptions<D>& options, unsigned threads, const std::stop_token& stop)
  : Source(triangulation)
  , Labels(triangulation.Labels())
  , Options(options)
  , Threads(threads)
  , Stop(stop)
{
}

template <int D>
ManifoldLabels<D> ManifoldLabeller<D>::Take()
{
  ManifoldLabels<D> made;
  made.New = this->TakeLabels();
  const auto given = std::stable_partition(made.New.begin(), made.New.end(),
    [this](SimplexId s) { return !this->Source.State(s).Examined; });
  const Simplices taken = this->TakeBack({ given, made.New.end() });
  made.New.erase(given, made.New.end());
  made.New.insert(made.New.end(), taken.begin(), taken.end());
  this->Mark(made.New);
  return made;
}

template <int D>
ManifoldLabels<D> ManifoldLabeller<D>::Repair(
  ManifoldLabels<D> made, GapOptions gaps, InterfaceStatistics& statistics)
{
  const Simplices fresh = std::exchange(made.New, {});
  Simplices given; // labels by layers, pieces and ridges
  Simplices changed = fresh;
  const bool areFew = this->AreFew(changed);
  const auto add = [&](const Simplices& some)
  {
    given.insert(given.end(), some.begin(), some.end());
    changed.insert(changed.end(), some.begin(), some.end());
  };
  if (this->Options.Contacts)
  {
    const bool areMost = 2 * changed.size() > this->Labels.size();
    if (!areMost)
    {
      std::sort(changed.begin(), changed.end());
    }
    made.Layers = FindHiddenLayers<D>(this->Source, this->Labels, areMost ? nullptr : &changed,
      this->Options, this->Threads, this->Stop);
    add(ShowHiddenLayers<D>(
      this->Source, this->Labels, made.Layers, this->Options, this->Threads, this->Stop));
  }
  if (this->Options.Kept)
  {
    JoinedPieces<D> joined =
      JoinPieces<D>(this->Source, this->Labels, this->Options, gaps, this->Threads, this->Stop);
    add(joined.Relabelled);
    made.Gaps = std::move(joined.Gaps);
  }
  const std::vector<InterfaceRidge<D>> ridges = areFew
    ? FindNonManifoldRidgesOf<D>(this->Source, this->Labels, changed, this->Threads, this->Stop)
    : FindNonManifoldRidges<D>(this->Source, this->Labels, this->Threads, this->Stop);
  ManifoldRepairResult<D> result =
    RepairManifold<D>(this->Source, this->Labels, ridges, this->Options, this->Threads, this->Stop);
  statistics.NonManifoldRepaired += ridges.size() - result.Left.size();
  statistics.NonManifoldLeft = result.Left.size();
  made.NonManifold = std::move(result.Left);
  for (const InterfaceRidge<D>& ridge : made.NonManifold)
  {
    made.Places.push_back(Centroid(this->Source.Points(ridge.Vertices)));
  }
  std::erase_if(made.Layers,
    [&](const HiddenLayer<D>& layer)
    {
      const HiddenLayerFinder<D> finder(this->Source, this->Labels, this->Options);
      return !finder.Find(layer.Cell, layer.Facet);
    });
  add(result.Relabelled);
  this->Mark(given);
  this->Examine(fresh, made);
  return made;
}

/** If there are more, it takes less time to look at all simplices. */
template <int D>
bool ManifoldLabeller<D>::AreFew(const Simplices& some) const
{
  constexpr std::size_t Share = 32;
  return some.size() <= this->Source.SimplexIdEnd() / Share;
}

template <int D>
void ManifoldLabeller<D>::Mark(const Simplices& changed)
{
  if (this->AreFew(changed))
  {
    MarkInterfaceVerticesOf<D>(this->Source, this->Labels, changed, this->Threads, this->Stop);
  }
  else
  {
    MarkInterfaceVertices<D>(this->Source, this->Labels, this->Threads, this->Stop);
  }
}

/**
 * Gives simplices that are not examined the labels at their circumcentres.
 * @return those, and in 3D the examined ones that have other labels: a repair has given them
 */
template <int D>
auto ManifoldLabeller<D>::TakeLabels() -> Simplices
{
  const std::size_t ids = this->Source.SimplexIdEnd();
  this->Labels.resize(ids);
  return ParallelCollect<SimplexId>(
    ids, Grain, this->Threads,
    [&](std::size_t first, std::size_t last, Simplices& some)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        if (!this->Source.IsAlive(s))
        {
          this->Labels[s] = 0;
        }
        else if (!this->Source.State(s).Examined)
        {
          this->Labels[s] = this->LabelAtCentre(s);
          some.push_back(s);
        }
        else if (D == 3 && this->Labels[s] != this->LabelAtCentre(s)) // in 4D no facet is too sharp
        {
          some.push_back(s);
        }
      }
    },
    this->Stop);
}

/**
 * Takes labels back that repairs have given, where an interface facet is too sharp. Repairs do not make such a facet.
 * But refinement makes new ones beside the simplex, and takes junctions away. Its facet rule does not judge this one, since
 * the labels at both circumcentres are the same.
 * @param given the simplices with such labels
 * @return those that have lost one
 */
template <int D>
auto ManifoldLabeller<D>::TakeBack(const Simplices& given) -> Simplices
{
  SimplexLabels& labels = this->Labels;
  const repair::Neighbourhood<D> near(this->Source, labels);
  const repair::ChangeRules<D> rules(near, labels, this->Options);
  const auto isTooSharp = [&](SimplexId s)
  {
    const auto& beside = this->Source.GetSimplex(s).N;
    for (unsigned i = 0; i <= D; ++i)
    {
      if (beside[i] != None && labels[beside[i]] != labels[s] &&
        this->LabelAtCentre(beside[i]) == this->LabelAtCentre(s) && !rules.HasGoodAngles(s, i, {}))
      {
        return true;
      }
    }
    return false;
  };
  Simplices taken;
  for (bool isAgain = true; isAgain;) // what is taken may make facets beside it sharp
  {
    isAgain = false;
    for (const SimplexId s : given)
    {
      if (labels[s] != this->LabelAtCentre(s) && isTooSharp(s))
      {
        this->Source.State(s).Examined = false;
        labels[s] = this->LabelAtCentre(s);
        taken.push_back(s);
        isAgain = true;
      }
    }
  }
  return taken;
}

/** Nothing is to be done around the fresh simplices, except around what is left. */
template <int D>
void ManifoldLabeller<D>::Examine(const Simplices& fresh, const ManifoldLabels<D>& made)
{
  for (const SimplexId s : fresh)
  {
    this->Source.State(s).Examined = true;
  }
  const repair::Neighbourhood<D> near(this->Source, this->Labels);
  for (const HiddenLayer<D>& layer : made.Layers)
  {
    this->Source.State(layer.Cell).Examined = false;
  }
  for (const InterfaceRidge<D>& ridge : made.NonManifold)
  {
    for (const SimplexId s : near.StarOf(ridge.Vertices))
    {
      this->Source.State(s).Examined = false;
    }
  }
}

template class ManifoldLabeller<3>;
template class ManifoldLabeller<4>;

} // namespace voxplex

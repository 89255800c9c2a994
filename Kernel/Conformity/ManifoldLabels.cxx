// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldLabels.h"

#include "Base/UninitialisedVector.h"
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
  , Options(options)
  , Threads(threads)
  , Stop(stop)
{
}

template <int D>
ManifoldLabels<D> ManifoldLabeller<D>::Take()
{
  ManifoldLabels<D> made;
  made.New = this->TakeLabels(made.Labels);
  this->Mark(made.Labels, made.New);
  return made;
}

template <int D>
ManifoldLabels<D> ManifoldLabeller<D>::Repair(
  ManifoldLabels<D> made, GapOptions gaps, InterfaceStatistics& statistics)
{
  std::vector<SimplexId> changed = std::exchange(made.New, {});
  const bool areFew = this->AreFew(changed);
  if (this->Options.Contacts)
  {
    std::sort(changed.begin(), changed.end());
    const bool areMost = 2 * changed.size() > made.Labels.size();
    made.Layers = FindHiddenLayers<D>(this->Source, made.Labels, areMost ? nullptr : &changed,
      this->Options, this->Threads, this->Stop);
    const std::vector<SimplexId> shown = ShowHiddenLayers<D>(
      this->Source, made.Labels, made.Layers, this->Options, this->Threads, this->Stop);
    changed.insert(changed.end(), shown.begin(), shown.end());
  }
  if (this->Options.Kept)
  {
    JoinedPieces<D> joined =
      JoinPieces<D>(this->Source, made.Labels, this->Options, gaps, this->Stop);
    changed.insert(changed.end(), joined.Relabelled.begin(), joined.Relabelled.end());
    made.Gaps = std::move(joined.Gaps);
  }
  const std::vector<InterfaceRidge<D>> ridges = areFew
    ? FindNonManifoldRidgesOf<D>(this->Source, made.Labels, changed, this->Threads, this->Stop)
    : FindNonManifoldRidges<D>(this->Source, made.Labels, this->Threads, this->Stop);
  ManifoldRepairResult<D> result =
    RepairManifold<D>(this->Source, made.Labels, ridges, this->Options, this->Threads, this->Stop);
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
      const HiddenLayerFinder<D> finder(this->Source, made.Labels, this->Options);
      return !finder.Find(layer.Cell, layer.Facet);
    });
  this->Mark(made.Labels, this->KeepLabels(made));
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
void ManifoldLabeller<D>::Mark(const SimplexLabels& labels, const Simplices& changed)
{
  if (this->AreFew(changed))
  {
    MarkInterfaceVerticesOf<D>(this->Source, labels, changed, this->Threads, this->Stop);
  }
  else
  {
    MarkInterfaceVertices<D>(this->Source, labels, this->Threads, this->Stop);
  }
}

/**
 * Gives simplices that are not examined the labels at their circumcentres, and returns them. So it does with
 * those beside them that have been given another label: the bounds that this label keeps are those of
 * facets that are gone.
 */
template <int D>
auto ManifoldLabeller<D>::TakeLabels(SimplexLabels& labels) const -> Simplices
{
  const std::size_t ids = this->Source.SimplexIdEnd();
  labels.resize(ids);
  Simplices fresh = ParallelCollect<SimplexId>(
    ids, Grain, this->Threads,
    [&](std::size_t first, std::size_t last, Simplices& some)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        labels[s] = 0;
        if (!this->Source.IsAlive(s))
        {
          continue;
        }
        SimplexState& state = this->Source.State(s);
        if (!state.Examined)
        {
          state.Given = LabelAtCentre(this->Source, *this->Options.Surfaces, s);
          some.push_back(s);
        }
        labels[s] = state.Given;
      }
    },
    this->Stop);
  const auto appendOutdated = [&](SimplexId of, Simplices& some)
  {
    for (const SimplexId n : this->Source.GetSimplex(of).N)
    {
      if (n != None && this->Source.State(n).Examined &&
        labels[n] != LabelAtCentre(this->Source, *this->Options.Surfaces, n))
      {
        some.push_back(n);
      }
    }
  };
  Simplices outdated = ParallelCollect<SimplexId>(
    fresh.size(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last, Simplices& some)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        appendOutdated(fresh[k], some);
      }
    },
    this->Stop);
  for (std::size_t k = 0; k < outdated.size(); ++k)
  {
    const SimplexId s = outdated[k];
    SimplexState& state = this->Source.State(s);
    if (std::exchange(state.Examined, false))
    {
      labels[s] = state.Given = LabelAtCentre(this->Source, *this->Options.Surfaces, s);
      fresh.push_back(s);
      appendOutdated(s, outdated);
    }
  }
  return fresh;
}

/** Returns the simplices that have another label than TakeLabels() gave them. */
template <int D>
auto ManifoldLabeller<D>::KeepLabels(const ManifoldLabels<D>& made) -> Simplices
{
  const SimplexLabels& labels = made.Labels;
  Simplices changed = ParallelCollect<SimplexId>(
    labels.size(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last, Simplices& some)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        SimplexState& state = this->Source.State(s);
        if (this->Source.IsAlive(s))
        {
          if (std::exchange(state.Given, labels[s]) != labels[s])
          {
            some.push_back(s);
          }
          state.Examined = true;
        }
      }
    },
    this->Stop);
  const repair::Neighbourhood<D> near(this->Source, labels);
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
  return changed;
}

template class ManifoldLabeller<3>;
template class ManifoldLabeller<4>;

} // namespace voxplex

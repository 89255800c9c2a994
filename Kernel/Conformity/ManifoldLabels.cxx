// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldLabels.h"

#include "Base/UninitialisedVector.h"
#include "Conformity/Crumbs.h"
#include "Delaunay/VertexStar.h"
#include "Parallel/ParallelCollect.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

/** Vertices of these simplices that are inside of a label. */
template <int D>
std::vector<Point<D>> VerticesWithin(const Triangulation<D>& triangulation,
  const SimplexLabels& labels, const std::vector<SimplexId>& simplices, unsigned threads,
  const std::stop_token& stop)
{
  const std::vector<VertexId> vertices = VerticesOf(triangulation, simplices);
  const auto isWithin = [&](VertexId v)
  {
    const SimplexId incident = triangulation.GetVertex(v).Incident;
    return !AnyInStar(triangulation, v, incident,
      [&, label = labels[incident]](SimplexId s) { return labels[s] != label; });
  };
  constexpr std::size_t Grain = 256;
  UninitialisedVector<std::uint8_t> areWithin(vertices.size());
  ParallelFor(
    0, vertices.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        areWithin[k] = isWithin(vertices[k]) ? 1 : 0;
      }
    },
    stop);
  std::vector<Point<D>> within;
  for (std::size_t k = 0; k < vertices.size(); ++k)
  {
    if (areWithin[k] != 0)
    {
      within.push_back(triangulation.Position(vertices[k]));
    }
  }
  return within;
}

template <int D>
Point<D> CentroidOf(const Triangulation<D>& triangulation,
  const std::array<VertexId, static_cast<std::size_t>(D - 1)>& v)
{
  Point<D> centroid = triangulation.Position(v[0]);
  for (std::size_t a = 0; a < centroid.size(); ++a)
  {
    double sum = 0.0;
    for (std::size_t k = 1; k < v.size(); ++k)
    {
      sum += triangulation.Position(v[k])[a] - triangulation.Position(v[0])[a];
    }
    centroid[a] += sum / static_cast<double>(v.size());
  }
  return centroid;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
ManifoldLabeller<D>::ManifoldLabeller(const Triangulation<D>& triangulation,
  const ManifoldRepairOptions<D>& options, unsigned threads, const std::stop_token& stop)
  : Source(triangulation)
  , Options(options)
  , Threads(threads)
  , Stop(stop)
  , Seen(triangulation)
{
}

template <int D>
SimplexLabels ManifoldLabeller<D>::MakePlain() const
{
  return LabelSimplices(this->Source, *this->Options.Surfaces, this->Threads, this->Stop);
}

template <int D>
void ManifoldLabeller<D>::Forget()
{
  this->Seen.Forget();
  this->Small = std::vector<SimplexId>();
  this->Crumbs = {};
  this->Ridges = std::vector<InterfaceRidge<D>>();
  this->Relabelled = {};
  this->Repaired = {};
}

template <int D>
ManifoldLabels<D> ManifoldLabeller<D>::Make(InterfaceStatistics& statistics)
{
  ManifoldLabels<D> made;
  made.Labels = this->MakePlain();
  const bool isFirst = this->Seen.IsEmpty();
  const Some added = isFirst ? std::nullopt : this->FindNew();
  std::vector<SimplexId> relabelled;
  if constexpr (D == 3)
  {
    this->Small = added && this->AreFew(*added)
      ? UpdateSmallFragments(
          this->Source, made.Labels, this->Small, *added, this->Threads, this->Stop)
      : FindSmallFragments(this->Source, made.Labels, this->Threads, this->Stop);
    if (added)
    {
      this->Relabelled.Changed = VerticesOf(this->Source, *added);
    }
    else
    {
      this->Relabelled = {};
    }
    relabelled = RelabelCrumbs(this->Source, made.Labels, this->Small, this->Options, this->Threads,
      this->Stop, &this->Relabelled);
  }
  const Some changed = this->FindChanged(made.Labels, added, relabelled);
  this->FindRidges(made.Labels, changed);
  if (isFirst) // not before the lists of facets, which need most memory, are gone
  {
    this->FindNew();
  }
  ManifoldRepairResult<D> result = RepairManifold<D>(this->Source, made.Labels, this->Ridges,
    this->Options, this->Threads, this->Stop, &this->Repaired);
  statistics.NonManifoldRepaired = this->Ridges.size() - result.Left.size();
  statistics.NonManifoldLeft = result.Left.size();
  made.NonManifold = std::move(result.Left);
  for (const InterfaceRidge<D>& ridge : made.NonManifold)
  {
    made.Places.push_back({ CentroidOf(this->Source, ridge.Vertices), ridge.IsJunction });
  }
  relabelled.insert(relabelled.end(), result.Relabelled.begin(), result.Relabelled.end());
  made.Gone = VerticesWithin(this->Source, made.Labels, relabelled, this->Threads, this->Stop);
  return made;
}

/** The simplices that are new since the last call. */
template <int D>
auto ManifoldLabeller<D>::FindNew() -> Some
{
  this->Seen.MakeRoom();
  constexpr std::size_t Grain = 8192;
  constexpr std::size_t Share = 4;
  const std::size_t most = this->Source.SimplexIdEnd() / Share;
  std::atomic<std::size_t> number{ 0 };
  std::vector<SimplexId> all = ParallelCollect<SimplexId>(
    this->Source.SimplexIdEnd(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last, std::vector<SimplexId>& found)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        if (this->Seen.See(s))
        {
          found.push_back(s);
        }
      }
      if (number.fetch_add(found.size(), std::memory_order_relaxed) + found.size() > most)
      {
        found = {};
      }
    },
    this->Stop);
  return number.load() > most ? std::nullopt : Some(std::move(all));
}

/**
 * The simplices that are new, or have another label than in the last call.
 * @param added the new simplices
 * @param crumbs those that have another label than that at their circumcentre, ascending
 */
template <int D>
auto ManifoldLabeller<D>::FindChanged(
  const SimplexLabels& labels, Some added, const std::vector<SimplexId>& crumbs) -> Some
{
  std::vector<std::pair<SimplexId, LabelId>> now;
  now.reserve(crumbs.size());
  for (const SimplexId s : crumbs)
  {
    now.push_back({ s, labels[s] });
  }
  if (added)
  {
    std::vector<std::pair<SimplexId, LabelId>> other;
    std::set_symmetric_difference(
      this->Crumbs.begin(), this->Crumbs.end(), now.begin(), now.end(), std::back_inserter(other));
    for (const auto& [s, label] : other)
    {
      if (this->Source.IsAlive(s))
      {
        added->push_back(s);
      }
    }
  }
  this->Crumbs = std::move(now);
  return added;
}

/** Finds the ridges that are not manifold with these labels. */
template <int D>
void ManifoldLabeller<D>::FindRidges(const SimplexLabels& labels, const Some& changed)
{
  const std::span<const LabelId> now(labels);
  this->Ridges = changed && this->AreFew(*changed)
    ? UpdateNonManifoldRidges<D>(
        this->Source, now, this->Ridges, *changed, this->Threads, this->Stop)
    : FindNonManifoldRidges<D>(this->Source, now, this->Threads, this->Stop);
  if (changed)
  {
    this->Repaired.Changed = VerticesOf(this->Source, *changed);
  }
  else
  {
    this->Repaired = {};
  }
}

/** Whether it takes less time to look around these than to look at all simplices. */
template <int D>
bool ManifoldLabeller<D>::AreFew(const std::vector<SimplexId>& simplices) const
{
  constexpr std::size_t Share = 32;
  return simplices.size() <= this->Source.SimplexIdEnd() / Share;
}

template class ManifoldLabeller<3>;
template class ManifoldLabeller<4>;

} // namespace voxplex

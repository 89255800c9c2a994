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
  std::vector<VertexId> vertices;
  for (const SimplexId s : simplices)
  {
    const auto& v = triangulation.GetSimplex(s).V;
    vertices.insert(vertices.end(), v.begin(), v.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto isWithin = [&](VertexId v)
  {
    const std::vector<SimplexId> star =
      StarOf(triangulation, v, triangulation.GetVertex(v).Incident);
    return std::all_of(
      star.begin(), star.end(), [&](SimplexId s) { return labels[s] == labels[star.front()]; });
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
  this->Crumbs = std::vector<SimplexId>();
  this->Ridges = std::vector<InterfaceRidge<D>>();
}

template <int D>
ManifoldLabels<D> ManifoldLabeller<D>::Make(InterfaceStatistics& statistics)
{
  ManifoldLabels<D> made;
  made.Labels = this->MakePlain();
  const bool isFirst = this->Seen.IsEmpty();
  const Few added = isFirst ? std::nullopt : this->FindNew();
  std::vector<SimplexId> relabelled;
  if constexpr (D == 3)
  {
    this->Small = added ? UpdateSmallFragments(this->Source, made.Labels, this->Small, *added,
                            this->Threads, this->Stop)
                        : FindSmallFragments(this->Source, made.Labels, this->Threads, this->Stop);
    relabelled = RelabelCrumbs(
      this->Source, made.Labels, this->Small, this->Options, this->Threads, this->Stop);
  }
  this->FindRidges(made.Labels, added, relabelled);
  if (isFirst) // not before the lists of facets, which need most memory, are gone
  {
    this->FindNew();
  }
  ManifoldRepairResult<D> result = RepairManifold<D>(
    this->Source, made.Labels, this->Ridges, this->Options, this->Threads, this->Stop);
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
auto ManifoldLabeller<D>::FindNew() -> Few
{
  this->Seen.MakeRoom();
  return this->FindFew([this](SimplexId s) { return this->Seen.See(s); });
}

/** The simplices for which condition(s) holds. It is called once for each id, by several threads. */
template <int D>
template <typename Condition>
auto ManifoldLabeller<D>::FindFew(const Condition& condition) const -> Few
{
  constexpr std::size_t Grain = 8192;
  constexpr std::size_t Share = 32;
  const std::size_t most = this->Source.SimplexIdEnd() / Share;
  std::atomic<std::size_t> number{ 0 };
  std::vector<SimplexId> all = ParallelCollect<SimplexId>(
    this->Source.SimplexIdEnd(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last, std::vector<SimplexId>& found)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        if (condition(s))
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
  return number.load() > most ? std::nullopt : Few(std::move(all));
}

/**
 * Finds the ridges that are not manifold with these labels.
 * @param added the new simplices
 * @param crumbs the simplices that have another label than that at their circumcentre
 */
template <int D>
void ManifoldLabeller<D>::FindRidges(
  const SimplexLabels& labels, const Few& added, const std::vector<SimplexId>& crumbs)
{
  const std::span<const LabelId> now(labels);
  if (added)
  {
    std::vector<SimplexId> changed = *added;
    changed.insert(changed.end(), crumbs.begin(), crumbs.end());
    std::copy_if(this->Crumbs.begin(), this->Crumbs.end(), std::back_inserter(changed),
      [this](SimplexId s) { return this->Source.IsAlive(s); });
    this->Ridges = UpdateNonManifoldRidges<D>(
      this->Source, now, this->Ridges, changed, this->Threads, this->Stop);
  }
  else
  {
    this->Ridges = FindNonManifoldRidges<D>(this->Source, now, this->Threads, this->Stop);
  }
  this->Crumbs = crumbs;
}

template class ManifoldLabeller<3>;
template class ManifoldLabeller<4>;

} // namespace voxplex

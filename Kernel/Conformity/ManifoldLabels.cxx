// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldLabels.h"

#include "Base/UninitialisedVector.h"
#include "Conformity/Crumbs.h"
#include "Delaunay/VertexStar.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cstdint>
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
ManifoldLabels<D> MakeManifoldLabels(const Triangulation<D>& triangulation, bool repair,
  const ManifoldRepairOptions<D>& options, InterfaceStatistics& statistics, unsigned threads,
  const std::stop_token& stop)
{
  ManifoldLabels<D> made;
  made.Labels = LabelSimplices(triangulation, *options.Surfaces, threads, stop);
  if (repair)
  {
    std::vector<SimplexId> changed;
    if constexpr (D == 3)
    {
      changed = RelabelCrumbs(triangulation, made.Labels, options, threads, stop);
    }
    ManifoldRepairResult<D> result =
      RepairManifold<D>(triangulation, made.Labels, options, threads, stop);
    statistics.NonManifoldRepaired = result.Before - result.Left.size();
    statistics.NonManifoldLeft = result.Left.size();
    made.NonManifold = std::move(result.Left);
    for (const InterfaceRidge<D>& ridge : made.NonManifold)
    {
      made.Places.push_back({ CentroidOf(triangulation, ridge.Vertices), ridge.IsJunction });
    }
    changed.insert(changed.end(), result.Relabelled.begin(), result.Relabelled.end());
    made.Gone = VerticesWithin(triangulation, made.Labels, changed, threads, stop);
  }
  return made;
}

template ManifoldLabels<3> MakeManifoldLabels<3>(const Triangulation<3>&, bool,
  const ManifoldRepairOptions<3>&, InterfaceStatistics&, unsigned, const std::stop_token&);
template ManifoldLabels<4> MakeManifoldLabels<4>(const Triangulation<4>&, bool,
  const ManifoldRepairOptions<4>&, InterfaceStatistics&, unsigned, const std::stop_token&);

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/MeshTopology.h"

#include "Base/DisjointSets.h"
#include "Base/GridIndex.h"
#include "Geometry/SimplexQuality.h"
#include "Mesh/MeshElements.h"
#include "Parallel/ParallelCollect.h"
#include "Quality/ComponentPieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>

namespace voxplex
{

namespace
{

/** A piece holds a component if it has half of it, or of this number of voxels of it. */
constexpr double VoxelsThatHold = 64.0;

/** The components with these numbers, ascending, in sets that touch each other in the image. */
template <int D>
DisjointSets JoinTouching(const std::vector<std::uint32_t>& some, const Components<D>& components)
{
  using Index = typename GridGeometry<D>::Index;
  DisjointSets sets(some.size());
  for (std::uint32_t k = 0; k < some.size(); ++k)
  {
    components.ForEachRun(some[k],
      [&](Index low, std::int64_t length)
      {
        Index high = low;
        high[0] += length - 1;
        for (std::size_t a = 0; a < D; ++a)
        {
          --low[a];
          ++high[a];
        }
        ForEachIndex(low, high,
          [&](const Index& voxel)
          {
            const auto at = std::lower_bound(some.begin(), some.end(), components.At(voxel));
            if (at != some.end() && *at == components.At(voxel))
            {
              sets.Join(k, static_cast<std::uint32_t>(at - some.begin()));
            }
          });
      });
  }
  return sets;
}

template <int D>
auto CornersOf(const SimplexMesh<D>& mesh, std::size_t facet)
{
  std::array<const Point<D>*, D> corners;
  for (std::size_t k = 0; k < D; ++k)
  {
    corners[k] = &mesh.Points[mesh.Facets[facet][k]];
  }
  return corners;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void ComparePieces(const LabelledCells<D>& elements, const Components<D>& components,
  const LabelImage<D>& image, const std::vector<bool>& wanted, ComponentStatistics& statistics,
  unsigned threads, const std::stop_token& stop)
{
  const ComponentPieces<D> pieces(elements, components, image, PieceShares::OfAll, threads, stop);
  const double voxel = image.Grid().VoxelVolume();
  std::map<std::uint32_t, std::map<std::uint32_t, double>> volumes; // of components' pieces
  statistics.United.clear();
  for (std::uint32_t p = 0; p < pieces.All().size(); ++p)
  {
    const auto& piece = pieces.All()[p];
    if (piece.Component != None && wanted[piece.Component])
    {
      volumes[piece.Component][p] = 0.0;
    }
    std::vector<std::uint32_t> all; // components that the piece has a share of
    std::vector<std::uint32_t> held;
    for (const auto& [component, volume] : piece.Shares)
    {
      const auto voxels = static_cast<double>(components.All()[component].Voxels);
      if (wanted[component] && volume >= 0.5 * voxel * std::min(voxels, VoxelsThatHold))
      {
        held.push_back(static_cast<std::uint32_t>(all.size()));
      }
      all.push_back(component);
    }
    if (held.size() < 2)
    {
      continue;
    }
    DisjointSets sets = JoinTouching(all, components);
    std::set<std::uint32_t> names;
    std::uint32_t smaller = held.front(); // the smallest one that is not of the first set
    for (const std::uint32_t k : held)
    {
      names.insert(sets.Find(k));
      if (sets.Find(k) != sets.Find(held.front()) &&
        (smaller == held.front() ||
          components.All()[all[k]].Voxels < components.All()[all[smaller]].Voxels))
      {
        smaller = k;
      }
    }
    if (names.size() > 1)
    {
      statistics.United.push_back(
        { MakeReport(components.All()[all[smaller]], image), names.size() });
    }
  }
  std::stable_sort(statistics.United.begin(), statistics.United.end(),
    [](const auto& a, const auto& b) { return a.Component.Voxels > b.Component.Voxels; });
  std::erase_if(volumes, [](const auto& component) { return component.second.size() < 2; });
  for (std::uint32_t s = 0; !volumes.empty() && s < elements.Size(); ++s)
  {
    const std::uint32_t p = pieces.Of(s);
    const auto component = volumes.find(p == None ? None : pieces.All()[p].Component);
    if (component != volumes.end())
    {
      component->second[p] += std::abs(SignedVolume<D>(elements.PointsOf(s).data()));
    }
  }
  statistics.Broken.clear();
  for (const auto& [component, all] : volumes)
  {
    double sum = 0.0;
    double largest = 0.0;
    for (const auto& [p, volume] : all)
    {
      sum += volume;
      largest = std::max(largest, volume);
    }
    statistics.Broken.push_back(
      { MakeReport(components.All()[component], image), all.size(), largest / sum });
  }
  const auto looseVoxels = [](const BrokenComponent& broken)
  { return (1.0 - broken.Largest) * static_cast<double>(broken.Component.Voxels); };
  std::stable_sort(statistics.Broken.begin(), statistics.Broken.end(),
    [&](const auto& a, const auto& b) { return looseVoxels(a) > looseVoxels(b); });
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<FalseContact> FindFalseContacts(const SimplexMesh<D>& mesh, const LabelImage<D>& image,
  unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 1024;
  const LabelContacts<D> contacts(image);
  const std::vector<std::size_t> found = ParallelCollect<std::size_t>(
    mesh.Facets.size(), Grain, threads,
    [&](std::size_t first, std::size_t last, std::vector<std::size_t>& some)
    {
      for (std::size_t f = first; f < last; ++f)
      {
        if (!contacts.TouchNear(CornersOf(mesh, f), LabelIdOf(mesh.FacetLabels[f][0], image),
              LabelIdOf(mesh.FacetLabels[f][1], image)))
        {
          some.push_back(f);
        }
      }
    },
    stop);
  std::map<std::array<std::int64_t, 2>, FalseContact> byLabels;
  std::map<std::array<std::int64_t, 2>, double> largest; // facet
  for (const std::size_t f : found)
  {
    const auto corners = CornersOf(mesh, f);
    const double area = FacetMeasure(corners);
    FalseContact& contact = byLabels[mesh.FacetLabels[f]];
    contact.Labels = mesh.FacetLabels[f];
    ++contact.Facets;
    contact.Area += area;
    if (area > largest[mesh.FacetLabels[f]] || contact.Voxel.empty())
    {
      largest[mesh.FacetLabels[f]] = area;
      contact.Voxel.clear();
      const Point<D> index = image.Grid().ToIndex(Centroid(corners));
      for (std::size_t a = 0; a < D; ++a)
      {
        const auto end = static_cast<double>(image.Grid().Dimensions[a] - 1);
        contact.Voxel.push_back(std::llround(std::clamp(index[a], 0.0, end)));
      }
    }
  }
  std::vector<FalseContact> all;
  for (auto& [labels, contact] : byLabels)
  {
    all.push_back(std::move(contact));
  }
  std::stable_sort(all.begin(), all.end(),
    [](const FalseContact& a, const FalseContact& b) { return a.Area > b.Area; });
  return all;
}

template void ComparePieces<3>(const LabelledCells<3>&, const Components<3>&, const LabelImage<3>&,
  const std::vector<bool>&, ComponentStatistics&, unsigned, const std::stop_token&);
template void ComparePieces<4>(const LabelledCells<4>&, const Components<4>&, const LabelImage<4>&,
  const std::vector<bool>&, ComponentStatistics&, unsigned, const std::stop_token&);
template std::vector<FalseContact> FindFalseContacts<3>(
  const SimplexMesh<3>&, const LabelImage<3>&, unsigned, const std::stop_token&);
template std::vector<FalseContact> FindFalseContacts<4>(
  const SimplexMesh<4>&, const LabelImage<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

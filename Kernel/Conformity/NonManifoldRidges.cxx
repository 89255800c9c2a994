// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/NonManifoldRidges.h"

#include "Base/UninitialisedVector.h"
#include "Conformity/ChangeRules.h"
#include "Conformity/RepairNeighbourhood.h"
#include "Mesh/InterfaceFacets.h"
#include "Parallel/ParallelCollect.h"

#include <algorithm>
#include <array>

namespace voxplex
{

namespace
{

//------------------------------------------------------------------------------------------------
/** Finds bad ridges one by one. */
template <int D>
class RidgeFinder
{
public:
  /** Both must outlive this object. */
  RidgeFinder(const Triangulation<D>& triangulation, std::span<const LabelId> labels)
    : Source(triangulation)
    , Near(triangulation, labels)
  {
  }

  /** Appends the bad ridges of a simplex. */
  void Find(SimplexId s, std::vector<InterfaceRidge<D>>& found) const
  {
    const auto& v = this->Source.GetSimplex(s).V;
    for (unsigned i = 0; i <= D; ++i)
    {
      for (unsigned j = 0; j < i; ++j)
      {
        repair::Ridge<D> ridge;
        std::size_t n = 0;
        for (unsigned k = 0; k <= D; ++k)
        {
          if (k != i && k != j)
          {
            ridge[n++] = v[k];
          }
        }
        std::sort(ridge.begin(), ridge.end());
        this->Add(ridge, s, found);
      }
    }
  }

private:
  void Add(const repair::Ridge<D>& ridge, SimplexId s, std::vector<InterfaceRidge<D>>& found) const
  {
    const auto state = this->Near.RingOf(ridge, s).Now;
    if (state.Bad > 0)
    {
      found.push_back({ ridge, state.IsJunction });
    }
  }

  const Triangulation<D>& Source;
  const repair::Neighbourhood<D> Near;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
InterfaceFacets<D> FindInterfaceFacets(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, unsigned threads, const std::stop_token& stop)
{
  InterfaceFacets<D> all;
  ListInterfaces(
    labels, [&](SimplexId s) -> const auto& { return triangulation.GetSimplex(s).N; },
    BeyondEnd::Background,
    [&](std::size_t number)
    {
      all.Facets.resize(number);
      all.Labels.resize(number);
    },
    [&](std::size_t place, SimplexId s, unsigned i, LabelId beside)
    {
      all.Facets[place] = OutwardFacet(triangulation.GetSimplex(s).V, i);
      all.Labels[place] = { labels[s], beside };
    },
    threads, stop);
  return all;
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidges(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, unsigned threads, const std::stop_token& stop)
{
  const InterfaceFacets<D> interfaces =
    FindInterfaceFacets<D>(triangulation, labels, threads, stop);
  return FindNonManifoldRidges<D>(std::span<const repair::Facet<D>>(interfaces.Facets),
    std::span<const std::array<LabelId, 2>>(interfaces.Labels), triangulation.VertexIdEnd(),
    threads, stop);
}

template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidgesOf(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, const std::vector<SimplexId>& simplices, unsigned threads,
  const std::stop_token& stop)
{
  constexpr std::size_t Grain = 256;
  std::vector<InterfaceRidge<D>> ridges = ParallelCollect<InterfaceRidge<D>>(
    simplices.size(), Grain, threads,
    [&](std::size_t first, std::size_t last, std::vector<InterfaceRidge<D>>& found)
    {
      const RidgeFinder<D> finder(triangulation, labels);
      for (std::size_t k = first; k < last; ++k)
      {
        finder.Find(simplices[k], found);
      }
    },
    stop);
  std::sort(ridges.begin(), ridges.end(),
    [](const auto& a, const auto& b) { return a.Vertices < b.Vertices; });
  ridges.erase(std::unique(ridges.begin(), ridges.end(),
                 [](const auto& a, const auto& b) { return a.Vertices == b.Vertices; }),
    ridges.end());
  return ridges;
}

template InterfaceFacets<3> FindInterfaceFacets<3>(
  const Triangulation<3>&, std::span<const LabelId>, unsigned, const std::stop_token&);
template std::vector<InterfaceRidge<3>> FindNonManifoldRidges<3>(
  const Triangulation<3>&, std::span<const LabelId>, unsigned, const std::stop_token&);
template std::vector<InterfaceRidge<4>> FindNonManifoldRidges<4>(
  const Triangulation<4>&, std::span<const LabelId>, unsigned, const std::stop_token&);
template std::vector<InterfaceRidge<3>> FindNonManifoldRidgesOf<3>(const Triangulation<3>&,
  std::span<const LabelId>, const std::vector<SimplexId>&, unsigned, const std::stop_token&);
template std::vector<InterfaceRidge<4>> FindNonManifoldRidgesOf<4>(const Triangulation<4>&,
  std::span<const LabelId>, const std::vector<SimplexId>&, unsigned, const std::stop_token&);

} // namespace voxplex

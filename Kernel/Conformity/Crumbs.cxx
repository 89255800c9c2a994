// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/Crumbs.h"

#include "Conformity/ChangeRules.h"
#include "Delaunay/VertexStar.h"
#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelCollect.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace voxplex
{

namespace
{

/** The largest number of tetrahedra of a crumb. */
constexpr std::size_t MostOfACrumb = 5;

/** A crumb, or some tetrahedra of a larger fragment. */
using Fragment = std::vector<SimplexId>;

class CrumbFinder
{
public:
  /** Both must outlive this object. */
  CrumbFinder(const Triangulation<3>& triangulation, const SimplexLabels& labels)
    : Mesh(triangulation)
    , Labels(labels)
  {
  }

  /** Whether s may begin a search, and its fragment is as small as a crumb. */
  bool IsSmall(SimplexId s) const
  {
    return this->MayBegin(s) && this->SomeOf(s).size() <= MostOfACrumb;
  }

  /** The crumb that s is of, ascending, if s is its first tetrahedron that may begin a search. */
  std::optional<Fragment> CrumbOf(SimplexId s) const
  {
    Fragment fragment = this->SomeOf(s);
    std::sort(fragment.begin(), fragment.end());
    const auto first = std::find_if(
      fragment.begin(), fragment.end(), [this](SimplexId t) { return this->MayBegin(t); });
    const bool isCrumb = *first == s &&
      this->HangsOnLarger(
        fragment, [this](VertexId v, SimplexId t) { return StarOf(this->Mesh, v, t); });
    return isCrumb ? std::optional(std::move(fragment)) : std::nullopt;
  }

  /** Whether something that was a crumb still is one. */
  bool IsCrumb(const Fragment& crumb, const repair::Neighbourhood<3>& near) const
  {
    return this->SomeOf(crumb.front()).size() == crumb.size() &&
      this->HangsOnLarger(crumb,
        [&near](VertexId v, SimplexId) -> const std::vector<SimplexId>& { return near.StarOf(v); });
  }

  /** The fragment of s, if it has at most MostOfACrumb tetrahedra; otherwise more than these. */
  Fragment SomeOf(SimplexId s) const
  {
    Fragment found{ s };
    for (std::size_t k = 0; k < found.size() && found.size() <= MostOfACrumb; ++k)
    {
      for (const SimplexId n : this->Mesh.GetSimplex(found[k]).N)
      {
        if (this->LabelOf(n) == this->Labels[s] &&
          std::find(found.begin(), found.end(), n) == found.end())
        {
          found.push_back(n);
        }
      }
    }
    return found;
  }

private:
  LabelId LabelOf(SimplexId s) const { return s == None ? LabelId{ 0 } : this->Labels[s]; }

  /**
   * Whether s has at most one neighbour of its label. Fragments without such a tetrahedron, such as
   * rings around an edge, are 2 % of the small ones, and looking for them takes twice the time.
   */
  bool MayBegin(SimplexId s) const
  {
    if (this->Labels[s] == 0)
    {
      return false;
    }
    const auto& n = this->Mesh.GetSimplex(s).N;
    return std::count_if(n.begin(), n.end(),
             [&](SimplexId t) { return this->LabelOf(t) == this->Labels[s]; }) <= 1;
  }

  /**
   * Whether a larger fragment of the label has one of the vertices.
   * @param starOf gives the star of a vertex of a simplex
   */
  template <typename Stars>
  bool HangsOnLarger(const Fragment& fragment, const Stars& starOf) const
  {
    for (const SimplexId s : fragment)
    {
      for (const VertexId v : this->Mesh.GetSimplex(s).V)
      {
        for (const SimplexId t : starOf(v, s))
        {
          if (this->Labels[t] == this->Labels[s] &&
            !std::binary_search(fragment.begin(), fragment.end(), t) &&
            this->SomeOf(t).size() > fragment.size())
          {
            return true;
          }
        }
      }
    }
    return false;
  }

  const Triangulation<3>& Mesh;
  const SimplexLabels& Labels;
};

double AreaOf(const Triangulation<3>& mesh, const repair::Facet<3>& facet)
{
  const Point<3>& p = mesh.Position(facet[0]);
  const Point<3> normal =
    Cross(Subtract(mesh.Position(facet[1]), p), Subtract(mesh.Position(facet[2]), p));
  return 0.5 * std::sqrt(Dot(normal, normal));
}

/**
 * The changes that give a crumb a label beside it, the one with the largest common area first.
 * @param crumbs all simplices of crumbs, ascending
 */
std::vector<repair::Change> ChangesOf(const Fragment& crumb, const Triangulation<3>& mesh,
  const SimplexLabels& labels, const std::vector<SimplexId>& crumbs)
{
  std::map<LabelId, double> areas;
  for (const SimplexId s : crumb)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      const SimplexId n = mesh.GetSimplex(s).N[i];
      if (n == None || !std::binary_search(crumbs.begin(), crumbs.end(), n))
      {
        areas[n == None ? LabelId{ 0 } : labels[n]] +=
          AreaOf(mesh, repair::FacetOf<3>(mesh.GetSimplex(s).V, i));
      }
    }
  }
  std::vector<std::pair<LabelId, double>> sorted(areas.begin(), areas.end());
  std::stable_sort(
    sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<repair::Change> changes;
  for (const auto& [label, area] : sorted)
  {
    changes.push_back({ crumb, label });
  }
  return changes;
}

/** The crumbs, in the order of their first simplices. */
std::vector<Fragment> FindCrumbs(const CrumbFinder& finder, const std::vector<SimplexId>& small,
  unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 64;
  std::vector<Fragment> crumbs = ParallelCollect<Fragment>(
    small.size(), Grain, threads,
    [&](std::size_t first, std::size_t end, std::vector<Fragment>& found)
    {
      for (std::size_t k = first; k < end; ++k)
      {
        if (std::optional<Fragment> crumb = finder.CrumbOf(small[k]))
        {
          found.push_back(std::move(*crumb));
        }
      }
    },
    stop);
  std::sort(crumbs.begin(), crumbs.end());
  return crumbs;
}

} // namespace

//------------------------------------------------------------------------------------------------
std::vector<SimplexId> FindSmallFragments(const Triangulation<3>& triangulation,
  const SimplexLabels& labels, unsigned threads, const std::stop_token& stop)
{
  const CrumbFinder finder(triangulation, labels);
  constexpr std::size_t Grain = 8192;
  return ParallelCollect<SimplexId>(
    labels.size(), Grain, threads,
    [&](std::size_t first, std::size_t end, std::vector<SimplexId>& found)
    {
      for (auto s = static_cast<SimplexId>(first); s < end; ++s)
      {
        if (finder.IsSmall(s))
        {
          found.push_back(s);
        }
      }
    },
    stop);
}

std::vector<SimplexId> UpdateSmallFragments(const Triangulation<3>& triangulation,
  const SimplexLabels& labels, const std::vector<SimplexId>& before,
  const std::vector<SimplexId>& added, unsigned threads, const std::stop_token& stop)
{
  const CrumbFinder finder(triangulation, labels);
  // Fragments that have changed have a new simplex, or one beside it.
  constexpr std::size_t Grain = 256;
  std::vector<SimplexId> small = ParallelCollect<SimplexId>(
    added.size(), Grain, threads,
    [&](std::size_t first, std::size_t end, std::vector<SimplexId>& found)
    {
      const auto look = [&](SimplexId s)
      {
        if (labels[s] != 0)
        {
          const Fragment some = finder.SomeOf(s);
          std::copy_if(some.begin(), some.end(), std::back_inserter(found),
            [&](SimplexId t) { return finder.IsSmall(t); });
        }
      };
      for (std::size_t k = first; k < end; ++k)
      {
        look(added[k]);
        for (const SimplexId n : triangulation.GetSimplex(added[k]).N)
        {
          if (n != None)
          {
            look(n);
          }
        }
      }
    },
    stop);
  std::copy_if(before.begin(), before.end(), std::back_inserter(small),
    [&](SimplexId s) { return finder.IsSmall(s); });
  std::sort(small.begin(), small.end());
  small.erase(std::unique(small.begin(), small.end()), small.end());
  return small;
}

//------------------------------------------------------------------------------------------------
std::vector<SimplexId> RelabelCrumbs(const Triangulation<3>& triangulation, SimplexLabels& labels,
  const std::vector<SimplexId>& small, const ManifoldRepairOptions<3>& options, unsigned threads,
  const std::stop_token& stop)
{
  const CrumbFinder finder(triangulation, labels);
  const std::vector<Fragment> crumbs = FindCrumbs(finder, small, threads, stop);
  std::vector<SimplexId> all;
  for (const Fragment& crumb : crumbs)
  {
    all.insert(all.end(), crumb.begin(), crumb.end());
  }
  std::sort(all.begin(), all.end());
  const SimplexLabels before = crumbs.empty() ? SimplexLabels() : labels;
  const repair::Neighbourhood<3> near(triangulation, labels, before);
  const repair::ChangeRules<3> rules(near, labels, options);

  std::vector<SimplexId> changed;
  for (const Fragment& crumb : crumbs)
  {
    if (!finder.IsCrumb(crumb, near)) // not any more, because of its neighbours' new labels
    {
      continue;
    }
    const std::vector<repair::Change> changes = ChangesOf(crumb, triangulation, labels, all);
    const auto best = std::find_if(changes.begin(), changes.end(),
      [&](const repair::Change& change)
      { return !rules.Dents(change) && rules.IsAllowed(change); });
    if (best != changes.end())
    {
      for (const SimplexId s : crumb)
      {
        labels[s] = best->Label;
      }
      changed.insert(changed.end(), crumb.begin(), crumb.end());
    }
  }
  std::sort(changed.begin(), changed.end());
  return changed;
}

} // namespace voxplex

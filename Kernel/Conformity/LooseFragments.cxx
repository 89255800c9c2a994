// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/LooseFragments.h"

#include "Conformity/ChangeRules.h"
#include "Conformity/OrderedChanges.h"
#include "Delaunay/VertexStar.h"
#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelCollect.h"

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace voxplex
{

namespace
{

/** The largest number of tetrahedra of a loose fragment. */
constexpr std::size_t MostSimplices = 5;

/** A loose fragment. */
using Fragment = std::vector<SimplexId>;

/** A small fragment, or some tetrahedra of a larger fragment. */
using FewSimplices = boost::container::small_vector<SimplexId, MostSimplices + 4>;

class LooseFragmentFinder
{
public:
  /** Both must outlive this object. */
  LooseFragmentFinder(const Triangulation<3>& triangulation, const SimplexLabels& labels)
    : Mesh(triangulation)
    , Labels(labels)
  {
  }

  /** Whether s may begin a search, and its fragment is as small as a loose fragment. */
  bool IsSmall(SimplexId s) const
  {
    return this->MayBegin(s) && this->FragmentAt(s).size() <= MostSimplices;
  }

  /**
   * The loose fragment that s is of, ascending, if s is its first tetrahedron that may begin a
   * search.
   */
  std::optional<Fragment> FindLooseFragment(SimplexId s) const
  {
    const FewSimplices some = this->FragmentAt(s);
    Fragment fragment(some.begin(), some.end());
    std::sort(fragment.begin(), fragment.end());
    const auto first = std::find_if(
      fragment.begin(), fragment.end(), [this](SimplexId t) { return this->MayBegin(t); });
    const bool isLoose = *first == s &&
      this->HangsOnLarger(
        fragment,
        [this](VertexId v, SimplexId t, const auto& condition)
        { return AnyInStar(this->Mesh, v, t, condition); },
        [](const FewSimplices&) {});
    return isLoose ? std::optional(std::move(fragment)) : std::nullopt;
  }

  /**
   * Whether something that was a loose fragment still is one.
   * @param seen receives the vertices of simplices that were looked at, except those of stars
   */
  bool IsLoose(
    const Fragment& loose, const repair::Neighbourhood<3>& near, std::vector<VertexId>& seen) const
  {
    return this->FragmentAt(loose.front()).size() == loose.size() &&
      this->HangsOnLarger(
        loose,
        [&near](VertexId v, SimplexId, const auto& condition)
        {
          const std::vector<SimplexId>& star = near.StarOf(v);
          return std::any_of(star.begin(), star.end(), condition);
        },
        [&](const FewSimplices& some)
        {
          for (const SimplexId t : some)
          {
            const auto& v = this->Mesh.GetSimplex(t).V;
            seen.insert(seen.end(), v.begin(), v.end());
          }
        });
  }

  /** The fragment of s, if it has at most MostSimplices tetrahedra; otherwise more than these. */
  FewSimplices FragmentAt(SimplexId s) const
  {
    FewSimplices found{ s };
    for (std::size_t k = 0; k < found.size() && found.size() <= MostSimplices; ++k)
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
   * @param anyInStar anyInStar(v, s, condition): whether a condition holds for a simplex of the
   * star of v, which has s
   * @param lookedAt lookedAt(some) is called with fragments at the vertices
   */
  template <typename Stars, typename LookedAt>
  bool HangsOnLarger(
    const Fragment& fragment, const Stars& anyInStar, const LookedAt& lookedAt) const
  {
    const LabelId label = this->Labels[fragment.front()];
    const auto isOfLarger = [&](SimplexId t)
    {
      if (this->Labels[t] != label || std::binary_search(fragment.begin(), fragment.end(), t))
      {
        return false;
      }
      const FewSimplices some = this->FragmentAt(t);
      lookedAt(some);
      return some.size() > fragment.size();
    };
    return std::any_of(fragment.begin(), fragment.end(),
      [&](SimplexId s)
      {
        const auto& v = this->Mesh.GetSimplex(s).V;
        return std::any_of(
          v.begin(), v.end(), [&](VertexId x) { return anyInStar(x, s, isOfLarger); });
      });
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
 * The changes that give a loose fragment a label beside it, the one with the largest common area
 * first.
 * @param looseFragments all simplices of loose fragments, ascending
 */
std::vector<repair::Change> ChangesOf(const Fragment& loose, const Triangulation<3>& mesh,
  const SimplexLabels& labels, const std::vector<SimplexId>& looseFragments)
{
  std::map<LabelId, double> areas;
  for (const SimplexId s : loose)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      const SimplexId n = mesh.GetSimplex(s).N[i];
      if (n == None || !std::binary_search(looseFragments.begin(), looseFragments.end(), n))
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
    changes.push_back({ loose, label });
  }
  return changes;
}

/** The loose fragments, in the order of their first simplices. */
std::vector<Fragment> FindLooseFragments(const LooseFragmentFinder& finder,
  const std::vector<SimplexId>& small, unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 64;
  std::vector<Fragment> looseFragments = ParallelCollect<Fragment>(
    small.size(), Grain, threads,
    [&](std::size_t first, std::size_t end, std::vector<Fragment>& found)
    {
      for (std::size_t k = first; k < end; ++k)
      {
        if (std::optional<Fragment> loose = finder.FindLooseFragment(small[k]))
        {
          found.push_back(std::move(*loose));
        }
      }
    },
    stop);
  std::sort(looseFragments.begin(), looseFragments.end());
  return looseFragments;
}

//------------------------------------------------------------------------------------------------
/** Finds changes for loose fragments. Each thread needs its own. */
class LooseFragmentRepair
{
public:
  /**
   * All must outlive this object.
   * @param labels by simplex id; they may change between calls
   * @param before the labels before any change
   * @param simplices of all loose fragments, ascending
   */
  LooseFragmentRepair(const Triangulation<3>& triangulation, const SimplexLabels& labels,
    const SimplexLabels& before, const ManifoldRepairOptions<3>& options,
    const std::vector<SimplexId>& simplices)
    : Mesh(triangulation)
    , Labels(labels)
    , OfLooseFragments(simplices)
    , Finder(triangulation, labels)
    , Near(triangulation, labels, before)
    , Rules(this->Near, labels, options)
  {
  }

  LooseFragmentRepair(const LooseFragmentRepair&) = delete; // Rules refer to Near
  LooseFragmentRepair& operator=(const LooseFragmentRepair&) = delete;

  /**
   * The best change of a loose fragment. None if its neighbours' new labels have made it another
   * fragment.
   */
  repair::Proposal Propose(const Fragment& loose) const
  {
    this->Near.ForgetSeen();
    repair::Proposal proposal;
    if (this->Finder.IsLoose(loose, this->Near, proposal.Seen))
    {
      std::vector<repair::Change> changes =
        ChangesOf(loose, this->Mesh, this->Labels, this->OfLooseFragments);
      const auto best = std::find_if(changes.begin(), changes.end(),
        [this](const repair::Change& change)
        { return !this->Rules.Dents(change) && this->Rules.IsAllowed(change); });
      if (best != changes.end())
      {
        proposal.Best = std::move(*best);
      }
    }
    const std::vector<VertexId>& seen = this->Near.Seen();
    proposal.Seen.insert(proposal.Seen.end(), seen.begin(), seen.end());
    for (const SimplexId s : loose)
    {
      const auto& v = this->Mesh.GetSimplex(s).V;
      proposal.Seen.insert(proposal.Seen.end(), v.begin(), v.end());
    }
    return proposal;
  }

private:
  const Triangulation<3>& Mesh;
  const SimplexLabels& Labels;
  const std::vector<SimplexId>& OfLooseFragments;
  const LooseFragmentFinder Finder;
  const repair::Neighbourhood<3> Near;
  const repair::ChangeRules<3> Rules;
};

} // namespace

//------------------------------------------------------------------------------------------------
std::vector<SimplexId> FindSmallFragments(const Triangulation<3>& triangulation,
  const SimplexLabels& labels, unsigned threads, const std::stop_token& stop)
{
  const LooseFragmentFinder finder(triangulation, labels);
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

std::vector<SimplexId> FindSmallFragmentsAt(const Triangulation<3>& triangulation,
  const SimplexLabels& labels, const std::vector<SimplexId>& changed, unsigned threads,
  const std::stop_token& stop)
{
  const LooseFragmentFinder finder(triangulation, labels);
  constexpr std::size_t Grain = 256;
  std::vector<SimplexId> small = ParallelCollect<SimplexId>(
    changed.size(), Grain, threads,
    [&](std::size_t first, std::size_t end, std::vector<SimplexId>& found)
    {
      const auto look = [&](SimplexId s)
      {
        if (labels[s] != 0)
        {
          const FewSimplices some = finder.FragmentAt(s);
          std::copy_if(some.begin(), some.end(), std::back_inserter(found),
            [&](SimplexId t) { return finder.IsSmall(t); });
        }
      };
      for (std::size_t k = first; k < end; ++k)
      {
        look(changed[k]);
        for (const SimplexId n : triangulation.GetSimplex(changed[k]).N)
        {
          if (n != None)
          {
            look(n);
          }
        }
      }
    },
    stop);
  std::sort(small.begin(), small.end());
  small.erase(std::unique(small.begin(), small.end()), small.end());
  return small;
}

//------------------------------------------------------------------------------------------------
std::vector<SimplexId> RelabelLooseFragments(const Triangulation<3>& triangulation,
  SimplexLabels& labels, const std::vector<SimplexId>& small,
  const ManifoldRepairOptions<3>& options, unsigned threads, const std::stop_token& stop)
{
  const std::vector<Fragment> looseFragments =
    FindLooseFragments(LooseFragmentFinder(triangulation, labels), small, threads, stop);
  if (looseFragments.empty())
  {
    return {};
  }
  std::vector<SimplexId> simplices; // of all loose fragments, ascending
  for (const Fragment& loose : looseFragments)
  {
    simplices.insert(simplices.end(), loose.begin(), loose.end());
  }
  std::sort(simplices.begin(), simplices.end());
  const SimplexLabels before = labels;
  repair::OrderedChanges<3> changes(triangulation, labels, looseFragments.size(), threads, stop);
  changes.Pass([&]
    { return LooseFragmentRepair(triangulation, labels, before, options, simplices); },
    [&](const LooseFragmentRepair& finder, std::size_t k)
    { return finder.Propose(looseFragments[k]); });
  return changes.TakeChanged();
}

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/HiddenLayers.h"

#include "Conformity/ChangeRules.h"
#include "Conformity/OrderedChanges.h"
#include "Parallel/ParallelCollect.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>

namespace voxplex
{

namespace
{

template <int D>
auto FacetPoints(const Triangulation<D>& mesh, SimplexId s, unsigned i)
{
  return mesh.Points(repair::FacetOf<D>(mesh.GetSimplex(s).V, i));
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
bool HiddenLayerFinder<D>::IsFalseContact(SimplexId s, unsigned i, LabelId a, LabelId b) const
{
  return a != b && !this->Contacts.TouchNear(FacetPoints(this->Mesh, s, i), a, b);
}

template <int D>
std::optional<HiddenLayer<D>> HiddenLayerFinder<D>::Find(SimplexId s, unsigned i) const
{
  const auto& simplex = this->Mesh.GetSimplex(s);
  const SimplexId n = simplex.N[i];
  if (n == None)
  {
    return std::nullopt;
  }
  const LabelId a = this->Labels[s];
  const LabelId b = this->Labels[n];
  for (unsigned k = 1; a == b && k <= D; ++k)
  {
    if (this->Mesh.GetVertex(simplex.V[(i + k) % (D + 1)]).Kind != VertexKind::Feature)
    {
      return std::nullopt;
    }
  }
  if (a != b && !this->IsFalseContact(s, i, a, b))
  {
    return std::nullopt;
  }
  const Point<D> from = this->Mesh.GetCircumball(s).Center;
  const Point<D> to = this->Mesh.GetCircumball(n).Center;
  const auto runs = this->Contacts.LabelsAlong(from, to);
  std::size_t layer = runs.size(); // the longest one
  for (std::size_t k = 0; k < runs.size(); ++k)
  {
    if (runs[k].Label != a && runs[k].Label != b &&
      (layer == runs.size() || runs[k].End - runs[k].Begin > runs[layer].End - runs[layer].Begin))
    {
      layer = k;
    }
  }
  if (layer == runs.size())
  {
    if (a == b)
    {
      return std::nullopt;
    }
    const Point<D> centroid = Centroid(FacetPoints(this->Mesh, s, i));
    return HiddenLayer<D>{ s, i, a, { centroid, centroid } };
  }
  using Through = typename LabelContacts<D>::Through;
  // Between two labels, a layer at an end is a corner of its voxels only.
  const double begin = a == b ? runs[layer].Begin : runs[layer].End;
  const double end = a == b ? runs[layer].End : runs[layer].Begin;
  const Point<D> before = Interpolate(from, to, layer > 0 ? runs[layer - 1].End : begin);
  const Point<D> after =
    Interpolate(from, to, layer + 1 < runs.size() ? runs[layer + 1].Begin : end);
  const bool isAtEnd = layer == 0 || layer + 1 == runs.size();
  if (a == b &&
    this->Contacts.AreConnected(before, after, a, isAtEnd ? Through::Corners : Through::Faces))
  {
    return std::nullopt;
  }
  const std::optional<Point<D>> first = this->CrossingAt(before, after, runs[layer].Label);
  const std::optional<Point<D>> second = this->CrossingAt(after, before, runs[layer].Label);
  if (a == b && isAtEnd && (!first || !second))
  {
    return std::nullopt; // no sample can show it
  }
  const auto& bounds = this->Surfaces.Bounds();
  return HiddenLayer<D>{ s, i, runs[layer].Label,
    { bounds.Clamp(first.value_or(before)), bounds.Clamp(second.value_or(after)) } };
}

/** Where a line from the middle of a layer leaves it, towards an end of it, in the label field. */
template <int D>
std::optional<Point<D>> HiddenLayerFinder<D>::CrossingAt(
  const Point<D>& end, const Point<D>& other, LabelId layer) const
{
  const Point<D> middle = Interpolate(end, other, 0.5);
  Point<D> z;
  const bool isFound = this->Surfaces.Label(middle) == layer &&
    this->Surfaces.FirstCrossing(middle, layer, Interpolate(middle, end, 2.0), z);
  return isFound ? std::optional<Point<D>>(z) : std::nullopt;
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<HiddenLayer<D>> FindHiddenLayers(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, const std::vector<SimplexId>* simplices,
  const ManifoldRepairOptions<D>& options, unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 1024;
  const HiddenLayerFinder<D> finder(triangulation, labels, options);
  return ParallelCollect<HiddenLayer<D>>(
    simplices ? simplices->size() : labels.size(), Grain, threads,
    [&](std::size_t first, std::size_t last, std::vector<HiddenLayer<D>>& found)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        const SimplexId s = simplices ? (*simplices)[k] : static_cast<SimplexId>(k);
        for (unsigned i = 0; i <= D && triangulation.IsAlive(s); ++i)
        {
          const SimplexId n = triangulation.GetSimplex(s).N[i];
          const bool comesFromBoth =
            !simplices || std::binary_search(simplices->begin(), simplices->end(), n);
          if (s < n || !comesFromBoth)
          {
            if (std::optional<HiddenLayer<D>> layer = finder.Find(s, i))
            {
              found.push_back(*layer);
            }
          }
        }
      }
    },
    stop);
}

//------------------------------------------------------------------------------------------------
namespace
{

/** Finds changes that show layers. Each thread needs its own. */
template <int D>
class LayerRepair
{
public:
  /** @param changed the simplices that have been given labels to show layers */
  LayerRepair(const Triangulation<D>& triangulation, std::span<const LabelId> labels,
    const std::set<SimplexId>& changed, const ManifoldRepairOptions<D>& options)
    : Mesh(triangulation)
    , Labels(labels)
    , Changed(changed)
    , Finder(triangulation, labels, options)
    , Near(triangulation, labels)
    , Rules(this->Near, labels, options)
  {
  }

  LayerRepair(const LayerRepair&) = delete; // Rules refer to Near
  LayerRepair& operator=(const LayerRepair&) = delete;

  repair::Proposal Propose(const HiddenLayer<D>& layer) const
  {
    this->Near.ForgetSeen();
    const SimplexId s = layer.Cell;
    const SimplexId n = this->Mesh.GetSimplex(s).N[layer.Facet];
    repair::Proposal proposal;
    if (this->IsHidden(layer, this->Labels[s], this->Labels[n]))
    {
      double least = 0.0;
      for (const SimplexId t : { s, n })
      {
        if (this->Changed.contains(t))
        {
          continue; // each simplex is changed once at most, so that passes end
        }
        const double volume = this->Near.VolumeOf({ t });
        for (const LabelId label : this->LabelsFor(t, layer))
        {
          repair::Change change{ { t }, label };
          if ((!proposal.Best || volume < least) &&
            !this->IsHidden(
              layer, t == s ? label : this->Labels[s], t == n ? label : this->Labels[n]) &&
            !this->Rules.Dents(change) && this->Rules.IsAllowed(change))
          {
            least = volume;
            proposal.Best = std::move(change);
          }
        }
      }
    }
    proposal.Seen = this->Near.Seen();
    for (const SimplexId t : { s, n })
    {
      const auto& v = this->Mesh.GetSimplex(t).V;
      proposal.Seen.insert(proposal.Seen.end(), v.begin(), v.end());
    }
    return proposal;
  }

private:
  /** Whether a layer is hidden if the simplices at its facet have these labels. */
  bool IsHidden(const HiddenLayer<D>& layer, LabelId a, LabelId b) const
  {
    return a == b ? a != layer.Label : this->Finder.IsFalseContact(layer.Cell, layer.Facet, a, b);
  }

  /** The labels beside a simplex, and background if it is that of the layer. */
  std::set<LabelId> LabelsFor(SimplexId t, const HiddenLayer<D>& layer) const
  {
    std::set<LabelId> labels;
    for (unsigned i = 0; i <= D; ++i)
    {
      labels.insert(this->Near.LabelBeside(t, i));
    }
    if (layer.Label == 0)
    {
      labels.insert(0);
    }
    labels.erase(this->Labels[t]);
    return labels;
  }

  const Triangulation<D>& Mesh;
  const std::span<const LabelId> Labels;
  const std::set<SimplexId>& Changed;
  const HiddenLayerFinder<D> Finder;
  const repair::Neighbourhood<D> Near;
  const repair::ChangeRules<D> Rules;
};

} // namespace

template <int D>
std::vector<SimplexId> ShowHiddenLayers(const Triangulation<D>& triangulation,
  std::span<LabelId> labels, const std::vector<HiddenLayer<D>>& layers,
  const ManifoldRepairOptions<D>& options, unsigned threads, const std::stop_token& stop)
{
  if (layers.empty())
  {
    return {};
  }
  repair::OrderedChanges<D> changes(triangulation, labels, layers.size(), threads, stop);
  while (changes.Pass([&]
    { return LayerRepair<D>(triangulation, labels, changes.GetChanged(), options); },
    [&](const LayerRepair<D>& finder, std::size_t k) { return finder.Propose(layers[k]); }))
  {
  }
  return { changes.GetChanged().begin(), changes.GetChanged().end() };
}

template class HiddenLayerFinder<3>;
template class HiddenLayerFinder<4>;
template std::vector<HiddenLayer<3>> FindHiddenLayers<3>(const Triangulation<3>&,
  std::span<const LabelId>, const std::vector<SimplexId>*, const ManifoldRepairOptions<3>&,
  unsigned, const std::stop_token&);
template std::vector<HiddenLayer<4>> FindHiddenLayers<4>(const Triangulation<4>&,
  std::span<const LabelId>, const std::vector<SimplexId>*, const ManifoldRepairOptions<4>&,
  unsigned, const std::stop_token&);
template std::vector<SimplexId> ShowHiddenLayers<3>(const Triangulation<3>&, std::span<LabelId>,
  const std::vector<HiddenLayer<3>>&, const ManifoldRepairOptions<3>&, unsigned,
  const std::stop_token&);
template std::vector<SimplexId> ShowHiddenLayers<4>(const Triangulation<4>&, std::span<LabelId>,
  const std::vector<HiddenLayer<4>>&, const ManifoldRepairOptions<4>&, unsigned,
  const std::stop_token&);

} // namespace voxplex

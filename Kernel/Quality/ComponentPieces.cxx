// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/ComponentPieces.h"

#include "Base/GridIndex.h"
#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelCollect.h"
#include "Parallel/ParallelFor.h"
#include "Quality/ElementVoxels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 65536;

/** So many elements of a piece at least are looked at, whatever its shares are found from. */
constexpr std::size_t Enough = 1024;

/** A facet without its smallest vertex, and an element that has it. */
struct SortedFacet
{
  std::array<std::uint32_t, 2> Others;
  std::uint32_t Element;

  bool operator<(const SortedFacet& other) const { return this->Others < other.Others; }
};

template <typename Visit>
void ForEachFacet(const SimplexMesh<3>& mesh, const Visit& visit)
{
  for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    auto v = mesh.Simplices[s];
    std::sort(v.begin(), v.end());
    visit(v[0], SortedFacet{ { v[1], v[2] }, s });
    visit(v[0], SortedFacet{ { v[1], v[3] }, s });
    visit(v[0], SortedFacet{ { v[2], v[3] }, s });
    visit(v[1], SortedFacet{ { v[2], v[3] }, s });
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <typename Elements>
DisjointSets FindPieces(const Elements& elements, unsigned threads, const std::stop_token& stop)
{
  const std::span<const LabelId> labels = elements.GetLabels();
  DisjointSets pieces(labels.size());
  // Each thread joins elements of its own chunk. Those of two chunks are joined at the end.
  using Pair = std::array<std::uint32_t, 2>;
  const std::vector<Pair> across = ParallelCollect<Pair>(
    labels.size(), Grain, threads,
    [&](std::size_t first, std::size_t last, std::vector<Pair>& found)
    {
      for (auto s = static_cast<std::uint32_t>(first); s < last; ++s)
      {
        if (labels[s] == 0)
        {
          continue;
        }
        for (const std::uint32_t n : elements.NeighboursOf(s))
        {
          if (n < s && labels[n] == labels[s])
          {
            n >= first ? pieces.Join(s, n) : found.push_back({ s, n });
          }
        }
      }
    },
    stop);
  for (const auto& [s, n] : across)
  {
    pieces.Join(s, n);
  }
  return pieces;
}

//------------------------------------------------------------------------------------------------
template <int D>
template <typename Elements>
ComponentPieces<D>::ComponentPieces(const Elements& elements, const Components<D>& components,
  const LabelImage<D>& image, PieceShares shares, unsigned threads, const std::stop_token& stop)
  : Numbers(elements.Size(), None)
{
  DisjointSets pieces = FindPieces(elements, threads, stop);
  const std::span<const LabelId> labels = elements.GetLabels();
  std::vector<std::uint32_t> only(image.Values().size(), None); // component of each label
  std::vector<bool> hasSeveral(only.size());
  for (std::uint32_t c = 0; c < components.All().size(); ++c)
  {
    const LabelId label = components.All()[c].Label;
    hasSeveral[label] = hasSeveral[label] || only[label] != None;
    only[label] = c;
  }
  for (std::uint32_t s = 0; s < this->Numbers.size(); ++s)
  {
    const LabelId label = labels[s];
    if (label == 0)
    {
      continue;
    }
    const std::uint32_t first = pieces.Find(s);
    if (first == s)
    {
      this->Numbers[s] = static_cast<std::uint32_t>(this->List.size());
      this->List.push_back(
        { .Label = label, .Component = hasSeveral[label] ? None : only[label], .First = s });
    }
    this->Numbers[s] = this->Numbers[first];
    ++this->List[this->Numbers[s]].Size;
  }
  ThrowIfStopped(stop);
  const ElementVoxels<D> voxels(components, image);
  struct HeldVolume
  {
    std::uint64_t Of; ///< 2^32 times the piece, plus the component
    double Volume;
  };
  std::vector<HeldVolume> held = ParallelCollect<HeldVolume>(
    this->Numbers.size(), Grain, threads,
    [&](std::size_t begin, std::size_t end, std::vector<HeldVolume>& found)
    {
      for (std::size_t s = begin; s < end; ++s)
      {
        if (this->Numbers[s] == None || !hasSeveral[labels[s]])
        {
          continue;
        }
        const std::size_t all = this->List[this->Numbers[s]].Size;
        if (shares == PieceShares::OfSome && all >= 2 * Enough &&
          (s & (std::bit_floor(all / Enough) - 1)) != 0)
        {
          continue; // elements near each other have like numbers, so the others are everywhere
        }
        const auto corners = elements.PointsOf(s);
        const double volume = std::abs(SignedVolume<D>(corners.data()));
        voxels.ForEachVoxel(corners,
          [&](const auto& voxel)
          {
            const std::uint32_t c = components.At(voxel);
            if (c == None || components.All()[c].Label != labels[s])
            {
              return;
            }
            const std::uint64_t of = (std::uint64_t{ this->Numbers[s] } << 32) | c;
            if (found.empty() ||
              found.back().Of != of) // elements near each other have like numbers
            {
              found.push_back({ of, 0.0 });
            }
            found.back().Volume += volume;
          });
      }
    },
    stop);
  std::stable_sort(
    held.begin(), held.end(), [](const HeldVolume& a, const HeldVolume& b) { return a.Of < b.Of; });
  for (std::size_t k = 0; k < held.size(); ++k)
  {
    auto& found = this->List[held[k].Of >> 32].Shares;
    if (k == 0 || held[k - 1].Of != held[k].Of)
    {
      found.emplace_back(static_cast<std::uint32_t>(held[k].Of), 0.0);
    }
    found.back().second += held[k].Volume;
  }
  for (Piece& piece : this->List)
  {
    const auto largest = std::max_element(piece.Shares.begin(), piece.Shares.end(),
      [](const auto& a, const auto& b) { return a.second < b.second; });
    if (largest != piece.Shares.end())
    {
      piece.Component = largest->first;
    }
    else if (piece.Component == None)
    {
      voxels.ForEachVoxel(elements.PointsOf(piece.First),
        [&](const auto& centre)
        {
          voxels.ForEachAround(centre,
            [&](const auto& voxel)
            {
              const std::uint32_t c = components.At(voxel);
              if (piece.Component == None && c != None && components.All()[c].Label == piece.Label)
              {
                piece.Component = c;
              }
            });
        });
    }
  }
}

//------------------------------------------------------------------------------------------------
std::map<std::int64_t, std::uint64_t> CountFragments(
  const SimplexMesh<3>& mesh, const std::stop_token& stop)
{
  std::vector<std::size_t> ends(mesh.Points.size() + 1); // of the facets of each smallest vertex
  ForEachFacet(mesh, [&](std::uint32_t v, const SortedFacet&) { ++ends[v + 1]; });
  for (std::size_t v = 1; v < ends.size(); ++v)
  {
    ends[v] += ends[v - 1];
  }
  ThrowIfStopped(stop);
  std::vector<SortedFacet> facets(ends.back());
  ForEachFacet(mesh, [&](std::uint32_t v, const SortedFacet& facet) { facets[ends[v]++] = facet; });
  ThrowIfStopped(stop);
  DisjointSets pieces(mesh.Simplices.size());
  std::size_t first = 0;
  for (std::size_t v = 0; v < mesh.Points.size(); ++v)
  {
    std::sort(facets.begin() + static_cast<std::ptrdiff_t>(first),
      facets.begin() + static_cast<std::ptrdiff_t>(ends[v]));
    for (std::size_t k = first + 1; k < ends[v]; ++k)
    {
      const SortedFacet& a = facets[k - 1];
      const SortedFacet& b = facets[k];
      if (a.Others == b.Others && mesh.Labels[a.Element] == mesh.Labels[b.Element])
      {
        pieces.Join(a.Element, b.Element);
      }
    }
    first = ends[v];
  }
  ThrowIfStopped(stop);
  std::map<std::int64_t, std::uint64_t> numbers;
  for (std::uint32_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    numbers[mesh.Labels[s]] += pieces.Find(s) == s ? 1 : 0;
  }
  return numbers;
}

template DisjointSets FindPieces(const LabelledTriangulation<3>&, unsigned, const std::stop_token&);
template DisjointSets FindPieces(const LabelledTriangulation<4>&, unsigned, const std::stop_token&);
template DisjointSets FindPieces(const LabelledCells<3>&, unsigned, const std::stop_token&);
template DisjointSets FindPieces(const LabelledCells<4>&, unsigned, const std::stop_token&);
template class ComponentPieces<3>;
template class ComponentPieces<4>;
template ComponentPieces<3>::ComponentPieces(const LabelledTriangulation<3>&, const Components<3>&,
  const LabelImage<3>&, PieceShares, unsigned, const std::stop_token&);
template ComponentPieces<4>::ComponentPieces(const LabelledTriangulation<4>&, const Components<4>&,
  const LabelImage<4>&, PieceShares, unsigned, const std::stop_token&);
template ComponentPieces<3>::ComponentPieces(const LabelledCells<3>&, const Components<3>&,
  const LabelImage<3>&, PieceShares, unsigned, const std::stop_token&);
template ComponentPieces<4>::ComponentPieces(const LabelledCells<4>&, const Components<4>&,
  const LabelImage<4>&, PieceShares, unsigned, const std::stop_token&);

} // namespace voxplex

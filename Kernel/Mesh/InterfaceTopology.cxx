// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/InterfaceTopology.h"

#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>

namespace voxplex
{
namespace
{

constexpr std::size_t Grain = 4096;

/** One label on one side of a facet at one of its edges. */
struct Side
{
  std::array<std::uint32_t, 2> Edge; ///< the smaller point first
  std::int64_t Label;
};

bool Before(const Side& a, const Side& b)
{
  return std::tie(a.Edge, a.Label) < std::tie(b.Edge, b.Label);
}

std::vector<Side> SortedSides(
  const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop)
{
  std::vector<Side> sides(6 * mesh.Facets.size());
  ParallelFor(
    0, mesh.Facets.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t f = first; f < last; ++f)
      {
        for (std::size_t i = 0; i < 3; ++i)
        {
          const auto [low, high] = std::minmax(mesh.Facets[f][i], mesh.Facets[f][(i + 1) % 3]);
          sides[6 * f + 2 * i] = { { low, high }, mesh.FacetLabels[f][0] };
          sides[6 * f + 2 * i + 1] = { { low, high }, mesh.FacetLabels[f][1] };
        }
      }
    },
    stop);
  std::vector<Side> scratch(sides.size());
  const std::span<Side> sorted = ParallelRadixSort(
    std::span<Side>(sides), std::span<Side>(scratch),
    static_cast<unsigned>(std::bit_width(mesh.Points.size())),
    [](const Side& side) { return side.Edge[0]; }, threads, stop);
  if (sorted.data() != sides.data())
  {
    sides.swap(scratch);
  }
  // Those that share their first point are few.
  for (std::size_t first = 0; first < sides.size();)
  {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].Edge[0] == sides[first].Edge[0])
    {
      ++end;
    }
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(first),
      sides.begin() + static_cast<std::ptrdiff_t>(end), Before);
    first = end;
  }
  return sides;
}

/** What meets at a point of the mesh. */
struct PointJunction
{
  std::array<std::int64_t, 3> Labels{};
  std::uint8_t NumberOfLabels = 0; ///< 4 stands for four or more
  std::uint32_t JunctionEdges = 0;

  void Add(std::int64_t label)
  {
    const auto end = this->Labels.begin() + std::min<std::ptrdiff_t>(this->NumberOfLabels, 3);
    if (this->NumberOfLabels < 4 && std::find(this->Labels.begin(), end, label) == end)
    {
      if (this->NumberOfLabels < 3)
      {
        this->Labels[this->NumberOfLabels] = label;
      }
      ++this->NumberOfLabels;
    }
  }
};

/** The sides of one edge, sorted by label. */
class EdgeSides
{
public:
  EdgeSides(const std::vector<Side>& sides, std::size_t first)
    : Sides(sides)
    , First(first)
    , End(first)
  {
    while (this->End < sides.size() && sides[this->End].Edge == sides[first].Edge)
    {
      this->NumberOfLabels +=
        this->End == first || sides[this->End].Label != sides[this->End - 1].Label;
      ++this->End;
    }
  }

  std::size_t GetEnd() const { return this->End; }
  bool IsJunction() const { return this->NumberOfLabels >= 3; }

  /** Calls visit(label, facets that have it on one side). */
  template <typename Visit>
  void ForEachLabel(Visit&& visit) const
  {
    for (std::size_t s = this->First; s < this->End;)
    {
      std::size_t next = s + 1;
      while (next < this->End && this->Sides[next].Label == this->Sides[s].Label)
      {
        ++next;
      }
      visit(this->Sides[s].Label, next - s);
      s = next;
    }
  }

private:
  const std::vector<Side>& Sides;
  std::size_t First;
  std::size_t End;
  unsigned NumberOfLabels = 0;
};

} // namespace

InterfaceTopology MeasureTopology(
  const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop)
{
  const std::vector<Side> sides = SortedSides(mesh, threads, stop);
  InterfaceTopology topology;
  std::map<std::int64_t, LabelTopology> labels;
  std::vector<PointJunction> points(mesh.Points.size());
  for (std::size_t first = 0; first < sides.size();)
  {
    const EdgeSides edge(sides, first);
    ++topology.InterfaceEdges;
    topology.JunctionEdges += edge.IsJunction();
    for (const std::uint32_t point : sides[first].Edge)
    {
      points[point].JunctionEdges += edge.IsJunction();
    }
    edge.ForEachLabel(
      [&](std::int64_t label, std::size_t facets)
      {
        for (const std::uint32_t point : sides[first].Edge)
        {
          points[point].Add(label);
        }
        if (label != 0)
        {
          LabelTopology& own = labels[label];
          own.Label = label;
          ++own.BoundaryEdges;
          own.NonManifoldEdges += facets != 2;
          own.NonManifoldEdgesAtJunctions += facets != 2 && edge.IsJunction();
        }
      });
    first = edge.GetEnd();
  }
  for (const PointJunction& point : points)
  {
    const bool isCorner = point.NumberOfLabels > 3;
    topology.JunctionPoints += point.JunctionEdges > 0;
    topology.Corners += isCorner;
    topology.IrregularJunctionPoints +=
      point.JunctionEdges > 0 && point.JunctionEdges != 2 && !isCorner;
  }
  for (const auto& [label, own] : labels)
  {
    topology.BoundaryEdges += own.BoundaryEdges;
    topology.NonManifoldEdges += own.NonManifoldEdges;
    topology.NonManifoldEdgesAtJunctions += own.NonManifoldEdgesAtJunctions;
    topology.Labels.push_back(own);
  }
  return topology;
}

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/InterfaceTopology.h"

#include "Quality/InterfaceEdges.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <span>

namespace voxplex
{
namespace
{

/** The labels and junction edges that meet at a point of the mesh. */
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

} // namespace

InterfaceTopology MeasureTopology(
  const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop)
{
  InterfaceTopology topology;
  std::map<std::int64_t, LabelTopology> labels;
  std::vector<PointJunction> points(mesh.Points.size());
  LabelsAtRidge<std::int64_t> around(mesh.FacetLabels);
  const auto addEdge = [&](const auto& ends, std::span<const RidgeUse<3>> uses)
  {
    const std::span<const LabelAtRidge> labelsHere = around.Count(uses);
    const bool isJunction = IsJunction(labelsHere);
    ++topology.InterfaceEdges;
    topology.JunctionEdges += isJunction;
    for (const std::uint32_t point : ends)
    {
      points[point].JunctionEdges += isJunction;
    }
    for (const LabelAtRidge& label : labelsHere)
    {
      for (const std::uint32_t point : ends)
      {
        points[point].Add(label.Label);
      }
      if (label.Label != 0)
      {
        LabelTopology& own = labels[label.Label];
        own.Label = label.Label;
        ++own.BoundaryEdges;
        own.NonManifoldEdges += !IsManifold(label);
        own.NonManifoldEdgesAtJunctions += !IsManifold(label) && isJunction;
      }
    }
  };
  InterfaceRidgeLists<3>(mesh.Facets, mesh.Points.size(), threads, stop).ForEachRidge(addEdge);
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

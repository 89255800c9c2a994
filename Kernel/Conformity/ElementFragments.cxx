// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ElementFragments.h"

#include "Base/DisjointSets.h"
#include "Base/GridIndex.h"
#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

namespace
{

using Index = GridGeometry<3>::Index;

} // namespace

//------------------------------------------------------------------------------------------------
ElementFragments::ElementFragments(
  const LabelledTriangulation<3>& elements, const std::stop_token& stop)
  : Elements(elements)
{
  const Triangulation<3>& mesh = elements.GetTriangulation();
  const std::span<const LabelId> labels = elements.GetLabels();
  DisjointSets sets(labels.size());
  for (SimplexId s = 0; s < labels.size(); ++s)
  {
    if (labels[s] != 0)
    {
      for (const SimplexId n : mesh.GetSimplex(s).N)
      {
        if (n < s && labels[n] == labels[s])
        {
          sets.Join(s, n);
        }
      }
    }
  }
  ThrowIfStopped(stop);
  this->Numbers.assign(labels.size(), None);
  for (std::uint32_t s = 0; s < labels.size(); ++s)
  {
    if (labels[s] == 0)
    {
      continue;
    }
    const std::uint32_t first = sets.Find(s);
    if (first == s)
    {
      this->Numbers[s] = static_cast<std::uint32_t>(this->List.size());
      this->List.push_back({ labels[s] });
    }
    this->Numbers[s] = this->Numbers[first];
  }
  ThrowIfStopped(stop);
}

//------------------------------------------------------------------------------------------------
std::array<Point<3>, 4> ElementFragments::PointsOf(std::size_t element) const
{
  return { this->Elements.PointOf(element, 0), this->Elements.PointOf(element, 1),
    this->Elements.PointOf(element, 2), this->Elements.PointOf(element, 3) };
}

//------------------------------------------------------------------------------------------------
void ElementFragments::MeasureVolumes(const std::vector<bool>& which)
{
  for (std::size_t s = 0; s < this->Size(); ++s)
  {
    if (this->Of(s) != None && which[this->Of(s)])
    {
      const std::array<Point<3>, 4> p = this->PointsOf(s);
      const std::array<const Point<3>*, 4> points = { &p[0], &p[1], &p[2], &p[3] };
      this->List[this->Of(s)].Volume += std::abs(SignedVolume<3>(points.data()));
    }
  }
}

//------------------------------------------------------------------------------------------------
void ElementFragments::FindComponents(const Components<3>& components, const LabelImage<3>& image)
{
  for (const std::int64_t radius : { 0, 1 })
  {
    for (std::size_t s = 0; s < this->Size(); ++s)
    {
      if (this->Of(s) == None || this->List[this->Of(s)].Component != None)
      {
        continue;
      }
      Fragment& fragment = this->List[this->Of(s)];
      Point<3> centroid{};
      for (const Point<3>& p : this->PointsOf(s))
      {
        for (std::size_t a = 0; a < 3; ++a)
        {
          centroid[a] += 0.25 * p[a];
        }
      }
      const Point<3> at = image.Grid().ToIndex(centroid);
      Index low;
      Index high;
      for (std::size_t a = 0; a < 3; ++a)
      {
        const std::int64_t voxel = std::llround(at[a]) - image.CropOrigin()[a];
        low[a] = voxel - radius;
        high[a] = voxel + radius;
      }
      ForEachIndex(low, high,
        [&](const Index& voxel)
        {
          const std::uint32_t c = components.At(voxel);
          if (fragment.Component == None && c != None &&
            components.All()[c].Label == fragment.Label)
          {
            fragment.Component = c;
          }
        });
    }
  }
}

} // namespace voxplex

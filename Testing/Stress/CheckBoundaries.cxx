// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Boundaries of labels are closed and manifold.
#include "Checks.h"

#include <algorithm>
#include <string>

namespace voxplex::stress
{

namespace
{

/** An edge (4D: a triangle) of a facet of the boundary of a label. */
template <int D>
struct Ridge
{
  std::array<std::uint32_t, static_cast<std::size_t>(D - 1)> Vertices; ///< sorted
  std::int64_t Label;

  auto operator<=>(const Ridge&) const = default;
};

template <int D>
std::vector<Ridge<D>> RidgesOf(const SimplexMesh<D>& mesh)
{
  std::vector<Ridge<D>> ridges;
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    auto facet = mesh.Facets[f];
    std::sort(facet.begin(), facet.end());
    for (std::size_t i = 0; i < facet.size(); ++i)
    {
      Ridge<D> ridge;
      for (std::size_t j = 0, to = 0; j < facet.size(); ++j)
      {
        if (j != i)
        {
          ridge.Vertices[to++] = facet[j];
        }
      }
      for (const std::int64_t label : mesh.FacetLabels[f])
      {
        ridge.Label = label;
        ridges.push_back(ridge);
      }
    }
  }
  std::sort(ridges.begin(), ridges.end());
  return ridges;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void CheckBoundaries(const Subject<D>& subject, MeshFigures& figures, Findings& findings)
{
  const std::vector<Ridge<D>> ridges = RidgesOf(subject.Mesh);
  const std::vector<double> planes = subject.PlaneTimes();
  std::uint64_t offPlanes = 0;
  for (std::size_t i = 0; i < ridges.size();)
  {
    std::size_t end = i + 1;
    while (end < ridges.size() && ridges[end] == ridges[i])
    {
      ++end;
    }
    if ((end - i) % 2 != 0)
    {
      findings.Add("open-boundary", "of label " + std::to_string(ridges[i].Label));
    }
    if (end - i != 2 && ridges[i].Label != 0)
    {
      ++figures.NonManifold;
      // A pentatope that keeps its label has four vertices on a plane, and each of its triangles two or three.
      offPlanes += OnOnePlane<D>(subject, planes, ridges[i].Vertices) < 2 ? 1 : 0;
    }
    i = end;
  }
  if (offPlanes > 0 && subject.Of.Options.Interfaces.Manifold)
  {
    findings.Add("non-manifold", std::to_string(offPlanes) + (D == 3 ? " edges" : " triangles"));
  }
}

template void CheckBoundaries<3>(const Subject<3>&, MeshFigures&, Findings&);
template void CheckBoundaries<4>(const Subject<4>&, MeshFigures&, Findings&);

} // namespace voxplex::stress

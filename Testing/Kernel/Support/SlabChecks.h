// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What holds of space-time meshes that conform to time planes. The checks use the points and simplices of a
// mesh only, and share no code with the kernel.
#ifndef voxplex_SlabChecks_h
#define voxplex_SlabChecks_h

#include "MeshChecks.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace voxplex::checks
{

/** A tetrahedron in space, by the coordinates of its corners, and the label of its pentatope. */
struct FlatFacet
{
  std::array<std::array<double, 3>, 4> Corners; ///< sorted
  std::int64_t Label;

  auto operator<=>(const FlatFacet&) const = default;
};

/**
 * The facets with all corners at a time, to the bit, of the pentatopes before (-1) or after it (+1).
 */
inline std::multiset<FlatFacet> FacetsAt(const SimplexMesh<4>& mesh, double time, int side)
{
  std::multiset<FlatFacet> facets;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    const auto& simplex = mesh.Simplices[s];
    for (std::size_t apex = 0; apex < 5; ++apex)
    {
      FlatFacet facet{ {}, mesh.Labels[s] };
      bool isFlat = (mesh.Points[simplex[apex]][3] - time) * side > 0.0;
      for (std::size_t k = 0, m = 0; k < 5; ++k)
      {
        if (k != apex)
        {
          const Point<4>& p = mesh.Points[simplex[k]];
          isFlat = isFlat && p[3] == time;
          facet.Corners[m++] = { p[0], p[1], p[2] };
        }
      }
      if (isFlat)
      {
        std::sort(facet.Corners.begin(), facet.Corners.end());
        facets.insert(facet);
      }
    }
  }
  return facets;
}

/** Slab k of a mesh, and what is wrong with it as a mesh of its own. */
struct SlabReport
{
  std::size_t Pentatopes = 0;
  double Hypervolume = 0.0;
  std::vector<std::string> Complaints;
};

/**
 * @param first, last the times of the slab
 */
inline SlabReport CheckSlab(
  const SimplexMesh<4>& mesh, std::uint32_t slab, double first, double last)
{
  SlabReport report;
  const auto complain = [&report](std::size_t s, const std::string& what)
  {
    std::ostringstream text;
    text << "pentatope " << s << " " << what;
    report.Complaints.push_back(text.str());
  };
  // The pentatopes at each facet, as seen from both sides: the sign says where the apex is.
  std::map<std::array<std::uint32_t, 4>, std::vector<int>> sides;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    if (mesh.Slabs[s] != slab)
    {
      continue;
    }
    ++report.Pentatopes;
    const auto& simplex = mesh.Simplices[s];
    for (const std::uint32_t v : simplex)
    {
      if (mesh.Points[v][3] < first || mesh.Points[v][3] > last)
      {
        complain(s, "leaves its slab");
      }
    }
    const double volume = Volume(mesh, s);
    report.Hypervolume += volume;
    if (!(volume > 0.0))
    {
      complain(s, "has no positive volume");
    }
    for (std::size_t apex = 0; apex < 5; ++apex)
    {
      std::array<std::uint32_t, 4> facet;
      for (std::size_t k = 0, m = 0; k < 5; ++k)
      {
        if (k != apex)
        {
          facet[m++] = simplex[k];
        }
      }
      int sign = apex % 2 == 0 ? 1 : -1;
      for (std::size_t i = 0; i < 4; ++i)
      {
        for (std::size_t j = 0; j < i; ++j)
        {
          sign = facet[j] > facet[i] ? -sign : sign;
        }
      }
      std::sort(facet.begin(), facet.end());
      sides[facet].push_back(sign);
    }
  }
  for (const auto& [facet, signs] : sides)
  {
    if (signs.size() > 2 || (signs.size() == 2 && signs[0] == signs[1]))
    {
      report.Complaints.push_back("a facet has pentatopes that overlap");
    }
  }
  return report;
}

} // namespace voxplex::checks

#endif

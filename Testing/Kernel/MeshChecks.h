// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Invariants of every mesh, computed from the mesh alone and apart from the kernel's own measures.
#ifndef voxplex_MeshChecks_h
#define voxplex_MeshChecks_h

#include "Mesh/SimplexMesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <vector>

namespace voxplex::checks
{

inline Point<3> Cross(const Point<3>& a, const Point<3>& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

inline double Volume(const SimplexMesh<3>& mesh, std::size_t t)
{
  const auto& v = mesh.Simplices[t];
  const Point<3>& o = mesh.Points[v[0]];
  return Dot(Cross(Subtract(mesh.Points[v[1]], o), Subtract(mesh.Points[v[2]], o)),
           Subtract(mesh.Points[v[3]], o)) /
    6.0;
}

inline std::map<std::int64_t, double> Volumes(const SimplexMesh<3>& mesh)
{
  std::map<std::int64_t, double> volumes;
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    volumes[mesh.Labels[t]] += Volume(mesh, t);
  }
  return volumes;
}

inline double Circumradius(const SimplexMesh<3>& mesh, std::size_t t)
{
  const auto& v = mesh.Simplices[t];
  const Point<3>& o = mesh.Points[v[0]];
  const Point<3> a = Subtract(mesh.Points[v[1]], o);
  const Point<3> b = Subtract(mesh.Points[v[2]], o);
  const Point<3> c = Subtract(mesh.Points[v[3]], o);
  const Point<3> bc = Cross(b, c);
  const Point<3> ca = Cross(c, a);
  const Point<3> ab = Cross(a, b);
  Point<3> n;
  for (std::size_t k = 0; k < 3; ++k)
  {
    n[k] = Dot(a, a) * bc[k] + Dot(b, b) * ca[k] + Dot(c, c) * ab[k];
  }
  return std::sqrt(Dot(n, n)) / (2.0 * std::abs(Dot(a, bc)));
}

inline double RadiusEdge(const SimplexMesh<3>& mesh, std::size_t t)
{
  double shortest = std::numeric_limits<double>::infinity();
  for (unsigned i = 0; i < 4; ++i)
  {
    for (unsigned j = 0; j < i; ++j)
    {
      shortest = std::min(
        shortest, Distance(mesh.Points[mesh.Simplices[t][i]], mesh.Points[mesh.Simplices[t][j]]));
    }
  }
  return Circumradius(mesh, t) / shortest;
}

/** Degrees. */
inline double SmallestAngle(const SimplexMesh<3>& mesh, const std::array<std::uint32_t, 3>& f)
{
  double smallest = 180.0;
  for (unsigned i = 0; i < 3; ++i)
  {
    const Point<3> a = Subtract(mesh.Points[f[(i + 1) % 3]], mesh.Points[f[i]]);
    const Point<3> b = Subtract(mesh.Points[f[(i + 2) % 3]], mesh.Points[f[i]]);
    const Point<3> c = Cross(a, b);
    smallest =
      std::min(smallest, std::atan2(std::sqrt(Dot(c, c)), Dot(a, b)) * 180.0 / std::numbers::pi);
  }
  return smallest;
}

/**
 * What is wrong with a mesh, empty if nothing: orientation, use of points, conformity, interfaces
 * against the simplices beside them, closedness of every label's boundary, winding of the facets.
 */
inline std::vector<std::string> Complaints(const SimplexMesh<3>& mesh)
{
  std::vector<std::string> complaints;
  const auto complain = [&](const std::string& text)
  {
    if (complaints.size() < 20)
    {
      complaints.push_back(text);
    }
  };
  using Facet = std::array<std::uint32_t, 3>;
  std::map<Facet, std::vector<std::size_t>> sides;
  std::vector<char> used(mesh.Points.size(), 0);
  if (mesh.Labels.size() != mesh.Simplices.size() || mesh.Facets.size() != mesh.FacetLabels.size())
  {
    complain("arrays of different length");
    return complaints;
  }
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    if (!(Volume(mesh, t) > 0.0))
    {
      complain("inverted tetrahedron");
    }
    if (mesh.Labels[t] == 0)
    {
      complain("tetrahedron of background");
    }
    const auto& v = mesh.Simplices[t];
    for (unsigned i = 0; i < 4; ++i)
    {
      used[v[i]] = 1;
      Facet f = { v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4] };
      std::sort(f.begin(), f.end());
      sides[f].push_back(t);
    }
  }
  if (std::count(used.begin(), used.end(), 0) != 0)
  {
    complain("unused points");
  }
  if (std::set<Point<3>>(mesh.Points.begin(), mesh.Points.end()).size() != mesh.Points.size())
  {
    complain("double points");
  }

  std::map<Facet, std::array<std::int64_t, 2>> expected;
  for (const auto& [f, ts] : sides)
  {
    if (ts.size() > 2)
    {
      complain("facet of more than two tetrahedra");
    }
    const std::int64_t a = mesh.Labels[ts[0]];
    const std::int64_t b = ts.size() == 2 ? mesh.Labels[ts[1]] : 0;
    if (a != b)
    {
      expected[f] = { std::max(a, b), std::min(a, b) };
    }
  }
  if (expected.size() != mesh.Facets.size())
  {
    complain("number of interface facets");
  }
  std::map<std::int64_t, std::map<std::array<std::uint32_t, 2>, int>> edges;
  for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
  {
    Facet f = mesh.Facets[k];
    const Point<3> normal = Cross(Subtract(mesh.Points[f[1]], mesh.Points[f[0]]),
      Subtract(mesh.Points[f[2]], mesh.Points[f[0]]));
    std::sort(f.begin(), f.end());
    const auto it = expected.find(f);
    if (it == expected.end() || it->second != mesh.FacetLabels[k])
    {
      complain("labels of an interface facet");
      continue;
    }
    for (const std::size_t t : sides[f])
    {
      for (const std::uint32_t v : mesh.Simplices[t])
      {
        if (v != f[0] && v != f[1] && v != f[2])
        {
          const double side = Dot(normal, Subtract(mesh.Points[v], mesh.Points[f[0]]));
          if ((mesh.Labels[t] == mesh.FacetLabels[k][0]) != (side < 0.0))
          {
            complain("winding of an interface facet");
          }
        }
      }
    }
    for (const std::int64_t label : mesh.FacetLabels[k])
    {
      for (unsigned i = 0; i < 3; ++i)
      {
        ++edges[label][{ f[i == 0 ? 1u : 0u], f[i == 2 ? 1u : 2u] }];
      }
    }
  }
  for (const auto& [label, counts] : edges)
  {
    for (const auto& [edge, count] : counts)
    {
      if (count % 2 != 0)
      {
        complain("the boundary of label " + std::to_string(label) + " is not closed");
      }
    }
  }
  return complaints;
}

} // namespace voxplex::checks

#endif

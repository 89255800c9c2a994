// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Invariants of every mesh, computed from the mesh alone and apart from the kernel's own measures.
#ifndef voxplex_MeshChecks_h
#define voxplex_MeshChecks_h

#include "Image/GridGeometry.h"
#include "Mesh/SimplexMesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace voxplex::checks
{

/** The simplices of a triangulation, or the cells of a complex, that are alive. */
template <typename Mesh>
std::vector<std::uint32_t> AliveIn(const Mesh& mesh)
{
  std::uint32_t end = 0;
  if constexpr (requires { mesh.SimplexIdEnd(); })
  {
    end = mesh.SimplexIdEnd();
  }
  else
  {
    end = static_cast<std::uint32_t>(mesh.Cells.size());
  }
  std::vector<std::uint32_t> alive;
  for (std::uint32_t s = 0; s < end; ++s)
  {
    if (mesh.IsAlive(s))
    {
      alive.push_back(s);
    }
  }
  return alive;
}

/** The same numbers, in the same order. */
template <int D>
void ExpectSame(const SimplexMesh<D>& a, const SimplexMesh<D>& b)
{
  EXPECT_TRUE(a.Points == b.Points);
  EXPECT_TRUE(a.Simplices == b.Simplices);
  EXPECT_TRUE(a.Labels == b.Labels);
  EXPECT_TRUE(a.Facets == b.Facets);
  EXPECT_TRUE(a.FacetLabels == b.FacetLabels);
  EXPECT_TRUE(a.Slabs == b.Slabs);
  EXPECT_TRUE(a.Twins == b.Twins);
}

/** The facets between labels with their labels, whatever their order and that of their vertices. */
template <int D>
auto InterfacesOf(const SimplexMesh<D>& mesh)
{
  std::set<std::pair<std::set<std::uint32_t>, std::array<std::int64_t, 2>>> interfaces;
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    interfaces.insert({ { mesh.Facets[f].begin(), mesh.Facets[f].end() }, mesh.FacetLabels[f] });
  }
  return interfaces;
}

inline Point<3> Cross(const Point<3>& a, const Point<3>& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

/** By how many voxels a point lies outside of the box of an image that has an object at all its borders. */
inline double DistanceOutside(const GridGeometry<3>& grid, const Point<3>& p)
{
  const Point<3> index = grid.ToIndex(p);
  double distance = 0.0;
  for (std::size_t a = 0; a < 3; ++a)
  {
    distance = std::max(
      { distance, -0.5 - index[a], index[a] + 0.5 - static_cast<double>(grid.Dimensions[a]) });
  }
  return distance;
}

/** Rows and columns. */
template <std::size_t N>
double Determinant(std::array<std::array<double, N>, N> m)
{
  double determinant = 1.0;
  for (std::size_t c = 0; c < N; ++c)
  {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < N; ++r)
    {
      pivot = std::abs(m[r][c]) > std::abs(m[pivot][c]) ? r : pivot;
    }
    if (m[pivot][c] == 0.0)
    {
      return 0.0;
    }
    if (pivot != c)
    {
      std::swap(m[c], m[pivot]);
      determinant = -determinant;
    }
    determinant *= m[c][c];
    for (std::size_t r = c + 1; r < N; ++r)
    {
      const double f = m[r][c] / m[c][c];
      for (std::size_t k = c; k < N; ++k)
      {
        m[r][k] -= f * m[c][k];
      }
    }
  }
  return determinant;
}

/** The vectors from the first point of a simplex to the others. */
template <int D>
std::array<Point<D>, static_cast<std::size_t>(D)> Edges(const SimplexMesh<D>& mesh, std::size_t t)
{
  std::array<Point<D>, static_cast<std::size_t>(D)> edges;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    edges[i] = Subtract(mesh.Points[mesh.Simplices[t][i + 1]], mesh.Points[mesh.Simplices[t][0]]);
  }
  return edges;
}

/** Of D dimensions; negative for inverted simplices. */
template <int D>
double Volume(const SimplexMesh<D>& mesh, std::size_t t)
{
  return Determinant(Edges(mesh, t)) / (D == 3 ? 6.0 : 24.0);
}

template <int D>
std::map<std::int64_t, double> Volumes(const SimplexMesh<D>& mesh)
{
  std::map<std::int64_t, double> volumes;
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    volumes[mesh.Labels[t]] += Volume(mesh, t);
  }
  return volumes;
}

/** Of all labels together. */
template <int D>
double WholeVolume(const SimplexMesh<D>& mesh)
{
  double whole = 0.0;
  for (const auto& [label, volume] : Volumes(mesh))
  {
    whole += volume;
  }
  return whole;
}

/** By Cramer's rule: the centre is as far from the first point as from each other one. */
template <int D>
double Circumradius(const SimplexMesh<D>& mesh, std::size_t t)
{
  const auto edges = Edges(mesh, t);
  const double determinant = Determinant(edges);
  double radius2 = 0.0;
  for (std::size_t c = 0; c < edges.size(); ++c)
  {
    auto replaced = edges;
    for (std::size_t r = 0; r < edges.size(); ++r)
    {
      replaced[r][c] = 0.5 * Dot(edges[r], edges[r]);
    }
    const double x = Determinant(replaced) / determinant;
    radius2 += x * x;
  }
  return std::sqrt(radius2);
}

template <int D>
double ShortestEdge(const SimplexMesh<D>& mesh, std::size_t t)
{
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i <= static_cast<std::size_t>(D); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      shortest = std::min(
        shortest, Distance(mesh.Points[mesh.Simplices[t][i]], mesh.Points[mesh.Simplices[t][j]]));
    }
  }
  return shortest;
}

template <int D>
double RadiusEdge(const SimplexMesh<D>& mesh, std::size_t t)
{
  return Circumradius(mesh, t) / ShortestEdge(mesh, t);
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

/** Right-hand, and twice as long as the facet's area. */
inline Point<3> NormalOf(const SimplexMesh<3>& mesh, const std::array<std::uint32_t, 3>& f)
{
  return Cross(
    Subtract(mesh.Points[f[1]], mesh.Points[f[0]]), Subtract(mesh.Points[f[2]], mesh.Points[f[0]]));
}

inline double AreaOf(const SimplexMesh<3>& mesh, const std::array<std::uint32_t, 3>& f)
{
  const Point<3> normal = NormalOf(mesh, f);
  return 0.5 * std::sqrt(Dot(normal, normal));
}

/** Those of the interface facets. */
template <int D>
std::set<std::uint32_t> VerticesOfInterfaces(const SimplexMesh<D>& mesh)
{
  std::set<std::uint32_t> vertices;
  for (const auto& f : mesh.Facets)
  {
    vertices.insert(f.begin(), f.end());
  }
  return vertices;
}

/** Whether a simplex has the first label of a facet, which is the one behind it. */
template <int D>
bool IsFirstLabel(const SimplexMesh<D>& mesh, std::size_t facet, std::size_t t)
{
  return mesh.Labels[t] == mesh.FacetLabels[facet][0];
}

/** Whether a tetrahedron lies on the side of a facet that its right-hand normal points away from. */
inline bool IsBehind(const SimplexMesh<3>& mesh, std::size_t facet, std::size_t t)
{
  const auto& f = mesh.Facets[facet];
  const Point<3>& origin = mesh.Points[f[0]];
  const Point<3> normal = NormalOf(mesh, f);
  double side = 0.0; // the facet's own vertices add nothing
  for (const std::uint32_t v : mesh.Simplices[t])
  {
    const bool own = std::find(f.begin(), f.end(), v) != f.end();
    side += own ? 0.0 : Dot(normal, Subtract(mesh.Points[v], origin));
  }
  return side < 0.0;
}

/** A face of a facet: an edge in 3D, a triangle in 4D. */
template <int D>
using Ridge = std::array<std::uint32_t, static_cast<std::size_t>(D) - 1>;

/** How many interface facets of each label, background included, have each ridge. */
template <int D>
std::map<std::int64_t, std::map<Ridge<D>, int>> RidgesOfBoundaries(const SimplexMesh<D>& mesh)
{
  std::map<std::int64_t, std::map<Ridge<D>, int>> ridges;
  for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
  {
    auto f = mesh.Facets[k];
    std::sort(f.begin(), f.end());
    for (std::size_t i = 0; i < f.size(); ++i)
    {
      Ridge<D> ridge;
      for (std::size_t j = 0; j < ridge.size(); ++j)
      {
        ridge[j] = f[j < i ? j : j + 1];
      }
      for (const std::int64_t label : mesh.FacetLabels[k])
      {
        ++ridges[label][ridge];
      }
    }
  }
  return ridges;
}

/**
 * What is wrong with a mesh, empty if nothing: orientation, use of points, conformity, interfaces
 * against the simplices beside them, closedness of every label's boundary, winding of the facets in 3D.
 */
template <int D>
std::vector<std::string> Complaints(const SimplexMesh<D>& mesh)
{
  constexpr std::size_t N = static_cast<std::size_t>(D);
  std::vector<std::string> complaints;
  const auto complain = [&](const std::string& text)
  {
    if (complaints.size() < 20)
    {
      complaints.push_back(text);
    }
  };
  using Facet = std::array<std::uint32_t, N>;
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
      complain("inverted simplex");
    }
    if (mesh.Labels[t] == 0)
    {
      complain("simplex of background");
    }
    const auto& v = mesh.Simplices[t];
    for (std::size_t i = 0; i <= N; ++i)
    {
      used[v[i]] = 1;
      Facet f;
      for (std::size_t k = 0; k < N; ++k)
      {
        f[k] = v[(i + 1 + k) % (N + 1)];
      }
      std::sort(f.begin(), f.end());
      sides[f].push_back(t);
    }
  }
  if (std::count(used.begin(), used.end(), 0) != 0)
  {
    complain("unused points");
  }
  if (std::set<Point<D>>(mesh.Points.begin(), mesh.Points.end()).size() != mesh.Points.size())
  {
    complain("double points");
  }

  std::map<Facet, std::array<std::int64_t, 2>> expected;
  for (const auto& [f, ts] : sides)
  {
    if (ts.size() > 2)
    {
      complain("facet of more than two simplices");
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
  for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
  {
    Facet f = mesh.Facets[k];
    std::sort(f.begin(), f.end());
    const auto it = expected.find(f);
    if (it == expected.end() || it->second != mesh.FacetLabels[k])
    {
      complain("labels of an interface facet");
    }
    else if constexpr (D == 3)
    {
      for (const std::size_t t : sides[f])
      {
        if (IsFirstLabel(mesh, k, t) != IsBehind(mesh, k, t))
        {
          complain("winding of an interface facet");
        }
      }
    }
  }
  for (const auto& [label, counts] : RidgesOfBoundaries(mesh))
  {
    for (const auto& [ridge, count] : counts)
    {
      if (count % 2 != 0)
      {
        complain("the boundary of label " + std::to_string(label) + " is not closed");
      }
    }
  }
  return complaints;
}

template <int D>
void ExpectSound(const SimplexMesh<D>& mesh)
{
  const std::vector<std::string> complaints = Complaints(mesh);
  EXPECT_TRUE(complaints.empty()) << complaints.front();
}

/** What holds of every mesh with default options. Facets at junctions may have smaller angles. */
inline void ExpectGood(const SimplexMesh<3>& mesh, double smallestAngle = 30.0)
{
  ExpectSound(mesh);
  ASSERT_FALSE(mesh.Simplices.empty());
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    ASSERT_LT(RadiusEdge(mesh, t), 2.0 + 1e-9);
  }
  for (const auto& f : mesh.Facets)
  {
    ASSERT_GE(SmallestAngle(mesh, f), smallestAngle - 1e-6);
  }
}

} // namespace voxplex::checks

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What must hold of a space-time mesh beside what holds of every mesh (MeshChecks.h): the topology of its
// boundaries, its flat ends, where its boundary lies.
#ifndef voxplex_SpaceTimeChecks_h
#define voxplex_SpaceTimeChecks_h

#include "Domain/ImageDomain.h"
#include "MeshChecks.h"
#include "Mesher/ImageMesher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace voxplex::checks
{

using Tetrahedron = std::array<std::uint32_t, 4>;
using Triangle = std::array<std::uint32_t, 3>;

/** The boundary tetrahedra of one label, background included. */
inline std::vector<Tetrahedron> BoundaryOf(const SimplexMesh<4>& mesh, std::int64_t label)
{
  std::vector<Tetrahedron> boundary;
  for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
  {
    if (mesh.FacetLabels[k][0] == label || mesh.FacetLabels[k][1] == label)
    {
      boundary.push_back(mesh.Facets[k]);
    }
  }
  return boundary;
}

/** Vertices where three or more labels meet, background included. */
inline std::vector<char> Junctions(const SimplexMesh<4>& mesh)
{
  std::vector<std::set<std::int64_t>> labels(mesh.Points.size());
  for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
  {
    for (const std::uint32_t v : mesh.Facets[k])
    {
      labels[v].insert(mesh.FacetLabels[k].begin(), mesh.FacetLabels[k].end());
    }
  }
  std::vector<char> junctions(mesh.Points.size(), 0);
  std::transform(labels.begin(), labels.end(), junctions.begin(),
    [](const std::set<std::int64_t>& l) { return l.size() > 2 ? 1 : 0; });
  return junctions;
}

/** Triangles, given by their vertices, form one closed surface of the Euler characteristic of a sphere. */
inline bool IsSphere(const std::vector<Triangle>& triangles)
{
  std::map<std::array<std::uint32_t, 2>, int> edges;
  std::map<std::uint32_t, std::uint32_t> parent; // union-find
  const auto find = [&](std::uint32_t v)
  {
    while (parent.at(v) != v)
    {
      v = parent.at(v);
    }
    return v;
  };
  for (const Triangle& t : triangles)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      parent.emplace(t[i], t[i]);
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      ++edges[{ low, high }];
      parent[find(low)] = find(high);
    }
  }
  const bool closed =
    std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 2; });
  const auto roots = std::count_if(
    parent.begin(), parent.end(), [](const auto& node) { return node.first == node.second; });
  return closed && roots == 1 && parent.size() + triangles.size() == edges.size() + 2;
}

/** What keeps boundaries from being 3-manifolds. */
struct ManifoldDefects
{
  /** Triangles of the boundary of a label, not background, in more or less than two of its tetrahedra. */
  std::size_t Triangles = 0;
  /** Vertices away from junctions whose link in a label's boundary is no sphere. */
  std::size_t Vertices = 0;
};

/** Boundaries of all labels. */
inline ManifoldDefects FindManifoldDefects(const SimplexMesh<4>& mesh)
{
  const std::vector<char> junctions = Junctions(mesh);
  ManifoldDefects defects;
  for (const auto& [label, triangles] : RidgesOfBoundaries(mesh))
  {
    for (const auto& [t, count] : triangles)
    {
      defects.Triangles += count != 2 && label != 0 ? 1 : 0;
    }
    std::map<std::uint32_t, std::vector<Triangle>> links;
    for (const Tetrahedron& t : BoundaryOf(mesh, label))
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        links[t[i]].push_back({ t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4] });
      }
    }
    for (const auto& [v, link] : links)
    {
      defects.Vertices += !junctions[v] && !IsSphere(link) ? 1 : 0;
    }
  }
  return defects;
}

/** Independent components of the simplices of one label, joined by facets. */
inline std::size_t NumberOfComponents(const SimplexMesh<4>& mesh, std::int64_t label)
{
  std::vector<std::size_t> parent(mesh.Simplices.size());
  std::iota(parent.begin(), parent.end(), std::size_t{ 0 });
  const auto find = [&](std::size_t s)
  {
    while (parent[s] != s)
    {
      s = parent[s] = parent[parent[s]];
    }
    return s;
  };
  std::map<Tetrahedron, std::size_t> first;
  std::size_t components = 0;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    if (mesh.Labels[s] != label)
    {
      continue;
    }
    ++components;
    for (std::size_t i = 0; i < 5; ++i)
    {
      const auto& v = mesh.Simplices[s];
      Tetrahedron f = { v[(i + 1) % 5], v[(i + 2) % 5], v[(i + 3) % 5], v[(i + 4) % 5] };
      std::sort(f.begin(), f.end());
      const auto [found, isNew] = first.emplace(f, s);
      if (!isNew && find(found->second) != find(s))
      {
        parent[find(s)] = find(found->second);
        --components;
      }
    }
  }
  return components;
}

/** First and last time of a mesh's points. */
inline std::pair<double, double> TimeSpan(const SimplexMesh<4>& mesh)
{
  std::pair<double, double> span = { std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity() };
  for (const Point<4>& p : mesh.Points)
  {
    span = { std::min(span.first, p[3]), std::max(span.second, p[3]) };
  }
  return span;
}

/** Whether all vertices of a facet have exactly this time. */
inline bool LiesAt(const SimplexMesh<4>& mesh, const Tetrahedron& f, double time)
{
  return std::all_of(
    f.begin(), f.end(), [&](std::uint32_t v) { return mesh.Points[v][3] == time; });
}

/** 3D volume of a tetrahedron, by what it covers of space. */
inline double SpatialVolume(const SimplexMesh<4>& mesh, const Tetrahedron& f)
{
  std::array<Point<3>, 3> edges;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Point<4> d = Subtract(mesh.Points[f[i + 1]], mesh.Points[f[0]]);
    edges[i] = { d[0], d[1], d[2] };
  }
  return std::abs(Determinant(edges)) / 6.0;
}

/** 3D volume of each label where the mesh ends at a time: the facets there against background. */
inline std::map<std::int64_t, double> EndVolumes(const SimplexMesh<4>& mesh, double time)
{
  std::map<std::int64_t, double> volumes;
  for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
  {
    if (mesh.FacetLabels[k][1] == 0 && LiesAt(mesh, mesh.Facets[k], time))
    {
      volumes[mesh.FacetLabels[k][0]] += SpatialVolume(mesh, mesh.Facets[k]);
    }
  }
  return volumes;
}

/**
 * 3D volume of the cut of a simplex of unit hypervolume by a time: the B-spline of the times of its five
 * vertices (Curry and Schoenberg). From the right where it jumps.
 * @param knots sorted
 */
inline double CutOfUnitSimplex(const double* knots, int n, double time)
{
  const double length = knots[n] - knots[0];
  if (!(length > 0.0) || time < knots[0] || time >= knots[n])
  {
    return 0.0;
  }
  if (n == 1)
  {
    return 1.0 / length;
  }
  return n *
    ((time - knots[0]) * CutOfUnitSimplex(knots, n - 1, time) +
      (knots[n] - time) * CutOfUnitSimplex(knots + 1, n - 1, time)) /
    ((n - 1) * length);
}

/** 3D volume of each label where a time cuts the mesh; just after the time where both differ. */
inline std::map<std::int64_t, double> SliceVolumes(const SimplexMesh<4>& mesh, double time)
{
  std::map<std::int64_t, double> volumes;
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    std::array<double, 5> knots;
    for (std::size_t i = 0; i < 5; ++i)
    {
      knots[i] = mesh.Points[mesh.Simplices[s][i]][3];
    }
    std::sort(knots.begin(), knots.end());
    if (knots[0] <= time && time < knots[4])
    {
      volumes[mesh.Labels[s]] += Volume(mesh, s) * CutOfUnitSimplex(knots.data(), 4, time);
    }
  }
  return volumes;
}

/** Facets that are not on a flat end of the domain. */
inline std::vector<std::size_t> LateralFacets(const SimplexMesh<4>& mesh, const Domain<4>& domain)
{
  const Box<4> box = domain.Bounds();
  std::vector<std::size_t> lateral;
  for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
  {
    const bool onEnd = (domain.HasTimeBorder(0) && LiesAt(mesh, mesh.Facets[k], box.Min[3])) ||
      (domain.HasTimeBorder(1) && LiesAt(mesh, mesh.Facets[k], box.Max[3]));
    if (!onEnd)
    {
      lateral.push_back(k);
    }
  }
  return lateral;
}

/** Whether a point is on an interface of the label field, to a few hundredths of a voxel. */
inline bool IsOnInterface(const LabelField<4>& field, const Point<4>& p)
{
  // The margin of the label that wins rises by about 1 per voxel.
  return field.Margin(p, field.Label(p)) < 0.05;
}

/** The vertices of lateral facets that are on no interface. */
inline std::set<std::uint32_t> VerticesOffInterface(
  const SimplexMesh<4>& mesh, const ImageDomain<4>& domain)
{
  std::set<std::uint32_t> off;
  for (const std::size_t k : LateralFacets(mesh, domain))
  {
    off.insert(mesh.Facets[k].begin(), mesh.Facets[k].end());
  }
  std::erase_if(
    off, [&](std::uint32_t v) { return IsOnInterface(domain.GetLabelField(), mesh.Points[v]); });
  return off;
}

/** Lateral facets with a vertex that is on no interface. */
inline std::size_t CountFacetsOffInterface(const SimplexMesh<4>& mesh, const ImageDomain<4>& domain)
{
  const std::set<std::uint32_t> vertices = VerticesOffInterface(mesh, domain);
  const std::vector<std::size_t> facets = LateralFacets(mesh, domain);
  return static_cast<std::size_t>(std::count_if(facets.begin(), facets.end(),
    [&](std::size_t k)
    {
      const Tetrahedron& f = mesh.Facets[k];
      return std::any_of(f.begin(), f.end(), [&](std::uint32_t v) { return vertices.contains(v); });
    }));
}

/** 3D volume of each label of a frame of an image. */
inline std::map<std::int64_t, double> FrameVolumes(const LabelImage<4>& image, std::int64_t frame)
{
  const auto& n = image.CropDimensions();
  const auto voxels = static_cast<std::size_t>(n[0] * n[1] * n[2]);
  const std::int64_t inCrop = frame - image.CropOrigin()[3];
  const auto& toFrame = image.Grid().IndexToFrame;
  const double voxel = toFrame[0][0] * toFrame[1][1] * toFrame[2][2];
  std::map<std::int64_t, double> volumes;
  if (inCrop >= 0 && inCrop < n[3])
  {
    for (const LabelId id : image.Ids().subspan(static_cast<std::size_t>(inCrop) * voxels, voxels))
    {
      if (id != 0)
      {
        volumes[image.Values()[id]] += voxel;
      }
    }
  }
  return volumes;
}

/** Hypervolume of each label: the frames' volumes, linear between them. */
inline std::map<std::int64_t, double> Hypervolumes(const LabelImage<4>& image)
{
  const std::int64_t frames = image.Grid().Dimensions[3];
  const double step = image.Grid().IndexToFrame[3][3];
  std::map<std::int64_t, double> hypervolumes;
  for (std::int64_t frame = 0; frame < frames; ++frame)
  {
    const double share = frame == 0 || frame + 1 == frames ? 0.5 : 1.0;
    for (const auto& [label, volume] : FrameVolumes(image, frame))
    {
      hypervolumes[label] += share * step * volume;
    }
  }
  return hypervolumes;
}

} // namespace voxplex::checks

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshMeasures.h"

#include "Geometry/Point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxplex::benchmarks
{
namespace
{

constexpr double DegreesPerRadian = 180.0 / std::numbers::pi;

Point<3> Cross(const Point<3>& a, const Point<3>& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

/** Angle between two vectors, degrees. */
double Angle(const Point<3>& a, const Point<3>& b)
{
  return std::acos(std::clamp(Dot(a, b) / std::sqrt(Dot(a, a) * Dot(b, b)), -1.0, 1.0)) *
    DegreesPerRadian;
}

using Corners = std::array<Point<3>, 4>;

Corners CornersOf(const SimplexMesh<3>& mesh, std::size_t t)
{
  Corners p;
  for (std::size_t i = 0; i < 4; ++i)
  {
    p[i] = mesh.Points[mesh.Simplices[t][i]];
  }
  return p;
}

double SixVolumes(const Corners& p)
{
  return Dot(Cross(Subtract(p[1], p[0]), Subtract(p[2], p[0])), Subtract(p[3], p[0]));
}

double RadiusEdgeRatio(const Corners& p)
{
  const Point<3> a = Subtract(p[1], p[0]);
  const Point<3> b = Subtract(p[2], p[0]);
  const Point<3> c = Subtract(p[3], p[0]);
  const Point<3> bc = Cross(b, c);
  const Point<3> ca = Cross(c, a);
  const Point<3> ab = Cross(a, b);
  Point<3> centre;
  for (std::size_t i = 0; i < 3; ++i)
  {
    centre[i] = Dot(a, a) * bc[i] + Dot(b, b) * ca[i] + Dot(c, c) * ab[i];
  }
  const double radius = std::sqrt(Dot(centre, centre)) / (2.0 * std::abs(Dot(a, bc)));
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < 4; ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      shortest = std::min(shortest, Distance(p[i], p[j]));
    }
  }
  return radius / shortest;
}

/** The vertices of the facet opposite to vertex i, counter-clockwise when seen from outside. */
constexpr std::array<std::array<std::size_t, 3>, 4> FacetCorners{ { { 1, 2, 3 }, { 0, 3, 2 },
  { 0, 1, 3 }, { 0, 2, 1 } } };

void MeasureDihedrals(const Corners& p, MeshMeasures& measures)
{
  std::array<Point<3>, 4> normals;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const auto& f = FacetCorners[i];
    normals[i] = Cross(Subtract(p[f[1]], p[f[0]]), Subtract(p[f[2]], p[f[0]]));
  }
  for (std::size_t i = 1; i < 4; ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      const double dihedral = 180.0 - Angle(normals[i], normals[j]);
      measures.DihedralMin = std::min(measures.DihedralMin, dihedral);
      measures.DihedralMax = std::max(measures.DihedralMax, dihedral);
    }
  }
}

struct Facet
{
  std::array<std::uint32_t, 3> Vertices; ///< increasing
  std::array<std::int64_t, 2> Labels;    ///< labels of the two sides; 0 is outside

  bool operator<(const Facet& other) const { return this->Vertices < other.Vertices; }
};

/** The facets whose two sides have different labels. */
std::vector<Facet> InterfaceFacets(const SimplexMesh<3>& mesh)
{
  std::vector<Facet> facets;
  facets.reserve(4 * mesh.Simplices.size());
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    for (const auto& corners : FacetCorners)
    {
      Facet facet{ {}, { mesh.Labels[t], 0 } };
      for (std::size_t k = 0; k < 3; ++k)
      {
        facet.Vertices[k] = mesh.Simplices[t][corners[k]];
      }
      std::sort(facet.Vertices.begin(), facet.Vertices.end());
      facets.push_back(facet);
    }
  }
  std::sort(facets.begin(), facets.end());

  std::size_t kept = 0;
  for (std::size_t i = 0; i < facets.size(); ++i)
  {
    Facet facet = facets[i];
    if (i + 1 < facets.size() && facets[i + 1].Vertices == facet.Vertices)
    {
      facet.Labels[1] = facets[++i].Labels[0];
    }
    if (facet.Labels[0] != facet.Labels[1])
    {
      facets[kept++] = facet;
    }
  }
  facets.resize(kept);
  return facets;
}

/** Whether each vertex has interface facets of three or more labels. */
std::vector<bool> JunctionVertices(const std::vector<Facet>& facets, std::size_t numberOfVertices)
{
  constexpr std::int64_t none = -1;
  std::vector<std::array<std::int64_t, 2>> seen(numberOfVertices, { none, none });
  std::vector<bool> junction(numberOfVertices, false);
  for (const Facet& facet : facets)
  {
    for (const std::uint32_t v : facet.Vertices)
    {
      for (const std::int64_t label : facet.Labels)
      {
        auto place = std::find_if(seen[v].begin(), seen[v].end(),
          [=](std::int64_t known) { return known == label || known == none; });
        if (place == seen[v].end())
        {
          junction[v] = true;
        }
        else
        {
          *place = label;
        }
      }
    }
  }
  return junction;
}

double SmallestPlanarAngle(const SimplexMesh<3>& mesh, const Facet& facet)
{
  double smallest = 180.0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Point<3>& p = mesh.Points[facet.Vertices[k]];
    smallest = std::min(smallest,
      Angle(Subtract(mesh.Points[facet.Vertices[(k + 1) % 3]], p),
        Subtract(mesh.Points[facet.Vertices[(k + 2) % 3]], p)));
  }
  return smallest;
}

void MeasureInterfaces(const SimplexMesh<3>& mesh, MeshMeasures& measures)
{
  constexpr double bound = 30.0 - 1e-6;
  const std::vector<Facet> facets = InterfaceFacets(mesh);
  const std::vector<bool> junction = JunctionVertices(facets, mesh.Points.size());
  measures.InterfaceFacets = facets.size();
  for (const Facet& facet : facets)
  {
    const double angle = SmallestPlanarAngle(mesh, facet);
    measures.PlanarMin = std::min(measures.PlanarMin, angle);
    measures.PlanarBelow30 += angle < bound;
    if (std::none_of(facet.Vertices.begin(), facet.Vertices.end(),
          [&](std::uint32_t v) { return junction[v]; }))
    {
      measures.PlanarMinAwayFromJunctions = std::min(measures.PlanarMinAwayFromJunctions, angle);
      measures.PlanarBelow30AwayFromJunctions += angle < bound;
    }
  }
}

void MeasureLabels(const LabelVolumes& mesh, const LabelVolumes& image, MeshMeasures& measures)
{
  measures.LabelsInImage = image.size();
  double total = 0.0;
  double difference = 0.0;
  for (const auto& [label, volume] : image)
  {
    const auto found = mesh.find(label);
    measures.LabelsLost += found == mesh.end();
    total += volume;
    difference += std::abs((found == mesh.end() ? 0.0 : found->second) - volume);
  }
  measures.VolumeError = difference / total;
}

} // namespace

LabelVolumes VolumesOf(const LabelVolume& image)
{
  const double voxel = image.Spacing[0] * image.Spacing[1] * image.Spacing[2];
  std::vector<std::uint64_t> voxels(1 << 16, 0);
  for (const std::uint16_t label : image.Labels)
  {
    ++voxels[label];
  }
  LabelVolumes volumes;
  for (std::size_t label = 1; label < voxels.size(); ++label)
  {
    if (voxels[label] != 0)
    {
      volumes[static_cast<std::int64_t>(label)] = voxel * static_cast<double>(voxels[label]);
    }
  }
  return volumes;
}

MeshMeasures Measure(const SimplexMesh<3>& mesh, const LabelVolumes& image)
{
  MeshMeasures measures;
  measures.Tetrahedra = mesh.Simplices.size();
  LabelVolumes volumes;
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    const Corners corners = CornersOf(mesh, t);
    const double volume = SixVolumes(corners) / 6.0;
    volumes[mesh.Labels[t]] += volume;
    measures.Inverted += !(volume > 0.0);
    measures.RadiusEdgeMax = std::max(measures.RadiusEdgeMax, RadiusEdgeRatio(corners));
    MeasureDihedrals(corners, measures);
  }
  MeasureLabels(volumes, image, measures);
  MeasureInterfaces(mesh, measures);
  return measures;
}

} // namespace voxplex::benchmarks

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Images and meshes whose interfaces are hard, and what is wrong with them.
#ifndef voxplex_InterfaceChecks_h
#define voxplex_InterfaceChecks_h

#include "BallDomain.h"
#include "ComplexOf.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Quality/InterfaceEdges.h"
#include "Sizing/Grading/PointBounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace voxplex::checks
{

/** Calls function(voxel, next) for both sides of all faces between voxels of different labels. */
template <typename Function>
void ForEachFace(const LabelImage<3>& image, Function&& function)
{
  const auto& n = image.CropDimensions();
  GridGeometry<3>::Index voxel;
  for (voxel[2] = -1; voxel[2] < n[2]; ++voxel[2])
  {
    for (voxel[1] = -1; voxel[1] < n[1]; ++voxel[1])
    {
      for (voxel[0] = -1; voxel[0] < n[0]; ++voxel[0])
      {
        for (std::size_t a = 0; a < 3; ++a)
        {
          GridGeometry<3>::Index next = voxel;
          ++next[a];
          if (image.At(voxel) != image.At(next))
          {
            function(voxel, next);
          }
        }
      }
    }
  }
}

/** Edges at which the number of facets of a label's boundary is not two; background does not count as a label. */
inline std::set<std::array<std::uint32_t, 2>> BadEdges(const SimplexMesh<3>& mesh)
{
  std::set<std::array<std::uint32_t, 2>> bad;
  for (const auto& [label, ridges] : RidgesOfBoundaries(mesh))
  {
    for (const auto& [edge, count] : ridges)
    {
      if (label != 0 && count != 2)
      {
        bad.insert({ edge[0], edge[1] });
      }
    }
  }
  return bad;
}

/** Blobs of two labels in a third, and holes. */
inline LabelImage<3> Blobs(unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<std::array<double, 5>> blobs;
  for (int k = 0; k < 60; ++k)
  {
    blobs.push_back({ 4.0 + random() % 24, 4.0 + random() % 24, 4.0 + random() % 24,
      1.5 + 0.01 * (random() % 250), static_cast<double>(random() % 3) });
  }
  return phantoms::Make(phantoms::Cube(32),
    [=](const Point<3>& p) -> std::int16_t
    {
      for (const auto& b : blobs)
      {
        if (Distance(p, { b[0], b[1], b[2] }) < b[3])
        {
          return static_cast<std::int16_t>(b[4]);
        }
      }
      return Distance(p, { 15.5, 15.5, 15.5 }) < 13.0 ? 3 : 0;
    });
}

inline SimplexMesh<3> Mesh(const LabelImage<3>& image, double delta, unsigned rounds,
  MeshingStatistics* statistics = nullptr, unsigned threads = 1)
{
  MeshingOptions<3> options = WithDelta<3>(delta);
  options.Interfaces.Rounds = rounds;
  options.Interfaces.Manifold = rounds > 0; // without rounds nothing is repaired
  options.Team.Threads = threads;
  SimplexMesh<3> mesh = MeshOf(image, options, statistics);
  ExpectSound(mesh);
  return mesh;
}

struct RingShape
{
  double Height = 0.9; ///< half of the edge's length; below 1 tetrahedra around it are Delaunay
  std::vector<double> Degrees; ///< of each tetrahedron; empty: all alike
  bool HasCaps = false;        ///< each tetrahedron has a neighbour of its label below
  /** Number of a vertex between two tetrahedra of a label, which four more of them enclose; 0: none. */
  std::uint32_t Inner = 0;
};

/** Tetrahedra around an edge with the labels given, in a ring of radius 1; none where the label is 0. */
inline SimplexMesh<3> Ring(const std::vector<std::int64_t>& labels, const RingShape& shape = {})
{
  const double height = shape.Height;
  SimplexMesh<3> mesh;
  mesh.Points.push_back({ 0.0, 0.0, -height });
  mesh.Points.push_back({ 0.0, 0.0, height });
  const std::size_t n = labels.size();
  std::vector<double> angles{ 0.0 };
  for (std::size_t k = 0; k < n; ++k)
  {
    const double degrees =
      shape.Degrees.empty() ? 360.0 / static_cast<double>(n) : shape.Degrees[k];
    mesh.Points.push_back({ std::cos(angles[k]), std::sin(angles[k]), 0.0 });
    angles.push_back(angles[k] + degrees * std::numbers::pi / 180.0);
  }
  std::map<std::array<std::uint32_t, 3>, std::vector<std::size_t>> sides;
  constexpr unsigned outward[4][3] = { { 1, 2, 3 }, { 2, 0, 3 }, { 0, 1, 3 }, { 1, 0, 2 } };
  for (std::size_t k = 0; k < n; ++k)
  {
    if (labels[k] == 0)
    {
      continue;
    }
    const auto first = static_cast<std::uint32_t>(2 + k);
    const auto second = static_cast<std::uint32_t>(2 + (k + 1) % n);
    mesh.Simplices.push_back({ 0, 1, first, second });
    mesh.Labels.push_back(labels[k]);
    if (shape.HasCaps)
    {
      const double middle = 0.5 * (angles[k] + angles[k + 1]);
      const auto apex = static_cast<std::uint32_t>(mesh.Points.size());
      mesh.Points.push_back({ 0.2 * std::cos(middle), 0.2 * std::sin(middle), -height - 1.25 });
      mesh.Simplices.push_back({ apex, 0, first, second });
      mesh.Labels.push_back(labels[k]);
    }
  }
  if (shape.Inner != 0)
  {
    const std::uint32_t inner = 2 + shape.Inner;
    const auto outer = static_cast<std::uint32_t>(mesh.Points.size());
    mesh.Points.push_back({ 2.0 * mesh.Points[inner][0], 2.0 * mesh.Points[inner][1], 0.0 });
    for (const std::uint32_t pole : { 0u, 1u })
    {
      for (const std::uint32_t beside : { inner - 1, inner + 1 })
      {
        const bool isTurned = (pole == 0) != (beside < inner);
        mesh.Simplices.push_back(
          { pole, outer, isTurned ? beside : inner, isTurned ? inner : beside });
        mesh.Labels.push_back(labels[shape.Inner]);
      }
    }
  }
  const auto keyOf = [&](std::size_t t, unsigned i)
  {
    const auto& v = mesh.Simplices[t];
    std::array<std::uint32_t, 3> key{ v[outward[i][0]], v[outward[i][1]], v[outward[i][2]] };
    std::sort(key.begin(), key.end());
    return key;
  };
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      sides[keyOf(t, i)].push_back(t);
    }
  }
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    for (unsigned i = 0; i < 4; ++i)
    {
      std::int64_t other = 0;
      for (const std::size_t s : sides[keyOf(t, i)])
      {
        other = s != t ? mesh.Labels[s] : other;
      }
      if (other < mesh.Labels[t])
      {
        const auto& v = mesh.Simplices[t];
        mesh.Facets.push_back({ v[outward[i][0]], v[outward[i][1]], v[outward[i][2]] });
        mesh.FacetLabels.push_back({ mesh.Labels[t], other });
      }
    }
  }
  return mesh;
}

/** Adds another mesh, so far along each axis. */
inline void Append(const SimplexMesh<3>& other, double offset, SimplexMesh<3>& mesh)
{
  const auto first = static_cast<std::uint32_t>(mesh.Points.size());
  for (Point<3> p : other.Points)
  {
    for (double& x : p)
    {
      x += offset;
    }
    mesh.Points.push_back(p);
  }
  for (auto cell : other.Simplices)
  {
    for (std::uint32_t& v : cell)
    {
      v += first;
    }
    mesh.Simplices.push_back(cell);
  }
  for (auto facet : other.Facets)
  {
    for (std::uint32_t& v : facet)
    {
      v += first;
    }
    mesh.Facets.push_back(facet);
  }
  mesh.Labels.insert(mesh.Labels.end(), other.Labels.begin(), other.Labels.end());
  mesh.FacetLabels.insert(
    mesh.FacetLabels.end(), other.FacetLabels.begin(), other.FacetLabels.end());
}

/** Four tetrahedra around an edge that is not manifold. If one changes its label, a facet with 25 degrees appears. */
inline SimplexMesh<3> SharpRing()
{
  RingShape shape;
  shape.Height = 0.15;
  shape.Degrees = { 25.0, 155.0, 25.0, 155.0 };
  shape.HasCaps = true;
  return Ring({ 1, 2, 1, 2 }, shape);
}

/** Labels are their own values. */
class PlainLabels : public BallDomain
{
public:
  PlainLabels()
    : BallDomain(1.0)
  {
  }
  std::int64_t LabelValue(LabelId id) const override { return id; }
};

/** Tetrahedra that are Delaunay, as part of a triangulation of a box around them. */
class Triangulated
{
public:
  explicit Triangulated(const SimplexMesh<3>& mesh)
  {
    Box<3> box = BoundsOf<3>(mesh.Points);
    for (std::size_t a = 0; a < 3; ++a)
    {
      box.Min[a] -= 10.0;
      box.Max[a] += 10.0;
    }
    this->Source = std::make_unique<Triangulation<3>>(box);
    Triangulation<3>::Worker worker(*this->Source);
    for (const Point<3>& p : mesh.Points)
    {
      const SimplexId conflict = this->Source->FindConflict(worker, p, this->Source->FirstAlive());
      EXPECT_EQ(
        this->Source->Insert(worker, p, VertexKind::Feature, conflict), InsertionOutcome::Inserted);
    }
    std::map<std::set<Point<3>>, std::int64_t> labels;
    for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
    {
      std::set<Point<3>> corners;
      for (const std::uint32_t v : mesh.Simplices[t])
      {
        corners.insert(mesh.Points[v]);
      }
      labels[corners] = mesh.Labels[t];
    }
    std::size_t found = 0;
    this->Labels.assign(this->Source->SimplexIdEnd(), 0);
    for (SimplexId s = 0; s < this->Labels.size(); ++s)
    {
      std::set<Point<3>> corners;
      for (unsigned i = 0; i < 4 && this->Source->IsAlive(s); ++i)
      {
        corners.insert(this->Source->Position(this->Source->GetSimplex(s).V[i]));
      }
      const auto label = labels.find(corners);
      if (label != labels.end())
      {
        this->Labels[s] = static_cast<LabelId>(label->second);
        ++found;
      }
    }
    EXPECT_EQ(found, mesh.Simplices.size()) << "not Delaunay";
  }

  SimplexMesh<3> Extract() const
  {
    SimplexMesh<3> mesh;
    ExtractMesh<3>(*this->Source, PlainLabels(), this->Labels, mesh);
    return mesh;
  }

  std::unique_ptr<Triangulation<3>> Source;
  SimplexLabels Labels; ///< of each simplex id
};

/** Those of a mesh. */
inline std::vector<InterfaceEdge> NonManifoldEdges(const SimplexMesh<3>& mesh)
{
  return FindNonManifoldRidges<3>(mesh.Facets, mesh.FacetLabels, mesh.Points.size());
}

} // namespace voxplex::checks

#endif

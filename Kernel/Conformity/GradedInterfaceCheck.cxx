// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/GradedInterfaceCheck.h"

#include "Conformity/FaceScan.h"
#include "Conformity/NonManifoldRidges.h"
#include "Geometry/BoundingTree.h"
#include "Refinement/FeatureGrid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace voxplex
{

namespace
{

/**
 * The largest allowed distance of the mesh from interfaces, in finest sampling distances. Uniform
 * meshes are about as far away.
 */
constexpr double SurfaceDistance = 1.22;

/** The mesh may be farther from voxel faces by this factor, because voxel faces form stairs. */
constexpr double StairFactor = 1.15;

} // namespace

//------------------------------------------------------------------------------------------------
GradedInterfaceCheck::GradedInterfaceCheck(const LabelImage<3>& image, const BitMask<3>& sites,
  const Domain<3>& domain, const SizingField<3>& sizing, LocalDelta<3>& local, unsigned threads,
  const std::stop_token& stop)
  : Image(image)
  , Sites(sites)
  , Surfaces(domain)
  , Sampling(image, sites, domain, sizing, local, stop)
  , Threads(threads)
  , Stop(stop)
  , Largest(LargestDistance(image.Grid(), sizing.Base().Asked))
{
}

//------------------------------------------------------------------------------------------------
double GradedInterfaceCheck::LargestDistance(const GridGeometry<3>& grid, double delta)
{
  return std::max(SurfaceDistance * delta, 0.5 * grid.VoxelDiagonal());
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> GradedInterfaceCheck::Inspect(
  const LabelledTriangulation<3>& elements, const std::vector<NonManifoldPlace<3>>& edges)
{
  const Triangulation<3>& triangulation = elements.GetTriangulation();
  const InterfaceFacets<3> interfaces =
    FindInterfaceFacets<3>(triangulation, elements.GetLabels(), this->Threads, this->Stop);
  FeatureGrid<3> vertices({ 0.0, 0.0, 0.0 }, this->Largest, interfaces.Facets.size() / 2);
  std::vector<Triangle> all;
  all.reserve(interfaces.Facets.size());
  std::vector<bool> isAdded(triangulation.VertexIdEnd());
  for (const auto& facet : interfaces.Facets)
  {
    all.push_back({ triangulation.Position(facet[0]), triangulation.Position(facet[1]),
      triangulation.Position(facet[2]) });
    for (const VertexId v : facet)
    {
      if (!isAdded[v])
      {
        isAdded[v] = true;
        vertices.Add(triangulation.Position(v));
      }
    }
  }
  const BoundingTree<Triangle> triangles(std::move(all), this->Threads, this->Stop);

  // Checks the voxel face, and the smooth interface near it, which is the interface that is meshed.
  using Hint = std::uint32_t; // see BoundingTree
  const auto isFar = [&](const VoxelFace<3>& face, Hint& hint)
  {
    const Point<3> centre = CentreOf(face, this->Image);
    const double half = 0.5 * this->Image.Grid().Spacing(static_cast<int>(face.Axis));
    if (this->Largest > half && vertices.AnyWithin(centre, this->Largest - half))
    {
      return false;
    }
    const double distance = std::sqrt(triangles.Distance2To(centre, hint));
    if (distance > StairFactor * this->Largest)
    {
      return true;
    }
    Point<3> z;
    return distance + half > this->Largest &&
      this->Surfaces.FirstCrossing(this->Image.CentreOf(face.Voxel), this->Image.At(face.Voxel),
        this->Image.CentreOf(face.Next()), z) &&
      triangles.Distance2To(z, hint) > this->Largest * this->Largest;
  };
  std::vector<VoxelFace<3>> far = FilterFaces<Hint, 3>(this->Sampling.Sampled(), isFar);
  if (far.empty())
  {
    far = ScanFaces<Hint, 3>(this->Image, this->Sites, this->Threads, this->Stop, isFar);
  }
  this->FarFaces = far.size();
  return this->Sampling.AroundIfBad(far, edges);
}

} // namespace voxplex

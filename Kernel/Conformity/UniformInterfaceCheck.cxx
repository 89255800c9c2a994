// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/UniformInterfaceCheck.h"

#include "Conformity/FaceScan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace voxplex
{

namespace
{

/**
 * If vertices are closer to each other than this factor times NearVoxel, one of them is enough to
 * clear the voxels around them.
 */
constexpr double ClearingDistance = 0.25;

/**
 * A subset of the points, at least `distance` apart. Each other point is closer than that to one of
 * the subset.
 */
std::vector<Point<3>> ThinOut(const std::vector<Point<3>>& points, double distance)
{
  FeatureGrid<3> kept({ 0.0, 0.0, 0.0 }, distance, points.size());
  std::vector<Point<3>> some;
  for (const Point<3>& p : points)
  {
    if (!kept.AnyWithin(p, distance))
    {
      kept.Add(p);
      some.push_back(p);
    }
  }
  return some;
}

} // namespace

//------------------------------------------------------------------------------------------------
UniformInterfaceCheck::UniformInterfaceCheck(const LabelImage<3>& image, const BitMask<3>& sites,
  const Domain<3>& domain, const SizingField<3>& sizing, LocalDelta<3>& local, unsigned threads,
  const std::stop_token& stop)
  : Image(image)
  , Sites(sites)
  , Sizing(sizing)
  , Sampling(image, sites, domain, sizing, local, stop)
  , Threads(threads)
  , Stop(stop)
  , VoxelDiagonal(image.Grid().VoxelDiagonal())
  , Reach(std::max(LargestDistance * sizing.Largest(), VoxelDiagonal))
{
  if (sizing.IsUniform())
  {
    constexpr double Safety = 1.0 - 1e-6;
    // The result is positive, because Reach is at least the voxel's diagonal.
    this->NearVoxel = Safety * (this->Reach - 0.5 * image.Grid().LargestSpacing());
  }
}

//------------------------------------------------------------------------------------------------
double UniformInterfaceCheck::LargestDistanceOf(const VoxelFace& face, const Point<3>& centre) const
{
  const double asked =
    this->Sizing.AskedDistance(centre, this->Image.At(face.Voxel), this->Image.At(face.Next()));
  return std::max(LargestDistance * asked, this->VoxelDiagonal);
}

bool UniformInterfaceCheck::IsFar(const VoxelFace& face, Hint& known) const
{
  const Point<3> centre = CentreOf(face, this->Image);
  const double distance = this->LargestDistanceOf(face, centre);
  if (known && Distance2(centre, *known) < distance * distance)
  {
    return false;
  }
  // A near vertex serves more of the adjacent faces than a far one.
  known = this->Vertices->FindWithin(centre, 0.5 * distance);
  if (!known)
  {
    known = this->Vertices->FindWithin(centre, distance);
  }
  return !known;
}

//------------------------------------------------------------------------------------------------
// Clears the ball row by row. IndexToFrame is upper triangular, so z and y of the frame are
// constant along a row.
void UniformInterfaceCheck::ClearVoxelsNear(const Point<3>& p, BitMask<3>& voxels) const
{
  const GridGeometry<3>::Matrix& m = this->Image.Grid().IndexToFrame;
  const auto& n = voxels.Dimensions();
  Point<3> x = this->Image.Grid().ToIndex(p); // in the mask: the crop and one layer around it
  for (std::size_t a = 0; a < 3; ++a)
  {
    x[a] -= static_cast<double>(this->Image.CropOrigin()[a] - 1);
  }
  // The positions along an axis within half a width of a centre. The square of half a width is
  // rounded.
  const auto places = [&](std::size_t a, double centre, double half2)
  {
    const double half = std::sqrt(std::max(half2, 0.0)) / m[a][a];
    return std::pair{ std::max<std::int64_t>(
                        static_cast<std::int64_t>(std::ceil(centre - half)), 0),
      std::min(static_cast<std::int64_t>(std::floor(centre + half)), n[a] - 1) };
  };
  const double radius2 = this->NearVoxel * this->NearVoxel;
  const auto layers = places(2, x[2], radius2);
  for (std::int64_t k = layers.first; k <= layers.second; ++k)
  {
    const double dz = static_cast<double>(k) - x[2];
    const double left2 = radius2 - m[2][2] * dz * m[2][2] * dz;
    const auto rows = places(1, x[1] - m[1][2] * dz / m[1][1], left2);
    for (std::int64_t j = rows.first; j <= rows.second; ++j)
    {
      const double dy = static_cast<double>(j) - x[1];
      const double y = m[1][1] * dy + m[1][2] * dz;
      const auto [first, last] =
        places(0, x[0] - (m[0][1] * dy + m[0][2] * dz) / m[0][0], left2 - y * y);
      voxels.ClearRun({ first, j, k }, last);
    }
  }
}

//------------------------------------------------------------------------------------------------
std::vector<VoxelFace> UniformInterfaceCheck::FindAllFar(
  const std::vector<Point<3>>& vertices) const
{
  BitMask<3> voxels = this->Sites;
  if (this->NearVoxel > 0.0)
  {
    // Vertices may be much denser than the sampling distance. The scan below uses all of them.
    const std::vector<Point<3>> some = ThinOut(vertices, ClearingDistance * this->NearVoxel);
    ParallelFor(
      0, some.size(), 1024, this->Threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          this->ClearVoxelsNear(some[i], voxels);
        }
      },
      this->Stop);
  }
  return ScanFaces<Hint>(this->Image, voxels, this->Threads, this->Stop,
    [this](const VoxelFace& face, Hint& known) { return this->IsFar(face, known); });
}

/** The far faces among those that were sampled, and those near to vertices that are gone. */
std::vector<VoxelFace> UniformInterfaceCheck::FindFarAgain(const std::vector<Point<3>>& gone) const
{
  std::vector<SearchBall> balls;
  balls.reserve(gone.size());
  for (const Point<3>& p : gone)
  {
    balls.push_back({ p, this->Reach + 1e-6 * this->VoxelDiagonal }); // tolerates rounding
  }
  const std::vector<VoxelFace> near = FindFacesNear(this->Image, this->Sites, balls, this->Stop);
  return FilterFaces<Hint>(UnionOf(this->Sampling.Sampled(), near),
    [this](const VoxelFace& face, Hint& known) { return this->IsFar(face, known); });
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> UniformInterfaceCheck::InspectVertices(
  const InterfaceVertices::Changes& changes)
{
  const bool isFirst = !this->Vertices;
  if (isFirst)
  {
    this->Vertices.emplace(Point<3>{ 0.0, 0.0, 0.0 }, this->Reach, changes.Added.size());
  }
  for (const Point<3>& p : changes.Gone)
  {
    this->Vertices->Remove(p);
  }
  for (const Point<3>& p : changes.Added)
  {
    this->Vertices->Add(p);
  }
  const std::vector<VoxelFace> far =
    isFirst ? this->FindAllFar(changes.Added) : this->FindFarAgain(changes.Gone);
  this->FarFaces = far.size();
  return this->Sampling.Around(far, {});
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> UniformInterfaceCheck::InspectLabels(
  const std::vector<Point<3>>& gone, const std::vector<NonManifoldPlace>& edges)
{
  std::vector<Point<3>> removed;
  std::copy_if(gone.begin(), gone.end(), std::back_inserter(removed),
    [&](const Point<3>& p) { return this->Vertices->Remove(p); });
  const std::vector<VoxelFace> far = this->FindFarAgain(removed);
  for (const Point<3>& p : removed)
  {
    this->Vertices->Add(p);
  }
  this->FarFaces = far.size();
  return this->Sampling.AroundIfBad(far, edges);
}

} // namespace voxplex

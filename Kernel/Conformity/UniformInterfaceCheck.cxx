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

constexpr std::size_t Grain = 1024;

/** The voxel whose centre is nearest along each axis. */
template <int D>
typename GridGeometry<D>::Index NearestVoxel(
  const Point<D>& place, const typename GridGeometry<D>::Index& dimensions)
{
  typename GridGeometry<D>::Index voxel;
  for (std::size_t a = 0; a < D; ++a)
  {
    voxel[a] = std::clamp<std::int64_t>(std::llround(place[a]), 0, dimensions[a] - 1);
  }
  return voxel;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
UniformInterfaceCheck<D>::UniformInterfaceCheck(const LabelImage<D>& image, const BitMask<D>& sites,
  const Domain<D>& domain, const SizingField<D>& sizing, LocalDelta<D>& local, unsigned threads,
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
template <int D>
double UniformInterfaceCheck<D>::LargestDistanceOf(
  const VoxelFace<D>& face, const Point<D>& centre) const
{
  const double asked =
    this->Sizing.AskedDistance(centre, this->Image.At(face.Voxel), this->Image.At(face.Next()));
  return std::max(LargestDistance * asked, this->VoxelDiagonal);
}

template <int D>
bool UniformInterfaceCheck<D>::IsFar(const VoxelFace<D>& face, Hint& known) const
{
  const Point<D> centre = CentreOf(face, this->Image);
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
// The mask has the voxels of the crop and one layer around it.
template <int D>
Point<D> UniformInterfaceCheck<D>::PlaceInMask(const Point<D>& p) const
{
  Point<D> place = this->Image.Grid().ToIndex(p);
  for (std::size_t a = 0; a < D; ++a)
  {
    place[a] -= static_cast<double>(this->Image.CropOrigin()[a] - 1);
  }
  return place;
}

// Clears the ball row by row. IndexToFrame is upper triangular, so along an axis the coordinates of
// all later axes are constant.
template <int D>
void UniformInterfaceCheck<D>::ClearVoxelsNear(const Point<D>& centre, BitMask<D>& voxels) const
{
  Index voxel{};
  this->ClearVoxelsNear(centre, D - 1, this->NearVoxel * this->NearVoxel, voxel, voxels);
}

/**
 * Clears the voxels of a ball whose indices along the axes after `axis` are given.
 * @param left2 the squared radius, less the squared distance along these axes
 */
template <int D>
void UniformInterfaceCheck<D>::ClearVoxelsNear(
  const Point<D>& centre, std::size_t axis, double left2, Index& voxel, BitMask<D>& voxels) const
{
  const auto& m = this->Image.Grid().IndexToFrame;
  double middle = centre[axis]; // where the distance along this axis is 0
  for (std::size_t a = axis + 1; a < D; ++a)
  {
    middle -= m[axis][a] * (static_cast<double>(voxel[a]) - centre[a]) / m[axis][axis];
  }
  const double half = std::sqrt(std::max(left2, 0.0)) / m[axis][axis]; // left2 is rounded
  const auto first = std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(middle - half)), 0);
  const auto last =
    std::min(static_cast<std::int64_t>(std::floor(middle + half)), voxels.Dimensions()[axis] - 1);
  voxel[axis] = first;
  if (axis == 0)
  {
    voxels.ClearRun(voxel, last);
    return;
  }
  for (; voxel[axis] <= last; ++voxel[axis])
  {
    const double away = m[axis][axis] * (static_cast<double>(voxel[axis]) - middle);
    this->ClearVoxelsNear(centre, axis - 1, left2 - away * away, voxel, voxels);
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<VoxelFace<D>> UniformInterfaceCheck<D>::FindAllFar(
  std::span<const Point<D>> vertices) const
{
  BitMask<D> voxels = this->Sites;
  if (this->NearVoxel > 0.0)
  {
    // Vertices may be much denser than voxels. Those of one voxel clear nearly the same voxels, so
    // one of them is enough. The scan below uses all.
    BitMask<D> isUsed(voxels.Dimensions());
    ParallelFor(
      0, vertices.size(), Grain, this->Threads,
      [&](std::size_t first, std::size_t last)
      {
        for (const Point<D>& p : vertices.subspan(first, last - first))
        {
          const Point<D> place = this->PlaceInMask(p);
          if (isUsed.SetIfClear(NearestVoxel<D>(place, isUsed.Dimensions())))
          {
            this->ClearVoxelsNear(place, voxels);
          }
        }
      },
      this->Stop);
  }
  return ScanFaces<Hint, D>(this->Image, voxels, this->Threads, this->Stop,
    [this](const VoxelFace<D>& face, Hint& known) { return this->IsFar(face, known); });
}

/** The far faces among those that were sampled, and those near to vertices that are gone. */
template <int D>
std::vector<VoxelFace<D>> UniformInterfaceCheck<D>::FindFarAgain(
  const std::vector<Point<D>>& gone) const
{
  std::vector<SearchBall<D>> balls;
  balls.reserve(gone.size());
  for (const Point<D>& p : gone)
  {
    balls.push_back({ p, this->Reach + 1e-6 * this->VoxelDiagonal }); // tolerates rounding
  }
  const std::vector<VoxelFace<D>> near =
    FindFacesNear<D>(this->Image, this->Sites, balls, this->Stop);
  return FilterFaces<Hint, D>(UnionOf(this->Sampling.Sampled(), near),
    [this](const VoxelFace<D>& face, Hint& known) { return this->IsFar(face, known); });
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<FeatureSeed<D>> UniformInterfaceCheck<D>::InspectVertices(
  const typename InterfaceVertices<D>::Changes& changes)
{
  const bool isFirst = !this->Vertices;
  if (isFirst)
  {
    // With one sampling distance all queries are of the first level.
    this->Vertices.emplace(Point<D>{}, this->Reach, changes.Added.size(),
      this->Sizing.IsUniform() ? 1 : FeatureGrid<D>::Levels);
  }
  for (const Point<D>& p : changes.Gone)
  {
    this->Vertices->Remove(p);
  }
  ParallelFor(
    0, changes.Added.size(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (const Point<D>& p : changes.Added.subspan(first, last - first))
      {
        this->Vertices->Add(p);
      }
    },
    this->Stop);
  const std::vector<VoxelFace<D>> far =
    isFirst ? this->FindAllFar(changes.Added) : this->FindFarAgain(changes.Gone);
  this->FarFaces = far.size();
  return this->Sampling.Around(far, {});
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<FeatureSeed<D>> UniformInterfaceCheck<D>::InspectLabels(
  const std::vector<Point<D>>& gone, const std::vector<NonManifoldPlace<D>>& edges)
{
  std::vector<Point<D>> removed;
  std::copy_if(gone.begin(), gone.end(), std::back_inserter(removed),
    [&](const Point<D>& p) { return this->Vertices->Remove(p); });
  const std::vector<VoxelFace<D>> far = this->FindFarAgain(removed);
  for (const Point<D>& p : removed)
  {
    this->Vertices->Add(p);
  }
  this->FarFaces = far.size();
  return this->Sampling.AroundIfBad(far, edges);
}

template class UniformInterfaceCheck<3>;
template class UniformInterfaceCheck<4>;

} // namespace voxplex

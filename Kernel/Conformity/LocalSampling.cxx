// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/LocalSampling.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace voxplex
{

namespace
{

// Chosen on the knee atlas. Around edges, a larger radius adds elements, and makes new non-manifold
// edges at its rim. Around far faces, a smaller radius leaves out the parts that the tips of
// processes hang on.

/**
 * Faces are sampled within this many sampling distances of a far face, or of the midpoint of a
 * non-manifold edge. There they are sampled within the spacing of the visit before, if that is less, and at
 * least within a voxel. With 0.5 at edges, brains get 3 % more elements.
 */
constexpr double RadiusAtFace = 1.0;
constexpr double RadiusAtEdge = 0.25;

/**
 * Spacing at the first visit of a far face or an edge, in sampling distances. With 0.5, there is one
 * round less, but meshes of atlases with thin labels have up to a sixth more elements.
 */
constexpr double FirstSpacing = 0.8;

/**
 * Spacing at a visit of a gap, in spacings of the visit before, and at the first in sampling
 * distances. With 0.4, meshes of thin sheets have up to six times as many elements.
 */
constexpr double NextSpacingAtGap = 0.6;

/**
 * The spacing at the first visit of a hidden layer, in lengths of the dual edge inside of it. The points
 * on both sides are to be each other's neighbours.
 */
constexpr double SpacingOfLayer = 0.9;

/**
 * The sampling distance of R1 is this factor times the spacing of points, because the points already
 * give the shape of interfaces. With 1, islands of the knee atlas get twice as many additional
 * elements; if single voxels are kept, too, the run takes three times as long. With 3, refinement is
 * then resumed twice rather than once.
 */
constexpr double BoundFactor = 2.0;

/**
 * The finest spacings, as FinestSpacing() takes them. A vessel of one voxel is 0.8 voxels thick in the
 * label field along an axis, and where it leaves a thick part much less. With 0.2, vessels stay in
 * fragments there, and if voxels are much longer along them.
 */
constexpr double FinestOfInterfaces = 0.2;
constexpr double FinestInsideComponents = 0.1;

/**
 * The largest number of voxels that get points. In a larger component, only every k-th voxel gets
 * points; R1 finds the rest.
 */
constexpr std::int64_t MostSeededVoxels = 20000;

/**
 * A fraction of the smallest voxel spacing: the label field has no finer features. In 4D half the
 * spacing makes about ten times as many elements. So it is 2.5 times as large there, and the smallest
 * spacing counts as at least half of the mean one: the step between frames may be short.
 */
template <int D>
double FinestSpacing(const GridGeometry<D>& grid, double fraction)
{
  if constexpr (D == 3)
  {
    return fraction * grid.SmallestSpacing();
  }
  else
  {
    const double mean = std::pow(grid.VoxelVolume(), 1.0 / D);
    return 2.5 * fraction * std::max(grid.SmallestSpacing(), 0.5 * mean);
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
LocalSampling<D>::LocalSampling(const LabelImage<D>& image, const LabelImage<D>& ofDomain,
  const BitMask<D>& sites, const Domain<D>& domain, const SizingField<D>& sizing,
  LocalDelta<D>& local, const std::stop_token& stop)
  : Image(image)
  , OfDomain(ofDomain)
  , Sites(sites)
  , Surfaces(domain)
  , Sizing(sizing)
  , Local(local)
  , Stop(stop)
  , OfInterfaces{ FirstSpacing, 0.5, FinestSpacing<D>(image.Grid(), FinestOfInterfaces), 2, 1.0 }
  , OfGaps{ NextSpacingAtGap, NextSpacingAtGap,
    FinestSpacing<D>(image.Grid(), FinestInsideComponents), 1, BoundFactor }
  , OfLayers{ 0.0, NextSpacingAtGap, FinestSpacing<D>(image.Grid(), FinestOfInterfaces), 0, 0.0 }
  , FinestOfComponent(OfGaps.Finest)
{
  for (std::size_t label = 1; label < image.Values().size(); ++label)
  {
    this->FinestOfComponent =
      std::min(this->FinestOfComponent, sizing.LargestOf(static_cast<LabelId>(label)));
  }
}

template <int D>
std::vector<FeatureSeed<D>> LocalSampling<D>::TakeSeeds()
{
  this->Begin(); // if nothing was requested, no bound is new
  this->Local.Grade(this->Sizing.Largest());
  this->AreTaken = true;
  return std::exchange(this->Seeds, {});
}

/** Begins a request. The first one after TakeSeeds() forgets which bounds were new. */
template <int D>
void LocalSampling<D>::Begin()
{
  ++this->Requests;
  if (std::exchange(this->AreTaken, false))
  {
    this->Local.ForgetLowered();
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
std::size_t LocalSampling<D>::SampleInterfaces(
  const std::vector<VoxelFace<D>>& far, const std::vector<Point<D>>& edges)
{
  std::vector<SearchBall<D>> balls;
  balls.reserve(far.size() + edges.size());
  for (const VoxelFace<D>& face : far)
  {
    balls.push_back({ CentreOf(face, this->OfDomain), RadiusAtFace * this->AskedDistance(face) });
  }
  for (const Point<D>& middle : edges)
  {
    const double radius =
      std::min(RadiusAtEdge * this->Sizing.AskedNear(middle), this->Sizing.Spacing(middle));
    balls.push_back({ middle, std::max(radius, this->Image.Grid().SmallestSpacing()) });
  }
  const std::vector<VoxelFace<D>> faces =
    FindFacesNear(this->OfDomain, this->Sites, balls, this->Stop);
  std::vector<VoxelFace<D>> all;
  std::set_union(
    this->Faces.begin(), this->Faces.end(), faces.begin(), faces.end(), std::back_inserter(all));
  this->Faces = std::move(all);
  const std::size_t points = this->SampleFaces(faces, this->OfInterfaces,
    [this](const VoxelFace<D>& face) { return this->AskedDistance(face); });
  this->Bound(far, this->OfInterfaces);
  return points;
}

template <int D>
std::size_t LocalSampling<D>::SampleGaps(const std::vector<VoxelFace<D>>& faces)
{
  const std::size_t points = this->SampleFaces(faces, this->OfGaps,
    [this](const VoxelFace<D>& face)
    {
      return this->Sizing.SamplingDistance(CentreOf(face, this->OfDomain),
        this->OfDomain.At(face.Voxel), this->OfDomain.At(face.Next()));
    });
  this->Bound(faces, this->OfGaps);
  return points;
}

template <int D>
std::size_t LocalSampling<D>::SampleLayers(
  const std::vector<HiddenLayer<D>>& layers, double thinnest)
{
  this->Begin();
  const std::size_t before = this->Seeds.size();
  for (const HiddenLayer<D>& layer : layers)
  {
    const double thickness = Distance(layer.Ends[0], layer.Ends[1]);
    for (const Point<D>& end : layer.Ends)
    {
      if (thickness > 0.0 && thickness >= thinnest * this->Sizing.Spacing(end))
      {
        const Index voxel = this->VoxelAt(end);
        Place& place = this->PlaceAt(voxel, this->OfLayers);
        this->Visit(
          place, this->OfLayers, std::min(SpacingOfLayer * thickness, this->Sizing.Spacing(end)));
        if (place.Spacing > 0.0)
        {
          this->Seeds.push_back({ end, place.Spacing });
          this->Local.SetSpacing(voxel, 1, place.Spacing);
        }
      }
    }
  }
  return this->Seeds.size() - before;
}

/** The voxel of the crop that a point is in, or nearest to. */
template <int D>
auto LocalSampling<D>::VoxelAt(const Point<D>& p) const -> Index
{
  Index voxel = this->Image.VoxelAt(p);
  for (std::size_t a = 0; a < D; ++a)
  {
    voxel[a] = std::clamp<std::int64_t>(voxel[a], 0, this->Image.CropDimensions()[a] - 1);
  }
  return voxel;
}

/** The requested sampling distance. If it is graded, at most the finest one. */
template <int D>
double LocalSampling<D>::AskedDistance(const VoxelFace<D>& face) const
{
  const double distance = this->Sizing.AskedDistance(
    CentreOf(face, this->OfDomain), this->OfDomain.At(face.Voxel), this->OfDomain.At(face.Next()));
  const BaseDistance<D>& base = this->Sizing.Base();
  return base.Graded ? std::min(distance, base.Asked) : distance;
}

/** The place that a voxel is sampled with. */
template <int D>
auto LocalSampling<D>::PlaceAt(const Index& voxel, Schedule& schedule) -> Place&
{
  Index cell = voxel;
  for (std::int64_t& c : cell)
  {
    c = (c + 1) / LocalDelta<D>::Cell;
  }
  return schedule.Places[cell];
}

/** Visits a place, once in a request. @param first the spacing if it was never visited */
template <int D>
void LocalSampling<D>::Visit(Place& place, const Schedule& schedule, double first)
{
  if (place.Request != this->Requests)
  {
    place.Request = this->Requests;
    const double spacing = place.Visits == 0 ? first : schedule.Next * place.Spacing;
    const bool isDone = place.Visits > 0 && place.Spacing <= schedule.Finest;
    place.Spacing = isDone ? 0.0 : std::max(spacing, schedule.Finest);
    ++place.Visits;
  }
}

/** @param distanceOf distanceOf(face) is the distance that sampling begins with */
template <int D>
template <typename DistanceOf>
std::size_t LocalSampling<D>::SampleFaces(
  const std::vector<VoxelFace<D>>& faces, Schedule& schedule, const DistanceOf& distanceOf)
{
  this->Begin();
  const std::size_t before = this->Seeds.size();
  for (const VoxelFace<D>& face : faces)
  {
    Place& place = this->PlaceAt(face.Voxel, schedule);
    this->Visit(place, schedule, schedule.First * distanceOf(face));
    Point<D> z;
    if (place.Spacing > 0.0 &&
      this->Surfaces.FirstCrossing(this->OfDomain.CentreOf(face.Voxel),
        this->OfDomain.At(face.Voxel), this->OfDomain.CentreOf(face.Next()), z))
    {
      this->Seeds.push_back({ z, place.Spacing });
      if (schedule.FirstBound > 1) // with a bound at each visit, that one is enough
      {
        this->Local.SetSpacing(face.Voxel, 1, place.Spacing);
      }
    }
  }
  return this->Seeds.size() - before;
}

/** Bounds the sampling distance at faces that were sampled. */
template <int D>
void LocalSampling<D>::Bound(const std::vector<VoxelFace<D>>& faces, Schedule& schedule)
{
  for (const VoxelFace<D>& face : faces)
  {
    const Place& place = this->PlaceAt(face.Voxel, schedule);
    if (place.Spacing > 0.0 && place.Visits >= schedule.FirstBound)
    {
      const double factor = place.Spacing <= schedule.Finest ? schedule.BoundAtFinest : BoundFactor;
      this->Local.SetBound(face.Voxel, 1,
        std::max(this->OfDomain.At(face.Voxel), this->OfDomain.At(face.Next())),
        factor * place.Spacing);
    }
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
std::size_t LocalSampling<D>::SampleComponent(
  const Components<D>& components, std::uint32_t component, double spacing)
{
  this->Begin();
  const std::size_t before = this->Seeds.size();
  const LabelId label = components.All()[component].Label;
  const std::int64_t step = components.All()[component].Voxels / MostSeededVoxels + 1;
  std::int64_t count = 0;
  components.ForEachRun(component,
    [&](const Index& first, std::int64_t length)
    {
      ThrowIfStopped(this->Stop);
      this->Local.SetBound(first, length, label, BoundFactor * spacing);
      for (Index voxel = first; voxel[0] < first[0] + length; ++voxel[0])
      {
        for (std::size_t k = 0; count % step == 0 && k < std::size_t{ 2 } * D; ++k)
        {
          Index neighbour = voxel;
          neighbour[k / 2] += k % 2 == 0 ? -1 : 1;
          Point<D> z;
          if (components.At(neighbour) != component &&
            this->Surfaces.FirstCrossing(
              this->Image.CentreOf(voxel), label, this->Image.CentreOf(neighbour), z))
          {
            this->Seeds.push_back({ z, spacing });
          }
        }
        ++count;
      }
    });
  return this->Seeds.size() - before;
}

template class LocalSampling<3>;
template class LocalSampling<4>;

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ComponentGuard.h"

#include "LostComponents.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

namespace
{

/**
 * Delta of a component is at most this times the ratio of its volume to its surface: 0.45 of the edge of a
 * cube. Chosen on the knee atlas, whose islands of 8 voxels and more then all come out at once.
 */
constexpr double SamplesPerThickness = 2.7;

/**
 * The rules keep this times the spacing of a component's seeds: these carry its shape already. With 1 there
 * are twice as many additional elements on the knee atlas, and when single voxels are kept, too, they take
 * three times as long; with 3 refinement then goes on twice rather than once.
 */
constexpr double BoundFactor = 2.0;

/** Of larger components only every so manieth face gets a seed; R1 finds what is between. */
constexpr std::int64_t MostSeededVoxels = 20000;

/** No component is sampled more finely than this, in voxels: the label field has no finer features. */
constexpr double FinestVoxels = 0.1;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
ComponentGuard<D>::ComponentGuard(const LabelImage<D>& image, const Domain<D>& domain,
  const Components<D>& components, const std::vector<double>& delta, std::int64_t fewestVoxels,
  LocalDelta<D>& local, unsigned threads, const std::stop_token& stop)
  : Image(image)
  , Surfaces(domain)
  , All(components)
  , Wanted(components.FindWanted(fewestVoxels))
  , Threads(threads)
  , Stop(stop)
  , Local(local)
{
  double spacing = image.Grid().Spacing(0);
  for (int a = 1; a < D; ++a)
  {
    spacing = std::min(spacing, image.Grid().Spacing(a));
  }
  this->FinestDelta =
    std::min(*std::min_element(delta.begin() + 1, delta.end()), FinestVoxels * spacing);
  const double voxelVolume = image.Grid().VoxelVolume();
  this->Delta.resize(this->All.All().size());
  for (std::uint32_t c = 0; c < this->Delta.size(); ++c)
  {
    const Component<D>& component = this->All.All()[c];
    this->Delta[c] = delta[component.Label];
    const double own =
      SamplesPerThickness * static_cast<double>(component.Voxels) * voxelVolume / component.Surface;
    if (this->Wanted[c] && own < delta[component.Label])
    {
      ThrowIfStopped(stop);
      this->Sample(c, std::max(own, this->FinestDelta));
    }
  }
  this->Local.Grade();
}

//------------------------------------------------------------------------------------------------
template <int D>
void ComponentGuard<D>::Sample(std::uint32_t component, double delta)
{
  this->Delta[component] = delta;
  const LabelId label = this->All.All()[component].Label;
  const std::int64_t step = this->All.All()[component].Voxels / MostSeededVoxels + 1;
  std::int64_t count = 0;
  this->All.ForEachRun(component,
    [&](const Index& first, std::int64_t length)
    {
      this->Local.SetBound(first, length, label, BoundFactor * delta);
      Index voxel = first;
      for (; voxel[0] < first[0] + length; ++voxel[0])
      {
        if (count++ % step != 0)
        {
          continue;
        }
        const Point<D> centre = this->Image.CentreOf(voxel);
        for (std::size_t a = 0; a < D; ++a)
        {
          for (const std::int64_t direction : { -1, 1 })
          {
            Index neighbour = voxel;
            neighbour[a] += direction;
            Point<D> z;
            if (this->All.At(neighbour) != component &&
              this->Surfaces.FirstCrossing(centre, label, this->Image.CentreOf(neighbour), z))
            {
              this->Seeds.push_back({ z, delta });
            }
          }
        }
      }
    });
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<std::uint32_t> ComponentGuard<D>::FindLost(const SimplexMesh<D>& mesh) const
{
  return FindLostComponents(this->All, this->Image, mesh, this->Wanted, this->Threads, this->Stop);
}

//------------------------------------------------------------------------------------------------
template <int D>
bool ComponentGuard<D>::SampleFiner(const std::vector<std::uint32_t>& lost)
{
  bool any = false;
  for (const std::uint32_t c : lost)
  {
    if (this->Delta[c] > this->FinestDelta)
    {
      this->Sample(c, std::max(this->FinestDelta, 0.5 * this->Delta[c]));
      any = true;
    }
  }
  if (any)
  {
    this->Local.Grade();
  }
  return any;
}

template class ComponentGuard<3>;
template class ComponentGuard<4>;

} // namespace voxplex

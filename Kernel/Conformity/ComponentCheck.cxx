// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ComponentCheck.h"

#include "Conformity/FinestSpacing.h"
#include "Domain/ThinPart.h"
#include "Parallel/ParallelFor.h"
#include "Quality/LostComponents.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace voxplex
{

namespace
{

/**
 * Delta of a component is at most this factor times the ratio of its volume to its surface: 0.45 of
 * the edge of a cube. Chosen on the knee atlas: all its islands of 8 voxels and more then appear at
 * once.
 */
constexpr double SamplesPerThickness = 2.7;

/**
 * The delta of the rules is this factor times the spacing of a component's seeds, because the seeds
 * already give its shape. With 1, the knee atlas gets twice as many additional elements; if single
 * voxels are kept, too, the run takes three times as long. With 3, refinement is then resumed twice
 * rather than once.
 */
constexpr double BoundFactor = 2.0;

/**
 * The largest number of voxels searched for the thickest part. In a larger component, only every
 * k-th voxel is searched.
 */
constexpr std::int64_t MostVoxelsLookedAt = 1000;

/**
 * The number of times a component is sampled where it is thickest, before it is sampled as a whole.
 */
constexpr unsigned AttemptsAtThickest = 2;

/**
 * Where a component is thickest, points are at least the first factor times its thickness apart,
 * and delta is at most the second factor times its thickness. The six points around a grain are
 * 0.71 of its thickness apart. Any larger factors from 0.6 and 1.5 on give about as many elements.
 */
constexpr double SpacingAtThickest = 0.7;
constexpr double BoundAtThickest = 2.0;

/**
 * The smallest thickness, in finest deltas. In a thinner part, points would be too close to each
 * other.
 */
constexpr double LeastThickness = 5.0;

/**
 * The largest number of voxels that get seeds. In a larger component, only every k-th voxel gets
 * seeds; R1 finds the rest.
 */
constexpr std::int64_t MostSeededVoxels = 20000;

/** The finest spacing of seeds, as FinestSpacing() takes it. */
constexpr double FinestVoxels = 0.1;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
ComponentCheck<D>::ComponentCheck(const LabelImage<D>& image, const Domain<D>& domain,
  const Components<D>& components, const SizingField<D>& sizing, std::int64_t fewestVoxels,
  bool exact, bool mayRefine, LocalDelta<D>& local, ComponentStatistics& statistics,
  unsigned threads, const std::stop_token& stop)
  : Image(image)
  , Surfaces(domain)
  , All(components)
  , Attempts(components.All().size(), exact ? AttemptsAtThickest : 0)
  , Wanted(components.FindWanted(fewestVoxels))
  , MayRefine(mayRefine)
  , Threads(threads)
  , Stop(stop)
  , LargestSpacing(sizing.Largest())
  , Local(local)
  , Statistics(statistics)
{
  this->FinestDelta = voxplex::FinestSpacing<D>(image.Grid(), FinestVoxels);
  for (std::size_t label = 1; label < image.Values().size(); ++label)
  {
    this->FinestDelta = std::min(this->FinestDelta, sizing.LargestOf(static_cast<LabelId>(label)));
  }
  for (std::uint32_t c = 0; c < this->All.All().size(); ++c)
  {
    this->Delta.push_back(sizing.LargestOf(this->All.All()[c].Label));
    const double own = this->OwnDelta(c);
    if (exact && mayRefine && this->Wanted[c] && own < this->Delta[c])
    {
      ThrowIfStopped(stop);
      this->Sample(c, own);
    }
  }
  this->Local.Grade(this->LargestSpacing);
}

//------------------------------------------------------------------------------------------------
template <int D>
double ComponentCheck<D>::OwnDelta(std::uint32_t component) const
{
  const Component<D>& of = this->All.All()[component];
  const double volume = static_cast<double>(of.Voxels) * this->Image.Grid().VoxelVolume();
  return std::max(SamplesPerThickness * volume / of.Surface, this->FinestDelta);
}

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<FeatureSeed<D>> ComponentCheck<D>::TakeSeeds()
{
  this->Statistics.Seeds += this->Seeds.size();
  return std::exchange(this->Seeds, {});
}

//------------------------------------------------------------------------------------------------
template <int D>
Remedy<D> ComponentCheck<D>::Inspect(const LabelledTriangulation<D>& elements)
{
  if (!this->SampleFiner(this->FindLost(elements)))
  {
    return {};
  }
  ++this->Statistics.Rounds;
  return { true, this->TakeSeeds() };
}

//------------------------------------------------------------------------------------------------
template <int D>
void ComponentCheck<D>::SampleThickest(std::uint32_t component)
{
  const std::int64_t step = this->All.All()[component].Voxels / MostVoxelsLookedAt + 1;
  std::int64_t count = 0;
  std::optional<ThinPart<D>> thickest;
  this->All.ForEachRun(component,
    [&](const Index& first, std::int64_t length)
    {
      ThrowIfStopped(this->Stop);
      for (Index voxel = first; voxel[0] < first[0] + length; ++voxel[0])
      {
        if (count++ % step != 0)
        {
          continue;
        }
        ThinPart<D> part(this->Image, this->Surfaces, voxel);
        if (!thickest || part.IsBetterThan(*thickest))
        {
          thickest = std::move(part);
        }
      }
    });
  const double thickness =
    std::ldexp(std::max(thickest->Thickness(), LeastThickness * this->FinestDelta),
      -static_cast<int>(this->Attempts[component]));
  for (const Point<D>& z : thickest->Ends())
  {
    this->Seeds.push_back({ z, SpacingAtThickest * thickness });
  }
  this->Local.SetBound(thickest->Voxel(), 1, this->All.All()[component].Label,
    std::min(this->Delta[component], BoundAtThickest * thickness));
  ++this->Attempts[component];
}

//------------------------------------------------------------------------------------------------
template <int D>
void ComponentCheck<D>::Sample(std::uint32_t component, double delta)
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
bool ComponentCheck<D>::SampleFiner(const std::vector<std::uint32_t>& lost)
{
  bool any = false;
  for (const std::uint32_t c : lost)
  {
    if (!this->MayRefine)
    {
      break;
    }
    if (this->Attempts[c] < AttemptsAtThickest)
    {
      this->SampleThickest(c);
      any = true;
    }
    else if (this->Delta[c] > this->FinestDelta)
    {
      const double own = this->OwnDelta(c);
      this->Sample(
        c, own < this->Delta[c] ? own : std::max(this->FinestDelta, 0.5 * this->Delta[c]));
      any = true;
    }
  }
  if (any)
  {
    this->Local.Grade(this->LargestSpacing);
  }
  return any;
}

template class ComponentCheck<3>;
template class ComponentCheck<4>;

} // namespace voxplex

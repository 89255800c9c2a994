// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ComponentCheck.h"

#include "Quality/LostComponents.h"

#include <algorithm>

namespace voxplex
{

namespace
{

/**
 * The delta that suits a component is this factor times the ratio of its volume to its surface: 0.45 of
 * the edge of a cube. With 3.4, exact meshes have up to a third fewer elements, but volumes are off by a
 * fifth more.
 */
constexpr double SamplesPerThickness = 2.7;

/**
 * A lost component is first sampled with this factor times its own delta, or the second factor times what
 * it has, and from then on with the second factor times the last one. If the first one is 1, brains whose
 * parts are mostly thinner than delta get half as many elements again.
 */
constexpr double FirstDelta = 3.0;
constexpr double NextDelta = 0.6;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
ComponentCheck<D>::ComponentCheck(const LabelImage<D>& image, const Components<D>& components,
  const SizingField<D>& sizing, std::int64_t fewestVoxels, bool exact, bool mayRefine,
  LocalSampling<D>& sampling, ComponentStatistics& statistics, unsigned threads,
  const std::stop_token& stop)
  : Image(image)
  , All(components)
  , Sampling(sampling)
  , Wanted(components.FindWanted(fewestVoxels))
  , MayRefine(mayRefine)
  , Threads(threads)
  , Stop(stop)
  , Statistics(statistics)
{
  for (std::uint32_t c = 0; c < this->All.All().size(); ++c)
  {
    this->Delta.push_back(sizing.LargestOf(this->All.All()[c].Label));
    const double own = this->OwnDelta(c);
    if (exact && mayRefine && this->Wanted[c] && own < this->Delta[c])
    {
      this->Sample(c, own);
    }
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
double ComponentCheck<D>::OwnDelta(std::uint32_t component) const
{
  const Component<D>& of = this->All.All()[component];
  const double volume = static_cast<double>(of.Voxels) * this->Image.Grid().VoxelVolume();
  return std::max(SamplesPerThickness * volume / of.Surface, this->Sampling.FinestOfComponents());
}

template <int D>
void ComponentCheck<D>::Sample(std::uint32_t component, double delta)
{
  this->Delta[component] = delta;
  this->Statistics.Seeds += this->Sampling.SampleComponent(this->All, component, delta);
}

//------------------------------------------------------------------------------------------------
template <int D>
bool ComponentCheck<D>::Inspect(const LabelledTriangulation<D>& elements)
{
  const bool any = this->SampleFiner(this->FindLost(elements));
  this->Statistics.Rounds += any ? 1 : 0;
  return any;
}

template <int D>
bool ComponentCheck<D>::SampleFiner(const std::vector<std::uint32_t>& lost)
{
  if (!this->MayRefine)
  {
    return false;
  }
  const double finest = this->Sampling.FinestOfComponents();
  bool any = false;
  for (const std::uint32_t c : lost)
  {
    if (this->Delta[c] > finest)
    {
      this->Sample(
        c, std::min(FirstDelta * this->OwnDelta(c), std::max(finest, NextDelta * this->Delta[c])));
      any = true;
    }
  }
  return any;
}

template class ComponentCheck<3>;
template class ComponentCheck<4>;

} // namespace voxplex

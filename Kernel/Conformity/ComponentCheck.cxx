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
 * Delta of a component is at most this factor times the ratio of its volume to its surface: 0.45 of
 * the edge of a cube. Chosen on the knee atlas: all its islands of 8 voxels and more then appear at
 * once.
 */
constexpr double SamplesPerThickness = 2.7;

/**
 * The number of times a component is sampled where it is thickest, before it is sampled as a whole.
 */
constexpr unsigned AttemptsAtThickest = 2;

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
  , Attempts(components.All().size(), exact ? AttemptsAtThickest : 0)
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
    if (this->Attempts[c] < AttemptsAtThickest)
    {
      this->Statistics.Seeds +=
        this->Sampling.SampleThickest(this->All, c, this->Attempts[c]++, this->Delta[c]);
      any = true;
    }
    else if (this->Delta[c] > finest)
    {
      const double own = this->OwnDelta(c);
      this->Sample(c, own < this->Delta[c] ? own : std::max(finest, 0.5 * this->Delta[c]));
      any = true;
    }
  }
  return any;
}

template class ComponentCheck<3>;
template class ComponentCheck<4>;

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceCheck.h"

#include "Mesh/LabelledTriangulation.h"

#include <algorithm>
#include <utility>

namespace voxplex
{

template <int D>
InterfaceCheck<D>::InterfaceCheck(const Subject& subject, unsigned rounds,
  LocalSampling<D>& sampling, InterfaceStatistics& statistics, const std::stop_token& stop)
  : Mesh(subject.Mesh)
  , Rounds(rounds)
  , Statistics(statistics)
  , Distances(subject.Image, subject.Sites, subject.Surfaces, subject.Sizing, subject.Threads, stop)
  , Sampling(sampling)
{
}

template <int D>
bool InterfaceCheck<D>::InspectSampled(const ManifoldLabels<D>& made)
{
  this->HasSeenAll = false;
  if (!this->MayGoOn())
  {
    return false;
  }
  if (std::exchange(this->IsFirst, false))
  {
    return this->InspectAll(made);
  }
  const std::vector<VoxelFace<D>> far = this->Distances.FindFar(
    LabelledTriangulation<D>(this->Mesh, made.Labels), this->Sampling.Sampled());
  return !far.empty() && this->Sample(far, made);
}

template <int D>
bool InterfaceCheck<D>::InspectRidges(const ManifoldLabels<D>& made)
{
  return D == 3 && this->MayGoOn() &&
    std::any_of(made.Places.begin(), made.Places.end(),
      [](const NonManifoldPlace<D>& place) { return !place.IsJunction; }) &&
    this->Sample({}, made);
}

template <int D>
bool InterfaceCheck<D>::InspectAll(const ManifoldLabels<D>& made)
{
  if (!this->MayGoOn() || std::exchange(this->HasSeenAll, true))
  {
    return false;
  }
  const std::vector<VoxelFace<D>> far =
    this->Distances.FindFar(LabelledTriangulation<D>(this->Mesh, made.Labels));
  return !far.empty() && this->Sample(far, made);
}

/** Has these faces and the edges sampled. If there are any points, counts a round. */
template <int D>
bool InterfaceCheck<D>::Sample(const std::vector<VoxelFace<D>>& far, const ManifoldLabels<D>& made)
{
  const std::size_t points =
    this->Sampling.SampleInterfaces(far, D == 3 ? made.Places : std::vector<NonManifoldPlace<D>>());
  this->Statistics.Rounds += points == 0 ? 0 : 1;
  this->Statistics.Seeds += points;
  return points > 0;
}

template class InterfaceCheck<3>;
template class InterfaceCheck<4>;

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceCheck.h"

#include "Mesh/LabelledTriangulation.h"

#include <utility>

namespace voxplex
{

template <int D>
InterfaceCheck<D>::InterfaceCheck(const Subject& subject, unsigned rounds, LocalDelta<D>& local,
  InterfaceStatistics& statistics, const std::stop_token& stop)
  : Mesh(subject.Mesh)
  , Rounds(rounds)
  , Statistics(statistics)
  , Distances(subject.Image, subject.Sites, subject.Surfaces, subject.Sizing, subject.Threads, stop)
  , Sampling(subject.Image, subject.Sites, subject.Surfaces, subject.Sizing, local, stop)
{
}

template <int D>
Remedy<D> InterfaceCheck<D>::InspectSampled(const ManifoldLabels<D>& made)
{
  this->HasSeenAll = false;
  if (!this->MayGoOn())
  {
    return {};
  }
  if (std::exchange(this->IsFirst, false))
  {
    return this->InspectAll(made);
  }
  const std::vector<VoxelFace<D>> far = this->Distances.FindFar(
    LabelledTriangulation<D>(this->Mesh, made.Labels), this->Sampling.Sampled());
  return far.empty() ? Remedy<D>() : this->Sample(far, made);
}

template <int D>
Remedy<D> InterfaceCheck<D>::InspectRidges(const ManifoldLabels<D>& made)
{
  return this->MayGoOn() ? this->Sample({}, made) : Remedy<D>();
}

template <int D>
Remedy<D> InterfaceCheck<D>::InspectAll(const ManifoldLabels<D>& made)
{
  if (!this->MayGoOn() || std::exchange(this->HasSeenAll, true))
  {
    return {};
  }
  const std::vector<VoxelFace<D>> far =
    this->Distances.FindFar(LabelledTriangulation<D>(this->Mesh, made.Labels));
  return far.empty() ? Remedy<D>() : this->Sample(far, made);
}

/** Makes a remedy of the points around these faces and edges. If there are any, counts a round. */
template <int D>
Remedy<D> InterfaceCheck<D>::Sample(
  const std::vector<VoxelFace<D>>& far, const ManifoldLabels<D>& made)
{
  std::vector<FeatureSeed<D>> points =
    this->Sampling.AroundIfBad(far, D == 3 ? made.Places : std::vector<NonManifoldPlace<D>>());
  this->Statistics.Rounds += points.empty() ? 0 : 1;
  this->Statistics.Seeds += points.size();
  return { !points.empty(), std::move(points) };
}

template class InterfaceCheck<3>;
template class InterfaceCheck<4>;

} // namespace voxplex

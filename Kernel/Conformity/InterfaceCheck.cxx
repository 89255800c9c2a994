// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceCheck.h"

#include "Mesh/LabelledTriangulation.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace voxplex
{

namespace
{

/** Hidden layers are sampled this many times; more finely each time. */
constexpr unsigned UsualLayerRounds = 6;
constexpr unsigned MostLayerRounds = 64; ///< if components are to be exact

/**
 * Unless components are to be exact, thinner layers are not sampled, in spacings of the mesh. Each pair
 * of points that is much closer than the others brings a hundred elements: with 0, a brain of thin labels
 * gets 11 % more elements, with 0.5 5 %.
 */
constexpr double ThinnestLayer = 0.5;

/**
 * Hidden layers, unless components are to be exact, and edges are sampled only if they are few: at most so
 * many, or one for so many vertices. An image of noise has many more, and would get five times the
 * elements.
 */
constexpr std::size_t FewDefects = 200;
constexpr std::size_t VerticesPerDefect = 50;

} // namespace

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
    LabelledTriangulation<D>(this->Mesh, this->Mesh.Labels()), this->Sampling.Sampled());
  return !far.empty() && this->Sample(far, made);
}

template <int D>
bool InterfaceCheck<D>::InspectRidges(const ManifoldLabels<D>& made)
{
  return D == 3 && this->MayGoOn() && !made.Places.empty() && this->AreFew(made.Places.size()) &&
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
    this->Distances.FindFar(LabelledTriangulation<D>(this->Mesh, this->Mesh.Labels()));
  return !far.empty() && this->Sample(far, made);
}

template <int D>
bool InterfaceCheck<D>::InspectLayers(const ManifoldLabels<D>& made, bool exact)
{
  if (made.Layers.empty() || this->Rounds == 0 ||
    this->Statistics.LayerRounds >= (exact ? MostLayerRounds : UsualLayerRounds) ||
    (!exact && !this->AreFew(made.Layers.size())))
  {
    return false;
  }
  const std::size_t points = this->Sampling.SampleLayers(made.Layers, exact ? 0.0 : ThinnestLayer);
  this->Statistics.LayerRounds += points == 0 ? 0 : 1;
  this->Statistics.LayerSeeds += points;
  return points > 0;
}

template <int D>
bool InterfaceCheck<D>::AreFew(std::size_t defects) const
{
  return defects <= std::max<std::size_t>(FewDefects, this->Mesh.VertexIdEnd() / VerticesPerDefect);
}

/** Has these faces and the edges sampled. If there are any points, counts a round. */
template <int D>
bool InterfaceCheck<D>::Sample(const std::vector<VoxelFace<D>>& far, const ManifoldLabels<D>& made)
{
  const bool samplesEdges = D == 3 && this->AreFew(made.Places.size());
  const std::size_t points =
    this->Sampling.SampleInterfaces(far, samplesEdges ? made.Places : std::vector<Point<D>>());
  this->Statistics.Rounds += points == 0 ? 0 : 1;
  this->Statistics.Seeds += points;
  return points > 0;
}

template class InterfaceCheck<3>;
template class InterfaceCheck<4>;

} // namespace voxplex

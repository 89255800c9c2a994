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
  : Of(subject)
  , Rounds(rounds)
  , Statistics(statistics)
  , Vertices(subject.Mesh, subject.Surfaces, subject.Threads, stop)
{
  if constexpr (D == 3)
  {
    if (subject.Sizing.Base().Graded)
    {
      this->Graded.emplace(subject.Image, subject.Sites, subject.Surfaces, subject.Sizing, local,
        subject.Threads, stop);
      return;
    }
  }
  this->Uniform.emplace(
    subject.Image, subject.Sites, subject.Surfaces, subject.Sizing, local, subject.Threads, stop);
}

template <int D>
Remedy<D> InterfaceCheck<D>::InspectVertices()
{
  return this->Uniform && this->MayGoOn()
    ? this->Counted(this->Uniform->InspectVertices(this->Vertices.Update()))
    : Remedy<D>();
}

template <int D>
Remedy<D> InterfaceCheck<D>::InspectLabels(const ManifoldLabels<D>& made)
{
  if (!this->MayGoOn())
  {
    return {};
  }
  if constexpr (D == 3)
  {
    return this->Counted(this->Graded
        ? this->Graded->Inspect(LabelledTriangulation<3>(this->Of.Mesh, made.Labels), made.Places)
        : this->Uniform->InspectLabels(made.Gone, made.Places));
  }
  else
  {
    return this->Counted(this->Uniform->InspectLabels(made.Gone, {}));
  }
}

template <int D>
void InterfaceCheck<D>::Finish()
{
  this->Vertices.Forget();
  this->Uniform.reset();
}

/** Makes a remedy of these points. If there are any, counts a round. */
template <int D>
Remedy<D> InterfaceCheck<D>::Counted(std::vector<FeatureSeed<D>> points)
{
  this->Statistics.Rounds += points.empty() ? 0 : 1;
  this->Statistics.Seeds += points.size();
  return { !points.empty(), std::move(points) };
}

template class InterfaceCheck<3>;
template class InterfaceCheck<4>;

} // namespace voxplex

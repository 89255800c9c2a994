// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/SpaceTimeInterfaceCheck.h"

#include <utility>

namespace voxplex
{

SpaceTimeInterfaceCheck::SpaceTimeInterfaceCheck(const Triangulation<4>& mesh,
  const LabelImage<4>& image, const BitMask<4>& sites, const Domain<4>& surfaces,
  const SizingField<4>& sizing, const InterfaceOptions& options, LocalDelta<4>& local,
  InterfaceStatistics& statistics, double& seconds, unsigned threads, const std::stop_token& stop)
  : ConformityCheck(seconds)
  , MostRounds(options.Rounds)
  , Statistics(statistics)
  , Vertices(mesh, surfaces, threads, stop)
  , Distances(image, sites, surfaces, sizing, local, threads, stop)
{
}

Remedy<4> SpaceTimeInterfaceCheck::InspectTriangulation()
{
  if (this->Statistics.Rounds >= this->MostRounds)
  {
    return {};
  }
  std::vector<FeatureSeed<4>> points = this->Distances.InspectVertices(this->Vertices.Update());
  this->Statistics.Rounds += points.empty() ? 0 : 1;
  this->Statistics.Seeds += points.size();
  return { !points.empty(), std::move(points) };
}

} // namespace voxplex

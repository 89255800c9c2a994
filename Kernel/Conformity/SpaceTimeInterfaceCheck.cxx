// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/SpaceTimeInterfaceCheck.h"

#include <utility>

namespace voxplex
{

namespace
{

ManifoldRepairOptions<4> RepairOptionsFor(
  const Domain<4>& surfaces, const SizingField<4>& sizing, std::function<bool(SimplexId)> keeps)
{
  ManifoldRepairOptions<4> options;
  options.Surfaces = &surfaces;
  options.Sizing = &sizing;
  options.Keeps = std::move(keeps);
  return options;
}

} // namespace

SpaceTimeInterfaceCheck::SpaceTimeInterfaceCheck(const Triangulation<4>& mesh,
  const LabelImage<4>& image, const BitMask<4>& sites, const Domain<4>& surfaces,
  const SizingField<4>& sizing, const InterfaceOptions& options, bool mayRefine,
  std::function<bool(SimplexId)> keeps, LocalDelta<4>& local, InterfaceStatistics& statistics,
  double& seconds, unsigned threads, const std::stop_token& stop)
  : ConformityCheck(seconds)
  , Repairs(options.Manifold)
  , MostRounds(mayRefine ? options.Rounds : 0)
  , Statistics(statistics)
  , Vertices(mesh, surfaces, threads, stop)
  , Labeller(mesh, RepairOptionsFor(surfaces, sizing, std::move(keeps)), threads, stop)
  , Distances(image, sites, surfaces, sizing, local, threads, stop)
{
}

Remedy<4> SpaceTimeInterfaceCheck::InspectTriangulation()
{
  const bool looks = this->Statistics.Rounds < this->MostRounds;
  Remedy<4> remedy;
  if (looks)
  {
    remedy = this->Counted(this->Distances.InspectVertices(this->Vertices.Update()));
  }
  if (!remedy.IsNeeded)
  {
    if (this->Repairs)
    {
      this->Made = this->Labeller.Make(this->Statistics);
    }
    else
    {
      this->Made.Labels = this->Labeller.MakePlain();
    }
    if (looks)
    {
      // Triangles are not sampled: on noise the mesh would become many times as large.
      remedy = this->Counted(this->Distances.InspectLabels(this->Made.Gone, {}));
    }
  }
  return remedy;
}

/** Makes a remedy of these points. If there are any, counts a round. */
Remedy<4> SpaceTimeInterfaceCheck::Counted(std::vector<FeatureSeed<4>> points)
{
  this->Statistics.Rounds += points.empty() ? 0 : 1;
  this->Statistics.Seeds += points.size();
  return { !points.empty(), std::move(points) };
}

} // namespace voxplex

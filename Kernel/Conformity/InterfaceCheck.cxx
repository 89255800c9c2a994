// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceCheck.h"

#include <utility>

namespace voxplex
{

namespace
{

ManifoldRepairOptions<3> RepairOptionsFor(const InterfaceCheck::Subject& subject)
{
  ManifoldRepairOptions<3> options;
  options.Shape = subject.Shape;
  options.Surfaces = &subject.Surfaces;
  options.Sizing = &subject.Sizing;
  return options;
}

} // namespace

InterfaceCheck::InterfaceCheck(const Subject& subject, const InterfaceOptions& options,
  LocalDelta<3>& local, InterfaceStatistics& statistics, double& seconds,
  const std::stop_token& stop)
  : ConformityCheck(seconds)
  , Of(subject)
  , Options(options)
  , Statistics(statistics)
  , Stop(stop)
  , Vertices(subject.Mesh, subject.Surfaces, subject.Threads, stop)
  , Labeller(subject.Mesh, RepairOptionsFor(subject), subject.Threads, stop)
{
  if (subject.Sizing.Base().Graded)
  {
    this->Graded.emplace(
      subject.Image, subject.Sites, subject.Surfaces, subject.Sizing, local, subject.Threads, stop);
  }
  else
  {
    this->Uniform.emplace(
      subject.Image, subject.Sites, subject.Surfaces, subject.Sizing, local, subject.Threads, stop);
  }
}

//------------------------------------------------------------------------------------------------
Remedy<3> InterfaceCheck::InspectTriangulation()
{
  if (this->Uniform && this->MayGoOn())
  {
    Remedy<3> remedy = this->Counted(this->Uniform->InspectVertices(this->Vertices.Update()));
    if (remedy.IsNeeded)
    {
      return remedy;
    }
  }
  this->MakeLabels();
  this->OpenEdges();
  return {};
}

Remedy<3> InterfaceCheck::InspectElements(const LabelledTriangulation<3>&)
{
  return this->Uniform && this->MayGoOn()
    ? this->Counted(this->Uniform->InspectLabels(this->Made.Gone, this->Made.Places))
    : Remedy<3>();
}

Remedy<3> InterfaceCheck::InspectMesh(const SimplexMesh<3>& mesh)
{
  return this->NeedsMesh() ? this->Counted(this->Graded->Inspect(mesh, this->Made.Places))
                           : Remedy<3>();
}

void InterfaceCheck::Finish()
{
  this->Vertices.Forget();
  this->Labeller.Forget();
  this->Uniform.reset();
}

/** Makes a remedy of these points. If there are any, counts a round. */
Remedy<3> InterfaceCheck::Counted(std::vector<FeatureSeed<3>> points)
{
  this->Statistics.Rounds += points.empty() ? 0 : 1;
  this->Statistics.Seeds += points.size();
  return { !points.empty(), std::move(points) };
}

//------------------------------------------------------------------------------------------------
void InterfaceCheck::MakeLabels()
{
  this->Made = {}; // the labels of the round before need no memory beside the new ones
  this->Spindles = {};
  if (this->Options.Manifold)
  {
    this->Made = this->Labeller.Make(this->Statistics);
  }
  else
  {
    this->Made.Labels = this->Labeller.MakePlain();
  }
}

/** Opens the edges that are not manifold with these labels. */
void InterfaceCheck::OpenEdges()
{
  SpindleResult<3> result = MakeSpindles(
    this->Of.Mesh, this->Of.Surfaces, this->Made.Labels, this->Made.NonManifold, this->Stop);
  this->Statistics.CountOpened(this->Made.NonManifold.size(), result.Left.size());
  this->Spindles = std::move(result.Parts);
}

} // namespace voxplex

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceCheck.h"

#include "Delaunay/VertexStar.h"

#include <algorithm>
#include <utility>

namespace voxplex
{

InterfaceCheck::InterfaceCheck(const Subject& subject, const InterfaceOptions& options,
  LocalDelta<3>& local, InterfaceStatistics& statistics, double& seconds,
  const std::stop_token& stop)
  : ConformityCheck(seconds)
  , Of(subject)
  , Options(options)
  , Statistics(statistics)
  , Stop(stop)
  , Vertices(subject.Mesh, subject.Surfaces, subject.Threads, stop)
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
  const bool looks = this->Uniform && this->MayGoOn();
  Remedy<3> remedy;
  if (looks)
  {
    remedy = this->Counted(this->Uniform->InspectVertices(this->Vertices.Update()));
  }
  if (!remedy.IsNeeded)
  {
    this->MakeLabels();
    if (looks)
    {
      remedy = this->Counted(this->Uniform->InspectLabels(this->Gone, this->Places));
    }
  }
  if (!remedy.IsNeeded)
  {
    this->OpenEdges();
  }
  return remedy;
}

Remedy<3> InterfaceCheck::InspectMesh(const SimplexMesh<3>& mesh)
{
  return this->Graded && this->MayGoOn() ? this->Counted(this->Graded->Inspect(mesh, this->Places))
                                         : Remedy<3>();
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
  const Triangulation<3>& mesh = this->Of.Mesh;
  this->LabelOf = LabelSimplices(mesh, this->Of.Surfaces, this->Of.Threads, this->Stop);
  const std::vector<SimplexId> relabelled =
    this->Options.Manifold ? this->Repair() : std::vector<SimplexId>();
  this->Gone = this->VerticesWithin(relabelled);
}

/** @return the tetrahedra that got another label */
std::vector<SimplexId> InterfaceCheck::Repair()
{
  const Triangulation<3>& mesh = this->Of.Mesh;
  ManifoldRepairOptions options;
  options.Shape = this->Of.Shape;
  options.Surfaces = &this->Of.Surfaces;
  options.Sizing = &this->Of.Sizing;
  ManifoldRepairResult result =
    RepairManifold(mesh, this->LabelOf, options, this->Of.Threads, this->Stop);
  this->Statistics.NonManifoldRepaired = result.Before - result.Left.size();
  this->Statistics.NonManifoldLeft = result.Left.size();
  this->NonManifold = std::move(result.Left);
  this->Places.clear();
  for (const InterfaceEdge& edge : this->NonManifold)
  {
    this->Places.push_back(
      { Interpolate(mesh.Position(edge.Ends[0]), mesh.Position(edge.Ends[1]), 0.5),
        edge.IsJunction });
  }
  return std::move(result.Relabelled);
}

/** Opens the edges that Repair() left non-manifold. */
void InterfaceCheck::OpenEdges()
{
  SpindleResult result =
    MakeSpindles(this->Of.Mesh, this->Of.Surfaces, this->LabelOf, this->NonManifold, this->Stop);
  const std::size_t opened = this->NonManifold.size() - result.Left.size();
  this->Statistics.NonManifoldOpened = opened;
  this->Statistics.NonManifoldRepaired += opened;
  this->Statistics.NonManifoldLeft = result.Left.size();
  this->Spindles = std::move(result.Parts);
}

/** Vertices of these tetrahedra that are inside of a label. */
std::vector<Point<3>> InterfaceCheck::VerticesWithin(const std::vector<SimplexId>& relabelled) const
{
  const Triangulation<3>& mesh = this->Of.Mesh;
  std::vector<VertexId> vertices;
  for (const SimplexId s : relabelled)
  {
    const auto& v = mesh.GetSimplex(s).V;
    vertices.insert(vertices.end(), v.begin(), v.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Point<3>> within;
  for (const VertexId v : vertices)
  {
    const std::vector<SimplexId> star = StarOf(mesh, v, mesh.GetVertex(v).Incident);
    if (std::all_of(star.begin(), star.end(),
          [&](SimplexId s) { return this->LabelOf[s] == this->LabelOf[star.front()]; }))
    {
      within.push_back(mesh.Position(v));
    }
  }
  return within;
}

} // namespace voxplex

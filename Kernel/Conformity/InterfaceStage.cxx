// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceStage.h"

#include "Delaunay/VertexStar.h"

#include <algorithm>
#include <utility>

namespace voxplex
{

InterfaceStage::InterfaceStage(const Subject& subject, const InterfaceOptions& options,
  LocalDelta<3>& local, InterfaceStatistics& figures, const std::stop_token& stop)
  : Of(subject)
  , Options(options)
  , Figures(figures)
  , Stop(stop)
  , Vertices(subject.Mesh, subject.Surfaces, subject.Threads, stop)
  , Guard(subject.Image, subject.Sites, subject.Surfaces, subject.Base, subject.Sizes, local,
      subject.Threads, stop)
{
}

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> InterfaceStage::InspectTriangulation()
{
  const bool looks = this->MayGoOn() && !this->Of.Base.Graded;
  std::vector<FeatureSeed<3>> seeds;
  if (looks)
  {
    seeds = this->Counted(this->Guard.InspectVertices(this->Vertices.Update()));
  }
  if (seeds.empty())
  {
    this->MakeLabels();
    if (looks)
    {
      seeds = this->Counted(this->Guard.InspectLabels(this->Gone, this->Pinches));
    }
  }
  if (seeds.empty())
  {
    this->OpenEdges();
  }
  return seeds;
}

std::vector<FeatureSeed<3>> InterfaceStage::InspectMesh(const SimplexMesh<3>& mesh)
{
  return this->MayGoOn() && this->Of.Base.Graded
    ? this->Counted(this->Guard.InspectMesh(mesh, this->Pinches))
    : std::vector<FeatureSeed<3>>();
}

/** A round of those asked for, if there are points to go on with. */
std::vector<FeatureSeed<3>> InterfaceStage::Counted(std::vector<FeatureSeed<3>> seeds)
{
  this->Figures.Rounds += seeds.empty() ? 0 : 1;
  this->Figures.Seeds += seeds.size();
  return seeds;
}

//------------------------------------------------------------------------------------------------
void InterfaceStage::MakeLabels()
{
  const Triangulation<3>& mesh = this->Of.Mesh;
  this->LabelOf = LabelSimplices(mesh, this->Of.Surfaces, this->Of.Threads, this->Stop);
  const std::vector<SimplexId> relabelled =
    this->Options.Manifold ? this->Repair() : std::vector<SimplexId>();
  this->Gone = this->VerticesWithin(relabelled);
}

/** @return the tetrahedra that got another label */
std::vector<SimplexId> InterfaceStage::Repair()
{
  const Triangulation<3>& mesh = this->Of.Mesh;
  ManifoldRepairOptions options;
  options.Shape = this->Of.Shape;
  options.Surfaces = &this->Of.Surfaces;
  options.Size = this->Of.Size;
  ManifoldRepairResult result =
    RepairManifold(mesh, this->LabelOf, options, this->Of.Threads, this->Stop);
  this->Figures.NonManifoldRepaired = result.Before - result.Left.size();
  this->Figures.NonManifoldLeft = result.Left.size();
  this->NonManifold = std::move(result.Left);
  this->Pinches.clear();
  for (const InterfaceEdge& edge : this->NonManifold)
  {
    this->Pinches.push_back(
      { Interpolate(mesh.Position(edge.Ends[0]), mesh.Position(edge.Ends[1]), 0.5),
        edge.IsJunction });
  }
  return std::move(result.Relabelled);
}

/** What whole tetrahedra did not mend. */
void InterfaceStage::OpenEdges()
{
  SpindleResult result =
    MakeSpindles(this->Of.Mesh, this->Of.Surfaces, this->LabelOf, this->NonManifold, this->Stop);
  const std::size_t opened = this->NonManifold.size() - result.Left.size();
  this->Figures.NonManifoldOpened = opened;
  this->Figures.NonManifoldRepaired += opened;
  this->Figures.NonManifoldLeft = result.Left.size();
  this->Spindles = std::move(result.Parts);
}

/** Vertices of these tetrahedra that are inside of a label. */
std::vector<Point<3>> InterfaceStage::VerticesWithin(const std::vector<SimplexId>& relabelled) const
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

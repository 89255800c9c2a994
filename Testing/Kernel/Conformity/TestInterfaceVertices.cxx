// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The vertices on the interfaces of a triangulation are marked, and stay so while it changes.
#include "Base/Error.h"
#include "ComplexOf.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/ManifoldLabels.h"
#include "Domain/ImageDomain.h"
#include "InterfaceChecks.h"
#include "RefinementChecks.h"
#include "RepairTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <set>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

std::set<Point<3>> MarkedVertices(const Triangulation<3>& mesh)
{
  std::set<Point<3>> marked;
  for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
  {
    if (mesh.GetVertex(v).Alive && mesh.GetVertex(v).OnInterface)
    {
      EXPECT_TRUE(marked.insert(mesh.Position(v)).second);
    }
  }
  return marked;
}

/** Of the facets of the mesh with these labels. */
std::set<Point<3>> VerticesOfFacets(
  const Triangulation<3>& triangulation, const Domain<3>& domain, const SimplexLabels& labels)
{
  SimplexMesh<3> mesh;
  ExtractMesh<3>(triangulation, domain, labels, mesh);
  std::set<Point<3>> vertices;
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t v : facet)
    {
      vertices.insert(mesh.Points[v]);
    }
  }
  return vertices;
}

VertexId InsertFree(Triangulation<3>& mesh, Triangulation<3>::Worker& worker, const Point<3>& p)
{
  const SimplexId conflict = mesh.FindConflict(worker, p, mesh.FirstAlive());
  EXPECT_EQ(mesh.Insert(worker, p, VertexKind::Free, conflict), InsertionOutcome::Inserted);
  return worker.NewVertex;
}

/** Makes the labels again, which marks vertices, and compares these with the facets of the mesh. */
class CheckedVertices
{
public:
  CheckedVertices(Triangulation<3>& mesh, const Domain<3>& domain, unsigned threads)
    : Mesh(mesh)
    , Image(domain)
    , Labeller(mesh, ManifoldRepairOptions<3>{ .Surfaces = &domain }, threads, {})
  {
    this->Update();
    this->Added = 0;
  }

  void Update()
  {
    InterfaceStatistics figures;
    const checks::RepairedLabels<3> made = checks::LabelsOf(this->Labeller, figures);
    const std::set<Point<3>> now = MarkedVertices(this->Mesh);
    EXPECT_EQ(now, VerticesOfFacets(this->Mesh, this->Image, made.Labels));
    this->Added += Difference(now, this->Before).size();
    this->Gone += Difference(this->Before, now).size();
    this->Before = now;
  }

  std::size_t Added = 0; ///< in all updates
  std::size_t Gone = 0;

private:
  static std::set<Point<3>> Difference(
    const std::set<Point<3>>& from, const std::set<Point<3>>& without)
  {
    std::set<Point<3>> left;
    std::set_difference(
      from.begin(), from.end(), without.begin(), without.end(), std::inserter(left, left.begin()));
    return left;
  }

  Triangulation<3>& Mesh;
  const Domain<3>& Image;
  ManifoldLabeller<3> Labeller;
  std::set<Point<3>> Before;
};

void ExpectVerticesOfFacets(const Domain<3>& domain, double delta)
{
  SCOPED_TRACE(delta);
  const auto refined = Refined(domain, delta);
  Triangulation<3>& mesh = refined->Mesh;
  const SimplexLabels labels = LabelSimplices<3>(mesh, domain);
  const std::set<Point<3>> expected = VerticesOfFacets(mesh, domain, labels);
  EXPECT_GT(expected.size(), 3u);
  for (const unsigned threads : { 1u, 3u })
  {
    MarkInterfaceVertices<3>(mesh, labels, threads, {});
    EXPECT_EQ(MarkedVertices(mesh), expected);
  }
  std::vector<SimplexId> all = AliveIn(mesh);
  for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
  {
    mesh.SetOnInterface(v, v % 2 == 0);
  }
  MarkInterfaceVerticesOf<3>(mesh, labels, all, 3, {});
  EXPECT_EQ(MarkedVertices(mesh), expected);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(MarkInterfaceVertices<3>(mesh, labels, 1, stop.get_token()), Cancelled);
}

} // namespace

TEST(InterfaceVertices, AreThoseOfTheFacetsOfTheMesh)
{
  const LabelImage<3> image = phantoms::TouchingLabels(24);
  ExpectVerticesOfFacets(ImageDomain<3>(image, 1.0), 2.5);
  for (const double delta : { 0.5, 1.0, 2.0, 4.0, 5.0, 7.0 })
  {
    ExpectVerticesOfFacets(BallDomain(5.0), delta);
  }
}

// Points come and go, as rules would ask for it, and ids of vertices and simplices are used again.
TEST(InterfaceVertices, FollowATriangulationThatChanges)
{
  const LabelImage<3> image = Blobs(1);
  const ImageDomain<3> domain(image, 1.0);
  for (const unsigned threads : { 1u, 3u })
  {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(4.0, 27.0);
    const auto refined = Refined(domain, 4.0);
    Triangulation<3>& mesh = refined->Mesh;
    Triangulation<3>::Worker worker(mesh);
    CheckedVertices vertices(mesh, domain, threads);
    std::vector<VertexId> inserted;
    for (int round = 0; round < 40; ++round)
    {
      for (std::size_t k = random() % 8; k > 0 && !inserted.empty(); --k)
      {
        std::swap(inserted[random() % inserted.size()], inserted.back());
        ASSERT_EQ(mesh.Remove(worker, inserted.back()), RemovalOutcome::Removed);
        inserted.pop_back();
      }
      for (std::size_t k = random() % 9; k > 0; --k)
      {
        const Point<3> p{ uniform(random), uniform(random), uniform(random) };
        inserted.push_back(InsertFree(mesh, worker, p));
      }
      SCOPED_TRACE(round);
      vertices.Update();
    }
    EXPECT_GT(vertices.Added, 40u);
    EXPECT_GT(vertices.Gone, 20u);
  }
}

// All ids are others then. Marks move with the vertices.
TEST(InterfaceVertices, FollowARenumberedTriangulation)
{
  const LabelImage<3> image = Blobs(1);
  const ImageDomain<3> domain(image, 1.0);
  for (const unsigned threads : { 1u, 3u })
  {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(4.0, 27.0);
    const auto refined = Refined(domain, 4.0);
    Triangulation<3>& mesh = refined->Mesh;
    CheckedVertices vertices(mesh, domain, threads);
    for (const int insertions : { 0, 6, 6, 6, 300, 6 })
    {
      {
        Triangulation<3>::Worker worker(mesh);
        for (int k = 0; k < insertions; ++k)
        {
          const Point<3> p{ uniform(random), uniform(random), uniform(random) };
          InsertFree(mesh, worker, p);
          const auto v = static_cast<VertexId>(random() % mesh.VertexIdEnd());
          if (mesh.GetVertex(v).Alive && mesh.GetVertex(v).Kind != VertexKind::Box)
          {
            mesh.Remove(worker, v);
          }
        }
      }
      mesh.Renumber(threads);
      SCOPED_TRACE(insertions);
      vertices.Update();
    }
    EXPECT_GT(vertices.Added, 100u);
    EXPECT_GT(vertices.Gone, 100u);
  }
}

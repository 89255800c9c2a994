// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The vertices on the interfaces of a triangulation, and how they are followed.
#include "Base/Error.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/PositionDifference.h"
#include "Domain/ImageDomain.h"
#include "InterfaceChecks.h"
#include "Mesh/MeshExtraction.h"
#include "RefinementChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <set>
#include <span>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Of the facets of the mesh. */
std::set<Point<3>> VerticesOfFacets(const RefinementContext<3>& refined, const Domain<3>& domain)
{
  SimplexMesh<3> mesh;
  ExtractMesh<3>(refined.Mesh, domain, mesh);
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

std::set<Point<3>> AsSet(std::span<const Point<3>> points)
{
  const std::set<Point<3>> set(points.begin(), points.end());
  EXPECT_EQ(set.size(), points.size());
  return set;
}

std::set<Point<3>> Difference(const std::set<Point<3>>& from, const std::set<Point<3>>& without)
{
  std::set<Point<3>> left;
  std::set_difference(
    from.begin(), from.end(), without.begin(), without.end(), std::inserter(left, left.begin()));
  return left;
}

VertexId InsertFree(Triangulation<3>& mesh, Triangulation<3>::Worker& worker, const Point<3>& p)
{
  const SimplexId conflict = mesh.FindConflict(worker, p, mesh.FirstAlive());
  EXPECT_EQ(mesh.Insert(worker, p, VertexKind::Free, conflict), InsertionOutcome::Inserted);
  return worker.NewVertex;
}

/** Compares each update with the facets of the mesh. */
class CheckedVertices
{
public:
  CheckedVertices(const RefinementContext<3>& refined, const Domain<3>& domain, unsigned threads)
    : Refined(refined)
    , Image(domain)
    , Vertices(refined.Mesh, domain, threads)
    , Before(AsSet(this->Vertices.Update().Added))
  {
  }

  void Update()
  {
    const std::set<Point<3>> now = VerticesOfFacets(this->Refined, this->Image);
    const InterfaceVertices<3>::Changes changes = this->Vertices.Update();
    EXPECT_EQ(AsSet(changes.Added), Difference(now, this->Before));
    EXPECT_EQ(AsSet(changes.Gone), Difference(this->Before, now));
    this->Added += changes.Added.size();
    this->Gone += changes.Gone.size();
    this->Before = now;
  }

  std::size_t Added = 0; ///< in all updates
  std::size_t Gone = 0;

private:
  const RefinementContext<3>& Refined;
  const Domain<3>& Image;
  InterfaceVertices<3> Vertices;
  std::set<Point<3>> Before;
};

void ExpectVerticesOfFacets(const Domain<3>& domain, double delta)
{
  SCOPED_TRACE(delta);
  const auto refined = Refined(domain, delta);
  const std::set<Point<3>> expected = VerticesOfFacets(*refined, domain);
  EXPECT_GT(expected.size(), 3u);
  for (const unsigned threads : { 1u, 3u })
  {
    InterfaceVertices<3> vertices(refined->Mesh, domain, threads);
    const InterfaceVertices<3>::Changes all = vertices.Update();
    EXPECT_EQ(AsSet(all.Added), expected);
    EXPECT_TRUE(all.Gone.empty());
    const InterfaceVertices<3>::Changes none = vertices.Update();
    EXPECT_TRUE(none.Added.empty());
    EXPECT_TRUE(none.Gone.empty());
  }
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(
    InterfaceVertices<3>(refined->Mesh, domain, 1, stop.get_token()).Update(), Cancelled);
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
    CheckedVertices vertices(*refined, domain, threads);
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

// All ids are others then. Positions tell which vertices are new.
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
    CheckedVertices vertices(*refined, domain, threads);
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

// Points that differ in the last place only, and the two zeros.
TEST(PositionDifference, TellsEqualPositionsOnly)
{
  const double next = std::nextafter(1.0, 2.0);
  const std::vector<Point<3>> first{ { 1.0, 2.0, 3.0 }, { 0.0, 5.0, 5.0 }, { 7.0, 7.0, 7.0 } };
  const std::vector<Point<3>> second{ { next, 2.0, 3.0 }, { 7.0, 7.0, 7.0 }, { -0.0, 5.0, 5.0 } };
  for (const unsigned threads : { 1u, 3u })
  {
    const PositionDifference<3> difference = DifferenceOf<3>(first, second, threads, {});
    EXPECT_EQ(difference.OfFirst, (std::vector<Point<3>>{ { 1.0, 2.0, 3.0 } }));
    EXPECT_EQ(difference.OfSecond, (std::vector<Point<3>>{ { next, 2.0, 3.0 } }));
  }
  const PositionDifference<3> none = DifferenceOf<3>({}, {}, 1, {});
  EXPECT_TRUE(none.OfFirst.empty() && none.OfSecond.empty());
}

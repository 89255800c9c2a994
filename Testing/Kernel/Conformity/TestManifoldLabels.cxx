// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Labels stay with their simplices through further refinement, and boundaries are as manifold as if all
// simplices were looked at.
#include "Conformity/ManifoldLabels.h"
#include "Delaunay/VertexStar.h"
#include "Domain/ImageDomain.h"
#include "Geometry/SimplexQuality.h"
#include "InterfaceChecks.h"
#include "Refinement/Rules/Rules4D.h"
#include "RefinementChecks.h"
#include "RepairTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

template <int D>
ManifoldRepairOptions<D> OptionsFor(const Domain<D>& domain)
{
  ManifoldRepairOptions<D> options;
  options.Surfaces = &domain;
  return options;
}

template <int D>
void ExpectSameRidges(
  const std::vector<InterfaceRidge<D>>& ridges, const std::vector<InterfaceRidge<D>>& expected)
{
  ASSERT_EQ(ridges.size(), expected.size());
  for (std::size_t k = 0; k < ridges.size(); ++k)
  {
    EXPECT_EQ(ridges[k].Vertices, expected[k].Vertices);
    EXPECT_EQ(ridges[k].IsJunction, expected[k].IsJunction);
  }
}

template <int D>
void ExpectSame(const checks::RepairedLabels<D>& again, const checks::RepairedLabels<D>& expected)
{
  EXPECT_EQ(again.Labels, expected.Labels);
  EXPECT_EQ(again.Places.size(), expected.Places.size());
  ExpectSameRidges(again.NonManifold, expected.NonManifold);
}

/**
 * Inserts points at random, and removes some vertices, half of them near such points.
 * @param places most points come near one of these, if there are any; the others anywhere in the box
 */
template <int D>
void ChangeAtRandom(Triangulation<D>& mesh, const Box<D>& box, const std::vector<Point<D>>& places,
  std::size_t insertions, std::mt19937& random)
{
  typename Triangulation<D>::Worker worker(mesh);
  for (std::size_t k = 0; k < insertions; ++k)
  {
    Box<D> part = box;
    if (!places.empty() && k % 4 != 0)
    {
      part = { places[random() % places.size()], {} };
      part.Max = part.Min;
      for (std::size_t a = 0; a < part.Min.size(); ++a)
      {
        part.Min[a] -= 1.0;
        part.Max[a] += 1.0;
      }
    }
    Point<D> p;
    for (std::size_t a = 0; a < p.size(); ++a)
    {
      p[a] = std::uniform_real_distribution<double>(part.Min[a], part.Max[a])(random);
    }
    const SimplexId conflict = mesh.FindConflict(worker, p, mesh.FirstAlive());
    const VertexId corner = mesh.GetSimplex(conflict).V[0];
    ASSERT_EQ(mesh.Insert(worker, p, VertexKind::Free, conflict), InsertionOutcome::Inserted);
    for (const VertexId v : { corner, static_cast<VertexId>(random() % mesh.VertexIdEnd()) })
    {
      if (k % 3 == 0 && mesh.GetVertex(v).Alive && mesh.GetVertex(v).Kind != VertexKind::Box)
      {
        mesh.Remove(worker, v);
      }
    }
  }
}

/** The number of simplices with each label. */
std::map<LabelId, std::size_t> CountLabels(const SimplexLabels& labels)
{
  std::map<LabelId, std::size_t> numbers;
  for (const LabelId label : labels)
  {
    numbers[label] += label != 0 ? 1u : 0u;
  }
  return numbers;
}

/** Interface triangles that repairs have made keep the bounds of angles, beside new tetrahedra, too. */
void ExpectNoSharpFacets(
  const Triangulation<3>& mesh, const SimplexLabels& plain, const SimplexLabels& given)
{
  std::vector<std::set<LabelId>> around(mesh.VertexIdEnd());
  for (SimplexId s = 0; s < given.size(); ++s)
  {
    for (const VertexId v : mesh.GetSimplex(s).V)
    {
      if (mesh.IsAlive(s))
      {
        around[v].insert(given[s]);
      }
    }
  }
  for (SimplexId s = 0; s < given.size(); ++s)
  {
    const auto& simplex = mesh.GetSimplex(s);
    for (unsigned i = 0; i < 4; ++i)
    {
      const SimplexId n = simplex.N[i];
      if (mesh.IsAlive(s) && n != None && plain[n] == plain[s] && given[n] < given[s])
      {
        const auto corner = [&](unsigned k) { return simplex.V[(i + k) % 4]; };
        const std::array<double, 3> angles = PlanarAngles(
          mesh.Position(corner(1)), mesh.Position(corner(2)), mesh.Position(corner(3)));
        const bool isAtJunction = around[corner(1)].size() > 2 || around[corner(2)].size() > 2 ||
          around[corner(3)].size() > 2;
        const ShapeBounds bounds;
        EXPECT_GE(*std::min_element(angles.begin(), angles.end()),
          (isAtJunction ? bounds.JunctionFacetAngle : bounds.FacetAngle) - 1e-6);
      }
    }
  }
}

/**
 * Makes the labels of two equal triangulations again and again, one with one thread and one with three.
 * @return the repaired ridges of all rounds
 */
template <int D>
std::size_t CheckRounds(std::array<Triangulation<D>*, 2> meshes, const Domain<D>& domain,
  const std::vector<std::size_t>& insertions)
{
  std::array<std::mt19937, 2> random{ std::mt19937(1), std::mt19937(1) };
  const Triangulation<D>& mesh = *meshes[0];
  ManifoldLabeller<D> one(*meshes[0], OptionsFor(domain), 1, {});
  ManifoldLabeller<D> three(*meshes[1], OptionsFor(domain), 3, {});
  std::vector<Point<D>> places; // of simplices with another label
  std::array<InterfaceStatistics, 2> figures;
  checks::RepairedLabels<D> made;
  for (const std::size_t number : insertions)
  {
    SCOPED_TRACE(number);
    for (std::size_t k = 0; k < 2; ++k)
    {
      ChangeAtRandom(*meshes[k], domain.Bounds(), places, number, random[k]);
    }
    made = checks::LabelsOf(one, figures[0]);
    ExpectSame(checks::LabelsOf(three, figures[1]), made);
    EXPECT_EQ(figures[1].NonManifoldRepaired, figures[0].NonManifoldRepaired);
    EXPECT_EQ(figures[0].NonManifoldLeft, made.NonManifold.size());

    // Nothing is overlooked, though few simplices are looked at.
    ExpectSameRidges(made.NonManifold, FindNonManifoldRidges<D>(mesh, made.Labels));

    const SimplexLabels plain = LabelSimplices<D>(mesh, domain);
    if constexpr (D == 3)
    {
      ExpectNoSharpFacets(mesh, plain, made.Labels);
    }
    places.clear();
    for (SimplexId s = 0; s < plain.size(); ++s)
    {
      if (plain[s] != made.Labels[s])
      {
        places.push_back(mesh.Position(mesh.GetSimplex(s).V[0]));
      }
    }
  }
  // New numbers are no new simplices.
  const std::size_t repaired = figures[0].NonManifoldRepaired;
  if (made.NonManifold.empty())
  {
    meshes[0]->Renumber(2);
    const checks::RepairedLabels<D> again = checks::LabelsOf(one, figures[0]);
    EXPECT_EQ(CountLabels(again.Labels), CountLabels(made.Labels));
    EXPECT_EQ(figures[0].NonManifoldRepaired, repaired);
  }
  return repaired;
}

} // namespace

//------------------------------------------------------------------------------------------------
// Few simplices are new in most rounds, many in one, and none in another.
TEST(ManifoldLabels, AreMadeAgain)
{
  for (const unsigned seed : { 1u, 2u, 3u })
  {
    SCOPED_TRACE(seed);
    const LabelImage<3> image = Blobs(seed);
    const ImageDomain<3> domain(image, 1.0);
    const auto context = Refined(domain, 2.0);
    const auto other = Refined(domain, 2.0);
    EXPECT_GT(CheckRounds<3>({ &context->Mesh, &other->Mesh }, domain,
                { 0, 5, 0, 8, 1, 500, 10, 10, 10, 10, 10, 3 }),
      20u);
  }
}

// Fragments become loose, or are not loose any more, because of new tetrahedra at a vertex.
TEST(ManifoldLabels, AreMadeAgainAmongManyLabels)
{
  constexpr std::int64_t Side = 24;
  std::mt19937 random(1);
  std::vector<std::uint8_t> cubes(Side * Side * Side / 8);
  std::generate(
    cubes.begin(), cubes.end(), [&] { return static_cast<std::uint8_t>(random() % 7); });
  std::vector<std::uint8_t> voxels;
  for (std::int64_t v = 0; v < Side * Side * Side; ++v)
  {
    const std::int64_t i = v % Side / 2;
    const std::int64_t j = v / Side % Side / 2;
    const std::int64_t k = v / (Side * Side) / 2;
    voxels.push_back(cubes[static_cast<std::size_t>(i + Side / 2 * (j + Side / 2 * k))]);
  }
  const LabelImage<3> image = LabelImage<3>::FromScalars<std::uint8_t>(
    voxels, GridGeometry<3>::Orthogonal({ Side, Side, Side }, { 1.0, 1.0, 1.0 }));
  const ImageDomain<3> domain(image, 1.0);
  const auto context = Refined(domain, 2.0);
  const auto other = Refined(domain, 2.0);
  std::vector<std::size_t> insertions{ 0 };
  insertions.insert(insertions.end(), 36, 10);
  EXPECT_GT(CheckRounds<3>({ &context->Mesh, &other->Mesh }, domain, insertions), 100u);
}

TEST(ManifoldLabels, AreMadeAgainInSpaceTime)
{
  std::mt19937 random(1);
  std::vector<std::uint16_t> voxels(3 * 3 * 3 * 2);
  for (std::uint16_t& voxel : voxels)
  {
    voxel = static_cast<std::uint16_t>(random() % 3);
  }
  const LabelImage<4> image = LabelImage<4>::FromScalars<std::uint16_t>(
    voxels, GridGeometry<4>::Orthogonal({ 3, 3, 3, 2 }, { 3.0, 3.0, 3.0, 3.0 }));
  const ImageDomain<4> domain(image, 1.0);
  RefinementSettings<4> settings;
  settings.Sizing.Base = { 1.4 };
  settings.SpaceTime.Slivers.Fight = false;
  Box<4> box = Around<4>(domain, 1.4);
  box.Min[3] = domain.Bounds().Min[3]; // flat ends
  box.Max[3] = domain.Bounds().Max[3];
  RefinementContext<4> context(domain, settings, box, 1000);
  RefinementContext<4> other(domain, settings, box, 1000);
  ASSERT_TRUE(Refiner<Rules4D>(context).Run(nullptr));
  ASSERT_TRUE(Refiner<Rules4D>(other).Run(nullptr));
  EXPECT_GT(CheckRounds<4>({ &context.Mesh, &other.Mesh }, domain, { 0, 1, 30, 1 }), 10u);
}

//------------------------------------------------------------------------------------------------
TEST(NonManifoldRidges, AreFoundAtChangedSimplices)
{
  const LabelImage<3> image = Blobs(1);
  const ImageDomain<3> domain(image, 1.0);
  const auto context = Refined(domain, 3.0);
  const Triangulation<3>& mesh = context->Mesh;
  SimplexLabels labels = LabelSimplices<3>(mesh, domain);
  std::mt19937 random(1);
  std::vector<SimplexId> changed;
  for (int round = 0; round < 20; ++round)
  {
    for (int k = 0; k < 20; ++k)
    {
      const auto s = static_cast<SimplexId>(random() % labels.size());
      if (mesh.IsAlive(s))
      {
        labels[s] = static_cast<LabelId>(random() % 3);
        changed.push_back(s);
      }
    }
    std::vector<InterfaceRidge<3>> expected = FindNonManifoldRidges<3>(mesh, labels);
    std::erase_if(expected,
      [&](const InterfaceRidge<3>& ridge)
      {
        return std::none_of(changed.begin(), changed.end(),
          [&](SimplexId s)
          {
            const auto& v = mesh.GetSimplex(s).V;
            return std::all_of(ridge.Vertices.begin(), ridge.Vertices.end(),
              [&v](VertexId x) { return std::find(v.begin(), v.end(), x) != v.end(); });
          });
      });
    const auto found = FindNonManifoldRidgesOf<3>(mesh, labels, changed, 1 + round % 3);
    ExpectSameRidges(found, expected);
    EXPECT_GT(found.size(), 3u);
  }
}

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Labels that are made again after further refinement are those of a new object.
#include "Conformity/Crumbs.h"
#include "Conformity/ManifoldLabels.h"
#include "Conformity/RepairMemory.h"
#include "Delaunay/VertexStar.h"
#include "Domain/ImageDomain.h"
#include "InterfaceChecks.h"
#include "Refinement/Rules4D.h"
#include "RefinementChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
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
void ExpectSame(const ManifoldLabels<D>& again, const ManifoldLabels<D>& expected)
{
  EXPECT_EQ(again.Labels, expected.Labels);
  EXPECT_EQ(again.Gone, expected.Gone);
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

/** Makes the labels again and again. @return the repaired ridges of all rounds */
template <int D>
std::size_t CheckRounds(
  Triangulation<D>& mesh, const Domain<D>& domain, const std::vector<std::size_t>& insertions)
{
  std::mt19937 random(1);
  ManifoldLabeller<D> one(mesh, OptionsFor(domain), 1, {});
  ManifoldLabeller<D> three(mesh, OptionsFor(domain), 3, {});
  std::vector<Point<D>> places; // of simplices with another label
  std::size_t repaired = 0;
  for (const std::size_t number : insertions)
  {
    SCOPED_TRACE(number);
    ChangeAtRandom(mesh, domain.Bounds(), places, number, random);
    std::array<InterfaceStatistics, 3> figures;
    const ManifoldLabels<D> expected =
      ManifoldLabeller<D>(mesh, OptionsFor(domain), 1, {}).Make(figures[0]);
    ExpectSame(one.Make(figures[1]), expected);
    ExpectSame(three.Make(figures[2]), expected);
    for (const InterfaceStatistics& same : figures)
    {
      EXPECT_EQ(same.NonManifoldRepaired, figures[0].NonManifoldRepaired);
      EXPECT_EQ(same.NonManifoldLeft, figures[0].NonManifoldLeft);
    }
    repaired += figures[0].NonManifoldRepaired;
    const SimplexLabels plain = one.MakePlain();
    places.clear();
    for (SimplexId s = 0; s < plain.size(); ++s)
    {
      if (plain[s] != expected.Labels[s])
      {
        places.push_back(mesh.Position(mesh.GetSimplex(s).V[0]));
      }
    }
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
    EXPECT_GT(
      CheckRounds<3>(context->Mesh, domain, { 0, 5, 0, 8, 1, 500, 10, 10, 10, 10, 10, 3 }), 20u);
  }
}

// Crumbs become crumbs, or no crumbs any more, because of new tetrahedra at a vertex.
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
  std::vector<std::size_t> insertions{ 0 };
  insertions.insert(insertions.end(), 36, 10);
  EXPECT_GT(CheckRounds<3>(context->Mesh, domain, insertions), 100u);
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
  ASSERT_TRUE(Refiner<Rules4D>(context).Run(nullptr));
  EXPECT_GT(CheckRounds<4>(context.Mesh, domain, { 0, 1, 30, 1 }), 20u);
}

//------------------------------------------------------------------------------------------------
TEST(NonManifoldRidges, AreUpdatedWhenLabelsChange)
{
  const LabelImage<3> image = Blobs(1);
  const ImageDomain<3> domain(image, 1.0);
  const auto context = Refined(domain, 3.0);
  const Triangulation<3>& mesh = context->Mesh;
  SimplexLabels labels = LabelSimplices<3>(mesh, domain);
  std::mt19937 random(1);
  std::vector<InterfaceRidge<3>> ridges = FindNonManifoldRidges<3>(mesh, labels);
  for (int round = 0; round < 20; ++round)
  {
    std::vector<SimplexId> changed;
    while (changed.size() < 20)
    {
      const auto s = static_cast<SimplexId>(random() % labels.size());
      if (mesh.IsAlive(s))
      {
        labels[s] = static_cast<LabelId>(random() % 3);
        changed.push_back(s);
      }
    }
    ridges = UpdateNonManifoldRidges<3>(mesh, labels, ridges, changed, 1 + round % 3);
    ExpectSameRidges(ridges, FindNonManifoldRidges<3>(mesh, labels));
  }
  EXPECT_GT(ridges.size(), 100u);
}

TEST(NonManifoldRidges, AreUpdatedWhenVerticesAreRemoved)
{
  const LabelImage<3> image = Blobs(1);
  const ImageDomain<3> domain(image, 1.0);
  const auto context = Refined(domain, 3.0);
  Triangulation<3>& mesh = context->Mesh;
  std::mt19937 random(1);
  SimplexLabels labels;
  SeenSimplices<3> seen(mesh);
  // Gives new simplices labels at random, and background to those that are gone.
  const auto labelNew = [&]
  {
    std::vector<SimplexId> added;
    labels.resize(mesh.SimplexIdEnd());
    seen.MakeRoom();
    for (SimplexId s = 0; s < labels.size(); ++s)
    {
      if (seen.See(s))
      {
        labels[s] = static_cast<LabelId>(random() % 3);
        added.push_back(s);
      }
      labels[s] = mesh.IsAlive(s) ? labels[s] : LabelId{ 0 };
    }
    return added;
  };
  labelNew();
  std::vector<InterfaceRidge<3>> ridges = FindNonManifoldRidges<3>(mesh, labels);
  Triangulation<3>::Worker worker(mesh);
  for (int round = 0; round < 20; ++round)
  {
    for (int k = 0; k < 5; ++k)
    {
      const auto v = static_cast<VertexId>(random() % mesh.VertexIdEnd());
      if (mesh.GetVertex(v).Alive && mesh.GetVertex(v).Kind != VertexKind::Box)
      {
        mesh.Remove(worker, v);
      }
    }
    const std::vector<SimplexId> added = labelNew();
    ridges = UpdateNonManifoldRidges<3>(mesh, labels, ridges, added, 1 + round % 3);
    ExpectSameRidges(ridges, FindNonManifoldRidges<3>(mesh, labels));
  }
  EXPECT_GT(ridges.size(), 100u);
}

TEST(SmallFragments, AreUpdatedAfterRefinement)
{
  const LabelImage<3> image = Blobs(2);
  const ImageDomain<3> domain(image, 1.0);
  const auto context = Refined(domain, 4.0);
  const auto find = [&](const SimplexLabels& labels)
  { return FindSmallFragments(context->Mesh, labels, 1, {}); };
  std::mt19937 random(1);
  std::vector<SimplexId> small = find(LabelSimplices<3>(context->Mesh, domain));
  SeenSimplices<3> seen(context->Mesh);
  std::size_t most = 0;
  for (int round = 0; round < 20; ++round)
  {
    std::vector<SimplexId> added;
    seen.MakeRoom();
    for (SimplexId s = 0; s < context->Mesh.SimplexIdEnd(); ++s)
    {
      seen.See(s);
    }
    ChangeAtRandom(context->Mesh, domain.Bounds(), {}, 10, random);
    seen.MakeRoom();
    for (SimplexId s = 0; s < context->Mesh.SimplexIdEnd(); ++s)
    {
      if (seen.See(s))
      {
        added.push_back(s);
      }
    }
    const SimplexLabels labels = LabelSimplices<3>(context->Mesh, domain);
    small = UpdateSmallFragments(context->Mesh, labels, small, added, 1 + round % 3, {});
    ASSERT_EQ(small, find(labels));
    most = std::max(most, small.size());
  }
  EXPECT_GT(most, 10u);
}

//------------------------------------------------------------------------------------------------
// Crumbs and bad ridges lie side by side, so that what is found for one depends on others.
TEST(RepairMemory, ChangesNoResult)
{
  const LabelImage<3> image = Blobs(1);
  const ImageDomain<3> domain(image, 1.0);
  const auto context = Refined(domain, 2.0);
  const Triangulation<3>& mesh = context->Mesh;
  SimplexLabels plain = LabelSimplices<3>(mesh, domain);
  std::mt19937 random(1);
  const auto changeOne = [&](SimplexLabels& labels)
  {
    const auto s = static_cast<SimplexId>(random() % labels.size());
    if (mesh.IsAlive(s))
    {
      labels[s] = static_cast<LabelId>(random() % 3);
    }
  };
  const auto verticesOfOther = [&mesh](const SimplexLabels& a, const SimplexLabels& b)
  {
    std::vector<SimplexId> other;
    for (SimplexId s = 0; s < a.size(); ++s)
    {
      if (mesh.IsAlive(s) && a[s] != b[s])
      {
        other.push_back(s);
      }
    }
    return VerticesOf(mesh, other);
  };
  for (std::size_t k = 0; k < plain.size() / 8; ++k)
  {
    changeOne(plain);
  }
  CrumbMemory crumbs;
  RepairMemory<3> ridges;
  SimplexLabels plainBefore = plain;
  SimplexLabels before = plain; // and without crumbs
  std::size_t relabelled = 0;
  std::size_t repaired = 0;
  for (unsigned round = 0; round < 100; ++round)
  {
    SCOPED_TRACE(round);
    const unsigned threads = 1 + round % 3;
    const std::vector<SimplexId> small = FindSmallFragments(mesh, plain, threads, {});
    SimplexLabels labels = plain;
    SimplexLabels expected = plain;
    crumbs.Changed = verticesOfOther(plain, plainBefore);
    const std::vector<SimplexId> changed =
      RelabelCrumbs(mesh, labels, small, {}, threads, {}, &crumbs);
    EXPECT_EQ(changed, RelabelCrumbs(mesh, expected, small, {}, 1, {}));
    ASSERT_EQ(labels, expected);
    relabelled += changed.size();

    ridges.Changed = verticesOfOther(labels, before);
    before = labels;
    const std::vector<InterfaceRidge<3>> bad = FindNonManifoldRidges<3>(mesh, labels);
    const ManifoldRepairResult<3> result =
      RepairManifold<3>(mesh, labels, bad, {}, threads, {}, &ridges);
    const ManifoldRepairResult<3> fresh = RepairManifold<3>(mesh, expected, bad);
    EXPECT_EQ(result.Relabelled, fresh.Relabelled);
    EXPECT_EQ(result.Left.size(), fresh.Left.size());
    ASSERT_EQ(labels, expected);
    repaired += result.Relabelled.size();

    plainBefore = plain;
    for (int k = 0; k < 25; ++k)
    {
      changeOne(plain);
    }
  }
  EXPECT_GT(relabelled, 1000u);
  EXPECT_GT(repaired, 1000u);
}

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Vertices that are inserted in poor pentatopes make better ones, and lose nothing.
#include "Geometry/SimplexQuality.h"
#include "MeshChecks.h"
#include "Optimisation/Pentatopes/PentatopeFlips.h"
#include "Optimisation/Pentatopes/PentatopeInsertion.h"
#include "Optimisation/Pentatopes/PentatopeOptimiser.h"
#include "PentatopeCases.h"
#include "Sanitizers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

// Several cavities one after the other.
TEST(PentatopeInsertion, FillsCavitiesWithBetterPentatopes)
{
  const LabelImage<4> image = ImageOf(phantoms::WithTimeScale(phantoms::OpeningTube(), 2.0));
  const ImageDomain<4> domain(image, 1.0);
  SimplexMesh<4> mesh = Mesh(image, UsualOptions(3.0), false).Mesh;
  const SimplexMesh<4> before = mesh;
  const PentatopeBounds bounds;
  PentatopeComplex complex = checks::ScoredComplexOf(mesh);
  const PentatopeRules rules(domain, bounds);
  Patch patch(complex, {}, 0);
  PentatopeCavity cavity(patch, rules);
  complex.Goal = bounds.Target;
  std::size_t made = 0;
  for (std::uint32_t s = 0; s < mesh.Simplices.size() && made < 40; ++s)
  {
    if (!complex.IsPoor(s))
    {
      continue;
    }
    const PentatopeInsertion insertion = cavity.Find(s, bounds.Target);
    if (!(insertion.After > insertion.Before))
    {
      continue;
    }
    ++made;
    double smallest = 1.0;
    double hypervolume = 0.0;
    for (const std::uint32_t old : insertion.Old)
    {
      ASSERT_EQ(complex.LabelOf(old), complex.LabelOf(s));
      smallest = std::min(smallest, complex.Scores[old]);
      hypervolume += SignedVolume<4>(complex.PointsOf(complex.Cells[old].V).data());
    }
    ASSERT_EQ(insertion.Before, smallest);
    const std::uint32_t v = AddVertex(complex, insertion.Place);
    ASSERT_TRUE(Replace(complex, patch, insertion.Old, insertion.New, v));
    VertexStar<4> star;
    ASSERT_TRUE(patch.GatherStar(v, star));
    ASSERT_EQ(star.Cells.size(), insertion.New.size());
    smallest = 1.0;
    for (const std::uint32_t n : star.Cells)
    {
      const auto points = complex.PointsOf(complex.Cells[n].V);
      const PentatopeShape shape = ShapeOf(points);
      ASSERT_NEAR(shape.Quality, complex.Scores[n], 1e-9);
      smallest = std::min(smallest, shape.Quality);
      hypervolume -= SignedVolume<4>(points.data());
    }
    ASSERT_NEAR(insertion.After, smallest, 1e-9);
    ASSERT_NEAR(hypervolume, 0.0, 1e-6);
  }
  EXPECT_EQ(made, 40u);
  mesh = checks::Written(complex);
  EXPECT_EQ(mesh.Points.size(), before.Points.size() + made);
  ExpectSound(mesh);
  ASSERT_EQ(InterfacesOf(mesh), InterfacesOf(before));
}

// One point is inside of five pentatopes, near a facet. A cavity of all five would be best without it.
// A bound that many pentatopes break before.
TEST(PentatopeInsertion, BreaksNoMoreBoundsThanBefore)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = ImageOf(phantoms::WithTimeScale(phantoms::OpeningTube(), 2.0));
  const ImageDomain<4> domain(image, 1.0);
  const SimplexMesh<4> mesh = Mesh(image, UsualOptions(3.0), false).Mesh;
  PentatopeBounds bounds;
  bounds.RadiusEdgeRatio = 1.1;
  PentatopeComplex complex = checks::ScoredComplexOf(mesh);
  complex.Goal = bounds.Target;
  const auto breaks = [&](const std::array<const Point<4>*, 5>& points)
  { return ShapeOf(points).Ratio > bounds.RadiusEdgeRatio ? 1 : 0; };
  const PentatopeRules rules(domain, bounds);
  const Patch patch(complex, {}, 0);
  PentatopeCavity cavity(patch, rules);
  int made = 0;
  int broken = 0;
  for (std::uint32_t s = 0; s < mesh.Simplices.size() && made < 40; ++s)
  {
    const PentatopeInsertion insertion =
      complex.IsPoor(s) ? cavity.Find(s, bounds.Target) : PentatopeInsertion();
    if (insertion.After > insertion.Before)
    {
      ++made;
      int before = 0;
      int after = 0;
      for (const std::uint32_t old : insertion.Old)
      {
        before += breaks(complex.PointsOf(complex.Cells[old].V));
      }
      for (const PentatopeComplex::Vertices& corners : insertion.New)
      {
        std::array<const Point<4>*, 5> points;
        for (std::size_t i = 0; i < 5; ++i)
        {
          points[i] = corners[i] == None ? &insertion.Place : &complex.Points[corners[i]];
        }
        after += breaks(points);
      }
      EXPECT_LE(after, before) << s;
      broken += after;
    }
  }
  EXPECT_EQ(made, 40);
  EXPECT_GT(broken, 0);
}

// Flips and insertions change stars, and vertices are new.
TEST(PentatopeComplex, StarsFollowChanges)
{
  const LabelImage<4> image = ImageOf(phantoms::WithTimeScale(phantoms::OpeningTube(), 2.0));
  const ImageDomain<4> domain(image, 1.0);
  const SimplexMesh<4> mesh = Mesh(image, UsualOptions(4.0), false).Mesh;
  const PentatopeBounds bounds;
  PentatopeComplex complex = checks::ScoredComplexOf(mesh);
  complex.Goal = 2.0 * bounds.Target;
  const PentatopeRules rules(domain, bounds);
  Patch patch(complex, {}, 0);
  PentatopeCavity cavity(patch, rules);
  std::size_t flips = 0;
  std::size_t insertions = 0;
  for (int pass = 0; pass < 6; ++pass)
  {
    for (std::uint32_t s = 0; s < complex.Cells.size(); ++s)
    {
      if (!complex.IsPoor(s))
      {
        continue;
      }
      const PentatopeFlip flip = FindFlip(complex, rules, s);
      if (flip.NumberOfOld != 0)
      {
        const std::span<const std::uint32_t> old(flip.Old.data(), flip.NumberOfOld);
        flips += Replace(complex, patch, old, { flip.New.data(), flip.NumberOfNew }) ? 1 : 0;
      }
      else if (insertions < 10u * (1u + static_cast<unsigned>(pass)))
      {
        const PentatopeInsertion insertion = cavity.Find(s, bounds.Target);
        if (insertion.After > insertion.Before)
        {
          const std::uint32_t v = AddVertex(complex, insertion.Place);
          insertions += Replace(complex, patch, insertion.Old, insertion.New, v) ? 1 : 0;
        }
      }
    }
    std::vector<std::vector<std::uint32_t>> stars(complex.Points.size());
    for (std::uint32_t s = 0; s < complex.Cells.size(); ++s)
    {
      for (std::size_t k = 0; k < 5 && complex.IsAlive(s); ++k)
      {
        stars[complex.Cells[s].V[k]].push_back(s);
      }
    }
    std::size_t whole = 0;
    for (std::uint32_t v = 0; v < stars.size(); ++v)
    {
      ASSERT_EQ(complex.Degrees[v], stars[v].size()) << v;
      VertexStar<4> star;
      if (patch.GatherStar(v, star))
      {
        ++whole;
        std::sort(star.Cells.begin(), star.Cells.end());
        ASSERT_EQ(star.Cells, stars[v]) << v;
      }
    }
    EXPECT_GT(whole, stars.size() * 9 / 10);
  }
  EXPECT_GT(flips, 200u);
  EXPECT_GT(insertions, 20u);
}

TEST(PentatopeInsertion, LosesNoVertex)
{
  const LabelImage<4> image = ImageOf(phantoms::FourBall(4.0));
  const ImageDomain<4> domain(image, 1.0);
  SimplexMesh<4> mesh;
  const double below = (1.0 - std::sqrt(5.0)) / 4.0; // makes a regular pentatope
  for (const Point<4>& p :
    { Point<4>{ 1.0, 0.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0, 0.0 }, { 0.0, 0.0, 1.0, 0.0 },
      { 0.0, 0.0, 0.0, 1.0 }, { below, below, below, below }, { 0.24, 0.24, 0.24, 0.24 } })
  {
    mesh.Points.push_back(p);
  }
  for (std::uint32_t left = 0; left < 5; ++left)
  {
    std::vector<Point<4>> points(mesh.Points.begin(), mesh.Points.end());
    mesh.Simplices.push_back(Without(points, left));
    mesh.Labels.push_back(1);
  }
  PentatopeBounds bounds;
  bounds.RadiusEdgeRatio = 100.0;
  PentatopeComplex complex = checks::ScoredComplexOf(mesh);
  complex.Goal = bounds.Target;
  ASSERT_TRUE(complex.IsPoor(4));
  const PentatopeInsertion insertion =
    PentatopeCavity(Patch(complex, {}, 0), PentatopeRules(domain, bounds)).Find(4, 0.2);
  EXPECT_LT(insertion.Old.size(), 5u);
}

// A cavity with more pentatopes than facets: some of the old ones are left without vertices.
// In random labels hardly any insertion helps. To look for one at each of the worst pentatopes would take
// most of the time.
TEST(PentatopeInsertion, EndsARoundThatIsInVain)
{
  const auto grid = GridGeometry<4>::Orthogonal({ 14, 14, 14, 6 }, { 1.0, 1.0, 1.0, 1.0 });
  std::mt19937_64 random(3);
  std::vector<std::uint8_t> voxels(14 * 14 * 14 * 6);
  for (std::uint8_t& voxel : voxels)
  {
    voxel = static_cast<std::uint8_t>(random() % 3);
  }
  const LabelImage<4> image = LabelImage<4>::FromScalars<std::uint8_t>(voxels, grid);
  const ImageDomain<4> domain(image, 1.0);
  SimplexMesh<4> mesh = Mesh(image, UsualOptions(1.5), false).Mesh;
  PentatopeBounds bounds;
  bounds.Target = 0.5; // out of reach for most
  const PentatopeStatistics done = checks::OptimisePentatopes(mesh, domain, image, bounds, 1, {});
  EXPECT_GT(done.PoorAfter, 10000u);
  EXPECT_LT(done.InsertionsTried, 100u) << "of " << done.Insertions << " made";
}

TEST(PentatopeInsertion, MayLeaveFewerPentatopes)
{
  const std::string voxels = // 16 of each frame
    "0001111111111111"
    "0001000100011111"
    "0011001100110011"
    "0111011101110111"
    "0111011101110111"
    "1111111111111111"
    "0001111111111111";
  std::vector<std::uint8_t> labels(voxels.size());
  std::transform(voxels.begin(), voxels.end(), labels.begin(),
    [](char c) { return static_cast<std::uint8_t>(c - '0'); });
  const double step = 4.6004168467952447;
  const auto image = LabelImage<4>::FromScalars<std::uint8_t>(
    labels, GridGeometry<4>::Orthogonal({ 4, 2, 2, 7 }, { 1.0, 1.0, 1.0, step }));
  MeshingOptions<4> options;
  options.Optimisation.Run = true;
  options.SmoothingSigma = 0.86067485254147424;
  options.Planes.Times = { 2.0858202825744367 * step };
  options.Planes.Periodic = true;
  options.Components.Smallest = 1;
  options.Components.Exact = true;
  options.Interfaces.Rounds = 4;
  options.Interfaces.Fit = true;
  options.Sampling.Grading.Mode = GradingMode::LocalFeatureSize;
  options.Sampling.Grading.Ratio = 3.1846078395545083;
  options.Sampling.Grading.Lambda = 22.898033687866945;
  options.SpaceTime.Slivers.Fight = false;
  for (const double delta : { 5.764, 5.768, 5.772 })
  {
    if (Sanitized && delta != 5.768)
    {
      continue;
    }
    options.Sampling.Delta = delta;
    ExpectSound(MeshOf(image, options));
  }
}

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Changes of a mesh lose no component that is guarded.
#include "ComplexOf.h"
#include "Domain/ImageDomain.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Optimisation/ComponentGuard.h"
#include "Optimisation/Patch.h"
#include "Optimisation/Tetrahedra/MeshOptimiser.h"
#include "Phantoms.h"
#include "Quality/LostComponents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

using namespace voxplex;

namespace
{

template <int D>
std::vector<std::uint8_t> HoldersIn(
  ComponentGuard<D>& guard, const SimplexMesh<D>& mesh, unsigned threads)
{
  return guard.FindHolders(checks::ComplexOf<D>(mesh).Elements(), threads);
}

/** Noise, smoothed a little, in classes: many small components of each. */
LabelImage<3> Noise(unsigned seed)
{
  std::mt19937 random(seed);
  constexpr std::int64_t N = 28;
  std::vector<int> noise(N * N * N);
  std::generate(noise.begin(), noise.end(), [&] { return static_cast<int>(random() % 100); });
  std::vector<std::int16_t> scalars;
  for (std::int64_t v = 0; v < N * N * N; ++v)
  {
    const std::array<std::int64_t, 3> at = { v % N, v / N % N, v / N / N };
    const bool isInside =
      std::all_of(at.begin(), at.end(), [](std::int64_t x) { return x > 1 && x < N - 2; });
    int sum = 0;
    for (std::int64_t k = 0; k < 8 && isInside; ++k)
    {
      sum += noise[v + k % 2 + N * (k / 2 % 2) + N * N * (k / 4)];
    }
    scalars.push_back(static_cast<std::int16_t>(isInside ? std::clamp((sum - 280) / 40, 0, 4) : 0));
  }
  return LabelImage<3>::FromScalars<std::int16_t>(scalars, phantoms::Cube(N));
}

SimplexMesh<3> Unoptimised(const LabelImage<3>& image, double delta)
{
  MeshingOptions<3> options = checks::WithDelta<3>(delta);
  options.Components.Smallest = 2;
  options.Optimisation.Run = false;
  return checks::MeshOf(image, options);
}

/** A small simplex around a point. */
template <int D>
std::array<Point<D>, D + 1> Around(const Point<D>& centre, double size)
{
  std::array<Point<D>, D + 1> corners;
  corners.fill(centre);
  for (std::size_t a = 0; a < D; ++a)
  {
    corners[0][a] -= size;
    corners[a + 1][a] += size;
  }
  return corners;
}

template <int D>
typename ComponentGuard<D>::Corners PointersTo(const std::array<Point<D>, D + 1>& points)
{
  typename ComponentGuard<D>::Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    corners[i] = &points[i];
  }
  return corners;
}

} // namespace

//------------------------------------------------------------------------------------------------
// Without the guard, optimisation loses some: otherwise this test could not fail.
TEST(ComponentGuard, OptimisationLosesNothing)
{
  std::size_t lostWithout = 0;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    const LabelImage<3> image = Noise(seed);
    const ImageDomain<3> domain(image, 1.0);
    const Components<3> components(image);
    const std::vector<bool> wanted = components.FindWanted(2);
    const auto lostIn = [&](const SimplexMesh<3>& mesh)
    { return FindLostComponents(components, image, mesh, wanted, 2); };
    for (const double delta : { 2.0, 3.0 })
    {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", delta " << delta);
      const SimplexMesh<3> before = Unoptimised(image, delta);
      OptimisationOptions options;
      options.SmallestDihedralAngle = 30.0; // much to try
      options.LargestDihedralAngle = 135.0;
      options.InterfaceTolerance = 0.5;
      SimplexMesh<3> mesh = before;
      const OptimisationStatistics without = checks::OptimiseMesh(mesh, domain, options, 2);
      lostWithout += lostIn(mesh).size() - lostIn(before).size();

      ComponentGuard<3> guard(image);
      guard.Add(components, wanted);
      options.Guard = &guard;
      mesh = before;
      const OptimisationStatistics with = checks::OptimiseMesh(mesh, domain, options, 2);
      EXPECT_EQ(lostIn(mesh), lostIn(before));
      EXPECT_LE(with.After.Poor, without.After.Poor + without.Before.Poor / 50);
      checks::ExpectSound(mesh);

      // Whatever the number of threads.
      SimplexMesh<3> again = before;
      checks::OptimiseMesh(again, domain, options, 5);
      checks::ExpectSame(again, mesh);
    }
  }
  EXPECT_GT(lostWithout, 3u);
}

//------------------------------------------------------------------------------------------------
TEST(ComponentGuard, NextHoldersAreNamed)
{
  std::vector<std::uint8_t> scalars(9 * 9 * 9, 0);
  scalars[4 + 9 * (4 + 9 * 4)] = 3; // one voxel
  scalars[8 + 9 * (4 + 9 * 4)] = 3; // another component
  const auto image = LabelImage<3>::FromScalars<std::uint8_t>(scalars, phantoms::Cube(9));
  const Components<3> components(image);
  ASSERT_EQ(components.All().size(), 2u);
  const LabelId label = components.All()[0].Label;
  const Point<3> centre = image.Grid().ToFrame({ 4.0, 4.0, 4.0 });
  const auto shifted = [&](double by) {
    return Around<3>({ centre[0] + by, centre[1], centre[2] }, 0.1);
  };

  SimplexMesh<3> mesh;
  for (const double by : { 0.0, 4.0 })
  {
    for (const Point<3>& p : shifted(by))
    {
      mesh.Points.push_back(p);
    }
    const auto first = static_cast<std::uint32_t>(mesh.Points.size() - 4);
    mesh.Simplices.push_back({ first, first + 1, first + 2, first + 3 });
    mesh.Labels.push_back(label);
  }
  ComponentGuard<3> guard(image);
  EXPECT_TRUE(HoldersIn(guard, mesh, 1).empty()) << "nothing is guarded";
  guard.Add(components, { true, false });
  EXPECT_EQ(HoldersIn(guard, mesh, 1), (std::vector<std::uint8_t>{ 1, 0 }));

  const auto before = shifted(0.0);
  const auto near = shifted(1.3); // within a voxel of it
  const auto far = shifted(1.7);
  EXPECT_TRUE(guard.Keeps(label, PointersTo<3>(before), PointersTo<3>(near)));
  EXPECT_FALSE(guard.Keeps(label, PointersTo<3>(before), PointersTo<3>(far)));
  EXPECT_TRUE(guard.Keeps(label, PointersTo<3>(far), PointersTo<3>(far))) << "it holds nothing";
  const std::array<ComponentGuard<3>::Corners, 3> after = { PointersTo<3>(far), PointersTo<3>(near),
    PointersTo<3>(before) };
  std::array<std::uint8_t, 3> areHolders{};
  EXPECT_TRUE(guard.Keeps(label, PointersTo<3>(before), after, areHolders));
  EXPECT_EQ(areHolders, (std::array<std::uint8_t, 3>{ 0, 1, 0 }));
}

//------------------------------------------------------------------------------------------------
// In 4D each frame has components of its own, and an element holds them at the times that it has.
TEST(ComponentGuard, FramesHaveTheirOwn)
{
  std::vector<std::uint8_t> scalars(7 * 7 * 7 * 3, 0);
  const std::size_t middle = 3 + 7 * (3 + 7 * 3);
  for (const std::size_t frame : { 0u, 1u, 2u })
  {
    scalars[middle + 7 * 7 * 7 * frame] = 1;
  }
  const auto image = LabelImage<4>::FromScalars<std::uint8_t>(
    scalars, GridGeometry<4>::Orthogonal({ 7, 7, 7, 3 }, { 1.0, 1.0, 1.0, 1.0 }));
  const Components<4> ofFrames(image, 1, {}, 3);
  ASSERT_EQ(ofFrames.All().size(), 3u);
  const LabelId label = ofFrames.All()[0].Label;
  const auto at = [&](double time, double size) {
    return Around<4>(image.Grid().ToFrame({ 3.0, 3.0, 3.0, time }), size);
  };

  SimplexMesh<4> mesh;
  for (const double time : { 0.1, 1.1, 2.1 })
  {
    for (const Point<4>& p : at(time, 0.4))
    {
      mesh.Points.push_back(p);
    }
    const auto first = static_cast<std::uint32_t>(mesh.Points.size() - 5);
    mesh.Simplices.push_back({ first, first + 1, first + 2, first + 3, first + 4 });
    mesh.Labels.push_back(1);
  }
  ComponentGuard<4> guard(image);
  guard.Add(ofFrames, { true, true, true });
  EXPECT_EQ(HoldersIn(guard, mesh, 2), (std::vector<std::uint8_t>{ 1, 1, 1 }));
  const auto before = at(1.1, 0.4);
  const auto reaches = at(1.3, 0.4); // still cut at frame 1
  const auto between = at(1.5, 0.2);
  EXPECT_TRUE(guard.Keeps(label, PointersTo<4>(before), PointersTo<4>(reaches)));
  EXPECT_FALSE(guard.Keeps(label, PointersTo<4>(before), PointersTo<4>(between)));
}

//------------------------------------------------------------------------------------------------
// Flips and insertions of pentatopes ask before they replace a holder.
TEST(ComponentGuard, PentatopesAreHandedOver)
{
  std::vector<std::uint8_t> scalars(9 * 9 * 9 * 9, 0);
  scalars[4 + 9 * (4 + 9 * (4 + 9 * 4))] = 1; // one voxel
  const auto image = LabelImage<4>::FromScalars<std::uint8_t>(
    scalars, GridGeometry<4>::Orthogonal({ 9, 9, 9, 9 }, { 1.0, 1.0, 1.0, 1.0 }));
  const Components<4> components(image);
  const Point<4> centre = image.Grid().ToFrame({ 4.0, 4.0, 4.0, 4.0 });
  SimplexMesh<4> mesh; // two pentatopes in the voxel and far away, and the points of others
  std::vector<PentatopeComplex::Vertices> corners;
  for (const double by : { 0.0, 3.0, 1.2, 2.5 })
  {
    const auto first = static_cast<std::uint32_t>(mesh.Points.size());
    corners.push_back({ first, first + 1, first + 2, first + 3, first + 4 });
    for (Point<4> p : Around<4>(centre, 0.1))
    {
      p[0] += by;
      mesh.Points.push_back(p);
    }
  }
  mesh.Simplices = { corners[0], corners[1] };
  mesh.Labels = { 1, 1 };

  ComponentGuard<4> guard(image);
  guard.Add(components, { true });
  PentatopeComplex complex = checks::ScoredComplexOf(mesh);
  complex.Protect(&guard);
  Patch patch(complex, {}, 0);
  patch.NeedSlots(2);
  EXPECT_TRUE(complex.IsHolder(0));
  EXPECT_FALSE(complex.IsHolder(1));
  const std::array<std::uint32_t, 1> holder = { 0 };
  const std::array<std::uint32_t, 1> other = { 1 };
  const std::array<NewCell<4>, 1> far = { NewCell<4>{ corners[3], 1 } };
  const std::array<NewCell<4>, 2> both = { far[0], NewCell<4>{ corners[2], 1 } };
  EXPECT_TRUE(patch.Replace(other, far));
  EXPECT_FALSE(patch.Replace(holder, far));
  EXPECT_TRUE(complex.IsHolder(0)) << "nothing has changed";
  ASSERT_TRUE(patch.Replace(holder, both)); // the first takes its place
  EXPECT_FALSE(complex.IsHolder(0));
  EXPECT_TRUE(complex.IsHolder(complex.Hosts[corners[2][0]]));
}

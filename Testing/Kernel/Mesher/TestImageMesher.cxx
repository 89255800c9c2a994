// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Whole meshes of phantoms: invariants, accuracy, sizes, options, cancelling.
#include "Base/Error.h"
#include "CallableSize.h"
#include "Domain/LabelField.h"
#include "Geometry/SimplexQuality.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Quality/MeshQuality.h"
#include "Sanitizers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <thread>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

SimplexMesh<3> Mesh(const LabelImage<3>& image, double delta)
{
  return MeshOf(image, WithDelta<3>(delta));
}

double ImageVolume(const LabelImage<3>& image)
{
  std::int64_t voxels = 0;
  for (std::size_t i = 1; i < image.Counts().size(); ++i)
  {
    voxels += image.Counts()[i];
  }
  return static_cast<double>(voxels) * image.Grid().VoxelVolume();
}

std::shared_ptr<SizeFunction<3>> Size(std::function<double(const Point<3>&, std::int64_t)> f)
{
  return std::make_shared<CallableSize>(std::move(f));
}

std::string RefusalOf(const LabelImage<3>& image, const MeshingOptions<3>& options)
{
  SimplexMesh<3> mesh;
  const std::string message = MessageOf<Error>([&] { ImageMesher<3>(options).Run(image, mesh); });
  EXPECT_TRUE(message.empty() || mesh.Simplices.empty());
  return message;
}

} // namespace

// The figures that are promised for a ball of radius 20 voxels.
TEST(ImageMesher, BallIsAccurate)
{
  const double radius = 20.0;
  const LabelImage<3> image = phantoms::Ball(radius);
  const SimplexMesh<3> mesh = Mesh(image, 2.0);
  ExpectGood(mesh);
  const double c = 0.5 * static_cast<double>(image.Grid().Dimensions[0] - 1);
  const Point<3> centre = { c, c, c };
  const std::set<std::uint32_t> onInterface = VerticesOfInterfaces(mesh);
  double normalError = 0.0;
  for (const auto& f : mesh.Facets)
  {
    const Point<3> n = NormalOf(mesh, f);
    Point<3> outwards;
    for (std::size_t k = 0; k < 3; ++k)
    {
      outwards[k] = (mesh.Points[f[0]][k] + mesh.Points[f[1]][k] + mesh.Points[f[2]][k]) / 3.0 - c;
    }
    const Point<3> x = checks::Cross(n, outwards);
    normalError += std::atan2(std::sqrt(Dot(x, x)), Dot(n, outwards)) * 180.0 / std::numbers::pi;
  }
  double distance = 0.0;
  for (const std::uint32_t v : onInterface)
  {
    distance += std::abs(Distance(mesh.Points[v], centre) - radius);
  }
  const double volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  distance /= static_cast<double>(onInterface.size());
  normalError /= static_cast<double>(mesh.Facets.size());
  RecordProperty("mean_distance_voxels", std::to_string(distance));
  RecordProperty("mean_normal_error_degrees", std::to_string(normalError));
  RecordProperty("volume_error", std::to_string(WholeVolume(mesh) / volume - 1.0));
  EXPECT_LE(distance, 0.08);
  EXPECT_LE(normalError, 5.0);
  EXPECT_NEAR(WholeVolume(mesh), volume, 0.01 * volume);
}

TEST(ImageMesher, VolumesAreThoseOfTheImage)
{
  struct Case
  {
    const char* Name;
    LabelImage<3> Image;
    double Delta;
    double Tolerance;
  };
  const auto flat = GridGeometry<3>::Orthogonal({ 60, 60, 20 }, { 0.3, 0.3, 1.0 });
  const auto ball = [](const Point<3>& p) -> std::int16_t {
    return Distance(p, { 9.0, 9.0, 9.5 }) < 7.0 ? 4 : 0;
  };
  const Case cases[] = { { "torus", phantoms::Torus(16.0, 6.0), 1.0, 0.03 },
    { "sheet of one voxel", phantoms::Sheet(20), 0.8, 0.01 },
    { "cut by the border", phantoms::CutBall(14), 1.5, 0.05 },
    { "anisotropic spacing", phantoms::Make(flat, ball), 0.8, 0.04 } };
  for (const Case& c : cases)
  {
    SCOPED_TRACE(c.Name);
    const SimplexMesh<3> mesh = Mesh(c.Image, c.Delta);
    ExpectGood(mesh);
    EXPECT_NEAR(WholeVolume(mesh), ImageVolume(c.Image), c.Tolerance * ImageVolume(c.Image));
    // Euler characteristic of the boundary: 0 with one handle, else 2.
    const std::size_t twice = &c == &cases[0] ? 0 : 4;
    EXPECT_EQ(2 * VerticesOfInterfaces(mesh).size(), mesh.Facets.size() + twice);
  }
}

TEST(ImageMesher, NestedBallsKeepTheirLabels)
{
  const LabelImage<3> image = phantoms::NestedBalls(18.0);
  const SimplexMesh<3> mesh = Mesh(image, 1.0);
  ExpectGood(mesh);
  const std::map<std::int64_t, double> volumes = Volumes(mesh);
  ASSERT_EQ(volumes.size(), 3u);
  for (std::size_t id = 1; id < 4; ++id)
  {
    const double voxels = static_cast<double>(image.Counts()[id]);
    EXPECT_NEAR(volumes.at(image.Values()[id]), voxels, 0.05 * voxels);
  }
  std::set<std::array<std::int64_t, 2>> pairs(mesh.FacetLabels.begin(), mesh.FacetLabels.end());
  EXPECT_EQ(pairs, (std::set<std::array<std::int64_t, 2>>{ { 7, 3 }, { 200, 7 }, { 200, 0 } }));
}

TEST(ImageMesher, TouchingLabelsShareTheirInterface)
{
  const LabelImage<3> image = phantoms::TouchingLabels(16);
  // The two labels are alike: their interface lies in the plane between them, except for a groove along its rim. There
  // background wins against each of the two alone.
  const LabelField<3> field(image, MeshingOptions<3>().SmoothingSigma);
  constexpr int samples = 480; // along each axis of the image's section
  constexpr double step = 23.0 / samples;
  double expected = 0.0;
  for (int j = 0; j < samples; ++j)
  {
    for (int k = 0; k < samples; ++k)
    {
      expected +=
        field.Label({ 11.5, (j + 0.5) * step, (k + 0.5) * step }) != 0 ? step * step : 0.0;
    }
  }
  for (const bool junctions : { false, true })
  {
    MeshingOptions<3> options = WithDelta<3>(1.0);
    options.Interfaces.SampleJunctions = junctions;
    const SimplexMesh<3> mesh = MeshOf(image, options);
    ExpectGood(mesh, 0.0);
    const std::map<std::int64_t, double> volumes = Volumes(mesh);
    EXPECT_NEAR(volumes.at(1), volumes.at(2), 0.02 * volumes.at(1));
    EXPECT_NEAR(WholeVolume(mesh), ImageVolume(image), 0.04 * ImageVolume(image));
    double area = 0.0;
    for (std::size_t k = 0; k < mesh.Facets.size(); ++k)
    {
      if (mesh.FacetLabels[k] == std::array<std::int64_t, 2>{ 2, 1 })
      {
        area += AreaOf(mesh, mesh.Facets[k]);
      }
    }
    if (junctions)
    {
      EXPECT_NEAR(area, expected, 0.015 * expected);
    }
    else // the groove is not followed
    {
      EXPECT_NEAR(area, 16.0 * 16.0, 0.08 * 16.0 * 16.0);
    }
  }
}

TEST(ImageMesher, SliversAreSplit)
{
  const std::array<LabelImage<3>, 3> images{ phantoms::NestedBalls(18.0),
    phantoms::TouchingLabels(16), phantoms::Torus(16.0, 6.0) };
  for (const LabelImage<3>& image : images)
  {
    MeshingOptions<3> options = WithDelta<3>(1.0);
    options.Shape.Slivers.Angle = 0.0;
    const SimplexMesh<3> with = MeshOf(image, options);
    options.Shape.Slivers.Angle = 9.0;
    for (const unsigned threads : { 1u, 4u })
    {
      options.Team.Threads = threads;
      const SimplexMesh<3> without = MeshOf(image, options);
      ExpectGood(without, &image == &images[1] ? 0.0 : 30.0);
      const MeshQuality before = MeasureQuality<3>(with, 2.0, 30.0, 1);
      const MeshQuality after = MeasureQuality<3>(without, 2.0, 30.0, 1);
      EXPECT_LT(before.MinimumDihedralAngle, 3.0) << "no test";
      EXPECT_GT(after.MinimumDihedralAngle, 4.6);
      EXPECT_LT(after.MaximumDihedralAngle, 171.0);
      EXPECT_LT(without.Simplices.size(), 1.3 * static_cast<double>(with.Simplices.size()));
      EXPECT_NEAR(WholeVolume(without), WholeVolume(with), 0.01 * WholeVolume(with));
    }
  }
}

namespace
{

/** How many elements have their smallest dihedral angle between two bounds, in degrees. */
std::size_t CountSlivers(const SimplexMesh<3>& mesh, double low, double high)
{
  return static_cast<std::size_t>(std::count_if(mesh.Simplices.begin(), mesh.Simplices.end(),
    [&](const auto& simplex)
    {
      std::array<const Point<3>*, 4> points;
      std::transform(simplex.begin(), simplex.end(), points.begin(),
        [&](std::uint32_t v) { return &mesh.Points[v]; });
      const double sine = SmallestDihedralSine(points.data());
      const double angle = std::asin(sine) * 180.0 / std::numbers::pi;
      return angle >= low && angle < high;
    }));
}

} // namespace

// Blocks of labels at random.
TEST(ImageMesher, SliversInsideAreLeftToOptimisation)
{
  std::mt19937 random(3);
  std::array<std::int16_t, 1000> labels;
  for (std::int16_t& label : labels)
  {
    label = static_cast<std::int16_t>(random() % 8);
  }
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(40),
    [&](const Point<3>& p)
    {
      const auto block = [&](std::size_t a)
      { return static_cast<std::size_t>(std::clamp(p[a] / 4.0, 0.0, 9.0)); };
      return labels[block(0) + 10 * (block(1) + 10 * block(2))];
    });
  MeshingOptions<3> options = WithDelta<3>(3.0);
  const SimplexMesh<3> all = MeshOf(image, options);
  options.Shape.Slivers.AngleInside = 3.0;
  const SimplexMesh<3> some = MeshOf(image, options);
  EXPECT_LT(some.Simplices.size(), 0.95 * static_cast<double>(all.Simplices.size()));
  EXPECT_LE(CountSlivers(all, 0.0, 9.0), 20u);
  EXPECT_LE(CountSlivers(some, 0.0, 3.0), 20u);
  EXPECT_GT(CountSlivers(some, 3.0, 9.0), 100u);
}

// Thin wavy sheets in balls: slivers with all vertices on the two sides of the sheet, none of whose facets nor of
// their neighbours' is an interface's, go by points of the interface beside them.
TEST(ImageMesher, SliversBetweenTwoSidesOfASheetAreSplit)
{
  std::uint64_t found = 0;
  std::uint64_t kept = 0;
  for (const unsigned seed : { 30u, 32u, 34u, 35u })
  {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high)
    { return std::uniform_real_distribution<>(low, high)(random); };
    Point<3> normal{ uniform(-1, 1), uniform(-1, 1), uniform(-1, 1) };
    const double length = std::sqrt(Dot(normal, normal));
    const double halfThickness = uniform(0.8, 2.5) * length;
    const double frequency = uniform(0.3, 0.6);
    const double amplitude = uniform(1, 4) * length;
    const LabelImage<3> image = phantoms::Make(phantoms::Cube(41),
      [&](const Point<3>& p) -> std::int16_t
      {
        const Point<3> d = Subtract(p, { 20.0, 20.0, 20.0 });
        const double height = Dot(d, normal) + amplitude * std::sin(frequency * d[1]);
        return Dot(d, d) >= 17.0 * 17.0 ? 0 : std::abs(height) < halfThickness ? 2 : 1;
      });
    for (const double delta : { 1.5, 2.0, 2.5 })
    {
      MeshingStatistics statistics;
      MeshOf(image, WithDelta<3>(delta), &statistics);
      found += statistics.Rules.SliversFound;
      kept += statistics.Rules.SliversKept;
    }
  }
  EXPECT_GT(found, 500u);
  EXPECT_LE(kept, 1u); // without those points 6
}

TEST(ImageMesher, SkewedAxesAreMeshedInRealLengths)
{
  GridGeometry<3> grid = phantoms::Cube(40);
  grid.IndexToFrame[0][1] = 0.4;
  grid.IndexToFrame[1][2] = -0.3;
  const Point<3> centre = grid.ToFrame({ 19.5, 19.5, 19.5 });
  const LabelImage<3> image = phantoms::Make(
    grid, [&](const Point<3>& p) -> std::int16_t { return Distance(p, centre) < 12.0 ? 1 : 0; });
  const SimplexMesh<3> mesh = Mesh(image, 1.6);
  ExpectGood(mesh);
  double farthest = 0.0;
  for (const auto& f : mesh.Facets)
  {
    farthest = std::max(farthest, std::abs(Distance(mesh.Points[f[0]], centre) - 12.0));
  }
  EXPECT_LT(farthest, 0.7);
}

TEST(ImageMesher, NoiseTerminates)
{
  std::mt19937 random(11);
  std::uniform_int_distribution<int> label(0, 5);
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(9),
    [&](const Point<3>&) -> std::int16_t { return static_cast<std::int16_t>(label(random)); });
  for (const double delta : { 0.3, 1.0, 3.0 })
  {
    const SimplexMesh<3> mesh = Mesh(image, delta);
    EXPECT_TRUE(Complaints(mesh).empty()) << "delta " << delta;
  }
}

TEST(ImageMesher, OneVoxelObject)
{
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(7),
    [](const Point<3>& p) -> std::int16_t {
      return p == Point<3>{ 3.0, 3.0, 3.0 } ? 9 : 0;
    });
  const SimplexMesh<3> mesh = Mesh(image, 0.3);
  ExpectGood(mesh);
  EXPECT_EQ(mesh.Labels.front(), 9);
}

TEST(ImageMesher, SizesBoundCircumradii)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<3> image = phantoms::NestedBalls(15.0);
  const std::size_t without = Mesh(image, 2.5).Simplices.size();
  MeshingOptions<3> options = WithDelta<3>(2.5);
  options.Sampling.Size = Size([](const Point<3>&, std::int64_t) { return 1.5; });
  SimplexMesh<3> mesh = MeshOf(image, options);
  ExpectGood(mesh);
  EXPECT_GT(mesh.Simplices.size(), 2 * without);
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    ASSERT_LT(Circumradius(mesh, t), 1.5 + 1e-9);
  }

  options.Sampling.Size = Size([](const Point<3>&, std::int64_t label)
    { return label == 7 ? 1.0 : std::numeric_limits<double>::quiet_NaN(); });
  mesh = MeshOf(image, options);
  ExpectGood(mesh);
  double largestOther = 0.0;
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    const double radius = Circumradius(mesh, t);
    if (mesh.Labels[t] == 7)
    {
      ASSERT_LT(radius, 1.0 + 1e-9);
    }
    else
    {
      largestOther = std::max(largestOther, radius);
    }
  }
  EXPECT_GT(largestOther, 1.5);
}

TEST(ImageMesher, TinySizesAreRaisedToTheFloor)
{
  MeshingOptions<3> options = WithDelta<3>(4.0);
  options.Sampling.Size =
    Size([](const Point<3>& p, std::int64_t) { return p[0] < 6.0 ? 1e-12 : 0.0; });
  ExpectSound(MeshOf(phantoms::Ball(4.0), options));
}

// Beside a ball there are a speck, which is noise, and a voxel of a label that delta is too large for.
TEST(ImageMesher, StatisticsSayWhatTheMeshHasAndLacks)
{
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(32),
    [](const Point<3>& p) -> std::int16_t
    {
      const bool isBall = Distance2(p, Point<3>{ 14.0, 14.0, 14.0 }) < 100.0;
      const bool isSpeck = Distance2(p, Point<3>{ 28.0, 28.0, 28.0 }) < 1.5;
      const bool isVoxel = Distance2(p, Point<3>{ 2.0, 28.0, 2.0 }) < 0.5;
      return static_cast<std::int16_t>(isBall || isSpeck ? 3 : isVoxel ? 7 : 0);
    });
  MeshingOptions<3> options = WithDelta<3>(6.0);
  options.Components.Smallest = 0;
  options.Interfaces.Rounds = 0;
  ImageMesher<3> mesher(options);
  SimplexMesh<3> mesh;
  mesher.Run(image, mesh);
  EXPECT_TRUE(mesher.Statistics().DroppedComponents.empty());
  EXPECT_EQ(mesher.Statistics().LostLabels, std::vector<std::int64_t>{ 7 });
  EXPECT_FALSE(mesher.Statistics().HasQuality);

  options.SmallestVolume = 10.0;
  options.MeasureQuality = true;
  mesher = ImageMesher<3>(options);
  mesher.Run(image, mesh);
  const MeshingStatistics& statistics = mesher.Statistics();
  ASSERT_EQ(statistics.DroppedComponents.size(), 2u);
  EXPECT_EQ(statistics.DroppedComponents[0].Label, 7);
  EXPECT_EQ(statistics.DroppedComponents[1].Voxels, 7);
  EXPECT_TRUE(statistics.LostLabels.empty()) << "what was left out on request is not lost";
  EXPECT_EQ(statistics.Elements, mesh.Simplices.size());
  EXPECT_EQ(statistics.Vertices, mesh.Points.size());
  EXPECT_EQ(statistics.InterfaceFacets, mesh.Facets.size());
  ASSERT_TRUE(statistics.HasQuality);
  EXPECT_NEAR(statistics.Quality.Labels.at(0).Volume, WholeVolume(mesh), 1e-6);
  EXPECT_EQ(image.Counts()[2], 1) << "the image of the caller stays";
}

TEST(ImageMesher, TwoMeshesAtOnce)
{
  const LabelImage<3> large = phantoms::Ball(600.0, 50.0);
  const SimplexMesh<3> expectedSmall = Mesh(phantoms::Ball(0.06, 0.01), 0.02);
  const SimplexMesh<3> expectedLarge = Mesh(large, 100.0);
  SimplexMesh<3> a;
  SimplexMesh<3> b;
  std::thread first([&] { a = Mesh(phantoms::Ball(0.06, 0.01), 0.02); });
  std::thread second([&] { b = Mesh(large, 100.0); });
  first.join();
  second.join();
  EXPECT_EQ(a.Points, expectedSmall.Points);
  EXPECT_EQ(b.Points, expectedLarge.Points);
}

TEST(ImageMesher, DefaultDeltaFollowsTheSpacing)
{
  ImageMesher<3> mesher{ MeshingOptions<3>() };
  SimplexMesh<3> mesh;
  mesher.Run(phantoms::Ball(3.0, 0.5), mesh);
  EXPECT_DOUBLE_EQ(mesher.Statistics().Delta, 1.0);
  EXPECT_DOUBLE_EQ(
    DefaultDelta<3>(GridGeometry<3>::Orthogonal({ 2, 2, 2 }, { 0.5, 1.0, 2.0 }).VoxelVolume()),
    2.0);
}

TEST(ImageMesher, BadOptionsSaySo)
{
  const LabelImage<3> image = phantoms::Ball(5.0);
  for (const double delta :
    { -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
  {
    EXPECT_NE(RefusalOf(image, WithDelta<3>(delta)).find("delta"), std::string::npos) << delta;
  }
  MeshingOptions<3> options;
  options.Shape.RadiusEdgeRatio = 1.5;
  EXPECT_NE(RefusalOf(image, options).find("1.93"), std::string::npos);
  options.Limits.Force = true;
  EXPECT_EQ(RefusalOf(image, options), "");
  options = MeshingOptions<3>();
  options.Shape.FacetAngle = 31.0;
  EXPECT_NE(RefusalOf(image, options).find("facet angle"), std::string::npos);
  options = MeshingOptions<3>();
  options.SmoothingSigma = -1.0;
  EXPECT_NE(RefusalOf(image, options), "");
}

TEST(ImageMesher, MeshesThatDoNotFitAreRefusedWithTheEstimate)
{
  const LabelImage<3> image = phantoms::Ball(10.0);
  MeshingOptions<3> options = WithDelta<3>(1e-4);
  const std::string message = RefusalOf(image, options);
  EXPECT_NE(message.find("GiB"), std::string::npos) << message;
  EXPECT_NE(message.find("elements"), std::string::npos) << message;
  options.Sampling.Delta = 1.0;
  options.Limits.Memory = 1000;
  EXPECT_NE(RefusalOf(image, options).find("larger delta"), std::string::npos);
  options.Limits.Force = true;
  EXPECT_EQ(RefusalOf(image, options), "");
}

// What is thinner than delta is refined far below it: the sheet, of one voxel, with a delta of 2 by a factor of three.
TEST(ImageMesher, EstimateIsOfTheRightOrder)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  struct Phantom
  {
    const char* Name;
    LabelImage<3> Image;
    double LargestDelta;
  };
  const Phantom all[] = { { "ball", phantoms::Ball(20.0), 4.0 },
    { "nested balls", phantoms::NestedBalls(20.0), 4.0 },
    { "touching labels", phantoms::TouchingLabels(20), 4.0 },
    { "cut ball", phantoms::CutBall(20), 4.0 }, { "sheet", phantoms::Sheet(30), 1.0 } };
  for (const Phantom& phantom : all)
  {
    for (double delta = 1.0; delta <= phantom.LargestDelta; delta *= 2.0)
    {
      for (const double size : { 0.0, delta })
      {
        MeshingOptions<3> options = WithDelta<3>(delta);
        if (size > 0.0)
        {
          options.Sampling.Size = Size([=](const Point<3>&, std::int64_t) { return size; });
        }
        MeshingStatistics statistics;
        const SimplexMesh<3> mesh = MeshOf(phantom.Image, options, &statistics);
        const double ratio = static_cast<double>(statistics.EstimatedElements) /
          static_cast<double>(mesh.Simplices.size());
        EXPECT_GT(ratio, 0.65) << phantom.Name << ", delta " << delta << ", size " << size;
        EXPECT_LT(ratio, 1.65) << phantom.Name << ", delta " << delta << ", size " << size;
      }
    }
  }
}

TEST(ImageMesher, CancellingAtOnceDoesNotWaitForThePreparation)
{
  // Noise and the widest smoothing: a label field that takes far longer than the first report.
  std::mt19937 random(12);
  std::uniform_int_distribution<int> label(0, 5);
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(100),
    [&](const Point<3>&) -> std::int16_t { return static_cast<std::int16_t>(label(random)); });
  for (const unsigned threads : { 1u, 4u })
  {
    MeshingOptions<3> options;
    options.SmoothingSigma = LabelField<3>::MaximumSigma;
    options.Team.Threads = threads;
    ImageMesher<3> mesher(options);
    int calls = 0;
    mesher.Progress = [&](double)
    {
      ++calls;
      return false;
    };
    SimplexMesh<3> mesh;
    EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Cancelled);
    EXPECT_EQ(calls, 1); // who has cancelled is not asked again
    EXPECT_TRUE(mesh.Simplices.empty());
    EXPECT_EQ(mesher.Statistics().LabelFieldBytes, 0u); // the preparation was not finished
  }
}

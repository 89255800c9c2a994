// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Space-time meshes that conform to time planes, and periodic ones.
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "CallableSize.h"
#include "Phantoms.h"
#include "Sanitizers.h"
#include "SlabChecks.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

struct Result
{
  SimplexMesh<4> Mesh;
  MeshingStatistics Statistics;
};

template <template <int> class Image>
Result RunOf(const Image<4>& image, const MeshingOptions<4>& options)
{
  Result result;
  result.Mesh = checks::MeshOf(image, options, &result.Statistics);
  return result;
}

using Voxel = GridGeometry<4>::Index;

/** Background, except some voxels with the labels 1, 2 and so on in turn, at most `labels`. */
LabelImage<4> ImageOfVoxels(
  const GridGeometry<4>& grid, const std::vector<Voxel>& voxels, std::size_t labels)
{
  std::vector<std::uint8_t> values(CountCells(grid.Dimensions), 0);
  for (std::size_t k = 0; k < voxels.size(); ++k)
  {
    values[OffsetOf(voxels[k], grid.Dimensions)] = static_cast<std::uint8_t>(k % labels + 1);
  }
  return LabelImage<4>::FromScalars<std::uint8_t>(values, grid);
}

/** Everything on that users get. */
MeshingOptions<4> WithPlanes(double delta, std::vector<double> times, unsigned threads = 1)
{
  MeshingOptions<4> options = WithDelta<4>(delta);
  options.Optimisation.Run = true;
  options.Team.Threads = threads;
  options.Planes.Times = std::move(times);
  return options;
}

void ExpectSlabs(const Result& result, double first, double last)
{
  const SimplexMesh<4>& mesh = result.Mesh;
  const std::vector<double>& times = result.Statistics.Planes.Times;
  ASSERT_EQ(mesh.Slabs.size(), mesh.Simplices.size());
  ExpectSound(mesh);
  std::size_t pentatopes = 0;
  for (std::uint32_t slab = 0; slab <= times.size(); ++slab)
  {
    SCOPED_TRACE("slab " + std::to_string(slab));
    const SlabReport report = CheckSlab(
      mesh, slab, slab == 0 ? first : times[slab - 1], slab == times.size() ? last : times[slab]);
    EXPECT_TRUE(report.Complaints.empty()) << report.Complaints.front();
    EXPECT_GT(report.Pentatopes, 0u);
    pentatopes += report.Pentatopes;
  }
  EXPECT_EQ(pentatopes, mesh.Simplices.size());
  for (const double time : times)
  {
    const auto before = FacetsAt(mesh, time, -1);
    EXPECT_FALSE(before.empty());
    EXPECT_TRUE(before == FacetsAt(mesh, time, 1)) << "plane at " << time;
  }
}

void ExpectPeriod(const Result& result, double first, double last)
{
  const SimplexMesh<4>& mesh = result.Mesh;
  const auto start = FacetsAt(mesh, first, 1);
  EXPECT_FALSE(start.empty());
  EXPECT_TRUE(start == FacetsAt(mesh, last, -1));
  std::map<std::array<double, 3>, std::uint32_t> at;
  std::size_t ends = 0;
  for (std::uint32_t v = 0; v < mesh.Points.size(); ++v)
  {
    const Point<4>& p = mesh.Points[v];
    if (p[3] == first)
    {
      at[{ p[0], p[1], p[2] }] = v;
    }
  }
  for (std::uint32_t v = 0; v < mesh.Points.size(); ++v)
  {
    const Point<4>& p = mesh.Points[v];
    if (p[3] == last && at.contains({ p[0], p[1], p[2] }))
    {
      const std::array<std::uint32_t, 2> pair = { at.at({ p[0], p[1], p[2] }), v };
      EXPECT_TRUE(std::binary_search(mesh.Twins.begin(), mesh.Twins.end(), pair));
      ++ends;
    }
  }
  EXPECT_GT(ends, 0u);
  EXPECT_EQ(ends, mesh.Twins.size());
}

} // namespace

TEST(TimePlanes, SlabsMatchOnPlanes)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(17, 1.0));
  for (const unsigned threads : { 1u, 2u })
  {
    for (const bool isRaw : { false, true })
    {
      if (Sanitized && isRaw == (threads == 2))
      {
        continue;
      }
      SCOPED_TRACE(std::to_string(threads) + (isRaw ? " threads, as refined" : " threads"));
      MeshingOptions<4> options = WithPlanes(2.0, { 11.0, 5.3, 0.0, 8.0, 16.0, 8.0 }, threads);
      options.Optimisation.Run = !isRaw;
      options.Interfaces.Fit = !isRaw;
      const Result result = RunOf(image, options);
      EXPECT_EQ(result.Statistics.Planes.Times, (std::vector<double>{ 5.3, 8.0, 11.0 }));
      EXPECT_TRUE(result.Mesh.Twins.empty());
      ExpectSlabs(result, 0.0, 16.0);
      // Seen: 2 to 3 of some 2,000 facets on planes.
      EXPECT_LT(result.Statistics.Planes.Relabelled, result.Statistics.Planes.Facets / 50);
      EXPECT_EQ(result.Statistics.Planes.Refused, 0u);
    }
  }
}

// A frame of the object is cut by each plane; facets there are inside of the object, and no interfaces.
TEST(TimePlanes, VolumesAndShapesAreThoseOfAMeshWithoutPlanes)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<4> image = ImageOf(phantoms::MergingBalls());
  const Result with = RunOf(image, WithPlanes(2.0, { 4.0, 8.0, 12.0 }));
  const Result without = RunOf(image, WithPlanes(2.0, {}));
  ExpectSlabs(with, 0.0, 16.0);
  EXPECT_TRUE(without.Mesh.Slabs.empty());
  const auto expected = Hypervolumes(image);
  const auto volumes = Volumes(with.Mesh);
  for (const std::int64_t label : { 1, 2 })
  {
    EXPECT_NEAR(volumes.at(label), expected.at(label), 0.02 * expected.at(label));
  }
  for (std::size_t f = 0; f < with.Mesh.Facets.size(); ++f)
  {
    const auto& facet = with.Mesh.Facets[f];
    const double time = with.Mesh.Points[facet[0]][3];
    const bool isFlat = std::all_of(
      facet.begin(), facet.end(), [&](std::uint32_t v) { return with.Mesh.Points[v][3] == time; });
    EXPECT_FALSE(isFlat && time > 0.0 && time < 16.0) << "an interface lies in a plane";
  }
  // Seen: 27,672 with planes, 27,435 without.
  EXPECT_LT(with.Mesh.Simplices.size(), 1.1 * static_cast<double>(without.Mesh.Simplices.size()));
  for (std::size_t s = 0; s < with.Mesh.Simplices.size(); ++s)
  {
    ASSERT_LT(RadiusEdge(with.Mesh, s), 2.0 + 1e-9);
  }
  EXPECT_GE(with.Statistics.Optimisation.SmallestVolumeAfter, 0.01);
  EXPECT_TRUE(with.Statistics.Components.Lost.empty());
  EXPECT_TRUE(with.Statistics.FrameComponents.Lost.empty());
}

// Motion of several voxels a frame: frames are added between frames. Thin slabs.
TEST(TimePlanes, EveryFrameOfAFastBall)
{
  const LabelImage<4> image = ImageOf(phantoms::WithTimeScale(phantoms::FastBall(7), 4.0));
  std::vector<double> frames;
  for (std::int64_t k = 0; k < image.Grid().Dimensions[3]; ++k)
  {
    frames.push_back(static_cast<double>(k) * image.Grid().IndexToFrame[3][3]);
  }
  const Result result = RunOf(image, WithPlanes(0.9 * frames[1], frames));
  EXPECT_EQ(result.Statistics.Planes.Times.size(), frames.size() - 2);
  ExpectSlabs(result, frames.front(), frames.back());
}

// So few rounds that planes are closed while slabs still ask for points. Slabs match all the same.
TEST(TimePlanes, ClosedPlanesRefusePointsAndMatch)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(17, 1.0, 2.5));
  for (const bool isPeriodic : { false, true })
  {
    for (const unsigned rounds : { 1u, 2u, 8u })
    {
      if (Sanitized && (rounds == 2) == isPeriodic)
      {
        continue;
      }
      SCOPED_TRACE(std::to_string(rounds) + (isPeriodic ? " rounds, a period" : " rounds"));
      MeshingOptions<4> options = WithPlanes(2.0, { 3.0, 5.5, 8.0, 11.0 });
      options.Planes.Periodic = isPeriodic;
      options.Planes.OpenRounds = rounds;
      const Result result = RunOf(image, options);
      const TimePlaneStatistics& planes = result.Statistics.Planes;
      ExpectSlabs(result, 0.0, 16.0);
      EXPECT_LE(planes.Rounds, rounds + 2);
      EXPECT_EQ(planes.Refused > 0, rounds < 8) << planes.Rounds << " rounds";
      if (isPeriodic)
      {
        ExpectPeriod(result, 0.0, 16.0);
      }
    }
  }
}

// Single voxels that come and go. A pentatope beside a plane gets the label of the plane, which is not that of its
// circumcentre for many of them here; the rules must know.
TEST(TimePlanes, PentatopesBesidePlanesKeepTheBoundsOfTheLabelThatTheyGet)
{
  const LabelImage<4> image =
    ImageOfVoxels(GridGeometry<4>::Orthogonal({ 3, 6, 2, 4 }, { 1.0, 1.0, 1.0, 3.0 }),
      { { 2, 2, 0, 0 }, { 2, 5, 0, 0 }, { 2, 1, 0, 1 }, { 1, 5, 0, 2 }, { 2, 2, 0, 3 },
        { 2, 5, 0, 3 } },
      1);
  MeshingOptions<4> options = WithPlanes(0.75, {});
  options.Planes.Periodic = true;
  options.Optimisation.Run = false;
  options.Interfaces.Fit = false;
  options.Interfaces.Manifold = false;
  options.SpaceTime.Slivers.Fight = false;
  options.Sampling.InterfaceSizes = { { 1, 0, 2.0 } };
  const Result result = RunOf(image, options);
  EXPECT_GT(result.Statistics.Planes.Relabelled, 0u);
  for (std::size_t s = 0; s < result.Mesh.Simplices.size(); ++s)
  {
    ASSERT_LT(RadiusEdge(result.Mesh, s), 2.0 + 1e-9);
  }
}

// The vertices of their facets are on interfaces, too. Otherwise vertices of the background come into the mesh.
TEST(TimePlanes, FacetsOfPentatopesBesidePlanesAreSampled)
{
  const std::vector<float> noise = { -0.206680313f, 0.620040953f, -0.9300614f, 1.6534425f,
    0.413360626f, 1.4467622f, 0.9300614f, -0.9300614f, -0.826721251f, 0.620040953f, 0.620040953f,
    0.826721251f, 1.13674176f, 0.723381102f, 0.310020477f, 0.620040953f, 0.413360626f,
    -0.723381102f, -0.103340156f, 0.206680313f, 0.310020477f, -0.620040953f, -1.13674176f,
    0.9300614f, 0.0f, -0.413360626f, 0.103340156f, -0.413360626f, -0.826721251f, 1.4467622f,
    0.413360626f, 0.826721251f, 0.206680313f, 0.9300614f, -1.03340161f, -1.8601228f, 0.516700804f,
    -1.6534425f, -0.826721251f, -0.206680313f, 0.620040953f, -0.103340156f, -0.826721251f,
    0.310020477f, 0.620040953f, -0.723381102f, 1.96346295f, -0.413360626f, 1.13674176f,
    0.413360626f, 0.826721251f, 0.723381102f, -0.206680313f, -1.4467622f, -1.03340161f,
    0.516700804f, 1.24008191f, 0.310020477f, -0.9300614f, 1.24008191f, 0.620040953f, 0.206680313f,
    0.206680313f, -1.4467622f, -0.206680313f, 0.516700804f, 0.0f, -0.206680313f, 0.723381102f,
    0.206680313f, -0.310020477f, -0.103340156f, 0.310020477f, -0.620040953f, -0.413360626f,
    1.13674176f, -1.8601228f, -1.03340161f, -0.9300614f, -0.310020477f, -0.413360626f, 0.826721251f,
    -0.413360626f, 0.103340156f };
  const GridGeometry<4> grid =
    GridGeometry<4>::Orthogonal({ 3, 2, 2, 7 }, { 1.0, 1.0, 1.0, 1.5165657989938228 });
  Isosurface surface;
  surface.Inside = IsosurfaceSide::Below;
  const auto image = IsosurfaceImage<4>::FromScalars(std::span<const float>(noise), grid, surface);
  MeshingOptions<4> options = WithPlanes(1.1060022271093888, { 1.5165657989938228 });
  options.Optimisation.Run = false;
  options.Interfaces.Fit = false;
  options.Interfaces.Manifold = false;
  options.Interfaces.Rounds = 0;
  options.Components.Smallest = 0;
  options.SpaceTime.Slivers.Fight = false;
  options.SpaceTime.Order = RuleOrder::SurfaceFirst;
  const Result result = RunOf(image, options);
  EXPECT_GT(result.Statistics.Planes.Relabelled, 0u);
  for (const Point<4>& p : result.Mesh.Points)
  {
    EXPECT_TRUE(
      p[0] > -1.0 && p[0] < 3.0 && p[1] > -1.0 && p[1] < 2.0 && p[2] > -1.0 && p[2] < 2.0);
  }
}

// The object begins and ends within the image, so the first and the last slab have one flat end each, and are flat.
TEST(TimePlanes, AFlatSlabAtTheBeginningTakesFewPoints)
{
  GridGeometry<4> grid = GridGeometry<4>::Orthogonal({ 3, 2, 7, 8 }, { 1.0, 1.0, 1.0, 0.4622 });
  grid.IndexToFrame[0][1] = -0.507;
  grid.IndexToFrame[0][2] = -0.027;
  grid.IndexToFrame[1][2] = -0.585;
  const LabelImage<4> image = ImageOfVoxels(grid, { { 0, 0, 4, 5 }, { 2, 0, 6, 6 } }, 2);
  std::vector<double> frames;
  for (int k = 0; k < 8; ++k)
  {
    frames.push_back(0.4622 * k);
  }
  MeshingOptions<4> options = WithPlanes(0.3039, frames);
  options.SmoothingSigma = 0.4229;
  options.Shape.RadiusEdgeRatio = 2.28;
  options.SpaceTime.Slivers.Fight = false;
  const Result result = RunOf(image, options);
  EXPECT_FALSE(result.Mesh.Simplices.empty());
  EXPECT_LT(result.Statistics.Rules.Insertions(), 3000u);
  EXPECT_TRUE(result.Statistics.RelaxedRegions.empty());
}

// A circumcentre lay 1e-14 inside of a face of the box. Rounding made the balls of the flat pentatopes beside it meet the
// interface, and the ball rule covered the face: 6,775 points.
TEST(TimePlanes, PointsNextToAFaceOfTheBoxAreMovedOntoIt)
{
  const double voxel = 20.535581761938751;
  const double frame = 1360.4283379679866;
  const LabelImage<4> image =
    ImageOfVoxels(GridGeometry<4>::Orthogonal({ 6, 3, 8, 2 }, { voxel, voxel, voxel, frame }),
      { { 0, 0, 6, 0 }, { 0, 0, 6, 1 } }, 1);
  MeshingOptions<4> options = WithPlanes(0.0, {});
  options.Planes.Periodic = true;
  options.SmoothingSigma = 0.0;
  options.Sampling.Size = std::make_shared<CallableSizeOf<4>>(
    [](const Point<4>&, std::int64_t) { return 45.419866406846104; });
  options.Shape.RadiusEdgeRatio = 3.632;
  options.Interfaces.Fit = false;
  const Result result = RunOf(image, options);
  EXPECT_FALSE(result.Mesh.Simplices.empty());
  EXPECT_LT(result.Statistics.Rules.Insertions(), 1000u);
  EXPECT_TRUE(result.Statistics.RelaxedRegions.empty());
}

// The closest point of an interface lay on a plane, and was one bit beside it. Its pentatopes had no volume.
TEST(TimePlanes, FeaturePointsOnPlanesAreExactlyThere)
{
  const double frame = 0.43664573019466985;
  const GridGeometry<4> grid = GridGeometry<4>::Orthogonal(
    { 8, 4, 2, 5 }, { 1.1908350403630583, 1.3419092246714037, 1.3803457941103172, frame });
  std::vector<std::uint8_t> values(8 * 4 * 2 * 5, 0);
  const std::vector<std::array<std::size_t, 5>> voxels = { { 0, 0, 0, 0, 1 }, { 7, 2, 0, 0, 1 },
    { 7, 1, 0, 1, 1 }, { 7, 0, 0, 2, 1 }, { 1, 0, 0, 3, 2 }, { 0, 0, 0, 4, 2 }, { 0, 1, 1, 4, 2 } };
  for (const auto& v : voxels)
  {
    values[v[0] + 8 * (v[1] + 4 * (v[2] + 2 * v[3]))] = static_cast<std::uint8_t>(v[4]);
  }
  MeshingOptions<4> options = WithPlanes(0.36515245651547584, { 0.0, frame, 3.0 * frame });
  options.SmoothingSigma = 1.4580878140394968;
  options.FrameSteps = 3;
  options.Sampling.Size =
    std::make_shared<CallableSizeOf<4>>([](const Point<4>& p, std::int64_t label)
      { return label == 2 ? 3.7737989278716904 + 0.44577933495228039 * std::abs(p[0]) : 0.0; });
  const Result result = RunOf(LabelImage<4>::FromScalars<std::uint8_t>(values, grid), options);
  ASSERT_FALSE(result.Mesh.Simplices.empty());
  for (const Point<4>& p : result.Mesh.Points)
  {
    for (const double time : result.Statistics.Planes.Times)
    {
      EXPECT_TRUE(p[3] == time || std::abs(p[3] - time) > 1e-9) << p[3] - time;
    }
  }
}

TEST(TimePlanes, BothEndsOfAPeriodAreCongruent)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  // Begins and ends with motion, so both ends are equal only if the smoothing wraps.
  const LabelImage<4> image = ImageOf(PulsatingBalls(17, 1.0, 2.5));
  for (const unsigned threads : { 1u, 2u })
  {
    for (const bool hasPlanes : { false, true })
    {
      if (Sanitized && hasPlanes != (threads == 2))
      {
        continue;
      }
      SCOPED_TRACE(std::to_string(threads) + (hasPlanes ? " threads, planes" : " threads"));
      MeshingOptions<4> options = WithPlanes(
        2.0, hasPlanes ? std::vector<double>{ 5.0, 9.5 } : std::vector<double>(), threads);
      options.Planes.Periodic = true;
      const Result result = RunOf(image, options);
      EXPECT_EQ(result.Statistics.Planes.Times,
        (hasPlanes ? std::vector<double>{ 5.0, 9.5 } : std::vector<double>{ 8.0 }));
      ExpectSlabs(result, 0.0, 16.0);
      ExpectPeriod(result, 0.0, 16.0);
      EXPECT_EQ(result.Statistics.Planes.Pairs, result.Mesh.Twins.size());
    }
  }
}

TEST(TimePlanes, SmoothingWrapsAtTheEndsOfAPeriod)
{
  // The radius is the same in the first and in the last frame, but grows after the first one.
  LabelImage<4> image = ImageOf(PulsatingBalls(9, 1.0, 3.0));
  const auto countChanges = [](const LabelImage<4>& of)
  {
    const ImageDomain<4> domain(of, 1.0);
    std::size_t changes = 0;
    for (double x = 1.05; x < 22.0; x += 0.31)
    {
      for (double y = 1.05; y < 22.0; y += 0.31)
      {
        changes += domain.Label({ x, y, 11.5, 0.0 }) != domain.Label({ x, y, 11.5, 8.0 }) ? 1 : 0;
      }
    }
    return changes;
  };
  EXPECT_GT(countChanges(image), 0u) << "this image shows nothing";
  image.MakePeriodicInTime();
  EXPECT_EQ(countChanges(image), 0u);
}

TEST(TimePlanes, OneThreadGivesTheSameMeshAgain)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(17, 1.0));
  MeshingOptions<4> options = WithPlanes(2.5, { 8.0 });
  options.Planes.Periodic = true;
  const Result first = RunOf(image, options);
  const Result second = RunOf(image, options);
  EXPECT_TRUE(first.Mesh.Points == second.Mesh.Points);
  EXPECT_TRUE(first.Mesh.Simplices == second.Mesh.Simplices);
  EXPECT_TRUE(first.Mesh.Twins == second.Mesh.Twins);
}

namespace
{

/** Values of a ball that moves around a circle once, in 17 frames; the last is the first one. */
std::vector<float> CirclingBall(const GridGeometry<4>& grid)
{
  const double last = static_cast<double>(grid.Dimensions[3] - 1);
  return phantoms::Sample<float>(grid,
    [last](const Point<4>& p)
    {
      const double phase = 2.0 * std::numbers::pi * std::fmod(p[3], last) / last;
      return 7.0 -
        std::hypot(
          p[0] - 12.0 - 2.5 * std::cos(phase), p[1] - 12.0 - 2.5 * std::sin(phase), p[2] - 12.0);
    });
}

} // namespace

TEST(TimePlanes, IsosurfacesHavePeriods)
{
  const auto grid = GridGeometry<4>::Orthogonal({ 25, 25, 25, 17 }, { 1.0, 1.0, 1.0, 1.0 });
  std::vector<float> values = CirclingBall(grid);
  MeshingOptions<4> options = WithPlanes(2.0, {});
  options.Planes.Periodic = true;
  for (const double sigma : { 0.0, 1.0 })
  {
    SCOPED_TRACE(sigma);
    Isosurface surface;
    surface.SmoothingSigma = sigma;
    surface.PeriodicInTime = true;
    const auto image = IsosurfaceImage<4>::FromScalars<float>(values, grid, surface);
    const Result result = RunOf(image, options);
    ExpectSlabs(result, 0.0, 16.0);
    ExpectPeriod(result, 0.0, 16.0);
    const double expected = 16.0 * 4.0 / 3.0 * std::numbers::pi * 343.0;
    EXPECT_NEAR(Volumes(result.Mesh).at(1), expected, 0.015 * expected);
    EXPECT_EQ(result.Statistics.Planes.Refused, 0u);
  }

  const auto refusal = [&](bool isPeriodic)
  {
    return MessageOf(
      [&]
      {
        Isosurface surface;
        surface.PeriodicInTime = isPeriodic;
        const auto image = IsosurfaceImage<4>::FromScalars<float>(values, grid, surface);
        SimplexMesh<4> mesh;
        ImageMesher<4>(options).Run(image, mesh);
      });
  };
  EXPECT_NE(refusal(false).find("an image that was made to be periodic"), std::string::npos);
  values[(24 * 25 + 3) * 25 + 2] += 1.0f;
  EXPECT_NE(
    refusal(true).find("they differ in 1 voxels, one of which is (2, 3, 24)"), std::string::npos)
    << refusal(true);
}

// Values that only wrap make both ends equal: they change before the last frame, but not after the first one.
TEST(TimePlanes, ValuesWrapAtTheEndsOfAPeriod)
{
  const auto grid = GridGeometry<4>::Orthogonal({ 25, 25, 25, 17 }, { 1.0, 1.0, 1.0, 1.0 });
  const std::vector<float> values = CirclingBall(grid);
  for (const bool isPeriodic : { true, false })
  {
    Isosurface surface;
    surface.SmoothingSigma = 1.0;
    surface.PeriodicInTime = isPeriodic;
    const auto image = IsosurfaceImage<4>::FromScalars<float>(values, grid, surface);
    std::size_t differ = 0;
    std::vector<float> first(25);
    std::vector<float> last(25);
    for (std::int64_t y = 0; y < 25; ++y)
    {
      for (std::int64_t z = 0; z < 25; ++z)
      {
        image.ReadMargins({ 0, y, z, 0 }, 25, first.data());
        image.ReadMargins({ 0, y, z, 16 }, 25, last.data());
        differ += first != last ? 1 : 0;
      }
    }
    EXPECT_EQ(differ > 0, !isPeriodic);
  }
}

TEST(TimePlanes, RefusesWhatCannotBe)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(17, 1.0));
  const auto messageOf = [](const LabelImage<4>& of, const MeshingOptions<4>& options)
  {
    SimplexMesh<4> mesh;
    return MessageOf([&] { ImageMesher<4>(options).Run(of, mesh); });
  };
  const auto expect = [&](const MeshingOptions<4>& options, const std::string& part)
  {
    const std::string message = messageOf(image, options);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect(WithPlanes(2.0, { 17.0 }),
    "at 17 is not between the first frame, at 0, and the last one, at 16");
  expect(WithPlanes(2.0, { -1.0 }), "at -1 is not between");
  expect(WithPlanes(2.0, { nan }), "is not between");
  expect(WithPlanes(2.0, { 8.0, 9.0 }), "a slab of 1 is thinner than delta, which is 2");
  expect(WithPlanes(2.0, { 15.0 }), "a slab of 1 is thinner than delta, which is 2");

  MeshingOptions<4> options = WithPlanes(2.0, {});
  options.Planes.Periodic = true;
  const std::string message = messageOf(
    ImageOf({ image.Grid(),
      [](const Point<4>& p) -> std::uint8_t {
        return Distance(p, { 11.5, 11.5, 11.5, 0.0 }) < 8.0 + (p[3] > 0.0 ? 0.5 * p[3] : 0.0);
      } }),
    options);
  EXPECT_NE(
    message.find("a last frame that is equal to the first one; they differ in"), std::string::npos)
    << message;
}

TEST(TimePlanes, TheUnionOfSlabsCountsInTheMemoryThatIsEstimated)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(17, 1.0));
  const auto isRefused = [&](const MeshingOptions<4>& from, std::uint64_t limit)
  {
    MeshingOptions<4> options = from;
    options.Limits.Memory = limit;
    ImageMesher<4> mesher(options);
    mesher.Progress = [](double fraction) { return fraction < 0.25; }; // after the estimate
    SimplexMesh<4> mesh;
    return MessageOf<TooLargeError>([&] { mesher.Run(image, mesh); }) != "";
  };
  std::uint64_t enough = 1u << 20; // for a mesh without planes, and just so
  while (isRefused(WithPlanes(2.5, {}), enough))
  {
    enough += enough / 8;
  }
  EXPECT_TRUE(isRefused(WithPlanes(2.5, { 8.0 }), enough));
  EXPECT_FALSE(isRefused(WithPlanes(2.5, { 8.0 }), 2 * enough));
}

TEST(TimePlanes, CancelStopsARun)
{
  const LabelImage<4> image = ImageOf(PulsatingBalls(17, 1.0));
  ImageMesher<4> mesher(WithPlanes(0.7, { 8.0 }));
  double reached = 0.0;
  mesher.Progress = [&reached](double fraction)
  {
    EXPECT_GE(fraction, reached);
    reached = fraction;
    return fraction < 0.3;
  };
  SimplexMesh<4> mesh;
  EXPECT_EQ(mesher.Run(image, mesh), MeshingOutcome::Cancelled);
  EXPECT_TRUE(mesh.Simplices.empty());
}

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Connected components against a flood fill, bounds of delta, and that no component is lost.
#include "Base/Error.h"
#include "ComplexOf.h"
#include "Conformity/ComponentCheck.h"
#include "Domain/ImageDomain.h"
#include "Image/Components.h"
#include "Image/DropComponents.h"
#include "Mesh/MeshElements.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Mesher/ImageMesher.h"
#include "Phantoms.h"
#include "Quality/LostComponents.h"
#include "Sizing/LocalDelta.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

using namespace voxplex;

namespace
{

template <int D>
using IndexOf = typename GridGeometry<D>::Index;

template <int D>
std::size_t Flat(const IndexOf<D>& n, const IndexOf<D>& index)
{
  std::size_t at = 0;
  for (std::size_t a = D; a-- > 0;)
  {
    at = at * static_cast<std::size_t>(n[a]) + static_cast<std::size_t>(index[a]);
  }
  return at;
}

template <int D>
IndexOf<D> Unflat(const IndexOf<D>& n, std::size_t at)
{
  IndexOf<D> index;
  for (std::size_t a = 0; a < D; ++a)
  {
    index[a] = static_cast<std::int64_t>(at % static_cast<std::size_t>(n[a]));
    at /= static_cast<std::size_t>(n[a]);
  }
  return index;
}

/** Components by flood fill, numbered by their first voxels; calls faces(voxel, axis) for every face. */
template <int D, typename Faces>
std::vector<std::uint32_t> FloodFill(const LabelImage<D>& image, Faces&& face)
{
  const IndexOf<D>& n = image.CropDimensions();
  const auto ids = image.Ids();
  std::vector<std::uint32_t> component(ids.size(), Components<D>::None);
  std::uint32_t count = 0;
  for (std::size_t start = 0; start < ids.size(); ++start)
  {
    if (ids[start] == 0 || component[start] != Components<D>::None)
    {
      continue;
    }
    std::vector<std::size_t> stack{ start };
    component[start] = count;
    while (!stack.empty())
    {
      const std::size_t at = stack.back();
      stack.pop_back();
      for (std::size_t a = 0; a < D; ++a)
      {
        for (const int step : { -1, 1 })
        {
          IndexOf<D> next = Unflat<D>(n, at);
          next[a] += step;
          const bool inside = next[a] >= 0 && next[a] < n[a];
          if (!inside || ids[Flat<D>(n, next)] != ids[at])
          {
            face(count, a);
          }
          else if (component[Flat<D>(n, next)] == Components<D>::None)
          {
            component[Flat<D>(n, next)] = count;
            stack.push_back(Flat<D>(n, next));
          }
        }
      }
    }
    ++count;
  }
  return component;
}

template <int D>
LabelImage<D> RandomImage(const GridGeometry<D>& grid, int labels, unsigned seed)
{
  std::mt19937 random(seed);
  std::size_t size = 1;
  for (const std::int64_t n : grid.Dimensions)
  {
    size *= static_cast<std::size_t>(n);
  }
  std::vector<std::uint8_t> scalars(size);
  for (std::uint8_t& s : scalars)
  {
    s = static_cast<std::uint8_t>(random() % static_cast<unsigned>(labels + 1));
  }
  scalars[0] = 1;
  scalars[size - 1] = 1;
  return LabelImage<D>::template FromScalars<std::uint8_t>(scalars, grid);
}

/** The area of a voxel's face across each axis, from the steps along the other two. */
std::array<double, 3> FaceAreas(const GridGeometry<3>& grid)
{
  std::array<Point<3>, 3> steps;
  for (std::size_t c = 0; c < 3; ++c)
  {
    steps[c] = { grid.IndexToFrame[0][c], grid.IndexToFrame[1][c], grid.IndexToFrame[2][c] };
  }
  std::array<double, 3> areas;
  for (std::size_t a = 0; a < 3; ++a)
  {
    const Point<3> x = checks::Cross(steps[(a + 1) % 3], steps[(a + 2) % 3]);
    areas[a] = std::sqrt(Dot(x, x));
  }
  return areas;
}

template <int D>
void ExpectComponentsOfFloodFill(const LabelImage<D>& image, const std::array<double, D>& areas)
{
  std::vector<double> surface(image.Ids().size(), 0.0);
  const std::vector<std::uint32_t> expected =
    FloodFill(image, [&](std::uint32_t c, std::size_t axis) { surface[c] += areas[axis]; });
  for (const unsigned threads : { 1u, 3u })
  {
    const Components<D> components(image, threads);
    std::vector<std::int64_t> voxels(components.All().size(), 0);
    for (std::size_t at = 0; at < expected.size(); ++at)
    {
      const IndexOf<D> index = Unflat<D>(image.CropDimensions(), at);
      ASSERT_EQ(components.At(index), expected[at]) << at;
      if (expected[at] != Components<D>::None)
      {
        if (voxels[expected[at]]++ == 0)
        {
          EXPECT_EQ(components.All()[expected[at]].First, index);
        }
        EXPECT_EQ(components.All()[expected[at]].Label, image.Ids()[at]);
      }
    }
    for (std::uint32_t c = 0; c < voxels.size(); ++c)
    {
      const Component<D>& component = components.All()[c];
      EXPECT_EQ(component.Voxels, voxels[c]);
      EXPECT_NEAR(component.Surface, surface[c], 1e-9 * surface[c]);
      std::int64_t inRuns = 0;
      components.ForEachRun(c,
        [&](const IndexOf<D>& first, std::int64_t length)
        {
          inRuns += length;
          IndexOf<D> last = first;
          last[0] += length - 1;
          EXPECT_EQ(components.At(first), c);
          EXPECT_EQ(components.At(last), c);
        });
      EXPECT_EQ(inRuns, voxels[c]);
    }
    EXPECT_EQ(std::accumulate(voxels.begin(), voxels.end(), std::int64_t{ 0 }),
      static_cast<std::int64_t>(expected.size()) -
        std::count(expected.begin(), expected.end(), Components<D>::None));
  }
}

SimplexMesh<3> Mesh(
  const LabelImage<3>& image, const MeshingOptions<3>& options, MeshingStatistics& statistics)
{
  const SimplexMesh<3> mesh = checks::MeshOf(image, options, &statistics);
  checks::ExpectSound(mesh);
  std::size_t aboveBound = 0;
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    aboveBound += checks::RadiusEdge(mesh, t) < 2.0 + 1e-9 ? 0 : 1;
  }
  EXPECT_LE(aboveBound, 10 * statistics.Interfaces.NonManifoldOpened); // only pieces may be
  return mesh;
}

/** How many of the centres have an element of the label that contains them or is within the distance. */
std::size_t CountFound(const SimplexMesh<3>& mesh, const std::vector<Point<3>>& centres,
  std::int64_t label, double distance)
{
  std::size_t found = 0;
  for (const Point<3>& centre : centres)
  {
    for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
    {
      Point<3> centroid{};
      for (const std::uint32_t v : mesh.Simplices[t])
      {
        for (std::size_t a = 0; a < 3; ++a)
        {
          centroid[a] += 0.25 * mesh.Points[v][a];
        }
      }
      if (mesh.Labels[t] == label && Distance(centroid, centre) < distance)
      {
        ++found;
        break;
      }
    }
  }
  return found;
}

/** Cubes of label 2 with this side, 12 apart, in a block of label 1. */
struct Islands
{
  explicit Islands(std::int64_t side, const Point<3>& spacing = { 1.0, 1.0, 1.0 })
    : Image(LabelImage<3>::FromScalars<std::uint8_t>(
        std::vector<std::uint8_t>{ 1, 1, 1, 1, 1, 1, 1, 1 }, phantoms::Cube(2)))
  {
    const std::int64_t n = 40;
    const auto grid = GridGeometry<3>::Orthogonal({ n, n, n }, spacing);
    const auto island = [=](std::int64_t i) { return i % 12 >= 6 && i % 12 < 6 + side; };
    const auto outside = [=](std::int64_t x) { return x < 2 || x >= n - 2; };
    this->Image = phantoms::OfVoxels(grid,
      [&](const auto& v)
      {
        return std::any_of(v.begin(), v.end(), outside) ? 0
          : std::all_of(v.begin(), v.end(), island)     ? 2
                                                        : 1;
      });
    for (const std::int64_t k : { 6, 18, 30 })
    {
      for (const std::int64_t j : { 6, 18, 30 })
      {
        for (const std::int64_t i : { 6, 18, 30 })
        {
          const double half = 0.5 * static_cast<double>(side - 1);
          this->Centres.push_back(grid.ToFrame({ static_cast<double>(i) + half,
            static_cast<double>(j) + half, static_cast<double>(k) + half }));
        }
      }
    }
  }

  LabelImage<3> Image;
  std::vector<Point<3>> Centres;
};

/** Flat voxels of a block, in columns of one to three, get another label, or background. */
LabelImage<3> SpeckledBlock(unsigned seed)
{
  std::mt19937 random(seed);
  constexpr std::int64_t N = 12;
  std::vector<std::int16_t> scalars(N * N * N, 0);
  const auto at = [&](std::int64_t x, std::int64_t y, std::int64_t z) -> std::int16_t&
  { return scalars[static_cast<std::size_t>((z * N + y) * N + x)]; };
  const unsigned labels = 2 + random() % 3;
  for (std::int64_t k = 0; k < (N - 2) * (N - 2) * (N - 2); ++k)
  {
    at(1 + k % (N - 2), 1 + k / (N - 2) % (N - 2), 1 + k / (N - 2) / (N - 2)) = 1;
  }
  const auto inside = [&] { return 1 + static_cast<std::int64_t>(random() % (N - 2)); };
  for (int column = 0; column < 172; ++column)
  {
    const std::int64_t x = inside();
    const std::int64_t y = inside();
    const std::int64_t z = inside();
    const auto label = static_cast<std::int16_t>(random() % (labels + 1));
    const auto last = std::min(z + static_cast<std::int64_t>(random() % 3), N - 2);
    for (std::int64_t k = z; k <= last; ++k)
    {
      at(x, y, k) = label;
    }
  }
  return LabelImage<3>::FromScalars<std::int16_t>(
    scalars, GridGeometry<3>::Orthogonal({ N, N, N }, { 1.0, 1.0, 3.0 }));
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(Components, AreThoseOfAFloodFill)
{
  GridGeometry<3> skewed = GridGeometry<3>::Orthogonal({ 23, 17, 13 }, { 0.5, 1.0, 2.0 });
  skewed.IndexToFrame[0][1] = 0.3;
  skewed.IndexToFrame[0][2] = -0.7;
  skewed.IndexToFrame[1][2] = 0.4;
  for (const int labels : { 1, 2, 5 })
  {
    ExpectComponentsOfFloodFill<3>(
      RandomImage(skewed, labels, static_cast<unsigned>(labels)), FaceAreas(skewed));
  }
  const auto grid = GridGeometry<4>::Orthogonal({ 7, 6, 5, 9 }, { 1.0, 2.0, 3.0, 0.5 });
  ExpectComponentsOfFloodFill<4>(RandomImage(grid, 2, 7), { 3.0, 1.5, 1.0, 6.0 });
}

//------------------------------------------------------------------------------------------------
// Rows enough for several slabs, and components that wind through all of them.
TEST(Components, JoinAcrossSlabs)
{
  const auto grid = GridGeometry<3>::Orthogonal({ 9, 64, 48 }, { 1.0, 1.0, 1.0 });
  ExpectComponentsOfFloodFill<3>(RandomImage(grid, 1, 3), { 1.0, 1.0, 1.0 });
  const auto comb = phantoms::Make(grid,
    [](const Point<3>& p) -> std::int16_t { return p[2] > 46.5 || std::fmod(p[1], 2.0) < 0.5; });
  EXPECT_EQ(Components<3>(comb, 4).All().size(), 1u);
}

//------------------------------------------------------------------------------------------------
TEST(Components, BeyondTheCropThereIsNone)
{
  const LabelImage<3> image = phantoms::Ball(3.0);
  const Components<3> components(image);
  ASSERT_EQ(components.All().size(), 1u);
  const auto& n = image.CropDimensions();
  EXPECT_EQ(components.At({ -1, n[1] / 2, n[2] / 2 }), Components<3>::None);
  EXPECT_EQ(components.At({ n[0], n[1] / 2, n[2] / 2 }), Components<3>::None);
  EXPECT_EQ(components.At({ n[0] / 2, n[1] / 2, n[2] / 2 }), 0u);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(Components<3>(image, 1, stop.get_token()), Cancelled);
}

//------------------------------------------------------------------------------------------------
TEST(DropComponents, SpecksBecomeWhatIsAroundThem)
{
  // 2 in 1; two voxels of 3 and 4 that touch each other in the background; 5 is large.
  const auto speck = [](const Point<3>& p, double x, double y, double z) {
    return Distance(p, { x, y, z }) < 0.5;
  };
  LabelImage<3> image = phantoms::Make(phantoms::Cube(16, 0.5),
    [&](const Point<3>& p) -> std::int16_t
    {
      const double z = p[2];
      return speck(p, 3.0, 3.0, 3.0) ? 2
        : speck(p, 6.5, 6.5, 7.0)    ? 3
        : speck(p, 6.5, 6.5, 6.0)    ? 4
        : z < 0.6                    ? 5
        : z > 1.4 && z < 5.1         ? 1
                                     : 0;
    });
  const auto countOf = [&](std::int64_t value)
  {
    for (std::size_t id = 0; id < image.Values().size(); ++id)
    {
      if (image.Values()[id] == value)
      {
        return image.Counts()[id];
      }
    }
    return std::int64_t{ -1 };
  };
  const std::int64_t ones = countOf(1);
  const std::int64_t fives = countOf(5);
  EXPECT_TRUE(DropComponents(image, 0.0).empty());
  const std::vector<ComponentReport> dropped = DropComponents(image, 1.0, 3);
  ASSERT_EQ(dropped.size(), 3u);
  std::set<std::int64_t> labels;
  for (const ComponentReport& component : dropped)
  {
    labels.insert(component.Label);
    EXPECT_EQ(component.Voxels, 1);
    ASSERT_EQ(component.Voxel.size(), 3u);
  }
  EXPECT_EQ(labels, (std::set<std::int64_t>{ 2, 3, 4 }));
  EXPECT_EQ(dropped[0].Voxel, (std::vector<std::int64_t>{ 6, 6, 6 }));
  EXPECT_EQ(countOf(1), ones + 1);
  EXPECT_EQ(countOf(5), fives);
  for (const std::int64_t value : { 2, 3, 4 })
  {
    EXPECT_EQ(countOf(value), 0);
  }
  const Components<3> left(image);
  EXPECT_EQ(left.All().size(), 2u);
}

//------------------------------------------------------------------------------------------------
// A thin plate of 2 between two plates of 1: it becomes 1 first, the others background, and then it is a
// speck of 1 that must go, too.
TEST(DropComponents, WhatTouchesOtherSpecksGoesInTheEnd)
{
  LabelImage<3> image = phantoms::Make(phantoms::Cube(12),
    [](const Point<3>& p) -> std::int16_t
    {
      const auto within = [](double x, double low, double high) { return x >= low && x <= high; };
      if (p[2] > 9.5)
      {
        return 3;
      }
      if (!within(p[0], 2, 4) || !within(p[1], 2, 4) || !within(p[2], 2, 6))
      {
        return 0;
      }
      return p[2] == 4.0 ? 2 : 1;
    });
  EXPECT_EQ(DropComponents(image, 40.0).size(), 4u);
  EXPECT_EQ(image.Counts()[1], 0);
  EXPECT_EQ(image.Counts()[2], 0);
  EXPECT_EQ(image.Counts()[3], 288);
}

//------------------------------------------------------------------------------------------------
TEST(DropComponents, SomethingMustBeLeft)
{
  LabelImage<3> image = phantoms::Ball(3.0);
  EXPECT_THROW(DropComponents(image, 1000.0), InputError);
}

//------------------------------------------------------------------------------------------------
TEST(ComponentCheck, KeepsIslandsThatAreSmallBesideDelta)
{
  const Islands islands(2);
  for (const unsigned threads : { 1u, 4u })
  {
    MeshingOptions<3> options = checks::WithDelta<3>(5.0);
    options.Team.Threads = threads;
    options.Team.Reproducible =
      threads > 1; // else numbers of seeds and elements vary from run to run
    options.Components.Smallest = 0;
    MeshingStatistics statistics;
    EXPECT_LT(CountFound(Mesh(islands.Image, options, statistics), islands.Centres, 2, 1.5), 27u);

    options.Components.Smallest = 8;
    const SimplexMesh<3> few = Mesh(islands.Image, options, statistics);
    EXPECT_EQ(CountFound(few, islands.Centres, 2, 1.5), 27u);
    EXPECT_EQ(statistics.Components.Found, 28u);
    EXPECT_LE(statistics.Components.Seeds, 27u * 48u) << "on all faces, twice";
    EXPECT_GE(statistics.Components.Rounds, 1u);
    EXPECT_TRUE(statistics.Components.Lost.empty());

    options.Components.Exact = true;
    const SimplexMesh<3> exact = Mesh(islands.Image, options, statistics);
    EXPECT_EQ(CountFound(exact, islands.Centres, 2, 1.5), 27u);
    EXPECT_GT(statistics.Components.Seeds, 27u * 8u);
    EXPECT_EQ(statistics.Components.Rounds, 0u);
    EXPECT_TRUE(statistics.Components.Lost.empty());
    EXPECT_LT(few.Simplices.size(), exact.Simplices.size());
  }
}

//------------------------------------------------------------------------------------------------
TEST(ComponentCheck, LeavesSmallerOnesAlone)
{
  const Islands islands(2);
  MeshingOptions<3> options = checks::WithDelta<3>(5.0);
  options.Components.Smallest = 9;
  options.Components.Exact = true;
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = Mesh(islands.Image, options, statistics);
  EXPECT_LT(CountFound(mesh, islands.Centres, 2, 1.5), 27u);
  EXPECT_EQ(statistics.Components.Seeds, 24u)
    << "on one island, the first of the largest of its label";
  EXPECT_TRUE(statistics.Components.Lost.empty());
  options.Components.Smallest = 0;
  Mesh(islands.Image, options, statistics);
  EXPECT_EQ(statistics.Components.Found, 0u);
}

//------------------------------------------------------------------------------------------------
TEST(ComponentCheck, KeepsSingleVoxelsIfAsked)
{
  for (const Point<3>& spacing : { Point<3>{ 1.0, 1.0, 1.0 }, Point<3>{ 0.3, 0.3, 1.0 } })
  {
    const Islands islands(1, spacing);
    MeshingOptions<3> options = checks::WithDelta<3>(3.0);
    options.Components.Smallest = 1;
    MeshingStatistics statistics;
    const SimplexMesh<3> mesh = Mesh(islands.Image, options, statistics);
    EXPECT_EQ(CountFound(mesh, islands.Centres, 2, 1.0), 27u);
    EXPECT_TRUE(statistics.Components.Lost.empty());
  }
}

//------------------------------------------------------------------------------------------------
TEST(ComponentCheck, KeepsASheetThatIsThinBesideDelta)
{
  MeshingOptions<3> options = checks::WithDelta<3>(6.0);
  MeshingStatistics statistics;
  const LabelImage<3> image = phantoms::Sheet(20);
  const SimplexMesh<3> mesh = Mesh(image, options, statistics);
  EXPECT_FALSE(mesh.Simplices.empty());
  EXPECT_TRUE(statistics.Components.Lost.empty());
}

//------------------------------------------------------------------------------------------------
// Single voxels next to each other, flat ones: the first guess does not do for all of them.
TEST(ComponentCheck, GoesOnUntilNothingIsLost)
{
  std::mt19937 random(5);
  const LabelImage<3> image =
    phantoms::Make(GridGeometry<3>::Orthogonal({ 24, 24, 12 }, { 0.3, 0.3, 1.0 }),
      [&](const Point<3>&) -> std::int16_t
      {
        const unsigned draw = static_cast<unsigned>(random() % 100);
        return draw < 5 ? 2 : draw < 8 ? 3 : 1;
      });
  for (const unsigned threads : { 1u, 4u })
  {
    MeshingOptions<3> options = checks::WithDelta<3>(3.0);
    options.Components.Smallest = 1;
    options.Team.Threads = threads;
    MeshingStatistics statistics;
    const SimplexMesh<3> mesh = Mesh(image, options, statistics);
    EXPECT_GE(statistics.Components.Rounds, 1u);
    EXPECT_TRUE(statistics.Components.Lost.empty());
    const ImageDomain<3> domain(image, 1.0);
    const Components<3> components(image);
    const SizingField<3> sizing(domain, { .Base = { 3.0 } });
    LocalDelta<3> local(image);
    LocalSampling<3> sampling(image, image, domain.GetSites(), domain, sizing, local, {});
    const ComponentCheck<3> check(
      image, components, sizing, 1, false, true, sampling, statistics.Components, 1, {});
    EXPECT_GT(components.All().size(), 100u);
    EXPECT_TRUE(check.FindLost(mesh).empty());
  }
}

//------------------------------------------------------------------------------------------------
// Repairs give tetrahedra away, at times the only ones of a component: two of these images showed it.
TEST(ComponentCheck, LooksAtRepairedInterfaces)
{
  for (const unsigned seed : { 9u, 19u })
  {
    const LabelImage<3> image = SpeckledBlock(seed);
    const Components<3> components(image);
    for (const double delta : { 1.5, 4.0 })
    {
      MeshingOptions<3> options = checks::WithDelta<3>(delta);
      options.Components.Smallest = 1;
      MeshingStatistics statistics;
      const SimplexMesh<3> mesh = Mesh(image, options, statistics);
      EXPECT_GT(statistics.Interfaces.NonManifoldRepaired, 0u);
      EXPECT_EQ(FindLostComponents(components, image, mesh, components.FindWanted(1), 1, {}).size(),
        statistics.Components.Lost.size());
    }
  }
}

//------------------------------------------------------------------------------------------------
TEST(ComponentCheck, SaysWhichComponentsHaveNoElement)
{
  const Islands islands(2);
  const ImageDomain<3> domain(islands.Image, 1.0);
  const Components<3> components(islands.Image);
  const SizingField<3> sizing(domain, { .Base = { 5.0 } });
  LocalDelta<3> local(islands.Image);
  ComponentStatistics counts;
  LocalSampling<3> sampling(
    islands.Image, islands.Image, domain.GetSites(), domain, sizing, local, {});
  ComponentCheck<3> check(
    islands.Image, components, sizing, 8, false, true, sampling, counts, 2, {});
  MeshingOptions<3> options = checks::WithDelta<3>(5.0);
  MeshingStatistics statistics;
  SimplexMesh<3> mesh = Mesh(islands.Image, options, statistics);
  EXPECT_TRUE(check.FindLost(mesh).empty());
  const auto island = static_cast<std::uint32_t>(
    std::find_if(components.All().begin(), components.All().end(),
      [&](const Component<3>& c)
      {
        return c.Voxels == 8 && c.First[0] + islands.Image.CropOrigin()[0] == 18 &&
          c.First[1] + islands.Image.CropOrigin()[1] == 18 &&
          c.First[2] + islands.Image.CropOrigin()[2] == 18;
      }) -
    components.All().begin());
  ASSERT_LT(island, components.All().size());
  std::vector<bool> wanted(components.All().size());
  wanted[island] = true;
  const auto witness = [&](unsigned threads)
  {
    const Complex<3> complex = checks::ComplexOf<3>(mesh, &domain);
    return FindFirstWitnesses(
      components, islands.Image, complex.Elements(), wanted, threads)[island];
  };
  ASSERT_NE(witness(1), None);
  EXPECT_EQ(witness(1), witness(3));
  EXPECT_EQ(mesh.Labels[witness(1)], 2);
  for (const std::uint32_t v : mesh.Simplices[witness(1)])
  {
    EXPECT_LT(Distance(mesh.Points[v], islands.Centres[13]), 3.0);
  }

  // Take the elements of the island around one centre away.
  const auto& all = components.All();
  for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
  {
    const Point<3>& p = mesh.Points[mesh.Simplices[t][0]];
    if (mesh.Labels[t] == 2 && Distance(p, islands.Centres[13]) < 3.0)
    {
      mesh.Labels[t] = 1;
    }
  }
  const std::vector<std::uint32_t> lost = check.FindLost(mesh);
  EXPECT_EQ(lost, std::vector<std::uint32_t>{ island });
  EXPECT_EQ(witness(1), None);
  EXPECT_EQ(all[lost[0]].Voxels, 8);
  for (std::size_t a = 0; a < 3; ++a) // indices of the crop, which begins at 2
  {
    EXPECT_EQ(all[lost[0]].First[a] + islands.Image.CropOrigin()[a], 18);
  }

  // The points on all faces, again and again, with smaller bounds.
  EXPECT_EQ(counts.Seeds, 0u);
  double smallest = local.Smallest();
  std::size_t before = 0;
  int rounds = 0;
  while (check.SampleFiner(lost))
  {
    const std::vector<FeatureSeed<3>> seeds = sampling.TakeSeeds();
    EXPECT_EQ(seeds.size(), 24u) << rounds;
    EXPECT_EQ(counts.Seeds, before += seeds.size());
    EXPECT_LT(local.Smallest(), smallest);
    smallest = local.Smallest();
    ASSERT_LT(++rounds, 10);
  }
  EXPECT_GE(rounds, 4);
  EXPECT_LT(local.Smallest(), 0.5) << "of a cube of two voxels";
  EXPECT_FALSE(check.SampleFiner({}));
}

//------------------------------------------------------------------------------------------------
// A mesh in which nothing is small is what it was without the check.
TEST(ComponentCheck, ChangesNothingWhereDeltaIsFineEnough)
{
  const LabelImage<3> image = phantoms::NestedBalls(18.0);
  MeshingOptions<3> options = checks::WithDelta<3>(1.0);
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = Mesh(image, options, statistics);
  EXPECT_EQ(statistics.Components.Found, 3u);
  EXPECT_EQ(statistics.Components.Seeds, 0u);
  options.Components.Smallest = 0;
  const SimplexMesh<3> without = Mesh(image, options, statistics);
  EXPECT_TRUE(std::equal(mesh.Points.begin(), mesh.Points.end(), without.Points.begin()));
  EXPECT_TRUE(std::equal(mesh.Simplices.begin(), mesh.Simplices.end(), without.Simplices.begin()));
}

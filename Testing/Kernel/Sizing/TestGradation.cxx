// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Sizes that are limited in their growth: against all pairs of samples, and in meshes.
#include "Base/Error.h"
#include "CallableSize.h"
#include "MeshChecks.h"
#include "Mesher/ImageMesher.h"
#include "Phantoms.h"
#include "Sanitizers.h"
#include "Sizing/GradedSize.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <random>

using namespace voxplex;

namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();

/** Anisotropic and oblique: the mesher's frame has an upper triangular matrix. */
GridGeometry<3> ObliqueGrid()
{
  GridGeometry<3> grid = GridGeometry<3>::Orthogonal({ 34, 20, 14 }, { 0.5, 1.0, 2.0 });
  grid.IndexToFrame[0][1] = 0.2;
  grid.IndexToFrame[0][2] = -0.5;
  grid.IndexToFrame[1][2] = 0.3;
  return grid;
}

/** A bent object: distances go straight through what is outside. */
std::int16_t Bent(const Point<3>& p)
{
  return std::hypot(p[0] - 8.0, p[1] - 3.0) > 5.0 && p[2] > 1.0 && p[2] < 25.0 ? 1 : 0;
}

/** Steps, spots of one voxel, nothing elsewhere. */
double Uneven(const Point<3>& p, std::int64_t)
{
  if (std::abs(p[0] - 3.0) < 0.3 && std::abs(p[1] - 12.0) < 0.6)
  {
    return 0.25;
  }
  return p[2] < 5.0 ? 1.0 + 0.05 * p[0] : p[1] > 15.0 ? 2.0 : Infinity;
}

struct Sample
{
  Point<3> Place;
  double Size;
};

/** All voxels of the object. */
std::vector<Sample> Samples(const LabelImage<3>& image, const SizeFunction<3>& size)
{
  std::vector<Sample> samples;
  const auto& n = image.CropDimensions();
  for (std::size_t v = 0; v < image.Ids().size(); ++v)
  {
    const auto i = static_cast<std::int64_t>(v);
    if (image.Ids()[v] != 0)
    {
      const Point<3> p =
        image.Grid().ToFrame({ static_cast<double>(i % n[0] + image.CropOrigin()[0]),
          static_cast<double>(i / n[0] % n[1] + image.CropOrigin()[1]),
          static_cast<double>(i / n[0] / n[1] + image.CropOrigin()[2]) });
      samples.push_back({ p, size.Evaluate(p, image.Values()[image.Ids()[v]]) });
    }
  }
  return samples;
}

double BruteForce(const std::vector<Sample>& samples, double gradation, const Point<3>& p)
{
  double least = Infinity;
  for (const Sample& sample : samples)
  {
    least = std::min(least, sample.Size + gradation * Distance(p, sample.Place));
  }
  return least;
}

/** The diagonal of a cell of two voxels, about; see GradedGrid. */
double CellDiagonal(const GridGeometry<3>& grid)
{
  return 2.0 * (grid.Spacing(0) + grid.Spacing(1) + grid.Spacing(2));
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(Gradation, IsTheLargestFunctionBelowThatGrowsSoSlowly)
{
  for (const bool oblique : { false, true })
  {
    const GridGeometry<3> grid =
      oblique ? ObliqueGrid() : GridGeometry<3>::Orthogonal({ 34, 20, 14 }, { 0.5, 1.0, 2.0 });
    const LabelImage<3> image = phantoms::Make(grid, Bent);
    const auto size = std::make_shared<CallableSize>(Uneven);
    const std::vector<Sample> samples = Samples(image, *size);
    for (const double gradation : { 0.1, 0.3, 1.0 })
    {
      const auto graded = GradedSize<3>::Limit(size, image, gradation, 1);
      ASSERT_NE(graded, size);
      const double tolerance = gradation * CellDiagonal(grid);
      double sum = 0.0;
      for (const Sample& sample : samples)
      {
        const double exact = BruteForce(samples, gradation, sample.Place);
        const double value = graded->Evaluate(sample.Place, 1);
        ASSERT_LE(value, sample.Size);
        ASSERT_NEAR(value, exact, tolerance);
        sum += std::abs(value - exact);
      }
      // Mostly far better than the bound: a tenth of it on average, with oblique axes a fifth.
      EXPECT_LT(sum / static_cast<double>(samples.size()), (oblique ? 0.2 : 0.1) * tolerance);
    }
  }
}

//------------------------------------------------------------------------------------------------
TEST(Gradation, BoundsTheSlopeBetweenAnyTwoPoints)
{
  const LabelImage<3> image = phantoms::Make(ObliqueGrid(), Bent);
  const auto size = std::make_shared<CallableSize>(Uneven);
  constexpr double gradation = 0.3;
  const auto graded = GradedSize<3>::Limit(size, image, gradation, 1);
  const std::vector<Sample> samples = Samples(image, *size);
  const double tolerance = gradation * CellDiagonal(image.Grid());
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, samples.size() - 1);
  double largest = 0.0; // excess without the limit: the check means something
  for (int i = 0; i < 20000; ++i)
  {
    const Sample& a = samples[any(random)];
    const Sample& b = samples[any(random)];
    const double change = graded->Evaluate(a.Place, 1) - graded->Evaluate(b.Place, 1);
    ASSERT_LE(std::abs(change), gradation * Distance(a.Place, b.Place) + tolerance);
    if (std::isfinite(a.Size) && std::isfinite(b.Size))
    {
      largest = std::max(
        largest, std::abs(a.Size - b.Size) - gradation * Distance(a.Place, b.Place) - tolerance);
    }
  }
  EXPECT_TRUE(largest > 0.0 ||
    std::any_of(
      samples.begin(), samples.end(), [](const Sample& s) { return std::isinf(s.Size); }));
}

//------------------------------------------------------------------------------------------------
TEST(Gradation, SmallCellsAreRightToRounding)
{
  // One small voxel in the middle: its cone is all there is.
  const LabelImage<3> image =
    phantoms::Make(phantoms::Cube(21), [](const Point<3>&) -> std::int16_t { return 1; });
  const Point<3> middle{ 10.0, 11.0, 9.0 };
  const auto size = std::make_shared<CallableSize>(
    [&](const Point<3>& p, std::int64_t) { return Distance(p, middle) < 0.1 ? 0.5 : 1e6; });
  const auto graded = GradedSize<3>::Limit(size, image, 0.25, 1);
  for (const Sample& sample : Samples(image, *size))
  {
    ASSERT_NEAR(
      graded->Evaluate(sample.Place, 1), 0.5 + 0.25 * Distance(sample.Place, middle), 1e-5);
  }
  EXPECT_NEAR(graded->Evaluate({ -100.0, 11.0, 9.0 }, 1), 0.5 + 0.25 * 110.0, 1e-4);
}

//------------------------------------------------------------------------------------------------
TEST(Gradation, LargeImagesHaveLargerCells)
{
  // More cells of two voxels than there may be: 261 x 261 x 131 / 8 > 2^20.
  const LabelImage<3> image =
    phantoms::Make(GridGeometry<3>::Orthogonal({ 261, 261, 131 }, { 1.0, 1.0, 1.0 }),
      [](const Point<3>& p) -> std::int16_t { return p[0] < 130.5 ? 1 : 2; });
  class Sizes final : public SizeFunction<3>
  {
  public:
    double Evaluate(const Point<3>&, std::int64_t label) const override
    {
      return label == 1 ? 1.0 : 50.0;
    }
    bool DependsOnLabelAlone() const override { return true; }
  };
  const auto graded = GradedSize<3>::Limit(std::make_shared<Sizes>(), image, 0.2, 0);
  for (double x = 0.0; x <= 260.0; x += 6.5)
  {
    const double exact = std::min(x < 130.5 ? 1.0 : 50.0, 1.0 + 0.2 * std::max(0.0, x - 130.0));
    EXPECT_NEAR(graded->Evaluate({ x, 100.0, 77.0 }, x < 130.5 ? 1 : 2), exact, 1e-4) << x;
  }
}

//------------------------------------------------------------------------------------------------
TEST(Gradation, LeavesAloneWhatNeedsNoLimit)
{
  const LabelImage<3> image = phantoms::NestedBalls(12.0);
  EXPECT_EQ(GradedSize<3>::Limit(nullptr, image, 0.3, 1), nullptr);
  const auto uneven = std::make_shared<CallableSize>(Uneven);
  EXPECT_EQ(GradedSize<3>::Limit(uneven, image, 0.0, 1), uneven);
  const auto nothing = std::make_shared<CallableSize>(
    [](const Point<3>&, std::int64_t) { return std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_EQ(GradedSize<3>::Limit(nothing, image, 0.3, 1), nothing);

  class Labels final : public SizeFunction<3>
  {
  public:
    explicit Labels(double ofSeven)
      : OfSeven(ofSeven)
    {
    }
    double Evaluate(const Point<3>&, std::int64_t label) const override
    {
      return label == 7 ? this->OfSeven : 2.0;
    }
    bool DependsOnLabelAlone() const override { return true; }

  private:
    double OfSeven;
  };
  const auto same = std::make_shared<Labels>(2.0);
  EXPECT_EQ(GradedSize<3>::Limit(same, image, 0.3, 1), same);
  for (const double ofSeven : { 1.0, 3.0, 0.0, Infinity }) // not positive: no bound there
  {
    const auto differ = std::make_shared<Labels>(ofSeven);
    EXPECT_NE(GradedSize<3>::Limit(differ, image, 0.3, 1), differ) << ofSeven;
  }
}

//------------------------------------------------------------------------------------------------
TEST(Gradation, DoesNotDependOnThreadsAndStops)
{
  const LabelImage<3> image = phantoms::NestedBalls(30.0);
  const auto size = std::make_shared<CallableSize>(
    [](const Point<3>& p, std::int64_t label) {
      return label == 3 ? 0.5 + 0.01 * p[0] : label == 7 ? 3.0 + std::sin(p[1]) : Infinity;
    });
  const auto one = GradedSize<3>::Limit(size, image, 0.3, 1);
  const auto many = GradedSize<3>::Limit(size, image, 0.3, 5);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(0.0, 68.0);
  for (int i = 0; i < 10000; ++i)
  {
    const Point<3> p{ anywhere(random), anywhere(random), anywhere(random) };
    ASSERT_EQ(one->Evaluate(p, 200), many->Evaluate(p, 200));
  }
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(GradedSize<3>::Limit(size, image, 0.3, 2, stop.get_token()), Cancelled);
}

//------------------------------------------------------------------------------------------------
// A small size on one side of a plane: elements on the other grow with their distance from it.
TEST(Gradation, ElementsOfNeighboursObeyTheBound)
{
  VOXPLEX_NOT_WITH_SANITIZERS();
  const LabelImage<3> image = phantoms::TouchingLabels(30); // the plane is x = 18.5
  MeshingOptions<3> options;
  options.Sampling.Delta = 4.0;
  options.Sampling.Size = std::make_shared<CallableSize>(
    [](const Point<3>&, std::int64_t label) { return label == 1 ? 1.0 : 100.0; });
  const auto excess = [&](double gradation, const SimplexMesh<3>& mesh)
  {
    double largest = -Infinity;
    for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
    {
      if (mesh.Labels[t] == 2)
      {
        double nearest =
          Infinity; // to label 1; no farther than from the circumcentre and its radius
        for (const std::uint32_t v : mesh.Simplices[t])
        {
          nearest = std::min(nearest, std::max(0.0, mesh.Points[v][0] - 18.5));
        }
        const double radius = checks::Circumradius(mesh, t);
        largest = std::max(largest, radius - (1.0 + gradation * (nearest + radius + 1.0)));
      }
    }
    return largest;
  };
  ImageMesher<3> stepping(
    [&]
    {
      MeshingOptions<3> without = options;
      without.Sampling.Gradation = 0.0;
      return without;
    }());
  SimplexMesh<3> mesh;
  stepping.Run(image, mesh);
  EXPECT_GT(excess(0.1, mesh), 0.5); // what is to be prevented
  const std::size_t without = mesh.Simplices.size();

  std::size_t last = std::numeric_limits<std::size_t>::max();
  for (const double gradation : { 0.1, 0.3 })
  {
    options.Sampling.Gradation = gradation;
    ImageMesher<3> mesher(options);
    mesher.Run(image, mesh);
    EXPECT_TRUE(checks::Complaints(mesh).empty());
    EXPECT_LT(excess(gradation, mesh), gradation * 1.0) << gradation;
    EXPECT_LT(mesh.Simplices.size(), last);
    last = mesh.Simplices.size();
  }
  EXPECT_GT(mesh.Simplices.size(), without / 2);
}

//------------------------------------------------------------------------------------------------
TEST(Gradation, MeshesWithoutSizesDoNotKnowIt)
{
  const LabelImage<3> image = phantoms::TouchingLabels(12);
  MeshingOptions<3> options;
  options.Sampling.Delta = 1.5;
  std::array<SimplexMesh<3>, 3> meshes;
  for (std::size_t i = 0; i < meshes.size(); ++i)
  {
    options.Sampling.Gradation = std::array{ 0.0, 0.3, 0.01 }[i];
    ImageMesher<3>(options).Run(image, meshes[i]);
    EXPECT_EQ(meshes[i].Points, meshes[0].Points);
    EXPECT_EQ(meshes[i].Simplices, meshes[0].Simplices);
  }
  for (const double wrong : { -0.1, Infinity, std::numeric_limits<double>::quiet_NaN() })
  {
    options.Sampling.Gradation = wrong;
    EXPECT_THROW(ImageMesher<3>(options).Run(image, meshes[0]), InputError);
  }
}

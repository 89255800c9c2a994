// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Image/FeatureTransform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace voxplex;

namespace
{

template <int D>
struct Sites
{
  using Index = typename BitMask<D>::Index;
  BitMask<D> Mask;
  std::vector<Index> List;

  Sites(const Index& dimensions, double density, std::mt19937& random)
    : Mask(dimensions)
  {
    std::bernoulli_distribution coin(density);
    for (std::size_t k = 0; k < CountCells(dimensions); ++k)
    {
      if (coin(random))
      {
        this->List.push_back(IndexAt(k, dimensions));
        this->Mask.Set(this->List.back());
      }
    }
  }
};

/** Every answer is a site, at the distance that brute force finds. */
template <int D>
void CheckAgainstBruteForce(
  const Sites<D>& sites, const Point<D>& spacing, const typename FeatureTransform<D>::Array& stride)
{
  const FeatureTransform<D> transform(sites.Mask, spacing, stride);
  const FeatureTransform<D> threaded(sites.Mask, spacing, stride, 4);
  std::size_t expectedCells = 1;
  for (std::size_t a = 0; a < D; ++a)
  {
    expectedCells *=
      static_cast<std::size_t>((sites.Mask.Dimensions()[a] + stride[a] - 1) / stride[a]);
  }
  ASSERT_EQ(transform.NumberOfCells(), expectedCells);
  for (std::size_t cell = 0; cell < transform.NumberOfCells(); ++cell)
  {
    ASSERT_EQ(transform.Site(cell), threaded.Site(cell));
    ASSERT_EQ(transform.Distance(cell), threaded.Distance(cell));
    Point<D> query;
    std::size_t rest = cell;
    for (std::size_t a = 0; a < D; ++a)
    {
      const std::size_t c = rest % transform.CellDimensions()[a];
      query[a] = transform.Centre(a, c);
      ASSERT_EQ(transform.CellOf(a, query[a]), c);
      rest /= transform.CellDimensions()[a];
    }
    const auto distance2 = [&](const typename Sites<D>::Index& site)
    {
      double sum = 0.0;
      for (std::size_t a = 0; a < D; ++a)
      {
        const double d = spacing[a] * (static_cast<double>(site[a]) - query[a]);
        sum += d * d;
      }
      return sum;
    };
    double best = std::numeric_limits<double>::infinity();
    for (const auto& site : sites.List)
    {
      best = std::min(best, distance2(site));
    }
    if (sites.List.empty())
    {
      ASSERT_EQ(transform.Site(cell), FeatureTransform<D>::NoSite);
      ASSERT_TRUE(std::isinf(transform.Distance(cell)));
      continue;
    }
    const auto site = transform.IndexOf(transform.Site(cell));
    ASSERT_TRUE(sites.Mask.Test(site));
    ASSERT_NEAR(distance2(site), best, 1e-12 * (1.0 + best));
    ASSERT_NEAR(transform.Distance(cell), std::sqrt(best), 1e-6 * (1.0 + std::sqrt(best)));
  }
}

} // namespace

TEST(FeatureTransform, EqualsBruteForceIn3D)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> spacing(0.2, 3.0);
  std::uniform_int_distribution<std::int64_t> size(1, 14);
  std::uniform_int_distribution<std::uint32_t> stride(1, 5);
  for (int trial = 0; trial < 60; ++trial)
  {
    SCOPED_TRACE(trial);
    // Now and then a row longer than a word.
    const Sites<3>::Index dimensions{ trial % 5 == 0 ? 150 : size(random), size(random),
      size(random) };
    const double density = std::array{ 0.0, 0.002, 0.02, 0.2 }[static_cast<std::size_t>(trial) % 4];
    const Sites<3> sites(dimensions, density, random);
    CheckAgainstBruteForce<3>(sites, { 1.0, 1.0, 1.0 }, { 1, 1, 1 });
    CheckAgainstBruteForce<3>(
      sites, { spacing(random), spacing(random), spacing(random) }, { 1, 1, 1 });
    CheckAgainstBruteForce<3>(sites, { spacing(random), spacing(random), spacing(random) },
      { stride(random), stride(random), stride(random) });
  }
}

TEST(FeatureTransform, EqualsBruteForceIn4D)
{
  std::mt19937 random(2);
  std::uniform_real_distribution<double> spacing(0.2, 3.0);
  std::uniform_int_distribution<std::int64_t> size(1, 8);
  std::uniform_int_distribution<std::uint32_t> stride(1, 4);
  for (int trial = 0; trial < 30; ++trial)
  {
    SCOPED_TRACE(trial);
    const Sites<4>::Index dimensions{ size(random), size(random), size(random), size(random) };
    const double density = std::array{ 0.002, 0.02, 0.2 }[static_cast<std::size_t>(trial) % 3];
    const Sites<4> sites(dimensions, density, random);
    const Point<4> lengths{ spacing(random), spacing(random), spacing(random), spacing(random) };
    CheckAgainstBruteForce<4>(sites, lengths, { 1, 1, 1, 1 });
    CheckAgainstBruteForce<4>(
      sites, lengths, { stride(random), stride(random), stride(random), stride(random) });
  }
}

TEST(FeatureTransform, ClampsCoordinatesToTheLattice)
{
  BitMask<3> mask({ 10, 10, 10 });
  mask.Set({ 3, 4, 5 });
  const FeatureTransform<3> transform(mask, { 1.0, 1.0, 1.0 }, { 4, 1, 3 });
  EXPECT_EQ(transform.CellDimensions(), (FeatureTransform<3>::Array{ 3, 10, 4 }));
  EXPECT_EQ(transform.CellOf(0, -1e30), 0u);
  EXPECT_EQ(transform.CellOf(0, 1e30), 2u);
  EXPECT_EQ(transform.CellOf(0, 3.4), 0u);
  EXPECT_EQ(transform.CellOf(0, 3.6), 1u);
  EXPECT_EQ(transform.IndexOf(transform.Site(0)), (BitMask<3>::Index{ 3, 4, 5 }));
}

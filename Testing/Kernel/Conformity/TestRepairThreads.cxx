// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Several threads mend edges that are not manifold, with the result of one.
#include "Conformity/ManifoldRepair.h"
#include "Domain/ImageDomain.h"
#include "Phantoms.h"
#include "RefinementChecks.h"
#include "RepairTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Repairs cubes of random labels. @return the bad edges, and the number of changes */
std::array<std::size_t, 2> CheckThatThreadsDoNotMatter(std::size_t size)
{
  const auto n = static_cast<std::int64_t>(size);
  std::mt19937 generator(1);
  std::vector<std::uint8_t> cubes(size * size * size / 64);
  std::generate(
    cubes.begin(), cubes.end(), [&] { return static_cast<std::uint8_t>(generator() % 4); });
  const auto image = phantoms::OfVoxels(phantoms::Cube(n),
    [&](const auto& v) {
      return cubes[static_cast<std::size_t>(v[0] / 4 + n / 4 * (v[1] / 4 + n / 4 * (v[2] / 4)))];
    });
  const ImageDomain<3> domain(image, 1.0);
  const auto context = Refined(domain, 3.0);
  const SimplexLabels before = LabelSimplices<3>(context->Mesh, domain);
  SimplexLabels labels = before;
  const Repaired<3> result = RepairAll<3>(context->Mesh, labels);
  for (const unsigned threads : { 2u, 3u, 8u })
  {
    SimplexLabels repaired = before;
    const Repaired<3> same = RepairAll<3>(context->Mesh, repaired, {}, threads);
    EXPECT_EQ(repaired, labels) << threads;
    EXPECT_EQ(same.Relabelled, result.Relabelled) << threads;
    EXPECT_EQ(same.Left.size(), result.Left.size()) << threads;
  }
  return { result.Before, result.Relabelled.size() };
}

} // namespace

// Each thread has many bad edges, and neighbours that another thread changes.
TEST(ManifoldRepair, DoesNotDependOnThreads)
{
  const auto [ridges, changes] = CheckThatThreadsDoNotMatter(64);
  EXPECT_GT(ridges, 600u);
  EXPECT_GT(changes, 300u);
}

// There are too few bad edges for parts with labels of their own.
TEST(ManifoldRepair, DoesNotDependOnThreadsWithFewEdges)
{
  const auto [ridges, changes] = CheckThatThreadsDoNotMatter(20);
  EXPECT_GT(ridges, 10u);
  EXPECT_LT(ridges, 64u);
  EXPECT_GT(changes, 5u);
}

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Several threads mend edges that are not manifold, with the result of one.
#include "Conformity/ManifoldRepair.h"
#include "Domain/ImageDomain.h"
#include "RefinementChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

// Cubes of random labels. There are enough bad edges for each of the threads to have many, and neighbours that another
// thread changes.
TEST(ManifoldRepair, DoesNotDependOnThreads)
{
  constexpr std::size_t Size = 64;
  std::mt19937 generator(1);
  std::vector<std::uint8_t> cubes(Size * Size * Size / 64);
  std::generate(
    cubes.begin(), cubes.end(), [&] { return static_cast<std::uint8_t>(generator() % 4); });
  std::vector<std::uint8_t> voxels;
  for (std::size_t k = 0; k < Size; ++k)
  {
    for (std::size_t j = 0; j < Size; ++j)
    {
      for (std::size_t i = 0; i < Size; ++i)
      {
        voxels.push_back(cubes[i / 4 + Size / 4 * (j / 4 + Size / 4 * (k / 4))]);
      }
    }
  }
  const auto image = LabelImage<3>::FromScalars<std::uint8_t>(
    voxels, GridGeometry<3>::Orthogonal({ Size, Size, Size }, { 1.0, 1.0, 1.0 }));
  const ImageDomain<3> domain(image, 1.0);
  const auto context = Refined(domain, 3.0);
  const SimplexLabels before = LabelSimplices<3>(context->Mesh, domain);
  SimplexLabels labels = before;
  const ManifoldRepairResult<3> result = RepairManifold<3>(context->Mesh, labels);
  EXPECT_GT(result.Before, 600u);
  EXPECT_GT(result.Relabelled.size(), 300u);
  for (const unsigned threads : { 2u, 3u, 8u })
  {
    SimplexLabels repaired = before;
    const ManifoldRepairResult<3> same = RepairManifold<3>(context->Mesh, repaired, {}, threads);
    EXPECT_EQ(repaired, labels) << threads;
    EXPECT_EQ(same.Relabelled, result.Relabelled) << threads;
    EXPECT_EQ(same.Left.size(), result.Left.size()) << threads;
  }
}

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Hundreds of tiny random images under many threads, which are in each other's way all the time; none
// may hang, and every mesh must be sound.
#include "Base/Error.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Sanitizers.h"
#include "ThreadTesting.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <string>
#include <tuple>

using namespace voxplex;
using namespace voxplex::checks;
using voxplex::testing::Watchdog;

namespace
{

/** The aggressive manager takes many times as long where there are more threads than cores. */
int NumberOfImages(ContentionPolicy contention)
{
  const int several = contention == ContentionPolicy::Aggressive ? 2 : 4;
  return Sanitized ? several : 40 * several;
}

using Policies = std::tuple<ContentionPolicy, BalancePolicy>;

std::string Name(const Policies& policies)
{
  const auto [contention, balance] = policies;
  return voxplex::testing::NameOf(contention) + "_" +
    std::string(BalancePolicyNames[static_cast<std::size_t>(balance)]);
}

/** 2^3 to 8^3 voxels of 1 to 5 labels, noise or blocks; at least one voxel is not background. */
LabelImage<3> RandomImage(std::mt19937& random)
{
  const auto number = [&](int low, int high)
  { return std::uniform_int_distribution<int>(low, high)(random); };
  GridGeometry<3> grid = GridGeometry<3>::Orthogonal(
    { number(2, 8), number(2, 8), number(2, 8) }, { 1.0, number(1, 3) / 2.0, 1.0 });
  const int labels = number(1, 5);
  const int block = number(1, 3);
  const int background = number(0, 1);
  std::map<std::array<int, 3>, std::int16_t> blocks;
  return phantoms::Make(grid,
    [&](const Point<3>& p) -> std::int16_t
    {
      if (p == Point<3>{ 0.0, 0.0, 0.0 })
      {
        return 1;
      }
      std::array<int, 3> key;
      for (std::size_t a = 0; a < 3; ++a)
      {
        key[a] = static_cast<int>(p[a] / grid.IndexToFrame[a][a] + 0.5) / block;
      }
      return blocks.try_emplace(key, static_cast<std::int16_t>(number(1 - background, labels)))
        .first->second;
    });
}

class RefinementStress : public ::testing::TestWithParam<Policies>
{
};

} // namespace

//------------------------------------------------------------------------------------------------
TEST_P(RefinementStress, TinyRandomImages)
{
  const auto [contention, balance] = GetParam();
  for (int seed = 0; seed < NumberOfImages(contention); ++seed)
  {
    const std::string name = Name(GetParam()) + ", seed " + std::to_string(seed);
    SCOPED_TRACE(name);
    const Watchdog watchdog(name);
    std::mt19937 random(static_cast<unsigned>(seed));
    const LabelImage<3> image = RandomImage(random);
    MeshingOptions<3> options =
      WithDelta<3>(std::uniform_real_distribution<double>(0.25, 2.0)(random));
    options.Team.Threads = 8;
    options.Team.Contention = contention;
    options.Team.Balance = balance;
    options.SmoothingSigma = seed % 3 == 0 ? 0.0 : 1.0;
    options.Team.SeedsPerThread = seed % 4 < 2 ? 128 : 0;
    MeshingStatistics statistics;
    ExpectSound(MeshOf(image, options, &statistics));
    EXPECT_EQ(statistics.Contention, contention);
    EXPECT_EQ(statistics.Balance, balance);
    ASSERT_EQ(statistics.Threads.size(), 8u);
    std::uint64_t waits = 0;
    std::uint64_t rollbacks = 0;
    for (const ThreadStatistics& thread : statistics.Threads)
    {
      waits += thread.Waits;
      rollbacks += thread.Rollbacks;
    }
    EXPECT_LE(waits, rollbacks);
    if (contention == ContentionPolicy::Global || contention == ContentionPolicy::Local)
    {
      EXPECT_FALSE(statistics.SwitchedToLocal);
    }
    if (contention == ContentionPolicy::Aggressive && waits != 0)
    {
      EXPECT_TRUE(statistics.SwitchedToLocal) << "only the local manager makes threads wait";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Policies, RefinementStress,
  ::testing::Combine(::testing::ValuesIn(voxplex::testing::AllPolicies),
    ::testing::Values(BalancePolicy::Random, BalancePolicy::Hierarchical)),
  [](const auto& policies) { return Name(policies.param); });

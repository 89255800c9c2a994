// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Work that blocks of a complex are given.
#include "Base/Error.h"
#include "ComplexOf.h"
#include "Optimisation/BlockSchedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <vector>

using namespace voxplex;
using checks::Strip;

namespace
{

/** What the tasks of a schedule were given. */
struct Given
{
  std::vector<std::uint32_t> Cells; ///< the number of times
  /** Of the tasks that begin with a clock, which may run at the same time: cells, slots, spare vertices. */
  std::map<std::uint32_t, std::vector<std::vector<std::uint32_t>>> Tasks;
};

Given GiveTo(TetrahedralComplex& complex, unsigned threads)
{
  Given given{ std::vector<std::uint32_t>(complex.Cells.size()), {} };
  std::vector<std::uint32_t> all(complex.Cells.size());
  std::iota(all.begin(), all.end(), 0u);
  std::set<std::uint32_t> used; // slots
  std::mutex mutex;
  const std::stop_token never;
  BlockSchedule<3> schedule(complex, threads, never);
  schedule.RunInTiles(
    all, [&](std::uint32_t t) { return std::optional(schedule.ItemOf(t)); }, { 2, 1 },
    [&](Patch<3>& patch, std::span<const std::uint32_t> cells)
    {
      const std::scoped_lock lock(mutex);
      std::vector<std::uint32_t> slots = patch.TakeSlots();
      EXPECT_GE(slots.size(), 2 * cells.size());
      std::vector<std::uint32_t> task(cells.begin(), cells.end());
      task.insert(task.end(), slots.begin(), slots.end());
      for (const std::uint32_t t : cells)
      {
        ++given.Cells[t];
        EXPECT_TRUE(patch.MayChange(t));
        const std::uint32_t spare = patch.SpareVertex();
        EXPECT_TRUE(patch.Has(spare));
        EXPECT_EQ(complex.Degrees.at(spare), 0u);
        patch.KeepVertex();
        task.push_back(~spare); // of another kind than cells and slots
        EXPECT_TRUE(used.insert(slots.front()).second);
        slots.erase(slots.begin());
      }
      EXPECT_EQ(patch.SpareVertex(), TetrahedralComplex::None);
      given.Tasks[patch.Clock].push_back(task);
      patch.SetSlots(slots);
      ++patch.Clock;
    });
  return given;
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(BlockSchedule, DoesAllWorkOnce)
{
  TetrahedralComplex complex = Strip(5000);
  const Given given = GiveTo(complex, 3);
  EXPECT_EQ(given.Cells, std::vector<std::uint32_t>(5000, 1u));
  ASSERT_GE(given.Tasks.size(), 2u); // what lies across planes comes later
  EXPECT_GE(given.Tasks.begin()->second.size(), 8u);
  for (const auto& [clock, tasks] : given.Tasks)
  {
    std::set<std::uint32_t> once;
    std::size_t number = 0;
    for (const std::vector<std::uint32_t>& task : tasks)
    {
      once.insert(task.begin(), task.end());
      number += task.size();
    }
    EXPECT_EQ(once.size(), number) << "two tasks have something in common";
  }
}

TEST(BlockSchedule, GivesLittleWorkToOneBlock)
{
  TetrahedralComplex complex = Strip(100);
  const Given given = GiveTo(complex, 3);
  ASSERT_EQ(given.Tasks.size(), 1u);
  EXPECT_EQ(given.Tasks.begin()->second.size(), 1u);
  EXPECT_EQ(given.Cells, std::vector<std::uint32_t>(100, 1u));
}

TEST(BlockSchedule, DoesNotDependOnThreads)
{
  TetrahedralComplex complex = Strip(5000);
  Given one = GiveTo(complex, 1);
  for (const unsigned threads : { 2u, 5u })
  {
    TetrahedralComplex other = Strip(5000);
    Given several = GiveTo(other, threads);
    ASSERT_EQ(several.Tasks.size(), one.Tasks.size());
    for (auto& [clock, tasks] : several.Tasks)
    {
      std::sort(tasks.begin(), tasks.end());
      std::sort(one.Tasks[clock].begin(), one.Tasks[clock].end());
      EXPECT_EQ(tasks, one.Tasks[clock]);
    }
  }
}

TEST(BlockSchedule, CanBeStopped)
{
  TetrahedralComplex complex = Strip(10);
  std::stop_source stop;
  stop.request_stop();
  const std::stop_token stopped = stop.get_token();
  BlockSchedule<3> schedule(complex, 1, stopped);
  EXPECT_THROW(
    schedule.RunInBlocks({}, { { 0 } }, {}, [](Patch<3>&, std::span<const std::uint32_t>) {}),
    Cancelled);
}

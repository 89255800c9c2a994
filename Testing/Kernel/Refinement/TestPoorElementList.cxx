// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/PoorElementList.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

using namespace voxplex;

namespace
{

/** Pushes `number` simplices, of which every tenth stays alive, and takes them all. */
struct Course
{
  std::size_t MostEntries = 0;
  std::vector<SimplexId> Alive; ///< in the order in which they were taken

  Course(std::uint32_t number, bool dropsDead, bool putsLast)
  {
    const auto isAlive = [](const PoorElementList::Entry& e) { return e.Id % 10 == 0; };
    PoorElementList list;
    if (dropsDead)
    {
      list.DropDeadBy(isAlive);
    }
    for (SimplexId s = 0; s < number; ++s)
    {
      putsLast ? list.PushLast(s, 0) : list.Push(s, 0);
      this->MostEntries = std::max(this->MostEntries, list.Size());
    }
    while (!list.Empty())
    {
      const PoorElementList::Entry e = list.Pop();
      if (isAlive(e))
      {
        this->Alive.push_back(e.Id);
      }
    }
  }
};

} // namespace

TEST(PoorElementList, DropsDeadEntriesBeforeItGrows)
{
  constexpr std::uint32_t number = 100000;
  for (const bool putsLast : { false, true })
  {
    SCOPED_TRACE(putsLast);
    const Course keeps(number, false, putsLast);
    const Course drops(number, true, putsLast);
    EXPECT_EQ(keeps.MostEntries, number);
    EXPECT_LT(drops.MostEntries, number / 2);
    EXPECT_EQ(drops.Alive, keeps.Alive); // and in the same order
    EXPECT_EQ(drops.Alive.size(), number / 10);
  }
}

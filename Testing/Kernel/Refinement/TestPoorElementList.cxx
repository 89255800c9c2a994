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

// The directory of eager removal follows entries that move.
TEST(PoorElementList, FindsEntriesAfterDeadOnesWereDropped)
{
  PoorElementList list;
  PoorElementList::Directory directory;
  list.RemoveEagerly(directory, 3);
  list.DropDeadBy([](const PoorElementList::Entry& e) { return e.Id % 2 == 0; });
  constexpr SimplexId number = 5000;
  for (SimplexId s = 0; s < number; ++s)
  {
    list.Push(s, 7);
  }
  EXPECT_LT(list.Size(), number);
  for (SimplexId s = 0; s < number; s += 2)
  {
    const PoorElementList::Directory::Slot slot = directory.Find(s);
    EXPECT_EQ(slot.List, 3u);
    list.Remove({ s, 7 }, slot.Index);
  }
  while (!list.Empty())
  {
    const SimplexId left = list.Pop().Id;
    EXPECT_TRUE(left == None || left % 2 == 1) << left;
  }
}

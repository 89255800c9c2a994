// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/PageMemory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <new>

using namespace voxplex;

TEST(PageMemory, IsAlignedAndZeroAndCanBeWritten)
{
  constexpr std::size_t bytes = (1 << 20) + 100;
  for (int round = 0; round < 3; ++round)
  {
    auto* const pages = static_cast<unsigned char*>(AllocatePages(bytes));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pages) % 64, 0u);
    EXPECT_EQ(std::count(pages, pages + bytes, 0), static_cast<std::ptrdiff_t>(bytes));
    std::fill_n(pages, bytes, static_cast<unsigned char>(1));
    FreePages(pages, bytes);
  }
}

// Otherwise all addresses would be gone soon: 128 TiB.
TEST(PageMemory, GoesBackToTheSystem)
{
  constexpr std::size_t bytes = std::size_t{ 1 } << 30;
  for (int round = 0; round < 140000; ++round)
  {
    FreePages(AllocatePages(bytes), bytes);
  }
}

TEST(PageMemory, ThrowsIfThereIsNotEnough)
{
  EXPECT_THROW(AllocatePages(std::size_t{ 1 } << 60), std::bad_alloc);
}

TEST(PageMemory, TheMachineHasSome)
{
  EXPECT_GT(PhysicalMemory(), std::uint64_t{ 1 } << 26);
  EXPECT_LT(PhysicalMemory(), std::uint64_t{ 1 } << 50);
}

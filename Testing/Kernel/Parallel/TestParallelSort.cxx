// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The helpers of parallel loops against what one thread would do.
#include "Base/UninitialisedVector.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelSort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>

using namespace voxplex;

namespace
{

struct Record
{
  std::uint64_t Key;
  std::uint32_t Id;
  bool operator==(const Record&) const = default;
};

std::uint64_t KeyOf(const Record& record)
{
  return record.Key;
}

/** Records in random order of their keys, which lie below 2^bits; ids ascend. */
std::vector<Record> RandomRecords(std::size_t n, unsigned bits)
{
  std::mt19937_64 random(n + bits);
  std::vector<Record> records(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    records[i] = { bits == 0 ? 0 : random() >> (64 - bits), static_cast<std::uint32_t>(i) };
  }
  return records;
}

std::vector<Record> Sorted(std::vector<Record> records, unsigned bits, unsigned threads)
{
  std::vector<Record> scratch(records.size());
  const auto result =
    ParallelRadixSort(std::span<Record>(records), std::span<Record>(scratch), bits, KeyOf, threads);
  return { result.begin(), result.end() };
}

} // namespace

// Few bits mean many equal keys, whose order only a stable sort keeps; the largest size makes
// several blocks.
TEST(ParallelRadixSort, IsTheStableSortForAnyNumberOfThreads)
{
  for (const std::size_t n : { 0u, 1u, 2u, 100u, 65536u, 65537u, 300000u })
  {
    for (const unsigned bits : { 0u, 1u, 9u, 10u, 11u, 32u, 63u, 64u })
    {
      const std::vector<Record> records = RandomRecords(n, bits);
      std::vector<Record> expected = records;
      std::ranges::stable_sort(expected, {}, KeyOf);
      for (const unsigned threads : { 0u, 1u, 2u, 3u, 8u })
      {
        ASSERT_TRUE(Sorted(records, bits, threads) == expected)
          << n << " records, " << bits << " bits, " << threads << " threads";
      }
    }
  }
}

// Digits that all keys share are skipped; what lies above `bits` is not looked at.
TEST(ParallelRadixSort, KeysThatShareDigits)
{
  for (const unsigned shift : { 0u, 15u, 40u })
  {
    std::vector<Record> records = RandomRecords(100000, 9);
    for (Record& record : records)
    {
      record.Key = (record.Key << shift) | (std::uint64_t{ 1 } << 62);
    }
    std::vector<Record> expected = records;
    std::ranges::stable_sort(expected, {}, KeyOf);
    for (const unsigned threads : { 1u, 3u })
    {
      EXPECT_TRUE(Sorted(records, 63, threads) == expected) << shift;
      EXPECT_TRUE(Sorted(records, 50, threads) == expected) << shift;
    }
  }
}

TEST(ParallelRadixSort, Stops)
{
  const std::vector<Record> records = RandomRecords(100000, 63);
  for (const unsigned threads : { 1u, 4u })
  {
    // At once, before half of a pass, and in a later pass.
    for (const std::size_t calls : { 0u, 50000u, 450000u })
    {
      std::vector<Record> values = records;
      std::vector<Record> scratch(values.size());
      std::stop_source source;
      std::atomic<std::size_t> called = 0;
      const auto key = [&](const Record& record)
      {
        if (++called >= calls)
        {
          source.request_stop();
        }
        return record.Key;
      };
      if (calls == 0)
      {
        source.request_stop();
      }
      EXPECT_THROW(ParallelRadixSort(std::span<Record>(values), std::span<Record>(scratch), 63, key,
                     threads, source.get_token()),
        Cancelled);
      EXPECT_LE(called, calls + records.size()) << "no further pass";
    }
  }
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_THROW(
    ParallelRadixSort(std::span<Record>(), std::span<Record>(), 63, KeyOf, 1, stopped.get_token()),
    Cancelled);
}

TEST(ChunkCounts, ChunksAppendInTheirOrder)
{
  for (const std::size_t n : { std::size_t{ 0 }, std::size_t{ 1 }, ChunkCounts::Grain,
         ChunkCounts::Grain + 1, 5 * ChunkCounts::Grain - 1 })
  {
    const auto isTaken = [](std::size_t i) { return i % 7 == 3 || i % 100 < 20; };
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < n; ++i)
    {
      if (isTaken(i))
      {
        expected.push_back(i);
      }
    }
    ChunkCounts counts(n);
    ParallelFor(0, n, ChunkCounts::Grain, 3,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t i = first; i < last; ++i)
        {
          counts.OfChunk(first) += isTaken(i);
        }
      });
    std::vector<std::size_t> taken(counts.TurnIntoPlaces());
    ASSERT_EQ(taken.size(), expected.size());
    ParallelFor(0, n, ChunkCounts::Grain, 3,
      [&](std::size_t first, std::size_t last)
      {
        std::size_t place = counts.OfChunk(first);
        for (std::size_t i = first; i < last; ++i)
        {
          if (isTaken(i))
          {
            taken[place++] = i;
          }
        }
      });
    EXPECT_EQ(taken, expected);
  }
}

TEST(UninitialisedVector, ResizeLeavesTheMemoryAsItWas)
{
  constexpr int Marker = 42;
  UninitialisedVector<int> values(1000, Marker);
  EXPECT_EQ(std::ranges::count(values, Marker), 1000);
  int* const memory = values.data();
  values.clear();
  values.resize(1000);
  ASSERT_EQ(values.data(), memory);
  EXPECT_EQ(std::ranges::count(values, Marker), 1000) << "nothing was written";
  values.resize(1001, 7);
  EXPECT_EQ(values.back(), 7);
  const UninitialisedVector<int> copy = values;
  EXPECT_EQ(copy, values);
}

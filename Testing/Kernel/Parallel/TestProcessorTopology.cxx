// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/HardwareCounters.h"
#include "Parallel/ProcessorTopology.h"
#ifdef VOXPLEX_HAVE_HWLOC
#include "Parallel/HwlocTopology.h"
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sched.h>
#endif

using namespace voxplex;

namespace
{

using Groups = std::vector<unsigned>;

Groups GroupsOfLevel(const ProcessorTopology& topology, unsigned level)
{
  Groups groups;
  for (const auto& group : topology.Group)
  {
    groups.push_back(group[level]);
  }
  return groups;
}

/** Threads of one group are in one group on all higher levels, and all in group 0 of the last. */
void ExpectNested(const ProcessorTopology& topology)
{
  for (const auto& a : topology.Group)
  {
    EXPECT_EQ(a[2], 0u);
    for (const auto& b : topology.Group)
    {
      EXPECT_TRUE(a[0] != b[0] || a[1] == b[1]);
    }
  }
}

#ifdef VOXPLEX_HAVE_HWLOC

/**
 * DiscoverTopology() on a described machine.
 * @param description in hwloc's synthetic notation
 * @param allowed as numbered by the operating system; empty means all
 */
ProcessorTopology DescribedTopology(
  const char* description, const std::vector<unsigned>& allowed, unsigned threads)
{
  hwloc_topology_t machine = nullptr;
  hwloc_topology_init(&machine);
  EXPECT_EQ(hwloc_topology_set_synthetic(machine, description), 0);
  EXPECT_EQ(hwloc_topology_load(machine), 0);
  const hwloc_bitmap_t set = allowed.empty() ? hwloc_bitmap_alloc_full() : hwloc_bitmap_alloc();
  for (const unsigned processor : allowed)
  {
    hwloc_bitmap_set(set, processor);
  }
  ProcessorTopology topology = SpreadThreads(machine, set, threads);
  hwloc_bitmap_free(set);
  hwloc_topology_destroy(machine);
  return topology;
}

#endif

} // namespace

TEST(ProcessorTopology, Flat)
{
  const ProcessorTopology flat = FlatTopology(5);
  EXPECT_EQ(GroupsOfLevel(flat, 0), Groups(5, 0));
  EXPECT_EQ(GroupsOfLevel(flat, 1), Groups(5, 0));
  EXPECT_EQ(GroupsOfLevel(flat, 2), Groups(5, 0));
  EXPECT_TRUE(flat.Processor.empty());
  EXPECT_FALSE(PinThisThread(flat, 0));
}

#ifdef VOXPLEX_HAVE_HWLOC

TEST(ProcessorTopology, CoresFirstThenHyperthreadsThenRoundAgain)
{
  const ProcessorTopology topology = DescribedTopology("pack:2 numa:1 core:4 pu:2", {}, 20);
  EXPECT_EQ(topology.Processor,
    (Groups{ 0, 2, 4, 6, 8, 10, 12, 14, 1, 3, 5, 7, 9, 11, 13, 15, 0, 2, 4, 6 }));
  const Groups sockets = { 0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0 };
  EXPECT_EQ(GroupsOfLevel(topology, 0), sockets);
  EXPECT_EQ(GroupsOfLevel(topology, 1), sockets);
  ExpectNested(topology);
}

TEST(ProcessorTopology, SocketsInNumaNodes)
{
  const ProcessorTopology topology = DescribedTopology("numa:2 pack:2 core:2 pu:1", {}, 8);
  EXPECT_EQ(topology.Processor, (Groups{ 0, 1, 2, 3, 4, 5, 6, 7 }));
  EXPECT_EQ(GroupsOfLevel(topology, 0), (Groups{ 0, 0, 1, 1, 2, 2, 3, 3 }));
  EXPECT_EQ(GroupsOfLevel(topology, 1), (Groups{ 0, 0, 0, 0, 1, 1, 1, 1 }));
  ExpectNested(topology);
}

TEST(ProcessorTopology, NumaNodesInSockets)
{
  const ProcessorTopology topology = DescribedTopology("pack:2 numa:2 core:2 pu:2", {}, 16);
  EXPECT_EQ(GroupsOfLevel(topology, 0), (Groups{ 0, 0, 1, 1, 2, 2, 3, 3, 0, 0, 1, 1, 2, 2, 3, 3 }));
  EXPECT_EQ(GroupsOfLevel(topology, 1), (Groups{ 0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1 }));
  ExpectNested(topology);
}

TEST(ProcessorTopology, FewThreadsStayInOneSocket)
{
  const ProcessorTopology topology = DescribedTopology("pack:2 numa:1 core:4 pu:2", {}, 3);
  EXPECT_EQ(topology.Processor, (Groups{ 0, 2, 4 }));
  EXPECT_EQ(GroupsOfLevel(topology, 0), Groups(3, 0));
}

TEST(ProcessorTopology, ForbiddenProcessorsAreLeftOut)
{
  const char* machine = "pack:2 numa:1 core:4 pu:2";
  // The second hyper-thread of a core is its first where the first is forbidden.
  EXPECT_EQ(DescribedTopology(machine, { 1, 3, 8, 10 }, 4).Processor, (Groups{ 1, 3, 8, 10 }));
  EXPECT_EQ(DescribedTopology(machine, { 0, 1, 8 }, 4).Processor, (Groups{ 0, 8, 1, 0 }));
  // Groups are numbered by those that are used.
  const ProcessorTopology second = DescribedTopology(machine, { 8, 9 }, 2);
  EXPECT_EQ(GroupsOfLevel(second, 0), Groups(2, 0));
  EXPECT_EQ(GroupsOfLevel(second, 1), Groups(2, 0));
  EXPECT_TRUE(DescribedTopology(machine, { 99 }, 2).Processor.empty());
}

#endif

TEST(ProcessorTopology, ThisMachine)
{
  for (const unsigned threads : { 1u, 2u, 7u, 300u })
  {
    const ProcessorTopology topology = DiscoverTopology(threads);
    ASSERT_EQ(topology.Group.size(), threads);
    ExpectNested(topology);
#ifdef VOXPLEX_HAVE_HWLOC
    EXPECT_EQ(topology.Processor.size(), threads);
#else
    EXPECT_TRUE(topology.Processor.empty());
#endif
    EXPECT_FALSE(PinThisThread(topology, threads)) << "there is no such thread";
  }
}

#if defined(__linux__) && defined(VOXPLEX_HAVE_HWLOC)

namespace
{

std::vector<unsigned> AllowedHere()
{
  cpu_set_t set;
  std::vector<unsigned> allowed;
  if (sched_getaffinity(0, sizeof set, &set) == 0)
  {
    for (unsigned i = 0; i < CPU_SETSIZE; ++i)
    {
      if (CPU_ISSET(i, &set))
      {
        allowed.push_back(i);
      }
    }
  }
  return allowed;
}

/** As `taskset -a -p`: all threads, since sanitizers have some of their own. */
void AllowProcess(const std::vector<unsigned>& processors)
{
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const unsigned processor : processors)
  {
    CPU_SET(processor, &set);
  }
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
  {
    sched_setaffinity(std::stoi(task.path().filename().string()), sizeof set, &set);
  }
}

} // namespace

TEST(ProcessorTopology, HonoursWhatTheProcessMayUse)
{
  const std::vector<unsigned> allowed = AllowedHere();
  ASSERT_FALSE(allowed.empty());
  for (const unsigned processor : allowed)
  {
    AllowProcess({ processor });
    const ProcessorTopology topology = DiscoverTopology(3);
    AllowProcess(allowed);
    EXPECT_EQ(topology.Processor, Groups(3, processor));
  }
  Groups used = DiscoverTopology(static_cast<unsigned>(allowed.size())).Processor;
  std::sort(used.begin(), used.end());
  EXPECT_EQ(used, allowed);
}

TEST(ProcessorTopology, PinsTheCallingThreadOnly)
{
  const std::vector<unsigned> allowed = AllowedHere();
  const unsigned threads = static_cast<unsigned>(allowed.size()) + 1;
  const ProcessorTopology topology = DiscoverTopology(threads);
  for (unsigned t = 0; t < threads; ++t)
  {
    std::thread(
      [&topology, t]()
      {
        EXPECT_TRUE(PinThisThread(topology, t));
        EXPECT_EQ(AllowedHere(), Groups(1, topology.Processor[t]));
      })
      .join();
  }
  EXPECT_EQ(AllowedHere(), allowed);
}

#endif

//----------------------------------------------------------------------------------------------
namespace
{

/** Work that shows in the counters of a machine that has them. */
double TouchMemory()
{
  std::vector<double> values(std::size_t(1) << 20, 1.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    sum += values[(i * 4099) % values.size()];
  }
  return sum;
}

bool IsEmpty(const HardwareCounters::Counts& counts)
{
  return !counts.TlbMisses && !counts.LastLevelCacheMisses && !counts.ResourceStallCycles;
}

} // namespace

TEST(HardwareCounters, CountsOrSaysThatItCannot)
{
  HardwareCounters counters;
  EXPECT_TRUE(IsEmpty(counters.Stop())) << "was not started";
  for (int round = 0; round < 3; ++round)
  {
    const bool counts = counters.Start();
    EXPECT_GT(TouchMemory(), 0.0);
    EXPECT_EQ(IsEmpty(counters.Stop()), !counts);
    EXPECT_TRUE(IsEmpty(counters.Stop())) << "was stopped already";
  }
  EXPECT_EQ(counters.Start(), counters.Start()) << "starts anew";
}

TEST(HardwareCounters, EachThreadHasItsOwn)
{
  std::vector<std::thread> threads;
  std::array<bool, 4> started{};
  for (bool& mine : started)
  {
    threads.emplace_back(
      [&mine]()
      {
        HardwareCounters counters;
        mine = counters.Start();
        EXPECT_GT(TouchMemory(), 0.0);
        EXPECT_EQ(IsEmpty(counters.Stop()), !mine);
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(std::count(started.begin(), started.end(), started[0]), 4);
}

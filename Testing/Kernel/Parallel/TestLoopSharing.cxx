// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/LoopSharing.h"
#include "Parallel/ParkingSpot.h"
#include "Refinement/Scheduling/ContentionManager.h"
#include "Refinement/Scheduling/LoadBalancer.h"
#include "Sanitizers.h"
#include "ThreadTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

using namespace voxplex;
using namespace voxplex::testing;

namespace
{

/** Helpers that never give up: for tests in which the owner waits for one. */
constexpr unsigned Patient = std::numeric_limits<unsigned>::max();

struct Custom : std::exception
{
};

/** Threads first ... last - 1 help for as long as this lives. */
class Helpers
{
public:
  Helpers(LoopSharing& sharing, unsigned first, unsigned last)
  {
    for (unsigned t = first; t < last; ++t)
    {
      this->Threads.emplace_back(
        [this, &sharing, t]()
        {
          while (!this->Over)
          {
            sharing.HelpUntil(t, [this]() { return this->Over.load(); });
          }
        });
    }
    EXPECT_TRUE(Soon([&sharing]() { return sharing.SomeoneIdle(); }));
  }
  ~Helpers() { this->Over = true; }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

private:
  std::atomic<bool> Over{ false };
  std::vector<std::jthread> Threads; // last: they use the other
};

/** Until something is true that another thread brings about: nobody need look again. */
void WaitFor(const std::atomic<bool>& flag)
{
  while (!flag)
  {
    std::this_thread::yield();
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(LoopSharing, AloneTheOwnerDoesAllInOnePiece)
{
  LoopSharing sharing(3);
  EXPECT_FALSE(sharing.SomeoneIdle());
  unsigned calls = 0;
  bool meanwhile = false;
  sharing.Run(
    1, 100, 7,
    [&](unsigned thread, std::size_t first, std::size_t last)
    {
      EXPECT_EQ(thread, 1u);
      EXPECT_EQ(first, 0u);
      EXPECT_EQ(last, 100u);
      EXPECT_TRUE(meanwhile);
      ++calls;
    },
    [&]() { meanwhile = true; });
  EXPECT_EQ(calls, 1u);
  sharing.Run(1, 0, 7, [&](unsigned, std::size_t, std::size_t) { ++calls; });
  EXPECT_EQ(calls, 1u) << "an empty loop";
  EXPECT_EQ(sharing.GetCounts(1).Loops, 0u);
  EXPECT_EQ(sharing.GetCounts(1).Iterations, 0u);
}

TEST(LoopSharing, AnIdleThreadTakesChunks)
{
  const Watchdog watchdog("an idle thread takes chunks");
  LoopSharing sharing(2, Patient);
  auto helpers = std::make_unique<const Helpers>(sharing, 1, 2);
  for (const std::size_t count : { 1u, 5u, 6u, 7u, 100u })
  {
    std::atomic<bool> taken{ false };
    std::vector<unsigned> by(
      count, 99); // plain memory: the sanitizer sees whether it is handed over
    std::vector<unsigned> input(count);
    std::iota(input.begin(), input.end(), 0u);
    const std::uint64_t before = sharing.GetCounts(0).Iterations;
    sharing.Run(
      0, count, 6,
      [&](unsigned thread, std::size_t first, std::size_t last)
      {
        EXPECT_LT(first, last);
        EXPECT_LE(last, count);
        EXPECT_EQ(first % 6, 0u);
        EXPECT_LE(last - first, 6u);
        for (std::size_t i = first; i < last; ++i)
        {
          EXPECT_EQ(by[i], 99u);
          by[i] = thread + 0 * input[i];
        }
        taken = taken || thread == 1;
      },
      [&]() { WaitFor(taken); });
    EXPECT_EQ(std::count(by.begin(), by.end(), 99u), 0);
    EXPECT_EQ(by[0], 1u) << "the owner began only when the helper had";
    EXPECT_EQ(sharing.GetCounts(0).Iterations - before,
      static_cast<std::uint64_t>(std::count(by.begin(), by.end(), 1u)));
  }
  helpers.reset(); // they have ended
  EXPECT_EQ(sharing.GetCounts(0).Loops, 5u);
  EXPECT_EQ(sharing.GetCounts(1).Loops, 0u);
  EXPECT_EQ(sharing.TicksOfHelp(0), 0u);
  EXPECT_GT(sharing.TicksOfHelp(1), 0u);
}

// The loop's memory is the owner's stack. A helper that stayed would write over what comes there next.
TEST(LoopSharing, NoHelperIsLeftBehind)
{
  const Watchdog watchdog("no helper is left behind");
  LoopSharing sharing(2, Patient);
  const Helpers helpers(sharing, 1, 2);
  std::atomic<bool> inside{ false };
  std::atomic<bool> mayLeave{ false };
  const Call owner(
    [&]()
    {
      bool written[2] = { false, false };
      sharing.Run(
        0, 2, 1,
        [&](unsigned thread, std::size_t first, std::size_t)
        {
          if (thread == 1)
          {
            inside = true;
            WaitFor(mayLeave);
          }
          written[first] = true;
        },
        [&]() { WaitFor(inside); });
      return written[0] && written[1];
    });
  EXPECT_TRUE(Soon([&]() { return inside.load(); }));
  EXPECT_TRUE(Stays([&]() { return !owner.Returned(); })) << "its helper is at work still";
  mayLeave = true;
  EXPECT_TRUE(owner.ReturnsSoon());
  EXPECT_TRUE(owner.Value());
}

TEST(LoopSharing, ManyOwnersAndHelpers)
{
  const Watchdog watchdog("many owners and helpers");
  constexpr unsigned Owners = 4;
  constexpr unsigned Threads = 8;
  LoopSharing sharing(Threads, 200);
  std::atomic<unsigned> rounds{ 0 };
  {
    const Helpers helpers(sharing, Owners, Threads);
    std::vector<std::jthread> owners;
    for (unsigned me = 0; me < Owners; ++me)
    {
      owners.emplace_back(
        [&sharing, &rounds, me]()
        {
          std::mt19937 random(me);
          for (unsigned round = 0; round < (Sanitized ? 2000u : 20000u); ++round)
          {
            // New memory in each round, for the sanitizers.
            const auto sums = std::make_unique<std::uint64_t[]>(64);
            const std::size_t count = random() % 64;
            const std::uint64_t salt = random();
            sharing.Run(
              me, count, 1 + random() % 5,
              [&](unsigned, std::size_t first, std::size_t last)
              {
                for (std::size_t i = first; i < last; ++i)
                {
                  sums[i] += salt + i;
                }
              },
              [&]()
              {
                if (salt % 16 == 0)
                {
                  std::this_thread::yield();
                }
              });
            for (std::size_t i = 0; i < 64; ++i)
            {
              ASSERT_EQ(sums[i], i < count ? salt + i : 0u) << "iteration " << i << " of " << count;
            }
            ++rounds;
            // Owners help, too: as a thread does that loses a vertex.
            if (salt % 4 == 0)
            {
              unsigned looks = 20;
              sharing.HelpUntil(me, [&looks]() { return looks-- == 0; });
            }
          }
        });
    }
  }
  EXPECT_EQ(rounds, Owners * (Sanitized ? 2000u : 20000u));
  EXPECT_FALSE(sharing.SomeoneIdle());
}

//------------------------------------------------------------------------------------------------
TEST(LoopSharing, WhatAHelperThrowsReachesTheOwner)
{
  const Watchdog watchdog("a helper throws");
  LoopSharing sharing(3, Patient);
  const Helpers helpers(sharing, 1, 3);
  for (unsigned round = 0; round < 200; ++round)
  {
    std::atomic<bool> thrown{ false };
    std::atomic<unsigned> others{ 0 };
    EXPECT_THROW(sharing.Run(
                   0, 1000, 1,
                   [&](unsigned thread, std::size_t, std::size_t)
                   {
                     if (thread != 0)
                     {
                       thrown = true;
                       throw std::bad_alloc();
                     }
                     ++others;
                   },
                   [&]() { WaitFor(thrown); }),
      std::bad_alloc);
    EXPECT_LT(others, 1000u) << "a chunk that threw counts as taken";
  }
  // The sharing works on.
  std::atomic<unsigned> done{ 0 };
  sharing.Run(0, 10, 1, [&](unsigned, std::size_t, std::size_t) { ++done; });
  EXPECT_EQ(done, 10u);
}

TEST(LoopSharing, WhatTheOwnerThrowsWaitsForTheHelpers)
{
  const Watchdog watchdog("the owner throws");
  LoopSharing sharing(2, Patient);
  const Helpers helpers(sharing, 1, 2);
  for (unsigned round = 0; round < 200; ++round)
  {
    const bool inMeanwhile = round % 2 == 0;
    std::atomic<bool> helped{ false };
    std::atomic<bool> thrown{ false };
    bool left = false; // not atomic: written by the helper before it leaves
    EXPECT_THROW(sharing.Run(
                   0, 2, 1,
                   [&](unsigned thread, std::size_t, std::size_t)
                   {
                     if (thread == 0)
                     {
                       thrown = true;
                       throw Custom();
                     }
                     helped = true;
                     WaitFor(thrown); // so the other chunk is the owner's
                     std::this_thread::yield();
                     left = true;
                   },
                   [&]()
                   {
                     WaitFor(helped);
                     if (inMeanwhile)
                     {
                       thrown = true;
                       throw Custom();
                     }
                   }),
      Custom);
    EXPECT_TRUE(left);
  }
}

TEST(LoopSharing, AllMayThrow)
{
  const Watchdog watchdog("all throw");
  LoopSharing sharing(4, Patient);
  const Helpers helpers(sharing, 1, 4);
  for (unsigned round = 0; round < 500; ++round)
  {
    EXPECT_THROW(
      sharing.Run(0, 100, 1, [](unsigned, std::size_t, std::size_t) { throw Custom(); }), Custom);
  }
  std::atomic<unsigned> done{ 0 };
  sharing.Run(0, 10, 1, [&](unsigned, std::size_t, std::size_t) { ++done; });
  EXPECT_EQ(done, 10u);
}

//------------------------------------------------------------------------------------------------
TEST(LoopSharing, AHelperThatFindsNothingGivesUp)
{
  const Watchdog watchdog("a helper gives up");
  LoopSharing sharing(2);
  const Call helper(
    [&]()
    {
      sharing.HelpUntil(1, []() { return false; });
      return true;
    });
  EXPECT_TRUE(helper.ReturnsSoon());
  EXPECT_FALSE(sharing.SomeoneIdle());
}

TEST(LoopSharing, WaitAndHelpEndsWithTheWakeUp)
{
  const Watchdog watchdog("wake-up");
  LoopSharing sharing(2, Patient);
  for (const bool withDesk : { true, false })
  {
    for (unsigned round = 0; round < 200; ++round)
    {
      ParkingSpot spot;
      spot.Prepare();
      int written = 0; // not atomic: Wake() publishes it
      const Call waiting(
        [&]()
        {
          WaitAndHelp(spot, withDesk ? &sharing : nullptr, 1);
          return written == 1;
        });
      if (round % 3 == 1)
      {
        std::this_thread::yield();
      }
      if (round % 50 == 2)
      {
        EXPECT_TRUE(Stays([&]() { return !waiting.Returned(); })) << "nobody woke it";
      }
      written = 1;
      spot.Wake();
      EXPECT_TRUE(waiting.ReturnsSoon());
      EXPECT_TRUE(waiting.Value());
    }
  }
  EXPECT_FALSE(sharing.SomeoneIdle());
}

namespace
{

/** Runs a loop of thread 0 in which thread 1, which waits somewhere, does a part. */
void ExpectHelp(LoopSharing& sharing)
{
  EXPECT_TRUE(Soon([&]() { return sharing.SomeoneIdle(); }));
  std::atomic<bool> taken{ false };
  sharing.Run(
    0, 8, 1, [&](unsigned thread, std::size_t, std::size_t) { taken = taken || thread == 1; },
    [&]() { WaitFor(taken); });
  EXPECT_GT(sharing.GetCounts(0).Iterations, 0u);
}

} // namespace

TEST(LoopSharing, WhoBegsForWorkHelps)
{
  const Watchdog watchdog("beg and help");
  for (const BalancePolicy policy : { BalancePolicy::Random, BalancePolicy::Hierarchical })
  {
    LoopSharing sharing(2, Patient);
    const auto balancer = MakeLoadBalancer(policy, FlatTopology(2), &sharing);
    const Call beggar([&]() { return balancer->Beg(1); });
    ExpectHelp(sharing);
    EXPECT_FALSE(beggar.Returned());
    EXPECT_TRUE(Soon([&]() { return balancer->SomeoneBegs(); }));
    EXPECT_EQ(balancer->TakeBeggar(0).Thread, 1u);
    balancer->Wake(1);
    EXPECT_TRUE(beggar.ReturnsSoon());
    EXPECT_TRUE(beggar.Value());
  }
}

TEST(LoopSharing, WhoLostAVertexHelps)
{
  const Watchdog watchdog("lose and help");
  for (const ContentionPolicy policy : { ContentionPolicy::Global, ContentionPolicy::Local })
  {
    LoopSharing sharing(2, Patient);
    const auto manager = MakeContentionManager(policy, 2, &sharing);
    const Call loser([&]() { return manager->RollbackOccurred(1, 0); });
    ExpectHelp(sharing);
    EXPECT_FALSE(loser.Returned());
    for (unsigned success = 0; success < 10; ++success)
    {
      manager->RollbackNotOccurred(0);
    }
    EXPECT_TRUE(loser.ReturnsSoon());
    EXPECT_TRUE(loser.Value());
  }
}

// A run is stopped while threads wait and help: all end, the owner's loop too.
TEST(LoopSharing, Stop)
{
  const Watchdog watchdog("stop");
  for (unsigned round = 0; round < 200; ++round)
  {
    LoopSharing sharing(4, Patient);
    const auto balancer = MakeLoadBalancer(BalancePolicy::Random, FlatTopology(4), &sharing);
    const auto manager = MakeContentionManager(ContentionPolicy::Local, 4, &sharing);
    std::atomic<unsigned> done{ 0 };
    {
      std::vector<std::jthread> waiting;
      waiting.emplace_back([&]() { EXPECT_FALSE(balancer->Beg(1)); });
      waiting.emplace_back([&]() { EXPECT_FALSE(balancer->Beg(2)); });
      waiting.emplace_back([&]() { manager->RollbackOccurred(3, 0); });
      waiting.emplace_back(
        [&]()
        {
          for (unsigned loop = 0; loop < 20; ++loop)
          {
            sharing.Run(0, 20, 1,
              [&](unsigned, std::size_t first, std::size_t last)
              { done += static_cast<unsigned>(last - first); });
          }
        });
      std::this_thread::sleep_for(std::chrono::microseconds(round));
      balancer->Stop();
      manager->Stop();
    }
    EXPECT_EQ(done, 400u);
  }
}

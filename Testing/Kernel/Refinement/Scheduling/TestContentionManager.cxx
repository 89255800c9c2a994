// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/ParkingSpot.h"
#include "Refinement/Scheduling/Contention/AggressiveContentionManager.h"
#include "Refinement/Scheduling/Contention/BlockingContentionManager.h"
#include "Refinement/Scheduling/Contention/GlobalContentionManager.h"
#include "Refinement/Scheduling/Contention/LocalContentionManager.h"
#include "Refinement/Scheduling/Contention/RandomContentionManager.h"
#include "Refinement/Scheduling/ContentionManager.h"
#include "Refinement/Scheduling/LoadBalancer.h"
#include "ThreadTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <barrier>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

using namespace voxplex;
using namespace voxplex::testing;

namespace
{

/** Enough successes in a row to wake one thread. */
void Succeed(ContentionManager& manager, unsigned thread, unsigned wakeUps = 1)
{
  for (unsigned i = 0; i < wakeUps * BlockingContentionManager::SuccessesToWake; ++i)
  {
    manager.RollbackNotOccurred(thread);
  }
}

/** A rollback in a thread of its own. */
std::unique_ptr<Call> Lose(ContentionManager& manager, unsigned thread, unsigned winner)
{
  return std::make_unique<Call>(
    [&manager, thread, winner]() { return manager.RollbackOccurred(thread, winner); });
}

template <typename Manager>
bool WaitsSoon(const Manager& manager, unsigned thread)
{
  return Soon([&manager, thread]() { return manager.IsWaiting(thread); });
}

/** A rollback in a thread of its own that is expected to wait. */
template <typename Manager>
std::unique_ptr<Call> LoseAndWait(Manager& manager, unsigned thread, unsigned winner)
{
  auto call = Lose(manager, thread, winner);
  EXPECT_TRUE(WaitsSoon(manager, thread)) << thread << " -> " << winner;
  return call;
}

double ProcessorSecondsOfThisThread()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

//----------------------------------------------------------------------------------------------
TEST(ParkingSpot, WakingBeforeWaitingCounts)
{
  const Watchdog watchdog("a wake-up before the wait is lost");
  ParkingSpot spot;
  spot.Prepare();
  EXPECT_TRUE(spot.IsTaken());
  spot.Wake();
  EXPECT_FALSE(spot.IsTaken());
  spot.Wait();
}

TEST(ParkingSpot, WakingNobodyIsForgotten)
{
  ParkingSpot spot;
  spot.Wake();
  spot.Prepare();
  EXPECT_TRUE(spot.IsTaken());
}

TEST(ParkingSpot, SleepsWhenItTakesLong)
{
  const Watchdog watchdog("a sleeping thread is not woken");
  ParkingSpot spot;
  spot.Prepare();
  double processorSeconds = 0.0;
  std::thread waiting(
    [&spot, &processorSeconds]()
    {
      const double before = ProcessorSecondsOfThisThread();
      spot.Wait();
      processorSeconds = ProcessorSecondsOfThisThread() - before;
    });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  spot.Wake();
  waiting.join();
  EXPECT_LT(processorSeconds, 0.05);
}

/** Two threads that wait for each other in turn, at all moments of the other's falling asleep. */
TEST(ParkingSpot, LosesNoWakeUp)
{
  const Watchdog watchdog("a wake-up is lost");
  constexpr unsigned rounds = 20000;
  std::array<ParkingSpot, 2> spots;
  unsigned ball = 0; // not atomic: the spots order it
  auto play = [&](unsigned me)
  {
    std::mt19937 random(me);
    for (unsigned round = 0; round < rounds; ++round)
    {
      if (me != 0 || round != 0)
      {
        spots[me].Wait();
      }
      ++ball;
      spots[me].Prepare(); // before the other can wake us
      const auto until =
        std::chrono::steady_clock::now() + std::chrono::nanoseconds(random() % 40000);
      while (random() % 8 == 0 && std::chrono::steady_clock::now() < until)
      {
      }
      if (round % 64 == 0)
      {
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 200));
      }
      spots[1 - me].Wake();
    }
  };
  spots[1].Prepare();
  std::thread other(play, 1);
  play(0);
  other.join();
  EXPECT_EQ(ball, 2 * rounds);
}

//----------------------------------------------------------------------------------------------
/** The thesis' figure 3.3; its threads 1 to 4 are 0 to 3 here. */
TEST(LocalContentionManager, Figure3_3)
{
  const Watchdog watchdog("figure 3.3");
  LocalContentionManager manager(4);
  // Steps 2 and 3: T1 and T4 lose against T2 and wait.
  auto t4 = LoseAndWait(manager, 3, 1);
  auto t1 = LoseAndWait(manager, 0, 1);
  // Step 4: T2 makes progress and wakes one, T4.
  for (unsigned i = 1; i < LocalContentionManager::SuccessesToWake; ++i)
  {
    manager.RollbackNotOccurred(1);
  }
  EXPECT_TRUE(Stays([&]() { return manager.IsWaiting(3); }));
  manager.RollbackNotOccurred(1);
  EXPECT_TRUE(t4->ReturnsSoon());
  EXPECT_TRUE(t4->Value());
  EXPECT_TRUE(manager.IsWaiting(0));
  // Steps 5 and 6: the cycle T2 -> T3 -> T4 -> T2; T4 decides first, then T2, then T3.
  t4 = LoseAndWait(manager, 3, 1);
  auto t2 = LoseAndWait(manager, 1, 2);
  EXPECT_FALSE(manager.RollbackOccurred(2, 3)) << "the last one breaks the cycle";
  EXPECT_TRUE(manager.IsWaiting(0)) << "who begins to wait wakes nobody";
  EXPECT_TRUE(manager.IsWaiting(3));
  // On: T3 wakes T2, and T2 wakes T1 and T4, in the order in which they came.
  Succeed(manager, 2);
  EXPECT_TRUE(t2->ReturnsSoon());
  Succeed(manager, 1);
  EXPECT_TRUE(t1->ReturnsSoon());
  EXPECT_TRUE(manager.IsWaiting(3));
  Succeed(manager, 1);
  EXPECT_TRUE(t4->ReturnsSoon());
}

TEST(LocalContentionManager, ARollbackBreaksTheRowOfSuccesses)
{
  const Watchdog watchdog("row of successes");
  LocalContentionManager manager(3);
  auto loser = LoseAndWait(manager, 1, 0);
  for (unsigned i = 1; i < LocalContentionManager::SuccessesToWake; ++i)
  {
    manager.RollbackNotOccurred(0);
  }
  EXPECT_FALSE(manager.RollbackOccurred(0, 1)) << "the winner waits";
  manager.RollbackNotOccurred(0);
  EXPECT_TRUE(Stays([&]() { return manager.IsWaiting(1); }));
  Succeed(manager, 0);
  EXPECT_TRUE(loser->ReturnsSoon());
}

TEST(LocalContentionManager, NobodyWaitsForAnIdleThread)
{
  const Watchdog watchdog("idle winner");
  LocalContentionManager manager(5);
  std::vector<std::unique_ptr<Call>> losers;
  for (unsigned t = 1; t < 4; ++t)
  {
    losers.push_back(LoseAndWait(manager, t, 0));
  }
  manager.BecomesIdle(0);
  for (const auto& loser : losers)
  {
    EXPECT_TRUE(loser->ReturnsSoon()) << "all are woken";
    EXPECT_TRUE(loser->Value());
  }
  const auto late = Lose(manager, 4, 0);
  EXPECT_TRUE(late->ReturnsSoon());
  EXPECT_FALSE(late->Value());

  manager.BecomesBusy(0);
  const auto again = LoseAndWait(manager, 4, 0);
  Succeed(manager, 0);
  EXPECT_TRUE(again->ReturnsSoon());
}

/**
 * Threads in a ring that all lose to their neighbour at once: some wait, some do not, and those
 * that do not are enough to wake all.
 */
class LosingRing : public ::testing::TestWithParam<unsigned>
{
};

TEST_P(LosingRing, SomeWaitAndSomeDoNot)
{
  const unsigned threads = this->GetParam();
  const Watchdog watchdog("a ring of " + std::to_string(threads));
  constexpr unsigned rounds = 1000;
  LocalContentionManager manager(threads);
  std::barrier together(static_cast<std::ptrdiff_t>(threads));
  std::atomic<unsigned> waited{ 0 };
  std::atomic<unsigned> wrong{ 0 };
  std::vector<std::jthread> ring;
  for (unsigned t = 0; t < threads; ++t)
  {
    ring.emplace_back(
      [&, t]()
      {
        for (unsigned round = 0; round < rounds; ++round)
        {
          together.arrive_and_wait();
          waited += manager.RollbackOccurred(t, (t + 1) % threads) ? 1 : 0;
          Succeed(manager, t);
          manager.BecomesIdle(t); // who loses to it now is too late to be woken by its successes
          together.arrive_and_wait();
          manager.BecomesBusy(t);
          if (t == 0)
          {
            wrong += waited == 0 || waited == threads ? 1 : 0;
            waited = 0;
          }
        }
      });
  }
  ring.clear(); // joins
  EXPECT_EQ(wrong, 0u);
}

INSTANTIATE_TEST_SUITE_P(Sizes, LosingRing, ::testing::Values(2u, 3u, 5u, 16u));

//----------------------------------------------------------------------------------------------
TEST(GlobalContentionManager, TheOnlyActiveThreadNeverWaits)
{
  const Watchdog watchdog("only one active");
  GlobalContentionManager alone(1);
  alone.BecomesIdle(0);
  alone.BecomesBusy(0);

  GlobalContentionManager manager(3);
  manager.BecomesIdle(2);
  auto loser = LoseAndWait(manager, 1, 0);
  EXPECT_FALSE(manager.RollbackOccurred(0, 1)) << "one waits, one is idle";
  EXPECT_FALSE(manager.RollbackOccurred(0, 2));
  Succeed(manager, 0);
  EXPECT_TRUE(loser->ReturnsSoon());
  // Who was woken is active again.
  loser = LoseAndWait(manager, 0, 1);
  manager.BecomesBusy(2);
  Succeed(manager, 2);
  EXPECT_TRUE(loser->ReturnsSoon());
}

TEST(GlobalContentionManager, FirstComeFirstServed)
{
  const Watchdog watchdog("first come, first served");
  GlobalContentionManager manager(4);
  std::vector<std::unique_ptr<Call>> losers;
  for (const unsigned t : { 2u, 0u, 3u })
  {
    losers.push_back(LoseAndWait(manager, t, 1));
  }
  for (std::size_t i = 0; i < losers.size(); ++i)
  {
    Succeed(manager, 1);
    EXPECT_TRUE(losers[i]->ReturnsSoon());
    EXPECT_EQ(
      static_cast<std::size_t>(manager.IsWaiting(2)) + manager.IsWaiting(0) + manager.IsWaiting(3),
      losers.size() - i - 1);
  }
}

TEST(GlobalContentionManager, TheLastActiveThreadWakesAnotherBeforeItBecomesIdle)
{
  const Watchdog watchdog("the last active thread becomes idle");
  GlobalContentionManager manager(4);
  auto first = LoseAndWait(manager, 1, 0);
  auto second = LoseAndWait(manager, 2, 0);
  manager.BecomesIdle(3);
  EXPECT_TRUE(Stays([&]() { return manager.IsWaiting(1); })) << "0 is still active";
  manager.BecomesIdle(0);
  EXPECT_TRUE(first->ReturnsSoon());
  EXPECT_TRUE(manager.IsWaiting(2));
  manager.BecomesIdle(1);
  EXPECT_TRUE(second->ReturnsSoon());
  manager.BecomesIdle(2);
}

//----------------------------------------------------------------------------------------------
TEST(AggressiveContentionManager, GoesOverToTheLocalOne)
{
  const Watchdog watchdog("aggressive");
  const unsigned limit = AggressiveContentionManager::RollbacksToSwitch;
  AggressiveContentionManager manager(4);
  manager.BecomesIdle(3);
  for (unsigned i = 0; i < limit; ++i)
  {
    EXPECT_FALSE(manager.RollbackOccurred(1, 0));
  }
  manager.RollbackNotOccurred(1);
  for (unsigned i = 0; i < limit; ++i)
  {
    EXPECT_FALSE(manager.RollbackOccurred(1, 0));
  }
  EXPECT_FALSE(manager.SwitchedToLocal()) << "a success begins a new row";
  const auto loser = Lose(manager, 1, 0);
  EXPECT_TRUE(Soon([&]() { return manager.SwitchedToLocal(); }));
  EXPECT_TRUE(Stays([&]() { return !loser->Returned(); }));
  EXPECT_FALSE(manager.RollbackOccurred(2, 1)) << "the winner waits";
  EXPECT_FALSE(manager.RollbackOccurred(2, 3)) << "the winner has been idle since before";
  Succeed(manager, 0);
  EXPECT_TRUE(loser->ReturnsSoon());
  EXPECT_TRUE(loser->Value());
}

TEST(RandomContentionManager, SleepsAfterSeveralRollbacksInARow)
{
  RandomContentionManager manager(2);
  for (int round = 0; round < 2; ++round)
  {
    for (unsigned i = 0; i < RandomContentionManager::RollbacksBeforeSleep; ++i)
    {
      EXPECT_FALSE(manager.RollbackOccurred(0, 1));
    }
    for (int i = 0; i < 3; ++i)
    {
      const auto start = std::chrono::steady_clock::now();
      EXPECT_TRUE(manager.RollbackOccurred(0, 1));
      EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::microseconds(900));
    }
    manager.RollbackNotOccurred(0);
  }
  EXPECT_FALSE(manager.SwitchedToLocal());
}

TEST(RandomContentionManager, GoesOverToTheLocalOne)
{
  const Watchdog watchdog("random");
  RandomContentionManager manager(2);
  for (unsigned i = 0; i < RandomContentionManager::SleepsToSwitch; ++i)
  {
    for (unsigned k = 0; i == 0 && k < RandomContentionManager::RollbacksBeforeSleep; ++k)
    {
      EXPECT_FALSE(manager.RollbackOccurred(0, 1));
    }
    EXPECT_TRUE(manager.RollbackOccurred(0, 1));
  }
  EXPECT_FALSE(manager.SwitchedToLocal());
  const auto loser = Lose(manager, 0, 1);
  EXPECT_TRUE(Soon([&]() { return manager.SwitchedToLocal(); }));
  EXPECT_TRUE(Stays([&]() { return !loser->Returned(); }));
  Succeed(manager, 1);
  EXPECT_TRUE(loser->ReturnsSoon());
}

//----------------------------------------------------------------------------------------------
TEST(ContentionManager, OneThreadAlone)
{
  const Watchdog watchdog("one thread alone");
  for (const ContentionPolicy policy : AllPolicies)
  {
    const auto manager = MakeContentionManager(policy, 1);
    Succeed(*manager, 0, 3);
    manager->BecomesIdle(0);
    manager->BecomesBusy(0);
    Succeed(*manager, 0);
    EXPECT_FALSE(manager->SwitchedToLocal());
    manager->Stop();
  }
}

TEST(ContentionManager, StopWakesAll)
{
  const Watchdog watchdog("Stop() leaves somebody waiting");
  LocalContentionManager local(4);
  GlobalContentionManager global(4);
  std::vector<std::unique_ptr<Call>> losers;
  losers.push_back(LoseAndWait(local, 1, 0));
  losers.push_back(LoseAndWait(local, 2, 0));
  losers.push_back(LoseAndWait(local, 0, 3));
  losers.push_back(LoseAndWait(global, 1, 0));
  losers.push_back(LoseAndWait(global, 2, 0));
  losers.push_back(LoseAndWait(global, 0, 3));
  local.Stop();
  global.Stop();
  for (const auto& loser : losers)
  {
    EXPECT_TRUE(loser->ReturnsSoon());
  }
}

TEST(ContentionManager, NobodyWaitsAfterStop)
{
  const Watchdog watchdog("somebody waits after Stop()");
  for (const ContentionPolicy policy : AllPolicies)
  {
    const auto manager = MakeContentionManager(policy, 3);
    manager->Stop();
    manager->Stop();
    for (unsigned i = 0; i < AggressiveContentionManager::RollbacksToSwitch + 10; ++i)
    {
      EXPECT_FALSE(manager->RollbackOccurred(1, 0)) << NameOf(policy);
    }
    manager->BecomesIdle(1);
    manager->BecomesBusy(1);
    Succeed(*manager, 1);
  }
}

/** Stop() while everybody loses to everybody, and nobody ever succeeds. */
TEST(ContentionManager, StopAtAnyTime)
{
  for (const ContentionPolicy policy : AllPolicies)
  {
    const Watchdog watchdog("Stop() in the midst of it, " + NameOf(policy));
    for (unsigned round = 0; round < 200; ++round)
    {
      constexpr unsigned threads = 6;
      const auto manager = MakeContentionManager(policy, threads);
      std::atomic<bool> stopped{ false };
      std::vector<std::jthread> losers;
      for (unsigned t = 0; t < threads; ++t)
      {
        losers.emplace_back(
          [&, t]()
          {
            std::mt19937 random(round * threads + t);
            while (!stopped.load(std::memory_order_relaxed))
            {
              manager->RollbackOccurred(
                t, (t + 1 + static_cast<unsigned>(random()) % (threads - 1)) % threads);
            }
          });
      }
      std::this_thread::sleep_for(std::chrono::microseconds(round * 7 % 500));
      stopped = true;
      manager->Stop();
    }
  }
}

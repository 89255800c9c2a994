// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Scheduling/BeggingLists.h"
#include "Refinement/Scheduling/LoadBalancer.h"
#include "ThreadTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

using namespace voxplex;
using namespace voxplex::testing;

namespace
{

constexpr unsigned Nobody = LoadBalancer::Nobody;

/** Sockets of `perSocket` threads in nodes of `perNode` threads. */
ProcessorTopology Regular(unsigned threads, unsigned perSocket, unsigned perNode)
{
  ProcessorTopology topology = FlatTopology(threads);
  for (unsigned t = 0; t < threads; ++t)
  {
    topology.Group[t] = { t / perSocket, t / perNode, 0 };
  }
  return topology;
}

/** Two nodes of two sockets of two threads: sockets {0,1} {2,3} | {4,5} {6,7}. */
ProcessorTopology EightThreads()
{
  return Regular(8, 2, 4);
}

/** A balancer, and a thread for each call of Beg(). */
class Scene
{
public:
  Scene(BalancePolicy policy, const ProcessorTopology& topology)
    : Flat(FlatTopology(static_cast<unsigned>(topology.Group.size())))
    , Balancer(policy == BalancePolicy::Hierarchical ? topology : this->Flat, topology)
    , Calls(topology.Group.size())
  {
  }
  ~Scene() { this->Balancer.Stop(); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /** Returns when the thread waits in a list. */
  void Begs(unsigned thread)
  {
    const unsigned before = this->Balancer.NumberOfBeggars();
    this->BegsLast(thread);
    EXPECT_TRUE(Soon([&]() { return this->Balancer.NumberOfBeggars() == before + 1; }));
  }
  /** Does not wait for anything. */
  void BegsLast(unsigned thread)
  {
    this->Calls[thread] =
      std::make_unique<Call>([this, thread]() { return this->Balancer.Beg(thread); });
  }
  /** The giver takes a beggar, which must be this one, on this level, and wakes it. */
  void ExpectGift(unsigned giver, unsigned beggar, unsigned level)
  {
    const LoadBalancer::Beggar taken = this->Balancer.TakeBeggar(giver);
    ASSERT_EQ(taken.Thread, beggar) << "giver " << giver;
    EXPECT_EQ(taken.Level, level) << "giver " << giver << ", beggar " << beggar;
    EXPECT_FALSE(this->Calls[beggar]->Returned()) << "it was taken, but not woken yet";
    this->Balancer.Wake(beggar);
    EXPECT_TRUE(this->Calls[beggar]->ReturnsSoon());
    EXPECT_TRUE(this->Calls[beggar]->Value());
  }
  void ExpectNobody(unsigned giver)
  {
    EXPECT_EQ(this->Balancer.TakeBeggar(giver).Thread, Nobody) << "giver " << giver;
  }
  void ExpectEnd(unsigned thread)
  {
    EXPECT_TRUE(this->Calls[thread]->ReturnsSoon()) << thread;
    EXPECT_FALSE(this->Calls[thread]->Value()) << thread;
  }

  const ProcessorTopology Flat;
  BeggingLists Balancer;
  std::vector<std::unique_ptr<Call>> Calls;
};

} // namespace

//----------------------------------------------------------------------------------------------
TEST(RandomWorkStealing, FirstComeFirstServed)
{
  const Watchdog watchdog("RWS");
  Scene scene(BalancePolicy::Random, EightThreads());
  EXPECT_FALSE(scene.Balancer.SomeoneBegs());
  scene.ExpectNobody(0);
  for (const unsigned beggar : { 4u, 1u, 2u, 7u })
  {
    scene.Begs(beggar);
  }
  EXPECT_TRUE(scene.Balancer.SomeoneBegs());
  // The order does not depend on the thread that gives. The level of each gift is told nevertheless.
  scene.ExpectGift(0, 4, 2);
  scene.ExpectGift(0, 1, 0);
  scene.ExpectGift(0, 2, 1);
  scene.ExpectGift(6, 7, 0);
  scene.ExpectNobody(0);
  EXPECT_FALSE(scene.Balancer.SomeoneBegs());
}

TEST(HierarchicalWorkStealing, OneOfASocketStaysInIt)
{
  const Watchdog watchdog("HWS, level 1");
  Scene scene(BalancePolicy::Hierarchical, EightThreads());
  scene.Begs(1);
  EXPECT_TRUE(scene.Balancer.SomeoneBegs());
  scene.ExpectNobody(2);
  scene.ExpectNobody(7);
  scene.ExpectGift(0, 1, 0);
  EXPECT_FALSE(scene.Balancer.SomeoneBegs());
}

TEST(HierarchicalWorkStealing, TheLastOfASocketAsksTheNode)
{
  const Watchdog watchdog("HWS, level 2");
  Scene scene(BalancePolicy::Hierarchical, EightThreads());
  scene.Begs(2);
  scene.Begs(3);
  scene.ExpectNobody(4); // another node
  scene.ExpectGift(0, 3, 1);
  scene.ExpectNobody(0);     // 2 waits for 3
  scene.ExpectGift(3, 2, 0); // which brings work home
  // The other way round.
  scene.Begs(3);
  scene.Begs(2);
  scene.ExpectGift(1, 2, 1);
  scene.ExpectGift(2, 3, 0);
}

TEST(HierarchicalWorkStealing, TheLastOfANodeAsksAll)
{
  const Watchdog watchdog("HWS, level 3");
  Scene scene(BalancePolicy::Hierarchical, EightThreads());
  scene.Begs(4); // socket {4,5}
  scene.Begs(5); // node {4,5,6,7}
  scene.Begs(6); // socket {6,7}
  scene.Begs(7); // all
  scene.ExpectGift(0, 7, 2);
  scene.ExpectNobody(0);
  scene.ExpectGift(7, 6, 0);
  scene.ExpectGift(7, 5, 1);
  scene.ExpectNobody(7);
  scene.ExpectGift(5, 4, 0);
  EXPECT_FALSE(scene.Balancer.SomeoneBegs());
}

TEST(HierarchicalWorkStealing, TheNearestFirst)
{
  const Watchdog watchdog("HWS, nearest first");
  Scene scene(BalancePolicy::Hierarchical, EightThreads());
  for (const unsigned beggar : { 4u, 5u, 6u, 7u, 2u, 3u, 1u }) // the nearest last
  {
    scene.Begs(beggar);
  }
  scene.ExpectGift(0, 1, 0);
  scene.ExpectGift(0, 3, 1);
  scene.ExpectGift(0, 7, 2);
  scene.ExpectNobody(0);
}

TEST(HierarchicalWorkStealing, SocketsOfOneThreadHaveNoFirstLevel)
{
  const Watchdog watchdog("HWS, one thread a socket");
  Scene scene(BalancePolicy::Hierarchical, Regular(4, 1, 2));
  scene.Begs(3);
  scene.ExpectNobody(0);
  scene.ExpectGift(2, 3, 1);
  scene.Begs(3);
  scene.Begs(2);
  scene.Begs(1);
  scene.ExpectGift(0, 1, 1);
  scene.ExpectGift(0, 2, 2);
  scene.ExpectNobody(0);
  scene.ExpectGift(2, 3, 1);
}

/** Where sockets and NUMA nodes are the same: the last of a socket asks all at once. */
TEST(HierarchicalWorkStealing, NodesOfOneSocketHaveNoSecondLevel)
{
  const Watchdog watchdog("HWS, one socket a node");
  Scene scene(BalancePolicy::Hierarchical, Regular(6, 2, 2));
  for (const unsigned beggar : { 2u, 3u, 4u, 5u })
  {
    scene.Begs(beggar);
  }
  scene.ExpectGift(0, 3, 2);
  scene.ExpectGift(0, 5, 2);
  scene.ExpectNobody(0);
  scene.ExpectGift(5, 4, 0);
  scene.ExpectGift(3, 2, 0);
}

/** Groups of different sizes, whose numbers have gaps. */
TEST(HierarchicalWorkStealing, UnevenGroups)
{
  const Watchdog watchdog("HWS, uneven groups");
  ProcessorTopology topology = FlatTopology(6);
  topology.Group = { { 9, 4, 0 }, { 9, 4, 0 }, { 9, 4, 0 }, { 2, 4, 0 }, { 7, 1, 0 }, { 7, 1, 0 } };
  Scene scene(BalancePolicy::Hierarchical, topology);
  scene.Begs(3);
  scene.ExpectNobody(4);
  scene.ExpectGift(1, 3, 1);
  scene.Begs(0);
  scene.Begs(1);
  scene.ExpectNobody(3); // 2 still works
  scene.Begs(2);
  scene.ExpectGift(3, 2, 1);
  scene.Begs(2);
  scene.Begs(3);
  scene.ExpectGift(4, 3, 2);
  scene.ExpectGift(3, 2, 1);
  scene.ExpectGift(2, 0, 0);
  scene.ExpectGift(2, 1, 0);
}

//----------------------------------------------------------------------------------------------
class BothBalancers : public ::testing::TestWithParam<BalancePolicy>
{
};

TEST_P(BothBalancers, OneThreadAlone)
{
  const Watchdog watchdog("one thread alone");
  const auto balancer = MakeLoadBalancer(this->GetParam(), FlatTopology(1));
  EXPECT_FALSE(balancer->SomeoneBegs());
  EXPECT_EQ(balancer->TakeBeggar(0).Thread, Nobody);
  EXPECT_FALSE(balancer->Beg(0));
  EXPECT_FALSE(balancer->Beg(0));
}

/** One thread has work, all others beg. Each of them gets some, in any order and on any processor. */
TEST_P(BothBalancers, EverybodyGetsWorkFromOne)
{
  const Watchdog watchdog("work from one");
  std::mt19937 random(1);
  for (unsigned round = 0; round < 50; ++round)
  {
    Scene scene(this->GetParam(), EightThreads());
    std::vector<unsigned> order(8);
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);
    const unsigned rich = order.back();
    order.pop_back();
    for (const unsigned beggar : order)
    {
      scene.Begs(beggar);
    }
    // A thread with work serves all that it may, and so do those that it serves.
    std::vector<unsigned> givers = { rich };
    for (std::size_t i = 0; i < givers.size(); ++i)
    {
      for (auto beggar = scene.Balancer.TakeBeggar(givers[i]); beggar.Thread != Nobody;
           beggar = scene.Balancer.TakeBeggar(givers[i]))
      {
        scene.Balancer.Wake(beggar.Thread);
        EXPECT_TRUE(scene.Calls[beggar.Thread]->ReturnsSoon());
        EXPECT_TRUE(scene.Calls[beggar.Thread]->Value());
        givers.push_back(beggar.Thread);
      }
    }
    EXPECT_EQ(givers.size(), 8u) << "round " << round;
  }
}

TEST_P(BothBalancers, EndsWhenAllBeg)
{
  const Watchdog watchdog("the end");
  std::mt19937 random(2);
  for (const ProcessorTopology& topology :
    { FlatTopology(8), EightThreads(), Regular(8, 1, 1), Regular(8, 3, 6), Regular(8, 4, 8) })
  {
    for (unsigned round = 0; round < 20; ++round)
    {
      Scene scene(this->GetParam(), topology);
      std::vector<unsigned> order(8);
      std::iota(order.begin(), order.end(), 0u);
      std::shuffle(order.begin(), order.end(), random);
      for (unsigned i = 0; i < 7; ++i)
      {
        scene.Begs(order[i]);
      }
      for (unsigned i = 0; i < 7; ++i)
      {
        EXPECT_FALSE(scene.Calls[order[i]]->Returned()) << "one still works";
      }
      scene.BegsLast(order[7]);
      for (unsigned t = 0; t < 8; ++t)
      {
        scene.ExpectEnd(t);
      }
      EXPECT_FALSE(scene.Balancer.Beg(3)) << "it is over";
      scene.ExpectNobody(0);
    }
  }
}

TEST_P(BothBalancers, WhoWasTakenCountsAsBusy)
{
  const Watchdog watchdog("taken, not woken");
  Scene scene(this->GetParam(), FlatTopology(2));
  scene.Begs(1);
  EXPECT_EQ(scene.Balancer.TakeBeggar(0).Thread, 1u);
  scene.Begs(0); // must not end all: 1 is about to get work
  EXPECT_TRUE(Stays([&]() { return !scene.Calls[0]->Returned() && !scene.Calls[1]->Returned(); }));
  scene.Balancer.Wake(1);
  EXPECT_TRUE(scene.Calls[1]->ReturnsSoon());
  EXPECT_TRUE(scene.Calls[1]->Value());
  scene.ExpectGift(1, 0, 0);
}

TEST_P(BothBalancers, Stop)
{
  const Watchdog watchdog("Stop()");
  Scene scene(this->GetParam(), EightThreads());
  for (const unsigned beggar : { 0u, 2u, 3u, 4u, 6u })
  {
    scene.Begs(beggar);
  }
  EXPECT_EQ(scene.Balancer.TakeBeggar(1).Thread, 0u); // never woken by its giver
  scene.Balancer.Stop();
  for (const unsigned beggar : { 0u, 2u, 3u, 4u, 6u })
  {
    scene.ExpectEnd(beggar);
  }
  EXPECT_FALSE(scene.Balancer.Beg(7));
  scene.ExpectNobody(1);
  scene.Balancer.Stop();
}

TEST_P(BothBalancers, StopAtAnyTime)
{
  const Watchdog watchdog("Stop() at any time");
  for (unsigned round = 0; round < 300; ++round)
  {
    const auto balancer = MakeLoadBalancer(this->GetParam(), EightThreads());
    std::vector<std::jthread> beggars;
    for (unsigned t = 1; t < 8; ++t)
    {
      beggars.emplace_back([&balancer, t]() { EXPECT_FALSE(balancer->Beg(t)); });
    }
    std::this_thread::sleep_for(std::chrono::microseconds(round));
    balancer->Stop();
  }
}

//----------------------------------------------------------------------------------------------
namespace
{

/** Threads that pass work around until there is none. */
class Economy
{
public:
  Economy(BalancePolicy policy, const ProcessorTopology& topology, unsigned seed)
    : Seed(seed)
    , Balancer(MakeLoadBalancer(policy, topology))
    , Purses(topology.Group.size())
  {
  }

  void Run(unsigned work)
  {
    this->Purses[0].Work = work;
    std::vector<std::jthread> others;
    for (unsigned t = 1; t < this->Purses.size(); ++t)
    {
      others.emplace_back([this, t]() { this->Live(t); });
    }
    this->Live(0);
  }

  unsigned WorkDone() const
  {
    unsigned done = 0;
    for (const Purse& purse : this->Purses)
    {
      EXPECT_EQ(purse.Work, 0u);
      done += purse.Done;
    }
    return done;
  }

private:
  struct alignas(64) Purse
  {
    unsigned Work = 0; ///< not atomic: written by givers, ordered by Wake()
    unsigned Done = 0;
  };

  void Live(unsigned me)
  {
    std::mt19937 random(this->Seed * 1000 + me);
    Purse& mine = this->Purses[me];
    do
    {
      while (mine.Work > 0)
      {
        --mine.Work;
        ++mine.Done;
        if (random() % 4 == 0)
        {
          std::this_thread::yield();
        }
        if (this->Balancer->SomeoneBegs())
        {
          this->Give(me, mine, random);
        }
      }
    } while (this->Balancer->Beg(me));
  }

  void Give(unsigned me, Purse& mine, std::mt19937& random)
  {
    const LoadBalancer::Beggar beggar = this->Balancer->TakeBeggar(me);
    if (beggar.Thread == Nobody)
    {
      return;
    }
    const unsigned gift = static_cast<unsigned>(random()) % (mine.Work + 1); // all, or nothing
    this->Purses[beggar.Thread].Work = gift;
    mine.Work -= gift;
    if (random() % 8 == 0)
    {
      std::this_thread::yield();
    }
    this->Balancer->Wake(beggar.Thread);
  }

  const unsigned Seed;
  std::unique_ptr<LoadBalancer> Balancer;
  std::vector<Purse> Purses;
};

} // namespace

TEST_P(BothBalancers, AllWorkIsDoneAndThenAllEnd)
{
  constexpr unsigned work = 2000;
  unsigned seed = 0;
  for (const ProcessorTopology& topology : { FlatTopology(2), FlatTopology(16), Regular(16, 4, 8),
         Regular(16, 1, 2), Regular(13, 3, 6), Regular(16, 2, 2), Regular(5, 1, 1) })
  {
    for (unsigned round = 0; round < 5; ++round)
    {
      ++seed;
      const Watchdog watchdog("economy, seed " + std::to_string(seed));
      Economy economy(this->GetParam(), topology, seed);
      economy.Run(work);
      EXPECT_EQ(economy.WorkDone(), work) << "seed " << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Policies, BothBalancers,
  ::testing::Values(BalancePolicy::Random, BalancePolicy::Hierarchical),
  [](const auto& chosen)
  { return std::string(BalancePolicyNames[static_cast<std::size_t>(chosen.param)]); });

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// All contention managers with all load balancers, in a refinement without a mesh.
#include "Refinement/Scheduling/ContentionManager.h"
#include "Refinement/Scheduling/LoadBalancer.h"
#include "ThreadTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

using namespace voxplex;
using namespace voxplex::testing;

// Refinement without a mesh: an operation takes a few of some tokens, as one on a mesh takes
// vertices.
namespace
{

struct Workload
{
  const char* Name;
  unsigned Threads;
  unsigned Tokens;
  unsigned TokensOfOperation;
  unsigned Operations;
};

std::ostream& operator<<(std::ostream& stream, const Workload& load)
{
  return stream << load.Name;
}

class SimulatedRefinement
{
public:
  SimulatedRefinement(
    ContentionPolicy contention, BalancePolicy balance, const Workload& load, std::uint64_t seed)
    : Load(load)
    , Seed(seed)
    , Topo(FourSockets(load.Threads))
    , Contention(MakeContentionManager(contention, load.Threads))
    , Balance(MakeLoadBalancer(balance, this->Topo))
    , Tokens(load.Tokens)
    , Workers(load.Threads)
  {
  }

  /** All threads from the first element to the last; returns when all have ended. */
  void Run()
  {
    this->Workers[0].Elements = 1;
    std::vector<std::jthread> others;
    for (unsigned t = 1; t < this->Load.Threads; ++t)
    {
      others.emplace_back([this, t]() { this->Work(t); });
    }
    this->Work(0);
  }

  void Stop()
  {
    this->Stopped = true;
    this->Contention->Stop();
    this->Balance->Stop();
  }

  struct Counts
  {
    unsigned Rollbacks = 0;
    unsigned Waits = 0;
    unsigned Gifts = 0;
  };
  /** Adds what happened. After the run. */
  void AddTo(Counts& counts) const
  {
    for (const Worker& worker : this->Workers)
    {
      counts.Rollbacks += worker.Rollbacks;
      counts.Waits += worker.Waits;
      counts.Gifts += worker.Gifts;
    }
  }

  void ExpectAllDone() const
  {
    EXPECT_EQ(this->Done, this->Load.Operations);
    std::uint64_t uses = 0;
    for (const Token& token : this->Tokens)
    {
      EXPECT_EQ(token.Owner, Free);
      uses += token.Uses;
    }
    EXPECT_EQ(uses, std::uint64_t(this->Done) * this->Load.TokensOfOperation);
    for (const Worker& worker : this->Workers)
    {
      EXPECT_EQ(worker.Elements, 0u);
    }
  }

private:
  static constexpr unsigned Free = 0; ///< else the owner's number plus one
  static constexpr unsigned EnoughToGive = 3;

  struct Token
  {
    std::atomic<unsigned> Owner{ Free };
    std::uint64_t Uses = 0; ///< changed by the owner: the sanitizer sees if there are two
  };
  struct alignas(64) Worker
  {
    unsigned Elements = 0; ///< written by givers while this one begs
    unsigned Rollbacks = 0;
    unsigned Waits = 0;
    unsigned Gifts = 0;
  };

  static ProcessorTopology FourSockets(unsigned threads)
  {
    ProcessorTopology topology = FlatTopology(threads);
    for (unsigned t = 0; t < threads; ++t)
    {
      topology.Group[t] = { t * 4 / threads, t * 2 / threads, 0 };
    }
    return topology;
  }

  void Work(unsigned me)
  {
    std::mt19937_64 random(this->Seed * 1000 + me);
    while (!this->Stopped.load(std::memory_order_relaxed))
    {
      if (this->Workers[me].Elements == 0)
      {
        this->Contention->BecomesIdle(me);
        if (!this->Balance->Beg(me))
        {
          return;
        }
        this->Contention->BecomesBusy(me);
        continue;
      }
      const unsigned winner = this->Operate(me, random);
      if (winner != Free)
      {
        ++this->Workers[me].Rollbacks;
        this->Workers[me].Waits += this->Contention->RollbackOccurred(me, winner - 1) ? 1 : 0;
        continue;
      }
      this->Contention->RollbackNotOccurred(me);
      this->Give(me, random);
    }
  }

  /** One operation on random tokens. Returns who held one of them, or Free if it is done. */
  unsigned Operate(unsigned me, std::mt19937_64& random)
  {
    std::vector<unsigned> held;
    unsigned winner = Free;
    while (held.size() < this->Load.TokensOfOperation && winner == Free)
    {
      const auto token = static_cast<unsigned>(random() % this->Load.Tokens);
      unsigned owner = Free;
      if (this->Tokens[token].Owner.compare_exchange_strong(
            owner, me + 1, std::memory_order_acquire, std::memory_order_relaxed))
      {
        held.push_back(token);
        if (random() % 4 == 0)
        {
          std::this_thread::yield(); // lets others run into what we hold
        }
      }
      else if (owner != me + 1)
      {
        winner = owner;
      }
    }
    if (winner == Free)
    {
      this->Change(me, held, random);
    }
    for (const unsigned token : held)
    {
      this->Tokens[token].Owner.store(Free, std::memory_order_release);
    }
    return winner;
  }

  /**
   * The element is replaced by none, one or two, as many on average: so threads run out of work all
   * the time. Thread 0 never does before all operations are handed out.
   */
  void Change(unsigned me, const std::vector<unsigned>& held, std::mt19937_64& random)
  {
    for (const unsigned token : held)
    {
      ++this->Tokens[token].Uses;
    }
    unsigned& elements = this->Workers[me].Elements;
    --elements;
    auto children = static_cast<unsigned>(random() % 3);
    if (me == 0 && elements == 0)
    {
      children = std::max(children, 1u);
    }
    for (unsigned i = 0; i < children; ++i)
    {
      if (this->Created.fetch_add(1, std::memory_order_relaxed) < this->Load.Operations)
      {
        ++elements;
      }
    }
    this->Done.fetch_add(1, std::memory_order_relaxed);
  }

  void Give(unsigned me, std::mt19937_64& random)
  {
    unsigned& elements = this->Workers[me].Elements;
    if (!this->Balance->SomeoneBegs() || elements < EnoughToGive)
    {
      return;
    }
    const LoadBalancer::Beggar beggar = this->Balance->TakeBeggar(me);
    if (beggar.Thread == LoadBalancer::Nobody)
    {
      return;
    }
    EXPECT_NE(beggar.Thread, me);
    EXPECT_EQ(this->Workers[beggar.Thread].Elements, 0u);
    if (random() % 16 == 0)
    {
      std::this_thread::yield();
    }
    const unsigned gift = random() % 16 == 0 ? 0 : elements / 2; // nothing, now and then
    this->Workers[beggar.Thread].Elements = gift;
    elements -= gift;
    ++this->Workers[me].Gifts;
    this->Balance->Wake(beggar.Thread);
  }

  const Workload Load;
  const std::uint64_t Seed;
  const ProcessorTopology Topo;
  std::unique_ptr<ContentionManager> Contention;
  std::unique_ptr<LoadBalancer> Balance;
  std::vector<Token> Tokens;
  std::vector<Worker> Workers;
  std::atomic<unsigned> Created{ 1 };
  std::atomic<unsigned> Done{ 0 };
  std::atomic<bool> Stopped{ false };
};

} // namespace

class AllPoliciesTogether
  : public ::testing::TestWithParam<std::tuple<ContentionPolicy, BalancePolicy, Workload>>
{
public:
  std::string Describe(std::uint64_t seed) const
  {
    return NameOf(std::get<0>(this->GetParam())) + ", " +
      std::string(BalancePolicyNames[static_cast<std::size_t>(std::get<1>(this->GetParam()))]) +
      ", " + std::get<2>(this->GetParam()).Name + ", seed " + std::to_string(seed);
  }
  SimulatedRefinement Simulate(std::uint64_t seed) const
  {
    const auto& [contention, balance, load] = this->GetParam();
    return { contention, balance, load, seed };
  }
};

TEST_P(AllPoliciesTogether, RunsToTheEnd)
{
  SimulatedRefinement::Counts counts;
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE(this->Describe(seed));
    const Watchdog watchdog(this->Describe(seed));
    SimulatedRefinement simulation = this->Simulate(seed);
    simulation.Run();
    simulation.ExpectAllDone();
    simulation.AddTo(counts);
  }
  // Else the test would be worth nothing.
  EXPECT_GT(counts.Rollbacks, 0u);
  EXPECT_GT(counts.Gifts, 0u);
  const ContentionPolicy policy = std::get<0>(this->GetParam());
  if (policy == ContentionPolicy::Local || policy == ContentionPolicy::Global)
  {
    EXPECT_GT(counts.Waits, 0u);
  }
  this->RecordProperty("Rollbacks", static_cast<int>(counts.Rollbacks));
  this->RecordProperty("Waits", static_cast<int>(counts.Waits));
  this->RecordProperty("Gifts", static_cast<int>(counts.Gifts));
}

TEST_P(AllPoliciesTogether, CanBeStopped)
{
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
  {
    const Watchdog watchdog("stopped: " + this->Describe(seed));
    SimulatedRefinement simulation = this->Simulate(seed);
    std::jthread run([&simulation]() { simulation.Run(); });
    std::this_thread::sleep_for(std::chrono::microseconds((seed * seed * 37) % 3000));
    simulation.Stop();
  }
}

// One token: nobody can work beside another. As many threads as processors, and many more.
INSTANTIATE_TEST_SUITE_P(Stress, AllPoliciesTogether,
  ::testing::Combine(::testing::ValuesIn(AllPolicies),
    ::testing::Values(BalancePolicy::Random, BalancePolicy::Hierarchical),
    ::testing::Values(Workload{ "TwoThreads", 2, 6, 3, 10000 },
      Workload{ "ManyThreads", 16, 60, 4, 10000 },
      Workload{ "ManyThreadsFewTokens", 16, 5, 3, 5000 },
      Workload{ "ManyThreadsOneToken", 16, 1, 1, 5000 })),
  [](const auto& chosen)
  {
    std::string name = NameOf(std::get<0>(chosen.param)) + "_" +
      std::string(BalancePolicyNames[static_cast<std::size_t>(std::get<1>(chosen.param))]) + "_" +
      std::get<2>(chosen.param).Name;
    return name;
  });

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/ThreadTeam.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cassert>
#include <exception>
#include <utility>

namespace voxplex
{

namespace
{

thread_local ThreadTeam* Led = nullptr; ///< the latest team of this thread

} // namespace

//------------------------------------------------------------------------------------------------
ThreadTeam::ThreadTeam(unsigned threads)
{
  const unsigned wanted = NumberOfThreads(threads) - 1;
  this->Helpers.reserve(wanted);
  try
  {
    while (this->Helpers.size() < wanted)
    {
      auto helper = std::make_unique<Helper>();
      helper->Spot.Prepare();
      const std::size_t thread = this->Helpers.size() + 1;
      helper->Thread =
        std::thread([this, &waiting = *helper, thread] { this->Help(waiting, thread); });
      this->Helpers.push_back(std::move(helper));
    }
  }
  catch (const std::exception&)
  {
    // The system cannot start more threads, or has no memory for them: the team has those that run.
  }
  this->Before = std::exchange(Led, this);
}

ThreadTeam::~ThreadTeam()
{
  assert(Led == this);
  Led = this->Before;
  this->Call = nullptr;
  for (const std::unique_ptr<Helper>& helper : this->Helpers)
  {
    helper->Spot.Wake();
    helper->Thread.join();
  }
}

//------------------------------------------------------------------------------------------------
ThreadTeam* ThreadTeam::Idle()
{
  return Led && !Led->IsRunning ? Led : nullptr;
}

//------------------------------------------------------------------------------------------------
void ThreadTeam::Run(std::size_t helpers, Function function, void* data)
{
  helpers = std::min(helpers, this->Helpers.size());
  this->IsRunning = true;
  this->Call = function;
  this->Data = data;
  this->Left.store(helpers, std::memory_order_relaxed);
  this->LeadersSpot.Prepare();
  for (std::size_t h = 0; h < helpers; ++h)
  {
    this->Helpers[h]->Spot.Wake();
  }
  function(data, 0);
  if (helpers != 0)
  {
    this->LeadersSpot.Wait();
  }
  this->IsRunning = false;
}

//------------------------------------------------------------------------------------------------
void ThreadTeam::Help(Helper& helper, std::size_t thread)
{
  for (helper.Spot.Wait(); this->Call; helper.Spot.Wait())
  {
    this->Call(this->Data, thread);
    helper.Spot.Prepare(); // before the leader can wake it again
    if (this->Left.fetch_sub(1, std::memory_order_acq_rel) == 1)
    {
      this->LeadersSpot.Wake();
    }
  }
}

} // namespace voxplex

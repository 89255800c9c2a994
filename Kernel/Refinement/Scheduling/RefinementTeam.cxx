// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Scheduling/RefinementTeam.h"

#include <algorithm>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

/** Holds threads back until their number is known. */
class StartingLine
{
public:
  enum State
  {
    Closed,
    Open,
    Called ///< the start is cancelled
  };
  void Set(State state)
  {
    this->Value.store(state, std::memory_order_release);
    this->Value.notify_all();
  }
  /** @return true if the thread may start */
  bool Wait() const
  {
    this->Value.wait(Closed, std::memory_order_acquire);
    return this->Value.load(std::memory_order_acquire) == Open;
  }

private:
  std::atomic<int> Value{ Closed };
};

} // namespace

//------------------------------------------------------------------------------------------------
RefinementTeam::RefinementTeam(const TeamOptions& options)
  : Options(options)
{
}

RefinementTeam::~RefinementTeam() = default;

//------------------------------------------------------------------------------------------------
void RefinementTeam::Run(const std::function<void(unsigned threads)>& prepare,
  const std::function<void(unsigned thread)>& task)
{
  const unsigned wanted = std::max(1u, this->Options.Threads);
  this->Placement = DiscoverTopology(wanted);
  StartingLine line;
  std::vector<std::jthread> threads;
  const unsigned first = this->Options.Pin ? 0 : 1;
  threads.reserve(wanted);
  try
  {
    for (unsigned t = first; t < wanted; ++t)
    {
      threads.emplace_back(
        [this, t, &line, &task]
        {
          if (!line.Wait())
          {
            return;
          }
          if (this->Options.Pin)
          {
            // If pinning fails, the thread runs on any processor.
            PinThisThread(this->Placement, t);
          }
          this->RunGuarded(t, task);
        });
    }
  }
  catch (const std::system_error&)
  {
    // The system gives no more threads: the existing ones do the work.
  }
  catch (...)
  {
    line.Set(StartingLine::Called);
    throw;
  }
  const bool callerWorks = first == 1 || threads.empty();
  try
  {
    const unsigned number = std::max(1u, static_cast<unsigned>(threads.size()) + first);
    this->Placement.Group.resize(number);
    if (this->Options.FineGrained)
    {
      this->Sharing = std::make_unique<LoopSharing>(number);
    }
    this->Manager = MakeContentionManager(
      this->Options.Contention, number, this->Sharing.get(), this->Options.SuccessesToWake);
    this->Balancer = MakeLoadBalancer(this->Options.Balance, this->Placement, this->Sharing.get());
    prepare(number);
  }
  catch (...)
  {
    line.Set(StartingLine::Called);
    throw;
  }
  line.Set(StartingLine::Open);
  if (callerWorks)
  {
    this->RunGuarded(0, task);
  }
  threads.clear(); // joins
  if (this->Error)
  {
    std::rethrow_exception(this->Error);
  }
}

//------------------------------------------------------------------------------------------------
void RefinementTeam::RunGuarded(unsigned thread, const std::function<void(unsigned thread)>& task)
{
  try
  {
    task(thread);
  }
  catch (...)
  {
    this->Fail(std::current_exception());
  }
}

//------------------------------------------------------------------------------------------------
void RefinementTeam::Fail(std::exception_ptr error)
{
  {
    const std::scoped_lock lock(this->ErrorMutex);
    if (!this->Error)
    {
      this->Error = std::move(error);
    }
  }
  this->Stop();
}

//------------------------------------------------------------------------------------------------
void RefinementTeam::Stop()
{
  this->StopFlag.store(true, std::memory_order_relaxed);
  this->Manager->Stop();
  this->Balancer->Stop();
}

} // namespace voxplex

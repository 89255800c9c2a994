// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementTeam.h
 * @brief The threads that refine together: their start, their end, and what they share beside the
 * mesh.
 */
#ifndef voxplex_RefinementTeam_h
#define voxplex_RefinementTeam_h

#include "Parallel/LoopSharing.h"
#include "Parallel/ProcessorTopology.h"
#include "Refinement/Scheduling/ContentionManager.h"
#include "Refinement/Scheduling/LoadBalancer.h"
#include "Refinement/Scheduling/TeamOptions.h"

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>

namespace voxplex
{

/**
 * @brief Runs one task in several threads, with a contention manager and a load balancer.
 *
 * If the task throws in one thread, the other threads are stopped, and Run() throws the first
 * exception.
 */
class RefinementTeam
{
public:
  explicit RefinementTeam(const TeamOptions& options);
  ~RefinementTeam();
  RefinementTeam(const RefinementTeam&) = delete;
  RefinementTeam& operator=(const RefinementTeam&) = delete;

  /**
   * Starts the threads and calls prepare(n) in the calling thread. n is the number of threads:
   * fewer than in the options if the system gives no more. Then calls task(t) in each thread, t = 0
   * ... n-1. The calling thread is number 0, unless threads are pinned: the calling thread is never
   * pinned. Returns when all threads have ended.
   */
  void Run(const std::function<void(unsigned threads)>& prepare,
    const std::function<void(unsigned thread)>& task);

  /**
   * Ends the run soon: no thread waits any more, and Stopped() is true. Any thread may call this
   * while the task runs.
   */
  void Stop();
  bool Stopped() const { return this->StopFlag.load(std::memory_order_relaxed); }

  /** Valid from prepare() on. */
  const ProcessorTopology& Places() const { return this->Placement; }
  ContentionManager& Contention() { return *this->Manager; }
  LoadBalancer& Balance() { return *this->Balancer; }
  /** Null unless FineGrained. */
  LoopSharing* Help() const { return this->Sharing.get(); }

private:
  void RunGuarded(unsigned thread, const std::function<void(unsigned thread)>& task);
  void Fail(std::exception_ptr error);

  const TeamOptions Options;
  ProcessorTopology Placement;
  std::atomic<bool> StopFlag{ false };
  std::unique_ptr<LoopSharing> Sharing; ///< declared before its users
  std::unique_ptr<ContentionManager> Manager;
  std::unique_ptr<LoadBalancer> Balancer;
  std::mutex ErrorMutex;
  std::exception_ptr Error;
};

} // namespace voxplex

#endif

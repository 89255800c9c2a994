// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementTeam.h
 * @brief The threads that refine together: their start, their end, what they share beside the mesh.
 */
#ifndef voxplex_RefinementTeam_h
#define voxplex_RefinementTeam_h

#include "Parallel/LoopSharing.h"
#include "Parallel/ProcessorTopology.h"
#include "Refinement/ContentionManager.h"
#include "Refinement/LoadBalancer.h"

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>

namespace voxplex
{

/** How many threads refine, and how. */
struct TeamOptions
{
  unsigned Threads = 1;
  ContentionPolicy Contention = ContentionPolicy::Local;
  /** Global and local: after how many successes in a row a thread wakes one that waits. */
  unsigned SuccessesToWake = 10;
  BalancePolicy Balance = BalancePolicy::Hierarchical;
  bool Pin = false;
  /** Run the code for several threads with one thread too: tells what its locks and clocks cost. */
  bool Synchronise = false;
  /** Take simplices out of the lists of poor elements when they die, not when they come up. */
  bool RemoveEagerly = false;
  /** Let threads that wait help with the insertions of others (thesis, section 4.6.2). */
  bool FineGrained = false;
  /** Lattice nodes a thread, about, from which interfaces are sampled before the start; 0 for none. */
  unsigned SeedsPerThread = 128;
};

/**
 * @brief Runs one task in several threads that know a contention manager and a load balancer.
 *
 * If the task throws in one thread, the others are stopped and Run() throws what the first threw.
 */
class RefinementTeam
{
public:
  explicit RefinementTeam(const TeamOptions& options);
  ~RefinementTeam();
  RefinementTeam(const RefinementTeam&) = delete;
  RefinementTeam& operator=(const RefinementTeam&) = delete;

  /**
   * Starts the threads and calls prepare(n) in the calling thread, where n is how many there are: fewer
   * than asked for if the system gives no more. Then calls task(t) in each, t = 0 ... n-1; the calling
   * thread is number 0, unless threads are pinned, which the calling thread never is. Returns when all
   * have ended.
   */
  void Run(const std::function<void(unsigned threads)>& prepare,
    const std::function<void(unsigned thread)>& task);

  /** Ends the run soon: nobody waits any more and Stopped() is true. Any thread, while the task runs. */
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
  std::unique_ptr<LoopSharing> Sharing; ///< before those who refer to it
  std::unique_ptr<ContentionManager> Manager;
  std::unique_ptr<LoadBalancer> Balancer;
  std::mutex ErrorMutex;
  std::exception_ptr Error;
};

} // namespace voxplex

#endif

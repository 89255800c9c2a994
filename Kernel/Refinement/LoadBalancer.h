// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoadBalancer.h
 * @brief Who gets work from whom, and when all is done (thesis, sections 3.2.4 and 3.4.1).
 */
#ifndef voxplex_LoadBalancer_h
#define voxplex_LoadBalancer_h

#include "Parallel/Policies.h"
#include "Parallel/ProcessorTopology.h"

#include <memory>

namespace voxplex
{

class LoopSharing;

/**
 * @brief The begging lists: threads without work wait in them until a busy thread gives them some.
 *
 * A busy thread looks now and then whether SomeoneBegs(); if it has work to spare it takes a beggar
 * out of the lists, puts work into the beggar's own list, and wakes it. Nobody takes work from a
 * busy thread, so that the lists of poor elements need no locks.
 */
class LoadBalancer
{
public:
  struct Beggar
  {
    unsigned Thread;
    unsigned Level; ///< lowest level on which giver and beggar share a group
  };
  static constexpr unsigned Nobody = 0xffffffffu;

  virtual ~LoadBalancer() = default;

  /** Cheap: a load of a shared word that rarely changes. May be out of date. */
  virtual bool SomeoneBegs() const = 0;

  /**
   * Takes the beggar that `giver` should serve first out of the lists; its Thread is Nobody if
   * there is none that it may serve. Whoever takes one must call Wake(), or Stop(). From now on the
   * beggar counts as busy. Without a mutex if there is none, so that it may be asked after each
   * operation.
   */
  virtual Beggar TakeBeggar(unsigned giver) = 0;

  /** Lets a beggar that was taken go on; what the caller wrote before is visible to it. */
  virtual void Wake(unsigned beggar) = 0;

  /**
   * Waits for work. The thread has none left.
   * @return false if there is none and never will be, since all threads wait, or after Stop(); the
   *   thread must then leave its list alone until all threads have ended: a giver that was
   *   interrupted by Stop() may still be writing to it
   */
  virtual bool Beg(unsigned thread) = 0;

  /** Wakes all; from now on Beg() returns false. May be called by anyone at any time. */
  virtual void Stop() = 0;
};

/**
 * @param topology has the number of threads
 * @param sharing where threads help while they wait for work, or null; must outlive the balancer
 */
std::unique_ptr<LoadBalancer> MakeLoadBalancer(
  BalancePolicy policy, const ProcessorTopology& topology, LoopSharing* sharing = nullptr);

} // namespace voxplex

#endif

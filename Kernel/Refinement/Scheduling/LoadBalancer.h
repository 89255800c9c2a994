// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoadBalancer.h
 * @brief Which thread gets work from which, and when all work is done (thesis, sections 3.2.4 and
 * 3.4.1).
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
 * A busy thread regularly asks whether SomeoneBegs(). If it has work to spare, it takes a beggar
 * out of the lists, puts work into the beggar's own list, and wakes it. No thread takes work from a
 * busy thread, so the lists of poor elements need no locks.
 */
class LoadBalancer
{
public:
  struct Beggar
  {
    unsigned Thread;
    unsigned Level; ///< lowest level at which giver and beggar share a group
  };
  static constexpr unsigned Nobody = 0xffffffffu;

  virtual ~LoadBalancer() = default;

  /** Cheap: it loads a shared word that rarely changes. The answer may be out of date. */
  virtual bool SomeoneBegs() const = 0;

  /**
   * Takes the beggar that `giver` should serve first out of the lists. If there is none that it may
   * serve, Thread is Nobody. The caller must then call Wake() for the beggar, or Stop(). From now
   * on the beggar counts as busy. If there is no beggar, the call takes no mutex, so it may be made
   * after each operation.
   */
  virtual Beggar TakeBeggar(unsigned giver) = 0;

  /** Lets a beggar that was taken out go on. It sees all memory that the caller wrote before. */
  virtual void Wake(unsigned beggar) = 0;

  /**
   * Waits for work. The thread must have none left.
   * @return false if there will never be work, because all threads wait, or after Stop(). Then the
   *   thread must not touch its list until all threads have ended: a giver that was interrupted by
   *   Stop() may still be writing to it
   */
  virtual bool Beg(unsigned thread) = 0;

  /** Wakes all threads; from now on Beg() returns false. Any thread may call this at any time. */
  virtual void Stop() = 0;
};

/**
 * @param topology has the number of threads
 * @param sharing the loops at which threads help while they wait for work, or null; must outlive
 *   the balancer
 */
std::unique_ptr<LoadBalancer> MakeLoadBalancer(
  BalancePolicy policy, const ProcessorTopology& topology, LoopSharing* sharing = nullptr);

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BeggingLists.h
 * @brief The load balancer of both policies. Private to LoadBalancer.cxx and its test.
 */
#ifndef voxplex_BeggingLists_h
#define voxplex_BeggingLists_h

#include "Parallel/CacheLine.h"
#include "Parallel/LoopSharing.h"
#include "Parallel/ParkingSpot.h"
#include "Parallel/WaitingList.h"
#include "Refinement/Scheduling/LoadBalancer.h"

#include <array>
#include <atomic>
#include <mutex>
#include <vector>

namespace voxplex
{

/**
 * @brief One begging list for each group of each level of a topology (thesis, section 3.4.1).
 *
 * Take a topology of sockets in NUMA nodes in the machine; any other nesting works as well. An idle
 * thread waits
 *
 * - in the list of its socket, BL1, unless all other threads of the socket wait there;
 * - else in the list of its node, BL2, unless one thread of every other socket of the node waits
 *   there;
 * - else in the list of the machine, BL3.
 *
 * A giver looks into BL1 of its socket, BL2 of its node, and BL3, in this order. A list is served
 * first come, first served. Random work stealing is the same with all threads in one socket.
 *
 * **Every beggar is found.** Only busy threads of a socket serve its BL1. If all threads of a
 * socket wait, the threads on BL1 wait until the socket's delegate is served. The delegate is the
 * last thread of the socket, which waits in a higher list. A socket has only one, because a thread
 * goes up only if all others are on BL1. Once served, the delegate serves BL1 of its socket before
 * all other lists. The same holds for nodes and BL2, with delegates in place of threads. Now let a
 * thread B be busy. In B's socket, waiting threads are on BL1. Every other socket of B's node has a
 * busy thread or a delegate on BL2. Every other node has a busy thread or a delegate on BL3. B may
 * serve each of these lists. So if a socket falls idle later, its threads on BL1 are not forgotten:
 * the delegate brings work home.
 *
 * **Termination.** Waiting threads are counted under the mutex. A thread that is taken out counts
 * as busy at once, before its giver wakes it. So the count reaches the number of threads only if no
 * thread has work or is about to get some. The thread that completes the count ends the run. Only
 * this thread would find all three lists full.
 *
 * **Help.** A waiting thread may help others with a shared loop. It still counts as waiting and is
 * woken as before. The loop is part of the work of its owner, which is busy, and the help ends
 * before the owner's loop does.
 */
class BeggingLists final : public LoadBalancer
{
public:
  /**
   * @param groups the threads of a group wait in one list
   * @param topology gives Beggar::Level; it has as many threads as `groups`
   * @param sharing the loops at which waiting threads help, or null
   */
  BeggingLists(const ProcessorTopology& groups, const ProcessorTopology& topology,
    LoopSharing* sharing = nullptr);

  bool SomeoneBegs() const override
  {
    // Relaxed: only a hint; TakeBeggar() looks under the mutex.
    return this->Listed.load(std::memory_order_relaxed) != 0;
  }
  Beggar TakeBeggar(unsigned giver) override;
  void Wake(unsigned beggar) override { this->Slots[beggar].Spot.Wake(); }
  bool Beg(unsigned thread) override;
  void Stop() override;

  /** The number of threads that wait in the lists now; for tests and for observers of a run. */
  unsigned NumberOfBeggars() const { return this->Listed.load(std::memory_order_relaxed); }

private:
  static constexpr unsigned Levels = ProcessorTopology::Levels;

  struct alignas(CacheLineSize) List
  {
    std::atomic<unsigned> Size{ 0 }; ///< written under the mutex, read without it
    unsigned Capacity = 0;           ///< members (threads, sockets, nodes) of the group, minus one
    WaitingList Threads;
  };
  struct alignas(CacheLineSize) Slot
  {
    std::array<unsigned, Levels> ListOfLevel{}; ///< index in Lists
    std::array<unsigned, Levels> Group{};       ///< in the topology that gives the levels
    unsigned NextInList = WaitingList::Nobody;
    alignas(CacheLineSize) ParkingSpot Spot;
  };

  void End();
  unsigned SharedLevel(unsigned a, unsigned b) const;

  LoopSharing* const Sharing;
  std::vector<Slot> Slots;
  std::vector<List> Lists;
  alignas(CacheLineSize) std::atomic<unsigned> Listed{ 0 }; ///< threads in all lists together
  alignas(CacheLineSize) std::mutex Mutex; ///< guards the lists and the members below
  unsigned Waiting = 0; ///< like Listed, plus the thread that found all others waiting
  std::atomic<bool> Over{ false };
};

} // namespace voxplex

#endif

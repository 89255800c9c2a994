// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BeggingLists.h
 * @brief The load balancer that both policies are. Private to LoadBalancer.cxx and its test.
 */
#ifndef voxplex_BeggingLists_h
#define voxplex_BeggingLists_h

#include "Parallel/CacheLine.h"
#include "Parallel/LoopSharing.h"
#include "Parallel/ParkingSpot.h"
#include "Parallel/WaitingList.h"
#include "Refinement/LoadBalancer.h"

#include <array>
#include <atomic>
#include <mutex>
#include <vector>

namespace voxplex
{

/**
 * @brief One begging list for each group of each level of a topology (thesis, section 3.4.1).
 *
 * Say the topology has sockets in NUMA nodes in the machine; any nesting will do. An idle thread
 *
 * - waits in the list of its socket, BL1, unless all other threads of the socket wait there;
 * - else in the list of its node, BL2, unless one of every other socket of the node waits there;
 * - else in the list of the machine, BL3.
 *
 * A giver looks into BL1 of its socket, BL2 of its node, BL3, in this order; a list is served first
 * come, first served. Random work stealing is the same with all threads in one socket.
 *
 * **Whoever begs is found.** BL1 of a socket is served by busy threads of that socket only. So once
 * all its threads wait, they stay where they are until its delegate is served: the last one, which
 * went up. There is one delegate only, as it went up when all others were on BL1. Once served, it
 * serves BL1 of its socket before all else. The same holds for nodes and BL2 as for sockets and
 * BL1, with delegates in place of threads. Now let a thread B be busy. Who waits in B's socket
 * waits on its BL1; every other socket of B's node has a busy thread or a delegate on BL2; every
 * other node has a busy thread or a delegate on BL3. B may serve each of these. A thread on BL1
 * whose socket fell idle after it is thus not forgotten: its delegate brings work home.
 *
 * **Termination.** Those who wait are counted under the mutex; who is taken out counts as busy at
 * once, before its giver wakes it. So the count reaches the number of threads only when nobody has
 * work or is about to get some; the thread that makes it do so ends all. That is the only case in
 * which all three lists would be full for a thread.
 *
 * **Help.** A thread that waits may help others at a sharing. It still counts as waiting, and is woken as
 * before: what it does there is a part of its owner's work, which is busy, and ends before the owner's.
 */
class BeggingLists final : public LoadBalancer
{
public:
  /**
   * @param groups who waits with whom
   * @param topology by which Beggar::Level is told; as many threads as groups
   * @param sharing where those who wait help, or null
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

  /** How many threads wait in the lists now; for tests, and for those who watch a run. */
  unsigned NumberOfBeggars() const { return this->Listed.load(std::memory_order_relaxed); }

private:
  static constexpr unsigned Levels = ProcessorTopology::Levels;

  struct alignas(CacheLineSize) List
  {
    std::atomic<unsigned> Size{ 0 }; ///< written under the mutex, looked at without
    unsigned Capacity = 0;           ///< members (threads, sockets, nodes) of the group, less one
    WaitingList Threads;
  };
  struct alignas(CacheLineSize) Slot
  {
    std::array<unsigned, Levels> ListOfLevel{}; ///< index in Lists
    std::array<unsigned, Levels> Group{};       ///< in the topology by which levels are told
    unsigned NextInList = WaitingList::Nobody;
    alignas(CacheLineSize) ParkingSpot Spot;
  };

  void End();
  unsigned SharedLevel(unsigned a, unsigned b) const;

  LoopSharing* const Sharing;
  std::vector<Slot> Slots;
  std::vector<List> Lists;
  alignas(CacheLineSize) std::atomic<unsigned> Listed{ 0 }; ///< threads in all lists together
  alignas(CacheLineSize) std::mutex Mutex;                  ///< guards the lists and what follows
  unsigned Waiting = 0; ///< as Listed, but with the one that found all others waiting
  std::atomic<bool> Over{ false };
};

} // namespace voxplex

#endif

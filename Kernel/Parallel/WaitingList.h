// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WaitingList.h
 * @brief A first-in, first-out queue of waiting threads.
 */
#ifndef voxplex_WaitingList_h
#define voxplex_WaitingList_h

#include <atomic>
#include <limits>

namespace voxplex
{

/**
 * @brief A queue of thread numbers. It is linked through the threads' slots, so it never allocates.
 *
 * A thread is in at most one queue at a time. A mutex must guard each queue; it also guards the
 * NextInList of the threads in the queue. Only IsEmpty() may be called without it, as a hint.
 *
 * @tparam Slots a container whose operator[] returns slots with a member `unsigned NextInList`
 */
class WaitingList
{
public:
  static constexpr unsigned Nobody = std::numeric_limits<unsigned>::max();

  bool IsEmpty() const { return this->First.load(std::memory_order_relaxed) == Nobody; }

  template <typename Slots>
  void Append(Slots& slots, unsigned thread)
  {
    slots[thread].NextInList = Nobody;
    if (this->IsEmpty())
    {
      this->First.store(thread, std::memory_order_relaxed);
    }
    else
    {
      slots[this->Last].NextInList = thread;
    }
    this->Last = thread;
  }

  /** @return Nobody if the list is empty */
  template <typename Slots>
  unsigned TakeFirst(const Slots& slots)
  {
    const unsigned first = this->First.load(std::memory_order_relaxed);
    if (first != Nobody)
    {
      this->First.store(slots[first].NextInList, std::memory_order_relaxed);
    }
    return first;
  }

private:
  std::atomic<unsigned> First{ Nobody }; ///< relaxed, here and above: the mutex orders the rest
  unsigned Last = Nobody;
};

} // namespace voxplex

#endif

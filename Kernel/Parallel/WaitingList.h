// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WaitingList.h
 * @brief A first-in, first-out queue of waiting threads.
 */
#ifndef voxplex_WaitingList_h
#define voxplex_WaitingList_h

#include <limits>

namespace voxplex
{

/**
 * @brief A queue of thread numbers. It is linked through the threads' slots, so it never allocates.
 *
 * A thread is in at most one queue at a time. Queues are not thread-safe. The mutex that guards a
 * queue also guards the NextInList of the threads in it.
 *
 * @tparam Slots a container whose operator[] returns slots with a member `unsigned NextInList`
 */
struct WaitingList
{
  static constexpr unsigned Nobody = std::numeric_limits<unsigned>::max();
  unsigned First = Nobody;
  unsigned Last = Nobody;

  bool IsEmpty() const { return this->First == Nobody; }

  template <typename Slots>
  void Append(Slots& slots, unsigned thread)
  {
    slots[thread].NextInList = Nobody;
    if (this->IsEmpty())
    {
      this->First = thread;
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
    const unsigned first = this->First;
    if (first != Nobody)
    {
      this->First = slots[first].NextInList;
    }
    return first;
  }
};

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParkingSpot.h
 * @brief Where one thread waits until another lets it go on.
 */
#ifndef voxplex_ParkingSpot_h
#define voxplex_ParkingSpot_h

#include "Parallel/Pause.h"

#include <atomic>
#include <thread>

namespace voxplex
{

/**
 * @brief The place where one thread, its owner, waits.
 *
 * The owner says with Prepare() that it will wait, then lets others know (puts itself into a list),
 * then calls Wait(). Whoever finds it calls Wake(), before or after Wait() was entered: no wake-up
 * is lost, and one that nobody waits for has no effect on later waits.
 *
 *     Free --Prepare()--> Taken --Wait(), after spinning--> Asleep
 *      ^                    |                                 |
 *      +------- Wake() -----+------------- Wake() ------------+
 *
 * Most waits are either very short or long. Wait() therefore spins for a moment, lets other threads
 * of the processor run a few times, and then sleeps in the operating system, so that threads that
 * wait never take the processors from those that work even if there are many more of them.
 *
 * A spot must outlive all calls of Wake(): one may still run when Wait() has returned.
 */
class ParkingSpot
{
public:
  static constexpr unsigned Spins = 300; ///< pauses before the processor is offered to others
  static constexpr unsigned Yields = 8;  ///< offers before the thread sleeps

  /** The owner is about to wait. */
  void Prepare()
  {
    // Relaxed: the owner lets others know afterwards, through a mutex.
    this->State.store(Taken, std::memory_order_relaxed);
  }

  /** True between Prepare() and Wake(). Exact only under what orders these two. */
  bool IsTaken() const { return this->State.load(std::memory_order_relaxed) != Free; }

  /** Returns once Wake() was called after Prepare(); what its caller wrote before is visible. */
  void Wait()
  {
    for (unsigned spin = 0; spin < Spins; ++spin)
    {
      if (this->WasWoken())
      {
        return;
      }
      Pause();
    }
    for (unsigned yield = 0; yield < Yields; ++yield)
    {
      if (this->WasWoken())
      {
        return;
      }
      std::this_thread::yield();
    }
    // Fails if Wake() came in between. From here on Wake() sees that somebody sleeps.
    int taken = Taken;
    this->State.compare_exchange_strong(
      taken, Asleep, std::memory_order_relaxed, std::memory_order_relaxed);
    while (!this->WasWoken())
    {
      this->State.wait(Asleep, std::memory_order_acquire);
    }
  }

  /** Lets the owner go on. Any thread, any number of times. */
  void Wake()
  {
    // Release: publishes what the caller wrote. Sequentially consistent, since the library decides
    // by a second variable whether there is a sleeper to be notified.
    if (this->State.exchange(Free, std::memory_order_seq_cst) == Asleep)
    {
      this->State.notify_one();
    }
  }

private:
  static constexpr int Free = 0;
  static constexpr int Taken = 1;
  static constexpr int Asleep = 2;

  /** Acquire: pairs with the release in Wake(). */
  bool WasWoken() const { return this->State.load(std::memory_order_acquire) == Free; }

  std::atomic<int> State{ Free }; ///< an int: what a futex compares
};

} // namespace voxplex

#endif

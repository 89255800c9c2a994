// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParkingSpot.h
 * @brief A place where one thread waits until another thread wakes it.
 */
#ifndef voxplex_ParkingSpot_h
#define voxplex_ParkingSpot_h

#include "Parallel/Pause.h"

#include <atomic>
#include <thread>

namespace voxplex
{

/**
 * @brief A place where one thread, its owner, waits.
 *
 * The owner calls Prepare(), then tells other threads that it waits (for example, puts itself into
 * a list), then calls Wait(). Another thread calls Wake(), before or after the owner enters Wait().
 * No wake-up is lost. A wake-up without a waiting owner has no effect on later waits.
 *
 *     Free --Prepare()--> Taken --Wait(), after spinning--> Asleep
 *      ^                    |                                 |
 *      +------- Wake() -----+------------- Wake() ------------+
 *
 * Most waits are either very short or long. Wait() therefore spins for a moment, then yields the
 * processor a few times, and then sleeps in the operating system. So waiting threads do not take
 * the processors from working threads, even if there are many more threads than processors.
 *
 * A spot must outlive all calls of Wake(): such a call may still run when Wait() has returned.
 */
class ParkingSpot
{
public:
  static constexpr unsigned Spins = 300; ///< pauses before the first yield
  static constexpr unsigned Yields = 8;  ///< yields before the thread sleeps

  /** The owner calls it when it is about to wait. */
  void Prepare()
  {
    // Relaxed: afterwards the owner tells other threads through a mutex.
    this->State.store(Taken, std::memory_order_relaxed);
  }

  /** True between Prepare() and Wake(). Exact only if these two calls are ordered with this one. */
  bool IsTaken() const { return this->State.load(std::memory_order_relaxed) != Free; }

  /**
   * Returns once Wake() was called after Prepare(). Everything that the caller of Wake() wrote
   * before is visible then.
   */
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
    // Fails if Wake() was called in the meantime. From here on Wake() sees that the owner sleeps.
    int taken = Taken;
    this->State.compare_exchange_strong(
      taken, Asleep, std::memory_order_relaxed, std::memory_order_relaxed);
    while (!this->WasWoken())
    {
      this->State.wait(Asleep, std::memory_order_acquire);
    }
  }

  /** Lets the owner go on. Any thread may call it, any number of times. */
  void Wake()
  {
    // The release publishes the caller's writes. It is sequentially consistent, since the library
    // uses a second variable to decide whether it must notify a sleeping thread.
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

  std::atomic<int> State{ Free }; ///< an int, since a futex compares an int
};

} // namespace voxplex

#endif

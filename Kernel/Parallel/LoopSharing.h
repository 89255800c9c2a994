// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoopSharing.h
 * @brief Waiting threads help working threads with their loops (thesis, section 4.6.2).
 */
#ifndef voxplex_LoopSharing_h
#define voxplex_LoopSharing_h

#include "Parallel/CacheLine.h"
#include "Parallel/CycleClock.h"
#include "Parallel/ParkingSpot.h"
#include "Parallel/Pause.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief A thread, the owner, offers a loop of independent iterations. Threads that wait for
 * something else, the helpers, take chunks of it.
 *
 * Threads are numbered from 0. Each thread has a slot, in which it offers one loop at a time. The
 * slot's state is the number h of helpers inside, times 2, plus 1 while the door is open:
 *
 *     0 --owner opens--> Open --helpers enter and leave--> Open + 2 h
 *     ^                                                      |  the owner, or a helper that finds
 *     |                                                      v  no chunk left, shuts the door
 *     +------------- the last helper leaves ---------------- 2 h
 *
 * A helper enters by a compare-and-exchange that succeeds only while the door is open. The owner
 * and the helpers take chunks by an atomic counter. The owner returns when the door is shut and all
 * helpers have left. So a helper accesses the loop's data only before the owner returns, even if
 * the helper is interrupted. Outside of chunks it accesses only the slots, which live as long as
 * the LoopSharing.
 *
 * **Memory order.** Opening is a release, and entering is an acquire: a helper sees everything that
 * the owner wrote before it opened the loop. Leaving is a release, and the owner's last load of the
 * slot's state is an acquire: the owner sees everything that the helpers wrote. The owner keeps its
 * locks during the loop. Therefore the helpers may read all data that these locks protect.
 *
 * **Progress.** No thread waits for a helper to come. A helper waits neither for another helper nor
 * for an owner. The owner waits only for running chunks to end. So helping adds no edge to the
 * "waits for" graphs of contention managers and load balancers. A helper that is woken goes on when
 * the loop has no chunk left. A helper holds no locks, since a waiting thread holds none.
 *
 * No operation allocates memory or takes a mutex. If no thread is idle, the owner's cost is one
 * relaxed load.
 *
 * Loops must not be nested, and a chunk must not wait for another thread.
 */
class LoopSharing
{
public:
  /** A helper gives up after this many searches in a row that find no open loop. */
  static constexpr unsigned DefaultPatience = 32768;
  /** A helper yields its processor to other threads once in this many searches. */
  static constexpr unsigned LooksBeforeYield = 16;
  /** An owner that waits for the last chunks pauses this often before it yields its processor. */
  static constexpr unsigned PausesBeforeYield = 1024;

  /** The help that an owner received. */
  struct Counts
  {
    std::uint64_t Loops = 0;      ///< loops in which helpers took part
    std::uint64_t Iterations = 0; ///< iterations done by helpers
  };

  /**
   * @param threads number of threads that may be owners or helpers
   * @param patience a helper gives up after this many searches in a row that find no open loop
   */
  explicit LoopSharing(unsigned threads, unsigned patience = DefaultPatience)
    : Patience(patience)
    , Slots(threads)
  {
  }
  LoopSharing(const LoopSharing&) = delete;
  LoopSharing& operator=(const LoopSharing&) = delete;

  /**
   * True if a thread is ready to help. This is only a hint. It is cheap, since the word that it
   * reads changes only when a thread begins or ends to wait.
   */
  bool SomeoneIdle() const { return this->Idle.load(std::memory_order_relaxed) != 0; }

  /**
   * Calls body(thread, first, last) on disjoint chunks that together cover [0, count), in the
   * calling thread and in its helpers. Returns when all chunks are done and all helpers have left.
   * If no thread is idle, the calling thread does the whole loop as one chunk.
   *
   * @param owner the calling thread's number
   * @param grain iterations of a chunk, at least 1
   * @param body gets the number of the thread in which it runs, to select data of that thread
   * @param meanwhile the owner calls it before it takes chunks itself; helpers may work meanwhile
   * @throws the first exception of a chunk or of `meanwhile`; chunks that had not begun by then are
   *   not run
   */
  template <typename Body, typename Meanwhile>
  void Run(unsigned owner, std::size_t count, std::size_t grain, Body&& body, Meanwhile&& meanwhile)
  {
    if (!this->SomeoneIdle() || count == 0)
    {
      meanwhile();
      if (count != 0)
      {
        body(owner, std::size_t{ 0 }, count);
      }
      return;
    }
    Slot& slot = this->Slots[owner];
    Open(
      slot, count, grain,
      [](void* context, unsigned thread, std::size_t first, std::size_t last)
      { (*static_cast<std::remove_reference_t<Body>*>(context))(thread, first, last); },
      const_cast<void*>(static_cast<const void*>(std::addressof(body))));
    try
    {
      meanwhile();
      TakeChunks(slot, owner);
    }
    catch (...)
    {
      Fail(slot, std::current_exception());
    }
    Close(slot);
  }

  template <typename Body>
  void Run(unsigned owner, std::size_t count, std::size_t grain, Body&& body)
  {
    this->Run(owner, count, grain, std::forward<Body>(body), []() {});
  }

  /**
   * Helps owners with their loops until done() is true, or until many searches in a row found no
   * open loop. done() is called before each search, so the return is late by at most the chunks of
   * one loop.
   */
  template <typename Done>
  void HelpUntil(unsigned helper, const Done& done)
  {
    this->Idle.fetch_add(1, std::memory_order_relaxed);
    for (unsigned looks = 0; looks < this->Patience && !done();)
    {
      if (this->HelpOnce(helper))
      {
        looks = 0;
        continue;
      }
      ++looks;
      if (looks % LooksBeforeYield == 0)
      {
        std::this_thread::yield();
      }
      else
      {
        Pause();
      }
    }
    this->Idle.fetch_sub(1, std::memory_order_relaxed);
  }

  /** Exact if the owner calls it, or if the owner's thread has ended. */
  const Counts& GetCounts(unsigned owner) const { return this->Slots[owner].Received; }

  /** Time that a thread spent in loops of others. Exact if it calls this, or if it has ended. */
  CycleClock::Ticks TicksOfHelp(unsigned helper) const { return this->Slots[helper].Given; }

private:
  using Function = void (*)(void* context, unsigned thread, std::size_t first, std::size_t last);

  static constexpr std::uint32_t OpenDoor = 1;
  static constexpr std::uint32_t OneHelper = 2;

  struct alignas(CacheLineSize) Slot
  {
    std::atomic<std::uint32_t> State{ 0 };
    // The loop. The owner writes it while State is 0. The owner and the helpers inside read it.
    Function Call = nullptr;
    void* Context = nullptr;
    std::size_t Count = 0;
    std::size_t Grain = 1;
    std::exception_ptr Error; ///< written by the thread that sets Failed

    alignas(CacheLineSize) std::atomic<std::size_t> Next{ 0 }; ///< first iteration not handed out
    std::atomic<std::size_t> ByHelpers{ 0 };                   ///< iterations done by helpers
    std::atomic<bool> Failed{ false };

    alignas(CacheLineSize) Counts Received; ///< written by the owner only
    CycleClock::Ticks Given = 0; ///< of the owner, in loops of others; written by the owner only
  };

  static void Open(Slot& slot, std::size_t count, std::size_t grain, Function call, void* context)
  {
    assert(slot.State.load(std::memory_order_relaxed) == 0 && "loops must not be nested");
    slot.Call = call;
    slot.Context = context;
    slot.Count = count;
    slot.Grain = std::max<std::size_t>(grain, 1);
    slot.Next.store(0, std::memory_order_relaxed);
    slot.ByHelpers.store(0, std::memory_order_relaxed);
    // Release: publishes the loop, and the data that its iterations will read.
    slot.State.store(OpenDoor, std::memory_order_release);
  }

  /** @return iterations done */
  static std::size_t TakeChunks(Slot& slot, unsigned thread)
  {
    std::size_t done = 0;
    for (;;)
    {
      // Relaxed: the counter only hands out numbers.
      const std::size_t first = slot.Next.fetch_add(slot.Grain, std::memory_order_relaxed);
      if (first >= slot.Count)
      {
        return done;
      }
      const std::size_t last = first + std::min(slot.Grain, slot.Count - first);
      slot.Call(slot.Context, thread, first, last);
      done += last - first;
    }
  }

  /** Called by the owner, or by a helper that has entered. */
  static void Fail(Slot& slot, std::exception_ptr error)
  {
    slot.Next.store(slot.Count, std::memory_order_relaxed);
    // Relaxed: the owner reads Error when all helpers have left.
    if (!slot.Failed.exchange(true, std::memory_order_relaxed))
    {
      slot.Error = std::move(error);
    }
  }

  static void Close(Slot& slot)
  {
    // Acquire, here and below: each helper that left has modified State by a release operation. The
    // load that reads the last of these values synchronises with all of them.
    std::uint32_t state = slot.State.fetch_and(~OpenDoor, std::memory_order_acquire) & ~OpenDoor;
    for (unsigned turn = 0; state != 0; ++turn)
    {
      // A chunk takes microseconds. A helper that is not done after the pauses has probably lost
      // its processor, and may need this one.
      if (turn < PausesBeforeYield)
      {
        Pause();
      }
      else
      {
        std::this_thread::yield();
      }
      state = slot.State.load(std::memory_order_acquire);
    }
    const std::size_t byHelpers = slot.ByHelpers.load(std::memory_order_relaxed);
    slot.Received.Loops += byHelpers != 0 ? 1 : 0;
    slot.Received.Iterations += byHelpers;
    if (slot.Failed.load(std::memory_order_relaxed))
    {
      slot.Failed.store(false, std::memory_order_relaxed);
      std::rethrow_exception(std::exchange(slot.Error, nullptr));
    }
  }

  /** Takes part in the first open loop. @return false if no loop is open. Never throws. */
  bool HelpOnce(unsigned helper)
  {
    const std::size_t threads = this->Slots.size();
    for (std::size_t k = 1; k < threads; ++k) // from the next slot on, so that helpers spread
    {
      Slot& slot = this->Slots[(helper + k) % threads];
      std::uint32_t state = slot.State.load(std::memory_order_relaxed);
      // Acquire: pairs with the release in Open(), even if helpers entered and left since.
      if ((state & OpenDoor) != 0 &&
        slot.State.compare_exchange_strong(
          state, state + OneHelper, std::memory_order_acquire, std::memory_order_relaxed))
      {
        const CycleClock::Ticks start = CycleClock::Now();
        HelpInside(slot, helper);
        this->Slots[helper].Given += CycleClock::Now() - start;
        return true;
      }
    }
    return false;
  }

  static void HelpInside(Slot& slot, unsigned helper)
  {
    try
    {
      const std::size_t done = TakeChunks(slot, helper);
      slot.ByHelpers.fetch_add(done, std::memory_order_relaxed);
    }
    catch (...)
    {
      Fail(slot, std::current_exception());
    }
    // No chunk is left, so no more helpers need to enter.
    slot.State.fetch_and(~OpenDoor, std::memory_order_relaxed);
    // Release: the owner sees everything that this helper wrote. From here on the helper does not
    // access the loop's data.
    slot.State.fetch_sub(OneHelper, std::memory_order_release);
  }

  const unsigned Patience;
  std::vector<Slot> Slots;
  alignas(CacheLineSize) std::atomic<unsigned> Idle{ 0 };
};

/** Waits at a spot. If `sharing` is not null, the thread helps while it waits. */
inline void WaitAndHelp(ParkingSpot& spot, LoopSharing* sharing, unsigned thread)
{
  if (sharing)
  {
    sharing->HelpUntil(thread, [&spot]() { return !spot.IsTaken(); });
  }
  spot.Wait(); // acquires the data that were written before the wake-up
}

} // namespace voxplex

#endif

// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LoopSharing.h
 * @brief Threads that wait help those that work with their loops (thesis, section 4.6.2).
 */
#ifndef voxplex_LoopSharing_h
#define voxplex_LoopSharing_h

#include "Parallel/CacheLine.h"
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
 * @brief Where a thread, the owner, offers a loop of independent iterations and threads that wait for
 * something else, the helpers, take chunks of it.
 *
 * Threads are numbered from 0. Each has a slot in which it offers one loop at a time:
 *
 *     0 --owner opens--> Open --helpers enter and leave--> Open + 2 h
 *     ^                                                      |  the owner, or a helper who finds
 *     |                                                      v  nothing left, shuts the door
 *     +------------- the last helper leaves ---------------- 2 h
 *
 * A helper enters by a compare-and-exchange that succeeds only while the door is open, and takes chunks
 * by an atomic counter, as the owner does. The owner returns when the door is shut and all helpers have
 * left. So a helper touches what the loop refers to only before its owner returns, wherever it was
 * interrupted; between looks and chunks it touches nothing but the slots, which live as long as the sharing.
 *
 * **Memory order.** Opening is a release and entering an acquire: a helper sees all that the owner wrote
 * before. Leaving is a release, and the owner's last look at the slot an acquire: the owner sees all that
 * the helpers wrote. Whatever the owner was entitled to read by locks that it took before the loop and
 * gives back after it, the helpers may read in between.
 *
 * **Nobody waits for a helper to come,** and helpers never wait: neither for each other nor for an owner.
 * The owner waits for chunks that run to end and for nothing else. So helping adds no edge to the
 * "waits for" graphs of contention managers and load balancers; a helper that is woken goes on after
 * its chunk, and it holds no more locks than it did while it waited, that is, none.
 *
 * No operation allocates or takes a mutex. An owner that finds nobody idle pays for one relaxed load.
 *
 * Loops must not be nested, and a chunk must not wait for another thread.
 */
class LoopSharing
{
public:
  /** Looks without finding a loop after which a helper gives up and sleeps. */
  static constexpr unsigned DefaultPatience = 32768;
  /** Looks between two offers of the processor to other threads. */
  static constexpr unsigned LooksBeforeYield = 16;
  /** Pauses of an owner that waits for the last chunks, before it offers its processor to others. */
  static constexpr unsigned PausesBeforeYield = 1024;

  /** What an owner got from its helpers. */
  struct Counts
  {
    std::uint64_t Loops = 0;      ///< loops of which helpers did a part
    std::uint64_t Iterations = 0; ///< done by helpers
  };

  /**
   * @param threads how many may be owners or helpers
   * @param patience looks without finding a loop after which a helper gives up
   */
  explicit LoopSharing(unsigned threads, unsigned patience = DefaultPatience)
    : Patience(patience)
    , Slots(threads)
  {
  }
  LoopSharing(const LoopSharing&) = delete;
  LoopSharing& operator=(const LoopSharing&) = delete;

  /** True if a thread is ready to help. Only a hint, cheap: a word that changes when waits begin or end. */
  bool SomeoneIdle() const { return this->Idle.load(std::memory_order_relaxed) != 0; }

  /**
   * Calls body(thread, first, last) on disjoint chunks that together cover [0, count), in the calling
   * thread and in those that come to help; returns when all are done and all helpers have left.
   *
   * @param owner the calling thread's number
   * @param grain iterations of a chunk, at least 1
   * @param body gets the number of the thread that it runs in, for what each thread has of its own
   * @param meanwhile called by the owner before it takes part itself, while helpers are at work already
   * @throws what a chunk or `meanwhile` threw first; chunks that had not begun by then are not run
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
    this->Open(
      slot, count, grain,
      [](void* context, unsigned thread, std::size_t first, std::size_t last)
      { (*static_cast<std::remove_reference_t<Body>*>(context))(thread, first, last); },
      const_cast<void*>(static_cast<const void*>(std::addressof(body))));
    try
    {
      meanwhile();
      this->TakeChunks(slot, owner);
    }
    catch (...)
    {
      this->Fail(slot, std::current_exception());
    }
    this->Close(slot);
  }

  template <typename Body>
  void Run(unsigned owner, std::size_t count, std::size_t grain, Body&& body)
  {
    this->Run(owner, count, grain, std::forward<Body>(body), []() {});
  }

  /**
   * Helps whoever offers a loop, until done() or until nobody has offered one for a while. done() is
   * asked before each look, so that it is late by one chunk at most.
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

  /** Exact when the owner's thread has ended, or for the owner. */
  const Counts& GetCounts(unsigned owner) const { return this->Slots[owner].Received; }

private:
  using Function = void (*)(void* context, unsigned thread, std::size_t first, std::size_t last);

  static constexpr std::uint32_t OpenDoor = 1;
  static constexpr std::uint32_t OneHelper = 2;

  struct alignas(CacheLineSize) Slot
  {
    std::atomic<std::uint32_t> State{ 0 };
    // The loop: written by the owner while State is 0, read by the owner and by those inside.
    Function Call = nullptr;
    void* Context = nullptr;
    std::size_t Count = 0;
    std::size_t Grain = 1;
    std::exception_ptr Error; ///< written by whoever sets Failed

    alignas(CacheLineSize) std::atomic<std::size_t> Next{ 0 }; ///< first iteration not handed out
    std::atomic<std::size_t> ByHelpers{ 0 };                   ///< iterations
    std::atomic<bool> Failed{ false };

    alignas(CacheLineSize) Counts Received; ///< touched by the owner only
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
    // Release: publishes the loop, and all that its iterations will read.
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

  /** By someone inside. */
  static void Fail(Slot& slot, std::exception_ptr error)
  {
    slot.Next.store(slot.Count, std::memory_order_relaxed);
    // Relaxed: Error is read when all have left.
    if (!slot.Failed.exchange(true, std::memory_order_relaxed))
    {
      slot.Error = std::move(error);
    }
  }

  static void Close(Slot& slot)
  {
    // Acquire, here and below: reads the last of the words that helpers wrote one after the other as they
    // left, and so synchronises with each of them.
    std::uint32_t state = slot.State.fetch_and(~OpenDoor, std::memory_order_acquire) & ~OpenDoor;
    for (unsigned turn = 0; state != 0; ++turn)
    {
      // A chunk takes microseconds: whoever is not done by then has lost its processor, and may need this.
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

  /** Takes part in the first open loop; false if there is none. Never throws. */
  bool HelpOnce(unsigned helper)
  {
    const std::size_t threads = this->Slots.size();
    for (std::size_t k = 1; k < threads; ++k) // from the next one on, so that helpers spread
    {
      Slot& slot = this->Slots[(helper + k) % threads];
      std::uint32_t state = slot.State.load(std::memory_order_relaxed);
      // Acquire: pairs with Open(), whatever helpers entered and left since.
      if ((state & OpenDoor) != 0 &&
        slot.State.compare_exchange_strong(
          state, state + OneHelper, std::memory_order_acquire, std::memory_order_relaxed))
      {
        this->HelpInside(slot, helper);
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
    // Nothing is left: nobody need enter any more.
    slot.State.fetch_and(~OpenDoor, std::memory_order_relaxed);
    // Release: the owner sees what was written here. Last touch of what the loop refers to.
    slot.State.fetch_sub(OneHelper, std::memory_order_release);
  }

  const unsigned Patience;
  std::vector<Slot> Slots;
  alignas(CacheLineSize) std::atomic<unsigned> Idle{ 0 };
};

/** Waits at a spot, and meanwhile helps if there is a sharing. */
inline void WaitAndHelp(ParkingSpot& spot, LoopSharing* sharing, unsigned thread)
{
  if (sharing)
  {
    sharing->HelpUntil(thread, [&spot]() { return !spot.IsTaken(); });
  }
  spot.Wait(); // acquires what was written before the wake-up
}

} // namespace voxplex

#endif

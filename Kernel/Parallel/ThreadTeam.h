// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThreadTeam.h
 * @brief Threads that wait for the next parallel loop.
 */
#ifndef voxplex_ThreadTeam_h
#define voxplex_ThreadTeam_h

#include "Parallel/CacheLine.h"
#include "Parallel/ParkingSpot.h"

#include <atomic>
#include <cstddef>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

namespace voxplex
{

/**
 * @brief A thread, the leader, and helpers that sleep until it calls Run().
 *
 * The checks of a mesh consist of hundreds of short loops. To start threads for each takes longer
 * than many of the loops. While a team lives, ParallelFor() uses it for the loops of the thread
 * that made it, the leader. Loops of other threads, and loops within a loop, start threads of their
 * own.
 *
 * If a thread makes another team, that one is used until it is destroyed. The leader destroys its
 * teams itself, the latest first.
 */
class ThreadTeam
{
public:
  /**
   * @param threads the leader included; 0 means all cores. If the system cannot start as many,
   *   there are fewer.
   */
  explicit ThreadTeam(unsigned threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  /** The latest team that the calling thread leads, or null if there is none or it is in Run(). */
  static ThreadTeam* Idle();

  std::size_t NumberOfHelpers() const { return this->Helpers.size(); }

  /**
   * Calls work(thread) in several threads at once: the leader, which has number 0, and the helpers 1,
   * 2, ..., as many as are asked for, or all. Returns when all have returned. Everything that the
   * leader wrote before is visible to the helpers, and what they wrote is visible to the leader
   * afterwards.
   * @param work must not throw
   */
  template <typename Work>
  void Run(std::size_t helpers, Work& work)
  {
    static_assert(std::is_invocable_v<Work&, std::size_t>);
    this->Run(
      helpers, [](void* data, std::size_t thread) { (*static_cast<Work*>(data))(thread); },
      std::addressof(work));
  }

private:
  using Function = void (*)(void* data, std::size_t thread);

  struct alignas(CacheLineSize) Helper
  {
    ParkingSpot Spot;
    std::thread Thread;
  };

  void Run(std::size_t helpers, Function function, void* data);
  void Help(Helper& helper, std::size_t thread);

  // Written by the leader while the helpers wait. Wake() publishes them.
  Function Call = nullptr; ///< null: the team ends
  void* Data = nullptr;

  std::atomic<std::size_t> Left{ 0 }; ///< helpers that have not returned
  ParkingSpot LeadersSpot;
  bool IsRunning = false;       ///< used by the leader alone
  ThreadTeam* Before = nullptr; ///< the leader's team when it made this one
  std::vector<std::unique_ptr<Helper>> Helpers;
};

} // namespace voxplex

#endif
